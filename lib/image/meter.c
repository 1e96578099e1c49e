#include "image/meter.h"

#include <math.h>
#include <stdatomic.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include "base/memory.h"
#include "base/output.h"
#include "base/parallel.h"
#include "base/vector.h"

#define MIDDLE_GREY .18 /* what the average becomes: Reinhard et al. 2002, section 3 */

/* A positive float's exponent and 9 bits of its fraction: steps of 2^-9 at most. */
#define SHIFT 14
#define BINS (1u << (31 - SHIFT))

#define BLOCK_BYTES (1 << 19) /* of rows that a thread takes at once: it stays in a cache */
#define RUN 256               /* pixels whose luminance stays in the nearest cache */

static char scratch_name[] = "a temporary file";

struct spec_meter {
	struct spec_finish *finish;
	struct spec_output scratch;
	size_t width;
	long long rows;
	struct spec_meter_row all;
	int exposed; /* what is in the file has been exposed already */
	int threads;
	/* [threads]: how many lit pixels there are, by the bits of luminance; or null */
	uint32_t **bin;
};

int
spec_meter_wanted(const struct spec_look *look)
{
	return look->metering != SPEC_METERING_NONE || look->gamut == SPEC_GAMUT_SCALE;
}

enum spec_status
spec_meter_open(struct spec_meter **result, struct spec_finish *finish, size_t width,
	int threads, struct spec_error *error)
{
	struct spec_meter *meter = spec_memory_new(1, sizeof *meter, "pictures", error);
	enum spec_status status;

	*result = meter;
	if (!meter)
		return SPEC_ENOMEM;
	*meter = (struct spec_meter){.finish = finish,
		.scratch = {.path = scratch_name, .fd = -1},
		.width = width,
		.all = {.most = 1, .chroma = 1},
		.exposed = finish->look->metering == SPEC_METERING_NONE,
		.threads = threads};
	meter->bin = spec_memory_new((size_t)threads, sizeof *meter->bin, "threads", error);
	if (!meter->bin)
		return SPEC_ENOMEM;
	status = spec_output_scratch(&meter->scratch.fd, error);
	if (status != SPEC_OK)
		meter->scratch.fd = -1;
	return status;
}

/* Luminance, or 0 where it is not above 0 or not finite. */
SPEC_VECTORISED static void
find_luminance(const double weight[3], const float *restrict r, const float *restrict g,
	const float *restrict b, size_t count, double *restrict luminance)
{
	double red = weight[0], green = weight[1], blue = weight[2];

	for (size_t i = 0; i < count; i++) {
		double y = red * r[i] + green * g[i] + blue * b[i];
		float rounded = (float)y;

		luminance[i] = ((rounded > 0) & (rounded - rounded == 0)) ? y : 0;
	}
}

SPEC_VECTORISED static void
find_logarithms(const double *restrict luminance, size_t count, double *restrict logarithm)
{
	for (size_t i = 0; i < count; i++) {
		double lit = luminance[i] > 0 ? luminance[i] : 1;

		logarithm[i] = spec_vector_log(lit);
	}
}

static void
count_bins(const double *luminance, size_t count, uint32_t *bin)
{
	for (size_t i = 0; i < count; i++) {
		float rounded = (float)luminance[i];
		uint32_t bits;

		memcpy(&bits, &rounded, sizeof bits);
		bin[bits >> SHIFT] += luminance[i] > 0;
	}
}

static void
measure(const struct spec_meter *meter, const float *row, uint32_t *bin,
	struct spec_meter_row *measured)
{
	const float *red = row, *green = red + meter->width, *blue = green + meter->width;
	double luminance[RUN], logarithm[RUN];

	for (size_t x0 = 0; x0 < meter->width; x0 += RUN) {
		size_t count = meter->width - x0 < RUN ? meter->width - x0 : RUN;

		find_luminance(meter->finish->map.luminance, red + x0, green + x0,
			blue + x0, count, luminance);
		for (size_t i = 0; i < count; i++)
			measured->lit += luminance[i] > 0;
		if (bin) {
			count_bins(luminance, count, bin);
			continue;
		}
		find_logarithms(luminance, count, logarithm);
		for (size_t i = 0; i < count; i++)
			measured->logs += logarithm[i];
	}
}

