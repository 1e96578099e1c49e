/*
 * Where rays of a film go, by pbrt-v4's conventions: the camera looks along +z of its own
 * space, x is to the right and y upwards, in a left-handed world; pixels are counted from
 * the film's upper left corner.
 */
#include <stdio.h>

#include "render/camera.h"
#include "scene/parse.h"

#include "check.h"

#define PI 3.14159265358979323846
#define ROUNDED 1e-12

struct view {
	struct spec_scene scene;
	struct spec_camera camera;
	struct spec_sampler sampler;
};

/* The camera of statements before WorldBegin, with a film of that many pixels. */
static void
open_view(struct view *view, const char *statements, int width, int height)
{
	struct spec_error error;
	char text[1024];

	assert_true(strlen(statements) + 16 < sizeof text);
	snprintf(text, sizeof text, "%s WorldBegin", statements);
	if (spec_scene_parse(&view->scene, text, strlen(text), "t.pbrt", &error) != SPEC_OK)
		fail_msg("%s: %s", text, error.message);
	spec_camera_make(&view->camera, &view->scene, width, height);
	spec_sampler_start(&view->sampler, 1, 0, 0, 0);
}

static void
close_view(struct view *view)
{
	spec_scene_free(&view->scene);
}

static struct spec_ray
ray_at(struct view *view, double x, double y)
{
	return spec_camera_ray(&view->camera, x, y, &view->sampler);
}

static void
expect_vector(struct spec_vector value, struct spec_vector wanted, double bound,
	const char *what, double x, double y)
{
	if (!(fabs(value.x - wanted.x) <= bound && fabs(value.y - wanted.y) <= bound &&
		    fabs(value.z - wanted.z) <= bound))
		fail_msg("%s, film at %g, %g: (%.15g %.15g %.15g) instead of (%.15g %.15g "
			 "%.15g)",
			what, x, y, value.x, value.y, value.z, wanted.x, wanted.y,
			wanted.z);
}

/* The ray at a point of the film begins at from and goes along a vector of any length. */
static void
expect_ray(struct view *view, double x, double y, struct spec_vector from,
	struct spec_vector along, const char *what)
{
	struct spec_ray ray = ray_at(view, x, y);
	double length = sqrt(along.x * along.x + along.y * along.y + along.z * along.z);

	expect_vector(ray.origin, from, ROUNDED, what, x, y);
	expect_vector(ray.direction,
		(struct spec_vector){along.x / length, along.y / length, along.z / length},
		ROUNDED, what, x, y);
}

static const struct spec_vector eye = {0, 0, 0};

/* --- the film --- */

/*
 * Without a Camera the fov is 90 degrees: the screen at z = 1 goes from -1 to 1 both ways.
 * Its upper left corner is where x and y of the film are 0.
 */
static void
test_corners(void **state)
{
	static const char *const same[] = {
		"", "Camera \"perspective\"", "Camera \"perspective\" \"float fov\" 90"};
	struct view view;

	(void)state;
	for (size_t i = 0; i < COUNT(same); i++) {
		open_view(&view, same[i], 2, 2);
		expect_ray(&view, 1, 1, eye, (struct spec_vector){0, 0, 1}, "middle");
		expect_ray(&view, 0, 0, eye, (struct spec_vector){-1, 1, 1}, "left, top");
		expect_ray(&view, 2, 0, eye, (struct spec_vector){1, 1, 1}, "right, top");
		expect_ray(
			&view, 0, 2, eye, (struct spec_vector){-1, -1, 1}, "left, below");
		expect_ray(
			&view, 2, 2, eye, (struct spec_vector){1, -1, 1}, "right, below");
		expect_ray(&view, 2, 1, eye, (struct spec_vector){1, 0, 1}, "right");
		expect_ray(&view, 1, 0, eye, (struct spec_vector){0, 1, 1}, "top");
		close_view(&view);
	}
}

/*
 * The slopes x/z at the right edge's middle and y/z at the upper edge's, and the opposite.
 */
