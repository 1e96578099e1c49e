/*
 * What a format of files is to reader.c: one table of functions each. Reader.c opens the
 * source, finds the format, and checks the calls; a format says what the image is, takes
 * lines from the source, and makes them planes of floats.
 */
#ifndef SPEC_IMAGE_READING_H
#define SPEC_IMAGE_READING_H

#include "base/source.h"
#include "image/reader.h"

struct spec_reading_format;

/* A format's own reader begins with this. */
struct spec_reader {
	const struct spec_reading_format *format;
	struct spec_source source;
	struct spec_image image;
	struct spec_limits limits;
	struct spec_storage storage;
	char *representation; /* of what is in the file, where that is not bands; or null */
	struct spec_error *refused; /* while opening: where bad names are noted; or null */
	int chunk_lines;            /* that are stored, and so decoded, together */
	size_t line_bytes;          /* of one line, as it is stored uncompressed */
};

struct spec_buffer {
	unsigned char *bytes;
	size_t room;
};

/* A format's own decoder begins with this. */
struct spec_decoder {
	struct spec_reader *reader;
	unsigned char *wanted;
	struct spec_buffer packed;    /* what fetch took */
	struct spec_buffer converted; /* planes that decode made */
	float **row;                  /* [lines][channels]; null where not wanted */
	size_t row_room;
	int y0, lines; /* of the block */
};

struct spec_reading_format {
	const char *name;
	size_t reader_bytes, decoder_bytes; /* of the format's own structs */

	/*
	 * Whether the file is one of this format, from its first bytes (size of them, fewer
	 * only where the file is shorter) and its name.
	 */
	int (*recognises)(const unsigned char *bytes, size_t size, const char *path);

	/*
	 * Fills in the image, indexed, and chunk_lines and line_bytes. The source is open
	 * and has not been sealed; limits are set. path: as the user wrote it.
	 */
	enum spec_status (*open)(struct spec_reader *reader, const char *path,
		const struct spec_settings *settings, struct spec_error *error);

	/* Must cope with whatever a failed open left. */
	void (*close)(struct spec_reader *reader);

	/* These two may be null. close must cope with whatever a failed open left. */
	enum spec_status (*open_decoder)(
		struct spec_decoder *decoder, struct spec_error *error);
	void (*close_decoder)(struct spec_decoder *decoder);

	/* As spec_reader_shares; null: it does not. */
	int (*shares)(const struct spec_reader *reader);

	/* As spec_decoder_fetch, for the lines decoder->y0 and decoder->lines say. */
	enum spec_status (*fetch)(struct spec_decoder *decoder, struct spec_error *error);

	/* Fills decoder->row, which has room, for every line and wanted channel. */
	enum spec_status (*decode)(struct spec_decoder *decoder, struct spec_error *error);

	/* As spec_reader_drain; null: the source's own. */
	enum spec_status (*drain)(struct spec_reader *reader, struct spec_error *error);
};

extern const struct spec_reading_format spec_reading_exr, spec_reading_envi,
	spec_reading_hsr, spec_reading_picture;

/* Adds a file to a reader of pictures of one band each that is still to be opened. */
enum spec_status spec_reading_add_picture(
	struct spec_reader *reader, const char *path, struct spec_error *error);

/* For shares: whether one can go to any place in the reader's source. */
int spec_reading_seekable(const struct spec_reader *reader);

/* Bytes of the beginning of a file that a format is recognised by. */
#define SPEC_READING_FIRST_BYTES 1024

static inline size_t
spec_reading_align(size_t size)
{
	return (size + 63) / 64 * 64; /* a cache line, and the widest vector */
}

/*
 * How many pixels of so many bytes, band beside band, to take apart at a time, so that they
 * stay in half of a first-level cache until all their bands are taken.
 */
static inline size_t
spec_reading_run(size_t pixel_bytes)
{
	size_t run = 16384 / pixel_bytes;

	return run < 8 ? 8 : run;
}

/* Grows a buffer to at least size bytes, keeping the first kept ones. */
enum spec_status spec_reading_reserve(
	struct spec_buffer *buffer, size_t size, size_t kept, struct spec_error *error);

/* Makes room in decoder->converted for every wanted channel of every line of the block. */
enum spec_status spec_reading_planes(
	struct spec_decoder *decoder, struct spec_error *error);

/* SPEC_ERANGE: so many pixels are more than the reader's limits allow, or fewer than one. */
enum spec_status spec_reading_check_size(const struct spec_reader *reader, long long width,
	long long height, struct spec_error *error);

/* SPEC_ERANGE: so many lines, decoded together, need more memory than the limits allow. */
enum spec_status spec_reading_check_memory(
	const struct spec_reader *reader, struct spec_error *error);

#endif
