#include "scene/parameters.h"

#include <float.h>
#include <limits.h>
#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "base/memory.h"
#include "base/nearest.h"

#define BLANKS " \t"

struct type {
	const char *name;
	enum spec_parameter_type type;
};

static const struct type types[] = {{"float", SPEC_FLOAT}, {"integer", SPEC_INTEGER},
	{"bool", SPEC_BOOL}, {"string", SPEC_STRING}, {"point2", SPEC_POINT2},
	{"vector2", SPEC_VECTOR2}, {"point3", SPEC_POINT3}, {"vector3", SPEC_VECTOR3},
	{"normal", SPEC_NORMAL}, {"spectrum", SPEC_SPECTRUM}, {"rgb", SPEC_RGB},
	{"blackbody", SPEC_BLACKBODY}, {"texture", SPEC_TEXTURE},
	{"samplespectrum", SPEC_SAMPLED_SPECTRUM},
	{"tabulatedspectrum", SPEC_TABULATED_SPECTRUM},
	{"fourierspectrum", SPEC_FOURIER_SPECTRUM},
	{"compositespectrumsampled", SPEC_COMPOSITE_SAMPLED},
	{"compositespectrumfourier", SPEC_COMPOSITE_FOURIER},
	{"rgbspectrum", SPEC_RGB_SPECTRUM}, {"rgbfromsampled", SPEC_RGB_FROM_SAMPLED},
	{"rgbfromtabulated", SPEC_RGB_FROM_TABULATED}, {NULL, 0}};

static const char *
type_name(enum spec_parameter_type type)
{
	for (size_t i = 0; types[i].name; i++)
		if (types[i].type == type)
			return types[i].name;
	return "";
}

static void
free_parameter(struct spec_parameter *parameter)
{
	for (size_t i = 0; parameter->text && i < parameter->count; i++)
		free(parameter->text[i]);
	free(parameter->text);
	free(parameter->number);
	free(parameter->name);
}

void
spec_parameters_cut(struct spec_parameters *parameters, size_t count)
{
	while (parameters->count > count)
		free_parameter(&parameters->list[--parameters->count]);
}

void
spec_parameters_free(struct spec_parameters *parameters)
{
	spec_parameters_cut(parameters, 0);
	free(parameters->list);
	*parameters = (struct spec_parameters){0};
}

/* ---- reading ---- */

/* Takes a declaration "TYPE NAME" apart. */
static enum spec_status
parse_declaration(struct spec_tokens *tokens, const struct spec_token *token,
	struct spec_parameter *parameter)
{
	const char *text = token->text + strspn(token->text, BLANKS);
	size_t type = strcspn(text, BLANKS);
	const char *name = text + type + strspn(text + type, BLANKS);
	size_t length = strcspn(name, BLANKS);
	const char *nearest;
	char named[64];

	parameter->place = token->place;
	if (length == 0 || name[length + strspn(name + length, BLANKS)] != '\0')
		return spec_scene_fail(tokens->scene, &token->place, tokens->error,
			SPEC_EFORMAT,
			"a parameter is declared by its type and its name, as in \"float "
			"radius\", not \"%.60s\"",
			token->text);
	parameter->name = spec_memory_text(name, length, tokens->error);
	if (!parameter->name)
		return SPEC_ENOMEM;
	for (size_t i = 0; types[i].name; i++)
		if (strlen(types[i].name) == type &&
			strncmp(types[i].name, text, type) == 0)
			parameter->type = types[i].type;
	if (parameter->type)
		return SPEC_OK;
	snprintf(named, sizeof named, "%.*s", type < 60 ? (int)type : 60, text);
	nearest = spec_nearest_name(named, types, sizeof *types);
	return spec_scene_fail(tokens->scene, &token->place, tokens->error, SPEC_EFORMAT,
		"there is no type '%s' of parameters%s%s%s", named,
		nearest ? "; did you mean '" : "", nearest ? nearest : "",
		nearest ? "'?" : "");
}

static enum spec_status
fail_value(struct spec_tokens *tokens, const struct spec_parameter *parameter,
	const struct spec_token *token, const char *wanted)
{
	return spec_scene_fail(tokens->scene, &token->place, tokens->error, SPEC_EFORMAT,
		"a value of '%.60s' should be %s, not %s%.*s%s", parameter->name, wanted,
		token->kind == SPEC_TOKEN_STRING ? "\"" : "'",
		token->length < 60 ? (int)token->length : 60, token->text,
		token->kind == SPEC_TOKEN_STRING ? "\"" : "'");
}

