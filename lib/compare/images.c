#include "compare/images.h"

#include <math.h>
#include <stdint.h>
#include <stdlib.h>
#include <string.h>

#include "base/memory.h"
#include "compare/comparing.h"
#include "image/stream.h"

/* What a line's measures are, as the stream carries them; what is wanted of the bands and of
 * the tiles follows it. */
struct row {
	struct spec_measure spectral, others;
	struct spec_whole whole;
	struct spec_exact exact;
};

/* A worker's room, cut out of its scratch. */
struct room {
	const float **plane; /* [2 * pairs]: A's, then B's */
	size_t *pixel;       /* [width] that count */
	float *samples;      /* [2 * bands * width], where rows are made */
};

struct mask {
	int decoder;
	size_t channel;
	int y0;
	const struct spec_matte *matte;
	int whole; /* its bits are a whole number */
};

struct run {
	struct spec_comparing comparing;
	struct mask mask; /* matte is null: none */
	size_t width;     /* of the region */
	size_t planes;
};

static size_t
round_up(size_t bytes)
{
	return (bytes + 63) / 64 * 64;
}

static struct room
cut_room(const struct run *run, void *scratch)
{
	char *at = scratch;
	struct room room;

	room.plane = (const float **)(void *)at;
	at += round_up(run->planes * sizeof *room.plane);
	room.pixel = (size_t *)(void *)at;
	at += round_up(run->width * sizeof *room.pixel);
	room.samples = (float *)(void *)at;
	return room;
}

static int
makes_rows(const struct run *run)
{
	return run->mask.matte || run->comparing.sums[0].first;
}

static size_t
room_bytes(const struct run *run)
{
	size_t rows = makes_rows(run) ? run->planes : 0;

	return round_up(run->planes * sizeof(float *)) +
	       round_up(run->width * sizeof(size_t)) + rows * run->width * sizeof(float);
}

/* The pixels of the line that count; returns how many. */
static size_t
choose_pixels(const struct run *run, const struct spec_stream_worker *worker, int line,
	size_t *pixel)
{
	const struct mask *mask = &run->mask;
	const float *row;
	size_t count = 0;

	if (!mask->matte) {
		for (size_t x = 0; x < run->width; x++)
			pixel[x] = x;
		return run->width;
	}
	row = spec_decoder_row(worker->decoder[mask->decoder],
		      mask->y0 + run->comparing.region.y0 + line, mask->channel) +
	      run->comparing.region.x0;
	for (size_t x = 0; x < run->width; x++) {
		uint32_t number;

		memcpy(&number, row + x, sizeof number);
		if (mask->matte->equals ? number == mask->matte->number
			: mask->whole   ? number != 0
					: row[x] > 0)
			pixel[count++] = x;
	}
	return count;
}

static const float *
row_of(const struct run *run, const struct spec_stream_worker *worker, int side, int line,
	size_t channel)
{
	const struct spec_image *image = side ? run->comparing.b : run->comparing.a;

	return spec_decoder_row(worker->decoder[side],
		       image->data.y0 + run->comparing.region.y0 + line, channel) +
	       run->comparing.region.x0;
}

/* The samples of the pixels that count, of a channel as it is. */
static const float *
take_row(const struct run *run, const float *row, const size_t *pixel, size_t count,
	float *samples)
{
	if (!run->mask.matte)
		return row;
	for (size_t i = 0; i < count; i++)
		samples[i] = row[pixel[i]];
	return samples;
}

/* The same of a sum of channels. */
static const float *
sum_row(const struct run *run, const struct spec_stream_worker *worker, int side, int line,
	size_t band, const size_t *pixel, size_t count, float *samples)
{
	const struct spec_comparing_sums *sums = &run->comparing.sums[side];

	for (size_t i = 0; i < count; i++) {
		double sum = 0;

		for (size_t k = sums->first[band]; k < sums->first[band + 1]; k++)
			sum += sums->weight[k] *
			       row_of(run, worker, side, line, sums->channel[k])[pixel[i]];
		samples[i] = (float)sum;
	}
	return samples;
}

