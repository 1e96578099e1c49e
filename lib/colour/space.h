/*
 * Colour spaces of three primaries, white points and chromatic adaptation.
 * Matrices are 3 x 3, row by row, and act on columns: out[r] = sum of m[3 * r + c] in[c].
 * XYZ is of the CIE 1931 observer, with Y = 1 for white.
 */
#ifndef SPEC_COLOUR_SPACE_H
#define SPEC_COLOUR_SPACE_H

#include <stddef.h>

#include "base/error.h"
#include "colour/transfer.h"

/* What is told of a colour once its amounts of the primaries are known. */
enum spec_coordinates {
	SPEC_COORDINATES_RGB, /* the amounts: red, green and blue */
	SPEC_COORDINATES_XYZ, /* the amounts, of the primaries X, Y and Z */
	SPEC_COORDINATES_LAB, /* CIE L*a*b*, of X, Y and Z beside a white */
	SPEC_COORDINATES_XYY  /* chromaticity x and y, and Y */
};

struct spec_space {
	const char *name;   /* as on the command line */
	const char *title;  /* for people */
	const char *source; /* the standard, with its year */
	double red_xy[2], green_xy[2], blue_xy[2], white_xy[2];
	const struct spec_transfer *transfer; /* of whole numbers; null: linear */
	enum spec_coordinates coordinates;
	int cicp; /* ColourPrimaries of ITU-T H.273 (07/2024), table 2; 0: none */
};

struct spec_white {
	const char *name;
	double xy[2]; /* CIE 1931 chromaticity */
	const char *source;
};

/* The spaces and whites that are known; null beyond the last. */
const struct spec_space *spec_space_at(size_t index);
const struct spec_white *spec_white_at(size_t index);

/*
 * The one of that name, of a space in any case, or null with SPEC_EUSAGE and the known names
 * in the message.
 */
const struct spec_space *spec_space_find(const char *name, struct spec_error *error);
const struct spec_white *spec_white_find(const char *name, struct spec_error *error);

/*
 * Spaces as users write them: a name, or four chromaticities "xr,yr xg,yg xb,yb xw,yw" of
 * red, green, blue and white, whose space has the name "custom" and sRGB's transfer
 * function. Errors (SPEC_EUSAGE): neither of them; primaries that make no space.
 */
enum spec_status spec_space_parse(
	const char *text, struct spec_space *space, struct spec_error *error);

/* XYZ with Y = 1 of a chromaticity; y must not be 0. */
void spec_white_xyz(const double xy[2], double xyz[3]);

/*
 * The matrix from linear RGB to XYZ, and its inverse. R = G = B = 1 is the space's
 * white. Error: SPEC_ERANGE when the primaries lie on one line or white has no y.
 * Source: SMPTE RP 177:1993, derivation of basic television color equations.
 */
enum spec_status spec_space_to_xyz(
	const struct spec_space *space, double m[9], struct spec_error *error);
enum spec_status spec_space_from_xyz(
	const struct spec_space *space, double m[9], struct spec_error *error);

enum spec_adaptation {
	SPEC_ADAPTATION_NONE,     /* identity: XYZ is kept */
	SPEC_ADAPTATION_BRADFORD, /* linearised, as in ICC.1 */
	SPEC_ADAPTATION_CAT16,
	SPEC_ADAPTATION_VON_KRIES,
	SPEC_ADAPTATION_CAT02
};

/* none, vonkries, bradford, cat02 or cat16; else SPEC_EUSAGE. */
enum spec_status spec_adaptation_find(
	const char *name, enum spec_adaptation *method, struct spec_error *error);

/*
 * The matrix that takes XYZ seen under one white to the corresponding XYZ under
 * another, adaptation complete: from/Y becomes to/Y, and a common factor stays.
 * Given:    from_xyz, to_xyz  the whites, finite, Y > 0, any scale
 * Error:    SPEC_ERANGE  a white with Y not positive or with no positive response in
 *                        one of the method's three channels
 * Source:   von Kries' rule in the channels of Lam 1985 (Bradford, as in ICC.1:2010
 *           annex E), of Li, Li, Wang et al. 2017 (CAT16), of CIE 159:2004 (CAT02), or in
 *           the cones of Hunt, Pointer and Estevez, made for D65 (von Kries).
 */
enum spec_status spec_adaptation_matrix(enum spec_adaptation method,
	const double from_xyz[3], const double to_xyz[3], double m[9],
	struct spec_error *error);

/* out = a b (b acts first); out may be a or b. */
void spec_matrix_multiply(const double a[9], const double b[9], double out[9]);

/* out = m in; out may be in. */
void spec_matrix_apply(const double m[9], const double in[3], double out[3]);

/* out = the inverse of m; out may be m. SPEC_ERANGE if m is singular or not finite. */
enum spec_status spec_matrix_invert(
	const double m[9], double out[9], struct spec_error *error);

#endif
