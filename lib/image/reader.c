#include "image/reader.h"

#include <libdeflate.h>
#include <openexr.h>
#include <stdlib.h>
#include <string.h>

#include "base/memory.h"
#include "base/number.h"
#include "base/source.h"
#include "image/codec.h"
#include "image/exr.h"
#include "image/half.h"

_Static_assert(
	__BYTE_ORDER__ == __ORDER_LITTLE_ENDIAN__, "chunks are used as they are stored");

#define LARGEST_COORDINATE (1 << 30) /* so that widths and heights fit an int */
#define BLOCK_COPIES 4               /* packed, unpacked, scratch and converted */

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

struct fetched {
	exr_chunk_info_t info;
	size_t at; /* in packed */
};

struct buffer {
	unsigned char *bytes;
	size_t room;
};

struct spec_decoder {
	struct spec_reader *reader;
	unsigned char *wanted;
	exr_decode_pipeline_t pipeline;
	int started;
	struct libdeflate_decompressor *decompressor;
	struct buffer packed, unpacked, tile, converted;
	struct fetched *chunk;
	size_t chunks, chunk_room;
	const unsigned char **line; /* where each line of the block begins */
	size_t line_room;
	float **row; /* [lines][channels]; null where not wanted */
	size_t row_room;
	int y0, lines;
};

static int64_t
read_bytes(exr_const_context_t context, void *data, void *buffer, uint64_t size,
	uint64_t offset, exr_stream_error_func_ptr_t report)
{
	struct spec_reader *reader = data;
	struct spec_error error = {0};
	size_t got;

	(void)context;
	(void)report;
	if (spec_source_read(&reader->source, buffer, size, (int64_t)offset, &got,
		    &error) != SPEC_OK) {
		spec_exr_note(&error);
		return -1;
	}
	if (got < size && reader->source.sealed) {
		spec_error_set(&error, SPEC_EFORMAT, "%s: ends early", reader->source.name);
		spec_exr_note(&error);
	}
	return (int64_t)got;
}

static int64_t
source_size(exr_const_context_t context, void *data)
{
	struct spec_reader *reader = data;

	(void)context;
	return reader->source.size;
}

/* The magic number first: OpenEXRCore's words for a text file are not clear. */
static enum spec_status
check_magic(struct spec_reader *reader, struct spec_error *error)
{
	static const unsigned char magic[4] = {0x76, 0x2f, 0x31, 0x01};
	unsigned char bytes[4];
	size_t got;
	enum spec_status status =
		spec_source_read(&reader->source, bytes, sizeof bytes, 0, &got, error);

	if (status != SPEC_OK)
		return status;
	if (got == 0)
		return spec_error_set(
			error, SPEC_EFORMAT, "%s: is empty", reader->source.name);
	if (got < sizeof bytes || memcmp(bytes, magic, sizeof magic) != 0)
		return spec_error_set(error, SPEC_EFORMAT, "%s: is not an OpenEXR file",
			reader->source.name);
	return SPEC_OK;
}

static enum spec_status
start(struct spec_reader *reader, struct spec_error *error)
{
	exr_context_initializer_t setup = EXR_DEFAULT_CONTEXT_INITIALIZER;
	exr_result_t result;

	setup.error_handler_fn = spec_exr_report;
	setup.user_data = reader;
	setup.read_fn = read_bytes;
	setup.size_fn = reader->source.seekable ? source_size : NULL;
	setup.flags = EXR_CONTEXT_FLAG_DISABLE_CHUNK_RECONSTRUCTION;
	spec_exr_forget();
	result = exr_start_read(&reader->context, reader->source.name, &setup);
	if (result == EXR_ERR_SUCCESS)
		return SPEC_OK;
	spec_exr_error(result, "the header is damaged or cut short", error);
	return spec_error_prefix(error, "%s", reader->source.name);
}

static enum spec_status
get_windows(struct spec_reader *reader, int part, struct spec_image *image,
	struct spec_error *error)
{
	const char *name = reader->source.name;
	exr_attr_box2i_t data, display;
	exr_attr_v2f_t centre = {0};
	exr_compression_t compression = EXR_COMPRESSION_NONE;
	exr_result_t result = exr_get_data_window(reader->context, part, &data);
	long long width, height;

