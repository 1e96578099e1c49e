#include "render/camera.h"

#include <math.h>

#include "render/through.h"

void
spec_camera_make(
	struct spec_camera *camera, const struct spec_scene *scene, int width, int height)
{
	double aspect = (double)width / height, half = tan(scene->fov_deg * M_PI / 360);
	double x = aspect > 1 ? aspect : 1, y = aspect > 1 ? 1 : 1 / aspect;
	double window[4] = {-x, x, -y, y};

	*camera = (struct spec_camera){scene, width, height, {0}};
	for (int i = 0; i < 4; i++)
		camera->screen[i] =
			half * (scene->has_screen ? scene->screen[i] : window[i]);
}

/* pbrt's spherical camera: y is the pole, and columns go from x by z. */
static struct spec_vector
look_around(double right, double down)
{
	double azimuth = 2 * M_PI * right, polar = M_PI * down;

	return (struct spec_vector){
		sin(polar) * cos(azimuth), cos(polar), sin(polar) * sin(azimuth)};
}

struct spec_ray
spec_camera_ray(
	const struct spec_camera *camera, double x, double y, struct spec_sampler *sampler)
{
	const struct spec_scene *scene = camera->scene;
	const double *s = camera->screen;
	struct spec_vector origin = {0, 0, 0};
	struct spec_vector direction = {s[0] + (s[1] - s[0]) * x / camera->width,
		s[3] - (s[3] - s[2]) * y / camera->height, 1};

	if (scene->all_around)
		direction = look_around(x / camera->width, y / camera->height);
	else if (scene->lens_radius > 0) {
		struct spec_vector focus =
			spec_vector_scale(direction, scene->focal_distance);
		double pair[2], radius, angle;

		spec_sampler_pair(sampler, pair);
		radius = scene->lens_radius * sqrt(pair[0]);
		angle = 2 * M_PI * pair[1];
		origin = (struct spec_vector){radius * cos(angle), radius * sin(angle), 0};
		direction = spec_vector_subtract(focus, origin);
	}
	return (struct spec_ray){spec_through_point(scene->camera.m, origin),
		spec_vector_unit(spec_through_direction(scene->camera.m, direction))};
}
