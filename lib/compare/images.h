/* Two images: whether they are of the same kind, and how far apart their samples are. */
#ifndef SPEC_COMPARE_IMAGES_H
#define SPEC_COMPARE_IMAGES_H

#include "base/error.h"
#include "compare/detail.h"
#include "compare/matte.h"
#include "compare/measure.h"
#include "compare/significance.h"
#include "image/reader.h"
#include "image/settings.h"
#include "spectrum/curve.h"

/* From what a test of significance takes the noise. */
enum spec_images_noise {
	SPEC_IMAGES_NOISE_KNOWN,      /* the variances in the files, else the differences */
	SPEC_IMAGES_NOISE_VARIANCE,   /* the variances, which must be there */
	SPEC_IMAGES_NOISE_DIFFERENCES /* the differences in any case */
};

struct spec_images_setup {
	const struct spec_curve *observer; /* for colour differences; null: not wanted */
	/* On reflective images; its white is that of both. */
	const struct spec_curve *illuminant;
	int colour_optional; /* bands that the observer does not see are no error */
	double exposure;     /* stops: emissive light of 2^-exposure is white */
	int want_angle;
	double peak;             /* of psnr; 0: the largest magnitude in A */
	spec_detail_wanted maps; /* of pixels, that are to be kept */
	int want_seen;           /* what the observer sees of both */
	int want_bands;          /* sums of each band */
	int resample;            /* other bands are no difference: the overlap counts */
	int exact;               /* whether all bits are the same */
	double sigma;            /* of a test of significance; 0: none */
	enum spec_images_noise noise; /* of that test */
	/* What counts, 0,0 is the data window's corner; or null. */
	const struct spec_window *crop;
	const struct spec_matte *mask;   /* settled; or null */
	struct spec_reader *mask_reader; /* of another file; null: the mask is in A */
};

/* Whole numbers that are no bands, such as ids: equal or not. */
struct spec_whole {
	unsigned long long differing; /* samples */
	uint32_t a, b;                /* the pair farthest apart, the first of those */
	size_t x, channel;            /* where: the channel's index is A's */
	int y;
};

/* Samples whose bits are not the same, as floats of 32 bits. */
struct spec_exact {
	unsigned long long differing;
	uint32_t a, b; /* the first pair */
	size_t x, channel;
	int y;
};

struct spec_images {
	/* What is different about the images as such, a line each; "" if nothing is. */
	char structure[2048];
	/* What was done to compare them, a line each. */
	char notes[512];
	int comparable; /* the samples could be measured */
	int coloured;   /* colour differences were measured */
	size_t bands;   /* measured; of all Stokes components */
	int grid;       /* 0, or 1: the places' channels are those of B */
	/* Of the bands, or, in images without any, of all channels but whole numbers. */
	struct spec_measure spectral;
	struct spec_measure others; /* of all other channels */
	struct spec_whole whole;
	struct spec_exact exact;
	struct spec_significance test; /* its places count from the region's corner */
	int known_variances;           /* of that test: from channels variance.NAME */

	struct spec_window region;     /* that was measured */
	struct spec_detail_band *band; /* [bands] where wanted, or null */
	size_t *band_channel;          /* [bands], of the image that grid tells */
	double *band_nm;               /* [bands]; 0 where the channel is no band */
	double *width_nm;              /* [bands], with the sums */
	/* Where wanted, or null: width * height of region; NaN: outside the mask. */
	float *map[SPEC_DETAIL_PIXELS];
	/* X, Y, Z of each pixel of both images, likewise, on the scale of white_xyz. */
	float *seen[2];
	double white_xyz[3]; /* where coloured */
};

/*
 * Compares windows, quantity, bands and channels, and, where these agree, all the
 * samples. A place's band is the index of the channel in A, or in B where result->grid
 * says so; its x and y count from the data window's corner. A difference is no
 * error: errors are those of reading; a crop outside the image or a mask of another
 * window (SPEC_ERANGE).
 */
enum spec_status spec_images_compare(struct spec_images *result, struct spec_reader *a,
	struct spec_reader *b, const struct spec_images_setup *setup,
	const struct spec_settings *settings, struct spec_error *error);

void spec_images_free(struct spec_images *result);

/*
 * The value that percent (0 to 100) of a map's pixels are not above, by nearest rank; NaN of no
 * pixels. *x, *y: the first pixel that has it, from the data window's corner.
 * Error: SPEC_ENOMEM.
 */
enum spec_status spec_images_percentile(const struct spec_images *result,
	enum spec_detail_pixel kind, double percent, double *value, size_t *x, int *y,
	struct spec_error *error);

/* The mean of a map; NaN of no pixels. */
double spec_images_mean(const struct spec_images *result, enum spec_detail_pixel kind);

#endif