	if (result == EXR_ERR_SUCCESS)
		result = exr_get_display_window(reader->context, part, &display);
	if (result == EXR_ERR_SUCCESS)
		result = exr_get_compression(reader->context, part, &compression);
	if (result != EXR_ERR_SUCCESS)
		return spec_exr_error(result, name, error);
	/* Optional in practice: what the library leaves is 1, (0, 0) and 1. */
	image->pixel_aspect_ratio = image->screen_window_width = 1;
	exr_get_pixel_aspect_ratio(reader->context, part, &image->pixel_aspect_ratio);
	exr_get_screen_window_center(reader->context, part, &centre);
	exr_get_screen_window_width(reader->context, part, &image->screen_window_width);
	image->screen_window_x = centre.x;
	image->screen_window_y = centre.y;
	image->compression = compression;
	width = (long long)data.max.x - data.min.x + 1;
	height = (long long)data.max.y - data.min.y + 1;
	if (width < 1 || height < 1)
		return spec_error_set(
			error, SPEC_EFORMAT, "%s: the data window is empty", name);
	if (width > reader->limits.pixels / height)
		return spec_error_set(error, SPEC_ERANGE,
			"%s: %lld x %lld pixels are more than the limit of %lld (--limit "
			"pixels=N)",
			name, width, height, reader->limits.pixels);
	if (data.min.x < -LARGEST_COORDINATE || data.min.y < -LARGEST_COORDINATE ||
		data.max.x >= LARGEST_COORDINATE || data.max.y >= LARGEST_COORDINATE ||
		display.max.x == INT32_MAX || display.max.y == INT32_MAX)
		return spec_error_set(
			error, SPEC_ERANGE, "%s: a window reaches beyond 2^30", name);
	image->data = (struct spec_window){
		data.min.x, data.min.y, data.max.x + 1, data.max.y + 1};
	image->display = (struct spec_window){
		display.min.x, display.min.y, display.max.x + 1, display.max.y + 1};
	return SPEC_OK;
}

static enum spec_status
get_channels(struct spec_reader *reader, int part, struct spec_image *image,
	struct spec_error *error)
{
	const char *name = reader->source.name;
	const exr_attr_chlist_t *list;
	exr_result_t result = exr_get_channels(reader->context, part, &list);
	enum spec_status status = SPEC_OK;

	if (result != EXR_ERR_SUCCESS)
		return spec_exr_error(result, name, error);
	if (list->num_channels > reader->limits.channels)
		return spec_error_set(error, SPEC_ERANGE,
			"%s: %d channels are more than the limit of %lld (--limit "
			"channels=N)",
			name, list->num_channels, reader->limits.channels);
	for (int i = 0; i < list->num_channels && status == SPEC_OK; i++) {
		const exr_attr_chlist_entry_t *entry = &list->entries[i];

		if (entry->x_sampling != 1 || entry->y_sampling != 1)
			return spec_error_set(error, SPEC_EUNSUPPORTED,
				"%s: channel '%s' is subsampled", name, entry->name.str);
		status = spec_image_add_channel(
			image, entry->name.str, (enum spec_sample)entry->pixel_type, error);
		if (status == SPEC_OK)
			image->channel[image->channels - 1].linear = entry->p_linear;
		else
			spec_error_prefix(error, "%s", name);
	}
	return status;
}

static enum spec_status
get_image(struct spec_reader *reader, int part, struct spec_image *image,
	struct spec_error *error)
{
	const char *part_name = NULL;
	enum spec_status status = get_windows(reader, part, image, error);

	if (status == SPEC_OK)
		status = get_channels(reader, part, image, error);
	if (status == SPEC_OK)
		status = spec_exr_get_attributes(
			reader->context, part, image, reader->source.name, error);
	if (status == SPEC_OK &&
		exr_get_name(reader->context, part, &part_name) == EXR_ERR_SUCCESS &&
		part_name) {
		image->part = spec_memory_text(part_name, strlen(part_name), error);
		status = image->part ? SPEC_OK : SPEC_ENOMEM;
	}
	if (status == SPEC_OK)
		status = spec_image_index(image, reader->source.name, error);
	return status;
}

