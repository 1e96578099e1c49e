/* ENVI files against bytes and headers that are put together here. */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "image/enviheader.h"

#include "readback.h"

#define WIDTH 3
#define HEIGHT 5
#define BANDS 2
#define SAMPLES (WIDTH * HEIGHT * BANDS)

static struct spec_settings settings;

static int
set_up(void **state)
{
	(void)state;
	spec_settings_init(&settings);
	return scratch_make("envi");
}

/* A number as so many bytes of two's complement or IEEE 754, in one order or the other. */
static void
put(unsigned char *to, int type, int big, double number)
{
	size_t bytes = envi_type_bytes(type);
	uint64_t bits = number < 0 ? (uint64_t)(int64_t)number : (uint64_t)number;
	float narrow = (float)number;
	uint32_t narrow_bits;

	if (type == ENVI_F32) {
		memcpy(&narrow_bits, &narrow, 4);
		bits = narrow_bits;
	} else if (type == ENVI_F64) {
		memcpy(&bits, &number, 8);
	}
	for (size_t i = 0; i < bytes; i++)
		to[big ? bytes - 1 - i : i] = (unsigned char)(bits >> 8 * i);
}

/* Where a sample stands, by the definitions of the three interleaves. */
static size_t
place(const char *interleave, size_t x, size_t y, size_t band)
{
	if (strcmp(interleave, "bsq") == 0)
		return (band * HEIGHT + y) * WIDTH + x;
	if (strcmp(interleave, "bil") == 0)
		return (y * BANDS + band) * WIDTH + x;
	return (y * WIDTH + x) * BANDS + band;
}

static void
save_header(const char *name, int type, int big, const char *interleave, const char *more)
{
	char text[1024];

	snprintf(text, sizeof text,
		"ENVI\nsamples = %d\nlines = %d\nbands = %d\ndata type = %d\n"
		"interleave = %s\nbyte order = %d\n%s\n",
		WIDTH, HEIGHT, BANDS, type, interleave, big, more);
	save_text(name, text);
}

#define LIGHT "data units = radiance\nwavelength units = nm\nwavelength = {500, 400}\n"

/* Bytes of another order than any machine's give other numbers in every type but one. */
static double
sample_of(int type, size_t i)
{
	static const struct {
		int type;
		double least, most;
	} range[] = {{ENVI_U8, 0, 255}, {ENVI_I16, -32768, 32767}, {ENVI_U16, 0, 65535},
		{ENVI_I32, -2147483648., 2147483647.}, {ENVI_U32, 0, 4294967295.},
		{ENVI_I64, -9223372036854775808., 9223372036854774784.},
		{ENVI_U64, 0, 18446744073709549568.}, {ENVI_F32, -3e38, 3e38},
		{ENVI_F64, -1e-30, 1e-30}};
	double value = 0;

	for (size_t k = 0; k < COUNT(range); k++) {
		if (range[k].type != type)
			continue;
		value = i == 0   ? range[k].least
			: i == 1 ? range[k].most
				 : range[k].least / 7 * (double)(i % 5) +
					   range[k].most / 11 * (double)(i % 7);
	}
	return type == ENVI_F64 ? value : type == ENVI_F32 ? (float)value : trunc(value);
}

static void
every_type_order_and_interleave(void **state)
{
	static const int types[] = {ENVI_U8, ENVI_I16, ENVI_I32, ENVI_F32, ENVI_F64,
		ENVI_U16, ENVI_U32, ENVI_I64, ENVI_U64};
	static const char *const interleaves[] = {"bsq", "bil", "bip"};
	unsigned char bytes[SAMPLES * 8];
	struct readback back;

	(void)state;
	for (size_t i = 0; i < COUNT(types) * 3 * 2; i++) {
		int type = types[i / 6], big = i % 2;
		const char *interleave = interleaves[i / 2 % 3];
		size_t size = envi_type_bytes(type);

		for (size_t k = 0; k < SAMPLES; k++)
			put(bytes + place(interleave, k % WIDTH, k / WIDTH % HEIGHT,
					    k / WIDTH / HEIGHT) *
						size,
				type, big, sample_of(type, k));
		save("a.img", bytes, SAMPLES * size);
		save_header("a.hdr", type, big, interleave, LIGHT);
		reads(&back, i % 4 < 2 ? "a.hdr" : "a.img", &settings);
		assert_int_equal(back.image->bands, BANDS);
		for (size_t k = 0; k < SAMPLES; k++) {
			/* The file's first band has the longer wavelength. */
			size_t band = 1 - k / WIDTH / HEIGHT;
			float got = readback_at(
				&back, band, (int)(k % WIDTH), (int)(k / WIDTH % HEIGHT));

			if (got != (float)sample_of(type, k))
				fail_msg(
					"type %d, %s, order %d, sample %zu: %.9g instead of %.9g",
					type, interleave, big, k, got, sample_of(type, k));
		}
		readback_close(&back);
	}
}

