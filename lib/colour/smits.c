#include "colour/smits.h"

#include <math.h>

void
spec_smits_weights(const double rgb[3], double weight[SPEC_SMITS_COLUMNS])
{
	double white = fmin(rgb[0], fmin(rgb[1], rgb[2]));
	double r = rgb[0] - white, g = rgb[1] - white, b = rgb[2] - white;
	/* One of the three is 0 now, so that at most one of these minima is not. */
	double cyan = fmin(g, b), magenta = fmin(r, b), yellow = fmin(r, g);

	weight[SPEC_SMITS_WHITE] = white;
	weight[SPEC_SMITS_CYAN] = cyan;
	weight[SPEC_SMITS_MAGENTA] = magenta;
	weight[SPEC_SMITS_YELLOW] = yellow;
	weight[SPEC_SMITS_RED] = r - magenta - yellow;
	weight[SPEC_SMITS_GREEN] = g - cyan - yellow;
	weight[SPEC_SMITS_BLUE] = b - cyan - magenta;
}
