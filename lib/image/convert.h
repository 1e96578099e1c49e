/*
 * specconvert's work on images: every line of the output is a weighted sum of
 * channels of the input, the weights fixed beforehand.
 */
#ifndef SPEC_IMAGE_CONVERT_H
#define SPEC_IMAGE_CONVERT_H

#include <stddef.h>

#include "base/error.h"
#include "image/image.h"
#include "image/reader.h"
#include "image/settings.h"
#include "spectrum/curve.h"
#include "spectrum/grid.h"

struct spec_convert_setup {
	int has_crop;
	struct spec_window crop;       /* in pixels of the data window: 0,0 is its corner */
	int downsample;                /* mean of N x N pixels; 1: as it is */
	const struct spec_grid *grid;  /* linear between the bands; or null */
	const struct spec_grid *bands; /* bands to keep, as they are; or null */
	const struct spec_curve *multiply; /* curves, by their first column */
	size_t multiplies;
	const struct spec_curve *illuminate; /* T times this becomes S0; or null */
	enum spec_extrapolate extrapolate;   /* of curves and of the grid */
	double scale;
	int half; /* bands are stored as HALF */
};

struct spec_convert {
	struct spec_image image; /* the output's, indexed */
	const struct spec_image *input;
	size_t *first;   /* [channels + 1]: where each channel's terms begin */
	size_t *channel; /* of the input, per term */
	double *weight;
	size_t terms, channel_room, weight_room;
	unsigned char *wanted; /* per channel of the input */
	int x0, y0;            /* the crop's corner in the input's data window */
	int downsample;
};

/*
 * Works out the output's header and the weights. Errors: a crop outside the image
 * or empty (SPEC_ERANGE), sizes that downsample does not divide, a wavelength
 * outside the bands or a curve (SPEC_ERANGE), a band that is not there,
 * --illuminate on an emissive image, a change of grid of a bispectral image.
 */
enum spec_status spec_convert_plan(struct spec_convert *convert,
	const struct spec_image *input, const struct spec_convert_setup *setup,
	const char *name, struct spec_error *error);
void spec_convert_free(struct spec_convert *convert);

/* Reads all lines, converts and writes them to the settings' output; as spec_image_save. */
enum spec_status spec_convert_run(struct spec_convert *convert, struct spec_reader *reader,
	const struct spec_settings *settings, unsigned long long *overflows,
	struct spec_error *error);

#endif
