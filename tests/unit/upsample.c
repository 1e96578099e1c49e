/* lib/colour/upsample: spectra for RGB colours. */
#include <float.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "colour/difference.h"
#include "colour/observer.h"
#include "colour/upsample.h"
#include "spectrum/mean.h"
#include "spectrum/spd.h"

#include "check.h"

/* What all tests use: sRGB's upsampler, and the curves it was made of. */
static struct spec_upsampler srgb;
static struct spec_curve observer, d65;

/* Uniform in [0, 1). */
static double
draw(void)
{
	static uint64_t state = 2019;

	state = state * 6364136223846793005u + 1442695040888963407u;
	return (double)(state >> 11) * 0x1p-53;
}

/* A colour from where fits are easy or hard: anywhere, dark, bright, at the faces. */
static void
draw_colour(int kind, double rgb[3])
{
	for (int i = 0; i < 3; i++)
		rgb[i] = kind == 0     ? draw()
			 : kind == 1   ? exp(-20 * draw())
			 : kind == 2   ? 1 - exp(-20 * draw())
			 : draw() < .4 ? (double)(draw() < .5)
				       : draw();
}

/* The i-th colour of a grid with so many steps along each side. */
static void
pick(int i, int side, double rgb[3])
{
	for (int c = 2; c >= 0; c--, i /= side)
		rgb[c] = (double)(i % side) / (side - 1);
}

static struct spec_sigmoid
albedo(const double rgb[3])
{
	struct spec_sigmoid sigmoid;
	struct spec_error error;

	assert_int_equal(spec_upsample_albedo(&srgb, rgb, &sigmoid, &error), SPEC_OK);
	return sigmoid;
}

/* Bands and their weights under D65. */
struct eye {
	struct spec_bands bands;
	double edge_nm[472], weight[3 * 471], value[471];
};

/* The observer's own samples, or bins of a width up from a wavelength. */
static void
open_eye(struct eye *eye, const struct spec_curve *illuminant, double from_nm,
	double width_nm, size_t bins)
{
	double outside;

	eye->bands = (struct spec_bands){
		.count = observer.count, .wavelength_nm = observer.wavelength_nm};
	if (bins > 0)
		eye->bands = (struct spec_bands){.count = bins, .edges_nm = eye->edge_nm};
	for (size_t i = 0; i <= bins; i++)
		eye->edge_nm[i] = from_nm + width_nm * (double)i;
	assert_true(eye->bands.count <= COUNT(eye->value));
	assert_int_equal(spec_observer_weights(&observer, illuminant, &eye->bands,
				 eye->weight, &outside, NULL),
		SPEC_OK);
}

/* XYZ of what is in the eye's bands. */
static void
see(const struct eye *eye, double xyz[3])
{
	for (size_t c = 0; c < 3; c++) {
		xyz[c] = 0;
		for (size_t i = 0; i < eye->bands.count; i++)
			xyz[c] += eye->weight[c * eye->bands.count + i] * eye->value[i];
	}
}

static void
see_sigmoid(struct eye *eye, const struct spec_sigmoid *sigmoid, double xyz[3])
{
	if (eye->bands.edges_nm)
		spec_sigmoid_mean(sigmoid, eye->edge_nm, eye->bands.count, eye->value);
	else
		spec_sigmoid_sample(
			sigmoid, eye->bands.wavelength_nm, eye->bands.count, eye->value);
	see(eye, xyz);
}

/* DeltaE2000 between XYZ under a white and RGB that a matrix takes to such XYZ. */
static double
difference(const double xyz[3], const double rgb[3], const double to_xyz[9])
{
	const double one[3] = {1, 1, 1};
	double white[3], wanted[3], lab1[3], lab2[3];

	spec_matrix_apply(to_xyz, one, white);
	spec_matrix_apply(to_xyz, rgb, wanted);
	spec_lab_from_xyz(xyz, white, lab1);
	spec_lab_from_xyz(wanted, white, lab2);
	return spec_difference_ciede2000(lab1, lab2);
}

