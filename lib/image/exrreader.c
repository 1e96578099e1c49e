#include "image/reader.h"

#include <openexr.h>
#include <stdlib.h>
#include <string.h>

#include "base/memory.h"
#include "base/number.h"
#include "image/exr.h"
#include "image/exrreading.h"
#include "image/given.h"
#include "image/scan.h"

#define LARGEST_COORDINATE (1 << 30) /* so that widths and heights fit an int */

static int64_t
read_bytes(exr_const_context_t context, void *data, void *buffer, uint64_t size,
	uint64_t offset, exr_stream_error_func_ptr_t report)
{
	struct exr_reader *reader = data;
	struct spec_error error = {0};
	size_t got;

	(void)context;
	(void)report;
	if (spec_source_read(&reader->base.source, buffer, size, (int64_t)offset, &got,
		    &error) != SPEC_OK) {
		/* Not -1: the library would take it for a length and write before the buffer. */
		spec_exr_note(&error);
		return 0;
	}
	if (got < size && reader->base.source.sealed) {
		spec_error_set(
			&error, SPEC_EFORMAT, "%s: ends early", reader->base.source.name);
		spec_exr_note(&error);
	}
	return (int64_t)got;
}

static int64_t
source_size(exr_const_context_t context, void *data)
{
	struct exr_reader *reader = data;

	(void)context;
	return reader->base.source.size;
}

static int
recognises(const unsigned char *bytes, size_t size, const char *path)
{
	static const unsigned char magic[4] = {0x76, 0x2f, 0x31, 0x01};

	(void)path;
	return size >= sizeof magic && memcmp(bytes, magic, sizeof magic) == 0;
}

static enum spec_status
start(struct exr_reader *reader, struct spec_error *error)
{
	exr_context_initializer_t setup = EXR_DEFAULT_CONTEXT_INITIALIZER;
	enum spec_status status;
	exr_result_t result;

	setup.error_handler_fn = spec_exr_report;
	setup.user_data = reader;
	setup.read_fn = read_bytes;
	setup.size_fn = reader->base.source.seekable ? source_size : NULL;
	setup.alloc_fn = spec_exr_allocate;
	setup.free_fn = free;
	/* Not strict, the library would guess at what it cannot read. */
	setup.flags = EXR_CONTEXT_FLAG_DISABLE_CHUNK_RECONSTRUCTION |
		      EXR_CONTEXT_FLAG_STRICT_HEADER;
	spec_exr_forget();
	spec_exr_allow(reader->base.limits.header, "header");
	result = exr_start_read(&reader->context, reader->base.source.name, &setup);
	if (result == EXR_ERR_SUCCESS)
		return SPEC_OK;
	status = spec_exr_error(result, "the header is damaged or cut short", error);
	if (error && strstr(error->message, "data window"))
		return spec_error_set(error, SPEC_ERANGE,
			"%s: the data window is empty or reaches beyond 2^30",
			reader->base.source.name);
	spec_error_prefix(error, "%s", reader->base.source.name);
	return status;
}

static enum spec_status
get_windows(struct exr_reader *reader, int part, struct spec_image *image,
	struct spec_error *error)
{
	const char *name = reader->base.source.name;
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
	if (spec_reading_check_size(&reader->base, width, height, error) != SPEC_OK)
		return SPEC_ERANGE;
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

/* Whether bad names and attributes are no error: the first is noted. */
static enum spec_status
tolerate(const struct exr_reader *reader, enum spec_status status,
	const struct spec_error *error)
{
	struct spec_error *refused = reader->base.refused;

	if (status != SPEC_EFORMAT || !refused)
		return status;
	if (refused->status == SPEC_OK)
		*refused = error ? *error : (struct spec_error){.status = SPEC_EFORMAT};
	return SPEC_OK;
}

static enum spec_status
get_channels(struct exr_reader *reader, int part, struct spec_image *image,
	struct spec_error *error)
{
	const char *name = reader->base.source.name;
	const exr_attr_chlist_t *list;
	exr_result_t result = exr_get_channels(reader->context, part, &list);
	enum spec_status status = SPEC_OK;

