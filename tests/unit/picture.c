/* Pictures: what is written is read back by other means. */
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include <fcntl.h>
#include <png.h>
#include <sys/wait.h>
#include <unistd.h>

#include "image/image.h"
#include "image/picture.h"
#include "image/reader.h"

#include "files.h"

#define WIDTH 37
#define HEIGHT 23
#define SAMPLES ((size_t)WIDTH * HEIGHT * 3)

struct fixture {
	char folder[64];
	char path[128];
	uint8_t *u8;
	uint16_t *u16;
	float *floats;
};

/* Noise, which no format can compress much. Knuth's multiplicative hash. */
static int
set_up(void **state)
{
	struct fixture *fixture = calloc(1, sizeof *fixture);

	assert_non_null(fixture);
	strcpy(fixture->folder, "/tmp/picture.XXXXXX");
	assert_non_null(mkdtemp(fixture->folder));
	fixture->u8 = malloc(SAMPLES);
	fixture->u16 = malloc(SAMPLES * sizeof *fixture->u16);
	fixture->floats = malloc(SAMPLES * sizeof *fixture->floats);
	assert_true(fixture->u8 && fixture->u16 && fixture->floats);
	for (size_t i = 0; i < SAMPLES; i++) {
		uint32_t noise = (uint32_t)i * 2654435761u;

		noise ^= noise >> 15;
		fixture->u8[i] = (uint8_t)(noise >> 7);
		fixture->u16[i] = (uint16_t)(noise >> 3);
		fixture->floats[i] = (float)i / 100 - 1;
	}
	*state = fixture;
	return 0;
}

static int
tear_down(void **state)
{
	struct fixture *fixture = *state;

	assert_int_equal(rmdir(fixture->folder), 0); /* nothing was left in it */
	free(fixture->u8);
	free(fixture->u16);
	free(fixture->floats);
	free(fixture);
	return 0;
}

static const void *
rows_of(const struct fixture *fixture, const struct spec_picture_kind *kind, size_t y)
{
	size_t at = y * WIDTH * 3;

	return kind->sample == SPEC_PICTURE_U8    ? (const void *)(fixture->u8 + at)
	       : kind->sample == SPEC_PICTURE_U16 ? (const void *)(fixture->u16 + at)
						  : (const void *)(fixture->floats + at);
}

/* Writes the fixture's picture to name in its folder; rows in uneven portions. */
static void
write_picture(struct fixture *fixture, const char *name, int bits, const char *space)
{
	static const size_t portions[] = {1, 5, 0, 16, 1};
	struct spec_error error = {0};
	struct spec_picture_kind kind;
	struct spec_picture *picture;
	struct spec_output output;
	size_t y = 0;

	snprintf(fixture->path, sizeof fixture->path, "%s/%s", fixture->folder, name);
	if (spec_picture_choose(fixture->path, NULL, bits, &kind, &error) != SPEC_OK)
		fail_msg("%s", error.message);
	assert_int_equal(spec_output_open(&output, fixture->path, &error), SPEC_OK);
	if (spec_picture_open(&picture, &kind, &output, WIDTH, HEIGHT,
		    space ? spec_space_find(space, NULL) : NULL, &error) != SPEC_OK)
		fail_msg("%s", error.message);
	for (size_t i = 0; i < COUNT(portions); y += portions[i++]) {
		if (spec_picture_write(picture, rows_of(fixture, &kind, y), portions[i],
			    &error) != SPEC_OK)
			fail_msg("%s", error.message);
	}
	assert_int_equal(y, HEIGHT);
	if (spec_picture_finish(picture, &error) != SPEC_OK)
		fail_msg("%s", error.message);
	spec_picture_close(picture);
	assert_int_equal(spec_output_commit(&output, &error), SPEC_OK);
}

/* The whole file, which is then removed. */
static unsigned char *
take_file(const char *path, size_t *size)
{
	unsigned char *bytes = file_bytes(path, size);

	unlink(path);
	return bytes;
}

/* PNG */

