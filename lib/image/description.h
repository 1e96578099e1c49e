/*
 * What an image says of itself in one text, for formats that have room for no more: a TIFF's
 * ImageDescription. After the line "spectools" come lines "key: value", of which those that
 * begin with a blank go on: wavelength_nm with the bands' wavelengths, spec:quantity, and
 * every other attribute "spec:…" that is text.
 */
#ifndef SPEC_IMAGE_DESCRIPTION_H
#define SPEC_IMAGE_DESCRIPTION_H

#include "base/error.h"
#include "base/text.h"
#include "image/image.h"
#include "spectrum/grid.h"

/* Writes the description of an indexed image to text->stream, which is open. SPEC_ENOMEM. */
enum spec_status spec_description_write(
	const struct spec_image *image, struct spec_text *text, struct spec_error *error);

/* Whether a text is such a description. */
int spec_description_is_ours(const char *description);

/*
 * Reads a description: attributes go to the image, the wavelengths to grid unless it is
 * null. A text that is no description becomes an attribute ImageDescription, and grid
 * stays empty. Errors: SPEC_EFORMAT, wavelengths that are not positive; SPEC_ENOMEM.
 */
enum spec_status spec_description_read(const char *description, struct spec_image *image,
	struct spec_grid *grid, struct spec_error *error);

#endif
