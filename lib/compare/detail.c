#include "compare/detail.h"

#include <math.h>
#include <string.h>

#include "base/vector.h"
#include "colour/difference.h"

/* Pixels at a time: the sums stay in the first-level cache. */
#define CHUNK 64

#define LANES 8 /* sums and extremes side by side */

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
	double scale_a[CHUNK], scale_b[CHUNK]; /* inverse lengths */
	double minus[CHUNK],
		plus[CHUNK]; /* squared lengths of u - v, u + v of unit vectors */
	double xyz_a[3][CHUNK], xyz_b[3][CHUNK]; /* X, Y, Z; then L*, a*, b* */
	double value[SPEC_DETAIL_PIXELS][CHUNK];
};

/* Copies with 0 for what is not finite on both sides; returns whether there is any. */
SPEC_VECTORISED static int
clean(const float *restrict a, const float *restrict b, size_t count,
	float *restrict clean_a, float *restrict clean_b)
{
	int bad = 0;

	for (size_t i = 0; i < count; i++) {
		float p = a[i], q = b[i];
		int finite = (p - p == 0) & (q - q == 0);

		clean_a[i] = finite ? p : 0;
		clean_b[i] = finite ? q : 0;
		bad |= !finite;
	}
	return bad;
}

/* Returns how many samples of the band differ and are not finite. */
static size_t
fetch(struct chunk *chunk, size_t band)
{
	const float *a = chunk->a[band] + chunk->x0, *b = chunk->b[band] + chunk->x0;
	size_t spoiled = 0;

	if (!clean(a, b, chunk->n, chunk->clean_a, chunk->clean_b))
		return 0;
	for (size_t i = 0; i < chunk->n; i++) {
		int finite = isfinite(a[i]) && isfinite(b[i]);
		int differs = !finite && a[i] != b[i] && !(isnan(a[i]) && isnan(b[i]));

		chunk->spoiled[i] |= differs;
		spoiled += (size_t)differs;
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

/* Of one band and chunk: a plain sum of 64 is exact enough to add as one. */
struct part {
	double square[LANES], magnitude[LANES], square_a[LANES], a[LANES], b[LANES];
	double most[LANES];
};

/* Pixels beyond the chunk's last are 0. */
SPEC_VECTORISED static void
sum_part(const float *restrict a, const float *restrict b, struct part *restrict part)
{
	for (size_t i = 0; i < CHUNK; i += LANES) {
		for (size_t k = 0; k < LANES; k++) {
			double p = a[i + k], q = b[i + k], d = p - q, magnitude = fabs(d);

			part->square[k] += d * d;
			part->magnitude[k] += magnitude;
			part->square_a[k] += p * p;
			part->a[k] += p;
			part->b[k] += q;
			part->most[k] =
				magnitude > part->most[k] ? magnitude : part->most[k];
		}
	}
}

static double
sum_lanes(const double lane[LANES])
{
	return ((lane[0] + lane[1]) + (lane[2] + lane[3])) +
	       ((lane[4] + lane[5]) + (lane[6] + lane[7]));
}

static void
add_band(const struct chunk *chunk, size_t spoiled, struct spec_detail_band *band)
{
	struct part part = {0};

	sum_part(chunk->clean_a, chunk->clean_b, &part);
	spec_measure_sum_add(&band->square, sum_lanes(part.square));
	spec_measure_sum_add(&band->magnitude, sum_lanes(part.magnitude));
	spec_measure_sum_add(&band->square_a, sum_lanes(part.square_a));
	spec_measure_sum_add(&band->a, sum_lanes(part.a));
	spec_measure_sum_add(&band->b, sum_lanes(part.b));
	for (size_t k = 0; k < LANES; k++)
		band->most = fmax(band->most, part.most[k]);
	if (spoiled > 0)
		band->most = INFINITY;
	band->samples += chunk->n;
	band->nonfinite += spoiled;
}

SPEC_VECTORISED static void
find_scales(const double *restrict square, double *restrict scale)
{
	for (size_t i = 0; i < CHUNK; i++) {
		double inverse = 1 / sqrt(square[i]);

		scale[i] = square[i] > 0 ? inverse : 0;
	}
}

SPEC_VECTORISED static void
add_units(struct chunk *restrict chunk, size_t n)
{
	for (size_t i = 0; i < n; i++) {
		double u = chunk->clean_a[i] * chunk->scale_a[i];
		double v = chunk->clean_b[i] * chunk->scale_b[i];

		chunk->minus[i] += (u - v) * (u - v);
		chunk->plus[i] += (u + v) * (u + v);
	}
}

/* Both shares are above 0, or nothing is added, or infinity. */
SPEC_VECTORISED static void
add_divergence(struct chunk *restrict chunk, size_t n)
{
	double ratio[CHUNK];

	for (size_t i = 0; i < n; i++) {
		double p = chunk->clean_a[i] / chunk->sum_a[i];
		double q = chunk->clean_b[i] / chunk->sum_b[i];

		ratio[i] = ((p > 0) & (q > 0)) ? p / q : 1;
	}
	for (size_t i = 0; i < n; i++)
		ratio[i] = spec_vector_log(ratio[i]);
	for (size_t i = 0; i < n; i++) {
		double p = chunk->clean_a[i] / chunk->sum_a[i];
		double q = chunk->clean_b[i] / chunk->sum_b[i];
		double all = (p - q) * ratio[i], none = ((p > 0) | (q > 0)) ? INFINITY : 0;

		chunk->value[SPEC_DETAIL_SID][i] += ((p > 0) & (q > 0)) ? all : none;
	}
}

SPEC_VECTORISED static void
add_colour(struct chunk *restrict chunk, size_t n, const double *w, size_t bands)
{
	double x = w[0], y = w[bands], z = w[2 * bands];

	for (size_t i = 0; i < n; i++) {
		double a = chunk->clean_a[i], b = chunk->clean_b[i];

		chunk->xyz_a[0][i] += x * a;
		chunk->xyz_a[1][i] += y * a;
		chunk->xyz_a[2][i] += z * a;
		chunk->xyz_b[0][i] += x * b;
		chunk->xyz_b[1][i] += y * b;
		chunk->xyz_b[2][i] += z * b;
	}
}

static void
find_colours(struct chunk *chunk, spec_detail_wanted wanted)
{
	double *const a[3] = {chunk->xyz_a[0], chunk->xyz_a[1], chunk->xyz_a[2]};
	double *const b[3] = {chunk->xyz_b[0], chunk->xyz_b[1], chunk->xyz_b[2]};
	int same[CHUNK] = {0};

	for (size_t i = 0; i < chunk->n; i++)
		same[i] = a[0][i] == b[0][i] && a[1][i] == b[1][i] && a[2][i] == b[2][i];
	spec_lab_row(chunk->setup->white_xyz, a, chunk->n);
	spec_lab_row(chunk->setup->white_xyz, b, chunk->n);
	if (wanted & 1u << SPEC_DETAIL_DE2000)
		spec_difference_ciede2000_row((const double *const *)a,
			(const double *const *)b, chunk->n,
			chunk->value[SPEC_DETAIL_DE2000]);
	for (size_t i = 0; i < chunk->n; i++) {
		double one[3] = {a[0][i], a[1][i], a[2][i]};
		double two[3] = {b[0][i], b[1][i], b[2][i]};

		if (wanted & 1u << SPEC_DETAIL_DE76)
			chunk->value[SPEC_DETAIL_DE76][i] = spec_difference_ab76(one, two);
		if (wanted & 1u << SPEC_DETAIL_DE94)
			chunk->value[SPEC_DETAIL_DE94][i] = spec_difference_cie94(one, two);
		for (int kind = SPEC_DETAIL_DE76; kind <= SPEC_DETAIL_DE2000; kind++)
			chunk->value[kind][i] = same[i] ? 0 : chunk->value[kind][i];
	}
}

/* In one loop the compiler would take an arc only where it is wanted, one by one. */
SPEC_VECTORISED static void
find_angles(struct chunk *restrict chunk, size_t n)
{
	double *restrict angle = chunk->value[SPEC_DETAIL_SAM];
	double *restrict fit = chunk->value[SPEC_DETAIL_GFC];

	for (size_t i = 0; i < n; i++)
		angle[i] = spec_vector_atan2(sqrt(chunk->minus[i]), sqrt(chunk->plus[i]));
	for (size_t i = 0; i < n; i++) {
		double minus = chunk->minus[i], plus = chunk->plus[i], both = minus + plus;
		double share = fabs(plus - minus) / both;

		angle[i] = minus > 0 ? 2 * angle[i] : 0;
		fit[i] = both > 0 ? share : 1;
	}
}

static void
find_distances(struct chunk *chunk)
{
	double bands = (double)chunk->setup->bands;

	for (size_t i = 0; i < chunk->n; i++) {
		chunk->value[SPEC_DETAIL_RMSE][i] = sqrt(chunk->square[i] / bands);
		chunk->value[SPEC_DETAIL_MAE][i] = chunk->magnitude[i] / bands;
		chunk->value[SPEC_DETAIL_MAX][i] = chunk->most[i];
	}
}

static void
write_pixels(const struct chunk *chunk, spec_detail_wanted wanted,
	float *const map[SPEC_DETAIL_PIXELS])
{
	for (int kind = 0; kind < SPEC_DETAIL_PIXELS; kind++) {
		double worst = kind == SPEC_DETAIL_GFC ? -INFINITY : INFINITY;

		for (size_t i = 0; i < chunk->n && (wanted & 1u << kind); i++) {
			double value = chunk->value[kind][i];
			int known = !chunk->spoiled[i] && !isnan(value);

			map[kind][chunk->x0 + i] = (float)(known ? value : worst);
		}
	}
}

static void
measure_chunk(struct chunk *chunk, spec_detail_wanted wanted, struct spec_detail_band *band)
{
	int twice = (wanted & (ANGLES | 1u << SPEC_DETAIL_SID)) != 0;
	int colour = chunk->setup->weight_xyz && (wanted & COLOURS);
	size_t bands = chunk->setup->bands;

	for (size_t k = 0; k < bands; k++) {
		size_t spoiled = fetch(chunk, k);

		add_differences(chunk, chunk->n);
		if (band)
			add_band(chunk, spoiled, &band[k]);
		if (colour)
			add_colour(chunk, chunk->n, chunk->setup->weight_xyz + k, bands);
	}
	find_scales(chunk->aa, chunk->scale_a);
	find_scales(chunk->bb, chunk->scale_b);
	for (size_t k = 0; twice && k < bands; k++) {
		fetch(chunk, k);
		if (wanted & ANGLES)
			add_units(chunk, chunk->n);
		if (wanted & 1u << SPEC_DETAIL_SID)
			add_divergence(chunk, chunk->n);
	}
	find_distances(chunk);
	if (wanted & ANGLES)
		find_angles(chunk, chunk->n);
	if (colour)
		find_colours(chunk, wanted);
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

void
spec_detail_band_add(struct spec_detail_band *total, const struct spec_detail_band *row)
{
	spec_measure_sum_join(&total->square, &row->square);
	spec_measure_sum_join(&total->magnitude, &row->magnitude);
	spec_measure_sum_join(&total->square_a, &row->square_a);
	spec_measure_sum_join(&total->a, &row->a);
	spec_measure_sum_join(&total->b, &row->b);
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

	return is_known(&all)
		       ? sqrt(spec_measure_sum_value(&all.square) / (double)all.samples)
		       : INFINITY;
}

double
spec_detail_mae(const struct spec_detail_band *band, size_t count)
{
	struct spec_detail_band all = join(band, count);

	return is_known(&all) ? spec_measure_sum_value(&all.magnitude) / (double)all.samples
			      : INFINITY;
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

	return is_known(&all) ? sqrt(ratio(spec_measure_sum_value(&all.square),
					spec_measure_sum_value(&all.square_a)))
			      : INFINITY;
}

double
spec_detail_psnr(const struct spec_detail_band *band, size_t count, double peak)
{
	double rmse = spec_detail_rmse(band, count);

	return rmse == 0 ? INFINITY : 20 * log10(peak / rmse);
}

double
spec_detail_energy(const struct spec_detail_band *band, const double *weight, size_t count)
{
	struct spec_detail_band all = join(band, count);
	double a = 0, difference = 0;

	if (!is_known(&all))
		return INFINITY;
	for (size_t i = 0; i < count; i++) {
		a += weight[i] * spec_measure_sum_value(&band[i].a);
		difference += weight[i] * (spec_measure_sum_value(&band[i].b) -
						  spec_measure_sum_value(&band[i].a));
	}
	return ratio(difference, a);
}
