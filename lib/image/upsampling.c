/* Planning: everything about the bands that does not depend on the colours. */
#include "image/upsampling.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "base/interval.h"
#include "base/memory.h"
#include "colour/basis.h"
#include "colour/smits.h"
#include "colour/gaussian.h"
#include "colour/upsample.h"

/* Two nodes stand for no more than this of a band. */
#define WIDEST_STRETCH_NM 5.

/* Sun's Gaussians are tabulated at so many widths, each the same share below the last. */
#define WIDTHS 270

struct name {
	const char *name;
	int value;
};

static enum spec_status
find(const char *what, const struct name *table, size_t count, const char *name, int *value,
	struct spec_error *error)
{
	char known[64] = "";

	for (size_t i = 0; i < count; i++) {
		if (strcmp(table[i].name, name) == 0) {
			*value = table[i].value;
			return SPEC_OK;
		}
		strcat(strcat(known, i > 0 ? " " : ""), table[i].name);
	}
	return spec_error_set(
		error, SPEC_EUSAGE, "unknown %s '%.100s' (%s)", what, name, known);
}

enum spec_status
spec_upsampling_find_model(
	const char *name, enum spec_upsampling_model *model, struct spec_error *error)
{
	static const struct name models[] = {{"smits", SPEC_UPSAMPLING_SMITS},
		{"sun", SPEC_UPSAMPLING_SUN}, {"sigmoid", SPEC_UPSAMPLING_SIGMOID},
		{"basis", SPEC_UPSAMPLING_BASIS}};
	int value = 0;
	enum spec_status status =
		find("model", models, sizeof models / sizeof *models, name, &value, error);

	if (status == SPEC_OK)
		*model = (enum spec_upsampling_model)value;
	return status;
}

enum spec_status
spec_upsampling_find_use(
	const char *name, enum spec_upsampling_use *use, struct spec_error *error)
{
	static const struct name uses[] = {{"reflectance", SPEC_UPSAMPLING_ALBEDO},
		{"unbounded", SPEC_UPSAMPLING_UNBOUNDED}, {"light", SPEC_UPSAMPLING_LIGHT}};
	int value = 0;
	enum spec_status status =
		find("use", uses, sizeof uses / sizeof *uses, name, &value, error);

	if (status == SPEC_OK)
		*use = (enum spec_upsampling_use)value;
	return status;
}

/* Integrals */

/* What is integrated over a stretch of a band: a column of a basis, and light, if any. */
struct product {
	const struct spec_curve *basis; /* or null: 1 */
	size_t column;
	const struct spec_curve *light; /* or null: 1 */
	enum spec_extrapolate extrapolate;
};

static enum spec_status
value_at(const struct product *product, double nm, double *value, struct spec_error *error)
{
	double light = 1, basis = 1;
	enum spec_status status = SPEC_OK;

	if (product->light)
		status = spec_curve_sample(
			product->light, 0, product->extrapolate, &nm, 1, &light, error);
	if (product->basis && status == SPEC_OK)
		status = spec_curve_sample(product->basis, product->column,
			SPEC_EXTRAPOLATE_CONSTANT, &nm, 1, &basis, error);
	*value = light * basis;
	return status;
}

/* The curve's first sample above a wavelength, if it is below the limit; else the limit. */
static double
next_sample(const struct spec_curve *curve, double nm, double limit_nm)
{
	size_t next =
		curve ? spec_interval_count(curve->wavelength_nm, curve->count, nm) : 0;

	return curve && next < curve->count ? fmin(curve->wavelength_nm[next], limit_nm)
					    : limit_nm;
}

/*
 * moment[k] = the integral of the product times ((l - middle) / half the stretch)^k, k
 * below count, over the stretch's width: by three points of Gauss between the curves'
 * samples, exact up to the fifth power.
 */
