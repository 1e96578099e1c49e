/* Daylight in scenes: where the sun is, what a plane gets of it, and how it is chosen. */
#include <stdio.h>
#include <stdlib.h>

#include "place/coordinates.h"
#include "place/instant.h"
#include "place/sun.h"
#include "render/daylight.h"
#include "render/render.h"
#include "scene/parse.h"

#include "check.h"
#include "random.h"

#define PI 3.14159265358979323846
#define RADIANS (PI / 180)
#define MOST_BANDS 64

/* Noon in Leuven, with the sun in the south-east, 49 degrees high. */
#define LEUVEN "\"string place\" \"50.88N 4.70E\" "
#define NOON LEUVEN "\"string time\" \"2005-05-17T12:00:00+02:00\" "
#define LATE LEUVEN "\"string time\" \"2005-05-17T20:30:00+02:00\" " /* 6.6 degrees */
#define DAYLIGHT "LightSource \"daylight\" "

static void
expect_near(double value, double wanted, double tolerance, const char *what)
{
	if (!(fabs(value - wanted) <= tolerance))
		fail_msg(
			"%s: %.9g instead of %.9g +- %.2g", what, value, wanted, tolerance);
}

static void
parse(struct spec_scene *scene, const char *text)
{
	struct spec_error error;

	check(spec_scene_parse(scene, text, strlen(text), "t.pbrt", &error), &error);
}

static void
make_bands(struct spec_bands_grid *bands, const char *text)
{
	struct spec_grid grid;
	struct spec_error error;

	check(spec_grid_parse(text, &grid, &error), &error);
	check(spec_bands_make(bands, &grid, SPEC_EXTRAPOLATE_REFUSE, &error), &error);
	assert_true(bands->count <= MOST_BANDS);
	spec_grid_free(&grid);
}

/* --- scenes --- */

/* The sun of spec_solar_position, whose own tests hold it against an ephemeris. */
static void
test_sun(void **state)
{
	struct spec_place place = {50.88, 4.70, 0};
	const struct spec_scene_daylight *is;
	struct spec_instant instant;
	struct spec_solar solar;
	struct spec_scene scene;
	struct spec_error error;

	(void)state;
	parse(&scene, "WorldBegin " DAYLIGHT NOON);
	is = scene.light[0].daylight;
	check(spec_instant_parse("2005-05-17T10:00:00Z", &instant, &error), &error);
	check(spec_solar_position(&place, &instant, NULL, &solar, &error), &error);
	expect_near(is->sun.zenith_deg, solar.zenith_refracted_deg, 1e-9, "its zenith");
	expect_near(is->sun.azimuth_deg, solar.azimuth_deg, 1e-9, "its azimuth");
	expect_near(is->sun.distance_au, solar.distance_au, 1e-9, "its distance");
	assert_true(is->sunlight.place.latitude_deg == 50.88);
	assert_true(spec_instant_between(&instant, &is->sunlight.instant) == 0);
	assert_true(!scene.has_place && is->has_sun &&
		    is->sunlight.atmosphere.ground_albedo == 0.2);
	assert_true(is->sunlight.atmosphere.turbidity == 3);
	spec_scene_free(&scene);

	parse(&scene, "WorldBegin " DAYLIGHT NOON
		      "\"bool sun\" false \"float turbidity\" 2 \"float albedo\" .7");
	is = scene.light[0].daylight;
	assert_true(!is->has_sun && is->sunlight.atmosphere.ground_albedo == 0.7);
	assert_true(is->sunlight.atmosphere.turbidity == 2);
	spec_scene_free(&scene);

	parse(&scene, "WorldBegin " DAYLIGHT "\"string place\" \"27.99N 86.93E 5300m\" "
		      "\"string time\" \"2005-05-17T12:00:00+06:00\"");
	/* The standard atmosphere's at 5300 m. */
	expect_near(scene.light[0].daylight->sunlight.atmosphere.pressure_hpa, 519, 2,
		"pressure");
	spec_scene_free(&scene);
}

