#include "image/atlas.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "base/memory.h"
#include "base/path.h"
#include "base/text.h"
#include "colour/observer.h"
#include "colour/space.h"
#include "image/atlasing.h"
#include "image/kind.h"
#include "image/patches.h"
#include "image/save.h"
#include "spectrum/lookup.h"
#include "spectrum/spd.h"

static const char *const channels[SPEC_ATLAS_TEXEL] = {"R", "G", "B", "A"};

/* An atlas that is being made. */
struct atlas {
	struct spec_image image;
	size_t samples, lines;
	float *value;                     /* [lines][SPEC_ATLAS_TEXEL * width] */
	size_t channel[SPEC_ATLAS_TEXEL]; /* of R, G, B, A in image */
};

/* A name without its folders and the suffix of texts; newly allocated. */
static char *
short_name(const char *name, struct spec_error *error)
{
	const char *begin = spec_path_name(name), *suffix = spec_path_suffix(name);
	size_t length =
		spec_kind_is_text_name(begin) ? (size_t)(suffix - begin) : strlen(begin);
	char *text = spec_memory_new(length + 1, 1, "names", error);

	if (text)
		memcpy(text, begin, length);
	return text;
}

/* A line of text; what would end a field becomes a blank. */
static void
print_line(FILE *file, const struct spec_curve *curve, const char *name, size_t column)
{
	const char *const field[SPEC_ATLAS_FIELDS] = {[SPEC_ATLAS_NAME] = name,
		[SPEC_ATLAS_COLUMN] = curve->column[column],
		[SPEC_ATLAS_QUANTITY] = curve->quantity,
		[SPEC_ATLAS_UNIT] = curve->unit,
		[SPEC_ATLAS_MEDIUM] = curve->medium,
		[SPEC_ATLAS_TITLE] = curve->title,
		[SPEC_ATLAS_SOURCE] = curve->source};

	for (size_t i = 0; i < SPEC_ATLAS_FIELDS; i++) {
		for (const char *at = field[i]; *at; at++)
			(void)putc(*at == '\t' || *at == '\n' ? ' ' : *at, file);
		(void)putc(i + 1 < SPEC_ATLAS_FIELDS ? '\t' : '\n', file);
	}
}

static enum spec_status
check_names(char *const *name, size_t curves, struct spec_error *error)
{
	for (size_t i = 0; i < curves; i++)
		for (size_t j = 0; j < i; j++)
			if (strcmp(name[i], name[j]) == 0)
				return spec_error_set(error, SPEC_EUSAGE,
					"two curves are called '%.200s', and an atlas needs to "
					"tell them apart",
					name[i]);
	return SPEC_OK;
}

/* The text of all lines. */
static enum spec_status
describe_lines(const struct spec_curve *curve, const char *const *name, size_t curves,
	struct spec_text *text, struct spec_error *error)
{
	char **shorter = spec_memory_new(curves, sizeof *shorter, "names", error);
	enum spec_status status = shorter ? spec_text_open(text, error) : SPEC_ENOMEM;

	for (size_t i = 0; i < curves && status == SPEC_OK; i++) {
		shorter[i] = short_name(name[i], error);
		status = shorter[i] ? SPEC_OK : SPEC_ENOMEM;
	}
	if (status == SPEC_OK)
		status = check_names(shorter, curves, error);
	for (size_t i = 0; i < curves && status == SPEC_OK; i++)
		for (size_t j = 0; j < curve[i].columns; j++)
			print_line(text->stream, &curve[i], shorter[i], j);
	if (status == SPEC_OK) {
		(void)putc('\0', text->stream);
		status = spec_text_close(text, error);
	}
	for (size_t i = 0; shorter && i < curves; i++)
		free(shorter[i]);
	free(shorter);
	return status;
}

static enum spec_status
describe_grid(
	struct spec_image *image, const struct spec_grid *grid, struct spec_error *error)
{
	const double *nm = grid->wavelength_nm;
	double step = grid->count > 1
			      ? (nm[grid->count - 1] - nm[0]) / (double)(grid->count - 1)
			      : 1;
	char text[3 * SPEC_SPD_NUMBER + 3];
	size_t length;

