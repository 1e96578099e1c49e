/* Channel names: which of them are bands, and of what. */
#ifndef SPEC_IMAGE_NAMES_H
#define SPEC_IMAGE_NAMES_H

#include "base/error.h"
#include "image/image.h"

/* Wavelengths that a channel may have [nm]: from X-rays to a millimetre. */
#define SPEC_NAMES_SHORTEST_NM 0.01
#define SPEC_NAMES_LONGEST_NM 1e6

/*
 * Reads channel->name and fills role, stokes and wavelengths. Known are the
 * names of the spectral EXR layout 1.0 (Fichet et al., JCGT 10(3), 2021), which
 * pbrt-v4 and colour-science write too; Mitsuba 0.6's "400.00-410.00nm";
 * ISET3d's "Radiance.C01" (31 bands from 400 to 700 nm); KAIST's "w420nm"
 * (reflectance). Any other name is OTHER. Error (SPEC_EFORMAT): a name of the
 * layout whose wavelength is missing, zero or out of range.
 */
enum spec_status spec_names_read(struct spec_channel *channel, struct spec_error *error);

/*
 * Writes the layout's name of a band, six decimals with a comma, into text.
 * reradiated_nm is used for BISPECTRAL alone.
 */
void spec_names_write(char *text, size_t size, enum spec_role role, int stokes,
	double wavelength_nm, double reradiated_nm);

#endif
