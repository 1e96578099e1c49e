/*
 * A table of the sigmoids of upsample.h, for as many colours as there are pixels: what a
 * fit finds for one colour, interpolated between the colours of a grid.
 * Layout: Jakob and Hanika 2019 (upsample.h): for each component l that is the largest a
 *         cube of N^3 cells, by z, the component's value, and the other two over it,
 *         y = rgb[(l + 2) % 3] / z and x = rgb[(l + 1) % 3] / z. With s(u) = 3 u^2 - 2 u^3,
 *         z_i = s(s(i / (N - 1))), so that the steps are fine near 0 and 1.
 * Ours:   x_i = y_i = s(i / (N - 1)), where theirs are even: saturated colours and those
 *         beside white are met five times better. The polynomial is one of t, -1 and 1 at
 *         the ends of the observer's table, which floats hold well. Along z interpolation
 *         is linear in 1 / sqrt(z), for so the coefficients of dark colours grow; colours
 *         darker than z_1 are multiples of z_1's.
 * Accuracy: N = 64, by the observer's own samples under D65: DeltaE2000 is at most 0.07,
 *         0.011 on average, over grids of 16^3 linear and encoded colours and over random
 *         and dark ones; at most 0.2 beside white, where all components are above 0.97.
 */
#ifndef SPEC_COLOUR_SIGMOIDS_H
#define SPEC_COLOUR_SIGMOIDS_H

#include <stddef.h>

#include "base/error.h"
#include "colour/upsample.h"

#define SPEC_SIGMOIDS_LEAST 4 /* N, as the next two */
#define SPEC_SIGMOIDS_MOST 256
#define SPEC_SIGMOIDS_USUAL 64
#define SPEC_SIGMOIDS_KEYS 1024 /* of the guesses at a cell */

/* Cells along one axis: where they begin, and how to find one quickly. */
struct spec_sigmoids_axis {
	float at[SPEC_SIGMOIDS_MOST];
	/* One over the way to the next, in the variable that interpolation is linear in. */
	float rate[SPEC_SIGMOIDS_MOST];
	unsigned char guess[SPEC_SIGMOIDS_KEYS]; /* a cell at or below, by a key */
};

struct spec_sigmoids {
	size_t side;               /* N */
	double middle_nm, half_nm; /* t = (l - middle) / half */
	/* [3][N of z][N of y][N of x][3]: c0, c1, c2; and one more, so that four can be read */
	const float *coefficient;
	struct spec_sigmoids_axis share; /* x and y; the key is x */
	struct spec_sigmoids_axis level; /* z; the key is its square root */
	float place[SPEC_SIGMOIDS_MOST]; /* -1 / sqrt(z_i), and of z_0 that of z_1 */
	void *memory;                    /* what the coefficients lie in */
	size_t mapped;                   /* its bytes where it is a file's, else 0 */
};

/*
 * Fits all 3 N^3 colours; the same bits for any number of threads. Errors: SPEC_ERANGE, a
 * side out of range; SPEC_ENOMEM.
 */
enum spec_status spec_sigmoids_solve(const struct spec_upsampler *upsampler, size_t side,
	int threads, struct spec_sigmoids *sigmoids, struct spec_error *error);

/* Writes a table as a file, whole or not at all. Errors: SPEC_EIO. */
enum spec_status spec_sigmoids_save(
	const struct spec_sigmoids *sigmoids, const char *path, struct spec_error *error);

/*
 * The table at path; it is mapped, and so not read before it is needed. Errors: SPEC_EIO;
 * SPEC_EFORMAT where it is no such table, of another kind of computer, or not whole.
 */
enum spec_status spec_sigmoids_open(
	const char *path, struct spec_sigmoids *sigmoids, struct spec_error *error);

/* That of sRGB, ../share/spectools/upsampling/srgb.sigmoids beside the running program. */
enum spec_status spec_sigmoids_load(
	struct spec_sigmoids *sigmoids, struct spec_error *error);

/* Frees what sigmoids holds and leaves it empty; null or empty is allowed. */
void spec_sigmoids_free(struct spec_sigmoids *sigmoids);

/*
 * The reflectances of count colours: scale S(c0 t^2 + c1 t + c2), in planes. Equal
 * components give exactly level spectra.
 * Given:    r, g, b  linear, in [0, 1]
 * Returned: c0, c1, c2, scale  [count] each, finite; scale is in [0, 1]
 */
void spec_sigmoids_look_up(const struct spec_sigmoids *sigmoids, const float *r,
	const float *g, const float *b, size_t count, float *c0, float *c1, float *c2,
	float *scale);

/* The same of one colour, as upsample.h has it. */
void spec_sigmoids_find(const struct spec_sigmoids *sigmoids, const double rgb[3],
	struct spec_sigmoid *sigmoid);

#endif
