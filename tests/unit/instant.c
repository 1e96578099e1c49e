/* lib/place/instant: times in ISO 8601, and leap seconds. */
#include <stdio.h>
#include <stdlib.h>

#include "place/instant.h"

#include "check.h"
#include "instants.h"

static void
writes(const struct spec_instant *instant, int decimals, const char *wanted)
{
	char written[SPEC_INSTANT_WRITTEN];

	spec_instant_format(instant, decimals, written);
	assert_string_equal(written, wanted);
}

/* Reda & Andreas have this instant as JD 2452930.312847. */
static void
one_instant_in_every_spelling(void **state)
{
	static const char *const spelling[] = {"2003-10-17T12:30:30-07:00",
		"2003-10-17 12:30:30-0700", "2003-10-17t12:30:30.0-07",
		"20031017T123030-0700", "2003-290T19:30:30Z", "2003290T193030z",
		"2003-10-17T19:30:30,000Z", "2003-10-18T01:15:30+05:45",
		"2003-10-17T19:30:30-00:00"};

	(void)state;
	for (size_t i = 0; i < COUNT(spelling); i++) {
		struct spec_instant instant = instant_of(spelling[i]);

		near(instant.utc1 + instant.utc2, 2452930.312847, 5e-7, spelling[i]);
		assert_int_equal(instant.leap, SPEC_LEAP_KNOWN);
	}
	near(instant_of("2003-10-17T12:30Z").utc2 * 86400, 45000, 1e-6, "no seconds");
	near(instant_of("20031017T1230Z").utc2 * 86400, 45000, 1e-6, "no seconds, basic");
	near(instant_of("2003-10-17T12:30:00.25Z").utc2 * 86400, 45000.25, 1e-6,
		"a quarter");
}

static void
instants_are_written(void **state)
{
	static const char *const text[] = {"2003-10-17T12:30:30-07:00",
		"2003-12-31T23:59:59+05:45", "2004-02-29T00:00:00Z", "2016-12-31T23:59:60Z",
		"2016-12-31T18:59:60-05:00", "2017-01-01T05:44:60+05:45",
		"1900-01-01T00:00:00Z", "2100-12-31T23:59:59Z"};
	struct spec_instant instant;

	(void)state;
	for (size_t i = 0; i < COUNT(text); i++) {
		instant = instant_of(text[i]);
		writes(&instant, 0, text[i]);
	}
	instant = instant_of("2003-12-31T23:59:59.6-07:00");
	writes(&instant, 0, "2004-01-01T00:00:00-07:00");
	writes(&instant, 2, "2003-12-31T23:59:59.60-07:00");
	instant = instant_of("2000-366T12:00Z");
	writes(&instant, 0, "2000-12-31T12:00:00Z");
}

/* What a file may say, and ISO 8601 cannot: local mean time of Amsterdam. */
static void
zones_have_seconds(void **state)
{
	static const struct spec_reading reading = {1930, 6, 1, 0, 10, 0, 19 * 60 + 32};
	struct spec_instant instant = instant_of("1930-06-01T12:00:00Z");

	(void)state;
	instant.offset_s = 19 * 60 + 32;
	writes(&instant, 0, "1930-06-01T12:19:32+00:19:32");
	assert_int_equal(spec_instant_from_reading(&reading, &instant, NULL), SPEC_OK);
	writes(&instant, 0, "1930-06-01T00:10:00+00:19:32");
	instant.offset_s = 0;
	writes(&instant, 0, "1930-05-31T23:50:28Z");
}

static void
days_are_counted_where_the_clock_is(void **state)
{
	static const struct {
		const char *text;
		int day;
	} days[] = {{"2003-10-17T12:30:30-07:00", 290},
		{"2004-12-31T23:59:59.5-07:00", 366}, {"2003-12-31T23:00:00-07:00", 365},
		{"2003-01-01T00:30:00+12:00", 1}};

	(void)state;
	for (size_t i = 0; i < COUNT(days); i++) {
		struct spec_instant instant = instant_of(days[i].text);

		assert_int_equal(spec_instant_day_of_year(&instant), days[i].day);
	}
}

static void
offsets_are_at_most_a_day(void **state)
{
	struct spec_reading reading = {2003, 10, 17, 12, 30, 30, 86400};
	struct spec_error error = {0};
	struct spec_instant instant;

	(void)state;
	assert_int_equal(spec_instant_from_reading(&reading, &instant, &error), SPEC_OK);
	for (int sign = -1; sign <= 1; sign += 2) {
		reading.offset_s = sign * 86401;
		assert_int_equal(
			spec_instant_from_reading(&reading, &instant, &error), SPEC_ERANGE);
		assert_contains(error.message, "an offset from UTC is at most a day");
	}
}

