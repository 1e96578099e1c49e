/*
 * Fourier series of spectra over a range, T 3.1:
 *     S(l) = a0 / 2 + sum of an cos(n u) + bn sin(n u),  u = 2 pi (l - low) / (high - low).
 * Everywhere: coefficient is a0, a1, b1, a2, b2, …, an odd count of them; low_nm < high_nm.
 */
#ifndef SPEC_SPECTRUM_FOURIER_H
#define SPEC_SPECTRUM_FOURIER_H

#include <stddef.h>

#include "spectrum/interpolate.h"

struct spec_series {
	double low_nm, high_nm;
	size_t count;
	const double *coefficient;
};

/* The series at a wavelength, also beyond its range, where it repeats itself. */
double spec_series_at(const struct spec_series *series, double nm);

/* Its mean from a_nm to b_nm, a_nm < b_nm, by the closed form of its integral. */
double spec_series_mean(const struct spec_series *series, double a_nm, double b_nm);

/*
 * T 3.2 and 3.3 for a part of a spectrum: adds to the coefficients [count] of a series from
 * low_nm to high_nm those of a piece, and of a line of that weight.
 */
void spec_series_add_piece(const struct spec_piece *piece, double low_nm, double high_nm,
	double *coefficient, size_t count);
void spec_series_add_line(double wavelength_nm, double weight, double low_nm,
	double high_nm, double *coefficient, size_t count);

/*
 * The product of two series of one range, exact: product has room for a_count + b_count - 1
 * coefficients. A convolution, so the time goes with a_count times b_count.
 */
void spec_series_multiply(
	const double *a, size_t a_count, const double *b, size_t b_count, double *product);

#endif