/* Round trips of a grid of 16^3 linear or encoded colours; also that all is in [0, 1]. */
static void
go_round(
	struct eye *eye, int encoded, const double to_xyz[9], double most, double most_mean)
{
	double worst = 0, sum = 0;

	for (int i = 0; i < 16 * 16 * 16; i++) {
		double rgb[3], xyz[3], e;
		struct spec_sigmoid sigmoid;

		pick(i, 16, rgb);
		for (int c = 0; c < 3 && encoded; c++)
			rgb[c] = spec_srgb_decode(rgb[c]);
		sigmoid = albedo(rgb);
		see_sigmoid(eye, &sigmoid, xyz);
		for (size_t k = 0; k < eye->bands.count; k++)
			assert_true(eye->value[k] >= 0 && eye->value[k] <= 1);
		e = difference(xyz, rgb, to_xyz);
		worst = fmax(worst, e);
		sum += e;
	}
	if (!(worst <= most && sum / 4096 <= most_mean))
		fail_msg("DeltaE2000 at most %g, %g on average; wanted %g and %g", worst,
			sum / 4096, most, most_mean);
}

/* By the samples of the fit: measured 1.1e-10, mean 5e-12. */
static void
upsample_round_trip(void **state)
{
	struct eye eye;

	(void)state;
	open_eye(&eye, &d65, 0, 0, 0);
	go_round(&eye, 0, srgb.to_xyz, 1e-9, 1e-10);
	go_round(&eye, 1, srgb.to_xyz, 1e-9, 1e-10);
}

/*
 * By integrals over bins, as images have them. Bins of 1 nm: measured 0.0130, mean 0.0019;
 * of 5 nm, where a bin's mean reflectance and its mean light are not independent: 0.131,
 * 0.0245.
 */
static void
upsample_round_trip_in_bins(void **state)
{
	struct eye eye;

	(void)state;
	open_eye(&eye, &d65, 360, 1, 470);
	go_round(&eye, 0, srgb.to_xyz, .01, .002);
	go_round(&eye, 1, srgb.to_xyz, .02, .003);
	open_eye(&eye, &d65, 377.5, 5, 81);
	go_round(&eye, 0, srgb.to_xyz, .1, .03);
	go_round(&eye, 1, srgb.to_xyz, .15, .03);
}

/* Without adaptation from D65 to sRGB's x = .3127, y = .3290: measured 0.0146, 0.0058. */
static void
upsample_round_trip_unadapted(void **state)
{
	struct eye eye;
	double to_xyz[9];

	(void)state;
	assert_int_equal(
		spec_space_to_xyz(spec_space_find("srgb", NULL), to_xyz, NULL), SPEC_OK);
	open_eye(&eye, &d65, 0, 0, 0);
	go_round(&eye, 0, to_xyz, .015, .006);
}

/* Colours from everywhere. Measured: 1e-10; 5e-6 beside white, 9e-5 below 0.001. */
static void
upsample_meets_random_colours(void **state)
{
	struct eye eye;

	(void)state;
	open_eye(&eye, &d65, 0, 0, 0);
	for (int round = 0; round < 4000; round++) {
		double rgb[3], xyz[3];
		struct spec_sigmoid sigmoid;

		draw_colour(round % 4, rgb);
		sigmoid = albedo(rgb);
		see_sigmoid(&eye, &sigmoid, xyz);
		near(difference(xyz, rgb, srgb.to_xyz), 0,
			fmax(rgb[0], fmax(rgb[1], rgb[2])) < .001   ? .001
			: fmin(rgb[0], fmin(rgb[1], rgb[2])) > .999 ? 1e-4
								    : 1e-8,
			"DeltaE2000");
	}
}

