#include "compare/expression.h"

#include <math.h>
#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "base/memory.h"
#include "base/nearest.h"
#include "base/number.h"

#define BLANKS " \t\r\n"
#define LETTERS "abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ_"
#define DIGITS "0123456789"
#define LAST_LETTER 'w' /* x and y are the pixel */
#define LONGEST_QUOTED 40
#define MOST_NAMES 64

/* What was assigned: the bytes of its name in the text, and its node. */
struct variable {
	const char *name;
	size_t length, node;
};

/* text[at] is the next byte to look at; the functions below leave it at no blank. */
struct parser {
	struct spec_expression *expression;
	const char *text;
	size_t at, room, images, depth;
	struct variable variable[MOST_NAMES];
	size_t variables;
	struct spec_error *error;
};

/* A name in the text; length 0: there is none. */
struct word {
	const char *text;
	size_t at, length;
};

static const struct {
	const char *name;
	enum spec_expression_place place;
} places[] = {
	{"nm", SPEC_PLACE_NM},
	{"stokes", SPEC_PLACE_STOKES},
	{"width", SPEC_PLACE_WIDTH},
	{"height", SPEC_PLACE_HEIGHT},
	{"bands", SPEC_PLACE_BANDS},
	{"x", SPEC_PLACE_X},
	{"y", SPEC_PLACE_Y},
	{0},
};

static enum spec_status parse_choice(struct parser *parser, size_t *node);
static enum spec_status parse_sign(struct parser *parser, size_t *node);

static int
quoted_length(size_t length)
{
	return (int)(length < LONGEST_QUOTED ? length : LONGEST_QUOTED);
}

/* The error that something else than what stands at text[at] must come here. */
static enum spec_status
fail_expected(const struct parser *parser, const char *what)
{
	const char *found = parser->text + parser->at;
	size_t length = strspn(found, LETTERS DIGITS);

	if (*found == '\0')
		return spec_error_set_at(parser->error, parser->text, parser->at,
			"expected %s, but the expression ends", what);
	if (length == 0) /* one character, which may have several bytes */
		for (length = 1; ((unsigned char)found[length] & 0xc0) == 0x80;)
			length++;
	return spec_error_set_at(parser->error, parser->text, parser->at,
		"expected %s, not '%.*s'", what, quoted_length(length), found);
}

static void
skip_blanks(struct parser *parser)
{
	parser->at += strspn(parser->text + parser->at, BLANKS);
}

/* Takes a token and the blanks after it, if it is there; "<" is not the start of "<=". */
static int
take_token(struct parser *parser, const char *token)
{
	const char *text = parser->text + parser->at;
	size_t length = strlen(token);

	if (strncmp(text, token, length) != 0)
		return 0;
	if (length == 1 && strchr("<>=!", token[0]) && text[1] == '=')
		return 0;
	parser->at += length;
	skip_blanks(parser);
	return 1;
}

static struct word
take_word(struct parser *parser)
{
	const char *text = parser->text + parser->at;
	struct word word = {text, parser->at, 0};

	if (strspn(text, LETTERS) > 0)
		word.length = strspn(text, LETTERS DIGITS);
	parser->at += word.length;
	return word;
}

static int
is_word(struct word word, const char *name)
{
	return strlen(name) == word.length && strncmp(word.text, name, word.length) == 0;
}

/* --- nodes --- */

static enum spec_status
add_node(struct parser *parser, const struct spec_node *node, size_t *index)
{
	struct spec_expression *expression = parser->expression;
	void *list = expression->node;
	enum spec_status status;

	if (expression->count == SPEC_EXPRESSION_MOST_NODES)
		return spec_error_set_at(parser->error, parser->text, node->at,
			"the expression has more than %d parts",
			SPEC_EXPRESSION_MOST_NODES);
	status = spec_memory_grow(&list, &parser->room, expression->count + 1, sizeof *node,
		"nodes", parser->error);
	expression->node = list;
	if (status != SPEC_OK)
		return status;
	*index = expression->count;
	expression->node[expression->count++] = *node;
	return SPEC_OK;
}

/* As add_node, but what reads the same sample is one node. */
static enum spec_status
add_leaf(struct parser *parser, const struct spec_node *leaf, size_t *index)
{
	const struct spec_expression *expression = parser->expression;

	for (*index = 0; *index < expression->count; ++*index) {
		const struct spec_node *known = &expression->node[*index];

		if (known->kind == leaf->kind && known->place == leaf->place &&
			known->image == leaf->image)
			return SPEC_OK;
	}
	return add_node(parser, leaf, index);
}

