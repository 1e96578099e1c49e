/*
 * Spectra for RGB colours after Smits: as much white as there is in the colour, then as
 * much cyan, magenta or yellow, then what remains of red, green or blue, each a spectrum
 * of ten steps.
 * Source: Smits: An RGB-to-spectrum conversion for reflectances. Journal of Graphics Tools
 *         4 (4), 1999, 11-22.
 * Reading: the ten values are those of ten bins of 34 nm from 380 nm on, each of 34 samples
 *         at whole nanometres, and so spectra/upsampling/smits has them. So integrated, by
 *         sums over these samples of the CIE's table of 1931, the seven spectra under equal
 *         energy meet their colours, of Rec. 709's primaries and a white of equal energy,
 *         to 0.001. (Taken for points between which the spectrum is linear they miss by
 *         0.09.) Beyond 380 and 719 nm the outer bins go on.
 * Range:  the red spectrum reaches 1.0149, cyan 1.0007: not quite reflectances.
 */
#ifndef SPEC_COLOUR_SMITS_H
#define SPEC_COLOUR_SMITS_H

#include "colour/basis.h"

#define SPEC_SMITS_SPECTRUM "upsampling/smits"

/* The columns of the basis. */
enum spec_smits {
	SPEC_SMITS_WHITE,
	SPEC_SMITS_CYAN,
	SPEC_SMITS_MAGENTA,
	SPEC_SMITS_YELLOW,
	SPEC_SMITS_RED,
	SPEC_SMITS_GREEN,
	SPEC_SMITS_BLUE,
	SPEC_SMITS_COLUMNS
};

/*
 * The weights of the seven spectra, of which at most three are not 0.
 * Given: rgb, linear, finite, >= 0. Returned: weight[SPEC_SMITS_COLUMNS], each >= 0.
 */
void spec_smits_weights(const double rgb[3], double weight[SPEC_SMITS_COLUMNS]);

#endif
