#include "image/chart.h"

#include <stdio.h>
#include <string.h>

#include "base/number.h"
#include "image/save.h"

#define LARGEST 32768 /* pixels of a side */

void
spec_chart_options_init(struct spec_chart_options *options)
{
	*options = (struct spec_chart_options){.width = 480, .height = 270};
}

enum spec_status
spec_chart_options_take(struct spec_chart_options *options, const char *name,
	const char *value, int *known, struct spec_error *error)
{
	*known = 1;
	if (strcmp(name, "size") == 0) {
		options->has_size = 1;
		return spec_number_parse_size(value, LARGEST, "the size", &options->width,
			&options->height, error);
	}
	if (strcmp(name, "angle") == 0) {
		options->has_angle = 1;
		return spec_number_parse_angle(
			value, 0, 90, "the angle", &options->angle_deg, error);
	}
	if (strcmp(name, "chart") == 0)
		options->axes = value;
	else if (strcmp(name, "grid") == 0)
		options->grid = value;
	else
		*known = 0;
	return SPEC_OK;
}

enum spec_status
spec_chart_options_grid(const struct spec_chart_options *options, struct spec_grid *grid,
	struct spec_error *error)
{
	return spec_grid_parse(options->grid ? options->grid : "380:780:5", grid, error);
}

static enum spec_status
fail_at(const char *text, size_t at, struct spec_error *error)
{
	enum spec_status status = error ? error->status : SPEC_EUSAGE;

	spec_error_point(error, text, at);
	return status;
}

static enum spec_status
unknown_variable(const struct spec_chart *chart, const char *text, size_t at,
	struct spec_error *error)
{
	char names[128] = "";

	for (size_t i = 0; i < chart->variables; i++) {
		size_t length = strlen(names);

		snprintf(names + length, sizeof names - length, "%s%s", i ? ", " : "",
			chart->variable[i].name);
	}
	(void)spec_error_set(error, SPEC_EUSAGE,
		"an axis of a chart is NAME A..B, where NAME is one of %s", names);
	return fail_at(text, at, error);
}

/* The end of an axis: length bytes at text + at. */
static enum spec_status
parse_end(const struct spec_chart_variable *variable, const char *text, size_t at,
	size_t length, double *value, struct spec_error *error)
{
	char word[64];
	enum spec_status status;

	if (length >= sizeof word) {
		(void)spec_error_set(error, SPEC_EUSAGE, "the %s is longer than any number",
			variable->name);
		return fail_at(text, at, error);
	}
	memcpy(word, text + at, length);
	word[length] = '\0';
	if (variable->unit == SPEC_CHART_DEGREES)
		status = spec_number_parse_angle(word, variable->lowest, variable->highest,
			variable->name, value, error);
	else
		status = spec_number_parse_thickness(word, variable->name, value, error);
	if (status == SPEC_OK && (*value < variable->lowest || *value > variable->highest))
		status = spec_error_set(error, SPEC_ERANGE,
			"the %s is outside %g..%g nm: '%s'", variable->name,
			variable->lowest, variable->highest, word);
	return status == SPEC_OK ? status : fail_at(text, at, error);
}

/* One axis at *at; *at moves behind it. */
static enum spec_status
parse_axis(const struct spec_chart *chart, const char *text, size_t *at,
	struct spec_chart_axis *axis, struct spec_error *error)
{
	size_t name = *at + strspn(text + *at, " ");
	size_t name_length = strcspn(text + name, " ,");
	size_t first = name + name_length + strspn(text + name + name_length, " ");
	size_t length = strcspn(text + first, " ,"), i = 0;
	const char *dots = strstr(text + first, "..");
	const struct spec_chart_variable *variable;
	enum spec_status status;

	while (i < chart->variables &&
		(strlen(chart->variable[i].name) != name_length ||
			strncmp(chart->variable[i].name, text + name, name_length) != 0))
		i++;
	if (i == chart->variables)
		return unknown_variable(chart, text, name, error);
	variable = &chart->variable[i];
	if (!dots || dots >= text + first + length) {
		(void)spec_error_set(error, SPEC_EUSAGE,
			"the axis '%s' of a chart has no range A..B", variable->name);
		return fail_at(text, first, error);
	}
	axis->variable = i;
	status = parse_end(
		variable, text, first, (size_t)(dots - text) - first, &axis->first, error);
	if (status == SPEC_OK)
		status = parse_end(variable, text, (size_t)(dots - text) + 2,
			first + length - (size_t)(dots - text) - 2, &axis->last, error);
	*at = first + length + strspn(text + first + length, " ");
	return status;
}

