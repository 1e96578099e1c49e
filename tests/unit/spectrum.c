/* lib/spectrum: grids, curves, the spd format, names, and the data in spectra/. */
#include <float.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include "spectrum/curve.h"
#include "spectrum/grid.h"
#include "spectrum/lookup.h"
#include "spectrum/spd.h"

#include "files.h"

#define assert_near(got, want, tolerance) check_near(got, want, tolerance, __LINE__)

static void
check_near(double got, double want, double tolerance, int line)
{
	if (!(fabs(got - want) <= tolerance))
		fail_msg("line %d: got %.9g, want %.9g within %g", line, got, want,
			tolerance);
}

/* ---- grids ---- */

static void
grid_has_its_wavelengths(void **state)
{
	struct spec_grid grid, copy;
	struct spec_error error;

	(void)state;
	assert_int_equal(spec_grid_parse("380:780:5", &grid, &error), SPEC_OK);
	assert_int_equal(grid.count, 81);
	assert_true(grid.wavelength_nm[0] == 380 && grid.wavelength_nm[80] == 780);
	assert_int_equal(spec_grid_copy(&grid, &copy, &error), SPEC_OK);
	spec_grid_free(&grid);
	assert_null(grid.wavelength_nm);
	assert_int_equal(copy.count, 81);
	assert_true(copy.wavelength_nm[1] == 385);
	spec_grid_free(&copy);
	spec_grid_free(&copy);
	spec_grid_free(NULL);

	/* 0.1 is no binary fraction: 10 * 0.1 steps must be found all the same. */
	assert_int_equal(spec_grid_parse("400:401:0.1", &grid, &error), SPEC_OK);
	assert_int_equal(grid.count, 11);
	assert_true(grid.wavelength_nm[10] == 400 + 10 * 0.1);
	spec_grid_free(&grid);
	assert_int_equal(spec_grid_parse("550:550:5", &grid, &error), SPEC_OK);
	assert_int_equal(grid.count, 1);
	spec_grid_free(&grid);
	assert_int_equal(spec_grid_parse("1:32767:1", &grid, &error), SPEC_OK);
	assert_int_equal(grid.count, 32767);
	spec_grid_free(&grid);
}

/* Within 0.001 nm, and within a quarter of the way to the next. */
static void
grid_knows_its_wavelengths(void **state)
{
	static const double known_nm[] = {400, 500, 500.002};
	static const struct {
		double nm;
		size_t nearest;
		int same;
	} cases[] = {{399.9991, 0, 1}, {399.9989, 0, 0}, {400.0009, 0, 1}, {400.0011, 0, 0},
		{499.9996, 1, 1}, {499.9994, 1, 0}, {500.0004, 1, 1}, {500.0006, 1, 0},
		{500.0014, 2, 0}, {500.0016, 2, 1}, {500.0024, 2, 1}, {500.0026, 2, 0},
		{1, 0, 0}, {1e9, 2, 0}};
	int same;

	(void)state;
	for (size_t i = 0; i < COUNT(cases); i++) {
		assert_int_equal(
			spec_grid_nearest(known_nm, COUNT(known_nm), cases[i].nm, &same),
			cases[i].nearest);
		if (same != cases[i].same)
			fail_msg("%.10g nm", cases[i].nm);
	}
	assert_int_equal(spec_grid_nearest(known_nm, 1, 400.0009, &same), 0);
	assert_true(same);
}

static void
grid_refuses_nonsense(void **state)
{
	static const struct {
		const char *text;
		enum spec_status status;
		const char *message;
	} cases[] = {
		{"", SPEC_EUSAGE, "not LO:HI:STEP"},
		{"400", SPEC_EUSAGE, "not LO:HI:STEP"},
		{"400:700", SPEC_EUSAGE, "not LO:HI:STEP"},
		{"400:700:", SPEC_EUSAGE, "not LO:HI:STEP"},
		{"400:700:5:", SPEC_EUSAGE, "not LO:HI:STEP"},
		{"400:700:5nm", SPEC_EUSAGE, "not LO:HI:STEP"},
		{" 400:700:5", SPEC_EUSAGE, "not LO:HI:STEP"},
		{"400;700;5", SPEC_EUSAGE, "not LO:HI:STEP"},
		{"400:nan:5", SPEC_EUSAGE, "not LO:HI:STEP"},
		{"400:inf:5", SPEC_EUSAGE, "not LO:HI:STEP"},
		{"400:1e999:5", SPEC_EUSAGE, "not LO:HI:STEP"},
		{"700:400:5", SPEC_EUSAGE, "reversed"},
		{"400:700:0", SPEC_EUSAGE, "not positive"},
		{"400:700:-5", SPEC_EUSAGE, "not positive"},
		{"400:702:5", SPEC_EUSAGE, "nearest that fits is 700"},
		{"400:704:5", SPEC_EUSAGE, "nearest that fits is 705"},
		{"400:402:50", SPEC_EUSAGE, "nearest that fits is 400"},
		{"999990:999999:6", SPEC_EUSAGE, "nearest that fits is 999996"},
		{"0.5:700:5", SPEC_ERANGE, "leaves 1..1000000 nm"},
		{"0:700:5", SPEC_ERANGE, "leaves 1..1000000 nm"},
		{"400:1000001:1", SPEC_ERANGE, "leaves 1..1000000 nm"},
		{"1:32768:1", SPEC_ERANGE, "more than 32767"},
		{"400:700:1e-320", SPEC_ERANGE, "more than 32767"},
		/* Ten steps of a tenth of the distance between neighbouring doubles. */
		{"999999:999999.00000000011641532:1.1641532e-11", SPEC_ERANGE, "too small"},
	};
	struct spec_grid grid;
	struct spec_error error;

	(void)state;
	for (size_t i = 0; i < sizeof cases / sizeof cases[0]; i++) {
		assert_int_equal(
			spec_grid_parse(cases[i].text, &grid, &error), cases[i].status);
		assert_contains(error.message, cases[i].message);
		assert_null(grid.wavelength_nm);
		assert_int_equal(
			spec_grid_parse(cases[i].text, &grid, NULL), cases[i].status);
	}
	assert_int_equal(spec_grid_new(0, &grid, &error), SPEC_ERANGE);
	assert_int_equal(spec_grid_new(32768, &grid, &error), SPEC_ERANGE);
}

