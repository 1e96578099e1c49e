#include "base/output.h"

#include <errno.h>
#include <fcntl.h>
#include <limits.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

#include "base/memory.h"

#define MOST_LINKS 40        /* as the kernel has it */
#define PIPE_BYTES (1 << 20) /* a larger pipe halves the number of switches */

static void
clear(struct spec_output *output)
{
	free(output->path);
	free(output->target);
	free(output->temporary);
	*output = (struct spec_output){.fd = -1};
}

static enum spec_status
open_standard(struct spec_output *output, struct spec_error *error)
{
	struct stat status;
	int flags = fcntl(STDOUT_FILENO, F_GETFL);

	output->fd = STDOUT_FILENO;
	output->standard = 1;
	if (flags < 0 || fstat(STDOUT_FILENO, &status) < 0)
		return spec_error_system(error, errno, "unable to use standard output");
	output->seekable = S_ISREG(status.st_mode) && !(flags & O_APPEND) &&
			   lseek(STDOUT_FILENO, 0, SEEK_CUR) == 0;
	output->terminal = isatty(STDOUT_FILENO);
	if (S_ISFIFO(status.st_mode))
		(void)fcntl(STDOUT_FILENO, F_SETPIPE_SZ, PIPE_BYTES);
	return SPEC_OK;
}

/* The folder a path lies in, with its slash; "./" for a bare name. */
static char *
folder_of(const char *path, struct spec_error *error)
{
	const char *slash = strrchr(path, '/');

	return slash ? spec_memory_text(path, slash - path + 1, error)
		     : spec_memory_text("./", 2, error);
}

/* A new temporary name beside target; the file is made only where fd is to be opened. */
static char *
temporary_name(const char *target, struct spec_error *error)
{
	size_t size = strlen(target) + 16;
	char *name = spec_memory_new(size, 1, "bytes of a file name", error);

	if (name)
		snprintf(name, size, "%s.XXXXXX", target);
	return name;
}

static enum spec_status
open_beside(struct spec_output *output, mode_t mode, struct spec_error *error)
{
	char *folder = folder_of(output->target, error);

	if (!folder)
		return SPEC_ENOMEM;
	/* A file without a name cannot be left behind, not even by SIGKILL. */
	output->fd = open(folder, O_TMPFILE | O_WRONLY | O_CLOEXEC, mode);
	free(folder);
	if (output->fd < 0) {
		output->temporary = temporary_name(output->target, error);
		if (!output->temporary)
			return SPEC_ENOMEM;
		output->fd = mkostemp(output->temporary, O_CLOEXEC);
		if (output->fd < 0) {
			int failure = errno;

			free(output->temporary);
			output->temporary = NULL;
			return spec_error_system(
				error, failure, "unable to create '%s'", output->path);
		}
	}
	(void)fchmod(
		output->fd, mode); /* the umask has taken bits of a mode that is kept */
	output->seekable = 1;
	return SPEC_OK;
}

/* The link's text as a path: beside the link, where it is relative. */
static char *
follow(const char *link, struct spec_error *error)
{
	char text[PATH_MAX], *path, *folder;
	ssize_t length = readlink(link, text, sizeof text - 1);

	if (length < 0) {
		spec_error_system(error, errno, "unable to read '%s'", link);
		return NULL;
	}
	text[length] = '\0';
	folder = text[0] == '/' ? spec_memory_text("", 0, error) : folder_of(link, error);
	if (!folder)
		return NULL;
	path = spec_memory_new(
		strlen(folder) + (size_t)length + 1, 1, "bytes of a path", error);
	if (path)
		sprintf(path, "%s%s", folder, text);
	free(folder);
	return path;
}

/* The target is what the path's symbolic links lead to, there or not. */
static enum spec_status
resolve(struct spec_output *output, struct spec_error *error)
{
	struct stat status;

	output->target = spec_memory_text(output->path, strlen(output->path), error);
	for (int links = 0; output->target && links < MOST_LINKS; links++) {
		char *next;

		if (lstat(output->target, &status) != 0 || !S_ISLNK(status.st_mode))
			return SPEC_OK;
		next = follow(output->target, error);
		free(output->target);
		output->target = next;
	}
	if (!output->target)
		return SPEC_EIO;
	return spec_error_set(
		error, SPEC_EIO, "unable to write '%s': too many links", output->path);
}

/* What lies at path decides: a regular file or nothing is replaced, all else is written to. */
static enum spec_status
open_named(struct spec_output *output, struct spec_error *error)
{
	struct stat status;
	mode_t mask = umask(0);
	enum spec_status resolved;

	umask(mask);
	if (stat(output->path, &status) == 0 && !S_ISREG(status.st_mode)) {
		if (S_ISDIR(status.st_mode))
			return spec_error_set(
				error, SPEC_EIO, "'%s' is a directory", output->path);
		output->fd = open(output->path, O_WRONLY | O_CLOEXEC);
		if (output->fd < 0)
			return spec_error_system(
				error, errno, "unable to open '%s'", output->path);
		output->terminal = isatty(output->fd);
		return SPEC_OK;
	}
	if (access(output->path, W_OK) != 0 && errno != ENOENT)
		return spec_error_system(
			error, errno, "unable to write '%s'", output->path);
	resolved = resolve(output, error);
	if (resolved != SPEC_OK)
		return resolved;
	if (stat(output->target, &status) == 0)
		return open_beside(output, status.st_mode & 0777, error);
	return open_beside(output, 0666 & ~mask, error);
}

