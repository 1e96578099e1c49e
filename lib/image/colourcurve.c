#include "image/colourcurve.h"

#include <float.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "base/memory.h"
#include "base/number.h"
#include "colour/basis.h"
#include "colour/models.h"
#include "colour/smits.h"
#include "colour/space.h"
#include "colour/gaussian.h"
#include "colour/upsample.h"
#include "image/fromrgb.h"
#include "spectrum/mean.h"
#include "spectrum/rebin.h"

#define LINEAR "rgb:"
#define ROUNDED 1e-3 /* by how much three digits of YUV may leave the range of RGB */

/* Smits' steps and a light are averaged each for itself over pieces of this share. */
#define PIECES_PER_NM 10

/* The model that a text begins with, as in "hsv:", or null. */
static const struct spec_model *
model_of(const char *text)
{
	const struct spec_model *model;

	for (size_t i = 0; (model = spec_model_at(i)); i++) {
		size_t length = strlen(model->name);

		if (strncmp(text, model->name, length) == 0 && text[length] == ':')
			return model;
	}
	return NULL;
}

int
spec_colour_curve_is_name(const char *text)
{
	return text[0] == '#' || strncmp(text, LINEAR, strlen(LINEAR)) == 0 ||
	       model_of(text) != NULL;
}

static enum spec_status
parse_code(const char *text, double rgb[3], struct spec_error *error)
{
	unsigned long code;

	if (strlen(text) != 7 || strspn(text + 1, "0123456789abcdefABCDEF") != 6)
		return spec_error_set(
			error, SPEC_EUSAGE, "'%.100s' is no colour #rrggbb", text);
	code = strtoul(text + 1, NULL, 16);
	for (int i = 0; i < 3; i++)
		rgb[i] = spec_srgb_decode((double)(code >> (16 - 8 * i) & 255) / 255);
	return SPEC_OK;
}

/* So many numbers with commas between them; form: what the text should be. */
static enum spec_status
parse_numbers(const char *text, const char *form, size_t count, const double *least,
	const double *most, double *value, struct spec_error *error)
{
	const char *at = strchr(text, ':') + 1;

	for (size_t i = 0; i < count; i++) {
		size_t length = i + 1 < count ? strcspn(at, ",") : strlen(at);
		char number[64];
		enum spec_status status;

		if (length >= sizeof number || (i + 1 < count && at[length] != ','))
			return spec_error_set(
				error, SPEC_EUSAGE, "'%.100s' is no colour %s", text, form);
		memcpy(number, at, length);
		number[length] = '\0';
		status = spec_number_parse(number, least[i], most[i],
			"a component of the colour", &value[i], error);
		if (status != SPEC_OK)
			return status;
		at += length + 1;
	}
	return SPEC_OK;
}

/* A colour of a model, which is encoded. */
static enum spec_status
parse_model(const struct spec_model *model, const char *text, double rgb[3],
	struct spec_error *error)
{
	static const char *const parts[3] = {"red", "green", "blue"};
	double margin = model->kind == SPEC_MODEL_YUV ? ROUNDED : 0;
	double value[SPEC_MODEL_MOST], least[SPEC_MODEL_MOST], most[SPEC_MODEL_MOST];
	char form[32];
	enum spec_status status;

	for (size_t i = 0; i < model->components; i++) {
		least[i] = model->least[i] - margin;
		most[i] = model->most[i] + margin;
	}
	(void)snprintf(form, sizeof form, "%s:%s,%s,%s%s%s", model->name,
		model->component[0], model->component[1], model->component[2],
		model->components > 3 ? "," : "",
		model->components > 3 ? model->component[3] : "");
	status = parse_numbers(text, form, model->components, least, most, value, error);
	if (status != SPEC_OK)
		return status;
	spec_model_to_rgb(model, value, rgb);
	for (int i = 0; i < 3; i++) {
		if (!(rgb[i] >= -ROUNDED && rgb[i] <= 1 + ROUNDED))
			return spec_error_set(error, SPEC_ERANGE,
				"'%.100s' is no colour of RGB: its %s is %.4g, not in [0, 1]",
				text, parts[i], rgb[i]);
		rgb[i] = spec_srgb_decode(fmin(fmax(rgb[i], 0), 1));
	}
	return SPEC_OK;
}

enum spec_status
spec_colour_curve_parse(const char *text, double rgb[3], struct spec_error *error)
{
	static const double least[3] = {0}, most[3] = {FLT_MAX, FLT_MAX, FLT_MAX};
	const struct spec_model *model = model_of(text);

	if (text[0] == '#')
		return parse_code(text, rgb, error);
	return model ? parse_model(model, text, rgb, error)
		     : parse_numbers(text, "rgb:R,G,B", 3, least, most, rgb, error);
}

