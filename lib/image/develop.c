#include "image/develop.h"

#include <math.h>
#include <stdint.h>
#include <stdlib.h>
#include <string.h>

#include "base/memory.h"
#include "base/vector.h"
#include "image/meter.h"
#include "image/stream.h"

struct development {
	const struct spec_rgb *rgb;
	struct spec_picture *picture;
	struct spec_finish finish;
	struct spec_meter *meter; /* or null: rows are finished as they come */
	struct spec_develop *result;
	size_t width, row_bytes;
	int y0;
};

/* A row's header in the stream, before its samples. */
struct row {
	long long nonfinite;
	int first_x;
	struct spec_meter_row measured; /* where there is a meter */
};

/* Of a float that is not finite all bits of the exponent are set. */
SPEC_VECTORISED static int
all_finite(const float *linear, size_t count)
{
	const uint32_t exponent = 0x7f800000;
	uint32_t bad = 0, bits;

	for (size_t i = 0; i < count; i++) {
		memcpy(&bits, &linear[i], sizeof bits);
		bad |= (bits & exponent) == exponent;
	}
	return !bad;
}

static void
find_nonfinite(const float *const linear[3], size_t width, struct row *row)
{
	*row = (struct row){0};
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

static enum spec_status
kernel(void *state, struct spec_stream_worker *worker, int line, struct spec_error *error)
{
	const struct development *development = state;
	size_t width = development->width;
	const float **plane = worker->scratch;
	float *sums = (float *)(void *)(plane + development->rgb->terms);
	float *const linear[3] = {sums, sums + width, sums + 2 * width};
	struct row *row = (struct row *)(void *)worker->payload;
	unsigned char *samples;

	for (size_t i = 0; i < development->rgb->terms; i++)
		plane[i] = spec_decoder_row(worker->decoder[0], development->y0 + line,
			development->rgb->channel[i]);
	spec_rgb_row(development->rgb, plane, width, linear[0], linear[1], linear[2]);
	find_nonfinite((const float *const *)linear, width, row);
	if (development->meter)
		return spec_meter_take(development->meter, worker->number, sums, line,
			&row->measured, error);
	samples = worker->payload + sizeof(struct row);
	spec_finish_expose(&development->finish, linear, width);
	spec_finish_encode(&development->finish, linear, width, line, samples);
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
		if (development->meter)
			spec_meter_add(development->meter, &row->measured);
		else
			status =
				spec_picture_write(development->picture, row + 1, 1, error);
	}
	return status;
}

/* The stream from the image to the picture, or to the meter. */
static enum spec_status
run(struct development *development, struct spec_reader *reader,
	const struct spec_settings *settings, struct spec_error *error)
{
	const struct spec_rgb *rgb = development->rgb;
	struct spec_stream stream = {
		.payload_bytes = sizeof(struct row) + development->row_bytes,
		.scratch_bytes = rgb->terms * sizeof(float *) +
				 3 * development->width * sizeof(float),
		.state = development,
		.kernel = kernel,
		.deliver = deliver};
	unsigned char *wanted =
		spec_stream_take(&stream, reader, rgb->channel, rgb->terms, error);
	enum spec_status status =
		wanted ? spec_stream_run(&stream, settings, error) : SPEC_ENOMEM;

	free(wanted);
	return status;
}

static enum spec_status
develop(struct development *development, const struct spec_look *look,
	enum spec_picture_sample sample, struct spec_reader *reader,
	const struct spec_settings *settings, struct spec_error *error)
{
	const struct spec_window *window = &spec_reader_image(reader)->data;
	size_t bytes = spec_picture_sample_bytes(sample);
	enum spec_status status = spec_finish_init(
		&development->finish, look, sample, development->rgb->white, error);

	development->y0 = window->y0;
	development->width = spec_window_width(window);
	if (status == SPEC_OK && spec_meter_wanted(look)) {
		bytes = 0; /* the meter keeps the samples */
		status = spec_meter_open(&development->meter, &development->finish,
			development->width, settings->threads, error);
	}
	/* Rounded up, so that the next row's header is aligned. */
	development->row_bytes = (3 * development->width * bytes + 7) / 8 * 8;
	if (status == SPEC_OK)
		status = run(development, reader, settings, error);
	if (status == SPEC_OK && development->meter)
		status = spec_meter_finish(
			development->meter, development->picture, settings, error);
	if (status == SPEC_OK)
		status = spec_picture_finish(development->picture, error);
	spec_meter_close(development->meter);
	return status;
}

enum spec_status
spec_develop_run(struct spec_develop *result, struct spec_reader *reader,
	const struct spec_rgb *rgb, const struct spec_look *look,
	struct spec_picture *picture, enum spec_picture_sample sample,
	const struct spec_settings *settings, struct spec_error *error)
{
	struct development *development =
		spec_memory_new(1, sizeof *development, "tables", error);
	enum spec_status status = SPEC_ENOMEM;

	*result = (struct spec_develop){0};
	if (development) {
		development->rgb = rgb;
		development->picture = picture;
		development->result = result;
		development->meter = NULL;
		status = develop(development, look, sample, reader, settings, error);
	}
	free(development);
	return status;
}
