#include "place/own.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "base/memory.h"
#include "base/text.h"
#include "place/placed.h"
#include "place/sunlight.h"
#include "spectrum/lookup.h"

#define NAME "daylight"

int
spec_own_light_is_named(const char *name)
{
	size_t length = strlen(NAME);

	return strncmp(name, NAME, length) == 0 &&
	       (name[length] == '\0' || name[length] == ',');
}

enum spec_status
spec_own_lookup_light(const char *name, const struct spec_image *image, const char *file,
	struct spec_curve *curve, struct spec_error *error)
{
	return spec_own_light_is_named(name)
		       ? spec_own_light(name, image, file, curve, error)
		       : spec_lookup_light(name, curve, error);
}

enum spec_status
spec_own_adaptation(const char *text, const struct spec_image *image, const char *file,
	enum spec_adaptation *method, struct spec_curve *light, struct spec_error *error)
{
	const char *colon = strchr(text, ':');
	char *name = spec_memory_text(
		text, colon ? (size_t)(colon - text) : strlen(text), error);
	enum spec_status status = name ? SPEC_OK : SPEC_ENOMEM;

	*light = (struct spec_curve){0};
	if (status == SPEC_OK && !spec_own_light_is_named(name)) {
		status = spec_adaptation_find(text, method, error);
	} else if (status == SPEC_OK && image->role == SPEC_ROLE_REFLECTIVE) {
		status = spec_error_set(error, SPEC_EUSAGE,
			"%s: " NAME
			" adapts light; reflectance is lit by an illuminant, " NAME
			" or another, and adapted from that",
			file);
	} else if (status == SPEC_OK) {
		status =
			spec_adaptation_find(colon ? colon + 1 : "bradford", method, error);
		if (status == SPEC_OK)
			status = spec_own_light(name, image, file, light, error);
	}
	free(name);
	return status;
}

/* As sunlight.h names the light of such a place and time; to be freed. */
static enum spec_status
spell(const char *name, const struct spec_place *place, const struct spec_instant *instant,
	struct spec_text *text, struct spec_error *error)
{
	char time[SPEC_INSTANT_WRITTEN];
	enum spec_status status = spec_text_open(text, error);

	if (status != SPEC_OK)
		return status;
	spec_instant_format(instant, 0, time);
	fprintf(text->stream, NAME "@%.9f %.9f %.4fm,%s%s", place->latitude_deg,
		place->longitude_deg, place->altitude_m, time, name + strlen(NAME));
	fputc('\0', text->stream);
	return spec_text_close(text, error);
}

enum spec_status
spec_own_light(const char *name, const struct spec_image *image, const char *file,
	struct spec_curve *curve, struct spec_error *error)
{
	struct spec_place place;
	struct spec_instant instant;
	struct spec_text text = {0};
	enum spec_status status =
		spec_placed_of_image(image, file, &place, &instant, error);

	*curve = (struct spec_curve){0};
	if (status != SPEC_OK)
		return status;
	status = spell(name, &place, &instant, &text, error);
	if (status == SPEC_OK) {
		status = spec_sunlight_named(text.bytes, curve, error);
		if (status != SPEC_OK)
			spec_error_prefix(error, "%s", file);
		/* It would point into what nobody wrote. */
		if (error)
			error->place[0] = '\0';
	}
	spec_text_free(&text);
	for (size_t i = 0; i < curve->count && status == SPEC_OK; i++)
		curve->value[i] /= M_PI;
	if (status == SPEC_OK)
		status = spec_curve_set_text(&curve->quantity, "radiance per nm", error);
	if (status == SPEC_OK)
		status = spec_curve_set_text(&curve->unit, "W m-2 sr-1 nm-1", error);
	if (status != SPEC_OK)
		spec_curve_free(curve);
	return status;
}

enum spec_status
spec_own_settle(struct spec_operation *operation, size_t operations,
	const struct spec_image *image, const char *file, struct spec_error *error)
{
	enum spec_status status = SPEC_OK;

	for (size_t i = 0; i < operations && status == SPEC_OK; i++) {
		if (operation[i].deferred)
			status = spec_own_light(operation[i].value, image, file,
				&operation[i].curve, error);
		operation[i].deferred = 0;
	}
	return status;
}