/* ---- the format ---- */

static enum spec_status
parse(const char *text, struct spec_curve *curve, struct spec_error *error)
{
	return spec_spd_parse(text, strlen(text), "t.spd", curve, error);
}

static void
spd_reads_a_full_file(void **state)
{
	struct spec_curve curve;
	struct spec_error error;

	(void)state;
	assert_int_equal(
		parse("\xef\xbb\xbf# title: Some metal \r\n#quantity:refractive index\n"
		      "# unit: 1\n#  source: A: B, 1972\n# medium: vacuum\n"
		      "# licence: none\n# no key here\n#\n\n"
		      "# columns: wavelength_nm n k\n"
		      "  400.5\t1.5e0   -2 \n\n# title: only a comment by now\n"
		      "500 , .25,3.",
			&curve, &error),
		SPEC_OK);
	assert_string_equal(curve.title, "Some metal");
	assert_string_equal(curve.quantity, "refractive index");
	assert_string_equal(curve.unit, "1");
	assert_string_equal(curve.source, "A: B, 1972");
	assert_string_equal(curve.medium, "vacuum");
	assert_int_equal(curve.count, 2);
	assert_int_equal(curve.columns, 2);
	assert_string_equal(curve.column[0], "n");
	assert_string_equal(curve.column[1], "k");
	assert_true(curve.wavelength_nm[0] == 400.5 && curve.wavelength_nm[1] == 500);
	assert_true(curve.value[0] == 1.5 && curve.value[1] == 0.25);
	assert_true(curve.value[2] == -2 && curve.value[3] == 3);
	assert_int_equal(spec_curve_find_column(&curve, "k"), 1);
	assert_int_equal(spec_curve_find_column(&curve, "R"), 2);
	spec_curve_free(&curve);
}

static void
spd_reads_plain_pairs_and_csv(void **state)
{
	struct spec_curve curve;
	struct spec_error error;

	(void)state;
	assert_int_equal(parse("400 1\r\n500 2\r\n", &curve, &error), SPEC_OK);
	assert_string_equal(curve.title, "");
	assert_string_equal(curve.quantity, "");
	assert_string_equal(curve.medium, "");
	assert_string_equal(curve.column[0], "value");
	assert_int_equal(curve.count, 2);
	spec_curve_free(&curve);
	assert_int_equal(parse("400,1,2\n500,3,4\n", &curve, &error), SPEC_OK);
	assert_string_equal(curve.column[1], "value2");
	assert_true(curve.value[1] == 3 && curve.value[2] == 2);
	spec_curve_free(&curve);
	assert_int_equal(parse("wavelength_nm,n, k\n400,1,2", &curve, &error), SPEC_OK);
	assert_string_equal(curve.column[0], "n");
	assert_string_equal(curve.column[1], "k");
	spec_curve_free(&curve);
}

/* Cameras' curves, say, by who measured them. */
static void
spd_reads_the_tables_of_others(void **state)
{
	static const char *const first[] = {"wavelength", "Wavelength (nm)",
		"WAVELENGTH(nm)", "Wavelength [nm]", "wavelength[NM]", "Wavelength_nm"};
	struct spec_curve curve;
	struct spec_error error;

	(void)state;
	for (size_t i = 0; i < sizeof first / sizeof first[0]; i++) {
		char text[80];

		snprintf(text, sizeof text, "%s,r,g,b\n400,1,2,3\n500,4,5,6\n", first[i]);
		assert_int_equal(parse(text, &curve, &error), SPEC_OK);
		assert_int_equal(curve.columns, 3);
		assert_string_equal(curve.column[0], "r");
		assert_true(curve.value[1] == 4 && curve.value[5] == 6);
		spec_curve_free(&curve);
	}
	assert_int_equal(
		parse("# range: 400-500 nm, step 100 nm\n400 1\n500 2\n", &curve, &error),
		SPEC_OK);
	assert_true(curve.count == 2 && curve.value[1] == 2);
	spec_curve_free(&curve);
}

