/* Statistics against sums that are exact, or taken in long double. */
#include <float.h>
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdlib.h>
#include <string.h>

#include <cmocka.h>

#include "image/statistics.h"

enum { WIDEST = 100 };

/* Of whole numbers 1..width: mean (n + 1) / 2, squares n (n^2 - 1) / 12; all sums exact. */
static void
test_whole_numbers(void **state)
{
	float row[WIDEST];

	(void)state;
	for (size_t width = 1; width <= WIDEST; width++) {
		struct spec_statistics line;
		double n = (double)width;

		for (size_t x = 0; x < width; x++)
			row[x] = (float)(width - x);
		spec_statistics_line(&line, row, width, 7);
		assert_int_equal(line.samples, width);
		assert_int_equal(line.finite, width);
		assert_true(line.minimum == 1 && line.maximum == (float)width);
		assert_true(line.mean == (n + 1) / 2);
		assert_true(line.squares == n * (n * n - 1) / 12);
		assert_int_equal(line.nan.count, 0);
		assert_int_equal(line.negative.count, 0);
		assert_int_equal(line.above_one.count, width - 1);
		assert_true(spec_statistics_deviation(&line) == sqrt(line.squares / n));
	}
}

static void
expect_kind(
	const struct spec_statistics_kind *kind, unsigned long long count, size_t x, int y)
{
	assert_int_equal(kind->count, count);
	assert_int_equal(kind->x, x);
	assert_int_equal(kind->y, y);
}

/* Wherever in the line they stand, they are counted apart and not in the mean. */
static void
test_odd_samples(void **state)
{
	(void)state;
	for (size_t at = 0; at + 4 < 40; at++) {
		struct spec_statistics line;
		float row[40];

		for (size_t x = 0; x < 40; x++)
			row[x] = 0.5F;
		row[at] = NAN;
		row[at + 1] = -INFINITY;
		row[at + 2] = INFINITY;
		row[at + 3] = -0.25F;
		row[at + 4] = 1.25F;
		spec_statistics_line(&line, row, 40, 3);
		assert_int_equal(line.finite, 37);
		expect_kind(&line.nan, 1, at, 3);
		expect_kind(&line.infinite, 2, at + 1, 3);
		expect_kind(&line.negative, 1, at + 3, 3);
		expect_kind(&line.above_one, 1, at + 4, 3);
		assert_true(line.minimum == -0.25F && line.maximum == 1.25F);
		assert_true(line.mean == 18.5 / 37);
		assert_true(line.squares == 2 * 0.75 * 0.75);
	}
}

/* Rounding that a reflectance of 1 may carry is not above 1, and no zero is negative. */
static void
test_nearly_odd_samples(void **state)
{
	const float row[] = {1.00001F, -0.0F, FLT_MAX, -FLT_MIN, nextafterf(1.00001F, 2)};
	struct spec_statistics line;

	(void)state;
	spec_statistics_line(&line, row, 5, 0);
	expect_kind(&line.above_one, 2, 2, 0);
	expect_kind(&line.negative, 1, 3, 0);
	assert_int_equal(line.infinite.count, 0);
}

static void
test_nothing_finite(void **state)
{
	const float row[] = {NAN, INFINITY, NAN};
	struct spec_statistics line, total = {0};

	(void)state;
	spec_statistics_line(&line, row, 3, 0);
	assert_int_equal(line.finite, 0);
	assert_true(isnan(spec_statistics_deviation(&line)));
	spec_statistics_add(&total, &line);
	assert_int_equal(total.samples, 3);
	assert_int_equal(total.nan.count, 2);
	assert_true(isnan(spec_statistics_deviation(&total)));
}

/*
 * Large numbers that differ little: sums of plain squares would have no digit left. The
 * mean's error is below 1e-15 of it, and that of the deviation, a 1e-6th of the mean, below
 * 1e-9 of itself: a few roundings of the mean's, 2^-52, times 1e6.
 */
static void
test_digits_do_not_cancel(void **state)
{
	struct spec_statistics total = {0}, line;
	long double sum = 0, squares = 0, mean;
	float row[50][WIDEST];
	uint32_t seed = 1;

	(void)state;
	for (int y = 0; y < 50; y++) {
		for (size_t x = 0; x < WIDEST; x++) {
			seed = seed * 1664525 + 1013904223; /* Numerical Recipes */
			row[y][x] = 65536 + (float)(seed >> 22) / 8192 + (float)y / 128;
			sum += row[y][x];
		}
		spec_statistics_line(&line, row[y], WIDEST, y);
		spec_statistics_add(&total, &line);
	}
	mean = sum / (50 * WIDEST);
	for (int y = 0; y < 50; y++) {
		for (size_t x = 0; x < WIDEST; x++)
			squares += (row[y][x] - mean) * (row[y][x] - mean);
	}
	assert_int_equal(total.finite, 50 * WIDEST);
	assert_true(fabsl(total.mean - mean) < 1e-15L * mean);
	assert_true(fabsl(total.squares - squares) < 2e-9L * squares);
}

/* The first of several parts is the earliest in the image, whatever part comes first. */
static void
test_the_first_place(void **state)
{
	struct spec_statistics early = {0}, late = {0}, total = {0};

	(void)state;
	early.nan = (struct spec_statistics_kind){2, 9, 1};
	late.nan = (struct spec_statistics_kind){3, 4, 2};
	spec_statistics_add(&total, &late);
	spec_statistics_add(&total, &early);
	expect_kind(&total.nan, 5, 9, 1);
	late.nan = (struct spec_statistics_kind){1, 8, 1};
	spec_statistics_add(&total, &late);
	expect_kind(&total.nan, 6, 8, 1);
}

int
main(void)
{
	const struct CMUnitTest tests[] = {
		cmocka_unit_test(test_whole_numbers),
		cmocka_unit_test(test_odd_samples),
		cmocka_unit_test(test_nearly_odd_samples),
		cmocka_unit_test(test_nothing_finite),
		cmocka_unit_test(test_digits_do_not_cancel),
		cmocka_unit_test(test_the_first_place),
	};

	return cmocka_run_group_tests(tests, NULL, NULL);
}