/* Smits' mean over a bin, or that of its product with a light. */
static enum spec_status
mean_of_steps(const struct spec_curve *steps, const double *weight,
	const struct spec_fromrgb_setup *setup, const struct spec_curve *light,
	const double bin_nm[2], double *mean, struct spec_error *error)
{
	size_t count = light ? (size_t)((bin_nm[1] - bin_nm[0]) * PIECES_PER_NM) + 1 : 1;
	double *memory = spec_memory_new(count + 1, 3 * sizeof *memory, "pieces", error);
	double *edge_nm = memory, *part = memory + count + 1, *power = part + count + 1;
	enum spec_status status = memory ? SPEC_OK : SPEC_ENOMEM;

	*mean = 0;
	for (size_t j = 0; j <= count && status == SPEC_OK; j++) {
		double share = (double)j / (double)count;

		power[j] = 1;
		edge_nm[j] = bin_nm[0] * (1 - share) + bin_nm[1] * share;
	}
	if (status == SPEC_OK)
		status = spec_basis_mean(steps, weight, edge_nm, count, part, error);
	if (status == SPEC_OK && light)
		status = spec_curve_mean(
			light, 0, setup->extrapolate, edge_nm, count, power, error);
	for (size_t j = 0; j < count && status == SPEC_OK; j++)
		*mean += power[j] * part[j] / (double)count;
	free(memory);
	return status;
}

static enum spec_status
fill_smits(const double rgb[3], const struct spec_fromrgb_setup *setup,
	const struct spec_curve *light, struct spec_curve *curve, struct spec_error *error)
{
	double weight[SPEC_SMITS_COLUMNS], *edges_nm;
	struct spec_curve steps;
	enum spec_status status =
		spec_basis_load(SPEC_SMITS_SPECTRUM, SPEC_SMITS_COLUMNS, &steps, error);

	if (status != SPEC_OK)
		return status;
	spec_smits_weights(rgb, weight);
	edges_nm = spec_memory_new(curve->count + 1, sizeof *edges_nm, "edges", error);
	status = edges_nm ? SPEC_OK : SPEC_ENOMEM;
	if (status == SPEC_OK)
		spec_bins_halfway(curve->wavelength_nm, curve->count, edges_nm);
	for (size_t i = 0; i < curve->count && status == SPEC_OK; i++)
		status = mean_of_steps(&steps, weight, setup, light, edges_nm + i,
			&curve->value[i], error);
	free(edges_nm);
	spec_curve_free(&steps);
	return status;
}

static enum spec_status
fill_basis(const double rgb[3], struct spec_curve *curve, struct spec_error *error)
{
	struct spec_curve basis;
	enum spec_status status =
		spec_basis_load(SPEC_MALLETT_SPECTRUM, SPEC_MALLETT_COLUMNS, &basis, error);

	if (status != SPEC_OK)
		return status;
	status = spec_basis_sample(
		&basis, rgb, curve->wavelength_nm, curve->count, curve->value, error);
	spec_curve_free(&basis);
	return status;
}

static enum spec_status
fill_sigmoid(const double rgb[3], const struct spec_upsampler *upsampler, int bounded,
	struct spec_curve *curve, struct spec_error *error)
{
	struct spec_sigmoid sigmoid;
	enum spec_status status =
		bounded ? spec_upsample_albedo(upsampler, rgb, &sigmoid, error)
			: spec_upsample_unbounded(upsampler, rgb, &sigmoid, error);

	if (status == SPEC_OK)
		spec_sigmoid_sample(
			&sigmoid, curve->wavelength_nm, curve->count, curve->value);
	return status;
}

static enum spec_status
fill_sun(const double rgb[3], int lit, struct spec_curve *curve, struct spec_error *error)
{
	struct spec_gaussian_fit *sun = spec_memory_new(1, sizeof *sun, "models", error);
	struct spec_gaussians gaussians;
	enum spec_status status =
		sun ? spec_gaussian_load(spec_space_find("srgb", NULL), lit, sun, error)
		    : SPEC_ENOMEM;

	if (status == SPEC_OK)
		status = spec_gaussian_solve(sun, rgb, &gaussians, error);
	if (status == SPEC_OK)
		spec_gaussians_sample(
			&gaussians, curve->wavelength_nm, curve->count, curve->value);
	spec_gaussian_free(sun);
	free(sun);
	return status;
}

static enum spec_status
multiply(const struct spec_curve *light, enum spec_extrapolate extrapolate,
	struct spec_curve *curve, struct spec_error *error)
{
	for (size_t i = 0; i < curve->count; i++) {
		double power;
		enum spec_status status = spec_curve_sample(
			light, 0, extrapolate, &curve->wavelength_nm[i], 1, &power, error);

		if (status != SPEC_OK)
			return status;
		curve->value[i] *= power;
	}
	return SPEC_OK;
}

/* The values, in [0, 1] where they are an albedo. */
static enum spec_status
fill(const double rgb[3], const struct spec_fromrgb_setup *setup, struct spec_curve *curve,
	struct spec_error *error)
{
	int bounded = setup->use == SPEC_UPSAMPLING_ALBEDO;
	int lit = setup->use == SPEC_UPSAMPLING_LIGHT;
	struct spec_upsampler upsampler;
	enum spec_status status;

