#include "image/canvas.h"

#include <ctype.h>
#include <stdlib.h>
#include <string.h>

#include "base/memory.h"

#define DOT 2 /* pixels, a side of what characters are made of, by the scale of 1 */
#define GLYPH_WIDTH 3
#define GLYPH_HEIGHT (SPEC_CANVAS_TEXT_HEIGHT / DOT)
#define ADVANCE ((GLYPH_WIDTH + 1) * DOT)

/* Rows of three dots from above, the left one 4. */
static const struct {
	char character;
	unsigned char row[GLYPH_HEIGHT];
} glyphs[] = {
	{'0', {7, 5, 5, 5, 7}},
	{'1', {2, 6, 2, 2, 7}},
	{'2', {7, 1, 7, 4, 7}},
	{'3', {7, 1, 7, 1, 7}},
	{'4', {5, 5, 7, 1, 1}},
	{'5', {7, 4, 7, 1, 7}},
	{'6', {7, 4, 7, 5, 7}},
	{'7', {7, 1, 1, 1, 1}},
	{'8', {7, 5, 7, 5, 7}},
	{'9', {7, 5, 7, 1, 7}},
	{'.', {0, 0, 0, 0, 2}},
	{'-', {0, 0, 7, 0, 0}},
	{'+', {0, 2, 7, 2, 0}},
	{'A', {7, 5, 7, 5, 5}},
	{'B', {6, 5, 6, 5, 6}},
	{'C', {7, 4, 4, 4, 7}},
	{'D', {6, 5, 5, 5, 6}},
	{'E', {7, 4, 7, 4, 7}},
	{'F', {7, 4, 6, 4, 4}},
	{'G', {7, 4, 5, 5, 7}},
	{'H', {5, 5, 7, 5, 5}},
	{'I', {7, 2, 2, 2, 7}},
	{'J', {1, 1, 1, 5, 7}},
	{'K', {5, 5, 6, 5, 5}},
	{'L', {4, 4, 4, 4, 7}},
	{'M', {5, 7, 7, 5, 5}},
	{'N', {7, 5, 5, 5, 5}},
	{'O', {2, 5, 5, 5, 2}},
	{'P', {7, 5, 7, 4, 4}},
	{'Q', {7, 5, 5, 7, 1}},
	{'R', {6, 5, 6, 5, 5}},
	{'S', {7, 4, 7, 1, 7}},
	{'T', {7, 2, 2, 2, 2}},
	{'U', {5, 5, 5, 5, 7}},
	{'V', {5, 5, 5, 5, 2}},
	{'W', {5, 5, 7, 7, 5}},
	{'X', {5, 5, 2, 5, 5}},
	{'Y', {5, 5, 2, 2, 2}},
	{'Z', {7, 1, 2, 4, 7}},
	{'/', {1, 1, 2, 4, 4}},
	{'*', {0, 5, 2, 5, 0}},
	{'(', {1, 2, 2, 2, 1}},
	{')', {4, 2, 2, 2, 4}},
	{'[', {3, 2, 2, 2, 3}},
	{']', {6, 2, 2, 2, 6}},
	{'<', {1, 2, 4, 2, 1}},
	{'>', {4, 2, 1, 2, 4}},
	{'=', {0, 7, 0, 7, 0}},
	{'!', {2, 2, 2, 0, 2}},
	{'?', {6, 1, 2, 0, 2}},
	{':', {0, 2, 0, 2, 0}},
	{';', {0, 2, 0, 2, 4}},
	{',', {0, 0, 0, 2, 4}},
	{'^', {2, 5, 0, 0, 0}},
	{'"', {5, 5, 0, 0, 0}},
	{'&', {2, 5, 2, 5, 3}},
	{'|', {2, 2, 2, 2, 2}},
	{'%', {5, 1, 2, 4, 5}},
	{'_', {0, 0, 0, 0, 7}},
};

enum spec_status
spec_canvas_open(
	struct spec_canvas *canvas, size_t width, size_t height, struct spec_error *error)
{
	canvas->width = width;
	canvas->height = height;
	canvas->scale = 1;
	canvas->rgb = spec_memory_new(width * height, 3, "pixels", error);
	if (!canvas->rgb)
		return SPEC_ENOMEM;
	memset(canvas->rgb, 255, width * height * 3);
	return SPEC_OK;
}

void
spec_canvas_close(struct spec_canvas *canvas)
{
	free(canvas->rgb);
	canvas->rgb = NULL;
}

unsigned char *
spec_canvas_pixel(const struct spec_canvas *canvas, size_t x, size_t y)
{
	return canvas->rgb + 3 * (y * canvas->width + x);
}

static void
draw_glyph(struct spec_canvas *canvas, size_t x0, size_t y0, char character)
{
	size_t i = 0, dot = DOT * canvas->scale;

	while (i < sizeof glyphs / sizeof *glyphs && glyphs[i].character != character)
		i++;
	if (i == sizeof glyphs / sizeof *glyphs)
		return;
	for (size_t y = 0; y < GLYPH_HEIGHT * dot; y++) {
		for (size_t x = 0; x < GLYPH_WIDTH * dot; x++) {
			if (glyphs[i].row[y / dot] & 4 >> x / dot && x0 + x < canvas->width)
				memset(spec_canvas_pixel(canvas, x0 + x, y0 + y), 0, 3);
		}
	}
}

/* Pixels that a text takes by the scale of 1. */
static size_t
text_width(const char *text)
{
	size_t length = strlen(text);

	return length > 0 ? length * ADVANCE - DOT : 0;
}

void
spec_canvas_text(struct spec_canvas *canvas, size_t x0, size_t y0,
	enum spec_canvas_anchor anchor, const char *text)
{
	size_t shift = (size_t)anchor * text_width(text) * canvas->scale / 2;

	x0 = x0 > shift ? x0 - shift : 0;
	for (; *text; text++, x0 += ADVANCE * canvas->scale)
		draw_glyph(canvas, x0, y0, (char)toupper((unsigned char)*text));
}
