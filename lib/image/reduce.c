#include "image/reduce.h"

#include <math.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "base/memory.h"
#include "image/layers.h"

/* How long the prefix of a layer is, such as "film1.", or 0. */
static size_t
prefix_length(const char *name, int *is_lamp)
{
	size_t length;

	*is_lamp = strncmp(name, "lamp", 4) == 0;
	if (!*is_lamp && strncmp(name, "film", 4) != 0)
		return 0;
	length = 4 + strspn(name + 4, "0123456789");
	return length > 4 && name[length] == '.' ? length + 1 : 0;
}

static size_t
find(const struct spec_image *input, const char *prefix, size_t length, const char *base)
{
	char name[256];
	size_t found;

	if (snprintf(name, sizeof name, "%.*s%s", (int)length, prefix, base) >=
		(int)sizeof name)
		return SPEC_LAYERS_NONE;
	found = spec_image_find_channel(input, name);
	return found < input->channels && input->channel[found].sample != SPEC_SAMPLE_UINT
		       ? found
		       : SPEC_LAYERS_NONE;
}

/* Whether base is VECTOR.X, .Y or .Z, of one of these vectors. */
static int
is_component(const char *base, const char *const *vector, size_t vectors)
{
	for (size_t i = 0; i < vectors; i++) {
		size_t length = strlen(vector[i]);

		if (strncmp(base, vector[i], length) == 0 && base[length] == '.' &&
			base[length + 1] >= 'X' && base[length + 1] <= 'Z' &&
			base[length + 2] == '\0')
			return 1;
	}
	return 0;
}

/* The three components of a vector of which name is one; 0: not all are there. */
static int
find_vector(const struct spec_image *input, const char *name, size_t source[3])
{
	size_t length = strlen(name) - 1;

	for (size_t i = 0; i < 3; i++) {
		char axis[2] = {(char)('X' + i), '\0'};

		source[i] = find(input, name, length, axis);
		if (source[i] == SPEC_LAYERS_NONE)
			return 0;
	}
	return 1;
}

static struct spec_reduce_channel
plan_channel(const struct spec_image *input, const struct spec_channel *channel)
{
	static const char *const directions[] = {"N", "Ns", "Tan", "I"};
	static const char *const means[] = {"P", "Q"}, *const lamp[] = {"D"};
	static const char *const scalars[] = {"u", "v", "cosine"};
	struct spec_reduce_channel plan = {.cover = SPEC_LAYERS_NONE};
	const char *name = channel->name;
	int is_lamp;
	size_t length = prefix_length(name, &is_lamp);
	const char *base = name + length;
	int direction = length > 0 && is_lamp ? is_component(base, lamp, 1)
					      : is_component(base, directions, 4);
	int mean = is_component(base, means, 2);

	plan.source[0] = spec_image_find_channel(input, name);
	for (size_t i = 0; i < sizeof scalars / sizeof *scalars; i++)
		mean |= strcmp(base, scalars[i]) == 0;
	if (channel->sample == SPEC_SAMPLE_UINT)
		plan.kind = SPEC_REDUCE_NUMBER;
	else if (direction && find_vector(input, name, plan.source))
		plan.kind = SPEC_REDUCE_VECTOR;
	else if (direction || mean)
		plan.kind = SPEC_REDUCE_WEIGHTED;
	if (plan.kind == SPEC_REDUCE_VECTOR)
		plan.component = name[strlen(name) - 1] - 'X';
	/* Lamps shine on the surface without a prefix. */
	if (direction || mean || strcmp(base, "id") == 0)
		plan.cover = find(input, name, is_lamp ? 0 : length, "cover");
	if (plan.kind == SPEC_REDUCE_WEIGHTED && plan.cover == SPEC_LAYERS_NONE)
		plan.kind = SPEC_REDUCE_PLAIN;
	return plan;
}

/* A number of a pixel, or of several alike. */
struct number {
	uint32_t value, place;
	double weight;
};

enum spec_status
spec_reduce_plan(struct spec_reduce *reduce, const struct spec_image *image,
	const struct spec_image *input, int n, unsigned char *wanted,
	struct spec_error *error)
{
	*reduce = (struct spec_reduce){.n = n};
	reduce->channel = spec_memory_new(
		image->channels, sizeof *reduce->channel, "channels", error);
	if (!reduce->channel)
		return SPEC_ENOMEM;
	for (size_t i = 0; i < image->channels; i++) {
		struct spec_reduce_channel *plan = &reduce->channel[i];

		if (image->channel[i].role != SPEC_ROLE_OTHER)
			continue;
		*plan = plan_channel(input, &image->channel[i]);
		if (plan->cover != SPEC_LAYERS_NONE)
			wanted[plan->cover] = 1;
		for (size_t j = 0; plan->kind == SPEC_REDUCE_VECTOR && j < 3; j++)
			wanted[plan->source[j]] = 1;
		if (plan->kind == SPEC_REDUCE_NUMBER)
			reduce->scratch_bytes =
				(size_t)n * (size_t)n * sizeof(struct number);
	}
	return SPEC_OK;
}

