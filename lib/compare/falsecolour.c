#include "compare/falsecolour.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include "base/memory.h"
#include "base/output.h"
#include "image/legend.h"
#include "image/stream.h"

#define ALIGNMENT 64 /* bytes, of a view's scratch */

static char scratch_name[] = "a temporary file";

struct colouring {
	const struct spec_falsecolour_setup *setup;
	const struct spec_view *view;
	struct spec_picture *picture;
	enum spec_picture_sample sample;
	struct spec_falsecolour *result;
	size_t width, picture_width;
	size_t row_bytes; /* of what the stream delivers */
	int y0;
	int waits;                  /* the scale is to be found first */
	struct spec_output scratch; /* where numbers wait */
};

/* A row's header in the stream, before its samples or, where these must wait, its numbers. */
struct row {
	long long nonfinite;
	int first_x;
	float least, largest; /* of the finite numbers, or HUGE_VALF, -HUGE_VALF */
};

static struct spec_legend
legend_of(const struct spec_falsecolour_setup *setup, double low, double high)
{
	return (struct spec_legend){setup->map, low, high, setup->view->label, 1};
}

void
spec_falsecolour_size(const struct spec_falsecolour_setup *setup,
	const struct spec_image *image, size_t *width, size_t *height)
{
	struct spec_legend legend = legend_of(setup, 0, 1);

	*width = spec_window_width(&image->data);
	*height = spec_window_height(&image->data);
	if (!setup->legend)
		return;
	if (*width < SPEC_LEGEND_LEAST_WIDTH)
		*width = SPEC_LEGEND_LEAST_WIDTH;
	*height += spec_legend_height(&legend, *width);
}

/* --- samples --- */

/* Codes of 8 bits, encoded, as what the picture is given. */
static void
put_codes(
	enum spec_picture_sample sample, const unsigned char *code, size_t count, void *to)
{
	for (size_t i = 0; i < count; i++) {
		if (sample == SPEC_PICTURE_U8)
			((unsigned char *)to)[i] = code[i];
		else if (sample == SPEC_PICTURE_U16)
			((uint16_t *)to)[i] = (uint16_t)(257 * code[i]);
		else
			((float *)to)[i] = (float)spec_srgb_decode(code[i] / 255.);
	}
}

static void
put_share(enum spec_picture_sample sample, double share, void *to, size_t index)
{
	double clipped = fmin(fmax(share, 0), 1);

	if (sample == SPEC_PICTURE_U8)
		((unsigned char *)to)[index] = (unsigned char)lround(255 * clipped);
	else if (sample == SPEC_PICTURE_U16)
		((uint16_t *)to)[index] = (uint16_t)lround(65535 * clipped);
	else
		((float *)to)[index] = (float)share;
}

/* Three samples of a pixel. */
static void *
pixel_at(enum spec_picture_sample sample, void *row, size_t x)
{
	return (unsigned char *)row + 3 * x * spec_picture_sample_bytes(sample);
}

/* A row of numbers as the picture's samples, white beyond them. */
static void
colour_row(const struct colouring *colouring, const float *number, double low, double high,
	void *samples)
{
	const struct spec_view *view = colouring->view;
	static const unsigned char white[] = {255, 255, 255};
	size_t width = colouring->width;

	for (size_t x = 0; x < width; x++) {
		void *to = pixel_at(colouring->sample, samples, x);
		unsigned char rgb[3];
		double sum = number[x];

		for (size_t i = 1; i < view->numbers; i++)
			sum += number[i * width + x];
		if (view->numbers == 1 || !isfinite(sum)) {
			spec_colourmap_paint(colouring->setup->map, sum, low, high, rgb);
			put_codes(colouring->sample, rgb, 3, to);
			continue;
		}
		for (size_t i = 0; i < 3; i++)
			put_share(colouring->sample,
				i < view->terms
					? (number[i * width + x] - low) / (high - low)
					: 0,
				to, i);
	}
	for (size_t x = width; x < colouring->picture_width; x++)
		put_codes(colouring->sample, white, 3,
			pixel_at(colouring->sample, samples, x));
}

/* --- the stream --- */

