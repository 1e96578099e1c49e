/* Numbers that others have printed of the spectra in spectra/: temperatures, colour charts. */
#include <stdio.h>
#include <stdlib.h>
#include <unistd.h>

#include "colour/difference.h"
#include "colour/observer.h"
#include "colour/temperature.h"
#include "spectrum/lookup.h"

#include "check.h"

static struct spec_curve observer; /* CIE 1931 */

static int
load_observer(void **state)
{
	(void)state;
	return spec_observer_load("1931", &observer, NULL) != SPEC_OK;
}

static int
free_observer(void **state)
{
	(void)state;
	spec_curve_free(&observer);
	return 0;
}

/* ---- tristimulus values and correlated colour temperatures ---- */

/*
 * CIE 15:2004, tables of the illuminants (A to D75 by their definition; FL1 to FL12 in whole
 * 10 K), and CIE 15:2018 (LED), as the package Color of Haskell 0.4.1 and Wikipedia,
 * "Standard illuminant", repeat them; D60 by definition, 6000 K times 1.4388 / 1.4380.
 */
static const struct {
	const char *name;
	double cct_k;
} temperatures[] = {
	{"A", 2856},
	{"B", 4874},
	{"C", 6774},
	{"D50", 5003},
	{"D55", 5503},
	{"D60", 6003},
	{"D65", 6504},
	{"D75", 7504},
	{"E", 5454},
	{"FL1", 6430},
	{"FL2", 4230},
	{"FL3", 3450},
	{"FL4", 2940},
	{"FL5", 6350},
	{"FL6", 4150},
	{"FL7", 6500},
	{"FL8", 5000},
	{"FL9", 4150},
	{"FL10", 5000},
	{"FL11", 4000},
	{"FL12", 3000},
	{"FL3.1", 2932},
	{"FL3.2", 3965},
	{"FL3.3", 6280},
	{"FL3.4", 2904},
	{"FL3.5", 4086},
	{"FL3.6", 4894},
	{"FL3.7", 2979},
	{"FL3.8", 4006},
	{"FL3.9", 4853},
	{"FL3.10", 5000},
	{"FL3.11", 5854},
	{"FL3.12", 2984},
	{"FL3.13", 3896},
	{"FL3.14", 5045},
	{"FL3.15", 6509},
	{"HP1", 1959},
	{"HP2", 2506},
	{"HP3", 3144},
	{"HP4", 4002},
	{"HP5", 4039},
	{"LED-B1", 2733},
	{"LED-B2", 2998},
	{"LED-B3", 4103},
	{"LED-B4", 5109},
	{"LED-B5", 6598},
	{"LED-BH1", 2851},
	{"LED-RGB1", 2840},
	{"LED-V1", 2724},
	{"LED-V2", 4070},
};

/* Every fifth sample of an observer: the lamps' tables and what is told of them are of 5 nm. */
static void
sum_by_5_nm(const struct spec_curve *eye, const char *name, double first_nm, double last_nm,
	double xyz[3])
{
	struct spec_curve lamp;
	struct spec_error error;

	if (spec_lookup_light(name, &lamp, &error) != SPEC_OK)
		fail_msg("%s", error.message);
	for (size_t c = 0; c < 3; c++)
		xyz[c] = 0;
	for (size_t i = 0; i < eye->count; i += 5) {
		double power, nm = eye->wavelength_nm[i];

		if (nm < first_nm || nm > last_nm)
			continue;
		assert_int_equal(spec_curve_sample(&lamp, 0, SPEC_EXTRAPOLATE_ZERO, &nm, 1,
					 &power, NULL),
			SPEC_OK);
		for (size_t c = 0; c < 3; c++)
			xyz[c] += power * eye->value[c * eye->count + i];
	}
	spec_curve_free(&lamp);
}

/*
 * Whole kelvins of other constants of radiation and of a search in steps: .05 %, which is what
 * the fifth digit of x is worth at 5000 K; FL1 to FL12 besides half of their last digit.
 */
