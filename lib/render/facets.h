/* The triangles of a mesh in world space, and which side of each is outward. */
#ifndef SPEC_RENDER_FACETS_H
#define SPEC_RENDER_FACETS_H

#include "base/error.h"
#include "render/space.h"
#include "scene/scene.h"

struct spec_facets {
	struct spec_vector *corner;   /* [3 * triangles] */
	struct spec_vector *normal;   /* [triangles] geometric, outward, unit */
	struct spec_vector low, size; /* of the box around the mesh in its own space */
};

/*
 * Outward is the winding's side in object space, so that a space which turns left hands to
 * right ones keeps it; or, where the vertices have normals, theirs. The shape's own
 * reverse_orientation is not applied. SPEC_ENOMEM; then facets hold what there was room for.
 */
enum spec_status spec_facets_make(struct spec_facets *facets,
	const struct spec_scene_shape *shape, struct spec_error *error);
void spec_facets_free(struct spec_facets *facets);

/* Entry i of a mesh's list of points or normals. */
static inline struct spec_vector
spec_facets_vertex(const float *list, size_t i)
{
	return (struct spec_vector){list[3 * i], list[3 * i + 1], list[3 * i + 2]};
}

#endif
