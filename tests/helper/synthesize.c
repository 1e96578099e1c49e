/*
 * Makes spectral EXR files whose every sample is known, for tests and benches.
 *
 *   synthesize [OPTION]... [-o FILE]        (try --help)
 *
 * A sample is value(x, y, band), rounded to float, where
 *   x, y  are counted from the data window's corner, so 0,0 is its first pixel;
 *   band  counts the wavelengths of the grid from 0 or, in place of a grid, the
 *         --channel options as they were given; --extra channels count on from there.
 *
 *   ramp        ((x + 1) * 0.001 + y * 0.01) + band * 0.1, in double; the default
 *   negative    minus the ramp
 *   constant:V  V
 *   noise       (splitmix64(2^32 * y + 2^16 * x + band) >> 40) * 2^-24, in [0, 1):
 *               24 random bits, which nothing compresses
 *   grain       (0.25 + (x + y) * 2^-13 + band * 2^-9) * (1 + noise / 8): smooth but for
 *               noise in the lower bits, as in a rendered picture, and compresses as one
 *   nan:X,Y,B   one sample of the pattern is NaN; inf:X,Y,B: plus infinity. May be
 *               given several times, before or after the pattern.
 *
 * splitmix64(n) is the first output of Vigna's generator for the state n:
 *   z = n + 0x9e3779b97f4a7c15; z = (z ^ z >> 30) * 0xbf58476d1ce4e5b9;
 *   z = (z ^ z >> 27) * 0x94d049bb133111eb; z ^ z >> 31.
 *
 * --kind stokes multiplies the value by 1, 1/2, -1/4, 1/8 for S0..S3: a possible
 * light, since S0 exceeds the length of the rest. Spots lie in S0 alone. A --uint
 * channel holds x + 65536 * y. Windows are half-open; without --display the display
 * window is the data window.
 */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "base/memory.h"
#include "base/number.h"
#include "cli/options.h"
#include "image/names.h"
#include "spectrum/grid.h"

#include "making.h"

#define MOST_SPOTS 16
#define MOST_ATTRIBUTES 64
#define MOST_BANDS 65536 /* as many as the noise tells apart */

enum shape {
	SHAPE_RAMP,
	SHAPE_NEGATIVE,
	SHAPE_CONSTANT,
	SHAPE_NOISE,
	SHAPE_GRAIN,
	SHAPE_NUMBER
};

struct spot {
	int x, y, band;
	float value;
};

/* A channel and how it is filled. */
struct plane {
	const char *name;
	enum spec_sample sample;
	int band;
	float factor;
	int spotted; /* spots lie in it */
	enum shape shape;
};

struct synthesis {
	struct spec_settings settings;
	struct spec_window data, display;
	int has_display, bins;
	const char *grid, *kind, *quantity;
	const char **raw, **extra, **number; /* channel names */
	size_t raws, extras, numbers;
	size_t raw_room, extra_room, number_room;
	const char *attribute[MOST_ATTRIBUTES];
	char attribute_kind[MOST_ATTRIBUTES]; /* 'a'ttribute, 'n'umber, 'w'ithout */
	size_t attributes;
	enum shape shape;
	double constant;
	struct spot spot[MOST_SPOTS];
	size_t spots;

	struct spec_grid wavelengths;
	struct plane *plane; /* in the order of the image's channels */
	size_t planes;
	struct spec_image image;
};

static const struct cli_option options[] = {
	{0, "size", "WxH", "of the data window (default: 16x8)"},
	{0, "data", "X0,Y0", "corner of the data window"},
	{0, "display", "X0,Y0,X1,Y1", "display window"},
	{0, "grid", "LO:HI:STEP", "wavelengths in nm (default: 400:700:20)"},
	{0, "kind", "S0|T|stokes", "emissive, reflective, or S0 to S3"},
	{0, "pattern", "NAME",
		"constant:V ramp noise grain negative\nnan:X,Y,BAND inf:X,Y,BAND"},
	{0, "channel", "NAME", "a channel of this name, in place of the grid's; repeats"},
	{0, "extra", "NAME", "another channel, FLOAT; repeats"},
	{0, "uint", "NAME", "another channel, UINT; repeats"},
	{0, "uint-id", NULL, "as --uint id"},
	{0, "attribute", "NAME=TEXT", "a string attribute; repeats"},
	{0, "number", "NAME=VALUE", "a float attribute; repeats"},
	{0, "without", "NAME", "no such attribute; repeats"},
	{0, "bins", NULL, "spec:bins half-way between the wavelengths"},
	{0, "quantity", "TEXT", "spec:quantity"},
	{0},
};

