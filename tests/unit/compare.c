/* How far apart two images are. */
#include <float.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "colour/difference.h"
#include "compare/images.h"
#include "compare/measure.h"

#include "check.h"
#include "random.h"

#define PI 3.14159265358979323846

/* An odd width, more than two chunks of the measure, and its last chunk in part. */
enum { BANDS = 5, WIDTH = 150, HEIGHT = 7 };

struct pair {
	float a[HEIGHT][BANDS][WIDTH], b[HEIGHT][BANDS][WIDTH];
};

static void
at(struct spec_measure_place place, size_t x, int y, size_t band)
{
	assert_int_equal(place.x, x);
	assert_int_equal(place.y, y);
	assert_int_equal(place.band, band);
}

/* Both images hold the same values, .25 to 4.2, a multiple of 1/256. */
static struct pair *
new_pair(void)
{
	struct pair *pair = malloc(sizeof *pair);
	uint32_t seed = 1;
	size_t i, total = sizeof pair->a / sizeof(float);

	assert_non_null(pair);
	for (i = 0; i < total; i++) {
		seed = seed * 1664525 + 1013904223; /* Numerical Recipes */
		(&pair->a[0][0][0])[i] = .25f + (float)(seed >> 22) / 256;
	}
	memcpy(pair->b, pair->a, sizeof pair->a);
	return pair;
}

static void
measure_pair_row(const struct spec_measure_setup *setup, const struct pair *pair, int y,
	struct spec_measure *row)
{
	const float *a[BANDS], *b[BANDS];
	size_t band;

	for (band = 0; band < BANDS; band++) {
		a[band] = pair->a[y][band];
		b[band] = pair->b[y][band];
	}
	spec_measure_row(setup, a, b, WIDTH, y, row);
}

static struct spec_measure
measure_pair(const struct spec_measure_setup *setup, const struct pair *pair)
{
	struct spec_measure total, row;
	int y;

	spec_measure_clear(&total);
	for (y = 0; y < HEIGHT; y++) {
		measure_pair_row(setup, pair, y, &row);
		spec_measure_add(&total, &row);
	}
	return total;
}

static const double weights[3 * BANDS] = {
	.1, .05, .2, .3, .1, .01, .1, .4, .2, .05, .5, .3, .05, 0, 0};

static const struct spec_measure_setup everything = {BANDS, 1, weights, {1.9, 1.7, 1.8}, 0};

/* One pixel of two bands. */
static struct spec_measure
measure_pixel(float a0, float a1, float b0, float b1)
{
	const struct spec_measure_setup setup = {2, 1, NULL, {0, 0, 0}, 0};
	const float *a[2] = {&a0, &a1}, *b[2] = {&b0, &b1};
	struct spec_measure measure;

	spec_measure_row(&setup, a, b, 1, 0, &measure);
	return measure;
}

static void
test_equal(void **state)
{
	struct pair *pair = new_pair();
	struct spec_measure m = measure_pair(&everything, pair);

	(void)state;
	assert_int_equal(m.pixels, WIDTH * HEIGHT);
	assert_int_equal(m.samples, WIDTH * HEIGHT * BANDS);
	assert_int_equal(m.nonfinite, 0);
	near(spec_measure_rmse(&m), 0, 0, "rmse");
	near(spec_measure_max(&m), 0, 0, "max");
	near(spec_measure_angle_mean(&m), 0, 0, "angle mean");
	near(spec_measure_angle_max(&m), 0, 0, "angle max");
	near(spec_measure_fit_mean(&m), 1, 0, "fit mean");
	near(spec_measure_fit_min(&m), 1, 0, "fit min");
	near(spec_measure_colour_mean(&m), 0, 0, "colour mean");
	near(spec_measure_colour_max(&m), 0, 0, "colour max");
	assert_true(spec_measure_psnr(&m, 0) == INFINITY);
	free(pair);
}

