/* specdiff - how far apart two spectral images are; see specdiff(1). */
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "all/tool.h"
#include "base/number.h"
#include "base/output.h"
#include "base/text.h"
#include "colour/observer.h"
#include "compare/heatmap.h"
#include "compare/report.h"
#include "spectrum/lookup.h"

#define EXIT_DIFFERENT 1

static const struct cli_option options[] = {
	{'m', "metric", "NAME,...",
		"print these: rmse max sam sam-max psnr gfc gfc-min de2000 "
		"de2000-max (default: these nine) mae relative energy sid "
		"sid-max de76 de76-max de94 de94-max, percentiles such as "
		"de2000-p95, or all"},
	{'t', "tolerance", "NAME=VALUE",
		"differ only beyond this; may be given several times"},
	{0, "exact", NULL, "differ where any bit of a sample does"},
	{0, "same-within", "Nsigma",
		"test whether two renders differ by more than their noise; "
		"a false alarm is as rare as N sigma of a normal noise"},
	{0, "noise", "variance|differences",
		"what that takes for noise (default: the files' variances, if both have "
		"them, else the differences)"},
	{0, "bands", NULL, "print rmse, mae, max, relative and psnr of each band"},
	{0, "json", NULL, "print JSON"},
	{0, "resample", NULL, "compare different grids over their overlap"},
	{0, "crop", "X0,Y0,X1,Y1",
		"compare these pixels of the data window alone; X1, Y1 are outside"},
	{0, "mask", "CHANNEL|FILE",
		"compare where this is not 0: CHANNEL, CHANNEL=N, FILE, "
		"FILE:CHANNEL, FILE:CHANNEL=N"},
	{0, "heatmap", "FILE", "write a picture of where the images differ"},
	{0, "side-by-side", "FILE", "write both images and such a picture, in one"},
	{0, "heatmap-metric", "NAME",
		"of these pictures: rmse mae max sam gfc sid de76 de94 de2000 "
		"(default: de2000, without colours max)"},
	{0, "heatmap-max", "VALUE",
		"what the last colour of these pictures stands for (default: the largest)"},
	{0, "observer", "1931|1964|2015-2|2015-10|SPD",
		"for colour differences (default: 1931)"},
	{0, "illuminant", "SPD", "for colour differences of reflectance (default: D65)"},
	{'e', "exposure", "EV",
		"for colour differences of light: 2^-EV is white (default: 0)"},
	{0, "peak", "VALUE", "of psnr (default: the largest magnitude in the first)"},
	{0},
};

static const struct cli_program program = {
	.name = "specdiff",
	.arguments = "[OPTION]... FILE1 FILE2",
	.summary =
		"Tell how far apart two spectral images are. Exit status: 0 the same (or within "
		"the tolerances), 1 different, 2 trouble.",
	.options = options,
};

struct job {
	const char *input[2];
	int inputs;
	struct spec_report report;
	int any_chosen, json;
	const char *observer, *illuminant, *mask_text;
	struct spec_matte mask;
	struct spec_reader *mask_reader;
	struct spec_window crop;
	const char *heatmap_path, *side_path;
	struct spec_heatmap heatmap;
	int has_map; /* heatmap.map was chosen */
	struct spec_images_setup setup;
	struct spec_settings settings;
};

/* The metric of that name in the report's list, where percentiles come as they are named. */
static enum spec_status
find_metric(struct job *job, const char *name, size_t length,
	struct spec_report_metric **found, struct spec_error *error)
{
	struct spec_report *report = &job->report;
	struct spec_metric metric;
	enum spec_status status = spec_metric_find(name, length, &metric, error);

	if (status != SPEC_OK)
		return status;
	for (size_t i = 0; i < report->metrics; i++) {
		*found = &report->metric[i];
		if (strcmp((*found)->metric.name, metric.name) == 0)
			return SPEC_OK;
	}
	if (report->metrics == SPEC_REPORT_MOST_METRICS)
		return spec_error_set(error, SPEC_EUSAGE, "more than %d metrics",
			SPEC_REPORT_MOST_METRICS);
	*found = &report->metric[report->metrics++];
	(*found)->metric = metric;
	return SPEC_OK;
}