static int
names_part(exr_const_context_t context, int part, const char *wanted)
{
	const char *name = NULL;
	long long number;

	if (exr_get_name(context, part, &name) == EXR_ERR_SUCCESS && name &&
		strcmp(name, wanted) == 0)
		return 1;
	return spec_number_parse_whole(wanted, 0, 1 << 20, "part", &number, NULL) ==
		       SPEC_OK &&
	       number == part;
}

/* The part that was asked for, else the only one with bands. */
static enum spec_status
choose_part(
	struct spec_reader *reader, const char *wanted, int parts, struct spec_error *error)
{
	const char *name = reader->source.name;
	enum spec_status status = SPEC_OK;
	int spectral = 0;

	reader->part = -1;
	for (int part = 0; part < parts && status == SPEC_OK; part++) {
		struct spec_image image = {0};

		if (wanted) {
			if (reader->part < 0 && names_part(reader->context, part, wanted))
				reader->part = part;
			continue;
		}
		status = get_image(reader, part, &image, error);
		if (image.bands > 0 && spectral++ == 0)
			reader->part = part;
		spec_image_clear(&image);
	}
	if (status != SPEC_OK)
		return status;
	if (wanted && reader->part < 0)
		return spec_error_set(error, SPEC_EUSAGE,
			"%s: has no part '%s' (it has %d)", name, wanted, parts);
	if (spectral > 1)
		return spec_error_set(error, SPEC_EUSAGE,
			"%s: %d of its %d parts have bands; choose one with --part", name,
			spectral, parts);
	if (reader->part < 0)
		reader->part = 0;
	return SPEC_OK;
}

static enum spec_status
get_storage(struct spec_reader *reader, struct spec_error *error)
{
	const char *name = reader->source.name;
	exr_storage_t storage;
	exr_result_t result = exr_get_storage(reader->context, reader->part, &storage);
	int32_t across, down, width, height, lines = 1;

	if (result != EXR_ERR_SUCCESS)
		return spec_exr_error(result, name, error);
	if (storage == EXR_STORAGE_DEEP_SCANLINE || storage == EXR_STORAGE_DEEP_TILED)
		return spec_error_set(
			error, SPEC_EUNSUPPORTED, "%s: holds deep data", name);
	if (reader->image.compression == EXR_COMPRESSION_DWAA ||
		reader->image.compression == EXR_COMPRESSION_DWAB)
		return spec_error_set(error, SPEC_EUNSUPPORTED,
			"%s: DWA compression is not in this version of OpenEXRCore", name);
	reader->tiled = storage == EXR_STORAGE_TILED;
	if (!reader->tiled) {
		result = exr_get_scanlines_per_chunk(reader->context, reader->part, &lines);
		reader->chunk_lines = lines;
	} else {
		result = exr_get_tile_sizes(
			reader->context, reader->part, 0, 0, &width, &height);
		if (result == EXR_ERR_SUCCESS)
			result = exr_get_tile_levels(
				reader->context, reader->part, &across, &down);
		if (result == EXR_ERR_SUCCESS) {
			int tile = width < 1 ? 1 : width;

			reader->tile_width = tile;
			reader->chunk_lines = height < 1 ? 1 : height;
			reader->tiles_across =
				(int)((spec_window_width(&reader->image.data) + tile - 1) /
					tile);
		}
	}
	return result == EXR_ERR_SUCCESS ? SPEC_OK : spec_exr_error(result, name, error);
}

