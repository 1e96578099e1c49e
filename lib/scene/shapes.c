/* The statement Shape. */
#include <float.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "base/memory.h"
#include "scene/parsing.h"
#include "scene/paths.h"
#include "scene/ply.h"

enum sort { SPHERE, DISK, TRIANGLES, PLY };

static const struct spec_expected sphere[] = {SPEC_TAKES("radius", SPEC_FLOAT),
	SPEC_TAKES("zmin", SPEC_FLOAT), SPEC_TAKES("zmax", SPEC_FLOAT),
	SPEC_TAKES("phimax", SPEC_FLOAT), SPEC_REFUSES("alpha", NULL), {0}};
static const struct spec_expected disk[] = {SPEC_TAKES("radius", SPEC_FLOAT),
	SPEC_TAKES("innerradius", SPEC_FLOAT), SPEC_TAKES("height", SPEC_FLOAT),
	SPEC_TAKES("phimax", SPEC_FLOAT), SPEC_REFUSES("alpha", NULL), {0}};
static const struct spec_expected trianglemesh[] = {SPEC_TAKES("P", SPEC_POINT3),
	SPEC_TAKES("indices", SPEC_INTEGER), SPEC_TAKES("N", SPEC_NORMAL),
	SPEC_TAKES("uv", SPEC_POINT2), SPEC_REFUSES("S", NULL), SPEC_IGNORES("faceIndices"),
	SPEC_REFUSES("alpha", NULL), {0}};
static const struct spec_expected plymesh[] = {SPEC_TAKES("filename", SPEC_STRING),
	SPEC_REFUSES("displacement", NULL), SPEC_IGNORES("edgelength"),
	SPEC_REFUSES("alpha", NULL), {0}};

const struct spec_parsing_sort spec_parser_shapes[] = {{"sphere", sphere, SPHERE},
	{"disk", disk, DISK}, {"trianglemesh", trianglemesh, TRIANGLES},
	{"plymesh", plymesh, PLY}, {"bilinearmesh", NULL, 0}, {"curve", NULL, 0},
	{"cylinder", NULL, 0}, {"loopsubdiv", NULL, 0}, {0}};

/* Parts of spheres and disks are not supported; most: the value that leaves it whole. */
static enum spec_status
check_whole(const struct spec_arguments *arguments, const char *name, double whole)
{
	double value = whole;
	enum spec_status status = spec_arguments_numbers(arguments, name, 1, &value);

	if (status == SPEC_OK && (whole < 0 ? value > whole : value < whole))
		status = spec_arguments_fail(arguments,
			spec_arguments_find(arguments, name), SPEC_EUNSUPPORTED,
			"is %g, but parts of it are not supported: it must be whole",
			value);
	return status;
}

static enum spec_status
read_sphere(const struct spec_arguments *arguments, struct spec_scene_shape *shape)
{
	enum spec_status status =
		spec_arguments_positive(arguments, "radius", &shape->radius);

	if (status == SPEC_OK)
		status = check_whole(arguments, "zmin", -shape->radius);
	if (status == SPEC_OK)
		status = check_whole(arguments, "zmax", shape->radius);
	if (status == SPEC_OK)
		status = check_whole(arguments, "phimax", 360);
	return status;
}

static enum spec_status
read_disk(const struct spec_arguments *arguments, struct spec_scene_shape *shape)
{
	enum spec_status status =
		spec_arguments_positive(arguments, "radius", &shape->radius);

	if (status == SPEC_OK)
		status = spec_arguments_number(
			arguments, "innerradius", 0, shape->radius, &shape->inner_radius);
	if (status == SPEC_OK && shape->inner_radius == shape->radius)
		status = spec_arguments_fail(
			arguments, NULL, SPEC_ERANGE, "has no area: its radii are equal");
	if (status == SPEC_OK)
		status = spec_arguments_number(
			arguments, "height", -DBL_MAX, DBL_MAX, &shape->height);
	if (status == SPEC_OK)
		status = check_whole(arguments, "phimax", 360);
	return status;
}

/* ---- meshes ---- */

/* Numbers of a mesh as float, so many for each vertex; there is no such parameter: null. */
static enum spec_status
read_floats(const struct spec_arguments *arguments, const char *name, size_t wanted,
	float **list)
{
	const struct spec_parameter *parameter = spec_arguments_find(arguments, name);

	if (!parameter)
		return SPEC_OK;
	if (parameter->count != wanted)
		return spec_arguments_fail(arguments, parameter, SPEC_EFORMAT,
			"has %zu numbers, but %zu are needed for the vertices",
			parameter->count, wanted);
	*list = spec_memory_new(wanted, sizeof **list, "numbers", arguments->error);
	if (!*list)
		return SPEC_ENOMEM;
	for (size_t i = 0; i < wanted; i++) {
		if (fabs(parameter->number[i]) > FLT_MAX)
			return spec_arguments_fail(arguments, parameter, SPEC_ERANGE,
				"has a number that is too large: %g", parameter->number[i]);
		(*list)[i] = (float)parameter->number[i];
	}
	return SPEC_OK;
}

