/* Inside reader.c, fetch.c and decode.c alone: what readers and decoders hold. */
#ifndef SPEC_IMAGE_READING_H
#define SPEC_IMAGE_READING_H

#include <libdeflate.h>
#include <openexr.h>

#include "base/source.h"
#include "image/reader.h"

struct spec_reader {
	exr_context_t context;
	struct spec_source source;
	struct spec_image image;
	struct spec_limits limits;
	int part;
	int tiled, tiles_across, tile_width;
	int chunk_lines;
	size_t line_bytes;
	size_t *offset; /* of each channel in a stored line */
	/* The last chunk taken from a pipe, kept where the next block needs it too. */
	exr_chunk_info_t kept_info;
	unsigned char *kept;
	size_t kept_room;
	int kept_valid;
};

/* A chunk as it was taken from the file. */
struct spec_fetched {
	exr_chunk_info_t info;
	size_t at; /* in packed */
};

struct spec_buffer {
	unsigned char *bytes;
	size_t room;
};

struct spec_decoder {
	struct spec_reader *reader;
	unsigned char *wanted;
	exr_decode_pipeline_t pipeline;
	int started;
	struct libdeflate_decompressor *decompressor;
	struct spec_buffer packed, unpacked, tile, converted;
	struct spec_fetched *chunk;
	size_t chunks, chunk_room;
	const unsigned char **line; /* where each line of the block begins */
	size_t line_room;
	float **row; /* [lines][channels]; null where not wanted */
	size_t row_room;
	int y0, lines;
};

static inline size_t
spec_reading_align(size_t size)
{
	return (size + 63) / 64 * 64; /* a cache line, and the widest vector */
}

/* Grows a buffer to at least size bytes, keeping the first kept ones. */
enum spec_status spec_reading_reserve(
	struct spec_buffer *buffer, size_t size, size_t kept, struct spec_error *error);

/* The first line of the chunk that line y is stored in. */
int spec_reading_chunk_start(const struct spec_reader *reader, int y);

#endif
