/* lib/place: the light of the sun and of a clear sky. */
#include "check.h"

#include <stdlib.h>

#include "place/clearsky.h"
#include "place/dome.h"
#include "place/sun.h"

#define PI 3.14159265358979323846
#define RADIANS (PI / 180)

static struct spec_error error;

static void
expect_ok(enum spec_status status)
{
	if (status != SPEC_OK)
		fail_msg("%s", error.message);
}

/* Uniform in [0, 1). */
static double
draw(void)
{
	static uint64_t state = 20050517;

	state = state * 6364136223846793005u + 1442695040888963407u;
	return (double)(state >> 11) * 0x1p-53;
}

/* ---- SPCTRAL2 ---- */

/* The column at a wavelength of the model. */
static double
at(const struct spec_curve *curve, enum spec_clearsky_column column, double nm)
{
	double value;

	expect_ok(spec_curve_sample(
		curve, column, SPEC_EXTRAPOLATE_REFUSE, &nm, 1, &value, &error));
	return value;
}

/*
 * NREL's program spectrl2_2.c for 40 N 80 W, 15 March 2020 10:45:59, 1013 hPa, exponent
 * 1.14, asymmetry 0.65, 0.344 atm-cm, depth 0.1, 1.42 cm, albedo 0.2: as the tests of pvlib
 * 0.13 quote it. It works in single precision, and has the sun to 1e-4 degrees.
 */
static void
spctral2_is_that_of_its_authors(void **state)
{
	static const struct {
		double nm, outside, direct, sky, both;
	} rows[] = {
		{300.0, 0.541685, 0.000403357, 0.000766597, 0.00103695},
		{320.0, 0.722819, 0.0938211, 0.10857, 0.171456},
		{350.0, 0.98603, 0.30439, 0.206687, 0.410711},
		{400.0, 1.49507, 0.717152, 0.274637, 0.755323},
		{410, 1.71966, 0.874312, 0.307391, 0.893416},
		{450.0, 2.02664, 1.22582, 0.325499, 1.14713},
		{510.0, 1.9478, 1.35159, 0.24005, 1.14598},
		{593.0, 1.78708, 1.3093, 0.154487, 1.03207},
		{718.0, 1.38883, 1.04527, 0.0792312, 0.779847},
		{762.5, 1.2362, 0.696961, 0.0457462, 0.512898},
		{905.0, 0.902841, 0.625378, 0.0301957, 0.449368},
		{937.0, 0.822787, 0.322714, 0.0142779, 0.230584},
		{1070.0, 0.647616, 0.602016, 0.022255, 0.425768},
		{1350.0, 0.395625, 0.067147, 0.0016227, 0.0466294},
		{1960.0, 0.124328, 0.0235258, 0.000322992, 0.0160916},
		{2005.0, 0.11422, 0.0313799, 0.000418265, 0.0214513},
		{2360.0, 0.0644887, 0.0514176, 0.000551568, 0.0350153},
		{3100.0, 0.0223386, 0.00340969, 2.31674e-05, 0.00230858},
		{4000.0, 0.00869283, 0.00834659, 3.97255e-05, 0.00563419},
	};
	/* Its factor of the distance is Spencer's; here it is that of its own first row. */
	struct spec_clearsky_sun sun = {
		.zenith_deg = 47.912086486816406, .distance_au = sqrt(.5359 / .541684692)};
	struct spec_atmosphere atmosphere = spec_atmosphere_default();
	struct spec_curve curve;

	(void)state;
	atmosphere.pressure_hpa = 1013;
	atmosphere.aerosol_depth = .1;
	atmosphere.aerosol_exponent = 1.14;
	atmosphere.ozone_cm = .344;
	near(spec_air_mass(sun.zenith_deg), 1.4899535986910446, 1e-5, "the air mass");
	expect_ok(spec_clearsky_curve(&sun, &atmosphere, NULL, &curve, &error));
	assert_int_equal(curve.count, 122);
	for (size_t i = 0; i < COUNT(rows); i++) {
		double nm = rows[i].nm;

		near(at(&curve, SPEC_CLEARSKY_OUTSIDE, nm), rows[i].outside, 2e-5,
			"outside");
		near(at(&curve, SPEC_CLEARSKY_DIRECT, nm), rows[i].direct, 3e-5, "direct");
		near(at(&curve, SPEC_CLEARSKY_SKY, nm), rows[i].sky, 2e-5, "the sky");
		near(at(&curve, SPEC_CLEARSKY_BOTH, nm), rows[i].both, 3e-5, "both");
	}
	spec_curve_free(&curve);
}

