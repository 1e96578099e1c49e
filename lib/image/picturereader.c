/*
 * Reading pictures: one of red, green and blue, a file of many channels that are bands, or
 * a folder (or a list) of pictures of one band each. PNG is read here, which the plugin with
 * OpenImageIO is not loaded for; all else by that.
 */
#include <ctype.h>
#include <dirent.h>
#include <errno.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <strings.h>
#include <sys/stat.h>
#include <unistd.h>

#include "base/memory.h"
#include "base/path.h"
#include "colour/space.h"
#include "image/picturereading.h"

#define MOST_FILES 4096

/* A file of Windows' begins with two letters only: the sizes behind must fit, too. */
static int
is_bmp(const unsigned char *bytes, size_t size)
{
	return size >= 26 && memcmp(bytes, "BM", 2) == 0 &&
	       memcmp(bytes + 6, "\0\0\0\0", 4) == 0 &&
	       (bytes[14] == 12 || bytes[14] >= 40) && bytes[15] == 0;
}

/* P1..P6, PF, Pf, white space, and a number or a comment. */
static int
is_pnm(const unsigned char *bytes, size_t size)
{
	return size > 3 && bytes[0] == 'P' && bytes[1] && strchr("123456Ff", bytes[1]) &&
	       isspace(bytes[2]) && (isdigit(bytes[3]) || bytes[3] == '#');
}

/* Not GIF: OpenImageIO takes memory for its canvas, up to 16 GiB, before it tells its size. */
static int
recognises(const unsigned char *bytes, size_t size, const char *path)
{
	static const struct {
		const char *bytes;
		size_t count, at;
	} magic[] = {{"\xff\xd8\xff", 3, 0}, {"II*\0", 4, 0}, {"MM\0*", 4, 0},
		{"II+\0", 4, 0}, {"MM\0+", 4, 0}, {"#?RADIANCE", 10, 0}, {"#?RGBE", 6, 0},
		{"WEBP", 4, 8}, {"SDPX", 4, 0}, {"XPDS", 4, 0}};

	(void)path;
	for (size_t i = 0; i < sizeof magic / sizeof *magic; i++) {
		if (size >= magic[i].at + magic[i].count &&
			memcmp(bytes + magic[i].at, magic[i].bytes, magic[i].count) == 0)
			return 1;
	}
	return spec_png_recognises(bytes, size) || is_bmp(bytes, size) ||
	       is_pnm(bytes, size);
}

/* ---- the files ---- */

static enum spec_status
add_input(struct picture_reader *reader, const char *folder, const char *name,
	struct spec_error *error)
{
	size_t length = strlen(folder) + strlen(name) + 2;
	void *list = reader->input;
	enum spec_status status = spec_memory_grow(&list, &reader->input_room,
		reader->inputs + 1, sizeof *reader->input, "files", error);
	struct picture_input *input;

	reader->input = list;
	if (status != SPEC_OK)
		return status;
	input = &reader->input[reader->inputs];
	*input = (struct picture_input){
		.path = spec_memory_new(length, 1, "bytes", error), .source = {.fd = -1}};
	if (!input->path)
		return SPEC_ENOMEM;
	snprintf(input->path, length, "%s%s%s", folder, *folder ? "/" : "", name);
	reader->inputs++;
	return reader->inputs > MOST_FILES
		       ? spec_error_set(error, SPEC_ERANGE, "%s: more than %d pictures",
				 reader->base.source.name, MOST_FILES)
		       : SPEC_OK;
}

enum spec_status
spec_reading_add_picture(
	struct spec_reader *reader, const char *path, struct spec_error *error)
{
	return add_input((struct picture_reader *)reader, "", path, error);
}

static int
compare_paths(const void *a, const void *b)
{
	const struct picture_input *one = a, *two = b;

	return strverscmp(one->path, two->path);
}

/*
 * Everything in a folder but hidden files, text and folders, in the order of the names, in
 * which 2 comes before 10.
 */
