#include "base/nearest.h"

#include <ctype.h>
#include <stdint.h>
#include <string.h>

size_t
spec_nearest_distance(const char *a, const char *b)
{
	size_t row[SPEC_NEAREST_LONGEST + 1], length = strlen(b);

	if (length > SPEC_NEAREST_LONGEST)
		return SIZE_MAX;
	for (size_t j = 0; j <= length; j++)
		row[j] = j;
	for (size_t i = 0; a[i]; i++) {
		size_t diagonal = row[0];

		row[0] = i + 1;
		for (size_t j = 0; j < length; j++) {
			int equal = tolower((unsigned char)a[i]) ==
				    tolower((unsigned char)b[j]);
			size_t replace = diagonal + !equal;
			size_t least = row[j] < row[j + 1] ? row[j] + 1 : row[j + 1] + 1;

			diagonal = row[j + 1];
			row[j + 1] = replace < least ? replace : least;
		}
	}
	return row[length];
}

const char *
spec_nearest_name(const char *name, const void *table, size_t size)
{
	size_t length = strlen(name), least = length < 4 ? 2 : 3;
	const char *nearest = NULL;

	if (length < 2 || length > SPEC_NEAREST_LONGEST)
		return NULL;
	for (const char *row = table;; row += size) {
		const char *candidate;
		size_t distance;

		memcpy(&candidate, row, sizeof candidate);
		if (!candidate)
			return nearest;
		distance = spec_nearest_distance(name, candidate);
		if (distance < least) {
			least = distance;
			nearest = candidate;
		}
	}
}
