/* What the fuzz targets of images share: opening bytes, and looking at every sample. */
#ifndef TESTS_FUZZ_WALK_H
#define TESTS_FUZZ_WALK_H

#include <fcntl.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/mman.h>
#include <unistd.h>

#include "image/reader.h"

#include "fuzz.h"

#define PIPE_BYTES (1 << 20)

static inline void
settle(struct spec_settings *settings)
{
	spec_settings_init(settings);
	settings->limits = (struct spec_limits){
		.pixels = 1 << 16, .channels = 512, .header = 1 << 20, .memory = 32 << 20};
}

/* A descriptor to read the bytes from; a pipe holds them all, so nobody need feed it. */
static inline int
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

static inline struct spec_reader *
open_path(const char *path, const struct spec_settings *settings)
{
	struct spec_reader *reader;
	struct spec_error error = {0};

	if (spec_reader_open(&reader, path, settings, &error) == SPEC_OK)
		return reader;
	require(error.status != SPEC_OK && error.message[0], "a failure without a message");
	require(!strchr(error.message, '\n'), "a message of two lines");
	return NULL;
}

static inline struct spec_reader *
open_descriptor(int fd)
{
	struct spec_settings settings;
	char path[64];

	settle(&settings);
	snprintf(path, sizeof path, "/proc/self/fd/%d", fd);
	return open_path(path, &settings);
}

static inline uint64_t
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
static inline int
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

static inline void
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

#endif
