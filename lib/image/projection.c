#include "image/projection.h"

#include <math.h>
#include <string.h>

#include "base/number.h"
#include "base/triple.h"

#define MOST_HEIGHT 65536

/* Width to height, in faces where it has any. */
static const struct {
	const char *name;
	size_t wide, high;
} shapes[] = {
	[SPEC_PROJECTION_LATLONG] = {"latlong", 2, 1},
	[SPEC_PROJECTION_CROSS] = {"cross", 4, 3},
	[SPEC_PROJECTION_TALL_CROSS] = {"tall-cross", 3, 4},
	[SPEC_PROJECTION_OCTAHEDRAL] = {"octahedral", 1, 1},
};

enum { PROJECTIONS = sizeof shapes / sizeof *shapes };

enum spec_status
spec_projection_parse(const char *text, enum spec_projection *projection, size_t *height,
	struct spec_error *error)
{
	size_t length = strcspn(text, ":"), found = 0;
	long long pixels;
	enum spec_status status;

	while (found < PROJECTIONS && (strncmp(shapes[found].name, text, length) != 0 ||
					      shapes[found].name[length] != '\0'))
		found++;
	if (found == PROJECTIONS)
		return spec_error_set(error, SPEC_EUSAGE,
			"'%.100s' is not latlong, cross, tall-cross or octahedral, or one of these with a height, such as cross:768",
			text);
	*projection = (enum spec_projection)found;
	*height = 0;
	if (text[length] == '\0')
		return SPEC_OK;
	status = spec_number_parse_whole(
		text + length + 1, 1, MOST_HEIGHT, "the height", &pixels, error);
	if (status != SPEC_OK)
		return status;
	*height = (size_t)pixels;
	if (*height % shapes[found].high != 0)
		return spec_error_set(error, SPEC_EUSAGE,
			"a %s of %zu pixels' height has no whole faces: it must be a multiple of %zu",
			shapes[found].name, *height, shapes[found].high);
	return SPEC_OK;
}

enum spec_status
spec_panorama_of(size_t width, size_t height, struct spec_panorama *panorama,
	struct spec_error *error)
{
	for (size_t i = 0; i < PROJECTIONS; i++) {
		if (width % shapes[i].wide == 0 &&
			width / shapes[i].wide * shapes[i].high == height) {
			*panorama = (struct spec_panorama){
				(enum spec_projection)i, width, height};
			return SPEC_OK;
		}
	}
	return spec_error_set(error, SPEC_EUNSUPPORTED,
		"%zu x %zu pixels: what is all around has 2:1 (latlong), 4:3 (cross), 3:4 (tall-cross) or 1:1 (octahedral)",
		width, height);
}

/* Pixels along a quarter of the horizon, or as many as have the same area. */
static double
quarter(const struct spec_panorama *panorama)
{
	if (panorama->projection == SPEC_PROJECTION_OCTAHEDRAL)
		return (double)panorama->height * sqrt(M_PI) / 4;
	if (panorama->projection == SPEC_PROJECTION_LATLONG)
		return (double)panorama->width / 4;
	return (double)panorama->width / (double)shapes[panorama->projection].wide;
}

struct spec_panorama
spec_panorama_like(
	const struct spec_panorama *other, enum spec_projection projection, size_t height)
{
	double face = quarter(other);

	if (height == 0 && projection == SPEC_PROJECTION_OCTAHEDRAL)
		height = (size_t)ceil(face * 4 / sqrt(M_PI));
	else if (height == 0 && projection == SPEC_PROJECTION_LATLONG)
		height = (size_t)ceil(2 * face);
	else if (height == 0)
		height = (size_t)ceil(face) * shapes[projection].high;
	return (struct spec_panorama){projection,
		height / shapes[projection].high * shapes[projection].wide, height};
}

/* --- the cube --- */

