#include "optics/grating.h"

#include <math.h>

/* The outgoing direction's component across the grooves. */
static double
across(const double incident[3], int order, double wavelength_nm, double pitch_nm)
{
	return order * wavelength_nm / pitch_nm - incident[1];
}

/*
 * The square of the outgoing direction's z; below 0 there is none. This is what the other two
 * leave of 1, written as a difference to the lamp's own: order 0 never gets lost in rounding.
 */
static double
upright_square(const double incident[3], double outgoing_y)
{
	return incident[2] * incident[2] +
	       (incident[1] - outgoing_y) * (incident[1] + outgoing_y);
}

static int
propagates(const double incident[3], int order, double wavelength_nm, double pitch_nm)
{
	double y = across(incident, order, wavelength_nm, pitch_nm);

	return upright_square(incident, y) >= 0;
}

int
spec_grating_direction(const double incident[3], int order, double wavelength_nm,
	double pitch_nm, double outgoing[3])
{
	double y = across(incident, order, wavelength_nm, pitch_nm);
	double z2 = upright_square(incident, y);

	if (!(z2 >= 0))
		return 0;
	outgoing[0] = -incident[0];
	outgoing[1] = y;
	outgoing[2] = sqrt(z2);
	return 1;
}

void
spec_grating_orders(const double incident[3], double wavelength_nm, double pitch_nm,
	int *lowest, int *highest)
{
	double radius = sqrt(fmax(1 - incident[0] * incident[0], 0));

	/* One more than the quotient says: rounding must not decide otherwise here. */
	*lowest = (int)((incident[1] - radius) * pitch_nm / wavelength_nm) - 1;
	*highest = (int)((incident[1] + radius) * pitch_nm / wavelength_nm) + 1;
	while (*lowest < 0 && !propagates(incident, *lowest, wavelength_nm, pitch_nm))
		++*lowest;
	while (*highest > 0 && !propagates(incident, *highest, wavelength_nm, pitch_nm))
		--*highest;
}

double
spec_grating_phase(double depth_nm, double index, double wavelength_nm)
{
	return 4 * M_PI * index * depth_nm / wavelength_nm;
}

double
spec_grating_lamellar(double width_ratio, double phase_rad, int order)
{
	double retarded = sin(phase_rad / 2), turns = order * width_ratio, share;

	if (order == 0)
		return 1 - 4 * width_ratio * (1 - width_ratio) * retarded * retarded;
	/* Whole turns are taken off first: the orders that vanish do so exactly. */
	share = sin(M_PI * (turns - rint(turns))) / (M_PI * order);
	return 4 * retarded * retarded * share * share;
}
