/*
 * Fewer bands: which of an image's bands to keep, and what their weights in a sum over all
 * bands become when the others are left out.
 *
 * Source: D. Schiffner, Wellenlängenbasiertes Beleuchtungsmodell im Shader (2008), 4.3, the
 * parameter "steps" of codes 5 and 6, and 4.6, the level of detail system: halves of halves
 * whose ends are kept, linear between them. There the observer's curves are interpolated,
 * too; here every band keeps its own weight, which goes to its two neighbours that are kept.
 */
#ifndef SPEC_COLOUR_COARSE_H
#define SPEC_COLOUR_COARSE_H

#include <stddef.h>

#include "base/error.h"

/*
 * The bands of a level. At level 0 the first and the last are kept; each level above it also
 * keeps the middle of every gap, the lower of two, so that level n has 2^n gaps or, where
 * there are no more bands, fewer. Every level keeps what those below it keep.
 * Given:    count  bands, >= 1
 * Returned: kept   count flags; and how many of them are set
 */
size_t spec_coarse_halve(size_t count, unsigned level, unsigned char *kept);

/* The lowest level that keeps all of count bands: 0 of up to two. */
unsigned spec_coarse_finest(size_t count);

/*
 * The bands that are a step apart, beginning with the first: 0, stride, 2 stride, ...
 * Given:    wavelength_nm  count, ascending
 *           step_nm        positive
 * Returned: stride         >= 1
 * Errors (SPEC_EUSAGE): the bands have no equal distance, to 1 % of it; the step is no
 *           multiple of that distance, to 1 % of it; only one band would remain.
 */
enum spec_status spec_coarse_stride(const double *wavelength_nm, size_t count,
	double step_nm, size_t *stride, struct spec_error *error);

/*
 * Each band kept stands for those up to the next: in place, of count weights, those at
 * multiples of the stride are multiplied by it, the others become 0. So a spectrum that is
 * flat is seen wrongly, by what the last band kept stands for beyond the end, or lacks.
 */
void spec_coarse_repeat(size_t count, size_t stride, double *weight);

/*
 * Linear between bands kept: in place, each of the other weights is shared by the two bands
 * around it, in proportion to nearness, and becomes 0. So sums over spectra that are linear
 * between the bands kept stay what they are. The first and the last band must be kept.
 */
void spec_coarse_interpolate(const double *wavelength_nm, size_t count,
	const unsigned char *kept, double *weight);

#endif