/* Five bytes in front; values are (number * gain + offset) / factor, and 7 is none. */
static void
numbers_are_scaled_and_ignored(void **state)
{
	unsigned char bytes[5 + SAMPLES * 2] = {0xff, 0xff, 0xff, 0xff, 0xff};
	struct readback back;

	(void)state;
	for (size_t k = 0; k < SAMPLES; k++)
		put(bytes + 5 +
				place("bip", k % WIDTH, k / WIDTH % HEIGHT,
					k / WIDTH / HEIGHT) *
					2,
			ENVI_I16, 1, (double)k);
	save("a.img", bytes, sizeof bytes);
	save_header("a.hdr", ENVI_I16, 1, "bip",
		LIGHT "header offset = 5\ndata ignore value = 7\n"
		      "data gain values = {0, 2}\ndata offset values = {3, 1}\n"
		      "reflectance scale factor = 4.0\n");
	reads(&back, "a.hdr", &settings);
	for (size_t k = 0; k < SAMPLES; k++) {
		size_t band = k / WIDTH / HEIGHT;
		float got = readback_at(
			&back, 1 - band, (int)(k % WIDTH), (int)(k / WIDTH % HEIGHT));
		double wanted = band == 0 ? 3. / 4 : ((double)k * 2 + 1) / 4;

		if (k == 7)
			assert_true(isnan(got));
		else
			near(got, wanted, 0, "a scaled number");
	}
	readback_close(&back);
}

static void
save_zeros(void)
{
	static const unsigned char zeros[SAMPLES * 4];

	save("a.img", zeros, sizeof zeros);
}

static void
wavelengths_have_units(void **state)
{
	static const struct {
		const char *unit, *numbers;
		double first_nm, second_nm;
	} cases[] = {{"Nanometers", "400.5, 500", 400.5, 500},
		{"Micrometers", ".4,.5", 400, 500}, {"um", "0.5 0.4", 400, 500},
		{"Millimeters", "4e-4, 5e-4", 400, 500}, {"cm", "4e-5, 5e-5", 400, 500},
		{"Meters", "4e-7, 5e-7", 400, 500}, {"Angstroms", "4000, 5000", 400, 500},
		/* 1e7 / k, and c / f with c = 299792458 m/s */
		{"Wavenumber", "20000, 25000", 400, 500},
		{"GHz", "599584.916, 749481.145", 400, 500},
		{"MHz", "599584916, 749481145", 400, 500},
		{"Centimeters", "4e-5, 5e-5", 400, 500}, {"Microns", ".4 .5", 400, 500},
		{"mm", "4e-4, 5e-4", 400, 500}, {"m", "4e-7, 5e-7", 400, 500},
		{"nm", "400, 500", 400, 500}, {"Unknown", "0.4, 0.5", 400, 500},
		{"", "400,\n  500", 400, 500}, {"", "99, 99.5", 99000, 99500},
		{"", "100, 101", 100, 101}};

	(void)state;
	save_zeros();
	for (size_t i = 0; i < COUNT(cases); i++) {
		struct readback back;
		char more[256];

		snprintf(more, sizeof more,
			"data units = radiance\n%s%s\nwavelength = { %s }\n",
			*cases[i].unit ? "wavelength units = " : "", cases[i].unit,
			cases[i].numbers);
		save_header("a.hdr", ENVI_F32, 0, "bsq", more);
		reads(&back, "a.hdr", &settings);
		/* The layout's names have six decimals. */
		near(back.image->wavelength_nm[0], cases[i].first_nm, 5e-7, cases[i].unit);
		near(back.image->wavelength_nm[1], cases[i].second_nm, 5e-7, cases[i].unit);
		readback_close(&back);
	}
}

