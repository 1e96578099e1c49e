/* lib/image/upsampling: rows of RGB pixels become bands. */
#include <float.h>

#include "colour/basis.h"
#include "colour/smits.h"
#include "colour/gaussian.h"
#include "colour/upsample.h"
#include "image/upsampling.h"

#include "check.h"

#define BANDS 81
#define WIDTH 700 /* blocks of 256 pixels, and some more */

static struct spec_upsampler srgb;
static double nm[BANDS], edge_nm[BANDS + 1];
static float colour[3][WIDTH], plane[BANDS][WIDTH];
static float *band[BANDS];

/* Uniform in [0, 1). */
static double
draw(void)
{
	static uint64_t state = 81;

	state = state * 6364136223846793005u + 1442695040888963407u;
	return (double)(state >> 11) * 0x1p-53;
}

static void
draw_colours(double most)
{
	for (size_t x = 0; x < WIDTH; x++)
		for (int c = 0; c < 3; c++)
			colour[c][x] = (float)(most * (x % 3 == 0 ? draw() < .5 : draw()));
}

static struct spec_upsampling
plan(enum spec_upsampling_model model, enum spec_upsampling_use use, int means)
{
	struct spec_upsampling_setup setup = {model, use, BANDS, means ? NULL : nm,
		means ? edge_nm : NULL, SPEC_EXTRAPOLATE_REFUSE};
	struct spec_upsampling upsampling;
	struct spec_error error = {0};

	if (spec_upsampling_plan(&upsampling, &setup, &error) != SPEC_OK)
		fail_msg("%s", error.message);
	return upsampling;
}

static size_t
make_row(const struct spec_upsampling *upsampling)
{
	return spec_upsampling_row(
		upsampling, colour[0], colour[1], colour[2], WIDTH, band);
}

/* What a model's function for one colour gives, without light. */
static void
one_colour(const struct spec_upsampling *upsampling, const double rgb[3], int means,
	double value[BANDS])
{
	double weight[SPEC_SMITS_COLUMNS] = {rgb[0], rgb[1], rgb[2]}, part[3], most = 1;
	int smits = upsampling->model == SPEC_UPSAMPLING_SMITS;
	struct spec_gaussians gaussians;
	struct spec_sigmoid sigmoid;
	struct spec_curve basis;

	if (upsampling->model == SPEC_UPSAMPLING_SUN) {
		assert_int_equal(
			spec_gaussian_solve(upsampling->sun, rgb, &gaussians, NULL),
			SPEC_OK);
		if (means)
			spec_gaussians_mean(&gaussians, edge_nm, BANDS, value);
		else
			spec_gaussians_sample(&gaussians, nm, BANDS, value);
	} else if (upsampling->model == SPEC_UPSAMPLING_SIGMOID) {
		if (upsampling->use != SPEC_UPSAMPLING_ALBEDO)
			most = 2 * fmax(rgb[0], fmax(rgb[1], rgb[2]));
		for (int c = 0; c < 3; c++)
			part[c] = most > 0 ? rgb[c] / most : 0;
		spec_sigmoids_find(&upsampling->sigmoids, part, &sigmoid);
		sigmoid.scale *= most;
		if (means)
			spec_sigmoid_mean(&sigmoid, edge_nm, BANDS, value);
		else
			spec_sigmoid_sample(&sigmoid, nm, BANDS, value);
	} else {
		if (smits)
			spec_smits_weights(rgb, weight);
		assert_int_equal(
			spec_basis_load(smits ? SPEC_SMITS_SPECTRUM : SPEC_MALLETT_SPECTRUM,
				smits ? SPEC_SMITS_COLUMNS : SPEC_MALLETT_COLUMNS, &basis,
				NULL),
			SPEC_OK);
		assert_int_equal(
			means ? spec_basis_mean(&basis, weight, edge_nm, BANDS, value, NULL)
			      : spec_basis_sample(&basis, weight, nm, BANDS, value, NULL),
			SPEC_OK);
		spec_curve_free(&basis);
	}
}