	if (setup->model == SPEC_UPSAMPLING_SUN)
		return fill_sun(rgb, !lit, curve, error);
	status = spec_upsampler_load(spec_space_find("srgb", NULL), &upsampler, error);
	if (status != SPEC_OK)
		return status;
	if (setup->model == SPEC_UPSAMPLING_SMITS)
		status =
			fill_smits(rgb, setup, lit ? &upsampler.light : NULL, curve, error);
	else if (setup->model == SPEC_UPSAMPLING_BASIS)
		status = fill_basis(rgb, curve, error);
	else
		status = fill_sigmoid(rgb, &upsampler, bounded, curve, error);
	if (status == SPEC_OK && lit && setup->model != SPEC_UPSAMPLING_SMITS)
		status = multiply(&upsampler.light, setup->extrapolate, curve, error);
	for (size_t i = 0; i < curve->count && bounded; i++)
		curve->value[i] = curve->value[i] > 1 ? 1 : curve->value[i];
	spec_upsampler_free(&upsampler);
	return status;
}

static enum spec_status
set_texts(const double rgb[3], const struct spec_fromrgb_setup *setup,
	struct spec_curve *curve, struct spec_error *error)
{
	static const char *const sources[] = {
		[SPEC_UPSAMPLING_SMITS] =
			"B. Smits, An RGB-to-spectrum conversion for reflectances (1999)",
		[SPEC_UPSAMPLING_SUN] = "Y. Sun et al., Deriving spectra from colors and "
					"rendering light interference (1999)",
		[SPEC_UPSAMPLING_SIGMOID] = "W. Jakob and J. Hanika, A low-dimensional "
					    "function space for efficient spectral "
					    "upsampling (2019)",
		[SPEC_UPSAMPLING_BASIS] = "I. Mallett and C. Yuksel, Spectral primary "
					  "decomposition for rendering with sRGB "
					  "reflectance (2019)"};
	static const char *const quantities[] = {[SPEC_UPSAMPLING_ALBEDO] = "reflectance",
		[SPEC_UPSAMPLING_UNBOUNDED] = "factor",
		[SPEC_UPSAMPLING_LIGHT] = "spectral power distribution"};
	char title[128];
	enum spec_status status;

	(void)snprintf(title, sizeof title, "RGB %.6g %.6g %.6g", rgb[0], rgb[1], rgb[2]);
	status = spec_curve_set_text(&curve->title, title, error);
	if (status == SPEC_OK)
		status = spec_curve_set_text(
			&curve->quantity, quantities[setup->use], error);
	if (status == SPEC_OK && setup->use != SPEC_UPSAMPLING_LIGHT)
		status = spec_curve_set_text(&curve->unit, "1", error);
	if (status == SPEC_OK && setup->use != SPEC_UPSAMPLING_UNBOUNDED)
		status = spec_curve_set_text(&curve->column[0],
			setup->use == SPEC_UPSAMPLING_LIGHT ? "L" : "R", error);
	if (status == SPEC_OK)
		status = spec_curve_set_text(&curve->source, sources[setup->model], error);
	return status;
}

static enum spec_status
check(const double rgb[3], const struct spec_fromrgb_setup *setup, struct spec_error *error)
{
	double most = setup->use == SPEC_UPSAMPLING_ALBEDO ? 1 : FLT_MAX;

	if (setup->use == SPEC_UPSAMPLING_ALBEDO && setup->model == SPEC_UPSAMPLING_SUN)
		return spec_upsampling_refuse_sun(error);
	for (int i = 0; i < 3; i++)
		if (!(rgb[i] >= 0 && rgb[i] <= most))
			return spec_error_set(error, SPEC_ERANGE,
				"a component of the colour is %g, not in %s", rgb[i],
				most > 1 ? "the range of floats from 0 on" : "[0, 1]");
	return SPEC_OK;
}

enum spec_status
spec_colour_curve(const double rgb[3], const struct spec_fromrgb_setup *setup,
	struct spec_curve *curve, struct spec_error *error)
{
	struct spec_grid usual = {0};
	const struct spec_grid *grid = setup->grid ? setup->grid : &usual;
	enum spec_status status = check(rgb, setup, error);

	*curve = (struct spec_curve){0};
	if (status == SPEC_OK && !setup->grid)
		status = spec_grid_parse(SPEC_FROMRGB_GRID, &usual, error);
	if (status == SPEC_OK)
		status = spec_curve_new(grid->count, 1, curve, error);
	if (status == SPEC_OK) {
		memcpy(curve->wavelength_nm, grid->wavelength_nm,
			grid->count * sizeof *curve->wavelength_nm);
		status = fill(rgb, setup, curve, error);
	}
	if (status == SPEC_OK)
		status = set_texts(rgb, setup, curve, error);
	spec_grid_free(&usual);
	if (status != SPEC_OK)
		spec_curve_free(curve);
	return status;
}
