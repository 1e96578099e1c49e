/*
 * Reading PNG pictures row by row, by libpng: 1 to 16 bits, grey, red-green-blue, palettes,
 * alpha, interlaced or not, forward from a pipe or anywhere in a file.
 * Source: W3C, Portable Network Graphics (PNG) Specification, third edition (2025).
 */
#ifndef SPEC_IMAGE_PNGINPUT_H
#define SPEC_IMAGE_PNGINPUT_H

#include <stddef.h>

#include "base/error.h"
#include "base/source.h"

struct spec_png;

struct spec_png_content {
	int width, height;
	int channels;       /* Y, Y A, R G B or R G B A */
	int has_primaries;  /* it says others than sRGB's: */
	float primaries[8]; /* x and y of red, green, blue and white */
};

/* Whether a file of these first bytes is a PNG picture. */
int spec_png_recognises(const unsigned char *bytes, size_t size);

/*
 * Begins a picture; source must live as long, and is sealed. Messages are the cause alone.
 * Errors: SPEC_EFORMAT, SPEC_EUNSUPPORTED (a cICP chunk whose transfer function, primaries
 * or range is not known here), SPEC_EIO, SPEC_ENOMEM.
 */
enum spec_status spec_png_open(struct spec_png **png, struct spec_source *source,
	struct spec_png_content *content, struct spec_error *error);

/*
 * Rows first..end-1, channels interleaved: whole numbers divided by the largest; where
 * linear, of red, green, blue and grey the light that they stand for, multiplied by alpha.
 * The first of the chunks cICP, sRGB and gAMA that is there says how numbers stand for
 * light; without them it is as sRGB has it. An ICC profile is passed over.
 * memory: bytes that an interlaced picture may take as a whole.
 * Errors: as above; SPEC_ERANGE: more memory; back in a pipe.
 */
enum spec_status spec_png_read(struct spec_png *png, int first, int end, int linear,
	long long memory, float *rows, struct spec_error *error);

void spec_png_close(struct spec_png *png);

#endif
