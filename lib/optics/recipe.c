#include "optics/recipe.h"

#include <math.h>
#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "base/memory.h"
#include "base/number.h"

#define BLANKS " \t\r\n"
#define DELIMITERS BLANKS "|()^"
#define LONGEST_QUOTED 40 /* bytes of what was found instead */

struct group {
	size_t at;    /* where its parenthesis stands */
	size_t layer; /* its first */
};

/* text[at] is the next byte to look at; the functions below leave it at no blank. */
struct parser {
	struct spec_recipe *recipe;
	const char *text;
	size_t at;
	size_t media_room, layer_room;
	struct group group[SPEC_RECIPE_DEEPEST]; /* those that are open */
	size_t depth;
	struct spec_error *error;
};

struct word {
	size_t at, length; /* length 0: there is none */
};

/* Turns an error of another module into one at a byte of the text. */
static enum spec_status
fail_again(const struct parser *parser, size_t at)
{
	if (parser->error)
		parser->error->status = SPEC_EUSAGE;
	spec_error_point(parser->error, parser->text, at);
	return SPEC_EUSAGE;
}

/* How much of a text that is too long to be quoted whole: whole UTF-8 characters. */
static int
quoted_length(const char *text, size_t length)
{
	if (length <= LONGEST_QUOTED)
		return (int)length;
	length = LONGEST_QUOTED;
	while (length > 0 && ((unsigned char)text[length] & 0xc0) == 0x80)
		length--;
	return (int)length;
}

/* The error that something else than what stands at text[at] must come here. */
static enum spec_status
fail_expected(const struct parser *parser, const char *what)
{
	const char *found = parser->text + parser->at;
	size_t length = strcspn(found, DELIMITERS);

	if (*found == '\0' && parser->depth > 0)
		return spec_error_set_at(parser->error, parser->text,
			parser->group[parser->depth - 1].at, "a '(' without a ')'");
	if (*found == ')' && parser->depth == 0)
		return spec_error_set_at(
			parser->error, parser->text, parser->at, "a ')' without a '('");
	if (*found == '\0')
		return spec_error_set_at(parser->error, parser->text, parser->at,
			"expected %s, but the stack ends", what);
	return spec_error_set_at(parser->error, parser->text, parser->at,
		"expected %s, not '%.*s'", what, length ? quoted_length(found, length) : 1,
		found);
}

static void
skip_blanks(struct parser *parser)
{
	parser->at += strspn(parser->text + parser->at, BLANKS);
}

/* Takes a byte and the blanks after it, if it is there. */
static int
take_byte(struct parser *parser, char byte)
{
	if (parser->text[parser->at] != byte)
		return 0;
	parser->at++;
	skip_blanks(parser);
	return 1;
}

/* Takes a word and the blanks after it. */
static struct word
take_word(struct parser *parser)
{
	struct word word = {parser->at, strcspn(parser->text + parser->at, DELIMITERS)};

	parser->at += word.length;
	skip_blanks(parser);
	return word;
}

/* As take_word, and parentheses right after it, with all in them, belong to the word. */
static enum spec_status
take_name(struct parser *parser, struct word *name)
{
	const char *text = parser->text;
	size_t end = parser->at + strcspn(text + parser->at, DELIMITERS);

	while (end > parser->at && text[end] == '(') {
		size_t close = end + strcspn(text + end, ")|");

		if (text[close] != ')')
			return spec_error_set_at(
				parser->error, parser->text, end, "a '(' without a ')'");
		end = close + 1;
		end += strcspn(text + end, DELIMITERS);
	}
	*name = (struct word){parser->at, end - parser->at};
	parser->at = end;
	skip_blanks(parser);
	return SPEC_OK;
}

static int
is_star(const struct parser *parser, struct word word)
{
	return word.length == 1 && parser->text[word.at] == '*';
}

/* The number of a medium, which is read if the stack has not named it before. */
static enum spec_status
find_medium(struct parser *parser, struct word word, size_t *medium)
{
	struct spec_recipe *recipe = parser->recipe;
	const char *name = parser->text + word.at;
	struct spec_recipe_medium *fresh;
	enum spec_status status;

	for (*medium = 0; *medium < recipe->media; ++*medium) {
		const char *known = recipe->medium[*medium].name;

		if (strncmp(known, name, word.length) == 0 && known[word.length] == '\0')
			return SPEC_OK;
	}
	status = spec_memory_grow((void **)&recipe->medium, &parser->media_room,
		recipe->media + 1, sizeof *recipe->medium, "media", parser->error);
	if (status != SPEC_OK)
		return status;
	fresh = &recipe->medium[recipe->media++];
	fresh->at = word.at;
	fresh->layer = recipe->count;
	fresh->name = spec_memory_text(name, word.length, parser->error);
	return fresh->name ? spec_index_parse_part(parser->text, word.at, word.length,
				     &fresh->index, parser->error)
			   : SPEC_ENOMEM;
}

