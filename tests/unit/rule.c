/* lib/colour/rule, abridged: integration by the image's grid and by ASTM E308, luminance. */
#include <stdio.h>
#include <stdlib.h>
#include <unistd.h>

#include "colour/abridged.h"
#include "colour/difference.h"
#include "colour/rule.h"
#include "spectrum/lookup.h"

#include "check.h"

#define MOST_BANDS 512

/* An observer, and a light where one is named. */
struct scene {
	struct spec_curve eye, lamp;
	double nm[MOST_BANDS], weight[3 * MOST_BANDS];
	struct spec_bands bands;
};

static void
open_scene(struct scene *scene, const char *eye, const char *lamp)
{
	struct spec_error error;

	*scene = (struct scene){.bands = {.wavelength_nm = scene->nm}};
	if (spec_observer_load(eye, &scene->eye, &error) != SPEC_OK)
		fail_msg("%s", error.message);
	if (lamp && spec_lookup_light(lamp, &scene->lamp, &error) != SPEC_OK)
		fail_msg("%s", error.message);
}

static void
close_scene(struct scene *scene)
{
	spec_curve_free(&scene->eye);
	spec_curve_free(&scene->lamp);
}

static void
lay_bands(struct scene *scene, double first_nm, double last_nm, double step_nm)
{
	scene->bands.count = 0;
	for (double nm = first_nm; nm <= last_nm; nm += step_nm)
		scene->nm[scene->bands.count++] = nm;
}

static void
weigh(struct scene *scene, enum spec_rule rule, struct spec_rule_sums *sums)
{
	struct spec_error error;

	if (spec_rule_weights(rule, &scene->eye, scene->lamp.count ? &scene->lamp : NULL,
		    &scene->bands, scene->weight, sums, &error) != SPEC_OK)
		fail_msg("%s", error.message);
}

/* The tristimulus value of samples by the weights. */
static double
seen(const struct scene *scene, size_t c, const double *value)
{
	double sum = 0;

	for (size_t i = 0; i < scene->bands.count; i++)
		sum += scene->weight[c * scene->bands.count + i] * value[i];
	return sum;
}

static void
refuse(struct scene *scene, enum spec_rule rule, enum spec_status status,
	const char *message)
{
	struct spec_rule_sums sums;
	struct spec_error error;

	assert_int_equal(spec_rule_weights(rule, &scene->eye,
				 scene->lamp.count ? &scene->lamp : NULL, &scene->bands,
				 scene->weight, &sums, &error),
		status);
	assert_contains(error.message, message);
}

/* ---- ASTM E308 ---- */

/*
 * The tables of ASTM E308-15, which colour-science 0.4 has in its tests as "matching" it: 100
 * times the weights, three decimals. Illuminant A, 1964, by 10 nm from 360 nm.
 */
static const double a_1964_10[][3] = {
	{0, 0, 0},
	{0, 0, 0},
	{0, 0, 0},
	{.002, 0, .008},
	{.025, .003, .110},
	{.134, .014, .615},
	{.377, .039, 1.792},
	{.686, .084, 3.386},
	{.964, .156, 4.944},
	{1.080, .259, 5.806},
	{1.006, .424, 5.812},
	{.731, .696, 4.919},
	{.343, 1.082, 3.300},
	{.078, 1.616, 1.973},
	{.022, 2.422, 1.152},
	{.218, 3.529, .658},
	{.750, 4.840, .382},
	{1.642, 6.100, .211},
	{2.842, 7.250, .102},
	{4.336, 8.114, .032},
	{6.200, 8.758, .001},
	{8.262, 8.988, 0},
	{10.227, 8.760, 0},
	{11.945, 8.304, 0},
	{12.746, 7.468, 0},
	{12.337, 6.323, 0},
	{10.817, 5.033, 0},
	{8.560, 3.744, 0},
	{6.014, 2.506, 0},
	{3.887, 1.560, 0},
	{2.309, .911, 0},
	{1.276, .499, 0},
	{.666, .259, 0},
	{.336, .130, 0},
	{.166, .065, 0},
	{.082, .032, 0},
	{.040, .016, 0},
	{.020, .008, 0},
	{.010, .004, 0},
	{.005, .002, 0},
	{.003, .001, 0},
	{.001, .001, 0},
	{.001, 0, 0},
	{0, 0, 0},
	{0, 0, 0},
	{0, 0, 0},
	{0, 0, 0},
	{0, 0, 0},
};