static const struct cli_program program = {
	.name = "synthesize",
	.arguments = "[OPTION]... [-o FILE]",
	.summary = "Makes spectral EXR files with known samples.",
	.options = options,
	.writes_images = 1,
};

/* "1,2,3" or "64x48": exactly count numbers. */
static void
take_numbers(const struct cli *cli, char separator, int count, int *number)
{
	const char *text = cli->value;

	for (int i = 0; i < count; i++) {
		char *end;
		long value = strtol(text, &end, 10);

		if (end == text || *end != (i + 1 < count ? separator : '\0') ||
			value < -(1L << 30) || value > 1L << 30)
			cli_usage(cli, "'%s' is not %d numbers with '%c' between them",
				cli->value, count, separator);
		number[i] = (int)value;
		text = end + 1;
	}
}

static void
take_spot(struct synthesis *synthesis, struct cli *cli, const char *text, float value)
{
	struct cli sub = *cli;
	int number[3];

	sub.value = text;
	take_numbers(&sub, ',', 3, number);
	if (synthesis->spots == MOST_SPOTS)
		cli_usage(cli, "more than %d spots", MOST_SPOTS);
	synthesis->spot[synthesis->spots++] =
		(struct spot){number[0], number[1], number[2], value};
}

static void
take_pattern(struct synthesis *synthesis, struct cli *cli)
{
	const char *text = cli->value;
	struct spec_error error;

	if (strncmp(text, "nan:", 4) == 0) {
		take_spot(synthesis, cli, text + 4, NAN);
	} else if (strncmp(text, "inf:", 4) == 0) {
		take_spot(synthesis, cli, text + 4, INFINITY);
	} else if (strcmp(text, "ramp") == 0) {
		synthesis->shape = SHAPE_RAMP;
	} else if (strcmp(text, "negative") == 0) {
		synthesis->shape = SHAPE_NEGATIVE;
	} else if (strcmp(text, "noise") == 0) {
		synthesis->shape = SHAPE_NOISE;
	} else if (strcmp(text, "grain") == 0) {
		synthesis->shape = SHAPE_GRAIN;
	} else if (strncmp(text, "constant:", 9) == 0) {
		synthesis->shape = SHAPE_CONSTANT;
		cli_check(cli,
			spec_number_parse(text + 9, -3e38, 3e38, "the constant",
				&synthesis->constant, &error),
			&error);
	} else {
		cli_usage(cli, "unknown pattern '%s'", text);
	}
}

static void
append(const struct cli *cli, const char ***list, size_t *count, size_t *room,
	const char *text)
{
	struct spec_error error;
	void *grown = *list;

	cli_check(cli,
		spec_memory_grow(&grown, room, *count + 1, sizeof **list, "names", &error),
		&error);
	*list = grown;
	(*list)[(*count)++] = text;
}

/* Options that add something to a list; returns 0 where the option is another. */
static int
take_list(struct synthesis *synthesis, struct cli *cli)
{
	if (strcmp(cli->name, "channel") == 0) {
		append(cli, &synthesis->raw, &synthesis->raws, &synthesis->raw_room,
			cli->value);
	} else if (strcmp(cli->name, "extra") == 0) {
		append(cli, &synthesis->extra, &synthesis->extras, &synthesis->extra_room,
			cli->value);
	} else if (strcmp(cli->name, "uint") == 0) {
		append(cli, &synthesis->number, &synthesis->numbers,
			&synthesis->number_room, cli->value);
	} else if (strcmp(cli->name, "uint-id") == 0) {
		append(cli, &synthesis->number, &synthesis->numbers,
			&synthesis->number_room, "id");
	} else if (strcmp(cli->name, "attribute") == 0 ||
		   strcmp(cli->name, "number") == 0 || strcmp(cli->name, "without") == 0) {
		if (synthesis->attributes == MOST_ATTRIBUTES ||
			(cli->name[0] != 'w' && !strchr(cli->value, '=')))
			cli_usage(
				cli, "'%s' is not NAME=TEXT, or one too many", cli->value);
		synthesis->attribute_kind[synthesis->attributes] = cli->name[0];
		synthesis->attribute[synthesis->attributes++] = cli->value;
	} else {
		return 0;
	}
	return 1;
}