static void
spd_refuses_damage(void **state)
{
	static const struct {
		const char *text, *message;
	} cases[] = {
		{"", "without a row"},
		{"# title: t\n", "t.spd:1: the file ends without a row"},
		{"400\n", "t.spd:1: a row needs a wavelength and a value"},
		{"400 1\n500\n", "t.spd:2: a row needs"},
		{"400 1\n500 1 2\n", "t.spd:2: 3 numbers where the rows above have 2"},
		{"# columns: wavelength_nm n k\n400 1\n",
			"t.spd:2: 2 numbers where the header"},
		{"400 1\n400 2\n", "t.spd:2: the wavelength 400 nm does not lie above"},
		{"400 1\n\n390 2\n", "t.spd:3: the wavelength 390 nm does not lie above"},
		{"0 1\n", "t.spd:1: the wavelength 0 nm is not positive"},
		{"-400 1\n", "is not positive"},
		{"400 nan\n", "'nan' is not a finite number"},
		{"400 -inf\n", "'-inf' is not a finite number"},
		{"400 1e999\n", "'1e999' is not a finite number"},
		{"400 1x\n", "'1x' is not a finite number"},
		{"400 0x10\n", "'0x10' is not a finite number"},
		{"400 1;2\n", "'1;2' is not a finite number"},
		{"nm value\n400 1\n", "t.spd:1: 'nm' is not a finite number"},
		{"wavelength_um,n\n.4,1\n", "t.spd:1: 'wavelength_um' is not a finite"},
		{"wavelength (um),n\n.4,1\n",
			"t.spd:2: 2 numbers where the header names 3"},
		{"wavelength\n400 1\n", "t.spd:1: the columns are not wavelength_nm and"},
		{"400,,1\n", "a value is missing"},
		{"400,1,\n", "a value is missing"},
		{",400,1\n", "a value is missing"},
		{"# medium: glass\n400 1\n", "t.spd:1: the medium is neither"},
		{"# unit: 1\n# unit: 2\n400 1\n", "t.spd:2: the header has 'unit:' twice"},
		{"# columns: nm n\n400 1\n", "not wavelength_nm but 'nm'"},
		{"# columns: wavelength_nm\n400 1\n", "not wavelength_nm and others"},
		{"# columns:\n400 1\n", "not wavelength_nm and others"},
		{"# columns: wavelength_nm,,n\n400 1\n", "a column has no name"},
		{"# columns: wavelength_nm n,\n400 1\n", "a column has no name"},
		{"# columns: wavelength_nm n\nwavelength_nm,n\n400 1\n", "named twice"},
	};
	struct spec_curve curve;
	struct spec_error error;

	(void)state;
	for (size_t i = 0; i < sizeof cases / sizeof cases[0]; i++) {
		assert_int_equal(parse(cases[i].text, &curve, &error), SPEC_EFORMAT);
		assert_contains(error.message, cases[i].message);
		assert_null(curve.title);
		assert_null(curve.value);
		assert_int_equal(parse(cases[i].text, &curve, NULL), SPEC_EFORMAT);
	}
	assert_int_equal(spec_spd_parse("400 1\n5\0 2\n", 12, "t.spd", &curve, &error),
		SPEC_EFORMAT);
	assert_contains(error.message, "t.spd:2: a zero byte");
}

static void
spd_keeps_its_limits(void **state)
{
	size_t size = SPEC_SPD_LONGEST_LINE + 16, length;
	char *text = malloc(size);
	struct spec_curve curve;
	struct spec_error error;

	(void)state;
	memset(text, ' ', size);
	memcpy(text, "400 1", 5);
	memcpy(text + SPEC_SPD_LONGEST_LINE, "\r\n", 2);
	assert_int_equal(
		spec_spd_parse(text, SPEC_SPD_LONGEST_LINE + 2, "t", &curve, &error),
		SPEC_OK);
	spec_curve_free(&curve);
	memcpy(text + SPEC_SPD_LONGEST_LINE, " \n", 2);
	assert_int_equal(
		spec_spd_parse(text, SPEC_SPD_LONGEST_LINE + 2, "t", &curve, &error),
		SPEC_ERANGE);
	assert_contains(error.message, "t:1: the line is longer than 262144 bytes");
	memset(text + SPEC_SPD_LONGEST_LINE, ' ', 16);
	assert_int_equal(spec_spd_parse(text, size, "t", &curve, &error), SPEC_ERANGE);
	free(text);

	text = malloc((SPEC_SPD_MOST_ROWS + 1) * (size_t)10);
	length = 0;
	for (int i = 1; i <= SPEC_SPD_MOST_ROWS + 1; i++)
		length += (size_t)sprintf(text + length, "%d 1\n", i);
	assert_int_equal(spec_spd_parse(text, length, "t", &curve, &error), SPEC_ERANGE);
	assert_contains(error.message, "t:1000001: more than 1000000 rows");
	length -= strlen("1000001 1\n");
	assert_int_equal(spec_spd_parse(text, length, "t", &curve, &error), SPEC_OK);
	assert_int_equal(curve.count, SPEC_SPD_MOST_ROWS);
	spec_curve_free(&curve);
	free(text);
}

static void
spd_reports_the_system(void **state)
{
	struct spec_curve curve;
	struct spec_error error;
	FILE *file;

	(void)state;
	assert_int_equal(spec_spd_load("/nonexistent/x.spd", &curve, &error), SPEC_EIO);
	assert_contains(error.message, "unable to open '/nonexistent/x.spd': No such file");
	assert_int_equal(spec_spd_load("/", &curve, &error), SPEC_EIO);
	assert_contains(error.message, "unable to read '/'");
	assert_int_equal(parse("400 1\n", &curve, &error), SPEC_OK);
	file = fopen("/dev/full", "w");
	if (file) {
		assert_int_equal(spec_spd_write(file, &curve, &error), SPEC_EIO);
		assert_contains(error.message, "No space left");
		fclose(file);
	}
	spec_curve_free(&curve);
}

/* ---- writing ---- */

static void
numbers_are_short(void **state)
{
	static const struct {
		double value;
		const char *text;
	} cases[] = {{0, "0"}, {100, "100"}, {0.1, "0.1"}, {-2.5, "-2.5"}, {1e-7, "1e-07"},
		{0.0001299, "0.0001299"}, {1e15, "1000000000000000"}, {1e16, "1e+16"},
		{1.0 / 3, "0.3333333333333333"}, {DBL_TRUE_MIN, "5e-324"},
		{DBL_MAX, "1.7976931348623157e+308"}, {632.8, "632.8"}};
	char text[SPEC_SPD_NUMBER];

	(void)state;
	for (size_t i = 0; i < sizeof cases / sizeof cases[0]; i++) {
		size_t length = spec_spd_format_number(cases[i].value, text);

		assert_int_equal(length, strlen(text));
		assert_string_equal(text, cases[i].text);
	}
}

