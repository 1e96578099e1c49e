/* What the colours of a false-colour picture mean: a strip below it. */
#ifndef SPEC_IMAGE_LEGEND_H
#define SPEC_IMAGE_LEGEND_H

#include "colour/colourmap.h"
#include "image/canvas.h"

#define SPEC_LEGEND_LEAST_WIDTH 256 /* pixels: the numbers do not touch */
#define SPEC_LEGEND_GAP 4           /* pixels, around what it is made of */

struct spec_legend {
	const struct spec_colourmap *map;
	double low, high;  /* what its two ends stand for */
	const char *label; /* such as a name and a unit */
};

/* Pixels of its height below a picture of that width, at least LEAST_WIDTH. */
size_t spec_legend_height(const struct spec_legend *legend, size_t width);

/*
 * Draws it into the last rows of a canvas: the colours, below them the numbers at their ends and
 * half-way, and the label between two of these or, where it is too long, in a line of its own;
 * there it is cut where even that is too short.
 */
void spec_legend_draw(const struct spec_legend *legend, struct spec_canvas *canvas);

#endif
