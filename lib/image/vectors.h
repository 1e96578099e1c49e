/* specconvert's vectors: the codes of a picture become directions again. */
#ifndef SPEC_IMAGE_VECTORS_H
#define SPEC_IMAGE_VECTORS_H

#include "base/error.h"
#include "image/reader.h"
#include "image/settings.h"

/*
 * Reads an image's channels R, G and B and writes an image of the channels NAME.X, NAME.Y and
 * NAME.Z of floats, 2 c - 1 (D. Schiffner, Wellenlaengenbasiertes Beleuchtungsmodell im Shader,
 * 2008, equation 55, turned round), with the input's windows. c is the code of a picture, 0
 * to 1, as it is where it is read as sRGB, and the number that OpenEXR holds. They are not
 * made unit vectors: what shows nothing, 1/2, is 0.
 * Errors: no such channels, or whole numbers in one (SPEC_EUNSUPPORTED), a name that is none
 * (SPEC_EUSAGE); those of reading and writing.
 */
enum spec_status spec_vectors_run(struct spec_reader *reader, const char *name,
	const struct spec_settings *settings, struct spec_error *error);

#endif
