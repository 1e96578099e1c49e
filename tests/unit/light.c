/* Light sources: what they send against closed forms, and how they are chosen. */
#include <stdio.h>
#include <stdlib.h>
#include <unistd.h>

#include "image/save.h"
#include "render/light.h"
#include "scene/scene.h"
#include "scene/transform.h"

#include "check.h"
#include "shapes.h"

#define PI 3.14159265358979323846
#define BANDS 4
#define SAMPLES 4096

/*
 * A mean of estimates lies within 4 of its own standard errors of the truth but for one in
 * 16000; the seeds are fixed, so that a test that passed once passes always.
 */
#define SIGMAS 4
#define ROUNDED 1e-6 /* values are floats */

struct fixture {
	struct spec_scene scene;
	struct spec_settings settings;
	struct spec_grid grid;
	struct spec_bands_grid bands;
	struct spec_world *world;
	struct spec_lights *lights;
	uint64_t seed;
	char picture[64];     /* a file's name, or "" */
	const char *quantity; /* of the picture, or null */
};

static int
set_up(void **state)
{
	struct fixture *f = calloc(1, sizeof *f);
	struct spec_error error;

	assert_non_null(f);
	spec_settings_init(&f->settings);
	f->settings.threads = 1;
	check(spec_grid_parse("400:700:100", &f->grid, &error), &error);
	check(spec_bands_make(&f->bands, &f->grid, SPEC_EXTRAPOLATE_REFUSE, &error),
		&error);
	f->scene.shape = calloc(8, sizeof *f->scene.shape);
	f->scene.light = calloc(8, sizeof *f->scene.light);
	f->scene.material = calloc(1, sizeof *f->scene.material);
	f->scene.materials = 1;
	*state = f;
	return 0;
}

static void
close_lights(struct fixture *f)
{
	spec_lights_free(f->lights);
	spec_world_close(f->world);
	f->lights = NULL;
	f->world = NULL;
}

static int
tear_down(void **state)
{
	struct fixture *f = *state;

	close_lights(f);
	spec_scene_free(&f->scene);
	spec_bands_free(&f->bands);
	spec_grid_free(&f->grid);
	if (f->picture[0])
		unlink(f->picture);
	free(f);
	return 0;
}

static void
open_lights(struct fixture *f)
{
	struct spec_error error;

	close_lights(f);
	check(spec_world_open(&f->world, &f->scene, &error), &error);
	check(spec_lights_make(
		      &f->lights, &f->scene, f->world, &f->bands, &f->settings, &error),
		&error);
}

/* --- scenes --- */

static struct spec_scene_light *
add_light(struct fixture *f, enum spec_scene_light_kind kind, double value)
{
	struct spec_scene_light *light = &f->scene.light[f->scene.lights++];

	*light = (struct spec_scene_light){.kind = kind,
		.spectrum = {.kind = SPEC_SCENE_CONSTANT, .value = value},
		.scale = 1,
		.world = spec_transform_identity()};
	return light;
}

/* With the last light. */
static struct spec_scene_shape *
add_shape(struct fixture *f, enum spec_scene_shape_kind kind)
{
	struct spec_scene_shape *shape = &f->scene.shape[f->scene.shapes++];

	*shape = (struct spec_scene_shape){.kind = kind,
		.world = spec_transform_identity(),
		.radius = 1,
		.light = f->scene.lights - 1};
	return shape;
}

static struct spec_vector
through(const struct spec_transform *transform, struct spec_vector v, int is_point)
{
	const double(*m)[4] = transform->m;
	double w = is_point;

	return (struct spec_vector){
		m[0][0] * v.x + m[0][1] * v.y + m[0][2] * v.z + w * m[0][3],
		m[1][0] * v.x + m[1][1] * v.y + m[1][2] * v.z + w * m[1][3],
		m[2][0] * v.x + m[2][1] * v.y + m[2][2] * v.z + w * m[2][3]};
}

/* --- irradiance --- */

static double
value_of(const struct spec_light_sample *light, size_t band)
{
	return light->radiance.value[band] * light->radiance.scale;
}

/* The mean of value times cosine over samples, unshadowed, of one band. */
static void
estimate(struct fixture *f, struct spec_vector point, struct spec_vector normal,
	unsigned samples, double *mean, double *deviation)
{
	double sum = 0, squares = 0;
	float room[BANDS];
	struct spec_light_sample light = {.radiance.room = room};

	f->seed++;
	for (unsigned i = 0; i < samples; i++) {
		struct spec_sampler sampler;
		double cosine;

		/* In blocks of 64 from pixels of their own: these are independent. */
		spec_sampler_start(&sampler, f->seed, (int)(i / 64), 0, i % 64);
		if (!spec_lights_sample(f->lights, point, &sampler, &light))
			continue;
		near(spec_vector_length(light.direction), 1, 1e-9, "a direction");
		cosine = fmax(0, spec_vector_dot(light.direction, normal));
		sum += cosine * value_of(&light, 1);
		squares += pow(cosine * value_of(&light, 1), 2);
	}
	*mean = sum / samples;
	*deviation = sqrt(fmax(0, squares / samples - *mean * *mean) / samples);
}

