/*
 * Models that order the colours of an RGB space in other ways: HSV, HSL, YUV and CMYK.
 * Everywhere: rgb is encoded by the space's transfer function, as pictures and style sheets
 * have it, each component in [0, 1]. Nothing is rounded or clamped.
 *
 *   HSV   H hue [degrees, 0 <= H < 360; 0 of greys], S saturation, V value, in [0, 1]
 *         Source: A. R. Smith: Color gamut transform pairs. SIGGRAPH 1978, 12-19: of the
 *         hexcone. With M and m the largest and the smallest component: V = M,
 *         S = (M - m) / M, 0 of black; H = 60 (G - B) / (M - m) where R is the largest,
 *         120 + 60 (B - R) / (M - m) where G is, 240 + 60 (R - G) / (M - m) where B is.
 *   HSL   H the same, S saturation, L lightness, in [0, 1]
 *         Source: W3C: CSS Color Module Level 4, section 7, after G. H. Joblove,
 *         D. Greenberg: Color spaces for computer graphics. SIGGRAPH 1978, 20-25.
 *         L = (M + m) / 2, S = (M - L) / min(L, 1 - L), 0 of greys.
 *   YUV   Y luma in [0, 1], U and V colour differences, |U| <= 0.436798, |V| <= 0.614777
 *         Source: Recommendation ITU-R BT.470-6, 1998, of PAL:
 *         Y = 0.299 R + 0.587 G + 0.114 B, U = 0.493 (B - Y), V = 0.877 (R - Y).
 *         Not every such triple is a colour of RGB.
 *   CMYK  cyan, magenta, yellow, key (black), in [0, 1], of ideal inks, with as much key as
 *         the colour allows; of black C = M = Y = 0
 *         Source: W3C: CSS Color Module Level 5, section on device-cmyk(), "naively":
 *         K = 1 - M, C = (1 - R - K) / (1 - K), and so on; back: R = (1 - C) (1 - K).
 */
#ifndef SPEC_COLOUR_MODELS_H
#define SPEC_COLOUR_MODELS_H

#include <stddef.h>

#include "base/error.h"

#define SPEC_MODEL_MOST 4 /* components */

enum spec_model_kind { SPEC_MODEL_HSV, SPEC_MODEL_HSL, SPEC_MODEL_YUV, SPEC_MODEL_CMYK };

struct spec_model {
	enum spec_model_kind kind;
	const char *name; /* as on the command line */
	size_t components;
	const char *component[SPEC_MODEL_MOST]; /* their letters */
	double least[SPEC_MODEL_MOST], most[SPEC_MODEL_MOST];
};

/* The models that are known; null beyond the last. */
const struct spec_model *spec_model_at(size_t index);

/* The one of that name, or null with SPEC_EUSAGE and the known names in the message. */
const struct spec_model *spec_model_find(const char *name, struct spec_error *error);

/* A colour in a model, and back: any hue that is finite is taken, as that within 0 to 360. */
void spec_model_from_rgb(
	const struct spec_model *model, const double rgb[3], double value[SPEC_MODEL_MOST]);
void spec_model_to_rgb(
	const struct spec_model *model, const double value[SPEC_MODEL_MOST], double rgb[3]);

#endif
