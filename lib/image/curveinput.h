/*
 * Where specconvert's curves come from: files and names, colours, and pictures that hold
 * curves, drawn as a plot or packed in an atlas.
 */
#ifndef SPEC_IMAGE_CURVEINPUT_H
#define SPEC_IMAGE_CURVEINPUT_H

#include "base/error.h"
#include "image/fromrgb.h"
#include "image/settings.h"
#include "image/trace.h"
#include "spectrum/curve.h"
#include "spectrum/reshape.h"

struct spec_curve_input {
	int from_rgb, has_use;             /* --from-rgb and --as were given */
	struct spec_fromrgb_setup colours; /* what becomes of colours, also of an image's */
	int from_plot, has_ink;            /* --from-plot and --ink were given */
	struct spec_trace_axes axes;
	double ink[3], paper[3]; /* encoded, in [0, 1] */
	const char *row;         /* of an atlas, or null */
};

/* No option given: files and names; the paper is white. */
void spec_curve_input_init(struct spec_curve_input *input);

/*
 * Takes from-rgb, as, from-plot, ink, paper or row, by its long name; of others *known is 0.
 * Errors (SPEC_EUSAGE, SPEC_ERANGE): a value that is none.
 */
enum spec_status spec_curve_input_take(struct spec_curve_input *input, const char *name,
	const char *value, int *known, struct spec_error *error);

/*
 * Once all options are taken: what colours become where --as does not say it. The grid and
 * half of the colours are left to the caller. SPEC_EUSAGE: options that do not go together.
 */
enum spec_status spec_curve_input_settle(
	struct spec_curve_input *input, struct spec_error *error);

/* Whether curves come out of images, whatever their names look like. */
int spec_curve_input_is_image(const struct spec_curve_input *input);

/*
 * The curve of one operand, after all that reshape says. settings: how images are read.
 * Errors: SPEC_EUSAGE, no colour where one is wanted; those of spec_colour_curve,
 * spec_reader_open, spec_atlas_curve, spec_trace_curve and spec_reshape_curve. Then curve is
 * empty.
 */
enum spec_status spec_curve_input_load(const struct spec_curve_input *input,
	const char *name, const struct spec_reshape *reshape,
	const struct spec_settings *settings, struct spec_curve *curve,
	struct spec_reshape_notes *notes, struct spec_error *error);

#endif
