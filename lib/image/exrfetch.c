/* Taking chunks from a file or a pipe, for decoders to work on. */
#include <stdlib.h>
#include <string.h>

#include "base/memory.h"
#include "image/codec.h"
#include "image/exr.h"
#include "image/exrreading.h"

/* Bytes between two channels below which reading them takes less than another call. */
#define JUMP 4096

static enum spec_status
fetch_failed(const struct exr_reader *reader, exr_result_t result, int y,
	struct spec_error *error)
{
	enum spec_status status = spec_exr_error(result, reader->base.source.name, error);

	/* The library tells it by comparing a chunk with the size of the file. */
	if (error && (strstr(error->message, ": ends early") ||
			     strstr(error->message, "file size")))
		return spec_error_set(error, SPEC_EFORMAT,
			"%s: ends early, in line %d of %d..%d", reader->base.source.name, y,
			reader->base.image.data.y0, reader->base.image.data.y1 - 1);
	return status;
}

/* The room that a chunk is given: ZIP is decoded where it lies. */
static size_t
room_for(const exr_chunk_info_t *info)
{
	int grows = spec_codec_is_zip(info->compression) &&
		    info->unpacked_size > info->packed_size;

	return spec_reading_align(grows ? info->unpacked_size : info->packed_size);
}

/* Whether a chunk is a line as it is, of a file in which one can go to any place. */
static int
is_plain_line(const struct exr_reader *reader, const exr_chunk_info_t *info)
{
	return !reader->tiled && reader->base.source.seekable && info->height == 1 &&
	       info->packed_size == info->unpacked_size &&
	       info->packed_size == reader->base.line_bytes &&
	       info->data_offset + info->packed_size <= (uint64_t)reader->base.source.size;
}

/* Reads the channels that are wanted, and no more between them than is worth a jump. */
static enum spec_status
read_wanted(struct exr_decoder *decoder, const exr_chunk_info_t *info, unsigned char *to,
	struct spec_error *error)
{
	struct exr_reader *reader = exr_reader_of(decoder);
	size_t channels = reader->base.image.channels, from = 0, end = 0, got;
	enum spec_status status = SPEC_OK;

	for (size_t i = 0; i <= channels && status == SPEC_OK; i++) {
		if (i < channels && !decoder->base.wanted[i])
			continue;
		if (end > from && (i == channels || reader->offset[i] > end + JUMP)) {
			status = spec_source_read(&reader->base.source, to + from,
				end - from, (int64_t)(info->data_offset + from), &got,
				error);
			if (status == SPEC_OK && got < end - from)
				return spec_error_set(error, SPEC_EFORMAT,
					"%s: ends early, in line %d of %d..%d",
					reader->base.source.name, info->start_y,
					reader->base.image.data.y0,
					reader->base.image.data.y1 - 1);
			from = end;
		}
		if (i == channels)
			break;
		from = end > from ? from : reader->offset[i];
		end = i + 1 < channels ? reader->offset[i + 1] : reader->base.line_bytes;
	}
	return status;
}

static enum spec_status
read_chunk(struct exr_decoder *decoder, const exr_chunk_info_t *info, int y,
	unsigned char *to, struct spec_error *error)
{
	struct exr_reader *reader = exr_reader_of(decoder);
	exr_result_t result;

	if (is_plain_line(reader, info))
		return read_wanted(decoder, info, to, error);
	result = exr_read_chunk(reader->context, reader->part, info, to);
	/* The library fills a short uncompressed chunk with zeros and calls it success. */
	if (result != EXR_ERR_SUCCESS || spec_exr_has_note())
		return fetch_failed(reader, result, y, error);
	return SPEC_OK;
}

/* Reads one chunk to the end of packed. column: the tile's, or 0. */
static enum spec_status
fetch_chunk(struct exr_decoder *decoder, int y, int column, size_t *used,
	struct spec_error *error)
{
	struct exr_reader *reader = exr_reader_of(decoder);
	struct exr_fetched *chunk = &decoder->chunk[decoder->chunks];
	enum spec_status status;
	exr_result_t result;

