/* lib/spectrum/operate, common, values: arithmetic with spectra of all kinds. */
#include <stdlib.h>

#include "spectrum/operate.h"

#include "check.h"
#include "spectra.h"

#define KINDS 6

static struct spec_spectrum
combine(const struct spec_spectrum *a, enum spec_operator op, const struct spec_spectrum *b,
	enum spec_extrapolate extrapolate)
{
	struct spec_spectrum result;
	struct spec_error error;

	if (spec_spectrum_combine(a, op, b, extrapolate, &result, &error) != SPEC_OK)
		fail_msg("%s", error.message);
	return result;
}

static struct spec_spectrum
sampled(double low_nm, double high_nm, size_t count, double first, double step)
{
	double value[1000];
	struct spec_spectrum spectrum;

	for (size_t i = 0; i < count; i++)
		value[i] = first + step * (double)i;
	assert_int_equal(spec_spectrum_sampled(low_nm, high_nm, value, count,
				 SPEC_INTERPOLATE_LINEAR, &spectrum, NULL),
		SPEC_OK);
	return spectrum;
}

static struct spec_spectrum
constant(double level)
{
	struct spec_spectrum spectrum;

	assert_int_equal(spec_spectrum_constant(level, &spectrum, NULL), SPEC_OK);
	return spectrum;
}

/* One of each kind, all positive, by the order of their numbers. */
static void
make_kinds(struct spec_spectrum spectra[KINDS])
{
	static const double nm[] = {380, 395, 430.5, 500, 612, 780},
			    value[] = {.1, .9, .3, 2, .05, 1.5},
			    series[] = {4, .3, -.4, .1, .05}, rgb[] = {.7, .2, .1};
	static const struct spec_sigmoid sigmoid = {1.5, 3e-5, -.02, 2};

	spec_spectrum_constant(.7, &spectra[0], NULL);
	spec_spectrum_blackbody(2856, 3, &spectra[1], NULL);
	spec_spectrum_rgb(rgb, &sigmoid, &spectra[2], NULL);
	spec_spectrum_fourier(380, 780, series, COUNT(series), &spectra[3], NULL);
	spec_spectrum_tabulated(nm, value, COUNT(nm), 0, &spectra[4], NULL);
	spectra[5] = sampled(380, 780, 41, .5, .05);
}

static double
apply(enum spec_operator op, double a, double b)
{
	const double results[] = {a + b, a - b, a * b, a / b, pow(a, b)};

	return results[op];
}

/* ---- kinds ---- */

static void
kinds_do_not_depend_on_order(void **state)
{
	(void)state;
	for (int a = 0; a < KINDS; a++)
		for (int b = 0; b < KINDS; b++)
			for (int op = SPEC_ADD; op <= SPEC_MULTIPLY; op++)
				assert_int_equal(spec_operator_kind((enum spec_operator)op,
							 (enum spec_spectrum_kind)a,
							 (enum spec_spectrum_kind)b),
					spec_operator_kind((enum spec_operator)op,
						(enum spec_spectrum_kind)b,
						(enum spec_spectrum_kind)a));
	assert_int_equal(spec_operator_kind(
				 SPEC_ADD, SPEC_SPECTRUM_SAMPLED, SPEC_SPECTRUM_TABULATED),
		SPEC_SPECTRUM_TABULATED);
	assert_int_equal(spec_operator_kind(SPEC_MULTIPLY, SPEC_SPECTRUM_FOURIER,
				 SPEC_SPECTRUM_FOURIER),
		SPEC_SPECTRUM_FOURIER);
	assert_int_equal(spec_operator_kind(
				 SPEC_DIVIDE, SPEC_SPECTRUM_FOURIER, SPEC_SPECTRUM_FOURIER),
		SPEC_SPECTRUM_SAMPLED);
	assert_int_equal(spec_operator_kind(
				 SPEC_MULTIPLY, SPEC_SPECTRUM_CONSTANT, SPEC_SPECTRUM_RGB),
		SPEC_SPECTRUM_RGB);
}

