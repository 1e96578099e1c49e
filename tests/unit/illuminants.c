/* lib/spectrum/illuminant and the lights of the CIE in spectra/, as observers see them. */
#include <stdio.h>
#include <stdlib.h>
#include <unistd.h>

#include "colour/observer.h"
#include "spectrum/illuminant.h"
#include "spectrum/lookup.h"
#include "spectrum/planck.h"
#include "spectrum/store.h"

#include "check.h"

/* What T of D50 to D75 is multiplied by: c2 of 1968 over that of their definition. */
#define OF_1968 (1.4388 / 1.4380)

static void
light(const char *name, struct spec_curve *curve)
{
	struct spec_error error;

	if (spec_lookup_light(name, curve, &error) != SPEC_OK)
		fail_msg("%s", error.message);
}

static double
at(const struct spec_curve *curve, double nm)
{
	double value;

	assert_int_equal(
		spec_curve_sample(curve, 0, SPEC_EXTRAPOLATE_REFUSE, &nm, 1, &value, NULL),
		SPEC_OK);
	return value;
}

/* Every step-th sample of an observer: its sums are then at that distance. */
static void
observer(const char *name, size_t step, struct spec_curve *thin)
{
	struct spec_curve whole;
	struct spec_error error;

	if (spec_observer_load(name, &whole, &error) != SPEC_OK)
		fail_msg("%s", error.message);
	assert_int_equal(
		spec_curve_new((whole.count - 1) / step + 1, 3, thin, NULL), SPEC_OK);
	for (size_t i = 0; i < thin->count; i++) {
		thin->wavelength_nm[i] = whole.wavelength_nm[i * step];
		for (size_t c = 0; c < 3; c++)
			thin->value[c * thin->count + i] =
				whole.value[c * whole.count + i * step];
	}
	spec_curve_free(&whole);
}

static void
chromaticity(const struct spec_curve *eye, const struct spec_curve *lamp, double xy[2])
{
	double xyz[3], sum;

	assert_int_equal(spec_observer_white(eye, lamp, xyz, NULL), SPEC_OK);
	sum = xyz[0] + xyz[1] + xyz[2];
	xy[0] = xyz[0] / sum;
	xy[1] = xyz[1] / sum;
}

/* ---- the CIE's lights ---- */

/*
 * Chromaticities, of the observers of 1931 and 1964, of four or five digits; each was held
 * against the list of colour-science 0.4 (CCS_ILLUMINANTS, BSD-3-Clause), whose sources are,
 * of 1931: CIE 15:2004, and CIE 15:2018 for the LEDs. Of 1964: CIE 15:2004; for B and FL1 to
 * FL12 the list of Wikipedia, "Standard illuminant". D60 and ID of both, and FL3, HP and LED
 * of 1964, are its own sums by ASTM E308-15, rounded here: not published, but another
 * program's. Its D50 and D65 are those of RGB spaces, .3457 .3585 and .3127 .3290; these are
 * the CIE's, which its notes name.
 */
