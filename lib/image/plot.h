/* Plots of spectra and of their places in the chromaticity diagram. */
#ifndef SPEC_IMAGE_PLOT_H
#define SPEC_IMAGE_PLOT_H

#include "base/error.h"
#include "colour/appearance.h"
#include "image/plotting.h"
#include "image/probe.h"
#include "spectrum/curve.h"

#define SPEC_PLOT_MOST 1000 /* spectra */

struct spec_plot {
	enum spec_plotting_format format;
	char *quantity; /* of all, or null where there are several: then each is scaled to 1 */
	char *unit; /* of all, or null where there are several; "" where it is not known */
	size_t count, room;
	struct spec_plotting_series *series;
};

/* An empty plot. Error (SPEC_EUSAGE): the path ends in neither .png, .svg nor .pdf. */
enum spec_status spec_plot_open(
	const char *path, struct spec_plot *plot, struct spec_error *error);
void spec_plot_free(struct spec_plot *plot);

/*
 * Adds a column of a curve, called name; appearance: null, it is no colour. Errors:
 * SPEC_ERANGE, there are SPEC_PLOT_MOST already; SPEC_ENOMEM.
 */
enum spec_status spec_plot_add_curve(struct spec_plot *plot, const char *name,
	const struct spec_curve *curve, size_t column,
	const struct spec_appearance *appearance, struct spec_error *error);

/* The same of probes that were read and seen: S0 or T. An image without bands adds none. */
enum spec_status spec_plot_add_probes(struct spec_plot *plot,
	const struct spec_probe *probe, size_t probes, const struct spec_reader *reader,
	struct spec_error *error);

/*
 * Draws it all to a file that is whole or not there. The locus and the black bodies are
 * those of the viewing's observer; sRGB's triangle is drawn for CIE 1931 alone. Errors:
 * SPEC_EUSAGE, there is nothing to plot, or the observer sees no X, Y and Z;
 * SPEC_EUNSUPPORTED, the plugin is not there; those of spec_output_save.
 */
enum spec_status spec_plot_save(const struct spec_plot *plot, const char *path,
	const struct spec_viewing *viewing, struct spec_error *error);

#endif
