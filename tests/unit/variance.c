/* Variances of means of samples. */
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>

#include "render/variance.h"

#define COUNT 3
#define ROUNDED 1e-14 /* of a few sums of doubles, relative */

/* The variances of the means of so many samples, sample by sample. */
static void
run(const float (*sample)[COUNT], unsigned samples, double variance[COUNT])
{
	double sum[COUNT] = {0}, before[COUNT] = {0};
	unsigned begin = 0;

	for (int i = 0; i < COUNT; i++)
		variance[i] = 0;
	for (unsigned n = 0; n < samples; n++) {
		for (int i = 0; i < COUNT; i++)
			sum[i] += sample[n][i];
		if (!spec_variance_ends(n, samples))
			continue;
		spec_variance_add(variance, before, sum, COUNT, n + 1 - begin);
		begin = n + 1;
	}
	assert_int_equal(begin, samples);
	spec_variance_finish(variance, sum, COUNT, samples);
}

static void
expect(const double is[COUNT], const double wanted[COUNT])
{
	for (int i = 0; i < COUNT; i++)
		if (!(is[i] >= 0 && fabs(is[i] - wanted[i]) <= ROUNDED * (1 + wanted[i])))
			fail_msg("%d: %.17g instead of %.17g", i, is[i], wanted[i]);
}

/* s^2 of 1, 2, 4, 9 is 38 / 3 about the mean 4; those of a constant are 0, not below it. */
static void
test_few_samples(void **state)
{
	static const float sample[][COUNT] = {
		{1, 0.1F, 0}, {2, 0.1F, 0}, {4, 0.1F, 0}, {9, 0.1F, 8}};
	static const double four[COUNT] = {38.0 / 12, 0, 4}, two[COUNT] = {0.25, 0, 0};
	double variance[COUNT];

	(void)state;
	run(sample, 4, variance);
	expect(variance, four);
	run(sample, 2, variance);
	expect(variance, two);
}

/*
 * Ten samples are batches of 2 1 1 1 2 1 1 1: a 3 in the first, another in the second and 6 in
 * the last are 9 / 2 + 9 + 36 - 144 / 10.
 */
static void
test_batches(void **state)
{
	static const float sample[10][COUNT] = {{0}, {3, 0, 1}, {3, 0, 1}, [9] = {6, 0, 0}};
	static const double wanted[COUNT] = {
		(4.5 + 9 + 36 - 14.4) / 70, 0, (0.5 + 1 - 0.4) / 70};
	double variance[COUNT];

	(void)state;
	run(sample, 10, variance);
	expect(variance, wanted);
}

/* As many batches as there are samples up to 8, whatever their number. */
static void
test_ends(void **state)
{
	static const unsigned many[] = {2, 3, 8, 9, 1000, 16777216};

	(void)state;
	for (size_t i = 0; i < sizeof many / sizeof *many; i++) {
		unsigned ends = 0;

		for (unsigned n = 0; n < many[i]; n++)
			ends += (unsigned)spec_variance_ends(n, many[i]);
		assert_int_equal(ends, many[i] < 8 ? many[i] : 8);
		assert_true(spec_variance_ends(many[i] - 1, many[i]));
	}
}

/* What rounding takes below 0, and a NaN, which stays one. */
static void
test_rounding(void **state)
{
	double square[2] = {2.9999999999999996, NAN}, sum[2] = {3, NAN};

	(void)state;
	spec_variance_finish(square, sum, 2, 3);
	assert_true(square[0] == 0);
	assert_true(isnan(square[1]));
}

int
main(void)
{
	const struct CMUnitTest tests[] = {
		cmocka_unit_test(test_few_samples),
		cmocka_unit_test(test_batches),
		cmocka_unit_test(test_ends),
		cmocka_unit_test(test_rounding),
	};

	return cmocka_run_group_tests(tests, NULL, NULL);
}
