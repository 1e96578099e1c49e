#include "colour/upsample.h"

#include <float.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "base/memory.h"
#include "base/vector.h"
#include "colour/difference.h"
#include "colour/observer.h"
#include "spectrum/lookup.h"
#include "spectrum/mean.h"
#include "spectrum/sigmoid.h"

/* How far the illuminant's chromaticity may lie from the space's white, in x and in y. */
#define SAME_WHITE .001

/* CIE 15:2018: where CIELAB's cube root meets the straight line, and the line's slope. */
#define LAB_EPSILON (216. / 24389)
#define LAB_KAPPA (24389. / 27)

/* The fit ends at this difference in CIELAB, or where no damping makes a step better. */
#define MET 1e-10
#define MOST_STEPS 100
#define FIRST_DAMPING 1e-3
#define LEAST_DAMPING 1e-15
#define MOST_DAMPING 1e10

/*
 * The largest coefficient in the fit, over 1 + |x| of the grey that is as bright. sRGB
 * needs some 20; colours that no reflectance has would else grow edges without bound.
 */
#define MOST_COEFFICIENT 1000

#define LIGHT_PIECE_NM .1 /* over one, light and sigmoid are averaged each for itself */

/* A colour to be met, with the wavelengths of the observer scaled to [-1, 1]. */
struct fit {
	const struct spec_upsampler *upsampler;
	double middle_nm, half_nm;
	double goal[3]; /* CIELAB */
	double limit;   /* of the coefficients */
};

/* Where a fit stands: c[0] t^2 + c[1] t + c[2]. */
struct state {
	double c[3];
	double miss[3];  /* the goal less what this gives, in CIELAB */
	double slope[9]; /* slope[3 * r + k]: of CIELAB's r-th coordinate by c[k] */
	double square;   /* of the miss */
};

/* The colours */

static enum spec_status
check_white(const struct spec_space *space, const double white[3], struct spec_error *error)
{
	double sum = white[0] + white[1] + white[2];
	double x = white[0] / sum, y = white[1] / sum;

	if (fabs(x - space->white_xy[0]) <= SAME_WHITE &&
		fabs(y - space->white_xy[1]) <= SAME_WHITE)
		return SPEC_OK;
	return spec_error_set(error, SPEC_ERANGE,
		"the illuminant (x %.4f, y %.4f) is not the white of %s (x %.4f, y %.4f)",
		x, y, space->title, space->white_xy[0], space->white_xy[1]);
}

static enum spec_status
find_matrix(const struct spec_space *space, struct spec_upsampler *upsampler,
	struct spec_error *error)
{
	enum spec_status status = spec_space_to_xyz(space, upsampler->to_xyz, error);
	double nominal[3], adaptation[9];

	if (status != SPEC_OK)
		return status;
	spec_white_xyz(space->white_xy, nominal);
	status = spec_adaptation_matrix(
		SPEC_ADAPTATION_BRADFORD, nominal, upsampler->white, adaptation, error);
	if (status == SPEC_OK)
		spec_matrix_multiply(adaptation, upsampler->to_xyz, upsampler->to_xyz);
	return status;
}

/* Y = 1 for the light, where light of 1 per nm has Y = 1 too. */
static enum spec_status
normalise_light(const struct spec_curve *observer, const struct spec_curve *illuminant,
	struct spec_upsampler *upsampler, struct spec_error *error)
{
	struct spec_curve *light = &upsampler->light;
	enum spec_status status = spec_curve_copy(illuminant, light, error);
	const double *ybar = observer->value + observer->count;
	double *power;
	double sum = 0, level = 0;

	if (status != SPEC_OK)
		return status;
	power = spec_memory_new(observer->count, sizeof *power, "wavelengths", error);
	status = power ? spec_curve_sample(light, 0, SPEC_EXTRAPOLATE_ZERO,
				 observer->wavelength_nm, observer->count, power, error)
		       : SPEC_ENOMEM;
	for (size_t i = 0; status == SPEC_OK && i < observer->count; i++) {
		sum += ybar[i] * power[i];
		level += ybar[i];
	}
	for (size_t i = 0; status == SPEC_OK && i < light->count * light->columns; i++)
		light->value[i] *= level / sum;
	free(power);
	return status;
}

