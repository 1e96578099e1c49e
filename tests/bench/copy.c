/*
 * The floor of a row kernel on a pipe: reads a row from stdin, writes it to stdout,
 * with pipe buffers of 1 MiB, and does nothing else.
 *
 *   bench-copy ROWBYTES < in > out
 */
#include <errno.h>
#include <fcntl.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#define PIPE_BYTES (1 << 20)

static _Noreturn void
die(const char *message)
{
	fprintf(stderr, "bench-copy: %s: %s\n", message, strerror(errno));
	exit(2);
}

/* Fills the row as far as the input goes. */
static size_t
read_row(char *row, size_t size)
{
	size_t got = 0;

	while (got < size) {
		ssize_t part = read(STDIN_FILENO, row + got, size - got);

		if (part < 0 && errno == EINTR)
			continue;
		if (part < 0)
			die("unable to read");
		if (part == 0)
			break;
		got += (size_t)part;
	}
	return got;
}

static void
write_row(const char *row, size_t size)
{
	while (size > 0) {
		ssize_t part = write(STDOUT_FILENO, row, size);

		if (part < 0 && errno == EINTR)
			continue;
		if (part < 0)
			die("unable to write");
		row += part;
		size -= (size_t)part;
	}
}

int
main(int argc, char **argv)
{
	long long size = argc == 2 ? strtoll(argv[1], NULL, 10) : 0;
	size_t got;
	char *row;

	if (size < 1 || size > 1LL << 30) {
		fputs("usage: bench-copy ROWBYTES < in > out\n", stderr);
		return 2;
	}
	/* Neither need be a pipe; where one is not, this does nothing. */
	(void)fcntl(STDIN_FILENO, F_SETPIPE_SZ, PIPE_BYTES);
	(void)fcntl(STDOUT_FILENO, F_SETPIPE_SZ, PIPE_BYTES);
	row = malloc((size_t)size);
	if (!row)
		die("no memory for a row");
	while ((got = read_row(row, (size_t)size)) > 0)
		write_row(row, got);
	free(row);
	return 0;
}