/* The largest and the mean difference from it, over the largest of the bands. */
static void
compare(enum spec_upsampling_model model, enum spec_upsampling_use use, int means,
	double most, double most_mean)
{
	struct spec_upsampling upsampling = plan(model, use, means);
	double worst = 0, sum = 0;

	draw_colours(use == SPEC_UPSAMPLING_ALBEDO ? 1 : 30);
	assert_int_equal(make_row(&upsampling), 0);
	for (size_t x = 0; x < WIDTH; x++) {
		double rgb[3] = {colour[0][x], colour[1][x], colour[2][x]}, value[BANDS];
		double off = 0, highest = 1e-30;

		one_colour(&upsampling, rgb, means, value);
		for (size_t i = 0; i < BANDS; i++) {
			double limit = use == SPEC_UPSAMPLING_ALBEDO ? 1 : HUGE_VAL;

			highest = fmax(highest, value[i]);
			off = fmax(off, fabs(plane[i][x] - fmin(value[i], limit)));
		}
		worst = fmax(worst, off / highest);
		sum += off / highest / WIDTH;
	}
	if (!(worst <= most && sum <= most_mean))
		fail_msg("model %d, use %d, means %d: %g at most, %g on average", model,
			use, means, worst, sum);
	spec_upsampling_free(&upsampling);
}

static void
rows_are_single_colours(void **state)
{
	static const enum spec_upsampling_use uses[2] = {
		SPEC_UPSAMPLING_ALBEDO, SPEC_UPSAMPLING_UNBOUNDED};

	(void)state;
	for (int k = 0; k < 2; k++) {
		for (int means = 0; means < 2; means++) {
			compare(SPEC_UPSAMPLING_SMITS, uses[k], means, 1e-6, 1e-6);
			compare(SPEC_UPSAMPLING_BASIS, uses[k], means, 1e-6, 1e-6);
			compare(SPEC_UPSAMPLING_SIGMOID, uses[k], means,
				means ? 2e-3 : 5e-6, means ? 1e-4 : 2e-6);
		}
	}
	for (int means = 0; means < 2; means++) {
		compare(SPEC_UPSAMPLING_SUN, SPEC_UPSAMPLING_LIGHT, means, .02, 1e-3);
		compare(SPEC_UPSAMPLING_SUN, SPEC_UPSAMPLING_UNBOUNDED, means, .02, 1e-3);
	}
}

/* A model times D65: at wavelengths the product, as means that of fine pieces. */
static void
light_is_the_model_times_d65(void **state)
{
	static const enum spec_upsampling_model models[3] = {
		SPEC_UPSAMPLING_SMITS, SPEC_UPSAMPLING_SIGMOID, SPEC_UPSAMPLING_BASIS};

	(void)state;
	draw_colours(3);
	for (int k = 0; k < 3; k++) {
		struct spec_upsampling lit = plan(models[k], SPEC_UPSAMPLING_LIGHT, 0);
		struct spec_upsampling plain =
			plan(models[k], SPEC_UPSAMPLING_UNBOUNDED, 0);
		double light[BANDS];
		static float kept[BANDS][WIDTH];

		assert_int_equal(spec_curve_sample(&srgb.light, 0, SPEC_EXTRAPOLATE_REFUSE,
					 nm, BANDS, light, NULL),
			SPEC_OK);
		make_row(&plain);
		memcpy(kept, plane, sizeof kept);
		make_row(&lit);
		for (size_t i = 0; i < BANDS; i++)
			for (size_t x = 0; x < WIDTH; x++)
				near(plane[i][x], light[i] * kept[i][x], 3e-6, "light");
		spec_upsampling_free(&lit);
		spec_upsampling_free(&plain);
	}
}

