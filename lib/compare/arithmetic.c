#include "compare/arithmetic.h"

#include <stdlib.h>
#include <string.h>

#include "base/memory.h"
#include "compare/planning.h"
#include "image/save.h"

#define ALIGNMENT 64 /* bytes, of a program's scratch */

static const struct spec_arithmetic_traits operations[] = {
	[SPEC_ARITHMETIC_ADD] = {"add", 2, SPEC_ARITHMETIC_MOST, 1, 1, 0, 1, 0},
	[SPEC_ARITHMETIC_SUBTRACT] = {"subtract", 2, 2, 1, 1, 0, 1, 0},
	[SPEC_ARITHMETIC_MULTIPLY] = {"multiply", 2, SPEC_ARITHMETIC_MOST, 0, 0, 0, 0, 0},
	[SPEC_ARITHMETIC_DIVIDE] = {"divide", 2, 2, 0, 0, 0, 0, 0},
	[SPEC_ARITHMETIC_MIN] = {"min", 2, SPEC_ARITHMETIC_MOST, 1, 0, 0, 0, 0},
	[SPEC_ARITHMETIC_MAX] = {"max", 2, SPEC_ARITHMETIC_MOST, 1, 0, 0, 0, 0},
	[SPEC_ARITHMETIC_MEAN] = {"mean", 2, SPEC_ARITHMETIC_MOST, 1, 1, 1, 1, 1},
	[SPEC_ARITHMETIC_OVER] = {"over", 2, SPEC_ARITHMETIC_MOST, 1, 1, 1, 0, 0},
	[SPEC_ARITHMETIC_LERP] = {"lerp", 2, 2, 1, 1, 1, 0, 0},
	[SPEC_ARITHMETIC_MERGE] = {"merge", 2, SPEC_ARITHMETIC_MOST, 1, 1, 1, 1, 1},
	[SPEC_ARITHMETIC_EXPRESSION] = {"expr", 1, SPEC_ARITHMETIC_MOST, 0, 0, 0, 0, 0},
};

enum spec_status
spec_arithmetic_find(const char *name, enum spec_arithmetic_operation *operation,
	struct spec_error *error)
{
	for (int i = 0; i < SPEC_ARITHMETIC_MERGE; i++) {
		*operation = (enum spec_arithmetic_operation)i;
		if (strcmp(operations[i].name, name) == 0)
			return SPEC_OK;
	}
	return spec_error_set(error, SPEC_EUSAGE,
		"'%s' is not add, subtract, multiply, divide, min, max, mean, over or lerp",
		name);
}

enum spec_status
spec_arithmetic_plan(struct spec_arithmetic *arithmetic, const struct spec_match *input,
	size_t images, const struct spec_arithmetic_setup *setup, struct spec_error *error)
{
	struct spec_plan plan = {.arithmetic = arithmetic,
		.input = input,
		.images = images,
		.setup = setup,
		.operation = &operations[setup->operation],
		.error = error};
	enum spec_status status = SPEC_OK;

	*arithmetic = (struct spec_arithmetic){.images = images};
	plan.operands = images - (setup->mask && setup->mask->path);
	if (plan.operands > SPEC_ARITHMETIC_MOST)
		return spec_error_set(error, SPEC_EUSAGE,
			"%d images at most can be combined, and %zu are given",
			SPEC_ARITHMETIC_MOST, plan.operands);
	for (size_t i = 0; i < images; i++) {
		plan.image[i] = input[i].image;
		plan.name[i] = input[i].name;
	}
	status = spec_plan_check(&plan);
	if (status == SPEC_OK)
		status = spec_plan_result(&plan);
	if (status == SPEC_OK)
		status = spec_plan_channels(&plan);
	spec_expression_free(&plan.expression);
	for (size_t i = 0; i < plan.operands; i++)
		spec_layers_free(&plan.layers[i]);
	if (status != SPEC_OK)
		spec_arithmetic_free(arithmetic);
	return status;
}

void
spec_arithmetic_free(struct spec_arithmetic *arithmetic)
{
	for (size_t i = 0; i < arithmetic->programs; i++)
		spec_program_free(&arithmetic->program[i]);
	for (size_t i = 0; i < arithmetic->images; i++)
		free(arithmetic->wanted[i]);
	free(arithmetic->program);
	free(arithmetic->source);
	spec_image_clear(&arithmetic->image);
	*arithmetic = (struct spec_arithmetic){0};
}

/* Bytes of a worker's pointers to rows, which come before a program's scratch. */
static size_t
pointer_bytes(const struct spec_arithmetic *arithmetic)
{
	size_t bytes = arithmetic->most_rows * sizeof(float *);

	return (bytes + ALIGNMENT - 1) / ALIGNMENT * ALIGNMENT;
}

static void
run_program(const struct spec_arithmetic *arithmetic,
	const struct spec_stream_worker *worker, const struct spec_program *program,
	int line, float *to)
{
	const struct spec_window *data = &arithmetic->image.data;
	const float **row = worker->scratch;
	char *scratch = worker->scratch;

	for (size_t i = 0; i < program->rows; i++)
		row[i] = spec_decoder_row(worker->decoder[program->row[i].image],
			data->y0 + line, program->row[i].channel);
	spec_program_run(program, row, spec_window_width(data), line,
		scratch + pointer_bytes(arithmetic), to);
}

static enum spec_status
kernel(void *state, struct spec_stream_worker *worker, int line, struct spec_error *error)
{
	const struct spec_arithmetic *arithmetic = state;
	const struct spec_image *image = &arithmetic->image;
	int y = image->data.y0 + line;
	float *const *plane;
	enum spec_status status = spec_packer_begin(worker->packer, y, &plane, error);

	for (size_t i = 0; i < image->channels && status == SPEC_OK; i++) {
		const struct spec_arithmetic_source *source = &arithmetic->source[i];

		if (source->program == SPEC_PROGRAM_NONE)
			memcpy(plane[i],
				spec_decoder_row(worker->decoder[0], y, source->channel),
				spec_window_width(&image->data) * sizeof **plane);
		else
			run_program(arithmetic, worker,
				&arithmetic->program[source->program], line, plane[i]);
	}
	return status == SPEC_OK ? spec_packer_end(worker->packer, y, error) : status;
}

enum spec_status
spec_arithmetic_run(struct spec_arithmetic *arithmetic, struct spec_reader *const *reader,
	const struct spec_settings *settings, unsigned long long *overflows,
	struct spec_error *error)
{
	struct spec_stream stream = {.readers = (int)arithmetic->images,
		.first_line = arithmetic->image.data.y0,
		.lines = (int)spec_window_height(&arithmetic->image.data),
		.lines_in = 1,
		.scratch_bytes = pointer_bytes(arithmetic) + arithmetic->scratch_bytes,
		.state = arithmetic,
		.kernel = kernel};

	for (size_t i = 0; i < arithmetic->images; i++) {
		stream.reader[i] = reader[i];
		stream.wanted[i] = arithmetic->wanted[i];
	}
	return spec_image_save(&arithmetic->image, &stream, settings, overflows, error);
}
