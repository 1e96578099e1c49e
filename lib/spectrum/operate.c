#include "spectrum/operate.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "base/memory.h"
#include "spectrum/common.h"
#include "spectrum/fourier.h"

static const char *const words[] = {
	"plus", "minus", "times", "divided by", "to the power of"};

#define C SPEC_SPECTRUM_CONSTANT
#define F SPEC_SPECTRUM_FOURIER
#define T SPEC_SPECTRUM_TABULATED
#define S SPEC_SPECTRUM_SAMPLED

/* By the order of enum spec_spectrum_kind. */
static const enum spec_spectrum_kind kinds[6][6] = {{C, S, S, F, T, S}, {S, S, S, S, T, S},
	{S, S, S, S, T, S}, {F, S, S, F, T, S}, {T, T, T, T, T, T}, {S, S, S, S, T, S}};

#undef C
#undef F
#undef T
#undef S

enum spec_spectrum_kind
spec_operator_kind(
	enum spec_operator op, enum spec_spectrum_kind a, enum spec_spectrum_kind b)
{
	if (op == SPEC_MULTIPLY && a == SPEC_SPECTRUM_CONSTANT)
		return b;
	if ((op == SPEC_MULTIPLY || op == SPEC_DIVIDE) && b == SPEC_SPECTRUM_CONSTANT)
		return a;
	if (kinds[a][b] == SPEC_SPECTRUM_FOURIER && op > SPEC_MULTIPLY)
		return SPEC_SPECTRUM_SAMPLED;
	return kinds[a][b];
}

static double
apply(enum spec_operator op, double a, double b)
{
	switch (op) {
	case SPEC_ADD:
		return a + b;
	case SPEC_SUBTRACT:
		return a - b;
	case SPEC_MULTIPLY:
		return a * b;
	case SPEC_DIVIDE:
		return a / b;
	case SPEC_RAISE:
		break;
	}
	return pow(a, b);
}

static enum spec_status
fail_value(enum spec_operator op, double a, double b, double nm, struct spec_error *error)
{
	return spec_error_set(error, SPEC_ERANGE, "%g %s %g, at %.10g nm, is not finite", a,
		words[op], b, nm);
}

/* ---- lines ---- */

static enum spec_status
check_lines(const struct spec_spectrum *a, enum spec_operator op,
	const struct spec_spectrum *b, struct spec_error *error)
{
	if (op == SPEC_RAISE && a->lines + b->lines > 0)
		return spec_error_set(error, SPEC_ERANGE,
			"'%.200s' to the power of '%.200s': lines have no powers and are "
			"none",
			a->title, b->title);
	if (op == SPEC_DIVIDE && b->lines > 0)
		return spec_error_set(error, SPEC_ERANGE,
			"'%.200s' cannot be divided by '%.200s', which has lines", a->title,
			b->title);
	if (op != SPEC_MULTIPLY)
		return SPEC_OK;
	for (size_t i = 0, k = 0; i < a->lines && k < b->lines;) {
		double one_nm = a->line[i].wavelength_nm, two_nm = b->line[k].wavelength_nm;

		if (one_nm == two_nm)
			return spec_error_set(error, SPEC_ERANGE,
				"'%.200s' times '%.200s': both have a line at %.10g nm, "
				"and the product of two lines has no meaning",
				a->title, b->title, one_nm);
		i += one_nm < two_nm;
		k += two_nm < one_nm;
	}
	return SPEC_OK;
}

/* Adds the lines of one operand, times or over the other's smooth part. */
static enum spec_status
take_lines(const struct spec_spectrum *from, enum spec_operator op,
	const struct spec_spectrum *other, enum spec_extrapolate extrapolate,
	struct spec_spectrum *result, struct spec_error *error)
{
	enum spec_status status = SPEC_OK;

	for (size_t i = 0; i < from->lines && status == SPEC_OK; i++) {
		struct spec_line line = from->line[i];
		double factor, nm = line.wavelength_nm;

		if (op == SPEC_MULTIPLY || op == SPEC_DIVIDE) {
			if (extrapolate == SPEC_EXTRAPOLATE_REFUSE &&
				(nm < other->low_nm || nm > other->high_nm))
				continue;
			status = spec_spectrum_sample(
				other, extrapolate, &nm, 1, &factor, error);
			if (status != SPEC_OK)
				return status;
			line.weight = apply(op, line.weight, factor);
			if (!isfinite(line.weight))
				return fail_value(
					op, from->line[i].weight, factor, nm, error);
		}
		status = spec_spectrum_add_lines(result, &line, 1, error);
	}
	return status;
}

