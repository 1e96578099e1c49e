/* The chromaticity diagram: loci, a space's triangle, and the points. */
#include <math.h>
#include <stdint.h>
#include <stdio.h>

#include "image/plotdrawing.h"

#define TINT_SIDE 256 /* pixels of the tinted picture */
#define PALENESS .55  /* how much of it is white */

static double
encode(double linear)
{
	return linear <= .0031308 ? 12.92 * linear : 1.055 * pow(linear, 1 / 2.4) - .055;
}

/* The colour of a chromaticity, as bright as the screen can show it, made paler. */
static uint32_t
tint(const struct spec_plotting_request *request, double x, double y)
{
	double xyz[3] = {x, y, 1 - x - y}, rgb[3], most = 1e-9;
	uint32_t pixel = 0;

	for (int r = 0; r < 3; r++) {
		rgb[r] = 0;
		for (int c = 0; c < 3; c++)
			rgb[r] += request->from_xyz[3 * r + c] * xyz[c];
		rgb[r] = rgb[r] > 0 ? rgb[r] : 0;
		most = rgb[r] > most ? rgb[r] : most;
	}
	for (int r = 0; r < 3; r++) {
		double shown = PALENESS + (1 - PALENESS) * encode(rgb[r] / most);

		pixel = pixel << 8 | (uint32_t)lround(255 * shown);
	}
	return pixel;
}

static void
trace_locus(cairo_t *cairo, const struct spec_plotting_request *request,
	const struct spec_panel *panel)
{
	for (size_t i = 0; i < request->locus_count; i++)
		cairo_line_to(cairo, spec_panel_x(panel, request->locus_xy[i][0]),
			spec_panel_y(panel, request->locus_xy[i][1]));
	cairo_close_path(cairo);
}

static void
fill_tints(cairo_t *cairo, const struct spec_plotting_request *request,
	const struct spec_panel *panel)
{
	cairo_surface_t *picture =
		cairo_image_surface_create(CAIRO_FORMAT_RGB24, TINT_SIDE, TINT_SIDE);
	unsigned char *bytes = cairo_image_surface_get_data(picture);
	int stride = cairo_image_surface_get_stride(picture);

	if (!bytes) {
		cairo_surface_destroy(picture);
		return;
	}
	for (int j = 0; j < TINT_SIDE; j++) {
		uint32_t *row = (uint32_t *)(void *)(bytes + (ptrdiff_t)j * stride);

		for (int i = 0; i < TINT_SIDE; i++)
			row[i] = tint(request,
				panel->x0 + (i + .5) / TINT_SIDE * (panel->x1 - panel->x0),
				panel->y1 - (j + .5) / TINT_SIDE * (panel->y1 - panel->y0));
	}
	cairo_surface_mark_dirty(picture);
	cairo_save(cairo);
	trace_locus(cairo, request, panel);
	cairo_clip(cairo);
	cairo_translate(cairo, panel->left, panel->top);
	cairo_scale(cairo, panel->width / TINT_SIDE, panel->height / TINT_SIDE);
	cairo_set_source_surface(cairo, picture, 0, 0);
	cairo_paint(cairo);
	cairo_restore(cairo);
	cairo_surface_destroy(picture);
}

/* Wavelengths that are far enough apart on the locus to be written. */
static int
is_labelled(double nm)
{
	if (fabs(nm - 10 * round(nm / 10)) > 1e-6)
		return 0;
	return (nm >= 460 && nm <= 600) || nm == 380 || nm == 620 || nm == 700;
}

/* A short stroke and the number, outwards: to the right of the way along the locus. */
static void
draw_wavelengths(cairo_t *cairo, const struct spec_plotting_request *request,
	const struct spec_panel *panel)
{
	for (size_t i = 0; i < request->locus_count; i++) {
		size_t before = i > 0 ? i - 1 : 0;
		size_t after = i + 1 < request->locus_count ? i + 1 : i;
		double x = spec_panel_x(panel, request->locus_xy[i][0]);
		double y = spec_panel_y(panel, request->locus_xy[i][1]);
		double dx = spec_panel_x(panel, request->locus_xy[after][0]) -
			    spec_panel_x(panel, request->locus_xy[before][0]);
		double dy = spec_panel_y(panel, request->locus_xy[after][1]) -
			    spec_panel_y(panel, request->locus_xy[before][1]);
		double length = hypot(dx, dy), outx, outy;
		char text[32];

		if (!is_labelled(request->locus_nm[i]) || !(length > 0))
			continue;
		/* Near its red end the locus hardly moves: away from the left there. */
		outx = request->locus_nm[i] < 650 ? dy / length : M_SQRT1_2;
		outy = request->locus_nm[i] < 650 ? -dx / length : -M_SQRT1_2;
		cairo_move_to(cairo, x, y);
		cairo_line_to(cairo, x + 4 * outx, y + 4 * outy);
		cairo_stroke(cairo);
		snprintf(text, sizeof text, "%.0f", request->locus_nm[i]);
		spec_plot_text(cairo, x + 7 * outx, y + 7 * outy, .5 - .5 * outx,
			.5 + .5 * outy, text);
	}
}

