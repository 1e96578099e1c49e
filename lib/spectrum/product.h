/* Curves made from curves. */
#ifndef SPEC_SPECTRUM_PRODUCT_H
#define SPEC_SPECTRUM_PRODUCT_H

#include "base/error.h"
#include "spectrum/curve.h"
#include "spectrum/grid.h"

/* The curve at a grid's wavelengths, all its columns and texts. As spec_curve_sample. */
enum spec_status spec_curve_resample(const struct spec_curve *curve,
	const struct spec_grid *grid, enum spec_extrapolate extrapolate,
	struct spec_curve *result, struct spec_error *error);

/*
 * All columns of a times the first of b, at the wavelengths of both that lie in the
 * range that they share; there it is exact. The title names both, the source both
 * sources. Light times a ratio is light, a ratio times a ratio a ratio of a's kind; the
 * unit and any other quantity are left open. Error (SPEC_ERANGE): the ranges do not
 * meet.
 */
enum spec_status spec_curve_multiply(const struct spec_curve *a, const struct spec_curve *b,
	struct spec_curve *result, struct spec_error *error);

#endif
