#include "colour/coordinates.h"

#include "colour/difference.h"

static void
to_xyy(const double white[3], double xyz[3])
{
	double sum = xyz[0] + xyz[1] + xyz[2], luminance = xyz[1];
	const double *of = sum == 0 ? white : xyz;

	if (sum == 0)
		sum = white[0] + white[1] + white[2];
	xyz[0] = of[0] / sum;
	xyz[1] = of[1] / sum;
	xyz[2] = luminance;
}

void
spec_coordinates_row(enum spec_coordinates coordinates, const double white[3],
	float *const plane[3], size_t count)
{
	if (coordinates != SPEC_COORDINATES_LAB && coordinates != SPEC_COORDINATES_XYY)
		return;
	for (size_t i = 0; i < count; i++) {
		double value[3] = {plane[0][i], plane[1][i], plane[2][i]};

		if (coordinates == SPEC_COORDINATES_LAB)
			spec_lab_from_xyz(value, white, value);
		else
			to_xyy(white, value);
		for (int c = 0; c < 3; c++)
			plane[c][i] = (float)value[c];
	}
}
