/*
 * Reading Radiance's spectral pictures: a text header, then pixels of one byte for each
 * band, from the longest wavelength on, and an exponent that they share.
 * Source: Ward and others, Radiance 6.0 (2024), color.h and color.c.
 */
#include <errno.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <strings.h>

#include "base/memory.h"
#include "base/number.h"
#include "image/hsr.h"
#include "image/reading.h"

#define MOST_HEADER (1 << 20) /* bytes */

struct hsr_reader {
	struct spec_reader base;
	size_t bands; /* of a pixel in the file: NCOMP */
	double longest_nm, shortest_nm;
	double exposure;
	double power[256];     /* of two, that each byte of an exponent stands for */
	int64_t data;          /* where the pixels begin */
	unsigned char *header; /* of so many bytes, pixels behind it perhaps among them */
	size_t header_bytes;
	char *other; /* the header's lines that mean nothing here */
	size_t other_bytes, other_room;
	int spectral; /* the format's line was there */
};

/* Pictures of red, green and blue begin alike: the name tells them apart, or the format. */
static int
recognises(const unsigned char *bytes, size_t size, const char *path)
{
	static const char format[] = "_spectra\n";
	size_t length = strlen(path);

	if (size < 10 || memcmp(bytes, "#?RADIANCE", 10) != 0)
		return 0;
	return strcmp(path, "-") == 0 ||
	       (length > 4 && strcasecmp(path + length - 4, ".hsr") == 0) ||
	       memmem(bytes, size, format, sizeof format - 1);
}

/* ---- the header ---- */

static enum spec_status
fail_line(const struct hsr_reader *reader, const char *what, const char *line,
	struct spec_error *error)
{
	return spec_error_set(error, SPEC_EFORMAT, "%s: %s: '%.60s'",
		reader->base.source.name, what, line);
}

static enum spec_status
keep_line(struct hsr_reader *reader, const char *line, struct spec_error *error)
{
	size_t length = strlen(line);
	void *list = reader->other;
	enum spec_status status = spec_memory_grow(&list, &reader->other_room,
		reader->other_bytes + length + 2, 1, "bytes", error);

	reader->other = list;
	if (status != SPEC_OK)
		return status;
	memcpy(reader->other + reader->other_bytes, line, length);
	reader->other_bytes += length;
	reader->other[reader->other_bytes++] = '\n';
	return SPEC_OK;
}

/* FORMAT= of the two versions that there were; both have the same pixels. */
static enum spec_status
take_format(struct hsr_reader *reader, const char *text, struct spec_error *error)
{
	text += strspn(text, " ");
	if (strcmp(text, "Radiance_spectra") != 0 &&
		strcmp(text, "Radiance_rle_spectra") != 0)
		return spec_error_set(error, SPEC_EUNSUPPORTED,
			"%s: is in Radiance's format '%.40s', which has no spectra",
			reader->base.source.name, text);
	reader->spectral = 1;
	return SPEC_OK;
}

static enum spec_status
take_line(struct hsr_reader *reader, const char *line, struct spec_error *error)
{
	struct spec_image *image = &reader->base.image;
	long long count;
	double number, split[2];

	if (strncmp(line, "FORMAT=", 7) == 0)
		return take_format(reader, line + 7, error);
	if (strncmp(line, "NCOMP=", 6) == 0) {
		if (spec_number_parse_whole(line + 6, 4, 32767, "bands", &count, NULL) !=
			SPEC_OK)
			return fail_line(
				reader, "is no number of bands, 4 to 32767", line, error);
		reader->bands = (size_t)count;
		return SPEC_OK;
	}
	if (strncmp(line, "WAVELENGTH_SPLITS=", 18) == 0) {
		if (sscanf(line + 18, "%lf %lf %lf %lf", &reader->longest_nm, &split[0],
			    &split[1], &reader->shortest_nm) != 4)
			return fail_line(reader, "are not four wavelengths", line, error);
		return SPEC_OK;
	}
	if (strncmp(line, "EXPOSURE=", 9) == 0) {
		if (sscanf(line + 9, "%lf", &number) != 1 || !(number > 0) ||
			!isfinite(number))
			return fail_line(reader, "is no exposure", line, error);
		reader->exposure *= number;
		return SPEC_OK;
	}
	if (strncmp(line, "PIXASPECT=", 10) == 0 &&
		sscanf(line + 10, "%lf", &number) == 1 && number > 0) {
		/* Radiance's is height over width; OpenEXR's width over height. */
		image->pixel_aspect_ratio = (float)(1 / number);
		return SPEC_OK;
	}
	return strncmp(line, "#?", 2) == 0 ? SPEC_OK : keep_line(reader, line, error);
}

