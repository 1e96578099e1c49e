/* lib/place: where the sun is, and when it rises and sets. */
#include <stdio.h>
#include <stdlib.h>

#include "place/day.h"
#include "place/sun.h"

#include "check.h"
#include "instants.h"

#define ARCSECOND (1. / 3600)
#define RADIANS (1 / 57.29577951308232)

static const struct spec_place golden = {39.742476, -105.1786, 1830.14};

static struct spec_solar
solar_of(const struct spec_place *place, const char *time, const struct spec_air *air)
{
	struct spec_instant instant = instant_of(time);
	struct spec_error error = {0};
	struct spec_solar solar;

	if (spec_solar_position(place, &instant, air, &solar, &error) != SPEC_OK)
		fail_msg("%s", error.message);
	return solar;
}

/*
 * Reda & Andreas: Solar position algorithm for solar radiation applications. NREL/TP-560-34302,
 * 2003, revised 2008, table A5.1 and appendix A.4. Tolerance: 1.1", for VSOP87 as the paper
 * cuts it against ERFA's orbit; their 67 s of TT - UT1 in place of 64.184 s are under .1" more.
 */
static void
sun_is_where_the_paper_has_it(void **state)
{
	static const struct spec_air air = {820, 11};
	struct spec_solar solar = solar_of(&golden, "2003-10-17T12:30:30-07:00", &air);

	(void)state;
	near(solar.zenith_deg, 90 - 39.872046, 1.1 * ARCSECOND, "zenith, airless");
	near(solar.zenith_refracted_deg, 50.11162, 1.1 * ARCSECOND, "zenith, refracted");
	near((solar.azimuth_deg - 194.34024) * sin(50.11162 * RADIANS), 0, 1.1 * ARCSECOND,
		"azimuth");
	near(solar.declination_deg, -9.316179, 1.1 * ARCSECOND, "declination");
	near(solar.hour_angle_deg, 11.10629, 1.1 * ARCSECOND, "hour angle");
	near(solar.distance_au, .9965422974, 2e-7, "distance");
	/* Their mean sun is that of TT, 67 s before UT1's, and goes 0.9856474 deg a day. */
	near(solar.equation_of_time_min, 14.641503 - 67 * .9856474 / 86400 * 4,
		1.1 * ARCSECOND * 4, "equation of time");
}

/*
 * Meeus: Astronomical algorithms, 2nd edition, 1998, examples 25.b and 28.b: 1992 October 13,
 * 0h TD, which is 59.184 s after UTC; his mean sun is that of TD, too.
 */
static void
sun_is_where_meeus_has_it(void **state)
{
	struct spec_place pole = {90, 0, 0};
	struct spec_solar solar = solar_of(&pole, "1992-10-12T23:59:00.816Z", NULL);

	(void)state;
	near(solar.distance_au, .99760775, 2e-6, "distance");
	/* From the pole the parallax, 8.794", lowers it. */
	near(solar.declination_deg, -7.783872 - 8.794 * cos(7.783872 * RADIANS) * ARCSECOND,
		1.1 * ARCSECOND, "declination");
	near(solar.equation_of_time_min, (3.427351 - 59.184 * .9856474 / 86400) * 4,
		1.1 * ARCSECOND * 4, "equation of time");
}

/*
 * The Astronomical Almanac for 2024: equinoxes to the minute, in which the declination changes
 * by 1", half of it for rounding and 1.2" for the sun's own latitude; perihelion and aphelion.
 */
static void
sun_is_where_the_almanac_has_it(void **state)
{
	struct spec_place place = {0, 0, 0};

	(void)state;
	near(solar_of(&place, "2024-03-20T03:06Z", NULL).declination_deg, 0,
		1.7 * ARCSECOND, "spring");
	near(solar_of(&place, "2024-09-22T12:44Z", NULL).declination_deg, 0,
		1.7 * ARCSECOND, "autumn");
	near(solar_of(&place, "2024-01-03T00:39Z", NULL).distance_au, .983307, 1e-6,
		"perihelion");
	near(solar_of(&place, "2024-07-05T05:06Z", NULL).distance_au, 1.016725, 1e-6,
		"aphelion");
}

