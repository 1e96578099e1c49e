/* lib/spectrum/mean: means of curves over bins. */
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "spectrum/curve.h"
#include "spectrum/mean.h"

#include "check.h"

/* Uniform in [0, 1). */
static double
draw(void)
{
	static uint64_t state = 1931;

	state = state * 6364136223846793005u + 1442695040888963407u;
	return (double)(state >> 11) * 0x1p-53;
}

/* A curve of one column. */
static struct spec_curve
make(const double *nm, const double *value, size_t count)
{
	struct spec_curve curve;

	assert_int_equal(spec_curve_new(count, 1, &curve, NULL), SPEC_OK);
	memcpy(curve.wavelength_nm, nm, count * sizeof *nm);
	memcpy(curve.value, value, count * sizeof *value);
	return curve;
}

/* The mean of one bin. */
static double
mean(const struct spec_curve *curve, enum spec_extrapolate extrapolate, double a_nm,
	double b_nm)
{
	const double edge_nm[2] = {a_nm, b_nm};
	struct spec_error error;
	double value;

	assert_int_equal(spec_curve_mean(curve, 0, extrapolate, edge_nm, 1, &value, &error),
		SPEC_OK);
	return value;
}

static const double knot_nm[] = {400, 405, 417.5, 480, 481, 700};

/* A ramp, whatever its knots, has the mean that it has in the bin's middle. */
static void
mean_of_a_ramp(void **state)
{
	double ramp[COUNT(knot_nm)];
	struct spec_curve curve;

	(void)state;
	for (size_t i = 0; i < COUNT(knot_nm); i++)
		ramp[i] = 3 - .01 * knot_nm[i];
	curve = make(knot_nm, ramp, COUNT(knot_nm));
	for (int round = 0; round < 1000; round++) {
		double a = 400 + 300 * draw(), b = 400 + 300 * draw();
		double low = fmin(a, b), high = fmax(a, b);

		near(mean(&curve, SPEC_EXTRAPOLATE_REFUSE, low, high), 3 - .005 * (a + b),
			1e-14, "ramp");
	}
	near(mean(&curve, SPEC_EXTRAPOLATE_REFUSE, 400, 700), -2.5, 1e-15, "whole");
	near(mean(&curve, SPEC_EXTRAPOLATE_REFUSE, 405, 417.5), -1.1125, 1e-15, "segment");
	near(mean(&curve, SPEC_EXTRAPOLATE_REFUSE, 406, 407), -1.065, 1e-15, "inside one");
	spec_curve_free(&curve);
}

/* A box with slopes 10 nm wide from 500 to 510 nm and from 590 to 600 nm, 2 high. */
static void
mean_of_a_box(void **state)
{
	static const double nm[] = {400, 500, 510, 590, 600, 700};
	static const double height[] = {0, 0, 2, 2, 0, 0};
	static const double edge_nm[] = {
		400, 450, 500, 505, 510, 540, 590, 592.5, 650, 700};
	static const double wanted[] = {0, 0, .5, 1.5, 2, 2, 1.75, 7.5 * .75 / 57.5, 0};
	struct spec_curve curve = make(nm, height, COUNT(nm));
	double value[COUNT(wanted)];
	struct spec_error error;

	(void)state;
	assert_int_equal(spec_curve_mean(&curve, 0, SPEC_EXTRAPOLATE_REFUSE, edge_nm,
				 COUNT(wanted), value, &error),
		SPEC_OK);
	for (size_t i = 0; i < COUNT(wanted); i++)
		near(value[i], wanted[i], 1e-15, "box");
	near(mean(&curve, SPEC_EXTRAPOLATE_REFUSE, 400, 700), 180. / 300, 1e-15, "whole");
	near(mean(&curve, SPEC_EXTRAPOLATE_REFUSE, 495, 605), 180. / 110, 1e-15, "around");
	near(mean(&curve, SPEC_EXTRAPOLATE_REFUSE, 520, 520.001), 2, 0, "narrow");
	spec_curve_free(&curve);
}

