#include "compare/measure.h"

#include <float.h>
#include <math.h>
#include <string.h>

#include "base/vector.h"
#include "colour/difference.h"

/* Pixels at a time: the sums stay in the first-level cache, 81 bands in the second. */
#define CHUNK 128

#define LANES 8 /* sums and extremes side by side */

/* Pixels x0 .. x0 + n - 1 of the row and what is summed over their bands. */
struct chunk {
	const struct spec_measure_setup *setup;
	const float *const *a, *const *b;
	size_t x0, n;
	int dirty; /* holds samples that are not finite */
	float clean_a[CHUNK], clean_b[CHUNK];
	unsigned char bad[CHUNK];    /* the pixel has a nonfinite difference */
	double aa[CHUNK], bb[CHUNK]; /* squared lengths */
	double square[CHUNK];        /* of the difference */
	double worst[CHUNK];         /* the largest magnitude of the difference */
	double largest[CHUNK];       /* the largest magnitude of a */
	double minus[CHUNK],
		plus[CHUNK]; /* squared lengths of the unit vectors' u - v, u + v */
	double xyz_a[3 * CHUNK], xyz_b[3 * CHUNK]; /* X's, Y's, Z's; then L's, a's, b's */
	double angle[CHUNK], fit[CHUNK], colour[CHUNK];
};

void
spec_measure_clear(struct spec_measure *measure)
{
	memset(measure, 0, sizeof *measure);
	measure->angle_most.value = -INFINITY;
	measure->fit_least.value = INFINITY;
	measure->colour_most.value = -INFINITY;
}

/* Adds count numbers, LANES of them at a time, each with what its own sum has lost. */
SPEC_VECTORISED static void
sum_add_all(struct spec_measure_sum *sum, const double *restrict value, size_t count)
{
	double lane[LANES] = {0}, lost[LANES] = {0};
	size_t i = 0;

	for (; i + LANES <= count; i += LANES) {
		for (size_t k = 0; k < LANES;
			k++) { /* Knuth's sum of two, without a branch */
			double v = value[i + k], total = lane[k] + v,
			       part = total - lane[k];

			lost[k] += (lane[k] - (total - part)) + (v - part);
			lane[k] = total;
		}
	}
	for (size_t k = 0; k < LANES; k++) {
		spec_measure_sum_add(sum, lane[k]);
		sum->lost += lost[k];
	}
	for (; i < count; i++)
		spec_measure_sum_add(sum, value[i]);
}

static inline double
greater(double a, double b)
{
	return a > b ? a : b;
}

/* The largest of sign times each of count numbers, which are not NaN. */
SPEC_VECTORISED static double
largest_of(const double *restrict value, size_t count, double sign)
{
	double lane[LANES], largest = -INFINITY;
	size_t i = 0;

	for (size_t k = 0; k < LANES; k++)
		lane[k] = -INFINITY;
	for (; i + LANES <= count; i += LANES)
		for (size_t k = 0; k < LANES; k++)
			lane[k] = greater(sign * value[i + k], lane[k]);
	for (; i < count; i++)
		largest = greater(sign * value[i], largest);
	for (size_t k = 0; k < LANES; k++)
		largest = greater(lane[k], largest);
	return largest;
}

SPEC_VECTORISED static void
add_squares(struct chunk *restrict chunk, const float *restrict a, const float *restrict b)
{
	for (size_t i = 0; i < chunk->n; i++) {
		double p = a[i], q = b[i], d = p - q;

		chunk->aa[i] += p * p;
		chunk->bb[i] += q * q;
		chunk->square[i] += d * d;
		chunk->worst[i] = greater(fabs(d), chunk->worst[i]);
		chunk->largest[i] = greater(fabs(p), chunk->largest[i]);
	}
}

/* Always inlined: no loop with a call in it becomes vector code. */
static inline __attribute__((always_inline)) void
add_squares_of_four(struct chunk *restrict chunk, size_t i, double p0, double p1, double p2,
	double p3, double q0, double q1, double q2, double q3)
{
	double d0 = p0 - q0, d1 = p1 - q1, d2 = p2 - q2, d3 = p3 - q3;

	chunk->aa[i] += (p0 * p0 + p1 * p1) + (p2 * p2 + p3 * p3);
	chunk->bb[i] += (q0 * q0 + q1 * q1) + (q2 * q2 + q3 * q3);
	chunk->square[i] += (d0 * d0 + d1 * d1) + (d2 * d2 + d3 * d3);
	chunk->worst[i] = greater(chunk->worst[i],
		greater(greater(fabs(d0), fabs(d1)), greater(fabs(d2), fabs(d3))));
	chunk->largest[i] = greater(chunk->largest[i],
		greater(greater(fabs(p0), fabs(p1)), greater(fabs(p2), fabs(p3))));
}

