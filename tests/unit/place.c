/* lib/place: coordinates, and what files say of places and times. */
#include <stdio.h>
#include <stdlib.h>

#include "image/image.h"
#include "place/coordinates.h"
#include "place/placed.h"

#include "check.h"

static struct spec_place
place_of(const char *text)
{
	struct spec_error error = {0};
	struct spec_place place;

	if (spec_place_parse(text, &place, &error) != SPEC_OK)
		fail_msg("%s", error.message);
	return place;
}

/*
 * The bridge at Ar Ramadi in the spellings that GeographicLib's reference lists for its class
 * GeoCoords, and in those that it refuses for their spaces. MGRS squares have sides of 10 m
 * to 1 km; half of one is .0045 deg.
 */
static void
places_are_read_in_every_spelling(void **state)
{
	static const struct {
		const char *text;
		double tolerance_deg;
	} spellings[] = {
		{"33.44 43.27", 1e-12},
		{"33.44, 43.27", 1e-12},
		{"33.44,43.27", 1e-12},
		{"N33d26.4' E43d16.2'", 1e-12},
		{"43d16'12\"E 33d26'24\"N", 1e-12},
		{"43:16:12E 33:26:24", 1e-12},
		{"33\u00b026\u203224\u2033N 43\u00b016\u203212\u2033E", 1e-12},
		{"33.44 N 43.27 E", 1e-12},
		{"43.27 e, 33.44 n", 1e-12},
		{"N 33.44 E 43.27", 1e-12},
		{"33d 26' 24\" N 43d 16' 12\" E", 1e-12},
		{"33\u00b0 26\u2032 24\u2033 N, 43\u00b0 16\u2032 12\u2033 E", 1e-12},
		{"38n 339188 3701405", 1e-4},
		{"897039 3708229 37n", 1e-4},
		{"38SLC3918701405", 1e-4},
		{"38SLC391014", .002},
		{"37SHT9708", .01},
	};

	(void)state;
	for (size_t i = 0; i < COUNT(spellings); i++) {
		struct spec_place place = place_of(spellings[i].text);

		near(place.latitude_deg, 33.44, spellings[i].tolerance_deg,
			spellings[i].text);
		near(place.longitude_deg, 43.27, spellings[i].tolerance_deg,
			spellings[i].text);
		assert_true(place.altitude_m == 0);
	}
}

static void
altitudes_are_read(void **state)
{
	(void)state;
	near(place_of("33.44 43.27 1830.14m").altitude_m, 1830.14, 0, "m");
	near(place_of("33.44 N, 43.27 E, -420 m").altitude_m, -420, 0, "m, with spaces");
	near(place_of("38SLC3918701405 1.5km").altitude_m, 1500, 0, "km, after MGRS");
	near(place_of("38n 339188 3701405 2 km").altitude_m, 2000, 0, "km, after UTM");
	near(place_of("33.44 N, 43.27 E, 2 km").longitude_deg, 43.27, 1e-12, "longitude");
}

/* The south pole in UPS has its zone as a letter that belongs to nothing else. */
static void
poles_and_the_antimeridian_are_places(void **state)
{
	(void)state;
	near(place_of("90N 0").latitude_deg, 90, 0, "north pole");
	near(place_of("s 2000000 2000000").latitude_deg, -90, 1e-9, "south pole, UPS");
	near(place_of("2000000 2000000 n").latitude_deg, 90, 1e-9, "north pole, UPS");
	near(fabs(place_of("10 180").longitude_deg), 180, 0, "antimeridian");
	near(fabs(place_of("10 180W").longitude_deg), 180, 0, "antimeridian from the east");
	near(place_of("10 190").longitude_deg, -170, 1e-12, "beyond it");
}