static void
the_user_says_wavelengths_and_kind(void **state)
{
	struct spec_settings told = settings;
	struct readback back;

	(void)state;
	save_zeros();
	save_header("a.hdr", ENVI_F32, 0, "bsq", "");
	refuses("a.hdr", &settings, SPEC_EUSAGE, "(--read-as)");
	told.read_as = SPEC_ROLE_REFLECTIVE;
	refuses("a.hdr", &told, SPEC_EUSAGE, "(--wavelengths");
	told.wavelengths = "400:600:100";
	refuses("a.hdr", &told, SPEC_EUSAGE, "has 2 bands, and --wavelengths gives 3");
	told.wavelengths = "0.61um,700";
	reads(&back, "a.hdr", &told);
	assert_int_equal(back.image->role, SPEC_ROLE_REFLECTIVE);
	near(back.image->wavelength_nm[0], 610, 0, "the first wavelength");
	readback_close(&back);
	/* Instead of those in the header, too. */
	save_header("a.hdr", ENVI_F32, 0, "bsq", LIGHT);
	told.read_as = SPEC_ROLE_OTHER;
	reads(&back, "a.hdr", &told);
	assert_int_equal(back.image->role, SPEC_ROLE_EMISSIVE);
	near(back.image->wavelength_nm[1], 700, 0, "the second wavelength");
	readback_close(&back);
}

static void
kinds_are_found_in_the_header(void **state)
{
	static const struct {
		const char *line;
		enum spec_role role;
	} cases[] = {{"data units = Reflectance", SPEC_ROLE_REFLECTIVE},
		{"description = {Transmittance of\n a filter}", SPEC_ROLE_REFLECTIVE},
		{"z plot titles = {Wavelength, Radiance}", SPEC_ROLE_EMISSIVE},
		{"band names = {Reflectance 1, Reflectance 2}", SPEC_ROLE_REFLECTIVE},
		{"reflectance scale factor = 10000", SPEC_ROLE_REFLECTIVE},
		{"description = {reflectance from radiance}\ndata units = radiance",
			SPEC_ROLE_EMISSIVE},
		/* The first of data units, z plot titles, description, band names. */
		{"z plot titles = {x, reflectance}\ndata units = radiance",
			SPEC_ROLE_EMISSIVE},
		{"description = {reflectance}\nz plot titles = {x, radiance}",
			SPEC_ROLE_EMISSIVE},
		{"band names = {Reflectance 1, Reflectance 2}\ndescription = {radiance}",
			SPEC_ROLE_EMISSIVE}};

	(void)state;
	save_zeros();
	for (size_t i = 0; i < COUNT(cases); i++) {
		struct readback back;
		char more[256];

		snprintf(more, sizeof more, "%s\nwavelength = {400, 500}\n", cases[i].line);
		save_header("a.hdr", ENVI_F32, 0, "bsq", more);
		reads(&back, "a.hdr", &settings);
		assert_int_equal(back.image->role, cases[i].role);
		readback_close(&back);
	}
}

static void
windows_come_from_the_corner(void **state)
{
	struct readback back;

	(void)state;
	save_zeros();
	save_header("a.hdr", ENVI_F32, 0, "bsq", LIGHT "x start = 11\ny start = -3\n");
	reads(&back, "a.hdr", &settings);
	assert_int_equal(back.image->data.x0, 10);
	assert_int_equal(back.image->data.y0, -4);
	assert_int_equal(back.image->data.x1, 13);
	assert_int_equal(back.image->display.y1, 1);
	readback_close(&back);
	save_header("a.hdr", ENVI_F32, 0, "bsq",
		LIGHT "spec:display window = {-1 -2 30 40}\nspec:pixel aspect = 1.5\n");
	reads(&back, "a.hdr", &settings);
	assert_int_equal(back.image->data.x0, 0);
	assert_int_equal(back.image->display.x0, -1);
	assert_int_equal(back.image->display.y1, 40);
	near(back.image->pixel_aspect_ratio, 1.5, 0, "the pixels' aspect");
	readback_close(&back);
}

static const char *
text_of(const struct spec_image *image, const char *name)
{
	const struct spec_attribute *attribute = spec_image_attribute(image, name);
	static char text[256];

	if (!attribute || strcmp(attribute->type, "string") != 0)
		return "(none)";
	snprintf(text, sizeof text, "%.*s", (int)attribute->size,
		(const char *)attribute->value);
	return text;
}

static void
the_syntax_is_loose(void **state)
{
	struct readback back;

	(void)state;
	save_zeros();
	save_text("a.hdr",
		"ENVI\r\n; a comment = {\r\n\r\n   ;another\r\nSamples=3\r\n  LINES  =  5 \r\n"
		"bands = 2\r\nData   Type = 4\r\nInterLeave = BSQ\r\nbyte order = 0\r\n"
		"wavelength = {\r\n 400 ,\r\n 500\r\n} and more\r\n"
		"data units = {radiance}\r\nmap info = {UTM, 1 = 2,\r\n 3}\r\n"
		"sensor type = Unknown ; x\r\nsamples = 3\r\n"
		"spec:Owner = {%7Bme%7d%7D, 5%}");
	reads(&back, "a.hdr", &settings);
	assert_string_equal(text_of(back.image, "envi:map info"), "UTM, 1 = 2,\r\n 3");
	assert_string_equal(text_of(back.image, "envi:sensor type"), "Unknown ; x");
	assert_string_equal(text_of(back.image, "envi:data units"), "radiance");
	assert_string_equal(text_of(back.image, "spec:Owner"), "{me%7d}, 5%");
	assert_string_equal(text_of(back.image, "envi:samples"), "(none)");
	readback_close(&back);
}

