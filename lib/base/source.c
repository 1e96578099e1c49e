#include "base/source.h"

#include <errno.h>
#include <fcntl.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

#include "base/memory.h"
#include "base/output.h"

#define PIPE_BYTES (1 << 20)
#define SKIP_BYTES (1 << 16)

enum spec_status
spec_source_open(struct spec_source *source, const char *path, size_t head_limit,
	struct spec_error *error)
{
	int standard = strcmp(path, "-") == 0;
	const char *name = standard ? "<stdin>" : path;
	struct stat status;

	*source = (struct spec_source){.fd = -1, .size = -1, .head_limit = head_limit};
	source->name = spec_memory_text(name, strlen(name), error);
	if (!source->name)
		return SPEC_ENOMEM;
	source->fd = standard ? STDIN_FILENO : open(path, O_RDONLY | O_CLOEXEC);
	if (source->fd < 0 || fstat(source->fd, &status) < 0) {
		spec_error_system(error, errno, "unable to open '%s'", name);
		spec_source_close(source);
		return SPEC_EIO;
	}
	if (S_ISDIR(status.st_mode)) {
		spec_source_close(source);
		return spec_error_set(
			error, SPEC_EIO, "unable to read '%s': is a directory", path);
	}
	if (S_ISREG(status.st_mode)) {
		source->base = standard ? lseek(source->fd, 0, SEEK_CUR) : 0;
		source->seekable = source->base >= 0;
		source->size =
			status.st_size > source->base ? status.st_size - source->base : 0;
		(void)posix_fadvise(source->fd, 0, 0, POSIX_FADV_SEQUENTIAL);
	} else if (S_ISFIFO(status.st_mode)) {
		(void)fcntl(source->fd, F_SETPIPE_SZ, PIPE_BYTES);
	}
	return SPEC_OK;
}

/* tee(2) copies what a pipe holds and leaves it there. */
static size_t
peek_pipe(int fd, void *bytes, size_t size)
{
	int copy[2];
	ssize_t got;

	if (pipe2(copy, O_CLOEXEC) < 0)
		return 0;
	do {
		got = tee(fd, copy[1], size, 0);
	} while (got < 0 && errno == EINTR);
	if (got > 0) {
		size = (size_t)got;
		do {
			got = read(copy[0], bytes, size);
		} while (got < 0 && errno == EINTR);
	}
	close(copy[0]);
	close(copy[1]);
	return got > 0 ? (size_t)got : 0;
}

static ssize_t
peek_file(int fd, void *bytes, size_t size, off_t offset)
{
	ssize_t got;

	do {
		got = pread(fd, bytes, size, offset);
	} while (got < 0 && errno == EINTR);
	return got;
}

size_t
spec_source_peek(const char *path, void *bytes, size_t size)
{
	int standard = strcmp(path, "-") == 0;
	int shared = standard || strncmp(path, "/dev/", 5) == 0 ||
		     strncmp(path, "/proc/self/fd/", 14) == 0;
	struct stat status;
	ssize_t got = 0;
	int fd;

	/* A named FIFO that is opened and closed again loses its writer. */
	if (!shared && (stat(path, &status) < 0 || !S_ISREG(status.st_mode)))
		return 0;
	fd = standard ? STDIN_FILENO : open(path, O_RDONLY | O_CLOEXEC);
	if (fd >= 0 && fstat(fd, &status) == 0) {
		if (S_ISREG(status.st_mode))
			got = peek_file(
				fd, bytes, size, standard ? lseek(fd, 0, SEEK_CUR) : 0);
		else if (S_ISFIFO(status.st_mode))
			got = (ssize_t)peek_pipe(fd, bytes, size);
	}
	if (fd > STDIN_FILENO)
		close(fd);
	return got > 0 ? (size_t)got : 0;
}

void
spec_source_close(struct spec_source *source)
{
	if (source->fd > STDIN_FILENO)
		(void)close(source->fd);
	free(source->name);
	free(source->head);
	*source = (struct spec_source){.fd = -1};
}

static enum spec_status
read_failed(const struct spec_source *source, struct spec_error *error)
{
	return spec_error_system(error, errno, "unable to read '%s'", source->name);
}

/* Reads size bytes unless the end comes first. offset < 0: at the descriptor's own place. */
static enum spec_status
read_fully(struct spec_source *source, void *data, size_t size, int64_t offset, size_t *got,
	struct spec_error *error)
{
	char *byte = data;

	*got = 0;
	while (*got < size) {
		ssize_t taken = offset < 0 ? read(source->fd, byte + *got, size - *got)
					   : pread(source->fd, byte + *got, size - *got,
						     offset + *got);

		if (taken < 0 && errno == EINTR)
			continue;
		if (taken < 0)
			return read_failed(source, error);
		if (taken == 0)
			break;
		*got += taken;
	}
	return SPEC_OK;
}

