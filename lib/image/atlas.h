/*
 * Atlases of spectra: many curves in one OpenEXR image of 32-bit floats R, G, B and A, for
 * programs that read textures.
 *
 * Each column of each curve is a line of the image. Texel x of it has the values at four
 * wavelengths, LO + (4 x + c) STEP, c = 0 of R to 3 of A; what is beyond the last is 0. After
 * these ceil(samples / 4) texels one more has a colour: R, G, B of sRGB, linear, 1 for white,
 * of light as it is and of reflectances and transmittances under D65, by the observer of 1931,
 * and A = 1; or all 0 where the column is neither, as of an index. A is a value like the
 * others: colours are not multiplied by it. Attributes, both strings:
 *   spec:atlas        "LO:HI:STEP" [nm]
 *   spec:atlas-lines  for each line of the image one of text, with tabs between: the curve's
 *                     name, the column's, quantity, unit, medium, title, source
 * Source: after the textures, 128 texels from 324 nm on, of D. Schiffner,
 *         Wellenlängenbasiertes Beleuchtungsmodell im Shader (2008).
 */
#ifndef SPEC_IMAGE_ATLAS_H
#define SPEC_IMAGE_ATLAS_H

#include <stddef.h>

#include "base/error.h"
#include "image/reader.h"
#include "image/settings.h"
#include "spectrum/curve.h"
#include "spectrum/grid.h"

#define SPEC_ATLAS_GRID "324:835:1" /* where none is given: 128 texels and a colour */

/*
 * Writes an atlas of curves to the settings' output, as spec_image_save does.
 * Given:  curve, name   so many curves; a name is a path or a spectrum's, of which the last
 *                       component without .spd, .txt or .csv becomes the curve's
 *         grid          in equal steps, or null: SPEC_ATLAS_GRID
 *         extrapolate   what the curves are outside their data
 * Errors: SPEC_EUSAGE  two curves of one name, a grid of other steps, another format than
 *                      OpenEXR; SPEC_ERANGE  outside the data, beyond floats
 */
enum spec_status spec_atlas_write(const struct spec_curve *curve, const char *const *name,
	size_t curves, const struct spec_grid *grid, enum spec_extrapolate extrapolate,
	const struct spec_settings *settings, struct spec_error *error);

/*
 * The curve of that name from an atlas, all its columns, with its texts; values are those of
 * the shortest decimals that are the same float. Errors: SPEC_EFORMAT  no atlas, a damaged
 * one; SPEC_EUSAGE  no such curve, with the names that are there. Then curve is empty.
 */
enum spec_status spec_atlas_curve(struct spec_reader *reader, const char *name,
	struct spec_curve *curve, struct spec_error *error);

#endif
