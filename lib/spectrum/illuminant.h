/* Illuminants by formula: phases of daylight, and the black body, of any temperature. */
#ifndef SPEC_SPECTRUM_ILLUMINANT_H
#define SPEC_SPECTRUM_ILLUMINANT_H

#include "base/error.h"
#include "spectrum/curve.h"

#define SPEC_DAYLIGHT_COOLEST_K 4000.0
#define SPEC_DAYLIGHT_HOTTEST_K 25000.0
#define SPEC_BLACKBODY_COOLEST_K 100.0
#define SPEC_BLACKBODY_HOTTEST_K 1e6

/* The wavelengths of the black body's curve, 1 nm apart. */
#define SPEC_BLACKBODY_FIRST_NM 200
#define SPEC_BLACKBODY_LAST_NM 2500

/*
 * The chromaticity of daylight, CIE 1931, of a correlated colour temperature [K] from
 * SPEC_DAYLIGHT_COOLEST_K to SPEC_DAYLIGHT_HOTTEST_K. Error: SPEC_ERANGE.
 * Source: CIE 15:2018, equations 4.7 to 4.9: y = -3.000 x^2 + 2.870 x - 0.275 and
 *         x = -4.6070e9 / T^3 + 2.9678e6 / T^2 + 0.09911e3 / T + 0.244063  to 7000 K,
 *         x = -2.0064e9 / T^3 + 1.9018e6 / T^2 + 0.24748e3 / T + 0.237040  above.
 */
enum spec_status spec_daylight_xy(
	double temperature_k, double xy[2], struct spec_error *error);

/*
 * The phase of daylight of a correlated colour temperature, S0 + M1 S1 + M2 S2, relative,
 * 100 at 560 nm, at the wavelengths of the components.
 * Given:    components  S0, S1 and S2 in its first three columns (the CIE's: 300 to
 *                       830 nm, in spectra/ illuminants/daylight-components)
 * Source:   CIE 15:2018, equation 4.10, with M1 and M2 rounded to three decimals as the
 *           tables of D50, D55, D65 and D75 have it; these are of 5000, 5500, 6500 and
 *           7500 K times 1.4388 / 1.4380, so that D65 is of 6503.6 K.
 * Errors:   SPEC_ERANGE as above; SPEC_EFORMAT: fewer columns; SPEC_ENOMEM
 */
enum spec_status spec_daylight_curve(const struct spec_curve *components,
	double temperature_k, struct spec_curve *curve, struct spec_error *error);

/*
 * The black body, planck.h, from SPEC_BLACKBODY_FIRST_NM to SPEC_BLACKBODY_LAST_NM,
 * relative, 100 at 560 nm. SPEC_ERANGE: not SPEC_BLACKBODY_COOLEST_K to _HOTTEST_K.
 */
enum spec_status spec_blackbody_curve(
	double temperature_k, struct spec_curve *curve, struct spec_error *error);

/* Whether a name is one of spec_illuminant_parse: begins with daylight: or blackbody: */
int spec_illuminant_is_formula(const char *name);

/*
 * Reads "daylight:6504K" or "blackbody:3000K": *daylight says which, *temperature_k is in
 * the range above. SPEC_EUSAGE: another text. SPEC_ERANGE: a temperature beyond the range.
 */
enum spec_status spec_illuminant_parse(
	const char *name, int *daylight, double *temperature_k, struct spec_error *error);

#endif
