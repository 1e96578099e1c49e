/* lib/colour/models: HSV, HSL, YUV and CMYK against published colours, and there and back. */
#include "check.h"

#include "colour/models.h"
#include "random.h"

static const struct spec_model *
model(const char *name)
{
	const struct spec_model *found = spec_model_find(name, NULL);

	assert_non_null(found);
	return found;
}

/* Both ways, to rounding: values are of the model as published, colours as fractions. */
static void
check_pair(const char *name, const double value[4], const double rgb[3], double tolerance)
{
	double got[SPEC_MODEL_MOST];

	spec_model_to_rgb(model(name), value, got);
	for (int i = 0; i < 3; i++)
		near(got[i], rgb[i], tolerance, name);
	spec_model_from_rgb(model(name), rgb, got);
	for (size_t i = 0; i < model(name)->components; i++)
		near(got[i], value[i], tolerance * (model(name)->most[i] > 1 ? 360 : 1),
			name);
}

/* CSS Color Module Level 3, section 4.2.4, its greens among others. */
static void
hsl_of_style_sheets(void **state)
{
	static const double wanted[][7] = {
		{0, 1, .5, 0, 1, 0, 0},
		{120, 1, .5, 0, 0, 1, 0},
		{120, 1, .25, 0, 0, .5, 0},              /* "dark green" */
		{120, 1, .75, 0, .5, 1, .5},             /* "light green" */
		{120, .75, .75, 0, .5625, .9375, .5625}, /* "pastel green" */
		{30, 1, .5, 0, 1, .5, 0},
		{210, .5, .5, 0, .25, .5, .75},
		{300, .25, .25, 0, .3125, .1875, .3125},
		{0, 0, 0, 0, 0, 0, 0},
		{0, 0, 1, 0, 1, 1, 1},
		{0, 0, .25, 0, .25, .25, .25},
	};

	(void)state;
	for (size_t i = 0; i < COUNT(wanted); i++)
		check_pair("hsl", wanted[i], wanted[i] + 4, 1e-15);
}

/* Named colours of the CSS, #RRGGBB, by the hexcone. */
static void
hsv_of_named_colours(void **state)
{
	static const double wanted[][7] = {
		{0, 1, 1, 0, 1, 0, 0},
		{60, 1, 1, 0, 1, 1, 0},
		{180, 1, .5, 0, 0, .5, .5}, /* half of cyan */
		{240, .5, 1, 0, .5, .5, 1},
		{300, 1, .5, 0, .5, 0, .5},
		{0, 0, .75, 0, .75, .75, .75},
		{0, 0, 0, 0, 0, 0, 0},
		/* cornflowerblue, #6495ed: 218.54 deg, 57.8 %, 92.9 % */
		{240 - 60 * 49 / 137., 137 / 237., 237 / 255., 0, 100 / 255., 149 / 255.,
			237 / 255.},
		/* deeppink, #ff1493: 327.57 deg */
		{360 - 60 * 127 / 235., 235 / 255., 1, 0, 1, 20 / 255., 147 / 255.},
	};

	(void)state;
	for (size_t i = 0; i < COUNT(wanted); i++)
		check_pair("hsv", wanted[i], wanted[i] + 4, 1e-15);
}

/* BT.470-6: bars of full colour; three digits as television's tables print them. */
static void
yuv_of_colour_bars(void **state)
{
	static const double wanted[][7] = {
		{1, 0, 0, 0, 1, 1, 1},
		{.886, -.437, .100, 0, 1, 1, 0},
		{.701, .147, -.615, 0, 0, 1, 1},
		{.587, -.289, -.515, 0, 0, 1, 0},
		{.413, .289, .515, 0, 1, 0, 1},
		{.299, -.147, .615, 0, 1, 0, 0},
		{.114, .437, -.100, 0, 0, 0, 1},
		{0, 0, 0, 0, 0, 0, 0},
	};

	(void)state;
	for (size_t i = 0; i < COUNT(wanted); i++)
		check_pair("yuv", wanted[i], wanted[i] + 4, .0015);
}