/* Samples in the file's own order (big-endian), and what it says of its space. */
static unsigned char *
read_png(const char *path, int bits, int *srgb, double *gamma, double white[2])
{
	png_structp png = png_create_read_struct(PNG_LIBPNG_VER_STRING, NULL, NULL, NULL);
	png_infop info = png_create_info_struct(png);
	size_t stride = (size_t)WIDTH * 3 * bits / 8;
	unsigned char *pixels = malloc(stride * HEIGHT);
	FILE *stream = fopen(path, "rb");
	double unused;
	int intent;

	assert_true(png && info && pixels && stream);
	png_init_io(png, stream);
	png_read_info(png, info);
	assert_int_equal(png_get_image_width(png, info), WIDTH);
	assert_int_equal(png_get_image_height(png, info), HEIGHT);
	assert_int_equal(png_get_bit_depth(png, info), bits);
	assert_int_equal(png_get_color_type(png, info), PNG_COLOR_TYPE_RGB);
	*srgb = png_get_sRGB(png, info, &intent) != 0;
	*gamma = white[0] = white[1] = 0;
	png_get_gAMA(png, info, gamma);
	png_get_cHRM(png, info, &white[0], &white[1], &unused, &unused, &unused, &unused,
		&unused, &unused);
	for (size_t y = 0; y < HEIGHT; y++)
		png_read_row(png, pixels + y * stride, NULL);
	png_read_end(png, NULL);
	png_destroy_read_struct(&png, &info, NULL);
	fclose(stream);
	unlink(path);
	return pixels;
}

static void
check_words(const unsigned char *big_endian, const uint16_t *words)
{
	for (size_t i = 0; i < SAMPLES; i++)
		assert_int_equal(big_endian[2 * i] << 8 | big_endian[2 * i + 1], words[i]);
}

static void
test_png8(void **state)
{
	struct fixture *fixture = *state;
	unsigned char *pixels;
	double gamma, white[2];
	int srgb;

	write_picture(fixture, "a.png", 0, "srgb");
	pixels = read_png(fixture->path, 8, &srgb, &gamma, white);
	assert_memory_equal(pixels, fixture->u8, SAMPLES);
	assert_true(srgb);
	free(pixels);
	write_picture(fixture, "a.b.PNG", 8, NULL);
	pixels = read_png(fixture->path, 8, &srgb, &gamma, white);
	assert_memory_equal(pixels, fixture->u8, SAMPLES);
	assert_false(srgb);
	assert_true(gamma == 0 && white[0] == 0);
	free(pixels);
}

static void
test_png16(void **state)
{
	struct fixture *fixture = *state;
	unsigned char *pixels;
	double gamma, white[2];
	int srgb;

	write_picture(fixture, "a.png", 16, "srgb");
	pixels = read_png(fixture->path, 16, &srgb, &gamma, white);
	check_words(pixels, fixture->u16);
	assert_true(srgb);
	free(pixels);
}

/* Spaces beside sRGB are told by gamma and chromaticities, which PNG rounds to 1e-5. */
static void
test_png_spaces(void **state)
{
	static const struct {
		const char *name;
		double gamma, white_x;
	} spaces[] = {{"p3", .45455, .3127}, {"rec2020", 0, .3127},
		{"adobe", .45471, .3127}, {"dci-p3", .38462, .314}, {"aces", 1, 0}};
	struct fixture *fixture = *state;

	for (size_t i = 0; i < COUNT(spaces); i++) {
		double gamma, white[2];
		int srgb;

		write_picture(fixture, "a.png", 8, spaces[i].name);
		free(read_png(fixture->path, 8, &srgb, &gamma, white));
		assert_false(srgb);
		assert_true(
			gamma > spaces[i].gamma - 1e-5 && gamma < spaces[i].gamma + 1e-5);
		assert_true(white[0] > spaces[i].white_x - 1e-5 &&
			    white[0] < spaces[i].white_x + 1e-5);
	}
}

/* PPM */

static void
test_ppm(void **state)
{
	static const char head8[] = "P6\n37 23\n255\n", head16[] = "P6\n37 23\n65535\n";
	struct fixture *fixture = *state;
	unsigned char *bytes;
	size_t size;

	write_picture(fixture, "a.ppm", 0, "srgb");
	bytes = take_file(fixture->path, &size);
	assert_int_equal(size, strlen(head8) + SAMPLES);
	assert_memory_equal(bytes, head8, strlen(head8));
	assert_memory_equal(bytes + strlen(head8), fixture->u8, SAMPLES);
	free(bytes);
	write_picture(fixture, "a.pnm", 16, NULL);
	bytes = take_file(fixture->path, &size);
	assert_int_equal(size, strlen(head16) + 2 * SAMPLES);
	assert_memory_equal(bytes, head16, strlen(head16));
	check_words(bytes + strlen(head16), fixture->u16);
	free(bytes);
}