static enum spec_status
measure_lines(struct spec_reader *reader, struct spec_error *error)
{
	const struct spec_image *image = &reader->image;
	size_t width = spec_window_width(&image->data), bytes = 0;
	size_t lines = reader->chunk_lines, height = spec_window_height(&image->data);

	reader->offset =
		spec_memory_new(image->channels, sizeof *reader->offset, "channels", error);
	if (!reader->offset)
		return SPEC_ENOMEM;
	for (size_t i = 0; i < image->channels; i++) {
		reader->offset[i] = bytes;
		bytes += width * spec_exr_sample_bytes(image->channel[i].sample);
	}
	reader->line_bytes = bytes;
	if (lines > height)
		lines = height;
	if (bytes > (size_t)reader->limits.memory / lines / BLOCK_COPIES)
		return spec_error_set(error, SPEC_ERANGE,
			"%s: %zu lines of %zu bytes need more than the limit of %lld bytes "
			"of memory "
			"(--limit memory=BYTES)",
			reader->source.name, lines, bytes, reader->limits.memory);
	return SPEC_OK;
}

/* A pipe is read forward only; tiles, several parts and other line orders need a copy. */
static enum spec_status
settle_source(struct spec_reader *reader, int parts, struct spec_error *error)
{
	exr_lineorder_t order = EXR_LINEORDER_INCREASING_Y;
	enum spec_status status = SPEC_OK;

	exr_get_lineorder(reader->context, reader->part, &order);
	if (!reader->source.seekable &&
		(reader->tiled || parts > 1 || order != EXR_LINEORDER_INCREASING_Y))
		status = spec_source_spool(&reader->source, error);
	spec_source_seal(&reader->source);
	return status;
}

static enum spec_status
open_reader(struct spec_reader *reader, const char *path,
	const struct spec_settings *settings, struct spec_error *error)
{
	int parts = 0;
	enum spec_status status = spec_source_open(
		&reader->source, path, (size_t)settings->limits.header, error);

	reader->limits = settings->limits;
	if (status == SPEC_OK)
		status = check_magic(reader, error);
	if (status == SPEC_OK)
		status = start(reader, error);
	if (status == SPEC_OK && exr_get_count(reader->context, &parts) != EXR_ERR_SUCCESS)
		status = spec_error_set(error, SPEC_EFORMAT, "%s: has no part", path);
	if (status == SPEC_OK)
		status = choose_part(reader, settings->part, parts, error);
	if (status == SPEC_OK)
		status = get_image(reader, reader->part, &reader->image, error);
	if (status == SPEC_OK)
		status = get_storage(reader, error);
	if (status == SPEC_OK)
		status = measure_lines(reader, error);
	if (status == SPEC_OK)
		status = settle_source(reader, parts, error);
	return status;
}

enum spec_status
spec_reader_open(struct spec_reader **reader, const char *path,
	const struct spec_settings *settings, struct spec_error *error)
{
	enum spec_status status;

	*reader = spec_memory_new(1, sizeof **reader, "readers", error);
	if (!*reader)
		return SPEC_ENOMEM;
	(*reader)->source.fd = -1;
	status = open_reader(*reader, path, settings, error);
	if (status != SPEC_OK) {
		spec_reader_close(*reader);
		*reader = NULL;
	}
	return status;
}

void
spec_reader_close(struct spec_reader *reader)
{
	if (!reader)
		return;
	if (reader->context)
		exr_finish(&reader->context);
	spec_source_close(&reader->source);
	spec_image_clear(&reader->image);
	free(reader->offset);
	free(reader->kept);
	free(reader);
}

const struct spec_image *
spec_reader_image(const struct spec_reader *reader)
{
	return &reader->image;
}

const char *
spec_reader_name(const struct spec_reader *reader)
{
	return reader->source.name;
}

int
spec_reader_chunk_lines(const struct spec_reader *reader)
{
	return reader->chunk_lines;
}

size_t
spec_reader_line_bytes(const struct spec_reader *reader)
{
	return reader->line_bytes;
}

