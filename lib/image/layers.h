/*
 * Light layers: the light that arrives at surfaces whose optics is left to a later tool,
 * and the geometry of those surfaces, as channels beside an image's bands; see specexr(5).
 */
#ifndef SPEC_IMAGE_LAYERS_H
#define SPEC_IMAGE_LAYERS_H

#include <stddef.h>
#include <stdint.h>

#include "base/error.h"
#include "image/image.h"

#define SPEC_LAYERS_NONE SIZE_MAX /* in place of the index of a channel that is not there */

/* Channels of a surface's geometry; vectors have X, Y, Z, all or none. */
struct spec_geometry {
	size_t point[3];   /* P [m] */
	size_t normal[3];  /* N */
	size_t shading[3]; /* Ns */
	size_t tangent[3]; /* Tan */
	size_t eye[3];     /* I */
	size_t object[3];  /* Q, 0 to 1 in the object's bounding box */
	size_t cosine;     /* of Ns and I: negative where the outward normal looks away */
	size_t cover;      /* 0 to 1 */
	size_t id;         /* UINT */
};

/* film<k>: a surface along the straight view ray, and what it mirrors. */
struct spec_film_layer {
	struct spec_geometry geometry;
	size_t *mirror; /* [bands] radiance along the mirror direction, times cover */
};

/* lamp<j>: what a small or far light sends to the image's own surface. */
struct spec_lamp_layer {
	size_t direction[3]; /* D, towards the light */
	size_t *irradiance;  /* [bands] perpendicular to D, times cover */
};

struct spec_layers {
	struct spec_geometry surface; /* of the channels without a prefix */
	size_t films, lamps;
	struct spec_film_layer *film; /* from the eye */
	struct spec_lamp_layer *lamp;
	size_t *through; /* [bands] radiance behind the last film; null: none */
};

/*
 * The layers of an indexed image. Having none is no error. Errors (SPEC_EFORMAT): a layer
 * without one of the image's bands or with another, numbers with gaps, a vector that is
 * not whole, layers in an image that is not emissive. name: the file, for messages.
 */
enum spec_status spec_layers_find(struct spec_layers *layers,
	const struct spec_image *image, const char *name, struct spec_error *error);
void spec_layers_free(struct spec_layers *layers);

/* Whether a channel belongs to film layers (film<k>. or through.), or to lamps (lamp<j>.). */
int spec_layers_is_film(const struct spec_channel *channel);
int spec_layers_is_lamp(const struct spec_channel *channel);

#endif
