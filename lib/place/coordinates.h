/*
 * Places on the earth, WGS 84, by GeographicLib, which is C++ and comes in the plugin
 * places.so: every function here that can fail may answer SPEC_EUNSUPPORTED, the plugin was
 * not found or cannot be loaded.
 */
#ifndef SPEC_PLACE_COORDINATES_H
#define SPEC_PLACE_COORDINATES_H

#include <stddef.h>

#include "base/error.h"

#define SPEC_PLACE_LOWEST_M (-12000.0) /* below the deepest sea */
#define SPEC_PLACE_HIGHEST_M 100000.0  /* where space begins */

struct spec_place {
	double latitude_deg;  /* geodetic, north, -90 to 90 */
	double longitude_deg; /* east of Greenwich, -180 to 180 */
	double altitude_m;    /* over the ellipsoid */
};

/*
 * Reads a place as people write it: degrees, or degrees, minutes and seconds, latitude first
 * unless a hemisphere letter says otherwise, that letter after a space or not; UTM or UPS
 * (zone with n or s, easting, northing); MGRS, of which the square's centre is taken. An
 * altitude may follow, with its unit: "39.742476 N 105.1786 W 1830.14m"; without it 0.
 * Errors: SPEC_EUSAGE, with what is wrong and, where there is one, GeographicLib's cause.
 */
enum spec_status spec_place_parse(
	const char *text, struct spec_place *place, struct spec_error *error);

/* Whether the numbers lie in the ranges above. SPEC_ERANGE says which does not. */
enum spec_status spec_place_check(const struct spec_place *place, struct spec_error *error);

enum spec_place_form {
	SPEC_PLACE_DEGREES, /* "39.742476N 105.178600W" */
	SPEC_PLACE_DMS,     /* with degrees, minutes and seconds to 0.01" */
	SPEC_PLACE_UTM,     /* or UPS, to 1 m */
	SPEC_PLACE_MGRS,    /* to 1 m: of that square's corner */
	SPEC_PLACE_FORMS
};

#define SPEC_PLACE_WRITTEN 64 /* bytes that every form fits in */

/* Writes it, without its altitude; spec_place_parse reads the text. */
enum spec_status spec_place_format(const struct spec_place *place,
	enum spec_place_form form, char written[SPEC_PLACE_WRITTEN],
	struct spec_error *error);

/* "50.88 N 4.7 E": degrees to seven digits, without its altitude. */
void spec_place_brief(const struct spec_place *place, char written[SPEC_PLACE_WRITTEN]);

/*
 * Earth-centred, earth-fixed coordinates [m]: x towards 0 N 0 E, y towards 0 N 90 E, z
 * towards the north pole. axes, which may be null: rows x, y, z; columns the unit vectors
 * east, north and up at the place.
 */
enum spec_status spec_place_to_earth(const struct spec_place *place, double xyz_m[3],
	double axes[9], struct spec_error *error);

/* Its inverse; SPEC_ERANGE below and above the altitudes that a place can have. */
enum spec_status spec_place_from_earth(
	const double xyz_m[3], struct spec_place *place, struct spec_error *error);

/* Where one place is seen from another: metres towards east, north and up there. */
enum spec_status spec_place_to_local(const struct spec_place *origin,
	const struct spec_place *place, double east_north_up_m[3],
	struct spec_error *error);

enum spec_status spec_place_from_local(const struct spec_place *origin,
	const double east_north_up_m[3], struct spec_place *place,
	struct spec_error *error);

struct spec_geodesic {
	double distance_m; /* along the ellipsoid; altitudes play no part */
	double bearing_deg; /* at the start, towards the end: from north through east, 0..360 */
	double arrival_deg; /* at the end, onwards */
};

/* The shortest way; where several are (poles, antipodes) one of them. */
enum spec_status spec_place_geodesic(const struct spec_place *from,
	const struct spec_place *to, struct spec_geodesic *way, struct spec_error *error);

/* The place so far away in that direction, at the same altitude. */
enum spec_status spec_place_onwards(const struct spec_place *from, double bearing_deg,
	double distance_m, struct spec_place *to, struct spec_error *error);

#endif