static void
measure(const struct colouring *colouring, const float *number, struct row *row)
{
	const struct spec_view *view = colouring->view;
	size_t width = colouring->width;
	size_t parts = view->numbers == 1 ? 1 : view->terms;

	*row = (struct row){0, 0, HUGE_VALF, -HUGE_VALF};
	for (size_t x = 0; x < width; x++) {
		int finite = 1;

		for (size_t i = 0; i < parts; i++) {
			float here = number[i * width + x];

			if (!isfinite(here)) {
				finite = 0;
				continue;
			}
			row->least = here < row->least ? here : row->least;
			row->largest = here > row->largest ? here : row->largest;
		}
		if (!finite && row->nonfinite++ == 0)
			row->first_x = (int)x;
	}
}

static enum spec_status
kernel(void *state, struct spec_stream_worker *worker, int line, struct spec_error *error)
{
	const struct colouring *colouring = state;
	const struct spec_view *view = colouring->view;
	size_t terms =
		(view->terms * sizeof(float *) + ALIGNMENT - 1) / ALIGNMENT * ALIGNMENT;
	size_t scratch = spec_view_scratch(view, colouring->width);
	const float **row = worker->scratch;
	char *space = (char *)worker->scratch + terms;
	float *number = (float *)(void *)(space + (scratch + ALIGNMENT - 1) / ALIGNMENT *
							  ALIGNMENT);

	(void)error;
	for (size_t i = 0; i < view->terms; i++)
		row[i] = spec_decoder_row(
			worker->decoder[0], colouring->y0 + line, view->channel[i]);
	if (colouring->waits)
		number = (float *)(void *)(worker->payload + sizeof(struct row));
	spec_view_row(view, row, colouring->width, line, space, number);
	measure(colouring, number, (struct row *)(void *)worker->payload);
	if (!colouring->waits)
		colour_row(colouring, number, colouring->setup->low, colouring->setup->high,
			worker->payload + sizeof(struct row));
	return SPEC_OK;
}

static enum spec_status
deliver(void *state, const unsigned char *payload, int line, int count,
	struct spec_error *error)
{
	struct colouring *colouring = state;
	struct spec_falsecolour *result = colouring->result;
	size_t step = sizeof(struct row) + colouring->row_bytes;
	enum spec_status status = SPEC_OK;

	for (int i = 0; i < count && status == SPEC_OK; i++) {
		const struct row *row =
			(const struct row *)(const void *)(payload + (size_t)i * step);

		if (row->nonfinite > 0 && result->nonfinite == 0) {
			result->first_x = row->first_x;
			result->first_y = line + i;
		}
		result->nonfinite += row->nonfinite;
		result->low = fmin(result->low, row->least);
		result->high = fmax(result->high, row->largest);
		status =
			colouring->waits
				? spec_output_write(&colouring->scratch, row + 1,
					  colouring->view->numbers * colouring->width *
						  sizeof(float),
					  error)
				: spec_picture_write(colouring->picture, row + 1, 1, error);
	}
	return status;
}

static enum spec_status
stream(struct colouring *colouring, struct spec_reader *reader,
	const struct spec_settings *settings, struct spec_error *error)
{
	const struct spec_view *view = colouring->view;
	struct spec_stream stream = {
		.payload_bytes = sizeof(struct row) + colouring->row_bytes,
		.scratch_bytes = view->terms * sizeof(float *) +
				 spec_view_scratch(view, colouring->width) + 2 * ALIGNMENT +
				 view->numbers * colouring->width * sizeof(float),
		.state = colouring,
		.kernel = kernel,
		.deliver = deliver};
	unsigned char *wanted =
		spec_stream_take(&stream, reader, view->channel, view->terms, error);
	enum spec_status status =
		wanted ? spec_stream_run(&stream, settings, error) : SPEC_ENOMEM;

	free(wanted);
	return status;
}

/* --- after the last line --- */

