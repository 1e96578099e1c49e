/* lib/colour/smits and basis: spectra for RGB colours that are sums of tabulated ones. */
#include "colour/difference.h"
#include "colour/observer.h"
#include "colour/smits.h"
#include "colour/space.h"
#include "colour/upsample.h"
#include "spectrum/lookup.h"

#include "check.h"

static struct spec_curve observer, smits, mallett;

/* The colours of Smits' spectra, in the order of enum spec_smits. */
static const double corner[SPEC_SMITS_COLUMNS][3] = {
	{1, 1, 1}, {0, 1, 1}, {1, 0, 1}, {1, 1, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}};

/*
 * Linear RGB of a spectrum as light, by the observer's table within the curve's range, where
 * light of 1 per nm has Y = 1, and a space's matrix.
 */
static void
see(const struct spec_curve *curve, size_t column, const struct spec_space *space,
	double rgb[3])
{
	double first_nm = curve->wavelength_nm[0];
	double last_nm = curve->wavelength_nm[curve->count - 1];
	double from_xyz[9], xyz[3] = {0}, luminance = 0;

	for (size_t i = 0; i < observer.count; i++) {
		double nm = observer.wavelength_nm[i], value;

		if (nm < first_nm || nm > last_nm)
			continue;
		assert_int_equal(spec_curve_sample(curve, column, SPEC_EXTRAPOLATE_REFUSE,
					 &nm, 1, &value, NULL),
			SPEC_OK);
		for (size_t c = 0; c < 3; c++)
			xyz[c] += value * observer.value[observer.count * c + i];
		luminance += observer.value[observer.count + i];
	}
	for (size_t c = 0; c < 3; c++)
		xyz[c] /= luminance;
	assert_int_equal(spec_space_from_xyz(space, from_xyz, NULL), SPEC_OK);
	spec_matrix_apply(from_xyz, xyz, rgb);
}

/* The farthest that Smits' seven spectra are from their colours. */
static double
farthest(const struct spec_curve *curve, const struct spec_space *space)
{
	double most = 0, rgb[3];

	for (size_t k = 0; k < SPEC_SMITS_COLUMNS; k++) {
		see(curve, k, space, rgb);
		for (int c = 0; c < 3; c++)
			most = fmax(most, fabs(rgb[c] - corner[k][c]));
	}
	return most;
}

/* As bins to 0.001 (measured 0.0009); as ten points of an even grid 0.09. */
static void
smits_bins_are_their_colours(void **state)
{
	struct spec_space space = *spec_space_find("srgb", NULL);
	struct spec_curve points;

	(void)state;
	space.white_xy[0] = space.white_xy[1] = 1. / 3;
	near(farthest(&smits, &space), 0, .001, "bins");
	assert_int_equal(spec_curve_new(10, SPEC_SMITS_COLUMNS, &points, NULL), SPEC_OK);
	for (size_t i = 0; i < 10; i++) {
		points.wavelength_nm[i] = 380 + 340 / 9. * (double)i;
		for (size_t k = 0; k < SPEC_SMITS_COLUMNS; k++)
			points.value[10 * k + i] = smits.value[20 * k + 2 * i];
	}
	near(farthest(&points, &space), .09, .01, "points");
	spec_curve_free(&points);
}

/* Equal energy, seen by a display whose white is D65. */
static void
smits_white_is_equal_energy(void **state)
{
	static const double wanted[3] = {1.205, .948, .909};
	double rgb[3];

	(void)state;
	see(&smits, SPEC_SMITS_WHITE, spec_space_find("srgb", NULL), rgb);
	for (int c = 0; c < 3; c++)
		near(rgb[c], wanted[c], .0015, "white");
}

