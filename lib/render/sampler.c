#include "render/sampler.h"

static uint64_t
mix(uint64_t z)
{
	/* splitmix64's finisher (Steele, Lea & Flood 2014) */
	z = (z ^ (z >> 30)) * 0xbf58476d1ce4e5b9;
	z = (z ^ (z >> 27)) * 0x94d049bb133111eb;
	return z ^ (z >> 31);
}

static uint64_t
reverse_long(uint64_t x)
{
	x = __builtin_bswap64(x);
	x = (x & 0x0f0f0f0f0f0f0f0f) << 4 | (x >> 4 & 0x0f0f0f0f0f0f0f0f);
	x = (x & 0x3333333333333333) << 2 | (x >> 2 & 0x3333333333333333);
	return (x & 0x5555555555555555) << 1 | (x >> 1 & 0x5555555555555555);
}

static uint32_t
reverse(uint32_t x)
{
	return (uint32_t)(reverse_long(x) >> 32);
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

/* Sobol's second dimension, reversed, from an index: Pascal's triangle modulo 2, by halves. */
static uint32_t
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

void
spec_sampler_pair(struct spec_sampler *sampler, double pair[2])
{
	uint64_t hash = mix(sampler->seed + 0x9e3779b97f4a7c15 * ++sampler->dimension);
	uint64_t other = mix(hash ^ 0xd1b54a32d192ed03);
	uint32_t index = reverse(scramble_reversed(sampler->reversed, (uint32_t)hash));
	uint32_t first = scramble_reversed(index, (uint32_t)(hash >> 32));
	uint32_t second = scramble_reversed(second_reversed(index), (uint32_t)other);
	uint64_t both = reverse_long((uint64_t)first << 32 | second);

	pair[0] = (uint32_t)both * 0x1p-32;
	pair[1] = (uint32_t)(both >> 32) * 0x1p-32;
}

double
spec_sampler_number(struct spec_sampler *sampler)
{
	uint64_t hash = mix(sampler->seed + 0x9e3779b97f4a7c15 * ++sampler->dimension);
	uint32_t index = reverse(scramble_reversed(sampler->reversed, (uint32_t)hash));

	return reverse(scramble_reversed(index, (uint32_t)(hash >> 32))) * 0x1p-32;
}
