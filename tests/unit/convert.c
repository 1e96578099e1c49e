/* What specconvert and spec2rgb compute, against closed forms on images made for it. */
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include <math.h>
#include <unistd.h>

#include "base/output.h"
#include "colour/space.h"
#include "image/convert.h"
#include "image/writer.h"
#include "image/rgb.h"
#include "spectrum/product.h"

#include "check.h"

/* A float is rounded once where it is stored: half of 2^-23, relative. */
#define FLOAT_ROUNDING 0x1p-24
/* Sums in double of a few terms round far below that: this leaves room for both. */
#define CLOSE (1.01 * FLOAT_ROUNDING)

/* An image in a file, whose samples a function gives by channel and pixel from 0. */
typedef float sample_of(const struct spec_channel *channel, int x, int y);

struct fixture {
	char folder[64];
	char input[128], output[128];
	struct spec_settings settings;
	struct spec_reader *reader;     /* of the input */
	struct spec_convert convert;    /* the last one */
	struct spec_reader *result;     /* of the output */
	struct spec_decoder *decoder;   /* all lines of the output */
	const struct spec_image *image; /* the output's */
};

static int
set_up(void **state)
{
	struct fixture *fixture = calloc(1, sizeof *fixture);

	assert_non_null(fixture);
	strcpy(fixture->folder, "/tmp/convert.XXXXXX");
	assert_non_null(mkdtemp(fixture->folder));
	snprintf(fixture->input, sizeof fixture->input, "%s/in.exr", fixture->folder);
	snprintf(fixture->output, sizeof fixture->output, "%s/out.exr", fixture->folder);
	spec_settings_init(&fixture->settings);
	fixture->settings.threads = 2;
	*state = fixture;
	return 0;
}

static void
close_result(struct fixture *fixture)
{
	spec_decoder_close(fixture->decoder);
	spec_reader_close(fixture->result);
	spec_convert_free(&fixture->convert);
	fixture->decoder = NULL;
	fixture->result = NULL;
}

static int
tear_down(void **state)
{
	struct fixture *fixture = *state;

	close_result(fixture);
	spec_reader_close(fixture->reader);
	unlink(fixture->input);
	unlink(fixture->output);
	assert_int_equal(rmdir(fixture->folder), 0); /* nothing else was left in it */
	free(fixture);
	return 0;
}

/* Writes the image, whose channels are added already, and opens it as the input. */
static void
make_input(struct fixture *fixture, struct spec_image *image, sample_of *sample)
{
	struct spec_error error;
	struct spec_output output;
	struct spec_writer *writer;
	struct spec_packer *packer;
	float *const *plane;

	image->pixel_aspect_ratio = image->screen_window_width = 1;
	check(spec_image_index(image, "test", &error), &error);
	check(spec_output_open(&output, fixture->input, &error), &error);
	check(spec_writer_open(&writer, image, &output, -1, &error), &error);
	check(spec_packer_open(&packer, writer, &error), &error);
	for (int y = image->data.y0; y < image->data.y1; y++) {
		check(spec_packer_begin(packer, y, &plane, &error), &error);
		for (size_t i = 0; i < image->channels; i++)
			for (int x = 0; x < image->data.x1 - image->data.x0; x++)
				plane[i][x] =
					sample(&image->channel[i], x, y - image->data.y0);
		check(spec_packer_end(packer, y, &error), &error);
	}
	check(spec_writer_finish(writer, &error), &error);
	spec_packer_close(packer);
	spec_writer_close(writer);
	check(spec_output_commit(&output, &error), &error);
	spec_image_clear(image);
	spec_reader_close(fixture->reader);
	check(spec_reader_open(
		      &fixture->reader, fixture->input, &fixture->settings, &error),
		&error);
}

static void
make_image(struct fixture *fixture, const char *const *names, size_t count,
	struct spec_window window, sample_of *sample)
{
	struct spec_image image = {.data = window, .display = window};
	struct spec_error error;

	for (size_t i = 0; i < count; i++)
		check(spec_image_add_channel(&image, names[i],
			      strcmp(names[i], "id") == 0 ? SPEC_SAMPLE_UINT
							  : SPEC_SAMPLE_FLOAT,
			      &error),
			&error);
	make_input(fixture, &image, sample);
}

static enum spec_status
plan(struct fixture *fixture, const struct spec_convert_setup *setup,
	struct spec_error *error)
{
	struct spec_convert_setup whole = *setup;

	whole.downsample = setup->downsample ? setup->downsample : 1;
	close_result(fixture);
	return spec_convert_plan(&fixture->convert, spec_reader_image(fixture->reader),
		&whole, "in.exr", error);
}

/* Converts the input, which can be read once, to the output and decodes all of that. */
static void
convert(struct fixture *fixture, const struct spec_convert_setup *setup)
{
	unsigned long long overflows;
	struct spec_error error;

	check(plan(fixture, setup, &error), &error);
	fixture->settings.output = fixture->output;
	check(spec_convert_run(&fixture->convert, fixture->reader, &fixture->settings,
		      &overflows, &error),
		&error);
	check(spec_reader_open(
		      &fixture->result, fixture->output, &fixture->settings, &error),
		&error);
	fixture->image = spec_reader_image(fixture->result);
	check(spec_decoder_open(&fixture->decoder, fixture->result, NULL, &error), &error);
	check(spec_decoder_fetch(fixture->decoder, fixture->image->data.y0,
		      fixture->image->data.y1, &error),
		&error);
	check(spec_decoder_decode(fixture->decoder, &error), &error);
}

static const float *
channel_at(const struct fixture *fixture, const char *name, int x, int y)
{
	const struct spec_image *image = fixture->image;

	for (size_t i = 0; i < image->channels; i++) {
		if (strcmp(image->channel[i].name, name) == 0)
			return spec_decoder_row(fixture->decoder, image->data.y0 + y, i) +
			       x;
	}
	fail_msg("there is no channel '%s'", name);
	return NULL;
}

