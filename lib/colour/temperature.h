/*
 * Correlated colour temperature: that of the black body whose chromaticity is nearest, in
 * the CIE 1960 diagram u = 4X / (X + 15Y + 3Z), v = 6Y / (X + 15Y + 3Z).
 */
#ifndef SPEC_COLOUR_TEMPERATURE_H
#define SPEC_COLOUR_TEMPERATURE_H

#include "spectrum/curve.h"

/* Beyond these nothing is said. */
#define SPEC_TEMPERATURE_LOWEST_K 1000.0
#define SPEC_TEMPERATURE_HIGHEST_K 100000.0
#define SPEC_TEMPERATURE_FARTHEST .05 /* |Duv|: CIE 15:2018, section 9.5 */

/* Chromaticity in the CIE 1960 diagram; NaN where X + 15Y + 3Z is not positive. */
void spec_temperature_uv(const double xyz[3], double uv[2]);

/* The tristimulus values, on any scale, of the black body at a temperature > 0 [K]. */
void spec_temperature_black_body(
	const struct spec_curve *observer, double temperature_k, double xyz[3]);

/*
 * Given:    observer  colour-matching functions: CIE 1931, by the definition of the term
 *           xyz       tristimulus values by that observer, any scale
 * Returned: cct_k     [K], from LOWEST_K to HIGHEST_K
 *           duv       distance from the Planckian locus, from -FARTHEST to FARTHEST,
 *                     positive above it (greener), as in ANSI C78.377
 *           Both are NaN where there is no such temperature: xyz is not finite or has no
 *           chromaticity, or the nearest black body is beyond these limits.
 * Rule:     The locus is that of Planck's law (planck.h; CODATA 2018's c2 = .01438777 m K)
 *           summed over the observer's samples. The foot of the perpendicular is bracketed
 *           among temperatures 10 mired apart and found by bisection of
 *           (p - c(T)) . c'(T) = 0, with dB/dT = B x / (T (1 - e^-x)), x = c2 / (l T).
 * Source:   CIE 15:2018, correlated colour temperature; Ohno: Practical use and calculation
 *           of CCT and Duv. LEUKOS 10 (2014) 47-55, whose approximations are not needed.
 */
void spec_temperature_find(
	const struct spec_curve *observer, const double xyz[3], double *cct_k, double *duv);

#endif
