/*
 * Writing a finished RGB picture row by row, in the format that the name of the
 * file asks for. PNG, PPM and OpenEXR are written here; any other format goes
 * through OpenImageIO, in a plugin that is loaded only then.
 */
#ifndef SPEC_IMAGE_PICTURE_H
#define SPEC_IMAGE_PICTURE_H

#include <stddef.h>

#include "base/error.h"
#include "base/output.h"
#include "colour/space.h"

/* Most pixels of a picture, width times height. */
#define SPEC_PICTURE_MOST_PIXELS ((size_t)1 << 30)

enum spec_picture_sample {
	SPEC_PICTURE_U8,   /* uint8_t, 0..255 */
	SPEC_PICTURE_U16,  /* uint16_t, 0..65535 */
	SPEC_PICTURE_FLOAT /* linear, 1 is white; neither end is a limit */
};

/* Bytes of a sample as spec_picture_write is given it. */
size_t spec_picture_sample_bytes(enum spec_picture_sample sample);

enum spec_picture_format {
	SPEC_PICTURE_PNG,
	SPEC_PICTURE_PPM,
	SPEC_PICTURE_EXR,
	SPEC_PICTURE_PLUGIN
};

/* What spec_picture_choose found. Callers need only sample, and may fill in the last two. */
struct spec_picture_kind {
	enum spec_picture_format format;
	enum spec_picture_sample sample; /* what spec_picture_write is given */
	int half;                        /* floats are stored with 16 bits */
	char suffix[16];                 /* lower case, without the dot */
	/*
	 * What OpenEXR can tell: account.h's text, or null; the
	 * luminance of 1 [cd m^-2], or 0.
	 */
	const char *account;
	double luminance;
};

/*
 * The format of a name, such as png, or, where that is null, the one that the suffix of path
 * asks for, in upper or lower case; "-" is PNG then.
 * bits: per sample, 8, 16 or 32, or 0: the format's usual. PNG and PPM (.ppm, .pnm)
 * hold 8 (usual) or 16; EXR floats of 32 (usual) or 16; TIFF 8 (usual), 16, or floats
 * of 32; HDR floats (32); every other format 8.
 * Errors (SPEC_EUSAGE): no suffix, another number of bits; (SPEC_EUNSUPPORTED): no
 * format of that suffix, bits that it cannot hold, the plugin cannot be loaded.
 */
enum spec_status spec_picture_choose(const char *path, const char *format, int bits,
	struct spec_picture_kind *kind, struct spec_error *error);

/*
 * Whether who reads a file of that kind knows its space: the file tells it, or it is what
 * readers take for granted, sRGB. OpenImageIO 2.4 writes profiles to TIFF and JPEG alone.
 */
int spec_picture_tells_space(
	const struct spec_picture_kind *kind, const struct spec_space *space);

struct spec_picture;

/*
 * Begins a picture. The output must live as long as the picture; committing or
 * abandoning it stays the caller's. space: what the samples' numbers mean, or null:
 * the file does not say. Integers are encoded by space->transfer, floats are linear.
 * Errors: the output is a terminal (SPEC_EUSAGE); no pixels, or more than
 * SPEC_PICTURE_MOST_PIXELS (SPEC_ERANGE); coordinates other than RGB in a format other
 * than OpenEXR (SPEC_EUNSUPPORTED); what the system or the format refuses.
 */
enum spec_status spec_picture_open(struct spec_picture **picture,
	const struct spec_picture_kind *kind, struct spec_output *output, size_t width,
	size_t height, const struct spec_space *space, struct spec_error *error);

/*
 * The next count rows, from top to bottom: red, green, blue of each pixel, as the
 * kind's samples, in this machine's byte order, aligned as C wants them. After an
 * error every further call gives that error again. HDR holds nothing below 0: such
 * samples, and NaN, become 0.
 * Errors: more rows than the picture has (SPEC_EUSAGE); what the system or the
 * format refuses.
 */
enum spec_status spec_picture_write(struct spec_picture *picture, const void *rows,
	size_t count, struct spec_error *error);

/* Ends the file. Errors: rows are missing (SPEC_EUSAGE), or as spec_picture_write's. */
enum spec_status spec_picture_finish(
	struct spec_picture *picture, struct spec_error *error);

/* How many finite samples were too large for floats of 16 bits, once it is finished. */
unsigned long long spec_picture_overflows(const struct spec_picture *picture);

/* At any time, finished or not; null is harmless. */
void spec_picture_close(struct spec_picture *picture);

/* A picture and the file that it becomes, which is there whole or not at all; not to be moved. */
struct spec_picture_file {
	struct spec_picture *picture;
	struct spec_output output;
};

/* As spec_output_open and spec_picture_open; after an error there is nothing to be ended. */
enum spec_status spec_picture_file_open(struct spec_picture_file *file, const char *path,
	const struct spec_picture_kind *kind, size_t width, size_t height,
	const struct spec_space *space, struct spec_error *error);

/*
 * Closes the picture, and commits the file if status, that of all which was done to it, is
 * SPEC_OK, else abandons it. Returns status, or that of committing.
 */
enum spec_status spec_picture_file_end(
	struct spec_picture_file *file, enum spec_status status, struct spec_error *error);

#endif