static void
light_has_means_of_products(void **state)
{
	enum { fine = 100, pixels = 40 };
	static const enum spec_upsampling_model models[3] = {
		SPEC_UPSAMPLING_SMITS, SPEC_UPSAMPLING_SIGMOID, SPEC_UPSAMPLING_BASIS};
	static float value[fine][pixels];
	double fine_nm[fine];
	float *fine_band[fine];

	(void)state;
	draw_colours(1);
	for (int k = 0; k < 3; k++) {
		for (size_t i = 3; i < BANDS; i += 11) {
			struct spec_upsampling_setup setup = {models[k],
				SPEC_UPSAMPLING_LIGHT, fine, fine_nm, NULL,
				SPEC_EXTRAPOLATE_REFUSE};
			struct spec_upsampling points;
			struct spec_upsampling means =
				plan(models[k], SPEC_UPSAMPLING_LIGHT, 1);

			for (size_t j = 0; j < fine; j++) {
				fine_nm[j] = edge_nm[i] + 5 * ((double)j + .5) / fine;
				fine_band[j] = value[j];
			}
			assert_int_equal(
				spec_upsampling_plan(&points, &setup, NULL), SPEC_OK);
			make_row(&means);
			(void)spec_upsampling_row(&points, colour[0], colour[1], colour[2],
				pixels, fine_band);
			for (size_t x = 0; x < pixels; x++) {
				double sum = 0;

				for (size_t j = 0; j < fine; j++)
					sum += value[j][x] / fine;
				near(plane[i][x], sum,
					models[k] == SPEC_UPSAMPLING_SIGMOID ? 4e-4 : 2e-5,
					"mean");
			}
			spec_upsampling_free(&means);
			spec_upsampling_free(&points);
		}
	}
}

/* In [0, 1] whatever the pixels hold; greys are level; what was clamped is counted. */
static void
albedo_stays_in_range(void **state)
{
	static const enum spec_upsampling_model models[3] = {
		SPEC_UPSAMPLING_SMITS, SPEC_UPSAMPLING_SIGMOID, SPEC_UPSAMPLING_BASIS};

	(void)state;
	for (int k = 0; k < 6; k++) {
		struct spec_upsampling upsampling =
			plan(models[k / 2], SPEC_UPSAMPLING_ALBEDO, k % 2);
		size_t out = 0;

		for (size_t x = 0; x < WIDTH; x++) {
			int pale = x % 5 == 0, wild = x % 7 == 0, bad = 0;

			for (int c = 0; c < 3; c++) {
				double value = pale   ? 1 - 1e-4 * draw()
					       : wild ? 4 * draw() - 2
						      : draw() * draw() * (draw() < .7);

				colour[c][x] = (float)value;
				bad |= colour[c][x] < 0 || colour[c][x] > 1;
			}
			out += bad;
		}
		assert_int_equal(make_row(&upsampling), out);
		assert_true(out > 20);
		for (size_t i = 0; i < BANDS; i++)
			for (size_t x = 0; x < WIDTH; x++)
				assert_true(plane[i][x] >= 0 && plane[i][x] <= 1);
		spec_upsampling_free(&upsampling);
	}
}

/* The sigmoid's greys have the same value in all bands, black and white too. */
static void
greys_are_level(void **state)
{
	(void)state;
	for (int k = 0; k < 4; k++) {
		struct spec_upsampling upsampling = plan(SPEC_UPSAMPLING_SIGMOID,
			k / 2 ? SPEC_UPSAMPLING_UNBOUNDED : SPEC_UPSAMPLING_ALBEDO, k % 2);

		for (size_t x = 0; x < WIDTH; x++)
			colour[0][x] = colour[1][x] = colour[2][x] = (float)x / (WIDTH - 1);
		assert_int_equal(make_row(&upsampling), 0);
		for (size_t i = 0; i < BANDS; i++)
			for (size_t x = 0; x < WIDTH; x++)
				near(plane[i][x], colour[0][x], 1e-7 * colour[0][x],
					"grey");
		spec_upsampling_free(&upsampling);
	}
}