static enum spec_status
parse_whole(struct spec_tokens *tokens, const struct spec_parameter *parameter,
	const struct spec_token *token, double *number)
{
	size_t sign = *token->text == '-' || *token->text == '+';
	long long value = 0;

	if (token->kind != SPEC_TOKEN_WORD || token->length == sign)
		return fail_value(tokens, parameter, token, "a whole number");
	for (size_t i = sign; i < token->length; i++) {
		if (token->text[i] < '0' || token->text[i] > '9')
			return fail_value(tokens, parameter, token, "a whole number");
		value = value * 10 + (token->text[i] - '0');
		if (value > INT_MAX)
			return spec_scene_fail(tokens->scene, &token->place, tokens->error,
				SPEC_ERANGE, "a value of '%.60s' is larger than %d",
				parameter->name, INT_MAX);
	}
	*number = (double)(*token->text == '-' ? -value : value);
	return SPEC_OK;
}

static enum spec_status
parse_number(struct spec_tokens *tokens, const struct spec_parameter *parameter,
	const struct spec_token *token, double *number)
{
	if (parameter->type == SPEC_INTEGER)
		return parse_whole(tokens, parameter, token, number);
	if (parameter->type == SPEC_BOOL) {
		*number = spec_token_is_word(token, "true");
		return *number == 1 || spec_token_is_word(token, "false")
			       ? SPEC_OK
			       : fail_value(tokens, parameter, token,
					 "true or false without quotes");
	}
	if (token->kind == SPEC_TOKEN_STRING)
		return fail_value(tokens, parameter, token, "a number");
	return spec_tokens_read_number(tokens, token, number);
}

static enum spec_status
parse_text(struct spec_tokens *tokens, struct spec_parameter *parameter,
	const struct spec_token *token)
{
	void *list = parameter->text;
	enum spec_status status;
	char *copy;

	if (token->kind != SPEC_TOKEN_STRING)
		return fail_value(tokens, parameter, token, "a string");
	status = spec_memory_grow(&list, &parameter->room, parameter->count + 1,
		sizeof *parameter->text, "strings", tokens->error);
	parameter->text = list;
	if (status != SPEC_OK)
		return status;
	copy = spec_memory_text(token->text, token->length, tokens->error);
	if (!copy)
		return SPEC_ENOMEM;
	parameter->text[parameter->count++] = copy;
	return SPEC_OK;
}

/* Adds a value; the first one of a spectrum decides whether it is named or tabulated. */
static enum spec_status
parse_value(struct spec_tokens *tokens, struct spec_parameter *parameter,
	const struct spec_token *token)
{
	void *list = parameter->number;
	enum spec_status status;
	int named = parameter->count > 0 ? parameter->text != NULL
					 : token->kind == SPEC_TOKEN_STRING;

	if (parameter->type == SPEC_STRING || parameter->type == SPEC_TEXTURE ||
		(parameter->type == SPEC_SPECTRUM && named))
		return parse_text(tokens, parameter, token);
	status = spec_memory_grow(&list, &parameter->room, parameter->count + 1,
		sizeof *parameter->number, "numbers", tokens->error);
	parameter->number = list;
	if (status == SPEC_OK)
		status = parse_number(
			tokens, parameter, token, &parameter->number[parameter->count]);
	if (status == SPEC_OK)
		parameter->count++;
	return status;
}

/* One value, or some in brackets. */
static enum spec_status
parse_values(struct spec_tokens *tokens, struct spec_parameter *parameter)
{
	struct spec_token token;
	enum spec_status status = spec_tokens_next(tokens, &token);
	int many = status == SPEC_OK && token.kind == SPEC_TOKEN_OPEN;

	if (many)
		status = spec_tokens_next(tokens, &token);
	while (status == SPEC_OK && !(many && token.kind == SPEC_TOKEN_CLOSE)) {
		if (token.kind != SPEC_TOKEN_WORD && token.kind != SPEC_TOKEN_STRING)
			return spec_scene_fail(tokens->scene, &token.place, tokens->error,
				SPEC_EFORMAT, "a value of '%.60s'%s is missing here",
				parameter->name, many ? " or a ]" : "");
		status = parse_value(tokens, parameter, &token);
		if (status != SPEC_OK || !many)
			return status;
		status = spec_tokens_next(tokens, &token);
	}
	if (status == SPEC_OK && parameter->count == 0)
		status = spec_scene_fail(tokens->scene, &parameter->place, tokens->error,
			SPEC_EFORMAT, "'%.60s' has no value", parameter->name);
	return status;
}

enum spec_status
spec_parameters_parse(struct spec_tokens *tokens, struct spec_parameters *parameters)
{
	struct spec_token token;
	enum spec_status status = spec_tokens_next(tokens, &token);

	while (status == SPEC_OK && token.kind == SPEC_TOKEN_STRING) {
		void *list = parameters->list;
		struct spec_parameter *parameter;

		status = spec_memory_grow(&list, &parameters->room, parameters->count + 1,
			sizeof *parameters->list, "parameters", tokens->error);
		parameters->list = list;
		if (status != SPEC_OK)
			return status;
		parameter = &parameters->list[parameters->count++];
		*parameter = (struct spec_parameter){0};
		status = parse_declaration(tokens, &token, parameter);
		if (status == SPEC_OK)
			status = parse_values(tokens, parameter);
		if (status == SPEC_OK)
			status = spec_tokens_next(tokens, &token);
	}
	if (status == SPEC_OK)
		spec_tokens_unget(tokens, &token);
	return status;
}

