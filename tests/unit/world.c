/* Where rays meet shapes, and how they get away from them. */
#include <stdlib.h>

#include "render/world.h"
#include "scene/scene.h"
#include "scene/transform.h"

#include "check.h"
#include "shapes.h"

#define PI 3.14159265358979323846

struct fixture {
	struct spec_scene scene;
	struct spec_world *world;
	uint64_t random;
};

static int
set_up(void **state)
{
	struct fixture *f = calloc(1, sizeof *f);

	assert_non_null(f);
	f->scene.shape = calloc(8, sizeof *f->scene.shape);
	f->scene.material = calloc(1, sizeof *f->scene.material);
	f->scene.materials = 1;
	f->random = 1;
	*state = f;
	return 0;
}

static int
tear_down(void **state)
{
	struct fixture *f = *state;

	spec_world_close(f->world);
	spec_scene_free(&f->scene);
	free(f);
	return 0;
}

static void
open_world(struct fixture *f)
{
	struct spec_error error;

	spec_world_close(f->world);
	check(spec_world_open(&f->world, &f->scene, &error), &error);
}

/* --- numbers and directions by chance, the same in every run --- */

static double
chance(struct fixture *f)
{
	uint64_t z = f->random += 0x9e3779b97f4a7c15;

	z = (z ^ (z >> 30)) * 0xbf58476d1ce4e5b9;
	z = (z ^ (z >> 27)) * 0x94d049bb133111eb;
	return (double)((z ^ (z >> 31)) >> 11) * 0x1p-53;
}

static struct spec_vector
any_direction(struct fixture *f)
{
	double z = 2 * chance(f) - 1, angle = 2 * PI * chance(f), r = sqrt(1 - z * z);

	return (struct spec_vector){r * cos(angle), r * sin(angle), z};
}

/* About a normal, at a cosine given. */
static struct spec_vector
direction_at(struct fixture *f, struct spec_vector normal, double cosine)
{
	struct spec_frame frame = spec_frame_about(normal);
	double angle = 2 * PI * chance(f), sine = sqrt(1 - cosine * cosine);

	return spec_frame_to_world(
		&frame, (struct spec_vector){sine * cos(angle), sine * sin(angle), cosine});
}

static double
distance_of(struct spec_vector a, struct spec_vector b)
{
	return spec_vector_length(spec_vector_subtract(a, b));
}

/* --- shapes --- */

static const struct place places[] = {
	{{1, 1, 1}, 0, {0, 0, 1}, {0, 0, 0}},
	{{1, 1, 1}, 70, {1, 2, 3}, {1, -2, 3}},
	{{3, 0.5, 1}, 40, {0, 1, 1}, {0, 5, 0}},
	{{-1, 1, 1}, 10, {1, 0, 0}, {0, 0, 1}}, /* mirrored */
	{{-2, -0.3, -1}, 200, {1, 1, 0}, {4, 0, 0}},
	{{1, 1, 0.01}, 33, {1, 0, 1}, {0, 0, 0}},
	{{0.05, 0.05, 0.05}, 20, {0, 1, 0}, {600, 0, -800}}, /* a bubble 1 km off */
	{{1e-6, 1e-6, 1e-6}, 5, {0, 1, 0}, {0, 0, 0}},
	{{1e6, 1e6, 1e6}, 5, {0, 1, 0}, {0, 0, 0}},
};
#define PLACES (sizeof places / sizeof *places)

static struct spec_scene_shape *
add_shape(struct fixture *f, enum spec_scene_shape_kind kind, const struct place *place)
{
	struct spec_scene_shape *shape = &f->scene.shape[f->scene.shapes++];

	shape->kind = kind;
	shape->world = transform_of(place);
	shape->radius = 1;
	shape->light = SPEC_SCENE_NONE;
	return shape;
}

/* An octahedron about 0, its outside outside; normals: as if of a sphere. */
static struct spec_scene_shape *
add_octahedron(struct fixture *f, const struct place *place, int normals, int uv)
{
	static const float point[] = {
		1, 0, 0, 0, 1, 0, 0, 0, 1, -1, 0, 0, 0, -1, 0, 0, 0, -1};
	static const uint32_t index[] = {
		0, 1, 2, 1, 3, 2, 3, 4, 2, 4, 0, 2, 1, 0, 5, 3, 1, 5, 4, 3, 5, 0, 4, 5};
	static const float uvs[] = {.1f, .2f, .8f, .1f, .4f, .9f, .7f, .6f, .3f, .5f, 0, 1};
	struct spec_scene_shape *shape = add_shape(f, SPEC_SCENE_MESH, place);

	shape->vertices = 6;
	shape->triangles = 8;
	shape->point = copy_of(point, sizeof point);
	shape->index = copy_of(index, sizeof index);
	shape->normal = normals ? copy_of(point, sizeof point) : NULL;
	shape->uv = uv ? copy_of(uvs, sizeof uvs) : NULL;
	return shape;
}