static void
what_follows_from_the_sun_is_consistent(void **state)
{
	struct spec_solar solar = solar_of(&golden, "2003-10-17T12:30:30-07:00", NULL);
	const double *e = solar.east_north_up;
	double h = (90 - solar.zenith_refracted_deg) * RADIANS;

	(void)state;
	near(solar.antisolar_azimuth_deg, solar.azimuth_deg - 180, 1e-9,
		"antisolar azimuth");
	near(solar.antisolar_elevation_deg, -h / RADIANS, 1e-9, "antisolar elevation");
	near(e[0] * e[0] + e[1] * e[1] + e[2] * e[2], 1, 1e-14, "length");
	near(e[2], sin(h), 1e-14, "up");
	near(atan2(e[0], e[1]) / RADIANS + 360, solar.azimuth_deg, 1e-9, "azimuth");
	/* 4.65047e-3 rad at 1 au, and the place is 4100 km nearer. */
	near(solar.radius_deg * solar.distance_au, 4.65047e-3 / RADIANS * (1 + 2.74e-5),
		.005 * ARCSECOND, "radius");
	near(solar.air_mass_absolute / solar.air_mass,
		spec_air_standard(golden.altitude_m).pressure_hpa / 1013.25, 1e-12,
		"pressure");
}

/* ISO 2533:1975, tables: pressure and temperature at geopotential altitudes. */
static void
air_is_the_standard(void **state)
{
	static const struct {
		double altitude_m, pressure_hpa, temperature_c;
	} levels[] = {{0, 1013.25, 15}, {1000, 898.746, 8.5}, {2000, 794.952, 2},
		{5000, 540.199, -17.5}, {11000, 226.320, -56.5}, {12000, 193.304, -56.5},
		{20000, 54.7487, -56.5}};

	(void)state;
	for (size_t i = 0; i < COUNT(levels); i++) {
		struct spec_air air = spec_air_standard(levels[i].altitude_m);

		near(air.pressure_hpa, levels[i].pressure_hpa,
			1e-5 * levels[i].pressure_hpa, "pressure");
		near(air.temperature_c, levels[i].temperature_c, 1e-9, "temperature");
	}
}

/*
 * Refraction at 1010 hPa and 10 C by Bennett's and Saemundsson's formulas: Meeus (1998),
 * chapter 16, has 28.754' at an apparent 0.5 deg, 24.618' at a true 33.246' (they agree to
 * .1'). The air masses are of table 1 of Kasten & Young (1989), by their formula.
 */
static void
light_is_bent_and_dimmed(void **state)
{
	static const struct spec_air air = {1010, 10}, cold = {1010, -20}, thin = {505, 10};

	(void)state;
	near(spec_air_refraction(&cold, 20), spec_air_refraction(&air, 20) * 283 / 253,
		1e-12, "cold air");
	near(spec_air_refraction(&thin, 20), spec_air_refraction(&air, 20) / 2, 1e-12,
		"thin air");
	near(spec_air_refraction(&air, .5 - 28.754 / 60) * 60, 28.754, .1,
		"near the horizon");
	near(spec_air_refraction(&air, 33.246 / 60) * 60, 24.618, .001, "Meeus");
	near(spec_air_refraction(&air, 45) * 60, 1.0130, .005, "45 degrees");
	/* 10.3 / 4.61 - .5 is 1.7343 degrees, of which the tangent is .030279. */
	near(spec_air_refraction(&air, -.5) * 60, 1.02 / .030279, .01, "half set");
	near(spec_air_refraction(&air, -1), 0, 0, "below the horizon");
	near(spec_air_mass(0), .9997, 1e-4, "zenith");
	near(spec_air_mass(60), 1.994, 1e-3, "60 degrees");
	near(spec_air_mass(85), 10.3, .05, "85 degrees");
	near(spec_air_mass(90), 37.92, .01, "horizon");
	assert_true(isnan(spec_air_mass(90.001)));
}

