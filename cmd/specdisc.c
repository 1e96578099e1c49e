/* specdisc - diffraction at discs and gratings, on light layers or as a chart; see specdisc(1). */
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "all/tool.h"
#include "base/memory.h"
#include "base/number.h"
#include "base/output.h"
#include "cli/groups.h"
#include "image/diffract.h"
#include "image/discchart.h"
#include "optics/ordertable.h"

#define FARTHEST_M 1e9
#define WIDEST_NM 1e7 /* of a track or a pit: 1 cm, 50000 orders */

static const struct cli_option options[] = {
	{'p', "preset", "cd|dvd|bluray|vinyl", "the disc (default: cd)"},
	{0, "track", "LENGTH", "from track to track, in place of the preset's"},
	{0, "pit", "LENGTH", "mean distance from pit to pit along a track"},
	{'m', "mask", "ID",
		"this disc is for surfaces of this id; repeat --preset for others"},
	{0, "model", "composite|orders",
		"Vangorp & Yskout's, made to look like photographs, "
		"or the grating's orders by scalar diffraction (default: composite)"},
	{0, "spread", "ANGLE",
		"of an order about its direction, a standard deviation "
		"(default: 0.5deg; model orders)"},
	{0, "centre", "X,Y,Z", "tracks are circles around it, in place of Tan [m]"},
	{0, "axis", "X,Y,Z", "and turn about this direction (default: 0,0,1)"},
	{'k', "keep", NULL, "leave the layers in the image"},
	{0, "orders", NULL, "print the directions of the orders, and read no image"},
	{0, "chart", "AXES",
		"make a chart, and read no image: one or two of 'eye A..B, "
		"lamp A..B, azimuth A..B', to the right and downwards"},
	{0, "size", "WxH", "of the chart in pixels (default: 480x270)"},
	{'a', "angle", "ANGLE", "of the lamp, for --orders and --chart (default: 0deg)"},
	{0, "eye", "ANGLE", "of the eye, for --chart (default: 0deg)"},
	{0, "azimuth", "ANGLE",
		"of lamp and eye, 0 across the tracks, 90 along them (default: 0deg)"},
	{'g', "grid", "LO:HI:STEP",
		"wavelengths of --orders and --chart [nm] (default: 380:780:5)"},
	{0},
};

static const struct cli_program program = {
	.name = "specdisc",
	.arguments = "[OPTION]... [FILE]",
	.summary =
		"Put the colours of a compact disc, or another grating, on the surface that an "
		"image's lamp layers light, or chart them.",
	.options = options,
	.writes_images = 1,
};

/* Options of a disc. */
enum { PRESET, TRACK, PIT, MASK };

struct job {
	const char *input;
	struct cli_groups discs;
	struct spec_diffract_setup setup;
	struct spec_chart_options chart;
	double eye_deg, azimuth_deg, spread_deg;
	int orders, has_eye, has_azimuth, has_axis, has_spread, has_model;
	unsigned long long overflows;
	struct spec_settings settings;
};

static enum spec_status
take_vector(const char *text, const char *what, double vector[3], struct spec_error *error)
{
	for (size_t i = 0; i < 3; i++) {
		size_t length = strcspn(text, ",");
		char part[64];
		enum spec_status status;

		if ((text[length] == ',') != (i < 2) || length >= sizeof part)
			return spec_error_set(error, SPEC_EUSAGE, "%s is not X,Y,Z", what);
		memcpy(part, text, length);
		part[length] = '\0';
		status = spec_number_parse(
			part, -FARTHEST_M, FARTHEST_M, what, &vector[i], error);
		if (status != SPEC_OK)
			return status;
		text += length + (i < 2);
	}
	return SPEC_OK;
}

