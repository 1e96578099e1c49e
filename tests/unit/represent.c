/* lib/spectrum/represent, peaks: from one representation of a spectrum to another. */
#include <stdlib.h>

#include "spectrum/lookup.h"
#include "spectrum/represent.h"

#include "check.h"
#include "spectra.h"

#define PI 3.141592653589793
#define TO(...) (&(struct spec_representation){__VA_ARGS__})

static double
energy(const struct spec_spectrum *spectrum)
{
	double low_nm, high_nm, value;

	spec_spectrum_range(spectrum, &low_nm, &high_nm);
	assert_int_equal(spec_spectrum_integral(spectrum, SPEC_EXTRAPOLATE_REFUSE, low_nm,
				 high_nm, &value, NULL),
		SPEC_OK);
	return value;
}

static struct spec_spectrum
convert(const struct spec_spectrum *source, const struct spec_representation *target)
{
	struct spec_spectrum result;
	struct spec_error error;

	if (spec_spectrum_convert(source, target, &result, &error) != SPEC_OK)
		fail_msg("%s", error.message);
	return result;
}

/* Samples over 360..830 nm of a function. */
static struct spec_spectrum
sample(double (*function)(double), double step_nm, enum spec_interpolate interpolate)
{
	static double value[2000];
	size_t count = (size_t)(470 / step_nm) + 1;
	struct spec_spectrum spectrum;

	for (size_t i = 0; i < count; i++)
		value[i] = function(360 + (double)i * step_nm);
	assert_int_equal(
		spec_spectrum_sampled(360, 830, value, count, interpolate, &spectrum, NULL),
		SPEC_OK);
	return spectrum;
}

static double
hill(double nm)
{
	return 3 + 2 * exp(-(nm - 560) * (nm - 560) / (2 * 60 * 60));
}

static double
cubic(double nm)
{
	double x = (nm - 600) / 200;

	return ((-.8 * x + .5) * x + .9) * x + 4;
}

static double
ramp(double nm)
{
	return (nm - 360) / 470;
}

/* ---- Fourier ---- */

/*
 * A ramp from 0 to 1: a0 = 1, an = 0, bn = -1 / (pi n). Left samples of it, of step h, are
 * stairs: that function's own coefficients, not those of a sum over samples.
 */
static void
samples_are_integrated_exactly(void **state)
{
	struct spec_spectrum linear = sample(ramp, 47, SPEC_INTERPOLATE_LINEAR);
	struct spec_spectrum left = sample(ramp, 47, SPEC_INTERPOLATE_LEFT), series;

	(void)state;
	series = convert(&linear, TO(.kind = SPEC_SPECTRUM_FOURIER, .count = 41));
	assert_true(series.low_nm == 360 && series.high_nm == 830 && series.count == 41);
	near(series.value[0], 1, 1e-14, "a0");
	for (int n = 1; n <= 20; n++) {
		near(series.value[2 * n - 1], 0, 1e-14, "an");
		near(series.value[2 * n], -1 / (PI * n), 1e-14, "bn");
	}
	spec_spectrum_free(&series);
	series = convert(&left, TO(.kind = SPEC_SPECTRUM_FOURIER, .count = 41));
	near(series.value[0], 2 * .45, 1e-14, "a0 of the stairs");
	for (int n = 1; n <= 20; n++) {
		double cosine = 0, sine = 0, u = 2 * PI * n / 10;

		for (int i = 0; i < 10; i++) {
			cosine += .1 * i * (sin(u * (i + 1)) - sin(u * i));
			sine += .1 * i * (cos(u * i) - cos(u * (i + 1)));
		}
		near(series.value[2 * n - 1], cosine / (PI * n), 1e-14, "an of the stairs");
		near(series.value[2 * n], sine / (PI * n), 1e-14, "bn of the stairs");
	}
	spec_spectrum_free(&series);
	spec_spectrum_free(&linear);
	spec_spectrum_free(&left);
}