/* what: the noun for the error that none stands here. */
static enum spec_status
take_medium(struct parser *parser, const char *what, size_t *medium)
{
	size_t start = parser->at;
	struct word name = {0};
	enum spec_status status = take_name(parser, &name);

	if (status != SPEC_OK)
		return status;
	if (name.length == 0 || is_star(parser, name)) {
		parser->at = start;
		return fail_expected(parser, what);
	}
	return find_medium(parser, name, medium);
}

static enum spec_status
add_layer(struct parser *parser, size_t medium, double thickness_nm)
{
	struct spec_recipe *recipe = parser->recipe;
	enum spec_status status =
		spec_memory_grow((void **)&recipe->layer, &parser->layer_room,
			recipe->count + 1, sizeof *recipe->layer, "layers", parser->error);

	if (status == SPEC_OK)
		recipe->layer[recipe->count++] =
			(struct spec_recipe_layer){medium, thickness_nm};
	return status;
}

static enum spec_status
fail_too_many(const struct parser *parser, size_t at)
{
	return spec_error_set_at(parser->error, parser->text, at,
		"the stack has more than %d layers", SPEC_RECIPE_MOST_LAYERS);
}

static enum spec_status
parse_thickness(const struct parser *parser, struct word word, double *thickness_nm)
{
	char *text = spec_memory_text(parser->text + word.at, word.length, parser->error);
	enum spec_status status;

	if (!text)
		return SPEC_ENOMEM;
	status = spec_number_parse_thickness(
		text, "the thickness", thickness_nm, parser->error);
	if (status != SPEC_OK)
		status = fail_again(parser, word.at);
	else if (*thickness_nm > SPEC_RECIPE_THICKEST_NM)
		status = spec_error_set_at(parser->error, parser->text, word.at,
			"the thickness is more than 1 m: '%s'", text);
	free(text);
	return status;
}

/* Marks the layer that comes next as the one whose thickness is free. */
static enum spec_status
set_varied(struct parser *parser, size_t at)
{
	struct spec_recipe *recipe = parser->recipe;

	if (parser->depth > 0)
		return spec_error_set_at(parser->error, parser->text, at,
			"a layer in a group cannot have the thickness *");
	if (recipe->varied != 0)
		return spec_error_set_at(parser->error, parser->text, at,
			"only one layer can have the thickness *");
	recipe->varied = recipe->count;
	recipe->varied_at = at;
	return SPEC_OK;
}

/* A medium and its thickness; or, where the text ends after a medium, the substrate. */
static enum spec_status
take_layer(struct parser *parser, int *ended)
{
	size_t start = parser->at, medium;
	double thickness_nm = NAN;
	struct word word;
	enum spec_status status = take_medium(parser,
		parser->depth > 0 ? "a layer or a group"
				  : "a layer, a group or the substrate",
		&medium);

	if (status != SPEC_OK)
		return status;
	*ended = parser->depth == 0 && parser->text[parser->at] == '\0';
	if (*ended)
		return add_layer(parser, medium, 0);
	word = take_word(parser);
	if (word.length == 0)
		return fail_expected(parser, "a thickness");
	if (parser->depth == 0 && parser->text[parser->at] == '\0')
		return spec_error_set_at(parser->error, parser->text, word.at,
			"the last medium, the substrate, has no thickness");
	if (parser->recipe->count > SPEC_RECIPE_MOST_LAYERS)
		return fail_too_many(parser, start);
	if (is_star(parser, word))
		status = set_varied(parser, word.at);
	else
		status = parse_thickness(parser, word, &thickness_nm);
	return status == SPEC_OK ? add_layer(parser, medium, thickness_nm) : status;
}

static enum spec_status
open_group(struct parser *parser)
{
	if (parser->depth == SPEC_RECIPE_DEEPEST)
		return spec_error_set_at(parser->error, parser->text, parser->at,
			"more than %d groups lie in each other", SPEC_RECIPE_DEEPEST);
	parser->group[parser->depth++] = (struct group){parser->at, parser->recipe->count};
	take_byte(parser, '(');
	return SPEC_OK;
}

/* Writes out the layers from first on so many times. at: where an error points to. */
static enum spec_status
repeat_layers(struct parser *parser, size_t first, size_t times, size_t at)
{
	struct spec_recipe *recipe = parser->recipe;
	size_t layers = recipe->count - first;
	enum spec_status status;

	if (layers * (times - 1) > SPEC_RECIPE_MOST_LAYERS - (recipe->count - 1))
		return fail_too_many(parser, at);
	status = spec_memory_grow((void **)&recipe->layer, &parser->layer_room,
		first + layers * times, sizeof *recipe->layer, "layers", parser->error);
	for (; status == SPEC_OK && times > 1; times--) {
		memcpy(recipe->layer + recipe->count, recipe->layer + first,
			layers * sizeof *recipe->layer);
		recipe->count += layers;
	}
	return status;
}

