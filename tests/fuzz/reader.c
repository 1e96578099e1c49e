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

#include "walk.h"

#define WAY_PIPE 1
#define WAY_WRITE 2
#define WAY_SOME 4                        /* every other channel is wanted */
#define WAY_BLOCK(way) (1 + ((way) >> 3)) /* lines that are fetched together */

/* Copies one line from a reader to a writer. */
static enum spec_status
pass_line(struct spec_decoder *decoder, struct spec_packer *packer,
	const struct spec_image *image, int y)
{
	float *const *plane;
	enum spec_status status = spec_decoder_read(decoder, y, NULL);

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

	/* Other formats are formats.c's, or OpenImageIO's, which is not under test. */
	if (size >= 4 && memcmp(data, "\x76\x2f\x31\x01", 4) != 0)
		return 0;
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