/* Over a part of the range the pieces at its ends are cut. */
static void
parts_of_tables_are_cut(void **state)
{
	struct spec_spectrum linear = sample(ramp, 47, SPEC_INTERPOLATE_LINEAR), series;
	struct spec_spectrum wide;

	(void)state;
	series = convert(&linear, TO(.kind = SPEC_SPECTRUM_FOURIER, .count = 9,
					  .low_nm = 400, .high_nm = 700));
	near(series.value[0], 2 * (550 - 360) / 470., 1e-14, "a0");
	for (int n = 1; n <= 4; n++) {
		near(series.value[2 * n - 1], 0, 1e-14, "an");
		near(series.value[2 * n], -300 / 470. / (PI * n), 1e-14, "bn");
	}
	spec_spectrum_free(&series);
	assert_int_equal(spec_spectrum_convert(&linear,
				 TO(.kind = SPEC_SPECTRUM_FOURIER, .count = 9,
					 .low_nm = 340, .high_nm = 900),
				 &series, NULL),
		SPEC_ERANGE);
	wide = convert(
		&linear, TO(.kind = SPEC_SPECTRUM_FOURIER, .count = 9, .low_nm = 340,
				 .high_nm = 900, .extrapolate = SPEC_EXTRAPOLATE_ZERO));
	near(wide.value[0], 2 * 235 / 560., 1e-14, "energy over the wider range");
	spec_spectrum_free(&wide);
	wide = convert(
		&linear, TO(.kind = SPEC_SPECTRUM_FOURIER, .count = 9, .low_nm = 340,
				 .high_nm = 900, .extrapolate = SPEC_EXTRAPOLATE_CONSTANT));
	near(wide.value[0], 2 * (235 + 70) / 560., 1e-13, "with the ends drawn out");
	spec_spectrum_free(&wide);
	spec_spectrum_free(&linear);
}

static void
series_are_cut_or_filled(void **state)
{
	static const double coefficient[] = {2, .3, -.4, .1, .05};
	struct spec_spectrum series, shorter, longer, other;

	(void)state;
	spec_spectrum_fourier(400, 700, coefficient, 5, &series, NULL);
	shorter = convert(&series, TO(.kind = SPEC_SPECTRUM_FOURIER, .count = 3));
	longer = convert(&series, TO(.kind = SPEC_SPECTRUM_FOURIER, .count = 7));
	assert_memory_equal(shorter.value, coefficient, 3 * sizeof(double));
	assert_memory_equal(longer.value, coefficient, 5 * sizeof(double));
	assert_true(longer.value[5] == 0 && longer.value[6] == 0 && shorter.count == 3);
	/* Half a wave fewer fits exactly into half the range: its own values tell. */
	other = convert(&series, TO(.kind = SPEC_SPECTRUM_FOURIER, .count = 101,
					 .low_nm = 400, .high_nm = 550));
	near(value_at(&other, 470), value_at(&series, 470), .01, "over another range");
	near(energy(&other) / 150, value_at(&other, 475), 1, "of that size");
	spec_spectrum_free(&series);
	spec_spectrum_free(&shorter);
	spec_spectrum_free(&longer);
	spec_spectrum_free(&other);
}

/* A black body, smooth: its series' energy is its own, to what the pieces promise. */
static void
functions_have_series(void **state)
{
	struct spec_spectrum body, series;
	double sum = 0;

	(void)state;
	spec_spectrum_blackbody(6500, 2, &body, NULL);
	series = convert(&body, TO(.kind = SPEC_SPECTRUM_FOURIER, .count = 11));
	assert_true(series.low_nm == 360 && series.high_nm == 830);
	near(series.value[0] * 235, energy(&body), 1e-10, "a0");
	for (int i = 0; i <= 47000; i++) {
		double nm = 360 + .01 * i;

		sum += (i == 0 || i == 47000 ? 1
			       : i % 2       ? 4
					     : 2) *
		       value_at(&body, nm) * sin(2 * PI * 3 * (nm - 360) / 470);
	}
	near(series.value[6], sum * .01 / 3 * 2 / 470, 1e-12, "b3");
	spec_spectrum_free(&body);
	spec_spectrum_free(&series);
}

/* ---- lines ---- */

static const struct spec_line mercury[] = {
	{404, 31}, {436, 80}, {546, 120}, {577, 22.5}, {579, 24}};

