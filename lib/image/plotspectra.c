/* The spectra as lines over wavelength, with their names. */
#include <math.h>

#include "image/plotdrawing.h"

#define MOST_NAMES 28
#define NAME_LINE 13.0

/* The range of finite values, with 0 in it. */
static void
find_range(const struct spec_plotting_request *request, struct spec_panel *panel)
{
	double low = 0, high = 0;

	panel->x0 = INFINITY;
	panel->x1 = -INFINITY;
	for (size_t i = 0; i < request->count; i++) {
		const struct spec_plotting_series *series = &request->series[i];

		for (size_t j = 0; j < series->count; j++) {
			double value = series->value[j];

			low = isfinite(value) && value < low ? value : low;
			high = isfinite(value) && value > high ? value : high;
		}
		panel->x0 = fmin(panel->x0, series->wavelength_nm[0]);
		panel->x1 = fmax(panel->x1, series->wavelength_nm[series->count - 1]);
	}
	if (low == high)
		high = low + 1;
	panel->y0 = low < 0 ? low - .04 * (high - low) : 0;
	panel->y1 = high > 0 ? high + .04 * (high - low) : 0;
	if (panel->x0 == panel->x1) {
		panel->x0 -= 1;
		panel->x1 += 1;
	}
}

static void
draw_line(cairo_t *cairo, const struct spec_plotting_series *series,
	const struct spec_panel *panel)
{
	int drawn = 0;

	for (size_t i = 0; i < series->count; i++) {
		double x = spec_panel_x(panel, series->wavelength_nm[i]);
		double y = spec_panel_y(panel, series->value[i]);

		if (!isfinite(y)) {
			drawn = 0;
			continue;
		}
		if (drawn)
			cairo_line_to(cairo, x, y);
		else
			cairo_move_to(cairo, x, y);
		drawn = 1;
	}
	cairo_stroke(cairo);
}

static void
draw_dots(cairo_t *cairo, const struct spec_plotting_series *series,
	const struct spec_panel *panel)
{
	for (size_t i = 0; i < series->count; i++) {
		if (!isfinite(series->value[i]))
			continue;
		cairo_arc(cairo, spec_panel_x(panel, series->wavelength_nm[i]),
			spec_panel_y(panel, series->value[i]), 2.5, 0, 2 * M_PI);
		cairo_fill(cairo);
	}
}

/* Below the panel, in columns. */
static void
draw_names(cairo_t *cairo, const struct spec_plotting_request *request,
	const struct spec_panel *panel)
{
	const size_t columns = 4;
	size_t names = request->count < MOST_NAMES ? request->count : MOST_NAMES;

	for (size_t i = 0; i < names; i++) {
		size_t column = i % columns, line = i / columns;
		double x = panel->left + panel->width * (double)column / (double)columns;
		double y = panel->top + panel->height + 50 + NAME_LINE * (double)line;
		int last = i + 1 == names && names < request->count;

		spec_plot_colour(cairo, i);
		cairo_rectangle(cairo, x, y - 2, 14, 4);
		cairo_fill(cairo);
		cairo_save(cairo);
		cairo_rectangle(cairo, x, y - NAME_LINE, panel->width / (double)columns - 4,
			2 * NAME_LINE);
		cairo_clip(cairo);
		cairo_set_source_rgb(cairo, 0, 0, 0);
		spec_plot_text(cairo, x + 18, y, 0, .5,
			last ? "and others" : request->series[i].name);
		cairo_restore(cairo);
	}
}

void
spec_plot_spectra(cairo_t *cairo, const struct spec_plotting_request *request,
	struct spec_panel panel)
{
	find_range(request, &panel);
	spec_plot_axes(cairo, &panel, "wavelength / nm", request->quantity);
	cairo_save(cairo);
	cairo_rectangle(cairo, panel.left, panel.top, panel.width, panel.height);
	cairo_clip(cairo);
	cairo_set_line_width(cairo, 1.6);
	cairo_set_line_join(cairo, CAIRO_LINE_JOIN_ROUND);
	for (size_t i = 0; i < request->count; i++) {
		spec_plot_colour(cairo, i);
		if (request->series[i].count == 1)
			draw_dots(cairo, &request->series[i], &panel);
		else
			draw_line(cairo, &request->series[i], &panel);
	}
	cairo_restore(cairo);
	draw_names(cairo, request, &panel);
}