static void
expect_window(struct view *view, const double window[4], const char *what)
{
	double w = view->camera.width, h = view->camera.height;
	double x = (window[0] + window[1]) / 2, y = (window[2] + window[3]) / 2;

	expect_ray(view, 0, h / 2, eye, (struct spec_vector){window[0], y, 1}, what);
	expect_ray(view, w, h / 2, eye, (struct spec_vector){window[1], y, 1}, what);
	expect_ray(view, w / 2, h, eye, (struct spec_vector){x, window[2], 1}, what);
	expect_ray(view, w / 2, 0, eye, (struct spec_vector){x, window[3], 1}, what);
	expect_ray(view, w / 2, h / 2, eye, (struct spec_vector){x, y, 1}, what);
}

/*
 * "The spread angle of the viewing frustum along the narrower of the image's width and
 * height": half of it has the slope tan(fov / 2), and the longer side as many times that as
 * it is longer. tan 30 = 1 / sqrt 3, tan 45 = 1, tan 60 = sqrt 3, tan 22.5 = sqrt 2 - 1.
 */
static void
test_fov_is_of_the_shorter_side(void **state)
{
	static const struct {
		double fov_deg;
		int width, height;
		double x, y;
	} films[] = {
		{60, 100, 100, .57735026918962576, .57735026918962576},
		{60, 200, 100, 1.15470053837925153, .57735026918962576},
		{60, 100, 200, .57735026918962576, 1.15470053837925153},
		{90, 1920, 1080, 16. / 9, 1},
		{90, 1080, 1920, 1, 16. / 9},
		{120, 3, 7, 1.73205080756887729, 7 / 3. * 1.73205080756887729},
		{120, 7, 3, 7 / 3. * 1.73205080756887729, 1.73205080756887729},
		{45, 1, 1, .41421356237309505, .41421356237309505},
		{45, 5, 1, 5 * .41421356237309505, .41421356237309505},
		{45, 1, 5, .41421356237309505, 5 * .41421356237309505},
	};
	struct view view;

	(void)state;
	for (size_t i = 0; i < COUNT(films); i++) {
		char text[80];
		double x = films[i].x, y = films[i].y, window[4] = {-x, x, -y, y};

		snprintf(text, sizeof text, "Camera \"perspective\" \"float fov\" %g",
			films[i].fov_deg);
		open_view(&view, text, films[i].width, films[i].height);
		snprintf(text, sizeof text, "%g degrees, %d x %d", films[i].fov_deg,
			films[i].width, films[i].height);
		expect_window(&view, window, text);
		close_view(&view);
	}
}

/*
 * Pixels are squares on a plane across the view, not on a sphere. tan(53.13 degrees / 2) =
 * 1/2: at z = 1 a film of 8 x 4 has pixels of 1/4, and its upper left corner is (-1, 1/2).
 */
static void
test_pixels_are_squares_on_a_plane(void **state)
{
	struct view view;

	(void)state;
	open_view(&view, "Camera \"perspective\" \"float fov\" 53.130102354155979", 8, 4);
	for (int j = 0; j < 4; j++) {
		for (int i = 0; i < 8; i++) {
			struct spec_vector along = {
				-1 + (i + .5) / 4, .5 - (j + .5) / 4, 1};

			expect_ray(&view, i + .5, j + .5, eye, along, "a pixel");
		}
	}
	close_view(&view);
}

/* Finer pixels of the same picture, as --supersample has them. */
static void
test_resolution_is_no_shape(void **state)
{
	static const char text[] = "LookAt 3 1 2 0 0 0 0 1 0 Camera \"perspective\" "
				   "\"float fov\" 40 \"float lensradius\" .1 "
				   "\"float focaldistance\" 3";
	struct view coarse, fine;

	(void)state;
	open_view(&coarse, text, 30, 20);
	open_view(&fine, text, 120, 80);
	for (int i = 0; i < 20; i++) {
		double x = 30 * fmod(i * .618, 1), y = 20 * fmod(i * .414, 1);
		struct spec_ray a, b;

		spec_sampler_start(&coarse.sampler, 3, i, 0, 0);
		spec_sampler_start(&fine.sampler, 3, i, 0, 0);
		a = ray_at(&coarse, x, y);
		b = ray_at(&fine, 4 * x, 4 * y);
		expect_vector(b.origin, a.origin, ROUNDED, "origin", x, y);
		expect_vector(b.direction, a.direction, ROUNDED, "direction", x, y);
	}
	close_view(&coarse);
	close_view(&fine);
}

