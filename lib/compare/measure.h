/*
 * How far apart two images are, row by row. Rows are measured independently, by any
 * thread, and added in the order of the rows: then the result has the same bits for
 * every number of threads.
 *
 * Two samples are equal when both are NaN or the same infinity; they then count as
 * 0 in both images. Any other sample that is not finite differs from everything: it is
 * counted in nonfinite, and the metrics it touches become infinite, so that no
 * tolerance can pass (-infinity for those where large is good). No result is NaN.
 */
#ifndef SPEC_COMPARE_MEASURE_H
#define SPEC_COMPARE_MEASURE_H

#include <stddef.h>
#include <stdint.h>

#include "compare/sum.h"

struct spec_measure_setup {
	size_t bands;             /* per pixel, >= 1 */
	int want_angle;           /* spectral angle and goodness of fit */
	const double *weight_xyz; /* 3 * bands, from spec_observer_weights, when colour
	                             differences are wanted; else null */
	double white_xyz[3];      /* each > 0, on the scale of the weights; for colour */
	double peak;              /* of psnr; 0: the largest finite magnitude in A */
};

struct spec_measure_place {
	size_t x;
	int y;
	size_t band; /* 0 for what belongs to a pixel */
};

/* An extreme over the pixels; the earliest by y, x where several are equal. */
struct spec_measure_extreme {
	double value;
	struct spec_measure_place place;
};

struct spec_measure {
	uint64_t samples, pixels;
	uint64_t nonfinite; /* samples that differ and are not finite on both sides */
	struct spec_measure_place nonfinite_first; /* earliest by y, x, band */
	float nonfinite_a, nonfinite_b;            /* the two samples there */

	/*
	 * The largest |a - b|, infinite at nonfinite_first when there is one; place
	 * and samples are set only when it is above 0. Earliest by y, x, band.
	 */
	struct spec_measure_extreme difference;
	float difference_a, difference_b;
	float largest_a; /* the largest magnitude in A, of the samples that are finite in both */

	struct spec_measure_sum square; /* of a - b */
	struct spec_measure_sum angle;  /* [rad] */
	struct spec_measure_sum fit, colour;
	uint64_t nonfinite_pixels; /* pixels with such a sample: in no sum or extreme */

	struct spec_measure_extreme angle_most;  /* [rad] */
	struct spec_measure_extreme fit_least;   /* goodness of fit, 1 is best */
	struct spec_measure_extreme colour_most; /* CIEDE2000 */
};

/* The measure of nothing, neutral for spec_measure_add. */
void spec_measure_clear(struct spec_measure *measure);

/*
 * Measures one row.
 * Given:    a, b   one pointer per band to width samples
 *           width  pixels in the row
 *           y      the row, for the places
 * Returned: row    the measure of this row alone
 *
 * Spectral angle [rad, 0 to pi]: 2 atan2(|u - v|, |u + v|) of the spectra u, v made
 * unit vectors, which keeps its digits for nearly equal spectra and is exactly 0 for
 * equal ones (Kahan 2006, How futile are mindless assessments of roundoff, section
 * 12); 0 between two zero spectra, pi/2 between zero and another. Spectral angle
 * mapper: Kruse et al. 1993.
 * Goodness of fit: |sum of a b| / (|a| |b|), Romero, García-Beltrán, Hernández-Andrés
 * 1997; 1 between two zero spectra, 0 between zero and another.
 * Colour difference: CIEDE2000 of the pixel's XYZ = sums over the bands of weight_xyz.
 */
void spec_measure_row(const struct spec_measure_setup *setup, const float *const *a,
	const float *const *b, size_t width, int y, struct spec_measure *row);

/* Adds a row's (or several rows') measure to that of the rows before it. */
void spec_measure_add(struct spec_measure *total, const struct spec_measure *row);

/*
 * Results. Where nothing was measured (no pixels) they are as for a difference that is
 * not finite: nothing compared is nothing passed. The means and extremes of angle, fit
 * and colour mean something only when the setup wanted them.
 */
double spec_measure_rmse(const struct spec_measure *measure);        /* over all samples */
double spec_measure_max(const struct spec_measure *measure);         /* largest |a - b| */
double spec_measure_angle_mean(const struct spec_measure *measure);  /* [rad] */
double spec_measure_angle_max(const struct spec_measure *measure);   /* [rad] */
double spec_measure_fit_mean(const struct spec_measure *measure);    /* best 1 */
double spec_measure_fit_min(const struct spec_measure *measure);     /* best 1 */
double spec_measure_colour_mean(const struct spec_measure *measure); /* CIEDE2000 */
double spec_measure_colour_max(const struct spec_measure *measure);  /* CIEDE2000 */

/*
 * Peak signal-to-noise ratio 20 log10(peak / rmse) [dB]; peak as in the setup. Infinite
 * for equal images, -infinity when peak is 0 and the images differ.
 */
double spec_measure_psnr(const struct spec_measure *measure, double peak);

#endif
