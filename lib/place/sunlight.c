#include "place/sunlight.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "base/memory.h"
#include "base/number.h"

#define HIGHEST_M 20000. /* over which a standard atmosphere is known */

static const char *const parts[] = {"sun", "sky", "daylight"};

/* ---- names ---- */

/* What the options say, in the order of option_names; NaN where they do not. */
enum option {
	TURBIDITY,
	AEROSOL,
	ANGSTROM,
	OZONE,
	WATER,
	PRESSURE,
	ALBEDO,
	TILT,
	FACING,
	OPTIONS
};

static const double tilts_deg[] = {0, 180}, azimuths_deg[] = {-360, 360};

#define RANGE(member) &spec_atmosphere_lowest.member, &spec_atmosphere_highest.member

static const struct {
	const char *name, *what;
	const double *lowest, *highest;
} options[OPTIONS] = {
	[TURBIDITY] = {"turbidity", "turbidity", RANGE(turbidity)},
	[AEROSOL] = {"aerosol", "optical depth of aerosol", RANGE(aerosol_depth)},
	[ANGSTROM] = {"angstrom", "exponent of aerosol", RANGE(aerosol_exponent)},
	[OZONE] = {"ozone", "column of ozone", RANGE(ozone_cm)},
	[WATER] = {"water", "column of water", RANGE(water_cm)},
	[PRESSURE] = {"pressure", "pressure", RANGE(pressure_hpa)},
	[ALBEDO] = {"albedo", "albedo", RANGE(ground_albedo)},
	[TILT] = {"tilt", "tilt", &tilts_deg[0], &tilts_deg[1]},
	[FACING] = {"facing", "azimuth", &azimuths_deg[0], &azimuths_deg[1]},
};

/* The length of the part's name, "@" included; 0: none. */
static size_t
find_part(const char *name, enum spec_sunlight_part *part)
{
	for (int i = 0; i < 3; i++) {
		size_t length = strlen(parts[i]);

		if (strncmp(name, parts[i], length) == 0 && name[length] == '@') {
			*part = (enum spec_sunlight_part)i;
			return length + 1;
		}
	}
	return 0;
}

static int
is_named(const char *name)
{
	enum spec_sunlight_part part;

	return find_part(name, &part) > 0;
}

/* The option that "NAME=VALUE" or "NAME" names, or OPTIONS. */
static enum option
find_option(const char *text)
{
	size_t length = strcspn(text, "=");
	enum option i = 0;

	while (i < OPTIONS && (strlen(options[i].name) != length ||
				      strncmp(options[i].name, text, length) != 0))
		i++;
	return i;
}

/* Reads "NAME=VALUE". */
static enum spec_status
take_option(const char *text, double value[OPTIONS], struct spec_error *error)
{
	size_t length = strcspn(text, "=");
	enum option i = find_option(text);

	if (i == OPTIONS)
		return spec_error_set(error, SPEC_EUSAGE,
			"'%.*s' is none of turbidity, aerosol, angstrom, ozone, water, "
			"pressure, albedo, tilt and facing",
			(int)length, text);
	if (!isnan(value[i]))
		return spec_error_set(
			error, SPEC_EUSAGE, "'%s' is given twice", options[i].name);
	if (!text[length])
		return spec_error_set(
			error, SPEC_EUSAGE, "'%s' needs a value: %s=NUMBER", text, text);
	text += length + 1;
	if (i == TILT || i == FACING)
		return spec_number_parse_angle(text, *options[i].lowest,
			*options[i].highest, options[i].what, &value[i], error);
	return spec_number_parse(text, *options[i].lowest, *options[i].highest,
		options[i].what, &value[i], error);
}

static void
forget_options(double value[OPTIONS])
{
	for (int i = 0; i < OPTIONS; i++)
		value[i] = NAN;
}

/* An option in place of a default. */
static void
settle(double option, double *value)
{
	if (!isnan(option))
		*value = option;
}

static enum spec_status
settle_all(const double value[OPTIONS], struct spec_sunlight *sunlight,
	struct spec_error *error)
{
	struct spec_atmosphere *air = &sunlight->atmosphere;
	double turbidity;
	enum spec_status status;

