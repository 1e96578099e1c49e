/* Names of channels, the bands that they form, and what an image says of itself. */
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include <math.h>

#include "image/image.h"
#include "image/names.h"

#include "check.h"

/* The text of a string attribute, or null. Inlined, gcc 12 takes it for a dangling pointer. */
static __attribute__((noinline)) char *
text_of(const struct spec_image *image, const char *name)
{
	char *text;

	assert_int_equal(spec_image_text(image, name, &text, NULL), SPEC_OK);
	return text;
}

#define LIGHT_NM_PER_S 299792458e9 /* exact, SI 2019 */

/* Each operation of the reading rounds once; there are at most four. */
#define ROUNDING (4 * 0x1p-53)

static struct spec_channel
read_name(const char *name)
{
	struct spec_channel channel = {.name = (char *)name};
	struct spec_error error;

	if (spec_names_read(&channel, &error) != SPEC_OK)
		fail_msg("'%s': %s", name, error.message);
	return channel;
}

static const struct {
	const char *name;
	enum spec_role role;
	int stokes;
	double wavelength_nm, reradiated_nm; /* reradiated: 0 where it is the same */
} bands[] = {
	/* The layout's own, as the reference, pbrt-v4 and colour-science write it. */
	{"S0.550,000000nm", SPEC_ROLE_EMISSIVE, 0, 550, 0},
	{"S1.550,000000nm", SPEC_ROLE_EMISSIVE, 1, 550, 0},
	{"S2.550,000000nm", SPEC_ROLE_EMISSIVE, 2, 550, 0},
	{"S3.550,000000nm", SPEC_ROLE_EMISSIVE, 3, 550, 0},
	{"T.550,000000nm", SPEC_ROLE_REFLECTIVE, 0, 550, 0},
	{"T.350,000000nm.550,000000nm", SPEC_ROLE_BISPECTRAL, 0, 350, 550},
	{"T.550,000000nm.550,000000nm", SPEC_ROLE_REFLECTIVE, 0, 550, 0},
	{"S0.374,688nm", SPEC_ROLE_EMISSIVE, 0, 374.688, 0},
	{"S0.300,0nm", SPEC_ROLE_EMISSIVE, 0, 300, 0},
	{"S0.300nm", SPEC_ROLE_EMISSIVE, 0, 300, 0},
	{"T.,5um", SPEC_ROLE_REFLECTIVE, 0, 500, 0},
	{"T.5,e2nm", SPEC_ROLE_REFLECTIVE, 0, 500, 0},
	{"T.5,5E2nm", SPEC_ROLE_REFLECTIVE, 0, 550, 0},
	{"T.5e-1um", SPEC_ROLE_REFLECTIVE, 0, 500, 0},
	{"T.5e+2nm", SPEC_ROLE_REFLECTIVE, 0, 500, 0},
	/* Units and their prefixes. */
	{"S0.5e-7m", SPEC_ROLE_EMISSIVE, 0, 500, 0},
	{"S0.0,5um", SPEC_ROLE_EMISSIVE, 0, 500, 0},
	{"S0.0,0005mm", SPEC_ROLE_EMISSIVE, 0, 500, 0},
	{"S0.5e-5cm", SPEC_ROLE_EMISSIVE, 0, 500, 0},
	{"S0.5e-6dm", SPEC_ROLE_EMISSIVE, 0, 500, 0},
	{"S0.5e-8dam", SPEC_ROLE_EMISSIVE, 0, 500, 0},
	{"S0.5e-9hm", SPEC_ROLE_EMISSIVE, 0, 500, 0},
	{"S0.5e-10km", SPEC_ROLE_EMISSIVE, 0, 500, 0},
	{"S0.5e-13Mm", SPEC_ROLE_EMISSIVE, 0, 500, 0},
	{"S0.5e-16Gm", SPEC_ROLE_EMISSIVE, 0, 500, 0},
	{"S0.5e-19Tm", SPEC_ROLE_EMISSIVE, 0, 500, 0},
	{"S0.5e-22Pm", SPEC_ROLE_EMISSIVE, 0, 500, 0},
	{"S0.5e-25Em", SPEC_ROLE_EMISSIVE, 0, 500, 0},
	{"S0.5e-28Zm", SPEC_ROLE_EMISSIVE, 0, 500, 0},
	{"S0.5e-31Ym", SPEC_ROLE_EMISSIVE, 0, 500, 0},
	{"S0.500000pm", SPEC_ROLE_EMISSIVE, 0, 500, 0},
	{"S0.600THz", SPEC_ROLE_EMISSIVE, 0, LIGHT_NM_PER_S / 600e12, 0},
	{"S0.0,6PHz", SPEC_ROLE_EMISSIVE, 0, LIGHT_NM_PER_S / 600e12, 0},
	{"S0.6e14Hz", SPEC_ROLE_EMISSIVE, 0, LIGHT_NM_PER_S / 600e12, 0},
	{"S0.600000GHz", SPEC_ROLE_EMISSIVE, 0, LIGHT_NM_PER_S / 600e12, 0},
	{"S0.6e17mHz", SPEC_ROLE_EMISSIVE, 0, LIGHT_NM_PER_S / 600e12, 0},
	{"S0.6e13daHz", SPEC_ROLE_EMISSIVE, 0, LIGHT_NM_PER_S / 600e12, 0},
	/* Mitsuba 0.6 and older ART: edges. */
	{"400.00-410.00nm", SPEC_ROLE_EMISSIVE, 0, 405, 0},
	{"360.00-375.67nm", SPEC_ROLE_EMISSIVE, 0, 367.835, 0},
	/* ISET3d. */
	{"Radiance.C01", SPEC_ROLE_EMISSIVE, 0, 400, 0},
	{"Radiance.C16", SPEC_ROLE_EMISSIVE, 0, 550, 0},
	{"Radiance.C31", SPEC_ROLE_EMISSIVE, 0, 700, 0},
	/* KAIST. */
	{"w420nm", SPEC_ROLE_REFLECTIVE, 0, 420, 0},
	{"w720nm", SPEC_ROLE_REFLECTIVE, 0, 720, 0},
};

