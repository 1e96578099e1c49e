/* What is wrong with an image, by specexr(5), and what is odd. */
#ifndef SPEC_IMAGE_LINT_H
#define SPEC_IMAGE_LINT_H

#include <stddef.h>

#include "base/error.h"
#include "image/settings.h"

enum spec_lint_severity {
	SPEC_LINT_NOTE,    /* worth knowing: nothing is wrong */
	SPEC_LINT_WARNING, /* not as a writer must or should do it, or no possible light */
	SPEC_LINT_ERROR    /* the file is invalid: readers refuse it */
};

struct spec_lint_finding {
	enum spec_lint_severity severity;
	char *place; /* a channel, an attribute, a sample "CHANNEL at X,Y", or a part of the file */
	char *text;
};

struct spec_lint {
	struct spec_lint_finding *finding;
	size_t findings, room;
	size_t count[SPEC_LINT_ERROR + 1]; /* of each severity */
};

/* "note", "warning", "error". */
const char *spec_lint_severity(enum spec_lint_severity severity);

/*
 * Reads a whole image, header and samples, and lists what is found: of the header first,
 * then of the samples. What a format forbids is no error here but a finding. Errors: those
 * of reading a file that is damaged, cut short, or of a kind that no tool reads. path: "-"
 * is standard input.
 */
enum spec_status spec_lint_file(struct spec_lint *lint, const char *path,
	const struct spec_settings *settings, struct spec_error *error);

void spec_lint_free(struct spec_lint *lint);

#endif