/* Spikes in single samples above a cubic: the very lines, and the cubic. */
static void
spikes_above_cubic_are_found(void **state)
{
	struct spec_spectrum table = sample(cubic, 1, SPEC_INTERPOLATE_LINEAR), found;
	double whole = energy(&table);

	(void)state;
	for (size_t i = 0; i < COUNT(mercury); i++) {
		table.value[(size_t)mercury[i].wavelength_nm - 360] += mercury[i].weight;
		whole += mercury[i].weight;
	}
	found = convert(&table, TO(.kind = SPEC_SPECTRUM_COMPOSITE, .count = 9));
	assert_int_equal(found.lines, COUNT(mercury));
	for (size_t i = 0; i < COUNT(mercury); i++) {
		assert_true(found.line[i].wavelength_nm == mercury[i].wavelength_nm);
		/* Those at 577 and 579 nm share a foot, so their bases are straight. */
		near(found.line[i].weight, mercury[i].weight, i < 3 ? 1e-11 : 1e-4,
			"weight");
	}
	for (double nm = 360; nm < 830; nm++)
		near(value_at(&found, nm), cubic(nm), nm > 575 && nm < 581 ? 1e-4 : 1e-11,
			"smooth");
	near(energy(&found), whole, 1e-9, "energy");
	spec_spectrum_free(&found);
	/* The heaviest come first. */
	found = convert(&table, TO(.kind = SPEC_SPECTRUM_COMPOSITE, .count = 2));
	assert_int_equal(found.lines, 2);
	assert_true(found.line[0].wavelength_nm == 436);
	assert_true(found.line[1].wavelength_nm == 546);
	near(value_at(&found, 404), cubic(404) + 31, 1e-11, "what stays");
	near(energy(&found), whole, 1e-9, "energy with two lines");
	spec_spectrum_free(&found);
	found = convert(&table, TO(.kind = SPEC_SPECTRUM_COMPOSITE, .count = 0));
	assert_int_equal(found.lines, 0);
	spec_spectrum_free(&found);
	spec_spectrum_free(&table);
}

/* To samples and back: the same lines, also those between two samples. */
static void
lines_come_back_from_samples(void **state)
{
	static const struct spec_line between[] = {
		{404.66, 30}, {435.83, 80}, {546.07, 120}};
	struct spec_spectrum composite = sample(hill, 5, SPEC_INTERPOLATE_LINEAR), table;
	struct spec_spectrum back;

	(void)state;
	spec_spectrum_add_lines(&composite, between, COUNT(between), NULL);
	table = convert(&composite, TO(.kind = SPEC_SPECTRUM_TABULATED));
	assert_int_equal(table.lines, 0);
	near(energy(&table), energy(&composite), 1e-10, "energy");
	back = convert(&table, TO(.kind = SPEC_SPECTRUM_COMPOSITE, .count = 3));
	assert_int_equal(back.lines, 3);
	/* The hill is no cubic: its fourth derivative times 7.5^4 / 24 is off by 1e-3. */
	for (size_t i = 0; i < COUNT(between); i++) {
		near(back.line[i].wavelength_nm, between[i].wavelength_nm, 1e-3, "line");
		near(back.line[i].weight, between[i].weight, 1e-2, "weight");
	}
	near(energy(&back), energy(&composite), 1e-10, "energy of what came back");
	spec_spectrum_free(&composite);
	spec_spectrum_free(&table);
	spec_spectrum_free(&back);
}

/* A peak must rise by a tenth of what it stands on. */
static void
small_bumps_are_no_lines(void **state)
{
	struct spec_spectrum table = sample(cubic, 5, SPEC_INTERPOLATE_LINEAR), split;

	(void)state;
	table.value[20] *= 1.09;
	table.value[40] *= 1.11;
	split = convert(&table, TO(.kind = SPEC_SPECTRUM_COMPOSITE, .count = 9));
	assert_int_equal(split.lines, 1);
	assert_true(split.line[0].wavelength_nm == 560);
	assert_true(split.value[20] == table.value[20]);
	spec_spectrum_free(&split);
	spec_spectrum_free(&table);
}

/* Smooth things have no lines: hills, ramps, and hills in coarse samples. */
static void
hills_are_no_lines(void **state)
{
	struct spec_spectrum tables[] = {sample(hill, 1, 0), sample(hill, 10, 0),
		sample(ramp, 5, 0), sample(cubic, 47, 0)};

	(void)state;
	for (size_t i = 0; i < COUNT(tables); i++) {
		struct spec_spectrum split = convert(
			&tables[i], TO(.kind = SPEC_SPECTRUM_COMPOSITE, .count = 9));

		assert_int_equal(split.lines, 0);
		assert_memory_equal(
			split.value, tables[i].value, split.count * sizeof *split.value);
		spec_spectrum_free(&split);
		spec_spectrum_free(&tables[i]);
	}
}

