/* specconvert - change the grid, values or extent of spectra; see specconvert(1). */
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "all/tool.h"
#include "base/memory.h"
#include "image/convert.h"
#include "image/convertoptions.h"
#include "image/curveinput.h"
#include "image/curveoutput.h"
#include "image/fromrgb.h"
#include "image/kind.h"
#include "image/patches.h"
#include "image/represented.h"
#include "image/reproject.h"
#include "image/vectors.h"
#include "place/own.h"
#include "place/placed.h"
#include "spectrum/reshape.h"

static const struct cli_option options[] = {
	{'g', "grid", "LO:HI:STEP|FILE|native",
		"new bands at these wavelengths [nm], or at those of a FILE or SPD"},
	{0, "interp", "linear|nearest|left|sprague",
		"what lies between the old ones (default: linear, or as a "
		"curve's file says)"},
	{0, "rebin", NULL, "the bins of --grid get the energy of the old bins"},
	{'b', "band", "WAVELENGTH", "keep this band; may be given several times"},
	{0, "bands-only", NULL, "drop every channel that is no band"},
	{0, "per", "nm|band", "make values densities, or integrals over bands"},
	{0, "to-air", NULL, "make wavelengths in vacuum those in air"},
	{0, "to-vacuum", NULL, "make wavelengths in air those in vacuum"},
	{0, "input-unit", "nm|um|THz|cm-1", "what a curve is tabulated over (default: nm)"},
	{'m', "multiply", "SPD",
		"multiply by a curve; this and the following may be "
		"given several times, and are done in the order given"},
	{0, "divide", "SPD", "divide by a curve"},
	{0, "add", "SPD", "add a curve"},
	{'s', "scale", "X", "multiply by a number"},
	{0, "raise", "X", "raise to a power"},
	{0, "clamp", "A..B", "bound from below and above"},
	{0, "illuminate", "SPD", "turn reflectance into the light it sends back"},
	{0, "reflectance-of", "SPD", "turn light into the reflectance under this light"},
	{0, "least", "X",
		"light below X of its most tells no reflectance (default: 0.001)"},
	{0, "from-rgb", "smits|sun|sigmoid|basis",
		"make spectra of the colours of an image, or of '#rrggbb'"},
	{0, "as", "reflectance|light|unbounded",
		"what they become (default: reflectance; after sun, light)"},
	{0, "vectors", "NAME",
		"make channels NAME.X, NAME.Y, NAME.Z of a picture's codes c, 2 c - 1: undoes "
		"spec2rgb --layer N"},
	{0, "extrapolate", "refuse|zero|constant",
		"what lies outside the data (default: refuse)"},
	{0, "to", "KIND",
		"another representation: sampled[:LO:HI:STEP], tabulated, "
		"fourier:N, composite:K or composite:K,N"},
	{0, "from-plot", "X,Y=WAVELENGTH,VALUE X,Y=WAVELENGTH,VALUE",
		"read a curve off the picture of a plot, by two places in it"},
	{0, "ink", "'#RRGGBB'", "the colour of that curve"},
	{0, "paper", "'#RRGGBB'", "what is behind it (default: '#ffffff')"},
	{0, "atlas", NULL, "pack curves into an image, four samples in each pixel"},
	{0, "row", "NAME", "take the curve of that name out of such an image"},
	{0, "place", "PLACE", "say where the image was taken"},
	{0, "time", "TIME", "say when: ISO 8601 with an offset, or now"},
	{0, "crop", "X0,Y0,X1,Y1",
		"keep these pixels of the data window; X1, Y1 are outside"},
	{0, "downsample", "N", "mean of N x N pixels"},
	{0, "projection", "NAME[:HEIGHT]",
		"lay out anew what is all around: latlong, cross, tall-cross, "
		"octahedral; the input's shape tells its own"},
	{0, "patches", "COLUMNSxROWS", "make a chart of patches from curves"},
	{0, "patch", "PIXELS", "side of a patch (default: 1)"},
	{0, "gap", "PIXELS", "black between the patches (default: 0)"},
	{0, "strip", "HEIGHT",
		"make a picture of a curve: a pixel for each wavelength, "
		"red, green and blue its columns"},
	{0, "scaling", "none|global|channel",
		"divide a strip by its greatest value (default: none)"},
	{'f', "format", "exr|envi|hsr|tiff|bands|spd|csv",
		"of the output (default: the suffix of -o, else the input's)"},
	{0},
};

