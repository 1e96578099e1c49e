/* specfilm - interference in thin films, on light layers or as a chart; see specfilm(1). */
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "all/tool.h"
#include "base/memory.h"
#include "base/number.h"
#include "cli/groups.h"
#include "image/filmchart.h"
#include "image/fold.h"
#include "spectrum/spd.h"

static const struct cli_option options[] = {
	{'s', "stack", "STACK",
		"ambient | layer thickness | ... | substrate, such as "
		"'air | 1.33 500nm | air' or 'air | (TiO2 60nm | SiO2 95nm)^8 | N-BK7'"},
	{'t', "thickness", "THICKNESS",
		"of the only layer, or of the one with * for its thickness: "
		"500nm, or 'gravity 530nm..730nm [AXIS]'"},
	{'m', "mask", "ID",
		"this stack is for surfaces of this id; repeat --stack for others"},
	{0, "polarisation", "u|s|p", "of all light (default: u, unpolarised)"},
	{'k', "keep", NULL, "leave the layers in the image"},
	{0, "spectrum", NULL, "print R, T and A over wavelength, and read no image"},
	{0, "chart", "AXES",
		"make a chart, and read no image: one or two of "
		"'thickness A..B, angle A..B', to the right and downwards"},
	{0, "of", "SHARE",
		"a chart of: reflectance transmittance absorptance (default: reflectance)"},
	{0, "size", "WxH", "of the chart in pixels (default: 480x270)"},
	{'a', "angle", "ANGLE", "of incidence, for --spectrum and --chart (default: 0deg)"},
	{'g', "grid", "LO:HI:STEP",
		"wavelengths of --spectrum and --chart [nm] (default: 380:780:5)"},
	{0, "extrapolate", "refuse|constant",
		"indices outside their data (default: refuse)"},
	{0},
};

static const struct cli_program program = {
	.name = "specfilm",
	.arguments = "--stack STACK [OPTION]... [FILE]",
	.summary =
		"Put thin films on the surfaces that an image's light layers show, or chart what "
		"films reflect.",
	.options = options,
	.writes_images = 1,
};

/* Options of a film. */
enum { STACK, THICKNESS, MASK };

struct job {
	const char *input;
	struct cli_groups films;
	enum spec_polarisation polarisation;
	enum spec_film_share share;
	enum spec_extrapolate extrapolate;
	struct spec_chart_options chart;
	int keep, spectrum, has_share;
	unsigned long long overflows;
	struct spec_settings settings;
};

static enum spec_status
take_option(void *state, const char *name, const char *value, struct spec_error *error)
{
	struct job *job = state;
	int known;
	enum spec_status status =
		spec_chart_options_take(&job->chart, name, value, &known, error);

	if (known)
		return status;
	if (strcmp(name, "stack") == 0)
		return cli_groups_take(&job->films, STACK, value, error);
	if (strcmp(name, "thickness") == 0)
		return cli_groups_take(&job->films, THICKNESS, value, error);
	if (strcmp(name, "mask") == 0)
		return cli_groups_take(&job->films, MASK, value, error);
	if (strcmp(name, "of") == 0) {
		job->has_share = 1;
		return spec_film_share_parse(value, &job->share, error);
	}
	if (strcmp(name, "polarisation") == 0)
		return spec_polarisation_parse(value, &job->polarisation, error);
	if (strcmp(name, "extrapolate") == 0)
		return spec_extrapolate_parse(value, 0, &job->extrapolate, error);
	if (strcmp(name, "keep") == 0)
		job->keep = 1;
	else if (strcmp(name, "spectrum") == 0)
		job->spectrum = 1;
	else
		return spec_settings_take(&job->settings, name, value, &known, error);
	return SPEC_OK;
}

/* What goes together, and what does not. */
static void
check_options(const struct cli *cli, const struct job *job)
{
	int alone = job->spectrum || job->chart.axes;

	for (size_t i = 0; i < job->films.count; i++) {
		if (!job->films.group[i].option[STACK])
			cli_usage(cli, "--thickness and --mask need a --stack");
	}
	if (job->films.count == 0)
		cli_usage(cli, "there is no --stack");
	if (job->spectrum && job->chart.axes)
		cli_usage(cli, "--spectrum and --chart exclude each other");
	if (alone && job->input)
		cli_usage(cli, "--spectrum and --chart read no image: '%s'", job->input);
	if (alone &&
		(job->films.count > 1 || job->films.group[0].option[MASK] || job->keep))
		cli_usage(cli, "--spectrum and --chart take one --stack, and neither "
			       "--mask nor --keep");
	if (!alone && (job->chart.has_angle || job->chart.grid))
		cli_usage(cli, "--angle and --grid are for --spectrum and --chart");
	if (!job->chart.axes && (job->chart.has_size || job->has_share))
		cli_usage(cli, "--size and --of are for --chart");
}

