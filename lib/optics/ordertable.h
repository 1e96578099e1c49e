/* A disc's orders as text. */
#ifndef SPEC_OPTICS_ORDERTABLE_H
#define SPEC_OPTICS_ORDERTABLE_H

#include <stddef.h>

#include "base/error.h"
#include "base/text.h"
#include "optics/disc.h"

/*
 * A line for each order that leaves the disc, at each of count wavelengths [nm]: "order nm
 * angle azimuth efficiency", after a line that says so. Light comes from angle_deg (0 to
 * 90) to the normal; azimuth_deg is that of the plane of incidence, 0 across the tracks, 90
 * along them. The order's angle is to the normal too, and its azimuth goes from -180 to 180.
 * Efficiencies are those of spec_grating_lamellar. text: to be freed. Error: SPEC_ENOMEM.
 */
enum spec_status spec_orders_text(const struct spec_disc *disc, double angle_deg,
	double azimuth_deg, const double *wavelength_nm, size_t count,
	struct spec_text *text, struct spec_error *error);

#endif
