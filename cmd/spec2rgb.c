/* spec2rgb - what an eye sees of a spectral image, as a picture; see spec2rgb(1). */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "all/tool.h"
#include "base/number.h"
#include "colour/observer.h"
#include "compare/falsecolour.h"
#include "image/account.h"
#include "image/develop.h"
#include "image/layer.h"
#include "image/level.h"
#include "image/separate.h"
#include "place/own.h"

#define NOTICEABLE 0.01 /* of Y outside the image's range: worth a warning */

static const struct cli_option options[] = {
	{0, "observer", "1931|1964|2015-2|2015-10|SPD",
		"colour-matching functions (default: 1931)"},
	{0, "illuminant", "SPD", "light on an image of reflectance (default: D65)"},
	{0, "space", "NAME|PRIMARIES",
		"srgb, p3, dci-p3, rec709, rec2020, aces, acescg, adobe, xyz, "
		"lab, xyy, or 'xr,yr xg,yg xb,yb xw,yw' (default: srgb)"},
	{0, "transfer", "linear|srgb|rec709|rec2020|adobe|dci|gamma:G",
		"encode whole numbers so (default: as the space has it)"},
	{0, "adapt", "none|vonkries|bradford|cat02|cat16|SPD[:METHOD]",
		"adapt reflectance to the white of the space, or light from "
		"this light, of which daylight is that of its own place and "
		"time (default: none)"},
	{'e', "exposure", "EV|auto|auto:P%",
		"multiply by 2^EV (default: 0), or so that the average becomes "
		"0.18, or the percentile 1"},
	{0, "tone", "none|reinhard|reinhard:W|filmic",
		"compress luminance by a curve (default: none)"},
	{0, "gamut", "clip|desaturate|scale|perceptual",
		"what becomes of colours outside the space (default: clip)"},
	{0, "dither", NULL, "add noise before rounding to 8 bits"},
	{0, "step", "NM", "use bands this far apart, each for those up to the next"},
	{0, "lod", "N|METRIC:X",
		"use 2^N + 1 bands and straight lines between them, or the fewest "
		"whose difference from all bands is X or less; METRIC is de76, "
		"de76-max, de2000 or de2000-max"},
	{0, "error", NULL, "with --step or --lod, print the difference from all bands"},
	{'f', "format", "SUFFIX",
		"of the output, such as ppm (default: the suffix of -o, else png)"},
	{0, "bits", "8|16|32", "bits per sample (default: as the format has them)"},
	{0, "rule", "cie|grid|astm",
		"integrate by 1 nm, over the image's own wavelengths, or by the "
		"weights of ASTM E308 for reflectance (default: cie)"},
	{0, "white", "1|100",
		"Y of the perfect reflector, and of light of 1 per nm (default: 1)"},
	{0, "absolute", NULL,
		"Y in cd/m^2, of radiance, or of reflectance under light whose power is known"},
	{'v', "verbose", NULL,
		"tell how it was integrated, on standard error and in OpenEXR's "
		"spec:integration"},
	{0, "model", "hsv|hsl|yuv|cmyk",
		"the components of a colour model, as an OpenEXR image"},
	{0, "layer", "NAME",
		"show this layer: film1.mirror, through; N, uv and the like as "
		"codes; any channel in false colours"},
	{'b', "band", "WAVELENGTH", "false colours of this band's values"},
	{0, "expr", "EXPRESSION",
		"false colours of a number, such as '(b750-b670)/(b750+b670)'"},
	{0, "stokes", "dop|dolp|docp|aop|ellipticity",
		"false colours of what the Stokes components tell of polarisation"},
	{0, "range", "A..B|auto",
		"the numbers that the map's ends stand for (default: the least "
		"and the largest, or those that a quantity has by itself, such as an angle)"},
	{0, "colour-map", "NAME",
		"viridis, grey, cool-warm or hue (default: viridis; of angles hue)"},
	{0, "legend", NULL, "add the map and its numbers below the picture"},
	{0},
};

static const struct cli_program program = {
	.name = "spec2rgb",
	.arguments = "[OPTION]... [FILE]",
	.summary =
		"Show a spectral image as a picture: PNG, PPM, EXR by the suffix of -o, any "
		"other format through OpenImageIO.",
	.options = options,
};

