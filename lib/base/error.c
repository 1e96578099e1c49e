#include "base/error.h"

#include <errno.h>
#include <stdarg.h>
#include <stdio.h>
#include <string.h>

static void
replace_line_breaks(char *message)
{
	for (; *message; message++)
		if ((unsigned char)*message < ' ' || *message == 127)
			*message = '?';
}

enum spec_status
spec_error_set(struct spec_error *error, enum spec_status status, const char *format, ...)
{
	va_list arguments;

	if (!error)
		return status;
	error->status = status;
	va_start(arguments, format);
	vsnprintf(error->message, sizeof error->message, format, arguments);
	va_end(arguments);
	replace_line_breaks(error->message);
	return status;
}

enum spec_status
spec_error_system(struct spec_error *error, int errnum, const char *format, ...)
{
	enum spec_status status = errnum == ENOMEM ? SPEC_ENOMEM : SPEC_EIO;
	va_list arguments;
	size_t length;

	if (!error)
		return status;
	error->status = status;
	va_start(arguments, format);
	vsnprintf(error->message, sizeof error->message, format, arguments);
	va_end(arguments);
	length = strlen(error->message);
	snprintf(error->message + length, sizeof error->message - length, ": %s",
		strerror(errnum));
	replace_line_breaks(error->message);
	return status;
}

enum spec_status
spec_error_prefix(struct spec_error *error, const char *format, ...)
{
	char old[sizeof error->message];
	va_list arguments;
	size_t length;

	if (!error)
		return SPEC_OK;
	memcpy(old, error->message, sizeof old);
	va_start(arguments, format);
	vsnprintf(error->message, sizeof error->message, format, arguments);
	va_end(arguments);
	length = strlen(error->message);
	snprintf(error->message + length, sizeof error->message - length, ": %s", old);
	replace_line_breaks(error->message);
	return error->status;
}
