#include "image/develop.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "base/memory.h"
#include "colour/coordinates.h"
#include "colour/encode.h"
#include "image/stream.h"

struct development {
	const struct spec_rgb *rgb;
	const struct spec_look *look;
	struct spec_picture *picture;
	enum spec_picture_sample sample;
	struct spec_encoder encoder;
	struct spec_develop *result;
	size_t width, row_bytes;
	int y0;
};

/* A row's header in the stream, before its samples. */
struct row {
	long long nonfinite;
	int first_x;
};

static size_t
sample_bytes(enum spec_picture_sample sample)
{
	return sample == SPEC_PICTURE_U8 ? 1 : sample == SPEC_PICTURE_U16 ? 2 : 4;
}

/*
 * v - v is 0 for a finite v and NaN for every other; the sum finds a whole row
 * finite without a branch per pixel.
 */
static int
all_finite(const float *linear, size_t count)
{
	float sum = 0;

	for (size_t i = 0; i < count; i++)
		sum += linear[i] - linear[i];
	return sum == 0;
}

static void
find_nonfinite(const float *const linear[3], size_t width, struct row *row)
{
	*row = (struct row){0, 0};
	if (all_finite(linear[0], 3 * width)) /* the three rows follow one another */
		return;
	for (size_t x = 0; x < width; x++) {
		if (isfinite(linear[0][x]) && isfinite(linear[1][x]) &&
			isfinite(linear[2][x]))
			continue;
		if (row->nonfinite++ == 0)
			row->first_x = (int)x;
	}
}

static void
encode_row(const struct development *development, const float *const linear[3],
	unsigned char *samples)
{
	size_t width = development->width;

	for (size_t i = 0; i < 3; i++) {
		if (development->sample == SPEC_PICTURE_U8) {
			spec_encode8(
				&development->encoder, linear[i], width, samples + i, 3);
		} else if (development->sample == SPEC_PICTURE_U16) {
			spec_encode16(&development->encoder, linear[i], width,
				(uint16_t *)(void *)samples + i, 3);
		} else {
			float *to = (float *)(void *)samples + i;

			for (size_t x = 0; x < width; x++)
				to[3 * x] = linear[i][x];
		}
	}
}

static enum spec_status
kernel(void *state, struct spec_stream_worker *worker, int line, struct spec_error *error)
{
	const struct development *development = state;
	size_t width = development->width;
	const float **plane = worker->scratch;
	float *sums = (float *)(void *)(plane + development->rgb->terms);
	float *const linear[3] = {sums, sums + width, sums + 2 * width};

	(void)error;
	for (size_t i = 0; i < development->rgb->terms; i++)
		plane[i] = spec_decoder_row(worker->decoder[0], development->y0 + line,
			development->rgb->channel[i]);
	spec_rgb_row(development->rgb, plane, width, linear[0], linear[1], linear[2]);
	find_nonfinite(
		(const float *const *)linear, width, (struct row *)(void *)worker->payload);
	spec_coordinates_row(development->look->space->coordinates, development->rgb->white,
		linear, width);
	encode_row(development, (const float *const *)linear,
		worker->payload + sizeof(struct row));
	return SPEC_OK;
}

static enum spec_status
deliver(void *state, const unsigned char *payload, int line, int count,
	struct spec_error *error)
{
	struct development *development = state;
	size_t step = sizeof(struct row) + development->row_bytes;
	enum spec_status status = SPEC_OK;

	for (int i = 0; i < count && status == SPEC_OK; i++) {
		const struct row *row =
			(const struct row *)(const void *)(payload + i * step);

		if (row->nonfinite > 0 && development->result->nonfinite == 0) {
			development->result->first_x = row->first_x;
			development->result->first_y = line + i;
		}
		development->result->nonfinite += row->nonfinite;
		status = spec_picture_write(development->picture, row + 1, 1, error);
	}
	return status;
}

enum spec_status
spec_develop_run(struct spec_develop *result, struct spec_reader *reader,
	const struct spec_rgb *rgb, const struct spec_look *look,
	struct spec_picture *picture, enum spec_picture_sample sample,
	const struct spec_settings *settings, struct spec_error *error)
{
	const struct spec_image *image = spec_reader_image(reader);
	struct development *development =
		spec_memory_new(1, sizeof *development, "tables", error);
	unsigned char *wanted = spec_memory_new(image->channels, 1, "channels", error);
	struct spec_stream stream = {.reader = {reader}, .wanted = {wanted}, .readers = 1};
	enum spec_status status = SPEC_ENOMEM;

	*result = (struct spec_develop){0};
	if (development && wanted) {
		for (size_t i = 0; i < rgb->terms; i++)
			wanted[rgb->channel[i]] = 1;
		*development = (struct development){.rgb = rgb,
			.look = look,
			.picture = picture,
			.sample = sample,
			.result = result,
			.y0 = image->data.y0};
		development->width = spec_window_width(&image->data);
		/* Rounded up, so that the next row's header is aligned. */
		development->row_bytes =
			(3 * development->width * sample_bytes(sample) + 7) / 8 * 8;
		spec_encoder_init(&development->encoder, look->space->transfer
								 ? look->space->transfer
								 : &spec_transfer_linear);
		stream.first_line = image->data.y0;
		stream.lines = (int)spec_window_height(&image->data);
		stream.lines_in = 1;
		stream.payload_bytes = sizeof(struct row) + development->row_bytes;
		stream.scratch_bytes = rgb->terms * sizeof(float *) +
				       3 * development->width * sizeof(float);
		stream.state = development;
		stream.kernel = kernel;
		stream.deliver = deliver;
		status = spec_stream_run(&stream, settings, error);
	}
	if (status == SPEC_OK)
		status = spec_picture_finish(picture, error);
	free(development);
	free(wanted);
	return status;
}