enum spec_status
spec_decoder_open(struct spec_decoder **result, struct spec_reader *reader,
	const unsigned char *wanted, struct spec_error *error)
{
	struct spec_decoder *decoder =
		spec_memory_new(1, sizeof *decoder, "decoders", error);
	size_t channels = reader->image.channels;

	*result = decoder;
	if (!decoder)
		return SPEC_ENOMEM;
	decoder->reader = reader;
	decoder->wanted = spec_memory_new(channels, 1, "channels", error);
	decoder->decompressor = libdeflate_alloc_decompressor();
	if (!decoder->wanted || !decoder->decompressor) {
		spec_decoder_close(decoder);
		*result = NULL;
		return spec_error_set(error, SPEC_ENOMEM, "out of memory for a decoder");
	}
	for (size_t i = 0; i < channels; i++)
		decoder->wanted[i] = wanted ? wanted[i] : 1;
	return SPEC_OK;
}

void
spec_decoder_close(struct spec_decoder *decoder)
{
	if (!decoder)
		return;
	if (decoder->started) {
		/* These are ours; the library would free them. */
		decoder->pipeline.packed_buffer = decoder->pipeline.unpacked_buffer = NULL;
		decoder->pipeline.packed_alloc_size =
			decoder->pipeline.unpacked_alloc_size = 0;
		exr_decoding_destroy(decoder->reader->context, &decoder->pipeline);
	}
	if (decoder->decompressor)
		libdeflate_free_decompressor(decoder->decompressor);
	free(decoder->wanted);
	free(decoder->packed.bytes);
	free(decoder->unpacked.bytes);
	free(decoder->tile.bytes);
	free(decoder->converted.bytes);
	free(decoder->chunk);
	free(decoder->line);
	free(decoder->row);
	free(decoder);
}

/* Grows a buffer, keeping the first kept bytes. */
static enum spec_status
reserve(struct buffer *buffer, size_t size, size_t kept, struct spec_error *error)
{
	unsigned char *bytes;

	if (size <= buffer->room)
		return SPEC_OK;
	if (kept > 0 && size < buffer->room + buffer->room / 2)
		size = buffer->room + buffer->room / 2; /* it grows chunk by chunk */
	bytes = spec_memory_aligned(size, 1, "bytes of pixels", error);
	if (!bytes)
		return SPEC_ENOMEM;
	if (kept > 0)
		memcpy(bytes, buffer->bytes, kept);
	free(buffer->bytes);
	buffer->bytes = bytes;
	buffer->room = size;
	return SPEC_OK;
}

static size_t
align_up(size_t size)
{
	return (size + 63) / 64 * 64;
}

static enum spec_status
fetch_failed(const struct spec_reader *reader, exr_result_t result, int y,
	struct spec_error *error)
{
	enum spec_status status = spec_exr_error(result, reader->source.name, error);

	/* The library tells it by comparing a chunk with the size of the file. */
	if (error && (strstr(error->message, ": ends early") ||
			     strstr(error->message, "file size")))
		return spec_error_set(error, SPEC_EFORMAT,
			"%s: ends early, in line %d of %d..%d", reader->source.name, y,
			reader->image.data.y0, reader->image.data.y1 - 1);
	return status;
}

/* Reads one chunk to the end of packed. column: the tile's, or 0. */
static enum spec_status
fetch_chunk(struct spec_decoder *decoder, int y, int column, size_t *used,
	struct spec_error *error)
{
	struct spec_reader *reader = decoder->reader;
	struct fetched *chunk = &decoder->chunk[decoder->chunks];
	enum spec_status status;
	exr_result_t result;

	spec_exr_forget();
	if (reader->tiled)
		result = exr_read_tile_chunk_info(reader->context, reader->part, column,
			(y - reader->image.data.y0) / reader->chunk_lines, 0, 0,
			&chunk->info);
	else
		result = exr_read_scanline_chunk_info(
			reader->context, reader->part, y, &chunk->info);
	if (result != EXR_ERR_SUCCESS)
		return fetch_failed(reader, result, y, error);
	if (reader->image.compression == EXR_COMPRESSION_NONE &&
		chunk->info.packed_size != chunk->info.unpacked_size)
		return spec_error_set(error, SPEC_EFORMAT,
			"%s: line %d has %llu bytes instead of %llu", reader->source.name,
			y, (unsigned long long)chunk->info.packed_size,
			(unsigned long long)chunk->info.unpacked_size);
	status = reserve(
		&decoder->packed, *used + align_up(chunk->info.packed_size), *used, error);
	if (status != SPEC_OK)
		return status;
	result = exr_read_chunk(
		reader->context, reader->part, &chunk->info, decoder->packed.bytes + *used);
	/* The library fills a short uncompressed chunk with zeros and calls it success. */
	if (result != EXR_ERR_SUCCESS || spec_exr_has_note())
		return fetch_failed(reader, result, y, error);
	chunk->at = *used;
	*used += align_up(chunk->info.packed_size);
	decoder->chunks++;
	return SPEC_OK;
}

