#include "image/plot.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <strings.h>

#include "base/memory.h"
#include "base/output.h"
#include "base/path.h"
#include "base/text.h"
#include "colour/dominant.h"
#include "colour/space.h"
#include "colour/temperature.h"
#include "image/describe.h"
#include "image/plugin.h"

enum spec_status
spec_plot_open(const char *path, struct spec_plot *plot, struct spec_error *error)
{
	static const char *const suffix[] = {[SPEC_PLOTTING_PNG] = ".png",
		[SPEC_PLOTTING_SVG] = ".svg",
		[SPEC_PLOTTING_PDF] = ".pdf"};
	const char *dot = spec_path_suffix(path);

	*plot = (struct spec_plot){0};
	for (size_t i = 0; i < sizeof suffix / sizeof *suffix; i++) {
		if (strcasecmp(dot, suffix[i]) == 0) {
			plot->format = (enum spec_plotting_format)i;
			return SPEC_OK;
		}
	}
	return spec_error_set(error, SPEC_EUSAGE,
		"a plot is written as .png, .svg or .pdf, which '%s' does not say", path);
}

void
spec_plot_free(struct spec_plot *plot)
{
	for (size_t i = 0; i < plot->count; i++) {
		free(plot->series[i].name);
		free(plot->series[i].wavelength_nm);
		free(plot->series[i].value);
	}
	free(plot->series);
	free(plot->quantity);
	free(plot->unit);
	*plot = (struct spec_plot){0};
}

/* A text that is another than that of all before is left out. */
static void
drop_other(char **text, const char *other)
{
	if (!*text || strcmp(*text, other) == 0)
		return;
	free(*text);
	*text = NULL;
}

static enum spec_status
take_quantity(struct spec_plot *plot, const char *quantity, const char *unit,
	struct spec_error *error)
{
	if (plot->count > 0) {
		drop_other(&plot->quantity, quantity);
		drop_other(&plot->unit, unit);
		return SPEC_OK;
	}
	plot->quantity = spec_memory_text(quantity, strlen(quantity), error);
	plot->unit = spec_memory_text(unit, strlen(unit), error);
	return plot->quantity && plot->unit ? SPEC_OK : SPEC_ENOMEM;
}

/* Room for a spectrum; what it holds is the caller's to fill in. */
static enum spec_status
add_series(struct spec_plot *plot, const char *name, const char *quantity, const char *unit,
	const double *wavelength_nm, size_t count, const struct spec_appearance *appearance,
	struct spec_error *error)
{
	void *list = plot->series;
	struct spec_plotting_series *series;
	enum spec_status status = take_quantity(plot, quantity, unit, error);

	if (status != SPEC_OK)
		return status;
	if (plot->count == SPEC_PLOT_MOST)
		return spec_error_set(error, SPEC_ERANGE,
			"more than %d spectra are too many for a plot", SPEC_PLOT_MOST);
	status = spec_memory_grow(
		&list, &plot->room, plot->count + 1, sizeof *series, "spectra", error);
	plot->series = list;
	if (status != SPEC_OK)
		return status;
	series = &plot->series[plot->count++];
	*series = (struct spec_plotting_series){.count = count, .xy = {NAN, NAN}};
	if (appearance)
		memcpy(series->xy, appearance->xy, sizeof series->xy);
	series->name = spec_text_readable(name, error);
	series->wavelength_nm = spec_memory_new(count, sizeof(double), "samples", error);
	series->value = spec_memory_new(count, sizeof(double), "samples", error);
	if (!series->name || !series->wavelength_nm || !series->value)
		return SPEC_ENOMEM;
	memcpy(series->wavelength_nm, wavelength_nm, count * sizeof(double));
	return SPEC_OK;
}

enum spec_status
spec_plot_add_curve(struct spec_plot *plot, const char *name,
	const struct spec_curve *curve, size_t column,
	const struct spec_appearance *appearance, struct spec_error *error)
{
	enum spec_status status = add_series(plot, name, curve->quantity, curve->unit,
		curve->wavelength_nm, curve->count, appearance, error);

	if (status == SPEC_OK)
		memcpy(plot->series[plot->count - 1].value,
			curve->value + column * curve->count,
			curve->count * sizeof(double));
	return status;
}

