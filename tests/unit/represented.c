/* lib/scene/represented, and lib/render/bands on it: a thesis' types of spectra in scenes. */
#include <stdio.h>
#include <stdlib.h>

#include "render/bands.h"
#include "scene/parse.h"
#include "spectrum/lookup.h"
#include "spectrum/mean.h"

#include "check.h"

#define LIGHT "WorldBegin LightSource \"infinite\" "
#define PAINT "WorldBegin Material \"diffuse\" "
#define GLASS "WorldBegin Material \"dielectric\" "

static struct spec_scene
parse(const char *text)
{
	struct spec_scene scene;
	struct spec_error error;

	if (spec_scene_parse(&scene, text, strlen(text), "t.pbrt", &error) != SPEC_OK)
		fail_msg("%s\n%s", text, error.message);
	return scene;
}

/* The bands LO:HI:STEP of a spectrum, into value; its energy. */
static double
energy_in_bands(const struct spec_scene *scene, const struct spec_scene_spectrum *spectrum,
	const char *grid_text, enum spec_bands_use use)
{
	static double value[2000];
	struct spec_grid grid;
	struct spec_bands_grid bands;
	struct spec_error error;
	double sum = 0;

	assert_int_equal(spec_grid_parse(grid_text, &grid, NULL), SPEC_OK);
	assert_int_equal(
		spec_bands_make(&bands, &grid, SPEC_EXTRAPOLATE_REFUSE, NULL), SPEC_OK);
	if (spec_bands_sample(&bands, scene, spectrum, use, value, &error) != SPEC_OK)
		fail_msg("%s", error.message);
	for (size_t i = 0; i < bands.count; i++)
		sum += value[i] * (bands.edges_nm[i + 1] - bands.edges_nm[i]);
	spec_bands_free(&bands);
	spec_grid_free(&grid);
	return sum;
}

static void
samples_and_tables_are_curves(void **state)
{
	struct spec_scene scene = parse(
		LIGHT "\"samplespectrum L\" [400 700 1 2 4 7] LightSource \"infinite\" "
		      "\"tabulatedspectrum L\" [400 1 450 2 700 3]");
	const struct spec_scene_spectrum *first = &scene.light[0].spectrum,
					 *second = &scene.light[1].spectrum;

	(void)state;
	assert_int_equal(first->kind, SPEC_SCENE_CURVE);
	assert_int_equal(first->curve.count, 4);
	assert_true(first->curve.wavelength_nm[1] == 500 && first->curve.value[2] == 4);
	assert_true(first->curve.wavelength_nm[3] == 700);
	assert_string_equal(first->curve.title, "L");
	assert_int_equal(second->kind, SPEC_SCENE_CURVE);
	assert_true(second->curve.count == 3 && second->curve.wavelength_nm[1] == 450);
	/* T: 0 outside. */
	near(energy_in_bands(&scene, first, "300:800:10", SPEC_BANDS_LIGHT),
		100 * (.5 + 2 + 4 + 3.5), 1e-9, "samples");
	spec_scene_free(&scene);
}

/* a0 / 2 times the range. */
static void
series_are_kept(void **state)
{
	struct spec_scene scene =
		parse(LIGHT "\"fourierspectrum L\" [400 700 2 .5 -.25 .125 0]");
	const struct spec_scene_spectrum *spectrum = &scene.light[0].spectrum;

	(void)state;
	assert_int_equal(spectrum->kind, SPEC_SCENE_SPECTRUM);
	assert_int_equal(spectrum->spectrum.smooth, SPEC_SPECTRUM_FOURIER);
	assert_int_equal(spectrum->spectrum.count, 5);
	assert_true(spectrum->spectrum.value[2] == -.25);
	near(energy_in_bands(&scene, spectrum, "390:710:20", SPEC_BANDS_LIGHT), 300, 1e-9,
		"energy");
	assert_int_equal(scene.warnings, 0);
	spec_scene_free(&scene);
}

/* The energy of the lines is in the bands, whatever those are. */
static void
lines_reach_every_grid(void **state)
{
	static const char *const grids[] = {
		"380:780:5", "380:780:20", "404:580:4", "390:710:1", "300:900:50"};
	static const char *const texts[] = {LIGHT
		"\"compositespectrumsampled L\" [3 400 700 0 0 0 404.66 3 435.83 5 "
		"546.07 7 577 11]",
		LIGHT "\"compositespectrumfourier L\" [1 400 700 0 404.66 3 435.83 5 "
		      "546.07 7 577 11]"};

	(void)state;
	for (size_t i = 0; i < COUNT(texts); i++) {
		struct spec_scene scene = parse(texts[i]);

		assert_int_equal(scene.light[0].spectrum.kind, SPEC_SCENE_SPECTRUM);
		assert_int_equal(scene.light[0].spectrum.spectrum.lines, 4);
		for (size_t k = 0; k < COUNT(grids); k++)
			near(energy_in_bands(&scene, &scene.light[0].spectrum, grids[k],
				     SPEC_BANDS_LIGHT),
				26, 1e-11, grids[k]);
		spec_scene_free(&scene);
	}
}

