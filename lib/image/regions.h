/* Rectangles of an image, such as the patches of a chart, and their mean spectra. */
#ifndef SPEC_IMAGE_REGIONS_H
#define SPEC_IMAGE_REGIONS_H

#include "base/error.h"
#include "image/probe.h"
#include "image/reader.h"
#include "image/settings.h"

#define SPEC_REGIONS_MOST 65536 /* rectangles, and columns or rows of a chart */

struct spec_regions {
	int columns, rows; /* of a chart; 0, 0: the rectangles were named */
	size_t probes, room;
	struct spec_probe *probe;
};

/*
 * text: a chart's "COLUMNSxROWS", or else a file, a rectangle per line: "NAME X0 Y0 X1 Y1",
 * whole numbers from the data window's corner, X1 and Y1 not inside. Empty lines and those
 * that begin with '#' are skipped. Errors: SPEC_EIO; SPEC_EFORMAT, another line (the message
 * says which), two of a name, no rectangle; SPEC_ERANGE, more than SPEC_REGIONS_MOST.
 */
enum spec_status spec_regions_parse(
	const char *text, struct spec_regions *regions, struct spec_error *error);

void spec_regions_free(struct spec_regions *regions);

/*
 * Reads an image's lines, as far as the rectangles reach, and puts the means over each, in
 * double, into its values; once per reader. A chart's patches fill the data window; of each
 * the middle half of both sides is measured, and it is called by its number, row by row from
 * 1. The same bits for any number of threads. A NaN in a rectangle is one in its mean, and
 * what is no number that could be averaged (a UINT that is no band) is NaN where the
 * rectangle has several pixels. Errors: SPEC_ERANGE, a rectangle outside the image, or a
 * chart with more patches than the image has pixels to a side; and those of reading.
 */
enum spec_status spec_regions_read(struct spec_regions *regions, struct spec_reader *reader,
	const struct spec_settings *settings, struct spec_error *error);

#endif
