#include "render/area.h"

#include <math.h>
#include <stdlib.h>

#include "base/memory.h"
#include "render/through.h"

#define ON 2e-6 /* of a sphere's radius: a point so near counts as on it */
/*
 * How far off an area rays may meet it, of the size of the numbers that it is computed from:
 * 33 ulps of single precision for meshes, which are Embree's, else 45000 of double precision.
 */
#define OFF 2e-6
#define THIN_OFF 1e-11

int
spec_area_is_similar(const double m[4][4], double *scale)
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
measure_mesh(struct spec_area *area, struct spec_error *error)
{
	size_t triangles = area->shape->triangles;

	area->until = spec_memory_new(triangles, sizeof *area->until, "triangles", error);
	if (!area->until)
		return SPEC_ENOMEM;
	for (size_t i = 0; i < triangles; i++) {
		const struct spec_vector *at = area->facets->corner + 3 * i;

		area->area += spec_vector_length(
				      spec_vector_cross(spec_vector_subtract(at[1], at[0]),
					      spec_vector_subtract(at[2], at[0]))) /
			      2;
		area->until[i] = area->area;
	}
	return SPEC_OK;
}

/* The axes of a disk's plane in world space. */
static void
disk_axes(
	const struct spec_scene_shape *shape, struct spec_vector *x, struct spec_vector *y)
{
	*x = spec_through_direction(shape->world.m, (struct spec_vector){1, 0, 0});
	*y = spec_through_direction(shape->world.m, (struct spec_vector){0, 1, 0});
}

enum spec_status
spec_area_make(struct spec_area *area, const struct spec_scene_shape *shape,
	const struct spec_facets *facets, struct spec_error *error)
{
	double scale, r = shape->radius, inner = shape->inner_radius;
	struct spec_vector x, y;

	*area = (struct spec_area){.shape = shape, .facets = facets};
	if (shape->kind == SPEC_SCENE_MESH)
		return measure_mesh(area, error);
	if (shape->kind == SPEC_SCENE_DISK) {
		disk_axes(shape, &x, &y);
		area->area = M_PI * (r * r - inner * inner) *
			     spec_vector_length(spec_vector_cross(x, y));
		return SPEC_OK;
	}
	if (!spec_area_is_similar(shape->world.m, &scale))
		return spec_error_set(error, SPEC_EUNSUPPORTED,
			"a sphere that shines cannot be stretched yet");
	area->radius = r * scale;
	area->middle = spec_through_point(shape->world.m, (struct spec_vector){0, 0, 0});
	area->area = 4 * M_PI * area->radius * area->radius;
	return SPEC_OK;
}

void
spec_area_free(struct spec_area *area)
{
	free(area->until);
	*area = (struct spec_area){0};
}

/*
 * The triangle at a share of the whole area, 0 to 1. Which half it is in is chance: a product
 * does not make the processor guess.
 */
static size_t
find_triangle(const struct spec_area *area, double share)
{
	double wanted = share * area->area;
	size_t low = 0;

	for (size_t count = area->shape->triangles, half; count > 1; count -= half) {
		half = count / 2;
		low += half * (area->until[low + half - 1] <= wanted);
	}
	return low;
}

/*
 * A point of a mesh or a disk, uniform over it, and the outward normal there. Returns how far
 * off it rays may meet it along the normal [m].
 */
static double
sample_mesh(const struct spec_area *area, const double pair[2], double number,
	struct spec_vector *point, struct spec_vector *normal)
{
	size_t triangle = find_triangle(area, number);
	const struct spec_vector *at = area->facets->corner + 3 * triangle;
	struct spec_vector b = spec_vector_subtract(at[1], at[0]);
	struct spec_vector c = spec_vector_subtract(at[2], at[0]);
	double root = sqrt(pair[0]);

	*point = spec_vector_along(
		spec_vector_along(at[0], b, root * (1 - pair[1])), c, root * pair[1]);
	*normal = area->facets->normal[triangle];
	return OFF * (spec_vector_size(*point) + spec_vector_size(b) + spec_vector_size(c));
}

static double
sample_disk(const struct spec_area *area, const double pair[2], struct spec_vector *point,
	struct spec_vector *normal)
{
	const struct spec_scene_shape *shape = area->shape;
	double inner = shape->inner_radius, outer = shape->radius,
	       angle = 2 * M_PI * pair[1];
	double r = sqrt(inner * inner + pair[0] * (outer * outer - inner * inner));