static enum spec_status
integrate(const struct product *product, double from_nm, double to_nm, double *moment,
	size_t count, struct spec_error *error)
{
	static const double place[3] = {-.774596669241483377, 0, .774596669241483377};
	static const double weight[3] = {5. / 18, 8. / 18, 5. / 18};
	double middle_nm = .5 * (from_nm + to_nm), width_nm = to_nm - from_nm, end_nm;

	memset(moment, 0, count * sizeof *moment);
	for (double nm = from_nm; nm < to_nm; nm = end_nm) {
		end_nm = next_sample(product->light, nm, to_nm);
		end_nm = next_sample(product->basis, nm, end_nm);
		for (int i = 0; i < 3; i++) {
			double at_nm = .5 * (nm + end_nm) + .5 * (end_nm - nm) * place[i];
			double value, off = (at_nm - middle_nm) / (.5 * width_nm);
			enum spec_status status = value_at(product, at_nm, &value, error);

			if (status != SPEC_OK)
				return status;
			value *= (end_nm - nm) / width_nm * weight[i];
			for (size_t k = 0; k < count; k++, value *= off)
				moment[k] += value;
		}
	}
	return SPEC_OK;
}

/* A product at a band's wavelength, or its mean over the band. */
static enum spec_status
over_band(const struct product *product, const struct spec_upsampling_setup *setup,
	size_t band, double *value, struct spec_error *error)
{
	const double *edge = setup->edges_nm;

	if (!edge)
		return value_at(product, setup->wavelength_nm[band], value, error);
	return integrate(product, edge[band], edge[band + 1], value, 1, error);
}

/* The models */

static enum spec_status
plan_basis(struct spec_upsampling *upsampling, const struct spec_upsampling_setup *setup,
	const struct spec_curve *light, struct spec_error *error)
{
	int smits = setup->model == SPEC_UPSAMPLING_SMITS;
	struct product product = {.light = light, .extrapolate = setup->extrapolate};
	struct spec_curve basis;
	enum spec_status status;

	upsampling->columns = smits ? SPEC_SMITS_COLUMNS : SPEC_MALLETT_COLUMNS;
	upsampling->basis = spec_memory_new(setup->count,
		upsampling->columns * sizeof *upsampling->basis, "bands", error);
	if (!upsampling->basis)
		return SPEC_ENOMEM;
	status = spec_basis_load(smits ? SPEC_SMITS_SPECTRUM : SPEC_MALLETT_SPECTRUM,
		upsampling->columns, &basis, error);
	product.basis = &basis;
	for (size_t i = 0; i < setup->count && status == SPEC_OK; i++) {
		float *to = upsampling->basis + i * upsampling->columns;

		for (size_t k = 0; k < upsampling->columns && status == SPEC_OK; k++) {
			double value;

			product.column = k;
			status = over_band(&product, setup, i, &value, error);
			to[k] = (float)value;
		}
	}
	spec_curve_free(&basis);
	return status;
}

static size_t
count_stretches(const struct spec_upsampling_setup *setup, size_t band)
{
	double width_nm = setup->edges_nm[band + 1] - setup->edges_nm[band];

	return (size_t)ceil(width_nm / WIDEST_STRETCH_NM * (1 - 1e-9));
}

/*
 * The two nodes of Gauss for a weight >= 0 of which the moments are known, on [-1, 1]: the
 * roots of the u^2 + a u + b whose products with 1 and u have no integral. So a cubic's
 * integral is exact, and what is in [0, 1] stays between 0 and moment 0.
 */
static void
find_nodes(const double moment[4], double u[2], double weight[2])
{
	const double *m = moment;
	double det = m[0] * m[2] - m[1] * m[1];
	double a = (m[1] * m[2] - m[0] * m[3]) / det;
	double b = (m[1] * m[3] - m[2] * m[2]) / det;
	double root = sqrt(a * a / 4 - b);

	if (!(det > 1e-9 * m[0] * m[0] && root > 1e-6)) { /* dark, or one end of it lit */
		u[0] = u[1] = m[0] > 0 ? m[1] / m[0] : 0;
		weight[0] = weight[1] = m[0] / 2;
		return;
	}
	u[0] = -a / 2 - root;
	u[1] = -a / 2 + root;
	weight[0] = (m[0] * u[1] - m[1]) / (u[1] - u[0]);
	weight[1] = m[0] - weight[0];
}

