#include "spectrum/planck.h"

#include "base/vector.h"

/* x = X_NM_K / (l T) with l in nm; of the radiance per nm, 2 h c^2 / l^5, with l in nm. */
#define X_NM_K (1e9 * SPEC_PLANCK_J_S * SPEC_LIGHT_SPEED_M_PER_S / SPEC_BOLTZMANN_J_PER_K)
#define RADIANCE_NM4                                                                       \
	(1e36 * 2 * SPEC_PLANCK_J_S * SPEC_LIGHT_SPEED_M_PER_S * SPEC_LIGHT_SPEED_M_PER_S)

/* The greatest value of x^5 / (e^x - 1), where x = 5 (1 - e^-x): at 4.965114231744276. */
#define PEAK 21.20143566054992

/* Below SMALL_X, e^x - 1 is taken from its series, since the difference loses digits. */
#define SMALL_X .25

/* Any x from here on: e^x overflows, and x^5 must not. */
#define LARGE_X 1e3

/* Gauss and Legendre's rule of 8 points on [-1, 1]: Abramowitz and Stegun 1964, 25.4. */
#define POINTS 8
static const double node[POINTS] = {-.9602898564975363, -.7966664774136267,
	-.5255324099163290, -.1834346424956498, .1834346424956498, .5255324099163290,
	.7966664774136267, .9602898564975363};
static const double share[POINTS] = {.1012285362903763, .2223810344533745,
	.3137066458778873, .3626837833783620, .3626837833783620, .3137066458778873,
	.2223810344533745, .1012285362903763};

typedef void planck_function(double, const double *restrict, size_t, double *restrict);

/* (e^x - 1) / x for 0 <= x <= SMALL_X: 1 + x/2 (1 + x/3 (1 + … x/13)). */
static inline double
small_growth(double x)
{
	double sum = 1;

	for (int n = 13; n >= 2; n--)
		sum = 1 + sum * (x * (1. / n));
	return sum;
}

/* 1 / (e^x - 1) for x >= 0, where e^x is known; 0 where that is infinite. */
static inline double
occupation(double x, double exponential)
{
	double small = x > SMALL_X ? SMALL_X : x;
	double series = small * small_growth(small);

	return 1 / (x < SMALL_X ? series : exponential - 1);
}

/* e^x, in a loop of its own: libmvec's vectors are not for code with choices in it. */
SPEC_VECTORISED static void
exponentials(double temperature_k, const double *restrict wavelength_nm, size_t count,
	double *restrict exponential)
{
	for (size_t i = 0; i < count; i++)
		exponential[i] =
			spec_vector_exp(X_NM_K / (wavelength_nm[i] * temperature_k));
}

SPEC_VECTORISED void
spec_planck_radiance(double temperature_k, const double *restrict wavelength_nm,
	size_t count, double *restrict radiance)
{
	exponentials(temperature_k, wavelength_nm, count, radiance);
	for (size_t i = 0; i < count; i++) {
		double nm = wavelength_nm[i], nm2 = nm * nm;

		radiance[i] = RADIANCE_NM4 / (nm2 * nm2 * nm) *
			      occupation(X_NM_K / (nm * temperature_k), radiance[i]);
	}
}

SPEC_VECTORISED void
spec_planck_relative(double temperature_k, const double *restrict wavelength_nm,
	size_t count, double *restrict relative)
{
	exponentials(temperature_k, wavelength_nm, count, relative);
	for (size_t i = 0; i < count; i++) {
		double x = X_NM_K / (wavelength_nm[i] * temperature_k);
		double within = x > LARGE_X ? LARGE_X : x, square = within * within;

		relative[i] = square * square * within / PEAK * occupation(x, relative[i]);
	}
}

static void
average(planck_function *planck, double temperature_k, const double *edges_nm, size_t bins,
	double *mean)
{
	for (size_t i = 0; i < bins; i++) {
		double middle = .5 * (edges_nm[i] + edges_nm[i + 1]);
		double half = .5 * (edges_nm[i + 1] - edges_nm[i]);
		double wavelength_nm[POINTS], value[POINTS], sum = 0;

		for (int j = 0; j < POINTS; j++)
			wavelength_nm[j] = middle + half * node[j];
		planck(temperature_k, wavelength_nm, POINTS, value);
		for (int j = 0; j < POINTS; j++)
			sum += share[j] * value[j];
		mean[i] = .5 * sum;
	}
}

void
spec_planck_radiance_mean(
	double temperature_k, const double *edges_nm, size_t bins, double *radiance)
{
	average(spec_planck_radiance, temperature_k, edges_nm, bins, radiance);
}

void
spec_planck_relative_mean(
	double temperature_k, const double *edges_nm, size_t bins, double *relative)
{
	average(spec_planck_relative, temperature_k, edges_nm, bins, relative);
}
