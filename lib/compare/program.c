#include "compare/program.h"

#include <math.h>
#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "base/memory.h"
#include "base/vector.h"

#define RUN 256 /* pixels that are worked on at a time: registers stay in the cache */

enum kind { /* of an instruction */
	KIND_CONSTANT,
	KIND_Y,
	KIND_X,
	KIND_FLOATS,
	KIND_WHOLES,
	KIND_CALL
};

struct spec_instruction {
	enum kind kind;
	size_t to;                              /* register */
	size_t operand[SPEC_FUNCTION_OPERANDS]; /* registers */
	const struct spec_function *function;
	double number;
	size_t row;
};

/* What is known of a node before it is run. */
struct knowledge {
	int known; /* the same in all pixels, and this: */
	double value;
	size_t node;  /* itself, or the branch that a choice is known to take */
	size_t uses;  /* by nodes that run; 0: it does not */
	size_t place; /* its register */
};

/* Between two bands of an image: (1 - part) of one and part of the next. */
struct between {
	size_t band;
	double part;
};

struct maker {
	struct spec_program *program;
	const struct spec_expression *expression;
	const struct spec_program_place *place;
	struct knowledge *of; /* per node */
	size_t *spare;        /* registers that are free */
	size_t spares, row_room, instruction_room;
	struct spec_error *error;
};

static enum spec_status __attribute__((format(printf, 4, 5)))
fail(const struct maker *maker, enum spec_status status, const struct spec_node *node,
	const char *format, ...)
{
	va_list arguments;

	va_start(arguments, format);
	spec_error_vset(maker->error, status, format, arguments);
	va_end(arguments);
	spec_error_point(maker->error, maker->expression->text, node->at);
	return status;
}

size_t
spec_program_band(const struct spec_image *image, size_t band, int stokes)
{
	if (image->bands == 0)
		return SPEC_PROGRAM_NONE;
	if (image->role == SPEC_ROLE_REFLECTIVE)
		stokes = 0;
	return stokes < image->stokes
		       ? image->band_channel[(size_t)stokes * image->bands + band]
		       : SPEC_PROGRAM_NONE;
}

/* --- what is known beforehand --- */

static double
number_of_place(const struct spec_program_place *place, enum spec_expression_place what)
{
	switch (what) {
	case SPEC_PLACE_NM:
		return place->wavelength_nm;
	case SPEC_PLACE_STOKES:
		return place->stokes;
	case SPEC_PLACE_WIDTH:
		return (double)place->width;
	case SPEC_PLACE_HEIGHT:
		return (double)place->height;
	default:
		return (double)place->bands;
	}
}

/* The function's own loop works it out, so that it has the bits it has in a row. */
static double
call_once(const struct spec_function *function, const double *value)
{
	double lane[SPEC_FUNCTION_OPERANDS][SPEC_FUNCTION_LANES], to[SPEC_FUNCTION_LANES];

	for (int i = 0; i < SPEC_FUNCTION_OPERANDS; i++)
		for (int j = 0; j < SPEC_FUNCTION_LANES; j++)
			lane[i][j] = value[i];
	function->run(to, lane[0], lane[1], lane[2], SPEC_FUNCTION_LANES);
	return to[0];
}

static int
is_choice(const struct spec_node *node)
{
	return node->kind == SPEC_NODE_CALL && strcmp(node->function->name, "if") == 0;
}

/* What stands for an if whose condition is known; else the node itself. */
static size_t
chosen(const struct maker *maker, size_t index)
{
	const struct spec_node *node = &maker->expression->node[index];
	const struct knowledge *condition = &maker->of[node->operand[0]];

	if (!is_choice(node) || !condition->known || isnan(condition->value))
		return index;
	return maker->of[node->operand[condition->value != 0 ? 1 : 2]].node;
}

