/*
 * Complex refractive indices n + ik over wavelength. Fields go as e^{-i omega t}, so a
 * medium absorbs where k > 0. Indices are relative to air, whose own index is 1 here, and
 * so is the vacuum's; wavelengths are taken as they are: in air they are 0.03 % shorter
 * than in the vacuum.
 */
#ifndef SPEC_OPTICS_INDEX_H
#define SPEC_OPTICS_INDEX_H

#include <stddef.h>

#include "base/error.h"
#include "optics/dispersion.h"
#include "spectrum/curve.h"

#define SPEC_INDEX_LARGEST 1e6 /* of n and k; far above whatever was measured */

enum spec_index_kind { SPEC_INDEX_CONSTANT, SPEC_INDEX_DISPERSION, SPEC_INDEX_CURVE };

struct spec_index {
	enum spec_index_kind kind;
	double n, k;                       /* a constant */
	struct spec_dispersion dispersion; /* a formula; its k is 0 */
	struct spec_curve curve;           /* a table, linear between its rows */
	size_t n_column, k_column;         /* of the curve; k is 0 if it has no k_column */
};

/*
 * Reads an index:
 *   air, vacuum                 1; upper and lower case are equal
 *   1.33                        a number n
 *   1.5+0.01i                   n + ik, in this form alone
 *   sellmeier(B1,C1,B2,C2,…), sellmeier-um(B1,L1,B2,L2,…), cauchy(A,B,C,…),
 *   schott(a0,a1,a2,…), conrady(n0,A,B)
 *                               the formulas of enum spec_dispersion_kind
 *   N-BK7, glass/F5, ./my.spd   whatever else: a curve, as spec_lookup_curve finds it, of
 *                               the quantity "refractive index" or not stated, with a
 *                               column n and perhaps k; other columns mean nothing
 * What begins as a number, and has only digits and the characters .,+-eEij, must be one.
 * n and k lie in 0..SPEC_INDEX_LARGEST and are not both 0.
 * SPEC_EUSAGE: a text that is none of these, or a curve that is no index. SPEC_ERANGE: a
 * table with an n or k outside its range. Others as spec_lookup_curve. Every error but
 * SPEC_ENOMEM has a caret under its place in text. On an error index is empty.
 */
enum spec_status spec_index_parse(
	const char *text, struct spec_index *index, struct spec_error *error);

/* As spec_index_parse, of length bytes from byte at of text on; place shows all of it. */
enum spec_status spec_index_parse_part(const char *text, size_t at, size_t length,
	struct spec_index *index, struct spec_error *error);

/*
 * The index at count wavelengths.
 * wavelength_nm: in any order. extrapolate: what a table is worth outside its data, where
 * SPEC_EXTRAPOLATE_ZERO is an error as SPEC_EXTRAPOLATE_REFUSE is, for no medium has the
 * index 0; a formula holds everywhere. n, k: room for count values each; the three arrays
 * must not overlap.
 * SPEC_ERANGE: as spec_curve_sample and spec_dispersion_sample, or a formula gives more
 * than SPEC_INDEX_LARGEST; what n and k then hold is undefined.
 */
enum spec_status spec_index_sample(const struct spec_index *index,
	const double *wavelength_nm, size_t count, enum spec_extrapolate extrapolate,
	double *n, double *k, struct spec_error *error);

/* Frees what index holds and leaves it empty; null or empty is allowed. */
void spec_index_free(struct spec_index *index);

#endif