static enum spec_status
take_metrics(struct job *job, const char *text, struct spec_error *error)
{
	enum spec_status status = SPEC_OK;
	struct spec_report_metric *metric;

	job->any_chosen = 1;
	while (status == SPEC_OK) {
		size_t length = strcspn(text, ",");

		if (length == 3 && strncmp(text, "all", 3) == 0) {
			for (size_t i = 0; i < SPEC_METRICS_NAMED; i++)
				job->report.metric[i].shown = 1;
		} else {
			status = find_metric(job, text, length, &metric, error);
			if (status == SPEC_OK)
				metric->shown = 1;
		}
		if (text[length] == '\0')
			break;
		text += length + 1;
	}
	return status;
}

static enum spec_status
take_tolerance(struct job *job, const char *text, struct spec_error *error)
{
	struct spec_report_metric *metric;
	size_t length = strcspn(text, "=");
	enum spec_status status = find_metric(job, text, length, &metric, error);

	if (status != SPEC_OK)
		return status;
	if (text[length] == '\0')
		return spec_error_set(error, SPEC_EUSAGE, "'%s' is not NAME=VALUE", text);
	metric->judged = 1;
	return spec_number_parse(
		text + length + 1, 0, 1e300, "the tolerance", &metric->tolerance, error);
}

static enum spec_status
take_image(struct job *job, const char *path, struct spec_error *error)
{
	if (job->inputs == 2)
		return spec_error_set(error, SPEC_EUSAGE,
			"two images at a time: '%s' is one too many", path);
	job->input[job->inputs++] = path;
	return SPEC_OK;
}

/* "3sigma", or "3". */
static enum spec_status
take_sigma(struct job *job, const char *text, struct spec_error *error)
{
	size_t length = strcspn(text, "s");
	char number[32] = "";
	enum spec_status status;

	if (text[length] && strcmp(text + length, "sigma") != 0)
		return spec_error_set(error, SPEC_EUSAGE, "'%s' is not Nsigma", text);
	snprintf(number, sizeof number, "%.*s", (int)length, text);
	status = spec_number_parse(
		number, 0.1, 10, "the number of sigmas", &job->setup.sigma, error);
	job->report.sigma = job->setup.sigma;
	return status;
}

static enum spec_status
take_noise(struct job *job, const char *text, struct spec_error *error)
{
	if (strcmp(text, "variance") == 0)
		job->setup.noise = SPEC_IMAGES_NOISE_VARIANCE;
	else if (strcmp(text, "differences") == 0)
		job->setup.noise = SPEC_IMAGES_NOISE_DIFFERENCES;
	else
		return spec_error_set(error, SPEC_EUSAGE,
			"'%s' is neither variance nor differences", text);
	return SPEC_OK;
}

/* Options without a value. */
static int
take_flag(struct job *job, const char *name)
{
	if (strcmp(name, "exact") == 0)
		job->setup.exact = job->report.exact = 1;
	else if (strcmp(name, "bands") == 0)
		job->setup.want_bands = job->report.shows_bands = 1;
	else if (strcmp(name, "resample") == 0)
		job->setup.resample = 1;
	else if (strcmp(name, "json") == 0)
		job->json = 1;
	else
		return 0;
	return 1;
}

/* Options of pictures; *known 0: it is another. */
static enum spec_status
take_picture(struct job *job, const char *name, const char *value, int *known,
	struct spec_error *error)
{
	*known = 1;
	if (strcmp(name, "heatmap-metric") == 0) {
		job->has_map = 1;
		return spec_metric_map(value, &job->heatmap.map, error);
	}
	if (strcmp(name, "heatmap-max") == 0)
		return spec_number_parse(value, 1e-300, 1e300, "the last colour's value",
			&job->heatmap.most, error);
	if (strcmp(name, "heatmap") == 0)
		job->heatmap_path = value;
	else if (strcmp(name, "side-by-side") == 0)
		job->side_path = value;
	else
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
		return take_image(job, value, error);
	if (strcmp(name, "metric") == 0)
		return take_metrics(job, value, error);
	if (strcmp(name, "tolerance") == 0)
		return take_tolerance(job, value, error);
	if (strcmp(name, "exposure") == 0)
		return spec_number_parse(
			value, -100, 100, "the exposure", &job->setup.exposure, error);
	if (strcmp(name, "peak") == 0)
		return spec_number_parse(
			value, 1e-300, 1e300, "the peak", &job->report.peak, error);
	if (strcmp(name, "same-within") == 0)
		return take_sigma(job, value, error);
	if (strcmp(name, "noise") == 0)
		return take_noise(job, value, error);
	if (strcmp(name, "crop") == 0) {
		job->setup.crop = &job->crop;
		return spec_settings_crop(value, &job->crop, error);
	}
	status = take_picture(job, name, value, &known, error);
	if (known)
		return status;
	if (strcmp(name, "observer") == 0)
		job->observer = value;
	else if (strcmp(name, "illuminant") == 0)
		job->illuminant = value;
	else if (strcmp(name, "mask") == 0)
		job->mask_text = value;
	else if (!take_flag(job, name))
		return spec_settings_take(&job->settings, name, value, &known, error);
	return SPEC_OK;
}

