/* Scene spectra in the bands that are rendered: against tables, Planck and the eye. */
#include <stdio.h>
#include <stdlib.h>

#include "render/bands.h"
#include "scene/parse.h"
#include "spectrum/lookup.h"

#include "check.h"

#define MOST 1024 /* bands */
#define ROUNDED 1e-12

/* --- bands --- */

static struct spec_bands_grid
bands_at(const double *wavelength_nm, size_t count, enum spec_extrapolate extrapolate)
{
	struct spec_bands_grid bands;
	struct spec_error error;
	struct spec_grid grid;

	assert_true(count <= MOST);
	check(spec_grid_new(count, &grid, &error), &error);
	memcpy(grid.wavelength_nm, wavelength_nm, count * sizeof *wavelength_nm);
	check(spec_bands_make(&bands, &grid, extrapolate, &error), &error);
	spec_grid_free(&grid); /* the bands have wavelengths of their own */
	return bands;
}

static struct spec_bands_grid
bands_of(const char *text, enum spec_extrapolate extrapolate)
{
	struct spec_bands_grid bands;
	struct spec_error error;
	struct spec_grid grid;

	check(spec_grid_parse(text, &grid, &error), &error);
	bands = bands_at(grid.wavelength_nm, grid.count, extrapolate);
	spec_grid_free(&grid);
	return bands;
}

static void
expect_edges(struct spec_bands_grid bands, const double *edge, size_t count)
{
	assert_int_equal(bands.count, count);
	for (size_t i = 0; i <= count; i++)
		near(bands.edges_nm[i], edge[i], ROUNDED * edge[i], "an edge");
	spec_bands_free(&bands);
	assert_null(bands.wavelength_nm);
	assert_null(bands.edges_nm);
	assert_int_equal(bands.count, 0);
	spec_bands_free(&bands);
}

/* Half-way between, and as far beyond the ends; a sole band is 1 nm wide. */
static void
test_edges(void **state)
{
	static const double uneven[] = {400, 410, 430, 500}, sole = 550.5;
	struct spec_bands_grid bands;

	(void)state;
	expect_edges(bands_of("400:700:100", SPEC_EXTRAPOLATE_REFUSE),
		(double[]){350, 450, 550, 650, 750}, 4);
	expect_edges(bands_of("380:390:5", SPEC_EXTRAPOLATE_REFUSE),
		(double[]){377.5, 382.5, 387.5, 392.5}, 3);
	expect_edges(bands_of("400:401.5:1.5", SPEC_EXTRAPOLATE_REFUSE),
		(double[]){399.25, 400.75, 402.25}, 2);
	expect_edges(bands_at(uneven, 4, SPEC_EXTRAPOLATE_REFUSE),
		(double[]){395, 405, 420, 465, 535}, 4);
	expect_edges(bands_at(&sole, 1, SPEC_EXTRAPOLATE_REFUSE), (double[]){550, 551}, 1);
	bands = bands_at(uneven, 4, SPEC_EXTRAPOLATE_CONSTANT);
	assert_memory_equal(bands.wavelength_nm, uneven, sizeof uneven);
	assert_int_equal(bands.extrapolate, SPEC_EXTRAPOLATE_CONSTANT);
	spec_bands_free(&bands);
}

/* --- spectra --- */

/*
 * The spectrum of a parameter in a statement of its use, in a scene that lives until the
 * next one is read. Of an index it is the n or the k of a metal.
 */
static struct spec_scene scene;

static int
close_scene(void **state)
{
	(void)state;
	spec_scene_free(&scene);
	return 0;
}

static void
read_scene(const char *before, const char *parameter, const char *after)
{
	struct spec_error error;
	char text[1024];
	int length = snprintf(
		text, sizeof text, "WorldBegin\n %s\n  %s %s", before, parameter, after);

	assert_true(length < (int)sizeof text);
	spec_scene_free(&scene);
	check(spec_scene_parse(&scene, text, strlen(text), "t.pbrt", &error), &error);
}

static const struct spec_scene_spectrum *
light(const char *parameter)
{
	read_scene("LightSource \"infinite\"", parameter, "");
	return &scene.light[0].spectrum;
}

