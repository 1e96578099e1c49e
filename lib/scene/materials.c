/* The statements that describe materials. */
#include <limits.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "base/memory.h"
#include "optics/disc.h"
#include "optics/recipe.h"
#include "optics/thickness.h"
#include "scene/parsing.h"
#include "scene/spectra.h"

/* What all materials have; "type" is MakeNamedMaterial's, and is taken there. */
#define EVERY_MATERIAL                                                                     \
	SPEC_TAKES("type", SPEC_STRING), SPEC_TAKES("id", SPEC_INTEGER),                   \
		SPEC_REFUSES("normalmap", NULL), SPEC_REFUSES("displacement", NULL)

#define EVERY_ROUGHNESS                                                                    \
	SPEC_TAKES("roughness", SPEC_FLOAT), SPEC_TAKES("uroughness", SPEC_FLOAT),         \
		SPEC_TAKES("vroughness", SPEC_FLOAT),                                      \
		SPEC_TAKES("remaproughness", SPEC_BOOL)

static const struct spec_expected diffuse[] = {
	SPEC_TAKES("reflectance", SPEC_ANY_SPECTRUM), EVERY_MATERIAL, {0}};
static const struct spec_expected conductor[] = {SPEC_TAKES("eta", SPEC_ANY_SPECTRUM),
	SPEC_TAKES("k", SPEC_ANY_SPECTRUM),
	SPEC_REFUSES("reflectance", "give eta and k instead"), EVERY_ROUGHNESS,
	EVERY_MATERIAL, {0}};
static const struct spec_expected dielectric[] = {
	SPEC_TAKES("eta", SPEC_ANY_SPECTRUM), EVERY_ROUGHNESS, EVERY_MATERIAL, {0}};
static const struct spec_expected thinfilm[] = {SPEC_TAKES("stack", SPEC_STRING),
	SPEC_TAKES("thickness", SPEC_STRING), EVERY_MATERIAL, {0}};
static const struct spec_expected diffractive[] = {
	SPEC_TAKES("preset", SPEC_STRING), EVERY_MATERIAL, {0}};
static const struct spec_expected interface[] = {EVERY_MATERIAL, {0}};

const struct spec_parsing_sort spec_parser_materials[] = {
	{"diffuse", diffuse, SPEC_SCENE_DIFFUSE},
	{"conductor", conductor, SPEC_SCENE_CONDUCTOR},
	{"dielectric", dielectric, SPEC_SCENE_DIELECTRIC},
	{"thinfilm", thinfilm, SPEC_SCENE_THINFILM},
	{"diffractive", diffractive, SPEC_SCENE_DIFFRACTIVE},
	{"interface", interface, SPEC_SCENE_INTERFACE},
	{"", interface, SPEC_SCENE_INTERFACE}, {"none", interface, SPEC_SCENE_INTERFACE},
	{"coateddiffuse", NULL, 0}, {"coatedconductor", NULL, 0},
	{"diffusetransmission", NULL, 0}, {"thindielectric", NULL, 0}, {"hair", NULL, 0},
	{"measured", NULL, 0}, {"subsurface", NULL, 0}, {"mix", NULL, 0}, {0}};

/* A new material, the last one of the scene, or null: SPEC_ENOMEM. */
static struct spec_scene_material *
add(struct spec_parser *parser, const struct spec_scene_place *place)
{
	struct spec_scene *scene = parser->scene;
	void *list = scene->material;
	struct spec_scene_material *material;
	enum spec_status status = spec_memory_grow(&list, &scene->material_room,
		scene->materials + 1, sizeof *scene->material, "materials", parser->error);

	scene->material = list;
	if (status != SPEC_OK)
		return NULL;
	material = &scene->material[scene->materials++];
	*material = (struct spec_scene_material){
		.id = (uint32_t)scene->materials, .place = *place};
	return material;
}

static struct spec_scene_spectrum
constant(double value, const struct spec_scene_place *place)
{
	return (struct spec_scene_spectrum){
		.kind = SPEC_SCENE_CONSTANT, .value = value, .place = *place};
}

enum spec_status
spec_parser_plain_material(
	struct spec_parser *parser, const struct spec_scene_place *place, size_t *material)
{
	struct spec_scene_material *plain;

	if (parser->plain == SPEC_SCENE_NONE) {
		plain = add(parser, place);
		if (!plain)
			return SPEC_ENOMEM;
		plain->reflectance = constant(0.5, place);
		parser->plain = parser->scene->materials - 1;
	}
	*material = parser->plain;
	return SPEC_OK;
}

