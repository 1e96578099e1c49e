#include "compare/images.h"

#include <math.h>
#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "base/memory.h"
#include "colour/observer.h"
#include "image/stream.h"

#define SAME_NM 1e-3 /* edges of bins closer than this are the same */

/* The channels that are measured: A's and B's, pair by pair. */
struct pairs {
	size_t count;
	size_t *a, *b;
};

struct comparison {
	struct spec_images *result;
	const struct spec_image *a, *b;
	struct pairs bands, others;
	struct spec_measure_setup spectral_setup, others_setup;
	double *weight_xyz;
};

/* What a line's two measures are, as the stream carries them. */
struct row {
	struct spec_measure spectral, others;
	struct spec_whole whole;
};

static void __attribute__((format(printf, 2, 3)))
say(struct spec_images *result, const char *format, ...)
{
	static const char more[] = "... and more\n";
	size_t length = strlen(result->structure), room = sizeof result->structure - length;
	va_list arguments;
	int wanted;

	if (length >= sizeof more &&
		strcmp(result->structure + length - sizeof more + 1, more) == 0)
		return;
	va_start(arguments, format);
	wanted = vsnprintf(result->structure + length, room, format, arguments);
	va_end(arguments);
	spec_error_plain(
		result->structure + length); /* of the line break too: put it back */
	if (wanted > 0 && (size_t)wanted < room)
		result->structure[length + wanted - 1] = '\n';
	if (wanted < 0 || (size_t)wanted + sizeof more > room) /* whole lines or none */
		strcpy(result->structure + length, more);
}

static void
compare_windows(struct spec_images *result, const char *what, const struct spec_window *a,
	const struct spec_window *b)
{
	if (memcmp(a, b, sizeof *a) != 0)
		say(result, "%s windows differ: %d,%d,%d,%d and %d,%d,%d,%d\n", what, a->x0,
			a->y0, a->x1, a->y1, b->x0, b->y0, b->x1, b->y1);
}

static enum spec_status
compare_quantities(struct spec_images *result, const struct spec_image *a,
	const struct spec_image *b, int *same_scale, struct spec_error *error)
{
	char *one = spec_image_quantity(a, error), *two = spec_image_quantity(b, error);
	enum spec_status status = one && two ? SPEC_OK : SPEC_ENOMEM;

	if (status == SPEC_OK && (a->role != b->role || strcmp(one, two) != 0))
		say(result, "quantities differ: '%s' and '%s'\n", *one ? one : "no bands",
			*two ? two : "no bands");
	/* Values of bands and densities are not on one scale. */
	*same_scale =
		status == SPEC_OK && !strstr(one, "per band") == !strstr(two, "per band");
	free(one);
	free(two);
	return status;
}

static int
same_band(const struct spec_image *a, const struct spec_image *b, size_t i)
{
	int same;

	return spec_image_nearest_band(a, b->wavelength_nm[i], &same) == i && same;
}

/* Whether the bands can be paired. */
static int
compare_bands(
	struct spec_images *result, const struct spec_image *a, const struct spec_image *b)
{
	size_t i = 0;
	int paired = 0;

	if (a->role != b->role) {
		say(result, "bands differ: %zu and %zu, of different kinds\n", a->bands,
			b->bands);
		return 0;
	}
	if (a->stokes != b->stokes)
		say(result, "Stokes components differ: %d and %d\n", a->stokes, b->stokes);
	while (i < a->bands && i < b->bands && same_band(a, b, i))
		i++;
	if (i < a->bands && (i >= b->bands || a->wavelength_nm[i] < b->wavelength_nm[i]))
		say(result,
			"bands differ: %zu and %zu, the first has %g nm, the second has "
			"not\n",
			a->bands, b->bands, a->wavelength_nm[i]);
	else if (i < b->bands)
		say(result,
			"bands differ: %zu and %zu, the second has %g nm, the first has "
			"not\n",
			a->bands, b->bands, b->wavelength_nm[i]);
	else
		paired = a->stokes == b->stokes;
	if (paired && (a->edges_nm != NULL) != (b->edges_nm != NULL)) {
		say(result, "bands differ: one has bins, the other has point samples\n");
		return 0;
	}
	for (i = 0; paired && a->edges_nm && i <= a->bands; i++) {
		if (fabs(a->edges_nm[i] - b->edges_nm[i]) <= SAME_NM)
			continue;
		say(result, "bins differ: an edge at %g nm and at %g nm\n", a->edges_nm[i],
			b->edges_nm[i]);
		return 0;
	}
	return paired;
}