/* A xorshift generator (Marsaglia 2003, J. Stat. Softw. 8(14)): fixed seed, any bits. */
static uint64_t
next_bits(uint64_t *bits)
{
	*bits ^= *bits << 13;
	*bits ^= *bits >> 7;
	*bits ^= *bits << 17;
	return *bits;
}

static void
fill_with_any_bits(struct spec_curve *curve)
{
	uint64_t bits = 88172645463325252u;
	double nm = 1;

	for (size_t i = 0; i < curve->count; i++) {
		curve->wavelength_nm[i] = nm;
		nm += (double)(next_bits(&bits) >> 11) * 0x1p-53 + 1e-9;
	}
	for (size_t i = 0; i < curve->count * curve->columns; i++) {
		do {
			uint64_t any = next_bits(&bits);

			memcpy(&curve->value[i], &any, sizeof any);
		} while (!isfinite(curve->value[i]));
	}
	curve->value[0] = -0.0;
	curve->value[1] = DBL_TRUE_MIN;
	curve->value[2] = -DBL_MAX;
	curve->value[3] = DBL_MIN;
	curve->value[4] = 0x1p53 + 2;
}

static void
writing_and_reading_is_the_identity(void **state)
{
	struct spec_curve curve, copy, back;
	struct spec_error error;
	FILE *file = tmpfile();

	(void)state;
	assert_int_equal(spec_curve_new(5000, 3, &curve, &error), SPEC_OK);
	assert_string_equal(curve.column[2], "value3");
	assert_int_equal(
		spec_curve_set_text(&curve.title, "Any µ: bits # here", &error), SPEC_OK);
	assert_int_equal(spec_curve_set_text(&curve.unit, "W m^-2 nm^-1", &error), SPEC_OK);
	assert_int_equal(spec_curve_set_text(&curve.medium, "air", &error), SPEC_OK);
	assert_int_equal(spec_curve_set_text(&curve.column[1], "k", &error), SPEC_OK);
	fill_with_any_bits(&curve);
	assert_int_equal(spec_curve_copy(&curve, &copy, &error), SPEC_OK);
	assert_int_equal(spec_spd_write(file, &curve, &error), SPEC_OK);
	rewind(file);
	assert_int_equal(spec_spd_read(file, "t", &back, &error), SPEC_OK);
	fclose(file);
	assert_string_equal(back.title, curve.title);
	assert_string_equal(back.quantity, "");
	assert_string_equal(back.unit, curve.unit);
	assert_string_equal(back.source, "");
	assert_string_equal(back.medium, "air");
	assert_int_equal(back.count, 5000);
	assert_int_equal(back.columns, 3);
	for (size_t i = 0; i < 3; i++) {
		assert_string_equal(back.column[i], curve.column[i]);
		assert_string_equal(copy.column[i], curve.column[i]);
	}
	assert_memory_equal(back.wavelength_nm, curve.wavelength_nm, 5000 * sizeof(double));
	assert_memory_equal(back.value, curve.value, 15000 * sizeof(double));
	assert_memory_equal(copy.value, curve.value, 15000 * sizeof(double));
	spec_curve_free(&curve);
	spec_curve_free(&copy);
	spec_curve_free(&back);
	spec_curve_free(NULL);
}

/* Sets a text of a good curve, which then cannot be written; puts the old one back. */
static void
assert_unwritable(
	struct spec_curve *curve, char **field, const char *text, const char *message)
{
	struct spec_error error;
	char *old = *field;
	FILE *file = tmpfile();

	*field = NULL;
	assert_int_equal(spec_curve_set_text(field, text, &error), SPEC_OK);
	assert_int_equal(spec_spd_write(file, curve, &error), SPEC_ERANGE);
	assert_contains(error.message, message);
	assert_int_equal(ftell(file), 0);
	fclose(file);
	free(*field);
	*field = old;
}

static void
writing_refuses_what_cannot_be_read(void **state)
{
	struct spec_curve curve;
	struct spec_error error;
	FILE *file = tmpfile();

	(void)state;
	assert_int_equal(parse("400 1\n500 2\n", &curve, &error), SPEC_OK);
	assert_unwritable(&curve, &curve.title, "two\nlines", "no line of an spd file");
	assert_unwritable(&curve, &curve.source, " blank", "no line of an spd file");
	assert_unwritable(&curve, &curve.medium, "water", "neither air nor vacuum");
	assert_unwritable(
		&curve, &curve.column[0], "a b", "cannot be the name of a column");
	assert_unwritable(
		&curve, &curve.column[0], "a,b", "cannot be the name of a column");
	assert_unwritable(&curve, &curve.column[0], "", "cannot be the name of a column");
	curve.value[1] = NAN;
	assert_int_equal(spec_spd_write(file, &curve, &error), SPEC_ERANGE);
	assert_contains(error.message, "at 500 nm is not finite");
	curve.value[1] = 0;
	curve.wavelength_nm[1] = 400;
	assert_int_equal(spec_spd_write(file, &curve, &error), SPEC_ERANGE);
	curve.wavelength_nm[1] = INFINITY;
	assert_int_equal(spec_spd_write(file, &curve, &error), SPEC_ERANGE);
	assert_int_equal(ftell(file), 0);
	fclose(file);
	spec_curve_free(&curve);
	assert_int_equal(spec_curve_new(0, 1, &curve, &error), SPEC_ERANGE);
	assert_int_equal(spec_curve_new(1, 0, &curve, &error), SPEC_ERANGE);
	assert_int_equal(spec_curve_new(SIZE_MAX / 8, 1, &curve, &error), SPEC_ENOMEM);
}

/* ---- sampling ---- */

