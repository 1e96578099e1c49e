/* Allocation that cannot overflow, and lists that grow. */
#ifndef SPEC_BASE_MEMORY_H
#define SPEC_BASE_MEMORY_H

#include <stddef.h>

#include "base/error.h"

/*
 * Zeroed memory for count elements of size bytes, or null with the error set
 * (the product is checked for overflow; a count of 0 gives a valid pointer).
 * what: a plural noun for the message, such as "channels".
 */
void *spec_memory_new(
	size_t count, size_t size, const char *what, struct spec_error *error);

/* As spec_memory_new, but not zeroed and aligned to 64 bytes. Freed with free(). */
void *spec_memory_aligned(
	size_t count, size_t size, const char *what, struct spec_error *error);

/*
 * Grows *list, which has room for *room elements of size bytes, until it has
 * room for at least count. The new elements are zero. On failure the list is
 * as it was.
 */
enum spec_status spec_memory_grow(void **list, size_t *room, size_t count, size_t size,
	const char *what, struct spec_error *error);

/* A copy of length bytes of text with a zero after them, or null with the error set. */
char *spec_memory_text(const char *text, size_t length, struct spec_error *error);

#endif
