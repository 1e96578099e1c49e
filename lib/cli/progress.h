/* A line on stderr: bar, rate, time left. For cmd/ alone. */
#ifndef SPEC_CLI_PROGRESS_H
#define SPEC_CLI_PROGRESS_H

#include <time.h>

struct cli_progress {
	struct timespec start, last;
	const char *unit; /* a plural noun: "lines" */
	int wanted;       /* 0: never; 1: when the work turns out long; 2: at once */
	int shown;
};

/* on: from --progress; quiet: from -q. By itself it shows only on a terminal. */
void cli_progress_start(struct cli_progress *progress, const char *unit, int on, int quiet);

/* A callback: state is the struct cli_progress. */
void cli_progress_show(void *state, int done, int total);

/* Takes the line away. */
void cli_progress_end(struct cli_progress *progress);

#endif