static void
expect_irradiance(struct fixture *f, struct spec_vector point, struct spec_vector normal,
	double wanted, const char *what)
{
	double mean, deviation;

	estimate(f, point, normal, SAMPLES, &mean, &deviation);
	near(mean, wanted, SIGMAS * deviation + ROUNDED * wanted, what);
	if (deviation > 0.1 * wanted)
		fail_msg("%s: too noisy to say anything", what);
}

static const struct spec_vector up = {0, 0, 1}, down = {0, 0, -1};

/* --- spheres --- */

/* Wholly above the horizon: pi L (r/d)^2 cos. */
static void
test_sphere_outside(void **state)
{
	struct fixture *f = *state;
	struct spec_scene_shape *shape;
	static const struct place places[] = {
		{{1, 1, 1}, 0, {0, 0, 1}, {0, 0, 0}},
		{{0.5, 0.5, 0.5}, 50, {1, 2, 3}, {0, 0, 0}},
		{{-0.2, 0.2, 0.2}, 50, {1, 0, 0}, {1, 0, 0}}, /* mirrored */
		{{0.01, 0.01, 0.01}, 0, {0, 0, 1}, {0, 0, 0}},
	};

	add_light(f, SPEC_SCENE_AREA, 3);
	shape = add_shape(f, SPEC_SCENE_SPHERE);
	for (size_t i = 0; i < sizeof places / sizeof *places; i++) {
		double r = fabs(places[i].scale[0]), x = places[i].move[0];

		shape->world = transform_of(&places[i]);
		open_lights(f);
		for (double height = 1.5; height < 500; height *= 6)
			expect_irradiance(f, (struct spec_vector){0, 0, -height}, up,
				3 * PI * r * r * height / pow(height * height + x * x, 1.5),
				"a sphere");
	}
	/* From outside the inside is not to be seen. */
	shape->reverse_orientation = 1;
	open_lights(f);
	expect_irradiance(f, (struct spec_vector){0, 0, -3}, up, 0, "its dark outside");
	f->scene.light->twosided = 1;
	open_lights(f);
	expect_irradiance(
		f, (struct spec_vector){0, 0, -3}, up, 3 * PI * 1e-4 / 9, "two sides");
}

static const struct place bubble = {
	{0.05, 0.05, 0.05}, 20, {0, 1, 0}, {600, 0, -800}}; /* 1 km off */

/* The wall all around has one radiance: pi L. */
static void
test_sphere_inside(void **state)
{
	struct fixture *f = *state;
	struct spec_scene_shape *shape;
	static const double way[][3] = {
		{0, 0, 0}, {0.3, 0.2, 0.1}, {0, 0, 0.9}, {0.57, 0.57, 0.57}};

	add_light(f, SPEC_SCENE_AREA, 3);
	shape = add_shape(f, SPEC_SCENE_SPHERE);
	shape->world = transform_of(&bubble);
	shape->reverse_orientation = 1;
	for (int kind = 0; kind < 3; kind++) { /* reversed, two sides, outside alone */
		shape->reverse_orientation = kind == 0;
		f->scene.light->twosided = kind == 1;
		open_lights(f);
		for (size_t i = 0; i < sizeof way / sizeof *way; i++) {
			struct spec_vector p = through(&shape->world,
				(struct spec_vector){way[i][0], way[i][1], way[i][2]}, 1);
			double wanted = kind < 2 ? 3 * PI : 0;

			expect_irradiance(f, p, up, wanted, "in a sphere");
			expect_irradiance(f, p, down, wanted, "in a sphere");
		}
	}
}

/* On the wall itself, wherever rounding puts its points: all other points shine on it. */
static void
test_sphere_surface(void **state)
{
	struct fixture *f = *state;
	struct spec_scene_shape *shape;

	add_light(f, SPEC_SCENE_AREA, 3);
	shape = add_shape(f, SPEC_SCENE_SPHERE);
	shape->world = transform_of(&bubble);
	for (int twosided = 0; twosided < 2; twosided++) {
		f->scene.light->twosided = twosided;
		shape->reverse_orientation = !twosided;
		open_lights(f);
		for (int i = 0; i < 40; i++) {
			double z = (i + 0.5) / 20 - 1, r = sqrt(1 - z * z);
			struct spec_vector d = {r * cos(i * 2.4), r * sin(i * 2.4), z};
			struct spec_vector p = through(&shape->world, d, 1);
			struct spec_vector out =
				spec_vector_unit(through(&shape->world, d, 0));

			expect_irradiance(
				f, p, spec_vector_negate(out), 3 * PI, "on a wall");
			/* The convex side does not light itself. */
			expect_irradiance(f, p, out, 0, "on the other side");
		}
	}
}