static enum spec_status
add_call(struct parser *parser, const struct spec_function *function, size_t at,
	const size_t *operand, size_t *index)
{
	struct spec_node node = {.kind = SPEC_NODE_CALL, .at = at, .function = function};

	memcpy(node.operand, operand, (size_t)function->operands * sizeof *operand);
	return add_node(parser, &node, index);
}

/* --- names --- */

/* The image that a name means, from 0; 0: it means none. */
static int
find_image(struct word word, size_t *image)
{
	size_t digits = word.length - 5;

	*image = 0;
	if (word.length == 1 && word.text[0] >= 'a' && word.text[0] <= LAST_LETTER) {
		*image = (size_t)(word.text[0] - 'a');
		return 1;
	}
	if (word.length < 6 || word.length > 9 || strncmp(word.text, "image", 5) != 0 ||
		strspn(word.text + 5, DIGITS) < digits || word.text[5] == '0')
		return 0;
	for (size_t i = 0; i < digits; i++)
		*image = *image * 10 + (size_t)(word.text[5 + i] - '0');
	--*image;
	return 1;
}

static struct variable *
find_variable(struct parser *parser, struct word word)
{
	for (size_t i = 0; i < parser->variables; i++) {
		if (parser->variable[i].length == word.length &&
			strncmp(parser->variable[i].name, word.text, word.length) == 0)
			return &parser->variable[i];
	}
	return NULL;
}

static const struct spec_function *
find_function(struct word word)
{
	char name[16];

	if (word.length >= sizeof name)
		return NULL;
	memcpy(name, word.text, word.length);
	name[word.length] = '\0';
	return spec_function_named(name);
}

static enum spec_status
fail_unknown(const struct parser *parser, struct word word)
{
	char name[SPEC_NEAREST_LONGEST + 1];
	const char *near = NULL;

	if (word.length < sizeof name) {
		memcpy(name, word.text, word.length);
		name[word.length] = '\0';
		near = spec_nearest_name(name, spec_functions, sizeof *spec_functions);
		if (!near)
			near = spec_nearest_name(name, places, sizeof *places);
	}
	if (near)
		return spec_error_set_at(parser->error, parser->text, word.at,
			"'%.*s' is not known; did you mean '%s'?",
			quoted_length(word.length), word.text, near);
	return spec_error_set_at(parser->error, parser->text, word.at,
		"'%.*s' is not known", quoted_length(word.length), word.text);
}

/* --- values --- */

/* ("NAME") or NAME, behind the point. */
static enum spec_status
take_channel(struct parser *parser, char **channel)
{
	const char *text = parser->text + parser->at;
	size_t start = parser->at, length = strspn(text, LETTERS DIGITS "."), end = 0;

	if (length > 0) {
		*channel = spec_memory_text(text, length, parser->error);
		parser->at += length;
		skip_blanks(parser);
		return *channel ? SPEC_OK : SPEC_ENOMEM;
	}
	if (!take_token(parser, "(") || parser->text[parser->at] != '"') {
		parser->at = start;
		return fail_expected(parser, "the name of a channel");
	}
	text = parser->text + ++parser->at;
	*channel = spec_memory_text(text, strlen(text), parser->error);
	if (!*channel)
		return SPEC_ENOMEM;
	for (length = 0; text[end] && text[end] != '"'; end++) {
		end += text[end] == '\\' && text[end + 1];
		(*channel)[length++] = text[end];
	}
	(*channel)[length] = '\0';
	if (text[end] == '\0')
		return spec_error_set_at(parser->error, parser->text, parser->at - 1,
			"a '\"' without another");
	parser->at += end + 1;
	skip_blanks(parser);
	return take_token(parser, ")") ? SPEC_OK : fail_expected(parser, "')'");
}

