#include "image/stream.h"

#include <pthread.h>
#include <stdlib.h>

#include "base/memory.h"
#include "base/parallel.h"

#define BLOCK_BYTES                                                                        \
	(1 << 20)      /* small enough for the cache, large enough to be worth a turn */
#define MOST_CHUNKS 4  /* in a block, to make whole lines of the output */
#define MOST_LINES 256 /* in a block, to hold whole chunks of every input */
#define BLOCK_COPIES 4 /* packed, unpacked, scratch, and the output's */

struct run {
	struct spec_stream *stream;
	const struct spec_settings *settings;
	int threads;
	int block_lines; /* of the output */
	int blocks;
	pthread_mutex_t take; /* held while readers that do not share are read */
	int next_block;       /* guarded by take */
	struct spec_turnstile turnstile;
};

static int
at_most(long long a, long long b)
{
	return (int)(a < b ? a : b);
}

/* The least of a and b, both >= 1. */
static long long
common_multiple(long long a, long long b)
{
	long long divisor = a, rest = b;

	do { /* Euclid */
		long long next = divisor % rest;

		divisor = rest;
		rest = next;
	} while (rest != 0);
	return a / divisor * b;
}

/*
 * Lines that hold whole chunks of every input; where heights of tiles go badly into each
 * other, of the largest alone.
 */
static long long
common_chunk(const struct spec_stream *stream)
{
	long long chunk = 1, largest = 1;

	for (int i = 0; i < stream->readers; i++) {
		int lines = spec_reader_chunk_lines(stream->reader[i]);

		largest = lines > largest ? lines : largest;
		if (chunk <= MOST_LINES)
			chunk = common_multiple(chunk, lines);
	}
	return chunk <= MOST_LINES ? chunk : largest;
}

/*
 * How many lines of the output make a block: whole chunks of the input, so that no
 * chunk is decoded twice, or, where lines_in goes badly into them, a few chunks, so
 * that few are.
 */
static int
choose_block(const struct spec_stream *stream)
{
	long long chunk = common_chunk(stream), lines;
	size_t bytes = 1;

	if (stream->readers == 0)
		return at_most(spec_writer_chunk_lines(stream->writer), stream->lines);
	for (int i = 0; i < stream->readers; i++)
		bytes += spec_reader_line_bytes(stream->reader[i]);
	lines = common_multiple(chunk, stream->lines_in);
	if (lines > MOST_CHUNKS * chunk)
		lines = chunk > stream->lines_in ? MOST_CHUNKS * chunk : stream->lines_in;
	while (lines < (1 << 20) && (size_t)lines * 2 * bytes <= BLOCK_BYTES)
		lines *= 2;
	lines /= stream->lines_in;
	return at_most(lines < 1 ? 1 : lines, stream->lines);
}

/* The first block ends where a chunk of the input ends, so that all others begin with one. */
static int
lead_lines(const struct run *run)
{
	const struct spec_stream *stream = run->stream;
	int chunk, into;

	if (stream->readers == 0)
		return 0;
	chunk = spec_reader_chunk_lines(stream->reader[0]);
	into = (stream->first_line - spec_reader_image(stream->reader[0])->data.y0) % chunk;
	return into / stream->lines_in % run->block_lines;
}

static void
block_range(const struct run *run, int block, int *first, int *end)
{
	long long lead = lead_lines(run);

	*first = block == 0 ? 0 : (int)((long long)block * run->block_lines - lead);
	*end = at_most((block + 1LL) * run->block_lines - lead, run->stream->lines);
}

