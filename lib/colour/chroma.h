/*
 * Losing chroma, of the perceptual gamut map: towards the grey of the same OKLab lightness,
 * at constant hue, until no component is below 0 or above 1.
 */
#ifndef SPEC_COLOUR_CHROMA_H
#define SPEC_COLOUR_CHROMA_H

#include <stddef.h>

/*
 * In place: count pixels of three planes, of which those outside and finite are changed.
 * to_cones: from the components to cones' responses, white's are 1; from_cones: its inverse.
 * Components are at most 2e-9 off the edge of the gamut that they are brought to.
 */
void spec_chroma_row(const double to_cones[9], const double from_cones[9],
	float *const plane[3], size_t count);

#endif
