#include "scene/outdoors.h"

#include <math.h>
#include <stdlib.h>

#include "base/memory.h"
#include "base/triple.h"
#include "place/coordinates.h"
#include "place/instant.h"
#include "place/sunlight.h"
#include "scene/transform.h"

#define RADIANS (M_PI / 180)
#define NEAREST_M 1e-3  /* places no farther apart have no bearing */
#define SMALLEST 1e-6   /* the sine between two directions that are told apart */
#define STEEPEST_DEG 89 /* what looks straight up has no bearing */

/* ---- places and times ---- */

/* What a reader of texts said, as an error of the parameter. */
static enum spec_status
blame(const struct spec_arguments *arguments, const char *name, enum spec_status status,
	const struct spec_error *cause)
{
	return spec_arguments_fail(arguments, spec_arguments_find(arguments, name), status,
		"is refused: %s", cause->message);
}

static enum spec_status
need_text(const struct spec_arguments *arguments, const char *name, const char **text)
{
	enum spec_status status = spec_arguments_text(arguments, name, text);

	if (status == SPEC_OK && !*text)
		status = spec_arguments_fail(
			arguments, NULL, SPEC_EFORMAT, "needs \"string %s\"", name);
	return status;
}

static enum spec_status
read_place(
	const struct spec_arguments *arguments, const char *name, struct spec_place *place)
{
	struct spec_error cause = {0};
	const char *text = NULL;
	enum spec_status status = need_text(arguments, name, &text);

	if (status != SPEC_OK)
		return status;
	status = spec_place_parse(text, place, &cause);
	return status == SPEC_OK ? status : blame(arguments, name, status, &cause);
}

static enum spec_status
read_time(const struct spec_arguments *arguments, struct spec_instant *instant)
{
	struct spec_error cause = {0};
	const char *text = NULL;
	enum spec_status status = need_text(arguments, "time", &text);

	if (status != SPEC_OK)
		return status;
	status = spec_instant_parse(text, instant, &cause);
	return status == SPEC_OK ? status : blame(arguments, "time", status, &cause);
}

static enum spec_status
find_sun(const struct spec_arguments *arguments, struct spec_scene_daylight *daylight)
{
	struct spec_error cause = {0};
	enum spec_status status =
		spec_sunlight_sun(&daylight->sunlight, &daylight->sun, &cause);

	return status == SPEC_OK ? status : blame(arguments, "time", status, &cause);
}

/* ---- axes ---- */

/* A direction of a space as a unit vector in the world. */
static enum spec_status
read_direction(const struct spec_arguments *arguments, const char *name,
	const struct spec_transform *world, double v[3])
{
	double local[3] = {v[0], v[1], v[2]};
	enum spec_status status = spec_arguments_numbers(arguments, name, 3, local);

	for (int i = 0; i < 3; i++)
		v[i] = spec_triple_dot(world->m[i], local);
	if (status == SPEC_OK && !spec_triple_normalise(v))
		status =
			spec_arguments_fail(arguments, spec_arguments_find(arguments, name),
				SPEC_ERANGE, "is no direction: it has no length");
	return status;
}

static int
is_mirrored(const struct spec_transform *transform)
{
	double x_by_y[3];

	spec_triple_cross(transform->m[0], transform->m[1], x_by_y);
	return spec_triple_dot(x_by_y, transform->m[2]) < 0;
}

static enum spec_status
read_axes(const struct spec_arguments *arguments, const struct spec_transform *world,
	struct spec_scene_daylight *daylight)
{
	double *up = daylight->up, *north = daylight->north, *east = daylight->east;
	enum spec_status status;
	double length;

	up[1] = north[2] = 1;
	status = read_direction(arguments, "up", world, up);
	if (status == SPEC_OK)
		status = read_direction(arguments, "north", world, north);
	if (status != SPEC_OK)
		return status;
	spec_triple_cross(up, north, east);
	length = sqrt(spec_triple_dot(east, east));
	if (!(length > SMALLEST))
		return spec_arguments_fail(
			arguments, NULL, SPEC_ERANGE, "has up and north in one line");
	if (is_mirrored(&arguments->scene->camera))
		length = -length;
	for (int i = 0; i < 3; i++)
		east[i] /= length;
	spec_triple_cross(east, up, north);
	for (int i = 0; i < 3 && length < 0; i++)
		north[i] = -north[i];
	return SPEC_OK;
}

/* ---- daylight ---- */

