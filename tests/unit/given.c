/* What users tell of bands. */
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "image/given.h"

#include "check.h"

static void
lists_and_grids_of_wavelengths(void **state)
{
	static const struct {
		const char *text;
		size_t count;
		double first_nm, last_nm;
		const char *part; /* of the message */
	} cases[] = {{"400:700:10", 31, 400, 700, NULL}, {"400", 1, 400, 400, NULL},
		{"400nm,.5um,6e-7m", 3, 400, 600, NULL},
		{NULL, 2, 0, 0, "file: does not say of which wavelengths its 2 bands are"},
		{"400,500,600", 2, 0, 0, "file: has 2 bands, and --wavelengths gives 3"},
		{"500,400", 2, 0, 0, "do not ascend at 400 nm"},
		{"400,400", 2, 0, 0, "do not ascend"}, {"400,", 2, 0, 0, "wavelength"},
		{",400", 2, 0, 0, "wavelength"}, {"400,5x", 2, 0, 0, "5x"},
		{"", 1, 0, 0, "wavelength"}, {"700:400:10", 2, 0, 0, "700:400:10"},
		{"0000000000000000000000000000000000000000000000000000000000000000000400,500",
			2, 0, 0, "longer"}};

	(void)state;
	for (size_t i = 0; i < COUNT(cases); i++) {
		struct spec_settings settings = {.wavelengths = cases[i].text};
		struct spec_error error = {0};
		struct spec_grid grid;
		enum spec_status status = spec_given_wavelengths(
			&settings, cases[i].count, "file", &grid, &error);

		if (cases[i].part) {
			if (status == SPEC_OK)
				fail_msg("was taken: %s", cases[i].text);
			assert_contains(error.message, cases[i].part);
			assert_int_equal(grid.count, 0);
			continue;
		}
		assert_int_equal(status, SPEC_OK);
		assert_int_equal(grid.count, cases[i].count);
		near(grid.wavelength_nm[0], cases[i].first_nm, 1e-9, cases[i].text);
		near(grid.wavelength_nm[grid.count - 1], cases[i].last_nm, 1e-9,
			cases[i].text);
		spec_grid_free(&grid);
	}
}

static enum spec_status
apply(struct spec_image *image, const char *map, enum spec_role read_as,
	struct spec_error *error)
{
	static const char *const names[] = {"S0.400,000000nm", "blue", "red", "w"};
	struct spec_settings settings = {.name_map = map, .read_as = read_as};

	*image = (struct spec_image){0};
	for (size_t i = 0; i < COUNT(names); i++)
		assert_int_equal(
			spec_image_add_channel(image, names[i], SPEC_SAMPLE_FLOAT, NULL),
			SPEC_OK);
	return spec_given_apply(image, &settings, "file", error);
}

static void
names_get_wavelengths(void **state)
{
	struct spec_image image;

	(void)state;
	assert_int_equal(
		apply(&image, "red=650nm,blue=.45um", SPEC_ROLE_OTHER, NULL), SPEC_OK);
	assert_int_equal(image.channel[1].role, SPEC_ROLE_EMISSIVE);
	near(image.channel[1].wavelength_nm, 450, 1e-9, "blue");
	near(image.channel[2].wavelength_nm, 650, 1e-9, "red");
	assert_int_equal(image.channel[3].role, SPEC_ROLE_OTHER);
	spec_image_clear(&image);
	/* Of two inputs the map may be for the other, where this one has bands. */
	assert_int_equal(apply(&image, "green=550", SPEC_ROLE_OTHER, NULL), SPEC_OK);
	spec_image_clear(&image);
}

static void
what_does_not_fit_is_refused(void **state)
{
	static const struct {
		const char *map;
		enum spec_role read_as;
		const char *part;
	} cases[] = {{"red=650,red=600", SPEC_ROLE_OTHER, "'red' is mapped twice"},
		{"S0.400,000000nm=500", SPEC_ROLE_OTHER, "not NAME=WAVELENGTH"},
		{"red", SPEC_ROLE_OTHER, "not NAME=WAVELENGTH"},
		{"=5", SPEC_ROLE_OTHER, "not NAME=WAVELENGTH"},
		{"red=650xyz", SPEC_ROLE_OTHER, "wavelength"},
		{NULL, SPEC_ROLE_REFLECTIVE, "its names say that it is radiance"}};

	(void)state;
	for (size_t i = 0; i < COUNT(cases); i++) {
		struct spec_error error = {0};
		struct spec_image image;

		if (apply(&image, cases[i].map, cases[i].read_as, &error) == SPEC_OK)
			fail_msg("was taken: %s", cases[i].map);
		assert_int_equal(error.status, SPEC_EUSAGE);
		assert_contains(error.message, cases[i].part);
		spec_image_clear(&image);
	}
}

int
main(void)
{
	const struct CMUnitTest tests[] = {
		cmocka_unit_test(lists_and_grids_of_wavelengths),
		cmocka_unit_test(names_get_wavelengths),
		cmocka_unit_test(what_does_not_fit_is_refused),
	};

	return cmocka_run_group_tests(tests, NULL, NULL);
}