static enum spec_status
add_probe(struct spec_plot *plot, const struct spec_probe *probe,
	const struct spec_image *image, const char *quantity, struct spec_error *error)
{
	const char *unit = spec_describe_unit(quantity);
	char place[64];
	enum spec_status status;

	snprintf(place, sizeof place, "%zu,%d", probe->x, probe->y);
	status = add_series(plot, probe->name ? probe->name : place, quantity,
		unit ? unit : "", image->wavelength_nm, image->bands, &probe->seen, error);
	for (size_t i = 0; i < image->bands && status == SPEC_OK; i++)
		plot->series[plot->count - 1].value[i] =
			probe->value[image->band_channel[i]];
	return status;
}

enum spec_status
spec_plot_add_probes(struct spec_plot *plot, const struct spec_probe *probe, size_t probes,
	const struct spec_reader *reader, struct spec_error *error)
{
	const struct spec_image *image = spec_reader_image(reader);
	char *quantity = spec_image_quantity(image, error);
	enum spec_status status = quantity ? SPEC_OK : SPEC_ENOMEM;

	for (size_t i = 0; i < probes && image->bands > 0 && status == SPEC_OK; i++)
		status = add_probe(plot, &probe[i], image, quantity, error);
	free(quantity);
	return status;
}

/* Spectra of several quantities share an axis: each is divided by its greatest value. */
static void
scale_series(struct spec_plotting_series *series)
{
	double most = 0;

	for (size_t i = 0; i < series->count; i++) {
		double size = fabs(series->value[i]);

		most = isfinite(size) && size > most ? size : most;
	}
	for (size_t i = 0; i < series->count && most > 0; i++)
		series->value[i] /= most;
}

/* Black bodies in steps of 5 mired; hotter than the hottest means endlessly hot. */
#define BODIES 201

static void
place_bodies(const struct spec_viewing *viewing, struct spec_plotting_body *body)
{
	static const double labelled_k[] = {2000, 3000, 4000, 6500, 10000};
	const size_t labels = sizeof labelled_k / sizeof *labelled_k;
	double xyz[3];

	for (size_t i = 0; i < BODIES; i++) {
		double t = 1e6 / (5 * (double)i + .1);

		/* In place of the step nearest to it there is the temperature itself. */
		body[i].labelled = 0;
		for (size_t next = 0; next < labels; next++) {
			if (fabs(1e6 / t - 1e6 / labelled_k[next]) <= 2.5) {
				t = labelled_k[next];
				body[i].labelled = 1;
				break;
			}
		}
		body[i].temperature_k = t;
		spec_temperature_black_body(&viewing->observer, t, xyz);
		spec_dominant_xy(xyz, body[i].xy);
	}
}

static int
is_standard(const struct spec_viewing *viewing)
{
	const struct spec_curve *a = &viewing->observer, *b = &viewing->standard;

	return a->count == b->count && a->columns == b->columns &&
	       memcmp(a->value, b->value, a->count * a->columns * sizeof(double)) == 0;
}

static enum spec_status
place_space(struct spec_plotting_request *request, const struct spec_viewing *viewing,
	struct spec_error *error)
{
	const struct spec_space *space = spec_space_find("srgb", error);

	if (!space)
		return SPEC_EUSAGE;
	request->triangle = is_standard(viewing);
	request->space = space->title;
	memcpy(request->primary_xy[0], space->red_xy, sizeof space->red_xy);
	memcpy(request->primary_xy[1], space->green_xy, sizeof space->green_xy);
	memcpy(request->primary_xy[2], space->blue_xy, sizeof space->blue_xy);
	memcpy(request->white_xy, space->white_xy, sizeof space->white_xy);
	return spec_space_from_xyz(space, request->from_xyz, error);
}