static const struct spec_scene_spectrum *
reflectance(const char *parameter)
{
	read_scene("Material \"diffuse\"", parameter, "");
	return &scene.material[0].reflectance;
}

static const struct spec_scene_spectrum *
eta(const char *parameter)
{
	read_scene("Material \"conductor\"", parameter, "\"float k\" 0");
	return &scene.material[0].eta;
}

static const struct spec_scene_spectrum *
k(const char *parameter)
{
	read_scene("Material \"conductor\" \"float eta\" 1", parameter, "");
	return &scene.material[0].k;
}

/* What a spectrum is in the bands, which are then freed. */
static const double *
sample_in(struct spec_bands_grid bands, const struct spec_scene_spectrum *spectrum,
	enum spec_bands_use use)
{
	static double value[MOST + 1];
	struct spec_error error;

	value[bands.count] = -77; /* not to be written */
	check(spec_bands_sample(&bands, &scene, spectrum, use, value, &error), &error);
	assert_true(value[bands.count] == -77);
	spec_bands_free(&bands);
	return value;
}

static const double *
sample(const char *grid, const struct spec_scene_spectrum *spectrum,
	enum spec_bands_use use)
{
	return sample_in(bands_of(grid, SPEC_EXTRAPOLATE_REFUSE), spectrum, use);
}

static void
expect_values(const double *value, const double *wanted, size_t count, double bound,
	const char *what)
{
	for (size_t i = 0; i < count; i++) {
		char which[160];

		snprintf(which, sizeof which, "%s, band %zu", what, i);
		near(value[i], wanted[i], bound, which);
	}
}

/* --- the same at all wavelengths --- */

static void
test_constants(void **state)
{
	static const char grid[] = "1:950001:50000"; /* no data, and so no ends */

	(void)state;
	for (int i = 0; i < 20; i++) {
		assert_true(sample(grid, light("\"float L\" 1234.5"),
				    SPEC_BANDS_LIGHT)[i] == 1234.5);
		assert_true(sample(grid, reflectance("\"float reflectance\" .3"),
				    SPEC_BANDS_RATIO)[i] == .3);
		assert_true(
			sample(grid, eta("\"float eta\" 1.5"), SPEC_BANDS_INDEX)[i] == 1.5);
	}
}

/* --- pairs of a wavelength and a value --- */

/*
 * v = 1 at 400 nm, 4 at 700 nm, and a line between: v(l) = 1 + (l - 400) / 100, in bins
 * from 350 to 450, 550, 650 and 750. Within the data the mean is the value at the middle: 2
 * and 3. The first bin has data in its half 400..450, of mean 1.25, and the last in
 * 650..700, 3.75.
 */
static void
test_pairs(void **state)
{
	static const char grid[] = "400:700:100";

	(void)state;
	/* Dark beyond: half of 1.25, half of 3.75. */
	expect_values(sample(grid, light("\"spectrum L\" [400 1 700 4]"), SPEC_BANDS_LIGHT),
		(double[]){.625, 2, 3, 1.875}, 4, ROUNDED, "light");
	/* A tenth of it; beyond, as at the ends: (1 + 1.25) / 2 and (3.75 + 4) / 2. */
	expect_values(sample(grid, reflectance("\"spectrum reflectance\" [400 .1 700 .4]"),
			      SPEC_BANDS_RATIO),
		(double[]){.1125, .2, .3, .3875}, 4, ROUNDED, "reflectance");
	/* At the middles. */
	expect_values(sample(grid, eta("\"spectrum eta\" [400 1 700 4]"), SPEC_BANDS_INDEX),
		(double[]){1, 2, 3, 4}, 4, ROUNDED, "n");
	expect_values(sample(grid, k("\"spectrum k\" [400 1 700 4]"), SPEC_BANDS_INDEX),
		(double[]){1, 2, 3, 4}, 4, ROUNDED, "k");
}

/*
 * A peak of 1 at 500 nm that is 40 nm wide at its foot has an area of 20 nm: a fifth in the
 * mean over a bin of 100 nm that has all of it, wherever, and 1 at its middle.
 */