/* Each pair and operator: the kind of the table, the values of both, the order's converse. */
static void
every_pair_has_its_values(void **state)
{
	struct spec_spectrum spectra[KINDS];

	(void)state;
	make_kinds(spectra);
	for (int a = 0; a < KINDS; a++)
		for (int b = 0; b < KINDS; b++)
			for (int op = 0; op <= SPEC_RAISE; op++) {
				struct spec_spectrum r =
					combine(&spectra[a], (enum spec_operator)op,
						&spectra[b], SPEC_EXTRAPOLATE_REFUSE);
				/* Where results have samples, or any wavelengths. */
				const double nm = r.wavelength_nm
							  ? r.wavelength_nm[r.count / 2]
							  : 523.7;

				assert_int_equal(r.smooth,
					spec_operator_kind((enum spec_operator)op,
						spectra[a].smooth, spectra[b].smooth));
				near(value_at(&r, nm),
					apply((enum spec_operator)op,
						value_at(&spectra[a], nm),
						value_at(&spectra[b], nm)),
					1e-14 * fabs(value_at(&r, nm)) + 1e-15, "value");
				spec_spectrum_free(&r);
			}
	for (int i = 0; i < KINDS; i++)
		spec_spectrum_free(&spectra[i]);
}

static void
numbers_combine(void **state)
{
	struct spec_spectrum spectra[KINDS], r;

	(void)state;
	make_kinds(spectra);
	for (int a = 0; a < KINDS; a++) {
		spec_curve_set_text(&spectra[a].title, "lamp", NULL);
		spec_curve_set_text(&spectra[a].unit, "W/nm", NULL);
		for (int op = 0; op <= SPEC_RAISE; op++) {
			double nm;

			assert_int_equal(spec_spectrum_combine_number(&spectra[a],
						 (enum spec_operator)op, 2.5, &r, NULL),
				SPEC_OK);
			nm = r.wavelength_nm ? r.wavelength_nm[r.count / 2] : 523.7;
			near(value_at(&r, nm),
				apply((enum spec_operator)op, value_at(&spectra[a], nm),
					2.5),
				1e-13, "value");
			assert_string_equal(r.title, "lamp");
			assert_string_equal(r.unit, op <= SPEC_SUBTRACT ? "W/nm" : "");
			spec_spectrum_free(&r);
		}
		assert_int_equal(spec_spectrum_negate(&spectra[a], &r, NULL), SPEC_OK);
		assert_int_equal(r.smooth, spectra[a].smooth);
		assert_true(value_at(&r, 500) == -value_at(&spectra[a], 500));
		assert_string_equal(r.unit, "W/nm");
		spec_spectrum_free(&r);
		spec_spectrum_free(&spectra[a]);
	}
}

/* ---- wavelengths ---- */

static void
finer_samples_rule(void **state)
{
	struct spec_spectrum coarse = sampled(400, 700, 16, 1, .1),
			     fine = sampled(503, 803, 61, 2, .1), r, swapped;

	(void)state;
	r = combine(&coarse, SPEC_MULTIPLY, &fine, SPEC_EXTRAPOLATE_REFUSE);
	assert_true(r.low_nm == 503 && r.high_nm == 698 && r.count == 40);
	assert_int_equal(r.smooth, SPEC_SPECTRUM_SAMPLED);
	near(value_at(&r, 538), value_at(&coarse, 538) * value_at(&fine, 538), 1e-14,
		"at a sample of the finer");
	swapped = combine(&fine, SPEC_MULTIPLY, &coarse, SPEC_EXTRAPOLATE_REFUSE);
	assert_true(swapped.count == r.count && swapped.low_nm == r.low_nm);
	assert_memory_equal(swapped.value, r.value, r.count * sizeof *r.value);
	spec_spectrum_free(&swapped);
	spec_spectrum_free(&r);
	/* T: 0 outside. */
	r = combine(&coarse, SPEC_ADD, &fine, SPEC_EXTRAPOLATE_ZERO);
	assert_true(r.low_nm == 403 && r.high_nm == 803 && r.count == 81);
	near(value_at(&r, 448), value_at(&coarse, 448), 1e-14, "the coarse one alone");
	near(value_at(&r, 783), value_at(&fine, 783), 1e-14, "the fine one alone");
	near(value_at(&r, 603), value_at(&coarse, 603) + value_at(&fine, 603), 1e-14,
		"sum");
	spec_spectrum_free(&r);
	spec_spectrum_free(&coarse);
	spec_spectrum_free(&fine);
}