struct job {
	const char *input, *observer, *illuminant, *adapt, *format;
	const struct spec_model *model; /* or null */
	struct spec_space space;        /* with the transfer function that is used */
	const char *space_text;         /* or null, as the next */
	int untold;                   /* which space it is cannot be seen in the picture */
	int unadapted;                /* it is light, and no light to adapt from is known */
	unsigned long long overflows; /* samples that --bits 16 made infinite */
	const struct spec_transfer *transfer;
	struct spec_transfer gamma; /* where that is a power */
	struct spec_look look;
	double exposure;
	struct spec_level level;
	const char *level_option; /* that gave it, or null */
	int error;                /* of the level is printed */
	enum spec_rule rule;
	const char *white; /* or null */
	enum spec_rgb_scale scale;
	int bits, absolute, verbose;
	const char *layer;            /* or null */
	struct spec_view_setup shown; /* what a false colour is of */
	struct spec_falsecolour_setup painted;
	int ranged;                                    /* its range was given */
	const char *of_colours, *of_scales, *of_bands; /* such an option, or null */
	struct spec_settings settings;
	char *account;    /* of --verbose, once it is planned */
	double luminance; /* of 1, then; 0 where it is not told */
};

static enum spec_status
take_exposure(struct job *job, const char *value, struct spec_error *error)
{
	job->exposure = 0;
	job->look.metering = SPEC_METERING_NONE;
	if (strncmp(value, "auto", 4) == 0)
		return spec_look_meter(&job->look, value, error);
	return spec_number_parse(value, -100, 100, "the exposure", &job->exposure, error);
}

static enum spec_status
take_level(struct job *job, const char *name, const char *value, struct spec_error *error)
{
	if (job->level_option && strcmp(job->level_option, name) != 0)
		return spec_error_set(
			error, SPEC_EUSAGE, "--step and --lod exclude each other");
	job->level_option = name;
	return strcmp(name, "step") == 0 ? spec_level_parse_step(value, &job->level, error)
					 : spec_level_parse(value, &job->level, error);
}

static enum spec_status
take_white(struct job *job, const char *value, struct spec_error *error)
{
	if (strcmp(value, "1") != 0 && strcmp(value, "100") != 0)
		return spec_error_set(error, SPEC_EUSAGE,
			"the Y of white is 1 or 100, not '%.40s'", value);
	job->white = value;
	return SPEC_OK;
}

/* The options that say how bands are summed up. */
static enum spec_status
take_sums(struct job *job, const char *name, const char *value, int *known,
	struct spec_error *error)
{
	*known = 1;
	if (strcmp(name, "rule") == 0)
		return spec_rule_find(value, &job->rule, error);
	if (strcmp(name, "white") == 0)
		return take_white(job, value, error);
	if (strcmp(name, "absolute") == 0)
		job->absolute = 1;
	else if (strcmp(name, "verbose") == 0)
		job->verbose = 1;
	else
		*known = 0;
	return SPEC_OK;
}

/* The options that say how colours are seen. */
static enum spec_status
take_colours(struct job *job, const char *name, const char *value, int *known,
	struct spec_error *error)
{
	enum spec_status status = SPEC_OK;

	*known = 1;
	if (strcmp(name, "illuminant") == 0) {
		job->illuminant = value;
	} else if (strcmp(name, "adapt") == 0) {
		job->adapt = value;
	} else if (strcmp(name, "space") == 0) {
		job->space_text = value;
		status = spec_space_parse(value, &job->space, error);
	} else if (strcmp(name, "transfer") == 0) {
		job->transfer = spec_transfer_parse(value, &job->gamma, error);
		status = job->transfer ? SPEC_OK : SPEC_EUSAGE;
	} else if (strcmp(name, "exposure") == 0) {
		status = take_exposure(job, value, error);
	} else if (strcmp(name, "tone") == 0) {
		status = spec_tone_parse(value, &job->look.tone, error);
	} else if (strcmp(name, "gamut") == 0) {
		status = spec_gamut_find(value, &job->look.gamut, error);
	} else if (strcmp(name, "dither") == 0) {
		job->look.dither = 1;
	} else if (strcmp(name, "step") == 0 || strcmp(name, "lod") == 0) {
		status = take_level(job, name, value, error);
	} else if (strcmp(name, "error") == 0) {
		job->error = 1;
	} else if (strcmp(name, "model") == 0) {
		job->model = spec_model_find(value, error);
		status = job->model ? SPEC_OK : SPEC_EUSAGE;
	} else {
		status = take_sums(job, name, value, known, error);
	}
	if (*known && strcmp(name, "verbose") != 0)
		job->of_colours = name;
	return status;
}