static void
upsample_grey_is_level(void **state)
{
	static const double grey[] = {
		0, DBL_MIN, 1e-9, .001, .18, .5, .73, .999, 1 - 1e-9, 1};
	double nm[500], edge_nm[500], value[500];

	(void)state;
	for (size_t i = 0; i < COUNT(nm); i++) {
		nm[i] = 300 + 2. * (double)i;
		edge_nm[i] = 1 + (double)(i * i);
	}
	for (size_t k = 0; k < COUNT(grey); k++) {
		const double rgb[3] = {grey[k], grey[k], grey[k]};
		struct spec_sigmoid sigmoid = albedo(rgb);
		double tolerance = k == 0 || k == COUNT(grey) - 1 ? 0 : 4e-16 * grey[k];

		spec_sigmoid_sample(&sigmoid, nm, COUNT(nm), value);
		for (size_t i = 0; i < COUNT(nm); i++)
			near(value[i], grey[k], tolerance, "grey");
		spec_sigmoid_mean(&sigmoid, edge_nm, COUNT(nm) - 1, value);
		for (size_t i = 0; i + 1 < COUNT(nm); i++)
			near(value[i], grey[k], tolerance, "grey's mean");
	}
}

/*
 * The spectrum of given coefficients, and the fit of XYZ .2065 .1220 .0514 under D65, as
 * the documentation of colour-science's colour 0.4 prints them (sd_Jakob2019,
 * find_coefficients_Jakob2019). That fit ends at DeltaE76 .014; the coefficients differ by
 * .04 % then.
 */
static void
upsample_agrees_with_colour_science(void **state)
{
	const struct spec_sigmoid known = {1, -9e-5, 8.5e-2, -20};
	static const double nm[] = {400, 420, 440, 460, 480, 500, 520, 540, 560, 580, 600};
	static const double wanted[] = {.3143046, .4133320, .4880034, .5279562, .5319346,
		.5, .4326202, .3373544, .2353056, .1507665, .0931332};
	const double xyz[3] = {.20654008, .12197225, .05136952};
	double value[COUNT(nm)], from_xyz[9], rgb[3];
	struct spec_sigmoid sigmoid;

	(void)state;
	spec_sigmoid_sample(&known, nm, COUNT(nm), value);
	for (size_t i = 0; i < COUNT(nm); i++)
		near(value[i], wanted[i], 1e-7, "sd_Jakob2019");
	assert_int_equal(spec_matrix_invert(srgb.to_xyz, from_xyz, NULL), SPEC_OK);
	spec_matrix_apply(from_xyz, xyz, rgb);
	sigmoid = albedo(rgb);
	near(sigmoid.c0_per_nm2, 1.3723791e-4, 1.4e-7, "c0");
	near(sigmoid.c1_per_nm, -1.3514399e-1, 1.4e-4, "c1");
	near(sigmoid.c2, 30.838973, .031, "c2");
}

/* In [0, 1] for every colour of the space and far beyond the visible. */
static void
upsample_stays_in_range(void **state)
{
	double nm[300], value[300];

	(void)state;
	for (size_t i = 0; i < COUNT(nm); i++)
		nm[i] = 1 + (double)(i * i) / 50;
	for (int round = 0; round < 400; round++) {
		double rgb[3];
		struct spec_sigmoid sigmoid;

		draw_colour(round % 4, rgb);
		sigmoid = albedo(rgb);
		spec_sigmoid_sample(&sigmoid, nm, COUNT(nm), value);
		for (size_t i = 0; i < COUNT(nm); i++)
			assert_true(value[i] >= 0 && value[i] <= 1);
		spec_sigmoid_mean(&sigmoid, nm, COUNT(nm) - 1, value);
		for (size_t i = 0; i + 1 < COUNT(nm); i++)
			assert_true(value[i] >= 0 && value[i] <= 1);
	}
}

/* The mean over a bin of a sigmoid times a straight line, by a fine trapezoid rule. */
static long double
fine_mean(const struct spec_sigmoid *sigmoid, const double bin_nm[2], const double line[2])
{
	enum { steps = 4000 };
	long double sum = 0;

	for (int j = 0; j <= steps; j++) {
		long double part = (long double)j / steps;
		long double nm = bin_nm[0] + (bin_nm[1] - bin_nm[0]) * part;
		long double x =
			(sigmoid->c0_per_nm2 * nm + sigmoid->c1_per_nm) * nm + sigmoid->c2;
		long double value = .5L + .5L * x / sqrtl(1 + x * x);

		sum += (line[0] + (line[1] - line[0]) * part) * value *
		       (j == 0 || j == steps ? .5L : 1);
	}
	return sigmoid->scale * sum / steps;
}