static enum spec_status
read_diffuse(const struct spec_arguments *arguments, struct spec_scene_material *material)
{
	int given;

	material->reflectance = constant(0.5, &arguments->place);
	return spec_arguments_spectrum(arguments, "reflectance", SPEC_SCENE_REFLECTANCE,
		&material->reflectance, &given);
}

/* pbrt's roughness is the square of alpha, unless it says otherwise. */
static enum spec_status
read_roughness(const struct spec_arguments *arguments, struct spec_scene_material *material)
{
	static const char *const names[] = {"uroughness", "vroughness"};
	double both = 0, *alpha = material->roughness;
	int remap = 1;
	enum spec_status status =
		spec_arguments_number(arguments, "roughness", 0, 1, &both);

	for (int i = 0; i < 2; i++) {
		alpha[i] = both;
		if (status == SPEC_OK)
			status =
				spec_arguments_number(arguments, names[i], 0, 1, &alpha[i]);
	}
	if (status == SPEC_OK)
		status = spec_arguments_flag(arguments, "remaproughness", &remap);
	for (int i = 0; i < 2 && remap; i++)
		alpha[i] = sqrt(alpha[i]);
	return status;
}

static enum spec_status
read_conductor(const struct spec_arguments *arguments, struct spec_scene_material *material)
{
	int has_eta, has_k = 0;
	enum spec_status status = spec_arguments_spectrum(
		arguments, "eta", SPEC_SCENE_ETA, &material->eta, &has_eta);

	if (status == SPEC_OK)
		status = spec_arguments_spectrum(
			arguments, "k", SPEC_SCENE_K, &material->k, &has_k);
	if (status == SPEC_OK && has_eta != has_k)
		return spec_arguments_fail(arguments, NULL, SPEC_EFORMAT,
			"has %s but no %s", has_eta ? "eta" : "k", has_eta ? "k" : "eta");
	if (status == SPEC_OK && !has_eta)
		status = spec_arguments_named_spectrum(
			arguments, "metal-Cu-eta", SPEC_SCENE_ETA, &material->eta);
	if (status == SPEC_OK && !has_k)
		status = spec_arguments_named_spectrum(
			arguments, "metal-Cu-k", SPEC_SCENE_K, &material->k);
	return status == SPEC_OK ? read_roughness(arguments, material) : status;
}

static enum spec_status
read_dielectric(
	const struct spec_arguments *arguments, struct spec_scene_material *material)
{
	int given;
	enum spec_status status;

	material->eta = constant(1.5, &arguments->place);
	status = spec_arguments_spectrum(
		arguments, "eta", SPEC_SCENE_ETA, &material->eta, &given);
	return status == SPEC_OK ? read_roughness(arguments, material) : status;
}

/* Puts the place of a parameter before an error of somebody else's. */
static enum spec_status
at(const struct spec_arguments *arguments, const char *name, enum spec_status status)
{
	return spec_arguments_blame(
		arguments, spec_arguments_find(arguments, name), status);
}

/* A copy of a string parameter that must be there. */
static enum spec_status
copy_text(const struct spec_arguments *arguments, const char *name, char **copy)
{
	const char *text;
	enum spec_status status = spec_arguments_text(arguments, name, &text);

	if (status != SPEC_OK)
		return status;
	if (!text)
		return spec_arguments_fail(
			arguments, NULL, SPEC_EFORMAT, "needs a \"string %s\"", name);
	*copy = spec_memory_text(text, strlen(text), arguments->error);
	return *copy ? SPEC_OK : SPEC_ENOMEM;
}

/* Whether a stack can be read, and has thicknesses. */
static enum spec_status
check_stack(const struct spec_arguments *arguments, const char *stack, const char *varied)
{
	struct spec_error *error = arguments->error;
	struct spec_thickness thickness;
	struct spec_recipe recipe;
	size_t layer;
	enum spec_status status =
		at(arguments, "stack", spec_recipe_parse(stack, &recipe, error));

	if (status == SPEC_OK && varied) {
		status = at(arguments, "stack",
			spec_recipe_find_varied(&recipe, &layer, error));
		if (status == SPEC_OK)
			status = at(arguments, "thickness",
				spec_thickness_parse(varied, &thickness, error));
	} else if (status == SPEC_OK) {
		status = at(arguments, "stack", spec_recipe_check_fixed(&recipe, error));
	}
	spec_recipe_free(&recipe);
	return status;
}

