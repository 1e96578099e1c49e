/* From bands to RGB: one weighted sum per channel of the picture. */
#ifndef SPEC_IMAGE_RGB_H
#define SPEC_IMAGE_RGB_H

#include <stddef.h>

#include "base/error.h"
#include "colour/rule.h"
#include "colour/space.h"
#include "image/image.h"
#include "spectrum/curve.h"

/* What Y = 1 of spec_observer_weights becomes. */
enum spec_rgb_scale {
	SPEC_RGB_ONE,
	SPEC_RGB_HUNDRED,
	SPEC_RGB_ABSOLUTE /* its luminance in cd m^-2 */
};

struct spec_rgb_setup {
	/* Where it sees no XYZ, its signals are the RGB, of no space, and not adapted. */
	const struct spec_curve *observer;
	const struct spec_curve *illuminant; /* of reflective images; null: equal energy */
	/*
	 * Of reflective images, to the space's white, or to D50 where it has no RGB; of
	 * emissive ones from the colour of light, where it is not null, likewise.
	 */
	enum spec_adaptation adaptation;
	const struct spec_curve *light;
	const struct spec_space *space;
	double exposure; /* in stops: everything is multiplied by 2^exposure */
	enum spec_rule rule;
	enum spec_rgb_scale scale;
};

/*
 * The sums: a channel of the image and what it adds to red, green and blue, or to X, Y and
 * Z where the space has no RGB.
 */
struct spec_rgb {
	size_t terms;
	size_t *channel;
	double *weight; /* [3 * terms]: red's, then green's, then blue's */
	double outside; /* fraction of Y that the image's range leaves out */
	int raw;        /* red, green and blue are signals of three sensors, of no space */
	/*
	 * XYZ, with Y = 1, of what is white: of light, equal energy, or what it was adapted
	 * to; of reflectance, the perfect reflector, adapted.
	 */
	double white[3];
	/*
	 * [cd m^-2] what that Y = 1 is before the exposure, by the efficacy of the observer
	 * (rule.h): of radiance; of reflectance where the illuminant is one, that of the
	 * perfect reflector, or an irradiance of the perfect diffuser. Else NaN.
	 */
	double luminance;
};

/*
 * By the rule "cie", and so by the others as rule.h has it:
 * Emissive images: S0's bands; a radiance of 1 per nm at all wavelengths has Y = 1.
 * Reflective ones: T under the illuminant; the perfect reflector has Y = 1.
 * Bispectral channels add T.in.out times the illuminant at in, relative to the same
 * Y, at out: their values are the elements of a discrete reradiation matrix.
 * Errors: no bands; SPEC_EUSAGE: an adaptation without XYZ, the rule "astm" for bispectral
 * images; SPEC_EUNSUPPORTED: the scale is absolute, and the luminance not known; those of
 * spec_rule_weights.
 */
enum spec_status spec_rgb_plan(struct spec_rgb *rgb, const struct spec_image *image,
	const struct spec_rgb_setup *setup, struct spec_error *error);
void spec_rgb_free(struct spec_rgb *rgb);

/*
 * One row: plane[t] points to the samples of channel rgb->channel[t]; red, green and
 * blue to width floats each. Sums are taken in double.
 */
void spec_rgb_row(const struct spec_rgb *rgb, const float *const *plane, size_t width,
	float *red, float *green, float *blue);

#endif
