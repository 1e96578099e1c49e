/* specinfo - what is in spectral images and curves; see specinfo(1). */
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include "all/tool.h"
#include "base/json.h"
#include "base/memory.h"
#include "base/output.h"
#include "base/source.h"
#include "base/text.h"
#include "colour/appearance.h"
#include "image/describe.h"
#include "image/kind.h"
#include "image/lint.h"
#include "image/plot.h"
#include "image/probe.h"
#include "image/regions.h"
#include "image/value.h"
#include "place/almanac.h"
#include "place/placed.h"
#include "spectrum/lookup.h"
#include "spectrum/spd.h"
#include "spectrum/summary.h"

#define EXIT_FINDINGS 1
#define EXIT_TROUBLE 2

static const struct cli_option options[] = {
	{0, "json", NULL, "print JSON: an object, or an array of them for several files"},
	{'s', "statistics", NULL,
		"min, max, mean, standard deviation, counts of NaN, of "
		"infinities and of negative values; reads all pixels"},
	{'b', "bands", NULL, "the same for each band, too"},
	{'p', "probe", "X,Y",
		"print the spectrum of this pixel and its colour in place of "
		"all that; may be given several times"},
	{0, "patches", "FILE|COLUMNSxROWS",
		"the same of means over rectangles: lines NAME X0 Y0 X1 Y1, "
		"or a chart's columns and rows, such as 6x4"},
	{0, "observer", "1931|1964|2015-2|2015-10|SPD", "who sees colours (default: 1931)"},
	{0, "illuminant", "SPD",
		"the light on reflectance, and white (default: D65; equal "
		"energy for dominant wavelengths of light)"},
	{0, "rule", "cie|grid|astm",
		"integrate by 1 nm, over the spectrum's own wavelengths, or by "
		"the weights of ASTM E308 for reflectance (default: cie)"},
	{0, "plot", "FILE",
		"draw the curves, or what --probe and --patches measure, and "
		"their places in the chromaticity diagram: .png, .svg, .pdf"},
	{0, "sun", "PLACE|own",
		"tell where the sun is and when it rises and sets at this "
		"place and --time, or where and when each FILE was taken"},
	{0, "time", "TIME", "ISO 8601 with an offset, or now"},
	{0, "toward", "PLACE", "add bearing and distance of another place"},
	{0, "air", "HPA,CELSIUS", "what bends the light (default: the standard's)"},
	{'c', "check", NULL,
		"list what is wrong with images, a line for each finding; "
		"reads all pixels"},
	{0},
};

static const struct cli_program program = {
	.name = "specinfo",
	.arguments = "[OPTION]... [FILE|SPD]...",
	.summary =
		"Tell what is in spectral images and in curves, or what is wrong with images. Exit "
		"status: 0 done, 1 --check has found errors or warnings, 2 trouble.",
	.options = options,
};

struct job {
	const struct cli *cli;
	const char **input;
	size_t inputs, input_room;
	int json, statistics, bands, check;
	struct spec_probe *probe;
	size_t probes, probe_room;
	const char *patches, *observer, *illuminant, *plotted;
	struct spec_plot plot;
	struct spec_almanac_request almanac;
	struct spec_regions regions;
	struct spec_viewing viewing; /* once it is needed */
	enum spec_rule rule;
	int rule_told, seeing;
	struct spec_settings settings;
	struct cli_progress progress;
	struct spec_text text;
	struct spec_json writer;
	size_t told;     /* files that the text tells of */
	size_t findings; /* errors and warnings */
};

static enum spec_status
take_probe(struct job *job, const char *text, struct spec_error *error)
{
	void *list = job->probe;
	enum spec_status status = spec_memory_grow(&list, &job->probe_room, job->probes + 1,
		sizeof *job->probe, "pixels", error);

	job->probe = list;
	if (status == SPEC_OK)
		status = spec_probe_parse(text, &job->probe[job->probes], error);
	if (status == SPEC_OK)
		job->probes++;
	return status;
}

static enum spec_status
take_rule(struct job *job, const char *value, struct spec_error *error)
{
	job->rule_told = 1;
	return spec_rule_find(value, &job->rule, error);
}