/* The numbers that waited, now that the scale is known. */
static enum spec_status
colour_waiting(struct colouring *colouring, size_t lines, struct spec_error *error)
{
	size_t numbers = colouring->view->numbers * colouring->width;
	size_t bytes = numbers * sizeof(float);
	float *number = spec_memory_new(numbers, sizeof *number, "numbers", error);
	void *samples = spec_memory_new(3 * colouring->picture_width,
		spec_picture_sample_bytes(colouring->sample), "pixels", error);
	enum spec_status status = number && samples ? SPEC_OK : SPEC_ENOMEM;

	for (size_t line = 0; line < lines && status == SPEC_OK; line++) {
		status = spec_output_read(colouring->scratch.fd, number, bytes,
			(int64_t)(line * bytes), error);
		if (status != SPEC_OK)
			break;
		colour_row(colouring, number, colouring->result->low,
			colouring->result->high, samples);
		status = spec_picture_write(colouring->picture, samples, 1, error);
	}
	free(number);
	free(samples);
	return status;
}

static enum spec_status
add_legend(const struct colouring *colouring, struct spec_error *error)
{
	const struct spec_falsecolour_setup *setup = colouring->setup;
	struct spec_legend legend =
		legend_of(setup, colouring->result->low, colouring->result->high);
	size_t width = colouring->picture_width;
	size_t height = spec_legend_height(&legend, width);
	void *samples = spec_memory_new(
		3 * width, spec_picture_sample_bytes(colouring->sample), "pixels", error);
	struct spec_canvas canvas = {0};
	enum spec_status status =
		samples ? spec_canvas_open(&canvas, width, height, error) : SPEC_ENOMEM;

	if (status == SPEC_OK)
		spec_legend_draw(&legend, &canvas);
	for (size_t y = 0; y < height && status == SPEC_OK; y++) {
		put_codes(colouring->sample, spec_canvas_pixel(&canvas, 0, y), 3 * width,
			samples);
		status = spec_picture_write(colouring->picture, samples, 1, error);
	}
	spec_canvas_close(&canvas);
	free(samples);
	return status;
}

/* The scale that was found, or that which was asked for. */
static void
settle_scale(const struct colouring *colouring)
{
	struct spec_falsecolour *result = colouring->result;

	if (!colouring->waits) {
		result->low = colouring->setup->low;
		result->high = colouring->setup->high;
	} else if (!(result->low <= result->high)) { /* nothing is finite */
		result->low = 0;
		result->high = 1;
	} else if (result->low == result->high) {
		result->high = result->low + fmax(1, fabs(result->low));
	}
}

enum spec_status
spec_falsecolour_run(struct spec_falsecolour *result,
	const struct spec_falsecolour_setup *setup, struct spec_reader *reader,
	struct spec_picture *picture, enum spec_picture_sample sample,
	const struct spec_settings *settings, struct spec_error *error)
{
	const struct spec_image *image = spec_reader_image(reader);
	struct colouring colouring = {.setup = setup,
		.view = setup->view,
		.picture = picture,
		.sample = sample,
		.result = result,
		.width = spec_window_width(&image->data),
		.y0 = image->data.y0,
		.waits = setup->low == setup->high,
		.scratch = {.path = scratch_name, .fd = -1}};
	size_t height, bytes;
	enum spec_status status = SPEC_OK;

	*result = (struct spec_falsecolour){.low = HUGE_VAL, .high = -HUGE_VAL};
	spec_falsecolour_size(setup, image, &colouring.picture_width, &height);
	bytes = colouring.waits
			? setup->view->numbers * colouring.width * sizeof(float)
			: 3 * colouring.picture_width * spec_picture_sample_bytes(sample);
	/* Rounded up, so that the next row's header is aligned. */
	colouring.row_bytes = (bytes + 7) / 8 * 8;
	if (colouring.waits)
		status = spec_output_scratch(&colouring.scratch.fd, error);
	if (status == SPEC_OK)
		status = stream(&colouring, reader, settings, error);
	settle_scale(&colouring);
	if (status == SPEC_OK && colouring.waits)
		status =
			colour_waiting(&colouring, spec_window_height(&image->data), error);
	if (status == SPEC_OK && setup->legend)
		status = add_legend(&colouring, error);
	if (status == SPEC_OK)
		status = spec_picture_finish(picture, error);
	if (colouring.waits && colouring.scratch.fd >= 0)
		(void)close(colouring.scratch.fd);
	return status;
}
