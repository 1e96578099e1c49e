/* What unit tests of shapes and rays share. */
#ifndef TESTS_UNIT_SHAPES_H
#define TESTS_UNIT_SHAPES_H

#include <stdlib.h>

#include "render/space.h"
#include "render/world.h"
#include "scene/transform.h"

#include "check.h"

/* Scaled, then turned, then moved. */
struct place {
	double scale[3], turn_deg, axis[3], move[3];
};

static inline struct spec_transform
transform_of(const struct place *place)
{
	struct spec_transform t = spec_transform_identity();
	struct spec_error error;

	check(spec_transform_translate(&t, place->move, &error), &error);
	check(spec_transform_rotate(&t, place->turn_deg, place->axis, &error), &error);
	check(spec_transform_scale(&t, place->scale, &error), &error);
	return t;
}

static inline struct spec_ray
ray_to(struct spec_vector from, struct spec_vector to)
{
	return (struct spec_ray){from, spec_vector_unit(spec_vector_subtract(to, from))};
}

/* A list that a scene owns and frees. */
static inline void *
copy_of(const void *list, size_t size)
{
	void *copy = malloc(size);

	assert_non_null(copy);
	return memcpy(copy, list, size);
}

#endif
