#include "place/clearsky.h"

#include <math.h>
#include <stddef.h>
#include <string.h>

#include "place/sun.h"
#include "spectrum/lookup.h"

#define RADIANS (3.14159265358979323846 / 180)

#define STANDARD_HPA 1013.   /* of the program; its molecules' depth is for it */
#define EARTH_KM 6370.       /* B 2-10 */
#define OZONE_KM 22.         /* the height of most of it, B 2-10 */
#define SLANT_MASS 1.8       /* of light that the ground sends up, B 3-8 */
#define ALBEDO_DECAY .095    /* of the aerosol's albedo over the wavelength, B 3-16 */
#define LOWEST_COSINE .01745 /* of the sun's zenith angle under a tilted plane, 1 degree */

/* Turbidity: that of the sky's models, dome.h. */
const struct spec_atmosphere spec_atmosphere_lowest = {
	.pressure_hpa = 10, .turbidity = 1, .aerosol_exponent = -1};
const struct spec_atmosphere spec_atmosphere_highest = {.pressure_hpa = 1200,
	.turbidity = 10,
	.aerosol_depth = 10,
	.aerosol_exponent = 4,
	.aerosol_albedo = 1,
	.aerosol_asymmetry = .99,
	.ozone_cm = 2,
	.water_cm = 20,
	.ground_albedo = 1};

struct spec_atmosphere
spec_atmosphere_default(void)
{
	struct spec_atmosphere atmosphere = {.pressure_hpa = 1013.25,
		.aerosol_exponent = 1.3,
		.aerosol_albedo = .945,
		.aerosol_asymmetry = .65,
		.ozone_cm = .34,
		.water_cm = 1.42,
		.ground_albedo = .2};

	spec_atmosphere_set_turbidity(&atmosphere, 3, NULL);
	return atmosphere;
}

struct spec_atmosphere
spec_atmosphere_at(double altitude_m)
{
	struct spec_atmosphere atmosphere = spec_atmosphere_default();

	atmosphere.pressure_hpa = spec_air_standard(altitude_m).pressure_hpa;
	return atmosphere;
}

/* lowest to highest, both included; NaN is not. */
static enum spec_status
check_range(const char *what, double value, double lowest, double highest,
	struct spec_error *error)
{
	if (value >= lowest && value <= highest)
		return SPEC_OK;
	return spec_error_set(error, SPEC_ERANGE, "%s is %g, outside %g..%g", what, value,
		lowest, highest);
}

enum spec_status
spec_atmosphere_set_turbidity(
	struct spec_atmosphere *atmosphere, double turbidity, struct spec_error *error)
{
	enum spec_status status = check_range("the turbidity", turbidity,
		spec_atmosphere_lowest.turbidity, spec_atmosphere_highest.turbidity, error);

	if (status != SPEC_OK)
		return status;
	atmosphere->turbidity = turbidity;
	atmosphere->aerosol_depth =
		(.04608 * turbidity - .04586) * pow(.5, -atmosphere->aerosol_exponent);
	return SPEC_OK;
}

static double
member(const struct spec_atmosphere *atmosphere, size_t offset)
{
	double value;

	memcpy(&value, (const char *)atmosphere + offset, sizeof value);
	return value;
}

static enum spec_status
check_atmosphere(const struct spec_atmosphere *atmosphere, struct spec_error *error)
{
	static const struct {
		const char *what;
		size_t offset;
	} members[] = {
		{"the pressure in hPa", offsetof(struct spec_atmosphere, pressure_hpa)},
		{"the turbidity", offsetof(struct spec_atmosphere, turbidity)},
		{"the aerosol's optical depth",
			offsetof(struct spec_atmosphere, aerosol_depth)},
		{"the aerosol's exponent",
			offsetof(struct spec_atmosphere, aerosol_exponent)},
		{"the aerosol's albedo", offsetof(struct spec_atmosphere, aerosol_albedo)},
		{"the aerosol's asymmetry",
			offsetof(struct spec_atmosphere, aerosol_asymmetry)},
		{"ozone in atm-cm", offsetof(struct spec_atmosphere, ozone_cm)},
		{"water in cm", offsetof(struct spec_atmosphere, water_cm)},
		{"the ground's albedo", offsetof(struct spec_atmosphere, ground_albedo)},
	};
	enum spec_status status = SPEC_OK;

	for (size_t i = 0; i < sizeof members / sizeof members[0] && status == SPEC_OK; i++)
		status = check_range(members[i].what, member(atmosphere, members[i].offset),
			member(&spec_atmosphere_lowest, members[i].offset),
			member(&spec_atmosphere_highest, members[i].offset), error);
	return status;
}

/* A row of the data, and the aerosol at its wavelength. */
struct row {
	double um, outside, water, ozone, gas;
	double depth, albedo; /* B 2-7, B 3-16 */
};

