/*
 * The light of the sun and of a clear sky, spectrally, on any plane.
 * Source:   R. E. Bird, C. Riordan: Simple solar spectral model for direct and diffuse
 *           irradiance on horizontal and tilted planes at the earth's surface for cloudless
 *           atmospheres. SERI/TR-215-2436, 1984; Journal of Climate and Applied Meteorology
 *           25, 1986, 87-97: SPCTRAL2. Equations "B" are those of the report.
 * Where the report and NREL's program of the model, spectrl2_2.c, differ, the program has
 * the later figures and is followed: 1.3366 in B 2-4 (1.335), 118.3 in B 2-11 (118.93), the
 * gases in place of ozone in B 3-8, the factor of B 3-17 once, and the air mass of sun.h in
 * B 2-5.
 * Accuracy: that of the model: 5 to 10 % against rigorous codes at most wavelengths, more
 *           where water absorbs; zenith angles up to 80 degrees are those it was made for.
 */
#ifndef SPEC_PLACE_CLEARSKY_H
#define SPEC_PLACE_CLEARSKY_H

#include "base/error.h"
#include "spectrum/curve.h"

#define SPEC_CLEARSKY_LOW_NM 300.
#define SPEC_CLEARSKY_HIGH_NM 4000.

/* What is above the place, and the ground around it. */
struct spec_atmosphere {
	double pressure_hpa;      /* at the place */
	double turbidity;         /* of the air over its molecules', for the sky (dome.h) */
	double aerosol_depth;     /* optical depth at 500 nm */
	double aerosol_exponent;  /* Angstrom's: the depth goes as wavelength^-exponent */
	double aerosol_albedo;    /* of one scattering at 400 nm */
	double aerosol_asymmetry; /* the mean cosine of the angle of scattering */
	double ozone_cm;          /* atm-cm */
	double water_cm;          /* of precipitable water */
	double ground_albedo;
};

/* From what to what each of them may be, both included. */
extern const struct spec_atmosphere spec_atmosphere_lowest, spec_atmosphere_highest;

/* Where the sun is seen, refraction included, and how far it is. */
struct spec_clearsky_sun {
	double zenith_deg;  /* 0 to < 90 */
	double azimuth_deg; /* from north by east */
	double distance_au; /* > 0 */
};

struct spec_clearsky_plane {
	double tilt_deg;    /* 0 horizontal, 90 a wall, 180 a ceiling */
	double azimuth_deg; /* that it faces, from north by east */
};

/*
 * At sea level: 1013.25 hPa, turbidity 3 with its aerosol of exponent 1.3, rural aerosol
 * (0.945 and 0.65, B table 3-1), 0.34 atm-cm of ozone, 1.42 cm of water (those of the
 * standard atmospheres of middle latitudes and of the U.S.), albedo 0.2.
 */
struct spec_atmosphere spec_atmosphere_default(void);

/* The same at an altitude [m], with the pressure that spec_air_standard has there. */
struct spec_atmosphere spec_atmosphere_at(double altitude_m);

/*
 * Sets the turbidity and the depth of aerosol with it, 0.04608 T - 0.04586 at 1 um and with
 * the exponent that is there at 500 nm.
 * Source: A. J. Preetham, P. Shirley, B. Smits: A Practical Analytic Model for Daylight.
 *         SIGGRAPH 1999, 91-100, appendix 1 (its exponent is 1.3).
 * Error:  SPEC_ERANGE  outside its range
 */
enum spec_status spec_atmosphere_set_turbidity(
	struct spec_atmosphere *atmosphere, double turbidity, struct spec_error *error);

/*
 * Irradiance [W m-2 nm-1] at the 122 wavelengths of the model, 300 to 4000 nm, a curve with
 * the columns
 *   outside  perpendicular to the sun, outside the atmosphere (B 2-2, at its distance)
 *   direct   from the sun, perpendicular to it (B 2-1)
 *   sun      of that on the plane; 0 where the plane looks away from it
 *   sky      on the plane from the rest: from the sky, brighter around the sun, and from the
 *            ground where the plane is not horizontal (B 3-1 to 3-18)
 *   both     the sum of the two
 * plane: null is horizontal.
 * Errors:  SPEC_ERANGE  the sun at or below the horizon, what lies outside its range
 *          SPEC_EUSAGE, SPEC_EIO, SPEC_EFORMAT  the data "sky/spctral2" cannot be had
 */
enum spec_status spec_clearsky_curve(const struct spec_clearsky_sun *sun,
	const struct spec_atmosphere *atmosphere, const struct spec_clearsky_plane *plane,
	struct spec_curve *curve, struct spec_error *error);

/* The columns of that curve. */
enum spec_clearsky_column {
	SPEC_CLEARSKY_OUTSIDE,
	SPEC_CLEARSKY_DIRECT,
	SPEC_CLEARSKY_SUN,
	SPEC_CLEARSKY_SKY,
	SPEC_CLEARSKY_BOTH,
	SPEC_CLEARSKY_COLUMNS
};

#endif
