/* The spectra as lines over wavelength, with their names. */
#include <math.h>

#include "image/plotdrawing.h"

#include <stdio.h>
#include <string.h>

#define MOST_COLUMNS 4
#define MOST_LINES 7
#define MOST_NAMES (MOST_COLUMNS * MOST_LINES)
#define NAME_LINE 13.0
#define NAME_LEFT 18.0 /* of it are 14 for the line's colour */
#define NAME_GAP 10.0
#define MOST_BYTES 255 /* of a name; what is longer fits no page */

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

static double
width_of(cairo_t *cairo, const char *text)
{
	cairo_text_extents_t size;

	cairo_text_extents(cairo, text, &size);
	return size.x_advance;
}

/*
 * The name, or as much of its end as fits, behind an ellipsis: names are often paths, which
 * differ at their ends. fitting: MOST_BYTES + 4 bytes.
 */
static void
fit_name(cairo_t *cairo, const char *name, double width, char *fitting)
{
	size_t length = strlen(name);

	if (length <= MOST_BYTES && width_of(cairo, name) <= width) {
		memcpy(fitting, name, length + 1);
		return;
	}
	if (length > MOST_BYTES)
		name += length - MOST_BYTES;
	do {
		name += *name != '\0';
		while ((*name & 0xc0) == 0x80)
			name++;
		snprintf(fitting, MOST_BYTES + 4, "\xe2\x80\xa6%s", name);
	} while (*name && width_of(cairo, fitting) > width);
}

/* As many columns as the widest name leaves, and as the names need to fit below the panel. */
static size_t
count_columns(cairo_t *cairo, const struct spec_plotting_request *request, size_t names,
	double width)
{
	size_t columns = MOST_COLUMNS;
	double widest = 0;

	for (size_t i = 0; i < names; i++)
		widest = fmax(widest, width_of(cairo, request->series[i].name));
	while (columns > 1 && (columns - 1) * MOST_LINES >= names &&
		NAME_LEFT + widest + NAME_GAP > width / (double)columns)
		columns--;
	return columns;
}

/* Below the panel, in columns. */
static void
draw_names(cairo_t *cairo, const struct spec_plotting_request *request,
	const struct spec_panel *panel)
{
	size_t names = request->count < MOST_NAMES ? request->count : MOST_NAMES;
	size_t columns = count_columns(cairo, request, names, panel->width);
	double width = panel->width / (double)columns;
	char fitting[MOST_BYTES + 4];

	for (size_t i = 0; i < names; i++) {
		size_t line = i / columns;
		double x = panel->left + width * (double)(i % columns);
		double y = panel->top + panel->height + 50 + NAME_LINE * (double)line;
		int last = i + 1 == names && names < request->count;

		spec_plot_colour(cairo, i);
		cairo_rectangle(cairo, x, y - 2, 14, 4);
		cairo_fill(cairo);
		cairo_set_source_rgb(cairo, 0, 0, 0);
		fit_name(cairo, last ? "and others" : request->series[i].name,
			width - NAME_LEFT - NAME_GAP, fitting);
		spec_plot_text(cairo, x + NAME_LEFT, y, 0, .5, fitting);
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
