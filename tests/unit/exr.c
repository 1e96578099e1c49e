/*
 * Reader and writer of spectral EXR against each other and against OpenEXRCore: every
 * compression, sample and window, from files and pipes, by any number of threads.
 */
#include <stdio.h>
#include <stdlib.h>

#include <fcntl.h>
#include <openexr.h>
#include <stdatomic.h>
#include <sys/wait.h>
#include <unistd.h>

#include "base/output.h"
#include "base/parallel.h"
#include "image/half.h"
#include "image/image.h"
#include "image/reader.h"
#include "image/writer.h"

#include "check.h"
#include "files.h"

#define MOST_CHANNELS 8
#define MOST_THREADS 8

static const struct {
	const char *name;
	int number, lines;
} compressions[] = {{"none", EXR_COMPRESSION_NONE, 1}, {"rle", EXR_COMPRESSION_RLE, 1},
	{"zips", EXR_COMPRESSION_ZIPS, 1}, {"zip", EXR_COMPRESSION_ZIP, 16},
	{"piz", EXR_COMPRESSION_PIZ, 32}, {"pxr24", EXR_COMPRESSION_PXR24, 16},
	{"b44", EXR_COMPRESSION_B44, 32}, {"b44a", EXR_COMPRESSION_B44A, 32}};

/* How samples are made up. */
enum pattern {
	SMOOTH,  /* compresses */
	NOISE,   /* does not: chunks are stored as they are */
	SPECIAL, /* NaN with payloads, infinities, -0, denormals */
	TAME     /* smooth, floats with 15 bits of mantissa, as PXR24 keeps them */
};

struct channel {
	const char *name;
	enum spec_sample sample;
};

/* An image whose every sample is known by its place. */
struct shape {
	int width, height, x0, y0;
	int compression;
	enum pattern pattern;
	size_t channels;
	struct channel channel[MOST_CHANNELS]; /* in the order of strcmp */
};

struct fixture {
	char folder[64];
	char path[128], other[128];
};

static int
set_up(void **state)
{
	struct fixture *fixture = calloc(1, sizeof *fixture);

	assert_non_null(fixture);
	strcpy(fixture->folder, "/tmp/exr.XXXXXX");
	assert_non_null(mkdtemp(fixture->folder));
	snprintf(fixture->path, sizeof fixture->path, "%s/a.exr", fixture->folder);
	snprintf(fixture->other, sizeof fixture->other, "%s/b.exr", fixture->folder);
	*state = fixture;
	return 0;
}

static int
tear_down(void **state)
{
	struct fixture *fixture = *state;

	unlink(fixture->path);
	unlink(fixture->other);
	assert_int_equal(rmdir(fixture->folder), 0); /* nothing else was left in it */
	free(fixture);
	return 0;
}

/* What a sample is. */

static uint32_t
bits_of(float value)
{
	uint32_t bits;

	memcpy(&bits, &value, sizeof bits);
	return bits;
}

static float
float_of(uint32_t bits)
{
	float value;

	memcpy(&value, &bits, sizeof value);
	return value;
}

/* A finalizer of a hash (Prospector, C. Wellons 2018): every bit depends on every other. */
static uint32_t
mix(uint32_t n)
{
	n = (n ^ n >> 16) * 0x21f0aaadU;
	n = (n ^ n >> 15) * 0x735a2d97U;
	return n ^ n >> 15;
}

/* The 16 bits of a half, which is finite unless the pattern is SPECIAL. */
static uint16_t
half_bits(enum pattern pattern, int x, int y, size_t channel)
{
	/* Quiet and signalling NaN, infinities, zeros, denormals, the largest. */
	static const uint16_t specials[] = {0x7e55, 0xfe01, 0x7c01, 0x7c00, 0xfc00, 0x8000,
		0x0001, 0x83ff, 0x7bff, 0x0000, 0xfdff};
	uint32_t noise = mix((uint32_t)(x * 8191 + y * 131071) + (uint32_t)channel);

	if (pattern == SPECIAL && noise % 3 == 0)
		return specials[(noise >> 8) % COUNT(specials)];
	if (pattern == NOISE)
		return (uint16_t)((noise & 0x83ff) | ((8 + (noise >> 16) % 15) << 10));
	return (uint16_t)(0x3800 + 3 * x + 5 * y + 7 * (int)channel);
}

static uint32_t
float_bits(enum pattern pattern, int x, int y, size_t channel)
{
	static const uint32_t specials[] = {0x7fc12345, 0xffc00001, 0x7f800001, 0xffbfffff,
		0x7f800000, 0xff800000, 0x80000000, 0x00000001, 0x807fffff, 0x7f7fffff};
	uint32_t noise = mix((uint32_t)(x * 8191 + y * 131071) + (uint32_t)channel);

	if (pattern == SPECIAL && noise % 3 == 0)
		return specials[(noise >> 8) % COUNT(specials)];
	if (pattern == NOISE)
		return (noise & 0x807fffff) | ((100 + (noise >> 24) % 50) << 23);
	noise = bits_of(1 + 0.01F * (float)x + 0.1F * (float)y + (float)channel);
	return pattern == TAME ? noise & 0xffffff00 : noise;
}

static uint32_t
uint_bits(enum pattern pattern, int x, int y, size_t channel)
{
	uint32_t noise = mix((uint32_t)(x * 8191 + y * 131071) + (uint32_t)channel);

	return pattern == SMOOTH ? (uint32_t)x + 1000U * (uint32_t)y : noise;
}

/* By its definition (IEEE 754-2019, table 3.5), NaN with its payload at the top. */
static float
float_of_half(uint16_t half)
{
	uint32_t sign = (uint32_t)(half & 0x8000) << 16, rest = half & 0x03ff;
	int exponent = half >> 10 & 31;

	if (exponent == 31)
		return float_of(sign | 0x7f800000 | rest << 13);
	return (half & 0x8000 ? -1.F : 1.F) *
	       (exponent == 0 ? ldexpf((float)rest, -24)
			      : ldexpf((float)(rest | 0x400), exponent - 25));
}

/* The sample as the reader gives it: a HALF's value, a FLOAT's or a UINT's bits. x, y from 0. */
static uint32_t
expected_bits(const struct shape *shape, size_t channel, int x, int y)
{
	switch (shape->channel[channel].sample) {
	case SPEC_SAMPLE_HALF:
		return bits_of(float_of_half(half_bits(shape->pattern, x, y, channel)));
	case SPEC_SAMPLE_FLOAT:
		return float_bits(shape->pattern, x, y, channel);
	default:
		return uint_bits(shape->pattern, x, y, channel);
	}
}

/* Halves themselves: eight at a time are the processor's, single ones are not. */

static void
test_halves(void **state)
{
	(void)state;
	for (uint32_t bits = 0; bits < 0x10000; bits++) {
		uint16_t half[9], back[9];
		float value[9], wanted = float_of_half((uint16_t)bits);

		for (size_t i = 0; i < 9; i++)
			half[i] = (uint16_t)bits;
		spec_half_to_float(value, half, 9);
		spec_half_from_float(back, value, 9);
		for (size_t i = 0; i < 9; i += 8) {
			uint32_t quiet = isnan(wanted) ? 0x00400000 : 0;

			assert_int_equal(
				bits_of(value[i]) | quiet, bits_of(wanted) | quiet);
			assert_int_equal(back[i] | quiet >> 13, bits | quiet >> 13);
		}
	}
}

