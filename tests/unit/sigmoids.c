/* lib/colour/sigmoids: the table of sigmoids. */
#include <fcntl.h>
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include <cmocka.h>

#include "colour/difference.h"
#include "colour/sigmoids.h"

#define COUNT(list) (sizeof(list) / sizeof *(list))
#define SIDE 12

static struct spec_upsampler srgb;
static struct spec_sigmoids built, small; /* as make built it; of 12^3 colours */

/* Errors fall with the square of the side; those stated are of 64. */
static double coarser;

/* Uniform in [0, 1). */
static double
draw(void)
{
	static uint64_t state = 64;

	state = state * 6364136223846793005u + 1442695040888963407u;
	return (double)(state >> 11) * 0x1p-53;
}

static double
miss(const double rgb[3], const struct spec_sigmoid *sigmoid)
{
	const double one[3] = {1, 1, 1};
	double value[471], xyz[3] = {0}, wanted[3], white[3], lab1[3], lab2[3];

	assert_int_equal(srgb.count, COUNT(value));
	spec_sigmoid_sample(sigmoid, srgb.wavelength_nm, srgb.count, value);
	for (size_t c = 0; c < 3; c++)
		for (size_t i = 0; i < srgb.count; i++)
			xyz[c] += srgb.weight[srgb.count * c + i] * value[i];
	spec_matrix_apply(srgb.to_xyz, one, white);
	spec_matrix_apply(srgb.to_xyz, rgb, wanted);
	spec_lab_from_xyz(xyz, white, lab1);
	spec_lab_from_xyz(wanted, white, lab2);
	return spec_difference_ciede2000(lab1, lab2);
}

/* The i-th colour of a kind: 0, 1 grids of 16^3, linear, encoded; random; dark; pale. */
static void
pick(int kind, int i, double rgb[3])
{
	for (int c = 0; c < 3; c++, i /= 16) {
		rgb[c] = kind < 2    ? (double)(i & 15) / 15
			 : kind == 2 ? draw()
			 : kind == 3 ? exp(-14 * draw())
				     : 1 - .03 * draw();
		if (kind == 1)
			rgb[c] = spec_srgb_decode(rgb[c]);
		rgb[c] = (float)rgb[c];
	}
}

/*
 * Between the table and its colours. Measured: .033, .064, .061, .069 and
 * .195 at most, .013, .011, .011, .008 and .02 on average.
 */
static void
sigmoids_round_trip(void **state)
{
	static const double most[] = {.04, .07, .07, .08, .25};
	static const double mean[] = {.015, .015, .015, .015, .03};

	(void)state;
	for (int kind = 0; kind < 5; kind++) {
		double worst = 0, sum = 0;

		for (int i = 0; i < 4096; i++) {
			struct spec_sigmoid sigmoid;
			double rgb[3], off;

			pick(kind, i, rgb);
			spec_sigmoids_find(&built, rgb, &sigmoid);
			assert_true(sigmoid.scale >= 0 && sigmoid.scale <= 1);
			off = miss(rgb, &sigmoid);
			worst = fmax(worst, off);
			sum += off / 4096;
		}
		if (!(worst <= coarser * most[kind] && sum <= coarser * mean[kind]))
			fail_msg("kind %d: DeltaE2000 at most %g, %g on average", kind,
				worst, sum);
	}
}

/* The colours of the grid have the spectra that a fit of its own finds, but for floats. */
static void
sigmoids_are_fits(void **state)
{
	double worst = 0;

	(void)state;
	for (int i = 0; i < 300; i++) {
		size_t l = (size_t)i % 3, z = 1 + (size_t)(draw() * (SIDE - 1));
		size_t x = (size_t)(draw() * SIDE), y = (size_t)(draw() * (SIDE - 1));
		double rgb[3], a[471], b[471];
		struct spec_sigmoid found, fitted;

		rgb[l] = small.level.at[z];
		rgb[(l + 1) % 3] = (float)(rgb[l] * small.share.at[x]);
		rgb[(l + 2) % 3] = (float)(rgb[l] * small.share.at[y]);
		spec_sigmoids_find(&small, rgb, &found);
		assert_int_equal(spec_upsample_albedo(&srgb, rgb, &fitted, NULL), SPEC_OK);
		spec_sigmoid_sample(&found, srgb.wavelength_nm, srgb.count, a);
		spec_sigmoid_sample(&fitted, srgb.wavelength_nm, srgb.count, b);
		for (size_t k = 0; k < COUNT(a); k++)
			worst = fmax(worst, fabs(a[k] - b[k]));
	}
	if (!(worst <= 2e-4))
		fail_msg("spectra differ by %g", worst);
}

