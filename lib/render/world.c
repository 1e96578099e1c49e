#include "render/world.h"

#include <embree3/rtcore.h>
#include <float.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "base/memory.h"
#include "render/through.h"

/*
 * How far from a surface a ray starts, of the size of the numbers that its place was computed
 * from: 33 ulps of single precision where that was Embree's, else 450000 of double precision.
 */
#define SKIN 2e-6
#define THIN_SKIN 1e-10
#define SHORT 1e-6 /* of a distance: as much shorter it is no further in single precision */

/* A sphere or a disk, as Embree's callbacks need it. */
struct quadric {
	const struct spec_scene_shape *shape;
	size_t number;
};

struct spec_world {
	const struct spec_scene *scene;
	RTCDevice device;
	RTCScene tree;
	struct quadric *quadric;    /* [shapes] */
	struct spec_facets *facets; /* [shapes]; empty where a shape is no mesh */
	struct spec_vector middle;
	double radius;
	char message[256]; /* of Embree's first error */
};

/* A ray on its way, with what Embree's own has no room for. */
struct journey {
	struct RTCIntersectContext context;
	struct spec_vector origin, direction;
	double distance; /* of the nearest sphere or disk so far */
};

/*
 * The nearest distance in (least, most) at which o + t d meets a sphere about 0; 0: none.
 * The middle's distance is found before the discriminant, which then loses no digits.
 */
static double
meet_sphere(double radius, struct spec_vector o, struct spec_vector d, double least,
	double most)
{
	double a = spec_vector_dot(d, d), b = -spec_vector_dot(o, d) / a;
	struct spec_vector nearest = spec_vector_along(o, d, b);
	double rest = (radius * radius - spec_vector_dot(nearest, nearest)) / a, half;

	if (!(rest >= 0))
		return 0;
	half = sqrt(rest);
	if (b - half > least && b - half < most)
		return b - half;
	return b + half > least && b + half < most ? b + half : 0;
}

static double
meet_disk(const struct spec_scene_shape *shape, struct spec_vector o, struct spec_vector d,
	double least, double most)
{
	double t = d.z != 0 ? (shape->height - o.z) / d.z : 0, x, y, square;

	if (!(t > least && t < most))
		return 0;
	x = o.x + t * d.x;
	y = o.y + t * d.y;
	square = x * x + y * y;
	return square <= shape->radius * shape->radius &&
			       square >= shape->inner_radius * shape->inner_radius
		       ? t
		       : 0;
}

static double
meet_quadric(const struct spec_scene_shape *shape, const struct journey *journey,
	double least, double most)
{
	struct spec_vector o = spec_through_point(shape->world.inverse, journey->origin);
	struct spec_vector d =
		spec_through_direction(shape->world.inverse, journey->direction);

	return shape->kind == SPEC_SCENE_SPHERE
		       ? meet_sphere(shape->radius, o, d, least, most)
		       : meet_disk(shape, o, d, least, most);
}

static void
intersect_quadric(const struct RTCIntersectFunctionNArguments *arguments)
{
	const struct quadric *quadric = arguments->geometryUserPtr;
	struct journey *journey = (struct journey *)arguments->context;
	struct RTCRayHit *rayhit = (struct RTCRayHit *)arguments->rayhit;
	double t;

	if (!arguments->valid[0])
		return;
	t = meet_quadric(quadric->shape, journey, rayhit->ray.tnear, rayhit->ray.tfar);
	if (t == 0)
		return;
	journey->distance = t;
	rayhit->ray.tfar = (float)t;
	rayhit->hit.u = rayhit->hit.v = 0;
	rayhit->hit.primID = arguments->primID;
	rayhit->hit.geomID = arguments->geomID;
	rayhit->hit.instID[0] = arguments->context->instID[0];
}

static void
occlude_quadric(const struct RTCOccludedFunctionNArguments *arguments)
{
	const struct quadric *quadric = arguments->geometryUserPtr;
	const struct journey *journey = (const struct journey *)arguments->context;
	struct RTCRay *ray = (struct RTCRay *)arguments->ray;

	if (!arguments->valid[0])
		return;
	if (meet_quadric(quadric->shape, journey, ray->tnear, ray->tfar) != 0)
		ray->tfar = -INFINITY;
}

