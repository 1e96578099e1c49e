/* How thick a film is over a surface. */
#ifndef SPEC_OPTICS_THICKNESS_H
#define SPEC_OPTICS_THICKNESS_H

#include <stddef.h>

#include "base/error.h"

enum spec_thickness_kind {
	SPEC_THICKNESS_CONSTANT,
	SPEC_THICKNESS_GRAVITY /* thin above, thick below */
};

struct spec_thickness {
	enum spec_thickness_kind kind;
	double top_nm, bottom_nm; /* of a constant: both the same */
	int up;                   /* the object's axis that looks upwards: 0 x, 1 y, 2 z */
	int downwards;            /* the axis looks downwards instead */
};

/*
 * "500nm", or "gravity 530nm..730nm", at the top and at the bottom, and perhaps the object's
 * axis that looks upwards: x, y, z (the default), -x, -y or -z. Lengths as
 * spec_number_parse_thickness has them, up to SPEC_RECIPE_THICKEST_NM; those of gravity are
 * not 0. Errors: SPEC_EUSAGE and SPEC_ERANGE, with a caret.
 */
enum spec_status spec_thickness_parse(
	const char *text, struct spec_thickness *thickness, struct spec_error *error);

/*
 * The thickness [nm] of count pixels; height: object coordinates along the axis, 0 to 1 in
 * the object's bounding box, or null for a constant. Gravity is d = top * (bottom / top)^a
 * with a from 0 at the top to 1 at the bottom (T 6.13, after Jaszkowski & Rzeszut 2003).
 */
void spec_thickness_row(const struct spec_thickness *thickness, const float *height,
	size_t count, double *thickness_nm);

#endif
