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

struct spec_sampler {
	uint64_t seed;     /* of the pixel */
	uint32_t reversed; /* the sample's number, its bits in reverse */
	uint32_t dimension;
};

/* The sample's first numbers come next. */
void spec_sampler_start(
	struct spec_sampler *sampler, uint64_t seed, int x, int y, uint32_t sample);

/* The next pair, and the next number, of the sample. */
void spec_sampler_pair(struct spec_sampler *sampler, double pair[2]);
double spec_sampler_number(struct spec_sampler *sampler);

#endif