void
spec_reduce_free(struct spec_reduce *reduce)
{
	free(reduce->channel);
	*reduce = (struct spec_reduce){0};
}

static int
compare_numbers(const void *a, const void *b)
{
	const struct number *one = a, *two = b;

	if (one->value != two->value)
		return one->value < two->value ? -1 : 1;
	return one->place < two->place ? -1 : 1;
}

/* The value with the most weight; of several that lead, the one that came first. */
static uint32_t
most_frequent(struct number *number, size_t count)
{
	struct number best = {.weight = 0};

	qsort(number, count, sizeof *number, compare_numbers);
	for (size_t i = 0, run; i < count; i += run) {
		struct number group = number[i];

		for (run = 1; i + run < count && number[i + run].value == group.value;
			run++)
			group.weight += number[i + run].weight;
		if (group.weight > best.weight ||
			(group.weight == best.weight && group.weight > 0 &&
				group.place < best.place))
			best = group;
	}
	return best.value;
}

/* The lines of a channel that a line of the output is made of. */
static const float *
line_of(const struct spec_decoder *decoder, size_t channel, int y, size_t x)
{
	return channel == SPEC_LAYERS_NONE ? NULL
					   : spec_decoder_row(decoder, y, channel) + x;
}

static double
weight_of(const float *cover, size_t i)
{
	return !cover ? 1 : cover[i] > 0 ? (double)cover[i] : 0;
}

static void
reduce_numbers(const struct spec_reduce *reduce, const struct spec_decoder *decoder,
	const struct spec_reduce_channel *plan, int y, size_t x, size_t width, float *to,
	struct number *number)
{
	size_t n = (size_t)reduce->n;

	for (size_t i = 0; i < width; i++) {
		size_t count = 0;
		uint32_t value = 0;
		int equal = 1;

		for (size_t line = 0; line < n; line++) {
			size_t first = x + i * n;
			const float *from =
				line_of(decoder, plan->source[0], y + (int)line, first);
			const float *cover =
				line_of(decoder, plan->cover, y + (int)line, first);

			for (size_t j = 0; j < n; j++) {
				struct number next = {.place = (uint32_t)(line * n + j),
					.weight = weight_of(cover, j)};

				memcpy(&next.value, from + j, sizeof next.value);
				if (next.weight == 0)
					continue;
				equal &= count == 0 || next.value == number[0].value;
				number[count++] = next;
			}
		}
		if (count > 0)
			value = equal ? number[0].value : most_frequent(number, count);
		memcpy(to + i, &value, sizeof value);
	}
}

/* The weighted means of count channels over one pixel of the output. */
static void
average(const struct spec_reduce *reduce, const struct spec_decoder *decoder,
	const struct spec_reduce_channel *plan, int count, int y, size_t x, double mean[3])
{
	size_t n = (size_t)reduce->n;
	double total = 0;

	mean[0] = mean[1] = mean[2] = 0;
	for (size_t line = 0; line < n; line++) {
		const float *cover = line_of(decoder, plan->cover, y + (int)line, x);

		for (size_t j = 0; j < n; j++) {
			double weight = weight_of(cover, j);

			if (weight == 0)
				continue; /* what is there means nothing, and may be NaN */
			total += weight;
			for (int i = 0; i < count; i++)
				mean[i] += weight * line_of(decoder, plan->source[i],
							    y + (int)line, x)[j];
		}
	}
	for (int i = 0; i < count && total > 0; i++)
		mean[i] /= total;
}

void
spec_reduce_row(const struct spec_reduce *reduce, const struct spec_decoder *decoder,
	size_t channel, int y, size_t x, size_t width, float *to, void *scratch)
{
	const struct spec_reduce_channel *plan = &reduce->channel[channel];
	int count = plan->kind == SPEC_REDUCE_VECTOR ? 3 : 1;

	if (plan->kind == SPEC_REDUCE_NUMBER) {
		reduce_numbers(reduce, decoder, plan, y, x, width, to, scratch);
		return;
	}
	for (size_t i = 0; i < width; i++) {
		double mean[3], length;

		average(reduce, decoder, plan, count, y, x + i * (size_t)reduce->n, mean);
		length = sqrt(mean[0] * mean[0] + mean[1] * mean[1] + mean[2] * mean[2]);
		if (count == 3 && length > 0)
			mean[plan->component] /= length;
		to[i] = (float)mean[count == 3 ? plan->component : 0];
	}
}
