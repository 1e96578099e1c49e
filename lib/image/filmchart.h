/* Charts of a film: what it reflects over its thickness and the angle of incidence. */
#ifndef SPEC_IMAGE_FILMCHART_H
#define SPEC_IMAGE_FILMCHART_H

#include "base/error.h"
#include "image/chart.h"
#include "optics/coating.h"

enum spec_film_share {
	SPEC_FILM_REFLECTANCE,
	SPEC_FILM_TRANSMITTANCE, /* of power, into the substrate */
	SPEC_FILM_ABSORPTANCE    /* in the layers */
};

/* "reflectance", "transmittance" or "absorptance". Error (SPEC_EUSAGE): another text. */
enum spec_status spec_film_share_parse(
	const char *text, enum spec_film_share *share, struct spec_error *error);
const char *spec_film_share_name(enum spec_film_share share);

/* The cosine of an angle of incidence, 0 to 90 degrees; 0 at 90. */
double spec_film_cosine(double angle_deg);

/* The state of spec_film_chart_evaluate. */
struct spec_film_chart {
	const struct spec_coating *coating; /* at the chart's grid */
	enum spec_polarisation polarisation;
	enum spec_film_share share;
};

/* The variables of such a chart: 0 thickness [nm], of the varied layer; 1 angle [degrees]. */
enum { SPEC_FILM_THICKNESS, SPEC_FILM_ANGLE, SPEC_FILM_VARIABLES };
void spec_film_chart_variables(
	struct spec_chart *chart, double thickness_nm, double angle_deg);

/* A chart's evaluate function; state is a struct spec_film_chart. */
void spec_film_chart_evaluate(
	const void *state, const double *const *at, size_t count, double *value);

#endif
