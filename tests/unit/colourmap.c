/* The colours of maps. */
#include <math.h>

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

static double
lightness(double share)
{
	double linear[3], matrix[9], xyz[3], white[3], lab[3];
	const struct spec_space *space = spec_space_find("srgb", NULL);
	unsigned char rgb[3];

	spec_colourmap_viridis(share, rgb);
	for (int c = 0; c < 3; c++)
		linear[c] = spec_srgb_decode(rgb[c] / 255.);
	assert_int_equal(spec_space_to_xyz(space, matrix, NULL), 0);
	spec_matrix_apply(matrix, linear, xyz);
	spec_white_xyz(space->white_xy, white);
	spec_lab_from_xyz(xyz, white, lab);
	return lab[0];
}

/* Lighter with every step; the published map goes from L* 15 to 91 in nearly even steps. */
static void
test_viridis_lightness(void **state)
{
	(void)state;
	for (int i = 0; i <= 20; i++) {
		near(lightness(i / 20.), 15 + 76 * i / 20., 3, "lightness");
		assert_true(i == 0 || lightness(i / 20.) > lightness((i - 1) / 20.));
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

int
main(void)
{
	const struct CMUnitTest tests[] = {
		cmocka_unit_test(test_viridis_published),
		cmocka_unit_test(test_viridis_lightness),
		cmocka_unit_test(test_viridis_outside),
	};

	return cmocka_run_group_tests(tests, NULL, NULL);
}