static enum spec_status
take_range(struct job *job, const char *value, struct spec_error *error)
{
	struct spec_falsecolour_setup *painted = &job->painted;
	enum spec_status status;

	job->ranged = 1;
	painted->low = painted->high = 0;
	if (strcmp(value, "auto") == 0)
		return SPEC_OK;
	status = spec_number_parse_range(value, &painted->low, &painted->high, error);
	if (status == SPEC_OK && painted->low == painted->high)
		status = spec_error_set(
			error, SPEC_EUSAGE, "the range '%.200s' has no width", value);
	return status;
}

/* The options that say what is shown in false colours, and on which scale. */
static enum spec_status
take_false(struct job *job, const char *name, const char *value, int *known,
	struct spec_error *error)
{
	enum spec_status status = SPEC_OK;
	int scale = 0;

	*known = 1;
	if (strcmp(name, "band") == 0) {
		status = spec_number_parse_length(
			value, "the wavelength", &job->shown.band_nm, error);
	} else if (strcmp(name, "expr") == 0) {
		job->shown.expression = value;
	} else if (strcmp(name, "stokes") == 0) {
		job->shown.polarisation = spec_stokes_find(value, error);
		status = job->shown.polarisation ? SPEC_OK : SPEC_EUSAGE;
	} else {
		scale = 1;
		if (strcmp(name, "range") == 0)
			status = take_range(job, value, error);
		else if (strcmp(name, "legend") == 0)
			job->painted.legend = 1;
		else if (strcmp(name, "colour-map") == 0)
			status = (job->painted.map = spec_colourmap_find(value, error))
					 ? SPEC_OK
					 : SPEC_EUSAGE;
		else
			*known = 0;
	}
	if (*known && scale)
		job->of_scales = name;
	else if (*known)
		job->of_bands = name;
	return status;
}

static enum spec_status
take_option(void *state, const char *name, const char *value, struct spec_error *error)
{
	struct job *job = state;
	enum spec_status status = SPEC_OK;
	long long bits;
	int known;

	if (strcmp(name, "observer") == 0) {
		job->observer = value;
	} else if (strcmp(name, "layer") == 0) {
		job->layer = value;
	} else if (strcmp(name, "format") == 0) {
		job->format = value;
	} else if (strcmp(name, "bits") == 0) {
		status = spec_number_parse_whole(
			value, 8, 32, "the number of bits", &bits, error);
		job->bits = status == SPEC_OK ? (int)bits : 0;
	} else {
		status = take_colours(job, name, value, &known, error);
		if (!known)
			status = take_false(job, name, value, &known, error);
		if (!known)
			status = spec_settings_take(
				&job->settings, name, value, &known, error);
	}
	return status;
}

/* What changes the light, or is made for a white of 1, contradicts another scale. */
static void
find_scale(struct cli *cli, struct job *job)
{
	const struct spec_look *look = &job->look;

	if (job->absolute && job->white)
		cli_usage(cli, "--absolute and --white exclude each other");
	if (job->absolute)
		job->scale = SPEC_RGB_ABSOLUTE;
	else if (job->white && strcmp(job->white, "100") == 0)
		job->scale = SPEC_RGB_HUNDRED;
	if (job->scale == SPEC_RGB_ONE)
		return;
	if (job->model || job->exposure != 0 || look->metering != SPEC_METERING_NONE ||
		look->gamut || look->tone.kind ||
		job->space.coordinates == SPEC_COORDINATES_LAB)
		cli_usage(cli, "--absolute and --white 100 are for plain sums: without "
			       "--exposure, --tone, --gamut, --model and Lab");
}

