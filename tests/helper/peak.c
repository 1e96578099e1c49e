/*
 * Runs a command and says how long it took and how much memory it had at its peak.
 *
 *   peak FILE COMMAND [ARGUMENT]...
 *
 * Appends "SECONDS KIBIBYTES STATUS CPU-SECONDS" to FILE. The exit status is the command's,
 * or 128 plus the signal that ended it.
 *
 * The child of a fork begins with its parent's peak, so this program must stay small:
 * it has no library but libc.
 */
#include <errno.h>
#include <fcntl.h>
#include <stdio.h>
#include <string.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <time.h>
#include <unistd.h>

static double
now(void)
{
	struct timespec time;

	clock_gettime(CLOCK_MONOTONIC, &time);
	return (double)time.tv_sec + 1e-9 * (double)time.tv_nsec;
}

static double
seconds(struct timeval time)
{
	return (double)time.tv_sec + 1e-6 * (double)time.tv_usec;
}

static int
fail(const char *what)
{
	fprintf(stderr, "peak: %s: %s\n", what, strerror(errno));
	return 2;
}

int
main(int argc, char **argv)
{
	double start = now();
	struct rusage usage;
	int status, file;
	pid_t child;

	if (argc < 3) {
		fputs("usage: peak FILE COMMAND [ARGUMENT]...\n", stderr);
		return 2;
	}
	file = open(argv[1], O_WRONLY | O_CREAT | O_APPEND | O_CLOEXEC, 0666);
	if (file < 0)
		return fail(argv[1]);
	child = fork();
	if (child < 0)
		return fail("fork");
	if (child == 0) {
		execvp(argv[2], argv + 2);
		_exit(fail(argv[2]));
	}
	/* A pipe must not stay open because of the one who only watches. */
	close(STDIN_FILENO);
	close(STDOUT_FILENO);
	while (wait4(child, &status, 0, &usage) < 0) {
		if (errno != EINTR)
			return fail("wait");
	}
	status = WIFEXITED(status) ? WEXITSTATUS(status) : 128 + WTERMSIG(status);
	if (dprintf(file, "%.4f %ld %d %.4f\n", now() - start, usage.ru_maxrss, status,
		    seconds(usage.ru_utime) + seconds(usage.ru_stime)) < 0)
		return fail(argv[1]);
	return status;
}