static const struct cli_program program = {
	.name = "specconvert",
	.arguments = "[OPTION]... [FILE|SPD]...",
	.summary =
		"Change the grid, values or extent of a spectral image or of curves, and turn "
		"one into the other.",
	.options = options,
	.writes_images = 1,
};

struct job {
	const char **input;
	size_t inputs;
	size_t input_room;
	struct spec_convert_options change;
	struct spec_curve_input from; /* where curves come from */
	struct spec_curve_output into;
	struct spec_placed placed;
	const char *vectors; /* their name, or null */
	int projects;        /* the option was given */
	enum spec_projection projection;
	size_t height;                /* of it, or 0 */
	enum spec_kind kind;          /* of the output */
	unsigned long long clamped;   /* pixels whose colour was out of range */
	unsigned long long overflows; /* samples that --half made infinite */
	struct spec_settings settings;
};

static enum spec_status
take_input(struct job *job, const char *path, struct spec_error *error)
{
	void *list = (void *)job->input;
	enum spec_status status = spec_memory_grow(&list, &job->input_room, job->inputs + 1,
		sizeof *job->input, "inputs", error);

	job->input = list;
	if (status == SPEC_OK)
		job->input[job->inputs++] = path;
	return status;
}

static enum spec_status
take_format(struct job *job, const char *text, struct spec_error *error)
{
	enum spec_status status = spec_kind_of_format(text, &job->kind, error);

	job->settings.format = job->kind == SPEC_KIND_IMAGE ? text : NULL;
	return status;
}

/* What is about the layout of pixels, and the output. */
static enum spec_status
take_image(struct job *job, const char *name, const char *value, int *known,
	struct spec_error *error)
{
	*known = 1;
	if (strcmp(name, "vectors") == 0) {
		job->vectors = value;
		return SPEC_OK;
	}
	if (strcmp(name, "projection") == 0) {
		job->projects = 1;
		return spec_projection_parse(value, &job->projection, &job->height, error);
	}
	if (strcmp(name, "format") == 0)
		return take_format(job, value, error);
	*known = 0;
	return SPEC_OK;
}

static enum spec_status
take(void *state, const char *name, const char *value, struct spec_error *error)
{
	struct job *job = state;
	enum spec_status status;
	int known = 0;

	if (!name)
		return take_input(job, value, error);
	status = take_image(job, name, value, &known, error);
	if (!known && status == SPEC_OK && value && spec_own_light_is_named(value))
		status = spec_convert_options_defer(
			&job->change, name, value, &known, error);
	if (!known && status == SPEC_OK)
		status =
			spec_convert_options_take(&job->change, name, value, &known, error);
	if (!known && status == SPEC_OK)
		status = spec_curve_input_take(&job->from, name, value, &known, error);
	if (!known && status == SPEC_OK)
		status = spec_curve_output_take(&job->into, name, value, &known, error);
	if (!known && status == SPEC_OK)
		status = spec_placed_take(&job->placed, name, value, &known, error);
	if (!known && status == SPEC_OK)
		status = spec_settings_take(&job->settings, name, value, &known, error);
	return status;
}

