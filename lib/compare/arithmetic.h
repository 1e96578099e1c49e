/*
 * Several images made into one, band by band and pixel by pixel. Every operation is an
 * expression on them, which compare/program.h runs; this file sees that it makes sense.
 */
#ifndef SPEC_COMPARE_ARITHMETIC_H
#define SPEC_COMPARE_ARITHMETIC_H

#include <stddef.h>

#include "base/error.h"
#include "compare/expression.h"
#include "compare/matte.h"
#include "compare/match.h"
#include "compare/program.h"
#include "image/reader.h"
#include "image/settings.h"

#define SPEC_ARITHMETIC_MOST 64 /* images; a mask may come to them */

enum spec_arithmetic_operation {
	SPEC_ARITHMETIC_ADD,
	SPEC_ARITHMETIC_SUBTRACT,
	SPEC_ARITHMETIC_MULTIPLY,
	SPEC_ARITHMETIC_DIVIDE,
	SPEC_ARITHMETIC_MIN,
	SPEC_ARITHMETIC_MAX,
	SPEC_ARITHMETIC_MEAN,
	SPEC_ARITHMETIC_OVER,
	SPEC_ARITHMETIC_LERP,
	SPEC_ARITHMETIC_MERGE,
	SPEC_ARITHMETIC_EXPRESSION
};

/* "add" and so on, but not the last two. Error (SPEC_EUSAGE): another name. */
enum spec_status spec_arithmetic_find(const char *name,
	enum spec_arithmetic_operation *operation, struct spec_error *error);

struct spec_arithmetic_setup {
	enum spec_arithmetic_operation operation;
	const char *expression;        /* of EXPRESSION */
	const struct spec_matte *mask; /* of LERP; settled */
	const char *alpha;             /* the channel of OVER; null: A */
	const double *weight;          /* of MEAN and MERGE, one for each image; or null */
	enum spec_role kind; /* of EXPRESSION's result; OTHER: that of the first image */
	int half;            /* bands are stored as HALF */
};

/* How a channel of the output comes about. */
struct spec_arithmetic_source {
	size_t program; /* or SPEC_PROGRAM_NONE: it is a channel of the first image */
	size_t channel;
};

struct spec_arithmetic {
	struct spec_image image;               /* the output's, indexed */
	size_t images;                         /* that are read: the mask's too */
	struct spec_arithmetic_source *source; /* per channel of the output */
	struct spec_program *program;
	size_t programs, program_room;
	unsigned char *wanted[SPEC_ARITHMETIC_MOST + 1]; /* per image and channel */
	size_t most_rows;                                /* of a program */
	size_t rows_bytes, scratch_bytes; /* of a worker's pointers, in all */
};

/*
 * Works out the output's header and how its channels come about. input: the images, indexed,
 * and behind them that of the mask where it has one of its own. Errors: too few or too many
 * images for the operation; windows, bands, bins, quantities or Stokes components that do not
 * fit together, told with both sides; no alpha where one is needed; an expression that is none.
 * The inputs must live as long.
 */
enum spec_status spec_arithmetic_plan(struct spec_arithmetic *arithmetic,
	const struct spec_match *input, size_t images,
	const struct spec_arithmetic_setup *setup, struct spec_error *error);
void spec_arithmetic_free(struct spec_arithmetic *arithmetic);

/*
 * Reads all lines, and writes the settings' output; as
 * spec_image_save. reader: one per image.
 */
enum spec_status spec_arithmetic_run(struct spec_arithmetic *arithmetic,
	struct spec_reader *const *reader, const struct spec_settings *settings,
	unsigned long long *overflows, struct spec_error *error);

#endif
