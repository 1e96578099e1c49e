#include "colour/encode.h"

#include <math.h>
#include <string.h>

#include "base/vector.h"
#include "colour/space.h"

#define BLOCK 256 /* samples at a time */

/* The largest float below 1, which has the largest code at 8 bits as at 16. */
#define BELOW_ONE 0x1.fffffep-1f

#define LOWEST8 0x1p-13f /* a power of two below the first threshold, 1.518e-4 */
#define LOWEST8_BITS 0x39000000u
#define SHIFT8 15 /* bits of a float below those that choose the bucket */
#define LOW8 ((1u << SHIFT8) - 1)

#define LOWEST16 0x1p-9f /* a power of two below 0.0031308 */
#define SHIFT16 13
#define LINEAR_END 0.0031308 /* IEC 61966-2-1:1999 */

/*
 * A chord in a bucket of relative width h = 2^-10 departs from 65535 (1.055 v^(5/12) -
 * 0.055) by at most 65535 * 1.055 * (5/12)(7/12)/8 * h^2 = .0020: where it comes this
 * near to a half, the formula decides.
 */
#define DOUBT16 .0025

static uint32_t
bits_of(float v)
{
	uint32_t bits;

	memcpy(&bits, &v, sizeof bits);
	return bits;
}

static float
float_of(uint32_t bits)
{
	float v;

	memcpy(&v, &bits, sizeof v);
	return v;
}

/* The smallest float that rounds to code or more, searched from the formula's inverse. */
static float
find_threshold(int code)
{
	float v = (float)spec_srgb_decode((code - .5) / 255);

	while (255 * spec_srgb_encode(v) >= code - .5)
		v = nextafterf(v, 0);
	while (255 * spec_srgb_encode(v) < code - .5)
		v = nextafterf(v, 1);
	return v;
}

/*
 * A bucket's word is code * 2^16 + 2^16 - t: code is that of the bucket's first float,
 * t the low bits of the next threshold if it lies in the bucket, else 2^15. Adding a
 * float's low bits carries into the code exactly when they reach t.
 */
static void
fill_buckets8(struct spec_encoder *encoder)
{
	uint32_t base = LOWEST8_BITS >> SHIFT8, i, first, t;
	uint32_t code = 0;

	for (i = 0; i < SPEC_ENCODER_BUCKETS8; i++) {
		first = (base + i) << SHIFT8;
		while (code < 255 && bits_of(encoder->threshold[code + 1]) <= first)
			code++;
		t = LOW8 + 1;
		if (code < 255 && bits_of(encoder->threshold[code + 1]) <= (first | LOW8))
			t = bits_of(encoder->threshold[code + 1]) & LOW8;
		encoder->bucket8[i] = (code << 16) + 0x10000 - t;
	}
}

void
spec_encoder_init(struct spec_encoder *encoder)
{
	uint32_t base = bits_of(LOWEST16) >> SHIFT16, i;
	int code;

	encoder->threshold[0] = 0;
	for (code = 1; code < 256; code++)
		encoder->threshold[code] = find_threshold(code);
	fill_buckets8(encoder);
	/* The power alone, also below LINEAR_END, so that the chord across it is good. */
	for (i = 0; i < SPEC_ENCODER_KNOTS16; i++)
		encoder->knot16[i] =
			65535 *
			(1.055 * pow(float_of((base + i) << SHIFT16), 1 / 2.4) - .055);
}

/*
 * The bits of each float, brought into [LOWEST8, 1), above those of LOWEST8. The
 * comparisons are false for a NaN, which so becomes the lowest.
 */
SPEC_VECTORISED static void
clamp_bits8(const float *restrict linear, size_t count, uint32_t *restrict clamped)
{
	uint32_t bits;
	size_t i;
	float v;

	for (i = 0; i < count; i++) {
		v = linear[i];
		v = v > LOWEST8 ? v : LOWEST8;
		v = v < BELOW_ONE ? v : BELOW_ONE;
		memcpy(&bits, &v, sizeof bits);
		clamped[i] = bits - LOWEST8_BITS;
	}
}

/* The look-up stands alone because gather instructions are slower than single loads. */
void
spec_encode_srgb8(const struct spec_encoder *encoder, const float *linear, size_t count,
	unsigned char *out, size_t stride)
{
	const uint32_t *bucket = encoder->bucket8;
	uint32_t clamped[BLOCK], code;
	size_t i, n;

	for (; count > 0; count -= n, linear += n, out += n * stride) {
		n = count < BLOCK ? count : BLOCK;
		clamp_bits8(linear, n, clamped);
		for (i = 0; i < n; i++) {
			code = bucket[clamped[i] >> SHIFT8] + (clamped[i] & LOW8);
			out[i * stride] = (unsigned char)(code >> 16);
		}
	}
}

static uint16_t
encode16(const struct spec_encoder *encoder, float linear)
{
	uint32_t bits, index;
	double scaled, part, whole;
	float v = linear > 0 ? linear : 0;

	v = v < BELOW_ONE ? v : BELOW_ONE;
	if (v <= LINEAR_END)
		return (uint16_t)(65535 * spec_srgb_encode(v) + .5);
	bits = bits_of(v);
	index = (bits >> SHIFT16) - (bits_of(LOWEST16) >> SHIFT16);
	part = (bits & ((1u << SHIFT16) - 1)) * (1. / (1u << SHIFT16));
	scaled = encoder->knot16[index] +
		 (encoder->knot16[index + 1] - encoder->knot16[index]) * part + .5;
	whole = floor(scaled);
	if (scaled - whole < DOUBT16 || scaled - whole > 1 - DOUBT16)
		return (uint16_t)(65535 * spec_srgb_encode(v) + .5);
	return (uint16_t)whole;
}

void
spec_encode_srgb16(const struct spec_encoder *encoder, const float *linear, size_t count,
	uint16_t *out, size_t stride)
{
	size_t i;

	for (i = 0; i < count; i++)
		out[i * stride] = encode16(encoder, linear[i]);
}