/* More than one buffer, whose end falls inside a row. */
static void
test_ppm_large(void **state)
{
	enum { SIDE = 1001 };
	static const char head[] = "P6\n1001 1001\n65535\n";
	struct fixture *fixture = *state;
	struct spec_picture_kind kind;
	struct spec_picture *picture;
	struct spec_output output;
	size_t samples = (size_t)SIDE * SIDE * 3, size;
	uint16_t *words = malloc(samples * sizeof *words);
	unsigned char *bytes;

	assert_non_null(words);
	for (size_t i = 0; i < samples; i++)
		words[i] = (uint16_t)(i * 31 + i / 1000);
	snprintf(fixture->path, sizeof fixture->path, "%s/a.ppm", fixture->folder);
	assert_int_equal(
		spec_picture_choose(fixture->path, NULL, 16, &kind, NULL), SPEC_OK);
	assert_int_equal(spec_output_open(&output, fixture->path, NULL), SPEC_OK);
	assert_int_equal(
		spec_picture_open(&picture, &kind, &output, SIDE, SIDE, NULL, NULL),
		SPEC_OK);
	assert_int_equal(spec_picture_write(picture, words, SIDE, NULL), SPEC_OK);
	assert_int_equal(spec_picture_finish(picture, NULL), SPEC_OK);
	spec_picture_close(picture);
	assert_int_equal(spec_output_commit(&output, NULL), SPEC_OK);
	bytes = take_file(fixture->path, &size);
	assert_int_equal(size, strlen(head) + 2 * samples);
	for (size_t i = 0; i < samples; i++) {
		const unsigned char *word = bytes + strlen(head) + 2 * i;

		if ((word[0] << 8 | word[1]) != words[i])
			fail_msg("sample %zu", i);
	}
	free(bytes);
	free(words);
}

/* OpenEXR */

static void
check_exr_rows(struct fixture *fixture, struct spec_reader *reader, float tolerance)
{
	struct spec_decoder *decoder;

	assert_int_equal(spec_decoder_open(&decoder, reader, NULL, NULL), SPEC_OK);
	assert_int_equal(spec_decoder_fetch(decoder, 0, HEIGHT, NULL), SPEC_OK);
	assert_int_equal(spec_decoder_decode(decoder, NULL), SPEC_OK);
	for (int y = 0; y < HEIGHT; y++) {
		for (size_t c = 0; c < 3; c++) {
			const float *got = spec_decoder_row(decoder, y, c);

			for (size_t x = 0; x < WIDTH; x++) {
				float wanted = fixture->floats[((size_t)y * WIDTH + x) * 3 +
							       2 - c];

				assert_float_equal(got[x], wanted, tolerance);
			}
		}
	}
	spec_decoder_close(decoder);
}

static void
check_exr(struct fixture *fixture, int bits, const char *name)
{
	const struct spec_space *space = spec_space_find(name, NULL);
	const struct spec_attribute *attribute;
	const struct spec_image *image;
	struct spec_settings settings;
	struct spec_reader *reader;
	float xy[8];

	write_picture(fixture, "a.exr", bits, name);
	spec_settings_init(&settings);
	assert_int_equal(
		spec_reader_open(&reader, fixture->path, &settings, NULL), SPEC_OK);
	image = spec_reader_image(reader);
	assert_int_equal(image->channels, 3);
	assert_string_equal(image->channel[0].name, "B");
	assert_string_equal(image->channel[2].name, "R");
	assert_int_equal(image->channel[0].sample,
		bits == 16 ? SPEC_SAMPLE_HALF : SPEC_SAMPLE_FLOAT);
	attribute = spec_image_attribute(image, "chromaticities");
	assert_non_null(attribute);
	assert_string_equal(attribute->type, "chromaticities");
	assert_int_equal(attribute->size, sizeof xy);
	memcpy(xy, attribute->value, sizeof xy);
	assert_true(xy[0] == (float)space->red_xy[0] && xy[3] == (float)space->green_xy[1]);
	assert_true(
		xy[4] == (float)space->blue_xy[0] && xy[7] == (float)space->white_xy[1]);
	/* Half: 11 bits of values below 32, so at most half of 2^-6 off. */
	check_exr_rows(fixture, reader, bits == 16 ? 1.f / 128 : 0);
	spec_reader_close(reader);
	unlink(fixture->path);
}

