/*
 * PNG pictures that libpng writes here, of every kind, against the numbers that went in and
 * the definitions of what they stand for.
 */
#include <math.h>
#include <png.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/wait.h>

#include "readback.h"

#define WIDTH 9
#define HEIGHT 7

/* What is written. */
struct kind {
	int colour, depth, interlace;
	int transparent; /* tRNS: palette entry 1, or the sample of pixel 1,0 */
	double gamma;    /* gAMA, or 0 */
	int srgb;        /* the chunk */
	const unsigned char *cicp;
	const double *chromaticities; /* white, red, green, blue */
};

static struct spec_settings settings;

static int
set_up(void **state)
{
	(void)state;
	spec_settings_init(&settings);
	return scratch_make("png");
}

/* A sample of any depth, that is neither constant nor alike in the channels. */
static unsigned
sample_at(const struct kind *kind, int x, int y, int channel)
{
	unsigned most = (1U << kind->depth) - 1;

	return (unsigned)(x * 37 + y * 11401 + channel * 7919 + x * y * 5) % (most + 1);
}

static const png_color palette[4] = {{0, 10, 20}, {255, 1, 2}, {30, 200, 100}, {5, 6, 255}};

static int
channels_of(int colour)
{
	return colour == PNG_COLOR_TYPE_GRAY || colour == PNG_COLOR_TYPE_PALETTE ? 1
	       : colour == PNG_COLOR_TYPE_GRAY_ALPHA                             ? 2
	       : colour == PNG_COLOR_TYPE_RGB                                    ? 3
										 : 4;
}

/* A row as PNG has it: from the highest bit, 16 bits with the higher byte first. */
static void
fill_row(const struct kind *kind, int y, unsigned char *row)
{
	int channels = channels_of(kind->colour);
	size_t bit = 0;

	memset(row, 0, WIDTH * 8);
	for (int i = 0; i < WIDTH * channels; i++, bit += (size_t)kind->depth) {
		unsigned value = sample_at(kind, i / channels, y, i % channels);

		if (kind->colour == PNG_COLOR_TYPE_PALETTE)
			value %= 4;
		for (int b = 0; b < kind->depth; b++)
			if (value >> (kind->depth - 1 - b) & 1)
				row[(bit + (size_t)b) / 8] |=
					(unsigned char)(0x80 >> (bit + (size_t)b) % 8);
	}
}

static void
set_chunks(png_structp png, png_infop info, const struct kind *kind)
{
	static png_byte alpha[2] = {255, 51};
	png_color_16 clear = {.gray = (png_uint_16)sample_at(kind, 1, 0, 0),
		.red = (png_uint_16)sample_at(kind, 1, 0, 0),
		.green = (png_uint_16)sample_at(kind, 1, 0, 1),
		.blue = (png_uint_16)sample_at(kind, 1, 0, 2)};
	const double *xy = kind->chromaticities;

	if (kind->colour == PNG_COLOR_TYPE_PALETTE)
		png_set_PLTE(png, info, palette, kind->depth == 1 ? 2 : 4);
	if (kind->transparent)
		png_set_tRNS(png, info, alpha,
			kind->colour == PNG_COLOR_TYPE_PALETTE ? 2 : 0,
			kind->colour == PNG_COLOR_TYPE_PALETTE ? NULL : &clear);
	if (kind->srgb)
		png_set_sRGB(png, info, PNG_sRGB_INTENT_PERCEPTUAL);
	if (xy)
		png_set_cHRM(
			png, info, xy[0], xy[1], xy[2], xy[3], xy[4], xy[5], xy[6], xy[7]);
}