static void
test_peaks(void **state)
{
	static const char peak[] = "[300 0 480 0 500 1 520 0 800 0]";
	char text[80];

	(void)state;
	snprintf(text, sizeof text, "\"spectrum L\" %s", peak);
	expect_values(sample("400:700:100", light(text), SPEC_BANDS_LIGHT),
		(double[]){0, .2, 0, 0}, 4, ROUNDED, "light");
	/* Of bins from 450 to 500 and 550, each has one side. */
	expect_values(sample("425:575:50", light(text), SPEC_BANDS_LIGHT),
		(double[]){0, .2, .2, 0}, 4, ROUNDED, "light, halved");
	/* Half a nm around 500: 1 - .25 / 20. */
	expect_values(sample("500:500:1", light(text), SPEC_BANDS_LIGHT), (double[]){.9875},
		1, ROUNDED, "light, a sole band");
	snprintf(text, sizeof text, "\"spectrum reflectance\" %s", peak);
	expect_values(sample("400:700:100", reflectance(text), SPEC_BANDS_RATIO),
		(double[]){0, .2, 0, 0}, 4, ROUNDED, "reflectance");
	snprintf(text, sizeof text, "\"spectrum k\" %s", peak);
	expect_values(sample("400:700:100", k(text), SPEC_BANDS_INDEX),
		(double[]){0, 1, 0, 0}, 4, ROUNDED, "k");
}

/*
 * Light ends with its data, whatever the rule of the bands; the rest goes on only if told.
 */
static void
test_beyond(void **state)
{
	static const enum spec_extrapolate rules[] = {
		SPEC_EXTRAPOLATE_REFUSE, SPEC_EXTRAPOLATE_CONSTANT};

	(void)state;
	for (size_t i = 0; i < COUNT(rules); i++)
		expect_values(
			sample_in(bands_of("200:1000:100", rules[i]),
				light("\"spectrum L\" [450 2 640 2]"), SPEC_BANDS_LIGHT),
			/* 550..650 has 90 nm of light. */
			(double[]){0, 0, 0, 2, 1.8, 0, 0, 0, 0}, 9, ROUNDED, "light");
	expect_values(sample_in(bands_of("200:1000:100", SPEC_EXTRAPOLATE_CONSTANT),
			      reflectance("\"spectrum reflectance\" [450 .2 650 .4]"),
			      SPEC_BANDS_RATIO),
		(double[]){.2, .2, .2, .25, .35, .4, .4, .4, .4}, 9, ROUNDED,
		"reflectance");
	expect_values(sample_in(bands_of("200:1000:100", SPEC_EXTRAPOLATE_CONSTANT),
			      eta("\"spectrum eta\" [450 1.2 650 1.4]"), SPEC_BANDS_INDEX),
		(double[]){1.2, 1.2, 1.2, 1.25, 1.35, 1.4, 1.4, 1.4, 1.4}, 9, ROUNDED, "n");
}

static void
expect_refusal(const char *grid, const struct spec_scene_spectrum *spectrum,
	enum spec_bands_use use, const char *begins, const char *names)
{
	struct spec_bands_grid bands = bands_of(grid, SPEC_EXTRAPOLATE_REFUSE);
	struct spec_error error = {0};
	double value[MOST];

	assert_int_equal(spec_bands_sample(&bands, &scene, spectrum, use, value, &error),
		SPEC_ERANGE);
	assert_int_equal(error.status, SPEC_ERANGE);
	if (strncmp(error.message, begins, strlen(begins)) != 0 ||
		!strstr(error.message, names))
		fail_msg("'%s' instead of '%s ... %s'", error.message, begins, names);
	assert_int_equal(
		spec_bands_sample(&bands, &scene, spectrum, use, value, NULL), SPEC_ERANGE);
	spec_bands_free(&bands);
}

/* The file, line and column are those of the parameter, in line 3. */
static void
test_refusals(void **state)
{
	(void)state;
	expect_refusal("400:700:100",
		reflectance("\"spectrum reflectance\" [410 .1 800 .4]"), SPEC_BANDS_RATIO,
		"t.pbrt:3:3: ", "400 nm");
	expect_refusal("400:700:100",
		reflectance("\"spectrum reflectance\" [300 .1 690 .4]"), SPEC_BANDS_RATIO,
		"t.pbrt:3:3: ", "700 nm");
	expect_refusal("400:700:100", eta("\"spectrum eta\" [410 1 800 2]"),
		SPEC_BANDS_INDEX, "t.pbrt:3:3: ", "400 nm");
	expect_refusal("400:700:100", k("\"spectrum k\" [300 1 690 2]"), SPEC_BANDS_INDEX,
		"t.pbrt:3:3: ", "700 nm");
}