static void
assert_sample(const struct fixture *fixture, const char *name, int x, int y, double wanted)
{
	float found = *channel_at(fixture, name, x, y);

	if (!(fabs(found - wanted) <= CLOSE * fabs(wanted)))
		fail_msg("'%s' at %d,%d: %.9g instead of %.9g", name, x, y, found, wanted);
}

static struct spec_curve
curve_of(const double (*point)[2], size_t count)
{
	struct spec_curve curve;

	assert_int_equal(spec_curve_new(count, 1, &curve, NULL), SPEC_OK);
	for (size_t i = 0; i < count; i++) {
		curve.wavelength_nm[i] = point[i][0];
		curve.value[i] = point[i][1];
	}
	return curve;
}

#define CURVE(...)                                                                         \
	curve_of((const double[][2]){__VA_ARGS__},                                         \
		COUNT(((const double[][2]){__VA_ARGS__})))

/* Of a setup: what is done to its bands. */
#define OPERATIONS(...)                                                                    \
	.operation = (struct spec_operation[]){__VA_ARGS__},                               \
	.operations = COUNT(((struct spec_operation[]){__VA_ARGS__}))
#define SCALE(factor)                                                                      \
	{                                                                                  \
		.kind = SPEC_OPERATION_SCALE, .number = (factor)                           \
	}
#define WITH(what, by)                                                                     \
	{                                                                                  \
		.kind = SPEC_OPERATION_##what, .curve = (by)                               \
	}

/*
 * Linear in the wavelength, so that interpolation is exact: 2^-10 per nm, and all the
 * numbers are multiples of 2^-10 that a float holds.
 */
static float
linear(const struct spec_channel *channel, int x, int y)
{
	if (channel->role == SPEC_ROLE_OTHER)
		return (float)(100 + x + 16 * y);
	return (float)(channel->wavelength_nm / 1024 + x + 4 * y + 32 * channel->stokes);
}

static const char *const plain[] = {
	"A", "B", "G", "R", "S0.400nm", "S0.500nm", "S0.600nm", "S0.700nm", "Z"};

static const struct spec_window small = {0, 0, 5, 3};

static void
test_grid(void **state)
{
	struct fixture *fixture = *state;
	struct spec_grid grid;
	struct spec_convert_setup setup = {.grid = &grid};
	char name[64];

	make_image(fixture, plain, COUNT(plain), small, linear);
	assert_int_equal(spec_grid_parse("400:700:12.5", &grid, NULL), SPEC_OK);
	convert(fixture, &setup);
	assert_int_equal(fixture->image->bands, 25);
	assert_int_equal(fixture->image->channels, 30); /* the preview still fits */
	for (size_t i = 0; i < 25; i++) {
		double nm = 400 + 12.5 * (double)i;

		assert_true(fixture->image->wavelength_nm[i] == nm);
		snprintf(name, sizeof name, "S0.%d,%d00000nm", (int)nm,
			nm > (int)nm ? 5 : 0);
		for (int y = 0; y < 3; y++)
			for (int x = 0; x < 5; x++)
				assert_true(*channel_at(fixture, name, x, y) ==
					    (float)(nm / 1024 + x + 4 * y));
	}
	assert_true(*channel_at(fixture, "Z", 4, 2) == 136);
	assert_true(*channel_at(fixture, "R", 1, 1) == 117);
	spec_grid_free(&grid);
}

/* The old bands themselves pass through bit for bit, NaN and all. */
static float
peculiar(const struct spec_channel *channel, int x, int y)
{
	static const uint32_t bits[] = {0x7f812345, 0x7f800000, 0x80000000, 1, 0x3f800001};
	float value;

	if (channel->role == SPEC_ROLE_OTHER)
		return 7;
	memcpy(&value, &bits[(x + y) % 5], sizeof value);
	return value;
}

static void
test_identity(void **state)
{
	struct fixture *fixture = *state;
	struct spec_grid grid;
	struct spec_convert_setup setup = {0}, same = {.grid = &grid},
				  band = {.bands = &grid};
	const struct spec_convert_setup *const setups[3] = {&setup, &same, &band};

	assert_int_equal(spec_grid_parse("400:700:100", &grid, NULL), SPEC_OK);
	for (size_t i = 0; i < 3; i++) {
		make_image(fixture, plain, COUNT(plain), small, peculiar);
		convert(fixture, setups[i]);
		assert_int_equal(fixture->image->channels, COUNT(plain));
		for (int x = 0; x < 5; x++) {
			float wanted = peculiar(
				&(struct spec_channel){.role = SPEC_ROLE_EMISSIVE}, x, 2);

			assert_memory_equal(channel_at(fixture, "S0.600,000000nm", x, 2),
				&wanted, sizeof wanted);
		}
	}
	spec_grid_free(&grid);
}

static void
test_bands(void **state)
{
	struct fixture *fixture = *state;
	struct spec_grid grid = {.wavelength_nm = (double[]){500, 699.9995}, .count = 2};
	struct spec_convert_setup setup = {.bands = &grid};
	struct spec_error error;

	make_image(fixture, plain, COUNT(plain), small, linear);
	convert(fixture, &setup);
	assert_int_equal(fixture->image->bands, 2);
	assert_true(*channel_at(fixture, "S0.500,000000nm", 1, 0) == 500.F / 1024 + 1);
	assert_true(*channel_at(fixture, "S0.700,000000nm", 1, 0) == 700.F / 1024 + 1);
	grid.wavelength_nm[0] = 510;
	assert_int_equal(plan(fixture, &setup, &error), SPEC_ERANGE);
	assert_non_null(strstr(error.message, "in.exr: has no band at 510 nm"));
	assert_non_null(strstr(error.message, "500 nm"));
}

