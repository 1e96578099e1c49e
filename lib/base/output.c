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

#define COPY_BYTES (1 << 20)

#define MOST_NAMES 100       /* tried for a temporary file */
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

/* A name beside the target that nobody is likely to have; another one for each attempt. */
static enum spec_status
name_temporary(struct spec_output *output, int attempt, struct spec_error *error)
{
	size_t size = strlen(output->target) + 48;

	free(output->temporary);
	output->temporary = spec_memory_new(size, 1, "bytes of a file name", error);
	if (!output->temporary)
		return SPEC_ENOMEM;
	snprintf(output->temporary, size, "%s.%ld-%d", output->target, (long)getpid(),
		attempt);
	return SPEC_OK;
}

static void
forget_temporary(struct spec_output *output)
{
	free(output->temporary);
	output->temporary = NULL;
}

/* Where the file system has no files without a name. */
static enum spec_status
open_temporary(struct spec_output *output, struct spec_error *error)
{
	int failure = EEXIST;

	for (int attempt = 0; attempt < MOST_NAMES && failure == EEXIST; attempt++) {
		if (name_temporary(output, attempt, error) != SPEC_OK)
			return SPEC_ENOMEM;
		output->fd = open(
			output->temporary, O_CREAT | O_EXCL | O_WRONLY | O_CLOEXEC, 0666);
		if (output->fd >= 0)
			return SPEC_OK;
		failure = errno;
	}
	forget_temporary(output);
	return spec_error_system(error, failure, "unable to create '%s'", output->path);
}