static int
keep(void *state, const unsigned char *bytes, size_t count)
{
	return fwrite(bytes, 1, count, state) == count ? 0 : -1;
}

static enum spec_status
draw(const struct spec_plotting_request *request, const char *path,
	struct spec_error *error)
{
	const struct spec_plotting *plotting;
	struct spec_text text = {0};
	const void *table = NULL;
	const char *wrong;
	enum spec_status status =
		spec_plugin_find("plots.so", SPEC_PLOTTING_SYMBOL, &table, error);

	plotting = table;
	if (status == SPEC_OK && plotting->version != SPEC_PLOTTING_VERSION)
		status = spec_error_set(error, SPEC_EUNSUPPORTED,
			"the plugin plots.so is of another version of spectools");
	if (status == SPEC_OK)
		status = spec_text_open(&text, error);
	if (status != SPEC_OK)
		return status;
	wrong = plotting->draw(request, keep, text.stream);
	status = spec_text_close(&text, error);
	if (status == SPEC_OK && wrong)
		status = spec_error_set(error, SPEC_EIO, "%s: %s", path, wrong);
	if (status == SPEC_OK)
		status = spec_output_save(path, text.bytes, text.size, error);
	spec_text_free(&text);
	return status;
}

/* What is on the axis of values, with the unit in brackets where it is one that is known. */
static char *
name_values(const struct spec_plot *plot, struct spec_error *error)
{
	const char *quantity = plot->quantity, *unit = plot->unit;
	char *name, *readable;
	size_t size;

	if (!quantity)
		quantity = "each over its greatest value";
	else if (!*quantity)
		quantity = "value";
	if (!plot->quantity || !unit || strcmp(unit, "1") == 0)
		unit = "";
	size = strlen(quantity) + strlen(unit) + sizeof " []";
	name = spec_memory_new(size, 1, "characters", error);
	if (!name)
		return NULL;
	snprintf(name, size, *unit ? "%s [%s]" : "%s%s", quantity, unit);
	readable = spec_text_readable(name, error);
	free(name);
	return readable;
}

static enum spec_status
fill_request(struct spec_plotting_request *request, const struct spec_plot *plot,
	const struct spec_viewing *viewing, struct spec_plotting_body *body,
	struct spec_error *error)
{
	*request = (struct spec_plotting_request){.format = plot->format,
		.count = plot->count,
		.series = plot->series,
		.bodies = BODIES,
		.body = body};
	request->quantity = name_values(plot, error);
	request->observer = spec_text_readable(viewing->observer.title, error);
	request->locus_xy = spec_memory_new(viewing->observer.count,
		sizeof *request->locus_xy, "observer samples", error);
	request->locus_nm = spec_memory_new(
		viewing->observer.count, sizeof(double), "observer samples", error);
	if (!request->quantity || !request->observer || !request->locus_xy ||
		!request->locus_nm)
		return SPEC_ENOMEM;
	request->locus_count = spec_dominant_locus(
		&viewing->observer, request->locus_xy, request->locus_nm);
	place_bodies(viewing, body);
	return place_space(request, viewing, error);
}

enum spec_status
spec_plot_save(const struct spec_plot *plot, const char *path,
	const struct spec_viewing *viewing, struct spec_error *error)
{
	struct spec_plotting_body body[BODIES];
	struct spec_plotting_request request;
	enum spec_status status;

	if (plot->count == 0)
		return spec_error_set(error, SPEC_EUSAGE, "there is no spectrum to plot");
	if (!viewing->tristimulus)
		return spec_error_set(error, SPEC_EUSAGE,
			"observer '%.200s' has no X, Y and Z to draw a chromaticity diagram "
			"of",
			viewing->observer.title);
	if (!plot->quantity) {
		for (size_t i = 0; i < plot->count; i++)
			scale_series(&plot->series[i]);
	}
	status = fill_request(&request, plot, viewing, body, error);
	if (status == SPEC_OK)
		status = draw(&request, path, error);
	free(request.quantity);
	free(request.observer);
	free(request.locus_xy);
	free(request.locus_nm);
	return status;
}
