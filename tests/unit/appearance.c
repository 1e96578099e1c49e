/* Correlated colour temperature, dominant wavelength, and the whole appearance of curves. */
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "colour/appearance.h"
#include "colour/dominant.h"
#include "colour/temperature.h"
#include "spectrum/lookup.h"
#include "spectrum/spd.h"

#include "check.h"

static struct spec_curve observer;

static int
load_observer(void **state)
{
	struct spec_error error;

	(void)state;
	setenv("SPECTRA_PATH", "spectra", 1);
	return spec_spd_load("spectra/cmf/cie1931.spd", &observer, &error) != SPEC_OK;
}

static int
free_observer(void **state)
{
	(void)state;
	spec_curve_free(&observer);
	return 0;
}

/* XYZ with Y = 1 of a chromaticity in the CIE 1960 diagram. */
static void
xyz_of_uv(double u, double v, double xyz[3])
{
	double x = 3 * u / (2 * u - 8 * v + 4), y = 2 * v / (2 * u - 8 * v + 4);

	xyz[0] = x / y;
	xyz[1] = 1;
	xyz[2] = (1 - x - y) / y;
}

static void
xyz_of_xy(double x, double y, double xyz[3])
{
	xyz[0] = x / y;
	xyz[1] = 1;
	xyz[2] = (1 - x - y) / y;
}

/*
 * u, v as colour-science's tests have them, to 8 digits (BSD-3-Clause, test_ohno2013.py). Its
 * c2 is .014388 m K, and its observer ends at 780 nm; the same black body has another
 * temperature by another c2.
 */
static void
test_planckian_locus(void **state)
{
	static const struct {
		double temperature_k, u, v;
	} known[] = {
		{1000, .44796288, .35462962},
		{1010, .44563516, .35483063},
	};
	double *value = observer.value;
	struct spec_curve cut = observer;
	double xyz[3], uv[2];

	(void)state;
	cut.value = malloc(3 * cut.count * sizeof *cut.value);
	assert_non_null(cut.value);
	for (size_t i = 0; i < 3 * cut.count; i++)
		cut.value[i] = cut.wavelength_nm[i % cut.count] > 780 ? 0 : value[i];
	for (size_t i = 0; i < COUNT(known); i++) {
		spec_temperature_black_body(
			&cut, known[i].temperature_k * .014387768775 / .014388, xyz);
		spec_temperature_uv(xyz, uv);
		near(uv[0], known[i].u, 1e-8, "u");
		near(uv[1], known[i].v, 1e-8, "v");
	}
	free(cut.value);
}

/*
 * Ohno 2014's algorithm after colour-science's test: u .1978, v .3122 is 6507.4738 K, Duv
 * .00322335. The algorithm's own error is up to 1 K and 1e-6, c2's .1 K.
 */
static void
test_temperature_ohno(void **state)
{
	double xyz[3], cct, duv;

	(void)state;
	xyz_of_uv(.1978, .3122, xyz);
	spec_temperature_find(&observer, xyz, &cct, &duv);
	near(cct, 6507.4738, 1, "temperature");
	near(duv, .00322335, 1e-6, "Duv");
	/* sRGB's white: 6504 K by CIE 15's D65, .0032 in ANSI C78.377's notation. */
	xyz_of_xy(.3127, .3290, xyz);
	spec_temperature_find(&observer, xyz, &cct, &duv);
	near(cct, 6504, 1, "D65");
	near(duv, .0032, 5e-5, "D65");
}

