/* Pictures of all that is around: directions of places, and pixels around directions. */
#include <stdlib.h>

#include "image/projection.h"

#include "check.h"

#define PI 3.14159265358979323846

static const struct spec_panorama all[] = {
	{SPEC_PROJECTION_LATLONG, 64, 32},
	{SPEC_PROJECTION_CROSS, 64, 48},
	{SPEC_PROJECTION_TALL_CROSS, 48, 64},
	{SPEC_PROJECTION_OCTAHEDRAL, 36, 36},
};

static void
is_direction(const struct spec_panorama *panorama, double x, double y, double dx, double dy,
	double dz)
{
	double d[3], length = sqrt(dx * dx + dy * dy + dz * dz);

	assert_true(spec_panorama_direction(panorama, x, y, d));
	near(d[0], dx / length, 1e-14, "x");
	near(d[1], dy / length, 1e-14, "y");
	near(d[2], dz / length, 1e-14, "z");
}

/* The middles of faces, and edges at which they meet. */
static void
test_directions(void **state)
{
	const struct spec_panorama *latlong = &all[0], *cross = &all[1], *tall = &all[2],
				   *square = &all[3];
	double d[3];

	(void)state;
	is_direction(latlong, 0, 16, 1, 0, 0);
	is_direction(latlong, 16, 16, 0, 1, 0);
	is_direction(latlong, 32, 16, -1, 0, 0);
	is_direction(latlong, 48, 16, 0, -1, 0);
	is_direction(latlong, 7, 0, 0, 0, 1);
	is_direction(latlong, 8, 8, 1, 1, sqrt(2));

	is_direction(cross, 24, 24, 1, 0, 0);
	is_direction(cross, 40, 24, 0, 1, 0);
	is_direction(cross, 56, 24, -1, 0, 0);
	is_direction(cross, 8, 24, 0, -1, 0);
	is_direction(cross, 24, 8, 0, 0, 1);
	is_direction(cross, 24, 40, 0, 0, -1);
	is_direction(cross, 24, 16, 1, 0, 1); /* +x above, and +z below */
	is_direction(cross, 24, 16 - 1e-15 * 16, 1, 0, 1);
	is_direction(cross, 32, 24, 1, 1, 0);
	is_direction(cross, 28, 20, 2, 1, 1);
	is_direction(cross, 28, 44, -1, 1, -2);
	assert_false(spec_panorama_direction(cross, 8, 8, d));
	assert_false(spec_panorama_direction(cross, 40, 8, d));
	assert_false(spec_panorama_direction(cross, 56, 40, d));

	is_direction(tall, 24, 24, 1, 0, 0);
	is_direction(tall, 40, 24, 0, 1, 0);
	is_direction(tall, 8, 24, 0, -1, 0);
	is_direction(tall, 24, 8, 0, 0, 1);
	is_direction(tall, 24, 40, 0, 0, -1);
	is_direction(tall, 24, 56, -1, 0, 0);
	is_direction(tall, 24, 48, -1, 0, -1); /* what is behind begins below */
	is_direction(tall, 28, 60, -2, 1, 1);
	assert_false(spec_panorama_direction(tall, 8, 56, d));

	/* pbrt-v4's: the middle is up, the middles of the sides are the horizon's axes */
	is_direction(square, 18, 18, 0, 0, 1);
	is_direction(square, 36, 18, 1, 0, 0);
	is_direction(square, 18, 36, 0, 1, 0);
	is_direction(square, 0, 18, -1, 0, 0);
	is_direction(square, 36, 36, 0, 0, -1);
	is_direction(square, 27, 27, 1, 1, 0);
}

/* Equal parts of the square are equal solid angles: half of it lies within .25 of the middle. */
static void
test_square_has_equal_areas(void **state)
{
	enum { SIDE = 199, CAPS = 8 };
	struct spec_panorama square = {SPEC_PROJECTION_OCTAHEDRAL, SIDE, SIDE};
	int above[CAPS] = {0};

	(void)state;
	for (int y = 0; y < SIDE; y++) {
		for (int x = 0; x < SIDE; x++) {
			double d[3];

			spec_panorama_direction(&square, x + .5, y + .5, d);
			near(d[0] * d[0] + d[1] * d[1] + d[2] * d[2], 1, 1e-14, "length");
			for (int i = 0; i < CAPS; i++)
				above[i] += d[2] > 1 - 2 * (i + 1.) / CAPS;
		}
	}
	/*
	 * No pixel lies on the horizon. A cap of height h has h / 2 of all; its rim crosses
	 * about 2 SIDE pixels, a hundredth.
	 */
	for (int i = 0; i < CAPS; i++)
		near(above[i] / (double)(SIDE * SIDE), (i + 1.) / CAPS, .005, "cap");
}

/* A pixel's own middle is that pixel. */
static void
test_there_and_back(void **state)
{
	(void)state;
	for (size_t k = 0; k < COUNT(all); k++) {
		size_t shown = 0;

		for (size_t y = 0; y < all[k].height; y++) {
			for (size_t x = 0; x < all[k].width; x++) {
				struct spec_panorama_blend blend;
				double d[3], part = 0;

				if (!spec_panorama_direction(
					    &all[k], (double)x + .5, (double)y + .5, d))
					continue;
				shown++;
				blend = spec_panorama_around(&all[k], d);
				for (size_t i = 0; i < 4; i++)
					part += blend.pixel[i] == y * all[k].width + x
							? blend.part[i]
							: 0;
				near(part, 1, 1e-10, "part");
			}
		}
		assert_int_equal(shown, k == 1 || k == 2 ? all[k].width * all[k].height / 2
							 : all[k].width * all[k].height);
	}
}

