#include "render/render.h"

#include <pmmintrin.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <xmmintrin.h>

#include "base/memory.h"
#include "base/vector.h"
#include "image/names.h"
#include "image/samples.h"
#include "image/save.h"
#include "image/variances.h"
#include "place/placed.h"
#include "render/sums.h"
#include "render/variance.h"

#define USUAL_SAMPLES 16
#define USUAL_DEPTH 5

enum { SURFACE_IDS = SPEC_RENDER_MOST_FILMS, OTHER_IDS, ALL_IDS };

/* --- where what stands in a pixel's sums: S0, through, films, the surface, lamps --- */

static size_t
through_slot(const struct spec_render *render)
{
	return render->bands.count;
}

static size_t
film_slot(const struct spec_render *render, size_t film)
{
	size_t bands = render->bands.count;

	return 2 * bands + film * (bands + SPEC_SUMS_GEOMETRY);
}

static size_t
surface_slot(const struct spec_render *render)
{
	return film_slot(render, (size_t)render->setup.films);
}

static size_t
lamp_slot(const struct spec_render *render, size_t lamp)
{
	return surface_slot(render) + SPEC_SUMS_GEOMETRY + lamp * (render->bands.count + 3);
}

/*
 * Where a deferred disc is in the pixel, its geometry is the pixel's; else that of the other
 * surfaces, which is summed up behind all that is written.
 */
static size_t
other_slot(const struct spec_render *render)
{
	return lamp_slot(render, render->lamps);
}

static size_t
variance_slot(const struct spec_render *render)
{
	return other_slot(render) + SPEC_SUMS_GEOMETRY;
}

static int
has_surface(const struct spec_render *render)
{
	return render->setup.discs || render->setup.geometry;
}

/* --- the header --- */

/* Adds a layer's bands, "mirror." and the like before the layout's names. */
static enum spec_status
add_bands(struct spec_render *render, const char *prefix, enum spec_sample sample,
	struct spec_error *error)
{
	enum spec_status status = SPEC_OK;
	char band[64], name[128];

	for (size_t i = 0; i < render->bands.count && status == SPEC_OK; i++) {
		spec_names_write(band, sizeof band, SPEC_ROLE_EMISSIVE, 0,
			render->bands.wavelength_nm[i], 0);
		snprintf(name, sizeof name, "%s%s", prefix, band);
		status = spec_image_add_channel(&render->image, name, sample, error);
	}
	return status;
}

static enum spec_sample
sample_of(const struct spec_render *render)
{
	return render->setup.half ? SPEC_SAMPLE_HALF : SPEC_SAMPLE_FLOAT;
}

static enum spec_status
add_films(struct spec_render *render, struct spec_error *error)
{
	enum spec_sample sample = sample_of(render);
	enum spec_status status = SPEC_OK;
	char prefix[48];

	if (render->setup.films > 0)
		status = add_bands(render, "through.", sample, error);
	for (int i = 1; i <= render->setup.films && status == SPEC_OK; i++) {
		snprintf(prefix, sizeof prefix, "film%d.", i);
		status = spec_sums_add_channels(&render->image, prefix, error);
		snprintf(prefix, sizeof prefix, "film%d.mirror.", i);
		if (status == SPEC_OK)
			status = add_bands(render, prefix, sample, error);
	}
	return status;
}

static enum spec_status
add_lamps(struct spec_render *render, struct spec_error *error)
{
	enum spec_status status = SPEC_OK;
	char name[48];

	for (size_t i = 1; i <= render->lamps && status == SPEC_OK; i++) {
		for (const char *axis = "XYZ"; *axis && status == SPEC_OK; axis++) {
			snprintf(name, sizeof name, "lamp%zu.D.%c", i, *axis);
			status = spec_image_add_channel(
				&render->image, name, SPEC_SAMPLE_FLOAT, error);
		}
		snprintf(name, sizeof name, "lamp%zu.", i);
		if (status == SPEC_OK)
			status = add_bands(render, name, sample_of(render), error);
	}
	return status;
}

