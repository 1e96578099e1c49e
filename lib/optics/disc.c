#include "optics/disc.h"

#include <math.h>
#include <string.h>

#include "base/vector.h"

#define PARALLEL 1e-12 /* squared sine of an angle that float vectors cannot tell from 0 */

/*
 * T, section 7.2, has the CD's dimensions, 7.5 the DVD's distances; ECMA-130 (1996) and
 * ECMA-267 (2001) agree with them in the tracks. The index is polycarbonate's (1.585 at 589
 * nm), within the 1.55 +- 0.10 of both standards. No standard fixes width and depth, since
 * players need only the signal that they give: T's pits are a quarter of a CD player's 780 nm
 * deep in that (123 nm), so the others are taken as a quarter of 650 nm (103 nm) and of 405 nm
 * (64 nm). 320 nm and 130 nm are nominal widths in the trade's literature.
 *
 * Blu-ray: track pitch 320 nm, channel bit 74.5 nm (Blu-ray Disc Association, white paper on
 * the format, 2010; a layer of 25 GB). The code (1,7)PP has runs of 2 to 8 bits; were they as
 * random as can be, a run of i bits had probability x^-i with x = 1.6013, and a mean length of
 * 3.39 bits: a pit and a land after it take 2 * 3.39 * 74.5 nm = 506 nm.
 *
 * Record: 100 um is a usual distance of grooves, which carry no pits. T has no constants for
 * it. c2 alone leaves the anisotropic part of T 7.9, without any wavelength; with T's c5 and
 * beta, c0 makes it send back about 0.044 of a lamp's light from above, as a plane of PVC with
 * index 1.54 does (0.045).
 *
 * T has table 7.1 for the CD, and names no other constants for its DVD in figure
 * 7.9. An order's width is 0.5 degrees: the sun's or a lamp's at arm's length, and a
 * disc that is not quite flat.
 */
#define COMPOSITE_OF_T                                                                     \
	.groove_scale = .005, .strip_height = 1, .strip_floor = .01,                       \
	.main_scale_nm = 1000, .main_floor_nm = 0, .groove_decay = 10,                     \
	.groove_exponent = 2, .side_width_rad = 3.14, .main_width_rad = .4,                \
	.specular = 50, .specular_exponent = 10000, .diffuse = .001

static const struct spec_disc discs[] = {
	{.name = "cd",
		.track_nm = 1600,
		.pit_nm = 2400,
		.pit_width_nm = 600,
		.pit_depth_nm = 125,
		.index = 1.58,
		.lobe_width = M_PI / 360,
		COMPOSITE_OF_T},
	{.name = "dvd",
		.track_nm = 740,
		.pit_nm = 1400,
		.pit_width_nm = 320,
		.pit_depth_nm = 103,
		.index = 1.58,
		.lobe_width = M_PI / 360,
		COMPOSITE_OF_T},
	{.name = "bluray",
		.track_nm = 320,
		.pit_nm = 506,
		.pit_width_nm = 130,
		.pit_depth_nm = 64,
		.index = 1.58,
		.lobe_width = M_PI / 360,
		COMPOSITE_OF_T},
	{.name = "vinyl",
		.track_nm = 100000,
		.index = 1.54,
		.lobe_width = M_PI / 360,
		.groove_scale = .04,
		.strip_floor = 1,
		.groove_decay = 10,
		.groove_exponent = 2,
		.side_width_rad = 3.14,
		.main_width_rad = .4},
};

const struct spec_disc *
spec_disc_find(const char *name, struct spec_error *error)
{
	for (size_t i = 0; i < sizeof discs / sizeof *discs; i++) {
		if (strcmp(discs[i].name, name) == 0)
			return &discs[i];
	}
	spec_error_set(error, SPEC_EUSAGE,
		"no disc is named '%s'; there are cd, dvd, bluray and vinyl", name);
	return NULL;
}

struct vector {
	double x, y, z;
};

static inline double
dot(struct vector a, struct vector b)
{
	return a.x * b.x + a.y * b.y + a.z * b.z;
}

static inline struct vector
scaled(struct vector a, double factor)
{
	return (struct vector){a.x * factor, a.y * factor, a.z * factor};
}

static inline struct vector
sum_of(struct vector a, struct vector b)
{
	return (struct vector){a.x + b.x, a.y + b.y, a.z + b.z};
}

static inline struct vector
cross(struct vector a, struct vector b)
{
	return (struct vector){
		a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
}

/* The unit vector; *known stays 1 if there is one. No squared float overflows a double. */
static inline struct vector
unit_of(const float *const plane[3], size_t i, int *known)
{
	struct vector a = {plane[0][i], plane[1][i], plane[2][i]};
	double square = dot(a, a);

	*known &= (square > 0) & (square < INFINITY);
	return scaled(a, 1 / sqrt(square));
}

SPEC_VECTORISED static void
geometry(const struct spec_disc_directions *directions, size_t count,
	double *restrict along, double *restrict across, double *restrict half_cosine,
	double *restrict lamp_cosine, double *restrict eye_cosine)
{
	const struct spec_disc_directions from = *directions;

	for (size_t i = 0; i < count; i++) {
		int known = 1;
		struct vector lamp = unit_of(from.lamp, i, &known);
		struct vector eye = unit_of(from.eye, i, &known);
		struct vector normal = unit_of(from.normal, i, &known);
		struct vector t = unit_of(from.tangent, i, &known);
		struct vector sum = sum_of(lamp, eye);
		struct vector x = sum_of(t, scaled(normal, -dot(t, normal)));
		double flat = dot(x, x), size = dot(sum, sum), scale = 1 / sqrt(flat);

		known &= flat > PARALLEL;
		along[i] = known ? dot(sum, x) * scale : 0;
		across[i] = known ? dot(sum, cross(normal, x)) * scale : 0;
		half_cosine[i] =
			(known & (size > 0)) ? dot(sum, normal) * (1 / sqrt(size)) : 0;
		lamp_cosine[i] = known ? dot(lamp, normal) : 0;
		eye_cosine[i] = known ? dot(eye, normal) : 0;
	}
}

void
spec_disc_geometry(
	const struct spec_disc_directions *directions, struct spec_disc_pixels *pixels)
{
	geometry(directions, pixels->count, pixels->along, pixels->across,
		pixels->half_cosine, pixels->lamp_cosine, pixels->eye_cosine);
}