static enum spec_status
take_model(struct job *job, const char *value, struct spec_error *error)
{
	int orders = strcmp(value, "orders") == 0;

	if (!orders && strcmp(value, "composite") != 0)
		return spec_error_set(
			error, SPEC_EUSAGE, "'%s' is not composite or orders", value);
	job->has_model = 1;
	job->setup.model = orders ? spec_disc_orders : spec_disc_composite;
	return SPEC_OK;
}

static enum spec_status
take_chart_option(struct job *job, const char *name, const char *value, int *known,
	struct spec_error *error)
{
	*known = 1;
	if (strcmp(name, "eye") == 0) {
		job->has_eye = 1;
		return spec_number_parse_angle(
			value, -90, 90, "the eye's angle", &job->eye_deg, error);
	}
	if (strcmp(name, "azimuth") == 0) {
		job->has_azimuth = 1;
		return spec_number_parse_angle(
			value, -180, 180, "the azimuth", &job->azimuth_deg, error);
	}
	if (strcmp(name, "orders") == 0) {
		job->orders = 1;
		return SPEC_OK;
	}
	return spec_chart_options_take(&job->chart, name, value, known, error);
}

static enum spec_status
take_surface_option(struct job *job, const char *name, const char *value, int *known,
	struct spec_error *error)
{
	*known = 1;
	if (strcmp(name, "preset") == 0)
		return cli_groups_take(&job->discs, PRESET, value, error);
	if (strcmp(name, "track") == 0)
		return cli_groups_take(&job->discs, TRACK, value, error);
	if (strcmp(name, "pit") == 0)
		return cli_groups_take(&job->discs, PIT, value, error);
	if (strcmp(name, "mask") == 0)
		return cli_groups_take(&job->discs, MASK, value, error);
	if (strcmp(name, "model") == 0)
		return take_model(job, value, error);
	if (strcmp(name, "centre") == 0) {
		job->setup.has_centre = 1;
		return take_vector(value, "the centre", job->setup.centre, error);
	}
	if (strcmp(name, "axis") == 0) {
		job->has_axis = 1;
		return take_vector(value, "the axis", job->setup.axis, error);
	}
	if (strcmp(name, "spread") == 0) {
		job->has_spread = 1;
		return spec_number_parse_angle(
			value, 1e-4, 45, "the spread", &job->spread_deg, error);
	}
	*known = 0;
	return SPEC_OK;
}

static enum spec_status
take_option(void *state, const char *name, const char *value, struct spec_error *error)
{
	struct job *job = state;
	int known;
	enum spec_status status = take_chart_option(job, name, value, &known, error);

	if (!known)
		status = take_surface_option(job, name, value, &known, error);
	if (known)
		return status;
	if (strcmp(name, "keep") != 0)
		return spec_settings_take(&job->settings, name, value, &known, error);
	job->setup.keep = 1;
	return SPEC_OK;
}

/* What goes together, and what does not. */
static void
check_options(const struct cli *cli, const struct job *job)
{
	const struct spec_diffract_setup *setup = &job->setup;
	const double *axis = setup->axis;
	int alone = job->orders || job->chart.axes;

	if (job->orders && job->chart.axes)
		cli_usage(cli, "--orders and --chart exclude each other");
	if (alone && job->input)
		cli_usage(cli, "--orders and --chart read no image: '%s'", job->input);
	if (alone && (job->discs.count > 1 || job->discs.group[0].option[MASK] ||
			     setup->keep || setup->has_centre))
		cli_usage(cli, "--orders and --chart take one disc, and neither --mask, "
			       "--keep nor --centre");
	if (!alone && (job->chart.has_angle || job->has_azimuth || job->chart.grid))
		cli_usage(
			cli, "--angle, --azimuth and --grid are for --orders and --chart");
	if (!job->chart.axes && (job->chart.has_size || job->has_eye))
		cli_usage(cli, "--size and --eye are for --chart");
	if (job->orders &&
		(job->has_model || job->has_spread || job->discs.group[0].option[PIT]))
		cli_usage(cli, "--orders knows of neither --model, --spread nor --pit");
	if (job->has_axis && !setup->has_centre)
		cli_usage(cli, "--axis needs a --centre");
	if (axis[0] == 0 && axis[1] == 0 && axis[2] == 0)
		cli_usage(cli, "the axis is 0,0,0");
	if (job->has_spread && setup->model != spec_disc_orders)
		cli_usage(cli, "--spread is for --model orders");
}

