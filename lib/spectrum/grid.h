/* Wavelength grids: the wavelengths at which something is known or wanted. */
#ifndef SPEC_SPECTRUM_GRID_H
#define SPEC_SPECTRUM_GRID_H

#include <stddef.h>

#include "base/error.h"

#define SPEC_GRID_LOWEST_NM 1.0
#define SPEC_GRID_HIGHEST_NM 1e6
#define SPEC_GRID_LONGEST 32767 /* wavelengths */

struct spec_grid {
	double *wavelength_nm; /* strictly ascending */
	size_t count;          /* >= 1 once filled */
};

/*
 * A grid of count wavelengths, all 0, for the caller to fill in.
 * count: 1..SPEC_GRID_LONGEST, else SPEC_ERANGE. Also SPEC_ENOMEM.
 */
enum spec_status spec_grid_new(
	size_t count, struct spec_grid *grid, struct spec_error *error);

/*
 * The grid that "LO:HI:STEP" describes, in nm: LO + i * STEP for i = 0, 1, … up to HI.
 * LO and HI lie in SPEC_GRID_LOWEST_NM..SPEC_GRID_HIGHEST_NM, LO <= HI, STEP > 0.
 * SPEC_EUSAGE: not three numbers; reversed bounds; a STEP that is not positive; or a HI
 * that lies more than 1e-6 STEP off the grid, and then the message names the nearest HI
 * that fits. SPEC_ERANGE: a bound outside its range, or more than SPEC_GRID_LONGEST
 * wavelengths. SPEC_ENOMEM. On an error grid is empty.
 */
enum spec_status spec_grid_parse(
	const char *text, struct spec_grid *grid, struct spec_error *error);

/* copy becomes a grid of its own with source's wavelengths. SPEC_ENOMEM; then copy is empty. */
enum spec_status spec_grid_copy(
	const struct spec_grid *source, struct spec_grid *copy, struct spec_error *error);

/*
 * The step of ascending wavelengths that are a regular grid: none lies farther off it than
 * 0.001 nm, which names of three decimals agree within, and 1 % of the step. 0: they are
 * irregular, or fewer than two.
 */
double spec_grid_step(const double *wavelength_nm, size_t count);

/*
 * The index of the wavelength nearest to one, among count >= 1 that ascend; *same: it is that
 * one, which it is within 0.001 nm (names of three and of six decimals agree) but no
 * farther than a quarter of the way to its neighbours.
 */
size_t spec_grid_nearest(
	const double *known_nm, size_t count, double wavelength_nm, int *same);

/* Frees what grid holds and leaves it empty; null or empty is allowed. */
void spec_grid_free(struct spec_grid *grid);

#endif
