#include "spectrum/represent.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "base/memory.h"
#include "spectrum/fourier.h"

#define STEP_NM 1.    /* of what has no samples */
#define WAVE_STEPS 16 /* in the shortest wave of a Fourier series */
#define MOST_STEPS (SPEC_GRID_LONGEST - 1)
#define END_SLACK 1e-9

/* ---- wavelengths ---- */

double *
spec_spectrum_grid(
	const struct spec_spectrum *spectrum, size_t *count, struct spec_error *error)
{
	double low_nm, high_nm, steps, *nm;
	size_t waves = spectrum->count / 2;

	spec_spectrum_range(spectrum, &low_nm, &high_nm);
	steps = fmax(ceil((high_nm - low_nm) / STEP_NM - END_SLACK), 1);
	if (spectrum->smooth == SPEC_SPECTRUM_FOURIER)
		steps = fmax(steps, WAVE_STEPS * (double)waves);
	steps = fmin(steps, MOST_STEPS);
	*count = spectrum->wavelength_nm ? spectrum->count : (size_t)steps + 1;
	nm = spec_memory_new(*count, sizeof *nm, "wavelengths", error);
	if (!nm)
		return NULL;
	for (size_t i = 0; i < *count; i++)
		nm[i] = spectrum->wavelength_nm ? spectrum->wavelength_nm[i]
			: i + 1 == *count
				? high_nm
				: low_nm + (double)i * ((high_nm - low_nm) / steps);
	return nm;
}

/* The range asked for, or the spectrum's own. */
static void
choose_range(const struct spec_spectrum *source,
	const struct spec_representation *representation, double *low_nm, double *high_nm)
{
	*low_nm = representation->low_nm;
	*high_nm = representation->high_nm;
	if (*low_nm == 0 && *high_nm == 0)
		spec_spectrum_range(source, low_nm, high_nm);
}

static enum spec_status
check_range(const struct spec_spectrum *source, enum spec_extrapolate extrapolate,
	double low_nm, double high_nm, struct spec_error *error)
{
	double ends_nm[2], value[2];

	if (!(low_nm > 0 && low_nm < high_nm && isfinite(high_nm)))
		return spec_error_set(error, SPEC_ERANGE,
			"a spectrum cannot reach from %.10g to %.10g nm", low_nm, high_nm);
	ends_nm[0] = low_nm;
	ends_nm[1] = high_nm;
	return spec_spectrum_sample(source, extrapolate, ends_nm, 2, value, error);
}

/* ---- to samples and tables ---- */

/* Adds a line to samples as a peak of its weight. */
static void
spread_line(const struct spec_line *line, enum spec_interpolate interpolate,
	const double *nm, double *value, size_t count)
{
	double width_nm, part;
	size_t i = 0, high = count - 1;

	if (count < 2 || line->wavelength_nm < nm[0] || line->wavelength_nm > nm[count - 1])
		return;
	while (high - i > 1) {
		size_t middle = i + (high - i) / 2;

		if (nm[middle] <= line->wavelength_nm)
			i = middle;
		else
			high = middle;
	}
	width_nm = nm[i + 1] - nm[i];
	part = (line->wavelength_nm - nm[i]) / width_nm;
	if (interpolate == SPEC_INTERPOLATE_LEFT) {
		value[i] += line->weight / width_nm;
		return;
	}
	if (interpolate == SPEC_INTERPOLATE_NEAREST)
		part = part >= .5;
	for (int side = 0; side < 2; side++, part = 1 - part) {
		size_t k = side == 0 ? i + 1 : i;
		double before_nm = k > 0 ? nm[k - 1] : nm[k];
		double after_nm = k + 1 < count ? nm[k + 1] : nm[k];

		value[k] += line->weight * part / (.5 * (after_nm - before_nm));
	}
}

static enum spec_status
to_table(const struct spec_spectrum *source,
	const struct spec_representation *representation, const double *nm, size_t count,
	struct spec_spectrum *result, struct spec_error *error)
{
	double *value = spec_memory_new(count, sizeof *value, "values", error);
	enum spec_status status =
		value ? spec_spectrum_sample(source, representation->extrapolate, nm, count,
				value, error)
		      : SPEC_ENOMEM;

