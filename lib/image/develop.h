/* spec2rgb's work: a spectral image becomes a picture, row by row. */
#ifndef SPEC_IMAGE_DEVELOP_H
#define SPEC_IMAGE_DEVELOP_H

#include "base/error.h"
#include "image/look.h"
#include "image/picture.h"
#include "image/reader.h"
#include "image/rgb.h"
#include "image/settings.h"

/* What was seen on the way. */
struct spec_develop {
	long long nonfinite;  /* pixels with a red, green or blue that is not finite */
	int first_x, first_y; /* the first of them, in the data window */
};

/*
 * Reads all lines of an image, sums them by the plan and writes them to a picture
 * of the data window's size. Integer samples are encoded by the space's transfer
 * function and clipped to 0..1; NaN becomes black. Floats stay linear, or are other
 * coordinates of colour, as the space has them. Looks that need the whole picture first
 * use a temporary file: see meter.h.
 * Errors: those of reading, of the picture, of spec_finish_init and of meter.h.
 */
enum spec_status spec_develop_run(struct spec_develop *develop, struct spec_reader *reader,
	const struct spec_rgb *rgb, const struct spec_look *look,
	struct spec_picture *picture, enum spec_picture_sample sample,
	const struct spec_settings *settings, struct spec_error *error);

#endif