static struct spec_vector
through(const double m[4][4], struct spec_vector v, int is_point)
{
	double w = is_point;

	return (struct spec_vector){
		m[0][0] * v.x + m[0][1] * v.y + m[0][2] * v.z + w * m[0][3],
		m[1][0] * v.x + m[1][1] * v.y + m[1][2] * v.z + w * m[1][3],
		m[2][0] * v.x + m[2][1] * v.y + m[2][2] * v.z + w * m[2][3]};
}

/* The normal of a stretched plane: across the images of two vectors in it. */
static struct spec_vector
normal_of(const struct spec_scene_shape *shape, struct spec_vector local)
{
	struct spec_frame frame = spec_frame_about(local);
	struct spec_vector normal = spec_vector_unit(spec_vector_cross(
		through(shape->world.m, frame.x, 0), through(shape->world.m, frame.y, 0)));
	struct spec_vector out = through(shape->world.m, local, 0);

	return spec_vector_dot(normal, out) < 0 ? spec_vector_negate(normal) : normal;
}

static struct spec_hit
meet(const struct fixture *f, const struct spec_ray *ray)
{
	struct spec_hit hit;

	memset(&hit, 0, sizeof hit);
	if (!spec_world_meet(f->world, ray, &hit))
		fail_msg("the ray meets nothing");
	spec_world_describe(f->world, &hit);
	return hit;
}

static void
expect_near(double value, double wanted, double bound, size_t place, const char *what)
{
	if (!(fabs(value - wanted) <= bound))
		fail_msg("place %zu: %s: %.12g instead of %.12g +- %.2g", place, what,
			value, wanted, bound);
}

static void
expect_at(struct spec_vector value, struct spec_vector wanted, double bound, size_t place,
	const char *what)
{
	double off = distance_of(value, wanted);

	if (!(off <= bound))
		fail_msg("place %zu: %s: %g off, at most %g expected", place, what, off,
			bound);
}

/* --- spheres and disks, to the precision that world.h promises: that of double --- */

/*
 * What an ulp of the largest coordinate makes in the object's space and back: 16 ulps for
 * the dozen of roundings, along a ray that arrives at the cosine.
 */
static double
rounding(const struct spec_scene_shape *shape, struct spec_vector origin, double distance,
	double cosine)
{
	double size = spec_vector_length(origin) + distance, move = 0;

	for (int i = 0; i < 3; i++)
		move += fabs(shape->world.m[i][3]);
	return 16 * 0x1p-52 * (size + move) / cosine;
}

static double
condition(const struct place *place)
{
	double most = 0, least = INFINITY;

	for (int i = 0; i < 3; i++) {
		most = fmax(most, fabs(place->scale[i]));
		least = fmin(least, fabs(place->scale[i]));
	}
	return most / least;
}

/* A ray that arrives at a point from outside, and one from another point of the surface. */
static void
expect_meeting(struct fixture *f, size_t place, struct spec_vector local,
	struct spec_vector local_normal, double away)
{
	const struct spec_scene_shape *shape = f->scene.shape;
	struct spec_vector point = through(shape->world.m, local, 1);
	struct spec_vector normal = normal_of(shape, local_normal);
	double cosine = 0.1 + 0.9 * chance(f), size = condition(&places[place]), bound;
	struct spec_ray ray;
	struct spec_hit hit;

	ray = ray_to(
		spec_vector_along(point, direction_at(f, normal, cosine), away), point);
	hit = meet(f, &ray);
	bound = size * rounding(shape, ray.origin, away, cosine);
	expect_near(hit.distance, away, bound, place, "distance");
	expect_at(hit.point, point, bound, place, "point");
	expect_at(hit.shading, hit.normal, 0, place, "shading normal");
	/* A curved surface turns its normal on the way: by size / the smallest axis. */
	expect_at(hit.normal, normal,
		1e-12 + 10 * size * bound /
				spec_vector_length(through(shape->world.m, local, 0)),
		place, "normal");
	expect_near(spec_vector_length(hit.tangent), 1, 1e-12, place, "tangent's length");
	expect_near(
		spec_vector_dot(hit.tangent, hit.normal), 0, 1e-9 * size, place, "tangent");
}

