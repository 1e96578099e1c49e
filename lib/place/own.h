/*
 * The light of an image's own place and time, where an option names a light: "daylight", and
 * behind a comma the options of sunlight.h, "daylight,turbidity=2".
 */
#ifndef SPEC_PLACE_OWN_H
#define SPEC_PLACE_OWN_H

#include <stddef.h>

#include "base/error.h"
#include "colour/space.h"
#include "image/image.h"
#include "spectrum/curve.h"
#include "spectrum/operation.h"

int spec_own_light_is_named(const char *name);

/*
 * The radiance [W m-2 sr-1 nm-1] that a white matt surface sends back in the light of the sun
 * and a clear sky, the ground unless the options name a plane: 1/pi of the irradiance of
 * sunlight.h. file: for messages. Errors: those of spec_placed_of_image, spec_sunlight_parse
 * and spec_sunlight_make; SPEC_ERANGE: the sun is below the horizon.
 */
enum spec_status spec_own_light(const char *name, const struct spec_image *image,
	const char *file, struct spec_curve *curve, struct spec_error *error);

/* That light, or any other by its name, as spec_lookup_light. */
enum spec_status spec_own_lookup_light(const char *name, const struct spec_image *image,
	const char *file, struct spec_curve *curve, struct spec_error *error);

/*
 * An adaptation by its name, as spec_adaptation_find; or, of an emissive image, from what
 * light becomes, its own "daylight" or any light by its name: behind a colon the method, else
 * Bradford's. light is empty otherwise. SPEC_EUSAGE: the image is reflective.
 */
enum spec_status spec_own_adaptation(const char *text, const struct spec_image *image,
	const char *file, enum spec_adaptation *method, struct spec_curve *light,
	struct spec_error *error);

/* Gives the operations that spec_operation_defer left without it their light. */
enum spec_status spec_own_settle(struct spec_operation *operation, size_t operations,
	const struct spec_image *image, const char *file, struct spec_error *error);

#endif
