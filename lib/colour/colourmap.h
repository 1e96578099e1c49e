/* Colour maps: from a number to a colour that the eye takes for one. */
#ifndef SPEC_COLOUR_COLOURMAP_H
#define SPEC_COLOUR_COLOURMAP_H

#include "base/error.h"

struct spec_colourmap {
	const char *name; /* as on the command line */
	/* share: what lies outside 0 to 1 gets the nearer end's colour, NaN that of 0 */
	void (*colour)(double share, unsigned char rgb[3]);
};

/*
 * "viridis", "grey", "cool-warm" or "hue". Error (SPEC_EUSAGE): another name; the known ones
 * are in the message.
 */
const struct spec_colourmap *spec_colourmap_find(
	const char *name, struct spec_error *error);

/*
 * The colour of a value on a scale on which low is the map's 0 and high its 1; low may be the
 * larger one, but not equal. NaN is grey (128, 128, 128), an infinity magenta (255, 0, 255).
 */
void spec_colourmap_paint(const struct spec_colourmap *map, double value, double low,
	double high, unsigned char rgb[3]);

/* The maps themselves. Returned: rgb  encoded as sRGB, 0 to 255 */

/*
 * Viridis, perceptually uniform and monotonic in lightness, from dark blue at 0 to yellow
 * at 1.
 * Source:   N. Smith, S. van der Walt: mpl colour maps (2015), published under CC0 at
 *           github.com/BIDS/colormap; every 5th of its 256 colours, linear between them,
 *           which is within 0.003 of the others.
 */
void spec_colourmap_viridis(double share, unsigned char rgb[3]);

/* Greys whose CIELAB lightness L* is 100 share (CIE 15:2018). */
void spec_colourmap_grey(double share, unsigned char rgb[3]);

/*
 * For values on both sides of one that is neutral, which has 1/2: from blue by a light grey to
 * red, of equal lightness at equal distances from 1/2.
 * Source:   K. Moreland: Diverging Color Maps for Scientific Visualization, ISVC 2009, with
 *           the ends (59, 76, 192) and (180, 4, 38).
 */
void spec_colourmap_cool_warm(double share, unsigned char rgb[3]);

/*
 * For angles: 0 and 1 have one colour. A circle of hues, lightness 0.75 and chroma 0.12, in
 * OKLab, which begins at red.
 * Source:   B. Ottosson: A perceptual color space for image processing, 2020.
 */
void spec_colourmap_hue(double share, unsigned char rgb[3]);

#endif
