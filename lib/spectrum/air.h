/*
 * Wavelengths in air and in vacuum. The air is that of standards: dry, 15 degrees Celsius,
 * 101325 Pa, 450 ppm of carbon dioxide.
 */
#ifndef SPEC_SPECTRUM_AIR_H
#define SPEC_SPECTRUM_AIR_H

#include <stddef.h>

#include "base/error.h"

/* Where Ciddor's equation holds, wavelengths in vacuum. */
#define SPEC_AIR_SHORTEST_NM 230.0
#define SPEC_AIR_LONGEST_NM 1690.0

enum spec_medium { SPEC_MEDIUM_UNKNOWN, SPEC_MEDIUM_AIR, SPEC_MEDIUM_VACUUM };

/* "air", "vacuum", or "" for what is not known. */
const char *spec_medium_name(enum spec_medium medium);

/*
 * The refractive index of such air at a wavelength in vacuum, from SPEC_AIR_SHORTEST_NM to
 * SPEC_AIR_LONGEST_NM:  1e8 (n - 1) = 5792105 / (238.0185 - s^2) + 167917 / (57.362 - s^2),
 * s the wave number in 1/um (P. E. Ciddor, Applied Optics 35, 1566 (1996), eq 1).
 */
double spec_air_index(double vacuum_nm);

/*
 * Turns count wavelengths of the other medium into those of the medium given, which is
 * known. From air to vacuum exact to 1e-12, relative. Error (SPEC_ERANGE): one that lies
 * outside the equation's range.
 */
enum spec_status spec_air_convert(
	enum spec_medium to, double *wavelength_nm, size_t count, struct spec_error *error);

#endif