static void
parse(struct cli *cli, struct job *job, struct spec_error *error)
{
	spec_chart_options_init(&job->chart);
	spec_settings_init(&job->settings);
	job->input = cli_take_all(cli, "image", take_option, job);
	if (job->discs.count == 0) /* a disc as it comes */
		cli_check(cli, cli_groups_take(&job->discs, PRESET, "cd", error), error);
	check_options(cli, job);
}

static enum spec_status
take_distance(
	const char *text, const char *what, double *distance_nm, struct spec_error *error)
{
	enum spec_status status = spec_number_parse_length(text, what, distance_nm, error);

	if (status == SPEC_OK && *distance_nm > WIDEST_NM)
		status = spec_error_set(error, SPEC_ERANGE, "%s is more than %g mm: '%s'",
			what, WIDEST_NM * 1e-6, text);
	return status;
}

static enum spec_status
make_disc(const struct job *job, const struct cli_group *group, struct spec_disc *disc,
	struct spec_error *error)
{
	const struct spec_disc *preset =
		spec_disc_find(group->option[PRESET] ? group->option[PRESET] : "cd", error);
	enum spec_status status = preset ? SPEC_OK : SPEC_EUSAGE;

	if (status != SPEC_OK)
		return status;
	*disc = *preset;
	if (group->option[TRACK])
		status = take_distance(
			group->option[TRACK], "the track", &disc->track_nm, error);
	if (status == SPEC_OK && group->option[PIT])
		status = take_distance(group->option[PIT], "the pit", &disc->pit_nm, error);
	if (disc->pit_width_nm > disc->track_nm)
		disc->pit_width_nm *= disc->track_nm / preset->track_nm;
	disc->lobe_width = job->has_spread ? job->spread_deg * 3.14159265358979323846 / 180
					   : disc->lobe_width;
	return status;
}

static enum spec_status
print_orders(const struct job *job, const struct spec_disc *disc,
	const struct spec_grid *grid, struct spec_error *error)
{
	struct spec_text text = {0};
	enum spec_status status = spec_orders_text(disc, job->chart.angle_deg,
		job->azimuth_deg, grid->wavelength_nm, grid->count, &text, error);

	if (status == SPEC_OK)
		status = spec_output_save(
			job->settings.output, text.bytes, text.size, error);
	spec_text_free(&text);
	return status;
}

/* What an axis gives is not given by an option, too. */
static enum spec_status
check_axes(const struct job *job, const struct spec_chart *chart, struct spec_error *error)
{
	const int given[] = {job->has_eye, job->chart.has_angle, job->has_azimuth};
	static const char *const option[] = {"--eye", "--angle", "--azimuth"};

	for (size_t i = 0; i < 2; i++) {
		size_t variable = chart->axis[i].variable;

		if (variable < SPEC_DISC_VARIABLES && given[variable])
			return spec_error_set(error, SPEC_EUSAGE,
				"the chart goes over '%s', and %s gives one",
				chart->variable[variable].name, option[variable]);
	}
	return SPEC_OK;
}

static enum spec_status
draw_chart(struct job *job, const struct spec_disc *disc, const struct spec_grid *grid,
	struct spec_error *error)
{
	struct spec_disc_chart state = {
		disc, job->setup.model, {grid->count, grid->wavelength_nm, NULL}};
	struct spec_chart chart = {.width = job->chart.width,
		.height = job->chart.height,
		.grid = grid,
		.quantity = "reflectance factor",
		.evaluate = spec_disc_chart_evaluate,
		.state = &state};
	enum spec_status status;

