/* The expression that an operation on images is. */
#ifndef SPEC_COMPARE_FORMULA_H
#define SPEC_COMPARE_FORMULA_H

#include "base/error.h"
#include "compare/arithmetic.h"

/*
 * The expression, newly allocated, on so many images; that of a mask with a path comes behind
 * them. weight: of the images, in place of the setup's; or null.
 *
 *   add, multiply      a + b + c ...
 *   subtract, divide   a - b
 *   min, max           min(a, b, c ...)
 *   mean               (a + b + c ...) / n
 *   merge              (wa a + wb b + wc c ...) / (wa + wb + wc ...)
 *   over               a + (1 - a.A) (b + (1 - b.A) (c ...)), A being the channel of alpha;
 *                      what is behind an alpha of 1 plays no part
 *   lerp               (1 - m) a + m b, as mix has it
 */
enum spec_status spec_formula_write(const struct spec_arithmetic_setup *setup,
	const double *weight, size_t images, char **text, struct spec_error *error);

/*
 * The same of the variance of that result, image1 and so on being those of the images: of sums
 * and means of independent images; null for all else.
 *   add, subtract   a + b + c ...
 *   mean, merge     (wa^2 a + wb^2 b + wc^2 c ...) / (wa + wb + wc ...)^2
 */
enum spec_status spec_formula_variance(const struct spec_arithmetic_setup *setup,
	const double *weight, size_t images, char **text, struct spec_error *error);

/* The channel that is alpha. */
const char *spec_formula_alpha(const struct spec_arithmetic_setup *setup);

/*
 * The mean of a geometry channel of specexr(5), weighted by cover and weight, newly allocated;
 * null where the channel is none or an image does not have it. cover itself is weighted by
 * weight alone, vectors are made unit vectors again, and id is that of the greatest weight.
 * Where nothing is covered the mean is 0.
 */
enum spec_status spec_formula_geometry(const struct spec_match *input, const double *weight,
	size_t images, const struct spec_channel *channel, char **text,
	struct spec_error *error);

#endif
