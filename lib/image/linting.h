/* Inside lint*.c alone: an image that is being looked at. */
#ifndef SPEC_IMAGE_LINTING_H
#define SPEC_IMAGE_LINTING_H

#include "image/lint.h"
#include "image/reader.h"

/* A channel of a band, by its wavelength. */
struct spec_linting_band {
	double wavelength_nm;
	size_t channel;
};

struct spec_linting {
	struct spec_lint *lint;
	const struct spec_image *image; /* which may have no index */
	struct spec_storage storage;
	int exr; /* the file is OpenEXR, whose attributes the layout asks for */
	enum spec_status status; /* of adding: once memory is out, nothing more is added */
	struct spec_error *error;
	/*
	 * The bands that there are, index or not, each list by wavelength: S0 to S3, or T in
	 * the first.
	 */
	enum spec_role role;
	struct spec_linting_band *band[4];
	size_t bands[4];
};

void spec_linting_add(struct spec_linting *linting, enum spec_lint_severity severity,
	const char *place, const char *format, ...) __attribute__((format(printf, 4, 5)));

/* Finds the bands, and what is wrong with channels: names, types, grids. */
void spec_linting_channels(struct spec_linting *linting);

/* What is wrong with attributes, after spec_linting_channels. */
void spec_linting_attributes(struct spec_linting *linting);

/* What is wrong with light layers and geometry. */
void spec_linting_layers(struct spec_linting *linting);

/* Reads all samples, and tells what is wrong with them. Errors: those of reading. */
enum spec_status spec_linting_samples(struct spec_linting *linting,
	struct spec_reader *reader, const struct spec_settings *settings,
	struct spec_error *error);

#endif