static void
test_read_bands(void **state)
{
	(void)state;
	for (size_t i = 0; i < COUNT(bands); i++) {
		struct spec_channel channel = read_name(bands[i].name);
		double nm = bands[i].wavelength_nm;

		if (channel.role != bands[i].role || channel.stokes != bands[i].stokes ||
			fabs(channel.wavelength_nm - nm) > ROUNDING * nm)
			fail_msg("'%s': role %d, S%d, %.17g nm", bands[i].name,
				channel.role, channel.stokes, channel.wavelength_nm);
		if (bands[i].reradiated_nm > 0)
			assert_true(channel.reradiated_nm == bands[i].reradiated_nm);
	}
}

/* The usual unit is exact, and edges are kept. */
static void
test_read_exactly(void **state)
{
	struct spec_channel channel = read_name("S0.400,123457nm");

	(void)state;
	assert_true(channel.wavelength_nm == 400.123457);
	channel = read_name("400.00-410.50nm");
	assert_true(channel.low_nm == 400);
	assert_true(channel.high_nm == 410.5);
}

/* Names that are no band's: they pass through. */
static void
test_read_others(void **state)
{
	static const char *const names[] = {"", "R", "G", "B", "A", "Z", "Y", "S0", "S0.",
		"T", "T.", "S4.550,000000nm", "S.550,000000nm", "S00.550,000000nm",
		"s0.550nm", "t.550nm", "T.R", "T.G", "S0.550,000000", "S0.550,000000nmx",
		"S0.550.000000nm", "S0.550 nm", "S0. 550nm", "S0.+550nm", "S0.-550nm",
		"S0.550,000000 nm", "S0.550xm", "S0.550Nm", "S0.550hz",
		"S0.550,000000nm.600,000000nm", "T.550,000000nm.", "T.550,000000nm.x",
		"T.550,000000nm.600,000000nm.650,000000nm", "T.550,000000nm.-600nm",
		"left.S0.550,000000nm", "film1.mirror.S0.550,000000nm",
		"S0.550,000000nm.left", "S0.0x10nm", "S0.infnm", "S0.nannm", "Radiance.C00",
		"Radiance.C32", "Radiance.C1", "Radiance.C001", "Radiance.Cxx",
		"radiance.C01", "w420", "w420nmx", "w nm", "wnm", "w-420nm", "w0nm",
		"w420um", "width", "400.00-410.00", "400.00nm", "410.00-400.00nm",
		"400.00-400.00nm", "400,00-410,00nm", "-400.00-410.00nm", "0.00-410.00nm",
		"400.00--410.00nm", "id", "cover", "P.X", "N.X", "lamp1.D.X"};

	(void)state;
	for (size_t i = 0; i < COUNT(names); i++) {
		struct spec_channel channel = read_name(names[i]);

		if (channel.role != SPEC_ROLE_OTHER)
			fail_msg("'%s' became a band of role %d at %g nm", names[i],
				channel.role, channel.wavelength_nm);
	}
}

