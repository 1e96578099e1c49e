/*
 * Makes spectral EXR files of light layers and geometry, as specexr(5) has them, whose
 * every sample is known; and lists the samples of a pixel. For tests and benches.
 *
 *   layers [OPTION]... [-o FILE]        (try --help)
 *   layers --print X,Y [FILE]           lists pixel X,Y of any EXR file that the tools
 *                                       read, counted from the data window's corner: a
 *                                       line "CHANNEL VALUE" per channel, ordered by name
 *
 * Below, x, y is a pixel, 0,0 the upper left; W x H the --size; M the smaller of the two;
 *   a = (x + 1/2 - W/2) / M,  b = (H/2 - y - 1/2) / M    right of and above the middle
 *   V = --radiance (1), B = --behind (0.25), A = --angle (0; tilted: 30 degrees)
 *   s(l) at the wavelength l, by --shape: flat 1 (the default), ramp l / 550 nm
 *   sky(d) = 1 + d.X/8 + d.Y/4 + d.Z/2     of a unit vector d, away from the surface
 *   m = 2 (N.I) N - I                      the mirror direction
 * mirror, through, S0 and lamp<j>.S0 are what is said per scene times s(l), at the bands'
 * wavelengths even with --bins. Always Ns = N and cosine = N.I. Where the cover of a film
 * or of the disc is 0, so are its other channels and its lamps. All is computed in double
 * and rounded to float when it is written. World is left-handed, in metres, z up: who
 * looks along -y has x on the right.
 *
 *   flat    One plane through the origin, orthographic. film1: cover 1, id 1, I = (0,1,0),
 *           N = (0, cos A, sin A), P = (a, -b tan A, b), Q.X = (x + 1/2) / W,
 *           Q.Z = 1 - (y + 1/2) / H, Q.Y = 0 where A = 0, 1 - Q.Z where A > 0, Q.Z where
 *           A < 0; mirror = V, through = B, S0 = 0.
 *   pair    Two such planes, the second 0.1 m behind the first (P.Y is 0.1 less) and seen
 *           only in the right half of the image, a >= 0. film1: id 3, the rest as in flat.
 *           film2: id 7, mirror = V/2, Q.X = 2 (x + 1/2) / W - 1, the rest as in flat.
 *           through = B, in the left half too. S0 = 0.
 *   tilted  A square of 4 m around the origin, seen from (0,1,0) in perspective.
 *           v = (a, -1, b), g = 1 - b tan A, P = (0,1,0) + v / g, N = (0, cos A, sin A),
 *           h = P.Z / cos A; film1 is there where g > 0, |P.X| <= 2 and |h| <= 2: cover 1,
 *           id 1, I = -v / |v|, Q = (1/2 + P.X/4, as flat's, 1/2 + h/4),
 *           mirror = V sky(m), through = B, S0 = 0. Elsewhere S0 = V sky(v / |v|) and
 *           through = 0.
 *   sphere  A bubble of radius r = --radius (0.4) around the origin, orthographic,
 *           I = (0,1,0). Where a^2 + b^2 < r^2, c = sqrt(1 - (a^2 + b^2) / r^2):
 *           film1: N = (a/r, c, b/r), film2: N = (a/r, -c, b/r), whose cosine is negative;
 *           both: cover 1, id 1, P = r N, Q = (N + (1,1,1)) / 2, mirror = V sky(m) - the
 *           other film does not change what comes along m - and through = V sky((0,-1,0)),
 *           S0 = 0. Elsewhere S0 = V sky((0,-1,0)).
 *   disc    A compact disc: 0.025 <= |P| <= 0.058 in the plane z = 0, seen in perspective
 *           from e = --eye (0,-0.25,0.25), which looks at the origin: f = -e / |e|,
 *           right = u x f / |u x f| where u = (0,0,1), or (0,1,0) where e lies on the z
 *           axis, up = f x right, v = f + (0.14 / |e|) (a right + b up); where v.Z < 0,
 *           P = e - v e.Z / v.Z. cover 1, id 1, N = (0,0,1), I = -v / |v|,
 *           Tan = (-P.Y, P.X, 0) / |P|, Q = ((P.X + 0.058) / 0.116, (P.Y + 0.058) / 0.116,
 *           0); of each --lamp (0.1,0.2,0.4,1) at p with the power w, D = (p - P) / |p - P|
 *           and lamp<j>.S0 = w / (4 pi |p - P|^2), or 0 where p.Z <= 0. S0 = 0.
 *           The cross product has (p x q).X = p.Y q.Z - p.Z q.Y, and so on.
 *   noise   For benches. --films K of them (1), k = 1 ... K: as in flat with A = 0, except
 *           id k, P.Y = -(k - 1) / 10 and N along
 *           (sin(6 pi Q.X + k), 1 or, where k is even, -1, cos(4 pi Q.Z + k)).
 *           All light is multiplied by G(c): mirror = V G(k), through = B G(32),
 *           S0 = V G(0), where G(c) of the band i counted from 0 is
 *           (0.25 + (x + y) 2^-13 + i 2^-9) * (1 + noise(x, y, i + 1024 c) / 8), with the
 *           noise of synthesize.c: smooth, but for some bits, as a rendered picture.
 *           With --lamps J in place of films: such a surface, k = 1, without a prefix, as
 *           in disc; Tan = (N.Y, -N.X, 0) made a unit vector, lamp<j>: D towards
 *           (cos j, 1, sin j), lamp<j>.S0 = V G(j); S0 = V G(0).
 *
 * --samples N (tilted, sphere, pair, disc): a pixel is the mean of N x N such points, where
 * x + 1/2 becomes x + (i + 1/2) / N, i = 0 ... N - 1, and y likewise. Geometry and cosine
 * are the mean of the points that show the surface, vectors made unit vectors again (P and
 * Q stay means); cover and light are means of all points, light that is not there being 0.
 */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "base/memory.h"
