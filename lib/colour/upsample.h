/*
 * Spectra for RGB colours: the sigmoids of spectrum/sigmoid.h that have them.
 * Source: Jakob, Hanika: A low-dimensional function space for efficient spectral
 *         upsampling. Computer Graphics Forum 38 (2), 2019, 147-155; unbounded colours
 *         and lights: Pharr, Jakob, Humphreys: Physically Based Rendering, 4th edition,
 *         2023, section 4.6.6 (RGBUnboundedSpectrum, RGBIlluminantSpectrum).
 */
#ifndef SPEC_COLOUR_UPSAMPLE_H
#define SPEC_COLOUR_UPSAMPLE_H

#include <stddef.h>

#include "base/error.h"
#include "colour/space.h"
#include "spectrum/curve.h"
#include "spectrum/sigmoid.h"

/* What colours of one space are fitted against; afterwards only read, by any threads. */
struct spec_upsampler {
	size_t count;          /* the observer's samples */
	double *wavelength_nm; /* [count] */
	double *weight;        /* [3 * count]: XYZ of a reflectance under the illuminant */
	double white[3];       /* XYZ of the perfect reflector */
	double to_xyz[9];      /* from linear RGB; 1, 1, 1 is white */
	struct spec_curve light; /* the illuminant, Y = 1 as spec_observer_weights has it */
};

/*
 * Given:    space       the space of the colours
 *           observer    the CIE 1931 colour-matching functions
 *           illuminant  the light under which a reflectance has its colour, and which
 *                       coloured lights are multiples of: that of the space's white
 * Rule:     the space's nominal white and the illuminant's own differ in the fourth
 *           digit. Colours are relative to the illuminant's (Bradford's adaptation
 *           between the two), so that greys are level spectra.
 * Errors:   SPEC_ERANGE  the illuminant's chromaticity is more than 0.001 away from the
 *                        space's white; those of spec_observer_weights
 */
enum spec_status spec_upsampler_new(const struct spec_space *space,
	const struct spec_curve *observer, const struct spec_curve *illuminant,
	struct spec_upsampler *upsampler, struct spec_error *error);

/*
 * The same with cmf/cie1931 and, of the illuminants A, D50, D55, D65, D75 and E, the one
 * that is the space's white. Errors: SPEC_EUNSUPPORTED  the white is none of these;
 * those of spec_lookup_curve and spec_upsampler_new.
 */
enum spec_status spec_upsampler_load(const struct spec_space *space,
	struct spec_upsampler *upsampler, struct spec_error *error);

/* Frees what upsampler holds and leaves it empty; null or empty is allowed. */
void spec_upsampler_free(struct spec_upsampler *upsampler);

/*
 * The reflectance of a colour; scale is 1.
 * Given:    rgb      linear, each in [0, 1]
 * Rule:     Gauss-Newton steps, damped after Levenberg and Marquardt, on the difference
 *           in CIELAB, which the paper too minimises. Equal components give a level
 *           spectrum without a fit, and 0 and 1 give 0 and 1 at every wavelength.
 * Accuracy: over grids of 16^3 linear and encoded sRGB colours DeltaE2000 is at most
 *           2e-10 by the observer's own samples, 0.014 by bins 1 nm wide and 0.14 by
 *           bins 5 nm wide; colours darker than 0.001 or paler than 0.999 are met to
 *           0.001. What no reflectance can show, such as the corners of Rec. 2020, gives
 *           the nearest that the fit finds.
 * Errors:   SPEC_ERANGE  a component outside [0, 1], or NaN
 */
enum spec_status spec_upsample_albedo(const struct spec_upsampler *upsampler,
	const double rgb[3], struct spec_sigmoid *sigmoid, struct spec_error *error);

/*
 * The same, the fit begun at the spectrum of a colour near this one, which saves steps.
 * start: null, or finite and not sigmoid itself.
 */
enum spec_status spec_upsample_albedo_from(const struct spec_upsampler *upsampler,
	const double rgb[3], const struct spec_sigmoid *start, struct spec_sigmoid *sigmoid,
	struct spec_error *error);

/*
 * A colour of any brightness, such as a light's or a coefficient's: with m the largest
 * component, scale is 2 m and the sigmoid that of rgb / 2 m, so that it stays smooth.
 * Given: rgb, linear, finite, >= 0; black has scale 0. Error: SPEC_ERANGE.
 */
enum spec_status spec_upsample_unbounded(const struct spec_upsampler *upsampler,
	const double rgb[3], struct spec_sigmoid *sigmoid, struct spec_error *error);

/*
 * A coloured light: the spectrum times upsampler->light, at wavelengths and as means over
 * bins (within 1e-5 of light times scale). rgb = 1, 1, 1 gives the light itself.
 * Errors: those of spec_curve_sample and spec_curve_mean for the light; SPEC_ENOMEM.
 */
enum spec_status spec_upsampler_sample_light(const struct spec_upsampler *upsampler,
	const struct spec_sigmoid *sigmoid, enum spec_extrapolate extrapolate,
	const double *wavelength_nm, size_t count, double *value, struct spec_error *error);
enum spec_status spec_upsampler_mean_light(const struct spec_upsampler *upsampler,
	const struct spec_sigmoid *sigmoid, enum spec_extrapolate extrapolate,
	const double *edges_nm, size_t bins, double *value, struct spec_error *error);

#endif
