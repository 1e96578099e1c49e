/* The options of specconvert that say what becomes of bands, values and pixels. */
#ifndef SPEC_IMAGE_CONVERTOPTIONS_H
#define SPEC_IMAGE_CONVERTOPTIONS_H

#include <stddef.h>

#include "base/error.h"
#include "image/convert.h"
#include "image/settings.h"
#include "spectrum/abscissa.h"
#include "spectrum/grid.h"
#include "spectrum/operation.h"
#include "spectrum/represent.h"

struct spec_convert_options {
	/* What to do; once settled it refers to what stands below. Of curves, a part of it. */
	struct spec_convert_setup setup;
	enum spec_abscissa abscissa;   /* of curves */
	int has_interpolation, has_to; /* --interp and --to were given */
	struct spec_representation to;

	const char *grid_text; /* of --grid, or null */
	struct spec_grid grid, bands;
	double *edges_nm; /* of the grid, where its file tells them */
	struct spec_operation *operation;
	size_t operation_room, band_room;
};

/* No option given. */
void spec_convert_options_init(struct spec_convert_options *options);
void spec_convert_options_free(struct spec_convert_options *options);

/*
 * Takes grid, interp, rebin, band, bands-only, per, to-air, to-vacuum, input-unit, to, least,
 * extrapolate, crop, downsample, or what spec_operation_parse knows, by its long name; of
 * others *known is 0. Values must stay until options is freed. Errors: a value that is none;
 * those of reading a curve.
 */
enum spec_status spec_convert_options_take(struct spec_convert_options *options,
	const char *name, const char *value, int *known, struct spec_error *error);

/* The same of illuminate and reflectance-of, whose light is not known before the image is. */
enum spec_status spec_convert_options_defer(struct spec_convert_options *options,
	const char *name, const char *value, int *known, struct spec_error *error);

/*
 * Once all options are taken: reads the grid where it is a file's, and fills in setup. Errors:
 * SPEC_EUSAGE, options that do not go together; those of spec_grid_of.
 */
enum spec_status spec_convert_options_settle(struct spec_convert_options *options,
	const struct spec_settings *settings, struct spec_error *error);

/* Whether they change an image; another representation is no change. */
int spec_convert_options_change(const struct spec_convert_options *options);

#endif