#include "base/number.h"
#include "cli/options.h"
#include "image/names.h"
#include "image/reader.h"
#include "spectrum/grid.h"

#include "making.h"

#define PI 3.14159265358979323846
#define MOST_FILMS 4
#define MOST_LAMPS 16
#define MOST_BANDS 1024 /* that the grain tells apart */
#define MOST_SAMPLES 4096
#define GRAIN_THROUGH 32
#define LONGEST_NAME 64
#define COMPONENTS 3 /* of a vector */

#define DISC_INNER_M 0.025
#define DISC_OUTER_M 0.058
#define DISC_FRAME_M 0.14 /* that the smaller side of the image shows */
#define SQUARE_HALF_M 2.0 /* of the tilted plane */
#define GAP_M 0.1         /* between planes one behind the other */

/* --- The scenes: what a point of the image shows. --- */

enum kind {
	KIND_FLAT,
	KIND_PAIR,
	KIND_TILTED,
	KIND_SPHERE,
	KIND_DISC,
	KIND_NOISE,
	KIND_NOISE_LAMPS, /* not a name of --scene: noise with --lamps */
	KIND_PRINT        /* no scene: a pixel of a file is listed */
};

struct vector {
	double x, y, z;
};

struct lamp {
	struct vector point;
	double power;
};

struct scene {
	enum kind kind;
	int width, height;
	double angle; /* radians */
	double radiance, behind, radius;
	int samples;
	struct vector eye;
	struct lamp lamp[MOST_LAMPS];
	int films, lamps;
};

struct surface {
	double cover, cosine, id;
	struct vector point, normal, eye, box, tangent;
	double mirror;
};

struct beam {
	struct vector direction;
	double irradiance;
};

/* Holds doubles alone, so that it can be taken for a list of them: numbers_of. */
struct pixel {
	struct surface film[MOST_FILMS]; /* the first is also what has no prefix */
	struct beam beam[MOST_LAMPS];
	double through, rest; /* rest: S0 */
};

#define NUMBERS (sizeof(struct pixel) / sizeof(double))

static double *
numbers_of(struct pixel *pixel)
{
	return (double *)(void *)pixel;
}

static struct vector
add(struct vector p, struct vector q, double factor)
{
	return (struct vector){p.x + q.x * factor, p.y + q.y * factor, p.z + q.z * factor};
}

static double
dot(struct vector p, struct vector q)
{
	return p.x * q.x + p.y * q.y + p.z * q.z;
}

static struct vector
cross(struct vector p, struct vector q)
{
	return (struct vector){
		p.y * q.z - p.z * q.y, p.z * q.x - p.x * q.z, p.x * q.y - p.y * q.x};
}

/* The vector 0 stays what it is. */
static struct vector
unit(struct vector p)
{
	double length = sqrt(dot(p, p));

	return length > 0 ? add((struct vector){0}, p, 1 / length) : p;
}

static double
sky(struct vector direction)
{
	return 1 + direction.x / 8 + direction.y / 4 + direction.z / 2;
}

static struct vector
mirrored(const struct surface *surface)
{
	double cosine = dot(surface->normal, surface->eye);

	return add(add((struct vector){0}, surface->normal, 2 * cosine), surface->eye, -1);
}

/* Where on the image a place lies, x, y in pixels: (a, 0, b) of the text above. */
static struct vector
in_frame(const struct scene *scene, double x, double y)
{
	double smaller = scene->width < scene->height ? scene->width : scene->height;

	return (struct vector){
		(x - 0.5 * scene->width) / smaller, 0, (0.5 * scene->height - y) / smaller};
}

/* Q of a plane that is tilted about x; along: 0 at its lower edge, 1 at its upper. */
static struct vector
box_of_plane(const struct scene *scene, double across, double along)
{
	double depth = 0;

	if (scene->angle > 0)
		depth = 1 - along;
	else if (scene->angle < 0)
		depth = along;
	return (struct vector){across, depth, along};
}

static void
show_surface(struct surface *surface, double id, struct vector point, struct vector normal,
	struct vector eye)
{
	surface->cover = 1;
	surface->cosine = dot(normal, eye);
	surface->id = id;
	surface->point = point;
	surface->normal = normal;
	surface->eye = eye;
}

/* A film that fills the image, seen orthographically; index from 0. */
static void
see_plane(const struct scene *scene, double x, double y, int index, struct surface *film)
{
	struct vector at = in_frame(scene, x, y);

	at.y = -index * GAP_M - at.z * tan(scene->angle);
	show_surface(film, 1, at, (struct vector){0, cos(scene->angle), sin(scene->angle)},
		(struct vector){0, 1, 0});
	film->box = box_of_plane(scene, x / scene->width, 1 - y / scene->height);
	film->mirror = scene->radiance;
}

static void
see_flat(const struct scene *scene, double x, double y, struct pixel *pixel)
{
	see_plane(scene, x, y, 0, &pixel->film[0]);
	pixel->through = scene->behind;
}

static void
see_pair(const struct scene *scene, double x, double y, struct pixel *pixel)
{
	struct surface *front = &pixel->film[0], *back = &pixel->film[1];

	see_flat(scene, x, y, pixel);
	front->id = 3;
	if (in_frame(scene, x, y).x < 0)
		return;
	see_plane(scene, x, y, 1, back);
	back->id = 7;
	back->box.x = 2 * x / scene->width - 1;
	back->mirror = scene->radiance / 2;
}

