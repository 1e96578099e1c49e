/*
 * Fast and exact sRGB codes: every float gets the code that rounding the transfer
 * function gives, round(255 srgb(v)) or round(65535 srgb(v)), v clamped to [0, 1].
 * NaN and -0 give 0, +infinity the largest code.
 */
#ifndef SPEC_COLOUR_ENCODE_H
#define SPEC_COLOUR_ENCODE_H

#include <stddef.h>
#include <stdint.h>

/*
 * 8 bits: the floats of [2^-13, 1) fall into buckets by exponent and 8 bits of the
 * fraction, at most one threshold in each. 16 bits: [2^-9, 1) by exponent and 10 bits.
 */
#define SPEC_ENCODER_BUCKETS8 (13 * 256)
#define SPEC_ENCODER_KNOTS16 (9 * 1024 + 1)

/* The tables, 87 KiB: the caller's, filled once, then only read, by any threads. */
struct spec_encoder {
	float threshold[256];                    /* smallest float of each code; [0] is 0 */
	uint32_t bucket8[SPEC_ENCODER_BUCKETS8]; /* code and threshold, see encode.c */
	double knot16[SPEC_ENCODER_KNOTS16];     /* 65535 srgb(v) where a bucket begins */
};

/* Fills the tables (a quarter of a millisecond). */
void spec_encoder_init(struct spec_encoder *encoder);

/* Codes of count floats, to out[0], out[stride], …; stride >= 1, in samples. */
void spec_encode_srgb8(const struct spec_encoder *encoder, const float *linear,
	size_t count, unsigned char *out, size_t stride);
void spec_encode_srgb16(const struct spec_encoder *encoder, const float *linear,
	size_t count, uint16_t *out, size_t stride);

#endif
