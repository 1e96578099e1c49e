/* Decoding what was fetched: decompressing, ordering and converting lines. */
#include <stdlib.h>
#include <string.h>

#include "base/memory.h"
#include "image/codec.h"
#include "image/exr.h"
#include "image/half.h"
#include "image/exrreading.h"

_Static_assert(
	__BYTE_ORDER__ == __ORDER_LITTLE_ENDIAN__, "chunks are used as they are stored");

enum spec_status
exr_open_decoder(struct spec_decoder *base, struct spec_error *error)
{
	struct exr_decoder *decoder = (struct exr_decoder *)base;

	decoder->decompressor = libdeflate_alloc_decompressor();
	return decoder->decompressor
		       ? SPEC_OK
		       : spec_error_set(error, SPEC_ENOMEM, "out of memory for a decoder");
}

void
exr_close_decoder(struct spec_decoder *base)
{
	struct exr_decoder *decoder = (struct exr_decoder *)base;

	if (decoder->started) {
		/* These are ours; the library would free them. */
		decoder->pipeline.packed_buffer = decoder->pipeline.unpacked_buffer = NULL;
		decoder->pipeline.packed_alloc_size =
			decoder->pipeline.unpacked_alloc_size = 0;
		exr_decoding_destroy(exr_reader_of(decoder)->context, &decoder->pipeline);
	}
	spec_codec_release();
	if (decoder->decompressor)
		libdeflate_free_decompressor(decoder->decompressor);
	free(decoder->unpacked.bytes);
	free(decoder->tile.bytes);
	free(decoder->chunk);
	free(decoder->line);
}

static exr_result_t
read_nothing(exr_decode_pipeline_t *pipeline)
{
	(void)pipeline;
	return EXR_ERR_SUCCESS;
}

static exr_result_t
start_pipeline(struct exr_decoder *decoder, const exr_chunk_info_t *info)
{
	exr_const_context_t context = exr_reader_of(decoder)->context;
	int part = exr_reader_of(decoder)->part;
	exr_decode_pipeline_t *pipeline = &decoder->pipeline;
	exr_result_t result;

	if (decoder->started)
		return exr_decoding_update(context, part, info, pipeline);
	result = exr_decoding_initialize(context, part, info, pipeline);
	if (result != EXR_ERR_SUCCESS)
		return result;
	decoder->started = 1;
	result = exr_decoding_choose_default_routines(context, part, pipeline);
	pipeline->read_fn = read_nothing;
	pipeline->unpack_and_convert_fn = NULL;
	return result;
}

static exr_result_t
run_pipeline(
	struct exr_decoder *decoder, const struct exr_fetched *chunk, unsigned char *room)
{
	exr_decode_pipeline_t *pipeline = &decoder->pipeline;
	exr_result_t result = start_pipeline(decoder, &chunk->info);

	pipeline->packed_buffer = decoder->base.packed.bytes + chunk->at;
	pipeline->packed_alloc_size = 0;
	pipeline->unpacked_buffer = room;
	pipeline->unpacked_alloc_size = chunk->info.unpacked_size;
	if (result == EXR_ERR_SUCCESS)
		result = exr_decoding_run(exr_reader_of(decoder)->context,
			exr_reader_of(decoder)->part, pipeline);
	pipeline->packed_buffer = pipeline->unpacked_buffer = NULL;
	pipeline->packed_alloc_size = pipeline->unpacked_alloc_size = 0;
	return result;
}