static void
test_extrapolate(void **state)
{
	struct fixture *fixture = *state;
	struct spec_grid grid;
	struct spec_convert_setup setup = {.grid = &grid};
	struct spec_error error;

	assert_int_equal(spec_grid_parse("350:750:50", &grid, NULL), SPEC_OK);
	make_image(fixture, plain, COUNT(plain), small, linear);
	assert_int_equal(plan(fixture, &setup, &error), SPEC_ERANGE);
	assert_non_null(strstr(error.message, "400..700 nm"));
	setup.extrapolate = SPEC_EXTRAPOLATE_ZERO;
	convert(fixture, &setup);
	assert_true(*channel_at(fixture, "S0.350,000000nm", 2, 1) == 0);
	assert_true(*channel_at(fixture, "S0.750,000000nm", 2, 1) == 0);
	assert_true(*channel_at(fixture, "S0.400,000000nm", 2, 1) == 400.F / 1024 + 6);
	make_image(fixture, plain, COUNT(plain), small, linear);
	setup.extrapolate = SPEC_EXTRAPOLATE_CONSTANT;
	convert(fixture, &setup);
	assert_true(*channel_at(fixture, "S0.350,000000nm", 2, 1) == 400.F / 1024 + 6);
	assert_true(*channel_at(fixture, "S0.750,000000nm", 2, 1) == 700.F / 1024 + 6);
	/* Zero outside is zero, whatever lies at the end. */
	make_image(fixture, plain, COUNT(plain), small, peculiar);
	setup.extrapolate = SPEC_EXTRAPOLATE_ZERO;
	convert(fixture, &setup);
	for (int x = 0; x < 5; x++)
		assert_true(*channel_at(fixture, "S0.350,000000nm", x, 0) == 0);
	spec_grid_free(&grid);
}

/* Curves and a number multiply; the preview, which would mislead, goes. */
static void
test_multiply(void **state)
{
	struct fixture *fixture = *state;
	struct spec_curve factor[] = {CURVE({300, 0}, {800, 5}), CURVE({400, 2}, {700, 2})};
	struct spec_convert_setup setup = {OPERATIONS(
		WITH(MULTIPLY, factor[0]), WITH(MULTIPLY, factor[1]), SCALE(-0.5))};
	struct spec_operation shorter[2] = {WITH(MULTIPLY, factor[0])};
	struct spec_error error;

	make_image(fixture, plain, COUNT(plain), small, linear);
	convert(fixture, &setup);
	assert_int_equal(fixture->image->channels, COUNT(plain) - 3);
	for (int nm = 400; nm <= 700; nm += 100) {
		char name[64];

		snprintf(name, sizeof name, "S0.%d,000000nm", nm);
		for (int x = 0; x < 5; x++)
			assert_sample(fixture, name, x, 1,
				(nm / 1024.0 + x + 4) * ((nm - 300) * 0.01) * 2 * -0.5);
	}
	assert_true(*channel_at(fixture, "Z", 4, 2) == 136);
	spec_curve_free(&factor[1]);
	factor[1] = CURVE({450, 2}, {700, 2});
	shorter[1] = (struct spec_operation)WITH(MULTIPLY, factor[1]);
	setup.operation = shorter;
	setup.operations = 2;
	assert_int_equal(plan(fixture, &setup, &error), SPEC_ERANGE);
	assert_non_null(strstr(error.message, "450..700 nm"));
	spec_curve_free(&factor[0]);
	spec_curve_free(&factor[1]);
}

/* With a grid as well: the factor is that of the new wavelength. */
static void
test_multiply_grid(void **state)
{
	struct fixture *fixture = *state;
	struct spec_curve factor = CURVE({400, 1}, {450, 8}, {500, 1}, {700, 1});
	struct spec_grid grid = {.wavelength_nm = (double[]){425, 450}, .count = 2};
	struct spec_convert_setup setup = {
		OPERATIONS(WITH(MULTIPLY, factor)), .grid = &grid};

	make_image(fixture, plain, COUNT(plain), small, linear);
	convert(fixture, &setup);
	assert_sample(fixture, "S0.425,000000nm", 3, 2, (425 / 1024.0 + 11) * 4.5);
	assert_sample(fixture, "S0.450,000000nm", 3, 2, (450 / 1024.0 + 11) * 8);
	spec_curve_free(&factor);
}

static void
test_stokes(void **state)
{
	static const char *const names[] = {"S0.400nm", "S0.600nm", "S1.400nm", "S1.600nm",
		"S2.400nm", "S2.600nm", "S3.400nm", "S3.600nm"};
	struct fixture *fixture = *state;
	struct spec_grid grid = {.wavelength_nm = (double[]){450, 500, 550}, .count = 3};
	struct spec_convert_setup setup = {.grid = &grid, OPERATIONS(SCALE(2))};
	char name[64];

	make_image(fixture, names, COUNT(names), small, linear);
	convert(fixture, &setup);
	assert_int_equal(fixture->image->stokes, 4);
	assert_int_equal(fixture->image->channels, 12);
	for (int stokes = 0; stokes < 4; stokes++) {
		snprintf(name, sizeof name, "S%d.550,000000nm", stokes);
		assert_true(*channel_at(fixture, name, 1, 1) ==
			    2 * (float)(550 / 1024.0 + 5 + 32 * stokes));
	}
}

/* Reflectance under light: T * power becomes S0. */
static const char *const reflective[] = {"T.400nm", "T.500nm", "T.600nm"};