static void
expect_axis(const double axis[3], double x, double y, double z, const char *what)
{
	expect_near(axis[0], x, 1e-12, what);
	expect_near(axis[1], y, 1e-12, what);
	expect_near(axis[2], z, 1e-12, what);
}

/* East is to the right of who looks north, on the picture. */
static void
test_axes(void **state)
{
	static const struct {
		const char *text;
		double east[3], north[3], up[3];
	} cases[] = {
		{"WorldBegin " DAYLIGHT NOON, {1, 0, 0}, {0, 0, 1}, {0, 1, 0}},
		{"Scale -1 1 1 Camera \"perspective\" WorldBegin " DAYLIGHT NOON,
			{-1, 0, 0}, {0, 0, 1}, {0, 1, 0}},
		/* In a space of right hands with z upwards, as most programs have it. */
		{"Scale -1 1 1 LookAt 0 0 0  0 1 0  0 0 1 Camera \"perspective\" "
		 "WorldBegin " DAYLIGHT NOON
		 "\"vector3 up\" [0 0 2] \"vector3 north\" [0 3 1]",
			{1, 0, 0}, {0, 1, 0}, {0, 0, 1}},
		/* The light's space counts, whatever its handedness. */
		{"WorldBegin Rotate 90 1 0 0 " DAYLIGHT NOON, {1, 0, 0}, {0, -1, 0},
			{0, 0, 1}},
		{"WorldBegin Scale -1 2 2 Translate 1 2 3 " DAYLIGHT NOON, {1, 0, 0},
			{0, 0, 1}, {0, 1, 0}},
	};

	(void)state;
	for (size_t i = 0; i < COUNT(cases); i++) {
		const struct spec_scene_daylight *is;
		struct spec_scene scene;

		parse(&scene, cases[i].text);
		is = scene.light[0].daylight;
		expect_axis(is->east, cases[i].east[0], cases[i].east[1], cases[i].east[2],
			cases[i].text);
		expect_axis(is->north, cases[i].north[0], cases[i].north[1],
			cases[i].north[2], cases[i].text);
		expect_axis(is->up, cases[i].up[0], cases[i].up[1], cases[i].up[2],
			cases[i].text);
		spec_scene_free(&scene);
	}
}

/* A camera's direction: world from camera, of z and of x. */
static void
expect_view(const char *text, double bearing_deg, double elevation_deg)
{
	double b = bearing_deg * RADIANS, e = elevation_deg * RADIANS;
	struct spec_scene scene;
	double z[3], x[3];

	parse(&scene, text);
	for (int i = 0; i < 3; i++) {
		z[i] = scene.camera.m[i][2];
		x[i] = scene.camera.m[i][0];
	}
	/* Bearings are good to 1e-4 degrees here. */
	expect_near(z[0], cos(e) * sin(b), 2e-6, text);
	expect_near(z[1], sin(e), 2e-6, text);
	expect_near(z[2], cos(e) * cos(b), 2e-6, text);
	expect_near(x[0], cos(b), 2e-6, text);
	expect_near(x[1], 0, 2e-6, text);
	expect_near(x[2], -sin(b), 2e-6, text);
	spec_scene_free(&scene);
}

static void
test_views(void **state)
{
	struct spec_scene scene;

	(void)state;
	expect_view("Camera \"perspective\" " LEUVEN
		    "\"string toward\" \"52N 4.70E\" WorldBegin",
		0, 0);
	expect_view("Camera \"perspective\" " LEUVEN
		    "\"string toward\" \"40N 4.70E\" \"float elevation\" 30 WorldBegin",
		180, 30);
	/* A quarter of the equator away, which is in the east from wherever one is. */
	expect_view("Camera \"perspective\" \"string place\" \"0N 10E\" "
		    "\"string toward\" \"0N 100E\" \"float elevation\" -5 WorldBegin",
		90, -5);
	/* What stands before puts the eye into east, up and north. */
	parse(&scene, "Translate -5 -1.5 2 Camera \"perspective\" " LEUVEN
		      "\"string toward\" \"40N 4.70E\" WorldBegin");
	expect_near(scene.camera.m[0][3], 5, 1e-9, "the eye");
	expect_near(scene.camera.m[1][3], 1.5, 1e-9, "the eye");
	expect_near(scene.camera.m[2][3], -2, 1e-9, "the eye");
	assert_true(scene.has_place && scene.place.longitude_deg == 4.70);
	spec_scene_free(&scene);
}

