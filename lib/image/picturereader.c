/*
 * Reading what OpenImageIO reads: a picture of red, green and blue, a file of many channels
 * that are bands, or a folder (or a list) of pictures of one band each.
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
#include "base/number.h"
#include "colour/space.h"
#include "image/description.h"
#include "image/given.h"
#include "image/plugin.h"
#include "image/reading.h"

#define MOST_FILES 4096

/* One file of the picture. */
struct input {
	char *path;
	void *handle;
	struct spec_pictures_content content;
	double wavelength_nm; /* that its name says, or 0 */
};

struct picture_reader {
	struct spec_reader base;
	struct spec_plugin plugin;
	struct input *input;
	size_t inputs, input_room;
	/* Of each channel of the image: which input's, and which of its channels. */
	size_t *from_input, *from_channel;
	int encoded; /* red, green and blue are to be made linear */
};

static int
recognises(const unsigned char *bytes, size_t size, const char *path)
{
	static const struct {
		const char *bytes;
		size_t count, at;
	} magic[] = {{"\x89PNG", 4, 0}, {"\xff\xd8\xff", 3, 0}, {"II*\0", 4, 0},
		{"MM\0*", 4, 0}, {"II+\0", 4, 0}, {"MM\0+", 4, 0}, {"#?RADIANCE", 10, 0},
		{"#?RGBE", 6, 0}, {"WEBP", 4, 8}, {"SDPX", 4, 0}, {"XPDS", 4, 0},
		{"GIF8", 4, 0}, {"BM", 2, 0}};

	if (strcmp(path, "-") == 0)
		return 0; /* OpenImageIO wants a file */
	for (size_t i = 0; i < sizeof magic / sizeof *magic; i++) {
		if (size >= magic[i].at + magic[i].count &&
			memcmp(bytes + magic[i].at, magic[i].bytes, magic[i].count) == 0)
			return 1;
	}
	/* P1..P6, PF, Pf, and white space. */
	return size > 2 && bytes[0] == 'P' && strchr("123456Ff", bytes[1]) && bytes[1] &&
	       isspace(bytes[2]);
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
	struct input *input;

	reader->input = list;
	if (status != SPEC_OK)
		return status;
	input = &reader->input[reader->inputs];
	*input = (struct input){.path = spec_memory_new(length, 1, "bytes", error)};
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
	const struct input *one = a, *two = b;

	return strcmp(one->path, two->path);
}

/* Everything in a folder but hidden files, text and folders, in the order of the names. */
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
		const char *dot = strrchr(entry->d_name, '.');
		struct stat about;
		int pass = entry->d_name[0] == '.' || !dot;

		for (size_t i = 0; !pass && i < sizeof passed / sizeof *passed; i++)
			pass = strcasecmp(dot, passed[i]) == 0;
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

static enum spec_status
open_input(struct picture_reader *reader, struct input *input, struct spec_error *error)
{
	struct spec_error cause = {0};
	enum spec_status status = reader->plugin.table->open_input(
		&input->handle, input->path, &input->content, &cause);

	return status == SPEC_OK ? SPEC_OK
				 : spec_error_set(error, status, "%s: %s", input->path,
					   cause.message);
}

