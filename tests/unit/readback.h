/* A whole image's samples, as the reader gives them. */
#ifndef TESTS_UNIT_READBACK_H
#define TESTS_UNIT_READBACK_H

#include "image/reader.h"

#include "files.h"

struct readback {
	struct spec_reader *reader;
	const struct spec_image *image;
	float *value; /* [channel][line][pixel], channels in the image's order */
};

static inline void
readback_close(struct readback *back)
{
	spec_reader_close(back->reader);
	free(back->value);
	*back = (struct readback){0};
}

/* All lines of an open reader, so many at a time. */
static inline enum spec_status
readback_lines(struct readback *back, int block, struct spec_error *error)
{
	const struct spec_image *image = back->image;
	size_t width = spec_window_width(&image->data),
	       height = spec_window_height(&image->data);
	struct spec_decoder *decoder = NULL;
	enum spec_status status = spec_decoder_open(&decoder, back->reader, NULL, error);

	back->value = malloc(image->channels * width * height * sizeof(float));
	for (int y = image->data.y0; y < image->data.y1 && status == SPEC_OK; y += block) {
		int end = y + block < image->data.y1 ? y + block : image->data.y1;

		status = spec_decoder_fetch(decoder, y, end, error);
		if (status == SPEC_OK)
			status = spec_decoder_decode(decoder, error);
		for (int line = y; line < end && status == SPEC_OK; line++)
			for (size_t c = 0; c < image->channels; c++)
				memcpy(back->value +
						(c * height +
							(size_t)(line - image->data.y0)) *
							width,
					spec_decoder_row(decoder, line, c),
					width * sizeof(float));
	}
	spec_decoder_close(decoder);
	return status;
}

/* Opens a file of the scratch folder and reads all of it; to be closed unless it fails. */
static inline enum spec_status
readback(struct readback *back, const char *name, const struct spec_settings *settings,
	struct spec_error *error)
{
	enum spec_status status;
	char path[256];

	*back = (struct readback){0};
	snprintf(path, sizeof path, "%s/%s", scratch, name);
	status = spec_reader_open(&back->reader, path, settings, error);
	if (status != SPEC_OK)
		return status;
	back->image = spec_reader_image(back->reader);
	status = readback_lines(back, 2, error);
	if (status != SPEC_OK)
		readback_close(back);
	return status;
}

/* Of the band of that number, ascending by wavelength. */
static inline float
readback_at(const struct readback *back, size_t band, int x, int y)
{
	const struct spec_image *image = back->image;
	size_t width = spec_window_width(&image->data),
	       height = spec_window_height(&image->data);

	return back->value[(image->band_channel[band] * height + (size_t)y) * width +
			   (size_t)x];
}

/* A file that cannot be read: this status, and a message that has this part, in one line. */
static inline void
refuses(const char *name, const struct spec_settings *settings, enum spec_status wanted,
	const char *part)
{
	struct spec_error error = {0};
	struct readback back;
	enum spec_status status = readback(&back, name, settings, &error);

	if (status == SPEC_OK) {
		readback_close(&back);
		fail_msg("%s was read; wanted: %s", name, part);
	}
	if (status != wanted)
		fail_msg("%s: status %d instead of %d: %s", name, status, wanted,
			error.message);
	assert_contains(error.message, part);
	assert_null(strchr(error.message, '\n'));
}

/* A file that must be read; to be closed. */
static inline void
reads(struct readback *back, const char *name, const struct spec_settings *settings)
{
	struct spec_error error = {0};

	if (readback(back, name, settings, &error) != SPEC_OK)
		fail_msg("%s: %s", name, error.message);
}

#endif