/* Bounds in world space: the corners of the box in the object's. */
static void
bound_quadric(const struct RTCBoundsFunctionArguments *arguments)
{
	const struct quadric *quadric = arguments->geometryUserPtr;
	const struct spec_scene_shape *shape = quadric->shape;
	double r = shape->radius, low = -r, high = r, least[3], most[3];
	float *bounds = &arguments->bounds_o->lower_x;

	if (shape->kind == SPEC_SCENE_DISK)
		low = high = shape->height;
	for (int i = 0; i < 3; i++) {
		least[i] = DBL_MAX;
		most[i] = -DBL_MAX;
	}
	for (int corner = 0; corner < 8; corner++) {
		struct spec_vector p = spec_through_point(shape->world.m,
			(struct spec_vector){corner & 1 ? r : -r, corner & 2 ? r : -r,
				corner & 4 ? high : low});
		double at[3] = {p.x, p.y, p.z};

		for (int i = 0; i < 3; i++) {
			least[i] = at[i] < least[i] ? at[i] : least[i];
			most[i] = at[i] > most[i] ? at[i] : most[i];
		}
	}
	for (int i = 0; i < 3; i++) { /* lower x, y, z, one apart, upper x, y, z */
		double slack = 1e-6 * (fabs(least[i]) + fabs(most[i])) + FLT_MIN;

		bounds[i] = (float)(least[i] - slack);
		bounds[4 + i] = (float)(most[i] + slack);
	}
}

static void
note_error(void *user, enum RTCError code, const char *text)
{
	struct spec_world *world = user;

	(void)code;
	if (world->message[0] == '\0')
		snprintf(world->message, sizeof world->message, "%s", text ? text : "");
}

static enum spec_status
add_quadric(struct spec_world *world, size_t number, struct spec_error *error)
{
	RTCGeometry geometry = rtcNewGeometry(world->device, RTC_GEOMETRY_TYPE_USER);

	if (!geometry)
		return spec_error_set(error, SPEC_ENOMEM, "Embree: %s", world->message);
	world->quadric[number] = (struct quadric){&world->scene->shape[number], number};
	rtcSetGeometryUserPrimitiveCount(geometry, 1);
	rtcSetGeometryUserData(geometry, &world->quadric[number]);
	rtcSetGeometryBoundsFunction(geometry, bound_quadric, NULL);
	rtcSetGeometryIntersectFunction(geometry, intersect_quadric);
	rtcSetGeometryOccludedFunction(geometry, occlude_quadric);
	rtcCommitGeometry(geometry);
	rtcAttachGeometryByID(world->tree, geometry, (unsigned)number);
	rtcReleaseGeometry(geometry);
	return SPEC_OK;
}

static enum spec_status
add_mesh(struct spec_world *world, size_t number, struct spec_error *error)
{
	const struct spec_scene_shape *shape = &world->scene->shape[number];
	RTCGeometry geometry = rtcNewGeometry(world->device, RTC_GEOMETRY_TYPE_TRIANGLE);
	float *point = NULL;
	uint32_t *index = NULL;

	if (geometry) {
		point = rtcSetNewGeometryBuffer(geometry, RTC_BUFFER_TYPE_VERTEX, 0,
			RTC_FORMAT_FLOAT3, 3 * sizeof *point, shape->vertices);
		index = rtcSetNewGeometryBuffer(geometry, RTC_BUFFER_TYPE_INDEX, 0,
			RTC_FORMAT_UINT3, 3 * sizeof *index, shape->triangles);
	}
	if (!point || !index) {
		if (geometry)
			rtcReleaseGeometry(geometry);
		return spec_error_set(error, SPEC_ENOMEM, "Embree: %s", world->message);
	}
	for (size_t i = 0; i < shape->vertices; i++) {
		struct spec_vector p = spec_through_point(shape->world.m,
			(struct spec_vector){shape->point[3 * i], shape->point[3 * i + 1],
				shape->point[3 * i + 2]});

		point[3 * i] = (float)p.x;
		point[3 * i + 1] = (float)p.y;
		point[3 * i + 2] = (float)p.z;
	}
	memcpy(index, shape->index, 3 * shape->triangles * sizeof *index);
	rtcCommitGeometry(geometry);
	rtcAttachGeometryByID(world->tree, geometry, (unsigned)number);
	rtcReleaseGeometry(geometry);
	return spec_facets_make(&world->facets[number], shape, error);
}

static void
find_bounds(struct spec_world *world)
{
	struct RTCBounds bounds;
	struct spec_vector low, high;

	rtcGetSceneBounds(world->tree, &bounds);
	low = (struct spec_vector){bounds.lower_x, bounds.lower_y, bounds.lower_z};
	high = (struct spec_vector){bounds.upper_x, bounds.upper_y, bounds.upper_z};
	if (!(low.x <= high.x)) /* nothing is there */
		low = high = (struct spec_vector){0, 0, 0};
	world->middle = spec_vector_scale(spec_vector_add(low, high), 0.5);
	world->radius = spec_vector_length(spec_vector_subtract(high, low)) / 2;
}