static void
take_option(struct synthesis *synthesis, struct cli *cli)
{
	struct spec_window *data = &synthesis->data, *display = &synthesis->display;
	int number[4];

	if (strcmp(cli->name, "size") == 0) {
		take_numbers(cli, 'x', 2, number);
		if (number[0] < 1 || number[1] < 1 || number[0] > 65536)
			cli_usage(cli, "the size %s is not positive or wider than 65536",
				cli->value);
		data->x1 = number[0]; /* the corner is added later */
		data->y1 = number[1];
	} else if (strcmp(cli->name, "data") == 0) {
		take_numbers(cli, ',', 2, number);
		data->x0 = number[0];
		data->y0 = number[1];
	} else if (strcmp(cli->name, "display") == 0) {
		take_numbers(cli, ',', 4, number);
		*display = (struct spec_window){number[0], number[1], number[2], number[3]};
		synthesis->has_display = 1;
	} else if (strcmp(cli->name, "grid") == 0) {
		synthesis->grid = cli->value;
	} else if (strcmp(cli->name, "kind") == 0) {
		synthesis->kind = cli->value;
	} else if (strcmp(cli->name, "pattern") == 0) {
		take_pattern(synthesis, cli);
	} else if (strcmp(cli->name, "bins") == 0) {
		synthesis->bins = 1;
	} else if (strcmp(cli->name, "quantity") == 0) {
		synthesis->quantity = cli->value;
	} else if (!take_list(synthesis, cli)) {
		cli_usage(cli, "option '--%s' does nothing here", cli->name);
	}
}

static void
take_options(struct synthesis *synthesis, struct cli *cli)
{
	struct spec_error error;
	int known;

	spec_settings_init(&synthesis->settings);
	synthesis->data = (struct spec_window){0, 0, 16, 8};
	synthesis->grid = "400:700:20";
	synthesis->kind = "S0";
	while (cli_next(cli)) {
		if (!cli->name)
			cli_usage(cli, "'%s' is one too many", cli->value);
		cli_check(cli,
			spec_settings_take(&synthesis->settings, cli->name, cli->value,
				&known, &error),
			&error);
		if (!known)
			take_option(synthesis, cli);
	}
	synthesis->data.x1 += synthesis->data.x0;
	synthesis->data.y1 += synthesis->data.y0;
	if (!synthesis->has_display)
		synthesis->display = synthesis->data;
}

static enum spec_status
add_plane(struct synthesis *synthesis, const char *name, struct plane plane,
	struct spec_error *error)
{
	plane.name = spec_memory_text(name, strlen(name), error);
	if (!plane.name)
		return SPEC_ENOMEM;
	synthesis->plane[synthesis->planes++] = plane;
	return SPEC_OK;
}

/* The channels of the grid. */
static enum spec_status
plan_bands(struct synthesis *synthesis, enum spec_sample sample, struct spec_error *error)
{
	static const float factor[4] = {1, 0.5F, -0.25F, 0.125F};
	enum spec_role role = strcmp(synthesis->kind, "T") == 0 ? SPEC_ROLE_REFLECTIVE
								: SPEC_ROLE_EMISSIVE;
	int components = strcmp(synthesis->kind, "stokes") == 0 ? 4 : 1;
	enum spec_status status = SPEC_OK;
	char name[64];

	for (int component = 0; component < components; component++) {
		for (size_t i = 0; i < synthesis->wavelengths.count && status == SPEC_OK;
			i++) {
			spec_names_write(name, sizeof name, role, component,
				synthesis->wavelengths.wavelength_nm[i], 0);
			status = add_plane(synthesis, name,
				(struct plane){.sample = sample,
					.band = (int)i,
					.factor = factor[component],
					.spotted = component == 0,
					.shape = synthesis->shape},
				error);
		}
	}
	return status;
}

