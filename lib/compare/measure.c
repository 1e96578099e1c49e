#include "compare/measure.h"

#include <float.h>
#include <math.h>
#include <string.h>

#include "base/vector.h"
#include "colour/difference.h"

/* Pixels at a time: the sums stay in the first-level cache, 81 bands in the second. */
#define CHUNK 64

/* Pixels x0 .. x0 + n - 1 of the row and what is summed over their bands. */
struct chunk {
	const struct spec_measure_setup *setup;
	const float *const *a, *const *b;
	size_t x0, n;
	int dirty;                   /* holds samples that are not finite */
	double aa[CHUNK], bb[CHUNK]; /* squared lengths */
	double square[CHUNK];        /* of the difference */
	double worst[CHUNK];         /* the largest magnitude of the difference */
	double minus[CHUNK],
		plus[CHUNK]; /* squared lengths of the unit vectors' u - v, u + v */
	double xyz_a[3 * CHUNK], xyz_b[3 * CHUNK]; /* X's, Y's, Z's */
	float clean_a[CHUNK], clean_b[CHUNK];
	unsigned char bad[CHUNK]; /* the pixel has a nonfinite difference */
};

void
spec_measure_clear(struct spec_measure *measure)
{
	memset(measure, 0, sizeof *measure);
	measure->angle_most.value = -INFINITY;
	measure->fit_least.value = INFINITY;
	measure->colour_most.value = -INFINITY;
}

/* Neumaier 1974: keeps what each addition rounds away. */
static inline void
sum_add(struct spec_measure_sum *sum, double value)
{
	double total = sum->sum + value;

	if (fabs(sum->sum) >= fabs(value))
		sum->lost += (sum->sum - total) + value;
	else
		sum->lost += (value - total) + sum->sum;
	sum->sum = total;
}

/* What is lost beside an infinite sum is NaN and means nothing. */
static double
sum_value(const struct spec_measure_sum *sum)
{
	return isfinite(sum->sum) ? sum->sum + sum->lost : sum->sum;
}

/* The bits of a magnitude order as the magnitudes do. */
SPEC_VECTORISED static float
largest_magnitude(const float *a, size_t n)
{
	int32_t largest = 0, bits;
	float value;
	size_t i;

	for (i = 0; i < n; i++) {
		memcpy(&bits, &a[i], sizeof bits);
		bits &= INT32_MAX;
		largest = bits > largest ? bits : largest;
	}
	memcpy(&value, &largest, sizeof value);
	return value;
}

SPEC_VECTORISED static void
add_squares(const float *restrict a, const float *restrict b, size_t n, double *restrict aa,
	double *restrict bb, double *restrict square, double *restrict worst)
{
	double p, q, d, magnitude;
	size_t i;

	for (i = 0; i < n; i++) {
		p = a[i];
		q = b[i];
		d = p - q;
		magnitude = fabs(d);
		aa[i] += p * p;
		bb[i] += q * q;
		square[i] += d * d;
		worst[i] = magnitude > worst[i] ? magnitude : worst[i];
	}
}

/* scale_a, scale_b: the inverse lengths. Equal spectra cancel exactly. */
SPEC_VECTORISED static void
add_units(const float *restrict a, const float *restrict b, size_t n,
	const double *restrict scale_a, const double *restrict scale_b,
	double *restrict minus, double *restrict plus)
{
	double u, v;
	size_t i;

	for (i = 0; i < n; i++) {
		u = a[i] * scale_a[i];
		v = b[i] * scale_b[i];
		minus[i] += (u - v) * (u - v);
		plus[i] += (u + v) * (u + v);
	}
}

SPEC_VECTORISED static void
add_colour(const float *restrict a, size_t n, double wx, double wy, double wz,
	double *restrict xyz)
{
	size_t i;

	for (i = 0; i < n; i++) {
		xyz[i] += wx * a[i];
		xyz[CHUNK + i] += wy * a[i];
		xyz[2 * CHUNK + i] += wz * a[i];
	}
}

