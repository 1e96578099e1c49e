/*
 * The plugin pictures.so: picture formats that OpenImageIO writes. Loaded by
 * plugin.c alone, when such a format is asked for, since OpenImageIO costs 0.2 s
 * and 132 MB at every start. A C interface: no exception leaves it.
 */
#ifndef SPEC_IMAGE_PICTURES_H
#define SPEC_IMAGE_PICTURES_H

#include <stddef.h>

#include "base/error.h"

/* To be raised with every change below, and of struct spec_error. */
#define SPEC_PICTURES_VERSION 1

/* The only symbol: a constant struct spec_pictures. */
#define SPEC_PICTURES_SYMBOL "spec_pictures"

struct spec_pictures_request {
	const char *suffix; /* without the dot */
	size_t width, height;
	int bits;           /* 8, 16: integers; 32: floats */
	const char *colour; /* OpenImageIO's name of the colour space, or null */
};

/*
 * Each function that can fail fills *error (never null): the cause alone, perhaps
 * with line breaks; the caller names the file.
 */
struct spec_pictures {
	int version;

	/* SPEC_EUNSUPPORTED: nothing here writes RGB to files of that suffix. */
	enum spec_status (*knows)(const char *suffix, struct spec_error *error);

	/* Begins a picture. *picture is null after an error. */
	enum spec_status (*open)(void **picture,
		const struct spec_pictures_request *request, struct spec_error *error);

	/* The next count rows, interleaved RGB, from top to bottom. */
	enum spec_status (*write)(
		void *picture, const void *rows, size_t count, struct spec_error *error);

	/* Ends the picture. The encoded file is the picture's, until close. */
	enum spec_status (*finish)(void *picture, const unsigned char **bytes, size_t *size,
		struct spec_error *error);

	/* Frees all and removes temporary files; null is harmless. */
	void (*close)(void *picture);
};

#endif
