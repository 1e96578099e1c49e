/*
 * Where and when an image was taken, by OpenEXR's standard attributes: longitude, latitude
 * and altitude (float; degrees east and north, metres), capDate (the local time to the
 * second, "2003:10:17 12:30:30") and utcOffset (float, seconds: UTC = local time + it, so
 * that zones east of Greenwich have negative ones).
 */
#ifndef SPEC_PLACE_PLACED_H
#define SPEC_PLACE_PLACED_H

#include <stdio.h>

#include "base/error.h"
#include "image/image.h"
#include "image/settings.h"
#include "place/coordinates.h"
#include "place/instant.h"

/*
 * Both of an image; an altitude that is missing is 0. name: the file, for messages.
 * SPEC_EUSAGE: the image does not say where or when; SPEC_EFORMAT: what it says is none;
 * SPEC_ERANGE.
 */
enum spec_status spec_placed_of_image(const struct spec_image *image, const char *name,
	struct spec_place *place, struct spec_instant *instant, struct spec_error *error);

/* A line of it for people, as spec_describe_print has them; none where it is not said. */
void spec_placed_print(FILE *stream, const struct spec_image *image);

/* What options say of where and when; {0} at first. */
struct spec_placed {
	int has_place, has_time;
	struct spec_place place;
	struct spec_instant instant;
};

/* Takes an option: place or time. *known 0: it is neither. Errors: those of the parsers. */
enum spec_status spec_placed_take(struct spec_placed *placed, const char *name,
	const char *value, int *known, struct spec_error *error);

/* SPEC_EUSAGE: they say something, and the output, text or another format, cannot hold it. */
enum spec_status spec_placed_check(const struct spec_placed *placed, int is_text,
	const struct spec_settings *settings, struct spec_error *error);

/* Sets what the options say. SPEC_ENOMEM. */
enum spec_status spec_placed_apply(const struct spec_placed *placed,
	struct spec_image *image, struct spec_error *error);

/*
 * Sets the attributes, those of the place or the instant that are not null; an altitude of 0
 * leaves none. The instant is rounded to seconds. SPEC_ENOMEM.
 */
enum spec_status spec_placed_set(struct spec_image *image, const struct spec_place *place,
	const struct spec_instant *instant, struct spec_error *error);

#endif