/* What may follow an image: (WAVELENGTH) or .CHANNEL. */
static enum spec_status
parse_image(struct parser *parser, struct word word, size_t image, size_t *index)
{
	struct spec_node node = {.kind = SPEC_NODE_SAMPLE, .at = word.at, .image = image};
	enum spec_status status;

	if (image >= parser->images)
		return spec_error_set_at(parser->error, parser->text, word.at,
			"there is no image '%.*s': %zu %s given", (int)word.length,
			word.text, parser->images, parser->images == 1 ? "is" : "are");
	if (take_token(parser, ".")) {
		node.kind = SPEC_NODE_CHANNEL;
		status = take_channel(parser, &node.channel);
		if (status == SPEC_OK)
			status = add_node(parser, &node, index);
		if (status != SPEC_OK)
			free(node.channel);
		return status;
	}
	if (!take_token(parser, "("))
		return add_leaf(parser, &node, index);
	node.kind = SPEC_NODE_AT;
	status = parse_choice(parser, &node.operand[0]);
	if (status == SPEC_OK && !take_token(parser, ")"))
		status = fail_expected(parser, "')'");
	return status == SPEC_OK ? add_node(parser, &node, index) : status;
}

static enum spec_status
parse_more(struct parser *parser, const struct spec_function *function, struct word word,
	size_t *index)
{
	enum spec_status status = SPEC_OK;

	while (status == SPEC_OK && function->repeats && take_token(parser, ",")) {
		size_t operand[SPEC_FUNCTION_OPERANDS] = {*index};

		status = parse_choice(parser, &operand[1]);
		if (status == SPEC_OK)
			status = add_call(parser, function, word.at, operand, index);
	}
	return status;
}

static enum spec_status
parse_function(struct parser *parser, const struct spec_function *function,
	struct word word, size_t *index)
{
	size_t operand[SPEC_FUNCTION_OPERANDS] = {0};
	struct spec_node wavelength = {
		.kind = SPEC_NODE_PLACE, .at = word.at, .place = SPEC_PLACE_NM};
	enum spec_status status = SPEC_OK;
	int taken = 0;

	if (!take_token(parser, "("))
		return fail_expected(parser, "'(' after the function");
	if (strcmp(function->name, "planck") == 0)
		status = add_leaf(parser, &wavelength, &operand[taken++]);
	for (int first = taken; taken < function->operands && status == SPEC_OK; taken++) {
		if (taken > first && !take_token(parser, ","))
			return fail_expected(parser, "',' and another operand");
		status = parse_choice(parser, &operand[taken]);
	}
	if (status == SPEC_OK)
		status = add_call(parser, function, word.at, operand, index);
	if (status == SPEC_OK)
		status = parse_more(parser, function, word, index);
	if (status == SPEC_OK && !take_token(parser, ")"))
		status = fail_expected(parser, "')'");
	return status;
}

/*
 * Whether a word is "b750", of one image its value at that wavelength [nm]; digits
 * behind a point belong to it.
 */
static int
take_band(struct parser *parser, struct word word, double *wavelength_nm)
{
	size_t length;

	if (parser->images != 1 || word.length < 2 || word.text[0] != 'b' ||
		strspn(word.text + 1, DIGITS) < word.length - 1)
		return 0;
	length = spec_number_scan(word.text + 1, '.', wavelength_nm);
	parser->at = word.at + 1 + length;
	skip_blanks(parser);
	return length > 0;
}

static enum spec_status
parse_band(struct parser *parser, struct word word, double wavelength_nm, size_t *index)
{
	struct spec_node node = {.at = word.at, .number = wavelength_nm};
	enum spec_status status = add_node(parser, &node, &node.operand[0]);

	node.kind = SPEC_NODE_AT;
	return status == SPEC_OK ? add_node(parser, &node, index) : status;
}

static enum spec_status
parse_name(struct parser *parser, size_t *index)
{
	struct word word = take_word(parser);
	struct spec_node node = {.at = word.at, .kind = SPEC_NODE_PLACE};
	const struct spec_function *function = find_function(word);
	const struct variable *variable = find_variable(parser, word);
	double wavelength_nm;
	size_t image;

	skip_blanks(parser);
	if (variable) {
		*index = variable->node;
		return SPEC_OK;
	}
	if (function)
		return parse_function(parser, function, word, index);
	if (find_image(word, &image))
		return parse_image(parser, word, image, index);
	if (is_word(word, "pi")) {
		node.kind = SPEC_NODE_NUMBER;
		node.number = M_PI;
		return add_node(parser, &node, index);
	}
	for (size_t i = 0; places[i].name; i++) {
		node.place = places[i].place;
		if (is_word(word, places[i].name))
			return add_leaf(parser, &node, index);
	}
	if (take_band(parser, word, &wavelength_nm))
		return parse_band(parser, word, wavelength_nm, index);
	return fail_unknown(parser, word);
}

