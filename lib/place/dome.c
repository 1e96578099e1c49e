#include "place/dome.h"

#include <math.h>
#include <string.h>

#include "base/vector.h"
#include "spectrum/lookup.h"

#define RADIANS (M_PI / 180)

#define BANDS SPEC_DOME_BANDS
#define TURBIDITIES 10
#define ALBEDOS 2
#define POINTS 6  /* of a curve over the elevation */
#define SHAPES 9  /* coefficients of H 8 */
#define PIECES 45 /* of the sun's radiance over the elevation */
#define POWERS 4  /* in a piece */
#define LIMBS 6

/* ---- the data ---- */

/* A table of so many columns over the bands. */
static enum spec_status
load(const char *name, size_t columns, struct spec_curve *curve, struct spec_error *error)
{
	enum spec_status status = spec_lookup_curve(name, curve, error);

	if (status != SPEC_OK)
		return status;
	status =
		curve->columns == columns && curve->count == BANDS ? SPEC_OK : SPEC_EFORMAT;
	for (size_t i = 0; i < BANDS && status == SPEC_OK; i++)
		if (curve->wavelength_nm[i] != SPEC_DOME_LOW_NM + SPEC_DOME_STEP_NM * i)
			status = SPEC_EFORMAT;
	if (status == SPEC_OK)
		return SPEC_OK;
	spec_error_set(error, status,
		"'%s' is not a table of %zu columns over the %d bands from %g to %g nm",
		name, columns, BANDS, SPEC_DOME_LOW_NM, SPEC_DOME_HIGH_NM);
	spec_curve_free(curve);
	return status;
}

/* Where something lies between the tables of turbidities and albedos, and its weight. */
struct corner {
	size_t table; /* TURBIDITIES * albedo + turbidity - 1 */
	double weight;
};

/* The four tables around a turbidity and an albedo. */
static void
find_corners(double turbidity, double albedo, struct corner corner[static 4])
{
	int whole = (int)fmin(turbidity, TURBIDITIES - 1);
	double rest = turbidity - whole;

	for (int i = 0; i < 4; i++) {
		int bright = i / 2, murky = i % 2;

		corner[i].table = (size_t)(TURBIDITIES * bright + whole - 1 + murky);
		corner[i].weight =
			(bright ? albedo : 1 - albedo) * (murky ? rest : 1 - rest);
	}
}

/* The weights of the control points at a place x, 0 to 1, along a curve: H 11, quintic. */
static void
find_points(double x, double weight[static POINTS])
{
	static const double binomial[POINTS] = {1, 5, 10, 10, 5, 1};

	for (int i = 0; i < POINTS; i++)
		weight[i] = binomial[i] * pow(x, i) * pow(1 - x, POINTS - 1 - i);
}

/* The sum over tables and control points of the data of one band, step apart. */
static double
combine(const struct spec_curve *data, size_t band, size_t step, size_t shape,
	const struct corner corner[static 4], const double point[static POINTS])
{
	double sum = 0;

	for (int i = 0; i < 4; i++)
		for (size_t j = 0; j < POINTS; j++) {
			size_t column = (corner[i].table * POINTS + j) * step + shape;

			sum += corner[i].weight * point[j] *
			       data->value[column * BANDS + band];
		}
	return sum;
}

static enum spec_status
make_sky(double elevation_rad, const struct spec_atmosphere *atmosphere,
	struct spec_dome *dome, struct spec_error *error)
{
	const size_t tables = TURBIDITIES * ALBEDOS;
	struct spec_curve shapes = {0}, means = {0};
	struct corner corner[4];
	double point[POINTS];
	enum spec_status status = load(
		"sky/hosek-wilkie-distribution", tables * POINTS * SHAPES, &shapes, error);

	if (status == SPEC_OK)
		status = load("sky/hosek-wilkie-radiance", tables * POINTS, &means, error);
	find_corners(atmosphere->turbidity, atmosphere->ground_albedo, corner);
	find_points(cbrt(elevation_rad / (M_PI / 2)), point);
	for (size_t i = 0; i < BANDS && status == SPEC_OK; i++) {
		for (size_t j = 0; j < SHAPES; j++)
			dome->distribution[j][i] =
				combine(&shapes, i, SHAPES, j, corner, point);
		dome->radiance[i] = combine(&means, i, 1, 0, corner, point);
	}
	spec_curve_free(&shapes);
	spec_curve_free(&means);
	return status;
}

/* The sun's radiance at a band for one of the turbidities: a cubic per piece. */
static double
sun_radiance(
	const struct spec_curve *data, size_t band, int turbidity, double elevation_rad)
{
	int piece = (int)fmin(cbrt(elevation_rad / (M_PI / 2)) * PIECES, PIECES - 1);
	double start = piece / (double)PIECES;
	double x = elevation_rad - start * start * start * (M_PI / 2), value = 0;
	size_t first = ((size_t)(turbidity - 1) * PIECES + (size_t)piece) * POWERS;

	for (size_t i = 0; i < POWERS; i++)
		value = value * x + data->value[(first + i) * BANDS + band];
	return value;
}