static void
test_stretched_sphere_is_refused(void **state)
{
	struct fixture *f = *state;
	static const struct place place = {{1, 2, 1}, 50, {1, 2, 3}, {0, 0, 0}};
	struct spec_error error;

	f->scene.files = 1;
	f->scene.file = calloc(1, sizeof *f->scene.file);
	f->scene.file[0] = strdup("a.pbrt");
	add_light(f, SPEC_SCENE_AREA, 3);
	add_shape(f, SPEC_SCENE_SPHERE)->world = transform_of(&place);
	check(spec_world_open(&f->world, &f->scene, &error), &error);
	assert_int_equal(spec_lights_make(&f->lights, &f->scene, f->world, &f->bands,
				 &f->settings, &error),
		SPEC_EUNSUPPORTED);
	assert_null(f->lights);
}

/* --- disks --- */

/* An ellipse of half axes a and b, parallel, at height h above: pi L a b / sqrt(..). */
static double
ellipse(double a, double b, double h)
{
	return PI * a * b / sqrt((a * a + h * h) * (b * b + h * h));
}

static void
test_disk(void **state)
{
	struct fixture *f = *state;
	struct spec_scene_shape *shape;
	struct place place = {{1, 1, 1}, 0, {0, 0, 1}, {0, 0, 0}};

	add_light(f, SPEC_SCENE_AREA, 2);
	shape = add_shape(f, SPEC_SCENE_DISK);
	shape->radius = 2;
	for (int i = 0; i < 8; i++) {
		double x, y, wanted, outer, inner, normal;

		place.scale[0] = i & 1 ? -1.5 : 1;
		place.scale[1] = i & 2 ? 0.5 : 1;
		place.scale[2] = i & 4 ? -1 : 1;
		place.turn_deg = 30. * i;
		shape->world = transform_of(&place);
		shape->height = 0.25;
		shape->inner_radius = i >= 3 ? 0.7 : 0;
		normal = place.scale[2]; /* outward is along the object's z */
		x = fabs(place.scale[0]);
		y = place.scale[1];
		outer = ellipse(2 * x, 2 * y, 1);
		inner = ellipse(shape->inner_radius * x, shape->inner_radius * y, 1);
		wanted = 2 * (outer - inner);
		open_lights(f);
		expect_irradiance(f, (struct spec_vector){0, 0, normal * 1.25},
			normal > 0 ? down : up, wanted, "a disk");
		expect_irradiance(f, (struct spec_vector){0, 0, normal * -0.75},
			normal > 0 ? up : down, 0, "a disk from behind");
		shape->reverse_orientation = 1;
		open_lights(f);
		expect_irradiance(f, (struct spec_vector){0, 0, normal * -0.75},
			normal > 0 ? up : down, wanted, "a reversed disk");
		expect_irradiance(f, (struct spec_vector){0, 0, normal * 1.25},
			normal > 0 ? down : up, 0, "a reversed disk from behind");
		shape->reverse_orientation = 0;
		f->scene.light->twosided = 1;
		open_lights(f);
		expect_irradiance(f, (struct spec_vector){0, 0, normal * 1.25},
			normal > 0 ? down : up, wanted, "a disk of two sides");
		expect_irradiance(f, (struct spec_vector){0, 0, normal * -0.75},
			normal > 0 ? up : down, wanted, "a disk of two sides");
		f->scene.light->twosided = 0;
	}
}

/* --- meshes --- */

/* Two triangles in z = 0 of different sizes, outward along z. */
static struct spec_scene_shape *
add_mesh(struct fixture *f)
{
	static const float point[] = {0, 0, 0, 2, 0, 0, 0, 1, 0, -0.2f, -0.1f, 0};
	static const uint32_t index[] = {0, 1, 2, 0, 2, 3};
	struct spec_scene_shape *shape = add_shape(f, SPEC_SCENE_MESH);

	shape->vertices = 4;
	shape->triangles = 2;
	shape->point = copy_of(point, sizeof point);
	shape->index = copy_of(index, sizeof index);
	return shape;
}

/* Lambert's formula: half the sum of edges' angles times their planes' normals. */
static double
polygons(const struct spec_scene_shape *shape, struct spec_vector point,
	struct spec_vector normal)
{
	double whole = 0;

	for (size_t t = 0; t < shape->triangles; t++) {
		struct spec_vector v[3];
		double sum = 0;

		for (size_t i = 0; i < 3; i++) {
			const float *p = shape->point + 3 * shape->index[3 * t + i];

			v[i] = spec_vector_unit(spec_vector_subtract(
				through(&shape->world,
					(struct spec_vector){p[0], p[1], p[2]}, 1),
				point));
		}
		for (size_t i = 0; i < 3; i++) {
			struct spec_vector a = v[i], b = v[(i + 1) % 3];
			struct spec_vector across = spec_vector_cross(a, b);

			sum += acos(spec_vector_dot(a, b)) *
			       spec_vector_dot(spec_vector_unit(across), normal) / 2;
		}
		whole += fabs(sum);
	}
	return whole;
}