/* From the locus, a known way along its perpendicular and back, over the whole range. */
static void
test_temperature_round_trip(void **state)
{
	static const double aside[] = {-.0499, -.02, -1e-4, 0, 1e-4, .02, .0499};

	(void)state;
	for (double mired = 10.01; mired <= 999; mired *= 1.25) {
		double t = 1e6 / mired, step = 1e-5 * t, xyz[3], at[2], low[2], high[2];
		double cct, duv, length;

		spec_temperature_black_body(&observer, t, xyz);
		spec_temperature_uv(xyz, at);
		spec_temperature_black_body(&observer, t - step, xyz);
		spec_temperature_uv(xyz, low);
		spec_temperature_black_body(&observer, t + step, xyz);
		spec_temperature_uv(xyz, high);
		length = hypot(high[0] - low[0], high[1] - low[1]);
		for (size_t i = 0; i < COUNT(aside); i++) {
			/* Towards hotter, u falls: the left hand is below the locus. */
			double u = at[0] + aside[i] * (high[1] - low[1]) / length;
			double v = at[1] - aside[i] * (high[0] - low[0]) / length;

			xyz_of_uv(u, v, xyz);
			spec_temperature_find(&observer, xyz, &cct, &duv);
			near(cct / t, 1, 1e-5, "temperature");
			near(duv, aside[i], 1e-9, "Duv");
		}
		/* And none farther off than .05. */
		xyz_of_uv(at[0] + .0501 * (high[1] - low[1]) / length,
			at[1] - .0501 * (high[0] - low[0]) / length, xyz);
		spec_temperature_find(&observer, xyz, &cct, &duv);
		assert_true(isnan(cct) && isnan(duv));
	}
}

static void
test_temperature_none(void **state)
{
	static const double none[][3] = {{0, 0, 0}, {NAN, 1, 1}, {1, INFINITY, 1},
		{-1, -1, -1}, {.4, .2, .01}, {.1, .8, .1}, {.2, .05, 1}};
	double xyz[3], cct, duv;

	(void)state;
	for (size_t i = 0; i < COUNT(none); i++) {
		spec_temperature_find(&observer, none[i], &cct, &duv);
		assert_true(isnan(cct) && isnan(duv));
	}
	spec_temperature_black_body(&observer, 990, xyz);
	spec_temperature_find(&observer, xyz, &cct, &duv);
	assert_true(isnan(cct));
	spec_temperature_black_body(&observer, 105000, xyz);
	spec_temperature_find(&observer, xyz, &cct, &duv);
	assert_true(isnan(cct));
}

/*
 * colour-science's test_dominant.py (BSD-3-Clause), white .31270, .32900: there the nearest
 * whole wavelength, so within half a nm; the purity is the same construction, but with the
 * locus of all samples: 2e-3 between the nearest whole wavelength and the line's own.
 */
static void
test_dominant_published(void **state)
{
	static const double white[2] = {.3127, .3290};
	static const struct {
		double xy[2], dominant_nm, purity;
	} known[] = {
		{{.54369557, .32107944}, 616, .622885671878446},
		{{.37605506, .24452225}, -509, .438347859215887},
	};
	double nm, purity;

	(void)state;
	for (size_t i = 0; i < COUNT(known); i++) {
		assert_int_equal(spec_dominant_find(
					 &observer, known[i].xy, white, &nm, &purity, NULL),
			SPEC_OK);
		near(nm, known[i].dominant_nm, .5, "wavelength");
		near(purity, known[i].purity, 2e-3, "purity");
	}
}

