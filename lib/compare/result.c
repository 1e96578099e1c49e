/* What several images are together, and the header that says so. */
#include <stdlib.h>
#include <string.h>

#include "base/memory.h"
#include "compare/planning.h"
#include "image/samples.h"
#include "image/variances.h"

/* The text of the operands' quantity where it is the same in all, else "ratio". */
static enum spec_status
settle_ratio(struct spec_plan *plan)
{
	char *first = spec_image_quantity(plan->image[0], plan->error);
	enum spec_status status = first ? SPEC_OK : SPEC_ENOMEM;

	for (size_t i = 1; i < plan->operands && status == SPEC_OK; i++) {
		char *other = spec_image_quantity(plan->image[i], plan->error);

		if (!other)
			status = SPEC_ENOMEM;
		else if (strcmp(first, other) != 0)
			plan->quantity = "ratio";
		free(other);
	}
	free(first);
	return status;
}

/* Light times reflectance is light, reflectance times reflectance reflectance. */
static enum spec_status
settle_product(struct spec_plan *plan)
{
	size_t lights = 0, other = 0;

	for (size_t i = 0; i < plan->operands; i++) {
		if (plan->image[i]->role != SPEC_ROLE_EMISSIVE)
			continue;
		other = lights++ > 0 ? other : i;
		if (lights > 1)
			return spec_error_set(plan->error, SPEC_EUSAGE,
				"%s and %s are both light, whose product is nothing (--expr)",
				plan->name[other], plan->name[i]);
	}
	plan->model = other;
	plan->role = plan->image[other]->role;
	return lights == 0 ? settle_ratio(plan) : SPEC_OK;
}

/* Light over light is a ratio, and so is reflectance over reflectance. */
static enum spec_status
settle_quotient(struct spec_plan *plan)
{
	const struct spec_image *above = plan->image[0], *below = plan->image[1];
	enum spec_status status;

	if (above->role == SPEC_ROLE_EMISSIVE && below->role == SPEC_ROLE_REFLECTIVE)
		return SPEC_OK;
	if (above->role != below->role)
		return spec_error_set(plan->error, SPEC_EUSAGE,
			"%s is %s, %s %s: that quotient is nothing (--expr)", plan->name[0],
			spec_match_kind(above), plan->name[1], spec_match_kind(below));
	plan->quantity = "ratio";
	plan->role = SPEC_ROLE_REFLECTIVE;
	if (above->role == SPEC_ROLE_REFLECTIVE)
		return SPEC_OK;
	status = spec_match_quantities(&plan->input[0], &plan->input[1], plan->error);
	if (status == SPEC_OK && above->stokes > 1)
		return spec_error_set(plan->error, SPEC_EUNSUPPORTED,
			"%s has %d Stokes components, which have no quotient",
			plan->name[0], above->stokes);
	return status;
}

static enum spec_status
settle_result(struct spec_plan *plan)
{
	enum spec_role kind = plan->setup->kind;

	plan->role = plan->image[0]->role;
	switch (plan->setup->operation) {
	case SPEC_ARITHMETIC_MULTIPLY:
		return settle_product(plan);
	case SPEC_ARITHMETIC_DIVIDE:
		return settle_quotient(plan);
	case SPEC_ARITHMETIC_EXPRESSION:
		if (kind == SPEC_ROLE_OTHER || kind == plan->role)
			return SPEC_OK;
		plan->role = kind;
		plan->quantity = kind == SPEC_ROLE_EMISSIVE ? "radiance per nm" : "ratio";
		/* Light of an expression is as the first light in it. */
		for (size_t i = plan->operands; i-- > 0;) {
			if (plan->image[i]->role != kind || kind != SPEC_ROLE_EMISSIVE)
				continue;
			plan->model = i;
			plan->quantity = NULL;
		}
		return SPEC_OK;
	default:
		return SPEC_OK;
	}
}

static enum spec_sample
sample_of_bands(const struct spec_plan *plan)
{
	int half = 1;

	for (size_t i = 0; i < plan->operands; i++) {
		const struct spec_image *image = plan->image[i];

		half &= image->bands > 0 &&
			image->channel[image->band_channel[0]].sample == SPEC_SAMPLE_HALF;
	}
	return half || plan->setup->half ? SPEC_SAMPLE_HALF : SPEC_SAMPLE_FLOAT;
}

/* Variances of sums of images that all have them; those of the first alone mean nothing. */
static enum spec_status
set_variances(const struct spec_plan *plan)
{
	struct spec_image *image = &plan->arithmetic->image;
	int known = plan->operation->layers && image->stokes == 1 && image->bispectral == 0;

	for (size_t i = 0; i < plan->operands && known; i++)
		known = spec_variances_are_whole(plan->image[i]);
	return spec_variances_has_some(image)
		       ? spec_variances_renew(image, known, plan->name[0], plan->error)
		       : SPEC_OK;
}