static void
see_tilted(const struct scene *scene, double x, double y, struct pixel *pixel)
{
	const struct vector eye = {0, 1, 0};
	const struct vector normal = {0, cos(scene->angle), sin(scene->angle)};
	struct surface *film = &pixel->film[0];
	struct vector ray = in_frame(scene, x, y), point;
	double facing = 1 - ray.z * tan(scene->angle), along;

	ray.y = -1;
	point = add(eye, ray, 1 / facing);
	along = point.z / cos(scene->angle);
	ray = unit(ray);
	if (facing <= 0 || fabs(point.x) > SQUARE_HALF_M || fabs(along) > SQUARE_HALF_M) {
		pixel->rest = scene->radiance * sky(ray);
		return;
	}
	show_surface(film, 1, point, normal, add((struct vector){0}, ray, -1));
	film->box = box_of_plane(scene, 0.5 + point.x / (2 * SQUARE_HALF_M),
		0.5 + along / (2 * SQUARE_HALF_M));
	film->mirror = scene->radiance * sky(mirrored(film));
	pixel->through = scene->behind;
}

static void
see_sphere(const struct scene *scene, double x, double y, struct pixel *pixel)
{
	const struct vector ray = {0, -1, 0}, eye = {0, 1, 0}, half = {0.5, 0.5, 0.5};
	struct vector normal =
		add((struct vector){0}, in_frame(scene, x, y), 1 / scene->radius);
	double background = scene->radiance * sky(ray);
	double square = dot(normal, normal);

	if (square >= 1) {
		pixel->rest = background;
		return;
	}
	normal.y = sqrt(1 - square);
	for (int i = 0; i < 2; i++, normal.y = -normal.y) {
		struct surface *film = &pixel->film[i];

		show_surface(film, 1, add((struct vector){0}, normal, scene->radius),
			normal, eye);
		film->box = add(half, normal, 0.5);
		film->mirror = scene->radiance * sky(mirrored(film));
	}
	pixel->through = background;
}

/* The ray through a place of the image, of a camera that looks at the origin. */
static struct vector
aimed_ray(const struct scene *scene, double x, double y)
{
	const struct vector axis = {0, 0, 1}, other = {0, 1, 0};
	struct vector at = in_frame(scene, x, y), eye = scene->eye;
	struct vector forward = unit(add((struct vector){0}, eye, -1)), right, up;
	double scale = DISC_FRAME_M / sqrt(dot(eye, eye));

	right = unit(cross(eye.x == 0 && eye.y == 0 ? other : axis, forward));
	up = cross(forward, right);
	return add(add(forward, right, scale * at.x), up, scale * at.z);
}

static void
see_lamps(const struct scene *scene, struct pixel *pixel)
{
	for (int i = 0; i < scene->lamps; i++) {
		const struct lamp *lamp = &scene->lamp[i];
		struct vector way = add(lamp->point, pixel->film[0].point, -1);

		pixel->beam[i].direction = unit(way);
		if (lamp->point.z > 0)
			pixel->beam[i].irradiance = lamp->power / (4 * PI * dot(way, way));
	}
}

static void
see_disc(const struct scene *scene, double x, double y, struct pixel *pixel)
{
	const struct vector normal = {0, 0, 1};
	struct surface *disc = &pixel->film[0];
	struct vector ray = aimed_ray(scene, x, y), point;
	double radius;

	if (ray.z >= 0)
		return;
	point = add(scene->eye, ray, -scene->eye.z / ray.z);
	point.z = 0;
	radius = sqrt(dot(point, point));
	if (radius < DISC_INNER_M || radius > DISC_OUTER_M)
		return;
	show_surface(disc, 1, point, normal, unit(add((struct vector){0}, ray, -1)));
	disc->tangent = unit(cross(normal, point));
	disc->box = (struct vector){(point.x + DISC_OUTER_M) / (2 * DISC_OUTER_M),
		(point.y + DISC_OUTER_M) / (2 * DISC_OUTER_M), 0};
	see_lamps(scene, pixel);
}

/* The k-th film of the noise, without its light. */
static void
see_waves(const struct scene *scene, double x, double y, int k, struct surface *film)
{
	struct vector normal = {0, k % 2 == 0 ? -1 : 1, 0};

	see_plane(scene, x, y, k - 1, film);
	normal.x = sin(6 * PI * film->box.x + k);
	normal.z = cos(4 * PI * film->box.z + k);
	show_surface(film, k, film->point, unit(normal), film->eye);
}

static void
see_noise(const struct scene *scene, double x, double y, struct pixel *pixel)
{
	for (int k = 1; k <= scene->films; k++)
		see_waves(scene, x, y, k, &pixel->film[k - 1]);
	pixel->through = scene->behind;
	pixel->rest = scene->radiance;
}

static void
see_noise_lamps(const struct scene *scene, double x, double y, struct pixel *pixel)
{
	struct surface *surface = &pixel->film[0];

	see_waves(scene, x, y, 1, surface);
	surface->tangent = unit((struct vector){surface->normal.y, -surface->normal.x, 0});
	for (int j = 1; j <= scene->lamps; j++) {
		struct vector point = {cos(j), 1, sin(j)};
		struct beam *beam = &pixel->beam[j - 1];

		beam->direction = unit(add(point, surface->point, -1));
		beam->irradiance = scene->radiance;
	}
	pixel->rest = scene->radiance;
}

