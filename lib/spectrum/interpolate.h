/*
 * What lies between samples. A sampled function is taken apart into pieces, each a
 * polynomial, so that its values and its integrals are both exact.
 */
#ifndef SPEC_SPECTRUM_INTERPOLATE_H
#define SPEC_SPECTRUM_INTERPOLATE_H

#include <stddef.h>

#include "base/error.h"

enum spec_interpolate {
	SPEC_INTERPOLATE_LINEAR,  /* straight lines */
	SPEC_INTERPOLATE_NEAREST, /* the nearest sample; of two, the one above */
	SPEC_INTERPOLATE_LEFT,    /* the last sample at or below */
	/*
	 * Sprague's: polynomials of degree 5 through 6 equidistant samples that meet with equal
	 * slopes and curvatures. T. B. Sprague: Explanation of a new formula for interpolation,
	 * J. Inst. Actuaries 22 (1880) 270-285; CIE 167:2005, 9.2.4, table V, with the two
	 * samples that it adds at each end.
	 */
	SPEC_INTERPOLATE_SPRAGUE
};

#define SPEC_INTERPOLATE_SPRAGUE_LEAST 6 /* samples */

/* "linear", "nearest", "left" or "sprague". SPEC_EUSAGE: another text. */
enum spec_status spec_interpolate_parse(
	const char *text, enum spec_interpolate *interpolate, struct spec_error *error);
const char *spec_interpolate_name(enum spec_interpolate interpolate);

/* Samples to interpolate between. */
struct spec_samples {
	const double *wavelength_nm; /* strictly ascending */
	const double *value;
	size_t count; /* >= 1; >= 6 and equidistant for Sprague's */
	enum spec_interpolate interpolate;
};

/*
 * SPEC_ERANGE: Sprague's interpolation of fewer than 6 samples, or of wavelengths that are
 * further than 1e-6 of their distance from being equidistant.
 */
enum spec_status spec_samples_check(
	const struct spec_samples *samples, struct spec_error *error);

/*
 * A piece: the sum of coefficient[l] P_l(t), l < terms, P_l Legendre's polynomials and t
 * from -1 at from_nm to 1 at to_nm. Its integral is coefficient[0] (to_nm - from_nm).
 */
struct spec_piece {
	double from_nm, to_nm;
	int terms; /* 1 to 6 */
	double coefficient[6];
};

/*
 * Sets the coefficients of a piece, terms of them, from its values where t is
 * spec_gauss_node, the points of Gauss and Legendre's rule: exact for a polynomial of degree
 * below 6.
 */
extern const double spec_gauss_node[6];
void spec_piece_fit(struct spec_piece *piece, const double value[6]);

/* The pieces between the samples i and i + 1, i + 1 < count: 1, or 2 for the nearest. */
int spec_samples_pieces(
	const struct spec_samples *samples, size_t i, struct spec_piece pieces[2]);

/* What of a piece lies between two wavelengths, where it has some there. */
void spec_piece_cut(struct spec_piece *piece, double low_nm, double high_nm);

/* The function at a wavelength from the first sample to the last. */
double spec_samples_at(const struct spec_samples *samples, double nm);

/* Its integral from a_nm to b_nm, a_nm <= b_nm, both from the first sample to the last. */
double spec_samples_integral(const struct spec_samples *samples, double a_nm, double b_nm);

/*
 * The integrals of the piece times cos k(nm - origin_nm) and times sin k(nm - origin_nm),
 * k_per_nm >= 0, exact to rounding: with x = k (to_nm - from_nm) / 2 and j_l the spherical
 * Bessel functions, those of P_l(t) exp(ixt) over t are 2 i^l j_l(x) (DLMF 10.54.2).
 */
void spec_piece_transform(const struct spec_piece *piece, double k_per_nm, double origin_nm,
	double *cosine, double *sine);

/* The spherical Bessel functions j_0 to j_5 at x >= 0, to 1e-14. */
void spec_spherical_bessel(double x, double j[6]);

#endif
