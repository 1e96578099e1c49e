/* The numbers behind a picture's samples: how evenly they lie, and what they depend on. */
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <string.h>

#include <cmocka.h>

#include "render/sampler.h"

#define DIMENSIONS 12
#define LARGEST 256

/* Of the pixel at (x, y), the pair that sample draws as its dimension-th. */
static void
draw(uint64_t seed, int x, int y, uint32_t sample, int dimension, double pair[2])
{
	struct spec_sampler sampler;

	spec_sampler_start(&sampler, seed, x, y, sample);
	for (int i = 0; i <= dimension; i++)
		spec_sampler_pair(&sampler, pair);
}

/* --- elementary intervals --- */

/* n pairs from sample first on: every interval of 2^i by n / 2^i holds one. */
static void
expect_net(uint64_t seed, int x, int dimension, uint32_t first, unsigned n)
{
	double pair[LARGEST][2];

	for (unsigned i = 0; i < n; i++)
		draw(seed, x, 3, first + i, dimension, pair[i]);
	for (unsigned across = 1; across <= n; across *= 2) {
		unsigned char seen[LARGEST] = {0};
		unsigned down = n / across;

		for (unsigned i = 0; i < n; i++) {
			unsigned a = (unsigned)(pair[i][0] * across);
			unsigned b = (unsigned)(pair[i][1] * down);

			assert_in_range(a, 0, across - 1);
			assert_in_range(b, 0, down - 1);
			if (seen[a * down + b]++)
				fail_msg("seed %llu, pixel %d, dimension %d, samples from "
					 "%u: interval %u,%u of %u x %u is hit twice",
					(unsigned long long)seed, x, dimension, first, a, b,
					across, down);
		}
	}
}

static void
test_net(void **state)
{
	(void)state;
	for (unsigned n = 16; n <= LARGEST; n *= 4)
		for (int x = 0; x < 8; x++)
			for (int dimension = 0; dimension < DIMENSIONS; dimension++)
				for (uint64_t seed = 0; seed < 3; seed++)
					expect_net(seed, x, dimension, 0, n);
}

/* A sequence: every whole block of as many samples is a net as well, far on, too. */
static void
test_sequence(void **state)
{
	(void)state;
	for (uint32_t block = 1; block < 5; block++)
		for (int dimension = 0; dimension < DIMENSIONS; dimension++)
			expect_net(7, -1, dimension, 64 * block, 64);
	expect_net(7, 5, 1, 0xffffff00, 256);
}

static void
test_numbers(void **state)
{
	(void)state;
	for (unsigned n = 2; n <= LARGEST; n *= 2) {
		for (int x = 0; x < 50; x++) {
			unsigned char seen[LARGEST] = {0};

			for (unsigned i = 0; i < n; i++) {
				struct spec_sampler sampler;
				double pair[2], number;

				spec_sampler_start(&sampler, 1, x, 0, i);
				spec_sampler_pair(&sampler, pair);
				number = spec_sampler_number(&sampler);
				assert_true(number >= 0 && number < 1);
				assert_int_equal(seen[(unsigned)(number * n)]++, 0);
			}
		}
	}
}

/* --- moments --- */

#define PIXELS 40000

/*
 * 4 standard errors: one false alarm in 16000 of each bound, of which there are about 500
 * here; the seeds are fixed.
 */
#define SIGMAS 4

static void
expect(double value, double wanted, double bound)
{
	if (!(fabs(value - wanted) <= bound))
		fail_msg("%.8g instead of %.8g +- %.2g", value, wanted, bound);
}

/* Values of one sample in many pixels are independent. */
static void
test_moments(void **state)
{
	static const uint32_t samples[] = {0, 1, 7, 1000};

	(void)state;
	for (size_t s = 0; s < sizeof samples / sizeof *samples; s++) {
		for (int dimension = 0; dimension < DIMENSIONS; dimension++) {
			double mean[2] = {0}, square[2] = {0}, pair[2];

			for (int i = 0; i < PIXELS; i++) {
				draw(11, i % 200, i / 200, samples[s], dimension, pair);
				for (int j = 0; j < 2; j++) {
					mean[j] += pair[j] / PIXELS;
					square[j] +=
						(pair[j] - 0.5) * (pair[j] - 0.5) / PIXELS;
				}
			}
			for (int j = 0; j < 2; j++) {
				/* 1/12 and 1/180: variances of it and of its square. */
				expect(mean[j], 0.5, SIGMAS * sqrt(1. / 12 / PIXELS));
				expect(square[j], 1. / 12,
					SIGMAS * sqrt(1. / 180 / PIXELS));
			}
		}
	}
}

