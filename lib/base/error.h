/*
 * Statuses and messages. The library never prints and never exits: a function
 * that can fail returns a status and fills a message that names the file, the
 * place in it and the cause.
 */
#ifndef SPEC_BASE_ERROR_H
#define SPEC_BASE_ERROR_H

#include <stdarg.h>
#include <stddef.h>

enum spec_status {
	SPEC_OK,
	SPEC_EUSAGE,       /* the caller asked for something that makes no sense */
	SPEC_EIO,          /* the operating system refused */
	SPEC_EFORMAT,      /* the input is damaged or is not what it claims to be */
	SPEC_ERANGE,       /* a value lies outside its range, or a limit was hit */
	SPEC_EUNSUPPORTED, /* well-formed, but nothing here can do it */
	SPEC_ENOMEM
};

struct spec_error {
	enum spec_status status;
	char message[1024]; /* one line, lower case, no full stop */
	/* "", or two lines: what the user wrote, and a caret under the fault. */
	char place[256];
};

/* Replaces line breaks and other control characters: names in files may hold anything. */
void spec_error_plain(char *text);

/* A null error is allowed: the status is still returned. */
enum spec_status spec_error_set(struct spec_error *error, enum spec_status status,
	const char *format, ...) __attribute__((format(printf, 3, 4)));

/* As spec_error_set, of a function's own variable arguments; error's own message is none. */
enum spec_status spec_error_vset(struct spec_error *error, enum spec_status status,
	const char *format, va_list arguments) __attribute__((format(printf, 3, 0)));

/* As spec_error_set, and appends ": " and the text of the errno given. */
enum spec_status spec_error_system(struct spec_error *error, int errnum, const char *format,
	...) __attribute__((format(printf, 3, 4)));

/*
 * Shows where in a text the fault lies, for an error that is set: error->place becomes the
 * text (of a long one the part around the fault) and, under byte at of it, a caret.
 */
void spec_error_point(struct spec_error *error, const char *text, size_t at);

/* Both at once, of status SPEC_EUSAGE, which is returned. */
enum spec_status spec_error_set_at(struct spec_error *error, const char *text, size_t at,
	const char *format, ...) __attribute__((format(printf, 4, 5)));

/* Puts "prefix: " before the message that is there. */
void spec_error_prefix(struct spec_error *error, const char *format, ...)
	__attribute__((format(printf, 2, 3)));

#endif