enum spec_status
spec_chart_parse(struct spec_chart *chart, const char *text, struct spec_error *error)
{
	struct spec_chart_axis *axis = chart->axis;
	size_t at = 0, second;
	enum spec_status status = parse_axis(chart, text, &at, &axis[0], error);

	axis[1] = (struct spec_chart_axis){SPEC_CHART_VARIABLES, 0, 0};
	if (status != SPEC_OK || text[at] == '\0')
		return status;
	second = at + 1;
	if (text[at] == ',')
		status = parse_axis(chart, text, &second, &axis[1], error);
	if (status != SPEC_OK)
		return status;
	if (text[at] != ',' || text[second] != '\0') {
		(void)spec_error_set(error, SPEC_EUSAGE,
			"a chart has one axis, or two with a comma between");
		return fail_at(text, text[at] != ',' ? at : second, error);
	}
	if (axis[0].variable == axis[1].variable) {
		(void)spec_error_set(error, SPEC_EUSAGE, "both axes are the same");
		at++;
		return fail_at(text, at + strspn(text + at, " "), error);
	}
	return SPEC_OK;
}

/* The header of the chart's image, indexed. */
static enum spec_status
make_image(const struct spec_chart *chart, const struct spec_settings *settings,
	struct spec_image *image, struct spec_error *error)
{
	enum spec_status status;

	*image = (struct spec_image){.pixel_aspect_ratio = 1, .screen_window_width = 1};
	image->data = image->display =
		(struct spec_window){0, 0, chart->width, chart->height};
	status = spec_image_set_text(image, "spectralLayoutVersion", "1.0", error);
	if (status == SPEC_OK)
		status =
			spec_image_set_text(image, "spec:quantity", chart->quantity, error);
	if (status == SPEC_OK)
		status = spec_image_add_bands(image, SPEC_ROLE_REFLECTIVE, 1,
			chart->grid->wavelength_nm, chart->grid->count,
			settings->half ? SPEC_SAMPLE_HALF : SPEC_SAMPLE_FLOAT, error);
	if (status == SPEC_OK)
		status = spec_image_index(image, "chart", error);
	return status;
}

static double
at_pixel(const struct spec_chart_axis *axis, size_t pixel, int pixels)
{
	double part = pixels > 1 ? (double)pixel / (pixels - 1) : 0;

	return axis->first * (1 - part) + axis->last * part;
}

/* The variables of pixels x0..x0+count-1 of a line. */
static void
set_variables(const struct spec_chart *chart, int line, size_t x0, size_t count,
	double (*at)[SPEC_CHART_RUN])
{
	for (size_t v = 0; v < chart->variables; v++) {
		for (size_t i = 0; i < count; i++) {
			at[v][i] = chart->variable[v].value;
			if (chart->axis[0].variable == v)
				at[v][i] = at_pixel(&chart->axis[0], x0 + i, chart->width);
			else if (chart->axis[1].variable == v)
				at[v][i] = at_pixel(
					&chart->axis[1], (size_t)line, chart->height);
		}
	}
}

struct run {
	const struct spec_chart *chart;
	const struct spec_image *image;
};

static enum spec_status
kernel(void *state, struct spec_stream_worker *worker, int line, struct spec_error *error)
{
	const struct run *run = state;
	size_t width = spec_window_width(&run->image->data), bands = run->image->bands;
	double at[SPEC_CHART_VARIABLES][SPEC_CHART_RUN], *value = worker->scratch;
	const double *const variable[] = {at[0], at[1], at[2], at[3]};
	float *const *plane;
	enum spec_status status = spec_packer_begin(worker->packer, line, &plane, error);

	for (size_t x0 = 0; x0 < width && status == SPEC_OK; x0 += SPEC_CHART_RUN) {
		size_t count = width - x0 < SPEC_CHART_RUN ? width - x0 : SPEC_CHART_RUN;

		set_variables(run->chart, line, x0, count, at);
		run->chart->evaluate(run->chart->state, variable, count, value);
		for (size_t band = 0; band < bands; band++) {
			float *to = plane[run->image->band_channel[band]] + x0;

			for (size_t i = 0; i < count; i++)
				to[i] = (float)value[band * SPEC_CHART_RUN + i];
		}
	}
	return status == SPEC_OK ? spec_packer_end(worker->packer, line, error) : status;
}

enum spec_status
spec_chart_save(const struct spec_chart *chart, const struct spec_settings *settings,
	unsigned long long *overflows, struct spec_error *error)
{
	struct spec_image image;
	struct run run = {chart, &image};
	struct spec_stream stream = {
		.lines = chart->height, .lines_in = 1, .state = &run, .kernel = kernel};
	enum spec_status status = make_image(chart, settings, &image, error);

	if (status == SPEC_OK)
		status = spec_settings_record(settings, &image, error);
	stream.scratch_bytes = image.bands * SPEC_CHART_RUN * sizeof(double);
	if (status == SPEC_OK)
		status = spec_image_save(&image, &stream, settings, overflows, error);
	spec_image_clear(&image);
	return status;
}
