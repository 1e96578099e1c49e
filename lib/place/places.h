/*
 * The plugin places.so: coordinates by GeographicLib. Loaded by coordinates.c alone. A C
 * interface: no exception leaves it. Angles are degrees, lengths metres.
 */
#ifndef SPEC_PLACE_PLACES_H
#define SPEC_PLACE_PLACES_H

#include <stddef.h>

#include "base/error.h"
#include "place/coordinates.h"

/* To be raised with every change below, of struct spec_error and of coordinates.h. */
#define SPEC_PLACES_VERSION 1

/* The only symbol: a constant struct spec_places. */
#define SPEC_PLACES_SYMBOL "spec_places"

/*
 * Each function fills *error, which may be null, where it fails: the cause alone, perhaps
 * with line breaks; SPEC_EUSAGE where GeographicLib refuses what it was given. Altitudes are
 * left as they are by parse and onwards.
 */
struct spec_places {
	int version;

	enum spec_status (*parse)(
		const char *text, struct spec_place *place, struct spec_error *error);
	enum spec_status (*format)(const struct spec_place *place,
		enum spec_place_form form, char *written, size_t room,
		struct spec_error *error);
	enum spec_status (*to_earth)(const struct spec_place *place, double xyz_m[3],
		double axes[9], struct spec_error *error);
	enum spec_status (*from_earth)(
		const double xyz_m[3], struct spec_place *place, struct spec_error *error);
	enum spec_status (*to_local)(const struct spec_place *origin,
		const struct spec_place *place, double east_north_up_m[3],
		struct spec_error *error);
	enum spec_status (*from_local)(const struct spec_place *origin,
		const double east_north_up_m[3], struct spec_place *place,
		struct spec_error *error);
	enum spec_status (*geodesic)(const struct spec_place *from,
		const struct spec_place *to, struct spec_geodesic *way,
		struct spec_error *error);
	enum spec_status (*onwards)(const struct spec_place *from, double bearing_deg,
		double distance_m, struct spec_place *to, struct spec_error *error);
};

#endif