enum spec_status
spec_meter_take(struct spec_meter *meter, int worker, float *row, int y,
	struct spec_meter_row *measured, struct spec_error *error)
{
	const struct spec_finish *finish = meter->finish;
	size_t width = meter->width, bytes = 3 * width * sizeof *row;
	float *const plane[3] = {row, row + width, row + 2 * width};

	*measured = (struct spec_meter_row){.most = 1, .chroma = 1};
	if (finish->look->metering == SPEC_METERING_PERCENTILE && !meter->bin[worker]) {
		meter->bin[worker] =
			spec_memory_new(BINS, sizeof **meter->bin, "pictures", error);
		if (!meter->bin[worker])
			return SPEC_ENOMEM;
	}
	if (!meter->exposed) {
		measure(meter, row, meter->bin[worker], measured);
	} else {
		struct spec_gamut_map map = finish->map;

		spec_finish_expose(finish, plane, width);
		spec_gamut_measure(&map, (const float *const *)plane, width);
		measured->most = map.most;
		measured->chroma = map.chroma;
	}
	return spec_output_write_at(
		&meter->scratch, row, bytes, (long long)y * (long long)bytes, error);
}

void
spec_meter_add(struct spec_meter *meter, const struct spec_meter_row *measured)
{
	meter->rows++;
	meter->all.lit += measured->lit;
	meter->all.logs += measured->logs;
	meter->all.most = fmax(meter->all.most, measured->most);
	meter->all.chroma = fmin(meter->all.chroma, measured->chroma);
}

static double
count_bin(const struct spec_meter *meter, uint32_t bin)
{
	double count = 0;

	for (int i = 0; i < meter->threads; i++)
		count += meter->bin[i] ? meter->bin[i][bin] : 0;
	return count;
}

/* The middle of the bin that holds the percentile. */
static double
find_percentile(const struct spec_meter *meter, double percentile)
{
	double rank = meter->all.lit * percentile / 100, seen = count_bin(meter, 0);
	uint32_t bin = 0, bits;
	float luminance;

	while (bin + 1 < BINS && seen < rank)
		seen += count_bin(meter, ++bin);
	bits = (bin << SHIFT) + (1u << (SHIFT - 1));
	memcpy(&luminance, &bits, sizeof luminance);
	return luminance;
}

static double
find_gain(const struct spec_meter *meter)
{
	const struct spec_look *look = meter->finish->look;

	if (look->metering == SPEC_METERING_NONE || meter->all.lit == 0)
		return 1;
	if (look->metering == SPEC_METERING_PERCENTILE)
		return 1 / find_percentile(meter, look->percentile);
	return MIDDLE_GREY / exp(meter->all.logs / (double)meter->all.lit);
}

/* Blocks of rows that several threads take from the temporary file, in turns. */
struct again {
	struct spec_meter *meter;
	struct spec_picture *picture; /* or null: the gamut is measured */
	atomic_llong next;            /* block that nobody has taken */
	size_t rows;                  /* of a block */
	size_t sample_bytes;          /* of a row of the picture */
	struct spec_turnstile turnstile;
};

/* One block, from linear rows to samples, or to what there is to be measured in map. */
static void
work_on(const struct again *again, float *linear, unsigned char *samples, long long first,
	size_t count, struct spec_gamut_map *map)
{
	const struct spec_finish *finish = again->meter->finish;
	size_t width = again->meter->width;

	for (size_t i = 0; i < count; i++) {
		float *row = linear + 3 * i * width;
		float *const plane[3] = {row, row + width, row + 2 * width};

		if (!again->meter->exposed)
			spec_finish_expose(finish, plane, width);
		if (again->picture)
			spec_finish_encode(finish, plane, width, (int)first + (int)i,
				samples + i * again->sample_bytes);
		else
			spec_gamut_measure(map, (const float *const *)plane, width);
	}
}

