#include "image/save.h"

#include "base/output.h"

static enum spec_status
write_lines(struct spec_stream *stream, const struct spec_settings *settings,
	unsigned long long *overflows, struct spec_error *error)
{
	enum spec_status status = spec_stream_run(stream, settings, error);

	if (status == SPEC_OK)
		status = spec_writer_finish(stream->writer, error);
	if (status == SPEC_OK)
		*overflows = spec_writer_overflows(stream->writer);
	return status;
}

enum spec_status
spec_image_save(const struct spec_image *image, struct spec_stream *stream,
	const struct spec_settings *settings, unsigned long long *overflows,
	struct spec_error *error)
{
	const struct spec_writing_format *format;
	struct spec_output output;
	int opened = 0;
	enum spec_status status =
		spec_writer_choose(settings->output, settings->format, &format, error);

	*overflows = 0;
	if (status == SPEC_OK)
		status = spec_writer_check_settings(format, settings, error);
	if (status == SPEC_OK && !spec_writer_makes_files(format)) {
		status = spec_output_open(&output, settings->output, error);
		opened = status == SPEC_OK;
	}
	if (status == SPEC_OK)
		status = spec_writer_open_as(&stream->writer, format, image,
			opened ? &output : NULL, settings->output, settings->compression,
			error);
	if (status == SPEC_OK)
		status = write_lines(stream, settings, overflows, error);
	if (status == SPEC_OK && opened) {
		opened = 0;
		status = spec_output_commit(&output, error);
	}
	if (status == SPEC_OK)
		status = spec_writer_commit(stream->writer, error);
	spec_writer_close(stream->writer);
	stream->writer = NULL;
	if (opened)
		spec_output_abandon(&output);
	return status;
}