/* The integral of a column, linear between its rows. */
static double
integral(const struct spec_curve *curve, enum spec_clearsky_column column, double low,
	double high)
{
	const int steps = 2000;
	double sum = 0;

	for (int i = 0; i <= steps; i++)
		sum += at(curve, column, low + (high - low) * i / steps) *
		       (i == 0 || i == steps ? .5 : 1);
	return sum * (high - low) / steps;
}

/*
 * ASTM G173-03 is of a rigorous code for the same air: air mass 1.5, depth 0.084 at 500 nm,
 * 0.3438 atm-cm, 1.4164 cm, a plane tilted by 37 degrees to the sun; its ground is light
 * sand, of albedo 0.2 or so. The model's authors find 5 to 10 % at most wavelengths.
 */
static void
spctral2_is_near_the_reference_spectra(void **state)
{
	static const double edges[] = {300, 400, 500, 600, 700, 1100, 4000};
	static const double direct[] = {
		30.519, 115.122, 133.770, 125.923, 305.075, 189.730};
	static const double global[] = {
		46.101, 139.579, 151.013, 139.239, 328.626, 195.811};
	struct spec_clearsky_sun sun = {48.19, 180, 1};
	struct spec_clearsky_plane plane = {37, 180};
	struct spec_atmosphere atmosphere = spec_atmosphere_default();
	struct spec_curve curve;
	double sums[2] = {0};

	(void)state;
	atmosphere.aerosol_depth = .084;
	atmosphere.aerosol_exponent = 1.14;
	atmosphere.ozone_cm = .3438;
	atmosphere.water_cm = 1.4164;
	expect_ok(spec_clearsky_curve(&sun, &atmosphere, &plane, &curve, &error));
	for (size_t i = 0; i < COUNT(direct); i++) {
		double one = integral(&curve, SPEC_CLEARSKY_DIRECT, edges[i], edges[i + 1]);
		double two = integral(&curve, SPEC_CLEARSKY_BOTH, edges[i], edges[i + 1]);

		near(one, direct[i], .08 * direct[i], "direct in a range");
		near(two, global[i], .08 * global[i], "global in a range");
		sums[0] += one;
		sums[1] += two;
	}
	near(sums[0], 900.14, .02 * 900, "direct");
	near(sums[1], 1000.37, .03 * 1000, "global");
	spec_curve_free(&curve);
}

static void
planes_get_what_faces_them(void **state)
{
	struct spec_clearsky_sun sun = {60, 90, 1.01};
	struct spec_atmosphere atmosphere = spec_atmosphere_default();
	static const struct {
		struct spec_clearsky_plane plane;
		double incidence;
	} cases[] = {{{0, 0}, .5}, {{60, 90}, 1}, {{90, 270}, 0}, {{180, 0}, 0},
		{{90, 90}, .8660254037844386}, {{90, 30}, .4330127018922193}};
	struct spec_curve flat, curve;

	(void)state;
	expect_ok(spec_clearsky_curve(&sun, &atmosphere, NULL, &flat, &error));
	for (size_t i = 0; i < COUNT(cases); i++) {
		expect_ok(spec_clearsky_curve(
			&sun, &atmosphere, &cases[i].plane, &curve, &error));
		for (double nm = 400; nm < 2000; nm += 100) {
			double direct = at(&curve, SPEC_CLEARSKY_DIRECT, nm);

			near(at(&curve, SPEC_CLEARSKY_SUN, nm), direct * cases[i].incidence,
				1e-12, "the sun");
			assert_true(at(&curve, SPEC_CLEARSKY_SKY, nm) > 0);
			if (i == 3) /* a ceiling sees the ground alone */
				near(at(&curve, SPEC_CLEARSKY_SKY, nm),
					.2 * at(&flat, SPEC_CLEARSKY_BOTH, nm), 1e-12,
					"the ceiling");
		}
		spec_curve_free(&curve);
	}
	spec_curve_free(&flat);
}