static int
samples_equal(float a, float b)
{
	return a == b || (isnan(a) && isnan(b));
}

/* The samples of one band; where the chunk is dirty, copies with 0 for what is not finite. */
static void
fetch(struct chunk *chunk, size_t band, const float **a, const float **b)
{
	size_t i;

	*a = chunk->a[band] + chunk->x0;
	*b = chunk->b[band] + chunk->x0;
	if (!chunk->dirty)
		return;
	for (i = 0; i < chunk->n; i++) {
		int finite = isfinite((*a)[i]) && isfinite((*b)[i]);

		chunk->clean_a[i] = finite ? (*a)[i] : 0;
		chunk->clean_b[i] = finite ? (*b)[i] : 0;
	}
	*a = chunk->clean_a;
	*b = chunk->clean_b;
}

/* Counts the differences that are not finite; the first is the earliest by x, band. */
static void
count_nonfinite(struct chunk *chunk, int y, struct spec_measure *row)
{
	size_t i, band;
	float a, b;

	for (i = 0; i < chunk->n; i++) {
		for (band = 0; band < chunk->setup->bands; band++) {
			a = chunk->a[band][chunk->x0 + i];
			b = chunk->b[band][chunk->x0 + i];
			if ((isfinite(a) && isfinite(b)) || samples_equal(a, b))
				continue;
			if (row->nonfinite++ == 0) {
				row->nonfinite_first =
					(struct spec_measure_place){chunk->x0 + i, y, band};
				row->nonfinite_a = a;
				row->nonfinite_b = b;
			}
			chunk->bad[i] = 1;
		}
		row->nonfinite_pixels += chunk->bad[i];
	}
}

static void
pass_squares(struct chunk *chunk, struct spec_measure *row)
{
	float largest = row->largest_a, here;
	const float *a, *b;
	size_t band;

	for (band = 0; band < chunk->setup->bands; band++) {
		fetch(chunk, band, &a, &b);
		add_squares(
			a, b, chunk->n, chunk->aa, chunk->bb, chunk->square, chunk->worst);
		here = largest_magnitude(a, chunk->n);
		largest = here > largest ? here : largest;
	}
	if (isfinite(largest))
		row->largest_a = largest;
}

/* A float's square never overflows a double: only what is not finite spoils a sum. */
static int
squares_spoiled(const struct chunk *chunk)
{
	size_t i;

	for (i = 0; i < chunk->n; i++)
		if (!isfinite(chunk->aa[i] + chunk->bb[i]))
			return 1;
	return 0;
}

static void
open_chunk(struct chunk *chunk, int y, struct spec_measure *row)
{
	size_t offset = offsetof(struct chunk, aa);
	float largest = row->largest_a;

	chunk->dirty = 0;
	memset((char *)chunk + offset, 0, sizeof *chunk - offset);
	pass_squares(chunk, row);
	if (!squares_spoiled(chunk))
		return;
	chunk->dirty = 1;
	row->largest_a = largest;
	memset((char *)chunk + offset, 0, sizeof *chunk - offset);
	count_nonfinite(chunk, y, row);
	pass_squares(chunk, row);
}

static void
pass_units(struct chunk *chunk)
{
	double scale_a[CHUNK], scale_b[CHUNK];
	const float *a, *b;
	size_t band, i;

	for (i = 0; i < chunk->n; i++) {
		scale_a[i] = chunk->aa[i] > 0 ? 1 / sqrt(chunk->aa[i]) : 0;
		scale_b[i] = chunk->bb[i] > 0 ? 1 / sqrt(chunk->bb[i]) : 0;
	}
	for (band = 0; band < chunk->setup->bands; band++) {
		fetch(chunk, band, &a, &b);
		add_units(a, b, chunk->n, scale_a, scale_b, chunk->minus, chunk->plus);
	}
}

