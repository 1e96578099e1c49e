#include "render/light.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "base/memory.h"
#include "base/vector.h"
#include "render/area.h"
#include "render/daylight.h"
#include "render/surroundings.h"
#include "render/through.h"

/* One thing that may be chosen: a light without a shape, or a shape that shines. */
struct emitter {
	enum spec_scene_light_kind kind;
	size_t light;          /* its number in the scene */
	size_t shape;          /* of an area light */
	double chance, until;  /* of being chosen, and the sum up to here */
	float *value;          /* [bands] */
	struct spec_area area; /* of an area light */
};

struct spec_lights {
	const struct spec_scene *scene;
	const struct spec_world *world;
	size_t bands, emitters;
	struct emitter *emitter;
	size_t *of_shape;    /* [shapes] the emitter, or SPEC_SCENE_NONE */
	size_t surroundings; /* the emitter of the infinite light, or SPEC_SCENE_NONE */
	struct spec_surroundings picture; /* of it, if it has one */
	struct spec_daylight daylight;    /* of it, if it is that */
	double world_radius;
};

/* Whether the infinite light is another one from each direction; its value is a scale then. */
static int
has_picture(const struct spec_lights *lights)
{
	return lights->picture.pixel || lights->daylight.bands > 0;
}

/* Radiant power, up to a factor that all lights share. */
static double
power_of(const struct spec_lights *lights, const struct emitter *emitter)
{
	const struct spec_scene_light *light = &lights->scene->light[emitter->light];
	double mean = 0, square = lights->world_radius * lights->world_radius;

	for (size_t i = 0; i < lights->bands; i++)
		mean += emitter->value[i] / (double)lights->bands;
	if (emitter->kind == SPEC_SCENE_POINT)
		return 4 * M_PI * mean;
	if (emitter->kind == SPEC_SCENE_DISTANT)
		return M_PI * square * mean;
	if (emitter->kind == SPEC_SCENE_INFINITE && lights->picture.pixel)
		mean *= lights->picture.mean;
	else if (emitter->kind == SPEC_SCENE_INFINITE && has_picture(lights))
		mean *= lights->daylight.mean;
	if (emitter->kind == SPEC_SCENE_INFINITE)
		return 4 * M_PI * M_PI * square * mean;
	return emitter->area.area * M_PI * mean * (light->twosided ? 2 : 1);
}

static enum spec_status
add_emitter(struct spec_lights *lights, const struct spec_bands_grid *bands, size_t light,
	size_t shape, struct spec_error *error)
{
	const struct spec_scene_light *from = &lights->scene->light[light];
	struct emitter *emitter = &lights->emitter[lights->emitters++];
	double *value = spec_memory_new(bands->count, sizeof *value, "bands", error);
	enum spec_status status = value ? SPEC_OK : SPEC_ENOMEM;

	*emitter = (struct emitter){.kind = from->kind, .light = light, .shape = shape};
	emitter->value = spec_memory_new(bands->count, sizeof(float), "bands", error);
	if (!emitter->value)
		status = SPEC_ENOMEM;
	if (status == SPEC_OK)
		status = spec_bands_sample(bands, lights->scene, &from->spectrum,
			SPEC_BANDS_LIGHT, value, error);
	for (size_t i = 0; i < bands->count && status == SPEC_OK; i++) {
		emitter->value[i] = (float)(value[i] * from->scale);
		if (isfinite(emitter->value[i]))
			continue;
		status = spec_error_set(error, SPEC_ERANGE,
			"the light is too bright at %g nm", bands->wavelength_nm[i]);
		spec_scene_prefix(lights->scene, &from->place, error);
	}
	free(value);
	if (status != SPEC_OK || from->kind != SPEC_SCENE_AREA)
		return status;
	status = spec_area_make(&emitter->area, &lights->scene->shape[shape],
		spec_world_facets(lights->world, shape), error);
	if (status == SPEC_EUNSUPPORTED)
		spec_scene_prefix(lights->scene, &lights->scene->shape[shape].place, error);
	return status;
}

static enum spec_status
read_picture(struct spec_lights *lights, const struct spec_scene_light *light,
	const struct spec_bands_grid *bands, const struct spec_settings *settings,
	struct spec_error *error)
{
	double scale;
	enum spec_status status = SPEC_OK;

