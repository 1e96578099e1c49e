#include "render/camera.h"

#include <math.h>

#define PI 3.14159265358979323846

void
spec_camera_make(
	struct spec_camera *camera, const struct spec_scene *scene, int width, int height)
{
	double aspect = (double)width / height, half = tan(scene->fov_deg * PI / 360);
	double x = aspect > 1 ? aspect : 1, y = aspect > 1 ? 1 : 1 / aspect;
	double window[4] = {-x, x, -y, y};

	*camera = (struct spec_camera){scene, width, height, {0}};
	for (int i = 0; i < 4; i++)
		camera->screen[i] =
			half * (scene->has_screen ? scene->screen[i] : window[i]);
}

static struct spec_vector
to_world(const struct spec_transform *camera, struct spec_vector v, int is_point)
{
	const double(*m)[4] = camera->m;
	double w = is_point;

	return (struct spec_vector){
		m[0][0] * v.x + m[0][1] * v.y + m[0][2] * v.z + w * m[0][3],
		m[1][0] * v.x + m[1][1] * v.y + m[1][2] * v.z + w * m[1][3],
		m[2][0] * v.x + m[2][1] * v.y + m[2][2] * v.z + w * m[2][3]};
}

/* pbrt's spherical camera: y is the pole, and columns go from x by z. */
static struct spec_vector
look_around(double right, double down)
{
	double azimuth = 2 * PI * right, polar = PI * down;

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
		angle = 2 * PI * pair[1];
		origin = (struct spec_vector){radius * cos(angle), radius * sin(angle), 0};
		direction = spec_vector_subtract(focus, origin);
	}
	return (struct spec_ray){to_world(&scene->camera, origin, 1),
		spec_vector_unit(to_world(&scene->camera, direction, 0))};
}
