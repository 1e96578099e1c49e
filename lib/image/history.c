/* spec:history: every image carries the commands that made it. */
#include <stdlib.h>
#include <string.h>

#include "base/memory.h"
#include "image/image.h"

struct text {
	char *bytes;
	size_t length, room;
	enum spec_status status;
};

static void
append(struct text *text, const char *bytes, size_t length, struct spec_error *error)
{
	void *list = text->bytes;

	if (text->status != SPEC_OK)
		return;
	text->status = spec_memory_grow(&list, &text->room, text->length + length + 1, 1,
		"bytes of history", error);
	text->bytes = list;
	if (text->status != SPEC_OK)
		return;
	memcpy(text->bytes + text->length, bytes, length);
	text->length += length;
}

static int
is_plain(const char *argument)
{
	static const char plain[] = "abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ"
				    "0123456789_-./:,=+@%";

	return *argument && argument[strspn(argument, plain)] == '\0';
}

/* An argument as sh would read it back; a line break would end the line of the history. */
static void
append_quoted(struct text *text, const char *argument, struct spec_error *error)
{
	if (is_plain(argument)) {
		append(text, argument, strlen(argument), error);
		return;
	}
	append(text, "'", 1, error);
	for (; *argument; argument++) {
		if (*argument == '\'')
			append(text, "'\\''", 4, error);
		else
			append(text,
				*argument == '\n' || *argument == '\r' ? " " : argument, 1,
				error);
	}
	append(text, "'", 1, error);
}

enum spec_status
spec_image_add_history(
	struct spec_image *image, int argc, char **argv, struct spec_error *error)
{
	struct text text = {0};
	char *before;
	enum spec_status status = spec_image_text(image, "spec:history", &before, error);

	if (status != SPEC_OK)
		return status;
	if (before && *before) {
		append(&text, before, strlen(before), error);
		if (before[strlen(before) - 1] != '\n')
			append(&text, "\n", 1, error);
	}
	free(before);
	for (int i = 0; i < argc; i++) {
		const char *slash = i == 0 ? strrchr(argv[0], '/') : NULL;

		if (i > 0)
			append(&text, " ", 1, error);
		append_quoted(&text, slash ? slash + 1 : argv[i], error);
	}
	append(&text, "  # spectools " SPEC_VERSION "\n",
		strlen("  # spectools " SPEC_VERSION "\n"), error);
	status = text.status;
	if (status == SPEC_OK) {
		text.bytes[text.length] = '\0';
		status = spec_image_set_text(image, "spec:history", text.bytes, error);
	}
	free(text.bytes);
	return status;
}
