/*
 * Fewer pixels: one of N x N. Light is averaged; of geometry channels (specexr(5)) that mean
 * is weighted by the cover of their surface, directions are made unit vectors again, and of
 * whole numbers the one that most of the surface has is taken.
 */
#ifndef SPEC_IMAGE_REDUCE_H
#define SPEC_IMAGE_REDUCE_H

#include <stddef.h>

#include "base/error.h"
#include "image/image.h"
#include "image/reader.h"

enum spec_reduce_kind {
	SPEC_REDUCE_PLAIN,    /* a mean, which is not made here */
	SPEC_REDUCE_WEIGHTED, /* a mean weighted by cover */
	SPEC_REDUCE_VECTOR,   /* a component of such a mean, of unit length */
	SPEC_REDUCE_NUMBER    /* the most frequent, by cover */
};

struct spec_reduce_channel {
	enum spec_reduce_kind kind;
	size_t source[3]; /* of the input: the channel, or a vector's three */
	int component;    /* 0..2, of a vector */
	size_t cover;     /* of the input, or SPEC_LAYERS_NONE: 1 everywhere */
};

struct spec_reduce {
	int n;
	struct spec_reduce_channel *channel; /* of the output */
	size_t scratch_bytes;                /* that spec_reduce_row needs */
};

/*
 * How each foreign channel of an indexed image, the output, is made of those of the input by
 * their names; wanted: the input's channels that are read are marked. SPEC_ENOMEM.
 */
enum spec_status spec_reduce_plan(struct spec_reduce *reduce,
	const struct spec_image *image, const struct spec_image *input, int n,
	unsigned char *wanted, struct spec_error *error);
void spec_reduce_free(struct spec_reduce *reduce);

/*
 * One line of a channel that is not PLAIN: width pixels, from lines y .. y + n - 1 of the
 * input from its column x on. Pixels of no cover count nothing, and where there are no
 * others the result is 0.
 */
void spec_reduce_row(const struct spec_reduce *reduce, const struct spec_decoder *decoder,
	size_t channel, int y, size_t x, size_t width, float *to, void *scratch);

#endif
