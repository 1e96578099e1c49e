/* Pictures of where two images differ. */
#ifndef SPEC_COMPARE_HEATMAP_H
#define SPEC_COMPARE_HEATMAP_H

#include "base/error.h"
#include "compare/images.h"

struct spec_heatmap {
	enum spec_detail_pixel map; /* that the result has */
	double most;                /* the value of the last colour; 0: the map's largest */
	double white_xyz[3];        /* of what was seen, for side by side */
};

/*
 * Writes a map in viridis' colours, dark where the images are alike, with a legend below:
 * the colours with the numbers at their ends and half-way, and the map's name and unit. What
 * is infinite is magenta, what lies outside the mask grey. Of goodness of fit the scale is
 * 1 - value. The suffix of path says the format; errors: spec_picture_choose's, those of
 * writing.
 */
enum spec_status spec_heatmap_write(const char *path, const struct spec_images *result,
	const struct spec_heatmap *heatmap, struct spec_error *error);

/*
 * The first image, the second, and the map side by side, with the legend. The result has
 * seen. Colours are adapted from white_xyz to sRGB's white (Bradford) and clipped.
 */
enum spec_status spec_heatmap_side_by_side(const char *path,
	const struct spec_images *result, const struct spec_heatmap *heatmap,
	struct spec_error *error);

#endif
