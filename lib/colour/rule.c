#include "colour/rule.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "base/memory.h"
#include "colour/abridged.h"

/* K_cd and its wavelength: SI Brochure 2019; CIE e-ILV 17-730, of 540 THz in standard air. */
#define CANDELA_LUMEN_PER_WATT 683.0
#define CANDELA_NM 555.016

/* V(lambda)'s own is 683.002: what lies so near is the CIE's 683 lm/W. */
#define ROUNDED_LUMEN_PER_WATT .005

static const struct {
	const char *name, *title;
} rules[] = {{"cie", "sums by the observer's steps (CIE 15:2018)"},
	{"grid", "the trapezoid over the spectrum's own wavelengths"},
	{"astm", "the weights of ASTM E308-15, made by ASTM E2022-11"}};

enum spec_status
spec_rule_find(const char *name, enum spec_rule *rule, struct spec_error *error)
{
	for (size_t i = 0; i < sizeof rules / sizeof *rules; i++) {
		if (strcmp(name, rules[i].name) == 0) {
			*rule = (enum spec_rule)i;
			return SPEC_OK;
		}
	}
	return spec_error_set(error, SPEC_EUSAGE,
		"'%.40s' is no rule of integration: cie, grid or astm", name);
}

const char *
spec_rule_name(enum spec_rule rule)
{
	return rules[rule].name;
}

const char *
spec_rule_title(enum spec_rule rule)
{
	return rules[rule].title;
}

/* The step of the observer's table times the sum of y, or S y, over it. */
static enum spec_status
integrate(const struct spec_curve *observer, const struct spec_curve *illuminant,
	double *integral, struct spec_error *error)
{
	const size_t n = observer->count;
	double *light = spec_memory_new(n, sizeof *light, "observer samples", error);
	enum spec_status status = SPEC_ENOMEM;

	*integral = 0;
	if (!light)
		return status;
	status = SPEC_OK;
	if (illuminant)
		status = spec_curve_sample(illuminant, 0, SPEC_EXTRAPOLATE_ZERO,
			observer->wavelength_nm, n, light, error);
	for (size_t i = 0; i < n && status == SPEC_OK; i++)
		*integral += observer->value[n + i] * (illuminant ? light[i] : 1);
	*integral *= (observer->wavelength_nm[n - 1] - observer->wavelength_nm[0]) /
		     (double)(n - 1);
	free(light);
	return status;
}

/* Where the bands weigh the observer. */
static double
middle(const struct spec_bands *bands, size_t i)
{
	return bands->edges_nm ? .5 * (bands->edges_nm[i] + bands->edges_nm[i + 1])
			       : bands->wavelength_nm[i];
}

/* The nm that a band stands for; a value per band stands for its light as it is. */
static double
width(const struct spec_bands *bands, size_t i)
{
	const double *w = bands->wavelength_nm;

	if (bands->per_band)
		return 1;
	if (bands->edges_nm)
		return bands->edges_nm[i + 1] - bands->edges_nm[i];
	return .5 * (w[i + 1 < bands->count ? i + 1 : i] - w[i > 0 ? i - 1 : 0]);
}

/* The weights before they are divided by anything. */
static enum spec_status
weigh_grid(const struct spec_curve *observer, const struct spec_curve *illuminant,
	const struct spec_bands *bands, double *weight, struct spec_error *error)
{
	const size_t n = bands->count;

	for (size_t i = 0; i < n; i++) {
		double nm = middle(bands, i), power = width(bands, i), light = 1;
		enum spec_status status = SPEC_OK;

		if (illuminant)
			status = spec_curve_sample(illuminant, 0, SPEC_EXTRAPOLATE_ZERO,
				&nm, 1, &light, error);
		for (size_t c = 0; c < 3 && status == SPEC_OK; c++) {
			status = spec_curve_sample(observer, c, SPEC_EXTRAPOLATE_ZERO, &nm,
				1, &weight[c * n + i], error);
			weight[c * n + i] *= power * light;
		}
		if (status != SPEC_OK)
			return status;
	}
	return SPEC_OK;
}

