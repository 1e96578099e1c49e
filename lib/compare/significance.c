#include "compare/significance.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "base/memory.h"

static size_t
count_columns(size_t width)
{
	return (width + SPEC_SIGNIFICANCE_TILE - 1) / SPEC_SIGNIFICANCE_TILE;
}

size_t
spec_significance_row_sums(size_t bands, size_t width)
{
	return count_columns(width) * bands;
}

enum spec_status
spec_significance_open(struct spec_significance *test, size_t bands, size_t width,
	struct spec_error *error)
{
	*test = (struct spec_significance){.bands = bands, .columns = count_columns(width)};
	test->evidence = -INFINITY;
	test->band = spec_memory_new(bands, sizeof *test->band, "bands", error);
	test->square = spec_memory_new(bands, sizeof *test->square, "bands", error);
	test->tile =
		spec_memory_new(bands * test->columns, sizeof *test->tile, "tiles", error);
	return test->band && test->square && test->tile ? SPEC_OK : SPEC_ENOMEM;
}

void
spec_significance_free(struct spec_significance *test)
{
	free(test->band);
	free(test->square);
	free(test->tile);
	*test = (struct spec_significance){0};
}

static int
is_variance(float variance)
{
	return variance >= 0 && isfinite(variance);
}

void
spec_significance_row(size_t bands, size_t width, const float *const *a,
	const float *const *b, const float *const *variance_a,
	const float *const *variance_b, const size_t *pixel, size_t count,
	struct spec_significance_sums *sums)
{
	memset(sums, 0, spec_significance_row_sums(bands, width) * sizeof *sums);
	for (size_t band = 0; band < bands; band++) {
		for (size_t i = 0; i < count; i++) {
			double d = (double)a[band][i] - b[band][i], variance = d * d;
			struct spec_significance_sums *it =
				&sums[pixel[i] / SPEC_SIGNIFICANCE_TILE * bands + band];

			if (variance_a)
				variance =
					(double)variance_a[band][i] + variance_b[band][i];
			if (!isfinite(d))
				continue;
			if (variance_a && !(is_variance(variance_a[band][i]) &&
						  is_variance(variance_b[band][i]))) {
				it->unknown++;
				continue;
			}
			it->difference += d;
			it->variance += variance;
			it->pixels++;
		}
	}
}

static double
standardised(const struct spec_significance_sums *sums)
{
	return sums->difference == 0 ? 0 : sums->difference / sqrt(sums->variance);
}

/* Takes a statistic that says more than those before it. */
static void
weigh(struct spec_significance *test, double evidence, enum spec_significance_kind kind,
	double value, size_t band, const struct spec_significance_sums *sums)
{
	test->tests++;
	if (!(evidence > test->evidence))
		return;
	test->evidence = evidence;
	test->kind = kind;
	test->value = value;
	test->in_band = band;
	test->mean = sums->difference / sums->pixels;
	test->x = 0;
	test->y = 0;
}

static void
close_tiles(struct spec_significance *test)
{
	for (size_t i = 0; i < test->columns * test->bands; i++) {
		const struct spec_significance_sums *tile = &test->tile[i];
		size_t band = i % test->bands, before = test->tests;
		double z = standardised(tile), most = test->evidence;

		if (tile->pixels == 0)
			continue;
		weigh(test, z * z / 2 - log(2), SPEC_SIGNIFICANCE_ONE_TILE, z, band, tile);
		if (test->tests > before && test->evidence > most) {
			test->x = i / test->bands * SPEC_SIGNIFICANCE_TILE;
			test->y = test->row_y;
		}
		test->square[band].chi_square += z * z;
		test->square[band].tiles++;
		test->band[band].difference += tile->difference;
		test->band[band].variance += tile->variance;
		test->band[band].pixels += tile->pixels;
	}
	memset(test->tile, 0, test->columns * test->bands * sizeof *test->tile);
	test->lines = 0;
}

void
spec_significance_add(
	struct spec_significance *test, const struct spec_significance_sums *sums, int line)
{
	if (test->lines == 0)
		test->row_y = line;
	for (size_t i = 0; i < test->columns * test->bands; i++) {
		test->tile[i].difference += sums[i].difference;
		test->tile[i].variance += sums[i].variance;
		test->tile[i].pixels += sums[i].pixels;
		test->unknown += sums[i].unknown;
	}
	if (++test->lines == SPEC_SIGNIFICANCE_TILE)
		close_tiles(test);
}

void
spec_significance_finish(struct spec_significance *test)
{
	if (test->lines > 0)
		close_tiles(test);
	for (size_t i = 0; i < test->bands; i++) {
		const struct spec_significance_sums *band = &test->band[i];
		double tiles = (double)test->square[i].tiles, z = standardised(band);
		double t = test->square[i].chi_square / tiles;
		double evidence = t > 1 ? tiles * (t - 1 - log(t)) / 2 : 0;

		if (band->pixels == 0)
			continue;
		weigh(test, z * z / 2 - log(2), SPEC_SIGNIFICANCE_BAND, z, i, band);
		weigh(test, isinf(t) ? INFINITY : evidence, SPEC_SIGNIFICANCE_TILES, t, i,
			band);
	}
}

double
spec_significance_p(const struct spec_significance *test)
{
	return fmin(1, (double)test->tests * exp(-test->evidence));
}

double
spec_significance_level(double sigma)
{
	return erfc(sigma / sqrt(2));
}

double
spec_significance_least(const struct spec_significance *test, double sigma)
{
	/* n where 2 exp(-n / 2) times the statistics is the level. */
	return 2 * log(2 * (double)test->tests / spec_significance_level(sigma));
}