static void
composites_have_both_parts(void **state)
{
	struct spec_scene scene =
		parse(LIGHT "\"compositespectrumsampled L\" [4 400 700 1 2 4 7 546.1 30] "
			    "LightSource \"infinite\" \"compositespectrumfourier L\" "
			    "[3 400 700 2 .5 -.25 600 5 500 4]");

	(void)state;
	near(energy_in_bands(
		     &scene, &scene.light[0].spectrum, "390:710:10", SPEC_BANDS_LIGHT),
		1000 + 30, 1e-9, "samples");
	near(energy_in_bands(
		     &scene, &scene.light[1].spectrum, "390:710:10", SPEC_BANDS_LIGHT),
		300 + 9, 1e-9, "series");
	assert_true(scene.light[1].spectrum.spectrum.line[0].wavelength_nm == 500);
	spec_scene_free(&scene);
}

/* Without lines they are like their smooth parts, also where there must be none. */
static void
reflectances_may_be_composites_without_lines(void **state)
{
	struct spec_scene scene = parse(PAINT
		"\"compositespectrumsampled reflectance\" [3 300 800 .2 .4 .6] "
		"Material \"diffuse\" \"fourierspectrum reflectance\" [300 800 1 .3 0]");

	(void)state;
	near(energy_in_bands(&scene, &scene.material[0].reflectance, "400:700:10",
		     SPEC_BANDS_RATIO) /
			310,
		.2 + .4 * 250 / 500, 1e-12, "composite");
	near(energy_in_bands(&scene, &scene.material[1].reflectance, "300:800:10",
		     SPEC_BANDS_RATIO),
		250 + 2 * 5 * .8, 1e-2, "series, its ends drawn out");
	spec_scene_free(&scene);
}

/* ---- colours ---- */

static void
colours_are_those_of_spectra(void **state)
{
	struct spec_scene scene = parse(
		LIGHT "\"rgbspectrum L\" [1 2 .5] LightSource \"infinite\" "
		      "\"rgbfromsampled L\" [360 830 2 2] "
		      "Material \"diffuse\" \"rgbfromsampled reflectance\" [400 700 .5 .5] "
		      "Material \"diffuse\" \"rgbfromtabulated reflectance\" "
		      "[400 .1 560 .1 620 .8 700 .8]");
	const double *given = scene.light[0].spectrum.rgb,
		     *energy = scene.light[1].spectrum.rgb,
		     *grey = scene.material[0].reflectance.rgb,
		     *red = scene.material[1].reflectance.rgb;

	(void)state;
	assert_int_equal(scene.light[0].spectrum.kind, SPEC_SCENE_RGB);
	assert_true(given[0] == 1 && given[1] == 2 && given[2] == .5);
	/*
	 * Equal energy has XYZ = 1, 1, 1 but for 4 digits of the table's sums; by IEC
	 * 61966-2-1's matrix that is 1.2048, .9483, .9088. D65's own white moves it by 1e-3.
	 */
	near(energy[0], 2 * 1.2048, 4e-3, "red of equal energy");
	near(energy[1], 2 * .9483, 4e-3, "green of equal energy");
	near(energy[2], 2 * .9088, 4e-3, "blue of equal energy");
	for (int i = 0; i < 3; i++)
		near(grey[i], .5, 1e-9, "grey");
	assert_true(red[0] > .5 && red[1] < .25 && red[2] < .15);
	assert_int_equal(scene.material[1].reflectance.kind, SPEC_SCENE_RGB);
	assert_int_equal(scene.material[1].reflectance.curve.count, 0);
	spec_scene_free(&scene);
}

/* D65, as a table, is white; and that colour as a light is D65 again. */
static void
daylight_is_white(void **state)
{
	struct spec_curve daylight;
	struct spec_scene scene;
	char *text = malloc(100000);
	const double edges[] = {399.5, 700.5}, *rgb;
	double mean;
	size_t used;

	(void)state;
	assert_non_null(text);
	assert_int_equal(spec_lookup_curve("illuminants/D65", &daylight, NULL), SPEC_OK);
	used = (size_t)sprintf(text, "%s", LIGHT "\"rgbfromtabulated L\" [");
	for (size_t i = 0; i < daylight.count; i++)
		used += (size_t)sprintf(text + used, " %.17g %.17g",
			daylight.wavelength_nm[i], daylight.value[i] / 100);
	sprintf(text + used, " ]");
	scene = parse(text);
	rgb = scene.light[0].spectrum.rgb;
	near(rgb[1] / rgb[0], 1, 1e-9, "green over red");
	near(rgb[2] / rgb[0], 1, 1e-9, "blue over red");
	spec_curve_mean(&daylight, 0, SPEC_EXTRAPOLATE_REFUSE, edges, 1, &mean, NULL);
	near(energy_in_bands(
		     &scene, &scene.light[0].spectrum, "400:700:1", SPEC_BANDS_LIGHT),
		mean * 301 / 100, 1e-2, "its energy");
	spec_scene_free(&scene);
	spec_curve_free(&daylight);
	free(text);
}

