/* What the fuzz targets share. */
#ifndef TESTS_FUZZ_FUZZ_H
#define TESTS_FUZZ_FUZZ_H

#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "base/error.h"

/* What libFuzzer calls; the first where a target has it. */
int LLVMFuzzerInitialize(int *argc, char ***argv);
int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size);

/* Ends the program, which libFuzzer takes for a find, where something does not hold. */
static inline void
require(int holds, const char *what)
{
	if (holds)
		return;
	fprintf(stderr, "fuzz: %s\n", what);
	abort();
}

/* What failed has a status and one line to say. */
static inline void
require_message(const struct spec_error *error)
{
	require(error->status != SPEC_OK, "a failure without a status");
	require(error->message[0] && !strchr(error->message, '\n'),
		"not one line's message");
}

/* And, where memory was there, a place in a text with a caret under it. */
static inline void
require_caret(const struct spec_error *error)
{
	const char *first = error->place, *second = strchr(first, '\n');

	require_message(error);
	if (error->status == SPEC_ENOMEM)
		return;
	require(second != NULL, "a failure without a place");
	second++;
	require(strspn(second, " ") + 1 == strlen(second) &&
			second[strlen(second) - 1] == '^',
		"no caret");
	require(strlen(second) <= (size_t)(second - first), "a caret behind the text");
}

/* make fuzz runs at the top of the repository, where our spectra are. */
static inline void
use_our_spectra(void)
{
	setenv("SPECTRA_PATH", "spectra", 0);
}

#endif