	if (!spec_area_is_similar(light->world.m, &scale))
		status = spec_error_set(error, SPEC_EUNSUPPORTED,
			"a picture of surroundings cannot be stretched");
	if (status == SPEC_OK)
		status = spec_surroundings_read(
			&lights->picture, light->picture, bands, settings, error);
	if (status != SPEC_OK)
		spec_scene_prefix(lights->scene, &light->place, error);
	return status;
}

static enum spec_status
make_daylight(struct spec_lights *lights, const struct spec_scene_light *light,
	const struct spec_bands_grid *bands, struct spec_error *error)
{
	enum spec_status status =
		spec_daylight_make(&lights->daylight, light->daylight, bands, error);

	if (status != SPEC_OK)
		spec_scene_prefix(lights->scene, &light->place, error);
	return status;
}

static enum spec_status
add_lights(struct spec_lights *lights, const struct spec_bands_grid *bands,
	const struct spec_settings *settings, struct spec_error *error)
{
	const struct spec_scene *scene = lights->scene;
	enum spec_status status = SPEC_OK;

	for (size_t i = 0; i < scene->lights && status == SPEC_OK; i++) {
		const struct spec_scene_light *light = &scene->light[i];

		if (light->kind == SPEC_SCENE_AREA)
			continue;
		if (light->kind == SPEC_SCENE_INFINITE &&
			lights->surroundings != SPEC_SCENE_NONE) {
			status = spec_error_set(error, SPEC_EUNSUPPORTED,
				"a second infinite light cannot be rendered yet");
			spec_scene_prefix(scene, &light->place, error);
			continue;
		}
		if (light->kind == SPEC_SCENE_INFINITE)
			lights->surroundings = lights->emitters;
		if (light->picture)
			status = read_picture(lights, light, bands, settings, error);
		if (light->daylight)
			status = make_daylight(lights, light, bands, error);
		if (status == SPEC_OK)
			status = add_emitter(lights, bands, i, SPEC_SCENE_NONE, error);
	}
	for (size_t i = 0; i < scene->shapes && status == SPEC_OK; i++) {
		if (scene->shape[i].light == SPEC_SCENE_NONE)
			continue;
		lights->of_shape[i] = lights->emitters;
		status = add_emitter(lights, bands, scene->shape[i].light, i, error);
	}
	return status;
}

/* Half by power, half equally: a small light that is near may matter more than a large sky. */
static void
share_chances(struct spec_lights *lights)
{
	double whole = 0, until = 0;
	size_t shining = 0;

	for (size_t i = 0; i < lights->emitters; i++) {
		struct emitter *emitter = &lights->emitter[i];

		emitter->chance = power_of(lights, emitter);
		whole += emitter->chance;
		shining += emitter->chance > 0;
	}
	for (size_t i = 0; i < lights->emitters; i++) {
		struct emitter *emitter = &lights->emitter[i];

		if (emitter->chance > 0)
			emitter->chance =
				(emitter->chance / whole + 1.0 / (double)shining) / 2;
		emitter->until = until += emitter->chance;
	}
}

enum spec_status
spec_lights_make(struct spec_lights **result, const struct spec_scene *scene,
	const struct spec_world *world, const struct spec_bands_grid *bands,
	const struct spec_settings *settings, struct spec_error *error)
{
	struct spec_lights *lights = spec_memory_new(1, sizeof *lights, "lights", error);
	enum spec_status status = SPEC_OK;
	struct spec_vector middle;

	*result = lights;
	if (!lights)
		return SPEC_ENOMEM;
	lights->scene = scene;
	lights->world = world;
	lights->bands = bands->count;
	lights->surroundings = SPEC_SCENE_NONE;
	spec_world_bounds(world, &middle, &lights->world_radius);
	lights->emitter = spec_memory_new(
		scene->lights + scene->shapes, sizeof *lights->emitter, "lights", error);
	lights->of_shape =
		spec_memory_new(scene->shapes, sizeof *lights->of_shape, "shapes", error);
	if (!lights->emitter || !lights->of_shape)
		status = SPEC_ENOMEM;
	for (size_t i = 0; i < scene->shapes && status == SPEC_OK; i++)
		lights->of_shape[i] = SPEC_SCENE_NONE;
	if (status == SPEC_OK)
		status = add_lights(lights, bands, settings, error);
	if (status == SPEC_OK)
		share_chances(lights);
	else
		spec_lights_free(lights);
	if (status != SPEC_OK)
		*result = NULL;
	return status;
}