/* Measured: 1.0e-6, the bound itself, and 2.3e-6. */
static void
upsample_means_keep_their_error(void **state)
{
	static const double level[2] = {1, 1};

	(void)state;
	for (int round = 0; round < 400; round++) {
		double rgb[3], edge_nm[2], value, light[2];
		struct spec_sigmoid sigmoid;

		do
			draw_colour(round % 4, rgb);
		while (rgb[0] == rgb[1] && rgb[1] == rgb[2]);
		sigmoid = albedo(rgb);
		edge_nm[0] = 300 + 520 * draw();
		edge_nm[1] = edge_nm[0] + 10 * draw();
		spec_sigmoid_mean(&sigmoid, edge_nm, 1, &value);
		near(value, (double)fine_mean(&sigmoid, edge_nm, level), 1.01e-6, "mean");

		/* Between two samples of D65, where it is straight. */
		edge_nm[0] = 5 * floor(edge_nm[0] / 5);
		edge_nm[1] = edge_nm[0] + 5;
		assert_int_equal(spec_curve_sample(&srgb.light, 0, SPEC_EXTRAPOLATE_REFUSE,
					 edge_nm, 2, light, NULL),
			SPEC_OK);
		assert_int_equal(spec_upsampler_mean_light(&srgb, &sigmoid,
					 SPEC_EXTRAPOLATE_REFUSE, edge_nm, 1, &value, NULL),
			SPEC_OK);
		near(value, (double)fine_mean(&sigmoid, edge_nm, light),
			1e-5 * .5 * (light[0] + light[1]), "mean of light");
	}
}

static void
upsample_unbounded_is_scaled(void **state)
{
	struct eye eye;

	(void)state;
	open_eye(&eye, &d65, 0, 0, 0);
	for (int round = 0; round < 500; round++) {
		double rgb[3], part[3], xyz[3], most, level = exp(40 * draw() - 20);
		struct spec_sigmoid sigmoid, of_part;

		draw_colour(0, rgb);
		most = fmax(rgb[0], fmax(rgb[1], rgb[2]));
		for (int i = 0; i < 3; i++) {
			part[i] = rgb[i] / (2 * most);
			rgb[i] *= level;
		}
		assert_int_equal(
			spec_upsample_unbounded(&srgb, rgb, &sigmoid, NULL), SPEC_OK);
		near(sigmoid.scale / (2 * most * level), 1, 4e-16, "scale");
		of_part = albedo(part);
		near(sigmoid.c2, of_part.c2, 1e-9 * fabs(of_part.c2), "c2");
		see_sigmoid(&eye, &sigmoid, xyz);
		for (int i = 0; i < 3; i++)
			xyz[i] /= 2 * most * level;
		near(difference(xyz, part, srgb.to_xyz), 0, 1e-9, "DeltaE2000");
	}
}

/* Equal components at any brightness: level, to the last bit. Black: 0. */
static void
upsample_unbounded_grey(void **state)
{
	static const double grey[] = {0, 1e-300, .3, 1, 42, 1e300};
	const double nm[3] = {400, 550, 700};
	double value[3];

	(void)state;
	for (size_t k = 0; k < COUNT(grey); k++) {
		const double rgb[3] = {grey[k], grey[k], grey[k]};
		struct spec_sigmoid sigmoid;

		assert_int_equal(
			spec_upsample_unbounded(&srgb, rgb, &sigmoid, NULL), SPEC_OK);
		spec_sigmoid_sample(&sigmoid, nm, 3, value);
		for (int i = 0; i < 3; i++)
			near(value[i], grey[k], 0, "grey");
	}
}

