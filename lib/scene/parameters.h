/*
 * Parameter lists: "float radius" 2 "point3 P" [0 0 0 1 0 0 …], and what a statement makes
 * of them.
 */
#ifndef SPEC_SCENE_PARAMETERS_H
#define SPEC_SCENE_PARAMETERS_H

#include <stddef.h>

#include "base/error.h"
#include "scene/scene.h"
#include "scene/tokens.h"

enum spec_parameter_type {
	SPEC_FLOAT = 1 << 0,
	SPEC_INTEGER = 1 << 1,
	SPEC_BOOL = 1 << 2,
	SPEC_STRING = 1 << 3,
	SPEC_POINT2 = 1 << 4,
	SPEC_VECTOR2 = 1 << 5,
	SPEC_POINT3 = 1 << 6,
	SPEC_VECTOR3 = 1 << 7,
	SPEC_NORMAL = 1 << 8,
	SPEC_SPECTRUM = 1 << 9,
	SPEC_RGB = 1 << 10,
	SPEC_BLACKBODY = 1 << 11,
	SPEC_TEXTURE = 1 << 12,
	/* Representations that pbrt has not: see represented.h. */
	SPEC_SAMPLED_SPECTRUM = 1 << 13,
	SPEC_TABULATED_SPECTRUM = 1 << 14,
	SPEC_FOURIER_SPECTRUM = 1 << 15,
	SPEC_COMPOSITE_SAMPLED = 1 << 16,
	SPEC_COMPOSITE_FOURIER = 1 << 17,
	SPEC_RGB_SPECTRUM = 1 << 18,
	SPEC_RGB_FROM_SAMPLED = 1 << 19,
	SPEC_RGB_FROM_TABULATED = 1 << 20
};

#define SPEC_REPRESENTED                                                                   \
	(SPEC_SAMPLED_SPECTRUM | SPEC_TABULATED_SPECTRUM | SPEC_FOURIER_SPECTRUM |         \
		SPEC_COMPOSITE_SAMPLED | SPEC_COMPOSITE_FOURIER | SPEC_RGB_SPECTRUM |      \
		SPEC_RGB_FROM_SAMPLED | SPEC_RGB_FROM_TABULATED)
#define SPEC_ANY_SPECTRUM                                                                  \
	(SPEC_SPECTRUM | SPEC_RGB | SPEC_BLACKBODY | SPEC_FLOAT | SPEC_REPRESENTED)

struct spec_parameter {
	enum spec_parameter_type type;
	char *name;
	struct spec_scene_place place; /* of its declaration */
	size_t count;                  /* of the values, >= 1 */
	double *number; /* of all types but the next; whole ones are, a bool is 0 or 1 */
	char **text;    /* of strings, textures and spectra that are named; else null */
	size_t room;
};

struct spec_parameters {
	size_t count, room;
	struct spec_parameter *list;
};

/*
 * Reads parameters until something else comes, which stays the next token. Errors, in
 * tokens->error: SPEC_EFORMAT, SPEC_ERANGE, SPEC_ENOMEM. Then and else to be freed.
 */
enum spec_status spec_parameters_parse(
	struct spec_tokens *tokens, struct spec_parameters *parameters);

/* Frees what is there beyond the first so many. */
void spec_parameters_cut(struct spec_parameters *parameters, size_t count);
void spec_parameters_free(struct spec_parameters *parameters);

enum spec_expected_use {
	SPEC_TAKEN,      /* somebody asks for it */
	SPEC_IGNORED,    /* without it the picture is the same */
	SPEC_WARNED,     /* it matters to pbrt alone: one warning */
	SPEC_UNSUPPORTED /* without it the picture would be another one: an error */
};

/* A row of the table of what a statement may have; in the last one name is null. */
struct spec_expected {
	const char *name;
	unsigned types; /* any of these */
	enum spec_expected_use use;
	const char *hint; /* what to do instead, or null */
};

#define SPEC_TAKES(name, types)                                                            \
	{                                                                                  \
		name, types, SPEC_TAKEN, NULL                                              \
	}
#define SPEC_IGNORES(name)                                                                 \
	{                                                                                  \
		name, 0, SPEC_IGNORED, NULL                                                \
	}
#define SPEC_WARNS(name, hint)                                                             \
	{                                                                                  \
		name, 0, SPEC_WARNED, hint                                                 \
	}
#define SPEC_REFUSES(name, hint)                                                           \
	{                                                                                  \
		name, 0, SPEC_UNSUPPORTED, hint                                            \
	}

/* The parameters of one statement. The functions below leave errors in error. */
struct spec_arguments {
	struct spec_scene *scene; /* takes the warnings */
	struct spec_error *error;
	char statement[80]; /* as in: Shape "sphere" */
	struct spec_scene_place place;
	const struct spec_parameters *own;
	const struct spec_parameters *inherited; /* from Attribute, or null */
};

/*
 * Holds the parameters against a table. An inherited one that the table lacks is meant for
 * another statement. SPEC_EFORMAT: an own one that the table lacks, one that is there
 * twice, another type; SPEC_EUNSUPPORTED; SPEC_ENOMEM.
 */
enum spec_status spec_arguments_check(
	const struct spec_arguments *arguments, const struct spec_expected *expected);

/* The parameter of that name or null; the statement's own comes before an inherited one. */
const struct spec_parameter *spec_arguments_find(
	const struct spec_arguments *arguments, const char *name);

/*
 * The next five: where there is no such parameter, the value stays what it was. Else there
 * must be exactly one value, or count; SPEC_EFORMAT: there are others. SPEC_ERANGE: a value
 * outside minimum..maximum, or one that is not positive.
 */
enum spec_status spec_arguments_number(const struct spec_arguments *arguments,
	const char *name, double minimum, double maximum, double *value);
enum spec_status spec_arguments_positive(
	const struct spec_arguments *arguments, const char *name, double *value);
enum spec_status spec_arguments_whole(const struct spec_arguments *arguments,
	const char *name, long long minimum, long long maximum, long long *value);
enum spec_status spec_arguments_flag(
	const struct spec_arguments *arguments, const char *name, int *value);
enum spec_status spec_arguments_numbers(const struct spec_arguments *arguments,
	const char *name, size_t count, double *value);

/* The string of that name, or null where there is none. It belongs to the parameter. */
enum spec_status spec_arguments_text(
	const struct spec_arguments *arguments, const char *name, const char **text);

/* Checks that a parameter has one value. SPEC_EFORMAT: it has more. */
enum spec_status spec_arguments_only(
	const struct spec_arguments *arguments, const struct spec_parameter *parameter);

/* A parameter's place; null: the statement's. */
const struct spec_scene_place *spec_arguments_place(
	const struct spec_arguments *arguments, const struct spec_parameter *parameter);

/* Puts that place before an error that has none. Returns the status, which may be SPEC_OK. */
enum spec_status spec_arguments_blame(const struct spec_arguments *arguments,
	const struct spec_parameter *parameter, enum spec_status status);

/* An error about a parameter; null: about the statement. Returns the status. */
enum spec_status spec_arguments_fail(const struct spec_arguments *arguments,
	const struct spec_parameter *parameter, enum spec_status status, const char *format,
	...) __attribute__((format(printf, 4, 5)));

#endif