/* Names of the layout whose wavelength makes no sense. */
static void
test_read_bad(void **state)
{
	static const char *const names[] = {"S0.nm", "T.nm", "S3.um", "S0.m", "S0.Hz",
		"S0.THz", "S0.0nm", "S0.0,0nm", "T.0Hz", "S0.0,001nm", "S0.2mm", "S0.5m",
		"T.100Hz", "S0.1e300m", "T.nm.550nm", "T.550nm.nm", "T.550nm.0nm",
		"T.550nm.2mm", "S0.1e25Hz", "S0.1e400nm", "T.1e-400nm", "T.550nm.1e999Hz",
		"S0.0000000000000000000000000000000000000000000000000000000000000500nm"};
	struct spec_error error;

	(void)state;
	for (size_t i = 0; i < COUNT(names); i++) {
		struct spec_channel channel = {.name = (char *)names[i]};

		if (spec_names_read(&channel, &error) != SPEC_EFORMAT)
			fail_msg("'%s' became role %d at %g nm", names[i], channel.role,
				channel.wavelength_nm);
		assert_non_null(strstr(error.message, names[i]));
	}
}

static void
test_write(void **state)
{
	char text[96];

	(void)state;
	spec_names_write(text, sizeof text, SPEC_ROLE_EMISSIVE, 2, 550, 0);
	assert_string_equal(text, "S2.550,000000nm");
	spec_names_write(text, sizeof text, SPEC_ROLE_REFLECTIVE, 0, 374.6884, 0);
	assert_string_equal(text, "T.374,688400nm");
	spec_names_write(text, sizeof text, SPEC_ROLE_BISPECTRAL, 0, 350, 550.5);
	assert_string_equal(text, "T.350,000000nm.550,500000nm");
	spec_names_write(
		text, sizeof text, SPEC_ROLE_EMISSIVE, 0, SPEC_NAMES_LONGEST_NM, 0);
	assert_string_equal(text, "S0.1000000,000000nm");
	spec_names_write(
		text, sizeof text, SPEC_ROLE_EMISSIVE, 0, SPEC_NAMES_SHORTEST_NM, 0);
	assert_string_equal(text, "S0.0,010000nm");
}

/* What is read and written is read again as the same, to half of the sixth decimal. */
static void
test_round_trip(void **state)
{
	char text[96], again[96];

	(void)state;
	for (size_t i = 0; i < COUNT(bands); i++) {
		struct spec_channel first = read_name(bands[i].name), second;

		spec_names_write(text, sizeof text, first.role, first.stokes,
			first.wavelength_nm, first.reradiated_nm);
		second = read_name(text);
		assert_int_equal(second.role, first.role);
		assert_int_equal(second.stokes, first.stokes);
		assert_true(
			fabs(second.wavelength_nm - first.wavelength_nm) <= 0.5e-6 * 1.001);
		spec_names_write(again, sizeof again, second.role, second.stokes,
			second.wavelength_nm, second.reradiated_nm);
		assert_string_equal(again, text);
	}
}

/* Images */

static struct spec_image
image_of(const char *const *names, size_t count)
{
	struct spec_image image = {.data = {0, 0, 1, 1}, .display = {0, 0, 1, 1}};
	struct spec_error error;

	for (size_t i = 0; i < count; i++)
		check(spec_image_add_channel(&image, names[i], SPEC_SAMPLE_FLOAT, &error),
			&error);
	return image;
}

static struct spec_image
indexed(const char *const *names, size_t count)
{
	struct spec_image image = image_of(names, count);
	struct spec_error error;

	check(spec_image_index(&image, "a.exr", &error), &error);
	return image;
}

