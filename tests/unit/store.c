/* lib/spectrum/store, spdtable: spectra of all kinds in .spd files. */
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

#include "spectrum/spd.h"
#include "spectrum/store.h"

#define COUNT(list) (sizeof(list) / sizeof *(list))

/* What is written, in memory; to be freed. */
static char *
written(const struct spec_spectrum *spectrum)
{
	char *text = NULL;
	size_t size;
	FILE *file = open_memstream(&text, &size);
	struct spec_error error;

	assert_non_null(file);
	if (spec_spectrum_write(file, spectrum, &error) != SPEC_OK)
		fail_msg("%s", error.message);
	fclose(file);
	return text;
}

static enum spec_status
read_back(const char *text, struct spec_spectrum *spectrum, struct spec_error *error)
{
	FILE *file = fmemopen((void *)(uintptr_t)text, strlen(text), "r");
	enum spec_status status;

	assert_non_null(file);
	status = spec_spectrum_read(file, "t.spd", spectrum, error);
	fclose(file);
	return status;
}

static void
assert_equal(const struct spec_spectrum *a, const struct spec_spectrum *b)
{
	assert_int_equal(a->smooth, b->smooth);
	assert_int_equal(a->interpolate, b->interpolate);
	assert_int_equal(a->count, b->count);
	assert_int_equal(a->lines, b->lines);
	assert_true(a->low_nm == b->low_nm && a->high_nm == b->high_nm);
	assert_true(a->level == b->level && a->temperature_k == b->temperature_k);
	assert_memory_equal(a->rgb, b->rgb, sizeof a->rgb);
	assert_memory_equal(&a->sigmoid, &b->sigmoid, sizeof a->sigmoid);
	if (a->count > 0)
		assert_memory_equal(a->value, b->value, a->count * sizeof *a->value);
	assert_int_equal(a->wavelength_nm != NULL, b->wavelength_nm != NULL);
	if (a->wavelength_nm)
		assert_memory_equal(a->wavelength_nm, b->wavelength_nm,
			a->count * sizeof *a->wavelength_nm);
	if (a->lines > 0)
		assert_memory_equal(a->line, b->line, a->lines * sizeof *a->line);
	assert_string_equal(a->title, b->title);
	assert_string_equal(a->medium, b->medium);
	assert_string_equal(a->quantity, b->quantity);
}

/* One of each kind and rule, with numbers that need all their digits. */
static size_t
make_kinds(struct spec_spectrum *spectra)
{
	static const double nm[] = {380.1, 395, 430. + 1. / 3, 433, 500, 612},
			    value[] = {.1, 1. / 3, -.3, 4e-300, 2, 1e22},
			    rgb[] = {.7, .2, 1. / 7};
	static const struct spec_sigmoid sigmoid = {1.5, 3e-5, -.02, 2},
					 white = {1, 0, 0, INFINITY},
					 black = {1, 0, 0, -INFINITY};
	struct spec_spectrum *next = spectra;

	spec_spectrum_constant(1. / 3, next++, NULL);
	spec_spectrum_blackbody(2856.1, 1. / 3, next++, NULL);
	spec_spectrum_rgb(rgb, &sigmoid, next++, NULL);
	spec_spectrum_rgb(rgb, &white, next++, NULL);
	spec_spectrum_rgb(rgb, &black, next++, NULL);
	spec_spectrum_fourier(380.3, 780.7, value, 5, next++, NULL);
	spec_spectrum_fourier(380.3, 780.7, value, 1, next++, NULL);
	for (int i = 0; i < 3; i++)
		spec_spectrum_tabulated(
			nm, value, 6, (enum spec_interpolate)i, next++, NULL);
	for (int i = 0; i < 4; i++)
		spec_spectrum_sampled(
			380.1, 780.4, value, 6, (enum spec_interpolate)i, next++, NULL);
	return (size_t)(next - spectra);
}

static void
expect_return(const struct spec_spectrum *spectrum)
{
	struct spec_spectrum back;
	struct spec_error error;
	char *text = written(spectrum);

	if (read_back(text, &back, &error) != SPEC_OK)
		fail_msg("%s\n%s", error.message, text);
	assert_equal(&back, spectrum);
	spec_spectrum_free(&back);
	free(text);
}