/*
 * Without aerosol, ground and water, at 1070 nm, where nothing else absorbs: B 3-5 alone, half
 * of what molecules scatter, whatever the height of the sun.
 */
static void
half_of_what_molecules_scatter_comes_down(void **state)
{
	struct spec_atmosphere atmosphere = spec_atmosphere_default();

	(void)state;
	atmosphere.aerosol_depth = atmosphere.ground_albedo = atmosphere.water_cm = 0;
	for (double zenith = 0; zenith < 90; zenith += 4.99) {
		struct spec_clearsky_sun sun = {zenith, 0, 1};
		struct spec_curve curve;
		double outside, through;

		expect_ok(spec_clearsky_curve(&sun, &atmosphere, NULL, &curve, &error));
		outside = at(&curve, SPEC_CLEARSKY_OUTSIDE, 1070);
		through = at(&curve, SPEC_CLEARSKY_DIRECT, 1070) / outside;
		near(at(&curve, SPEC_CLEARSKY_SKY, 1070),
			outside * cos(zenith * RADIANS) * (1 - pow(through, .95)) / 2,
			1e-12, "the sky");
		spec_curve_free(&curve);
	}
}

static void
turbidity_is_of_aerosol(void **state)
{
	struct spec_atmosphere atmosphere = spec_atmosphere_default();

	(void)state;
	/* 0.04608 * 3 - 0.04586 at 1 um, and 2^1.3 times that at 500 nm. */
	near(atmosphere.aerosol_depth, .09238 * 2.462289, 1e-6, "the aerosol");
}

static void
what_is_no_day_is_refused(void **state)
{
	struct spec_atmosphere atmosphere = spec_atmosphere_default();
	struct spec_clearsky_sun sun = {90, 0, 1};
	struct spec_curve curve;
	struct spec_dome dome;

	(void)state;
	assert_int_equal(
		spec_clearsky_curve(&sun, &atmosphere, NULL, &curve, &error), SPEC_ERANGE);
	assert_contains(error.message, "below the horizon");
	assert_int_equal(spec_dome_make(&sun, &atmosphere, &dome, &error), SPEC_ERANGE);
	assert_contains(error.message, "below the horizon");
	sun.zenith_deg = NAN;
	assert_int_equal(spec_dome_make(&sun, &atmosphere, &dome, &error), SPEC_ERANGE);
	sun.zenith_deg = -1;
	assert_int_equal(spec_dome_make(&sun, &atmosphere, &dome, &error), SPEC_ERANGE);
	assert_contains(error.message, "zenith angle in degrees is -1, outside 0..90");
	sun.zenith_deg = 89.999;
	expect_ok(spec_dome_make(&sun, &atmosphere, &dome, &error));
	spec_dome_free(&dome);
	atmosphere.ground_albedo = 1.01;
	assert_int_equal(spec_dome_make(&sun, &atmosphere, &dome, &error), SPEC_ERANGE);
	assert_contains(error.message, "albedo is 1.01, outside 0..1");
	assert_int_equal(
		spec_atmosphere_set_turbidity(&atmosphere, .99, &error), SPEC_ERANGE);
	assert_int_equal(
		spec_atmosphere_set_turbidity(&atmosphere, 10.01, &error), SPEC_ERANGE);
}

/* ---- the dome ---- */

/* The sun in the south unless turned, at sea level. */
static void
make(double turbidity, double albedo, double elevation_deg, double azimuth_deg,
	struct spec_dome *dome)
{
	struct spec_clearsky_sun sun = {90 - elevation_deg, azimuth_deg, 1};
	struct spec_atmosphere atmosphere = spec_atmosphere_default();

	expect_ok(spec_atmosphere_set_turbidity(&atmosphere, turbidity, &error));
	atmosphere.ground_albedo = albedo;
	expect_ok(spec_dome_make(&sun, &atmosphere, dome, &error));
}

/* The direction at a zenith angle that is so far from the sun, all in degrees. */
static void
aim(const struct spec_dome *dome, double theta, double gamma, double direction[3])
{
	double z = cos(theta * RADIANS), r = sin(theta * RADIANS);
	double flat = hypot(dome->sun[0], dome->sun[1]);
	double turn = (cos(gamma * RADIANS) - z * dome->sun[2]) / (r * flat);
	double azimuth = atan2(dome->sun[0], dome->sun[1]) + acos(turn);

	assert_true(fabs(turn) <= 1);
	direction[0] = r * sin(azimuth);
	direction[1] = r * cos(azimuth);
	direction[2] = z;
}