static void
test_faults(void **state)
{
	static const struct {
		enum spec_status status;
		const char *text, *message; /* message: its beginning */
	} faults[] = {
		{SPEC_EFORMAT, "WorldBegin " DAYLIGHT LEUVEN,
			"t.pbrt:1:12: LightSource \"daylight\" needs \"string time\""},
		{SPEC_EFORMAT,
			"WorldBegin " DAYLIGHT "\"string time\" \"2005-05-17T12:00Z\"",
			"t.pbrt:1:12: LightSource \"daylight\" needs \"string place\""},
		{SPEC_ERANGE,
			"WorldBegin " DAYLIGHT LEUVEN
			"\"string time\" \"2005-05-17T00:00:00+02:00\"",
			"t.pbrt:1:65: 'time' of LightSource \"daylight\" is refused: at 50.88 N "
			"4.7 E on 2005-05-17T00:00:00+02:00 the sun's centre is 16.6"},
		{SPEC_ERANGE,
			"WorldBegin " DAYLIGHT "\"string place\" \"50.88N 4.70E 21km\" "
			"\"string time\" \"2005-05-17T12:00Z\"",
			"t.pbrt:1:70: 'time' of LightSource \"daylight\" is refused: the "
			"light at an altitude of 21000 m is not known"},
		{SPEC_EUSAGE, "WorldBegin " DAYLIGHT LEUVEN "\"string time\" \"noon\"",
			"t.pbrt:1:65: 'time' of LightSource \"daylight\" is refused: "},
		{SPEC_EUSAGE, "WorldBegin " DAYLIGHT "\"string place\" \"Leuven\"",
			"t.pbrt:1:35: 'place' of LightSource \"daylight\" is refused: "},
		{SPEC_ERANGE, "WorldBegin " DAYLIGHT NOON "\"float turbidity\" 11",
			"t.pbrt:1:107: 'turbidity' of LightSource \"daylight\" is outside "
			"1..10: 11"},
		{SPEC_ERANGE, "WorldBegin " DAYLIGHT NOON "\"float albedo\" 1.5",
			"t.pbrt:1:107: 'albedo' of LightSource \"daylight\" is outside 0..1"},
		{SPEC_ERANGE, "WorldBegin " DAYLIGHT NOON "\"vector3 up\" [0 0 0]",
			"t.pbrt:1:107: 'up' of LightSource \"daylight\" is no direction"},
		{SPEC_ERANGE, "WorldBegin " DAYLIGHT NOON "\"vector3 up\" [0 0 3]",
			"t.pbrt:1:12: LightSource \"daylight\" has up and north in one line"},
		{SPEC_EFORMAT, "WorldBegin " DAYLIGHT NOON "\"spectrum L\" \"D65\"",
			"t.pbrt:1:107: LightSource \"daylight\" has no parameter 'L'"},
		{SPEC_EFORMAT, "Camera \"perspective\" " LEUVEN,
			"t.pbrt:1:1: Camera \"perspective\" needs \"string toward\""},
		{SPEC_EFORMAT, "Camera \"perspective\" \"float elevation\" 3",
			"t.pbrt:1:1: Camera \"perspective\" needs \"string place\""},
		{SPEC_ERANGE,
			"Camera \"perspective\" " LEUVEN
			"\"string toward\" \"50.88N 4.70E\"",
			"t.pbrt:1:52: 'toward' of Camera \"perspective\" is where the camera "
			"is"},
		{SPEC_ERANGE,
			"Camera \"perspective\" " LEUVEN
			"\"string toward\" \"0N 0E\" \"float elevation\" 90",
			"t.pbrt:1:76: 'elevation' of Camera \"perspective\" is outside"},
		{SPEC_EUSAGE,
			"Camera \"perspective\" " LEUVEN "\"string toward\" \"nowhere\"",
			"t.pbrt:1:52: 'toward' of Camera \"perspective\" is refused: "},
		{SPEC_EFORMAT, "Camera \"spherical\" " LEUVEN,
			"t.pbrt:1:20: Camera \"spherical\" has no parameter 'place'"},
	};

	(void)state;
	for (size_t i = 0; i < COUNT(faults); i++) {
		struct spec_error error = {0};
		struct spec_scene scene;
		const char *text = faults[i].text, *wanted = faults[i].message;
		enum spec_status status =
			spec_scene_parse(&scene, text, strlen(text), "t.pbrt", &error);

		if (status != faults[i].status ||
			strncmp(error.message, wanted, strlen(wanted)) != 0)
			fail_msg("%s: status %d, '%s'", text, status, error.message);
	}
}

