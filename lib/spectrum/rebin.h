/*
 * Bins: the stretches of the spectrum that bands stand for. A change of bins that keeps the
 * energy gives each new bin what the old ones have where they overlap.
 */
#ifndef SPEC_SPECTRUM_REBIN_H
#define SPEC_SPECTRUM_REBIN_H

#include <stddef.h>

#include "base/error.h"
#include "spectrum/curve.h"
#include "spectrum/grid.h"

/*
 * The edges of bins that meet half-way between count ascending wavelengths; the outer ones
 * reach as far out as in. Of one wavelength the bin is 1 nm wide. edges_nm: room for
 * count + 1.
 */
void spec_bins_halfway(const double *wavelength_nm, size_t count, double *edges_nm);

/* Part of a bin that lies in another. */
struct spec_overlap {
	size_t first, count; /* old bins that the new one meets */
	double below_nm;     /* how much of it lies below the first */
	double above_nm;     /* and above the last */
};

/* Which of bins old bins, whose ascending edges are given, a bin from low to high meets. */
struct spec_overlap spec_bins_overlap(
	const double *edges_nm, size_t bins, double low_nm, double high_nm);

/* The length [nm] that low..high shares with old bin i. */
double spec_bins_shared(const double *edges_nm, size_t i, double low_nm, double high_nm);

/* "380..390 nm and 700..720 nm": what of low..high lies outside; "" where nothing does. */
void spec_bins_describe_outside(char *text, size_t size, double first_nm, double last_nm,
	double low_nm, double high_nm);

/*
 * What of a grid, or with rebin of its bins (edges_nm as below), lies outside a curve, or
 * outside the bins that its samples are taken for; as spec_bins_describe_outside.
 */
void spec_curve_describe_outside(const struct spec_curve *curve,
	const struct spec_grid *grid, const double *edges_nm, int rebin, char *text,
	size_t size);

/*
 * The curve as means over the bins of a grid: edges_nm has one more than the grid; null:
 * they meet half-way as spec_bins_halfway has them. So do those that the samples are taken
 * for. All columns and texts. The integral over the range of both is kept. The part of a
 * bin outside counts as 0, or, under SPEC_EXTRAPOLATE_CONSTANT, as the end's value. Error
 * (SPEC_ERANGE): a bin that lies outside as a whole, under SPEC_EXTRAPOLATE_REFUSE.
 */
enum spec_status spec_curve_rebin(const struct spec_curve *curve,
	const struct spec_grid *grid, const double *edges_nm,
	enum spec_extrapolate extrapolate, struct spec_curve *result,
	struct spec_error *error);

#endif