/*
 * CIE's fluorescent lamps by 5 nm: mercury's lines at 404.66, 435.83 and 546.07 nm (NIST).
 * In F11 the green phosphor lies over the last.
 */
static void
lamps_have_mercurys_lines(void **state)
{
	static const char *const lamps[] = {
		"illuminants/F2", "illuminants/F7", "illuminants/F11"};

	(void)state;
	for (size_t i = 0; i < COUNT(lamps); i++) {
		struct spec_curve curve;
		struct spec_spectrum table, split;
		int first = 0, second = 0, third = 0;

		assert_int_equal(spec_lookup_curve(lamps[i], &curve, NULL), SPEC_OK);
		spec_spectrum_from_curve(&curve, 0, &table, NULL);
		split = convert(&table, TO(.kind = SPEC_SPECTRUM_COMPOSITE, .count = 8));
		for (size_t k = 0; k < split.lines; k++) {
			double nm = split.line[k].wavelength_nm;

			first |= fabs(nm - 404.66) < 1;
			second |= fabs(nm - 435.83) < 1;
			third |= fabs(nm - 546.07) < 2;
		}
		assert_true(first && second && third);
		near(energy(&split), energy(&table), 1e-9, "energy");
		for (size_t k = 0; k < split.count; k++)
			assert_true(
				split.value[k] >= 0 && split.value[k] <= table.value[k]);
		spec_spectrum_free(&table);
		spec_spectrum_free(&split);
		spec_curve_free(&curve);
	}
}

/* ---- composites ---- */

/* One line over a constant, in every representation that has an energy. */
static void
conversions_keep_energy(void **state)
{
	static const struct spec_line line = {546.1, 30};
	static const enum spec_interpolate rules[] = {SPEC_INTERPOLATE_LINEAR,
		SPEC_INTERPOLATE_NEAREST, SPEC_INTERPOLATE_LEFT, SPEC_INTERPOLATE_SPRAGUE};
	struct spec_spectrum source, result;

	(void)state;
	spec_spectrum_constant(.5, &source, NULL);
	spec_spectrum_add_lines(&source, &line, 1, NULL);
	for (size_t i = 0; i < COUNT(rules); i++) {
		result = convert(&source,
			TO(.kind = SPEC_SPECTRUM_SAMPLED, .low_nm = 380, .high_nm = 780,
				.count = 81, .interpolate = rules[i]));
		assert_int_equal(result.smooth, SPEC_SPECTRUM_SAMPLED);
		assert_int_equal(result.interpolate, rules[i]);
		near(energy(&result), 230, 1e-10, spec_interpolate_name(rules[i]));
		spec_spectrum_free(&result);
	}
	result = convert(&source, TO(.kind = SPEC_SPECTRUM_TABULATED));
	assert_int_equal(result.count, 471);
	near(energy(&result), 265, 1e-10, "tabulated");
	spec_spectrum_free(&result);
	result = convert(&source, TO(.kind = SPEC_SPECTRUM_FOURIER, .count = 9));
	near(energy(&result), 265, 1e-10, "fourier");
	near(result.value[3], 2 * 30 / 470. * cos(2 * PI * 2 * 186.1 / 470), 1e-12, "a2");
	near(result.value[4], 2 * 30 / 470. * sin(2 * PI * 2 * 186.1 / 470), 1e-12, "b2");
	spec_spectrum_free(&result);
	result = convert(&source,
		TO(.kind = SPEC_SPECTRUM_COMPOSITE, .count = 1, .coefficients = 3));
	assert_int_equal(result.smooth, SPEC_SPECTRUM_FOURIER);
	assert_true(result.lines == 1 && result.line[0].weight == 30);
	near(energy(&result), 265, 1e-10, "composite");
	spec_spectrum_free(&result);
	result = convert(&source, TO(.kind = SPEC_SPECTRUM_CONSTANT));
	near(result.level, 265 / 470., 1e-14, "constant");
	spec_spectrum_free(&result);
	spec_spectrum_free(&source);
}