/* b = a + 1/2 everywhere: rmse and maximum 1/2, psnr 20 log10(2 peak). */
static void
test_offset(void **state)
{
	struct pair *pair = new_pair();
	struct spec_measure m;
	float *b = &pair->b[0][0][0], largest = 0;
	size_t i;

	(void)state;
	for (i = 0; i < WIDTH * HEIGHT * BANDS; i++) {
		largest = b[i] > largest ? b[i] : largest;
		b[i] += .5f;
	}
	m = measure_pair(&everything, pair);
	near(spec_measure_rmse(&m), .5, 0, "rmse");
	near(spec_measure_max(&m), .5, 0, "max");
	at(m.difference.place, 0, 0, 0);
	near(m.difference_a, pair->a[0][0][0], 0, "a");
	near(m.difference_b, pair->b[0][0][0], 0, "b");
	near(spec_measure_psnr(&m, 4), 20 * log10(8), 1e-14, "psnr");
	near(spec_measure_psnr(&m, 0), 20 * log10(2. * largest), 1e-14,
		"psnr of the largest");
	near(m.largest_a, largest, 0, "largest");
	free(pair);
}

static void
test_places(void **state)
{
	struct pair *pair = new_pair();
	struct spec_measure m;

	(void)state;
	/* The same difference four times: the earliest by y, x, band counts. */
	pair->b[3][2][140] += 2;
	pair->b[3][1][141] -= 2;
	pair->b[3][4][140] -= 2;
	pair->b[4][0][0] += 2;
	pair->b[0][0][0] += 1;
	m = measure_pair(&everything, pair);
	near(spec_measure_max(&m), 2, 0, "max");
	at(m.difference.place, 140, 3, 2);
	near(m.difference_b - m.difference_a, 2, 0, "samples");
	/* A lost pixel has the largest angle and colour difference, and the least fit. */
	memcpy(pair->b, pair->a, sizeof pair->a);
	for (int band = 0; band < BANDS; band++)
		pair->b[5][band][77] = 0;
	m = measure_pair(&everything, pair);
	near(spec_measure_angle_max(&m), PI / 2, 1e-15, "angle");
	near(spec_measure_angle_mean(&m), PI / 2 / (WIDTH * HEIGHT), 1e-18, "angle mean");
	near(spec_measure_fit_min(&m), 0, 1e-15, "fit");
	at(m.angle_most.place, 77, 5, 0);
	at(m.fit_least.place, 77, 5, 0);
	at(m.colour_most.place, 77, 5, 0);
	free(pair);
}

static void
test_angle(void **state)
{
	static const struct {
		float a0, a1, b0, b1;
		double angle, fit;
	} known[] = {
		{1, 0, 0, 1, PI / 2, 0},
		{1, 0, 1, 1, PI / 4, .70710678118654752},
		{1, 2, -1, -2, PI, 1},
		{1, 2, 4, 8, 0, 1},
		{0, 0, 0, 0, 0, 1},
		{0, 0, 3, 1, PI / 2, 0},
		{3, 1, 0, 0, PI / 2, 0},
		{FLT_TRUE_MIN, 0, 0, FLT_TRUE_MIN, PI / 2, 0},
		{FLT_MAX, 0, FLT_MAX, FLT_MAX, PI / 4, .70710678118654752},
		/* tan(angle) = 2^-20: acos of the cosine would keep three digits. */
		{1, 0, 1, 0x1p-20f, 0x1p-20, 1},
		{1, 0, 1, 0x1p-40f, 0x1p-40, 1},
	};
	struct spec_measure m;
	size_t i;

	(void)state;
	for (i = 0; i < sizeof known / sizeof *known; i++) {
		m = measure_pixel(known[i].a0, known[i].a1, known[i].b0, known[i].b1);
		near(spec_measure_angle_max(&m), known[i].angle,
			known[i].angle < 1e-3 ? 1e-12 * known[i].angle : 1e-15, "angle");
		near(spec_measure_fit_min(&m), known[i].fit, 1e-12, "fit");
	}
	/* A power of two as factor cancels exactly. */
	m = measure_pixel(.3f, .7f, .6f, 1.4f);
	near(spec_measure_angle_max(&m), 0, 0, "scaled");
}