static void
test_exr(void **state)
{
	check_exr(*state, 0, "srgb");
	check_exr(*state, 32, "aces");
	check_exr(*state, 16, "rec2020");
}

/* The plugin */

static void
check_magic(struct fixture *fixture, const char *name, int bits, const char *magic,
	size_t magic_size, size_t at, size_t least, size_t most)
{
	unsigned char *bytes;
	size_t size;

	write_picture(fixture, name, bits, "srgb");
	bytes = take_file(fixture->path, &size);
	if (size < at + magic_size || memcmp(bytes + at, magic, magic_size) != 0)
		fail_msg("%s: wrong signature", name);
	if (size < least || size > most)
		fail_msg("%s: %zu bytes, wanted %zu..%zu", name, size, least, most);
	free(bytes);
}

/*
 * Sizes: lossless formats hold this noise in about its plain size. sgi is one of
 * those that reach us through a file in a folder of the plugin's.
 */
static void
test_plugin(void **state)
{
	struct fixture *fixture = *state;
	size_t plain = SAMPLES;

	check_magic(fixture, "a.jpg", 0, "\xff\xd8\xff", 3, 0, 300, 3 * plain);
	check_magic(fixture, "a.JPEG", 8, "\xff\xd8\xff", 3, 0, 300, 3 * plain);
	check_magic(fixture, "a.hdr", 0, "#?RADIANCE", 10, 0, plain / 2, plain * 2);
	check_magic(fixture, "a.bmp", 0, "BM", 2, 0, plain, plain * 2);
	check_magic(fixture, "a.webp", 0, "RIFF", 4, 0, 100, plain * 2);
	check_magic(fixture, "a.tga", 0, "\0\0\x02", 3, 0, plain, plain * 4);
	check_magic(fixture, "a.sgi", 0, "\x01\xda", 2, 0, plain, plain * 2);
}

/* A number of the first directory of a little-endian TIFF; of several, the first. */
static unsigned
tiff_tag(const unsigned char *bytes, size_t size, unsigned wanted)
{
	size_t at = bytes[4] | bytes[5] << 8 | bytes[6] << 16;
	size_t count = at + 2 <= size ? bytes[at] | bytes[at + 1] << 8 : 0;

	for (size_t i = 0; i < count && at + 2 + 12 * (i + 1) <= size; i++) {
		const unsigned char *entry = bytes + at + 2 + 12 * i;
		size_t value = entry[8] | entry[9] << 8 | entry[10] << 16;

		if ((entry[0] | entry[1] << 8) != (int)wanted)
			continue;
		if (entry[2] == 3 && entry[4] > 2 &&
			value + 1 < size) /* more words than fit */
			value = bytes[value] | bytes[value + 1] << 8;
		return (unsigned)value;
	}
	return 0;
}

/* TIFF 6.0: width 256, length 257, bits 258, samples 277, format 339 (3: floats). */
static void
test_tiff(void **state)
{
	struct fixture *fixture = *state;

	for (int bits = 8; bits <= 32; bits *= 2) {
		unsigned char *bytes;
		size_t size, plain = SAMPLES * bits / 8;

		write_picture(fixture, bits == 8 ? "a.tif" : "a.TIFF", bits, "srgb");
		bytes = take_file(fixture->path, &size);
		/* The floats are a ramp, which ZIP makes small. */
		assert_in_range(size, bits == 32 ? plain / 10 : plain / 2, plain * 2);
		assert_memory_equal(bytes, "II*\0", 4);
		assert_int_equal(tiff_tag(bytes, size, 256), WIDTH);
		assert_int_equal(tiff_tag(bytes, size, 257), HEIGHT);
		assert_int_equal(tiff_tag(bytes, size, 258), bits);
		assert_int_equal(tiff_tag(bytes, size, 277), 3);
		assert_int_equal(tiff_tag(bytes, size, 339) == 3, bits == 32);
		free(bytes);
	}
}

