#include "spectrum/mean.h"

#include <math.h>

#include "base/interval.h"

/* The column of a curve, and the first sample that no bin has passed. */
struct walk {
	size_t count, next;
	const double *wavelength_nm, *value;
};

/* What a bin has gathered from its pieces. */
struct gathered {
	double integral, lowest, highest;
};

static enum spec_status
check_edges(const double *edges_nm, size_t bins, struct spec_error *error)
{
	for (size_t i = 0; i <= bins; i++) {
		if (!isfinite(edges_nm[i]))
			return spec_error_set(
				error, SPEC_ERANGE, "bin edge %zu is not finite", i + 1);
		if (i > 0 && !(edges_nm[i] > edges_nm[i - 1]))
			return spec_error_set(error, SPEC_ERANGE,
				"bin edges do not ascend: %.10g nm follows %.10g nm",
				edges_nm[i], edges_nm[i - 1]);
	}
	return SPEC_OK;
}

/* Adds a straight piece of a curve. */
static void
gather(struct gathered *gathered, double width_nm, double from, double to)
{
	gathered->integral += .5 * width_nm * (from + to);
	gathered->lowest = fmin(gathered->lowest, fmin(from, to));
	gathered->highest = fmax(gathered->highest, fmax(from, to));
}

/* The curve at nm, which lies between the sample before the next and the next. */
static double
value_at(const struct walk *walk, double nm)
{
	size_t i = walk->next;
	double from_nm, to_nm, from;

	if (i == walk->count || nm <= walk->wavelength_nm[i - 1])
		return walk->value[i - 1];
	from_nm = walk->wavelength_nm[i - 1];
	to_nm = walk->wavelength_nm[i];
	from = walk->value[i - 1];
	return from + (walk->value[i] - from) * ((nm - from_nm) / (to_nm - from_nm));
}

/* From a to b, both within the data; a lies before the next sample. Moves on to b. */
static void
gather_inside(struct walk *walk, double a_nm, double b_nm, struct gathered *gathered)
{
	double from_nm = a_nm, from = value_at(walk, a_nm), to;

	for (; walk->next < walk->count && walk->wavelength_nm[walk->next] <= b_nm;
		walk->next++) {
		to = walk->value[walk->next];
		gather(gathered, walk->wavelength_nm[walk->next] - from_nm, from, to);
		from_nm = walk->wavelength_nm[walk->next];
		from = to;
	}
	if (from_nm < b_nm)
		gather(gathered, b_nm - from_nm, from, value_at(walk, b_nm));
}

static double
mean_of_bin(struct walk *walk, enum spec_extrapolate extrapolate, double a_nm, double b_nm)
{
	double first_nm = walk->wavelength_nm[0];
	double last_nm = walk->wavelength_nm[walk->count - 1];
	/* What is refused has been; the rest beyond an end counts as that end. */
	int zero = extrapolate == SPEC_EXTRAPOLATE_ZERO;
	double before = zero ? 0 : walk->value[0];
	double after = zero ? 0 : walk->value[walk->count - 1];
	double inner_a_nm = fmax(a_nm, first_nm), inner_b_nm = fmin(b_nm, last_nm);
	struct gathered gathered = {0, INFINITY, -INFINITY};

	if (a_nm < first_nm)
		gather(&gathered, fmin(b_nm, first_nm) - a_nm, before, before);
	if (inner_a_nm < inner_b_nm)
		gather_inside(walk, inner_a_nm, inner_b_nm, &gathered);
	if (b_nm > last_nm)
		gather(&gathered, b_nm - fmax(a_nm, last_nm), after, after);
	return fmin(
		fmax(gathered.integral / (b_nm - a_nm), gathered.lowest), gathered.highest);
}

enum spec_status
spec_curve_mean(const struct spec_curve *curve, size_t column,
	enum spec_extrapolate extrapolate, const double *edges_nm, size_t bins,
	double *value, struct spec_error *error)
{
	enum spec_status status = check_edges(edges_nm, bins, error);
	struct walk walk = {.count = curve->count, .wavelength_nm = curve->wavelength_nm};
	double ends_nm[2], ends[2];

	if (status != SPEC_OK)
		return status;
	ends_nm[0] = edges_nm[0];
	ends_nm[1] = edges_nm[bins];
	status = spec_curve_sample(curve, column, extrapolate, ends_nm, 2, ends, error);
	if (status != SPEC_OK)
		return status;
	walk.value = curve->value + column * curve->count;
	walk.next = spec_interval_count(
		walk.wavelength_nm, walk.count, fmax(edges_nm[0], curve->wavelength_nm[0]));
	for (size_t i = 0; i < bins; i++)
		value[i] = mean_of_bin(&walk, extrapolate, edges_nm[i], edges_nm[i + 1]);
	return SPEC_OK;
}
