/* Light transport against closed forms, and rendered files: scenes are built by hand. */
#include <float.h>
#include <stdio.h>
#include <stdlib.h>
#include <unistd.h>

#include "image/names.h"
#include "image/reader.h"
#include "optics/disc.h"
#include "render/render.h"
#include "scene/scene.h"
#include "scene/transform.h"

#include "check.h"
#include "shapes.h"

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

/* A floor is lit by the lamp above it alike, however large it is. */
static void
test_floor_sizes(void **state)
{
	(void)state;
	for (double radius = 1; radius < 2e4; radius *= 10) {
		struct fixture *f = new_floor();

		add_light(f, SPEC_SCENE_AREA, 7);
		f->scene.shape[0].radius = radius;
		add_shape(f, SPEC_SCENE_SPHERE, 1, 0, 2, 0.5)->light = 0;
		expect_irradiance(
			f, PI * 7 * 0.25 / 5 * (2 / sqrt(5)), 16384, "a lamp over a floor");
	}
}

/* What hangs 5 mm below a lamp shades it, however large the scene is; and below a point. */
static void
test_lampshade(void **state)
{
	(void)state;
	for (int i = 0; i < 4; i++) {
		struct fixture *f = new_floor();
		struct spec_ray ray = ray_to(
			(struct spec_vector){3, 0, 0.5}, (struct spec_vector){0, 0, 0});
		double mean, deviation;

		f->scene.shape[0].radius = i & 1 ? 1e4 : 10;
		add_shape(f, SPEC_SCENE_DISK, 0, 0, 1.985, 0.1);
		if (i & 2) {
			add_light(f, SPEC_SCENE_POINT, 1)->from[2] = 1.99;
		} else {
			add_light(f, SPEC_SCENE_AREA, 1);
			add_shape(f, SPEC_SCENE_SPHERE, 0, 0, 2, 0.01)->light = 0;
		}
		open_render(f);
		estimate(f, &ray, 1, 256, &mean, &deviation);
		if (mean != 0)
			fail_msg("%s in a scene of %g m: %g instead of 0",
				i & 2 ? "a point" : "a lamp", f->scene.shape[0].radius,
				mean);
		free_fixture(f);
	}
}

/*
 * On a sphere's own wall: 2.5 cm and 1 km off, where rounding puts points to both sides of it.
 */
static void
test_shining_room(void **state)
{
	struct fixture *f = new_fixture();
	struct spec_scene_shape *wall;
	double sum = 0, variance = 0;

	(void)state;
	f->scene.max_depth = 100;
	add_material(f, SPEC_SCENE_DIFFUSE)->reflectance = constant(0.5);
	add_light(f, SPEC_SCENE_AREA, 1);
	wall = add_shape(f, SPEC_SCENE_SPHERE, 600, 0, -800, 0.025);
	wall->light = 0;
	wall->reverse_orientation = 1;
	open_render(f);
	for (uint32_t i = 0; i < 65536; i++) {
		struct spec_ray ray = {
			{600 + 1e-3 * (i % 7), 0, -800}, {sin(i) * 0.6, cos(i) * 0.6, 0.8}};
		struct spec_sampler sampler;
		float radiance[16] = {0};

		spec_sampler_start(&sampler, 1, (int)i, 0, 0);
		spec_path_trace(&f->render.tracer, &ray, 0, 0, &sampler, f->room, radiance);
		sum += radiance[1] / 65536;
		variance += (radiance[1] - 2.) * (radiance[1] - 2.) / 65536;
	}
	if (!(fabs(sum - 2) <= SIGMAS * sqrt(variance / 65536)))
		fail_msg("%.8g instead of 2 +- %.2g", sum, SIGMAS * sqrt(variance / 65536));
	free_fixture(f);
}

/* --- files --- */

struct picture {
	char path[64];
	struct spec_reader *reader;
	struct spec_decoder *decoder;
	const struct spec_image *image;
};

/* Renders to a file and decodes all of that. */
static void
render_picture(struct fixture *f, const struct spec_render_setup *wanted, int threads,
	struct picture *picture)
{
	struct spec_render_setup setup = *wanted;
	volatile double tiny = DBL_MIN;
	unsigned long long overflows;
	struct spec_error error;
	int file;

