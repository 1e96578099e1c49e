#include "scene/parse.h"

#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "base/memory.h"
#include "base/nearest.h"
#include "scene/parsing.h"

/* ---- what the parts share ---- */

enum spec_status
spec_parser_fail(const struct spec_parser *parser, const struct spec_statement *statement,
	enum spec_status status, const char *format, ...)
{
	va_list arguments;

	va_start(arguments, format);
	spec_error_vset(parser->error, status, format, arguments);
	va_end(arguments);
	spec_scene_prefix(parser->scene, &statement->place, parser->error);
	return status;
}

/* Puts a place before an error without one, such as a transform's. */
static enum spec_status
placed(const struct spec_parser *parser, const struct spec_scene_place *place,
	enum spec_status status)
{
	if (status != SPEC_OK)
		spec_scene_prefix(parser->scene, place, parser->error);
	return status;
}

struct spec_arguments
spec_parser_arguments(
	struct spec_parser *parser, const struct spec_statement *statement, int target)
{
	struct spec_arguments arguments = {.scene = parser->scene,
		.error = parser->error,
		.place = statement->place,
		.own = &statement->parameters,
		.inherited = target < 0 ? NULL : &parser->inherited[target]};

	snprintf(arguments.statement, sizeof arguments.statement, "%s \"%.40s\"",
		statement->keyword, statement->name);
	return arguments;
}

const struct spec_parsing_sort *
spec_parser_sort(const struct spec_parser *parser, const struct spec_statement *statement,
	const struct spec_parsing_sort *sorts, const char *name)
{
	const struct spec_parsing_sort *sort = sorts;
	const char *wanted = name ? name : statement->name, *nearest;
	const char *keyword = name ? "Material" : statement->keyword;

	while (sort->name && strcmp(sort->name, wanted) != 0)
		sort++;
	if (sort->expected)
		return sort;
	if (sort->name) {
		spec_parser_fail(parser, statement, SPEC_EUNSUPPORTED,
			"%s \"%.60s\" is not supported", keyword, wanted);
		return NULL;
	}
	nearest = spec_nearest_name(wanted, sorts, sizeof *sorts);
	spec_parser_fail(parser, statement, SPEC_EFORMAT, "there is no %s \"%.60s\"%s%s%s",
		keyword, wanted, nearest ? "; did you mean \"" : "", nearest ? nearest : "",
		nearest ? "\"?" : "");
	return NULL;
}

struct spec_parsing_name *
spec_parser_find(const struct spec_parsing_names *names, const char *name)
{
	for (size_t i = 0; i < names->count; i++)
		if (strcmp(names->list[i].name, name) == 0)
			return &names->list[i];
	return NULL;
}

struct spec_parsing_name *
spec_parser_add(
	struct spec_parsing_names *names, const char *name, struct spec_error *error)
{
	struct spec_parsing_name *there = spec_parser_find(names, name);
	void *list = names->list;
	enum spec_status status;
	char *copy;

	if (there)
		return there;
	status = spec_memory_grow(
		&list, &names->room, names->count + 1, sizeof *names->list, "names", error);
	names->list = list;
	copy = status == SPEC_OK ? spec_memory_text(name, strlen(name), error) : NULL;
	if (!copy)
		return NULL;
	names->list[names->count] = (struct spec_parsing_name){.name = copy};
	return &names->list[names->count++];
}

static void
free_names(struct spec_parsing_names *names)
{
	for (size_t i = 0; i < names->count; i++)
		free(names->list[i].name);
	free(names->list);
}

/* ---- transforms ---- */

static enum spec_status
identity(struct spec_parser *parser, struct spec_statement *statement)
{
	(void)statement;
	parser->state.transform = spec_transform_identity();
	return SPEC_OK;
}

static enum spec_status
translate(struct spec_parser *parser, struct spec_statement *statement)
{
	return placed(parser, &statement->place,
		spec_transform_translate(
			&parser->state.transform, statement->number, parser->error));
}

