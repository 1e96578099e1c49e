/* Light transport against closed forms: scenes are built by hand, without files. */
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdlib.h>
#include <string.h>

#include <cmocka.h>

#include "render/render.h"
#include "scene/scene.h"

#define PI 3.14159265358979323846

/*
 * A mean of estimates lies within 4 of its own standard errors of the truth but for one in
 * 16000; the seeds are fixed, so that a test that passed once passes always.
 */
#define SIGMAS 4

struct fixture {
	struct spec_scene scene;
	struct spec_settings settings;
	struct spec_grid grid;
	struct spec_render render;
	struct spec_path_room *room;
};

static void
check(enum spec_status status, const struct spec_error *error)
{
	if (status != SPEC_OK)
		fail_msg("%s", error->message);
}

static struct spec_transform
placed(double x, double y, double z)
{
	struct spec_transform t = {0};

	for (int i = 0; i < 4; i++)
		t.m[i][i] = t.inverse[i][i] = 1;
	t.m[0][3] = x;
	t.m[1][3] = y;
	t.m[2][3] = z;
	t.inverse[0][3] = -x;
	t.inverse[1][3] = -y;
	t.inverse[2][3] = -z;
	return t;
}

static struct spec_scene_spectrum
constant(double value)
{
	return (struct spec_scene_spectrum){.kind = SPEC_SCENE_CONSTANT, .value = value};
}

static struct fixture *
new_fixture(void)
{
	struct fixture *f = calloc(1, sizeof *f);
	struct spec_error error;

	assert_non_null(f);
	spec_settings_init(&f->settings);
	check(spec_grid_parse("400:700:100", &f->grid, &error), &error);
	f->scene.camera = placed(0, 0, 0);
	f->scene.fov_deg = 90;
	f->scene.width = f->scene.height = 1;
	f->scene.max_depth = 5;
	f->scene.material = calloc(8, sizeof *f->scene.material);
	f->scene.shape = calloc(8, sizeof *f->scene.shape);
	f->scene.light = calloc(8, sizeof *f->scene.light);
	return f;
}

static void
free_fixture(struct fixture *f)
{
	spec_path_room_free(f->room);
	spec_render_close(&f->render);
	spec_scene_free(&f->scene);
	spec_grid_free(&f->grid);
	free(f);
}

static struct spec_scene_material *
add_material(struct fixture *f, enum spec_scene_material_kind kind)
{
	struct spec_scene_material *material = &f->scene.material[f->scene.materials++];

	material->kind = kind;
	material->id = (uint32_t)f->scene.materials;
	material->reflectance = constant(0.5);
	material->eta = constant(1.5);
	material->k = constant(0);
	return material;
}

/* Of the last material, and without a light. */
static struct spec_scene_shape *
add_shape(struct fixture *f, enum spec_scene_shape_kind kind, double x, double y, double z,
	double radius)
{
	struct spec_scene_shape *shape = &f->scene.shape[f->scene.shapes++];

	shape->kind = kind;
	shape->world = placed(x, y, z);
	shape->radius = radius;
	shape->material = f->scene.materials - 1;
	shape->light = SPEC_SCENE_NONE;
	return shape;
}

static struct spec_scene_light *
add_light(struct fixture *f, enum spec_scene_light_kind kind, double value)
{
	struct spec_scene_light *light = &f->scene.light[f->scene.lights++];

	light->kind = kind;
	light->spectrum = constant(value);
	light->scale = 1;
	light->world = placed(0, 0, 0);
	return light;
}

static void
open_render(struct fixture *f)
{
	struct spec_render_setup setup = {.grid = &f->grid, .supersample = 1};
	struct spec_error error;

	check(spec_render_open(&f->render, &f->scene, &setup, &f->settings, &error),
		&error);
	f->room = spec_path_room_new(f->grid.count, &error);
	assert_non_null(f->room);
}