static enum spec_status
take_option(struct job *job, const char *name, const char *value, struct spec_error *error)
{
	int known;
	enum spec_status status =
		spec_almanac_take(&job->almanac, name, value, &known, error);

	if (known)
		return status;
	if (strcmp(name, "json") == 0)
		job->json = 1;
	else if (strcmp(name, "statistics") == 0)
		job->statistics = 1;
	else if (strcmp(name, "bands") == 0)
		job->statistics = job->bands = 1;
	else if (strcmp(name, "check") == 0)
		job->check = 1;
	else if (strcmp(name, "probe") == 0)
		return take_probe(job, value, error);
	else if (strcmp(name, "patches") == 0)
		job->patches = value;
	else if (strcmp(name, "plot") == 0)
		job->plotted = value;
	else if (strcmp(name, "observer") == 0)
		job->observer = value;
	else if (strcmp(name, "illuminant") == 0)
		job->illuminant = value;
	else if (strcmp(name, "rule") == 0)
		return take_rule(job, value, error);
	else
		return spec_settings_take(&job->settings, name, value, &known, error);
	return SPEC_OK;
}

static enum spec_status
take_input(struct job *job, const char *path, struct spec_error *error)
{
	void *list = (void *)job->input;
	enum spec_status status = spec_memory_grow(&list, &job->input_room, job->inputs + 1,
		sizeof *job->input, "operands", error);

	job->input = list;
	if (status != SPEC_OK)
		return status;
	for (size_t i = 0; i < job->inputs; i++) {
		if (strcmp(path, "-") == 0 && strcmp(job->input[i], "-") == 0)
			return spec_error_set(error, SPEC_EUSAGE,
				"only one of the files can come from standard input");
	}
	job->input[job->inputs++] = path;
	return SPEC_OK;
}

/* Loads who sees and by what light, the first time. */
static enum spec_status
see(struct job *job, struct spec_error *error)
{
	enum spec_status status = SPEC_OK;

	if (!job->seeing)
		status = spec_viewing_load(
			job->observer, job->illuminant, &job->viewing, error);
	job->viewing.rule = job->rule;
	job->viewing.rule_told = job->rule_told;
	job->seeing = status == SPEC_OK;
	return status;
}

static void
parse(struct cli *cli, struct job *job, struct spec_error *error)
{
	spec_settings_init(&job->settings);
	while (cli_next(cli)) {
		if (cli->name)
			cli_check(
				cli, take_option(job, cli->name, cli->value, error), error);
		else
			cli_check(cli, take_input(job, cli->value, error), error);
	}
	if (job->check + job->statistics + (job->probes > 0) + (job->patches != NULL) +
			job->almanac.asked >
		1)
		cli_usage(cli,
			"--check, --probe, --patches, --sun and --statistics (or --bands) exclude "
			"each other");
	cli_check(cli, spec_almanac_settle(&job->almanac, job->inputs, error), error);
	if (job->patches)
		cli_check(
			cli, spec_regions_parse(job->patches, &job->regions, error), error);
	if (job->plotted && (job->check || job->statistics || job->almanac.asked))
		cli_usage(cli,
			"--plot draws nothing of --check, --sun, --statistics and --bands");
	if (job->plotted)
		cli_check(cli, spec_plot_open(job->plotted, &job->plot, error), error);
	if (job->observer || job->illuminant || job->plotted)
		cli_check(cli, see(job, error), error);
	if (job->inputs == 0)
		cli_check(cli, take_input(job, "-", error), error);
}

static void
separate(struct job *job)
{
	if (!job->json && job->told > 0)
		fputc('\n', job->text.stream);
	job->told++;
}

static int
is_seen(const struct spec_curve *curve)
{
	return spec_seen_of(curve->quantity, curve->unit) != SPEC_SEEN_NOTHING;
}

/* Called as the curve is, and where there are several columns as they are. */
static enum spec_status
plot_column(struct job *job, const char *name, const struct spec_curve *curve,
	size_t column, const struct spec_appearance *appearance, struct spec_error *error)
{
	struct spec_text text = {0};
	enum spec_status status = spec_text_open(&text, error);

	if (status != SPEC_OK)
		return status;
	fputs(name, text.stream);
	if (curve->columns > 1)
		fprintf(text.stream, " %s", curve->column[column]);
	fputc('\0', text.stream);
	status = spec_text_close(&text, error);
	if (status == SPEC_OK)
		status = spec_plot_add_curve(
			&job->plot, text.bytes, curve, column, appearance, error);
	spec_text_free(&text);
	return status;
}