static enum spec_status
scale(struct spec_parser *parser, struct spec_statement *statement)
{
	return placed(parser, &statement->place,
		spec_transform_scale(
			&parser->state.transform, statement->number, parser->error));
}

static enum spec_status
rotate(struct spec_parser *parser, struct spec_statement *statement)
{
	return placed(parser, &statement->place,
		spec_transform_rotate(&parser->state.transform, statement->number[0],
			statement->number + 1, parser->error));
}

static enum spec_status
look_at(struct spec_parser *parser, struct spec_statement *statement)
{
	const double *number = statement->number;

	return placed(parser, &statement->place,
		spec_transform_look_at(&parser->state.transform, number, number + 3,
			number + 6, parser->error));
}

static enum spec_status
set_transform(struct spec_parser *parser, struct spec_statement *statement)
{
	return placed(parser, &statement->place,
		spec_transform_set(
			&parser->state.transform, statement->number, parser->error));
}

static enum spec_status
concat_transform(struct spec_parser *parser, struct spec_statement *statement)
{
	return placed(parser, &statement->place,
		spec_transform_concat(
			&parser->state.transform, statement->number, parser->error));
}

static enum spec_status
coordinate_system(struct spec_parser *parser, struct spec_statement *statement)
{
	struct spec_parsing_name *system =
		spec_parser_add(&parser->systems, statement->name, parser->error);

	if (!system)
		return SPEC_ENOMEM;
	system->transform = parser->state.transform;
	return SPEC_OK;
}

static enum spec_status
use_coordinate_system(struct spec_parser *parser, struct spec_statement *statement)
{
	const struct spec_parsing_name *system =
		spec_parser_find(&parser->systems, statement->name);

	if (!system)
		return spec_parser_fail(parser, statement, SPEC_EFORMAT,
			"there is no CoordinateSystem \"%.60s\" so far", statement->name);
	parser->state.transform = system->transform;
	return SPEC_OK;
}

static enum spec_status
reverse_orientation(struct spec_parser *parser, struct spec_statement *statement)
{
	(void)statement;
	parser->state.reverse_orientation = !parser->state.reverse_orientation;
	return SPEC_OK;
}

static enum spec_status
active_transform(struct spec_parser *parser, struct spec_statement *statement)
{
	struct spec_token token;
	enum spec_status status = spec_tokens_want(
		&parser->tokens, SPEC_TOKEN_WORD, "All, StartTime or EndTime", &token);

	if (status == SPEC_OK && (token.length != 3 || strncmp(token.text, "All", 3) != 0))
		status = spec_parser_fail(parser, statement, SPEC_EUNSUPPORTED,
			"ActiveTransform %.*s is not supported: nothing moves",
			token.length < 20 ? (int)token.length : 20, token.text);
	return status;
}

/* ---- the statements around others ---- */

static enum spec_status
push(struct spec_parser *parser, const struct spec_statement *statement, int imported)
{
	void *list = parser->frame;
	enum spec_status status;

	if (parser->frames == SPEC_PARSING_DEEPEST)
		return spec_parser_fail(parser, statement, SPEC_ERANGE,
			"statements are nested more than %d deep", SPEC_PARSING_DEEPEST);
	status = spec_memory_grow(&list, &parser->frame_room, parser->frames + 1,
		sizeof *parser->frame, "nested statements", parser->error);
	parser->frame = list;
	if (status != SPEC_OK)
		return status;
	parser->frame[parser->frames++] = (struct spec_parsing_frame){
		.state = parser->state, .place = statement->place, .imported = imported};
	return SPEC_OK;
}

static void
pop(struct spec_parser *parser)
{
	parser->state = parser->frame[--parser->frames].state;
	for (int i = 0; i < SPEC_PARSING_TARGETS; i++)
		spec_parameters_cut(&parser->inherited[i], parser->state.inherited[i]);
}

static enum spec_status
attribute_begin(struct spec_parser *parser, struct spec_statement *statement)
{
	return push(parser, statement, 0);
}