/* The mean radiance along a ray and its standard error, of the band given. */
static void
estimate(struct fixture *f, const struct spec_ray *ray, size_t band, unsigned samples,
	double *mean, double *deviation)
{
	double sum = 0, squares = 0;
	struct spec_sampler sampler;
	float radiance[16];

	for (unsigned i = 0; i < samples; i++) {
		memset(radiance, 0, sizeof radiance);
		spec_sampler_start(&sampler, 1, 0, 0, i);
		spec_path_trace(&f->render.tracer, ray, 0, 0, &sampler, f->room, radiance);
		sum += radiance[band];
		squares += (double)radiance[band] * radiance[band];
	}
	*mean = sum / samples;
	*deviation = sqrt(fmax(0, squares / samples - *mean * *mean) / samples);
}

/* The estimate is within SIGMAS of the wanted value, or within floor of it (relative). */
static void
expect(struct fixture *f, const struct spec_ray *ray, double wanted, unsigned samples,
	double floor, const char *what)
{
	double mean, deviation, bound;

	estimate(f, ray, 1, samples, &mean, &deviation);
	bound = fmax(SIGMAS * deviation, floor * wanted);
	if (!(fabs(mean - wanted) <= bound))
		fail_msg("%s: %.8g instead of %.8g +- %.2g", what, mean, wanted, bound);
	if (deviation > 0.05 * wanted)
		fail_msg(
			"%s: too noisy to say anything: %g of %g", what, deviation, wanted);
}

static struct spec_ray
ray_to(struct spec_vector from, struct spec_vector to)
{
	return (struct spec_ray){from, spec_vector_unit(spec_vector_subtract(to, from))};
}

/* --- a convex body in uniform surroundings sends back its albedo --- */

static void
furnace(struct fixture *f, double albedo, double tolerance, const char *what)
{
	static const double side[] = {0, 0.3, 0.7, 0.95, 0.999};
	struct spec_ray ray;

	add_light(f, SPEC_SCENE_INFINITE, 1);
	open_render(f);
	for (size_t i = 0; i < sizeof side / sizeof *side; i++) {
		ray = (struct spec_ray){{0, -5, side[i]}, {0, 1, 0}};
		expect(f, &ray, albedo, 4096, tolerance, what);
	}
	free_fixture(f);
}

static void
test_furnace_diffuse(void **state)
{
	struct fixture *f = new_fixture();

	(void)state;
	add_material(f, SPEC_SCENE_DIFFUSE)->reflectance = constant(0.5);
	add_shape(f, SPEC_SCENE_SPHERE, 0, 0, 0, 1);
	furnace(f, 0.5, 1e-5, "diffuse .5");
}

static void
test_furnace_dielectric(void **state)
{
	struct fixture *f = new_fixture();

	(void)state;
	f->scene.max_depth = 100;
	add_material(f, SPEC_SCENE_DIELECTRIC);
	add_shape(f, SPEC_SCENE_SPHERE, 0, 0, 0, 1);
	furnace(f, 1, 1e-5, "glass");
}

/* A clear film in uniform surroundings is not to be seen. */
static void
test_furnace_film(void **state)
{
	struct fixture *f = new_fixture();
	struct spec_scene_material *film;

	(void)state;
	f->scene.max_depth = 200;
	film = add_material(f, SPEC_SCENE_THINFILM);
	film->stack = strdup("air | 1.33 * | air");
	film->thickness = strdup("gravity 200nm..700nm");
	add_shape(f, SPEC_SCENE_SPHERE, 0, 0, 0, 1);
	furnace(f, 1, 1e-5, "a clear bubble");
}

/* A metal that reflects all: n = 0. */
static void
test_furnace_mirror(void **state)
{
	struct fixture *f = new_fixture();
	struct spec_scene_material *metal;

	(void)state;
	metal = add_material(f, SPEC_SCENE_CONDUCTOR);
	metal->eta = constant(0);
	metal->k = constant(3);
	add_shape(f, SPEC_SCENE_SPHERE, 0, 0, 0, 1);
	furnace(f, 1, 1e-5, "a mirror");
}

/* --- irradiance of a diffuse plane, in closed form: L = rho E / pi --- */

static struct fixture *
new_floor(void)
{
	struct fixture *f = new_fixture();

	add_material(f, SPEC_SCENE_DIFFUSE)->reflectance = constant(0.6);
	add_shape(f, SPEC_SCENE_DISK, 0, 0, 0, 10);
	f->scene.max_depth = 1;
	return f;
}