static void
sampling_is_linear_between(void **state)
{
	static const double at_nm[] = {
		600, 400, 500, 450, 475, 500.1, 400 - 1e-7, 600 + 1e-7};
	static const double want[] = {
		0.3, 0.1, 0.7, 0.4, 0.55, 0.7 - 0.4 * 0.001, 0.1, 0.3};
	struct spec_curve curve;
	struct spec_error error;
	double value[8];

	(void)state;
	assert_int_equal(
		parse("400 9 0.1\n500 9 0.7\n600 9 0.3\n", &curve, &error), SPEC_OK);
	assert_int_equal(spec_curve_sample(&curve, 1, SPEC_EXTRAPOLATE_REFUSE, at_nm, 8,
				 value, &error),
		SPEC_OK);
	for (int i = 0; i < 8; i++)
		assert_near(
			value[i], want[i], 1e-13); /* rounding of a few operations near 1 */
	/* The samples themselves, and level stretches, are exact. */
	assert_true(value[0] == 0.3 && value[1] == 0.1 && value[2] == 0.7);
	assert_int_equal(spec_curve_sample(&curve, 0, SPEC_EXTRAPOLATE_REFUSE, at_nm, 8,
				 value, &error),
		SPEC_OK);
	for (int i = 0; i < 8; i++)
		assert_true(value[i] == 9);
	assert_int_equal(spec_curve_sample(
				 &curve, 2, SPEC_EXTRAPOLATE_ZERO, at_nm, 8, value, &error),
		SPEC_ERANGE);
	spec_curve_free(&curve);
}

static void
sampling_outside_follows_the_rule(void **state)
{
	static const double at_nm[] = {390, 610, 500};
	struct spec_curve curve;
	struct spec_error error;
	double value[3], nan_nm = NAN, just_outside_nm = 600 + 1e-5;

	(void)state;
	assert_int_equal(parse("# title: Lamp 7\n400 1\n600 3\n", &curve, &error), SPEC_OK);
	assert_int_equal(spec_curve_sample(&curve, 0, SPEC_EXTRAPOLATE_REFUSE, at_nm + 1, 1,
				 value, &error),
		SPEC_ERANGE);
	assert_string_equal(error.message, "'Lamp 7' covers 400..600 nm, not 610 nm");
	assert_int_equal(spec_curve_sample(&curve, 0, SPEC_EXTRAPOLATE_REFUSE,
				 &just_outside_nm, 1, value, &error),
		SPEC_ERANGE);
	assert_int_equal(spec_curve_sample(
				 &curve, 0, SPEC_EXTRAPOLATE_ZERO, at_nm, 3, value, &error),
		SPEC_OK);
	assert_true(value[0] == 0 && value[1] == 0 && value[2] == 2);
	assert_int_equal(spec_curve_sample(&curve, 0, SPEC_EXTRAPOLATE_CONSTANT, at_nm, 3,
				 value, &error),
		SPEC_OK);
	assert_true(value[0] == 1 && value[1] == 3 && value[2] == 2);
	for (int rule = SPEC_EXTRAPOLATE_REFUSE; rule <= SPEC_EXTRAPOLATE_CONSTANT; rule++)
		assert_int_equal(spec_curve_sample(&curve, 0, (enum spec_extrapolate)rule,
					 &nan_nm, 1, value, &error),
			SPEC_ERANGE);
	spec_curve_free(&curve);
}

static void
one_sample_is_known_at_its_wavelength_alone(void **state)
{
	static const double at_nm[] = {632.8, 632};
	struct spec_curve curve;
	struct spec_error error;
	double value[2];

	(void)state;
	assert_int_equal(parse("632.8 1.5\n", &curve, &error), SPEC_OK);
	assert_int_equal(spec_curve_sample(&curve, 0, SPEC_EXTRAPOLATE_REFUSE, at_nm, 1,
				 value, &error),
		SPEC_OK);
	assert_true(value[0] == 1.5);
	assert_int_equal(spec_curve_sample(&curve, 0, SPEC_EXTRAPOLATE_REFUSE, at_nm, 2,
				 value, &error),
		SPEC_ERANGE);
	assert_contains(error.message, "the curve covers 632.8..632.8 nm, not 632 nm");
	assert_int_equal(spec_curve_sample(
				 &curve, 0, SPEC_EXTRAPOLATE_ZERO, at_nm, 2, value, &error),
		SPEC_OK);
	assert_true(value[0] == 1.5 && value[1] == 0);
	spec_curve_free(&curve);
}

/* ---- names ---- */

static char own_data[4096]; /* the repository's spectra/, or "" */

/* A file of one sample of that value. */
static void
make_file(const char *path, int value)
{
	char text[32];

	snprintf(text, sizeof text, "500 %d\n", value);
	save_text(path, text);
}

static int
make_scratch(void **state)
{
	(void)state;
	if (scratch_make("spectrum") != 0)
		return -1;
	make_folder("a");
	make_folder("a/glass");
	make_folder("a/glass/sub");
	make_folder("a/glass/sub/deep");
	make_folder("a/metals");
	make_folder("a/other");
	make_folder("b");
	make_folder("b/glass");
	make_file("a/glass/crown.spd", 1);
	make_file("a/glass/sub/flint.spd", 2);
	make_file("a/glass/sub/deep/lost.spd", 3);
	make_file("a/metals/twice.spd", 4);
	make_file("a/glass/twice.spd", 5);
	make_file("a/glass/notes.txt", 6);
	make_file("a/other/hidden.spd", 7);
	make_folder("a/glass/.veil");
	make_file("a/glass/.veil/behind.spd", 13);
	make_file("a/glass/.veiled.spd", 14);
	make_file("a/glass/Case.spd", 8);
	make_file("a/metals/case.spd", 9);
	make_file("b/glass/crown.spd", 10);
	make_file("b/glass/second.spd", 11);
	make_file("plain.csv", 12);
	return 0;
}

