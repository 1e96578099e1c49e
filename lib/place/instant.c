#include "place/instant.h"

#include <ctype.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <time.h>

#include <erfa.h>
#include <erfaextra.h>
#include <erfam.h>

#define DAY_S 86400.0
#define ORDINAL (-1)    /* in place of a month: the day is that of the year */
#define FIRST_YEAR 1900 /* of the sun's ephemeris, eraEpv00 */
#define LAST_YEAR 2100
#define MJD_ZERO ERFA_DJM0

/* Reads a whole number of so many digits; 0 where they are not there. */
static int
take_digits(const char **at, int digits, int *value)
{
	*value = 0;
	for (int i = 0; i < digits; i++) {
		if (!isdigit((unsigned char)(*at)[i]))
			return 0;
		*value = 10 * *value + ((*at)[i] - '0');
	}
	*at += digits;
	return 1;
}

static int
take_mark(const char **at, char mark)
{
	if (**at != mark)
		return 0;
	++*at;
	return 1;
}

static size_t
count_digits(const char *at)
{
	return strspn(at, "0123456789");
}

/* By the calendar or by the day of the year. */
static int
take_date(const char **at, struct spec_reading *reading)
{
	int extended;

	if (!take_digits(at, 4, &reading->year))
		return 0;
	extended = take_mark(at, '-');
	if (count_digits(*at) == 3) {
		reading->month = ORDINAL;
		return take_digits(at, 3, &reading->day);
	}
	return take_digits(at, 2, &reading->month) && (!extended || take_mark(at, '-')) &&
	       take_digits(at, 2, &reading->day);
}

static int
take_clock(const char **at, struct spec_reading *reading)
{
	int extended, whole;
	double unit = 1;

	if (!take_digits(at, 2, &reading->hour))
		return 0;
	extended = take_mark(at, ':');
	if (!take_digits(at, 2, &reading->minute))
		return 0;
	if (extended ? !take_mark(at, ':') : !isdigit((unsigned char)**at))
		return 1;
	if (!take_digits(at, 2, &whole))
		return 0;
	reading->second = whole;
	if (**at != '.' && **at != ',')
		return 1;
	++*at;
	if (!isdigit((unsigned char)**at))
		return 0;
	for (; isdigit((unsigned char)**at); ++*at)
		reading->second += (**at - '0') * (unit /= 10);
	return 1;
}

/* To the end of the text. */
static int
take_zone(const char **at, struct spec_reading *reading)
{
	int sign = **at == '-' ? -1 : 1, hours = 0, minutes = 0;

	if (take_mark(at, 'Z') || take_mark(at, 'z'))
		return !**at;
	if (!take_mark(at, '+') && !take_mark(at, '-'))
		return 0;
	if (!take_digits(at, 2, &hours))
		return 0;
	if (**at && ((void)take_mark(at, ':'), !take_digits(at, 2, &minutes)))
		return 0;
	reading->offset_s = sign * (hours * 3600 + minutes * 60);
	return !**at && hours < 24 && minutes < 60;
}

/* The system's clock, in the zone of the environment. */
static enum spec_status
take_now(struct spec_instant *instant, struct spec_error *error)
{
	struct spec_reading reading;
	struct tm local;
	time_t now = time(NULL);

	if (now == (time_t)-1 || !localtime_r(&now, &local))
		return spec_error_set(error, SPEC_EIO, "the system does not tell the time");
	reading =
		(struct spec_reading){local.tm_year + 1900, local.tm_mon + 1, local.tm_mday,
			local.tm_hour, local.tm_min, local.tm_sec, (int)local.tm_gmtoff};
	return spec_instant_from_reading(&reading, instant, error);
}

