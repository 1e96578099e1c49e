/*
 * Arithmetic with spectra, each operand in a representation of its own.
 *
 * The kind of the result follows from the kinds of the smooth parts and not from their
 * order. For sums, differences and products:
 *
 *                 constant   blackbody  rgb        fourier    tabulated  sampled
 *     constant    constant   sampled*   sampled*   fourier    tabulated  sampled
 *     blackbody              sampled    sampled    sampled    tabulated  sampled
 *     rgb                               sampled    sampled    tabulated  sampled
 *     fourier                                      fourier**  tabulated  sampled
 *     tabulated                                               tabulated  tabulated
 *     sampled                                                            sampled
 *
 * *  what is multiplied or divided by a constant stays what it is.
 * ** sampled where the two ranges differ.
 * Quotients and powers are the same, but sampled where the table says fourier (not for a
 * quotient by a constant). A colour thus becomes samples, while T keeps it a colour: products
 * of colours are what spectra are there to replace.
 *
 * Wavelengths of the result:
 *   sampled and sampled      if their samples lie at the same places, there; else at those of
 *                            the finer, so that nothing is lost (T 3.1.2), of equal steps
 *                            those of the one that begins lower, drawn on in equal steps
 *   tabulated and a table    at those of both
 *   a table and a constant   at the table's
 *   sampled and no table     at its own, with its step divided into equal parts that are no
 *                            wider than the steps of the other's spec_spectrum_grid
 *   tabulated and no table   at its own, and at such equal steps between the ends
 *   neither                  equal steps, the smaller of what spec_spectrum_grid has
 * in the range that both share under SPEC_EXTRAPOLATE_REFUSE; else over the range of either
 * (T: samples are 0 outside). What has no ends limits and extends nothing. Between its samples
 * the result follows the rule of its tables where they agree, else it is linear.
 *
 * Fourier series of one range: coefficients are added, and products are convolutions with
 * all N1 + N2 - 1 coefficients, exact; spec_spectrum_convert cuts them off.
 *
 * Lines: sums and differences have those of both. In a product each has its weight times the
 * other's smooth part there, in a quotient over it; where the other is not known they are
 * left out with the range. Two lines at one wavelength cannot be multiplied. Nothing is
 * divided by lines, and powers, exponentials, roots and clamps of lines have no meaning.
 *
 * Texts: results name both operands. The quantity stays that of light times a ratio or over
 * it, of a ratio times a ratio, and of sums of what is the same; the unit that of such sums.
 * By a number the title and quantity stay, and of a product, quotient or power no unit.
 *
 * Errors of all: SPEC_ERANGE  a result that is not finite, such as a quotient by 0, at a
 *                             wavelength that is named; ranges that do not meet; lines, as
 *                             above; too many coefficients
 *                SPEC_ENOMEM. Then result is empty.
 */
#ifndef SPEC_SPECTRUM_OPERATE_H
#define SPEC_SPECTRUM_OPERATE_H

#include "base/error.h"
#include "spectrum/spectrum.h"

enum spec_operator {
	SPEC_ADD,
	SPEC_SUBTRACT,
	SPEC_MULTIPLY,
	SPEC_DIVIDE,
	SPEC_RAISE /* a to the power of b */
};

/* The table above: of smooth parts, for Fourier series of one range. */
enum spec_spectrum_kind spec_operator_kind(
	enum spec_operator op, enum spec_spectrum_kind a, enum spec_spectrum_kind b);

enum spec_status spec_spectrum_combine(const struct spec_spectrum *a, enum spec_operator op,
	const struct spec_spectrum *b, enum spec_extrapolate extrapolate,
	struct spec_spectrum *result, struct spec_error *error);

/* The same with a number for b. */
enum spec_status spec_spectrum_combine_number(const struct spec_spectrum *a,
	enum spec_operator op, double number, struct spec_spectrum *result,
	struct spec_error *error);

enum spec_status spec_spectrum_negate(const struct spec_spectrum *spectrum,
	struct spec_spectrum *result, struct spec_error *error);

/*
 * Of the values of a constant, and at the samples of tables; others become samples. A clamp
 * to low..high, low <= high, leaves alone what does not leave them.
 */
enum spec_status spec_spectrum_exp(const struct spec_spectrum *spectrum,
	struct spec_spectrum *result, struct spec_error *error);
enum spec_status spec_spectrum_sqrt(const struct spec_spectrum *spectrum,
	struct spec_spectrum *result, struct spec_error *error);
enum spec_status spec_spectrum_clamp(const struct spec_spectrum *spectrum, double low,
	double high, struct spec_spectrum *result, struct spec_error *error);

/*
 * The smallest and the largest value of the smooth part in its range, and where: exact for
 * constants and for tables without Sprague's rule; of others to about 1e-9 of the spread.
 * Lines have no height and do not count.
 */
struct spec_extremes {
	double least, least_nm, most, most_nm;
};
enum spec_status spec_spectrum_extremes(const struct spec_spectrum *spectrum,
	struct spec_extremes *extremes, struct spec_error *error);

/* Whether it is 0 at all wavelengths, without lines. */
int spec_spectrum_is_black(const struct spec_spectrum *spectrum);

#endif
