/* specconvert's pictures of surroundings, laid out anew: image/projection.h says how. */
#ifndef SPEC_IMAGE_REPROJECT_H
#define SPEC_IMAGE_REPROJECT_H

#include <stddef.h>

#include "base/error.h"
#include "image/projection.h"
#include "image/reader.h"
#include "image/settings.h"

/*
 * Reads a whole image, whose layout its shape tells, and writes it in another one, of that
 * height or, where height is 0, of like resolution. A pixel is the mean of 16 places in it,
 * at which the image is linear between the pixels' middles; what is beside the faces of a
 * cross is 0. Channels of whole numbers have those of the pixel nearest to the middle. All
 * samples are in memory.
 * Errors (the message names the file): another shape, polarised light, whose frames would turn
 * (SPEC_EUNSUPPORTED); more pixels or samples than the limits (SPEC_ERANGE); those of reading and
 * writing.
 */
enum spec_status spec_reproject_run(struct spec_reader *reader,
	enum spec_projection projection, size_t height,
	const struct spec_settings *settings, unsigned long long *overflows,
	struct spec_error *error);

#endif
