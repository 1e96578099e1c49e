/*
 * Where people put spaces in coordinates and GeographicLib allows none, and the altitude
 * behind them, of which it knows nothing. For coordinates.c.
 */
#ifndef SPEC_PLACE_SPELLING_H
#define SPEC_PLACE_SPELLING_H

#include "base/error.h"

#define SPEC_SPELLING_LONGEST 256 /* a place, its zero included */

/*
 * The part before the altitude, pieces with one space between, and the altitude [m], which
 * is left as it is where there is none: a last piece that ends in m or km, or is one of
 * these after a number. SPEC_EUSAGE: nothing is there, or more than SPEC_SPELLING_LONGEST;
 * SPEC_ERANGE: the altitude.
 */
enum spec_status spec_spelling_part(const char *text, char spelt[SPEC_SPELLING_LONGEST],
	double *altitude_m, struct spec_error *error);

/*
 * Joins what belongs together: minutes and seconds to the degrees that stand before them,
 * and hemisphere letters to their number, behind or, where the text begins with one, before
 * it. Whether that changed anything.
 */
int spec_spelling_join(char spelt[SPEC_SPELLING_LONGEST]);

/* Whether it is a single number, perhaps with marks of degrees and a hemisphere. */
int spec_spelling_is_half(const char *spelt);

#endif
