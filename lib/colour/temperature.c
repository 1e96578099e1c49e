#include "colour/temperature.h"

#include <math.h>

#include "spectrum/planck.h"

#define STEP_MIRED 10.0
#define LOWEST_MIRED (1e6 / SPEC_TEMPERATURE_HIGHEST_K)
#define HIGHEST_MIRED (1e6 / SPEC_TEMPERATURE_LOWEST_K)
#define HALVINGS 60 /* of 20 mired: far below a double's resolution */
#define RUN 128     /* samples of the observer at a time */

/* Black bodies at the ends of the range still have a temperature, in spite of rounding. */
#define END_MIRED 1e-6

#define C2_NM_K (1e9 * SPEC_PLANCK_J_S * SPEC_LIGHT_SPEED_M_PER_S / SPEC_BOLTZMANN_J_PER_K)

/* XYZ of the black body, and, where rise is not null, what they grow by per kelvin. */
static void
sum_black_body(const struct spec_curve *observer, double temperature_k, double xyz[3],
	double *rise)
{
	const size_t n = observer->count;
	double power[RUN];

	for (size_t c = 0; c < 3; c++) {
		xyz[c] = 0;
		if (rise)
			rise[c] = 0;
	}
	for (size_t first = 0; first < n; first += RUN) {
		size_t count = n - first < RUN ? n - first : RUN;
		const double *nm = observer->wavelength_nm + first;

		spec_planck_relative(temperature_k, nm, count, power);
		for (size_t i = 0; i < count; i++) {
			double x = C2_NM_K / (nm[i] * temperature_k);
			double growth = power[i] * x / (temperature_k * -expm1(-x));

			for (size_t c = 0; c < 3; c++) {
				double response = observer->value[c * n + first + i];

				xyz[c] += response * power[i];
				if (rise)
					rise[c] += response * growth;
			}
		}
	}
}

void
spec_temperature_black_body(
	const struct spec_curve *observer, double temperature_k, double xyz[3])
{
	sum_black_body(observer, temperature_k, xyz, NULL);
}

static double
denominator(const double xyz[3])
{
	return xyz[0] + 15 * xyz[1] + 3 * xyz[2];
}

void
spec_temperature_uv(const double xyz[3], double uv[2])
{
	double sum = denominator(xyz);

	uv[0] = sum > 0 ? 4 * xyz[0] / sum : NAN;
	uv[1] = sum > 0 ? 6 * xyz[1] / sum : NAN;
}

/* The square of the distance from uv to the locus. */
static double
distance2(const struct spec_curve *observer, const double uv[2], double mired)
{
	double xyz[3], at[2];

	spec_temperature_black_body(observer, 1e6 / mired, xyz);
	spec_temperature_uv(xyz, at);
	return (uv[0] - at[0]) * (uv[0] - at[0]) + (uv[1] - at[1]) * (uv[1] - at[1]);
}

/* Above 0 where the foot of the perpendicular is at a higher temperature. */
static double
ahead(const struct spec_curve *observer, const double uv[2], double mired)
{
	double xyz[3], rise[3], at[2], sum, growth;

	sum_black_body(observer, 1e6 / mired, xyz, rise);
	spec_temperature_uv(xyz, at);
	sum = denominator(xyz);
	growth = denominator(rise);
	return (uv[0] - at[0]) * (4 * rise[0] - at[0] * growth) / sum +
	       (uv[1] - at[1]) * (6 * rise[1] - at[1] * growth) / sum;
}

/* The steps go one beyond either end: a foot at the end lies between two of them. */
static double
nearest_step(const struct spec_curve *observer, const double uv[2])
{
	double best = NAN, least = INFINITY;

	for (double mired = LOWEST_MIRED / 2; mired < HIGHEST_MIRED + 2 * STEP_MIRED;
		mired += mired < LOWEST_MIRED ? LOWEST_MIRED / 2 : STEP_MIRED) {
		double distance = distance2(observer, uv, mired);

		if (distance < least) {
			least = distance;
			best = mired;
		}
	}
	return best;
}

void
spec_temperature_find(
	const struct spec_curve *observer, const double xyz[3], double *cct_k, double *duv)
{
	double uv[2], low, high, mired, body[3], at[2], distance;

	*cct_k = *duv = NAN;
	spec_temperature_uv(xyz, uv);
	if (!isfinite(uv[0]) || !isfinite(uv[1]))
		return;
	mired = nearest_step(observer, uv);
	low = mired - STEP_MIRED > LOWEST_MIRED / 2 ? mired - STEP_MIRED : LOWEST_MIRED / 2;
	high = mired + STEP_MIRED;
	for (int i = 0; i < HALVINGS; i++) {
		mired = .5 * (low + high);
		if (ahead(observer, uv, mired) > 0)
			high = mired;
		else
			low = mired;
	}
	spec_temperature_black_body(observer, 1e6 / mired, body);
	spec_temperature_uv(body, at);
	distance = hypot(uv[0] - at[0], uv[1] - at[1]);
	if (distance > SPEC_TEMPERATURE_FARTHEST || mired < LOWEST_MIRED - END_MIRED ||
		mired > HIGHEST_MIRED + END_MIRED)
		return;
	*cct_k = 1e6 / mired;
	*duv = uv[1] < at[1] ? -distance : distance;
}
