/*
 * Instants: ISO 8601 with an offset from UTC, to and from UTC as ERFA counts it. Leap
 * seconds are those of ERFA's table, and every instant says whether the table knows it.
 */
#ifndef SPEC_PLACE_INSTANT_H
#define SPEC_PLACE_INSTANT_H

#include <stddef.h>

#include "base/error.h"

#define SPEC_INSTANT_WRITTEN 40 /* bytes that every instant fits in, written */

/* Half the clock and more: no zone was ever further from UTC. */
#define SPEC_INSTANT_FURTHEST_S (24 * 3600)

enum spec_leap_seconds {
	SPEC_LEAP_KNOWN,
	SPEC_LEAP_BEFORE, /* before 1960 there was no UTC: it is UT, and TT a minute off */
	SPEC_LEAP_AFTER   /* ERFA's table is too old to tell: as if none came since */
};

struct spec_instant {
	double utc1, utc2; /* their sum is ERFA's quasi Julian date of UTC [d] */
	int offset_s;      /* east of Greenwich: local time = UTC + offset */
	enum spec_leap_seconds leap;
};

/* A calendar's and a clock's reading at an offset. */
struct spec_reading {
	int year, month, day, hour, minute;
	double second; /* to 61 within a leap second */
	int offset_s;
};

/*
 * Reads "2003-10-17T12:30:30-07:00", the basic form "20031017T123030-0700", days of the
 * year "2003-290T19:30:30Z"; seconds, and their decimals after a point or comma, may be
 * missing, the zone may not: Z or an offset. "now" is the system's time and zone. Leap
 * seconds are read where there was one. SPEC_EUSAGE says what is wrong; SPEC_ERANGE:
 * years from 1900 to 2100 alone.
 */
enum spec_status spec_instant_parse(
	const char *text, struct spec_instant *instant, struct spec_error *error);

enum spec_status spec_instant_from_reading(const struct spec_reading *reading,
	struct spec_instant *instant, struct spec_error *error);

/* The reading at its own offset, rounded to a number of decimals of the second, 0 to 6. */
struct spec_reading spec_instant_reading(const struct spec_instant *instant, int decimals);

/* ISO 8601 with the offset, "Z" where it is 0: "2003-10-17T12:30:30-07:00". */
void spec_instant_format(const struct spec_instant *instant, int decimals,
	char written[SPEC_INSTANT_WRITTEN]);

/* The day of the year there, 1 to 366. */
int spec_instant_day_of_year(const struct spec_instant *instant);

/* So many seconds of TAI later, at the same offset. */
struct spec_instant spec_instant_later(const struct spec_instant *instant, double seconds);

/* Seconds of TAI from one to the other. */
double spec_instant_between(const struct spec_instant *from, const struct spec_instant *to);

/* Terrestrial time as a Julian date in two parts [d], and TAI - UTC [s]. */
void spec_instant_terrestrial(const struct spec_instant *instant, double tt[2]);
double spec_instant_tai_utc(const struct spec_instant *instant);

/* The latest year and month of which ERFA's table of leap seconds has one. */
void spec_instant_last_leap(int *year, int *month);

#endif
