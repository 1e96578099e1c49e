#include "compare/detail.h"

#include <math.h>
#include <string.h>

#include "base/vector.h"
#include "colour/difference.h"

/* Pixels at a time: the sums stay in the first-level cache. */
#define CHUNK 64

#define COLOURS (1u << SPEC_DETAIL_DE76 | 1u << SPEC_DETAIL_DE94 | 1u << SPEC_DETAIL_DE2000)
#define ANGLES (1u << SPEC_DETAIL_SAM | 1u << SPEC_DETAIL_GFC)

struct chunk {
	const struct spec_measure_setup *setup;
	const float *const *a, *const *b;
	size_t x0, n;
	float clean_a[CHUNK], clean_b[CHUNK]; /* 0 for what is not finite */
	int spoiled[CHUNK];                   /* not finite, and not the same */
	double square[CHUNK], magnitude[CHUNK], most[CHUNK];
	double aa[CHUNK], bb[CHUNK], sum_a[CHUNK], sum_b[CHUNK];
	double minus[CHUNK],
		plus[CHUNK]; /* squared lengths of u - v, u + v of unit vectors */
	double divergence[CHUNK];
	double xyz_a[3][CHUNK], xyz_b[3][CHUNK];
};

/* Neumaier 1974: keeps what each addition rounds away. */
static void
sum_add(struct spec_measure_sum *sum, double value)
{
	double total = sum->sum + value;

	if (fabs(sum->sum) >= fabs(value))
		sum->lost += (sum->sum - total) + value;
	else
		sum->lost += (value - total) + sum->sum;
	sum->sum = total;
}

static double
sum_value(const struct spec_measure_sum *sum)
{
	return isfinite(sum->sum) ? sum->sum + sum->lost : sum->sum;
}

/* Returns how many samples of the band differ and are not finite. */
static size_t
fetch(struct chunk *chunk, size_t band)
{
	size_t spoiled = 0;

	for (size_t i = 0; i < chunk->n; i++) {
		float p = chunk->a[band][chunk->x0 + i], q = chunk->b[band][chunk->x0 + i];
		int finite = isfinite(p) && isfinite(q);
		int differs = !finite && p != q && !(isnan(p) && isnan(q));

		chunk->clean_a[i] = finite ? p : 0;
		chunk->clean_b[i] = finite ? q : 0;
		chunk->spoiled[i] |= differs;
		spoiled += differs;
	}
	return spoiled;
}

SPEC_VECTORISED static void
add_differences(struct chunk *restrict chunk, size_t n)
{
	for (size_t i = 0; i < n; i++) {
		double p = chunk->clean_a[i], q = chunk->clean_b[i], d = p - q;
		double magnitude = fabs(d);

		chunk->square[i] += d * d;
		chunk->magnitude[i] += magnitude;
		chunk->most[i] = magnitude > chunk->most[i] ? magnitude : chunk->most[i];
		chunk->aa[i] += p * p;
		chunk->bb[i] += q * q;
		chunk->sum_a[i] += p > 0 ? p : 0;
		chunk->sum_b[i] += q > 0 ? q : 0;
	}
}

/* Adds the chunk's part of a band: a plain sum of 64 is exact enough to add as one. */
static void
add_band(const struct chunk *chunk, size_t spoiled, struct spec_detail_band *band)
{
	double square = 0, magnitude = 0, square_a = 0, a = 0, b = 0;

	for (size_t i = 0; i < chunk->n; i++) {
		double p = chunk->clean_a[i], q = chunk->clean_b[i], d = p - q;

		square += d * d;
		magnitude += fabs(d);
		square_a += p * p;
		a += p;
		b += q;
		if (fabs(d) > band->most)
			band->most = fabs(d);
	}
	sum_add(&band->square, square);
	sum_add(&band->magnitude, magnitude);
	sum_add(&band->square_a, square_a);
	sum_add(&band->a, a);
	sum_add(&band->b, b);
	if (spoiled > 0)
		band->most = INFINITY;
	band->samples += chunk->n;
	band->nonfinite += spoiled;
}

