/* What false colours show: Stokes components, expressions and layers, as numbers. */
#include <math.h>
#include <stdlib.h>

#include "colour/observer.h"
#include "compare/view.h"

#include "check.h"

#define DEG (3.14159265358979323846 / 180)

enum { BANDS = 3, WIDTH = 5 };

static const double wavelengths[BANDS] = {450, 550, 650};

/* Polarised light, reflectance, and channels beside; made once. */
static struct spec_image light, reflectance;
static struct spec_curve observer;

static int
make_images(void **state)
{
	static const char *const more[] = {"N.X", "N.Y", "N.Z", "film1.uv", "film1.u",
		"film1.v", "id", "film1.mirror.S0.450nm", "film1.mirror.S0.550nm",
		"film1.mirror.S0.650nm", "P.X", "P.Y"};
	struct spec_error error;

	(void)state;
	for (size_t i = 0; i < COUNT(more); i++) {
		if (spec_image_add_channel(&light, more[i],
			    strcmp(more[i], "id") ? SPEC_SAMPLE_FLOAT : SPEC_SAMPLE_UINT,
			    &error) != SPEC_OK)
			return -1;
	}
	light.data = light.display = reflectance.data = reflectance.display =
		(struct spec_window){0, 0, WIDTH, 1};
	return spec_image_add_bands(&light, SPEC_ROLE_EMISSIVE, 4, wavelengths, BANDS,
		       SPEC_SAMPLE_FLOAT, &error) != SPEC_OK ||
	       spec_image_add_bands(&reflectance, SPEC_ROLE_REFLECTIVE, 1, wavelengths,
		       BANDS, SPEC_SAMPLE_FLOAT, &error) != SPEC_OK ||
	       spec_image_index(&light, "light.exr", &error) != SPEC_OK ||
	       spec_image_index(&reflectance, "paint.exr", &error) != SPEC_OK ||
	       spec_observer_load("1931", &observer, &error) != SPEC_OK;
}

static int
clear_images(void **state)
{
	(void)state;
	spec_image_clear(&light);
	spec_image_clear(&reflectance);
	spec_curve_free(&observer);
	return 0;
}

/* The numbers of a row in which every channel of the view has the value that of says. */
static void
run(const struct spec_view *view,
	double (*of)(const struct spec_channel *channel, size_t x), float *to)
{
	static float sample[64][WIDTH];
	const float *row[64];
	void *scratch =
		aligned_alloc(64, (spec_view_scratch(view, WIDTH) + 63) / 64 * 64 + 64);

	assert_non_null(scratch);
	assert_in_range(view->terms, 0, 64);
	for (size_t i = 0; i < view->terms; i++) {
		const struct spec_channel *channel =
			&view->image->channel[view->channel[i]];

		for (size_t x = 0; x < WIDTH; x++) {
			double value = of(channel, x);
			uint32_t whole = (uint32_t)value;

			sample[i][x] = (float)value;
			if (channel->sample == SPEC_SAMPLE_UINT)
				memcpy(&sample[i][x], &whole, sizeof whole);
		}
		row[i] = sample[i];
	}
	spec_view_row(view, row, WIDTH, 0, scratch, to);
	free(scratch);
}

static double
tell(const char *name, const double stokes[4])
{
	return spec_stokes_find(name, NULL)->of(stokes);
}

/* Light of a degree, made of an ellipse at an angle (Born & Wolf, 1.4.2, (45)). */
static void
test_ellipses(void **state)
{
	(void)state;
	for (double degree = .1; degree <= 1; degree += .3) {
		for (double angle = 1; angle < 180; angle += 13) {
			for (double turn = -45; turn <= 44; turn += 14.75) {
				const double s[4] = {7,
					7 * degree * cos(2 * turn * DEG) *
						cos(2 * angle * DEG),
					7 * degree * cos(2 * turn * DEG) *
						sin(2 * angle * DEG),
					7 * degree * sin(2 * turn * DEG)};

				near(tell("dop", s), degree, 1e-14, "dop");
				near(tell("dolp", s), degree * cos(2 * turn * DEG), 1e-14,
					"dolp");
				near(tell("docp", s), fabs(degree * sin(2 * turn * DEG)),
					1e-14, "docp");
				near(tell("ellipticity", s), turn, 1e-11, "ellipticity");
				if (turn > -45)
					near(tell("aop", s), angle, 1e-11, "aop");
			}
		}
	}
}

/* What has no value is no number; and where an angle begins again. */
static void
test_no_polarisation(void **state)
{
	static const double plain[] = {1, 0, 0, 0}, dark[] = {0, 0, 0, 0},
			    circular[] = {1, 0, 0, -1}, flat[] = {1, 1, 0, 0},
			    upright[] = {1, -1, 0, 0}, below[] = {1, 1, -1e-9, 0};

	(void)state;
	near(tell("dop", plain), 0, 0, "dop");
	assert_true(isnan(tell("aop", plain)));
	assert_true(isnan(tell("aop", circular)));
	assert_true(isnan(tell("ellipticity", plain)));
	near(tell("ellipticity", circular), -45, 1e-12, "ellipticity");
	assert_true(isnan(tell("dop", dark)));
	near(tell("aop", flat), 0, 0, "aop");
	near(tell("aop", upright), 90, 1e-12, "aop");
	near(tell("aop", below), 180, 1e-6, "aop");
}

