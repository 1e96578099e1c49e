/*
 * Variances of bands that are means of random samples: channels "variance.NAME" beside the
 * bands NAME; see specexr(5).
 */
#ifndef SPEC_IMAGE_VARIANCES_H
#define SPEC_IMAGE_VARIANCES_H

#include <stddef.h>

#include "base/error.h"
#include "image/image.h"

#define SPEC_VARIANCES_PREFIX "variance."

/* Whether a channel is one. */
int spec_variances_is_one(const struct spec_channel *channel);

int spec_variances_has_some(const struct spec_image *image);

/* That of the channel of a band, in an indexed image; channels: there is none. */
size_t spec_variances_find(const struct spec_image *image, size_t band_channel);

/* Whether there is one of every band, diagonal or not. An image without bands has none. */
int spec_variances_are_whole(const struct spec_image *image);

/*
 * Removes all of an indexed image and, if so wanted, adds one of each band, by the bands'
 * names. It is indexed again. name: the file, for messages. Errors: those of
 * spec_image_index.
 */
enum spec_status spec_variances_renew(
	struct spec_image *image, int wanted, const char *name, struct spec_error *error);

#endif