static enum spec_status
set_bands(const struct spec_plan *plan)
{
	const struct spec_image *first = plan->image[0], *model = plan->image[plan->model];
	struct spec_image *image = &plan->arithmetic->image;
	enum spec_sample sample = sample_of_bands(plan);
	int stokes = model->role == plan->role ? model->stokes : 1;
	const double *edges_nm = model->edges_nm ? model->edges_nm : first->edges_nm;
	enum spec_status status = SPEC_OK;

	spec_image_remove_preview(image);
	if (plan->role != first->role || stokes != first->stokes) {
		spec_image_remove_bands(image);
		status = spec_image_add_bands(image, plan->role, stokes,
			first->wavelength_nm, first->bands, sample, plan->error);
	}
	for (size_t i = 0; i < image->channels; i++) {
		if (image->channel[i].role != SPEC_ROLE_OTHER)
			image->channel[i].sample = sample;
	}
	if (status == SPEC_OK)
		status = spec_image_set_bins(image, edges_nm, first->bands, plan->error);
	if (status == SPEC_OK)
		status = spec_image_rename_bands(image, plan->name[0], plan->error);
	return status == SPEC_OK ? set_variances(plan) : status;
}

static enum spec_status
set_attributes(const struct spec_plan *plan)
{
	struct spec_image *image = &plan->arithmetic->image;
	enum spec_status status =
		spec_image_set_text(image, "spectralLayoutVersion", "1.0", plan->error);

	if (status == SPEC_OK && plan->quantity)
		status = spec_image_set_text(
			image, "spec:quantity", plan->quantity, plan->error);
	if (status == SPEC_OK && plan->role == SPEC_ROLE_REFLECTIVE)
		spec_image_remove_attribute(image, "emissiveUnits");
	else if (status == SPEC_OK && !spec_image_attribute(image, "emissiveUnits"))
		status = spec_image_set_text(
			image, "emissiveUnits", "W.m^-2.sr^-1", plan->error);
	/* Light that took the place of reflectance is of another quantity than that. */
	if (status == SPEC_OK && plan->role == SPEC_ROLE_EMISSIVE && plan->model > 0 &&
		!plan->quantity) {
		char *quantity = spec_image_quantity(plan->image[plan->model], plan->error);

		status = quantity ? spec_image_set_text(
					    image, "spec:quantity", quantity, plan->error)
				  : SPEC_ENOMEM;
		free(quantity);
	}
	return status;
}

/* The commands that made every one of the images, those of equal ones once. */
static enum spec_status
join_history(const struct spec_plan *plan)
{
	char *text[SPEC_ARITHMETIC_MOST] = {NULL}, *joined = NULL;
	size_t length = 1;
	enum spec_status status = SPEC_OK;

	for (size_t i = 0; i < plan->operands && status == SPEC_OK; i++) {
		status = spec_image_text(
			plan->image[i], "spec:history", &text[i], plan->error);
		length += text[i] ? strlen(text[i]) + 1 : 0;
	}
	if (status == SPEC_OK && length > 1) {
		joined = spec_memory_new(length, 1, "bytes of history", plan->error);
		status = joined ? SPEC_OK : SPEC_ENOMEM;
	}
	for (size_t i = 0, j; joined && i < plan->operands; i++) {
		for (j = 0; j < i && text[i]; j++)
			if (text[j] && strcmp(text[j], text[i]) == 0)
				break;
		if (!text[i] || j < i || !*text[i])
			continue;
		strcat(joined, text[i]);
		if (joined[strlen(joined) - 1] != '\n')
			strcat(joined, "\n");
	}
	if (joined)
		status = spec_image_set_text(
			&plan->arithmetic->image, "spec:history", joined, plan->error);
	for (size_t i = 0; i < plan->operands; i++)
		free(text[i]);
	free(joined);
	return status;
}

static enum spec_status
make_header(const struct spec_plan *plan)
{
	struct spec_image *image = &plan->arithmetic->image;
	enum spec_status status = spec_image_copy(image, plan->image[0], plan->error);

	if (status == SPEC_OK)
		status = spec_image_index(image, plan->name[0], plan->error);
	if (status == SPEC_OK)
		status = set_bands(plan);
	if (status == SPEC_OK)
		status = set_attributes(plan);
	return status == SPEC_OK ? join_history(plan) : status;
}

/* Those that were given, or of renders their samples. */
static enum spec_status
settle_weights(struct spec_plan *plan)
{
	long long all = 0, samples;
	int known = 1, merge = plan->setup->operation == SPEC_ARITHMETIC_MERGE;
	enum spec_status status = SPEC_OK;

	plan->weight = plan->setup->weight;
	for (size_t i = 0; i < plan->operands && merge && status == SPEC_OK; i++) {
		status = spec_samples_get(
			plan->image[i], &samples, plan->name[i], plan->error);
		if (status == SPEC_OK && samples == 0 && !plan->weight)
			return spec_error_set(plan->error, SPEC_EUSAGE,
				"%s does not say its samples per pixel, spec:samples (--weight)",
				plan->name[i]);
		plan->samples[i] = (double)samples;
		known &= samples > 0;
		all += samples;
	}
	if (status != SPEC_OK)
		return status;
	if (merge && !plan->weight)
		plan->weight = plan->samples;
	return spec_samples_set(&plan->arithmetic->image, merge && known ? all : 0,
		"the merged image", plan->error);
}

enum spec_status
spec_plan_result(struct spec_plan *plan)
{
	enum spec_status status = settle_result(plan);

	if (status == SPEC_OK)
		status = make_header(plan);
	return status == SPEC_OK ? settle_weights(plan) : status;
}