static enum spec_status
list_folder(struct picture_reader *reader, const char *path, struct spec_error *error)
{
	static const char *const passed[] = {
		".txt", ".md", ".csv", ".json", ".mat", ".spd", ".pdf", ".xml", ".db"};
	enum spec_status status = SPEC_OK;
	struct dirent *entry;
	DIR *folder = opendir(path);

	if (!folder)
		return spec_error_system(error, errno, "unable to open '%s'", path);
	while (status == SPEC_OK && (entry = readdir(folder))) {
		const char *suffix = spec_path_suffix(entry->d_name);
		struct stat about;
		int pass = entry->d_name[0] == '.' || !*suffix;

		for (size_t i = 0; !pass && i < sizeof passed / sizeof *passed; i++)
			pass = strcasecmp(suffix, passed[i]) == 0;
		if (!pass && fstatat(dirfd(folder), entry->d_name, &about, 0) == 0 &&
			S_ISREG(about.st_mode))
			status = add_input(reader, path, entry->d_name, error);
	}
	closedir(folder);
	if (status == SPEC_OK && reader->inputs == 0)
		return spec_error_set(
			error, SPEC_EFORMAT, "%s: has no picture in it", path);
	if (status == SPEC_OK)
		qsort(reader->input, reader->inputs, sizeof *reader->input, compare_paths);
	return status;
}

/* Takes a picture for PNG, and begins to read it, if it is; *is_png. */
static enum spec_status
try_png(struct picture_input *input, struct spec_source *source, int *is_png,
	struct spec_error *error)
{
	unsigned char bytes[16];
	size_t got;
	enum spec_status status =
		spec_source_read(source, bytes, sizeof bytes, 0, &got, error);

	*is_png = status == SPEC_OK && spec_png_recognises(bytes, got);
	if (!*is_png)
		return status;
	status = spec_png_open(&input->png, source, &input->png_content, error);
	input->content = (struct spec_pictures_content){.format = "png",
		.width = input->png_content.width,
		.height = input->png_content.height,
		.channels = input->png_content.channels,
		.integers = 1,
		.description = ""};
	return status;
}

/* OpenImageIO wants a file by its name: a pipe is copied into one without. */
static enum spec_status
open_foreign(struct picture_reader *reader, struct picture_input *input,
	struct spec_error *error)
{
	struct spec_source *source = &reader->base.source;
	int piped = source->fd >= 0 && (!source->seekable || source->fd == STDIN_FILENO);
	char name[64];
	enum spec_status status = SPEC_OK;

	if (source->fd >= 0 && !source->seekable)
		status = spec_source_spool(source, error);
	snprintf(name, sizeof name, "/proc/self/fd/%d", source->fd);
	if (status == SPEC_OK && !reader->plugin.table)
		status = spec_plugin_load(&reader->plugin, error);
	return status == SPEC_OK
		       ? reader->plugin.table->open_input(&input->handle,
				 piped ? name : input->path, &input->content, error)
		       : status;
}

static enum spec_status
open_input(struct picture_reader *reader, struct picture_input *input,
	struct spec_error *error)
{
	struct spec_source *source = &reader->base.source;
	struct spec_error cause = {0};
	enum spec_status status = SPEC_OK;
	int is_png = 0;

	if (source->fd < 0) {
		source = &input->source;
		status = spec_source_open(
			source, input->path, (size_t)reader->base.limits.header, error);
		if (status != SPEC_OK)
			return status;
	}
	status = try_png(input, source, &is_png, &cause);
	if (status == SPEC_OK && !is_png) {
		if (source == &input->source)
			spec_source_close(source);
		status = open_foreign(reader, input, &cause);
	}
	return status == SPEC_OK ? SPEC_OK
				 : spec_error_set(error, status, "%s: %s", input->path,
					   cause.message);
}