	if (status == SPEC_OK && source->lines > 0 && count < 2)
		status = spec_error_set(error, SPEC_ERANGE,
			"one wavelength has no width for the energy of lines");
	for (size_t i = 0; status == SPEC_OK && i < source->lines; i++)
		spread_line(
			&source->line[i], representation->interpolate, nm, value, count);
	if (status == SPEC_OK && representation->kind == SPEC_SPECTRUM_SAMPLED)
		status = spec_spectrum_sampled(nm[0], nm[count - 1], value, count,
			representation->interpolate, result, error);
	else if (status == SPEC_OK)
		status = spec_spectrum_tabulated(
			nm, value, count, representation->interpolate, result, error);
	free(value);
	return status;
}

static enum spec_status
to_tabulated(const struct spec_spectrum *source,
	const struct spec_representation *representation, struct spec_spectrum *result,
	struct spec_error *error)
{
	const struct spec_grid *grid = representation->grid;
	size_t count = grid ? grid->count : 0;
	double *own = grid ? NULL : spec_spectrum_grid(source, &count, error);
	enum spec_status status = grid || own ? to_table(source, representation,
							grid ? grid->wavelength_nm : own,
							count, result, error)
					      : SPEC_ENOMEM;

	free(own);
	return status;
}

static enum spec_status
to_sampled(const struct spec_spectrum *source,
	const struct spec_representation *representation, struct spec_spectrum *result,
	struct spec_error *error)
{
	struct spec_spectrum empty = {0};
	double low_nm, high_nm, *nm;
	size_t count = representation->count;
	enum spec_status status;

	choose_range(source, representation, &low_nm, &high_nm);
	status = check_range(source, representation->extrapolate, low_nm, high_nm, error);
	if (status == SPEC_OK && count == 0) {
		nm = spec_spectrum_grid(source, &count, error);
		free(nm);
		status = nm ? SPEC_OK : SPEC_ENOMEM;
	}
	/* Zeros, for the wavelengths that equal steps have. */
	if (status == SPEC_OK && (count < 2 || count > SPEC_SPECTRUM_MOST_SAMPLES))
		status = spec_error_set(error, SPEC_ERANGE,
			"a sampled spectrum has 2 to %d samples, not %zu",
			SPEC_SPECTRUM_MOST_SAMPLES, count);
	if (status != SPEC_OK)
		return status;
	nm = spec_memory_new(count, sizeof *nm, "wavelengths", error);
	status = nm ? spec_spectrum_sampled(low_nm, high_nm, nm, count,
			      SPEC_INTERPOLATE_LINEAR, &empty, error)
		    : SPEC_ENOMEM;
	if (status == SPEC_OK)
		status = to_table(
			source, representation, empty.wavelength_nm, count, result, error);
	spec_spectrum_free(&empty);
	free(nm);
	return status;
}

/* ---- to Fourier ---- */

/* The part of a table between the ends of a series. */
static void
transform_table(const struct spec_spectrum *source, double low_nm, double high_nm,
	double *coefficient, size_t count)
{
	struct spec_samples samples = {
		source->wavelength_nm, source->value, source->count, source->interpolate};

	for (size_t i = 0; i + 1 < source->count; i++) {
		struct spec_piece pieces[2];
		int number = spec_samples_pieces(&samples, i, pieces);

		for (int k = 0; k < number; k++)
			if (pieces[k].from_nm < high_nm && pieces[k].to_nm > low_nm) {
				spec_piece_cut(&pieces[k], low_nm, high_nm);
				spec_series_add_piece(
					&pieces[k], low_nm, high_nm, coefficient, count);
			}
	}
}

/* What has no samples, or lies outside them, from a to b: as polynomials over 1 nm each. */
static enum spec_status
transform_values(const struct spec_spectrum *source, enum spec_extrapolate extrapolate,
	double a_nm, double b_nm, const double ends_nm[2], double *coefficient,
	size_t count, struct spec_error *error)
{
	double pieces = ceil((b_nm - a_nm) / STEP_NM);
	size_t waves = source->count / 2;
	enum spec_status status = SPEC_OK;

	if (source->smooth == SPEC_SPECTRUM_FOURIER)
		pieces = fmax(pieces, WAVE_STEPS * (double)waves);
	for (double i = 0; i < pieces && status == SPEC_OK; i++) {
		struct spec_piece piece = {a_nm + (b_nm - a_nm) * (i / pieces),
			a_nm + (b_nm - a_nm) * ((i + 1) / pieces), 6, {0}};
		double nm[6], value[6];

		for (int k = 0; k < 6; k++)
			nm[k] = .5 * (piece.from_nm + piece.to_nm) +
				.5 * (piece.to_nm - piece.from_nm) * spec_gauss_node[k];
		status = spec_spectrum_sample(source, extrapolate, nm, 6, value, error);
		spec_piece_fit(&piece, value);
		spec_series_add_piece(&piece, ends_nm[0], ends_nm[1], coefficient, count);
	}
	return status;
}

