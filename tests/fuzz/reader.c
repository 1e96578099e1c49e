/*
 * Fuzzes the reader: opens the bytes as an image, as a file or as a pipe, decodes every
 * line in blocks whose height does not fit the chunks, looks at every sample, and asks
 * for all that an image can say. Some of the images are written again and read back:
 * what could be read must come back bit for bit.
 *
 * The last byte of the input, which no image needs, chooses the way.
 */
#include <fcntl.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/mman.h>
#include <unistd.h>

#include "base/output.h"
#include "image/reader.h"
#include "image/writer.h"

#include "fuzz.h"

#define PIPE_BYTES (1 << 20)
#define WAY_PIPE 1
#define WAY_WRITE 2
#define WAY_SOME 4                        /* every other channel is wanted */
#define WAY_BLOCK(way) (1 + ((way) >> 3)) /* lines that are fetched together */

static void
settle(struct spec_settings *settings)
{
	spec_settings_init(settings);
	settings->limits = (struct spec_limits){
		.pixels = 1 << 16, .channels = 512, .header = 1 << 20, .memory = 32 << 20};
}

/* A descriptor to read the bytes from; a pipe holds them all, so nobody need feed it. */
static int
offer(const uint8_t *data, size_t size, int as_pipe)
{
	int end[2];

	if (as_pipe && pipe(end) == 0) {
		if (fcntl(end[1], F_SETPIPE_SZ, PIPE_BYTES) < (int)size)
			abort();
		require(write(end[1], data, size) == (ssize_t)size, "a short write");
		close(end[1]);
		return end[0];
	}
	end[0] = memfd_create("input", MFD_CLOEXEC);
	require(end[0] >= 0, "no memory file");
	require(write(end[0], data, size) == (ssize_t)size, "a short write");
	return end[0];
}

static struct spec_reader *
open_descriptor(int fd)
{
	struct spec_settings settings;
	struct spec_reader *reader;
	struct spec_error error = {0};
	char path[64];

	settle(&settings);
	snprintf(path, sizeof path, "/proc/self/fd/%d", fd);
	if (spec_reader_open(&reader, path, &settings, &error) == SPEC_OK)
		return reader;
	require(error.status != SPEC_OK && error.message[0], "a failure without a message");
	require(!strchr(error.message, '\n'), "a message of two lines");
	return NULL;
}

static uint64_t
mix(uint64_t sum, const float *row, size_t width)
{
	for (size_t x = 0; x < width; x++) {
		uint32_t bits;

		memcpy(&bits, row + x, sizeof bits);
		sum = (sum ^ bits) * 0x100000001b3U; /* FNV-1a's prime */
	}
	return sum;
}

/* Decodes all lines; 1, with the sum of their samples, if there was no error. */
static int
walk(struct spec_reader *reader, const unsigned char *wanted, int block, uint64_t *sum)
{
	const struct spec_image *image = spec_reader_image(reader);
	size_t width = spec_window_width(&image->data);
	struct spec_error error = {0};
	struct spec_decoder *decoder;
	enum spec_status status = spec_decoder_open(&decoder, reader, wanted, &error);

	*sum = 0;
	for (int y = image->data.y0; y < image->data.y1 && status == SPEC_OK; y += block) {
		int end = image->data.y1 - y < block ? image->data.y1 : y + block;

		status = spec_decoder_fetch(decoder, y, end, &error);
		if (status == SPEC_OK)
			status = spec_decoder_decode(decoder, &error);
		for (int line = y; line < end && status == SPEC_OK; line++) {
			for (size_t i = 0; i < image->channels; i++) {
				if (!wanted || wanted[i])
					*sum = mix(*sum, spec_decoder_row(decoder, line, i),
						width);
			}
		}
	}
	spec_decoder_close(decoder);
	require(status == SPEC_OK || error.message[0], "a failure without a message");
	return status == SPEC_OK;
}

static void
question(const struct spec_image *image)
{
	struct spec_image copy;
	char *quantity;

	for (size_t i = 0; i < image->bands * (size_t)image->stokes; i++)
		require(image->band_channel[i] < image->channels,
			"a band without a channel");
	for (size_t i = 1; i < image->bands; i++)
		require(image->wavelength_nm[i] > image->wavelength_nm[i - 1],
			"bands disordered");
	quantity = spec_image_quantity(image, NULL);
	free(quantity);
	if (spec_image_copy(&copy, image, NULL) != SPEC_OK)
		return;
	if (spec_image_index(&copy, "copy", NULL) == SPEC_OK)
		(void)spec_image_rename_bands(&copy, "copy", NULL);
	spec_image_clear(&copy);
}

