#include "place/sun.h"

#include <math.h>
#include <string.h>

#include <erfa.h>
#include <erfam.h>

#define SUN_RADIUS_M 6.957e8 /* IAU 2015 resolution B3, nominal */

/*
 * ISO 2533:1975: at sea level; the lapse up to the tropopause and the exponent of pressure
 * with it, g / (R lapse); from there on one temperature and the scale height R T / g.
 */
#define STANDARD_HPA 1013.25
#define STANDARD_K 288.15
#define LAPSE_K_PER_M .0065
#define PRESSURE_EXPONENT 5.255876
#define TROPOPAUSE_M 11000
#define TROPOPAUSE_K 216.65
#define TROPOPAUSE_HPA 226.3206
#define SCALE_HEIGHT_M 6341.62

/* Julian dates a day and a half, so any offset from UTC, around 1900 to 2100. */
#define FIRST_JULIAN_DATE 2415019
#define LAST_JULIAN_DATE 2488436

#define LIGHT_TIMES 2        /* the sun's own motion, 13 m/s, makes .01" of the second */
#define HORIZON_DEG (-.8333) /* below, nothing of the disc is seen, and R means nothing */

struct spec_air
spec_air_standard(double altitude_m)
{
	struct spec_air air;
	double kelvin;

	if (altitude_m <= TROPOPAUSE_M) {
		kelvin = STANDARD_K - LAPSE_K_PER_M * altitude_m;
		air.pressure_hpa =
			STANDARD_HPA * pow(kelvin / STANDARD_K, PRESSURE_EXPONENT);
	} else {
		kelvin = TROPOPAUSE_K;
		air.pressure_hpa =
			TROPOPAUSE_HPA * exp(-(altitude_m - TROPOPAUSE_M) / SCALE_HEIGHT_M);
	}
	air.temperature_c = kelvin - 273.15;
	return air;
}

double
spec_air_refraction(const struct spec_air *air, double elevation_deg)
{
	double h = elevation_deg;

	if (h < HORIZON_DEG)
		return 0;
	return air->pressure_hpa / 1010 * 283 / (273 + air->temperature_c) * 1.02 / 60 /
	       tan((h + 10.3 / (h + 5.11)) * ERFA_DD2R);
}

double
spec_air_mass(double zenith_refracted_deg)
{
	double g = 90 - zenith_refracted_deg;

	if (!(g >= 0))
		return NAN;
	return 1 / (sin(g * ERFA_DD2R) + .50572 * pow(g + 6.07995, -1.6364));
}

/*
 * Unit vector towards the sun in the intermediate frame of date (CIRS), and its distance
 * [au], from where astrom says.
 */
static double
seek(eraASTROM *astrom, const double tt[2], double towards[3])
{
	double away_d = 0, distance = 0;

	for (int i = 0; i < LIGHT_TIMES; i++) {
		double heliocentric[2][3], barycentric[2][3], sun[3], natural[3], proper[3];

		(void)eraEpv00(tt[0], tt[1] - away_d, heliocentric, barycentric);
		for (int k = 0; k < 3; k++)
			sun[k] = barycentric[0][k] - heliocentric[0][k] - astrom->eb[k];
		eraPn(sun, &distance, natural);
		away_d = distance * ERFA_AULT / ERFA_DAYSEC;
		eraAb(natural, astrom->v, astrom->em, astrom->bm1, proper);
		eraRxp(astrom->bpn, proper, towards);
	}
	return distance;
}

/* Apparent minus mean solar time, from the earth's centre. */
static double
find_equation(const struct spec_instant *instant, const double tt[2])
{
	eraASTROM astrom;
	double towards[3], ascension, declination, origins, turned;

	eraApci13(tt[0], tt[1], &astrom, &origins);
	(void)seek(&astrom, tt, towards);
	eraC2s(towards, &ascension, &declination);
	turned = eraEra00(instant->utc1, instant->utc2) - ascension -
		 ERFA_D2PI * fmod(fmod(instant->utc1, 1) + fmod(instant->utc2, 1), 1);
	return eraAnpm(turned) / ERFA_D2PI * 1440;
}