/* A coloured light seen by the observer is its colour; white is D65 with Y = 1. */
static void
upsample_light_has_its_colour(void **state)
{
	const double one[3] = {1, 1, 1}, at_nm[2] = {560, 430};
	struct spec_sigmoid sigmoid;
	struct eye eye;
	double xyz[3], wanted[3], sample[2], mean[81];

	(void)state;
	open_eye(&eye, NULL, 360, 1, 470);
	for (int round = 0; round < 200; round++) {
		double rgb[3];

		draw_colour(round % 4, rgb);
		assert_int_equal(
			spec_upsample_unbounded(&srgb, rgb, &sigmoid, NULL), SPEC_OK);
		assert_int_equal(
			spec_upsampler_mean_light(&srgb, &sigmoid, SPEC_EXTRAPOLATE_REFUSE,
				eye.edge_nm, 470, eye.value, NULL),
			SPEC_OK);
		see(&eye, xyz);
		spec_matrix_apply(srgb.to_xyz, rgb, wanted);
		for (int i = 0; i < 3; i++)
			near(xyz[i], wanted[i], 2e-4 * sigmoid.scale, "XYZ");
	}
	assert_int_equal(spec_upsample_unbounded(&srgb, one, &sigmoid, NULL), SPEC_OK);
	assert_int_equal(spec_upsampler_sample_light(&srgb, &sigmoid,
				 SPEC_EXTRAPOLATE_REFUSE, at_nm, 2, sample, NULL),
		SPEC_OK);
	near(sample[1] / sample[0], .866823, 1e-12, "S(430) / S(560) of D65");
	open_eye(&eye, NULL, 377.5, 5, 81);
	assert_int_equal(spec_upsampler_mean_light(&srgb, &sigmoid, SPEC_EXTRAPOLATE_REFUSE,
				 eye.edge_nm, 81, eye.value, NULL),
		SPEC_OK);
	assert_int_equal(spec_curve_mean(&srgb.light, 0, SPEC_EXTRAPOLATE_REFUSE,
				 eye.edge_nm, 81, mean, NULL),
		SPEC_OK);
	for (int i = 0; i < 81; i++)
		near(eye.value[i], mean[i], 1e-14, "D65 itself");
}

/* Beyond D65's 300..830 nm the rule for curves holds. */
static void
upsample_light_has_an_end(void **state)
{
	const struct spec_sigmoid level = {1, 0, 0, 0};
	const double edge_nm[2] = {830, 840}, at_nm[1] = {835};
	struct spec_error error;
	double value;

	(void)state;
	assert_int_equal(spec_upsampler_mean_light(&srgb, &level, SPEC_EXTRAPOLATE_REFUSE,
				 edge_nm, 1, &value, &error),
		SPEC_ERANGE);
	assert_non_null(strstr(error.message, "D65"));
	assert_int_equal(spec_upsampler_sample_light(&srgb, &level, SPEC_EXTRAPOLATE_REFUSE,
				 at_nm, 1, &value, &error),
		SPEC_ERANGE);
	assert_int_equal(spec_upsampler_mean_light(&srgb, &level, SPEC_EXTRAPOLATE_ZERO,
				 edge_nm, 1, &value, &error),
		SPEC_OK);
	near(value, 0, 0, "zero");
	assert_int_equal(spec_upsampler_mean_light(&srgb, &level, SPEC_EXTRAPOLATE_CONSTANT,
				 edge_nm, 1, &value, &error),
		SPEC_OK);
	near(value, .5 * srgb.light.value[srgb.light.count - 1], 1e-15, "constant");
}

static void
upsample_refuses_bad_colours(void **state)
{
	static const double bad[][3] = {{-1e-9, .5, .5}, {.5, 1.001, .5}, {.5, .5, NAN},
		{INFINITY, 0, 0}, {0, -INFINITY, 0}};
	const double bright[3] = {.5, 1.001, .5}, huge[3] = {DBL_MAX, 0, 0};
	struct spec_sigmoid sigmoid;
	struct spec_error error;

	(void)state;
	for (size_t i = 0; i < COUNT(bad); i++) {
		assert_int_equal(
			spec_upsample_albedo(&srgb, bad[i], &sigmoid, &error), SPEC_ERANGE);
		assert_int_equal(
			spec_upsample_unbounded(&srgb, bad[i], &sigmoid, &error) == SPEC_OK,
			i == 1);
	}
	assert_int_equal(
		spec_upsample_albedo(&srgb, bright, &sigmoid, &error), SPEC_ERANGE);
	assert_string_equal(error.message, "green 1.001 of a colour is not in [0, 1]");
	assert_int_equal(
		spec_upsample_unbounded(&srgb, huge, &sigmoid, &error), SPEC_ERANGE);
}