/* The observer's samples and their weights, for point samples at those wavelengths. */
static enum spec_status
weigh(const struct spec_curve *observer, const struct spec_curve *illuminant,
	struct spec_upsampler *upsampler, struct spec_error *error)
{
	struct spec_bands bands = {
		.count = observer->count, .wavelength_nm = observer->wavelength_nm};
	double outside;

	upsampler->count = bands.count;
	upsampler->wavelength_nm = spec_memory_new(
		bands.count, sizeof *upsampler->wavelength_nm, "wavelengths", error);
	upsampler->weight = spec_memory_new(
		bands.count, 3 * sizeof *upsampler->weight, "weights", error);
	if (!upsampler->wavelength_nm || !upsampler->weight)
		return SPEC_ENOMEM;
	memcpy(upsampler->wavelength_nm, observer->wavelength_nm,
		bands.count * sizeof *upsampler->wavelength_nm);
	return spec_observer_weights(
		observer, illuminant, &bands, upsampler->weight, &outside, error);
}

enum spec_status
spec_upsampler_new(const struct spec_space *space, const struct spec_curve *observer,
	const struct spec_curve *illuminant, struct spec_upsampler *upsampler,
	struct spec_error *error)
{
	enum spec_status status;

	*upsampler = (struct spec_upsampler){0};
	status = spec_observer_white(observer, illuminant, upsampler->white, error);
	if (status == SPEC_OK)
		status = check_white(space, upsampler->white, error);
	if (status == SPEC_OK)
		status = find_matrix(space, upsampler, error);
	if (status == SPEC_OK)
		status = weigh(observer, illuminant, upsampler, error);
	if (status == SPEC_OK)
		status = normalise_light(observer, illuminant, upsampler, error);
	if (status != SPEC_OK)
		spec_upsampler_free(upsampler);
	return status;
}

static const struct spec_white *
find_white(const struct spec_space *space)
{
	const struct spec_white *white = NULL;

	for (size_t i = 0; (white = spec_white_at(i)); i++)
		if (fabs(white->xy[0] - space->white_xy[0]) <= SAME_WHITE &&
			fabs(white->xy[1] - space->white_xy[1]) <= SAME_WHITE)
			break;
	return white;
}

enum spec_status
spec_upsampler_load(const struct spec_space *space, struct spec_upsampler *upsampler,
	struct spec_error *error)
{
	const struct spec_white *white = find_white(space);
	struct spec_curve observer = {0}, illuminant = {0};
	enum spec_status status;
	char name[64];

	*upsampler = (struct spec_upsampler){0};
	if (!white)
		return spec_error_set(error, SPEC_EUNSUPPORTED,
			"no illuminant is known that is the white of %s (x %.4f, y %.4f)",
			space->title, space->white_xy[0], space->white_xy[1]);
	snprintf(name, sizeof name, "illuminants/%s", white->name);
	status = spec_lookup_curve(spec_observer_spectrum("1931"), &observer, error);
	if (status == SPEC_OK)
		status = spec_lookup_curve(name, &illuminant, error);
	if (status == SPEC_OK)
		status =
			spec_upsampler_new(space, &observer, &illuminant, upsampler, error);
	spec_curve_free(&observer);
	spec_curve_free(&illuminant);
	return status;
}

void
spec_upsampler_free(struct spec_upsampler *upsampler)
{
	if (!upsampler)
		return;
	free(upsampler->wavelength_nm);
	free(upsampler->weight);
	spec_curve_free(&upsampler->light);
	*upsampler = (struct spec_upsampler){0};
}

/* The fit */

/* The x of which S(x) is value, which lies in [0, 1]. */
static double
inverse_sigmoid(double value)
{
	return (value - .5) / sqrt(value * (1 - value));
}

/* Samples are added up side by side, and these sums at the end. */
#define LANES 8
#define SUMS 12 /* XYZ, then its slopes, laid out as a state's */

