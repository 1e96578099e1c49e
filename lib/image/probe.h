/* The samples of single pixels. */
#ifndef SPEC_IMAGE_PROBE_H
#define SPEC_IMAGE_PROBE_H

#include <stdio.h>

#include "base/error.h"
#include "base/json.h"
#include "image/reader.h"

/* A pixel, counted from the data window's corner. */
struct spec_probe {
	size_t x;
	int y;
	double *value; /* of each channel of the image, once it is read */
};

/* "X,Y", whole numbers from 0 on. Error (SPEC_EUSAGE, SPEC_ERANGE): something else. */
enum spec_status spec_probe_parse(
	const char *text, struct spec_probe *probe, struct spec_error *error);

/*
 * Reads the pixels, no more lines than they need; once per reader. Error (SPEC_ERANGE): a
 * pixel outside the image; and those of reading.
 */
enum spec_status spec_probe_read(struct spec_probe *probe, size_t probes,
	struct spec_reader *reader, struct spec_error *error);

void spec_probe_free(struct spec_probe *probe, size_t probes);

/*
 * The spectra as text: a line per band, its wavelength in nm and a value per probe and
 * Stokes component. The header is that of spd(5), so that they are curves to other tools
 * unless a value is not finite; other channels are told in its comments. Error: SPEC_ENOMEM.
 */
enum spec_status spec_probe_print(FILE *stream, const struct spec_reader *reader,
	const struct spec_probe *probe, size_t probes, struct spec_error *error);

/* An object; specinfo(1) says what its keys mean. */
enum spec_status spec_probe_json(struct spec_json *json, const struct spec_reader *reader,
	const struct spec_probe *probe, size_t probes, struct spec_error *error);

#endif