static void
check_outputs(struct cli *cli, const struct job *job)
{
	const char *path[] = {job->settings.output, job->heatmap_path, job->side_path};

	for (int i = 0; i < 3; i++) {
		for (int j = 0; j < i; j++) {
			if (path[i] && strcmp(path[i], path[j] ? path[j] : "") == 0)
				cli_usage(cli, "two outputs would both be written to '%s'",
					path[i]);
		}
	}
}

static void
parse(struct cli *cli, struct job *job)
{
	struct spec_report *report = &job->report;

	spec_settings_init(&job->settings);
	report->metrics = SPEC_METRICS_NAMED;
	for (size_t i = 0; i < SPEC_METRICS_NAMED; i++)
		report->metric[i].metric = spec_metrics[i];
	cli_take_each(cli, take, job);
	if (job->inputs < 2)
		cli_usage(cli, "two images are needed (try --help)");
	if (strcmp(job->input[0], "-") == 0 && strcmp(job->input[1], "-") == 0)
		cli_usage(cli, "only one of the images can come from standard input");
	if (report->exact && job->setup.resample)
		cli_usage(cli, "--exact and --resample exclude each other");
	if ((job->has_map || job->heatmap.most > 0) && !job->heatmap_path &&
		!job->side_path)
		cli_usage(cli, "%s is for --heatmap and --side-by-side",
			job->has_map ? "--heatmap-metric" : "--heatmap-max");
	if (job->setup.noise != SPEC_IMAGES_NOISE_KNOWN && !(job->setup.sigma > 0))
		cli_usage(cli, "--noise is for --same-within");
	check_outputs(cli, job);
	for (size_t i = 0; i < SPEC_METRICS_USUAL && !job->any_chosen; i++)
		report->metric[i].shown = 1;
}

/* What the pictures need; whether they need colours. */
static int
plan_pictures(struct job *job)
{
	if (!job->heatmap_path && !job->side_path)
		return 0;
	if (!job->has_map) {
		job->heatmap.map = SPEC_DETAIL_DE2000;
		job->setup.maps |= 1u << SPEC_DETAIL_MAX;
	}
	job->setup.maps |= 1u << job->heatmap.map;
	job->setup.want_seen = job->side_path != NULL;
	return job->side_path || (job->has_map && job->heatmap.map >= SPEC_DETAIL_DE76);
}

static enum spec_status
write_pictures(struct job *job, const struct spec_images *result, struct spec_error *error)
{
	enum spec_status status = SPEC_OK;

	if (!result->comparable)
		return SPEC_OK;
	if (!job->has_map && !result->coloured)
		job->heatmap.map = SPEC_DETAIL_MAX;
	memcpy(job->heatmap.white_xyz, result->white_xyz, sizeof job->heatmap.white_xyz);
	if (job->heatmap_path)
		status =
			spec_heatmap_write(job->heatmap_path, result, &job->heatmap, error);
	if (status == SPEC_OK && job->side_path)
		status = spec_heatmap_side_by_side(
			job->side_path, result, &job->heatmap, error);
	return status;
}

/* What the metrics need; whether a colour difference was asked for by name. */
static int
plan(struct job *job)
{
	int named = 0;

	for (size_t i = 0; i < job->report.metrics; i++) {
		const struct spec_report_metric *it = &job->report.metric[i];
		int asked = (it->shown && job->any_chosen) || it->judged;

		if (it->shown || it->judged)
			spec_metric_need(&it->metric, &job->setup);
		named |= asked && spec_metric_is_colour(&it->metric);
	}
	job->setup.peak = job->report.peak;
	return plan_pictures(job) || named;
}