static void
gather(const struct run *run, const struct spec_stream_worker *worker,
	const struct spec_comparing_pairs *pairs, int summed, int line, size_t count,
	const struct room *room)
{
	float *samples = room->samples;

	for (size_t i = 0; i < 2 * pairs->count; i++) {
		int side = i >= pairs->count;
		size_t at = side ? i - pairs->count : i;

		if (summed) {
			room->plane[i] = sum_row(
				run, worker, side, line, at, room->pixel, count, samples);
		} else {
			const size_t *channel = side ? pairs->b : pairs->a;

			room->plane[i] =
				take_row(run, row_of(run, worker, side, line, channel[at]),
					room->pixel, count, samples);
		}
		if (makes_rows(run))
			samples += run->width;
	}
}

static void
measure_others(const struct run *run, const struct spec_stream_worker *worker, int line,
	int y, size_t count, const struct room *room, struct row *row)
{
	const struct spec_comparing *comparing = &run->comparing;
	const struct spec_comparing_pairs *pairs = &comparing->others;

	gather(run, worker, pairs, 0, line, count, room);
	spec_measure_clear(&row->others);
	for (size_t i = 0; i < pairs->count; i++) {
		const float *const *a = &room->plane[i];
		const float *const *b = &room->plane[pairs->count + i];
		struct spec_measure one;

		if (spec_comparing_is_whole(&comparing->a->channel[pairs->a[i]])) {
			spec_comparing_whole_row(
				*a, *b, count, pairs->a[i], y, &row->whole);
			continue;
		}
		spec_measure_row(&comparing->others_setup, a, b, count, y, &one);
		one.difference.place.band = one.nonfinite_first.band = i;
		spec_measure_add(&row->others, &one);
	}
	if (comparing->setup->exact)
		spec_comparing_exact_row(pairs, room->plane, count, y, &row->exact);
}

static void
place_pixel(struct spec_measure_place *place, const size_t *pixel, size_t corner)
{
	place->x = pixel[place->x] + corner;
}

/* From the place among the pixels that count to that from the window's corner. */
static void
place_pixels(struct spec_measure *measure, const size_t *pixel, size_t count, size_t corner)
{
	if (count == 0)
		return;
	place_pixel(&measure->nonfinite_first, pixel, corner);
	place_pixel(&measure->difference.place, pixel, corner);
	place_pixel(&measure->angle_most.place, pixel, corner);
	place_pixel(&measure->fit_least.place, pixel, corner);
	place_pixel(&measure->colour_most.place, pixel, corner);
}

/* The maps' rows, first without gaps, then each value in its place. */
static void
fill_maps(const struct run *run, const struct room *room, int line, size_t count,
	struct spec_detail_band *band)
{
	const struct spec_comparing *comparing = &run->comparing;
	size_t bands = comparing->bands.count;
	float *map[SPEC_DETAIL_PIXELS];

	for (int kind = 0; kind < SPEC_DETAIL_PIXELS; kind++) {
		map[kind] = comparing->result->map[kind];
		if (map[kind])
			map[kind] += (size_t)line * run->width;
	}
	spec_detail_row(&comparing->spectral_setup, comparing->setup->maps, room->plane,
		room->plane + bands, count, map, band);
	for (int kind = 0; kind < SPEC_DETAIL_PIXELS; kind++) {
		size_t from = count;

		for (size_t x = run->width; x-- > 0 && map[kind] && run->mask.matte;) {
			int counts = from > 0 && room->pixel[from - 1] == x;

			map[kind][x] = counts ? map[kind][--from] : NAN;
		}
	}
}