/* Adds samples i to i + lanes - 1. */
static inline void
add_samples(const struct fit *fit, const double c[3], size_t i, size_t lanes,
	double sum[SUMS][LANES])
{
	const struct spec_upsampler *up = fit->upsampler;

	for (size_t k = 0; k < lanes; k++) {
		double t = (up->wavelength_nm[i + k] - fit->middle_nm) / fit->half_nm;
		double x = (c[0] * t + c[1]) * t + c[2], square = 1 + x * x;
		double value = spec_sigmoid_of(x), rise = .5 / (square * sqrt(square));

		for (int r = 0; r < 3; r++) {
			double weight = up->weight[(size_t)r * up->count + i + k];
			double slope_2 = weight * rise, slope_1 = slope_2 * t;

			sum[r][k] += weight * value;
			sum[3 + 3 * r][k] += slope_1 * t;
			sum[3 + 3 * r + 1][k] += slope_1;
			sum[3 + 3 * r + 2][k] += slope_2;
		}
	}
}

/* XYZ of the spectrum with coefficients c, and its slopes, laid out as a state's. */
SPEC_VECTORISED static void
project(const struct fit *fit, const double c[3], double xyz[3], double slope[9])
{
	double sum[SUMS][LANES] = {{0}};
	size_t count = fit->upsampler->count, i = 0;

	for (; i + LANES <= count; i += LANES)
		add_samples(fit, c, i, LANES, sum);
	add_samples(fit, c, i, count - i, sum);
	for (int j = 0; j < SUMS; j++) {
		double *to = j < 3 ? &xyz[j] : &slope[j - 3];

		*to = 0;
		for (int k = 0; k < LANES; k++)
			*to += sum[j][k];
	}
}

/* The slope of CIELAB's f, the cube root that is straight near 0. */
static double
lab_root_slope(double ratio)
{
	double root = cbrt(ratio);

	return ratio > LAB_EPSILON ? 1 / (3 * root * root) : LAB_KAPPA / 116;
}

/* Fills in what follows from a state's coefficients. */
static void
look(const struct fit *fit, struct state *state)
{
	const double *white = fit->upsampler->white;
	double xyz[3], lab[3], steep[3];

	project(fit, state->c, xyz, state->slope);
	spec_lab_from_xyz(xyz, white, lab);
	state->square = 0;
	for (int r = 0; r < 3; r++) {
		state->miss[r] = fit->goal[r] - lab[r];
		state->square += state->miss[r] * state->miss[r];
		steep[r] = lab_root_slope(xyz[r] / white[r]) / white[r];
	}
	for (int k = 0; k < 3; k++) {
		double x = steep[0] * state->slope[k], y = steep[1] * state->slope[3 + k],
		       z = steep[2] * state->slope[6 + k];

		state->slope[k] = 116 * y;
		state->slope[3 + k] = 500 * (x - y);
		state->slope[6 + k] = 200 * (y - z);
	}
}

/*
 * The coefficients a damped step away: (J'J + damping diag J'J) step = J' miss. Returns 0
 * where there is no such step or it leaves the limit.
 */
static int
step_from(const struct fit *fit, const struct state *state, double damping, double c[3])
{
	const double *slope = state->slope;
	double normal[9], inverse[9], right[3], step[3];

	for (int i = 0; i < 3; i++) {
		right[i] = 0;
		for (int r = 0; r < 3; r++)
			right[i] += slope[3 * r + i] * state->miss[r];
		for (int k = 0; k < 3; k++) {
			normal[3 * i + k] = 0;
			for (int r = 0; r < 3; r++)
				normal[3 * i + k] += slope[3 * r + i] * slope[3 * r + k];
		}
		normal[4 * i] *= 1 + damping;
	}
	if (spec_matrix_invert(normal, inverse, NULL) != SPEC_OK)
		return 0;
	spec_matrix_apply(inverse, right, step);
	for (int i = 0; i < 3; i++) {
		c[i] = state->c[i] + step[i];
		if (!(fabs(c[i]) <= fit->limit))
			return 0;
	}
	return 1;
}