/* ---- checking ---- */

const struct spec_scene_place *
spec_arguments_place(
	const struct spec_arguments *arguments, const struct spec_parameter *parameter)
{
	return parameter ? &parameter->place : &arguments->place;
}

enum spec_status
spec_arguments_blame(const struct spec_arguments *arguments,
	const struct spec_parameter *parameter, enum spec_status status)
{
	if (status != SPEC_OK)
		spec_scene_prefix(arguments->scene,
			spec_arguments_place(arguments, parameter), arguments->error);
	return status;
}

enum spec_status
spec_arguments_fail(const struct spec_arguments *arguments,
	const struct spec_parameter *parameter, enum spec_status status, const char *format,
	...)
{
	char cause[600], subject[160];
	va_list list;

	va_start(list, format);
	vsnprintf(cause, sizeof cause, format, list);
	va_end(list);
	if (parameter)
		snprintf(subject, sizeof subject, "'%.60s' of %s", parameter->name,
			arguments->statement);
	else
		snprintf(subject, sizeof subject, "%s", arguments->statement);
	return spec_scene_fail(arguments->scene, spec_arguments_place(arguments, parameter),
		arguments->error, status, "%s %s", subject, cause);
}

static const struct spec_expected *
find_expected(const struct spec_expected *expected, const char *name)
{
	for (; expected->name; expected++)
		if (strcmp(expected->name, name) == 0)
			return expected;
	return NULL;
}

static enum spec_status
fail_unknown(const struct spec_arguments *arguments, const struct spec_parameter *parameter,
	const struct spec_expected *expected)
{
	const char *nearest =
		spec_nearest_name(parameter->name, expected, sizeof *expected);

	return spec_scene_fail(arguments->scene, &parameter->place, arguments->error,
		SPEC_EFORMAT, "%s has no parameter '%.60s'%s%s%s", arguments->statement,
		parameter->name, nearest ? "; did you mean '" : "", nearest ? nearest : "",
		nearest ? "'?" : "");
}

static enum spec_status
fail_type(const struct spec_arguments *arguments, const struct spec_parameter *parameter,
	unsigned wanted)
{
	char list[200] = "";
	size_t end = 0;

	if (parameter->type == SPEC_TEXTURE)
		return spec_arguments_fail(arguments, parameter, SPEC_EUNSUPPORTED,
			"is a texture, and textures are not supported");
	/* Where any spectrum will do, pbrt's own types say so. */
	for (size_t i = 0; types[i].name; i++)
		if (wanted & types[i].type & ~(unsigned)SPEC_REPRESENTED)
			end += (size_t)snprintf(list + end, sizeof list - end, "%s%s",
				end > 0 ? " or " : "", types[i].name);
	return spec_arguments_fail(arguments, parameter, SPEC_EFORMAT,
		"is of type %s, not %s", list, type_name(parameter->type));
}

static enum spec_status
check(const struct spec_arguments *arguments, const struct spec_parameter *parameter,
	const struct spec_expected *row)
{
	if (row->use == SPEC_UNSUPPORTED)
		return spec_arguments_fail(arguments, parameter, SPEC_EUNSUPPORTED,
			"is not supported%s%s", row->hint ? ": " : "",
			row->hint ? row->hint : "");
	if (row->use == SPEC_TAKEN && !(row->types & parameter->type))
		return fail_type(arguments, parameter, row->types);
	if (row->use == SPEC_WARNED)
		return spec_scene_warn(arguments->scene, &parameter->place,
			arguments->error, "'%s' of %s is not used%s%s", parameter->name,
			arguments->statement, row->hint ? ": " : "",
			row->hint ? row->hint : "");
	return SPEC_OK;
}

static int
is_own(const struct spec_arguments *arguments, const struct spec_parameter *parameter)
{
	for (size_t i = 0; i < arguments->own->count; i++)
		if (parameter == &arguments->own->list[i])
			return 1;
	return 0;
}

