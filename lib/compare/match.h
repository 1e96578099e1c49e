/*
 * Whether two images can be combined pixel by pixel and band by band. Each error names both
 * files and what each of them has. Images are indexed; names are for the messages.
 */
#ifndef SPEC_COMPARE_MATCH_H
#define SPEC_COMPARE_MATCH_H

#include "base/error.h"
#include "image/image.h"

struct spec_match {
	const struct spec_image *image;
	const char *name;
};

/* The same data window and display window. */
enum spec_status spec_match_windows(
	const struct spec_match *a, const struct spec_match *b, struct spec_error *error);

/* Bands at the same wavelengths, as spec_image_nearest_band has it. Both have bands. */
enum spec_status spec_match_bands(
	const struct spec_match *a, const struct spec_match *b, struct spec_error *error);

/* The same bins, within 0.001 nm, or on both sides none. */
enum spec_status spec_match_bins(
	const struct spec_match *a, const struct spec_match *b, struct spec_error *error);

/* Light on both sides or reflectance on both, of the same quantity. */
enum spec_status spec_match_quantities(
	const struct spec_match *a, const struct spec_match *b, struct spec_error *error);

/* As many Stokes components. */
enum spec_status spec_match_stokes(
	const struct spec_match *a, const struct spec_match *b, struct spec_error *error);

/* What an image is, for messages: "light" or "reflectance". */
const char *spec_match_kind(const struct spec_image *image);

#endif