static void
nonsense_is_refused(void **state)
{
	static const char *const text[][2] = {
		{"", "'' is no place: write it as in"},
		{"   ", "is no place"},
		{"here", "'here' is no place"},
		{"91N 5E", "'91N 5E' is no place: Latitude 91d not in [-90d, 90d]"},
		{"39.74", "'39.74' is half a place: a latitude and a longitude make one"},
		{"1 2 3 4", "is no place"},
		{"50.88N", "'50.88N' is half a place"},
		{"E4d42'", "'E4d42'' is half a place"},
		{"5E 6W", "is no place"},
		{"5 N 6 N", "is no place"},
		{"40:61 50", "is no place: Minutes 61"},
		{"38IMB", "is no place"},
		{"40 nan", "a longitude is from -180 to 180 degrees, not nan"},
		{"nan 40", "a latitude is from -90 to 90 degrees, not nan"},
		{"inf 40", "is no place"},
		{"40 50 200km", "the altitude in km is outside -12..100: '200'"},
		{"40 50 2e5m", "the altitude in m is outside -12000..100000: '2e5'"},
		{"40 50 xm", "the altitude in m is not a number"},
		{"1,2,3,4,5,6,7,8,9,0,1,2,3,4,5,6,7,8", "is no place"},
	};
	char longest[400];

	(void)state;
	for (size_t i = 0; i < COUNT(text); i++) {
		struct spec_error error = {0};
		struct spec_place place;

		assert_int_not_equal(spec_place_parse(text[i][0], &place, &error), SPEC_OK);
		assert_contains(error.message, text[i][1]);
		assert_null(strchr(error.message, '\n'));
	}
	memset(longest, '1', sizeof longest);
	longest[sizeof longest - 1] = '\0';
	assert_int_equal(
		spec_place_parse(longest, &(struct spec_place){0}, NULL), SPEC_EUSAGE);
}

static void
places_are_written_as_they_are_read(void **state)
{
	static const char *const written[SPEC_PLACE_FORMS] = {"33.440000 43.270000",
		"33d26'24.00\"N 043d16'12.00\"E", "38n 339188 3701405", "38SLC3918701405"};
	struct spec_place place = place_of("33.44 43.27");

	(void)state;
	for (int i = 0; i < SPEC_PLACE_FORMS; i++) {
		char text[SPEC_PLACE_WRITTEN];
		struct spec_place again;

		assert_int_equal(spec_place_format(&place, i, text, NULL), SPEC_OK);
		assert_string_equal(text, written[i]);
		again = place_of(text);
		near(again.latitude_deg, place.latitude_deg, 1e-5, text);
		near(again.longitude_deg, place.longitude_deg, 1e-5, text);
	}
}

/* Mount Everest in the examples of GeographicLib's reference for its class Geocentric. */
static void
places_are_in_the_earths_frame(void **state)
{
	struct spec_place place = place_of("27.99 86.93 8820m"), again;
	double xyz_m[3], axes[9];

	(void)state;
	assert_int_equal(spec_place_to_earth(&place, xyz_m, axes, NULL), SPEC_OK);
	near(xyz_m[0], 302271.4, .05, "x");
	near(xyz_m[1], 5635928.4, .05, "y");
	near(xyz_m[2], 2979666.1, .05, "z");
	near(axes[8], sin(place.latitude_deg / 57.29577951308232), 1e-12, "up, z");
	near(axes[3], cos(place.longitude_deg / 57.29577951308232), 1e-12, "east, y");
	assert_int_equal(spec_place_from_earth(xyz_m, &again, NULL), SPEC_OK);
	near(again.latitude_deg, place.latitude_deg, 1e-11, "latitude");
	near(again.longitude_deg, place.longitude_deg, 1e-11, "longitude");
	near(again.altitude_m, 8820, 1e-6, "altitude");
}

/* Calais from Paris, in its reference for the class LocalCartesian. */
static void
places_are_in_a_local_frame(void **state)
{
	struct spec_place paris = place_of("48:50 2:20"), calais = place_of("50.9 1.8"),
			  there;
	double enu_m[3];
	static const double back_m[3] = {-38e3, 230e3, -4e3};

	(void)state;
	assert_int_equal(spec_place_to_local(&paris, &calais, enu_m, NULL), SPEC_OK);
	near(enu_m[0], -37518.64, .01, "east");
	near(enu_m[1], 229949.65, .01, "north");
	near(enu_m[2], -4260.43, .01, "up");
	assert_int_equal(spec_place_from_local(&paris, back_m, &there, NULL), SPEC_OK);
	near(there.latitude_deg, 50.9003, 5e-5, "latitude");
	near(there.longitude_deg, 1.79318, 5e-6, "longitude");
	near(there.altitude_m, 264.915, 5e-4, "altitude");
}

/*
 * Karney: Algorithms for geodesics. Journal of Geodesy 87, 2013, 43-55, tables 2 (direct) and
 * 4 (inverse, near the antipodes).
 */
