#include "base/error.h"

#include <errno.h>
#include <stdarg.h>
#include <stdio.h>
#include <string.h>

void
spec_error_plain(char *text)
{
	for (; *text; text++) {
		if ((unsigned char)*text < ' ' || *text == 127)
			*text = '?';
	}
}

enum spec_status
spec_error_vset(struct spec_error *error, enum spec_status status, const char *format,
	va_list arguments)
{
	if (!error)
		return status;
	error->status = status;
	error->place[0] = '\0';
	vsnprintf(error->message, sizeof error->message, format, arguments);
	spec_error_plain(error->message);
	return status;
}

enum spec_status
spec_error_set(struct spec_error *error, enum spec_status status, const char *format, ...)
{
	va_list arguments;

	va_start(arguments, format);
	spec_error_vset(error, status, format, arguments);
	va_end(arguments);
	return status;
}

enum spec_status
spec_error_system(struct spec_error *error, int errnum, const char *format, ...)
{
	enum spec_status status = errnum == ENOMEM ? SPEC_ENOMEM : SPEC_EIO;
	va_list arguments;
	size_t length;

	va_start(arguments, format);
	spec_error_vset(error, status, format, arguments);
	va_end(arguments);
	if (!error)
		return status;
	length = strlen(error->message);
	snprintf(error->message + length, sizeof error->message - length, ": %s",
		strerror(errnum));
	spec_error_plain(error->message);
	return status;
}

static int
continues(char byte)
{
	return ((unsigned char)byte & 0xc0) ==
	       0x80; /* not the first byte of a UTF-8 character */
}

void
spec_error_point(struct spec_error *error, const char *text, size_t at)
{
	enum { BEFORE = 48, AFTER = 24 };
	char excerpt[BEFORE + AFTER + 1];
	size_t length = strlen(text), start, end, column = 0;

	if (!error)
		return;
	if (at > length)
		at = length;
	start = at > BEFORE ? at - BEFORE : 0;
	end = length - at > AFTER ? at + AFTER : length;
	while (start < at && continues(text[start]))
		start++;
	while (end < length && end > at && continues(text[end]))
		end--;
	for (size_t i = start; i < at; i++)
		column += !continues(text[i]);
	snprintf(excerpt, sizeof excerpt, "%.*s", (int)(end - start), text + start);
	spec_error_plain(excerpt);
	snprintf(error->place, sizeof error->place, "  %s\n  %*s^", excerpt, (int)column,
		"");
}

enum spec_status
spec_error_set_at(
	struct spec_error *error, const char *text, size_t at, const char *format, ...)
{
	va_list arguments;

	va_start(arguments, format);
	spec_error_vset(error, SPEC_EUSAGE, format, arguments);
	va_end(arguments);
	spec_error_point(error, text, at);
	return SPEC_EUSAGE;
}

void
spec_error_prefix(struct spec_error *error, const char *format, ...)
{
	char old[sizeof((struct spec_error *)0)->message];
	va_list arguments;
	size_t length;

	if (!error)
		return;
	memcpy(old, error->message, sizeof old);
	va_start(arguments, format);
	vsnprintf(error->message, sizeof error->message, format, arguments);
	va_end(arguments);
	length = strlen(error->message);
	snprintf(error->message + length, sizeof error->message - length, ": %s", old);
	spec_error_plain(error->message);
}