/* A number, in nm where it has a unit. */
static enum spec_status
parse_number(struct parser *parser, size_t *index)
{
	struct spec_node node = {.kind = SPEC_NODE_NUMBER, .at = parser->at};
	struct word unit;
	size_t length = spec_number_scan(parser->text + parser->at, '.', &node.number);

	if (length == 0)
		return fail_expected(parser, "a number");
	parser->at += length;
	unit = take_word(parser);
	if (is_word(unit, "um"))
		node.number *= 1e3;
	else if (unit.length > 0 && !is_word(unit, "nm"))
		return spec_error_set_at(parser->error, parser->text, unit.at,
			"expected an operator, not '%.*s'", quoted_length(unit.length),
			unit.text);
	skip_blanks(parser);
	return add_node(parser, &node, index);
}

static enum spec_status
parse_value(struct parser *parser, size_t *index)
{
	const char *text = parser->text + parser->at;
	size_t start = parser->at;
	enum spec_status status;

	if (strspn(text, DIGITS ".") > 0)
		return parse_number(parser, index);
	if (strspn(text, LETTERS) > 0)
		return parse_name(parser, index);
	if (!take_token(parser, "("))
		return fail_expected(parser, "a value");
	status = parse_choice(parser, index);
	if (status == SPEC_OK && parser->text[parser->at] == '\0')
		return spec_error_set_at(
			parser->error, parser->text, start, "a '(' without a ')'");
	if (status == SPEC_OK && !take_token(parser, ")"))
		status = fail_expected(parser, "an operator or ')'");
	return status;
}

/* --- operators --- */

static enum spec_status
fail_too_deep(const struct parser *parser, size_t at)
{
	return spec_error_set_at(parser->error, parser->text, at,
		"more than %d parts lie in each other", SPEC_EXPRESSION_DEEPEST);
}

static enum spec_status
parse_power(struct parser *parser, size_t *index)
{
	size_t operand[SPEC_FUNCTION_OPERANDS] = {0}, at;
	enum spec_status status = parse_value(parser, index);

	operand[0] = *index;
	at = parser->at;
	if (status != SPEC_OK || !take_token(parser, "^"))
		return status;
	status = parse_sign(parser, &operand[1]);
	return status == SPEC_OK ? add_call(parser, spec_function_operator("^", 2), at,
					   operand, index)
				 : status;
}

/* All that stands in parentheses comes through here. */
static enum spec_status
parse_sign(struct parser *parser, size_t *index)
{
	static const char *const signs[] = {"-", "!", "+"};
	size_t at = parser->at, operand[SPEC_FUNCTION_OPERANDS] = {0};
	enum spec_status status;
	int sign = 0;

	if (++parser->depth > SPEC_EXPRESSION_DEEPEST)
		return fail_too_deep(parser, at);
	while (sign < 3 && !take_token(parser, signs[sign]))
		sign++;
	status = sign < 3 ? parse_sign(parser, index) : parse_power(parser, index);
	operand[0] = *index;
	if (status == SPEC_OK && sign < 2)
		status = add_call(
			parser, spec_function_operator(signs[sign], 1), at, operand, index);
	parser->depth--;
	return status;
}

/* The operators of two operands, the loosest first. */
static const char *const levels[][7] = {
	{"||"},
	{"&&"},
	{"<=", ">=", "==", "!=", "<", ">"},
	{"+", "-"},
	{"*", "/"},
};

enum { LEVELS = sizeof levels / sizeof levels[0], COMPARISONS = 2 };

static const char *
take_operator(struct parser *parser, int level)
{
	for (const char *const *name = levels[level]; *name; name++) {
		if (take_token(parser, *name))
			return *name;
	}
	return NULL;
}

static enum spec_status
parse_level(struct parser *parser, int level, size_t *index)
{
	size_t at, operand[SPEC_FUNCTION_OPERANDS] = {0};
	const char *name;
	enum spec_status status;
	int times = 0;

	if (level == LEVELS)
		return parse_sign(parser, index);
	status = parse_level(parser, level + 1, index);
	while (status == SPEC_OK) {
		at = parser->at;
		name = take_operator(parser, level);
		if (!name)
			break;
		if (level == COMPARISONS && times++ > 0)
			return spec_error_set_at(parser->error, parser->text, at,
				"comparisons do not follow one another (&&)");
		operand[0] = *index;
		status = parse_level(parser, level + 1, &operand[1]);
		if (status == SPEC_OK)
			status = add_call(parser, spec_function_operator(name, 2), at,
				operand, index);
	}
	return status;
}

