#include "image/reader.h"

#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>

#include "base/memory.h"
#include "image/expandedreader.h"
#include "image/reading.h"

#define BLOCK_COPIES 4 /* packed, unpacked, scratch and converted */

#define FORMATS 4

/* Tried in this order. */
static const struct spec_reading_format *const formats[FORMATS] = {
	&spec_reading_exr, &spec_reading_hsr, &spec_reading_picture, &spec_reading_envi};

/* ---- what formats use ---- */

enum spec_status
spec_reading_reserve(
	struct spec_buffer *buffer, size_t size, size_t kept, struct spec_error *error)
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

enum spec_status
spec_reading_planes(struct spec_decoder *decoder, struct spec_error *error)
{
	const struct spec_image *image = &decoder->reader->image;
	size_t room = spec_reading_align(spec_window_width(&image->data) * sizeof(float));
	size_t planes = 0;
	unsigned char *to;
	enum spec_status status;

	for (size_t i = 0; i < image->channels; i++)
		planes += decoder->wanted[i];
	status = spec_reading_reserve(
		&decoder->converted, planes * decoder->lines * room, 0, error);
	to = decoder->converted.bytes;
	for (size_t i = 0; status == SPEC_OK && i < image->channels * decoder->lines; i++) {
		decoder->row[i] = NULL;
		if (decoder->wanted[i % image->channels]) {
			decoder->row[i] = (float *)(void *)to;
			to += room;
		}
	}
	return status;
}

int
spec_reading_seekable(const struct spec_reader *reader)
{
	return reader->source.seekable;
}

enum spec_status
spec_reading_check_size(const struct spec_reader *reader, long long width, long long height,
	struct spec_error *error)
{
	const char *name = reader->source.name;

	if (width < 1 || height < 1)
		return spec_error_set(error, SPEC_ERANGE, "%s: has no pixel", name);
	if (width > reader->limits.pixels / height)
		return spec_error_set(error, SPEC_ERANGE,
			"%s: %lld x %lld pixels are more than the limit of %lld (--limit "
			"pixels=N)",
			name, width, height, reader->limits.pixels);
	return SPEC_OK;
}

enum spec_status
spec_reading_check_memory(const struct spec_reader *reader, struct spec_error *error)
{
	size_t lines = reader->chunk_lines, bytes = reader->line_bytes;
	size_t height = spec_window_height(&reader->image.data);

	if (lines > height)
		lines = height;
	if (bytes > (size_t)reader->limits.memory / lines / BLOCK_COPIES)
		return spec_error_set(error, SPEC_ERANGE,
			"%s: %zu lines of %zu bytes need more than the limit of %lld bytes "
			"of memory (--limit memory=BYTES)",
			reader->source.name, lines, bytes, reader->limits.memory);
	return SPEC_OK;
}

/* ---- readers ---- */

static const struct spec_reading_format *
recognise(const unsigned char *bytes, size_t size, const char *path)
{
	for (size_t i = 0; i < FORMATS; i++) {
		if (formats[i]->recognises(bytes, size, path))
			return formats[i];
	}
	return NULL;
}

static int
is_folder(const char *path)
{
	struct stat about;

	return strcmp(path, "-") != 0 && stat(path, &about) == 0 && S_ISDIR(about.st_mode);
}

int
spec_reader_recognises(const char *path)
{
	unsigned char bytes[SPEC_READING_FIRST_BYTES];
	size_t size = spec_source_peek(path, bytes, sizeof bytes);

	return is_folder(path) || recognise(bytes, size, path) != NULL;
}

/* The format that an open source is in. */
static enum spec_status
find_format(struct spec_source *source, const char *path,
	const struct spec_reading_format **format, struct spec_error *error)
{
	unsigned char bytes[SPEC_READING_FIRST_BYTES];
	size_t got;
	enum spec_status status =
		spec_source_read(source, bytes, sizeof bytes, 0, &got, error);

	if (status != SPEC_OK)
		return status;
	if (got == 0)
		return spec_error_set(error, SPEC_EFORMAT, "%s: is empty", source->name);
	*format = recognise(bytes, got, path);
	if (*format)
		return SPEC_OK;
	return spec_error_set(error, SPEC_EFORMAT,
		"%s: is no image in a format that is read here", source->name);
}

