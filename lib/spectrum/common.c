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

/* Equal steps from low to high, those of samples drawn on. */
static enum spec_status
draw_on(const struct spec_spectrum *sampled, double low_nm, double high_nm,
	struct spec_grid *wavelengths, struct spec_error *error)
{
	double step_nm = step_of(sampled), origin_nm = sampled->low_nm;
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
		if (k >= 0 && k < (double)sampled->count)
			nm = sampled->wavelength_nm[(size_t)k];
		wavelengths->wavelength_nm[i] = fmin(fmax(nm, low_nm), high_nm);
	}
	return SPEC_OK;
}

/* The wavelengths of one table or of two that lie in the range, each once. */
static enum spec_status
merge(const struct spec_spectrum *a, const struct spec_spectrum *b, double low_nm,
	double high_nm, struct spec_grid *wavelengths, struct spec_error *error)
{
	size_t a_count = a->wavelength_nm ? a->count : 0, i = 0;
	size_t b_count = b->wavelength_nm ? b->count : 0, k = 0;

	wavelengths->wavelength_nm =
		spec_memory_new(a_count + b_count, sizeof(double), "wavelengths", error);
	wavelengths->count = 0;
	if (!wavelengths->wavelength_nm)
		return SPEC_ENOMEM;
	while (i < a_count || k < b_count) {
		double one_nm = i < a_count ? a->wavelength_nm[i] : INFINITY;
		double two_nm = k < b_count ? b->wavelength_nm[k] : INFINITY;
		double nm = fmin(one_nm, two_nm);

		i += one_nm == nm;
		k += two_nm == nm;
		if (nm >= low_nm && nm <= high_nm)
			wavelengths->wavelength_nm[wavelengths->count++] = nm;
	}
	return SPEC_OK;
}

/* Equal steps, for what has no samples. */
static enum spec_status
make_steps(const struct spec_spectrum *a, const struct spec_spectrum *b, double low_nm,
	double high_nm, struct spec_grid *wavelengths, struct spec_error *error)
{
	double step_nm = INFINITY, steps;
	const struct spec_spectrum *both[] = {a, b};

	for (int i = 0; i < 2; i++) {
		size_t count;
		double *nm = spec_spectrum_grid(both[i], &count, error);

		if (!nm)
			return SPEC_ENOMEM;
		step_nm = fmin(step_nm, nm[1] - nm[0]);
		free(nm);
	}
	steps = fmax(ceil((high_nm - low_nm) / step_nm - 1e-6), 1);
	if (!(steps < SPEC_SPECTRUM_MOST_SAMPLES))
		return spec_error_set(error, SPEC_ERANGE, "more than %d samples",
			SPEC_SPECTRUM_MOST_SAMPLES);
	wavelengths->count = (size_t)steps + 1;
	wavelengths->wavelength_nm =
		spec_memory_new(wavelengths->count, sizeof(double), "wavelengths", error);
	if (!wavelengths->wavelength_nm)
		return SPEC_ENOMEM;
	for (size_t i = 0; i < wavelengths->count; i++)
		wavelengths->wavelength_nm[i] =
			low_nm + (high_nm - low_nm) * ((double)i / steps);
	wavelengths->wavelength_nm[wavelengths->count - 1] = high_nm;
	return SPEC_OK;
}

enum spec_status
spec_spectrum_common(const struct spec_spectrum *a, const struct spec_spectrum *b,
	enum spec_extrapolate extrapolate, struct spec_grid *wavelengths,
	struct spec_error *error)
{
	int sampled =
		a->smooth == SPEC_SPECTRUM_SAMPLED && b->smooth == SPEC_SPECTRUM_SAMPLED;
	double low_nm, high_nm;
	int met = meet(a, b, extrapolate, &low_nm, &high_nm);
	enum spec_status status = SPEC_OK;
	int finer;

	if (met && sampled && !same_wavelengths(a, b)) {
		finer = step_of(a) != step_of(b) ? step_of(b) < step_of(a)
						 : b->low_nm < a->low_nm;
		status = draw_on(finer ? b : a, low_nm, high_nm, wavelengths, error);
	} else if (met && (a->wavelength_nm || b->wavelength_nm)) {
		/* A table and something without samples: the table does not grow. */
		if (!a->wavelength_nm || !b->wavelength_nm) {
			const struct spec_spectrum *table = a->wavelength_nm ? a : b;

			low_nm = fmax(low_nm, table->low_nm);
			high_nm = fmin(high_nm, table->high_nm);
		}
		status = merge(a, b, low_nm, high_nm, wavelengths, error);
	} else if (met && low_nm < high_nm) {
		status = make_steps(a, b, low_nm, high_nm, wavelengths, error);
	}
	if (status != SPEC_OK || wavelengths->count > 0)
		return status;
	return spec_error_set(error, SPEC_ERANGE,
		"'%.200s' (%g..%g nm) and '%.200s' (%g..%g nm) do not meet", a->title,
		a->low_nm, a->high_nm, b->title, b->low_nm, b->high_nm);
}
