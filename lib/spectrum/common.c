#include "spectrum/common.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "base/memory.h"
#include "spectrum/represent.h"

static int
is_endless(const struct spec_spectrum *spectrum)
{
	return isinf(spectrum->high_nm);
}

/* The range of the result; 0: they do not meet. */
static int
meet(const struct spec_spectrum *a, const struct spec_spectrum *b,
	enum spec_extrapolate extrapolate, double *low_nm, double *high_nm)
{
	if (is_endless(a) || is_endless(b)) {
		spec_spectrum_range(is_endless(a) ? b : a, low_nm, high_nm);
	} else if (extrapolate == SPEC_EXTRAPOLATE_REFUSE) {
		*low_nm = fmax(a->low_nm, b->low_nm);
		*high_nm = fmin(a->high_nm, b->high_nm);
	} else {
		*low_nm = fmin(a->low_nm, b->low_nm);
		*high_nm = fmax(a->high_nm, b->high_nm);
	}
	return *low_nm <= *high_nm;
}

static double
step_of(const struct spec_spectrum *sampled)
{
	return (sampled->high_nm - sampled->low_nm) / (double)(sampled->count - 1);
}

static int
same_wavelengths(const struct spec_spectrum *a, const struct spec_spectrum *b)
{
	return a->count == b->count && memcmp(a->wavelength_nm, b->wavelength_nm,
					       a->count * sizeof *a->wavelength_nm) == 0;
}

/* Equal steps from low to high, those of samples drawn on and divided into parts. */
static enum spec_status
draw_on(const struct spec_spectrum *sampled, double parts, double low_nm, double high_nm,
	struct spec_grid *wavelengths, struct spec_error *error)
{
	double step_nm = step_of(sampled) / parts, origin_nm = sampled->low_nm;
	double first = ceil((low_nm - origin_nm) / step_nm - 1e-6);
	double last = floor((high_nm - origin_nm) / step_nm + 1e-6);

	if (last - first >= SPEC_SPECTRUM_MOST_SAMPLES)
		return spec_error_set(error, SPEC_ERANGE,
			"steps of %.10g nm from %.10g to %.10g nm are more than %d samples",
			step_nm, low_nm, high_nm, SPEC_SPECTRUM_MOST_SAMPLES);
	wavelengths->count = last >= first ? (size_t)(last - first) + 1 : 0;
	wavelengths->wavelength_nm =
		spec_memory_new(wavelengths->count, sizeof(double), "wavelengths", error);
	if (!wavelengths->wavelength_nm)
		return SPEC_ENOMEM;
	for (size_t i = 0; i < wavelengths->count; i++) {
		double k = first + (double)i, nm = origin_nm + k * step_nm;

		/* Its own samples are at its own wavelengths, and no step leaves the range. */
		if (k >= 0 && fmod(k, parts) == 0 && k / parts < (double)sampled->count)
			nm = sampled->wavelength_nm[(size_t)(k / parts)];
		wavelengths->wavelength_nm[i] = fmin(fmax(nm, low_nm), high_nm);
	}
	return SPEC_OK;
}

/* A step that does for what has no samples, infinite for a constant; 0: SPEC_ENOMEM. */
static double
function_step(const struct spec_spectrum *spectrum, struct spec_error *error)
{
	double step_nm = INFINITY, *nm;
	size_t count;

	if (spectrum->smooth == SPEC_SPECTRUM_CONSTANT)
		return step_nm;
	nm = spec_spectrum_grid(spectrum, &count, error);
	step_nm = nm ? nm[1] - nm[0] : 0;
	free(nm);
	return step_nm;
}

/* Equal steps, no wider than that, from low to high; none of an infinite step. */
static enum spec_status
make_steps(double step_nm, double low_nm, double high_nm, struct spec_grid *wavelengths,
	struct spec_error *error)
{
	double steps = fmax(ceil((high_nm - low_nm) / step_nm - 1e-6), 1);

	if (!(steps < SPEC_SPECTRUM_MOST_SAMPLES))
		return spec_error_set(error, SPEC_ERANGE, "more than %d samples",
			SPEC_SPECTRUM_MOST_SAMPLES);
	wavelengths->count = isinf(step_nm) ? 0 : (size_t)steps + 1;
	wavelengths->wavelength_nm =
		spec_memory_new(wavelengths->count, sizeof(double), "wavelengths", error);
	if (!wavelengths->wavelength_nm)
		return SPEC_ENOMEM;
	for (size_t i = 0; i < wavelengths->count; i++)
		wavelengths->wavelength_nm[i] =
			(double)i < steps
				? low_nm + (high_nm - low_nm) * ((double)i / steps)
				: high_nm;
	return SPEC_OK;
}