static enum spec_status
deliver(struct again *again, const unsigned char *samples, size_t count,
	const struct spec_gamut_map *map, struct spec_error *error)
{
	struct spec_gamut_map *all = &again->meter->finish->map;
	enum spec_status status = SPEC_OK;

	if (!again->picture) {
		all->most = fmax(all->most, map->most);
		all->chroma = fmin(all->chroma, map->chroma);
		return SPEC_OK;
	}
	for (size_t i = 0; i < count && status == SPEC_OK; i++)
		status = spec_picture_write(
			again->picture, samples + i * again->sample_bytes, 1, error);
	return status;
}

/* Blocks for one thread, as long as there are any. */
static enum spec_status
take_blocks(struct again *again, float *linear, unsigned char *samples,
	struct spec_error *error)
{
	const struct spec_meter *meter = again->meter;
	size_t row_bytes = 3 * meter->width * sizeof *linear;
	struct spec_gamut_map map = meter->finish->map;
	enum spec_status status = SPEC_OK;

	map.most = map.chroma = 1;
	while (status == SPEC_OK) {
		long long block = atomic_fetch_add(&again->next, 1);
		long long first = block * (long long)again->rows;
		size_t count = again->rows;

		if (first >= meter->rows)
			break;
		if ((long long)count > meter->rows - first)
			count = (size_t)(meter->rows - first);
		status = spec_output_read(meter->scratch.fd, linear, count * row_bytes,
			first * (long long)row_bytes, error);
		if (status == SPEC_OK)
			work_on(again, linear, samples, first, count, &map);
		if (status != SPEC_OK || !spec_turnstile_enter(&again->turnstile, block))
			break;
		status = deliver(again, samples, count, &map, error);
		if (status == SPEC_OK)
			spec_turnstile_leave(&again->turnstile);
	}
	return status;
}

static void
work(void *argument, int worker)
{
	struct again *again = argument;
	size_t width = again->meter->width;
	struct spec_error error = {0};
	float *linear = spec_memory_new(
		again->rows, 3 * width * sizeof *linear, "pictures", &error);
	unsigned char *samples =
		spec_memory_new(again->rows, again->sample_bytes, "pictures", &error);
	enum spec_status status = SPEC_ENOMEM;

	(void)worker;
	if (linear && samples)
		status = take_blocks(again, linear, samples, &error);
	if (status != SPEC_OK)
		spec_turnstile_stop(&again->turnstile, &error);
	free(linear);
	free(samples);
}

static enum spec_status
read_again(struct spec_meter *meter, struct spec_picture *picture, int threads,
	struct spec_error *error)
{
	size_t row_bytes = 3 * meter->width * sizeof(float);
	struct again again = {.meter = meter,
		.picture = picture,
		.rows = row_bytes < BLOCK_BYTES ? BLOCK_BYTES / row_bytes : 1,
		.sample_bytes = 3 * meter->width *
				spec_picture_sample_bytes(meter->finish->sample)};
	enum spec_status status;

	spec_turnstile_init(&again.turnstile);
	status = spec_parallel_run(threads, work, &again, error);
	if (status == SPEC_OK)
		status = spec_turnstile_status(&again.turnstile, error);
	spec_turnstile_destroy(&again.turnstile);
	return status;
}

enum spec_status
spec_meter_finish(struct spec_meter *meter, struct spec_picture *picture,
	const struct spec_settings *settings, struct spec_error *error)
{
	enum spec_status status = SPEC_OK;

	meter->finish->gain = find_gain(meter);
	meter->finish->map.most = meter->all.most;
	meter->finish->map.chroma = meter->all.chroma;
	if (meter->finish->look->gamut == SPEC_GAMUT_SCALE && !meter->exposed)
		status = read_again(meter, NULL, settings->threads, error);
	if (status == SPEC_OK)
		status = read_again(meter, picture, settings->threads, error);
	return status;
}

void
spec_meter_close(struct spec_meter *meter)
{
	if (!meter)
		return;
	if (meter->scratch.fd >= 0)
		(void)close(meter->scratch.fd);
	for (int i = 0; meter->bin && i < meter->threads; i++)
		free(meter->bin[i]);
	free(meter->bin);
	free(meter);
}