static void
pass_colour(struct chunk *chunk)
{
	const double *w = chunk->setup->weight_xyz;
	size_t band, bands = chunk->setup->bands;
	const float *a, *b;

	for (band = 0; band < bands; band++, w++) {
		fetch(chunk, band, &a, &b);
		add_colour(a, chunk->n, w[0], w[bands], w[2 * bands], chunk->xyz_a);
		add_colour(b, chunk->n, w[0], w[bands], w[2 * bands], chunk->xyz_b);
	}
}

static void
take_most(struct spec_measure_extreme *most, double value, size_t x, int y)
{
	if (value > most->value)
		*most = (struct spec_measure_extreme){value, {x, y, 0}};
}

static void
take_least(struct spec_measure_extreme *least, double value, size_t x, int y)
{
	if (value < least->value)
		*least = (struct spec_measure_extreme){value, {x, y, 0}};
}

static void
take_difference(const struct chunk *chunk, size_t i, int y, struct spec_measure *row)
{
	size_t band, x = chunk->x0 + i;
	double d;

	for (band = 0; band < chunk->setup->bands; band++) {
		d = (double)chunk->a[band][x] - chunk->b[band][x];
		if (fabs(d) != chunk->worst[i])
			continue;
		row->difference.value = chunk->worst[i];
		row->difference.place = (struct spec_measure_place){x, y, band};
		row->difference_a = chunk->a[band][x];
		row->difference_b = chunk->b[band][x];
		return;
	}
}

static void
take_angle(const struct chunk *chunk, size_t i, int y, struct spec_measure *row)
{
	double minus = chunk->minus[i], plus = chunk->plus[i], both = minus + plus;
	double angle = minus > 0 ? 2 * atan2(sqrt(minus), sqrt(plus)) : 0;
	double fit = both > 0 ? fabs(plus - minus) / both : 1;

	sum_add(&row->angle, angle);
	sum_add(&row->fit, fit);
	take_most(&row->angle_most, angle, chunk->x0 + i, y);
	take_least(&row->fit_least, fit, chunk->x0 + i, y);
}

static void
take_colour(const struct chunk *chunk, size_t i, int y, struct spec_measure *row)
{
	double a[3], b[3], lab_a[3], lab_b[3], difference = 0;
	int c;

	for (c = 0; c < 3; c++) {
		a[c] = chunk->xyz_a[c * CHUNK + i];
		b[c] = chunk->xyz_b[c * CHUNK + i];
	}
	if (!(a[0] == b[0] && a[1] == b[1] && a[2] == b[2])) {
		spec_lab_from_xyz(a, chunk->setup->white_xyz, lab_a);
		spec_lab_from_xyz(b, chunk->setup->white_xyz, lab_b);
		difference = spec_difference_ciede2000(lab_a, lab_b);
		/* A NaN could pass a tolerance; an infinity cannot. */
		if (!(difference <= DBL_MAX))
			difference = INFINITY;
	}
	sum_add(&row->colour, difference);
	take_most(&row->colour_most, difference, chunk->x0 + i, y);
}

static void
measure_chunk(struct chunk *chunk, int y, struct spec_measure *row)
{
	const struct spec_measure_setup *setup = chunk->setup;
	size_t i;

	open_chunk(chunk, y, row);
	if (setup->want_angle)
		pass_units(chunk);
	if (setup->weight_xyz)
		pass_colour(chunk);
	for (i = 0; i < chunk->n; i++) {
		sum_add(&row->square, chunk->square[i]);
		if (chunk->worst[i] > row->difference.value)
			take_difference(chunk, i, y, row);
		if (chunk->bad[i])
			continue;
		if (setup->want_angle)
			take_angle(chunk, i, y, row);
		if (setup->weight_xyz)
			take_colour(chunk, i, y, row);
	}
}

