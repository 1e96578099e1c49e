#include "spectrum/spectrum.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "base/memory.h"

static const char *const kinds[] = {
	"constant", "blackbody", "rgb", "fourier", "tabulated", "sampled", "composite"};

enum spec_spectrum_kind
spec_spectrum_kind(const struct spec_spectrum *spectrum)
{
	return spectrum->lines > 0 ? SPEC_SPECTRUM_COMPOSITE : spectrum->smooth;
}

const char *
spec_spectrum_kind_name(enum spec_spectrum_kind kind)
{
	return kinds[kind];
}

/* Making and freeing */

#define TEXTS 5

static void
list_texts(struct spec_spectrum *spectrum, char **texts[TEXTS])
{
	texts[0] = &spectrum->title;
	texts[1] = &spectrum->quantity;
	texts[2] = &spectrum->unit;
	texts[3] = &spectrum->source;
	texts[4] = &spectrum->medium;
}

/* An empty spectrum of a kind, with room for count values and as many wavelengths. */
static enum spec_status
make(enum spec_spectrum_kind kind, size_t count, size_t wavelengths,
	struct spec_spectrum *spectrum, struct spec_error *error)
{
	enum spec_status status = SPEC_OK;
	char **texts[TEXTS];

	*spectrum =
		(struct spec_spectrum){.smooth = kind, .high_nm = INFINITY, .count = count};
	list_texts(spectrum, texts);
	for (int i = 0; i < TEXTS && status == SPEC_OK; i++)
		status = spec_curve_set_text(texts[i], "", error);
	if (status == SPEC_OK && count > 0) {
		spectrum->value = spec_memory_new(count, sizeof(double), "values", error);
		status = spectrum->value ? SPEC_OK : SPEC_ENOMEM;
	}
	if (status == SPEC_OK && wavelengths > 0) {
		spectrum->wavelength_nm =
			spec_memory_new(wavelengths, sizeof(double), "wavelengths", error);
		status = spectrum->wavelength_nm ? SPEC_OK : SPEC_ENOMEM;
	}
	if (status != SPEC_OK)
		spec_spectrum_free(spectrum);
	return status;
}

void
spec_spectrum_free(struct spec_spectrum *spectrum)
{
	char **texts[TEXTS];

	if (!spectrum)
		return;
	list_texts(spectrum, texts);
	for (int i = 0; i < TEXTS; i++)
		free(*texts[i]);
	free(spectrum->wavelength_nm);
	free(spectrum->value);
	free(spectrum->line);
	*spectrum = (struct spec_spectrum){0};
}

static enum spec_status
check_count(
	size_t count, size_t least, size_t most, const char *what, struct spec_error *error)
{
	if (count >= least && count <= most)
		return SPEC_OK;
	return spec_error_set(error, SPEC_ERANGE, "a spectrum has %zu to %zu %s, not %zu",
		least, most, what, count);
}

static enum spec_status
check_ends(double low_nm, double high_nm, struct spec_error *error)
{
	if (low_nm > 0 && low_nm < high_nm && isfinite(high_nm))
		return SPEC_OK;
	return spec_error_set(error, SPEC_ERANGE,
		"a spectrum cannot reach from %.10g to %.10g nm", low_nm, high_nm);
}

static enum spec_status
check_values(const double *value, size_t count, const char *what, struct spec_error *error)
{
	for (size_t i = 0; i < count; i++)
		if (!isfinite(value[i]))
			return spec_error_set(
				error, SPEC_ERANGE, "%s %zu is not finite", what, i + 1);
	return SPEC_OK;
}

enum spec_status
spec_spectrum_sampled(double low_nm, double high_nm, const double *value, size_t count,
	enum spec_interpolate interpolate, struct spec_spectrum *spectrum,
	struct spec_error *error)
{
	enum spec_status status =
		check_count(count, 2, SPEC_SPECTRUM_MOST_SAMPLES, "samples", error);
	double *nm, step_nm = (high_nm - low_nm) / (double)(count > 1 ? count - 1 : 1);

	*spectrum = (struct spec_spectrum){0};
	if (status == SPEC_OK)
		status = check_ends(low_nm, high_nm, error);
	if (status != SPEC_OK)
		return status;
	nm = spec_memory_new(count, sizeof *nm, "wavelengths", error);
	if (!nm)
		return SPEC_ENOMEM;
	for (size_t i = 0; i + 1 < count; i++)
		nm[i] = low_nm + (double)i * step_nm;
	nm[count - 1] = high_nm;
	status = spec_spectrum_tabulated(nm, value, count, interpolate, spectrum, error);
	spectrum->smooth = SPEC_SPECTRUM_SAMPLED;
	free(nm);
	return status;
}

enum spec_status
spec_spectrum_tabulated(const double *wavelength_nm, const double *value, size_t count,
	enum spec_interpolate interpolate, struct spec_spectrum *spectrum,
	struct spec_error *error)
{
	struct spec_samples samples = {wavelength_nm, value, count, interpolate};
	enum spec_status status =
		check_count(count, 1, SPEC_SPECTRUM_MOST_SAMPLES, "samples", error);