static double
unit(void)
{
	return rand() / (RAND_MAX + 1.);
}

/*
 * What is linear in the direction comes back but for the curvature of the layout, everywhere: a
 * wrong neighbour across an edge, a pole or a corner is off by a pixel's step. The square has
 * edges in its middle, at which a step turns. The parts add
 * up to 1, and their pixels show something.
 */
static void
test_linear(void **state)
{
	(void)state;
	srand(7);
	for (size_t k = 0; k < COUNT(all); k++) {
		double step = PI / 2 / 16; /* between pixels' middles, at most 1.3 of it */

		for (int n = 0; n < 200000; n++) {
			double z = 2 * unit() - 1, turn = 2 * PI * unit(), sum = 0,
			       found = 0;
			double d[3] = {sqrt(1 - z * z) * cos(turn),
				sqrt(1 - z * z) * sin(turn), z};
			struct spec_panorama_blend blend;

			if (n % 4 == 0) { /* near an axis, an edge or a corner, too */
				for (int i = 0; i < 3; i++)
					d[i] = floor(3 * unit() - 1) + 1e-3 * unit();
				z = sqrt(d[0] * d[0] + d[1] * d[1] + d[2] * d[2]);
				for (int i = 0; i < 3; i++)
					d[i] /= z;
			}
			blend = spec_panorama_around(&all[k], d);
			for (size_t i = 0; i < 4; i++) {
				double e[3];
				size_t x = blend.pixel[i] % all[k].width,
				       y = blend.pixel[i] / all[k].width;

				assert_true(blend.part[i] >= 0);
				assert_in_range(y, 0, all[k].height - 1);
				assert_true(spec_panorama_direction(
					&all[k], (double)x + .5, (double)y + .5, e));
				sum += blend.part[i];
				found += blend.part[i] * (e[0] + 2 * e[1] + 3 * e[2]);
				if (blend.part[i] > 0)
					assert_true(
						e[0] * d[0] + e[1] * d[1] + e[2] * d[2] >
						cos((k == 3 ? 3.5 : 2.2) * step));
			}
			near(sum, 1, 1e-12, "parts");
			near(found, d[0] + 2 * d[1] + 3 * d[2],
				sqrt(14) * (k == 3 ? .5 : .6 * step) * step,
				"a linear function");
		}
	}
}

static void
test_shapes(void **state)
{
	struct spec_panorama panorama, other;
	struct spec_error error = {0};

	(void)state;
	for (size_t k = 0; k < COUNT(all); k++) {
		assert_int_equal(
			spec_panorama_of(all[k].width, all[k].height, &panorama, &error),
			SPEC_OK);
		assert_int_equal(panorama.projection, all[k].projection);
		other = spec_panorama_like(&panorama, panorama.projection, 0);
		assert_int_equal(other.width, all[k].width);
		assert_int_equal(other.height, all[k].height);
		other = spec_panorama_like(&all[0], all[k].projection, 0);
		assert_int_equal(other.width, k == 3 ? 37 : all[k].width);
		other = spec_panorama_like(&panorama, SPEC_PROJECTION_CROSS, 96);
		assert_int_equal(other.width, 128);
	}
	assert_int_equal(spec_panorama_of(63, 48, &panorama, &error), SPEC_EUNSUPPORTED);
	assert_contains(error.message, "63 x 48 pixels: what is all around has 2:1");
	assert_int_equal(spec_panorama_of(5, 3, &panorama, &error), SPEC_EUNSUPPORTED);
}

static void
test_names(void **state)
{
	static const char *const wrong[] = {"", "cube", "cros", "crosses",
		"cross:", "cross:0", "cross:100", "cross:96x", "tall-cross:98",
		"latlong:65537", ":96"};
	enum spec_projection projection;
	struct spec_error error = {0};
	size_t height;

	(void)state;
	assert_int_equal(
		spec_projection_parse("tall-cross:96", &projection, &height, &error),
		SPEC_OK);
	assert_int_equal(projection, SPEC_PROJECTION_TALL_CROSS);
	assert_int_equal(height, 96);
	assert_int_equal(
		spec_projection_parse("octahedral", &projection, &height, &error), SPEC_OK);
	assert_int_equal(projection, SPEC_PROJECTION_OCTAHEDRAL);
	assert_int_equal(height, 0);
	for (size_t i = 0; i < COUNT(wrong); i++)
		assert_int_not_equal(
			spec_projection_parse(wrong[i], &projection, &height, &error),
			SPEC_OK);
}

int
main(void)
{
	const struct CMUnitTest tests[] = {
		cmocka_unit_test(test_directions),
		cmocka_unit_test(test_square_has_equal_areas),
		cmocka_unit_test(test_there_and_back),
		cmocka_unit_test(test_linear),
		cmocka_unit_test(test_shapes),
		cmocka_unit_test(test_names),
	};

	return cmocka_run_group_tests(tests, NULL, NULL);
}
