/*
 * What a false colour shows of an image: a number for each pixel, worked out from its
 * channels, or a vector, whose three components are red, green and blue.
 */
#ifndef SPEC_COMPARE_VIEW_H
#define SPEC_COMPARE_VIEW_H

#include <stddef.h>

#include "base/error.h"
#include "compare/program.h"
#include "image/image.h"
#include "image/layer.h"
#include "image/reader.h"
#include "image/rgb.h"
#include "spectrum/curve.h"

/*
 * What Stokes components (S0, S1, S2, S3) tell of a pixel:
 *   dop          degree of polarisation             sqrt(S1^2 + S2^2 + S3^2) / S0
 *   dolp         of linear polarisation             sqrt(S1^2 + S2^2) / S0
 *   docp         of circular polarisation           |S3| / S0
 *   aop          angle of linear polarisation       atan2(S2, S1) / 2 [deg], 0 up to 180
 *   ellipticity  atan2(S3, sqrt(S1^2 + S2^2)) / 2 [deg], -45 to 45, with the sign of S3
 * What has no value, such as the angle of light that is not polarised, is NaN.
 * Source: M. Born, E. Wolf: Principles of Optics, 7th edition 1999, sections 1.4.2 and 10.9.
 */
struct spec_stokes_number {
	const char *name;
	const char *label; /* with its unit */
	double low, high;  /* of its scale */
	const char *map;
	double (*of)(const double stokes[4]);
};

/* Error (SPEC_EUSAGE): another name. */
const struct spec_stokes_number *spec_stokes_find(
	const char *name, struct spec_error *error);

struct spec_view_setup {
	/* The first of these that is not null, else the band alone. */
	const struct spec_stokes_number *polarisation;
	const char *expression;         /* of compare/expression.h, on one image */
	const struct spec_layer *layer; /* of channels, not of bands */
	/*
	 * The band of an expression's "a" and "nm", and of polarisation; 0: none, and the
	 * Stokes components are those of the light that the observer sees, weighted by its y.
	 */
	double band_nm;
	const struct spec_curve *observer; /* of polarisation */
};

struct spec_view {
	size_t numbers;   /* of a pixel: 1 or 3 */
	char label[128];  /* what the number is */
	const char *map;  /* usual colour map */
	double low, high; /* usual scale; equal: its own least and largest value */
	size_t terms;     /* channels that are read */
	size_t *channel;  /* [terms] */

	const struct spec_stokes_number *polarisation; /* or null */
	struct spec_rgb intensity, rest; /* its sums: S0, 0, 0 and S1, S2, S3 */
	struct spec_program program;     /* of an expression or a band */
	const struct spec_image *image;
};

/*
 * image: indexed; name: its file, for messages; both must live as long. Errors: an
 * expression that is none, or not of this image, with the place in it; a band that is not
 * there; no Stokes components; those of spec_observer_weights.
 */
enum spec_status spec_view_make(struct spec_view *view, const struct spec_image *image,
	const char *name, const struct spec_view_setup *setup, struct spec_error *error);
void spec_view_free(struct spec_view *view);

/* Bytes of scratch that a row of so many pixels needs, aligned to 64. */
size_t spec_view_scratch(const struct spec_view *view, size_t width);

/*
 * The numbers of one row, width floats for each component. row: the samples of each of
 * view->channel. y: the row's number from the data window's corner.
 */
void spec_view_row(const struct spec_view *view, const float *const *row, size_t width,
	int y, void *scratch, float *to);

#endif
