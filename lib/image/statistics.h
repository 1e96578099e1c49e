/*
 * Statistics of the samples of channels. Lines are measured one by one, by any thread, and
 * added in their order, so that the results have the same bits for every number of threads.
 */
#ifndef SPEC_IMAGE_STATISTICS_H
#define SPEC_IMAGE_STATISTICS_H

#include <stddef.h>

#include "base/error.h"
#include "image/reader.h"
#include "image/settings.h"

/* What reflects so much more than all is above 1: floats near 1 have room for rounding. */
#define SPEC_STATISTICS_ONE 1.00001F

/* Samples of a kind: how many, and the first by y, x from the data window's corner. */
struct spec_statistics_kind {
	unsigned long long count;
	size_t x;
	int y;
};

struct spec_statistics {
	unsigned long long samples; /* all of them */
	unsigned long long finite;
	struct spec_statistics_kind nan, infinite;
	struct spec_statistics_kind negative;  /* finite and below 0 */
	struct spec_statistics_kind above_one; /* finite and above SPEC_STATISTICS_ONE */
	/* Of the finite samples; where there are none, they mean nothing. */
	float minimum, maximum;
	double mean;
	double squares; /* sum of (sample - mean)^2 */
};

/*
 * Measures width samples at row, line y. The mean is that of the line, then the squares are
 * summed about it: two passes, so no digits cancel.
 */
void spec_statistics_line(
	struct spec_statistics *statistics, const float *row, size_t width, int y);

/*
 * Adds part, which comes after what total holds already. Means and squares as in Chan,
 * Golub & LeVeque 1979, "Updating formulae and a pairwise algorithm for computing sample
 * variances", eq 2.1. A total of nothing is all 0.
 */
void spec_statistics_add(struct spec_statistics *total, const struct spec_statistics *part);

/* The standard deviation sqrt(squares / finite) of the samples themselves; NaN: none. */
double spec_statistics_deviation(const struct spec_statistics *statistics);

/* Whether the reader gives a channel as numbers: not so a UINT that is no band. */
int spec_statistics_applies(const struct spec_channel *channel);

/*
 * Reads all lines. result: one for each channel of the image, of which those are filled
 * that are wanted (one flag per channel) and that spec_statistics_applies to.
 */
enum spec_status spec_statistics_run(struct spec_statistics *result,
	struct spec_reader *reader, const unsigned char *wanted,
	const struct spec_settings *settings, struct spec_error *error);

#endif