static void
expect_irradiance(struct fixture *f, double irradiance, unsigned samples, const char *what)
{
	struct spec_ray ray =
		ray_to((struct spec_vector){3, 0, 0.5}, (struct spec_vector){0, 0, 0});

	open_render(f);
	expect(f, &ray, 0.6 * irradiance / PI, samples, 1e-5, what);
	free_fixture(f);
}

static void
test_point(void **state)
{
	struct fixture *f = new_floor();
	struct spec_scene_light *light = add_light(f, SPEC_SCENE_POINT, 5);

	(void)state;
	light->from[0] = 1;
	light->from[2] = 2;
	expect_irradiance(f, 5.0 * 2 / pow(5, 1.5), 16, "a point");
}

static void
test_distant(void **state)
{
	struct fixture *f = new_floor();
	struct spec_scene_light *light = add_light(f, SPEC_SCENE_DISTANT, 3);

	(void)state;
	light->from[1] = 3;
	light->from[2] = 4;
	expect_irradiance(f, 3 * 0.8, 16, "a distant light");
}

/* A sphere wholly above the horizon: E = pi L (r / d)^2 cos. */
static void
test_sphere(void **state)
{
	struct fixture *f = new_floor();
	struct spec_scene_light *light = add_light(f, SPEC_SCENE_AREA, 7);

	(void)state;
	(void)light;
	add_shape(f, SPEC_SCENE_SPHERE, 1, 0, 2, 0.5)->light = 0;
	expect_irradiance(f, PI * 7 * 0.25 / 5 * (2 / sqrt(5)), 4096, "a sphere");
}

/* A disk right above, parallel: E = pi L r^2 / (r^2 + h^2). */
static void
test_disk(void **state)
{
	struct fixture *f = new_floor();
	struct spec_scene_shape *disk;

	(void)state;
	add_light(f, SPEC_SCENE_AREA, 2);
	disk = add_shape(f, SPEC_SCENE_DISK, 0, 0, 2, 1);
	disk->light = 0;
	disk->reverse_orientation = 1;
	expect_irradiance(f, PI * 2 / (1 + 4.0), 4096, "a disk");
}

/* The same with the diffuse floor alone finding it: both ways have one expectation. */
static void
test_surroundings(void **state)
{
	struct fixture *f = new_floor();

	(void)state;
	add_light(f, SPEC_SCENE_INFINITE, 1.5);
	expect_irradiance(f, PI * 1.5, 4096, "uniform surroundings");
}

/* --- a closed room whose walls shine and reflect: L = Le / (1 - rho) --- */

static void
test_closed_room(void **state)
{
	struct fixture *f = new_fixture();
	struct spec_scene_shape *wall;
	struct spec_ray ray = {{0.2, 0.1, 0.3}, {0, 0.6, 0.8}};

	(void)state;
	f->scene.max_depth = 100;
	add_material(f, SPEC_SCENE_DIFFUSE)->reflectance = constant(0.5);
	add_light(f, SPEC_SCENE_AREA, 1);
	wall = add_shape(f, SPEC_SCENE_SPHERE, 0, 0, 0, 1);
	wall->light = 0;
	wall->reverse_orientation = 1;
	open_render(f);
	expect(f, &ray, 2, 4096, 1e-4, "a closed room");
	free_fixture(f);
}

int
main(void)
{
	const struct CMUnitTest tests[] = {
		cmocka_unit_test(test_furnace_diffuse),
		cmocka_unit_test(test_furnace_dielectric),
		cmocka_unit_test(test_furnace_film),
		cmocka_unit_test(test_furnace_mirror),
		cmocka_unit_test(test_point),
		cmocka_unit_test(test_distant),
		cmocka_unit_test(test_sphere),
		cmocka_unit_test(test_disk),
		cmocka_unit_test(test_surroundings),
		cmocka_unit_test(test_closed_room),
	};

	return cmocka_run_group_tests_name("render", tests, NULL, NULL);
}