static void
assert_unfit(const char *const *names, size_t count, const char *words)
{
	struct spec_image image = image_of(names, count);
	struct spec_error error;

	assert_int_equal(spec_image_index(&image, "a.exr", &error), SPEC_EFORMAT);
	if (strncmp(error.message, "a.exr: ", 7) != 0 || !strstr(error.message, words))
		fail_msg("'%s' does not say '%s'", error.message, words);
	spec_image_clear(&image);
}

#define INDEXED(...)                                                                       \
	indexed((const char *const[]){__VA_ARGS__},                                        \
		COUNT(((const char *const[]){__VA_ARGS__})))
#define ASSERT_UNFIT(words, ...)                                                           \
	assert_unfit((const char *const[]){__VA_ARGS__},                                   \
		COUNT(((const char *const[]){__VA_ARGS__})), words)

/* Channels lie in the order of their names, bands in that of their wavelengths. */
static void
test_index_order(void **state)
{
	struct spec_image image = INDEXED("S0.1050,000000nm", "Z", "S0.950,000000nm",
		"S0.99,000000nm", "A", "S0.0,5um");
	static const char *const order[] = {"A", "S0.0,5um", "S0.1050,000000nm",
		"S0.950,000000nm", "S0.99,000000nm", "Z"};
	static const double wavelength_nm[] = {99, 500, 950, 1050};
	static const size_t channel[] = {4, 1, 3, 2};

	(void)state;
	for (size_t i = 0; i < COUNT(order); i++)
		assert_string_equal(image.channel[i].name, order[i]);
	assert_int_equal(image.role, SPEC_ROLE_EMISSIVE);
	assert_int_equal(image.bands, 4);
	assert_int_equal(image.stokes, 1);
	assert_null(image.edges_nm);
	for (size_t i = 0; i < 4; i++) {
		assert_true(image.wavelength_nm[i] == wavelength_nm[i]);
		assert_int_equal(image.band_channel[i], channel[i]);
	}
	spec_image_clear(&image);
}

static void
test_index_stokes(void **state)
{
	static const char *const names[] = {"S3.500nm", "S3.1000nm", "S2.500nm",
		"S2.1000nm", "S1.500nm", "S1.1000nm", "S0.500nm", "S0.1000nm"};
	struct spec_image image = indexed(names, COUNT(names));

	(void)state;
	assert_int_equal(image.stokes, 4);
	assert_int_equal(image.bands, 2);
	for (int stokes = 0; stokes < 4; stokes++) {
		for (size_t i = 0; i < 2; i++) {
			const struct spec_channel *channel =
				&image.channel[image.band_channel[2 * (size_t)stokes + i]];

			assert_int_equal(channel->stokes, stokes);
			assert_true(channel->wavelength_nm == (i == 0 ? 500 : 1000));
		}
	}
	spec_image_clear(&image);
	ASSERT_UNFIT("Stokes", "S0.500nm", "S1.500nm", "S2.500nm");
	ASSERT_UNFIT("Stokes", "S1.500nm", "S2.500nm", "S3.500nm");
	ASSERT_UNFIT("S0 has 2 bands and S3 has 1", "S0.500nm", "S0.600nm", "S1.500nm",
		"S1.600nm", "S2.500nm", "S2.600nm", "S3.500nm");
	ASSERT_UNFIT("no partner", "S0.500nm", "S1.500nm", "S2.500nm", "S3.501nm");
	ASSERT_UNFIT("no partner", "S0.500nm", "S1.500nm", "S2.500nm", "S3.500,0000011nm");
	image = INDEXED("S0.500nm", "S1.500nm", "S2.500nm", "S3.500,0000009nm");
	assert_int_equal(image.stokes, 4);
	spec_image_clear(&image);
}