/* 1.1 nm of 5 beyond a sample: shared, or where a reader of that rule would look for it. */
static void
lines_go_where_they_are_read(void **state)
{
	static const struct spec_line line = {546.1, 30};
	static const double wanted[][2] = {{30 * .78 / 5, 30 * .22 / 5}, {6, 0}, {6, 0}};
	struct spec_spectrum source, result;

	(void)state;
	spec_spectrum_constant(0, &source, NULL);
	spec_spectrum_add_lines(&source, &line, 1, NULL);
	for (int i = 0; i < 3; i++) {
		result = convert(&source,
			TO(.kind = SPEC_SPECTRUM_SAMPLED, .low_nm = 380, .high_nm = 780,
				.count = 81, .interpolate = (enum spec_interpolate)i));
		near(result.value[33], wanted[i][0], 1e-12, "at 545 nm");
		near(result.value[34], wanted[i][1], 1e-12, "at 550 nm");
		near(value_at(&result, 546.1) > value_at(&result, 551), 1, 0, "is read");
		spec_spectrum_free(&result);
	}
	spec_spectrum_free(&source);
}

static void
lines_at_ends_keep_energy(void **state)
{
	static const struct spec_line ends[] = {{400, 3}, {700, 5}, {399, 50}, {701, 50}};
	struct spec_spectrum source, result;

	(void)state;
	spec_spectrum_constant(0, &source, NULL);
	spec_spectrum_add_lines(&source, ends, COUNT(ends), NULL);
	for (int i = 0; i < 3; i++) {
		result = convert(&source,
			TO(.kind = SPEC_SPECTRUM_SAMPLED, .low_nm = 400, .high_nm = 700,
				.count = 31, .interpolate = (enum spec_interpolate)i));
		near(energy(&result), 8, 1e-12, "ends");
		spec_spectrum_free(&result);
	}
	spec_spectrum_free(&source);
}

static void
texts_and_curves(void **state)
{
	static const double coefficient[] = {2, .3, -.4};
	struct spec_spectrum series, copy;
	struct spec_curve curve;

	(void)state;
	spec_spectrum_fourier(400, 700, coefficient, 3, &series, NULL);
	spec_curve_set_text(&series.title, "lamp", NULL);
	spec_curve_set_text(&series.medium, "air", NULL);
	copy = convert(&series, TO(.kind = SPEC_SPECTRUM_SAMPLED));
	assert_string_equal(copy.title, "lamp");
	assert_int_equal(copy.count, 301);
	assert_int_equal(spec_spectrum_to_curve(&series, &curve, NULL), SPEC_OK);
	assert_string_equal(curve.medium, "air");
	assert_true(curve.count == 301 && curve.wavelength_nm[300] == 700);
	near(curve.value[150], 1 - .3, 1e-14, "half-way");
	spec_curve_free(&curve);
	spec_spectrum_free(&copy);
	spec_spectrum_free(&series);
}

static void
asking_has_a_syntax(void **state)
{
	static const char *const wrong[] = {"", "fourier", "fourier:", "fourier:x",
		"fourier:9x", "fourier:-9", "composite:", "composite:4,", "composite:4,x",
		"sampled:", "sampled:400:700", "table", "fourier:9,9"};
	static const char *const outside[] = {"fourier:8", "fourier:0", "fourier:4099",
		"composite:4,6", "composite:5000", "sampled:400:400:1"};
	struct spec_representation r = {.extrapolate = SPEC_EXTRAPOLATE_ZERO};
	struct spec_error error;

	(void)state;
	assert_int_equal(
		spec_representation_parse("sampled:400:700:10", &r, NULL), SPEC_OK);
	assert_true(r.kind == SPEC_SPECTRUM_SAMPLED && r.low_nm == 400 &&
		    r.high_nm == 700 && r.count == 31);
	assert_int_equal(spec_representation_parse("sampled", &r, NULL), SPEC_OK);
	assert_true(r.kind == SPEC_SPECTRUM_SAMPLED && r.count == 0 && r.low_nm == 0);
	assert_int_equal(spec_representation_parse("tabulated", &r, NULL), SPEC_OK);
	assert_true(r.kind == SPEC_SPECTRUM_TABULATED && r.count == 0 && r.low_nm == 0);
	assert_int_equal(spec_representation_parse("fourier:9", &r, NULL), SPEC_OK);
	assert_true(r.kind == SPEC_SPECTRUM_FOURIER && r.count == 9);
	assert_int_equal(spec_representation_parse("composite:4", &r, NULL), SPEC_OK);
	assert_true(r.kind == SPEC_SPECTRUM_COMPOSITE && r.count == 4);
	assert_int_equal(r.coefficients, 0);
	assert_int_equal(spec_representation_parse("composite:4,11", &r, NULL), SPEC_OK);
	assert_int_equal(r.coefficients, 11);
	assert_int_equal(r.extrapolate, SPEC_EXTRAPOLATE_ZERO);
	for (size_t i = 0; i < COUNT(wrong); i++)
		assert_int_equal(
			spec_representation_parse(wrong[i], &r, &error), SPEC_EUSAGE);
	for (size_t i = 0; i < COUNT(outside); i++)
		assert_int_equal(
			spec_representation_parse(outside[i], &r, &error), SPEC_ERANGE);
}