static void
parse(struct cli *cli, struct job *job)
{
	spec_settings_init(&job->settings);
	job->input = cli_take_all(cli, "image", take_option, job);
	if (!job->input)
		job->input = "-";
	if (job->model && (job->format || job->bits))
		cli_usage(cli, "--format and --bits are for pictures, not for --model");
	if (job->model && (job->space_text || job->transfer))
		cli_usage(cli, "--model has the components of sRGB alone");
	if (job->model && (job->look.metering != SPEC_METERING_NONE || job->look.gamut ||
				  job->look.tone.kind || job->look.dither))
		cli_usage(cli, "--exposure auto, --tone, --gamut and --dither are for "
			       "pictures, not for --model");
	if (job->error && job->level.kind == SPEC_LEVEL_ALL)
		cli_usage(cli, "--error is of --step or --lod");
	job->level.measured = job->error;
	job->settings.reread = job->error || job->level.kind == SPEC_LEVEL_BOUNDED;
	if (job->settings.reread && job->look.metering != SPEC_METERING_NONE)
		cli_usage(
			cli, "--lod METRIC:X and --error need a given exposure, not auto");
	if (job->shown.expression && job->shown.polarisation)
		cli_usage(cli, "--expr and --stokes exclude each other");
	if (job->of_bands && job->of_colours)
		cli_usage(cli, "--%s makes false colours, which --%s does not change",
			job->of_bands, job->of_colours);
	find_scale(cli, job);
	job->look.space = &job->space;
	if (job->transfer)
		job->space.transfer = job->transfer;
}

/* What a picture's 1 is stays known where nothing else changes the light. */
static enum spec_status
tell(struct job *job, const struct spec_image *image, const struct spec_rgb_setup *setup,
	const struct spec_rgb *rgb, const struct spec_level_report *report,
	struct spec_error *error)
{
	double luminance = spec_account_luminance(setup, rgb);
	int all = job->level.kind == SPEC_LEVEL_ALL;
	char bands[SPEC_LEVEL_TEXT];

	if (!all)
		spec_level_text(&job->level, report, bands);
	if (isfinite(luminance) && job->look.metering == SPEC_METERING_NONE &&
		job->look.gamut != SPEC_GAMUT_SCALE && !job->look.tone.kind)
		job->luminance = luminance;
	return spec_account_text(
		image, setup, rgb, all ? NULL : bands, &job->account, error);
}

/* The sums of the bands that the options leave. */
static enum spec_status
plan(struct job *job, struct spec_reader *reader, const struct spec_image *image,
	struct spec_rgb *rgb, struct spec_level_report *report, struct spec_error *error)
{
	const struct spec_image *whole = spec_reader_image(reader);
	const char *name = spec_reader_name(reader);
	struct spec_curve observer = {0}, illuminant = {0}, light = {0};
	struct spec_rgb_setup setup = {.observer = &observer,
		.illuminant = &illuminant,
		.space = &job->space,
		.exposure = job->exposure,
		.rule = job->rule,
		.scale = job->scale};
	enum spec_status status = spec_observer_load(job->observer, &observer, error);

	if (status == SPEC_OK)
		status = spec_own_lookup_light(
			job->illuminant, whole, name, &illuminant, error);
	if (status == SPEC_OK)
		status = spec_own_adaptation(
			job->adapt, whole, name, &setup.adaptation, &light, error);
	setup.light = light.count > 0 ? &light : NULL;
	job->unadapted = setup.adaptation != SPEC_ADAPTATION_NONE && !setup.light &&
			 image->role != SPEC_ROLE_REFLECTIVE;
	if (status == SPEC_OK) {
		status = spec_rgb_plan(rgb, image, &setup, error);
		if (status != SPEC_OK)
			spec_error_prefix(error, "%s", name);
	}
	if (status == SPEC_OK)
		status = spec_level_apply(&job->level, reader, image, &setup, rgb, report,
			&job->settings, error);
	if (status == SPEC_OK && job->verbose)
		status = tell(job, image, &setup, rgb, report, error);
	spec_curve_free(&observer);
	spec_curve_free(&illuminant);
	spec_curve_free(&light);
	return status;
}

static void
warn_nonfinite(const struct cli *cli, const struct job *job, const char *name,
	long long count, int x, int y)
{
	if (!job->settings.quiet && count > 0)
		cli_warn(cli, "%s: %lld %s not finite, the first at %d,%d", name, count,
			count == 1 ? "pixel is" : "pixels are", x, y);
}

