#include "render/light.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "base/memory.h"
#include "base/vector.h"
#include "render/surroundings.h"

#define PI 3.14159265358979323846
#define ON 2e-6 /* of a sphere's radius: a point so near counts as on it */
/*
 * How far off an area rays may meet it, of the size of the numbers that it is computed from:
 * 33 ulps of single precision for meshes, which are Embree's, else 45000 of double precision.
 */
#define OFF 2e-6
#define THIN_OFF 1e-11

/* One thing that may be chosen: a light without a shape, or a shape that shines. */
struct emitter {
	enum spec_scene_light_kind kind;
	size_t light;         /* its number in the scene */
	size_t shape;         /* of an area light */
	double chance, until; /* of being chosen, and the sum up to here */
	float *value;         /* [bands] */
	/* Areas. */
	double area;            /* [m^2] */
	double *triangle_until; /* [triangles] cumulative area of a mesh's */
	struct spec_vector
		*corner;       /* [3 * triangles] a corner and two edges, in world space */
	unsigned char *inward; /* [triangles] the edges' cross product points inward */
	double radius;         /* of a sphere in world space [m] */
	struct spec_vector middle;
};

struct spec_lights {
	const struct spec_scene *scene;
	size_t bands, emitters;
	struct emitter *emitter;
	size_t *of_shape;    /* [shapes] the emitter, or SPEC_SCENE_NONE */
	size_t surroundings; /* the emitter of the infinite light, or SPEC_SCENE_NONE */
	struct spec_surroundings picture; /* of it, if it has one */
	struct spec_vector world_middle;
	double world_radius;
};

static struct spec_vector
vector_of(const double v[3])
{
	return (struct spec_vector){v[0], v[1], v[2]};
}

static struct spec_vector
turned(const double m[4][4], struct spec_vector v)
{
	return (struct spec_vector){m[0][0] * v.x + m[0][1] * v.y + m[0][2] * v.z,
		m[1][0] * v.x + m[1][1] * v.y + m[1][2] * v.z,
		m[2][0] * v.x + m[2][1] * v.y + m[2][2] * v.z};
}

static struct spec_vector
moved(const double m[4][4], struct spec_vector p)
{
	return spec_vector_add(
		turned(m, p), (struct spec_vector){m[0][3], m[1][3], m[2][3]});
}

static struct spec_vector
corner(const struct spec_scene_shape *shape, size_t triangle, size_t i)
{
	const float *p = shape->point + 3 * (size_t)shape->index[3 * triangle + i];

	return moved(shape->world.m, (struct spec_vector){p[0], p[1], p[2]});
}

/*
 * Whether the winding of a triangle in world space shows its inside: outward is as in object
 * space, also where a space turns left hands to right ones, and as the vertices' normals say.
 */
static int
is_inward(const struct spec_scene_shape *shape, size_t triangle)
{
	const double(*m)[4] = shape->world.m;
	struct spec_vector x = {m[0][0], m[1][0], m[2][0]};
	struct spec_vector y = {m[0][1], m[1][1], m[2][1]};
	struct spec_vector z = {m[0][2], m[1][2], m[2][2]};
	int mirrored = spec_vector_dot(spec_vector_cross(x, y), z) < 0;
	const uint32_t *index = shape->index + 3 * triangle;
	struct spec_vector local[3], normal;
	double sum = 0;

	for (size_t i = 0; i < 3; i++) {
		const float *p = shape->point + 3 * (size_t)index[i];

		local[i] = (struct spec_vector){p[0], p[1], p[2]};
	}
	normal = spec_vector_cross(spec_vector_subtract(local[1], local[0]),
		spec_vector_subtract(local[2], local[0]));
	for (size_t i = 0; i < 3 && shape->normal; i++) {
		const float *n = shape->normal + 3 * (size_t)index[i];

		sum += spec_vector_dot(normal, (struct spec_vector){n[0], n[1], n[2]});
	}
	return mirrored != (sum < 0);
}

static enum spec_status
measure_mesh(struct emitter *emitter, const struct spec_scene_shape *shape,
	struct spec_error *error)
{
	double *until =
		spec_memory_new(shape->triangles, sizeof *until, "triangles", error);

