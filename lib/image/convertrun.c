/* The pixels of a conversion. */
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "base/vector.h"
#include "image/convert.h"
#include "image/save.h"
#include "spectrum/weights.h"

#define MOST_MIXED SPEC_WEIGHTS_MOST
#define RUN 1024 /* pixels at a time: a few rows of them, and sums, stay in the cache */

SPEC_VECTORISED static void
scale_row(float *restrict to, const float *restrict from, double weight, size_t count)
{
	for (size_t x = 0; x < count; x++)
		to[x] = (float)(weight * from[x]);
}

/* n is a number where this is inlined: the sum of a few rows stays in registers. */
static inline __attribute__((always_inline)) void
mix_rows(float *restrict to, const float *const *row, const double *weight, size_t n,
	size_t count)
{
	const float *from[MOST_MIXED];
	double part[MOST_MIXED];

	from[0] = row[0];
	part[0] = weight[0];
	for (size_t i = 1; i < n; i++) {
		from[i] = row[i];
		part[i] = weight[i];
	}
	for (size_t x = 0; x < count; x++) {
		double sum = part[0] * from[0][x];

		for (size_t i = 1; i < n; i++)
			sum += part[i] * from[i][x];
		to[x] = (float)sum;
	}
}

#define MIX(n)                                                                             \
	SPEC_VECTORISED static void mix_##n(float *restrict to, const float *const *row,   \
		const double *weight, size_t count)                                        \
	{                                                                                  \
		mix_rows(to, row, weight, n, count);                                       \
	}

/* clang-format off */
MIX(2)
MIX(3)
MIX(4)
MIX(5)
MIX(6)
/* clang-format on */

SPEC_VECTORISED static void
add_one(double *restrict sum, const float *restrict a, double wa, size_t count)
{
	for (size_t x = 0; x < count; x++)
		sum[x] += wa * a[x];
}

/* Four at a time: the sums are read and written a quarter as often. */
SPEC_VECTORISED static void
add_four(double *restrict sum, const float *restrict a, const float *restrict b,
	const float *restrict c, const float *restrict d, const double *restrict weight,
	size_t count)
{
	double wa = weight[0], wb = weight[1], wc = weight[2], wd = weight[3];

	for (size_t x = 0; x < count; x++)
		sum[x] = (((sum[x] + wa * a[x]) + wb * b[x]) + wc * c[x]) + wd * d[x];
}

SPEC_VECTORISED static void
store(float *restrict to, const double *restrict sum, size_t count)
{
	for (size_t x = 0; x < count; x++)
		to[x] = (float)sum[x];
}

/* Raises to a power; how many finite values that made NaN or infinite. */
SPEC_VECTORISED static unsigned long long
raise_values(double *restrict value, double power, size_t count)
{
	unsigned long long spoiled = 0;

	for (size_t x = 0; x < count && (power == 2 || power == .5); x++) {
		double raised = power == 2 ? value[x] * value[x] : sqrt(value[x]);

		spoiled += (raised - raised != 0) & (value[x] - value[x] == 0);
		value[x] = raised;
	}
	for (size_t x = 0; x < count && power != 2 && power != .5; x++) {
		double raised = spec_vector_pow(value[x], power);

		spoiled += (raised - raised != 0) & (value[x] - value[x] == 0);
		value[x] = raised;
	}
	return spoiled;
}

/* A NaN stays one. */
SPEC_VECTORISED static void
clamp_values(double *restrict value, double low, double high, size_t count)
{
	for (size_t x = 0; x < count; x++) {
		double bounded = value[x] < low ? low : value[x];

		value[x] = bounded > high ? high : bounded;
	}
}

SPEC_VECTORISED static void
move_values(double *restrict value, double factor, double addend, size_t count)
{
	for (size_t x = 0; x < count; x++)
		value[x] = value[x] * factor + addend;
}

static void
spoil(struct spec_convert *convert, unsigned long long count)
{
	if (count > 0) /* atomic, and so not for nothing */
		convert->spoiled += count;
}

/* The sum of a channel's terms over count <= RUN pixels from column x on, and its steps. */
static void
sum_run(struct spec_convert *convert, const struct spec_decoder *decoder, size_t channel,
	int y, size_t x, double *sum, size_t count)
{
	size_t t = convert->first[channel], end = convert->first[channel + 1];

	for (size_t i = 0; i < count; i++)
		sum[i] = convert->offset[channel];
	for (; t + 4 <= end; t += 4) {
		const float *row[4];

		for (size_t i = 0; i < 4; i++)
			row[i] = spec_decoder_row(decoder, y, convert->channel[t + i]) + x;
		add_four(sum, row[0], row[1], row[2], row[3], convert->weight + t, count);
	}
	for (; t < end; t++)
		add_one(sum, spec_decoder_row(decoder, y, convert->channel[t]) + x,
			convert->weight[t], count);
	for (size_t i = 0; i < convert->steps && convert->stepped[channel]; i++) {
		const struct spec_convert_step *step = &convert->step[i];
		const double *after = convert->after + (channel * convert->steps + i) * 2;

		if (step->raises)
			spoil(convert, raise_values(sum, step->power, count));
		else
			clamp_values(sum, step->low, step->high, count);
		if (after[0] != 1 || after[1] != 0)
			move_values(sum, after[0], after[1], count);
	}
}