/* The same by 20 nm. */
static const double a_1964_20[][3] = {
	{0, 0, -.001},
	{-.009, -.001, -.041},
	{.060, .005, .257},
	{.773, .078, 3.697},
	{1.900, .304, 9.755},
	{1.971, .855, 11.487},
	{.718, 2.146, 6.785},
	{.043, 4.899, 2.321},
	{1.522, 9.647, .743},
	{5.677, 14.461, .196},
	{12.445, 17.474, .005},
	{20.554, 17.584, -.003},
	{25.332, 14.896, 0},
	{21.571, 10.080, 0},
	{12.179, 5.068, 0},
	{4.668, 1.830, 0},
	{1.324, .513, 0},
	{.318, .123, 0},
	{.075, .029, 0},
	{.018, .007, 0},
	{.005, .002, 0},
	{.001, .001, 0},
	{0, 0, 0},
	{0, 0, 0},
};

/* D65, 1931, by 20 nm from 360 nm. */
static const double d65_1931_20[][3] = {
	{-.001, 0, -.005},
	{-.008, 0, -.039},
	{.179, .002, .829},
	{2.542, .071, 12.203},
	{6.670, .453, 33.637},
	{6.333, 1.316, 36.334},
	{2.213, 2.933, 18.278},
	{.052, 6.866, 5.543},
	{1.348, 14.106, 1.611},
	{5.767, 18.981, .382},
	{11.301, 18.863, .068},
	{16.256, 15.455, .025},
	{17.933, 10.699, .013},
	{14.020, 6.277, .003},
	{7.057, 2.743, 0},
	{2.527, .927, 0},
	{.670, .242, 0},
	{.140, .050, 0},
	{.035, .013, 0},
	{.008, .003, 0},
	{.002, .001, 0},
	{0, 0, 0},
	{0, 0, 0},
	{0, 0, 0},
};

/* Of bands of 400 to 700 nm the ends collect what is missing, after rounding. */
static const double d65_1931_20_at_400[3] = {.170, .002, .785};
static const double d65_1931_20_at_700[3] = {.185, .067, 0};

static void
compare(struct scene *scene, double first_nm, double step_nm, const double (*table)[3],
	size_t count, double tolerance)
{
	struct spec_rule_sums sums;

	lay_bands(scene, first_nm, first_nm + step_nm * (double)(count - 1), step_nm);
	assert_int_equal(scene->bands.count, count);
	weigh(scene, SPEC_RULE_ASTM, &sums);
	for (size_t i = 0; i < count; i++)
		for (size_t c = 0; c < 3; c++)
			near(100 * scene->weight[c * count + i], table[i][c], tolerance,
				"weight");
}

static void
astm_has_its_tables(void **state)
{
	struct scene scene;
	double cut[16][3];

	(void)state;
	memcpy(cut, d65_1931_20 + 2, sizeof cut);
	memcpy(cut[0], d65_1931_20_at_400, sizeof cut[0]);
	memcpy(cut[15], d65_1931_20_at_700, sizeof cut[15]);
	open_scene(
		&scene, "1964", "blackbody:2855.4957K"); /* A by 1 nm: 2848 K of its c2 */
	compare(&scene, 360, 10, a_1964_10, COUNT(a_1964_10), 5e-4);
	compare(&scene, 360, 20, a_1964_20, COUNT(a_1964_20), 5e-4);
	close_scene(&scene);
	open_scene(&scene, "1931", "D65");
	compare(&scene, 360, 20, d65_1931_20, COUNT(d65_1931_20), 5e-4);
	compare(&scene, 400, 20, (const double(*)[3])cut, COUNT(cut), 4 * 5e-4);
	close_scene(&scene);
}