#define GOOD "ENVI\nsamples = 3\nlines = 5\nbands = 2\ndata type = 4\n"
#define GOOD2 "interleave = bsq\nbyte order = 0\ndata units = radiance\n"
#define GOOD3 "wavelength = {400, 500}\n"

static void
bad_headers_are_refused(void **state)
{
	static const struct {
		const char *text, *part;
		enum spec_status status;
	} cases[] = {
		{"ENVI\nlines = 5\n", "has no 'samples'", SPEC_EFORMAT},
		{"ENVI\nsamples = 3\nlines 5\n", "a.hdr:3: is neither", SPEC_EFORMAT},
		{"ENVI\nsamples = 3\nx = {5\n\n", "a.hdr:3: a brace is not closed",
			SPEC_EFORMAT},
		{GOOD GOOD2 GOOD3 "samples = 4\n", "a.hdr:10: 'samples' is there twice",
			SPEC_EFORMAT},
		{"ENVI\nsamples = 0\nlines = 5\nbands = 2\n", "samples", SPEC_ERANGE},
		{"ENVI\nsamples = 3x\n", "samples", SPEC_EUSAGE},
		{GOOD "interleave = bop\n", "has no 'byte order'", SPEC_EFORMAT},
		{GOOD "byte order = 0\ninterleave = bop\n", "not bsq, bil or bip",
			SPEC_EFORMAT},
		{GOOD "byte order = 0\n", "has no 'interleave'", SPEC_EFORMAT},
		{GOOD "byte order = 2\n", "byte order", SPEC_ERANGE},
		{"ENVI\nsamples = 3\nlines = 5\nbands = 2\ndata type = 6\n",
			"complex numbers", SPEC_EUNSUPPORTED},
		{"ENVI\nsamples = 3\nlines = 5\nbands = 2\ndata type = 7\n",
			"data type 7 is unknown", SPEC_EFORMAT},
		{GOOD GOOD2 GOOD3 "file compression = 1\n", "compressed",
			SPEC_EUNSUPPORTED},
		{GOOD GOOD2 "wavelength = {400}\n", "is not 2 numbers", SPEC_EFORMAT},
		{GOOD GOOD2 "wavelength = {400,500,600}\n", "is not 2 numbers",
			SPEC_EFORMAT},
		{GOOD GOOD2 "wavelength = {400, x}\n", "is not 2 numbers", SPEC_EFORMAT},
		{GOOD GOOD2 "wavelength = {500, 500}\n", "500", SPEC_EFORMAT},
		{GOOD GOOD2 "wavelength = {0, 500}\n", "(--wavelengths", SPEC_EFORMAT},
		{GOOD GOOD2 GOOD3 "wavelength units = Index\n", "(--wavelengths",
			SPEC_EFORMAT},
		{GOOD GOOD2 GOOD3 "data gain values = {1}\n", "data gain values",
			SPEC_EFORMAT},
		{GOOD GOOD2 GOOD3 "reflectance scale factor = 0\n", "scale factor",
			SPEC_ERANGE},
		{GOOD GOOD2 GOOD3 "data ignore value = none\n", "data ignore value",
			SPEC_EUSAGE},
		{GOOD GOOD2 GOOD3 "header offset = 1\n",
			"a.img: ends early: has 120 bytes instead of 121", SPEC_EFORMAT},
		{GOOD GOOD2 GOOD3 "spec:display window = {0 0 0 5}\n", "no window",
			SPEC_EFORMAT},
		{GOOD GOOD2 GOOD3 "spec:samples = 0\n", "spec:samples", SPEC_ERANGE},
		{"ENVI\nsamples = 1000000000\nlines = 1000000000\nbands = 2\n"
		 "data type = 4\n" GOOD2 GOOD3,
			"(--limit pixels=N)", SPEC_ERANGE},
	};

	(void)state;
	save_zeros();
	for (size_t i = 0; i < COUNT(cases); i++) {
		save_text("a.hdr", cases[i].text);
		refuses("a.hdr", &settings, cases[i].status, cases[i].part);
	}
}

