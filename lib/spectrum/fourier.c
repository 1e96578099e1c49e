#include "spectrum/fourier.h"

#include <math.h>

#define TWO_PI 6.283185307179586

/* 2 pi times n u less its whole turns, so that high harmonics keep their digits. */
static double
angle(double n, double turn)
{
	double turns = n * turn;

	return TWO_PI * (turns - floor(turns));
}

double
spec_series_at(const struct spec_series *series, double nm)
{
	double turn = (nm - series->low_nm) / (series->high_nm - series->low_nm);
	double sum = .5 * series->coefficient[0];

	for (size_t n = 1; n <= series->count / 2; n++) {
		double at = angle((double)n, turn);

		sum += series->coefficient[2 * n - 1] * cos(at) +
		       series->coefficient[2 * n] * sin(at);
	}
	return sum;
}

double
spec_series_mean(const struct spec_series *series, double a_nm, double b_nm)
{
	double range_nm = series->high_nm - series->low_nm;
	double half = (b_nm - a_nm) / 2 / range_nm;
	double turn = (a_nm - series->low_nm) / range_nm + half;
	double sum = .5 * series->coefficient[0];

	/* The mean of cos(n u) is cos(n u) in the middle, times sin(x) / x. */
	for (size_t n = 1; n <= series->count / 2; n++) {
		double at = angle((double)n, turn), x = TWO_PI * (double)n * half;
		double part = x > 1e-8 ? sin(x) / x : 1;

		sum += part * (series->coefficient[2 * n - 1] * cos(at) +
				      series->coefficient[2 * n] * sin(at));
	}
	return sum;
}

void
spec_series_add_piece(const struct spec_piece *piece, double low_nm, double high_nm,
	double *coefficient, size_t count)
{
	double range_nm = high_nm - low_nm, cosine, sine;

	coefficient[0] +=
		2 / range_nm * piece->coefficient[0] * (piece->to_nm - piece->from_nm);
	for (size_t n = 1; n <= count / 2; n++) {
		double k_per_nm = TWO_PI * (double)n / range_nm;

		spec_piece_transform(piece, k_per_nm, low_nm, &cosine, &sine);
		coefficient[2 * n - 1] += 2 / range_nm * cosine;
		coefficient[2 * n] += 2 / range_nm * sine;
	}
}

void
spec_series_add_line(double wavelength_nm, double weight, double low_nm, double high_nm,
	double *coefficient, size_t count)
{
	double range_nm = high_nm - low_nm, share = 2 / range_nm * weight;
	double turn = (wavelength_nm - low_nm) / range_nm;

	coefficient[0] += share;
	for (size_t n = 1; n <= count / 2; n++) {
		double at = angle((double)n, turn);

		coefficient[2 * n - 1] += share * cos(at);
		coefficient[2 * n] += share * sin(at);
	}
}

/* The n-th complex coefficient, of exp(inu): (an - i bn) / 2; 0 beyond the last. */
static void
complex_at(const double *coefficient, size_t count, ptrdiff_t n, double *re, double *im)
{
	size_t i = (size_t)(n < 0 ? -n : n);

	*re = *im = 0;
	if (i > count / 2)
		return;
	*re = .5 * coefficient[i == 0 ? 0 : 2 * i - 1];
	*im = i == 0 ? 0 : (n < 0 ? .5 : -.5) * coefficient[2 * i];
}

void
spec_series_multiply(
	const double *a, size_t a_count, const double *b, size_t b_count, double *product)
{
	ptrdiff_t a_most = (ptrdiff_t)(a_count / 2), b_most = (ptrdiff_t)(b_count / 2);

	for (ptrdiff_t n = 0; n <= a_most + b_most; n++) {
		double re = 0, im = 0;

		for (ptrdiff_t m = -a_most; m <= a_most; m++) {
			double a_re, a_im, b_re, b_im;

			complex_at(a, a_count, m, &a_re, &a_im);
			complex_at(b, b_count, n - m, &b_re, &b_im);
			re += a_re * b_re - a_im * b_im;
			im += a_re * b_im + a_im * b_re;
		}
		product[n == 0 ? 0 : 2 * n - 1] = 2 * re;
		if (n > 0)
			product[2 * n] = -2 * im;
	}
}