/* The nodes of a band: its wavelength, or a pair for each stretch of its bin. */
static enum spec_status
plan_nodes(const struct spec_upsampling *upsampling,
	const struct spec_upsampling_setup *setup, const struct product *product,
	size_t band, struct spec_error *error)
{
	struct spec_upsampling_node *node = upsampling->node + upsampling->first[band];
	size_t count = (upsampling->first[band + 1] - upsampling->first[band]) / 2;
	double middle_nm = upsampling->sigmoids.middle_nm;
	double unit_nm = upsampling->sigmoids.half_nm;

	if (!setup->edges_nm) {
		node->t = (float)((setup->wavelength_nm[band] - middle_nm) / unit_nm);
		node->weight = upsampling->most[band];
		return SPEC_OK;
	}
	for (size_t j = 0; j < count; j++) {
		double half_nm = .5 * (setup->edges_nm[band + 1] - setup->edges_nm[band]) /
				 (double)count;
		double at_nm = setup->edges_nm[band] + half_nm * (double)(2 * j + 1);
		double moment[4], u[2], weight[2];
		enum spec_status status = integrate(
			product, at_nm - half_nm, at_nm + half_nm, moment, 4, error);

		if (status != SPEC_OK)
			return status;
		find_nodes(moment, u, weight);
		for (int i = 0; i < 2; i++, node++) {
			node->t = (float)((at_nm + half_nm * u[i] - middle_nm) / unit_nm);
			node->weight = (float)(weight[i] / (double)count);
		}
	}
	return SPEC_OK;
}

static enum spec_status
plan_sigmoids(struct spec_upsampling *upsampling, const struct spec_upsampling_setup *setup,
	const struct spec_curve *light, struct spec_error *error)
{
	struct product product = {.light = light, .extrapolate = setup->extrapolate};
	enum spec_status status = spec_sigmoids_load(&upsampling->sigmoids, error);

	if (status != SPEC_OK)
		return status;
	upsampling->first = spec_memory_new(
		setup->count + 1, sizeof *upsampling->first, "bands", error);
	if (!upsampling->first)
		return SPEC_ENOMEM;
	for (size_t i = 0; i < setup->count; i++)
		upsampling->first[i + 1] =
			upsampling->first[i] +
			(setup->edges_nm ? 2 * count_stretches(setup, i) : 1);
	upsampling->node = spec_memory_new(upsampling->first[setup->count],
		sizeof *upsampling->node, "parts of bands", error);
	if (!upsampling->node)
		return SPEC_ENOMEM;
	for (size_t i = 0; i < setup->count && status == SPEC_OK; i++)
		status = plan_nodes(upsampling, setup, &product, i, error);
	return status;
}

enum spec_status
spec_upsampling_refuse_sun(struct spec_error *error)
{
	return spec_error_set(error, SPEC_EUNSUPPORTED,
		"Sun's spectra are no reflectances, they rise above 1 (they are light, or "
		"unbounded)");
}

static enum spec_status
plan_sun(struct spec_upsampling *upsampling, const struct spec_upsampling_setup *setup,
	struct spec_error *error)
{
	const double *edge = setup->edges_nm;
	double width_nm = SPEC_GAUSSIAN_WIDEST_NM;
	enum spec_status status;