/* Decodes one chunk into room for its unpacked size, or leaves it where it is; *bytes: where. */
static enum spec_status
decode_chunk(struct exr_decoder *decoder, const struct exr_fetched *chunk,
	unsigned char *room, const unsigned char **bytes, struct spec_error *error)
{
	const exr_chunk_info_t *info = &chunk->info;
	exr_result_t result;

	*bytes = decoder->base.packed.bytes + chunk->at;
	/*
	 * A chunk that did not shrink is stored. OpenEXR's C++ library holds that for
	 * B44 too, where OpenEXRCore 3.1 does not.
	 */
	if (info->packed_size == info->unpacked_size)
		return SPEC_OK;
	spec_exr_forget();
	spec_exr_allow(decoder->base.reader->limits.memory, "memory");
	if (spec_codec_is_zip(info->compression))
		result = spec_codec_unzip(decoder->decompressor, *bytes, info->packed_size,
			room, info->unpacked_size);
	else
		result = run_pipeline(decoder, chunk, room);
	*bytes = room;
	if (result == EXR_ERR_OUT_OF_MEMORY || spec_exr_has_note())
		return spec_exr_error(result, decoder->base.reader->source.name, error);
	if (result != EXR_ERR_SUCCESS)
		return spec_error_set(error, SPEC_EFORMAT,
			"%s: the data of line %d are damaged",
			decoder->base.reader->source.name,
			exr_reader_of(decoder)->tiled ? decoder->base.y0 : info->start_y);
	return SPEC_OK;
}

/* Whether a chunk's lines need another place than that of its packed bytes. */
static int
needs_room(const exr_chunk_info_t *info)
{
	return info->packed_size != info->unpacked_size &&
	       !spec_codec_is_zip(info->compression);
}

static enum spec_status
decode_scanlines(struct exr_decoder *decoder, struct spec_error *error)
{
	const struct exr_reader *reader = exr_reader_of(decoder);
	size_t total = 0, used = 0;
	enum spec_status status;

	for (size_t i = 0; i < decoder->chunks; i++) {
		const exr_chunk_info_t *info = &decoder->chunk[i].info;

		if (info->unpacked_size != reader->base.line_bytes * (size_t)info->height)
			return spec_error_set(error, SPEC_EFORMAT,
				"%s: line %d has a wrong size", reader->base.source.name,
				info->start_y);
		if (needs_room(info))
			total += spec_reading_align(info->unpacked_size);
	}
	status = spec_reading_reserve(&decoder->unpacked, total ? total : 1, 0, error);
	for (size_t i = 0; i < decoder->chunks && status == SPEC_OK; i++) {
		const exr_chunk_info_t *info = &decoder->chunk[i].info;
		const unsigned char *bytes;

		status = decode_chunk(decoder, &decoder->chunk[i],
			needs_room(info)
				? decoder->unpacked.bytes + used
				: decoder->base.packed.bytes + decoder->chunk[i].at,
			&bytes, error);
		if (needs_room(info))
			used += spec_reading_align(info->unpacked_size);
		for (int line = 0; line < info->height && status == SPEC_OK; line++) {
			int row = info->start_y + line - decoder->base.y0;

			if (row >= 0 && row < decoder->base.lines)
				decoder->line[row] =
					bytes + (size_t)line * reader->base.line_bytes;
		}
	}
	return status;
}

/* Puts a tile's samples where they stand in the lines: line, channel, sample. */
static void
place_tile(struct exr_decoder *decoder, const exr_chunk_info_t *info, size_t first_line,
	const unsigned char *bytes)
{
	const struct exr_reader *reader = exr_reader_of(decoder);
	size_t x = (size_t)info->start_x * reader->tile_width;

	for (size_t line = 0; line < (size_t)info->height; line++) {
		unsigned char *to = decoder->unpacked.bytes +
				    (first_line + line) * reader->base.line_bytes;

		for (size_t i = 0; i < reader->base.image.channels; i++) {
			size_t size =
				spec_exr_sample_bytes(reader->base.image.channel[i].sample);

			memcpy(to + reader->offset[i] + x * size, bytes,
				info->width * size);
			bytes += info->width * size;
		}
	}
}