static enum spec_status
open_worker(struct run *run, struct spec_stream_worker *worker, struct spec_error *error)
{
	struct spec_stream *stream = run->stream;
	enum spec_status status = SPEC_OK;

	for (int i = 0; i < stream->readers && status == SPEC_OK; i++)
		status = spec_decoder_open(
			&worker->decoder[i], stream->reader[i], stream->wanted[i], error);
	if (status == SPEC_OK && stream->writer)
		status = spec_packer_open(&worker->packer, stream->writer, error);
	if (status == SPEC_OK && stream->scratch_bytes > 0) {
		worker->scratch =
			spec_memory_aligned(stream->scratch_bytes, 1, "bytes", error);
		status = worker->scratch ? SPEC_OK : SPEC_ENOMEM;
	}
	return status;
}

static void
close_worker(struct spec_stream_worker *worker)
{
	for (int i = 0; i < SPEC_STREAM_READERS; i++)
		spec_decoder_close(worker->decoder[i]);
	spec_packer_close(worker->packer);
	free(worker->scratch);
}

/* Fetches a block of the readers that share, or of the others. */
static enum spec_status
fetch_block(struct run *run, struct spec_stream_worker *worker, int block, int shared,
	struct spec_error *error)
{
	struct spec_stream *stream = run->stream;
	enum spec_status status = SPEC_OK;
	int first, end;

	block_range(run, block, &first, &end);
	for (int i = 0; i < stream->readers && status == SPEC_OK; i++)
		if (spec_reader_shares(stream->reader[i]) == shared)
			status = spec_decoder_fetch(worker->decoder[i],
				stream->first_line + first * stream->lines_in,
				stream->first_line + end * stream->lines_in, error);
	return status;
}

/* Takes the next block from the readers: *block, or -1 at the end. */
static enum spec_status
take_block(struct run *run, struct spec_stream_worker *worker, int *block,
	struct spec_error *error)
{
	enum spec_status status = SPEC_OK;

	pthread_mutex_lock(&run->take);
	*block = run->next_block < run->blocks ? run->next_block++ : -1;
	if (*block >= 0)
		status = fetch_block(run, worker, *block, 0, error);
	if (status != SPEC_OK)
		run->next_block = run->blocks; /* a pipe cannot go on after this */
	pthread_mutex_unlock(&run->take);
	if (*block >= 0 && status == SPEC_OK)
		status = fetch_block(run, worker, *block, 1, error);
	return status;
}

static enum spec_status
work_block(struct run *run, struct spec_stream_worker *worker, unsigned char *payload,
	int block, struct spec_error *error)
{
	struct spec_stream *stream = run->stream;
	enum spec_status status = SPEC_OK;
	int first, end;

	block_range(run, block, &first, &end);
	for (int i = 0; i < stream->readers && status == SPEC_OK; i++)
		status = spec_decoder_decode(worker->decoder[i], error);
	for (int line = first; line < end && status == SPEC_OK; line++) {
		worker->payload =
			payload ? payload + (line - first) * stream->payload_bytes : NULL;
		status = stream->kernel(stream->state, worker, line, error);
	}
	if (status != SPEC_OK)
		return status;
	if (!spec_turnstile_enter(&run->turnstile, block))
		return spec_turnstile_status(&run->turnstile, error);
	if (stream->deliver)
		status = stream->deliver(stream->state, payload, first, end - first, error);
	if (status == SPEC_OK && run->settings->show)
		run->settings->show(run->settings->show_state, end, stream->lines);
	if (status == SPEC_OK)
		spec_turnstile_leave(&run->turnstile);
	return status;
}

/* Takes and does blocks until none is left; *block: the last one taken, or -1. */
static enum spec_status
work_all(struct run *run, struct spec_stream_worker *worker, int *block,
	struct spec_error *error)
{
	size_t size = run->stream->payload_bytes * run->block_lines;
	enum spec_status status = open_worker(run, worker, error);
	unsigned char *payload = NULL;

	*block = -1;
	if (status == SPEC_OK && size > 0) {
		payload = spec_memory_aligned(size, 1, "bytes", error);
		status = payload ? SPEC_OK : SPEC_ENOMEM;
	}
	while (status == SPEC_OK) {
		status = take_block(run, worker, block, error);
		if (status != SPEC_OK || *block < 0)
			break;
		status = work_block(run, worker, payload, *block, error);
	}
	free(payload);
	return status;
}

