/*
 * Pictures of three colours become spectral: the models of colour/smits.h, colour/gaussian.h,
 * colour/upsample.h and colour/basis.h, for rows of pixels.
 */
#ifndef SPEC_IMAGE_UPSAMPLING_H
#define SPEC_IMAGE_UPSAMPLING_H

#include <stddef.h>

#include "base/error.h"
#include "colour/sigmoids.h"
#include "spectrum/curve.h"

enum spec_upsampling_model {
	SPEC_UPSAMPLING_SMITS,
	SPEC_UPSAMPLING_SUN,
	SPEC_UPSAMPLING_SIGMOID, /* Jakob and Hanika, by the table of colour/sigmoids.h */
	SPEC_UPSAMPLING_BASIS    /* Mallett and Yuksel */
};

enum spec_upsampling_use {
	SPEC_UPSAMPLING_ALBEDO,    /* a reflectance, in [0, 1]; not of Sun's model */
	SPEC_UPSAMPLING_UNBOUNDED, /* a factor >= 0 of any size */
	SPEC_UPSAMPLING_LIGHT      /* radiance: of D65, Y = 1, where the colour is white */
};

struct spec_upsampling_setup {
	enum spec_upsampling_model model;
	enum spec_upsampling_use use;
	size_t count;                /* bands, >= 1 */
	const double *wavelength_nm; /* [count]: point samples; or null */
	const double *edges_nm;      /* [count + 1], ascending: means over bins; or null */
	enum spec_extrapolate extrapolate; /* of D65; all else is known everywhere */
};

/* A sigmoid in a band is the sum of weight S(x(t)) over the band's nodes. */
struct spec_upsampling_node {
	float t, weight;
};

/* What rows are made with; afterwards only read, by any threads. */
struct spec_upsampling {
	enum spec_upsampling_model model;
	enum spec_upsampling_use use;
	size_t bands;
	float *most; /* [bands]: of an albedo of 1 */

	size_t columns; /* Smits, basis */
	float *basis;   /* [bands][columns] */

	struct spec_sigmoids sigmoids;
	size_t *first; /* [bands + 1]: where a band's nodes begin: one, or pairs */
	struct spec_upsampling_node *node;

	struct spec_gaussian_fit *sun;
	size_t widths;
	double *matrix;  /* [widths][9]: from RGB to the weights */
	float *gaussian; /* [bands][widths][3] */
};

/* smits, sun, sigmoid or basis; reflectance, unbounded or light. Else SPEC_EUSAGE. */
enum spec_status spec_upsampling_find_model(
	const char *name, enum spec_upsampling_model *model, struct spec_error *error);
enum spec_status spec_upsampling_find_use(
	const char *name, enum spec_upsampling_use *use, struct spec_error *error);

/* The error of an albedo of Sun's. */
enum spec_status spec_upsampling_refuse_sun(struct spec_error *error);

/*
 * Colours are linear, with Rec. 709's primaries and D65. How a model's spectrum is used:
 *     Smits, basis   as it is; as light, times D65. An albedo above 1, which Smits' red
 *                    reaches, becomes 1.
 *     sigmoid        as upsample.h says
 *     Sun            as light, solved as light; else solved under D65
 * Errors: SPEC_EUNSUPPORTED, an albedo of Sun's; SPEC_ERANGE, bands outside D65 that are
 * refused; those of the models.
 */
enum spec_status spec_upsampling_plan(struct spec_upsampling *upsampling,
	const struct spec_upsampling_setup *setup, struct spec_error *error);
void spec_upsampling_free(struct spec_upsampling *upsampling);

/*
 * One row: band[i] gets width samples of band i. A component that is not finite makes all
 * bands of its pixel NaN. A negative one counts as 0, and of an albedo one above 1 as 1.
 * Returned: the pixels in which that was so.
 * Accuracy: beside the functions for one colour in double, of the largest of the bands:
 *           Smits and basis 1e-6; Sun 1e-4, and 0.02 where the widths went another step
 *           down. A sigmoid of the table's coefficients 2e-6 of its scale at wavelengths;
 *           as a mean over bins, for which two nodes stand in each 5 nm, 1e-5 for most
 *           colours and 2e-3 for the most saturated.
 */
size_t spec_upsampling_row(const struct spec_upsampling *upsampling, const float *r,
	const float *g, const float *b, size_t width, float *const *band);

#endif