static void
test_illuminate(void **state)
{
	struct fixture *fixture = *state;
	struct spec_curve light = CURVE({400, 1}, {500, 10}, {600, 100});
	struct spec_grid grid = {.wavelength_nm = (double[]){450, 600}, .count = 2};
	struct spec_convert_setup setup = {OPERATIONS(WITH(ILLUMINATE, light))};
	struct spec_error error;
	char *quantity;

	make_image(fixture, reflective, COUNT(reflective), small, linear);
	convert(fixture, &setup);
	assert_int_equal(fixture->image->role, SPEC_ROLE_EMISSIVE);
	assert_int_equal(fixture->image->bands, 3);
	assert_sample(fixture, "S0.400,000000nm", 2, 1, 400 / 1024.0 + 6);
	assert_sample(fixture, "S0.500,000000nm", 2, 1, (500 / 1024.0 + 6) * 10);
	assert_sample(fixture, "S0.600,000000nm", 2, 1, (600 / 1024.0 + 6) * 100);
	quantity = spec_image_quantity(fixture->image, &error);
	assert_string_equal(quantity, "radiance per nm");
	free(quantity);
	make_image(fixture, reflective, COUNT(reflective), small, linear);
	setup.grid = &grid;
	convert(fixture, &setup);
	assert_int_equal(fixture->image->bands, 2);
	assert_sample(fixture, "S0.450,000000nm", 2, 1, (450 / 1024.0 + 6) * 5.5);
	/* Light is not lit. */
	make_image(fixture, plain, COUNT(plain), small, linear);
	assert_int_equal(plan(fixture, &setup, &error), SPEC_EUSAGE);
	spec_curve_free(&light);
}

/* Reradiation: S0(out) = sum over in of T(in, out) * power(in). */
static float
fluorescent(const struct spec_channel *channel, int x, int y)
{
	if (channel->role == SPEC_ROLE_BISPECTRAL)
		return (float)(channel->wavelength_nm / 1024 + channel->reradiated_nm / 64 +
			       x * y);
	return (float)(channel->wavelength_nm / 1024 + x + 4 * y);
}

static void
test_illuminate_bispectral(void **state)
{
	static const char *const names[] = {"T.400nm", "T.500nm", "T.600nm",
		"T.400nm.500nm", "T.400nm.600nm", "T.500nm.600nm"};
	struct fixture *fixture = *state;
	struct spec_curve light = CURVE({400, 3}, {500, 5}, {600, 7}),
			  filter = CURVE({400, 1}, {600, 0.5});
	struct spec_grid grid = {.wavelength_nm = (double[]){500}, .count = 1};
	struct spec_convert_setup setup = {OPERATIONS(WITH(ILLUMINATE, light))},
				  regrid = {.grid = &grid}, scaled = {OPERATIONS(SCALE(2))},
				  filtered = {OPERATIONS(
					  WITH(ILLUMINATE, light), WITH(MULTIPLY, filter))};
	struct spec_error error;

	make_image(fixture, names, COUNT(names), small, fluorescent);
	convert(fixture, &setup);
	assert_int_equal(fixture->image->channels, 3);
	assert_sample(fixture, "S0.400,000000nm", 2, 1, 3 * (400 / 1024.0 + 6));
	assert_sample(fixture, "S0.500,000000nm", 2, 1,
		5 * (500 / 1024.0 + 6) + 3 * (400 / 1024.0 + 500 / 64.0 + 2));
	assert_sample(fixture, "S0.600,000000nm", 2, 1,
		7 * (600 / 1024.0 + 6) + 3 * (400 / 1024.0 + 600 / 64.0 + 2) +
			5 * (500 / 1024.0 + 600 / 64.0 + 2));
	/* A filter is passed by the light that leaves. */
	make_image(fixture, names, COUNT(names), small, fluorescent);
	convert(fixture, &filtered);
	assert_sample(fixture, "S0.500,000000nm", 2, 1,
		0.75 * (5 * (500 / 1024.0 + 6) + 3 * (400 / 1024.0 + 500 / 64.0 + 2)));
	/* The matrix itself keeps its shape, and its grid. */
	make_image(fixture, names, COUNT(names), small, fluorescent);
	convert(fixture, &scaled);
	assert_int_equal(fixture->image->bispectral, 3);
	assert_sample(fixture, "T.400,000000nm.600,000000nm", 2, 1,
		2 * (400 / 1024.0 + 600 / 64.0 + 2));
	assert_int_equal(plan(fixture, &regrid, &error), SPEC_EUNSUPPORTED);
	spec_curve_free(&light);
	spec_curve_free(&filter);
}

/* Windows */

static void
test_crop(void **state)
{
	static const struct spec_window outside[] = {{0, 0, 41, 5}, {0, 0, 5, 51},
		{-1, 0, 5, 5}, {0, -1, 5, 5}, {5, 5, 5, 9}, {5, 5, 9, 5}, {9, 5, 5, 9},
		{40, 50, 41, 51}};
	struct fixture *fixture = *state;
	struct spec_convert_setup setup = {.has_crop = 1, .crop = {3, 7, 40, 41}};
	struct spec_window window = {-10, -20, 30, 30};
	struct spec_error error;

	make_image(fixture, plain, COUNT(plain), window, linear);
	convert(fixture, &setup);
	assert_int_equal(fixture->image->data.x0, -7);
	assert_int_equal(fixture->image->data.y0, -13);
	assert_int_equal(fixture->image->data.x1, 30);
	assert_int_equal(fixture->image->data.y1, 21);
	assert_memory_equal(&fixture->image->display, &window, sizeof window);
	for (int y = 0; y < 34; y++)
		for (int x = 0; x < 37; x++)
			assert_true(*channel_at(fixture, "S0.500,000000nm", x, y) ==
				    (float)(500 / 1024.0 + (x + 3) + 4 * (y + 7)));
	for (size_t i = 0; i < COUNT(outside); i++) {
		setup.crop = outside[i];
		assert_int_equal(plan(fixture, &setup, &error), SPEC_ERANGE);
		assert_non_null(strstr(error.message, "0,0,40,50"));
	}
}