static enum spec_status
combine_lines(const struct spec_spectrum *a, enum spec_operator op,
	const struct spec_spectrum *b, enum spec_extrapolate extrapolate,
	struct spec_spectrum *result, struct spec_error *error)
{
	struct spec_spectrum negative;
	enum spec_status status = take_lines(a, op, b, extrapolate, result, error);

	if (status != SPEC_OK || op != SPEC_SUBTRACT)
		return status == SPEC_OK ? take_lines(b, op, a, extrapolate, result, error)
					 : status;
	status = spec_spectrum_copy(b, &negative, error);
	if (status != SPEC_OK)
		return status;
	for (size_t i = 0; i < negative.lines; i++)
		negative.line[i].weight *= -1;
	status = take_lines(&negative, op, a, extrapolate, result, error);
	spec_spectrum_free(&negative);
	return status;
}

/* ---- kinds that stay ---- */

static int
has_numbers(const struct spec_spectrum *spectrum)
{
	return spectrum->count > 0;
}

/* A spectrum times or over a constant: its kind stays. */
static enum spec_status
scale(const struct spec_spectrum *spectrum, enum spec_operator op, double factor,
	struct spec_spectrum *result, struct spec_error *error)
{
	enum spec_status status = spec_spectrum_copy(spectrum, result, error);
	double nm = spectrum->low_nm;

	if (status != SPEC_OK)
		return status;
	result->lines = 0;
	result->level = apply(op, spectrum->level, factor);
	result->sigmoid.scale = apply(op, spectrum->sigmoid.scale, factor);
	for (int i = 0; i < 3; i++)
		result->rgb[i] = apply(op, spectrum->rgb[i], factor);
	if (!isfinite(result->level) || !isfinite(result->sigmoid.scale))
		return fail_value(op, spectrum->level, factor,
			has_numbers(spectrum) ? nm : SPEC_SPECTRUM_LOW_NM, error);
	for (size_t i = 0; i < result->count; i++) {
		result->value[i] = apply(op, spectrum->value[i], factor);
		if (result->wavelength_nm)
			nm = result->wavelength_nm[i];
		if (!isfinite(result->value[i]))
			return fail_value(op, spectrum->value[i], factor, nm, error);
	}
	return SPEC_OK;
}

/* The coefficients of a series or a constant, as those of a series. */
static void
coefficients_of(const struct spec_spectrum *spectrum, double *constant,
	const double **coefficient, size_t *count)
{
	int series = spectrum->smooth == SPEC_SPECTRUM_FOURIER;

	*constant = 2 * spectrum->level;
	*coefficient = series ? spectrum->value : constant;
	*count = series ? spectrum->count : 1;
}

static enum spec_status
combine_series(const struct spec_spectrum *a, enum spec_operator op,
	const struct spec_spectrum *b, struct spec_spectrum *result,
	struct spec_error *error)
{
	const struct spec_spectrum *series = a->smooth == SPEC_SPECTRUM_FOURIER ? a : b;
	size_t a_count, b_count, count;
	double a_level, b_level, *coefficient;
	const double *a_value, *b_value;
	enum spec_status status;

	coefficients_of(a, &a_level, &a_value, &a_count);
	coefficients_of(b, &b_level, &b_value, &b_count);
	count = op == SPEC_MULTIPLY ? a_count + b_count - 1
		: a_count > b_count ? a_count
				    : b_count;
	if (count > SPEC_SPECTRUM_MOST_COEFFICIENTS)
		return spec_error_set(error, SPEC_ERANGE,
			"'%.200s' times '%.200s' has %zu Fourier coefficients, more than "
			"%d",
			a->title, b->title, count, SPEC_SPECTRUM_MOST_COEFFICIENTS);
	coefficient = spec_memory_new(count, sizeof *coefficient, "coefficients", error);
	if (!coefficient)
		return SPEC_ENOMEM;
	if (op == SPEC_MULTIPLY)
		spec_series_multiply(a_value, a_count, b_value, b_count, coefficient);
	else
		for (size_t i = 0; i < count; i++)
			coefficient[i] = apply(op, i < a_count ? a_value[i] : 0,
				i < b_count ? b_value[i] : 0);
	status = spec_spectrum_fourier(
		series->low_nm, series->high_nm, coefficient, count, result, error);
	free(coefficient);
	return status;
}

/* ---- at wavelengths ---- */