/* --- names --- */

/*
 * Rows of CIE S 014-2: 102.023 at 555 nm, 100 at 560 nm, 98.1671 at 565 nm. A bin of 5 nm
 * about a row has, of lines to its neighbours, the mean (before + 6 row + after) / 8.
 */
static void
test_named_light(void **state)
{
	static const char *const names[] = {
		"\"D65\"", "\"illuminants/D65\"", "\"stdillum-D65\""};

	(void)state;
	for (size_t i = 0; i < COUNT(names); i++) {
		char text[80];
		const double *value;

		snprintf(text, sizeof text, "\"spectrum L\" %s", names[i]);
		value = sample("555:565:5", light(text), SPEC_BANDS_LIGHT);
		near(value[1], (102.023 + 6 * 100 + 98.1671) / 8, 1e-9, names[i]);
		/* Absolute, and dark beyond 300 and 830 nm, but for half of the last bin. */
		value = sample("280:850:10", light(text), SPEC_BANDS_LIGHT);
		assert_true(value[0] == 0 && value[1] == 0 && value[57] == 0);
		assert_true(value[56] == 0 && value[55] > 25 && value[55] < 35);
	}
}

/* 15-red has .672 at 645 nm, .686 at 650 nm and .694 at 655 nm; as above. */
static void
test_named_reflectance(void **state)
{
	const double *value = sample("645:655:5",
		reflectance("\"spectrum reflectance\" \"15-red\""), SPEC_BANDS_RATIO);

	(void)state;
	near(value[1], (.672 + 6 * .686 + .694) / 8, 1e-12, "15-red");
	expect_refusal("375:780:5", reflectance("\"spectrum reflectance\" \"15-red\""),
		SPEC_BANDS_RATIO, "t.pbrt:3:3: ", "375 nm");
}

/*
 * Johnson and Christy's gold: n = .62, k = 2.081 at 520.9 nm, .43 and 2.455 at 548.6 nm,
 * .29 and 2.863 at 582.1 nm. Half-way between the latter, at 565.35 nm, .36 and 2.659.
 * SCHOTT's n of N-BK7 at the helium line of 587.5618 nm is 1.51680.
 */
static void
test_named_indices(void **state)
{
	static const double gold_nm[] = {520.9, 548.6, 565.35, 582.1}, helium_nm = 587.5618;
	static const double n[] = {.62, .43, .36, .29},
			    kappa[] = {2.081, 2.455, 2.659, 2.863};

	(void)state;
	expect_values(sample_in(bands_at(gold_nm, 4, SPEC_EXTRAPOLATE_REFUSE),
			      eta("\"spectrum eta\" \"metal-Au-eta\""), SPEC_BANDS_INDEX),
		n, 4, 1e-9, "n of gold");
	expect_values(sample_in(bands_at(gold_nm, 4, SPEC_EXTRAPOLATE_REFUSE),
			      k("\"spectrum k\" \"metal-Au-k\""), SPEC_BANDS_INDEX),
		kappa, 4, 1e-9, "k of gold");
	/* One curve has both: what it is wanted for says which column. */
	expect_values(sample_in(bands_at(gold_nm, 4, SPEC_EXTRAPOLATE_REFUSE),
			      k("\"spectrum k\" \"Au\""), SPEC_BANDS_INDEX),
		kappa, 4, 1e-9, "k of gold");
	expect_values(sample_in(bands_at(&helium_nm, 1, SPEC_EXTRAPOLATE_REFUSE),
			      eta("\"spectrum eta\" \"N-BK7\""), SPEC_BANDS_INDEX),
		(double[]){1.5168}, 1, 2e-6, "n of N-BK7");
}

/* --- black bodies --- */

#define C2_NM_K 14387768.775 /* h c / k: the second radiation constant, CODATA 2018 */

/*
 * x^5 / (e^x - 1) with x = c2 / (l T) is greatest where x = 5 (1 - e^-x), at 4.9651142317.
 */