/* Half-way between two halves the even one is nearest; beyond 65520 there is no half. */
static void
test_half_rounding(void **state)
{
	(void)state;
	for (uint16_t bits = 0; bits < 0x7c00; bits++) {
		float low = float_of_half(bits),
		      high = bits == 0x7bff ? 65536 : float_of_half((uint16_t)(bits + 1));
		float middle = (low + high) / 2; /* exact: one bit more */
		float value[27];
		uint16_t half[27];

		for (size_t i = 0; i < 9; i++) {
			value[i] = middle;
			value[9 + i] = nextafterf(middle, 0);
			value[18 + i] = -nextafterf(middle, INFINITY);
		}
		spec_half_from_float(half, value, 9);
		spec_half_from_float(half + 9, value + 9, 9);
		spec_half_from_float(half + 18, value + 18, 9);
		for (size_t i = 0; i < 9; i += 8) {
			assert_int_equal(half[i], bits + (bits & 1));
			assert_int_equal(half[9 + i], bits);
			assert_int_equal(half[18 + i], 0x8000 | (bits + 1));
		}
	}
}

/* Writing with the suite's writer. */

static struct spec_image
image_of(const struct shape *shape)
{
	struct spec_image image = {
		.data = {shape->x0, shape->y0, shape->x0 + shape->width,
			shape->y0 + shape->height},
		/* Another than the data window, and partly outside it. */
		.display = {shape->x0 - 3, shape->y0 + 1, shape->x0 + 5, shape->y0 + 9},
		.pixel_aspect_ratio = 1.5F,
		.screen_window_x = 0.25F,
		.screen_window_y = -0.5F,
		.screen_window_width = 2,
	};
	struct spec_error error;

	for (size_t i = 0; i < shape->channels; i++)
		check(spec_image_add_channel(&image, shape->channel[i].name,
			      shape->channel[i].sample, &error),
			&error);
	check(spec_image_index(&image, "test", &error), &error);
	for (size_t i = 0; i < shape->channels; i++)
		assert_string_equal(image.channel[i].name, shape->channel[i].name);
	return image;
}

struct writing {
	const struct shape *shape;
	struct spec_writer *writer;
	atomic_int next_chunk;
	atomic_int failures;
};

static void
fill_line(const struct shape *shape, int y, float *const *plane)
{
	for (size_t i = 0; i < shape->channels; i++) {
		for (int x = 0; x < shape->width; x++) {
			uint32_t bits = expected_bits(shape, i, x, y);

			memcpy(plane[i] + x, &bits, sizeof bits);
		}
	}
}

/* cmocka's assertions are for the first thread alone. */
static void
write_chunks(void *argument, int worker)
{
	struct writing *writing = argument;
	const struct shape *shape = writing->shape;
	int lines = spec_writer_chunk_lines(writing->writer), y;
	struct spec_packer *packer;
	float *const *plane;

	(void)worker;
	if (spec_packer_open(&packer, writing->writer, NULL) != SPEC_OK) {
		writing->failures++;
		return;
	}
	while ((y = atomic_fetch_add(&writing->next_chunk, 1) * lines) < shape->height) {
		for (int end = y + lines; y < end && y < shape->height; y++) {
			if (spec_packer_begin(packer, shape->y0 + y, &plane, NULL) !=
				SPEC_OK) {
				writing->failures++;
				continue;
			}
			fill_line(shape, y, plane);
			if (spec_packer_end(packer, shape->y0 + y, NULL) != SPEC_OK)
				writing->failures++;
		}
	}
	spec_packer_close(packer);
}

static void
write_image(const struct shape *shape, const struct spec_image *image, const char *path,
	int threads)
{
	struct writing writing = {.shape = shape};
	struct spec_output output;
	struct spec_error error;

	check(spec_output_open(&output, path, &error), &error);
	check(spec_writer_open(&writing.writer, image, &output, shape->compression, &error),
		&error);
	check(spec_parallel_run(threads, write_chunks, &writing, &error), &error);
	assert_int_equal(writing.failures, 0);
	check(spec_writer_finish(writing.writer, &error), &error);
	spec_writer_close(writing.writer);
	check(spec_output_commit(&output, &error), &error);
}

static void
write_shape(const struct shape *shape, const char *path, int threads)
{
	struct spec_image image = image_of(shape);

	write_image(shape, &image, path, threads);
	spec_image_clear(&image);
}

/* Reading with the suite's reader. */

static struct spec_reader *
open_reader(const char *path, const char *part)
{
	struct spec_settings settings;
	struct spec_reader *reader;
	struct spec_error error;

	spec_settings_init(&settings);
	settings.part = part;
	check(spec_reader_open(&reader, path, &settings, &error), &error);
	return reader;
}

/* Halves' signalling NaN may become quiet; all else is kept. */
static int
same_sample(enum spec_sample sample, uint32_t a, uint32_t b)
{
	if (sample == SPEC_SAMPLE_HALF && isnan(float_of(a)))
		return (a | 0x00400000) == (b | 0x00400000);
	return a == b;
}

typedef int comparison(const struct shape *shape, size_t channel, int x, int y,
	uint32_t wanted, uint32_t found);

static int
exactly(const struct shape *shape, size_t channel, int x, int y, uint32_t wanted,
	uint32_t found)
{
	(void)x;
	(void)y;
	return same_sample(shape->channel[channel].sample, wanted, found);
}

static void
compare_line(const struct shape *shape, const struct spec_decoder *decoder, int y,
	comparison *same)
{
	for (size_t i = 0; i < shape->channels; i++) {
		const float *row = spec_decoder_row(decoder, shape->y0 + y, i);

		assert_non_null(row);
		for (int x = 0; x < shape->width; x++) {
			uint32_t wanted = expected_bits(shape, i, x, y), found;

			memcpy(&found, row + x, sizeof found);
			if (!same(shape, i, x, y, wanted, found))
				fail_msg("compression %d, pattern %d, %dx%d at %d,%d, "
					 "'%s' at %d,%d: %08x instead of %08x",
					shape->compression, shape->pattern, shape->width,
					shape->height, shape->x0, shape->y0,
					shape->channel[i].name, x, y, found, wanted);
		}
	}
}

/* Reads all lines in blocks of these heights, by two decoders in turn. */
static void
compare_image(const struct shape *shape, struct spec_reader *reader, const int *block,
	size_t blocks, comparison *same)
{
	const struct spec_image *image = spec_reader_image(reader);
	struct spec_decoder *decoder[2];
	struct spec_error error;
	int y = 0, turn = 0;

	assert_int_equal(image->channels, shape->channels);
	assert_int_equal(image->data.x0, shape->x0);
	assert_int_equal(image->data.y0, shape->y0);
	assert_int_equal(image->data.x1, shape->x0 + shape->width);
	assert_int_equal(image->data.y1, shape->y0 + shape->height);
	for (size_t i = 0; i < shape->channels; i++) {
		assert_string_equal(image->channel[i].name, shape->channel[i].name);
		assert_int_equal(image->channel[i].sample, shape->channel[i].sample);
	}
	for (int i = 0; i < 2; i++)
		check(spec_decoder_open(&decoder[i], reader, NULL, &error), &error);
	for (size_t i = 0; y < shape->height; i++, turn = !turn) {
		int end = y + block[i % blocks];

		end = end < shape->height ? end : shape->height;
		check(spec_decoder_fetch(
			      decoder[turn], shape->y0 + y, shape->y0 + end, &error),
			&error);
		check(spec_decoder_decode(decoder[turn], &error), &error);
		for (; y < end; y++)
			compare_line(shape, decoder[turn], y, same);
	}
	for (int i = 0; i < 2; i++)
		spec_decoder_close(decoder[i]);
}

/* A process that writes the file into a pipe, whose other end *path names. */
static pid_t
start_pipe(const char *file, char path[32], int *end)
{
	int ends[2];
	pid_t child;

	assert_int_equal(pipe(ends), 0);
	child = fork();
	assert_true(child >= 0);
	if (child == 0) {
		char bytes[4096];
		int fd = open(file, O_RDONLY);
		ssize_t got;

		close(ends[0]);
		while ((got = read(fd, bytes, sizeof bytes)) > 0)
			if (write(ends[1], bytes, (size_t)got) != got)
				_exit(1);
		_exit(got < 0);
	}
	close(ends[1]);
	snprintf(path, 32, "/dev/fd/%d", ends[0]);
	*end = ends[0];
	return child;
}

