#include "cli/progress.h"

#include <stdio.h>
#include <string.h>
#include <unistd.h>

#define LONG_WORK_S 1.0 /* shorter work shows nothing */
#define REFRESH_S 0.1
#define BAR_WIDTH 30

static double
seconds_since(const struct timespec *then, const struct timespec *now)
{
	return (double)(now->tv_sec - then->tv_sec) +
	       1e-9 * (double)(now->tv_nsec - then->tv_nsec);
}

void
cli_progress_start(struct cli_progress *progress, const char *unit, int on, int quiet)
{
	*progress = (struct cli_progress){.unit = unit};
	if (!quiet)
		progress->wanted = on ? 2 : isatty(STDERR_FILENO);
	clock_gettime(CLOCK_MONOTONIC, &progress->start);
}

void
cli_progress_show(void *state, int done, int total)
{
	struct cli_progress *progress = state;
	char bar[BAR_WIDTH + 1];
	struct timespec now;
	double elapsed, rate;
	int filled = (int)((double)done / total * BAR_WIDTH);

	if (!progress->wanted)
		return;
	clock_gettime(CLOCK_MONOTONIC, &now);
	elapsed = seconds_since(&progress->start, &now);
	if (progress->wanted == 1 && elapsed < LONG_WORK_S)
		return;
	if (progress->shown && done < total &&
		seconds_since(&progress->last, &now) < REFRESH_S)
		return;
	progress->last = now;
	progress->shown = 1;
	memset(bar, '.', BAR_WIDTH);
	memset(bar, '#', filled);
	bar[BAR_WIDTH] = '\0';
	rate = elapsed > 0 ? done / elapsed : 0;
	fprintf(stderr, "\r[%s] %3d%%  %.0f %s/s  %.0f s left ", bar,
		(int)(100.0 * done / total), rate, progress->unit,
		rate > 0 ? (total - done) / rate : 0);
}

void
cli_progress_end(struct cli_progress *progress)
{
	if (progress->shown)
		fprintf(stderr, "\r\033[K");
	progress->shown = 0;
}