	setup.grid = &f->grid;
	setup.supersample = setup.supersample ? setup.supersample : 1;
	strcpy(picture->path, "/tmp/render.XXXXXX.exr");
	file = mkstemps(picture->path, 4);
	assert_true(file >= 0);
	close(file);
	f->settings.output = picture->path;
	f->settings.threads = threads;
	spec_render_close(&f->render);
	check(spec_render_open(&f->render, &f->scene, &setup, &f->settings, &error),
		&error);
	check(spec_render_run(&f->render, &f->settings, &overflows, &error), &error);
	assert_true(tiny / 2 > 0); /* this thread has tiny numbers still */
	check(spec_reader_open(&picture->reader, picture->path, &f->settings, &error),
		&error);
	picture->image = spec_reader_image(picture->reader);
	check(spec_decoder_open(&picture->decoder, picture->reader, NULL, &error), &error);
	check(spec_decoder_fetch(picture->decoder, picture->image->data.y0,
		      picture->image->data.y1, &error),
		&error);
	check(spec_decoder_decode(picture->decoder, &error), &error);
}

static void
close_picture(struct picture *picture)
{
	spec_decoder_close(picture->decoder);
	spec_reader_close(picture->reader);
	unlink(picture->path);
}

/* At a place of the whole picture, not of the data window. */
static float
sample_at(const struct picture *picture, const char *name, int x, int y)
{
	const struct spec_image *image = picture->image;
	size_t channel = spec_image_find_channel(image, name);

	if (channel == image->channels)
		fail_msg("there is no channel '%s'", name);
	return spec_decoder_row(picture->decoder, y, channel)[x - image->data.x0];
}

/* The band of that number, of the layer with that prefix. */
static double
band_at(const struct picture *picture, const char *prefix, size_t band, int x, int y)
{
	char name[128];
	size_t length = (size_t)snprintf(name, sizeof name, "%s", prefix);

	spec_names_write(name + length, sizeof name - length, SPEC_ROLE_EMISSIVE, 0,
		picture->image->wavelength_nm[band], 0);
	return sample_at(picture, name, x, y);
}

static void
expect_same_pixels(const struct picture *part, const struct picture *whole)
{
	const struct spec_window *data = &part->image->data;

	assert_int_equal(part->image->channels, whole->image->channels);
	for (size_t i = 0; i < part->image->channels; i++)
		for (int y = data->y0; y < data->y1; y++)
			assert_memory_equal(spec_decoder_row(part->decoder, y, i),
				spec_decoder_row(whole->decoder, y, i) + data->x0 -
					whole->image->data.x0,
				spec_window_width(data) * sizeof(float));
}

/* A camera at z = height that looks down, its right along -x, with a view of fov degrees. */
static void
look_down(struct fixture *f, double height, double fov_deg, int size)
{
	struct spec_transform t = spec_transform_identity();
	struct spec_error error;
	const double eye[] = {0, 0, height}, to[] = {0, 0, 0}, up[] = {0, 1, 0};

	check(spec_transform_look_at(&t, eye, to, up, &error), &error);
	f->scene.camera = spec_transform_inverse(&t);
	f->scene.fov_deg = fov_deg;
	f->scene.width = f->scene.height = size;
}

/* Something of everything: a floor, a bubble, a metal ball, a disc, two lamps, a sky. */
static struct fixture *
new_room(void)
{
	struct fixture *f = new_floor();
	struct spec_scene_material *material;

	f->scene.max_depth = 5;
	f->scene.shape->height = -1;
	material = add_material(f, SPEC_SCENE_THINFILM);
	material->stack = strdup("air | 1.33 * | air");
	material->thickness = strdup("gravity 200nm..700nm");
	add_shape(f, SPEC_SCENE_SPHERE, 0.7, 0, 0, 0.6);
	material = add_material(f, SPEC_SCENE_CONDUCTOR);
	material->k = constant(3);
	material->roughness[0] = material->roughness[1] = 0.2;
	add_shape(f, SPEC_SCENE_SPHERE, -0.7, 0.3, 0, 0.4);
	add_material(f, SPEC_SCENE_DIFFRACTIVE)->preset = strdup("cd");
	add_shape(f, SPEC_SCENE_DISK, -0.5, -0.7, -0.5, 0.5);
	add_light(f, SPEC_SCENE_AREA, 4);
	add_shape(f, SPEC_SCENE_SPHERE, 3, 0, 3, 0.5)->light = 0;
	add_light(f, SPEC_SCENE_POINT, 3)->from[2] = 4;
	add_light(f, SPEC_SCENE_INFINITE, 0.3);
	look_down(f, 4, 50, 12);
	return f;
}