/* Means of n x n pixels, of the values that the steps have made of each. */
static void
average_row(struct spec_convert *convert, const struct spec_decoder *decoder,
	size_t channel, int y, float *to, double *total)
{
	size_t width = spec_window_width(&convert->image.data),
	       n = (size_t)convert->downsample;
	double share = 1.0 / ((double)n * (double)n), sum[RUN];

	memset(total, 0, width * sizeof *total);
	for (size_t line = 0; line < n; line++) {
		size_t pixel = 0, within = 0;

		for (size_t x = 0; x < width * n; x += RUN) {
			size_t count = width * n - x < RUN ? width * n - x : RUN;

			sum_run(convert, decoder, channel, y + (int)line,
				(size_t)convert->x0 + x, sum, count);
			for (size_t i = 0; i < count; i++) {
				total[pixel] += sum[i];
				if (++within == n) {
					within = 0;
					pixel++;
				}
			}
		}
	}
	for (size_t x = 0; x < width; x++)
		to[x] = (float)(total[x] * share);
}

static void
mix_run(const struct spec_convert *convert, const struct spec_decoder *decoder,
	size_t first, size_t terms, int y, size_t x, float *to, size_t count)
{
	static void (*const mix[])(float *restrict, const float *const *, const double *,
		size_t) = {NULL, NULL, mix_2, mix_3, mix_4, mix_5, mix_6};
	const float *row[MOST_MIXED];

	for (size_t i = 0; i < terms; i++)
		row[i] = spec_decoder_row(decoder, y, convert->channel[first + i]) + x;
	mix[terms](to, row, convert->weight + first, count);
}

/* Count <= RUN pixels of a channel, from column x of the input on. */
static void
convert_run(struct spec_convert *convert, const struct spec_decoder *decoder,
	size_t channel, int y, size_t x, float *to, size_t count)
{
	size_t first = convert->first[channel], terms = convert->first[channel + 1] - first;
	int plain = convert->offset[channel] == 0 && !convert->stepped[channel];
	double sum[RUN];

	if (plain && terms == 1) {
		const float *from =
			spec_decoder_row(decoder, y, convert->channel[first]) + x;

		if (convert->weight[first] == 1)
			memcpy(to, from, count * sizeof *to); /* the bits of a NaN, too */
		else
			scale_row(to, from, convert->weight[first], count);
	} else if (plain && terms >= 2 && terms <= MOST_MIXED) {
		mix_run(convert, decoder, first, terms, y, x, to, count);
	} else {
		sum_run(convert, decoder, channel, y, x, sum, count);
		store(to, sum, count);
	}
}

static void
reduce_row(struct spec_convert *convert, const struct spec_stream_worker *worker,
	size_t channel, int y, float *to)
{
	const struct spec_decoder *decoder = worker->decoder[0];

	if (convert->reduce.channel[channel].kind == SPEC_REDUCE_PLAIN)
		average_row(convert, decoder, channel, y, to, worker->scratch);
	else
		spec_reduce_row(&convert->reduce, decoder, channel, y, (size_t)convert->x0,
			spec_window_width(&convert->image.data), to, worker->scratch);
}

/* By runs of pixels first: neighbouring bands are made of the same rows. */
static void
convert_line(struct spec_convert *convert, const struct spec_stream_worker *worker, int y,
	float *const *plane)
{
	size_t width = spec_window_width(&convert->image.data);
	size_t channels = convert->image.channels;

	for (size_t i = 0; i < channels && convert->downsample > 1; i++)
		reduce_row(convert, worker, i, y, plane[i]);
	for (size_t x = 0; x < width && convert->downsample == 1; x += RUN) {
		size_t count = width - x < RUN ? width - x : RUN;

		for (size_t i = 0; i < channels; i++)
			convert_run(convert, worker->decoder[0], i, y,
				(size_t)convert->x0 + x, plane[i] + x, count);
	}
}

static enum spec_status
kernel(void *state, struct spec_stream_worker *worker, int line, struct spec_error *error)
{
	struct spec_convert *convert = state;
	int y = convert->input->data.y0 + convert->y0 + line * convert->downsample;
	int y_out = convert->image.data.y0 + line;
	float *const *plane;
	enum spec_status status = spec_packer_begin(worker->packer, y_out, &plane, error);

	if (status != SPEC_OK)
		return status;
	convert_line(convert, worker, y, plane);
	return spec_packer_end(worker->packer, y_out, error);
}

enum spec_status
spec_convert_run(struct spec_convert *convert, struct spec_reader *reader,
	const struct spec_settings *settings, unsigned long long *overflows,
	struct spec_error *error)
{
	struct spec_stream stream = {
		.reader = {reader},
		.wanted = {convert->wanted},
		.readers = 1,
		.first_line = convert->input->data.y0 + convert->y0,
		.lines = (int)spec_window_height(&convert->image.data),
		.lines_in = convert->downsample,
		.state = convert,
		.kernel = kernel,
	};

	if (convert->downsample > 1) {
		size_t totals = spec_window_width(&convert->image.data) * sizeof(double);

		stream.scratch_bytes = convert->reduce.scratch_bytes > totals
					       ? convert->reduce.scratch_bytes
					       : totals;
	}
	return spec_image_save(&convert->image, &stream, settings, overflows, error);
}
