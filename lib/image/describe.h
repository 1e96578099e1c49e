/* What is in an image: from its header alone, and statistics where they were taken. */
#ifndef SPEC_IMAGE_DESCRIBE_H
#define SPEC_IMAGE_DESCRIBE_H

#include <stdio.h>

#include "base/error.h"
#include "base/json.h"
#include "image/image.h"
#include "image/layers.h"
#include "image/reader.h"
#include "image/statistics.h"

struct spec_describe_setup {
	const char *format;                       /* of the file: "OpenEXR" */
	const char *representation;               /* as spec_reader_representation has it */
	const struct spec_statistics *statistics; /* one per channel, or null: none */
	int bands; /* of each band, too, where there are some */
};

struct spec_describe {
	const struct spec_image *image;
	struct spec_describe_setup setup;
	const char *name; /* the file's */
	struct spec_storage storage;
	unsigned long long bytes; /* of all samples, uncompressed */
	enum spec_naming naming;  /* of the bands */
	double step_nm;           /* of the bands; 0: irregular, or a single one */
	char *quantity;           /* "" without bands */
	const char *unit;         /* of a sample, or null: not known */
	struct spec_layers layers;
	/* Why there are no layers although there are channels of them. */
	struct spec_error damage;
};

/* The reader and the setup must live as long as describe. Error: SPEC_ENOMEM. */
enum spec_status spec_describe_find(struct spec_describe *describe,
	const struct spec_reader *reader, const struct spec_describe_setup *setup,
	struct spec_error *error);
void spec_describe_free(struct spec_describe *describe);

/* The unit of a sample of that quantity (specexr(5)), or null: not known. */
const char *spec_describe_unit(const char *quantity);

/* For people: the file's name, then a line per thing. */
void spec_describe_print(FILE *stream, const struct spec_describe *describe);

/* For programs: an object; specinfo(1) says what its keys mean. */
void spec_describe_json(struct spec_json *json, const struct spec_describe *describe);

#endif