/* What a point shows; x, y in pixels, 0.5,0.5 being the middle of the first. */
static void
see(const struct scene *scene, double x, double y, struct pixel *pixel)
{
	*pixel = (struct pixel){0};
	switch (scene->kind) {
	case KIND_FLAT:
		see_flat(scene, x, y, pixel);
		break;
	case KIND_PAIR:
		see_pair(scene, x, y, pixel);
		break;
	case KIND_TILTED:
		see_tilted(scene, x, y, pixel);
		break;
	case KIND_SPHERE:
		see_sphere(scene, x, y, pixel);
		break;
	case KIND_DISC:
		see_disc(scene, x, y, pixel);
		break;
	case KIND_NOISE:
		see_noise(scene, x, y, pixel);
		break;
	case KIND_NOISE_LAMPS:
		see_noise_lamps(scene, x, y, pixel);
		break;
	case KIND_PRINT:
		break;
	}
}

/* Makes means of the sums of the count points of a surface's pixel. */
static void
finish_surface(struct surface *surface, double count)
{
	double shown = surface->cover > 0 ? 1 / surface->cover : 0;
	struct vector none = {0};

	surface->cosine *= shown;
	surface->id = round(surface->id * shown); /* all its points have the same */
	surface->point = add(none, surface->point, shown);
	surface->box = add(none, surface->box, shown);
	surface->normal = unit(surface->normal);
	surface->eye = unit(surface->eye);
	surface->tangent = unit(surface->tangent);
	surface->cover /= count;
	surface->mirror /= count;
}

static void
see_pixel(const struct scene *scene, int x, int y, struct pixel *pixel)
{
	double *sum = numbers_of(pixel), count = (double)scene->samples * scene->samples;
	struct pixel point;

	if (scene->samples == 1) {
		see(scene, x + 0.5, y + 0.5, pixel);
		return;
	}
	*pixel = (struct pixel){0};
	for (int j = 0; j < scene->samples; j++) {
		for (int i = 0; i < scene->samples; i++) {
			see(scene, x + (i + 0.5) / scene->samples,
				y + (j + 0.5) / scene->samples, &point);
			for (size_t n = 0; n < NUMBERS; n++)
				sum[n] += numbers_of(&point)[n];
		}
	}
	for (int i = 0; i < MOST_FILMS; i++)
		finish_surface(&pixel->film[i], count);
	for (int i = 0; i < MOST_LAMPS; i++) {
		pixel->beam[i].direction = unit(pixel->beam[i].direction);
		pixel->beam[i].irradiance /= count;
	}
	pixel->through /= count;
	pixel->rest /= count;
}

/* G(which) of the text above, which is c there. */
static double
grain(int x, int y, int band, int which)
{
	uint64_t state = ((uint64_t)y << 32) + ((uint64_t)x << 16) +
			 (uint64_t)(band + which * MOST_BANDS);
	double noise = (double)(int32_t)(making_splitmix(state) >> 40) / (1 << 24);

	return (0.25 + (x + y) / 8192.0 + band / 512.0) * (1 + noise / 8);
}

/* --- The file: which channels hold what of it. --- */

/* A channel and what it shows of a pixel. */
struct plane {
	char *name;
	enum spec_sample sample;
	size_t source; /* index of the source */
	int band;      /* of light, else -1 */
	int grain;     /* which grain multiplies it, or -1 */
};

struct layers {
	struct spec_settings settings;
	struct scene scene;
	const char *grid;
	int ramp, bins;
	int print_x, print_y;
	const char *file; /* to print from */

	struct spec_grid wavelengths;
	double *shape;  /* s, per wavelength */
	size_t *source; /* indices into the numbers of a pixel, each once */
	size_t sources;
	struct plane *plane; /* in the order of the image's channels */
	size_t planes, plane_room;
	struct pixel model; /* stands for any: tells where in a pixel a number lies */
	struct spec_image image;
};

/* The index, among the sources, of a number of layers->model. */
static size_t
source_of(struct layers *layers, const double *number)
{
	size_t offset = (size_t)(number - numbers_of(&layers->model));
	size_t i = 0;

	while (i < layers->sources && layers->source[i] != offset)
		i++;
	if (i == layers->sources)
		layers->source[layers->sources++] = offset;
	return i;
}

static enum spec_status
add_plane(struct layers *layers, const char *prefix, const char *name, const double *number,
	struct plane plane, struct spec_error *error)
{
	void *grown = layers->plane;
	char whole[2 * LONGEST_NAME];

	if (spec_memory_grow(&grown, &layers->plane_room, layers->planes + 1, sizeof plane,
		    "channels", error) != SPEC_OK)
		return SPEC_ENOMEM;
	layers->plane = grown;
	snprintf(whole, sizeof whole, "%s%s", prefix, name);
	plane.name = spec_memory_text(whole, strlen(whole), error);
	if (!plane.name)
		return SPEC_ENOMEM;
	plane.source = source_of(layers, number);
	layers->plane[layers->planes++] = plane;
	return SPEC_OK;
}

static enum spec_status
plan_number(struct layers *layers, const char *prefix, const char *name,
	const double *number, struct spec_error *error)
{
	return add_plane(layers, prefix, name, number,
		(struct plane){.sample = SPEC_SAMPLE_FLOAT, .band = -1, .grain = -1},
		error);
}

static enum spec_status
plan_vector(struct layers *layers, const char *prefix, const char *name,
	const struct vector *vector, struct spec_error *error)
{
	const double *component[COMPONENTS] = {&vector->x, &vector->y, &vector->z};
	enum spec_status status = SPEC_OK;
	char whole[LONGEST_NAME];

	for (int i = 0; i < COMPONENTS && status == SPEC_OK; i++) {
		snprintf(whole, sizeof whole, "%s.%c", name, "XYZ"[i]);
		status = plan_number(layers, prefix, whole, component[i], error);
	}
	return status;
}

