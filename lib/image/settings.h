/* What every image tool lets its user set: limits, part, compression, threads. */
#ifndef SPEC_IMAGE_SETTINGS_H
#define SPEC_IMAGE_SETTINGS_H

#include "base/error.h"
#include "image/image.h"

/* Refused before allocating; the message names the limit and the option that lifts it. */
struct spec_limits {
	long long pixels;     /* width times height */
	long long channels;   /* at most 32767, which OpenEXR cannot exceed */
	long long attributes; /* of a part */
	long long header;     /* bytes */
	long long memory;     /* bytes of pixel buffers at one time */
};

struct spec_settings {
	struct spec_limits limits;
	const char *output; /* "-" is standard output */
	const char *format; /* of images that are written; null: by the output's suffix */
	const char *part;   /* null: the only part with bands */
	/* What the user tells of bands, as given.h has it; null, OTHER: nothing. */
	const char *name_map, *wavelengths;
	enum spec_role read_as;
	int compression; /* as OpenEXR numbers them, or -1: the default */
	int half;
	int threads;
	int history;
	/* The command, for the history; the tool sets it. */
	int argc;
	char **argv;
	int quiet;
	int progress; /* 1: wanted even when stderr is no terminal */
	int reread;   /* images are read more than once: a pipe becomes a temporary file */
	/* Called now and then, from one thread at a time, with the lines done; may be null. */
	void (*show)(void *show_state, int done, int total);
	void *show_state;
};

/* The defaults; threads is the number of processors. */
void spec_settings_init(struct spec_settings *settings);

/*
 * Takes an option by its long name. Returns SPEC_OK with *known 0 where it is
 * none of these; errors as spec_number_parse's, or an unknown name.
 */
enum spec_status spec_settings_take(struct spec_settings *settings, const char *name,
	const char *value, int *known, struct spec_error *error);

/* Adds the command to an image's history, unless none is wanted. SPEC_ENOMEM. */
enum spec_status spec_settings_record(const struct spec_settings *settings,
	struct spec_image *image, struct spec_error *error);

/* "zip", "none", … to OpenEXR's number; DWA is refused: OpenEXRCore 3.1 cannot do it. */
enum spec_status spec_settings_compression(
	const char *name, int *compression, struct spec_error *error);

/* The other way round, or null. */
const char *spec_settings_compression_name(int compression);

/* "X0,Y0,X1,Y1", whole numbers from 0 on. Error (SPEC_EUSAGE): something else. */
enum spec_status spec_settings_crop(
	const char *text, struct spec_window *crop, struct spec_error *error);

#endif