static enum spec_status
open_mask(struct job *job, const struct spec_reader *first, struct spec_error *error)
{
	enum spec_status status = spec_matte_read(&job->mask, job->mask_text,
		spec_reader_image(first), spec_reader_name(first), error);

	job->setup.mask = &job->mask;
	if (status != SPEC_OK || !job->mask.path)
		return status;
	if (strcmp(job->mask.path, "-") == 0 &&
		(strcmp(job->input[0], "-") == 0 || strcmp(job->input[1], "-") == 0))
		return spec_error_set(error, SPEC_EUSAGE,
			"only one of the images can come from standard input");
	status = spec_reader_open(&job->mask_reader, job->mask.path, &job->settings, error);
	job->setup.mask_reader = job->mask_reader;
	if (status != SPEC_OK)
		return status;
	return spec_matte_settle(&job->mask, spec_reader_image(job->mask_reader),
		spec_reader_name(job->mask_reader), error);
}

/* Whether a picture is compared with what another image shows. */
static int
shows(struct spec_reader *const *reader)
{
	return (spec_reader_image(reader[0])->bands > 0) !=
	       (spec_reader_image(reader[1])->bands > 0);
}

static enum spec_status
compare(struct job *job, struct spec_reader *reader[2], struct spec_images *result,
	struct spec_error *error)
{
	struct spec_curve observer = {0}, illuminant = {0};
	enum spec_status status = SPEC_OK;
	int named = plan(job);

	job->setup.colour_optional = !named;
	if (job->mask_text)
		status = open_mask(job, reader[0], error);
	if (status == SPEC_OK &&
		(named || !job->any_chosen || job->heatmap_path || shows(reader))) {
		status = spec_observer_load(job->observer, &observer, error);
		if (status == SPEC_OK && !spec_observer_is_xyz(&observer))
			status = spec_error_set(error, SPEC_EUSAGE,
				"observer '%.200s' has columns %.40s, %.40s, %.40s: "
				"colour differences need x, y, z",
				job->observer, observer.column[0], observer.column[1],
				observer.column[2]);
		if (status == SPEC_OK)
			status = spec_lookup_light(job->illuminant, &illuminant, error);
		job->setup.observer = &observer;
		job->setup.illuminant = &illuminant;
	}
	if (status == SPEC_OK)
		status = spec_images_compare(
			result, reader[0], reader[1], &job->setup, &job->settings, error);
	job->setup.observer = job->setup.illuminant = NULL;
	spec_curve_free(&observer);
	spec_curve_free(&illuminant);
	return status;
}

/* The report appears whole or not at all. */
static enum spec_status
print_report(struct job *job, struct spec_reader *const *reader,
	const struct spec_images *result, struct spec_error *error)
{
	struct spec_report *report = &job->report;
	struct spec_text text;
	enum spec_status status;

	report->result = result;
	for (int i = 0; i < 2; i++) {
		report->name[i] = spec_reader_name(reader[i]);
		report->image[i] = spec_reader_image(reader[i]);
	}
	status = spec_report_judge(report, error);
	if (status == SPEC_OK)
		status = spec_text_open(&text, error);
	if (status != SPEC_OK)
		return status;
	if (job->json)
		spec_report_json(report, text.stream);
	else
		spec_report_text(report, text.stream);
	status = spec_text_close(&text, error);
	if (status == SPEC_OK)
		status = spec_output_save(
			job->settings.output, text.bytes, text.size, error);
	spec_text_free(&text);
	return status;
}

int
main(int argc, char **argv)
{
	static struct job job;
	struct spec_error error = {0};
	struct spec_reader *reader[2] = {NULL, NULL};
	struct spec_images result = {0};
	struct cli_progress progress;
	enum spec_status status;
	struct cli cli;

	job.observer = "1931";
	job.illuminant = "illuminants/D65";
	tool_start(&cli, &program, argc, argv);
	parse(&cli, &job);
	tool_begin(&progress, &job.settings, argc, argv);

	for (int i = 0; i < 2; i++)
		cli_check(&cli,
			spec_reader_open(&reader[i], job.input[i], &job.settings, &error),
			&error);
	status = compare(&job, reader, &result, &error);
	cli_progress_end(&progress);
	cli_check(&cli, status, &error);

	cli_check(&cli, write_pictures(&job, &result, &error), &error);
	cli_check(&cli, print_report(&job, reader, &result, &error), &error);
	spec_images_free(&result);
	spec_reader_close(reader[0]);
	spec_reader_close(reader[1]);
	spec_reader_close(job.mask_reader);
	spec_matte_free(&job.mask);
	return job.report.different ? EXIT_DIFFERENT : 0;
}
