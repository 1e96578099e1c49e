/*
 * What a scene file describes, before anything is rendered: camera, lights, materials and
 * shapes, in pbrt's left-handed world, in metres. The parser fills it (parse.h); nothing
 * here depends on the wavelengths that will be rendered.
 */
#ifndef SPEC_SCENE_SCENE_H
#define SPEC_SCENE_SCENE_H

#include <stddef.h>
#include <stdint.h>

#include "base/error.h"
#include "place/sunlight.h"
#include "spectrum/curve.h"
#include "spectrum/spectrum.h"

#define SPEC_SCENE_NONE SIZE_MAX /* in place of a number in one of the lists */

/* Points are columns: p' = m p; the inverse is kept beside, for normals. */
struct spec_transform {
	double m[4][4], inverse[4][4];
};

/* Where a statement stands, for messages: "file:line:column". */
struct spec_scene_place {
	size_t file; /* the number of its name in the scene's list */
	int line, column;
};

enum spec_scene_spectrum_kind {
	SPEC_SCENE_CONSTANT,  /* value at all wavelengths */
	SPEC_SCENE_CURVE,     /* curve's first column */
	SPEC_SCENE_BLACKBODY, /* of the temperature value [K], 1 at its peak */
	SPEC_SCENE_RGB,       /* in linear sRGB; what it stands for depends on its use */
	SPEC_SCENE_SPECTRUM   /* a Fourier series, or anything with lines */
};

struct spec_scene_spectrum {
	enum spec_scene_spectrum_kind kind;
	double value;
	double rgb[3];
	struct spec_curve curve;
	struct spec_spectrum spectrum;
	struct spec_scene_place place;
};

enum spec_scene_material_kind {
	SPEC_SCENE_DIFFUSE,
	SPEC_SCENE_CONDUCTOR,
	SPEC_SCENE_DIELECTRIC,
	SPEC_SCENE_THINFILM,    /* a stack between two media, straight through */
	SPEC_SCENE_DIFFRACTIVE, /* a disc of specdisc's */
	SPEC_SCENE_INTERFACE    /* no surface at all: it only bounds an area light */
};

struct spec_scene_material {
	enum spec_scene_material_kind kind;
	uint32_t id; /* from 1: the "integer id" of the statement, else its number */
	struct spec_scene_spectrum reflectance; /* diffuse, 0 to 1 */
	struct spec_scene_spectrum eta, k;      /* conductor; dielectric: eta alone */
	double roughness[2];                    /* alpha of Trowbridge-Reitz, 0: smooth */
	char *stack, *thickness; /* thinfilm, as specfilm's; thickness or null */
	char *preset;            /* diffractive, as specdisc's */
	struct spec_scene_place place;
};

enum spec_scene_shape_kind { SPEC_SCENE_SPHERE, SPEC_SCENE_DISK, SPEC_SCENE_MESH };

struct spec_scene_shape {
	enum spec_scene_shape_kind kind;
	struct spec_transform world; /* world from object */
	int reverse_orientation;     /* normals point the other way */
	double radius, inner_radius,
		height;             /* sphere: radius; disk: all, in the plane z = height */
	size_t vertices, triangles; /* mesh, in object space */
	float *point;               /* [3 * vertices] */
	float *normal;              /* [3 * vertices], or null */
	float *uv;                  /* [2 * vertices], or null */
	uint32_t *index;            /* [3 * triangles] */
	size_t material;            /* its number */
	size_t light;               /* the area light's number, or SPEC_SCENE_NONE */
	struct spec_scene_place place;
};

enum spec_scene_light_kind {
	SPEC_SCENE_POINT,   /* radiant intensity [W/sr/nm] at from */
	SPEC_SCENE_DISTANT, /* irradiance perpendicular to it [W/m^2/nm], going to - from */
	SPEC_SCENE_INFINITE, /* radiance from all directions, or from a picture */
	SPEC_SCENE_AREA /* radiance of the shapes that carry it, on the normals' side */
};

/* The sun and a clear sky, somewhere and at some time. */
struct spec_scene_daylight {
	struct spec_sunlight sunlight; /* place, instant, atmosphere; no plane */
	struct spec_clearsky_sun sun;
	int has_sun; /* else the sky alone */
	double east[3], north[3],
		up[3]; /* in world space: unit vectors across each other */
};

struct spec_scene_light {
	enum spec_scene_light_kind kind;
	struct spec_scene_spectrum spectrum;
	double scale;
	double from[3], to[3];                /* in world space */
	struct spec_transform world;          /* infinite: world from light */
	char *picture;                        /* infinite: a file's path, or null */
	struct spec_scene_daylight *daylight; /* infinite: in place of that, or null */
	int twosided;                         /* area */
	struct spec_scene_place place;
};

struct spec_scene {
	size_t files;
	char **file; /* names, for messages */

	struct spec_transform camera; /* world from camera */
	int has_place;                /* it says where it stands: */
	struct spec_place place;
	int all_around; /* latitude and longitude around the camera's y: no fov, screen, lens */
	double fov_deg;   /* of the shorter side */
	double screen[4]; /* x0, x1, y0, y1 of the screen window; see has_screen */
	int has_screen;
	double lens_radius, focal_distance;
	int width, height; /* of the film */
	int samples;       /* per pixel; 0: not said */
	int max_depth;     /* of the integrator; -1: not said */
	long long seed;
	char *integrator; /* its name, or null */
	char *output;     /* the film's file name, or null */

	size_t materials, shapes, lights;
	struct spec_scene_material *material;
	struct spec_scene_shape *shape;
	struct spec_scene_light *light;
	/* What was read and makes no difference here: "file:line:column: …", each once. */
	size_t warnings;
	char **warning;
	size_t file_room, material_room, shape_room, light_room, warning_room;
};

void spec_scene_free(struct spec_scene *scene);

/* Frees what a spectrum holds; an empty one is allowed. */
void spec_scene_spectrum_free(struct spec_scene_spectrum *spectrum);

/* Puts "file:line:column: " before the message that is there. */
void spec_scene_prefix(const struct spec_scene *scene, const struct spec_scene_place *place,
	struct spec_error *error);

/* spec_error_set, with the place before the message. A null error is allowed. */
enum spec_status spec_scene_fail(const struct spec_scene *scene,
	const struct spec_scene_place *place, struct spec_error *error,
	enum spec_status status, const char *format, ...)
	__attribute__((format(printf, 5, 6)));

/* Adds a warning, unless there is one of the same text already, from any place. SPEC_ENOMEM. */
enum spec_status spec_scene_warn(struct spec_scene *scene,
	const struct spec_scene_place *place, struct spec_error *error, const char *format,
	...) __attribute__((format(printf, 4, 5)));

#endif
