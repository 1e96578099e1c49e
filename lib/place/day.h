/*
 * The sun's day: when it rises, culminates and sets. It rises and sets when its upper edge
 * is at a level horizon under 34' of refraction, its centre 50' below it without air, as the
 * almanacs have it; hills, and the height of the eye above them, are left out.
 */
#ifndef SPEC_PLACE_DAY_H
#define SPEC_PLACE_DAY_H

#include "base/error.h"
#include "place/coordinates.h"
#include "place/instant.h"

#define SPEC_DAY_HORIZON_DEG (-50. / 60) /* the centre's elevation without air */

enum spec_day_kind {
	SPEC_DAY_ORDINARY, /* the sun rises or sets */
	SPEC_DAY_POLAR_DAY,
	SPEC_DAY_POLAR_NIGHT
};

struct spec_solar_day {
	enum spec_day_kind kind;
	int rises, sets;
	struct spec_instant sunrise, noon, sunset; /* the first and last where it does */
	double noon_zenith_deg;                    /* airless */
};

/*
 * Of the day that the instant is in, by the calendar at its offset: the culmination nearest
 * to 12:00 there, the rise in the half day before it and the set in the half day after it,
 * at the same offset. Errors: those of spec_solar_position.
 */
enum spec_status spec_solar_day(const struct spec_place *place,
	const struct spec_instant *instant, struct spec_solar_day *day,
	struct spec_error *error);

#endif
