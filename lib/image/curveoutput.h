/*
 * What specconvert makes of curves: a text, a chart of patches, a strip, or an atlas.
 */
#ifndef SPEC_IMAGE_CURVEOUTPUT_H
#define SPEC_IMAGE_CURVEOUTPUT_H

#include "base/error.h"
#include "image/image.h"
#include "image/kind.h"
#include "image/patches.h"
#include "image/settings.h"
#include "image/strip.h"
#include "spectrum/curve.h"
#include "spectrum/grid.h"

#define SPEC_CURVE_OUTPUT_MOST 4096 /* curves of one image */

struct spec_curve_output {
	struct spec_patches_setup patches;   /* columns 0: --patches was not given */
	int strip;                           /* its height, or 0 */
	enum spec_strip_scaling scaling;     /* of the strip */
	int atlas;                           /* --atlas was given */
	const struct spec_image *attributes; /* a chart gets this one's, too; or null */
};

/* No option given: patches of one pixel, without a gap. */
void spec_curve_output_init(struct spec_curve_output *output);

/*
 * Takes patches, patch, gap, strip, scaling or atlas, by its long name; of others *known is
 * 0. Errors (SPEC_EUSAGE, SPEC_ERANGE): a value that is none.
 */
enum spec_status spec_curve_output_take(struct spec_curve_output *output, const char *name,
	const char *value, int *known, struct spec_error *error);

/* The option that was given, as "--strip", or null; patch and gap alone are none. */
const char *spec_curve_output_option(const struct spec_curve_output *output);

/*
 * Whether so many curves can become this. kind: of the file, where it is known; a strip is a
 * picture and has none. Errors: SPEC_EUSAGE, options that do not go together; SPEC_ERANGE, too
 * many curves.
 */
enum spec_status spec_curve_output_check(const struct spec_curve_output *output,
	enum spec_kind kind, size_t curves, struct spec_error *error);

/* One curve as text of a kind; path as spec_spd_save has it, and its errors. */
enum spec_status spec_curve_output_text(enum spec_kind kind, const struct spec_curve *curve,
	const char *path, struct spec_error *error);

/*
 * Writes curves to settings' output.
 * Given:  output   as above; patches' extrapolate and half are set, and its grid, of the
 *                  bands; null: the first curve's, or the atlas's own
 *         kind     SPEC_KIND_IMAGE: a chart, of one row where nothing else was asked for;
 *                  of a strip and an atlas nothing
 *         name     of each curve, for an atlas
 * Errors: those of spec_strip_save, spec_atlas_write, spec_spd_save, spec_patches_write.
 */
enum spec_status spec_curve_output_save(const struct spec_curve_output *output,
	enum spec_kind kind, const struct spec_curve *curve, const char *const *name,
	size_t curves, const struct spec_settings *settings, unsigned long long *overflows,
	struct spec_error *error);

#endif
