#include "colour/gaussian.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "base/memory.h"
#include "colour/dominant.h"
#include "colour/observer.h"
#include "colour/upsample.h"
#include "spectrum/lookup.h"

#define LN_2 0.693147180559945309417

/* Chromaticities closer to white than this have no direction. */
#define SAME_XY 1e-12

/* A weight is negative beyond rounding below this part of the largest. */
#define NONE 1e-9

static const double centre_nm[3] = {680, 550, 450};

/* Purity goes with the distance from white: at a distance of 1 it is 1 over the locus's. */
static enum spec_status
find_locus(const struct spec_curve *observer, struct spec_gaussian_fit *fit,
	struct spec_error *error)
{
	const double *white = fit->white_xy;
	enum spec_status status = SPEC_OK;

	for (size_t k = 0; k <= SPEC_GAUSSIAN_DIRECTIONS && status == SPEC_OK; k++) {
		double angle = M_PI * (2 * (double)k / SPEC_GAUSSIAN_DIRECTIONS - 1);
		double xy[2] = {white[0] + cos(angle), white[1] + sin(angle)}, nm;

		status = spec_dominant_find(
			observer, xy, white, &nm, &fit->nearness[k], error);
		if (status == SPEC_OK && !isfinite(fit->nearness[k]))
			status = spec_error_set(error, SPEC_EFORMAT,
				"the observer '%s' has no locus around white",
				observer->title);
	}
	return status;
}

/* The weights of light itself, at the observer's samples. */
static enum spec_status
weigh_light(const struct spec_curve *observer, struct spec_gaussian_fit *fit,
	struct spec_error *error)
{
	struct spec_bands bands = {
		.count = observer->count, .wavelength_nm = observer->wavelength_nm};
	size_t bytes = observer->count * sizeof *fit->wavelength_nm;
	double outside;

	fit->count = observer->count;
	fit->wavelength_nm = spec_memory_new(1, bytes, "wavelengths", error);
	fit->weight = spec_memory_new(3, bytes, "weights", error);
	if (!fit->wavelength_nm || !fit->weight)
		return SPEC_ENOMEM;
	memcpy(fit->wavelength_nm, observer->wavelength_nm, bytes);
	return spec_observer_weights(observer, NULL, &bands, fit->weight, &outside, error);
}

/* Those under the space's white light, which an upsampler has. */
static enum spec_status
weigh_factor(const struct spec_space *space, struct spec_gaussian_fit *fit,
	struct spec_error *error)
{
	struct spec_upsampler upsampler;
	enum spec_status status = spec_upsampler_load(space, &upsampler, error);

	if (status != SPEC_OK)
		return status;
	fit->count = upsampler.count;
	fit->wavelength_nm = upsampler.wavelength_nm;
	fit->weight = upsampler.weight;
	memcpy(fit->to_xyz, upsampler.to_xyz, sizeof fit->to_xyz);
	upsampler.wavelength_nm = upsampler.weight = NULL;
	spec_upsampler_free(&upsampler);
	return SPEC_OK;
}

enum spec_status
spec_gaussian_load(const struct spec_space *space, int lit, struct spec_gaussian_fit *fit,
	struct spec_error *error)
{
	struct spec_curve observer = {0};
	enum spec_status status;

	*fit = (struct spec_gaussian_fit){
		.white_xy = {space->white_xy[0], space->white_xy[1]}};
	status = spec_lookup_curve(spec_observer_spectrum("1931"), &observer, error);
	if (status == SPEC_OK && lit) {
		status = weigh_factor(space, fit, error);
	} else if (status == SPEC_OK) {
		status = spec_space_to_xyz(space, fit->to_xyz, error);
		if (status == SPEC_OK)
			status = weigh_light(&observer, fit, error);
	}
	if (status == SPEC_OK)
		status = find_locus(&observer, fit, error);
	spec_curve_free(&observer);
	if (status != SPEC_OK)
		spec_gaussian_free(fit);
	return status;
}

void
spec_gaussian_free(struct spec_gaussian_fit *fit)
{
	if (!fit)
		return;
	free(fit->wavelength_nm);
	free(fit->weight);
	*fit = (struct spec_gaussian_fit){0};
}