static const struct place mesh_places[] = {
	{{1, 1, 1}, 0, {0, 0, 1}, {0, 0, 0}},
	{{3, 0.5, 2}, 20, {1, 1, 0}, {0, 0, 0}},
	{{-1, 1, 1}, 20, {1, 0, 0}, {0.2, 0, 0}},
	{{1, -2, -1}, 20, {1, 1, 1}, {0, 0, 0}},
	{{-1, -2, -0.5}, 15, {0, 1, 0}, {0, 0, 0}},
};

/* Both sides of a mesh, lit as its outward normal says: along the object's z. */
static void
expect_mesh(struct fixture *f, const struct spec_scene_shape *shape, double outward,
	const char *what)
{
	struct spec_vector x = through(&shape->world, (struct spec_vector){1, 0, 0}, 0);
	struct spec_vector y = through(&shape->world, (struct spec_vector){0, 1, 0}, 0);
	struct spec_vector z = through(&shape->world, (struct spec_vector){0, 0, 1}, 0);
	struct spec_vector n = spec_vector_unit(spec_vector_cross(x, y));
	struct spec_vector middle =
		through(&shape->world, (struct spec_vector){0.3, 0.2, 0}, 1);

	if (spec_vector_dot(n, z) * outward < 0)
		n = spec_vector_negate(n);
	open_lights(f);
	for (int side = -1; side < 2; side += 2) {
		struct spec_vector point = spec_vector_along(middle, n, 1.5 * side);
		struct spec_vector normal = spec_vector_scale(n, -side);
		int lit = side > 0 || f->scene.light->twosided;

		expect_irradiance(f, point, normal,
			lit ? 2 * polygons(shape, point, normal) : 0, what);
	}
}

static void
test_mesh(void **state)
{
	struct fixture *f = *state;
	struct spec_scene_shape *shape;

	add_light(f, SPEC_SCENE_AREA, 2);
	shape = add_mesh(f);
	for (size_t i = 0; i < sizeof mesh_places / sizeof *mesh_places; i++) {
		shape->world = transform_of(&mesh_places[i]);
		expect_mesh(f, shape, 1, "a mesh");
		shape->reverse_orientation = 1;
		expect_mesh(f, shape, -1, "a reversed mesh");
		shape->reverse_orientation = 0;
		f->scene.light->twosided = 1;
		expect_mesh(f, shape, 1, "a mesh of two sides");
		f->scene.light->twosided = 0;
	}
}

/* pbrt: the vertices' normals say which side is outward, whatever the corners' order. */
static void
test_mesh_normals(void **state)
{
	static const float back[] = {0, 0, -1, 0, 0, -1, 0, 0.1f, -1, 0, 0, -1};
	struct fixture *f = *state;
	struct spec_scene_shape *shape;

	add_light(f, SPEC_SCENE_AREA, 2);
	shape = add_mesh(f);
	shape->normal = copy_of(back, sizeof back);
	for (size_t i = 0; i < sizeof mesh_places / sizeof *mesh_places; i++) {
		shape->world = transform_of(&mesh_places[i]);
		expect_mesh(f, shape, -1, "a mesh with normals");
		shape->reverse_orientation = 1;
		expect_mesh(f, shape, 1, "a reversed mesh with normals");
		shape->reverse_orientation = 0;
	}
}

/* --- surroundings --- */

static const struct place sky_places[] = {
	{{1, 1, 1}, 0, {0, 0, 1}, {0, 0, 0}},
	{{1, 1, 1}, 60, {1, 2, 3}, {5, 0, 0}},
	{{-1, 1, 1}, 60, {1, 2, 3}, {0, 0, 0}},
	{{7, 7, 7}, 60, {1, 2, 3}, {0, 0, 0}},
};

static void
test_constant_sky(void **state)
{
	static const struct place stretched = {{3, 1, 0.5}, 60, {1, 2, 3}, {0, 0, 0}};
	struct fixture *f = *state;
	struct spec_scene_light *light = add_light(f, SPEC_SCENE_INFINITE, 1.5);

	add_shape(f, SPEC_SCENE_SPHERE)->light = SPEC_SCENE_NONE;
	for (size_t i = 0; i < sizeof sky_places / sizeof *sky_places; i++) {
		light->world = transform_of(&sky_places[i]);
		open_lights(f);
		expect_irradiance(f, (struct spec_vector){3, 4, 5},
			spec_vector_unit((struct spec_vector){1, 2, 3}), PI * 1.5,
			"a constant sky");
	}
	light->world = transform_of(&stretched);
	open_lights(f);
	expect_irradiance(f, (struct spec_vector){3, 4, 5},
		spec_vector_unit((struct spec_vector){1, 2, 3}), PI * 1.5,
		"a constant sky in a stretched space");
}

