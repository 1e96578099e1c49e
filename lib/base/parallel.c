#include "base/parallel.h"

#include <sched.h>
#include <stdlib.h>

#include "base/memory.h"

#define MOST_THREADS 256

struct job {
	void (*work)(void *, int);
	void *argument;
	int worker;
};

int
spec_parallel_processors(void)
{
	cpu_set_t set;
	int count = 1;

	CPU_ZERO(&set);
	if (sched_getaffinity(0, sizeof set, &set) == 0)
		count = CPU_COUNT(&set);
	return count < 1 ? 1 : count > MOST_THREADS ? MOST_THREADS : count;
}

static void *
run_job(void *argument)
{
	struct job *job = argument;

	job->work(job->argument, job->worker);
	return NULL;
}

enum spec_status
spec_parallel_run(
	int threads, void (*work)(void *, int), void *argument, struct spec_error *error)
{
	pthread_t *handle = spec_memory_new(threads, sizeof *handle, "threads", error);
	struct job *job = spec_memory_new(threads, sizeof *job, "threads", error);
	int started = 1;

	if (!handle || !job) {
		free(handle);
		free(job);
		return SPEC_ENOMEM;
	}
	for (; started < threads; started++) {
		job[started] = (struct job){work, argument, started};
		if (pthread_create(&handle[started], NULL, run_job, &job[started]) != 0)
			break;
	}
	work(argument, 0);
	for (int i = 1; i < started; i++)
		pthread_join(handle[i], NULL);
	free(handle);
	free(job);
	return SPEC_OK;
}

void
spec_turnstile_init(struct spec_turnstile *turnstile)
{
	*turnstile = (struct spec_turnstile){0};
	pthread_mutex_init(&turnstile->lock, NULL);
	pthread_cond_init(&turnstile->changed, NULL);
}

void
spec_turnstile_destroy(struct spec_turnstile *turnstile)
{
	pthread_cond_destroy(&turnstile->changed);
	pthread_mutex_destroy(&turnstile->lock);
}

int
spec_turnstile_enter(struct spec_turnstile *turnstile, long long ticket)
{
	int open;

	pthread_mutex_lock(&turnstile->lock);
	while (!turnstile->stopped && turnstile->next != ticket)
		pthread_cond_wait(&turnstile->changed, &turnstile->lock);
	open = !turnstile->stopped;
	pthread_mutex_unlock(&turnstile->lock);
	return open;
}

void
spec_turnstile_leave(struct spec_turnstile *turnstile)
{
	pthread_mutex_lock(&turnstile->lock);
	turnstile->next++;
	pthread_cond_broadcast(&turnstile->changed);
	pthread_mutex_unlock(&turnstile->lock);
}

void
spec_turnstile_stop(struct spec_turnstile *turnstile, const struct spec_error *error)
{
	pthread_mutex_lock(&turnstile->lock);
	if (!turnstile->stopped)
		turnstile->error = *error;
	turnstile->stopped = 1;
	pthread_cond_broadcast(&turnstile->changed);
	pthread_mutex_unlock(&turnstile->lock);
}

enum spec_status
spec_turnstile_status(struct spec_turnstile *turnstile, struct spec_error *error)
{
	enum spec_status status = SPEC_OK;

	pthread_mutex_lock(&turnstile->lock);
	if (turnstile->stopped) {
		status = turnstile->error.status;
		if (error)
			*error = turnstile->error;
	}
	pthread_mutex_unlock(&turnstile->lock);
	return status;
}
