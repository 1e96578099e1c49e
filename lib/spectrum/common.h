/* The wavelengths at which two spectra are combined. */
#ifndef SPEC_SPECTRUM_COMMON_H
#define SPEC_SPECTRUM_COMMON_H

#include "base/error.h"
#include "spectrum/grid.h"
#include "spectrum/spectrum.h"

/*
 * The wavelengths of a result of samples, as operate.h says: 1 to
 * SPEC_SPECTRUM_MOST_SAMPLES, ascending; to be freed with spec_grid_free, on an error too.
 * SPEC_ERANGE: the ranges do not meet, or there would be more. SPEC_ENOMEM.
 */
enum spec_status spec_spectrum_common(const struct spec_spectrum *a,
	const struct spec_spectrum *b, enum spec_extrapolate extrapolate,
	struct spec_grid *wavelengths, struct spec_error *error);

#endif
