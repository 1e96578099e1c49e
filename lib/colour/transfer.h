/*
 * Transfer functions: how light becomes the number that a picture holds, and back.
 * All of them are of one family, with a straight part near 0 and a power above it.
 */
#ifndef SPEC_COLOUR_TRANSFER_H
#define SPEC_COLOUR_TRANSFER_H

#include <stddef.h>

#include "base/error.h"

struct spec_transfer {
	const char *name;   /* as on the command line */
	const char *source; /* the standard, with its year */
	/*
	 * Light v, 1 is white, becomes slope v up to cut, scale v^power - offset above.
	 * Without unit. From cut_encoded on the inverse is that of the power.
	 */
	double slope, cut, scale, power, offset, cut_encoded;
	int cicp; /* TransferCharacteristics of ITU-T H.273 (07/2024), table 3; 0: none */
};

/* linear, srgb, rec709, rec2020, adobe (power 256/563) and dci (power 1/2.6). */
extern const struct spec_transfer spec_transfer_linear, spec_transfer_srgb,
	spec_transfer_rec709, spec_transfer_rec2020, spec_transfer_adobe, spec_transfer_dci;

/* The functions that are known; null beyond the last. */
const struct spec_transfer *spec_transfer_at(size_t index);

/* The one of that name, or null with SPEC_EUSAGE and the known names in the message. */
const struct spec_transfer *spec_transfer_find(const char *name, struct spec_error *error);

/* The largest G of gamma:G, which the tables of encode.h are made for; G is 1 or more. */
#define SPEC_TRANSFER_MOST_GAMMA 2.6

/*
 * Functions as users write them: a name of those, or "gamma:G", v^(1/G), which is put into
 * *own and called by text; both must last as long as it. Null with SPEC_EUSAGE: neither.
 */
const struct spec_transfer *spec_transfer_parse(
	const char *text, struct spec_transfer *own, struct spec_error *error);

/*
 * Given:    linear, encoded  without unit, nominally in [0, 1]; below it the straight
 *                            part goes on (a pure power is 0 there), above it the
 *                            power; NaN stays NaN
 */
double spec_transfer_encode(const struct spec_transfer *transfer, double linear);
double spec_transfer_decode(const struct spec_transfer *transfer, double encoded);

/*
 * sRGB's.
 * Source:   IEC 61966-2-1:1999: 12.92 v up to 0.0031308, else 1.055 v^(1/2.4) - 0.055;
 *           decoding divides at 0.04045.
 */
double spec_srgb_encode(double linear);
double spec_srgb_decode(double encoded);

#endif