	*point = spec_through_point(shape->world.m,
		(struct spec_vector){r * cos(angle), r * sin(angle), shape->height});
	*normal = spec_through_normal(&shape->world, (struct spec_vector){0, 0, 1});
	return THIN_OFF * (spec_vector_size(*point) + outer);
}

/* 1 - cosine of the cone that a sphere fills; 2, all directions, from within and on it. */
static double
cone_of(const struct spec_area *area, struct spec_vector point, struct spec_vector *axis)
{
	double distance, sine;

	*axis = spec_vector_subtract(area->middle, point);
	distance = spec_vector_length(*axis);
	if (distance <= area->radius * (1 + ON)) {
		*axis = (struct spec_vector){0, 0, 1};
		return 2;
	}
	sine = area->radius / distance;
	*axis = spec_vector_scale(*axis, 1 / distance);
	return sine * sine / (1 + sqrt(1 - sine * sine));
}

static int
sample_sphere(const struct spec_area *area, struct spec_vector point, const double pair[2],
	struct spec_area_sample *sample)
{
	struct spec_frame frame;
	struct spec_vector axis;
	double cone = cone_of(area, point, &axis), cosine = 1 - pair[0] * cone;
	double sine = sqrt(fmax(0, 1 - cosine * cosine)), angle = 2 * M_PI * pair[1];
	double middle, half;
	struct spec_vector to = spec_vector_subtract(area->middle, point);

	if (!(cone > 0))
		return 0;
	frame = spec_frame_about(axis);
	sample->direction = spec_frame_to_world(
		&frame, (struct spec_vector){sine * cos(angle), sine * sin(angle), cosine});
	middle = spec_vector_dot(sample->direction, to);
	half = area->radius * area->radius - (spec_vector_dot(to, to) - middle * middle);
	half = sqrt(fmax(0, half));
	sample->distance = cone < 2 ? middle - half : middle + half;
	sample->density = 1 / (2 * M_PI * cone);
	sample->normal = spec_vector_subtract(
		spec_vector_along(point, sample->direction, sample->distance),
		area->middle);
	return sample->distance > ON * area->radius; /* else outwards, on it */
}

/* The surface's points by their area, seen from a point. */
static int
sample_flat(const struct spec_area *area, struct spec_vector from, const double pair[2],
	double number, struct spec_area_sample *sample)
{
	struct spec_vector point, to;
	double square, across,
		off = area->shape->kind == SPEC_SCENE_MESH
			      ? sample_mesh(area, pair, number, &point, &sample->normal)
			      : sample_disk(area, pair, &point, &sample->normal);

	to = spec_vector_subtract(point, from);
	square = spec_vector_dot(to, to);
	if (!(square > 0))
		return 0;
	/* No quotient waits for another, nor the density for the root. */
	across = fabs(spec_vector_dot(sample->normal, to));
	sample->distance = sqrt(square);
	sample->direction = spec_vector_scale(to, 1 / sample->distance);
	sample->density = square / (area->area * across) * sample->distance;
	sample->distance -= off / across * sample->distance;
	if (!(sample->distance > 0))
		sample->distance = 0;
	return sample->density < INFINITY;
}

int
spec_area_sample(const struct spec_area *area, struct spec_vector from,
	const double pair[2], double number, struct spec_area_sample *sample)
{
	int found = area->shape->kind == SPEC_SCENE_SPHERE
			    ? sample_sphere(area, from, pair, sample)
			    : sample_flat(area, from, pair, number, sample);

	if (area->shape->reverse_orientation)
		sample->normal = spec_vector_negate(sample->normal);
	return found;
}

double
spec_area_density(const struct spec_area *area, const struct spec_hit *hit,
	struct spec_vector from, struct spec_vector direction)
{
	struct spec_vector axis, to;

	if (area->shape->kind == SPEC_SCENE_SPHERE)
		return 1 / (2 * M_PI * cone_of(area, from, &axis));
	to = spec_vector_subtract(hit->point, from);
	return spec_vector_dot(to, to) /
	       (area->area * fabs(spec_vector_dot(hit->normal, direction)));
}
