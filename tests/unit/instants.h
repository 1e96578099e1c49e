/* What unit tests of times share. */
#ifndef TESTS_UNIT_INSTANTS_H
#define TESTS_UNIT_INSTANTS_H

#include "place/instant.h"

#include "check.h"

static inline struct spec_instant
instant_of(const char *text)
{
	struct spec_error error = {0};
	struct spec_instant instant;

	check(spec_instant_parse(text, &instant, &error), &error);
	return instant;
}

#endif