/* The lines between the ends of a series. */
static void
transform_lines(const struct spec_spectrum *source, double low_nm, double high_nm,
	double *coefficient, size_t count)
{
	for (size_t i = 0; i < source->lines; i++) {
		const struct spec_line *line = &source->line[i];

		if (line->wavelength_nm >= low_nm && line->wavelength_nm <= high_nm)
			spec_series_add_line(line->wavelength_nm, line->weight, low_nm,
				high_nm, coefficient, count);
	}
}

static enum spec_status
transform(const struct spec_spectrum *source, enum spec_extrapolate extrapolate,
	double low_nm, double high_nm, double *coefficient, size_t count,
	struct spec_error *error)
{
	double ends_nm[2] = {low_nm, high_nm}, inner_low_nm, inner_high_nm;
	enum spec_status status = SPEC_OK;

	transform_lines(source, low_nm, high_nm, coefficient, count);
	inner_low_nm = fmin(fmax(low_nm, source->low_nm), high_nm);
	inner_high_nm = fmax(fmin(high_nm, source->high_nm), low_nm);
	if (source->wavelength_nm)
		transform_table(source, low_nm, high_nm, coefficient, count);
	else if (inner_low_nm < inner_high_nm)
		status = transform_values(source, extrapolate, inner_low_nm, inner_high_nm,
			ends_nm, coefficient, count, error);
	if (extrapolate != SPEC_EXTRAPOLATE_CONSTANT)
		return status;
	if (status == SPEC_OK && low_nm < inner_low_nm)
		status = transform_values(source, extrapolate, low_nm, inner_low_nm,
			ends_nm, coefficient, count, error);
	if (status == SPEC_OK && high_nm > inner_high_nm)
		status = transform_values(source, extrapolate, inner_high_nm, high_nm,
			ends_nm, coefficient, count, error);
	return status;
}

static int
is_truncation(const struct spec_spectrum *source, double low_nm, double high_nm)
{
	return source->smooth == SPEC_SPECTRUM_FOURIER && source->low_nm == low_nm &&
	       source->high_nm == high_nm;
}

static enum spec_status
to_fourier(const struct spec_spectrum *source,
	const struct spec_representation *representation, struct spec_spectrum *result,
	struct spec_error *error)
{
	size_t count = representation->count;
	double low_nm, high_nm, *coefficient;
	enum spec_status status;

	choose_range(source, representation, &low_nm, &high_nm);
	status = check_range(source, representation->extrapolate, low_nm, high_nm, error);
	if (status != SPEC_OK)
		return status;
	coefficient = spec_memory_new(
		count > 0 ? count : 1, sizeof *coefficient, "coefficients", error);
	if (!coefficient)
		return SPEC_ENOMEM;
	/* The count is checked before the work. */
	status = spec_spectrum_fourier(low_nm, high_nm, coefficient, count, result, error);
	free(coefficient);
	if (status != SPEC_OK)
		return status;
	coefficient = result->value;
	if (is_truncation(source, low_nm, high_nm)) {
		memcpy(coefficient, source->value,
			(count < source->count ? count : source->count) *
				sizeof *coefficient);
		transform_lines(source, low_nm, high_nm, coefficient, count);
		return SPEC_OK;
	}
	return transform(source, representation->extrapolate, low_nm, high_nm, coefficient,
		count, error);
}

/* ---- to composite and constant ---- */

/* Takes the lines of a table out of it. */
static enum spec_status
split_lines(struct spec_spectrum *table, size_t most, struct spec_error *error)
{
	struct spec_samples samples = {
		table->wavelength_nm, table->value, table->count, table->interpolate};
	size_t lines = most < table->count ? most : table->count;
	struct spec_line *line = spec_memory_new(lines, sizeof *line, "lines", error);
	double *smooth = spec_memory_new(table->count, sizeof *smooth, "values", error);
	enum spec_status status = line && smooth ? SPEC_OK : SPEC_ENOMEM;

	if (status == SPEC_OK && samples.interpolate != SPEC_INTERPOLATE_LINEAR)
		status = spec_error_set(error, SPEC_EUNSUPPORTED,
			"lines are found in samples that are linear between, not by the "
			"rule '%s'",
			spec_interpolate_name(samples.interpolate));
	if (status == SPEC_OK)
		status = spec_samples_lines(&samples, line, &lines, smooth, error);
	if (status == SPEC_OK) {
		memcpy(table->value, smooth, table->count * sizeof *smooth);
		status = spec_spectrum_add_lines(table, line, lines, error);
	}
	free(line);
	free(smooth);
	return status;
}