	*spectrum = (struct spec_spectrum){0};
	for (size_t i = 0; status == SPEC_OK && i < count; i++)
		if (!(wavelength_nm[i] > (i > 0 ? wavelength_nm[i - 1] : 0)) ||
			isinf(wavelength_nm[i]))
			status = spec_error_set(error, SPEC_ERANGE,
				"the wavelength %.10g nm is not finite, positive and above "
				"the one before",
				wavelength_nm[i]);
	if (status == SPEC_OK)
		status = check_values(value, count, "sample", error);
	if (status == SPEC_OK)
		status = spec_samples_check(&samples, error);
	if (status == SPEC_OK)
		status = make(SPEC_SPECTRUM_TABULATED, count, count, spectrum, error);
	if (status != SPEC_OK)
		return status;
	spectrum->interpolate = interpolate;
	spectrum->low_nm = wavelength_nm[0];
	spectrum->high_nm = wavelength_nm[count - 1];
	memcpy(spectrum->wavelength_nm, wavelength_nm, count * sizeof *wavelength_nm);
	memcpy(spectrum->value, value, count * sizeof *value);
	return SPEC_OK;
}

enum spec_status
spec_spectrum_fourier(double low_nm, double high_nm, const double *coefficient,
	size_t count, struct spec_spectrum *spectrum, struct spec_error *error)
{
	enum spec_status status = check_count(
		count, 1, SPEC_SPECTRUM_MOST_COEFFICIENTS, "coefficients", error);

	*spectrum = (struct spec_spectrum){0};
	if (status == SPEC_OK && count % 2 == 0)
		status = spec_error_set(error, SPEC_ERANGE,
			"a Fourier spectrum has an odd number of coefficients, a0, a1, b1, "
			"a2, b2 and so on, not %zu",
			count);
	if (status == SPEC_OK)
		status = check_ends(low_nm, high_nm, error);
	if (status == SPEC_OK)
		status = check_values(coefficient, count, "coefficient", error);
	if (status == SPEC_OK)
		status = make(SPEC_SPECTRUM_FOURIER, count, 0, spectrum, error);
	if (status != SPEC_OK)
		return status;
	spectrum->low_nm = low_nm;
	spectrum->high_nm = high_nm;
	memcpy(spectrum->value, coefficient, count * sizeof *coefficient);
	return SPEC_OK;
}

enum spec_status
spec_spectrum_constant(
	double level, struct spec_spectrum *spectrum, struct spec_error *error)
{
	enum spec_status status = check_values(&level, 1, "level", error);

	*spectrum = (struct spec_spectrum){0};
	if (status == SPEC_OK)
		status = make(SPEC_SPECTRUM_CONSTANT, 0, 0, spectrum, error);
	if (status == SPEC_OK)
		spectrum->level = level;
	return status;
}

enum spec_status
spec_spectrum_blackbody(double temperature_k, double level, struct spec_spectrum *spectrum,
	struct spec_error *error)
{
	enum spec_status status = check_values(&level, 1, "level", error);

	*spectrum = (struct spec_spectrum){0};
	if (status == SPEC_OK && !(temperature_k > 0 && isfinite(temperature_k)))
		status = spec_error_set(error, SPEC_ERANGE,
			"the temperature of a black body is not positive and finite: %g K",
			temperature_k);
	if (status == SPEC_OK)
		status = make(SPEC_SPECTRUM_BLACKBODY, 0, 0, spectrum, error);
	if (status != SPEC_OK)
		return status;
	spectrum->temperature_k = temperature_k;
	spectrum->level = level;
	return SPEC_OK;
}

enum spec_status
spec_spectrum_rgb(const double rgb[3], const struct spec_sigmoid *sigmoid,
	struct spec_spectrum *spectrum, struct spec_error *error)
{
	const double finite[] = {sigmoid->scale, sigmoid->c0_per_nm2, sigmoid->c1_per_nm};
	enum spec_status status = check_values(rgb, 3, "component", error);

	*spectrum = (struct spec_spectrum){0};
	if (status == SPEC_OK)
		status = check_values(finite, 3, "number of the sigmoid", error);
	if (status == SPEC_OK && isnan(sigmoid->c2))
		status = spec_error_set(error, SPEC_ERANGE, "the sigmoid is not a number");
	if (status == SPEC_OK)
		status = make(SPEC_SPECTRUM_RGB, 0, 0, spectrum, error);
	if (status != SPEC_OK)
		return status;
	memcpy(spectrum->rgb, rgb, sizeof spectrum->rgb);
	spectrum->sigmoid = *sigmoid;
	return SPEC_OK;
}

/* Lines */

static int
compare_lines(const void *a, const void *b)
{
	const struct spec_line *one = a, *two = b;

	return (one->wavelength_nm > two->wavelength_nm) -
	       (one->wavelength_nm < two->wavelength_nm);
}

