/* Text that is put together in memory, through a stream. */
#ifndef SPEC_BASE_TEXT_H
#define SPEC_BASE_TEXT_H

#include <stddef.h>
#include <stdio.h>

#include "base/error.h"

struct spec_text {
	char *bytes; /* size of them, without a zero behind */
	size_t size, room;
	FILE *stream; /* to write to, while it is open */
};

/*
 * Opens text->stream. In place of open_memstream, which in glibc 2.36 forgets that it could
 * not grow and leaves the rest away. SPEC_ENOMEM.
 */
enum spec_status spec_text_open(struct spec_text *text, struct spec_error *error);

/* Closes the stream: now the bytes are all there. SPEC_ENOMEM; then they are none. */
enum spec_status spec_text_close(struct spec_text *text, struct spec_error *error);

/* Frees the bytes, and closes the stream where it is open. */
void spec_text_free(struct spec_text *text);

/*
 * The length of the UTF-8 character that begins at bytes, or 0: there is none. size: of
 * bytes, above 0. Unicode 15.0, table 3-7.
 */
size_t spec_text_character(const unsigned char *bytes, size_t size);

/*
 * A copy of a text in which every byte that is no UTF-8 has become U+FFFD, or null with the
 * error set (SPEC_ENOMEM).
 */
char *spec_text_readable(const char *text, struct spec_error *error);

#endif