static void
cmyk_of_inks(void **state)
{
	static const double wanted[][7] = {
		{0, 0, 0, 0, 1, 1, 1},
		{0, 0, 0, 1, 0, 0, 0},
		{1, 0, 0, 0, 0, 1, 1},
		{0, 1, 0, 0, 1, 0, 1},
		{0, 0, 1, 0, 1, 1, 0},
		{0, .5, 1, 0, 1, .5, 0},
		{0, .5, 1, .5, .5, .25, 0},
	};

	(void)state;
	for (size_t i = 0; i < COUNT(wanted); i++)
		check_pair("cmyk", wanted[i], wanted[i] + 4, 1e-15);
}

/* Every colour comes back, and each component keeps to its range. */
static void
all_come_back(void **state)
{
	uint64_t seed = 16;
	const struct spec_model *each;

	(void)state;
	for (size_t m = 0; (each = spec_model_at(m)); m++) {
		for (int i = 0; i < 17 * 17 * 17 + 5000; i++) {
			int at[3] = {i / 289 % 17, i / 17 % 17, i % 17};
			double rgb[3] = {at[0] / 16., at[1] / 16., at[2] / 16.};
			double value[SPEC_MODEL_MOST], back[3];

			for (int c = 0; c < 3 && i >= 17 * 17 * 17; c++)
				rgb[c] = random_share(&seed);
			spec_model_from_rgb(each, rgb, value);
			spec_model_to_rgb(each, value, back);
			for (size_t c = 0; c < each->components; c++)
				assert_true(value[c] >= each->least[c] - 1e-15 &&
					    value[c] <= each->most[c] + 1e-15);
			assert_true(each->most[0] < 360 || value[0] < 360);
			for (int c = 0; c < 3; c++)
				near(back[c], rgb[c], 4e-15, each->name);
		}
	}
}

/* Hues repeat themselves; greys have none, of whatever hue they were made. */
static void
hues_go_round(void **state)
{
	static const char *const names[2] = {"hsv", "hsl"};

	(void)state;
	for (int m = 0; m < 2; m++) {
		for (int hue = 0; hue <= 360; hue += 15) {
			double value[3][4] = {
				{hue, .6, .7, 0}, {hue - 720, .6, .7, 0}, {hue, 0, .7, 0}};
			double rgb[3][3], back[4];

			for (int i = 0; i < 3; i++)
				spec_model_to_rgb(model(names[m]), value[i], rgb[i]);
			for (int c = 0; c < 3; c++) {
				near(rgb[1][c], rgb[0][c], 1e-14, "another turn");
				near(rgb[2][c], .7, 0, "grey");
			}
			/* By less than a last place below red, which is 0 and not 360. */
			rgb[1][0] = 1;
			rgb[1][1] = .5;
			rgb[1][2] = nextafter(.5, 1);
			spec_model_from_rgb(model(names[m]), rgb[1], back);
			assert_true(back[0] >= 0 && back[0] < 360);
			spec_model_from_rgb(model(names[m]), rgb[2], back);
			near(back[0], 0, 0, "hue of a grey");
			near(back[1], 0, 0, "saturation of a grey");
		}
	}
}

static void
unknown_model(void **state)
{
	struct spec_error error;

	(void)state;
	assert_null(spec_model_find("lab", &error));
	assert_int_equal(error.status, SPEC_EUSAGE);
	assert_contains(error.message, "'lab' is not hsv, hsl, yuv or cmyk");
}

int
main(void)
{
	const struct CMUnitTest tests[] = {
		cmocka_unit_test(hsl_of_style_sheets),
		cmocka_unit_test(hsv_of_named_colours),
		cmocka_unit_test(yuv_of_colour_bars),
		cmocka_unit_test(cmyk_of_inks),
		cmocka_unit_test(all_come_back),
		cmocka_unit_test(hues_go_round),
		cmocka_unit_test(unknown_model),
	};

	return cmocka_run_group_tests_name("models", tests, NULL, NULL);
}