static enum spec_status
open_inputs(struct picture_reader *reader, struct spec_error *error)
{
	struct spec_image *image = &reader->base.image;
	const struct spec_pictures_content *first;
	enum spec_status status = SPEC_OK;

	for (size_t i = 0; i < reader->inputs && status == SPEC_OK; i++)
		status = open_input(reader, &reader->input[i], error);
	if (status != SPEC_OK)
		return status;
	first = &reader->input[0].content;
	for (size_t i = 0; i < reader->inputs; i++) {
		const struct spec_pictures_content *other = &reader->input[i].content;

		/* Grey that was saved as red, green and blue is one band. */
		if (reader->base.source.fd < 0 && other->channels > 4)
			return spec_error_set(error, SPEC_EUSAGE,
				"one image at a time, or pictures of one band each: %s has "
				"%d channels",
				reader->input[i].path, other->channels);
		if (other->width != first->width || other->height != first->height)
			return spec_error_set(error, SPEC_EFORMAT,
				"%s: has %d x %d pixels, and %s has %d x %d",
				reader->input[i].path, other->width, other->height,
				reader->input[0].path, first->width, first->height);
	}
	if (spec_reading_check_size(&reader->base, first->width, first->height, error) !=
		SPEC_OK)
		return SPEC_ERANGE;
	image->data.x1 = image->display.x1 = first->width;
	image->data.y1 = image->display.y1 = first->height;
	image->pixel_aspect_ratio = image->screen_window_width = 1;
	return SPEC_OK;
}

/* ---- the reader ---- */

static enum spec_status
open_reader(struct spec_reader *base, const char *path,
	const struct spec_settings *settings, struct spec_error *error)
{
	struct picture_reader *reader = (struct picture_reader *)base;
	const struct spec_pictures_content *content;
	enum spec_status status = SPEC_OK;
	int folder = base->source.fd < 0;
	size_t channels = 0;

	if (reader->inputs == 0)
		status = folder ? list_folder(reader, path, error)
				: add_input(reader, "", base->source.name, error);
	if (status == SPEC_OK)
		status = open_inputs(reader, error);
	if (status != SPEC_OK)
		return status;
	content = &reader->input[0].content;
	status = picture_describe(reader, settings, error);
	for (size_t i = 0; i < reader->inputs; i++)
		channels += (size_t)reader->input[i].content.channels;
	base->chunk_lines = 1;
	base->line_bytes = (size_t)content->width * channels * sizeof(float);
	return status == SPEC_OK ? spec_reading_check_memory(base, error) : status;
}

static void
close_reader(struct spec_reader *base)
{
	struct picture_reader *reader = (struct picture_reader *)base;

	for (size_t i = 0; i < reader->inputs; i++) {
		struct picture_input *input = &reader->input[i];

		if (input->handle)
			reader->plugin.table->close_input(input->handle);
		spec_png_close(input->png);
		spec_source_close(&input->source);
		free(input->path);
	}
	free(reader->input);
	free(reader->from_input);
	free(reader->from_channel);
	spec_plugin_unload(&reader->plugin);
}

/* ---- lines ---- */

/* Whether a channel that is wanted comes from an input. */
static int
is_wanted(const struct spec_decoder *decoder, size_t number)
{
	const struct picture_reader *reader =
		(const struct picture_reader *)decoder->reader;

	for (size_t c = 0; c < reader->base.image.channels; c++) {
		if (decoder->wanted[c] && reader->from_input[c] == number)
			return 1;
	}
	return 0;
}