	if (result != EXR_ERR_SUCCESS)
		return spec_exr_error(result, name, error);
	if (list->num_channels > reader->base.limits.channels)
		return spec_error_set(error, SPEC_ERANGE,
			"%s: %d channels are more than the limit of %lld (--limit "
			"channels=N)",
			name, list->num_channels, reader->base.limits.channels);
	for (int i = 0; i < list->num_channels && status == SPEC_OK; i++) {
		const exr_attr_chlist_entry_t *entry = &list->entries[i];

		if (entry->x_sampling != 1 || entry->y_sampling != 1)
			return spec_error_set(error, SPEC_EUNSUPPORTED,
				"%s: channel '%s' is subsampled", name, entry->name.str);
		status = spec_image_add_channel(
			image, entry->name.str, (enum spec_sample)entry->pixel_type, error);
		if (status != SPEC_OK)
			spec_error_prefix(error, "%s", name);
		status = tolerate(reader, status, error);
		if (status == SPEC_OK)
			image->channel[image->channels - 1].linear = entry->p_linear;
	}
	return status;
}

static enum spec_status
get_image(struct exr_reader *reader, int part, const struct spec_settings *settings,
	struct spec_image *image, struct spec_error *error)
{
	const char *part_name = NULL;
	enum spec_status status = get_windows(reader, part, image, error);