/* Not finite: NaN in all bands, and not counted. The neighbours are as they were. */
static void
not_finite_gives_nan(void **state)
{
	static const float bad[3] = {NAN, HUGE_VALF, -HUGE_VALF};

	(void)state;
	for (int k = 0; k < 16; k++) {
		enum spec_upsampling_model model = (enum spec_upsampling_model)(k / 4);
		enum spec_upsampling_use use =
			k / 2 % 2 ? SPEC_UPSAMPLING_LIGHT : SPEC_UPSAMPLING_ALBEDO;
		struct spec_upsampling upsampling;

		if (model == SPEC_UPSAMPLING_SUN)
			use = SPEC_UPSAMPLING_LIGHT;
		upsampling = plan(model, use, k % 2);
		draw_colours(1);
		for (size_t x = 0; x < WIDTH; x += 5)
			colour[x % 3][x] = bad[x / 5 % 3];
		assert_int_equal(make_row(&upsampling), 0);
		for (size_t i = 0; i < BANDS; i++)
			for (size_t x = 0; x < WIDTH; x++)
				assert_true(isnan(plane[i][x]) == (x % 5 == 0));
		spec_upsampling_free(&upsampling);
	}
}

/* Unbounded colours: twice as bright is twice the spectrum; below 0 it is 0. */
static void
unbounded_is_linear(void **state)
{
	static const enum spec_upsampling_model models[4] = {SPEC_UPSAMPLING_SMITS,
		SPEC_UPSAMPLING_SIGMOID, SPEC_UPSAMPLING_BASIS, SPEC_UPSAMPLING_SUN};

	(void)state;
	for (int k = 0; k < 4; k++) {
		struct spec_upsampling upsampling =
			plan(models[k], SPEC_UPSAMPLING_UNBOUNDED, 1);

		for (size_t x = 0; x < WIDTH; x++)
			for (int c = 0; c < 3; c++)
				colour[c][x] = (float)(x % 2 ? 16 * (double)colour[c][x - 1]
							     : 100 * draw());
		assert_int_equal(make_row(&upsampling), 0);
		for (size_t i = 0; i < BANDS; i++)
			for (size_t x = 0; x + 1 < WIDTH; x += 2)
				near(plane[i][x + 1], 16 * plane[i][x],
					1e-6 * plane[i][x + 1], "bright");
		for (size_t x = 0; x < WIDTH; x++)
			colour[0][x] = colour[1][x] = colour[2][x] = x % 2 ? -1.F : FLT_MAX;
		assert_int_equal(make_row(&upsampling), WIDTH);
		for (size_t i = 0; i < BANDS; i++)
			for (size_t x = 1; x < WIDTH; x += 2)
				assert_true(plane[i][x] == 0);
		spec_upsampling_free(&upsampling);
	}
}

/* Bins as wide as one likes, and as narrow. */
static void
bins_of_any_width(void **state)
{
	static const double edges[] = {360, 360.01, 361, 400, 500.5, 501, 830};
	static const double wide[] = {360, 830};
	struct spec_upsampling_setup setup = {SPEC_UPSAMPLING_SIGMOID,
		SPEC_UPSAMPLING_ALBEDO, COUNT(edges) - 1, NULL, edges,
		SPEC_EXTRAPOLATE_REFUSE};
	struct spec_upsampling upsampling, whole;

	(void)state;
	draw_colours(1);
	assert_int_equal(spec_upsampling_plan(&upsampling, &setup, NULL), SPEC_OK);
	setup.count = 1;
	setup.edges_nm = wide;
	assert_int_equal(spec_upsampling_plan(&whole, &setup, NULL), SPEC_OK);
	make_row(&upsampling);
	(void)spec_upsampling_row(
		&whole, colour[0], colour[1], colour[2], WIDTH, band + COUNT(edges));
	for (size_t x = 0; x < WIDTH; x++) {
		double sum = 0;

		for (size_t i = 0; i + 1 < COUNT(edges); i++)
			sum += plane[i][x] * (edges[i + 1] - edges[i]) / 470;
		near(sum, plane[COUNT(edges)][x], 1e-4, "the whole");
	}
	spec_upsampling_free(&upsampling);
	spec_upsampling_free(&whole);
}