/* --- radiance --- */

struct fixture {
	struct spec_scene scene;
	struct spec_bands_grid bands;
	struct spec_daylight daylight;
};

static void
open_light(struct fixture *f, const char *text, const char *grid)
{
	struct spec_error error;

	parse(&f->scene, text);
	make_bands(&f->bands, grid);
	check(spec_daylight_make(
		      &f->daylight, f->scene.light[0].daylight, &f->bands, &error),
		&error);
}

static void
close_light(struct fixture *f)
{
	spec_daylight_free(&f->daylight);
	spec_bands_free(&f->bands);
	spec_scene_free(&f->scene);
}

/* The scene's default: x east, y up, z north. */
static struct spec_vector
towards(double azimuth_deg, double elevation_deg)
{
	double a = azimuth_deg * RADIANS, e = elevation_deg * RADIANS;

	return (struct spec_vector){cos(e) * sin(a), sin(e), cos(e) * cos(a)};
}

static void
look(const struct fixture *f, struct spec_vector direction, float *radiance)
{
	float ones[MOST_BANDS];

	for (size_t i = 0; i < f->bands.count; i++) {
		ones[i] = 1;
		radiance[i] = 0;
	}
	spec_daylight_add(&f->daylight, direction, ones, 1, radiance);
}

/* In the sky, on the sun and behind it: the dome's radiance, at its own bands. */
static void
test_radiance(void **state)
{
	struct fixture f;
	double band[SPEC_DOME_BANDS], disc[SPEC_DOME_BANDS];
	float radiance[MOST_BANDS], twice[MOST_BANDS], factor[MOST_BANDS];
	const struct spec_clearsky_sun *sun;

	(void)state;
	open_light(&f, "WorldBegin " DAYLIGHT NOON, "340:700:20");
	sun = &f.scene.light[0].daylight->sun;
	for (int i = 0; i < 40; i++) {
		int column = i % 8, row = i / 8;
		double azimuth = column * 45, elevation = row * 18 + .1;
		double d[3] = {cos(elevation * RADIANS) * sin(azimuth * RADIANS),
			cos(elevation * RADIANS) * cos(azimuth * RADIANS),
			sin(elevation * RADIANS)};

		spec_dome_sky(&f.daylight.dome, d, band);
		look(&f, towards(azimuth, elevation), radiance);
		/* 340 to 360 is between bands, linearly: its bin, too. */
		expect_near(radiance[0], (band[0] + band[1]) / 2, 1e-5 * band[0], "340 nm");
		/* At 400 the bin is a mean of two slopes: 1/8 of each step of 1/4 off. */
		expect_near(radiance[3], band[2] * .875 + (band[1] + band[3]) * .0625,
			1e-4 * band[2], "400 nm");
	}
	look(&f, towards(sun->azimuth_deg, 90 - sun->zenith_deg + .1), radiance);
	look(&f, towards(sun->azimuth_deg, 90 - sun->zenith_deg + .5), twice);
	{
		double e = (90 - sun->zenith_deg + .1) * RADIANS;
		double a = sun->azimuth_deg * RADIANS;
		double d[3] = {cos(e) * sin(a), cos(e) * cos(a), sin(e)};

		assert_true(spec_dome_disc(&f.daylight.dome, d, disc));
		spec_dome_sky(&f.daylight.dome, d, band);
		expect_near(radiance[0], (disc[0] + disc[1] + band[0] + band[1]) / 2,
			1e-5 * disc[1], "the disc at 340 nm");
		assert_true(twice[0] < .01 * radiance[0]);
	}
	for (size_t i = 0; i < f.bands.count; i++) {
		factor[i] = (float)i;
		twice[i] = 1;
	}
	look(&f, towards(100, 30), radiance);
	spec_daylight_add(&f.daylight, towards(100, 30), factor, 2, twice);
	for (size_t i = 0; i < f.bands.count; i++)
		expect_near(twice[i], 1 + 2.0 * (double)i * radiance[i],
			1e-6 * (1 + twice[i]), "with a factor");
	close_light(&f);
}

