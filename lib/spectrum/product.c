#include "spectrum/product.h"

#include <stdlib.h>
#include <string.h>

#include "base/memory.h"
#include "spectrum/weights.h"

static enum spec_status
copy_texts(const struct spec_curve *from, struct spec_curve *to, struct spec_error *error)
{
	char **target[] = {&to->title, &to->quantity, &to->unit, &to->source, &to->medium};
	const char *text[] = {
		from->title, from->quantity, from->unit, from->source, from->medium};
	enum spec_status status = SPEC_OK;

	for (size_t i = 0; i < sizeof text / sizeof text[0] && status == SPEC_OK; i++)
		status = spec_curve_set_text(target[i], text[i], error);
	for (size_t i = 0; i < from->columns && status == SPEC_OK; i++)
		status = spec_curve_set_text(&to->column[i], from->column[i], error);
	return status;
}

static enum spec_status
sample_all(const struct spec_curve *curve, enum spec_extrapolate extrapolate,
	struct spec_curve *result, struct spec_error *error)
{
	enum spec_status status = copy_texts(curve, result, error);

	for (size_t i = 0; i < curve->columns && status == SPEC_OK; i++)
		status = spec_curve_sample(curve, i, extrapolate, result->wavelength_nm,
			result->count, result->value + i * result->count, error);
	return status;
}

enum spec_status
spec_curve_resample(const struct spec_curve *curve, const struct spec_grid *grid,
	enum spec_extrapolate extrapolate, struct spec_curve *result,
	struct spec_error *error)
{
	enum spec_status status =
		spec_curve_new(grid->count, curve->columns, result, error);

	if (status != SPEC_OK)
		return status;
	for (size_t i = 0; i < grid->count; i++)
		result->wavelength_nm[i] = grid->wavelength_nm[i];
	status = sample_all(curve, extrapolate, result, error);
	if (status != SPEC_OK)
		spec_curve_free(result);
	return status;
}

enum spec_status
spec_curve_resample_by(enum spec_interpolate rule, const struct spec_curve *curve,
	const struct spec_grid *grid, enum spec_extrapolate extrapolate,
	struct spec_curve *result, struct spec_error *error)
{
	double first_nm = curve->wavelength_nm[0];
	double last_nm = curve->wavelength_nm[curve->count - 1];
	enum spec_status status =
		spec_weights_check(rule, curve->wavelength_nm, curve->count, error);

	*result = (struct spec_curve){0};
	if (status == SPEC_OK)
		status = spec_curve_resample(curve, grid, extrapolate, result, error);
	if (status != SPEC_OK || rule == SPEC_INTERPOLATE_LINEAR)
		return status;
	for (size_t i = 0; i < grid->count; i++) {
		double nm = grid->wavelength_nm[i];
		struct spec_weights weights;

		if (nm <= first_nm || nm >= last_nm)
			continue; /* an end, or extrapolated: every rule has the same */
		weights = spec_weights_at(rule, curve->wavelength_nm, curve->count, nm);
		for (size_t j = 0; j < curve->columns; j++) {
			const double *from =
				curve->value + j * curve->count + weights.first;
			double sum = 0;

			for (size_t k = 0; k < weights.count; k++)
				sum += weights.weight[k] * from[k];
			result->value[j * grid->count + i] = sum;
		}
	}
	return SPEC_OK;
}

/* The wavelengths of both in their common range, each once; into list where it is not null. */
static size_t
merge(const struct spec_curve *a, const struct spec_curve *b, double *list)
{
	double low = a->wavelength_nm[0] > b->wavelength_nm[0] ? a->wavelength_nm[0]
							       : b->wavelength_nm[0];
	double last_a = a->wavelength_nm[a->count - 1],
	       last_b = b->wavelength_nm[b->count - 1];
	double high = last_a < last_b ? last_a : last_b;
	size_t i = 0, j = 0, count = 0;

	while (i < a->count || j < b->count) {
		double next;

		if (j == b->count ||
			(i < a->count && a->wavelength_nm[i] <= b->wavelength_nm[j]))
			next = a->wavelength_nm[i];
		else
			next = b->wavelength_nm[j];
		i += i < a->count && a->wavelength_nm[i] == next;
		j += j < b->count && b->wavelength_nm[j] == next;
		if (next < low || next > high)
			continue;
		if (list)
			list[count] = next;
		count++;
	}
	return count;
}

enum how { MULTIPLY, DIVIDE, ADD };

static int
is_stated(const struct spec_curve *curve)
{
	return curve->quantity[0] != '\0';
}