static double
planck(double temperature_k, double nm)
{
	double x = C2_NM_K / (nm * temperature_k), peak = 4.965114231744276;

	return pow(x / peak, 5) * expm1(peak) / expm1(x);
}

/* Simpson's rule. */
static double
planck_mean(double temperature_k, double from_nm, double to_nm)
{
	enum { PIECES = 400 };
	double sum = 0;

	for (int i = 0; i <= PIECES; i++) {
		int weight = i == 0 || i == PIECES ? 1 : i % 2 ? 4 : 2;

		sum += weight *
		       planck(temperature_k, from_nm + (to_nm - from_nm) * i / PIECES);
	}
	return sum / 3 / PIECES;
}

/* A value of a sole band, which is 1 nm wide, at a wavelength. */
static double
blackbody_at(double temperature_k, double nm)
{
	char text[80];

	snprintf(text, sizeof text, "\"blackbody L\" %.17g", temperature_k);
	return sample_in(bands_at(&nm, 1, SPEC_EXTRAPOLATE_REFUSE), light(text),
		SPEC_BANDS_LIGHT)[0];
}

/*
 * pbrt divides a black body by its value where it is greatest, after Wien at 2897772 nm /
 * T: at 579.554 nm of 5000 K, 289.777 nm of 10000 K.
 */
static void
test_blackbody_peak(void **state)
{
	(void)state;
	near(blackbody_at(5000, 579.5544), 1, 1e-5, "5000 K");
	near(blackbody_at(10000, 289.7772), 1, 1e-5, "10000 K");
	near(blackbody_at(300, 9659.24), 1, 1e-5, "300 K");
	/* By hand: it falls by 1 % over 5 % of the wavelength or so, on both sides. */
	for (int i = -1; i <= 1; i += 2) {
		double value = blackbody_at(5000, 579.5544 * (1 + .05 * i));

		assert_true(value < .995 && value > .98);
	}
}

/*
 * At 5000 K and 500 nm x = 5.7551075, e^x = 315.80, at 1000 nm half and its root, 17.7708:
 * the ratio is 2^5 (17.7708 - 1) / (315.80 - 1) = 1.7048. In the far infrared, where x is
 * small, radiance goes with the fourth power: 16 times less at twice the wavelength.
 */
static void
test_blackbody_ratio(void **state)
{
	(void)state;
	near(blackbody_at(5000, 500) / blackbody_at(5000, 1000), 1.7048, 1e-4,
		"500 to 1000 nm");
	/* x = .144 and .072: 16 (1 - .072 / 2 + ...). */
	near(blackbody_at(1e6, 100) / blackbody_at(1e6, 200),
		32 * expm1(.071938843875) / expm1(.14387768775), 1e-3, "100 to 200 nm");
}

static void
test_blackbody_means(void **state)
{
	static const double temperature_k[] = {1500, 2856, 5000, 6504, 12000, 40000};
	static const struct {
		const char *text;
		double first_nm, width_nm, bound;
		size_t count;
	} grids[] = {
		{"380:780:5", 377.5, 5, 1e-10, 81},
		{"400:700:20", 390, 20, 1e-10, 16},
		{"400:700:100", 350, 100, 1e-6, 4},
		{"1000:2000:50", 975, 50, 1e-10, 21},
	};

	(void)state;
	for (size_t i = 0; i < COUNT(temperature_k); i++) {
		for (size_t j = 0; j < COUNT(grids); j++) {
			const double *value;
			char text[80];

			snprintf(text, sizeof text, "\"blackbody L\" %g", temperature_k[i]);
			value = sample(grids[j].text, light(text), SPEC_BANDS_LIGHT);
			for (size_t b = 0; b < grids[j].count; b++) {
				double from_nm =
					grids[j].first_nm + (double)b * grids[j].width_nm;
				double wanted = planck_mean(temperature_k[i], from_nm,
					from_nm + grids[j].width_nm);

				near(value[b], wanted, grids[j].bound * wanted,
					grids[j].text);
				assert_true(value[b] > 0 && value[b] <= 1);
			}
		}
	}
}

/*
 * The first of bins of 200 nm about 20 nm goes from -80 to 120 nm: below 0 nothing shines.
 * So the mean is 3/5 of that from 0 to 120 nm.
 */
