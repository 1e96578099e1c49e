/*
 * All that is known of the sun at a place and a time, for specinfo(1): asked for by options,
 * written for people and for programs.
 */
#ifndef SPEC_PLACE_ALMANAC_H
#define SPEC_PLACE_ALMANAC_H

#include <stdio.h>

#include "base/error.h"
#include "base/json.h"
#include "image/settings.h"
#include "place/coordinates.h"
#include "place/day.h"
#include "place/instant.h"
#include "place/sun.h"

/* What the options say; {0} at first. */
struct spec_almanac_request {
	int asked, own; /* for the sun; for that of each file's own place and time */
	int has_time, has_target, has_air;
	struct spec_place place, target;
	struct spec_instant instant;
	struct spec_air air;
};

struct spec_almanac {
	struct spec_place place;
	struct spec_instant instant;
	struct spec_air air;
	struct spec_solar solar;
	struct spec_solar_day day;
	char written[SPEC_PLACE_FORMS][SPEC_PLACE_WRITTEN];
	double xyz_m[3];
	int has_target;
	struct spec_place target;
	struct spec_geodesic way;
	double east_north_up_m[3]; /* of the target */
};

/*
 * Takes an option: sun (a place, or "own"), time, toward (a place), air ("PRESSURE,CELSIUS",
 * hPa). *known 0: it is none of these. Errors: those of the parsers.
 */
enum spec_status spec_almanac_take(struct spec_almanac_request *request, const char *name,
	const char *value, int *known, struct spec_error *error);

/* SPEC_EUSAGE: they make no sense together; operands: how many files are named. */
enum spec_status spec_almanac_settle(const struct spec_almanac_request *request,
	size_t operands, struct spec_error *error);

/* path: of the file whose place and time count where request->own. */
enum spec_status spec_almanac_find(struct spec_almanac *almanac,
	const struct spec_almanac_request *request, const char *path,
	const struct spec_settings *settings, struct spec_error *error);

/* name: of the file, or null. The keys are those of specinfo(1). */
void spec_almanac_print(FILE *stream, const char *name, const struct spec_almanac *almanac);
void spec_almanac_json(
	struct spec_json *json, const char *name, const struct spec_almanac *almanac);

#endif