	*air = spec_atmosphere_at(sunlight->place.altitude_m);
	turbidity = air->turbidity;
	settle(value[ANGSTROM], &air->aerosol_exponent);
	settle(value[TURBIDITY], &turbidity);
	status = spec_atmosphere_set_turbidity(air, turbidity, error);
	if (status != SPEC_OK)
		return status;
	settle(value[AEROSOL], &air->aerosol_depth);
	settle(value[OZONE], &air->ozone_cm);
	settle(value[WATER], &air->water_cm);
	settle(value[ALBEDO], &air->ground_albedo);
	settle(value[PRESSURE], &air->pressure_hpa);
	sunlight->has_plane = !isnan(value[TILT]) || !isnan(value[FACING]);
	sunlight->plane = (struct spec_clearsky_plane){90, 180};
	settle(value[TILT], &sunlight->plane.tilt_deg);
	settle(value[FACING], &sunlight->plane.azimuth_deg);
	return SPEC_OK;
}

/* The last of the fields of text, cut off from the others, from its first letter on; or null. */
static char *
cut_last(char *text)
{
	char *comma = strrchr(text, ',');

	if (!comma)
		return NULL;
	*comma = '\0';
	return comma + 1 + strspn(comma + 1, " ");
}

/* text: what stands behind the @, which is cut up; *at: the field at fault. */
static enum spec_status
parse(char *text, struct spec_sunlight *sunlight, const char **at, struct spec_error *error)
{
	double value[OPTIONS];
	char *field;
	enum spec_status status = SPEC_OK;

	forget_options(value);
	*at = text;
	while (status == SPEC_OK && (field = cut_last(text)) &&
		(strchr(field, '=') || find_option(field) < OPTIONS)) {
		*at = field;
		status = take_option(field, value, error);
	}
	if (status != SPEC_OK)
		return status;
	*at = field ? field : text;
	if (!field)
		return spec_error_set(error, SPEC_EUSAGE,
			"a place, a comma and a time are wanted, such as '50.88N 4.70E,"
			"2005-05-17T12:00+02:00'");
	status = spec_instant_parse(field, &sunlight->instant, error);
	if (status != SPEC_OK)
		return status;
	*at = text;
	status = spec_place_parse(text, &sunlight->place, error);
	return status == SPEC_OK ? settle_all(value, sunlight, error) : status;
}

enum spec_status
spec_sunlight_parse(
	const char *name, struct spec_sunlight *sunlight, struct spec_error *error)
{
	const char *at;
	char *text;
	size_t start;
	enum spec_status status;

	*sunlight = (struct spec_sunlight){0};
	start = find_part(name, &sunlight->part);
	if (start == 0)
		return spec_error_set(error, SPEC_EUSAGE,
			"'%.200s' does not begin with sun@, sky@ or daylight@", name);
	text = spec_memory_text(name + start, strlen(name + start), error);
	if (!text)
		return SPEC_ENOMEM;
	status = parse(text, sunlight, &at, error);
	if (status == SPEC_EUSAGE || status == SPEC_ERANGE)
		spec_error_point(error, name, start + (size_t)(at - text));
	free(text);
	return status;
}

enum spec_status
spec_sunlight_at(const struct spec_place *place, const struct spec_instant *instant,
	const char *given, struct spec_sunlight *sunlight, struct spec_error *error)
{
	double value[OPTIONS];
	char *text = spec_memory_text(given, strlen(given), error), *field;
	enum spec_status status = text ? SPEC_OK : SPEC_ENOMEM;

	*sunlight = (struct spec_sunlight){
		.part = SPEC_SUNLIGHT_BOTH, .place = *place, .instant = *instant};
	forget_options(value);
	while (status == SPEC_OK && (field = cut_last(text)))
		status = take_option(field, value, error);
	free(text);
	return status == SPEC_OK ? settle_all(value, sunlight, error) : status;
}

/* ---- light ---- */

enum spec_status
spec_sunlight_sun(const struct spec_sunlight *sunlight, struct spec_clearsky_sun *sun,
	struct spec_error *error)
{
	struct spec_air air = spec_air_standard(sunlight->place.altitude_m);
	struct spec_solar solar;
	char place[SPEC_PLACE_WRITTEN], instant[SPEC_INSTANT_WRITTEN];
	enum spec_status status;

