/*
 * Whether two Monte Carlo renders have the same expectation, by their noise. The null
 * hypothesis: the differences d of the pixels of a band are independent of each other, and
 * symmetric about 0, as those of two renders of one scene with as many samples each are.
 * Bands may depend on each other.
 *
 * In each band three kinds of statistics are taken, tiles being of SPEC_SIGNIFICANCE_TILE
 * pixels square, or what is left of one at the region's end:
 *   z of the band, and z of each tile: the sum of d over the root of the sum of d^2, or,
 *     where the variances of both means are known, over the root of their sums;
 *   Q of the band: the sum of z^2 over its N tiles.
 * Given the magnitudes |d|, a sum of symmetric d is one of random signs, so that (Hoeffding,
 * Journal of the American Statistical Association 58 (1963) 13-30; Efron, ibid. 64 (1969)
 * 1278-1302) for every number of pixels and every symmetric noise, fireflies included,
 *   P(|z| >= t) <= 2 exp(-t^2 / 2),
 * and, since E exp(s z^2) <= (1 - 2 s)^(-1/2), as for a normal z, by Chernoff's bound
 *   P(Q >= N t) <= exp(-N (t - 1 - ln t) / 2) for t > 1.
 * With known variances both hold for normal d. The least of these bounds times the number of
 * statistics bounds the probability p that renders with the same expectation are as far
 * apart (Bonferroni): an alarm where p <= erfc(sigma / sqrt 2), 0.0027 for 3 sigma, is false
 * no more often than that.
 *
 * z is at most the root of the number of pixels: a difference of few pixels cannot be told
 * from noise without variances.
 */
#ifndef SPEC_COMPARE_SIGNIFICANCE_H
#define SPEC_COMPARE_SIGNIFICANCE_H

#include <stddef.h>

#include "base/error.h"

#define SPEC_SIGNIFICANCE_TILE 16 /* pixels */

/*
 * Sums over pixels of one band: of d, of what d's variance is taken from, and how many; and
 * in how many there is a d, but no variance of it.
 */
struct spec_significance_sums {
	double difference, variance;
	double pixels, unknown;
};

enum spec_significance_kind {
	SPEC_SIGNIFICANCE_BAND,  /* z of a band */
	SPEC_SIGNIFICANCE_TILES, /* Q of a band; its value is Q / N */
	SPEC_SIGNIFICANCE_ONE_TILE
};

struct spec_significance {
	size_t bands, columns;
	struct spec_significance_sums *band; /* [bands] */
	/* [columns * bands] of the open row of tiles */
	struct spec_significance_sums *tile;
	struct {
		double chi_square;
		size_t tiles;
	} * square;   /* [bands] */
	int lines;    /* in the open row of tiles */
	int row_y;    /* of its first line */
	size_t tests; /* statistics */
	/* Samples with variances that are not finite or below 0: then p says nothing. */
	double unknown;

	/* The statistic whose bound is least. */
	double evidence; /* minus the logarithm of that bound */
	enum spec_significance_kind kind;
	double value; /* z, or Q / N */
	double mean;  /* of d there */
	size_t in_band, x;
	int y; /* the tile's corner in the region */
};

/* How many sums spec_significance_row fills. */
size_t spec_significance_row_sums(size_t bands, size_t width);

/* width: of the region. Error: SPEC_ENOMEM; it may be freed then as after success. */
enum spec_status spec_significance_open(struct spec_significance *test, size_t bands,
	size_t width, struct spec_error *error);
void spec_significance_free(struct spec_significance *test);

/*
 * The sums of one row of count pixels, whose places in the region's row are pixel[count].
 * a, b: one pointer for each band; variance_a, variance_b: the same of the variances of a
 * and of b, or null. Samples that are not finite are left out, and those with a variance
 * that is not finite or below 0 are no more than counted.
 */
void spec_significance_row(size_t bands, size_t width, const float *const *a,
	const float *const *b, const float *const *variance_a,
	const float *const *variance_b, const size_t *pixel, size_t count,
	struct spec_significance_sums *sums);

/* Adds rows in their order, from line 0 of the region on. */
void spec_significance_add(struct spec_significance *test,
	const struct spec_significance_sums *sums, int line);

/* After the last row. */
void spec_significance_finish(struct spec_significance *test);

/* The bound p, at most 1. */
double spec_significance_p(const struct spec_significance *test);

/* The p at which there is an alarm, erfc(sigma / sqrt 2). */
double spec_significance_level(double sigma);

/*
 * How many pixels a band must have at least, so that differences that all have one sign and
 * size raise an alarm where variances are not known.
 */
double spec_significance_least(const struct spec_significance *test, double sigma);

#endif
