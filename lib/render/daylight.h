/*
 * The sun and a clear sky around a scene (place/dome.h), and below the horizon a level ground
 * that they light, matt and of one albedo: what a direction sends, and how to choose one by
 * what it sends. The sun's disc is chosen apart from the rest, evenly by its solid angle.
 */
#ifndef SPEC_RENDER_DAYLIGHT_H
#define SPEC_RENDER_DAYLIGHT_H

#include <stddef.h>

#include "base/error.h"
#include "place/dome.h"
#include "render/bands.h"
#include "render/space.h"
#include "render/surroundings.h"
#include "scene/scene.h"

/* What the bands have of those of the dome: the mean over a bin is a sum over some. */
struct spec_daylight_share {
	size_t first[SPEC_DOME_BANDS], last[SPEC_DOME_BANDS]; /* bands that have some */
	float *part;                                          /* [SPEC_DOME_BANDS][bands] */
};

struct spec_daylight {
	size_t bands;
	struct spec_dome dome;
	struct spec_frame axes; /* east, north and up in the scene */
	struct spec_daylight_share sky, disc;
	float *ground; /* [bands] radiance [W m^-2 sr^-1 nm^-1] */

	/* Directions but the sun's, by the mean of bands. */
	struct spec_surroundings shares;
	int has_sun;
	double sun_chance; /* of the disc to be chosen */
	double sun_sr;
	struct spec_frame sun; /* about the disc's middle, of the dome's axes */
	double mean;           /* radiance over all directions and bands */
};

/*
 * light: an infinite one of daylight. Bands are means over their bins; outside 300 to 4000 nm
 * there is no light. Errors: those of spec_dome_make. It may be freed then as after success.
 */
enum spec_status spec_daylight_make(struct spec_daylight *daylight,
	const struct spec_scene_daylight *light, const struct spec_bands_grid *bands,
	struct spec_error *error);
void spec_daylight_free(struct spec_daylight *daylight);

/*
 * Adds the radiance in a direction of the scene, a unit vector, times factor[bands] and
 * weight.
 */
void spec_daylight_add(const struct spec_daylight *daylight, struct spec_vector direction,
	const float *factor, double weight, float *radiance);

/*
 * Chooses a direction by what comes from it; returns the density [1/sr], by which it may be
 * chosen in either way. number: in [0, 1), says whether it is one to the sun.
 */
double spec_daylight_sample(const struct spec_daylight *daylight, const double pair[2],
	double number, struct spec_vector *direction);
double spec_daylight_density(
	const struct spec_daylight *daylight, struct spec_vector direction);

#endif