/* ---- warnings and faults ---- */

static void
what_leaves_its_use_is_clamped(void **state)
{
	static const struct {
		const char *text, *warning;
	} rows[] = {
		{LIGHT "\"fourierspectrum L\" [400 700 1 1 0]",
			"t.pbrt:1:35: 'L' of LightSource \"infinite\" is light and -0.5 at "
			"550 nm; it is clamped"},
		{LIGHT "\"compositespectrumfourier L\" [3 400 700 1 1 0 500 2]",
			"t.pbrt:1:35: 'L' of LightSource \"infinite\" is light and -0.5 at "
			"550 nm; it is clamped"},
		{PAINT "\"fourierspectrum reflectance\" [400 700 1 -.6 0]",
			"t.pbrt:1:31: 'reflectance' of Material \"diffuse\" is a reflectance "
			"and -0.1 at 4"},
		{LIGHT "\"rgbfromtabulated L\" [499 0 500 1 501 0]",
			"t.pbrt:1:35: 'L' of LightSource \"infinite\" has a colour that sRGB "
			"has not, -"}};

	(void)state;
	for (size_t i = 0; i < COUNT(rows); i++) {
		struct spec_scene scene = parse(rows[i].text);

		assert_int_equal(scene.warnings, 1);
		if (strncmp(scene.warning[0], rows[i].warning, strlen(rows[i].warning)))
			fail_msg("'%s'", scene.warning[0]);
		if (i < 2) {
			/* The half wave above 0: half of 300 / pi + the half that is flat. */
			double part = energy_in_bands(&scene, &scene.light[0].spectrum,
				"390:710:10", SPEC_BANDS_LIGHT);
			double u = 2 * 3.141592653589793 / 3;

			near(part - 2. * (double)i,
				300 / 3.141592653589793 * (.5 * u + sin(u)), 2e-2,
				"energy");
		}
		spec_scene_free(&scene);
	}
}

struct fault {
	enum spec_status status;
	const char *text, *message;
};