/* A sample that is not finite on one side spoils every metric, and no other does. */
static void
test_nonfinite(void **state)
{
	static const struct {
		float a, b;
		int equal;
	} known[] = {{NAN, NAN, 1}, {-NAN, NAN, 1}, {INFINITY, INFINITY, 1},
		{-INFINITY, -INFINITY, 1}, {NAN, 1, 0}, {1, NAN, 0},
		{INFINITY, -INFINITY, 0}, {INFINITY, 1, 0}, {1, -INFINITY, 0},
		{NAN, INFINITY, 0}, {INFINITY, NAN, 0}, {NAN, 0, 0}, {0, NAN, 0}};
	struct pair *pair = new_pair();
	struct spec_measure m;
	size_t i;

	(void)state;
	for (i = 0; i < sizeof known / sizeof *known; i++) {
		pair->a[2][3][100] = known[i].a;
		pair->b[2][3][100] = known[i].b;
		m = measure_pair(&everything, pair);
		assert_int_equal(m.nonfinite, !known[i].equal);
		if (known[i].equal) {
			near(spec_measure_rmse(&m), 0, 0, "rmse");
			near(spec_measure_max(&m), 0, 0, "max");
			near(spec_measure_angle_max(&m), 0, 0, "angle");
			near(spec_measure_fit_mean(&m), 1, 0, "fit");
			near(spec_measure_colour_max(&m), 0, 0, "colour");
			assert_true(spec_measure_psnr(&m, 0) == INFINITY);
			assert_true(m.largest_a < 5);
			continue;
		}
		at(m.nonfinite_first, 100, 2, 3);
		at(m.difference.place, 100, 2, 3);
		assert_memory_equal(&m.nonfinite_a, &known[i].a, sizeof(float));
		assert_memory_equal(&m.nonfinite_b, &known[i].b, sizeof(float));
		assert_true(spec_measure_rmse(&m) == INFINITY);
		assert_true(spec_measure_max(&m) == INFINITY);
		assert_true(spec_measure_angle_mean(&m) == INFINITY);
		assert_true(spec_measure_angle_max(&m) == INFINITY);
		assert_true(spec_measure_fit_mean(&m) == -INFINITY);
		assert_true(spec_measure_fit_min(&m) == -INFINITY);
		assert_true(spec_measure_colour_mean(&m) == INFINITY);
		assert_true(spec_measure_colour_max(&m) == INFINITY);
		assert_true(spec_measure_psnr(&m, 0) == -INFINITY);
		assert_true(spec_measure_psnr(&m, 1) == -INFINITY);
	}
	free(pair);
}

static void
test_nonfinite_counts(void **state)
{
	struct pair *pair = new_pair();
	struct spec_measure m;

	(void)state;
	pair->a[1][4][70] = NAN;
	pair->b[1][1][71] = INFINITY;
	pair->b[1][0][70] = NAN;
	pair->a[6][2][0] = INFINITY;
	pair->b[0][0][0] += 1;
	pair->a[1][0][70] = 9;
	pair->b[1][2][70] += 3;
	m = measure_pair(&everything, pair);
	assert_int_equal(m.nonfinite, 4);
	assert_int_equal(m.nonfinite_pixels, 3);
	at(m.nonfinite_first, 70, 1, 0);
	/* The finite differences are summed all the same, but not such a pixel's angle. */
	near(m.square.sum, 10, 0, "square");
	at(m.angle_most.place, 0, 0, 0);
	at(m.colour_most.place, 0, 0, 0);
	assert_true(m.largest_a < 5);
	free(pair);
}