static enum spec_status
read_thinfilm(const struct spec_arguments *arguments, struct spec_scene_material *material)
{
	enum spec_status status = copy_text(arguments, "stack", &material->stack);

	if (status == SPEC_OK && spec_arguments_find(arguments, "thickness"))
		status = copy_text(arguments, "thickness", &material->thickness);
	return status == SPEC_OK
		       ? check_stack(arguments, material->stack, material->thickness)
		       : status;
}

static enum spec_status
read_diffractive(
	const struct spec_arguments *arguments, struct spec_scene_material *material)
{
	enum spec_status status = copy_text(arguments, "preset", &material->preset);

	if (status == SPEC_OK && !spec_disc_find(material->preset, arguments->error))
		status = at(arguments, "preset", SPEC_EUSAGE);
	return status;
}

static enum spec_status
read_material(const struct spec_arguments *arguments, struct spec_scene_material *material)
{
	switch (material->kind) {
	case SPEC_SCENE_DIFFUSE:
		return read_diffuse(arguments, material);
	case SPEC_SCENE_CONDUCTOR:
		return read_conductor(arguments, material);
	case SPEC_SCENE_DIELECTRIC:
		return read_dielectric(arguments, material);
	case SPEC_SCENE_THINFILM:
		return read_thinfilm(arguments, material);
	case SPEC_SCENE_DIFFRACTIVE:
		return read_diffractive(arguments, material);
	case SPEC_SCENE_INTERFACE:
		break;
	}
	return SPEC_OK;
}

/* Adds the material of the statement, of the given sort, to the scene. */
static enum spec_status
take(struct spec_parser *parser, const struct spec_statement *statement,
	const struct spec_arguments *arguments, const char *name)
{
	const struct spec_parsing_sort *sort =
		spec_parser_sort(parser, statement, spec_parser_materials, name);
	struct spec_scene_material *material;
	long long id = 0;
	enum spec_status status;

	if (!sort)
		return parser->error->status;
	status = spec_arguments_check(arguments, sort->expected);
	if (status == SPEC_OK)
		status = spec_arguments_whole(arguments, "id", 1, INT_MAX, &id);
	if (status != SPEC_OK)
		return status;
	material = add(parser, &statement->place);
	if (!material)
		return SPEC_ENOMEM;
	material->kind = (enum spec_scene_material_kind)sort->number;
	if (id > 0)
		material->id = (uint32_t)id;
	return read_material(arguments, material);
}

enum spec_status
spec_parser_material(struct spec_parser *parser, struct spec_statement *statement)
{
	struct spec_arguments arguments =
		spec_parser_arguments(parser, statement, SPEC_PARSING_MATERIAL);
	const struct spec_parameter *type = spec_arguments_find(&arguments, "type");
	enum spec_status status;

	if (type)
		return spec_arguments_fail(&arguments, type, SPEC_EFORMAT,
			"is MakeNamedMaterial's: here the type is \"%.60s\"",
			statement->name);
	status = take(parser, statement, &arguments, NULL);
	if (status == SPEC_OK)
		parser->state.material = parser->scene->materials - 1;
	return status;
}

enum spec_status
spec_parser_make_named_material(
	struct spec_parser *parser, struct spec_statement *statement)
{
	struct spec_arguments arguments =
		spec_parser_arguments(parser, statement, SPEC_PARSING_MATERIAL);
	struct spec_parsing_name *name;
	const struct spec_parameter *type = spec_arguments_find(&arguments, "type");
	enum spec_status status;

	if (spec_parser_find(&parser->materials, statement->name))
		return spec_parser_fail(parser, statement, SPEC_EFORMAT,
			"there is a material '%.60s' already", statement->name);
	if (!type || type->type != SPEC_STRING || type->count != 1)
		return spec_arguments_fail(&arguments, type, SPEC_EFORMAT,
			type ? "is not one string" : "needs a \"string type\"");
	status = take(parser, statement, &arguments, type->text[0]);
	if (status != SPEC_OK)
		return status;
	name = spec_parser_add(&parser->materials, statement->name, parser->error);
	if (!name)
		return SPEC_ENOMEM;
	name->material = parser->scene->materials - 1;
	return SPEC_OK;
}

enum spec_status
spec_parser_named_material(struct spec_parser *parser, struct spec_statement *statement)
{
	const struct spec_parsing_name *name =
		spec_parser_find(&parser->materials, statement->name);

	if (!name)
		return spec_parser_fail(parser, statement, SPEC_EFORMAT,
			"no material '%.60s' has been made so far", statement->name);
	parser->state.material = name->material;
	return SPEC_OK;
}
