#include "colour/appearance.h"

#include <math.h>
#include <stddef.h>
#include <stdlib.h>
#include <string.h>

#include "base/memory.h"
#include "colour/difference.h"
#include "colour/dominant.h"
#include "colour/observer.h"
#include "colour/temperature.h"
#include "spectrum/lookup.h"

/* A spectrum that leaves out more of Y than this says so. */
#define MUCH .01

/* The efficacy times the integral of ybar: the luminance of a radiance of 1 per nm. */
static double
unit_luminance(const struct spec_curve *observer)
{
	const size_t n = observer->count;
	double sum = 0;

	for (size_t i = 0; i < n; i++)
		sum += observer->value[n + i];
	return spec_rule_efficacy(observer) * sum *
	       (observer->wavelength_nm[n - 1] - observer->wavelength_nm[0]) /
	       (double)(n - 1);
}

static enum spec_status
find_whites(struct spec_viewing *viewing, int given, struct spec_error *error)
{
	double neutral[3];
	enum spec_status status = spec_observer_white(
		&viewing->observer, &viewing->illuminant, viewing->white_xyz, error);

	if (status == SPEC_OK)
		status = spec_observer_white(&viewing->observer, NULL, neutral, error);
	if (status != SPEC_OK)
		return status;
	viewing->tristimulus = spec_observer_is_xyz(&viewing->observer);
	for (int i = 0; i < 3 && viewing->tristimulus; i++) {
		if (!(viewing->white_xyz[i] > 0))
			return spec_error_set(error, SPEC_ERANGE,
				"the illuminant's X, Y and Z are not all positive");
	}
	spec_dominant_xy(given ? viewing->white_xyz : neutral, viewing->neutral_xy);
	viewing->luminance = unit_luminance(&viewing->standard);
	viewing->observer_luminance = unit_luminance(&viewing->observer);
	return SPEC_OK;
}

enum spec_status
spec_viewing_load(const char *observer, const char *illuminant,
	struct spec_viewing *viewing, struct spec_error *error)
{
	enum spec_status status;

	*viewing = (struct spec_viewing){0};
	status =
		spec_observer_load(observer ? observer : "1931", &viewing->observer, error);
	if (status == SPEC_OK)
		status = spec_observer_load("1931", &viewing->standard, error);
	if (status == SPEC_OK)
		status = spec_lookup_light(illuminant ? illuminant : "illuminants/D65",
			&viewing->illuminant, error);
	if (status == SPEC_OK)
		status = find_whites(viewing, illuminant != NULL, error);
	if (status != SPEC_OK)
		spec_viewing_free(viewing);
	return status;
}

void
spec_viewing_free(struct spec_viewing *viewing)
{
	spec_curve_free(&viewing->observer);
	spec_curve_free(&viewing->standard);
	spec_curve_free(&viewing->illuminant);
}

static int
begins(const char *text, const char *start)
{
	return strncmp(text, start, strlen(start)) == 0;
}

enum spec_seen
spec_seen_of(const char *quantity, const char *unit)
{
	if (begins(quantity, "reflectance") || begins(quantity, "transmittance"))
		return SPEC_SEEN_REFLECTED;
	if (begins(quantity, "radiance"))
		return begins(unit, "relative") ? SPEC_SEEN_RELATIVE : SPEC_SEEN_RADIANCE;
	if (strcmp(quantity, "spectral power distribution") == 0 &&
		strcmp(unit, "W m-2 nm-1") == 0)
		return SPEC_SEEN_IRRADIANCE;
	if (*quantity == '\0' || strcmp(quantity, "spectral power distribution") == 0)
		return SPEC_SEEN_RELATIVE;
	return SPEC_SEEN_NOTHING;
}

void
spec_appearance_clear(struct spec_appearance *appearance)
{
	double *value = (double *)appearance;

	for (size_t i = 0; i < offsetof(struct spec_appearance, viewing) / sizeof *value;
		i++)
		value[i] = NAN;
	appearance->viewing = NULL;
}

static int
is_finite(const double xyz[3])
{
	return isfinite(xyz[0]) && isfinite(xyz[1]) && isfinite(xyz[2]);
}

/* What relative values are multiplied by, and white's Y on the scale of xyz. */
static double
scale_of(const struct spec_viewing *viewing, enum spec_seen seen, double y, double *white)
{
	*white = seen == SPEC_SEEN_IRRADIANCE ? y : 1;
	if ((seen == SPEC_SEEN_RADIANCE || seen == SPEC_SEEN_IRRADIANCE) &&
		isfinite(viewing->observer_luminance))
		return viewing->observer_luminance;
	if (seen != SPEC_SEEN_RELATIVE)
		return 100;
	*white = y;
	return 100 / y;
}

