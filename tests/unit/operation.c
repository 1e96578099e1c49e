/* Interpolation, bins, units and arithmetic of curves, against closed forms. */
#include <stdio.h>
#include <stdlib.h>

#include "spectrum/abscissa.h"
#include "spectrum/air.h"
#include "spectrum/interpolate.h"
#include "spectrum/weights.h"
#include "spectrum/operation.h"
#include "spectrum/planck.h"
#include "spectrum/product.h"
#include "spectrum/rebin.h"

#include "check.h"

#define EPSILON 0x1p-53

static void
assert_near(double found, double wanted, double tolerance)
{
	if (!(fabs(found - wanted) <= tolerance))
		fail_msg("%.17g instead of %.17g, %g off", found, wanted, found - wanted);
}

static struct spec_curve
curve_of(const char *quantity, const double (*point)[2], size_t count)
{
	struct spec_curve curve;

	assert_int_equal(spec_curve_new(count, 1, &curve, NULL), SPEC_OK);
	assert_int_equal(spec_curve_set_text(&curve.quantity, quantity, NULL), SPEC_OK);
	for (size_t i = 0; i < count; i++) {
		curve.wavelength_nm[i] = point[i][0];
		curve.value[i] = point[i][1];
	}
	return curve;
}

#define LIGHT "spectral power distribution"
#define CURVE(quantity, ...)                                                               \
	curve_of(quantity, (const double[][2]){__VA_ARGS__},                               \
		COUNT(((const double[][2]){__VA_ARGS__})))

/* Interpolation */

static double
value_at(enum spec_interpolate rule, const double *known_nm, const double *value,
	size_t count, double at_nm)
{
	struct spec_weights weights = spec_weights_at(rule, known_nm, count, at_nm);
	double sum = 0;

	assert_true(weights.count >= 1 && weights.first + weights.count <= count);
	for (size_t i = 0; i < weights.count; i++)
		sum += weights.weight[i] * value[weights.first + i];
	return sum;
}

static void
test_rules(void **state)
{
	static const double known_nm[] = {400, 420, 500}, value[] = {1, 5, 3};
	static const struct {
		double at_nm, linear, nearest, left;
	} wanted[] = {{300, 1, 1, 1}, {400, 1, 1, 1}, {405, 2, 1, 1}, {410, 3, 5, 1},
		{410.001, 3.0002, 5, 1}, {420, 5, 5, 5}, {440, 4.5, 5, 5},
		{499, 3.025, 3, 5}, {500, 3, 3, 3}, {600, 3, 3, 3}};

	(void)state;
	for (size_t i = 0; i < COUNT(wanted); i++) {
		double at_nm = wanted[i].at_nm;

		assert_near(value_at(SPEC_INTERPOLATE_LINEAR, known_nm, value, 3, at_nm),
			wanted[i].linear, 1e-12);
		assert_true(value_at(SPEC_INTERPOLATE_NEAREST, known_nm, value, 3, at_nm) ==
			    wanted[i].nearest);
		assert_true(value_at(SPEC_INTERPOLATE_LEFT, known_nm, value, 3, at_nm) ==
			    wanted[i].left);
	}
	/* One sample is all there is. */
	assert_true(value_at(SPEC_INTERPOLATE_LINEAR, known_nm, value, 1, 450) == 1);
}

/*
 * The example of colour-science's SpragueInterpolator, an independent program (colour 0.4,
 * its documentation): eight digits are printed.
 */
static void
test_sprague_published(void **state)
{
	static const double x[] = {1, 2, 3, 4, 5, 6, 7};
	static const double y[] = {
		5.9200, 9.3700, 10.8135, 4.5100, 69.5900, 27.8007, 86.0500};

	(void)state;
	assert_near(value_at(SPEC_INTERPOLATE_SPRAGUE, x, y, 7, 1.5), 7.2185025, 1e-7);
	assert_near(value_at(SPEC_INTERPOLATE_SPRAGUE, x, y, 7, 1.25), 6.7295161, 1e-7);
	assert_near(value_at(SPEC_INTERPOLATE_SPRAGUE, x, y, 7, 1.75), 7.8140625, 1e-7);
}

