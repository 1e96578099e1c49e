/* What unit tests of spectra share. */
#ifndef TESTS_UNIT_SPECTRA_H
#define TESTS_UNIT_SPECTRA_H

#include "spectrum/spectrum.h"

#include "check.h"

/* The value at a wavelength [nm], which the spectrum must have. */
static inline double
value_at(const struct spec_spectrum *spectrum, double nm)
{
	double value;

	assert_int_equal(spec_spectrum_sample(
				 spectrum, SPEC_EXTRAPOLATE_REFUSE, &nm, 1, &value, NULL),
		SPEC_OK);
	return value;
}

#endif
