#include "image/legend.h"

#include <stdio.h>

#define GAP SPEC_LEGEND_GAP
#define BAR 12 /* pixels, the height of the colours */
#define LINE (GAP + SPEC_CANVAS_TEXT_HEIGHT)

size_t
spec_legend_height(const struct spec_legend *legend)
{
	return 2 * GAP + BAR + LINE + (legend->label_below ? LINE : 0);
}

static void
draw_number(struct spec_canvas *canvas, double number, size_t x, size_t y,
	enum spec_canvas_anchor anchor)
{
	char text[32];

	snprintf(text, sizeof text, "%.3g", number);
	spec_canvas_text(canvas, x, y, anchor, text);
}

void
spec_legend_draw(const struct spec_legend *legend, struct spec_canvas *canvas)
{
	size_t top = canvas->height - spec_legend_height(legend) + GAP;
	size_t width = canvas->width - 2 * GAP, below = top + BAR + GAP;

	for (size_t x = 0; x < width; x++)
		for (size_t y = 0; y < BAR; y++)
			legend->map->colour((double)x / (double)(width - 1),
				spec_canvas_pixel(canvas, GAP + x, top + y));
	draw_number(canvas, legend->low, GAP, below, SPEC_CANVAS_BEGINNING);
	draw_number(canvas, legend->low + (legend->high - legend->low) / 2, GAP + width / 2,
		below, SPEC_CANVAS_MIDDLE);
	draw_number(canvas, legend->high, GAP + width, below, SPEC_CANVAS_END);
	if (legend->label_below)
		spec_canvas_text(
			canvas, GAP, below + LINE, SPEC_CANVAS_BEGINNING, legend->label);
	else
		spec_canvas_text(
			canvas, GAP + width / 4, below, SPEC_CANVAS_MIDDLE, legend->label);
}
