/* Writing an OpenEXR file: its header and, for a stream, its chunk table beforehand. */
#include <errno.h>
#include <openexr.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include "base/memory.h"
#include "image/exr.h"
#include "image/exrwriting.h"

#define MOST_CHANNELS 32767 /* exr_add_channel takes more, and fails later */
#define SHORT_NAME 31       /* bytes; longer ones set the file's long-name flag */

/*
 * An uncompressed chunk has a known size: y and size, four bytes each, then the
 * lines. So the table can go out before the chunks that it points to.
 */
static enum spec_status
write_predicted_table(struct exr_writer *writer, struct spec_error *error)
{
	uint64_t at = writer->base.output->position + 8 * writer->base.chunks;

	writer->table = spec_memory_new(
		writer->base.chunks, sizeof *writer->table, "chunks", error);
	if (!writer->table)
		return SPEC_ENOMEM;
	writer->table_at = writer->base.output->position;
	for (size_t i = 0; i < writer->base.chunks; i++) {
		writer->table[i] = at;
		at += 8 +
		      writer->base.line_bytes * spec_writing_lines(&writer->base, (int)i);
	}
	return spec_output_write(
		writer->base.output, writer->table, 8 * writer->base.chunks, error);
}

static enum spec_status
write_stream(struct exr_writer *writer, const void *bytes, size_t size, uint64_t offset,
	struct spec_error *error)
{
	struct spec_output *output = writer->base.output;
	enum spec_status status = SPEC_OK;

	if (writer->table && offset == writer->table_at) {
		/* The table at the end: it must be the one that was predicted. */
		if (size == 8 * writer->base.chunks &&
			memcmp(bytes, writer->table, size) == 0)
			return SPEC_OK;
		return spec_error_set(error, SPEC_EFORMAT,
			"%s: the chunks are not where they were announced", output->path);
	}
	if (offset > (uint64_t)output->position && !writer->table)
		status = write_predicted_table(writer, error);
	if (status == SPEC_OK && offset != (uint64_t)output->position)
		status = spec_error_set(error, SPEC_EFORMAT,
			"%s: cannot go back in a stream", output->path);
	return status == SPEC_OK ? spec_output_write(output, bytes, size, error) : status;
}

static int64_t
write_bytes(exr_const_context_t context, void *data, const void *bytes, uint64_t size,
	uint64_t offset, exr_stream_error_func_ptr_t report)
{
	struct exr_writer *writer = data;
	struct spec_error error;
	enum spec_status status;

	(void)context;
	(void)report;
	if (writer->streaming)
		status = write_stream(writer, bytes, size, offset, &error);
	else
		status = spec_output_write_at(
			writer->scratched ? &writer->scratch : writer->base.output, bytes,
			size, (int64_t)offset, &error);
	if (status == SPEC_OK)
		return (int64_t)size;
	spec_exr_note(&error);
	return -1;
}

static enum spec_status
failed(const struct exr_writer *writer, exr_result_t result, struct spec_error *error)
{
	return spec_exr_error(result, writer->base.path, error);
}

static int
has_long_name(const struct spec_image *image)
{
	for (size_t i = 0; i < image->channels; i++) {
		if (strlen(image->channel[i].name) > SHORT_NAME)
			return 1;
	}
	for (size_t i = 0; i < image->attributes; i++) {
		if (strlen(image->attribute[i].name) > SHORT_NAME ||
			strlen(image->attribute[i].type) > SHORT_NAME)
			return 1;
	}
	return 0;
}

static exr_attr_box2i_t
box_of(const struct spec_window *window)
{
	exr_attr_box2i_t box;

	box.min.x = window->x0;
	box.min.y = window->y0;
	box.max.x = window->x1 - 1;
	box.max.y = window->y1 - 1;
	return box;
}

static exr_result_t
set_windows(struct exr_writer *writer, int part)
{
	const struct spec_image *image = writer->base.image;
	exr_attr_box2i_t data = box_of(&image->data), display = box_of(&image->display);
	exr_attr_v2f_t centre;

	centre.x = image->screen_window_x;
	centre.y = image->screen_window_y;
	return exr_initialize_required_attr(writer->context, part, &display, &data,
		image->pixel_aspect_ratio, &centre, image->screen_window_width,
		EXR_LINEORDER_INCREASING_Y, (exr_compression_t)writer->base.compression);
}