/* Bands that are X, Y and Z themselves. */
static void
test_colour(void **state)
{
	static const double unit[9] = {1, 0, 0, 0, 1, 0, 0, 0, 1};
	const struct spec_measure_setup setup = {3, 0, unit, {.5, 1, .75}, 0};
	const float ax[3] = {.5f, .25f, -1}, ay[3] = {1, .5f, .5f},
		    az[3] = {.75f, .125f, 0};
	const float bx[3] = {0, .25f, -1}, by[3] = {0, .25f, .25f}, bz[3] = {0, .25f, 3};
	const float *a[3] = {ax, ay, az}, *b[3] = {bx, by, bz};
	double expected[3], sum = 0, lab_a[3], lab_b[3];
	struct spec_measure m;
	int i;

	(void)state;
	for (i = 0; i < 3; i++) {
		spec_lab_from_xyz((double[]){ax[i], ay[i], az[i]}, setup.white_xyz, lab_a);
		spec_lab_from_xyz((double[]){bx[i], by[i], bz[i]}, setup.white_xyz, lab_b);
		expected[i] = spec_difference_ciede2000(lab_a, lab_b);
		sum += expected[i];
	}
	spec_measure_row(&setup, a, b, 1, 4, &m);
	/* White against black: mean L* is 50, where S_L is 1, so exactly 100. */
	near(spec_measure_colour_max(&m), 100, 1e-12, "white and black");
	at(m.colour_most.place, 0, 4, 0);
	spec_measure_row(&setup, a, b, 3, 4, &m);
	near(spec_measure_colour_mean(&m), sum / 3, 1e-13, "mean");
	near(spec_measure_colour_max(&m), fmax(fmax(expected[0], expected[1]), expected[2]),
		1e-13, "max");
}

/* A white that is not positive gives no number: infinite, so that no tolerance passes. */
static void
test_colour_bad_white(void **state)
{
	static const double unit[9] = {1, 0, 0, 0, 1, 0, 0, 0, 1};
	const struct spec_measure_setup setup = {3, 0, unit, {0, NAN, 1}, 0};
	const float one = 1, two = 2, *a[3] = {&one, &one, &one},
		    *b[3] = {&two, &one, &one};
	struct spec_measure m, total;

	(void)state;
	spec_measure_clear(&total);
	spec_measure_row(&setup, a, b, 1, 0, &m);
	spec_measure_add(&total, &m);
	spec_measure_add(&total, &m);
	assert_true(spec_measure_colour_mean(&total) == INFINITY);
	assert_true(spec_measure_colour_max(&total) == INFINITY);
}

/* Everything again, the long way: long double, one pixel after the other. */
static void
test_long_way(void **state)
{
	struct pair *pair = new_pair();
	long double square = 0, angle = 0, aa, bb, ab, d;
	double worst = 0;
	struct spec_measure m;
	size_t i, band, x;
	int y;

	(void)state;
	for (i = 0; i < WIDTH * HEIGHT * BANDS; i++)
		(&pair->b[0][0][0])[i] =
			(&pair->a[0][0][0])[(i * 7919) % (WIDTH * HEIGHT * BANDS)];
	for (y = 0; y < HEIGHT; y++)
		for (x = 0; x < WIDTH; x++) {
			aa = bb = ab = 0;
			for (band = 0; band < BANDS; band++) {
				long double p = pair->a[y][band][x],
					    q = pair->b[y][band][x];

				d = p - q;
				square += d * d;
				worst = fmax(worst, fabs((double)d));
				aa += p * p;
				bb += q * q;
				ab += p * q;
			}
			angle += acosl(fminl(ab / sqrtl(aa * bb), 1));
		}
	m = measure_pair(&everything, pair);
	near(spec_measure_rmse(&m), (double)sqrtl(square / (WIDTH * HEIGHT * BANDS)), 1e-15,
		"rmse");
	near(spec_measure_max(&m), worst, 0, "max");
	near(spec_measure_angle_mean(&m), (double)(angle / (WIDTH * HEIGHT)), 1e-12,
		"angle");
	free(pair);
}

