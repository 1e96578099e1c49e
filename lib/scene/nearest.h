/* The name that somebody may have meant. */
#ifndef SPEC_SCENE_NEAREST_H
#define SPEC_SCENE_NEAREST_H

#include <stddef.h>

/*
 * The name in a table that is nearest to a name that is not in it, or null if none is near.
 * table: rows of size bytes each, whose first member is a const char *, null in the last.
 */
const char *spec_nearest_name(const char *name, const void *table, size_t size);

#endif
