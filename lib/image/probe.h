/* The samples of single pixels, or their means over rectangles, and how they look. */
#ifndef SPEC_IMAGE_PROBE_H
#define SPEC_IMAGE_PROBE_H

#include <stdio.h>

#include "base/error.h"
#include "base/json.h"
#include "colour/appearance.h"
#include "image/reader.h"

/* A pixel or a rectangle of them, counted from the data window's corner. */
struct spec_probe {
	char *name; /* of a rectangle; a pixel has none */
	size_t x, width;
	int y, height;
	double *value; /* of each channel of the image, once it is read */
	struct spec_appearance seen;
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

/* Frees what the probes hold, not the list. */
void spec_probe_free(struct spec_probe *probe, size_t probes);

/*
 * How the spectra look, of probes that are read: S0 as light, which is absolute where the
 * quantity is a radiance; T, and what is reradiated, under the viewing's illuminant. An image
 * without bands, or with none that the observer sees, has no appearance. Errors: SPEC_ENOMEM;
 * those of spec_rgb_plan where the viewing's rule is another than "cie".
 */
enum spec_status spec_probe_see(struct spec_probe *probe, size_t probes,
	const struct spec_reader *reader, const struct spec_viewing *viewing,
	struct spec_error *error);

/*
 * The spectra as text: a line per band, its wavelength in nm and a value per probe and
 * Stokes component. The header is that of spd(5), so that they are curves to other tools
 * unless a value is not finite; other channels and how the spectra look are told in its
 * comments. Error: SPEC_ENOMEM.
 */
enum spec_status spec_probe_print(FILE *stream, const struct spec_reader *reader,
	const struct spec_probe *probe, size_t probes, struct spec_error *error);

/* An object; specinfo(1) says what its keys mean. Probes are all pixels, or none is. */
enum spec_status spec_probe_json(struct spec_json *json, const struct spec_reader *reader,
	const struct spec_probe *probe, size_t probes, struct spec_error *error);

#endif