static void
test_spheres(void **state)
{
	struct fixture *f = *state;
	struct spec_scene_shape *shape = add_shape(f, SPEC_SCENE_SPHERE, &places[0]);

	for (size_t place = 0; place < PLACES; place++) {
		double away = 3 * fabs(places[place].scale[0]);

		shape->world = transform_of(&places[place]);
		open_world(f);
		for (int i = 0; i < 300; i++) {
			struct spec_vector local = any_direction(f);

			expect_meeting(f, place, local, local, away);
		}
	}
}

/* From within, and from a camera a kilometre away. */
static void
test_spheres_from_within_and_afar(void **state)
{
	struct fixture *f = *state;
	struct spec_scene_shape *shape = add_shape(f, SPEC_SCENE_SPHERE, &places[0]);

	for (size_t place = 0; place < PLACES; place++) {
		shape->world = transform_of(&places[place]);
		open_world(f);
		for (int i = 0; i < 300; i++) {
			struct spec_vector a = any_direction(f), b = any_direction(f);
			struct spec_vector point = through(shape->world.m, a, 1), from;
			struct spec_ray ray;
			struct spec_hit hit;
			double bound;

			/* From the chord's middle; chords not too flat. */
			if (spec_vector_dot(a, b) > 0.9)
				continue;
			from = through(shape->world.m,
				spec_vector_scale(spec_vector_add(a, b), 0.5), 1);
			ray = ray_to(from, point);
			hit = meet(f, &ray);
			bound = condition(&places[place]) * rounding(shape, from, 0, 0.05);
			expect_at(hit.point, point, bound, place, "point from within");
			assert_true(spec_vector_dot(hit.normal, ray.direction) > 0);
		}
		if (condition(&places[place]) == 1)
			for (int i = 0; i < 100; i++)
				expect_meeting(f, place, (struct spec_vector){0, 0.6, 0.8},
					(struct spec_vector){0, 0.6, 0.8},
					1000 * fabs(places[place].scale[0]));
	}
}

static void
test_disks(void **state)
{
	struct fixture *f = *state;
	struct spec_scene_shape *shape = add_shape(f, SPEC_SCENE_DISK, &places[0]);
	const struct spec_vector up = {0, 0, 1};

	shape->radius = 2;
	shape->inner_radius = 0.5;
	shape->height = 0.25;
	for (size_t place = 0; place < PLACES; place++) {
		shape->world = transform_of(&places[place]);
		open_world(f);
		for (int i = 0; i < 300; i++) {
			double r = 0.501 + 1.498 * chance(f), angle = 2 * PI * chance(f);
			struct spec_vector local = {
				r * cos(angle), r * sin(angle), shape->height};
			struct spec_hit hit;
			struct spec_ray ray;

			expect_meeting(f, place, local, up, fabs(places[place].scale[0]));
			ray = ray_to(
				through(shape->world.m, (struct spec_vector){0, 0, 3}, 1),
				through(shape->world.m, local, 1));
			hit = meet(f, &ray);
			expect_near(hit.u, angle / (2 * PI), 1e-6, place, "u");
			expect_near(hit.v, (2 - r) / 1.5, 1e-6, place, "v");
			expect_at(hit.object,
				(struct spec_vector){
					local.x / 4 + 0.5, local.y / 4 + 0.5, 0},
				1e-6, place, "object coordinates");
		}
	}
}

/* Beside the disk, and through its hole, there is nothing. */
static void
test_disk_edges(void **state)
{
	static const double radius[] = {0, 0.4999, 0.5001, 1.9999, 2.0001};
	static const int there[] = {0, 0, 1, 1, 0};
	struct fixture *f = *state;
	struct spec_scene_shape *shape = add_shape(f, SPEC_SCENE_DISK, &places[1]);

	shape->radius = 2;
	shape->inner_radius = 0.5;
	open_world(f);
	for (int i = 0; i < 5; i++) {
		struct spec_vector to =
			through(shape->world.m, (struct spec_vector){-radius[i], 0, 0}, 1);
		struct spec_ray ray = ray_to((struct spec_vector){7, 8, 9}, to);
		struct spec_hit hit;

		assert_int_equal(spec_world_meet(f->world, &ray, &hit), there[i]);
		assert_int_equal(spec_world_blocks(f->world, &ray, INFINITY), there[i]);
	}
}

