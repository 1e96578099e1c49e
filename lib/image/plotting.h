/*
 * The plugin plots.so: spectra and a chromaticity diagram, drawn by cairo. Loaded by plot.c
 * alone, when a plot is asked for, since cairo costs 4 ms at every start. What it draws is
 * computed before: it knows nothing of colour.
 */
#ifndef SPEC_IMAGE_PLOTTING_H
#define SPEC_IMAGE_PLOTTING_H

#include <stddef.h>

/* To be raised with every change below. */
#define SPEC_PLOTTING_VERSION 2

/* The only symbol: a constant struct spec_plotting. */
#define SPEC_PLOTTING_SYMBOL "spec_plotting"

enum spec_plotting_format { SPEC_PLOTTING_PNG, SPEC_PLOTTING_SVG, SPEC_PLOTTING_PDF };

/* A spectrum, and its point in the diagram. */
struct spec_plotting_series {
	char *name;
	size_t count;
	double *wavelength_nm; /* ascending */
	double *value;         /* what is not finite interrupts the line */
	double xy[2];          /* NaN: no point */
};

/* A temperature on the Planckian locus. */
struct spec_plotting_body {
	double temperature_k, xy[2];
	int labelled;
};

struct spec_plotting_request {
	enum spec_plotting_format format;
	char *quantity; /* on the axis of values; like all texts, valid UTF-8 */
	char *observer; /* over the diagram */
	size_t count;
	const struct spec_plotting_series *series;

	size_t locus_count;
	double (*locus_xy)[2];
	double *locus_nm;
	size_t bodies;
	const struct spec_plotting_body *body;
	int triangle; /* that of a space is drawn */
	const char *space;
	double primary_xy[3][2], white_xy[2];
	double from_xyz[9]; /* to the space's linear RGB, for the tints */
};

struct spec_plotting {
	int version;

	/*
	 * Draws, and calls write with the file's bytes, piece by piece; write returns 0 to
	 * go on. Returns null, or what is wrong.
	 */
	const char *(*draw)(const struct spec_plotting_request *request,
		int (*write)(void *state, const unsigned char *bytes, size_t count),
		void *state);
};

#endif