	air.pressure_hpa = sunlight->atmosphere.pressure_hpa;
	if (!(sunlight->place.altitude_m <= HIGHEST_M))
		return spec_error_set(error, SPEC_ERANGE,
			"the light at an altitude of %g m is not known, only up to %g m",
			sunlight->place.altitude_m, HIGHEST_M);
	status = spec_solar_position(
		&sunlight->place, &sunlight->instant, &air, &solar, error);
	if (status != SPEC_OK)
		return status;
	*sun = (struct spec_clearsky_sun){
		solar.zenith_refracted_deg, solar.azimuth_deg, solar.distance_au};
	if (sun->zenith_deg < 90)
		return SPEC_OK;
	spec_place_brief(&sunlight->place, place);
	spec_instant_format(&sunlight->instant, 0, instant);
	return spec_error_set(error, SPEC_ERANGE,
		"at %s on %s the sun's centre is %.2f degrees below the horizon, and the light of "
		"twilight and night is not known",
		place, instant, sun->zenith_deg - 90);
}

static enum spec_status
describe(const struct spec_sunlight *sunlight, const struct spec_clearsky_sun *sun,
	const struct spec_curve *clear, struct spec_curve *curve, struct spec_error *error)
{
	static const char *const what[] = {"Sun", "Clear sky", "Sun and clear sky"};
	char place[SPEC_PLACE_WRITTEN], instant[SPEC_INSTANT_WRITTEN], title[256];
	enum spec_status status;

	spec_place_brief(&sunlight->place, place);
	spec_instant_format(&sunlight->instant, 0, instant);
	snprintf(title, sizeof title, "%s at %s, %s, the sun %.2f degrees high",
		what[sunlight->part], place, instant, 90 - sun->zenith_deg);
	status = spec_curve_set_text(&curve->title, title, error);
	if (status == SPEC_OK)
		status = spec_curve_set_text(&curve->quantity, clear->quantity, error);
	if (status == SPEC_OK)
		status = spec_curve_set_text(&curve->unit, clear->unit, error);
	if (status == SPEC_OK)
		status = spec_curve_set_text(&curve->source, clear->source, error);
	if (status == SPEC_OK)
		status = spec_curve_set_text(&curve->medium, clear->medium, error);
	if (status == SPEC_OK)
		status = spec_curve_set_text(&curve->column[0], "E", error);
	return status;
}

enum spec_status
spec_sunlight_make(const struct spec_sunlight *sunlight, struct spec_curve *curve,
	struct spec_error *error)
{
	enum spec_clearsky_column column =
		sunlight->part == SPEC_SUNLIGHT_SKY    ? SPEC_CLEARSKY_SKY
		: sunlight->part == SPEC_SUNLIGHT_BOTH ? SPEC_CLEARSKY_BOTH
		: sunlight->has_plane                  ? SPEC_CLEARSKY_SUN
						       : SPEC_CLEARSKY_DIRECT;
	struct spec_clearsky_sun sun;
	struct spec_curve clear = {0};
	enum spec_status status = spec_sunlight_sun(sunlight, &sun, error);

	*curve = (struct spec_curve){0};
	if (status == SPEC_OK)
		status = spec_clearsky_curve(&sun, &sunlight->atmosphere,
			sunlight->has_plane ? &sunlight->plane : NULL, &clear, error);
	if (status == SPEC_OK)
		status = spec_curve_new(clear.count, 1, curve, error);
	if (status == SPEC_OK)
		status = describe(sunlight, &sun, &clear, curve, error);
	if (status == SPEC_OK) {
		memcpy(curve->wavelength_nm, clear.wavelength_nm,
			clear.count * sizeof *clear.wavelength_nm);
		memcpy(curve->value, clear.value + column * clear.count,
			clear.count * sizeof *clear.value);
	} else {
		spec_curve_free(curve);
	}
	spec_curve_free(&clear);
	return status;
}

enum spec_status
spec_sunlight_named(const char *name, struct spec_curve *curve, struct spec_error *error)
{
	struct spec_sunlight sunlight;
	enum spec_status status = spec_sunlight_parse(name, &sunlight, error);

	*curve = (struct spec_curve){0};
	return status == SPEC_OK ? spec_sunlight_make(&sunlight, curve, error) : status;
}

const struct spec_lookup_maker spec_sunlight_maker = {is_named, spec_sunlight_named};