static void
test_sphere_coordinates(void **state)
{
	struct fixture *f = *state;
	struct spec_scene_shape *shape = add_shape(f, SPEC_SCENE_SPHERE, &places[2]);

	shape->radius = 3;
	open_world(f);
	for (int i = 0; i < 300; i++) {
		double azimuth = 2 * PI * chance(f), polar = PI * (0.01 + 0.98 * chance(f));
		struct spec_vector d = {
			sin(polar) * cos(azimuth), sin(polar) * sin(azimuth), cos(polar)};
		struct spec_ray ray =
			ray_to(through(shape->world.m, (struct spec_vector){0, 0, 0}, 1),
				through(shape->world.m, spec_vector_scale(d, 3), 1));
		struct spec_hit hit = meet(f, &ray);

		/* pbrt: v from the pole at -z. */
		expect_near(hit.u, azimuth / (2 * PI), 1e-6, 0, "u");
		expect_near(hit.v, 1 - polar / PI, 1e-6, 0, "v");
		expect_at(hit.object,
			spec_vector_along((struct spec_vector){.5, .5, .5}, d, 0.5), 1e-6,
			0, "object coordinates");
	}
}

/* --- meshes: Embree's single precision --- */

/* 2^-24 of the largest coordinate, a dozen of times, and what a flat arrival makes of it. */
static double
float_rounding(struct spec_vector at, double size, double cosine)
{
	return 16 * 0x1p-24 * (spec_vector_length(at) + size) / cosine;
}

static void
expect_mesh(struct fixture *f, size_t place, const struct spec_scene_shape *shape)
{
	for (int i = 0; i < 300; i++) {
		size_t triangle = (size_t)(8 * chance(f));
		const uint32_t *corner = shape->index + 3 * triangle;
		double u = chance(f), v = chance(f), size = 0,
		       cosine = 0.2 + chance(f) * .8;
		struct spec_vector p = {0, 0, 0}, point, normal;
		double weight[3], bound;
		struct spec_ray ray;
		struct spec_hit hit;

		if (u + v > 1) {
			u = 1 - u;
			v = 1 - v;
		}
		u = 0.01 + 0.97 * u;
		v = 0.01 + 0.97 * v;
		weight[0] = 1 - u - v;
		weight[1] = u;
		weight[2] = v;
		for (int j = 0; j < 3; j++) {
			const float *at = shape->point + 3 * corner[j];

			p = spec_vector_along(
				p, (struct spec_vector){at[0], at[1], at[2]}, weight[j]);
			size = fmax(size, fabs(places[place].scale[j]));
		}
		point = through(shape->world.m, p, 1);
		normal = normal_of(shape,
			(struct spec_vector){copysign(sqrt(1. / 3), p.x),
				copysign(sqrt(1. / 3), p.y), copysign(sqrt(1. / 3), p.z)});
		ray = ray_to(
			spec_vector_along(point, direction_at(f, normal, cosine), size),
			point);
		hit = meet(f, &ray);
		bound = float_rounding(point, 2 * size, cosine);
		expect_at(hit.point, point, bound, place, "point of a mesh");
		expect_near(hit.distance, size, bound, place, "distance of a mesh");
		expect_at(hit.normal, normal, 1e-9, place, "normal of a mesh");
		bound *= 4 / size * condition(&places[place]);
		if (shape->normal) {
			struct spec_vector shading = normal_of(shape, spec_vector_unit(p));

			/* Where it looks away from the eye, see test_bent_normals. */
			if (spec_vector_dot(ray.direction, shading) < -0.01)
				expect_at(hit.shading, shading, bound, place,
					"shading normal");
		} else {
			expect_at(hit.shading, normal, 1e-9, place, "shading normal");
		}
		if (shape->uv) {
			double at[2] = {0};

			for (int j = 0; j < 3; j++)
				for (int k = 0; k < 2; k++)
					at[k] += weight[j] * shape->uv[2 * corner[j] + k];
			expect_near(hit.u, at[0], bound, place, "u of a mesh");
			expect_near(hit.v, at[1], bound, place, "v of a mesh");
		}
	}
}