static enum spec_status
develop(struct job *job, struct spec_reader *reader, const struct spec_rgb *rgb,
	struct spec_develop *result, struct spec_error *error)
{
	const struct spec_window *window = &spec_reader_image(reader)->data;
	struct spec_picture_kind kind;
	struct spec_picture_file file;
	enum spec_status status = spec_picture_choose(
		job->settings.output, job->format, job->bits, &kind, error);

	if (status == SPEC_OK && job->transfer && job->transfer != &spec_transfer_linear &&
		kind.sample == SPEC_PICTURE_FLOAT)
		status = spec_error_set(error, SPEC_EUSAGE,
			"--transfer is for whole numbers: floats stay linear");
	if (status == SPEC_OK && job->scale != SPEC_RGB_ONE &&
		kind.sample != SPEC_PICTURE_FLOAT)
		status = spec_error_set(error, SPEC_EUSAGE,
			"--absolute and --white 100 are for floats, such as those of "
			"OpenEXR: whole numbers end at 1");
	kind.account = job->account;
	kind.luminance = job->luminance;
	if (status == SPEC_OK)
		status = spec_picture_file_open(&file, job->settings.output, &kind,
			spec_window_width(window), spec_window_height(window),
			rgb->raw ? NULL : &job->space, error);
	if (status != SPEC_OK)
		return status;
	job->untold = !rgb->raw && !spec_picture_tells_space(&kind, &job->space);
	status = spec_develop_run(result, reader, rgb, &job->look, file.picture,
		kind.sample, &job->settings, error);
	job->overflows = spec_picture_overflows(file.picture);
	return spec_picture_file_end(&file, status, error);
}

static enum spec_status
paint(struct job *job, struct spec_reader *reader, struct spec_falsecolour *result,
	struct spec_error *error)
{
	struct spec_falsecolour_setup *painted = &job->painted;
	struct spec_picture_kind kind;
	struct spec_picture_file file;
	size_t width, height;
	enum spec_status status = spec_picture_choose(
		job->settings.output, job->format, job->bits, &kind, error);

	spec_falsecolour_size(painted, spec_reader_image(reader), &width, &height);
	/* Components of vectors are no light. */
	if (status == SPEC_OK)
		status = spec_picture_file_open(&file, job->settings.output, &kind, width,
			height,
			painted->view->numbers == 1 ? spec_space_find("srgb", NULL) : NULL,
			error);
	if (status != SPEC_OK)
		return status;
	status = spec_falsecolour_run(
		result, painted, reader, file.picture, kind.sample, &job->settings, error);
	return spec_picture_file_end(&file, status, error);
}

/* What is the same in all pixels of a false colour. */
static enum spec_status
prepare(struct job *job, const struct spec_image *image, const char *name,
	struct spec_view *view, struct spec_error *error)
{
	struct spec_falsecolour_setup *painted = &job->painted;
	struct spec_curve observer = {0};
	struct spec_view_setup shown = job->shown;
	enum spec_status status = spec_observer_load(job->observer, &observer, error);

	shown.observer = &observer;
	if (status == SPEC_OK)
		status = spec_view_make(view, image, name, &shown, error);
	spec_curve_free(&observer);
	if (status != SPEC_OK)
		return status;
	if (view->numbers > 1 && (painted->legend || painted->map))
		return spec_error_set(error, SPEC_EUSAGE,
			"%s: '%s' has several numbers in each pixel: they have no colour map and no legend",
			name, job->layer);
	painted->view = view;
	if (!job->ranged) {
		painted->low = view->low;
		painted->high = view->high;
	}
	if (!painted->map)
		painted->map = spec_colourmap_find(view->map, error);
	return painted->map ? SPEC_OK : SPEC_EUSAGE;
}

static void
show_false(struct cli *cli, struct job *job, struct spec_reader *reader,
	const struct spec_image *image, struct cli_progress *progress)
{
	const char *name = spec_reader_name(reader);
	struct spec_error error = {0};
	struct spec_falsecolour seen = {0};
	struct spec_view view = {0};
	enum spec_status status = prepare(job, image, name, &view, &error);

	cli_check(cli, status, &error);
	status = paint(job, reader, &seen, &error);
	cli_progress_end(progress);
	cli_check(cli, status, &error);
	if (job->verbose)
		fprintf(stderr, "%s: %s: %s: the scale is %g..%g\n", program.name, name,
			view.label, seen.low, seen.high);
	warn_nonfinite(cli, job, name, seen.nonfinite, seen.first_x, seen.first_y);
	job->painted.view = NULL;
	spec_view_free(&view);
}

