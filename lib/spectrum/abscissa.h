/* Curves over another unit than nanometres, such as frequency or wavenumber. */
#ifndef SPEC_SPECTRUM_ABSCISSA_H
#define SPEC_SPECTRUM_ABSCISSA_H

#include "base/error.h"
#include "spectrum/curve.h"

enum spec_abscissa {
	SPEC_ABSCISSA_NM,
	SPEC_ABSCISSA_UM,
	SPEC_ABSCISSA_THZ,
	SPEC_ABSCISSA_PER_CM /* wavenumber */
};

/* "nm", "um", "THz" or "cm-1". Error (SPEC_EUSAGE): another text. */
enum spec_status spec_abscissa_parse(
	const char *text, enum spec_abscissa *abscissa, struct spec_error *error);

/*
 * A curve whose wavelengths were read as the numbers that its file has, and are of another
 * unit: they become nm, ascending, and so do the values change their order. A frequency v
 * is the wavelength c / v in vacuum, a wavenumber k is 1 / k.
 * Values that are a density over that unit x are made one per nm,
 *     S(l) = S(x) |dx/dl|:  1e-3 for um, c / l^2 for a frequency, 1 / l^2 for a wavenumber:
 * those of a spectral power distribution, and where the quantity names the unit, such as
 * "radiance per THz", which becomes "radiance per nm". The unit's text is dropped then.
 * *left: set where the quantity is not stated, so that values were left as they were.
 * Error (SPEC_ERANGE): wavelengths that are too near to one another to be told apart.
 */
enum spec_status spec_abscissa_convert(enum spec_abscissa abscissa,
	struct spec_curve *curve, int *left, struct spec_error *error);

#endif
