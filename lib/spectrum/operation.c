#include "spectrum/operation.h"

#include <math.h>
#include <string.h>

#include "base/memory.h"
#include "base/number.h"
#include "spectrum/lookup.h"
#include "spectrum/product.h"

static const char *const names[] = {
	[SPEC_OPERATION_MULTIPLY] = "multiply",
	[SPEC_OPERATION_DIVIDE] = "divide",
	[SPEC_OPERATION_ADD] = "add",
	[SPEC_OPERATION_SCALE] = "scale",
	[SPEC_OPERATION_RAISE] = "raise",
	[SPEC_OPERATION_CLAMP] = "clamp",
	[SPEC_OPERATION_ILLUMINATE] = "illuminate",
	[SPEC_OPERATION_REFLECTANCE_OF] = "reflectance-of",
};

int
spec_operation_defer(
	const char *option, const char *value, struct spec_operation *operation)
{
	int lights = strcmp(option, names[SPEC_OPERATION_ILLUMINATE]) == 0;

	if (!lights && strcmp(option, names[SPEC_OPERATION_REFLECTANCE_OF]) != 0)
		return 0;
	*operation = (struct spec_operation){
		.kind = lights ? SPEC_OPERATION_ILLUMINATE : SPEC_OPERATION_REFLECTANCE_OF,
		.value = value,
		.deferred = 1};
	return 1;
}

enum spec_status
spec_operation_parse(const char *option, const char *value,
	struct spec_operation *operation, int *known, struct spec_error *error)
{
	size_t kind = 0, kinds = sizeof names / sizeof *names;

	*operation = (struct spec_operation){0};
	while (kind < kinds && strcmp(option, names[kind]) != 0)
		kind++;
	*known = kind < kinds;
	operation->kind = *known ? (enum spec_operation_kind)kind : 0;
	operation->value = value;
	if (!*known)
		return SPEC_OK;
	switch (operation->kind) {
	case SPEC_OPERATION_SCALE:
		return spec_number_parse(
			value, -1e30, 1e30, "the scale", &operation->number, error);
	case SPEC_OPERATION_RAISE:
		return spec_number_parse(
			value, -1e3, 1e3, "the power", &operation->number, error);
	case SPEC_OPERATION_CLAMP:
		return spec_number_parse_range(
			value, &operation->low, &operation->high, error);
	case SPEC_OPERATION_ILLUMINATE:
	case SPEC_OPERATION_REFLECTANCE_OF:
		return spec_lookup_light(value, &operation->curve, error);
	default:
		return spec_lookup_factor(value, &operation->curve, error);
	}
}

void
spec_operation_free(struct spec_operation *operation)
{
	spec_curve_free(&operation->curve);
	*operation = (struct spec_operation){0};
}

const char *
spec_operation_name(const struct spec_operation *operation)
{
	const char *title = operation->curve.title;

	return (title && *title) || !operation->value ? spec_curve_name(&operation->curve)
						      : operation->value;
}

int
spec_operation_is_affine(const struct spec_operation *operation)
{
	return operation->kind != SPEC_OPERATION_RAISE &&
	       operation->kind != SPEC_OPERATION_CLAMP;
}

/* What becomes of a value, by an operation without a curve. */
static double
change(const struct spec_operation *operation, double value)
{
	if (operation->kind == SPEC_OPERATION_SCALE)
		return value * operation->number;
	if (operation->kind == SPEC_OPERATION_RAISE)
		return pow(value, operation->number);
	return fmin(fmax(value, operation->low), operation->high);
}

static enum spec_status
change_all(const struct spec_operation *operation, struct spec_curve *curve,
	struct spec_error *error)
{
	size_t count = curve->count * curve->columns;
	enum spec_status status = SPEC_OK;

	for (size_t i = 0; i < count; i++) {
		if (!isfinite(change(operation, curve->value[i])))
			return spec_error_set(error, SPEC_ERANGE,
				"'%.200s' is %g at %.10g nm: the result is not finite",
				spec_curve_name(curve), curve->value[i],
				curve->wavelength_nm[i % curve->count]);
	}
	/* They were those of other numbers. */
	if ((operation->kind == SPEC_OPERATION_SCALE ||
		    operation->kind == SPEC_OPERATION_RAISE) &&
		operation->number != 1)
		status = spec_curve_set_text(&curve->unit, "", error);
	if (status == SPEC_OK && operation->kind == SPEC_OPERATION_RAISE &&
		operation->number != 1 && !spec_curve_is_ratio(curve))
		status = spec_curve_set_text(&curve->quantity, "", error);
	for (size_t i = 0; i < count && status == SPEC_OK; i++)
		curve->value[i] = change(operation, curve->value[i]);
	return status;
}

enum spec_status
spec_operation_apply(const struct spec_operation *operation, struct spec_curve *curve,
	struct spec_error *error)
{
	struct spec_curve next;
	enum spec_status status;

	switch (operation->kind) {
	case SPEC_OPERATION_MULTIPLY:
		status = spec_curve_multiply(curve, &operation->curve, &next, error);
		break;
	case SPEC_OPERATION_DIVIDE:
		status = spec_curve_divide(curve, &operation->curve, &next, error);
		break;
	case SPEC_OPERATION_ADD:
		status = spec_curve_add(curve, &operation->curve, &next, error);
		break;
	case SPEC_OPERATION_ILLUMINATE:
	case SPEC_OPERATION_REFLECTANCE_OF:
		return spec_error_set(error, SPEC_EUNSUPPORTED,
			"--illuminate and --reflectance-of are for images, not for curves");
	default:
		return change_all(operation, curve, error);
	}
	if (status == SPEC_OK) {
		spec_curve_free(curve);
		*curve = next;
	}
	return status;
}