static enum spec_status
read_atmosphere(const struct spec_arguments *arguments, const struct spec_place *place,
	struct spec_atmosphere *atmosphere)
{
	struct spec_error cause = {0};
	double turbidity;
	enum spec_status status;

	*atmosphere = spec_atmosphere_at(place->altitude_m);
	turbidity = atmosphere->turbidity;
	status = spec_arguments_number(arguments, "turbidity",
		spec_atmosphere_lowest.turbidity, spec_atmosphere_highest.turbidity,
		&turbidity);
	if (status == SPEC_OK)
		status = spec_arguments_number(arguments, "albedo",
			spec_atmosphere_lowest.ground_albedo,
			spec_atmosphere_highest.ground_albedo, &atmosphere->ground_albedo);
	if (status != SPEC_OK)
		return status;
	status = spec_atmosphere_set_turbidity(atmosphere, turbidity, &cause);
	return status == SPEC_OK ? status : blame(arguments, "turbidity", status, &cause);
}

static enum spec_status
read_daylight(const struct spec_arguments *arguments, const struct spec_transform *world,
	struct spec_scene_daylight *daylight)
{
	struct spec_sunlight *sunlight = &daylight->sunlight;
	enum spec_status status = read_place(arguments, "place", &sunlight->place);

	if (status == SPEC_OK)
		status = read_time(arguments, &sunlight->instant);
	if (status == SPEC_OK)
		status =
			read_atmosphere(arguments, &sunlight->place, &sunlight->atmosphere);
	if (status == SPEC_OK)
		status = find_sun(arguments, daylight);
	if (status == SPEC_OK)
		status = spec_arguments_flag(arguments, "sun", &daylight->has_sun);
	return status == SPEC_OK ? read_axes(arguments, world, daylight) : status;
}

enum spec_status
spec_outdoors_daylight(
	const struct spec_arguments *arguments, struct spec_scene_light *light)
{
	struct spec_scene_daylight *daylight =
		spec_memory_new(1, sizeof *daylight, "daylight", arguments->error);

	if (!daylight)
		return SPEC_ENOMEM;
	daylight->has_sun = 1;
	light->daylight = daylight;
	light->spectrum = (struct spec_scene_spectrum){
		.kind = SPEC_SCENE_CONSTANT, .value = 1, .place = light->place};
	return read_daylight(arguments, &light->world, daylight);
}

/* ---- cameras ---- */

enum spec_status
spec_outdoors_face(const struct spec_arguments *arguments, struct spec_transform *camera)
{
	static const double eye[3] = {0, 0, 0}, up[3] = {0, 1, 0};
	struct spec_transform view = spec_transform_identity();
	struct spec_place from, to;
	struct spec_geodesic way;
	struct spec_error cause = {0};
	double elevation = 0, look[3], column[16];
	enum spec_status status;

	if (!spec_arguments_find(arguments, "place") &&
		!spec_arguments_find(arguments, "toward") &&
		!spec_arguments_find(arguments, "elevation"))
		return SPEC_OK;
	status = read_place(arguments, "place", &from);
	if (status == SPEC_OK)
		status = read_place(arguments, "toward", &to);
	if (status == SPEC_OK)
		status = spec_arguments_number(
			arguments, "elevation", -STEEPEST_DEG, STEEPEST_DEG, &elevation);
	if (status != SPEC_OK)
		return status;
	status = spec_place_geodesic(&from, &to, &way, &cause);
	if (status != SPEC_OK)
		return blame(arguments, "toward", status, &cause);
	if (!(way.distance_m > NEAREST_M))
		return spec_arguments_fail(arguments,
			spec_arguments_find(arguments, "toward"), SPEC_ERANGE,
			"is where the camera is");
	look[0] = cos(elevation * RADIANS) * sin(way.bearing_deg * RADIANS);
	look[1] = sin(elevation * RADIANS);
	look[2] = cos(elevation * RADIANS) * cos(way.bearing_deg * RADIANS);
	status = spec_transform_look_at(&view, eye, look, up, &cause);
	for (int i = 0; i < 16; i++)
		column[i] = camera->m[i % 4][i / 4];
	if (status == SPEC_OK)
		status = spec_transform_concat(&view, column, &cause);
	if (status != SPEC_OK)
		return blame(arguments, "toward", status, &cause);
	*camera = view;
	arguments->scene->has_place = 1;
	arguments->scene->place = from;
	return SPEC_OK;
}