/* Digits of the paper's table, and its largest value. */
static void
smits_table(void **state)
{
	static const char *const name[SPEC_SMITS_COLUMNS] = {
		"white", "cyan", "magenta", "yellow", "red", "green", "blue"};
	static const double nm[] = {300, 380, 413, 430, 500, 580, 600, 719, 900};
	static const double red[] = {
		.1012, .1012, .1012, .0515, 0, 0, .8325, 1.0149, 1.0149};
	static const double cyan[] = {
		.9710, .9710, .9710, .9426, 1.0007, 1.0007, .1564, 0, 0};
	double weight[SPEC_SMITS_COLUMNS], value[COUNT(nm)], most = 0;

	(void)state;
	assert_int_equal(smits.columns, SPEC_SMITS_COLUMNS);
	for (size_t k = 0; k < SPEC_SMITS_COLUMNS; k++)
		assert_string_equal(smits.column[k], name[k]);
	spec_smits_weights(corner[SPEC_SMITS_RED], weight);
	assert_int_equal(
		spec_basis_sample(&smits, weight, nm, COUNT(nm), value, NULL), SPEC_OK);
	for (size_t i = 0; i < COUNT(nm); i++)
		near(value[i], red[i], 1e-15, "red");
	spec_smits_weights(corner[SPEC_SMITS_CYAN], weight);
	assert_int_equal(
		spec_basis_sample(&smits, weight, nm, COUNT(nm), value, NULL), SPEC_OK);
	for (size_t i = 0; i < COUNT(nm); i++)
		near(value[i], cyan[i], 1e-15, "cyan");
	for (size_t i = 0; i < smits.count * smits.columns; i++) {
		assert_true(smits.value[i] >= 0);
		most = fmax(most, smits.value[i]);
	}
	near(most, 1.0149, 0, "the largest value");
}

/* White first, then two of the primaries together, then one; their colours add up. */
static void
smits_weights_add_up(void **state)
{
	uint64_t seed = 1999;

	(void)state;
	for (int round = 0; round < 1000; round++) {
		double rgb[3], weight[SPEC_SMITS_COLUMNS], sum[3] = {0};
		int used = 0;

		for (int c = 0; c < 3; c++) {
			seed = seed * 6364136223846793005u + 1442695040888963407u;
			rgb[c] = floor((double)(seed >> 11) * 0x1p-53 * 5) / 4;
		}
		spec_smits_weights(rgb, weight);
		for (size_t k = 0; k < SPEC_SMITS_COLUMNS; k++) {
			assert_true(weight[k] >= 0);
			used += weight[k] > 0;
			for (int c = 0; c < 3; c++)
				sum[c] += weight[k] * corner[k][c];
		}
		assert_true(used <= 3);
		near(weight[SPEC_SMITS_WHITE], fmin(rgb[0], fmin(rgb[1], rgb[2])), 0,
			"white");
		for (int c = 0; c < 3; c++)
			near(sum[c], rgb[c], 0, "sum");
	}
}

/* As much light in bins of any width: the means over 20 nm have the mean of the whole. */
static void
smits_means_keep_energy(void **state)
{
	static const double rgb[3] = {.9, .2, .4}, whole_nm[2] = {380, 720};
	double weight[SPEC_SMITS_COLUMNS], edge_nm[69], value[68], whole, sum = 0,
									  point[68];
	double points = 0;

	(void)state;
	spec_smits_weights(rgb, weight);
	for (size_t i = 0; i < COUNT(edge_nm); i++)
		edge_nm[i] = 380 + 20 * (double)i;
	assert_int_equal(
		spec_basis_mean(&smits, weight, edge_nm, 17, value, NULL), SPEC_OK);
	assert_int_equal(
		spec_basis_mean(&smits, weight, whole_nm, 1, &whole, NULL), SPEC_OK);
	assert_int_equal(
		spec_basis_sample(&smits, weight, edge_nm, 17, point, NULL), SPEC_OK);
	for (size_t i = 0; i < 17; i++) {
		sum += value[i] / 17;
		points += point[i] / 17;
	}
	near(sum, whole, 1e-14, "mean of the means");
	assert_true(fabs(points - whole) > 1e-3); /* points do not have it */
}