enum spec_status
spec_arguments_check(
	const struct spec_arguments *arguments, const struct spec_expected *expected)
{
	const struct spec_parameters *own = arguments->own;
	enum spec_status status = SPEC_OK;

	for (size_t i = 0; i < own->count && status == SPEC_OK; i++) {
		const struct spec_parameter *parameter = &own->list[i];
		const struct spec_expected *row = find_expected(expected, parameter->name);

		if (!row)
			return fail_unknown(arguments, parameter, expected);
		for (size_t j = 0; j < i; j++)
			if (strcmp(own->list[j].name, parameter->name) == 0)
				return spec_arguments_fail(arguments, parameter,
					SPEC_EFORMAT, "is given twice");
		status = check(arguments, parameter, row);
	}
	for (; arguments->inherited && expected->name && status == SPEC_OK; expected++) {
		const struct spec_parameter *parameter =
			spec_arguments_find(arguments, expected->name);

		if (parameter && !is_own(arguments, parameter))
			status = check(arguments, parameter, expected);
	}
	return status;
}

/* ---- asking ---- */

const struct spec_parameter *
spec_arguments_find(const struct spec_arguments *arguments, const char *name)
{
	const struct spec_parameters *lists[] = {arguments->own, arguments->inherited};

	for (int i = 0; i < 2; i++) {
		/* The last one holds. */
		for (size_t j = lists[i] ? lists[i]->count : 0; j > 0; j--)
			if (strcmp(lists[i]->list[j - 1].name, name) == 0)
				return &lists[i]->list[j - 1];
	}
	return NULL;
}

static enum spec_status
check_count(const struct spec_arguments *arguments, const struct spec_parameter *parameter,
	size_t count)
{
	if (parameter->count == count)
		return SPEC_OK;
	return spec_arguments_fail(arguments, parameter, SPEC_EFORMAT,
		"takes %zu value%s, not %zu", count, count == 1 ? "" : "s",
		parameter->count);
}

enum spec_status
spec_arguments_only(
	const struct spec_arguments *arguments, const struct spec_parameter *parameter)
{
	return check_count(arguments, parameter, 1);
}

enum spec_status
spec_arguments_numbers(const struct spec_arguments *arguments, const char *name,
	size_t count, double *value)
{
	const struct spec_parameter *parameter = spec_arguments_find(arguments, name);
	enum spec_status status =
		parameter ? check_count(arguments, parameter, count) : SPEC_OK;

	if (parameter && status == SPEC_OK)
		memcpy(value, parameter->number, count * sizeof *value);
	return status;
}

enum spec_status
spec_arguments_number(const struct spec_arguments *arguments, const char *name,
	double minimum, double maximum, double *value)
{
	double number = minimum;
	enum spec_status status = spec_arguments_numbers(arguments, name, 1, &number);
	const struct spec_parameter *parameter = spec_arguments_find(arguments, name);

	if (status != SPEC_OK || !parameter)
		return status;
	if (number >= minimum && number <= maximum) {
		*value = number;
		return SPEC_OK;
	}
	if (maximum == DBL_MAX)
		return spec_arguments_fail(arguments, parameter, SPEC_ERANGE,
			"is less than %g: %g", minimum, number);
	return spec_arguments_fail(arguments, parameter, SPEC_ERANGE,
		"is outside %g..%g: %g", minimum, maximum, number);
}

enum spec_status
spec_arguments_positive(
	const struct spec_arguments *arguments, const char *name, double *value)
{
	double number = 1;
	enum spec_status status = spec_arguments_numbers(arguments, name, 1, &number);
	const struct spec_parameter *parameter = spec_arguments_find(arguments, name);

	if (status != SPEC_OK || !parameter)
		return status;
	if (!(number > 0))
		return spec_arguments_fail(
			arguments, parameter, SPEC_ERANGE, "is not positive: %g", number);
	*value = number;
	return SPEC_OK;
}

enum spec_status
spec_arguments_whole(const struct spec_arguments *arguments, const char *name,
	long long minimum, long long maximum, long long *value)
{
	double number = (double)*value;
	enum spec_status status = spec_arguments_numbers(arguments, name, 1, &number);
	const struct spec_parameter *parameter = spec_arguments_find(arguments, name);

	if (status != SPEC_OK || !parameter)
		return status;
	if (!(number >= (double)minimum && number <= (double)maximum))
		return spec_arguments_fail(arguments, parameter, SPEC_ERANGE,
			"is outside %lld..%lld: %.0f", minimum, maximum, number);
	*value = (long long)number;
	return SPEC_OK;
}

enum spec_status
spec_arguments_flag(const struct spec_arguments *arguments, const char *name, int *value)
{
	double number = *value;
	enum spec_status status = spec_arguments_numbers(arguments, name, 1, &number);

	*value = number != 0;
	return status;
}

enum spec_status
spec_arguments_text(
	const struct spec_arguments *arguments, const char *name, const char **text)
{
	const struct spec_parameter *parameter = spec_arguments_find(arguments, name);
	enum spec_status status =
		parameter ? spec_arguments_only(arguments, parameter) : SPEC_OK;

	*text = parameter && status == SPEC_OK ? parameter->text[0] : NULL;
	return status;
}