static void
test_index_unfit(void **state)
{
	struct spec_image image;

	(void)state;
	ASSERT_UNFIT("two grids in one file?", "S0.500,000000nm", "S0.500,0nm");
	ASSERT_UNFIT("two grids in one file?", "S0.500nm", "S0.0,5um", "S0.600nm");
	ASSERT_UNFIT("two grids", "Radiance.C11", "S0.500nm");
	ASSERT_UNFIT("two grids", "S0.500nm", "S0.600nm", "400.00-410.00nm");
	ASSERT_UNFIT("same band", "T.500nm", "T.500nm.500nm");
	ASSERT_UNFIT("two grids in one file?", "S0.500nm", "S0.500,0000009nm");
	image = INDEXED("S0.500nm", "S0.500,0000011nm");
	assert_int_equal(image.bands, 2);
	spec_image_clear(&image);
	ASSERT_UNFIT("emissive and reflective", "S0.500nm", "T.500nm");
	ASSERT_UNFIT("emissive and reflective", "S0.500nm", "T.500nm.600nm");
	ASSERT_UNFIT("two channels are named 'A'", "A", "S0.500nm", "A");
	ASSERT_UNFIT("none on the diagonal", "T.500nm.600nm");
}

static void
test_index_bispectral(void **state)
{
	struct spec_image image = INDEXED("T.400nm", "T.500nm", "T.600nm", "T.400nm.500nm",
		"T.400nm.600nm", "T.500nm.600nm");

	(void)state;
	assert_int_equal(image.role, SPEC_ROLE_REFLECTIVE);
	assert_int_equal(image.bands, 3);
	assert_int_equal(image.bispectral, 3);
	assert_true(image.wavelength_nm[2] == 600);
	spec_image_clear(&image);
}

/* No bands are no error, and an index can be made anew. */
static void
test_index_again(void **state)
{
	struct spec_image image = INDEXED("R", "G", "B");
	struct spec_error error;
	char *quantity;

	(void)state;
	assert_int_equal(image.role, SPEC_ROLE_OTHER);
	assert_int_equal(image.bands, 0);
	quantity = spec_image_quantity(&image, &error);
	assert_string_equal(quantity, "");
	free(quantity);
	check(spec_image_add_bands(&image, SPEC_ROLE_REFLECTIVE, 1, (double[]){700, 400}, 2,
		      SPEC_SAMPLE_HALF, &error),
		&error);
	check(spec_image_index(&image, "a", &error), &error);
	assert_int_equal(image.channels, 5);
	assert_int_equal(image.bands, 2);
	assert_true(image.wavelength_nm[0] == 400);
	assert_string_equal(image.channel[image.band_channel[0]].name, "T.400,000000nm");
	assert_int_equal(image.channel[image.band_channel[0]].sample, SPEC_SAMPLE_HALF);
	quantity = spec_image_quantity(&image, &error);
	assert_string_equal(quantity, "reflectance");
	free(quantity);
	spec_image_remove_bands(&image);
	check(spec_image_index(&image, "a", &error), &error);
	assert_int_equal(image.channels, 3);
	assert_int_equal(image.bands, 0);
	check(spec_image_add_bands(&image, SPEC_ROLE_EMISSIVE, 4, (double[]){400}, 1,
		      SPEC_SAMPLE_FLOAT, &error),
		&error);
	check(spec_image_index(&image, "a", &error), &error);
	assert_int_equal(image.channels, 7);
	assert_int_equal(image.stokes, 4);
	quantity = spec_image_quantity(&image, &error);
	assert_string_equal(quantity, "radiance per nm");
	free(quantity);
	spec_image_clear(&image);
}

/* A name that makes no sense is an error at once. */
static void
test_add_bad(void **state)
{
	struct spec_image image = {0};
	struct spec_error error;

	(void)state;
	assert_int_equal(spec_image_add_channel(&image, "S0.nm", SPEC_SAMPLE_FLOAT, &error),
		SPEC_EFORMAT);
	spec_image_clear(&image);
}

/* spec:bins */

