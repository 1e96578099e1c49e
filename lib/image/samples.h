/*
 * How many samples a renderer took in each pixel: the attribute spec:samples, an int of at
 * least 1; see specexr(5).
 */
#ifndef SPEC_IMAGE_SAMPLES_H
#define SPEC_IMAGE_SAMPLES_H

#include "base/error.h"
#include "image/image.h"

/*
 * *samples: 0 where the image does not say. name: the file, for messages. Error
 * (SPEC_EFORMAT): the attribute is no int, or one below 1.
 */
enum spec_status spec_samples_get(const struct spec_image *image, long long *samples,
	const char *name, struct spec_error *error);

/*
 * samples: 0 removes the attribute. Error (SPEC_ERANGE): more than an int can hold. name: the
 * file, for messages.
 */
enum spec_status spec_samples_set(struct spec_image *image, long long samples,
	const char *name, struct spec_error *error);

#endif