/* The same on both sides of the sun. */
static void
test_symmetry(void **state)
{
	struct fixture f;
	float left[MOST_BANDS], right[MOST_BANDS];
	double azimuth;

	(void)state;
	open_light(&f, "WorldBegin " DAYLIGHT LATE, "400:700:50");
	azimuth = f.scene.light[0].daylight->sun.azimuth_deg;
	for (int i = 1; i < 12; i++)
		for (double elevation = 5; elevation < 90; elevation += 20) {
			look(&f, towards(azimuth + i * 15, elevation), left);
			look(&f, towards(azimuth - i * 15, elevation), right);
			for (size_t j = 0; j < f.bands.count; j++)
				expect_near(left[j], right[j], 1e-5 * left[j], "a side");
		}
	close_light(&f);
}

/* Outside 300 to 4000 nm there is no light; a bin that reaches out has the rest's share. */
static void
test_ends(void **state)
{
	struct fixture f;
	float radiance[MOST_BANDS];

	(void)state;
	open_light(&f, "WorldBegin " DAYLIGHT NOON, "200:4400:200");
	look(&f, towards(0, 40), radiance);
	assert_true(radiance[0] == 0 && radiance[1] > 0 && radiance[19] > 0);
	assert_true(radiance[20] == 0 && radiance[21] == 0);
	look(&f, towards(0, -40), radiance);
	assert_true(radiance[0] == 0 && radiance[1] > 0 && radiance[20] == 0);
	close_light(&f);
}

/* The sky's irradiance on the ground, in polar rings: another rule than the code's. */
static void
irradiance_of_sky(const struct spec_dome *dome, double irradiance[SPEC_DOME_BANDS])
{
	enum { RINGS = 180, SECTORS = 240 };

	memset(irradiance, 0, SPEC_DOME_BANDS * sizeof *irradiance);
	for (int i = 0; i < RINGS; i++) {
		double polar = (i + .5) / RINGS * PI / 2;
		double weight = sin(polar) * cos(polar) * PI / 2 / RINGS * 2 * PI / SECTORS;

		for (int j = 0; j < SECTORS; j++) {
			double angle = 2 * PI * j / SECTORS, band[SPEC_DOME_BANDS];
			double d[3] = {sin(polar) * cos(angle), sin(polar) * sin(angle),
				cos(polar)};

			spec_dome_sky(dome, d, band);
			for (int k = 0; k < SPEC_DOME_BANDS; k++)
				irradiance[k] += weight * band[k];
		}
	}
}

