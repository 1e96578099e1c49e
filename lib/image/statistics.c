#include "image/statistics.h"

#include <float.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "base/memory.h"
#include "base/vector.h"
#include "image/stream.h"

#define LANES 16 /* sums side by side, in the order of the samples whatever the vectors */

struct lanes {
	float minimum[LANES], maximum[LANES];
	double sum[LANES];
	unsigned finite[LANES], nan[LANES], negative[LANES], above_one[LANES];
};

static inline void
take_samples(struct lanes *lanes, const float *sample, size_t count)
{
	for (size_t i = 0; i < count; i++) {
		float value = sample[i];
		int finite = fabsf(value) <= FLT_MAX;
		float low = finite ? value : FLT_MAX, high = finite ? value : -FLT_MAX;

		lanes->minimum[i] = low < lanes->minimum[i] ? low : lanes->minimum[i];
		lanes->maximum[i] = high > lanes->maximum[i] ? high : lanes->maximum[i];
		lanes->sum[i] += finite ? value : 0;
		lanes->finite[i] += finite;
		lanes->nan[i] += value != value;
		lanes->negative[i] += finite & (value < 0);
		lanes->above_one[i] += finite & (value > SPEC_STATISTICS_ONE);
	}
}

SPEC_VECTORISED static void
take_line(struct lanes *result, const float *row, size_t width)
{
	struct lanes lanes = *result;
	size_t x = 0;

	for (; x + LANES <= width; x += LANES)
		take_samples(&lanes, row + x, LANES);
	take_samples(&lanes, row + x, width - x);
	*result = lanes;
}

static inline void
take_squares(double *sum, const float *sample, size_t count, double mean)
{
	for (size_t i = 0; i < count; i++) {
		double off = fabsf(sample[i]) <= FLT_MAX ? sample[i] - mean : 0;

		sum[i] += off * off;
	}
}

SPEC_VECTORISED static void
sum_squares(double *result, const float *row, size_t width, double mean)
{
	double sum[LANES] = {0};
	size_t x = 0;

	for (; x + LANES <= width; x += LANES)
		take_squares(sum, row + x, LANES, mean);
	take_squares(sum, row + x, width - x, mean);
	memcpy(result, sum, sizeof sum);
}

static double
sum_lanes(const double *lane)
{
	double sum = 0;

	for (size_t i = 0; i < LANES; i++)
		sum += lane[i];
	return sum;
}

static int
is_infinite(float value)
{
	return isinf(value) != 0;
}

static int
is_nan(float value)
{
	return isnan(value) != 0;
}

static int
is_negative(float value)
{
	return isfinite(value) && value < 0;
}

static int
is_above_one(float value)
{
	return isfinite(value) && value > SPEC_STATISTICS_ONE;
}

/* Where the first of them is; odd samples are few, so it is looked for afterwards. */
static struct spec_statistics_kind
find_first(unsigned long long count, const float *row, int y, int (*is)(float value))
{
	struct spec_statistics_kind kind = {.count = count, .y = y};

	if (count == 0)
		return (struct spec_statistics_kind){0};
	while (!is(row[kind.x]))
		kind.x++;
	return kind;
}

void
spec_statistics_line(
	struct spec_statistics *statistics, const float *row, size_t width, int y)
{
	struct lanes lanes = {0};
	double squares[LANES];
	unsigned long long nan = 0, negative = 0, above_one = 0;

	*statistics = (struct spec_statistics){
		.samples = width, .minimum = FLT_MAX, .maximum = -FLT_MAX};
	for (size_t i = 0; i < LANES; i++) {
		lanes.minimum[i] = FLT_MAX;
		lanes.maximum[i] = -FLT_MAX;
	}
	take_line(&lanes, row, width);
	for (size_t i = 0; i < LANES; i++) {
		statistics->minimum = fminf(statistics->minimum, lanes.minimum[i]);
		statistics->maximum = fmaxf(statistics->maximum, lanes.maximum[i]);
		statistics->finite += lanes.finite[i];
		nan += lanes.nan[i];
		negative += lanes.negative[i];
		above_one += lanes.above_one[i];
	}
	statistics->nan = find_first(nan, row, y, is_nan);
	statistics->infinite =
		find_first(width - statistics->finite - nan, row, y, is_infinite);
	statistics->negative = find_first(negative, row, y, is_negative);
	statistics->above_one = find_first(above_one, row, y, is_above_one);
	if (statistics->finite > 0) {
		statistics->mean = sum_lanes(lanes.sum) / (double)statistics->finite;
		sum_squares(squares, row, width, statistics->mean);
		statistics->squares = sum_lanes(squares);
	}
}