#define SKY_WIDTH 16
#define SKY_HEIGHT 8

/* A picture's pixel at the wavelength [nm]: anything, and one pixel is a sun. */
static double
sky_at(int x, int y, double wavelength_nm)
{
	double value = 1 + (x * 7 + y * 3) % 5;

	if (x == 0 && y == 2)
		value = 20000;
	return value * wavelength_nm / 500;
}

static double
flat_at(int x, int y, double wavelength_nm)
{
	(void)x;
	(void)y;
	return wavelength_nm / 500;
}

struct sky {
	struct spec_image image;
	double (*at)(int x, int y, double wavelength_nm);
};

static enum spec_status
sky_line(void *state, struct spec_stream_worker *worker, int line, struct spec_error *error)
{
	struct sky *sky = state;
	float *const *plane;
	enum spec_status status = spec_packer_begin(worker->packer, line, &plane, error);

	for (size_t i = 0; i < sky->image.bands && status == SPEC_OK; i++)
		for (int x = 0; x < SKY_WIDTH; x++)
			plane[sky->image.band_channel[i]][x] =
				(float)sky->at(x, line, sky->image.wavelength_nm[i]);
	return status == SPEC_OK ? spec_packer_end(worker->packer, line, error) : status;
}

/* Its bands are others than ours, and it reaches as far. */
static struct spec_scene_light *
add_sky(struct fixture *f, double (*at)(int x, int y, double wavelength_nm), double scale)
{
	static const double wavelength_nm[] = {380, 460, 550, 640, 720};
	struct spec_window window = {0, 0, SKY_WIDTH, SKY_HEIGHT};
	struct sky sky = {.image = {.data = window,
				  .display = window,
				  .pixel_aspect_ratio = 1,
				  .screen_window_width = 1},
		.at = at};
	struct spec_stream stream = {
		.lines = SKY_HEIGHT, .lines_in = 1, .state = &sky, .kernel = sky_line};
	struct spec_scene_light *light = add_light(f, SPEC_SCENE_INFINITE, 1);
	unsigned long long overflows;
	struct spec_error error;
	int file;

	strcpy(f->picture, "/tmp/light.XXXXXX.exr");
	file = mkstemps(f->picture, 4);
	assert_true(file >= 0);
	close(file);
	check(spec_image_add_bands(&sky.image, SPEC_ROLE_EMISSIVE, 1, wavelength_nm, 5,
		      SPEC_SAMPLE_FLOAT, &error),
		&error);
	if (f->quantity)
		check(spec_image_set_text(&sky.image, "spec:quantity", f->quantity, &error),
			&error);
	check(spec_image_index(&sky.image, "a sky", &error), &error);
	f->settings.output = f->picture;
	check(spec_image_save(&sky.image, &stream, &f->settings, &overflows, &error),
		&error);
	spec_image_clear(&sky.image);
	light->picture = strdup(f->picture);
	light->scale = scale;
	add_shape(f, SPEC_SCENE_SPHERE)->light = SPEC_SCENE_NONE; /* what is lit */
	return light;
}

static struct spec_vector
sky_direction(double x, double y)
{
	double azimuth = 2 * PI * x / SKY_WIDTH, polar = PI * y / SKY_HEIGHT;

	return (struct spec_vector){
		sin(polar) * cos(azimuth), sin(polar) * sin(azimuth), cos(polar)};
}

/* The second band's radiance, at 500 nm: linear between the picture's bands, as sky_at is. */
static double
sky_radiance(const struct fixture *f, struct spec_vector direction)
{
	static const float whole[BANDS] = {1, 1, 1, 1};
	float with[BANDS] = {0}, without[BANDS] = {0};

	spec_lights_add_surroundings(f->lights, direction, whole, 2, with);
	spec_lights_add_surroundings(f->lights, direction, NULL, 2, without);
	assert_memory_equal(with, without, sizeof with);
	return with[1] / 2;
}

/* Pixels are met at their middles, and between them it is linear, across the seam, too. */
static void
test_sky_lookup(void **state)
{
	struct fixture *f = *state;
	struct spec_scene_light *light = add_sky(f, sky_at, 0.5);

	for (size_t i = 0; i < sizeof sky_places / sizeof *sky_places; i++) {
		light->world = transform_of(&sky_places[i]);
		open_lights(f);
		for (int y = 0; y < SKY_HEIGHT; y++) {
			for (int x = 0; x < SKY_WIDTH; x++) {
				struct spec_vector d = spec_vector_unit(through(
					&light->world, sky_direction(x + 0.5, y + 0.5), 0));
				double here = sky_at(x, y, 500);
				double next = sky_at((x + 1) % SKY_WIDTH, y, 500);

				near(sky_radiance(f, d), here / 2, 1e-5 * here,
					"a pixel's middle");
				d = spec_vector_unit(through(
					&light->world, sky_direction(x + 1, y + 0.5), 0));
				near(sky_radiance(f, d), (here + next) / 4,
					1e-5 * (here + next), "a pixel's edge");
			}
		}
	}
}