static const struct spec_render_setup everything = {
	.width = 12, .height = 10, .samples = 4, .films = 2, .discs = 1, .geometry = 1};

static void
test_crop(void **state)
{
	struct spec_render_setup setup = everything;

	(void)state;
	for (int deferred = 0; deferred < 2; deferred++) {
		struct fixture *f = new_room();
		struct picture whole, part;

		setup.films = 2 * deferred;
		setup.discs = deferred;
		setup.supersample = 1 + deferred;
		setup.has_crop = 0;
		render_picture(f, &setup, 1, &whole);
		setup.has_crop = 1;
		setup.crop = (struct spec_window){2, 3, 11, 7};
		render_picture(f, &setup, 1, &part);
		assert_int_equal(part.image->data.x0, 2 * setup.supersample);
		assert_int_equal(part.image->data.y1, 7 * setup.supersample);
		assert_memory_equal(&part.image->display, &whole.image->display,
			sizeof whole.image->display);
		expect_same_pixels(&part, &whole);
		close_picture(&part);
		close_picture(&whole);
		free_fixture(f);
	}
}

static void
test_threads(void **state)
{
	struct fixture *f = new_room();
	struct picture one, four;

	(void)state;
	render_picture(f, &everything, 1, &one);
	render_picture(f, &everything, 4, &four);
	expect_same_pixels(&one, &four);
	close_picture(&one);
	close_picture(&four);
	free_fixture(f);
}

/* Half floats hold the same pixels, rounded. */
static void
test_half(void **state)
{
	struct fixture *f = new_room();
	struct spec_render_setup setup = everything;
	struct picture whole, half;

	(void)state;
	render_picture(f, &setup, 1, &whole);
	setup.half = 1;
	render_picture(f, &setup, 1, &half);
	for (int y = 0; y < 10; y++)
		for (int x = 0; x < 12; x++) {
			double wanted = band_at(&whole, "", 2, x, y);

			assert_true(fabs(band_at(&half, "", 2, x, y) - wanted) <=
				    0x1p-11 * wanted);
		}
	close_picture(&whole);
	close_picture(&half);
	free_fixture(f);
}

/* --- deferred films: folded by hand, as specexr(5) says, they are those of the whole --- */

/* The films of the scene's material that each layer shows, front first. */
struct fold {
	size_t films;
	size_t material[4];
};

static double
folded(const struct fixture *f, const struct picture *layers, const struct fold *fold,
	size_t band, int x, int y)
{
	double light = band_at(layers, "through.", band, x, y);
	double first = sample_at(layers, "film1.cover", x, y);

	for (size_t i = fold->films; i-- > 0;) {
		const struct spec_coating *coating =
			&f->render.material[fold->material[i]].coating;
		char prefix[32], name[64];
		double cosine, size, thickness_nm, cover, r = 0, t = 0;
		float height;

		snprintf(prefix, sizeof prefix, "film%zu.", i + 1);
		snprintf(name, sizeof name, "%scover", prefix);
		cover = sample_at(layers, name, x, y);
		if (cover == 0)
			continue;
		snprintf(name, sizeof name, "%scosine", prefix);
		cosine = sample_at(layers, name, x, y);
		size = fabs(cosine);
		snprintf(name, sizeof name, "%sQ.Z", prefix);
		height = sample_at(layers, name, x, y);
		spec_thickness_row(&coating->thickness, &height, 1, &thickness_nm);
		spec_coating_row(coating, band, cosine < 0, &size, &thickness_nm, 1,
			SPEC_POLARISATION_NONE, &r, &t);
		snprintf(name, sizeof name, "%smirror.", prefix);
		light = (1 + cover / first * (t - 1)) * light +
			r * band_at(layers, name, band, x, y);
	}
	return light + band_at(layers, "", band, x, y);
}

/*
 * The mean over all pixels of what both renderings differ by, in each band. Seeds differ, so
 * that the difference is as noisy as it looks. slack: of the mean, for what the tool sees of
 * a pixel: one angle and one thickness.
 */