static void
parse(struct cli *cli, struct job *job)
{
	spec_chart_options_init(&job->chart);
	spec_settings_init(&job->settings);
	job->input = cli_take_all(cli, "image", take_option, job);
	check_options(cli, job);
}

/* The coating of a film at wavelengths. thickness: in place of the film's own, or null. */
static enum spec_status
make_coating(const struct job *job, const struct cli_group *film,
	const struct spec_thickness *thickness, const double *wavelength_nm, size_t count,
	struct spec_coating *coating, struct spec_error *error)
{
	struct spec_recipe recipe = {0};
	struct spec_thickness own;
	enum spec_status status = spec_recipe_parse(film->option[STACK], &recipe, error);

	if (status == SPEC_OK && film->option[THICKNESS] && !thickness) {
		status = spec_thickness_parse(film->option[THICKNESS], &own, error);
		thickness = &own;
	}
	if (status == SPEC_OK)
		status = spec_coating_make(coating, &recipe, thickness, wavelength_nm,
			count, job->extrapolate, error);
	spec_recipe_free(&recipe);
	return status;
}

static enum spec_status
refuse_gravity(const struct spec_coating *coating, struct spec_error *error)
{
	if (coating->thickness.kind == SPEC_THICKNESS_CONSTANT)
		return SPEC_OK;
	return spec_error_set(error, SPEC_EUSAGE,
		"--spectrum and --chart need one thickness, not a course of it");
}

static enum spec_status
print_spectrum(
	const struct job *job, const struct spec_coating *coating, struct spec_error *error)
{
	static const char *const light[] = {"unpolarised", "s", "p"};
	struct spec_curve curve = {0};
	const char *thickness = job->films.group[0].option[THICKNESS];
	char title[512];
	enum spec_status status = spec_coating_curve(coating,
		spec_film_cosine(job->chart.angle_deg), job->polarisation, &curve, error);

	snprintf(title, sizeof title, "%.380s%s%.40s, %g deg, %s light",
		job->films.group[0].option[STACK], thickness ? ", * " : "",
		thickness ? thickness : "", job->chart.angle_deg, light[job->polarisation]);
	spec_error_plain(title);
	if (status == SPEC_OK)
		status = spec_curve_set_text(&curve.title, title, error);
	if (status == SPEC_OK)
		status = spec_spd_save(job->settings.output, &curve, error);
	spec_curve_free(&curve);
	return status;
}

static enum spec_status
draw_chart(struct job *job, const struct spec_chart *axes,
	const struct spec_coating *coating, struct spec_error *error)
{
	struct spec_film_chart film = {coating, job->polarisation, job->share};
	struct spec_chart chart = *axes;

	chart.width = job->chart.width;
	chart.height = job->chart.height;
	chart.quantity = spec_film_share_name(job->share);
	chart.evaluate = spec_film_chart_evaluate;
	chart.state = &film;
	return spec_chart_save(&chart, &job->settings, &job->overflows, error);
}

static int
has_axis(const struct spec_chart *chart, size_t variable)
{
	return chart->axis[0].variable == variable || chart->axis[1].variable == variable;
}

/* What an axis gives is not given by an option, too. */
static enum spec_status
check_axes(const struct job *job, const struct spec_chart *chart, struct spec_error *error)
{
	if (!job->chart.axes)
		return SPEC_OK;
	if (has_axis(chart, SPEC_FILM_THICKNESS) && job->films.group[0].option[THICKNESS])
		return spec_error_set(error, SPEC_EUSAGE,
			"the chart goes over the thickness, and --thickness gives one");
	if (has_axis(chart, SPEC_FILM_ANGLE) && job->chart.has_angle)
		return spec_error_set(error, SPEC_EUSAGE,
			"the chart goes over the angle, and --angle gives one");
	return SPEC_OK;
}