static void
test_bins(void **state)
{
	static const char *const bad[] = {"", "450", "450 550", "450 550 650 750",
		"450 550 650x", "450  550 650", " 450 550 650", "450,0 550,0 650,0",
		"450 550 nan", "450 550 inf", "650 550 450", "450 450 650", "450 650 650",
		"510 550 650", "450 490 650", "450 610 650", "450 550 590",
		"450\n550\n650"};
	struct spec_image image = INDEXED("S0.500nm", "S0.600nm");
	struct spec_error error;
	char *written;

	(void)state;
	check(spec_image_set_text(&image, "spec:bins", "450 550.25 650", &error), &error);
	check(spec_image_index(&image, "a", &error), &error);
	assert_non_null(image.edges_nm);
	assert_true(image.edges_nm[0] == 450);
	assert_true(image.edges_nm[1] == 550.25);
	assert_true(image.edges_nm[2] == 650);
	for (size_t i = 0; i < COUNT(bad); i++) {
		check(spec_image_set_text(&image, "spec:bins", bad[i], &error), &error);
		if (spec_image_index(&image, "a.exr", &error) != SPEC_EFORMAT)
			fail_msg("'%s' was taken for bins", bad[i]);
		assert_non_null(strstr(error.message, "spec:bins"));
	}
	/* Ten digits are written. */
	check(spec_image_set_bins(
		      &image, (const double[]){450.1234567, 550, 650}, 2, &error),
		&error);
	written = text_of(&image, "spec:bins");
	assert_string_equal(written, "450.1234567 550 650");
	free(written);
	/* A bin that touches its wavelength is one. */
	check(spec_image_set_text(&image, "spec:bins", "500 600 600.5", &error), &error);
	check(spec_image_index(&image, "a", &error), &error);
	check(spec_image_set_bins(&image, (double[]){450, 550.125, 650}, 2, &error),
		&error);
	check(spec_image_index(&image, "a", &error), &error);
	assert_true(image.edges_nm[1] == 550.125);
	check(spec_image_set_bins(&image, NULL, 0, &error), &error);
	assert_null(spec_image_attribute(&image, "spec:bins"));
	check(spec_image_index(&image, "a", &error), &error);
	assert_null(image.edges_nm);
	spec_image_clear(&image);
}

/* Mitsuba's names tell the edges, where they meet. */
static void
test_bins_of_names(void **state)
{
	struct spec_image image =
		INDEXED("400.00-433.33nm", "433.33-466.67nm", "466.67-500.00nm");
	struct spec_error error;
	char *text;

	(void)state;
	assert_non_null(image.edges_nm);
	assert_true(image.edges_nm[0] == 400);
	assert_true(image.edges_nm[1] == 433.33);
	assert_true(image.edges_nm[3] == 500);
	/* Renamed, they are kept in the attribute. */
	check(spec_image_rename_bands(&image, "a", &error), &error);
	assert_string_equal(image.channel[0].name, "S0.416,665000nm");
	text = text_of(&image, "spec:bins");
	assert_string_equal(text, "400 433.33 466.67 500");
	free(text);
	assert_non_null(image.edges_nm);
	spec_image_clear(&image);
	image = INDEXED("400.00-430.00nm", "440.00-470.00nm");
	assert_null(image.edges_nm);
	spec_image_clear(&image);
	/* Ends and beginnings may be rounded apart by 0.01. */
	image = INDEXED("400.00-430.00nm", "430.01-470.00nm");
	assert_non_null(image.edges_nm);
	spec_image_clear(&image);
	image = INDEXED("400.00-430.00nm", "430.02-470.00nm");
	assert_null(image.edges_nm);
	spec_image_clear(&image);
}

/* Wavelengths in metres, of any type that holds a number; the attribute goes with the name. */
static void
test_ocean(void **state)
{
	struct spec_image image = INDEXED("a", "b", "c", "d", "e");
	const float single = 4.5e-7f;
	const double exact = 5.5e-7, none = 5.5e-2;
	struct spec_error error;

	(void)state;
	check(spec_image_set_attribute(
		      &image, "a.wavelength", "float", &single, sizeof single, &error),
		&error);
	check(spec_image_set_attribute(
		      &image, "b.wavelength", "double", &exact, sizeof exact, &error),
		&error);
	check(spec_image_set_text(&image, "c.wavelength", "6.5e-7", &error), &error);
	check(spec_image_set_attribute(
		      &image, "d.wavelength", "double", &none, sizeof none, &error),
		&error);
	check(spec_image_set_text(&image, "e.wavelength", "650 nm", &error), &error);
	check(spec_image_index(&image, "it", &error), &error);
	assert_int_equal(image.bands, 3);
	assert_int_equal(image.role, SPEC_ROLE_EMISSIVE);
	for (int i = 0; i < 3; i++)
		assert_true(fabs(image.wavelength_nm[i] - (450 + 100 * i)) < 1e-9);
	check(spec_image_rename_bands(&image, "it", &error), &error);
	assert_string_equal(image.channel[image.band_channel[1]].name, "S0.550,000000nm");
	assert_null(spec_image_attribute(&image, "b.wavelength"));
	assert_non_null(spec_image_attribute(&image, "d.wavelength"));
	spec_image_clear(&image);
}

