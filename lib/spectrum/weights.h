/*
 * Between samples: what is known at some wavelengths gives a value at another as a weighted
 * sum, whose weights depend on the wavelengths alone; for images, of which every pixel has
 * the same wavelengths.
 */
#ifndef SPEC_SPECTRUM_WEIGHTS_H
#define SPEC_SPECTRUM_WEIGHTS_H

#include <stddef.h>

#include "base/error.h"
#include "spectrum/interpolate.h"

#define SPEC_WEIGHTS_MOST 6 /* samples that a value is made of */

struct spec_weights {
	/* Samples first .. first + count - 1; the outer ones do not weigh 0. */
	size_t first, count;
	double weight[SPEC_WEIGHTS_MOST];
};

/* Whether a rule can be used on count >= 1 ascending wavelengths, as spec_samples_check. */
enum spec_status spec_weights_check(enum spec_interpolate rule, const double *known_nm,
	size_t count, struct spec_error *error);

/*
 * The weights at a wavelength in known_nm[0] .. known_nm[count - 1]; outside, those of the
 * nearer end. Their sum is 1. The rule must have been checked.
 */
struct spec_weights spec_weights_at(enum spec_interpolate rule, const double *known_nm,
	size_t count, double wavelength_nm);

#endif
