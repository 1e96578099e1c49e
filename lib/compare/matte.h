/*
 * A matte, or mask: how much of the second image shows in each pixel. It is a channel of the
 * first image or of another one, or 1 where a channel of whole numbers has a certain value.
 */
#ifndef SPEC_COMPARE_MATTE_H
#define SPEC_COMPARE_MATTE_H

#include <stdint.h>

#include "base/error.h"
#include "image/image.h"

struct spec_matte {
	char *path;    /* of the image it is in; null: the first of those that are mixed */
	char *channel; /* null: it is not chosen yet */
	int equals;    /* 1 where the channel is number, else 0 */
	uint32_t number;
};

/*
 * What a text means, the first of these that fits: "NAME" or "NAME=N" with a channel of the
 * image, "FILE", "FILE:NAME" and "FILE:NAME=N" with a file that is there, or "-" for it.
 * name: the image's file, for messages. Error (SPEC_EUSAGE): none of them.
 */
enum spec_status spec_matte_read(struct spec_matte *mask, const char *text,
	const struct spec_image *image, const char *name, struct spec_error *error);

/*
 * Sees that the channel is in the image of path; where none was named it is the only one, A,
 * or Y. Errors (SPEC_EUSAGE): it is not, none of these is, "=N" of a channel of no whole
 * numbers.
 */
enum spec_status spec_matte_settle(struct spec_matte *mask, const struct spec_image *image,
	const char *name, struct spec_error *error);

void spec_matte_free(struct spec_matte *mask);

#endif