/* Display P3 and Rec. 2020 go beyond what reflectances can show: in range all the same. */
static void
upsample_of_wider_spaces(void **state)
{
	static const char *const names[] = {"p3", "adobe", "rec2020"};
	double nm[471], value[471];

	(void)state;
	for (size_t i = 0; i < COUNT(nm); i++)
		nm[i] = 360 + (double)i;
	for (size_t k = 0; k < COUNT(names); k++) {
		const struct spec_space *space = spec_space_find(names[k], NULL);
		struct spec_upsampler wide;
		struct spec_error error;

		assert_int_equal(spec_upsampler_load(space, &wide, &error), SPEC_OK);
		for (int i = 0; i < 27; i++) {
			struct spec_sigmoid sigmoid;
			double rgb[3];

			pick(i, 3, rgb);
			assert_int_equal(spec_upsample_albedo(&wide, rgb, &sigmoid, &error),
				SPEC_OK);
			spec_sigmoid_sample(&sigmoid, nm, COUNT(nm), value);
			for (size_t j = 0; j < COUNT(nm); j++)
				assert_true(value[j] >= 0 && value[j] <= 1);
		}
		spec_upsampler_free(&wide);
	}
}

static void
upsampler_wants_its_white(void **state)
{
	const struct spec_space *space = spec_space_find("srgb", NULL);
	struct spec_upsampler upsampler;
	struct spec_curve lamp;
	struct spec_error error;

	(void)state;
	assert_int_equal(
		spec_spd_load("spectra/illuminants/A.spd", &lamp, &error), SPEC_OK);
	assert_int_equal(spec_upsampler_new(space, &observer, &lamp, &upsampler, &error),
		SPEC_ERANGE);
	assert_non_null(strstr(error.message, "is not the white of sRGB"));
	assert_null(upsampler.weight);
	assert_int_equal(
		spec_upsampler_new(space, &lamp, &d65, &upsampler, &error), SPEC_EFORMAT);
	spec_curve_free(&lamp);
	assert_int_equal(
		spec_upsampler_load(spec_space_find("aces", NULL), &upsampler, &error),
		SPEC_EUNSUPPORTED);
	assert_non_null(strstr(error.message, "white of ACES2065-1"));
	spec_upsampler_free(&upsampler);
	spec_upsampler_free(&upsampler);
	spec_upsampler_free(NULL);
}

static int
open_all(void **state)
{
	(void)state;
	return spec_spd_load("spectra/cmf/cie1931.spd", &observer, NULL) != SPEC_OK ||
	       spec_spd_load("spectra/illuminants/D65.spd", &d65, NULL) != SPEC_OK ||
	       spec_upsampler_load(spec_space_find("srgb", NULL), &srgb, NULL) != SPEC_OK;
}

static int
close_all(void **state)
{
	(void)state;
	spec_curve_free(&observer);
	spec_curve_free(&d65);
	spec_upsampler_free(&srgb);
	return 0;
}

int
main(void)
{
	const struct CMUnitTest tests[] = {
		cmocka_unit_test(upsample_round_trip),
		cmocka_unit_test(upsample_round_trip_in_bins),
		cmocka_unit_test(upsample_round_trip_unadapted),
		cmocka_unit_test(upsample_meets_random_colours),
		cmocka_unit_test(upsample_agrees_with_colour_science),
		cmocka_unit_test(upsample_grey_is_level),
		cmocka_unit_test(upsample_stays_in_range),
		cmocka_unit_test(upsample_means_keep_their_error),
		cmocka_unit_test(upsample_unbounded_is_scaled),
		cmocka_unit_test(upsample_unbounded_grey),
		cmocka_unit_test(upsample_light_has_its_colour),
		cmocka_unit_test(upsample_light_has_an_end),
		cmocka_unit_test(upsample_refuses_bad_colours),
		cmocka_unit_test(upsample_of_wider_spaces),
		cmocka_unit_test(upsampler_wants_its_white),
	};

	return cmocka_run_group_tests_name("upsample", tests, open_all, close_all);
}
