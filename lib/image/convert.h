/*
 * specconvert's work on images: every line of the output is a weighted sum of channels of
 * the input, the weights fixed beforehand; powers and bounds are taken of the sums.
 */
#ifndef SPEC_IMAGE_CONVERT_H
#define SPEC_IMAGE_CONVERT_H

#include <stdatomic.h>
#include <stddef.h>

#include "base/error.h"
#include "image/image.h"
#include "image/reader.h"
#include "image/reduce.h"
#include "image/settings.h"
#include "spectrum/air.h"
#include "spectrum/curve.h"
#include "spectrum/grid.h"
#include "spectrum/interpolate.h"
#include "spectrum/operation.h"

/* What values that are densities, or their integrals over bands, are to be. */
enum spec_convert_per { SPEC_CONVERT_AS_IT_IS, SPEC_CONVERT_PER_NM, SPEC_CONVERT_PER_BAND };

struct spec_convert_setup {
	int has_crop;
	struct spec_window crop; /* in pixels of the data window: 0,0 is its corner */
	int downsample;          /* mean of N x N pixels; 1: as it is */
	enum spec_medium medium; /* wavelengths become those in it; unknown: they stay */
	const struct spec_grid *grid; /* new bands, or null */
	const double *edges_nm;       /* of its bins, for rebin; null: they meet half-way */
	const struct spec_grid *bands; /* bands to keep, as they are; or null */
	enum spec_interpolate interpolation;
	int rebin; /* the grid's bins get the energy of the bins there are */
	enum spec_convert_per per;
	const struct spec_operation *operation; /* on each band, in this order */
	size_t operations;
	double least; /* of the most light: a reflectance under less is not known */
	int bands_only;
	enum spec_extrapolate extrapolate; /* of curves and of the grid */
	int half;                          /* bands are stored as HALF */
};

#define SPEC_CONVERT_MOST_NOTES 4

/* Warnings for the user, a line each. */
struct spec_convert_notes {
	size_t count;
	char text[SPEC_CONVERT_MOST_NOTES][640];
};

/* What is done to a sum that no weight can do. */
struct spec_convert_step {
	int raises; /* to the power; else it is bound to low..high */
	double power, low, high;
};

struct spec_convert {
	struct spec_image image; /* the output's, indexed */
	const struct spec_image *input;
	struct spec_convert_notes notes;
	size_t *first;   /* [channels + 1]: where each channel's terms begin */
	size_t *channel; /* of the input, per term */
	double *weight;
	double *offset; /* [channels] what is added to the sum */
	size_t terms, channel_room, weight_room;
	/* What follows the sum: powers and bounds, each with a factor and an addend after it. */
	struct spec_convert_step *step; /* [steps] */
	size_t steps;
	double *after;          /* [channels * steps * 2] */
	unsigned char *stepped; /* per channel of the output: it has these steps */
	unsigned char *wanted;  /* per channel of the input */
	int x0, y0;             /* the crop's corner in the input's data window */
	int downsample;
	struct spec_reduce reduce; /* where downsample > 1 */
	atomic_ullong spoiled;     /* finite sums that a power made NaN or infinite */
};

/*
 * Works out the output's header, the weights and the notes. Errors: a crop outside the
 * image or empty (SPEC_ERANGE), sizes that downsample does not divide, a wavelength or bin
 * outside the bands or a curve (SPEC_ERANGE), a band that is not there, a curve that is 0
 * and divided by, operations that the image does not allow (SPEC_EUSAGE: light cannot be
 * illuminated, reflectance not be divided by its light, what is not the same not be
 * added; light layers, Stokes components and reradiation allow factors alone), a change of
 * grid of a bispectral image, no band left.
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
