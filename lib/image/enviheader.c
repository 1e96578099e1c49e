#include "image/enviheader.h"

#include <ctype.h>
#include <stdlib.h>
#include <string.h>
#include <strings.h>

#include "base/memory.h"
#include "base/number.h"

#define MOST_FIELDS 4096

/* Where the parser stands. */
struct text {
	const char *at, *end, *name;
	int line;
};

size_t
envi_type_bytes(int type)
{
	switch (type) {
	case ENVI_U8:
		return 1;
	case ENVI_I16:
	case ENVI_U16:
		return 2;
	case ENVI_I32:
	case ENVI_F32:
	case ENVI_U32:
		return 4;
	case ENVI_F64:
	case ENVI_I64:
	case ENVI_U64:
		return 8;
	default:
		return 0;
	}
}

/* A copy of the bytes from..to, without blanks at either end. */
static char *
copy_trimmed(const char *from, const char *to, struct spec_error *error)
{
	while (from < to && isspace((unsigned char)*from))
		from++;
	while (to > from && isspace((unsigned char)to[-1]))
		to--;
	return spec_memory_text(from, (size_t)(to - from), error);
}

/* A key as it is compared: lower case, with single blanks. Our own are as we wrote them. */
static void
normalise_key(char *key)
{
	char *to = key;

	if (strncmp(key, "spec:", 5) == 0)
		return;
	for (const char *from = key; *from; from++) {
		if (isspace((unsigned char)*from) && to > key && to[-1] == ' ')
			continue;
		*to++ = isspace((unsigned char)*from) ? ' '
						      : (char)tolower((unsigned char)*from);
	}
	*to = '\0';
}

static const char *
line_end(const struct text *text)
{
	const char *end = memchr(text->at, '\n', (size_t)(text->end - text->at));

	return end ? end : text->end;
}

/* The value behind the equals sign at text->at: up to the line's end, or to a brace. */
static enum spec_status
take_value(struct text *text, char **value, struct spec_error *error)
{
	const char *end = line_end(text);
	int first = text->line;

	while (text->at < end && (*text->at == ' ' || *text->at == '\t'))
		text->at++;
	if (text->at < end && *text->at == '{') {
		const char *brace = memchr(text->at, '}', (size_t)(text->end - text->at));

		if (!brace)
			return spec_error_set(error, SPEC_EFORMAT,
				"%s:%d: a brace is not closed", text->name, first);
		for (const char *at = text->at; at < brace; at++)
			text->line += *at == '\n';
		*value = copy_trimmed(text->at + 1, brace, error);
		text->at = brace;
		end = line_end(text);
	} else {
		*value = copy_trimmed(text->at, end, error);
	}
	text->at = end < text->end ? end + 1 : end;
	text->line++;
	return *value ? SPEC_OK : SPEC_ENOMEM;
}

const char *
envi_header_find(const struct envi_header *header, const char *key)
{
	for (size_t i = 0; i < header->fields; i++) {
		if (strcmp(header->field[i].key, key) == 0)
			return header->field[i].value;
	}
	return NULL;
}

static enum spec_status
take_field(struct text *text, struct envi_header *header, struct spec_error *error)
{
	const char *end = line_end(text), *equals, *known;
	int first = text->line;
	void *list = header->field;
	struct envi_field field = {0};
	enum spec_status status;

	while (text->at < end && isspace((unsigned char)*text->at))
		text->at++;
	equals = memchr(text->at, '=', (size_t)(end - text->at));
	if (text->at == end || *text->at == ';') { /* nothing, or a comment */
		text->at = end < text->end ? end + 1 : end;
		text->line++;
		return SPEC_OK;
	}
	if (!equals)
		return spec_error_set(error, SPEC_EFORMAT,
			"%s:%d: is neither 'key = value' nor a comment", text->name,
			text->line);
	if (header->fields >= MOST_FIELDS)
		return spec_error_set(error, SPEC_ERANGE, "%s:%d: more than %d fields",
			text->name, text->line, MOST_FIELDS);
	status = spec_memory_grow(&list, &header->room, header->fields + 1,
		sizeof *header->field, "fields", error);
	header->field = list;
	if (status != SPEC_OK)
		return status;
	field.key = copy_trimmed(text->at, equals, error);
	text->at = equals + 1;
	status = field.key ? take_value(text, &field.value, error) : SPEC_ENOMEM;
	if (status != SPEC_OK) {
		free(field.key);
		return status;
	}
	normalise_key(field.key);
	known = envi_header_find(header, field.key);
	if (known && strcmp(known, field.value) != 0)
		status = spec_error_set(error, SPEC_EFORMAT,
			"%s:%d: '%.60s' is there twice, with other values", text->name,
			first, field.key);
	header->field[header->fields++] = field;
	return status;
}

/* A whole number; value stays what it was where there is no such key and none is needed. */
static enum spec_status
get_whole(const struct envi_header *header, const char *key, int needed, long long least,
	long long most, const char *name, long long *value, struct spec_error *error)
{
	const char *text = envi_header_find(header, key);
	enum spec_status status;

	if (!text)
		return needed ? spec_error_set(
					error, SPEC_EFORMAT, "%s: has no '%s'", name, key)
			      : SPEC_OK;
	status = spec_number_parse_whole(text, least, most, key, value, error);
	if (status != SPEC_OK)
		spec_error_prefix(error, "%s", name);
	return status;
}