static void
ways_are_geodesics(void **state)
{
	struct spec_place from = {40, 0, 0}, to;
	struct spec_geodesic way;

	(void)state;
	assert_int_equal(spec_place_onwards(&from, 30, 10e6, &to, NULL), SPEC_OK);
	near(to.latitude_deg, 41.79331020506, 1e-11, "latitude");
	near(to.longitude_deg, 137.84490004377, 1e-11, "longitude");
	assert_int_equal(spec_place_geodesic(&from, &to, &way, NULL), SPEC_OK);
	near(way.distance_m, 10e6, 1e-6, "distance");
	near(way.bearing_deg, 30, 1e-11, "bearing");
	near(way.arrival_deg, 149.09016931807, 1e-11, "arrival");
	from = (struct spec_place){-30, 0, 0};
	to = (struct spec_place){29.9, 179.8, 0};
	assert_int_equal(spec_place_geodesic(&from, &to, &way, NULL), SPEC_OK);
	near(way.distance_m, 19989832.827610, 1e-6, "distance to the antipodes");
	near(way.bearing_deg, 161.890524736, 1e-9, "bearing to the antipodes");
	/* Westwards over the antimeridian. */
	from = (struct spec_place){0, -179, 0};
	to = (struct spec_place){0, 179, 0};
	assert_int_equal(spec_place_geodesic(&from, &to, &way, NULL), SPEC_OK);
	near(way.bearing_deg, 270, 1e-12, "bearing to the west");
	near(way.distance_m, 6378137 * 2 / 57.29577951308232, 1e-6, "along the equator");
}

static void
wrong_numbers_are_refused(void **state)
{
	static const struct spec_place wrong[] = {{91, 0, 0}, {0, 181, 0}, {0, 0, 2e5},
		{NAN, 0, 0}, {0, NAN, 0}, {0, 0, NAN}, {0, 0, -13e3}};
	static const double deep[3] = {0, 0, 1e6};
	struct spec_place place = {0}, to;
	struct spec_geodesic way;
	double xyz_m[3];
	char text[SPEC_PLACE_WRITTEN];

	(void)state;
	for (size_t i = 0; i < COUNT(wrong); i++) {
		const struct spec_place *at = &wrong[i];

		assert_int_equal(spec_place_format(at, 0, text, NULL), SPEC_ERANGE);
		assert_int_equal(spec_place_to_earth(at, xyz_m, NULL, NULL), SPEC_ERANGE);
		assert_int_equal(spec_place_to_local(at, &place, xyz_m, NULL), SPEC_ERANGE);
		assert_int_equal(spec_place_to_local(&place, at, xyz_m, NULL), SPEC_ERANGE);
		assert_int_equal(spec_place_from_local(at, xyz_m, &to, NULL), SPEC_ERANGE);
		assert_int_equal(spec_place_geodesic(at, &place, &way, NULL), SPEC_ERANGE);
		assert_int_equal(spec_place_geodesic(&place, at, &way, NULL), SPEC_ERANGE);
		assert_int_equal(spec_place_onwards(at, 0, 1, &to, NULL), SPEC_ERANGE);
	}
	assert_int_equal(spec_place_from_earth(deep, &to, NULL), SPEC_ERANGE);
	assert_int_equal(spec_place_onwards(&place, NAN, 1, &to, NULL), SPEC_ERANGE);
}

static void
set_text(struct spec_image *image, const char *name, const char *text)
{
	assert_int_equal(spec_image_set_text(image, name, text, NULL), SPEC_OK);
}

static void
set_number(struct spec_image *image, const char *name, float value)
{
	assert_int_equal(
		spec_image_set_attribute(image, name, "float", &value, sizeof value, NULL),
		SPEC_OK);
}

static float
number_of(const struct spec_image *image, const char *name)
{
	const struct spec_attribute *attribute = spec_image_attribute(image, name);
	float value;

	assert_non_null(attribute);
	assert_string_equal(attribute->type, "float");
	memcpy(&value, attribute->value, sizeof value);
	return value;
}

