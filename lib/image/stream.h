/*
 * The row stream: readers, a kernel, and what the kernel makes. Blocks of lines
 * are taken from the readers in order, decoded and worked on by several threads,
 * and delivered in order, so that memory does not grow with the image's height
 * and results do not depend on the number of threads.
 */
#ifndef SPEC_IMAGE_STREAM_H
#define SPEC_IMAGE_STREAM_H

#include "base/error.h"
#include "image/reader.h"
#include "image/writer.h"

#define SPEC_STREAM_READERS 65 /* 64 images and a mask */

/* What the kernel sees of a worker. */
struct spec_stream_worker {
	int number;
	struct spec_decoder *decoder[SPEC_STREAM_READERS];
	struct spec_packer *packer; /* where the stream has a writer */
	unsigned char *payload;     /* the current line's, where lines are delivered */
	void *scratch;              /* scratch_bytes of it, the worker's own */
};

struct spec_stream {
	struct spec_reader *reader[SPEC_STREAM_READERS];
	const unsigned char *wanted[SPEC_STREAM_READERS]; /* as spec_decoder_open's */
	int readers; /* 0: the kernel makes lines of nothing, and there is a writer */
	struct spec_writer *writer; /* or null */
	int first_line;             /* of the input that line 0 of the output needs */
	int lines;                  /* of the output */
	int lines_in;               /* of the input for each line of the output: 1, or N */
	size_t payload_bytes;       /* per line of the output, delivered in order; or 0 */
	size_t scratch_bytes;

	void *state;
	/*
	 * Makes line 0..lines-1 of the output from lines_in lines of the input, the
	 * first of which is first_line + line * lines_in. Pure: any order, any thread.
	 */
	enum spec_status (*kernel)(void *state, struct spec_stream_worker *worker, int line,
		struct spec_error *error);
	/* Called with the payloads of successive lines, in order, never twice at once. */
	enum spec_status (*deliver)(void *state, const unsigned char *payload, int line,
		int count, struct spec_error *error);
};

/*
 * Runs to the end or to the first error, with the settings' threads (fewer where
 * the memory limit allows no more) and the settings' display of progress.
 */
enum spec_status spec_stream_run(struct spec_stream *stream,
	const struct spec_settings *settings, struct spec_error *error);

/*
 * Lets a stream, whose other fields are set, take each line of a reader's image for one of the
 * output, and of its channels those of a list (one may stand there twice). Returns what
 * stream->wanted then refers to, to be freed after the run; null: no memory.
 */
unsigned char *spec_stream_take(struct spec_stream *stream, struct spec_reader *reader,
	const size_t *channel, size_t channels, struct spec_error *error);

#endif
