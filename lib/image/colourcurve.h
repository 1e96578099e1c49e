/* The spectrum of one RGB colour as a curve. */
#ifndef SPEC_IMAGE_COLOURCURVE_H
#define SPEC_IMAGE_COLOURCURVE_H

#include "base/error.h"
#include "image/fromrgb.h"
#include "spectrum/curve.h"

/* Whether a text is meant for a colour: it begins with '#', "rgb:" or a model's name. */
int spec_colour_curve_is_name(const char *text);

/*
 * "#rrggbb", encoded as sRGB has it, "rgb:R,G,B", linear numbers >= 0, or a colour of a
 * model (colour/models.h) over sRGB's codes: "hsv:H,S,V", "hsl:H,S,L", "yuv:Y,U,V",
 * "cmyk:C,M,Y,K". Errors (SPEC_EUSAGE, SPEC_ERANGE): another text; YUV that is no colour of
 * RGB by more than 0.001.
 */
enum spec_status spec_colour_curve_parse(
	const char *text, double rgb[3], struct spec_error *error);

/*
 * The spectrum on a grid, or null: SPEC_FROMRGB_GRID; setup has the model, its use and the
 * rule for D65, as spec_fromrgb_plan takes them, and of sigmoids it is a fit. Its samples
 * are values at the wavelengths; but after Smits they are means over the bands of the grid,
 * for linear between points on his steps it would not have their energy.
 * Errors: SPEC_ERANGE, a component that is not in [0, 1], of other uses than albedo not
 * finite and >= 0; those of the models.
 */
enum spec_status spec_colour_curve(const double rgb[3],
	const struct spec_fromrgb_setup *setup, struct spec_curve *curve,
	struct spec_error *error);

#endif
