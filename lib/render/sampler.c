#include "render/sampler.h"

#include "base/vector.h"

static inline uint64_t
mix(uint64_t z)
{
	/* splitmix64's finisher (Steele, Lea & Flood 2014) */
	z = (z ^ (z >> 30)) * 0xbf58476d1ce4e5b9;
	z = (z ^ (z >> 27)) * 0x94d049bb133111eb;
	return z ^ (z >> 31);
}

static inline uint32_t
reverse(uint32_t x)
{
	x = x << 16 | x >> 16;
	x = (x & 0x00ff00ff) << 8 | (x >> 8 & 0x00ff00ff);
	x = (x & 0x0f0f0f0f) << 4 | (x >> 4 & 0x0f0f0f0f);
	x = (x & 0x33333333) << 2 | (x >> 2 & 0x33333333);
	return (x & 0x55555555) << 1 | (x >> 1 & 0x55555555);
}

/* Burley's listing 1 with Vegdahl's constants (2021): each bit depends on those above it. */
static inline uint32_t
scramble_reversed(uint32_t x, uint32_t seed)
{
	x ^= x * 0x3d20adea;
	x += seed;
	x *= (seed >> 16) | 1;
	x ^= x * 0x05526c56;
	x ^= x * 0x53a22864;
	return x;
}

/* Sobol's second dimension, reversed, from an index: Pascal's triangle modulo 2, by halves. */
static inline uint32_t
second_reversed(uint32_t index)
{
	index ^= index >> 16;
	index ^= (index & 0xff00ff00) >> 8;
	index ^= (index & 0xf0f0f0f0) >> 4;
	index ^= (index & 0xcccccccc) >> 2;
	return index ^ (index & 0xaaaaaaaa) >> 1;
}

void
spec_sampler_start(
	struct spec_sampler *sampler, uint64_t seed, int x, int y, uint32_t sample)
{
	uint64_t pixel = (uint64_t)(uint32_t)x << 32 | (uint32_t)y;

	sampler->seed = mix(mix(seed + 0x9e3779b97f4a7c15) ^ mix(pixel));
	sampler->reversed = reverse(sample);
	sampler->dimension = 0;
}

SPEC_VECTORISED void
spec_sampler_fill(struct spec_sampler *sampler)
{
	uint64_t seed = sampler->seed, dimension = sampler->dimension;
	uint32_t reversed = sampler->reversed;
	uint32_t order[SPEC_SAMPLER_AHEAD], first[SPEC_SAMPLER_AHEAD];
	uint32_t second[SPEC_SAMPLER_AHEAD];

	for (unsigned i = 0; i < SPEC_SAMPLER_AHEAD; i++) {
		uint64_t hash = mix(seed + 0x9e3779b97f4a7c15 * (dimension + i + 1));

		order[i] = (uint32_t)hash;
		first[i] = (uint32_t)(hash >> 32);
		second[i] = (uint32_t)mix(hash ^ 0xd1b54a32d192ed03);
	}
	for (unsigned i = 0; i < SPEC_SAMPLER_AHEAD; i++) {
		uint32_t index = reverse(scramble_reversed(reversed, order[i]));

		sampler->first[i] = reverse(scramble_reversed(index, first[i])) * 0x1p-32;
		sampler->second[i] =
			reverse(scramble_reversed(second_reversed(index), second[i])) *
			0x1p-32;
	}
}
