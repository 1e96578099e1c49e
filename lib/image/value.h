/* The values of attributes, to be read by people and by programs. */
#ifndef SPEC_IMAGE_VALUE_H
#define SPEC_IMAGE_VALUE_H

#include <stdio.h>

#include "base/json.h"
#include "image/image.h"

/*
 * Writes a value in one line, of texts the first most bytes: then " ..." and how many there
 * are. Control characters become '?'. Of a type that is not known, type and size.
 */
void spec_value_print(FILE *stream, const struct spec_attribute *attribute, size_t most);

/*
 * Writes a value as JSON: a text, a number, an array of either, of matrices an array of
 * rows; chromaticities and a preview are objects, and a type that is not known is one of
 * "type" and "bytes".
 */
void spec_value_json(struct spec_json *json, const struct spec_attribute *attribute);

/* Writes text of so many bytes, control characters as '?'. */
void spec_value_print_text(FILE *stream, const char *text, size_t size);

#endif