static enum spec_status
check_lines(const struct spec_line *line, size_t count, struct spec_error *error)
{
	for (size_t i = 0; i < count; i++)
		if (!(line[i].wavelength_nm > 0 && isfinite(line[i].wavelength_nm) &&
			    isfinite(line[i].weight)))
			return spec_error_set(error, SPEC_ERANGE,
				"line %zu, at %.10g nm with weight %g, is not at a "
				"positive wavelength or not finite",
				i + 1, line[i].wavelength_nm, line[i].weight);
	return SPEC_OK;
}

enum spec_status
spec_spectrum_add_lines(struct spec_spectrum *spectrum, const struct spec_line *line,
	size_t count, struct spec_error *error)
{
	size_t all = spectrum->lines + count, kept = 0;
	enum spec_status status = check_lines(line, count, error);
	struct spec_line *list;

	if (status == SPEC_OK && all > SPEC_SPECTRUM_MOST_LINES)
		status = spec_error_set(error, SPEC_ERANGE,
			"a spectrum has at most %d lines, not %zu",
			SPEC_SPECTRUM_MOST_LINES, all);
	if (status != SPEC_OK || count == 0)
		return status;
	list = spec_memory_new(all, sizeof *list, "lines", error);
	if (!list)
		return SPEC_ENOMEM;
	if (spectrum->lines > 0)
		memcpy(list, spectrum->line, spectrum->lines * sizeof *list);
	memcpy(list + spectrum->lines, line, count * sizeof *list);
	qsort(list, all, sizeof *list, compare_lines);
	for (size_t i = 0; i < all; i++) {
		if (kept > 0 && list[kept - 1].wavelength_nm == list[i].wavelength_nm)
			list[kept - 1].weight += list[i].weight;
		else
			list[kept++] = list[i];
	}
	all = kept;
	kept = 0;
	for (size_t i = 0; i < all; i++)
		if (list[i].weight != 0)
			list[kept++] = list[i];
	free(spectrum->line);
	spectrum->line = list;
	spectrum->lines = kept;
	return check_lines(list, kept, error);
}

/* Copies */

enum spec_status
spec_spectrum_copy_texts(const struct spec_spectrum *from, struct spec_spectrum *to,
	struct spec_error *error)
{
	const char *text[TEXTS] = {
		from->title, from->quantity, from->unit, from->source, from->medium};
	enum spec_status status = SPEC_OK;
	char **texts[TEXTS];

	list_texts(to, texts);
	for (int i = 0; i < TEXTS && status == SPEC_OK; i++)
		status = spec_curve_set_text(texts[i], text[i], error);
	return status;
}

enum spec_status
spec_spectrum_copy(const struct spec_spectrum *source, struct spec_spectrum *copy,
	struct spec_error *error)
{
	size_t wavelengths = source->wavelength_nm ? source->count : 0;
	enum spec_status status =
		make(source->smooth, source->count, wavelengths, copy, error);

	if (status != SPEC_OK)
		return status;
	copy->interpolate = source->interpolate;
	copy->low_nm = source->low_nm;
	copy->high_nm = source->high_nm;
	copy->level = source->level;
	copy->temperature_k = source->temperature_k;
	memcpy(copy->rgb, source->rgb, sizeof copy->rgb);
	copy->sigmoid = source->sigmoid;
	if (source->count > 0)
		memcpy(copy->value, source->value, source->count * sizeof *copy->value);
	if (wavelengths > 0)
		memcpy(copy->wavelength_nm, source->wavelength_nm,
			wavelengths * sizeof *copy->wavelength_nm);
	status = spec_spectrum_copy_texts(source, copy, error);
	if (status == SPEC_OK)
		status = spec_spectrum_add_lines(copy, source->line, source->lines, error);
	if (status != SPEC_OK)
		spec_spectrum_free(copy);
	return status;
}

enum spec_status
spec_spectrum_from_curve(const struct spec_curve *curve, size_t column,
	struct spec_spectrum *spectrum, struct spec_error *error)
{
	const char *text[TEXTS] = {
		curve->title, curve->quantity, curve->unit, curve->source, curve->medium};
	char **texts[TEXTS];
	enum spec_status status;

	*spectrum = (struct spec_spectrum){0};
	if (column >= curve->columns)
		return spec_error_set(error, SPEC_ERANGE,
			"the curve '%.200s' has %zu columns, not %zu",
			spec_curve_name(curve), curve->columns, column + 1);
	status = spec_spectrum_tabulated(curve->wavelength_nm,
		curve->value + column * curve->count, curve->count, SPEC_INTERPOLATE_LINEAR,
		spectrum, error);
	list_texts(spectrum, texts);
	for (int i = 0; i < TEXTS && status == SPEC_OK; i++)
		status = spec_curve_set_text(texts[i], text[i], error);
	if (status != SPEC_OK)
		spec_spectrum_free(spectrum);
	return status;
}

void
spec_spectrum_range(const struct spec_spectrum *spectrum, double *low_nm, double *high_nm)
{
	int endless = isinf(spectrum->high_nm);

	*low_nm = endless ? SPEC_SPECTRUM_LOW_NM : spectrum->low_nm;
	*high_nm = endless ? SPEC_SPECTRUM_HIGH_NM : spectrum->high_nm;
}