static enum spec_status
write_header(struct exr_writer *writer, struct spec_error *error)
{
	const struct spec_image *image = writer->base.image;
	exr_context_initializer_t setup = EXR_DEFAULT_CONTEXT_INITIALIZER;
	enum spec_status status;
	exr_result_t result;
	int part, lines;

	setup.error_handler_fn = spec_exr_report;
	setup.user_data = writer;
	setup.write_fn = write_bytes;
	spec_exr_forget();
	result = exr_start_write(
		&writer->context, writer->base.path, EXR_WRITE_FILE_DIRECTLY, &setup);
	if (result == EXR_ERR_SUCCESS && has_long_name(image))
		result = exr_set_longname_support(writer->context, 1);
	if (result == EXR_ERR_SUCCESS)
		result = exr_add_part(
			writer->context, image->part, EXR_STORAGE_SCANLINE, &part);
	if (result == EXR_ERR_SUCCESS)
		result = set_windows(writer, part);
	for (size_t i = 0; i < image->channels && result == EXR_ERR_SUCCESS; i++)
		result = exr_add_channel(writer->context, part, image->channel[i].name,
			(exr_pixel_type_t)image->channel[i].sample,
			image->channel[i].linear ? EXR_PERCEPTUALLY_LINEAR
						 : EXR_PERCEPTUALLY_LOGARITHMIC,
			1, 1);
	if (result != EXR_ERR_SUCCESS)
		return failed(writer, result, error);
	status = spec_exr_set_attributes(
		writer->context, part, image, writer->base.path, error);
	if (status != SPEC_OK)
		return status;
	result = exr_write_header(writer->context);
	if (result == EXR_ERR_SUCCESS)
		result = exr_get_scanlines_per_chunk(writer->context, part, &lines);
	if (result != EXR_ERR_SUCCESS)
		return failed(writer, result, error);
	writer->base.chunk_lines = lines;
	writer->base.chunks = (spec_window_height(&image->data) + lines - 1) / lines;
	return SPEC_OK;
}

static enum spec_status
settle_output(struct exr_writer *writer, struct spec_error *error)
{
	struct spec_output *output = writer->base.output;
	int compression = writer->base.compression;

	if (output->terminal)
		return spec_error_set(error, SPEC_EUSAGE,
			"refusing to write an image to a terminal; use -o FILE or a pipe");
	if (writer->base.image->channels > MOST_CHANNELS)
		return spec_error_set(error, SPEC_ERANGE,
			"%s: %zu channels are more than %d", output->path,
			writer->base.image->channels, MOST_CHANNELS);
	if (compression < 0)
		compression = output->seekable ? EXR_COMPRESSION_ZIP : EXR_COMPRESSION_NONE;
	writer->base.compression = compression;
	writer->streaming = !output->seekable && compression == EXR_COMPRESSION_NONE;
	if (!output->seekable && !writer->streaming) {
		writer->scratch.path = output->path;
		if (spec_output_scratch(&writer->scratch.fd, error) != SPEC_OK)
			return error ? error->status : SPEC_EIO;
		writer->scratched = 1;
	}
	return SPEC_OK;
}

static enum spec_status
open_writer(struct spec_writer *base, struct spec_error *error)
{
	struct exr_writer *writer = (struct exr_writer *)base;
	enum spec_status status = settle_output(writer, error);

	return status == SPEC_OK ? write_header(writer, error) : status;
}

static enum spec_status
finish(struct spec_writer *base, struct spec_error *error)
{
	struct exr_writer *writer = (struct exr_writer *)base;

	/* The table went out with the last chunk; packers still need the context. */
	return writer->scratched
		       ? spec_output_append(base->output, writer->scratch.fd, error)
		       : SPEC_OK;
}

static void
close_writer(struct spec_writer *base)
{
	struct exr_writer *writer = (struct exr_writer *)base;

	if (writer->context)
		exr_finish(&writer->context);
	if (writer->scratched)
		close(writer->scratch.fd);
	free(writer->table);
}

const struct spec_writing_format spec_writing_exr = {
	.name = "exr",
	.suffixes = ".exr",
	.writer_bytes = sizeof(struct exr_writer),
	.packer_bytes = sizeof(struct exr_packer),
	.open = open_writer,
	.open_packer = exr_open_packer,
	.encode = exr_encode,
	.write = exr_write,
	.finish = finish,
	.close_packer = exr_close_packer,
	.close = close_writer,
};
