/* How the sums of a picture were taken, told in words. */
#ifndef SPEC_IMAGE_ACCOUNT_H
#define SPEC_IMAGE_ACCOUNT_H

#include "base/error.h"
#include "image/image.h"
#include "image/rgb.h"

/*
 * A text of one line, for the caller to free: the rule, the observer and its step, the
 * illuminant of reflectance, what Y is, and how much of it is not in the image's range, such
 * as "rule cie, sums by the observer's steps (CIE 15:2018); observer …, by 1 nm; illuminant …;
 * Y = 1: the perfect reflector; outside: 0.02 % of Y". Given: a plan, and what it was made of;
 * bands: level.h's text of those that were kept, to stand at the end, or null.
 * SPEC_ENOMEM; then the text is null.
 */
enum spec_status spec_account_text(const struct spec_image *image,
	const struct spec_rgb_setup *setup, const struct spec_rgb *rgb, const char *bands,
	char **text, struct spec_error *error);

/*
 * [cd m^-2] The luminance of a picture's 1, or NaN where it is not known: of a plan, after its
 * exposure.
 */
double spec_account_luminance(
	const struct spec_rgb_setup *setup, const struct spec_rgb *rgb);

#endif
