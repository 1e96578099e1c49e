/* specdiff - how far apart two spectral images are; see specdiff(1). */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "base/number.h"
#include "base/output.h"
#include "base/text.h"
#include "cli/options.h"
#include "cli/progress.h"
#include "colour/observer.h"
#include "compare/images.h"
#include "spectrum/lookup.h"

#define EXIT_DIFFERENT 1

static const struct cli_option options[] = {
	{'m', "metric", "NAME,...",
		"print these: rmse max sam sam-max psnr gfc gfc-min de2000\n"
		"de2000-max (default: all)"},
	{'t', "tolerance", "NAME=VALUE",
		"differ only beyond this; may be given several times"},
	{0, "observer", "1931|1964|2015-2|2015-10|SPD", "for de2000 (default: 1931)"},
	{0, "illuminant", "SPD", "for de2000 of reflectance (default: D65)"},
	{'e', "exposure", "EV", "for de2000 of light: 2^-EV is white (default: 0)"},
	{0, "peak", "VALUE", "of psnr (default: the largest magnitude in the first)"},
	{0},
};

static const struct cli_program program = {
	.name = "specdiff",
	.arguments = "[OPTION]... FILE1 FILE2",
	.summary =
		"Tell how far apart two spectral images are. Exit status: 0 the same (or within\n"
		"the tolerances), 1 different, 2 trouble.",
	.options = options,
};

struct metric {
	const char *name, *unit;
	int larger_is_better, angular, colour;
};

static const struct metric metrics[] = {
	{"rmse", "", 0, 0, 0},
	{"max", "", 0, 0, 0},
	{"sam", " rad", 0, 1, 0},
	{"sam-max", " rad", 0, 1, 0},
	{"psnr", " dB", 1, 0, 0},
	{"gfc", "", 1, 1, 0},
	{"gfc-min", "", 1, 1, 0},
	{"de2000", "", 0, 0, 1},
	{"de2000-max", "", 0, 0, 1},
};

enum { METRICS = sizeof metrics / sizeof metrics[0] };

struct job {
	const char *input[2];
	int inputs;
	int chosen[METRICS], any_chosen;
	double tolerance[METRICS];
	int judged[METRICS], any_judged;
	const char *observer, *illuminant;
	double exposure, peak;
	struct spec_settings settings;
};

static enum spec_status
find_metric(const char *name, size_t length, size_t *index, struct spec_error *error)
{
	for (*index = 0; *index < METRICS; (*index)++) {
		if (strlen(metrics[*index].name) == length &&
			memcmp(metrics[*index].name, name, length) == 0)
			return SPEC_OK;
	}
	return spec_error_set(error, SPEC_EUSAGE, "unknown metric '%.*s' (try --help)",
		(int)(length < 64 ? length : 64), name);
}

static enum spec_status
take_metrics(struct job *job, const char *text, struct spec_error *error)
{
	enum spec_status status = SPEC_OK;
	size_t index;

	job->any_chosen = 1;
	while (status == SPEC_OK) {
		size_t length = strcspn(text, ",");

		status = find_metric(text, length, &index, error);
		if (status == SPEC_OK)
			job->chosen[index] = 1;
		if (text[length] == '\0')
			break;
		text += length + 1;
	}
	return status;
}

