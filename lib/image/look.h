/*
 * From linear components to a picture's samples: exposure, tone, gamut, other coordinates,
 * transfer function, dithering, in this order.
 */
#ifndef SPEC_IMAGE_LOOK_H
#define SPEC_IMAGE_LOOK_H

#include "base/error.h"
#include "colour/encode.h"
#include "colour/gamut.h"
#include "colour/tone.h"
#include "image/picture.h"

enum spec_metering {
	SPEC_METERING_NONE,
	SPEC_METERING_AVERAGE, /* the mean of log Y becomes log 0.18 */
	SPEC_METERING_PERCENTILE /* Y that this part of the pixels does not exceed becomes 1 */
};

struct spec_look {
	const struct spec_space *space;
	enum spec_metering metering;
	double percentile; /* above 0, at most 100 */
	enum spec_gamut gamut;
	struct spec_tone tone;
	int dither; /* samples of 8 bits */
};

/* "auto", "auto:P%" with P above 0, at most 100; else SPEC_EUSAGE. */
enum spec_status spec_look_meter(
	struct spec_look *look, const char *text, struct spec_error *error);

/* A look made ready: gain, map.most and map.chroma are what measuring is to find. */
struct spec_finish {
	const struct spec_look *look;
	enum spec_picture_sample sample;
	double white[3]; /* its XYZ, for other coordinates */
	double gain;     /* of all components; 1 until it is measured */
	struct spec_gamut_map map;
	struct spec_encoder encoder;
};

/* Errors: those of spec_gamut_init; --dither of samples that have not 8 bits. */
enum spec_status spec_finish_init(struct spec_finish *finish, const struct spec_look *look,
	enum spec_picture_sample sample, const double white[3], struct spec_error *error);

/* What comes before the gamut: planes in place. */
void spec_finish_expose(
	const struct spec_finish *finish, float *const plane[3], size_t width);

/* What remains: planes in place, then samples, three to a pixel. y: the row, for dither. */
void spec_finish_encode(const struct spec_finish *finish, float *const plane[3],
	size_t width, int y, unsigned char *samples);

#endif