static void
equal_steps_have_one_origin(void **state)
{
	struct spec_spectrum a = sampled(400, 700, 31, 1, .1),
			     b = sampled(405, 705, 31, 1, .2), r, swapped;

	(void)state;
	r = combine(&a, SPEC_ADD, &b, SPEC_EXTRAPOLATE_ZERO);
	swapped = combine(&b, SPEC_ADD, &a, SPEC_EXTRAPOLATE_ZERO);
	assert_true(r.low_nm == 400 && r.high_nm == 700 && r.count == 31);
	assert_memory_equal(swapped.value, r.value, r.count * sizeof *r.value);
	spec_spectrum_free(&r);
	spec_spectrum_free(&swapped);
	/* The same places: nothing is interpolated. */
	r = combine(&a, SPEC_SUBTRACT, &a, SPEC_EXTRAPOLATE_REFUSE);
	assert_true(spec_spectrum_is_black(&r) && r.count == 31);
	spec_spectrum_free(&r);
	spec_spectrum_free(&a);
	spec_spectrum_free(&b);
}

static void
tables_have_the_wavelengths_of_both(void **state)
{
	static const double one_nm[] = {400, 450, 600}, two_nm[] = {420, 450, 500, 700},
			    value[] = {1, 2, 3, 4};
	static const double shared[] = {420, 450, 500, 600},
			    all[] = {400, 420, 450, 500, 600, 700};
	struct spec_spectrum one, two, r;

	(void)state;
	spec_spectrum_tabulated(one_nm, value, 3, SPEC_INTERPOLATE_LEFT, &one, NULL);
	spec_spectrum_tabulated(two_nm, value, 4, SPEC_INTERPOLATE_LEFT, &two, NULL);
	r = combine(&one, SPEC_MULTIPLY, &two, SPEC_EXTRAPOLATE_REFUSE);
	assert_int_equal(r.count, 4);
	assert_memory_equal(r.wavelength_nm, shared, sizeof shared);
	/* Products of stairs are stairs. */
	assert_int_equal(r.interpolate, SPEC_INTERPOLATE_LEFT);
	assert_true(value_at(&r, 440) == 1 && value_at(&r, 470) == 4);
	spec_spectrum_free(&r);
	r = combine(&one, SPEC_ADD, &two, SPEC_EXTRAPOLATE_ZERO);
	assert_int_equal(r.count, 6);
	assert_memory_equal(r.wavelength_nm, all, sizeof all);
	spec_spectrum_free(&r);
	two.interpolate = SPEC_INTERPOLATE_LINEAR;
	r = combine(&one, SPEC_ADD, &two, SPEC_EXTRAPOLATE_ZERO);
	assert_int_equal(r.interpolate, SPEC_INTERPOLATE_LINEAR);
	spec_spectrum_free(&r);
	spec_spectrum_free(&one);
	spec_spectrum_free(&two);
}

/* What has no samples is looked at closely, also between those of a coarse table. */
static void
tables_and_functions_lose_nothing(void **state)
{
	static const double nm[] = {300, 650, 800}, value[] = {1, .5, 0},
			    wave[] = {2, .5, 0};
	struct spec_spectrum table, series, samples = sampled(400, 700, 11, 1, .1),
					    level = constant(2), r;

	(void)state;
	spec_spectrum_tabulated(nm, value, 3, 0, &table, NULL);
	spec_spectrum_fourier(420, 720, wave, 3, &series, NULL);
	r = combine(&table, SPEC_MULTIPLY, &series, SPEC_EXTRAPOLATE_REFUSE);
	assert_int_equal(r.smooth, SPEC_SPECTRUM_TABULATED);
	assert_true(r.low_nm == 420 && r.high_nm == 720 && r.count == 301);
	near(value_at(&r, 500), value_at(&table, 500) * value_at(&series, 500), 1e-14,
		"tabulated");
	spec_spectrum_free(&r);
	r = combine(&series, SPEC_MULTIPLY, &samples, SPEC_EXTRAPOLATE_REFUSE);
	assert_int_equal(r.smooth, SPEC_SPECTRUM_SAMPLED);
	assert_true(r.low_nm == 420 && r.high_nm == 700 && r.count == 281);
	near(value_at(&r, 517), value_at(&samples, 517) * value_at(&series, 517), 1e-14,
		"sampled");
	spec_spectrum_free(&r);
	/* A constant asks for nothing. */
	r = combine(&samples, SPEC_ADD, &level, SPEC_EXTRAPOLATE_REFUSE);
	assert_int_equal(r.count, 11);
	spec_spectrum_free(&r);
	r = combine(&level, SPEC_RAISE, &table, SPEC_EXTRAPOLATE_REFUSE);
	assert_int_equal(r.count, 3);
	spec_spectrum_free(&r);
	spec_spectrum_free(&table);
	spec_spectrum_free(&series);
	spec_spectrum_free(&samples);
	spec_spectrum_free(&level);
}