/* Between the samples of the result: as in its tables, where they agree and it can be. */
static enum spec_interpolate
choose_rule(const struct spec_spectrum *a, const struct spec_spectrum *b,
	const struct spec_grid *wavelengths)
{
	const struct spec_spectrum *table = a->wavelength_nm ? a : b;
	struct spec_samples samples = {wavelengths->wavelength_nm,
		wavelengths->wavelength_nm, wavelengths->count, table->interpolate};

	if (!table->wavelength_nm ||
		(b->wavelength_nm && b->interpolate != table->interpolate) ||
		spec_samples_check(&samples, NULL) != SPEC_OK)
		return SPEC_INTERPOLATE_LINEAR;
	return table->interpolate;
}

static enum spec_status
make_table(enum spec_spectrum_kind kind, const struct spec_grid *wavelengths,
	const double *value, enum spec_interpolate rule, struct spec_spectrum *result,
	struct spec_error *error)
{
	size_t count = wavelengths->count;
	enum spec_status status = spec_spectrum_tabulated(
		wavelengths->wavelength_nm, value, count, rule, result, error);

	/* One sample has no step. */
	if (status == SPEC_OK && kind == SPEC_SPECTRUM_SAMPLED && count > 1)
		result->smooth = SPEC_SPECTRUM_SAMPLED;
	return status;
}

static enum spec_status
combine_values(const struct spec_spectrum *a, enum spec_operator op,
	const struct spec_spectrum *b, enum spec_extrapolate extrapolate,
	const struct spec_grid *wavelengths, struct spec_spectrum *result,
	struct spec_error *error)
{
	size_t count = wavelengths->count;
	double *one = spec_memory_new(count, sizeof *one, "values", error);
	double *two = spec_memory_new(count, sizeof *two, "values", error);
	enum spec_spectrum_kind kind = spec_operator_kind(op, a->smooth, b->smooth);
	enum spec_status status = one && two ? SPEC_OK : SPEC_ENOMEM;

	if (kind == SPEC_SPECTRUM_FOURIER)
		kind = SPEC_SPECTRUM_SAMPLED; /* of two ranges */
	if (status == SPEC_OK)
		status = spec_spectrum_sample(
			a, extrapolate, wavelengths->wavelength_nm, count, one, error);
	if (status == SPEC_OK)
		status = spec_spectrum_sample(
			b, extrapolate, wavelengths->wavelength_nm, count, two, error);
	for (size_t i = 0; i < count && status == SPEC_OK; i++) {
		double value = apply(op, one[i], two[i]);

		if (!isfinite(value))
			status = fail_value(
				op, one[i], two[i], wavelengths->wavelength_nm[i], error);
		one[i] = value;
	}
	if (status == SPEC_OK)
		status = make_table(kind, wavelengths, one, choose_rule(a, b, wavelengths),
			result, error);
	free(one);
	free(two);
	return status;
}

/* ---- all ---- */

static int
is_scaling(
	const struct spec_spectrum *a, enum spec_operator op, const struct spec_spectrum *b)
{
	return (op == SPEC_MULTIPLY && a->smooth == SPEC_SPECTRUM_CONSTANT) ||
	       ((op == SPEC_MULTIPLY || op == SPEC_DIVIDE) &&
		       b->smooth == SPEC_SPECTRUM_CONSTANT);
}

static int
is_series(
	const struct spec_spectrum *a, enum spec_operator op, const struct spec_spectrum *b)
{
	int both = a->smooth == SPEC_SPECTRUM_FOURIER && b->smooth == SPEC_SPECTRUM_FOURIER;

	if (both && (a->low_nm != b->low_nm || a->high_nm != b->high_nm))
		return 0;
	return spec_operator_kind(op, a->smooth, b->smooth) == SPEC_SPECTRUM_FOURIER;
}

static enum spec_status
combine_smooth(const struct spec_spectrum *a, enum spec_operator op,
	const struct spec_spectrum *b, enum spec_extrapolate extrapolate,
	struct spec_spectrum *result, struct spec_error *error)
{
	struct spec_grid wavelengths = {0};
	enum spec_status status;
	double value;

	if (is_scaling(a, op, b))
		return b->smooth == SPEC_SPECTRUM_CONSTANT
			       ? scale(a, op, b->level, result, error)
			       : scale(b, op, a->level, result, error);
	if (is_series(a, op, b))
		return combine_series(a, op, b, result, error);
	if (a->smooth == SPEC_SPECTRUM_CONSTANT && b->smooth == SPEC_SPECTRUM_CONSTANT) {
		value = apply(op, a->level, b->level);
		return isfinite(value) ? spec_spectrum_constant(value, result, error)
				       : fail_value(op, a->level, b->level,
						 SPEC_SPECTRUM_LOW_NM, error);
	}
	status = spec_spectrum_common(a, b, extrapolate, &wavelengths, error);
	if (status == SPEC_OK)
		status = combine_values(a, op, b, extrapolate, &wavelengths, result, error);
	spec_grid_free(&wavelengths);
	return status;
}