static void
save_png(const char *name, const struct kind *kind)
{
	png_structp png = png_create_write_struct(PNG_LIBPNG_VER_STRING, NULL, NULL, NULL);
	png_infop info = png_create_info_struct(png);
	unsigned char rows[HEIGHT][WIDTH * 8];
	char path[256];
	FILE *file;
	int passes;

	snprintf(path, sizeof path, "%s/%s", scratch, name);
	file = fopen(path, "wb");
	assert_non_null(file);
	if (setjmp(png_jmpbuf(png)))
		fail_msg("libpng did not write %s", name);
	png_init_io(png, file);
	png_set_IHDR(png, info, WIDTH, HEIGHT, kind->depth, kind->colour,
		kind->interlace ? PNG_INTERLACE_ADAM7 : PNG_INTERLACE_NONE,
		PNG_COMPRESSION_TYPE_DEFAULT, PNG_FILTER_TYPE_DEFAULT);
	set_chunks(png, info, kind);
	png_write_info_before_PLTE(png, info);
	if (kind->cicp)
		png_write_chunk(png, (png_const_bytep) "cICP", kind->cicp, 4);
	if (kind->gamma > 0) { /* png_set_gAMA would not write one that contradicts sRGB */
		uint32_t number = (uint32_t)lround(kind->gamma * 1e5);
		unsigned char bytes[4] = {(unsigned char)(number >> 24),
			(unsigned char)(number >> 16), (unsigned char)(number >> 8),
			(unsigned char)number};

		png_write_chunk(png, (png_const_bytep) "gAMA", bytes, 4);
	}
	png_write_info(png, info);
	passes = png_set_interlace_handling(png);
	for (int pass = 0; pass < passes; pass++) {
		for (int y = 0; y < HEIGHT; y++) {
			fill_row(kind, y, rows[y]);
			png_write_row(png, rows[y]);
		}
	}
	png_write_end(png, NULL);
	png_destroy_write_struct(&png, &info);
	fclose(file);
}

/* IEC 61966-2-1:1999. */
static double
from_srgb(double v)
{
	return v <= 0.04045 ? v / 12.92 : pow((v + 0.055) / 1.055, 2.4);
}

static double
as_it_is(double v)
{
	return v;
}

/* What a pixel of the kind should be, premultiplied; returns the number of channels. */
static int
wanted_at(const struct kind *kind, int x, int y, double (*light)(double), double value[4])
{
	int channels = channels_of(kind->colour), colours = channels >= 3 ? 3 : 1, same = 1;
	double most = (double)((1U << kind->depth) - 1), alpha = 1;

	if (kind->colour == PNG_COLOR_TYPE_PALETTE) {
		unsigned entry = sample_at(kind, x, y, 0) % 4;

		value[0] = light(palette[entry].red / 255.);
		value[1] = light(palette[entry].green / 255.);
		value[2] = light(palette[entry].blue / 255.);
		colours = 3;
		alpha = entry == 1 ? 51 / 255. : 1;
	} else {
		for (int c = 0; c < colours; c++) {
			value[c] = light(sample_at(kind, x, y, c) / most);
			same &= sample_at(kind, x, y, c) == sample_at(kind, 1, 0, c);
		}
		alpha = kind->transparent ? !same : 1;
		if (channels == colours + 1)
			alpha = sample_at(kind, x, y, colours) / most;
	}
	if (!kind->transparent && channels != colours + 1)
		return colours;
	for (int c = 0; c < colours; c++)
		value[c] *= alpha;
	value[colours] = alpha;
	return colours + 1;
}

static void
check_picture(const char *name, const struct kind *kind, double (*light)(double),
	const struct readback *back)
{
	static const char *const order[] = {
		"Y", "AY", "BGR", "ABGR"}; /* as strcmp has it */
	static const char *const letters[] = {"Y", "YA", "RGB", "RGBA"};
	double value[4];

	for (int i = 0; i < WIDTH * HEIGHT; i++) {
		int count = wanted_at(kind, i % WIDTH, i / WIDTH, light, value);

		assert_int_equal(back->image->channels, count);
		for (int c = 0; c < count; c++) {
			char letter = letters[count - 1][c];
			size_t at = (size_t)(strchr(order[count - 1], letter) -
					     order[count - 1]);
			float got = back->value[at * WIDTH * HEIGHT + (size_t)i];

			assert_int_equal(back->image->channel[at].name[0], letter);
			/* Two roundings to float, of the light and of its product. */
			if (!(fabs(got - value[c]) <= 1.3e-7 * value[c]))
				fail_msg(
					"%s: colour %d, depth %d, interlace %d, "
					"transparent %d: %c of %d,%d is %.9g instead of %.9g",
					name, kind->colour, kind->depth, kind->interlace,
					kind->transparent, letter, i % WIDTH, i / WIDTH,
					got, value[c]);
		}
	}
}