static enum spec_status
open_inputs(struct picture_reader *reader, struct spec_error *error)
{
	struct spec_image *image = &reader->base.image;
	const struct spec_pictures_content *first;
	enum spec_status status = spec_plugin_load(&reader->plugin, error);

	for (size_t i = 0; i < reader->inputs && status == SPEC_OK; i++)
		status = open_input(reader, &reader->input[i], error);
	if (status != SPEC_OK)
		return status;
	first = &reader->input[0].content;
	for (size_t i = 0; i < reader->inputs; i++) {
		const struct spec_pictures_content *other = &reader->input[i].content;

		/* Grey that was saved as red, green and blue is one band. */
		if (reader->inputs > 1 && other->channels > 4)
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

/* ---- what they are ---- */

/* The channels and where each comes from, the image's order being by name. */
static enum spec_status
settle_channels(struct picture_reader *reader, const struct spec_settings *settings,
	struct spec_error *error)
{
	struct spec_image *image = &reader->base.image;
	const char *name = reader->base.source.name;
	enum spec_status status = spec_given_apply(image, settings, name, error);

	if (status == SPEC_OK)
		status = spec_image_index(image, name, error);
	reader->from_input = spec_memory_new(
		image->channels, sizeof *reader->from_input, "channels", error);
	reader->from_channel = spec_memory_new(
		image->channels, sizeof *reader->from_channel, "channels", error);
	return status == SPEC_OK && (!reader->from_input || !reader->from_channel)
		       ? SPEC_ENOMEM
		       : status;
}

/* Up to four channels without wavelengths: Y, Y A, R G B or R G B A. */
static enum spec_status
set_colours(struct picture_reader *reader, const struct spec_settings *settings,
	struct spec_error *error)
{
	static const char *const names[] = {"Y", "YA", "RGB", "RGBA"};
	struct spec_image *image = &reader->base.image;
	const struct spec_pictures_content *content = &reader->input[0].content;
	const char *letters = names[content->channels - 1];
	enum spec_status status = SPEC_OK;
	char name[2] = "";

	for (int i = 0; i < content->channels && status == SPEC_OK; i++) {
		name[0] = letters[i];
		status = spec_image_add_channel(image, name, SPEC_SAMPLE_FLOAT, error);
	}
	reader->encoded = content->encoded;
	if (status == SPEC_OK)
		status = settle_channels(reader, settings, error);
	for (int i = 0; i < content->channels && status == SPEC_OK; i++) {
		name[0] = letters[i];
		reader->from_channel[spec_image_find_channel(image, name)] = (size_t)i;
	}
	return status;
}

/* Bands in the layout's names; band i of those given is channel i, or input i's first. */
static enum spec_status
set_bands(struct picture_reader *reader, const struct spec_grid *grid, enum spec_role role,
	const struct spec_settings *settings, struct spec_error *error)
{
	struct spec_image *image = &reader->base.image;
	enum spec_status status = spec_image_add_bands(
		image, role, 1, grid->wavelength_nm, grid->count, SPEC_SAMPLE_FLOAT, error);

	if (status == SPEC_OK)
		status = settle_channels(reader, settings, error);
	for (size_t i = 0; i < grid->count && status == SPEC_OK; i++) {
		int same;
		size_t found =
			spec_image_nearest_band(image, grid->wavelength_nm[i], &same);
		size_t channel = image->band_channel[found];

		reader->from_input[channel] = reader->inputs > 1 ? i : 0;
		reader->from_channel[channel] = reader->inputs > 1 ? 0 : i;
	}
	return status;
}

static enum spec_status
find_role(const struct picture_reader *reader, const struct spec_settings *settings,
	const char *quantity, enum spec_role *role, struct spec_error *error)
{
	*role = settings->read_as;
	if (*role != SPEC_ROLE_OTHER)
		return SPEC_OK;
	if (strstr(quantity, "radiance"))
		*role = SPEC_ROLE_EMISSIVE;
	else if (strstr(quantity, "reflectance") || strstr(quantity, "transmittance"))
		*role = SPEC_ROLE_REFLECTIVE;
	else
		return spec_error_set(error, SPEC_EUSAGE,
			"%s: does not say whether it holds radiance or reflectance "
			"(--read-as)",
			reader->base.source.name);
	return SPEC_OK;
}

/* Many channels in one file: what it describes itself as, or what the user says. */
static enum spec_status
set_cube(struct picture_reader *reader, const struct spec_settings *settings,
	struct spec_error *error)
{
	const struct spec_pictures_content *content = &reader->input[0].content;
	const char *name = reader->base.source.name;
	struct spec_grid grid = {0};
	enum spec_role role = SPEC_ROLE_OTHER;
	char *quantity;
	enum spec_status status = spec_description_read(content->description,
		&reader->base.image, settings->wavelengths ? NULL : &grid, error);

	if (status == SPEC_OK && grid.count == 0)
		status = spec_given_wavelengths(
			settings, (size_t)content->channels, name, &grid, error);
	if (status == SPEC_OK && grid.count != (size_t)content->channels)
		status = spec_error_set(error, SPEC_EFORMAT,
			"%s: describes %zu bands and has %d channels", name, grid.count,
			content->channels);
	if (status == SPEC_OK) {
		quantity = spec_image_quantity(&reader->base.image, error);
		status = quantity ? find_role(reader, settings, quantity, &role, error)
				  : SPEC_ENOMEM;
		free(quantity);
	}
	if (status == SPEC_OK)
		status = set_bands(reader, &grid, role, settings, error);
	spec_grid_free(&grid);
	return status;
}

/* The wavelength in a name such as "550nm.png" or "scene_w550.5nm.tif"; 0: none. */
static double
wavelength_of(const char *path)
{
	const char *slash = strrchr(path, '/'), *found = slash ? slash + 1 : path;

	while ((found = strstr(found, "nm"))) {
		const char *from = found;
		double value;

		while (from > path && (isdigit((unsigned char)from[-1]) ||
					      (from[-1] == '.' && from - path > 1 &&
						      isdigit((unsigned char)from[-2]))))
			from--;
		if (from < found &&
			spec_number_scan(from, '.', &value) == (size_t)(found - from))
			return value;
		found += 2;
	}
	return 0;
}

static int
compare_wavelengths(const void *a, const void *b)
{
	const struct input *one = a, *two = b;

	return (one->wavelength_nm > two->wavelength_nm) -
	       (one->wavelength_nm < two->wavelength_nm);
}

/* Of each picture the wavelength that its name says, if all do; sorted by it. */
static enum spec_status
read_names(struct picture_reader *reader, struct spec_grid *grid, struct spec_error *error)
{
	size_t known = 0;
	enum spec_status status;

	for (size_t i = 0; i < reader->inputs; i++) {
		struct input *input = &reader->input[i];

		input->wavelength_nm = wavelength_of(input->path);
		known += input->wavelength_nm > 0;
	}
	if (known < reader->inputs)
		return SPEC_OK;
	qsort(reader->input, reader->inputs, sizeof *reader->input, compare_wavelengths);
	status = spec_grid_new(reader->inputs, grid, error);
	for (size_t i = 0; i < reader->inputs && status == SPEC_OK; i++) {
		grid->wavelength_nm[i] = reader->input[i].wavelength_nm;
		if (i > 0 && grid->wavelength_nm[i] == grid->wavelength_nm[i - 1])
			status = spec_error_set(error, SPEC_EFORMAT,
				"%s and %s are both of %g nm", reader->input[i - 1].path,
				reader->input[i].path, grid->wavelength_nm[i]);
	}
	return status;
}

static enum spec_status
set_stack(struct picture_reader *reader, const struct spec_settings *settings,
	struct spec_error *error)
{
	const char *name = reader->base.source.name;
	struct spec_grid grid = {0};
	enum spec_role role = SPEC_ROLE_OTHER;
	char *quantity = NULL;
	enum spec_status status = spec_description_read(
		reader->input[0].content.description, &reader->base.image, NULL, error);

	if (status == SPEC_OK && !settings->wavelengths)
		status = read_names(reader, &grid, error);
	if (status == SPEC_OK && grid.count == 0)
		status = spec_given_wavelengths(
			settings, reader->inputs, name, &grid, error);
	if (status == SPEC_OK) {
		quantity = spec_image_quantity(&reader->base.image, error);
		status = quantity ? find_role(reader, settings, quantity, &role, error)
				  : SPEC_ENOMEM;
	}
	free(quantity);
	if (status == SPEC_OK)
		status = set_bands(reader, &grid, role, settings, error);
	spec_grid_free(&grid);
	return status;
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
				: add_input(reader, "", path, error);
	if (status == SPEC_OK)
		status = open_inputs(reader, error);
	if (status != SPEC_OK)
		return status;
	content = &reader->input[0].content;
	if (folder)
		status = set_stack(reader, settings, error);
	else if (settings->wavelengths || content->channels > 4 ||
		 spec_description_is_ours(content->description))
		status = set_cube(reader, settings, error);
	else
		status = set_colours(reader, settings, error);
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
		if (reader->input[i].handle)
			reader->plugin.table->close_input(reader->input[i].handle);
		free(reader->input[i].path);
	}
	free(reader->input);
	free(reader->from_input);
	free(reader->from_channel);
	spec_plugin_unload(&reader->plugin);
}

/* ---- lines ---- */

/* The lines of one input after another, each with its channels interleaved. */
static enum spec_status
fetch(struct spec_decoder *decoder, struct spec_error *error)
{
	struct picture_reader *reader = (struct picture_reader *)decoder->reader;
	enum spec_status status = spec_reading_reserve(&decoder->packed,
		reader->base.line_bytes * (size_t)decoder->lines, 0, error);
	float *to = (float *)(void *)decoder->packed.bytes;
	struct spec_error cause = {0};

	for (size_t i = 0; i < reader->inputs && status == SPEC_OK; i++) {
		const struct input *input = &reader->input[i];

		status = reader->plugin.table->read_input(input->handle, decoder->y0,
			decoder->y0 + decoder->lines, to, &cause);
		if (status != SPEC_OK)
			status = spec_error_set(
				error, status, "%s: %s", input->path, cause.message);
		to += (size_t)input->content.width * (size_t)input->content.channels *
		      (size_t)decoder->lines;
	}
	return status;
}

static enum spec_status
decode(struct spec_decoder *decoder, struct spec_error *error)
{
	const struct picture_reader *reader =
		(const struct picture_reader *)decoder->reader;
	const struct spec_image *image = &reader->base.image;
	size_t width = spec_window_width(&image->data), lines = (size_t)decoder->lines;
	enum spec_status status = spec_reading_planes(decoder, error);

	for (size_t c = 0; c < image->channels && status == SPEC_OK; c++) {
		const float *from = (const float *)(const void *)decoder->packed.bytes;
		size_t step = (size_t)reader->input[reader->from_input[c]].content.channels;
		int decodes = reader->encoded && image->channel[c].name[0] != 'A';

		for (size_t i = 0; i < reader->from_input[c]; i++)
			from += width * lines * (size_t)reader->input[i].content.channels;
		from += reader->from_channel[c];
		for (size_t line = 0; line < lines; line++) {
			float *row = decoder->row[line * image->channels + c];

			for (size_t x = 0; row && x < width; x++)
				row[x] = from[(line * width + x) * step];
			for (size_t x = 0; row && decodes && x < width; x++)
				row[x] = (float)spec_srgb_decode(row[x]);
		}
	}
	return status;
}

/* OpenImageIO has files alone, and nobody waits for those to be read. */
static enum spec_status
drain(struct spec_reader *reader, struct spec_error *error)
{
	(void)reader;
	(void)error;
	return SPEC_OK;
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