static const struct {
	const char *name;
	double x, y, x10, y10;
} published[] = {
	{"A", .44758, .40745, .45117, .40594},
	{"B", .34842, .35161, .34980, .35270},
	{"C", .31006, .31616, .31039, .31905},
	{"D50", .34567, .35851, .34773, .35952},
	{"D55", .33243, .34744, .33412, .34877},
	{"D60", .32162, .33762, .32299, .33928},
	{"D65", .31272, .32903, .31382, .33100},
	{"D75", .29903, .31488, .29968, .31740},
	{"E", .33333, .33333, .33333, .33333},
	{"ID50", .34321, .36021, .34562, .36123},
	{"ID65", .31066, .33066, .31207, .33266},
	{"LED-B1", .4560, .4078, .46250, .40304},
	{"LED-B2", .4357, .4012, .44212, .39663},
	{"LED-B3", .3756, .3723, .38085, .36852},
	{"LED-B4", .3422, .3502, .34837, .34507},
	{"LED-B5", .3118, .3236, .31692, .32206},
	{"LED-BH1", .4474, .4066, .45277, .40003},
	{"LED-RGB1", .4557, .4211, .45704, .42538},
	{"LED-V1", .4548, .4044, .45360, .39820},
	{"LED-V2", .3781, .3775, .37773, .37451},
	{"HP1", .5330, .4150, .54333, .40529},
	{"HP2", .4778, .4158, .48265, .41082},
	{"HP3", .4302, .4075, .43556, .39880},
	{"HP4", .3812, .3797, .38519, .36828},
	{"HP5", .3776, .3713, .38032, .36662},
	{"FL1", .3131, .3371, .31811, .33559},
	{"FL2", .3721, .3751, .37925, .36733},
	{"FL3", .4091, .3941, .41761, .38324},
	{"FL4", .4402, .4031, .44920, .39074},
	{"FL5", .3138, .3452, .31975, .34246},
	{"FL6", .3779, .3882, .38660, .37847},
	{"FL7", .3129, .3292, .31569, .32960},
	{"FL8", .3458, .3586, .34902, .35939},
	{"FL9", .3741, .3727, .37829, .37045},
	{"FL10", .3458, .3588, .35090, .35444},
	{"FL11", .3805, .3769, .38541, .37123},
	{"FL12", .4370, .4042, .44256, .39717},
	{"FL3.1", .4407, .4033, .44983, .39023},
	{"FL3.2", .3808, .3734, .38692, .36576},
	{"FL3.3", .3153, .3439, .32118, .34050},
	{"FL3.4", .4429, .4043, .44812, .39708},
	{"FL3.5", .3749, .3672, .37781, .36663},
	{"FL3.6", .3488, .3600, .35198, .36109},
	{"FL3.7", .4384, .4045, .44431, .39679},
	{"FL3.8", .3820, .3832, .38759, .37631},
	{"FL3.9", .3499, .3591, .35469, .35345},
	{"FL3.10", .3455, .3560, .34934, .35498},
	{"FL3.11", .3245, .3434, .32927, .33887},
	{"FL3.12", .4377, .4037, .44225, .40122},
	{"FL3.13", .3830, .3724, .38628, .37428},
	{"FL3.14", .3447, .3609, .34726, .36681},
	{"FL3.15", .3127, .3288, .31461, .33338},
};

static void
compare(const struct spec_curve eye[2], size_t lamp, double tolerance, double tolerance10)
{
	struct spec_curve curve;
	double xy[2];

	light(published[lamp].name, &curve);
	chromaticity(&eye[0], &curve, xy);
	near(xy[0], published[lamp].x, tolerance, published[lamp].name);
	near(xy[1], published[lamp].y, tolerance, published[lamp].name);
	chromaticity(&eye[1], &curve, xy);
	near(xy[0], published[lamp].x10, tolerance10, published[lamp].name);
	near(xy[1], published[lamp].y10, tolerance10, published[lamp].name);
	spec_curve_free(&curve);
}

/* Sums by 5 nm, from which the tables are. Those of FL at 10 degrees are by 1 nm. */
static void
lights_have_their_published_chromaticities(void **state)
{
	struct spec_curve eye[2];

	(void)state;
	observer("1931", 5, &eye[0]);
	observer("1964", 5, &eye[1]);
	for (size_t i = 0; i < COUNT(published); i++)
		compare(eye, i, 1e-4,
			strncmp(published[i].name, "FL", 2) == 0 ? 3e-4 : 1e-4);
	spec_curve_free(&eye[0]);
	spec_curve_free(&eye[1]);
}

/* As the tools see them: by 1 nm, and straight between the 5 nm of the lamps' tables. */
static void
lamps_hardly_change_with_the_step(void **state)
{
	struct spec_curve eye[2];

	(void)state;
	observer("1931", 1, &eye[0]);
	observer("1964", 1, &eye[1]);
	for (size_t i = 0; i < COUNT(published); i++) {
		int smooth = strchr("ABCDEI", published[i].name[0]) != NULL;

		compare(eye, i, smooth ? 1e-4 : 3e-4, smooth ? 1e-4 : 3e-4);
	}
	spec_curve_free(&eye[0]);
	spec_curve_free(&eye[1]);
}