static void
end_pipe(pid_t child, int end)
{
	int status;

	close(end);
	assert_int_equal(waitpid(child, &status, 0), child);
}

static void
compare_file(const struct shape *shape, const char *path, const char *part,
	const int *block, size_t blocks, comparison *same)
{
	struct spec_reader *reader = open_reader(path, part);

	compare_image(shape, reader, block, blocks, same);
	spec_reader_close(reader);
}

static void
compare_pipe(const struct shape *shape, const char *path, const char *part,
	const int *block, size_t blocks, comparison *same)
{
	char end_path[32];
	int end;
	pid_t child = start_pipe(path, end_path, &end);

	compare_file(shape, end_path, part, block, blocks, same);
	end_pipe(child, end);
}

/* Reading with the library alone. */

static void
compare_chunk(exr_const_context_t context, const struct shape *shape,
	const exr_chunk_info_t *info, comparison *same)
{
	exr_decode_pipeline_t pipeline = EXR_DECODE_PIPELINE_INITIALIZER;
	size_t pixels = (size_t)info->height * (size_t)shape->width;
	unsigned char *samples[MOST_CHANNELS];

	assert_int_equal(exr_decoding_initialize(context, 0, info, &pipeline), 0);
	for (size_t i = 0; i < shape->channels; i++) {
		exr_coding_channel_info_t *channel = &pipeline.channels[i];

		samples[i] = malloc(pixels * 4);
		assert_non_null(samples[i]);
		/* Halves as floats, the rest as it is. */
		channel->user_data_type = channel->data_type == EXR_PIXEL_HALF
						  ? EXR_PIXEL_FLOAT
						  : channel->data_type;
		channel->user_bytes_per_element = 4;
		channel->user_pixel_stride = 4;
		channel->user_line_stride = 4 * shape->width;
		channel->decode_to_ptr = samples[i];
	}
	assert_int_equal(exr_decoding_choose_default_routines(context, 0, &pipeline), 0);
	assert_int_equal(exr_decoding_run(context, 0, &pipeline), 0);
	for (size_t i = 0; i < shape->channels; i++) {
		for (size_t at = 0; at < pixels; at++) {
			int x = (int)at % shape->width,
			    y = info->start_y - shape->y0 + (int)at / shape->width;
			uint32_t wanted = expected_bits(shape, i, x, y), found;

			memcpy(&found, samples[i] + 4 * at, sizeof found);
			if (!same(shape, i, x, y, wanted, found))
				fail_msg("the library reads, compression %d, pattern %d, "
					 "%dx%d, '%s' at %d,%d: %08x instead of %08x",
					shape->compression, shape->pattern, shape->width,
					shape->height, shape->channel[i].name, x, y, found,
					wanted);
		}
		free(samples[i]);
	}
	assert_int_equal(exr_decoding_destroy(context, &pipeline), 0);
}

static void
compare_by_library(const struct shape *shape, const char *path, int lines, comparison *same)
{
	exr_context_initializer_t setup = EXR_DEFAULT_CONTEXT_INITIALIZER;
	exr_context_t context;
	exr_chunk_info_t info;
	int32_t found;

	assert_int_equal(exr_start_read(&context, path, &setup), 0);
	assert_int_equal(exr_get_scanlines_per_chunk(context, 0, &found), 0);
	assert_int_equal(found, lines);
	for (int y = 0; y < shape->height; y += lines) {
		assert_int_equal(
			exr_read_scanline_chunk_info(context, 0, shape->y0 + y, &info), 0);
		/* It takes B44's stored chunks for compressed ones, which the C++ library
		   does not (ImfScanLineInputFile.cpp, LineBufferTask::execute). */
		if (info.packed_size == info.unpacked_size &&
			(shape->compression == EXR_COMPRESSION_B44 ||
				shape->compression == EXR_COMPRESSION_B44A))
			continue;
		compare_chunk(context, shape, &info, same);
	}
	exr_finish(&context);
}

static const int whole[] = {1 << 20};

/* Every compression, sample, size and window. */

static const struct channel halves[] = {{"S0.400,000000nm", SPEC_SAMPLE_HALF},
	{"S0.500,000000nm", SPEC_SAMPLE_HALF}, {"S0.600,000000nm", SPEC_SAMPLE_HALF}};
static const struct channel floats[] = {{"A", SPEC_SAMPLE_FLOAT},
	{"T.400,000000nm", SPEC_SAMPLE_FLOAT}, {"T.500,000000nm", SPEC_SAMPLE_FLOAT}};
static const struct channel numbers[] = {{"id", SPEC_SAMPLE_UINT}};
static const struct channel mixed[] = {{"A", SPEC_SAMPLE_HALF}, {"P.X", SPEC_SAMPLE_FLOAT},
	{"S0.400,000000nm", SPEC_SAMPLE_FLOAT}, {"S0.500,000000nm", SPEC_SAMPLE_HALF},
	{"id", SPEC_SAMPLE_UINT}, {"zz", SPEC_SAMPLE_FLOAT}};
static const struct {
	const struct channel *channel;
	size_t count;
} sets[] = {{halves, COUNT(halves)}, {floats, COUNT(floats)}, {numbers, COUNT(numbers)},
	{mixed, COUNT(mixed)}};

/* A half as a whole number in the order of its values. */
static int
code_of(uint32_t bits)
{
	float value = float_of(bits), size = fabsf(value);
	int exponent, code;

	if (size < ldexpf(1, -14)) {
		code = (int)ldexpf(size, 24);
	} else {
		size = frexpf(size, &exponent); /* in [1/2, 1) */
		code = (exponent + 14) * 1024 + (int)((size * 2 - 1) * 1024);
	}
	return value < 0 ? -code : code;
}

/*
 * B44 stores a block of 4x4 halves as its largest code and differences of 6 bits, shifted
 * right by the least s that makes them fit: differences of a range M fit when
 * M / 2^s <= 30 or so, hence 2^s <= M / 15 and half of it, rounding, is M / 30. One code
 * more for the rounding of the largest. (OpenEXR, "B44 compression", pack().)
 */
static int
within_b44(const struct shape *shape, size_t channel, int x, int y, uint32_t wanted,
	uint32_t found)
{
	int low = INT32_MAX, high = INT32_MIN;

	if (shape->channel[channel].sample != SPEC_SAMPLE_HALF)
		return wanted == found;
	for (int j = y / 4 * 4; j < y / 4 * 4 + 4 && j < shape->height; j++) {
		for (int i = x / 4 * 4; i < x / 4 * 4 + 4 && i < shape->width; i++) {
			int code = code_of(expected_bits(shape, channel, i, j));

			low = code < low ? code : low;
			high = code > high ? code : high;
		}
	}
	return abs(code_of(wanted) - code_of(found)) <= (high - low) / 30 + 1;
}

/* PXR24 rounds floats to 15 bits of mantissa: half of 2^-15, relative. */
static int
within_pxr24(const struct shape *shape, size_t channel, int x, int y, uint32_t wanted,
	uint32_t found)
{
	double a = float_of(wanted), b = float_of(found);

	(void)x;
	(void)y;
	if (shape->channel[channel].sample != SPEC_SAMPLE_FLOAT)
		return same_sample(shape->channel[channel].sample, wanted, found);
	return fabs(a - b) <= fabs(a) * 0x1p-16;
}