/* What comes after a condition, operand[0]. at: where the "?" stood. */
static enum spec_status
parse_branches(struct parser *parser, size_t at, size_t *operand, size_t *index)
{
	enum spec_status status;

	if (++parser->depth > SPEC_EXPRESSION_DEEPEST)
		return fail_too_deep(parser, at);
	status = parse_choice(parser, &operand[1]);
	if (status == SPEC_OK && !take_token(parser, ":"))
		status = fail_expected(parser, "':' and what holds otherwise");
	if (status == SPEC_OK)
		status = parse_choice(parser, &operand[2]);
	parser->depth--;
	return status == SPEC_OK
		       ? add_call(parser, spec_function_named("if"), at, operand, index)
		       : status;
}

static enum spec_status
parse_choice(struct parser *parser, size_t *index)
{
	size_t operand[SPEC_FUNCTION_OPERANDS] = {0}, at;
	enum spec_status status = parse_level(parser, 0, index);

	operand[0] = *index;
	at = parser->at;
	if (status != SPEC_OK || !take_token(parser, "?"))
		return status;
	return parse_branches(parser, at, operand, index);
}

/* --- statements --- */

/* Whether "NAME =" comes next; then it is taken. */
static int
take_assignment(struct parser *parser, struct word *word)
{
	size_t start = parser->at;

	*word = take_word(parser);
	skip_blanks(parser);
	if (word->length > 0 && take_token(parser, "="))
		return 1;
	parser->at = start;
	return 0;
}

static enum spec_status
check_free(struct parser *parser, struct word word)
{
	size_t image;
	int taken = find_function(word) != NULL || is_word(word, "pi");

	for (size_t i = 0; places[i].name; i++)
		taken |= is_word(word, places[i].name);
	if (find_image(word, &image) && image < parser->images)
		return spec_error_set_at(parser->error, parser->text, word.at,
			"'%.*s' is an image", (int)word.length, word.text);
	if (taken)
		return spec_error_set_at(parser->error, parser->text, word.at,
			"'%.*s' has a meaning already", (int)word.length, word.text);
	return SPEC_OK;
}

static enum spec_status
parse_assignment(struct parser *parser, struct word word)
{
	struct variable *variable = find_variable(parser, word);
	enum spec_status status = check_free(parser, word);
	size_t node = 0;

	if (status == SPEC_OK)
		status = parse_choice(parser, &node);
	if (status != SPEC_OK)
		return status;
	if (!variable && parser->variables == MOST_NAMES)
		return spec_error_set_at(parser->error, parser->text, word.at,
			"more than %d names", MOST_NAMES);
	if (!variable)
		variable = &parser->variable[parser->variables++];
	*variable = (struct variable){word.text, word.length, node};
	return take_token(parser, ";") ? SPEC_OK
				       : fail_expected(parser, "an operator or ';'");
}

static enum spec_status
parse_statements(struct parser *parser)
{
	enum spec_status status = SPEC_OK;
	struct word word;

	skip_blanks(parser);
	while (status == SPEC_OK && take_assignment(parser, &word))
		status = parse_assignment(parser, word);
	if (status == SPEC_OK)
		status = parse_choice(parser, &parser->expression->result);
	if (status == SPEC_OK)
		(void)take_token(parser, ";");
	if (status == SPEC_OK && parser->text[parser->at] != '\0')
		status = fail_expected(parser, "an operator or the end");
	return status;
}

enum spec_status
spec_expression_parse(const char *text, size_t images, struct spec_expression *expression,
	struct spec_error *error)
{
	struct parser parser = {
		.expression = expression, .text = text, .images = images, .error = error};
	enum spec_status status = SPEC_ENOMEM;

	*expression = (struct spec_expression){0};
	expression->text = spec_memory_text(text, strlen(text), error);
	if (expression->text)
		status = parse_statements(&parser);
	if (status != SPEC_OK)
		spec_expression_free(expression);
	return status;
}

void
spec_expression_free(struct spec_expression *expression)
{
	for (size_t i = 0; i < expression->count; i++)
		free(expression->node[i].channel);
	free(expression->node);
	free(expression->text);
	*expression = (struct spec_expression){0};
}