/* The slot of a channel, by its name; bands by their order. */
static size_t
slot_of(const struct spec_render *render, const char *name)
{
	char prefix[48];
	const char *rest;
	size_t bands = render->bands.count;

	for (size_t i = 0; i < (size_t)render->setup.films; i++) {
		int length = snprintf(prefix, sizeof prefix, "film%zu.", i + 1);

		if (strncmp(name, prefix, (size_t)length) != 0)
			continue;
		rest = name + length;
		if (spec_sums_slot(rest) < SPEC_SUMS_GEOMETRY)
			return film_slot(render, i) + bands + spec_sums_slot(rest);
	}
	for (size_t i = 0; i < render->lamps; i++) {
		int length = snprintf(prefix, sizeof prefix, "lamp%zu.D.", i + 1);

		if (strncmp(name, prefix, (size_t)length) == 0)
			return lamp_slot(render, i) + bands + (size_t)(name[length] - 'X');
	}
	return surface_slot(render) + spec_sums_slot(name);
}

/* Bands have one name behind several prefixes. */
static enum spec_status
set_band_slots(struct spec_render *render, const char *prefix, size_t first,
	struct spec_error *error)
{
	char band[64], name[128];

	for (size_t i = 0; i < render->bands.count; i++) {
		size_t channel;

		spec_names_write(band, sizeof band, SPEC_ROLE_EMISSIVE, 0,
			render->bands.wavelength_nm[i], 0);
		snprintf(name, sizeof name, "%s%s", prefix, band);
		channel = spec_image_find_channel(&render->image, name);
		if (channel == render->image.channels)
			return spec_error_set(error, SPEC_EUSAGE,
				"the bands are too close together for their names");
		render->slot[channel] = first + i;
	}
	return SPEC_OK;
}

static enum spec_status
set_slots(struct spec_render *render, struct spec_error *error)
{
	const struct spec_image *image = &render->image;
	enum spec_status status;
	char prefix[48];

	render->slot =
		spec_memory_new(image->channels, sizeof *render->slot, "channels", error);
	if (!render->slot)
		return SPEC_ENOMEM;
	for (size_t i = 0; i < image->channels; i++)
		render->slot[i] = slot_of(render, image->channel[i].name);
	status = set_band_slots(render, "", 0, error);
	if (status == SPEC_OK && render->setup.films > 0)
		status = set_band_slots(render, "through.", through_slot(render), error);
	for (size_t i = 0; i < (size_t)render->setup.films && status == SPEC_OK; i++) {
		snprintf(prefix, sizeof prefix, "film%zu.mirror.", i + 1);
		status = set_band_slots(render, prefix, film_slot(render, i), error);
	}
	for (size_t i = 0; i < render->lamps && status == SPEC_OK; i++) {
		snprintf(prefix, sizeof prefix, "lamp%zu.", i + 1);
		status = set_band_slots(render, prefix, lamp_slot(render, i), error);
	}
	if (status == SPEC_OK && render->setup.variance)
		status = set_band_slots(
			render, SPEC_VARIANCES_PREFIX, variance_slot(render), error);
	render->slots = variance_slot(render) +
			(render->setup.variance ? 2 * render->bands.count : 0);
	return status;
}

static enum spec_status
set_windows(struct spec_render *render, struct spec_error *error)
{
	const struct spec_render_setup *setup = &render->setup;
	struct spec_window whole = {0, 0, setup->width, setup->height};
	struct spec_window data = setup->has_crop ? setup->crop : whole;
	int n = setup->supersample;

	if (data.x0 < 0 || data.y0 < 0 || data.x1 > whole.x1 || data.y1 > whole.y1 ||
		data.x0 >= data.x1 || data.y0 >= data.y1)
		return spec_error_set(error, SPEC_ERANGE,
			"the crop %d,%d,%d,%d is empty or not inside 0,0,%d,%d", data.x0,
			data.y0, data.x1, data.y1, whole.x1, whole.y1);
	render->image.data =
		(struct spec_window){data.x0 * n, data.y0 * n, data.x1 * n, data.y1 * n};
	render->image.display = (struct spec_window){0, 0, whole.x1 * n, whole.y1 * n};
	return SPEC_OK;
}

