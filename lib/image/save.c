#include "image/save.h"

#include "base/output.h"

static enum spec_status
write_lines(const struct spec_image *image, struct spec_stream *stream,
	const struct spec_settings *settings, struct spec_output *output,
	unsigned long long *overflows, struct spec_error *error)
{
	enum spec_status status = spec_writer_open(
		&stream->writer, image, output, settings->compression, error);

	if (status == SPEC_OK)
		status = spec_stream_run(stream, settings, error);
	if (status == SPEC_OK)
		status = spec_writer_finish(stream->writer, error);
	if (status == SPEC_OK)
		*overflows = spec_writer_overflows(stream->writer);
	spec_writer_close(stream->writer);
	stream->writer = NULL;
	return status;
}

enum spec_status
spec_image_save(const struct spec_image *image, struct spec_stream *stream,
	const struct spec_settings *settings, unsigned long long *overflows,
	struct spec_error *error)
{
	struct spec_output output;
	enum spec_status status = spec_output_open(&output, settings->output, error);

	*overflows = 0;
	if (status != SPEC_OK)
		return status;
	status = write_lines(image, stream, settings, &output, overflows, error);
	if (status == SPEC_OK)
		return spec_output_commit(&output, error);
	spec_output_abandon(&output);
	return status;
}
