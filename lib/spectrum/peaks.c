/* Finding the lines of samples; represent.h has the rule. */
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "base/memory.h"
#include "spectrum/represent.h"

#define WIDEST_NM 30.
#define FOOT .05 /* of the way come down: a step less than this is the foot */
#define RISES .1 /* of the base, by which a peak stands out */

struct peak {
	size_t left, top, right; /* the feet, and the highest sample between */
	double wavelength_nm, weight;
};

static size_t
foot_left(const double *value, size_t top)
{
	size_t i = top - 1;

	while (i > 0 && value[i] - value[i - 1] > FOOT * (value[top] - value[i]))
		i--;
	return i;
}

static size_t
foot_right(const double *value, size_t top, size_t last)
{
	size_t i = top + 1;

	while (i < last && value[i] - value[i + 1] > FOOT * (value[top] - value[i]))
		i++;
	return i;
}

/* The width that a sample stands for in the integral. */
static double
cell(const struct spec_samples *samples, size_t i)
{
	const double *nm = samples->wavelength_nm;
	double low_nm = i > 0 ? nm[i - 1] : nm[i];
	double high_nm = i + 1 < samples->count ? nm[i + 1] : nm[i];

	return .5 * (high_nm - low_nm);
}

/* Lagrange's polynomial through n points, at nm. */
static double
lagrange(const double *at_nm, const double *value, int n, double nm)
{
	double sum = 0;

	for (int i = 0; i < n; i++) {
		double part = value[i];

		for (int k = 0; k < n; k++)
			if (k != i)
				part *= (nm - at_nm[k]) / (at_nm[i] - at_nm[k]);
		sum += part;
	}
	return sum;
}

/* The base of a peak at its samples, into base; taken: samples inside any peak. */
static void
draw_base(const struct spec_samples *samples, const struct peak *peak,
	const unsigned char *taken, double *base)
{
	const double *nm = samples->wavelength_nm, *value = samples->value;
	size_t left = peak->left, right = peak->right;
	int cubic = left > 0 && right + 1 < samples->count && !taken[left - 1] &&
		    !taken[right + 1];
	double at_nm[4], at[4], least = fmin(fmin(value[left], value[right]), 0);

	at_nm[0] = nm[left];
	at_nm[1] = nm[right];
	at[0] = value[left];
	at[1] = value[right];
	if (cubic) {
		at_nm[2] = nm[left - 1];
		at_nm[3] = nm[right + 1];
		at[2] = value[left - 1];
		at[3] = value[right + 1];
	}
	for (size_t i = left + 1; i < right; i++)
		base[i] = fmin(
			fmax(lagrange(at_nm, at, cubic ? 4 : 2, nm[i]), least), value[i]);
}

/* The weight of a peak above its base, and its centre. */
static void
weigh(const struct spec_samples *samples, const double *base, struct peak *peak)
{
	double origin_nm = samples->wavelength_nm[peak->top], moment = 0;

	peak->weight = 0;
	for (size_t i = peak->left + 1; i < peak->right; i++) {
		double part = cell(samples, i) * (samples->value[i] - base[i]);

		peak->weight += part;
		moment += part * (samples->wavelength_nm[i] - origin_nm);
	}
	peak->wavelength_nm = origin_nm + (peak->weight > 0 ? moment / peak->weight : 0);
}

static int
is_narrow(const struct spec_samples *samples, const struct peak *peak)
{
	return samples->wavelength_nm[peak->right] - samples->wavelength_nm[peak->left] <=
		       WIDEST_NM ||
	       peak->right - peak->left == 2;
}

/* The narrow peaks, into peaks; returns how many. */
static size_t
find_peaks(const struct spec_samples *samples, struct peak *peaks)
{
	const double *value = samples->value;
	size_t count = 0;

	for (size_t i = 1; i + 1 < samples->count; i++) {
		struct peak peak = {.top = i};

		if (!(value[i] > value[i - 1] && value[i] >= value[i + 1]))
			continue;
		peak.left = foot_left(value, i);
		peak.right = foot_right(value, i, samples->count - 1);
		if (is_narrow(samples, &peak))
			peaks[count++] = peak;
	}
	return count;
}

/* Heaviest first; of equal ones the shortest wavelength. */
static int
compare_weights(const void *a, const void *b)
{
	const struct peak *one = a, *two = b;

	if (one->weight != two->weight)
		return one->weight < two->weight ? 1 : -1;
	return one->top > two->top ? 1 : -1;
}

static int
compare_places(const void *a, const void *b)
{
	const struct peak *one = a, *two = b;

	return one->top > two->top ? 1 : -1;
}

/* Keeps the peaks that stand out, with their weights. base: room for the samples. */
static size_t
keep_lines(const struct spec_samples *samples, struct peak *peaks, size_t count,
	unsigned char *taken, double *base)
{
	size_t kept = 0;

	for (size_t k = 0; k < count; k++)
		memset(taken + peaks[k].left + 1, 1, peaks[k].right - peaks[k].left - 1);
	for (size_t k = 0; k < count; k++) {
		size_t top = peaks[k].top;

		draw_base(samples, &peaks[k], taken, base);
		weigh(samples, base, &peaks[k]);
		if (samples->value[top] - base[top] > RISES * fabs(base[top]))
			peaks[kept++] = peaks[k];
	}
	return kept;
}

enum spec_status
spec_samples_lines(const struct spec_samples *samples, struct spec_line *line,
	size_t *lines, double *smooth, struct spec_error *error)
{
	size_t count = samples->count, found;
	struct peak *peaks = spec_memory_new(count, sizeof *peaks, "peaks", error);
	unsigned char *taken = spec_memory_new(count, 1, "samples", error);
	double *base = spec_memory_new(count, sizeof *base, "samples", error);
	enum spec_status status = peaks && taken && base ? SPEC_OK : SPEC_ENOMEM;

	memcpy(smooth, samples->value, count * sizeof *smooth);
	if (status == SPEC_OK) {
		found = find_peaks(samples, peaks);
		found = keep_lines(samples, peaks, found, taken, base);
		qsort(peaks, found, sizeof *peaks, compare_weights);
		*lines = found < *lines ? found : *lines;
		qsort(peaks, *lines, sizeof *peaks, compare_places);
		for (size_t k = 0; k < *lines; k++) {
			size_t from = peaks[k].left + 1;

			line[k] =
				(struct spec_line){peaks[k].wavelength_nm, peaks[k].weight};
			memcpy(smooth + from, base + from,
				(peaks[k].right - from) * sizeof *smooth);
		}
	}
	free(peaks);
	free(taken);
	free(base);
	return status;
}
