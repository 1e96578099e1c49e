/*
 * The black body. Its spectral radiance at a temperature T and a wavelength l is
 *     B(l, T) = (2 h c^2 / l^5) / (e^x - 1),  x = h c / (l k T),
 * in vacuum (Planck's law, as in CIE S 017:2020).
 *
 * Everywhere: temperature_k >= 0 [K], finite, and wavelengths > 0 [nm], finite. Where the
 * exponential overflows, beyond x = 709.78, the result is 0, as it is at 0 K; a NaN gives
 * NaN. Relative error, up to there: below (12 + x) 2^-52 (measured: 10 + x / 2).
 */
#ifndef SPEC_SPECTRUM_PLANCK_H
#define SPEC_SPECTRUM_PLANCK_H

#include <stddef.h>

/* SI Brochure, 9th edition, 2019: exact. */
#define SPEC_PLANCK_J_S 6.62607015e-34       /* h */
#define SPEC_LIGHT_SPEED_M_PER_S 299792458.0 /* c */
#define SPEC_BOLTZMANN_J_PER_K 1.380649e-23  /* k */

/* Wien's displacement law: B is greatest at l = b / T. CODATA 2018, digits cut. */
#define SPEC_WIEN_NM_K 2.897771955e6 /* b */

/* Spectral radiance [W m^-2 sr^-1 nm^-1] at count wavelengths, of any order. */
void spec_planck_radiance(double temperature_k, const double *restrict wavelength_nm,
	size_t count, double *restrict radiance);

/* The same over its greatest value, so 1 at l = b / T and in [0, 1] to rounding. */
void spec_planck_relative(double temperature_k, const double *restrict wavelength_nm,
	size_t count, double *restrict relative);

/*
 * Their means over bins, the i-th from edges_nm[i] to edges_nm[i + 1], ascending and > 0,
 * by Gauss and Legendre's rule of 8 points in each.
 * Error: relative; in a bin from a to b over which x falls by d, below 1e-12 where b is
 *        at most 1.5 a and d at most 4 (at 500 K and 380 nm, 20 nm are d = 3.8), and
 *        below 1e-6 where b is at most 3 a and d at most 8. Narrower bins for more.
 */
void spec_planck_radiance_mean(
	double temperature_k, const double *edges_nm, size_t bins, double *radiance);
void spec_planck_relative_mean(
	double temperature_k, const double *edges_nm, size_t bins, double *relative);

#endif