/* ---- Fourier ---- */

static void
products_of_series_agree_with_samples(void **state)
{
	static const double a_value[] = {2, .3, -.4, .1, .05, .2, -.1},
			    b_value[] = {3, .8, .6, -.1, .25};
	struct spec_spectrum a, b, product, other, r;

	(void)state;
	spec_spectrum_fourier(400, 700, a_value, 7, &a, NULL);
	spec_spectrum_fourier(400, 700, b_value, 5, &b, NULL);
	spec_spectrum_fourier(380, 720, b_value, 5, &other, NULL);
	product = combine(&a, SPEC_MULTIPLY, &b, SPEC_EXTRAPOLATE_REFUSE);
	assert_int_equal(product.smooth, SPEC_SPECTRUM_FOURIER);
	assert_int_equal(product.count, 11);
	for (double nm = 400; nm <= 700; nm += 3.7)
		near(value_at(&product, nm), value_at(&a, nm) * value_at(&b, nm), 1e-14,
			"product");
	r = combine(&a, SPEC_SUBTRACT, &b, SPEC_EXTRAPOLATE_REFUSE);
	assert_true(r.count == 7 && r.value[0] == -1 && r.value[6] == -.1);
	spec_spectrum_free(&r);
	r = combine(&a, SPEC_MULTIPLY, &other, SPEC_EXTRAPOLATE_REFUSE);
	assert_int_equal(r.smooth, SPEC_SPECTRUM_SAMPLED);
	assert_true(r.low_nm == 400 && r.high_nm == 700);
	spec_spectrum_free(&r);
	spec_spectrum_free(&product);
	spec_spectrum_free(&other);
	spec_spectrum_free(&a);
	spec_spectrum_free(&b);
}

/* ---- lines ---- */

static const struct spec_line line = {546, 30}, second = {436, 10}, outside = {350, 5};

static void
lines_are_multiplied_by_what_is_smooth(void **state)
{
	struct spec_spectrum lamp = constant(2), filter = sampled(400, 700, 31, .5, .1), r;
	double energy;

	(void)state;
	spec_spectrum_add_lines(&lamp, &line, 1, NULL);
	spec_spectrum_add_lines(&lamp, &outside, 1, NULL);
	for (int order = 0; order < 2; order++) {
		r = combine(order ? &filter : &lamp, SPEC_MULTIPLY, order ? &lamp : &filter,
			SPEC_EXTRAPOLATE_REFUSE);
		assert_int_equal(spec_spectrum_kind(&r), SPEC_SPECTRUM_COMPOSITE);
		assert_int_equal(r.lines, 1);
		near(r.line[0].weight, 30 * 1.96, 1e-12, "weight");
		spec_spectrum_integral(
			&r, SPEC_EXTRAPOLATE_REFUSE, 400, 700, &energy, NULL);
		near(energy, 2 * 600 + 30 * 1.96, 1e-10, "energy");
		spec_spectrum_free(&r);
	}
	r = combine(&lamp, SPEC_MULTIPLY, &filter, SPEC_EXTRAPOLATE_CONSTANT);
	assert_int_equal(r.lines, 2);
	near(r.line[0].weight, 5 * .5, 1e-15, "what stands outside the filter");
	spec_spectrum_free(&r);
	r = combine(&lamp, SPEC_MULTIPLY, &filter, SPEC_EXTRAPOLATE_ZERO);
	assert_int_equal(r.lines, 1);
	spec_spectrum_free(&r);
	r = combine(&lamp, SPEC_DIVIDE, &filter, SPEC_EXTRAPOLATE_REFUSE);
	near(r.line[0].weight, 30 / 1.96, 1e-13, "quotient");
	spec_spectrum_free(&r);
	spec_spectrum_free(&lamp);
	spec_spectrum_free(&filter);
}