static enum spec_status
read_indices(const struct spec_arguments *arguments, struct spec_scene_shape *shape)
{
	const struct spec_parameter *indices = spec_arguments_find(arguments, "indices");
	size_t count = indices ? indices->count : 3;

	if (!indices && shape->vertices != 3)
		return spec_arguments_fail(arguments, NULL, SPEC_EFORMAT,
			"needs indices, for it has not 3 vertices but %zu",
			shape->vertices);
	if (count % 3 != 0)
		return spec_arguments_fail(arguments, indices, SPEC_EFORMAT,
			"has %zu numbers, which is no multiple of 3", count);
	shape->triangles = count / 3;
	shape->index =
		spec_memory_new(count, sizeof *shape->index, "indices", arguments->error);
	if (!shape->index)
		return SPEC_ENOMEM;
	for (size_t i = 0; i < count; i++) {
		double index = indices ? indices->number[i] : (double)i;

		if (!(index >= 0 && index < (double)shape->vertices))
			return spec_arguments_fail(arguments, indices, SPEC_ERANGE,
				"has a vertex %.0f, and the last one is %zu", index,
				shape->vertices - 1);
		shape->index[i] = (uint32_t)index;
	}
	return SPEC_OK;
}

static enum spec_status
read_triangles(const struct spec_arguments *arguments, struct spec_scene_shape *shape)
{
	const struct spec_parameter *points = spec_arguments_find(arguments, "P");
	enum spec_status status;

	if (!points)
		return spec_arguments_fail(
			arguments, NULL, SPEC_EFORMAT, "needs its vertices, \"point3 P\"");
	if (points->count % 3 != 0)
		return spec_arguments_fail(arguments, points, SPEC_EFORMAT,
			"has %zu numbers, which is no multiple of 3", points->count);
	shape->vertices = points->count / 3;
	status = read_floats(arguments, "P", 3 * shape->vertices, &shape->point);
	if (status == SPEC_OK)
		status = read_floats(arguments, "N", 3 * shape->vertices, &shape->normal);
	if (status == SPEC_OK)
		status = read_floats(arguments, "uv", 2 * shape->vertices, &shape->uv);
	return status == SPEC_OK ? read_indices(arguments, shape) : status;
}

static enum spec_status
read_ply(const struct spec_arguments *arguments, struct spec_scene_shape *shape)
{
	const struct spec_parameter *file = spec_arguments_find(arguments, "filename");
	struct spec_ply mesh;
	const char *name;
	char *path = NULL;
	enum spec_status status = spec_arguments_text(arguments, "filename", &name);

	if (status != SPEC_OK)
		return status;
	if (!name)
		return spec_arguments_fail(
			arguments, NULL, SPEC_EFORMAT, "needs a \"string filename\"");
	status = spec_scene_need_file(
		arguments->scene, &file->place, name, &path, arguments->error);
	if (status != SPEC_OK)
		return status;
	status = spec_ply_load(path, &mesh, arguments->error);
	if (status != SPEC_OK)
		spec_scene_prefix(arguments->scene, &file->place, arguments->error);
	free(path);
	shape->vertices = mesh.vertices;
	shape->triangles = mesh.triangles;
	shape->point = mesh.point;
	shape->normal = mesh.normal;
	shape->uv = mesh.uv;
	shape->index = mesh.index;
	return status;
}

/* ---- all of them ---- */

/* A new shape, the last one of the scene, or null: SPEC_ENOMEM. */
static struct spec_scene_shape *
add(struct spec_parser *parser, const struct spec_statement *statement)
{
	struct spec_scene *scene = parser->scene;
	void *list = scene->shape;
	size_t material = parser->state.material;
	struct spec_scene_shape *shape;
	enum spec_status status = spec_memory_grow(&list, &scene->shape_room,
		scene->shapes + 1, sizeof *scene->shape, "shapes", parser->error);

	scene->shape = list;
	if (status == SPEC_OK && material == SPEC_SCENE_NONE)
		status = spec_parser_plain_material(parser, &statement->place, &material);
	if (status != SPEC_OK)
		return NULL;
	shape = &scene->shape[scene->shapes++];
	*shape = (struct spec_scene_shape){.world = parser->state.transform,
		.reverse_orientation = parser->state.reverse_orientation,
		.radius = 1,
		.material = material,
		.light = parser->state.light,
		.place = statement->place};
	return shape;
}

enum spec_status
spec_parser_shape(struct spec_parser *parser, struct spec_statement *statement)
{
	struct spec_arguments arguments =
		spec_parser_arguments(parser, statement, SPEC_PARSING_SHAPE);
	const struct spec_parsing_sort *sort =
		spec_parser_sort(parser, statement, spec_parser_shapes, NULL);
	struct spec_scene_shape *shape;
	enum spec_status status;

	if (!sort)
		return parser->error->status;
	status = spec_arguments_check(&arguments, sort->expected);
	if (status != SPEC_OK)
		return status;
	shape = add(parser, statement);
	if (!shape)
		return SPEC_ENOMEM;
	switch ((enum sort)sort->number) {
	case SPHERE:
		shape->kind = SPEC_SCENE_SPHERE;
		return read_sphere(&arguments, shape);
	case DISK:
		shape->kind = SPEC_SCENE_DISK;
		return read_disk(&arguments, shape);
	case TRIANGLES:
		shape->kind = SPEC_SCENE_MESH;
		return read_triangles(&arguments, shape);
	case PLY:
		shape->kind = SPEC_SCENE_MESH;
		return read_ply(&arguments, shape);
	}
	return SPEC_OK;
}