/* The colours of the pixels that count; of the others NaN. */
static void
fill_seen(const struct run *run, const struct room *room, int side, int line, size_t count)
{
	const struct spec_comparing *comparing = &run->comparing;
	size_t bands = comparing->bands.count;
	float *seen = comparing->result->seen[side] + 3 * (size_t)line * run->width;

	for (size_t x = 0; x < 3 * run->width; x++)
		seen[x] = NAN;
	for (size_t i = 0; i < count; i++) {
		for (size_t c = 0; c < 3; c++) {
			const double *weight = comparing->weight_xyz + c * bands;
			double sum = 0;

			for (size_t k = 0; k < bands; k++) {
				float here = room->plane[(size_t)side * bands + k][i];

				sum += isfinite(here) ? weight[k] * here : 0;
			}
			seen[3 * room->pixel[i] + c] = (float)sum;
		}
	}
}

/* A line's sums for the test of significance, behind those of the bands. */
static size_t
band_bytes(const struct run *run)
{
	size_t bands = run->comparing.setup->want_bands ? run->comparing.bands.count : 0;

	return bands * sizeof(struct spec_detail_band);
}

static void
fill_test(const struct run *run, const struct spec_stream_worker *worker, int line,
	size_t count, const struct room *room, struct spec_significance_sums *sums)
{
	const struct spec_comparing *comparing = &run->comparing;
	size_t bands = comparing->bands.count;
	int known = comparing->variances.count > 0;
	struct room rest = *room;

	rest.plane += 2 * bands;
	rest.samples += makes_rows(run) ? 2 * bands * run->width : 0;
	if (known)
		gather(run, worker, &comparing->variances, 0, line, count, &rest);
	spec_significance_row(bands, run->width, room->plane, room->plane + bands,
		known ? rest.plane : NULL, known ? rest.plane + bands : NULL, room->pixel,
		count, sums);
}

static enum spec_status
kernel(void *state, struct spec_stream_worker *worker, int line, struct spec_error *error)
{
	const struct run *run = state;
	const struct spec_comparing *comparing = &run->comparing;
	const struct spec_images_setup *setup = comparing->setup;
	struct room room = cut_room(run, worker->scratch);
	size_t bands = comparing->bands.count;
	size_t count = choose_pixels(run, worker, line, room.pixel);
	struct row *row = (struct row *)(void *)worker->payload;
	struct spec_detail_band *band = (struct spec_detail_band *)(void *)(row + 1);
	int y = line + comparing->region.y0;
	size_t x0 = (size_t)comparing->region.x0;

	(void)error;
	*row = (struct row){0};
	spec_measure_clear(&row->spectral);
	gather(run, worker, &comparing->bands, comparing->sums[0].first != NULL, line,
		count, &room);
	if (bands > 0) {
		spec_measure_row(&comparing->spectral_setup, room.plane, room.plane + bands,
			count, y, &row->spectral);
		if (setup->exact)
			spec_comparing_exact_row(
				&comparing->bands, room.plane, count, y, &row->exact);
		if (setup->maps || setup->want_bands)
			fill_maps(run, &room, line, count, setup->want_bands ? band : NULL);
	}
	for (int side = 0; side < 2 && comparing->result->seen[0]; side++)
		fill_seen(run, &room, side, line, count);
	if (setup->sigma > 0)
		fill_test(run, worker, line, count, &room,
			(struct spec_significance_sums *)(void *)((char *)band +
								  band_bytes(run)));
	measure_others(run, worker, line, y, count, &room, row);
	place_pixels(&row->spectral, room.pixel, count, x0);
	place_pixels(&row->others, room.pixel, count, x0);
	if (row->whole.differing > 0)
		row->whole.x = room.pixel[row->whole.x] + x0;
	if (row->exact.differing > 0)
		row->exact.x = room.pixel[row->exact.x] + x0;
	return SPEC_OK;
}

static size_t
payload_bytes(const struct run *run)
{
	size_t sums = 0;

	if (run->comparing.setup->sigma > 0)
		sums = spec_significance_row_sums(run->comparing.bands.count, run->width);
	return sizeof(struct row) + band_bytes(run) +
	       sums * sizeof(struct spec_significance_sums);
}