enum spec_status
spec_world_open(struct spec_world **result, const struct spec_scene *scene,
	struct spec_error *error)
{
	struct spec_world *world = spec_memory_new(1, sizeof *world, "worlds", error);
	enum spec_status status = SPEC_OK;

	*result = world;
	if (!world)
		return SPEC_ENOMEM;
	world->scene = scene;
	world->quadric =
		spec_memory_new(scene->shapes, sizeof *world->quadric, "shapes", error);
	world->facets =
		spec_memory_new(scene->shapes, sizeof *world->facets, "shapes", error);
	/* One thread: building is short, and Embree's own would outlive our limits. */
	world->device = world->quadric && world->facets
				? rtcNewDevice("threads=1,set_affinity=0")
				: NULL;
	if (world->device) {
		rtcSetDeviceErrorFunction(world->device, note_error, world);
		world->tree = rtcNewScene(world->device);
	}
	if (!world->tree)
		status = spec_error_set(error, SPEC_ENOMEM, "Embree does not start");
	if (status == SPEC_OK)
		rtcSetSceneFlags(world->tree, RTC_SCENE_FLAG_ROBUST);
	for (size_t i = 0; i < scene->shapes && status == SPEC_OK; i++) {
		const struct spec_scene_shape *shape = &scene->shape[i];

		/* What neither shines nor bends light is not there. */
		if (shape->light == SPEC_SCENE_NONE &&
			scene->material[shape->material].kind == SPEC_SCENE_INTERFACE)
			continue;
		status = shape->kind == SPEC_SCENE_MESH ? add_mesh(world, i, error)
							: add_quadric(world, i, error);
	}
	if (status == SPEC_OK) {
		rtcCommitScene(world->tree);
		if (world->message[0])
			status = spec_error_set(
				error, SPEC_ENOMEM, "Embree: %s", world->message);
	}
	if (status == SPEC_OK)
		find_bounds(world);
	else
		spec_world_close(world);
	if (status != SPEC_OK)
		*result = NULL;
	return status;
}

void
spec_world_close(struct spec_world *world)
{
	if (!world)
		return;
	if (world->tree)
		rtcReleaseScene(world->tree);
	if (world->device)
		rtcReleaseDevice(world->device);
	for (size_t i = 0; world->facets && i < world->scene->shapes; i++) {
		spec_facets_free(&world->facets[i]);
	}
	free(world->facets);
	free(world->quadric);
	free(world);
}

const struct spec_facets *
spec_world_facets(const struct spec_world *world, size_t shape)
{
	return &world->facets[shape];
}

void
spec_world_bounds(
	const struct spec_world *world, struct spec_vector *middle, double *radius)
{
	*middle = world->middle;
	*radius = world->radius;
}

static void
set_out(struct journey *journey, const struct spec_ray *ray)
{
	rtcInitIntersectContext(&journey->context);
	journey->origin = ray->origin;
	journey->direction = ray->direction;
}

static struct RTCRay
embree_ray(const struct spec_ray *ray, double distance)
{
	return (struct RTCRay){.org_x = (float)ray->origin.x,
		.org_y = (float)ray->origin.y,
		.org_z = (float)ray->origin.z,
		.dir_x = (float)ray->direction.x,
		.dir_y = (float)ray->direction.y,
		.dir_z = (float)ray->direction.z,
		.tfar = (float)distance,
		.mask = (unsigned)-1};
}

static void
find_on_quadric(const struct spec_scene_shape *shape, const struct spec_ray *ray,
	struct spec_hit *hit)
{
	struct spec_vector at =
		spec_vector_along(ray->origin, ray->direction, hit->distance);
	struct spec_vector local = spec_through_point(shape->world.inverse, at);
	struct spec_vector normal = {0, 0, 1};

	if (shape->kind == SPEC_SCENE_SPHERE)
		local = normal = spec_vector_scale(spec_vector_unit(local), shape->radius);
	else
		local.z = shape->height;
	hit->point = spec_through_point(shape->world.m, local);
	hit->normal = hit->shading = spec_through_normal(&shape->world, normal);
	hit->size = spec_vector_size(hit->point) + fabs(shape->world.m[0][3]) +
		    fabs(shape->world.m[1][3]) + fabs(shape->world.m[2][3]);
}

