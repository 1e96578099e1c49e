#include "place/day.h"

#include <math.h>

#include "place/sun.h"

#define SOLAR_DAY_S 86400.0
#define NEAR_S .001
#define NOON_STEPS 5
#define EDGE_STEPS 64

/* A time after an instant, and how far above the horizon's edge the sun is then. */
struct point {
	double after_s, height_deg;
};

static enum spec_status
measure(const struct spec_place *place, const struct spec_instant *instant,
	struct point *point, struct spec_error *error)
{
	struct spec_instant at = spec_instant_later(instant, point->after_s);
	struct spec_solar solar;
	enum spec_status status = spec_solar_position(place, &at, NULL, &solar, error);

	if (status == SPEC_OK)
		point->height_deg = 90 - solar.zenith_deg - SPEC_DAY_HORIZON_DEG;
	return status;
}

/*
 * By Newton's method, from 12:00: the hour angle goes with the time but for 30 s a day, so
 * that a step leaves 4e-4 of the way, which is half a day at first, and the third milliseconds.
 * Where UTC jumped ahead, by .05 s in 1961, noon may be skipped: the steps then go to and fro
 * over the gap, of which either side will do.
 */
static enum spec_status
find_noon(const struct spec_place *place, const struct spec_instant *instant,
	struct spec_solar_day *day, struct spec_error *error)
{
	struct spec_reading reading = spec_instant_reading(instant, 6);
	struct spec_solar solar;
	enum spec_status status;

	reading.hour = 12;
	reading.minute = 0;
	reading.second = 0;
	status = spec_instant_from_reading(&reading, &day->noon, error);
	for (int i = 0; i < NOON_STEPS && status == SPEC_OK; i++) {
		double step_s;

		status = spec_solar_position(place, &day->noon, NULL, &solar, error);
		if (status != SPEC_OK)
			return status;
		day->noon_zenith_deg = solar.zenith_deg;
		step_s = -solar.hour_angle_deg / 360 * SOLAR_DAY_S;
		if (fabs(step_s) < NEAR_S)
			return SPEC_OK;
		day->noon = spec_instant_later(&day->noon, step_s);
	}
	return status;
}

/*
 * When the sun is at the edge between two times, of which it is below it at one alone: regula
 * falsi, Illinois. after_s: from the instant.
 */
static enum spec_status
find_edge(const struct spec_place *place, const struct spec_instant *instant,
	struct point low, struct point high, double *after_s, struct spec_error *error)
{
	double low_weight = low.height_deg, high_weight = high.height_deg, last = 0;

	for (int i = 0; i < EDGE_STEPS; i++) {
		struct point middle = {
			.after_s = (low.after_s * high_weight - high.after_s * low_weight) /
				   (high_weight - low_weight)};
		enum spec_status status = measure(place, instant, &middle, error);
		double step_s = fabs(middle.after_s - *after_s);

		if (status != SPEC_OK)
			return status;
		*after_s = middle.after_s;
		if (step_s < NEAR_S)
			break;
		/* The end that stays for a second time counts for half. */
		if (middle.height_deg < 0) {
			low = middle;
			low_weight = middle.height_deg;
			high_weight /= last < 0 ? 2 : 1;
		} else {
			high = middle;
			high_weight = middle.height_deg;
			low_weight /= last > 0 ? 2 : 1;
		}
		last = middle.height_deg;
	}
	return SPEC_OK;
}

/* Half a day before noon (side -1) or after it (1); *crosses: it rises or sets in between. */
static enum spec_status
search(const struct spec_place *place, const struct spec_instant *noon, int side,
	struct spec_instant *edge, int *crosses, struct spec_error *error)
{
	struct point midnight = {.after_s = side * SOLAR_DAY_S / 2}, top = {0};
	double after_s = INFINITY;
	enum spec_status status = measure(place, noon, &top, error);

	if (status == SPEC_OK)
		status = measure(place, noon, &midnight, error);
	*crosses = status == SPEC_OK && midnight.height_deg < 0 && top.height_deg >= 0;
	if (*crosses)
		status = find_edge(place, noon, midnight, top, &after_s, error);
	if (*crosses && status == SPEC_OK)
		*edge = spec_instant_later(noon, after_s);
	return status;
}

enum spec_status
spec_solar_day(const struct spec_place *place, const struct spec_instant *instant,
	struct spec_solar_day *day, struct spec_error *error)
{
	enum spec_status status;

	*day = (struct spec_solar_day){0};
	status = find_noon(place, instant, day, error);
	if (status == SPEC_OK)
		status = search(place, &day->noon, -1, &day->sunrise, &day->rises, error);
	if (status == SPEC_OK)
		status = search(place, &day->noon, 1, &day->sunset, &day->sets, error);
	if (day->rises || day->sets)
		day->kind = SPEC_DAY_ORDINARY;
	else if (90 - day->noon_zenith_deg < SPEC_DAY_HORIZON_DEG)
		day->kind = SPEC_DAY_POLAR_NIGHT;
	else
		day->kind = SPEC_DAY_POLAR_DAY;
	return status;
}
