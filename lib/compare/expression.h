/*
 * Expressions on the bands of images, "a.A > 0 ? a / a.A : b(nm + 20)", are read once, into
 * nodes. compare/program.h makes of these what is run on rows of pixels.
 *
 *   program    = { name "=" choice ";" } choice [ ";" ]
 *   choice     = or [ "?" choice ":" choice ]
 *   or         = and { "||" and }
 *   and        = comparison { "&&" comparison }
 *   comparison = sum [ ( "<" | "<=" | ">" | ">=" | "==" | "!=" ) sum ]
 *   sum        = product { ( "+" | "-" ) product }
 *   product    = sign { ( "*" | "/" ) sign }
 *   sign       = [ "-" | "+" | "!" ] sign | power
 *   power      = value [ "^" sign ]
 *   value      = number [ "nm" | "um" ] | "(" choice ")" | name | image | "b" digits
 *              | function "(" choice { "," choice } ")"
 *   image      = ( letter | "image" whole ) [ "(" choice ")" | "." channel ]
 *   channel    = letters, digits, "_" and "." | "(" '"' text '"' ")"
 *
 * Images are a to w, or image1, image2, ...: the value of an image in the band that is worked
 * on; with a wavelength in nm in parentheses, its value there; with a point, that of a channel
 * by its name, in whose quotes \" and \\ are " and \. Of one image alone, b750 is a(750), and
 * b532.5 is a(532.5), as long as no name is assigned so. Other names are
 *   nm                   wavelength of the band that is worked on
 *   stokes               its component, 0 to 3
 *   x, y                 pixel, from the data window's corner
 *   width, height        of the data window
 *   bands                of the result
 *   pi
 *   those of functions, compare/function.h, and those that were assigned.
 */
#ifndef SPEC_COMPARE_EXPRESSION_H
#define SPEC_COMPARE_EXPRESSION_H

#include <stddef.h>

#include "base/error.h"
#include "compare/function.h"

#define SPEC_EXPRESSION_MOST_NODES 4096
#define SPEC_EXPRESSION_DEEPEST 100 /* parentheses and the like in each other */

enum spec_node_kind {
	SPEC_NODE_NUMBER,
	SPEC_NODE_PLACE,   /* of the pixel or the band */
	SPEC_NODE_SAMPLE,  /* an image in the band that is worked on */
	SPEC_NODE_AT,      /* an image at the wavelength operand[0] */
	SPEC_NODE_CHANNEL, /* a channel of an image */
	SPEC_NODE_CALL
};

enum spec_expression_place {
	SPEC_PLACE_NM,
	SPEC_PLACE_STOKES,
	SPEC_PLACE_WIDTH,
	SPEC_PLACE_HEIGHT,
	SPEC_PLACE_BANDS,
	SPEC_PLACE_X,
	SPEC_PLACE_Y
};

struct spec_node {
	enum spec_node_kind kind;
	size_t at; /* the byte of the text that it begins at, or its operator */
	double number;
	enum spec_expression_place place;
	size_t image;
	char *channel;
	const struct spec_function *function;
	size_t operand[SPEC_FUNCTION_OPERANDS]; /* nodes before this one */
};

struct spec_expression {
	char *text;
	struct spec_node *node;
	size_t count;
	size_t result; /* the node whose value the expression has */
};

/*
 * Reads an expression on so many images. Errors (SPEC_EUSAGE, with the place in the text):
 * what the grammar does not have, a name that is not known, an image that is not there.
 */
enum spec_status spec_expression_parse(const char *text, size_t images,
	struct spec_expression *expression, struct spec_error *error);
void spec_expression_free(struct spec_expression *expression);

#endif
