/*
 * The apparent sun from a place at an instant, by ERFA: light time, aberration, precession
 * and nutation (IAU 2006/2000A), the observer's parallax and diurnal aberration; earth's
 * orbit by eraEpv00, 5" at worst and .2" mostly from 1900 to 2100. UT1 is taken as UTC, from
 * which it is less than .9 s away: 13.5" of hour angle; polar motion, .5", is left out.
 */
#ifndef SPEC_PLACE_SUN_H
#define SPEC_PLACE_SUN_H

#include "base/error.h"
#include "place/coordinates.h"
#include "place/instant.h"

/* What bends the light: the air where the eye is. */
struct spec_air {
	double pressure_hpa, temperature_c;
};

struct spec_solar {
	/* From true north through east, 0 to 360. */
	double azimuth_deg;
	/* From the ellipsoid's normal: as without air, and as refraction lifts the sun. */
	double zenith_deg, zenith_refracted_deg;
	/* Over that at the zenith; NaN for a sun below the horizon. */
	double air_mass;
	/* The same times the pressure over 1013.25 hPa. */
	double air_mass_absolute;
	double distance_au;          /* from the earth's centre to the sun's */
	double radius_deg;           /* of the disc, from the place */
	double declination_deg;      /* from the place, of date */
	double hour_angle_deg;       /* from the place, west of its meridian, -180 to 180 */
	double equation_of_time_min; /* apparent minus mean solar time */
	/* Opposite the refracted sun, where rainbows have their centre. */
	double antisolar_azimuth_deg, antisolar_elevation_deg;
	/* Unit vector towards the refracted sun. */
	double east_north_up[3];
};

/* The International Standard Atmosphere's (ISO 2533:1975), up to 20 km; vacuum-like beyond. */
struct spec_air spec_air_standard(double altitude_m);

/*
 * How far the air lifts what is at that true elevation [deg], from -0.8333 deg upwards;
 * below it 0.
 * Source: Saemundsson, Sky and Telescope 72, 1986, 70, with pressure and temperature as in
 *         Reda & Andreas (eq. 42): R = P/1010 283/(273 + T) 1.02'/tan(h + 10.3/(h + 5.11)).
 */
double spec_air_refraction(const struct spec_air *air, double elevation_deg);

/*
 * Air mass over that of the zenith, at the refracted zenith distance [deg]; NaN beyond 90.
 * Source: Kasten & Young, Applied Optics 28, 1989, 4735: at elevation g
 *         1 / (sin g + 0.50572 (g + 6.07995)^-1.6364).
 */
double spec_air_mass(double zenith_refracted_deg);

/*
 * The sun there and then. air: null for the standard atmosphere of the place's altitude.
 * SPEC_ERANGE: the place, the air, or an instant outside 1900 to 2100.
 */
enum spec_status spec_solar_position(const struct spec_place *place,
	const struct spec_instant *instant, const struct spec_air *air,
	struct spec_solar *solar, struct spec_error *error);

#endif
