/*
 * Fuzzes the readers of times and of places' spellings; a time that is read must survive being
 * written and read, and there is a sun then.
 */
#include <math.h>
#include <stdint.h>
#include <stdlib.h>
#include <string.h>

#include "place/day.h"
#include "place/instant.h"
#include "place/spelling.h"
#include "place/sun.h"

#include "fuzz.h"

/* Any place will do: one of the instant's own making. */
static void
check_sun(const struct spec_instant *instant)
{
	struct spec_place place = {90 * sin(instant->utc2 * 1e4),
		180 * sin(instant->utc1 * 10 + instant->utc2 * 1e3), 0};
	struct spec_solar solar;
	struct spec_solar_day day;

	require(spec_solar_position(&place, instant, NULL, &solar, NULL) == SPEC_OK,
		"no sun");
	require(solar.zenith_deg >= 0 && solar.zenith_deg <= 180, "no zenith distance");
	require(solar.azimuth_deg >= 0 && solar.azimuth_deg <= 360, "no azimuth");
	require(solar.distance_au > .98 && solar.distance_au < 1.02, "no distance");
	require(isnan(solar.air_mass) || (solar.air_mass > .99 && solar.air_mass < 38),
		"no air mass");
	require(fabs(solar.equation_of_time_min) < 17, "no equation of time");
	require(spec_solar_day(&place, instant, &day, NULL) == SPEC_OK, "no day");
	require((day.rises || day.sets) == (day.kind == SPEC_DAY_ORDINARY), "no such day");
	if (day.rises)
		require(spec_instant_between(&day.sunrise, &day.noon) >= 0, "a late rise");
	if (day.sets)
		require(spec_instant_between(&day.noon, &day.sunset) >= 0, "an early set");
}

static void
check_instant(const struct spec_instant *instant)
{
	struct spec_error error = {0};
	struct spec_reading reading = spec_instant_reading(instant, 6);
	struct spec_instant again;
	char written[SPEC_INSTANT_WRITTEN];
	int day = spec_instant_day_of_year(instant);

	require(day >= 1 && day <= 366, "no day of the year");
	require(reading.second >= 0 && reading.second < 61, "no second");
	check_sun(instant);
	spec_instant_format(instant, 6, written);
	/* Rounded, the last of all may be in a year that is not read; offsets have minutes. */
	if (reading.year < 1900 || reading.year > 2100 || instant->offset_s % 60 != 0)
		return;
	if (spec_instant_parse(written, &again, &error) != SPEC_OK) {
		fprintf(stderr, "fuzz: %s: %s\n", written, error.message);
		require(0, "what was written cannot be read");
	}
	require(fabs(spec_instant_between(instant, &again)) < 1e-4, "another instant");
	require(again.offset_s == instant->offset_s && again.leap == instant->leap,
		"another zone");
}

static void
check_spelling(const char *text)
{
	struct spec_error error = {0};
	char spelt[SPEC_SPELLING_LONGEST];
	double altitude_m = 0;

	if (spec_spelling_part(text, spelt, &altitude_m, &error) != SPEC_OK) {
		require_message(&error);
		return;
	}
	require(altitude_m >= SPEC_PLACE_LOWEST_M && altitude_m <= SPEC_PLACE_HIGHEST_M,
		"no altitude");
	require(strlen(spelt) <= strlen(text), "more than there was");
	(void)spec_spelling_join(spelt);
	require(strlen(spelt) <= strlen(text), "more than there was, joined");
	(void)spec_spelling_is_half(spelt);
}

int
LLVMFuzzerTestOneInput(const uint8_t *data, size_t size)
{
	struct spec_error error = {0};
	struct spec_instant instant;
	char *text = malloc(size + 1);

	if (!text)
		return 0;
	memcpy(text, data, size);
	text[size] = '\0';
	check_spelling(text);
	if (spec_instant_parse(text, &instant, &error) == SPEC_OK)
		check_instant(&instant);
	else
		require_message(&error);
	free(text);
	return 0;
}
