#include "image/legend.h"

#include <stdio.h>

#define GAP SPEC_LEGEND_GAP
#define BAR 12 /* pixels, the height of the colours */
#define LINE (GAP + SPEC_CANVAS_TEXT_HEIGHT)

/* The numbers below the colours. */
struct numbers {
	char low[32], middle[32], high[32];
};

static struct numbers
numbers_of(const struct spec_legend *legend)
{
	struct numbers numbers;

	snprintf(numbers.low, sizeof numbers.low, "%.3g", legend->low);
	snprintf(numbers.middle, sizeof numbers.middle, "%.3g",
		legend->low + (legend->high - legend->low) / 2);
	snprintf(numbers.high, sizeof numbers.high, "%.3g", legend->high);
	return numbers;
}

/* Whether the label has room around a quarter of the width, between two numbers. */
static int
label_fits(const struct spec_legend *legend, size_t width)
{
	struct numbers numbers = numbers_of(legend);
	size_t half = spec_canvas_text_width(legend->label) / 2 + GAP;
	size_t inside = width - 2 * GAP, quarter = inside / 4;

	return quarter >= half + spec_canvas_text_width(numbers.low) &&
	       quarter >= half + spec_canvas_text_width(numbers.middle) / 2;
}

size_t
spec_legend_height(const struct spec_legend *legend, size_t width)
{
	return 2 * GAP + BAR + LINE + (label_fits(legend, width) ? 0 : LINE);
}

void
spec_legend_draw(const struct spec_legend *legend, struct spec_canvas *canvas)
{
	struct numbers numbers = numbers_of(legend);
	size_t top = canvas->height - spec_legend_height(legend, canvas->width) + GAP;
	size_t width = canvas->width - 2 * GAP, below = top + BAR + GAP;

	for (size_t x = 0; x < width; x++)
		for (size_t y = 0; y < BAR; y++)
			legend->map->colour((double)x / (double)(width - 1),
				spec_canvas_pixel(canvas, GAP + x, top + y));
	spec_canvas_text(canvas, GAP, below, SPEC_CANVAS_BEGINNING, numbers.low);
	spec_canvas_text(
		canvas, GAP + width / 2, below, SPEC_CANVAS_MIDDLE, numbers.middle);
	spec_canvas_text(canvas, GAP + width, below, SPEC_CANVAS_END, numbers.high);
	if (label_fits(legend, canvas->width))
		spec_canvas_text(
			canvas, GAP + width / 4, below, SPEC_CANVAS_MIDDLE, legend->label);
	else
		spec_canvas_text(
			canvas, GAP, below + LINE, SPEC_CANVAS_BEGINNING, legend->label);
}
