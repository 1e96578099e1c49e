/* What a curve is: its texts, its wavelengths, and how far its values reach. */
#ifndef SPEC_SPECTRUM_SUMMARY_H
#define SPEC_SPECTRUM_SUMMARY_H

#include <stdio.h>

#include "base/json.h"
#include "spectrum/curve.h"

/* For people: name, as the user wrote it, then a line per thing. */
void spec_summary_print(FILE *stream, const char *name, const struct spec_curve *curve);

/*
 * For programs: an object, which stays open for more keys, and is the caller's to close;
 * specinfo(1) says what its keys mean.
 */
void spec_summary_json_open(
	struct spec_json *json, const char *name, const struct spec_curve *curve);

#endif