/* The first line of the chunk that line y is stored in. */
static int
chunk_start(const struct spec_reader *reader, int y)
{
	int y0 = reader->image.data.y0;

	return y0 + (y - y0) / reader->chunk_lines * reader->chunk_lines;
}

/* Takes the chunk kept from the block before; a pipe gives it only once. */
static enum spec_status
take_kept(struct spec_decoder *decoder, size_t *used, struct spec_error *error)
{
	struct spec_reader *reader = decoder->reader;
	size_t size = reader->kept_info.packed_size;
	enum spec_status status =
		reserve(&decoder->packed, *used + align_up(size), *used, error);

	if (status != SPEC_OK)
		return status;
	memcpy(decoder->packed.bytes + *used, reader->kept, size);
	decoder->chunk[decoder->chunks++] = (struct fetched){reader->kept_info, *used};
	*used += align_up(size);
	return SPEC_OK;
}

static enum spec_status
keep_last(struct spec_decoder *decoder, struct spec_error *error)
{
	struct spec_reader *reader = decoder->reader;
	const struct fetched *last = &decoder->chunk[decoder->chunks - 1];
	void *list = reader->kept;
	enum spec_status status = spec_memory_grow(&list, &reader->kept_room,
		last->info.packed_size, 1, "bytes of pixels", error);

	if (status != SPEC_OK)
		return status;
	reader->kept = list;
	memcpy(reader->kept, decoder->packed.bytes + last->at, last->info.packed_size);
	reader->kept_info = last->info;
	reader->kept_valid = 1;
	return SPEC_OK;
}

enum spec_status
spec_decoder_fetch(struct spec_decoder *decoder, int y0, int y1, struct spec_error *error)
{
	struct spec_reader *reader = decoder->reader;
	int across = reader->tiled ? reader->tiles_across : 1,
	    first = chunk_start(reader, y0);
	size_t count = ((size_t)(y1 - first) / reader->chunk_lines + 1) * across, used = 0;
	void *list = decoder->chunk;
	enum spec_status status = spec_memory_grow(&list, &decoder->chunk_room, count,
		sizeof *decoder->chunk, "chunks", error);

	decoder->chunk = list;
	decoder->chunks = 0;
	decoder->y0 = y0;
	decoder->lines = y1 - y0;
	for (int y = first; y < y1 && status == SPEC_OK; y += reader->chunk_lines) {
		if (reader->kept_valid && reader->kept_info.start_y == y) {
			status = take_kept(decoder, &used, error);
			continue;
		}
		for (int column = 0; column < across && status == SPEC_OK; column++)
			status = fetch_chunk(decoder, y, column, &used, error);
	}
	reader->kept_valid = 0;
	if (status == SPEC_OK && !reader->source.seekable &&
		chunk_start(reader, y1 - 1) + reader->chunk_lines > y1 &&
		y1 < reader->image.data.y1)
		status = keep_last(decoder, error);
	return status;
}

/* The packed bytes are there already. */
static exr_result_t
read_nothing(exr_decode_pipeline_t *pipeline)
{
	(void)pipeline;
	return EXR_ERR_SUCCESS;
}

static exr_result_t
start_pipeline(struct spec_decoder *decoder, const exr_chunk_info_t *info)
{
	exr_const_context_t context = decoder->reader->context;
	int part = decoder->reader->part;
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
	if (info->compression == EXR_COMPRESSION_ZIP ||
		info->compression == EXR_COMPRESSION_ZIPS) {
		pipeline->decompress_fn = spec_codec_inflate;
		pipeline->decoding_user_data = decoder->decompressor;
	}
	return result;
}