/* What all wavelengths have in common. */
struct way {
	const struct spec_atmosphere *atmosphere;
	double cosine; /* of the sun's zenith angle */
	double mass, ozone_mass;
	/* How much of it aerosol scatters down, B 3-11 and 3-15. */
	double forward, slant_forward;
	double incidence;  /* the cosine of the sun's angle with the plane's normal, or 0 */
	double projection; /* that over the cosine of the zenith angle */
	double upward;     /* the plane's share of the sky, (1 + cos tilt) / 2 */
};

/* The shares of the light that get through, B 2-4 to 2-11, 3-9, 3-10. */
struct shares {
	double molecules, aerosol, water, ozone, gas, scattering, absorption;
};

static struct shares
through(const struct row *row, const struct way *way, double mass)
{
	const struct spec_atmosphere *atmosphere = way->atmosphere;
	double pressed = mass * atmosphere->pressure_hpa / STANDARD_HPA;
	double squared = row->um * row->um;
	double water = row->water * atmosphere->water_cm * mass, gas = row->gas * pressed;
	double depth = row->depth * mass;

	return (struct shares){
		.molecules =
			exp(-pressed / (squared * squared * (115.6406 - 1.3366 / squared))),
		.aerosol = exp(-depth),
		.water = exp(-.2385 * water / pow(1 + 20.07 * water, .45)),
		.ozone = exp(-row->ozone * atmosphere->ozone_cm * way->ozone_mass),
		.gas = exp(-1.41 * gas / pow(1 + 118.3 * gas, .45)),
		.scattering = exp(-row->albedo * depth),
		.absorption = exp(-(1 - row->albedo) * depth)};
}

/* What a wavelength brings where, in the order of the columns. */
static void
shine(const struct row *row, const struct way *way,
	double value[static SPEC_CLEARSKY_COLUMNS])
{
	struct shares here = through(row, way, way->mass);
	struct shares slant = through(row, way, SLANT_MASS);
	double albedo = way->atmosphere->ground_albedo;
	double direct = row->outside * here.molecules * here.aerosol * here.water *
			here.ozone * here.gas;
	double common = row->outside * way->cosine * here.ozone * here.gas * here.water *
			here.absorption;
	double by_molecules = common * (1 - pow(here.molecules, .95)) * .5;
	double by_aerosol =
		common * pow(here.molecules, 1.5) * (1 - here.scattering) * way->forward;
	double back =
		slant.gas * slant.water * slant.absorption *
		(.5 * (1 - slant.molecules) + (1 - way->slant_forward) * slant.molecules *
						      (1 - slant.scattering));
	double between = (direct * way->cosine + by_molecules + by_aerosol) * back *
			 albedo / (1 - back * albedo);
	double more = row->um <= .45 ? pow(row->um + .55, 1.8) : 1;
	double diffuse = (by_molecules + by_aerosol + between) * more;
	double around = direct / row->outside;

	value[SPEC_CLEARSKY_OUTSIDE] = row->outside;
	value[SPEC_CLEARSKY_DIRECT] = direct;
	value[SPEC_CLEARSKY_SUN] = direct * way->incidence;
	value[SPEC_CLEARSKY_SKY] =
		diffuse * (around * way->projection + way->upward * (1 - around)) +
		(direct * way->cosine + diffuse) * albedo * (1 - way->upward);
	value[SPEC_CLEARSKY_BOTH] = value[SPEC_CLEARSKY_SUN] + value[SPEC_CLEARSKY_SKY];
}

/* The part of what aerosol scatters that goes down, B 3-11 to 3-15. */
static double
forward_part(double asymmetry, double cosine)
{
	double g = log(1 - asymmetry);
	double a = g * (1.459 + g * (.1595 + g * .4129));
	double b = g * (.0783 + g * (-.3824 - g * .5874));

	return 1 - .5 * exp((a + b * cosine) * cosine);
}

