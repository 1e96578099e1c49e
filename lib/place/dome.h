/*
 * The radiance of a clear sky over its directions, and of the sun's disc in it, spectrally.
 * Sources:  L. Hosek, A. Wilkie: An Analytic Model for Full Spectral Sky-Dome Radiance. ACM
 *           Transactions on Graphics 31 (4), 2012, 95: "H".
 *           L. Hosek, A. Wilkie: Adding a Solar-Radiance Function to the Hosek-Wilkie
 *           Skylight Model. IEEE Computer Graphics and Applications 33 (3), 2013, 44-52.
 * The model has 11 bands, 40 nm apart, from 320 to 720 nm, linear between; it is for a place
 * at sea level, turbidities from 1 to 10 and the sun above the horizon.
 *
 * Two things are not in the papers:
 * - Their program multiplies the disc's radiance by a limb darkening that is 1 in the centre;
 *   here it is divided by its mean over the disc, so that the radiance is that of the disc's
 *   mean and the irradiance does not depend on how the disc is darkened.
 * - Outside 320 to 720 nm the sky has the distribution of 320 or 720 nm over its directions,
 *   and its radiance is to that of the end as the diffuse irradiance on a horizontal plane is
 *   in the model of clearsky.h; the disc likewise by the direct irradiance. Since the bands
 *   know no water vapour and no oxygen, the end is taken without them, and what they absorb
 *   begins beyond 720 nm.
 *
 * Directions are unit vectors: x to the east, y to the north, z up.
 */
#ifndef SPEC_PLACE_DOME_H
#define SPEC_PLACE_DOME_H

#include <stddef.h>

#include "base/error.h"
#include "place/clearsky.h"

#define SPEC_DOME_BANDS 11
#define SPEC_DOME_LOW_NM 320.
#define SPEC_DOME_HIGH_NM 720.
#define SPEC_DOME_STEP_NM 40.

/* The radius of the sun as it is seen from 1 au [rad]: 695700 km (IAU 2015, B3) in 1 au. */
#define SPEC_DOME_SUN_RADIUS_RAD 4.65047e-3

struct spec_dome {
	double sun[3];     /* the direction of its centre */
	double radius_rad; /* of its disc */
	/* Coefficients A to I of H 8, in the order of the data: A B C D E F G I H. */
	double distribution[9][SPEC_DOME_BANDS];
	double radiance[SPEC_DOME_BANDS]; /* the factor of H 8 [W m-2 sr-1 nm-1] */
	double disc[SPEC_DOME_BANDS];     /* mean over the disc [W m-2 sr-1 nm-1] */
	/* What the mean of the disc is multiplied by: powers 0 to 5 of the cosine there. */
	double limb[6][SPEC_DOME_BANDS];
	/* Irradiance outside the bands over that of their end: columns of clearsky.h. */
	struct spec_curve below, beyond;
};

/*
 * Makes the dome of a position of the sun, as it is seen. Of the atmosphere the turbidity and
 * the ground's albedo count within 320 to 720 nm. To be freed with spec_dome_free.
 * Errors: SPEC_ERANGE  the sun at or below the horizon; what lies outside its range
 *         SPEC_EUSAGE, SPEC_EIO, SPEC_EFORMAT  the data in "sky/" cannot be had
 * On an error dome is empty.
 */
enum spec_status spec_dome_make(const struct spec_clearsky_sun *sun,
	const struct spec_atmosphere *atmosphere, struct spec_dome *dome,
	struct spec_error *error);

/* Frees what dome holds and leaves it empty; null or empty is allowed. */
void spec_dome_free(struct spec_dome *dome);

/*
 * The sky's radiance in a direction without the sun's disc, at the 11 bands [W m-2 sr-1
 * nm-1]: 0 below the horizon, else 0 or more. Costs some 0.1 us.
 */
void spec_dome_sky(const struct spec_dome *dome, const double direction[3],
	double radiance[static SPEC_DOME_BANDS]);

/*
 * The radiance of the sun's disc alone, at the 11 bands: 0 off the disc and below the horizon.
 * Returns whether the direction is on it.
 */
int spec_dome_disc(const struct spec_dome *dome, const double direction[3],
	double radiance[static SPEC_DOME_BANDS]);

/* The solid angle of the disc [sr]; its irradiance is that times dome->disc. */
double spec_dome_disc_sr(const struct spec_dome *dome);

/* How wavelengths follow from bands: value = low * band[index] + high * band[index + 1]. */
struct spec_dome_weight {
	int index; /* 0 to SPEC_DOME_BANDS - 2 */
	double low, high;
};

/*
 * The weights of count wavelengths [nm], one for the sky and one for the disc each; either
 * may be null. Error: SPEC_ERANGE: not 300 to 4000 nm.
 */
enum spec_status spec_dome_weigh(const struct spec_dome *dome, const double *wavelength_nm,
	size_t count, struct spec_dome_weight *sky, struct spec_dome_weight *disc,
	struct spec_error *error);

/* The radiance at count wavelengths from that at the bands. */
void spec_dome_spread(const struct spec_dome_weight *weight, size_t count,
	const double band[static SPEC_DOME_BANDS], double *radiance);

#endif