	for (size_t i = 0; i < grid->count; i++)
		if (fabs(nm[i] - nm[0] - step * (double)i) > 1e-6 * step)
			return spec_error_set(error, SPEC_EUSAGE,
				"the grid of an atlas has equal steps (--grid LO:HI:STEP)");
	length = spec_spd_format_number(nm[0], text);
	text[length++] = ':';
	length += spec_spd_format_number(nm[grid->count - 1], text + length);
	text[length++] = ':';
	(void)spec_spd_format_number(step, text + length);
	return spec_image_set_text(image, SPEC_ATLAS_STEPS, text, error);
}

static enum spec_status
describe(struct atlas *atlas, const struct spec_curve *curve, const char *const *name,
	size_t curves, const struct spec_grid *grid, struct spec_error *error)
{
	struct spec_image *image = &atlas->image;
	struct spec_text lines = {0};
	enum spec_status status;

	image->pixel_aspect_ratio = image->screen_window_width = 1;
	image->data = image->display = (struct spec_window){
		0, 0, (int)spec_atlas_texels(grid->count) + 1, (int)atlas->lines};
	status = describe_lines(curve, name, curves, &lines, error);
	if (status == SPEC_OK)
		status = describe_grid(image, grid, error);
	if (status == SPEC_OK)
		status = spec_image_set_text(image, SPEC_ATLAS_LINES, lines.bytes, error);
	spec_text_free(&lines);
	for (size_t i = 0; i < SPEC_ATLAS_TEXEL && status == SPEC_OK; i++)
		status = spec_image_add_channel(
			image, channels[i], SPEC_SAMPLE_FLOAT, error);
	if (status == SPEC_OK)
		status = spec_image_index(image, "atlas", error);
	for (size_t i = 0; i < SPEC_ATLAS_TEXEL && status == SPEC_OK; i++)
		atlas->channel[i] = spec_image_find_channel(image, channels[i]);
	return status;
}

/* What the colours are made with: weights of the samples for R, G, B. */
struct colours {
	double *reflected, *emitted; /* [3 * samples], or null: the grid shows no colour */
};

/* weight becomes null where the grid does not meet what is seen. */
static enum spec_status
weigh(const struct spec_curve *observer, const struct spec_curve *illuminant,
	const struct spec_grid *grid, double **weight, struct spec_error *error)
{
	struct spec_bands bands = {
		.count = grid->count, .wavelength_nm = grid->wavelength_nm};
	double matrix[9], outside;
	enum spec_status status;

	*weight = spec_memory_new(3 * grid->count, sizeof **weight, "weights", error);
	if (!*weight)
		return SPEC_ENOMEM;
	status = spec_observer_weights(
		observer, illuminant, &bands, *weight, &outside, error);
	if (status == SPEC_ERANGE) {
		free(*weight);
		*weight = NULL;
		return SPEC_OK;
	}
	if (status == SPEC_OK)
		status = spec_space_from_xyz(spec_space_find("srgb", NULL), matrix, error);
	for (size_t i = 0; i < grid->count && status == SPEC_OK; i++) {
		double xyz[3] = {(*weight)[i], (*weight)[grid->count + i],
			(*weight)[2 * grid->count + i]};

		spec_matrix_apply(matrix, xyz, xyz);
		for (size_t c = 0; c < 3; c++)
			(*weight)[c * grid->count + i] = xyz[c];
	}
	return status;
}

static enum spec_status
open_colours(
	struct colours *colours, const struct spec_grid *grid, struct spec_error *error)
{
	struct spec_curve observer = {0}, illuminant = {0};
	enum spec_status status =
		spec_lookup_curve(spec_observer_spectrum("1931"), &observer, error);

	if (status == SPEC_OK)
		status = spec_lookup_light("illuminants/D65", &illuminant, error);
	if (status == SPEC_OK)
		status = weigh(&observer, &illuminant, grid, &colours->reflected, error);
	if (status == SPEC_OK)
		status = weigh(&observer, NULL, grid, &colours->emitted, error);
	spec_curve_free(&observer);
	spec_curve_free(&illuminant);
	return status;
}

