/*
 * Output that appears whole or not at all. A named regular file is written
 * beside its place without a name (or with a temporary one) and takes its name
 * when it is committed; anything else (a device, a FIFO, standard output) is
 * written in place.
 */
#ifndef SPEC_BASE_OUTPUT_H
#define SPEC_BASE_OUTPUT_H

#include <stddef.h>
#include <stdint.h>

#include "base/error.h"

struct spec_output {
	int fd;
	char *path;      /* as the user wrote it; "<stdout>" for "-" */
	char *target;    /* what commit renames onto, or null: written in place */
	char *temporary; /* the temporary name, or null while it has none */
	int standard;    /* it is standard output */
	int seekable;    /* a regular file at its beginning: may be written out of order */
	int terminal;
	int64_t position; /* where spec_output_write goes on */
};

/* path "-" is standard output. Errors: the file cannot be made. */
enum spec_status spec_output_open(
	struct spec_output *output, const char *path, struct spec_error *error);

/* Writes all the bytes at the current position. */
enum spec_status spec_output_write(struct spec_output *output, const void *data,
	size_t size, struct spec_error *error);

/* Writes all the bytes at an offset; only where output->seekable. */
enum spec_status spec_output_write_at(struct spec_output *output, const void *data,
	size_t size, int64_t offset, struct spec_error *error);

/*
 * Closes, checked, and gives the file its name. On failure nothing is left
 * behind. Either way the output is finished with.
 */
enum spec_status spec_output_commit(struct spec_output *output, struct spec_error *error);

/*
 * Commits several named files together: all of them have their new content afterwards, or,
 * after an error, all their old one, as far as renaming back goes. All are finished with.
 */
enum spec_status spec_output_commit_all(
	struct spec_output *const *output, size_t count, struct spec_error *error);

/* Drops what was written, as far as that can be done. Harmless after commit. */
void spec_output_abandon(struct spec_output *output);

/* Opens, writes and commits: a whole output at once. */
enum spec_status spec_output_save(
	const char *path, const void *data, size_t size, struct spec_error *error);

/* Writes what the file of that descriptor holds, from its beginning to its end. */
enum spec_status spec_output_append(
	struct spec_output *output, int fd, struct spec_error *error);

/* A nameless temporary file in TMPDIR, else /tmp: its descriptor in *fd. */
enum spec_status spec_output_scratch(int *fd, struct spec_error *error);

/* Reads back all the bytes at an offset of one; from any thread. */
enum spec_status spec_output_read(
	int fd, void *data, size_t size, int64_t offset, struct spec_error *error);

#endif
