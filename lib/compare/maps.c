/* What the maps of a comparison of images say. */
#include <math.h>
#include <stdint.h>
#include <stdlib.h>
#include <string.h>

#include "base/memory.h"
#include "compare/images.h"

#define DIGITS 65536 /* a float's bits are two of them */

/* Whole numbers that order as the floats do (no NaN). */
static inline uint32_t
order_of(float value)
{
	uint32_t bits;

	memcpy(&bits, &value, sizeof bits);
	return bits & 0x80000000 ? ~bits : bits | 0x80000000;
}

static float
value_of(uint32_t order)
{
	uint32_t bits = order & 0x80000000 ? order & 0x7fffffff : ~order;
	float value;

	memcpy(&value, &bits, sizeof value);
	return value;
}

/*
 * The first digit that *rank of the counted do not lie below, counted from 0; *rank becomes
 * how many of that digit lie before it.
 */
static uint32_t
find_digit(const size_t *count, size_t *rank)
{
	uint32_t digit = 0;

	while (*rank >= count[digit])
		*rank -= count[digit++];
	return digit;
}

/* The value of that rank from 0 of those that are not NaN; there are more. count: DIGITS. */
static float
select_rank(const float *map, size_t pixels, size_t rank, size_t *count)
{
	uint32_t high;

	memset(count, 0, DIGITS * sizeof *count);
	for (size_t i = 0; i < pixels; i++)
		count[order_of(map[i]) >> 16] += !isnan(map[i]);
	high = find_digit(count, &rank);
	memset(count, 0, DIGITS * sizeof *count);
	for (size_t i = 0; i < pixels; i++) {
		uint32_t order = order_of(map[i]);

		if (order >> 16 == high && !isnan(map[i]))
			count[order & 0xffff]++;
	}
	return value_of(high << 16 | find_digit(count, &rank));
}

static size_t
count_pixels(const struct spec_images *result)
{
	return spec_window_width(&result->region) * spec_window_height(&result->region);
}

enum spec_status
spec_images_percentile(const struct spec_images *result, enum spec_detail_pixel kind,
	double percent, double *value, size_t *x, int *y, struct spec_error *error)
{
	const float *map = result->map[kind];
	size_t pixels = count_pixels(result), known = 0, rank, at = 0;
	size_t width = spec_window_width(&result->region);
	size_t *count = spec_memory_new(DIGITS, sizeof *count, "numbers", error);

	if (!count)
		return SPEC_ENOMEM;
	for (size_t i = 0; i < pixels; i++)
		known += !isnan(map[i]);
	*value = NAN;
	*x = 0;
	*y = 0;
	if (known > 0) {
		float found;

		/* A share of 0.07 is not, and the 7th of 100 would be the 8th. */
		rank = (size_t)ceil(percent * (double)known / 100);
		rank = rank < 1 ? 0 : rank > known ? known - 1 : rank - 1;
		found = select_rank(map, pixels, rank, count);
		while (map[at] != found)
			at++;
		*value = (double)found;
		*x = at % width + (size_t)result->region.x0;
		*y = (int)(at / width) + result->region.y0;
	}
	free(count);
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
