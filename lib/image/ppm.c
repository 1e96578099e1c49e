/* PPM, binary (netpbm's ppm(5)): a line of text, then the samples, big-endian. */
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "base/memory.h"
#include "base/vector.h"
#include "image/encoder.h"

#define BUFFER_BYTES (1 << 20) /* rows are gathered: few large writes */

struct state {
	size_t used;
	unsigned char buffer[BUFFER_BYTES];
};

static enum spec_status
flush(struct spec_picture *picture, struct spec_error *error)
{
	struct state *state = picture->state;
	size_t used = state->used;

	state->used = 0;
	return spec_output_write(picture->output, state->buffer, used, error);
}

static enum spec_status
open_ppm(struct spec_picture *picture, struct spec_error *error)
{
	struct state *state = spec_memory_new(1, sizeof *state, "pictures", error);

	picture->state = state;
	if (!state)
		return SPEC_ENOMEM;
	state->used = (size_t)snprintf((char *)state->buffer, BUFFER_BYTES,
		"P6\n%zu %zu\n%d\n", picture->width, picture->height,
		picture->kind.sample == SPEC_PICTURE_U16 ? 65535 : 255);
	return SPEC_OK;
}

SPEC_VECTORISED static void
put_words(unsigned char *restrict to, const unsigned char *restrict from, size_t words)
{
	for (size_t i = 0; i < words; i++) {
		uint16_t word;

		memcpy(&word, from + 2 * i, sizeof word);
		word = (uint16_t)(word << 8 | word >> 8);
		memcpy(to + 2 * i, &word, sizeof word);
	}
}

static enum spec_status
write_ppm(struct spec_picture *picture, const void *rows, size_t count,
	struct spec_error *error)
{
	struct state *state = picture->state;
	const unsigned char *byte = rows;
	int wide = picture->kind.sample == SPEC_PICTURE_U16;
	size_t left = count * picture->width * 3 * (wide ? 2 : 1);

	while (left > 0) {
		/* Even, so that a word is never split. */
		size_t room = (BUFFER_BYTES - state->used) & ~(size_t)1;
		size_t bytes = left < room ? left : room;
		enum spec_status status = SPEC_OK;

		if (wide)
			put_words(state->buffer + state->used, byte, bytes / 2);
		else
			memcpy(state->buffer + state->used, byte, bytes);
		state->used += bytes;
		byte += bytes;
		left -= bytes;
		if (state->used + 1 >= BUFFER_BYTES)
			status = flush(picture, error);
		if (status != SPEC_OK)
			return status;
	}
	return SPEC_OK;
}

static void
close_ppm(struct spec_picture *picture)
{
	free(picture->state);
}

const struct spec_picture_encoder spec_picture_encoder_ppm = {
	open_ppm, write_ppm, flush, close_ppm};
