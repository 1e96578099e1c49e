#include "spectrum/curve.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "base/interval.h"
#include "base/memory.h"

#define END_SLACK 1e-9 /* relative: rounding in a wavelength is no extrapolation */

enum spec_status
spec_curve_set_text(char **field, const char *text, struct spec_error *error)
{
	char *copy = spec_memory_text(text, strlen(text), error);

	if (!copy)
		return SPEC_ENOMEM;
	free(*field);
	*field = copy;
	return SPEC_OK;
}

enum spec_status
spec_curve_join_texts(char **field, const char *one, const char *between, const char *other,
	struct spec_error *error)
{
	size_t size = strlen(one) + strlen(between) + strlen(other) + 1;
	char *text = spec_memory_new(size, 1, "bytes of text", error);

	if (!text)
		return SPEC_ENOMEM;
	snprintf(text, size, "%s%s%s", one, *one && *other ? between : "", other);
	free(*field);
	*field = text;
	return SPEC_OK;
}

static enum spec_status
name_columns(struct spec_curve *curve, struct spec_error *error)
{
	enum spec_status status = SPEC_OK;

	for (size_t i = 0; status == SPEC_OK && i < curve->columns; i++) {
		char name[32] = "value";

		if (curve->columns > 1)
			snprintf(name, sizeof name, "value%zu", i + 1);
		status = spec_curve_set_text(&curve->column[i], name, error);
	}
	return status;
}

enum spec_status
spec_extrapolate_parse(const char *text, int zero, enum spec_extrapolate *extrapolate,
	struct spec_error *error)
{
	static const char *const names[] = {[SPEC_EXTRAPOLATE_REFUSE] = "refuse",
		[SPEC_EXTRAPOLATE_ZERO] = "zero",
		[SPEC_EXTRAPOLATE_CONSTANT] = "constant"};

	for (int i = 0; i < 3; i++) {
		if (strcmp(text, names[i]) == 0 && (zero || i != SPEC_EXTRAPOLATE_ZERO)) {
			*extrapolate = (enum spec_extrapolate)i;
			return SPEC_OK;
		}
	}
	return spec_error_set(error, SPEC_EUSAGE, "'%s' is not refuse%s constant", text,
		zero ? ", zero or" : " or");
}

enum spec_status
spec_curve_new(
	size_t count, size_t columns, struct spec_curve *curve, struct spec_error *error)
{
	char **texts[] = {&curve->title, &curve->quantity, &curve->unit, &curve->source,
		&curve->medium};
	enum spec_status status = SPEC_OK;

	*curve = (struct spec_curve){0};
	if (count == 0 || columns == 0)
		return spec_error_set(
			error, SPEC_ERANGE, "a curve needs a sample and a column");
	curve->column = spec_memory_new(columns, sizeof *curve->column, "columns", error);
	if (curve->column) {
		curve->columns = columns;
		curve->wavelength_nm =
			spec_memory_new(count, sizeof(double), "wavelengths", error);
	}
	if (curve->wavelength_nm && columns > (size_t)-1 / count)
		spec_error_set(
			error, SPEC_ENOMEM, "out of memory for %zu columns", columns);
	else if (curve->wavelength_nm)
		curve->value =
			spec_memory_new(count * columns, sizeof(double), "values", error);
	curve->count = count;
	if (!curve->value)
		status = SPEC_ENOMEM;
	for (size_t i = 0; status == SPEC_OK && i < sizeof texts / sizeof texts[0]; i++)
		status = spec_curve_set_text(texts[i], "", error);
	if (status == SPEC_OK)
		status = name_columns(curve, error);
	if (status != SPEC_OK)
		spec_curve_free(curve);
	return status;
}