static void
lights_have_their_published_temperatures(void **state)
{
	(void)state;
	for (size_t i = 0; i < COUNT(temperatures); i++) {
		const char *name = temperatures[i].name;
		double wanted = temperatures[i].cct_k, xyz[3], cct, duv;
		int coarse = strncmp(name, "FL", 2) == 0 && !strchr(name, '.');

		sum_by_5_nm(&observer, name, 360, 830, xyz);
		spec_temperature_find(&observer, xyz, &cct, &duv);
		near(cct, wanted, .0005 * wanted + (coarse ? 5 : 0), name);
	}
}

/*
 * X and Z for Y = 100: CIE 015:2018, as colour-science 0.4 repeats it (TVS_ILLUMINANTS). To
 * half of the last digit they are sums by 5 nm from 380 to 780 nm.
 */
static void
illuminants_have_their_published_values(void **state)
{
	static const struct {
		const char *observer, *name;
		double x, z;
	} known[] = {{"1931", "A", 109.85, 35.58}, {"1931", "C", 98.07, 118.22},
		{"1931", "D50", 96.42, 82.51}, {"1931", "D55", 95.68, 92.14},
		{"1931", "D65", 95.04, 108.88}, {"1931", "D75", 94.97, 122.61},
		{"1964", "A", 111.14, 35.20}, {"1964", "C", 97.29, 116.14},
		{"1964", "D50", 96.72, 81.43}, {"1964", "D55", 95.80, 90.93},
		{"1964", "D65", 94.81, 107.32}, {"1964", "D75", 94.42, 120.64}};

	(void)state;
	for (size_t i = 0; i < COUNT(known); i++) {
		struct spec_curve eye;
		double xyz[3];

		assert_int_equal(
			spec_observer_load(known[i].observer, &eye, NULL), SPEC_OK);
		sum_by_5_nm(&eye, known[i].name, 380, 780, xyz);
		near(100 * xyz[0] / xyz[1], known[i].x, 5.1e-3, known[i].name);
		near(100 * xyz[2] / xyz[1], known[i].z, 5.1e-3, known[i].name);
		spec_curve_free(&eye);
	}
}

/*
 * A. R. Robertson: Computation of correlated color temperature and distribution temperature.
 * J. Opt. Soc. Am. 58 (1968) 1528, table 1, as Wyszecki and Stiles 1982, table 1(3.11), has
 * it: reciprocal temperature [1/MK], u, v, and the slope of the line of constant temperature.
 * At 325 the u of .24702 is a misprint of .24792 (B. Lindbloom). Its c2 is .014388 m K.
 */
static const double robertson[][4] = {
	{10, .18066, .26589, -.25479},
	{20, .18133, .26846, -.26876},
	{30, .18208, .27119, -.28539},
	{40, .18293, .27407, -.30470},
	{50, .18388, .27709, -.32675},
	{60, .18494, .28021, -.35156},
	{70, .18611, .28342, -.37915},
	{80, .18740, .28668, -.40955},
	{90, .18880, .28997, -.44278},
	{100, .19032, .29326, -.47888},
	{125, .19462, .30141, -.58204},
	{150, .19962, .30921, -.70471},
	{175, .20525, .31647, -.84901},
	{200, .21142, .32312, -1.0182},
	{225, .21807, .32909, -1.2168},
	{250, .22511, .33439, -1.4512},
	{275, .23247, .33904, -1.7298},
	{300, .24010, .34308, -2.0637},
	{325, .24792, .34655, -2.4681},
	{350, .25591, .34951, -2.9641},
	{375, .26400, .35200, -3.5814},
	{400, .27218, .35407, -4.3633},
	{425, .28039, .35577, -5.3762},
	{450, .28863, .35714, -6.7262},
	{475, .29685, .35823, -8.5955},
	{500, .30505, .35907, -11.324},
	{525, .31320, .35968, -15.628},
	{550, .32129, .36011, -23.325},
	{575, .32931, .36038, -40.770},
	{600, .33724, .36051, -116.45},
};

