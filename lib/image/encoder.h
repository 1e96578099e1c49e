/* What the picture formats are to picture.c: one table of functions each. */
#ifndef SPEC_IMAGE_ENCODER_H
#define SPEC_IMAGE_ENCODER_H

#include <stddef.h>

#include "image/picture.h"

struct spec_picture_encoder;

struct spec_picture {
	const struct spec_picture_encoder *encoder;
	struct spec_picture_kind kind;
	struct spec_output *output;
	const struct spec_space *space; /* or null */
	size_t width, height;
	size_t done;                  /* rows that were written */
	unsigned long long overflows; /* as spec_picture_overflows tells them */
	struct spec_error failure;    /* the first; status SPEC_OK: none */
	void *state;                  /* the format's own */
};

/*
 * picture.c checks the calls: rows never exceed the height, finish comes once and
 * when all rows are there, nothing but close follows an error. close must cope with
 * whatever a failed open left, also with a null state.
 */
struct spec_picture_encoder {
	enum spec_status (*open)(struct spec_picture *picture, struct spec_error *error);
	enum spec_status (*write)(struct spec_picture *picture, const void *rows,
		size_t count, struct spec_error *error);
	enum spec_status (*finish)(struct spec_picture *picture, struct spec_error *error);
	void (*close)(struct spec_picture *picture);
};

extern const struct spec_picture_encoder spec_picture_encoder_png;
extern const struct spec_picture_encoder spec_picture_encoder_ppm;
extern const struct spec_picture_encoder spec_picture_encoder_exr;
extern const struct spec_picture_encoder spec_picture_encoder_plugin;

/*
 * Whether the plugin can write files of that suffix (without the dot). path: for
 * the message. Errors (SPEC_EUNSUPPORTED): it cannot, or it cannot be loaded.
 */
enum spec_status spec_plugin_knows(
	const char *suffix, const char *path, struct spec_error *error);

#endif