static void
parse(struct cli *cli, struct job *job, struct spec_error *error)
{
	spec_settings_init(&job->settings);
	spec_convert_options_init(&job->change);
	spec_curve_input_init(&job->from);
	spec_curve_output_init(&job->into);
	cli_take_each(cli, take, job);
	if (job->inputs == 0)
		cli_check(cli, take_input(job, "-", error), error);
	cli_check(cli, spec_convert_options_settle(&job->change, &job->settings, error),
		error);
	cli_check(cli, spec_curve_input_settle(&job->from, error), error);
	if (job->change.has_to && (spec_curve_input_is_image(&job->from) ||
					  job->into.atlas || job->into.strip > 0))
		cli_usage(cli, "--to excludes --from-plot, --row, --atlas and --strip");
	job->into.patches.half = job->from.colours.half = job->settings.half;
	job->into.patches.extrapolate = job->from.colours.extrapolate =
		job->change.setup.extrapolate;
	job->into.patches.grid = job->from.colours.grid = job->change.setup.grid;
}

/* What is for images in OpenEXR: text, strips and atlases have samples of their own. */
static enum spec_status
check_storage(const struct job *job, struct spec_error *error)
{
	const struct spec_settings *settings = &job->settings;
	const char *what = spec_kind_is_text(job->kind) ? "text"
			   : job->into.strip > 0        ? "a strip"
			   : job->into.atlas            ? "an atlas"
							: NULL;

	if (what && settings->half)
		return spec_error_set(error, SPEC_EUSAGE,
			"--half is for images in OpenEXR alone, not for %s", what);
	if (what && !job->into.atlas && settings->compression >= 0)
		return spec_error_set(error, SPEC_EUSAGE,
			"--compression is for OpenEXR alone, not for %s", what);
	return SPEC_OK;
}

/* The kind of the output: as --format or the suffix says, else as the input is. */
static enum spec_status
settle_kind(struct job *job, enum spec_kind input, struct spec_error *error)
{
	enum spec_status status = SPEC_OK;

	if (job->kind == SPEC_KIND_UNTOLD)
		status = spec_kind_of_output(job->settings.output, &job->kind, error);
	if (job->kind == SPEC_KIND_UNTOLD)
		job->kind = input;
	return status;
}

/* ---- curves ---- */

/* What is for images alone, and what does not go together. */
static enum spec_status
check_curve_options(const struct job *job, struct spec_error *error)
{
	const struct spec_convert_setup *setup = &job->change.setup;
	const char *wrong = NULL;

	for (size_t i = 0; i < setup->operations; i++)
		if (job->change.operation[i].kind == SPEC_OPERATION_ILLUMINATE ||
			job->change.operation[i].kind == SPEC_OPERATION_REFLECTANCE_OF)
			wrong = "--illuminate and --reflectance-of are for images, not for "
				"curves (--multiply, --divide)";
	if (!wrong && (setup->has_crop || setup->downsample > 1 || setup->bands ||
			      setup->bands_only || setup->per != SPEC_CONVERT_AS_IT_IS ||
			      job->projects || job->vectors))
		wrong = "--crop, --downsample, --projection, --vectors, --band, --bands-only and "
			"--per are for images, not for curves";
	if (!wrong && job->kind == SPEC_KIND_IMAGE && job->change.has_to)
		wrong = "--to makes text, and the output is an image (-o FILE.spd)";
	if (!wrong && job->change.has_to && job->from.from_rgb)
		wrong = "--from-rgb and --to exclude each other: specconvert --from-rgb "
			"... | specconvert --to ...";
	return wrong ? spec_error_set(error, SPEC_EUSAGE, "%s", wrong)
		     : spec_curve_output_check(&job->into, job->kind, job->inputs, error);
}

static enum spec_status
settle_curves(struct job *job, struct spec_error *error)
{
	int chart = job->into.atlas || job->into.patches.columns > 0;
	enum spec_status status = SPEC_OK;

	if (job->into.strip == 0)
		status = settle_kind(job, chart ? SPEC_KIND_IMAGE : SPEC_KIND_SPD, error);
	if (status == SPEC_OK)
		status = check_curve_options(job, error);
	if (status == SPEC_OK)
		status = check_storage(job, error);
	return status == SPEC_OK ? spec_placed_check(&job->placed,
					   job->kind != SPEC_KIND_IMAGE || job->into.atlas,
					   &job->settings, error)
				 : status;
}

