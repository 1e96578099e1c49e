/* A small picture in memory, and letters on it. */
#ifndef SPEC_IMAGE_CANVAS_H
#define SPEC_IMAGE_CANVAS_H

#include <stddef.h>

#include "base/error.h"

#define SPEC_CANVAS_TEXT_HEIGHT 10 /* pixels, times the scale */

/* Red, green and blue of each pixel, encoded as sRGB, by rows. */
struct spec_canvas {
	size_t width, height;
	size_t scale; /* of letters, 1 or more */
	unsigned char *rgb;
};

/* All white, with a scale of 1. Error: SPEC_ENOMEM. */
enum spec_status spec_canvas_open(
	struct spec_canvas *canvas, size_t width, size_t height, struct spec_error *error);
void spec_canvas_close(struct spec_canvas *canvas);

unsigned char *spec_canvas_pixel(const struct spec_canvas *canvas, size_t x, size_t y);

enum spec_canvas_anchor { /* what of a text stands at its x */
	SPEC_CANVAS_BEGINNING,
	SPEC_CANVAS_MIDDLE,
	SPEC_CANVAS_END
};

/*
 * Draws a line of text in black with its upper side at y0: capitals, digits and the signs of
 * ASCII; small letters become capitals, and of other characters there is only the space. What
 * lies beyond the right side is cut.
 */
void spec_canvas_text(struct spec_canvas *canvas, size_t x0, size_t y0,
	enum spec_canvas_anchor anchor, const char *text);

#endif
