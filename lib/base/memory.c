#include "base/memory.h"

#include <stdint.h>
#include <stdlib.h>
#include <string.h>

#define ALIGNMENT 64 /* bytes: a cache line, and the widest vector register */

static int
product_overflows(size_t count, size_t size)
{
	return size != 0 && count > (PTRDIFF_MAX - ALIGNMENT) / size;
}

static void
set_no_memory(struct spec_error *error, size_t count, const char *what)
{
	spec_error_set(error, SPEC_ENOMEM, "out of memory for %zu %s", count, what);
}

void *
spec_memory_new(size_t count, size_t size, const char *what, struct spec_error *error)
{
	void *memory = NULL;

	if (!product_overflows(count, size))
		memory = calloc(count ? count : 1, size ? size : 1);
	if (!memory)
		set_no_memory(error, count, what);
	return memory;
}

void *
spec_memory_aligned(size_t count, size_t size, const char *what, struct spec_error *error)
{
	void *memory = NULL;
	size_t bytes;

	if (!product_overflows(count, size)) {
		bytes = (count * size + ALIGNMENT) / ALIGNMENT * ALIGNMENT;
		memory = aligned_alloc(ALIGNMENT, bytes);
	}
	if (!memory)
		set_no_memory(error, count, what);
	return memory;
}

enum spec_status
spec_memory_grow(void **list, size_t *room, size_t count, size_t size, const char *what,
	struct spec_error *error)
{
	size_t wanted = *room;
	void *grown;

	if (count <= *room)
		return SPEC_OK;
	while (wanted < count)
		wanted = wanted < 8 ? 8 : wanted + wanted / 2;
	grown = product_overflows(wanted, size) ? NULL : realloc(*list, wanted * size);
	if (!grown) {
		set_no_memory(error, wanted, what);
		return SPEC_ENOMEM;
	}
	memset((char *)grown + *room * size, 0, (wanted - *room) * size);
	*list = grown;
	*room = wanted;
	return SPEC_OK;
}

char *
spec_memory_text(const char *text, size_t length, struct spec_error *error)
{
	char *copy = spec_memory_new(length + 1, 1, "bytes of text", error);

	if (copy)
		memcpy(copy, text, length);
	return copy;
}