/* The columns' colours, for the caller to free; null where there is an error. */
static enum spec_status
find_colours(struct job *job, const char *name, const struct spec_curve *curve,
	struct spec_appearance **result, struct spec_error *error)
{
	struct spec_appearance *appearance =
		spec_memory_new(curve->columns, sizeof *appearance, "columns", error);
	enum spec_status status = appearance ? SPEC_OK : SPEC_ENOMEM;

	if (status == SPEC_OK && is_seen(curve))
		status = see(job, error);
	for (size_t i = 0; i < curve->columns && status == SPEC_OK; i++) {
		spec_appearance_clear(&appearance[i]);
		if (is_seen(curve))
			status = spec_appearance_of_curve(
				&job->viewing, curve, i, &appearance[i], error);
		if (status == SPEC_OK && job->plotted)
			status = plot_column(job, name, curve, i, &appearance[i], error);
	}
	if (status != SPEC_OK) {
		free(appearance);
		appearance = NULL;
	}
	*result = appearance;
	return status;
}

/* A curve's own where it has one column. */
static void
tell_colours(struct job *job, const struct spec_curve *curve,
	const struct spec_appearance *appearance)
{
	int several = curve->columns > 1;

	if (job->json && several)
		spec_json_open(&job->writer, "colours", '[', SPEC_JSON_LINES);
	for (size_t i = 0; i < curve->columns; i++) {
		if (!job->json) {
			if (is_seen(curve) && several)
				fprintf(job->text.stream, "  %-13s %s\n", "colour of",
					curve->column[i]);
			spec_appearance_print(job->text.stream, "  ", &appearance[i]);
			continue;
		}
		if (several)
			spec_json_open(&job->writer, NULL, '{', SPEC_JSON_INLINE);
		spec_appearance_json(&job->writer, &appearance[i]);
		if (several)
			spec_json_close(&job->writer);
	}
	if (job->json && several)
		spec_json_close(&job->writer);
}

static enum spec_status
tell_curve(struct job *job, const char *path, struct spec_error *error)
{
	struct spec_curve curve;
	struct spec_appearance *appearance = NULL;
	int standard = strcmp(path, "-") == 0;
	const char *name = standard ? "<stdin>" : path;
	enum spec_status status = standard ? spec_spd_read(stdin, name, &curve, error)
					   : spec_lookup_curve(path, &curve, error);

	if (status == SPEC_OK) {
		status = find_colours(job, name, &curve, &appearance, error);
		if (status != SPEC_OK && status != SPEC_ENOMEM)
			spec_error_prefix(error, "%s", name);
	}
	if (status == SPEC_OK) {
		separate(job);
		if (job->json)
			spec_summary_json_open(&job->writer, name, &curve);
		else
			spec_summary_print(job->text.stream, name, &curve);
		tell_colours(job, &curve, appearance);
		if (job->json)
			spec_json_close(&job->writer);
	}
	free(appearance);
	spec_curve_free(&curve);
	return status;
}

/* Statistics of all channels, or, where none are wanted, the pipe's rest. */
static enum spec_status
read_pixels(struct job *job, struct spec_reader *reader,
	struct spec_statistics **statistics, struct spec_error *error)
{
	size_t channels = spec_reader_image(reader)->channels;
	unsigned char *wanted;
	enum spec_status status = SPEC_ENOMEM;

	if (!job->statistics)
		return spec_reader_drain(reader, error);
	wanted = spec_memory_new(channels, 1, "channels", error);
	*statistics = spec_memory_new(channels, sizeof **statistics, "channels", error);
	if (wanted && *statistics) {
		memset(wanted, 1, channels);
		status = spec_statistics_run(
			*statistics, reader, wanted, &job->settings, error);
	}
	free(wanted);
	return status;
}

