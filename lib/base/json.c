#include "base/json.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "base/text.h"

#define INDENT 2

void
spec_json_start(struct spec_json *json, FILE *stream)
{
	*json = (struct spec_json){.stream = stream};
}

static void
new_line(struct spec_json *json)
{
	fprintf(json->stream, "\n%*s", json->depth * INDENT, "");
}

static void
put_text(struct spec_json *json, const char *text, size_t size)
{
	const unsigned char *bytes = (const unsigned char *)text;

	fputc('"', json->stream);
	while (size > 0) {
		size_t length = spec_text_character(bytes, size);

		if (length == 0)
			fputs("\\ufffd", json->stream);
		else if (*bytes == '"' || *bytes == '\\')
			fprintf(json->stream, "\\%c", *bytes);
		else if (*bytes == '\n')
			fputs("\\n", json->stream);
		else if (*bytes == '\t')
			fputs("\\t", json->stream);
		else if (*bytes < ' ' || *bytes == 0x7f)
			fprintf(json->stream, "\\u%04x", *bytes);
		else
			fwrite(bytes, 1, length, json->stream);
		length += length == 0;
		bytes += length;
		size -= length;
	}
	fputc('"', json->stream);
}

/* What stands before a value: the comma of the one before, its place and its key. */
static void
put_key(struct spec_json *json, const char *key)
{
	if (json->depth > 0) {
		int in_line = json->level[json->depth - 1].shape == SPEC_JSON_INLINE;

		if (json->level[json->depth - 1].values++ > 0)
			fputs(in_line ? ", " : ",", json->stream);
		if (!in_line)
			new_line(json);
	}
	if (key) {
		put_text(json, key, strlen(key));
		fputs(": ", json->stream);
	}
}

void
spec_json_open(
	struct spec_json *json, const char *key, char bracket, enum spec_json_shape shape)
{
	put_key(json, key);
	fputc(bracket, json->stream);
	if (json->depth > 0 && json->level[json->depth - 1].shape == SPEC_JSON_INLINE)
		shape = SPEC_JSON_INLINE;
	json->level[json->depth].closing = bracket == '{' ? '}' : ']';
	json->level[json->depth].shape = shape;
	json->level[json->depth].values = 0;
	json->depth++;
}

void
spec_json_close(struct spec_json *json)
{
	json->depth--;
	if (json->level[json->depth].shape == SPEC_JSON_LINES &&
		json->level[json->depth].values > 0)
		new_line(json);
	fputc(json->level[json->depth].closing, json->stream);
	if (json->depth == 0)
		fputc('\n', json->stream);
}

void
spec_json_bytes(struct spec_json *json, const char *key, const char *bytes, size_t size)
{
	put_key(json, key);
	put_text(json, bytes, size);
}

void
spec_json_truth(struct spec_json *json, const char *key, int value)
{
	put_key(json, key);
	fputs(value ? "true" : "false", json->stream);
}

void
spec_json_null(struct spec_json *json, const char *key)
{
	put_key(json, key);
	fputs("null", json->stream);
}

void
spec_json_text(struct spec_json *json, const char *key, const char *text)
{
	if (text)
		spec_json_bytes(json, key, text, strlen(text));
	else
		spec_json_null(json, key);
}

void
spec_json_number(struct spec_json *json, const char *key, double value)
{
	char text[32];
	int digits = 15;

	if (!isfinite(value)) {
		spec_json_null(json, key);
		return;
	}
	do
		snprintf(text, sizeof text, "%.*g", digits, value);
	while (strtod(text, NULL) != value && digits++ < 17);
	put_key(json, key);
	fputs(text, json->stream);
}

void
spec_json_float(struct spec_json *json, const char *key, float value)
{
	char text[32];
	int digits = 6;

	if (!isfinite(value)) {
		spec_json_null(json, key);
		return;
	}
	do
		snprintf(text, sizeof text, "%.*g", digits, value);
	while (strtof(text, NULL) != value && digits++ < 9);
	put_key(json, key);
	fputs(text, json->stream);
}

void
spec_json_whole(struct spec_json *json, const char *key, long long value)
{
	put_key(json, key);
	fprintf(json->stream, "%lld", value);
}

void
spec_json_numbers(
	struct spec_json *json, const char *key, const double *value, size_t count)
{
	spec_json_open(json, key, '[', SPEC_JSON_INLINE);
	for (size_t i = 0; i < count; i++)
		spec_json_number(json, NULL, value[i]);
	spec_json_close(json);
}
