/* What the files that plan a conversion share; see convert.h. */
#ifndef SPEC_IMAGE_CONVERTING_H
#define SPEC_IMAGE_CONVERTING_H

#include <stddef.h>

#include "base/error.h"
#include "image/convert.h"
#include "image/layers.h"

/* Bands, of the input or of the output. */
struct spec_converting_bands {
	size_t count;
	double *wavelength_nm;
	double *edges_nm; /* [count + 1], or null: point samples */
};

/* Channels of light, one for each band: a Stokes component, or a light layer. */
struct spec_converting_light {
	char prefix[64]; /* of the channels' names */
	int stokes;      /* 0 for layers */
	int is_layer;
	const size_t *channel; /* [bands] of the input */
};

struct spec_converting {
	struct spec_convert *convert;
	const struct spec_convert_setup *setup;
	const char *name; /* the file, for messages */
	struct spec_converting_bands known, made;
	int renewed; /* the output's bands are not those of the input as they are */
	/* Which of the known bands each made one is a sum of. */
	size_t *first; /* [made.count + 1] */
	size_t *band;
	double *weight;
	size_t terms, band_room, weight_room;
	struct spec_layers layers;
	struct spec_converting_light *light;
	size_t lights;
	char *quantity; /* the input's */
	int per_band;   /* the input's values are */
	int variances;  /* those of the output are made of those of the input */
};

/* Adds a line to the notes. */
void spec_converting_note(struct spec_converting *converting, const char *format, ...)
	__attribute__((format(printf, 2, 3)));

/* Fills known, made, renewed and the sums. Errors: those of grids and bins. */
enum spec_status spec_converting_bands(
	struct spec_converting *converting, struct spec_error *error);

/* Whether values are to become integrals over bands. */
int spec_converting_to_band(const struct spec_converting *converting);

/* Whether the image is one of light before operation at, counted from 0. */
int spec_converting_is_light(const struct spec_converting *converting, size_t at);

/* Checks that the operations suit the image. */
enum spec_status spec_converting_check(
	const struct spec_converting *converting, struct spec_error *error);

/* Leaves out the bands in which there is too little light to tell the reflectance. */
enum spec_status spec_converting_drop_dark(
	struct spec_converting *converting, struct spec_error *error);

/*
 * Where the image has variances (variances.h) and its samples change: has those of the new
 * bands in their place, or, if they cannot be known, none, with a note. SPEC_ENOMEM.
 */
enum spec_status spec_converting_renew_variances(
	struct spec_converting *converting, struct spec_error *error);

/*
 * The input's channel that such a channel of the output is made of, and its band; channels:
 * it is none of these.
 */
size_t spec_converting_find_variance(
	const struct spec_converting *converting, size_t channel, size_t *band);

/* Fills the convert's terms, offsets and steps. */
enum spec_status spec_converting_terms(
	struct spec_converting *converting, struct spec_error *error);

#endif
