#include "image/discchart.h"

#include <math.h>

void
spec_disc_chart_variables(
	struct spec_chart *chart, double eye_deg, double lamp_deg, double azimuth_deg)
{
	chart->variables = SPEC_DISC_VARIABLES;
	chart->variable[SPEC_DISC_EYE] =
		(struct spec_chart_variable){"eye", SPEC_CHART_DEGREES, -90, 90, eye_deg};
	chart->variable[SPEC_DISC_LAMP] =
		(struct spec_chart_variable){"lamp", SPEC_CHART_DEGREES, -90, 90, lamp_deg};
	chart->variable[SPEC_DISC_AZIMUTH] = (struct spec_chart_variable){
		"azimuth", SPEC_CHART_DEGREES, -180, 180, azimuth_deg};
}

void
spec_disc_chart_evaluate(
	const void *state, const double *const *at, size_t count, double *value)
{
	const struct spec_disc_chart *chart = state;
	double along[SPEC_CHART_RUN], across[SPEC_CHART_RUN], half_cosine[SPEC_CHART_RUN];
	struct spec_disc_pixels pixels = {.count = count,
		.along = along,
		.across = across,
		.half_cosine = half_cosine};

	for (size_t i = 0; i < count; i++) {
		double eye = at[SPEC_DISC_EYE][i] * M_PI / 180;
		double lamp = at[SPEC_DISC_LAMP][i] * M_PI / 180;
		double azimuth = at[SPEC_DISC_AZIMUTH][i] * M_PI / 180;
		double sines = sin(eye) + sin(lamp);

		along[i] = sines * sin(azimuth);
		across[i] = sines * cos(azimuth);
		half_cosine[i] = fabs(cos((eye + lamp) / 2)); /* of the bisector */
	}
	chart->model(chart->disc, &chart->bands, &pixels, value, SPEC_CHART_RUN);
	for (size_t band = 0; band < chart->bands.count; band++) {
		for (size_t i = 0; i < count; i++)
			value[band * SPEC_CHART_RUN + i] *= M_PI;
	}
}
