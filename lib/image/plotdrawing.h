/* What the files of the plugin plots.so share. */
#ifndef SPEC_IMAGE_PLOTDRAWING_H
#define SPEC_IMAGE_PLOTDRAWING_H

#include <cairo.h>

#include "image/plotting.h"

/* A panel on the page, in points, with the values at its edges; y grows upwards. */
struct spec_panel {
	double left, top, width, height;
	double x0, x1, y0, y1;
};

static inline double
spec_panel_x(const struct spec_panel *panel, double x)
{
	return panel->left + panel->width * (x - panel->x0) / (panel->x1 - panel->x0);
}

static inline double
spec_panel_y(const struct spec_panel *panel, double y)
{
	return panel->top + panel->height * (panel->y1 - y) / (panel->y1 - panel->y0);
}

/* The colour of the i-th series. */
void spec_plot_colour(cairo_t *cairo, size_t i);

/* A text at a place: across and up are 0 for its left and lower edge, 1 for the others. */
void spec_plot_text(
	cairo_t *cairo, double x, double y, double across, double up, const char *text);

/* Frame, ticks with numbers, a faint grid, and the names of the axes. */
void spec_plot_axes(
	cairo_t *cairo, const struct spec_panel *panel, const char *across, const char *up);

/* The panels. */
void spec_plot_spectra(cairo_t *cairo, const struct spec_plotting_request *request,
	struct spec_panel panel);
void spec_plot_diagram(cairo_t *cairo, const struct spec_plotting_request *request,
	struct spec_panel panel);

#endif
