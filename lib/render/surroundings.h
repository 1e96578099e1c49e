/* A spectral image of the surroundings, all bands of a pixel together. */
#ifndef SPEC_RENDER_SURROUNDINGS_H
#define SPEC_RENDER_SURROUNDINGS_H

#include <stddef.h>

#include "base/error.h"
#include "image/settings.h"
#include "render/bands.h"
#include "render/space.h"

/*
 * Latitude and longitude, twice as wide as high: column from +x by +y around +z, row from +z
 * down. pixel[(y * width + x) * bands + band] is radiance.
 */
struct spec_surroundings {
	size_t width, height, bands;
	float *pixel;
	double *row;    /* [height + 1] cumulative share of rows by radiance and size */
	double *column; /* [height][width + 1] the same in each row */
	double mean;    /* radiance over all directions and bands */
};

/*
 * Reads an image of light (S0). Bands are linear between the image's; outside them there is
 * no light. Errors: as spec_reader_open's; no S0, another shape, a negative or not finite
 * pixel, more pixels than the memory limit holds.
 */
enum spec_status spec_surroundings_read(struct spec_surroundings *surroundings,
	const char *path, const struct spec_bands_grid *bands,
	const struct spec_settings *settings, struct spec_error *error);
void spec_surroundings_free(struct spec_surroundings *surroundings);

/* What a direction of the light's own space sends, 0 or more. */
typedef double spec_surroundings_radiance(const void *state, struct spec_vector direction);

/* Surroundings of one band, as a function has them at the pixels' middles. SPEC_ENOMEM. */
enum spec_status spec_surroundings_plan(struct spec_surroundings *surroundings,
	size_t height, spec_surroundings_radiance *radiance, const void *state,
	struct spec_error *error);

/* Adds the radiance in a direction of the light's own space, times factor[bands] and weight. */
void spec_surroundings_add(const struct spec_surroundings *surroundings,
	struct spec_vector direction, const float *factor, double weight, float *radiance);

/* Chooses a direction by what comes from it; returns the density [1/sr]. */
double spec_surroundings_sample(const struct spec_surroundings *surroundings,
	const double pair[2], struct spec_vector *direction);
double spec_surroundings_density(
	const struct spec_surroundings *surroundings, struct spec_vector direction);

#endif