/* Level to the last bit, whatever the grid. */
static void
sigmoids_of_greys(void **state)
{
	static const double nm[4] = {360, 450, 700, 830};

	(void)state;
	for (int i = 0; i <= 1000; i++) {
		double grey = (float)(i / 1000.), rgb[3] = {grey, grey, grey}, value[4];
		struct spec_sigmoid sigmoid;

		spec_sigmoids_find(&built, rgb, &sigmoid);
		spec_sigmoid_sample(&sigmoid, nm, 4, value);
		for (int k = 0; k < 4; k++)
			assert_true(fabs(value[k] - grey) <= 1e-9 * grey);
	}
}

/* Nothing jumps from one colour to the next, also where the largest component changes. */
static void
sigmoids_are_continuous(void **state)
{
	double worst = 0;

	(void)state;
	for (int i = 0; i < 20000; i++) {
		double rgb[3], near[3], a[9], b[9];
		static const double nm[9] = {400, 440, 480, 520, 560, 600, 640, 680, 720};
		struct spec_sigmoid one, other;

		pick(2, i, rgb);
		if (i % 2)
			rgb[1] = rgb[0] * (1 + 1e-6 * (draw() - .5));
		for (int c = 0; c < 3; c++)
			near[c] = rgb[c] * (1 - 2e-6 * draw());
		spec_sigmoids_find(&built, rgb, &one);
		spec_sigmoids_find(&built, near, &other);
		spec_sigmoid_sample(&one, nm, 9, a);
		spec_sigmoid_sample(&other, nm, 9, b);
		for (int k = 0; k < 9; k++)
			worst = fmax(worst, fabs(a[k] - b[k]));
	}
	if (!(worst <= 1e-3))
		fail_msg("spectra of neighbours differ by %g", worst);
}

/* Twice as dark is half the spectrum, down to the smallest numbers; black is 0. */
static void
sigmoids_of_dark_colours(void **state)
{
	const double nm = 500, black[3] = {0};
	struct spec_sigmoid sigmoid;
	double value;

	(void)state;
	for (int i = 20; i < 140; i++) {
		double rgb[3] = {.3 * exp2(-i), .7 * exp2(-i), .2 * exp2(-i)}, half[3],
		       other;

		for (int c = 0; c < 3; c++)
			half[c] = rgb[c] / 2;
		spec_sigmoids_find(&built, rgb, &sigmoid);
		spec_sigmoid_sample(&sigmoid, &nm, 1, &value);
		spec_sigmoids_find(&built, half, &sigmoid);
		spec_sigmoid_sample(&sigmoid, &nm, 1, &other);
		assert_true(value > .3 * exp2(-i) && value < exp2(-i));
		assert_true(fabs(value / other - 2) < (i < 120 ? 1e-5 : .2));
	}
	spec_sigmoids_find(&built, black, &sigmoid);
	spec_sigmoid_sample(&sigmoid, &nm, 1, &value);
	assert_true(value == 0);
}

static void
solve(int threads, struct spec_sigmoids *sigmoids)
{
	assert_int_equal(
		spec_sigmoids_solve(&srgb, SIDE, threads, sigmoids, NULL), SPEC_OK);
}

static void
sigmoids_do_not_depend_on_threads(void **state)
{
	struct spec_sigmoids other;

	(void)state;
	solve(1, &other);
	assert_memory_equal(other.coefficient, small.coefficient,
		9 * SIDE * SIDE * SIDE * sizeof(float));
	spec_sigmoids_free(&other);
}