static enum spec_status
get_type(struct envi_header *header, const char *name, struct spec_error *error)
{
	long long type = 0, order = 0;
	enum spec_status status =
		get_whole(header, "data type", 1, 0, 99, name, &type, error);

	if (status == SPEC_OK && (type == 6 || type == 9))
		return spec_error_set(
			error, SPEC_EUNSUPPORTED, "%s: holds complex numbers", name);
	if (status == SPEC_OK && envi_type_bytes((int)type) == 0)
		return spec_error_set(error, SPEC_EFORMAT,
			"%s: the data type %lld is unknown", name, type);
	header->type = (int)type;
	if (status == SPEC_OK)
		status = get_whole(header, "byte order", envi_type_bytes((int)type) > 1, 0,
			1, name, &order, error);
	header->swapped = order != (__BYTE_ORDER__ == __ORDER_BIG_ENDIAN__);
	return status;
}

static enum spec_status
get_interleave(struct envi_header *header, const char *name, struct spec_error *error)
{
	static const char *const names[] = {"bsq", "bil", "bip"};
	const char *text = envi_header_find(header, "interleave");

	for (int i = 0; text && i < 3; i++) {
		if (strcasecmp(text, names[i]) == 0) {
			header->interleave = (enum envi_interleave)i;
			return SPEC_OK;
		}
	}
	return spec_error_set(error, SPEC_EFORMAT,
		text ? "%s: the interleave is not bsq, bil or bip"
		     : "%s: has no 'interleave'",
		name);
}

static enum spec_status
get_layout(struct envi_header *header, const char *name, struct spec_error *error)
{
	const char *packed = envi_header_find(header, "file compression");
	enum spec_status status =
		get_whole(header, "samples", 1, 1, 1 << 30, name, &header->samples, error);

	if (status == SPEC_OK)
		status = get_whole(
			header, "lines", 1, 1, 1 << 30, name, &header->lines, error);
	if (status == SPEC_OK)
		status = get_whole(
			header, "bands", 1, 1, 1 << 20, name, &header->bands, error);
	if (status == SPEC_OK)
		status = get_whole(header, "header offset", 0, 0, 1LL << 50, name,
			&header->offset, error);
	if (status == SPEC_OK)
		status = get_type(header, name, error);
	if (status == SPEC_OK)
		status = get_interleave(header, name, error);
	if (status == SPEC_OK && packed && strcmp(packed, "0") != 0)
		status = spec_error_set(
			error, SPEC_EUNSUPPORTED, "%s: its data are compressed", name);
	return status;
}

enum spec_status
envi_header_parse(const char *text, size_t size, const char *name,
	struct envi_header *header, struct spec_error *error)
{
	struct text parser = {text, text + size, name, 1};
	enum spec_status status = SPEC_OK;

	*header = (struct envi_header){0};
	if (size < 4 || memcmp(text, "ENVI", 4) != 0 || memchr(text, '\0', size))
		return spec_error_set(
			error, SPEC_EFORMAT, "%s: is no header of ENVI's", name);
	parser.at = line_end(&parser);
	parser.at += parser.at < parser.end;
	parser.line = 2;
	while (parser.at < parser.end && status == SPEC_OK)
		status = take_field(&parser, header, error);
	if (status == SPEC_OK)
		status = get_layout(header, name, error);
	if (status != SPEC_OK)
		envi_header_free(header);
	return status;
}

void
envi_header_free(struct envi_header *header)
{
	for (size_t i = 0; i < header->fields; i++) {
		free(header->field[i].key);
		free(header->field[i].value);
	}
	free(header->field);
	*header = (struct envi_header){0};
}

/* What is written by its number; an end is the first or the last character. */
static int
is_coded(char character, int end)
{
	return strchr("{}%", character) || (end && isspace((unsigned char)character));
}

void
envi_text_write(FILE *file, const char *text, size_t size)
{
	for (size_t i = 0; i < size; i++) {
		if (is_coded(text[i], i == 0 || i + 1 == size))
			fprintf(file, "%%%02X", (unsigned char)text[i]);
		else
			fputc(text[i], file);
	}
}

static int
hexadecimal(char digit)
{
	static const char digits[] = "0123456789ABCDEF";
	const char *found = digit ? strchr(digits, digit) : NULL;

	return found ? (int)(found - digits) : -1;
}

void
envi_text_decode(char *text)
{
	char *to = text;

	while (*text) {
		int high = *text == '%' ? hexadecimal(text[1]) : -1,
		    low = high >= 0 ? hexadecimal(text[2]) : -1;
		char character = (char)(high * 16 + low);

		if (low >= 0 && character && is_coded(character, 1)) {
			*to++ = character;
			text += 3;
		} else {
			*to++ = *text++;
		}
	}
	*to = '\0';
}

enum spec_status
envi_header_numbers(const struct envi_header *header, const char *key, const char *name,
	double **number, struct spec_error *error)
{
	const char *text = envi_header_find(header, key);
	size_t count = 0;

	*number = NULL;
	if (!text)
		return SPEC_OK;
	*number = spec_memory_new((size_t)header->bands, sizeof **number, "bands", error);
	if (!*number)
		return SPEC_ENOMEM;
	while (*text) {
		double value;
		size_t length = spec_number_scan(text, '.', &value);

		if (length == 0 || count == (size_t)header->bands)
			break;
		(*number)[count++] = value;
		text += length;
		text += strspn(text, " \t\r\n");
		if (*text == ',')
			text += 1 + strspn(text + 1, " \t\r\n");
	}
	if (count == (size_t)header->bands && !*text)
		return SPEC_OK;
	free(*number);
	*number = NULL;
	return spec_error_set(error, SPEC_EFORMAT,
		"%s: '%s' is not %lld numbers, one for each band", name, key,
		header->bands);
}