/* Copies one line from a reader to a writer. */
static enum spec_status
pass_line(struct spec_decoder *decoder, struct spec_packer *packer,
	const struct spec_image *image, int y)
{
	float *const *plane;
	enum spec_status status = spec_decoder_fetch(decoder, y, y + 1, NULL);

	if (status == SPEC_OK)
		status = spec_decoder_decode(decoder, NULL);
	if (status == SPEC_OK)
		status = spec_packer_begin(packer, y, &plane, NULL);
	if (status != SPEC_OK)
		return status;
	for (size_t i = 0; i < image->channels; i++)
		memcpy(plane[i], spec_decoder_row(decoder, y, i),
			spec_window_width(&image->data) * sizeof(float));
	return spec_packer_end(packer, y, NULL);
}

static enum spec_status
pass(struct spec_reader *reader, struct spec_writer *writer)
{
	const struct spec_image *image = spec_reader_image(reader);
	struct spec_decoder *decoder = NULL;
	struct spec_packer *packer = NULL;
	enum spec_status status = spec_decoder_open(&decoder, reader, NULL, NULL);

	if (status == SPEC_OK)
		status = spec_packer_open(&packer, writer, NULL);
	for (int y = image->data.y0; y < image->data.y1 && status == SPEC_OK; y++)
		status = pass_line(decoder, packer, image, y);
	spec_decoder_close(decoder);
	spec_packer_close(packer); /* before the end: it uses the writer's context */
	return status == SPEC_OK ? spec_writer_finish(writer, NULL) : status;
}

/* Samples come as they are stored, but for bands of whole numbers, which are read as numbers. */
static int
is_written_as_read(const struct spec_image *image)
{
	for (size_t i = 0; i < image->channels; i++) {
		if (image->channel[i].sample == SPEC_SAMPLE_UINT &&
			image->channel[i].role != SPEC_ROLE_OTHER)
			return 0;
	}
	return 1;
}

/* Writes the image anew and reads that: the same samples. */
static void
write_back(struct spec_reader *reader, int way, uint64_t sum)
{
	const struct spec_image *image = spec_reader_image(reader);
	static char name[] = "output";
	struct spec_output output = {.path = name, .seekable = 1};
	struct spec_writer *writer;
	enum spec_status status;
	uint64_t again;

	if (!is_written_as_read(image))
		return;
	output.fd = memfd_create(name, MFD_CLOEXEC);
	require(output.fd >= 0, "no memory file");
	status = spec_writer_open(&writer, image, &output, way & WAY_SOME ? 3 : 0, NULL);
	if (status == SPEC_OK) {
		status = pass(reader, writer);
		spec_writer_close(writer);
	}
	if (status == SPEC_OK) {
		struct spec_reader *second = open_descriptor(output.fd);

		require(second != NULL, "what was written cannot be opened");
		require(walk(second, NULL, 7, &again), "what was written cannot be read");
		require(again == sum, "what was written is something else");
		spec_reader_close(second);
	}
	close(output.fd);
}

int
LLVMFuzzerTestOneInput(const uint8_t *data, size_t size)
{
	int way = size > 0 ? data[size - 1] : 0;
	int as_pipe = way & WAY_PIPE && size <= PIPE_BYTES;
	static unsigned char some[512];
	struct spec_reader *reader;
	uint64_t sum;
	int fd;

	for (size_t i = 0; i < sizeof some; i++)
		some[i] = i % 2;
	fd = offer(data, size, as_pipe);
	reader = open_descriptor(fd);
	if (reader) {
		int all = !(way & WAY_SOME) || way & WAY_WRITE;

		question(spec_reader_image(reader));
		if (walk(reader, all ? NULL : some, WAY_BLOCK(way), &sum) &&
			way & WAY_WRITE && !as_pipe)
			write_back(reader, way, sum);
		spec_reader_close(reader);
	}
	close(fd);
	return 0;
}
