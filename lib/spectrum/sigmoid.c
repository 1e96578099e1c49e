#include "spectrum/sigmoid.h"

#include "base/vector.h"

/*
 * Means are taken over pieces of a bin, so narrow that the polynomial is nearly straight.
 * Over a piece h wide it leaves its chord by |c0| h^2 / 6 on average, and S' <= 1/2, so
 * the mean is off by |c0| h^2 / 12 at most: 1e-6.
 */
#define MOST_BEND 12e-6   /* |c0| h^2 */
#define MOST_PIECES 65536 /* in a bin */

static inline double
polynomial_at(const struct spec_sigmoid *sigmoid, double nm)
{
	return (sigmoid->c0_per_nm2 * nm + sigmoid->c1_per_nm) * nm + sigmoid->c2;
}

SPEC_VECTORISED void
spec_sigmoid_sample(const struct spec_sigmoid *sigmoid, const double *wavelength_nm,
	size_t count, double *value)
{
	const struct spec_sigmoid s = *sigmoid;

	for (size_t i = 0; i < count; i++)
		value[i] = s.scale * spec_sigmoid_of(polynomial_at(&s, wavelength_nm[i]));
}

size_t
spec_sigmoid_pieces(const struct spec_sigmoid *sigmoid, double bin_nm, double widest_nm)
{
	double most_nm = fmin(widest_nm, sqrt(MOST_BEND / fabs(sigmoid->c0_per_nm2)));

	return (size_t)fmin(fmax(ceil(bin_nm / most_nm), 1), MOST_PIECES);
}

/*
 * The mean of S(x) while x goes straight from a to b. S integrates to (x + r) / 2 with
 * r = sqrt(1 + x^2), and (rb - ra) / (b - a) = (a + b) / (ra + rb); x + r without loss
 * of digits below 0.
 */
static double
mean_between(double a, double b)
{
	double ra = sqrt(1 + a * a), rb = sqrt(1 + b * b);
	double sum_a = a < 0 ? 1 / (ra - a) : ra + a;
	double sum_b = b < 0 ? 1 / (rb - b) : rb + b;

	return .5 * (sum_a + sum_b) / (ra + rb);
}

void
spec_sigmoid_mean(const struct spec_sigmoid *sigmoid, const double *edges_nm, size_t bins,
	double *value)
{
	for (size_t i = 0; i < bins; i++) {
		double a_nm = edges_nm[i], width_nm = edges_nm[i + 1] - a_nm, sum = 0;
		size_t pieces = spec_sigmoid_pieces(sigmoid, width_nm, HUGE_VAL);
		double from = polynomial_at(sigmoid, a_nm), to;

		for (size_t j = 1; j <= pieces && isfinite(sigmoid->c2); j++, from = to) {
			to = polynomial_at(
				sigmoid, a_nm + width_nm * ((double)j / (double)pieces));
			sum += mean_between(from, to);
		}
		value[i] = sigmoid->scale * (isfinite(sigmoid->c2) ? sum / (double)pieces
								   : spec_sigmoid_of(from));
	}
}
