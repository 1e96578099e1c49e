#include "render/bands.h"

#include <stdlib.h>
#include <string.h>

#include "base/memory.h"
#include "base/vector.h"
#include "colour/upsample.h"
#include "spectrum/mean.h"
#include "spectrum/planck.h"
#include "spectrum/rebin.h"

enum spec_status
spec_bands_make(struct spec_bands_grid *bands, const struct spec_grid *grid,
	enum spec_extrapolate extrapolate, struct spec_error *error)
{
	size_t count = grid->count;

	*bands = (struct spec_bands_grid){.count = count, .extrapolate = extrapolate};
	bands->wavelength_nm = spec_memory_new(count, sizeof(double), "bands", error);
	bands->edges_nm = spec_memory_new(count + 1, sizeof(double), "bands", error);
	if (!bands->wavelength_nm || !bands->edges_nm) {
		spec_bands_free(bands);
		return SPEC_ENOMEM;
	}
	memcpy(bands->wavelength_nm, grid->wavelength_nm, count * sizeof(double));
	spec_bins_halfway(grid->wavelength_nm, count, bands->edges_nm);
	return SPEC_OK;
}

void
spec_bands_free(struct spec_bands_grid *bands)
{
	free(bands->wavelength_nm);
	free(bands->edges_nm);
	*bands = (struct spec_bands_grid){0};
}

static enum spec_status
sample_curve(const struct spec_bands_grid *bands, const struct spec_curve *curve,
	enum spec_bands_use use, double *value, struct spec_error *error)
{
	enum spec_extrapolate rule =
		use == SPEC_BANDS_LIGHT ? SPEC_EXTRAPOLATE_ZERO : bands->extrapolate;

	/* The outer edges may reach beyond data that the bands' middles do not leave. */
	if (use == SPEC_BANDS_RATIO) {
		enum spec_status status = spec_curve_sample(
			curve, 0, rule, bands->wavelength_nm, bands->count, value, error);

		if (status != SPEC_OK)
			return status;
		rule = SPEC_EXTRAPOLATE_CONSTANT;
	}
	if (use == SPEC_BANDS_INDEX)
		return spec_curve_sample(
			curve, 0, rule, bands->wavelength_nm, bands->count, value, error);
	return spec_curve_mean(curve, 0, rule, bands->edges_nm, bands->count, value, error);
}

/* A first bin of a wide step may reach below 0 nm, where nothing shines. */
static void
sample_blackbody(const struct spec_bands_grid *bands, double temperature_k, double *value)
{
	double from_nm = bands->edges_nm[0], within_nm[2] = {0, bands->edges_nm[1]};

	spec_planck_relative_mean(temperature_k, bands->edges_nm, bands->count, value);
	if (from_nm < 0) {
		spec_planck_relative_mean(temperature_k, within_nm, 1, value);
		value[0] *= within_nm[1] / (within_nm[1] - from_nm);
	}
}

static enum spec_status
sample_spectrum(const struct spec_bands_grid *bands, const struct spec_spectrum *spectrum,
	enum spec_bands_use use, double *value, struct spec_error *error)
{
	enum spec_status status;

	if (use == SPEC_BANDS_LIGHT)
		return spec_spectrum_mean(spectrum, SPEC_EXTRAPOLATE_ZERO, bands->edges_nm,
			bands->count, value, error);
	status = spec_spectrum_sample(spectrum, bands->extrapolate, bands->wavelength_nm,
		bands->count, value, error);
	if (status != SPEC_OK || use == SPEC_BANDS_INDEX)
		return status;
	/* The outer edges may reach beyond data that the bands' middles do not leave. */
	return spec_spectrum_mean(spectrum, SPEC_EXTRAPOLATE_CONSTANT, bands->edges_nm,
		bands->count, value, error);
}

static enum spec_status
sample_rgb(const struct spec_bands_grid *bands, const double rgb[3],
	enum spec_bands_use use, double *value, struct spec_error *error)
{
	struct spec_upsampler upsampler = {0};
	struct spec_sigmoid sigmoid;
	const struct spec_space *space = spec_space_find("srgb", error);
	enum spec_status status =
		space ? spec_upsampler_load(space, &upsampler, error) : SPEC_EUSAGE;

	if (status == SPEC_OK && use == SPEC_BANDS_RATIO)
		status = spec_upsample_albedo(&upsampler, rgb, &sigmoid, error);
	else if (status == SPEC_OK)
		status = spec_upsample_unbounded(&upsampler, rgb, &sigmoid, error);
	if (status == SPEC_OK && use == SPEC_BANDS_LIGHT)
		status = spec_upsampler_mean_light(&upsampler, &sigmoid,
			SPEC_EXTRAPOLATE_ZERO, bands->edges_nm, bands->count, value, error);
	else if (status == SPEC_OK && use == SPEC_BANDS_INDEX)
		spec_sigmoid_sample(&sigmoid, bands->wavelength_nm, bands->count, value);
	else if (status == SPEC_OK)
		spec_sigmoid_mean(&sigmoid, bands->edges_nm, bands->count, value);
	spec_upsampler_free(&upsampler);
	return status;
}

enum spec_status
spec_bands_sample(const struct spec_bands_grid *bands, const struct spec_scene *scene,
	const struct spec_scene_spectrum *spectrum, enum spec_bands_use use, double *value,
	struct spec_error *error)
{
	enum spec_status status = SPEC_OK;

	switch (spectrum->kind) {
	case SPEC_SCENE_CONSTANT:
		for (size_t i = 0; i < bands->count; i++)
			value[i] = spectrum->value;
		break;
	case SPEC_SCENE_BLACKBODY:
		sample_blackbody(bands, spectrum->value, value);
		break;
	case SPEC_SCENE_CURVE:
		status = sample_curve(bands, &spectrum->curve, use, value, error);
		break;
	case SPEC_SCENE_SPECTRUM:
		status = sample_spectrum(bands, &spectrum->spectrum, use, value, error);
		break;
	case SPEC_SCENE_RGB:
		status = sample_rgb(bands, spectrum->rgb, use, value, error);
		break;
	}
	if (status != SPEC_OK)
		spec_scene_prefix(scene, &spectrum->place, error);
	return status;
}

SPEC_VECTORISED void
spec_bands_add_product(float *restrict sum, const float *restrict a,
	const float *restrict b, float weight, size_t count)
{
	for (size_t i = 0; i < count; i++)
		sum[i] += weight * a[i] * b[i];
}
