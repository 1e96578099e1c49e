/* Whether two renders are the same within their noise. */
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "compare/significance.h"

#include "check.h"
#include "random.h"

enum { BANDS = 2, WIDTH = 40, HEIGHT = 33, TRIALS = 400 };

struct images {
	float a[HEIGHT][BANDS][WIDTH], b[HEIGHT][BANDS][WIDTH], variance[BANDS][WIDTH];
};

static struct spec_significance
test_of(const struct images *images, int known)
{
	struct spec_significance test;
	struct spec_significance_sums sums[BANDS * WIDTH];
	struct spec_error error;
	size_t pixel[WIDTH];

	for (size_t x = 0; x < WIDTH; x++)
		pixel[x] = x;
	assert_int_equal(spec_significance_open(&test, BANDS, WIDTH, &error), SPEC_OK);
	assert_true(spec_significance_row_sums(BANDS, WIDTH) == 3 * BANDS);
	for (int y = 0; y < HEIGHT; y++) {
		const float *a[] = {images->a[y][0], images->a[y][1]};
		const float *b[] = {images->b[y][0], images->b[y][1]};
		const float *variance[] = {images->variance[0], images->variance[1]};

		spec_significance_row(BANDS, WIDTH, a, b, known ? variance : NULL,
			known ? variance : NULL, pixel, WIDTH, sums);
		spec_significance_add(&test, sums, y);
	}
	spec_significance_finish(&test);
	return test;
}

/* A path tracer's noise: mostly small, at times a firefly. Its mean is the same everywhere. */
static float
noise(uint64_t *seed)
{
	double u = random_share(seed);

	return (float)(1 / sqrt(1e-4 + u)); /* P(X > t) falls as t^-2 */
}

static void
fill(struct images *images, uint64_t *seed)
{
	for (int y = 0; y < HEIGHT; y++) {
		for (int x = 0; x < WIDTH; x++) {
			images->a[y][0][x] = noise(seed);
			images->b[y][0][x] = noise(seed);
			/* The second band hangs on the first, as along one path. */
			images->a[y][1][x] = 2 * images->a[y][0][x];
			images->b[y][1][x] = 2 * images->b[y][0][x];
		}
	}
}

/*
 * False alarms are at most as many as the level says: at 1 sigma 0.3173 of the trials, and
 * 4 standard deviations of their number. All bounds hold, so that there are far fewer; but
 * p is no constant.
 */
static void
test_false_alarms(void **state)
{
	struct images *images = calloc(1, sizeof *images);
	double level = spec_significance_level(1), least = 1;
	uint64_t seed = 1;
	int alarms = 0;

	(void)state;
	near(level, 0.31731050786291410, 1e-15, "one sigma");
	near(spec_significance_level(3), 0.0026997960632601866, 1e-16, "three sigma");
	for (int i = 0; i < TRIALS; i++) {
		struct spec_significance test;

		fill(images, &seed);
		test = test_of(images, 0);
		/* 3 x 3 tiles, the whole band and its chi-square, of two bands */
		assert_true(test.tests == 22);
		alarms += spec_significance_p(&test) <= level;
		least = fmin(least, spec_significance_p(&test));
		spec_significance_free(&test);
	}
	assert_true(alarms <= level * TRIALS + 4 * sqrt(level * (1 - level) * TRIALS));
	assert_true(least < 1);
	free(images);
}

/* z of n equal differences is the root of n; Q of N tiles is their pixels' sum. */
static void
test_closed_forms(void **state)
{
	struct images *images = calloc(1, sizeof *images);
	struct spec_significance test;
	double n = WIDTH * HEIGHT, t = n / 9;

	(void)state;
	for (int y = 0; y < HEIGHT; y++)
		for (int x = 0; x < WIDTH; x++)
			images->a[y][0][x] = 3;
	test = test_of(images, 0);
	near(spec_significance_least(&test, 3), 2 * log(2 * 22 / 0.0026997960632601866),
		1e-12, "pixels");
	/* Of the bounds exp(-n/2) 2 and exp(-9/2 (t - 1 - ln t)) the first is less. */
	assert_int_equal(test.kind, SPEC_SIGNIFICANCE_BAND);
	near(test.value, sqrt(n), 1e-12, "z");
	near(test.mean, 3, 0, "mean");
	near(test.evidence, n / 2 - log(2), 1e-9, "evidence");
	assert_true(test.evidence > 4.5 * (t - 1 - log(t)));
	assert_true(test.in_band == 0);
	spec_significance_free(&test);
	for (int x = 0; x < WIDTH; x++)
		images->variance[0][x] = images->variance[1][x] = 4.5f / 4 * WIDTH * HEIGHT;
	test = test_of(images, 1);
	/* 3 n / sqrt(2 * 4.5 n^2 / 4) = 2 */
	near(spec_significance_p(&test), 1, 0, "noise of that size");
	near(test.value, 2, 1e-12, "z");
	spec_significance_free(&test);
	free(images);
}

/* A bias in one tile is found there; so is one that changes its sign from tile to tile. */
static void
test_bias(void **state)
{
	struct images *images = calloc(1, sizeof *images);
	struct spec_significance test;
	uint64_t seed = 2;

	(void)state;
	fill(images, &seed);
	for (int y = 16; y < 32; y++)
		for (int x = 16; x < 32; x++)
			images->b[y][1][x] += 8;
	test = test_of(images, 0);
	assert_true(spec_significance_p(&test) < 1e-6);
	assert_int_equal(test.kind, SPEC_SIGNIFICANCE_ONE_TILE);
	assert_true(test.in_band == 1 && test.x == 16 && test.y == 16 && test.value < 0);
	spec_significance_free(&test);
	fill(images, &seed);
	for (int y = 0; y < HEIGHT; y++)
		for (int x = 0; x < WIDTH; x++)
			images->b[y][0][x] += (x / 16 + y / 16) % 2 ? .8f : -.8f;
	test = test_of(images, 0);
	assert_int_equal(test.kind, SPEC_SIGNIFICANCE_TILES);
	assert_true(spec_significance_p(&test) < spec_significance_level(3));
	spec_significance_free(&test);
	free(images);
}

/* What is not finite is left out: others tell of it. */
static void
test_spoiled(void **state)
{
	struct images *images = calloc(1, sizeof *images);
	struct spec_significance test;

	(void)state;
	images->a[3][0][4] = NAN;
	images->a[5][1][6] = INFINITY;
	test = test_of(images, 0);
	near(spec_significance_p(&test), 1, 0, "nothing but zeros");
	near(test.band[0].pixels, WIDTH * HEIGHT - 1, 0, "pixels");
	spec_significance_free(&test);
	images->variance[0][7] = NAN;
	images->variance[0][8] = -1;
	test = test_of(images, 1);
	near(test.band[0].pixels, WIDTH * HEIGHT - 1 - 2 * HEIGHT, 0, "pixels");
	spec_significance_free(&test);
	free(images);
}

int
main(void)
{
	const struct CMUnitTest tests[] = {
		cmocka_unit_test(test_false_alarms),
		cmocka_unit_test(test_closed_forms),
		cmocka_unit_test(test_bias),
		cmocka_unit_test(test_spoiled),
	};

	return cmocka_run_group_tests(tests, NULL, NULL);
}
