#include "colour/coordinates.h"

#include "base/vector.h"
#include "colour/difference.h"

#define BLOCK 256 /* pixels at a time */

SPEC_VECTORISED static void
widen(const float *restrict from, size_t count, double *restrict to)
{
	for (size_t i = 0; i < count; i++)
		to[i] = (double)from[i];
}

SPEC_VECTORISED static void
narrow(const double *restrict from, size_t count, float *restrict to)
{
	for (size_t i = 0; i < count; i++)
		to[i] = (float)from[i];
}

static void
to_lab(const double white[3], float *const plane[3], size_t count)
{
	double room[3][BLOCK], *const value[3] = {room[0], room[1], room[2]};

	for (size_t x = 0, n; x < count; x += n) {
		n = count - x < BLOCK ? count - x : BLOCK;
		for (int c = 0; c < 3; c++)
			widen(plane[c] + x, n, value[c]);
		spec_lab_row(white, value, n);
		for (int c = 0; c < 3; c++)
			narrow(value[c], n, plane[c] + x);
	}
}

SPEC_VECTORISED static void
to_xyy(const double white[3], float *restrict x, float *restrict y, float *restrict z,
	size_t count)
{
	double all = white[0] + white[1] + white[2];
	double white_x = white[0] / all, white_y = white[1] / all;

	for (size_t i = 0; i < count; i++) {
		double luminance = y[i], first = x[i], sum = first + luminance + z[i];
		double share_x = first / sum, share_y = luminance / sum;

		x[i] = (float)(sum == 0 ? white_x : share_x);
		y[i] = (float)(sum == 0 ? white_y : share_y);
		z[i] = (float)luminance;
	}
}

void
spec_coordinates_row(enum spec_coordinates coordinates, const double white[3],
	float *const plane[3], size_t count)
{
	if (coordinates == SPEC_COORDINATES_LAB)
		to_lab(white, plane, count);
	else if (coordinates == SPEC_COORDINATES_XYY)
		to_xyy(white, plane[0], plane[1], plane[2], count);
}