/* Where the camera says it stands, or else the daylight, and when. */
static enum spec_status
set_place(struct spec_render *render, struct spec_error *error)
{
	const struct spec_scene *scene = render->scene;
	const struct spec_place *place = scene->has_place ? &scene->place : NULL;
	const struct spec_instant *instant = NULL;

	for (size_t i = 0; i < scene->lights; i++) {
		if (!scene->light[i].daylight)
			continue;
		instant = &scene->light[i].daylight->sunlight.instant;
		if (!place)
			place = &scene->light[i].daylight->sunlight.place;
	}
	return spec_placed_set(&render->image, place, instant, error);
}

static enum spec_status
make_header(struct spec_render *render, struct spec_error *error)
{
	struct spec_image *image = &render->image;
	enum spec_status status;

	*image = (struct spec_image){.pixel_aspect_ratio = 1, .screen_window_width = 1};
	status = set_windows(render, error);
	if (status == SPEC_OK)
		status = spec_image_set_text(image, "spectralLayoutVersion", "1.0", error);
	if (status == SPEC_OK)
		status = spec_image_set_text(image, "emissiveUnits", "W.m^-2.sr^-1", error);
	if (status == SPEC_OK)
		status = spec_image_set_text(
			image, "spec:quantity", "radiance per nm", error);
	if (status == SPEC_OK)
		status = spec_samples_set(
			image, render->setup.samples, "the rendered image", error);
	if (status == SPEC_OK)
		status = set_place(render, error);
	if (status == SPEC_OK)
		status = add_bands(render, "", sample_of(render), error);
	if (status == SPEC_OK && render->setup.variance)
		status = add_bands(render, SPEC_VARIANCES_PREFIX, SPEC_SAMPLE_FLOAT, error);
	if (status == SPEC_OK)
		status = add_films(render, error);
	if (status == SPEC_OK && has_surface(render))
		status = spec_sums_add_channels(image, "", error);
	if (status == SPEC_OK)
		status = add_lamps(render, error);
	if (status == SPEC_OK)
		status = spec_image_index(image, "the rendered image", error);
	if (status == SPEC_OK)
		status = spec_image_set_bins(
			image, render->bands.edges_nm, render->bands.count, error);
	if (status == SPEC_OK)
		status = spec_image_index(image, "the rendered image", error);
	return status == SPEC_OK ? set_slots(render, error) : status;
}

/* --- opening --- */

static void
settle_setup(struct spec_render *render)
{
	struct spec_render_setup *setup = &render->setup;
	const struct spec_scene *scene = render->scene;

	if (setup->width == 0) {
		setup->width = scene->width;
		setup->height = scene->height;
	}
	if (setup->samples == 0)
		setup->samples = scene->samples > 0 ? scene->samples : USUAL_SAMPLES;
}

/* Of one sample there is none, and the layers' would be missing. */
static enum spec_status
refuse_variance(const struct spec_render *render, struct spec_error *error)
{
	const struct spec_render_setup *setup = &render->setup;

	if (!setup->variance)
		return SPEC_OK;
	if (setup->films > 0 || setup->discs)
		return spec_error_set(error, SPEC_EUNSUPPORTED,
			"variances of light layers are not kept: --variance and --defer "
			"exclude each other");
	if (setup->samples < 2)
		return spec_error_set(error, SPEC_EUSAGE,
			"a variance needs 2 samples per pixel or more (--spp N)");
	return SPEC_OK;
}

/* What a film itself sends out has no layer. */
static enum spec_status
refuse_shining_films(const struct spec_render *render, struct spec_error *error)
{
	const struct spec_scene *scene = render->scene;

	for (size_t i = 0; i < scene->shapes && render->setup.films > 0; i++) {
		const struct spec_scene_shape *shape = &scene->shape[i];

		if (shape->light == SPEC_SCENE_NONE ||
			scene->material[shape->material].kind != SPEC_SCENE_THINFILM)
			continue;
		(void)spec_error_set(
			error, SPEC_EUNSUPPORTED, "a film that shines cannot be deferred");
		spec_scene_prefix(scene, &shape->place, error);
		return SPEC_EUNSUPPORTED;
	}
	return SPEC_OK;
}