static void
every_colour_and_depth(void **state)
{
	static const struct kind kinds[] = {{.colour = PNG_COLOR_TYPE_GRAY, .depth = 1},
		{.colour = PNG_COLOR_TYPE_GRAY, .depth = 2},
		{.colour = PNG_COLOR_TYPE_GRAY, .depth = 4},
		{.colour = PNG_COLOR_TYPE_GRAY, .depth = 8},
		{.colour = PNG_COLOR_TYPE_GRAY, .depth = 16},
		{.colour = PNG_COLOR_TYPE_PALETTE, .depth = 2},
		{.colour = PNG_COLOR_TYPE_PALETTE, .depth = 4},
		{.colour = PNG_COLOR_TYPE_PALETTE, .depth = 8},
		{.colour = PNG_COLOR_TYPE_RGB, .depth = 8},
		{.colour = PNG_COLOR_TYPE_RGB, .depth = 16},
		{.colour = PNG_COLOR_TYPE_GRAY_ALPHA, .depth = 8},
		{.colour = PNG_COLOR_TYPE_GRAY_ALPHA, .depth = 16},
		{.colour = PNG_COLOR_TYPE_RGB_ALPHA, .depth = 8},
		{.colour = PNG_COLOR_TYPE_RGB_ALPHA, .depth = 16}};

	(void)state;
	for (size_t i = 0; i < COUNT(kinds) * 4; i++) {
		struct kind kind = kinds[i / 4];
		struct readback back;

		kind.interlace = i % 2;
		kind.transparent = i / 2 % 2;
		if (kind.transparent && kind.colour & PNG_COLOR_MASK_ALPHA)
			continue;
		save_png("a.png", &kind);
		reads(&back, "a.png", &settings);
		check_picture("a.png", &kind, from_srgb, &back);
		readback_close(&back);
	}
}

/* Curves of ITU-T H.273, by their numbers there, and of gAMA. */
static double
power_22(double v)
{
	return pow(v, 2.2);
}

static double
power_28(double v)
{
	return pow(v, 2.8);
}

static double
power_18(double v)
{
	return pow(v, 1 / .55556);
}

static double
video(double v)
{
	return v < 4.5 * .018053968510807
		       ? v / 4.5
		       : pow((v + .09929682680944) / 1.09929682680944, 1 / .45);
}

static void
transfer_functions_are_honoured(void **state)
{
	static const unsigned char bt709[] = {1, 1, 0, 1}, g22[] = {1, 4, 0, 1},
				   g28[] = {1, 5, 0, 1}, linear[] = {1, 8, 0, 1},
				   srgb[] = {1, 13, 0, 1}, bt2020[] = {9, 14, 0, 1};
	static const struct {
		struct kind kind;
		double (*light)(double);
	} cases[] = {{{.gamma = .45455}, from_srgb}, {{.gamma = 1}, as_it_is},
		{{.gamma = .55556}, power_18}, {{.gamma = 1, .srgb = 1}, from_srgb},
		{{.cicp = bt709}, video}, {{.cicp = g22}, power_22},
		{{.cicp = g28}, power_28}, {{.cicp = linear, .srgb = 1}, as_it_is},
		{{.cicp = srgb, .gamma = 1}, from_srgb}, {{.cicp = bt2020}, video}};

	(void)state;
	for (size_t i = 0; i < COUNT(cases) * 2; i++) {
		struct kind kind = cases[i / 2].kind;
		struct readback back;

		kind.colour = PNG_COLOR_TYPE_RGB;
		kind.depth = i % 2 ? 16 : 8;
		save_png("a.png", &kind);
		reads(&back, "a.png", &settings);
		check_picture("a transfer function", &kind, cases[i / 2].light, &back);
		readback_close(&back);
	}
}

static void
has_primaries(const struct kind *kind, const float *wanted)
{
	const struct spec_attribute *attribute;
	struct readback back;
	float xy[8];

	save_png("a.png", kind);
	reads(&back, "a.png", &settings);
	attribute = spec_image_attribute(back.image, "chromaticities");
	if (!wanted) {
		assert_null(attribute);
	} else {
		assert_non_null(attribute);
		assert_int_equal(attribute->size, sizeof xy);
		memcpy(xy, attribute->value, sizeof xy);
		for (int i = 0; i < 8; i++)
			near(xy[i], wanted[i], 1e-6, "a chromaticity");
	}
	readback_close(&back);
}

static void
other_primaries_are_said(void **state)
{
	static const unsigned char bt2020[] = {9, 13, 0, 1}, srgb[] = {1, 13, 0, 1};
	static const float wide[] = {.708F, .292F, .170F, .797F, .131F, .046F, .3127F,
		.3290F},
			   other[] = {.7F, .3F, .2F, .7F, .1F, .05F, .3F, .35F};
	static const double chromaticities[] = {.3, .35, .7, .3, .2, .7, .1, .05},
			    standard[] = {.3127, .3290, .64, .33, .30, .60, .15, .06};
	struct kind kind = {.colour = PNG_COLOR_TYPE_RGB, .depth = 8};

	(void)state;
	has_primaries(&kind, NULL);
	kind.chromaticities = standard;
	has_primaries(&kind, NULL);
	kind.chromaticities = chromaticities;
	has_primaries(&kind, other);
	kind.cicp = bt2020;
	has_primaries(&kind, wide);
	kind.cicp = srgb;
	has_primaries(&kind, NULL);
}