static void
xyz_of_uv(double u, double v, double xyz[3])
{
	double sum = 2 * u - 8 * v + 4;

	xyz[0] = 3 * u / sum;
	xyz[1] = 2 * v / sum;
	xyz[2] = 1 - xyz[0] - xyz[1];
}

/* Half of the last digit. */
static void
black_bodies_lie_where_robertson_has_them(void **state)
{
	(void)state;
	for (size_t i = 0; i < COUNT(robertson); i++) {
		double temperature_k = 1e6 / robertson[i][0] * (.01438776877 / .014388);
		double xyz[3], uv[2];

		spec_temperature_black_body(&observer, temperature_k, xyz);
		spec_temperature_uv(xyz, uv);
		near(uv[0], robertson[i][1], 5.1e-6, "u");
		near(uv[1], robertson[i][2], 5.1e-6, "v");
	}
}

/*
 * .02 off the locus on either side, the temperature is still that of the line. The slopes have
 * five digits, u and v are rounded to 1e-5. The first is that of the highest temperature.
 */
static void
temperature_is_constant_along_robertsons_lines(void **state)
{
	(void)state;
	for (size_t i = 1; i < COUNT(robertson); i++) {
		double mired = robertson[i][0] / (.01438776877 / .014388);
		double slope = robertson[i][3], along = .02 / hypot(1, slope);

		for (int side = -1; side <= 1; side += 2) {
			double xyz[3], cct, duv;

			xyz_of_uv(robertson[i][1] + side * along,
				robertson[i][2] + side * along * slope, xyz);
			spec_temperature_find(&observer, xyz, &cct, &duv);
			near(1e6 / cct, mired, .03, "mired");
			near(duv, -side * .02, 1e-5, "Duv");
		}
	}
}

/* ---- the ColorChecker ---- */

/*
 * xyY under C: C. S. McCamy, H. Marcus, J. G. Davidson: A color-rendition chart. J. Appl.
 * Photogr. Eng. 2 (1976) 95. Lab under D50: the maker's reference of 2005 (X-Rite: New color
 * specifications for ColorChecker SG and Classic charts, 2016: before November 2014). Both are
 * of the CIE 1931 observer, and as colour-science 0.4 lists them.
 */
static const struct {
	const char *name;
	double xyy[3], lab[3];
} checker[] = {
	{"01-dark-skin", {.4002, .3504, .1005}, {37.986, 13.555, 14.059}},
	{"02-light-skin", {.3773, .3446, .3582}, {65.711, 18.13, 17.81}},
	{"03-blue-sky", {.2470, .2514, .1933}, {49.927, -4.88, -21.905}},
	{"04-foliage", {.3372, .4220, .1329}, {43.139, -13.095, 21.905}},
	{"05-blue-flower", {.2651, .2400, .2427}, {55.112, 8.844, -25.399}},
	{"06-bluish-green", {.2608, .3430, .4306}, {70.719, -33.397, -.199}},
	{"07-orange", {.5060, .4070, .3005}, {62.661, 36.067, 57.096}},
	{"08-purplish-blue", {.2110, .1750, .1200}, {40.02, 10.41, -45.964}},
	{"09-moderate-red", {.4533, .3058, .1977}, {51.124, 48.239, 16.248}},
	{"10-purple", {.2845, .2020, .0656}, {30.325, 22.976, -21.587}},
	{"11-yellow-green", {.3800, .4887, .4429}, {72.532, -23.709, 57.255}},
	{"12-orange-yellow", {.4729, .4375, .4306}, {71.941, 19.363, 67.857}},
	{"13-blue", {.1866, .1285, .0611}, {28.778, 14.179, -50.297}},
	{"14-green", {.3046, .4782, .2339}, {55.261, -38.342, 31.37}},
	{"15-red", {.5385, .3129, .1200}, {42.101, 53.378, 28.19}},
	{"16-yellow", {.4480, .4703, .5910}, {81.733, 4.039, 79.819}},
	{"17-magenta", {.3635, .2325, .1977}, {51.935, 49.986, -14.574}},
	{"18-cyan", {.1958, .2519, .1977}, {51.038, -28.631, -28.638}},
	{"19-white", {.3101, .3163, .9001}, {96.539, -.425, 1.186}},
	{"20-neutral-8", {.3101, .3163, .5910}, {81.257, -.638, -.335}},
	{"21-neutral-6.5", {.3101, .3163, .3620}, {66.766, -.734, -.504}},
	{"22-neutral-5", {.3101, .3163, .1977}, {50.867, -.153, -.27}},
	{"23-neutral-3.5", {.3101, .3163, .0900}, {35.656, -.421, -1.231}},
	{"24-black", {.3101, .3163, .0313}, {20.461, -.079, -.973}},
};

