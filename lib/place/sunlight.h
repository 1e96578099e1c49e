/*
 * The light of the sun and of a clear sky at a place and time, as spectra with a name: from
 * the place of the sun by sun.h, and clearsky.h.
 */
#ifndef SPEC_PLACE_SUNLIGHT_H
#define SPEC_PLACE_SUNLIGHT_H

#include "base/error.h"
#include "place/clearsky.h"
#include "place/coordinates.h"
#include "place/instant.h"
#include "place/sun.h"
#include "spectrum/curve.h"
#include "spectrum/lookup.h"

enum spec_sunlight_part {
	SPEC_SUNLIGHT_SUN, /* direct: facing the sun, unless there is a plane */
	SPEC_SUNLIGHT_SKY, /* diffuse, on the plane */
	SPEC_SUNLIGHT_BOTH /* on the plane */
};

struct spec_sunlight {
	enum spec_sunlight_part part;
	struct spec_place place;
	struct spec_instant instant;
	struct spec_atmosphere atmosphere;
	int has_plane; /* 0: horizontal, but for the sun facing it */
	struct spec_clearsky_plane plane;
};

/*
 * Reads "sun@PLACE,TIME", "sky@…" or "daylight@…", with options after further commas:
 *   turbidity=T                      1 to 10; sets the aerosol's depth
 *   aerosol=DEPTH angstrom=EXPONENT  optical depth at 500 nm, whatever the turbidity
 *   ozone=ATM-CM water=CM            above the place
 *   pressure=HPA                     in place of that of the place's altitude
 *   albedo=A                         of the ground
 *   tilt=ANGLE facing=ANGLE          a plane: 0 horizontal, 90 a wall; azimuth from north by
 *                                    east. facing alone is of a wall, tilt alone faces south
 * PLACE and TIME are as spec_place_parse and spec_instant_parse have them; the place may hold
 * commas. What is not said is as in spec_atmosphere_default.
 * Errors: SPEC_EUSAGE, SPEC_ERANGE  with a caret under the fault; SPEC_EUNSUPPORTED: places
 *         cannot be read
 */
enum spec_status spec_sunlight_parse(
	const char *name, struct spec_sunlight *sunlight, struct spec_error *error);

/*
 * The daylight of a place and an instant. given: these options, a comma before each, or "".
 * SPEC_EUSAGE, SPEC_ERANGE: one is none, or its value.
 */
enum spec_status spec_sunlight_at(const struct spec_place *place,
	const struct spec_instant *instant, const char *given,
	struct spec_sunlight *sunlight, struct spec_error *error);

/*
 * Its spectral irradiance [W m-2 nm-1] from 300 to 4000 nm, a curve of one column E.
 * Errors: SPEC_ERANGE  the sun is below the horizon (nothing here knows twilight), the place
 *                      is above 20 km, what sun.h and clearsky.h refuse
 */
enum spec_status spec_sunlight_make(const struct spec_sunlight *sunlight,
	struct spec_curve *curve, struct spec_error *error);

/* Where the sun is seen, refraction included; SPEC_ERANGE as above. */
enum spec_status spec_sunlight_sun(const struct spec_sunlight *sunlight,
	struct spec_clearsky_sun *sun, struct spec_error *error);

/* The curve of a name that begins with sun@, sky@ or daylight@. */
enum spec_status spec_sunlight_named(
	const char *name, struct spec_curve *curve, struct spec_error *error);

/* These names wherever a spectrum is named: for spec_lookup_set_maker. */
extern const struct spec_lookup_maker spec_sunlight_maker;

#endif
