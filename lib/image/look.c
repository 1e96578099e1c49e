#include "image/look.h"

#include <string.h>

#include "base/number.h"
#include "base/vector.h"
#include "colour/coordinates.h"

#define BLOCK 256 /* samples at a time */

enum spec_status
spec_look_meter(struct spec_look *look, const char *text, struct spec_error *error)
{
	char number[32];
	size_t length = strlen(text);
	enum spec_status status;

	look->metering = SPEC_METERING_AVERAGE;
	if (strcmp(text, "auto") == 0)
		return SPEC_OK;
	look->metering = SPEC_METERING_PERCENTILE;
	if (strncmp(text, "auto:", 5) != 0 || text[length - 1] != '%' ||
		length - 6 >= sizeof number)
		return spec_error_set(error, SPEC_EUSAGE,
			"the exposure is a number, auto, or auto:P%%, not '%s'", text);
	memcpy(number, text + 5, length - 6);
	number[length - 6] = 0;
	status = spec_number_parse(
		number, 0, 100, "the percentile of --exposure", &look->percentile, error);
	if (status == SPEC_OK && !(look->percentile > 0))
		status = spec_error_set(
			error, SPEC_EUSAGE, "the percentile of --exposure must be above 0");
	return status;
}

enum spec_status
spec_finish_init(struct spec_finish *finish, const struct spec_look *look,
	enum spec_picture_sample sample, const double white[3], struct spec_error *error)
{
	const struct spec_transfer *transfer = look->space->transfer;

	finish->look = look;
	finish->sample = sample;
	finish->gain = 1;
	memcpy(finish->white, white, sizeof finish->white);
	if (look->dither && sample != SPEC_PICTURE_U8)
		return spec_error_set(error, SPEC_EUSAGE,
			"--dither is for pictures of 8 bits per sample");
	spec_encoder_init(&finish->encoder, transfer ? transfer : &spec_transfer_linear);
	return spec_gamut_init(&finish->map, look->gamut, look->space, error);
}

SPEC_VECTORISED static void
multiply(float *restrict plane, size_t count, double gain)
{
	for (size_t x = 0; x < count; x++)
		plane[x] = (float)(plane[x] * gain);
}

void
spec_finish_expose(const struct spec_finish *finish, float *const plane[3], size_t width)
{
	if (finish->gain != 1) {
		for (int c = 0; c < 3; c++)
			multiply(plane[c], width, finish->gain);
	}
	spec_tone_row(&finish->look->tone, finish->map.luminance, plane, width);
}

/*
 * Noise of a place, the same in every run: an integer hash of good avalanche (C. Wellons:
 * Prospecting for hash functions, 2018, lowbias32).
 */
static inline uint32_t
hash(uint32_t x)
{
	x ^= x >> 16;
	x *= 0x7feb352du;
	x ^= x >> 15;
	x *= 0x846ca68bu;
	return x ^ x >> 16;
}

/*
 * Noise of one step of 8 bits, even from 0 to 1, is added to the code that 16 bits have,
 * and the whole part kept: the mean of many is the code's own place between two steps.
 */
SPEC_VECTORISED static void
add_noise(const uint16_t *restrict word, size_t count, uint32_t seed,
	unsigned char *restrict code)
{
	for (size_t i = 0; i < count; i++) {
		uint32_t noise = hash(seed + (uint32_t)i) >> 16;

		code[i] = (unsigned char)((word[i] + (noise * 257 >> 16)) / 257);
	}
}

static void
dither(const struct spec_encoder *encoder, const float *linear, size_t width, uint32_t seed,
	unsigned char *out)
{
	uint16_t word[BLOCK];
	unsigned char code[BLOCK];

	for (size_t x0 = 0; x0 < width; x0 += BLOCK) {
		size_t count = width - x0 < BLOCK ? width - x0 : BLOCK;

		spec_encode16(encoder, linear + x0, count, word, 1);
		add_noise(word, count, seed + (uint32_t)x0, code);
		for (size_t i = 0; i < count; i++)
			out[3 * (x0 + i)] = code[i];
	}
}

void
spec_finish_encode(const struct spec_finish *finish, float *const plane[3], size_t width,
	int y, unsigned char *samples)
{
	spec_gamut_row(&finish->map, plane, width);
	spec_coordinates_row(finish->look->space->coordinates, finish->white, plane, width);
	for (size_t c = 0; c < 3; c++) {
		if (finish->look->dither) {
			dither(&finish->encoder, plane[c], width,
				hash((uint32_t)y * 3 + (uint32_t)c), samples + c);
		} else if (finish->sample == SPEC_PICTURE_U8) {
			spec_encode8(&finish->encoder, plane[c], width, samples + c, 3);
		} else if (finish->sample == SPEC_PICTURE_U16) {
			spec_encode16(&finish->encoder, plane[c], width,
				(uint16_t *)(void *)samples + c, 3);
		} else {
			float *to = (float *)(void *)samples + c;

			for (size_t x = 0; x < width; x++)
				to[3 * x] = plane[c][x];
		}
	}
}