/* "-Y HEIGHT +X WIDTH": rows from the top, pixels from the left. */
static enum spec_status
take_size(struct hsr_reader *reader, const char *line, struct spec_error *error)
{
	struct spec_image *image = &reader->base.image;
	long long width, height;
	char end;

	if (sscanf(line, "-Y %lld +X %lld%c", &height, &width, &end) != 2) {
		if (strchr("+-", *line))
			return spec_error_set(error, SPEC_EUNSUPPORTED,
				"%s: its rows do not go from left to right and top to "
				"bottom: '%.40s'",
				reader->base.source.name, line);
		return fail_line(reader, "is no size of a picture", line, error);
	}
	if (spec_reading_check_size(&reader->base, width, height, error) != SPEC_OK)
		return SPEC_ERANGE;
	if (width > 1 << 30 || height > 1 << 30)
		return fail_line(reader, "is too large", line, error);
	image->data.x1 = image->display.x1 = (int)width;
	image->data.y1 = image->display.y1 = (int)height;
	return SPEC_OK;
}

/* The next line of the header, without its break; null: it does not end there. */
static char *
next_line(const struct hsr_reader *reader, int64_t *at)
{
	char *line = (char *)reader->header + *at;
	char *end = memchr(line, '\n', reader->header_bytes - (size_t)*at);

	if (!end)
		return NULL;
	*end = '\0';
	*at = end + 1 - (char *)reader->header;
	return line;
}

static enum spec_status
read_header(struct hsr_reader *reader, struct spec_error *error)
{
	enum spec_status status;
	int body = 0;
	char *line;

	reader->header = spec_memory_new(MOST_HEADER, 1, "bytes", error);
	if (!reader->header)
		return SPEC_ENOMEM;
	status = spec_source_read(&reader->base.source, reader->header, MOST_HEADER, 0,
		&reader->header_bytes, error);
	while (status == SPEC_OK) {
		line = next_line(reader, &reader->data);
		if (!line)
			return spec_error_set(error, SPEC_EFORMAT,
				"%s: the header is cut short", reader->base.source.name);
		if (body)
			return take_size(reader, line, error);
		if (!*line)
			body = 1;
		else
			status = take_line(reader, line, error);
	}
	return status;
}

/* ---- the image ---- */

/* Bands of one width, those of the file from the end. */
static enum spec_status
set_bands(struct hsr_reader *reader, struct spec_error *error)
{
	struct spec_image *image = &reader->base.image;
	size_t bands = reader->bands;
	double *edges_nm = spec_memory_new(2 * bands + 1, sizeof *edges_nm, "bands", error),
	       *middle_nm = edges_nm ? edges_nm + bands + 1 : NULL;
	enum spec_status status = edges_nm ? SPEC_OK : SPEC_ENOMEM;

	for (size_t i = 0; i <= bands && edges_nm; i++)
		edges_nm[i] =
			reader->shortest_nm + (reader->longest_nm - reader->shortest_nm) *
						      (double)i / (double)bands;
	for (size_t i = 0; i < bands && edges_nm; i++)
		middle_nm[i] = (edges_nm[i] + edges_nm[i + 1]) / 2;
	if (status == SPEC_OK)
		status = spec_image_add_bands(image, SPEC_ROLE_EMISSIVE, 1, middle_nm,
			bands, SPEC_SAMPLE_FLOAT, error);
	if (status == SPEC_OK)
		status = spec_image_set_bins(image, edges_nm, bands, error);
	if (status == SPEC_OK)
		status = spec_image_set_text(
			image, "spec:quantity", "radiance per nm", error);
	if (status == SPEC_OK && reader->other_bytes > 0) {
		reader->other[reader->other_bytes] = '\0';
		status =
			spec_image_set_text(image, "radiance:header", reader->other, error);
	}
	if (status == SPEC_OK)
		status = spec_image_index(image, reader->base.source.name, error);
	free(edges_nm);
	return status;
}