/* Rows measured in any order and added in theirs: the same bits. */
static void
test_order(void **state)
{
	struct pair *pair = new_pair();
	struct spec_measure m, rows[HEIGHT], again;
	size_t i;
	int y;

	(void)state;
	for (i = 0; i < WIDTH * HEIGHT * BANDS; i += 3)
		(&pair->b[0][0][0])[i] *= 1.1f;
	m = measure_pair(&everything, pair);
	for (y = HEIGHT - 1; y >= 0; y--)
		measure_pair_row(&everything, pair, y, &rows[y]);
	spec_measure_clear(&again);
	for (y = 0; y < HEIGHT; y++)
		spec_measure_add(&again, &rows[y]);
	assert_memory_equal(&m.square, &again.square, sizeof m.square);
	assert_memory_equal(&m.angle, &again.angle, sizeof m.angle);
	assert_memory_equal(&m.colour, &again.colour, sizeof m.colour);
	assert_memory_equal(&m.fit, &again.fit, sizeof m.fit);
	/* In halves the last bit may differ, the places not. */
	spec_measure_clear(&again);
	for (y = 4; y < HEIGHT; y++)
		spec_measure_add(&rows[3], &rows[y]);
	for (y = 0; y < 4; y++)
		spec_measure_add(&again, &rows[y]);
	near(spec_measure_rmse(&again), spec_measure_rmse(&m), 1e-16, "rmse");
	assert_memory_equal(
		&m.colour_most.place, &again.colour_most.place, sizeof m.colour_most.place);
	free(pair);
}

/* 10^16 and a thousand ones: a plain sum would keep none of the ones. */
static void
test_compensation(void **state)
{
	const struct spec_measure_setup setup = {1, 0, NULL, {0, 0, 0}, 0};
	static const float zero[1001], big[1] = {1e8f}, one[1] = {1};
	static float many[1001] = {1e8f};
	const float *a[1] = {zero}, *b[1] = {big};
	struct spec_measure total, row;
	int y;

	(void)state;
	spec_measure_row(&setup, a, b, 1, 0, &total);
	b[0] = one;
	for (y = 1; y <= 1000; y++) {
		spec_measure_row(&setup, a, b, 1, y, &row);
		spec_measure_add(&total, &row);
	}
	near(total.square.sum + total.square.lost, 1e16 + 1000, 0, "sum");
	/* The same within one row, and what it lost must reach the total. */
	for (y = 1; y <= 1000; y++)
		many[y] = 1;
	b[0] = many;
	spec_measure_row(&setup, a, b, 1001, 0, &row);
	spec_measure_clear(&total);
	spec_measure_add(&total, &row);
	near(total.square.sum + total.square.lost, 1e16 + 1000, 0, "sum of a row");
}

/* Nothing compared is nothing passed. */
static void
test_nothing(void **state)
{
	const float *none[1] = {NULL};
	const struct spec_measure_setup setup = {1, 1, NULL, {0, 0, 0}, 0};
	struct spec_measure m;

	(void)state;
	spec_measure_row(&setup, none, none, 0, 0, &m);
	assert_true(spec_measure_rmse(&m) == INFINITY);
	assert_true(spec_measure_max(&m) == INFINITY);
	assert_true(spec_measure_psnr(&m, 0) == -INFINITY);
	assert_true(spec_measure_fit_mean(&m) == -INFINITY);
	assert_true(spec_measure_angle_max(&m) == INFINITY);
}

/* Black against anything: the peak of A is 0. */
static void
test_black(void **state)
{
	struct spec_measure m = measure_pixel(0, 0, 1, 0);

	(void)state;
	assert_true(spec_measure_psnr(&m, 0) == -INFINITY);
	near(spec_measure_psnr(&m, 1), 20 * log10(sqrt(2)), 1e-14, "psnr");
}

