/*
 * How far the mean of a pixel's samples may be off, from the scatter of means of batches of
 * them: with batches of n_i of the n samples, whose sums are s_i, B of them and s the whole,
 *   (sum of s_i^2 / n_i - s^2 / n) / ((B - 1) n)
 * is the variance of the mean without a bias, if the samples are independent. Those of
 * sampler.h fill the pixel evenly, in each batch and, better, in all: so it is too large, by
 * at most about B where all is smooth. That of single samples (B = n) would be by n.
 */
#ifndef SPEC_RENDER_VARIANCE_H
#define SPEC_RENDER_VARIANCE_H

#include <stddef.h>

#define SPEC_VARIANCE_BATCHES 8 /* at most; fewer samples are each one */

/* Whether a batch of a pixel's samples ends with the one of that number, from 0. */
int spec_variance_ends(unsigned sample, unsigned samples);

/*
 * Adds a batch of size samples, which brought the sums from before[count] to after[count], to
 * squares[count]; before becomes after.
 */
void spec_variance_add(
	double *squares, double *before, const double *after, size_t count, unsigned size);

/*
 * Turns squares[count] to variances of the means; samples: n, 2 or more. What rounding leaves
 * below 0 is 0.
 */
void spec_variance_finish(
	double *squares, const double *sum, size_t count, unsigned samples);

#endif
