/* CIELAB and colour differences. */
#ifndef SPEC_COLOUR_DIFFERENCE_H
#define SPEC_COLOUR_DIFFERENCE_H

#include <stddef.h>

/*
 * CIELAB coordinates of a colour.
 * Given:    xyz    tristimulus values, finite, on the scale of white (negative ones go
 *                  on along the straight part)
 *           white  tristimulus values of the white, each > 0
 * Returned: lab    L* (0 black, 100 white), a*, b*, without unit
 * Source:   CIE 15:2018 and ISO/CIE 11664-4:2019, with the exact 216/24389 = (6/29)^3
 *           and 24389/27 = (29/3)^3 in place of .008856 and 903.3.
 */
void spec_lab_from_xyz(const double xyz[3], const double white[3], double lab[3]);

/* The distance in CIELAB, DeltaE*ab (CIE 1976; ISO/CIE 11664-4:2019). */
double spec_difference_ab76(const double lab1[3], const double lab2[3]);

/*
 * CIE94 colour difference of lab2 from the standard lab1, with kL = kC = kH = 1 and the
 * reference conditions' S_C = 1 + 0.045 C1*, S_H = 1 + 0.015 C1*: not symmetric.
 * Given:    lab1, lab2  CIELAB coordinates; a NaN gives NaN
 * Source:   CIE 116-1995, Industrial colour-difference evaluation.
 */
double spec_difference_cie94(const double lab1[3], const double lab2[3]);

/*
 * CIEDE2000 colour difference with kL = kC = kH = 1, symmetric in its arguments.
 * Given:    lab1, lab2  CIELAB coordinates, finite; a NaN gives NaN
 * Source:   Sharma, Wu, Dalal: The CIEDE2000 color-difference formula: implementation
 *           notes, supplementary test data, and mathematical observations. Color
 *           Research and Application 30 (2005) 21-30; ISO/CIE 11664-6:2014.
 * Domain:   meant for differences up to about 5; hue is discontinuous at 180 degrees.
 */
double spec_difference_ciede2000(const double lab1[3], const double lab2[3]);

/*
 * Both of them of many colours: planes hold count numbers each. Beside the functions above
 * CIELAB is at most 1e-12 off where XYZ do not exceed white, and a difference 1e-11.
 */

/* In place: X, Y, Z become L*, a*, b*. */
void spec_lab_row(const double white[3], double *const plane[3], size_t count);

/* CIEDE2000 of each pair. */
void spec_difference_ciede2000_row(const double *const lab1[3], const double *const lab2[3],
	size_t count, double *difference);

#endif