/* The last line and column alone: the last of all chunks. */
static void
test_crop_corner(void **state)
{
	struct fixture *fixture = *state;
	struct spec_convert_setup setup = {.has_crop = 1, .crop = {39, 49, 40, 50}};

	make_image(fixture, plain, COUNT(plain), (struct spec_window){-10, -20, 30, 30},
		linear);
	convert(fixture, &setup);
	assert_int_equal(fixture->image->data.x0, 29);
	assert_int_equal(fixture->image->data.y0, 29);
	assert_true(*channel_at(fixture, "S0.500,000000nm", 0, 0) ==
		    (float)(500 / 1024.0 + 39 + 4 * 49));
}

/* Downsampling */

static const char *const counted[] = {"A", "S0.400nm", "S0.500nm", "id"};

/*
 * Of every 3 x 3 pixels of id five are the block's number and the others alone; in every
 * second row of blocks three numbers have three pixels each, and the first of them counts.
 */
static float
counting(const struct spec_channel *channel, int x, int y)
{
	uint32_t number = (uint32_t)(1000 * (y / 3) + x / 3);
	float value;

	if (strcmp(channel->name, "id") != 0)
		return linear(channel, x, y);
	if (y / 3 % 2 != 0)
		number += 100000U * (uint32_t)(2 - x % 3);
	else if ((x % 3 + y % 3) % 2 != 0)
		number = 0xffffffff - (uint32_t)(x + 3 * y);
	memcpy(&value, &number, sizeof value);
	return value;
}

static void
test_downsample(void **state)
{
	struct fixture *fixture = *state;
	struct spec_convert_setup setup = {.downsample = 3};
	struct spec_window window = {-6, 9, 60, 69};

	make_image(fixture, counted, COUNT(counted), window, counting);
	convert(fixture, &setup);
	assert_int_equal(fixture->image->data.x0, -2);
	assert_int_equal(fixture->image->data.y0, 3);
	assert_int_equal(fixture->image->data.x1, 20);
	assert_int_equal(fixture->image->data.y1, 23);
	assert_memory_equal(&fixture->image->display, &fixture->image->data, sizeof window);
	for (int y = 0; y < 20; y++) {
		for (int x = 0; x < 22; x++) {
			uint32_t number;

			/* The mean of what is linear is its value in the middle. */
			assert_sample(fixture, "S0.500,000000nm", x, y,
				500 / 1024.0 + (3 * x + 1) + 4 * (3 * y + 1));
			assert_sample(
				fixture, "A", x, y, 100 + (3 * x + 1) + 16 * (3 * y + 1));
			memcpy(&number, channel_at(fixture, "id", x, y), sizeof number);
			assert_int_equal(number, 1000 * y + x + (y % 2 ? 200000 : 0));
		}
	}
}

/* A crop first; a window that does not fit is refused; the display window grows to fit. */
static void
test_downsample_windows(void **state)
{
	struct fixture *fixture = *state;
	struct spec_convert_setup setup = {.downsample = 4};
	struct spec_window window = {-6, 9, 27, 42};
	struct spec_error error;

	make_image(fixture, counted, COUNT(counted), window, counting);
	assert_int_equal(plan(fixture, &setup, &error), SPEC_ERANGE);
	assert_non_null(strstr(error.message, "4 x 4 pixels"));
	setup.has_crop = 1;
	setup.crop = (struct spec_window){2, 3, 30, 31};
	convert(fixture, &setup);
	assert_int_equal(fixture->image->data.x0, -1);
	assert_int_equal(fixture->image->data.y0, 3);
	assert_int_equal(fixture->image->data.x1, 6);
	assert_int_equal(fixture->image->data.y1, 10);
	assert_int_equal(fixture->image->display.x0, -2);
	assert_int_equal(fixture->image->display.y0, 2);
	assert_int_equal(fixture->image->display.x1, 7);
	assert_int_equal(fixture->image->display.y1, 11);
	for (int y = 0; y < 7; y++)
		for (int x = 0; x < 7; x++)
			assert_sample(fixture, "S0.400,000000nm", x, y,
				400 / 1024.0 + (4 * x + 3.5) + 4 * (4 * y + 4.5));
}

/* All at once: the order is crop, mean, grid, curves, which commute but for rounding. */
static void
test_everything(void **state)
{
	struct fixture *fixture = *state;
	struct spec_curve factor = CURVE({400, 1}, {600, 3}),
			  light = CURVE({400, 2}, {600, 4});
	struct spec_grid grid = {.wavelength_nm = (double[]){450, 525}, .count = 2};
	struct spec_convert_setup setup = {.has_crop = 1,
		.crop = {1, 2, 7, 10},
		.downsample = 2,
		.grid = &grid,
		OPERATIONS(WITH(MULTIPLY, factor), WITH(ILLUMINATE, light), SCALE(8))};

	make_image(fixture, reflective, COUNT(reflective),
		(struct spec_window){-1, 0, 9, 12}, linear);
	convert(fixture, &setup);
	for (int y = 0; y < 4; y++)
		for (int x = 0; x < 3; x++)
			assert_sample(fixture, "S0.525,000000nm", x, y,
				(525 / 1024.0 + (2 * x + 1.5) + 4 * (2 * y + 2.5)) * 2.25 *
					3.25 * 8);
	spec_curve_free(&factor);
	spec_curve_free(&light);
}

/* The same file whatever the number of threads. */
static void
test_threads(void **state)
{
	static const int threads[] = {2, 3, 8};
	struct fixture *fixture = *state;
	struct spec_grid grid;
	struct spec_convert_setup setup = {.grid = &grid, OPERATIONS(SCALE(1.25))};
	size_t room = 4 << 20, size[2];
	char *bytes[2] = {malloc(room), malloc(room)};

	assert_true(bytes[0] && bytes[1]);
	assert_int_equal(spec_grid_parse("400:700:4", &grid, NULL), SPEC_OK);
	for (size_t i = 0; i <= COUNT(threads); i++) {
		FILE *stream;

		make_image(fixture, plain, COUNT(plain),
			(struct spec_window){0, -7, 64, 593}, linear);
		fixture->settings.threads = i == 0 ? 1 : threads[i - 1];
		convert(fixture, &setup);
		stream = fopen(fixture->output, "rb");
		assert_non_null(stream);
		size[i > 0] = fread(bytes[i > 0], 1, room, stream);
		assert_true(size[i > 0] < room);
		fclose(stream);
		if (i == 0)
			continue;
		assert_int_equal(size[1], size[0]);
		assert_memory_equal(bytes[1], bytes[0], size[0]);
	}
	free(bytes[0]);
	free(bytes[1]);
	spec_grid_free(&grid);
}