/* BMP is plain: B, G, R from the bottom up, rows of whole words, after 54 bytes of header. */
static void
test_bmp_values(void **state)
{
	struct fixture *fixture = *state;
	size_t stride = (WIDTH * 3 + 3) / 4 * 4, size;
	unsigned char *bytes;

	write_picture(fixture, "a.bmp", 0, "srgb");
	bytes = take_file(fixture->path, &size);
	assert_int_equal(size, 54 + stride * HEIGHT);
	for (size_t i = 0; i < SAMPLES; i++) {
		size_t x = i / 3 % WIDTH, y = i / 3 / WIDTH;

		assert_int_equal(bytes[54 + (HEIGHT - 1 - y) * stride + 3 * x + 2 - i % 3],
			fixture->u8[i]);
	}
	free(bytes);
}

/* The flat scanlines' first pixel, and that of a negative sample: 0, not garbage. */
static void
test_hdr_values(void **state)
{
	static const char end[] = "-Y 23 +X 37\n";
	struct fixture *fixture = *state;
	unsigned char *bytes, *pixels;
	size_t size;

	for (size_t i = 0; i < SAMPLES; i++)
		fixture->floats[i] = i % 3 == 0 ? -1 : i % 3 == 1 ? 1 : .5f;
	write_picture(fixture, "a.hdr", 0, "srgb");
	bytes = take_file(fixture->path, &size);
	pixels = memmem(bytes, size, end, strlen(end));
	assert_non_null(pixels);
	pixels += strlen(end);
	/* New run-length encoding: 2 2 width, then per component runs of 37. */
	assert_memory_equal(pixels, "\2\2\0\45\245\0\245\200\245\100\245\201", 12);
	free(bytes);
}

/* Nothing of OpenImageIO may remain in the temporary folder. */
static void
test_plugin_tidy(void **state)
{
	struct fixture *fixture = *state;
	struct fixture inside = *fixture;

	setenv("TMPDIR", fixture->folder, 1);
	snprintf(inside.folder, sizeof inside.folder, "/tmp");
	write_picture(&inside, "picture-tidy.sgi", 0, "srgb");
	unlink(inside.path);
	unsetenv("TMPDIR"); /* tear_down finds the folder empty, or fails */
}

/* Errors */

static void
check_choice(const char *path, int bits, enum spec_status status, const char *message)
{
	struct spec_error error = {0};
	struct spec_picture_kind kind;

	assert_int_equal(spec_picture_choose(path, NULL, bits, &kind, &error), status);
	assert_int_equal(error.status, status);
	if (!strstr(error.message, message))
		fail_msg("%s: \"%s\" does not say \"%s\"", path, error.message, message);
	assert_int_equal(spec_picture_choose(path, NULL, bits, &kind, NULL), status);
}

static void
test_choose(void **state)
{
	struct spec_picture_kind kind;

	(void)state;
	assert_int_equal(spec_picture_choose("-", NULL, 0, &kind, NULL), SPEC_OK);
	assert_int_equal(kind.format, SPEC_PICTURE_PNG);
	assert_int_equal(kind.sample, SPEC_PICTURE_U8);
	assert_int_equal(spec_picture_choose("-", NULL, 16, &kind, NULL), SPEC_OK);
	assert_int_equal(kind.sample, SPEC_PICTURE_U16);
	assert_int_equal(spec_picture_choose("-", "PPM", 0, &kind, NULL), SPEC_OK);
	assert_int_equal(kind.format, SPEC_PICTURE_PPM);
	assert_int_equal(spec_picture_choose("x.exr", "ppm", 0, &kind, NULL), SPEC_OK);
	assert_int_equal(kind.format, SPEC_PICTURE_PPM);
	assert_int_equal(spec_picture_choose("x.exr", NULL, 0, &kind, NULL), SPEC_OK);
	assert_int_equal(kind.sample, SPEC_PICTURE_FLOAT);
	assert_int_equal(spec_picture_choose("x.hdr", NULL, 0, &kind, NULL), SPEC_OK);
	assert_int_equal(kind.sample, SPEC_PICTURE_FLOAT);
	check_choice("x", 0, SPEC_EUSAGE, "unable to write 'x': no suffix");
	check_choice("a.b/x", 0, SPEC_EUSAGE, "no suffix");
	check_choice("a/.png", 0, SPEC_EUSAGE, "no suffix");
	check_choice("x.", 0, SPEC_EUSAGE, "no suffix");
	check_choice("x.foo", 0, SPEC_EUNSUPPORTED,
		"unable to write 'x.foo': no picture format for '.foo'");
	check_choice("x.foo", 16, SPEC_EUNSUPPORTED, "no picture format for '.foo'");
	check_choice(
		"x.averyveryverylongsuffix", 0, SPEC_EUNSUPPORTED, "no picture format");
	check_choice("x.zfile", 0, SPEC_EUNSUPPORTED, "no picture format for '.zfile'");
	check_choice("x.term", 0, SPEC_EUNSUPPORTED, "no picture format for '.term'");
	check_choice("x.png", 32, SPEC_EUNSUPPORTED, ".png cannot hold 32 bits");
	check_choice("x.ppm", 32, SPEC_EUNSUPPORTED, ".ppm cannot hold 32 bits");
	check_choice("x.exr", 8, SPEC_EUNSUPPORTED, ".exr cannot hold 8 bits");
	check_choice("x.hdr", 8, SPEC_EUNSUPPORTED, ".hdr cannot hold 8 bits");
	check_choice("x.jpg", 16, SPEC_EUNSUPPORTED, ".jpg cannot hold 16 bits");
	check_choice("x.png", 12, SPEC_EUSAGE, "8, 16 or 32, not 12");
}