/* The lines of one wanted input after another, each with its channels interleaved. */
static enum spec_status
fetch(struct spec_decoder *decoder, struct spec_error *error)
{
	struct picture_reader *reader = (struct picture_reader *)decoder->reader;
	enum spec_status status = spec_reading_reserve(&decoder->packed,
		reader->base.line_bytes * (size_t)decoder->lines, 0, error);
	float *to = (float *)(void *)decoder->packed.bytes;
	int first = decoder->y0 - reader->base.image.data.y0, end = first + decoder->lines;
	struct spec_error cause = {0};

	for (size_t i = 0; i < reader->inputs && status == SPEC_OK; i++) {
		const struct picture_input *input = &reader->input[i];

		if (!is_wanted(decoder, i))
			continue;
		status = input->png ? spec_png_read(input->png, first, end, reader->colours,
					      reader->base.limits.memory, to, &cause)
				    : reader->plugin.table->read_input(
					      input->handle, first, end, to, &cause);
		if (status != SPEC_OK)
			status = spec_error_set(
				error, status, "%s: %s", input->path, cause.message);
		to += (size_t)input->content.width * (size_t)input->content.channels *
		      (size_t)decoder->lines;
	}
	return status;
}

/* Grey that was saved as red, green and blue is one band; what is coloured is none. */
static enum spec_status
check_grey(const struct picture_input *input, const float *from, size_t pixels,
	struct spec_error *error)
{
	size_t channels = (size_t)input->content.channels;

	for (size_t x = 0; channels >= 3 && x < pixels; x++, from += channels)
		if (from[0] != from[1] || from[0] != from[2])
			return spec_error_set(error, SPEC_EFORMAT,
				"%s: is coloured, and so not of one band", input->path);
	return SPEC_OK;
}

/* One line of one channel. */
static void
decode_row(const struct picture_reader *reader, size_t channel, const float *from,
	float *row, size_t width)
{
	const struct picture_input *input = &reader->input[reader->from_input[channel]];
	size_t step = (size_t)input->content.channels;

	for (size_t x = 0; x < width; x++)
		row[x] = from[x * step];
	if (reader->colours && input->content.encoded &&
		reader->base.image.channel[channel].name[0] != 'A') {
		for (size_t x = 0; x < width; x++)
			row[x] = (float)spec_srgb_decode(row[x]);
	}
}

/* A line of all channels of an input, so few pixels at a time that they stay in the cache. */
static void
decode_line(const struct picture_reader *reader, size_t number, const float *from,
	float *const *row, size_t width)
{
	size_t step = (size_t)reader->input[number].content.channels,
	       run = spec_reading_run(step * sizeof *from);

	for (size_t x = 0; x < width; x += run) {
		for (size_t c = 0; c < reader->base.image.channels; c++) {
			if (row[c] && reader->from_input[c] == number)
				decode_row(reader, c,
					from + x * step + reader->from_channel[c],
					row[c] + x, width - x < run ? width - x : run);
		}
	}
}

static enum spec_status
decode(struct spec_decoder *decoder, struct spec_error *error)
{
	const struct picture_reader *reader =
		(const struct picture_reader *)decoder->reader;
	size_t width = spec_window_width(&reader->base.image.data),
	       lines = (size_t)decoder->lines;
	const float *from = (const float *)(const void *)decoder->packed.bytes;
	enum spec_status status = spec_reading_planes(decoder, error);

	for (size_t i = 0; i < reader->inputs && status == SPEC_OK; i++) {
		const struct picture_input *input = &reader->input[i];
		size_t stride = width * (size_t)input->content.channels;

		if (!is_wanted(decoder, i))
			continue;
		if (reader->base.source.fd < 0)
			status = check_grey(input, from, width * lines, error);
		for (size_t line = 0; line < lines; line++, from += stride)
			decode_line(reader, i, from,
				decoder->row + line * reader->base.image.channels, width);
	}
	return status;
}

/* Where there is a folder nobody waits for it to be read. */
static enum spec_status
drain(struct spec_reader *reader, struct spec_error *error)
{
	return reader->source.fd < 0 ? SPEC_OK : spec_source_drain(&reader->source, error);
}

const struct spec_reading_format spec_reading_picture = {
	.name = "picture",
	.reader_bytes = sizeof(struct picture_reader),
	.decoder_bytes = sizeof(struct spec_decoder),
	.recognises = recognises,
	.open = open_reader,
	.close = close_reader,
	.fetch = fetch,
	.decode = decode,
	.drain = drain,
};