static void
test_meshes(void **state)
{
	struct fixture *f = *state;

	for (size_t place = 0; place < PLACES; place++) {
		for (int kind = 0; kind < 4; kind++) {
			struct spec_scene_shape *shape =
				add_octahedron(f, &places[place], kind & 1, kind & 2);

			open_world(f);
			expect_mesh(f, place, shape);
			spec_world_close(f->world);
			f->world = NULL;
			free(shape->point);
			free(shape->index);
			free(shape->normal);
			free(shape->uv);
			memset(shape, 0, sizeof *shape);
			f->scene.shapes = 0;
		}
	}
}

/* pbrt: the vertices' normals say which side is outside, whatever the corners' order. */
static void
test_vertex_normals_rule(void **state)
{
	struct fixture *f = *state;
	struct spec_scene_shape *shape = add_octahedron(f, &places[3], 1, 0);
	struct spec_ray ray = {{0, 0, 11}, {0.05, 0.05, -1}};
	struct spec_hit hit;

	for (size_t i = 0; i < 8; i++) {
		uint32_t swap = shape->index[3 * i];

		shape->index[3 * i] = shape->index[3 * i + 1];
		shape->index[3 * i + 1] = swap;
	}
	ray.direction = spec_vector_unit(ray.direction);
	open_world(f);
	hit = meet(f, &ray);
	assert_true(spec_vector_dot(hit.normal, ray.direction) < 0);
	assert_true(spec_vector_dot(hit.shading, ray.direction) < 0);
	shape->reverse_orientation = 1;
	hit = meet(f, &ray);
	assert_true(spec_vector_dot(hit.normal, ray.direction) > 0);
	assert_true(spec_vector_dot(hit.shading, ray.direction) > 0);
}

/*
 * Who sees a face from outside does not see it from inside past a bent shading normal: glass
 * would widen the light by n^2, a film on metal would be black.
 */
static void
test_bent_normals(void **state)
{
	struct fixture *f = *state;
	unsigned bent = 0;

	add_octahedron(f, &places[0], 1, 0);
	open_world(f);
	for (int i = 0; i < 20000; i++) {
		struct spec_vector from = spec_vector_scale(any_direction(f), 3);
		struct spec_ray ray = ray_to(from, any_direction(f));
		struct spec_hit hit;
		double side;

		if (!spec_world_meet(f->world, &ray, &hit))
			continue;
		side = spec_vector_dot(ray.direction, hit.normal);
		bent += fabs(side) < 0.3;
		assert_true(side * spec_vector_dot(ray.direction, hit.shading) >= 0);
	}
	assert_true(bent > 300);
}

static void
test_reversed(void **state)
{
	struct fixture *f = *state;
	struct spec_ray ray = {{0.2, 0.1, 5}, {0, 0, -1}};
	struct spec_hit hit, reversed;

	add_shape(f, SPEC_SCENE_SPHERE, &places[0]);
	open_world(f);
	hit = meet(f, &ray);
	f->scene.shape->reverse_orientation = 1;
	reversed = meet(f, &ray);
	expect_at(reversed.normal, spec_vector_negate(hit.normal), 0, 0, "normal");
	expect_at(reversed.shading, reversed.normal, 0, 0, "shading normal");
	expect_at(reversed.tangent, hit.tangent, 0, 0, "tangent");
}

/* 0 to 1 in the mesh's box (specexr(5), Q): what gravity makes of a film goes by it. */
static void
test_mesh_object_coordinates(void **state)
{
	struct fixture *f = *state;
	struct spec_scene_shape *shape = add_octahedron(f, &places[2], 0, 0);

	for (size_t i = 0; i < 6; i++) /* a box that is not about 0 */
		shape->point[3 * i + 2] = 4 * shape->point[3 * i + 2] + 7;
	open_world(f);
	for (int i = 0; i < 100; i++) {
		struct spec_vector d = any_direction(f), middle = {0, 0, 7}, local;
		struct spec_ray ray = ray_to(through(shape->world.m, middle, 1),
			through(shape->world.m, spec_vector_along(middle, d, 9), 1));
		struct spec_hit hit = meet(f, &ray);

		local = through(shape->world.inverse, hit.point, 1);
		expect_at(hit.object,
			(struct spec_vector){
				(local.x + 1) / 2, (local.y + 1) / 2, (local.z - 3) / 8},
			1e-5, 2, "object coordinates of a mesh");
	}
}

