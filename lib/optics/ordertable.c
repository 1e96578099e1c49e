#include "optics/ordertable.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "base/memory.h"
#include "optics/grating.h"

#define RADIANS_PER_DEGREE (3.14159265358979323846 / 180)

static double
cleaned(double component)
{
	return fabs(component) < 1e-15 ? 0 : component;
}

/* A text that grows: the C library's streams in memory lose what they cannot hold. */
struct table {
	char *text;
	size_t length, room;
};

static enum spec_status
add_line(struct table *table, const char *line, struct spec_error *error)
{
	size_t length = strlen(line);
	void *text = table->text;
	enum spec_status status = spec_memory_grow(
		&text, &table->room, table->length + length, 1, "bytes", error);

	table->text = text;
	if (status == SPEC_OK) {
		memcpy(table->text + table->length, line, length);
		table->length += length;
	}
	return status;
}

static enum spec_status
add_orders(struct table *table, const struct spec_disc *disc, const double incident[3],
	double wavelength_nm, struct spec_error *error)
{
	double phase = spec_grating_phase(disc->pit_depth_nm, disc->index, wavelength_nm);
	enum spec_status status = SPEC_OK;
	double outgoing[3];
	int lowest, highest;
	char line[160];

	spec_grating_orders(incident, wavelength_nm, disc->track_nm, &lowest, &highest);
	for (int order = lowest; order <= highest && status == SPEC_OK; order++) {
		double sine;

		if (!spec_grating_direction(
			    incident, order, wavelength_nm, disc->track_nm, outgoing))
			continue;
		sine = hypot(outgoing[0], outgoing[1]);
		/* What rounding leaves of 0, or -0, would have an azimuth, too. */
		snprintf(line, sizeof line, "%d %.10g %.10g %.10g %.10g\n", order,
			wavelength_nm, atan2(sine, outgoing[2]) / RADIANS_PER_DEGREE,
			atan2(cleaned(outgoing[0]), cleaned(outgoing[1])) /
				RADIANS_PER_DEGREE,
			spec_grating_lamellar(
				disc->pit_width_nm / disc->track_nm, phase, order));
		status = add_line(table, line, error);
	}
	return status;
}

enum spec_status
spec_orders_text(const struct spec_disc *disc, double angle_deg, double azimuth_deg,
	const double *wavelength_nm, size_t count, char **text, size_t *size,
	struct spec_error *error)
{
	double angle = angle_deg * RADIANS_PER_DEGREE;
	double azimuth = azimuth_deg * RADIANS_PER_DEGREE;
	double incident[3] = {
		sin(angle) * sin(azimuth), sin(angle) * cos(azimuth), cos(angle)};
	struct table table = {0};
	enum spec_status status =
		add_line(&table, "# order nm angle azimuth efficiency\n", error);

	for (size_t i = 0; i < count && status == SPEC_OK; i++)
		status = add_orders(&table, disc, incident, wavelength_nm[i], error);
	if (status != SPEC_OK) {
		free(table.text);
		table = (struct table){0};
	}
	*text = table.text;
	*size = table.length;
	return status;
}
