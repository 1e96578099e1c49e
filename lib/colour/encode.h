/*
 * Fast and exact codes: every float gets the code that rounding the transfer function f
 * gives, round(255 f(v)) or round(65535 f(v)), v clamped to [0, 1].
 * NaN and -0 give 0, +infinity the largest code.
 */
#ifndef SPEC_COLOUR_ENCODE_H
#define SPEC_COLOUR_ENCODE_H

#include <stddef.h>
#include <stdint.h>

#include "colour/transfer.h"

/*
 * 8 bits: the floats from a power of two below the first threshold up to 1 fall into
 * buckets by exponent and 8 bits of the fraction, at most one threshold in each; a power
 * 1/2.6 has its first threshold above 2^-24. 16 bits: above the straight part, or from
 * 2^-20 on, by exponent and 10 bits.
 */
#define SPEC_ENCODER_BUCKETS8 (24 * 256)
#define SPEC_ENCODER_KNOTS16 (20 * 1024 + 1)

/* The tables, 188 KiB: the caller's, filled once, then only read, by any threads. */
struct spec_encoder {
	const struct spec_transfer *transfer;
	float lowest8, lowest16; /* powers of two: where the tables begin */
	float direct_end;        /* up to here codes of 16 bits come by the formula */
	float threshold[256];    /* smallest float of each code; [0] is 0 */
	uint32_t bucket8[SPEC_ENCODER_BUCKETS8]; /* code and threshold, see encode.c */
	double knot16[SPEC_ENCODER_KNOTS16];     /* 65535 f(v) where a bucket begins */
};

/* Fills the tables (up to half a millisecond). */
void spec_encoder_init(struct spec_encoder *encoder, const struct spec_transfer *transfer);

/* Codes of count floats, to out[0], out[stride], …; stride >= 1, in samples. */
void spec_encode8(const struct spec_encoder *encoder, const float *linear, size_t count,
	unsigned char *out, size_t stride);
void spec_encode16(const struct spec_encoder *encoder, const float *linear, size_t count,
	uint16_t *out, size_t stride);

#endif