static void
expect_deferral(
	struct fixture *f, const struct fold *fold, int size, int samples, double slack)
{
	struct spec_render_setup setup = {
		.width = size, .height = size, .samples = samples};
	struct picture plain, layers;
	double pixels = (double)size * size;

	render_picture(f, &setup, 2, &plain);
	setup.films = (int)fold->films;
	setup.seed = 1;
	render_picture(f, &setup, 2, &layers);
	for (size_t band = 0; band < f->grid.count; band++) {
		double mean = 0, squares = 0, wanted = 0, bound;

		for (int y = 0; y < size; y++)
			for (int x = 0; x < size; x++) {
				double value = band_at(&plain, "", band, x, y);
				double d = folded(f, &layers, fold, band, x, y) - value;

				wanted += value / pixels;
				mean += d / pixels;
				squares += d * d / pixels;
			}
		bound = SIGMAS * sqrt((squares - mean * mean) / pixels) + slack * wanted;
		if (!(fabs(mean) <= bound))
			fail_msg("band %zu: folded %g more than %g +- %.2g", band, mean,
				wanted, bound);
		assert_true(bound <= 0.04 * wanted);
	}
	close_picture(&plain);
	close_picture(&layers);
}

/* A soap film over a mirror, seen obliquely, below a sky and beside a lamp. */
static struct fixture *
new_film(double radius)
{
	struct fixture *f = new_fixture();
	struct spec_scene_material *material;

	f->scene.max_depth = 60;
	material = add_material(f, SPEC_SCENE_THINFILM);
	material->stack = strdup("air | 1.33 * | air");
	material->thickness = strdup("350nm");
	add_shape(f, SPEC_SCENE_DISK, 0, 0, 0, radius);
	material = add_material(f, SPEC_SCENE_CONDUCTOR);
	material->eta = constant(0.2);
	material->k = constant(2);
	add_shape(f, SPEC_SCENE_DISK, 0, 0, -1, 10);
	add_light(f, SPEC_SCENE_INFINITE, 1);
	add_light(f, SPEC_SCENE_AREA, 5);
	f->scene.shape[f->scene.shapes - 1].light = SPEC_SCENE_NONE;
	add_shape(f, SPEC_SCENE_SPHERE, 0.5, 0, 4, 1)->light = 1;
	look_down(f, 8, 4, 16);
	f->scene.camera.m[0][3] += 3; /* not quite from above */
	return f;
}

static void
test_defer_film(void **state)
{
	struct fixture *f = new_film(10);

	(void)state;
	expect_deferral(f, &(struct fold){1, {0}}, 16, 64, 1e-4);
	expect_deferral(f, &(struct fold){2, {0}}, 16, 64, 1e-4); /* there is no second */
	free_fixture(f);
}

/* The film covers a part of the picture, and its edge runs through pixels. */
static void
test_defer_edge(void **state)
{
	struct fixture *f = new_film(0.2);

	(void)state;
	f->scene.shape->world = placed(3.05, 0, 0);
	expect_deferral(f, &(struct fold){2, {0}}, 16, 64, 1e-4);
	free_fixture(f);
}

/* A bubble over a floor: its two walls are films 1 and 2, the second seen from within. */
static void
test_defer_bubble(void **state)
{
	struct fixture *f = new_fixture();
	struct spec_scene_material *material;

	(void)state;
	f->scene.max_depth = 100;
	material = add_material(f, SPEC_SCENE_THINFILM);
	material->stack = strdup("air | 1.33 * | air");
	material->thickness = strdup("gravity 300nm..500nm");
	add_shape(f, SPEC_SCENE_SPHERE, 0.3, 0, 0, 1);
	add_material(f, SPEC_SCENE_DIFFUSE);
	add_shape(f, SPEC_SCENE_DISK, 0, 0, -2, 10);
	add_light(f, SPEC_SCENE_INFINITE, 0.5);
	add_light(f, SPEC_SCENE_AREA, 2);
	add_shape(f, SPEC_SCENE_SPHERE, 1, 1, 4, 1)->light = 1;
	look_down(f, 8, 5, 16);
	expect_deferral(f, &(struct fold){2, {0, 0}}, 16, 256, 1e-3);
	free_fixture(f);
}

