/*
 * Light transport: paths from the eye, all bands along one path, with next-event estimation
 * and the power heuristic (Veach 1997, eq. 9.10) between the two ways to find a light.
 */
#ifndef SPEC_RENDER_PATH_H
#define SPEC_RENDER_PATH_H

#include "base/error.h"
#include "render/bands.h"
#include "render/light.h"
#include "render/material.h"
#include "render/sampler.h"
#include "render/world.h"
#include "scene/scene.h"

/* What all paths share; only read. */
struct spec_tracer {
	const struct spec_scene *scene;
	const struct spec_world *world;
	const struct spec_lights *lights;
	const struct spec_material *material;
	size_t bands;
	int max_depth; /* scatterings at most */
};

/* A worker's own. */
struct spec_path_room;

struct spec_path_room *spec_path_room_new(size_t bands, struct spec_error *error);
void spec_path_room_free(struct spec_path_room *room);

/*
 * Adds an estimate of the radiance that arrives along a ray to radiance[bands]. depth:
 * scatterings that lie behind. without_small: at the first surface, lights that are a
 * point or a direction count for nothing.
 */
void spec_path_trace(const struct spec_tracer *tracer, const struct spec_ray *ray,
	int depth, int without_small, struct spec_sampler *sampler,
	struct spec_path_room *room, float *radiance);

#endif