static enum spec_status
deliver(void *state, const unsigned char *payload, int line, int count,
	struct spec_error *error)
{
	struct run *run = state;
	struct spec_images *result = run->comparing.result;

	(void)error;
	for (int i = 0; i < count; i++, payload += payload_bytes(run)) {
		const struct row *row = (const struct row *)(const void *)payload;
		const struct spec_detail_band *band =
			(const struct spec_detail_band *)(const void *)(row + 1);

		spec_measure_add(&result->spectral, &row->spectral);
		spec_measure_add(&result->others, &row->others);
		spec_comparing_whole_add(&result->whole, &row->whole);
		spec_comparing_exact_add(&result->exact, &row->exact);
		for (size_t k = 0; result->band && k < run->comparing.bands.count; k++)
			spec_detail_band_add(&result->band[k], &band[k]);
		if (run->comparing.setup->sigma > 0)
			spec_significance_add(&result->test,
				(const struct spec_significance_sums *)(const void
						*)((const char *)band + band_bytes(run)),
				line + i);
	}
	return SPEC_OK;
}

/* From the place among the pairs to the channel. */
static void
name_channels(struct spec_measure *measure, const struct spec_comparing_pairs *pairs)
{
	if (pairs->count == 0)
		return;
	measure->difference.place.band = pairs->a[measure->difference.place.band];
	measure->nonfinite_first.band = pairs->a[measure->nonfinite_first.band];
}

static enum spec_status
plan_region(struct run *run, const char *name, struct spec_error *error)
{
	struct spec_comparing *comparing = &run->comparing;
	const struct spec_window *crop = comparing->setup->crop;
	size_t width = spec_window_width(&comparing->a->data);
	size_t height = spec_window_height(&comparing->a->data);

	comparing->region = (struct spec_window){0, 0, (int)width, (int)height};
	if (crop && ((size_t)crop->x1 > width || (size_t)crop->y1 > height))
		return spec_error_set(error, SPEC_ERANGE,
			"%s: the crop %d,%d,%d,%d reaches beyond its %zu x %zu pixels",
			name, crop->x0, crop->y0, crop->x1, crop->y1, width, height);
	if (crop && (crop->x0 >= crop->x1 || crop->y0 >= crop->y1))
		return spec_error_set(error, SPEC_ERANGE,
			"%s: the crop %d,%d,%d,%d is empty", name, crop->x0, crop->y0,
			crop->x1, crop->y1);
	if (crop)
		comparing->region = *crop;
	comparing->result->region = comparing->region;
	run->width = spec_window_width(&comparing->region);
	return SPEC_OK;
}

static enum spec_status
plan_mask(struct run *run, struct spec_error *error)
{
	const struct spec_images_setup *setup = run->comparing.setup;
	const struct spec_image *image = setup->mask_reader
						 ? spec_reader_image(setup->mask_reader)
						 : run->comparing.a;
	const struct spec_window *a = &run->comparing.a->data, *m = &image->data;

	if (!setup->mask)
		return SPEC_OK;
	if (memcmp(a, m, sizeof *a) != 0)
		return spec_error_set(error, SPEC_ERANGE,
			"the mask's data window is %d,%d,%d,%d, the images' is %d,%d,%d,%d",
			m->x0, m->y0, m->x1, m->y1, a->x0, a->y0, a->x1, a->y1);
	run->mask.decoder = setup->mask_reader ? 2 : 0;
	run->mask.channel = spec_image_find_channel(image, setup->mask->channel);
	run->mask.y0 = m->y0;
	run->mask.matte = setup->mask;
	run->mask.whole = spec_comparing_is_whole(&image->channel[run->mask.channel]);
	return SPEC_OK;
}

/* Room for what outlives the comparison. */
static enum spec_status
plan_results(
	struct run *run, const struct spec_settings *settings, struct spec_error *error)
{
	struct spec_comparing *comparing = &run->comparing;
	struct spec_images *result = comparing->result;
	size_t bands = comparing->bands.count;
	size_t pixels = run->width * spec_window_height(&comparing->region), maps = 0;

