/*
 * Spectra for RGB colours that are weighted sums of tabulated spectra: sum of weight[k]
 * times the k-th column of a curve from spectra/upsampling. They go on beyond the table
 * with the values at its ends.
 */
#ifndef SPEC_COLOUR_BASIS_H
#define SPEC_COLOUR_BASIS_H

#include <stddef.h>

#include "base/error.h"
#include "spectrum/curve.h"

/*
 * Mallett and Yuksel's basis: the weights are the linear sRGB components themselves. Under
 * D65 a spectrum has its colour, exactly by sums over the table's 5 nm, and within a
 * DeltaE2000 of 0.07 by sums over 1 nm; the three add to 1 and lie in [0, 1], so colours
 * in [0, 1] have reflectances in [0, 1].
 * Source: Mallett, Yuksel: Spectral primary decomposition for rendering with sRGB
 *         reflectance. Eurographics Symposium on Rendering, 2019.
 */
#define SPEC_MALLETT_SPECTRUM "upsampling/mallett-yuksel"
#define SPEC_MALLETT_COLUMNS 3

/*
 * Reads the spectrum of that name. Errors: SPEC_EFORMAT where it has another number of
 * columns; those of spec_lookup_curve.
 */
enum spec_status spec_basis_load(const char *name, size_t columns, struct spec_curve *basis,
	struct spec_error *error);

/* The sum at count wavelengths [nm]. Error: SPEC_ERANGE, a wavelength that is NaN. */
enum spec_status spec_basis_sample(const struct spec_curve *basis, const double *weight,
	const double *wavelength_nm, size_t count, double *value, struct spec_error *error);

/*
 * Its means over bins, the i-th from edges_nm[i] to edges_nm[i + 1]: exact. Errors: those
 * of spec_curve_mean for the edges; SPEC_ENOMEM.
 */
enum spec_status spec_basis_mean(const struct spec_curve *basis, const double *weight,
	const double *edges_nm, size_t bins, double *value, struct spec_error *error);

#endif