/* Decodes one chunk into room for its unpacked size, or leaves it where it is; *bytes: where. */
static enum spec_status
decode_chunk(struct spec_decoder *decoder, const struct fetched *chunk, unsigned char *room,
	const unsigned char **bytes, struct spec_error *error)
{
	const exr_chunk_info_t *info = &chunk->info;
	exr_decode_pipeline_t *pipeline = &decoder->pipeline;
	int stored = info->packed_size == info->unpacked_size;
	exr_result_t result;

	*bytes = decoder->packed.bytes + chunk->at;
	if (stored && info->compression != EXR_COMPRESSION_B44 &&
		info->compression != EXR_COMPRESSION_B44A)
		return SPEC_OK;
	spec_exr_forget();
	result = start_pipeline(decoder, info);
	pipeline->packed_buffer = decoder->packed.bytes + chunk->at;
	pipeline->packed_alloc_size = 0;
	pipeline->unpacked_buffer = stored ? NULL : room;
	pipeline->unpacked_alloc_size = stored ? 0 : info->unpacked_size;
	if (result == EXR_ERR_SUCCESS)
		result = exr_decoding_run(
			decoder->reader->context, decoder->reader->part, pipeline);
	if (!stored)
		*bytes = room;
	pipeline->packed_buffer = pipeline->unpacked_buffer = NULL;
	pipeline->packed_alloc_size = pipeline->unpacked_alloc_size = 0;
	if (result != EXR_ERR_SUCCESS)
		return spec_error_set(error, SPEC_EFORMAT,
			"%s: the data of line %d are damaged", decoder->reader->source.name,
			decoder->reader->tiled ? decoder->y0 : info->start_y);
	return SPEC_OK;
}

static enum spec_status
decode_scanlines(struct spec_decoder *decoder, struct spec_error *error)
{
	const struct spec_reader *reader = decoder->reader;
	size_t total = 0, used = 0;
	enum spec_status status;

	for (size_t i = 0; i < decoder->chunks; i++) {
		const exr_chunk_info_t *info = &decoder->chunk[i].info;

		if (info->unpacked_size != reader->line_bytes * (size_t)info->height)
			return spec_error_set(error, SPEC_EFORMAT,
				"%s: line %d has a wrong size", reader->source.name,
				info->start_y);
		if (info->packed_size != info->unpacked_size)
			total += align_up(info->unpacked_size);
	}
	status = reserve(&decoder->unpacked, total, 0, error);
	for (size_t i = 0; i < decoder->chunks && status == SPEC_OK; i++) {
		const exr_chunk_info_t *info = &decoder->chunk[i].info;
		const unsigned char *bytes;

		status = decode_chunk(decoder, &decoder->chunk[i],
			decoder->unpacked.bytes + used, &bytes, error);
		if (info->packed_size != info->unpacked_size)
			used += align_up(info->unpacked_size);
		for (int line = 0; line < info->height && status == SPEC_OK; line++) {
			int row = info->start_y + line - decoder->y0;

			if (row >= 0 && row < decoder->lines)
				decoder->line[row] =
					bytes + (size_t)line * reader->line_bytes;
		}
	}
	return status;
}

/* Puts a tile's samples where they stand in the lines: line, channel, sample. */
static void
place_tile(struct spec_decoder *decoder, const exr_chunk_info_t *info, size_t first_line,
	const unsigned char *bytes)
{
	const struct spec_reader *reader = decoder->reader;
	size_t x = (size_t)info->start_x * reader->tile_width;

	for (size_t line = 0; line < (size_t)info->height; line++) {
		unsigned char *to =
			decoder->unpacked.bytes + (first_line + line) * reader->line_bytes;

		for (size_t i = 0; i < reader->image.channels; i++) {
			size_t size =
				spec_exr_sample_bytes(reader->image.channel[i].sample);

			memcpy(to + reader->offset[i] + x * size, bytes,
				info->width * size);
			bytes += info->width * size;
		}
	}
}