/* The bands of a light; which: its grain. */
static enum spec_status
plan_light(struct layers *layers, const char *prefix, const double *number, int which,
	struct spec_error *error)
{
	enum kind kind = layers->scene.kind;
	struct plane plane = {
		.sample = layers->settings.half ? SPEC_SAMPLE_HALF : SPEC_SAMPLE_FLOAT,
		.grain = kind == KIND_NOISE || kind == KIND_NOISE_LAMPS ? which : -1};
	enum spec_status status = SPEC_OK;
	char name[LONGEST_NAME];

	for (size_t i = 0; i < layers->wavelengths.count && status == SPEC_OK; i++) {
		spec_names_write(name, sizeof name, SPEC_ROLE_EMISSIVE, 0,
			layers->wavelengths.wavelength_nm[i], 0);
		plane.band = (int)i;
		status = add_plane(layers, prefix, name, number, plane, error);
	}
	return status;
}

static enum spec_status
plan_surface(struct layers *layers, const char *prefix, const struct surface *surface,
	struct spec_error *error)
{
	const struct {
		const char *name;
		const struct vector *vector;
	} vectors[] = {{"P", &surface->point}, {"N", &surface->normal},
		{"Ns", &surface->normal}, {"I", &surface->eye}, {"Q", &surface->box}};
	const struct plane id = {.sample = SPEC_SAMPLE_UINT, .band = -1, .grain = -1};
	enum spec_status status =
		plan_number(layers, prefix, "cover", &surface->cover, error);

	if (status == SPEC_OK)
		status = plan_number(layers, prefix, "cosine", &surface->cosine, error);
	if (status == SPEC_OK)
		status = add_plane(layers, prefix, "id", &surface->id, id, error);
	for (size_t i = 0; i < sizeof vectors / sizeof *vectors && status == SPEC_OK; i++)
		status = plan_vector(
			layers, prefix, vectors[i].name, vectors[i].vector, error);
	return status;
}

static enum spec_status
plan_films(struct layers *layers, struct spec_error *error)
{
	const struct pixel *model = &layers->model;
	enum spec_status status = SPEC_OK;
	char prefix[LONGEST_NAME];

	for (int i = 0; i < layers->scene.films && status == SPEC_OK; i++) {
		snprintf(prefix, sizeof prefix, "film%d.", i + 1);
		status = plan_surface(layers, prefix, &model->film[i], error);
		snprintf(prefix, sizeof prefix, "film%d.mirror.", i + 1);
		if (status == SPEC_OK)
			status = plan_light(
				layers, prefix, &model->film[i].mirror, i + 1, error);
	}
	if (status == SPEC_OK)
		status = plan_light(
			layers, "through.", &model->through, GRAIN_THROUGH, error);
	return status;
}

static enum spec_status
plan_lamps(struct layers *layers, struct spec_error *error)
{
	const struct pixel *model = &layers->model;
	enum spec_status status = plan_surface(layers, "", &model->film[0], error);
	char prefix[LONGEST_NAME];

	if (status == SPEC_OK)
		status = plan_vector(layers, "", "Tan", &model->film[0].tangent, error);
	for (int i = 0; i < layers->scene.lamps && status == SPEC_OK; i++) {
		const struct beam *beam = &model->beam[i];

		snprintf(prefix, sizeof prefix, "lamp%d.", i + 1);
		status = plan_vector(layers, prefix, "D", &beam->direction, error);
		if (status == SPEC_OK)
			status =
				plan_light(layers, prefix, &beam->irradiance, i + 1, error);
	}
	return status;
}

static int
compare_planes(const void *a, const void *b)
{
	const struct plane *one = a, *two = b;

	return strcmp(one->name, two->name);
}

static enum spec_status
plan_planes(struct layers *layers, struct spec_error *error)
{
	enum spec_status status;

	layers->source = spec_memory_new(NUMBERS, sizeof *layers->source, "numbers", error);
	if (!layers->source)
		return SPEC_ENOMEM;
	status = layers->scene.lamps > 0 ? plan_lamps(layers, error)
					 : plan_films(layers, error);
	if (status == SPEC_OK)
		status = plan_light(layers, "", &layers->model.rest, 0, error);
	if (status == SPEC_OK)
		qsort(layers->plane, layers->planes, sizeof *layers->plane, compare_planes);
	return status;
}

static enum spec_status
plan_spectrum(struct layers *layers, struct spec_error *error)
{
	const struct spec_grid *grid = &layers->wavelengths;
	enum spec_status status =
		spec_grid_parse(layers->grid, &layers->wavelengths, error);

	if (status != SPEC_OK)
		return status;
	if (grid->count > MOST_BANDS)
		return spec_error_set(error, SPEC_ERANGE, "more than %d bands", MOST_BANDS);
	layers->shape = spec_memory_new(grid->count, sizeof(double), "wavelengths", error);
	if (!layers->shape)
		return SPEC_ENOMEM;
	for (size_t i = 0; i < grid->count; i++)
		layers->shape[i] = layers->ramp ? grid->wavelength_nm[i] / 550 : 1;
	return SPEC_OK;
}

static enum spec_status
plan_image(struct layers *layers, struct spec_error *error)
{
	struct spec_image *image = &layers->image;
	struct spec_window window = {0, 0, layers->scene.width, layers->scene.height};
	enum spec_status status = SPEC_OK;

	*image = (struct spec_image){.data = window,
		.display = window,
		.pixel_aspect_ratio = 1,
		.screen_window_width = 1};
	for (size_t i = 0; i < layers->planes && status == SPEC_OK; i++)
		status = spec_image_add_channel(
			image, layers->plane[i].name, layers->plane[i].sample, error);
	if (status == SPEC_OK)
		status = spec_image_set_text(image, "spectralLayoutVersion", "1.0", error);
	if (status == SPEC_OK)
		status = spec_image_set_text(image, "emissiveUnits", "W.m^-2.sr^-1", error);
	if (status == SPEC_OK && layers->bins)
		status = making_set_bins(image, &layers->wavelengths, error);
	if (status == SPEC_OK)
		status = spec_image_index(image, layers->settings.output, error);
	return status;
}