/* Below the horizon: albedo E / pi, of the sky and of the sun. */
static void
test_ground(void **state)
{
	static const char *const texts[] = {"WorldBegin " DAYLIGHT NOON
					    "\"float albedo\" .5",
		"WorldBegin " DAYLIGHT NOON "\"float albedo\" .5 \"bool sun\" false",
		"WorldBegin " DAYLIGHT LATE "\"float albedo\" .5"};

	(void)state;
	for (size_t i = 0; i < COUNT(texts); i++) {
		struct fixture f;
		double wanted[SPEC_DOME_BANDS];
		float radiance[MOST_BANDS], other[MOST_BANDS];

		open_light(&f, texts[i],
			"340:380:20"); /* three bands between 320, 360 and 400 */
		irradiance_of_sky(&f.daylight.dome, wanted);
		for (int k = 0; k < SPEC_DOME_BANDS && i != 1; k++)
			wanted[k] += f.daylight.dome.disc[k] *
				     spec_dome_disc_sr(&f.daylight.dome) *
				     f.daylight.dome.sun[2];
		look(&f, towards(100, -1e-3), radiance);
		/* Both rules are good to 1e-3 around the sun. */
		expect_near(radiance[0], .5 / PI * (wanted[0] + wanted[1]) / 2,
			2e-3 * radiance[0], texts[i]);
		look(&f, towards(300, -90), other);
		assert_true(radiance[0] == other[0] && radiance[2] == other[2]);
		close_light(&f);
	}
}

/* --- choosing --- */

/* The density is one: over all directions its integral is 1, the sun's disc apart. */
static void
test_density(void **state)
{
	static const char *const texts[] = {"WorldBegin " DAYLIGHT NOON,
		"WorldBegin " DAYLIGHT LATE,
		"WorldBegin " DAYLIGHT NOON "\"bool sun\" false \"float albedo\" 0"};

	(void)state;
	for (size_t i = 0; i < COUNT(texts); i++) {
		enum { ROWS = 512, COLUMNS = 1024 };
		struct fixture f;
		double sum = 0;

		open_light(&f, texts[i], "400:700:100");
		for (int y = 0; y < ROWS; y++)
			for (int x = 0; x < COLUMNS; x++) {
				double e = 90 - (y + .5) / ROWS * 180;
				double density = spec_daylight_density(
					&f.daylight, towards((x + .5) / COLUMNS * 360, e));

				if (density < 100) /* off the disc */
					sum += density * cos(e * RADIANS) * PI / ROWS * 2 *
					       PI / COLUMNS;
			}
		expect_near(sum, 1 - f.daylight.sun_chance, 2e-4, texts[i]);
		assert_true((f.daylight.sun_chance > .25) == (i != 2));
		close_light(&f);
	}
}

/* A choice's density is that which is told of its direction, and the disc gets its share. */
static void
test_samples(void **state)
{
	enum { SAMPLES = 20000 };
	struct fixture f;
	uint64_t seed = 1;
	int on_disc = 0;
	float radiance[MOST_BANDS];
	double sum = 0, squares = 0, mean, deviation;

	(void)state;
	open_light(&f, "WorldBegin " DAYLIGHT NOON, "400:700:100");
	for (int i = 0; i < SAMPLES; i++) {
		struct spec_vector direction;
		double pair[2] = {random_share(&seed), random_share(&seed)}, value = 0;
		double density = spec_daylight_sample(
			&f.daylight, pair, random_share(&seed), &direction);

		expect_near(spec_vector_length(direction), 1, 1e-12, "its length");
		expect_near(spec_daylight_density(&f.daylight, direction), density,
			1e-9 * density, "its density");
		on_disc += density > f.daylight.sun_chance / f.daylight.sun_sr;
		look(&f, direction, radiance);
		for (size_t j = 0; j < f.bands.count; j++)
			value += radiance[j] / (double)f.bands.count;
		sum += value / density;
		squares += value / density * value / density;
	}
	mean = sum / SAMPLES;
	deviation = sqrt((squares / SAMPLES - mean * mean) / SAMPLES);
	expect_near(mean, 4 * PI * f.daylight.mean, 4 * deviation, "all of it");
	assert_true(deviation < .01 * mean);
	expect_near((double)on_disc / SAMPLES, f.daylight.sun_chance,
		4 * sqrt(.25 / SAMPLES), "the disc's share");
	close_light(&f);
}

/* --- a plane --- */

