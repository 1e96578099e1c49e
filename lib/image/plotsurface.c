/* The plugin's beginning: the page, its axes and texts, and the three formats. */
#include <math.h>
#include <stdio.h>

#include <cairo-pdf.h>
#include <cairo-svg.h>
#include <fontconfig/fontconfig.h>

#include "image/plotdrawing.h"

#define PAGE_WIDTH 1100.0 /* points, or pixels */
#define PAGE_HEIGHT 620.0
#define FONT_SIZE 11.0

/* Okabe and Ito's colours, which people with any colour vision tell apart, and darker ones. */
void
spec_plot_colour(cairo_t *cairo, size_t i)
{
	static const double colour[][3] = {{0, .45, .70}, {.84, .37, 0}, {0, .62, .45},
		{.80, .47, .65}, {.90, .62, 0}, {.34, .71, .91}, {.35, .35, .35}};
	const size_t count = sizeof colour / sizeof *colour;
	const double *c = colour[i % count];
	double dark = 1 / (1 + .35 * (double)(i / count % 4));

	cairo_set_source_rgb(cairo, c[0] * dark, c[1] * dark, c[2] * dark);
}

void
spec_plot_text(
	cairo_t *cairo, double x, double y, double across, double up, const char *text)
{
	cairo_text_extents_t size;

	cairo_text_extents(cairo, text, &size);
	cairo_move_to(cairo, x - across * size.x_advance, y + up * FONT_SIZE * .72);
	cairo_show_text(cairo, text);
	cairo_new_path(cairo);
}

/* 1, 2 or 5 times a power of ten, of which about so many fit. */
static double
step_of(double range, double ticks)
{
	double power = pow(10, floor(log10(range / ticks))), part = range / ticks / power;

	return power * (part < 1.5 ? 1 : part < 3.5 ? 2 : part < 7.5 ? 5 : 10);
}

static void
draw_tick(cairo_t *cairo, const struct spec_panel *panel, double value, double step,
	int upright)
{
	char text[32];
	double x = spec_panel_x(panel, value), y = spec_panel_y(panel, value);

	snprintf(text, sizeof text, "%.6g", fabs(value) < step * 1e-6 ? 0 : value);
	cairo_set_source_rgb(cairo, .88, .88, .88);
	if (upright) {
		cairo_move_to(cairo, panel->left, y);
		cairo_line_to(cairo, panel->left + panel->width, y);
	} else {
		cairo_move_to(cairo, x, panel->top);
		cairo_line_to(cairo, x, panel->top + panel->height);
	}
	cairo_stroke(cairo);
	cairo_set_source_rgb(cairo, 0, 0, 0);
	if (upright)
		spec_plot_text(cairo, panel->left - 6, y, 1, .5, text);
	else
		spec_plot_text(cairo, x, panel->top + panel->height + 6, .5, 1, text);
}

void
spec_plot_axes(
	cairo_t *cairo, const struct spec_panel *panel, const char *across, const char *up)
{
	double step = step_of(panel->x1 - panel->x0, 8);

	cairo_set_line_width(cairo, 1);
	for (double i = ceil(panel->x0 / step - 1e-9); i * step <= panel->x1; i++)
		draw_tick(cairo, panel, i * step, step, 0);
	step = step_of(panel->y1 - panel->y0, 8);
	for (double i = ceil(panel->y0 / step - 1e-9); i * step <= panel->y1; i++)
		draw_tick(cairo, panel, i * step, step, 1);
	cairo_set_source_rgb(cairo, 0, 0, 0);
	cairo_rectangle(cairo, panel->left, panel->top, panel->width, panel->height);
	cairo_stroke(cairo);
	spec_plot_text(cairo, panel->left + panel->width / 2,
		panel->top + panel->height + 24, .5, 1, across);
	spec_plot_text(cairo, panel->left, panel->top - 6, 0, 0, up);
}

struct target {
	int (*write)(void *state, const unsigned char *bytes, size_t count);
	void *state;
};

static cairo_status_t
pass_on(void *closure, const unsigned char *bytes, unsigned count)
{
	const struct target *target = closure;

	return target->write(target->state, bytes, count) == 0 ? CAIRO_STATUS_SUCCESS
							       : CAIRO_STATUS_WRITE_ERROR;
}

static cairo_surface_t *
make_surface(enum spec_plotting_format format, struct target *target)
{
	cairo_surface_t *surface;

	if (format == SPEC_PLOTTING_PNG)
		return cairo_image_surface_create(
			CAIRO_FORMAT_RGB24, (int)PAGE_WIDTH, (int)PAGE_HEIGHT);
	if (format == SPEC_PLOTTING_SVG)
		return cairo_svg_surface_create_for_stream(
			pass_on, target, PAGE_WIDTH, PAGE_HEIGHT);
	surface = cairo_pdf_surface_create_for_stream(
		pass_on, target, PAGE_WIDTH, PAGE_HEIGHT);
	/* The same plot is the same file. */
	cairo_pdf_surface_set_metadata(
		surface, CAIRO_PDF_METADATA_CREATE_DATE, "2000-01-01T00:00:00Z");
	return surface;
}

static const char *
draw(const struct spec_plotting_request *request,
	int (*write)(void *state, const unsigned char *bytes, size_t count), void *state)
{
	static const struct spec_panel left = {
		.left = 70, .top = 30, .width = 480, .height = 430};
	static const struct spec_panel right = {
		.left = 610, .top = 30, .width = 470, .height = 525};
	struct target target = {write, state};
	cairo_surface_t *surface = make_surface(request->format, &target);
	cairo_t *cairo = cairo_create(surface);
	cairo_status_t status;

	cairo_set_source_rgb(cairo, 1, 1, 1);
	cairo_paint(cairo);
	cairo_select_font_face(
		cairo, "sans-serif", CAIRO_FONT_SLANT_NORMAL, CAIRO_FONT_WEIGHT_NORMAL);
	cairo_set_font_size(cairo, FONT_SIZE);
	spec_plot_spectra(cairo, request, left);
	spec_plot_diagram(cairo, request, right);
	status = cairo_status(cairo);
	cairo_destroy(cairo);
	if (status == CAIRO_STATUS_SUCCESS && request->format == SPEC_PLOTTING_PNG)
		status = cairo_surface_write_to_png_stream(surface, pass_on, &target);
	cairo_surface_finish(surface);
	if (status == CAIRO_STATUS_SUCCESS)
		status = cairo_surface_status(surface);
	cairo_surface_destroy(surface);
	/* One plot is all there is in a process, and what is cached for others is no leak. */
	cairo_debug_reset_static_data();
	FcFini();
	return status == CAIRO_STATUS_SUCCESS ? NULL : cairo_status_to_string(status);
}

extern const struct spec_plotting spec_plotting;
const struct spec_plotting spec_plotting = {SPEC_PLOTTING_VERSION, draw};
