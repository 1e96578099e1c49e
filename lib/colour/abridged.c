#include "colour/abridged.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "base/memory.h"

#define RANGE_NM (SPEC_ABRIDGED_LAST_NM - SPEC_ABRIDGED_FIRST_NM)

/* As observer.c: closer than this is the same wavelength. */
#define SAME_NM 1e-6

#define MOST_NODES 4

static const int steps_nm[] = {10, 20};

/* The bands' step, or 0. */
static int
step_of(const double *wavelength_nm, size_t count)
{
	for (size_t k = 0; k < sizeof steps_nm / sizeof *steps_nm; k++) {
		size_t i = 1;

		while (i < count && fabs(wavelength_nm[i] - wavelength_nm[0] -
					    (double)i * steps_nm[k]) <= SAME_NM)
			i++;
		if (count > 1 && i == count)
			return steps_nm[k];
	}
	return 0;
}

/* Which band of the table is the image's first; those before the table count down. */
static enum spec_status
find_first(const double *wavelength_nm, size_t count, int step_nm, long *first,
	struct spec_error *error)
{
	double place = (wavelength_nm[0] - SPEC_ABRIDGED_FIRST_NM) / step_nm;

	*first = 0;
	if (fabs(place - round(place)) * step_nm > SAME_NM)
		return spec_error_set(error, SPEC_EUNSUPPORTED,
			"bands at %g, %g, … nm are not among those of the table of ASTM "
			"E308, %d, %d, … nm",
			wavelength_nm[0], wavelength_nm[1], SPEC_ABRIDGED_FIRST_NM,
			SPEC_ABRIDGED_FIRST_NM + step_nm);
	if (wavelength_nm[0] > SPEC_ABRIDGED_LAST_NM + SAME_NM ||
		wavelength_nm[count - 1] < SPEC_ABRIDGED_FIRST_NM - SAME_NM)
		return spec_error_set(error, SPEC_EUNSUPPORTED,
			"bands of %g..%g nm lie outside the table of ASTM E308, %d..%d nm",
			wavelength_nm[0], wavelength_nm[count - 1], SPEC_ABRIDGED_FIRST_NM,
			SPEC_ABRIDGED_LAST_NM);
	*first = lround(place);
	return SPEC_OK;
}

/* S x, S y, S z at every whole nm: 3 * (RANGE_NM + 1), and room for the light behind them. */
static enum spec_status
multiply(const struct spec_curve *observer, const struct spec_curve *illuminant,
	double *product, struct spec_error *error)
{
	const size_t n = RANGE_NM + 1;
	double nm[RANGE_NM + 1], *light = product + 3 * n;
	enum spec_status status;

	for (size_t i = 0; i < n; i++)
		nm[i] = SPEC_ABRIDGED_FIRST_NM + (double)i;
	status = spec_curve_sample(
		illuminant, 0, SPEC_EXTRAPOLATE_ZERO, nm, n, light, error);
	for (size_t c = 0; c < 3 && status == SPEC_OK; c++) {
		status = spec_curve_sample(
			observer, c, SPEC_EXTRAPOLATE_ZERO, nm, n, product + c * n, error);
		for (size_t i = 0; i < n && status == SPEC_OK; i++)
			product[c * n + i] *= light[i];
	}
	return status;
}

/*
 * The bands of the table from which a whole nm is interpolated, their number, and what each
 * contributes: Lagrange's polynomials, in units of the step. Beyond the last band of the table,
 * where an interval is incomplete, that band alone.
 */
static size_t
interpolate(int nm, int step_nm, size_t *first, double part[MOST_NODES])
{
	const int intervals = RANGE_NM / step_nm;
	int interval = nm / step_nm;
	size_t nodes = MOST_NODES;
	double at;

	part[0] = 1;
	*first = (size_t)intervals;
	if (nm >= intervals * step_nm)
		return 1;
	*first = interval > 0 ? (size_t)interval - 1 : 0;
	if (interval == 0 || interval == intervals - 1)
		nodes = 3;
	at = (double)nm / step_nm - (double)*first;
	for (size_t i = 0; i < nodes; i++) {
		part[i] = 1;
		for (size_t j = 0; j < nodes; j++) {
			if (j != i)
				part[i] *= (at - (double)j) / ((double)i - (double)j);
		}
	}
	return nodes;
}

/* The bands of the image that a band of the table is collected in. */
static size_t
collect(long band, long first, size_t count)
{
	if (band <= first)
		return 0;
	return (size_t)(band - first) < count ? (size_t)(band - first) : count - 1;
}

/* Given: the first band of the image that is in the table, and how many there are from it on. */
static void
fold(const double *product, int step_nm, long first, size_t count, double *weight,
	size_t room)
{
	for (int nm = 0; nm <= RANGE_NM; nm++) {
		double part[MOST_NODES];
		size_t band, nodes = interpolate(nm, step_nm, &band, part);

		for (size_t i = 0; i < nodes; i++) {
			size_t at = collect((long)(band + i), first, count);

			for (size_t c = 0; c < 3; c++)
				weight[c * room + at] +=
					part[i] * product[c * (RANGE_NM + 1) + (size_t)nm];
		}
	}
}

static enum spec_status
normalise(const double *product, double *weight, size_t count, double *sum,
	struct spec_error *error)
{
	*sum = 0;
	for (size_t i = 0; i <= RANGE_NM; i++)
		*sum += product[RANGE_NM + 1 + i];
	if (!(isfinite(*sum) && *sum > 0))
		return spec_error_set(error, SPEC_EFORMAT,
			"observer and illuminant give no finite, positive y within %d..%d "
			"nm",
			SPEC_ABRIDGED_FIRST_NM, SPEC_ABRIDGED_LAST_NM);
	for (size_t i = 0; i < 3 * count; i++)
		weight[i] /= *sum;
	return SPEC_OK;
}

enum spec_status
spec_abridged_weights(const struct spec_curve *observer,
	const struct spec_curve *illuminant, const double *wavelength_nm, size_t count,
	double *weight, double *sum, struct spec_error *error)
{
	int step_nm = step_of(wavelength_nm, count);
	long first, before;
	double *product;
	enum spec_status status;

	if (step_nm == 0)
		return spec_error_set(error, SPEC_EUNSUPPORTED,
			"ASTM E308 has weights for bands %d or %d nm apart, not for these",
			steps_nm[0], steps_nm[1]);
	status = find_first(wavelength_nm, count, step_nm, &first, error);
	if (status != SPEC_OK)
		return status;
	product = spec_memory_new(
		4 * (size_t)(RANGE_NM + 1), sizeof *product, "wavelengths", error);
	if (!product)
		return SPEC_ENOMEM;
	memset(weight, 0, 3 * count * sizeof *weight);
	before = first < 0 ? -first : 0;
	status = multiply(observer, illuminant, product, error);
	if (status == SPEC_OK) {
		fold(product, step_nm, first + before, count - (size_t)before,
			weight + before, count);
		status = normalise(product, weight, count, sum, error);
	}
	free(product);
	return status;
}