static void
add_units(struct chunk *chunk)
{
	for (size_t i = 0; i < chunk->n; i++) {
		double u = chunk->aa[i] > 0 ? chunk->clean_a[i] / sqrt(chunk->aa[i]) : 0;
		double v = chunk->bb[i] > 0 ? chunk->clean_b[i] / sqrt(chunk->bb[i]) : 0;

		chunk->minus[i] += (u - v) * (u - v);
		chunk->plus[i] += (u + v) * (u + v);
	}
}

static void
add_divergence(struct chunk *chunk)
{
	for (size_t i = 0; i < chunk->n; i++) {
		double p = fmax(chunk->clean_a[i], 0), q = fmax(chunk->clean_b[i], 0);

		p = p > 0 ? p / chunk->sum_a[i] : 0;
		q = q > 0 ? q / chunk->sum_b[i] : 0;
		if (p == q)
			continue;
		chunk->divergence[i] +=
			p > 0 && q > 0 ? (p - q) * (log(p) - log(q)) : INFINITY;
	}
}

static void
add_colour(struct chunk *chunk, size_t band)
{
	for (int c = 0; c < 3; c++) {
		double w = chunk->setup->weight_xyz[(size_t)c * chunk->setup->bands + band];

		for (size_t i = 0; i < chunk->n; i++) {
			chunk->xyz_a[c][i] += w * chunk->clean_a[i];
			chunk->xyz_b[c][i] += w * chunk->clean_b[i];
		}
	}
}

static void
measure_colours(const struct chunk *chunk, size_t i, double value[SPEC_DETAIL_PIXELS])
{
	double a[3], b[3], lab_a[3], lab_b[3];

	for (int c = 0; c < 3; c++) {
		a[c] = chunk->xyz_a[c][i];
		b[c] = chunk->xyz_b[c][i];
	}
	if (a[0] == b[0] && a[1] == b[1] && a[2] == b[2])
		return;
	spec_lab_from_xyz(a, chunk->setup->white_xyz, lab_a);
	spec_lab_from_xyz(b, chunk->setup->white_xyz, lab_b);
	value[SPEC_DETAIL_DE76] = spec_difference_ab76(lab_a, lab_b);
	value[SPEC_DETAIL_DE94] = spec_difference_cie94(lab_a, lab_b);
	value[SPEC_DETAIL_DE2000] = spec_difference_ciede2000(lab_a, lab_b);
}

static void
measure_pixel(const struct chunk *chunk, size_t i, double value[SPEC_DETAIL_PIXELS])
{
	double bands = (double)chunk->setup->bands;
	double minus = chunk->minus[i], plus = chunk->plus[i], both = minus + plus;

	value[SPEC_DETAIL_RMSE] = sqrt(chunk->square[i] / bands);
	value[SPEC_DETAIL_MAE] = chunk->magnitude[i] / bands;
	value[SPEC_DETAIL_MAX] = chunk->most[i];
	value[SPEC_DETAIL_SAM] = minus > 0 ? 2 * atan2(sqrt(minus), sqrt(plus)) : 0;
	value[SPEC_DETAIL_GFC] = both > 0 ? fabs(plus - minus) / both : 1;
	value[SPEC_DETAIL_SID] = chunk->divergence[i];
	value[SPEC_DETAIL_DE76] = value[SPEC_DETAIL_DE94] = value[SPEC_DETAIL_DE2000] = 0;
	if (chunk->setup->weight_xyz)
		measure_colours(chunk, i, value);
}

static void
write_pixels(const struct chunk *chunk, spec_detail_wanted wanted,
	float *const map[SPEC_DETAIL_PIXELS])
{
	for (size_t i = 0; i < chunk->n; i++) {
		double value[SPEC_DETAIL_PIXELS];

		measure_pixel(chunk, i, value);
		for (int kind = 0; kind < SPEC_DETAIL_PIXELS; kind++) {
			double worst = kind == SPEC_DETAIL_GFC ? -INFINITY : INFINITY;
			int known = !chunk->spoiled[i] && !isnan(value[kind]);

			if (wanted & 1u << kind)
				map[kind][chunk->x0 + i] =
					(float)(known ? value[kind] : worst);
		}
	}
}