/*
 * The authors' program, version 1.4a: its radiance at the bands, and that of the sun's centre
 * times its limb darkening there, which differs from 1 a little. The data here have 7 digits.
 */
static void
the_dome_is_that_of_its_authors(void **state)
{
	static const struct {
		double turbidity, albedo, elevation, theta, gamma;
		double sky[SPEC_DOME_BANDS], sun[SPEC_DOME_BANDS];
	} cases[] = {
		{1, 0, 30, 60, 45,
			{0.0354395763, 0.068275168, 0.10628165, 0.112645734, 0.104282955,
				0.0746362084, 0.0530751258, 0.0406755703, 0.0294075062,
				0.021556658, 0.0159707008},
			{779.452607, 3034.76945, 8355.73115, 14203.4563, 19605.9636,
				20110.0486, 20034.0316, 20927.7003, 20148.9995, 19264.0278,
				18190.9058}},
		{3, 0.2, 45, 30, 20,
			{0.0520006274, 0.0873621774, 0.128754977, 0.134117131, 0.126017014,
				0.0970172674, 0.0774493937, 0.0657450325, 0.0551132977,
				0.0452234888, 0.037123852},
			{1463.2507, 4448.18185, 10584.54, 16468.6777, 21494.8513,
				21258.9992, 20679.6173, 21285.2097, 20271.6472, 19252.5529,
				18098.7991}},
		{2.5, 0.3, 10, 85, 70,
			{0.00534855657, 0.0176578091, 0.0484640353, 0.0858487061,
				0.112049302, 0.108507691, 0.0947288835, 0.0856952114,
				0.068895646, 0.056888766, 0.0459145561},
			{13.5733116, 234.763032, 1497.14583, 4228.95724, 8051.97433,
				10222.078, 11802.432, 13730.9147, 14273.7849, 14478.2272,
				14310.3497}},
		{10, 1, 80, 5, 8,
			{0.146035211, 0.309161003, 0.612702533, 0.879903902, 1.07571363,
				1.01685217, 0.916106638, 0.904372617, 0.846557876,
				0.774231828, 0.674674725},
			{1690.86208, 4285.16051, 8814.58377, 12486.2966, 15389.8334,
				14738.1577, 14175.0085, 14755.4089, 14126.5254, 13655.9844,
				13082.5891}},
		{7.25, 0.5, 2, 89, 2.5,
			{0.000761894182, 0.00327059879, 0.00992723766, 0.0217845731,
				0.0494285345, 0.0816714886, 0.122203007, 0.18095578,
				0.22514811, 0.270493966, 0.306395584},
			{0, 0.00388336084, 0.238358879, 2.8390684, 13.5747166, 32.5793161,
				64.1368774, 127.932658, 190.621257, 284.225261,
				393.809267}},
		{4.6, 0.1, 60.3, 45, 70.5,
			{0.0506220981, 0.0797297791, 0.110046427, 0.108199823, 0.0936231082,
				0.0655477604, 0.0471144611, 0.0371092275, 0.0271391231,
				0.0207949105, 0.0159540847},
			{1906.73531, 5175.69117, 11493.5725, 17139.1537, 21786.5011,
				21187.3613, 20399.6886, 20886.6819, 19811.1866, 18787.9292,
				17652.6558}},
		{1.3, 0.8, 0.5, 70, 150,
			{0.00122564336, 0.00388801743, 0.00961662076, 0.0156920924,
				0.0217685328, 0.0218111203, 0.0216190298, 0.0214735797,
				0.0194289039, 0.016994476, 0.0145505013},
			{0, 2.64677465e-07, 0.123943667, 7.04685252, 87.6511675, 382.219434,
				1017.34153, 2123.7684, 3355.82495, 4624.13006, 5742.70376}},
	};

	static const double centre[] = {0.999986, 0.998263, 0.9998928, 0.999983, 0.999993,
		1, 1, 1.000008, 1.000009, 1.000005, 1.000008};

	(void)state;
	for (size_t i = 0; i < COUNT(cases); i++) {
		double direction[3], sky[SPEC_DOME_BANDS];
		struct spec_dome dome;

		make(cases[i].turbidity, cases[i].albedo, cases[i].elevation, 170, &dome);
		aim(&dome, cases[i].theta, cases[i].gamma, direction);
		spec_dome_sky(&dome, direction, sky);
		for (int j = 0; j < SPEC_DOME_BANDS; j++) {
			near(sky[j], cases[i].sky[j], 1e-5 * cases[i].sky[j], "the sky");
			near(dome.disc[j] * centre[j], cases[i].sun[j],
				1e-5 * cases[i].sun[j] + 1e-5, "the sun");
		}
		spec_dome_free(&dome);
	}
}

