/* What the parts of a comparison of images share; compare/images.h is its outside. */
#ifndef SPEC_COMPARE_COMPARING_H
#define SPEC_COMPARE_COMPARING_H

#include <stddef.h>

#include "base/error.h"
#include "colour/space.h"
#include "compare/images.h"
#include "image/image.h"

/* The channels that are measured: A's and B's, pair by pair. */
struct spec_comparing_pairs {
	size_t count;
	size_t *a, *b;
};

/* Bands made of the channels of one image: sums, those of band i from first[i] on. */
struct spec_comparing_sums {
	size_t *first; /* [pairs + 1], or null: the bands are the channels as they are */
	size_t *channel;
	double *weight;
};

struct spec_comparing {
	struct spec_images *result;
	const struct spec_images_setup *setup;
	const struct spec_image *a, *b;
	struct spec_comparing_pairs bands, others;
	struct spec_comparing_pairs variances; /* of all bands, or none */
	struct spec_comparing_sums sums[2];    /* of A and of B */
	/* The one of both that is a picture, where the other has bands; else null. */
	const struct spec_image *picture;
	/* The wavelengths of the bands that are measured, and the edges, or null. */
	size_t grid_bands;
	const double *grid_nm, *grid_edges_nm;
	struct spec_measure_setup spectral_setup, others_setup;
	double *weight_xyz, *width_nm;
	struct spec_window region; /* 0,0 is the corner of the data window */
};

/* Adds a line to what is different about the images as such. */
void spec_comparing_say(struct spec_images *result, const char *format, ...)
	__attribute__((format(printf, 2, 3)));

/* Room for sums of so many bands and terms in all, those of a band from 0 on. */
enum spec_status spec_comparing_new_sums(struct spec_comparing_sums *sums, size_t bands,
	size_t terms, struct spec_error *error);

/* Compares the images as such and pairs their channels. Errors: as spec_comparing_shown. */
enum spec_status spec_comparing_structure(
	struct spec_comparing *comparison, struct spec_error *error);

/*
 * Where the bands differ and the setup allows another grid: plans the sums on the coarser
 * of both, as far as it lies in the other, and *done is 1. Else *done is 0, and there is
 * no common stretch, or bins on one side alone. Error: SPEC_ENOMEM.
 */
enum spec_status spec_comparing_resample(
	struct spec_comparing *comparison, int *done, struct spec_error *error);

/*
 * Where one image has bands and the other channels R, G and B in place of them: plans three
 * sums that are red, green and blue of the one, in the primaries of the other, as spec2rgb has
 * them with the setup's observer, illuminant and exposure, and adapts nothing. Else, without an
 * observer or bit for bit, does nothing, and picture stays null. Errors: those of spec_rgb_plan.
 */
enum spec_status spec_comparing_shown(
	struct spec_comparing *comparison, struct spec_error *error);

/*
 * Finds the channels with the variances of the means that the bands are: "variance." and the
 * band's name, of every band on both sides; else there are none. Error: SPEC_ENOMEM.
 */
enum spec_status spec_comparing_variances(
	struct spec_comparing *comparison, struct spec_error *error);

/* The primaries that a picture names, or those of Rec. 709, which are sRGB's. */
enum spec_status spec_comparing_space(
	const struct spec_image *image, struct spec_space *space, struct spec_error *error);

/* Plans the colours of the bands, or of the channels R, G and B. Errors: those of observers. */
enum spec_status spec_comparing_colour(
	struct spec_comparing *comparison, struct spec_error *error);

/* The width of each band that is measured [nm], or 1; 0 for Stokes components but S0. */
enum spec_status spec_comparing_widths(
	struct spec_comparing *comparison, struct spec_error *error);

/* Adds the whole numbers, count of each side as bits of floats, of line y of A's channel. */
void spec_comparing_whole_row(const float *a, const float *b, size_t count, size_t channel,
	int y, struct spec_whole *whole);
/* Adds those of a line that comes after all that total has. */
void spec_comparing_whole_add(struct spec_whole *total, const struct spec_whole *row);

/* Adds line y bit for bit; plane: A's count samples of all pairs, then B's. */
void spec_comparing_exact_row(const struct spec_comparing_pairs *pairs,
	const float *const *plane, size_t count, int y, struct spec_exact *exact);
void spec_comparing_exact_add(struct spec_exact *total, const struct spec_exact *row);

void spec_comparing_free(struct spec_comparing *comparison);

/* A band's whole numbers come out of the decoder as floats, others as they are. */
static inline int
spec_comparing_is_whole(const struct spec_channel *channel)
{
	return channel->sample == SPEC_SAMPLE_UINT && channel->role == SPEC_ROLE_OTHER;
}

#endif
