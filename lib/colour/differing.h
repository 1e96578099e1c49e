/* Inside difference.c and differencerow.c alone: the numbers of CIELAB and CIEDE2000. */
#ifndef SPEC_COLOUR_DIFFERING_H
#define SPEC_COLOUR_DIFFERING_H

/* CIE 15:2018: where the cube root meets the straight line, and the line's slope. */
#define LAB_EPSILON (216. / 24389) /* (6/29)^3 */
#define LAB_KAPPA (24389. / 27)    /* (29/3)^3 */

#define DEGREE (3.14159265358979323846 / 180) /* rad */

/* 25^7, of the chroma weights G and R_C. */
#define CHROMA7 6103515625.

static inline double
seventh_power(double c)
{
	double c3 = c * c * c;

	return c3 * c3 * c;
}

#endif
