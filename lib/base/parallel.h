/* Worker threads that take turns. */
#ifndef SPEC_BASE_PARALLEL_H
#define SPEC_BASE_PARALLEL_H

#include <pthread.h>

#include "base/error.h"

/* How many processors this process may run on, at least 1. */
int spec_parallel_processors(void);

/*
 * Runs work(argument, worker) for worker = 0..threads-1, each on a thread of its
 * own (worker 0 on the caller's), and returns when all have. Where the system gives
 * no more threads, those that there are do the work. Error: SPEC_ENOMEM.
 */
enum spec_status spec_parallel_run(int threads, void (*work)(void *argument, int worker),
	void *argument, struct spec_error *error);

/*
 * A turnstile lets tickets 0, 1, 2, … through in that order, one at a time. It
 * keeps the first error and then lets nobody through any more.
 */
struct spec_turnstile {
	pthread_mutex_t lock;
	pthread_cond_t changed;
	long long next;
	int stopped;
	struct spec_error error;
};

void spec_turnstile_init(struct spec_turnstile *turnstile);
void spec_turnstile_destroy(struct spec_turnstile *turnstile);

/* Blocks until it is the ticket's turn. Returns 1, or 0 when the turnstile has stopped. */
int spec_turnstile_enter(struct spec_turnstile *turnstile, long long ticket);

/* The one who entered leaves: the next ticket's turn. */
void spec_turnstile_leave(struct spec_turnstile *turnstile);

/* Stops everybody; the first error given is kept. */
void spec_turnstile_stop(struct spec_turnstile *turnstile, const struct spec_error *error);

/* The error of the first stop, or SPEC_OK. */
enum spec_status spec_turnstile_status(
	struct spec_turnstile *turnstile, struct spec_error *error);

#endif
