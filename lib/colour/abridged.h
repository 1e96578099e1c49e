/* Weights for bands 10 or 20 nm apart, which stand for sums by 1 nm: ASTM E308. */
#ifndef SPEC_COLOUR_ABRIDGED_H
#define SPEC_COLOUR_ABRIDGED_H

#include <stddef.h>

#include "base/error.h"
#include "spectrum/curve.h"

/* The range of the sums [nm]: that of the CIE's observers. */
#define SPEC_ABRIDGED_FIRST_NM 360
#define SPEC_ABRIDGED_LAST_NM 830

/*
 * The weights of reflectance or transmittance under an illuminant.
 * Given:    observer      colour-matching functions in its first three columns
 *           illuminant    relative power per nm in its first column; both are linear
 *                         between their samples and zero outside them
 *           wavelength_nm count >= 1 bands, points, ascending
 * Returned: weight        3 * count: those of X, then of Y, then of Z. Those of Y add to 1.
 *           sum           the sum of S y over 360..830 nm by 1 nm, times 1 nm: what Y was
 *                         divided by
 * Rule:     At every whole nm of 360..830 the reflectance is interpolated among the bands
 *           of the table, 360, 360 + step, … nm, by Lagrange's polynomial through four of
 *           them, two on either side, but in the first and the last interval through three;
 *           from 820 nm on, where the table by 20 nm ends, it is that band's. What S x, S y,
 *           S z weigh there is folded into those bands. The weights of bands that the image
 *           lacks are added to its first and last; its bands outside the table weigh nothing.
 * Source:   ASTM E2022-11, by which the tables of ASTM E308-15 are made; the latter of bands
 *           that are missing.
 * Errors:   SPEC_EUNSUPPORTED  bands that are not 10 or 20 nm apart, that do not fall on
 *                              those of the table, or of which none is in it
 *           SPEC_EFORMAT       a sum that is not finite and positive
 *           SPEC_ENOMEM
 */
enum spec_status spec_abridged_weights(const struct spec_curve *observer,
	const struct spec_curve *illuminant, const double *wavelength_nm, size_t count,
	double *weight, double *sum, struct spec_error *error);

#endif
