/*
 * Fuzzes expressions; what is taken must run, and have the same
 * value wherever a pixel stands.
 */
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "compare/expression.h"
#include "compare/program.h"

#include "fuzz.h"

enum { IMAGES = 3, BANDS = 3, STOKES = 4, WIDTH = 19, SHIFT = 5, MOST_CHANNELS = 32 };

static struct spec_image image[IMAGES];
static float sample[WIDTH + SHIFT];

/* Light with all components, reflectance with other channels, and an image without bands. */
int
LLVMFuzzerInitialize(int *argc, char ***argv)
{
	static const double nm[BANDS] = {400, 500, 700};

	(void)argc;
	(void)argv;
	require(spec_image_add_bands(&image[0], SPEC_ROLE_EMISSIVE, STOKES, nm, BANDS,
			SPEC_SAMPLE_FLOAT, NULL) == SPEC_OK &&
			spec_image_add_bands(&image[1], SPEC_ROLE_REFLECTIVE, 1, nm, BANDS,
				SPEC_SAMPLE_HALF, NULL) == SPEC_OK &&
			spec_image_add_channel(&image[1], "id", SPEC_SAMPLE_UINT, NULL) ==
				SPEC_OK &&
			spec_image_add_channel(&image[2], "A", SPEC_SAMPLE_FLOAT, NULL) ==
				SPEC_OK,
		"no images");
	for (int i = 0; i < IMAGES; i++)
		require(spec_image_index(&image[i], "an image", NULL) == SPEC_OK,
			"no index");
	for (int i = 0; i < WIDTH + SHIFT; i++)
		sample[i] = (float)(i % 7) / 4 - 0.5f;
	return 0;
}

static void
check_nodes(const struct spec_expression *expression)
{
	require(expression->result < expression->count &&
			expression->count <= SPEC_EXPRESSION_MOST_NODES,
		"another size");
	for (size_t i = 0; i < expression->count; i++) {
		const struct spec_node *node = &expression->node[i];

		require(node->at <= strlen(expression->text), "a node behind the text");
		require(node->image < IMAGES, "no such image");
		for (int j = 0;
			node->kind == SPEC_NODE_CALL && j < node->function->operands; j++)
			require(node->operand[j] < i, "a node before its operand");
	}
}

/* The row that begins at sample[first]. */
static void
run(const struct spec_program *program, size_t first, float *to)
{
	const float *row[IMAGES * MOST_CHANNELS];
	void *scratch = aligned_alloc(64, spec_program_scratch(program));

	require(scratch && program->rows <= IMAGES * MOST_CHANNELS, "no rows");
	for (size_t i = 0; i < program->rows; i++) {
		require(program->row[i].channel < image[program->row[i].image].channels,
			"no such channel");
		row[i] = sample + first;
	}
	spec_program_run(program, row, WIDTH, 3, scratch, to);
	free(scratch);
}

static int
reads_pixel(const struct spec_expression *expression)
{
	for (size_t i = 0; i < expression->count; i++)
		if (expression->node[i].kind == SPEC_NODE_PLACE &&
			expression->node[i].place == SPEC_PLACE_X)
			return 1;
	return 0;
}

/* Bit for bit, NaN too. */
static int
same(const float *a, const float *b, size_t count)
{
	for (size_t i = 0; i < count; i++) {
		uint32_t one, two;

		memcpy(&one, a + i, sizeof one);
		memcpy(&two, b + i, sizeof two);
		if (one != two)
			return 0;
	}
	return 1;
}

static void
check_program(const struct spec_expression *expression, size_t band, int stokes)
{
	static const struct spec_image *const images[IMAGES] = {
		&image[0], &image[1], &image[2]};
	static const char *const names[IMAGES] = {"a.exr", "b.exr", "c.exr"};
	size_t channel[IMAGES];
	struct spec_program_place place = {.image = images,
		.name = names,
		.channel = channel,
		.wavelength_nm = image[0].wavelength_nm[band],
		.stokes = stokes,
		.bands = BANDS,
		.width = WIDTH,
		.height = 7};
	struct spec_error error = {0};
	struct spec_program program;
	float here[WIDTH], there[WIDTH];

	for (int i = 0; i < IMAGES; i++)
		channel[i] = spec_program_band(images[i], band, stokes);
	if (spec_program_make(&program, expression, &place, &error) != SPEC_OK) {
		require_caret(&error);
		require(!program.row && !program.instruction, "not left empty");
		return;
	}
	require(program.result < program.registers && program.fixed <= program.instructions,
		"no result");
	run(&program, 0, here);
	run(&program, SHIFT, there);
	require(reads_pixel(expression) || same(here + SHIFT, there, WIDTH - SHIFT),
		"a value that depends on its place");
	spec_program_free(&program);
}

int
LLVMFuzzerTestOneInput(const uint8_t *data, size_t size)
{
	struct spec_error error = {0};
	struct spec_expression expression;
	char *text = malloc(size + 1);

	if (!text)
		return 0;
	memcpy(text, data, size);
	text[size] = '\0';
	if (spec_expression_parse(text, IMAGES, &expression, &error) != SPEC_OK) {
		require_caret(&error);
		require(!expression.text && !expression.node, "not left empty");
	} else {
		check_nodes(&expression);
		check_program(&expression, 1, 0);
		check_program(&expression, 2, 3);
		spec_expression_free(&expression);
	}
	free(text);
	return 0;
}