/* --- dp/du: along it u grows, and v stays --- */

static struct spec_hit
meet_beside(struct fixture *f, const struct spec_hit *hit, struct spec_vector step,
	double length)
{
	struct spec_ray ray = {
		spec_vector_along(spec_vector_along(hit->point, step, length / 100),
			hit->normal, fabs(length) / 10),
		spec_vector_negate(hit->normal)};

	return meet(f, &ray);
}

static void
expect_tangent(struct fixture *f, size_t place, double size, const char *what)
{
	const struct spec_scene_shape *shape = f->scene.shape;

	for (int i = 0; i < 100; i++) {
		struct spec_vector to = through(shape->world.m, any_direction(f), 1),
				   across;
		struct spec_vector middle = {
			shape->world.m[0][3], shape->world.m[1][3], shape->world.m[2][3]};
		struct spec_ray ray = {
			spec_vector_along(middle, spec_vector_subtract(to, middle), 3),
			spec_vector_unit(spec_vector_subtract(middle, to))};
		struct spec_hit hit = meet(f, &ray), ahead, back, left, right;
		double du, dv, other;

		across = spec_vector_cross(hit.normal, hit.tangent);
		ahead = meet_beside(f, &hit, hit.tangent, size);
		back = meet_beside(f, &hit, hit.tangent, -size);
		left = meet_beside(f, &hit, across, size);
		right = meet_beside(f, &hit, across, -size);
		du = ahead.u - back.u;
		dv = ahead.v - back.v;
		other = left.v - right.v;
		/* Where u jumps, near a pole, or over a mesh's edge. */
		if (fabs(du) > 0.5 || fabs(hit.v - 0.5) > 0.45 ||
			(shape->kind == SPEC_SCENE_MESH &&
				(distance_of(ahead.normal, back.normal) > 1e-9 ||
					distance_of(left.normal, right.normal) > 1e-9)))
			continue;
		if (!(du > 0))
			fail_msg("place %zu: %s: u does not grow along dp/du but by %g",
				place, what, du);
		/* The second order: steps are 1/100 of the smallest axis. */
		if (!(fabs(dv) < 0.02 * fabs(other)))
			fail_msg("place %zu: %s: v changes by %g along dp/du, by %g across",
				place, what, dv, other);
	}
}

static void
test_tangents_of_quadrics(void **state)
{
	struct fixture *f = *state;
	struct spec_scene_shape *shape = add_shape(f, SPEC_SCENE_SPHERE, &places[0]);

	for (size_t place = 0; place < 5; place++) {
		shape->world = transform_of(&places[place]);
		open_world(f);
		expect_tangent(f, place, 0.3, "sphere");
	}
}

static void
test_tangents_of_meshes(void **state)
{
	struct fixture *f = *state;
	struct spec_scene_shape *shape = add_octahedron(f, &places[0], 0, 1);

	for (size_t place = 0; place < 5; place++) {
		shape->world = transform_of(&places[place]);
		open_world(f);
		expect_tangent(f, place, 0.3, "a mesh with uv");
	}
}

/* Where the file has no uv, those that stand in for them have a tangent, too. */
static void
test_tangents_without_uv(void **state)
{
	struct fixture *f = *state;
	struct spec_scene_shape *shape = add_octahedron(f, &places[0], 0, 0);

	for (size_t place = 0; place < 5; place++) {
		shape->world = transform_of(&places[place]);
		open_world(f);
		expect_tangent(f, place, 0.3, "a mesh without uv");
	}
}

/* --- leaving a surface --- */

static const double grazing[] = {1, 0.1, 1e-2, 1e-3, 1e-4, 1e-6, 1e-9};

/* A ray that leaves a convex body outwards never meets it again. */
static void
expect_no_return(struct fixture *f, size_t place, const char *what)
{
	const struct spec_scene_shape *shape = f->scene.shape;
	unsigned again = 0, all = 0;

	for (int i = 0; i < 2000; i++) {
		struct spec_vector to =
			through(shape->world.m, spec_vector_scale(any_direction(f), 3), 1);
		struct spec_vector middle = {
			shape->world.m[0][3], shape->world.m[1][3], shape->world.m[2][3]};
		struct spec_ray ray = ray_to(to, middle), away;
		struct spec_hit hit = meet(f, &ray), other;
		double cosine = grazing[(size_t)i % (sizeof grazing / sizeof *grazing)];

		if (hit.shape != 0)
			continue;
		away = spec_world_leave(
			f->world, &hit, direction_at(f, hit.normal, cosine));
		all++;
		again += spec_world_meet(f->world, &away, &other) && other.shape == 0;
	}
	if (again > 0)
		fail_msg("place %zu: %s: %u of %u rays meet the surface that they leave",
			place, what, again, all);
}