static enum spec_status
decode_tiles(struct spec_decoder *decoder, struct spec_error *error)
{
	const struct spec_reader *reader = decoder->reader;
	size_t tile_rows = decoder->chunks / reader->tiles_across;
	size_t above = decoder->y0 - chunk_start(reader, decoder->y0);
	enum spec_status status = reserve(&decoder->unpacked,
		tile_rows * reader->chunk_lines * reader->line_bytes, 0, error);

	for (size_t i = 0; i < decoder->chunks && status == SPEC_OK; i++) {
		const struct fetched *chunk = &decoder->chunk[i];
		size_t first_line = i / reader->tiles_across * reader->chunk_lines;
		size_t pixels = (size_t)chunk->info.width * chunk->info.height;
		const unsigned char *bytes;

		if (chunk->info.unpacked_size !=
				pixels * (reader->line_bytes /
						 spec_window_width(&reader->image.data)) ||
			chunk->info.start_x * (long long)reader->tile_width +
					chunk->info.width >
				(long long)spec_window_width(&reader->image.data))
			return spec_error_set(error, SPEC_EFORMAT,
				"%s: a tile has a wrong size", reader->source.name);
		status = reserve(&decoder->tile, chunk->info.unpacked_size, 0, error);
		if (status == SPEC_OK)
			status = decode_chunk(
				decoder, chunk, decoder->tile.bytes, &bytes, error);
		if (status == SPEC_OK)
			place_tile(decoder, &chunk->info, first_line, bytes);
	}
	for (int row = 0; row < decoder->lines && status == SPEC_OK; row++)
		decoder->line[row] =
			decoder->unpacked.bytes + (above + row) * reader->line_bytes;
	return status;
}

/* Bands are numbers, whatever they are stored as; a UINT that is no band stays bits. */
static int
needs_copy(const struct spec_reader *reader, size_t index)
{
	const struct spec_channel *channel = &reader->image.channel[index];

	return channel->sample == SPEC_SAMPLE_HALF ||
	       (channel->sample == SPEC_SAMPLE_UINT && channel->role != SPEC_ROLE_OTHER) ||
	       reader->offset[index] % 4 != 0 || reader->line_bytes % 4 != 0;
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
convert(struct spec_decoder *decoder, struct spec_error *error)
{
	const struct spec_reader *reader = decoder->reader;
	const struct spec_image *image = &reader->image;
	size_t width = spec_window_width(&image->data),
	       room = align_up(width * sizeof(float));
	size_t copies = 0;
	enum spec_status status;
	unsigned char *to;

	for (size_t i = 0; i < image->channels; i++)
		copies += decoder->wanted[i] && needs_copy(reader, i);
	status = reserve(&decoder->converted, copies * decoder->lines * room, 0, error);
	if (status != SPEC_OK)
		return status;
	to = decoder->converted.bytes;
	for (int row = 0; row < decoder->lines; row++) {
		for (size_t i = 0; i < image->channels; i++) {
			const unsigned char *from = decoder->line[row] + reader->offset[i];
			float **result = &decoder->row[row * image->channels + i];

			*result = NULL;
			if (!decoder->wanted[i])
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
spec_decoder_decode(struct spec_decoder *decoder, struct spec_error *error)
{
	void *lines = decoder->line, *rows = decoder->row;
	enum spec_status status = spec_memory_grow(&lines, &decoder->line_room,
		decoder->lines, sizeof *decoder->line, "lines", error);

	decoder->line = lines;
	if (status == SPEC_OK) {
		status = spec_memory_grow(&rows, &decoder->row_room,
			decoder->lines * decoder->reader->image.channels,
			sizeof *decoder->row, "rows", error);
		decoder->row = rows;
	}
	if (status == SPEC_OK)
		status = decoder->reader->tiled ? decode_tiles(decoder, error)
						: decode_scanlines(decoder, error);
	return status == SPEC_OK ? convert(decoder, error) : status;
}

const float *
spec_decoder_row(const struct spec_decoder *decoder, int y, size_t channel)
{
	return decoder->row[(y - decoder->y0) * decoder->reader->image.channels + channel];
}