/* --- Writing. --- */

/* The sources of line y: value is [sources][width]. */
static void
see_line(const struct layers *layers, int y, double *value)
{
	size_t width = (size_t)layers->scene.width;
	struct pixel pixel;

	for (size_t x = 0; x < width; x++) {
		see_pixel(&layers->scene, (int)x, y, &pixel);
		for (size_t i = 0; i < layers->sources; i++)
			value[i * width + x] = numbers_of(&pixel)[layers->source[i]];
	}
}

/* One channel of line y; value: of its source. */
static void
fill_row(const struct layers *layers, const struct plane *plane, int y, const double *value,
	float *row)
{
	size_t width = (size_t)layers->scene.width;
	uint32_t *number = (uint32_t *)(void *)row;
	double shape = plane->band >= 0 ? layers->shape[plane->band] : 1;

	if (plane->sample == SPEC_SAMPLE_UINT) {
		for (size_t x = 0; x < width; x++)
			number[x] = (uint32_t)value[x];
	} else if (plane->grain >= 0) {
		for (size_t x = 0; x < width; x++)
			row[x] = (float)(value[x] * shape *
					 grain((int)x, y, plane->band, plane->grain));
	} else {
		for (size_t x = 0; x < width; x++)
			row[x] = (float)(value[x] * shape);
	}
}

static void
fill_line(const void *state, int y, void *room, float *const *row)
{
	const struct layers *layers = state;
	size_t width = (size_t)layers->scene.width;
	double *value = room;

	see_line(layers, y, value);
	for (size_t i = 0; i < layers->planes; i++)
		fill_row(layers, &layers->plane[i], y,
			value + layers->plane[i].source * width, row[i]);
}

static enum spec_status
write_image(const struct layers *layers, struct spec_error *error)
{
	struct making making = {.image = &layers->image,
		.settings = &layers->settings,
		.fill = fill_line,
		.state = layers,
		.room_bytes =
			layers->sources * (size_t)layers->scene.width * sizeof(double)};

	return making_write(&making, error);
}

/* --- Reading: --print. --- */

static void
print_samples(
	const struct spec_image *image, const struct spec_decoder *decoder, int x, int y)
{
	for (size_t i = 0; i < image->channels; i++) {
		const struct spec_channel *channel = &image->channel[i];
		const float *row = spec_decoder_row(decoder, image->data.y0 + y, i);

		if (channel->sample == SPEC_SAMPLE_UINT && channel->role == SPEC_ROLE_OTHER)
			printf("%s %lu\n", channel->name,
				(unsigned long)((const uint32_t *)(const void *)row)[x]);
		else
			printf("%s %.9g\n", channel->name, (double)row[x]);
	}
}

static enum spec_status
print_from(struct spec_reader *reader, int x, int y, struct spec_error *error)
{
	const struct spec_image *image = spec_reader_image(reader);
	int line = image->data.y0 + y;
	struct spec_decoder *decoder;
	enum spec_status status;

	if ((size_t)x >= spec_window_width(&image->data) ||
		(size_t)y >= spec_window_height(&image->data))
		return spec_error_set(error, SPEC_ERANGE, "%s: no pixel %d,%d",
			spec_reader_name(reader), x, y);
	status = spec_decoder_open(&decoder, reader, NULL, error);
	if (status != SPEC_OK)
		return status;
	status = spec_decoder_read(decoder, line, error);
	if (status == SPEC_OK)
		print_samples(image, decoder, x, y);
	spec_decoder_close(decoder);
	if (status == SPEC_OK)
		status = spec_reader_drain(reader, error);
	return status;
}

static enum spec_status
print_pixel(const struct layers *layers, struct spec_error *error)
{
	struct spec_reader *reader;
	enum spec_status status =
		spec_reader_open(&reader, layers->file, &layers->settings, error);

	if (status != SPEC_OK)
		return status;
	status = print_from(reader, layers->print_x, layers->print_y, error);
	spec_reader_close(reader);
	return status;
}

/* --- The command line. --- */

static const struct cli_option options[] = {
	{0, "scene", "NAME", "flat (default) pair tilted sphere disc noise"},
	{0, "size", "WxH", "of the image (default: 16x8)"},
	{0, "grid", "LO:HI:STEP", "wavelengths in nm (default: 380:780:5)"},
	{0, "bins", NULL, "spec:bins half-way between the wavelengths"},
	{0, "shape", "NAME",
		"of all spectra: flat (default), or ramp: wavelength / 550 nm"},
	{0, "radiance", "V", "of what the films mirror (default: 1); not of disc"},
	{0, "behind", "V",
		"radiance behind the films (default: 0.25) of flat pair\ntilted noise"},
	{0, "angle", "DEGREES",
		"tilt of the plane of flat pair (default: 0)\nand of tilted (default: 30)"},
	{0, "radius", "R", "of sphere, in m; the frame is 1 m (default: 0.4)"},
	{0, "samples", "N",
		"N x N points a pixel of pair tilted sphere disc\n(default: 1)"},
	{0, "eye", "X,Y,Z", "where disc is seen from (default: 0,-0.25,0.25)"},
	{0, "lamp", "X,Y,Z[,POWER]", "a lamp of disc (default: 0.1,0.2,0.4,1); repeats"},
	{0, "films", "K", "of noise (default: 1)"},
	{0, "lamps", "J", "of noise, in place of films"},
	{0, "print", "X,Y", "list a pixel of the FILE given"},
	{0},
};