static void
test_half(void **state)
{
	struct fixture *fixture = *state;
	struct spec_convert_setup setup = {.half = 1};

	make_image(fixture, plain, COUNT(plain), small, linear);
	convert(fixture, &setup);
	for (size_t i = 0; i < fixture->image->channels; i++)
		assert_int_equal(fixture->image->channel[i].sample,
			fixture->image->channel[i].role == SPEC_ROLE_EMISSIVE
				? SPEC_SAMPLE_HALF
				: SPEC_SAMPLE_FLOAT);
	/* 11 bits of mantissa: half of 2^-10, relative. */
	assert_true(fabs(*channel_at(fixture, "S0.500,000000nm", 3, 2) -
			    (500 / 1024.0 + 11)) <= 0x1p-11 * 12);
}

/* Bins stay where bands stay, and go where a grid gives points. */
static void
test_bins(void **state)
{
	struct fixture *fixture = *state;
	struct spec_grid points = {.wavelength_nm = (double[]){450, 500}, .count = 2},
			 one = {.wavelength_nm = (double[]){500}, .count = 1};
	struct spec_convert_setup grid = {.grid = &points}, band = {.bands = &one},
				  scale = {OPERATIONS(SCALE(2))};
	const struct spec_convert_setup *const setups[3] = {&scale, &grid, &band};
	static const double edges[] = {350, 460, 550, 650};

	for (size_t i = 0; i < 3; i++) {
		struct spec_image image = {.data = small, .display = small};
		struct spec_error error;

		check(spec_image_add_bands(&image, SPEC_ROLE_EMISSIVE, 1,
			      (double[]){400, 500, 600}, 3, SPEC_SAMPLE_FLOAT, &error),
			&error);
		check(spec_image_set_bins(&image, edges, 3, &error), &error);
		make_input(fixture, &image, linear);
		convert(fixture, setups[i]);
		if (i == 1) {
			assert_null(fixture->image->edges_nm);
			continue;
		}
		assert_non_null(fixture->image->edges_nm);
		assert_true(fixture->image->edges_nm[0] == (i == 0 ? 350 : 460));
		assert_true(fixture->image->edges_nm[1] == (i == 0 ? 460 : 550));
	}
}

static void
test_not_spectral(void **state)
{
	static const char *const names[] = {"R", "G", "B"};
	struct fixture *fixture = *state;
	struct spec_convert_setup crop = {.has_crop = 1, .crop = {1, 1, 3, 2}},
				  scale = {OPERATIONS(SCALE(2))};
	struct spec_error error;

	make_image(fixture, names, COUNT(names), small, linear);
	assert_int_equal(plan(fixture, &scale, &error), SPEC_EFORMAT);
	assert_non_null(strstr(error.message, "no spectral channel"));
	convert(fixture, &crop);
	assert_int_equal(fixture->image->channels, 3);
	assert_true(*channel_at(fixture, "G", 1, 0) == 118);
}

/* From bands to RGB. An observer and a space that are simple: X, Y, Z are boxes. */

static struct spec_curve
box_observer(void)
{
	struct spec_curve curve;

	assert_int_equal(spec_curve_new(301, 3, &curve, NULL), SPEC_OK);
	for (size_t i = 0; i < 301; i++) {
		curve.wavelength_nm[i] = 400 + (double)i;
		curve.value[i] = i >= 200;                   /* x: 600..700 */
		curve.value[301 + i] = i >= 100 && i <= 200; /* y: 500..600 */
		curve.value[602 + i] = i <= 100;             /* z: 400..500 */
	}
	return curve;
}

static struct spec_image
bands_of(enum spec_role role, double low_nm, double step_nm, size_t count)
{
	struct spec_image image = {.data = small, .display = small};
	double *wavelength_nm = malloc(count * sizeof *wavelength_nm);
	struct spec_error error;

	assert_non_null(wavelength_nm);
	for (size_t i = 0; i < count; i++)
		wavelength_nm[i] = low_nm + step_nm * (double)i;
	check(spec_image_add_bands(
		      &image, role, 1, wavelength_nm, count, SPEC_SAMPLE_FLOAT, &error),
		&error);
	check(spec_image_index(&image, "test", &error), &error);
	free(wavelength_nm);
	return image;
}

/* The sums over all weights: the RGB of an image that is 1 everywhere. */
static void
sums_of(const struct spec_rgb *rgb, double sum[3])
{
	for (size_t j = 0; j < 3; j++) {
		sum[j] = 0;
		for (size_t i = 0; i < rgb->terms; i++)
			sum[j] += rgb->weight[j * rgb->terms + i];
	}
}

/*
 * A constant spectrum of 1 has the observer's own white, however the bands lie: each
 * interpolant reproduces constants. 1e-12: some hundred roundings of 2^-53.
 */
