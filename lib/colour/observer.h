/*
 * Observers: the weights that turn the bands of an image into tristimulus values.
 * X = sum over the bands of weight[band] * value[band], and so for Y and Z. Where the
 * columns of an observer are no x, y, z, read its three signals for X, Y, Z below.
 */
#ifndef SPEC_COLOUR_OBSERVER_H
#define SPEC_COLOUR_OBSERVER_H

#include <stddef.h>

#include "base/error.h"
#include "spectrum/curve.h"

/* The bands of an image, as far as integrals over them need it. */
struct spec_bands {
	size_t count;                /* bands, >= 1 */
	const double *wavelength_nm; /* count, strictly ascending; unused with edges_nm */
	const double *edges_nm;      /* count + 1, strictly ascending, when the values are
	                                means over bins; null: point samples, linear between */
	int per_band; /* the values are integrals over their bands, not densities per nm */
};

/*
 * The name in spectra/ of an observer's colour-matching functions: that of the CIE's
 * for "1931", "1964", "2015-2" and "2015-10"; any other name is itself.
 */
const char *spec_observer_spectrum(const char *name);

/*
 * Reads an observer by one of those names, or the name or path of any curve that has
 * - three columns or more, of which the first three count: x, y, z, or the sensitivities
 *   of three sensors, such as cones or a camera's;
 * - or one, a luminous efficiency or a spectral sensitivity: the observer gets it three
 *   times, and so sees greys.
 * Unequal steps become equal ones of at most 1 nm, linear between the curve's samples.
 * One without a title gets the name for it.
 * Errors:   as spec_lookup_curve; SPEC_EFORMAT: another curve; SPEC_ENOMEM
 */
enum spec_status spec_observer_load(
	const char *name, struct spec_curve *observer, struct spec_error *error);

/*
 * Whether what an observer sees are tristimulus values X, Y, Z: the first three columns
 * are called x, y, z (or X, Y, Z), or have no names (value1, value2, value3). Else they
 * are the signals of its sensors.
 */
int spec_observer_is_xyz(const struct spec_curve *observer);

/* Whether it sees greys: it is one curve, three times. */
int spec_observer_is_grey(const struct spec_curve *observer);

/*
 * The weights of the bands for X, Y and Z.
 * Given:    observer    colour-matching functions xbar, ybar, zbar in its first three
 *                       columns, at equal steps (the CIE's tables: 1 nm)
 *           illuminant  relative power per nm in its first column, linear between its
 *                       samples and zero outside them; null for light itself (emission)
 *           bands       the image's
 * Returned: weight      3 * bands->count: those of X, then of Y, then of Z.
 *                       Emission: a radiance of 1 per nm everywhere gives Y = 1, so
 *                       [nm] for values per band, without unit else.
 *                       With an illuminant: the perfect reflector gives Y = 1.
 *           outside     fraction of Y (of that radiance or that reflector) that comes
 *                       from outside the image's range, in [0, 1]
 * Rule:     sums over the observer's own samples, the image linear between its point
 *           samples (a band's weight is the sum of its hat function times xbar [times
 *           the illuminant]); nothing is extrapolated beyond the first and last
 *           sample, but 1e-6 nm are forgiven there. A bin weighs the integral over it
 *           of the product linear between the observer's samples. Point values per
 *           band weigh the product at their wavelength; their range ends half a step
 *           beyond the outer bands, and a single such band has nothing outside.
 * Errors:   SPEC_EUSAGE   no bands; per_band with an illuminant
 *           SPEC_ERANGE   one point sample that is no integral; wavelengths or edges
 *                         not finite and ascending; image or illuminant does not meet
 *                         the observer's range
 *           SPEC_EFORMAT  an observer without three columns or equal steps, or curves
 *                         whose Y is not finite and positive
 *           SPEC_ENOMEM
 * Source:   CIE 15:2018, calculation of tristimulus values (summation at 1 nm steps),
 *           normalised to 1 in place of 100.
 */
enum spec_status spec_observer_weights(const struct spec_curve *observer,
	const struct spec_curve *illuminant, const struct spec_bands *bands, double *weight,
	double *outside, struct spec_error *error);

/*
 * The tristimulus values of the perfect reflector under an illuminant, over the
 * observer's whole table, with Y = 1: the white of images of reflectance. A null
 * illuminant stands for the equal-energy spectrum. Errors as spec_observer_weights.
 */
enum spec_status spec_observer_white(const struct spec_curve *observer,
	const struct spec_curve *illuminant, double xyz[3], struct spec_error *error);

#endif
