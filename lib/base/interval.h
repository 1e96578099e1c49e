/* Looking up numbers in ascending lists, by halving. A value that is no number is below all. */
#ifndef SPEC_BASE_INTERVAL_H
#define SPEC_BASE_INTERVAL_H

#include <stddef.h>

/*
 * Which of so many intervals holds a value, 0..intervals-1. Interval i begins at edge[i]; the
 * first holds what is below it, too, and the last all that is above.
 */
static inline size_t
spec_interval_find(const double *edge, size_t intervals, double value)
{
	size_t low = 0, high = intervals;

	while (high - low > 1) {
		size_t middle = low + (high - low) / 2;

		if (edge[middle] <= value)
			low = middle;
		else
			high = middle;
	}
	return low;
}

/* How many edges lie at or below a value. */
static inline size_t
spec_interval_count(const double *edge, size_t edges, double value)
{
	size_t last = spec_interval_find(edge, edges, value);

	return edges > 0 && edge[last] <= value ? last + 1 : 0;
}

#endif