static void
measure_chunk(struct chunk *chunk, spec_detail_wanted wanted, struct spec_detail_band *band)
{
	int twice = (wanted & (ANGLES | 1u << SPEC_DETAIL_SID)) != 0;
	int colour = chunk->setup->weight_xyz && (wanted & COLOURS);

	for (size_t k = 0; k < chunk->setup->bands; k++) {
		size_t spoiled = fetch(chunk, k);

		add_differences(chunk, chunk->n);
		if (band)
			add_band(chunk, spoiled, &band[k]);
		if (colour)
			add_colour(chunk, k);
	}
	for (size_t k = 0; twice && k < chunk->setup->bands; k++) {
		fetch(chunk, k);
		if (wanted & ANGLES)
			add_units(chunk);
		if (wanted & 1u << SPEC_DETAIL_SID)
			add_divergence(chunk);
	}
}

void
spec_detail_row(const struct spec_measure_setup *setup, spec_detail_wanted wanted,
	const float *const *a, const float *const *b, size_t width,
	float *const map[SPEC_DETAIL_PIXELS], struct spec_detail_band *band)
{
	struct chunk chunk;

	if (band)
		memset(band, 0, setup->bands * sizeof *band);
	for (size_t x = 0; x < width; x += CHUNK) {
		memset(&chunk, 0, sizeof chunk);
		chunk.setup = setup;
		chunk.a = a;
		chunk.b = b;
		chunk.x0 = x;
		chunk.n = width - x < CHUNK ? width - x : CHUNK;
		measure_chunk(&chunk, wanted, band);
		if (wanted)
			write_pixels(&chunk, wanted, map);
	}
}

static void
sum_join(struct spec_measure_sum *total, const struct spec_measure_sum *row)
{
	sum_add(total, row->sum);
	total->lost += row->lost;
}

void
spec_detail_band_add(struct spec_detail_band *total, const struct spec_detail_band *row)
{
	sum_join(&total->square, &row->square);
	sum_join(&total->magnitude, &row->magnitude);
	sum_join(&total->square_a, &row->square_a);
	sum_join(&total->a, &row->a);
	sum_join(&total->b, &row->b);
	if (row->most > total->most)
		total->most = row->most;
	total->samples += row->samples;
	total->nonfinite += row->nonfinite;
}

static struct spec_detail_band
join(const struct spec_detail_band *band, size_t count)
{
	struct spec_detail_band all = {0};

	for (size_t i = 0; i < count; i++)
		spec_detail_band_add(&all, &band[i]);
	return all;
}

/* Nothing compared is nothing passed. */
static int
is_known(const struct spec_detail_band *all)
{
	return all->samples > 0 && all->nonfinite == 0;
}

double
spec_detail_rmse(const struct spec_detail_band *band, size_t count)
{
	struct spec_detail_band all = join(band, count);

	return is_known(&all) ? sqrt(sum_value(&all.square) / (double)all.samples)
			      : INFINITY;
}

double
spec_detail_mae(const struct spec_detail_band *band, size_t count)
{
	struct spec_detail_band all = join(band, count);

	return is_known(&all) ? sum_value(&all.magnitude) / (double)all.samples : INFINITY;
}

double
spec_detail_max(const struct spec_detail_band *band, size_t count)
{
	struct spec_detail_band all = join(band, count);

	return is_known(&all) ? all.most : INFINITY;
}

static double
ratio(double part, double whole)
{
	if (whole != 0)
		return part / whole;
	return part == 0 ? 0 : INFINITY;
}

double
spec_detail_relative(const struct spec_detail_band *band, size_t count)
{
	struct spec_detail_band all = join(band, count);

	return is_known(&all)
		       ? sqrt(ratio(sum_value(&all.square), sum_value(&all.square_a)))
		       : INFINITY;
}

double
spec_detail_energy(const struct spec_detail_band *band, const double *weight, size_t count)
{
	struct spec_detail_band all = join(band, count);
	double a = 0, difference = 0;

	if (!is_known(&all))
		return INFINITY;
	for (size_t i = 0; i < count; i++) {
		a += weight[i] * sum_value(&band[i].a);
		difference += weight[i] * (sum_value(&band[i].b) - sum_value(&band[i].a));
	}
	return ratio(difference, a);
}