/* a (1 - u - v) + b u + c v */
static struct spec_vector
blend(const float *list, const uint32_t *corner, const double weight[2])
{
	return spec_vector_along(
		spec_vector_along(spec_vector_scale(spec_facets_vertex(list, corner[0]),
					  1 - weight[0] - weight[1]),
			spec_facets_vertex(list, corner[1]), weight[0]),
		spec_facets_vertex(list, corner[2]), weight[1]);
}

static void
find_on_mesh(const struct spec_scene_shape *shape, const struct spec_facets *facets,
	const struct RTCHit *found, struct spec_hit *hit)
{
	const struct spec_vector *at = facets->corner + 3 * (size_t)found->primID;
	double u = found->u, v = found->v;

	hit->triangle = found->primID;
	hit->weight[0] = u;
	hit->weight[1] = v;
	hit->point = spec_vector_along(
		spec_vector_along(spec_vector_scale(at[0], 1 - u - v), at[1], u), at[2], v);
	hit->size = spec_vector_size(hit->point) +
		    spec_vector_size(spec_vector_subtract(at[1], at[0])) +
		    spec_vector_size(spec_vector_subtract(at[2], at[0]));
	hit->normal = hit->shading = facets->normal[found->primID];
	if (shape->normal)
		hit->shading = spec_through_normal(&shape->world,
			blend(shape->normal, shape->index + 3 * hit->triangle,
				hit->weight));
}

/* A shading normal that looks away where the surface does not is bent till it grazes. */
static void
straighten(struct spec_hit *hit, struct spec_vector direction)
{
	double side = spec_vector_dot(direction, hit->normal);
	double seen = spec_vector_dot(direction, hit->shading);

	if (side * seen >= 0)
		return;
	/* A little further than to the right angle, against rounding. */
	hit->shading = spec_vector_unit(
		spec_vector_along(hit->shading, direction, copysign(1e-6, side) - seen));
}

int
spec_world_meet(
	const struct spec_world *world, const struct spec_ray *ray, struct spec_hit *hit)
{
	struct RTCRayHit rayhit = {.ray = embree_ray(ray, INFINITY)};
	struct journey journey;
	const struct spec_scene_shape *shape;

	set_out(&journey, ray);
	rayhit.hit.geomID = RTC_INVALID_GEOMETRY_ID;
	rtcIntersect1(world->tree, &journey.context, &rayhit);
	if (rayhit.hit.geomID == RTC_INVALID_GEOMETRY_ID)
		return 0;
	hit->shape = rayhit.hit.geomID;
	shape = &world->scene->shape[hit->shape];
	hit->distance =
		shape->kind == SPEC_SCENE_MESH ? (double)rayhit.ray.tfar : journey.distance;
	if (shape->kind == SPEC_SCENE_MESH)
		find_on_mesh(shape, &world->facets[hit->shape], &rayhit.hit, hit);
	else
		find_on_quadric(shape, ray, hit);
	if (shape->reverse_orientation) {
		hit->normal = spec_vector_negate(hit->normal);
		hit->shading = spec_vector_negate(hit->shading);
	}
	if (shape->normal)
		straighten(hit, ray->direction);
	return 1;
}

/*
 * Coordinates as pbrt has them. Of a sphere: u around z from x, v from the pole at -z; of a
 * disk: v from the rim inwards.
 */
static void
describe_quadric(const struct spec_scene_shape *shape, struct spec_hit *hit)
{
	struct spec_vector p = spec_through_point(shape->world.inverse, hit->point);
	double r = shape->radius, azimuth = atan2(p.y, p.x), distance = hypot(p.x, p.y);
	struct spec_vector tangent = {-p.y, p.x, 0};

	if (distance == 0)
		tangent = (struct spec_vector){1, 0, 0};
	hit->tangent = spec_vector_unit(spec_through_direction(shape->world.m, tangent));
	hit->u = (azimuth < 0 ? azimuth + 2 * M_PI : azimuth) / (2 * M_PI);
	hit->object = (struct spec_vector){(p.x / r + 1) / 2, (p.y / r + 1) / 2, 0};
	if (shape->kind == SPEC_SCENE_SPHERE) {
		hit->v = 1 - acos(fmin(fmax(p.z / r, -1), 1)) / M_PI;
		hit->object.z = (p.z / r + 1) / 2;
	} else {
		hit->v = r > shape->inner_radius
				 ? (r - distance) / (r - shape->inner_radius)
				 : 0;
	}
}