/* A band's whole numbers come out of the decoder as floats, others as they are. */
static int
is_whole(const struct spec_channel *channel)
{
	return channel->sample == SPEC_SAMPLE_UINT && channel->role == SPEC_ROLE_OTHER;
}

/* Whole numbers are no bands, even where neither image has any and all channels stand in. */
static int
is_other(const struct spec_image *image, size_t channel, int spectral)
{
	const struct spec_channel *it = &image->channel[channel];

	if (!spectral)
		return it->sample == SPEC_SAMPLE_UINT;
	return it->role == SPEC_ROLE_OTHER || it->role == SPEC_ROLE_BISPECTRAL;
}

/* Pairs by name the channels that are no bands (others 1), or those that stand in for bands. */
static enum spec_status
pair_channels(struct spec_images *result, const struct spec_image *a,
	const struct spec_image *b, int others, struct pairs *pairs,
	struct spec_error *error)
{
	int spectral = a->bands > 0 || b->bands > 0;

	pairs->a = spec_memory_new(a->channels, sizeof *pairs->a, "channels", error);
	pairs->b = spec_memory_new(a->channels, sizeof *pairs->b, "channels", error);
	if (!pairs->a || !pairs->b)
		return SPEC_ENOMEM;
	for (size_t i = 0; i < a->channels; i++) {
		size_t partner = spec_image_find_channel(b, a->channel[i].name);

		if (is_other(a, i, spectral) != others)
			continue;
		if (partner == b->channels) {
			say(result, "channel '%s' is only in the first\n",
				a->channel[i].name);
			continue;
		}
		if ((a->channel[i].sample == SPEC_SAMPLE_UINT) !=
			(b->channel[partner].sample == SPEC_SAMPLE_UINT))
			say(result, "channel '%s' holds whole numbers on one side\n",
				a->channel[i].name);
		pairs->a[pairs->count] = i;
		pairs->b[pairs->count++] = partner;
	}
	for (size_t i = 0; i < b->channels; i++) {
		if (is_other(b, i, spectral) == others &&
			spec_image_find_channel(a, b->channel[i].name) == a->channels)
			say(result, "channel '%s' is only in the second\n",
				b->channel[i].name);
	}
	return SPEC_OK;
}

static enum spec_status
pair_bands(const struct spec_image *a, const struct spec_image *b, struct pairs *pairs,
	struct spec_error *error)
{
	size_t count = a->bands * (size_t)a->stokes;

	pairs->a = spec_memory_new(count, sizeof *pairs->a, "bands", error);
	pairs->b = spec_memory_new(count, sizeof *pairs->b, "bands", error);
	if (!pairs->a || !pairs->b)
		return SPEC_ENOMEM;
	pairs->count = count;
	memcpy(pairs->a, a->band_channel, count * sizeof *pairs->a);
	memcpy(pairs->b, b->band_channel, count * sizeof *pairs->b);
	return SPEC_OK;
}

static enum spec_status
compare_structure(struct comparison *comparison, struct spec_error *error)
{
	struct spec_images *result = comparison->result;
	const struct spec_image *a = comparison->a, *b = comparison->b;
	int same_window = memcmp(&a->data, &b->data, sizeof a->data) == 0, same_scale;
	enum spec_status status;

	compare_windows(result, "data", &a->data, &b->data);
	compare_windows(result, "display", &a->display, &b->display);
	result->comparable = compare_bands(result, a, b) && same_window;
	status = compare_quantities(result, a, b, &same_scale, error);
	if (status != SPEC_OK)
		return status;
	result->comparable &= same_scale;
	status = pair_channels(result, a, b, 1, &comparison->others, error);
	if (status == SPEC_OK && a->bands == 0 && b->bands == 0)
		status = pair_channels(result, a, b, 0, &comparison->bands, error);
	else if (status == SPEC_OK && result->comparable)
		status = pair_bands(a, b, &comparison->bands, error);
	return status;
}