static void
wrong_numbers_are_refused(void **state)
{
	static const struct spec_air wrong[] = {
		{-1, 10}, {NAN, 10}, {3000, 10}, {1010, -200}, {1010, NAN}, {1010, 200}};
	struct spec_instant instant = instant_of("2003-10-17T12:30:30-07:00"),
			    late = instant;
	struct spec_place nowhere = {95, 0, 0};
	struct spec_solar solar;

	(void)state;
	for (size_t i = 0; i < COUNT(wrong); i++)
		assert_int_equal(
			spec_solar_position(&golden, &instant, &wrong[i], &solar, NULL),
			SPEC_ERANGE);
	assert_int_equal(
		spec_solar_position(&nowhere, &instant, NULL, &solar, NULL), SPEC_ERANGE);
	late.utc1 += 1e6;
	assert_int_equal(
		spec_solar_position(&golden, &late, NULL, &solar, NULL), SPEC_ERANGE);
}

static struct spec_solar_day
day_of(const struct spec_place *place, const char *time)
{
	struct spec_instant instant = instant_of(time);
	struct spec_error error = {0};
	struct spec_solar_day day;

	if (spec_solar_day(place, &instant, &day, &error) != SPEC_OK)
		fail_msg("%s", error.message);
	return day;
}

static void
at(const struct spec_instant *got, const char *wanted, double tolerance_s)
{
	struct spec_instant instant = instant_of(wanted);

	near(spec_instant_between(&instant, got), 0, tolerance_s, wanted);
}

/*
 * Reda & Andreas, appendix A.2: what they compute for three days, and the Astronomical Almanac
 * has to the minute. They leave out the sun's parallax, 8.8", for which it rises up to .8 s
 * later here, and sets earlier.
 */
static void
sun_rises_and_sets_as_in_the_paper(void **state)
{
	static const struct {
		double latitude_deg;
		const char *sunrise, *sunset;
	} days[] = {{35, "1994-01-02T07:08:12.8Z", "1994-01-02T16:59:55.9Z"},
		{-35, "1996-07-05T07:08:15.4Z", "1996-07-05T17:01:04.5Z"},
		{-35, "2004-12-04T04:38:57.1Z", "2004-12-04T19:02:02.5Z"}};

	(void)state;
	for (size_t i = 0; i < COUNT(days); i++) {
		struct spec_place place = {days[i].latitude_deg, 0, 0};
		struct spec_solar_day day = day_of(&place, days[i].sunrise);

		assert_int_equal(day.kind, SPEC_DAY_ORDINARY);
		at(&day.sunrise, days[i].sunrise, 1);
		at(&day.sunset, days[i].sunset, 1);
	}
}

/*
 * Times to the minute, as almanacs print them, rounded: London (HM Nautical Almanac Office),
 * and the time of sunrise that NREL's calculator gives for its own example.
 */
static void
sun_rises_and_sets_as_in_almanacs(void **state)
{
	struct spec_place london = {51.5074, -.1278, 0};
	struct spec_solar_day day = day_of(&london, "2023-06-21T00:30:00+01:00");
	struct spec_solar_day late = day_of(&london, "2023-06-21T23:30:00+01:00");

	(void)state;
	at(&day.sunrise, "2023-06-21T04:43:00+01:00", 31);
	at(&day.noon, "2023-06-21T13:02:00+01:00", 31);
	at(&day.sunset, "2023-06-21T21:21:00+01:00", 32);
	near(spec_instant_between(&day.noon, &late.noon), 0, .01, "the same day");
	day = day_of(&golden, "2003-10-17T12:30:30-07:00");
	at(&day.sunrise, "2003-10-17T06:12:43-07:00", 1.5);
	at(&day.noon, "2003-10-17T11:46:05-07:00", 1);
	day = day_of(&golden, "2003-10-16T12:30:30-07:00");
	at(&day.sunset, "2003-10-16T17:20:19-07:00", 1.5);
}

