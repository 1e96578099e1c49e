#include "image/rgb.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "base/memory.h"
#include "base/vector.h"
#include "colour/appearance.h"
#include "colour/observer.h"

#define RUN 256 /* pixels whose sums stay in the nearest cache */

/* Everything that ends in XYZ, before the matrix to RGB. */
struct xyz_terms {
	size_t count;
	size_t *channel;
	double *weight;
};

static enum spec_status
observe_bands(const struct spec_image *image, const struct spec_rgb_setup *setup,
	const struct spec_curve *illuminant, double *weight, struct spec_rule_sums *sums,
	struct spec_error *error)
{
	char *quantity = spec_image_quantity(image, error);
	struct spec_bands bands = {image->bands, image->wavelength_nm, image->edges_nm, 0};

	if (!quantity)
		return SPEC_ENOMEM;
	bands.per_band = strstr(quantity, "per band") != NULL;
	free(quantity);
	return spec_rule_weights(
		setup->rule, setup->observer, illuminant, &bands, weight, sums, error);
}

/* The illuminant's power at a wavelength; outside its data it is zero. */
static enum spec_status
power_at(const struct spec_curve *illuminant, double wavelength_nm, double *power,
	struct spec_error *error)
{
	*power = 1;
	if (!illuminant)
		return SPEC_OK;
	return spec_curve_sample(
		illuminant, 0, SPEC_EXTRAPOLATE_ZERO, &wavelength_nm, 1, power, error);
}

/* Light of the wavelength in that leaves at the wavelength out. */
static enum spec_status
add_bispectral(const struct spec_image *image, const struct spec_rgb_setup *setup,
	double integral, struct xyz_terms *terms, size_t room, struct spec_error *error)
{
	double *plain = spec_memory_new(image->bands, 3 * sizeof *plain, "bands", error);
	struct spec_rule_sums sums;
	enum spec_status status =
		plain ? observe_bands(image, setup, NULL, plain, &sums, error)
		      : SPEC_ENOMEM;

	for (size_t i = 0; i < image->channels && status == SPEC_OK; i++) {
		const struct spec_channel *channel = &image->channel[i];
		size_t out;
		double power;
		int same;

		if (channel->role != SPEC_ROLE_BISPECTRAL)
			continue;
		out = spec_image_nearest_band(image, channel->reradiated_nm, &same);
		status = power_at(setup->illuminant, channel->wavelength_nm, &power, error);
		terms->channel[terms->count] = i;
		for (size_t j = 0; j < 3; j++)
			terms->weight[j * room + terms->count] =
				plain[j * image->bands + out] * power * sums.integral /
				integral;
		terms->count++;
	}
	free(plain);
	return status;
}

static const struct spec_curve *
illuminant_of(const struct spec_image *image, const struct spec_rgb_setup *setup)
{
	return image->role == SPEC_ROLE_REFLECTIVE ? setup->illuminant : NULL;
}

static enum spec_status
collect_terms(const struct spec_image *image, const struct spec_rgb_setup *setup,
	struct xyz_terms *terms, size_t room, struct spec_rule_sums *sums,
	struct spec_error *error)
{
	double *weight = spec_memory_new(image->bands, 3 * sizeof *weight, "bands", error);
	enum spec_status status = SPEC_ENOMEM;

	if (image->bispectral > 0 && setup->rule == SPEC_RULE_ASTM)
		status = spec_error_set(error, SPEC_EUSAGE,
			"the weights of ASTM E308 are not for bispectral images");
	else if (weight)
		status = observe_bands(
			image, setup, illuminant_of(image, setup), weight, sums, error);
	for (size_t i = 0; i < image->bands && status == SPEC_OK; i++) {
		terms->channel[i] = image->band_channel[i];
		for (size_t j = 0; j < 3; j++)
			terms->weight[j * room + i] = weight[j * image->bands + i];
	}
	terms->count = image->bands;
	free(weight);
	if (status == SPEC_OK && image->bispectral > 0)
		status = add_bispectral(image, setup, sums->integral, terms, room, error);
	return status;
}