/* The limb darkening of the data at 560 nm: 1 in the centre, 0.26892 at the limb. */
static void
the_disc_is_darker_at_its_limb(void **state)
{
	const double r = asin(4.65047e-3), at_limb = .26892;
	double direction[3], radiance[SPEC_DOME_BANDS], sum = 0, centre;
	const int rings = 2000;
	struct spec_dome dome;

	(void)state;
	make(3, .2, 90 - 1e-9, 0, &dome); /* in the zenith */
	near(dome.radius_rad, r, 1e-9, "the radius");
	for (int i = 0; i < rings; i++) { /* of equal area */
		double angle = r * sqrt((i + .5) / rings);

		direction[0] = sin(angle) * .6;
		direction[1] = sin(angle) * .8;
		direction[2] = cos(angle);
		assert_int_equal(spec_dome_disc(&dome, direction, radiance), 1);
		sum += radiance[6] / rings;
	}
	near(sum, dome.disc[6], 1e-4 * dome.disc[6], "the mean over the disc");
	near(spec_dome_disc_sr(&dome), PI * r * r, 1e-9, "the solid angle");
	assert_int_equal(spec_dome_disc(&dome, dome.sun, radiance), 1);
	centre = radiance[6];
	direction[0] = sin(r * (1 - 1e-12)), direction[1] = 0;
	direction[2] = cos(r * (1 - 1e-12));
	assert_int_equal(spec_dome_disc(&dome, direction, radiance), 1);
	near(radiance[6] / centre, at_limb, 1e-4, "the limb");
	direction[0] = sin(r * (1 + 1e-6));
	direction[2] = cos(r * (1 + 1e-6));
	assert_int_equal(spec_dome_disc(&dome, direction, radiance), 0);
	assert_true(radiance[6] == 0);
	spec_dome_free(&dome);
}

/* Uniform over the hemisphere. */
static void
draw_up(double direction[3])
{
	double z = draw(), azimuth = 2 * PI * draw(), r = sqrt(1 - z * z);

	direction[0] = r * cos(azimuth);
	direction[1] = r * sin(azimuth);
	direction[2] = z;
}

static void
the_dome_is_even_about_the_suns_meridian(void **state)
{
	(void)state;
	for (int i = 0; i < 200; i++) {
		double azimuth = 360 * draw(), one[3], two[3], sky[2][SPEC_DOME_BANDS];
		double side, n[2];
		struct spec_dome dome;

		make(1 + 9 * draw(), draw(), 1 + 88 * draw(), azimuth, &dome);
		draw_up(one);
		/* The mirror image in the plane of the sun and the zenith. */
		n[0] = cos(azimuth * RADIANS);
		n[1] = -sin(azimuth * RADIANS);
		side = 2 * (one[0] * n[0] + one[1] * n[1]);
		two[0] = one[0] - side * n[0];
		two[1] = one[1] - side * n[1];
		two[2] = one[2];
		spec_dome_sky(&dome, one, sky[0]);
		spec_dome_sky(&dome, two, sky[1]);
		for (int j = 0; j < SPEC_DOME_BANDS; j++) {
			assert_true(sky[0][j] > 0);
			near(sky[1][j], sky[0][j], 1e-12 * sky[0][j], "the mirror image");
		}
		spec_dome_free(&dome);
	}
}