void
spec_lights_free(struct spec_lights *lights)
{
	if (!lights)
		return;
	for (size_t i = 0; lights->emitter && i < lights->emitters; i++) {
		free(lights->emitter[i].value);
		spec_area_free(&lights->emitter[i].area);
	}
	free(lights->emitter);
	free(lights->of_shape);
	spec_surroundings_free(&lights->picture);
	spec_daylight_free(&lights->daylight);
	free(lights);
}

SPEC_VECTORISED static void
scale_values(float *restrict to, const float *restrict from, float factor, size_t count)
{
	for (size_t i = 0; i < count; i++)
		to[i] = factor * from[i];
}

/* Which side of a surface shines: 0 where none does in this direction. */
static int
shines(const struct spec_scene_light *light, struct spec_vector normal,
	struct spec_vector direction)
{
	return light->twosided || spec_vector_dot(normal, direction) < 0;
}

static int
sample_shape(const struct spec_lights *lights, const struct emitter *emitter,
	struct spec_vector from, const double pair[2], double number,
	struct spec_light_sample *sample)
{
	const struct spec_scene_light *light = &lights->scene->light[emitter->light];
	struct spec_area_sample area;

	if (!spec_area_sample(&emitter->area, from, pair, number, &area))
		return 0;
	sample->direction = area.direction;
	sample->distance = area.distance;
	sample->density = area.density;
	return shines(light, area.normal, sample->direction);
}

static int
sample_surroundings(const struct spec_lights *lights, const struct emitter *emitter,
	const double pair[2], double number, struct spec_light_sample *sample)
{
	const struct spec_scene_light *light = &lights->scene->light[emitter->light];
	double z = 1 - 2 * pair[0], r = sqrt(fmax(0, 1 - z * z)),
	       angle = 2 * M_PI * pair[1];
	struct spec_vector local = {r * cos(angle), r * sin(angle), z};

	sample->density = 1 / (4 * M_PI);
	sample->direction = local;
	if (lights->picture.pixel) {
		sample->density = spec_surroundings_sample(&lights->picture, pair, &local);
		sample->direction =
			spec_vector_unit(spec_through_direction(light->world.m, local));
	} else if (has_picture(lights)) {
		sample->density = spec_daylight_sample(
			&lights->daylight, pair, number, &sample->direction);
	}
	sample->distance = INFINITY;
	return sample->density > 0;
}

size_t
spec_lights_small(const struct spec_lights *lights)
{
	size_t count = 0;

	for (size_t i = 0; i < lights->emitters; i++)
		count += lights->emitter[i].kind == SPEC_SCENE_POINT ||
			 lights->emitter[i].kind == SPEC_SCENE_DISTANT;
	return count;
}

/* Direction, distance, and the factor on the value that makes it irradiance. */
static double
reach(const struct spec_lights *lights, const struct emitter *emitter,
	struct spec_vector point, struct spec_vector *direction, double *distance)
{
	const struct spec_scene_light *light = &lights->scene->light[emitter->light];
	struct spec_vector to = spec_vector_of(light->from);
	double square;

	if (emitter->kind == SPEC_SCENE_DISTANT) {
		*direction = spec_vector_unit(
			spec_vector_subtract(to, spec_vector_of(light->to)));
		*distance = INFINITY;
		return 1;
	}
	to = spec_vector_subtract(to, point);
	square = spec_vector_dot(to, to);
	*distance = sqrt(square);
	*direction = spec_vector_scale(to, 1 / *distance);
	return 1 / square;
}

void
spec_lights_reach(const struct spec_lights *lights, size_t small, struct spec_vector point,
	struct spec_vector *direction, double *distance, float *irradiance)
{
	for (size_t i = 0; i < lights->emitters; i++) {
		const struct emitter *emitter = &lights->emitter[i];

		if (emitter->kind != SPEC_SCENE_POINT &&
			emitter->kind != SPEC_SCENE_DISTANT)
			continue;
		if (small-- > 0)
			continue;
		scale_values(irradiance, emitter->value,
			(float)reach(lights, emitter, point, direction, distance),
			lights->bands);
		return;
	}
}

