/*
 * What an image says of itself in one text, for formats that have room for no more: a TIFF's
 * ImageDescription. After the line "spectools" come lines "key: value", of which those that
 * begin with a blank go on:
 *
 *   wavelength_nm   of the bands; or of the one band, with
 *   bin_nm          the edges of its bin
 *   data_window, display_window   X0 Y0 X1 Y1, half-open, where they are not 0 0 WIDTH HEIGHT
 *   pixel_aspect    where it is not 1
 *   spec:quantity, spec:samples, and every other attribute "spec:…" that is text
 */
#ifndef SPEC_IMAGE_DESCRIPTION_H
#define SPEC_IMAGE_DESCRIPTION_H

#include "base/error.h"
#include "base/text.h"
#include "image/image.h"
#include "spectrum/grid.h"

/* What a description says beside attributes. */
struct spec_description {
	struct spec_grid grid; /* empty: it names no wavelengths */
	int has_bin;
	double bin_nm[2];
};

/*
 * Writes the description of an indexed image to text->stream, which is open: of all its
 * bands, or of the one band of that number. SPEC_ENOMEM.
 */
enum spec_status spec_description_write(
	const struct spec_image *image, struct spec_text *text, struct spec_error *error);
enum spec_status spec_description_write_band(const struct spec_image *image, size_t band,
	struct spec_text *text, struct spec_error *error);

/* Whether a text is such a description. */
int spec_description_is_ours(const char *description);

/*
 * Reads a description: attributes, windows and the aspect go to the image, whose windows
 * are those of the file already, and the rest to *said, to be freed; neither is needed and
 * may be null. A text that is no description becomes an attribute ImageDescription.
 * Errors: SPEC_EFORMAT, wavelengths that are not positive, windows that are none or do not
 * have the file's size; SPEC_ENOMEM. After an error *said is empty.
 */
enum spec_status spec_description_read(const char *description, struct spec_image *image,
	struct spec_description *said, struct spec_error *error);
void spec_description_free(struct spec_description *said);

/* "X0 Y0 X1 Y1", a half-open window with a pixel in it. SPEC_EFORMAT: something else. */
#define SPEC_DESCRIPTION_WINDOW 64
void spec_description_window(
	char text[SPEC_DESCRIPTION_WINDOW], const struct spec_window *window);
enum spec_status spec_description_parse_window(
	const char *text, struct spec_window *window, struct spec_error *error);

#endif
