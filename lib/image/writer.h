/*
 * Writing a spectral image. Lines may come from several workers in any order near each
 * other; chunks of them are encoded side by side and written in order. OpenEXR: scanlines,
 * one part, increasing line order; to a pipe, an uncompressed image streams, a compressed
 * one is written when it is complete.
 */
#ifndef SPEC_IMAGE_WRITER_H
#define SPEC_IMAGE_WRITER_H

#include "base/error.h"
#include "base/output.h"
#include "image/image.h"
#include "image/settings.h"

struct spec_writer;
struct spec_writing_format;

/*
 * The format to write to path ("-": standard output): that of name, or, where name is
 * null, that of the suffix of path; OpenEXR where there is none, or below /dev another one.
 * Errors (SPEC_EUSAGE): no format of that name or suffix.
 */
enum spec_status spec_writer_choose(const char *path, const char *name,
	const struct spec_writing_format **format, struct spec_error *error);

/* Whether a suffix with its dot, such as ".hdr", is one of a format's. */
int spec_writer_knows_suffix(const char *suffix);

/* SPEC_EUSAGE: the settings ask for what the format does not have: HALF, a compression. */
enum spec_status spec_writer_check_settings(const struct spec_writing_format *format,
	const struct spec_settings *settings, struct spec_error *error);

/* Whether the format makes its files itself, so that no output is to be opened for it. */
int spec_writer_makes_files(const struct spec_writing_format *format);

/*
 * Writes the header. The image must be indexed and live as long as the writer;
 * its channels go out under their names, as the samples they say. The output
 * must live as long, too; committing or abandoning it stays the caller's.
 * compression: OpenEXR's number, or -1: none to a stream, zip to a file.
 * Errors: the output is a terminal, more channels than OpenEXR can write.
 */
enum spec_status spec_writer_open(struct spec_writer **writer,
	const struct spec_image *image, struct spec_output *output, int compression,
	struct spec_error *error);

/*
 * The same in any format. output: null where the format makes its files itself, at path.
 * compression: OpenEXR's alone.
 * Errors: also what the format cannot hold.
 */
enum spec_status spec_writer_open_as(struct spec_writer **writer,
	const struct spec_writing_format *format, const struct spec_image *image,
	struct spec_output *output, const char *path, int compression,
	struct spec_error *error);

/* Ends the file. Error: lines are missing. */
enum spec_status spec_writer_finish(struct spec_writer *writer, struct spec_error *error);

/* After the output has been committed: gives files beside it their names. */
enum spec_status spec_writer_commit(struct spec_writer *writer, struct spec_error *error);
void spec_writer_close(struct spec_writer *writer);

/* Lines that are encoded together, and bytes of one before that. */
int spec_writer_chunk_lines(const struct spec_writer *writer);
size_t spec_writer_line_bytes(const struct spec_writer *writer);

/* Finite samples that became infinite as HALF, once all packers are closed. */
unsigned long long spec_writer_overflows(const struct spec_writer *writer);

/* Stops workers that wait for their turn to write. */
void spec_writer_stop(struct spec_writer *writer, const struct spec_error *error);

/* One worker's place to write lines from. */
struct spec_packer;

enum spec_status spec_packer_open(
	struct spec_packer **packer, struct spec_writer *writer, struct spec_error *error);
/* Before the writer is closed. */
void spec_packer_close(struct spec_packer *packer);

/*
 * Where line y's samples go: one plane per channel, floats (UINT: 32 bits). The
 * planes hold until spec_packer_end for the same line.
 */
enum spec_status spec_packer_begin(
	struct spec_packer *packer, int y, float *const **plane, struct spec_error *error);

/*
 * The line is complete. Where it completes its chunk, the chunk is encoded, and
 * the call returns when it has been written, after all before it.
 */
enum spec_status spec_packer_end(
	struct spec_packer *packer, int y, struct spec_error *error);

#endif