static double
stokes_of(const struct spec_channel *channel, size_t x)
{
	/* 450 nm is polarised at 0, 550 nm at 45 degrees, 650 nm circularly. */
	static const double s[BANDS][4] = {{2, 1, 0, 0}, {4, 0, 1, 0}, {8, 0, 0, -4}};
	int band = (int)lround((channel->wavelength_nm - 450) / 100);

	return s[band][channel->stokes] * (double)(x + 1);
}

static void
check_view(const struct spec_view_setup *setup, double wanted, double tolerance)
{
	struct spec_error error = {0};
	struct spec_view view;
	float to[WIDTH];

	if (spec_view_make(&view, &light, "light.exr", setup, &error) != SPEC_OK)
		fail_msg("%s", error.message);
	assert_int_equal(view.numbers, 1);
	run(&view, stokes_of, to);
	for (size_t x = 0; x < WIDTH; x++)
		near(to[x], wanted, tolerance, "view");
	spec_view_free(&view);
}

/* Of one band, and of all as the observer sees them: here computed by the sums themselves. */
static void
test_polarised_bands(void **state)
{
	struct spec_view_setup setup = {.observer = &observer};
	const struct spec_bands bands = {BANDS, wavelengths, NULL, 0};
	double weight[3 * BANDS], outside, i, q, u, v;
	const double *y = weight + BANDS;

	(void)state;
	setup.polarisation = spec_stokes_find("dop", NULL);
	setup.band_nm = 450;
	check_view(&setup, .5, 1e-6);
	setup.band_nm = 650.0002;
	check_view(&setup, .5, 1e-6);
	setup.polarisation = spec_stokes_find("aop", NULL);
	setup.band_nm = 550;
	check_view(&setup, 45, 1e-5);

	assert_int_equal(
		spec_observer_weights(&observer, NULL, &bands, weight, &outside, NULL), 0);
	i = 2 * y[0] + 4 * y[1] + 8 * y[2];
	q = y[0];
	u = y[1];
	v = -4 * y[2];
	setup.band_nm = 0;
	check_view(&setup, atan2(u, q) / 2 / DEG, 1e-5);
	setup.polarisation = spec_stokes_find("dop", NULL);
	check_view(&setup, sqrt(q * q + u * u + v * v) / i, 1e-6);
	setup.polarisation = spec_stokes_find("docp", NULL);
	check_view(&setup, -v / i, 1e-6);
	setup.polarisation = spec_stokes_find("ellipticity", NULL);
	check_view(&setup, atan2(v, hypot(q, u)) / 2 / DEG, 1e-5);
}

static void
test_expressions(void **state)
{
	struct spec_view_setup setup = {.expression = "b650 / b450"};

	(void)state;
	check_view(&setup, 4, 1e-6);
	setup.expression = "a / b450 + nm";
	setup.band_nm = 550;
	check_view(&setup, 552, 1e-4);
	setup.expression = "7";
	check_view(&setup, 7, 0);
}

static void
refused(const struct spec_image *image, const struct spec_view_setup *setup,
	enum spec_status status, const char *part)
{
	struct spec_error error = {0};
	struct spec_view view;

	assert_int_equal(spec_view_make(&view, image, "f.exr", setup, &error), status);
	assert_contains(error.message, part);
	assert_null(view.channel);
}

static void
test_refused(void **state)
{
	const struct spec_stokes_number *dop = spec_stokes_find("dop", NULL);
	struct spec_error error = {0};

	(void)state;
	refused(&reflectance, &(struct spec_view_setup){.polarisation = dop}, SPEC_ERANGE,
		"f.exr: is not polarised");
	refused(&light, &(struct spec_view_setup){.polarisation = dop, .band_nm = 500},
		SPEC_ERANGE, "f.exr: has no band at 500 nm; the nearest is at 450 nm");
	refused(&light, &(struct spec_view_setup){.band_nm = 500}, SPEC_ERANGE,
		"no band at 500 nm");
	refused(&light, &(struct spec_view_setup){.expression = "1 + a"}, SPEC_EUSAGE,
		"of which band?");
	refused(&light, &(struct spec_view_setup){.expression = "nm"}, SPEC_EUSAGE,
		"of which band?");
	refused(&light, &(struct spec_view_setup){.expression = "a.Q"}, SPEC_EUSAGE,
		"f.exr has no channel 'Q'");
	assert_null(spec_stokes_find("s1", &error));
	assert_contains(error.message, "dop, dolp, docp, aop or ellipticity");
}

/* --- layers --- */