/* A sum over directions: error below 1e-4, as a grid twice as fine tells. */
static double
sky_irradiance(const struct fixture *f, const struct spec_transform *world,
	struct spec_vector normal)
{
	enum { FINE = 40 };
	double sum = 0;

	for (int y = 0; y < SKY_HEIGHT * FINE; y++) {
		double polar = PI * (y + 0.5) / (SKY_HEIGHT * FINE);
		double size = PI / (SKY_HEIGHT * FINE) * 2 * PI / (SKY_WIDTH * FINE);

		for (int x = 0; x < SKY_WIDTH * FINE; x++) {
			struct spec_vector d = spec_vector_unit(through(world,
				sky_direction((x + 0.5) / FINE, (y + 0.5) / FINE), 0));

			sum += sky_radiance(f, d) * sin(polar) * size *
			       fmax(0, spec_vector_dot(d, normal));
		}
	}
	return sum;
}

static void
test_sky(void **state)
{
	struct fixture *f = *state;
	struct spec_scene_light *light = add_sky(f, sky_at, 0.5);
	struct spec_vector normal = spec_vector_unit((struct spec_vector){2, 1, 3});

	for (size_t i = 0; i < sizeof sky_places / sizeof *sky_places; i++) {
		double wanted, mean, deviation;

		light->world = transform_of(&sky_places[i]);
		open_lights(f);
		wanted = sky_irradiance(f, &light->world, normal);
		estimate(f, (struct spec_vector){1, 2, 3}, normal, 8 * SAMPLES, &mean,
			&deviation);
		near(mean, wanted, SIGMAS * deviation + 1e-4 * wanted, "a sky");
	}
}

static void
test_flat_sky(void **state)
{
	struct fixture *f = *state;

	add_sky(f, flat_at, 3);
	open_lights(f);
	expect_irradiance(f, (struct spec_vector){1, 2, 3}, up, 3 * PI, "a flat sky");
}

/* Values per band are not taken for values per nm. */
static void
test_sky_per_band(void **state)
{
	struct fixture *f = *state;
	struct spec_error error;

	f->quantity = "radiance per band";
	f->scene.files = 1;
	f->scene.file = calloc(1, sizeof *f->scene.file);
	f->scene.file[0] = strdup("a.pbrt");
	add_sky(f, flat_at, 1);
	check(spec_world_open(&f->world, &f->scene, &error), &error);
	assert_int_equal(spec_lights_make(&f->lights, &f->scene, f->world, &f->bands,
				 &f->settings, &error),
		SPEC_EUNSUPPORTED);
}

/*
 * A sun's light, spread between pixels, is looked for where it comes from: no direction sends
 * many times what it is chosen for, or a picture would be speckled.
 */
static void
test_sun(void **state)
{
	struct fixture *f = *state;
	double whole = 0, worst = 0;

	add_sky(f, sky_at, 1);
	open_lights(f);
	for (int y = 0; y < 160; y++) {
		for (int x = 0; x < 320; x++) {
			struct spec_vector d =
				sky_direction((x + 0.5) / 20, (y + 0.5) / 20);
			double radiance = sky_radiance(f, d);
			double density = spec_lights_surroundings_density(f->lights, d);

			whole += radiance * sqrt(1 - d.z * d.z) * PI / 160 * 2 * PI / 320;
			worst = fmax(worst, radiance / density);
		}
	}
	/* A corner of the sun's neighbour has 16 times that pixel's mean. */
	if (worst > 20 * whole)
		fail_msg("a direction sends %g times what it is chosen for", worst / whole);
}

/* --- choices and densities --- */

/* One of each kind, apart from each other. */
static void
add_all(struct fixture *f)
{
	struct spec_scene_light *light;
	struct spec_scene_shape *shape;

	light = add_light(f, SPEC_SCENE_POINT, 4);
	light->from[2] = 3;
	light = add_light(f, SPEC_SCENE_DISTANT, 0.1);
	light->from[0] = 0.6;
	light->from[2] = 0.8;
	add_light(f, SPEC_SCENE_INFINITE, 0.02);
	light = add_light(f, SPEC_SCENE_AREA, 1);
	light->twosided = 1;
	shape = add_shape(f, SPEC_SCENE_SPHERE);
	shape->radius = 0.5;
	shape->world.m[0][3] = 3;
	shape->world.inverse[0][3] = -3;
	shape = add_shape(f, SPEC_SCENE_DISK);
	shape->world.m[1][3] = 3;
	shape->world.inverse[1][3] = -3;
	shape->world.m[2][3] = 2;
	shape->world.inverse[2][3] = -2;
	shape->inner_radius = 0.2;
	shape = add_mesh(f);
	shape->world.m[2][3] = 1;
	shape->world.inverse[2][3] = -1;
}

