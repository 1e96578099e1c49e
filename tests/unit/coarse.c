/* Which bands a coarser level keeps, and what their weights become. */
#include <stdlib.h>

#include "colour/coarse.h"
#include "colour/difference.h"
#include "colour/observer.h"
#include "image/level.h"

#include "check.h"

/* The flags as digits. */
static const char *
halved(size_t count, unsigned level)
{
	static char text[64];
	unsigned char kept[63];

	spec_coarse_halve(count, level, kept);
	for (size_t i = 0; i < count; i++)
		text[i] = (char)('0' + kept[i]);
	text[count] = 0;
	return text;
}

static void
test_halves(void **state)
{
	(void)state;
	assert_string_equal(halved(1, 0), "1");
	assert_string_equal(halved(1, 3), "1");
	assert_string_equal(halved(2, 0), "11");
	assert_string_equal(halved(9, 0), "100000001");
	assert_string_equal(halved(9, 1), "100010001");
	assert_string_equal(halved(9, 2), "101010101");
	assert_string_equal(halved(9, 3), "111111111");
	assert_string_equal(halved(9, 15), "111111111");
	/* Of two middles the lower; the gaps differ by one at most. */
	assert_string_equal(halved(8, 1), "10010001");
	assert_string_equal(halved(8, 2), "11010101");
}

/* Schiffner's 513 samples: halves of 256 steps, and so on down to single ones. */
static void
test_halves_of_513(void **state)
{
	unsigned char kept[513];

	(void)state;
	for (unsigned level = 0; level <= 9; level++) {
		size_t gap = (size_t)512 >> level;

		assert_int_equal(
			spec_coarse_halve(513, level, kept), ((size_t)1 << level) + 1);
		for (size_t i = 0; i < 513; i++)
			assert_int_equal(kept[i], i % gap == 0);
	}
	assert_int_equal(spec_coarse_finest(513), 9);
}

/* Of any number of bands: 2^n gaps, even ones, which the next level has, too. */
static void
test_levels_nest(void **state)
{
	unsigned char kept[300], before[300];

	(void)state;
	for (size_t count = 1; count <= 300; count++) {
		unsigned finest = spec_coarse_finest(count);

		memset(before, 0, sizeof before);
		for (unsigned level = 0; level <= finest; level++) {
			size_t number = spec_coarse_halve(count, level, kept), found = 0,
			       gaps = (size_t)1 << level, last = 0;

			for (size_t i = 0; i < count; i++) {
				found += kept[i];
				assert_true(kept[i] >= before[i]);
				if (!kept[i] || i == 0)
					continue;
				if (gaps <= count - 1)
					assert_in_range(i - last, (count - 1) / gaps,
						(count - 2 + gaps) / gaps);
				last = i;
			}
			assert_int_equal(number, found);
			assert_true(kept[0] && kept[count - 1]);
			assert_int_equal(number, count == 1         ? 1
						 : gaps < count - 1 ? gaps + 1
								    : count);
			assert_int_equal(number == count, level == finest);
			memcpy(before, kept, count);
		}
	}
}

static void
test_interpolate(void **state)
{
	/* From 400 to 500 nm: 410 is nine tenths the first's, 440 six tenths. */
	const double nm[] = {400, 410, 440, 500, 520};
	const unsigned char kept[] = {1, 0, 0, 1, 1};
	double weight[] = {1, 2, 3, 4, 5};

	(void)state;
	spec_coarse_interpolate(nm, 5, kept, weight);
	near(weight[0], 1 + .9 * 2 + .6 * 3, 1e-15, "first");
	near(weight[3], 4 + .1 * 2 + .4 * 3, 1e-15, "second");
	assert_true(weight[1] == 0 && weight[2] == 0 && weight[4] == 5);
}

