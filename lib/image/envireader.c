/* Reading ENVI files: a text header beside raw data. */
#include <math.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>

#include "base/memory.h"
#include "base/path.h"
#include "image/envireading.h"

#define MOST_HEADER (16 << 20) /* bytes */

/* ---- the two files ---- */

static int
is_header(const unsigned char *bytes, size_t size)
{
	return size >= 5 && memcmp(bytes, "ENVI", 4) == 0 &&
	       (bytes[4] == '\n' || bytes[4] == '\r' || bytes[4] == ' ');
}

/* Where a path's suffix begins, or its end. */
static size_t
stem_length(const char *path)
{
	return (size_t)(spec_path_suffix(path) - path);
}

/* A path of which the first so many bytes are followed by a suffix; empty: too long. */
static void
with_suffix(char *path, size_t room, const char *stem, size_t length, const char *suffix)
{
	if (length + strlen(suffix) >= room)
		*path = '\0';
	else
		snprintf(path, room, "%.*s%s", (int)length, stem, suffix);
}

/* The header of raw data: NAME.hdr beside NAME.img or NAME, or NAME.img.hdr. */
static int
find_header(const char *path, char *header, size_t room)
{
	size_t ends[] = {strlen(path), stem_length(path)};

	for (size_t i = 0; i < 2; i++) {
		unsigned char bytes[8];
		size_t got;
		FILE *file;

		with_suffix(header, room, path, ends[i], ".hdr");
		file = *header && strcmp(header, path) != 0 ? fopen(header, "re") : NULL;
		if (!file)
			continue;
		got = fread(bytes, 1, sizeof bytes, file);
		fclose(file);
		if (is_header(bytes, got))
			return 1;
	}
	return 0;
}

static int
recognises(const unsigned char *bytes, size_t size, const char *path)
{
	char header[4096];

	return is_header(bytes, size) ||
	       (strcmp(path, "-") != 0 && find_header(path, header, sizeof header));
}

/* The data of a header's path; the header's own name stands for them in messages. */
static enum spec_status
open_data(struct envi_reader *reader, const char *path, struct spec_error *error)
{
	static const char *const suffixes[] = {"", ".img", ".raw", ".dat", ".bin", ".bsq",
		".bil", ".bip", ".cube", ".hyspex", ".IMG", ".RAW", ".DAT", ".BIN", ".BSQ",
		".BIL", ".BIP"};
	char name[4096];
	struct stat about;

	if (strcmp(path, "-") == 0)
		return spec_error_set(error, SPEC_EUSAGE,
			"%s: is the header of an ENVI file, whose data lie in another one: "
			"name the file",
			reader->base.source.name);
	for (size_t i = 0; i < sizeof suffixes / sizeof *suffixes; i++) {
		with_suffix(name, sizeof name, path, stem_length(path), suffixes[i]);
		/* A folder of the image's name is often beside it. */
		if (*name && strcmp(name, path) != 0 && stat(name, &about) == 0 &&
			!S_ISDIR(about.st_mode)) {
			reader->from = &reader->data;
			return spec_source_open(&reader->data, name, 1, error);
		}
	}
	return spec_error_set(error, SPEC_EIO,
		"%s: the data that it describes were not found beside it (%.*s, .img, .raw "
		"…)",
		path, (int)stem_length(path), path);
}

static enum spec_status
read_all(struct spec_source *source, char **text, size_t *size, struct spec_error *error)
{
	enum spec_status status = SPEC_OK;
	size_t room = 0, got = 1;
	void *list = NULL;

	*size = 0;
	while (status == SPEC_OK && got > 0) {
		status = spec_memory_grow(&list, &room, *size + 65536, 1, "bytes", error);
		*text = list;
		if (status == SPEC_OK)
			status = spec_source_read(source, *text + *size, room - *size,
				(int64_t)*size, &got, error);
		*size += got;
		if (status == SPEC_OK && *size > MOST_HEADER)
			status = spec_error_set(error, SPEC_ERANGE,
				"%s: a header of more than %d bytes", source->name,
				MOST_HEADER);
	}
	return status;
}

static enum spec_status
read_header(struct envi_reader *reader, const char *path, struct spec_error *error)
{
	struct spec_source other = {.fd = -1};
	struct spec_source *source = &reader->base.source;
	unsigned char bytes[8];
	char name[4096], *text = NULL;
	size_t got, size = 0;
	enum spec_status status =
		spec_source_read(source, bytes, sizeof bytes, 0, &got, error);

	if (status == SPEC_OK && is_header(bytes, got)) {
		status = open_data(reader, path, error);
	} else if (status == SPEC_OK) {
		reader->from = source;
		find_header(path, name, sizeof name);
		source = &other;
		status = spec_source_open(&other, name, MOST_HEADER, error);
	}
	if (status == SPEC_OK)
		status = read_all(source, &text, &size, error);
	if (status == SPEC_OK)
		status =
			envi_header_parse(text, size, source->name, &reader->header, error);
	free(text);
	if (source == &other)
		spec_source_close(&other);
	return status;
}