static void
finds(const char *name, enum spec_layer_kind kind, const char *first, const char *last)
{
	struct spec_image chosen = {0};
	struct spec_error error = {0};
	struct spec_layer layer;
	size_t parts = kind == SPEC_LAYER_VECTOR ? 3 : kind == SPEC_LAYER_PLANE ? 2 : 1;

	if (spec_layer_find(&layer, &light, "f.exr", name, &chosen, &error) != SPEC_OK)
		fail_msg("%s", error.message);
	assert_int_equal(layer.kind, kind);
	assert_string_equal(light.channel[layer.channel[0]].name, first);
	assert_string_equal(light.channel[layer.channel[parts - 1]].name, last);
}

static void
test_layers(void **state)
{
	struct spec_image chosen = {0};
	struct spec_error error = {0};
	struct spec_layer layer;

	(void)state;
	finds("N", SPEC_LAYER_VECTOR, "N.X", "N.Z");
	finds("N.Y", SPEC_LAYER_CHANNEL, "N.Y", "N.Y");
	finds("id", SPEC_LAYER_CHANNEL, "id", "id");
	finds("film1.uv", SPEC_LAYER_CHANNEL, "film1.uv",
		"film1.uv"); /* it has that name */
	assert_int_equal(
		spec_layer_find(&layer, &light, "f.exr", "film1.mirror", &chosen, &error),
		SPEC_OK);
	assert_int_equal(layer.kind, SPEC_LAYER_BANDS);
	assert_int_equal(chosen.bands, BANDS);
	assert_int_equal(chosen.stokes, 1);
	assert_int_equal(chosen.channels, light.channels);
	for (size_t i = 0; i < BANDS; i++) {
		near(chosen.wavelength_nm[i], wavelengths[i], 0, "wavelength");
		assert_int_equal(strncmp(light.channel[chosen.band_channel[i]].name,
					 "film1.mirror.S0.", 16),
			0);
	}
	spec_image_clear(&chosen);
	/* A vector is whole or none. */
	assert_int_equal(spec_layer_find(&layer, &light, "f.exr", "P", &chosen, &error),
		SPEC_EUSAGE);
	assert_contains(error.message,
		"f.exr: has no layer 'P'; it has N, P.X, P.Y, film1.mirror, film1.u, ");
	assert_int_equal(
		spec_layer_find(&layer, &reflectance, "f.exr", "N", &chosen, &error),
		SPEC_EUSAGE);
	assert_contains(error.message, "and none besides its bands");
}

static double
tenths(const struct spec_channel *channel, size_t x)
{
	return channel->name[strlen(channel->name) - 1] - 'a' + (double)x / 8;
}

/* Vectors and whole numbers as they are; u and v have no third. */
static void
test_layer_numbers(void **state)
{
	struct spec_image chosen = {0};
	struct spec_layer layer;
	struct spec_view_setup setup = {.layer = &layer};
	struct spec_view view;
	float to[3 * WIDTH];

	(void)state;
	spec_layer_find(&layer, &light, "f.exr", "N", &chosen, NULL);
	assert_int_equal(spec_view_make(&view, &light, "f.exr", &setup, NULL), SPEC_OK);
	assert_int_equal(view.numbers, 3);
	near(view.low, -1, 0, "low");
	near(view.high, 1, 0, "high");
	run(&view, tenths, to);
	for (size_t i = 0; i < 3; i++)
		for (size_t x = 0; x < WIDTH; x++)
			near(to[i * WIDTH + x], 'X' + (double)i - 'a' + (double)x / 8, 1e-6,
				"component");
	spec_view_free(&view);

	spec_layer_find(&layer, &light, "f.exr", "id", &chosen, NULL);
	assert_int_equal(spec_view_make(&view, &light, "f.exr", &setup, NULL), SPEC_OK);
	assert_int_equal(view.numbers, 1);
	near(view.high - view.low, 0, 0, "scale");
	run(&view, tenths, to);
	near(to[0], 'd' - 'a', 0, "id");
	spec_view_free(&view);

	layer.kind = SPEC_LAYER_PLANE;
	layer.channel[0] = spec_image_find_channel(&light, "film1.u");
	layer.channel[1] = spec_image_find_channel(&light, "film1.v");
	layer.base = "uv";
	assert_int_equal(spec_view_make(&view, &light, "f.exr", &setup, NULL), SPEC_OK);
	assert_int_equal(view.numbers, 3);
	near(view.low, 0, 0, "low");
	near(view.high, 1, 0, "high");
	run(&view, tenths, to);
	near(to[0], 'u' - 'a', 0, "u");
	near(to[WIDTH], 'v' - 'a', 0, "v");
	near(to[2 * WIDTH + 3], 0, 0, "nothing");
	spec_view_free(&view);
}

int
main(void)
{
	const struct CMUnitTest tests[] = {
		cmocka_unit_test(test_ellipses),
		cmocka_unit_test(test_no_polarisation),
		cmocka_unit_test(test_polarised_bands),
		cmocka_unit_test(test_expressions),
		cmocka_unit_test(test_refused),
		cmocka_unit_test(test_layers),
		cmocka_unit_test(test_layer_numbers),
	};

	return cmocka_run_group_tests(tests, make_images, clear_images);
}