static const struct cli_program program = {
	.name = "layers",
	.arguments = "[OPTION]... [-o FILE] | --print X,Y [FILE]",
	.summary = "Makes spectral EXR files of light layers with known samples.",
	.options = options,
	.writes_images = 1,
};

static const char *const kind_names[] = {
	[KIND_FLAT] = "flat",
	[KIND_PAIR] = "pair",
	[KIND_TILTED] = "tilted",
	[KIND_SPHERE] = "sphere",
	[KIND_DISC] = "disc",
	[KIND_NOISE] = "noise",
	[KIND_NOISE_LAMPS] = "noise with --lamps",
	[KIND_PRINT] = "--print",
};

#define BIT(kind) (1U << (kind))
#define ALL_SCENES (BIT(KIND_PRINT) - 1)

/* Which scenes an option fits; one of this program that is not here fits all. */
static const struct fit {
	const char *option;
	unsigned kinds;
} fits[] = {
	{"radiance", ALL_SCENES & ~BIT(KIND_DISC)},
	{"behind", BIT(KIND_FLAT) | BIT(KIND_PAIR) | BIT(KIND_TILTED) | BIT(KIND_NOISE)},
	{"angle", BIT(KIND_FLAT) | BIT(KIND_PAIR) | BIT(KIND_TILTED)},
	{"radius", BIT(KIND_SPHERE)},
	{"samples", BIT(KIND_PAIR) | BIT(KIND_TILTED) | BIT(KIND_SPHERE) | BIT(KIND_DISC)},
	{"eye", BIT(KIND_DISC)},
	{"lamp", BIT(KIND_DISC)},
	{"films", BIT(KIND_NOISE)},
	{"lamps", BIT(KIND_NOISE_LAMPS)},
	{"print", BIT(KIND_PRINT)},
};

#define OPTIONS (sizeof options / sizeof *options - 1)

/* "64x48" or "1,2": two numbers of at least the least. */
static void
take_whole(const struct cli *cli, char separator, long least, int number[2])
{
	const char *text = cli->value;

	for (int i = 0; i < 2; i++) {
		char *end;
		long value = strtol(text, &end, 10);

		if (end == text || *end != (i == 0 ? separator : '\0') || value < least ||
			value > 1L << 30)
			cli_usage(cli, "'%s' is not two numbers from %ld with '%c' between",
				cli->value, least, separator);
		number[i] = (int)value;
		text = end + 1;
	}
}

/* "1,2.5,3": from least to most numbers; returns how many. */
static int
take_numbers(const struct cli *cli, int least, int most, double *number)
{
	const char *text = cli->value;
	int count = 0;

	while (count < most) {
		size_t length = spec_number_scan(text, '.', &number[count]);

		if (length == 0)
			break;
		text += length;
		count++;
		if (*text != ',' || count == most)
			break;
		text++;
	}
	if (*text != '\0' || count < least || text[-1] == ',')
		cli_usage(
			cli, "'%s' is not %d numbers with ',' between", cli->value, least);
	return count;
}

static double
take_number(const struct cli *cli, double minimum, double maximum)
{
	struct spec_error error;
	double value = 0;

	cli_check(cli,
		spec_number_parse(cli->value, minimum, maximum, cli->name, &value, &error),
		&error);
	return value;
}

static int
take_count(const struct cli *cli, long long most)
{
	struct spec_error error;
	long long value = 0;

	cli_check(cli,
		spec_number_parse_whole(cli->value, 1, most, cli->name, &value, &error),
		&error);
	return (int)value;
}

static void
take_scene(struct scene *scene, const struct cli *cli)
{
	int kind = 0;

	while (kind <= KIND_NOISE && strcmp(kind_names[kind], cli->value) != 0)
		kind++;
	if (kind > KIND_NOISE)
		cli_usage(cli, "unknown scene '%s' (flat pair tilted sphere disc noise)",
			cli->value);
	scene->kind = (enum kind)kind;
}

static void
take_lamp(struct scene *scene, const struct cli *cli)
{
	double number[4] = {0, 0, 0, 1};

	if (scene->lamps == MOST_LAMPS)
		cli_usage(cli, "more than %d lamps", MOST_LAMPS);
	take_numbers(cli, 3, 4, number);
	scene->lamp[scene->lamps++] =
		(struct lamp){{number[0], number[1], number[2]}, number[3]};
}

static void
take_eye(struct scene *scene, const struct cli *cli)
{
	double number[3];

	take_numbers(cli, 3, 3, number);
	if (number[2] <= 0)
		cli_usage(cli, "the eye is not above the disc");
	scene->eye = (struct vector){number[0], number[1], number[2]};
}

/* Options that belong to a scene; returns 0 where the option is another. */
static int
take_of_scene(struct scene *scene, const struct cli *cli)
{
	if (strcmp(cli->name, "radiance") == 0)
		scene->radiance = take_number(cli, 0, 1e30);
	else if (strcmp(cli->name, "behind") == 0)
		scene->behind = take_number(cli, 0, 1e30);
	else if (strcmp(cli->name, "angle") == 0)
		scene->angle = take_number(cli, -89, 89) * PI / 180;
	else if (strcmp(cli->name, "radius") == 0)
		scene->radius = take_number(cli, 1e-6, 1e6);
	else if (strcmp(cli->name, "samples") == 0)
		scene->samples = take_count(cli, MOST_SAMPLES);
	else if (strcmp(cli->name, "eye") == 0)
		take_eye(scene, cli);
	else if (strcmp(cli->name, "lamp") == 0)
		take_lamp(scene, cli);
	else if (strcmp(cli->name, "films") == 0)
		scene->films = take_count(cli, MOST_FILMS);
	else if (strcmp(cli->name, "lamps") == 0)
		scene->lamps = take_count(cli, MOST_LAMPS);
	else
		return 0;
	return 1;
}