/* At its edges the sun is 50' below the horizon, and at noon on the meridian. */
static void
edges_are_where_the_sun_says(void **state)
{
	static const double latitude_deg[] = {-66, -40, 0, 23.4, 52, 66.3};

	(void)state;
	for (size_t i = 0; i < COUNT(latitude_deg); i++) {
		struct spec_place place = {latitude_deg[i], 11, 200};
		struct spec_solar_day day = day_of(&place, "2026-12-10T12:00:00+01:00");
		struct spec_solar solar;

		assert_true(day.rises && day.sets);
		spec_solar_position(&place, &day.sunrise, NULL, &solar, NULL);
		near(solar.zenith_deg, 90 + 50. / 60, 1e-5, "sunrise");
		assert_true(solar.azimuth_deg < 180);
		spec_solar_position(&place, &day.sunset, NULL, &solar, NULL);
		near(solar.zenith_deg, 90 + 50. / 60, 1e-5, "sunset");
		assert_true(solar.azimuth_deg > 180);
		spec_solar_position(&place, &day.noon, NULL, &solar, NULL);
		near(solar.hour_angle_deg, 0, 1e-5, "noon");
		near(day.noon_zenith_deg, solar.zenith_deg, 1e-5, "noon's zenith");
		assert_true(spec_instant_between(&day.sunrise, &day.noon) > 0);
		assert_true(spec_instant_between(&day.noon, &day.sunset) > 0);
	}
}

/* Before August 1961 UTC jumped ahead by .05 s: at this place noon is between. */
static void
noon_is_found_where_utc_skips_it(void **state)
{
	struct spec_place place = {10, -178.4329, 0};
	struct spec_solar_day day = day_of(&place, "1961-08-01T12:00:00+12:00");
	struct spec_solar solar;

	(void)state;
	assert_int_equal(
		spec_solar_position(&place, &day.noon, NULL, &solar, NULL), SPEC_OK);
	near(solar.hour_angle_deg, 0, .05 / 240, "noon");
	near(day.noon_zenith_deg, solar.zenith_deg, 1e-5, "noon's zenith");
}

static void
poles_have_days_and_nights_of_their_own(void **state)
{
	struct spec_place cape = {71.17, 25.78, 0}, pole = {-90, 0, 0};
	struct spec_solar_day day = day_of(&cape, "2026-06-20T12:00:00+02:00");

	(void)state;
	assert_int_equal(day.kind, SPEC_DAY_POLAR_DAY);
	assert_false(day.rises || day.sets);
	assert_int_equal(
		day_of(&cape, "2026-12-20T12:00:00+01:00").kind, SPEC_DAY_POLAR_NIGHT);
	assert_int_equal(day_of(&pole, "2026-12-20T12:00:00Z").kind, SPEC_DAY_POLAR_DAY);
	assert_int_equal(day_of(&pole, "2026-06-20T12:00:00Z").kind, SPEC_DAY_POLAR_NIGHT);
	/* All day with its middle below the horizon, and its edge above it. */
	assert_int_equal(day_of(&pole, "2026-03-21T18:00:00Z").kind, SPEC_DAY_POLAR_DAY);
}

/* One meridian with two names, and dates: the sun is the same at the same instant. */
static void
antimeridian_is_one(void **state)
{
	struct spec_place east = {10, 180, 0}, west = {10, -180, 0};
	struct spec_solar_day day;
	struct spec_solar one = solar_of(&east, "2026-05-01T12:00:00+12:00", NULL),
			  other = solar_of(&west, "2026-04-30T12:00:00-12:00", NULL);

	(void)state;
	near(one.azimuth_deg, other.azimuth_deg, 1e-9, "azimuth");
	near(one.zenith_deg, other.zenith_deg, 1e-9, "zenith");
	day = day_of(&east, "2026-05-01T12:00:00+12:00");
	at(&day.noon, "2026-05-01T11:57:10+12:00", 20);
}

int
main(void)
{
	const struct CMUnitTest tests[] = {
		cmocka_unit_test(sun_is_where_the_paper_has_it),
		cmocka_unit_test(sun_is_where_meeus_has_it),
		cmocka_unit_test(sun_is_where_the_almanac_has_it),
		cmocka_unit_test(what_follows_from_the_sun_is_consistent),
		cmocka_unit_test(air_is_the_standard),
		cmocka_unit_test(light_is_bent_and_dimmed),
		cmocka_unit_test(wrong_numbers_are_refused),
		cmocka_unit_test(sun_rises_and_sets_as_in_the_paper),
		cmocka_unit_test(sun_rises_and_sets_as_in_almanacs),
		cmocka_unit_test(edges_are_where_the_sun_says),
		cmocka_unit_test(noon_is_found_where_utc_skips_it),
		cmocka_unit_test(poles_have_days_and_nights_of_their_own),
		cmocka_unit_test(antimeridian_is_one),
	};

	return cmocka_run_group_tests(tests, NULL, NULL);
}