static enum spec_status
to_composite(const struct spec_spectrum *source,
	const struct spec_representation *representation, struct spec_spectrum *result,
	struct spec_error *error)
{
	struct spec_representation fourier = *representation;
	struct spec_spectrum split, smooth;
	enum spec_status status;

	if (source->lines > representation->count)
		return spec_error_set(error, SPEC_ERANGE,
			"'%.200s' has %zu line%s, more than the %zu asked for",
			source->title, source->lines, source->lines == 1 ? "" : "s",
			representation->count);
	status = spec_spectrum_copy(source, &split, error);
	if (status == SPEC_OK && source->lines == 0 && source->wavelength_nm)
		status = split_lines(&split, representation->count, error);
	if (status != SPEC_OK || representation->coefficients == 0) {
		*result = split;
		return status;
	}
	smooth = split;
	smooth.lines = 0;
	fourier.count = representation->coefficients;
	status = to_fourier(&smooth, &fourier, result, error);
	if (status == SPEC_OK)
		status = spec_spectrum_add_lines(result, split.line, split.lines, error);
	spec_spectrum_free(&split);
	return status;
}

static enum spec_status
to_constant(const struct spec_spectrum *source,
	const struct spec_representation *representation, struct spec_spectrum *result,
	struct spec_error *error)
{
	double edges_nm[2], mean = 0;
	enum spec_status status;

	choose_range(source, representation, &edges_nm[0], &edges_nm[1]);
	status = spec_spectrum_mean(
		source, representation->extrapolate, edges_nm, 1, &mean, error);
	return status == SPEC_OK ? spec_spectrum_constant(mean, result, error) : status;
}

enum spec_status
spec_spectrum_convert(const struct spec_spectrum *source,
	const struct spec_representation *representation, struct spec_spectrum *result,
	struct spec_error *error)
{
	enum spec_status status = SPEC_EUNSUPPORTED;

	*result = (struct spec_spectrum){0};
	switch (representation->kind) {
	case SPEC_SPECTRUM_SAMPLED:
		status = to_sampled(source, representation, result, error);
		break;
	case SPEC_SPECTRUM_TABULATED:
		status = to_tabulated(source, representation, result, error);
		break;
	case SPEC_SPECTRUM_FOURIER:
		status = to_fourier(source, representation, result, error);
		break;
	case SPEC_SPECTRUM_COMPOSITE:
		status = to_composite(source, representation, result, error);
		break;
	case SPEC_SPECTRUM_CONSTANT:
		status = to_constant(source, representation, result, error);
		break;
	case SPEC_SPECTRUM_BLACKBODY:
	case SPEC_SPECTRUM_RGB:
		status = spec_error_set(error, SPEC_EUNSUPPORTED,
			"no spectrum becomes one of the kind '%s' here",
			spec_spectrum_kind_name(representation->kind));
		break;
	}
	if (status == SPEC_OK)
		status = spec_spectrum_copy_texts(source, result, error);
	if (status != SPEC_OK)
		spec_spectrum_free(result);
	return status;
}

enum spec_status
spec_spectrum_to_curve(const struct spec_spectrum *spectrum, struct spec_curve *curve,
	struct spec_error *error)
{
	struct spec_representation representation = {.kind = SPEC_SPECTRUM_TABULATED};
	struct spec_spectrum table;
	const char *text[5];
	char **field[5];
	enum spec_status status =
		spec_spectrum_convert(spectrum, &representation, &table, error);

	*curve = (struct spec_curve){0};
	if (status == SPEC_OK)
		status = spec_curve_new(table.count, 1, curve, error);
	if (status == SPEC_OK) {
		memcpy(curve->wavelength_nm, table.wavelength_nm,
			table.count * sizeof *table.wavelength_nm);
		memcpy(curve->value, table.value, table.count * sizeof *table.value);
		text[0] = table.title, field[0] = &curve->title;
		text[1] = table.quantity, field[1] = &curve->quantity;
		text[2] = table.unit, field[2] = &curve->unit;
		text[3] = table.source, field[3] = &curve->source;
		text[4] = table.medium, field[4] = &curve->medium;
		for (int i = 0; i < 5 && status == SPEC_OK; i++)
			status = spec_curve_set_text(field[i], text[i], error);
	}
	if (status != SPEC_OK)
		spec_curve_free(curve);
	spec_spectrum_free(&table);
	return status;
}
