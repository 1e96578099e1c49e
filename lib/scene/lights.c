/* The statements that describe lights. */
#include <float.h>
#include <stdlib.h>
#include <string.h>

#include "base/memory.h"
#include "scene/outdoors.h"
#include "scene/parsing.h"
#include "scene/paths.h"
#include "scene/spectra.h"

#define DAYLIGHT (-1) /* a sort of infinite light */

static const char absolute[] =
	"it is photometric; give the light's spectrum absolute values, and a scale";

#define EVERY_LIGHT                                                                        \
	SPEC_TAKES("scale", SPEC_FLOAT), SPEC_REFUSES("power", absolute),                  \
		SPEC_REFUSES("illuminance", absolute)

static const struct spec_expected point[] = {SPEC_TAKES("I", SPEC_ANY_SPECTRUM),
	SPEC_TAKES("from", SPEC_POINT3), EVERY_LIGHT, {0}};
static const struct spec_expected distant[] = {SPEC_TAKES("L", SPEC_ANY_SPECTRUM),
	SPEC_TAKES("from", SPEC_POINT3), SPEC_TAKES("to", SPEC_POINT3), EVERY_LIGHT, {0}};
static const struct spec_expected infinite[] = {SPEC_TAKES("L", SPEC_ANY_SPECTRUM),
	SPEC_TAKES("filename", SPEC_STRING), SPEC_REFUSES("portal", NULL), EVERY_LIGHT,
	{0}};
static const struct spec_expected daylight[] = {SPEC_TAKES("place", SPEC_STRING),
	SPEC_TAKES("time", SPEC_STRING), SPEC_TAKES("turbidity", SPEC_FLOAT),
	SPEC_TAKES("albedo", SPEC_FLOAT), SPEC_TAKES("up", SPEC_VECTOR3),
	SPEC_TAKES("north", SPEC_VECTOR3), SPEC_TAKES("sun", SPEC_BOOL), EVERY_LIGHT, {0}};
static const struct spec_expected diffuse[] = {SPEC_TAKES("L", SPEC_ANY_SPECTRUM),
	SPEC_TAKES("twosided", SPEC_BOOL), SPEC_REFUSES("filename", NULL), EVERY_LIGHT,
	{0}};

const struct spec_parsing_sort spec_parser_lights[] = {{"point", point, SPEC_SCENE_POINT},
	{"distant", distant, SPEC_SCENE_DISTANT},
	{"infinite", infinite, SPEC_SCENE_INFINITE}, {"daylight", daylight, DAYLIGHT},
	{"spot", NULL, 0}, {"goniometric", NULL, 0}, {"projection", NULL, 0}, {0}};
const struct spec_parsing_sort spec_parser_area_lights[] = {
	{"diffuse", diffuse, SPEC_SCENE_AREA}, {0}};

/* A new light, the last one of the scene, or null: SPEC_ENOMEM. */
static struct spec_scene_light *
add(struct spec_parser *parser, const struct spec_statement *statement, int kind)
{
	struct spec_scene *scene = parser->scene;
	void *list = scene->light;
	struct spec_scene_light *light;
	enum spec_status status = spec_memory_grow(&list, &scene->light_room,
		scene->lights + 1, sizeof *scene->light, "lights", parser->error);

	scene->light = list;
	if (status != SPEC_OK)
		return NULL;
	light = &scene->light[scene->lights++];
	*light = (struct spec_scene_light){.kind = (enum spec_scene_light_kind)kind,
		.scale = 1,
		.world = parser->state.transform,
		.place = statement->place};
	return light;
}

static enum spec_status
read_spectrum(const struct spec_arguments *arguments, const char *name,
	struct spec_scene_light *light)
{
	int given;
	enum spec_status status = spec_arguments_spectrum(
		arguments, name, SPEC_SCENE_LIGHT, &light->spectrum, &given);

	/* pbrt would take a white of 1 nit. */
	if (status == SPEC_OK && !given)
		status = spec_arguments_fail(arguments, NULL, SPEC_EFORMAT,
			"needs its spectrum, \"spectrum %s\"", name);
	return status;
}