/* Whether the luminance of Y = 1 is known. */
static enum spec_status
find_luminance(const struct spec_image *image, const struct spec_rgb_setup *setup,
	double integral, double *luminance, struct spec_error *error)
{
	const struct spec_curve *illuminant = illuminant_of(image, setup);
	char *quantity = spec_image_quantity(image, error);
	enum spec_seen seen;

	*luminance = NAN;
	if (!quantity)
		return SPEC_ENOMEM;
	seen = illuminant ? spec_seen_of(illuminant->quantity, illuminant->unit)
			  : spec_seen_of(quantity, "");
	free(quantity);
	if (seen == SPEC_SEEN_RADIANCE || (illuminant && seen == SPEC_SEEN_IRRADIANCE))
		*luminance = integral * spec_rule_efficacy(setup->observer);
	/* A perfect diffuser sends as much in all directions: its irradiance over pi. */
	if (seen == SPEC_SEEN_IRRADIANCE)
		*luminance /= M_PI;
	return SPEC_OK;
}

/* What the weights of Y = 1 are multiplied by, before the exposure. */
static enum spec_status
find_scale(const struct spec_image *image, const struct spec_rgb_setup *setup,
	double luminance, double *scale, struct spec_error *error)
{
	*scale = setup->scale == SPEC_RGB_HUNDRED ? 100 : 1;
	if (setup->scale != SPEC_RGB_ABSOLUTE)
		return SPEC_OK;
	*scale = luminance;
	if (isfinite(luminance))
		return SPEC_OK;
	if (isnan(spec_rule_efficacy(setup->observer)))
		return spec_error_set(error, SPEC_EUNSUPPORTED,
			"observer '%.200s' has no luminous efficiency, and so no luminance",
			setup->observer->title);
	if (image->role == SPEC_ROLE_REFLECTIVE)
		return spec_error_set(error, SPEC_EUNSUPPORTED,
			"reflectance has a luminance only under a radiance, or a power in "
			"W m-2 nm-1, and the illuminant '%.200s' tells ratios alone",
			setup->illuminant ? setup->illuminant->title : "equal energy");
	return spec_error_set(error, SPEC_EUNSUPPORTED,
		"has no luminance: its spec:quantity is no radiance");
}

static enum spec_status
matrix_of(const struct spec_image *image, const struct spec_rgb_setup *setup,
	const double seen_white[3], double m[9], double white[3], struct spec_error *error)
{
	static const double identity[9] = {1, 0, 0, 0, 1, 0, 0, 0, 1};
	int reflective = image->role == SPEC_ROLE_REFLECTIVE,
	    plain = setup->space->coordinates == SPEC_COORDINATES_RGB;
	const double *to_xy =
		plain ? setup->space->white_xy : spec_white_find("D50", error)->xy;
	double adaptation[9], to[3], from[3];
	enum spec_status status = SPEC_OK;

	if (spec_observer_is_xyz(setup->observer))
		status = spec_space_from_xyz(setup->space, m, error);
	else if (setup->adaptation == SPEC_ADAPTATION_NONE && plain)
		memcpy(m, identity, sizeof identity);
	else
		status = spec_error_set(error, SPEC_EUSAGE,
			"observer '%.200s' has no X, Y and Z to adapt to another white%s",
			setup->observer->title, plain ? "" : ", or to make Lab or xyY of");
	memcpy(white, seen_white, 3 * sizeof *white);
	memcpy(from, seen_white, sizeof from);
	if (status != SPEC_OK || setup->adaptation == SPEC_ADAPTATION_NONE ||
		(!reflective && !setup->light))
		return status;
	if (!reflective)
		status = spec_observer_white(setup->observer, setup->light, from, error);
	spec_white_xyz(to_xy, to);
	if (status == SPEC_OK)
		status = spec_adaptation_matrix(
			setup->adaptation, from, to, adaptation, error);
	if (status == SPEC_OK)
		spec_matrix_multiply(m, adaptation, m);
	memcpy(white, to, sizeof to);
	return status;
}