static void
sum_weights(const double *weight, size_t count, double sum[3])
{
	for (size_t c = 0; c < 3; c++) {
		sum[c] = 0;
		for (size_t i = 0; i < count; i++)
			sum[c] += weight[c * count + i];
	}
}

static enum spec_status
use_grid(const struct spec_curve *observer, const struct spec_curve *illuminant,
	const struct spec_bands *bands, double *weight, struct spec_rule_sums *sums,
	struct spec_error *error)
{
	enum spec_status status = weigh_grid(observer, illuminant, bands, weight, error);
	double sum[3];

	if (status != SPEC_OK)
		return status;
	sum_weights(weight, bands->count, sum);
	if (!(isfinite(sum[1]) && sum[1] > 0))
		return spec_error_set(error, SPEC_EFORMAT,
			"observer and illuminant give no finite, positive y at these "
			"bands");
	if (illuminant) {
		sums->integral = sum[1];
		for (size_t c = 0; c < 3; c++)
			sums->white[c] = sum[c] / sum[1];
	}
	for (size_t i = 0; i < 3 * bands->count; i++)
		weight[i] /= sums->integral;
	return SPEC_OK;
}

static enum spec_status
use_astm(const struct spec_curve *observer, const struct spec_curve *illuminant,
	const struct spec_bands *bands, double *weight, struct spec_rule_sums *sums,
	struct spec_error *error)
{
	enum spec_status status;

	if (!illuminant)
		return spec_error_set(error, SPEC_EUSAGE,
			"the weights of ASTM E308 are for reflectance and transmittance, "
			"not for light");
	if (bands->edges_nm)
		return spec_error_set(error, SPEC_EUSAGE,
			"the weights of ASTM E308 are for samples at points, not for means "
			"over bins");
	status = spec_abridged_weights(observer, illuminant, bands->wavelength_nm,
		bands->count, weight, &sums->integral, error);
	if (status == SPEC_OK)
		sum_weights(weight, bands->count, sums->white);
	return status;
}

enum spec_status
spec_rule_weights(enum spec_rule rule, const struct spec_curve *observer,
	const struct spec_curve *illuminant, const struct spec_bands *bands, double *weight,
	struct spec_rule_sums *sums, struct spec_error *error)
{
	/* Also by the other rules, for what is outside, and for what is wrong. */
	enum spec_status status = spec_observer_weights(
		observer, illuminant, bands, weight, &sums->outside, error);

	if (status == SPEC_OK)
		status = spec_observer_white(observer, illuminant, sums->white, error);
	if (status == SPEC_OK)
		status = integrate(observer, illuminant, &sums->integral, error);
	if (status == SPEC_OK && rule == SPEC_RULE_GRID)
		status = use_grid(observer, illuminant, bands, weight, sums, error);
	if (status == SPEC_OK && rule == SPEC_RULE_ASTM)
		status = use_astm(observer, illuminant, bands, weight, sums, error);
	return status;
}

double
spec_rule_efficacy(const struct spec_curve *observer)
{
	double nm = CANDELA_NM, y, efficacy;

	if (!spec_observer_is_xyz(observer) &&
		strcmp(observer->quantity, "luminous efficiency") != 0)
		return NAN;
	if (spec_curve_sample(observer, 1, SPEC_EXTRAPOLATE_ZERO, &nm, 1, &y, NULL) !=
			SPEC_OK ||
		!(y > 0))
		return NAN;
	efficacy = CANDELA_LUMEN_PER_WATT / y;
	return fabs(efficacy - CANDELA_LUMEN_PER_WATT) <= ROUNDED_LUMEN_PER_WATT
		       ? CANDELA_LUMEN_PER_WATT
		       : efficacy;
}