	if (status == SPEC_OK)
		status = get_channels(reader, part, image, error);
	if (status == SPEC_OK)
		status = spec_exr_get_attributes(
			reader->context, part, image, reader->base.source.name, error);
	if (status == SPEC_OK &&
		exr_get_name(reader->context, part, &part_name) == EXR_ERR_SUCCESS &&
		part_name) {
		image->part = spec_memory_text(part_name, strlen(part_name), error);
		status = image->part ? SPEC_OK : SPEC_ENOMEM;
	}
	if (status == SPEC_OK)
		status = spec_given_apply(image, settings, reader->base.source.name, error);
	if (status == SPEC_OK)
		status = spec_image_index(image, reader->base.source.name, error);
	if (status == SPEC_EFORMAT && reader->base.refused) {
		spec_image_clear_index(image);
		status = tolerate(reader, status, error);
	}
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

/* Whether there are bands, be they such that the image has no index. */
static int
has_bands(const struct spec_image *image)
{
	for (size_t i = 0; i < image->channels; i++) {
		if (image->channel[i].role != SPEC_ROLE_OTHER)
			return 1;
	}
	return 0;
}

/* The part that was asked for, else the only one with bands. */
static enum spec_status
choose_part(struct exr_reader *reader, const struct spec_settings *settings, int parts,
	struct spec_error *error)
{
	const char *wanted = settings->part;
	const char *name = reader->base.source.name;
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
		status = get_image(reader, part, settings, &image, error);
		if (has_bands(&image) && spectral++ == 0)
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
get_storage(struct exr_reader *reader, struct spec_error *error)
{
	const char *name = reader->base.source.name;
	exr_storage_t storage;
	exr_result_t result = exr_get_storage(reader->context, reader->part, &storage);
	int32_t across, down, width, height, lines = 1;

	if (result != EXR_ERR_SUCCESS)
		return spec_exr_error(result, name, error);
	if (storage == EXR_STORAGE_DEEP_SCANLINE || storage == EXR_STORAGE_DEEP_TILED)
		return spec_error_set(
			error, SPEC_EUNSUPPORTED, "%s: holds deep data", name);
	if (reader->base.image.compression == EXR_COMPRESSION_DWAA ||
		reader->base.image.compression == EXR_COMPRESSION_DWAB)
		return spec_error_set(error, SPEC_EUNSUPPORTED,
			"%s: DWA compression is not in this version of OpenEXRCore", name);
	if (reader->base.image.compression < EXR_COMPRESSION_NONE ||
		reader->base.image.compression > EXR_COMPRESSION_B44A)
		return spec_error_set(error, SPEC_EFORMAT, "%s: compression %d is unknown",
			name, reader->base.image.compression);
	reader->tiled = storage == EXR_STORAGE_TILED;
	if (!reader->tiled) {
		result = exr_get_scanlines_per_chunk(reader->context, reader->part, &lines);
		reader->base.chunk_lines = lines;
	} else {
		result = exr_get_tile_sizes(
			reader->context, reader->part, 0, 0, &width, &height);
		if (result == EXR_ERR_SUCCESS)
			result = exr_get_tile_levels(
				reader->context, reader->part, &across, &down);
		if (result == EXR_ERR_SUCCESS) {
			int tile = width < 1 ? 1 : width;

			reader->tile_width = tile;
			reader->base.chunk_lines = height < 1 ? 1 : height;
			reader->tiles_across =
				(int)((spec_window_width(&reader->base.image.data) + tile -
					      1) /
					tile);
		}
	}
	if (result != EXR_ERR_SUCCESS)
		return spec_exr_error(result, name, error);
	if (reader->base.chunk_lines < 1)
		return spec_error_set(
			error, SPEC_EFORMAT, "%s: its storage is unknown", name);
	return SPEC_OK;
}

static enum spec_status
measure_lines(struct exr_reader *reader, struct spec_error *error)
{
	const struct spec_image *image = &reader->base.image;
	size_t width = spec_window_width(&image->data), bytes = 0;

	reader->offset =
		spec_memory_new(image->channels, sizeof *reader->offset, "channels", error);
	if (!reader->offset)
		return SPEC_ENOMEM;
	for (size_t i = 0; i < image->channels; i++) {
		reader->offset[i] = bytes;
		bytes += width * spec_exr_sample_bytes(image->channel[i].sample);
	}
	reader->base.line_bytes = bytes;
	return spec_reading_check_memory(&reader->base, error);
}

/* A pipe is read forward only; tiles, several parts and other line orders need a copy. */
static enum spec_status
settle_source(struct exr_reader *reader, int parts, struct spec_error *error)
{
	exr_lineorder_t order = EXR_LINEORDER_INCREASING_Y;
	enum spec_status status = SPEC_OK;

	exr_get_lineorder(reader->context, reader->part, &order);
	reader->base.storage.parts = parts;
	reader->base.storage.part = reader->part;
	reader->base.storage.increasing = order == EXR_LINEORDER_INCREASING_Y;
	if (reader->tiled) {
		reader->base.storage.tile_width = reader->tile_width;
		reader->base.storage.tile_height = reader->base.chunk_lines;
	}
	if (!reader->base.source.seekable &&
		(reader->tiled || parts > 1 || order != EXR_LINEORDER_INCREASING_Y))
		status = spec_source_spool(&reader->base.source, error);
	spec_source_seal(&reader->base.source);
	return status;
}

static enum spec_status
open_reader(struct spec_reader *base, const char *path,
	const struct spec_settings *settings, struct spec_error *error)
{
	struct exr_reader *reader = (struct exr_reader *)base;
	int parts = 0;
	enum spec_status status = spec_scan_header(&base->source, &settings->limits, error);

	if (status == SPEC_OK)
		status = start(reader, error);
	if (status == SPEC_OK && exr_get_count(reader->context, &parts) != EXR_ERR_SUCCESS)
		status = spec_error_set(error, SPEC_EFORMAT, "%s: has no part", path);
	if (status == SPEC_OK)
		status = choose_part(reader, settings, parts, error);
	if (status == SPEC_OK)
		status = get_image(reader, reader->part, settings, &base->image, error);
	if (status == SPEC_OK)
		status = get_storage(reader, error);
	if (status == SPEC_OK)
		status = measure_lines(reader, error);
	if (status == SPEC_OK)
		status = settle_source(reader, parts, error);
	return status;
}

static void
close_reader(struct spec_reader *base)
{
	struct exr_reader *reader = (struct exr_reader *)base;

	if (reader->context)
		exr_finish(&reader->context);
	free(reader->offset);
	free(reader->kept);
}

const struct spec_reading_format spec_reading_exr = {
	.name = "OpenEXR",
	.reader_bytes = sizeof(struct exr_reader),
	.decoder_bytes = sizeof(struct exr_decoder),
	.recognises = recognises,
	.open = open_reader,
	.close = close_reader,
	.open_decoder = exr_open_decoder,
	.close_decoder = exr_close_decoder,
	.shares = spec_reading_seekable,
	.fetch = exr_fetch,
	.decode = exr_decode,
};