/* The reflectance is level outside 380..780 nm, where the observer hardly sees. */
static void
see_patch(const char *name, const struct spec_curve *light, double xyz[3])
{
	struct spec_curve patch;
	struct spec_error error;
	char path[80];
	double y = 0;

	snprintf(path, sizeof path, "colorchecker/%s", name);
	if (spec_lookup_curve(path, &patch, &error) != SPEC_OK)
		fail_msg("%s", error.message);
	for (size_t c = 0; c < 3; c++)
		xyz[c] = 0;
	for (size_t i = 0; i < observer.count; i++) {
		double power, part;

		assert_int_equal(spec_curve_sample(light, 0, SPEC_EXTRAPOLATE_ZERO,
					 &observer.wavelength_nm[i], 1, &power, NULL),
			SPEC_OK);
		assert_int_equal(spec_curve_sample(&patch, 0, SPEC_EXTRAPOLATE_CONSTANT,
					 &observer.wavelength_nm[i], 1, &part, NULL),
			SPEC_OK);
		y += power * observer.value[observer.count + i];
		for (size_t c = 0; c < 3; c++)
			xyz[c] += power * part * observer.value[c * observer.count + i];
	}
	for (size_t c = 0; c < 3; c++)
		xyz[c] /= y;
	spec_curve_free(&patch);
}

/*
 * The reflectances are one chart's, measured by N. Ohta 1997, and the numbers those of others:
 * charts differ by DeltaE2000 of 1 and more (D. Pascale: RGB coordinates of the Macbeth
 * ColorChecker, 2006, who compares such sets). So each may be 2 away, and their mean 1.
 */
static void
compare_charts(const char *light_name, int by_lab)
{
	const size_t count = COUNT(checker);
	struct spec_curve light;
	double white[3], sum = 0;

	assert_int_equal(spec_lookup_light(light_name, &light, NULL), SPEC_OK);
	assert_int_equal(spec_observer_white(&observer, &light, white, NULL), SPEC_OK);
	for (size_t i = 0; i < count; i++) {
		const double *p = checker[i].xyy;
		double xyz[3], seen[3], wanted[3], difference;
		double told[3] = {
			p[0] / p[1] * p[2], p[2], (1 - p[0] - p[1]) / p[1] * p[2]};

		see_patch(checker[i].name, &light, xyz);
		spec_lab_from_xyz(xyz, white, seen);
		spec_lab_from_xyz(told, white, wanted);
		difference =
			spec_difference_ciede2000(seen, by_lab ? checker[i].lab : wanted);
		near(difference, 0, 2, checker[i].name);
		sum += difference;
	}
	near(sum / (double)count, 0, 1, light_name);
	spec_curve_free(&light);
}

static void
colorchecker_has_its_makers_colours(void **state)
{
	(void)state;
	compare_charts("C", 0);
	compare_charts("D50", 1);
}

int
main(void)
{
	const struct CMUnitTest tests[] = {
		cmocka_unit_test(illuminants_have_their_published_values),
		cmocka_unit_test(lights_have_their_published_temperatures),
		cmocka_unit_test(black_bodies_lie_where_robertson_has_them),
		cmocka_unit_test(temperature_is_constant_along_robertsons_lines),
		cmocka_unit_test(colorchecker_has_its_makers_colours),
	};

	if (access("spectra/cmf/cie1931.spd", R_OK) == 0)
		setenv("SPECTRA_PATH", "spectra", 1);
	return cmocka_run_group_tests(tests, load_observer, free_observer);
}