static enum spec_status
combine(const struct spec_spectrum *a, enum spec_operator op, const struct spec_spectrum *b,
	enum spec_extrapolate extrapolate, struct spec_spectrum *result,
	struct spec_error *error)
{
	enum spec_status status = check_lines(a, op, b, error);

	*result = (struct spec_spectrum){0};
	if (status == SPEC_OK)
		status = combine_smooth(a, op, b, extrapolate, result, error);
	if (status == SPEC_OK)
		status = combine_lines(a, op, b, extrapolate, result, error);
	return status;
}

/* What the result is. */
static const char *
choose_quantity(
	const struct spec_spectrum *a, enum spec_operator op, const struct spec_spectrum *b)
{
	struct spec_curve one = {.quantity = a->quantity}, two = {.quantity = b->quantity};

	if (op <= SPEC_SUBTRACT)
		return strcmp(a->quantity, b->quantity) == 0 ? a->quantity : "";
	if (op == SPEC_MULTIPLY && spec_curve_is_ratio(&one))
		return spec_curve_is_ratio(&two) ? a->quantity : b->quantity;
	if (op <= SPEC_DIVIDE && !spec_curve_is_ratio(&one) && spec_curve_is_ratio(&two))
		return a->quantity;
	return "";
}

static enum spec_status
name_result(const struct spec_spectrum *a, enum spec_operator op,
	const struct spec_spectrum *b, struct spec_spectrum *result,
	struct spec_error *error)
{
	int same_unit = op <= SPEC_SUBTRACT && strcmp(a->unit, b->unit) == 0;
	enum spec_status status =
		spec_curve_set_text(&result->quantity, choose_quantity(a, op, b), error);
	char between[24];

	snprintf(between, sizeof between, " %s ", words[op]);
	if (status == SPEC_OK)
		status =
			spec_curve_set_text(&result->unit, same_unit ? a->unit : "", error);
	if (status == SPEC_OK)
		status = spec_curve_set_text(&result->medium,
			strcmp(a->medium, b->medium) == 0 ? a->medium : "", error);
	if (status == SPEC_OK)
		status = spec_curve_join_texts(
			&result->title, a->title, between, b->title, error);
	return status == SPEC_OK ? spec_curve_join_texts(&result->source, a->source, "; ",
					   b->source, error)
				 : status;
}

enum spec_status
spec_spectrum_combine(const struct spec_spectrum *a, enum spec_operator op,
	const struct spec_spectrum *b, enum spec_extrapolate extrapolate,
	struct spec_spectrum *result, struct spec_error *error)
{
	enum spec_status status = combine(a, op, b, extrapolate, result, error);

	if (status == SPEC_OK)
		status = name_result(a, op, b, result, error);
	if (status != SPEC_OK)
		spec_spectrum_free(result);
	return status;
}

enum spec_status
spec_spectrum_combine_number(const struct spec_spectrum *a, enum spec_operator op,
	double number, struct spec_spectrum *result, struct spec_error *error)
{
	struct spec_spectrum constant;
	enum spec_status status = spec_spectrum_constant(number, &constant, error);

	*result = (struct spec_spectrum){0};
	if (status == SPEC_OK)
		status = combine(a, op, &constant, SPEC_EXTRAPOLATE_REFUSE, result, error);
	if (status == SPEC_OK)
		status = spec_spectrum_copy_texts(a, result, error);
	/* It was of other numbers. */
	if (status == SPEC_OK && op > SPEC_SUBTRACT && number != 1)
		status = spec_curve_set_text(&result->unit, "", error);
	if (status == SPEC_OK && op == SPEC_RAISE && number != 1)
		status = spec_curve_set_text(&result->quantity, "", error);
	spec_spectrum_free(&constant);
	if (status != SPEC_OK)
		spec_spectrum_free(result);
	return status;
}

enum spec_status
spec_spectrum_negate(const struct spec_spectrum *spectrum, struct spec_spectrum *result,
	struct spec_error *error)
{
	enum spec_status status =
		spec_spectrum_combine_number(spectrum, SPEC_MULTIPLY, -1, result, error);

	if (status == SPEC_OK)
		status = spec_curve_set_text(&result->unit, spectrum->unit, error);
	if (status != SPEC_OK)
		spec_spectrum_free(result);
	return status;
}
