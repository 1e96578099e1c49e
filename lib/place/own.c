#include "place/own.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "base/memory.h"
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
	struct spec_error cause = {0};
	enum spec_status status = name ? SPEC_OK : SPEC_ENOMEM;

	*light = (struct spec_curve){0};
	if (status == SPEC_OK && !spec_own_light_is_named(name)) {
		status = spec_adaptation_find(text, method, &cause);
		if (status != SPEC_OK)
			spec_error_set(error, status, "%s, or " NAME, cause.message);
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

enum spec_status
spec_own_light(const char *name, const struct spec_image *image, const char *file,
	struct spec_curve *curve, struct spec_error *error)
{
	struct spec_place place;
	struct spec_instant instant;
	struct spec_sunlight sunlight;
	enum spec_status status =
		spec_placed_of_image(image, file, &place, &instant, error);

	*curve = (struct spec_curve){0};
	if (status != SPEC_OK)
		return status;
	status = spec_sunlight_at(&place, &instant, name + strlen(NAME), &sunlight, error);
	if (status == SPEC_OK)
		status = spec_sunlight_make(&sunlight, curve, error);
	if (status != SPEC_OK)
		spec_error_prefix(error, "%s", file);
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
