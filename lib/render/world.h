/*
 * The shapes of a scene, for rays to meet, on Embree 3. Spheres and disks are met in double
 * precision in their own space; triangles in Embree's single precision.
 */
#ifndef SPEC_RENDER_WORLD_H
#define SPEC_RENDER_WORLD_H

#include "base/error.h"
#include "render/facets.h"
#include "render/space.h"
#include "scene/scene.h"

struct spec_ray {
	struct spec_vector origin, direction; /* direction of length 1 */
};

struct spec_hit {
	size_t shape, triangle;     /* numbers in the scene, and in a mesh */
	double weight[2];           /* of the triangle's second and third corner */
	double distance;            /* [m] along the ray */
	double size;                /* [m] of the numbers that gave the point: its ulps */
	struct spec_vector point;   /* [m] world */
	struct spec_vector normal;  /* geometric, outward, unit */
	struct spec_vector shading; /* unit, on the geometric normal's side */

	/* What spec_world_describe adds: */
	struct spec_vector tangent; /* dp/du, unit */
	/* 0 to 1 in the object's bounding box, 0 where it is flat. */
	struct spec_vector object;
	double u, v;
};

struct spec_world;

/* scene: must live as long. Errors: Embree's, SPEC_ENOMEM. */
enum spec_status spec_world_open(struct spec_world **world, const struct spec_scene *scene,
	struct spec_error *error);
void spec_world_close(struct spec_world *world);

/* The first shape that a ray meets, into hit but for its last lines, and 1; or 0. */
int spec_world_meet(
	const struct spec_world *world, const struct spec_ray *ray, struct spec_hit *hit);

/* Where on its shape a hit lies: what few materials ask for. */
void spec_world_describe(const struct spec_world *world, struct spec_hit *hit);

/* Whether something stands between a point and distance, in lengths of the direction. */
int spec_world_blocks(
	const struct spec_world *world, const struct spec_ray *ray, double distance);

/* A ray that leaves a surface at a hit, on the side that direction points to. */
struct spec_ray spec_world_leave(const struct spec_world *world, const struct spec_hit *hit,
	struct spec_vector direction);

/*
 * Whether something stands between a hit and a light that its point sees in a direction, at
 * distance [m]; INFINITY: in all of it.
 */
int spec_world_shades(const struct spec_world *world, const struct spec_hit *hit,
	struct spec_vector direction, double distance);

/* The triangles of a shape that is a mesh; they live as long as the world. */
const struct spec_facets *spec_world_facets(const struct spec_world *world, size_t shape);

/* The middle and the radius of a sphere around everything [m]. */
void spec_world_bounds(
	const struct spec_world *world, struct spec_vector *middle, double *radius);

#endif
