/* Two images on different grids: the bands of the coarser, as far as the other one reaches. */
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "base/memory.h"
#include "compare/comparing.h"
#include "spectrum/rebin.h"
#include "spectrum/weights.h"

#define FORGIVEN_NM 1e-3 /* bands closer than this are the same, as everywhere */

static double
step_nm(const struct spec_image *image)
{
	return image->bands < 2 ? 0
				: (image->wavelength_nm[image->bands - 1] -
					  image->wavelength_nm[0]) /
					  (double)(image->bands - 1);
}

static int
is_within(const struct spec_image *grid, size_t band, const struct spec_image *other)
{
	const double *low = other->wavelength_nm, *high = low + other->bands - 1;

	if (grid->edges_nm) {
		low = other->edges_nm;
		high = low + other->bands;
		return grid->edges_nm[band] >= *low - FORGIVEN_NM &&
		       grid->edges_nm[band + 1] <= *high + FORGIVEN_NM;
	}
	return grid->wavelength_nm[band] >= *low - FORGIVEN_NM &&
	       grid->wavelength_nm[band] <= *high + FORGIVEN_NM;
}

/* What of the other image's bins lies in a bin, as shares that sum to 1. */
static struct spec_overlap
bin_shares(const struct spec_image *image, double low_nm, double high_nm, double *weight)
{
	struct spec_overlap overlap =
		spec_bins_overlap(image->edges_nm, image->bands, low_nm, high_nm);
	double total = 0;

	for (size_t i = 0; i < overlap.count; i++) {
		weight[i] = spec_bins_shared(
			image->edges_nm, overlap.first + i, low_nm, high_nm);
		total += weight[i];
	}
	for (size_t i = 0; i < overlap.count; i++)
		weight[i] /= total;
	return overlap;
}

enum spec_status
spec_comparing_new_sums(struct spec_comparing_sums *sums, size_t bands, size_t terms,
	struct spec_error *error)
{
	sums->first = spec_memory_new(bands + 1, sizeof *sums->first, "bands", error);
	sums->channel = spec_memory_new(terms, sizeof *sums->channel, "bands", error);
	sums->weight = spec_memory_new(terms, sizeof *sums->weight, "bands", error);
	return sums->first && sums->channel && sums->weight ? SPEC_OK : SPEC_ENOMEM;
}

/* The sums that give bands first .. first + count - 1 of grid, in each Stokes component. */
static enum spec_status
plan_sums(struct spec_comparing_sums *sums, const struct spec_image *image,
	const struct spec_image *grid, size_t first, size_t count, struct spec_error *error)
{
	size_t stokes = (size_t)image->stokes, terms = 0;
	size_t most = grid->edges_nm ? image->bands + 2 * count : SPEC_WEIGHTS_MOST * count;
	double *weight = spec_memory_new(image->bands, sizeof *weight, "bands", error);
	enum spec_status status =
		weight ? spec_comparing_new_sums(sums, stokes * count, stokes * most, error)
		       : SPEC_ENOMEM;

	for (size_t i = 0; i < stokes * count && status == SPEC_OK; i++) {
		size_t band = first + i % count, from = 0, used = 0;

		if (grid->edges_nm) {
			struct spec_overlap overlap = bin_shares(image,
				grid->edges_nm[band], grid->edges_nm[band + 1], weight);

			from = overlap.first;
			used = overlap.count;
		} else {
			struct spec_weights at = spec_weights_at(SPEC_INTERPOLATE_LINEAR,
				image->wavelength_nm, image->bands,
				grid->wavelength_nm[band]);

			from = at.first;
			used = at.count;
			memcpy(weight, at.weight, used * sizeof *weight);
		}
		for (size_t k = 0; k < used; k++, terms++) {
			sums->channel[terms] =
				image->band_channel[i / count * image->bands + from + k];
			sums->weight[terms] = weight[k];
		}
		sums->first[i + 1] = terms;
	}
	free(weight);
	return status;
}

/* The grid's channels name the bands. */
static enum spec_status
pair_grid(struct spec_comparing *comparison, const struct spec_image *grid, size_t first,
	size_t count, struct spec_error *error)
{
	struct spec_comparing_pairs *pairs = &comparison->bands;
	size_t all = (size_t)grid->stokes * count;

	pairs->a = spec_memory_new(all, sizeof *pairs->a, "bands", error);
	pairs->b = spec_memory_new(all, sizeof *pairs->b, "bands", error);
	if (!pairs->a || !pairs->b)
		return SPEC_ENOMEM;
	pairs->count = all;
	for (size_t i = 0; i < all; i++)
		pairs->a[i] = pairs->b[i] =
			grid->band_channel[i / count * grid->bands + first + i % count];
	comparison->grid_bands = count;
	comparison->grid_nm = grid->wavelength_nm + first;
	comparison->grid_edges_nm = grid->edges_nm ? grid->edges_nm + first : NULL;
	return SPEC_OK;
}

static enum spec_status
is_per_band(const struct spec_image *image, int *per_band, struct spec_error *error)
{
	char *quantity = spec_image_quantity(image, error);

	if (!quantity)
		return SPEC_ENOMEM;
	*per_band |= strstr(quantity, "per band") != NULL;
	free(quantity);
	return SPEC_OK;
}

enum spec_status
spec_comparing_resample(
	struct spec_comparing *comparison, int *done, struct spec_error *error)
{
	const struct spec_image *a = comparison->a, *b = comparison->b;
	int second = step_nm(b) > step_nm(a), per_band = 0;
	const struct spec_image *grid = second ? b : a, *other = second ? a : b;
	size_t first = 0, count = 0;
	enum spec_status status = is_per_band(a, &per_band, error);

	if (status == SPEC_OK)
		status = is_per_band(b, &per_band, error);
	if (status != SPEC_OK || per_band || !a->edges_nm != !b->edges_nm)
		return status;
	while (first < grid->bands && !is_within(grid, first, other))
		first++;
	while (first + count < grid->bands && is_within(grid, first + count, other))
		count++;
	if (count == 0) {
		spec_comparing_say(comparison->result,
			"no band of the coarser grid lies in the other\n");
		return SPEC_OK;
	}
	status = plan_sums(&comparison->sums[0], a, grid, first, count, error);
	if (status == SPEC_OK)
		status = plan_sums(&comparison->sums[1], b, grid, first, count, error);
	if (status == SPEC_OK)
		status = pair_grid(comparison, grid, first, count, error);
	comparison->result->grid = second;
	*done = status == SPEC_OK;
	snprintf(comparison->result->notes, sizeof comparison->result->notes,
		"resampled to the %s's grid: %g to %g nm in %zu bands of %zu and %zu\n",
		second ? "second" : "first", grid->wavelength_nm[first],
		grid->wavelength_nm[first + count - 1], count, a->bands, b->bands);
	return status;
}