enum spec_status
spec_render_open(struct spec_render *render, const struct spec_scene *scene,
	const struct spec_render_setup *setup, const struct spec_settings *settings,
	struct spec_error *error)
{
	enum spec_status status;

	*render = (struct spec_render){.setup = *setup, .scene = scene};
	settle_setup(render);
	status = refuse_variance(render, error);
	if (status == SPEC_OK)
		status = refuse_shining_films(render, error);
	if (status == SPEC_OK)
		status = spec_bands_make(
			&render->bands, setup->grid, setup->extrapolate, error);
	if (status == SPEC_OK)
		status = spec_world_open(&render->world, scene, error);
	if (status == SPEC_OK)
		status = spec_materials_make(
			&render->material, scene, &render->bands, error);
	if (status == SPEC_OK)
		status = spec_lights_make(&render->lights, scene, render->world,
			&render->bands, settings, error);
	if (status == SPEC_OK && setup->discs)
		render->lamps = spec_lights_small(render->lights);
	if (status == SPEC_OK)
		status = make_header(render, error);
	if (status != SPEC_OK) {
		spec_render_close(render);
		return status;
	}
	spec_camera_make(&render->camera, scene, render->setup.width * setup->supersample,
		render->setup.height * setup->supersample);
	render->tracer = (struct spec_tracer){scene, render->world, render->lights,
		render->material, render->bands.count,
		scene->max_depth >= 0 ? scene->max_depth : USUAL_DEPTH};
	return SPEC_OK;
}

void
spec_render_close(struct spec_render *render)
{
	if (render->scene)
		spec_materials_free(render->material, render->scene->materials);
	spec_lights_free(render->lights);
	spec_world_close(render->world);
	spec_image_clear(&render->image);
	spec_bands_free(&render->bands);
	free(render->slot);
	*render = (struct spec_render){0};
}

/* --- a pixel --- */

/* What a line is worked on with. */
struct desk {
	struct spec_render *render;
	struct spec_path_room *room;
	struct spec_sums_ids ids[ALL_IDS]; /* of each film, the surface, the others */
	float *radiance;                   /* [bands] */
	double *sums;                      /* [slots] */
};

SPEC_VECTORISED static void
add_values(double *restrict sum, const float *restrict value, size_t count)
{
	for (size_t i = 0; i < count; i++)
		sum[i] += value[i];
}

static void
add_bands_to(struct desk *desk, size_t slot)
{
	add_values(desk->sums + slot, desk->radiance, desk->render->bands.count);
}

/* Radiance along a ray, into the sums at slot. */
static void
add_radiance(struct desk *desk, const struct spec_ray *ray, int depth, int without_small,
	struct spec_sampler *sampler, size_t slot)
{
	memset(desk->radiance, 0, desk->render->bands.count * sizeof *desk->radiance);
	spec_path_trace(&desk->render->tracer, ray, depth, without_small, sampler,
		desk->room, desk->radiance);
	add_bands_to(desk, slot);
}

static const struct spec_scene_material *
material_at(const struct spec_render *render, const struct spec_hit *hit)
{
	return &render->scene->material[render->scene->shape[hit->shape].material];
}

/* The lights that a deferred disc is lit by, shadows included. */
static void
add_lamp_light(struct desk *desk, const struct spec_hit *hit)
{
	const struct spec_render *render = desk->render;

	for (size_t i = 0; i < render->lamps; i++) {
		size_t slot = lamp_slot(render, i);
		double *direction_sum = desk->sums + slot + render->bands.count, distance;
		struct spec_vector direction;

		spec_lights_reach(render->lights, i, hit->point, &direction, &distance,
			desk->radiance);
		direction_sum[0] += direction.x;
		direction_sum[1] += direction.y;
		direction_sum[2] += direction.z;
		if (!spec_world_shades(render->world, hit, direction, distance))
			add_bands_to(desk, slot);
	}
}

/* A sample whose first surface is seen by no film. */
static void
add_plain(struct desk *desk, const struct spec_ray *ray, const struct spec_hit *hit,
	struct spec_sampler *sampler)
{
	const struct spec_render *render = desk->render;
	int deferred = hit && render->setup.discs &&
		       material_at(render, hit)->kind == SPEC_SCENE_DIFFRACTIVE;

