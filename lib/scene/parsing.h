/* Inside the parser alone: what its parts share. */
#ifndef SPEC_SCENE_PARSING_H
#define SPEC_SCENE_PARSING_H

#include <stddef.h>

#include "base/error.h"
#include "scene/parameters.h"
#include "scene/scene.h"
#include "scene/tokens.h"
#include "scene/transform.h"

#define SPEC_PARSING_DEEPEST 4096 /* AttributeBegin in AttributeBegin */

/* A film's, where nothing is said. */
#define SPEC_PARSING_WIDTH 1280
#define SPEC_PARSING_HEIGHT 720

/* What an Attribute statement can give parameters to. */
enum spec_parsing_target { SPEC_PARSING_SHAPE, SPEC_PARSING_LIGHT, SPEC_PARSING_MATERIAL };
#define SPEC_PARSING_TARGETS 3

/* What AttributeBegin saves and AttributeEnd brings back. */
struct spec_parsing_state {
	struct spec_transform transform;
	int reverse_orientation;
	size_t material; /* its number; SPEC_SCENE_NONE: the default */
	size_t light;    /* the area light's, or SPEC_SCENE_NONE */
	size_t inherited[SPEC_PARSING_TARGETS]; /* how many parameters */
};

struct spec_parsing_frame {
	struct spec_parsing_state state;
	struct spec_scene_place place; /* of what began it */
	int imported;                  /* that is an Import */
};

struct spec_parsing_name {
	char *name;
	size_t material;                 /* of materials */
	struct spec_transform transform; /* of coordinate systems */
};

struct spec_parsing_names {
	size_t count, room;
	struct spec_parsing_name *list;
};

struct spec_parser {
	struct spec_scene *scene;
	struct spec_error *error;
	struct spec_tokens tokens;
	int in_world; /* behind WorldBegin */
	int has_seed; /* the sampler's, which comes before the option's */
	size_t plain; /* the default material, or SPEC_SCENE_NONE */
	struct spec_parsing_state state;
	struct spec_parsing_frame *frame;
	size_t frames, frame_room;
	struct spec_parameters inherited[SPEC_PARSING_TARGETS];
	struct spec_parsing_names materials, systems;
};

/* One that has been read and is to be carried out. */
struct spec_statement {
	const char *keyword;
	struct spec_scene_place place;
	char *name; /* the string behind the keyword, or null */
	struct spec_scene_place name_place;
	struct spec_parameters parameters; /* whoever empties it has them */
	double number[16];
};

/* An error at a statement. Returns the status. */
enum spec_status spec_parser_fail(const struct spec_parser *parser,
	const struct spec_statement *statement, enum spec_status status, const char *format,
	...) __attribute__((format(printf, 4, 5)));

/* The statement's parameters; target: whose inherited ones count too, or -1. */
struct spec_arguments spec_parser_arguments(
	struct spec_parser *parser, const struct spec_statement *statement, int target);

/*
 * Sorts of things, as in Shape "sphere". In the last row of a table name is null, in others
 * expected is null where we lack what pbrt has.
 */
struct spec_parsing_sort {
	const char *name;
	const struct spec_expected *expected;
	int number;
};

/*
 * The row of the statement's sort, or null with the error set: SPEC_EUNSUPPORTED, or
 * SPEC_EFORMAT: pbrt does not know it either. name: a material's, where it is not the
 * string behind the keyword; else null.
 */
const struct spec_parsing_sort *spec_parser_sort(const struct spec_parser *parser,
	const struct spec_statement *statement, const struct spec_parsing_sort *sorts,
	const char *name);

/* The entry of that name, or null. */
struct spec_parsing_name *spec_parser_find(
	const struct spec_parsing_names *names, const char *name);

/* The entry of that name, made if there is none, or null: SPEC_ENOMEM. */
struct spec_parsing_name *spec_parser_add(
	struct spec_parsing_names *names, const char *name, struct spec_error *error);

/* The default material's number, which is made when it is first needed. */
enum spec_status spec_parser_plain_material(
	struct spec_parser *parser, const struct spec_scene_place *place, size_t *material);

/* What there is of the targets, for Attribute. */
extern const struct spec_parsing_sort spec_parser_shapes[], spec_parser_lights[],
	spec_parser_area_lights[], spec_parser_materials[];

/* The statements. */
typedef enum spec_status spec_parser_statement(
	struct spec_parser *parser, struct spec_statement *statement);

spec_parser_statement spec_parser_camera, spec_parser_film, spec_parser_sampler,
	spec_parser_integrator, spec_parser_filter, spec_parser_option,
	spec_parser_colour_space;
spec_parser_statement spec_parser_material, spec_parser_make_named_material,
	spec_parser_named_material;
spec_parser_statement spec_parser_light, spec_parser_area_light;
spec_parser_statement spec_parser_shape;

#endif