enum { DETAIL_BANDS = 13, DETAIL_WIDTH = 150 };

struct detail {
	float a[DETAIL_BANDS][DETAIL_WIDTH], b[DETAIL_BANDS][DETAIL_WIDTH];
	float map[SPEC_DETAIL_PIXELS][DETAIL_WIDTH];
	struct spec_detail_band band[DETAIL_BANDS];
};

/* Values above 0, some of them 0 or below in one image or in both; one NaN. */
static void
make_detail(struct detail *detail)
{
	const float *a[DETAIL_BANDS], *b[DETAIL_BANDS];
	float *map[SPEC_DETAIL_PIXELS];
	struct spec_measure_setup setup = {.bands = DETAIL_BANDS};
	uint64_t random = 3;

	for (size_t k = 0; k < DETAIL_BANDS; k++) {
		for (size_t x = 0; x < DETAIL_WIDTH; x++) {
			detail->a[k][x] = (float)random_in(&random, .1, 1);
			detail->b[k][x] = (float)random_in(&random, .1, 1);
			if (x % 10 == 1)
				detail->a[k][x] = detail->b[k][x] = 0;
		}
		a[k] = detail->a[k];
		b[k] = detail->b[k];
	}
	detail->a[5][20] = detail->b[5][20] = -1;
	detail->b[7][30] = detail->a[9][32] = 0;
	detail->a[2][140] = NAN;
	for (int kind = 0; kind < SPEC_DETAIL_PIXELS; kind++)
		map[kind] = detail->map[kind];
	spec_detail_row(&setup, (1u << SPEC_DETAIL_DE76) - 1, a, b, DETAIL_WIDTH, map,
		detail->band);
}

static void
check_detail_pixel(const struct detail *detail, size_t x)
{
	long double aa = 0, bb = 0, ab = 0, sum_a = 0, sum_b = 0, square = 0, sid = 0;

	for (size_t k = 0; k < DETAIL_BANDS; k++) {
		long double p = detail->a[k][x], q = detail->b[k][x];

		aa += p * p;
		bb += q * q;
		ab += p * q;
		square += (p - q) * (p - q);
		sum_a += p > 0 ? p : 0;
		sum_b += q > 0 ? q : 0;
	}
	for (size_t k = 0; k < DETAIL_BANDS; k++) {
		long double p = detail->a[k][x], q = detail->b[k][x];

		p = p > 0 ? p / sum_a : 0;
		q = q > 0 ? q / sum_b : 0;
		if (p > 0 && q > 0)
			sid += (p - q) * logl(p / q);
		else if (p != q)
			sid = INFINITY;
	}
	near(detail->map[SPEC_DETAIL_RMSE][x], (double)sqrtl(square / DETAIL_BANDS), 1e-7,
		"rmse");
	near(detail->map[SPEC_DETAIL_GFC][x],
		aa > 0 ? (double)(fabsl(ab) / sqrtl(aa * bb)) : 1, 1e-7, "fit");
	near(detail->map[SPEC_DETAIL_SAM][x],
		aa > 0 ? (double)acosl(ab / sqrtl(aa * bb)) : 0, 2e-7, "angle");
	if (isinf((double)sid))
		assert_true(isinf(detail->map[SPEC_DETAIL_SID][x]));
	else
		near(detail->map[SPEC_DETAIL_SID][x], (double)sid, 4e-7, "divergence");
}

