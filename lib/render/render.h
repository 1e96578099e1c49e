/*
 * From a scene to a spectral image, line by line: finished radiance, or, where surfaces are
 * deferred, the light that arrives at them and their geometry (specexr(5), light layers).
 */
#ifndef SPEC_RENDER_RENDER_H
#define SPEC_RENDER_RENDER_H

#include "base/error.h"
#include "image/image.h"
#include "image/settings.h"
#include "render/bands.h"
#include "render/camera.h"
#include "render/light.h"
#include "render/material.h"
#include "render/path.h"
#include "render/world.h"
#include "scene/scene.h"
#include "spectrum/grid.h"

#define SPEC_RENDER_MOST_FILMS 16

struct spec_render_setup {
	const struct spec_grid *grid;
	enum spec_extrapolate extrapolate; /* see struct spec_bands_grid */
	int width, height;                 /* of the whole picture; 0: the scene's */
	int samples;                       /* per pixel; 0: the scene's, else 16 */
	int has_crop;
	struct spec_window crop; /* pixels of the picture, half-open */
	long long seed;
	int supersample; /* the layers are so many times finer each way; >= 1 */
	int films;    /* surfaces of thin films that are deferred, from the eye; 0: none */
	int discs;    /* the first surface, where it is a disc, is deferred */
	int geometry; /* the first surface's geometry goes along */
	int variance; /* of each band's mean, beside it; not with films or discs */
	int half;
};

struct spec_render {
	struct spec_render_setup setup;
	const struct spec_scene *scene;
	struct spec_bands_grid bands;
	struct spec_world *world;
	struct spec_material *material;
	struct spec_lights *lights;
	struct spec_camera camera;
	struct spec_tracer tracer;
	struct spec_image image; /* the output's header, indexed */
	size_t lamps;            /* lights that are a point or a direction, if discs */
	size_t *slot;            /* of each channel: its place in a pixel's sums */
	size_t slots;
};

/*
 * Prepares everything but the pixels. scene: must live as long. settings: limits, for
 * pictures that light the scene. Errors: those of the scene's spectra, materials and lights,
 * a crop outside the picture.
 */
enum spec_status spec_render_open(struct spec_render *render,
	const struct spec_scene *scene, const struct spec_render_setup *setup,
	const struct spec_settings *settings, struct spec_error *error);
void spec_render_close(struct spec_render *render);

/* Renders and writes all lines to the settings' output; as spec_image_save. */
enum spec_status spec_render_run(struct spec_render *render,
	const struct spec_settings *settings, unsigned long long *overflows,
	struct spec_error *error);

#endif