/* The pattern number n that a compression keeps, and how well. */
static comparison *
choose_pattern(struct shape *shape, int n)
{
	static const enum pattern pxr24[] = {SMOOTH, NOISE, TAME};

	shape->pattern = (enum pattern)(n % 3);
	switch (shape->compression) {
	case EXR_COMPRESSION_B44:
	case EXR_COMPRESSION_B44A:
		shape->pattern = n % 2 ? NOISE : SMOOTH; /* not finite becomes 0 in it */
		return within_b44;
	case EXR_COMPRESSION_PXR24:
		shape->pattern = pxr24[n % 3];
		return shape->pattern == TAME ? exactly : within_pxr24;
	default:
		return exactly;
	}
}

static void
test_round_trips(void **state)
{
	static const int widths[] = {1, 7, 33}, heights[] = {1, 15, 16, 17, 33, 70};
	static const int corners[][2] = {{0, 0}, {13, 1000}, {-40, -21}};
	struct fixture *fixture = *state;
	int n = 0;

	for (size_t c = 0; c < COUNT(compressions); c++) {
		for (size_t s = 0; s < COUNT(sets); s++) {
			for (size_t i = 0; i < COUNT(widths) * COUNT(heights); i++, n++) {
				const int *corner = corners[(i + s) % COUNT(corners)];
				struct shape shape = {
					.width = widths[i % COUNT(widths)],
					.height = heights[i / COUNT(widths)],
					.x0 = corner[0],
					.y0 = corner[1],
					.compression = compressions[c].number,
					.channels = sets[s].count,
				};
				comparison *same = choose_pattern(&shape, n);

				memcpy(shape.channel, sets[s].channel,
					sets[s].count * sizeof *shape.channel);
				write_shape(&shape, fixture->path, 1);
				compare_file(&shape, fixture->path, NULL, whole, 1, same);
			}
		}
	}
}

static void
test_windows_and_fields(void **state)
{
	struct fixture *fixture = *state;
	struct shape shape = {
		.width = 5, .height = 3, .x0 = -7, .y0 = 11, .channels = COUNT(mixed)};
	struct spec_image image;
	const struct spec_image *back;
	struct spec_reader *reader;

	memcpy(shape.channel, mixed, sizeof mixed);
	image = image_of(&shape);
	image.channel[0].linear = 1;
	image.part = strdup("left");
	write_image(&shape, &image, fixture->path, 1);
	reader = open_reader(fixture->path, NULL);
	back = spec_reader_image(reader);
	assert_memory_equal(&back->data, &image.data, sizeof image.data);
	assert_memory_equal(&back->display, &image.display, sizeof image.display);
	assert_true(back->pixel_aspect_ratio == 1.5F);
	assert_true(back->screen_window_x == 0.25F);
	assert_true(back->screen_window_y == -0.5F);
	assert_true(back->screen_window_width == 2);
	assert_string_equal(back->part, "left");
	assert_int_equal(back->channel[0].linear, 1);
	assert_int_equal(back->channel[1].linear, 0);
	assert_int_equal(back->bands, 2);
	spec_reader_close(reader);
	spec_image_clear(&image);
}

/* The outermost that OpenEXRCore takes. */
static void
test_far_windows(void **state)
{
	static const int corners[] = {-(1 << 30) + 2, (1 << 30) - 10};
	struct fixture *fixture = *state;

	for (size_t i = 0; i < COUNT(corners); i++) {
		struct shape shape = {.width = 4,
			.height = 9,
			.x0 = corners[i],
			.y0 = corners[i],
			.compression = EXR_COMPRESSION_ZIP,
			.channels = COUNT(floats)};

		struct spec_image image;

		memcpy(shape.channel, floats, sizeof floats);
		image = image_of(&shape);
		image.display = image.data;
		write_image(&shape, &image, fixture->path, 1);
		spec_image_clear(&image);
		compare_file(&shape, fixture->path, NULL, whole, 1, exactly);
	}
}

/* Blocks of lines that do not care where chunks begin. */

static void
test_straddling_blocks(void **state)
{
	static const int blocks[][5] = {
		{1, 1, 1, 1, 1}, {5, 7, 3, 20, 1}, {15, 2, 31, 1, 16}, {33, 33, 1, 1, 1}};
	struct fixture *fixture = *state;

	for (size_t c = 0; c < COUNT(compressions); c++) {
		struct shape shape = {.width = 9,
			.height = 70,
			.y0 = -3,
			.compression = compressions[c].number,
			.channels = COUNT(mixed)};
		comparison *same = choose_pattern(&shape, 0);

		memcpy(shape.channel, mixed, sizeof mixed);
		write_shape(&shape, fixture->path, 1);
		for (size_t i = 0; i < COUNT(blocks); i++) {
			compare_file(&shape, fixture->path, NULL, blocks[i],
				COUNT(blocks[i]), same);
			compare_pipe(&shape, fixture->path, NULL, blocks[i],
				COUNT(blocks[i]), same);
		}
	}
}

/* Lines in the middle alone, and channels alone: the rest is passed over. */
static void
test_selection(void **state)
{
	static const unsigned char wanted[] = {0, 1, 0, 1, 1, 0};
	struct fixture *fixture = *state;
	struct shape shape = {.width = 9,
		.height = 70,
		.compression = EXR_COMPRESSION_ZIP,
		.channels = COUNT(mixed)};

	memcpy(shape.channel, mixed, sizeof mixed);
	write_shape(&shape, fixture->path, 1);
	for (int piped = 0; piped < 2; piped++) {
		char path[32];
		int end = -1;
		pid_t child = piped ? start_pipe(fixture->path, path, &end) : -1;
		struct spec_reader *reader =
			open_reader(piped ? path : fixture->path, NULL);
		struct spec_decoder *decoder;
		struct spec_error error;

		check(spec_decoder_open(&decoder, reader, wanted, &error), &error);
		for (int y = 20; y < 60; y += 25) {
			check(spec_decoder_fetch(decoder, y, y + 2, &error), &error);
			check(spec_decoder_decode(decoder, &error), &error);
			for (size_t i = 0; i < shape.channels; i++) {
				const float *row = spec_decoder_row(decoder, y + 1, i);

				assert_int_equal(row != NULL, wanted[i]);
				if (row)
					assert_int_equal(bits_of(row[8]),
						expected_bits(&shape, i, 8, y + 1));
			}
		}
		spec_decoder_close(decoder);
		spec_reader_close(reader);
		if (piped)
			end_pipe(child, end);
	}
}

/* Bytes that do not depend on threads, nor on whether a pipe or a file takes them. */

static void
assert_same_files(const char *a, const char *b)
{
	size_t size_a, size_b;
	unsigned char *bytes_a = file_bytes(a, &size_a), *bytes_b = file_bytes(b, &size_b);

	assert_int_equal(size_a, size_b);
	assert_memory_equal(bytes_a, bytes_b, size_a);
	free(bytes_a);
	free(bytes_b);
}

static void
test_threads(void **state)
{
	static const int threads[] = {2, 3, MOST_THREADS};
	struct fixture *fixture = *state;

	for (size_t c = 0; c < COUNT(compressions); c++) {
		struct shape shape = {.width = 33,
			.height = 300,
			.y0 = -5,
			.compression = compressions[c].number,
			.channels = COUNT(mixed)};

		memcpy(shape.channel, mixed, sizeof mixed);
		choose_pattern(&shape, (int)c);
		write_shape(&shape, fixture->path, 1);
		for (size_t i = 0; i < COUNT(threads); i++) {
			write_shape(&shape, fixture->other, threads[i]);
			assert_same_files(fixture->path, fixture->other);
		}
	}
}

/* A process that takes what is written into a pipe to a file. */
static pid_t
start_drain(const char *file, char path[32], int *end)
{
	int ends[2];
	pid_t child;

	assert_int_equal(pipe(ends), 0);
	child = fork();
	assert_true(child >= 0);
	if (child == 0) {
		char bytes[4096];
		int fd = open(file, O_WRONLY | O_CREAT | O_TRUNC, 0600);
		ssize_t got;

		close(ends[1]);
		while ((got = read(ends[0], bytes, sizeof bytes)) > 0)
			if (write(fd, bytes, (size_t)got) != got)
				_exit(1);
		_exit(got < 0);
	}
	close(ends[0]);
	snprintf(path, 32, "/dev/fd/%d", ends[1]);
	*end = ends[1];
	return child;
}

