/* specrender - spectral path tracing of scenes in pbrt's format; see specrender(1). */
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "all/tool.h"
#include "base/number.h"
#include "render/render.h"
#include "scene/parse.h"

#define MOST_SAMPLES (1 << 24)
#define MOST_PIXELS (1 << 20) /* of a side */
#define MOST_FINER 64

static const struct cli_option options[] = {
	{'g', "grid", "LO:HI:STEP", "wavelengths of the bands [nm] (default: 380:780:5)"},
	{'n', "spp", "N", "samples per pixel (default: the scene's, else 16)"},
	{0, "size", "WxH", "of the picture in pixels (default: the scene's)"},
	{0, "crop", "X0,Y0,X1,Y1",
		"render these pixels of the picture alone; X1, Y1 are outside"},
	{'d', "defer", "film|disc|film,disc",
		"write the light that arrives at thin films and discs, "
		"for specfilm and specdisc, in place of what they make of it"},
	{0, "films", "N", "films along the view ray that are deferred (default: 2)"},
	{0, "supersample", "N", "N times the resolution each way"},
	{0, "gbuffer", NULL, "write the first surface's geometry, too"},
	{0, "variance", NULL,
		"write the variance of each sample in the image, too, for "
		"specdiff --same-within"},
	{0, "extrapolate", "refuse|constant",
		"reflectances and indices outside their data (default: refuse)"},
	{0, "seed", "N", "of the random numbers (default: the scene's)"},
	{0},
};

static const struct cli_program program = {
	.name = "specrender",
	.arguments = "[OPTION]... [SCENE.pbrt]",
	.summary = "Render a scene in pbrt's format, all wavelength bands along each path.",
	.options = options,
	.writes_images = 1,
};

struct job {
	const char *input, *grid;
	struct spec_render_setup setup;
	int has_seed, films;
	unsigned long long overflows;
	struct spec_settings settings;
};

static enum spec_status
take_defer(struct job *job, const char *value, struct spec_error *error)
{
	int films = strcmp(value, "film") == 0, discs = strcmp(value, "disc") == 0;
	int both = strcmp(value, "film,disc") == 0 || strcmp(value, "disc,film") == 0;

	if (!films && !discs && !both)
		return spec_error_set(
			error, SPEC_EUSAGE, "'%s' is not film, disc or film,disc", value);
	job->setup.films = films || both;
	job->setup.discs = discs || both;
	return SPEC_OK;
}

static enum spec_status
take_option(void *state, const char *name, const char *value, struct spec_error *error)
{
	struct job *job = state;
	struct spec_render_setup *setup = &job->setup;
	int known;

	if (strcmp(name, "spp") == 0)
		return spec_number_parse_int(value, 1, MOST_SAMPLES,
			"the number of samples", &setup->samples, error);
	if (strcmp(name, "size") == 0)
		return spec_number_parse_size(value, MOST_PIXELS, "the size", &setup->width,
			&setup->height, error);
	if (strcmp(name, "crop") == 0) {
		setup->has_crop = 1;
		return spec_settings_crop(value, &setup->crop, error);
	}
	if (strcmp(name, "defer") == 0)
		return take_defer(job, value, error);
	if (strcmp(name, "films") == 0)
		return spec_number_parse_int(value, 1, SPEC_RENDER_MOST_FILMS,
			"the number of films", &job->films, error);
	if (strcmp(name, "supersample") == 0)
		return spec_number_parse_int(
			value, 1, MOST_FINER, "the factor", &setup->supersample, error);
	if (strcmp(name, "extrapolate") == 0)
		return spec_extrapolate_parse(value, 0, &setup->extrapolate, error);
	if (strcmp(name, "seed") == 0) {
		job->has_seed = 1;
		return spec_number_parse_whole(
			value, 0, 1LL << 62, "the seed", &setup->seed, error);
	}
	if (strcmp(name, "grid") == 0)
		job->grid = value;
	else if (strcmp(name, "gbuffer") == 0)
		setup->geometry = 1;
	else if (strcmp(name, "variance") == 0)
		setup->variance = 1;
	else
		return spec_settings_take(&job->settings, name, value, &known, error);
	return SPEC_OK;
}

static void
parse(struct cli *cli, struct job *job)
{
	spec_settings_init(&job->settings);
	job->input = cli_take_all(cli, "scene", take_option, job);
	if (job->films > 0 && job->setup.films == 0)
		cli_usage(cli, "--films needs --defer film");
	if (job->setup.films > 0)
		job->setup.films = job->films > 0 ? job->films : 2;
	job->setup.half = job->settings.half;
}

static enum spec_status
render_scene(struct job *job, const struct spec_scene *scene, struct spec_error *error)
{
	struct spec_grid grid = {0};
	struct spec_render_setup setup = job->setup;
	struct spec_render render = {0};
	enum spec_status status = spec_grid_parse(job->grid, &grid, error);

	setup.grid = &grid;
	if (!job->has_seed)
		setup.seed = scene->seed;
	if (status == SPEC_OK)
		status = spec_render_open(&render, scene, &setup, &job->settings, error);
	if (status == SPEC_OK)
		status = spec_settings_record(&job->settings, &render.image, error);
	if (status == SPEC_OK)
		status = spec_render_run(&render, &job->settings, &job->overflows, error);
	spec_render_close(&render);
	spec_grid_free(&grid);
	return status;
}

int
main(int argc, char **argv)
{
	struct job job = {.grid = "380:780:5", .setup = {.supersample = 1}};
	struct spec_error error = {0};
	struct spec_scene scene = {0};
	struct cli_progress progress;
	enum spec_status status;
	struct cli cli;

	tool_start(&cli, &program, argc, argv);
	parse(&cli, &job);
	status = spec_scene_read(&scene, job.input ? job.input : "-", &error);
	cli_check(&cli, status, &error);
	for (size_t i = 0; i < scene.warnings && !job.settings.quiet; i++)
		cli_warn(&cli, "%s", scene.warning[i]);

	tool_begin(&progress, &job.settings, argc, argv);
	status = render_scene(&job, &scene, &error);
	cli_progress_end(&progress);
	cli_check(&cli, status, &error);
	if (!job.settings.quiet)
		cli_warn_overflows(&cli, job.settings.output, job.overflows);
	spec_scene_free(&scene);
	return 0;
}