static void
warn_of_curve(const struct cli *cli, const struct job *job, const char *name,
	const struct spec_reshape_notes *notes)
{
	int constant = job->change.setup.extrapolate == SPEC_EXTRAPOLATE_CONSTANT;

	if (job->settings.quiet)
		return;
	if (notes->left)
		cli_warn(cli, "%s: states no quantity: its values were left as they are",
			name);
	if (*notes->outside)
		cli_warn(cli, "%s: has nothing at %s: taken %s", name, notes->outside,
			constant ? "as at its end" : "for 0");
}

/* What is done to each curve. */
static struct spec_reshape
plan_curves(const struct job *job)
{
	static const char *const quantities[SPEC_ROLE_BISPECTRAL + 1] = {
		[SPEC_ROLE_EMISSIVE] = "radiance per nm",
		[SPEC_ROLE_REFLECTIVE] = "reflectance"};
	const struct spec_convert_setup *setup = &job->change.setup;

	return (struct spec_reshape){.quantity = quantities[job->settings.read_as],
		.abscissa = job->change.abscissa,
		.medium = setup->medium,
		.grid = setup->grid,
		.rebin = setup->rebin,
		.edges_nm = setup->edges_nm,
		.operation = setup->operation,
		.operations = setup->operations,
		.extrapolate = setup->extrapolate,
		.has_interpolate = job->change.has_interpolation,
		.interpolate = setup->interpolation};
}

static enum spec_status
convert_curves(const struct cli *cli, struct job *job, struct spec_error *error)
{
	struct spec_reshape reshape = plan_curves(job);
	enum spec_status status = settle_curves(job, error);
	struct spec_image said = {0};
	struct spec_curve *curve;

	if (status == SPEC_OK && job->change.has_to)
		return spec_reshape_save(job->input[0], &reshape, &job->change.to,
			job->settings.output, error);
	if (status != SPEC_OK)
		return status;
	curve = spec_memory_new(job->inputs, sizeof *curve, "curves", error);
	status = curve ? SPEC_OK : SPEC_ENOMEM;
	for (size_t i = 0; i < job->inputs && status == SPEC_OK; i++) {
		struct spec_reshape_notes notes = {0};

		status = spec_curve_input_load(&job->from, job->input[i], &reshape,
			&job->settings, &curve[i], &notes, error);
		if (status == SPEC_OK)
			warn_of_curve(cli, job, job->input[i], &notes);
	}
	if (status == SPEC_OK)
		status = spec_placed_apply(&job->placed, &said, error);
	job->into.attributes = &said;
	if (status == SPEC_OK)
		status = spec_curve_output_save(&job->into, job->kind, curve, job->input,
			job->inputs, &job->settings, &job->overflows, error);
	for (size_t i = 0; curve && i < job->inputs; i++)
		spec_curve_free(&curve[i]);
	job->into.attributes = NULL;
	spec_image_clear(&said);
	free(curve);
	return status;
}

/* ---- images ---- */

static enum spec_status
image_to_text(struct job *job, struct spec_reader *reader, struct spec_error *error)
{
	struct spec_curve curve = {0};
	enum spec_status status;

	if (spec_convert_options_change(&job->change) || job->from.from_rgb)
		return spec_error_set(error, SPEC_EUSAGE,
			"change the image first, then make it text: specconvert ... | "
			"specconvert -f spd");
	status = spec_patches_curve(reader, &curve, error);
	if (status == SPEC_OK)
		status = spec_curve_output_text(
			job->kind, &curve, job->settings.output, error);
	spec_curve_free(&curve);
	return status;
}