static void
test_rgb_constant(void **state)
{
	static const struct {
		double low_nm, step_nm;
		size_t count;
	} grids[] = {
		{400, 1, 301}, {400, 5, 61}, {400, 10, 31}, {380, 20, 18}, {400, 7.5, 41}};
	struct spec_curve observer = box_observer();
	struct spec_rgb_setup setup = {.observer = &observer, .exposure = 1};
	struct spec_error error;
	double m[9], white[3], xyz[3] = {0, 1, 0};

	(void)state;
	setup.space = spec_space_find("srgb", &error);
	check(spec_space_from_xyz(setup.space, m, &error), &error);
	/* X, Y, Z relative to Y: 101 samples in every box. */
	xyz[0] = xyz[2] = 1;
	spec_matrix_apply(m, xyz, white);
	for (size_t i = 0; i < COUNT(grids); i++) {
		for (int reflective_too = 0; reflective_too < 2; reflective_too++) {
			struct spec_image image = bands_of(
				reflective_too ? SPEC_ROLE_REFLECTIVE : SPEC_ROLE_EMISSIVE,
				grids[i].low_nm, grids[i].step_nm, grids[i].count);
			struct spec_rgb rgb;
			double sum[3];

			check(spec_rgb_plan(&rgb, &image, &setup, &error), &error);
			assert_int_equal(rgb.terms, grids[i].count);
			assert_true(fabs(rgb.outside) < 1e-12);
			sums_of(&rgb, sum);
			for (size_t j = 0; j < 3; j++) /* exposure 1 doubles */
				assert_true(fabs(sum[j] - 2 * white[j]) < 1e-12 * 10);
			spec_rgb_free(&rgb);
			spec_image_clear(&image);
		}
	}
	spec_curve_free(&observer);
}

/* What the bands do not reach is told: half of y's box. */
static void
test_rgb_outside(void **state)
{
	struct spec_curve observer = box_observer();
	struct spec_rgb_setup setup = {.observer = &observer};
	struct spec_image image = bands_of(SPEC_ROLE_EMISSIVE, 400, 10, 16);
	struct spec_error error;
	struct spec_rgb rgb;

	(void)state;
	setup.space = spec_space_find("srgb", &error);
	check(spec_rgb_plan(&rgb, &image, &setup, &error), &error);
	assert_true(fabs(rgb.outside - 50 / 101.0) < 0.01); /* one sample of y's 101 */
	spec_rgb_free(&rgb);
	spec_image_clear(&image);
	image = (struct spec_image){0};
	assert_int_equal(spec_rgb_plan(&rgb, &image, &setup, &error), SPEC_EFORMAT);
	spec_curve_free(&observer);
}

/* The perfect reflector has Y = 1 under any light; adapted, it is the space's white. */
static void
test_rgb_reflector(void **state)
{
	struct spec_curve observer = box_observer(), light = CURVE({380, 1}, {780, 9});
	struct spec_rgb_setup setup = {.observer = &observer, .illuminant = &light};
	struct spec_image image = bands_of(SPEC_ROLE_REFLECTIVE, 400, 10, 31);
	struct spec_error error;
	struct spec_rgb rgb;
	double back[9], sum[3], xyz[3];

	(void)state;
	setup.space = spec_space_find("srgb", &error);
	check(spec_space_to_xyz(setup.space, back, &error), &error);
	check(spec_rgb_plan(&rgb, &image, &setup, &error), &error);
	sums_of(&rgb, sum);
	spec_matrix_apply(back, sum, xyz);
	assert_true(fabs(xyz[1] - 1) < 1e-12 * 10);
	/* Light that grows with the wavelength: more X than Y than Z. Mean power in each box. */
	assert_true(fabs(xyz[0] / xyz[1] - 6.4 / 4.4) < 1e-12 * 10);
	assert_true(fabs(xyz[2] / xyz[1] - 2.4 / 4.4) < 1e-12 * 10);
	spec_rgb_free(&rgb);
	check(spec_adaptation_find("bradford", &setup.adaptation, &error), &error);
	check(spec_rgb_plan(&rgb, &image, &setup, &error), &error);
	sums_of(&rgb, sum);
	/* sRGB's matrices are those of its white to the digits of their definition. */
	for (size_t j = 0; j < 3; j++)
		assert_true(fabs(sum[j] - 1) < 1e-4);
	spec_rgb_free(&rgb);
	spec_image_clear(&image);
	spec_curve_free(&observer);
	spec_curve_free(&light);
}

/* A row is the weighted sum of its planes: 257 pixels are one run and one more. */
static void
test_rgb_row(void **state)
{
	enum { WIDTH = 257, TERMS = 7 };
	static float plane[TERMS][WIDTH], red[WIDTH], green[WIDTH], blue[WIDTH];
	double weight[3 * TERMS];
	size_t channel[TERMS];
	const float *row[TERMS];
	struct spec_rgb rgb = {.terms = TERMS, .channel = channel, .weight = weight};

	(void)state;
	for (size_t t = 0; t < TERMS; t++) {
		row[t] = plane[t];
		for (size_t x = 0; x < WIDTH; x++)
			plane[t][x] = (float)(t + 1) + (float)x;
		for (size_t j = 0; j < 3; j++)
			weight[j * TERMS + t] = (double)(j + 1) * 0.25 * (t % 2 ? -1 : 1);
	}
	spec_rgb_row(&rgb, row, WIDTH, red, green, blue);
	for (size_t x = 0; x < WIDTH; x++) {
		double sum = 0;

		for (size_t t = 0; t < TERMS; t++)
			sum += (t % 2 ? -1. : 1.) * ((double)(t + 1) + (double)x);
		/* All are multiples of 1/4 below 2^20: exact. */
		assert_true(red[x] == (float)(0.25 * sum));
		assert_true(green[x] == (float)(0.5 * sum));
		assert_true(blue[x] == (float)(0.75 * sum));
	}
}

/* Curves */

