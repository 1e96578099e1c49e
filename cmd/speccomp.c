/* speccomp - combine several spectral images into one; see speccomp(1). */
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "all/tool.h"
#include "base/memory.h"
#include "base/number.h"
#include "compare/arithmetic.h"

static const struct cli_option options[] = {
	{0, "op", "NAME",
		"add subtract multiply divide min max mean over lerp: "
		"what is done with the images, band by band"},
	{0, "merge", NULL,
		"merge renders of one scene: the mean, weighted by their "
		"samples per pixel"},
	{'e', "expr", "EXPRESSION",
		"this instead, such as 'a - b': a is the first image's value in the band, b the "
		"second's"},
	{'m', "mask", "CHANNEL|FILE",
		"of lerp: where it is 1 the second image shows; "
		"CHANNEL, CHANNEL=N, FILE, FILE:CHANNEL, FILE:CHANNEL=N"},
	{0, "alpha", "CHANNEL", "of over (default: A)"},
	{'w', "weight", "W,W,...", "of mean and --merge: a number for each image"},
	{0, "kind", "S0|T", "of --expr: light or reflectance (default: as the first)"},
	{0},
};

static const struct cli_program program = {
	.name = "speccomp",
	.arguments = "[OPTION]... FILE...",
	.summary = "Combine several spectral images into one.",
	.options = options,
	.writes_images = 1,
};

struct job {
	const char *input[SPEC_ARITHMETIC_MOST];
	size_t inputs;
	const char *mask_text;
	struct spec_matte mask;
	double weight[SPEC_ARITHMETIC_MOST];
	size_t weights;
	int chosen; /* of --op, --merge and --expr */
	struct spec_arithmetic_setup setup;
	struct spec_reader *reader[SPEC_ARITHMETIC_MOST + 1];
	struct spec_match image[SPEC_ARITHMETIC_MOST + 1];
	size_t images;
	unsigned long long overflows;
	struct spec_settings settings;
};

static enum spec_status
take_weights(struct job *job, const char *text, struct spec_error *error)
{
	enum spec_status status = SPEC_OK;

	for (job->weights = 0; status == SPEC_OK; text++) {
		size_t length = strcspn(text, ",");
		char *number;

		if (job->weights == SPEC_ARITHMETIC_MOST)
			return spec_error_set(error, SPEC_EUSAGE, "more than %d weights",
				SPEC_ARITHMETIC_MOST);
		number = spec_memory_text(text, length, error);
		if (!number)
			return SPEC_ENOMEM;
		status = spec_number_parse(number, 1e-30, 1e30, "a weight",
			&job->weight[job->weights++], error);
		free(number);
		text += length;
		if (*text == '\0')
			break;
	}
	return status;
}

static enum spec_status
take_kind(struct job *job, const char *value, struct spec_error *error)
{
	if (strcmp(value, "S0") == 0)
		job->setup.kind = SPEC_ROLE_EMISSIVE;
	else if (strcmp(value, "T") == 0)
		job->setup.kind = SPEC_ROLE_REFLECTIVE;
	else
		return spec_error_set(error, SPEC_EUSAGE, "'%s' is not S0 or T", value);
	return SPEC_OK;
}

static enum spec_status
choose(struct job *job, enum spec_arithmetic_operation operation, struct spec_error *error)
{
	job->setup.operation = operation;
	if (job->chosen++ > 0)
		return spec_error_set(
			error, SPEC_EUSAGE, "one of --op, --merge and --expr at a time");
	return SPEC_OK;
}

static enum spec_status
take_option(struct job *job, const char *name, const char *value, struct spec_error *error)
{
	enum spec_arithmetic_operation operation;
	enum spec_status status;
	int known;

	if (strcmp(name, "op") == 0) {
		status = spec_arithmetic_find(value, &operation, error);
		return status == SPEC_OK ? choose(job, operation, error) : status;
	}
	if (strcmp(name, "merge") == 0)
		return choose(job, SPEC_ARITHMETIC_MERGE, error);
	if (strcmp(name, "expr") == 0) {
		job->setup.expression = value;
		return choose(job, SPEC_ARITHMETIC_EXPRESSION, error);
	}
	if (strcmp(name, "weight") == 0)
		return take_weights(job, value, error);
	if (strcmp(name, "kind") == 0)
		return take_kind(job, value, error);
	if (strcmp(name, "alpha") == 0) {
		job->setup.alpha = value;
		return SPEC_OK;
	}
	if (strcmp(name, "mask") != 0)
		return spec_settings_take(&job->settings, name, value, &known, error);
	job->mask_text = value;
	return SPEC_OK;
}

