#include "render/path.h"

#include <stdint.h>
#include <stdlib.h>
#include <string.h>

#include "base/memory.h"
#include "base/vector.h"

#define SURE_DEPTH 4 /* scatterings before a path may end by chance */

struct spec_path_room {
	float *throughput, *weight, *light, *scattered; /* [bands] */
	double *room;                                   /* [2 * bands] */
};

struct spec_path_room *
spec_path_room_new(size_t bands, struct spec_error *error)
{
	struct spec_path_room *room = spec_memory_new(1, sizeof *room, "paths", error);
	size_t padded = (bands + 15) / 16 * 16;

	if (!room)
		return NULL;
	room->throughput = spec_memory_aligned(4 * padded, sizeof(float), "bands", error);
	room->room = spec_memory_aligned(2 * padded, sizeof(double), "bands", error);
	if (!room->throughput || !room->room) {
		spec_path_room_free(room);
		return NULL;
	}
	room->weight = room->throughput + padded;
	room->light = room->weight + padded;
	room->scattered = room->light + padded;
	return room;
}

void
spec_path_room_free(struct spec_path_room *room)
{
	if (!room)
		return;
	free(room->throughput);
	free(room->room);
	free(room);
}

SPEC_VECTORISED static void
fill(float *to, float value, size_t count)
{
	for (size_t i = 0; i < count; i++)
		to[i] = value;
}

/*
 * Multiplies by values and their scale; returns the largest product. Floats of at least 0
 * are in the order of their bits, of which gcc makes vector code.
 */
SPEC_VECTORISED static float
multiply(float *restrict to, const float *restrict by, float scale, size_t count)
{
	uint32_t most = 0, bits;
	float result;

	for (size_t i = 0; i < count; i++) {
		to[i] *= by[i] * scale;
		memcpy(&bits, to + i, sizeof bits);
		most = bits > most ? bits : most;
	}
	memcpy(&result, &most, sizeof result);
	return result;
}

SPEC_VECTORISED static void
add_three(float *restrict radiance, const float *restrict a, const float *restrict b,
	const float *restrict c, float weight, size_t count)
{
	for (size_t i = 0; i < count; i++)
		radiance[i] += weight * a[i] * b[i] * c[i];
}

/* The power heuristic with exponent 2 for the first of two ways. */
static double
heuristic(double first, double second)
{
	double a = first * first, b = second * second;

	return a < INFINITY ? a / (a + b) : 1;
}

/* Light that a choice among all lights finds, unshadowed. */
static void
add_direct(const struct spec_tracer *tracer, const struct spec_surface *surface,
	int without_small, struct spec_sampler *sampler, struct spec_path_room *room,
	float *radiance)
{
	struct spec_light_sample light = {.radiance.room = room->light};
	struct spec_bands_scaled scattered = {.room = room->scattered};
	double density, weight = 1;

	if (!spec_lights_sample(tracer->lights, surface->hit->point, sampler, &light) ||
		(without_small && light.density == 0))
		return;
	density = spec_material_evaluate(surface, light.direction, &scattered);
	if (!(density > 0))
		return;
	if (spec_world_shades(tracer->world, surface->hit, light.direction, light.distance))
		return;
	if (light.density > 0)
		weight = heuristic(light.density, density);
	add_three(radiance, room->throughput, scattered.value, light.radiance.value,
		(float)(weight * scattered.scale * light.radiance.scale), tracer->bands);
}

/* Where a path was scattered last, with what density; 0: by a mirror, or not at all. */
struct scattering {
	struct spec_vector point;
	double density;
};

/* Light that the path itself runs into. */
static void
add_met(const struct spec_tracer *tracer, const struct spec_hit *hit,
	struct spec_vector direction, const struct scattering *last,
	struct spec_path_room *room, float *radiance)
{
	double other, density = last->density;
	const float *value =
		spec_lights_emitted(tracer->lights, hit, last->point, direction, &other);

	if (value)
		spec_bands_add_product(radiance, room->throughput, value,
			(float)(density > 0 ? heuristic(density, other) : 1),
			tracer->bands);
}

static void
add_surroundings(const struct spec_tracer *tracer, const struct spec_ray *ray,
	double density, struct spec_path_room *room, float *radiance)
{
	double weight = 1;

	if (density > 0)
		weight = heuristic(density,
			spec_lights_surroundings_density(tracer->lights, ray->direction));
	spec_lights_add_surroundings(
		tracer->lights, ray->direction, room->throughput, weight, radiance);
}

/* Ends a path by chance when it carries little, at most chance; 0: it ended. */
static int
survives(struct spec_path_room *room, size_t bands, float chance, int depth,
	struct spec_sampler *sampler)
{
	if (!(chance > 0))
		return 0;
	if (depth < SURE_DEPTH || chance >= 1)
		return 1;
	if (chance < 0.05f)
		chance = 0.05f;
	if (spec_sampler_number(sampler) >= chance)
		return 0;
	for (size_t i = 0; i < bands; i++)
		room->throughput[i] /= chance;
	return 1;
}

void
spec_path_trace(const struct spec_tracer *tracer, const struct spec_ray *first, int depth,
	int without_small, struct spec_sampler *sampler, struct spec_path_room *room,
	float *radiance)
{
	struct spec_ray ray = *first;
	struct scattering last = {ray.origin, 0};
	struct spec_hit hit;

	fill(room->throughput, 1, tracer->bands);
	for (;; depth++) {
		struct spec_surface surface = {.hit = &hit, .room = room->room};
		struct spec_bands_scaled weight = {.room = room->weight};
		struct spec_vector direction;
		float most;

		if (!spec_world_meet(tracer->world, &ray, &hit)) {
			add_surroundings(tracer, &ray, last.density, room, radiance);
			return;
		}
		add_met(tracer, &hit, ray.direction, &last, room, radiance);
		if (depth >= tracer->max_depth)
			return;
		surface.material =
			&tracer->material[tracer->scene->shape[hit.shape].material];
		/* A diffuse surface is the same all over and all around. */
		if (surface.material->kind != SPEC_SCENE_DIFFUSE)
			spec_world_describe(tracer->world, &hit);
		surface.eye = spec_vector_negate(ray.direction);
		surface.cosine = spec_vector_dot(surface.eye, hit.shading);
		if (spec_material_is_rough(surface.material))
			add_direct(
				tracer, &surface, without_small, sampler, room, radiance);
		without_small = 0;
		last.density = spec_material_sample(
			&surface, room->throughput, sampler, &direction, &weight);
		if (last.density < 0)
			return;
		last.point = hit.point;
		most = multiply(
			room->throughput, weight.value, (float)weight.scale, tracer->bands);
		if (!survives(room, tracer->bands, most, depth, sampler))
			return;
		ray = spec_world_leave(tracer->world, &hit, direction);
	}
}