static void
search_scratch(void)
{
	char path[256];

	snprintf(path, sizeof path, "%s/a::%s/b:%s/none", scratch, scratch, scratch);
	setenv("SPECTRA_PATH", path, 1);
}

static void
search_own_data(void)
{
	if (own_data[0])
		setenv("SPECTRA_PATH", own_data, 1);
	else
		unsetenv("SPECTRA_PATH");
}

static void
names_are_found(void **state)
{
	static const struct {
		const char *name;
		int value;
	} cases[] = {{"crown", 1}, {"glass/crown", 1}, {"flint", 2}, {"sub/flint", 2},
		{"glass/sub/flint", 2}, {"metals/twice", 4}, {"glass/twice", 5},
		{"Case", 8}, {"case", 9}, {"second", 11}, {"SECOND", 11},
		{"Glass/Second", 11}, {"Metals/Twice", 4}};
	struct spec_curve curve;
	struct spec_error error;

	(void)state;
	search_scratch();
	for (size_t i = 0; i < sizeof cases / sizeof cases[0]; i++) {
		if (spec_lookup_curve(cases[i].name, &curve, &error) != SPEC_OK)
			fail_msg("%s: %s", cases[i].name, error.message);
		assert_true(curve.value[0] == cases[i].value);
		spec_curve_free(&curve);
	}
}

static void
paths_are_read(void **state)
{
	char path[256];
	struct spec_curve curve;
	struct spec_error error;

	(void)state;
	search_scratch();
	snprintf(path, sizeof path, "%s/plain.csv", scratch);
	assert_int_equal(spec_lookup_curve(path, &curve, &error), SPEC_OK);
	assert_true(curve.value[0] == 12);
	spec_curve_free(&curve);
	snprintf(path, sizeof path, "%s/gone.spd", scratch);
	assert_int_equal(spec_lookup_curve(path, &curve, &error), SPEC_EUSAGE);
	assert_contains(error.message, "no such file, nor is it in");
	assert_int_equal(spec_lookup_curve("/dev", &curve, &error), SPEC_EUSAGE);
}

static void
doubtful_names_are_refused(void **state)
{
	static const struct {
		const char *name, *message;
	} cases[] = {
		{"twice", "fits two spectra"},
		{"twice", "/a/glass/twice.spd"},
		{"twice", "/a/metals/twice.spd"},
		{"CASE", "fits two spectra"},
		{"lost", "no spectrum 'lost': it is not in /tmp/"},
		{"hidden", "no spectrum 'hidden'"},
		{"behind", "no spectrum 'behind'"},
		{".veiled", "no spectrum '.veiled'"},
		{"notes", "no spectrum 'notes'"},
		{"wn", "did you mean 'crown'?"},
		{"crwn", "did you mean 'crown'?"},
		{"Flimt", "did you mean 'flint'?"},
		{"glas/crown", "did you mean 'glass/crown'?"},
		{"crown.spd", "did you mean 'crown'?"},
		{"../a/glass/crown", "no spectrum"},
		{"", "no spectrum ''"},
	};
	struct spec_curve curve;
	struct spec_error error;

	(void)state;
	search_scratch();
	for (size_t i = 0; i < sizeof cases / sizeof cases[0]; i++) {
		assert_int_equal(
			spec_lookup_curve(cases[i].name, &curve, &error), SPEC_EUSAGE);
		assert_contains(error.message, cases[i].message);
		assert_null(curve.value);
		assert_int_equal(
			spec_lookup_curve(cases[i].name, &curve, NULL), SPEC_EUSAGE);
	}
	assert_int_equal(spec_lookup_curve("qqqqqqq", &curve, &error), SPEC_EUSAGE);
	assert_null(strstr(error.message, "did you mean"));
}

static void
names_are_listed(void **state)
{
	struct spec_error error;
	char **names;
	size_t count, crowns = 0;

	(void)state;
	search_scratch();
	assert_int_equal(spec_lookup_list(&names, &count, &error), SPEC_OK);
	assert_in_range(count, 7, 1000);
	for (size_t i = 0; i < count; i++) {
		assert_true(i == 0 || strcmp(names[i - 1], names[i]) < 0);
		crowns += strcmp(names[i], "glass/crown") == 0;
		assert_null(strstr(names[i], "hidden"));
	}
	assert_int_equal(crowns, 1);
	spec_lookup_free_list(names, count);
	spec_lookup_free_list(NULL, 0);
}

static void
own_data_lie_beside_the_program(void **state)
{
	char path[4096];
	ssize_t length = readlink("/proc/self/exe", path, sizeof path - 64);
	struct spec_curve curve;
	struct spec_error error;

	(void)state;
	assert_in_range(length, 1, sizeof path - 64);
	path[length] = '\0';
	strcpy(strrchr(path, '/'), "/../share/spectools/spectra/illuminants/D65.spd");
	if (access(path, R_OK) != 0)
		skip(); /* the link is made by make, not by this test */
	unsetenv("SPECTRA_PATH");
	assert_int_equal(spec_lookup_curve("D65", &curve, &error), SPEC_OK);
	spec_curve_free(&curve);
}

/* ---- the data ---- */

static void
load(const char *name, struct spec_curve *curve)
{
	struct spec_error error;

	search_own_data();
	if (spec_lookup_curve(name, curve, &error) != SPEC_OK)
		fail_msg("%s", error.message);
}

static double
value_at(const char *name, const char *column, double nm)
{
	struct spec_curve curve;
	struct spec_error error;
	double value;

	load(name, &curve);
	if (spec_curve_sample(&curve, spec_curve_find_column(&curve, column),
		    SPEC_EXTRAPOLATE_REFUSE, &nm, 1, &value, &error) != SPEC_OK)
		fail_msg("%s", error.message);
	spec_curve_free(&curve);
	return value;
}