enum spec_status
spec_output_open(struct spec_output *output, const char *path, struct spec_error *error)
{
	int standard = strcmp(path, "-") == 0;
	enum spec_status status;

	*output = (struct spec_output){.fd = -1};
	path = standard ? "<stdout>" : path;
	output->path = spec_memory_text(path, strlen(path), error);
	if (!output->path)
		return SPEC_ENOMEM;
	status = standard ? open_standard(output, error) : open_named(output, error);
	if (status != SPEC_OK)
		spec_output_abandon(output);
	return status;
}

static enum spec_status
write_failed(const struct spec_output *output, int failure, struct spec_error *error)
{
	return spec_error_system(error, failure, "unable to write '%s'", output->path);
}

enum spec_status
spec_output_write(
	struct spec_output *output, const void *data, size_t size, struct spec_error *error)
{
	const char *byte = data;

	while (size > 0) {
		ssize_t written = write(output->fd, byte, size);

		if (written < 0 && errno == EINTR)
			continue;
		if (written <= 0)
			return write_failed(output, written < 0 ? errno : ENOSPC, error);
		byte += written;
		size -= written;
		output->position += written;
	}
	return SPEC_OK;
}

enum spec_status
spec_output_write_at(struct spec_output *output, const void *data, size_t size,
	int64_t offset, struct spec_error *error)
{
	const char *byte = data;

	while (size > 0) {
		ssize_t written = pwrite(output->fd, byte, size, offset);

		if (written < 0 && errno == EINTR)
			continue;
		if (written <= 0)
			return write_failed(output, written < 0 ? errno : ENOSPC, error);
		byte += written;
		size -= written;
		offset += written;
	}
	return SPEC_OK;
}

/* Gives a nameless file a temporary name, which rename can then put in its place. */
static enum spec_status
give_name(struct spec_output *output, struct spec_error *error)
{
	char from[64];

	snprintf(from, sizeof from, "/proc/self/fd/%d", output->fd);
	for (int attempt = 0; attempt < 100; attempt++) {
		int guard;

		free(output->temporary);
		output->temporary = temporary_name(output->target, error);
		if (!output->temporary)
			return SPEC_ENOMEM;
		guard = mkostemp(output->temporary, O_CLOEXEC); /* for the name alone */
		if (guard < 0)
			break;
		close(guard);
		unlink(output->temporary);
		if (linkat(AT_FDCWD, from, AT_FDCWD, output->temporary,
			    AT_SYMLINK_FOLLOW) == 0)
			return SPEC_OK;
		if (errno != EEXIST)
			break;
	}
	free(output->temporary);
	output->temporary = NULL;
	return spec_error_system(error, errno, "unable to create '%s'", output->path);
}

/*
 * What the system has put off is told by close. Of standard output a copy is closed:
 * should that fail, the file can still be emptied; the rest is the process's end.
 */
static enum spec_status
close_checked(struct spec_output *output, struct spec_error *error)
{
	int fd = output->standard ? fcntl(output->fd, F_DUPFD_CLOEXEC, 3) : output->fd;

	if (fd < 0)
		return write_failed(output, errno, error);
	if (!output->standard)
		output->fd = -1;
	return close(fd) < 0 ? write_failed(output, errno, error) : SPEC_OK;
}

enum spec_status
spec_output_commit(struct spec_output *output, struct spec_error *error)
{
	enum spec_status status = SPEC_OK;

	if (output->target && !output->temporary)
		status = give_name(output, error);
	if (status == SPEC_OK)
		status = close_checked(output, error);
	if (status == SPEC_OK && output->target &&
		rename(output->temporary, output->target) < 0)
		status = write_failed(output, errno, error);
	if (status != SPEC_OK) {
		spec_output_abandon(output);
		return status;
	}
	clear(output);
	return SPEC_OK;
}

void
spec_output_abandon(struct spec_output *output)
{
	if (output->temporary)
		(void)unlink(output->temporary);
	if (output->fd >= 0) {
		if (output->standard && output->seekable)
			(void)!ftruncate(
				output->fd, 0); /* 'tool > file' leaves no half a file */
		if (!output->standard)
			(void)close(output->fd);
	}
	clear(output);
}

enum spec_status
spec_output_save(const char *path, const void *data, size_t size, struct spec_error *error)
{
	struct spec_output output;
	enum spec_status status = spec_output_open(&output, path, error);

	if (status != SPEC_OK)
		return status;
	status = spec_output_write(&output, data, size, error);
	if (status == SPEC_OK)
		return spec_output_commit(&output, error);
	spec_output_abandon(&output);
	return status;
}

int
spec_output_scratch(struct spec_error *error)
{
	const char *folder = getenv("TMPDIR");
	char *name;
	int fd;

	if (!folder || !*folder)
		folder = "/tmp";
	fd = open(folder, O_TMPFILE | O_RDWR | O_CLOEXEC, 0600);
	if (fd >= 0)
		return fd;
	name = spec_memory_new(strlen(folder) + 32, 1, "bytes of a file name", error);
	if (!name)
		return -1;
	sprintf(name, "%s/spectools.XXXXXX", folder);
	fd = mkostemp(name, O_CLOEXEC);
	if (fd < 0)
		spec_error_system(
			error, errno, "unable to create a temporary file in '%s'", folder);
	else
		(void)unlink(name);
	free(name);
	return fd;
}
