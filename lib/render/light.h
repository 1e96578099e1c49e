/*
 * Light sources, and how to choose a direction to one of them. Values are in each band:
 * radiance [W m^-2 sr^-1 nm^-1] of areas and of the surroundings.
 */
#ifndef SPEC_RENDER_LIGHT_H
#define SPEC_RENDER_LIGHT_H

#include <stddef.h>

#include "base/error.h"
#include "image/settings.h"
#include "render/bands.h"
#include "render/sampler.h"
#include "render/space.h"
#include "render/world.h"
#include "scene/scene.h"

struct spec_lights;

/* Errors: a spectrum, a picture that cannot be read. */
enum spec_status spec_lights_make(struct spec_lights **lights,
	const struct spec_scene *scene, const struct spec_world *world,
	const struct spec_bands_grid *bands, const struct spec_settings *settings,
	struct spec_error *error);
void spec_lights_free(struct spec_lights *lights);

/* A direction to a light as seen from a point. */
struct spec_light_sample {
	struct spec_vector direction; /* unit, towards the light */
	double distance; /* [m], up to which nothing may stand between: as far as rounding
			    leaves the light behind it */
	double density;  /* [1/sr] of this choice; 0: a point or a direction alone */
	/*
	 * Over density; of a point or a direction alone: irradiance perpendicular to the
	 * direction, over the chance of the choice.
	 */
	struct spec_bands_scaled radiance;
};

/* Chooses a light and a direction to it; 0: there is none, or it sends nothing here. */
int spec_lights_sample(const struct spec_lights *lights, struct spec_vector point,
	struct spec_sampler *sampler, struct spec_light_sample *sample);

/*
 * The radiance that a hit on a shape with an area light sends along -direction, into value;
 * null: none. *density [1/sr]: with which spec_lights_sample chooses this direction from
 * origin.
 */
const float *spec_lights_emitted(const struct spec_lights *lights,
	const struct spec_hit *hit, struct spec_vector origin, struct spec_vector direction,
	double *density);

/* Adds the radiance of the surroundings in a direction times factor[bands] and weight. */
void spec_lights_add_surroundings(const struct spec_lights *lights,
	struct spec_vector direction, const float *factor, double weight, float *radiance);
double spec_lights_surroundings_density(
	const struct spec_lights *lights, struct spec_vector direction);

/* Lights that are a point or a direction: their number, and each from a point. */
size_t spec_lights_small(const struct spec_lights *lights);
void spec_lights_reach(const struct spec_lights *lights, size_t small,
	struct spec_vector point, struct spec_vector *direction, double *distance,
	float *irradiance);

#endif
