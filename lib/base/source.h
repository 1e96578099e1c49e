/*
 * Input that can be read at an offset. A regular file can be read anywhere; a
 * pipe only forward, except for its beginning, which is kept until it is sealed.
 */
#ifndef SPEC_BASE_SOURCE_H
#define SPEC_BASE_SOURCE_H

#include <stddef.h>
#include <stdint.h>

#include "base/error.h"

struct spec_source {
	int fd;
	char *name; /* as the user wrote it; "<stdin>" for "-" */
	int seekable;
	int64_t size;     /* bytes, or -1 where it is not known */
	int64_t base;     /* where the data begin in the file */
	int64_t position; /* of a stream: bytes taken from it */
	unsigned char *head;
	size_t head_size, head_room;
	size_t head_limit; /* bytes of the head that may be read before it is sealed */
	int sealed;
};

/* path "-" is standard input. A directory is an error. */
enum spec_status spec_source_open(struct spec_source *source, const char *path,
	size_t head_limit, struct spec_error *error);

/*
 * The first bytes, up to size, of a file, or of a pipe that is standard input or another
 * open descriptor (/dev/fd/N); they are left there for the next reader. Returns how many
 * there are: of a pipe those that have been written, but one at least, and it waits for
 * that; 0 where it cannot be told: nothing there, or a named FIFO, which a second opening
 * would upset.
 */
size_t spec_source_peek(const char *path, void *bytes, size_t size);

void spec_source_close(struct spec_source *source);

/*
 * Reads up to size bytes at the offset; *got < size only at the end. From a stream, offsets
 * below what was taken are served from the head; beyond it the stream is read forward,
 * skipping what is between. Before sealing, a read ends at head_limit. Not safe for two
 * threads at once on a stream. Errors: the system's, a read that begins at head_limit or
 * beyond before sealing (SPEC_ERANGE), going back in a stream.
 */
enum spec_status spec_source_read(struct spec_source *source, void *data, size_t size,
	int64_t offset, size_t *got, struct spec_error *error);

/* From now on a stream only moves forward; its head is freed once it is passed. */
void spec_source_seal(struct spec_source *source);

/*
 * Reads a stream to its end and drops it, so that who writes it is not killed by
 * SIGPIPE for having more to say than was needed. Does nothing to a file.
 */
enum spec_status spec_source_drain(struct spec_source *source, struct spec_error *error);

/*
 * Copies what remains of a stream, head and all, to a scratch file
 * and reads that from now on.
 */
enum spec_status spec_source_spool(struct spec_source *source, struct spec_error *error);

#endif
