/*
 * A strip: three columns of a curve, such as an observer's functions, as red, green and blue
 * of a picture, a column of pixels for each wavelength; for programs that look them up there.
 */
#ifndef SPEC_IMAGE_STRIP_H
#define SPEC_IMAGE_STRIP_H

#include "base/error.h"
#include "spectrum/curve.h"

enum spec_strip_scaling {
	SPEC_STRIP_AS_IT_IS,
	SPEC_STRIP_GLOBAL, /* all values over the greatest of all */
	SPEC_STRIP_CHANNEL /* those of each column over its own greatest */
};

/* "none", "global" or "channel". Error (SPEC_EUSAGE): another text. */
enum spec_status spec_strip_parse(
	const char *text, enum spec_strip_scaling *scaling, struct spec_error *error);

/*
 * Writes the strip to path, in the format of its suffix, as spec_picture_choose has it, one
 * pixel wide for each sample and height >= 1 high. Integers are linear: a value v is
 * v * 255 (or 65535) rounded to nearest, so at most half of that off; floats are the values
 * themselves. Errors: neither one nor three columns; nothing above 0 to divide by; a value
 * outside 0..1 where the format has integers (SPEC_ERANGE); those of the picture.
 */
enum spec_status spec_strip_save(const char *path, const struct spec_curve *curve,
	enum spec_strip_scaling scaling, int height, struct spec_error *error);

#endif
