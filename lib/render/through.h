/* Points, directions and normals through a scene's transforms. */
#ifndef SPEC_RENDER_THROUGH_H
#define SPEC_RENDER_THROUGH_H

#include "render/space.h"
#include "scene/scene.h"

static inline struct spec_vector
spec_through_direction(const double m[4][4], struct spec_vector v)
{
	return (struct spec_vector){m[0][0] * v.x + m[0][1] * v.y + m[0][2] * v.z,
		m[1][0] * v.x + m[1][1] * v.y + m[1][2] * v.z,
		m[2][0] * v.x + m[2][1] * v.y + m[2][2] * v.z};
}

static inline struct spec_vector
spec_through_point(const double m[4][4], struct spec_vector p)
{
	return (struct spec_vector){m[0][0] * p.x + m[0][1] * p.y + m[0][2] * p.z + m[0][3],
		m[1][0] * p.x + m[1][1] * p.y + m[1][2] * p.z + m[1][3],
		m[2][0] * p.x + m[2][1] * p.y + m[2][2] * p.z + m[2][3]};
}

/* A normal goes by the transpose of the inverse; of length 1. */
static inline struct spec_vector
spec_through_normal(const struct spec_transform *transform, struct spec_vector n)
{
	const double(*m)[4] = transform->inverse;

	return spec_vector_unit(
		(struct spec_vector){m[0][0] * n.x + m[1][0] * n.y + m[2][0] * n.z,
			m[0][1] * n.x + m[1][1] * n.y + m[2][1] * n.z,
			m[0][2] * n.x + m[1][2] * n.y + m[2][2] * n.z});
}

#endif
