/*
 * Exposure to a curve: luminance is compressed, and the three components with it by one
 * factor, so that hue and the ratios of the components stay.
 *
 *   reinhard  f(Y) = Y (1 + Y / W^2) / (1 + Y); W, the least luminance that becomes 1, may
 *             be infinite. Source: Reinhard, Stark, Shirley, Ferwerda: Photographic tone
 *             reproduction for digital images. SIGGRAPH 2002, equations 3 and 4.
 *   filmic    f(Y) = h(2 Y) / h(11.2), h(x) = (x (A x + C B) + D E) / (x (A x + B) + D F) -
 *             E / F with A = 0.15, B = 0.50, C = 0.10, D = 0.20, E = 0.02, F = 0.30:
 *             5.6 becomes 1. Source: J. Hable: Uncharted 2: HDR lighting. GDC 2010.
 */
#ifndef SPEC_COLOUR_TONE_H
#define SPEC_COLOUR_TONE_H

#include <stddef.h>

#include "base/error.h"

enum spec_tone_kind { SPEC_TONE_NONE, SPEC_TONE_REINHARD, SPEC_TONE_FILMIC };

struct spec_tone {
	enum spec_tone_kind kind;
	double white; /* of reinhard: W, or 0: infinite */
};

/* none, reinhard, reinhard:W with W above 0, filmic; else SPEC_EUSAGE. */
enum spec_status spec_tone_parse(
	const char *text, struct spec_tone *tone, struct spec_error *error);

/* f(Y), of Y at or above 0. */
double spec_tone_curve(const struct spec_tone *tone, double luminance);

/*
 * In place: count pixels of three planes are multiplied by f(Y) / Y, where Y is the sum of
 * luminance[c] times plane c; where Y is not above 0, by the curve's slope at 0.
 */
void spec_tone_row(const struct spec_tone *tone, const double luminance[3],
	float *const plane[3], size_t count);

#endif