/* XYZ weights of S0's bands or of T's; the other Stokes components have none. */
static enum spec_status
plan_colour(struct comparison *comparison, const struct spec_images_setup *setup,
	struct spec_error *error)
{
	const struct spec_image *a = comparison->a;
	struct spec_bands bands = {a->bands, a->wavelength_nm, a->edges_nm, 0};
	const struct spec_curve *light =
		a->role == SPEC_ROLE_REFLECTIVE ? setup->illuminant : NULL;
	size_t count = comparison->bands.count;
	double outside,
		*weight = spec_memory_new(3 * a->bands, sizeof *weight, "bands", error);
	char *quantity = spec_image_quantity(a, error);
	enum spec_status status = weight && quantity ? SPEC_OK : SPEC_ENOMEM;

	comparison->weight_xyz = spec_memory_new(3 * count, sizeof *weight, "bands", error);
	if (!comparison->weight_xyz)
		status = SPEC_ENOMEM;
	bands.per_band = quantity && strstr(quantity, "per band") != NULL;
	free(quantity);
	if (status == SPEC_OK)
		status = spec_observer_weights(
			setup->observer, light, &bands, weight, &outside, error);
	for (size_t i = 0; i < 3 * a->bands && status == SPEC_OK; i++)
		comparison->weight_xyz[i / a->bands * count + i % a->bands] =
			weight[i] * exp2(setup->exposure);
	free(weight);
	if (status != SPEC_OK)
		return status;
	comparison->spectral_setup.weight_xyz = comparison->weight_xyz;
	comparison->result->coloured = 1;
	return spec_observer_white(setup->observer, setup->illuminant,
		comparison->spectral_setup.white_xyz, error);
}

static void
gather(const struct spec_stream_worker *worker, const struct pairs *pairs,
	const struct comparison *comparison, int line, const float **plane)
{
	for (size_t i = 0; i < pairs->count; i++) {
		plane[i] = spec_decoder_row(
			worker->decoder[0], comparison->a->data.y0 + line, pairs->a[i]);
		plane[pairs->count + i] = spec_decoder_row(
			worker->decoder[1], comparison->b->data.y0 + line, pairs->b[i]);
	}
}

static uint32_t
distance(uint32_t a, uint32_t b)
{
	return a > b ? a - b : b - a;
}

static void
compare_whole(const float *a, const float *b, size_t width, size_t channel, int y,
	struct spec_whole *whole)
{
	for (size_t x = 0; x < width; x++) {
		uint32_t one, two;

		memcpy(&one, a + x, sizeof one);
		memcpy(&two, b + x, sizeof two);
		if (one == two)
			continue;
		if (whole->differing++ == 0 ||
			distance(one, two) > distance(whole->a, whole->b)) {
			whole->a = one;
			whole->b = two;
			whole->x = x;
			whole->y = y;
			whole->channel = channel;
		}
	}
}

static void
add_whole(struct spec_whole *total, const struct spec_whole *row)
{
	unsigned long long before = total->differing;

	if (row->differing == 0)
		return;
	if (before == 0 || distance(row->a, row->b) > distance(total->a, total->b))
		*total = *row;
	total->differing = before + row->differing;
}

static void
measure_others(const struct comparison *comparison, const struct spec_stream_worker *worker,
	int line, const float **plane, struct row *row)
{
	const struct pairs *pairs = &comparison->others;
	size_t width = spec_window_width(&comparison->a->data);

	gather(worker, pairs, comparison, line, plane);
	spec_measure_clear(&row->others);
	row->whole = (struct spec_whole){0};
	for (size_t i = 0; i < pairs->count; i++) {
		const float *const *a = &plane[i], *const *b = &plane[pairs->count + i];
		struct spec_measure one;

		if (is_whole(&comparison->a->channel[pairs->a[i]])) {
			compare_whole(*a, *b, width, pairs->a[i], line, &row->whole);
			continue;
		}
		spec_measure_row(&comparison->others_setup, a, b, width, line, &one);
		one.difference.place.band = one.nonfinite_first.band = i;
		spec_measure_add(&row->others, &one);
	}
}

