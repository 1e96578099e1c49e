/* Curves made from curves. */
#ifndef SPEC_SPECTRUM_PRODUCT_H
#define SPEC_SPECTRUM_PRODUCT_H

#include "base/error.h"
#include "spectrum/curve.h"
#include "spectrum/grid.h"
#include "spectrum/interpolate.h"

/* The curve at a grid's wavelengths, all its columns and texts. As spec_curve_sample. */
enum spec_status spec_curve_resample(const struct spec_curve *curve,
	const struct spec_grid *grid, enum spec_extrapolate extrapolate,
	struct spec_curve *result, struct spec_error *error);

/* As spec_curve_resample, by a rule. Errors also as spec_weights_check. */
enum spec_status spec_curve_resample_by(enum spec_interpolate rule,
	const struct spec_curve *curve, const struct spec_grid *grid,
	enum spec_extrapolate extrapolate, struct spec_curve *result,
	struct spec_error *error);

/*
 * All columns of a times, over or plus the first of b, at the wavelengths of both that lie
 * in the range that they share; of products and sums that is exact. The title names both,
 * the source both sources.
 * Light times or over a ratio is light, a ratio times or over a ratio a ratio of a's kind;
 * any other quantity and the unit are left open. A sum is what a is, in the unit that both
 * state, or that one does.
 * Errors: the ranges do not meet; b is 0 where a is divided by it (SPEC_ERANGE). To add
 * what is not the same quantity, or has another unit (SPEC_EUSAGE); a quantity that is not
 * stated goes with any, and all kinds of light go together.
 */
enum spec_status spec_curve_multiply(const struct spec_curve *a, const struct spec_curve *b,
	struct spec_curve *result, struct spec_error *error);
enum spec_status spec_curve_divide(const struct spec_curve *a, const struct spec_curve *b,
	struct spec_curve *result, struct spec_error *error);
enum spec_status spec_curve_add(const struct spec_curve *a, const struct spec_curve *b,
	struct spec_curve *result, struct spec_error *error);

#endif
