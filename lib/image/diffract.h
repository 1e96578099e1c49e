/*
 * specdisc's work on images: the light of the lamp layers, diffracted at the image's own
 * surface, is added to the bands:
 *   S0 = S0 + sum over lamps of f_r (N.D) lamp
 */
#ifndef SPEC_IMAGE_DIFFRACT_H
#define SPEC_IMAGE_DIFFRACT_H

#include <stdatomic.h>

#include "base/error.h"
#include "image/layers.h"
#include "image/mask.h"
#include "image/reader.h"
#include "image/relight.h"
#include "image/settings.h"
#include "optics/disc.h"

/* spec_disc_composite or spec_disc_orders. */
typedef void spec_disc_model(const struct spec_disc *disc,
	const struct spec_disc_bands *bands, const struct spec_disc_pixels *pixels,
	double *reflection, size_t stride);

struct spec_diffract_setup {
	const struct spec_disc *disc;
	const struct spec_mask *mask; /* which surfaces each disc is on */
	size_t discs;
	spec_disc_model *model;
	int has_centre; /* the tangent is that of circles around it, in place of Tan */
	double centre[3], axis[3]; /* in world space [m]; the axis is not 0 */
	int keep, half;
};

struct spec_diffract {
	struct spec_relight relight;
	struct spec_layers layers;
	struct spec_diffract_setup setup;
	const char *name;
	atomic_llong bare; /* pixels of surfaces that no disc is for, left out */
};

/*
 * Works out the output's header and what is read. Arguments as spec_fold_plan's. Errors: no
 * lamp layers, layers that spec_layers_find refuses; no normal (Ns or N), no I, no Tan (or
 * no P, where there is a centre), a lamp without D, no id where a mask asks for it.
 */
enum spec_status spec_diffract_plan(struct spec_diffract *diffract,
	const struct spec_image *input, const struct spec_diffract_setup *setup,
	const char *name, struct spec_error *error);
void spec_diffract_free(struct spec_diffract *diffract);

/* Reads all lines, adds the light and writes them; as spec_fold_run. */
enum spec_status spec_diffract_run(struct spec_diffract *diffract,
	struct spec_reader *reader, const struct spec_settings *settings,
	unsigned long long *overflows, struct spec_error *error);

#endif