/* On the wavelengths of both the product is exact; between them it is not asked for. */
static void
test_product(void **state)
{
	struct spec_curve a = CURVE({400, 1}, {500, 3}, {600, 2}),
			  b = CURVE({450, 2}, {500, 4}, {550, 8}, {700, 2}), product;
	static const double wanted[][2] = {
		{450, 2 * 2}, {500, 3 * 4}, {550, 2.5 * 8}, {600, 2 * 6}};
	struct spec_curve far = CURVE({800, 1}, {900, 1}),
			  touching = CURVE({600, 5}, {700, 1});
	struct spec_error error;

	(void)state;
	assert_int_equal(spec_curve_set_text(&a.title, "a", NULL), SPEC_OK);
	check(spec_curve_multiply(&a, &b, &product, &error), &error);
	assert_int_equal(product.count, COUNT(wanted));
	assert_string_equal(product.title, "a");
	for (size_t i = 0; i < COUNT(wanted); i++) {
		assert_true(product.wavelength_nm[i] == wanted[i][0]);
		/* 550 nm is half-way of a, 600 nm a third of b: a few roundings. */
		assert_true(fabs(product.value[i] - wanted[i][1]) <=
			    8 * 0x1p-53 * wanted[i][1]);
	}
	spec_curve_free(&product);
	check(spec_curve_multiply(&a, &touching, &product, &error), &error);
	assert_int_equal(product.count, 1);
	assert_true(product.wavelength_nm[0] == 600);
	assert_true(product.value[0] == 10);
	spec_curve_free(&product);
	assert_int_equal(spec_curve_multiply(&a, &far, &product, &error), SPEC_ERANGE);
	assert_non_null(strstr(error.message, "do not meet"));
	spec_curve_free(&a);
	spec_curve_free(&b);
	spec_curve_free(&far);
	spec_curve_free(&touching);
}

/* Ranges that overlap where neither has a sample still share them. */
static void
test_product_between(void **state)
{
	struct spec_curve wide = CURVE({400, 1}, {800, 5}),
			  narrow = CURVE({500, 2}, {600, 2}), product;
	struct spec_error error;

	(void)state;
	check(spec_curve_multiply(&wide, &narrow, &product, &error), &error);
	assert_int_equal(product.count, 2);
	assert_true(product.wavelength_nm[0] == 500);
	assert_true(product.value[0] == 4);
	assert_true(product.value[1] == 6);
	spec_curve_free(&product);
	spec_curve_free(&wide);
	spec_curve_free(&narrow);
}

static void
test_product_columns(void **state)
{
	struct spec_curve many, b = CURVE({400, 2}, {500, 4}), product;
	struct spec_error error;

	(void)state;
	assert_int_equal(spec_curve_new(2, 2, &many, NULL), SPEC_OK);
	memcpy(many.wavelength_nm, (double[]){400, 500}, 2 * sizeof(double));
	memcpy(many.value, (double[]){1, 2, 30, 40}, 4 * sizeof(double));
	check(spec_curve_multiply(&many, &b, &product, &error), &error);
	assert_int_equal(product.columns, 2);
	assert_true(product.value[0] == 2);
	assert_true(product.value[1] == 8);
	assert_true(product.value[2] == 60);
	assert_true(product.value[3] == 160);
	spec_curve_free(&product);
	spec_curve_free(&many);
	spec_curve_free(&b);
}

static void
test_resample(void **state)
{
	struct spec_curve curve = CURVE({400, 1}, {500, 3}), result;
	struct spec_grid grid = {.wavelength_nm = (double[]){350, 425, 500}, .count = 3};
	struct spec_error error;

	(void)state;
	assert_int_equal(spec_curve_resample(
				 &curve, &grid, SPEC_EXTRAPOLATE_REFUSE, &result, &error),
		SPEC_ERANGE);
	check(spec_curve_resample(&curve, &grid, SPEC_EXTRAPOLATE_ZERO, &result, &error),
		&error);
	assert_true(result.value[0] == 0);
	assert_true(result.value[1] == 1.5);
	assert_true(result.value[2] == 3);
	spec_curve_free(&result);
	check(spec_curve_resample(
		      &curve, &grid, SPEC_EXTRAPOLATE_CONSTANT, &result, &error),
		&error);
	assert_true(result.value[0] == 1);
	spec_curve_free(&result);
	spec_curve_free(&curve);
}

int
main(void)
{
	const struct CMUnitTest tests[] = {
		cmocka_unit_test_setup_teardown(test_grid, set_up, tear_down),
		cmocka_unit_test_setup_teardown(test_identity, set_up, tear_down),
		cmocka_unit_test_setup_teardown(test_bands, set_up, tear_down),
		cmocka_unit_test_setup_teardown(test_extrapolate, set_up, tear_down),
		cmocka_unit_test_setup_teardown(test_multiply, set_up, tear_down),
		cmocka_unit_test_setup_teardown(test_multiply_grid, set_up, tear_down),
		cmocka_unit_test_setup_teardown(test_stokes, set_up, tear_down),
		cmocka_unit_test_setup_teardown(test_illuminate, set_up, tear_down),
		cmocka_unit_test_setup_teardown(
			test_illuminate_bispectral, set_up, tear_down),
		cmocka_unit_test_setup_teardown(test_crop, set_up, tear_down),
		cmocka_unit_test_setup_teardown(test_crop_corner, set_up, tear_down),
		cmocka_unit_test_setup_teardown(test_downsample, set_up, tear_down),
		cmocka_unit_test_setup_teardown(test_downsample_windows, set_up, tear_down),
		cmocka_unit_test_setup_teardown(test_everything, set_up, tear_down),
		cmocka_unit_test_setup_teardown(test_threads, set_up, tear_down),
		cmocka_unit_test_setup_teardown(test_half, set_up, tear_down),
		cmocka_unit_test_setup_teardown(test_bins, set_up, tear_down),
		cmocka_unit_test_setup_teardown(test_not_spectral, set_up, tear_down),
		cmocka_unit_test(test_rgb_constant),
		cmocka_unit_test(test_rgb_outside),
		cmocka_unit_test(test_rgb_reflector),
		cmocka_unit_test(test_rgb_row),
		cmocka_unit_test(test_product),
		cmocka_unit_test(test_product_between),
		cmocka_unit_test(test_product_columns),
		cmocka_unit_test(test_resample),
	};

	return cmocka_run_group_tests(tests, NULL, NULL);
}