/* More films than the path may be long: the same number of them is crossed. */
static void
test_defer_deep(void **state)
{
	struct fixture *f = new_film(10);

	(void)state;
	for (int i = 1; i < 4; i++) {
		struct spec_scene_shape *shape = &f->scene.shape[f->scene.shapes++];

		*shape = f->scene.shape[0];
		shape->height = -0.2 * i;
	}
	for (int depth = 0; depth < 6; depth++) {
		f->scene.max_depth = depth;
		/* Light that only paths longer than that would find counts for neither. */
		expect_deferral(f, &(struct fold){4, {0}}, 16, 64, 1e-4);
	}
	free_fixture(f);
}

/* On metal nothing comes through, and no second film is seen inside. */
static void
test_defer_film_on_metal(void **state)
{
	struct fixture *f = new_fixture();
	struct spec_scene_material *material;
	struct spec_render_setup setup = {
		.width = 4, .height = 4, .samples = 4, .films = 2};
	struct picture layers;

	(void)state;
	material = add_material(f, SPEC_SCENE_THINFILM);
	material->stack = strdup("air | 1.5 300nm | 0.3+3i");
	add_shape(f, SPEC_SCENE_SPHERE, 0, 0, 0, 1);
	add_light(f, SPEC_SCENE_INFINITE, 1);
	look_down(f, 8, 2, 4);
	expect_deferral(f, &(struct fold){2, {0, 0}}, 8, 16, 1e-3);
	render_picture(f, &setup, 1, &layers);
	assert_true(sample_at(&layers, "film1.cover", 1, 1) == 1);
	assert_true(sample_at(&layers, "film2.cover", 1, 1) == 0);
	close_picture(&layers);
	/* From within the metal all is dark, and specfilm(1) would not take such a film. */
	f->scene.shape->reverse_orientation = 1;
	render_picture(f, &setup, 1, &layers);
	assert_true(sample_at(&layers, "film1.cover", 1, 1) == 0);
	assert_true(band_at(&layers, "", 0, 1, 1) == 0);
	close_picture(&layers);
	free_fixture(f);
}

/* --- deferred discs --- */

/* A compact disc below a point and a distant light. */
static struct fixture *
new_disc(void)
{
	struct fixture *f = new_fixture();
	struct spec_scene_light *light;

	add_material(f, SPEC_SCENE_DIFFRACTIVE)->preset = strdup("cd");
	add_shape(f, SPEC_SCENE_DISK, 0, 0, 0, 0.06);
	light = add_light(f, SPEC_SCENE_POINT, 4);
	light->from[0] = 0.3;
	light->from[2] = 0.4;
	light = add_light(f, SPEC_SCENE_DISTANT, 2);
	light->from[1] = 0.6;
	light->from[2] = 0.8;
	look_down(f, 0.5, 15, 16);
	return f;
}

static const struct spec_render_setup disc_setup = {
	.width = 16, .height = 16, .samples = 16, .discs = 1};

static struct spec_vector
vector_at(const struct picture *picture, const char *prefix, int x, int y)
{
	char name[64];
	double v[3];

	for (int i = 0; i < 3; i++) {
		snprintf(name, sizeof name, "%s.%c", prefix, "XYZ"[i]);
		v[i] = sample_at(picture, name, x, y);
	}
	return (struct spec_vector){v[0], v[1], v[2]};
}

/* Irradiance across each lamp's direction: I / d^2, and E, as far as the disc covers. */
static void
test_lamps(void **state)
{
	struct fixture *f = new_disc();
	struct picture layers;
	unsigned partial = 0;

	(void)state;
	render_picture(f, &disc_setup, 2, &layers);
	for (int y = 0; y < 16; y++)
		for (int x = 0; x < 16; x++) {
			double cover = sample_at(&layers, "cover", x, y), e;
			struct spec_vector p, d;

			if (cover == 0)
				continue;
			p = vector_at(&layers, "P", x, y);
			d = spec_vector_subtract((struct spec_vector){0.3, 0, 0.4}, p);
			e = cover * 4 / spec_vector_dot(d, d);
			/* Across a pixel of 5 mm it varies: by the square of that / 0.5 m. */
			assert_true(
				fabs(band_at(&layers, "lamp1.", 1, x, y) - e) < 1e-3 * e);
			d = spec_vector_subtract(
				spec_vector_unit(d), vector_at(&layers, "lamp1.D", x, y));
			assert_true(spec_vector_length(d) < 1e-3);
			assert_true(fabs(band_at(&layers, "lamp2.", 1, x, y) - 2 * cover) <
				    1e-6);
			d = spec_vector_subtract((struct spec_vector){0, 0.6, 0.8},
				vector_at(&layers, "lamp2.D", x, y));
			assert_true(spec_vector_length(d) < 1e-6);
			assert_true(band_at(&layers, "", 1, x, y) == 0);
			assert_true(fabs(vector_at(&layers, "Ns", x, y).z - 1) < 1e-6);
			partial += cover < 1;
		}
	assert_true(partial > 0);
	close_picture(&layers);
	free_fixture(f);
}