/* Whether b can be added to a, as product.h has it; the error says why not. */
static enum spec_status
check_sum(const struct spec_curve *a, const struct spec_curve *b, struct spec_error *error)
{
	int same = !is_stated(a) || !is_stated(b) ||
		   (spec_curve_is_light(a) && spec_curve_is_light(b)) ||
		   (spec_curve_is_ratio(a) && spec_curve_is_ratio(b)) ||
		   strcmp(a->quantity, b->quantity) == 0;

	if (!same)
		return spec_error_set(error, SPEC_EUSAGE,
			"'%.200s' is a %.200s, '%.200s' a %.200s: they cannot be added",
			spec_curve_name(a), a->quantity, spec_curve_name(b), b->quantity);
	if (*a->unit && *b->unit && strcmp(a->unit, b->unit) != 0)
		return spec_error_set(error, SPEC_EUSAGE,
			"'%.200s' is in %.100s, '%.200s' in %.100s: they cannot be added",
			spec_curve_name(a), a->unit, spec_curve_name(b), b->unit);
	return SPEC_OK;
}

static const char *
quantity_of(enum how how, const struct spec_curve *a, const struct spec_curve *b)
{
	if (how == ADD)
		return is_stated(a) ? a->quantity : b->quantity;
	if (spec_curve_is_ratio(b))
		return spec_curve_is_ratio(a) || spec_curve_is_light(a) ? a->quantity : "";
	if (how == MULTIPLY && spec_curve_is_ratio(a))
		return b->quantity;
	return "";
}

/* What the result of two curves is. */
static enum spec_status
name_result(enum how how, const struct spec_curve *a, const struct spec_curve *b,
	struct spec_curve *result, struct spec_error *error)
{
	static const char *const between[] = {" times ", " over ", " plus "};
	const char *unit = "";
	enum spec_status status;

	if (how == ADD)
		unit = *a->unit ? a->unit : b->unit;
	status = spec_curve_set_text(&result->quantity, quantity_of(how, a, b), error);
	if (status == SPEC_OK)
		status = spec_curve_set_text(&result->unit, unit, error);
	if (status == SPEC_OK)
		status = spec_curve_join_texts(
			&result->title, a->title, between[how], b->title, error);
	return status == SPEC_OK ? spec_curve_join_texts(&result->source, a->source, "; ",
					   b->source, error)
				 : status;
}

/* value: the result's, of a alone so far; other: b's at its wavelengths. */
static enum spec_status
combine_values(enum how how, const double *other, const char *title,
	struct spec_curve *result, struct spec_error *error)
{
	for (size_t i = 0; i < result->count * result->columns; i++) {
		double b = other[i % result->count], *value = &result->value[i];

		if (how == DIVIDE && b == 0)
			return spec_error_set(error, SPEC_ERANGE,
				"unable to divide by '%.200s': it is 0 at %.10g nm", title,
				result->wavelength_nm[i % result->count]);
		*value = how == MULTIPLY ? *value * b
			 : how == DIVIDE ? *value / b
					 : *value + b;
	}
	return SPEC_OK;
}

static enum spec_status
combine(enum how how, const struct spec_curve *a, const struct spec_curve *b,
	struct spec_curve *result, struct spec_error *error)
{
	size_t count = merge(a, b, NULL);
	enum spec_status status;
	double *other;

	if (count == 0)
		return spec_error_set(error, SPEC_ERANGE,
			"'%s' (%g..%g nm) and '%s' (%g..%g nm) do not meet",
			spec_curve_name(a), a->wavelength_nm[0],
			a->wavelength_nm[a->count - 1], spec_curve_name(b),
			b->wavelength_nm[0], b->wavelength_nm[b->count - 1]);
	status = spec_curve_new(count, a->columns, result, error);
	if (status != SPEC_OK)
		return status;
	merge(a, b, result->wavelength_nm);
	status = sample_all(a, SPEC_EXTRAPOLATE_REFUSE, result, error);
	other = spec_memory_new(count, sizeof *other, "values", error);
	if (!other)
		status = SPEC_ENOMEM;
	if (status == SPEC_OK)
		status = spec_curve_sample(b, 0, SPEC_EXTRAPOLATE_REFUSE,
			result->wavelength_nm, count, other, error);
	if (status == SPEC_OK)
		status = name_result(how, a, b, result, error);
	if (status == SPEC_OK)
		status = combine_values(how, other, spec_curve_name(b), result, error);
	free(other);
	if (status != SPEC_OK)
		spec_curve_free(result);
	return status;
}

enum spec_status
spec_curve_multiply(const struct spec_curve *a, const struct spec_curve *b,
	struct spec_curve *result, struct spec_error *error)
{
	return combine(MULTIPLY, a, b, result, error);
}

enum spec_status
spec_curve_divide(const struct spec_curve *a, const struct spec_curve *b,
	struct spec_curve *result, struct spec_error *error)
{
	return combine(DIVIDE, a, b, result, error);
}

enum spec_status
spec_curve_add(const struct spec_curve *a, const struct spec_curve *b,
	struct spec_curve *result, struct spec_error *error)
{
	enum spec_status status = check_sum(a, b, error);

	return status == SPEC_OK ? combine(ADD, a, b, result, error) : status;
}
