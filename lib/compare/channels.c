/* How each channel of a combined image comes about. */
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "base/memory.h"
#include "compare/formula.h"
#include "compare/planning.h"
#include "image/variances.h"

#define SAME_NM 1e-3 /* bispectral channels closer than this are the same */

/* channel: of each image, what is worked on there. to: the output's. */
static enum spec_status
add_program(const struct spec_plan *plan, const struct spec_expression *expression,
	struct spec_program_place *place, size_t to)
{
	struct spec_arithmetic *arithmetic = plan->arithmetic;
	void *list = arithmetic->program;
	struct spec_program *program;
	enum spec_status status = spec_memory_grow(&list, &arithmetic->program_room,
		arithmetic->programs + 1, sizeof *program, "programs", plan->error);

	arithmetic->program = list;
	if (status != SPEC_OK)
		return status;
	place->image = plan->image;
	place->name = plan->name;
	place->bands = plan->image[0]->bands;
	place->width = spec_window_width(&plan->image[0]->data);
	place->height = spec_window_height(&plan->image[0]->data);
	program = &arithmetic->program[arithmetic->programs];
	status = spec_program_make(program, expression, place, plan->error);
	if (status != SPEC_OK)
		return status;
	program->whole = arithmetic->image.channel[to].role == SPEC_ROLE_OTHER &&
			 arithmetic->image.channel[to].sample == SPEC_SAMPLE_UINT;
	arithmetic->source[to].program = arithmetic->programs++;
	for (size_t i = 0; i < program->rows; i++)
		arithmetic->wanted[program->row[i].image][program->row[i].channel] = 1;
	if (program->rows > arithmetic->most_rows)
		arithmetic->most_rows = program->rows;
	if (spec_program_scratch(program) > arithmetic->scratch_bytes)
		arithmetic->scratch_bytes = spec_program_scratch(program);
	return SPEC_OK;
}

static enum spec_status
add_bands(const struct spec_plan *plan)
{
	const struct spec_image *image = &plan->arithmetic->image;
	size_t channel[SPEC_ARITHMETIC_MOST + 1];
	struct spec_program_place place = {.channel = channel};
	enum spec_status status = SPEC_OK;

	for (size_t i = 0; i < image->bands * (size_t)image->stokes && status == SPEC_OK;
		i++) {
		size_t band = i % image->bands;

		place.stokes = (int)(i / image->bands);
		place.wavelength_nm = image->wavelength_nm[band];
		for (size_t j = 0; j < plan->images; j++)
			channel[j] = spec_program_band(plan->image[j], band, place.stokes);
		status = add_program(
			plan, &plan->expression, &place, image->band_channel[i]);
	}
	return status;
}

/* The bispectral channel of the same wavelengths, or image->channels. */
static size_t
find_bispectral(const struct spec_image *image, const struct spec_channel *like)
{
	for (size_t i = 0; i < image->channels; i++) {
		const struct spec_channel *channel = &image->channel[i];

		if (channel->role == SPEC_ROLE_BISPECTRAL &&
			fabs(channel->wavelength_nm - like->wavelength_nm) < SAME_NM &&
			fabs(channel->reradiated_nm - like->reradiated_nm) < SAME_NM)
			return i;
	}
	return image->channels;
}

static enum spec_status
add_bispectral(const struct spec_plan *plan)
{
	const struct spec_image *image = &plan->arithmetic->image;
	size_t channel[SPEC_ARITHMETIC_MOST + 1];
	struct spec_program_place place = {.channel = channel};
	enum spec_status status = SPEC_OK;

	for (size_t i = 0; i < plan->operands; i++) {
		if (plan->image[i]->bispectral != image->bispectral)
			return spec_error_set(plan->error, SPEC_EUSAGE,
				"%s has %zu bispectral channels, %s %zu", plan->name[0],
				image->bispectral, plan->name[i],
				plan->image[i]->bispectral);
	}
	for (size_t i = 0; i < image->channels && status == SPEC_OK; i++) {
		if (image->channel[i].role != SPEC_ROLE_BISPECTRAL)
			continue;
		for (size_t j = 0; j < plan->images; j++) {
			channel[j] = find_bispectral(plan->image[j], &image->channel[i]);
			if (j < plan->operands && channel[j] == plan->image[j]->channels)
				return spec_error_set(plan->error, SPEC_EUSAGE,
					"%s has no channel '%s', %s has", plan->name[j],
					image->channel[i].name, plan->name[0]);
		}
		status = add_program(plan, &plan->expression, &place, i);
	}
	return status;
}

/* A foreign channel of floats that is worked on as a band: at[i] is that of image i. */
static enum spec_status
add_foreign(const struct spec_plan *plan, const size_t *at, const char *name)
{
	const struct spec_image *image = &plan->arithmetic->image;
	struct spec_program_place place = {.channel = at, .wavelength_nm = NAN};
	size_t to = spec_image_find_channel(image, name);

	if (to == image->channels || image->channel[to].sample == SPEC_SAMPLE_UINT)
		return SPEC_OK;
	return add_program(plan, &plan->expression, &place, to);
}

/* An image without alpha covers everything. */
static enum spec_status
add_alpha(const struct spec_plan *plan)
{
	const char *name = spec_formula_alpha(plan->setup);
	size_t at[SPEC_ARITHMETIC_MOST + 1];

	for (size_t i = 0; i < plan->images; i++) {
		at[i] = spec_image_find_channel(plan->image[i], name);
		if (at[i] == plan->image[i]->channels)
			at[i] = SPEC_PROGRAM_ONES;
	}
	return add_foreign(plan, at, name);
}

