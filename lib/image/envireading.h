/* Inside envireader.c and envidescribe.c alone: the reader of ENVI files. */
#ifndef SPEC_IMAGE_ENVIREADING_H
#define SPEC_IMAGE_ENVIREADING_H

#include "image/enviheader.h"
#include "image/reading.h"

struct envi_reader {
	struct spec_reader base;
	struct envi_header header;
	struct spec_source data; /* where the header is the file that was named */
	struct spec_source *from;
	size_t *band;          /* in the file, of each channel */
	double *gain, *offset; /* of each band in the file, or null */
	double ignored;        /* stands for no value; or NaN */
};

/*
 * From the header, and what the user says: the image without its samples, the band of each
 * channel, and how numbers become values. SPEC_EFORMAT, SPEC_ERANGE: a field makes no sense;
 * SPEC_EUSAGE: neither says what the image holds; SPEC_ENOMEM.
 */
enum spec_status envi_describe(struct envi_reader *reader,
	const struct spec_settings *settings, struct spec_error *error);

#endif
