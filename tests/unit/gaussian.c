/* lib/colour/gaussian: three Gaussians for an RGB colour. */
#include "colour/difference.h"
#include "colour/gaussian.h"

#include "check.h"

static struct spec_gaussian_fit light, factor;

/* DeltaE2000 between a colour and its spectrum. */
static double
miss(const struct spec_gaussian_fit *sun, const double rgb[3],
	struct spec_gaussians *gaussians)
{
	const double one[3] = {1, 1, 1};
	double value[471], xyz[3] = {0}, wanted[3], white[3], lab1[3], lab2[3];

	assert_int_equal(sun->count, COUNT(value));
	assert_int_equal(spec_gaussian_solve(sun, rgb, gaussians, NULL), SPEC_OK);
	spec_gaussians_sample(gaussians, sun->wavelength_nm, sun->count, value);
	for (size_t c = 0; c < 3; c++) {
		for (size_t i = 0; i < sun->count; i++)
			xyz[c] += sun->weight[sun->count * c + i] * value[i];
	}
	spec_matrix_apply(sun->to_xyz, one, white);
	spec_matrix_apply(sun->to_xyz, rgb, wanted);
	spec_lab_from_xyz(xyz, white, lab1);
	spec_lab_from_xyz(wanted, white, lab2);
	return spec_difference_ciede2000(lab1, lab2);
}

/*
 * Over a grid of 16^3: all but some 3 % are met to rounding, and those are
 * blues outside the Gaussians' triangle. Measured: 3.80 and 3.75 at most, 0.05 on average.
 */
static void
sun_round_trip(void **state)
{
	const struct spec_gaussian_fit *const both[2] = {&light, &factor};

	(void)state;
	for (int k = 0; k < 2; k++) {
		double most = 0, mean = 0;
		int missed = 0;

		for (int i = 0; i < 4096; i++) {
			double rgb[3] = {(double)(i >> 8) / 15, (double)(i >> 4 & 15) / 15,
				(double)(i & 15) / 15};
			struct spec_gaussians gaussians;
			double off = miss(both[k], rgb, &gaussians);

			for (int j = 0; j < 3; j++)
				assert_true(gaussians.weight[j] >= 0);
			most = fmax(most, off);
			mean += off / 4096;
			missed += off > 1e-6;
			if (off > 1e-6)
				assert_true(
					rgb[2] > rgb[1] && rgb[2] > rgb[0] &&
					gaussians.width_nm <= SPEC_GAUSSIAN_NARROWEST_NM);
		}
		if (!(most <= 4 && mean <= .06 && missed <= 130))
			fail_msg(
				"at most %g, %g on average, %d missed", most, mean, missed);
	}
}

/* Wider where paler; grey and black are widest, and brightness plays no part. */
static void
sun_width_follows_saturation(void **state)
{
	const double grey[3] = {.2, .2, .2}, black[3] = {0};
	double last = 151;

	(void)state;
	near(spec_gaussian_width(&light, grey), 150, 1e-6, "grey");
	near(spec_gaussian_width(&light, black), 150, 0, "black");
	for (int i = 0; i <= 10; i++) {
		double rgb[3] = {1, 1 - .1 * i, 1 - .1 * i}, tenth[3];
		double width_nm = spec_gaussian_width(&light, rgb);

		for (int c = 0; c < 3; c++)
			tenth[c] = .1 * rgb[c];
		assert_true(width_nm < last && width_nm > 10);
		near(spec_gaussian_width(&light, tenth), width_nm, 1e-9, "at a tenth");
		last = width_nm;
	}
}

/*
 * The purity of sRGB's red: its dominant wavelength under D65 is 611.3 nm, at x .6697
 * (interpolated in the CIE's table of 1931), so it is (.64 - .3127) / (.6697 - .3127).
 */
static void
sun_purity_of_red(void **state)
{
	const double red[3] = {1, 0, 0};
	double purity = (.64 - .3127) / (.6697 - .3127);

	(void)state;
	near(spec_gaussian_width(&light, red), 150 - 140 * purity, .02, "width");
}

/* Half height at half the width; the integral w sqrt(pi / ln 2) / 2; means add up. */
static void
sun_gaussians(void **state)
{
	static const double centre_nm[3] = {680, 550, 450};

	(void)state;
	for (int i = 0; i < 3; i++) {
		double c = centre_nm[i], w = 40, sum = 0;

		near(spec_gaussian_component(i, w, c), 1, 0, "peak");
		near(spec_gaussian_component(i, w, c + 20), .5, 1e-15, "half height");
		near(spec_gaussian_component(i, w, c - 20), .5, 1e-15, "half height");
		near(400 * spec_gaussian_component_mean(i, w, c - 200, c + 200),
			w / 2 * sqrt(3.14159265358979 / log(2)), 1e-9, "integral");
		for (int k = 0; k < 1000; k++)
			sum += spec_gaussian_component(i, w, c + 30 + .01 * (k + .5)) /
			       1000;
		near(spec_gaussian_component_mean(i, w, c + 30, c + 40), sum, 1e-7,
			"mean above");
		near(spec_gaussian_component_mean(i, w, c - 40, c - 30), sum, 1e-7,
			"mean below");
		near(spec_gaussian_component_mean(i, w, c - 1e-3, c + 1e-3), 1, 1e-8,
			"mean at peak");
	}
}

static void
sun_means_are_of_its_samples(void **state)
{
	static const double rgb[3] = {.2, .7, .4};
	struct spec_gaussians gaussians;
	double edge_nm[41], mean[40], nm, value;

	(void)state;
	assert_int_equal(spec_gaussian_solve(&light, rgb, &gaussians, NULL), SPEC_OK);
	for (size_t i = 0; i < COUNT(edge_nm); i++)
		edge_nm[i] = 380 + 10 * (double)i;
	spec_gaussians_mean(&gaussians, edge_nm, 40, mean);
	for (size_t i = 0; i < 40; i++) {
		double sum = 0;

		for (int k = 0; k < 200; k++) {
			nm = edge_nm[i] + .05 * (k + .5);
			spec_gaussians_sample(&gaussians, &nm, 1, &value);
			sum += value / 200;
		}
		near(mean[i], sum, 1e-6, "mean");
	}
}

static void
sun_refuses_bad_colours(void **state)
{
	static const double bad[][3] = {{-1e-9, 1, 1}, {1, NAN, 1}, {1, 1, INFINITY}};
	struct spec_gaussians gaussians;
	struct spec_error error;

	(void)state;
	for (size_t i = 0; i < COUNT(bad); i++)
		assert_int_equal(spec_gaussian_solve(&light, bad[i], &gaussians, &error),
			SPEC_ERANGE);
}

static int
open_all(void **state)
{
	const struct spec_space *srgb = spec_space_find("srgb", NULL);

	(void)state;
	return spec_gaussian_load(srgb, 0, &light, NULL) != SPEC_OK ||
	       spec_gaussian_load(srgb, 1, &factor, NULL) != SPEC_OK;
}

static int
close_all(void **state)
{
	(void)state;
	spec_gaussian_free(&light);
	spec_gaussian_free(&factor);
	return 0;
}

int
main(void)
{
	const struct CMUnitTest tests[] = {
		cmocka_unit_test(sun_round_trip),
		cmocka_unit_test(sun_width_follows_saturation),
		cmocka_unit_test(sun_purity_of_red),
		cmocka_unit_test(sun_gaussians),
		cmocka_unit_test(sun_means_are_of_its_samples),
		cmocka_unit_test(sun_refuses_bad_colours),
	};

	return cmocka_run_group_tests_name("sun", tests, open_all, close_all);
}