	emitter->triangle_until = until;
	emitter->corner = spec_memory_new(
		shape->triangles, 3 * sizeof *emitter->corner, "triangles", error);
	emitter->inward = spec_memory_new(shape->triangles, 1, "triangles", error);
	if (!until || !emitter->corner || !emitter->inward)
		return SPEC_ENOMEM;
	for (size_t i = 0; i < shape->triangles; i++) {
		struct spec_vector *at = emitter->corner + 3 * i;

		at[0] = corner(shape, i, 0);
		at[1] = spec_vector_subtract(corner(shape, i, 1), at[0]);
		at[2] = spec_vector_subtract(corner(shape, i, 2), at[0]);
		emitter->inward[i] = (unsigned char)is_inward(shape, i);
		emitter->area += spec_vector_length(spec_vector_cross(at[1], at[2])) / 2;
		until[i] = emitter->area;
	}
	return SPEC_OK;
}

/* The lengths of the axes of a shape's space; all the same for what stays a sphere. */
static int
is_similar(const double m[4][4], double *scale)
{
	double length[3], most = 0, skew = 0;

	for (int i = 0; i < 3; i++) {
		length[i] = sqrt(m[0][i] * m[0][i] + m[1][i] * m[1][i] + m[2][i] * m[2][i]);
		most = fmax(most, length[i]);
	}
	for (int i = 0; i < 3; i++) {
		int j = (i + 1) % 3;

		skew = fmax(skew,
			fabs(m[0][i] * m[0][j] + m[1][i] * m[1][j] + m[2][i] * m[2][j]));
		skew = fmax(skew, fabs(length[i] - length[j]) * most);
	}
	*scale = length[0];
	return skew <= 1e-6 * most * most;
}

static enum spec_status
measure_area(struct spec_lights *lights, struct emitter *emitter, struct spec_error *error)
{
	const struct spec_scene_shape *shape = &lights->scene->shape[emitter->shape];
	double scale, r = shape->radius, inner = shape->inner_radius;

	if (shape->kind == SPEC_SCENE_MESH)
		return measure_mesh(emitter, shape, error);
	if (shape->kind == SPEC_SCENE_DISK) {
		struct spec_vector x =
			turned(shape->world.m, (struct spec_vector){1, 0, 0});
		struct spec_vector y =
			turned(shape->world.m, (struct spec_vector){0, 1, 0});

		emitter->area = PI * (r * r - inner * inner) *
				spec_vector_length(spec_vector_cross(x, y));
		return SPEC_OK;
	}
	if (!is_similar(shape->world.m, &scale)) {
		(void)spec_error_set(error, SPEC_EUNSUPPORTED,
			"a sphere that shines cannot be stretched yet");
		spec_scene_prefix(lights->scene, &shape->place, error);
		return SPEC_EUNSUPPORTED;
	}
	emitter->radius = r * scale;
	emitter->middle = moved(shape->world.m, (struct spec_vector){0, 0, 0});
	emitter->area = 4 * PI * emitter->radius * emitter->radius;
	return SPEC_OK;
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
		return 4 * PI * mean;
	if (emitter->kind == SPEC_SCENE_DISTANT)
		return PI * square * mean;
	if (emitter->kind == SPEC_SCENE_INFINITE)
		return 4 * PI * PI * square * mean *
		       (lights->picture.pixel ? lights->picture.mean : 1);
	return emitter->area * PI * mean * (light->twosided ? 2 : 1);
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
	if (status == SPEC_OK && from->kind == SPEC_SCENE_AREA)
		status = measure_area(lights, emitter, error);
	return status;
}

static enum spec_status
read_picture(struct spec_lights *lights, const struct spec_scene_light *light,
	const struct spec_bands_grid *bands, const struct spec_settings *settings,
	struct spec_error *error)
{
	double scale;
	enum spec_status status = SPEC_OK;

	if (!is_similar(light->world.m, &scale))
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

	*result = lights;
	if (!lights)
		return SPEC_ENOMEM;
	lights->scene = scene;
	lights->bands = bands->count;
	lights->surroundings = SPEC_SCENE_NONE;
	spec_world_bounds(world, &lights->world_middle, &lights->world_radius);
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
		free(lights->emitter[i].triangle_until);
		free(lights->emitter[i].corner);
		free(lights->emitter[i].inward);
	}
	free(lights->emitter);
	free(lights->of_shape);
	spec_surroundings_free(&lights->picture);
	free(lights);
}

SPEC_VECTORISED static void
scale_values(float *restrict to, const float *restrict from, float factor, size_t count)
{
	for (size_t i = 0; i < count; i++)
		to[i] = factor * from[i];
}

/* What the numbers are in size that a point is computed from. */
static double
size_of(struct spec_vector v)
{
	return fabs(v.x) + fabs(v.y) + fabs(v.z);
}

/*
 * A point of an area, uniform over it, and the outward normal there. Returns how far off it
 * rays may meet it along the normal [m].
 */