/* The horizontal irradiance by the midpoint rule in z^2 and azimuth. */
static void
integrate_flat(const struct spec_dome *dome, double sum[SPEC_DOME_BANDS])
{
	const int rings = 300, turns = 600;

	memset(sum, 0, SPEC_DOME_BANDS * sizeof *sum);
	for (int i = 0; i < rings * turns; i++) {
		int ring = i / turns;
		double z = sqrt((ring + .5) / rings), r = sqrt(1 - z * z);
		double azimuth = 2 * PI * (i % turns + .5) / turns, sky[SPEC_DOME_BANDS];

		spec_dome_sky(dome, (double[]){r * cos(azimuth), r * sin(azimuth), z}, sky);
		for (int j = 0; j < SPEC_DOME_BANDS; j++)
			sum[j] += sky[j] * PI / (rings * turns);
	}
}

/* The same in rings around the sun: z is 0 below the horizon. */
static void
integrate_around(const struct spec_dome *dome, double sum[SPEC_DOME_BANDS])
{
	const int rings = 700, turns = 700;
	const double *s = dome->sun, flat = hypot(s[0], s[1]);
	double u[3] = {s[1] / flat, -s[0] / flat, 0}; /* across the meridian */
	double v[3] = {-s[0] * s[2] / flat, -s[1] * s[2] / flat, flat};

	memset(sum, 0, SPEC_DOME_BANDS * sizeof *sum);
	for (int i = 0; i < rings * turns; i++) {
		int ring = i / turns;
		double gamma = PI * (ring + .5) / rings,
		       a = 2 * PI * (i % turns + .5) / turns;
		double d[3], sky[SPEC_DOME_BANDS];

		for (int k = 0; k < 3; k++)
			d[k] = s[k] * cos(gamma) +
			       sin(gamma) * (u[k] * cos(a) + v[k] * sin(a));
		spec_dome_sky(dome, d, sky);
		for (int j = 0; j < SPEC_DOME_BANDS; j++)
			sum[j] += sky[j] * fmax(d[2], 0) * sin(gamma) * 2 * PI * PI /
				  (rings * turns);
	}
}

static void
two_rules_give_the_same_irradiance(void **state)
{
	static const double elevations[] = {3, 30, 75};

	(void)state;
	for (size_t i = 0; i < COUNT(elevations); i++) {
		double one[SPEC_DOME_BANDS], two[SPEC_DOME_BANDS];
		struct spec_dome dome;

		make(2 + 2. * i, .3, elevations[i], 200, &dome);
		integrate_flat(&dome, one);
		integrate_around(&dome, two);
		for (int j = 0; j < SPEC_DOME_BANDS; j++)
			near(two[j], one[j], 1e-3 * one[j], "the other rule");
		spec_dome_free(&dome);
	}
}

static void
wavelengths_lie_between_and_beyond_the_bands(void **state)
{
	static const double nm[] = {300, 320, 330, 555, 720, 721, 940, 1600, 4000};
	struct spec_dome_weight sky[COUNT(nm)], disc[COUNT(nm)];
	struct spec_clearsky_sun sun = {50, 0, 1};
	struct spec_atmosphere atmosphere = spec_atmosphere_default();
	double band[SPEC_DOME_BANDS], value[COUNT(nm)], other[COUNT(nm)], d[3], end;
	struct spec_curve clear, dry;
	struct spec_dome dome;

	(void)state;
	make(3, .2, 40, 0, &dome);
	expect_ok(spec_clearsky_curve(&sun, &atmosphere, NULL, &clear, &error));
	draw_up(d);
	spec_dome_sky(&dome, d, band);
	expect_ok(spec_dome_weigh(&dome, nm, COUNT(nm), sky, disc, &error));
	spec_dome_spread(sky, COUNT(nm), band, value);
	spec_dome_spread(disc, COUNT(nm), band, other);
	near(value[1], band[0], 0, "320 nm");
	near(value[2], .75 * band[0] + .25 * band[1], 1e-15, "330 nm");
	near(value[3], .125 * band[5] + .875 * band[6], 1e-15, "555 nm");
	near(other[3], value[3], 0, "555 nm of the disc");
	near(value[4], band[10], 0, "720 nm");
	end = at(&clear, SPEC_CLEARSKY_SKY, 300) / at(&clear, SPEC_CLEARSKY_SKY, 320);
	near(value[0], end * band[0], 1e-12 * band[0], "300 nm");
	for (size_t i = 6; i < COUNT(nm); i++) {
		near(value[i] / value[5],
			at(&clear, SPEC_CLEARSKY_SKY, nm[i]) /
				at(&clear, SPEC_CLEARSKY_SKY, 721),
			1e-12, "beyond, the sky");
		near(other[i] / other[5],
			at(&clear, SPEC_CLEARSKY_DIRECT, nm[i]) /
				at(&clear, SPEC_CLEARSKY_DIRECT, 721),
			1e-12, "beyond, the sun");
	}
	atmosphere.water_cm = 0; /* the band at 720 nm knows none */
	expect_ok(spec_clearsky_curve(&sun, &atmosphere, NULL, &dry, &error));
	near(value[5] / band[10],
		at(&clear, SPEC_CLEARSKY_SKY, 721) / at(&dry, SPEC_CLEARSKY_SKY, 720),
		1e-12, "721 nm");
	spec_curve_free(&dry);
	assert_int_equal(
		spec_dome_weigh(&dome, (double[]){299}, 1, sky, NULL, &error), SPEC_ERANGE);
	assert_int_equal(spec_dome_weigh(&dome, (double[]){4001}, 1, NULL, disc, &error),
		SPEC_ERANGE);
	spec_curve_free(&clear);
	spec_dome_free(&dome);
}