static void
test_output_to_pipe(void **state)
{
	struct fixture *fixture = *state;

	for (size_t c = 0; c < COUNT(compressions); c++) {
		for (int threads = 1; threads <= 3; threads += 2) {
			struct shape shape = {.width = 33,
				.height = 130,
				.y0 = 7,
				.compression = compressions[c].number,
				.channels = COUNT(mixed)};
			char path[32];
			pid_t child;
			int end;

			memcpy(shape.channel, mixed, sizeof mixed);
			write_shape(&shape, fixture->path, 1);
			child = start_drain(fixture->other, path, &end);
			write_shape(&shape, path, threads);
			end_pipe(child, end);
			assert_same_files(fixture->path, fixture->other);
		}
	}
}

/* By default NONE goes into a pipe and ZIP into a file. */
static void
test_default_compression(void **state)
{
	struct fixture *fixture = *state;
	struct shape shape = {
		.width = 4, .height = 4, .compression = -1, .channels = COUNT(floats)};
	struct spec_reader *reader;
	char path[32];
	pid_t child;
	int end;

	memcpy(shape.channel, floats, sizeof floats);
	write_shape(&shape, fixture->path, 1);
	child = start_drain(fixture->other, path, &end);
	write_shape(&shape, path, 1);
	end_pipe(child, end);
	reader = open_reader(fixture->path, NULL);
	assert_int_equal(spec_reader_image(reader)->compression, EXR_COMPRESSION_ZIP);
	spec_reader_close(reader);
	reader = open_reader(fixture->other, NULL);
	assert_int_equal(spec_reader_image(reader)->compression, EXR_COMPRESSION_NONE);
	spec_reader_close(reader);
}

/* A file with lines missing is no success, and one whose chunks come in disorder is none. */
static void
test_missing_lines(void **state)
{
	struct fixture *fixture = *state;
	struct shape shape = {.width = 4,
		.height = 40,
		.compression = EXR_COMPRESSION_ZIP,
		.channels = COUNT(floats)};
	struct spec_image image;
	struct spec_writer *writer;
	struct spec_packer *packer;
	struct spec_output output;
	struct spec_error error;
	float *const *plane;

	memcpy(shape.channel, floats, sizeof floats);
	image = image_of(&shape);
	check(spec_output_open(&output, fixture->path, &error), &error);
	check(spec_writer_open(&writer, &image, &output, shape.compression, &error),
		&error);
	check(spec_packer_open(&packer, writer, &error), &error);
	for (int y = 0; y < 39; y++) {
		check(spec_packer_begin(packer, y, &plane, &error), &error);
		fill_line(&shape, y, plane);
		check(spec_packer_end(packer, y, &error), &error);
	}
	assert_int_equal(spec_writer_finish(writer, &error), SPEC_EUSAGE);
	spec_packer_close(packer);
	spec_writer_close(writer);
	spec_output_abandon(&output);
	assert_int_equal(access(fixture->path, F_OK), -1);
	spec_image_clear(&image);
}

/* Attributes. */

static const struct {
	const char *name, *type;
	size_t size;
	const char *bytes;
} attributes[] = {
#define TEXT(string) sizeof(string) - 1, string
	{"a box of integers", "box2i", TEXT("\1\0\0\0\376\377\377\377\3\0\0\0\4\0\0\0")},
	{"a box of floats", "box2f", TEXT("\0\0\200?\0\0\0@\0\0@@\1\0\300\177")},
	{"chromas", "chromaticities", TEXT("0123456789abcdefghijklmnopqrstuv")},
	{"a double", "double", TEXT("12345678")},
	{"envmap", "envmap", TEXT("\1")},
	{"a float", "float", TEXT("\1\0\300\377")},
	{"an int", "int", TEXT("\376\377\377\377")},
	{"keys", "keycode", TEXT("0123456789abcdefghijklmnopqr")},
	{"m33f", "m33f", TEXT("0123456789abcdefghijklmnopqrstuvwxyz")},
	{"m33d", "m33d",
		TEXT("0123456789abcdefghijklmnopqrstuvwxyz0123456789ABCDEFGHIJKLMNOPQRSTUVWXYZ")},
	{"m44f", "m44f",
		TEXT("0123456789abcdef0123456789ABCDEF0123456789ghijkl0123456789GHIJKL")},
	{"m44d", "m44d",
		TEXT("0123456789abcdef0123456789ABCDEF0123456789ghijkl0123456789GHIJKL"
		     "0123456789mnopqr0123456789MNOPQR0123456789stuvwx0123456789STUVWX")},
	{"framesPerSecond", "rational", TEXT("\30\0\0\0\1\0\0\0")},
	{"a text", "string", TEXT("k\303\244se, 'quoted'\nsecond line")},
	{"an empty text", "string", TEXT("")},
	{"texts", "stringvector", TEXT("\3\0\0\0abc\0\0\0\0\2\0\0\0de")},
	{"floats", "floatvector", TEXT("abcdefghijkl")},
	{"time", "timecode", TEXT("12345678")},
	{"v2i", "v2i", TEXT("12345678")},
	{"v2f", "v2f", TEXT("12345678")},
	{"v2d", "v2d", TEXT("1234567812345678")},
	{"v3i", "v3i", TEXT("123456781234")},
	{"v3f", "v3f", TEXT("123456781234")},
	{"v3d", "v3d", TEXT("123456781234567812345678")},
	{"preview", "preview", TEXT("\3\0\0\0\2\0\0\0rgbargbargbaRGBARGBARGBA")},
	{"something else", "ownType", TEXT("any\0bytes\377at all")},
	{"an attribute whose name has more than 31 bytes", "string", TEXT("long")},
	{"a type", "a type whose name has more than 31 bytes", TEXT("longer")},
#undef TEXT
};

static void
assert_attributes(const struct spec_image *image)
{
	assert_int_equal(image->attributes, COUNT(attributes));
	for (size_t i = 0; i < COUNT(attributes); i++) {
		const struct spec_attribute *found =
			spec_image_attribute(image, attributes[i].name);

		if (!found)
			fail_msg("attribute '%s' is gone", attributes[i].name);
		assert_string_equal(found->type, attributes[i].type);
		if (found->size != attributes[i].size)
			fail_msg("attribute '%s' has %zu bytes instead of %zu",
				attributes[i].name, found->size, attributes[i].size);
		assert_memory_equal(found->value, attributes[i].bytes, found->size);
	}
}

/* The library's own readers see in them what was meant: not only our bytes, mirrored. */
static void
assert_library_sees(const char *path)
{
	exr_context_initializer_t setup = EXR_DEFAULT_CONTEXT_INITIALIZER;
	exr_context_t context;
	exr_attr_box2i_t box;
	exr_attr_rational_t rate;
	exr_attr_preview_t preview;
	exr_attr_m33f_t matrix;
	const char *text, *texts[3];
	int32_t count = 3, length, number;
	const float *list;

	assert_int_equal(exr_start_read(&context, path, &setup), EXR_ERR_SUCCESS);
	assert_int_equal(exr_attr_get_box2i(context, 0, "a box of integers", &box), 0);
	assert_int_equal(box.min.x, 1);
	assert_int_equal(box.min.y, -2);
	assert_int_equal(box.max.x, 3);
	assert_int_equal(box.max.y, 4);
	assert_int_equal(exr_attr_get_rational(context, 0, "framesPerSecond", &rate), 0);
	assert_int_equal(rate.num, 24);
	assert_int_equal(rate.denom, 1);
	assert_int_equal(exr_attr_get_preview(context, 0, "preview", &preview), 0);
	assert_int_equal(preview.width, 3);
	assert_int_equal(preview.height, 2);
	assert_memory_equal(preview.rgba, "rgbargbargbaRGBARGBARGBA", 24);
	assert_int_equal(exr_attr_get_m33f(context, 0, "m33f", &matrix), 0);
	assert_memory_equal(&matrix, "0123456789abcdefghijklmnopqrstuvwxyz", 36);
	assert_int_equal(exr_attr_get_int(context, 0, "an int", &number), 0);
	assert_int_equal(number, -2);
	assert_int_equal(exr_attr_get_string(context, 0, "a text", &length, &text), 0);
	assert_string_equal(text, "k\303\244se, 'quoted'\nsecond line");
	assert_int_equal(exr_attr_get_string_vector(context, 0, "texts", &count, texts), 0);
	assert_int_equal(count, 3);
	assert_string_equal(texts[0], "abc");
	assert_string_equal(texts[1], "");
	assert_string_equal(texts[2], "de");
	assert_int_equal(exr_attr_get_float_vector(context, 0, "floats", &count, &list), 0);
	assert_int_equal(count, 3);
	assert_memory_equal(list, "abcdefghijkl", 12);
	exr_finish(&context);
}

