/* What unit tests of numbers and messages share; brings cmocka and all that it needs. */
#ifndef TESTS_UNIT_CHECK_H
#define TESTS_UNIT_CHECK_H

#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <string.h>

#include <cmocka.h>

#include "base/error.h"

#define COUNT(list) (sizeof(list) / sizeof *(list))

/* Fails unless got lies within the tolerance of what is wanted; NaN never does. */
static inline void
near(double got, double wanted, double tolerance, const char *what)
{
	if (!(fabs(got - wanted) <= tolerance))
		fail_msg("%s: got %.17g, wanted %.17g +- %g", what, got, wanted, tolerance);
}

/* Fails with the error's message unless all went well. */
static inline void
check(enum spec_status status, const struct spec_error *error)
{
	if (status != SPEC_OK)
		fail_msg("%s", error->message);
}

static inline void
assert_contains(const char *text, const char *part)
{
	if (!strstr(text, part))
		fail_msg("'%s' is not in '%s'", part, text);
}

#endif