static enum spec_status
start(const struct spec_clearsky_sun *sun, const struct spec_atmosphere *atmosphere,
	const struct spec_clearsky_plane *plane, struct way *way, struct spec_error *error)
{
	double zenith = sun->zenith_deg * RADIANS, height = OZONE_KM / EARTH_KM;
	double tilt_deg = plane ? plane->tilt_deg : 0, tilt = tilt_deg * RADIANS;
	double turn = plane ? (sun->azimuth_deg - plane->azimuth_deg) * RADIANS : 0;
	enum spec_status status = check_atmosphere(atmosphere, error);

	if (status != SPEC_OK)
		return status;
	if (sun->zenith_deg >= 90)
		return spec_error_set(error, SPEC_ERANGE,
			"the sun is %.2f degrees below the horizon, and the model of a "
			"clear sky is for the day",
			sun->zenith_deg - 90);
	status = check_range(
		"the sun's zenith angle in degrees", sun->zenith_deg, 0, 90, error);
	if (status == SPEC_OK)
		status = check_range(
			"the sun's distance in au", sun->distance_au, .9, 1.1, error);
	if (status == SPEC_OK)
		status =
			check_range("the plane's tilt in degrees", tilt_deg, 0, 180, error);
	if (status == SPEC_OK && !isfinite(turn))
		status = spec_error_set(error, SPEC_ERANGE, "an azimuth is not a number");
	if (status != SPEC_OK)
		return status;
	*way = (struct way){.atmosphere = atmosphere, .cosine = cos(zenith)};
	way->mass = spec_air_mass(sun->zenith_deg);
	way->ozone_mass = (1 + height) / sqrt(way->cosine * way->cosine + 2 * height);
	way->forward = forward_part(atmosphere->aerosol_asymmetry, way->cosine);
	way->slant_forward = forward_part(atmosphere->aerosol_asymmetry, 1 / SLANT_MASS);
	way->incidence =
		fmax(cos(tilt) * way->cosine + sin(tilt) * sin(zenith) * cos(turn), 0);
	way->projection = tilt > 0 ? way->incidence / fmax(way->cosine, LOWEST_COSINE) : 1;
	way->upward = (1 + cos(tilt)) / 2;
	return SPEC_OK;
}

static enum spec_status
name_columns(struct spec_curve *curve, struct spec_error *error)
{
	static const char *const names[] = {"outside", "direct", "sun", "sky", "both"};
	enum spec_status status = SPEC_OK;

	for (size_t i = 0; i < SPEC_CLEARSKY_COLUMNS && status == SPEC_OK; i++)
		status = spec_curve_set_text(&curve->column[i], names[i], error);
	if (status == SPEC_OK)
		status = spec_curve_set_text(
			&curve->title, "Irradiance under a clear sky", error);
	if (status == SPEC_OK)
		status = spec_curve_set_text(
			&curve->quantity, "spectral power distribution", error);
	if (status == SPEC_OK)
		status = spec_curve_set_text(&curve->unit, "W m-2 nm-1", error);
	if (status == SPEC_OK)
		status = spec_curve_set_text(&curve->source,
			"SPCTRAL2: R. E. Bird and C. Riordan, Journal of Climate and "
			"Applied Meteorology 25, 1986, 87-97",
			error);
	if (status == SPEC_OK)
		status = spec_curve_set_text(&curve->medium, "air", error);
	return status;
}

/* The rows of the data, B 2-7 and B 3-16. */
static void
fill(const struct spec_curve *data, const struct spec_clearsky_sun *sun,
	const struct way *way, struct spec_curve *curve)
{
	const struct spec_atmosphere *atmosphere = way->atmosphere;
	const double *value = data->value;
	size_t count = data->count;

	for (size_t i = 0; i < count; i++) {
		double nm = data->wavelength_nm[i], fourfold = log(nm / 400);
		struct row row = {.um = nm / 1000,
			.outside = value[i] / (sun->distance_au * sun->distance_au),
			.water = value[count + i],
			.ozone = value[2 * count + i],
			.gas = value[3 * count + i],
			.depth = atmosphere->aerosol_depth *
				 pow(nm / 500, -atmosphere->aerosol_exponent),
			.albedo = atmosphere->aerosol_albedo *
				  exp(-ALBEDO_DECAY * fourfold * fourfold)};
		double column[SPEC_CLEARSKY_COLUMNS];

		shine(&row, way, column);
		curve->wavelength_nm[i] = nm;
		for (size_t j = 0; j < SPEC_CLEARSKY_COLUMNS; j++)
			curve->value[j * count + i] = column[j];
	}
}

enum spec_status
spec_clearsky_curve(const struct spec_clearsky_sun *sun,
	const struct spec_atmosphere *atmosphere, const struct spec_clearsky_plane *plane,
	struct spec_curve *curve, struct spec_error *error)
{
	struct spec_curve data = {0};
	struct way way = {0};
	enum spec_status status = start(sun, atmosphere, plane, &way, error);

	*curve = (struct spec_curve){0};
	if (status == SPEC_OK)
		status = spec_lookup_curve("sky/spctral2", &data, error);
	if (status == SPEC_OK && data.columns != 4)
		status = spec_error_set(error, SPEC_EFORMAT,
			"'sky/spctral2' has %zu columns, not 4", data.columns);
	if (status == SPEC_OK)
		status = spec_curve_new(data.count, SPEC_CLEARSKY_COLUMNS, curve, error);
	if (status == SPEC_OK)
		status = name_columns(curve, error);
	if (status == SPEC_OK)
		fill(&data, sun, &way, curve);
	else
		spec_curve_free(curve);
	spec_curve_free(&data);
	return status;
}