	if (hit && (deferred || render->setup.geometry))
		spec_sums_add(
			desk->sums + (deferred ? surface_slot(render) : other_slot(render)),
			&desk->ids[deferred ? SURFACE_IDS : OTHER_IDS], hit,
			spec_vector_negate(ray->direction), material_at(render, hit)->id);
	if (deferred)
		add_lamp_light(desk, hit);
	add_radiance(desk, ray, 0, deferred, sampler, 0);
}

/* Not from within a substrate that absorbs: all is dark there. */
static int
is_deferred_film(const struct spec_render *render, const struct spec_hit *hit,
	const struct spec_ray *ray)
{
	size_t material = render->scene->shape[hit->shape].material;

	return render->scene->material[material].kind == SPEC_SCENE_THINFILM &&
	       (spec_vector_dot(hit->shading, ray->direction) <= 0 ||
		       render->material[material].coating.clear_behind);
}

static int
meet(const struct spec_world *world, const struct spec_ray *ray, struct spec_hit *hit)
{
	if (!spec_world_meet(world, ray, hit))
		return 0;
	spec_world_describe(world, hit);
	return 1;
}

static void
add_sample(struct desk *desk, const struct spec_ray *first, struct spec_sampler *sampler)
{
	const struct spec_render *render = desk->render;
	struct spec_ray ray = *first, mirrored;
	struct spec_hit hit;
	size_t films = (size_t)render->setup.films, film = 0;
	int met;

	if (films == 0 && !has_surface(render)) {
		add_radiance(desk, &ray, 0, 0, sampler, 0);
		return;
	}
	met = meet(render->world, &ray, &hit);
	while (met && film < films && (int)film < render->tracer.max_depth &&
		is_deferred_film(render, &hit, &ray)) {
		struct spec_vector eye = spec_vector_negate(ray.direction);
		size_t slot = film_slot(render, film);

		spec_sums_add(desk->sums + slot + render->bands.count, &desk->ids[film],
			&hit, eye, material_at(render, &hit)->id);
		mirrored = spec_world_leave(
			render->world, &hit, spec_vector_mirror(eye, hit.shading));
		add_radiance(desk, &mirrored, (int)film + 1, 0, sampler, slot);
		/* Nothing comes through a substrate that absorbs. */
		if (!render->material[render->scene->shape[hit.shape].material]
				.coating.clear_behind)
			return;
		ray = spec_world_leave(render->world, &hit, ray.direction);
		film++;
		met = meet(render->world, &ray, &hit);
	}
	if (film == 0)
		add_plain(desk, &ray, met ? &hit : NULL, sampler);
	else
		add_radiance(desk, &ray, (int)film, 0, sampler, through_slot(render));
}

static void
finish_surface(struct desk *desk, unsigned samples)
{
	double *surface = desk->sums + surface_slot(desk->render);
	const double *other = desk->sums + other_slot(desk->render);
	size_t ids = SURFACE_IDS;

	if (surface[SPEC_SUMS_COVER] == 0) {
		memcpy(surface, other, SPEC_SUMS_GEOMETRY * sizeof *surface);
		ids = OTHER_IDS;
	}
	spec_sums_finish(surface, &desk->ids[ids], samples);
}

static void
finish_pixel(struct desk *desk, unsigned samples)
{
	const struct spec_render *render = desk->render;
	size_t bands = render->bands.count, films = (size_t)render->setup.films;
	double share = 1.0 / samples;

	if (render->setup.variance)
		spec_variance_finish(
			desk->sums + variance_slot(render), desk->sums, bands, samples);
	for (size_t i = 0; i < 2 * bands; i++)
		desk->sums[i] *= share;
	for (size_t i = 0; i < films; i++) {
		double *sum = desk->sums + film_slot(render, i);

		for (size_t j = 0; j < bands; j++)
			sum[j] *= share;
		spec_sums_finish(sum + bands, &desk->ids[i], samples);
	}
	finish_surface(desk, samples);
	for (size_t i = 0; i < render->lamps; i++) {
		double *sum = desk->sums + lamp_slot(render, i);
		struct spec_vector d = spec_vector_unit(
			(struct spec_vector){sum[bands], sum[bands + 1], sum[bands + 2]});

		for (size_t j = 0; j < bands; j++)
			sum[j] *= share;
		sum[bands] = d.x;
		sum[bands + 1] = d.y;
		sum[bands + 2] = d.z;
	}
}

