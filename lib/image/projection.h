/*
 * How pictures of all that is around a point are laid out: which direction a place in them
 * shows, and which pixels lie around a direction.
 *
 * Directions are those of specrender(1)'s lights: z is up, and who looks along x has y on the
 * right. Places are counted in pixels, from the left and from above, pixels' middles at halves.
 */
#ifndef SPEC_IMAGE_PROJECTION_H
#define SPEC_IMAGE_PROJECTION_H

#include <stddef.h>

#include "base/error.h"

enum spec_projection {
	/* Columns from +x by +y around +z, rows from +z down by equal angles: twice as wide as
	   high. */
	SPEC_PROJECTION_LATLONG,
	/*
	 * The faces of a cube as they are seen from its middle: of 4 by 3 the second column has
	 * +z, +x and -z, the middle row -y, +x, +y and -x.
	 */
	SPEC_PROJECTION_CROSS,
	/* Of 3 by 4 the middle column has +z, +x, -z and -x, this upside down, the second row -y,
	   +x and +y. */
	SPEC_PROJECTION_TALL_CROSS,
	/*
	 * A square of equal areas, +z in its middle and -z in its corners.
	 * Source: P. Clarberg: Fast Equal-Area Mapping of the (Hemi)Sphere using SIMD,
	 *         J. Graphics Tools 13(3), 2008; M. Pharr, W. Jakob, G. Humphreys:
	 *         Physically Based Rendering, 4th edition 2023, section 3.8.3, whose
	 *         directions these are.
	 */
	SPEC_PROJECTION_OCTAHEDRAL
};

/* A layout of so many pixels. */
struct spec_panorama {
	enum spec_projection projection;
	size_t width, height;
};

/*
 * "latlong", "cross", "tall-cross" or "octahedral", or one of these with ":" and its height in
 * pixels, else *height is 0. Errors (SPEC_EUSAGE): another name; a height that is no
 * multiple of the rows of faces, or none.
 */
enum spec_status spec_projection_parse(const char *text, enum spec_projection *projection,
	size_t *height, struct spec_error *error);

/*
 * The layout of a picture by its shape: 2:1 latlong, 4:3 cross, 3:4 tall-cross, 1:1 octahedral.
 * Error (SPEC_EUNSUPPORTED): another one; the message says what was expected.
 */
enum spec_status spec_panorama_of(size_t width, size_t height,
	struct spec_panorama *panorama, struct spec_error *error);

/* The layout of that height; height 0: with pixels about as far apart as in another one. */
struct spec_panorama spec_panorama_like(
	const struct spec_panorama *other, enum spec_projection projection, size_t height);

/* The unit vector that a place shows; 0: none, it is beside the faces of a cross. */
int spec_panorama_direction(
	const struct spec_panorama *panorama, double x, double y, double direction[3]);

/* Pixels and their parts, which add up to 1. */
struct spec_panorama_blend {
	size_t pixel[4]; /* y * width + x */
	double part[4];
};

/*
 * The pixels around a direction, for values that are linear between their middles: across
 * poles, edges and corners, too.
 */
struct spec_panorama_blend spec_panorama_around(
	const struct spec_panorama *panorama, const double direction[3]);

#endif