/* Every error of a format comes from here: too many rows, too few, a full disk. */
static void
check_rows(struct fixture *fixture, const char *name)
{
	struct spec_error error = {0};
	struct spec_picture_kind kind;
	struct spec_picture *picture;
	struct spec_output output;

	snprintf(fixture->path, sizeof fixture->path, "%s/%s", fixture->folder, name);
	assert_int_equal(spec_picture_choose(fixture->path, NULL, 0, &kind, NULL), SPEC_OK);
	assert_int_equal(spec_output_open(&output, fixture->path, NULL), SPEC_OK);
	assert_int_equal(
		spec_picture_open(&picture, &kind, &output, WIDTH, HEIGHT, NULL, NULL),
		SPEC_OK);
	assert_int_equal(
		spec_picture_write(picture, rows_of(fixture, &kind, 0), HEIGHT - 1, NULL),
		SPEC_OK);
	assert_int_equal(spec_picture_finish(picture, &error), SPEC_EUSAGE);
	assert_non_null(strstr(error.message, "22 of 23 rows"));
	assert_int_equal(spec_picture_write(picture, rows_of(fixture, &kind, 0), 1, NULL),
		SPEC_EUSAGE); /* an error stays */
	spec_picture_close(picture);
	assert_int_equal(
		spec_picture_open(&picture, &kind, &output, WIDTH, HEIGHT, NULL, NULL),
		SPEC_OK);
	assert_int_equal(
		spec_picture_write(picture, rows_of(fixture, &kind, 0), HEIGHT, NULL),
		SPEC_OK);
	assert_int_equal(spec_picture_write(picture, rows_of(fixture, &kind, 0), 1, &error),
		SPEC_EUSAGE);
	assert_non_null(strstr(error.message, "more than 23 rows"));
	spec_picture_close(picture);
	spec_output_abandon(&output);
}

static void
test_rows(void **state)
{
	static const char *const names[] = {"a.png", "a.ppm", "a.exr", "a.tif", "a.sgi"};

	for (size_t i = 0; i < COUNT(names); i++)
		check_rows(*state, names[i]);
	spec_picture_close(NULL);
}

static void
check_full(struct fixture *fixture, const char *name)
{
	struct spec_error error = {0};
	struct spec_picture_kind kind;
	struct spec_picture *picture;
	struct spec_output output;
	enum spec_status status;

	assert_int_equal(spec_picture_choose(name, NULL, 0, &kind, NULL), SPEC_OK);
	assert_int_equal(spec_output_open(&output, "/dev/full", NULL), SPEC_OK);
	status = spec_picture_open(&picture, &kind, &output, WIDTH, HEIGHT, NULL, &error);
	if (status == SPEC_OK)
		status = spec_picture_write(
			picture, rows_of(fixture, &kind, 0), HEIGHT, &error);
	if (status == SPEC_OK)
		status = spec_picture_finish(picture, &error);
	assert_int_equal(status, SPEC_EIO);
	assert_non_null(strstr(error.message, "/dev/full"));
	assert_non_null(strstr(error.message, "No space left on device"));
	spec_picture_close(picture);
	spec_output_abandon(&output);
}