/* Nothing comes from below, and the sky follows the sun's distance as its light does. */
static void
the_dome_ends_at_the_horizon(void **state)
{
	struct spec_clearsky_sun sun = {50, 10, 1};
	struct spec_atmosphere atmosphere = spec_atmosphere_default();
	double down[3] = {0, sqrt(.75), -.5}, up[3] = {0, sqrt(.75), .5},
	       sky[SPEC_DOME_BANDS];
	double near_sky[SPEC_DOME_BANDS];
	struct spec_dome dome;

	(void)state;
	expect_ok(spec_dome_make(&sun, &atmosphere, &dome, &error));
	spec_dome_sky(&dome, down, sky);
	for (int i = 0; i < SPEC_DOME_BANDS; i++)
		assert_true(sky[i] == 0);
	spec_dome_sky(&dome, up, sky);
	spec_dome_free(&dome);
	sun.distance_au = .983;
	expect_ok(spec_dome_make(&sun, &atmosphere, &dome, &error));
	spec_dome_sky(&dome, up, near_sky);
	for (int i = 0; i < SPEC_DOME_BANDS; i++)
		near(near_sky[i], sky[i] / (.983 * .983), 1e-12, "in January");
	near(dome.radius_rad, 4.65047e-3 / .983, 1e-7, "the disc in January");
	spec_dome_free(&dome);
	sun.zenith_deg = 89.9; /* the horizon cuts the disc */
	expect_ok(spec_dome_make(&sun, &atmosphere, &dome, &error));
	for (int i = -1; i <= 1; i += 2) {
		double height = i * .1 * RADIANS;

		up[0] = cos(height) * sin(10 * RADIANS);
		up[1] = cos(height) * cos(10 * RADIANS);
		up[2] = sin(height);
		assert_int_equal(spec_dome_disc(&dome, up, sky), i > 0);
	}
	spec_dome_free(&dome);
}

int
main(void)
{
	const struct CMUnitTest tests[] = {
		cmocka_unit_test(spctral2_is_that_of_its_authors),
		cmocka_unit_test(spctral2_is_near_the_reference_spectra),
		cmocka_unit_test(planes_get_what_faces_them),
		cmocka_unit_test(half_of_what_molecules_scatter_comes_down),
		cmocka_unit_test(turbidity_is_of_aerosol),
		cmocka_unit_test(what_is_no_day_is_refused),
		cmocka_unit_test(the_dome_is_that_of_its_authors),
		cmocka_unit_test(the_disc_is_darker_at_its_limb),
		cmocka_unit_test(the_dome_is_even_about_the_suns_meridian),
		cmocka_unit_test(two_rules_give_the_same_irradiance),
		cmocka_unit_test(wavelengths_lie_between_and_beyond_the_bands),
		cmocka_unit_test(the_dome_ends_at_the_horizon),
	};

	if (!getenv("SPECTRA_PATH"))
		setenv("SPECTRA_PATH", "spectra", 1);
	return cmocka_run_group_tests(tests, NULL, NULL);
}
