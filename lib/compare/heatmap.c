#include "compare/heatmap.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

#include "colour/colourmap.h"
#include "colour/space.h"
#include "compare/metrics.h"
#include "image/legend.h"
#include "image/picture.h"

#define GAP SPEC_LEGEND_GAP /* pixels between panels */

/* The map's colours, 0 being the same, with the numbers as they are measured. */
static struct spec_legend
legend_of(const struct spec_heatmap *heatmap, double most, char label[64])
{
	int falls = heatmap->map == SPEC_DETAIL_GFC;

	snprintf(label, 64, "%s %s", spec_metric_map_name(heatmap->map),
		spec_metric_map_unit(heatmap->map));
	return (struct spec_legend){spec_colourmap_find("viridis", NULL), falls ? 1 : 0,
		falls ? 1 - most : most, label, 0};
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
draw_map(struct spec_canvas *canvas, size_t x0, const struct spec_heatmap *heatmap,
	const struct spec_images *result, double most)
{
	const struct spec_colourmap *map = spec_colourmap_find("viridis", NULL);
	size_t width = spec_window_width(&result->region);
	const float *value = result->map[heatmap->map];

	for (size_t y = 0; y < spec_window_height(&result->region); y++)
		for (size_t x = 0; x < width; x++, value++)
			spec_colourmap_paint(map, distance(heatmap, *value), 0, most,
				spec_canvas_pixel(canvas, x0 + x, y));
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
draw_seen(struct spec_canvas *canvas, size_t x0, const struct spec_images *result, int side,
	const double matrix[9])
{
	const float *seen = result->seen[side];

	for (size_t y = 0; y < spec_window_height(&result->region); y++) {
		for (size_t x = 0; x < spec_window_width(&result->region); x++, seen += 3) {
			double colour[] = {seen[0], seen[1], seen[2]};
			unsigned char *rgb = spec_canvas_pixel(canvas, x0 + x, y);

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
save(const char *path, const struct spec_canvas *canvas, struct spec_error *error)
{
	struct spec_picture_kind kind;
	struct spec_picture_file file;
	enum spec_status status = spec_picture_choose(path, NULL, 8, &kind, error);

	if (status == SPEC_OK)
		status = spec_picture_file_open(&file, path, &kind, canvas->width,
			canvas->height, spec_space_find("srgb", NULL), error);
	if (status != SPEC_OK)
		return status;
	status = spec_picture_write(file.picture, canvas->rgb, canvas->height, error);
	if (status == SPEC_OK)
		status = spec_picture_finish(file.picture, error);
	return spec_picture_file_end(&file, status, error);
}

static size_t
at_least(size_t width)
{
	return width < SPEC_LEGEND_LEAST_WIDTH ? SPEC_LEGEND_LEAST_WIDTH : width;
}

enum spec_status
spec_heatmap_write(const char *path, const struct spec_images *result,
	const struct spec_heatmap *heatmap, struct spec_error *error)
{
	size_t width = at_least(spec_window_width(&result->region));
	double most = find_most(heatmap, result);
	char label[64];
	struct spec_legend legend = legend_of(heatmap, most, label);
	struct spec_canvas canvas;
	enum spec_status status = spec_canvas_open(&canvas, width,
		spec_window_height(&result->region) + spec_legend_height(&legend, width),
		error);

	if (status != SPEC_OK)
		return status;
	draw_map(&canvas, 0, heatmap, result, most);
	spec_legend_draw(&legend, &canvas);
	status = save(path, &canvas, error);
	spec_canvas_close(&canvas);
	return status;
}

enum spec_status
spec_heatmap_side_by_side(const char *path, const struct spec_images *result,
	const struct spec_heatmap *heatmap, struct spec_error *error)
{
	size_t width = spec_window_width(&result->region);
	size_t all = at_least(3 * width + 2 * GAP);
	double most = find_most(heatmap, result), matrix[9];
	char label[64];
	struct spec_legend legend = legend_of(heatmap, most, label);
	struct spec_canvas canvas;
	enum spec_status status = find_matrix(heatmap, matrix, error);

	if (status == SPEC_OK)
		status = spec_canvas_open(&canvas, all,
			spec_window_height(&result->region) +
				spec_legend_height(&legend, all),
			error);
	if (status != SPEC_OK)
		return status;
	draw_seen(&canvas, 0, result, 0, matrix);
	draw_seen(&canvas, width + GAP, result, 1, matrix);
	draw_map(&canvas, 2 * (width + GAP), heatmap, result, most);
	spec_legend_draw(&legend, &canvas);
	status = save(path, &canvas, error);
	spec_canvas_close(&canvas);
	return status;
}