static void
test_attributes(void **state)
{
	struct fixture *fixture = *state;
	struct shape shape = {.width = 2, .height = 2, .channels = COUNT(floats)};
	struct spec_image image, copy;
	struct spec_reader *reader;
	struct spec_error error;

	memcpy(shape.channel, floats, sizeof floats);
	image = image_of(&shape);
	for (size_t i = 0; i < COUNT(attributes); i++)
		check(spec_image_set_attribute(&image, attributes[i].name,
			      attributes[i].type, attributes[i].bytes, attributes[i].size,
			      &error),
			&error);
	write_image(&shape, &image, fixture->path, 1);
	assert_library_sees(fixture->path);
	reader = open_reader(fixture->path, NULL);
	assert_attributes(spec_reader_image(reader));
	/* And once more, from what was read. */
	check(spec_image_copy(&copy, spec_reader_image(reader), &error), &error);
	check(spec_image_index(&copy, "copy", &error), &error);
	write_image(&shape, &copy, fixture->other, 1);
	spec_reader_close(reader);
	spec_image_clear(&copy);
	assert_same_files(fixture->path, fixture->other);
	spec_image_clear(&image);
}

/* Lists with nothing in them are allowed in files. */
static void
test_empty_attributes(void **state)
{
	static const char *const types[] = {"stringvector", "floatvector"};
	struct fixture *fixture = *state;
	struct shape shape = {.width = 2, .height = 2, .channels = COUNT(floats)};

	memcpy(shape.channel, floats, sizeof floats);
	for (size_t i = 0; i < COUNT(types); i++) {
		struct spec_image image = image_of(&shape);
		const struct spec_attribute *found;
		struct spec_reader *reader;
		struct spec_error error;

		check(spec_image_set_attribute(&image, "empty", types[i], "", 0, &error),
			&error);
		write_image(&shape, &image, fixture->path, 1);
		reader = open_reader(fixture->path, NULL);
		found = spec_image_attribute(spec_reader_image(reader), "empty");
		assert_non_null(found);
		assert_string_equal(found->type, types[i]);
		assert_int_equal(found->size, 0);
		spec_reader_close(reader);
		spec_image_clear(&image);
	}
}

static void
test_long_names(void **state)
{
	static const char name[] =
		"a layer with a name.of more than thirty-one bytes, komma, k\303\244se.Z";
	struct fixture *fixture = *state;
	char longest[256];
	struct shape shape = {.width = 3, .height = 2, .channels = 3};

	memset(longest, 'z', 255);
	longest[255] = '\0';
	shape.channel[0] = (struct channel){"S0.500,000000nm", SPEC_SAMPLE_FLOAT};
	shape.channel[1] = (struct channel){name, SPEC_SAMPLE_HALF};
	shape.channel[2] = (struct channel){longest, SPEC_SAMPLE_UINT};
	write_shape(&shape, fixture->path, 1);
	compare_file(&shape, fixture->path, NULL, whole, 1, exactly);
	compare_pipe(&shape, fixture->path, NULL, whole, 1, exactly);
}

/* Files that the library writes: tiles, parts, line orders, its own zlib. */

struct foreign {
	struct shape shape;
	int tile_width, tile_height; /* 0: scanlines */
	exr_tile_level_mode_t levels;
	exr_lineorder_t order; /* of the only part */
	const char *part;      /* null: the only one, without a name */
};

static size_t
bytes_of(enum spec_sample sample)
{
	return sample == SPEC_SAMPLE_HALF ? 2 : 4;
}

/* A sample as files have it. */
static void
store_sample(const struct shape *shape, size_t channel, int x, int y, unsigned char *to)
{
	uint32_t bits = expected_bits(shape, channel, x, y);
	uint16_t half = half_bits(shape->pattern, x, y, channel);

	if (shape->channel[channel].sample == SPEC_SAMPLE_HALF)
		memcpy(to, &half, sizeof half);
	else
		memcpy(to, &bits, sizeof bits);
}

static void
declare_part(exr_context_t context, const struct foreign *foreign, int *part)
{
	const struct shape *shape = &foreign->shape;
	exr_attr_box2i_t data;
	exr_attr_v2f_t centre;

	data.min.x = shape->x0;
	data.min.y = shape->y0;
	data.max.x = shape->x0 + shape->width - 1;
	data.max.y = shape->y0 + shape->height - 1;
	centre.x = centre.y = 0;
	assert_int_equal(
		exr_add_part(context, foreign->part,
			foreign->tile_width ? EXR_STORAGE_TILED : EXR_STORAGE_SCANLINE,
			part),
		EXR_ERR_SUCCESS);
	assert_int_equal(
		exr_initialize_required_attr(context, *part, &data, &data, 1, &centre, 1,
			EXR_LINEORDER_INCREASING_Y, (exr_compression_t)shape->compression),
		EXR_ERR_SUCCESS);
	for (size_t i = 0; i < shape->channels; i++)
		assert_int_equal(exr_add_channel(context, *part, shape->channel[i].name,
					 (exr_pixel_type_t)shape->channel[i].sample,
					 EXR_PERCEPTUALLY_LOGARITHMIC, 1, 1),
			EXR_ERR_SUCCESS);
	if (foreign->tile_width)
		assert_int_equal(exr_set_tile_descriptor(context, *part,
					 (uint32_t)foreign->tile_width,
					 (uint32_t)foreign->tile_height, foreign->levels,
					 EXR_TILE_ROUND_DOWN),
			EXR_ERR_SUCCESS);
}

/*
 * Encodes the samples from x, y of a chunk and writes it. A chunk that does not shrink is
 * stored, as OpenEXR's C++ library does and expects it (ImfOutputFile.cpp, writePixelData);
 * OpenEXRCore 3.1.5 itself leaves one that stays as large as it was, and B44's that grow.
 */