static void
add_kind(struct spec_statistics_kind *total, const struct spec_statistics_kind *part)
{
	int earlier = part->y < total->y || (part->y == total->y && part->x < total->x);

	if (part->count > 0 && (total->count == 0 || earlier)) {
		total->x = part->x;
		total->y = part->y;
	}
	total->count += part->count;
}

void
spec_statistics_add(struct spec_statistics *total, const struct spec_statistics *part)
{
	double before = (double)total->finite, more = (double)part->finite, step;

	add_kind(&total->nan, &part->nan);
	add_kind(&total->infinite, &part->infinite);
	add_kind(&total->negative, &part->negative);
	add_kind(&total->above_one, &part->above_one);
	total->samples += part->samples;
	total->finite += part->finite;
	if (part->finite == 0)
		return;
	if (before == 0) {
		total->minimum = part->minimum;
		total->maximum = part->maximum;
	}
	total->minimum = fminf(total->minimum, part->minimum);
	total->maximum = fmaxf(total->maximum, part->maximum);
	step = part->mean - total->mean;
	total->squares += part->squares + step * step * (before * more / (before + more));
	total->mean += step * (more / (before + more));
}

double
spec_statistics_deviation(const struct spec_statistics *statistics)
{
	return statistics->finite > 0
		       ? sqrt(statistics->squares / (double)statistics->finite)
		       : NAN;
}

int
spec_statistics_applies(const struct spec_channel *channel)
{
	return channel->sample != SPEC_SAMPLE_UINT || channel->role != SPEC_ROLE_OTHER;
}

struct run {
	const struct spec_image *image;
	struct spec_statistics *result;
	size_t *channel; /* those that are measured */
	unsigned char *wanted;
	size_t channels;
};

static enum spec_status
measure_line(
	void *state, struct spec_stream_worker *worker, int line, struct spec_error *error)
{
	const struct run *run = state;
	struct spec_statistics *to = (void *)worker->payload;
	size_t width = spec_window_width(&run->image->data);

	(void)error;
	for (size_t i = 0; i < run->channels; i++)
		spec_statistics_line(&to[i],
			spec_decoder_row(worker->decoder[0], run->image->data.y0 + line,
				run->channel[i]),
			width, line);
	return SPEC_OK;
}

static enum spec_status
add_lines(void *state, const unsigned char *payload, int line, int count,
	struct spec_error *error)
{
	const struct run *run = state;
	const struct spec_statistics *from = (const void *)payload;

	(void)line;
	(void)error;
	for (int i = 0; i < count; i++) {
		for (size_t j = 0; j < run->channels; j++)
			spec_statistics_add(&run->result[run->channel[j]], from++);
	}
	return SPEC_OK;
}

enum spec_status
spec_statistics_run(struct spec_statistics *result, struct spec_reader *reader,
	const unsigned char *wanted, const struct spec_settings *settings,
	struct spec_error *error)
{
	const struct spec_image *image = spec_reader_image(reader);
	struct run run = {.image = image, .result = result};
	struct spec_stream stream = {.reader = {reader},
		.readers = 1,
		.first_line = image->data.y0,
		.lines = (int)spec_window_height(&image->data),
		.lines_in = 1,
		.state = &run,
		.kernel = measure_line,
		.deliver = add_lines};
	enum spec_status status = SPEC_ENOMEM;

	run.channel = spec_memory_new(image->channels, sizeof(size_t), "channels", error);
	run.wanted = spec_memory_new(image->channels, 1, "channels", error);
	if (run.channel && run.wanted) {
		for (size_t i = 0; i < image->channels; i++) {
			result[i] = (struct spec_statistics){0};
			run.wanted[i] =
				wanted[i] && spec_statistics_applies(&image->channel[i]);
			if (run.wanted[i])
				run.channel[run.channels++] = i;
		}
		stream.wanted[0] = run.wanted;
		stream.payload_bytes = run.channels * sizeof *result;
		status = spec_stream_run(&stream, settings, error);
	}
	free(run.channel);
	free(run.wanted);
	return status;
}