/* One line: the samples, and their colour where they have one. */
static enum spec_status
fill_line(struct atlas *atlas, float *line, const double *sample, const double *weight,
	const struct spec_curve *curve, struct spec_error *error)
{
	float *colour = line + SPEC_ATLAS_TEXEL * spec_atlas_texels(atlas->samples);

	for (size_t i = 0; i < atlas->samples; i++) {
		line[i] = (float)sample[i];
		if (!isfinite(line[i]))
			return spec_error_set(error, SPEC_ERANGE,
				"'%.200s' has a value beyond 32-bit floats, %g",
				spec_curve_name(curve), sample[i]);
	}
	for (size_t c = 0; c < 3 && weight; c++) {
		double sum = 0;

		for (size_t i = 0; i < atlas->samples; i++)
			sum += weight[c * atlas->samples + i] * sample[i];
		colour[c] = (float)sum;
	}
	colour[3] = weight ? 1 : 0;
	return SPEC_OK;
}

static enum spec_status
fill(struct atlas *atlas, const struct spec_curve *curve, size_t curves,
	const struct spec_grid *grid, enum spec_extrapolate extrapolate,
	struct spec_error *error)
{
	size_t width = SPEC_ATLAS_TEXEL * spec_window_width(&atlas->image.data), line = 0;
	double *sample = spec_memory_new(grid->count, sizeof *sample, "samples", error);
	struct colours colours = {0};
	enum spec_status status = SPEC_ENOMEM;

	atlas->value = spec_memory_new(
		atlas->lines * width, sizeof *atlas->value, "values", error);
	if (sample && atlas->value)
		status = open_colours(&colours, grid, error);
	for (size_t i = 0; i < curves && status == SPEC_OK; i++) {
		const double *weight = spec_curve_is_ratio(&curve[i])   ? colours.reflected
				       : spec_curve_is_light(&curve[i]) ? colours.emitted
									: NULL;

		for (size_t j = 0; j < curve[i].columns && status == SPEC_OK; j++, line++) {
			status = spec_curve_sample(&curve[i], j, extrapolate,
				grid->wavelength_nm, grid->count, sample, error);
			if (status == SPEC_OK)
				status = fill_line(atlas, atlas->value + line * width,
					sample, weight, &curve[i], error);
		}
	}
	free(colours.reflected);
	free(colours.emitted);
	free(sample);
	return status;
}

static enum spec_status
kernel(void *state, struct spec_stream_worker *worker, int line, struct spec_error *error)
{
	const struct atlas *atlas = state;
	size_t width = spec_window_width(&atlas->image.data);
	const float *value = atlas->value + (size_t)line * SPEC_ATLAS_TEXEL * width;
	float *const *plane;
	enum spec_status status = spec_packer_begin(worker->packer, line, &plane, error);

	for (size_t c = 0; c < SPEC_ATLAS_TEXEL && status == SPEC_OK; c++)
		for (size_t x = 0; x < width; x++)
			plane[atlas->channel[c]][x] = value[SPEC_ATLAS_TEXEL * x + c];
	return status == SPEC_OK ? spec_packer_end(worker->packer, line, error) : status;
}

enum spec_status
spec_atlas_write(const struct spec_curve *curve, const char *const *name, size_t curves,
	const struct spec_grid *grid, enum spec_extrapolate extrapolate,
	const struct spec_settings *settings, struct spec_error *error)
{
	struct atlas atlas = {.lines = spec_patches_count(curve, curves)};
	struct spec_stream stream = {.lines = (int)atlas.lines,
		.lines_in = 1,
		.state = &atlas,
		.kernel = kernel};
	struct spec_grid usual = {0};
	unsigned long long overflows;
	enum spec_status status = SPEC_OK;

	if (!grid)
		status = spec_grid_parse(SPEC_ATLAS_GRID, &usual, error);
	if (!grid)
		grid = &usual;
	atlas.samples = grid->count;
	if (status == SPEC_OK)
		status = describe(&atlas, curve, name, curves, grid, error);
	if (status == SPEC_OK)
		status = spec_settings_record(settings, &atlas.image, error);
	if (status == SPEC_OK)
		status = fill(&atlas, curve, curves, grid, extrapolate, error);
	/* Few curves reach as far as it, which nobody asked for. */
	if (status == SPEC_ERANGE && grid == &usual)
		spec_error_prefix(error, "an atlas has the grid " SPEC_ATLAS_GRID
					 " where --grid gives no other");
	if (status == SPEC_OK)
		status =
			spec_image_save(&atlas.image, &stream, settings, &overflows, error);
	free(atlas.value);
	spec_image_clear(&atlas.image);
	spec_grid_free(&usual);
	return status;
}
