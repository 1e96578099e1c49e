#include "spectrum/interpolate.h"

#include <math.h>
#include <string.h>

#include "base/interval.h"

#define EQUIDISTANT 1e-6 /* of a step */

#define BESSEL_TERMS 24
#define BESSEL_SERIES                                                                      \
	4. /* below it the series, above it the recurrence, keeps its digits */

static const char *const names[] = {"linear", "nearest", "left", "sprague"};

enum spec_status
spec_interpolate_parse(
	const char *text, enum spec_interpolate *interpolate, struct spec_error *error)
{
	for (size_t i = 0; i < sizeof names / sizeof names[0]; i++) {
		if (strcmp(text, names[i]) == 0) {
			*interpolate = (enum spec_interpolate)i;
			return SPEC_OK;
		}
	}
	return spec_error_set(error, SPEC_EUSAGE,
		"'%.60s' is not linear, nearest, left or sprague", text);
}

const char *
spec_interpolate_name(enum spec_interpolate interpolate)
{
	return names[interpolate];
}

enum spec_status
spec_samples_check(const struct spec_samples *samples, struct spec_error *error)
{
	const double *nm = samples->wavelength_nm;
	size_t count = samples->count;
	double step_nm;

	if (samples->interpolate != SPEC_INTERPOLATE_SPRAGUE)
		return SPEC_OK;
	if (count < SPEC_INTERPOLATE_SPRAGUE_LEAST)
		return spec_error_set(error, SPEC_ERANGE,
			"Sprague's interpolation needs %d samples, not %zu",
			SPEC_INTERPOLATE_SPRAGUE_LEAST, count);
	step_nm = (nm[count - 1] - nm[0]) / (double)(count - 1);
	for (size_t i = 1; i < count; i++)
		if (fabs(nm[i] - nm[i - 1] - step_nm) > EQUIDISTANT * step_nm)
			return spec_error_set(error, SPEC_ERANGE,
				"Sprague's interpolation needs equidistant samples, and "
				"%.10g nm is followed by %.10g nm where the mean step is "
				"%.10g nm",
				nm[i - 1], nm[i], step_nm);
	return SPEC_OK;
}

/* Sprague's polynomial */

/* A sample, or one of the two that CIE 167:2005 adds before the first and after the last. */
static double
sprague_sample(const struct spec_samples *samples, ptrdiff_t i)
{
	static const double before[2][6] = {
		{508, -540, 488, -367, 144, -24}, {884, -1960, 3033, -2648, 1080, -180}};
	const double *value = samples->value;
	ptrdiff_t last = (ptrdiff_t)samples->count - 1;
	double sum = 0;

	if (i >= 0 && i <= last)
		return value[i];
	for (int k = 0; k < 6; k++)
		sum += i < 0 ? before[-i - 1][k] * value[k]
			     : before[i - last - 1][k] * value[last - k];
	return sum / 209;
}

/* The coefficients of 1, x, … x^5, with x from 0 at sample i to 1 at the next. */
static void
sprague(const struct spec_samples *samples, size_t i, double a[6])
{
	static const double weight[5][6] = {{2, -16, 0, 16, -2, 0},
		{-1, 16, -30, 16, -1, 0}, {-9, 39, -70, 66, -33, 7},
		{13, -64, 126, -124, 61, -12}, {-5, 25, -50, 50, -25, 5}};

	a[0] = samples->value[i];
	for (int power = 1; power < 6; power++) {
		a[power] = 0;
		for (int k = 0; k < 6; k++)
			a[power] += weight[power - 1][k] *
				    sprague_sample(samples, (ptrdiff_t)i + k - 2);
		a[power] /= 24;
	}
}

static double
horner(const double a[6], double x)
{
	double sum = a[5];

	for (int i = 4; i >= 0; i--)
		sum = sum * x + a[i];
	return sum;
}

/*
 * From powers of x in 0..1 to Legendre's polynomials of t = 2 x - 1: x^n is the sum over l
 * of (2 l + 1) n!^2 / ((n - l)! (n + l + 1)!) P_l(t).
 */