/* A plate stands before each light: one half of the disc lies in its shadow. */
static void
test_lamp_shadows(void **state)
{
	struct fixture *f = new_disc();
	struct picture layers;
	unsigned dark[2] = {0}, lit[2] = {0};

	(void)state;
	add_material(f, SPEC_SCENE_DIFFUSE);
	/* Half-way to the point: its edge at x = 0.15 throws its shadow on x = 0. */
	add_shape(f, SPEC_SCENE_DISK, 0.15 + 0.3, 0, 0.2, 0.3);
	render_picture(f, &disc_setup, 2, &layers);
	for (int y = 0; y < 16; y++)
		for (int x = 0; x < 16; x++) {
			struct spec_vector p = vector_at(&layers, "P", x, y);
			double r = hypot(p.x, p.y);

			/* Pixels of 5 mm, and the plate's edge is bent. */
			if (sample_at(&layers, "cover", x, y) < 1 ||
				fabs(p.x - p.y * p.y) < 0.008 || r > 0.05)
				continue;
			for (int i = 0; i < 2; i++) {
				double e =
					band_at(&layers, i ? "lamp2." : "lamp1.", 0, x, y);

				/* The distant light comes from the side. */
				assert_true((e == 0) == (i == 0 && p.x > p.y * p.y));
				dark[i] += e == 0;
				lit[i] += e > 0;
			}
		}
	assert_true(dark[0] > 20 && lit[0] > 20 && dark[1] == 0 && lit[1] > 40);
	close_picture(&layers);
	free_fixture(f);
}

/* S0 and the lamps through the disc's model, by hand, are what is rendered without. */
static void
test_defer_disc(void **state)
{
	struct fixture *f = new_disc();
	struct spec_render_setup setup = disc_setup;
	const struct spec_disc *disc = spec_disc_find("cd", NULL);
	struct picture layers, plain;
	double mean[4] = {0}, squares[4] = {0}, wanted[4] = {0};
	unsigned pixels = 0;

	(void)state;
	/* Pixels of 0.3 mm: what they show of the disc does not vary in them. */
	look_down(f, 0.5, 0.5, 16);
	f->scene.camera.m[0][3] = 0.03;
	/* With a lamp that is none, but a part of S0. */
	add_light(f, SPEC_SCENE_AREA, 3);
	add_shape(f, SPEC_SCENE_SPHERE, -0.3, 0.1, 0.4, 0.05)->light = 2;
	setup.samples = 256;
	render_picture(f, &setup, 2, &layers);
	setup.discs = 0;
	setup.seed = 1;
	render_picture(f, &setup, 2, &plain);
	for (int y = 0; y < 16; y++)
		for (int x = 0; x < 16; x++) {
			struct spec_vector eye, along, across, normal;
			double sum[4] = {0};

			if (sample_at(&layers, "cover", x, y) < 1)
				continue;
			eye = vector_at(&layers, "I", x, y);
			normal = vector_at(&layers, "Ns", x, y);
			along = vector_at(&layers, "Tan", x, y);
			across = spec_vector_cross(normal, along);
			for (int i = 1; i < 3; i++) {
				char name[32];
				struct spec_disc_bands bands = {f->grid.count,
					plain.image->wavelength_nm, plain.image->edges_nm};
				struct spec_vector lamp, both;
				double u, v, half, reflection[4];
				struct spec_disc_pixels pixel = {.count = 1,
					.along = &u,
					.across = &v,
					.half_cosine = &half};

				snprintf(name, sizeof name, "lamp%d.D", i);
				lamp = vector_at(&layers, name, x, y);
				both = spec_vector_add(eye, lamp);
				u = spec_vector_dot(both, along);
				v = spec_vector_dot(both, across);
				half = spec_vector_dot(spec_vector_unit(both), normal);
				spec_disc_composite(disc, &bands, &pixel, reflection, 1);
				snprintf(name, sizeof name, "lamp%d.", i);
				for (size_t band = 0; band < 4; band++)
					sum[band] += reflection[band] *
						     spec_vector_dot(lamp, normal) *
						     band_at(&layers, name, band, x, y);
			}
			for (size_t band = 0; band < 4; band++) {
				double value = band_at(&plain, "", band, x, y);
				double d = sum[band] + band_at(&layers, "", band, x, y) -
					   value;

				mean[band] += d;
				squares[band] += d * d;
				wanted[band] += value;
			}
			pixels++;
		}
	assert_int_equal(pixels, 256);
	for (size_t band = 0; band < 4; band++) {
		double bound = SIGMAS * sqrt(squares[band]) + 1e-3 * wanted[band];

		if (!(fabs(mean[band]) <= bound))
			fail_msg("band %zu: %g more than %g +- %.2g", band, mean[band],
				wanted[band], bound);
		assert_true(bound < 0.15 * wanted[band]);
	}
	close_picture(&layers);
	close_picture(&plain);
	free_fixture(f);
}