/* An image of three colours becomes spectral; nothing else is done to it on the way. */
static enum spec_status
convert_colours(struct job *job, struct spec_reader *reader, struct spec_error *error)
{
	struct spec_convert_options without = job->change;
	struct spec_fromrgb fromrgb;
	enum spec_status status;

	without.setup.grid = NULL;
	if (spec_convert_options_change(&without))
		return spec_error_set(error, SPEC_EUSAGE,
			"make the spectra first, then change the image: specconvert --from-rgb "
			"... | specconvert ...");
	status = spec_fromrgb_plan(&fromrgb, spec_reader_image(reader), &job->from.colours,
		spec_reader_name(reader), error);
	if (status == SPEC_OK)
		status = spec_settings_record(&job->settings, &fromrgb.image, error);
	if (status == SPEC_OK)
		status = spec_fromrgb_run(
			&fromrgb, reader, &job->settings, &job->overflows, error);
	job->clamped = fromrgb.clamped;
	spec_fromrgb_free(&fromrgb);
	return status;
}

/* Coefficients or lines in place of bands; bands are what every reader gives. */
static enum spec_status
convert_representation(
	struct job *job, struct spec_reader *reader, struct spec_error *error)
{
	if (spec_convert_options_change(&job->change))
		return spec_error_set(error, SPEC_EUSAGE,
			"change the image first, then its representation: specconvert ... | "
			"specconvert --to ...");
	if (job->settings.format && strcmp(job->settings.format, "exr") != 0)
		return spec_error_set(error, SPEC_EUSAGE,
			"only OpenEXR files hold other representations than bands");
	return spec_represented_run(
		reader, &job->change.to, &job->settings, &job->overflows, error);
}

/* What is all around is laid out anew, or a picture's codes are vectors. */
static enum spec_status
convert_layout(struct job *job, struct spec_reader *reader, struct spec_error *error)
{
	const char *option = job->vectors ? "--vectors" : "--projection";

	if (spec_convert_options_change(&job->change) || spec_kind_is_text(job->kind) ||
		job->from.from_rgb || job->change.has_to ||
		(job->vectors &&
			(job->projects || job->placed.has_place || job->placed.has_time)))
		return spec_error_set(error, SPEC_EUSAGE,
			"%s does nothing else on the way: specconvert ... | specconvert %s ...",
			option, option);
	if (job->vectors)
		return spec_vectors_run(reader, job->vectors, &job->settings, error);
	return spec_reproject_run(reader, job->projection, job->height, &job->settings,
		&job->overflows, error);
}

/* Whether --to asks an image for something else than the bands that it has anyway. */
static int
leaves_bands(const struct job *job)
{
	return job->change.has_to &&
	       (job->change.to.kind == SPEC_SPECTRUM_FOURIER ||
		       job->change.to.kind == SPEC_SPECTRUM_COMPOSITE);
}

static void
warn(const struct cli *cli, const struct job *job, const struct spec_convert *convert)
{
	unsigned long long spoiled = convert->spoiled;

	for (size_t i = 0; i < convert->notes.count; i++)
		cli_warn(cli, "%s", convert->notes.text[i]);
	if (spoiled > 0)
		cli_warn(cli, "%s: %llu sample%s no finite power", job->settings.output,
			spoiled, spoiled == 1 ? " has" : "s have");
}

/* What is for curves alone. */
static enum spec_status
check_image_options(const struct job *job, struct spec_error *error)
{
	const char *option = spec_curve_output_option(&job->into);

	if (!option && job->change.abscissa != SPEC_ABSCISSA_NM)
		option = "--input-unit";
	if (option)
		return spec_error_set(error, SPEC_EUSAGE,
			"%s is for curves, '%s' is an image", option, job->input[0]);
	if (job->change.has_interpolation && !job->change.grid_text)
		return spec_error_set(
			error, SPEC_EUSAGE, "of an image, --interp is for --grid");
	if (job->change.has_to && job->change.to.kind == SPEC_SPECTRUM_SAMPLED &&
		job->change.to.count > 0)
		return spec_error_set(error, SPEC_EUSAGE,
			"of an image, --to sampled has the image's own bands; --grid changes "
			"them");
	return SPEC_OK;
}

