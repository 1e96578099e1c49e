/*
 * What specfilm and specdisc share: an image whose bands of light get light added to them,
 * and lose the layers that it was made of; everything else passes through.
 */
#ifndef SPEC_IMAGE_RELIGHT_H
#define SPEC_IMAGE_RELIGHT_H

#include "base/error.h"
#include "image/image.h"
#include "image/layers.h"
#include "image/reader.h"
#include "image/stream.h"

struct spec_relight {
	const struct spec_image *input;
	struct spec_image image; /* the output's header, indexed */
	size_t *origin;          /* of each channel of the output: the input's */
	size_t *band; /* of each channel of the output: S0's band, or SPEC_LAYERS_NONE */
	unsigned char *wanted; /* of each channel of the input: it is read */
};

/*
 * goes: which channels go, or null: none. half: bands are stored
 * as HALF. A preview goes too, for it would show the old values. The input must be
 * emissive. name: the file, for messages.
 */
enum spec_status spec_relight_plan(struct spec_relight *relight,
	const struct spec_image *input, int (*goes)(const struct spec_channel *channel),
	int half, const char *name, struct spec_error *error);
void spec_relight_free(struct spec_relight *relight);

/* Marks a channel of the input as wanted; SPEC_LAYERS_NONE is allowed. */
void spec_relight_want(struct spec_relight *relight, size_t channel);

/* A channel's samples in line y, or null for SPEC_LAYERS_NONE. */
static inline const float *
spec_relight_row(const struct spec_decoder *decoder, int y, size_t channel)
{
	return channel == SPEC_LAYERS_NONE ? NULL : spec_decoder_row(decoder, y, channel);
}

/* Copies what gets no light: line y of the input into the planes of a line of the output. */
void spec_relight_copy(const struct spec_relight *relight,
	const struct spec_decoder *decoder, int y, float *const *plane);

/*
 * The stream from the reader of the input to the output, for spec_image_save: line by line,
 * of the channels that are wanted. The caller adds kernel, state and scratch_bytes; relight
 * must live as long as it.
 */
struct spec_stream spec_relight_stream(
	const struct spec_relight *relight, struct spec_reader *reader);

#endif
