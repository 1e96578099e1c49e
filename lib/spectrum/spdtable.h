/* What stands in a file in the format of spd(5), before it is a curve or a spectrum. */
#ifndef SPEC_SPECTRUM_SPDTABLE_H
#define SPEC_SPECTRUM_SPDTABLE_H

#include <stddef.h>
#include <stdio.h>

#include "base/error.h"
#include "spectrum/curve.h"
#include "spectrum/spectrum.h"

struct spec_spd_table {
	char *title, *quantity, *unit, *source, *medium; /* null: not there */
	char *columns;                                   /* their names, or null */
	enum spec_spectrum_kind kind;                    /* tabulated where none is named */
	enum spec_interpolate interpolate;
	double low_nm, high_nm; /* of a Fourier series; 0: no range is given */
	size_t rows, width;     /* rows >= 1, of width numbers */
	double *number;         /* [rows * width], row after row */
	size_t lines;
	struct spec_line *line; /* as they stand there */
	size_t room, line_room;
};

/*
 * Reads a file up to its end, or size bytes at text. Rows are what their kind wants:
 *   tabulated, sampled  a wavelength, positive and ascending, and one value or more
 *   fourier             n, an, bn with n = 0, 1, …; b0 is 0; there is a range
 *   constant            the level
 *   blackbody           the temperature [K] and the level
 *   rgb                 red, green, blue, and scale, c0, c1, c2 of the sigmoid
 * Errors as spec_spd_read. Then table is empty.
 */
enum spec_status spec_spd_table_read(FILE *file, const char *name,
	struct spec_spd_table *table, struct spec_error *error);
enum spec_status spec_spd_table_parse(const char *text, size_t size, const char *name,
	struct spec_spd_table *table, struct spec_error *error);
void spec_spd_table_free(struct spec_spd_table *table);

/* The names of the columns of a kind's rows: "order cosine sine"; null: wavelength_nm first. */
const char *spec_spd_columns(enum spec_spectrum_kind kind);

/* The words between blanks and at most one comma, of which columns and rows consist. */
size_t spec_spd_word(const char *text);
const char *spec_spd_skip(const char *text, int *comma);

/* Moves a table, which is tabulated or sampled and has no lines, into a curve. */
enum spec_status spec_spd_table_to_curve(
	struct spec_spd_table *table, struct spec_curve *curve, struct spec_error *error);

/* The one spectrum that a table has. SPEC_ERANGE: more columns of values than one. */
enum spec_status spec_spd_table_to_spectrum(const struct spec_spd_table *table,
	const char *name, struct spec_spectrum *spectrum, struct spec_error *error);

/* For writing: what no file can hold is SPEC_ERANGE. Of curve the texts and columns count. */
enum spec_status spec_spd_check_texts(
	const struct spec_curve *curve, struct spec_error *error);

/* The header's lines but for the columns'. */
void spec_spd_write_texts(FILE *file, const struct spec_curve *curve);

/* The lines of the header that name a kind and what lies between its rows. */
void spec_spd_write_rule(
	FILE *file, enum spec_spectrum_kind kind, enum spec_interpolate interpolate);

/* As spec_spd_save, of a curve that is tabulated or sampled, with that between its rows. */
enum spec_status spec_spd_save_as(const char *path, const struct spec_curve *curve,
	enum spec_spectrum_kind kind, enum spec_interpolate interpolate,
	struct spec_error *error);

#endif