static void
descend(const struct fit *fit, struct state *state)
{
	double damping = FIRST_DAMPING;

	look(fit, state);
	for (int i = 0; i < MOST_STEPS && state->square > MET * MET; i++) {
		struct state next;

		if (damping > MOST_DAMPING)
			break;
		if (step_from(fit, state, damping, next.c)) {
			look(fit, &next);
			if (next.square < state->square) {
				*state = next;
				damping = fmax(damping / 10, LEAST_DAMPING);
				continue;
			}
		}
		damping *= 10;
	}
}

/* From t in [-1, 1] to wavelengths. */
static void
set_polynomial(const struct fit *fit, const double c[3], struct spec_sigmoid *sigmoid)
{
	double a = c[0] / (fit->half_nm * fit->half_nm), b = c[1] / fit->half_nm;
	double middle = fit->middle_nm;

	sigmoid->c0_per_nm2 = a;
	sigmoid->c1_per_nm = b - 2 * a * middle;
	sigmoid->c2 = (a * middle - b) * middle + c[2];
}

/* The polynomial of a spectrum, of t in [-1, 1]. */
static void
get_polynomial(const struct fit *fit, const struct spec_sigmoid *sigmoid, double c[3])
{
	double a = sigmoid->c0_per_nm2, b = sigmoid->c1_per_nm, middle = fit->middle_nm;

	c[0] = a * fit->half_nm * fit->half_nm;
	c[1] = (b + 2 * a * middle) * fit->half_nm;
	c[2] = (a * middle + b) * middle + sigmoid->c2;
}

/* The spectrum of a colour in [0, 1] that is not grey; start: null, or one near it. */
static void
fit_colour(const struct spec_upsampler *upsampler, const double rgb[3],
	const struct spec_sigmoid *start, struct spec_sigmoid *sigmoid)
{
	double first_nm = upsampler->wavelength_nm[0];
	double last_nm = upsampler->wavelength_nm[upsampler->count - 1];
	struct fit fit = {
		upsampler, .5 * (first_nm + last_nm), .5 * (last_nm - first_nm), {0}, 0};
	struct state state = {0};
	double xyz[3], level;

	spec_matrix_apply(upsampler->to_xyz, rgb, xyz);
	spec_lab_from_xyz(xyz, upsampler->white, fit.goal);
	/* A colour's Y is some mean of its components: never 0 or 1, but for rounding. */
	level = inverse_sigmoid(fmin(fmax(xyz[1], 1e-16), 1 - 1e-16));
	fit.limit = MOST_COEFFICIENT * (1 + fabs(level));
	if (start)
		get_polynomial(&fit, start, state.c);
	else
		state.c[2] = level;
	descend(&fit, &state);
	set_polynomial(&fit, state.c, sigmoid);
}

static enum spec_status
check_rgb(const double rgb[3], double most, struct spec_error *error)
{
	for (int i = 0; i < 3; i++)
		if (!(rgb[i] >= 0 && rgb[i] <= most))
			return spec_error_set(error, SPEC_ERANGE,
				"%s %g of a colour is not in [0, %g]",
				i == 0   ? "red"
				: i == 1 ? "green"
					 : "blue",
				rgb[i], most);
	return SPEC_OK;
}

enum spec_status
spec_upsample_albedo_from(const struct spec_upsampler *upsampler, const double rgb[3],
	const struct spec_sigmoid *start, struct spec_sigmoid *sigmoid,
	struct spec_error *error)
{
	enum spec_status status = check_rgb(rgb, 1, error);

	*sigmoid = (struct spec_sigmoid){.scale = 1};
	if (status != SPEC_OK)
		return status;
	if (rgb[0] == rgb[1] && rgb[1] == rgb[2])
		sigmoid->c2 = inverse_sigmoid(rgb[0]);
	else
		fit_colour(upsampler, rgb, start, sigmoid);
	return SPEC_OK;
}

enum spec_status
spec_upsample_albedo(const struct spec_upsampler *upsampler, const double rgb[3],
	struct spec_sigmoid *sigmoid, struct spec_error *error)
{
	return spec_upsample_albedo_from(upsampler, rgb, NULL, sigmoid, error);
}

