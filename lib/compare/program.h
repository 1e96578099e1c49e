/*
 * An expression made ready for one channel of the result: what is the same in all pixels is
 * worked out, and the rest runs on rows, in double precision, rounded to float once.
 */
#ifndef SPEC_COMPARE_PROGRAM_H
#define SPEC_COMPARE_PROGRAM_H

#include <stddef.h>
#include <stdint.h>

#include "base/error.h"
#include "compare/expression.h"
#include "image/image.h"

/* In place of an image's channel: it has none there, or it stands for ones. */
#define SPEC_PROGRAM_NONE SIZE_MAX
#define SPEC_PROGRAM_ONES (SIZE_MAX - 1)

/* What the names of an expression stand for in one channel of the result. */
struct spec_program_place {
	const struct spec_image *const *image; /* indexed; as many as the expression has */
	const char *const *name;               /* their files, for messages */
	const size_t *channel; /* of each image: the value of "a", "b", ... */
	double wavelength_nm;
	int stokes;
	size_t bands, width, height; /* of the result */
};

struct spec_program_row {
	size_t image, channel;
	int whole; /* 32 bits of a whole number, not a float */
};

struct spec_instruction;

struct spec_program {
	struct spec_program_row *row; /* what it reads */
	size_t rows;
	struct spec_instruction *instruction;
	size_t instructions, fixed; /* the first of them, once for the whole row */
	size_t registers, result;   /* the register of the value */
	int whole; /* stored as the 32 bits of whole numbers; the caller sets it */
};

/*
 * Errors, with the place in the expression: a channel that an image does not have, a
 * wavelength that is not the same in all pixels or outside the image's bands, an image
 * without bands in place of one that has (SPEC_EUSAGE, SPEC_ERANGE).
 */
enum spec_status spec_program_make(struct spec_program *program,
	const struct spec_expression *expression, const struct spec_program_place *place,
	struct spec_error *error);
void spec_program_free(struct spec_program *program);

/* Bytes of scratch that a run needs, aligned to 64. */
size_t spec_program_scratch(const struct spec_program *program);

/*
 * Works out one row. row: for each of the program's rows, its width samples. y: the row's
 * number from the data window's corner. to: width samples; overlaps none of them.
 */
void spec_program_run(const struct spec_program *program, const float *const *row,
	size_t width, int y, void *scratch, float *to);

/*
 * The channel of a band in a component of the light, and of reflectance the band's for all
 * components; SPEC_PROGRAM_NONE where the image has no bands or not that component.
 */
size_t spec_program_band(const struct spec_image *image, size_t band, int stokes);

#endif