	for (int kind = 0; kind < SPEC_DETAIL_PIXELS; kind++)
		maps += comparing->setup->maps >> kind & 1;
	maps += comparing->setup->want_seen ? 6 : 0;
	if (maps > 0 && pixels > (size_t)settings->limits.memory / (maps * sizeof(float)))
		return spec_error_set(error, SPEC_ERANGE,
			"%zu values for each of %zu pixels are more than the limit "
			"memory=%lld (--limit)",
			maps, pixels, settings->limits.memory);
	for (int kind = 0; kind < SPEC_DETAIL_PIXELS; kind++) {
		if (!(comparing->setup->maps & 1u << kind))
			continue;
		result->map[kind] = spec_memory_new(pixels, sizeof(float), "pixels", error);
		if (!result->map[kind])
			return SPEC_ENOMEM;
	}
	for (int side = 0; side < 2 && comparing->setup->want_seen && result->coloured;
		side++) {
		result->seen[side] =
			spec_memory_new(3 * pixels, sizeof(float), "pixels", error);
		if (!result->seen[side])
			return SPEC_ENOMEM;
	}
	if (comparing->setup->want_bands) {
		result->band = spec_memory_new(bands, sizeof *result->band, "bands", error);
		if (!result->band)
			return SPEC_ENOMEM;
	}
	result->band_channel =
		spec_memory_new(bands, sizeof *result->band_channel, "bands", error);
	result->band_nm = spec_memory_new(bands, sizeof *result->band_nm, "bands", error);
	if (!result->band_channel || !result->band_nm)
		return SPEC_ENOMEM;
	for (size_t i = 0; i < bands; i++) {
		result->band_channel[i] = comparing->bands.a[i];
		if (comparing->grid_bands > 0)
			result->band_nm[i] = comparing->grid_nm[i % comparing->grid_bands];
	}
	result->width_nm = comparing->width_nm;
	comparing->width_nm = NULL;
	return SPEC_OK;
}

static enum spec_status
finish_test(struct spec_comparing *comparing, struct spec_error *error)
{
	struct spec_images *result = comparing->result;
	double sigma = comparing->setup->sigma, least;

	spec_significance_finish(&result->test);
	result->known_variances = comparing->variances.count > 0;
	if (result->test.unknown > 0)
		return spec_error_set(error, SPEC_ERANGE,
			"the noise of %.0f samples is not known: a channel variance.* is below 0 "
			"or not finite there",
			result->test.unknown);
	least = spec_significance_least(&result->test, sigma);
	if (!result->known_variances && (double)result->spectral.pixels < least)
		return spec_error_set(error, SPEC_ERANGE,
			"%llu pixels are too few for a test at %g sigma, which takes %.0f",
			(unsigned long long)result->spectral.pixels, sigma, ceil(least));
	return SPEC_OK;
}

static enum spec_status
measure(struct run *run, struct spec_reader *a, struct spec_reader *b,
	const struct spec_settings *settings, struct spec_error *error)
{
	struct spec_comparing *comparing = &run->comparing;
	struct spec_stream stream = {
		.reader = {a, b, comparing->setup->mask_reader},
		.readers = run->mask.decoder == 2 ? 3 : 2,
		.first_line = comparing->a->data.y0 + comparing->region.y0,
		.lines = (int)spec_window_height(&comparing->region),
		.lines_in = 1,
		.payload_bytes = payload_bytes(run),
		.state = run,
		.kernel = kernel,
		.deliver = deliver,
	};
	enum spec_status status;

	run->planes = 2 * (comparing->bands.count + comparing->others.count +
				  comparing->variances.count);
	stream.scratch_bytes = room_bytes(run);
	status = spec_stream_run(&stream, settings, error);
	if (status == SPEC_OK && comparing->setup->sigma > 0)
		status = finish_test(comparing, error);
	comparing->result->bands = comparing->bands.count;
	name_channels(&comparing->result->spectral, &comparing->bands);
	name_channels(&comparing->result->others, &comparing->others);
	return status;
}