static void
write_foreign_chunk(exr_context_t context, int part, const struct foreign *foreign,
	const exr_chunk_info_t *info, int x0, int y0)
{
	const struct shape *shape = &foreign->shape;
	exr_encode_pipeline_t pipeline = EXR_ENCODE_PIPELINE_INITIALIZER;
	unsigned char *samples[MOST_CHANNELS];
	size_t width = (size_t)info->width, size;
	const void *bytes;
	int stored;

	assert_int_equal(exr_encoding_initialize(context, part, info, &pipeline), 0);
	for (int i = 0; i < pipeline.channel_count; i++) {
		exr_coding_channel_info_t *channel = &pipeline.channels[i];
		size_t each = bytes_of(shape->channel[i].sample);

		assert_string_equal(channel->channel_name, shape->channel[i].name);
		samples[i] = malloc(width * (size_t)info->height * each);
		assert_non_null(samples[i]);
		for (size_t at = 0; at < width * (size_t)info->height; at++)
			store_sample(shape, (size_t)i, x0 + (int)(at % width),
				y0 + (int)(at / width), samples[i] + at * each);
		channel->user_data_type = channel->data_type;
		channel->user_bytes_per_element = (int16_t)each;
		channel->user_pixel_stride = (int32_t)each;
		channel->user_line_stride = (int32_t)(width * each);
		channel->encode_from_ptr = samples[i];
	}
	assert_int_equal(exr_encoding_choose_default_routines(context, part, &pipeline), 0);
	pipeline.yield_until_ready_fn = NULL;
	pipeline.write_fn = NULL;
	assert_int_equal(exr_encoding_run(context, part, &pipeline), 0);
	stored = pipeline.compressed_bytes >= info->unpacked_size;
	bytes = stored ? pipeline.packed_buffer : pipeline.compressed_buffer;
	size = stored ? info->unpacked_size : pipeline.compressed_bytes;
	if (foreign->tile_width)
		assert_int_equal(
			exr_write_tile_chunk(context, part, info->start_x, info->start_y,
				info->level_x, info->level_y, bytes, size),
			0);
	else
		assert_int_equal(
			exr_write_scanline_chunk(context, part, info->start_y, bytes, size),
			0);
	for (int i = 0; i < pipeline.channel_count; i++)
		free(samples[i]);
	assert_int_equal(exr_encoding_destroy(context, &pipeline), 0);
}

static void
write_foreign_tiles(exr_context_t context, int part, const struct foreign *foreign)
{
	int32_t levels_x, levels_y;

	assert_int_equal(exr_get_tile_levels(context, part, &levels_x, &levels_y), 0);
	for (int level = 0; level < levels_x; level++) {
		int width = foreign->shape.width >> level,
		    height = foreign->shape.height >> level;
		int across = ((width ? width : 1) + foreign->tile_width - 1) /
			     foreign->tile_width;
		int down = ((height ? height : 1) + foreign->tile_height - 1) /
			   foreign->tile_height;

		for (int i = 0; i < across * down; i++) {
			exr_chunk_info_t info;

			assert_int_equal(
				exr_write_tile_chunk_info(context, part, i % across,
					i / across, level, level, &info),
				0);
			write_foreign_chunk(context, part, foreign, &info,
				i % across * foreign->tile_width,
				i / across * foreign->tile_height);
		}
	}
}

static void
write_foreign_lines(exr_context_t context, int part, const struct foreign *foreign)
{
	const struct shape *shape = &foreign->shape;
	int32_t lines;

	assert_int_equal(exr_get_scanlines_per_chunk(context, part, &lines), 0);
	for (int y = 0; y < shape->height; y += lines) {
		exr_chunk_info_t info;

		assert_int_equal(
			exr_write_scanline_chunk_info(context, part, shape->y0 + y, &info),
			0);
		write_foreign_chunk(context, part, foreign, &info, 0, y);
	}
}

/* Whether a table of chunks lies at bytes: ascending places, the first where it ends. */
static int
is_table(const unsigned char *bytes, size_t at, size_t size, uint64_t *table, size_t room,
	size_t *chunks)
{
	uint64_t first;

	memcpy(&first, bytes + at, 8);
	*chunks = (first - at) / 8;
	if (first <= at || first >= size || (first - at) % 8 != 0 || *chunks > room)
		return 0;
	memcpy(table, bytes + at, 8 * *chunks);
	for (size_t i = 1; i < *chunks; i++) {
		if (table[i] <= table[i - 1] || table[i] >= size)
			return 0;
	}
	return 1;
}

/* The library writes chunks by their numbers alone; here they change places in the file. */
static void
reorder_chunks(const char *path, exr_lineorder_t order)
{
	static const char line_order[] = "lineOrder\0lineOrder\0\1\0\0";
	size_t size, at, to, chunks, *chunk;
	unsigned char *bytes = file_bytes(path, &size), *copy = malloc(size);
	uint64_t table[256];
	FILE *stream = fopen(path, "wb");

	assert_true(copy && stream);
	for (at = 0; memcmp(bytes + at, line_order, sizeof line_order) != 0; at++)
		assert_true(at + 64 < size);
	bytes[at + sizeof line_order] = (unsigned char)order;
	while (!is_table(bytes, at, size, table, COUNT(table), &chunks))
		assert_true(++at + 8 < size);
	assert_true(chunks > 0);
	memcpy(copy, bytes, to = table[0]);
	chunk = malloc(chunks * sizeof *chunk);
	assert_non_null(chunk);
	for (size_t i = 0; i < chunks; i++) /* backwards, or the odd before the even */
		chunk[i] = order == EXR_LINEORDER_DECREASING_Y ? chunks - 1 - i
			   : i < chunks / 2                    ? 2 * i + 1
							       : 2 * (i - chunks / 2);
	for (size_t i = 0; i < chunks; i++) {
		size_t from = table[chunk[i]];
		size_t end = chunk[i] + 1 < chunks ? table[chunk[i] + 1] : size;
		uint64_t place = to;

		memcpy(copy + at + 8 * chunk[i], &place, 8);
		memcpy(copy + to, bytes + from, end - from);
		to += end - from;
	}
	assert_int_equal(to, size);
	assert_int_equal(fwrite(copy, 1, size, stream), size);
	assert_int_equal(fclose(stream), 0);
	free(chunk);
	free(bytes);
	free(copy);
}

static void
write_foreign(const char *path, const struct foreign *foreign, int parts)
{
	exr_context_initializer_t setup = EXR_DEFAULT_CONTEXT_INITIALIZER;
	exr_context_t context;
	int part;

	assert_int_equal(
		exr_start_write(&context, path, EXR_WRITE_FILE_DIRECTLY, &setup), 0);
	for (int i = 0; i < parts; i++)
		declare_part(context, &foreign[i], &part);
	assert_int_equal(exr_write_header(context), 0);
	for (int i = 0; i < parts; i++) {
		if (foreign[i].tile_width)
			write_foreign_tiles(context, i, &foreign[i]);
		else
			write_foreign_lines(context, i, &foreign[i]);
	}
	assert_int_equal(exr_finish(&context), 0);
	if (foreign->order != EXR_LINEORDER_INCREASING_Y)
		reorder_chunks(path, foreign->order);
}

/* From a file and from a pipe, in one block and in uneven ones. */
static void
compare_foreign(const char *path, const struct foreign *foreign, comparison *same)
{
	static const int uneven[] = {3, 20, 1, 17};

	compare_file(&foreign->shape, path, foreign->part, whole, 1, same);
	compare_file(&foreign->shape, path, foreign->part, uneven, COUNT(uneven), same);
	compare_pipe(&foreign->shape, path, foreign->part, whole, 1, same);
	compare_pipe(&foreign->shape, path, foreign->part, uneven, COUNT(uneven), same);
}

static void
test_foreign_scanlines(void **state)
{
	static const exr_lineorder_t orders[] = {
		EXR_LINEORDER_INCREASING_Y, EXR_LINEORDER_DECREASING_Y};
	struct fixture *fixture = *state;

	for (size_t c = 0; c < COUNT(compressions); c++) {
		for (int n = 0; n < 6; n++) {
			struct foreign foreign = {
				.shape = {.width = n == 5 ? 7 : 9 + n,
					.height = n == 5 ? 2 : 70,
					.x0 = -2,
					.y0 = n % 2 ? -11 : 6,
					.compression = compressions[c].number,
					.channels = COUNT(mixed)},
				.order = orders[n / 2 % 2],
			};
			comparison *same = choose_pattern(&foreign.shape, n);

			memcpy(foreign.shape.channel, mixed, sizeof mixed);
			write_foreign(fixture->path, &foreign, 1);
			compare_by_library(
				&foreign.shape, fixture->path, compressions[c].lines, same);
			compare_foreign(fixture->path, &foreign, same);
		}
	}
}