/* What the standard observer tells: luminance and temperature. */
static void
find_standard(const struct spec_viewing *viewing, enum spec_seen seen,
	const double standard[3], struct spec_appearance *appearance)
{
	if (seen == SPEC_SEEN_RADIANCE)
		appearance->luminance = viewing->luminance * standard[1];
	if (seen == SPEC_SEEN_IRRADIANCE)
		appearance->illuminance = viewing->luminance * standard[1];
	if (seen != SPEC_SEEN_REFLECTED)
		spec_temperature_find(
			&viewing->standard, standard, &appearance->cct_k, &appearance->duv);
}

/* Coordinates of X, Y, Z; y: of white, on their scale. */
static enum spec_status
find_colour(const struct spec_viewing *viewing, enum spec_seen seen, const double xyz[3],
	double y, const double white_xyz[3], struct spec_appearance *appearance,
	struct spec_error *error)
{
	double white[3], neutral[2], sum = xyz[0] + 15 * xyz[1] + 3 * xyz[2];

	for (int i = 0; i < 3; i++)
		white[i] = y * white_xyz[i];
	spec_lab_from_xyz(xyz, white, appearance->lab);
	if (!is_finite(appearance->lab))
		appearance->lab[0] = appearance->lab[1] = appearance->lab[2] = NAN;
	spec_dominant_xy(xyz, appearance->xy);
	if (sum > 0) {
		appearance->uv[0] = 4 * xyz[0] / sum;
		appearance->uv[1] = 9 * xyz[1] / sum;
	}
	memcpy(neutral, viewing->neutral_xy, sizeof neutral);
	if (seen == SPEC_SEEN_REFLECTED)
		spec_dominant_xy(white_xyz, neutral);
	return spec_dominant_find(&viewing->observer, appearance->xy, neutral,
		&appearance->dominant_nm, &appearance->purity, error);
}

enum spec_status
spec_appearance_find(const struct spec_viewing *viewing, enum spec_seen seen,
	const double xyz[3], const double standard[3], const double white[3],
	struct spec_appearance *appearance, struct spec_error *error)
{
	double scale, y;

	spec_appearance_clear(appearance);
	if (seen == SPEC_SEEN_NOTHING || !is_finite(xyz) || !is_finite(standard) ||
		((seen == SPEC_SEEN_RELATIVE || seen == SPEC_SEEN_IRRADIANCE) &&
			!(xyz[1] > 0)))
		return SPEC_OK;
	appearance->viewing = viewing;
	find_standard(viewing, seen, standard, appearance);
	scale = scale_of(viewing, seen, xyz[1], &y);
	for (int i = 0; i < 3; i++)
		(viewing->tristimulus ? appearance->xyz : appearance->signal)[i] =
			scale * xyz[i];
	if (!viewing->tristimulus)
		return SPEC_OK;
	if (!white || seen != SPEC_SEEN_REFLECTED)
		white = viewing->white_xyz;
	return find_colour(viewing, seen, xyz, y, white, appearance, error);
}

static enum spec_status
sum_curve(enum spec_rule rule, const struct spec_curve *observer,
	const struct spec_curve *illuminant, const struct spec_curve *curve,
	const double *value, double xyz[3], struct spec_rule_sums *sums,
	struct spec_error *error)
{
	struct spec_bands bands = {.count = curve->count,
		.wavelength_nm = curve->wavelength_nm,
		.per_band = !illuminant && strstr(curve->quantity, "per band")};
	double *weight =
		spec_memory_new(curve->count, 3 * sizeof *weight, "samples", error);
	enum spec_status status = SPEC_ENOMEM;

	if (weight)
		status = spec_rule_weights(
			rule, observer, illuminant, &bands, weight, sums, error);
	for (size_t c = 0; c < 3; c++) {
		xyz[c] = 0;
		for (size_t i = 0; i < curve->count && status == SPEC_OK; i++)
			xyz[c] += weight[c * curve->count + i] * value[i];
	}
	free(weight);
	return status;
}

enum spec_status
spec_appearance_of_curve(const struct spec_viewing *viewing, const struct spec_curve *curve,
	size_t column, struct spec_appearance *appearance, struct spec_error *error)
{
	enum spec_seen seen = spec_seen_of(curve->quantity, curve->unit);
	const struct spec_curve *illuminant =
		seen == SPEC_SEEN_REFLECTED ? &viewing->illuminant : NULL;
	const double *value = curve->value + column * curve->count;
	double xyz[3], standard[3];
	struct spec_rule_sums sums, ignored;
	enum spec_status status;

	spec_appearance_clear(appearance);
	if (seen == SPEC_SEEN_NOTHING)
		return SPEC_OK;
	status = sum_curve(viewing->rule, &viewing->observer, illuminant, curve, value, xyz,
		&sums, error);
	if (status == SPEC_OK)
		status = sum_curve(viewing->rule, &viewing->standard, illuminant, curve,
			value, standard, &ignored, error);
	if (status != SPEC_OK)
		return status == SPEC_ERANGE ? SPEC_OK : status;
	status = spec_appearance_find(
		viewing, seen, xyz, standard, sums.white, appearance, error);
	appearance->outside = sums.outside;
	return status;
}