static enum spec_status
plan_noise(struct spec_comparing *comparing, struct spec_error *error)
{
	enum spec_images_noise noise = comparing->setup->noise;
	enum spec_status status;

	if (noise == SPEC_IMAGES_NOISE_DIFFERENCES)
		return SPEC_OK;
	status = spec_comparing_variances(comparing, error);
	if (status == SPEC_OK && noise == SPEC_IMAGES_NOISE_VARIANCE &&
		comparing->variances.count == 0)
		status = spec_error_set(
			error, SPEC_ERANGE, "not both images have variances of all bands");
	return status;
}

static enum spec_status
plan(struct run *run, const struct spec_settings *settings, const char *name,
	struct spec_error *error)
{
	struct spec_comparing *comparing = &run->comparing;
	const struct spec_images_setup *setup = comparing->setup;
	enum spec_status status = SPEC_OK;

	comparing->spectral_setup.bands = comparing->bands.count;
	comparing->spectral_setup.want_angle = setup->want_angle;
	comparing->spectral_setup.peak = setup->peak;
	comparing->others_setup.bands = 1;
	if (setup->observer && comparing->bands.count > 0)
		status = spec_comparing_colour(comparing, error);
	if (status == SPEC_ERANGE && setup->colour_optional)
		status = SPEC_OK;
	else if (status != SPEC_OK)
		spec_error_prefix(error, "%s", name);
	if (status == SPEC_OK)
		status = plan_region(run, name, error);
	if (status == SPEC_OK)
		status = plan_mask(run, error);
	if (status == SPEC_OK && setup->want_bands)
		status = spec_comparing_widths(comparing, error);
	if (status == SPEC_OK && setup->sigma > 0)
		status = plan_noise(comparing, error);
	if (status == SPEC_OK && setup->sigma > 0)
		status = spec_significance_open(&comparing->result->test,
			comparing->bands.count, run->width, error);
	if (status == SPEC_OK)
		status = plan_results(run, settings, error);
	return status;
}

/* What was not looked at: the writer of a pipe must not be killed for that. */
static enum spec_status
drain(struct spec_reader *const *reader, size_t readers, struct spec_error *error)
{
	enum spec_status status = SPEC_OK;

	for (size_t i = 0; i < readers && status == SPEC_OK; i++)
		if (reader[i])
			status = spec_reader_drain(reader[i], error);
	return status;
}

enum spec_status
spec_images_compare(struct spec_images *result, struct spec_reader *a,
	struct spec_reader *b, const struct spec_images_setup *setup,
	const struct spec_settings *settings, struct spec_error *error)
{
	struct run run = {.comparing = {.result = result,
				  .setup = setup,
				  .a = spec_reader_image(a),
				  .b = spec_reader_image(b)}};
	struct spec_reader *const readers[] = {a, b, setup->mask_reader};
	enum spec_status status;

	*result = (struct spec_images){0};
	spec_measure_clear(&result->spectral);
	spec_measure_clear(&result->others);
	status = spec_comparing_structure(&run.comparing, error);
	if (status != SPEC_OK)
		spec_error_prefix(error, "%s", spec_reader_name(a));
	if (run.comparing.bands.count + run.comparing.others.count == 0)
		result->comparable = 0;
	if (status == SPEC_OK && result->comparable)
		status = plan(&run, settings, spec_reader_name(a), error);
	if (status == SPEC_OK && result->comparable)
		status = measure(&run, a, b, settings, error);
	if (status == SPEC_OK && setup->mask && result->comparable &&
		result->spectral.pixels + result->others.pixels == 0)
		status = spec_error_set(error, SPEC_ERANGE, "the mask leaves no pixel");
	if (status == SPEC_OK && (!result->comparable || setup->crop))
		status = drain(readers, 3, error);
	spec_comparing_free(&run.comparing);
	if (status != SPEC_OK)
		spec_images_free(result);
	return status;
}
