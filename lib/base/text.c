#include "base/text.h"

#include <errno.h>
#include <stdlib.h>
#include <string.h>

#include "base/memory.h"

/* What the stream's buffer holds goes behind the bytes; 0: it cannot. */
static ssize_t
append(void *cookie, const char *bytes, size_t size)
{
	struct spec_text *text = cookie;
	void *list = text->bytes;
	enum spec_status status =
		spec_memory_grow(&list, &text->room, text->size + size, 1, "bytes", NULL);

	text->bytes = list;
	if (status != SPEC_OK) {
		errno = ENOMEM;
		return 0;
	}
	memcpy(text->bytes + text->size, bytes, size);
	text->size += size;
	return (ssize_t)size;
}

enum spec_status
spec_text_open(struct spec_text *text, struct spec_error *error)
{
	*text = (struct spec_text){0};
	text->stream = fopencookie(text, "w", (cookie_io_functions_t){.write = append});
	if (text->stream)
		return SPEC_OK;
	return spec_error_set(error, SPEC_ENOMEM, "out of memory for a text");
}

enum spec_status
spec_text_close(struct spec_text *text, struct spec_error *error)
{
	/* ferror first: an earlier failed write may have left nothing to flush. */
	int failed = ferror(text->stream);

	failed |= fclose(text->stream) != 0;
	text->stream = NULL;
	if (!failed)
		return SPEC_OK;
	spec_text_free(text);
	return spec_error_set(error, SPEC_ENOMEM, "out of memory for a text");
}

void
spec_text_free(struct spec_text *text)
{
	if (text->stream)
		(void)fclose(text->stream);
	free(text->bytes);
	*text = (struct spec_text){0};
}

size_t
spec_text_character(const unsigned char *bytes, size_t size)
{
	unsigned char first = bytes[0], low = 0x80, high = 0xbf;
	size_t length = first < 0x80   ? 1
			: first < 0xc2 ? 0
			: first < 0xe0 ? 2
			: first < 0xf0 ? 3
			: first < 0xf5 ? 4
				       : 0;

	if (length < 2 || length > size)
		return length > size ? 0 : length;
	if (first == 0xe0)
		low = 0xa0; /* below it, the shorter form is the right one */
	else if (first == 0xf0)
		low = 0x90;
	else if (first == 0xed)
		high = 0x9f; /* above it are surrogates */
	else if (first == 0xf4)
		high = 0x8f; /* above it is nothing */
	if (bytes[1] < low || bytes[1] > high)
		return 0;
	for (size_t i = 2; i < length; i++) {
		if ((bytes[i] & 0xc0) != 0x80)
			return 0;
	}
	return length;
}

char *
spec_text_readable(const char *text, struct spec_error *error)
{
	const unsigned char *bytes = (const unsigned char *)text;
	size_t size = strlen(text), at = 0;
	/* What U+FFFD takes is at most three times what it stands for. */
	char *readable = spec_memory_new(size + 1, 3, "characters", error);

	while (readable && size > 0) {
		size_t length = spec_text_character(bytes, size);

		if (length > 0)
			memcpy(readable + at, bytes, length);
		else
			memcpy(readable + at, "\xef\xbf\xbd", 3);
		at += length > 0 ? length : 3;
		length += length == 0;
		bytes += length;
		size -= length;
	}
	return readable;
}