static void
test_rename(void **state)
{
	struct spec_image image = INDEXED("S0.1,5um", "A", "S0.374,688nm", "S0.0,4um");
	struct spec_error error;

	(void)state;
	check(spec_image_rename_bands(&image, "a", &error), &error);
	assert_string_equal(image.channel[0].name, "A");
	assert_string_equal(image.channel[1].name, "S0.1500,000000nm");
	assert_string_equal(image.channel[2].name, "S0.374,688000nm");
	assert_string_equal(image.channel[3].name, "S0.400,000000nm");
	assert_int_equal(image.bands, 3);
	assert_int_equal(image.band_channel[2], 1);
	spec_image_clear(&image);
	image = INDEXED("Radiance.C01", "Radiance.C02");
	check(spec_image_rename_bands(&image, "a", &error), &error);
	assert_string_equal(image.channel[1].name, "S0.410,000000nm");
	assert_int_equal(image.channel[1].naming, SPEC_NAMING_LAYOUT);
	spec_image_clear(&image);
	image = INDEXED("w420nm", "w430nm");
	check(spec_image_rename_bands(&image, "a", &error), &error);
	assert_string_equal(image.channel[0].name, "T.420,000000nm");
	spec_image_clear(&image);
	image = INDEXED("T.0,4um", "T.0,5um", "T.0,4um.0,5um");
	check(spec_image_rename_bands(&image, "a", &error), &error);
	assert_string_equal(image.channel[1].name, "T.400,000000nm.500,000000nm");
	spec_image_clear(&image);
}

/* Attributes and history */

static void
test_attributes(void **state)
{
	struct spec_image image = {0};
	struct spec_error error;
	char *text;

	(void)state;
	assert_null(spec_image_attribute(&image, "a"));
	assert_null(text_of(&image, "a"));
	spec_image_remove_attribute(&image, "a"); /* harmless */
	for (int i = 0; i < 20; i++) {
		char name[16];

		snprintf(name, sizeof name, "n%d", i);
		check(spec_image_set_attribute(&image, name, "int", &i, sizeof i, &error),
			&error);
	}
	check(spec_image_set_text(&image, "n7", "seven", &error),
		&error); /* another type */
	spec_image_remove_attribute(&image, "n3");
	spec_image_remove_attribute(&image, "n19");
	assert_int_equal(image.attributes, 18);
	assert_null(spec_image_attribute(&image, "n3"));
	for (int i = 0; i < 19; i++) {
		const struct spec_attribute *found;
		char name[16];

		snprintf(name, sizeof name, "n%d", i);
		found = spec_image_attribute(&image, name);
		if (i == 3)
			continue;
		assert_non_null(found);
		if (i == 7) {
			assert_string_equal(found->type, "string");
			assert_int_equal(found->size, 5);
		} else {
			assert_string_equal(found->type, "int");
			assert_memory_equal(found->value, &i, sizeof i);
		}
	}
	text = text_of(&image, "n7");
	assert_string_equal(text, "seven");
	free(text);
	assert_null(text_of(&image, "n8")); /* no text */
	check(spec_image_set_text(&image, "n7", "", &error), &error);
	text = text_of(&image, "n7");
	assert_string_equal(text, "");
	free(text);
	spec_image_clear(&image);
	spec_image_clear(&image); /* harmless */
}

static void
test_copy(void **state)
{
	struct spec_image image = INDEXED("A", "S0.500nm"), copy;
	struct spec_error error;

	(void)state;
	image.part = strdup("left");
	image.channel[1].linear = 1;
	image.compression = 3;
	check(spec_image_set_text(&image, "owner", "me", &error), &error);
	check(spec_image_copy(&copy, &image, &error), &error);
	check(spec_image_index(&copy, "copy", &error), &error);
	spec_image_clear(&image);
	assert_int_equal(copy.bands, 1);
	assert_string_equal(copy.part, "left");
	assert_int_equal(copy.channel[1].linear, 1);
	assert_int_equal(copy.compression, 3);
	assert_memory_equal(spec_image_attribute(&copy, "owner")->value, "me", 2);
	spec_image_clear(&copy);
}

