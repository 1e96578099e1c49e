/* One layer of an image by its name: what its channels of that prefix are. */
#ifndef SPEC_IMAGE_LAYER_H
#define SPEC_IMAGE_LAYER_H

#include <stddef.h>

#include "base/error.h"
#include "image/image.h"

enum spec_layer_kind {
	SPEC_LAYER_BANDS,  /* NAME.S0.550,000000nm and so on */
	SPEC_LAYER_VECTOR, /* NAME.X, NAME.Y, NAME.Z */
	SPEC_LAYER_PLANE,  /* of the name uv, or PREFIX.uv: the channels u and v */
	SPEC_LAYER_CHANNEL /* a channel of that name */
};

struct spec_layer {
	enum spec_layer_kind kind;
	size_t channel[3]; /* of VECTOR three, of PLANE two, of CHANNEL one */
	const char *base;  /* the name behind its last point, such as "N" of "film1.N" */
};

/*
 * Finds a layer of an indexed image. Where it is of bands, chosen becomes a copy of the
 * image, with the same channels in the same order, whose bands are the layer's;
 * spec_image_clear it. name: the file, for messages; layer must live as long as the result.
 * Errors: SPEC_EUSAGE: no such layer, those that there are in the message; SPEC_EFORMAT: bands
 * that make no image, as spec_image_index has it; SPEC_ENOMEM.
 */
enum spec_status spec_layer_find(struct spec_layer *result, const struct spec_image *image,
	const char *name, const char *layer, struct spec_image *chosen,
	struct spec_error *error);

#endif
