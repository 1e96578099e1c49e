#include "optics/ordertable.h"

#include <math.h>
#include <stdio.h>

#include "optics/grating.h"

#define RADIANS_PER_DEGREE (3.14159265358979323846 / 180)

static double
cleaned(double component)
{
	return fabs(component) < 1e-15 ? 0 : component;
}

static void
print_orders(FILE *file, const struct spec_disc *disc, const double incident[3],
	double wavelength_nm)
{
	double phase = spec_grating_phase(disc->pit_depth_nm, disc->index, wavelength_nm);
	double outgoing[3];
	int lowest, highest;

	spec_grating_orders(incident, wavelength_nm, disc->track_nm, &lowest, &highest);
	for (int order = lowest; order <= highest; order++) {
		double sine;

		if (!spec_grating_direction(
			    incident, order, wavelength_nm, disc->track_nm, outgoing))
			continue;
		sine = hypot(outgoing[0], outgoing[1]);
		/* What rounding leaves of 0, or -0, would have an azimuth, too. */
		fprintf(file, "%d %.10g %.10g %.10g %.10g\n", order, wavelength_nm,
			atan2(sine, outgoing[2]) / RADIANS_PER_DEGREE,
			atan2(cleaned(outgoing[0]), cleaned(outgoing[1])) /
				RADIANS_PER_DEGREE,
			spec_grating_lamellar(
				disc->pit_width_nm / disc->track_nm, phase, order));
	}
}

enum spec_status
spec_orders_text(const struct spec_disc *disc, double angle_deg, double azimuth_deg,
	const double *wavelength_nm, size_t count, struct spec_text *text,
	struct spec_error *error)
{
	double angle = angle_deg * RADIANS_PER_DEGREE;
	double azimuth = azimuth_deg * RADIANS_PER_DEGREE;
	double incident[3] = {
		sin(angle) * sin(azimuth), sin(angle) * cos(azimuth), cos(angle)};
	enum spec_status status = spec_text_open(text, error);

	if (status != SPEC_OK)
		return status;
	fputs("# order nm angle azimuth efficiency\n", text->stream);
	for (size_t i = 0; i < count; i++)
		print_orders(text->stream, disc, incident, wavelength_nm[i]);
	return spec_text_close(text, error);
}