/* Of four bands: the sums are loaded and stored a quarter as often. */
SPEC_VECTORISED static void
add_four_squares(struct chunk *restrict chunk, const float *const *a, const float *const *b)
{
	const float *restrict a0 = a[0] + chunk->x0, *restrict a1 = a[1] + chunk->x0;
	const float *restrict a2 = a[2] + chunk->x0, *restrict a3 = a[3] + chunk->x0;
	const float *restrict b0 = b[0] + chunk->x0, *restrict b1 = b[1] + chunk->x0;
	const float *restrict b2 = b[2] + chunk->x0, *restrict b3 = b[3] + chunk->x0;

	for (size_t i = 0; i < chunk->n; i++) {
		double p0 = a0[i], p1 = a1[i], p2 = a2[i], p3 = a3[i];
		double q0 = b0[i], q1 = b1[i], q2 = b2[i], q3 = b3[i];

		add_squares_of_four(chunk, i, p0, p1, p2, p3, q0, q1, q2, q3);
	}
}

/* scale_a, scale_b: the inverse lengths. Equal spectra cancel exactly. */
SPEC_VECTORISED static void
add_units(struct chunk *restrict chunk, const float *restrict a, const float *restrict b,
	const double *restrict scale_a, const double *restrict scale_b)
{
	for (size_t i = 0; i < chunk->n; i++) {
		double u = a[i] * scale_a[i], v = b[i] * scale_b[i];

		chunk->minus[i] += (u - v) * (u - v);
		chunk->plus[i] += (u + v) * (u + v);
	}
}

SPEC_VECTORISED static void
add_four_units(struct chunk *restrict chunk, const float *const *a, const float *const *b,
	const double *restrict scale_a, const double *restrict scale_b)
{
	const float *restrict a0 = a[0] + chunk->x0, *restrict a1 = a[1] + chunk->x0;
	const float *restrict a2 = a[2] + chunk->x0, *restrict a3 = a[3] + chunk->x0;
	const float *restrict b0 = b[0] + chunk->x0, *restrict b1 = b[1] + chunk->x0;
	const float *restrict b2 = b[2] + chunk->x0, *restrict b3 = b[3] + chunk->x0;

	for (size_t i = 0; i < chunk->n; i++) {
		double s = scale_a[i], t = scale_b[i];
		double u0 = a0[i] * s, u1 = a1[i] * s, u2 = a2[i] * s, u3 = a3[i] * s;
		double v0 = b0[i] * t, v1 = b1[i] * t, v2 = b2[i] * t, v3 = b3[i] * t;
		double m0 = u0 - v0, m1 = u1 - v1, m2 = u2 - v2, m3 = u3 - v3;

		chunk->minus[i] += (m0 * m0 + m1 * m1) + (m2 * m2 + m3 * m3);
		u0 += v0;
		u1 += v1;
		u2 += v2;
		u3 += v3;
		chunk->plus[i] += (u0 * u0 + u1 * u1) + (u2 * u2 + u3 * u3);
	}
}

/*
 * The same, and X, Y and Z of both. w: the weights of X, those of Y and Z follow after all
 * bands.
 */
SPEC_VECTORISED static void
add_four_bands(struct chunk *restrict chunk, const float *const *a, const float *const *b,
	const double *restrict w, size_t bands)
{
	const float *restrict a0 = a[0] + chunk->x0, *restrict a1 = a[1] + chunk->x0;
	const float *restrict a2 = a[2] + chunk->x0, *restrict a3 = a[3] + chunk->x0;
	const float *restrict b0 = b[0] + chunk->x0, *restrict b1 = b[1] + chunk->x0;
	const float *restrict b2 = b[2] + chunk->x0, *restrict b3 = b[3] + chunk->x0;
	const double *restrict y = w + bands, *restrict z = y + bands;
	double *restrict xyz_a = chunk->xyz_a, *restrict xyz_b = chunk->xyz_b;

	for (size_t i = 0; i < chunk->n; i++) {
		double p0 = a0[i], p1 = a1[i], p2 = a2[i], p3 = a3[i];
		double q0 = b0[i], q1 = b1[i], q2 = b2[i], q3 = b3[i];

		add_squares_of_four(chunk, i, p0, p1, p2, p3, q0, q1, q2, q3);
		xyz_a[i] += (w[0] * p0 + w[1] * p1) + (w[2] * p2 + w[3] * p3);
		xyz_b[i] += (w[0] * q0 + w[1] * q1) + (w[2] * q2 + w[3] * q3);
		xyz_a[CHUNK + i] += (y[0] * p0 + y[1] * p1) + (y[2] * p2 + y[3] * p3);
		xyz_b[CHUNK + i] += (y[0] * q0 + y[1] * q1) + (y[2] * q2 + y[3] * q3);
		xyz_a[2 * CHUNK + i] += (z[0] * p0 + z[1] * p1) + (z[2] * p2 + z[3] * p3);
		xyz_b[2 * CHUNK + i] += (z[0] * q0 + z[1] * q1) + (z[2] * q2 + z[3] * q3);
	}
}