/* What is straight between the bands kept has the same sum, at every level. */
static void
test_interpolate_keeps_straight_lines(void **state)
{
	enum { BANDS = 82 };
	double nm[BANDS], weight[BANDS], fewer[BANDS], all, some;
	unsigned char kept[BANDS];

	(void)state;
	for (size_t i = 0; i < BANDS; i++) {
		nm[i] = 380 + 5 * (double)i + (i % 3 ? .7 : 0);
		weight[i] = sin((double)(7 * i)) + .3;
	}
	for (unsigned level = 0; level <= spec_coarse_finest(BANDS); level++) {
		spec_coarse_halve(BANDS, level, kept);
		memcpy(fewer, weight, sizeof weight);
		spec_coarse_interpolate(nm, BANDS, kept, fewer);
		all = some = 0;
		for (size_t i = 0, from = 0, to; i < BANDS; i++) {
			double low, high, value;

			from = kept[i] ? i : from;
			for (to = i; !kept[to]; to++)
				;
			low = cos((double)(3 * from));
			high = cos((double)(3 * to));
			value = from == to ? low
					   : low + (high - low) * (nm[i] - nm[from]) /
							     (nm[to] - nm[from]);
			all += weight[i] * value;
			some += fewer[i] * value;
			assert_true(kept[i] || fewer[i] == 0);
		}
		near(some, all, 1e-12, "sum");
	}
}

static void
test_stride(void **state)
{
	/* As names of files have them: rounded. */
	const double thirds[] = {400, 403.33, 406.67, 410, 413.33},
		     uneven[] = {400, 410, 421, 430}, plain[] = {400, 405, 410, 415, 420};
	struct spec_error error;
	size_t stride = 0;
	double weight[] = {1, 2, 3, 4, 5};

	(void)state;
	assert_int_equal(spec_coarse_stride(plain, 5, 5, &stride, &error), SPEC_OK);
	assert_int_equal(stride, 1);
	assert_int_equal(spec_coarse_stride(plain, 5, 20, &stride, &error), SPEC_OK);
	assert_int_equal(stride, 4);
	assert_int_equal(spec_coarse_stride(thirds, 5, 10, &stride, &error), SPEC_OK);
	assert_int_equal(stride, 3);
	assert_int_equal(spec_coarse_stride(plain, 5, 8, &stride, &error), SPEC_EUSAGE);
	assert_contains(error.message, "5 nm apart: a step of 8 nm is no multiple");
	assert_int_equal(spec_coarse_stride(plain, 5, 1, &stride, &error), SPEC_EUSAGE);
	assert_int_equal(spec_coarse_stride(plain, 5, 25, &stride, &error), SPEC_EUSAGE);
	assert_contains(error.message, "400..420 nm a step of 25 nm leaves one");
	assert_int_equal(spec_coarse_stride(uneven, 4, 10, &stride, &error), SPEC_EUSAGE);
	assert_contains(error.message, "equal distances");
	assert_int_equal(spec_coarse_stride(plain, 1, 5, &stride, &error), SPEC_EUSAGE);
	spec_coarse_repeat(5, 3, weight);
	assert_true(weight[0] == 3 && weight[1] == 0 && weight[2] == 0 && weight[3] == 12 &&
		    weight[4] == 0);
}

/* X, Y and Z of a flat spectrum of bands 1 nm apart, seen by every stride-th of them. */
static void
flat(const struct spec_curve *observer, double first_nm, double last_nm, size_t stride,
	double xyz[3])
{
	size_t count = (size_t)(last_nm - first_nm) + 1;
	double nm[471], weight[3 * 471], outside;
	struct spec_bands bands = {count, nm, NULL, 0};

	for (size_t i = 0; i < count; i++)
		nm[i] = first_nm + (double)i;
	assert_int_equal(
		spec_observer_weights(observer, NULL, &bands, weight, &outside, NULL),
		SPEC_OK);
	for (size_t c = 0; c < 3; c++) {
		spec_coarse_repeat(count, stride, weight + c * count);
		xyz[c] = 0;
		for (size_t i = 0; i < count; i++)
			xyz[c] += weight[c * count + i];
	}
}