/* What a ray meets in a sampled direction says the same as the sample. */
static void
test_densities(void **state)
{
	struct fixture *f = *state;
	unsigned count[4] = {0};
	const struct spec_vector point = {0.5, 0.4, -1};

	add_all(f);
	open_lights(f);
	for (uint32_t i = 0; i < 20000; i++) {
		float room[BANDS], sky[BANDS] = {0};
		struct spec_light_sample light = {.radiance.room = room};
		struct spec_sampler sampler;
		const float *emitted;
		struct spec_ray ray;
		struct spec_hit hit;
		double density;

		spec_sampler_start(&sampler, 2, 0, 0, i);
		if (!spec_lights_sample(f->lights, point, &sampler, &light))
			continue;
		ray = (struct spec_ray){point, light.direction};
		if (light.density == 0) {
			count[3]++;
			continue;
		}
		if (light.distance == INFINITY) {
			count[2]++;
			density = spec_lights_surroundings_density(
				f->lights, light.direction);
			near(density / light.density, 1, 1e-6, "the sky's density");
			spec_lights_add_surroundings(
				f->lights, light.direction, NULL, 1, sky);
			near(value_of(&light, 2) * density, sky[2], 1e-6,
				"the sky's light");
			continue;
		}
		assert_true(spec_world_meet(f->world, &ray, &hit));
		/* Another light may stand before it. */
		if (fabs(hit.distance - light.distance) > 1e-3 * light.distance)
			continue;
		count[hit.shape == 0 ? 0 : 1]++;
		emitted = spec_lights_emitted(
			f->lights, &hit, point, light.direction, &density);
		assert_non_null(emitted);
		/* Meshes are met in single precision. */
		near(density / light.density, 1, 1e-4, "an area's density");
		near(value_of(&light, 2) * light.density, emitted[2], 1e-5,
			"an area's light");
		/* A mesh may be met a little before. */
		near(light.distance, hit.distance, 1e-4 * hit.distance, "distance");
	}
	for (int i = 0; i < 4; i++)
		assert_true(count[i] > 100);
}

/* Of all lights together: the sum of what each sends. */
static void
test_sum(void **state)
{
	struct fixture *f = *state;
	const struct spec_vector point = {0.5, 0.4, -9};
	double wanted, mean, deviation, d = sqrt(0.5 * 0.5 + 0.4 * 0.4 + 144), r = 0;

	add_all(f);
	open_lights(f);
	r = sqrt(2.5 * 2.5 + 0.4 * 0.4 + 81);
	wanted = 4 * 12 / (d * d * d) + 0.1 * 0.8 + PI * 0.02;
	wanted += PI * 0.25 / (r * r) * (9 / r);
	wanted += polygons(&f->scene.shape[2], point, up);
	/* The disk, far: the integral of cos^2 / r^2 over its ring, by sums. */
	for (int i = 0; i < 100; i++)
		for (int j = 0; j < 100; j++) {
			double rho = 0.2 + 0.8 * (i + 0.5) / 100, a = 2 * PI * j / 100;
			double x = rho * cos(a) - 0.5, y = 3 + rho * sin(a) - 0.4;
			double square = x * x + y * y + 121;

			wanted += 121 / (square * square) * rho * 0.8 / 100 * 2 * PI / 100;
		}
	estimate(f, point, up, 16 * SAMPLES, &mean, &deviation);
	near(mean, wanted, SIGMAS * deviation, "all lights");
	assert_true(deviation < 0.01 * wanted);
}

/* Chances, from densities and values, sum up to 1. */
static void
test_chances(void **state)
{
	struct fixture *f = *state;
	double chance[6] = {0}, sum = 0;
	const struct spec_vector point = {3, 0, 0}; /* in the sphere */

	add_all(f);
	open_lights(f);
	for (uint32_t i = 0; i < 20000; i++) {
		float room[BANDS];
		struct spec_light_sample light = {.radiance.room = room};
		struct spec_sampler sampler;

		spec_sampler_start(&sampler, 2, 0, 0, i);
		if (!spec_lights_sample(f->lights, point, &sampler, &light))
			continue;
		if (light.density == 0 && light.distance == INFINITY)
			chance[0] = 0.1 / value_of(&light, 0);
		else if (light.density == 0)
			chance[1] = 4 / 18. / value_of(&light, 0);
		else if (light.distance == INFINITY)
			chance[2] = light.density * 4 * PI;
		else if (light.distance < 0.5001)
			chance[3] = light.density * 4 * PI;
		else if (light.distance * light.direction.z > 1.5)
			chance[4] = light.density / pow(light.distance, 2) *
				    light.direction.z * PI * 0.96;
		else
			chance[5] = light.density / pow(light.distance, 2) *
				    light.direction.z * 1.1;
	}
	for (int i = 0; i < 6; i++) {
		assert_true(chance[i] > 0);
		sum += chance[i];
	}
	near(sum, 1, 1e-5, "the sum of all chances");
}