static enum spec_status
check_data(const struct envi_reader *reader, struct spec_error *error)
{
	const struct envi_header *header = &reader->header;
	long long needed;

	if (__builtin_mul_overflow(header->lines * header->samples,
		    header->bands * (long long)envi_type_bytes(header->type), &needed) ||
		__builtin_add_overflow(needed, header->offset, &needed))
		return spec_error_set(error, SPEC_ERANGE,
			"%s: describes more bytes than a file can have",
			reader->base.source.name);
	if (!reader->from->seekable)
		return spec_error_set(error, SPEC_EUNSUPPORTED,
			"%s: the data of an ENVI file must be a regular file",
			reader->from->name);
	if (reader->from->size < needed)
		return spec_error_set(error, SPEC_EFORMAT,
			"%s: ends early: has %lld bytes instead of %lld",
			reader->from->name, (long long)reader->from->size, needed);
	return SPEC_OK;
}

static enum spec_status
open_reader(struct spec_reader *base, const char *path,
	const struct spec_settings *settings, struct spec_error *error)
{
	struct envi_reader *reader = (struct envi_reader *)base;
	const struct envi_header *header = &reader->header;
	enum spec_status status;

	reader->data.fd = -1;
	status = read_header(reader, path, error);
	if (status == SPEC_OK && header->bands > settings->limits.channels)
		status = spec_error_set(error, SPEC_ERANGE,
			"%s: %lld bands are more than the limit of %lld (--limit channels=N)",
			base->source.name, header->bands, settings->limits.channels);
	if (status == SPEC_OK)
		status = spec_reading_check_size(
			base, header->samples, header->lines, error);
	if (status == SPEC_OK)
		status = check_data(reader, error);
	if (status == SPEC_OK)
		status = envi_describe(reader, settings, error);
	if (status == SPEC_OK)
		spec_source_seal(reader->from);
	base->chunk_lines = 1;
	base->line_bytes = (size_t)(header->samples * header->bands) *
			   (sizeof(float) > envi_type_bytes(header->type)
					   ? sizeof(float)
					   : envi_type_bytes(header->type));
	return status == SPEC_OK ? spec_reading_check_memory(base, error) : status;
}

static void
close_reader(struct spec_reader *base)
{
	struct envi_reader *reader = (struct envi_reader *)base;

	envi_header_free(&reader->header);
	spec_source_close(&reader->data);
	free(reader->band);
	free(reader->gain);
	free(reader->offset);
}

/* ---- lines ---- */

static enum spec_status
read_bytes(struct envi_reader *reader, unsigned char *to, size_t size, long long at,
	struct spec_error *error)
{
	size_t got;
	enum spec_status status = spec_source_read(
		reader->from, to, size, reader->header.offset + at, &got, error);

	if (status == SPEC_OK && got < size)
		status = spec_error_set(
			error, SPEC_EFORMAT, "%s: ends early", reader->from->name);
	return status;
}

static int
shares(const struct spec_reader *reader)
{
	return ((const struct envi_reader *)reader)->from->seekable;
}

/* Of a BSQ file the wanted bands alone, each with its lines; of others the lines. */
static enum spec_status
fetch(struct spec_decoder *decoder, struct spec_error *error)
{
	struct envi_reader *reader = (struct envi_reader *)decoder->reader;
	const struct envi_header *header = &reader->header;
	size_t bytes = (size_t)header->samples * envi_type_bytes(header->type),
	       block = bytes * decoder->lines;
	long long first = decoder->y0 - reader->base.image.data.y0;
	enum spec_status status = spec_reading_reserve(
		&decoder->packed, block * (size_t)header->bands, 0, error);

	if (status != SPEC_OK)
		return status;
	if (header->interleave != ENVI_BSQ)
		return read_bytes(reader, decoder->packed.bytes,
			block * (size_t)header->bands,
			first * (long long)bytes * header->bands, error);
	for (size_t i = 0; i < reader->base.image.channels && status == SPEC_OK; i++) {
		size_t band = reader->band[i];

		if (decoder->wanted[i])
			status = read_bytes(reader, decoder->packed.bytes + band * block,
				block,
				((long long)band * header->lines + first) *
					(long long)bytes,
				error);
	}
	return status;
}

/* Reads count numbers of a C type, step bytes apart, in either byte order. */
#define CONVERT(type, bits)                                                                \
	for (size_t x = 0; x < count; x++, from += step) {                                 \
		uint##bits##_t raw;                                                        \
		type number;                                                               \
                                                                                           \
		memcpy(&raw, from, sizeof raw);                                            \
		if (swapped)                                                               \
			raw = __builtin_bswap##bits(raw);                                  \
		memcpy(&number, &raw, sizeof number);                                      \
		to[x] = (float)number;                                                     \
	}                                                                                  \
	break