/*
 * What steps do to a flat spectrum, white under equal energy: DeltaE*ab as the sums of the
 * CIE's table of 10 degrees have it, computed beside the library and rounded to 1e-3.
 */
static void
test_steps_of_flat_spectrum(void **state)
{
	static const struct {
		double first_nm, last_nm, difference[5]; /* at 8, 16, 32, 64, 128 nm */
	} rows[] = {{360, 830, {.010, .169, .235, 4.245, 45.768}},
		{450, 650, {6.339, 13.113, 25.138, 53.279, 123.437}}};
	struct spec_curve observer;

	(void)state;
	assert_int_equal(spec_observer_load("1964", &observer, NULL), SPEC_OK);
	for (size_t i = 0; i < COUNT(rows); i++) {
		double white[3], xyz[3], lab[3], full[3];

		assert_int_equal(
			spec_observer_white(&observer, NULL, white, NULL), SPEC_OK);
		flat(&observer, rows[i].first_nm, rows[i].last_nm, 1, xyz);
		spec_lab_from_xyz(xyz, white, full);
		for (size_t j = 0; j < 5; j++) {
			flat(&observer, rows[i].first_nm, rows[i].last_nm, (size_t)8 << j,
				xyz);
			spec_lab_from_xyz(xyz, white, lab);
			near(spec_difference_ab76(full, lab), rows[i].difference[j], 5.1e-4,
				"difference");
		}
	}
	spec_curve_free(&observer);
}

static void
test_parse(void **state)
{
	static const char *const bad[] = {"", "-1", "16", "1.5", "4x", "de2000",
		"de2000:", "de2000:x", "de2000-max:-1", "de2000-max:nan", "de94:1",
		"de76-p95:1", ":1", "de:1", "de2000-maxi:1", "DE76:1"};
	struct spec_level level;
	struct spec_error error;

	(void)state;
	assert_int_equal(spec_level_parse("0", &level, &error), SPEC_OK);
	assert_true(level.kind == SPEC_LEVEL_HALVED && level.number == 0);
	assert_int_equal(spec_level_parse("15", &level, &error), SPEC_OK);
	assert_true(level.kind == SPEC_LEVEL_HALVED && level.number == 15);
	assert_int_equal(spec_level_parse("de76:2.5", &level, &error), SPEC_OK);
	assert_true(level.kind == SPEC_LEVEL_BOUNDED && level.formula == SPEC_LEVEL_DE76 &&
		    level.of_mean && level.bound == 2.5);
	assert_int_equal(spec_level_parse("de2000-max:0", &level, &error), SPEC_OK);
	assert_true(level.kind == SPEC_LEVEL_BOUNDED &&
		    level.formula == SPEC_LEVEL_DE2000 && !level.of_mean &&
		    level.bound == 0);
	for (size_t i = 0; i < COUNT(bad); i++) {
		if (spec_level_parse(bad[i], &level, &error) == SPEC_OK)
			fail_msg("'%s' is taken", bad[i]);
	}
	assert_int_equal(spec_level_parse_step("0.01um", &level, &error), SPEC_OK);
	assert_true(level.kind == SPEC_LEVEL_STEP);
	near(level.step_nm, 10, 1e-12, "step");
	assert_int_not_equal(spec_level_parse_step("0", &level, &error), SPEC_OK);
	assert_int_not_equal(spec_level_parse_step("-5", &level, &error), SPEC_OK);
}

int
main(void)
{
	const struct CMUnitTest tests[] = {cmocka_unit_test(test_halves),
		cmocka_unit_test(test_halves_of_513), cmocka_unit_test(test_levels_nest),
		cmocka_unit_test(test_interpolate),
		cmocka_unit_test(test_interpolate_keeps_straight_lines),
		cmocka_unit_test(test_stride),
		cmocka_unit_test(test_steps_of_flat_spectrum),
		cmocka_unit_test(test_parse)};

	return cmocka_run_group_tests(tests, NULL, NULL);
}
