/*
 * Images whose pixels are not samples in bands: coefficients of a Fourier series, or lines
 * and a smooth rest; specexr(5) specifies them. Any reader of OpenEXR opened by
 * spec_reader_open gives the bands that they stand for, so that every tool takes them.
 */
#ifndef SPEC_IMAGE_REPRESENTED_H
#define SPEC_IMAGE_REPRESENTED_H

#include <stddef.h>

#include "base/error.h"
#include "image/image.h"
#include "image/reader.h"
#include "image/settings.h"
#include "spectrum/represent.h"

#define SPEC_REPRESENTED_MOST_LINES 64
#define SPEC_REPRESENTED_MOST_COEFFICIENTS 1025

/*
 * What an image says in its attribute spec:representation. Of bins, the spectrum is level
 * in each, from the first edge to the last; of point samples it is linear from the first to
 * the last.
 */
struct spec_represented {
	size_t coefficients; /* of the smooth part, odd; 0: it is in bands */
	size_t lines;
	double low_nm, high_nm; /* of the Fourier series */
};

/*
 * What image says. *represented is all 0 where it has no such attribute. SPEC_EFORMAT: it is
 * damaged. name: the file, for messages.
 */
enum spec_status spec_represented_read(const struct spec_image *image, const char *name,
	struct spec_represented *represented, struct spec_error *error);

/*
 * The matrices between bands and coefficients: forth, [coefficients][bands], after T 3.2 and
 * 3.3, exact for spectra as above; back, [bands][coefficients], T 3.1 at point samples, its
 * means in bins. edges_nm: bands + 1, or null. Newly allocated; null: SPEC_ENOMEM.
 */
double *spec_represented_forth(const struct spec_represented *represented,
	const double *wavelength_nm, const double *edges_nm, size_t bands,
	struct spec_error *error);
double *spec_represented_back(const struct spec_represented *represented,
	const double *wavelength_nm, const double *edges_nm, size_t bands,
	struct spec_error *error);

/*
 * Writes the image of a reader in another representation, as spec_image_save does:
 * representation's kind is SPEC_SPECTRUM_FOURIER or SPEC_SPECTRUM_COMPOSITE, its count,
 * coefficients as in represent.h. Errors: no bands, a bispectral image, more coefficients
 * than bands, numbers out of range.
 */
enum spec_status spec_represented_run(struct spec_reader *reader,
	const struct spec_representation *representation,
	const struct spec_settings *settings, unsigned long long *overflows,
	struct spec_error *error);

/* The name of a coefficient's channel: a0, a1, b1, … after the prefix, such as "S0". */
void spec_represented_name(char *text, size_t size, const char *prefix, size_t coefficient);

/* The names of the channels of a line, counted from 0: its weight, and its wavelength. */
void spec_represented_line_names(
	char *weight, char *wavelength, size_t size, const char *prefix, size_t line);

/* "S0" to "S3", or "T". */
const char *spec_represented_prefix(enum spec_role role, int stokes);

#endif