/* A quartic inside, a line everywhere; the same from either end; continuous slopes. */
static void
test_sprague(void **state)
{
	enum { SAMPLES = 9 };
	double known_nm[SAMPLES], line[SAMPLES], quartic[SAMPLES], odd[SAMPLES],
		back[SAMPLES];

	(void)state;
	for (int i = 0; i < SAMPLES; i++) {
		double x = i - 4;

		known_nm[i] = 400 + 5 * i;
		line[i] = 3 - 2 * x;
		quartic[i] = 1 + x * (2 + x * (-3 + x * (.5 + x * .25)));
		odd[i] = back[SAMPLES - 1 - i] = (double)(i * i * 7 % 11);
	}
	for (double at = 0; at <= SAMPLES - 1; at += 1 / 16.) {
		double nm = 400 + 5 * at, x = at - 4;

		assert_near(value_at(SPEC_INTERPOLATE_SPRAGUE, known_nm, line, SAMPLES, nm),
			3 - 2 * x, 1e-12);
		assert_near(value_at(SPEC_INTERPOLATE_SPRAGUE, known_nm, odd, SAMPLES, nm),
			value_at(SPEC_INTERPOLATE_SPRAGUE, known_nm, back, SAMPLES,
				840 - nm),
			1e-12);
		if (at >= 2 && at <= SAMPLES - 3)
			assert_near(value_at(SPEC_INTERPOLATE_SPRAGUE, known_nm, quartic,
					    SAMPLES, nm),
				1 + x * (2 + x * (-3 + x * (.5 + x * .25))), 1e-11);
	}
	for (int i = 1; i < SAMPLES - 1; i++) {
		double step = 1e-3, nm = known_nm[i];
		double middle =
			value_at(SPEC_INTERPOLATE_SPRAGUE, known_nm, odd, SAMPLES, nm);
		double before = value_at(
			SPEC_INTERPOLATE_SPRAGUE, known_nm, odd, SAMPLES, nm - step);
		double after = value_at(
			SPEC_INTERPOLATE_SPRAGUE, known_nm, odd, SAMPLES, nm + step);

		/* Second differences of what has a bounded curvature, here below 100 nm^-2. */
		assert_near(after - middle, middle - before, 100 * step * step);
	}
}

static void
test_sprague_refused(void **state)
{
	double known_nm[] = {400, 410, 420, 430, 440, 450, 461};
	struct spec_error error;

	(void)state;
	check(spec_weights_check(SPEC_INTERPOLATE_SPRAGUE, known_nm, 6, &error), &error);
	assert_int_equal(spec_weights_check(SPEC_INTERPOLATE_SPRAGUE, known_nm, 5, &error),
		SPEC_ERANGE);
	assert_int_equal(spec_weights_check(SPEC_INTERPOLATE_SPRAGUE, known_nm, 7, &error),
		SPEC_ERANGE);
	assert_non_null(strstr(error.message, "equidistant"));
	check(spec_weights_check(SPEC_INTERPOLATE_LINEAR, known_nm, 7, &error), &error);
}

static void
test_resample_by(void **state)
{
	struct spec_curve curve = CURVE("", {400, 1}, {500, 3}), result;
	struct spec_grid grid = {
		.wavelength_nm = (double[]){350, 449, 451, 500}, .count = 4};
	struct spec_error error;

	(void)state;
	check(spec_curve_resample_by(SPEC_INTERPOLATE_NEAREST, &curve, &grid,
		      SPEC_EXTRAPOLATE_ZERO, &result, &error),
		&error);
	assert_true(result.value[0] == 0);
	assert_true(result.value[1] == 1);
	assert_true(result.value[2] == 3);
	assert_true(result.value[3] == 3);
	spec_curve_free(&result);
	assert_int_equal(spec_curve_resample_by(SPEC_INTERPOLATE_SPRAGUE, &curve, &grid,
				 SPEC_EXTRAPOLATE_ZERO, &result, &error),
		SPEC_ERANGE);
	spec_curve_free(&curve);
}

/* Bins */

static void
test_halfway(void **state)
{
	static const double nm[] = {400, 410, 430};
	double edges_nm[4];

	(void)state;
	spec_bins_halfway(nm, 3, edges_nm);
	assert_true(edges_nm[0] == 395);
	assert_true(edges_nm[1] == 405);
	assert_true(edges_nm[2] == 420);
	assert_true(edges_nm[3] == 440);
	spec_bins_halfway(nm, 1, edges_nm);
	assert_true(edges_nm[0] == 399.5);
	assert_true(edges_nm[1] == 400.5);
}

