#include "image/filmchart.h"

#include <math.h>
#include <string.h>

#define RADIANS_PER_DEGREE (3.14159265358979323846 / 180)

static const char *const shares[] = {"reflectance", "transmittance", "absorptance"};

enum spec_status
spec_film_share_parse(
	const char *text, enum spec_film_share *share, struct spec_error *error)
{
	for (int i = 0; i < 3; i++) {
		if (strcmp(text, shares[i]) == 0) {
			*share = (enum spec_film_share)i;
			return SPEC_OK;
		}
	}
	return spec_error_set(error, SPEC_EUSAGE,
		"'%s' is not reflectance, transmittance or absorptance", text);
}

const char *
spec_film_share_name(enum spec_film_share share)
{
	return shares[share];
}

double
spec_film_cosine(double angle_deg)
{
	return angle_deg < 90 ? cos(angle_deg * RADIANS_PER_DEGREE) : 0;
}

void
spec_film_chart_variables(struct spec_chart *chart, double thickness_nm, double angle_deg)
{
	chart->variables = SPEC_FILM_VARIABLES;
	chart->variable[SPEC_FILM_THICKNESS] = (struct spec_chart_variable){
		"thickness", SPEC_CHART_NM, 0, SPEC_RECIPE_THICKEST_NM, thickness_nm};
	chart->variable[SPEC_FILM_ANGLE] =
		(struct spec_chart_variable){"angle", SPEC_CHART_DEGREES, 0, 90, angle_deg};
}

static double
share_of(enum spec_film_share share, double reflectance, double transmittance)
{
	if (share == SPEC_FILM_REFLECTANCE)
		return reflectance;
	if (share == SPEC_FILM_TRANSMITTANCE)
		return transmittance;
	return spec_coating_absorptance(reflectance, transmittance);
}

void
spec_film_chart_evaluate(
	const void *state, const double *const *at, size_t count, double *value)
{
	const struct spec_film_chart *chart = state;
	const struct spec_stack *stack = &chart->coating->front;
	double cosine[SPEC_CHART_RUN], transmittance[SPEC_CHART_RUN];

	for (size_t i = 0; i < count; i++)
		cosine[i] = spec_film_cosine(at[SPEC_FILM_ANGLE][i]);
	for (size_t band = 0; band < stack->wavelengths; band++) {
		double *reflectance = value + band * SPEC_CHART_RUN;

		spec_stack_row(stack, band, cosine, at[SPEC_FILM_THICKNESS], count,
			chart->polarisation, reflectance, transmittance);
		for (size_t i = 0; i < count; i++)
			reflectance[i] =
				share_of(chart->share, reflectance[i], transmittance[i]);
	}
}