static void
spectra_come_back_bit_for_bit(void **state)
{
	static const struct spec_line lines[] = {{435.8 + 1e-9, 1. / 3}, {546.1, -2e-7}};
	struct spec_spectrum spectra[20];
	size_t count = make_kinds(spectra);

	(void)state;
	for (size_t i = 0; i < count; i++) {
		spec_curve_set_text(&spectra[i].title, "a lamp", NULL);
		spec_curve_set_text(&spectra[i].medium, "vacuum", NULL);
		expect_return(&spectra[i]);
		spec_spectrum_add_lines(&spectra[i], lines, COUNT(lines), NULL);
		expect_return(&spectra[i]);
		spec_spectrum_free(&spectra[i]);
	}
}

static void
files_look_like_this(void **state)
{
	static const double series[] = {2, .5, -.25}, value[] = {1, 2, 4};
	static const struct spec_line line = {546.1, 30};
	struct spec_spectrum spectrum;
	char *text;

	(void)state;
	spec_spectrum_fourier(400, 700, series, 3, &spectrum, NULL);
	spec_spectrum_add_lines(&spectrum, &line, 1, NULL);
	spec_curve_set_text(&spectrum.title, "lamp", NULL);
	text = written(&spectrum);
	assert_string_equal(text,
		"# title: lamp\n# representation: fourier\n# range: 400 700\n"
		"# columns: order cosine sine\n0 2 0\n1 0.5 -0.25\nline 546.1 30\n");
	free(text);
	spec_spectrum_free(&spectrum);
	spec_spectrum_sampled(400, 700, value, 3, SPEC_INTERPOLATE_LEFT, &spectrum, NULL);
	text = written(&spectrum);
	assert_string_equal(text, "# representation: sampled\n# interpolation: left\n"
				  "# columns: wavelength_nm value\n400 1\n550 2\n700 4\n");
	free(text);
	spec_spectrum_free(&spectrum);
	spec_spectrum_blackbody(2856, 3, &spectrum, NULL);
	text = written(&spectrum);
	assert_string_equal(text, "# representation: blackbody\n"
				  "# columns: temperature_K level\n2856 3\n");
	free(text);
	spec_spectrum_free(&spectrum);
}

static void
files_are_loaded_and_saved(void **state)
{
	char path[] = "/tmp/spectools-store-XXXXXX.spd";
	static const double series[] = {2, .5, -.25};
	struct spec_spectrum spectrum, back;
	struct spec_curve curve;
	int descriptor = mkstemps(path, 4);

	(void)state;
	assert_true(descriptor >= 0);
	close(descriptor);
	spec_spectrum_fourier(400, 700, series, 3, &spectrum, NULL);
	assert_int_equal(spec_spectrum_save(path, &spectrum, NULL), SPEC_OK);
	assert_int_equal(spec_spectrum_load(path, &back, NULL), SPEC_OK);
	assert_equal(&back, &spectrum);
	spec_spectrum_free(&back);
	assert_int_equal(spec_spectrum_named(path, &back, NULL), SPEC_OK);
	assert_equal(&back, &spectrum);
	/* Where a curve is wanted: 1 nm. */
	assert_int_equal(spec_spd_load(path, &curve, NULL), SPEC_OK);
	assert_true(curve.count == 301 && curve.columns == 1);
	assert_true(fabs(curve.value[150] - .5) < 1e-14);
	spec_curve_free(&curve);
	spec_spectrum_free(&back);
	spec_spectrum_free(&spectrum);
	unlink(path);
	assert_int_equal(spec_spectrum_load(path, &back, NULL), SPEC_EIO);
	assert_int_equal(spec_spectrum_named("D65", &back, NULL), SPEC_OK);
	assert_int_equal(back.smooth, SPEC_SPECTRUM_TABULATED);
	assert_string_equal(back.quantity, "spectral power distribution");
	spec_spectrum_free(&back);
}

/* As a curve, lines are peaks 2 nm wide at their foot, and their energy is there. */
static void
curves_of_composites_keep_energy(void **state)
{
	static const char text[] = "# representation: constant\n2\nline 500 30\n";
	struct spec_curve curve;
	double sum = 0;

	(void)state;
	assert_int_equal(
		spec_spd_parse(text, strlen(text), "t.spd", &curve, NULL), SPEC_OK);
	assert_true(curve.count == 471 && curve.wavelength_nm[0] == 360);
	for (size_t i = 0; i + 1 < curve.count; i++)
		sum += .5 * (curve.value[i] + curve.value[i + 1]);
	assert_true(fabs(sum - (2 * 470 + 30)) < 1e-9);
	assert_true(curve.value[140] == 32 && curve.value[139] == 2);
	spec_curve_free(&curve);
}