SPEC_VECTORISED static void
add_colour(const float *restrict a, size_t n, const double *w, size_t bands,
	double *restrict xyz)
{
	double wx = w[0], wy = w[bands], wz = w[2 * bands];

	for (size_t i = 0; i < n; i++) {
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

/* How many bands are taken by fours: what is not finite is replaced band by band. */
static size_t
by_fours(const struct chunk *chunk)
{
	return chunk->dirty ? 0 : chunk->setup->bands / 4 * 4;
}

static void
pass_bands(struct chunk *chunk)
{
	const double *w = chunk->setup->weight_xyz;
	size_t band = 0, bands = chunk->setup->bands;
	const float *a, *b;

	memset(chunk->aa, 0, sizeof chunk->aa);
	memset(chunk->bb, 0, sizeof chunk->bb);
	memset(chunk->square, 0, sizeof chunk->square);
	memset(chunk->worst, 0, sizeof chunk->worst);
	memset(chunk->largest, 0, sizeof chunk->largest);
	if (w) {
		memset(chunk->xyz_a, 0, sizeof chunk->xyz_a);
		memset(chunk->xyz_b, 0, sizeof chunk->xyz_b);
	}
	for (; band < by_fours(chunk); band += 4) {
		if (w)
			add_four_bands(
				chunk, chunk->a + band, chunk->b + band, w + band, bands);
		else
			add_four_squares(chunk, chunk->a + band, chunk->b + band);
	}
	for (; band < bands; band++) {
		fetch(chunk, band, &a, &b);
		add_squares(chunk, a, b);
		if (!w)
			continue;
		add_colour(a, chunk->n, w + band, bands, chunk->xyz_a);
		add_colour(b, chunk->n, w + band, bands, chunk->xyz_b);
	}
}

/* A float's square never overflows a double: only what is not finite spoils a sum. */
SPEC_VECTORISED static int
squares_spoiled(const struct chunk *chunk)
{
	int spoiled = 0;

	for (size_t i = 0; i < chunk->n; i++) {
		double both = chunk->aa[i] + chunk->bb[i];

		spoiled |= !(both - both == 0);
	}
	return spoiled;
}

static void
open_chunk(struct chunk *chunk, int y, struct spec_measure *row)
{
	chunk->dirty = 0;
	memset(chunk->bad, 0, sizeof chunk->bad);
	pass_bands(chunk);
	if (squares_spoiled(chunk)) {
		chunk->dirty = 1;
		count_nonfinite(chunk, y, row);
		pass_bands(chunk);
	}
	row->largest_a = (float)greater(
		largest_of(chunk->largest, chunk->n, 1), (double)row->largest_a);
}

/* In one loop the compiler would take an arc only where it is wanted, one by one. */
SPEC_VECTORISED static void
find_angles(struct chunk *restrict chunk)
{
	for (size_t i = 0; i < chunk->n; i++)
		chunk->angle[i] =
			spec_vector_atan2(sqrt(chunk->minus[i]), sqrt(chunk->plus[i]));
	for (size_t i = 0; i < chunk->n; i++) {
		double minus = chunk->minus[i], plus = chunk->plus[i], both = minus + plus;
		double fit = fabs(plus - minus) / both;

		chunk->angle[i] = minus > 0 ? 2 * chunk->angle[i] : 0;
		chunk->fit[i] = both > 0 ? fit : 1;
	}
}

SPEC_VECTORISED static void
find_scales(const double *restrict square, size_t n, double *restrict scale)
{
	for (size_t i = 0; i < n; i++) {
		double inverse = 1 / sqrt(square[i]);

		scale[i] = square[i] > 0 ? inverse : 0;
	}
}

static void
pass_units(struct chunk *chunk)
{
	double scale_a[CHUNK], scale_b[CHUNK];
	size_t band = 0;
	const float *a, *b;

	memset(chunk->minus, 0, sizeof chunk->minus);
	memset(chunk->plus, 0, sizeof chunk->plus);
	find_scales(chunk->aa, chunk->n, scale_a);
	find_scales(chunk->bb, chunk->n, scale_b);
	for (; band < by_fours(chunk); band += 4)
		add_four_units(chunk, chunk->a + band, chunk->b + band, scale_a, scale_b);
	for (; band < chunk->setup->bands; band++) {
		fetch(chunk, band, &a, &b);
		add_units(chunk, a, b, scale_a, scale_b);
	}
	find_angles(chunk);
}

/* 1 where the XYZ are the same, else 0. */
SPEC_VECTORISED static void
find_same(const struct chunk *restrict chunk, double *restrict same)
{
	const double *x = chunk->xyz_a, *y = x + CHUNK, *z = y + CHUNK;
	const double *u = chunk->xyz_b, *v = u + CHUNK, *w = v + CHUNK;

	for (size_t i = 0; i < chunk->n; i++)
		same[i] = ((x[i] == u[i]) & (y[i] == v[i]) & (z[i] == w[i])) ? 1 : 0;
}

/* Of the same XYZ no difference, whatever they are; a NaN could pass a tolerance. */
SPEC_VECTORISED static void
settle(const double *restrict same, size_t count, double *restrict difference)
{
	for (size_t i = 0; i < count; i++) {
		double known = difference[i] <= DBL_MAX ? difference[i] : INFINITY;

		difference[i] = same[i] > 0 ? 0 : known;
	}
}

static void
find_colours(struct chunk *chunk)
{
	double *const a[3] = {chunk->xyz_a, chunk->xyz_a + CHUNK, chunk->xyz_a + 2 * CHUNK};
	double *const b[3] = {chunk->xyz_b, chunk->xyz_b + CHUNK, chunk->xyz_b + 2 * CHUNK};
	double same[CHUNK];

	find_same(chunk, same);
	spec_lab_row(chunk->setup->white_xyz, a, chunk->n);
	spec_lab_row(chunk->setup->white_xyz, b, chunk->n);
	spec_difference_ciede2000_row((const double *const *)a, (const double *const *)b,
		chunk->n, chunk->colour);
	settle(same, chunk->n, chunk->colour);
}

/* The first of the values, times sign, that is the most of them, if it is above the extreme. */
static void
take_extreme(const double *value, size_t count, double sign, size_t x, int y,
	struct spec_measure_extreme *extreme)
{
	double best = largest_of(value, count, sign);
	size_t i = 0;

	if (!(best > sign * extreme->value))
		return;
	while (sign * value[i] != best)
		i++;
	*extreme = (struct spec_measure_extreme){value[i], {x + i, y, 0}};
}

/* The first of the chunk's largest differences: its pixel, then its band. */
static void
take_difference(const struct chunk *chunk, int y, struct spec_measure *row)
{
	double worst = largest_of(chunk->worst, chunk->n, 1);

	if (!(worst > row->difference.value))
		return;
	for (size_t i = 0; i < chunk->n; i++) {
		size_t x = chunk->x0 + i;

		if (chunk->worst[i] != worst)
			continue;
		for (size_t band = 0; band < chunk->setup->bands; band++) {
			double d = (double)chunk->a[band][x] - chunk->b[band][x];

			if (fabs(d) != worst)
				continue;
			row->difference.value = worst;
			row->difference.place = (struct spec_measure_place){x, y, band};
			row->difference_a = chunk->a[band][x];
			row->difference_b = chunk->b[band][x];
			return;
		}
	}
}

/* Angles, fits and colours of count pixels from the chunk's first on. */
static void
take_pixels(const struct chunk *chunk, size_t first, size_t count, int y,
	struct spec_measure *row)
{
	size_t x = chunk->x0 + first;

	if (chunk->setup->want_angle) {
		sum_add_all(&row->angle, chunk->angle + first, count);
		sum_add_all(&row->fit, chunk->fit + first, count);
		take_extreme(chunk->angle + first, count, 1, x, y, &row->angle_most);
		take_extreme(chunk->fit + first, count, -1, x, y, &row->fit_least);
	}
	if (chunk->setup->weight_xyz) {
		sum_add_all(&row->colour, chunk->colour + first, count);
		take_extreme(chunk->colour + first, count, 1, x, y, &row->colour_most);
	}
}

static void
measure_chunk(struct chunk *chunk, int y, struct spec_measure *row)
{
	open_chunk(chunk, y, row);
	if (chunk->setup->want_angle)
		pass_units(chunk);
	if (chunk->setup->weight_xyz)
		find_colours(chunk);
	sum_add_all(&row->square, chunk->square, chunk->n);
	take_difference(chunk, y, row);
	if (!chunk->dirty)
		take_pixels(chunk, 0, chunk->n, y, row);
	for (size_t i = 0; i < chunk->n && chunk->dirty; i++)
		if (!chunk->bad[i])
			take_pixels(chunk, i, 1, y, row);
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
	spec_measure_sum_join(&total->square, &row->square);
	spec_measure_sum_join(&total->angle, &row->angle);
	spec_measure_sum_join(&total->fit, &row->fit);
	spec_measure_sum_join(&total->colour, &row->colour);
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
	return spec_measure_sum_value(sum) / (double)measure->pixels;
}

double
spec_measure_rmse(const struct spec_measure *measure)
{
	if (!comparable(measure))
		return INFINITY;
	return sqrt(spec_measure_sum_value(&measure->square) / (double)measure->samples);
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
