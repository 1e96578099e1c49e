/* What images say of themselves in a text, there and back; and what is no such text. */
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "image/description.h"
#include "image/samples.h"

#include "check.h"

/* Two bands with bins, windows, samples, and a text with line breaks of its own. */
static void
make(struct spec_image *image)
{
	static const double wavelength_nm[] = {450.125, 550}, edges_nm[] = {400, 500, 600};

	*image = (struct spec_image){.data = {-2, 3, 5, 8},
		.display = {0, 0, 10, 10},
		.pixel_aspect_ratio = 1.5F};
	assert_int_equal(spec_image_add_bands(image, SPEC_ROLE_REFLECTIVE, 1, wavelength_nm,
				 2, SPEC_SAMPLE_FLOAT, NULL),
		SPEC_OK);
	assert_int_equal(spec_image_set_bins(image, edges_nm, 2, NULL), SPEC_OK);
	assert_int_equal(spec_samples_set(image, 64, "image", NULL), SPEC_OK);
	assert_int_equal(
		spec_image_set_text(image, "spec:history", "one: 1\n two\n\nthree\n", NULL),
		SPEC_OK);
	assert_int_equal(spec_image_set_text(image, "owner", "nobody", NULL), SPEC_OK);
	assert_int_equal(spec_image_index(image, "image", NULL), SPEC_OK);
}

static void
has_text(const struct spec_image *image, const char *name, const char *wanted)
{
	char *text;

	assert_int_equal(spec_image_text(image, name, &text, NULL), SPEC_OK);
	if (!wanted)
		assert_null(text);
	else
		assert_string_equal(text ? text : "(none)", wanted);
	free(text);
}

/* An image of that size, as a file's reader has it before it reads the description. */
static struct spec_image
of_size(int width, int height)
{
	return (struct spec_image){.data = {0, 0, width, height},
		.display = {0, 0, width, height},
		.pixel_aspect_ratio = 1};
}

static char *
describe(const struct spec_image *image, int band)
{
	struct spec_text text = {0};
	char *copy;

	assert_int_equal(spec_text_open(&text, NULL), SPEC_OK);
	if (band < 0)
		assert_int_equal(spec_description_write(image, &text, NULL), SPEC_OK);
	else
		assert_int_equal(
			spec_description_write_band(image, (size_t)band, &text, NULL),
			SPEC_OK);
	fputc('\0', text.stream);
	assert_int_equal(spec_text_close(&text, NULL), SPEC_OK);
	copy = strdup(text.bytes);
	spec_text_free(&text);
	return copy;
}

static void
all_comes_back(void **state)
{
	struct spec_description said;
	struct spec_image image, back = of_size(7, 5);
	long long samples;
	char *text;

	(void)state;
	make(&image);
	text = describe(&image, -1);
	assert_true(spec_description_is_ours(text));
	assert_int_equal(spec_description_read(text, &back, &said, NULL), SPEC_OK);
	assert_int_equal(said.grid.count, 2);
	near(said.grid.wavelength_nm[0], 450.125, 0, "a wavelength");
	assert_memory_equal(&back.data, &image.data, sizeof back.data);
	assert_memory_equal(&back.display, &image.display, sizeof back.display);
	near(back.pixel_aspect_ratio, 1.5, 0, "the aspect");
	assert_int_equal(spec_samples_get(&back, &samples, "back", NULL), SPEC_OK);
	assert_int_equal(samples, 64);
	has_text(&back, "spec:history", "one: 1\n two\n\nthree\n");
	has_text(&back, "spec:bins", "400 500 600");
	has_text(&back, "spec:quantity", "reflectance");
	has_text(&back, "owner", NULL);
	spec_description_free(&said);
	spec_image_clear(&back);
	spec_image_clear(&image);
	free(text);
}

static void
a_band_has_its_own_bin(void **state)
{
	struct spec_description said;
	struct spec_image image, back = of_size(7, 5);
	char *text;

	(void)state;
	make(&image);
	text = describe(&image, 1);
	assert_int_equal(spec_description_read(text, &back, &said, NULL), SPEC_OK);
	assert_int_equal(said.grid.count, 1);
	near(said.grid.wavelength_nm[0], 550, 0, "the wavelength");
	assert_true(said.has_bin);
	near(said.bin_nm[0], 500, 0, "an edge");
	near(said.bin_nm[1], 600, 0, "an edge");
	has_text(&back, "spec:bins", NULL);
	has_text(&back, "spec:history", "one: 1\n two\n\nthree\n");
	spec_description_free(&said);
	spec_image_clear(&back);
	spec_image_clear(&image);
	free(text);
}

static void
other_texts_are_kept_whole(void **state)
{
	struct spec_description said;
	struct spec_image back = of_size(1, 1);

	(void)state;
	assert_int_equal(
		spec_description_read("spectools are nice", &back, &said, NULL), SPEC_OK);
	has_text(&back, "ImageDescription", "spectools are nice");
	assert_int_equal(said.grid.count, 0);
	assert_int_equal(spec_description_read("", &back, NULL, NULL), SPEC_OK);
	spec_image_clear(&back);
}

static void
bad_ones_are_refused(void **state)
{
	static const struct {
		const char *text, *part;
	} cases[] = {{"spectools\nwavelength_nm: 400 x\n", "wavelengths are none: 'x'"},
		{"spectools\nwavelength_nm: 400 -5\n", "wavelengths are none"},
		{"spectools\nwavelength_nm: 400,5\n", "wavelengths are none"},
		{"spectools\nwavelength_nm: \n", "not 0"},
		{"spectools\ndata_window: 0 0 3 1\n", "speaks of 3 x 1 pixels"},
		{"spectools\ndata_window: 0 0 1\n", "is no window"},
		{"spectools\ndisplay_window: 5 5 5 6\n", "is no window"},
		{"spectools\ndisplay_window: 0 0 1e300 6\n", "is no window"},
		{"spectools\ndisplay_window: 0 0 1.5 6\n", "is no window"},
		{"spectools\npixel_aspect: 0\n", "aspect"},
		{"spectools\nspec:samples: many\n", "number of samples"}};

	(void)state;
	for (size_t i = 0; i < COUNT(cases); i++) {
		struct spec_image back = of_size(2, 1);
		struct spec_error error = {0};
		struct spec_description said;

		if (spec_description_read(cases[i].text, &back, &said, &error) == SPEC_OK)
			fail_msg("was read: %s", cases[i].text);
		assert_contains(error.message, cases[i].part);
		assert_int_equal(said.grid.count, 0);
		spec_image_clear(&back);
	}
}

int
main(void)
{
	const struct CMUnitTest tests[] = {
		cmocka_unit_test(all_comes_back),
		cmocka_unit_test(a_band_has_its_own_bin),
		cmocka_unit_test(other_texts_are_kept_whole),
		cmocka_unit_test(bad_ones_are_refused),
	};

	return cmocka_run_group_tests(tests, NULL, NULL);
}