static void
work(void *argument, int number)
{
	struct run *run = argument;
	struct spec_stream_worker worker = {.number = number};
	struct spec_error error = {0};
	int block;

	if (work_all(run, &worker, &block, &error) != SPEC_OK) {
		pthread_mutex_lock(&run->take);
		run->next_block = run->blocks;
		pthread_mutex_unlock(&run->take);
		/* Blocks before this one end first: the same error for any number of threads. */
		if (block >= 0)
			(void)spec_turnstile_enter(&run->turnstile, block);
		spec_turnstile_stop(&run->turnstile, &error);
		if (run->stream->writer)
			spec_writer_stop(run->stream->writer, &error);
	}
	close_worker(&worker);
}

/* Fewer threads rather than more memory than allowed; one must fit. */
static enum spec_status
fit_memory(struct run *run, struct spec_error *error)
{
	const struct spec_stream *stream = run->stream;
	const struct spec_settings *settings = run->settings;
	long long lines = (long long)run->block_lines * stream->lines_in, each = 0;
	long long limit = settings->limits.memory;

	for (int i = 0; i < stream->readers; i++)
		each += lines * (long long)spec_reader_line_bytes(stream->reader[i]) *
			BLOCK_COPIES;
	each += (long long)stream->payload_bytes * run->block_lines;
	each += (long long)stream->scratch_bytes;
	if (stream->readers == 0)
		each += (long long)spec_writer_line_bytes(stream->writer) *
			spec_writer_chunk_lines(stream->writer);
	if (each > limit)
		return spec_error_set(error, SPEC_ERANGE,
			"%s: %lld lines at a time need %lld bytes, more than the limit of "
			"%lld (--limit memory=BYTES)",
			stream->readers > 0 ? spec_reader_name(stream->reader[0])
					    : settings->output,
			lines, each, limit);
	while (run->threads > 1 && each * run->threads > limit)
		run->threads--;
	return SPEC_OK;
}

enum spec_status
spec_stream_run(struct spec_stream *stream, const struct spec_settings *settings,
	struct spec_error *error)
{
	struct run run = {
		.stream = stream, .settings = settings, .threads = settings->threads};
	enum spec_status status, worked;

	if (stream->lines < 1)
		return SPEC_OK;
	run.block_lines = choose_block(stream);
	run.blocks =
		(int)(((long long)stream->lines + lead_lines(&run) + run.block_lines - 1) /
			run.block_lines);
	status = fit_memory(&run, error);
	if (status != SPEC_OK)
		return status;
	if (run.threads > run.blocks)
		run.threads = run.blocks;
	pthread_mutex_init(&run.take, NULL);
	spec_turnstile_init(&run.turnstile);
	status = spec_parallel_run(run.threads, work, &run, error);
	worked = spec_turnstile_status(&run.turnstile, status == SPEC_OK ? error : NULL);
	spec_turnstile_destroy(&run.turnstile);
	pthread_mutex_destroy(&run.take);
	if (status == SPEC_OK)
		status = worked;
	for (int i = 0; i < stream->readers && status == SPEC_OK; i++)
		status = spec_reader_drain(stream->reader[i], error);
	return status;
}

unsigned char *
spec_stream_take(struct spec_stream *stream, struct spec_reader *reader,
	const size_t *channel, size_t channels, struct spec_error *error)
{
	const struct spec_image *image = spec_reader_image(reader);
	unsigned char *wanted = spec_memory_new(image->channels, 1, "channels", error);

	stream->reader[0] = reader;
	stream->wanted[0] = wanted;
	stream->readers = 1;
	stream->first_line = image->data.y0;
	stream->lines = (int)spec_window_height(&image->data);
	stream->lines_in = 1;
	for (size_t i = 0; wanted && i < channels; i++)
		wanted[channel[i]] = 1;
	return wanted;
}