int
spec_lights_sample(const struct spec_lights *lights, struct spec_vector point,
	struct spec_sampler *sampler, struct spec_light_sample *sample)
{
	double number = spec_sampler_number(sampler), pair[2];
	const struct emitter *emitter = lights->emitter;
	const struct emitter *last = lights->emitter + lights->emitters;

	spec_sampler_pair(sampler, pair);
	while (emitter < last && !(number < emitter->until))
		emitter++;
	if (emitter == last || !(emitter->chance > 0))
		return 0;
	number = (number - (emitter->until - emitter->chance)) / emitter->chance;
	sample->radiance.value = emitter->value;
	if (emitter->kind == SPEC_SCENE_POINT || emitter->kind == SPEC_SCENE_DISTANT) {
		sample->radiance.scale = reach(lights, emitter, point, &sample->direction,
						 &sample->distance) /
					 emitter->chance;
		sample->density = 0;
		return 1;
	}
	if (emitter->kind == SPEC_SCENE_INFINITE) {
		if (!sample_surroundings(lights, emitter, pair, number, sample))
			return 0;
		if (has_picture(lights)) {
			memset(sample->radiance.room, 0, lights->bands * sizeof(float));
			spec_lights_add_surroundings(
				lights, sample->direction, NULL, 1, sample->radiance.room);
			sample->radiance.value = sample->radiance.room;
		}
	} else if (!sample_shape(lights, emitter, point, pair, number, sample)) {
		return 0;
	}
	sample->density *= emitter->chance;
	sample->radiance.scale = 1 / sample->density;
	return 1;
}

const float *
spec_lights_emitted(const struct spec_lights *lights, const struct spec_hit *hit,
	struct spec_vector origin, struct spec_vector direction, double *density)
{
	size_t number = lights->of_shape[hit->shape];
	const struct emitter *emitter;

	*density = 0;
	if (number == SPEC_SCENE_NONE)
		return NULL;
	emitter = &lights->emitter[number];
	if (!shines(&lights->scene->light[emitter->light], hit->normal, direction))
		return NULL;
	*density =
		emitter->chance * spec_area_density(&emitter->area, hit, origin, direction);
	return emitter->value;
}

SPEC_VECTORISED static void
add_scaled(
	float *restrict radiance, const float *restrict value, float weight, size_t count)
{
	for (size_t i = 0; i < count; i++)
		radiance[i] += weight * value[i];
}

void
spec_lights_add_surroundings(const struct spec_lights *lights, struct spec_vector direction,
	const float *factor, double weight, float *radiance)
{
	const struct emitter *emitter;

	if (lights->surroundings == SPEC_SCENE_NONE)
		return;
	emitter = &lights->emitter[lights->surroundings];
	if (lights->picture.pixel) {
		const struct spec_scene_light *light =
			&lights->scene->light[emitter->light];
		struct spec_vector local = spec_vector_unit(
			spec_through_direction(light->world.inverse, direction));

		/* The value is the scale alone, the same in all bands. */
		spec_surroundings_add(&lights->picture, local,
			factor ? factor : emitter->value,
			factor ? weight * emitter->value[0] : weight, radiance);
	} else if (has_picture(lights)) {
		spec_daylight_add(&lights->daylight, direction,
			factor ? factor : emitter->value,
			factor ? weight * emitter->value[0] : weight, radiance);
	} else if (factor) {
		spec_bands_add_product(
			radiance, factor, emitter->value, (float)weight, lights->bands);
	} else {
		add_scaled(radiance, emitter->value, (float)weight, lights->bands);
	}
}

double
spec_lights_surroundings_density(
	const struct spec_lights *lights, struct spec_vector direction)
{
	const struct emitter *emitter;

	if (lights->surroundings == SPEC_SCENE_NONE)
		return 0;
	emitter = &lights->emitter[lights->surroundings];
	if (lights->picture.pixel) {
		const struct spec_scene_light *light =
			&lights->scene->light[emitter->light];

		return emitter->chance * spec_surroundings_density(&lights->picture,
						 spec_vector_unit(spec_through_direction(
							 light->world.inverse, direction)));
	}
	if (has_picture(lights))
		return emitter->chance *
		       spec_daylight_density(&lights->daylight, direction);
	return emitter->chance / (4 * M_PI);
}