/* CIE 170-2:2015: equal energy is white to the cones' observers too. */
static void
equal_energy_is_white(void **state)
{
	static const char *const names[] = {"1931", "1964", "2015-2", "2015-10"};

	(void)state;
	for (size_t i = 0; i < COUNT(names); i++) {
		struct spec_curve eye;
		double xy[2];

		observer(names[i], 1, &eye);
		chromaticity(&eye, NULL, xy);
		near(xy[0], 1. / 3, 5e-5, names[i]);
		near(xy[1], 1. / 3, 5e-5, names[i]);
		spec_curve_free(&eye);
	}
}

/* Equal steps, here of 5 nm, stay as they are, with their values. */
static void
observers_keep_their_steps(void **state)
{
	struct spec_curve eye, table;

	(void)state;
	assert_int_equal(spec_observer_load("stiles-burch-1959", &eye, NULL), SPEC_OK);
	assert_int_equal(spec_lookup_curve("stiles-burch-1959", &table, NULL), SPEC_OK);
	assert_int_equal(eye.count, table.count);
	for (size_t i = 0; i < table.count; i++)
		assert_true(eye.wavelength_nm[i] == table.wavelength_nm[i]);
	for (size_t i = 0; i < 3 * table.count; i++)
		assert_true(eye.value[i] == table.value[i]);
	assert_string_equal(eye.column[2], "b");
	assert_false(spec_observer_is_xyz(&eye));
	spec_curve_free(&eye);
	spec_curve_free(&table);
}

/* ---- daylight ---- */

/* The tables have three decimals, that of D65 four but of sums rounded before. */
static void
daylight_has_its_tables(void **state)
{
	static const struct {
		const char *name;
		double temperature_k, tolerance;
	} cases[] = {{"D50", 5000, 5.1e-4}, {"D55", 5500, 5.1e-4}, {"D60", 6000, 1e-6},
		{"D65", 6500, 1e-3}, {"D75", 7500, 5.1e-4}};

	(void)state;
	for (size_t k = 0; k < COUNT(cases); k++) {
		struct spec_curve table, curve;
		char name[64];

		snprintf(name, sizeof name, "daylight:%.9fK",
			cases[k].temperature_k * OF_1968);
		light(name, &curve);
		light(cases[k].name, &table);
		assert_int_equal(curve.count, 107);
		for (double nm = 300; nm <= 780; nm += 5)
			near(at(&curve, nm), at(&table, nm), cases[k].tolerance, name);
		spec_curve_free(&curve);
		spec_curve_free(&table);
	}
}

/* What is summed from the components has the chromaticity that the factors are made for. */
static void
daylight_lies_on_its_locus(void **state)
{
	struct spec_curve eye;
	double xy[2], seen[2], below[2];

	(void)state;
	observer("1931", 1, &eye);
	for (double t = 4000; t <= 25000; t += 250) {
		struct spec_curve curve;
		char name[64];

		snprintf(name, sizeof name, "daylight:%gK", t);
		light(name, &curve);
		assert_int_equal(spec_daylight_xy(t, xy, NULL), SPEC_OK);
		chromaticity(&eye, &curve, seen);
		near(seen[0], xy[0], 3e-4, name);
		near(seen[1], xy[1], 3e-4, name);
		near(at(&curve, 560), 100, 0, name);
		spec_curve_free(&curve);
	}
	/* By hand from the equations. */
	assert_int_equal(spec_daylight_xy(4000, xy, NULL), SPEC_OK);
	near(xy[0], .382343625, 1e-12, "x at 4000 K");
	near(xy[1], .3837662610155782, 1e-12, "y at 4000 K");
	assert_int_equal(spec_daylight_xy(25000, xy, NULL), SPEC_OK);
	near(xy[0], .2498536704, 1e-12, "x at 25000 K");
	assert_int_equal(spec_daylight_xy(6950, xy, NULL), SPEC_OK);
	near(xy[0], 0.3060419203904202, 1e-12, "x at 6950 K");
	/* The two branches meet to what their constants allow. */
	assert_int_equal(spec_daylight_xy(7000, below, NULL), SPEC_OK);
	assert_int_equal(spec_daylight_xy(7000.001, xy, NULL), SPEC_OK);
	near(xy[0], below[0], 1e-6, "x at 7000 K");
	spec_curve_free(&eye);
}