static enum spec_status
make_disc(double elevation_rad, double turbidity, struct spec_dome *dome,
	struct spec_error *error)
{
	struct spec_curve suns = {0}, limbs = {0};
	int whole = (int)fmin(turbidity, TURBIDITIES - 1);
	double rest = turbidity - whole;
	enum spec_status status = load("sky/hosek-wilkie-sun",
		(size_t)TURBIDITIES * PIECES * POWERS, &suns, error);

	if (status == SPEC_OK)
		status = load("sky/hosek-wilkie-limb", LIMBS, &limbs, error);
	for (size_t i = 0; i < BANDS && status == SPEC_OK; i++) {
		double clear = sun_radiance(&suns, i, whole, elevation_rad);
		double murky = sun_radiance(&suns, i, whole + 1, elevation_rad);
		double mean = 0;

		dome->disc[i] = fmax((1 - rest) * clear + rest * murky, 0);
		/* The mean of cosine^n over a disc is 2 / (n + 2). */
		for (size_t j = 0; j < LIMBS; j++)
			mean += limbs.value[j * BANDS + i] * 2 / (double)(j + 2);
		for (size_t j = 0; j < LIMBS; j++)
			dome->limb[j][i] = limbs.value[j * BANDS + i] / mean;
	}
	spec_curve_free(&suns);
	spec_curve_free(&limbs);
	return status;
}

/* ---- outside the bands ---- */

/* Every column over its value at an end of the bands without water vapour. */
static enum spec_status
compare_with_end(const struct spec_curve *wet, const struct spec_curve *dry, double end_nm,
	struct spec_curve *ratio, struct spec_error *error)
{
	enum spec_status status = spec_curve_copy(wet, ratio, error);

	for (size_t i = 0; i < wet->columns && status == SPEC_OK; i++) {
		double end;

		status = spec_curve_sample(
			dry, i, SPEC_EXTRAPOLATE_REFUSE, &end_nm, 1, &end, error);
		for (size_t j = 0; j < wet->count && status == SPEC_OK; j++)
			ratio->value[i * wet->count + j] /= end;
	}
	return status;
}

static enum spec_status
make_outside(const struct spec_clearsky_sun *sun, const struct spec_atmosphere *atmosphere,
	struct spec_dome *dome, struct spec_error *error)
{
	struct spec_curve wet = {0}, dry = {0};
	struct spec_atmosphere without = *atmosphere;
	enum spec_status status = spec_clearsky_curve(sun, atmosphere, NULL, &wet, error);

	without.water_cm = 0;
	if (status == SPEC_OK)
		status = spec_clearsky_curve(sun, &without, NULL, &dry, error);
	if (status == SPEC_OK)
		status =
			compare_with_end(&wet, &dry, SPEC_DOME_LOW_NM, &dome->below, error);
	if (status == SPEC_OK)
		status = compare_with_end(
			&wet, &dry, SPEC_DOME_HIGH_NM, &dome->beyond, error);
	spec_curve_free(&wet);
	spec_curve_free(&dry);
	return status;
}

/* ---- making ---- */

enum spec_status
spec_dome_make(const struct spec_clearsky_sun *sun,
	const struct spec_atmosphere *atmosphere, struct spec_dome *dome,
	struct spec_error *error)
{
	double zenith = sun->zenith_deg * RADIANS, azimuth = sun->azimuth_deg * RADIANS;
	double elevation = (90 - sun->zenith_deg) * RADIANS, nearness;
	enum spec_status status;

	*dome = (struct spec_dome){0};
	/* It checks the sun and the atmosphere, too. */
	status = make_outside(sun, atmosphere, dome, error);
	if (status == SPEC_OK)
		status = make_sky(elevation, atmosphere, dome, error);
	if (status == SPEC_OK)
		status = make_disc(elevation, atmosphere->turbidity, dome, error);
	if (status != SPEC_OK) {
		spec_dome_free(dome);
		return status;
	}
	/* The disc grows and keeps its radiance; the sky gets what the disc sends. */
	nearness = 1 / (sun->distance_au * sun->distance_au);
	for (int i = 0; i < BANDS; i++)
		dome->radiance[i] *= nearness;
	dome->radius_rad = asin(SPEC_DOME_SUN_RADIUS_RAD / sun->distance_au);
	dome->sun[0] = sin(zenith) * sin(azimuth);
	dome->sun[1] = sin(zenith) * cos(azimuth);
	dome->sun[2] = cos(zenith);
	return SPEC_OK;
}

void
spec_dome_free(struct spec_dome *dome)
{
	if (!dome)
		return;
	spec_curve_free(&dome->below);
	spec_curve_free(&dome->beyond);
	*dome = (struct spec_dome){0};
}

/* ---- evaluating ---- */