static void
show_colours(struct cli *cli, struct job *job, struct spec_reader *reader,
	const struct spec_image *image, struct cli_progress *progress)
{
	const char *name = spec_reader_name(reader);
	struct spec_error error = {0};
	struct spec_rgb rgb = {0};
	struct spec_develop seen = {0};
	struct spec_level_report report = {0};
	enum spec_status status = plan(job, reader, image, &rgb, &report, &error);

	if (status != SPEC_OK)
		cli_progress_end(progress);
	cli_check(cli, status, &error);
	status = job->model ? spec_separate_run(&seen, reader, &rgb, job->model,
				      &job->settings, &error)
			    : develop(job, reader, &rgb, &seen, &error);
	cli_progress_end(progress);
	cli_check(cli, status, &error);
	if (!job->settings.quiet && rgb.outside > NOTICEABLE)
		cli_warn(cli, "%s: %.1f %% of the luminance lies outside its bands", name,
			100 * rgb.outside);
	if (!job->settings.quiet)
		cli_warn_overflows(cli, job->settings.output, job->overflows);
	if (!job->settings.quiet && job->unadapted)
		cli_warn(cli, "%s: light is adapted from a light alone, as by --adapt A:%s",
			name, job->adapt);
	if (!job->settings.quiet && job->untold)
		cli_warn(cli,
			"the format cannot tell the space, %s%s%s: who reads it takes it for sRGB",
			job->space.title, job->transfer ? ", transfer function " : "",
			job->transfer ? job->transfer->name : "");
	warn_nonfinite(cli, job, name, seen.nonfinite, seen.first_x, seen.first_y);
	if (job->account)
		fprintf(stderr, "%s: %s: %s\n", program.name, name, job->account);
	if (job->error)
		spec_level_print(&report, stderr);
	spec_rgb_free(&rgb);
}

/* The image that is shown: the file's, or a layer of it. Returns whether in false colours. */
static int
choose(struct cli *cli, struct job *job, const struct spec_reader *reader,
	struct spec_image *chosen, struct spec_layer *layer,
	const struct spec_image **image)
{
	struct spec_error error = {0};

	*image = spec_reader_image(reader);
	layer->kind = SPEC_LAYER_BANDS;
	if (job->layer) {
		enum spec_status status = spec_layer_find(layer, *image,
			spec_reader_name(reader), job->layer, chosen, &error);

		cli_check(cli, status, &error);
		if (layer->kind == SPEC_LAYER_BANDS)
			*image = chosen;
		else if (job->of_bands)
			cli_usage(cli, "--%s is for bands, and the layer '%s' has none",
				job->of_bands, job->layer);
		else if (job->of_colours)
			cli_usage(cli,
				"the layer '%s' is no light: --%s does not go with it",
				job->layer, job->of_colours);
		else
			job->shown.layer = layer;
	}
	if (job->of_bands || job->shown.layer)
		return 1;
	if (job->of_scales)
		cli_usage(cli,
			"--%s is for false colours: --band, --expr, --stokes, or --layer of a channel",
			job->of_scales);
	return 0;
}

int
main(int argc, char **argv)
{
	struct job job = {.observer = "1931",
		.illuminant = "illuminants/D65",
		.adapt = "none",
		.space = *spec_space_find("srgb", NULL)};
	struct spec_error error = {0};
	struct spec_reader *reader = NULL;
	struct spec_image chosen = {0};
	struct spec_layer layer;
	const struct spec_image *image;
	struct cli_progress progress;
	enum spec_status status;
	struct cli cli;

	tool_start(&cli, &program, argc, argv);
	parse(&cli, &job);
	tool_begin(&progress, &job.settings, argc, argv);

	status = spec_reader_open(&reader, job.input, &job.settings, &error);
	cli_check(&cli, status, &error);
	if (choose(&cli, &job, reader, &chosen, &layer, &image))
		show_false(&cli, &job, reader, image, &progress);
	else
		show_colours(&cli, &job, reader, image, &progress);
	spec_image_clear(&chosen);
	free(job.account);
	spec_reader_close(reader);
	return 0;
}