/* A face: what lies ahead, to the right and above, and its cell in each cross. */
static const struct face {
	double ahead[3], right[3], up[3];
	size_t column[2], row[2]; /* of cross, of tall-cross */
} faces[] = {
	{{1, 0, 0}, {0, 1, 0}, {0, 0, 1}, {1, 1}, {1, 1}},
	{{0, 1, 0}, {-1, 0, 0}, {0, 0, 1}, {2, 2}, {1, 1}},
	{{-1, 0, 0}, {0, -1, 0}, {0, 0, 1}, {3, 1}, {1, 3}}, /* turned in tall-cross */
	{{0, -1, 0}, {1, 0, 0}, {0, 0, 1}, {0, 0}, {1, 1}},
	{{0, 0, 1}, {0, 1, 0}, {-1, 0, 0}, {1, 1}, {0, 0}},
	{{0, 0, -1}, {0, 1, 0}, {1, 0, 0}, {1, 1}, {2, 2}},
};

enum { FACES = sizeof faces / sizeof *faces, BACK = 2 };

/* A direction through a place on a face, both -1 to 1: a to the right, b up. */
static void
through_face(const struct face *face, double a, double b, double direction[3])
{
	for (int i = 0; i < 3; i++)
		direction[i] = face->ahead[i] + a * face->right[i] + b * face->up[i];
}

/* Of a place in a cell of a cross; what is upside down there is turned. */
static int
is_turned(const struct spec_panorama *panorama, size_t face)
{
	return panorama->projection == SPEC_PROJECTION_TALL_CROSS && face == BACK;
}

static int
cross_direction(
	const struct spec_panorama *panorama, double x, double y, double direction[3])
{
	int tall = panorama->projection == SPEC_PROJECTION_TALL_CROSS;
	double side = quarter(panorama), column = floor(x / side), row = floor(y / side);
	double a = 2 * (x / side - column) - 1, b = 1 - 2 * (y / side - row);

	for (size_t i = 0; i < FACES; i++) {
		if ((double)faces[i].column[tall] != column ||
			(double)faces[i].row[tall] != row)
			continue;
		if (is_turned(panorama, i))
			through_face(&faces[i], -a, -b, direction);
		else
			through_face(&faces[i], a, b, direction);
		spec_triple_normalise(direction);
		return 1;
	}
	return 0;
}

/* The face that a direction goes through, and where. */
static size_t
face_of(const double direction[3], double *a, double *b)
{
	size_t best = 0;
	double ahead;

	for (size_t i = 1; i < FACES; i++) {
		if (spec_triple_dot(direction, faces[i].ahead) >
			spec_triple_dot(direction, faces[best].ahead))
			best = i;
	}
	ahead = spec_triple_dot(direction, faces[best].ahead);
	*a = spec_triple_dot(direction, faces[best].right) / ahead;
	*b = spec_triple_dot(direction, faces[best].up) / ahead;
	return best;
}

/* The pixel of a face, i from its left and j from above, in its own directions. */
static size_t
face_pixel(const struct spec_panorama *panorama, size_t face, size_t i, size_t j)
{
	int tall = panorama->projection == SPEC_PROJECTION_TALL_CROSS;
	size_t side = (size_t)quarter(panorama);

	if (is_turned(panorama, face)) {
		i = side - 1 - i;
		j = side - 1 - j;
	}
	return (faces[face].row[tall] * side + j) * panorama->width +
	       faces[face].column[tall] * side + i;
}

static double
clamp(double value, double high)
{
	return fmin(fmax(value, 0), high);
}

/* A pixel of a face, both counted from its left and from above, kept on it. */
static size_t
kept_pixel(const struct spec_panorama *panorama, size_t face, double i, double j)
{
	double last = quarter(panorama) - 1;

	return face_pixel(panorama, face, (size_t)clamp(i, last), (size_t)clamp(j, last));
}