/*
 * The ratio takes the place of the film's: of 2, the screen is -2..2 by -1..1 times
 * tan(fov / 2), on any film, whose pixels are no squares then. screenwindow comes before
 * it.
 */
static void
test_screens(void **state)
{
	static const struct {
		const char *text;
		double window[4];
	} screens[] = {
		{"\"float frameaspectratio\" 2", {-2, 2, -1, 1}},
		{"\"float frameaspectratio\" 1", {-1, 1, -1, 1}},
		{"\"float frameaspectratio\" .5", {-1, 1, -2, 2}},
		/* tan 22.5 = sqrt 2 - 1 */
		{"\"float frameaspectratio\" .5 \"float fov\" 45",
			{-.41421356237309505, .41421356237309505, -.82842712474619010,
				.82842712474619010}},
		/* x0 x1 y0 y1: y0 is below, and is the film's last row. */
		{"\"float screenwindow\" [-1 .5 0 2]", {-1, .5, 0, 2}},
		{"\"float screenwindow\" [2 3 -5 -4]", {2, 3, -5, -4}},
		{"\"float screenwindow\" [-1 1 -1 1]", {-1, 1, -1, 1}},
		{"\"float screenwindow\" [-2 1 0 2] \"float fov\" 45",
			{-.82842712474619010, .41421356237309505, 0, .82842712474619010}},
		{"\"float screenwindow\" [-1 .5 0 2] \"float frameaspectratio\" 2",
			{-1, .5, 0, 2}},
	};
	static const int films[][2] = {{100, 100}, {300, 100}, {50, 200}};
	struct view view;

	(void)state;
	for (size_t i = 0; i < COUNT(screens); i++) {
		for (size_t j = 0; j < COUNT(films); j++) {
			char text[160];

			snprintf(text, sizeof text, "Camera \"perspective\" %s",
				screens[i].text);
			open_view(&view, text, films[j][0], films[j][1]);
			expect_window(&view, screens[i].window, text);
			close_view(&view);
		}
	}
}

/* --- the camera's place --- */

/*
 * What stands before Camera takes world to camera. So the camera's axes in the world are
 * what the inverse makes of x, y and z; the first ones are read off pbrt's LookAt: forward
 * goes from eye to look, right = up x forward, and up is made perpendicular.
 */
