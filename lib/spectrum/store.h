/* Spectra of all kinds in files of the format of spd(5). */
#ifndef SPEC_SPECTRUM_STORE_H
#define SPEC_SPECTRUM_STORE_H

#include <stdio.h>

#include "base/error.h"
#include "spectrum/spectrum.h"

/*
 * Reads a spectrum: of a file with several columns the first. As spec_spd_read, but
 * nothing is converted. SPEC_ERANGE also: numbers that no spectrum has.
 */
enum spec_status spec_spectrum_read(FILE *file, const char *name,
	struct spec_spectrum *spectrum, struct spec_error *error);
enum spec_status spec_spectrum_load(
	const char *path, struct spec_spectrum *spectrum, struct spec_error *error);

/* The spectrum of that name, as spec_lookup_curve finds it. */
enum spec_status spec_spectrum_named(
	const char *name, struct spec_spectrum *spectrum, struct spec_error *error);

/*
 * Writes a spectrum, so that reading gives the same, bit for bit, and flushes the file. One
 * that is tabulated and linear, without lines, becomes a plain curve. SPEC_ERANGE: what the
 * format cannot hold, and nothing is written then. SPEC_EIO.
 */
enum spec_status spec_spectrum_write(
	FILE *file, const struct spec_spectrum *spectrum, struct spec_error *error);

/* As spec_spectrum_write, to the file at path, "-" for standard output: whole or not at all. */
enum spec_status spec_spectrum_save(
	const char *path, const struct spec_spectrum *spectrum, struct spec_error *error);

#endif
