/* Random numbers, the same in every run: splitmix64, from a state of the caller's. */
#ifndef TESTS_UNIT_RANDOM_H
#define TESTS_UNIT_RANDOM_H

#include <math.h>
#include <stdint.h>

/* In [0, 1). */
static inline double
random_share(uint64_t *state)
{
	uint64_t z = *state += 0x9e3779b97f4a7c15;

	z = (z ^ z >> 30) * 0xbf58476d1ce4e5b9;
	z = (z ^ z >> 27) * 0x94d049bb133111eb;
	return (double)((z ^ z >> 31) >> 11) * 0x1p-53;
}

/* In [low, high). */
static inline double
random_in(uint64_t *state, double low, double high)
{
	return low + (high - low) * random_share(state);
}

/* From least to most, which are above 0, each factor of them as likely. */
static inline double
random_between(uint64_t *state, double least, double most)
{
	return least * pow(most / least, random_share(state));
}

#endif
