/* Between curves and images: a chart of patches from curves, curves from pixels. */
#ifndef SPEC_IMAGE_PATCHES_H
#define SPEC_IMAGE_PATCHES_H

#include "base/error.h"
#include "image/image.h"
#include "image/reader.h"
#include "image/settings.h"
#include "spectrum/curve.h"
#include "spectrum/grid.h"

#define SPEC_PATCHES_MOST_PIXELS 4096 /* columns of a text made from an image */

struct spec_patches_setup {
	int columns, rows;
	int patch; /* side of a patch, in pixels */
	int gap;   /* black pixels between and around patches */
	const struct spec_grid *grid;
	enum spec_extrapolate extrapolate;
	int half;
};

/*
 * The header of a chart: reflective where the first curve's quantity is one of reflectance
 * or transmittance, else emissive. Error: no room for all curves, or curves of both kinds,
 * or of neither light (or no quantity) nor reflectance nor transmittance.
 */
enum spec_status spec_patches_image(struct spec_image *image,
	const struct spec_curve *curve, size_t curves,
	const struct spec_patches_setup *setup, struct spec_error *error);

/* How many patches the curves make: one for each column. */
size_t spec_patches_count(const struct spec_curve *curve, size_t curves);

/*
 * Writes the chart: each column of each curve at the grid's wavelengths, by rows. Output
 * and *overflows as spec_image_save's.
 */
enum spec_status spec_patches_write(const struct spec_image *image,
	const struct spec_curve *curve, size_t curves,
	const struct spec_patches_setup *setup, const struct spec_settings *settings,
	unsigned long long *overflows, struct spec_error *error);

/*
 * Every pixel of an image as a column of one curve, named x<X>y<Y> by its place in
 * the data window. Errors: no bands; more than SPEC_PATCHES_MOST_PIXELS pixels.
 */
enum spec_status spec_patches_curve(
	struct spec_reader *reader, struct spec_curve *curve, struct spec_error *error);

/* The shortest decimal that reads back as the same float: 0.1, not 0.10000000149. */
double spec_patches_shortest(float value);

#endif