/* A line of history, read by sh, gives the arguments again. */
static void
test_history(void **state)
{
	static const char *arguments[] = {"/usr/bin/specconvert", "-o", "a b.exr", "it's",
		"", "$HOME `id` \\ \"q\" * ? ~ # ! & ; | < > ( ) { } [ ]",
		"--grid=400:700:5", "k\303\244se", "'", "''", "-", "#", "~", "=x", "a=b c"};
	struct spec_image image = {0};
	struct spec_error error;
	char *text, *line, got[4096] = "";
	char path[] = "/tmp/names.XXXXXX", command[64];
	size_t length = 0;
	FILE *stream;
	int fd;

	(void)state;
	check(spec_image_set_text(&image, "spec:history", "before", &error), &error);
	check(spec_image_add_history(&image, COUNT(arguments), (char **)arguments, &error),
		&error);
	text = text_of(&image, "spec:history");
	assert_int_equal(strncmp(text, "before\nspecconvert -o 'a b.exr' ", 31), 0);
	assert_int_equal(text[strlen(text) - 1], '\n');
	line = strchr(text, '\n') + 1;
	assert_ptr_equal(strchr(line, '\n'), text + strlen(text) - 1); /* one line */
	assert_non_null(strstr(line, "  # spectools " SPEC_VERSION "\n"));
	/* A script in which the tool's name prints its arguments, each ended by \1. */
	fd = mkstemp(path);
	assert_true(fd >= 0);
	stream = fdopen(fd, "w");
	assert_non_null(stream);
	fprintf(stream, "specconvert() { for a; do printf '%%s\\001' \"$a\"; done; }\n%s",
		line);
	assert_int_equal(fclose(stream), 0);
	snprintf(command, sizeof command, "sh %s", path);
	stream = popen(command, "r");
	assert_non_null(stream);
	got[fread(got, 1, sizeof got - 1, stream)] = '\0';
	assert_int_equal(pclose(stream), 0);
	remove(path);
	for (size_t i = 1; i < COUNT(arguments); i++) {
		size_t size = strlen(arguments[i]);

		assert_int_equal(strncmp(got + length, arguments[i], size), 0);
		assert_int_equal(got[length + size], 1);
		length += size + 1;
	}
	assert_int_equal(got[length], '\0');
	free(text);
	spec_image_clear(&image);
}

/* Each tool adds a line; a line break in an argument does not. */
static void
test_history_lines(void **state)
{
	static const char *first[] = {"spec2rgb"}, *second[] = {"specdiff", "a\nb\rc"};
	struct spec_image image = {0};
	struct spec_error error;
	char *text;

	(void)state;
	check(spec_image_add_history(&image, 1, (char **)first, &error), &error);
	check(spec_image_add_history(&image, 2, (char **)second, &error), &error);
	text = text_of(&image, "spec:history");
	assert_string_equal(text, "spec2rgb  # spectools " SPEC_VERSION
				  "\nspecdiff 'a b c'  # spectools " SPEC_VERSION "\n");
	free(text);
	spec_image_clear(&image);
}

int
main(void)
{
	const struct CMUnitTest tests[] = {
		cmocka_unit_test(test_read_bands),
		cmocka_unit_test(test_read_exactly),
		cmocka_unit_test(test_read_others),
		cmocka_unit_test(test_read_bad),
		cmocka_unit_test(test_write),
		cmocka_unit_test(test_round_trip),
		cmocka_unit_test(test_index_order),
		cmocka_unit_test(test_index_stokes),
		cmocka_unit_test(test_index_unfit),
		cmocka_unit_test(test_index_bispectral),
		cmocka_unit_test(test_index_again),
		cmocka_unit_test(test_add_bad),
		cmocka_unit_test(test_bins),
		cmocka_unit_test(test_bins_of_names),
		cmocka_unit_test(test_ocean),
		cmocka_unit_test(test_rename),
		cmocka_unit_test(test_attributes),
		cmocka_unit_test(test_copy),
		cmocka_unit_test(test_history),
		cmocka_unit_test(test_history_lines),
	};

	return cmocka_run_group_tests(tests, NULL, NULL);
}