/* Ends a batch of S0; the sums at its beginning stand behind its variance. */
static unsigned
end_batch(struct desk *desk, unsigned begin, unsigned end)
{
	size_t bands = desk->render->bands.count;
	double *squares = desk->sums + variance_slot(desk->render);

	spec_variance_add(squares, squares + bands, desk->sums, bands, end - begin);
	return end;
}

static void
render_pixel(struct desk *desk, int x, int y)
{
	const struct spec_render *render = desk->render;
	unsigned samples = (unsigned)render->setup.samples, begin = 0;
	struct spec_sampler sampler;

	memset(desk->sums, 0, render->slots * sizeof *desk->sums);
	for (size_t i = 0; i < ALL_IDS; i++)
		desk->ids[i].ids = 0;
	for (unsigned i = 0; i < samples; i++) {
		struct spec_ray ray;
		double pair[2];

		spec_sampler_start(&sampler, (uint64_t)render->setup.seed, x, y, i);
		spec_sampler_pair(&sampler, pair);
		ray = spec_camera_ray(&render->camera, x + pair[0], y + pair[1], &sampler);
		add_sample(desk, &ray, &sampler);
		if (render->setup.variance && spec_variance_ends(i, samples))
			begin = end_batch(desk, begin, i + 1);
	}
	finish_pixel(desk, samples);
}

static void
store_pixel(const struct desk *desk, float *const *plane, size_t x)
{
	const struct spec_image *image = &desk->render->image;

	for (size_t i = 0; i < image->channels; i++) {
		double value = desk->sums[desk->render->slot[i]];

		if (image->channel[i].sample == SPEC_SAMPLE_UINT) {
			uint32_t number = (uint32_t)value;

			memcpy(plane[i] + x, &number, sizeof number);
		} else {
			plane[i][x] = (float)value;
		}
	}
}

static enum spec_status
render_line(
	void *state, struct spec_stream_worker *worker, int line, struct spec_error *error)
{
	struct spec_render *render = state;
	const struct spec_window *data = &render->image.data;
	struct desk desk = {.render = render};
	float *const *plane;
	enum spec_status status;

	desk.sums = worker->scratch;
	desk.radiance = (float *)(void *)(desk.sums + render->slots);
	desk.room = spec_path_room_new(render->bands.count, error);
	if (!desk.room)
		return SPEC_ENOMEM;
	status = spec_packer_begin(worker->packer, data->y0 + line, &plane, error);
	for (int x = data->x0; x < data->x1 && status == SPEC_OK; x++) {
		render_pixel(&desk, x, data->y0 + line);
		store_pixel(&desk, plane, (size_t)(x - data->x0));
	}
	spec_path_room_free(desk.room);
	return status == SPEC_OK ? spec_packer_end(worker->packer, data->y0 + line, error)
				 : status;
}

static enum spec_status
kernel(void *state, struct spec_stream_worker *worker, int line, struct spec_error *error)
{
	unsigned modes = _mm_getcsr();
	enum spec_status status;

	/* What Embree wants: tiny numbers are 0. The thread may be the caller's. */
	_mm_setcsr(modes | _MM_FLUSH_ZERO_ON | _MM_DENORMALS_ZERO_ON);
	status = render_line(state, worker, line, error);
	_mm_setcsr(modes);
	return status;
}

enum spec_status
spec_render_run(struct spec_render *render, const struct spec_settings *settings,
	unsigned long long *overflows, struct spec_error *error)
{
	struct spec_stream stream = {
		.lines = (int)spec_window_height(&render->image.data),
		.lines_in = 1,
		.scratch_bytes = render->slots * sizeof(double) +
				 render->bands.count * sizeof(float),
		.state = render,
		.kernel = kernel,
	};

	return spec_image_save(&render->image, &stream, settings, overflows, error);
}
