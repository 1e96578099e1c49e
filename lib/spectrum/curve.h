/* Curves: one or more quantities tabulated over common wavelengths. */
#ifndef SPEC_SPECTRUM_CURVE_H
#define SPEC_SPECTRUM_CURVE_H

#include <stddef.h>

#include "base/error.h"

struct spec_curve {
	/* Never null once filled; "" where nothing is known. medium: "air", "vacuum" or "". */
	char *title, *quantity, *unit, *source, *medium;
	size_t count;          /* samples, >= 1 */
	double *wavelength_nm; /* > 0, strictly ascending */
	size_t columns;        /* >= 1 */
	char **column;         /* names of the columns, the wavelengths not among them */
	double *value;         /* value[column * count + i], finite */
};

/* What a curve is worth at a wavelength outside its data. */
enum spec_extrapolate {
	SPEC_EXTRAPOLATE_REFUSE,  /* an error */
	SPEC_EXTRAPOLATE_ZERO,    /* 0 */
	SPEC_EXTRAPOLATE_CONSTANT /* its value at the nearer end */
};

/*
 * "refuse", "constant" or, unless zero is 0, "zero": there are things that cannot be zero, such
 * as an index. Error (SPEC_EUSAGE): another text.
 */
enum spec_status spec_extrapolate_parse(const char *text, int zero,
	enum spec_extrapolate *extrapolate, struct spec_error *error);

/*
 * A curve of count samples in so many columns, for the caller to fill in: wavelengths and
 * values are 0, the texts "", and the columns are called "value", or "value1", "value2" …
 * where there are several. SPEC_ERANGE: count or columns is 0. SPEC_ENOMEM. On an error
 * curve is empty.
 */
enum spec_status spec_curve_new(
	size_t count, size_t columns, struct spec_curve *curve, struct spec_error *error);

/* copy becomes a curve of its own that equals source. SPEC_ENOMEM; then copy is empty. */
enum spec_status spec_curve_copy(
	const struct spec_curve *source, struct spec_curve *copy, struct spec_error *error);

/*
 * Replaces a text of a curve (&curve->title, &curve->column[1], …) by a copy of text.
 * SPEC_ENOMEM; then the old text stays.
 */
enum spec_status spec_curve_set_text(
	char **field, const char *text, struct spec_error *error);

/* Replaces it by one text, between, and the other, or by one of these where the other is "". */
enum spec_status spec_curve_join_texts(char **field, const char *one, const char *between,
	const char *other, struct spec_error *error);

/* The index of the column of that name, or curve->columns if there is none. */
size_t spec_curve_find_column(const struct spec_curve *curve, const char *name);

/*
 * The values of one column of the curve at count wavelengths [nm], in any order: the
 * tabulated values themselves where the wavelength is tabulated, linear between.
 * Wavelengths within 1e-9 (relative) of an end of the data count as that end; further out
 * the rule extrapolate holds. A curve of one sample is known at its wavelength alone.
 * column: 0..columns-1. value: room for count values, in the curve's unit.
 * SPEC_ERANGE: a wavelength outside the data under SPEC_EXTRAPOLATE_REFUSE (the message
 * names the curve, its range and the wavelength), a wavelength that is NaN, or a column
 * that is not there; what value then holds is undefined.
 */
enum spec_status spec_curve_sample(const struct spec_curve *curve, size_t column,
	enum spec_extrapolate extrapolate, const double *wavelength_nm, size_t count,
	double *value, struct spec_error *error);

/*
 * What a curve may stand for, by its quantity. Light: a spectral power distribution, a
 * radiance, or not stated. A ratio: reflectance or transmittance.
 */
int spec_curve_is_light(const struct spec_curve *curve);
int spec_curve_is_ratio(const struct spec_curve *curve);

/* Frees what curve holds and leaves it empty; null or empty is allowed. */
void spec_curve_free(struct spec_curve *curve);

/* What messages call a curve: its title, or that it has none. */
static inline const char *
spec_curve_name(const struct spec_curve *curve)
{
	return curve->title && *curve->title ? curve->title : "untitled";
}

#endif
