/* The text format of curves, .spd; spd(5) specifies it. */
#ifndef SPEC_SPECTRUM_SPD_H
#define SPEC_SPECTRUM_SPD_H

#include <stddef.h>
#include <stdio.h>

#include "base/error.h"
#include "spectrum/curve.h"

#define SPEC_SPD_LONGEST_LINE 262144 /* bytes, the line break not counted */
#define SPEC_SPD_MOST_ROWS 1000000

/*
 * Reads a curve from file up to its end, or from size bytes at text. name stands for the
 * file in messages, which begin "name:line: ". A spectrum that is no plain table (store.h)
 * is converted to one as spec_spectrum_to_curve does.
 * SPEC_EFORMAT: not this format, damaged, or without rows. SPEC_ERANGE: a line or the
 * table is too long. SPEC_EIO, SPEC_ENOMEM. On an error curve is empty.
 */
enum spec_status spec_spd_read(
	FILE *file, const char *name, struct spec_curve *curve, struct spec_error *error);
enum spec_status spec_spd_parse(const char *text, size_t size, const char *name,
	struct spec_curve *curve, struct spec_error *error);

/* As spec_spd_read, from the file at path; SPEC_EIO also where it cannot be opened. */
enum spec_status spec_spd_load(
	const char *path, struct spec_curve *curve, struct spec_error *error);

/*
 * Writes curve to file and flushes it. Every number has the fewest digits that read back
 * as the same double, so reading gives the same curve, bit for bit.
 * SPEC_ERANGE: a value that is not finite, wavelengths that are not positive and
 * ascending, or a text that the format cannot hold; nothing is written then. SPEC_EIO.
 */
enum spec_status spec_spd_write(
	FILE *file, const struct spec_curve *curve, struct spec_error *error);

/* As spec_spd_write, to the file at path, "-" for standard output: whole or not at all. */
enum spec_status spec_spd_save(
	const char *path, const struct spec_curve *curve, struct spec_error *error);

/*
 * The same as comma-separated values: a line of the columns' names, wavelength_nm the first,
 * and the rows, which spec_spd_read reads, too. What the curve is stays unsaid.
 */
enum spec_status spec_spd_save_csv(
	const char *path, const struct spec_curve *curve, struct spec_error *error);

/*
 * Writes value, finite, as decimal text with the fewest digits that read back as the same
 * double. text has room for SPEC_SPD_NUMBER bytes. Returns the length.
 */
#define SPEC_SPD_NUMBER 32
size_t spec_spd_format_number(double value, char *text);

#endif
