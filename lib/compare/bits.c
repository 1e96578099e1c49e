/* Samples that are equal or not: whole numbers, and any number bit for bit. */
#include <stdint.h>
#include <string.h>

#include "compare/comparing.h"

static uint32_t
distance(uint32_t a, uint32_t b)
{
	return a > b ? a - b : b - a;
}

void
spec_comparing_whole_row(const float *a, const float *b, size_t count, size_t channel,
	int y, struct spec_whole *whole)
{
	for (size_t x = 0; x < count; x++) {
		uint32_t one, two;

		memcpy(&one, a + x, sizeof one);
		memcpy(&two, b + x, sizeof two);
		if (one == two)
			continue;
		if (whole->differing++ == 0 ||
			distance(one, two) > distance(whole->a, whole->b)) {
			whole->a = one;
			whole->b = two;
			whole->x = x;
			whole->y = y;
			whole->channel = channel;
		}
	}
}

void
spec_comparing_whole_add(struct spec_whole *total, const struct spec_whole *row)
{
	unsigned long long before = total->differing;

	if (row->differing == 0)
		return;
	if (before == 0 || distance(row->a, row->b) > distance(total->a, total->b))
		*total = *row;
	total->differing = before + row->differing;
}

void
spec_comparing_exact_row(const struct spec_comparing_pairs *pairs,
	const float *const *plane, size_t count, int y, struct spec_exact *exact)
{
	for (size_t i = 0; i < pairs->count; i++) {
		const float *a = plane[i], *b = plane[pairs->count + i];

		if (memcmp(a, b, count * sizeof *a) == 0)
			continue;
		for (size_t x = 0; x < count; x++) {
			struct spec_exact here = {
				exact->differing, 0, 0, x, pairs->a[i], y};

			memcpy(&here.a, a + x, sizeof here.a);
			memcpy(&here.b, b + x, sizeof here.b);
			if (here.a == here.b)
				continue;
			if (exact->differing == 0)
				*exact = here;
			exact->differing++;
		}
	}
}

void
spec_comparing_exact_add(struct spec_exact *total, const struct spec_exact *row)
{
	unsigned long long before = total->differing;

	if (before == 0)
		*total = *row;
	else
		total->differing = before + row->differing;
}