static void
every_file_is_complete(void **state)
{
	static const char *const quantities[] = {"colour-matching function",
		"cone fundamental", "luminous efficiency", "daylight component",
		"spectral power distribution", "refractive index", "reflectance",
		"sky model coefficient"};
	struct spec_error error;
	char **names;
	size_t count;

	(void)state;
	search_own_data();
	assert_int_equal(spec_lookup_list(&names, &count, &error), SPEC_OK);
	assert_in_range(count, 100, 100000);
	for (size_t i = 0; i < count; i++) {
		struct spec_curve curve;
		size_t known = 0;

		load(names[i], &curve);
		for (size_t j = 0; j < sizeof quantities / sizeof quantities[0]; j++)
			known += strcmp(curve.quantity, quantities[j]) == 0;
		if (!*curve.title || known != 1 || !*curve.unit || !*curve.source)
			fail_msg("%s lacks a title, quantity, unit or source", names[i]);
		if (strcmp(curve.quantity, "refractive index") != 0)
			assert_string_equal(curve.medium, "air");
		else
			assert_string_equal(curve.column[0], "n");
		if (strcmp(curve.quantity, "reflectance") == 0)
			for (size_t j = 0; j < curve.count; j++)
				assert_true(curve.value[j] >= 0 && curve.value[j] <= 1);
		/* A short name must do: no two files have the same one. */
		spec_curve_free(&curve);
		load(strrchr(names[i], '/') + 1, &curve);
		spec_curve_free(&curve);
	}
	spec_lookup_free_list(names, count);
}

static void
observers_have_their_sums(void **state)
{
	/* The sums of the 1 nm tables of ISO 11664-1:2007. */
	static const double sums[2][3] = {
		{106.865, 106.857, 106.892}, {116.649, 116.662, 116.674}};
	static const char *const names[] = {"cie1931", "cie1964"}, *const xyz[] = {
									   "x", "y", "z"};

	(void)state;
	for (int i = 0; i < 2; i++) {
		struct spec_curve curve;

		load(names[i], &curve);
		assert_int_equal(curve.count, 471);
		assert_true(
			curve.wavelength_nm[0] == 360 && curve.wavelength_nm[470] == 830);
		for (int j = 0; j < 3; j++) {
			double sum = 0;

			assert_string_equal(curve.column[j], xyz[j]);
			for (int k = 0; k < 471; k++)
				sum += curve.value[j * 471 + k];
			assert_near(sum, sums[i][j], 1e-3);
		}
		spec_curve_free(&curve);
	}
}

static void
illuminants_are_normalised(void **state)
{
	static const char *const names[] = {"A", "D50", "D55", "D65", "D75", "E"};
	struct spec_curve curve;

	(void)state;
	for (size_t i = 0; i < sizeof names / sizeof names[0]; i++)
		assert_near(value_at(names[i], "S", 560), 100, 0);
	load("E", &curve);
	assert_true(curve.wavelength_nm[0] <= 360);
	assert_true(curve.wavelength_nm[curve.count - 1] >= 830);
	for (size_t i = 0; i < curve.count; i++)
		assert_true(curve.value[i] == 100);
	spec_curve_free(&curve);
	/* ISO 11664-2:2007, the ends of the table. */
	assert_near(value_at("D65", "S", 300), 0.0341, 0);
	assert_near(value_at("D65", "S", 830), 60.3125, 0);
	/* ISO 11664-2:2007, illuminant A to six digits. */
	assert_near(value_at("A", "S", 300), 0.930483, 5e-7);
	assert_near(value_at("A", "S", 780), 241.675, 5e-4);
}

/* The chromaticity of an illuminant: 5 nm sums over the range of its table. */
static void
chromaticity(const char *illuminant, const char *observer, double *x, double *y)
{
	struct spec_curve light, eye;
	double sum[3] = {0};

	load(illuminant, &light);
	load(observer, &eye);
	for (double nm = 360; nm <= 830; nm += 5) {
		double power, weight;

		if (nm < light.wavelength_nm[0] ||
			nm > light.wavelength_nm[light.count - 1])
			continue;
		assert_int_equal(spec_curve_sample(&light, 0, SPEC_EXTRAPOLATE_REFUSE, &nm,
					 1, &power, NULL),
			SPEC_OK);
		for (size_t j = 0; j < 3; j++) {
			assert_int_equal(spec_curve_sample(&eye, j, SPEC_EXTRAPOLATE_REFUSE,
						 &nm, 1, &weight, NULL),
				SPEC_OK);
			sum[j] += power * weight;
		}
	}
	*x = sum[0] / (sum[0] + sum[1] + sum[2]);
	*y = sum[1] / (sum[0] + sum[1] + sum[2]);
	spec_curve_free(&light);
	spec_curve_free(&eye);
}

