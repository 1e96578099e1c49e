/* Images of three colours become spectral: channels R, G, B make place for bands. */
#ifndef SPEC_IMAGE_FROMRGB_H
#define SPEC_IMAGE_FROMRGB_H

#include <stdatomic.h>
#include <stddef.h>

#include "base/error.h"
#include "image/image.h"
#include "image/reader.h"
#include "image/settings.h"
#include "image/upsampling.h"
#include "spectrum/curve.h"
#include "spectrum/grid.h"

#define SPEC_FROMRGB_GRID "380:780:5" /* where none is given */

struct spec_fromrgb_setup {
	enum spec_upsampling_model model;
	enum spec_upsampling_use use;
	const struct spec_grid *grid;      /* of the bands, or null */
	enum spec_extrapolate extrapolate; /* of D65 */
	int half;                          /* bands are stored as HALF */
};

struct spec_fromrgb {
	const struct spec_image *input;
	struct spec_image image; /* the output's, indexed */
	struct spec_upsampling upsampling;
	size_t colour[3]; /* the input's channels R, G, B */
	size_t *origin;   /* of each channel of the output that is no band: the input's */
	unsigned char *wanted; /* per channel of the input */
	atomic_ullong clamped; /* pixels with a component out of range */
};

/*
 * Works out the output's header. The bands are means over bins (spec:bins): T of quantity
 * "reflectance", or "factor" where it is unbounded, or S0 of "radiance per nm". They are
 * HALF where R is, else FLOAT. R, G, B and chromaticities go, all else passes through.
 * Errors: SPEC_EFORMAT  no channel R, G or B, or whole numbers in one; bands already
 *         SPEC_EUNSUPPORTED  other primaries or another white than Rec. 709's and D65
 *                            (within 0.001, in the attribute chromaticities)
 *         those of spec_upsampling_plan. name: the file, for messages.
 */
enum spec_status spec_fromrgb_plan(struct spec_fromrgb *fromrgb,
	const struct spec_image *input, const struct spec_fromrgb_setup *setup,
	const char *name, struct spec_error *error);
void spec_fromrgb_free(struct spec_fromrgb *fromrgb);

/* Reads all lines and writes them to the settings' output; as spec_image_save. */
enum spec_status spec_fromrgb_run(struct spec_fromrgb *fromrgb, struct spec_reader *reader,
	const struct spec_settings *settings, unsigned long long *overflows,
	struct spec_error *error);

#endif