enum spec_status
spec_instant_parse(const char *text, struct spec_instant *instant, struct spec_error *error)
{
	struct spec_reading reading = {0};
	const char *at = text;
	enum spec_status status;

	if (strcmp(text, "now") == 0)
		return take_now(instant, error);
	if (!take_date(&at, &reading))
		return spec_error_set(error, SPEC_EUSAGE,
			"'%s' is no time: write it as in 2003-10-17T12:30:30-07:00", text);
	if (!*at)
		return spec_error_set(error, SPEC_EUSAGE,
			"'%s' has no time of day: write it as in 2003-10-17T12:30:30-07:00",
			text);
	if ((*at != 'T' && *at != 't' && *at != ' ') || (at++, !take_clock(&at, &reading)))
		return spec_error_set(error, SPEC_EUSAGE,
			"'%s' is no time: its time of day is not hh:mm or hh:mm:ss", text);
	if (!*at)
		return spec_error_set(error, SPEC_EUSAGE,
			"'%s' does not say in which zone: end it with Z for UTC, or with "
			"an offset such as +01:00",
			text);
	if (!take_zone(&at, &reading))
		return spec_error_set(error, SPEC_EUSAGE,
			"'%s' is no time: what follows the time of day is neither Z nor "
			"an offset such as +01:00",
			text);
	status = spec_instant_from_reading(&reading, instant, error);
	if (status != SPEC_OK)
		spec_error_prefix(error, "'%s'", text);
	return status;
}

static int
is_leap_year(int year)
{
	return year % 4 == 0 && (year % 100 != 0 || year % 400 == 0);
}

/* The modified Julian date of its day, local. */
static enum spec_status
find_day(const struct spec_reading *reading, double *day, struct spec_error *error)
{
	double zero;

	if (reading->year < FIRST_YEAR || reading->year > LAST_YEAR)
		return spec_error_set(error, SPEC_ERANGE,
			"the sun's place is known from %d to %d, not in %d", FIRST_YEAR,
			LAST_YEAR, reading->year);
	if (reading->month == ORDINAL && reading->day >= 1 &&
		reading->day <= 365 + is_leap_year(reading->year)) {
		(void)eraCal2jd(reading->year, 1, 1, &zero, day);
		*day += reading->day - 1;
		return SPEC_OK;
	}
	if (eraCal2jd(reading->year, reading->month, reading->day, &zero, day) != 0)
		return spec_error_set(error, SPEC_EUSAGE, "the calendar has no such day");
	return SPEC_OK;
}

/* A second of 60 is one only where UTC has it, which the zone's minutes do not change. */
static enum spec_status
take_utc(double day, double minutes, double second, struct spec_instant *instant,
	struct spec_error *error)
{
	int year, month, date, status;
	double fraction;

	day += floor(minutes / 1440);
	minutes -= 1440 * floor(minutes / 1440);
	(void)eraJd2cal(MJD_ZERO, day, &year, &month, &date, &fraction);
	status = eraDtf2d("UTC", year, month, date, (int)(minutes / 60),
		(int)fmod(minutes, 60), second, &instant->utc1, &instant->utc2);
	if (status >= 2)
		return spec_error_set(error, SPEC_EUSAGE, "that was no leap second");
	if (status < 0)
		return spec_error_set(
			error, SPEC_EUSAGE, "the clock does not read such a time");
	instant->leap = eraDat(year, month, date, 0, &fraction) == 0 ? SPEC_LEAP_KNOWN
			: year < 1960                                ? SPEC_LEAP_BEFORE
								     : SPEC_LEAP_AFTER;
	return SPEC_OK;
}

enum spec_status
spec_instant_from_reading(const struct spec_reading *reading, struct spec_instant *instant,
	struct spec_error *error)
{
	int odd = reading->offset_s % 60, whole = reading->offset_s / 60;
	double day, minutes, second = reading->second;
	enum spec_status status = find_day(reading, &day, error);

	if (status != SPEC_OK)
		return status;
	if (reading->hour < 0 || reading->hour > 23 || reading->minute < 0 ||
		reading->minute > 59 || !(second >= 0 && second < 61))
		return spec_error_set(
			error, SPEC_EUSAGE, "the clock does not read such a time");
	if (abs(reading->offset_s) > SPEC_INSTANT_FURTHEST_S)
		return spec_error_set(error, SPEC_ERANGE,
			"an offset from UTC is at most a day, not %d s", reading->offset_s);
	minutes = reading->hour * 60.0 + reading->minute - whole;
	second -= odd;
	if (odd != 0) {
		minutes += floor(second / 60);
		second -= 60 * floor(second / 60);
	}
	instant->offset_s = reading->offset_s;
	return take_utc(day, minutes, second, instant, error);
}

