#include "render/facets.h"

#include <float.h>
#include <stdlib.h>

#include "base/memory.h"
#include "render/through.h"

/* The box around a mesh in its own space. */
static void
find_box(struct spec_facets *facets, const struct spec_scene_shape *shape)
{
	double low[3] = {DBL_MAX, DBL_MAX, DBL_MAX},
	       high[3] = {-DBL_MAX, -DBL_MAX, -DBL_MAX};

	for (size_t i = 0; i < 3 * shape->vertices; i++) {
		low[i % 3] = fmin(low[i % 3], shape->point[i]);
		high[i % 3] = fmax(high[i % 3], shape->point[i]);
	}
	facets->low = (struct spec_vector){low[0], low[1], low[2]};
	facets->size =
		(struct spec_vector){high[0] - low[0], high[1] - low[1], high[2] - low[2]};
}

/* pbrt: the vertices' normals, where there are some, say which side is outward. */
static int
is_inward(const struct spec_scene_shape *shape, const uint32_t *index,
	struct spec_vector normal)
{
	double sum = 0;

	for (size_t j = 0; j < 3 && shape->normal; j++)
		sum += spec_vector_dot(normal, spec_facets_vertex(shape->normal, index[j]));
	return sum < 0;
}

enum spec_status
spec_facets_make(struct spec_facets *facets, const struct spec_scene_shape *shape,
	struct spec_error *error)
{
	facets->corner = spec_memory_new(
		shape->triangles, 3 * sizeof *facets->corner, "triangles", error);
	facets->normal = spec_memory_new(
		shape->triangles, sizeof *facets->normal, "triangles", error);
	if (!facets->corner || !facets->normal)
		return SPEC_ENOMEM;
	find_box(facets, shape);
	for (size_t i = 0; i < shape->triangles; i++) {
		struct spec_vector *corner = facets->corner + 3 * i, local[3], normal;

		for (size_t j = 0; j < 3; j++) {
			local[j] =
				spec_facets_vertex(shape->point, shape->index[3 * i + j]);
			corner[j] = spec_through_point(shape->world.m, local[j]);
		}
		/* In object space: a space that is mirrored keeps its outside. */
		normal = spec_vector_cross(spec_vector_subtract(local[1], local[0]),
			spec_vector_subtract(local[2], local[0]));
		if (is_inward(shape, shape->index + 3 * i, normal))
			normal = spec_vector_negate(normal);
		facets->normal[i] = spec_through_normal(&shape->world, normal);
	}
	return SPEC_OK;
}

void
spec_facets_free(struct spec_facets *facets)
{
	free(facets->corner);
	free(facets->normal);
	*facets = (struct spec_facets){0};
}