static void
check_options(const struct cli *cli, const struct job *job)
{
	enum spec_arithmetic_operation operation = job->setup.operation;
	size_t from_stdin = 0;

	if (job->chosen == 0)
		cli_usage(cli, "one of --op, --merge and --expr is needed (try --help)");
	if (job->inputs == 0)
		cli_usage(cli, "images are needed (try --help)");
	if ((job->mask_text != NULL) != (operation == SPEC_ARITHMETIC_LERP))
		cli_usage(cli, job->mask_text ? "--mask is for --op lerp"
					      : "--op lerp needs a --mask");
	if (job->setup.alpha && operation != SPEC_ARITHMETIC_OVER)
		cli_usage(cli, "--alpha is for --op over");
	if (job->weights > 0 && operation != SPEC_ARITHMETIC_MEAN &&
		operation != SPEC_ARITHMETIC_MERGE)
		cli_usage(cli, "--weight is for --op mean and --merge");
	if (job->weights > 0 && job->weights != job->inputs)
		cli_usage(cli, "%zu weights for %zu images", job->weights, job->inputs);
	if (job->setup.kind != SPEC_ROLE_OTHER && operation != SPEC_ARITHMETIC_EXPRESSION)
		cli_usage(cli, "--kind is for --expr");
	for (size_t i = 0; i < job->inputs; i++)
		from_stdin += strcmp(job->input[i], "-") == 0;
	if (from_stdin > 1)
		cli_usage(cli, "only one of the images can come from standard input");
}

static void
parse(struct cli *cli, struct job *job, struct spec_error *error)
{
	spec_settings_init(&job->settings);
	while (cli_next(cli)) {
		if (cli->name)
			cli_check(
				cli, take_option(job, cli->name, cli->value, error), error);
		else if (job->inputs == SPEC_ARITHMETIC_MOST)
			cli_usage(cli, "%d images at most: '%s' is one too many",
				SPEC_ARITHMETIC_MOST, cli->value);
		else
			job->input[job->inputs++] = cli->value;
	}
	check_options(cli, job);
	job->setup.weight = job->weights > 0 ? job->weight : NULL;
	job->setup.half = job->settings.half;
}

static enum spec_status
open_image(struct job *job, const char *path, struct spec_error *error)
{
	size_t i = job->images;
	enum spec_status status =
		spec_reader_open(&job->reader[i], path, &job->settings, error);

	if (status != SPEC_OK)
		return status;
	job->image[i].image = spec_reader_image(job->reader[i]);
	job->image[i].name = spec_reader_name(job->reader[i]);
	job->images++;
	return SPEC_OK;
}

static int
is_taken(const struct job *job)
{
	int taken = 0;

	for (size_t i = 0; i < job->inputs; i++)
		taken |= strcmp(job->input[i], "-") == 0;
	return taken;
}

static enum spec_status
open_mask(struct job *job, struct spec_error *error)
{
	enum spec_status status = spec_matte_read(
		&job->mask, job->mask_text, job->image[0].image, job->image[0].name, error);

	job->setup.mask = &job->mask;
	if (status != SPEC_OK || !job->mask.path)
		return status;
	if (strcmp(job->mask.path, "-") == 0 && is_taken(job))
		return spec_error_set(error, SPEC_EUSAGE,
			"only one of the images can come from standard input");
	status = open_image(job, job->mask.path, error);
	if (status != SPEC_OK)
		return status;
	return spec_matte_settle(&job->mask, job->image[job->images - 1].image,
		job->image[job->images - 1].name, error);
}

static enum spec_status
combine(struct job *job, struct spec_error *error)
{
	struct spec_arithmetic arithmetic = {0};
	enum spec_status status = SPEC_OK;

	for (size_t i = 0; i < job->inputs && status == SPEC_OK; i++)
		status = open_image(job, job->input[i], error);
	if (status == SPEC_OK && job->mask_text)
		status = open_mask(job, error);
	if (status == SPEC_OK)
		status = spec_arithmetic_plan(
			&arithmetic, job->image, job->images, &job->setup, error);
	if (status == SPEC_OK)
		status = spec_settings_record(&job->settings, &arithmetic.image, error);
	if (status == SPEC_OK)
		status = spec_arithmetic_run(
			&arithmetic, job->reader, &job->settings, &job->overflows, error);
	spec_arithmetic_free(&arithmetic);
	return status;
}

int
main(int argc, char **argv)
{
	static struct job job;
	struct spec_error error = {0};
	struct cli_progress progress;
	enum spec_status status;
	struct cli cli;

	job.setup.kind = SPEC_ROLE_OTHER;
	tool_start(&cli, &program, argc, argv);
	parse(&cli, &job, &error);
	tool_begin(&progress, &job.settings, argc, argv);

	status = combine(&job, &error);
	cli_progress_end(&progress);
	cli_check(&cli, status, &error);
	if (!job.settings.quiet)
		cli_warn_overflows(&cli, job.settings.output, job.overflows);
	for (size_t i = 0; i < job.images; i++)
		spec_reader_close(job.reader[i]);
	spec_matte_free(&job.mask);
	return 0;
}