/* B44's blocks of 4x4 begin anew in each tile: its error is judged on scanlines. */
static void
test_foreign_tiles(void **state)
{
	static const int tiles[][2] = {{4, 4}, {16, 8}, {5, 7}, {64, 64}};
	static const exr_lineorder_t orders[] = {EXR_LINEORDER_INCREASING_Y,
		EXR_LINEORDER_DECREASING_Y, EXR_LINEORDER_RANDOM_Y};
	struct fixture *fixture = *state;

	for (size_t c = 0; c < COUNT(compressions); c++) {
		for (int n = 0; n < 12; n++) {
			struct foreign foreign = {
				.shape = {.width = 33,
					.height = 29,
					.x0 = n % 2 ? -5 : 3,
					.y0 = n % 2 ? 8 : -40,
					.compression = compressions[c].number,
					.channels = COUNT(mixed)},
				.tile_width = tiles[n % 4][0],
				.tile_height = tiles[n % 4][1],
				.order = orders[n % 3],
				.levels = n % 4 == 1 ? EXR_TILE_MIPMAP_LEVELS
						     : EXR_TILE_ONE_LEVEL,
			};
			comparison *same = choose_pattern(&foreign.shape, n / 4);

			if (same == within_b44)
				continue;
			memcpy(foreign.shape.channel, mixed, sizeof mixed);
			write_foreign(fixture->path, &foreign, 1);
			compare_foreign(fixture->path, &foreign, same);
		}
	}
}

static void
test_foreign_parts(void **state)
{
	static const char *const names[] = {"left", "right", "2"};
	struct fixture *fixture = *state;
	struct foreign foreign[3];
	struct spec_settings settings;
	struct spec_reader *reader;
	struct spec_error error;

	for (int i = 0; i < 3; i++) {
		foreign[i] = (struct foreign){
			.shape = {.width = 10 + i,
				.height = 40,
				.y0 = i,
				.pattern = NOISE,
				.compression =
					i == 1 ? EXR_COMPRESSION_PIZ : EXR_COMPRESSION_ZIP,
				.channels = i == 2 ? COUNT(numbers) : COUNT(mixed)},
			.part = names[i],
			.tile_width = i == 1 ? 8 : 0,
			.tile_height = i == 1 ? 8 : 0,
		};
		memcpy(foreign[i].shape.channel, i == 2 ? numbers : mixed,
			foreign[i].shape.channels * sizeof(struct channel));
	}
	write_foreign(fixture->path, foreign, 3);
	for (int i = 0; i < 3; i++)
		compare_foreign(fixture->path, &foreign[i], exactly);
	compare_file(&foreign[1].shape, fixture->path, "1", whole, 1, exactly);
	/* Two of them have bands: somebody must choose. */
	spec_settings_init(&settings);
	assert_int_equal(
		spec_reader_open(&reader, fixture->path, &settings, &error), SPEC_EUSAGE);
	settings.part = "middle";
	assert_int_equal(
		spec_reader_open(&reader, fixture->path, &settings, &error), SPEC_EUSAGE);
	settings.part = "3";
	assert_int_equal(
		spec_reader_open(&reader, fixture->path, &settings, &error), SPEC_EUSAGE);
	/* One of these has: it is the one. */
	write_foreign(fixture->path, foreign + 1, 2);
	compare_file(&foreign[1].shape, fixture->path, NULL, whole, 1, exactly);
	compare_pipe(&foreign[1].shape, fixture->path, NULL, whole, 1, exactly);
}

/* A band of whole numbers is numbers, whatever it is stored as. */
static void
test_bands_of_numbers(void **state)
{
	static const struct channel bands[] = {
		{"T.400,000000nm", SPEC_SAMPLE_UINT}, {"T.500,000000nm", SPEC_SAMPLE_UINT}};
	struct fixture *fixture = *state;
	struct foreign foreign = {.shape = {.width = 5, .height = 3, .channels = 2}};
	struct spec_reader *reader;
	struct spec_decoder *decoder;
	struct spec_error error;

	memcpy(foreign.shape.channel, bands, sizeof bands);
	write_foreign(fixture->path, &foreign, 1);
	reader = open_reader(fixture->path, NULL);
	check(spec_decoder_open(&decoder, reader, NULL, &error), &error);
	check(spec_decoder_fetch(decoder, 0, 3, &error), &error);
	check(spec_decoder_decode(decoder, &error), &error);
	assert_true(spec_decoder_row(decoder, 2, 1)[4] == 2004);
	spec_decoder_close(decoder);
	spec_reader_close(reader);
}

/* What we deflate, the library's zlib inflates, and takes apart as every reader does. */
static void
test_library_reads(void **state)
{
	struct fixture *fixture = *state;

	for (size_t c = 0; c < COUNT(compressions); c++) {
		for (int n = 0; n < 3; n++) {
			struct shape shape = {.width = 33,
				.height = 70,
				.y0 = -20,
				.compression = compressions[c].number,
				.channels = COUNT(mixed)};
			comparison *same = choose_pattern(&shape, n);

			memcpy(shape.channel, mixed, sizeof mixed);
			write_shape(&shape, fixture->path, 2);
			compare_by_library(
				&shape, fixture->path, compressions[c].lines, same);
		}
	}
}

/* Who does not ask for the message is told of the failure all the same. */
static void
test_no_message(void **state)
{
	static const unsigned char start[16] = {0x76, 0x2f, 0x31, 0x01, 2};
	char path[] = "/tmp/exr.XXXXXX";
	struct spec_settings settings;
	struct spec_reader *reader = NULL;
	int fd = mkstemp(path);

	(void)state;
	assert_true(fd >= 0);
	assert_int_equal(write(fd, start, sizeof start), sizeof start);
	assert_int_equal(close(fd), 0);
	spec_settings_init(&settings);
	assert_int_equal(spec_reader_open(&reader, path, &settings, NULL), SPEC_EFORMAT);
	assert_null(reader);
	unlink(path);
}

int
main(void)
{
	const struct CMUnitTest tests[] = {
		cmocka_unit_test(test_no_message),
		cmocka_unit_test(test_halves),
		cmocka_unit_test(test_half_rounding),
		cmocka_unit_test_setup_teardown(test_round_trips, set_up, tear_down),
		cmocka_unit_test_setup_teardown(test_windows_and_fields, set_up, tear_down),
		cmocka_unit_test_setup_teardown(test_far_windows, set_up, tear_down),
		cmocka_unit_test_setup_teardown(test_straddling_blocks, set_up, tear_down),
		cmocka_unit_test_setup_teardown(test_selection, set_up, tear_down),
		cmocka_unit_test_setup_teardown(test_threads, set_up, tear_down),
		cmocka_unit_test_setup_teardown(test_output_to_pipe, set_up, tear_down),
		cmocka_unit_test_setup_teardown(
			test_default_compression, set_up, tear_down),
		cmocka_unit_test_setup_teardown(test_missing_lines, set_up, tear_down),
		cmocka_unit_test_setup_teardown(test_attributes, set_up, tear_down),
		cmocka_unit_test_setup_teardown(test_empty_attributes, set_up, tear_down),
		cmocka_unit_test_setup_teardown(test_long_names, set_up, tear_down),
		cmocka_unit_test_setup_teardown(test_foreign_scanlines, set_up, tear_down),
		cmocka_unit_test_setup_teardown(test_foreign_tiles, set_up, tear_down),
		cmocka_unit_test_setup_teardown(test_foreign_parts, set_up, tear_down),
		cmocka_unit_test_setup_teardown(test_bands_of_numbers, set_up, tear_down),
		cmocka_unit_test_setup_teardown(test_library_reads, set_up, tear_down),
	};

	return cmocka_run_group_tests(tests, NULL, NULL);
}