/* OpenEXR's ImfStandardAttributes.h: UTC == local time + utcOffset. */
static void
files_say_where_and_when(void **state)
{
	struct spec_image image = {0};
	struct spec_place place = place_of("39.742476 -105.1786 1830.14m"), back;
	struct spec_instant instant, again;
	char *text = NULL, written[SPEC_INSTANT_WRITTEN];

	(void)state;
	assert_int_equal(
		spec_instant_parse("2003-10-17T12:30:29.6-07:00", &instant, NULL), SPEC_OK);
	assert_int_equal(spec_placed_set(&image, &place, &instant, NULL), SPEC_OK);
	near(number_of(&image, "longitude"), -105.1786, 4e-6, "longitude");
	near(number_of(&image, "latitude"), 39.742476, 2e-6, "latitude");
	near(number_of(&image, "altitude"), 1830.14, 1e-4, "altitude");
	near(number_of(&image, "utcOffset"), 7 * 3600, 0, "utcOffset");
	assert_int_equal(spec_image_text(&image, "capDate", &text, NULL), SPEC_OK);
	assert_string_equal(text, "2003:10:17 12:30:30");
	free(text);
	assert_int_equal(
		spec_placed_of_image(&image, "a.exr", &back, &again, NULL), SPEC_OK);
	near(back.longitude_deg, -105.1786, 4e-6, "longitude, read");
	near(back.altitude_m, 1830.14, 1e-4, "altitude, read");
	spec_instant_format(&again, 0, written);
	assert_string_equal(written, "2003-10-17T12:30:30-07:00");
	/* A place of unknown altitude takes that of another place away. */
	place.altitude_m = 0;
	assert_int_equal(spec_placed_set(&image, &place, NULL, NULL), SPEC_OK);
	assert_null(spec_image_attribute(&image, "altitude"));
	spec_image_clear(&image);
}

static void
refuses(const struct spec_image *image, enum spec_status wanted, const char *message)
{
	struct spec_error error = {0};
	struct spec_place place;
	struct spec_instant instant;

	assert_int_equal(
		spec_placed_of_image(image, "a.exr", &place, &instant, &error), wanted);
	assert_string_equal(error.message, message);
}

static void
files_that_do_not_say_it_are_told(void **state)
{
	struct spec_image image = {0};

	(void)state;
	refuses(&image, SPEC_EUSAGE,
		"a.exr: does not say where it was taken: it has no attribute longitude");
	set_number(&image, "longitude", 200);
	refuses(&image, SPEC_EUSAGE,
		"a.exr: does not say where it was taken: it has no attribute latitude");
	set_number(&image, "latitude", 50);
	refuses(&image, SPEC_ERANGE,
		"a.exr: a longitude is from -180 to 180 degrees, not 200");
	set_text(&image, "longitude", "5");
	refuses(&image, SPEC_EFORMAT,
		"a.exr: its attribute longitude is of type string, not float");
	set_number(&image, "longitude", 5);
	refuses(&image, SPEC_EUSAGE,
		"a.exr: does not say when it was taken: it has no attribute capDate");
	set_text(&image, "capDate", "2003-10-17 12:30:30");
	refuses(&image, SPEC_EFORMAT,
		"a.exr: its capDate, '2003-10-17 12:30:30', is not YYYY:MM:DD hh:mm:ss");
	set_text(&image, "capDate", "2003:10:17 12:30:30");
	refuses(&image, SPEC_EUSAGE,
		"a.exr: does not say in which zone it was taken: it has no attribute utcOffset");
	set_number(&image, "utcOffset", NAN);
	refuses(&image, SPEC_ERANGE,
		"a.exr: its utcOffset is nan s, and none is more than a day");
	set_number(&image, "utcOffset", -3600);
	set_text(&image, "capDate", "2003:13:17 12:30:30");
	refuses(&image, SPEC_EUSAGE, "a.exr: its capDate: the calendar has no such day");
	spec_image_clear(&image);
}

int
main(void)
{
	const struct CMUnitTest tests[] = {
		cmocka_unit_test(places_are_read_in_every_spelling),
		cmocka_unit_test(altitudes_are_read),
		cmocka_unit_test(poles_and_the_antimeridian_are_places),
		cmocka_unit_test(nonsense_is_refused),
		cmocka_unit_test(places_are_written_as_they_are_read),
		cmocka_unit_test(places_are_in_the_earths_frame),
		cmocka_unit_test(places_are_in_a_local_frame),
		cmocka_unit_test(ways_are_geodesics),
		cmocka_unit_test(wrong_numbers_are_refused),
		cmocka_unit_test(files_say_where_and_when),
		cmocka_unit_test(files_that_do_not_say_it_are_told),
	};

	return cmocka_run_group_tests(tests, NULL, NULL);
}