/* A reader that is still to be opened; the source is its from now on, or closed. */
static struct spec_reader *
make_reader(const struct spec_reading_format *format, struct spec_source *source,
	const struct spec_settings *settings, struct spec_error *error)
{
	struct spec_reader *reader =
		spec_memory_new(1, format->reader_bytes, "readers", error);

	if (!reader) {
		spec_source_close(source);
		return NULL;
	}
	reader->format = format;
	reader->source = *source;
	reader->limits = settings->limits;
	reader->storage = (struct spec_storage){.parts = 1, .increasing = 1};
	return reader;
}

/* Bands in place of coefficients or lines, where an image has such. */
static enum spec_status
expand(struct spec_reader **reader, struct spec_error *error)
{
	struct spec_represented represented;
	enum spec_status status = spec_represented_read(
		&(*reader)->image, (*reader)->source.name, &represented, error);

	if (status == SPEC_OK && (represented.coefficients > 0 || represented.lines > 0))
		status = spec_expanded_open(reader, &represented, error);
	return status;
}

/* Opens what make_reader made; refused as in open_any. */
static enum spec_status
finish_opening(struct spec_reader **result, struct spec_reader *reader, const char *path,
	const struct spec_settings *settings, struct spec_error *refused,
	struct spec_error *error)
{
	enum spec_status status;

	reader->refused = refused;
	status = reader->format->open(reader, path, settings, error);
	reader->refused = NULL;
	if (status == SPEC_OK && !refused)
		status = expand(&reader, error);
	else if (status == SPEC_OK && refused->status == SPEC_OK &&
		 expand(&reader, refused) == SPEC_ENOMEM)
		status = spec_error_set(error, SPEC_ENOMEM, "%s", refused->message);
	if (status == SPEC_OK)
		*result = reader;
	else
		spec_reader_close(reader);
	return status;
}

/* A source of that name that holds nothing: the files are the format's own matter. */
static enum spec_status
name_source(struct spec_source *source, const char *name, struct spec_error *error)
{
	*source = (struct spec_source){.fd = -1, .size = -1};
	source->name = spec_memory_text(name, strlen(name), error);
	return source->name ? SPEC_OK : SPEC_ENOMEM;
}

/* refused: null, or where bad names and attributes are noted. */
static enum spec_status
open_any(struct spec_reader **result, const char *path,
	const struct spec_settings *settings, struct spec_error *refused,
	struct spec_error *error)
{
	const struct spec_reading_format *format = &spec_reading_picture;
	struct spec_reader *reader;
	struct spec_source source;
	enum spec_status status;

	*result = NULL;
	if (is_folder(path)) {
		status = name_source(&source, path, error);
	} else {
		status = spec_source_open(
			&source, path, (size_t)settings->limits.header, error);
		if (status != SPEC_OK)
			return status;
		if (settings->reread && !source.seekable)
			status = spec_source_spool(&source, error);
		if (status == SPEC_OK)
			status = find_format(&source, path, &format, error);
		if (status != SPEC_OK)
			spec_source_close(&source);
	}
	if (status != SPEC_OK)
		return status;
	reader = make_reader(format, &source, settings, error);
	return reader ? finish_opening(result, reader, path, settings, refused, error)
		      : SPEC_ENOMEM;
}

enum spec_status
spec_reader_open(struct spec_reader **reader, const char *path,
	const struct spec_settings *settings, struct spec_error *error)
{
	return open_any(reader, path, settings, NULL, error);
}

enum spec_status
spec_reader_open_lenient(struct spec_reader **reader, const char *path,
	const struct spec_settings *settings, struct spec_error *refused,
	struct spec_error *error)
{
	*refused = (struct spec_error){0};
	return open_any(reader, path, settings, refused, error);
}

enum spec_status
spec_reader_open_list(struct spec_reader **result, const char *const *path, size_t count,
	const struct spec_settings *settings, struct spec_error *error)
{
	struct spec_reader *reader;
	struct spec_source source;
	enum spec_status status = name_source(&source, path[0], error);

	*result = NULL;
	if (status != SPEC_OK)
		return status;
	reader = make_reader(&spec_reading_picture, &source, settings, error);
	if (!reader)
		return SPEC_ENOMEM;
	for (size_t i = 0; i < count && status == SPEC_OK; i++)
		status = spec_reading_add_picture(reader, path[i], error);
	if (status != SPEC_OK) {
		spec_reader_close(reader);
		return status;
	}
	return finish_opening(result, reader, path[0], settings, NULL, error);
}

