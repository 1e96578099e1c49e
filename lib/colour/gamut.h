/*
 * Bringing colours that a space cannot show, with components below 0 or above 1, into it.
 *
 *   clip        each component by itself, when it is encoded: rows stay as they are
 *   desaturate  towards the grey of the same luminance, along a straight line of light, as
 *               far as needed; luminance above 1 becomes white, below 0 black
 *   scale       the whole picture by two numbers: everything over its largest component,
 *               where that is above 1, and saturation, the distance from the grey of the
 *               same luminance, by the largest factor that leaves nothing below 0
 *   perceptual  towards the grey of the same OKLab lightness, at constant hue, as far as
 *               needed: chroma falls. Lightness above 1 becomes white. Source: B. Ottosson:
 *               A perceptual color space for image processing, 2020. The cones' responses
 *               are divided by those to the space's white.
 */
#ifndef SPEC_COLOUR_GAMUT_H
#define SPEC_COLOUR_GAMUT_H

#include <stddef.h>

#include "base/error.h"
#include "colour/space.h"

enum spec_gamut {
	SPEC_GAMUT_CLIP,
	SPEC_GAMUT_DESATURATE,
	SPEC_GAMUT_SCALE,
	SPEC_GAMUT_PERCEPTUAL
};

/* clip, desaturate, scale or perceptual; else SPEC_EUSAGE. */
enum spec_status spec_gamut_find(
	const char *name, enum spec_gamut *gamut, struct spec_error *error);

struct spec_gamut_map {
	enum spec_gamut kind;
	double luminance[3];  /* of red, green and blue: they add to 1 */
	double to_cones[9];   /* of perceptual; white becomes 1 1 1 */
	double from_cones[9]; /* its inverse */
	double most, chroma;  /* of scale: see spec_gamut_measure */
};

/*
 * Errors: SPEC_EUSAGE, another map than clip of a space without RGB; SPEC_ERANGE, a white
 * that OKLab's cones do not see; those of spec_space_to_xyz.
 */
enum spec_status spec_gamut_init(struct spec_gamut_map *map, enum spec_gamut kind,
	const struct spec_space *space, struct spec_error *error);

/*
 * Takes count pixels into account for scale: most becomes the largest component, at least
 * 1; chroma the largest factor of saturation, at most 1. Pixels that are not finite, or
 * whose luminance is not above 0, do not count.
 */
void spec_gamut_measure(
	struct spec_gamut_map *map, const float *const plane[3], size_t count);

/* In place: count pixels of three planes. What is not finite stays as it is. */
void spec_gamut_row(const struct spec_gamut_map *map, float *const plane[3], size_t count);

#endif