/* The pixel i, j of a face, or, where one of both is beyond an edge, that next to it there. */
static size_t
pixel_across(const struct spec_panorama *panorama, size_t face, double i, double j)
{
	double side = quarter(panorama), a, b, direction[3];
	double outside = 1 + .01 / side; /* just beyond */

	a = 2 * (i + .5) / side - 1;
	b = 1 - 2 * (j + .5) / side;
	a = fabs(a) > 1 ? copysign(outside, a) : a;
	b = fabs(b) > 1 ? copysign(outside, b) : b;
	through_face(&faces[face], a, b, direction);
	face = face_of(direction, &a, &b);
	return kept_pixel(
		panorama, face, floor((a + 1) / 2 * side), floor((1 - b) / 2 * side));
}

/* How far between a face's last middle and the first one beyond its edge, 0 on the face. */
static double
part_outside(double side, double place)
{
	return fmax(0, (fabs(place) - 1) * side / 2 + .5);
}

/* The volume that three directions span. */
static double
volume(const double a[3], const double b[3], const double c[3])
{
	return a[0] * (b[1] * c[2] - b[2] * c[1]) + a[1] * (b[2] * c[0] - b[0] * c[2]) +
	       a[2] * (b[0] * c[1] - b[1] * c[0]);
}

/*
 * Where three faces meet: their pixels there are a triangle, whose corners lie towards the
 * middle of each from d, the corner; of a direction the shares are those of its sum.
 */
static void
blend_corner(const struct spec_panorama *panorama, size_t face, double right, double up,
	const double direction[3], struct spec_panorama_blend *blend)
{
	double side = quarter(panorama), corner[3][3], a, b, sum = 0;
	size_t faces_here[3] = {face, 0, 0};

	through_face(&faces[face], right * (1 - 1 / side), up * (1 - 1 / side), corner[0]);
	/* Seen from the corner the three axes are alike: turn them. */
	for (int k = 1; k < 3; k++) {
		double sign[3];

		for (int i = 0; i < 3; i++) {
			sign[i] = corner[0][i] < 0 ? -1 : 1;
			corner[k][i] = sign[i] * fabs(corner[0][(i + k) % 3]);
		}
		faces_here[k] = face_of(corner[k], &a, &b);
	}
	for (int k = 0; k < 3; k++) {
		const double *one = corner[(k + 1) % 3], *two = corner[(k + 2) % 3];

		(void)face_of(corner[k], &a, &b);
		blend->pixel[k] = kept_pixel(panorama, faces_here[k],
			floor((a + 1) / 2 * side), floor((1 - b) / 2 * side));
		blend->part[k] =
			fmax(0, volume(direction, one, two) / volume(corner[k], one, two));
		sum += blend->part[k];
	}
	for (int k = 0; k < 3; k++)
		blend->part[k] /= sum;
	blend->pixel[3] = blend->pixel[0];
	blend->part[3] = 0;
}

/*
 * Beyond an edge the next face is seen aslant: the middles of its first pixels lie 1 + 1 / side
 * times as far from the edge's middle as those of this face's last
 * ones, and so do those between.
 */
static void
blend_cross(const struct spec_panorama *panorama, const double direction[3],
	struct spec_panorama_blend *blend)
{
	double side = quarter(panorama), a, b, x, y, right, down;
	size_t face = face_of(direction, &a, &b);
	double narrow_a = a / (1 + part_outside(side, b) / side);
	double narrow_b = b / (1 + part_outside(side, a) / side);

	if (part_outside(side, narrow_a) > 0 && part_outside(side, narrow_b) > 0) {
		blend_corner(
			panorama, face, copysign(1, a), copysign(1, b), direction, blend);
		return;
	}
	if (part_outside(side, narrow_b) > 0)
		a = narrow_a;
	else
		b = narrow_b;
	x = (a + 1) / 2 * side - .5;
	y = (1 - b) / 2 * side - .5;
	right = x - floor(x);
	down = y - floor(y);
	for (int k = 0; k < 4; k++) {
		blend->part[k] = (k % 2 ? right : 1 - right) * (k / 2 ? down : 1 - down);
		blend->pixel[k] =
			pixel_across(panorama, face, floor(x) + k % 2, floor(y) + (k > 1));
	}
}

/* --- the square --- */