/* A light is chosen half by its power, half at random: of 1 and 3, 3 in 8 and 5 in 8. */
static void
test_chances_by_power(void **state)
{
	struct fixture *f = *state;
	const struct spec_vector point = {0, 0, 1};
	int seen[2] = {0};

	add_light(f, SPEC_SCENE_POINT, 1);
	add_light(f, SPEC_SCENE_POINT, 3);
	open_lights(f);
	for (uint32_t i = 0; i < 64; i++) {
		float room[BANDS];
		struct spec_light_sample light = {.radiance.room = room};
		struct spec_sampler sampler;
		int bright;

		spec_sampler_start(&sampler, 2, 0, 0, i);
		assert_true(spec_lights_sample(f->lights, point, &sampler, &light));
		bright = light.radiance.value[0] > 2;
		near(value_of(&light, 0), bright ? 3 / .625 : 1 / .375, ROUNDED,
			"what is sent, over the chance");
		seen[bright] = 1;
	}
	assert_true(seen[0] && seen[1]);
}

/* What sends nothing is never chosen, and does not take from what others send. */
static void
test_dark_lights(void **state)
{
	struct fixture *f = *state;
	struct spec_scene_light *light;

	add_light(f, SPEC_SCENE_POINT, 0)->from[2] = 5;
	light = add_light(f, SPEC_SCENE_POINT, 4);
	light->from[2] = 2;
	add_light(f, SPEC_SCENE_AREA, 0);
	add_shape(f, SPEC_SCENE_SPHERE);
	add_light(f, SPEC_SCENE_INFINITE, 0);
	open_lights(f);
	for (uint32_t i = 0; i < 1000; i++) {
		float room[BANDS];
		struct spec_light_sample sample = {.radiance.room = room};
		struct spec_sampler sampler;

		spec_sampler_start(&sampler, 2, 0, 0, i);
		assert_true(spec_lights_sample(
			f->lights, (struct spec_vector){0, 0, -2}, &sampler, &sample));
		near(sample.distance, 4, 1e-12, "distance");
		near(value_of(&sample, 0), 4 / 16., 1e-7, "irradiance");
	}
	/* All of them dark, and none at all. */
	for (int lights = 4; lights >= 0; lights -= 4) {
		float room[BANDS];
		struct spec_light_sample sample = {.radiance.room = room};
		struct spec_sampler sampler;

		light->scale = 0;
		f->scene.lights = (size_t)lights;
		f->scene.shapes = lights ? 1 : 0;
		close_lights(f);
		open_lights(f);
		spec_sampler_start(&sampler, 2, 0, 0, 0);
		assert_false(spec_lights_sample(f->lights, up, &sampler, &sample));
		assert_true(spec_lights_surroundings_density(f->lights, up) == 0);
	}
}

static void
test_small_lights(void **state)
{
	struct fixture *f = *state;
	struct spec_vector direction;
	float value[BANDS];
	double distance;

	add_all(f);
	open_lights(f);
	assert_int_equal(spec_lights_small(f->lights), 2);
	spec_lights_reach(
		f->lights, 0, (struct spec_vector){4, 0, 0}, &direction, &distance, value);
	near(distance, 5, 1e-12, "distance");
	near(direction.x, -0.8, 1e-12, "direction");
	near(value[3], 4 / 25., 1e-7, "irradiance");
	spec_lights_reach(
		f->lights, 1, (struct spec_vector){4, 0, 0}, &direction, &distance, value);
	assert_true(distance == INFINITY);
	near(direction.x, 0.6, 1e-12, "direction");
	near(value[3], 0.1, 1e-8, "irradiance");
}

#define TEST(name) cmocka_unit_test_setup_teardown(name, set_up, tear_down)

int
main(void)
{
	const struct CMUnitTest tests[] = {
		TEST(test_sphere_outside),
		TEST(test_sphere_inside),
		TEST(test_sphere_surface),
		TEST(test_stretched_sphere_is_refused),
		TEST(test_disk),
		TEST(test_mesh),
		TEST(test_mesh_normals),
		TEST(test_constant_sky),
		TEST(test_sky_lookup),
		TEST(test_sky),
		TEST(test_flat_sky),
		TEST(test_sky_per_band),
		TEST(test_sun),
		TEST(test_densities),
		TEST(test_sum),
		TEST(test_chances),
		TEST(test_chances_by_power),
		TEST(test_dark_lights),
		TEST(test_small_lights),
	};

	return cmocka_run_group_tests_name("light", tests, NULL, NULL);
}