/* A point of the object's space, in the world. */
static enum spec_status
read_point(const struct spec_arguments *arguments, const char *name,
	const struct spec_transform *world, double point_in_world[3])
{
	enum spec_status status =
		spec_arguments_numbers(arguments, name, 3, point_in_world);

	spec_transform_point(world, point_in_world, point_in_world);
	return status;
}

static enum spec_status
read_distant(const struct spec_arguments *arguments, struct spec_scene_light *light)
{
	enum spec_status status = read_spectrum(arguments, "L", light);

	light->to[2] = 1;
	if (status == SPEC_OK)
		status = read_point(arguments, "from", &light->world, light->from);
	if (status == SPEC_OK)
		status = read_point(arguments, "to", &light->world, light->to);
	if (status == SPEC_OK && light->from[0] == light->to[0] &&
		light->from[1] == light->to[1] && light->from[2] == light->to[2])
		status = spec_arguments_fail(arguments, NULL, SPEC_ERANGE,
			"has no direction: from and to are equal");
	return status;
}

static enum spec_status
read_infinite(const struct spec_arguments *arguments, struct spec_scene_light *light)
{
	const struct spec_parameter *file = spec_arguments_find(arguments, "filename");
	const char *name;
	enum spec_status status = spec_arguments_text(arguments, "filename", &name);

	if (status != SPEC_OK)
		return status;
	if (!file)
		return read_spectrum(arguments, "L", light);
	if (spec_arguments_find(arguments, "L"))
		return spec_arguments_fail(
			arguments, NULL, SPEC_EFORMAT, "has both L and filename");
	light->spectrum = (struct spec_scene_spectrum){
		.kind = SPEC_SCENE_CONSTANT, .value = 1, .place = file->place};
	return spec_scene_need_file(
		arguments->scene, &file->place, name, &light->picture, arguments->error);
}

static enum spec_status
read_light(const struct spec_arguments *arguments, int sort, struct spec_scene_light *light)
{
	enum spec_status status =
		spec_arguments_number(arguments, "scale", 0, DBL_MAX, &light->scale);

	if (status != SPEC_OK)
		return status;
	switch (light->kind) {
	case SPEC_SCENE_POINT:
		status = read_spectrum(arguments, "I", light);
		return status == SPEC_OK
			       ? read_point(arguments, "from", &light->world, light->from)
			       : status;
	case SPEC_SCENE_DISTANT:
		return read_distant(arguments, light);
	case SPEC_SCENE_INFINITE:
		return sort == DAYLIGHT ? spec_outdoors_daylight(arguments, light)
					: read_infinite(arguments, light);
	case SPEC_SCENE_AREA:
		status = read_spectrum(arguments, "L", light);
		return status == SPEC_OK ? spec_arguments_flag(
						   arguments, "twosided", &light->twosided)
					 : status;
	}
	return status;
}

static enum spec_status
take(struct spec_parser *parser, const struct spec_statement *statement,
	const struct spec_parsing_sort *sorts)
{
	struct spec_arguments arguments =
		spec_parser_arguments(parser, statement, SPEC_PARSING_LIGHT);
	const struct spec_parsing_sort *sort =
		spec_parser_sort(parser, statement, sorts, NULL);
	struct spec_scene_light *light;
	enum spec_status status;

	if (!sort)
		return parser->error->status;
	status = spec_arguments_check(&arguments, sort->expected);
	if (status != SPEC_OK)
		return status;
	light = add(parser, statement,
		sort->number == DAYLIGHT ? SPEC_SCENE_INFINITE : sort->number);
	return light ? read_light(&arguments, sort->number, light) : SPEC_ENOMEM;
}

enum spec_status
spec_parser_light(struct spec_parser *parser, struct spec_statement *statement)
{
	return take(parser, statement, spec_parser_lights);
}

enum spec_status
spec_parser_area_light(struct spec_parser *parser, struct spec_statement *statement)
{
	enum spec_status status = SPEC_OK;

	/* As in pbrt: shapes emit no longer. */
	if (*statement->name == '\0') {
		parser->state.light = SPEC_SCENE_NONE;
		return SPEC_OK;
	}
	status = take(parser, statement, spec_parser_area_lights);
	if (status == SPEC_OK)
		parser->state.light = parser->scene->lights - 1;
	return status;
}
