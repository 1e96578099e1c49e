/* Points, directions and frames in space. */
#ifndef SPEC_RENDER_SPACE_H
#define SPEC_RENDER_SPACE_H

#include <math.h>

struct spec_vector {
	double x, y, z;
};

static inline struct spec_vector
spec_vector_of(const double v[3])
{
	return (struct spec_vector){v[0], v[1], v[2]};
}

static inline struct spec_vector
spec_vector_add(struct spec_vector a, struct spec_vector b)
{
	return (struct spec_vector){a.x + b.x, a.y + b.y, a.z + b.z};
}

static inline struct spec_vector
spec_vector_subtract(struct spec_vector a, struct spec_vector b)
{
	return (struct spec_vector){a.x - b.x, a.y - b.y, a.z - b.z};
}

static inline struct spec_vector
spec_vector_scale(struct spec_vector a, double factor)
{
	return (struct spec_vector){a.x * factor, a.y * factor, a.z * factor};
}

static inline struct spec_vector
spec_vector_negate(struct spec_vector a)
{
	return (struct spec_vector){-a.x, -a.y, -a.z};
}

/* a + factor b */
static inline struct spec_vector
spec_vector_along(struct spec_vector a, struct spec_vector b, double factor)
{
	return spec_vector_add(a, spec_vector_scale(b, factor));
}

static inline double
spec_vector_dot(struct spec_vector a, struct spec_vector b)
{
	return a.x * b.x + a.y * b.y + a.z * b.z;
}

static inline struct spec_vector
spec_vector_cross(struct spec_vector a, struct spec_vector b)
{
	return (struct spec_vector){
		a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
}

/* The sum of the magnitudes: what the numbers are in size that a point is computed from. */
static inline double
spec_vector_size(struct spec_vector a)
{
	return fabs(a.x) + fabs(a.y) + fabs(a.z);
}

static inline double
spec_vector_length(struct spec_vector a)
{
	return sqrt(spec_vector_dot(a, a));
}

/* Of length 1; a null vector stays one. */
static inline struct spec_vector
spec_vector_unit(struct spec_vector a)
{
	double length = spec_vector_length(a);

	return length > 0 ? spec_vector_scale(a, 1 / length) : a;
}

/* The mirror direction of a direction about a unit normal, both pointing away. */
static inline struct spec_vector
spec_vector_mirror(struct spec_vector a, struct spec_vector normal)
{
	return spec_vector_along(
		spec_vector_negate(a), normal, 2 * spec_vector_dot(a, normal));
}

/* Three unit vectors across each other; z is the given one. */
struct spec_frame {
	struct spec_vector x, y, z;
};

/*
 * Duff et al., Building an Orthonormal Basis, Revisited, JCGT 6(1), 2017, listing 3.
 * z: a unit vector.
 */
static inline struct spec_frame
spec_frame_about(struct spec_vector z)
{
	double sign = copysign(1, z.z), a = -1 / (sign + z.z), b = z.x * z.y * a;

	return (struct spec_frame){{1 + sign * z.x * z.x * a, sign * b, -sign * z.x},
		{b, sign + z.y * z.y * a, -z.y}, z};
}

static inline struct spec_vector
spec_frame_to_world(const struct spec_frame *frame, struct spec_vector local)
{
	return spec_vector_along(
		spec_vector_along(spec_vector_scale(frame->x, local.x), frame->y, local.y),
		frame->z, local.z);
}

static inline struct spec_vector
spec_frame_to_local(const struct spec_frame *frame, struct spec_vector world)
{
	return (struct spec_vector){spec_vector_dot(world, frame->x),
		spec_vector_dot(world, frame->y), spec_vector_dot(world, frame->z)};
}

#endif