static enum spec_status
attribute_end(struct spec_parser *parser, struct spec_statement *statement)
{
	if (parser->frames == 0 || parser->frame[parser->frames - 1].imported)
		return spec_parser_fail(parser, statement, SPEC_EFORMAT,
			"%s ends what was not begun", statement->keyword);
	pop(parser);
	return SPEC_OK;
}

static enum spec_status
fail_open(struct spec_parser *parser)
{
	return spec_scene_fail(parser->scene, &parser->frame[parser->frames - 1].place,
		parser->error, SPEC_EFORMAT, "what begins here is never ended");
}

/* An imported file has ended: what it set is forgotten. */
static enum spec_status
return_from_import(struct spec_parser *parser)
{
	if (!parser->frame[parser->frames - 1].imported)
		return fail_open(parser);
	pop(parser);
	return SPEC_OK;
}

static enum spec_status
world_begin(struct spec_parser *parser, struct spec_statement *statement)
{
	struct spec_parsing_name *world =
		spec_parser_add(&parser->systems, "world", parser->error);

	(void)statement;
	if (!world)
		return SPEC_ENOMEM;
	parser->in_world = 1;
	parser->state.transform = spec_transform_identity();
	world->transform = parser->state.transform;
	return SPEC_OK;
}

static enum spec_status
include(struct spec_parser *parser, struct spec_statement *statement)
{
	struct spec_token name = {
		SPEC_TOKEN_STRING, statement->name, 0, statement->name_place};

	return spec_tokens_include(&parser->tokens, &name, 0);
}

static enum spec_status
import(struct spec_parser *parser, struct spec_statement *statement)
{
	struct spec_token name = {
		SPEC_TOKEN_STRING, statement->name, 0, statement->name_place};
	enum spec_status status = push(parser, statement, 1);

	return status == SPEC_OK ? spec_tokens_include(&parser->tokens, &name, 1) : status;
}

/* Whether one of the tables that a target has expects a parameter of that name. */
static int
is_expected(int target, const char *name)
{
	const struct spec_parsing_sort *const tables[][2] = {{spec_parser_shapes, NULL},
		{spec_parser_lights, spec_parser_area_lights},
		{spec_parser_materials, NULL}};

	for (int i = 0; i < 2 && tables[target][i]; i++)
		for (const struct spec_parsing_sort *sort = tables[target][i]; sort->name;
			sort++)
			for (const struct spec_expected *row = sort->expected;
				row && row->name; row++)
				if (strcmp(row->name, name) == 0)
					return 1;
	return 0;
}

static enum spec_status
attribute(struct spec_parser *parser, struct spec_statement *statement)
{
	static const struct spec_expected nothing[] = {{0}};
	static const struct spec_parsing_sort targets[] = {
		{"shape", nothing, SPEC_PARSING_SHAPE},
		{"light", nothing, SPEC_PARSING_LIGHT},
		{"material", nothing, SPEC_PARSING_MATERIAL}, {"medium", NULL, 0},
		{"texture", NULL, 0}, {0}};
	const struct spec_parsing_sort *sort =
		spec_parser_sort(parser, statement, targets, NULL);
	struct spec_parameters *given = &statement->parameters, *inherited;
	void *list;
	enum spec_status status;

	if (!sort)
		return parser->error->status;
	inherited = &parser->inherited[sort->number];
	list = inherited->list;
	for (size_t i = 0; i < given->count; i++)
		if (!is_expected(sort->number, given->list[i].name))
			return spec_scene_fail(parser->scene, &given->list[i].place,
				parser->error, SPEC_EFORMAT,
				"no %s has a parameter '%.60s'", statement->name,
				given->list[i].name);
	status = spec_memory_grow(&list, &inherited->room, inherited->count + given->count,
		sizeof *inherited->list, "parameters", parser->error);
	inherited->list = list;
	if (status != SPEC_OK || given->count == 0)
		return status;
	memcpy(inherited->list + inherited->count, given->list,
		given->count * sizeof *given->list);
	inherited->count += given->count;
	given->count = 0;
	parser->state.inherited[sort->number] = inherited->count;
	return SPEC_OK;
}

/* ---- what is not there ---- */