	spec_disc_chart_variables(
		&chart, job->eye_deg, job->chart.angle_deg, job->azimuth_deg);
	status = spec_chart_parse(&chart, job->chart.axes, error);
	if (status == SPEC_OK)
		status = check_axes(job, &chart, error);
	if (status == SPEC_OK)
		status = spec_chart_save(&chart, &job->settings, &job->overflows, error);
	return status;
}

/* --orders and --chart. */
static enum spec_status
show_disc(struct job *job, struct spec_error *error)
{
	struct spec_grid grid = {0};
	struct spec_disc disc;
	enum spec_status status = make_disc(job, &job->discs.group[0], &disc, error);

	if (status == SPEC_OK)
		status = spec_chart_options_grid(&job->chart, &grid, error);
	if (status == SPEC_OK)
		status = job->orders ? print_orders(job, &disc, &grid, error)
				     : draw_chart(job, &disc, &grid, error);
	spec_grid_free(&grid);
	return status;
}

static enum spec_status
light_image(struct job *job, struct spec_reader *reader, long long *bare,
	struct spec_error *error)
{
	struct spec_diffract diffract;
	enum spec_status status = spec_diffract_plan(&diffract, spec_reader_image(reader),
		&job->setup, spec_reader_name(reader), error);

	if (status == SPEC_OK)
		status = spec_settings_record(
			&job->settings, &diffract.relight.image, error);
	if (status == SPEC_OK)
		status = spec_diffract_run(
			&diffract, reader, &job->settings, &job->overflows, error);
	*bare = atomic_load(&diffract.bare);
	spec_diffract_free(&diffract);
	return status;
}

static enum spec_status
disc_image(struct job *job, long long *bare, struct spec_error *error)
{
	struct spec_disc *disc =
		spec_memory_new(job->discs.count, sizeof *disc, "discs", error);
	struct spec_mask *mask =
		spec_memory_new(job->discs.count, sizeof *mask, "discs", error);
	struct spec_reader *reader = NULL;
	enum spec_status status = disc && mask ? SPEC_OK : SPEC_ENOMEM;

	for (size_t i = 0; i < job->discs.count && status == SPEC_OK; i++) {
		status = make_disc(job, &job->discs.group[i], &disc[i], error);
		if (status == SPEC_OK)
			status = spec_mask_parse(
				mask, i, job->discs.group[i].option[MASK], "discs", error);
	}
	job->setup.disc = disc;
	job->setup.mask = mask;
	job->setup.discs = job->discs.count;
	job->setup.half = job->settings.half;
	if (status == SPEC_OK)
		status = spec_reader_open(
			&reader, job->input ? job->input : "-", &job->settings, error);
	if (status == SPEC_OK)
		status = light_image(job, reader, bare, error);
	free(disc);
	free(mask);
	spec_reader_close(reader);
	return status;
}

static void
warn(const struct cli *cli, const struct job *job, long long bare)
{
	if (job->settings.quiet)
		return;
	cli_warn_bare(cli, "disc", bare);
	cli_warn_overflows(cli, job->settings.output, job->overflows);
}

int
main(int argc, char **argv)
{
	struct job job = {.discs = {.nouns = "discs"},
		.setup = {.model = spec_disc_composite, .axis = {0, 0, 1}}};
	struct spec_error error = {0};
	struct cli_progress progress;
	enum spec_status status;
	long long bare = 0;
	struct cli cli;

	tool_start(&cli, &program, argc, argv);
	parse(&cli, &job, &error);
	tool_begin(&progress, &job.settings, argc, argv);

	status = job.orders || job.chart.axes ? show_disc(&job, &error)
					      : disc_image(&job, &bare, &error);
	cli_progress_end(&progress);
	cli_check(&cli, status, &error);
	warn(&cli, &job, bare);
	free(job.discs.group);
	return 0;
}