/* Irradiance of a level plane by the path tracer, in each band, and its relative error. */
static double
render_plane(const char *text, const char *grid_text, unsigned samples, double *irradiance,
	struct spec_dome *dome)
{
	struct spec_ray ray = {{0, 1, 0}, {0.6, -0.8, 0}};
	struct spec_settings settings;
	struct spec_render render;
	struct spec_scene scene;
	struct spec_path_room *room;
	struct spec_error error;
	struct spec_grid grid;
	float radiance[MOST_BANDS];
	double square = 0;

	spec_settings_init(&settings);
	parse(&scene, text);
	check(spec_grid_parse(grid_text, &grid, &error), &error);
	check(spec_render_open(&render, &scene,
		      &(struct spec_render_setup){.grid = &grid, .supersample = 1},
		      &settings, &error),
		&error);
	room = spec_path_room_new(grid.count, &error);
	assert_non_null(room);
	memset(irradiance, 0, grid.count * sizeof *irradiance);
	for (unsigned i = 0; i < samples; i++) {
		struct spec_sampler sampler;

		memset(radiance, 0, sizeof radiance);
		spec_sampler_start(&sampler, 1, 0, 0, i);
		spec_path_trace(&render.tracer, &ray, 0, 0, &sampler, room, radiance);
		for (size_t j = 0; j < grid.count; j++)
			irradiance[j] += PI / .6 * radiance[j] / samples;
		square += pow(PI / .6 * radiance[0], 2) / samples;
	}
	check(spec_dome_make(&scene.light[0].daylight->sun,
		      &scene.light[0].daylight->sunlight.atmosphere, dome, &error),
		&error);
	spec_path_room_free(room);
	spec_render_close(&render);
	spec_grid_free(&grid);
	spec_scene_free(&scene);
	return sqrt((square / (irradiance[0] * irradiance[0]) - 1) / samples);
}

#define PLANE                                                                              \
	"Material \"diffuse\" \"float reflectance\" .6 Rotate -90 1 0 0 "                  \
	"Shape \"disk\" \"float radius\" 100"

/* What the dome and the sun send to it; 1 %, more than three times the noise. */
static void
test_plane(void **state)
{
	static const char *const texts[] = {
		"Integrator \"path\" \"integer maxdepth\" 1 WorldBegin " DAYLIGHT NOON
			PLANE,
		"Integrator \"path\" \"integer maxdepth\" 1 WorldBegin " DAYLIGHT LATE
			PLANE,
		"Integrator \"path\" \"integer maxdepth\" 1 WorldBegin " DAYLIGHT NOON
		"\"bool sun\" false \"float scale\" 2 " PLANE};

	(void)state;
	for (size_t i = 0; i < COUNT(texts); i++) {
		double is[3], wanted[SPEC_DOME_BANDS], sigma;
		struct spec_dome dome;

		/* Between the bands of 440, 480 and 520 nm. */
		sigma = render_plane(texts[i], "460:500:20", 65536, is, &dome);
		irradiance_of_sky(&dome, wanted);
		for (int k = 0; k < SPEC_DOME_BANDS; k++)
			wanted[k] = i == 2 ? 2 * wanted[k]
					   : wanted[k] + dome.disc[k] *
								 spec_dome_disc_sr(&dome) *
								 dome.sun[2];
		assert_true(sigma < .003);
		expect_near(is[0], (wanted[3] + wanted[4]) / 2, .01 * is[0], texts[i]);
		expect_near(is[2], (wanted[4] + wanted[5]) / 2, .01 * is[2], texts[i]);
		spec_dome_free(&dome);
	}
}

int
main(void)
{
	const struct CMUnitTest tests[] = {
		cmocka_unit_test(test_sun),
		cmocka_unit_test(test_axes),
		cmocka_unit_test(test_views),
		cmocka_unit_test(test_faults),
		cmocka_unit_test(test_radiance),
		cmocka_unit_test(test_symmetry),
		cmocka_unit_test(test_ends),
		cmocka_unit_test(test_ground),
		cmocka_unit_test(test_density),
		cmocka_unit_test(test_samples),
		cmocka_unit_test(test_plane),
	};

	return cmocka_run_group_tests(tests, NULL, NULL);
}
