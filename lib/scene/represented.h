/*
 * Spectra of parameter lists in the representations of spectrum/spectrum.h, in the formats of
 * the thesis that it names, appendix A.1; all wavelengths are in nm:
 *   "samplespectrum L"           [LO HI v0 v1 …]  samples at equal distances, two or more
 *   "tabulatedspectrum L"        [nm v nm v …]    as "spectrum"
 *   "fourierspectrum L"          [LO HI a0 a1 b1 a2 b2 …]  an odd count of coefficients
 *   "compositespectrumsampled L" [n LO HI v0 … v(n-1) nm w nm w …]  samples and lines
 *   "compositespectrumfourier L" [n LO HI a0 … nm w nm w …]  n coefficients and lines
 *   "rgbspectrum L"              [r g b]          as "rgb"
 *   "rgbfromsampled L"           as samplespectrum, and
 *   "rgbfromtabulated L"         as tabulatedspectrum, for their colour
 * Where this differs from the thesis:
 * - Outside their range only lights are 0. Reflectances and indices follow the bands' rule.
 * - Colours become spectra, as those of "rgb" do: bands carry nothing else.
 * - The colour of a light is its own (CIE 1931, light of 1 per nm has Y = 1); that of
 *   anything else is the one under D65, so that a perfect reflector is 1, 1, 1. The thesis
 *   weighs both by the colour-matching functions alone.
 * - Coefficients may take a series out of the values of its use; it is clamped then, and a
 *   warning says so. So are components of colours. An index that is not positive is an error.
 */
#ifndef SPEC_SCENE_REPRESENTED_H
#define SPEC_SCENE_REPRESENTED_H

#include "base/error.h"
#include "scene/parameters.h"
#include "scene/scene.h"
#include "scene/spectra.h"

/*
 * Reads a parameter of one of these types, but for SPEC_RGB_SPECTRUM, into an empty
 * spectrum: SPEC_SCENE_CURVE for samples, tables and what was clamped, SPEC_SCENE_SPECTRUM
 * for series and lines, SPEC_SCENE_RGB. SPEC_EFORMAT, SPEC_ERANGE, SPEC_ENOMEM, and for
 * colours those of spec_upsampler_load.
 */
enum spec_status spec_scene_read_represented(const struct spec_arguments *arguments,
	const struct spec_parameter *parameter, enum spec_scene_use use,
	struct spec_scene_spectrum *spectrum);

/*
 * Takes a spectrum of a file for light, also where it fails: as it is, or clamped to 0 and
 * above as above. parameter: null where it is the statement's own. SPEC_ERANGE: other than a
 * Fourier series it has negative values, or it has lines that weigh less than 0.
 */
enum spec_status spec_scene_keep_light(const struct spec_arguments *arguments,
	const struct spec_parameter *parameter, struct spec_spectrum *stored,
	struct spec_scene_spectrum *spectrum);

/* What spectra.c has for all types. */

/* "light" and so on. */
const char *spec_scene_use_name(enum spec_scene_use use);

/* Whether a value is one of a use. */
int spec_scene_fits(enum spec_scene_use use, double value);

/* The error that it is not; wavelength_nm: 0 where it has none. */
enum spec_status spec_scene_fail_value(const struct spec_arguments *arguments,
	const struct spec_parameter *parameter, enum spec_scene_use use, double value,
	double wavelength_nm);

/* Whether all values of a curve fit. */
enum spec_status spec_scene_check_curve(const struct spec_arguments *arguments,
	const struct spec_parameter *parameter, enum spec_scene_use use,
	const struct spec_curve *curve);

/* Pairs of a wavelength and a value. */
enum spec_status spec_scene_read_table(const struct spec_arguments *arguments,
	const struct spec_parameter *parameter, struct spec_curve *curve);

#endif
