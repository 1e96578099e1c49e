/*
 * What a format of files is to writer.c and packer.c: one table of functions each. These
 * two gather lines into chunks, side by side, and see to it that chunks are written in
 * order; a format writes the header, encodes chunks and puts them into the file.
 */
#ifndef SPEC_IMAGE_WRITING_H
#define SPEC_IMAGE_WRITING_H

#include <pthread.h>

#include "base/parallel.h"
#include "image/writer.h"

/* A chunk that is being put together. */
struct spec_slot {
	int index; /* of the chunk, or -1: free */
	int missing;
	unsigned char *raw; /* line by line, in each channel by channel, the samples */
};

/* A format's own writer begins with this. */
struct spec_writer {
	const struct spec_writing_format *format;
	const struct spec_image *image;
	struct spec_output *output; /* or null: the format makes its own of path */
	const char *path;
	int compression; /* OpenEXR's number, or -1 */
	int chunk_lines; /* 1 unless the format's open says otherwise */
	size_t chunks;
	size_t line_bytes;
	size_t *offset;       /* of each channel in a line of a slot */
	int direct;           /* planes can lie in the chunk itself */
	pthread_mutex_t lock; /* guards slot and overflows */
	struct spec_slot *slot;
	size_t slots, slot_room;
	unsigned long long overflows; /* of the packers that are closed */
	struct spec_turnstile turnstile;
};

/* A format's own packer begins with this. */
struct spec_packer {
	struct spec_writer *writer;
	const void *chunk; /* what is to be written: the packer's, or the slot */
	size_t chunk_bytes;
	unsigned long long overflows; /* samples that HALF could not hold */
	float **plane;
	float *row; /* where planes do not lie in the chunk */
};

/* That of formats with own_samples whose files hold the bands alone. */
struct spec_sample_packer {
	struct spec_packer base;
	float *samples; /* of a chunk's bands, in the file's order */
};

/* Their open_packer and close_packer. */
enum spec_status spec_sample_packer_open(
	struct spec_packer *packer, struct spec_error *error);
void spec_sample_packer_close(struct spec_packer *packer);

/* Those that are null do nothing. */
struct spec_writing_format {
	const char *name;                  /* as --format has it */
	const char *suffixes;              /* of -o, with their dots, blanks between */
	size_t writer_bytes, packer_bytes; /* of the format's own structs */
	int makes_files; /* the files are the format's own matter: writer->output is null */
	int own_samples; /* it stores bands in its own way: lines come as floats, never HALF */

	/* Refuses what the format cannot hold, and writes what comes before the lines. */
	enum spec_status (*open)(struct spec_writer *writer, struct spec_error *error);
	enum spec_status (*open_packer)(
		struct spec_packer *packer, struct spec_error *error);

	/* Makes packer->chunk, which is the slot's bytes, another one. Side by side. */
	enum spec_status (*encode)(struct spec_packer *packer, int index,
		unsigned char *raw, struct spec_error *error);

	/* Writes packer->chunk, in order. */
	enum spec_status (*write)(
		struct spec_packer *packer, int index, struct spec_error *error);

	/* When all chunks are written: what comes after them. */
	enum spec_status (*finish)(struct spec_writer *writer, struct spec_error *error);

	/* After the output was committed: files beside it get their names. */
	enum spec_status (*commit)(struct spec_writer *writer, struct spec_error *error);

	/* Both must cope with whatever a failed open left. */
	void (*close_packer)(struct spec_packer *packer);
	void (*close)(struct spec_writer *writer);
};

extern const struct spec_writing_format spec_writing_exr, spec_writing_envi,
	spec_writing_hsr, spec_writing_tiff, spec_writing_folder;

/* Lines of a chunk: the last may have fewer. */
int spec_writing_lines(const struct spec_writer *writer, int index);

/* The first line of a chunk. */
static inline int
spec_writing_first_line(const struct spec_writer *writer, int index)
{
	return writer->image->data.y0 + index * writer->chunk_lines;
}

/*
 * SPEC_EUNSUPPORTED: the image has anything but one value for each band, which is all that
 * the format, called so in the message, can hold.
 */
enum spec_status spec_writing_only_bands(
	const struct spec_writer *writer, const char *format, struct spec_error *error);

/*
 * The bands of a chunk, of a format with own_samples, by wavelength, channels lying in the
 * order of their names. Of one line, pixel by pixel: to[x * bands + band]; or band by band,
 * each with its lines: to[(band * lines + line) * width + x]. raw: as encode gets it.
 */
void spec_writing_by_pixel(
	const struct spec_writer *writer, const unsigned char *raw, float *to);
void spec_writing_by_band(
	const struct spec_writer *writer, int index, const unsigned char *raw, float *to);

/* Lines of a chunk where each band's go to another place: so many that it is worth a call. */
int spec_writing_plane_lines(const struct spec_writer *writer);

/* A format's write where chunks simply follow each other in the output. */
enum spec_status spec_writing_append(
	struct spec_packer *packer, int index, struct spec_error *error);

#endif