static enum spec_status
unsupported(struct spec_parser *parser, struct spec_statement *statement)
{
	return spec_parser_fail(parser, statement, SPEC_EUNSUPPORTED, "%s is not supported",
		statement->keyword);
}

static enum spec_status
no_difference(struct spec_parser *parser, struct spec_statement *statement)
{
	(void)parser;
	(void)statement;
	return SPEC_OK;
}

/* One or two names of media, which may be empty. */
static enum spec_status
medium_interface(struct spec_parser *parser, struct spec_statement *statement)
{
	struct spec_token second;
	enum spec_status status = spec_tokens_next(&parser->tokens, &second);

	if (status != SPEC_OK)
		return status;
	if (*statement->name != '\0' ||
		(second.kind == SPEC_TOKEN_STRING && second.length > 0))
		return spec_parser_fail(parser, statement, SPEC_EUNSUPPORTED,
			"media are not supported: both names must be \"\"");
	if (second.kind != SPEC_TOKEN_STRING)
		spec_tokens_unget(&parser->tokens, &second);
	return SPEC_OK;
}

/* ---- statements ---- */

/* Where a statement may stand. */
enum block { ANYWHERE, BEFORE_WORLD, IN_WORLD };

/* What stands behind its keyword. */
enum form {
	NOTHING,
	NUMBERS,
	MATRIX, /* [ 16 numbers ] */
	NAME,   /* "string" */
	LIST,   /* "string" and a list of parameters */
	REFUSED /* it is not supported, so what follows does not matter */
};

static const struct row {
	const char *keyword;
	enum block block;
	enum form form;
	int numbers;
	spec_parser_statement *take;
} rows[] = {
	{"Accelerator", BEFORE_WORLD, LIST, 0, no_difference},
	{"ActiveTransform", ANYWHERE, NOTHING, 0, active_transform},
	{"AreaLightSource", IN_WORLD, LIST, 0, spec_parser_area_light},
	{"Attribute", ANYWHERE, LIST, 0, attribute},
	{"AttributeBegin", IN_WORLD, NOTHING, 0, attribute_begin},
	{"AttributeEnd", IN_WORLD, NOTHING, 0, attribute_end},
	{"Camera", BEFORE_WORLD, LIST, 0, spec_parser_camera},
	{"ColorSpace", ANYWHERE, NAME, 0, spec_parser_colour_space},
	{"ConcatTransform", ANYWHERE, MATRIX, 0, concat_transform},
	{"CoordSysTransform", ANYWHERE, NAME, 0, use_coordinate_system},
	{"CoordinateSystem", ANYWHERE, NAME, 0, coordinate_system},
	{"Film", BEFORE_WORLD, LIST, 0, spec_parser_film},
	{"Identity", ANYWHERE, NOTHING, 0, identity},
	{"Import", IN_WORLD, NAME, 0, import},
	{"Include", ANYWHERE, NAME, 0, include},
	{"Integrator", BEFORE_WORLD, LIST, 0, spec_parser_integrator},
	{"LightSource", IN_WORLD, LIST, 0, spec_parser_light},
	{"LookAt", ANYWHERE, NUMBERS, 9, look_at},
	{"MakeNamedMaterial", IN_WORLD, LIST, 0, spec_parser_make_named_material},
	{"MakeNamedMedium", ANYWHERE, REFUSED, 0, unsupported},
	{"Material", IN_WORLD, LIST, 0, spec_parser_material},
	{"MediumInterface", ANYWHERE, NAME, 0, medium_interface},
	{"NamedMaterial", IN_WORLD, NAME, 0, spec_parser_named_material},
	{"ObjectBegin", IN_WORLD, REFUSED, 0, unsupported},
	{"ObjectEnd", IN_WORLD, REFUSED, 0, unsupported},
	{"ObjectInstance", IN_WORLD, REFUSED, 0, unsupported},
	{"Option", ANYWHERE, NAME, 0, spec_parser_option},
	{"PixelFilter", BEFORE_WORLD, LIST, 0, spec_parser_filter},
	{"ReverseOrientation", IN_WORLD, NOTHING, 0, reverse_orientation},
	{"Rotate", ANYWHERE, NUMBERS, 4, rotate},
	{"Sampler", BEFORE_WORLD, LIST, 0, spec_parser_sampler},
	{"Scale", ANYWHERE, NUMBERS, 3, scale},
	{"Shape", IN_WORLD, LIST, 0, spec_parser_shape},
	{"Texture", IN_WORLD, REFUSED, 0, unsupported},
	{"Transform", ANYWHERE, MATRIX, 0, set_transform},
	{"TransformBegin", IN_WORLD, NOTHING, 0, attribute_begin},
	{"TransformEnd", IN_WORLD, NOTHING, 0, attribute_end},
	/* Without ActiveTransform there is but one transform at all times. */
	{"TransformTimes", BEFORE_WORLD, NUMBERS, 2, no_difference},
	{"Translate", ANYWHERE, NUMBERS, 3, translate},
	{"WorldBegin", BEFORE_WORLD, NOTHING, 0, world_begin},
	{0},
};