static double
integral(const struct spec_curve *curve)
{
	double *edges_nm = malloc((curve->count + 1) * sizeof *edges_nm), sum = 0;

	assert_non_null(edges_nm);
	spec_bins_halfway(curve->wavelength_nm, curve->count, edges_nm);
	for (size_t i = 0; i < curve->count; i++)
		sum += curve->value[i] * (edges_nm[i + 1] - edges_nm[i]);
	free(edges_nm);
	return sum;
}

/* Bins of 10 and 30 nm: 395, 405, 415, 445. */
static void
test_rebin(void **state)
{
	struct spec_curve curve = CURVE(LIGHT, {400, 1}, {410, 7}, {420, 4}, {440, 2}),
			  result;
	double bins_nm[] = {395, 400, 412, 420, 450};
	struct spec_grid grid = {
		.wavelength_nm = (double[]){397, 406, 416, 430}, .count = 4};
	struct spec_error error;

	(void)state;
	/* The curve's own bins end at 395, 405, 415, 430 and 450 nm. */
	check(spec_curve_rebin(
		      &curve, &grid, bins_nm, SPEC_EXTRAPOLATE_REFUSE, &result, &error),
		&error);
	assert_near(result.value[0], 1, 1e-15);
	assert_near(result.value[1], (5 * 1 + 7 * 7) / 12., 1e-14);
	assert_near(result.value[2], (3 * 7 + 5 * 4) / 8., 1e-14);
	assert_near(result.value[3], (10 * 4 + 20 * 2) / 30., 1e-14);
	assert_string_equal(result.quantity, LIGHT);
	spec_curve_free(&result);
	spec_curve_free(&curve);
}

/* Down and up again: what leaves a bin arrives in others. */
static void
test_rebin_keeps(void **state)
{
	static const char *const grids[] = {
		"400:700:10", "397:703:18", "400:700:2.5", "401:699:1", "395:705:310"};
	struct spec_curve curve, result;
	struct spec_error error;

	(void)state;
	assert_int_equal(spec_curve_new(61, 1, &curve, NULL), SPEC_OK);
	for (size_t i = 0; i < curve.count; i++) {
		curve.wavelength_nm[i] = 400 + 5 * (double)i;
		curve.value[i] = 2 + sin((double)i) + (double)(i % 7);
	}
	for (size_t i = 0; i < COUNT(grids); i++) {
		struct spec_grid grid;
		double low_nm, high_nm, wanted = 0;

		check(spec_grid_parse(grids[i], &grid, &error), &error);
		check(spec_curve_rebin(
			      &curve, &grid, NULL, SPEC_EXTRAPOLATE_ZERO, &result, &error),
			&error);
		low_nm = grid.wavelength_nm[0] -
			 (grid.wavelength_nm[1] - grid.wavelength_nm[0]) / 2;
		high_nm =
			grid.wavelength_nm[0] + grid.wavelength_nm[grid.count - 1] - low_nm;
		for (size_t j = 0; j < curve.count; j++) {
			double nm = curve.wavelength_nm[j];

			wanted += curve.value[j] *
				  fmax(0, fmin(nm + 2.5, high_nm) - fmax(nm - 2.5, low_nm));
		}
		/* Some hundred sums of positive numbers. */
		assert_near(integral(&result), wanted, 400 * EPSILON * wanted);
		spec_curve_free(&result);
		spec_grid_free(&grid);
	}
	spec_curve_free(&curve);
}