static void
test_blackbody_below_nothing(void **state)
{
	static const double temperature_k[] = {300, 5000, 20000, 60000};

	(void)state;
	for (size_t i = 0; i < COUNT(temperature_k); i++) {
		char text[80];
		double wanted = .6 * planck_mean(temperature_k[i], 1e-3, 120);

		snprintf(text, sizeof text, "\"blackbody L\" %g", temperature_k[i]);
		near(sample("20:620:200", light(text), SPEC_BANDS_LIGHT)[0], wanted, 1e-3,
			text);
	}
}

/* --- colours --- */

/* The eye and daylight, of 1 nm steps: what colours are to be seen by and under. */
#define STEPS 471 /* 360..830 nm */
#define EYE "360:830:1"

static struct {
	double xyz[3][STEPS], d65[STEPS];
	double sum_y, sum_y_d65;
} eye;

/* Rows of the table of 5 nm, and lines between. */
static double
line_at(const struct spec_curve *curve, double nm)
{
	size_t i = 1;

	while (curve->wavelength_nm[i] < nm)
		i++;
	return curve->value[i - 1] +
	       (curve->value[i] - curve->value[i - 1]) *
		       (nm - curve->wavelength_nm[i - 1]) /
		       (curve->wavelength_nm[i] - curve->wavelength_nm[i - 1]);
}

static int
open_eye(void **state)
{
	struct spec_curve observer, d65;
	struct spec_error error;

	(void)state;
	check(spec_lookup_curve("cmf/cie1931", &observer, &error), &error);
	check(spec_lookup_curve("illuminants/D65", &d65, &error), &error);
	assert_int_equal(observer.count, STEPS);
	assert_true(observer.wavelength_nm[0] == 360);
	for (size_t i = 0; i < STEPS; i++) {
		for (size_t c = 0; c < 3; c++)
			eye.xyz[c][i] = observer.value[c * STEPS + i];
		eye.d65[i] = line_at(&d65, 360 + (double)i);
		eye.sum_y += eye.xyz[1][i];
		eye.sum_y_d65 += eye.xyz[1][i] * eye.d65[i];
	}
	spec_curve_free(&observer);
	spec_curve_free(&d65);
	/* As Mitsuba has them, the latter by Simpson's rule from rows of 5 nm. */
	near(eye.sum_y, 106.8569, 1e-4, "the integral of y");
	near(eye.sum_y_d65, 10566.864, .5, "that of y under D65");
	return 0;
}

/* Linear sRGB of light in the eye's bands: IEC 61966-2-1, amendment 1. */
static void
see(const double *value, double scale, double rgb[3])
{
	static const double from_xyz[3][3] = {{3.2406255, -1.5372080, -.4986286},
		{-.9689307, 1.8757561, .0415175}, {.0557101, -.2040211, 1.0569959}};
	double xyz[3] = {0};

	for (size_t c = 0; c < 3; c++)
		for (size_t i = 0; i < STEPS; i++)
			xyz[c] += eye.xyz[c][i] * value[i] * scale;
	for (size_t c = 0; c < 3; c++)
		rgb[c] = from_xyz[c][0] * xyz[0] + from_xyz[c][1] * xyz[1] +
			 from_xyz[c][2] * xyz[2];
}

static const double colours[][3] = {{1, 1, 1}, {.5, .5, .5}, {.01, .01, .01}, {.8, .4, .1},
	{.1, .4, .8}, {.2, .7, .3}, {.9, .9, .1}, {.05, .02, .3}, {.6, .1, .6}, {1, .5, .5},
	{.3, 1, .9}};

/* A parameter of a colour. */
static const char *
rgb_text(const char *name, const double rgb[3], double factor)
{
	static char text[160];

	snprintf(text, sizeof text, "\"rgb %s\" [%.17g %.17g %.17g]", name, rgb[0] * factor,
		rgb[1] * factor, rgb[2] * factor);
	return text;
}

/*
 * Colours go round to .00025: D65 has not quite sRGB's white of .3127, .3290. Of 0 to 1
 * all is in 0 to 1. A sigmoid of a parabola rises and falls but once.
 */