/* What lies outside the data, by each rule; the curve is 1 at 400 nm and 3 at 500 nm. */
static void
mean_outside_the_data(void **state)
{
	static const double nm[] = {400, 450, 500}, height[] = {1, 2, 3};
	struct spec_curve curve = make(nm, height, 3);
	static const struct {
		double a_nm, b_nm, constant, zero;
	} known[] = {
		{300, 350, 1, 0},
		{300, 400, 1, 0},
		{350, 450, 1.25, .75},
		{300, 600, 2, 200. / 300},
		{450, 550, 2.75, 1.25},
		{500, 600, 3, 0},
		{600, 601, 3, 0},
		{-1, 0, 1, 0},
	};
	struct spec_error error;
	double value;

	(void)state;
	for (size_t i = 0; i < COUNT(known); i++) {
		const double edge_nm[2] = {known[i].a_nm, known[i].b_nm};

		near(mean(&curve, SPEC_EXTRAPOLATE_CONSTANT, edge_nm[0], edge_nm[1]),
			known[i].constant, 1e-15, "constant");
		near(mean(&curve, SPEC_EXTRAPOLATE_ZERO, edge_nm[0], edge_nm[1]),
			known[i].zero, 1e-15, "zero");
		assert_int_equal(spec_curve_mean(&curve, 0, SPEC_EXTRAPOLATE_REFUSE,
					 edge_nm, 1, &value, &error),
			SPEC_ERANGE);
		assert_non_null(strstr(error.message, "covers 400..500 nm"));
	}
	/* Rounding in an edge is no extrapolation. */
	near(mean(&curve, SPEC_EXTRAPOLATE_REFUSE, 400 - 3e-7, 500 + 4e-7), 2, 1e-8,
		"slack");
	near(mean(&curve, SPEC_EXTRAPOLATE_REFUSE, 400 - 3e-7, 400 - 2e-7), 1, 0, "end");
	spec_curve_free(&curve);
}

static void
mean_of_one_sample(void **state)
{
	static const double nm[] = {500}, height[] = {7};
	struct spec_curve curve = make(nm, height, 1);
	const double edge_nm[2] = {499, 501};
	struct spec_error error;
	double value;

	(void)state;
	near(mean(&curve, SPEC_EXTRAPOLATE_CONSTANT, 499, 501), 7, 0, "constant");
	near(mean(&curve, SPEC_EXTRAPOLATE_CONSTANT, 300, 301), 7, 0, "constant");
	near(mean(&curve, SPEC_EXTRAPOLATE_ZERO, 499, 501), 0, 0, "zero");
	assert_int_equal(spec_curve_mean(&curve, 0, SPEC_EXTRAPOLATE_REFUSE, edge_nm, 1,
				 &value, &error),
		SPEC_ERANGE);
	spec_curve_free(&curve);
}

static void
mean_takes_its_column(void **state)
{
	struct spec_curve curve;
	const double edge_nm[2] = {400, 500};
	struct spec_error error;
	double value;

	(void)state;
	assert_int_equal(spec_curve_new(2, 2, &curve, NULL), SPEC_OK);
	curve.wavelength_nm[0] = 400;
	curve.wavelength_nm[1] = 500;
	curve.value[2] = 4;
	curve.value[3] = 6;
	assert_int_equal(spec_curve_mean(&curve, 1, SPEC_EXTRAPOLATE_REFUSE, edge_nm, 1,
				 &value, &error),
		SPEC_OK);
	near(value, 5, 0, "second column");
	assert_int_equal(spec_curve_mean(&curve, 2, SPEC_EXTRAPOLATE_REFUSE, edge_nm, 1,
				 &value, &error),
		SPEC_ERANGE);
	assert_int_equal(spec_curve_mean(&curve, 0, SPEC_EXTRAPOLATE_REFUSE, edge_nm, 0,
				 &value, &error),
		SPEC_OK);
	spec_curve_free(&curve);
}

static void
mean_refuses_bad_edges(void **state)
{
	static const double nm[] = {400, 500}, height[] = {1, 1};
	struct spec_curve curve = make(nm, height, 2);
	static const struct {
		double edge_nm[3];
		const char *message;
	} cases[] = {
		{{410, NAN, 430}, "bin edge 2 is not finite"},
		{{NAN, 420, 430}, "bin edge 1 is not finite"},
		{{410, 420, INFINITY}, "bin edge 3 is not finite"},
		{{410, 420, 420}, "do not ascend: 420 nm follows 420 nm"},
		{{410, 430, 420}, "do not ascend: 420 nm follows 430 nm"},
	};
	struct spec_error error;
	double value[2];

	(void)state;
	for (size_t i = 0; i < COUNT(cases); i++) {
		assert_int_equal(spec_curve_mean(&curve, 0, SPEC_EXTRAPOLATE_CONSTANT,
					 cases[i].edge_nm, 2, value, &error),
			SPEC_ERANGE);
		assert_non_null(strstr(error.message, cases[i].message));
		assert_int_equal(spec_curve_mean(&curve, 0, SPEC_EXTRAPOLATE_CONSTANT,
					 cases[i].edge_nm, 2, value, NULL),
			SPEC_ERANGE);
	}
	spec_curve_free(&curve);
}

/* A level curve stays level to the last bit: a reflectance of 1 never exceeds 1. */
static void
mean_of_a_level_curve(void **state)
{
	double level[COUNT(knot_nm)];
	struct spec_curve curve;

	(void)state;
	for (int round = 0; round < 2000; round++) {
		double height = round % 2 ? 1 : 2 * draw() - 1;
		double a = 350 + 200 * draw();

		for (size_t i = 0; i < COUNT(knot_nm); i++)
			level[i] = height;
		curve = make(knot_nm, level, COUNT(knot_nm));
		near(mean(&curve, SPEC_EXTRAPOLATE_CONSTANT, a, a + 1e-3 + 300 * draw()),
			height, 0, "level");
		spec_curve_free(&curve);
	}
}