static enum spec_status
take_tolerance(struct job *job, const char *text, struct spec_error *error)
{
	size_t length = strcspn(text, "="), index;
	enum spec_status status = find_metric(text, length, &index, error);

	if (status != SPEC_OK)
		return status;
	if (text[length] == '\0')
		return spec_error_set(error, SPEC_EUSAGE, "'%s' is not NAME=VALUE", text);
	job->judged[index] = job->any_judged = 1;
	return spec_number_parse(text + length + 1, 0, 1e300, "the tolerance",
		&job->tolerance[index], error);
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

static enum spec_status
take(void *state, const char *name, const char *value, struct spec_error *error)
{
	struct job *job = state;
	int known;

	if (!name)
		return take_image(job, value, error);
	if (strcmp(name, "metric") == 0)
		return take_metrics(job, value, error);
	if (strcmp(name, "tolerance") == 0)
		return take_tolerance(job, value, error);
	if (strcmp(name, "exposure") == 0)
		return spec_number_parse(
			value, -100, 100, "the exposure", &job->exposure, error);
	if (strcmp(name, "peak") == 0)
		return spec_number_parse(
			value, 1e-300, 1e300, "the peak", &job->peak, error);
	if (strcmp(name, "observer") == 0)
		job->observer = value;
	else if (strcmp(name, "illuminant") == 0)
		job->illuminant = value;
	else
		return spec_settings_take(&job->settings, name, value, &known, error);
	return SPEC_OK;
}

static void
parse(struct cli *cli, struct job *job)
{
	spec_settings_init(&job->settings);
	cli_take_each(cli, take, job);
	if (job->inputs < 2)
		cli_usage(cli, "two images are needed (try --help)");
	if (strcmp(job->input[0], "-") == 0 && strcmp(job->input[1], "-") == 0)
		cli_usage(cli, "only one of the images can come from standard input");
}

/* The largest difference of whole numbers, as they are. */
static double
whole_max(const struct spec_whole *whole)
{
	return fabs((double)whole->a - (double)whole->b);
}

/* The largest difference in any channel. */
static double
max_of(const struct spec_images *result)
{
	double most = whole_max(&result->whole);

	if (result->bands > 0)
		most = fmax(most, spec_measure_max(&result->spectral));
	if (result->others.samples > 0)
		most = fmax(most, spec_measure_max(&result->others));
	return most;
}

static double
value_of(const struct spec_images *result, size_t index, double peak)
{
	const struct spec_measure *spectral = &result->spectral;

	switch (index) {
	case 0:
		return result->bands > 0 ? spec_measure_rmse(spectral) : 0;
	case 1:
		return max_of(result);
	case 2:
		return spec_measure_angle_mean(spectral);
	case 3:
		return spec_measure_angle_max(spectral);
	case 4:
		return spec_measure_psnr(spectral, peak);
	case 5:
		return spec_measure_fit_mean(spectral);
	case 6:
		return spec_measure_fit_min(spectral);
	case 7:
		return spec_measure_colour_mean(spectral);
	default:
		return spec_measure_colour_max(spectral);
	}
}

static int
applies(const struct spec_images *result, size_t index)
{
	if (metrics[index].colour)
		return result->coloured;
	return result->bands > 0 || index <= 1;
}

static void
print_name(FILE *report, const struct spec_image *image, size_t channel)
{
	char name[256];

	snprintf(name, sizeof name, "%s", image->channel[channel].name);
	spec_error_plain(name);
	fprintf(report, "'%s'", name);
}

static void
print_sample(FILE *report, const struct spec_image *image, const struct spec_measure *worst)
{
	if (worst->nonfinite > 0) {
		fprintf(report, " at %zu,%d in ", worst->nonfinite_first.x,
			worst->nonfinite_first.y);
		print_name(report, image, worst->nonfinite_first.band);
		fprintf(report, ": %.9g and %.9g, the first of %llu that are not finite",
			worst->nonfinite_a, worst->nonfinite_b,
			(unsigned long long)worst->nonfinite);
	} else if (worst->difference.value > 0) {
		fprintf(report, " at %zu,%d in ", worst->difference.place.x,
			worst->difference.place.y);
		print_name(report, image, worst->difference.place.band);
		fprintf(report, ": %.9g and %.9g", worst->difference_a,
			worst->difference_b);
	}
}

/* Where the largest difference is, and between what. */
static void
print_place(FILE *report, const struct spec_images *result, const struct spec_image *image)
{
	const struct spec_whole *whole = &result->whole;
	double most = max_of(result);

	if (whole->differing > 0 && whole_max(whole) == most) {
		fprintf(report, " at %zu,%d in ", whole->x, whole->y);
		print_name(report, image, whole->channel);
		fprintf(report, ": %u and %u", whole->a, whole->b);
	} else if (result->others.samples > 0 &&
		   spec_measure_max(&result->others) == most) {
		print_sample(report, image, &result->others);
	} else if (result->bands > 0) {
		print_sample(report, image, &result->spectral);
	}
}

static void
print_pixel(FILE *report, const struct spec_measure_extreme *extreme)
{
	if (extreme->value > 0)
		fprintf(report, " at %zu,%d", extreme->place.x, extreme->place.y);
}

static int
print_metrics(FILE *report, const struct job *job, const struct spec_images *result,
	const struct spec_image *image)
{
	/* What is not finite on one side, and another id, are beyond any tolerance. */
	int different = result->spectral.nonfinite > 0 || result->others.nonfinite > 0 ||
			result->whole.differing > 0;

	for (size_t i = 0; i < METRICS; i++) {
		double value;
		int beyond;

		if (!applies(result, i)) {
			different |=
				job->judged[i]; /* what cannot be measured is not within */
			continue;
		}
		value = value_of(result, i, job->peak);
		beyond = job->judged[i] &&
			 !(metrics[i].larger_is_better ? value >= job->tolerance[i]
						       : value <= job->tolerance[i]);
		different |= beyond;
		if (!job->any_chosen || job->chosen[i]) {
			fprintf(report, "%-10s %.6g%s", metrics[i].name, value,
				metrics[i].unit);
			if (i == 1)
				print_place(report, result, image);
			else if (i == 3)
				print_pixel(report, &result->spectral.angle_most);
			else if (i == 8)
				print_pixel(report, &result->spectral.colour_most);
			fprintf(report, beyond ? " (beyond %g)\n" : "\n",
				job->tolerance[i]);
		}
	}
	if (!job->any_judged)
		different = value_of(result, 1, 0) > 0;
	return different;
}

static enum spec_status
compare(struct job *job, struct spec_reader *reader[2], struct spec_images *result,
	struct spec_error *error)
{
	struct spec_curve observer = {0}, illuminant = {0};
	struct spec_images_setup setup = {.exposure = job->exposure, .peak = job->peak};
	enum spec_status status = SPEC_OK;
	int named = 0; /* a colour difference was asked for */

	setup.want_angle = !job->any_chosen;
	for (size_t i = 0; i < METRICS; i++) {
		int asked = job->chosen[i] || job->judged[i];

		named |= metrics[i].colour && asked;
		setup.want_angle |= metrics[i].angular && asked;
	}
	setup.colour_optional = !named;
	if (named || !job->any_chosen) {
		status = spec_observer_load(job->observer, &observer, error);
		if (status == SPEC_OK && !spec_observer_is_xyz(&observer))
			status = spec_error_set(error, SPEC_EUSAGE,
				"observer '%.200s' has columns %.40s, %.40s, %.40s: "
				"CIEDE2000 needs x, y, z",
				job->observer, observer.column[0], observer.column[1],
				observer.column[2]);
		if (status == SPEC_OK)
			status = spec_lookup_light(job->illuminant, &illuminant, error);
		setup.observer = &observer;
		setup.illuminant = &illuminant;
	}
	if (status == SPEC_OK)
		status = spec_images_compare(
			result, reader[0], reader[1], &setup, &job->settings, error);
	spec_curve_free(&observer);
	spec_curve_free(&illuminant);
	return status;
}

/* The report appears whole or not at all; *different is what it says. */
static enum spec_status
print_report(const struct job *job, const struct spec_images *result,
	const struct spec_image *image, int *different, struct spec_error *error)
{
	struct spec_text text;
	enum spec_status status = spec_text_open(&text, error);

	if (status != SPEC_OK)
		return status;
	fputs(result->structure, text.stream);
	*different = result->structure[0] != '\0';
	if (result->comparable)
		*different |= print_metrics(text.stream, job, result, image);
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
	struct job job = {.observer = "1931", .illuminant = "illuminants/D65"};
	struct spec_error error = {0};
	struct spec_reader *reader[2] = {NULL, NULL};
	struct spec_images result;
	struct cli_progress progress;
	enum spec_status status;
	int different = 0;
	struct cli cli;

	cli_start(&cli, &program, argc, argv);
	parse(&cli, &job);
	cli_progress_start(&progress, "lines", job.settings.progress, job.settings.quiet);
	job.settings.show = cli_progress_show;
	job.settings.show_state = &progress;

	for (int i = 0; i < 2; i++)
		cli_check(&cli,
			spec_reader_open(&reader[i], job.input[i], &job.settings, &error),
			&error);
	status = compare(&job, reader, &result, &error);
	cli_progress_end(&progress);
	cli_check(&cli, status, &error);

	cli_check(&cli,
		print_report(
			&job, &result, spec_reader_image(reader[0]), &different, &error),
		&error);
	spec_reader_close(reader[0]);
	spec_reader_close(reader[1]);
	return different ? EXIT_DIFFERENT : 0;
}