static const struct row *
find_row(struct spec_parser *parser, const struct spec_token *token)
{
	char word[64];
	const char *nearest;

	for (const struct row *row = rows; row->keyword; row++)
		if (strlen(row->keyword) == token->length &&
			strncmp(row->keyword, token->text, token->length) == 0)
			return row;
	snprintf(word, sizeof word, "%.*s", token->length < 60 ? (int)token->length : 60,
		token->text);
	nearest = spec_nearest_name(word, rows, sizeof *rows);
	spec_scene_fail(parser->scene, &token->place, parser->error, SPEC_EFORMAT,
		"there is no statement '%s'%s%s%s", word, nearest ? "; did you mean '" : "",
		nearest ? nearest : "", nearest ? "'?" : "");
	return NULL;
}

static enum spec_status
check_block(const struct spec_parser *parser, const struct row *row,
	const struct spec_statement *statement)
{
	if (row->block == BEFORE_WORLD && parser->in_world)
		return spec_parser_fail(parser, statement, SPEC_EFORMAT,
			"%s cannot stand behind WorldBegin", row->keyword);
	if (row->block == IN_WORLD && !parser->in_world)
		return spec_parser_fail(parser, statement, SPEC_EFORMAT,
			"%s cannot stand before WorldBegin", row->keyword);
	return SPEC_OK;
}

static enum spec_status
read_name(
	struct spec_parser *parser, const struct row *row, struct spec_statement *statement)
{
	char what[48];
	struct spec_token token;
	enum spec_status status;

	snprintf(what, sizeof what, "the \"string\" of %s", row->keyword);
	status = spec_tokens_want(&parser->tokens, SPEC_TOKEN_STRING, what, &token);
	if (status != SPEC_OK)
		return status;
	statement->name_place = token.place;
	statement->name = spec_memory_text(token.text, token.length, parser->error);
	return statement->name ? SPEC_OK : SPEC_ENOMEM;
}

static enum spec_status
read_numbers(
	struct spec_parser *parser, const struct row *row, struct spec_statement *statement)
{
	int matrix = row->form == MATRIX, numbers = matrix ? 16 : row->numbers;
	struct spec_token token;
	enum spec_status status = SPEC_OK;

	if (matrix)
		status = spec_tokens_want(&parser->tokens, SPEC_TOKEN_OPEN, "a [", &token);
	for (int i = 0; i < numbers && status == SPEC_OK; i++)
		status = spec_tokens_number(&parser->tokens, &statement->number[i]);
	if (matrix && status == SPEC_OK)
		status = spec_tokens_want(&parser->tokens, SPEC_TOKEN_CLOSE, "a ]", &token);
	return status;
}

/* Reads the rest of a statement and carries it out. */
static enum spec_status
take_statement(
	struct spec_parser *parser, const struct row *row, struct spec_statement *statement)
{
	enum spec_status status = check_block(parser, row, statement);

