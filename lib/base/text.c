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