/* Writes a table, cut or changed at a place, and sees what opening it says. */
static void
expect(const char *folder, long cut, long at, char byte, const char *wanted)
{
	char path[200];
	struct spec_sigmoids sigmoids;
	struct spec_error error = {0};
	FILE *file;

	(void)snprintf(path, sizeof path, "%s/table", folder);
	assert_int_equal(spec_sigmoids_save(&small, path, &error), SPEC_OK);
	file = fopen(path, "r+b");
	assert_non_null(file);
	if (at >= 0)
		assert_true(fseek(file, at, SEEK_SET) == 0 && fputc(byte, file) != EOF);
	if (cut >= 0)
		assert_int_equal(ftruncate(fileno(file), cut), 0);
	assert_int_equal(fclose(file), 0);
	assert_int_equal(spec_sigmoids_open(path, &sigmoids, &error),
		wanted ? SPEC_EFORMAT : SPEC_OK);
	if (wanted && !strstr(error.message, wanted))
		fail_msg("'%s' without '%s'", error.message, wanted);
	if (!wanted)
		assert_memory_equal(sigmoids.coefficient, small.coefficient,
			9 * SIDE * SIDE * SIDE * sizeof(float));
	if (!wanted)
		assert_memory_equal(&sigmoids.level, &small.level, sizeof small.level);
	spec_sigmoids_free(&sigmoids);
	assert_int_equal(unlink(path), 0);
}

static void
sigmoids_in_files(void **state)
{
	char folder[] = "/tmp/sigmoids-XXXXXX";
	struct spec_sigmoids sigmoids;
	struct spec_error error;

	(void)state;
	assert_non_null(mkdtemp(folder));
	expect(folder, -1, -1, 0, NULL);
	expect(folder, 0, -1, 0, "is no table of sigmoids");
	expect(folder, 40, -1, 0, "is no table of sigmoids");
	expect(folder, -1, 0, 'S', "is no table of sigmoids");
	expect(folder, -1, 32, 1, "another kind of computer");
	expect(folder, -1, 38, 1, "damaged header");
	expect(folder, -1, 36, 13, "bytes instead of");
	expect(folder, 1000, -1, 0, "1000 bytes instead of");
	assert_int_equal(spec_sigmoids_open(folder, &sigmoids, &error), SPEC_EFORMAT);
	assert_int_equal(rmdir(folder), 0);
	assert_int_equal(spec_sigmoids_open(folder, &sigmoids, &error), SPEC_EIO);
	assert_int_equal(spec_sigmoids_solve(&srgb, 3, 1, &sigmoids, &error), SPEC_ERANGE);
}

static int
open_all(void **state)
{
	(void)state;
	if (spec_upsampler_load(spec_space_find("srgb", NULL), &srgb, NULL) != SPEC_OK ||
		spec_sigmoids_load(&built, NULL) != SPEC_OK)
		return 1;
	coarser = 64. * 64 / (double)(built.side * built.side);
	return spec_sigmoids_solve(&srgb, SIDE, 3, &small, NULL) != SPEC_OK;
}

static int
close_all(void **state)
{
	(void)state;
	spec_upsampler_free(&srgb);
	spec_sigmoids_free(&built);
	spec_sigmoids_free(&small);
	return 0;
}

int
main(void)
{
	const struct CMUnitTest tests[] = {
		cmocka_unit_test(sigmoids_round_trip),
		cmocka_unit_test(sigmoids_are_fits),
		cmocka_unit_test(sigmoids_of_greys),
		cmocka_unit_test(sigmoids_are_continuous),
		cmocka_unit_test(sigmoids_of_dark_colours),
		cmocka_unit_test(sigmoids_do_not_depend_on_threads),
		cmocka_unit_test(sigmoids_in_files),
	};

	return cmocka_run_group_tests_name("sigmoids", tests, open_all, close_all);
}