static void
test_rebin_outside(void **state)
{
	struct spec_curve curve = CURVE(LIGHT, {400, 2}, {410, 6}), result;
	struct spec_grid grid = {.wavelength_nm = (double[]){390, 410}, .count = 2},
			 far = {.wavelength_nm = (double[]){400, 440}, .count = 2};
	struct spec_error error;
	char text[100];

	(void)state;
	/* 380..400..420 nm, of which 395..415 are known. */
	check(spec_curve_rebin(
		      &curve, &grid, NULL, SPEC_EXTRAPOLATE_REFUSE, &result, &error),
		&error);
	assert_near(result.value[0], 5 * 2 / 20., 1e-15);
	assert_near(result.value[1], (5 * 2 + 10 * 6) / 20., 1e-15);
	spec_curve_free(&result);
	check(spec_curve_rebin(
		      &curve, &grid, NULL, SPEC_EXTRAPOLATE_CONSTANT, &result, &error),
		&error);
	assert_near(result.value[0], 2, 1e-15);
	assert_near(result.value[1], (5 * 2 + 15 * 6) / 20., 1e-15);
	spec_curve_free(&result);
	spec_curve_describe_outside(&curve, &grid, NULL, 1, text, sizeof text);
	assert_string_equal(text, "380..395 nm and 415..420 nm");
	spec_curve_describe_outside(&curve, &grid, NULL, 0, text, sizeof text);
	assert_string_equal(text, "390..400 nm");
	/* 380..420..460 nm: nothing is known of the second. */
	assert_int_equal(spec_curve_rebin(&curve, &far, NULL, SPEC_EXTRAPOLATE_REFUSE,
				 &result, &error),
		SPEC_ERANGE);
	assert_non_null(strstr(error.message, "420..460"));
	check(spec_curve_rebin(
		      &curve, &far, NULL, SPEC_EXTRAPOLATE_CONSTANT, &result, &error),
		&error);
	assert_near(result.value[1], 6, 1e-15);
	spec_curve_free(&result);
	spec_curve_free(&curve);
}

/* Air */

/*
 * Lines of sodium in vacuum and in air (NIST Atomic Spectra Database 5.11, D2 and D1). NIST's
 * air is that of Peck and Reeder, 1972, with 330 ppm of carbon dioxide in place of 450, which
 * makes n less by 1.2e-4 * 0.534 (n - 1) = 1.8e-8 (Ciddor 1996, eq 2): 1.1e-5 nm.
 */
static void
test_air(void **state)
{
	static const double vacuum_nm[] = {589.1583264, 589.7558147};
	static const double air_nm[] = {588.9950954, 589.5924237};
	struct spec_error error;

	(void)state;
	for (size_t i = 0; i < COUNT(air_nm); i++) {
		double nm = vacuum_nm[i];

		check(spec_air_convert(SPEC_MEDIUM_AIR, &nm, 1, &error), &error);
		assert_near(nm, air_nm[i], 1.1e-5);
	}
	/* refractiveindex.info, air, Ciddor 1996; eight decimals. */
	assert_near(spec_air_index(300), 1.00029157, 5.1e-9);
	assert_near(spec_air_index(1100), 1.0002739, 5.1e-9);
	for (double wanted_nm = 230; wanted_nm <= 1690; wanted_nm += 20) {
		double nm = wanted_nm;

		check(spec_air_convert(SPEC_MEDIUM_AIR, &nm, 1, &error), &error);
		assert_true(nm < wanted_nm);
		if (nm < 230)
			continue;
		check(spec_air_convert(SPEC_MEDIUM_VACUUM, &nm, 1, &error), &error);
		assert_near(nm, wanted_nm, 1e-12 * wanted_nm);
	}
	for (double nm = 200; nm < 2000; nm += 1500) {
		double outside_nm = nm;

		assert_int_equal(spec_air_convert(SPEC_MEDIUM_AIR, &outside_nm, 1, &error),
			SPEC_ERANGE);
	}
}

/* Abscissae */

/*
 * Planck's law in frequency, 2 h v^3 / c^2 / (e^(hv/kT) - 1), and in
 * wavenumber, per THz, 1/cm.
 */