/* Polynomials through three or four bands are parabolas where those lie on one. */
static void
astm_is_exact_for_parabolas(void **state)
{
	(void)state;
	for (int step = 10; step <= 20; step += 10) {
		struct scene scene;
		struct spec_rule_sums sums;
		double value[MOST_BANDS], wanted[3] = {0, 0, 0}, y = 0;

		open_scene(&scene, "1931", "FL11");
		lay_bands(&scene, 360, 830, step);
		weigh(&scene, SPEC_RULE_ASTM, &sums);
		for (size_t i = 0; i < scene.bands.count; i++)
			value[i] = .2 + pow((scene.nm[i] - 610) / 300, 2);
		/* FL11 is told to 780 nm: nothing of it is beyond the last band. */
		for (double nm = 360; nm <= 780; nm++) {
			const double *ybar =
				scene.eye.value + scene.eye.count + (size_t)nm - 360;
			double power;

			assert_int_equal(
				spec_curve_sample(&scene.lamp, 0, SPEC_EXTRAPOLATE_ZERO,
					&nm, 1, &power, NULL),
				SPEC_OK);
			y += power * *ybar;
			power *= .2 + pow((nm - 610) / 300, 2);
			wanted[0] += power * ybar[-(ptrdiff_t)scene.eye.count];
			wanted[1] += power * *ybar;
			wanted[2] += power * ybar[scene.eye.count];
		}
		for (size_t c = 0; c < 3; c++)
			near(seen(&scene, c, value), wanted[c] / y, 1e-13, "parabola");
		near(sums.integral / y, 1, 1e-13, "integral");
		close_scene(&scene);
	}
}

/*
 * An observer and a light that are 1 everywhere: the sum of a parabola over every nm, but by
 * 20 nm the last 10 are those of 820 nm. No real observer sees the ends of the table.
 */
static void
astm_reaches_to_the_ends(void **state)
{
	struct spec_curve level;

	(void)state;
	assert_int_equal(spec_curve_new(2, 3, &level, NULL), SPEC_OK);
	level.wavelength_nm[0] = 300;
	level.wavelength_nm[1] = 900;
	for (size_t i = 0; i < 6; i++)
		level.value[i] = 1;
	for (int step = 10; step <= 20; step += 10) {
		double nm[48], weight[3 * 48], sum, wanted = 0, got = 0;
		size_t count = step == 10 ? 48 : 24;

		for (size_t i = 0; i < count; i++)
			nm[i] = 360 + (double)i * step;
		assert_int_equal(spec_abridged_weights(
					 &level, &level, nm, count, weight, &sum, NULL),
			SPEC_OK);
		near(sum, 471, 1e-10, "sum");
		for (int at = 360; at <= 830; at++)
			wanted += pow((step == 20 && at > 820 ? 820 : at) - 500, 2);
		for (size_t i = 0; i < count; i++)
			got += weight[count + i] * sum * pow(nm[i] - 500, 2);
		near(got / wanted, 1, 1e-12, "parabola");
	}
	spec_curve_free(&level);
}

/* Bands beyond the table weigh nothing, and change nothing. */
static void
astm_ignores_bands_outside_its_table(void **state)
{
	struct scene scene;
	struct spec_rule_sums sums;
	double wanted[3 * 48];

	(void)state;
	open_scene(&scene, "1931", "D65");
	lay_bands(&scene, 360, 830, 10);
	assert_int_equal(scene.bands.count, 48);
	weigh(&scene, SPEC_RULE_ASTM, &sums);
	memcpy(wanted, scene.weight, sizeof wanted);
	lay_bands(&scene, 300, 850, 10);
	assert_int_equal(scene.bands.count, 56);
	weigh(&scene, SPEC_RULE_ASTM, &sums);
	for (size_t c = 0; c < 3; c++)
		for (size_t i = 0; i < 56; i++)
			near(scene.weight[c * 56 + i],
				i < 6 || i >= 54 ? 0 : wanted[c * 48 + i - 6], 0, "weight");
	/* Those of the white point of ASTM E308-01: 95.047 100 108.883. */
	near(sums.white[0], .95047, 2e-5, "X of white");
	near(sums.white[1], 1, 1e-14, "Y of white");
	near(sums.white[2], 1.08883, 2e-5, "Z of white");
	/* Two bands collect everything. */
	lay_bands(&scene, 560, 570, 10);
	weigh(&scene, SPEC_RULE_ASTM, &sums);
	near(scene.weight[2] + scene.weight[3], 1, 1e-14, "two bands");
	close_scene(&scene);
}