void
spec_reader_close(struct spec_reader *reader)
{
	if (!reader)
		return;
	reader->format->close(reader);
	spec_source_close(&reader->source);
	spec_image_clear(&reader->image);
	free(reader->representation);
	free(reader);
}

enum spec_status
spec_reader_drain(struct spec_reader *reader, struct spec_error *error)
{
	return reader->format->drain ? reader->format->drain(reader, error)
				     : spec_source_drain(&reader->source, error);
}

const struct spec_image *
spec_reader_image(const struct spec_reader *reader)
{
	return &reader->image;
}

struct spec_image *
spec_reader_header(struct spec_reader *reader)
{
	return &reader->image;
}

const char *
spec_reader_name(const struct spec_reader *reader)
{
	return reader->source.name;
}

const char *
spec_reader_format(const struct spec_reader *reader)
{
	return reader->format->name;
}

struct spec_storage
spec_reader_storage(const struct spec_reader *reader)
{
	return reader->storage;
}

const char *
spec_reader_representation(const struct spec_reader *reader)
{
	return reader->representation ? reader->representation : "";
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

/* ---- decoders ---- */

enum spec_status
spec_decoder_open(struct spec_decoder **result, struct spec_reader *reader,
	const unsigned char *wanted, struct spec_error *error)
{
	const struct spec_reading_format *format = reader->format;
	struct spec_decoder *decoder =
		spec_memory_new(1, format->decoder_bytes, "decoders", error);
	size_t channels = reader->image.channels;
	enum spec_status status = SPEC_OK;

	*result = NULL;
	if (!decoder)
		return SPEC_ENOMEM;
	decoder->reader = reader;
	decoder->wanted = spec_memory_new(channels, 1, "channels", error);
	if (!decoder->wanted)
		status = SPEC_ENOMEM;
	for (size_t i = 0; status == SPEC_OK && i < channels; i++)
		decoder->wanted[i] = wanted ? wanted[i] : 1;
	if (status == SPEC_OK && format->open_decoder)
		status = format->open_decoder(decoder, error);
	if (status == SPEC_OK)
		*result = decoder;
	else
		spec_decoder_close(decoder);
	return status;
}

void
spec_decoder_close(struct spec_decoder *decoder)
{
	if (!decoder)
		return;
	if (decoder->reader->format->close_decoder)
		decoder->reader->format->close_decoder(decoder);
	free(decoder->wanted);
	free(decoder->packed.bytes);
	free(decoder->converted.bytes);
	free(decoder->row);
	free(decoder);
}

int
spec_reader_shares(const struct spec_reader *reader)
{
	return reader->format->shares && reader->format->shares(reader);
}

enum spec_status
spec_decoder_fetch(struct spec_decoder *decoder, int y0, int y1, struct spec_error *error)
{
	decoder->y0 = y0;
	decoder->lines = y1 - y0;
	return decoder->reader->format->fetch(decoder, error);
}

enum spec_status
spec_decoder_decode(struct spec_decoder *decoder, struct spec_error *error)
{
	void *rows = decoder->row;
	enum spec_status status = spec_memory_grow(&rows, &decoder->row_room,
		decoder->lines * decoder->reader->image.channels, sizeof *decoder->row,
		"rows", error);

	decoder->row = rows;
	return status == SPEC_OK ? decoder->reader->format->decode(decoder, error) : status;
}

enum spec_status
spec_decoder_read(struct spec_decoder *decoder, int y, struct spec_error *error)
{
	enum spec_status status = spec_decoder_fetch(decoder, y, y + 1, error);

	return status == SPEC_OK ? spec_decoder_decode(decoder, error) : status;
}

const float *
spec_decoder_row(const struct spec_decoder *decoder, int y, size_t channel)
{
	return decoder->row[(y - decoder->y0) * decoder->reader->image.channels + channel];
}