struct fault {
	enum spec_status status;
	const char *text, *message;
};

static void
faults_have_places(void **state)
{
	static const struct fault faults[] = {
		{SPEC_EFORMAT, "# representation: wavelet\n1 2\n",
			"t.spd:1: there is no representation 'wavelet'"},
		{SPEC_EFORMAT, "# representation: composite\n1 2\n",
			"t.spd:1: there is no representation 'composite'"},
		{SPEC_EFORMAT,
			"# columns: wavelength_nm a\n# representation: sampled\n1 2\n",
			"t.spd:2: the representation is named below the columns"},
		{SPEC_EFORMAT,
			"# representation: sampled\n# representation: sampled\n1 2\n",
			"t.spd:2: the header has 'representation:' twice"},
		{SPEC_EFORMAT, "# interpolation: cubic\n400 2\n",
			"t.spd:1: the interpolation is not linear, nearest, left or sprague: "
			"'cubic'"},
		{SPEC_EFORMAT, "# representation: fourier\n# range: 400\n0 2 0\n1 2 0\n",
			"t.spd:2: the range is not two numbers"},
		{SPEC_EFORMAT, "# range: 700 400\n# representation: fourier\n0 2 0\n",
			"t.spd:1: the range is not two wavelengths"},
		{SPEC_EFORMAT, "# representation: sampled\n# range: 400 700\n400 2\n",
			"t.spd: a range, which only a Fourier spectrum has"},
		{SPEC_EFORMAT, "# representation: fourier\n0 1 0\n",
			"t.spd: a Fourier spectrum without a range"},
		{SPEC_EFORMAT, "# representation: fourier\n# range: 400 700\n0 1\n",
			"t.spd:3: 2 numbers where the representation has 3"},
		{SPEC_EFORMAT, "# representation: fourier\n# range: 400 700\n1 1 0\n",
			"t.spd:3: the order 1 stands where 0 should"},
		{SPEC_EFORMAT, "# representation: fourier\n# range: 400 700\n0 1 2\n",
			"t.spd:3: the sine of order 0 is not 0"},
		{SPEC_EFORMAT,
			"# representation: fourier\n# range: 400 700\n# columns: n a b\n",
			"t.spd:3: the columns are not 'order cosine sine'"},
		{SPEC_EFORMAT, "# representation: constant\n1\n2\n",
			"t.spd:3: a spectrum of the kind 'constant' has one row"},
		{SPEC_EFORMAT, "# representation: constant\n# interpolation: left\n1\n",
			"t.spd: an interpolation, which only samples have"},
		{SPEC_ERANGE, "# representation: blackbody\n-3 1\n",
			"t.spd: the temperature of a black body is not positive"},
		{SPEC_EFORMAT, "# representation: sampled\n400 1\n410 1\n430 1\n",
			"t.spd: the samples do not stand at equal distances: 410 nm where 415 "
			"nm should"},
		{SPEC_ERANGE, "# interpolation: sprague\n400 1\n410 1\n",
			"t.spd: Sprague's interpolation needs 6 samples, not 2"},
		{SPEC_EFORMAT, "400 1\nline 500\n",
			"t.spd:2: a line is 'line', its wavelength and its weight"},
		{SPEC_EFORMAT, "400 1\nline 500 1 2\n", "t.spd:2: a line is 'line'"},
		{SPEC_EFORMAT, "400 1\nline -500 1\n", "t.spd:2: a line is 'line'"},
		{SPEC_EFORMAT, "line 500 1\n400 1\n",
			"t.spd:2: a row stands below the lines"},
		{SPEC_EFORMAT, "line 500 1\n", "t.spd:1: the file ends without a row"},
		{SPEC_EFORMAT, "400 1\nlines 500 1\n",
			"t.spd:2: 'lines' is not a finite number"},
		{SPEC_EFORMAT, "400 1 2\n410 1 2\nline 500 1\n",
			"t.spd: lines stand beside 2 columns, not one"}};

	struct spec_error error = {0};
	struct spec_curve curve;

	(void)state;
	for (size_t i = 0; i < COUNT(faults); i++) {
		const struct fault *fault = &faults[i];
		struct spec_spectrum spectrum;
		enum spec_status status = read_back(fault->text, &spectrum, &error);

		if (status != fault->status ||
			strncmp(error.message, fault->message, strlen(fault->message)) != 0)
			fail_msg("%s: status %d, '%s'", fault->text, status, error.message);
		assert_null(spectrum.title);
		assert_int_equal(read_back(fault->text, &spectrum, NULL), status);
		/* And to who wants a plain curve. */
		assert_int_equal(spec_spd_parse(fault->text, strlen(fault->text), "t.spd",
					 &curve, &error),
			fault->status);
		if (strncmp(error.message, fault->message, strlen(fault->message)) != 0)
			fail_msg("%s: '%s'", fault->text, error.message);
		assert_null(curve.value);
	}
	assert_int_equal(spec_spd_parse("400 1\nline 400 1\n", 17, "t.spd", &curve, &error),
		SPEC_ERANGE);
	assert_string_equal(error.message,
		"t.spd: one wavelength has no width for the energy of lines");
}