/* However the weights of a bin's parts are rounded, white is not above 1. */
static void
wide_bins_stay_in_range(void **state)
{
	(void)state;
	for (size_t x = 0; x < WIDTH; x++)
		for (int c = 0; c < 3; c++)
			colour[c][x] = x % 2 ? 1 : (float)(1 - 1e-6 * draw());
	for (int width_nm = 6; width_nm <= 450; width_nm += 7) {
		const double edges[2] = {360, 360 + width_nm};
		struct spec_upsampling_setup setup = {SPEC_UPSAMPLING_SIGMOID,
			SPEC_UPSAMPLING_ALBEDO, 1, NULL, edges, SPEC_EXTRAPOLATE_REFUSE};
		struct spec_upsampling upsampling;

		assert_int_equal(spec_upsampling_plan(&upsampling, &setup, NULL), SPEC_OK);
		assert_int_equal(make_row(&upsampling), 0);
		for (size_t x = 0; x < WIDTH; x++)
			assert_true(plane[0][x] > .999 && plane[0][x] <= 1);
		spec_upsampling_free(&upsampling);
	}
}

static void
plans_that_are_refused(void **state)
{
	static const double far_nm[2] = {700, 900};
	struct spec_upsampling_setup setup = {SPEC_UPSAMPLING_SUN, SPEC_UPSAMPLING_ALBEDO,
		2, far_nm, NULL, SPEC_EXTRAPOLATE_REFUSE};
	enum spec_upsampling_model model;
	enum spec_upsampling_use use;
	struct spec_upsampling upsampling;
	struct spec_error error;

	(void)state;
	assert_int_equal(
		spec_upsampling_plan(&upsampling, &setup, &error), SPEC_EUNSUPPORTED);
	assert_non_null(strstr(error.message, "no reflectances"));
	setup.use = SPEC_UPSAMPLING_LIGHT;
	for (int k = 0; k < 4; k++) {
		setup.model = (enum spec_upsampling_model)k;
		assert_int_equal(spec_upsampling_plan(&upsampling, &setup, &error),
			setup.model == SPEC_UPSAMPLING_SUN ? SPEC_OK : SPEC_ERANGE);
		if (setup.model != SPEC_UPSAMPLING_SUN)
			assert_non_null(strstr(error.message, "D65"));
		spec_upsampling_free(&upsampling);
		setup.extrapolate = SPEC_EXTRAPOLATE_ZERO;
		assert_int_equal(
			spec_upsampling_plan(&upsampling, &setup, &error), SPEC_OK);
		setup.extrapolate = SPEC_EXTRAPOLATE_REFUSE;
		spec_upsampling_free(&upsampling);
	}
	assert_int_equal(spec_upsampling_find_model("smits", &model, NULL), SPEC_OK);
	assert_int_equal(model, SPEC_UPSAMPLING_SMITS);
	assert_int_equal(spec_upsampling_find_use("light", &use, NULL), SPEC_OK);
	assert_int_equal(use, SPEC_UPSAMPLING_LIGHT);
	assert_int_equal(spec_upsampling_find_model("Smits", &model, &error), SPEC_EUSAGE);
	assert_non_null(strstr(error.message, "'Smits' (smits sun sigmoid basis)"));
	assert_int_equal(spec_upsampling_find_use("", &use, &error), SPEC_EUSAGE);
}

static int
open_all(void **state)
{
	(void)state;
	for (size_t i = 0; i <= BANDS; i++)
		edge_nm[i] = 377.5 + 5 * (double)i;
	for (size_t i = 0; i < BANDS; i++) {
		nm[i] = 380 + 5 * (double)i;
		band[i] = plane[i];
	}
	return spec_upsampler_load(spec_space_find("srgb", NULL), &srgb, NULL) != SPEC_OK;
}

static int
close_all(void **state)
{
	(void)state;
	spec_upsampler_free(&srgb);
	return 0;
}

int
main(void)
{
	const struct CMUnitTest tests[] = {
		cmocka_unit_test(rows_are_single_colours),
		cmocka_unit_test(light_is_the_model_times_d65),
		cmocka_unit_test(light_has_means_of_products),
		cmocka_unit_test(albedo_stays_in_range),
		cmocka_unit_test(greys_are_level),
		cmocka_unit_test(not_finite_gives_nan),
		cmocka_unit_test(unbounded_is_linear),
		cmocka_unit_test(bins_of_any_width),
		cmocka_unit_test(wide_bins_stay_in_range),
		cmocka_unit_test(plans_that_are_refused),
	};

	return cmocka_run_group_tests_name("upsampling", tests, open_all, close_all);
}
