/*
 * Reading an image by blocks of scanlines: from a file at any place, from a pipe forward
 * only. Of OpenEXR scanlines and tiles, every compression but DWA, one part of several.
 */
#ifndef SPEC_IMAGE_READER_H
#define SPEC_IMAGE_READER_H

#include "base/error.h"
#include "image/image.h"
#include "image/settings.h"

struct spec_reader;

/*
 * path "-" is standard input; a folder is one of pictures of one band each, as
 * spec_reader_open_list has them, in the order of their names. With several parts,
 * settings->part names one by number or name; without it the only part that has bands is
 * taken, and where several have, that is an error that lists them. The image comes indexed.
 */
enum spec_status spec_reader_open(struct spec_reader **reader, const char *path,
	const struct spec_settings *settings, struct spec_error *error);

/*
 * The same of a list of pictures of one band each, in the order of settings->wavelengths or
 * with their wavelengths in their names, as 550nm.png.
 */
enum spec_status spec_reader_open_list(struct spec_reader **reader, const char *const *path,
	size_t count, const struct spec_settings *settings, struct spec_error *error);

/*
 * As spec_reader_open, for who wants to know what is wrong: names and attributes that
 * specexr(5) forbids are no error. *refused is what spec_reader_open would have said of
 * them, or has the status SPEC_OK; where it has not, the image has channels, attributes and
 * samples, but no bands. Coefficients stay what they are.
 */
enum spec_status spec_reader_open_lenient(struct spec_reader **reader, const char *path,
	const struct spec_settings *settings, struct spec_error *refused,
	struct spec_error *error);

/* Whether what is at the path, or on standard input, begins as an image that is read here. */
int spec_reader_recognises(const char *path);

void spec_reader_close(struct spec_reader *reader);

/* After the last line that was wanted: lets a pipe's writer finish. */
enum spec_status spec_reader_drain(struct spec_reader *reader, struct spec_error *error);

const struct spec_image *spec_reader_image(const struct spec_reader *reader);

/* The same image, to set attributes of before it is used; nothing else of it may change. */
struct spec_image *spec_reader_header(struct spec_reader *reader);
const char *spec_reader_name(const struct spec_reader *reader);

/* The format's name, such as "OpenEXR". */
const char *spec_reader_format(const struct spec_reader *reader);

/* How the file keeps its pixels. */
struct spec_storage {
	int parts, part;             /* how many there are, and which was read, from 0 */
	int tile_width, tile_height; /* 0, 0: scanlines */
	int increasing;              /* its lines are in increasing order */
};

struct spec_storage spec_reader_storage(const struct spec_reader *reader);

/* The text of spec:representation where what is read stands for something else, or "". */
const char *spec_reader_representation(const struct spec_reader *reader);

/* Lines that are stored, and so decoded, together: 1, 16, 32, or a tile's height. */
int spec_reader_chunk_lines(const struct spec_reader *reader);

/* Bytes of one line as it is stored uncompressed. */
size_t spec_reader_line_bytes(const struct spec_reader *reader);

/*
 * Whether decoders may fetch side by side and in any order, as from a file in which one can
 * go to any place. It stays so while the reader is open.
 */
int spec_reader_shares(const struct spec_reader *reader);

/* One worker's place to decode a block of lines into. */
struct spec_decoder;

/* wanted: one flag per channel of the image, or null for all. */
enum spec_status spec_decoder_open(struct spec_decoder **decoder,
	struct spec_reader *reader, const unsigned char *wanted, struct spec_error *error);
void spec_decoder_close(struct spec_decoder *decoder);

/*
 * Takes what lines y0..y1-1 (of the data window) need from the file. Where the reader does
 * not share, calls must not overlap in time, and go forward: y0 not before the last call's
 * y1 - lines that share a chunk with it may be asked for again by another decoder.
 */
enum spec_status spec_decoder_fetch(
	struct spec_decoder *decoder, int y0, int y1, struct spec_error *error);

/* Decodes what was fetched. Decoders work side by side. */
enum spec_status spec_decoder_decode(
	struct spec_decoder *decoder, struct spec_error *error);

/* Both, for line y alone. */
enum spec_status spec_decoder_read(
	struct spec_decoder *decoder, int y, struct spec_error *error);

/*
 * The samples of a wanted channel in a fetched line: HALF converted to float, a
 * UINT's number if it is a band, its 32 bits if it is not. Valid until the next fetch.
 */
const float *spec_decoder_row(const struct spec_decoder *decoder, int y, size_t channel);

#endif