/* ---- the black body ---- */

/* A is one of 2848 K with c2 = 1.435e7 nm K; so it is of more with that of the SI. */
static void
black_body_has_the_shape_of_a(void **state)
{
	double c2_nm_k =
		1e9 * SPEC_PLANCK_J_S * SPEC_LIGHT_SPEED_M_PER_S / SPEC_BOLTZMANN_J_PER_K;
	struct spec_curve table, curve;
	char name[64];

	(void)state;
	light("A", &table);
	snprintf(name, sizeof name, "blackbody:%.12gK", 2848 * c2_nm_k / 1.435e7);
	light(name, &curve);
	for (size_t i = 0; i < table.count; i++)
		near(at(&curve, table.wavelength_nm[i]) / table.value[i], 1, 1e-8, name);
	spec_curve_free(&curve);
	spec_curve_free(&table);
}

static void
black_body_peaks_after_wien(void **state)
{
	(void)state;
	for (double t = 1500; t < 12000; t += 500) {
		struct spec_curve curve;
		size_t most = 0;

		assert_int_equal(spec_blackbody_curve(t, &curve, NULL), SPEC_OK);
		for (size_t i = 1; i < curve.count; i++)
			if (curve.value[i] > curve.value[most])
				most = i;
		near(curve.wavelength_nm[most], SPEC_WIEN_NM_K / t, .5 + 1e-3, "peak");
		near(at(&curve, 560), 100, 1e-12, "reference");
		spec_curve_free(&curve);
	}
}

static void
black_bodies_of_any_temperature_are_finite(void **state)
{
	static const double temperature_k[] = {100, 300, 1e3, 1e5, 1e6};

	(void)state;
	for (size_t k = 0; k < COUNT(temperature_k); k++) {
		struct spec_curve curve;

		assert_int_equal(
			spec_blackbody_curve(temperature_k[k], &curve, NULL), SPEC_OK);
		for (size_t i = 0; i < curve.count; i++)
			assert_true(isfinite(curve.value[i]) && curve.value[i] >= 0);
		spec_curve_free(&curve);
	}
}

/* ---- names ---- */

static void
formulas_are_found_like_names(void **state)
{
	struct spec_spectrum spectrum;
	struct spec_curve curve;
	double nm = 560, value;

	(void)state;
	light("blackbody:3e3K", &curve);
	assert_string_equal(curve.title, "Black body of 3000 K");
	assert_string_equal(curve.medium, "vacuum");
	spec_curve_free(&curve);
	assert_int_equal(spec_spectrum_named("daylight:5000K", &spectrum, NULL), SPEC_OK);
	assert_int_equal(spec_spectrum_sample(
				 &spectrum, SPEC_EXTRAPOLATE_REFUSE, &nm, 1, &value, NULL),
		SPEC_OK);
	near(value, 100, 0, "daylight");
	spec_spectrum_free(&spectrum);
}

