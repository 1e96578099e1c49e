/* Where the rays of a picture begin. */
#ifndef SPEC_RENDER_CAMERA_H
#define SPEC_RENDER_CAMERA_H

#include "render/sampler.h"
#include "render/world.h"
#include "scene/scene.h"

struct spec_camera {
	const struct spec_scene *scene;
	int width, height;
	double screen[4]; /* x0, x1, y0, y1 of the plane at distance 1 */
};

/* width and height of the whole film, in pixels. */
void spec_camera_make(
	struct spec_camera *camera, const struct spec_scene *scene, int width, int height);

/* The ray through a point of the film: x to the right, y downwards, in pixels. */
struct spec_ray spec_camera_ray(
	const struct spec_camera *camera, double x, double y, struct spec_sampler *sampler);

#endif
