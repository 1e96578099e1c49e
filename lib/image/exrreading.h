/* Inside exrreader.c, exrfetch.c and exrdecode.c alone: OpenEXR's readers and decoders. */
#ifndef SPEC_IMAGE_EXRREADING_H
#define SPEC_IMAGE_EXRREADING_H

#include <libdeflate.h>
#include <openexr.h>

#include "image/reading.h"

struct exr_reader {
	struct spec_reader base;
	exr_context_t context;
	int part;
	int tiled, tiles_across, tile_width;
	size_t *offset; /* of each channel in a stored line */
	/* The last chunk taken from a pipe, kept where the next block needs it too. */
	exr_chunk_info_t kept_info;
	unsigned char *kept;
	size_t kept_room;
	int kept_valid;
};

/* A chunk as it was taken from the file. */
struct exr_fetched {
	exr_chunk_info_t info;
	size_t at; /* in packed */
};

struct exr_decoder {
	struct spec_decoder base;
	exr_decode_pipeline_t pipeline;
	int started;
	struct libdeflate_decompressor *decompressor;
	struct spec_buffer unpacked, tile;
	struct exr_fetched *chunk;
	size_t chunks, chunk_room;
	const unsigned char **line; /* where each line of the block begins */
	size_t line_room;
};

static inline struct exr_reader *
exr_reader_of(const struct exr_decoder *decoder)
{
	return (struct exr_reader *)decoder->base.reader;
}

/* The first line of the chunk that line y is stored in. */
static inline int
exr_chunk_start(const struct exr_reader *reader, int y)
{
	int y0 = reader->base.image.data.y0;

	return y0 + (y - y0) / reader->base.chunk_lines * reader->base.chunk_lines;
}

/* The functions of spec_reading_exr that exrfetch.c and exrdecode.c hold. */
enum spec_status exr_fetch(struct spec_decoder *decoder, struct spec_error *error);
enum spec_status exr_open_decoder(struct spec_decoder *decoder, struct spec_error *error);
void exr_close_decoder(struct spec_decoder *decoder);
enum spec_status exr_decode(struct spec_decoder *decoder, struct spec_error *error);

#endif
