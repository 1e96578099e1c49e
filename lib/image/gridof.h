/* The grid that a user names: numbers, or what has wavelengths. */
#ifndef SPEC_IMAGE_GRIDOF_H
#define SPEC_IMAGE_GRIDOF_H

#include "base/error.h"
#include "image/settings.h"
#include "spectrum/grid.h"

/*
 * text is "LO:HI:STEP", or an image or a curve, whose wavelengths the grid has. *edges_nm:
 * the edges of an image's bins, count + 1 and to be freed, or null. Errors: those of
 * spec_grid_parse, spec_reader_open and spec_lookup_curve; an image without bands
 * (SPEC_EFORMAT). Then grid is empty.
 */
enum spec_status spec_grid_of(const char *text, const struct spec_settings *settings,
	struct spec_grid *grid, double **edges_nm, struct spec_error *error);

#endif
