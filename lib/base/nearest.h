/* How near a name is to another: what somebody may have meant. */
#ifndef SPEC_BASE_NEAREST_H
#define SPEC_BASE_NEAREST_H

#include <stddef.h>

#define SPEC_NEAREST_LONGEST 64 /* bytes of names that are compared */

/*
 * The least number of bytes to insert, delete or replace that turns a into b; upper and
 * lower case are equal. SIZE_MAX where b is longer than SPEC_NEAREST_LONGEST.
 * Source: Wagner & Fischer 1974, "The string-to-string correction problem", J. ACM 21(1);
 * it keeps one row of the table.
 */
size_t spec_nearest_distance(const char *a, const char *b);

/*
 * The name in a table that is nearest to a name that is not in it, or null if none is near.
 * table: rows of size bytes each, whose first member is a const char *, null in the last.
 */
const char *spec_nearest_name(const char *name, const void *table, size_t size);

#endif
