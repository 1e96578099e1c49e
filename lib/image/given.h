/* What the user tells of an image's bands, where the file does not say it. */
#ifndef SPEC_IMAGE_GIVEN_H
#define SPEC_IMAGE_GIVEN_H

#include "base/error.h"
#include "image/image.h"
#include "image/settings.h"
#include "spectrum/grid.h"

/*
 * Gives the channels that settings->name_map names their wavelengths, and bands whose
 * names do not say whether they are light or reflectance what settings->read_as says; the
 * image is to be indexed afterwards. name_map is "NAME=WAVELENGTH,…"; a wavelength as
 * spec_number_parse_length reads it, and a NAME that holds a comma or an equals sign
 * cannot be given.
 * Errors (SPEC_EUSAGE): a map that is not of that form; a name that the image lacks, if
 * no other channel of it is a band, or that is there twice; a channel whose own name says
 * another wavelength; read_as where the names say it.
 */
enum spec_status spec_given_apply(struct spec_image *image,
	const struct spec_settings *settings, const char *name, struct spec_error *error);

/*
 * The wavelengths of count bands of a format that has bands without saying of which
 * wavelength: settings->wavelengths, "LO:HI:STEP" or "W,W,…", ascending. grid is the
 * caller's to free.
 * Errors (SPEC_EUSAGE): there are none, or not as many.
 */
enum spec_status spec_given_wavelengths(const struct spec_settings *settings, size_t count,
	const char *name, struct spec_grid *grid, struct spec_error *error);

/* "radiance" or "reflectance". SPEC_EUSAGE: something else. */
enum spec_status spec_given_role(
	const char *text, enum spec_role *role, struct spec_error *error);

#endif