/* --spectrum and --chart. */
static enum spec_status
show_film(struct job *job, struct spec_error *error)
{
	struct spec_thickness any = {.kind = SPEC_THICKNESS_CONSTANT};
	struct spec_chart chart = {0};
	struct spec_coating coating = {0};
	struct spec_grid grid = {0};
	int over_thickness;
	enum spec_status status = spec_chart_options_grid(&job->chart, &grid, error);

	spec_film_chart_variables(&chart, 0, job->chart.angle_deg);
	if (status == SPEC_OK && job->chart.axes)
		status = spec_chart_parse(&chart, job->chart.axes, error);
	if (status == SPEC_OK)
		status = check_axes(job, &chart, error);
	over_thickness = job->chart.axes && has_axis(&chart, SPEC_FILM_THICKNESS);
	if (status == SPEC_OK)
		status = make_coating(job, &job->films.group[0],
			over_thickness ? &any : NULL, grid.wavelength_nm, grid.count,
			&coating, error);
	if (status == SPEC_OK)
		status = refuse_gravity(&coating, error);
	chart.grid = &grid;
	chart.variable[SPEC_FILM_THICKNESS].value = coating.thickness.top_nm;
	if (status == SPEC_OK)
		status = job->spectrum ? print_spectrum(job, &coating, error)
				       : draw_chart(job, &chart, &coating, error);
	spec_coating_free(&coating);
	spec_grid_free(&grid);
	return status;
}

static enum spec_status
fold_image(struct job *job, struct spec_reader *reader, const struct spec_coating *coating,
	const struct spec_mask *mask, long long *bare, struct spec_error *error)
{
	struct spec_fold_setup setup = {coating, mask, job->films.count, job->polarisation,
		job->keep, job->settings.half};
	struct spec_fold fold;
	enum spec_status status = spec_fold_plan(
		&fold, spec_reader_image(reader), &setup, spec_reader_name(reader), error);

	if (status == SPEC_OK)
		status = spec_settings_record(&job->settings, &fold.relight.image, error);
	if (status == SPEC_OK)
		status = spec_fold_run(
			&fold, reader, &job->settings, &job->overflows, error);
	*bare = atomic_load(&fold.bare);
	spec_fold_free(&fold);
	return status;
}

static enum spec_status
film_image(struct job *job, long long *bare, struct spec_error *error)
{
	struct spec_mask *mask =
		spec_memory_new(job->films.count, sizeof *mask, "stacks", error);
	struct spec_coating *coating =
		spec_memory_new(job->films.count, sizeof *coating, "stacks", error);
	struct spec_reader *reader = NULL;
	enum spec_status status = mask && coating ? SPEC_OK : SPEC_ENOMEM;

	for (size_t i = 0; i < job->films.count && status == SPEC_OK; i++)
		status = spec_mask_parse(
			mask, i, job->films.group[i].option[MASK], "stacks", error);
	/* What is wrong with the command shows before a pipe is waited for. */
	for (size_t i = 0; i < job->films.count && status == SPEC_OK; i++) {
		struct spec_recipe recipe;

		status = spec_recipe_parse(
			job->films.group[i].option[STACK], &recipe, error);
		if (status == SPEC_OK)
			spec_recipe_free(&recipe);
	}
	if (status == SPEC_OK)
		status = spec_reader_open(
			&reader, job->input ? job->input : "-", &job->settings, error);
	for (size_t i = 0; i < job->films.count && status == SPEC_OK; i++) {
		const struct spec_image *image = spec_reader_image(reader);

		status = make_coating(job, &job->films.group[i], NULL, image->wavelength_nm,
			image->bands, &coating[i], error);
	}
	if (status == SPEC_OK)
		status = fold_image(job, reader, coating, mask, bare, error);
	for (size_t i = 0; coating && i < job->films.count; i++)
		spec_coating_free(&coating[i]);
	free(coating);
	free(mask);
	spec_reader_close(reader);
	return status;
}

static void
warn(const struct cli *cli, const struct job *job, long long bare)
{
	if (job->settings.quiet)
		return;
	cli_warn_bare(cli, "stack", bare);
	cli_warn_overflows(cli, job->settings.output, job->overflows);
}

int
main(int argc, char **argv)
{
	struct job job = {.films = {.nouns = "stacks"}};
	struct spec_error error = {0};
	struct cli_progress progress;
	enum spec_status status;
	long long bare = 0;
	struct cli cli;

	tool_start(&cli, &program, argc, argv);
	parse(&cli, &job);
	tool_begin(&progress, &job.settings, argc, argv);

	status = job.spectrum || job.chart.axes ? show_film(&job, &error)
						: film_image(&job, &bare, &error);
	cli_progress_end(&progress);
	cli_check(&cli, status, &error);
	warn(&cli, &job, bare);
	free(job.films.group);
	return 0;
}