static double
sample_area(const struct spec_scene_shape *shape, const struct emitter *emitter,
	const double pair[2], double number, struct spec_vector *point,
	struct spec_vector *normal)
{
	const double(*m)[4] = shape->world.m;
	double root = sqrt(pair[0]), angle = 2 * PI * pair[1], off;

	if (shape->kind == SPEC_SCENE_MESH) {
		double wanted = number * emitter->area;
		size_t low = 0, high = shape->triangles - 1;
		const struct spec_vector *at;

		while (low < high) {
			size_t middle = (low + high) / 2;

			if (emitter->triangle_until[middle] <= wanted)
				low = middle + 1;
			else
				high = middle;
		}
		at = emitter->corner + 3 * low;
		*point = spec_vector_along(
			spec_vector_along(at[0], at[1], root * (1 - pair[1])), at[2],
			root * pair[1]);
		*normal = spec_vector_unit(spec_vector_cross(at[1], at[2]));
		if (emitter->inward[low])
			*normal = spec_vector_negate(*normal);
		off = OFF * (size_of(*point) + size_of(at[1]) + size_of(at[2]));
	} else {
		double inner = shape->inner_radius, outer = shape->radius;
		double r = sqrt(inner * inner + pair[0] * (outer * outer - inner * inner));
		struct spec_vector x = turned(m, (struct spec_vector){1, 0, 0});
		struct spec_vector y = turned(m, (struct spec_vector){0, 1, 0});

		*point = moved(m, (struct spec_vector){
					  r * cos(angle), r * sin(angle), shape->height});
		*normal = spec_vector_unit(spec_vector_cross(x, y));
		if (spec_vector_dot(*normal, turned(m, (struct spec_vector){0, 0, 1})) < 0)
			*normal = spec_vector_negate(*normal);
		off = THIN_OFF * (size_of(*point) + outer);
	}
	if (shape->reverse_orientation)
		*normal = spec_vector_negate(*normal);
	return off;
}

/* 1 - cosine of the cone that a sphere fills; 2, all directions, from within and on it. */
static double
cone_of(const struct emitter *emitter, struct spec_vector point, struct spec_vector *axis)
{
	double distance, sine;

	*axis = spec_vector_subtract(emitter->middle, point);
	distance = spec_vector_length(*axis);
	if (distance <= emitter->radius * (1 + ON)) {
		*axis = (struct spec_vector){0, 0, 1};
		return 2;
	}
	sine = emitter->radius / distance;
	*axis = spec_vector_scale(*axis, 1 / distance);
	return sine * sine / (1 + sqrt(1 - sine * sine));
}

static int
sample_sphere(const struct emitter *emitter, struct spec_vector point, const double pair[2],
	struct spec_light_sample *sample)
{
	struct spec_frame frame;
	struct spec_vector axis;
	double cone = cone_of(emitter, point, &axis), cosine = 1 - pair[0] * cone;
	double sine = sqrt(fmax(0, 1 - cosine * cosine)), angle = 2 * PI * pair[1];
	double middle, half;
	struct spec_vector to = spec_vector_subtract(emitter->middle, point);

	if (!(cone > 0))
		return 0;
	frame = spec_frame_about(axis);
	sample->direction = spec_frame_to_world(
		&frame, (struct spec_vector){sine * cos(angle), sine * sin(angle), cosine});
	middle = spec_vector_dot(sample->direction, to);
	half = emitter->radius * emitter->radius -
	       (spec_vector_dot(to, to) - middle * middle);
	half = sqrt(fmax(0, half));
	sample->distance = cone < 2 ? middle - half : middle + half;
	sample->density = 1 / (2 * PI * cone);
	return sample->distance > ON * emitter->radius; /* else outwards, on it */
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
	const struct spec_scene_shape *shape = &lights->scene->shape[emitter->shape];
	const struct spec_scene_light *light = &lights->scene->light[emitter->light];
	struct spec_vector point, normal, to;
	double square, off, cosine;

	if (shape->kind == SPEC_SCENE_SPHERE) {
		if (!sample_sphere(emitter, from, pair, sample))
			return 0;
		point = spec_vector_along(from, sample->direction, sample->distance);
		normal = spec_vector_subtract(point, emitter->middle);
		if (shape->reverse_orientation)
			normal = spec_vector_negate(normal);
		return shines(light, normal, sample->direction);
	}
	off = sample_area(shape, emitter, pair, number, &point, &normal);
	to = spec_vector_subtract(point, from);
	square = spec_vector_dot(to, to);
	if (!(square > 0))
		return 0;
	sample->distance = sqrt(square);
	sample->direction = spec_vector_scale(to, 1 / sample->distance);
	cosine = fabs(spec_vector_dot(normal, sample->direction));
	sample->density = square / (emitter->area * cosine);
	sample->distance = fmax(sample->distance - off / cosine, 0);
	return sample->density < INFINITY && shines(light, normal, sample->direction);
}

