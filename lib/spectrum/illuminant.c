#include "spectrum/illuminant.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

#include "base/number.h"
#include "spectrum/planck.h"

#define DAYLIGHT "daylight:"
#define BLACKBODY "blackbody:"
#define LONGEST_NUMBER 63 /* as in spd(5) */

enum spec_status
spec_daylight_xy(double temperature_k, double xy[2], struct spec_error *error)
{
	double per_t = 1 / temperature_k, x;

	if (!(temperature_k >= SPEC_DAYLIGHT_COOLEST_K &&
		    temperature_k <= SPEC_DAYLIGHT_HOTTEST_K))
		return spec_error_set(error, SPEC_ERANGE,
			"daylight is defined from %g K to %g K, not at %g K",
			SPEC_DAYLIGHT_COOLEST_K, SPEC_DAYLIGHT_HOTTEST_K, temperature_k);
	if (temperature_k <= 7000)
		x = ((-4.6070e9 * per_t + 2.9678e6) * per_t + .09911e3) * per_t + .244063;
	else
		x = ((-2.0064e9 * per_t + 1.9018e6) * per_t + .24748e3) * per_t + .237040;
	xy[0] = x;
	xy[1] = (-3 * x + 2.870) * x - .275;
	return SPEC_OK;
}

/* The factors of S1 and S2, in thousandths. */
static void
daylight_factors(const double xy[2], double m[2])
{
	double x = xy[0], y = xy[1], divisor = .0241 + .2562 * x - .7341 * y;

	m[0] = round(1e3 * (-1.3515 - 1.7703 * x + 5.9114 * y) / divisor) / 1e3;
	m[1] = round(1e3 * (.0300 - 31.4424 * x + 30.0717 * y) / divisor) / 1e3;
}

/* The texts of both kinds. */
static enum spec_status
describe(struct spec_curve *curve, const char *title, double temperature_k,
	const char *source, const char *medium, struct spec_error *error)
{
	char text[96];
	enum spec_status status;

	snprintf(text, sizeof text, "%s of %.10g K", title, temperature_k);
	status = spec_curve_set_text(&curve->title, text, error);
	if (status == SPEC_OK)
		status = spec_curve_set_text(
			&curve->quantity, "spectral power distribution", error);
	if (status == SPEC_OK)
		status =
			spec_curve_set_text(&curve->unit, "relative, 100 at 560 nm", error);
	if (status == SPEC_OK)
		status = spec_curve_set_text(&curve->source, source, error);
	if (status == SPEC_OK)
		status = spec_curve_set_text(&curve->medium, medium, error);
	if (status == SPEC_OK)
		status = spec_curve_set_text(&curve->column[0], "S", error);
	if (status != SPEC_OK)
		spec_curve_free(curve);
	return status;
}

enum spec_status
spec_daylight_curve(const struct spec_curve *components, double temperature_k,
	struct spec_curve *curve, struct spec_error *error)
{
	const size_t count = components->count;
	const double *s = components->value;
	enum spec_status status;
	double xy[2] = {0}, m[2];

	*curve = (struct spec_curve){0};
	if (components->columns < 3)
		return spec_error_set(error, SPEC_EFORMAT,
			"'%.200s' has no three components of daylight", components->title);
	status = spec_daylight_xy(temperature_k, xy, error);
	if (status == SPEC_OK)
		status = spec_curve_new(count, 1, curve, error);
	if (status != SPEC_OK)
		return status;
	daylight_factors(xy, m);
	for (size_t i = 0; i < count; i++) {
		curve->wavelength_nm[i] = components->wavelength_nm[i];
		curve->value[i] = s[i] + m[0] * s[count + i] + m[1] * s[2 * count + i];
	}
	return describe(curve, "Daylight", temperature_k,
		"CIE 15:2018, Colorimetry, equations 4.7 to 4.10", "air", error);
}

enum spec_status
spec_blackbody_curve(
	double temperature_k, struct spec_curve *curve, struct spec_error *error)
{
	const double reference_nm = 560;
	enum spec_status status;
	double reference;

	*curve = (struct spec_curve){0};
	if (!(temperature_k >= SPEC_BLACKBODY_COOLEST_K &&
		    temperature_k <= SPEC_BLACKBODY_HOTTEST_K))
		return spec_error_set(error, SPEC_ERANGE,
			"a black body has %g K to %g K here, not %g K",
			SPEC_BLACKBODY_COOLEST_K, SPEC_BLACKBODY_HOTTEST_K, temperature_k);
	status = spec_curve_new(
		SPEC_BLACKBODY_LAST_NM - SPEC_BLACKBODY_FIRST_NM + 1, 1, curve, error);
	if (status != SPEC_OK)
		return status;
	for (size_t i = 0; i < curve->count; i++)
		curve->wavelength_nm[i] = SPEC_BLACKBODY_FIRST_NM + (double)i;
	spec_planck_radiance(
		temperature_k, curve->wavelength_nm, curve->count, curve->value);
	spec_planck_radiance(temperature_k, &reference_nm, 1, &reference);
	for (size_t i = 0; i < curve->count; i++)
		curve->value[i] *= 100 / reference;
	return describe(curve, "Black body", temperature_k,
		"Planck's law, CIE S 017:2020; constants of the SI, 2019", "vacuum", error);
}

int
spec_illuminant_is_formula(const char *name)
{
	return strncmp(name, DAYLIGHT, strlen(DAYLIGHT)) == 0 ||
	       strncmp(name, BLACKBODY, strlen(BLACKBODY)) == 0;
}

enum spec_status
spec_illuminant_parse(
	const char *name, int *daylight, double *temperature_k, struct spec_error *error)
{
	const char *text = strchr(name, ':');
	size_t length = text ? strlen(++text) : 0;
	char number[LONGEST_NUMBER + 1], what[LONGEST_NUMBER + 32];

	*daylight = strncmp(name, DAYLIGHT, strlen(DAYLIGHT)) == 0;
	if (!spec_illuminant_is_formula(name) || length < 2 || length > LONGEST_NUMBER ||
		text[length - 1] != 'K')
		return spec_error_set(error, SPEC_EUSAGE,
			"'%.200s' is no light: a temperature in kelvins is wanted, as in "
			"%s",
			name, *daylight ? "daylight:6504K" : "blackbody:3000K");
	snprintf(number, sizeof number, "%.*s", (int)(length - 1), text);
	snprintf(what, sizeof what, "the temperature of '%s'", name);
	return spec_number_parse(number,
		*daylight ? SPEC_DAYLIGHT_COOLEST_K : SPEC_BLACKBODY_COOLEST_K,
		*daylight ? SPEC_DAYLIGHT_HOTTEST_K : SPEC_BLACKBODY_HOTTEST_K, what,
		temperature_k, error);
}