/* The integral from a to b: all segments, clipped, in long double; 0 outside. */
static long double
integral(const struct spec_curve *curve, double a_nm, double b_nm)
{
	long double sum = 0;

	for (size_t i = 0; i + 1 < curve->count; i++) {
		long double x0 = curve->wavelength_nm[i], x1 = curve->wavelength_nm[i + 1];
		long double y0 = curve->value[i], y1 = curve->value[i + 1];
		long double from = fmaxl(a_nm, x0), to = fminl(b_nm, x1);

		if (from < to)
			sum += (to - from) *
			       (y0 + (y1 - y0) * ((from + to) / 2 - x0) / (x1 - x0));
	}
	return sum;
}

/* count ascending numbers from low on, steps of up to widest. */
static void
draw_ascending(double *list, size_t count, double low, double widest)
{
	list[0] = low;
	for (size_t i = 1; i < count; i++)
		list[i] = list[i - 1] + 1e-6 + widest * draw() * draw();
}

/* Random curves and bins: the integral, bin by bin and in all, and the range. */
static void
mean_of_random_curves(void **state)
{
	enum { most = 40 };
	double nm[most], height[most], edge_nm[most], value[most];
	struct spec_error error;

	(void)state;
	for (int round = 0; round < 3000; round++) {
		size_t count = 2 + (size_t)(draw() * (most - 2));
		size_t bins = 1 + (size_t)(draw() * (most - 2));
		struct spec_curve curve;
		double sum = 0, low = 0, high = 0;

		draw_ascending(nm, count, 100 + 300 * draw(), 20);
		draw_ascending(edge_nm, bins + 1, 50 + 400 * draw(), 20);
		for (size_t i = 0; i < count; i++) {
			height[i] = 2 * draw() - 1;
			low = fmin(low, height[i]);
			high = fmax(high, height[i]);
		}
		if (round % 3 == 0) { /* edges at samples */
			bins = bins < count ? bins : count - 1;
			memcpy(edge_nm, nm + (count - 1 - bins) / 2,
				(bins + 1) * sizeof *nm);
		}
		curve = make(nm, height, count);
		assert_int_equal(spec_curve_mean(&curve, 0, SPEC_EXTRAPOLATE_ZERO, edge_nm,
					 bins, value, &error),
			SPEC_OK);
		for (size_t i = 0; i < bins; i++) {
			double width_nm = edge_nm[i + 1] - edge_nm[i];
			long double part = integral(&curve, edge_nm[i], edge_nm[i + 1]);

			near(value[i] * width_nm, (double)part, 1e-13, "bin");
			assert_true(value[i] >= low && value[i] <= high);
			sum += value[i] * width_nm;
		}
		near(sum, (double)integral(&curve, edge_nm[0], edge_nm[bins]), 1e-12,
			"all bins");
		spec_curve_free(&curve);
	}
}

/* Many bins over a long table: one pass, where bins times samples would take an hour. */
static void
mean_takes_one_pass(void **state)
{
	enum { samples = 400000, bins = 300000 };
	double *edge_nm = calloc(bins + 1, sizeof *edge_nm);
	double *value = calloc(bins, sizeof *value);
	struct spec_curve curve;
	struct spec_error error;
	double sum = 0;

	(void)state;
	assert_non_null(edge_nm);
	assert_non_null(value);
	assert_int_equal(spec_curve_new(samples, 1, &curve, &error), SPEC_OK);
	for (size_t i = 0; i < samples; i++) {
		curve.wavelength_nm[i] = 1 + (double)i;
		curve.value[i] = sin(1e-3 * (double)i) + (double)(i % 2);
	}
	for (size_t i = 0; i <= bins; i++)
		edge_nm[i] = 1 + (samples - 1.) * (double)i / bins;
	assert_int_equal(spec_curve_mean(&curve, 0, SPEC_EXTRAPOLATE_REFUSE, edge_nm, bins,
				 value, &error),
		SPEC_OK);
	for (size_t i = 0; i < bins; i++)
		sum += value[i] * (edge_nm[i + 1] - edge_nm[i]);
	near(sum, (double)integral(&curve, 1, samples), 1e-6, "long table");
	spec_curve_free(&curve);
	free(edge_nm);
	free(value);
}

int
main(void)
{
	const struct CMUnitTest tests[] = {
		cmocka_unit_test(mean_of_a_ramp),
		cmocka_unit_test(mean_of_a_box),
		cmocka_unit_test(mean_outside_the_data),
		cmocka_unit_test(mean_of_one_sample),
		cmocka_unit_test(mean_takes_its_column),
		cmocka_unit_test(mean_refuses_bad_edges),
		cmocka_unit_test(mean_of_a_level_curve),
		cmocka_unit_test(mean_of_random_curves),
		cmocka_unit_test(mean_takes_one_pass),
	};

	return cmocka_run_group_tests_name("mean", tests, NULL, NULL);
}
