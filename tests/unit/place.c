/* lib/place: coordinates, instants and the sun. */
#include <stdio.h>
#include <stdlib.h>

#include "place/coordinates.h"
#include "place/instant.h"
#include "place/sun.h"

#include "check.h"

#define ARCSECOND (1. / 3600)

static struct spec_place
place_of(const char *text)
{
	struct spec_error error = {0};
	struct spec_place place;

	if (spec_place_parse(text, &place, &error) != SPEC_OK)
		fail_msg("%s", error.message);
	return place;
}

static struct spec_instant
instant_of(const char *text)
{
	struct spec_error error = {0};
	struct spec_instant instant;

	if (spec_instant_parse(text, &instant, &error) != SPEC_OK)
		fail_msg("%s", error.message);
	return instant;
}

/*
 * Reda & Andreas: Solar position algorithm for solar radiation applications. NREL/TP-560-34302,
 * 2003, revised 2008, table A5.1 and appendix A.4. Tolerances: 1.1" for VSOP87 as the paper
 * cuts it against ERFA's orbit, and their UT1, which is 2.8 s of TT off ours: under .1".
 */
static void
sun_is_where_the_paper_has_it(void **state)
{
	static const struct spec_air air = {820, 11};
	struct spec_place place = place_of("39.742476 -105.1786 1830.14m");
	struct spec_instant instant = instant_of("2003-10-17T12:30:30-07:00");
	struct spec_solar solar;

	(void)state;
	assert_int_equal(
		spec_solar_position(&place, &instant, &air, &solar, NULL), SPEC_OK);
	near(solar.zenith_deg, 90 - 39.872046, 1.1 * ARCSECOND, "zenith, airless");
	near(solar.zenith_refracted_deg, 50.11162, 1.1 * ARCSECOND, "zenith, refracted");
	near(solar.azimuth_deg, 194.34024, 1.1 * ARCSECOND / sin(50.1 / 57.29578),
		"azimuth");
	near(solar.declination_deg, -9.316179, 1.1 * ARCSECOND, "declination");
	near(solar.hour_angle_deg, 11.10629, 1.1 * ARCSECOND, "hour angle");
	near(solar.distance_au, .9965422974, 2e-7, "distance");
	/* Their mean sun is that of TT, 67 s before UT1's, and goes 0.9856474 deg a day. */
	near(solar.equation_of_time_min, 14.641503 - 67 * .9856474 / 86400 * 4,
		1.1 * ARCSECOND * 4, "equation of time");
}

int
main(void)
{
	const struct CMUnitTest tests[] = {
		cmocka_unit_test(sun_is_where_the_paper_has_it),
	};

	return cmocka_run_group_tests(tests, NULL, NULL);
}