enum spec_status
spec_curve_copy(
	const struct spec_curve *source, struct spec_curve *copy, struct spec_error *error)
{
	enum spec_status status =
		spec_curve_new(source->count, source->columns, copy, error);
	const char *from[] = {source->title, source->quantity, source->unit, source->source,
		source->medium};
	char **to[] = {
		&copy->title, &copy->quantity, &copy->unit, &copy->source, &copy->medium};

	if (status != SPEC_OK)
		return status;
	memcpy(copy->wavelength_nm, source->wavelength_nm,
		source->count * sizeof *source->wavelength_nm);
	memcpy(copy->value, source->value,
		source->count * source->columns * sizeof *source->value);
	for (size_t i = 0; status == SPEC_OK && i < sizeof to / sizeof to[0]; i++)
		status = spec_curve_set_text(to[i], from[i], error);
	for (size_t i = 0; status == SPEC_OK && i < source->columns; i++)
		status = spec_curve_set_text(&copy->column[i], source->column[i], error);
	if (status != SPEC_OK)
		spec_curve_free(copy);
	return status;
}

size_t
spec_curve_find_column(const struct spec_curve *curve, const char *name)
{
	size_t i = 0;

	while (i < curve->columns && strcmp(curve->column[i], name) != 0)
		i++;
	return i;
}

static enum spec_status
refuse(const struct spec_curve *curve, double wavelength_nm, struct spec_error *error)
{
	return spec_error_set(error, SPEC_ERANGE,
		"%s%.200s%s covers %.10g..%.10g nm, not %.10g nm", *curve->title ? "'" : "",
		*curve->title ? curve->title : "the curve", *curve->title ? "'" : "",
		curve->wavelength_nm[0], curve->wavelength_nm[curve->count - 1],
		wavelength_nm);
}

static double
interpolate(const struct spec_curve *curve, const double *value, double wavelength_nm)
{
	size_t i =
		spec_interval_find(curve->wavelength_nm, curve->count - 1, wavelength_nm);
	double from_nm = curve->wavelength_nm[i], to_nm = curve->wavelength_nm[i + 1];

	/* In this form the samples themselves and level stretches come out exactly. */
	return value[i] +
	       (value[i + 1] - value[i]) * ((wavelength_nm - from_nm) / (to_nm - from_nm));
}

enum spec_status
spec_curve_sample(const struct spec_curve *curve, size_t column,
	enum spec_extrapolate extrapolate, const double *wavelength_nm, size_t count,
	double *value, struct spec_error *error)
{
	double first_nm = curve->wavelength_nm[0];
	double last_nm = curve->wavelength_nm[curve->count - 1];
	const double *from;

	if (column >= curve->columns)
		return spec_error_set(error, SPEC_ERANGE,
			"the curve '%.200s' has %zu columns, not %zu",
			spec_curve_name(curve), curve->columns, column + 1);
	from = curve->value + column * curve->count;
	for (size_t i = 0; i < count; i++) {
		double at_nm = wavelength_nm[i];
		int inside = at_nm >= first_nm * (1 - END_SLACK) &&
			     at_nm <= last_nm * (1 + END_SLACK);

		if (isnan(at_nm) || (!inside && extrapolate == SPEC_EXTRAPOLATE_REFUSE))
			return refuse(curve, at_nm, error);
		if (!inside && extrapolate == SPEC_EXTRAPOLATE_ZERO)
			value[i] = 0;
		else if (at_nm <= first_nm)
			value[i] = from[0];
		else if (at_nm >= last_nm)
			value[i] = from[curve->count - 1];
		else
			value[i] = interpolate(curve, from, at_nm);
	}
	return SPEC_OK;
}

void
spec_curve_free(struct spec_curve *curve)
{
	if (!curve)
		return;
	for (size_t i = 0; curve->column && i < curve->columns; i++)
		free(curve->column[i]);
	free(curve->column);
	free(curve->title);
	free(curve->quantity);
	free(curve->unit);
	free(curve->source);
	free(curve->medium);
	free(curve->wavelength_nm);
	free(curve->value);
	*curve = (struct spec_curve){0};
}

int
spec_curve_is_light(const struct spec_curve *curve)
{
	return curve->quantity[0] == '\0' ||
	       strcmp(curve->quantity, "spectral power distribution") == 0 ||
	       strncmp(curve->quantity, "radiance", strlen("radiance")) == 0;
}

int
spec_curve_is_ratio(const struct spec_curve *curve)
{
	return strcmp(curve->quantity, "reflectance") == 0 ||
	       strcmp(curve->quantity, "transmittance") == 0;
}