static void
test_planck_abscissa(void **state)
{
	static const char *const quantity[] = {"radiance per THz", "radiance per cm-1"};
	static const enum spec_abscissa abscissa[] = {
		SPEC_ABSCISSA_THZ, SPEC_ABSCISSA_PER_CM};
	/* c / 1e12, and c 100 [Hz per unit] */
	static const double hertz[] = {1e12, SPEC_LIGHT_SPEED_M_PER_S * 100};
	static const double from[] = {350, 12000}, step[] = {10, 500};
	const double h = SPEC_PLANCK_J_S, c = SPEC_LIGHT_SPEED_M_PER_S;
	struct spec_error error;
	int left;

	(void)state;
	for (size_t i = 0; i < 2; i++) {
		struct spec_curve curve;

		assert_int_equal(spec_curve_new(40, 1, &curve, NULL), SPEC_OK);
		assert_int_equal(
			spec_curve_set_text(&curve.quantity, quantity[i], NULL), SPEC_OK);
		for (size_t j = 0; j < curve.count; j++) {
			double v;

			curve.wavelength_nm[j] = from[i] + step[i] * (double)j;
			v = curve.wavelength_nm[j] * hertz[i];
			curve.value[j] = 2 * h * v * v * v / (c * c) /
					 expm1(h * v / (SPEC_BOLTZMANN_J_PER_K * 3000)) *
					 hertz[i];
		}
		check(spec_abscissa_convert(abscissa[i], &curve, &left, &error), &error);
		assert_int_equal(left, 0);
		assert_string_equal(curve.quantity, "radiance per nm");
		for (size_t j = 0; j < curve.count; j++) {
			double wanted;

			assert_true(j == 0 ||
				    curve.wavelength_nm[j] > curve.wavelength_nm[j - 1]);
			spec_planck_radiance(3000, &curve.wavelength_nm[j], 1, &wanted);
			/* The exponent is 16 at most and rounded a few times on both ways. */
			assert_near(curve.value[j], wanted, 100 * EPSILON * wanted);
		}
		assert_near(curve.wavelength_nm[0], i == 0 ? 299792.458 / 740 : 1e7 / 31500,
			1e-10);
		spec_curve_free(&curve);
	}
}

static void
test_abscissa_quantities(void **state)
{
	static const struct {
		const char *quantity, *after;
		double value;
		int left;
	} wanted[] = {{LIGHT, LIGHT, 3e-3, 0},
		{"radiance per um", "radiance per nm", 3e-3, 0},
		{"radiance per nm", "radiance per nm", 3, 0},
		{"reflectance", "reflectance", 3, 0}, {"", "", 3, 1}};
	struct spec_error error;
	int left;

	(void)state;
	for (size_t i = 0; i < COUNT(wanted); i++) {
		struct spec_curve curve = CURVE(wanted[i].quantity, {.5, 3}, {.75, 3});

		check(spec_abscissa_convert(SPEC_ABSCISSA_UM, &curve, &left, &error),
			&error);
		assert_true(curve.wavelength_nm[0] == 500);
		assert_true(curve.wavelength_nm[1] == 750);
		assert_near(curve.value[1], wanted[i].value, 1e-17);
		assert_string_equal(curve.quantity, wanted[i].after);
		assert_int_equal(left, wanted[i].left);
		spec_curve_free(&curve);
	}
}

/* Arithmetic */

static void
test_divide_add(void **state)
{
	struct spec_curve a = CURVE(LIGHT, {400, 2}, {600, 6}),
			  b = CURVE("reflectance", {300, 4}, {500, 2}, {700, 1}),
			  c = CURVE("", {500, 1}, {600, 0}), result;
	struct spec_error error;

	(void)state;
	check(spec_curve_divide(&a, &b, &result, &error), &error);
	assert_int_equal(result.count, 3);
	assert_true(result.value[0] == 2 / 3.);
	assert_true(result.value[1] == 4 / 2.);
	assert_true(result.value[2] == 6 / 1.5);
	assert_string_equal(result.quantity, LIGHT);
	spec_curve_free(&result);
	check(spec_curve_add(&a, &c, &result, &error), &error);
	assert_int_equal(result.count, 2);
	assert_true(result.value[0] == 5);
	assert_true(result.value[1] == 6);
	assert_string_equal(result.quantity, LIGHT);
	spec_curve_free(&result);
	assert_int_equal(spec_curve_divide(&a, &c, &result, &error), SPEC_ERANGE);
	assert_non_null(strstr(error.message, "0 at 600 nm"));
	assert_int_equal(spec_curve_add(&a, &b, &result, &error), SPEC_EUSAGE);
	assert_int_equal(spec_curve_set_text(&a.unit, "W", NULL), SPEC_OK);
	assert_int_equal(spec_curve_set_text(&c.unit, "mW", NULL), SPEC_OK);
	assert_int_equal(spec_curve_add(&a, &c, &result, &error), SPEC_EUSAGE);
	assert_non_null(strstr(error.message, "mW"));
	spec_curve_free(&a);
	spec_curve_free(&b);
	spec_curve_free(&c);
}

