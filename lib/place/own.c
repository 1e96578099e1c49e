#include "place/own.h"

#include <ctype.h>
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

/* Neither a method nor a light, of which lookup tells why. colon: in text, or null. */
static enum spec_status
fail_unknown(const char *text, const char *colon, const struct spec_error *lookup,
	struct spec_error *error)
{
	struct spec_error cause = {0};
	enum spec_adaptation method;
	int formula = colon && isdigit((unsigned char)colon[1]);

	/* A file that is damaged, and a temperature that is none, say so themselves. */
	if (lookup->status != SPEC_EUSAGE || formula)
		return spec_error_set(error, lookup->status, "%s", lookup->message);
	spec_adaptation_find(colon ? colon + 1 : text, &method, &cause);
	return spec_error_set(error, SPEC_EUSAGE, "%s%s", cause.message,
		colon ? "" : ", or " NAME " or another light");
}

/* The light that light is adapted from. */
static enum spec_status
find_white(const char *text, const char *name, const struct spec_image *image,
	const char *file, struct spec_curve *light, struct spec_error *error)
{
	struct spec_error cause = {0};
	enum spec_status status;

	if (spec_own_light_is_named(name))
		return image->role == SPEC_ROLE_REFLECTIVE
			       ? SPEC_OK
			       : spec_own_light(name, image, file, light, error);
	status = spec_lookup_light(name, light, &cause);
	return status == SPEC_OK ? SPEC_OK
				 : fail_unknown(text, strrchr(text, ':'), &cause, error);
}

enum spec_status
spec_own_adaptation(const char *text, const struct spec_image *image, const char *file,
	enum spec_adaptation *method, struct spec_curve *light, struct spec_error *error)
{
	const char *colon = strrchr(text, ':');
	enum spec_status status;
	char *name;

	*light = (struct spec_curve){0};
	if (spec_adaptation_find(text, method, NULL) == SPEC_OK)
		return SPEC_OK;
	*method = SPEC_ADAPTATION_BRADFORD;
	if (colon && spec_adaptation_find(colon + 1, method, NULL) != SPEC_OK)
		colon = NULL; /* it is the light's, as in daylight:5000K */
	name = spec_memory_text(text, colon ? (size_t)(colon - text) : strlen(text), error);
	if (!name)
		return SPEC_ENOMEM;
	status = find_white(text, name, image, file, light, error);
	if (status == SPEC_OK && image->role == SPEC_ROLE_REFLECTIVE) {
		status = spec_error_set(error, SPEC_EUSAGE,
			"%s: %s adapts light; reflectance is lit by an illuminant, " NAME
			" or another, and adapted from that",
			file, name);
		spec_curve_free(light);
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