static void
to_legendre(const double a[6], double coefficient[6])
{
	for (int l = 0; l < 6; l++) {
		coefficient[l] = 0;
		for (int n = l; n < 6; n++) {
			/* n!^2 / ((n - l)! (n + l + 1)!) */
			double share = 1. / (n + 1);

			for (int i = 1; i <= l; i++)
				share *= (double)(n - i + 1) / (n + i + 1);
			coefficient[l] += (2 * l + 1) * share * a[n];
		}
	}
}

/* Pieces */

/* Gauss and Legendre's rule of 6 points on [-1, 1]: Abramowitz and Stegun 1964, 25.4. */
const double spec_gauss_node[6] = {-.9324695142031521, -.6612093864662645,
	-.2386191860831969, .2386191860831969, .6612093864662645, .9324695142031521};
static const double gauss_share[6] = {.1713244923791704, .3607615730481386,
	.4679139345726910, .4679139345726910, .3607615730481386, .1713244923791704};

/* The sum of coefficient[l] P_l(t). */
static double
legendre_sum(const double *coefficient, int terms, double t)
{
	double before = 0, at = 1, sum = 0;

	for (int l = 0; l < terms; l++) {
		double next = ((2 * l + 1) * t * at - l * before) / (l + 1);

		sum += coefficient[l] * at;
		before = at;
		at = next;
	}
	return sum;
}

void
spec_piece_fit(struct spec_piece *piece, const double value[6])
{
	memset(piece->coefficient, 0, sizeof piece->coefficient);
	for (int k = 0; k < 6; k++) {
		double t = spec_gauss_node[k], before = 0, at = 1;

		for (int l = 0; l < piece->terms; l++) {
			double next = ((2 * l + 1) * t * at - l * before) / (l + 1);

			piece->coefficient[l] +=
				.5 * (2 * l + 1) * gauss_share[k] * value[k] * at;
			before = at;
			at = next;
		}
	}
}

int
spec_samples_pieces(
	const struct spec_samples *samples, size_t i, struct spec_piece pieces[2])
{
	const double *nm = samples->wavelength_nm + i, *value = samples->value + i;
	double middle_nm = nm[0] + (nm[1] - nm[0]) / 2, a[6];

	pieces[0] = (struct spec_piece){nm[0], nm[1], 1, {value[0]}};
	switch (samples->interpolate) {
	case SPEC_INTERPOLATE_LINEAR:
		pieces[0].terms = 2;
		pieces[0].coefficient[0] = .5 * value[0] + .5 * value[1];
		pieces[0].coefficient[1] = .5 * value[1] - .5 * value[0];
		break;
	case SPEC_INTERPOLATE_NEAREST:
		pieces[0].to_nm = middle_nm;
		pieces[1] = (struct spec_piece){middle_nm, nm[1], 1, {value[1]}};
		return 2;
	case SPEC_INTERPOLATE_LEFT:
		break;
	case SPEC_INTERPOLATE_SPRAGUE:
		sprague(samples, i, a);
		to_legendre(a, pieces[0].coefficient);
		pieces[0].terms = 6;
		break;
	}
	return 1;
}

void
spec_piece_cut(struct spec_piece *piece, double low_nm, double high_nm)
{
	double from_nm = fmax(piece->from_nm, low_nm), to_nm = fmin(piece->to_nm, high_nm);
	double scale = 2 / (piece->to_nm - piece->from_nm), value[6];

	if (from_nm == piece->from_nm && to_nm == piece->to_nm)
		return;
	for (int k = 0; k < 6; k++) {
		double nm = .5 * (from_nm + to_nm) +
			    .5 * (to_nm - from_nm) * spec_gauss_node[k];

		value[k] = legendre_sum(piece->coefficient, piece->terms,
			scale * (nm - piece->from_nm) - 1);
	}
	spec_piece_fit(piece, value);
	piece->from_nm = from_nm;
	piece->to_nm = to_nm;
}

double
spec_samples_at(const struct spec_samples *samples, double nm)
{
	const double *at_nm = samples->wavelength_nm, *value = samples->value;
	size_t i = spec_interval_find(at_nm, samples->count - 1, nm);
	double x, a[6];

	if (nm <= at_nm[0])
		return value[0];
	if (nm >= at_nm[samples->count - 1])
		return value[samples->count - 1];
	x = (nm - at_nm[i]) / (at_nm[i + 1] - at_nm[i]);
	switch (samples->interpolate) {
	case SPEC_INTERPOLATE_NEAREST:
		return value[x < .5 ? i : i + 1];
	case SPEC_INTERPOLATE_LEFT:
		return value[i];
	case SPEC_INTERPOLATE_SPRAGUE:
		sprague(samples, i, a);
		return horner(a, x);
	case SPEC_INTERPOLATE_LINEAR:
		break;
	}
	return value[i] + (value[i + 1] - value[i]) * x;
}