static void
draw_bodies(cairo_t *cairo, const struct spec_plotting_request *request,
	const struct spec_panel *panel)
{
	cairo_set_source_rgb(cairo, .2, .2, .2);
	for (size_t i = 0; i < request->bodies; i++)
		cairo_line_to(cairo, spec_panel_x(panel, request->body[i].xy[0]),
			spec_panel_y(panel, request->body[i].xy[1]));
	cairo_stroke(cairo);
	for (size_t i = 0; i < request->bodies; i++) {
		double x = spec_panel_x(panel, request->body[i].xy[0]);
		double y = spec_panel_y(panel, request->body[i].xy[1]);
		char text[32];

		if (!request->body[i].labelled)
			continue;
		cairo_arc(cairo, x, y, 1.5, 0, 2 * M_PI);
		cairo_fill(cairo);
		snprintf(text, sizeof text, "%.0f K", request->body[i].temperature_k);
		spec_plot_text(cairo, x, y + 4, 0, 1, text);
	}
}

static void
draw_triangle(cairo_t *cairo, const struct spec_plotting_request *request,
	const struct spec_panel *panel)
{
	double x = spec_panel_x(panel, request->white_xy[0]);
	double y = spec_panel_y(panel, request->white_xy[1]);

	if (!request->triangle)
		return;
	cairo_set_source_rgb(cairo, 0, 0, 0);
	for (int i = 0; i < 3; i++)
		cairo_line_to(cairo, spec_panel_x(panel, request->primary_xy[i][0]),
			spec_panel_y(panel, request->primary_xy[i][1]));
	cairo_close_path(cairo);
	cairo_stroke(cairo);
	cairo_move_to(cairo, x - 4, y);
	cairo_line_to(cairo, x + 4, y);
	cairo_move_to(cairo, x, y - 4);
	cairo_line_to(cairo, x, y + 4);
	cairo_stroke(cairo);
	spec_plot_text(cairo, spec_panel_x(panel, request->primary_xy[1][0]),
		spec_panel_y(panel, request->primary_xy[1][1]) - 4, 0, 0, request->space);
}

static void
draw_points(cairo_t *cairo, const struct spec_plotting_request *request,
	const struct spec_panel *panel)
{
	for (size_t i = 0; i < request->count; i++) {
		const double *xy = request->series[i].xy;

		if (!isfinite(xy[0]) || !isfinite(xy[1]))
			continue;
		cairo_arc(cairo, spec_panel_x(panel, xy[0]), spec_panel_y(panel, xy[1]), 4,
			0, 2 * M_PI);
		spec_plot_colour(cairo, i);
		cairo_fill_preserve(cairo);
		cairo_set_source_rgb(cairo, 1, 1, 1);
		cairo_stroke(cairo);
	}
}

void
spec_plot_diagram(cairo_t *cairo, const struct spec_plotting_request *request,
	struct spec_panel panel)
{
	panel.x0 = -.05;
	panel.x1 = .8;
	panel.y0 = -.05;
	panel.y1 = .9;
	spec_plot_axes(cairo, &panel, "x", "y");
	cairo_save(cairo);
	cairo_rectangle(cairo, panel.left, panel.top, panel.width, panel.height);
	cairo_clip(cairo);
	fill_tints(cairo, request, &panel);
	cairo_set_line_width(cairo, 1);
	cairo_set_source_rgb(cairo, 0, 0, 0);
	trace_locus(cairo, request, &panel);
	cairo_stroke(cairo);
	draw_wavelengths(cairo, request, &panel);
	draw_triangle(cairo, request, &panel);
	draw_bodies(cairo, request, &panel);
	draw_points(cairo, request, &panel);
	cairo_restore(cairo);
	cairo_set_source_rgb(cairo, 0, 0, 0);
	spec_plot_text(
		cairo, panel.left + panel.width, panel.top - 6, 1, 0, request->observer);
}
