#include "colour/encode.h"

#include <math.h>
#include <string.h>

#include "base/vector.h"

#define BLOCK 256 /* samples at a time */

/* The largest float below 1, which has the largest code at 8 bits as at 16. */
#define BELOW_ONE 0x1.fffffep-1f

#define SHIFT8 15 /* bits of a float below those that choose the bucket */
#define LOW8 ((1u << SHIFT8) - 1)

#define SHIFT16 13
#define LOW16 ((1u << SHIFT16) - 1)
#define LOWEST16 0x1p-20f /* where there is no straight part */

/*
 * A chord in a bucket of relative width h = 2^-10 departs from 65535 a v^p, a <= 1.1, by
 * at most 65535 * 1.1 * p (1 - p) / 8 * h^2 <= .0022: where it comes this near to a half,
 * the formula decides.
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
find_threshold(const struct spec_transfer *transfer, int code)
{
	float v = (float)spec_transfer_decode(transfer, (code - .5) / 255);

	while (255 * spec_transfer_encode(transfer, v) >= code - .5)
		v = nextafterf(v, 0);
	while (255 * spec_transfer_encode(transfer, v) < code - .5)
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
	uint32_t base = bits_of(encoder->lowest8) >> SHIFT8, i, first, t;
	uint32_t end = bits_of(1) >> SHIFT8, code = 0;

	for (i = 0; i < end - base; i++) {
		first = (base + i) << SHIFT8;
		while (code < 255 && bits_of(encoder->threshold[code + 1]) <= first)
			code++;
		t = LOW8 + 1;
		if (code < 255 && bits_of(encoder->threshold[code + 1]) <= (first | LOW8))
			t = bits_of(encoder->threshold[code + 1]) & LOW8;
		encoder->bucket8[i] = (code << 16) + 0x10000 - t;
	}
}

/* The power of two at or below v, 0 < v <= 1. */
static float
power_of_two_below(float v)
{
	int exponent;

	(void)frexpf(v, &exponent);
	return ldexpf(.5f, exponent);
}

void
spec_encoder_init(struct spec_encoder *encoder, const struct spec_transfer *transfer)
{
	uint32_t base, i, end = bits_of(1) >> SHIFT16;
	int code;

	encoder->transfer = transfer;
	encoder->threshold[0] = 0;
	for (code = 1; code < 256; code++)
		encoder->threshold[code] = find_threshold(transfer, code);
	encoder->lowest8 = power_of_two_below(encoder->threshold[1]);
	fill_buckets8(encoder);
	encoder->lowest16 =
		transfer->cut > 0 ? power_of_two_below((float)transfer->cut) : LOWEST16;
	encoder->direct_end = fmaxf((float)transfer->cut, encoder->lowest16);
	base = bits_of(encoder->lowest16) >> SHIFT16;
	/* The power alone, also below the cut, so that the chord across it is good. */
	for (i = 0; i <= end - base; i++)
		encoder->knot16[i] =
			65535 * (transfer->scale * pow(float_of((base + i) << SHIFT16),
							   transfer->power) -
					transfer->offset);
}

/*
 * The bits of each float, brought into [lowest, 1), above those of lowest. The
 * comparisons are false for a NaN, which so becomes the lowest.
 */
SPEC_VECTORISED static void
clamp_bits8(const float *restrict linear, size_t count, float lowest,
	uint32_t *restrict clamped)
{
	uint32_t lowest_bits = bits_of(lowest);
	uint32_t bits;
	size_t i;
	float v;

	for (i = 0; i < count; i++) {
		v = linear[i];
		v = v > lowest ? v : lowest;
		v = v < BELOW_ONE ? v : BELOW_ONE;
		memcpy(&bits, &v, sizeof bits);
		clamped[i] = bits - lowest_bits;
	}
}

/* The look-up stands alone because gather instructions are slower than single loads. */
void
spec_encode8(const struct spec_encoder *encoder, const float *linear, size_t count,
	unsigned char *out, size_t stride)
{
	const uint32_t *bucket = encoder->bucket8;
	uint32_t clamped[BLOCK], code;
	size_t i, n;

	for (; count > 0; count -= n, linear += n, out += n * stride) {
		n = count < BLOCK ? count : BLOCK;
		clamp_bits8(linear, n, encoder->lowest8, clamped);
		for (i = 0; i < n; i++) {
			code = bucket[clamped[i] >> SHIFT8] + (clamped[i] & LOW8);
			out[i * stride] = (unsigned char)(code >> 16);
		}
	}
}

/* The code by the formula, of a float in [0, 1]. */
static uint16_t
encode16(const struct spec_transfer *transfer, float v)
{
	return (uint16_t)(65535 * spec_transfer_encode(transfer, v) + .5);
}

/* Floats brought into [0, 1), and the bits, above those of lowest, of what is not below it. */
SPEC_VECTORISED static void
clamp_bits16(const float *restrict linear, size_t count, float lowest,
	float *restrict clamped, uint32_t *restrict above)
{
	uint32_t lowest_bits = bits_of(lowest), bits;
	float v, u;

	for (size_t i = 0; i < count; i++) {
		v = linear[i];
		v = v > 0 ? v : 0;
		v = v < BELOW_ONE ? v : BELOW_ONE;
		u = v > lowest ? v : lowest;
		memcpy(&bits, &u, sizeof bits);
		clamped[i] = v;
		above[i] = bits - lowest_bits;
	}
}

/*
 * Codes by the straight part, or by the chord from low to high where that is sure of the
 * whole number; else -1.
 */
SPEC_VECTORISED static void
follow_chords(const struct spec_encoder *encoder, const float *restrict clamped,
	const uint32_t *restrict above, const double *restrict low,
	const double *restrict high, size_t count, int32_t *restrict code)
{
	double slope = encoder->transfer->slope, cut = encoder->transfer->cut;
	double direct_end = (double)encoder->direct_end;

	for (size_t i = 0; i < count; i++) {
		double v = (double)clamped[i];
		double part = (int32_t)(above[i] & LOW16) * (1. / (LOW16 + 1));
		double scaled = low[i] + (high[i] - low[i]) * part + .5;
		int32_t whole = (int32_t)scaled;
		int32_t straight = (int32_t)(65535 * (slope * v) + .5);
		double rest = scaled - whole;
		int sure = (v > direct_end) & (rest >= DOUBT16) & (rest <= 1 - DOUBT16);

		whole = sure ? whole : -1;
		code[i] = v <= cut ? straight : whole;
	}
}

void
spec_encode16(const struct spec_encoder *encoder, const float *linear, size_t count,
	uint16_t *out, size_t stride)
{
	const struct spec_transfer *transfer = encoder->transfer;
	double low[BLOCK], high[BLOCK];
	float clamped[BLOCK];
	uint32_t above[BLOCK];
	int32_t code[BLOCK];
	size_t n;

	for (; count > 0; count -= n, linear += n, out += n * stride) {
		n = count < BLOCK ? count : BLOCK;
		clamp_bits16(linear, n, encoder->lowest16, clamped, above);
		for (size_t i = 0; i < n; i++) {
			low[i] = encoder->knot16[above[i] >> SHIFT16];
			high[i] = encoder->knot16[(above[i] >> SHIFT16) + 1];
		}
		follow_chords(encoder, clamped, above, low, high, n, code);
		for (size_t i = 0; i < n; i++)
			out[i * stride] = code[i] < 0 ? encode16(transfer, clamped[i])
						      : (uint16_t)code[i];
	}
}