/* The bands of a layer: film i's, lamp i's, or where neither is asked for what passes. */
static const size_t *
bands_of(const struct spec_layers *layers, size_t i)
{
	if (i < layers->films)
		return layers->film[i].mirror;
	i -= layers->films;
	return i < layers->lamps ? layers->lamp[i].irradiance : layers->through;
}

static enum spec_status
add_layers(const struct spec_plan *plan)
{
	const struct spec_layers *first = &plan->layers[0];
	size_t at[SPEC_ARITHMETIC_MOST + 1];
	enum spec_status status = SPEC_OK;

	for (size_t i = 0; i < first->films + first->lamps + (first->through != NULL);
		i++) {
		for (size_t band = 0; band < plan->image[0]->bands && status == SPEC_OK;
			band++) {
			for (size_t j = 0; j < plan->operands; j++)
				at[j] = bands_of(&plan->layers[j], i)[band];
			status = add_foreign(plan, at,
				plan->image[0]->channel[bands_of(first, i)[band]].name);
		}
	}
	return status;
}

/* The variances of all bands, which the output has where all images have. */
static enum spec_status
add_variances(const struct spec_plan *plan)
{
	const struct spec_image *image = &plan->arithmetic->image;
	size_t at[SPEC_ARITHMETIC_MOST + 1];
	struct spec_program_place place = {.channel = at, .wavelength_nm = NAN};
	struct spec_expression expression = {0};
	char *text = NULL;
	enum spec_status status = spec_formula_variance(
		plan->setup, plan->weight, plan->operands, &text, plan->error);

	if (status == SPEC_OK && text)
		status = spec_expression_parse(
			text, plan->operands, &expression, plan->error);
	for (size_t i = 0; i < image->bands && text && status == SPEC_OK; i++) {
		for (size_t j = 0; j < plan->operands; j++)
			at[j] = spec_variances_find(
				plan->image[j], plan->image[j]->band_channel[i]);
		status = add_program(plan, &expression, &place,
			spec_variances_find(image, image->band_channel[i]));
	}
	spec_expression_free(&expression);
	free(text);
	return status;
}

/* A channel of the geometry that all images have, of which there is a mean. */
static enum spec_status
add_geometry(const struct spec_plan *plan, size_t to)
{
	size_t at[SPEC_ARITHMETIC_MOST + 1];
	struct spec_program_place place = {.channel = at, .wavelength_nm = NAN};
	struct spec_expression expression = {0};
	char *text = NULL;
	enum spec_status status = spec_formula_geometry(plan->input, plan->weight,
		plan->operands, &plan->arithmetic->image.channel[to], &text, plan->error);

	if (status == SPEC_OK && text)
		status = spec_expression_parse(
			text, plan->operands, &expression, plan->error);
	for (size_t i = 0; i < plan->operands; i++)
		at[i] = SPEC_PROGRAM_NONE;
	if (status == SPEC_OK && text)
		status = add_program(plan, &expression, &place, to);
	spec_expression_free(&expression);
	free(text);
	return status;
}

/* What nothing else makes is copied from the first image. */
static enum spec_status
copy_rest(const struct spec_plan *plan)
{
	struct spec_arithmetic *arithmetic = plan->arithmetic;
	const struct spec_image *image = &arithmetic->image;

	for (size_t i = 0; i < image->channels; i++) {
		struct spec_arithmetic_source *source = &arithmetic->source[i];

		if (source->program != SPEC_PROGRAM_NONE)
			continue;
		source->channel =
			spec_image_find_channel(plan->image[0], image->channel[i].name);
		arithmetic->wanted[0][source->channel] = 1;
	}
	return SPEC_OK;
}

static enum spec_status
make_room(const struct spec_plan *plan)
{
	struct spec_arithmetic *arithmetic = plan->arithmetic;
	size_t channels = arithmetic->image.channels;

	arithmetic->source = spec_memory_new(
		channels, sizeof *arithmetic->source, "channels", plan->error);
	for (size_t i = 0; arithmetic->source && i < channels; i++)
		arithmetic->source[i].program = SPEC_PROGRAM_NONE;
	for (size_t i = 0; arithmetic->source && i < plan->images; i++) {
		arithmetic->wanted[i] = spec_memory_new(
			plan->image[i]->channels, 1, "channels", plan->error);
		if (!arithmetic->wanted[i])
			return SPEC_ENOMEM;
	}
	return arithmetic->source ? SPEC_OK : SPEC_ENOMEM;
}

static enum spec_status
read_formula(struct spec_plan *plan)
{
	char *text = NULL;
	enum spec_status status = spec_formula_write(
		plan->setup, plan->weight, plan->operands, &text, plan->error);

	if (status == SPEC_OK)
		status = spec_expression_parse(
			text, plan->images, &plan->expression, plan->error);
	free(text);
	return status;
}

enum spec_status
spec_plan_channels(struct spec_plan *plan)
{
	size_t channels = plan->arithmetic->image.channels;
	enum spec_status status = make_room(plan);

	if (status == SPEC_OK)
		status = read_formula(plan);
	if (status == SPEC_OK)
		status = add_bands(plan);
	if (status == SPEC_OK && plan->operation->linear)
		status = add_bispectral(plan);
	if (status == SPEC_OK && plan->operation->alpha)
		status = add_alpha(plan);
	if (status == SPEC_OK && plan->operation->layers)
		status = add_layers(plan);
	if (status == SPEC_OK && spec_variances_has_some(&plan->arithmetic->image))
		status = add_variances(plan);
	for (size_t i = 0; i < channels && plan->operation->mean && status == SPEC_OK; i++)
		status = add_geometry(plan, i);
	return status == SPEC_OK ? copy_rest(plan) : status;
}
