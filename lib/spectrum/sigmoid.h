/*
 * A sigmoid of a quadratic polynomial of the wavelength,
 *     scale * S(c0 l^2 + c1 l + c2),  S(x) = 1/2 + x / (2 sqrt(1 + x^2)),  l in nm,
 * smooth, and between 0 and scale at every wavelength: the spectra that stand for colours.
 * Source: Jakob, Hanika: A low-dimensional function space for efficient spectral
 *         upsampling. Computer Graphics Forum 38 (2), 2019, 147-155.
 */
#ifndef SPEC_SPECTRUM_SIGMOID_H
#define SPEC_SPECTRUM_SIGMOID_H

#include <math.h>
#include <stddef.h>

struct spec_sigmoid {
	double scale;
	double c0_per_nm2, c1_per_nm;
	double c2; /* an infinity where the spectrum is 0 or scale everywhere */
};

/*
 * S(x), in a form that keeps its digits near 0 and gives 0 and 1 at the infinities. Half
 * of 1 + x/r is ((r + x)/r)/2, and (r + x)(r - x) = 1.
 */
static inline double
spec_sigmoid_of(double x)
{
	double r = sqrt(1 + x * x), tail = .5 / (r * (r + fabs(x)));

	return x < 0 ? tail : 1 - tail;
}

/* The spectrum at count wavelengths [nm], finite. */
void spec_sigmoid_sample(const struct spec_sigmoid *sigmoid, const double *wavelength_nm,
	size_t count, double *value);

/*
 * Its means over bins, the i-th from edges_nm[i] to edges_nm[i + 1], ascending: within
 * 1e-6 scale of the exact ones in bins up to 1000 nm wide, and never outside [0, scale].
 */
void spec_sigmoid_mean(const struct spec_sigmoid *sigmoid, const double *edges_nm,
	size_t bins, double *value);

/*
 * How many equal pieces of a bin of that width [nm], none wider than widest_nm, do for the
 * accuracy of the means, the polynomial being nearly straight in each: 1 or more.
 */
size_t spec_sigmoid_pieces(
	const struct spec_sigmoid *sigmoid, double bin_nm, double widest_nm);

#endif