static const struct place {
	const char *text;
	struct spec_vector eye, right, up, forward;
} places[] = {
	{"", {0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}},
	{"LookAt 0 0 0  0 0 1  0 1 0", {0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}},
	/* y x -z = -x */
	{"LookAt 1 2 3  1 2 -1  0 1 0", {1, 2, 3}, {-1, 0, 0}, {0, 1, 0}, {0, 0, -1}},
	/* y x (.6 0 .8) = (.8 0 -.6) */
	{"LookAt 0 0 0  3 0 4  0 2 0", {0, 0, 0}, {.8, 0, -.6}, {0, 1, 0}, {.6, 0, .8}},
	/* y x (0 -.8 .6) = (.6 0 0); up = forward x right = (0 -.8 .6) x (1 0 0) */
	{"LookAt 1 1 1  1 -3 4  0 1 0", {1, 1, 1}, {1, 0, 0}, {0, .6, .8}, {0, -.8, .6}},
	/* With z upwards: z x x = y, and z x y = -x. */
	{"LookAt 0 0 0  1 0 0  0 0 1", {0, 0, 0}, {0, 1, 0}, {0, 0, 1}, {1, 0, 0}},
	{"LookAt 0 -5 0  0 0 0  0 0 1", {0, -5, 0}, {-1, 0, 0}, {0, 0, 1}, {0, 1, 0}},
	/* Mirrored, as for scenes of right-handed programs: x is what was -x. */
	{"Scale -1 1 1 LookAt 0 -5 0  0 0 0  0 0 1", {0, -5, 0}, {1, 0, 0}, {0, 0, 1},
		{0, 1, 0}},
	/* The world is moved first: the eye stands less those 1 2 3 where it stood. */
	{"LookAt 1 2 3  1 2 -1  0 1 0 Translate 1 2 3", {0, 0, 0}, {-1, 0, 0}, {0, 1, 0},
		{0, 0, -1}},
	/* Moved last: the eye is at (-1 -2 -3) of what LookAt alone has as its space. */
	{"Translate 1 2 3 LookAt 1 2 3  1 2 -1  0 1 0", {2, 0, 6}, {-1, 0, 0}, {0, 1, 0},
		{0, 0, -1}},
	/* z goes to x and x to -z; backwards x goes to z and z to -x. */
	{"Rotate 90 0 1 0", {0, 0, 0}, {0, 0, 1}, {0, 1, 0}, {-1, 0, 0}},
	{"Rotate 90 1 0 0", {0, 0, 0}, {1, 0, 0}, {0, 0, -1}, {0, 1, 0}},
	{"Rotate 90 0 0 1", {0, 0, 0}, {0, -1, 0}, {1, 0, 0}, {0, 0, 1}},
	/* p / 2 - (.5 1 1.5), and p / 2 - (1 2 3). */
	{"Translate 1 2 3 Scale 2 2 2", {-.5, -1, -1.5}, {.5, 0, 0}, {0, .5, 0},
		{0, 0, .5}},
	{"Scale 2 2 2 Translate 1 2 3", {-1, -2, -3}, {.5, 0, 0}, {0, .5, 0}, {0, 0, .5}},
	/* Lengths are kept for what is between the axes: the view gets narrower. */
	{"Scale 2 1 1", {0, 0, 0}, {.5, 0, 0}, {0, 1, 0}, {0, 0, 1}},
	/* Columns: x to z, y to y, z to -x, and then (1 2 3) is added. */
	{"Transform [0 0 1 0  0 1 0 0  -1 0 0 0  1 2 3 1]", {-3, -2, 1}, {0, 0, -1},
		{0, 1, 0}, {1, 0, 0}},
};

/* From the camera's space to the world. */
static struct spec_vector
in_world(const struct place *place, double x, double y, double z)
{
	const struct spec_vector *r = &place->right, *u = &place->up, *f = &place->forward;

	return (struct spec_vector){x * r->x + y * u->x + z * f->x,
		x * r->y + y * u->y + z * f->y, x * r->z + y * u->z + z * f->z};
}

static void
test_places(void **state)
{
	struct view view;

	(void)state;
	for (size_t i = 0; i < COUNT(places); i++) {
		const struct place *place = &places[i];
		char text[160];

		snprintf(text, sizeof text, "%s Camera \"perspective\"", place->text);
		open_view(&view, text, 4, 2);
		expect_ray(&view, 2, 1, place->eye, place->forward, place->text);
		expect_ray(&view, 3, 1, place->eye, in_world(place, 1, 0, 1), place->text);
		expect_ray(&view, 2, 0, place->eye, in_world(place, 0, 1, 1), place->text);
		expect_ray(&view, .5, 1.75, place->eye, in_world(place, -1.5, -.75, 1),
			place->text);
		close_view(&view);
	}
}

/* Left-handed: where +y is up and +z goes away from the eye, +x is to the right. */
static void
test_handedness(void **state)
{
	static const char text[] = "LookAt 0 0 -5  0 0 0  0 1 0 Camera \"perspective\"";
	struct view view;

	(void)state;
	open_view(&view, text, 100, 100);
	/* (2 1 0) is 5 away, at the slopes 2/5 and 1/5: 20 pixels right, 10 up. */
	expect_ray(&view, 70, 40, (struct spec_vector){0, 0, -5},
		(struct spec_vector){2, 1, 5}, "a point of the plane z = 0");
	close_view(&view);
}