static void
nonsense_is_refused(void **state)
{
	static const char *const text[][2] = {
		{"", "'' is no time: write it as in 2003-10-17T12:30:30-07:00"},
		{"noon", "'noon' is no time"},
		{"2003-10-17", "'2003-10-17' has no time of day"},
		{"2003-10-17T12:30:30", "does not say in which zone: end it with Z"},
		{"2003-10-17T12:30", "does not say in which zone"},
		{"2003-10-17T12", "its time of day is not hh:mm"},
		{"2003-10-17T12:30:Z", "its time of day is not hh:mm"},
		{"2003-10-17T12:30:30.Z", "its time of day is not hh:mm"},
		{"2003-10-17_12:30Z", "its time of day is not hh:mm"},
		{"2003-10-17T12:30:30+", "neither Z nor an offset"},
		{"2003-10-17T12:30:30+7", "neither Z nor an offset"},
		{"2003-10-17T12:30:30+07:60", "neither Z nor an offset"},
		{"2003-10-17T12:30:30+24:00", "neither Z nor an offset"},
		{"2003-10-17T12:30:30+07:00x", "neither Z nor an offset"},
		{"2003-10-17T12:30:30Zulu", "neither Z nor an offset"},
		{"2003-10-17T12:30:30 CET", "neither Z nor an offset"},
		{"2003-13-17T12:30:30Z", "the calendar has no such day"},
		{"2003-00-17T12:30:30Z", "the calendar has no such day"},
		{"2003-02-29T12:30:30Z", "the calendar has no such day"},
		{"1900-366T12:30:30Z", "the calendar has no such day"},
		{"2003-366T12:30:30Z", "the calendar has no such day"},
		{"2003-000T12:30:30Z", "the calendar has no such day"},
		{"2003-10-17T24:30:30Z", "the clock does not read such a time"},
		{"2003-10-17T12:60:30Z", "the clock does not read such a time"},
		{"2003-10-17T12:30:61Z", "the clock does not read such a time"},
		{"2003-10-17T12:30:60Z", "that was no leap second"},
		{"2015-12-31T23:59:60Z", "that was no leap second"},
		{"2016-12-31T23:59:60-05:00", "that was no leap second"},
		{"1899-10-17T12:30:30Z", "known from 1900 to 2100, not in 1899"},
		{"2101-10-17T12:30:30Z", "known from 1900 to 2100, not in 2101"},
		{"12003-10-17T12:30:30Z", "is no time"},
	};

	(void)state;
	for (size_t i = 0; i < COUNT(text); i++) {
		struct spec_error error = {0};
		struct spec_instant instant;

		assert_int_not_equal(
			spec_instant_parse(text[i][0], &instant, &error), SPEC_OK);
		assert_contains(error.message, text[i][1]);
	}
}

/* IERS Bulletin C 52 (2016), and the table of UTC's steps since 1972. */
static void
leap_seconds_are_counted(void **state)
{
	struct spec_instant before = instant_of("2016-12-31T23:59:59Z"),
			    after = spec_instant_later(&before, 2);
	int year, month;

	(void)state;
	writes(&after, 0, "2017-01-01T00:00:00Z");
	near(spec_instant_between(&before, &after), 2, 1e-6, "between");
	near(spec_instant_tai_utc(&before), 36, 0, "before");
	near(spec_instant_tai_utc(&after), 37, 0, "after");
	after = spec_instant_later(&before, 1);
	writes(&after, 0, "2016-12-31T23:59:60Z");
	after = spec_instant_later(&before, -1);
	writes(&after, 0, "2016-12-31T23:59:58Z");
	before = instant_of("1972-01-01T00:00:00Z");
	near(spec_instant_tai_utc(&before), 10, 0, "1972");
	spec_instant_last_leap(&year, &month);
	assert_true(year * 12 + month >= 2017 * 12 + 1);
}

static void
the_tables_ends_are_told(void **state)
{
	(void)state;
	assert_int_equal(instant_of("1959-12-31T00:00:00Z").leap, SPEC_LEAP_BEFORE);
	assert_int_equal(instant_of("1960-01-01T00:00:00Z").leap, SPEC_LEAP_KNOWN);
	assert_int_equal(instant_of("2021-01-01T00:00:00Z").leap, SPEC_LEAP_KNOWN);
	assert_int_equal(instant_of("2099-01-01T00:00:00Z").leap, SPEC_LEAP_AFTER);
}

/* TT - TAI is 32.184 s (IAU 1991). */
static void
terrestrial_time_is_atomic(void **state)
{
	struct spec_instant instant = instant_of("2003-10-17T19:30:30Z");
	double tt[2];

	(void)state;
	spec_instant_terrestrial(&instant, tt);
	near(((tt[0] - instant.utc1) + (tt[1] - instant.utc2)) * 86400, 32 + 32.184, 1e-6,
		"TT - UTC");
}

int
main(void)
{
	const struct CMUnitTest tests[] = {
		cmocka_unit_test(one_instant_in_every_spelling),
		cmocka_unit_test(instants_are_written),
		cmocka_unit_test(zones_have_seconds),
		cmocka_unit_test(days_are_counted_where_the_clock_is),
		cmocka_unit_test(offsets_are_at_most_a_day),
		cmocka_unit_test(nonsense_is_refused),
		cmocka_unit_test(leap_seconds_are_counted),
		cmocka_unit_test(the_tables_ends_are_told),
		cmocka_unit_test(terrestrial_time_is_atomic),
	};

	return cmocka_run_group_tests(tests, NULL, NULL);
}
