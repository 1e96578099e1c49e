/*
 * The plugin pictures.so: picture formats that OpenImageIO reads and writes. Loaded by
 * plugin.c alone, when such a format is asked for, since OpenImageIO costs 0.2 s
 * and 132 MB at every start. A C interface: no exception leaves it.
 */
#ifndef SPEC_IMAGE_PICTURES_H
#define SPEC_IMAGE_PICTURES_H

#include <stddef.h>

#include "base/error.h"

/* To be raised with every change below, and of struct spec_error. */
#define SPEC_PICTURES_VERSION 3

/* The only symbol: a constant struct spec_pictures. */
#define SPEC_PICTURES_SYMBOL "spec_pictures"

struct spec_pictures_request {
	const char *suffix; /* without the dot */
	size_t width, height;
	size_t channels;
	int bits;                     /* 8, 16: integers; 32: floats */
	const char *colour;           /* OpenImageIO's name of the colour space, or null */
	const unsigned char *profile; /* of ICC, for formats that hold it, or null */
	size_t profile_bytes;
};

/* What a file that is read holds. */
struct spec_pictures_content {
	const char *format; /* OpenImageIO's name, such as "png"; the picture's own */
	int width, height;
	int channels;
	int integers; /* its numbers are whole, and come divided by the largest */
	int encoded;  /* by sRGB's transfer function, as far as the file says */
	const char *description; /* "" if it has none; the picture's own */
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

	/* The next count rows, channels interleaved, from top to bottom. */
	enum spec_status (*write)(
		void *picture, const void *rows, size_t count, struct spec_error *error);

	/*
	 * Ends the picture. The encoded file is the picture's, until close.
	 */
	enum spec_status (*finish)(void *picture, const unsigned char **bytes, size_t *size,
		struct spec_error *error);

	/* Frees all and removes temporary files; null is harmless. */
	void (*close)(void *picture);

	/* Begins to read a file; *input is null after an error. */
	enum spec_status (*open_input)(void **input, const char *path,
		struct spec_pictures_content *content, struct spec_error *error);

	/* Rows first..end-1 as floats, channels interleaved. Not from two threads at once. */
	enum spec_status (*read_input)(
		void *input, int first, int end, float *rows, struct spec_error *error);

	/* Null is harmless. */
	void (*close_input)(void *input);
};

#endif