static enum spec_status
tell_image(struct job *job, const char *path, struct spec_error *error)
{
	struct spec_describe_setup setup = {.bands = job->bands};
	struct spec_describe describe = {0};
	struct spec_statistics *statistics = NULL;
	struct spec_reader *reader = NULL;
	enum spec_status status = spec_reader_open(&reader, path, &job->settings, error);

	if (status == SPEC_OK)
		status = read_pixels(job, reader, &statistics, error);
	setup.statistics = statistics;
	if (status == SPEC_OK) {
		setup.format = spec_reader_format(reader);
		setup.representation = spec_reader_representation(reader);
	}
	if (status == SPEC_OK)
		status = spec_describe_find(&describe, reader, &setup, error);
	if (status == SPEC_OK) {
		separate(job);
		if (job->json)
			spec_describe_json(&job->writer, &describe);
		else
			spec_describe_print(job->text.stream, &describe);
		if (!job->json)
			spec_placed_print(job->text.stream, spec_reader_image(reader));
	}
	spec_describe_free(&describe);
	free(statistics);
	spec_reader_close(reader);
	return status;
}

static void
put_findings(struct spec_json *json, const char *name, const struct spec_lint *lint)
{
	spec_json_open(json, NULL, '{', SPEC_JSON_LINES);
	spec_json_text(json, "file", name);
	spec_json_whole(json, "errors", (long long)lint->count[SPEC_LINT_ERROR]);
	spec_json_whole(json, "warnings", (long long)lint->count[SPEC_LINT_WARNING]);
	spec_json_whole(json, "notes", (long long)lint->count[SPEC_LINT_NOTE]);
	spec_json_open(json, "findings", '[', SPEC_JSON_LINES);
	for (size_t i = 0; i < lint->findings; i++) {
		const struct spec_lint_finding *finding = &lint->finding[i];

		spec_json_open(json, NULL, '{', SPEC_JSON_INLINE);
		spec_json_text(json, "severity", spec_lint_severity(finding->severity));
		spec_json_text(json, "place", finding->place);
		spec_json_text(json, "text", finding->text);
		spec_json_close(json);
	}
	spec_json_close(json);
	spec_json_close(json);
}

static enum spec_status
check_image(struct job *job, const char *path, struct spec_error *error)
{
	const char *name = strcmp(path, "-") == 0 ? "<stdin>" : path;
	struct spec_lint lint;
	enum spec_status status = spec_lint_file(&lint, path, &job->settings, error);

	if (status != SPEC_OK)
		return status;
	job->told++;
	if (job->json)
		put_findings(&job->writer, name, &lint);
	for (size_t i = 0; i < lint.findings && !job->json; i++) {
		const struct spec_lint_finding *finding = &lint.finding[i];

		spec_value_print_text(job->text.stream, name, strlen(name));
		fprintf(job->text.stream, ": %s: %s: %s\n",
			spec_lint_severity(finding->severity), finding->place,
			finding->text);
	}
	job->findings += lint.count[SPEC_LINT_ERROR] + lint.count[SPEC_LINT_WARNING];
	spec_lint_free(&lint);
	return SPEC_OK;
}

/* Pixels, or means over rectangles. */
static enum spec_status
probe_image(struct job *job, const char *path, struct spec_error *error)
{
	struct spec_reader *reader;
	struct spec_probe *probe = job->probe;
	size_t probes = job->probes;
	enum spec_status status = spec_reader_open(&reader, path, &job->settings, error);

	if (status == SPEC_OK && job->patches) {
		status = spec_regions_read(&job->regions, reader, &job->settings, error);
		probe = job->regions.probe;
		probes = job->regions.probes;
	} else if (status == SPEC_OK) {
		status = spec_probe_read(probe, probes, reader, error);
	}
	if (status == SPEC_OK)
		status = see(job, error);
	if (status == SPEC_OK)
		status = spec_probe_see(probe, probes, reader, &job->viewing, error);
	if (status == SPEC_OK && job->plotted)
		status = spec_plot_add_probes(&job->plot, probe, probes, reader, error);
	if (status == SPEC_OK) {
		separate(job);
		status = job->json ? spec_probe_json(
					     &job->writer, reader, probe, probes, error)
				   : spec_probe_print(job->text.stream, reader, probe,
					     probes, error);
	}
	spec_reader_close(reader);
	return status;
}