static void
test_no_return(void **state)
{
	struct fixture *f = *state;
	struct spec_scene_shape *shape = add_shape(f, SPEC_SCENE_SPHERE, &places[0]);

	for (size_t place = 0; place < PLACES; place++) {
		shape->world = transform_of(&places[place]);
		open_world(f);
		expect_no_return(f, place, "a sphere");
	}
	shape->kind = SPEC_SCENE_DISK;
	shape->radius = 2;
	for (size_t place = 0; place < PLACES; place++) {
		shape->world = transform_of(&places[place]);
		open_world(f);
		expect_no_return(f, place, "a disk");
	}
}

static void
test_no_return_to_meshes(void **state)
{
	struct fixture *f = *state;
	struct spec_scene_shape *shape = add_octahedron(f, &places[0], 0, 0);

	for (size_t place = 0; place < PLACES; place++) {
		shape->world = transform_of(&places[place]);
		open_world(f);
		expect_no_return(f, place, "a mesh");
	}
}

/*
 * A ray that leaves inwards crosses the sphere along a chord: the other end is 2 r cos away.
 * It may be off by 1/1000 of the radius: what a picture of a bubble could show.
 */
static void
expect_chords(struct fixture *f, size_t place)
{
	const struct spec_scene_shape *shape = f->scene.shape;
	double r = shape->radius * fabs(places[place].scale[0]);

	for (int i = 0; i < 1000; i++) {
		struct spec_vector middle = {
			shape->world.m[0][3], shape->world.m[1][3], shape->world.m[2][3]};
		struct spec_ray ray = {middle, any_direction(f)}, in;
		struct spec_hit hit = meet(f, &ray), other;
		double cosine = 0.02 + 0.98 * chance(f);
		struct spec_vector direction =
			direction_at(f, spec_vector_negate(hit.normal), cosine);

		in = spec_world_leave(f->world, &hit, direction);
		other = meet(f, &in);
		expect_at(other.point,
			spec_vector_along(hit.point, direction, 2 * r * cosine), 1e-3 * r,
			place, "the other end of a chord");
	}
}

static void
test_chords(void **state)
{
	static const size_t round[] = {0, 1, 3, 6, 7, 8};
	struct fixture *f = *state;
	struct spec_scene_shape *shape = add_shape(f, SPEC_SCENE_SPHERE, &places[0]);

	for (size_t i = 0; i < sizeof round / sizeof *round; i++) {
		shape->world = transform_of(&places[round[i]]);
		open_world(f);
		expect_chords(f, round[i]);
	}
}

/* A disc's two faces are 1.2 mm apart, whatever else is in the scene. */
static void
test_large_ground(void **state)
{
	struct fixture *f = *state;
	struct spec_scene_shape *shape = add_shape(f, SPEC_SCENE_DISK, &places[0]);
	struct spec_ray ray = {{0.03, 0.02, 1}, {0, 0, -1}};
	struct spec_hit hit, next;

	shape->radius = 0.06;
	shape->height = 1.2e-3;
	shape = add_shape(f, SPEC_SCENE_DISK, &places[0]);
	shape->radius = 0.06;
	shape = add_shape(f, SPEC_SCENE_DISK, &places[0]);
	shape->radius = 10000;
	shape->height = -1e-3;
	open_world(f);
	hit = meet(f, &ray);
	assert_int_equal(hit.shape, 0);
	ray = spec_world_leave(f->world, &hit, ray.direction);
	next = meet(f, &ray);
	assert_int_equal(next.shape, 1);
	expect_near(next.distance, 1.2e-3, 1e-5, 0, "from face to face");
	ray = spec_world_leave(f->world, &next, ray.direction);
	next = meet(f, &ray);
	assert_int_equal(next.shape, 2);
}

/* --- blocking, bounds, nothing --- */

