/* Dominant wavelength and purity: colours as a mixture of white and one pure colour. */
#ifndef SPEC_COLOUR_DOMINANT_H
#define SPEC_COLOUR_DOMINANT_H

#include "base/error.h"
#include "spectrum/curve.h"

/*
 * The line of purples joins the spectral locus at these wavelengths; beyond them pure
 * colours differ less than the tables have digits.
 */
#define SPEC_DOMINANT_FIRST_NM 380.0
#define SPEC_DOMINANT_LAST_NM 700.0

/* Chromaticities nearer to white than this have no hue: below a table's digits. */
#define SPEC_DOMINANT_WHITE 1e-6

/* x and y; NaN where X + Y + Z is not positive. */
void spec_dominant_xy(const double xyz[3], double xy[2]);

/*
 * The chromaticities of the observer's own samples from FIRST_NM to LAST_NM, or as many of
 * them as it has. Given: room for observer->count pairs and wavelengths [nm]; either may be
 * null. Returned: how many there are.
 */
size_t spec_dominant_locus(
	const struct spec_curve *observer, double (*xy)[2], double *wavelength_nm);

/*
 * Given:    observer    colour-matching functions in its first three columns
 *           xy, white   chromaticities by that observer
 * Returned: dominant_nm the wavelength where the line from white through xy meets the
 *                       spectral locus, which is straight between the observer's samples;
 *                       where it meets the line of purples, minus the complementary
 *                       wavelength, where the line back through white meets the locus.
 *                       NaN: neither, or xy is white, or not finite.
 *           purity      excitation purity: how far xy is from white, over how far the
 *                       locus or the line of purples is on that side; 0 at white, above
 *                       1 outside (no light has that); NaN where there is no such line.
 * Error:    SPEC_ENOMEM
 * Source:   CIE 15:2018, dominant and complementary wavelength, excitation purity.
 */
enum spec_status spec_dominant_find(const struct spec_curve *observer, const double xy[2],
	const double white[2], double *dominant_nm, double *purity,
	struct spec_error *error);

#endif