static void
faults_have_places(void **state)
{
	static const struct fault faults[] = {
		{SPEC_EFORMAT, LIGHT "\"samplespectrum L\" [400 700 1]",
			"t.pbrt:1:35: 'L' of LightSource \"infinite\" needs the ends of a "
			"range in nm and two samples or more"},
		{SPEC_ERANGE, LIGHT "\"samplespectrum L\" [700 400 1 2]",
			"t.pbrt:1:35: 'L' of LightSource \"infinite\" is no spectrum: a "
			"spectrum cannot reach from 700 to 400 nm"},
		{SPEC_ERANGE, LIGHT "\"samplespectrum L\" [400 700 1 -2]",
			"t.pbrt:1:35: 'L' of LightSource \"infinite\" is light that is "
			"negative: -2 at 700 nm"},
		{SPEC_EFORMAT, LIGHT "\"tabulatedspectrum L\" [400 700 1]",
			"t.pbrt:1:35: 'L' of LightSource \"infinite\" needs pairs"},
		{SPEC_EFORMAT, LIGHT "\"fourierspectrum L\" [400 700 1 2]",
			"t.pbrt:1:35: 'L' of LightSource \"infinite\" needs the ends of a "
			"range in nm and an odd number of coefficients"},
		{SPEC_EFORMAT, LIGHT "\"fourierspectrum L\" [400 700]",
			"t.pbrt:1:35: 'L' of LightSource \"infinite\" needs the ends"},
		{SPEC_ERANGE, LIGHT "\"fourierspectrum L\" [0 700 1]",
			"t.pbrt:1:35: 'L' of LightSource \"infinite\" is no spectrum"},
		{SPEC_EFORMAT, LIGHT "\"compositespectrumsampled L\" [2.5 400 700 1 1]",
			"t.pbrt:1:35: 'L' of LightSource \"infinite\" begins with the number "
			"of its samples, not with 2.5"},
		{SPEC_EFORMAT, LIGHT "\"compositespectrumfourier L\" [0 400 700]",
			"t.pbrt:1:35: 'L' of LightSource \"infinite\" begins with the number "
			"of its coefficients, not with 0"},
		{SPEC_EFORMAT, LIGHT "\"compositespectrumsampled L\" [3 400 700 1 1]",
			"t.pbrt:1:35: 'L' of LightSource \"infinite\" needs, after 3, the ends "
			"of a range in nm and 3 samples"},
		{SPEC_EFORMAT, LIGHT "\"compositespectrumsampled L\" [2 400 700 1 1 546]",
			"t.pbrt:1:35: 'L' of LightSource \"infinite\" ends in 1 numbers that "
			"are no pairs"},
		{SPEC_ERANGE, LIGHT "\"compositespectrumsampled L\" [2 400 700 1 1 546 -1]",
			"t.pbrt:1:35: 'L' of LightSource \"infinite\" has a line of negative "
			"weight: -1 at 546 nm"},
		{SPEC_ERANGE, LIGHT "\"compositespectrumsampled L\" [2 400 700 1 1 -5 1]",
			"t.pbrt:1:35: 'L' of LightSource \"infinite\" is no spectrum: line 1"},
		{SPEC_ERANGE, LIGHT "\"compositespectrumfourier L\" [2 400 700 1 1]",
			"t.pbrt:1:35: 'L' of LightSource \"infinite\" is no spectrum: a "
			"Fourier spectrum has an odd number"},
		{SPEC_ERANGE,
			PAINT
			"\"compositespectrumsampled reflectance\" [2 400 700 1 1 546 1]",
			"t.pbrt:1:31: 'reflectance' of Material \"diffuse\" is a reflectance, "
			"and only light has lines"},
		{SPEC_ERANGE, PAINT "\"samplespectrum reflectance\" [400 700 1 2]",
			"t.pbrt:1:31: 'reflectance' of Material \"diffuse\" is a reflectance "
			"outside 0..1: 2 at 700 nm"},
		{SPEC_ERANGE, GLASS "\"fourierspectrum eta\" [400 700 1 .6 0]",
			"t.pbrt:1:34: 'eta' of Material \"dielectric\" is a refractive index "
			"that is not positive: -0.1 at 550 nm"},
		{SPEC_EFORMAT, LIGHT "\"rgbspectrum L\" [1 1]",
			"t.pbrt:1:35: 'L' of LightSource \"infinite\" takes 3 values, not 2"},
		{SPEC_ERANGE, LIGHT "\"rgbspectrum L\" [1 1 -1]",
			"t.pbrt:1:35: 'L' of LightSource \"infinite\" is light that is "
			"negative"},
		{SPEC_EFORMAT, LIGHT "\"rgbfromsampled L\" [400 700]",
			"t.pbrt:1:35: 'L' of LightSource \"infinite\" needs the ends"},
		{SPEC_ERANGE, LIGHT "\"rgbfromtabulated L\" [400 1 700 -1]",
			"t.pbrt:1:35: 'L' of LightSource \"infinite\" is light that is "
			"negative: -1 at 700 nm"},
		{SPEC_EFORMAT, LIGHT "\"fourierspectrum L\" \"D65\"",
			"t.pbrt:1:55: a value of 'L' should be a number, not \"D65\""},
		{SPEC_EFORMAT, LIGHT "\"samplespectru L\" [400 700 1 1]",
			"t.pbrt:1:35: there is no type 'samplespectru' of parameters; did you "
			"mean 'samplespectrum'?"},
	};

	(void)state;
	for (size_t i = 0; i < COUNT(faults); i++) {
		const struct fault *fault = &faults[i];
		struct spec_error error = {0};
		struct spec_scene scene;
		enum spec_status status = spec_scene_parse(
			&scene, fault->text, strlen(fault->text), "t.pbrt", &error);

		if (status != fault->status ||
			strncmp(error.message, fault->message, strlen(fault->message)) != 0)
			fail_msg("%s: status %d, '%s'", fault->text, status, error.message);
		assert_int_equal(spec_scene_parse(&scene, fault->text, strlen(fault->text),
					 "t.pbrt", NULL),
			status);
	}
}

int
main(void)
{
	const struct CMUnitTest tests[] = {
		cmocka_unit_test(samples_and_tables_are_curves),
		cmocka_unit_test(series_are_kept),
		cmocka_unit_test(lines_reach_every_grid),
		cmocka_unit_test(composites_have_both_parts),
		cmocka_unit_test(reflectances_may_be_composites_without_lines),
		cmocka_unit_test(colours_are_those_of_spectra),
		cmocka_unit_test(daylight_is_white),
		cmocka_unit_test(what_leaves_its_use_is_clamped),
		cmocka_unit_test(faults_have_places),
	};

	return cmocka_run_group_tests(tests, NULL, NULL);
}
