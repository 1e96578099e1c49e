/*
 * What is summed up over the samples of a pixel, by slots: the light in its bands, layer by
 * layer, and the geometry of surfaces.
 */
#ifndef SPEC_RENDER_SUMS_H
#define SPEC_RENDER_SUMS_H

#include <stddef.h>
#include <stdint.h>

#include "base/error.h"
#include "image/image.h"
#include "render/space.h"
#include "render/world.h"

/* Slots of a surface's geometry, from its first one. */
enum {
	SPEC_SUMS_POINT,
	SPEC_SUMS_NORMAL = 3,
	SPEC_SUMS_SHADING = 6,
	SPEC_SUMS_EYE = 9,
	SPEC_SUMS_TANGENT = 12,
	SPEC_SUMS_OBJECT = 15,
	SPEC_SUMS_U = 18,
	SPEC_SUMS_V,
	SPEC_SUMS_COSINE,
	SPEC_SUMS_COVER,
	SPEC_SUMS_ID,
	SPEC_SUMS_GEOMETRY /* how many they are */
};

#define SPEC_SUMS_IDS 8 /* different ones in a pixel that are told apart */

/* How often each material was seen in a pixel. */
struct spec_sums_ids {
	uint32_t id[SPEC_SUMS_IDS];
	unsigned count[SPEC_SUMS_IDS];
	size_t ids;
};

/* Adds a hit, seen from eye, to a surface's slots. */
void spec_sums_add(double *geometry, struct spec_sums_ids *ids, const struct spec_hit *hit,
	struct spec_vector eye, uint32_t id);

/*
 * Turns sums to means: cover over all samples, the rest over those that saw the surface,
 * vectors of length 1 again, the id that was seen most often.
 */
void spec_sums_finish(double *geometry, const struct spec_sums_ids *ids, unsigned samples);

/*
 * Adds a surface's channels to an image, one for each slot of its geometry, under a prefix
 * such as "film1." or "". The id is UINT, the others are FLOAT.
 */
enum spec_status spec_sums_add_channels(
	struct spec_image *image, const char *prefix, struct spec_error *error);

/* The slot of a channel's name without its prefix, or SPEC_SUMS_GEOMETRY. */
size_t spec_sums_slot(const char *name);

#endif
