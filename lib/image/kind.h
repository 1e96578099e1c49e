/* What the operands and outputs of a tool that takes images and curves are. */
#ifndef SPEC_IMAGE_KIND_H
#define SPEC_IMAGE_KIND_H

#include "base/error.h"

enum spec_kind {
	SPEC_KIND_UNTOLD, /* nobody has said it */
	SPEC_KIND_IMAGE,
	SPEC_KIND_SPD, /* text, as are all that follow */
	SPEC_KIND_CSV
};

static inline int
spec_kind_is_text(enum spec_kind kind)
{
	return kind >= SPEC_KIND_SPD;
}

/*
 * Whether a path ends in .spd, .txt or .csv, in upper or lower case.
 */
int spec_kind_is_text_name(const char *path);

/*
 * Whether an argument is a curve: a file with such a name, text on standard input ("-") or
 * another descriptor (/dev/fd/N), or a name of which there is no file, to be looked up among
 * the spectra. What begins as an image is none, nor what has the suffix of an image, such as
 * .exr.
 */
int spec_kind_is_curve(const char *path);

/* "spd", "csv", or the name of an image format; else SPEC_EUSAGE. */
enum spec_status spec_kind_of_format(
	const char *format, enum spec_kind *kind, struct spec_error *error);

/*
 * What the suffix of an output's path says: untold where it has none, is "-", or lies below
 * /dev with a suffix that is none. SPEC_EUSAGE: another suffix.
 */
enum spec_status spec_kind_of_output(
	const char *path, enum spec_kind *kind, struct spec_error *error);

#endif
