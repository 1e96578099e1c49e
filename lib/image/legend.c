#include "image/legend.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>

#define GAP SPEC_LEGEND_GAP
#define BAR 12 /* pixels, the height of the colours */
#define LEAST_DIGITS 3
#define MOST_DIGITS 10
#define LINE (GAP + SPEC_CANVAS_TEXT_HEIGHT)

static size_t
scale_of(size_t width)
{
	return width < SPEC_LEGEND_WIDTH ? 1 : width / SPEC_LEGEND_WIDTH;
}

size_t
spec_legend_height(const struct spec_legend *legend, size_t width)
{
	return (2 * GAP + BAR + LINE + (legend->label_below ? LINE : 0)) * scale_of(width);
}

/*
 * A number of the scale from low to high, by as few digits as keep it within a hundredth of
 * the scale: 0.9995 between 0.999 and 1 must not become 1.
 */
static void
draw_number(struct spec_canvas *canvas, const struct spec_legend *legend, double number,
	size_t x, size_t y, enum spec_canvas_anchor anchor)
{
	double off = fabs(legend->high - legend->low) / 100;
	int digits = LEAST_DIGITS - 1;
	char text[32];

	do {
		digits++;
		snprintf(text, sizeof text, "%.*g", digits, number);
	} while (digits < MOST_DIGITS && fabs(strtod(text, NULL) - number) > off);
	spec_canvas_text(canvas, x, y, anchor, text);
}

void
spec_legend_draw(const struct spec_legend *legend, struct spec_canvas *canvas)
{
	size_t scale = scale_of(canvas->width), gap = GAP * scale, bar = BAR * scale;
	size_t top = canvas->height - spec_legend_height(legend, canvas->width) + gap;
	size_t width = canvas->width - 2 * gap, below = top + bar + gap;

	canvas->scale = scale;
	for (size_t x = 0; x < width; x++)
		for (size_t y = 0; y < bar; y++)
			legend->map->colour((double)x / (double)(width - 1),
				spec_canvas_pixel(canvas, gap + x, top + y));
	draw_number(canvas, legend, legend->low, gap, below, SPEC_CANVAS_BEGINNING);
	draw_number(canvas, legend, legend->low + (legend->high - legend->low) / 2,
		gap + width / 2, below, SPEC_CANVAS_MIDDLE);
	draw_number(canvas, legend, legend->high, gap + width, below, SPEC_CANVAS_END);
	if (legend->label_below)
		spec_canvas_text(canvas, gap, below + LINE * scale, SPEC_CANVAS_BEGINNING,
			legend->label);
	else
		spec_canvas_text(
			canvas, gap + width / 4, below, SPEC_CANVAS_MIDDLE, legend->label);
}