static int
compare_planes(const void *a, const void *b)
{
	const struct plane *one = a, *two = b;

	return strcmp(one->name, two->name);
}

static enum spec_status
plan_planes(struct synthesis *synthesis, struct spec_error *error)
{
	enum spec_sample sample =
		synthesis->settings.half ? SPEC_SAMPLE_HALF : SPEC_SAMPLE_FLOAT;
	struct plane plane = {
		.sample = sample, .factor = 1, .spotted = 1, .shape = synthesis->shape};
	size_t most = 4 * synthesis->wavelengths.count + synthesis->raws +
		      synthesis->extras + synthesis->numbers;
	enum spec_status status = SPEC_OK;

	synthesis->plane = spec_memory_new(most, sizeof plane, "channels", error);
	if (!synthesis->plane)
		return SPEC_ENOMEM;
	if (synthesis->raws == 0)
		status = plan_bands(synthesis, sample, error);
	plane.band = synthesis->raws == 0 ? (int)synthesis->wavelengths.count : 0;
	for (size_t i = 0; i < synthesis->raws && status == SPEC_OK; i++, plane.band++)
		status = add_plane(synthesis, synthesis->raw[i], plane, error);
	plane.sample = SPEC_SAMPLE_FLOAT;
	for (size_t i = 0; i < synthesis->extras && status == SPEC_OK; i++, plane.band++)
		status = add_plane(synthesis, synthesis->extra[i], plane, error);
	plane.sample = SPEC_SAMPLE_UINT;
	plane.shape = SHAPE_NUMBER;
	for (size_t i = 0; i < synthesis->numbers && status == SPEC_OK; i++)
		status = add_plane(synthesis, synthesis->number[i], plane, error);
	if (status == SPEC_OK && plane.band > MOST_BANDS)
		return spec_error_set(error, SPEC_ERANGE, "more than %d bands", MOST_BANDS);
	qsort(synthesis->plane, synthesis->planes, sizeof plane, compare_planes);
	return status;
}

static enum spec_status
set_attribute(struct spec_image *image, const char *name, const char *text, int number,
	struct spec_error *error)
{
	enum spec_status status;
	double value;
	float rounded;

	if (!number)
		return spec_image_set_text(image, name, text, error);
	status = spec_number_parse(text, -3e38, 3e38, "the attribute", &value, error);
	rounded = (float)value;
	return status == SPEC_OK ? spec_image_set_attribute(image, name, "float", &rounded,
					   sizeof rounded, error)
				 : status;
}

static enum spec_status
set_attributes(struct synthesis *synthesis, struct spec_error *error)
{
	struct spec_image *image = &synthesis->image;
	enum spec_status status =
		spec_image_set_text(image, "spectralLayoutVersion", "1.0", error);

	if (status == SPEC_OK && strcmp(synthesis->kind, "T") != 0)
		status = spec_image_set_text(image, "emissiveUnits", "W.m^-2.sr^-1", error);
	if (status == SPEC_OK && synthesis->quantity)
		status = spec_image_set_text(
			image, "spec:quantity", synthesis->quantity, error);
	if (status == SPEC_OK && synthesis->bins)
		status = making_set_bins(image, &synthesis->wavelengths, error);
	for (size_t i = 0; i < synthesis->attributes && status == SPEC_OK; i++) {
		const char *text = synthesis->attribute[i];
		size_t length = strcspn(text, "=");
		char *name = spec_memory_text(text, length, error);

		if (!name)
			return SPEC_ENOMEM;
		if (synthesis->attribute_kind[i] == 'w')
			spec_image_remove_attribute(image, name);
		else
			status = set_attribute(image, name, text + length + 1,
				synthesis->attribute_kind[i] == 'n', error);
		free(name);
	}
	return status;
}

/*
 * The image is not indexed by the library, which refuses the files that some tests
 * are about: names without a wavelength, two grids in one file.
 */
static enum spec_status
plan_image(struct synthesis *synthesis, struct spec_error *error)
{
	struct spec_image *image = &synthesis->image;

	*image = (struct spec_image){.data = synthesis->data,
		.display = synthesis->display,
		.pixel_aspect_ratio = 1,
		.screen_window_width = 1};
	for (size_t i = 0; i < synthesis->planes; i++) {
		enum spec_status status = spec_image_add_channel(
			image, synthesis->plane[i].name, synthesis->plane[i].sample, error);

		if (image->channels == i) /* EFORMAT, a name without sense, has added it */
			return status;
	}
	return set_attributes(synthesis, error);
}