/* kept: the file that will be replaced, whose permissions are kept; or null. */
static enum spec_status
open_beside(struct spec_output *output, const struct stat *kept, struct spec_error *error)
{
	char *folder = folder_of(output->target, error);
	enum spec_status status = SPEC_OK;

	if (!folder)
		return SPEC_ENOMEM;
	/* A file without a name cannot be left behind, not even by SIGKILL. */
	output->fd = open(folder, O_TMPFILE | O_WRONLY | O_CLOEXEC, 0666);
	free(folder);
	if (output->fd < 0)
		status = open_temporary(output, error);
	if (status == SPEC_OK && kept)
		(void)fchmod(output->fd, kept->st_mode & 0777);
	output->seekable = status == SPEC_OK;
	return status;
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
	enum spec_status resolved;

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
	if (access(output->path, W_OK) != 0 && (errno != ENOENT || !*output->path))
		return spec_error_system(
			error, errno, "unable to write '%s'", output->path);
	resolved = resolve(output, error);
	if (resolved != SPEC_OK)
		return resolved;
	return open_beside(
		output, stat(output->target, &status) == 0 ? &status : NULL, error);
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
	int failure = EEXIST;
	char from[64];

	snprintf(from, sizeof from, "/proc/self/fd/%d", output->fd);
	for (int attempt = 0; attempt < MOST_NAMES && failure == EEXIST; attempt++) {
		if (name_temporary(output, attempt, error) != SPEC_OK)
			return SPEC_ENOMEM;
		if (linkat(AT_FDCWD, from, AT_FDCWD, output->temporary,
			    AT_SYMLINK_FOLLOW) == 0)
			return SPEC_OK;
		failure = errno;
	}
	forget_temporary(output);
	return spec_error_system(error, failure, "unable to create '%s'", output->path);
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

/* All but the file's own name, which renaming gives it. */
static enum spec_status
complete(struct spec_output *output, struct spec_error *error)
{
	enum spec_status status = SPEC_OK;

	if (output->target && !output->temporary)
		status = give_name(output, error);
	return status == SPEC_OK ? close_checked(output, error) : status;
}

enum spec_status
spec_output_commit(struct spec_output *output, struct spec_error *error)
{
	enum spec_status status = complete(output, error);

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

/* The file that an output replaces. */
struct old {
	int was_there;
	char *name; /* a second one that it has meanwhile, or null */
};

static void
keep_old(const struct spec_output *output, struct old *old)
{
	size_t size = strlen(output->temporary) + 8;
	struct stat status;

	old->was_there = lstat(output->target, &status) == 0;
	old->name = old->was_there ? spec_memory_new(size, 1, "bytes", NULL) : NULL;
	if (!old->name)
		return;
	snprintf(old->name, size, "%s-old", output->temporary);
	if (link(output->target, old->name) == 0)
		return;
	free(old->name);
	old->name = NULL; /* not every file system has links */
}

static void
put_back(const struct spec_output *output, const struct old *old)
{
	if (old->name)
		(void)rename(old->name, output->target);
	else if (!old->was_there)
		(void)unlink(output->target);
}

/* Gives all their names; *named: how many have them. */
static enum spec_status
rename_all(struct spec_output *const *output, size_t count, struct old *old, size_t *named,
	struct spec_error *error)
{
	for (*named = 0; *named < count; ++*named) {
		struct spec_output *next = output[*named];

		if (!next->target)
			continue;
		if (*named + 1 < count) /* no failure can follow the last one */
			keep_old(next, &old[*named]);
		if (rename(next->temporary, next->target) < 0)
			return write_failed(next, errno, error);
	}
	return SPEC_OK;
}

enum spec_status
spec_output_commit_all(
	struct spec_output *const *output, size_t count, struct spec_error *error)
{
	struct old *old = spec_memory_new(count, sizeof *old, "files", error);
	enum spec_status status = old ? SPEC_OK : SPEC_ENOMEM;
	size_t named = 0;

	for (size_t i = 0; i < count && status == SPEC_OK; i++)
		status = complete(output[i], error);
	if (status == SPEC_OK)
		status = rename_all(output, count, old, &named, error);
	for (size_t i = 0; old && i < count; i++) {
		if (status != SPEC_OK && i < named && output[i]->target)
			put_back(output[i], &old[i]);
		else if (old[i].name)
			(void)unlink(old[i].name);
		free(old[i].name);
	}
	free(old);
	for (size_t i = 0; i < count; i++) {
		if (status == SPEC_OK)
			clear(output[i]);
		else
			spec_output_abandon(output[i]);
	}
	return status;
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

enum spec_status
spec_output_scratch(int *fd, struct spec_error *error)
{
	const char *folder = getenv("TMPDIR");
	char *name;

	if (!folder || !*folder)
		folder = "/tmp";
	*fd = open(folder, O_TMPFILE | O_RDWR | O_CLOEXEC, 0600);
	if (*fd >= 0)
		return SPEC_OK;
	name = spec_memory_new(strlen(folder) + 32, 1, "bytes of a file name", error);
	if (!name)
		return SPEC_ENOMEM;
	sprintf(name, "%s/spectools.XXXXXX", folder);
	*fd = mkostemp(name, O_CLOEXEC);
	if (*fd >= 0)
		(void)unlink(name);
	free(name);
	return *fd >= 0 ? SPEC_OK
			: spec_error_system(error, errno,
				  "unable to create a temporary file in '%s'", folder);
}

enum spec_status
spec_output_read(int fd, void *data, size_t size, int64_t offset, struct spec_error *error)
{
	for (size_t done = 0; done < size;) {
		ssize_t got =
			pread(fd, (char *)data + done, size - done, offset + (int64_t)done);

		if (got < 0 && errno == EINTR)
			continue;
		if (got <= 0)
			return spec_error_set(error, SPEC_EIO,
				"unable to read a temporary file: %s",
				got < 0 ? strerror(errno) : "it has become shorter");
		done += (size_t)got;
	}
	return SPEC_OK;
}

enum spec_status
spec_output_append(struct spec_output *output, int fd, struct spec_error *error)
{
	char *buffer = spec_memory_new(COPY_BYTES, 1, "bytes", error);
	enum spec_status status = buffer ? SPEC_OK : SPEC_ENOMEM;
	int64_t offset = 0;
	ssize_t got = 1;

	while (status == SPEC_OK && got > 0) {
		got = pread(fd, buffer, COPY_BYTES, offset);
		if (got < 0 && errno == EINTR) {
			got = 1;
			continue;
		}
		if (got < 0)
			status = spec_error_system(
				error, errno, "unable to read back a temporary file");
		else
			status = spec_output_write(output, buffer, (size_t)got, error);
		offset += got;
	}
	free(buffer);
	return status;
}