static void
test_blocks(void **state)
{
	struct fixture *f = *state;
	struct spec_ray ray = {{0.1, 0.2, 6}, {0, 0, -1}};
	double at = 6 - sqrt(0.95);

	add_shape(f, SPEC_SCENE_SPHERE, &places[0]);
	add_octahedron(f, &places[3], 0, 0);
	f->scene.shape[1].world.m[2][3] = -100;
	f->scene.shape[1].world.inverse[2][3] = 100;
	open_world(f);
	assert_false(spec_world_blocks(f->world, &ray, 0));
	assert_false(spec_world_blocks(f->world, &ray, at * (1 - 1e-6)));
	assert_true(spec_world_blocks(f->world, &ray, at * (1 + 1e-6)));
	assert_true(spec_world_blocks(f->world, &ray, INFINITY));
	ray.origin.z = 0; /* from within */
	assert_false(spec_world_blocks(f->world, &ray, sqrt(0.95) * (1 - 1e-6)));
	assert_true(spec_world_blocks(f->world, &ray, sqrt(0.95) * (1 + 1e-6)));
	ray.origin.z = -10; /* the mesh is about 90 away */
	assert_false(spec_world_blocks(f->world, &ray, 85));
	assert_true(spec_world_blocks(f->world, &ray, 95));
	ray.direction.z = 1;
	ray.origin.x = 4;
	assert_false(spec_world_blocks(f->world, &ray, INFINITY));
}

/* Of several, the nearest, whatever their order and kinds. */
static void
test_nearest(void **state)
{
	struct fixture *f = *state;
	struct spec_ray ray = {{0.1, 0.2, 6}, {0, 0, -1}};

	add_octahedron(f, &places[0], 0, 0); /* its top at z = 0.7 there */
	add_shape(f, SPEC_SCENE_DISK, &places[0])->height = 0.9;
	add_shape(f, SPEC_SCENE_SPHERE, &places[0]); /* 0.97 */
	open_world(f);
	assert_int_equal(meet(f, &ray).shape, 2);
	ray.origin.z = 0.95;
	assert_int_equal(meet(f, &ray).shape, 1);
	ray.origin.z = 0.8;
	assert_int_equal(meet(f, &ray).shape, 0);
	ray.origin.z = -0.8;
	assert_int_equal(meet(f, &ray).shape, 2);
}

static void
test_nothing(void **state)
{
	struct fixture *f = *state;
	struct spec_ray ray = {{0, 0, 0}, {0, 0, 1}};
	struct spec_vector middle;
	struct spec_hit hit;
	double radius;

	open_world(f);
	assert_false(spec_world_meet(f->world, &ray, &hit));
	assert_false(spec_world_blocks(f->world, &ray, INFINITY));
	spec_world_bounds(f->world, &middle, &radius);
	assert_true(radius == 0);
}

static void
test_bounds(void **state)
{
	struct fixture *f = *state;
	struct spec_vector middle;
	double radius;

	for (size_t place = 0; place < 5; place++)
		add_shape(f, SPEC_SCENE_SPHERE, &places[place]);
	open_world(f);
	spec_world_bounds(f->world, &middle, &radius);
	assert_true(radius < 15);
	for (int i = 0; i < 1000; i++) {
		const struct spec_scene_shape *shape = &f->scene.shape[i % 5];
		struct spec_vector p = through(shape->world.m, any_direction(f), 1);

		assert_true(distance_of(p, middle) <= radius);
	}
}

#define TEST(name) cmocka_unit_test_setup_teardown(name, set_up, tear_down)

int
main(void)
{
	const struct CMUnitTest tests[] = {
		TEST(test_spheres),
		TEST(test_spheres_from_within_and_afar),
		TEST(test_disks),
		TEST(test_disk_edges),
		TEST(test_sphere_coordinates),
		TEST(test_meshes),
		TEST(test_vertex_normals_rule),
		TEST(test_bent_normals),
		TEST(test_reversed),
		TEST(test_mesh_object_coordinates),
		TEST(test_tangents_of_quadrics),
		TEST(test_tangents_of_meshes),
		TEST(test_tangents_without_uv),
		TEST(test_no_return),
		TEST(test_no_return_to_meshes),
		TEST(test_chords),
		TEST(test_large_ground),
		TEST(test_blocks),
		TEST(test_nearest),
		TEST(test_nothing),
		TEST(test_bounds),
	};

	return cmocka_run_group_tests_name("world", tests, NULL, NULL);
}
