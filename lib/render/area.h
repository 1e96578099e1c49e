/* Surfaces that shine, and how to choose a direction to a point of one. */
#ifndef SPEC_RENDER_AREA_H
#define SPEC_RENDER_AREA_H

#include "base/error.h"
#include "render/facets.h"
#include "render/space.h"
#include "render/world.h"
#include "scene/scene.h"

struct spec_area {
	const struct spec_scene_shape *shape;
	const struct spec_facets *facets; /* of a mesh */
	double area;                      /* [m^2] */
	double *until;                    /* [triangles] cumulative area of a mesh's */
	double radius;                    /* of a sphere in world space [m] */
	struct spec_vector middle;        /* of it */
};

/* facets: the shape's, where it is a mesh. SPEC_EUNSUPPORTED: a stretched sphere. */
enum spec_status spec_area_make(struct spec_area *area,
	const struct spec_scene_shape *shape, const struct spec_facets *facets,
	struct spec_error *error);
void spec_area_free(struct spec_area *area);

/* Whether a space has axes of one length, across each other: that is *scale. */
int spec_area_is_similar(const double m[4][4], double *scale);

struct spec_area_sample {
	struct spec_vector direction; /* unit, from the point to the surface */
	double distance; /* [m], up to which nothing may stand between: as far as rounding
			    leaves the surface behind it */
	double density;  /* [1/sr] */
	struct spec_vector normal; /* outward at the point met, of any length */
};

/*
 * Chooses a direction from a point by two numbers and, of meshes, a third, all in [0, 1): by
 * the solid angle of spheres, by the area of others. 0: none is to be had.
 */
int spec_area_sample(const struct spec_area *area, struct spec_vector from,
	const double pair[2], double number, struct spec_area_sample *sample);

/* The density [1/sr] with which that chooses the direction to a hit. */
double spec_area_density(const struct spec_area *area, const struct spec_hit *hit,
	struct spec_vector from, struct spec_vector direction);

#endif
