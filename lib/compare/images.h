/* Two images: whether they are of the same kind, and how far apart their samples are. */
#ifndef SPEC_COMPARE_IMAGES_H
#define SPEC_COMPARE_IMAGES_H

#include "base/error.h"
#include "compare/measure.h"
#include "image/reader.h"
#include "image/settings.h"
#include "spectrum/curve.h"

struct spec_images_setup {
	const struct spec_curve *observer; /* for CIEDE2000; null: not wanted */
	const struct spec_curve
		*illuminant; /* on reflective images; its white is that of both */
	int colour_optional; /* bands that the observer does not see are no error */
	double exposure;     /* stops: emissive light of 2^-exposure is white */
	int want_angle;
	double peak; /* of psnr; 0: the largest magnitude in A */
};

/* Whole numbers that are no bands, such as ids: equal or not. */
struct spec_whole {
	unsigned long long differing; /* samples */
	uint32_t a, b;                /* the pair farthest apart, the first of those */
	size_t x, channel;            /* where: the channel's index is A's */
	int y;
};

struct spec_images {
	/* What is different about the images as such, a line each; "" if nothing is. */
	char structure[2048];
	int comparable; /* the samples could be measured */
	int coloured;   /* CIEDE2000 was measured */
	size_t bands;   /* measured; of all Stokes components */
	/* Of the bands, or, in images without any, of all channels but whole numbers. */
	struct spec_measure spectral;
	struct spec_measure others; /* of all other channels */
	struct spec_whole whole;
};

/*
 * Compares windows, quantity, bands and channels, and, where these agree, all the
 * samples. A place's band is the index of the channel in A. A difference is no
 * error: errors are those of reading.
 */
enum spec_status spec_images_compare(struct spec_images *result, struct spec_reader *a,
	struct spec_reader *b, const struct spec_images_setup *setup,
	const struct spec_settings *settings, struct spec_error *error);

#endif
