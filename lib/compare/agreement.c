/* Whether images go together in an operation. */
#include <string.h>

#include "compare/formula.h"
#include "compare/planning.h"

static enum spec_status
check_counts(const struct spec_plan *plan)
{
	const struct spec_arithmetic_traits *operation = plan->operation;

	if (plan->operands < operation->least)
		return spec_error_set(plan->error, SPEC_EUSAGE,
			"%s needs %zu images at least, and %zu %s given", operation->name,
			operation->least, plan->operands,
			plan->operands == 1 ? "is" : "are");
	if (plan->operands > operation->most)
		return spec_error_set(plan->error, SPEC_EUSAGE,
			"%s takes %zu images at most, and %zu are given", operation->name,
			operation->most, plan->operands);
	return SPEC_OK;
}

/* Bispectral channels and Stokes components stand all that is linear, and nothing else. */
static enum spec_status
check_linear(const struct spec_plan *plan, size_t i)
{
	const struct spec_image *image = plan->image[i];

	if (plan->operation->linear)
		return SPEC_OK;
	if (image->bispectral > 0)
		return spec_error_set(plan->error, SPEC_EUNSUPPORTED,
			"%s is bispectral, which %s cannot do", plan->name[i],
			plan->operation->name);
	if (image->stokes > 1 && plan->operation->alike)
		return spec_error_set(plan->error, SPEC_EUNSUPPORTED,
			"%s has %d Stokes components, of which there is no %s",
			plan->name[i], image->stokes, plan->operation->name);
	return SPEC_OK;
}

static enum spec_status
check_alike(const struct spec_plan *plan, size_t i)
{
	const struct spec_match *first = &plan->input[0], *other = &plan->input[i];
	enum spec_status status = spec_match_quantities(first, other, plan->error);

	if (status == SPEC_OK)
		status = spec_match_stokes(first, other, plan->error);
	return status == SPEC_OK ? spec_match_bins(first, other, plan->error) : status;
}

/*
 * Reflectance is tabulated at points, and multiplies light in bins nevertheless; an expression
 * may join what it likes to bins.
 */
static enum spec_status
check_bins(const struct spec_plan *plan)
{
	int strict = plan->setup->operation != SPEC_ARITHMETIC_EXPRESSION;
	enum spec_status status = SPEC_OK;

	for (size_t i = 1; i < plan->operands; i++) {
		const struct spec_image *image = plan->image[i];

		for (size_t j = 0; j < i && status == SPEC_OK; j++) {
			const struct spec_image *before = plan->image[j];

			if ((before->edges_nm && image->edges_nm) ||
				(strict && before->role == image->role))
				status = spec_match_bins(
					&plan->input[j], &plan->input[i], plan->error);
		}
	}
	return status;
}

/* An expression has the components of its first light, and so must all other light. */
static enum spec_status
check_components(const struct spec_plan *plan)
{
	const struct spec_match *first = NULL;
	enum spec_status status = SPEC_OK;

	for (size_t i = 0; i < plan->operands && status == SPEC_OK; i++) {
		if (plan->image[i]->role != SPEC_ROLE_EMISSIVE)
			continue;
		if (!first)
			first = &plan->input[i];
		status = spec_match_stokes(first, &plan->input[i], plan->error);
	}
	return status;
}

static enum spec_status
check_images(const struct spec_plan *plan)
{
	enum spec_status status = SPEC_OK;

	for (size_t i = 0; i < plan->images && status == SPEC_OK; i++) {
		status = spec_match_windows(&plan->input[0], &plan->input[i], plan->error);
		if (status != SPEC_OK || i >= plan->operands)
			continue;
		if (plan->image[i]->bands == 0 &&
			(i == 0 || plan->setup->operation != SPEC_ARITHMETIC_EXPRESSION))
			return spec_error_set(plan->error, SPEC_EFORMAT,
				"%s: has no spectral channel", plan->name[i]);
		if (plan->image[i]->bands > 0)
			status = spec_match_bands(
				&plan->input[0], &plan->input[i], plan->error);
		if (status == SPEC_OK)
			status = check_linear(plan, i);
		if (status == SPEC_OK && plan->operation->alike)
			status = check_alike(plan, i);
	}
	if (status == SPEC_OK && !plan->operation->alike)
		status = check_bins(plan);
	return status == SPEC_OK ? check_components(plan) : status;
}

/* What lies over others without an alpha of its own would hide them all. */
static enum spec_status
check_alpha(const struct spec_plan *plan)
{
	const char *name = spec_formula_alpha(plan->setup);

	if (plan->setup->operation != SPEC_ARITHMETIC_OVER)
		return SPEC_OK;
	for (size_t i = 0; i + 1 < plan->operands; i++) {
		const struct spec_image *image = plan->image[i];
		size_t channel = spec_image_find_channel(image, name);

		if (channel == image->channels)
			return spec_error_set(plan->error, SPEC_EUSAGE,
				"%s has no alpha (%s), so %s could not be seen behind it",
				plan->name[i], name, plan->name[i + 1]);
		if (image->channel[channel].role != SPEC_ROLE_OTHER ||
			image->channel[channel].sample == SPEC_SAMPLE_UINT)
			return spec_error_set(plan->error, SPEC_EUSAGE,
				"%s: its channel '%s' is no alpha", plan->name[i], name);
	}
	return SPEC_OK;
}

static int
has_layers(const struct spec_image *image)
{
	for (size_t i = 0; i < image->channels; i++) {
		if (spec_layers_is_film(&image->channel[i]) ||
			spec_layers_is_lamp(&image->channel[i]))
			return 1;
	}
	return 0;
}

/* Light layers are worked on as the bands, or refused: S0 alone would not fit to them. */
static enum spec_status
check_layers(struct spec_plan *plan)
{
	const struct spec_layers *first = &plan->layers[0];
	enum spec_status status = SPEC_OK;

	for (size_t i = 0; i < plan->operands && status == SPEC_OK; i++) {
		struct spec_layers *layers = &plan->layers[i];

		if (!has_layers(plan->image[i]) && !has_layers(plan->image[0]))
			continue;
		if (!plan->operation->layers)
			return spec_error_set(plan->error, SPEC_EUSAGE,
				"%s has light layers, which %s cannot do (specfilm, specdisc first)",
				plan->name[has_layers(plan->image[i]) ? i : 0],
				plan->operation->name);
		status = spec_layers_find(
			layers, plan->image[i], plan->name[i], plan->error);
		if (status == SPEC_OK &&
			(layers->films != first->films || layers->lamps != first->lamps ||
				!layers->through != !first->through))
			status = spec_error_set(plan->error, SPEC_EUSAGE,
				"%s has light layers of %zu films%s and of %zu lamps, %s of %zu%s and of %zu",
				plan->name[0], first->films,
				first->through ? " (through)" : "", first->lamps,
				plan->name[i], layers->films,
				layers->through ? " (through)" : "", layers->lamps);
	}
	return status;
}

enum spec_status
spec_plan_check(struct spec_plan *plan)
{
	enum spec_status status = check_counts(plan);

	if (status == SPEC_OK)
		status = check_images(plan);
	if (status == SPEC_OK)
		status = check_alpha(plan);
	return status == SPEC_OK ? check_layers(plan) : status;
}