static enum spec_status
tell_sun(struct job *job, const char *path, struct spec_error *error)
{
	const char *name = strcmp(path, "-") == 0 ? "<stdin>" : path;
	struct spec_almanac almanac;
	enum spec_status status =
		spec_almanac_find(&almanac, &job->almanac, path, &job->settings, error);

	if (status != SPEC_OK)
		return status;
	separate(job);
	name = job->almanac.own ? name : NULL;
	if (job->json)
		spec_almanac_json(&job->writer, name, &almanac);
	else
		spec_almanac_print(job->text.stream, name, &almanac);
	return SPEC_OK;
}

/* A name that nothing has is not called a curve. */
static enum spec_status
refuse_curve(const char *path, const char *option, struct spec_error *error)
{
	struct spec_curve curve = {0};
	enum spec_status status = SPEC_OK;

	if (strcmp(path, "-") != 0)
		status = spec_lookup_curve(path, &curve, error);
	spec_curve_free(&curve);
	return status != SPEC_OK
		       ? status
		       : spec_error_set(error, SPEC_EUSAGE,
				 "'%s' is a curve, and %s is for images", path, option);
}

static enum spec_status
tell(struct job *job, const char *path, struct spec_error *error)
{
	int curve;

	if (job->almanac.asked && !job->almanac.own)
		return tell_sun(job, path, error);
	curve = spec_kind_is_curve(path);
	if (curve && job->almanac.own)
		return refuse_curve(path, "--sun own", error);
	if (curve && (job->check || job->probes > 0 || job->patches))
		return refuse_curve(path,
			job->check     ? "--check"
			: job->patches ? "--patches"
				       : "--probe",
			error);
	if (job->almanac.own)
		return tell_sun(job, path, error);
	if (job->check)
		return check_image(job, path, error);
	if (job->probes > 0 || job->patches)
		return probe_image(job, path, error);
	if (!curve && job->plotted)
		return spec_error_set(error, SPEC_EUSAGE,
			"'%s' is an image, of which --plot draws what --probe or "
			"--patches measure",
			path);
	return curve ? tell_curve(job, path, error) : tell_image(job, path, error);
}

/* Trouble with a file is told, and the others follow; without memory nothing does. */
static int
tell_all(struct job *job, struct spec_error *error)
{
	int trouble = 0;

	for (size_t i = 0; i < job->inputs; i++) {
		enum spec_status status;

		cli_progress_start(&job->progress, "lines", job->settings.progress,
			job->settings.quiet);
		status = tell(job, job->input[i], error);
		cli_progress_end(&job->progress);
		if (status == SPEC_ENOMEM)
			cli_die(job->cli, error);
		if (status != SPEC_OK) {
			fprintf(stderr, "%s: %s\n", program.name, error->message);
			trouble = 1;
		}
	}
	if (trouble)
		return EXIT_TROUBLE;
	return job->findings > 0 ? EXIT_FINDINGS : 0;
}

int
main(int argc, char **argv)
{
	struct spec_error error = {0};
	struct cli cli;
	struct job job = {.cli = &cli};
	int code;

	tool_start(&cli, &program, argc, argv);
	parse(&cli, &job, &error);
	job.settings.show = cli_progress_show;
	job.settings.show_state = &job.progress;
	cli_check(&cli, spec_text_open(&job.text, &error), &error);
	spec_json_start(&job.writer, job.text.stream);
	if (job.json && job.inputs > 1)
		spec_json_open(&job.writer, NULL, '[', SPEC_JSON_LINES);
	code = tell_all(&job, &error);
	if (job.json && job.inputs > 1)
		spec_json_close(&job.writer);
	cli_check(&cli, spec_text_close(&job.text, &error), &error);
	if (job.plotted && code != EXIT_TROUBLE)
		cli_check(&cli,
			spec_plot_save(&job.plot, job.plotted, &job.viewing, &error),
			&error);
	/* A file that is named appears only when it is complete. */
	if (job.told > 0 && (code != EXIT_TROUBLE || strcmp(job.settings.output, "-") == 0))
		cli_check(&cli,
			spec_output_save(
				job.settings.output, job.text.bytes, job.text.size, &error),
			&error);
	spec_text_free(&job.text);
	spec_probe_free(job.probe, job.probes);
	free(job.probe);
	spec_regions_free(&job.regions);
	spec_viewing_free(&job.viewing);
	spec_plot_free(&job.plot);
	free((void *)job.input);
	return code;
}
