#include "render/sampler.h"

static uint64_t
mix(uint64_t z)
{
	/* splitmix64's finisher (Steele, Lea & Flood 2014) */
	z = (z ^ (z >> 30)) * 0xbf58476d1ce4e5b9;
	z = (z ^ (z >> 27)) * 0x94d049bb133111eb;
	return z ^ (z >> 31);
}

static uint32_t
reverse(uint32_t x)
{
	x = __builtin_bswap32(x);
	x = (x & 0x0f0f0f0f) << 4 | (x >> 4 & 0x0f0f0f0f);
	x = (x & 0x33333333) << 2 | (x >> 2 & 0x33333333);
	return (x & 0x55555555) << 1 | (x >> 1 & 0x55555555);
}

/* Burley's listing 1 with Vegdahl's constants (2021): each bit depends on those above it. */
static uint32_t
scramble_reversed(uint32_t x, uint32_t seed)
{
	x ^= x * 0x3d20adea;
	x += seed;
	x *= (seed >> 16) | 1;
	x ^= x * 0x05526c56;
	x ^= x * 0x53a22864;
	return x;
}

static uint32_t
scramble(uint32_t x, uint32_t seed)
{
	return reverse(scramble_reversed(reverse(x), seed));
}

/*
 * Sobol's second dimension, from the reversed index, which is the first: Pascal's triangle
 * modulo 2, by halves.
 */
static uint32_t
second(uint32_t first)
{
	first ^= first << 16;
	first ^= (first & 0x00ff00ff) << 8;
	first ^= (first & 0x0f0f0f0f) << 4;
	first ^= (first & 0x33333333) << 2;
	return first ^ (first & 0x55555555) << 1;
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

void
spec_sampler_pair(struct spec_sampler *sampler, double pair[2])
{
	uint64_t hash = mix(sampler->seed + 0x9e3779b97f4a7c15 * ++sampler->dimension);
	uint64_t other = mix(hash ^ 0xd1b54a32d192ed03);
	uint32_t first = scramble_reversed(sampler->reversed, (uint32_t)hash);

	pair[0] = scramble(first, (uint32_t)(hash >> 32)) * 0x1p-32;
	pair[1] = scramble(second(first), (uint32_t)other) * 0x1p-32;
}

double
spec_sampler_number(struct spec_sampler *sampler)
{
	uint64_t hash = mix(sampler->seed + 0x9e3779b97f4a7c15 * ++sampler->dimension);
	uint32_t first = scramble_reversed(sampler->reversed, (uint32_t)hash);

	return scramble(first, (uint32_t)(hash >> 32)) * 0x1p-32;
}
