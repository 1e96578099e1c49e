/* Charts of a disc: what it sends back over the angles of eye and lamp. */
#ifndef SPEC_IMAGE_DISCCHART_H
#define SPEC_IMAGE_DISCCHART_H

#include "image/chart.h"
#include "image/diffract.h"

/* The state of spec_disc_chart_evaluate. */
struct spec_disc_chart {
	const struct spec_disc *disc;
	spec_disc_model *model;
	struct spec_disc_bands bands; /* the chart's grid */
};

/*
 * The variables of such a chart [degrees]: 0 eye, from the normal to the eye; 1 lamp, from
 * the normal to the lamp, both to one side; 2 azimuth of the plane that both lie in, 0 across
 * the tracks, 90 along them.
 */
enum { SPEC_DISC_EYE, SPEC_DISC_LAMP, SPEC_DISC_AZIMUTH, SPEC_DISC_VARIABLES };
void spec_disc_chart_variables(
	struct spec_chart *chart, double eye_deg, double lamp_deg, double azimuth_deg);

/*
 * A chart's evaluate function; state is a struct spec_disc_chart. The values are reflectance
 * factors: pi f_r, the light sent to the eye over what a white matt surface would send.
 */
void spec_disc_chart_evaluate(
	const void *state, const double *const *at, size_t count, double *value);

#endif