/* To the square's middle at 0, 0 and its sides at 1; and back. */
static void
to_square(const double d[3], double *u, double *v)
{
	double r = sqrt(fmax(0, 1 - fabs(d[2])));
	double turn = atan2(fabs(d[1]), fabs(d[0])) * 2 / M_PI, across = turn * r;
	double along = r - across;

	if (d[2] < 0) {
		double swap = along;

		along = 1 - across;
		across = 1 - swap;
	}
	*u = copysign(along, d[0]);
	*v = copysign(across, d[1]);
}

static void
from_square(double u, double v, double d[3])
{
	double side = 1 - (fabs(u) + fabs(v)), r = 1 - fabs(side);
	double turn = (r == 0 ? 1 : (fabs(v) - fabs(u)) / r + 1) * M_PI / 4;
	double sine = r * sqrt(fmax(0, 2 - r * r));

	d[0] = copysign(cos(turn), u) * sine;
	d[1] = copysign(sin(turn), v) * sine;
	d[2] = copysign(1 - r * r, side);
}

/* A pixel beyond a side lies on that side, opposite. */
static size_t
square_pixel(long side, long i, long j)
{
	if (i < 0 || i >= side) {
		i = i < 0 ? -1 - i : 2 * side - 1 - i;
		j = side - 1 - j;
	}
	if (j < 0 || j >= side) {
		j = j < 0 ? -1 - j : 2 * side - 1 - j;
		i = side - 1 - i;
	}
	return (size_t)(j * side + i);
}

/* --- all of them --- */

int
spec_panorama_direction(
	const struct spec_panorama *panorama, double x, double y, double direction[3])
{
	double width = (double)panorama->width, height = (double)panorama->height;
	double polar = M_PI * y / height, azimuth = 2 * M_PI * x / width;

	switch (panorama->projection) {
	case SPEC_PROJECTION_LATLONG:
		direction[0] = sin(polar) * cos(azimuth);
		direction[1] = sin(polar) * sin(azimuth);
		direction[2] = cos(polar);
		return 1;
	case SPEC_PROJECTION_OCTAHEDRAL:
		from_square(2 * x / width - 1, 2 * y / height - 1, direction);
		return 1;
	default:
		return cross_direction(panorama, x, y, direction);
	}
}

/* A line above the upper pole is the first one, on its other side. */
static size_t
latlong_pixel(const struct spec_panorama *panorama, long i, long j)
{
	long width = (long)panorama->width, height = (long)panorama->height;

	if (j < 0 || j >= height) {
		j = j < 0 ? -1 - j : 2 * height - 1 - j;
		i += width / 2;
	}
	return (size_t)(j * width + (i + width) % width);
}

struct spec_panorama_blend
spec_panorama_around(const struct spec_panorama *panorama, const double direction[3])
{
	double width = (double)panorama->width, height = (double)panorama->height, x, y;
	struct spec_panorama_blend blend;
	int is_square = panorama->projection == SPEC_PROJECTION_OCTAHEDRAL;

	if (is_square) {
		to_square(direction, &x, &y);
		x = (x + 1) / 2 * width - .5;
		y = (y + 1) / 2 * height - .5;
	} else if (panorama->projection == SPEC_PROJECTION_LATLONG) {
		x = atan2(direction[1], direction[0]) / (2 * M_PI);
		x = (x < 0 ? x + 1 : x) * width - .5;
		y = acos(fmin(fmax(direction[2], -1), 1)) / M_PI * height - .5;
	} else {
		blend_cross(panorama, direction, &blend);
		return blend;
	}
	for (int k = 0; k < 4; k++) {
		double right = x - floor(x), down = y - floor(y);
		long i = (long)floor(x) + k % 2, j = (long)floor(y) + k / 2;

		blend.part[k] = (k % 2 ? right : 1 - right) * (k / 2 ? down : 1 - down);
		blend.pixel[k] = is_square ? square_pixel((long)panorama->width, i, j)
					   : latlong_pixel(panorama, i, j);
	}
	return blend;
}