static void
take_option(struct layers *layers, const struct cli *cli)
{
	struct scene *scene = &layers->scene;
	int number[2];

	if (strcmp(cli->name, "scene") == 0) {
		take_scene(scene, cli);
	} else if (strcmp(cli->name, "size") == 0) {
		take_whole(cli, 'x', 1, number);
		if (number[0] > 65536)
			cli_usage(cli, "the size %s is wider than 65536", cli->value);
		scene->width = number[0];
		scene->height = number[1];
	} else if (strcmp(cli->name, "grid") == 0) {
		layers->grid = cli->value;
	} else if (strcmp(cli->name, "bins") == 0) {
		layers->bins = 1;
	} else if (strcmp(cli->name, "shape") == 0) {
		layers->ramp = strcmp(cli->value, "ramp") == 0;
		if (!layers->ramp && strcmp(cli->value, "flat") != 0)
			cli_usage(cli, "unknown shape '%s' (flat ramp)", cli->value);
	} else if (strcmp(cli->name, "print") == 0) {
		take_whole(cli, ',', 0, number);
		layers->print_x = number[0];
		layers->print_y = number[1];
	} else if (!take_of_scene(scene, cli)) {
		cli_usage(cli, "option '--%s' does nothing here", cli->name);
	}
}

static size_t
option_index(const char *name)
{
	size_t i = 0;

	while (i < OPTIONS && strcmp(options[i].name, name) != 0)
		i++;
	return i;
}

/* given: one flag per option of the table above. */
static void
check_fits(const struct cli *cli, enum kind kind, const unsigned char *given)
{
	for (size_t i = 0; i < OPTIONS; i++) {
		unsigned kinds = ALL_SCENES;

		for (size_t j = 0; j < sizeof fits / sizeof *fits; j++) {
			if (strcmp(fits[j].option, options[i].name) == 0)
				kinds = fits[j].kinds;
		}
		if (given[i] && !(kinds & BIT(kind)))
			cli_usage(cli, "option '--%s' does not fit %s", options[i].name,
				kind_names[kind]);
	}
}

/* What was not given, of the scene that now is known. */
static void
complete_scene(struct scene *scene, const unsigned char *given)
{
	if (scene->kind == KIND_TILTED && !given[option_index("angle")])
		scene->angle = 30 * PI / 180;
	if (scene->kind == KIND_PAIR || scene->kind == KIND_SPHERE)
		scene->films = 2;
	if (scene->kind == KIND_DISC && scene->lamps == 0)
		scene->lamp[scene->lamps++] = (struct lamp){{0.1, 0.2, 0.4}, 1};
}

static void
start_layers(struct layers *layers)
{
	spec_settings_init(&layers->settings);
	layers->grid = "380:780:5";
	layers->scene = (struct scene){.width = 16,
		.height = 8,
		.radiance = 1,
		.behind = 0.25,
		.radius = 0.4,
		.samples = 1,
		.eye = {0, -0.25, 0.25},
		.films = 1};
}

/* An option, or the file to print from. */
static void
take(struct layers *layers, struct cli *cli, unsigned char *given)
{
	struct spec_error error;
	int known;

	if (!cli->name) {
		if (layers->file)
			cli_usage(cli, "'%s' is one too many", cli->value);
		layers->file = cli->value;
		return;
	}
	cli_check(cli,
		spec_settings_take(
			&layers->settings, cli->name, cli->value, &known, &error),
		&error);
	if (known)
		return;
	take_option(layers, cli);
	given[option_index(cli->name)] = 1;
}

static void
take_options(struct layers *layers, struct cli *cli)
{
	unsigned char given[OPTIONS + 1] = {0};
	struct scene *scene = &layers->scene;

	start_layers(layers);
	while (cli_next(cli))
		take(layers, cli, given);
	if (given[option_index("print")])
		scene->kind = KIND_PRINT;
	else if (scene->kind == KIND_NOISE && given[option_index("lamps")])
		scene->kind = KIND_NOISE_LAMPS;
	check_fits(cli, scene->kind, given);
	if (layers->file && scene->kind != KIND_PRINT)
		cli_usage(cli, "'%s' is for --print alone", layers->file);
	if (scene->kind == KIND_PRINT && strcmp(layers->settings.output, "-") != 0)
		cli_usage(cli, "option '--output' does not fit --print");
	complete_scene(scene, given);
}

int
main(int argc, char **argv)
{
	static struct layers layers;
	struct spec_error error;
	struct cli cli;

	cli_start(&cli, &program, argc, argv);
	take_options(&layers, &cli);
	if (layers.scene.kind == KIND_PRINT) {
		layers.file = layers.file ? layers.file : "-";
		cli_check(&cli, print_pixel(&layers, &error), &error);
		return cli_finish(&cli, 0);
	}
	cli_check(&cli, plan_spectrum(&layers, &error), &error);
	cli_check(&cli, plan_planes(&layers, &error), &error);
	cli_check(&cli, plan_image(&layers, &error), &error);
	cli_check(&cli, write_image(&layers, &error), &error);
	spec_image_clear(&layers.image);
	for (size_t i = 0; i < layers.planes; i++)
		free(layers.plane[i].name);
	free(layers.plane);
	free(layers.source);
	free(layers.shape);
	spec_grid_free(&layers.wavelengths);
	return 0; /* stdout, where it was the output, is closed and checked already */
}