static void
what_is_not_understood_is_refused(void **state)
{
	static const struct {
		unsigned char cicp[4];
		const char *part;
	} cases[] = {{{9, 16, 0, 1}, "transfer function, number 16"},
		{{9, 18, 0, 1}, "transfer function, number 18"},
		{{10, 13, 0, 1}, "primaries, number 10"}, {{1, 13, 1, 1}, "no RGB"},
		{{1, 13, 0, 0}, "no RGB"}};

	(void)state;
	for (size_t i = 0; i < COUNT(cases); i++) {
		struct kind kind = {
			.colour = PNG_COLOR_TYPE_RGB, .depth = 8, .cicp = cases[i].cicp};

		save_png("a.png", &kind);
		refuses("a.png", &settings, SPEC_EUNSUPPORTED, cases[i].part);
	}
}

/* Grey with its wavelength, and three channels as three bands: the numbers themselves. */
static void
bands_stay_raw(void **state)
{
	struct spec_settings told = settings;
	struct kind kind = {.colour = PNG_COLOR_TYPE_GRAY, .depth = 16};
	struct readback back;

	(void)state;
	told.wavelengths = "550";
	told.read_as = SPEC_ROLE_EMISSIVE;
	save_png("a.png", &kind);
	reads(&back, "a.png", &told);
	for (int i = 0; i < WIDTH * HEIGHT; i++)
		near(readback_at(&back, 0, i % WIDTH, i / WIDTH),
			(float)sample_at(&kind, i % WIDTH, i / WIDTH, 0) / 65535.F, 0,
			"a number");
	readback_close(&back);
	kind = (struct kind){.colour = PNG_COLOR_TYPE_RGB, .depth = 8};
	told.wavelengths = "450,550,650";
	save_png("a.png", &kind);
	reads(&back, "a.png", &told);
	near(readback_at(&back, 2, 4, 3), (float)sample_at(&kind, 4, 3, 2) / 255.F, 0,
		"a number");
	readback_close(&back);
}

static void
lines_may_be_read_again(void **state)
{
	struct spec_error error;
	struct readback back;

	(void)state;
	for (int interlace = 0; interlace < 2; interlace++) {
		struct kind kind = {
			.colour = PNG_COLOR_TYPE_RGB, .depth = 8, .interlace = interlace};

		save_png("a.png", &kind);
		reads(&back, "a.png", &settings);
		free(back.value);
		assert_int_equal(readback_lines(&back, 3, &error), SPEC_OK);
		check_picture("a second time", &kind, from_srgb, &back);
		readback_close(&back);
	}
}

/* Cut at every byte, and with every byte another. */
static void
damage_is_found(void **state)
{
	struct kind kind = {.colour = PNG_COLOR_TYPE_RGB_ALPHA, .depth = 8};
	unsigned char *bytes;
	char path[256];
	size_t size;

	(void)state;
	snprintf(path, sizeof path, "%s/whole.png", scratch);
	for (kind.interlace = 0; kind.interlace < 2; kind.interlace++) {
		save_png("whole.png", &kind);
		bytes = file_bytes(path, &size);
		for (size_t i = 8; i < size; i++) {
			save("cut.png", bytes, i);
			refuses("cut.png", &settings, SPEC_EFORMAT, "cut.png: ends early");
		}
		for (size_t i = 8; i < size; i++) {
			bytes[i] ^= 0x55;
			save("bad.png", bytes, size);
			{
				struct spec_error error = {0};
				struct readback back;

				/* Checksums cover all but themselves and lengths. */
				if (readback(&back, "bad.png", &settings, &error) ==
					SPEC_OK)
					readback_close(&back);
				else
					assert_contains(error.message, "bad.png: ");
			}
			bytes[i] ^= 0x55;
		}
		free(bytes);
	}
}

static void
limits_hold(void **state)
{
	struct kind kind = {.colour = PNG_COLOR_TYPE_RGB, .depth = 8, .interlace = 1};
	struct spec_settings small = settings;

	(void)state;
	save_png("a.png", &kind);
	small.limits.pixels = WIDTH * HEIGHT - 1;
	refuses("a.png", &small, SPEC_ERANGE, "(--limit pixels=N)");
	small = settings;
	/* Room for rows, and not for the whole. */
	small.limits.memory = 4 * WIDTH * 3 * 4;
	save_png("b.png",
		&(struct kind){.colour = PNG_COLOR_TYPE_RGB, .depth = 16, .interlace = 1});
	small.limits.memory = WIDTH * HEIGHT * 6 - 1;
	refuses("b.png", &small, SPEC_ERANGE, "memory=BYTES)");
}