static void
other_temperatures_are_refused(void **state)
{
	static const struct {
		const char *name, *message;
	} cases[] = {{"daylight:3999.9K", "outside 4000..25000"},
		{"daylight:25001K", "outside 4000..25000"},
		{"blackbody:99K", "outside 100..1e+06"},
		{"blackbody:1e7K", "outside 100..1e+06"},
		{"blackbody:3000", "as in blackbody:3000K"},
		{"daylight:K", "as in daylight:6504K"},
		{"daylight:", "as in daylight:6504K"},
		{"daylight:6504 K", "is not a number"},
		{"blackbody:nanK", "is not a number"},
		{"blackbody:3000KK", "is not a number"},
		{"blackbody:00000000000000000000000000000000000000000000000000000000000003000K",
			"as in blackbody:3000K"}};
	struct spec_curve curve;
	struct spec_error error;
	double xy[2];

	(void)state;
	for (size_t i = 0; i < COUNT(cases); i++) {
		enum spec_status status = spec_lookup_light(cases[i].name, &curve, &error);

		assert_int_equal(status,
			strstr(cases[i].message, "outside") ? SPEC_ERANGE : SPEC_EUSAGE);
		assert_contains(error.message, cases[i].message);
		assert_null(curve.value);
	}
	assert_int_equal(spec_daylight_xy(NAN, xy, &error), SPEC_ERANGE);
	assert_int_equal(spec_daylight_xy(3999, xy, &error), SPEC_ERANGE);
	assert_int_equal(spec_blackbody_curve(NAN, &curve, &error), SPEC_ERANGE);
	assert_null(curve.value);
	assert_int_equal(
		spec_lookup_light("daylight-components", &curve, &error), SPEC_EUSAGE);
	assert_contains(error.message, "is a daylight component, not light");
}

/* CIE 15:2004 calls FL what was F before; F5 is a glass of SCHOTT's, too. */
static void
lamps_have_their_older_names(void **state)
{
	static const char *const none[] = {"F", "F0", "F13", "F3.", "F3.16", "F3.1.1",
		"F123", "F4x", "F3.x", "F3.123", "f 4"};
	struct spec_curve lamp, older;
	struct spec_error error;

	(void)state;
	for (int i = 1; i <= 27; i++) {
		char name[24], old[16];

		if (i <= 12)
			snprintf(old, sizeof old, "%c%d", i % 2 ? 'F' : 'f', i);
		else
			snprintf(old, sizeof old, "F3.%d", i - 12);
		snprintf(name, sizeof name, "FL%s", old + 1);
		light(name, &lamp);
		light(old, &older);
		assert_int_equal(older.count, lamp.count);
		assert_memory_equal(
			older.value, lamp.value, lamp.count * sizeof *lamp.value);
		spec_curve_free(&lamp);
		spec_curve_free(&older);
	}
	for (size_t i = 0; i < COUNT(none); i++) {
		assert_int_equal(spec_lookup_light(none[i], &lamp, &error), SPEC_EUSAGE);
		assert_contains(error.message, none[i]);
		assert_null(lamp.value);
	}
	assert_int_equal(spec_lookup_curve("F5", &lamp, &error), SPEC_OK);
	assert_string_equal(lamp.quantity, "refractive index");
	spec_curve_free(&lamp);
	assert_int_equal(spec_lookup_light("glass/F5", &lamp, &error), SPEC_EUSAGE);
	assert_contains(error.message, "is a refractive index, not light");
}

int
main(void)
{
	const struct CMUnitTest tests[] = {
		cmocka_unit_test(lights_have_their_published_chromaticities),
		cmocka_unit_test(lamps_hardly_change_with_the_step),
		cmocka_unit_test(equal_energy_is_white),
		cmocka_unit_test(observers_keep_their_steps),
		cmocka_unit_test(daylight_has_its_tables),
		cmocka_unit_test(daylight_lies_on_its_locus),
		cmocka_unit_test(black_body_has_the_shape_of_a),
		cmocka_unit_test(black_body_peaks_after_wien),
		cmocka_unit_test(black_bodies_of_any_temperature_are_finite),
		cmocka_unit_test(formulas_are_found_like_names),
		cmocka_unit_test(lamps_have_their_older_names),
		cmocka_unit_test(other_temperatures_are_refused),
	};

	if (access("spectra/cmf/cie1931.spd", R_OK) == 0)
		setenv("SPECTRA_PATH", "spectra", 1);
	return cmocka_run_group_tests(tests, NULL, NULL);
}