static enum spec_status
convert_bands(const struct cli *cli, struct job *job, struct spec_reader *reader,
	struct spec_error *error)
{
	struct spec_convert convert = {0};
	enum spec_status status =
		spec_own_settle(job->change.operation, job->change.setup.operations,
			spec_reader_image(reader), spec_reader_name(reader), error);

	if (status == SPEC_OK)
		status = spec_convert_plan(&convert, spec_reader_image(reader),
			&job->change.setup, spec_reader_name(reader), error);

	if (status == SPEC_OK)
		status = spec_settings_record(&job->settings, &convert.image, error);
	if (status == SPEC_OK)
		status = spec_convert_run(
			&convert, reader, &job->settings, &job->overflows, error);
	if (status == SPEC_OK && !job->settings.quiet)
		warn(cli, job, &convert);
	spec_convert_free(&convert);
	return status;
}

static enum spec_status
convert_image(const struct cli *cli, struct job *job, struct spec_error *error)
{
	struct spec_reader *reader = NULL;
	enum spec_status status = check_image_options(job, error);

	if (status == SPEC_OK)
		status = settle_kind(job, SPEC_KIND_IMAGE, error);
	if (status == SPEC_OK)
		status = check_storage(job, error);
	if (status == SPEC_OK && job->inputs > 1)
		status = spec_reader_open_list(
			&reader, job->input, job->inputs, &job->settings, error);
	else if (status == SPEC_OK)
		status = spec_reader_open(&reader, job->input[0], &job->settings, error);
	if (status == SPEC_OK)
		status = spec_placed_check(
			&job->placed, spec_kind_is_text(job->kind), &job->settings, error);
	if (status == SPEC_OK)
		status = spec_placed_apply(&job->placed, spec_reader_header(reader), error);
	if (status == SPEC_OK && (job->projects || job->vectors))
		status = convert_layout(job, reader, error);
	else if (status == SPEC_OK && spec_kind_is_text(job->kind))
		status = image_to_text(job, reader, error);
	else if (status == SPEC_OK && job->from.from_rgb)
		status = convert_colours(job, reader, error);
	else if (status == SPEC_OK && leaves_bands(job))
		status = convert_representation(job, reader, error);
	else if (status == SPEC_OK)
		status = convert_bands(cli, job, reader, error);
	spec_reader_close(reader);
	return status;
}

static void
free_job(struct job *job)
{
	spec_convert_options_free(&job->change);
	free((void *)job->input);
}

int
main(int argc, char **argv)
{
	struct job job = {0};
	struct spec_error error = {0};
	struct cli_progress progress;
	enum spec_status status;
	struct cli cli;

	tool_start(&cli, &program, argc, argv);
	parse(&cli, &job, &error);
	tool_begin(&progress, &job.settings, argc, argv);

	status = spec_curve_input_is_image(&job.from) || spec_kind_is_curve(job.input[0])
			 ? convert_curves(&cli, &job, &error)
			 : convert_image(&cli, &job, &error);
	cli_progress_end(&progress);
	cli_check(&cli, status, &error);
	if (!job.settings.quiet && job.clamped > 0)
		cli_warn(&cli, "%llu pixels had a component outside %s, which was clamped",
			job.clamped,
			job.from.colours.use == SPEC_UPSAMPLING_ALBEDO
				? "[0, 1]"
				: "the range from 0 on");
	if (!job.settings.quiet)
		cli_warn_overflows(&cli, job.settings.output, job.overflows);
	free_job(&job);
	return 0;
}