static void
illuminants_have_their_published_chromaticities(void **state)
{
	/*
	 * A, C, D50, D55, D65 at 2 degrees: CIE 15:2004, Colorimetry, 3rd edition. The
	 * others: the table of white points to five digits for both observers that is quoted
	 * everywhere (for one by Wikipedia, "Standard illuminant"). Two printings of it
	 * differ by up to two units of the fifth digit. One or two units of the fourth are
	 * allowed for another step and range of the sums, and three for the lamps, whose
	 * tables have two decimals.
	 */
	static const struct {
		const char *name;
		double x, y, x10, y10, tolerance, tolerance10;
	} cases[] = {
		{"A", 0.44758, 0.40745, 0.45117, 0.40594, 1e-4, 2e-4},
		{"C", 0.31006, 0.31616, 0.31039, 0.31905, 1e-4, 2e-4},
		{"D50", 0.34567, 0.35851, 0.34773, 0.35952, 1e-4, 2e-4},
		{"D55", 0.33243, 0.34744, 0.33411, 0.34877, 1e-4, 2e-4},
		{"D65", 0.31272, 0.32903, 0.31382, 0.33100, 1e-4, 2e-4},
		{"D75", 0.29902, 0.31485, 0.29968, 0.31740, 1e-4, 2e-4},
		{"E", 1.0 / 3, 1.0 / 3, 1.0 / 3, 1.0 / 3, 1e-4, 2e-4},
		{"F2", 0.37208, 0.37529, 0.37925, 0.36733, 3e-4, 3e-4},
		{"F7", 0.31292, 0.32933, 0.31569, 0.32960, 3e-4, 3e-4},
		{"F11", 0.38052, 0.37713, 0.38541, 0.37123, 3e-4, 3e-4},
	};

	(void)state;
	for (size_t i = 0; i < sizeof cases / sizeof cases[0]; i++) {
		double x, y;

		chromaticity(cases[i].name, "cie1931", &x, &y);
		assert_near(x, cases[i].x, cases[i].tolerance);
		assert_near(y, cases[i].y, cases[i].tolerance);
		chromaticity(cases[i].name, "cie1964", &x, &y);
		assert_near(x, cases[i].x10, cases[i].tolerance10);
		assert_near(y, cases[i].y10, cases[i].tolerance10);
	}
}

static void
glasses_have_their_published_index(void **state)
{
	/*
	 * n_d at 587.5618 nm: SCHOTT data sheets of N-BK7, SF11 and F5 (five decimals);
	 * fused silica: Malitson 1965, table I; diamond: Peter 1923, as the formula gives
	 * 2.4168 near 589 nm; water: 1.333 of every handbook at 20 °C.
	 */
	static const struct {
		const char *name;
		double n, tolerance;
	} cases[] = {{"N-BK7", 1.51680, 2e-5}, {"SF11", 1.78472, 2e-5},
		{"F5", 1.60342, 2e-5}, {"fused-silica", 1.45846, 3e-5},
		{"diamond", 2.4168, 2e-3}, {"water", 1.333, 1e-3}};

	(void)state;
	for (size_t i = 0; i < sizeof cases / sizeof cases[0]; i++)
		assert_near(value_at(cases[i].name, "n", 587.5618), cases[i].n,
			cases[i].tolerance);
	/* 4 pi k / wavelength: the absorption that Pope & Fry 1997 measured, 0.0565 / m. */
	assert_near(
		4 * 3.14159265358979 * value_at("water", "k", 550) / 550e-9, 0.0565, 1e-5);
}

/*
 * The reflectance of a bare surface in air under normal incidence.
 * Given:    n, k  of the material, n + ik
 * Returned: R     0..1
 * Source:   Fresnel's equations at normal incidence, as in Born & Wolf, Principles of
 *           Optics, 7th ed. (1999).
 */
static double
normal_reflectance(const char *name, double nm)
{
	double n = value_at(name, "n", nm), k = value_at(name, "k", nm);

	return ((n - 1) * (n - 1) + k * k) / ((n + 1) * (n + 1) + k * k);
}

static void
metals_shine_in_their_colours(void **state)
{
	(void)state;
	assert_true(normal_reflectance("Au", 700) > 0.95);
	assert_true(normal_reflectance("Au", 450) < 0.45);
	assert_true(normal_reflectance("Cu", 700) > 0.93);
	assert_true(normal_reflectance("Cu", 500) < 0.65);
	for (double nm = 450; nm <= 750; nm += 50) {
		assert_true(normal_reflectance("Ag", nm) > 0.95);
		assert_near(normal_reflectance("Al", nm), 0.91, 0.03);
	}
}

static void
find_own_data(void)
{
	char folder[4000];

	/* Run from the top of the repository, as make does, the data need no link. */
	if (getcwd(folder, sizeof folder) && access("spectra/cmf/cie1931.spd", R_OK) == 0)
		snprintf(own_data, sizeof own_data, "%s/spectra", folder);
}

int
main(void)
{
	const struct CMUnitTest tests[] = {
		cmocka_unit_test(grid_has_its_wavelengths),
		cmocka_unit_test(grid_knows_its_wavelengths),
		cmocka_unit_test(grid_refuses_nonsense),
		cmocka_unit_test(spd_reads_a_full_file),
		cmocka_unit_test(spd_reads_plain_pairs_and_csv),
		cmocka_unit_test(spd_reads_the_tables_of_others),
		cmocka_unit_test(spd_refuses_damage),
		cmocka_unit_test(spd_keeps_its_limits),
		cmocka_unit_test(spd_reports_the_system),
		cmocka_unit_test(numbers_are_short),
		cmocka_unit_test(writing_and_reading_is_the_identity),
		cmocka_unit_test(writing_refuses_what_cannot_be_read),
		cmocka_unit_test(sampling_is_linear_between),
		cmocka_unit_test(sampling_outside_follows_the_rule),
		cmocka_unit_test(one_sample_is_known_at_its_wavelength_alone),
		cmocka_unit_test(names_are_found),
		cmocka_unit_test(paths_are_read),
		cmocka_unit_test(doubtful_names_are_refused),
		cmocka_unit_test(names_are_listed),
		cmocka_unit_test(own_data_lie_beside_the_program),
		cmocka_unit_test(every_file_is_complete),
		cmocka_unit_test(observers_have_their_sums),
		cmocka_unit_test(illuminants_are_normalised),
		cmocka_unit_test(illuminants_have_their_published_chromaticities),
		cmocka_unit_test(glasses_have_their_published_index),
		cmocka_unit_test(metals_shine_in_their_colours),
	};

	find_own_data();
	return cmocka_run_group_tests(tests, make_scratch, scratch_remove);
}