static enum spec_status
fill_plan(struct spec_rgb *rgb, const struct spec_image *image,
	const struct spec_rgb_setup *setup, size_t room, struct spec_error *error)
{
	struct xyz_terms terms = {0, rgb->channel, rgb->weight};
	struct spec_rule_sums sums = {0};
	double m[9], scale = 1;
	enum spec_status status = collect_terms(image, setup, &terms, room, &sums, error);

	if (status == SPEC_OK)
		status =
			find_luminance(image, setup, sums.integral, &rgb->luminance, error);
	if (status == SPEC_OK)
		status = find_scale(image, setup, rgb->luminance, &scale, error);
	if (status == SPEC_OK)
		status = matrix_of(image, setup, sums.white, m, rgb->white, error);
	scale *= exp2(setup->exposure);
	rgb->outside = sums.outside;
	rgb->raw = !spec_observer_is_xyz(setup->observer) &&
		   !spec_observer_is_grey(setup->observer);
	rgb->terms = terms.count;
	for (size_t i = 0; i < rgb->terms && status == SPEC_OK; i++) {
		double xyz[3] = {
			rgb->weight[i], rgb->weight[room + i], rgb->weight[2 * room + i]};
		double linear[3];

		spec_matrix_apply(m, xyz, linear);
		for (size_t j = 0; j < 3; j++)
			rgb->weight[j * room + i] = linear[j] * scale;
	}
	return status;
}

enum spec_status
spec_rgb_plan(struct spec_rgb *rgb, const struct spec_image *image,
	const struct spec_rgb_setup *setup, struct spec_error *error)
{
	size_t room = image->bands + image->bispectral;
	enum spec_status status;

	*rgb = (struct spec_rgb){0};
	if (image->bands == 0)
		return spec_error_set(error, SPEC_EFORMAT, "has no spectral channel");
	rgb->channel = spec_memory_new(room, sizeof *rgb->channel, "bands", error);
	rgb->weight = spec_memory_new(room, 3 * sizeof *rgb->weight, "bands", error);
	status = rgb->channel && rgb->weight ? fill_plan(rgb, image, setup, room, error)
					     : SPEC_ENOMEM;
	if (status != SPEC_OK)
		spec_rgb_free(rgb);
	return status;
}

void
spec_rgb_free(struct spec_rgb *rgb)
{
	free(rgb->channel);
	free(rgb->weight);
	*rgb = (struct spec_rgb){0};
}

/* Adds four channels at once: the sums are loaded and stored a quarter as often. */
SPEC_VECTORISED static void
add_four(double *restrict sum, const float *restrict a, const float *restrict b,
	const float *restrict c, const float *restrict d, const double *w, size_t room,
	size_t count)
{
	for (size_t x = 0; x < count; x++) {
		double va = a[x], vb = b[x], vc = c[x], vd = d[x];

		sum[x] += (w[0] * va + w[1] * vb) + (w[2] * vc + w[3] * vd);
		sum[RUN + x] += (w[room] * va + w[room + 1] * vb) +
				(w[room + 2] * vc + w[room + 3] * vd);
		sum[2 * RUN + x] += (w[2 * room] * va + w[2 * room + 1] * vb) +
				    (w[2 * room + 2] * vc + w[2 * room + 3] * vd);
	}
}

static void
add_one(double *restrict sum, const float *restrict a, const double *w, size_t room,
	size_t count)
{
	for (size_t x = 0; x < count; x++) {
		sum[x] += w[0] * a[x];
		sum[RUN + x] += w[room] * a[x];
		sum[2 * RUN + x] += w[2 * room] * a[x];
	}
}

void
spec_rgb_row(const struct spec_rgb *rgb, const float *const *plane, size_t width,
	float *red, float *green, float *blue)
{
	const size_t room = rgb->terms;
	double sum[3 * RUN];

	for (size_t x0 = 0; x0 < width; x0 += RUN) {
		size_t count = width - x0 < RUN ? width - x0 : RUN, i = 0;

		memset(sum, 0, sizeof sum);
		for (; i + 4 <= rgb->terms; i += 4)
			add_four(sum, plane[i] + x0, plane[i + 1] + x0, plane[i + 2] + x0,
				plane[i + 3] + x0, rgb->weight + i, room, count);
		for (; i < rgb->terms; i++)
			add_one(sum, plane[i] + x0, rgb->weight + i, room, count);
		for (size_t x = 0; x < count; x++) {
			red[x0 + x] = (float)sum[x];
			green[x0 + x] = (float)sum[RUN + x];
			blue[x0 + x] = (float)sum[2 * RUN + x];
		}
	}
}
