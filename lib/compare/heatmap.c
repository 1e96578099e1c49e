#include "compare/heatmap.h"

#include <ctype.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "base/memory.h"
#include "base/output.h"
#include "colour/colourmap.h"
#include "colour/space.h"
#include "compare/metrics.h"
#include "image/picture.h"

#define GAP 4  /* pixels between panels and around the legend */
#define BAR 12 /* pixels, the height of the legend's colours */
#define DOT 2  /* pixels, a side of what the numbers are made of */
#define GLYPH_WIDTH 3
#define GLYPH_HEIGHT 5
#define ADVANCE ((GLYPH_WIDTH + 1) * DOT)
#define LEGEND (3 * GAP + BAR + GLYPH_HEIGHT * DOT)
#define LEAST_WIDTH 256 /* the legend's numbers do not touch */

/* A picture in memory, red, green and blue of each pixel. */
struct canvas {
	size_t width, height;
	unsigned char *rgb;
};

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
	{'C', {7, 4, 4, 4, 7}},
	{'D', {6, 5, 5, 5, 6}},
	{'E', {7, 4, 7, 4, 7}},
	{'F', {7, 4, 6, 4, 4}},
	{'G', {7, 4, 5, 5, 7}},
	{'I', {7, 2, 2, 2, 7}},
	{'M', {5, 7, 7, 5, 5}},
	{'R', {6, 5, 6, 5, 5}},
	{'S', {7, 4, 7, 1, 7}},
	{'X', {5, 5, 2, 5, 5}},
};

static enum spec_status
open_canvas(struct canvas *canvas, size_t width, size_t height, struct spec_error *error)
{
	canvas->width = width;
	canvas->height = height;
	canvas->rgb = spec_memory_new(width * height, 3, "pixels", error);
	if (!canvas->rgb)
		return SPEC_ENOMEM;
	memset(canvas->rgb, 255, width * height * 3);
	return SPEC_OK;
}

static unsigned char *
pixel_at(const struct canvas *canvas, size_t x, size_t y)
{
	return canvas->rgb + 3 * (y * canvas->width + x);
}

static void
draw_glyph(struct canvas *canvas, size_t x0, size_t y0, char character)
{
	size_t i = 0;

	while (i < sizeof glyphs / sizeof *glyphs && glyphs[i].character != character)
		i++;
	if (i == sizeof glyphs / sizeof *glyphs)
		return;
	for (size_t y = 0; y < GLYPH_HEIGHT * DOT; y++) {
		for (size_t x = 0; x < GLYPH_WIDTH * DOT; x++) {
			if (glyphs[i].row[y / DOT] & 4 >> x / DOT && x0 + x < canvas->width)
				memset(pixel_at(canvas, x0 + x, y0 + y), 0, 3);
		}
	}
}

/* x0: where it begins; of anchor 1 its middle, of 2 its end. */
static void
draw_text(struct canvas *canvas, size_t x0, size_t y0, int anchor, const char *text)
{
	size_t shift = (size_t)anchor * (strlen(text) * ADVANCE - DOT) / 2;

	x0 = x0 > shift ? x0 - shift : 0;
	for (; *text; text++, x0 += ADVANCE)
		draw_glyph(canvas, x0, y0, (char)toupper((unsigned char)*text));
}

static void
draw_legend(struct canvas *canvas, const struct spec_heatmap *heatmap, double most)
{
	size_t top = canvas->height - LEGEND + GAP, width = canvas->width - 2 * GAP;
	size_t below = top + BAR + GAP, end = canvas->width - GAP;
	int falls = heatmap->map == SPEC_DETAIL_GFC;
	char text[64];

	for (size_t x = 0; x < width; x++)
		for (size_t y = 0; y < BAR; y++)
			spec_colourmap_viridis((double)x / (double)(width - 1),
				pixel_at(canvas, GAP + x, top + y));
	draw_text(canvas, GAP, below, 0, falls ? "1" : "0");
	snprintf(text, sizeof text, "%.3g", falls ? 1 - most / 2 : most / 2);
	draw_text(canvas, GAP + width / 2, below, 1, text);
	snprintf(text, sizeof text, "%.3g", falls ? 1 - most : most);
	draw_text(canvas, end, below, 2, text);
	snprintf(text, sizeof text, "%s %s", spec_metric_map_name(heatmap->map),
		spec_metric_map_unit(heatmap->map));
	draw_text(canvas, GAP + width / 4, below, 1, text);
}

/* What the scale shows: 0 is the same. */
static double
distance(const struct spec_heatmap *heatmap, float value)
{
	return heatmap->map == SPEC_DETAIL_GFC ? 1 - (double)value : value;
}

static double
find_most(const struct spec_heatmap *heatmap, const struct spec_images *result)
{
	size_t pixels =
		spec_window_width(&result->region) * spec_window_height(&result->region);
	double most = 0;

	if (heatmap->most > 0)
		return heatmap->most;
	for (size_t i = 0; i < pixels; i++) {
		double value = distance(heatmap, result->map[heatmap->map][i]);

		if (isfinite(value) && value > most)
			most = value;
	}
	return most > 0 ? most : 1;
}