void
spec_measure_row(const struct spec_measure_setup *setup, const float *const *a,
	const float *const *b, size_t width, int y, struct spec_measure *row)
{
	struct chunk chunk;
	size_t x;

	spec_measure_clear(row);
	row->pixels = width;
	row->samples = (uint64_t)width * setup->bands;
	chunk.setup = setup;
	chunk.a = a;
	chunk.b = b;
	for (x = 0; x < width; x += chunk.n) {
		chunk.x0 = x;
		chunk.n = width - x < CHUNK ? width - x : CHUNK;
		measure_chunk(&chunk, y, row);
	}
	if (row->nonfinite > 0) {
		row->difference.value = INFINITY;
		row->difference.place = row->nonfinite_first;
		row->difference_a = row->nonfinite_a;
		row->difference_b = row->nonfinite_b;
	}
}

static void
sum_join(struct spec_measure_sum *total, const struct spec_measure_sum *row)
{
	sum_add(total, row->sum);
	total->lost += row->lost;
}

void
spec_measure_add(struct spec_measure *total, const struct spec_measure *row)
{
	if (total->nonfinite == 0 && row->nonfinite > 0) {
		total->nonfinite_first = row->nonfinite_first;
		total->nonfinite_a = row->nonfinite_a;
		total->nonfinite_b = row->nonfinite_b;
	}
	if (row->difference.value > total->difference.value) {
		total->difference = row->difference;
		total->difference_a = row->difference_a;
		total->difference_b = row->difference_b;
	}
	total->samples += row->samples;
	total->pixels += row->pixels;
	total->nonfinite += row->nonfinite;
	total->nonfinite_pixels += row->nonfinite_pixels;
	if (row->largest_a > total->largest_a)
		total->largest_a = row->largest_a;
	sum_join(&total->square, &row->square);
	sum_join(&total->angle, &row->angle);
	sum_join(&total->fit, &row->fit);
	sum_join(&total->colour, &row->colour);
	if (row->angle_most.value > total->angle_most.value)
		total->angle_most = row->angle_most;
	if (row->fit_least.value < total->fit_least.value)
		total->fit_least = row->fit_least;
	if (row->colour_most.value > total->colour_most.value)
		total->colour_most = row->colour_most;
}

/* Whether the metrics are numbers at all. */
static int
comparable(const struct spec_measure *measure)
{
	return measure->samples > 0 && measure->nonfinite == 0;
}

static double
mean(const struct spec_measure *measure, const struct spec_measure_sum *sum)
{
	return sum_value(sum) / (double)measure->pixels;
}

double
spec_measure_rmse(const struct spec_measure *measure)
{
	if (!comparable(measure))
		return INFINITY;
	return sqrt(sum_value(&measure->square) / (double)measure->samples);
}

double
spec_measure_max(const struct spec_measure *measure)
{
	return comparable(measure) ? measure->difference.value : INFINITY;
}

double
spec_measure_psnr(const struct spec_measure *measure, double peak)
{
	double rmse = spec_measure_rmse(measure);

	if (!comparable(measure))
		return -INFINITY;
	if (rmse == 0)
		return INFINITY;
	return 20 * log10((peak > 0 ? peak : measure->largest_a) / rmse);
}

double
spec_measure_angle_mean(const struct spec_measure *measure)
{
	return comparable(measure) ? mean(measure, &measure->angle) : INFINITY;
}

double
spec_measure_angle_max(const struct spec_measure *measure)
{
	return comparable(measure) ? measure->angle_most.value : INFINITY;
}

double
spec_measure_fit_mean(const struct spec_measure *measure)
{
	return comparable(measure) ? mean(measure, &measure->fit) : -INFINITY;
}

double
spec_measure_fit_min(const struct spec_measure *measure)
{
	return comparable(measure) ? measure->fit_least.value : -INFINITY;
}

double
spec_measure_colour_mean(const struct spec_measure *measure)
{
	return comparable(measure) ? mean(measure, &measure->colour) : INFINITY;
}

double
spec_measure_colour_max(const struct spec_measure *measure)
{
	return comparable(measure) ? measure->colour_most.value : INFINITY;
}