static void
astm_refuses_other_bands(void **state)
{
	struct scene scene;
	double edges[] = {395, 405, 415, 425};

	(void)state;
	open_scene(&scene, "1931", "D65");
	lay_bands(&scene, 400, 700, 5);
	refuse(&scene, SPEC_RULE_ASTM, SPEC_EUNSUPPORTED, "10 or 20 nm apart");
	lay_bands(&scene, 400, 700, 10);
	scene.nm[30] = 699;
	refuse(&scene, SPEC_RULE_ASTM, SPEC_EUNSUPPORTED, "10 or 20 nm apart");
	lay_bands(&scene, 405, 705, 10);
	refuse(&scene, SPEC_RULE_ASTM, SPEC_EUNSUPPORTED, "405, 415, … nm are not among");
	lay_bands(&scene, 410, 690, 20);
	refuse(&scene, SPEC_RULE_ASTM, SPEC_EUNSUPPORTED, "410, 430, … nm are not among");
	lay_bands(&scene, 400, 420, 10);
	scene.bands.edges_nm = edges;
	refuse(&scene, SPEC_RULE_ASTM, SPEC_EUSAGE, "not for means over bins");
	close_scene(&scene);
	open_scene(&scene, "1931", NULL);
	lay_bands(&scene, 400, 700, 10);
	refuse(&scene, SPEC_RULE_ASTM, SPEC_EUSAGE, "not for light");
	close_scene(&scene);
}

/* ---- the image's own grid ---- */

/* By hand: widths of half the way to the neighbours, at the table's values. */
static void
grid_is_the_trapezoid(void **state)
{
	static const double widths[] = {10, 15, 30, 25};
	struct scene scene;
	struct spec_rule_sums sums;
	double sum[3] = {0, 0, 0};

	(void)state;
	open_scene(&scene, "1931", "D65");
	scene.bands.count = 4;
	scene.nm[0] = 500;
	scene.nm[1] = 520;
	scene.nm[2] = 530;
	scene.nm[3] = 580;
	weigh(&scene, SPEC_RULE_GRID, &sums);
	for (size_t c = 0; c < 3; c++) {
		for (size_t i = 0; i < 4; i++) {
			size_t at = (size_t)scene.nm[i] - 360;
			double power, nm = scene.nm[i];

			assert_int_equal(
				spec_curve_sample(&scene.lamp, 0, SPEC_EXTRAPOLATE_REFUSE,
					&nm, 1, &power, NULL),
				SPEC_OK);
			scene.nm[16 + 4 * c + i] =
				widths[i] * power *
				scene.eye.value[c * scene.eye.count + at];
			sum[c] += scene.nm[16 + 4 * c + i];
		}
	}
	for (size_t c = 0; c < 3; c++) {
		for (size_t i = 0; i < 4; i++)
			near(scene.weight[4 * c + i], scene.nm[16 + 4 * c + i] / sum[1],
				1e-14, "weight");
		near(sums.white[c], sum[c] / sum[1], 1e-14, "white");
	}
	near(sums.integral, sum[1], 1e-10, "integral");
	assert_true(sums.outside > .1);
	close_scene(&scene);
}

/* Over the whole table by its step, the two rules differ by the ends, which are nearly 0. */
static void
grid_and_cie_agree_by_1_nm(void **state)
{
	static const char *const lamps[] = {NULL, "A", "FL11"};

	(void)state;
	for (size_t k = 0; k < COUNT(lamps); k++) {
		struct scene scene;
		struct spec_rule_sums cie, grid;
		double wanted[3 * MOST_BANDS];

		open_scene(&scene, "1931", lamps[k]);
		lay_bands(&scene, 360, 830, 1);
		weigh(&scene, SPEC_RULE_CIE, &cie);
		memcpy(wanted, scene.weight, sizeof wanted);
		weigh(&scene, SPEC_RULE_GRID, &grid);
		for (size_t i = 0; i < 3 * scene.bands.count; i++)
			near(scene.weight[i], wanted[i], 3e-6, "weight");
		for (size_t c = 0; c < 3; c++)
			near(grid.white[c], cie.white[c], 6e-6, "white");
		near(grid.integral / cie.integral, 1, 1e-6, "integral");
		near(grid.outside, cie.outside, 0, "outside");
		close_scene(&scene);
	}
}