static void
know_call(const struct maker *maker, const struct spec_node *node, struct knowledge *of)
{
	double value[SPEC_FUNCTION_OPERANDS] = {0};

	of->known = 1;
	for (int i = 0; i < node->function->operands; i++) {
		of->known &= maker->of[node->operand[i]].known;
		value[i] = maker->of[node->operand[i]].value;
	}
	if (of->known)
		of->value = call_once(node->function, value);
}

static void
know(const struct maker *maker, size_t index)
{
	const struct spec_node *node = &maker->expression->node[index];
	struct knowledge *of = &maker->of[index];

	of->node = chosen(maker, index);
	if (of->node != index) {
		of->known = maker->of[of->node].known;
		of->value = maker->of[of->node].value;
		return;
	}
	switch (node->kind) {
	case SPEC_NODE_NUMBER:
		of->known = 1;
		of->value = node->number;
		break;
	case SPEC_NODE_PLACE:
		of->known = node->place != SPEC_PLACE_X && node->place != SPEC_PLACE_Y;
		of->value = number_of_place(maker->place, node->place);
		break;
	case SPEC_NODE_SAMPLE:
		of->known = maker->place->channel[node->image] == SPEC_PROGRAM_ONES;
		of->value = 1;
		break;
	case SPEC_NODE_CALL:
		know_call(maker, node, of);
		break;
	default:
		break;
	}
}

/* How many operands must be there when the node runs. */
static int
running_operands(const struct spec_node *node)
{
	return node->kind == SPEC_NODE_CALL ? node->function->operands : 0;
}

/* The i-th of them. */
static struct knowledge *
operand_of(const struct maker *maker, const struct spec_node *node, int i)
{
	return &maker->of[maker->of[node->operand[i]].node];
}

/* Counts for each node that runs the nodes that use it; the result is used once. */
static void
count_uses(const struct maker *maker)
{
	size_t result = maker->of[maker->expression->result].node;

	maker->of[result].uses = 1;
	for (size_t i = result + 1; i-- > 0;) {
		const struct spec_node *node = &maker->expression->node[i];

		if (maker->of[i].uses == 0 || maker->of[i].known)
			continue;
		for (int j = 0; j < running_operands(node); j++)
			operand_of(maker, node, j)->uses++;
	}
}

/* --- instructions --- */

static enum spec_status
add_instruction(struct maker *maker, const struct spec_instruction *instruction)
{
	struct spec_program *program = maker->program;
	void *list = program->instruction;
	enum spec_status status =
		spec_memory_grow(&list, &maker->instruction_room, program->instructions + 1,
			sizeof *instruction, "instructions", maker->error);

	program->instruction = list;
	if (status == SPEC_OK)
		program->instruction[program->instructions++] = *instruction;
	return status;
}

static size_t
new_register(struct maker *maker)
{
	return maker->spares > 0 ? maker->spare[--maker->spares]
				 : maker->program->registers++;
}

/* What is the same in a whole row is worked out before the rest, and keeps its register. */
static int
is_fixed(const struct maker *maker, size_t index)
{
	const struct spec_node *node = &maker->expression->node[index];

	return maker->of[index].known ||
	       (node->kind == SPEC_NODE_PLACE && node->place == SPEC_PLACE_Y);
}

static void
end_uses(struct maker *maker, const struct spec_node *node)
{
	for (int i = 0; i < running_operands(node); i++) {
		struct knowledge *of = operand_of(maker, node, i);

		if (--of->uses == 0 && !is_fixed(maker, (size_t)(of - maker->of)))
			maker->spare[maker->spares++] = of->place;
	}
}

static enum spec_status
add_row(struct maker *maker, size_t image, size_t channel, size_t *index)
{
	struct spec_program *program = maker->program;
	const struct spec_channel *it = &maker->place->image[image]->channel[channel];
	void *list = program->row;
	enum spec_status status;

	for (*index = 0; *index < program->rows; ++*index) {
		if (program->row[*index].image == image &&
			program->row[*index].channel == channel)
			return SPEC_OK;
	}
	status = spec_memory_grow(&list, &maker->row_room, program->rows + 1,
		sizeof *program->row, "rows", maker->error);
	program->row = list;
	if (status == SPEC_OK)
		program->row[program->rows++] = (struct spec_program_row){image, channel,
			it->role == SPEC_ROLE_OTHER && it->sample == SPEC_SAMPLE_UINT};
	return status;
}

