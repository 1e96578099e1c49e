#include "spectrum/rebin.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "base/interval.h"
#include "base/memory.h"
#include "spectrum/product.h"

#define SLACK 1e-9 /* relative: rounding in an edge is no gap */

void
spec_bins_halfway(const double *wavelength_nm, size_t count, double *edges_nm)
{
	for (size_t i = 1; i < count; i++)
		edges_nm[i] = .5 * (wavelength_nm[i - 1] + wavelength_nm[i]);
	if (count == 1) {
		edges_nm[0] = wavelength_nm[0] - .5;
		edges_nm[1] = wavelength_nm[0] + .5;
		return;
	}
	edges_nm[0] = wavelength_nm[0] - (edges_nm[1] - wavelength_nm[0]);
	edges_nm[count] =
		wavelength_nm[count - 1] + (wavelength_nm[count - 1] - edges_nm[count - 1]);
}

double
spec_bins_shared(const double *edges_nm, size_t i, double low_nm, double high_nm)
{
	return fmax(0, fmin(edges_nm[i + 1], high_nm) - fmax(edges_nm[i], low_nm));
}

struct spec_overlap
spec_bins_overlap(const double *edges_nm, size_t bins, double low_nm, double high_nm)
{
	struct spec_overlap overlap = {0};
	double slack_nm = SLACK * high_nm;

	overlap.below_nm = fmin(edges_nm[0], high_nm) - low_nm;
	overlap.above_nm = high_nm - fmax(edges_nm[bins], low_nm);
	overlap.below_nm = overlap.below_nm > slack_nm ? overlap.below_nm : 0;
	overlap.above_nm = overlap.above_nm > slack_nm ? overlap.above_nm : 0;
	overlap.first = spec_interval_count(edges_nm + 1, bins, low_nm + slack_nm);
	while (overlap.first + overlap.count < bins &&
		edges_nm[overlap.first + overlap.count] < high_nm - slack_nm)
		overlap.count++;
	return overlap;
}

void
spec_bins_describe_outside(char *text, size_t size, double first_nm, double last_nm,
	double low_nm, double high_nm)
{
	double slack_nm = SLACK * last_nm;
	int below = first_nm - low_nm > slack_nm;
	int above = high_nm - last_nm > slack_nm;
	int length = 0;

	text[0] = '\0';
	if (below)
		length = snprintf(text, size, "%g..%g nm", low_nm, fmin(first_nm, high_nm));
	if (above)
		snprintf(text + length, size - (size_t)length, "%s%g..%g nm",
			below ? " and " : "", fmax(last_nm, low_nm), high_nm);
}

/* The mean over one bin of a column. */
static double
mean_of(const struct spec_curve *curve, const double *value, const double *edges_nm,
	const double *bin_nm, enum spec_extrapolate extrapolate)
{
	struct spec_overlap overlap =
		spec_bins_overlap(edges_nm, curve->count, bin_nm[0], bin_nm[1]);
	double sum = 0;

	for (size_t i = overlap.first; i < overlap.first + overlap.count; i++)
		sum += value[i] * spec_bins_shared(edges_nm, i, bin_nm[0], bin_nm[1]);
	if (extrapolate == SPEC_EXTRAPOLATE_CONSTANT)
		sum += overlap.below_nm * value[0] +
		       overlap.above_nm * value[curve->count - 1];
	return sum / (bin_nm[1] - bin_nm[0]);
}

static enum spec_status
check_bins(const struct spec_curve *curve, const double *known_nm, const double *wanted_nm,
	size_t bins, struct spec_error *error)
{
	for (size_t i = 0; i < bins; i++) {
		if (spec_bins_overlap(
			    known_nm, curve->count, wanted_nm[i], wanted_nm[i + 1])
				.count == 0)
			return spec_error_set(error, SPEC_ERANGE,
				"'%.200s' covers %g..%g nm, not the bin %g..%g nm "
				"(--extrapolate zero|constant)",
				spec_curve_name(curve), known_nm[0], known_nm[curve->count],
				wanted_nm[i], wanted_nm[i + 1]);
	}
	return SPEC_OK;
}

/* The edges of the bins half-way between one wavelength and the next, of an end of count. */
static void
outer_edges(const double *wavelength_nm, size_t count, double *low_nm, double *high_nm)
{
	double edges_nm[3];
	size_t pair = count < 2 ? count : 2;

	spec_bins_halfway(wavelength_nm, pair, edges_nm);
	*low_nm = edges_nm[0];
	spec_bins_halfway(wavelength_nm + count - pair, pair, edges_nm);
	*high_nm = edges_nm[pair];
}

void
spec_curve_describe_outside(const struct spec_curve *curve, const struct spec_grid *grid,
	const double *edges_nm, int rebin, char *text, size_t size)
{
	double first_nm = curve->wavelength_nm[0];
	double last_nm = curve->wavelength_nm[curve->count - 1];
	double low_nm = grid->wavelength_nm[0];
	double high_nm = grid->wavelength_nm[grid->count - 1];

	if (rebin) {
		outer_edges(curve->wavelength_nm, curve->count, &first_nm, &last_nm);
		outer_edges(grid->wavelength_nm, grid->count, &low_nm, &high_nm);
	}
	if (rebin && edges_nm) {
		low_nm = edges_nm[0];
		high_nm = edges_nm[grid->count];
	}
	spec_bins_describe_outside(text, size, first_nm, last_nm, low_nm, high_nm);
}

enum spec_status
spec_curve_rebin(const struct spec_curve *curve, const struct spec_grid *grid,
	const double *edges_nm, enum spec_extrapolate extrapolate,
	struct spec_curve *result, struct spec_error *error)
{
	double *known_nm =
		spec_memory_new(curve->count + 1, sizeof *known_nm, "edges", error);
	double *wanted_nm =
		spec_memory_new(grid->count + 1, sizeof *wanted_nm, "edges", error);
	enum spec_status status = known_nm && wanted_nm ? SPEC_OK : SPEC_ENOMEM;

	*result = (struct spec_curve){0};
	if (status == SPEC_OK) {
		spec_bins_halfway(curve->wavelength_nm, curve->count, known_nm);
		if (edges_nm)
			memcpy(wanted_nm, edges_nm, (grid->count + 1) * sizeof *edges_nm);
		else
			spec_bins_halfway(grid->wavelength_nm, grid->count, wanted_nm);
	}
	if (status == SPEC_OK && extrapolate == SPEC_EXTRAPOLATE_REFUSE)
		status = check_bins(curve, known_nm, wanted_nm, grid->count, error);
	/* For the texts; the values are overwritten. */
	if (status == SPEC_OK)
		status = spec_curve_resample(
			curve, grid, SPEC_EXTRAPOLATE_CONSTANT, result, error);
	for (size_t j = 0; status == SPEC_OK && j < curve->columns; j++)
		for (size_t i = 0; i < grid->count; i++)
			result->value[j * grid->count + i] =
				mean_of(curve, curve->value + j * curve->count, known_nm,
					wanted_nm + i, extrapolate);
	free(known_nm);
	free(wanted_nm);
	return status;
}