static void
limits_hold(void **state)
{
	struct spec_settings small = settings;

	(void)state;
	save_zeros();
	save_header("a.hdr", ENVI_F32, 0, "bsq", LIGHT);
	small.limits.channels = 1;
	refuses("a.hdr", &small, SPEC_ERANGE, "2 bands are more than the limit of 1");
	small = settings;
	small.limits.pixels = WIDTH * HEIGHT - 1;
	refuses("a.hdr", &small, SPEC_ERANGE, "(--limit pixels=N)");
	small = settings;
	small.limits.memory = 10;
	refuses("a.hdr", &small, SPEC_ERANGE, "(--limit memory=BYTES)");
	/* More bytes than can be counted, where the limit allows so many pixels. */
	small = settings;
	small.limits.pixels = INT64_MAX;
	save_text("a.hdr", "ENVI\nsamples = 1073741824\nlines = 1073741824\nbands = 32767\n"
			   "data type = 5\n" GOOD2);
	refuses("a.hdr", &small, SPEC_ERANGE, "more bytes than a file can have");
}

static void
the_two_files_find_each_other(void **state)
{
	static const unsigned char zeros[SAMPLES * 4];
	static const char *const names[][2] = {{"b.hdr", "b"}, {"c.hdr", "c.raw"},
		{"d.hdr", "d.BSQ"}, {"e.img.hdr", "e.img"}, {"f.g.hdr", "f.g.dat"}};

	(void)state;
	for (size_t i = 0; i < COUNT(names); i++) {
		for (int k = 0; k < 2; k++) {
			struct readback back;

			save(names[i][1], zeros, sizeof zeros);
			save_header(names[i][0], ENVI_F32, 0, "bil", LIGHT);
			reads(&back, names[i][k], &settings);
			readback_close(&back);
		}
	}
	/* A folder beside it is no data, nor is a header of another kind a header. */
	make_folder("h");
	save("h.img", zeros, sizeof zeros);
	save_header("h.hdr", ENVI_F32, 0, "bil", LIGHT);
	{
		struct readback back;

		reads(&back, "h.hdr", &settings);
		readback_close(&back);
	}
	save_header("alone.hdr", ENVI_F32, 0, "bil", LIGHT);
	refuses("alone.hdr", &settings, SPEC_EIO, "were not found beside it");
	save("raw.img", zeros, sizeof zeros);
	refuses("raw.img", &settings, SPEC_EFORMAT, "no image in a format");
	save_text("raw.hdr", "something else\n");
	refuses("raw.img", &settings, SPEC_EFORMAT, "no image in a format");
}

/* Data that begin as a picture of another format does are still what their header says. */
static void
data_may_look_like_a_picture(void **state)
{
	unsigned char bytes[SAMPLES] = "BM\x07\x09";
	struct readback back;

	(void)state;
	save("a.img", bytes, sizeof bytes);
	save_header("a.hdr", ENVI_U8, 0, "bsq", LIGHT);
	reads(&back, "a.img", &settings);
	near(readback_at(&back, 1, 0, 0), 'B', 0, "the first sample");
	readback_close(&back);
	memcpy(bytes, "P5\nx", 4);
	save("a.img", bytes, sizeof bytes);
	reads(&back, "a.img", &settings);
	readback_close(&back);
}

static void
texts_survive_their_braces(void **state)
{
	static const char *const texts[] = {
		"plain", " blanks ", "{a}%", "%7B", "line\nline\n", "%", "100% sure", ""};

	(void)state;
	for (size_t i = 0; i < COUNT(texts); i++) {
		char *written = NULL;
		size_t size;
		FILE *file = open_memstream(&written, &size);

		envi_text_write(file, texts[i], strlen(texts[i]));
		fclose(file);
		assert_null(strpbrk(written, "{}"));
		envi_text_decode(written);
		assert_string_equal(written, texts[i]);
		free(written);
	}
}

int
main(void)
{
	const struct CMUnitTest tests[] = {
		cmocka_unit_test(every_type_order_and_interleave),
		cmocka_unit_test(numbers_are_scaled_and_ignored),
		cmocka_unit_test(wavelengths_have_units),
		cmocka_unit_test(the_user_says_wavelengths_and_kind),
		cmocka_unit_test(kinds_are_found_in_the_header),
		cmocka_unit_test(windows_come_from_the_corner),
		cmocka_unit_test(the_syntax_is_loose),
		cmocka_unit_test(bad_headers_are_refused),
		cmocka_unit_test(limits_hold),
		cmocka_unit_test(the_two_files_find_each_other),
		cmocka_unit_test(data_may_look_like_a_picture),
		cmocka_unit_test(texts_survive_their_braces),
	};

	return cmocka_run_group_tests(tests, set_up, scratch_remove);
}