/* Two ascending lists of wavelengths as one, those in the range and each once. */
static enum spec_status
merge(const struct spec_grid *a, const struct spec_grid *b, double low_nm, double high_nm,
	struct spec_grid *wavelengths, struct spec_error *error)
{
	size_t i = 0, k = 0;

	wavelengths->wavelength_nm =
		spec_memory_new(a->count + b->count, sizeof(double), "wavelengths", error);
	wavelengths->count = 0;
	if (!wavelengths->wavelength_nm)
		return SPEC_ENOMEM;
	while (i < a->count || k < b->count) {
		double one_nm = i < a->count ? a->wavelength_nm[i] : INFINITY;
		double two_nm = k < b->count ? b->wavelength_nm[k] : INFINITY;
		double nm = fmin(one_nm, two_nm);

		i += one_nm == nm;
		k += two_nm == nm;
		if (nm >= low_nm && nm <= high_nm)
			wavelengths->wavelength_nm[wavelengths->count++] = nm;
	}
	return SPEC_OK;
}

/* A table, and something without samples. */
static enum spec_status
join_function(const struct spec_spectrum *table, const struct spec_spectrum *function,
	double low_nm, double high_nm, struct spec_grid *wavelengths,
	struct spec_error *error)
{
	struct spec_grid own = {table->wavelength_nm, table->count}, steps = {0};
	double step_nm = function_step(function, error), parts = 1;
	enum spec_status status = step_nm > 0 ? SPEC_OK : SPEC_ENOMEM;

	if (status == SPEC_OK && table->smooth == SPEC_SPECTRUM_SAMPLED) {
		if (!isinf(step_nm))
			parts = fmax(ceil(step_of(table) / step_nm - 1e-6), 1);
		return draw_on(table, parts, low_nm, high_nm, wavelengths, error);
	}
	if (status == SPEC_OK && low_nm < high_nm)
		status = make_steps(step_nm, low_nm, high_nm, &steps, error);
	if (status == SPEC_OK)
		status = merge(&own, &steps, low_nm, high_nm, wavelengths, error);
	spec_grid_free(&steps);
	return status;
}

static enum spec_status
join_tables(const struct spec_spectrum *a, const struct spec_spectrum *b, double low_nm,
	double high_nm, struct spec_grid *wavelengths, struct spec_error *error)
{
	struct spec_grid one = {a->wavelength_nm, a->count},
			 two = {b->wavelength_nm, b->count};
	int sampled =
		a->smooth == SPEC_SPECTRUM_SAMPLED && b->smooth == SPEC_SPECTRUM_SAMPLED;
	int second = 0;

	if (!sampled || same_wavelengths(a, b))
		return merge(&one, &two, low_nm, high_nm, wavelengths, error);
	second = step_of(a) != step_of(b) ? step_of(b) < step_of(a) : b->low_nm < a->low_nm;
	return draw_on(second ? b : a, 1, low_nm, high_nm, wavelengths, error);
}

static enum spec_status
join_functions(const struct spec_spectrum *a, const struct spec_spectrum *b, double low_nm,
	double high_nm, struct spec_grid *wavelengths, struct spec_error *error)
{
	double one_nm = function_step(a, error), two_nm = function_step(b, error);

	if (one_nm == 0 || two_nm == 0)
		return SPEC_ENOMEM;
	return low_nm < high_nm ? make_steps(fmin(one_nm, two_nm), low_nm, high_nm,
					  wavelengths, error)
				: SPEC_OK;
}

enum spec_status
spec_spectrum_common(const struct spec_spectrum *a, const struct spec_spectrum *b,
	enum spec_extrapolate extrapolate, struct spec_grid *wavelengths,
	struct spec_error *error)
{
	double low_nm, high_nm;
	enum spec_status status = SPEC_OK;

	if (meet(a, b, extrapolate, &low_nm, &high_nm)) {
		if (a->wavelength_nm && b->wavelength_nm)
			status = join_tables(a, b, low_nm, high_nm, wavelengths, error);
		else if (a->wavelength_nm)
			status = join_function(a, b, low_nm, high_nm, wavelengths, error);
		else if (b->wavelength_nm)
			status = join_function(b, a, low_nm, high_nm, wavelengths, error);
		else
			status = join_functions(a, b, low_nm, high_nm, wavelengths, error);
	}
	if (status != SPEC_OK || wavelengths->count > 0)
		return status;
	return spec_error_set(error, SPEC_ERANGE,
		"'%.200s' (%g..%g nm) and '%.200s' (%g..%g nm) do not meet", a->title,
		a->low_nm, a->high_nm, b->title, b->low_nm, b->high_nm);
}