static void
test_rgb_reflectance(void **state)
{
	(void)state;
	for (size_t i = 0; i < COUNT(colours); i++) {
		const double *value =
			sample(EYE, reflectance(rgb_text("reflectance", colours[i], 1)),
				SPEC_BANDS_RATIO);
		double seen[3], lit[STEPS];
		int turns = 0;

		for (size_t b = 0; b < STEPS; b++) {
			assert_true(value[b] >= 0 && value[b] <= 1);
			turns += b > 1 &&
				 (value[b] - value[b - 1]) * (value[b - 1] - value[b - 2]) <
					 -1e-24;
			lit[b] = value[b] * eye.d65[b];
		}
		assert_true(turns <= 1);
		see(lit, 1 / eye.sum_y_d65, seen);
		expect_values(seen, colours[i], 3, 2.5e-4, "a reflectance's colour");
	}
}

/* White, black and greys are the same everywhere, far outside what the eye sees, too. */
static void
test_rgb_greys(void **state)
{
	static const double greys[] = {0, 1e-6, .18, .5, .99, 1};

	(void)state;
	for (size_t i = 0; i < COUNT(greys); i++) {
		const double one[3] = {1, 1, 1};
		const double *value = sample("100:2000:100",
			reflectance(rgb_text("reflectance", one, greys[i])),
			SPEC_BANDS_RATIO);

		for (int b = 0; b < 20; b++)
			near(value[b], greys[i], greys[i] * ROUNDED, "a grey");
	}
}

/*
 * White light is D65, of a luminance of 1, which is that of a radiance of 1 everywhere:
 * times the sum of y over that of y and D65. In the bin of 1 nm about 560 nm, with 102.023
 * and 98.1671 5 nm off, D65 has the mean 100 + (2.023 - 1.8329) / 40.
 */
static void
test_rgb_light_is_daylight(void **state)
{
	const double one[3] = {1, 1, 1};
	const double *value, scale = eye.sum_y / eye.sum_y_d65;

	(void)state;
	value = sample("560:560:1", light(rgb_text("L", one, 1)), SPEC_BANDS_LIGHT);
	near(value[0], scale * 100.0047525, 1e-7, "white at 560 nm");
	value = sample("560:560:1", light(rgb_text("L", one, 70)), SPEC_BANDS_LIGHT);
	near(value[0], 70 * scale * 100.0047525, 1e-5, "brighter");
	/* As everywhere: between rows of 5 nm, where D65 is straight. */
	value = sample(EYE, light(rgb_text("L", one, 1)), SPEC_BANDS_LIGHT);
	for (int i = 0; i < STEPS; i++)
		if (i % 5)
			near(value[i], scale * eye.d65[i], 1e-6, "white");
	/* D65 ends at 300 and 830 nm. */
	value = sample("200:1000:100", light(rgb_text("L", one, 1)), SPEC_BANDS_LIGHT);
	assert_true(value[0] == 0 && value[7] == 0 && value[8] == 0);
	assert_true(value[1] > 0 && value[6] > 0);
}

/* Lights are seen as the colours that they were given as, of any brightness. */
static void
test_rgb_light_colours(void **state)
{
	static const double factors[] = {.001, 1, 300};

	(void)state;
	for (size_t i = 0; i < COUNT(colours); i++) {
		for (size_t j = 0; j < COUNT(factors); j++) {
			const double *value =
				sample(EYE, light(rgb_text("L", colours[i], factors[j])),
					SPEC_BANDS_LIGHT);
			double seen[3];

			see(value, 1 / eye.sum_y / factors[j], seen);
			expect_values(seen, colours[i], 3, 2.5e-4, "a light's colour");
		}
	}
}

/*
 * pbrt's RGBIlluminantSpectrum: with m the greatest of r, g and b, it is 2 m times the
 * reflectance of rgb / 2 m times the illuminant; RGBUnboundedSpectrum, which indices are,
 * is the same without the illuminant. Bins of 1 nm have the product of the means, but for
 * the last one, where D65 ends.
 */