static void
composites_cross(void **state)
{
	struct spec_spectrum a = constant(2), b = constant(3), r;

	(void)state;
	spec_spectrum_add_lines(&a, &line, 1, NULL);
	spec_spectrum_add_lines(&b, &second, 1, NULL);
	r = combine(&a, SPEC_MULTIPLY, &b, SPEC_EXTRAPOLATE_REFUSE);
	assert_true(r.level == 6 && r.lines == 2);
	assert_true(r.line[0].wavelength_nm == 436 && r.line[0].weight == 20);
	assert_true(r.line[1].wavelength_nm == 546 && r.line[1].weight == 90);
	spec_spectrum_free(&r);
	r = combine(&a, SPEC_SUBTRACT, &b, SPEC_EXTRAPOLATE_REFUSE);
	assert_true(r.level == -1 && r.lines == 2);
	assert_true(r.line[0].weight == -10 && r.line[1].weight == 30);
	assert_true(b.line[0].weight == 10);
	spec_spectrum_free(&r);
	r = combine(&a, SPEC_SUBTRACT, &a, SPEC_EXTRAPOLATE_REFUSE);
	assert_true(spec_spectrum_is_black(&r));
	spec_spectrum_free(&r);
	assert_int_equal(
		spec_spectrum_combine_number(&a, SPEC_DIVIDE, 4, &r, NULL), SPEC_OK);
	assert_true(r.level == .5 && r.lines == 1 && r.line[0].weight == 7.5);
	spec_spectrum_free(&r);
	spec_spectrum_free(&a);
	spec_spectrum_free(&b);
}

static void
meaningless_lines_are_refused(void **state)
{
	struct spec_spectrum a = constant(2), b = constant(3), r;
	struct spec_error e;

	(void)state;
	spec_spectrum_add_lines(&a, &line, 1, NULL);
	spec_spectrum_add_lines(&b, &second, 1, NULL);
	spec_spectrum_add_lines(&b, &line, 1, NULL);
	spec_curve_set_text(&a.title, "TL", NULL);
	spec_curve_set_text(&b.title, "Hg", NULL);
	assert_int_equal(
		spec_spectrum_combine(&a, SPEC_MULTIPLY, &b, 0, &r, &e), SPEC_ERANGE);
	assert_string_equal(e.message,
		"'TL' times 'Hg': both have a line at 546 nm, and the product of two lines "
		"has no meaning");
	assert_int_equal(
		spec_spectrum_combine(&a, SPEC_DIVIDE, &b, 0, &r, &e), SPEC_ERANGE);
	assert_string_equal(e.message, "'TL' cannot be divided by 'Hg', which has lines");
	assert_int_equal(spec_spectrum_combine(&a, SPEC_RAISE, &b, 0, &r, &e), SPEC_ERANGE);
	assert_int_equal(
		spec_spectrum_combine_number(&a, SPEC_RAISE, 2, &r, &e), SPEC_ERANGE);
	assert_int_equal(spec_spectrum_exp(&a, &r, &e), SPEC_ERANGE);
	assert_string_equal(
		e.message, "'TL' has lines, and the exponential of a line has no meaning");
	assert_int_equal(spec_spectrum_sqrt(&a, &r, &e), SPEC_ERANGE);
	assert_int_equal(spec_spectrum_clamp(&a, 0, 1, &r, &e), SPEC_ERANGE);
	assert_null(r.title);
	spec_spectrum_free(&a);
	spec_spectrum_free(&b);
}

