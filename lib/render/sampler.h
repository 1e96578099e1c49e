/*
 * Numbers in [0, 1) for the samples of a pixel: for every pair of dimensions a scrambled and
 * shuffled (0,2)-sequence of its own, so that n samples of a pixel fill each pair evenly.
 * They depend on the seed, the pixel and the sample's number alone.
 *
 * Source: Sobol's first two dimensions, scrambled after Owen (1995) by the hash of Burley,
 * Practical Hash-based Owen Scrambling, JCGT 9(4), 2020.
 */
#ifndef SPEC_RENDER_SAMPLER_H
#define SPEC_RENDER_SAMPLER_H

#include <stdint.h>

#define SPEC_SAMPLER_AHEAD 8 /* pairs that are made together, which is vector code */

struct spec_sampler {
	uint64_t seed;     /* of the pixel */
	uint32_t reversed; /* the sample's number, its bits in reverse */
	uint32_t dimension;
	double first[SPEC_SAMPLER_AHEAD], second[SPEC_SAMPLER_AHEAD];
};

/* The sample's first numbers come next. */
void spec_sampler_start(
	struct spec_sampler *sampler, uint64_t seed, int x, int y, uint32_t sample);

/* Makes the pairs from the next dimension on. */
void spec_sampler_fill(struct spec_sampler *sampler);

/* The next pair, and the next number, of the sample. */
static inline void
spec_sampler_pair(struct spec_sampler *sampler, double pair[2])
{
	uint32_t i = sampler->dimension % SPEC_SAMPLER_AHEAD;

	if (i == 0)
		spec_sampler_fill(sampler);
	sampler->dimension++;
	pair[0] = sampler->first[i];
	pair[1] = sampler->second[i];
}

static inline double
spec_sampler_number(struct spec_sampler *sampler)
{
	double pair[2];

	spec_sampler_pair(sampler, pair);
	return pair[0];
}

#endif