/* --- the thin lens --- */

#define LENS ".25"
#define FOCUS "4"
static const double lens = .25, focus = 4;

static double
along(struct spec_vector a, struct spec_vector b)
{
	return a.x * b.x + a.y * b.y + a.z * b.z;
}

/* A ray in the camera's space, whose axes are perpendicular and of one length. */
static struct spec_ray
in_camera(const struct place *place, struct spec_ray ray)
{
	const struct spec_vector *axis[3] = {&place->right, &place->up, &place->forward};
	struct spec_vector from = {ray.origin.x - place->eye.x, ray.origin.y - place->eye.y,
		ray.origin.z - place->eye.z};
	double square = along(place->up, place->up);

	return (struct spec_ray){
		{along(from, *axis[0]) / square, along(from, *axis[1]) / square,
			along(from, *axis[2]) / square},
		{along(ray.direction, *axis[0]) / square,
			along(ray.direction, *axis[1]) / square,
			along(ray.direction, *axis[2]) / square}};
}

/*
 * Rays begin on a disc in the plane z = 0 of the camera, of the radius of the lens. In the
 * plane z = focaldistance all those of a point of the film meet where the ray through the
 * lens' middle is: at the slopes of the screen times that distance.
 */
static void
expect_focus(struct view *view, const struct place *place, double x, double y)
{
	/* A fov of 90 degrees, and a film of 6 x 4. */
	struct spec_vector wanted = {focus * (x - 3) / 2, focus * (2 - y) / 2, focus};
	double lowest[2] = {1, 1}, highest[2] = {-1, -1};

	for (uint32_t i = 0; i < 256; i++) {
		struct spec_ray ray;
		double t;

		spec_sampler_start(&view->sampler, 1, (int)x, (int)y, i);
		ray = ray_at(view, x, y);
		near(sqrt(along(ray.direction, ray.direction)), 1, ROUNDED, place->text);
		ray = in_camera(place, ray);
		near(ray.origin.z, 0, ROUNDED, place->text);
		assert_true(hypot(ray.origin.x, ray.origin.y) <= lens * (1 + ROUNDED));
		assert_true(ray.direction.z > 0);
		t = focus / ray.direction.z;
		expect_vector((struct spec_vector){ray.origin.x + t * ray.direction.x,
				      ray.origin.y + t * ray.direction.y,
				      ray.origin.z + t * ray.direction.z},
			wanted, ROUNDED, place->text, x, y);
		lowest[0] = fmin(lowest[0], ray.origin.x);
		highest[0] = fmax(highest[0], ray.origin.x);
		lowest[1] = fmin(lowest[1], ray.origin.y);
		highest[1] = fmax(highest[1], ray.origin.y);
	}
	/* The whole of the lens is used. */
	for (int i = 0; i < 2; i++)
		assert_true(lowest[i] < -.9 * lens && highest[i] > .9 * lens);
}

/* In a scaled world the lens and the distance are lengths of the camera's space. */
static void
test_lens_focus(void **state)
{
	static const double film[][2] = {{3, 2}, {0, 0}, {6, 4}, {1.25, 3.5}, {4.1, .3}};
	struct view view;

	(void)state;
	for (size_t i = 0; i < COUNT(places); i++) {
		char text[240];

		if (along(places[i].right, places[i].right) !=
			along(places[i].up, places[i].up))
			continue; /* what in_camera cannot do */
		snprintf(text, sizeof text,
			"%s Camera \"perspective\" \"float lensradius\" " LENS
			" \"float focaldistance\" " FOCUS,
			places[i].text);
		open_view(&view, text, 6, 4);
		for (size_t j = 0; j < COUNT(film); j++)
			expect_focus(&view, &places[i], film[j][0], film[j][1]);
		close_view(&view);
	}
}

/*
 * The focus is no part of the field of view: with another fov the plane is as far off.
 * And it is a plane, not a sphere: z, not the distance, is focaldistance. tan 30 = 1 / sqrt
 * 3: the film's right edge is 10 / sqrt 3 to the right at z = 10.
 */