/* Light is divided by the observer's whole table: bins, values per band, and points alike. */
static void
grid_weighs_light(void **state)
{
	struct scene scene;
	struct spec_rule_sums sums;
	double edges[] = {540, 550, 570, 600}, y[3];

	(void)state;
	open_scene(&scene, "1931", NULL);
	scene.bands.count = 3;
	scene.bands.edges_nm = edges;
	for (size_t i = 0; i < 3; i++) {
		double nm = .5 * (edges[i] + edges[i + 1]);

		assert_int_equal(spec_curve_sample(&scene.eye, 1, SPEC_EXTRAPOLATE_REFUSE,
					 &nm, 1, &y[i], NULL),
			SPEC_OK);
	}
	weigh(&scene, SPEC_RULE_GRID, &sums);
	/* The sum of y: CIE 15:2018, 106.8569 by 1 nm. */
	near(sums.integral, 106.8569, 5e-5, "integral");
	for (size_t i = 0; i < 3; i++)
		near(scene.weight[3 + i], (edges[i + 1] - edges[i]) * y[i] / sums.integral,
			1e-15, "bin");
	near(sums.white[0], 1, 1e-4, "equal energy");
	scene.bands.per_band = 1;
	weigh(&scene, SPEC_RULE_GRID, &sums);
	for (size_t i = 0; i < 3; i++)
		near(scene.weight[3 + i], y[i] / sums.integral, 1e-15, "per band");
	scene.bands.edges_nm = NULL;
	scene.bands.count = 1;
	scene.nm[0] = 555;
	weigh(&scene, SPEC_RULE_GRID, &sums);
	near(scene.weight[1], 1 / sums.integral, 1e-15, "a line");
	close_scene(&scene);
}

/* CIELAB of a reflectance, sampled at the scene's bands. */
static void
see(struct scene *scene, enum spec_rule rule, const struct spec_curve *patch, double lab[3])
{
	struct spec_rule_sums sums;
	double value[MOST_BANDS], xyz[3];

	assert_int_equal(spec_curve_sample(patch, 0, SPEC_EXTRAPOLATE_REFUSE, scene->nm,
				 scene->bands.count, value, NULL),
		SPEC_OK);
	weigh(scene, rule, &sums);
	for (size_t c = 0; c < 3; c++)
		xyz[c] = seen(scene, c, value);
	spec_lab_from_xyz(xyz, sums.white, lab);
}

/*
 * The mean difference of a ColorChecker's patches, sampled by 20 nm, to the CIE's sums of their
 * 5 nm: the numbers of spec2rgb(1), as measured; no reference has them.
 */
static void
rules_differ_as_the_page_says(void **state)
{
	static const char *const patches[] = {"01-dark-skin", "02-light-skin",
		"03-blue-sky", "04-foliage", "05-blue-flower", "06-bluish-green",
		"07-orange", "08-purplish-blue", "09-moderate-red", "10-purple",
		"11-yellow-green", "12-orange-yellow", "13-blue", "14-green", "15-red",
		"16-yellow", "17-magenta", "18-cyan", "19-white", "20-neutral-8",
		"21-neutral-6.5", "22-neutral-5", "23-neutral-3.5", "24-black"};
	static const struct {
		const char *light;
		double mean[3]; /* by the rule */
	} cases[] = {{"D65", {.63, .14, .08}}, {"FL11", {.52, 4.5, .26}}};

	const size_t count = COUNT(patches);

	(void)state;
	for (size_t k = 0; k < COUNT(cases); k++) {
		struct scene scene;
		double sum[3] = {0, 0, 0};

		open_scene(&scene, "1931", cases[k].light);
		for (size_t i = 0; i < count; i++) {
			struct spec_curve patch;
			char name[64];
			double lab[3], other[3];

			snprintf(name, sizeof name, "colorchecker/%s", patches[i]);
			assert_int_equal(spec_lookup_curve(name, &patch, NULL), SPEC_OK);
			lay_bands(&scene, 380, 780, 5);
			see(&scene, SPEC_RULE_CIE, &patch, lab);
			lay_bands(&scene, 380, 780, 20);
			for (int rule = SPEC_RULE_CIE; rule <= SPEC_RULE_ASTM; rule++) {
				see(&scene, (enum spec_rule)rule, &patch, other);
				sum[rule] += spec_difference_ab76(lab, other);
			}
			spec_curve_free(&patch);
		}
		for (size_t c = 0; c < 3; c++)
			near(sum[c] / (double)count, cases[k].mean[c],
				c == 1 && k == 1 ? .05 : .0051, cases[k].light);
		close_scene(&scene);
	}
}