/* How densely other kinds are sampled for who wants a plain curve. */
static void
curves_have_steps(void **state)
{
	static const struct {
		const char *text;
		size_t count;
		double first_nm, last_nm;
	} cases[] = {
		{"# representation: constant\n2\n", 471, 360, 830},
		{"# representation: blackbody\n3000 1\n", 471, 360, 830},
		{"# representation: fourier\n# range: 400 700\n0 1 0\n1 1 0\n", 301, 400,
			700},
		{"# representation: fourier\n# range: 400 700.5\n0 1 0\n1 1 0\n", 302, 400,
			700.5},
		/* Waves of 0.5 nm at least, of which a sixteenth is 1/32. */
		{"# representation: fourier\n# range: 400 402\n0 1 0\n1 1 0\n2 1 0\n3 1 0\n"
		 "4 1 0\n",
			65, 400, 402},
	};
	struct spec_error error = {0};
	struct spec_curve curve;

	(void)state;
	for (size_t i = 0; i < COUNT(cases); i++) {
		if (spec_spd_parse(cases[i].text, strlen(cases[i].text), "t.spd", &curve,
			    &error) != SPEC_OK)
			fail_msg("%s", error.message);
		assert_int_equal(curve.count, cases[i].count);
		assert_true(curve.wavelength_nm[0] == cases[i].first_nm);
		assert_true(curve.wavelength_nm[curve.count - 1] == cases[i].last_nm);
		spec_curve_free(&curve);
	}
}

/* Below the rows and lines '#' begins a comment; several columns are read by their first. */
static void
headers_end_with_rows(void **state)
{
	struct spec_spectrum spectrum;

	(void)state;
	assert_int_equal(
		read_back("400 1 5\n410 2 6\n# representation: fourier\n", &spectrum, NULL),
		SPEC_OK);
	assert_true(spectrum.count == 2 && spectrum.value[1] == 2);
	spec_spectrum_free(&spectrum);
	assert_int_equal(
		read_back("400 1\nline , 500 , 3\n# title: x\n", &spectrum, NULL), SPEC_OK);
	assert_true(spectrum.lines == 1 && spectrum.line[0].weight == 3);
	assert_string_equal(spectrum.title, "");
	spec_spectrum_free(&spectrum);
}

static void
unwritable_texts_are_refused(void **state)
{
	struct spec_spectrum spectrum;
	struct spec_error error;
	FILE *file = tmpfile();

	(void)state;
	assert_non_null(file);
	spec_spectrum_constant(1, &spectrum, NULL);
	spec_curve_set_text(&spectrum.title, "two\nlines", NULL);
	assert_int_equal(spec_spectrum_write(file, &spectrum, &error), SPEC_ERANGE);
	assert_int_equal(ftell(file), 0);
	fclose(file);
	spec_curve_set_text(&spectrum.title, "", NULL);
	assert_int_equal(spec_spectrum_save("/dev/full", &spectrum, &error), SPEC_EIO);
	spec_spectrum_free(&spectrum);
}

int
main(void)
{
	const struct CMUnitTest tests[] = {
		cmocka_unit_test(spectra_come_back_bit_for_bit),
		cmocka_unit_test(files_look_like_this),
		cmocka_unit_test(files_are_loaded_and_saved),
		cmocka_unit_test(curves_of_composites_keep_energy),
		cmocka_unit_test(faults_have_places),
		cmocka_unit_test(curves_have_steps),
		cmocka_unit_test(headers_end_with_rows),
		cmocka_unit_test(unwritable_texts_are_refused),
	};

	return cmocka_run_group_tests(tests, NULL, NULL);
}