static void
wrong_conversions_are_refused(void **state)
{
	struct spec_spectrum left = sample(cubic, 10, SPEC_INTERPOLATE_LEFT), result;
	struct spec_spectrum lamp = sample(cubic, 10, SPEC_INTERPOLATE_LINEAR);
	struct spec_error e;

	(void)state;
	spec_spectrum_add_lines(&lamp, mercury, COUNT(mercury), NULL);
	spec_curve_set_text(&lamp.title, "lamp", NULL);
	assert_int_equal(
		spec_spectrum_convert(&left,
			TO(.kind = SPEC_SPECTRUM_COMPOSITE, .count = 3), &result, &e),
		SPEC_EUNSUPPORTED);
	assert_non_null(strstr(e.message, "'left'"));
	assert_int_equal(
		spec_spectrum_convert(&lamp,
			TO(.kind = SPEC_SPECTRUM_COMPOSITE, .count = 3), &result, &e),
		SPEC_ERANGE);
	assert_string_equal(e.message, "'lamp' has 5 lines, more than the 3 asked for");
	assert_int_equal(
		spec_spectrum_convert(&lamp, TO(.kind = SPEC_SPECTRUM_RGB), &result, &e),
		SPEC_EUNSUPPORTED);
	assert_int_equal(
		spec_spectrum_convert(
			&lamp, TO(.kind = SPEC_SPECTRUM_FOURIER, .count = 4), &result, &e),
		SPEC_ERANGE);
	assert_int_equal(
		spec_spectrum_convert(&lamp,
			TO(.kind = SPEC_SPECTRUM_SAMPLED, .low_nm = 700, .high_nm = 400),
			&result, &e),
		SPEC_ERANGE);
	assert_int_equal(spec_spectrum_convert(&lamp,
				 TO(.kind = SPEC_SPECTRUM_SAMPLED, .low_nm = 400,
					 .high_nm = 900, .count = 11),
				 &result, &e),
		SPEC_ERANGE);
	assert_string_equal(e.message, "'lamp' covers 360..830 nm, not 900 nm");
	assert_null(result.title);
	spec_spectrum_free(&left);
	spec_spectrum_free(&lamp);
}

int
main(void)
{
	const struct CMUnitTest tests[] = {
		cmocka_unit_test(samples_are_integrated_exactly),
		cmocka_unit_test(parts_of_tables_are_cut),
		cmocka_unit_test(series_are_cut_or_filled),
		cmocka_unit_test(functions_have_series),
		cmocka_unit_test(spikes_above_cubic_are_found),
		cmocka_unit_test(lines_come_back_from_samples),
		cmocka_unit_test(small_bumps_are_no_lines),
		cmocka_unit_test(hills_are_no_lines),
		cmocka_unit_test(lamps_have_mercurys_lines),
		cmocka_unit_test(conversions_keep_energy),
		cmocka_unit_test(lines_go_where_they_are_read),
		cmocka_unit_test(lines_at_ends_keep_energy),
		cmocka_unit_test(texts_and_curves),
		cmocka_unit_test(asking_has_a_syntax),
		cmocka_unit_test(wrong_conversions_are_refused),
	};

	return cmocka_run_group_tests(tests, NULL, NULL);
}