static void
what_cie_refuses_all_do(void **state)
{
	struct scene scene;

	(void)state;
	open_scene(&scene, "1931", "D65");
	for (int rule = SPEC_RULE_CIE; rule <= SPEC_RULE_ASTM; rule++) {
		scene.bands.count = 0;
		refuse(&scene, (enum spec_rule)rule, SPEC_EUSAGE, "no bands");
		lay_bands(&scene, 900, 1000, 10);
		refuse(&scene, (enum spec_rule)rule, SPEC_ERANGE, "lie outside");
	}
	close_scene(&scene);
}

static void
rules_have_names(void **state)
{
	struct spec_error error;
	enum spec_rule rule;

	(void)state;
	for (int i = SPEC_RULE_CIE; i <= SPEC_RULE_ASTM; i++) {
		assert_int_equal(
			spec_rule_find(spec_rule_name((enum spec_rule)i), &rule, NULL),
			SPEC_OK);
		assert_int_equal((int)rule, i);
	}
	assert_contains(spec_rule_title(SPEC_RULE_ASTM), "E308");
	assert_int_equal(spec_rule_find("ASTM", &rule, &error), SPEC_EUSAGE);
	assert_contains(error.message, "'ASTM' is no rule of integration");
}

/* ---- luminance ---- */

/*
 * BIPM: Principles governing photometry, 2nd edition, 2019 (Rapport BIPM-2019/05): 683.002 of
 * V, which is 683 as the CIE rounds it, 683.599 of the 10 degree observer, 683.358 and 683.144
 * of the cones', 1700.05 of V'.
 */
static void
observers_have_their_efficacy(void **state)
{
	static const struct {
		const char *name;
		double lumen_per_watt, tolerance;
	} known[] = {{"1931", 683, 0}, {"v-photopic", 683, 0}, {"1964", 683.599, 5e-3},
		{"2015-2", 683.358, 5e-3}, {"2015-10", 683.144, .01},
		{"v-scotopic", 1700.05, .5}, {"cie2006-lms-2", NAN, 0},
		{"stiles-burch-1959", NAN, 0}};

	(void)state;
	for (size_t i = 0; i < COUNT(known); i++) {
		struct spec_curve eye;
		double efficacy;

		assert_int_equal(spec_observer_load(known[i].name, &eye, NULL), SPEC_OK);
		efficacy = spec_rule_efficacy(&eye);
		if (isnan(known[i].lumen_per_watt))
			assert_true(isnan(efficacy));
		else
			near(efficacy, known[i].lumen_per_watt, known[i].tolerance,
				known[i].name);
		spec_curve_free(&eye);
	}
}

int
main(void)
{
	const struct CMUnitTest tests[] = {
		cmocka_unit_test(astm_has_its_tables),
		cmocka_unit_test(astm_is_exact_for_parabolas),
		cmocka_unit_test(astm_reaches_to_the_ends),
		cmocka_unit_test(astm_ignores_bands_outside_its_table),
		cmocka_unit_test(astm_refuses_other_bands),
		cmocka_unit_test(grid_is_the_trapezoid),
		cmocka_unit_test(grid_and_cie_agree_by_1_nm),
		cmocka_unit_test(grid_weighs_light),
		cmocka_unit_test(rules_differ_as_the_page_says),
		cmocka_unit_test(what_cie_refuses_all_do),
		cmocka_unit_test(rules_have_names),
		cmocka_unit_test(observers_have_their_efficacy),
	};

	if (access("spectra/cmf/cie1931.spd", R_OK) == 0)
		setenv("SPECTRA_PATH", "spectra", 1);
	return cmocka_run_group_tests(tests, NULL, NULL);
}