static void
test_lens_and_fov(void **state)
{
	struct view view;

	(void)state;
	open_view(&view,
		"Camera \"perspective\" \"float fov\" 60 \"float lensradius\" 2 "
		"\"float focaldistance\" 10",
		2, 2);
	for (uint32_t i = 0; i < 64; i++) {
		struct spec_ray ray;
		double t;

		spec_sampler_start(&view.sampler, 1, 0, 0, i);
		ray = ray_at(&view, 2, 1);
		t = 10 / ray.direction.z;
		near(ray.origin.x + t * ray.direction.x, 5.77350269189625765, ROUNDED * 10,
			"x in focus");
		near(ray.origin.y + t * ray.direction.y, 0, ROUNDED * 10, "y in focus");
	}
	close_view(&view);
}

/* focaldistance is 1e6 by default, and says nothing where there is no lens. */
static void
test_lens_defaults(void **state)
{
	struct view view;

	(void)state;
	open_view(&view, "Camera \"perspective\" \"float lensradius\" 1000", 2, 2);
	for (uint32_t i = 0; i < 64; i++) {
		struct spec_ray ray;

		spec_sampler_start(&view.sampler, 1, 0, 0, i);
		ray = ray_at(&view, 1, 1);
		assert_true(ray.origin.x != 0 && ray.origin.y != 0);
		near(ray.direction.x / ray.direction.z, -ray.origin.x / 1e6, ROUNDED,
			"x/z");
		near(ray.direction.y / ray.direction.z, -ray.origin.y / 1e6, ROUNDED,
			"y/z");
	}
	close_view(&view);
	open_view(&view, "Camera \"perspective\" \"float focaldistance\" 3", 2, 2);
	for (uint32_t i = 0; i < 64; i++) {
		spec_sampler_start(&view.sampler, 1, 0, 0, i);
		expect_ray(&view, 2, 0, eye, (struct spec_vector){1, 1, 1}, "no lens");
	}
	close_view(&view);
}

/* --- how the lens is filled --- */

/* Rings of equal areas, cut into as many sectors. */
#define RINGS 8
#define PIXELS 40000

/*
 * A lens is uniform if each cell of equal area has its share. Pixels are independent: a
 * count of n in p has a standard deviation of sqrt(n p (1 - p)), and 5 of them are left by
 * one in 1.7 million; the sum of squares over the 64 cells, each over its variance, is 63
 * on average with a deviation of sqrt(126). Seeds are fixed.
 */
static void
test_lens_is_uniform(void **state)
{
	static unsigned count[RINGS][RINGS];
	double share = 1. / (RINGS * RINGS), deviation, squares = 0, ends[2] = {1, 0};
	struct view view;

	(void)state;
	memset(count, 0, sizeof count);
	open_view(&view,
		"Camera \"perspective\" \"float lensradius\" " LENS
		" \"float focaldistance\" " FOCUS,
		6, 4);
	for (int i = 0; i < PIXELS; i++) {
		struct spec_vector at;
		double area, turn;

		spec_sampler_start(&view.sampler, 8, i % 200, i / 200, 5);
		at = ray_at(&view, 1, 3).origin;
		/* 0 to 1: the part of the lens that is nearer to its middle; and the angle. */
		area = (at.x * at.x + at.y * at.y) / (lens * lens);
		turn = atan2(at.y, at.x) / (2 * PI) + .5;
		assert_true(area >= 0 && area <= 1 + ROUNDED);
		ends[0] = fmin(ends[0], area);
		ends[1] = fmax(ends[1], area);
		count[(int)fmin(RINGS * area, RINGS - 1)]
		     [(int)fmin(RINGS * turn, RINGS - 1)]++;
	}
	assert_true(ends[0] < .001 && ends[1] > .999);
	deviation = sqrt(PIXELS * share * (1 - share));
	for (int i = 0; i < RINGS; i++) {
		for (int j = 0; j < RINGS; j++) {
			double off = (count[i][j] - PIXELS * share) / deviation;

			near(off, 0, 5, "a cell's count in deviations");
			squares += off * off;
		}
	}
	near(squares, 63, 5 * sqrt(126), "all cells");
	close_view(&view);
}