/* The integral of the sum of coefficient[l] P_l from -1 to t. */
static double
legendre_integral(const struct spec_piece *piece, double t)
{
	double before = 1, at = t, sum = piece->coefficient[0] * (t + 1);

	/* P_l integrates to (P_(l + 1) - P_(l - 1)) / (2 l + 1), which is 0 at -1. */
	for (int l = 1; l < piece->terms; l++) {
		double next = ((2 * l + 1) * t * at - l * before) / (l + 1);

		sum += piece->coefficient[l] * (next - before) / (2 * l + 1);
		before = at;
		at = next;
	}
	return sum;
}

/* The integral of a piece over what of it lies between a and b. */
static double
piece_integral(const struct spec_piece *piece, double a_nm, double b_nm)
{
	double width_nm = piece->to_nm - piece->from_nm, from = -1, to = 1;

	if (a_nm >= piece->to_nm || b_nm <= piece->from_nm)
		return 0;
	if (a_nm <= piece->from_nm && b_nm >= piece->to_nm)
		return piece->coefficient[0] * width_nm;
	if (a_nm > piece->from_nm)
		from = 2 * (a_nm - piece->from_nm) / width_nm - 1;
	if (b_nm < piece->to_nm)
		to = 2 * (b_nm - piece->from_nm) / width_nm - 1;
	return .5 * width_nm *
	       (legendre_integral(piece, to) - legendre_integral(piece, from));
}

double
spec_samples_integral(const struct spec_samples *samples, double a_nm, double b_nm)
{
	double sum = 0;

	if (samples->count < 2)
		return 0;
	for (size_t i = spec_interval_find(
		     samples->wavelength_nm, samples->count - 1, a_nm);
		i + 1 < samples->count && samples->wavelength_nm[i] < b_nm; i++) {
		struct spec_piece pieces[2];
		int count = spec_samples_pieces(samples, i, pieces);

		for (int k = 0; k < count; k++)
			sum += piece_integral(&pieces[k], a_nm, b_nm);
	}
	return sum;
}

/* Transforms */

/* j_l from its series x^l / (2 l + 1)!! (1 - (x^2/2) / (1! (2l + 3)) + …), DLMF 10.53.1. */
static double
bessel_series(int l, double x)
{
	double half = -.5 * x * x, term = 1, sum;

	for (int i = 1; i <= l; i++)
		term *= x / (2 * i + 1);
	sum = term;
	for (int k = 1; k < BESSEL_TERMS; k++) {
		term *= half / (k * (2 * (l + k) + 1));
		sum += term;
	}
	return sum;
}

void
spec_spherical_bessel(double x, double j[6])
{
	if (x < BESSEL_SERIES) {
		for (int l = 0; l < 6; l++)
			j[l] = bessel_series(l, x);
		return;
	}
	j[0] = sin(x) / x;
	j[1] = (sin(x) / x - cos(x)) / x;
	for (int l = 1; l < 5; l++)
		j[l + 1] = (2 * l + 1) / x * j[l] - j[l - 1];
}

void
spec_piece_transform(const struct spec_piece *piece, double k_per_nm, double origin_nm,
	double *cosine, double *sine)
{
	double half_nm = .5 * (piece->to_nm - piece->from_nm);
	double phase = k_per_nm * (piece->from_nm - origin_nm + half_nm);
	double even = 0, odd = 0, j[6];

	spec_spherical_bessel(k_per_nm * half_nm, j);
	for (int l = 0; l < piece->terms; l++) {
		double part = 2 * half_nm * piece->coefficient[l] * j[l];

		if (l & 2)
			part = -part;
		if (l & 1)
			odd += part;
		else
			even += part;
	}
	*cosine = even * cos(phase) - odd * sin(phase);
	*sine = even * sin(phase) + odd * cos(phase);
}