/* Takes bytes from the stream into the head until it holds wanted bytes or the stream ends. */
static enum spec_status
extend_head(struct spec_source *source, size_t wanted, struct spec_error *error)
{
	void *head = source->head;
	enum spec_status status;
	size_t got;

	if (wanted <= source->head_size)
		return SPEC_OK;
	status = spec_memory_grow(
		&head, &source->head_room, wanted, 1, "bytes of the header", error);
	if (status != SPEC_OK)
		return status;
	source->head = head;
	status = read_fully(source, source->head + source->head_size,
		wanted - source->head_size, -1, &got, error);
	source->head_size += got;
	source->position += got;
	return status;
}

static enum spec_status
skip(struct spec_source *source, int64_t count, struct spec_error *error)
{
	char waste[SKIP_BYTES];
	enum spec_status status = SPEC_OK;

	while (count > 0 && status == SPEC_OK) {
		size_t size = count < SKIP_BYTES ? (size_t)count : SKIP_BYTES, got;

		status = read_fully(source, waste, size, -1, &got, error);
		source->position += got;
		if (got < size)
			break;
		count -= size;
	}
	return status;
}

static enum spec_status
read_stream(struct spec_source *source, void *data, size_t size, int64_t offset,
	size_t *got, struct spec_error *error)
{
	enum spec_status status = SPEC_OK;
	size_t taken;

	*got = 0;
	if (!source->sealed)
		status = extend_head(source, offset + size, error);
	if (status == SPEC_OK && offset < (int64_t)source->head_size) {
		*got = source->head_size - offset < size ? source->head_size - offset
							 : size;
		memcpy(data, source->head + offset, *got);
	}
	if (status != SPEC_OK || *got == size || !source->sealed)
		return status;
	offset += *got;
	free(source->head); /* a stream only goes on from here */
	source->head = NULL;
	source->head_size = source->head_room = 0;
	if (offset < source->position)
		return spec_error_set(error, SPEC_EFORMAT,
			"%s: its parts are not in the order of the lines", source->name);
	status = skip(source, offset - source->position, error);
	if (status != SPEC_OK || source->position < offset)
		return status;
	status = read_fully(source, (char *)data + *got, size - *got, -1, &taken, error);
	source->position += taken;
	*got += taken;
	return status;
}

enum spec_status
spec_source_read(struct spec_source *source, void *data, size_t size, int64_t offset,
	size_t *got, struct spec_error *error)
{
	*got = 0;
	if (offset < 0 || offset > INT64_MAX / 2 || size > INT64_MAX / 2)
		return spec_error_set(error, SPEC_EFORMAT,
			"%s: an offset lies outside the file", source->name);
	if (!source->sealed && (size_t)offset >= source->head_limit)
		return spec_error_set(error, SPEC_ERANGE,
			"%s: the header is longer than the limit of %zu bytes (--limit header=BYTES)",
			source->name, source->head_limit);
	/* Readers look ahead: what lies beyond the limit is refused when it is needed. */
	if (!source->sealed && size > source->head_limit - (size_t)offset)
		size = source->head_limit - (size_t)offset;
	return source->seekable
		       ? read_fully(source, data, size, source->base + offset, got, error)
		       : read_stream(source, data, size, offset, got, error);
}

void
spec_source_seal(struct spec_source *source)
{
	source->sealed = 1;
}

enum spec_status
spec_source_drain(struct spec_source *source, struct spec_error *error)
{
	return source->seekable ? SPEC_OK : skip(source, INT64_MAX, error);
}

static enum spec_status
copy_rest(struct spec_source *source, struct spec_output *scratch, struct spec_error *error)
{
	enum spec_status status =
		spec_output_write(scratch, source->head, source->head_size, error);
	char *buffer = spec_memory_new(PIPE_BYTES, 1, "bytes", error);
	size_t got = 1;

	if (!buffer)
		return SPEC_ENOMEM;
	while (status == SPEC_OK && got > 0) {
		status = read_fully(source, buffer, PIPE_BYTES, -1, &got, error);
		if (status == SPEC_OK)
			status = spec_output_write(scratch, buffer, got, error);
	}
	free(buffer);
	return status;
}

enum spec_status
spec_source_spool(struct spec_source *source, struct spec_error *error)
{
	struct spec_output scratch = {.path = (char[]){"a temporary file"}};
	enum spec_status status;

	status = spec_output_scratch(&scratch.fd, error);
	if (status != SPEC_OK)
		return status;
	status = copy_rest(source, &scratch, error);
	if (status != SPEC_OK) {
		close(scratch.fd);
		return status;
	}
	if (source->fd > STDIN_FILENO)
		(void)close(source->fd);
	source->fd = scratch.fd;
	source->seekable = 1;
	source->base = 0;
	source->size = scratch.position;
	free(source->head);
	source->head = NULL;
	source->head_size = source->head_room = 0;
	return SPEC_OK;
}