/*
 * The samples of one pixel fill it evenly. Of 64 independent points the mean is off the
 * middle by 1/8 of the lens' deviation, which is radius / sqrt 2: .088 radii in the mean
 * square. Of even ones it is far less.
 */
static void
test_lens_is_filled_evenly(void **state)
{
	double square = 0;
	struct view view;

	(void)state;
	open_view(&view, "Camera \"perspective\" \"float lensradius\" " LENS, 1, 1);
	for (int pixel = 0; pixel < 100; pixel++) {
		double x = 0, y = 0;

		for (uint32_t i = 0; i < 64; i++) {
			struct spec_vector at;

			spec_sampler_start(&view.sampler, 2, pixel, 0, i);
			at = ray_at(&view, .5, .5).origin;
			x += at.x / lens / 64;
			y += at.y / lens / 64;
		}
		square += (x * x + y * y) / 100;
	}
	if (!(sqrt(square) < .03))
		fail_msg("the mean of 64 points is %g radii off", sqrt(square));
	close_view(&view);
}

/* The same numbers give the same ray, and another sample another one. */
static void
test_lens_is_the_samplers(void **state)
{
	struct spec_ray first, again, other;
	struct view view;

	(void)state;
	open_view(&view, "Camera \"perspective\" \"float lensradius\" " LENS, 1, 1);
	spec_sampler_start(&view.sampler, 2, 3, 4, 5);
	first = ray_at(&view, .2, .3);
	other = ray_at(&view, .2, .3);
	spec_sampler_start(&view.sampler, 2, 3, 4, 5);
	again = ray_at(&view, .2, .3);
	assert_memory_equal(&again, &first, sizeof first);
	assert_memory_not_equal(&other, &first, sizeof first);
	close_view(&view);
}

/* --- all around --- */

#define AROUND "Camera \"spherical\" \"string mapping\" \"equirectangular\""

/*
 * pbrt has theta = pi y / height and phi = 2 pi x / width, (sin theta cos phi,
 * sin theta sin phi, cos theta), and then y and z in each other's place. So rows go from +y
 * down to -y, and columns from +x by +z, -x and -z back to +x.
 */
static void
test_around_axes(void **state)
{
	static const int films[][2] = {{4, 2}, {400, 200}, {3, 7}, {1, 1}};
	struct view view;

	(void)state;
	for (size_t i = 0; i < COUNT(films); i++) {
		double w = films[i][0], h = films[i][1];

		open_view(&view, AROUND, films[i][0], films[i][1]);
		for (int column = 0; column <= 4; column++) {
			static const struct spec_vector sides[] = {
				{1, 0, 0}, {0, 0, 1}, {-1, 0, 0}, {0, 0, -1}, {1, 0, 0}};
			double x = column * w / 4;

			expect_ray(&view, x, h / 2, eye, sides[column], "the equator");
			expect_ray(&view, x, 0, eye, (struct spec_vector){0, 1, 0}, "top");
			expect_ray(
				&view, x, h, eye, (struct spec_vector){0, -1, 0}, "bottom");
		}
		/* Half-way between: theta and phi are 45 degrees, or 135 or 225. */
		expect_ray(&view, w / 8, h / 2, eye, (struct spec_vector){1, 0, 1},
			"between x and z");
		expect_ray(&view, w / 4, h / 4, eye, (struct spec_vector){0, 1, 1},
			"between y and z");
		expect_ray(&view, w / 4, 3 * h / 4, eye, (struct spec_vector){0, -1, 1},
			"between z and -y");
		expect_ray(&view, 5 * w / 8, 3 * h / 4, eye,
			(struct spec_vector){-1, -1.41421356237309505, -1}, "below, back");
		close_view(&view);
	}
}

