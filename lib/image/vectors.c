#include "image/vectors.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "colour/transfer.h"
#include "image/save.h"

#define LONGEST_NAME 100

struct vectors {
	const struct spec_image *input;
	struct spec_image image;
	size_t from[3], to[3]; /* channels */
	int encoded;           /* light is to be codes again */
};

static enum spec_status
find_channels(struct vectors *vectors, const char *file, struct spec_error *error)
{
	static const char *const name[] = {"R", "G", "B"};

	for (size_t i = 0; i < 3; i++) {
		vectors->from[i] = spec_image_find_channel(vectors->input, name[i]);
		if (vectors->from[i] == vectors->input->channels)
			return spec_error_set(error, SPEC_EUNSUPPORTED,
				"%s: has no channel %s to make vectors of", file, name[i]);
		if (vectors->input->channel[vectors->from[i]].sample == SPEC_SAMPLE_UINT)
			return spec_error_set(error, SPEC_EUNSUPPORTED,
				"%s: its channel %s holds whole numbers, not codes", file,
				name[i]);
	}
	return SPEC_OK;
}

static enum spec_status
describe(struct vectors *vectors, const char *name, struct spec_error *error)
{
	static const char component[] = "XYZ";
	struct spec_image *image = &vectors->image;
	char channel[LONGEST_NAME + 3];
	enum spec_status status = SPEC_OK;

	if (*name == '\0' || strlen(name) > LONGEST_NAME)
		return spec_error_set(error, SPEC_EUSAGE,
			"the name of vectors has 1 to %d letters, such as N", LONGEST_NAME);
	image->data = vectors->input->data;
	image->display = vectors->input->display;
	image->pixel_aspect_ratio = vectors->input->pixel_aspect_ratio;
	image->screen_window_width = 1;
	for (size_t i = 0; i < 3 && status == SPEC_OK; i++) {
		snprintf(channel, sizeof channel, "%s.%c", name, component[i]);
		status = spec_image_add_channel(image, channel, SPEC_SAMPLE_FLOAT, error);
	}
	if (status == SPEC_OK)
		status = spec_image_index(image, name, error);
	for (size_t i = 0; i < 3 && status == SPEC_OK; i++) {
		snprintf(channel, sizeof channel, "%s.%c", name, component[i]);
		vectors->to[i] = spec_image_find_channel(image, channel);
	}
	return status;
}

static enum spec_status
kernel(void *state, struct spec_stream_worker *worker, int line, struct spec_error *error)
{
	const struct vectors *vectors = state;
	int y = vectors->input->data.y0 + line;
	float *const *out;
	enum spec_status status = spec_packer_begin(worker->packer, y, &out, error);

	for (size_t i = 0; i < 3 && status == SPEC_OK; i++) {
		const float *row =
			spec_decoder_row(worker->decoder[0], y, vectors->from[i]);

		for (size_t x = 0; x < spec_window_width(&vectors->input->data); x++) {
			double code = vectors->encoded ? spec_srgb_encode(row[x]) : row[x];

			out[vectors->to[i]][x] = (float)(2 * code - 1);
		}
	}
	return status == SPEC_OK ? spec_packer_end(worker->packer, y, error) : status;
}

static enum spec_status
run(struct vectors *vectors, struct spec_reader *reader,
	const struct spec_settings *settings, struct spec_error *error)
{
	struct spec_stream stream = {.state = vectors, .kernel = kernel};
	unsigned char *wanted = spec_stream_take(&stream, reader, vectors->from, 3, error);
	unsigned long long overflows;
	enum spec_status status = wanted ? spec_image_save(&vectors->image, &stream,
						   settings, &overflows, error)
					 : SPEC_ENOMEM;

	free(wanted);
	return status;
}

enum spec_status
spec_vectors_run(struct spec_reader *reader, const char *name,
	const struct spec_settings *settings, struct spec_error *error)
{
	struct vectors vectors = {.input = spec_reader_image(reader),
		.encoded = strcmp(spec_reader_format(reader), "OpenEXR") != 0};
	enum spec_status status = find_channels(&vectors, spec_reader_name(reader), error);

	if (status == SPEC_OK)
		status = describe(&vectors, name, error);
	if (status == SPEC_OK)
		status = spec_settings_record(settings, &vectors.image, error);
	if (status == SPEC_OK)
		status = run(&vectors, reader, settings, error);
	spec_image_clear(&vectors.image);
	return status;
}