	if (status == SPEC_OK && (row->form == NUMBERS || row->form == MATRIX))
		status = read_numbers(parser, row, statement);
	if (status == SPEC_OK && (row->form == NAME || row->form == LIST))
		status = read_name(parser, row, statement);
	if (status == SPEC_OK && row->form == LIST)
		status = spec_parameters_parse(&parser->tokens, &statement->parameters);
	return status == SPEC_OK ? row->take(parser, statement) : status;
}

static enum spec_status
parse_statement(struct spec_parser *parser, const struct spec_token *token)
{
	struct spec_statement statement = {.place = token->place};
	const struct row *row;
	enum spec_status status;

	if (token->kind == SPEC_TOKEN_RETURN)
		return return_from_import(parser);
	if (token->kind != SPEC_TOKEN_WORD)
		return spec_scene_fail(parser->scene, &token->place, parser->error,
			SPEC_EFORMAT, "%s%.*s%s stands where a statement should be",
			token->kind == SPEC_TOKEN_STRING ? "\"" : "'",
			token->length < 60 ? (int)token->length : 60, token->text,
			token->kind == SPEC_TOKEN_STRING ? "\"" : "'");
	row = find_row(parser, token);
	if (!row)
		return SPEC_EFORMAT;
	statement.keyword = row->keyword;
	status = take_statement(parser, row, &statement);
	free(statement.name);
	spec_parameters_free(&statement.parameters);
	return status;
}

static enum spec_status
parse_statements(struct spec_parser *parser)
{
	struct spec_token token;
	enum spec_status status = spec_tokens_next(&parser->tokens, &token);

	while (status == SPEC_OK && token.kind != SPEC_TOKEN_END) {
		status = parse_statement(parser, &token);
		if (status == SPEC_OK)
			status = spec_tokens_next(&parser->tokens, &token);
	}
	if (status == SPEC_OK && parser->frames > 0)
		status = fail_open(parser);
	if (status == SPEC_OK && !parser->in_world)
		status = spec_scene_fail(parser->scene, &token.place, parser->error,
			SPEC_EFORMAT, "the file ends before a WorldBegin");
	return status;
}

/* ---- scenes ---- */

static void
settle(struct spec_parser *parser, struct spec_scene *scene, struct spec_error *error)
{
	*scene = (struct spec_scene){.camera = spec_transform_identity(),
		.fov_deg = 90,
		.focal_distance = 1e6,
		.width = SPEC_PARSING_WIDTH,
		.height = SPEC_PARSING_HEIGHT,
		.max_depth = -1};
	*parser = (struct spec_parser){.scene = scene,
		.error = error,
		.plain = SPEC_SCENE_NONE,
		.state = {.transform = scene->camera,
			.material = SPEC_SCENE_NONE,
			.light = SPEC_SCENE_NONE}};
}

/* Parses what tokens were opened for, if that has gone well, and frees the parser. */
static enum spec_status
finish(struct spec_parser *parser, enum spec_status status)
{
	if (status == SPEC_OK)
		status = parse_statements(parser);
	spec_tokens_close(&parser->tokens);
	for (int i = 0; i < SPEC_PARSING_TARGETS; i++)
		spec_parameters_free(&parser->inherited[i]);
	free_names(&parser->materials);
	free_names(&parser->systems);
	free(parser->frame);
	if (status != SPEC_OK)
		spec_scene_free(parser->scene);
	return status;
}

enum spec_status
spec_scene_read(struct spec_scene *scene, const char *path, struct spec_error *error)
{
	struct spec_error unwanted;
	struct spec_parser parser;

	settle(&parser, scene, error ? error : &unwanted);
	return finish(&parser, spec_tokens_open(&parser.tokens, scene, path, parser.error));
}

enum spec_status
spec_scene_parse(struct spec_scene *scene, const char *text, size_t size, const char *name,
	struct spec_error *error)
{
	struct spec_error unwanted;
	struct spec_parser parser;

	settle(&parser, scene, error ? error : &unwanted);
	return finish(&parser, spec_tokens_open_text(&parser.tokens, scene, text, size,
				       name, parser.error));
}