/*
 * Of 8 x 4 pixels the first one's middle is at 22.5 degrees from the pole and 22.5 from
 * +x: s = sin 22.5 and c = cos 22.5 give (s c, c, s s). The one of column 5 and row 2 is at
 * 112.5 degrees from the pole, of sine c and cosine -s, and at 247.5 from +x, of sine -c
 * and cosine -s.
 */
static void
test_around_pixels(void **state)
{
	const double s = .38268343236508977, c = .92387953251128676;
	struct view view;

	(void)state;
	open_view(&view, AROUND, 8, 4);
	expect_ray(&view, .5, .5, eye, (struct spec_vector){s * c, c, s * s}, "0, 0");
	expect_ray(&view, 7.5, .5, eye, (struct spec_vector){s * c, c, -s * s}, "7, 0");
	expect_ray(&view, .5, 3.5, eye, (struct spec_vector){s * c, -c, s * s}, "0, 3");
	expect_ray(&view, 5.5, 2.5, eye, (struct spec_vector){-c * s, -s, -c * c}, "5, 2");
	close_view(&view);
}

/* It has the camera's place, and no screen, fov or lens: of an earlier Camera or at all. */
static void
test_around_places(void **state)
{
	struct view view;

	(void)state;
	for (size_t i = 0; i < COUNT(places); i++) {
		const struct place *place = &places[i];
		char text[300];

		snprintf(text, sizeof text,
			"%s Camera \"perspective\" \"float fov\" 20 \"float lensradius\" 1 "
			"\"float screenwindow\" [0 1 0 1] " AROUND,
			place->text);
		open_view(&view, text, 8, 4);
		/* The parser may have left these out already. */
		view.scene.lens_radius = 1;
		view.scene.focal_distance = 2;
		expect_ray(&view, 2, 2, place->eye, place->forward, place->text);
		expect_ray(&view, 0, 2, place->eye, place->right, place->text);
		expect_ray(&view, 1, 0, place->eye, place->up, place->text);
		expect_ray(&view, 1, 2, place->eye, in_world(place, 1, 0, 1), place->text);
		expect_ray(&view, 2, 1, place->eye, in_world(place, 0, 1, 1), place->text);
		close_view(&view);
	}
}

/*
 * What the manual says of pictures of infinite lights, whose columns go from +x by +y
 * around +z and whose rows go down from +z: a camera that looks along +y with +z upwards
 * makes one, but mirrored in x. Its x is z x y = -x.
 */
static void
test_around_makes_skies(void **state)
{
	struct view view;

	(void)state;
	open_view(&view, "LookAt 0 0 0  0 1 0  0 0 1 " AROUND, 8, 4);
	for (int i = 0; i < 8; i++) {
		for (int j = 0; j < 4; j++) {
			double longitude = 2 * PI * (i + .5) / 8;
			double from_pole = PI * (j + .5) / 4;
			struct spec_vector sky = {-sin(from_pole) * cos(longitude),
				sin(from_pole) * sin(longitude), cos(from_pole)};

			expect_ray(&view, i + .5, j + .5, eye, sky, "a sky");
		}
	}
	close_view(&view);
}

int
main(void)
{
	const struct CMUnitTest tests[] = {
		cmocka_unit_test(test_corners),
		cmocka_unit_test(test_fov_is_of_the_shorter_side),
		cmocka_unit_test(test_pixels_are_squares_on_a_plane),
		cmocka_unit_test(test_resolution_is_no_shape),
		cmocka_unit_test(test_screens),
		cmocka_unit_test(test_places),
		cmocka_unit_test(test_handedness),
		cmocka_unit_test(test_lens_focus),
		cmocka_unit_test(test_lens_and_fov),
		cmocka_unit_test(test_lens_defaults),
		cmocka_unit_test(test_lens_is_uniform),
		cmocka_unit_test(test_lens_is_filled_evenly),
		cmocka_unit_test(test_lens_is_the_samplers),
		cmocka_unit_test(test_around_axes),
		cmocka_unit_test(test_around_pixels),
		cmocka_unit_test(test_around_places),
		cmocka_unit_test(test_around_makes_skies),
	};

	return cmocka_run_group_tests_name("camera", tests, NULL, NULL);
}