static void
convert(int type, int swapped, const unsigned char *from, size_t step, float *to,
	size_t count)
{
	switch (type) {
	case ENVI_U8:
		for (size_t x = 0; x < count; x++, from += step)
			to[x] = *from;
		break;
	case ENVI_I16:
		CONVERT(int16_t, 16);
	case ENVI_U16:
		CONVERT(uint16_t, 16);
	case ENVI_I32:
		CONVERT(int32_t, 32);
	case ENVI_U32:
		CONVERT(uint32_t, 32);
	case ENVI_I64:
		CONVERT(int64_t, 64);
	case ENVI_U64:
		CONVERT(uint64_t, 64);
	case ENVI_F64:
		CONVERT(double, 64);
	default:
		CONVERT(float, 32);
	}
}

static void
scale(const struct envi_reader *reader, size_t band, float *row, size_t count)
{
	double gain = reader->gain ? reader->gain[band] : 1,
	       offset = reader->offset ? reader->offset[band] : 0;

	if (!isnan(reader->ignored)) {
		for (size_t x = 0; x < count; x++)
			if (row[x] == (float)reader->ignored)
				row[x] = NAN;
	}
	if (gain == 1 && offset == 0)
		return;
	for (size_t x = 0; x < count; x++)
		row[x] = (float)(row[x] * gain + offset);
}

/* Where a band's first sample in a line of what was fetched lies, in samples. */
static size_t
place(const struct envi_header *header, size_t band, size_t line, size_t lines)
{
	size_t width = (size_t)header->samples, bands = (size_t)header->bands;

	switch (header->interleave) {
	case ENVI_BSQ:
		return (band * lines + line) * width;
	case ENVI_BIL:
		return (line * bands + band) * width;
	default:
		return line * width * bands + band;
	}
}

/* Floats of this machine's that lie line by line can be used where they were fetched. */
static int
needs_no_copy(const struct envi_reader *reader)
{
	const struct envi_header *header = &reader->header;

	return header->type == ENVI_F32 && !header->swapped &&
	       header->interleave != ENVI_BIP && !reader->gain && !reader->offset &&
	       isnan(reader->ignored);
}

static void
point(struct spec_decoder *decoder, const struct envi_reader *reader)
{
	size_t channels = reader->base.image.channels, lines = (size_t)decoder->lines;

	for (size_t i = 0; i < lines * channels; i++)
		decoder->row[i] = (float *)(void *)decoder->packed.bytes +
				  place(&reader->header, reader->band[i % channels],
					  i / channels, lines);
}

/* One line; pixel by pixel so few at a time that their bands stay in the cache. */
static void
decode_line(const struct envi_reader *reader, const struct spec_decoder *decoder,
	size_t line, float *const *row)
{
	const struct envi_header *header = &reader->header;
	size_t size = envi_type_bytes(header->type), width = (size_t)header->samples,
	       channels = reader->base.image.channels, pixel = (size_t)header->bands * size,
	       step = header->interleave == ENVI_BIP ? pixel : size,
	       run = header->interleave == ENVI_BIP ? spec_reading_run(pixel) : width;

	for (size_t x = 0; x < width; x += run) {
		for (size_t i = 0; i < channels; i++) {
			const unsigned char *from = decoder->packed.bytes +
						    place(header, reader->band[i], line,
							    (size_t)decoder->lines) *
							    size +
						    x * step;

			if (row[i])
				convert(header->type, header->swapped, from, step,
					row[i] + x, width - x < run ? width - x : run);
		}
	}
	for (size_t i = 0; i < channels; i++) {
		if (row[i])
			scale(reader, reader->band[i], row[i], width);
	}
}

static enum spec_status
decode(struct spec_decoder *decoder, struct spec_error *error)
{
	const struct envi_reader *reader = (const struct envi_reader *)decoder->reader;
	enum spec_status status;

	if (needs_no_copy(reader)) {
		point(decoder, reader);
		return SPEC_OK;
	}
	status = spec_reading_planes(decoder, error);
	for (size_t line = 0; status == SPEC_OK && line < (size_t)decoder->lines; line++)
		decode_line(reader, decoder, line,
			decoder->row + line * reader->base.image.channels);
	return status;
}

const struct spec_reading_format spec_reading_envi = {
	.name = "ENVI",
	.reader_bytes = sizeof(struct envi_reader),
	.decoder_bytes = sizeof(struct spec_decoder),
	.recognises = recognises,
	.open = open_reader,
	.close = close_reader,
	.shares = shares,
	.fetch = fetch,
	.decode = decode,
};