static void
infinite_results_are_refused(void **state)
{
	struct spec_spectrum ramp = sampled(400, 700, 31, -1, .1), one = constant(1), r;
	struct spec_spectrum far = sampled(900, 1000, 3, 1, 1), big = constant(1e308);
	struct spec_error e;

	(void)state;
	spec_curve_set_text(&ramp.title, "ramp", NULL);
	assert_int_equal(
		spec_spectrum_combine_number(&ramp, SPEC_DIVIDE, 0, &r, &e), SPEC_ERANGE);
	assert_int_equal(
		spec_spectrum_combine(&one, SPEC_DIVIDE, &ramp, 0, &r, &e), SPEC_ERANGE);
	assert_string_equal(e.message, "1 divided by 0, at 500 nm, is not finite");
	assert_int_equal(
		spec_spectrum_combine_number(&ramp, SPEC_RAISE, .5, &r, &e), SPEC_ERANGE);
	assert_int_equal(spec_spectrum_sqrt(&ramp, &r, &e), SPEC_ERANGE);
	assert_string_equal(e.message, "the square root of -1, at 400 nm, is not finite");
	assert_int_equal(spec_spectrum_exp(&big, &r, &e), SPEC_ERANGE);
	assert_int_equal(
		spec_spectrum_combine(&big, SPEC_ADD, &big, 0, &r, &e), SPEC_ERANGE);
	assert_int_equal(
		spec_spectrum_combine(&ramp, SPEC_ADD, &far, 0, &r, &e), SPEC_ERANGE);
	assert_non_null(strstr(e.message, "do not meet"));
	assert_int_equal(spec_spectrum_clamp(&ramp, 2, 1, &r, &e), SPEC_ERANGE);
	assert_int_equal(
		spec_spectrum_combine_number(&ramp, SPEC_ADD, NAN, &r, &e), SPEC_ERANGE);
	spec_spectrum_free(&ramp);
	spec_spectrum_free(&one);
	spec_spectrum_free(&far);
	spec_spectrum_free(&big);
}

/* ---- of one spectrum ---- */

static void
functions_are_of_values(void **state)
{
	struct spec_spectrum spectra[KINDS], r;

	(void)state;
	make_kinds(spectra);
	for (int i = 0; i < KINDS; i++) {
		double nm;

		assert_int_equal(spec_spectrum_exp(&spectra[i], &r, NULL), SPEC_OK);
		nm = r.wavelength_nm ? r.wavelength_nm[r.count / 2] : 500;
		near(value_at(&r, nm), exp(value_at(&spectra[i], nm)), 1e-14, "exp");
		spec_spectrum_free(&r);
		assert_int_equal(spec_spectrum_sqrt(&spectra[i], &r, NULL), SPEC_OK);
		near(value_at(&r, nm), sqrt(value_at(&spectra[i], nm)), 1e-14, "sqrt");
		spec_spectrum_free(&r);
		assert_int_equal(
			spec_spectrum_clamp(&spectra[i], .3, .8, &r, NULL), SPEC_OK);
		near(value_at(&r, nm), fmin(fmax(value_at(&spectra[i], nm), .3), .8), 1e-15,
			"clamp");
		spec_spectrum_free(&r);
		assert_int_equal(spec_spectrum_clamp(&spectra[i], 0, 9, &r, NULL), SPEC_OK);
		assert_int_equal(r.smooth, spectra[i].smooth);
		spec_spectrum_free(&r);
		spec_spectrum_free(&spectra[i]);
	}
}

static void
extremes_are_found(void **state)
{
	static const double wave[] = {2, .3, -.4}, value[] = {0, 0, 0, 1, 0, 0, 0};
	struct spec_spectrum series, body, spike, table = sampled(400, 700, 31, -1, .1);
	struct spec_extremes e;

	(void)state;
	spec_spectrum_fourier(400, 700, wave, 3, &series, NULL);
	assert_int_equal(spec_spectrum_extremes(&series, &e, NULL), SPEC_OK);
	near(e.most, 1.5, 1e-12, "1 + hypot(.3, .4)");
	near(e.least, .5, 1e-12, "1 - hypot(.3, .4)");
	/* Where tan u = -4/3: to the square root of what a double tells apart. */
	near(e.most_nm, 700 - atan2(.4, .3) / (2 * 3.141592653589793) * 300, 1e-5, "nm");
	spec_spectrum_blackbody(5000, 2, &body, NULL);
	spec_spectrum_extremes(&body, &e, NULL);
	near(e.most, 2, 1e-12, "the peak");
	near(e.most_nm, 2.897771955e6 / 5000, 1e-4, "Wien's law");
	assert_true(e.least == value_at(&body, 360) && e.least_nm == 360);
	spec_spectrum_extremes(&table, &e, NULL);
	assert_true(e.least == -1 && e.least_nm == 400 && e.most_nm == 700);
	/* Beside a spike Sprague's polynomials swing below 0. */
	spec_spectrum_sampled(400, 460, value, 7, SPEC_INTERPOLATE_SPRAGUE, &spike, NULL);
	spec_spectrum_extremes(&spike, &e, NULL);
	assert_true(e.most == 1 && e.most_nm == 430);
	near(e.least, -.125, .02, "swing");
	for (double nm = 400; nm < 460; nm += .01)
		assert_true(value_at(&spike, nm) >= e.least);
	spec_spectrum_free(&series);
	spec_spectrum_free(&body);
	spec_spectrum_free(&spike);
	spec_spectrum_free(&table);
}