static void
put_numbers(struct spec_json *json, const char *key, const double *value, size_t count)
{
	if (isfinite(value[0]) && isfinite(value[1]))
		spec_json_numbers(json, key, value, count);
	else
		spec_json_null(json, key);
}

/* A curve of one column is an observer of three that are alike. */
static size_t
count_signals(const struct spec_curve *observer)
{
	return strcmp(observer->column[0], observer->column[1]) == 0 ? 1 : 3;
}

void
spec_appearance_json(struct spec_json *json, const struct spec_appearance *appearance)
{
	const struct spec_viewing *viewing = appearance->viewing;

	if (viewing)
		spec_json_text(json, "rule", spec_rule_name(viewing->rule));
	else
		spec_json_null(json, "rule");
	put_numbers(json, "XYZ", appearance->xyz, 3);
	put_numbers(json, "xy", appearance->xy, 2);
	put_numbers(json, "uv", appearance->uv, 2);
	put_numbers(json, "Lab", appearance->lab, 3);
	spec_json_number(json, "cct", appearance->cct_k);
	spec_json_number(json, "duv", appearance->duv);
	spec_json_number(json, "dominant_nm", appearance->dominant_nm);
	spec_json_number(json, "purity", appearance->purity);
	spec_json_number(json, "luminance", appearance->luminance);
	spec_json_number(json, "illuminance", appearance->illuminance);
	spec_json_number(json, "outside", appearance->outside);
	if (viewing && isfinite(appearance->signal[0]))
		spec_json_numbers(json, "signals", appearance->signal,
			count_signals(&viewing->observer));
	else
		spec_json_null(json, "signals");
}

/* What rounds to 0 in so many decimals is 0, without a sign. */
static double
rounded(double value, double half)
{
	return fabs(value) < half ? 0 : value;
}

static void
print_signals(FILE *stream, const char *lead, const struct spec_appearance *appearance)
{
	const struct spec_viewing *viewing = appearance->viewing;
	size_t count = count_signals(&viewing->observer);

	fprintf(stream, "%s%-13s", lead, "signals");
	for (size_t i = 0; i < count; i++)
		fprintf(stream, "%s %s %.6g", i > 0 ? "," : "", viewing->observer.column[i],
			appearance->signal[i]);
	fputc('\n', stream);
}

void
spec_appearance_print(
	FILE *stream, const char *lead, const struct spec_appearance *appearance)
{
	const struct spec_appearance *a = appearance;

	if (a->viewing && a->viewing->rule_told)
		fprintf(stream, "%s%-13s %s, %s\n", lead, "rule",
			spec_rule_name(a->viewing->rule),
			spec_rule_title(a->viewing->rule));
	if (a->viewing && isfinite(a->signal[0]))
		print_signals(stream, lead, a);
	if (isfinite(a->xyz[0]))
		fprintf(stream, "%s%-13s %.6g %.6g %.6g\n", lead, "XYZ", a->xyz[0],
			a->xyz[1], a->xyz[2]);
	if (isfinite(a->xy[0]))
		fprintf(stream, "%s%-13s %.5f %.5f, u'v' %.5f %.5f\n", lead, "xy", a->xy[0],
			a->xy[1], a->uv[0], a->uv[1]);
	if (isfinite(a->lab[0]))
		fprintf(stream, "%s%-13s %.3f %.3f %.3f\n", lead, "Lab",
			rounded(a->lab[0], 5e-4), rounded(a->lab[1], 5e-4),
			rounded(a->lab[2], 5e-4));
	if (isfinite(a->cct_k))
		fprintf(stream, "%s%-13s %.1f K, Duv %.5f\n", lead, "temperature", a->cct_k,
			rounded(a->duv, 5e-6));
	if (isfinite(a->dominant_nm))
		fprintf(stream, "%s%-13s %.2f nm, purity %.4f\n", lead,
			a->dominant_nm < 0 ? "complementary" : "dominant",
			fabs(a->dominant_nm), a->purity);
	if (isfinite(a->luminance))
		fprintf(stream, "%s%-13s %.6g cd/m^2\n", lead, "luminance", a->luminance);
	if (isfinite(a->illuminance))
		fprintf(stream, "%s%-13s %.6g lx\n", lead, "illuminance", a->illuminance);
	if (a->outside > MUCH && a->viewing)
		fprintf(stream, "%s%-13s %.1f %% of Y, not counted\n", lead, "outside",
			100 * a->outside);
}