static void
draw_map(struct canvas *canvas, size_t x0, const struct spec_heatmap *heatmap,
	const struct spec_images *result, double most)
{
	static const unsigned char infinite[] = {255, 0, 255};
	size_t width = spec_window_width(&result->region);
	const float *value = result->map[heatmap->map];

	for (size_t y = 0; y < spec_window_height(&result->region); y++) {
		for (size_t x = 0; x < width; x++, value++) {
			double here = distance(heatmap, *value);
			unsigned char *rgb = pixel_at(canvas, x0 + x, y);

			if (isnan(here))
				memset(rgb, 128, 3);
			else if (isinf(here))
				memcpy(rgb, infinite, 3);
			else
				spec_colourmap_viridis(here / most, rgb);
		}
	}
}

/* From the XYZ of what was seen to linear sRGB. */
static enum spec_status
find_matrix(const struct spec_heatmap *heatmap, double matrix[9], struct spec_error *error)
{
	const struct spec_space *space = spec_space_find("srgb", error);
	double white[3], adapt[9];
	enum spec_status status;

	if (!space)
		return SPEC_EUSAGE;
	spec_white_xyz(space->white_xy, white);
	status = spec_adaptation_matrix(
		SPEC_ADAPTATION_BRADFORD, heatmap->white_xyz, white, adapt, error);
	if (status == SPEC_OK)
		status = spec_space_from_xyz(space, matrix, error);
	if (status == SPEC_OK)
		spec_matrix_multiply(matrix, adapt, matrix);
	return status;
}

static void
draw_seen(struct canvas *canvas, size_t x0, const struct spec_images *result, int side,
	const double matrix[9])
{
	const float *seen = result->seen[side];

	for (size_t y = 0; y < spec_window_height(&result->region); y++) {
		for (size_t x = 0; x < spec_window_width(&result->region); x++, seen += 3) {
			double colour[] = {seen[0], seen[1], seen[2]};
			unsigned char *rgb = pixel_at(canvas, x0 + x, y);

			spec_matrix_apply(matrix, colour, colour);
			for (int c = 0; c < 3; c++) {
				double share = fmin(fmax(colour[c], 0), 1);

				rgb[c] = (unsigned char)lround(
					255 * spec_srgb_encode(share));
			}
			if (isnan(seen[0]))
				memset(rgb, 128, 3);
		}
	}
}

static enum spec_status
save(const char *path, const struct canvas *canvas, struct spec_error *error)
{
	struct spec_picture_kind kind;
	struct spec_picture *picture = NULL;
	struct spec_output output;
	enum spec_status status = spec_picture_choose(path, 8, &kind, error);

	if (status == SPEC_OK)
		status = spec_output_open(&output, path, error);
	if (status != SPEC_OK)
		return status;
	status = spec_picture_open(&picture, &kind, &output, canvas->width, canvas->height,
		spec_space_find("srgb", NULL), error);
	if (status == SPEC_OK)
		status = spec_picture_write(picture, canvas->rgb, canvas->height, error);
	if (status == SPEC_OK)
		status = spec_picture_finish(picture, error);
	spec_picture_close(picture);
	if (status == SPEC_OK)
		return spec_output_commit(&output, error);
	spec_output_abandon(&output);
	return status;
}

static size_t
at_least(size_t width)
{
	return width < LEAST_WIDTH ? LEAST_WIDTH : width;
}

enum spec_status
spec_heatmap_write(const char *path, const struct spec_images *result,
	const struct spec_heatmap *heatmap, struct spec_error *error)
{
	size_t width = spec_window_width(&result->region);
	double most = find_most(heatmap, result);
	struct canvas canvas;
	enum spec_status status = open_canvas(&canvas, at_least(width),
		spec_window_height(&result->region) + LEGEND, error);

	if (status != SPEC_OK)
		return status;
	draw_map(&canvas, 0, heatmap, result, most);
	draw_legend(&canvas, heatmap, most);
	status = save(path, &canvas, error);
	free(canvas.rgb);
	return status;
}

enum spec_status
spec_heatmap_side_by_side(const char *path, const struct spec_images *result,
	const struct spec_heatmap *heatmap, struct spec_error *error)
{
	size_t width = spec_window_width(&result->region);
	double most = find_most(heatmap, result), matrix[9];
	struct canvas canvas;
	enum spec_status status = find_matrix(heatmap, matrix, error);

	if (status == SPEC_OK)
		status = open_canvas(&canvas, at_least(3 * width + 2 * GAP),
			spec_window_height(&result->region) + LEGEND, error);
	if (status != SPEC_OK)
		return status;
	draw_seen(&canvas, 0, result, 0, matrix);
	draw_seen(&canvas, width + GAP, result, 1, matrix);
	draw_map(&canvas, 2 * (width + GAP), heatmap, result, most);
	draw_legend(&canvas, heatmap, most);
	status = save(path, &canvas, error);
	free(canvas.rgb);
	return status;
}