/* Mixtures of white and the observer's own samples: they are met to rounding. */
static void
test_dominant_mixtures(void **state)
{
	static const double white[2] = {1. / 3, 1. / 3};
	double(*xy)[2] = malloc(observer.count * sizeof *xy);
	double *nm = malloc(observer.count * sizeof *nm), found, purity;
	size_t count = spec_dominant_locus(&observer, xy, nm);

	(void)state;
	assert_int_equal(count, 321);
	near(nm[0], 380, 0, "first");
	near(nm[count - 1], 700, 0, "last");
	for (size_t i = 40; i < count - 20; i++) {
		for (double part = .01; part <= 1; part += .33) {
			double at[2] = {white[0] + part * (xy[i][0] - white[0]),
				white[1] + part * (xy[i][1] - white[1])};

			spec_dominant_find(&observer, at, white, &found, &purity, NULL);
			near(found, nm[i], 1e-6, "wavelength");
			near(purity, part, 1e-9, "purity");
		}
	}
	for (double along = .1; along < 1; along += .2) {
		double purple[2] = {xy[0][0] + along * (xy[count - 1][0] - xy[0][0]),
			xy[0][1] + along * (xy[count - 1][1] - xy[0][1])};
		double at[2] = {white[0] + .3 * (purple[0] - white[0]),
			white[1] + .3 * (purple[1] - white[1])};

		spec_dominant_find(&observer, at, white, &found, &purity, NULL);
		assert_true(found < -490 && found > -570);
		near(purity, .3, 1e-9, "purity of a purple");
	}
	spec_dominant_find(&observer, white, white, &found, &purity, NULL);
	assert_true(isnan(found) && purity == 0);
	spec_dominant_find(&observer, (double[2]){NAN, 0}, white, &found, &purity, NULL);
	assert_true(isnan(found) && isnan(purity));
	free(xy);
	free(nm);
}

/*
 * xy: CIE 15:2004, tables T.3 and T.8.1, printed to 4 or 5 digits, of sums over 5 nm. Those
 * over 1 nm, the light linear between, differ by up to 2e-5, and by 3e-4 where it has lines.
 * Temperatures: the same tables, of lamps rounded to 10 K and more. Duv: of the printed xy,
 * the least distance to a black body among all whole temperatures.
 */
static void
test_appearance_of_lights(void **state)
{
	static const struct {
		const char *name;
		double x, y, xy_tolerance, cct_k, cct_tolerance, duv, duv_tolerance;
		double u, v; /* u', v' of the same table; 0: not there */
	} known[] = {
		{"D65", .31272, .32903, 2e-5, 6504, 2, .0032, 5e-5, .1978, .4683},
		{"D50", .34567, .35851, 2e-5, 5003, 2, .0032, 1e-4, .2092, .4881},
		{"A", .44758, .40745, 2e-5, 2856, 1, 0, 2e-5, .2560, .5243},
		{"F2", .3721, .3751, 3e-4, 4230, 15, .0018, 2e-4, 0, 0},
		{"F7", .3129, .3292, 3e-4, 6500, 15, .0032, 2e-4, 0, 0},
		{"F11", .3805, .3769, 3e-4, 4000, 15, .0001, 2e-4, 0, 0},
	};
	struct spec_viewing viewing;
	struct spec_appearance found;
	struct spec_error error;

	(void)state;
	assert_int_equal(spec_viewing_load(NULL, NULL, &viewing, &error), SPEC_OK);
	for (size_t i = 0; i < COUNT(known); i++) {
		const char *name = known[i].name;
		struct spec_curve lamp;

		assert_int_equal(spec_lookup_light(name, &lamp, &error), SPEC_OK);
		assert_int_equal(
			spec_appearance_of_curve(&viewing, &lamp, 0, &found, &error),
			SPEC_OK);
		near(found.xyz[1], 100, 1e-9, name);
		near(found.xy[0], known[i].x, known[i].xy_tolerance, name);
		near(found.xy[1], known[i].y, known[i].xy_tolerance, name);
		if (known[i].u > 0) {
			near(found.uv[0], known[i].u, 6e-5, name);
			near(found.uv[1], known[i].v, 6e-5, name);
		}
		near(found.cct_k, known[i].cct_k, known[i].cct_tolerance, name);
		near(found.duv, known[i].duv, known[i].duv_tolerance, name);
		near(found.lab[0], 100, 1e-9, name);
		assert_true(isnan(found.luminance));
		spec_curve_free(&lamp);
	}
	spec_viewing_free(&viewing);
}

/* A level spectrum of 1 on two samples, with the texts given. */
static void
see_level(const struct spec_viewing *viewing, const char *quantity, const char *unit,
	struct spec_appearance *found)
{
	struct spec_error error;
	struct spec_curve level;