/* What comes after the ')' of a group. */
static enum spec_status
close_group(struct parser *parser)
{
	size_t first = parser->group[--parser->depth].layer;
	struct word word;
	long long times;
	enum spec_status status;
	char *text;

	if (!take_byte(parser, '^'))
		return fail_expected(parser, "'^' and the number of repeats");
	word = take_word(parser);
	if (word.length == 0)
		return fail_expected(parser, "the number of repeats");
	text = spec_memory_text(parser->text + word.at, word.length, parser->error);
	if (!text)
		return SPEC_ENOMEM;
	status = spec_number_parse_whole(text, 1, SPEC_RECIPE_MOST_LAYERS,
		"the number of repeats", &times, parser->error);
	free(text);
	return status == SPEC_OK ? repeat_layers(parser, first, (size_t)times, word.at)
				 : fail_again(parser, word.at);
}

static enum spec_status
take_ambient(struct parser *parser)
{
	size_t medium;
	enum spec_status status;

	skip_blanks(parser);
	status = take_medium(parser, "the ambient medium", &medium);
	if (status == SPEC_OK)
		status = add_layer(parser, medium, 0);
	if (status != SPEC_OK || take_byte(parser, '|'))
		return status;
	if (strcspn(parser->text + parser->at, DELIMITERS) > 0)
		return spec_error_set_at(parser->error, parser->text, parser->at,
			"expected '|': the first medium, the ambient, has no thickness");
	return fail_expected(parser, "'|'");
}

static enum spec_status
parse_stack(struct parser *parser)
{
	enum spec_status status = take_ambient(parser);
	int ended = 0;

	while (status == SPEC_OK && !ended) {
		if (parser->text[parser->at] == '(') {
			status = open_group(parser);
			continue;
		}
		status = take_layer(parser, &ended);
		while (status == SPEC_OK && parser->depth > 0 && take_byte(parser, ')'))
			status = close_group(parser);
		if (status == SPEC_OK && !ended && !take_byte(parser, '|'))
			status = fail_expected(parser,
				parser->text[parser->at] ? "'|'" : "'|' and the substrate");
	}
	return status;
}

enum spec_status
spec_recipe_parse(const char *text, struct spec_recipe *recipe, struct spec_error *error)
{
	struct parser parser = {.recipe = recipe, .text = text, .error = error};
	enum spec_status status = SPEC_ENOMEM;

	*recipe = (struct spec_recipe){0};
	recipe->text = spec_memory_text(text, strlen(text), error);
	if (recipe->text)
		status = parse_stack(&parser);
	if (status != SPEC_OK)
		spec_recipe_free(recipe);
	return status;
}

void
spec_recipe_free(struct spec_recipe *recipe)
{
	if (!recipe)
		return;
	for (size_t i = 0; i < recipe->media; i++) {
		free(recipe->medium[i].name);
		spec_index_free(&recipe->medium[i].index);
	}
	free(recipe->medium);
	free(recipe->layer);
	free(recipe->text);
	*recipe = (struct spec_recipe){0};
}

size_t
spec_recipe_layers(const struct spec_recipe *recipe)
{
	return recipe->count - 2;
}

enum spec_status
spec_recipe_find_varied(
	const struct spec_recipe *recipe, size_t *layer, struct spec_error *error)
{
	size_t layers = spec_recipe_layers(recipe);

	*layer = recipe->varied ? recipe->varied : 1;
	if (recipe->varied || layers == 1)
		return SPEC_OK;
	if (layers == 0)
		return spec_error_set(error, SPEC_EUSAGE,
			"the stack has no layer whose thickness --thickness could set");
	return spec_error_set(error, SPEC_EUSAGE,
		"the stack has %zu layers; write * for the thickness of the one that "
		"--thickness sets",
		layers);
}

enum spec_status
spec_recipe_check_fixed(const struct spec_recipe *recipe, struct spec_error *error)
{
	if (recipe->varied == 0)
		return SPEC_OK;
	spec_error_set(error, SPEC_EUSAGE,
		"the thickness of layer %zu is *, and none is given for it",
		recipe->varied);
	spec_error_point(error, recipe->text, recipe->varied_at);
	return SPEC_EUSAGE;
}

enum spec_status
spec_recipe_sample(const struct spec_recipe *recipe, const double *wavelength_nm,
	size_t count, enum spec_extrapolate extrapolate, double *n, double *k,
	struct spec_error *error)
{
	for (size_t i = 0; i < recipe->count; i++) {
		const struct spec_recipe_medium *medium =
			&recipe->medium[recipe->layer[i].medium];
		size_t from = medium->layer * count, to = i * count;
		enum spec_status status;

		if (medium->layer < i) {
			memcpy(n + to, n + from, count * sizeof *n);
			memcpy(k + to, k + from, count * sizeof *k);
			continue;
		}
		status = spec_index_sample(&medium->index, wavelength_nm, count,
			extrapolate, n + to, k + to, error);
		if (status != SPEC_OK) {
			spec_error_prefix(error, "medium '%.200s'", medium->name);
			spec_error_point(error, recipe->text, medium->at);
			return status;
		}
	}
	return SPEC_OK;
}