struct spec_reading
spec_instant_reading(const struct spec_instant *instant, int decimals)
{
	struct spec_reading reading = {.offset_s = instant->offset_s};
	int odd = instant->offset_s % 60, whole = instant->offset_s / 60, fields[4] = {0};
	double zero, day, minutes, fraction;

	(void)eraD2dtf("UTC", decimals, instant->utc1, instant->utc2, &reading.year,
		&reading.month, &reading.day, fields);
	reading.second = fields[2] + fields[3] * pow(10, -decimals);
	minutes = fields[0] * 60.0 + fields[1] + whole;
	if (odd != 0) {
		reading.second += odd;
		minutes += floor(reading.second / 60);
		reading.second -= 60 * floor(reading.second / 60);
	}
	(void)eraCal2jd(reading.year, reading.month, reading.day, &zero, &day);
	day += floor(minutes / 1440);
	minutes -= 1440 * floor(minutes / 1440);
	(void)eraJd2cal(
		MJD_ZERO, day, &reading.year, &reading.month, &reading.day, &fraction);
	reading.hour = (int)(minutes / 60);
	reading.minute = (int)fmod(minutes, 60);
	return reading;
}

void
spec_instant_format(const struct spec_instant *instant, int decimals,
	char written[SPEC_INSTANT_WRITTEN])
{
	struct spec_reading reading = spec_instant_reading(instant, decimals);
	int offset = abs(reading.offset_s);
	size_t length = (size_t)snprintf(written, SPEC_INSTANT_WRITTEN,
		"%04d-%02d-%02dT%02d:%02d:%0*.*f", reading.year, reading.month, reading.day,
		reading.hour, reading.minute, decimals > 0 ? decimals + 3 : 2, decimals,
		reading.second);

	if (offset == 0) {
		(void)snprintf(written + length, SPEC_INSTANT_WRITTEN - length, "Z");
		return;
	}
	length += (size_t)snprintf(written + length, SPEC_INSTANT_WRITTEN - length,
		"%c%02d:%02d", reading.offset_s < 0 ? '-' : '+', offset / 3600,
		offset / 60 % 60);
	/* ISO 8601 has no seconds there; files may. */
	if (offset % 60 != 0)
		(void)snprintf(written + length, SPEC_INSTANT_WRITTEN - length, ":%02d",
			offset % 60);
}

int
spec_instant_day_of_year(const struct spec_instant *instant)
{
	struct spec_reading reading = spec_instant_reading(instant, 6);
	double zero, first, day;

	(void)eraCal2jd(reading.year, 1, 1, &zero, &first);
	(void)eraCal2jd(reading.year, reading.month, reading.day, &zero, &day);
	return (int)(day - first) + 1;
}

struct spec_instant
spec_instant_later(const struct spec_instant *instant, double seconds)
{
	struct spec_instant later = *instant;
	double tai1, tai2;

	(void)eraUtctai(instant->utc1, instant->utc2, &tai1, &tai2);
	(void)eraTaiutc(tai1, tai2 + seconds / DAY_S, &later.utc1, &later.utc2);
	return later;
}

double
spec_instant_between(const struct spec_instant *from, const struct spec_instant *to)
{
	double a[2], b[2];

	(void)eraUtctai(from->utc1, from->utc2, &a[0], &a[1]);
	(void)eraUtctai(to->utc1, to->utc2, &b[0], &b[1]);
	return ((b[0] - a[0]) + (b[1] - a[1])) * DAY_S;
}

void
spec_instant_terrestrial(const struct spec_instant *instant, double tt[2])
{
	double tai1, tai2;

	(void)eraUtctai(instant->utc1, instant->utc2, &tai1, &tai2);
	(void)eraTaitt(tai1, tai2, &tt[0], &tt[1]);
}

double
spec_instant_tai_utc(const struct spec_instant *instant)
{
	int year, month, day;
	double fraction, difference = 0;

	(void)eraJd2cal(instant->utc1, instant->utc2, &year, &month, &day, &fraction);
	(void)eraDat(year, month, day, fraction, &difference);
	return difference;
}

void
spec_instant_last_leap(int *year, int *month)
{
	eraLEAPSECOND *table;
	int count = eraGetLeapSeconds(&table);

	*year = count > 0 ? table[count - 1].iyear : 0;
	*month = count > 0 ? table[count - 1].month : 0;
}