/* A channel's samples into a register. */
static enum spec_status
add_load(struct maker *maker, size_t image, size_t channel, size_t to)
{
	struct spec_instruction load = {.kind = KIND_FLOATS, .to = to};
	enum spec_status status = add_row(maker, image, channel, &load.row);

	if (status == SPEC_OK && maker->program->row[load.row].whole)
		load.kind = KIND_WHOLES;
	return status == SPEC_OK ? add_instruction(maker, &load) : status;
}

static enum spec_status
make_sample(struct maker *maker, const struct spec_node *node, size_t to)
{
	size_t channel = maker->place->channel[node->image];

	if (channel == SPEC_PROGRAM_NONE)
		return fail(maker, SPEC_EUSAGE, node, "%s has no such band",
			maker->place->name[node->image]);
	return add_load(maker, node->image, channel, to);
}

static enum spec_status
make_channel(struct maker *maker, const struct spec_node *node, size_t to)
{
	const struct spec_image *image = maker->place->image[node->image];
	size_t channel = spec_image_find_channel(image, node->channel);

	if (channel == image->channels)
		return fail(maker, SPEC_EUSAGE, node, "%s has no channel '%.100s'",
			maker->place->name[node->image], node->channel);
	return add_load(maker, node->image, channel, to);
}

/* Values per band cannot be interpolated. */
static enum spec_status
refuse_per_band(const struct maker *maker, const struct spec_node *node, double nm)
{
	const struct spec_image *image = maker->place->image[node->image];
	char *quantity = spec_image_quantity(image, maker->error);
	int per_band = quantity && strstr(quantity, "per band");

	if (!quantity)
		return SPEC_ENOMEM;
	free(quantity);
	if (!per_band)
		return SPEC_OK;
	return fail(maker, SPEC_EUNSUPPORTED, node,
		"%s has no band at %g nm, and its values per band are not interpolated",
		maker->place->name[node->image], nm);
}

static enum spec_status
find_between(
	const struct maker *maker, const struct spec_node *node, struct between *between)
{
	const struct spec_image *image = maker->place->image[node->image];
	const struct knowledge *wavelength = &maker->of[node->operand[0]];
	const char *name = maker->place->name[node->image];
	double nm = wavelength->value, low;
	int same = 0;

	if (!wavelength->known)
		return fail(maker, SPEC_EUSAGE, node,
			"the wavelength must be the same in all pixels");
	if (image->bands == 0)
		return fail(maker, SPEC_EUSAGE, node, "%s has no bands", name);
	if (!isnan(nm))
		between->band = spec_image_nearest_band(image, nm, &same);
	if (same)
		return SPEC_OK;
	if (!(nm >= image->wavelength_nm[0] &&
		    nm <= image->wavelength_nm[image->bands - 1]))
		return fail(maker, SPEC_ERANGE, node,
			"%g nm is outside the bands of %s, %g..%g nm", nm, name,
			image->wavelength_nm[0], image->wavelength_nm[image->bands - 1]);
	between->band -= image->wavelength_nm[between->band] > nm;
	low = image->wavelength_nm[between->band];
	between->part = (nm - low) / (image->wavelength_nm[between->band + 1] - low);
	return refuse_per_band(maker, node, nm);
}