/*
 * Of independent numbers 12 (a - 1/2)(b - 1/2) has a standard deviation of 1. Here samples 2i
 * and 2i + 1 of a pixel lie in different halves of both dimensions, and so their products are
 * alike: at most half as many are independent.
 */
static void
test_correlation(void **state)
{
	double product[2 * DIMENSIONS][2 * DIMENSIONS] = {{0}};
	double bound = SIGMAS / sqrt(PIXELS / 2.);

	(void)state;
	for (int i = 0; i < PIXELS; i++) {
		double v[2 * DIMENSIONS];
		struct spec_sampler sampler;

		/* Sample i % 16 of its pixel: in and across pixels alike. */
		spec_sampler_start(&sampler, 5, i / 16, 0, (uint32_t)i % 16);
		for (int j = 0; j < DIMENSIONS; j++)
			spec_sampler_pair(&sampler, v + 2 * j);
		for (int j = 0; j < 2 * DIMENSIONS; j++)
			for (int k = 0; k < j; k++)
				product[j][k] += 12 * (v[j] - 0.5) * (v[k] - 0.5) / PIXELS;
	}
	for (int j = 0; j < 2 * DIMENSIONS; j++)
		for (int k = 0; k < j; k++)
			if (!(fabs(product[j][k]) < bound))
				fail_msg("numbers %d and %d: correlation %g, more than %g",
					j, k, product[j][k], bound);
}

/*
 * Of two dimensions in 16 samples, each has one number in every sixteenth. Which two go
 * together is left to chance: a cell of 16 x 16 is hit with a chance of 1/16 in a pixel.
 * 5 standard errors, 256 cells, 6 pairs of dimensions: one false alarm in 1100.
 */
static void
test_pairing(void **state)
{
	enum { ROUNDS = 20000 };
	static unsigned count[4][4][16][16];
	double sigma = sqrt(ROUNDS / 16. * 15 / 16);

	(void)state;
	memset(count, 0, sizeof count);
	for (int x = 0; x < ROUNDS; x++) {
		for (uint32_t sample = 0; sample < 16; sample++) {
			struct spec_sampler sampler;
			unsigned cell[4];
			double pair[2];

			spec_sampler_start(&sampler, 3, x, x / 100, sample);
			for (int j = 0; j < 4; j++) {
				spec_sampler_pair(&sampler, pair);
				cell[j] = (unsigned)(16 * pair[j % 2]);
			}
			for (int j = 0; j < 4; j++)
				for (int k = 0; k < j; k++)
					count[j][k][cell[j]][cell[k]]++;
		}
	}
	for (int j = 0; j < 4; j++)
		for (int k = 0; k < j; k++)
			for (int i = 0; i < 16; i++)
				for (int l = 0; l < 16; l++)
					expect(count[j][k][i][l], ROUNDS / 16., 5 * sigma);
}

/* --- what the numbers depend on --- */

static void
test_determinism(void **state)
{
	double first[16][2], again[2], other[2];

	(void)state;
	for (uint32_t i = 0; i < 16; i++)
		draw(9, 4, 2, i, 3, first[i]);
	for (uint32_t i = 16; i-- > 0;) {
		draw(9, 4, 2, i, 3, again);
		assert_memory_equal(again, first[i], sizeof again);
	}
	draw(8, 4, 2, 0, 3, other);
	assert_memory_not_equal(other, first[0], sizeof other);
	draw(9, 2, 4, 0, 3, other);
	assert_memory_not_equal(other, first[0], sizeof other);
	draw(9, 4, 2, 0, 2, other);
	assert_memory_not_equal(other, first[0], sizeof other);
	/* Pixels of negative coordinates have numbers of their own. */
	draw(9, -4, 2, 0, 3, other);
	assert_memory_not_equal(other, first[0], sizeof other);
}

/* What a number is drawn for does not shift the pairs after it. */
static void
test_one_dimension_each(void **state)
{
	struct spec_sampler a, b;
	double first[2], second[2];

	(void)state;
	spec_sampler_start(&a, 1, 2, 3, 4);
	spec_sampler_start(&b, 1, 2, 3, 4);
	(void)spec_sampler_number(&a);
	spec_sampler_pair(&b, second);
	spec_sampler_pair(&a, first);
	spec_sampler_pair(&b, second);
	assert_memory_equal(first, second, sizeof first);
}

int
main(void)
{
	const struct CMUnitTest tests[] = {
		cmocka_unit_test(test_net),
		cmocka_unit_test(test_sequence),
		cmocka_unit_test(test_numbers),
		cmocka_unit_test(test_moments),
		cmocka_unit_test(test_correlation),
		cmocka_unit_test(test_pairing),
		cmocka_unit_test(test_determinism),
		cmocka_unit_test(test_one_dimension_each),
	};

	return cmocka_run_group_tests_name("sampler", tests, NULL, NULL);
}