static void
fill_noise(float *row, size_t width, int y, int band, float factor)
{
	const float scale = factor / (1 << 24);
	uint64_t base = ((uint64_t)y << 32) + (uint64_t)band;

	for (size_t x = 0; x < width; x++)
		row[x] = scale * (float)(int32_t)(making_splitmix(base + (x << 16)) >> 40);
}

static void
fill_grain(float *row, size_t width, int y, int band, float factor)
{
	fill_noise(row, width, y, band, 1);
	for (size_t x = 0; x < width; x++) {
		double smooth = 0.25 + (double)(x + (size_t)y) / 8192 + band / 512.0;

		row[x] = factor * (float)(smooth * (1 + (double)row[x] / 8));
	}
}

/* One channel of line y, which is counted from the data window's first. */
static void
fill_row(const struct synthesis *synthesis, const struct plane *plane, int y, float *row)
{
	size_t width = spec_window_width(&synthesis->data);
	uint32_t *number = (uint32_t *)(void *)row;
	float factor = plane->shape == SHAPE_NEGATIVE ? -plane->factor : plane->factor;

	switch (plane->shape) {
	case SHAPE_RAMP:
	case SHAPE_NEGATIVE:
		for (size_t x = 0; x < width; x++)
			row[x] = factor * (float)(((double)(x + 1) * 0.001 + y * 0.01) +
						  plane->band * 0.1);
		break;
	case SHAPE_CONSTANT:
		for (size_t x = 0; x < width; x++)
			row[x] = factor * (float)synthesis->constant;
		break;
	case SHAPE_NOISE:
		fill_noise(row, width, y, plane->band, factor);
		break;
	case SHAPE_GRAIN:
		fill_grain(row, width, y, plane->band, factor);
		break;
	case SHAPE_NUMBER:
		for (size_t x = 0; x < width; x++)
			number[x] = (uint32_t)x + 65536U * (uint32_t)y;
		return;
	}
	for (size_t i = 0; i < synthesis->spots && plane->spotted; i++) {
		const struct spot *spot = &synthesis->spot[i];

		if (spot->y == y && spot->band == plane->band && spot->x >= 0 &&
			(size_t)spot->x < width)
			row[spot->x] = spot->value;
	}
}

/* All channels of line y. */
static void
fill_line(const void *state, int y, void *room, float *const *row)
{
	const struct synthesis *synthesis = state;

	(void)room;
	for (size_t i = 0; i < synthesis->planes; i++)
		fill_row(synthesis, &synthesis->plane[i], y, row[i]);
}

int
main(int argc, char **argv)
{
	static struct synthesis synthesis;
	struct making making = {.image = &synthesis.image,
		.settings = &synthesis.settings,
		.fill = fill_line,
		.state = &synthesis};
	struct spec_error error;
	struct cli cli;

	cli_start(&cli, &program, argc, argv);
	take_options(&synthesis, &cli);
	if (strcmp(synthesis.kind, "S0") != 0 && strcmp(synthesis.kind, "T") != 0 &&
		strcmp(synthesis.kind, "stokes") != 0)
		cli_usage(&cli, "unknown kind '%s' (S0 T stokes)", synthesis.kind);
	cli_check(&cli, spec_grid_parse(synthesis.grid, &synthesis.wavelengths, &error),
		&error);
	cli_check(&cli, plan_planes(&synthesis, &error), &error);
	cli_check(&cli, plan_image(&synthesis, &error), &error);
	cli_check(&cli, making_write(&making, &error), &error);
	spec_image_clear(&synthesis.image);
	for (size_t i = 0; i < synthesis.planes; i++)
		free((char *)synthesis.plane[i].name);
	free(synthesis.plane);
	free(synthesis.raw);
	free(synthesis.extra);
	free(synthesis.number);
	spec_grid_free(&synthesis.wavelengths);
	return 0; /* stdout, where it was the output, is closed and checked already */
}