/* dp/du from the vertices' uv, or any direction in the plane where they have none. */
static struct spec_vector
mesh_tangent(const struct spec_scene_shape *shape, const uint32_t *corner,
	struct spec_vector normal)
{
	struct spec_vector a = spec_facets_vertex(shape->point, corner[0]);
	struct spec_vector b =
		spec_vector_subtract(spec_facets_vertex(shape->point, corner[1]), a);
	struct spec_vector c =
		spec_vector_subtract(spec_facets_vertex(shape->point, corner[2]), a);
	const float *uv = shape->uv;
	double du1, du2, dv1, dv2, area;
	struct spec_vector tangent;

	du1 = uv[2 * corner[1]] - uv[2 * corner[0]];
	du2 = uv[2 * corner[2]] - uv[2 * corner[0]];
	dv1 = uv[2 * corner[1] + 1] - uv[2 * corner[0] + 1];
	dv2 = uv[2 * corner[2] + 1] - uv[2 * corner[0] + 1];
	area = du1 * dv2 - dv1 * du2;
	if (area == 0)
		return spec_frame_about(normal).x;
	tangent = spec_vector_along(spec_vector_scale(b, dv2 / area), c, -dv1 / area);
	return spec_vector_unit(spec_through_direction(shape->world.m, tangent));
}

static double
share_of(double at, double low, double size)
{
	return size > 0 ? fmin(fmax((at - low) / size, 0), 1) : 0;
}

static struct spec_vector
place_in_box(const struct spec_facets *facets, struct spec_vector p)
{
	return (struct spec_vector){share_of(p.x, facets->low.x, facets->size.x),
		share_of(p.y, facets->low.y, facets->size.y),
		share_of(p.z, facets->low.z, facets->size.z)};
}

static void
describe_mesh(const struct spec_scene_shape *shape, const struct spec_facets *facets,
	struct spec_hit *hit)
{
	const uint32_t *corner = shape->index + 3 * hit->triangle;
	const struct spec_vector *at = facets->corner + 3 * hit->triangle;
	double u = hit->weight[0], v = hit->weight[1];

	hit->object = place_in_box(facets, blend(shape->point, corner, hit->weight));
	/* Without uv pbrt takes (0,0), (1,0), (1,1). */
	hit->u = u + v;
	hit->v = v;
	hit->tangent = shape->uv
			       ? mesh_tangent(shape, corner, facets->normal[hit->triangle])
			       : spec_vector_unit(spec_vector_subtract(at[1], at[0]));
	if (shape->uv) {
		hit->u = (1 - u - v) * shape->uv[2 * corner[0]] +
			 u * shape->uv[2 * corner[1]] + v * shape->uv[2 * corner[2]];
		hit->v = (1 - u - v) * shape->uv[2 * corner[0] + 1] +
			 u * shape->uv[2 * corner[1] + 1] +
			 v * shape->uv[2 * corner[2] + 1];
	}
}

void
spec_world_describe(const struct spec_world *world, struct spec_hit *hit)
{
	const struct spec_scene_shape *shape = &world->scene->shape[hit->shape];

	if (shape->kind == SPEC_SCENE_MESH)
		describe_mesh(shape, &world->facets[hit->shape], hit);
	else
		describe_quadric(shape, hit);
}

int
spec_world_blocks(
	const struct spec_world *world, const struct spec_ray *ray, double distance)
{
	struct RTCRay embree = embree_ray(ray, distance);
	struct journey journey;

	set_out(&journey, ray);
	rtcOccluded1(world->tree, &journey.context, &embree);
	return embree.tfar < 0;
}

struct spec_ray
spec_world_leave(const struct spec_world *world, const struct spec_hit *hit,
	struct spec_vector direction)
{
	int is_mesh = world->scene->shape[hit->shape].kind == SPEC_SCENE_MESH;
	double skin = (is_mesh ? SKIN : THIN_SKIN) * hit->size;

	if (spec_vector_dot(direction, hit->normal) < 0)
		skin = -skin;
	return (struct spec_ray){
		spec_vector_along(hit->point, hit->normal, skin), direction};
}

int
spec_world_shades(const struct spec_world *world, const struct spec_hit *hit,
	struct spec_vector direction, double distance)
{
	struct spec_ray ray = spec_world_leave(world, hit, direction);
	struct spec_vector to;

	if (distance == INFINITY || !(distance > 0))
		return distance > 0 && spec_world_blocks(world, &ray, distance);
	to = spec_vector_subtract(
		spec_vector_along(hit->point, direction, distance), ray.origin);
	/* Of about length 1, which none of the shapes needs exactly: that saves a root. */
	ray.direction = spec_vector_scale(to, 1 / distance);
	return spec_world_blocks(world, &ray, distance * (1 - SHORT));
}