/* Mallett & Yuksel 2019: in [0, 1], and with 1 as their sum. */
static void
mallett_adds_to_one(void **state)
{
	(void)state;
	assert_int_equal(mallett.count, 81);
	for (size_t i = 0; i < mallett.count; i++) {
		double sum = 0;

		for (size_t k = 0; k < 3; k++) {
			double value = mallett.value[81 * k + i];

			assert_true(value >= 0 && value <= 1);
			sum += value;
		}
		near(sum, 1, 2e-5, "sum");
	}
}

/* Under D65 the colours themselves. Measured, by sums over 1 nm: 0.066, 0.028. */
static void
mallett_meets_its_colours(void **state)
{
	struct spec_upsampler srgb;
	double xyz[3][3] = {{0}}, white[3], one[3] = {1, 1, 1}, most = 0, mean = 0;

	(void)state;
	assert_int_equal(
		spec_upsampler_load(spec_space_find("srgb", NULL), &srgb, NULL), SPEC_OK);
	for (size_t k = 0; k < 3; k++) {
		double value[471];

		assert_int_equal(spec_basis_sample(&mallett, corner[SPEC_SMITS_RED + k],
					 srgb.wavelength_nm, 471, value, NULL),
			SPEC_OK);
		for (size_t c = 0; c < 3; c++)
			for (size_t i = 0; i < 471; i++)
				xyz[k][c] += srgb.weight[471 * c + i] * value[i];
	}
	spec_matrix_apply(srgb.to_xyz, one, white);
	for (int i = 0; i < 4096; i++) {
		double rgb[3] = {(double)(i >> 8) / 15, (double)(i >> 4 & 15) / 15,
			(double)(i & 15) / 15};
		double got[3], wanted[3], lab1[3], lab2[3], off;

		for (int c = 0; c < 3; c++)
			got[c] = rgb[0] * xyz[0][c] + rgb[1] * xyz[1][c] +
				 rgb[2] * xyz[2][c];
		spec_matrix_apply(srgb.to_xyz, rgb, wanted);
		spec_lab_from_xyz(got, white, lab1);
		spec_lab_from_xyz(wanted, white, lab2);
		off = spec_difference_ciede2000(lab1, lab2);
		most = fmax(most, off);
		mean += off / 4096;
	}
	if (!(most <= .07 && mean <= .03))
		fail_msg("DeltaE2000 at most %g, %g on average", most, mean);
	spec_upsampler_free(&srgb);
}

static void
basis_wants_its_columns(void **state)
{
	struct spec_curve curve = {0};
	struct spec_error error;

	(void)state;
	assert_int_equal(
		spec_basis_load("upsampling/smits", 3, &curve, &error), SPEC_EFORMAT);
	assert_non_null(strstr(error.message, "7 columns instead of 3"));
	assert_null(curve.value);
	assert_int_equal(
		spec_basis_load("upsampling/nothing", 3, &curve, &error), SPEC_EUSAGE);
}

static int
open_all(void **state)
{
	(void)state;
	return spec_lookup_curve("cmf/cie1931", &observer, NULL) != SPEC_OK ||
	       spec_basis_load(SPEC_SMITS_SPECTRUM, SPEC_SMITS_COLUMNS, &smits, NULL) !=
		       SPEC_OK ||
	       spec_basis_load(SPEC_MALLETT_SPECTRUM, SPEC_MALLETT_COLUMNS, &mallett,
		       NULL) != SPEC_OK;
}

static int
close_all(void **state)
{
	(void)state;
	spec_curve_free(&observer);
	spec_curve_free(&smits);
	spec_curve_free(&mallett);
	return 0;
}

int
main(void)
{
	const struct CMUnitTest tests[] = {
		cmocka_unit_test(smits_bins_are_their_colours),
		cmocka_unit_test(smits_white_is_equal_energy),
		cmocka_unit_test(smits_table),
		cmocka_unit_test(smits_weights_add_up),
		cmocka_unit_test(smits_means_keep_energy),
		cmocka_unit_test(mallett_adds_to_one),
		cmocka_unit_test(mallett_meets_its_colours),
		cmocka_unit_test(basis_wants_its_columns),
	};

	return cmocka_run_group_tests_name("smits", tests, open_all, close_all);
}