static void
black_is_nothing_at_all(void **state)
{
	static const double rgb[3] = {0, 0, 0};
	static const struct spec_sigmoid black = {1, 0, 0, -INFINITY};
	struct spec_spectrum spectra[KINDS], dark = constant(0), colour, r;

	(void)state;
	make_kinds(spectra);
	for (int i = 0; i < KINDS; i++) {
		assert_false(spec_spectrum_is_black(&spectra[i]));
		spec_spectrum_combine_number(&spectra[i], SPEC_MULTIPLY, 0, &r, NULL);
		assert_true(spec_spectrum_is_black(&r));
		spec_spectrum_free(&r);
		spec_spectrum_free(&spectra[i]);
	}
	assert_true(spec_spectrum_is_black(&dark));
	spec_spectrum_add_lines(&dark, &line, 1, NULL);
	assert_false(spec_spectrum_is_black(&dark));
	spec_spectrum_free(&dark);
	spec_spectrum_rgb(rgb, &black, &colour, NULL);
	assert_true(spec_spectrum_is_black(&colour));
	spec_spectrum_free(&colour);
}

static void
results_have_texts(void **state)
{
	struct spec_spectrum light = sampled(400, 700, 4, 1, 0),
			     ratio = sampled(400, 700, 4, 2, 0), r;

	(void)state;
	spec_curve_set_text(&light.title, "lamp", NULL);
	spec_curve_set_text(&light.quantity, "spectral power distribution", NULL);
	spec_curve_set_text(&light.unit, "W/nm", NULL);
	spec_curve_set_text(&light.medium, "air", NULL);
	spec_curve_set_text(&ratio.title, "wall", NULL);
	spec_curve_set_text(&ratio.quantity, "reflectance", NULL);
	r = combine(&light, SPEC_MULTIPLY, &ratio, SPEC_EXTRAPOLATE_REFUSE);
	assert_string_equal(r.title, "lamp times wall");
	assert_string_equal(r.quantity, "spectral power distribution");
	assert_string_equal(r.unit, "");
	assert_string_equal(r.medium, "");
	spec_spectrum_free(&r);
	r = combine(&light, SPEC_DIVIDE, &ratio, SPEC_EXTRAPOLATE_REFUSE);
	assert_string_equal(r.quantity, "spectral power distribution");
	spec_spectrum_free(&r);
	r = combine(&ratio, SPEC_DIVIDE, &light, SPEC_EXTRAPOLATE_REFUSE);
	assert_string_equal(r.quantity, "");
	spec_spectrum_free(&r);
	r = combine(&light, SPEC_ADD, &light, SPEC_EXTRAPOLATE_REFUSE);
	assert_string_equal(r.title, "lamp plus lamp");
	assert_string_equal(r.unit, "W/nm");
	assert_string_equal(r.medium, "air");
	spec_spectrum_free(&r);
	spec_spectrum_free(&light);
	spec_spectrum_free(&ratio);
}

int
main(void)
{
	const struct CMUnitTest tests[] = {
		cmocka_unit_test(kinds_do_not_depend_on_order),
		cmocka_unit_test(every_pair_has_its_values),
		cmocka_unit_test(numbers_combine),
		cmocka_unit_test(finer_samples_rule),
		cmocka_unit_test(equal_steps_have_one_origin),
		cmocka_unit_test(tables_have_the_wavelengths_of_both),
		cmocka_unit_test(tables_and_functions_lose_nothing),
		cmocka_unit_test(products_of_series_agree_with_samples),
		cmocka_unit_test(lines_are_multiplied_by_what_is_smooth),
		cmocka_unit_test(composites_cross),
		cmocka_unit_test(meaningless_lines_are_refused),
		cmocka_unit_test(infinite_results_are_refused),
		cmocka_unit_test(functions_are_of_values),
		cmocka_unit_test(extremes_are_found),
		cmocka_unit_test(black_is_nothing_at_all),
		cmocka_unit_test(results_have_texts),
	};

	return cmocka_run_group_tests(tests, NULL, NULL);
}
