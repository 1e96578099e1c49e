/* What the maps of a comparison of images say. */
#include <math.h>
#include <stdlib.h>

#include "base/memory.h"
#include "compare/images.h"

static int
ascending(const void *a, const void *b)
{
	const float *one = a, *two = b;

	return (*one > *two) - (*one < *two);
}

static size_t
count_pixels(const struct spec_images *result)
{
	return spec_window_width(&result->region) * spec_window_height(&result->region);
}

enum spec_status
spec_images_percentile(const struct spec_images *result, enum spec_detail_pixel kind,
	double share, double *value, size_t *x, int *y, struct spec_error *error)
{
	const float *map = result->map[kind];
	size_t pixels = count_pixels(result), count = 0, rank, at = 0;
	size_t width = spec_window_width(&result->region);
	float *sorted = spec_memory_new(pixels, sizeof *sorted, "pixels", error);

	if (!sorted)
		return SPEC_ENOMEM;
	for (size_t i = 0; i < pixels; i++)
		if (!isnan(map[i]))
			sorted[count++] = map[i];
	*value = NAN;
	*x = 0;
	*y = 0;
	if (count > 0) {
		qsort(sorted, count, sizeof *sorted, ascending);
		rank = (size_t)ceil(share * (double)count);
		rank = rank < 1 ? 0 : rank > count ? count - 1 : rank - 1;
		*value = sorted[rank];
		while (map[at] != sorted[rank])
			at++;
		*x = at % width + (size_t)result->region.x0;
		*y = (int)(at / width) + result->region.y0;
	}
	free(sorted);
	return SPEC_OK;
}

double
spec_images_mean(const struct spec_images *result, enum spec_detail_pixel kind)
{
	const float *map = result->map[kind];
	size_t pixels = count_pixels(result), count = 0;
	double sum = 0, lost = 0; /* Neumaier 1974 */

	for (size_t i = 0; i < pixels; i++) {
		double value = map[i], total = sum + value;

		if (isnan(value))
			continue;
		lost += fabs(sum) >= fabs(value) ? sum - total + value
						 : value - total + sum;
		sum = total;
		count++;
	}
	return (isfinite(sum) ? sum + lost : sum) / (double)count;
}

void
spec_images_free(struct spec_images *result)
{
	free(result->band);
	free(result->band_channel);
	free(result->band_nm);
	free(result->width_nm);
	spec_significance_free(&result->test);
	free(result->seen[0]);
	free(result->seen[1]);
	for (int kind = 0; kind < SPEC_DETAIL_PIXELS; kind++)
		free(result->map[kind]);
	*result = (struct spec_images){0};
}