static void
test_full(void **state)
{
	static const char *const names[] = {"a.png", "a.ppm", "a.exr", "a.jpg", "a.sgi"};

	for (size_t i = 0; i < COUNT(names); i++)
		check_full(*state, names[i]);
}

static void
test_sizes(void **state)
{
	static const size_t sizes[][2] = {{0, 1}, {1, 0}, {(size_t)1 << 31, 1},
		{(size_t)1 << 15, ((size_t)1 << 15) + 1}, {SIZE_MAX, SIZE_MAX}};
	struct spec_error error = {0};
	struct spec_picture_kind kind;
	struct spec_picture *picture;
	struct spec_output output;

	(void)state;
	assert_int_equal(spec_picture_choose("-", NULL, 0, &kind, NULL), SPEC_OK);
	assert_int_equal(spec_output_open(&output, "/dev/null", NULL), SPEC_OK);
	for (size_t i = 0; i < COUNT(sizes); i++) {
		assert_int_equal(spec_picture_open(&picture, &kind, &output, sizes[i][0],
					 sizes[i][1], NULL, &error),
			SPEC_ERANGE);
		assert_null(picture);
		assert_non_null(strstr(error.message, "/dev/null"));
	}
	/* libjpeg would end the program, gif would wrap around. */
	for (size_t i = 0; i < 2; i++) {
		assert_int_equal(
			spec_picture_choose(i ? "a.gif" : "a.jpg", NULL, 0, &kind, NULL),
			SPEC_OK);
		assert_int_equal(
			spec_picture_open(&picture, &kind, &output, 65536, 1, NULL, &error),
			SPEC_ERANGE);
		assert_non_null(
			strstr(error.message, "65536 x 1 pixels are too many for ."));
	}
	assert_int_equal(spec_picture_choose("-", NULL, 0, &kind, NULL), SPEC_OK);
	/* libpng's own limit, a million, does not stand in the way. */
	assert_int_equal(
		spec_picture_open(&picture, &kind, &output, 2000000, 1, NULL, &error),
		SPEC_OK);
	spec_picture_close(picture);
	spec_output_abandon(&output);
}

/* A copy of this program, elsewhere, finds no plugin beside itself. */
static void
test_no_plugin(void **state)
{
	struct fixture *fixture = *state;
	char command[512], line[1024] = "";
	FILE *stream;

	snprintf(command, sizeof command,
		"cp /proc/%d/exe %s/test && %s/test choose x.jpg 2>&1", (int)getpid(),
		fixture->folder, fixture->folder);
	stream = popen(command, "r");
	assert_non_null(stream);
	assert_non_null(fgets(line, sizeof line, stream));
	assert_int_equal(pclose(stream), SPEC_EUNSUPPORTED << 8);
	if (strncmp(line, "unable to write 'x.jpg': this format needs the picture plugin",
		    61))
		fail_msg("%s", line);
	snprintf(fixture->path, sizeof fixture->path, "%s/test", fixture->folder);
	unlink(fixture->path);
}

static int
choose(const char *path)
{
	struct spec_error error = {0};
	struct spec_picture_kind kind;
	enum spec_status status = spec_picture_choose(path, NULL, 0, &kind, &error);

	printf("%s\n", error.message);
	return (int)status;
}

#define TEST(name) cmocka_unit_test_setup_teardown(name, set_up, tear_down)

int
main(int argc, char **argv)
{
	const struct CMUnitTest tests[] = {TEST(test_png8), TEST(test_png16),
		TEST(test_png_spaces), TEST(test_ppm), TEST(test_ppm_large), TEST(test_exr),
		TEST(test_plugin), TEST(test_tiff), TEST(test_bmp_values),
		TEST(test_hdr_values), TEST(test_plugin_tidy), TEST(test_choose),
		TEST(test_rows), TEST(test_full), TEST(test_sizes), TEST(test_no_plugin)};

	if (argc == 3 && strcmp(argv[1], "choose") == 0)
		return choose(argv[2]);
	return cmocka_run_group_tests(tests, NULL, NULL);
}
