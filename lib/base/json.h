/*
 * Writing JSON (RFC 8259) to a stream. Whatever is given, what comes out is valid: texts are
 * escaped, bytes of them that are no UTF-8 become U+FFFD, and numbers that are not finite
 * become null. Write errors stay in the stream, for its owner to see.
 */
#ifndef SPEC_BASE_JSON_H
#define SPEC_BASE_JSON_H

#include <stddef.h>
#include <stdio.h>

#define SPEC_JSON_DEEPEST 16

enum spec_json_shape {
	SPEC_JSON_LINES, /* each value on a line of its own */
	SPEC_JSON_INLINE /* on one line, with all that is in it */
};

struct spec_json {
	FILE *stream;
	int depth; /* of containers that are open */
	struct {
		char closing; /* '}' or ']' */
		enum spec_json_shape shape;
		size_t values;
	} level[SPEC_JSON_DEEPEST];
};

void spec_json_start(struct spec_json *json, FILE *stream);

/*
 * Everywhere below: key is the value's name where it stands in an object, and null in an
 * array and at the top.
 */

/* Opens an object ('{') or an array ('['); at most SPEC_JSON_DEEPEST are open at once. */
void spec_json_open(
	struct spec_json *json, const char *key, char bracket, enum spec_json_shape shape);

/* Closes what was opened last; after the outermost a line ends. */
void spec_json_close(struct spec_json *json);

/* A text, or null where text is null. */
void spec_json_text(struct spec_json *json, const char *key, const char *text);

/* A text of size bytes, which may hold anything. */
void spec_json_bytes(
	struct spec_json *json, const char *key, const char *bytes, size_t size);

/* The fewest of 15 to 17 digits, or of 6 to 9, that read back as the same number. */
void spec_json_number(struct spec_json *json, const char *key, double value);
void spec_json_float(struct spec_json *json, const char *key, float value);

void spec_json_whole(struct spec_json *json, const char *key, long long value);
void spec_json_truth(struct spec_json *json, const char *key, int value);
void spec_json_null(struct spec_json *json, const char *key);

/* An array of numbers, on one line. */
void spec_json_numbers(
	struct spec_json *json, const char *key, const double *value, size_t count);

#endif