static enum spec_status
decode_tiles(struct exr_decoder *decoder, struct spec_error *error)
{
	const struct exr_reader *reader = exr_reader_of(decoder);
	size_t tile_rows = decoder->chunks / reader->tiles_across;
	size_t above = decoder->base.y0 - exr_chunk_start(reader, decoder->base.y0);
	enum spec_status status = spec_reading_reserve(&decoder->unpacked,
		tile_rows * reader->base.chunk_lines * reader->base.line_bytes, 0, error);

	for (size_t i = 0; i < decoder->chunks && status == SPEC_OK; i++) {
		const struct exr_fetched *chunk = &decoder->chunk[i];
		size_t first_line = i / reader->tiles_across * reader->base.chunk_lines;
		size_t pixels = (size_t)chunk->info.width * chunk->info.height;
		const unsigned char *bytes;

		if (chunk->info.unpacked_size !=
				pixels * (reader->base.line_bytes /
						 spec_window_width(
							 &reader->base.image.data)) ||
			chunk->info.start_x * (long long)reader->tile_width +
					chunk->info.width >
				(long long)spec_window_width(&reader->base.image.data))
			return spec_error_set(error, SPEC_EFORMAT,
				"%s: a tile has a wrong size", reader->base.source.name);
		status = spec_reading_reserve(
			&decoder->tile, chunk->info.unpacked_size, 0, error);
		if (status == SPEC_OK)
			status = decode_chunk(
				decoder, chunk, decoder->tile.bytes, &bytes, error);
		if (status == SPEC_OK)
			place_tile(decoder, &chunk->info, first_line, bytes);
	}
	for (int row = 0; row < decoder->base.lines && status == SPEC_OK; row++)
		decoder->line[row] =
			decoder->unpacked.bytes + (above + row) * reader->base.line_bytes;
	return status;
}

/* Bands are numbers, whatever they are stored as; a UINT that is no band stays bits. */
static int
needs_copy(const struct exr_reader *reader, size_t index)
{
	const struct spec_channel *channel = &reader->base.image.channel[index];

	return channel->sample == SPEC_SAMPLE_HALF ||
	       (channel->sample == SPEC_SAMPLE_UINT && channel->role != SPEC_ROLE_OTHER) ||
	       reader->offset[index] % 4 != 0 || reader->base.line_bytes % 4 != 0;
}

static void
copy_row(const struct spec_channel *channel, float *to, const unsigned char *from,
	size_t width)
{
	if (channel->sample == SPEC_SAMPLE_HALF) {
		spec_half_to_float(to, from, width);
		return;
	}
	memcpy(to, from, width * sizeof *to);
	if (channel->sample == SPEC_SAMPLE_UINT && channel->role != SPEC_ROLE_OTHER) {
		for (size_t x = 0; x < width; x++) {
			uint32_t number;

			memcpy(&number, to + x, sizeof number);
			to[x] = (float)number;
		}
	}
}

/* What can be used where it lies is; the rest is copied. */
static enum spec_status
convert(struct exr_decoder *decoder, struct spec_error *error)
{
	const struct exr_reader *reader = exr_reader_of(decoder);
	const struct spec_image *image = &reader->base.image;
	size_t width = spec_window_width(&image->data),
	       room = spec_reading_align(width * sizeof(float));
	size_t copies = 0;
	enum spec_status status;
	unsigned char *to;

	for (size_t i = 0; i < image->channels; i++)
		copies += decoder->base.wanted[i] && needs_copy(reader, i);
	status = spec_reading_reserve(
		&decoder->base.converted, copies * decoder->base.lines * room, 0, error);
	if (status != SPEC_OK)
		return status;
	to = decoder->base.converted.bytes;
	for (int row = 0; row < decoder->base.lines; row++) {
		for (size_t i = 0; i < image->channels; i++) {
			const unsigned char *from = decoder->line[row] + reader->offset[i];
			float **result = &decoder->base.row[row * image->channels + i];

			*result = NULL;
			if (!decoder->base.wanted[i])
				continue;
			if (!needs_copy(reader, i)) {
				*result = (float *)(void *)from;
				continue;
			}
			*result = (float *)(void *)to;
			to += room;
			copy_row(&image->channel[i], *result, from, width);
		}
	}
	return SPEC_OK;
}

enum spec_status
exr_decode(struct spec_decoder *base, struct spec_error *error)
{
	struct exr_decoder *decoder = (struct exr_decoder *)base;
	void *lines = decoder->line;
	enum spec_status status = spec_memory_grow(&lines, &decoder->line_room, base->lines,
		sizeof *decoder->line, "lines", error);

	decoder->line = lines;
	if (status == SPEC_OK)
		status = exr_reader_of(decoder)->tiled ? decode_tiles(decoder, error)
						       : decode_scanlines(decoder, error);
	return status == SPEC_OK ? convert(decoder, error) : status;
}