/* Of these quantities a quotient is what is said, or nothing. */
static void
test_quotient_quantities(void **state)
{
	static const char *const wanted[][3] = {{LIGHT, "transmittance", LIGHT},
		{"reflectance", "transmittance", "reflectance"}, {LIGHT, LIGHT, ""},
		{"reflectance", LIGHT, ""}, {"index", "reflectance", ""}};
	struct spec_error error;

	(void)state;
	for (size_t i = 0; i < COUNT(wanted); i++) {
		struct spec_curve a = CURVE(wanted[i][0], {400, 2}),
				  b = CURVE(wanted[i][1], {400, 4}), result;

		check(spec_curve_divide(&a, &b, &result, &error), &error);
		assert_string_equal(result.quantity, wanted[i][2]);
		spec_curve_free(&result);
		spec_curve_free(&a);
		spec_curve_free(&b);
	}
}

static void
apply(struct spec_curve *curve, const char *option, const char *value)
{
	struct spec_operation operation;
	struct spec_error error;
	int known;

	check(spec_operation_parse(option, value, &operation, &known, &error), &error);
	assert_int_equal(known, 1);
	check(spec_operation_apply(&operation, curve, &error), &error);
	spec_operation_free(&operation);
}

static void
test_operations(void **state)
{
	struct spec_curve curve = CURVE("transmittance", {400, .25}, {500, .5}, {600, -2});
	struct spec_operation root = {.kind = SPEC_OPERATION_RAISE, .number = .5};
	struct spec_error error;

	(void)state;
	assert_int_equal(spec_operation_apply(&root, &curve, &error), SPEC_ERANGE);
	assert_non_null(strstr(error.message, "600 nm"));
	assert_true(curve.value[0] == .25); /* as it was */
	apply(&curve, "raise", "2");
	assert_true(curve.value[0] == .0625);
	assert_true(curve.value[1] == .25);
	assert_true(curve.value[2] == 4);
	assert_string_equal(curve.quantity, "transmittance");
	apply(&curve, "clamp", "0.125..3");
	assert_true(curve.value[0] == .125);
	assert_true(curve.value[1] == .25);
	assert_true(curve.value[2] == 3);
	apply(&curve, "scale", "-2");
	assert_true(curve.value[2] == -6);
	spec_curve_free(&curve);
}

static void
test_operations_refused(void **state)
{
	static const char *const wrong[][2] = {{"clamp", "1..0"}, {"clamp", "1"},
		{"clamp", "..1"}, {"clamp", "0..x"}, {"clamp", "nan..1"}, {"raise", "x"},
		{"raise", "1e4"}, {"scale", ""}};
	struct spec_operation operation;
	struct spec_error error;
	int known;

	(void)state;
	for (size_t i = 0; i < COUNT(wrong); i++)
		assert_int_not_equal(spec_operation_parse(wrong[i][0], wrong[i][1],
					     &operation, &known, &error),
			SPEC_OK);
	check(spec_operation_parse("crop", "1", &operation, &known, &error), &error);
	assert_int_equal(known, 0);
}

int
main(void)
{
	const struct CMUnitTest tests[] = {
		cmocka_unit_test(test_rules),
		cmocka_unit_test(test_sprague_published),
		cmocka_unit_test(test_sprague),
		cmocka_unit_test(test_sprague_refused),
		cmocka_unit_test(test_resample_by),
		cmocka_unit_test(test_halfway),
		cmocka_unit_test(test_rebin),
		cmocka_unit_test(test_rebin_keeps),
		cmocka_unit_test(test_rebin_outside),
		cmocka_unit_test(test_air),
		cmocka_unit_test(test_planck_abscissa),
		cmocka_unit_test(test_abscissa_quantities),
		cmocka_unit_test(test_divide_add),
		cmocka_unit_test(test_quotient_quantities),
		cmocka_unit_test(test_operations),
		cmocka_unit_test(test_operations_refused),
	};

	return cmocka_run_group_tests(tests, NULL, NULL);
}
