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
	int label_below;   /* it has a line of its own, as long ones need */
};

/*
 * Pixels of its height below a picture so wide. It is drawn twice as large, three times and
 * so on as a picture has whole multiples of WIDTH, so that it can be read where a large
 * picture is shown small.
 */
#define SPEC_LEGEND_WIDTH 800
size_t spec_legend_height(const struct spec_legend *legend, size_t width);

/*
 * Draws it into the last rows of a canvas, at least LEAST_WIDTH wide: the colours, below
 * them the numbers at their ends and half-way, and the label between the first two of these
 * or below; what is too long of it is cut at the right side.
 */
void spec_legend_draw(const struct spec_legend *legend, struct spec_canvas *canvas);

#endif
