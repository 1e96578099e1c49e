#include "image/lint.h"

#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "base/memory.h"
#include "image/linting.h"

const char *
spec_lint_severity(enum spec_lint_severity severity)
{
	if (severity == SPEC_LINT_ERROR)
		return "error";
	return severity == SPEC_LINT_WARNING ? "warning" : "note";
}

void
spec_linting_add(struct spec_linting *linting, enum spec_lint_severity severity,
	const char *place, const char *format, ...)
{
	struct spec_lint *lint = linting->lint;
	struct spec_lint_finding finding = {.severity = severity};
	void *list = lint->finding;
	char text[1024];
	va_list arguments;

	if (linting->status != SPEC_OK)
		return;
	va_start(arguments, format);
	vsnprintf(text, sizeof text, format, arguments);
	va_end(arguments);
	linting->status = spec_memory_grow(&list, &lint->room, lint->findings + 1,
		sizeof finding, "findings", linting->error);
	lint->finding = list;
	if (linting->status != SPEC_OK)
		return;
	finding.place = spec_memory_text(place, strlen(place), linting->error);
	finding.text = spec_memory_text(text, strlen(text), linting->error);
	if (!finding.place || !finding.text) {
		free(finding.place);
		free(finding.text);
		linting->status = SPEC_ENOMEM;
		return;
	}
	spec_error_plain(finding.place);
	spec_error_plain(finding.text);
	lint->finding[lint->findings++] = finding;
	lint->count[severity]++;
}

static void
check_storage(struct spec_linting *linting)
{
	const struct spec_storage *storage = &linting->storage;

	if (storage->parts > 1)
		spec_linting_add(linting, SPEC_LINT_WARNING, "file",
			"has %d parts; a writer must write a single one", storage->parts);
	if (storage->tile_width > 0)
		spec_linting_add(linting, SPEC_LINT_WARNING, "file",
			"has tiles of %d x %d; a writer must write scanlines",
			storage->tile_width, storage->tile_height);
	if (!storage->increasing)
		spec_linting_add(linting, SPEC_LINT_WARNING, "file",
			"its lines are not in increasing order, as a writer must write them");
}

/* Whatever the reader refuses is an error, even if nothing here has said so. */
static void
check_refused(
	struct spec_linting *linting, const struct spec_error *refused, const char *name)
{
	const char *message = refused->message;
	size_t length = strlen(name);

	if (refused->status == SPEC_OK || linting->lint->count[SPEC_LINT_ERROR] > 0)
		return;
	if (strncmp(message, name, length) == 0 && strncmp(message + length, ": ", 2) == 0)
		message += length + 2;
	spec_linting_add(linting, SPEC_LINT_ERROR, "file", "%s", message);
}

enum spec_status
spec_lint_file(struct spec_lint *lint, const char *path,
	const struct spec_settings *settings, struct spec_error *error)
{
	struct spec_linting linting = {.lint = lint, .error = error};
	struct spec_reader *reader;
	struct spec_error refused;
	enum spec_status status;

	*lint = (struct spec_lint){0};
	status = spec_reader_open_lenient(&reader, path, settings, &refused, error);
	if (status != SPEC_OK)
		return status;
	linting.image = spec_reader_image(reader);
	linting.storage = spec_reader_storage(reader);
	linting.exr = strcmp(spec_reader_format(reader), "OpenEXR") == 0;
	check_storage(&linting);
	spec_linting_channels(&linting);
	spec_linting_attributes(&linting);
	spec_linting_layers(&linting);
	check_refused(&linting, &refused, spec_reader_name(reader));
	if (linting.status == SPEC_OK)
		status = spec_linting_samples(&linting, reader, settings, error);
	if (status == SPEC_OK)
		status = linting.status;
	for (int i = 0; i < 4; i++)
		free(linting.band[i]);
	spec_reader_close(reader);
	if (status != SPEC_OK)
		spec_lint_free(lint);
	return status;
}

void
spec_lint_free(struct spec_lint *lint)
{
	for (size_t i = 0; i < lint->findings; i++) {
		free(lint->finding[i].place);
		free(lint->finding[i].text);
	}
	free(lint->finding);
	*lint = (struct spec_lint){0};
}
