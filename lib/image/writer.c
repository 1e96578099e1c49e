#include "image/writer.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <strings.h>

#include "base/memory.h"
#include "base/path.h"
#include "image/exr.h"
#include "image/writing.h"

#define FORMATS 5

/* The first is the one of standard output and of names without a suffix. */
static const struct spec_writing_format *const formats[FORMATS] = {&spec_writing_exr,
	&spec_writing_envi, &spec_writing_hsr, &spec_writing_tiff, &spec_writing_folder};

/* Of a chunk of several lines: one band's bytes, and all bands' at most. */
#define BAND_BYTES (1 << 17)
#define CHUNK_BYTES (1 << 24)

/* ---- what formats use ---- */

int
spec_writing_lines(const struct spec_writer *writer, int index)
{
	long long left = (long long)spec_window_height(&writer->image->data) -
			 (long long)index * writer->chunk_lines;

	return left < writer->chunk_lines ? (int)left : writer->chunk_lines;
}

enum spec_status
spec_writing_append(struct spec_packer *packer, int index, struct spec_error *error)
{
	(void)index;
	return spec_output_write(
		packer->writer->output, packer->chunk, packer->chunk_bytes, error);
}

enum spec_status
spec_writing_only_bands(
	const struct spec_writer *writer, const char *format, struct spec_error *error)
{
	const struct spec_image *image = writer->image;

	if (image->bands == 0)
		return spec_error_set(error, SPEC_EUSAGE,
			"%s: the image has no bands to be written", writer->path);
	if (image->stokes > 1 || image->bispectral > 0)
		return spec_error_set(error, SPEC_EUNSUPPORTED,
			"%s: %s holds one value for each band, neither Stokes components "
			"nor reradiation",
			writer->path, format);
	for (size_t i = 0; i < image->channels; i++) {
		if (image->channel[i].role == SPEC_ROLE_OTHER)
			return spec_error_set(error, SPEC_EUNSUPPORTED,
				"%s: %s has no place for channel '%s' (--bands-only)",
				writer->path, format, image->channel[i].name);
		if (image->channel[i].sample == SPEC_SAMPLE_UINT)
			return spec_error_set(error, SPEC_EUNSUPPORTED,
				"%s: %s has no place for whole numbers, which '%s' has",
				writer->path, format, image->channel[i].name);
	}
	return SPEC_OK;
}

/* So few pixels at a time that what is written stays in half of a first-level cache. */
void
spec_writing_by_pixel(const struct spec_writer *writer, const unsigned char *raw, float *to)
{
	const struct spec_image *image = writer->image;
	size_t width = spec_window_width(&image->data), bands = image->bands,
	       run = 4096 / bands < 8 ? 8 : 4096 / bands;

	for (size_t first = 0; first < width; first += run) {
		size_t end = first + run < width ? first + run : width;

		for (size_t band = 0; band < bands; band++) {
			const float *from = (const float *)(const void
					*)(raw + writer->offset[image->band_channel[band]]);

			for (size_t x = first; x < end; x++)
				to[x * bands + band] = from[x];
		}
	}
}

void
spec_writing_by_band(
	const struct spec_writer *writer, int index, const unsigned char *raw, float *to)
{
	const struct spec_image *image = writer->image;
	size_t width = spec_window_width(&image->data),
	       lines = (size_t)spec_writing_lines(writer, index);

	for (size_t i = 0; i < image->bands * lines; i++, to += width)
		memcpy(to,
			raw + i % lines * writer->line_bytes +
				writer->offset[image->band_channel[i / lines]],
			width * sizeof *to);
}

int
spec_writing_plane_lines(const struct spec_writer *writer)
{
	size_t row = spec_window_width(&writer->image->data) * sizeof(float),
	       lines = BAND_BYTES / row, most = CHUNK_BYTES / writer->line_bytes;

	if (lines > most)
		lines = most;
	return lines < 1 ? 1 : (int)lines;
}

/* ---- the choice of a format ---- */

/* Whether a name is in a list with blanks between. */
static int
is_listed(const char *list, const char *name)
{
	size_t length = strlen(name);

	for (const char *at = list; *at; at += strspn(at, " ")) {
		size_t size = strcspn(at, " ");

		if (size == length && strncasecmp(at, name, length) == 0)
			return 1;
		at += size;
	}
	return 0;
}

/* What all formats together say: their names, or their suffixes. */
static void
list_known(char text[256], int suffixes)
{
	size_t length = 0;

	for (size_t i = 0; i < FORMATS && length < 256; i++) {
		const char *said = suffixes ? formats[i]->suffixes : formats[i]->name;

		length += (size_t)snprintf(text + length, 256 - length, "%s%s",
			length > 0 && *said ? " " : "", said);
	}
}

static enum spec_status
find_format(const char *name, const struct spec_writing_format **format,
	struct spec_error *error)
{
	char known[256];

	for (size_t i = 0; i < FORMATS; i++) {
		if (strcmp(formats[i]->name, name) == 0) {
			*format = formats[i];
			return SPEC_OK;
		}
	}
	list_known(known, 0);
	return spec_error_set(error, SPEC_EUSAGE, "unknown format '%s' (%s)", name, known);
}

static const struct spec_writing_format *
find_suffix(const char *suffix)
{
	for (size_t i = 0; i < FORMATS; i++)
		if (is_listed(formats[i]->suffixes, suffix))
			return formats[i];
	return NULL;
}

int
spec_writer_knows_suffix(const char *suffix)
{
	return find_suffix(suffix) != NULL;
}

