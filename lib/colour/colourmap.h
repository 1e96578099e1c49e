/* Colour maps: from a number to a colour that the eye takes for one. */
#ifndef SPEC_COLOUR_COLOURMAP_H
#define SPEC_COLOUR_COLOURMAP_H

/*
 * Viridis, perceptually uniform and monotonic in lightness, from dark blue at 0 to yellow
 * at 1; what lies outside gets the nearer end's colour.
 * Returned: rgb  encoded as sRGB, 0 to 255
 * Source:   N. Smith, S. van der Walt: mpl colour maps (2015), published under CC0 at
 *           github.com/BIDS/colormap; every 5th of its 256 colours, linear between them,
 *           which is within 0.003 of the others.
 */
void spec_colourmap_viridis(double share, unsigned char rgb[3]);

#endif