static enum spec_status
kernel(void *state, struct spec_stream_worker *worker, int line, struct spec_error *error)
{
	const struct comparison *comparison = state;
	size_t width = spec_window_width(&comparison->a->data);
	const float **plane = worker->scratch;
	struct row *row = (struct row *)(void *)worker->payload;

	(void)error;
	gather(worker, &comparison->bands, comparison, line, plane);
	spec_measure_clear(&row->spectral);
	if (comparison->bands.count > 0)
		spec_measure_row(&comparison->spectral_setup, plane,
			plane + comparison->bands.count, width, line, &row->spectral);
	measure_others(comparison, worker, line, plane, row);
	return SPEC_OK;
}

static enum spec_status
deliver(void *state, const unsigned char *payload, int line, int count,
	struct spec_error *error)
{
	struct comparison *comparison = state;
	const struct row *row = (const struct row *)(const void *)payload;

	(void)line;
	(void)error;
	for (int i = 0; i < count; i++) {
		spec_measure_add(&comparison->result->spectral, &row[i].spectral);
		spec_measure_add(&comparison->result->others, &row[i].others);
		add_whole(&comparison->result->whole, &row[i].whole);
	}
	return SPEC_OK;
}

/* From the place among the pairs to the channel of A. */
static void
name_channels(struct spec_measure *measure, const struct pairs *pairs)
{
	if (pairs->count == 0)
		return;
	measure->difference.place.band = pairs->a[measure->difference.place.band];
	measure->nonfinite_first.band = pairs->a[measure->nonfinite_first.band];
}

static enum spec_status
measure(struct comparison *comparison, struct spec_reader *a, struct spec_reader *b,
	const struct spec_settings *settings, struct spec_error *error)
{
	size_t planes = 2 * (comparison->bands.count + comparison->others.count);
	struct spec_stream stream = {
		.reader = {a, b},
		.readers = 2,
		.first_line = comparison->a->data.y0,
		.lines = (int)spec_window_height(&comparison->a->data),
		.lines_in = 1,
		.payload_bytes = sizeof(struct row),
		.scratch_bytes = planes * sizeof(float *),
		.state = comparison,
		.kernel = kernel,
		.deliver = deliver,
	};

	enum spec_status status = spec_stream_run(&stream, settings, error);

	comparison->result->bands = comparison->bands.count;
	name_channels(&comparison->result->spectral, &comparison->bands);
	name_channels(&comparison->result->others, &comparison->others);
	return status;
}

static void
free_pairs(struct pairs *pairs)
{
	free(pairs->a);
	free(pairs->b);
}

enum spec_status
spec_images_compare(struct spec_images *result, struct spec_reader *a,
	struct spec_reader *b, const struct spec_images_setup *setup,
	const struct spec_settings *settings, struct spec_error *error)
{
	struct comparison comparison = {
		.result = result, .a = spec_reader_image(a), .b = spec_reader_image(b)};
	enum spec_status status;

	*result = (struct spec_images){0};
	spec_measure_clear(&result->spectral);
	spec_measure_clear(&result->others);
	status = compare_structure(&comparison, error);
	comparison.spectral_setup.bands = comparison.bands.count;
	comparison.spectral_setup.want_angle = setup->want_angle;
	comparison.spectral_setup.peak = setup->peak;
	comparison.others_setup.bands = 1;
	if (status == SPEC_OK && result->comparable && setup->observer &&
		comparison.a->bands > 0)
		status = plan_colour(&comparison, setup, error);
	if (status == SPEC_ERANGE && setup->colour_optional)
		status = SPEC_OK;
	else if (status != SPEC_OK)
		spec_error_prefix(error, "%s", spec_reader_name(a));
	if (status == SPEC_OK && result->comparable &&
		comparison.bands.count + comparison.others.count > 0)
		status = measure(&comparison, a, b, settings, error);
	else
		result->comparable = 0;
	/* What was not looked at: the writer of a pipe must not be killed for that. */
	if (status == SPEC_OK && !result->comparable)
		status = spec_reader_drain(a, error);
	if (status == SPEC_OK && !result->comparable)
		status = spec_reader_drain(b, error);
	free_pairs(&comparison.bands);
	free_pairs(&comparison.others);
	free(comparison.weight_xyz);
	return status;
}
