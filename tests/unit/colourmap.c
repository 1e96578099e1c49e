/* The colours of maps. */
#include <math.h>
#include <stdlib.h>

#include "colour/colourmap.h"
#include "colour/difference.h"
#include "colour/space.h"

#include "check.h"

/* Published colours, by their number of 256, that are not those between which it goes. */
static void
test_viridis_published(void **state)
{
	static const struct {
		int index;
		double rgb[3];
	} published[] = {
		{0, {.267004, .004874, .329415}},
		{8, {.277018, .050344, .375715}},
		{52, {.252194, .269783, .531579}},
		{128, {.127568, .566949, .550556}},
		{188, {.335885, .777018, .402049}},
		{243, {.876168, .891125, .095250}},
		{248, {.926106, .897330, .104071}},
		{255, {.993248, .906157, .143936}},
	};

	(void)state;
	for (size_t i = 0; i < sizeof published / sizeof *published; i++) {
		unsigned char rgb[3];

		spec_colourmap_viridis(published[i].index / 255., rgb);
		/* half a step of 8 bits, and what straight lines lose */
		for (int c = 0; c < 3; c++)
			near(rgb[c] / 255., published[i].rgb[c], .5 / 255 + .003,
				"viridis");
	}
}

/* Its CIELAB coordinates, from the codes. */
static void
lab_of(const char *map, double share, double lab[3])
{
	double linear[3], matrix[9], xyz[3], white[3];
	const struct spec_space *space = spec_space_find("srgb", NULL);
	unsigned char rgb[3];

	spec_colourmap_find(map, NULL)->colour(share, rgb);
	for (int c = 0; c < 3; c++)
		linear[c] = spec_srgb_decode(rgb[c] / 255.);
	assert_int_equal(spec_space_to_xyz(space, matrix, NULL), 0);
	spec_matrix_apply(matrix, linear, xyz);
	spec_white_xyz(space->white_xy, white);
	spec_lab_from_xyz(xyz, white, lab);
}

static double
lightness(const char *map, double share)
{
	double lab[3];

	lab_of(map, share, lab);
	return lab[0];
}

/* Lighter with every step; the published map goes from L* 15 to 91 in nearly even steps. */
static void
test_viridis_lightness(void **state)
{
	(void)state;
	for (int i = 0; i <= 20; i++) {
		near(lightness("viridis", i / 20.), 15 + 76 * i / 20., 3, "lightness");
		assert_true(i == 0 || lightness("viridis", i / 20.) >
					      lightness("viridis", (i - 1) / 20.));
	}
}

static void
test_viridis_outside(void **state)
{
	unsigned char low[3], high[3], rgb[3];

	(void)state;
	spec_colourmap_viridis(0, low);
	spec_colourmap_viridis(1, high);
	spec_colourmap_viridis(-INFINITY, rgb);
	assert_memory_equal(rgb, low, 3);
	spec_colourmap_viridis(NAN, rgb);
	assert_memory_equal(rgb, low, 3);
	spec_colourmap_viridis(7, rgb);
	assert_memory_equal(rgb, high, 3);
}

/* Even steps of lightness; a code is at most 0.4 of L* in the dark. */
static void
test_grey(void **state)
{
	(void)state;
	for (int i = 0; i <= 20; i++)
		near(lightness("grey", i / 20.), 5 * i, .25, "lightness");
}

/*
 * Moreland's published table of 33 colours, of which some; he computed it by a matrix of
 * other digits, which is at most a code.
 */
static void
test_cool_warm(void **state)
{
	static const struct {
		double share;
		int rgb[3];
	} published[] = {
		{0, {59, 76, 192}},
		{.125, {98, 130, 234}},
		{.25, {141, 176, 254}},
		{.375, {184, 208, 249}},
		{.5, {221, 221, 221}},
		{.625, {245, 196, 173}},
		{.75, {244, 154, 123}},
		{.875, {222, 96, 77}},
		{1, {180, 4, 38}},
	};

	(void)state;
	for (size_t i = 0; i < COUNT(published); i++) {
		unsigned char rgb[3];

		spec_colourmap_cool_warm(published[i].share, rgb);
		for (int c = 0; c < 3; c++)
			near(rgb[c], published[i].rgb[c], 1, "cool-warm");
	}
}

/* Closed, red first, and nothing is clipped: of one lightness in steps of one size. */
static void
test_hue(void **state)
{
	double first[3], last[3], lab[3];

	(void)state;
	lab_of("hue", 0, first);
	lab_of("hue", 1, last);
	near(spec_difference_ab76(first, last), 0, 1e-9, "the ends");
	near(atan2(first[2], first[1]), .4, .2, "red's hue in CIELAB [rad]");
	for (int i = 0; i < 72; i++) {
		unsigned char rgb[3], opposite[3];

		lab_of("hue", i / 72., lab);
		near(lab[0], 71.5, 4, "lightness"); /* OKLab's is not quite CIELAB's */
		spec_colourmap_hue(i / 72., rgb);
		spec_colourmap_hue(fmod(i / 72. + .5, 1), opposite);
		for (int c = 0; c < 3; c++)
			assert_in_range(rgb[c], 1, 254);
		assert_true(abs(rgb[0] - opposite[0]) + abs(rgb[1] - opposite[1]) +
				    abs(rgb[2] - opposite[2]) >
			    100);
	}
}

static void
test_paint(void **state)
{
	const struct spec_colourmap *map = spec_colourmap_find("viridis", NULL);
	static const unsigned char grey[] = {128, 128, 128}, magenta[] = {255, 0, 255};
	unsigned char rgb[3], wanted[3];

	(void)state;
	spec_colourmap_paint(map, -3, -4, 0, rgb);
	spec_colourmap_viridis(.25, wanted);
	assert_memory_equal(rgb, wanted, 3);
	spec_colourmap_paint(map, 1, 4, 0, rgb);
	spec_colourmap_viridis(.75, wanted);
	assert_memory_equal(rgb, wanted, 3);
	spec_colourmap_paint(map, NAN, 0, 1, rgb);
	assert_memory_equal(rgb, grey, 3);
	spec_colourmap_paint(map, INFINITY, 0, 1, rgb);
	assert_memory_equal(rgb, magenta, 3);
	spec_colourmap_paint(map, -INFINITY, 0, 1, rgb);
	assert_memory_equal(rgb, magenta, 3);
}

static void
test_names(void **state)
{
	struct spec_error error = {0};

	(void)state;
	assert_ptr_equal(
		spec_colourmap_find("viridis", &error)->colour, spec_colourmap_viridis);
	assert_null(spec_colourmap_find("jet", &error));
	assert_int_equal(error.status, SPEC_EUSAGE);
	assert_contains(error.message, "viridis, grey, cool-warm or hue");
}

int
main(void)
{
	const struct CMUnitTest tests[] = {
		cmocka_unit_test(test_viridis_published),
		cmocka_unit_test(test_viridis_lightness),
		cmocka_unit_test(test_viridis_outside),
		cmocka_unit_test(test_grey),
		cmocka_unit_test(test_cool_warm),
		cmocka_unit_test(test_hue),
		cmocka_unit_test(test_paint),
		cmocka_unit_test(test_names),
	};

	return cmocka_run_group_tests(tests, NULL, NULL);
}
