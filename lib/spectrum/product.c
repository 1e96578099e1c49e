#include "spectrum/product.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "base/memory.h"

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

/* Sets a text to one, between and two. */
static enum spec_status
join(char **field, const char *one, const char *between, const char *two,
	struct spec_error *error)
{
	size_t size = strlen(one) + strlen(between) + strlen(two) + 1;
	char *text = spec_memory_new(size, 1, "bytes of text", error);
	enum spec_status status = text ? SPEC_OK : SPEC_ENOMEM;

	if (text) {
		snprintf(text, size, "%s%s%s", one, *one && *two ? between : "", two);
		status = spec_curve_set_text(field, text, error);
	}
	free(text);
	return status;
}

/* What the product of two curves is. */
static enum spec_status
name_product(const struct spec_curve *a, const struct spec_curve *b,
	struct spec_curve *result, struct spec_error *error)
{
	const char *quantity = "";
	enum spec_status status;

	if (spec_curve_is_ratio(a))
		quantity = spec_curve_is_ratio(b) ? a->quantity : b->quantity;
	else if (spec_curve_is_ratio(b))
		quantity = a->quantity;
	status = spec_curve_set_text(&result->quantity, quantity, error);
	if (status == SPEC_OK)
		status = spec_curve_set_text(&result->unit, "", error);
	if (status == SPEC_OK)
		status = join(&result->title, a->title, " times ", b->title, error);
	return status == SPEC_OK ? join(&result->source, a->source, "; ", b->source, error)
				 : status;
}

enum spec_status
spec_curve_multiply(const struct spec_curve *a, const struct spec_curve *b,
	struct spec_curve *result, struct spec_error *error)
{
	size_t count = merge(a, b, NULL);
	enum spec_status status;
	double *factor;

	if (count == 0)
		return spec_error_set(error, SPEC_ERANGE,
			"'%s' (%g..%g nm) and '%s' (%g..%g nm) do not meet", a->title,
			a->wavelength_nm[0], a->wavelength_nm[a->count - 1], b->title,
			b->wavelength_nm[0], b->wavelength_nm[b->count - 1]);
	status = spec_curve_new(count, a->columns, result, error);
	if (status != SPEC_OK)
		return status;
	merge(a, b, result->wavelength_nm);
	status = sample_all(a, SPEC_EXTRAPOLATE_REFUSE, result, error);
	factor = calloc(count, sizeof *factor);
	if (!factor)
		status = spec_error_set(
			error, SPEC_ENOMEM, "out of memory for %zu values", count);
	if (status == SPEC_OK)
		status = spec_curve_sample(b, 0, SPEC_EXTRAPOLATE_REFUSE,
			result->wavelength_nm, count, factor, error);
	if (status == SPEC_OK)
		status = name_product(a, b, result, error);
	for (size_t i = 0; i < count * a->columns && status == SPEC_OK; i++)
		result->value[i] *= factor[i % count];
	free(factor);
	if (status != SPEC_OK)
		spec_curve_free(result);
	return status;
}