static enum spec_status
check(const struct spec_place *place, const struct spec_instant *instant,
	const struct spec_air *air, struct spec_error *error)
{
	enum spec_status status = spec_place_check(place, error);

	if (status != SPEC_OK)
		return status;
	if (!(instant->utc1 + instant->utc2 > FIRST_JULIAN_DATE &&
		    instant->utc1 + instant->utc2 < LAST_JULIAN_DATE))
		return spec_error_set(error, SPEC_ERANGE,
			"the sun's place is known from 1900 to 2100 alone");
	if (!(air->pressure_hpa >= 0 && air->pressure_hpa <= 2000))
		return spec_error_set(error, SPEC_ERANGE,
			"the air's pressure is from 0 to 2000 hPa, not %g",
			air->pressure_hpa);
	if (!(air->temperature_c >= -150 && air->temperature_c <= 150))
		return spec_error_set(error, SPEC_ERANGE,
			"the air's temperature is from -150 to 150 C, not %g",
			air->temperature_c);
	return SPEC_OK;
}

/* What follows from azimuth and zenith distance. */
static void
look(const struct spec_air *air, struct spec_solar *solar)
{
	double azimuth = solar->azimuth_deg * ERFA_DD2R, zenith;

	solar->zenith_refracted_deg =
		solar->zenith_deg - spec_air_refraction(air, 90 - solar->zenith_deg);
	solar->air_mass = spec_air_mass(solar->zenith_refracted_deg);
	solar->air_mass_absolute = solar->air_mass * air->pressure_hpa / STANDARD_HPA;
	solar->antisolar_azimuth_deg = fmod(solar->azimuth_deg + 180, 360);
	solar->antisolar_elevation_deg = solar->zenith_refracted_deg - 90;
	zenith = solar->zenith_refracted_deg * ERFA_DD2R;
	solar->east_north_up[0] = sin(zenith) * sin(azimuth);
	solar->east_north_up[1] = sin(zenith) * cos(azimuth);
	solar->east_north_up[2] = cos(zenith);
}

enum spec_status
spec_solar_position(const struct spec_place *place, const struct spec_instant *instant,
	const struct spec_air *air, struct spec_solar *solar, struct spec_error *error)
{
	struct spec_air standard = spec_air_standard(place->altitude_m);
	eraASTROM astrom;
	double origins, tt[2], towards[3], heliocentric[2][3], barycentric[2][3];
	double ascension, declination, azimuth, zenith, hour_angle, ignored, distance;
	enum spec_status status = check(place, instant, air ? air : &standard, error);

	if (status != SPEC_OK)
		return status;
	/* Without pressure ERFA does not refract. */
	if (eraApco13(instant->utc1, instant->utc2, 0, place->longitude_deg * ERFA_DD2R,
		    place->latitude_deg * ERFA_DD2R, place->altitude_m, 0, 0, 0, 0, 0, .55,
		    &astrom, &origins) < 0)
		return spec_error_set(
			error, SPEC_ERANGE, "ERFA knows nothing of such an instant");
	spec_instant_terrestrial(instant, tt);
	distance = seek(&astrom, tt, towards);
	eraC2s(towards, &ascension, &declination);
	eraAtioq(ascension, declination, &astrom, &azimuth, &zenith, &hour_angle, &ignored,
		&ignored);
	(void)eraEpv00(tt[0], tt[1], heliocentric, barycentric);
	*solar = (struct spec_solar){
		.azimuth_deg = eraAnp(azimuth) * ERFA_DR2D,
		.zenith_deg = zenith * ERFA_DR2D,
		.distance_au = eraPm(heliocentric[0]),
		.radius_deg = asin(SUN_RADIUS_M / (distance * ERFA_DAU)) * ERFA_DR2D,
		.declination_deg = declination * ERFA_DR2D,
		.hour_angle_deg = eraAnpm(hour_angle) * ERFA_DR2D,
		.equation_of_time_min = find_equation(instant, tt),
	};
	look(air ? air : &standard, solar);
	return SPEC_OK;
}