/* An image at a wavelength: a band, or mix(one, next, part). */
static enum spec_status
make_at(struct maker *maker, const struct spec_node *node, size_t to)
{
	const struct spec_image *image = maker->place->image[node->image];
	struct spec_instruction part = {.kind = KIND_CONSTANT},
				mix = {.kind = KIND_CALL, .to = to};
	struct between between = {0, 0};
	size_t channel;
	enum spec_status status = find_between(maker, node, &between);

	if (status != SPEC_OK)
		return status;
	channel = spec_program_band(image, between.band, maker->place->stokes);
	if (channel == SPEC_PROGRAM_NONE)
		return fail(maker, SPEC_EUSAGE, node, "%s has no such Stokes component",
			maker->place->name[node->image]);
	if (between.part == 0)
		return add_load(maker, node->image, channel, to);
	for (int i = 0; i < SPEC_FUNCTION_OPERANDS; i++)
		mix.operand[i] = new_register(maker);
	mix.function = spec_function_named("mix");
	part.number = between.part;
	part.to = mix.operand[2];
	status = add_load(maker, node->image, channel, mix.operand[0]);
	channel = spec_program_band(image, between.band + 1, maker->place->stokes);
	if (status == SPEC_OK)
		status = add_load(maker, node->image, channel, mix.operand[1]);
	if (status == SPEC_OK)
		status = add_instruction(maker, &part);
	for (int i = 0; i < SPEC_FUNCTION_OPERANDS; i++)
		maker->spare[maker->spares++] = mix.operand[i];
	return status == SPEC_OK ? add_instruction(maker, &mix) : status;
}

static enum spec_status
make_call(struct maker *maker, const struct spec_node *node, size_t to)
{
	struct spec_instruction call = {
		.kind = KIND_CALL, .to = to, .function = node->function};
	enum spec_status status;

	for (int i = 0; i < node->function->operands; i++)
		call.operand[i] = operand_of(maker, node, i)->place;
	/* Exact, and faster than a power. */
	if (strcmp(node->function->name, "^") == 0 && operand_of(maker, node, 1)->known &&
		operand_of(maker, node, 1)->value == 2) {
		call.function = spec_function_operator("*", 2);
		call.operand[1] = call.operand[0];
	}
	status = add_instruction(maker, &call);
	end_uses(maker, node);
	return status;
}

static enum spec_status
make_fixed(struct maker *maker, size_t index)
{
	struct knowledge *of = &maker->of[index];
	struct spec_instruction fixed = {.kind = of->known ? KIND_CONSTANT : KIND_Y,
		.to = of->place = new_register(maker),
		.number = of->value};

	return add_instruction(maker, &fixed);
}

static enum spec_status
make_node(struct maker *maker, size_t index)
{
	const struct spec_node *node = &maker->expression->node[index];
	size_t to = maker->of[index].place = new_register(maker);
	struct spec_instruction x = {.kind = KIND_X, .to = to};

	switch (node->kind) {
	case SPEC_NODE_PLACE:
		return add_instruction(maker, &x);
	case SPEC_NODE_SAMPLE:
		return make_sample(maker, node, to);
	case SPEC_NODE_CHANNEL:
		return make_channel(maker, node, to);
	case SPEC_NODE_AT:
		return make_at(maker, node, to);
	default:
		return make_call(maker, node, to);
	}
}

static enum spec_status
make_nodes(struct maker *maker)
{
	size_t nodes = maker->expression->count;
	enum spec_status status = SPEC_OK;

	for (size_t i = 0; i < nodes; i++)
		know(maker, i);
	count_uses(maker);
	for (size_t i = 0; i < nodes && status == SPEC_OK; i++) {
		if (maker->of[i].uses > 0 && is_fixed(maker, i))
			status = make_fixed(maker, i);
	}
	maker->program->fixed = maker->program->instructions;
	for (size_t i = 0; i < nodes && status == SPEC_OK; i++) {
		if (maker->of[i].uses > 0 && !is_fixed(maker, i))
			status = make_node(maker, i);
	}
	maker->program->result = maker->of[maker->of[maker->expression->result].node].place;
	return status;
}

enum spec_status
spec_program_make(struct spec_program *program, const struct spec_expression *expression,
	const struct spec_program_place *place, struct spec_error *error)
{
	struct maker maker = {.program = program,
		.expression = expression,
		.place = place,
		.error = error};
	enum spec_status status = SPEC_ENOMEM;

	*program = (struct spec_program){0};
	maker.of = spec_memory_new(expression->count, sizeof *maker.of, "nodes", error);
	maker.spare = spec_memory_new(expression->count + SPEC_FUNCTION_OPERANDS,
		sizeof *maker.spare, "registers", error);
	if (maker.of && maker.spare)
		status = make_nodes(&maker);
	free(maker.of);
	free(maker.spare);
	if (status != SPEC_OK)
		spec_program_free(program);
	return status;
}

