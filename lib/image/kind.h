/* What an argument of a tool that takes images and curves is. */
#ifndef SPEC_IMAGE_KIND_H
#define SPEC_IMAGE_KIND_H

/*
 * Whether a path ends in .spd, .txt or .csv, in upper or lower case.
 */
int spec_kind_is_text_name(const char *path);

/*
 * Whether an argument is a curve: a file with such a name, text on standard input ("-") or
 * another descriptor (/dev/fd/N), or a name of which there is no file, to be looked up among
 * the spectra. What begins as an image is none, nor what has
 * the suffix of an image, such as .exr.
 */
int spec_kind_is_curve(const char *path);

#endif
