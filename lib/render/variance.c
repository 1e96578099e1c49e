#include "render/variance.h"

#include <stdint.h>

#include "base/vector.h"

static unsigned
count_batches(unsigned samples)
{
	return samples < SPEC_VARIANCE_BATCHES ? samples : SPEC_VARIANCE_BATCHES;
}

int
spec_variance_ends(unsigned sample, unsigned samples)
{
	uint64_t batches = count_batches(samples);

	return batches * sample / samples < batches * (sample + 1ULL) / samples;
}

SPEC_VECTORISED void
spec_variance_add(double *restrict squares, double *restrict before,
	const double *restrict after, size_t count, unsigned size)
{
	double share = 1.0 / size;

	for (size_t i = 0; i < count; i++) {
		double sum = after[i] - before[i];

		squares[i] += sum * sum * share;
		before[i] = after[i];
	}
}

void
spec_variance_finish(double *squares, const double *sum, size_t count, unsigned samples)
{
	double n = samples, batches = count_batches(samples);

	for (size_t i = 0; i < count; i++) {
		double between = squares[i] - sum[i] * sum[i] / n;

		squares[i] = between < 0 ? 0 : between / ((batches - 1) * n);
	}
}
