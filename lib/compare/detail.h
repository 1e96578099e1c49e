/*
 * What each pixel and each band of two images has of their difference: what the percentiles,
 * the maps and the table of bands are made of. spec_measure has what is cheap to sum; this
 * costs more, and is done where it was asked for.
 */
#ifndef SPEC_COMPARE_DETAIL_H
#define SPEC_COMPARE_DETAIL_H

#include <stddef.h>
#include <stdint.h>

#include "compare/measure.h"

/* What can be said of one pixel. */
enum spec_detail_pixel {
	SPEC_DETAIL_RMSE, /* root of the mean of (a - b)^2 over the bands */
	SPEC_DETAIL_MAE,  /* mean |a - b| over the bands */
	SPEC_DETAIL_MAX,  /* largest |a - b| */
	SPEC_DETAIL_SAM,  /* spectral angle [rad], as spec_measure_row has it */
	SPEC_DETAIL_GFC,  /* goodness of fit; 1 is best */
	/*
	 * Spectral information divergence [nat]: the sum of (p - q) ln(p / q) of the spectra
	 * divided by their sums, p and q. Chang: An information-theoretic approach to spectral
	 * variability, similarity, and discrimination for hyperspectral image analysis. IEEE
	 * Transactions on Information Theory 46 (2000) 1927-1932, eq 11 to 14. What is below 0
	 * counts as 0; infinite where one side alone is 0 in a band; 0 of two that are 0
	 * in all.
	 */
	SPEC_DETAIL_SID,
	SPEC_DETAIL_DE76,   /* DeltaE*ab */
	SPEC_DETAIL_DE94,   /* of the second image from the first */
	SPEC_DETAIL_DE2000, /* CIEDE2000 */
	SPEC_DETAIL_PIXELS
};

/* One bit of each that is wanted, 1 << enum spec_detail_pixel. */
typedef unsigned spec_detail_wanted;

/* The sums of one band, over all pixels whose samples are finite on both sides. */
struct spec_detail_band {
	struct spec_measure_sum square, magnitude; /* of a - b */
	struct spec_measure_sum square_a;          /* of a */
	struct spec_measure_sum a, b;
	double most; /* |a - b|; infinite where samples differ that are not finite */
	uint64_t samples, nonfinite;
};

/*
 * Measures one row.
 * Given:    a, b   one pointer per band of the setup to width samples
 * Returned: map    of each wanted kind a row of width values; INFINITY (of GFC: -INFINITY)
 *                  where the pixel has samples that differ and are not finite
 *           band   setup->bands of them, of this row alone; may be null
 */
void spec_detail_row(const struct spec_measure_setup *setup, spec_detail_wanted wanted,
	const float *const *a, const float *const *b, size_t width,
	float *const map[SPEC_DETAIL_PIXELS], struct spec_detail_band *band);

/* Adds a row's band to that of the rows before it; what is all 0 is neutral. */
void spec_detail_band_add(
	struct spec_detail_band *total, const struct spec_detail_band *row);

/* Results of count bands together; infinite where samples differ that are not finite. */
double spec_detail_rmse(const struct spec_detail_band *band, size_t count);
double spec_detail_mae(const struct spec_detail_band *band, size_t count);
double spec_detail_max(const struct spec_detail_band *band, size_t count);

/*
 * Root of the sum of (a - b)^2 over that of a^2: 0 where both are 0, infinite where a
 * alone is.
 */
double spec_detail_relative(const struct spec_detail_band *band, size_t count);

/*
 * Peak signal-to-noise ratio 20 log10(peak / rmse) [dB]; infinite where rmse is 0, minus
 * infinity where peak is and rmse is not, and where samples differ that are not finite.
 */
double spec_detail_psnr(const struct spec_detail_band *band, size_t count, double peak);

/*
 * (B - A) / A of the integrals over wavelengths and pixels: sums of the bands with
 * weight[count], such as their widths. 0 where both are 0, infinite where A alone is.
 */
double spec_detail_energy(
	const struct spec_detail_band *band, const double *weight, size_t count);

#endif