static enum spec_status
open_reader(struct spec_reader *base, const char *path,
	const struct spec_settings *settings, struct spec_error *error)
{
	struct hsr_reader *reader = (struct hsr_reader *)base;
	const char *name = base->source.name;
	enum spec_status status;

	(void)path;
	reader->exposure = 1;
	for (int i = 0; i < 256; i++)
		reader->power[i] = hsr_power((unsigned char)i);
	base->image.pixel_aspect_ratio = base->image.screen_window_width = 1;
	status = read_header(reader, error);
	if (status == SPEC_OK && !reader->spectral)
		status = spec_error_set(error, SPEC_EFORMAT, "%s: has no FORMAT=", name);
	if (status == SPEC_OK && (reader->bands == 0 || reader->longest_nm == 0))
		status = spec_error_set(error, SPEC_EFORMAT, "%s: has no %s", name,
			reader->bands == 0 ? "NCOMP=" : "WAVELENGTH_SPLITS=");
	if (status == SPEC_OK && (long long)reader->bands > settings->limits.channels)
		status = spec_error_set(error, SPEC_ERANGE,
			"%s: %zu bands are more than the limit of %lld (--limit "
			"channels=N)",
			name, reader->bands, settings->limits.channels);
	if (status == SPEC_OK && !(reader->shortest_nm >= 1 && reader->longest_nm <= 1e6 &&
					 reader->longest_nm - reader->shortest_nm >= 1))
		status = spec_error_set(error, SPEC_EFORMAT,
			"%s: its wavelengths do not go down from %g to %g nm", name,
			reader->longest_nm, reader->shortest_nm);
	if (status == SPEC_OK)
		status = set_bands(reader, error);
	spec_source_seal(&base->source);
	base->chunk_lines = 1;
	base->line_bytes =
		spec_window_width(&base->image.data) * reader->bands * sizeof(float);
	return status == SPEC_OK ? spec_reading_check_memory(base, error) : status;
}

static void
close_reader(struct spec_reader *base)
{
	struct hsr_reader *reader = (struct hsr_reader *)base;

	free(reader->header);
	free(reader->other);
}

/* ---- lines ---- */

static enum spec_status
fetch(struct spec_decoder *decoder, struct spec_error *error)
{
	struct hsr_reader *reader = (struct hsr_reader *)decoder->reader;
	size_t line = spec_window_width(&reader->base.image.data) * (reader->bands + 1),
	       size = line * (size_t)decoder->lines, got;
	enum spec_status status = spec_reading_reserve(&decoder->packed, size, 0, error);

	if (status == SPEC_OK)
		status = spec_source_read(&reader->base.source, decoder->packed.bytes, size,
			reader->data + decoder->y0 * (int64_t)line, &got, error);
	if (status == SPEC_OK && got < size)
		status = spec_error_set(error, SPEC_EFORMAT,
			"%s: ends early, in line %d of 0..%d", reader->base.source.name,
			decoder->y0 + (int)(got / line), reader->base.image.data.y1 - 1);
	return status;
}

/* One band of count pixels, which begin at from. */
static void
decode_run(const struct hsr_reader *reader, const unsigned char *from, size_t band,
	float *row, size_t count)
{
	size_t bands = reader->bands;
	double whole = HSR_RANGE_NM * reader->exposure;

	for (size_t x = 0; x < count; x++, from += bands + 1)
		row[x] = (float)((from[bands - 1 - band] + HSR_MIDDLE) *
				 reader->power[from[bands]] / whole);
}

static enum spec_status
decode(struct spec_decoder *decoder, struct spec_error *error)
{
	const struct hsr_reader *reader = (const struct hsr_reader *)decoder->reader;
	const struct spec_image *image = &reader->base.image;
	size_t width = spec_window_width(&image->data), pixel = reader->bands + 1,
	       run = spec_reading_run(pixel);
	enum spec_status status = spec_reading_planes(decoder, error);

	for (size_t line = 0; status == SPEC_OK && line < (size_t)decoder->lines; line++) {
		const unsigned char *from = decoder->packed.bytes + line * width * pixel;
		float *const *row = decoder->row + line * image->channels;

		for (size_t x = 0; x < width; x += run, from += run * pixel) {
			for (size_t band = 0; band < reader->bands; band++) {
				float *to = row[image->band_channel[band]];

				if (to)
					decode_run(reader, from, band, to + x,
						width - x < run ? width - x : run);
			}
		}
	}
	return status;
}

const struct spec_reading_format spec_reading_hsr = {
	.name = "Radiance HSR",
	.reader_bytes = sizeof(struct hsr_reader),
	.decoder_bytes = sizeof(struct spec_decoder),
	.recognises = recognises,
	.open = open_reader,
	.close = close_reader,
	.shares = spec_reading_seekable,
	.fetch = fetch,
	.decode = decode,
};
