/*
 * Other coordinates of X, Y and Z, pixel by pixel in planes.
 *
 *   L*a*b*  L* = 116 f(Y/Yn) - 16, a* = 500 (f(X/Xn) - f(Y/Yn)),
 *           b* = 200 (f(Y/Yn) - f(Z/Zn)), with f(t) = t^(1/3) above (6/29)^3 and
 *           (841/108) t + 4/29 below. Source: CIE 015:2018, section 8.2.1.
 *   xyY     x = X / (X + Y + Z), y = Y / (X + Y + Z), then Y; of black, where the sum is 0,
 *           x and y are those of white. Source: CIE 015:2018, section 7.3.
 */
#ifndef SPEC_COLOUR_COORDINATES_H
#define SPEC_COLOUR_COORDINATES_H

#include <stddef.h>

#include "colour/space.h"

/*
 * In place: count pixels of three planes hold X, Y and Z, and then the coordinates in the
 * order of their names. white: its XYZ, each positive. RGB and XYZ stay as they are.
 */
void spec_coordinates_row(enum spec_coordinates coordinates, const double white[3],
	float *const plane[3], size_t count);

#endif