/* The angle between a direction and the sun's centre [rad], exact where it is small. */
static double
angle_to_sun(const struct spec_dome *dome, const double d[3], double *cosine)
{
	const double *s = dome->sun;
	double x = d[1] * s[2] - d[2] * s[1], y = d[2] * s[0] - d[0] * s[2];
	double z = d[0] * s[1] - d[1] * s[0];

	*cosine = d[0] * s[0] + d[1] * s[1] + d[2] * s[2];
	return atan2(sqrt(x * x + y * y + z * z), *cosine);
}

/* H 8 with the anisotropic term of H 9. */
SPEC_VECTORISED static void
radiate(const struct spec_dome *dome, double height, double gamma, double cosine,
	double *restrict radiance)
{
	const double(*c)[BANDS] = dome->distribution;
	double root = sqrt(height), above = 1 / (height + .01);

	for (int i = 0; i < BANDS; i++) {
		double spread = 1 + c[8][i] * c[8][i] - 2 * c[8][i] * cosine;
		double mie = (1 + cosine * cosine) / (spread * sqrt(spread));
		double horizon = 1 + c[0][i] * spec_vector_exp(c[1][i] * above);
		double shape = c[2][i] + c[3][i] * spec_vector_exp(c[4][i] * gamma) +
			       c[5][i] * cosine * cosine + c[6][i] * mie + c[7][i] * root;
		double value = horizon * shape * dome->radiance[i];

		radiance[i] = value > 0 ? value : 0;
	}
}

void
spec_dome_sky(const struct spec_dome *dome, const double direction[3],
	double radiance[static SPEC_DOME_BANDS])
{
	double cosine, gamma;

	if (direction[2] < 0) {
		memset(radiance, 0, BANDS * sizeof *radiance);
		return;
	}
	gamma = angle_to_sun(dome, direction, &cosine);
	radiate(dome, direction[2], gamma, cosine, radiance);
}

int
spec_dome_disc(const struct spec_dome *dome, const double direction[3],
	double radiance[static SPEC_DOME_BANDS])
{
	double cosine, gamma = angle_to_sun(dome, direction, &cosine), out, mu;

	memset(radiance, 0, BANDS * sizeof *radiance);
	if (direction[2] < 0 || gamma > dome->radius_rad)
		return 0;
	out = sin(gamma) / sin(dome->radius_rad);
	mu = sqrt(fmax(1 - out * out, 0));
	for (int i = 0; i < BANDS; i++) {
		double limb = 0;

		for (int j = LIMBS - 1; j >= 0; j--)
			limb = limb * mu + dome->limb[j][i];
		radiance[i] = dome->disc[i] * limb;
	}
	return 1;
}

double
spec_dome_disc_sr(const struct spec_dome *dome)
{
	double half = sin(dome->radius_rad / 2);

	return 4 * M_PI * half * half;
}

/* ---- wavelengths ---- */

/* Outside the bands: what an end of them is multiplied by. */
static enum spec_status
weigh_outside(const struct spec_dome *dome, double nm, enum spec_clearsky_column column,
	struct spec_dome_weight *weight, struct spec_error *error)
{
	int low = nm < SPEC_DOME_LOW_NM;
	double ratio;
	enum spec_status status = spec_curve_sample(low ? &dome->below : &dome->beyond,
		column, SPEC_EXTRAPOLATE_REFUSE, &nm, 1, &ratio, error);

	if (status == SPEC_OK)
		*weight = (struct spec_dome_weight){.index = low ? 0 : BANDS - 2,
			.low = low ? ratio : 0,
			.high = low ? 0 : ratio};
	return status;
}

enum spec_status
spec_dome_weigh(const struct spec_dome *dome, const double *wavelength_nm, size_t count,
	struct spec_dome_weight *sky, struct spec_dome_weight *disc,
	struct spec_error *error)
{
	enum spec_status status = SPEC_OK;

	for (size_t i = 0; i < count && status == SPEC_OK; i++) {
		double nm = wavelength_nm[i];
		double band = (nm - SPEC_DOME_LOW_NM) / SPEC_DOME_STEP_NM;
		struct spec_dome_weight weight;

		if (nm >= SPEC_DOME_LOW_NM && nm <= SPEC_DOME_HIGH_NM) {
			weight.index = (int)fmin(band, BANDS - 2);
			weight.high = band - weight.index;
			weight.low = 1 - weight.high;
			if (sky)
				sky[i] = weight;
			if (disc)
				disc[i] = weight;
			continue;
		}
		if (sky)
			status = weigh_outside(dome, nm, SPEC_CLEARSKY_SKY, &sky[i], error);
		if (disc && status == SPEC_OK)
			status = weigh_outside(
				dome, nm, SPEC_CLEARSKY_DIRECT, &disc[i], error);
	}
	return status;
}

void
spec_dome_spread(const struct spec_dome_weight *weight, size_t count,
	const double band[static SPEC_DOME_BANDS], double *radiance)
{
	for (size_t i = 0; i < count; i++)
		radiance[i] = weight[i].low * band[weight[i].index] +
			      weight[i].high * band[weight[i].index + 1];
}