static void
test_rgb_rule(void **state)
{
	static const double bright[][3] = {
		{1, 1, 1}, {.8, .4, .1}, {.1, .2, .9}, {3, 1.5, .5}, {20, 30, 10}};

	(void)state;
	for (size_t i = 0; i < COUNT(bright); i++) {
		double twice = 2 * fmax(bright[i][0], fmax(bright[i][1], bright[i][2]));
		double part[STEPS], white[STEPS];
		const double one[3] = {1, 1, 1}, *value;

		value = sample(EYE,
			reflectance(rgb_text("reflectance", bright[i], 1 / twice)),
			SPEC_BANDS_RATIO);
		memcpy(part, value, sizeof part);
		value = sample(EYE, light(rgb_text("L", one, 1)), SPEC_BANDS_LIGHT);
		memcpy(white, value, sizeof white);
		value = sample(EYE, light(rgb_text("L", bright[i], 1)), SPEC_BANDS_LIGHT);
		for (int b = 0; b < STEPS - 1; b++)
			near(value[b], twice * part[b] * white[b], 2e-5 * twice, "a light");
		value = sample(EYE, k(rgb_text("k", bright[i], 1)), SPEC_BANDS_INDEX);
		for (int b = 0; b < STEPS; b++)
			near(value[b], twice * part[b], 2e-5 * twice, "an index");
	}
}

/* An index is that of the band's middle, not a mean; a sole band of 1 nm is nearly so. */
static void
test_rgb_index_is_at_the_middle(void **state)
{
	static const double rgb[3] = {.1, 2, 1};
	double wide[4];

	(void)state;
	memcpy(wide, sample("400:700:100", eta(rgb_text("eta", rgb, 1)), SPEC_BANDS_INDEX),
		sizeof wide);
	for (int b = 0; b < 4; b++) {
		double nm = 400 + 100 * b;
		const double *value = sample_in(bands_at(&nm, 1, SPEC_EXTRAPOLATE_REFUSE),
			eta(rgb_text("eta", rgb, 1)), SPEC_BANDS_INDEX);

		near(wide[b], value[0], 1e-4, "an index");
	}
}

static void
test_rgb_black(void **state)
{
	static const double black[3] = {0, 0, 0};
	const double *value;

	(void)state;
	value = sample("400:700:10", light(rgb_text("L", black, 1)), SPEC_BANDS_LIGHT);
	for (int b = 0; b < 31; b++)
		assert_true(value[b] == 0);
	value = sample("400:700:10", k(rgb_text("k", black, 1)), SPEC_BANDS_INDEX);
	for (int b = 0; b < 31; b++)
		assert_true(value[b] == 0);
}

/*
 * The parser lets no such colours through; they have the place of their parameter even so.
 */
static void
test_rgb_refusals(void **state)
{
	static const double grey[3] = {.5, .5, .5};
	struct spec_scene_spectrum spectrum;

	(void)state;
	spectrum = *reflectance(rgb_text("reflectance", grey, 1));
	spectrum.rgb[1] = 1.25;
	expect_refusal(
		"400:700:100", &spectrum, SPEC_BANDS_RATIO, "t.pbrt:3:3: ", "green 1.25");
	spectrum.rgb[1] = -.25;
	expect_refusal(
		"400:700:100", &spectrum, SPEC_BANDS_LIGHT, "t.pbrt:3:3: ", "green -0.25");
}

int
main(void)
{
	const struct CMUnitTest tests[] = {
		cmocka_unit_test(test_edges),
		cmocka_unit_test(test_constants),
		cmocka_unit_test(test_pairs),
		cmocka_unit_test(test_peaks),
		cmocka_unit_test(test_beyond),
		cmocka_unit_test(test_refusals),
		cmocka_unit_test(test_named_light),
		cmocka_unit_test(test_named_reflectance),
		cmocka_unit_test(test_named_indices),
		cmocka_unit_test(test_blackbody_peak),
		cmocka_unit_test(test_blackbody_ratio),
		cmocka_unit_test(test_blackbody_means),
		cmocka_unit_test(test_blackbody_below_nothing),
		cmocka_unit_test(test_rgb_reflectance),
		cmocka_unit_test(test_rgb_greys),
		cmocka_unit_test(test_rgb_light_is_daylight),
		cmocka_unit_test(test_rgb_light_colours),
		cmocka_unit_test(test_rgb_rule),
		cmocka_unit_test(test_rgb_index_is_at_the_middle),
		cmocka_unit_test(test_rgb_black),
		cmocka_unit_test(test_rgb_refusals),
	};

	return cmocka_run_group_tests_name("bands", tests, open_eye, close_scene);
}