	spec_exr_forget();
	spec_exr_allow(
		reader->base.limits.memory, "memory"); /* the chunk table is read here */
	if (reader->tiled)
		result = exr_read_tile_chunk_info(reader->context, reader->part, column,
			(y - reader->base.image.data.y0) / reader->base.chunk_lines, 0, 0,
			&chunk->info);
	else
		result = exr_read_scanline_chunk_info(
			reader->context, reader->part, y, &chunk->info);
	if (result != EXR_ERR_SUCCESS)
		return fetch_failed(reader, result, y, error);
	if (reader->base.image.compression == EXR_COMPRESSION_NONE &&
		chunk->info.packed_size != chunk->info.unpacked_size)
		return spec_error_set(error, SPEC_EFORMAT,
			"%s: line %d has %llu bytes instead of %llu",
			reader->base.source.name, y,
			(unsigned long long)chunk->info.packed_size,
			(unsigned long long)chunk->info.unpacked_size);
	status = spec_reading_reserve(
		&decoder->base.packed, *used + room_for(&chunk->info), *used, error);
	if (status == SPEC_OK)
		status = read_chunk(decoder, &chunk->info, y,
			decoder->base.packed.bytes + *used, error);
	if (status != SPEC_OK)
		return status;
	chunk->at = *used;
	*used += room_for(&chunk->info);
	decoder->chunks++;
	return SPEC_OK;
}

/* Takes the chunk kept from the block before; a pipe gives it only once. */
static enum spec_status
take_kept(struct exr_decoder *decoder, size_t *used, struct spec_error *error)
{
	struct exr_reader *reader = exr_reader_of(decoder);
	size_t size = reader->kept_info.packed_size;
	enum spec_status status = spec_reading_reserve(
		&decoder->base.packed, *used + room_for(&reader->kept_info), *used, error);

	if (status != SPEC_OK)
		return status;
	memcpy(decoder->base.packed.bytes + *used, reader->kept, size);
	decoder->chunk[decoder->chunks++] = (struct exr_fetched){reader->kept_info, *used};
	*used += room_for(&reader->kept_info);
	return SPEC_OK;
}

static enum spec_status
keep_last(struct exr_decoder *decoder, struct spec_error *error)
{
	struct exr_reader *reader = exr_reader_of(decoder);
	const struct exr_fetched *last = &decoder->chunk[decoder->chunks - 1];
	void *list = reader->kept;
	enum spec_status status = spec_memory_grow(&list, &reader->kept_room,
		last->info.packed_size, 1, "bytes of pixels", error);

	if (status != SPEC_OK)
		return status;
	reader->kept = list;
	memcpy(reader->kept, decoder->base.packed.bytes + last->at, last->info.packed_size);
	reader->kept_info = last->info;
	reader->kept_valid = 1;
	return SPEC_OK;
}

enum spec_status
exr_fetch(struct spec_decoder *base, struct spec_error *error)
{
	struct exr_decoder *decoder = (struct exr_decoder *)base;
	struct exr_reader *reader = exr_reader_of(decoder);
	int across = reader->tiled ? reader->tiles_across : 1, y1 = base->y0 + base->lines,
	    first = exr_chunk_start(reader, base->y0), step = reader->base.chunk_lines;
	size_t count = ((size_t)(y1 - first) / step + 1) * across, used = 0;
	void *list = decoder->chunk;
	enum spec_status status = spec_memory_grow(&list, &decoder->chunk_room, count,
		sizeof *decoder->chunk, "chunks", error);

	decoder->chunk = list;
	decoder->chunks = 0;
	for (int y = first; y < y1 && status == SPEC_OK; y += step) {
		if (reader->kept_valid && reader->kept_info.start_y == y) {
			status = take_kept(decoder, &used, error);
			continue;
		}
		for (int column = 0; column < across && status == SPEC_OK; column++)
			status = fetch_chunk(decoder, y, column, &used, error);
	}
	if (reader->base.source.seekable)
		return status;
	reader->kept_valid = 0;
	if (status == SPEC_OK && exr_chunk_start(reader, y1 - 1) + step > y1 &&
		y1 < reader->base.image.data.y1)
		status = keep_last(decoder, error);
	return status;
}