	assert_int_equal(spec_curve_new(2, 1, &level, &error), SPEC_OK);
	level.wavelength_nm[0] = 360;
	level.wavelength_nm[1] = 830;
	level.value[0] = level.value[1] = 1;
	assert_int_equal(spec_curve_set_text(&level.quantity, quantity, &error), SPEC_OK);
	assert_int_equal(spec_curve_set_text(&level.unit, unit, &error), SPEC_OK);
	assert_int_equal(
		spec_appearance_of_curve(viewing, &level, 0, found, &error), SPEC_OK);
	spec_curve_free(&level);
}

/*
 * 683 lm/W times 106.857 nm, the integral of ybar (CIE 15: 106.8569, colour-science too), is
 * 72983 cd/m2. The perfect reflector under D65: ASTM E308's white point.
 */
static void
test_appearance_scales(void **state)
{
	struct spec_viewing viewing;
	struct spec_appearance found;
	struct spec_error error;

	(void)state;
	assert_int_equal(spec_viewing_load(NULL, NULL, &viewing, &error), SPEC_OK);
	see_level(&viewing, "radiance per nm", "", &found);
	near(found.luminance, 683 * 106.857, 1, "luminance");
	near(found.xyz[1], found.luminance, 1e-9, "Y");
	near(found.lab[0], 100, 1e-9, "L*");
	near(found.purity, 0, 0, "purity of equal energy");
	assert_true(isnan(found.dominant_nm));
	near(found.outside, 0, 1e-12, "outside");
	see_level(&viewing, "reflectance", "1", &found);
	near(found.xyz[0], 95.047, .01, "X");
	near(found.xyz[1], 100, 1e-9, "Y");
	near(found.xyz[2], 108.883, .01, "Z");
	near(found.lab[1], 0, 1e-9, "a*");
	assert_true(isnan(found.cct_k) && isnan(found.luminance));
	see_level(&viewing, "refractive index", "1", &found);
	assert_true(isnan(found.xyz[1]) && isnan(found.lab[0]));
	see_level(&viewing, "radiance", "relative", &found);
	assert_true(found.xyz[1] == 100 && isnan(found.luminance));
	assert_true(isnan(found.illuminance));
	see_level(&viewing, "spectral power distribution", "relative", &found);
	assert_true(found.xyz[1] == 100 && isnan(found.illuminance));
	see_level(&viewing, "spectral power distribution", "W m-2 nm-1", &found);
	near(found.illuminance, 683 * 106.857, 1, "illuminance");
	near(found.xyz[1], found.illuminance, 1e-9, "Y");
	near(found.lab[0], 100, 1e-9, "L*");
	assert_true(isnan(found.luminance));
	spec_viewing_free(&viewing);
	/* Equal energy has x' = y' = 1/3 by either observer; D65 by the 10 degree observer: */
	assert_int_equal(spec_viewing_load("1964", "D65", &viewing, &error), SPEC_OK);
	see_level(&viewing, "reflectance", "1", &found);
	near(found.xy[0], .31381, 2e-5, "x10 of D65, CIE 15:2004 table T.3");
	near(found.xy[1], .33098, 2e-5, "y10");
	see_level(&viewing, "radiance", "", &found);
	near(found.luminance, 683 * 106.857, 1, "luminance is CIE 1931's");
	assert_true(found.purity > .05);
	spec_viewing_free(&viewing);
	assert_int_equal(spec_viewing_load("1931", "Au", &viewing, &error), SPEC_EUSAGE);
}

int
main(void)
{
	const struct CMUnitTest tests[] = {
		cmocka_unit_test(test_planckian_locus),
		cmocka_unit_test(test_temperature_ohno),
		cmocka_unit_test(test_temperature_round_trip),
		cmocka_unit_test(test_temperature_none),
		cmocka_unit_test(test_dominant_published),
		cmocka_unit_test(test_dominant_mixtures),
		cmocka_unit_test(test_appearance_of_lights),
		cmocka_unit_test(test_appearance_scales),
	};

	return cmocka_run_group_tests_name(
		"appearance", tests, load_observer, free_observer);
}