/* What each pixel and each band has, beside plain sums. */
static void
test_detail(void **state)
{
	static struct detail detail;

	(void)state;
	make_detail(&detail);
	for (size_t x = 0; x < DETAIL_WIDTH; x++) {
		if (x != 140)
			check_detail_pixel(&detail, x);
		else
			assert_true(isinf(detail.map[SPEC_DETAIL_SAM][x]));
	}
	for (size_t k = 0; k < DETAIL_BANDS; k++) {
		double magnitude = 0, a = 0, most = 0;

		for (size_t x = 0; x < DETAIL_WIDTH; x++) {
			double d = fabs((double)detail.a[k][x] - (double)detail.b[k][x]);

			if (isnan(d))
				continue;
			magnitude += d;
			a += (double)detail.a[k][x];
			most = fmax(most, d);
		}
		near(detail.band[k].magnitude.sum + detail.band[k].magnitude.lost,
			magnitude, 1e-12, "magnitude");
		near(detail.band[k].a.sum + detail.band[k].a.lost, a, 1e-12, "sum");
		if (k != 2)
			near(detail.band[k].most, most, 0, "most");
		else
			assert_true(isinf(detail.band[k].most));
		assert_int_equal(detail.band[k].samples, DETAIL_WIDTH);
		assert_int_equal(detail.band[k].nonfinite, k == 2);
	}
}

static int
ascending(const void *a, const void *b)
{
	const float *one = a, *two = b;

	return (*one > *two) - (*one < *two);
}

/* By nearest rank, as in a sorted copy; at the first of equal pixels, and none of NaN. */
static void
test_percentiles(void **state)
{
	enum { ACROSS = 37, DOWN = 23, PIXELS = ACROSS * DOWN, NANS = 5 };
	static const double percents[] = {0, .1, 25, 50, 50.1, 95, 99.9, 100};
	static float map[PIXELS], sorted[PIXELS];
	struct spec_images images = {.region = {3, 2, 3 + ACROSS, 2 + DOWN}};
	uint64_t random = 7;
	double value;
	size_t x, count = 0;
	int y;

	(void)state;
	for (size_t i = 0; i < PIXELS; i++) {
		map[i] = (float)(i % 3 ? random_in(&random, -1, 1)
				       : random_between(&random, 1e-30, 1e30));
		if (i % 50 == 7)
			map[i] = .125f;
	}
	for (size_t i = 0; i < NANS; i++)
		map[i * 100 + 11] = NAN;
	map[400] = -INFINITY;
	map[401] = INFINITY;
	for (size_t i = 0; i < PIXELS; i++)
		if (!isnan(map[i]))
			sorted[count++] = map[i];
	assert_int_equal(count, PIXELS - NANS);
	qsort(sorted, count, sizeof *sorted, ascending);
	images.map[SPEC_DETAIL_SAM] = map;
	for (size_t i = 0; i < COUNT(percents); i++) {
		size_t rank = (size_t)ceil(percents[i] * (double)count / 100), at;

		assert_int_equal(spec_images_percentile(&images, SPEC_DETAIL_SAM,
					 percents[i], &value, &x, &y, NULL),
			SPEC_OK);
		assert_true(value == (double)sorted[rank > 0 ? rank - 1 : 0]);
		at = (size_t)(y - 2) * ACROSS + (x - 3);
		assert_true((double)map[at] == value);
		while (at-- > 0)
			assert_false((double)map[at] == value);
	}
}

int
main(void)
{
	const struct CMUnitTest tests[] = {
		cmocka_unit_test(test_detail),
		cmocka_unit_test(test_percentiles),
		cmocka_unit_test(test_equal),
		cmocka_unit_test(test_offset),
		cmocka_unit_test(test_places),
		cmocka_unit_test(test_angle),
		cmocka_unit_test(test_nonfinite),
		cmocka_unit_test(test_nonfinite_counts),
		cmocka_unit_test(test_colour),
		cmocka_unit_test(test_colour_bad_white),
		cmocka_unit_test(test_long_way),
		cmocka_unit_test(test_order),
		cmocka_unit_test(test_compensation),
		cmocka_unit_test(test_nothing),
		cmocka_unit_test(test_black),
	};

	return cmocka_run_group_tests_name("compare", tests, NULL, NULL);
}
