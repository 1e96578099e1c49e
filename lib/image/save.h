/* An image that a tool makes, line by line, becomes the file that its user named. */
#ifndef SPEC_IMAGE_SAVE_H
#define SPEC_IMAGE_SAVE_H

#include "base/error.h"
#include "image/image.h"
#include "image/settings.h"
#include "image/stream.h"

/*
 * Opens the settings' output, runs the stream into it and commits; after an error nothing
 * is left behind. image: the output's header, indexed. stream->writer is filled in here.
 * *overflows: finite samples that became infinite as HALF.
 */
enum spec_status spec_image_save(const struct spec_image *image, struct spec_stream *stream,
	const struct spec_settings *settings, unsigned long long *overflows,
	struct spec_error *error);

#endif