void
spec_program_free(struct spec_program *program)
{
	free(program->row);
	free(program->instruction);
	*program = (struct spec_program){0};
}

/* --- running --- */

size_t
spec_program_scratch(const struct spec_program *program)
{
	return program->registers * RUN * sizeof(double);
}

SPEC_VECTORISED static void
widen(double *restrict to, const float *restrict from, size_t count)
{
	for (size_t i = 0; i < count; i++)
		to[i] = from[i];
}

SPEC_VECTORISED static void
widen_whole(double *restrict to, const float *restrict from, size_t count)
{
	for (size_t i = 0; i < count; i++) {
		uint32_t whole;

		memcpy(&whole, &from[i], sizeof whole);
		to[i] = whole;
	}
}

SPEC_VECTORISED static void
narrow(float *restrict to, const double *restrict from, size_t count)
{
	for (size_t i = 0; i < count; i++)
		to[i] = (float)from[i];
}

SPEC_VECTORISED static void
narrow_whole(float *restrict to, const double *restrict from, size_t count)
{
	for (size_t i = 0; i < count; i++) {
		uint32_t whole =
			from[i] > 0 && from[i] <= UINT32_MAX ? (uint32_t)from[i] : 0;

		memcpy(&to[i], &whole, sizeof whole);
	}
}

SPEC_VECTORISED static void
fill(double *restrict to, double value, double slope, size_t count)
{
	for (size_t i = 0; i < count; i++)
		to[i] = value + slope * (double)(int)i;
}

/* The part of a row that is worked on. */
struct run {
	const float *const *row;
	double (*space)[RUN]; /* the registers */
	size_t x, count;      /* first pixel, pixels */
	size_t lanes;         /* count, made a multiple of SPEC_FUNCTION_LANES */
	int y;
};

static void
execute(const struct spec_instruction *step, const struct run *run)
{
	double *to = run->space[step->to];

	switch (step->kind) {
	case KIND_CONSTANT:
		fill(to, step->number, 0, run->lanes);
		break;
	case KIND_Y:
		fill(to, run->y, 0, run->lanes);
		break;
	case KIND_X:
		fill(to, (double)run->x, 1, run->lanes);
		break;
	case KIND_FLOATS:
		widen(to, run->row[step->row] + run->x, run->count);
		memset(to + run->count, 0, (run->lanes - run->count) * sizeof *to);
		break;
	case KIND_WHOLES:
		widen_whole(to, run->row[step->row] + run->x, run->count);
		memset(to + run->count, 0, (run->lanes - run->count) * sizeof *to);
		break;
	case KIND_CALL:
		step->function->run(to, run->space[step->operand[0]],
			run->space[step->operand[1]], run->space[step->operand[2]],
			run->lanes);
		break;
	}
}

void
spec_program_run(const struct spec_program *program, const float *const *row, size_t width,
	int y, void *scratch, float *to)
{
	struct run run = {.row = row, .space = scratch, .y = y, .lanes = RUN};

	for (size_t i = 0; i < program->fixed; i++)
		execute(&program->instruction[i], &run);
	for (; run.x < width; run.x += RUN) {
		run.count = width - run.x < RUN ? width - run.x : RUN;
		run.lanes = (run.count + SPEC_FUNCTION_LANES - 1) / SPEC_FUNCTION_LANES *
			    SPEC_FUNCTION_LANES;
		for (size_t i = program->fixed; i < program->instructions; i++)
			execute(&program->instruction[i], &run);
		if (program->whole)
			narrow_whole(to + run.x, run.space[program->result], run.count);
		else
			narrow(to + run.x, run.space[program->result], run.count);
	}
}