double
spec_gaussian_width(const struct spec_gaussian_fit *fit, const double rgb[3])
{
	double xyz[3], sum, x, y, distance, at, purity;
	size_t k;

	spec_matrix_apply(fit->to_xyz, rgb, xyz);
	sum = xyz[0] + xyz[1] + xyz[2];
	if (!(sum > 0))
		return SPEC_GAUSSIAN_WIDEST_NM;
	x = xyz[0] / sum - fit->white_xy[0];
	y = xyz[1] / sum - fit->white_xy[1];
	distance = hypot(x, y);
	if (distance < SAME_XY)
		return SPEC_GAUSSIAN_WIDEST_NM;
	at = (atan2(y, x) / M_PI + 1) * (.5 * SPEC_GAUSSIAN_DIRECTIONS);
	k = at < SPEC_GAUSSIAN_DIRECTIONS - 1 ? (size_t)at : SPEC_GAUSSIAN_DIRECTIONS - 1;
	purity = distance *
		 (fit->nearness[k] +
			 (at - (double)k) * (fit->nearness[k + 1] - fit->nearness[k]));
	return SPEC_GAUSSIAN_WIDEST_NM +
	       fmin(purity, 1) * (SPEC_GAUSSIAN_NARROWEST_NM - SPEC_GAUSSIAN_WIDEST_NM);
}

double
spec_gaussian_component(int i, double width_nm, double wavelength_nm)
{
	double off = 2 * (wavelength_nm - centre_nm[i]) / width_nm;

	return exp(-LN_2 * off * off);
}

double
spec_gaussian_component_mean(int i, double width_nm, double from_nm, double to_nm)
{
	double steep = 2 * sqrt(LN_2) / width_nm;
	double from = steep * (from_nm - centre_nm[i]), to = steep * (to_nm - centre_nm[i]);
	/* Far from the middle erf is near 1, and erfc keeps the digits. */
	double area = from > 0 ? erfc(from) - erfc(to)
		      : to < 0 ? erfc(-to) - erfc(-from)
			       : erf(to) - erf(from);

	return .5 * sqrt(M_PI) * area / (to - from);
}

enum spec_status
spec_gaussian_matrix(const struct spec_gaussian_fit *fit, double width_nm, double m[9],
	struct spec_error *error)
{
	double xyz[9] = {0};
	enum spec_status status;

	for (size_t k = 0; k < fit->count; k++) {
		for (int i = 0; i < 3; i++) {
			double value =
				spec_gaussian_component(i, width_nm, fit->wavelength_nm[k]);

			for (size_t c = 0; c < 3; c++)
				xyz[3 * c + (size_t)i] +=
					fit->weight[c * fit->count + k] * value;
		}
	}
	status = spec_matrix_invert(xyz, m, error);
	if (status == SPEC_OK)
		spec_matrix_multiply(m, fit->to_xyz, m);
	return status;
}

int
spec_gaussian_is_met(const double weight[3])
{
	double most = fmax(weight[0], fmax(weight[1], weight[2]));
	double least = fmin(weight[0], fmin(weight[1], weight[2]));

	return least >= -NONE * most;
}

enum spec_status
spec_gaussian_solve(const struct spec_gaussian_fit *fit, const double rgb[3],
	struct spec_gaussians *gaussians, struct spec_error *error)
{
	enum spec_status status;
	double m[9];

	*gaussians = (struct spec_gaussians){.width_nm = SPEC_GAUSSIAN_WIDEST_NM};
	for (int i = 0; i < 3; i++)
		if (!(rgb[i] >= 0 && isfinite(rgb[i])))
			return spec_error_set(error, SPEC_ERANGE,
				"a component of a colour is %g, not finite and >= 0",
				rgb[i]);
	gaussians->width_nm = spec_gaussian_width(fit, rgb);
	for (;;) {
		status = spec_gaussian_matrix(fit, gaussians->width_nm, m, error);
		if (status != SPEC_OK)
			return status;
		spec_matrix_apply(m, rgb, gaussians->weight);
		if (gaussians->width_nm <= SPEC_GAUSSIAN_NARROWEST_NM ||
			spec_gaussian_is_met(gaussians->weight))
			break;
		gaussians->width_nm = fmax(gaussians->width_nm * SPEC_GAUSSIAN_STEP,
			SPEC_GAUSSIAN_NARROWEST_NM);
	}
	for (int i = 0; i < 3; i++)
		gaussians->weight[i] = fmax(gaussians->weight[i], 0);
	return SPEC_OK;
}

void
spec_gaussians_sample(const struct spec_gaussians *gaussians, const double *wavelength_nm,
	size_t count, double *value)
{
	for (size_t k = 0; k < count; k++) {
		value[k] = 0;
		for (int i = 0; i < 3; i++)
			value[k] += gaussians->weight[i] * spec_gaussian_component(i,
								   gaussians->width_nm,
								   wavelength_nm[k]);
	}
}

void
spec_gaussians_mean(const struct spec_gaussians *gaussians, const double *edges_nm,
	size_t bins, double *value)
{
	for (size_t k = 0; k < bins; k++) {
		value[k] = 0;
		for (int i = 0; i < 3; i++)
			value[k] += gaussians->weight[i] *
				    spec_gaussian_component_mean(i, gaussians->width_nm,
					    edges_nm[k], edges_nm[k + 1]);
	}
}