/* --- geometry --- */

static void
test_geometry(void **state)
{
	struct fixture *f = new_floor();
	struct spec_render_setup setup = {
		.width = 9, .height = 9, .samples = 16, .geometry = 1};
	struct picture picture;
	uint32_t id;
	float bits;

	(void)state;
	f->scene.shape->radius = 0.5;
	add_light(f, SPEC_SCENE_INFINITE, 1);
	look_down(f, 2, 2 * atan(0.45) * 180 / PI, 9);
	render_picture(f, &setup, 1, &picture);
	for (int y = 0; y < 9; y++)
		for (int x = 0; x < 9; x++) {
			struct spec_vector p = vector_at(&picture, "P", x, y);
			double px = (4 - x) * 0.2, py = (4 - y) * 0.2, r = hypot(px, py);
			double cover = sample_at(&picture, "cover", x, y);

			if (r > 0.36)
				continue;
			assert_true(cover == 1);
			/* One sample in each sixteenth, 0.2 / 16 wide. */
			assert_true(fabs(p.x - px) < 0.2 / 32);
			assert_true(fabs(p.y - py) < 0.2 / 32);
			assert_true(fabs(p.z) < 1e-7);
			assert_true(fabs(sample_at(&picture, "cosine", x, y) -
					    2 / sqrt(4 + r * r)) < 0.01);
			bits = sample_at(&picture, "id", x, y);
			memcpy(&id, &bits, sizeof id);
			assert_int_equal(id, f->scene.material->id);
		}
	assert_true(sample_at(&picture, "cover", 0, 0) == 0);
	close_picture(&picture);
	free_fixture(f);
}

/* What is no surface at all casts no shadow and takes no scattering. */
static void
test_interface(void **state)
{
	struct fixture *f = new_floor();
	struct spec_scene_light *light = add_light(f, SPEC_SCENE_POINT, 5);

	(void)state;
	light->from[0] = 1;
	light->from[2] = 2;
	add_material(f, SPEC_SCENE_INTERFACE);
	add_shape(f, SPEC_SCENE_SPHERE, 1, 0, 2, 0.5);
	add_shape(f, SPEC_SCENE_SPHERE, 3, 0, 0.5, 0.1); /* about the eye */
	expect_irradiance(f, 5.0 * 2 / pow(5, 1.5), 16, "a point in a ball of nothing");
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
		cmocka_unit_test(test_floor_sizes),
		cmocka_unit_test(test_lampshade),
		cmocka_unit_test(test_shining_room),
		cmocka_unit_test(test_crop),
		cmocka_unit_test(test_threads),
		cmocka_unit_test(test_half),
		cmocka_unit_test(test_defer_film),
		cmocka_unit_test(test_defer_edge),
		cmocka_unit_test(test_defer_bubble),
		cmocka_unit_test(test_defer_deep),
		cmocka_unit_test(test_defer_film_on_metal),
		cmocka_unit_test(test_lamps),
		cmocka_unit_test(test_lamp_shadows),
		cmocka_unit_test(test_defer_disc),
		cmocka_unit_test(test_geometry),
		cmocka_unit_test(test_interface),
	};

	return cmocka_run_group_tests_name("render", tests, NULL, NULL);
}