/* A folder of grey pictures is a stack of bands; what does not fit one is refused. */
static void
folders_are_stacks(void **state)
{
	struct spec_settings told = settings;
	struct kind grey = {.colour = PNG_COLOR_TYPE_GRAY, .depth = 16},
		    narrow = {.colour = PNG_COLOR_TYPE_GRAY, .depth = 8},
		    colour = {.colour = PNG_COLOR_TYPE_RGB, .depth = 8};
	struct readback back;

	(void)state;
	told.read_as = SPEC_ROLE_REFLECTIVE;
	make_folder("scene");
	refuses("scene", &told, SPEC_EFORMAT, "has no picture in it");
	save_png("scene/x_650nm.png", &narrow);
	save_png("scene/x_450.5nm.png", &grey);
	save_text("scene/notes.txt", "hello");
	save_text("scene/.hidden", "hello");
	make_folder("scene/more.d");
	reads(&back, "scene", &told);
	assert_int_equal(back.image->bands, 2);
	near(back.image->wavelength_nm[0], 450.5, 1e-9, "the first wavelength");
	near(readback_at(&back, 0, 3, 4), (float)sample_at(&grey, 3, 4, 0) / 65535.F, 0,
		"a number of 16 bits");
	near(readback_at(&back, 1, 3, 4), (float)sample_at(&narrow, 3, 4, 0) / 255.F, 0,
		"a number of 8 bits");
	readback_close(&back);
	refuses("scene", &settings, SPEC_EUSAGE, "(--read-as)");
	save_png("scene/y_650nm.png", &narrow);
	refuses("scene", &told, SPEC_EFORMAT, "are both of 650 nm");
	save_png("scene/y_650nm.png", &colour);
	told.wavelengths = "400:600:100";
	refuses("scene", &told, SPEC_EFORMAT, "y_650nm.png: is coloured");
	told.wavelengths = "400:500:100";
	refuses("scene", &told, SPEC_EUSAGE, "has 3 bands, and --wavelengths gives 2");
	save_text("scene/y_650nm.png", "no picture");
	refuses("scene", &told, SPEC_EFORMAT, "y_650nm.png: ");
}

/* Without wavelengths in the names their order counts, in which 2 comes before 10. */
static void
numbered_pictures_are_in_order(void **state)
{
	struct spec_settings told = settings;
	struct readback back;

	(void)state;
	told.read_as = SPEC_ROLE_EMISSIVE;
	told.wavelengths = "400:600:100";
	make_folder("numbered");
	for (int i = 0; i < 3; i++) {
		static const char *const names[] = {
			"numbered/ms_1.png", "numbered/ms_2.png", "numbered/ms_10.png"};
		struct kind kind = {.colour = PNG_COLOR_TYPE_GRAY, .depth = 2 << i};

		save_png(names[i], &kind);
	}
	refuses("numbered",
		&(struct spec_settings){
			.limits = settings.limits, .read_as = SPEC_ROLE_EMISSIVE},
		SPEC_EUSAGE, "(--wavelengths");
	reads(&back, "numbered", &told);
	for (size_t i = 0; i < 3; i++) {
		struct kind kind = {.depth = 2 << i};

		near(readback_at(&back, i, 5, 6),
			(float)sample_at(&kind, 5, 6, 0) / (float)((1 << (2 << i)) - 1),
			1e-7, "a picture by its number");
	}
	readback_close(&back);
}

int
main(void)
{
	const struct CMUnitTest tests[] = {
		cmocka_unit_test(every_colour_and_depth),
		cmocka_unit_test(transfer_functions_are_honoured),
		cmocka_unit_test(other_primaries_are_said),
		cmocka_unit_test(what_is_not_understood_is_refused),
		cmocka_unit_test(bands_stay_raw),
		cmocka_unit_test(lines_may_be_read_again),
		cmocka_unit_test(damage_is_found),
		cmocka_unit_test(limits_hold),
		cmocka_unit_test(folders_are_stacks),
		cmocka_unit_test(numbered_pictures_are_in_order),
	};

	return cmocka_run_group_tests(tests, set_up, scratch_remove);
}
