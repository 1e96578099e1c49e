/* Means of curves over bins. */
#ifndef SPEC_SPECTRUM_MEAN_H
#define SPEC_SPECTRUM_MEAN_H

#include <stddef.h>

#include "base/error.h"
#include "spectrum/curve.h"

/*
 * The means over bins of one column of a curve that is linear between its samples: its
 * integral over the bin, by trapezoids at the samples and the bin's edges and so exact to
 * rounding, over the bin's width. Takes time in proportion to the bins and the samples
 * that they span.
 * Given:    column       0..columns-1
 *           extrapolate  what the curve is outside its data, as in spec_curve_sample. A
 *                        curve of one sample has no width: only under
 *                        SPEC_EXTRAPOLATE_CONSTANT can its mean differ from 0.
 *           edges_nm     bins + 1, finite and ascending; the i-th bin reaches from
 *                        edges_nm[i] to edges_nm[i + 1]
 * Returned: value        bins means, in the curve's unit; none leaves the range of what
 *                        the curve is in its bin
 * Errors:   SPEC_ERANGE  edges that are not finite and ascending, and what
 *                        spec_curve_sample refuses at the outermost ones; what value then
 *                        holds is undefined
 */
enum spec_status spec_curve_mean(const struct spec_curve *curve, size_t column,
	enum spec_extrapolate extrapolate, const double *edges_nm, size_t bins,
	double *value, struct spec_error *error);

#endif
