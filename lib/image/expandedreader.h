/* Readers of images in other representations, for reader.c alone. */
#ifndef SPEC_IMAGE_EXPANDEDREADER_H
#define SPEC_IMAGE_EXPANDEDREADER_H

#include "base/error.h"
#include "image/reading.h"
#include "image/represented.h"

extern const struct spec_reading_format spec_reading_expanded;

/*
 * Puts a reader that gives bands in front of *reader, which holds what represented says.
 * After an error *reader is as it was. Errors: SPEC_EFORMAT, channels are missing;
 * SPEC_ERANGE; SPEC_ENOMEM.
 */
enum spec_status spec_expanded_open(struct spec_reader **reader,
	const struct spec_represented *represented, struct spec_error *error);

#endif