enum spec_status
spec_writer_choose(const char *path, const char *name,
	const struct spec_writing_format **format, struct spec_error *error)
{
	const char *suffix = spec_path_suffix(path);
	char known[256];

	*format = formats[0];
	if (name)
		return find_format(name, format, error);
	if (strcmp(path, "-") == 0 || !*suffix)
		return SPEC_OK;
	if (find_suffix(suffix)) {
		*format = find_suffix(suffix);
		return SPEC_OK;
	}
	if (strncmp(path, "/dev/", 5) == 0)
		return SPEC_OK; /* a device's name is not a file's */
	list_known(known, 1);
	return spec_error_set(error, SPEC_EUSAGE,
		"unable to write '%s': no image format for '%s' (%s)", path, suffix, known);
}

enum spec_status
spec_writer_check_settings(const struct spec_writing_format *format,
	const struct spec_settings *settings, struct spec_error *error)
{
	if (!format->own_samples || (!settings->half && settings->compression < 0))
		return SPEC_OK;
	return spec_error_set(error, SPEC_EUSAGE, "%s: %s is for OpenEXR alone, not for %s",
		settings->output, settings->half ? "--half" : "--compression",
		format->name);
}

int
spec_writer_makes_files(const struct spec_writing_format *format)
{
	return format->makes_files;
}

/* ---- writers ---- */

static enum spec_status
measure_lines(struct spec_writer *writer, struct spec_error *error)
{
	const struct spec_image *image = writer->image;
	size_t width = spec_window_width(&image->data);

	writer->offset =
		spec_memory_new(image->channels, sizeof *writer->offset, "channels", error);
	if (!writer->offset)
		return SPEC_ENOMEM;
	writer->direct = 1;
	for (size_t i = 0; i < image->channels; i++) {
		size_t bytes = writer->format->own_samples
				       ? sizeof(float)
				       : spec_exr_sample_bytes(image->channel[i].sample);

		if (i > 0 &&
			strcmp(image->channel[i - 1].name, image->channel[i].name) >= 0)
			return spec_error_set(
				error, SPEC_EUSAGE, "channels are not in order");
		writer->offset[i] = writer->line_bytes;
		writer->line_bytes += width * bytes;
		writer->direct &= bytes == sizeof(float);
	}
	return SPEC_OK;
}

enum spec_status
spec_writer_open(struct spec_writer **result, const struct spec_image *image,
	struct spec_output *output, int compression, struct spec_error *error)
{
	return spec_writer_open_as(
		result, &spec_writing_exr, image, output, output->path, compression, error);
}

enum spec_status
spec_writer_open_as(struct spec_writer **result, const struct spec_writing_format *format,
	const struct spec_image *image, struct spec_output *output, const char *path,
	int compression, struct spec_error *error)
{
	struct spec_writer *writer =
		spec_memory_new(1, format->writer_bytes, "writers", error);
	enum spec_status status = SPEC_OK;

	*result = NULL;
	if (!writer)
		return SPEC_ENOMEM;
	writer->format = format;
	writer->image = image;
	writer->output = output;
	writer->path = output ? output->path : path;
	writer->compression = compression;
	writer->chunk_lines = 1;
	pthread_mutex_init(&writer->lock, NULL);
	spec_turnstile_init(&writer->turnstile);
	if (image->channels == 0)
		status = spec_error_set(
			error, SPEC_EUSAGE, "%s: the image has no channel", writer->path);
	if (status == SPEC_OK)
		status = measure_lines(writer, error);
	if (status == SPEC_OK)
		status = format->open(writer, error);
	if (status != SPEC_OK) {
		spec_writer_close(writer);
		return status;
	}
	writer->chunks = (spec_window_height(&image->data) + writer->chunk_lines - 1) /
			 writer->chunk_lines;
	*result = writer;
	return SPEC_OK;
}

enum spec_status
spec_writer_finish(struct spec_writer *writer, struct spec_error *error)
{
	enum spec_status status = spec_turnstile_status(&writer->turnstile, error);

	if (status != SPEC_OK)
		return status;
	/* OpenEXRCore would call a file with lines missing a success. */
	if (writer->turnstile.next != (long long)writer->chunks)
		return spec_error_set(error, SPEC_EUSAGE,
			"%s: %lld of %zu chunks were written", writer->path,
			writer->turnstile.next, writer->chunks);
	return writer->format->finish ? writer->format->finish(writer, error) : SPEC_OK;
}

enum spec_status
spec_writer_commit(struct spec_writer *writer, struct spec_error *error)
{
	return writer->format->commit ? writer->format->commit(writer, error) : SPEC_OK;
}

void
spec_writer_close(struct spec_writer *writer)
{
	if (!writer)
		return;
	if (writer->format->close)
		writer->format->close(writer);
	for (size_t i = 0; i < writer->slots; i++)
		free(writer->slot[i].raw);
	free(writer->slot);
	free(writer->offset);
	pthread_mutex_destroy(&writer->lock);
	spec_turnstile_destroy(&writer->turnstile);
	free(writer);
}

int
spec_writer_chunk_lines(const struct spec_writer *writer)
{
	return writer->chunk_lines;
}

size_t
spec_writer_line_bytes(const struct spec_writer *writer)
{
	return writer->line_bytes;
}

unsigned long long
spec_writer_overflows(const struct spec_writer *writer)
{
	return writer->overflows;
}

void
spec_writer_stop(struct spec_writer *writer, const struct spec_error *error)
{
	spec_turnstile_stop(&writer->turnstile, error);
}