static int
sample_surroundings(const struct spec_lights *lights, const struct emitter *emitter,
	const double pair[2], struct spec_light_sample *sample)
{
	const struct spec_scene_light *light = &lights->scene->light[emitter->light];
	double z = 1 - 2 * pair[0], r = sqrt(fmax(0, 1 - z * z)), angle = 2 * PI * pair[1];
	struct spec_vector local = {r * cos(angle), r * sin(angle), z};

	sample->density = 1 / (4 * PI);
	sample->direction = local;
	if (lights->picture.pixel) {
		sample->density = spec_surroundings_sample(&lights->picture, pair, &local);
		sample->direction = spec_vector_unit(turned(light->world.m, local));
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
	struct spec_vector to = vector_of(light->from);
	double square;

	if (emitter->kind == SPEC_SCENE_DISTANT) {
		*direction =
			spec_vector_unit(spec_vector_subtract(to, vector_of(light->to)));
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
	double factor;

	spec_sampler_pair(sampler, pair);
	while (emitter < last && !(number < emitter->until))
		emitter++;
	if (emitter == last || !(emitter->chance > 0))
		return 0;
	number = (number - (emitter->until - emitter->chance)) / emitter->chance;
	if (emitter->kind == SPEC_SCENE_POINT || emitter->kind == SPEC_SCENE_DISTANT) {
		factor = reach(
			lights, emitter, point, &sample->direction, &sample->distance);
		sample->density = 0;
		scale_values(sample->value, emitter->value,
			(float)(factor / emitter->chance), lights->bands);
		return 1;
	}
	if (emitter->kind == SPEC_SCENE_INFINITE) {
		if (!sample_surroundings(lights, emitter, pair, sample))
			return 0;
		sample->density *= emitter->chance;
		memset(sample->value, 0, lights->bands * sizeof *sample->value);
		spec_lights_add_surroundings(lights, sample->direction, NULL,
			1 / sample->density, sample->value);
		return 1;
	}
	if (!sample_shape(lights, emitter, point, pair, number, sample))
		return 0;
	sample->density *= emitter->chance;
	scale_values(
		sample->value, emitter->value, (float)(1 / sample->density), lights->bands);
	return 1;
}

const float *
spec_lights_emitted(const struct spec_lights *lights, const struct spec_hit *hit,
	struct spec_vector origin, struct spec_vector direction, double *density)
{
	size_t number = lights->of_shape[hit->shape];
	const struct emitter *emitter;
	const struct spec_scene_shape *shape;
	struct spec_vector axis, to;

	*density = 0;
	if (number == SPEC_SCENE_NONE)
		return NULL;
	emitter = &lights->emitter[number];
	shape = &lights->scene->shape[hit->shape];
	if (!shines(&lights->scene->light[emitter->light], hit->normal, direction))
		return NULL;
	if (shape->kind == SPEC_SCENE_SPHERE) {
		*density = emitter->chance / (2 * PI * cone_of(emitter, origin, &axis));
		return emitter->value;
	}
	to = spec_vector_subtract(hit->point, origin);
	*density = emitter->chance * spec_vector_dot(to, to) /
		   (emitter->area * fabs(spec_vector_dot(hit->normal, direction)));
	return emitter->value;
}

SPEC_VECTORISED static void
add_product(float *restrict radiance, const float *restrict factor,
	const float *restrict value, float weight, size_t count)
{
	for (size_t i = 0; i < count; i++)
		radiance[i] += weight * factor[i] * value[i];
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
		struct spec_vector local =
			spec_vector_unit(turned(light->world.inverse, direction));

		/* The value is the scale alone, the same in all bands. */
		spec_surroundings_add(&lights->picture, local,
			factor ? factor : emitter->value,
			factor ? weight * emitter->value[0] : weight, radiance);
	} else if (factor) {
		add_product(radiance, factor, emitter->value, (float)weight, lights->bands);
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

		return emitter->chance *
		       spec_surroundings_density(&lights->picture,
			       spec_vector_unit(turned(light->world.inverse, direction)));
	}
	return emitter->chance / (4 * PI);
}