enum spec_status
spec_upsample_unbounded(const struct spec_upsampler *upsampler, const double rgb[3],
	struct spec_sigmoid *sigmoid, struct spec_error *error)
{
	enum spec_status status = check_rgb(rgb, DBL_MAX / 2, error);
	double scale, part[3];

	*sigmoid = (struct spec_sigmoid){0};
	if (status != SPEC_OK)
		return status;
	scale = 2 * fmax(rgb[0], fmax(rgb[1], rgb[2]));
	if (scale == 0)
		return SPEC_OK;
	for (int i = 0; i < 3; i++)
		part[i] = rgb[i] / scale;
	status = spec_upsample_albedo(upsampler, part, sigmoid, error);
	sigmoid->scale = scale;
	return status;
}

/* Coloured lights */

enum spec_status
spec_upsampler_sample_light(const struct spec_upsampler *upsampler,
	const struct spec_sigmoid *sigmoid, enum spec_extrapolate extrapolate,
	const double *wavelength_nm, size_t count, double *value, struct spec_error *error)
{
	double *light = spec_memory_new(count, sizeof *light, "wavelengths", error);
	enum spec_status status =
		light ? spec_curve_sample(&upsampler->light, 0, extrapolate, wavelength_nm,
				count, light, error)
		      : SPEC_ENOMEM;

	if (status == SPEC_OK)
		spec_sigmoid_sample(sigmoid, wavelength_nm, count, value);
	for (size_t i = 0; status == SPEC_OK && i < count; i++)
		value[i] *= light[i];
	free(light);
	return status;
}

/* Room for the pieces of a bin. */
struct pieces {
	double *edge_nm, *light, *part;
};

static enum spec_status
mean_light_of_bin(const struct spec_upsampler *upsampler,
	const struct spec_sigmoid *sigmoid, enum spec_extrapolate extrapolate,
	const double bin_nm[2], const struct pieces *pieces, double *mean,
	struct spec_error *error)
{
	double width_nm = bin_nm[1] - bin_nm[0], sum = 0;
	size_t count = spec_sigmoid_pieces(sigmoid, width_nm, LIGHT_PIECE_NM);
	enum spec_status status;

	for (size_t j = 0; j < count; j++)
		pieces->edge_nm[j] = bin_nm[0] + width_nm * ((double)j / (double)count);
	pieces->edge_nm[count] = bin_nm[1];
	status = spec_curve_mean(&upsampler->light, 0, extrapolate, pieces->edge_nm, count,
		pieces->light, error);
	if (status != SPEC_OK)
		return status;
	spec_sigmoid_mean(sigmoid, pieces->edge_nm, count, pieces->part);
	for (size_t j = 0; j < count; j++)
		sum += pieces->light[j] * pieces->part[j];
	*mean = sum / (double)count;
	return SPEC_OK;
}

static size_t
most_pieces(const struct spec_sigmoid *sigmoid, const double *edges_nm, size_t bins)
{
	size_t most = 1;

	for (size_t i = 0; i < bins; i++) {
		size_t count = spec_sigmoid_pieces(
			sigmoid, edges_nm[i + 1] - edges_nm[i], LIGHT_PIECE_NM);

		most = count > most ? count : most;
	}
	return most;
}

enum spec_status
spec_upsampler_mean_light(const struct spec_upsampler *upsampler,
	const struct spec_sigmoid *sigmoid, enum spec_extrapolate extrapolate,
	const double *edges_nm, size_t bins, double *value, struct spec_error *error)
{
	size_t room = most_pieces(sigmoid, edges_nm, bins) + 1;
	double *memory = spec_memory_new(room, 3 * sizeof *memory, "pieces", error);
	enum spec_status status = memory ? SPEC_OK : SPEC_ENOMEM;

	for (size_t i = 0; status == SPEC_OK && i < bins; i++) {
		struct pieces pieces = {memory, memory + room, memory + 2 * room};

		status = mean_light_of_bin(upsampler, sigmoid, extrapolate, edges_nm + i,
			&pieces, value + i, error);
	}
	free(memory);
	return status;
}