	if (setup->use == SPEC_UPSAMPLING_ALBEDO)
		return spec_upsampling_refuse_sun(error);
	upsampling->widths = WIDTHS;
	upsampling->sun = spec_memory_new(1, sizeof *upsampling->sun, "models", error);
	upsampling->matrix =
		spec_memory_new(WIDTHS, 9 * sizeof *upsampling->matrix, "matrices", error);
	upsampling->gaussian = spec_memory_new(
		setup->count, WIDTHS * 3 * sizeof *upsampling->gaussian, "bands", error);
	if (!upsampling->sun || !upsampling->matrix || !upsampling->gaussian)
		return SPEC_ENOMEM;
	status = spec_gaussian_load(spec_space_find("srgb", NULL),
		setup->use == SPEC_UPSAMPLING_UNBOUNDED, upsampling->sun, error);
	for (size_t j = 0; j < WIDTHS && status == SPEC_OK; j++) {
		status = spec_gaussian_matrix(
			upsampling->sun, width_nm, upsampling->matrix + 9 * j, error);
		for (size_t i = 0; i < setup->count; i++)
			for (size_t k = 0; k < 3; k++)
				upsampling->gaussian[(i * WIDTHS + j) * 3 + k] =
					(float)(edge ? spec_gaussian_component_mean((int)k,
							       width_nm, edge[i],
							       edge[i + 1])
						     : spec_gaussian_component((int)k,
							       width_nm,
							       setup->wavelength_nm[i]));
		width_nm *= SPEC_GAUSSIAN_STEP;
	}
	return status;
}

static enum spec_status
plan_model(struct spec_upsampling *upsampling, const struct spec_upsampling_setup *setup,
	const struct spec_curve *light, struct spec_error *error)
{
	struct product one = {.light = light, .extrapolate = setup->extrapolate};
	enum spec_status status = SPEC_OK;

	upsampling->most =
		spec_memory_new(setup->count, sizeof *upsampling->most, "bands", error);
	if (!upsampling->most)
		return SPEC_ENOMEM;
	for (size_t i = 0; i < setup->count && status == SPEC_OK; i++) {
		double value;

		status = over_band(&one, setup, i, &value, error);
		upsampling->most[i] = (float)value;
	}
	if (status != SPEC_OK)
		return status;
	switch (setup->model) {
	case SPEC_UPSAMPLING_SMITS:
	case SPEC_UPSAMPLING_BASIS:
		return plan_basis(upsampling, setup, light, error);
	case SPEC_UPSAMPLING_SIGMOID:
		return plan_sigmoids(upsampling, setup, light, error);
	case SPEC_UPSAMPLING_SUN:
		return plan_sun(upsampling, setup, error);
	}
	return spec_error_set(error, SPEC_EUSAGE, "no such model of spectra");
}

enum spec_status
spec_upsampling_plan(struct spec_upsampling *upsampling,
	const struct spec_upsampling_setup *setup, struct spec_error *error)
{
	/* Sun's spectra are light themselves. */
	int lit =
		setup->use == SPEC_UPSAMPLING_LIGHT && setup->model != SPEC_UPSAMPLING_SUN;
	struct spec_upsampler upsampler = {0};
	enum spec_status status = SPEC_OK;

	*upsampling = (struct spec_upsampling){
		.model = setup->model, .use = setup->use, .bands = setup->count};
	if (lit)
		status = spec_upsampler_load(
			spec_space_find("srgb", NULL), &upsampler, error);
	if (status == SPEC_OK)
		status =
			plan_model(upsampling, setup, lit ? &upsampler.light : NULL, error);
	spec_upsampler_free(&upsampler);
	if (status != SPEC_OK)
		spec_upsampling_free(upsampling);
	return status;
}

void
spec_upsampling_free(struct spec_upsampling *upsampling)
{
	free(upsampling->most);
	free(upsampling->basis);
	spec_sigmoids_free(&upsampling->sigmoids);
	free(upsampling->first);
	free(upsampling->node);
	spec_gaussian_free(upsampling->sun);
	free(upsampling->sun);
	free(upsampling->matrix);
	free(upsampling->gaussian);
	*upsampling = (struct spec_upsampling){0};
}
