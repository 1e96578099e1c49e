#include "optics/coating.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "base/memory.h"

/* The recipe's numbers in a stack; the varied layer's thickness comes later. */
static enum spec_status
fill_stack(struct spec_stack *stack, const struct spec_recipe *recipe,
	const double *wavelength_nm, size_t count, enum spec_extrapolate extrapolate,
	struct spec_error *error)
{
	size_t layers = spec_recipe_layers(recipe);
	enum spec_status status = spec_stack_new(layers, count, stack, error);

	if (status != SPEC_OK)
		return status;
	for (size_t i = 0; i < count; i++)
		stack->wavelength_nm[i] = wavelength_nm[i];
	for (size_t i = 0; i < layers; i++)
		stack->thickness_nm[i] = recipe->layer[i + 1].thickness_nm;
	return spec_recipe_sample(
		recipe, wavelength_nm, count, extrapolate, stack->n, stack->k, error);
}

static enum spec_status
settle_thickness(struct spec_coating *coating, const struct spec_recipe *recipe,
	const struct spec_thickness *thickness, struct spec_error *error)
{
	size_t layer;
	enum spec_status status;

	if (!thickness)
		return spec_recipe_check_fixed(recipe, error);
	status = spec_recipe_find_varied(recipe, &layer, error);
	if (status != SPEC_OK)
		return status;
	coating->thickness = *thickness;
	coating->front.varied = layer;
	coating->front.thickness_nm[layer - 1] = thickness->top_nm;
	return SPEC_OK;
}

/* A half-space from which light is to come: what it hardly absorbs is taken as nothing. */
static void
clear_ambient(struct spec_stack *stack)
{
	for (size_t i = 0; i < stack->wavelengths; i++) {
		if (stack->k[i] < SPEC_COATING_CLEAR)
			stack->k[i] = 0;
	}
}

static enum spec_status
settle_sides(struct spec_coating *coating, struct spec_error *error)
{
	const struct spec_stack *front = &coating->front;
	size_t count = front->wavelengths, behind = (front->layers + 1) * count;
	enum spec_status status;

	clear_ambient(&coating->front);
	if (!spec_stack_is_lit(front))
		return spec_error_set(error, SPEC_EUSAGE,
			"the stack's first medium absorbs: no light would arrive");
	status = spec_stack_reverse(front, &coating->back, error);
	clear_ambient(&coating->back);
	coating->clear_behind = status == SPEC_OK && spec_stack_is_lit(&coating->back);
	coating->from_behind = spec_memory_new(count, sizeof(double), "wavelengths", error);
	coating->from_before = spec_memory_new(count, sizeof(double), "wavelengths", error);
	if (status != SPEC_OK || !coating->from_behind || !coating->from_before)
		return SPEC_ENOMEM;
	for (size_t i = 0; i < count; i++) {
		double ratio = front->n[i] / front->n[behind + i];
		int clear = front->k[behind + i] < SPEC_COATING_CLEAR &&
			    front->n[behind + i] > 0;

		coating->from_behind[i] = clear ? ratio * ratio : 0;
		coating->from_before[i] = 1 / (ratio * ratio);
	}
	return SPEC_OK;
}

enum spec_status
spec_coating_make(struct spec_coating *coating, const struct spec_recipe *recipe,
	const struct spec_thickness *thickness, const double *wavelength_nm, size_t count,
	enum spec_extrapolate extrapolate, struct spec_error *error)
{
	enum spec_status status;

	*coating = (struct spec_coating){0};
	status = fill_stack(
		&coating->front, recipe, wavelength_nm, count, extrapolate, error);
	if (status == SPEC_OK)
		status = settle_thickness(coating, recipe, thickness, error);
	if (status == SPEC_OK)
		status = settle_sides(coating, error);
	if (status != SPEC_OK)
		spec_coating_free(coating);
	return status;
}

void
spec_coating_free(struct spec_coating *coating)
{
	spec_stack_free(&coating->front);
	spec_stack_free(&coating->back);
	free(coating->from_behind);
	free(coating->from_before);
	*coating = (struct spec_coating){0};
}

void
spec_coating_row(const struct spec_coating *coating, size_t wavelength, int behind,
	const double *cosine, const double *thickness_nm, size_t count,
	enum spec_polarisation polarisation, double *mirrored, double *through)
{
	double factor = behind ? coating->from_before[wavelength]
			       : coating->from_behind[wavelength];

	spec_stack_row(behind ? &coating->back : &coating->front, wavelength, cosine,
		thickness_nm, count, polarisation, mirrored, through);
	for (size_t i = 0; i < count && factor != 1; i++)
		through[i] *= factor;
}

void
spec_coating_spectrum(const struct spec_coating *coating, int behind, double cosine,
	double thickness_nm, double *mirrored, double *through)
{
	const struct spec_stack *stack = behind ? &coating->back : &coating->front;
	const double *factor = behind ? coating->from_before : coating->from_behind;

	spec_stack_spectrum(
		stack, cosine, thickness_nm, SPEC_POLARISATION_NONE, mirrored, through);
	for (size_t i = 0; i < stack->wavelengths; i++)
		through[i] *= factor[i];
}

double
spec_coating_absorptance(double reflectance, double transmittance)
{
	double rest = 1 - reflectance - transmittance;

	return fabs(rest) < 1e-14 ? 0 : rest;
}

enum spec_status
spec_coating_curve(const struct spec_coating *coating, double cosine,
	enum spec_polarisation polarisation, struct spec_curve *curve,
	struct spec_error *error)
{
	static const char *const names[] = {"R", "T", "A"};
	const struct spec_stack *stack = &coating->front;
	size_t count = stack->wavelengths;
	enum spec_status status = spec_curve_new(count, 3, curve, error);

	for (size_t i = 0; i < 3 && status == SPEC_OK; i++)
		status = spec_curve_set_text(&curve->column[i], names[i], error);
	if (status == SPEC_OK)
		status = spec_curve_set_text(&curve->quantity, "reflectance", error);
	if (status == SPEC_OK)
		status = spec_curve_set_text(&curve->unit, "1", error);
	if (status != SPEC_OK) {
		spec_curve_free(curve);
		return status;
	}
	memcpy(curve->wavelength_nm, stack->wavelength_nm, count * sizeof(double));
	spec_stack_spectrum(stack, cosine, coating->thickness.top_nm, polarisation,
		curve->value, curve->value + count);
	for (size_t i = 0; i < count; i++)
		curve->value[2 * count + i] =
			spec_coating_absorptance(curve->value[i], curve->value[count + i]);
	return SPEC_OK;
}
