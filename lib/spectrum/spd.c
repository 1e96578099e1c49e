#include "spectrum/spd.h"

#include <errno.h>
#include <math.h>
#include <stdarg.h>
#include <stdlib.h>
#include <string.h>

#include "base/memory.h"
#include "base/number.h"
#include "base/output.h"
#include "base/text.h"

#define FIRST_COLUMN "wavelength_nm"
#define BLANKS " \t"
#define CHUNK 65536 /* bytes read at once */

/* What is known of a file while its lines come in. */
struct parser {
	const char *name;
	struct spec_error *error;
	size_t line; /* counts from 1 */
	char *text;  /* the line so far, room for SPEC_SPD_LONGEST_LINE + 2 bytes */
	size_t length;
	char *title, *quantity, *unit, *source, *medium, *columns; /* null: not seen */
	double *number; /* row after row, a wavelength and its values */
	size_t room, rows, width;
};

static enum spec_status fail(const struct parser *parser, enum spec_status status,
	const char *format, ...) __attribute__((format(printf, 3, 4)));

static enum spec_status
fail(const struct parser *parser, enum spec_status status, const char *format, ...)
{
	char cause[512];
	va_list arguments;

	va_start(arguments, format);
	vsnprintf(cause, sizeof cause, format, arguments);
	va_end(arguments);
	return spec_error_set(
		parser->error, status, "%s:%zu: %s", parser->name, parser->line, cause);
}

static enum spec_status
fail_long(const struct parser *parser)
{
	return fail(parser, SPEC_ERANGE, "the line is longer than %d bytes",
		SPEC_SPD_LONGEST_LINE);
}

/* The next of several words, which blanks and at most one comma separate. */
static size_t
word_length(const char *text)
{
	return strcspn(text, BLANKS ",");
}

/* Steps over blanks and at most one comma; *comma tells whether there was one. */
static const char *
skip_separator(const char *text, int *comma)
{
	text += strspn(text, BLANKS);
	*comma = *text == ',';
	return *comma ? text + 1 + strspn(text + 1, BLANKS) : text;
}

/* Checks a line "wavelength_nm NAME…" and keeps it until the table is complete. */
static enum spec_status
parse_columns(struct parser *parser, const char *text)
{
	const char *at = text;
	size_t count = 0;
	int comma = 0;

	if (parser->columns)
		return fail(parser, SPEC_EFORMAT, "the columns are named twice");
	while (*at || comma) {
		size_t length = word_length(at);

		if (length == 0)
			return fail(parser, SPEC_EFORMAT, "a column has no name");
		if (count++ == 0 && (length != strlen(FIRST_COLUMN) ||
					    strncmp(at, FIRST_COLUMN, length) != 0))
			return fail(parser, SPEC_EFORMAT,
				"the first column is not " FIRST_COLUMN " but '%.*s'",
				(int)(length < 40 ? length : 40), at);
		at = skip_separator(at + length, &comma);
	}
	if (count < 2)
		return fail(parser, SPEC_EFORMAT,
			"the columns are not " FIRST_COLUMN " and others");
	parser->width = count;
	parser->columns = spec_memory_text(text, strlen(text), parser->error);
	return parser->columns ? SPEC_OK : SPEC_ENOMEM;
}

/* text: a line from behind its '#' on. Lines that are not ours are comments. */
static enum spec_status
parse_header(struct parser *parser, const char *text)
{
	const struct {
		const char *key;
		char **value;
	} keys[] = {{"title:", &parser->title}, {"quantity:", &parser->quantity},
		{"unit:", &parser->unit}, {"source:", &parser->source},
		{"medium:", &parser->medium}};

	if (parser->rows > 0)
		return SPEC_OK;
	text += strspn(text, BLANKS);
	if (strncmp(text, "columns:", 8) == 0)
		return parse_columns(parser, text + 8 + strspn(text + 8, BLANKS));
	for (size_t i = 0; i < sizeof keys / sizeof keys[0]; i++) {
		size_t length = strlen(keys[i].key);

		if (strncmp(text, keys[i].key, length) != 0)
			continue;
		if (*keys[i].value)
			return fail(parser, SPEC_EFORMAT, "the header has '%s' twice",
				keys[i].key);
		text += length + strspn(text + length, BLANKS);
		*keys[i].value = spec_memory_text(text, strlen(text), parser->error);
		if (!*keys[i].value)
			return SPEC_ENOMEM;
		break;
	}
	if (parser->medium && *parser->medium && strcmp(parser->medium, "air") != 0 &&
		strcmp(parser->medium, "vacuum") != 0)
		return fail(parser, SPEC_EFORMAT,
			"the medium is neither air nor vacuum: '%.40s'", parser->medium);
	return SPEC_OK;
}

/* Takes in the numbers of a row, before anything is known but that they are numbers. */
static enum spec_status
parse_numbers(struct parser *parser, size_t *count)
{
	const char *at = parser->text + strspn(parser->text, BLANKS);
	int comma = 0;

	for (*count = 0; *at || comma; ++*count) {
		size_t used = parser->rows * parser->width + *count, word = word_length(at);
		enum spec_status status = spec_memory_grow((void **)&parser->number,
			&parser->room, used + 1, sizeof(double), "values", parser->error);

		if (status != SPEC_OK)
			return status;
		if (word == 0)
			return fail(
				parser, SPEC_EFORMAT, "a value is missing beside a comma");
		if (spec_number_scan(at, '.', &parser->number[used]) != word)
			return fail(parser, SPEC_EFORMAT, "'%.*s' is not a finite number",
				(int)(word < 40 ? word : 40), at);
		at = skip_separator(at + word, &comma);
	}
	return SPEC_OK;
}

static enum spec_status
parse_row(struct parser *parser)
{
	size_t count;
	const double *row;
	enum spec_status status;

	if (parser->rows == SPEC_SPD_MOST_ROWS)
		return fail(parser, SPEC_ERANGE, "more than %d rows", SPEC_SPD_MOST_ROWS);
	status = parse_numbers(parser, &count);
	if (status != SPEC_OK)
		return status;
	if (count < 2)
		return fail(parser, SPEC_EFORMAT, "a row needs a wavelength and a value");
	if (parser->width == 0)
		parser->width = count;
	if (count != parser->width)
		return fail(parser, SPEC_EFORMAT, "%zu numbers where the %s %zu", count,
			parser->rows > 0 ? "rows above have" : "header names",
			parser->width);
	row = parser->number + parser->rows * parser->width;
	if (!(row[0] > 0))
		return fail(parser, SPEC_EFORMAT, "the wavelength %.10g nm is not positive",
			row[0]);
	if (parser->rows > 0 && !(row[0] > row[-(ptrdiff_t)parser->width]))
		return fail(parser, SPEC_EFORMAT,
			"the wavelength %.10g nm does not lie above the one before, %.10g "
			"nm",
			row[0], row[-(ptrdiff_t)parser->width]);
	parser->rows++;
	return SPEC_OK;
}

/* Takes in the line that has been gathered, without its line break. */
static enum spec_status
parse_line(struct parser *parser)
{
	static const char mark[] = "\xef\xbb\xbf"; /* UTF-8's byte order mark */
	char *text = parser->text;

	if (parser->length > 0 && text[parser->length - 1] == '\r')
		parser->length--;
	if (parser->length > SPEC_SPD_LONGEST_LINE)
		return fail_long(parser);
	if (memchr(text, '\0', parser->length))
		return fail(parser, SPEC_EFORMAT, "a zero byte, so this is no text");
	if (parser->line == 1 && parser->length >= 3 && memcmp(text, mark, 3) == 0) {
		parser->length -= 3;
		memmove(text, text + 3, parser->length);
	}
	while (parser->length > 0 && strchr(BLANKS, text[parser->length - 1]))
		parser->length--;
	text[parser->length] = '\0';
	parser->length = 0;
	text += strspn(text, BLANKS);
	if (*text == '\0')
		return SPEC_OK;
	if (*text == '#')
		return parse_header(parser, text + 1);
	/* The first line of a CSV file. */
	if (parser->rows == 0 && strncmp(text, FIRST_COLUMN, strlen(FIRST_COLUMN)) == 0)
		return parse_columns(parser, text);
	return parse_row(parser);
}

/* Takes in the next bytes of the file, which may end anywhere in a line. */
static enum spec_status
feed(struct parser *parser, const char *bytes, size_t size)
{
	enum spec_status status = SPEC_OK;

	while (status == SPEC_OK && size > 0) {
		const char *end = memchr(bytes, '\n', size);
		size_t length = end ? (size_t)(end - bytes) : size;
		/* One byte more than a line may have, for a carriage return. */
		size_t left = SPEC_SPD_LONGEST_LINE + 1 - parser->length;

		if (parser->length == 0)
			parser->line++;
		if (length > left)
			return fail_long(parser);
		memcpy(parser->text + parser->length, bytes, length);
		parser->length += length;
		if (end)
			status = parse_line(parser);
		bytes += length + (end != NULL);
		size -= length + (end != NULL);
	}
	return status;
}

/* Moves the header's texts and columns into the curve. */
static enum spec_status
finish_header(struct parser *parser, struct spec_curve *curve)
{
	char **from[] = {&parser->title, &parser->quantity, &parser->unit, &parser->source,
		&parser->medium};
	char **to[] = {&curve->title, &curve->quantity, &curve->unit, &curve->source,
		&curve->medium};
	const char *at = parser->columns;
	int comma;

	for (size_t i = 0; i < sizeof to / sizeof to[0]; i++) {
		char *old = *to[i];

		if (!*from[i])
			continue;
		*to[i] = *from[i];
		*from[i] = old;
	}
	if (!at)
		return SPEC_OK;
	for (size_t i = 0; i < curve->columns; i++) {
		size_t length;
		char *name;

		at = skip_separator(at + word_length(at), &comma);
		length = word_length(at);
		name = spec_memory_text(at, length, parser->error);
		if (!name)
			return SPEC_ENOMEM;
		free(curve->column[i]);
		curve->column[i] = name;
	}
	return SPEC_OK;
}

static enum spec_status
finish(struct parser *parser, struct spec_curve *curve)
{
	enum spec_status status = SPEC_OK;

	if (parser->length > 0)
		status = parse_line(parser);
	if (status == SPEC_OK && parser->rows == 0)
		status = spec_error_set(parser->error, SPEC_EFORMAT,
			"%s:%zu: the file ends without a row", parser->name, parser->line);
	if (status == SPEC_OK)
		status = spec_curve_new(
			parser->rows, parser->width - 1, curve, parser->error);
	if (status == SPEC_OK)
		status = finish_header(parser, curve);
	if (status != SPEC_OK)
		return status;
	for (size_t i = 0; i < curve->count; i++) {
		const double *row = parser->number + i * parser->width;

		curve->wavelength_nm[i] = row[0];
		for (size_t j = 0; j < curve->columns; j++)
			curve->value[j * curve->count + i] = row[1 + j];
	}
	return SPEC_OK;
}

static enum spec_status
parser_open(struct parser *parser, const char *name, struct spec_error *error)
{
	*parser = (struct parser){.name = name, .error = error};
	parser->text =
		spec_memory_new(SPEC_SPD_LONGEST_LINE + 2, 1, "bytes of a line", error);
	return parser->text ? SPEC_OK : SPEC_ENOMEM;
}

static void
parser_close(struct parser *parser)
{
	free(parser->text);
	free(parser->title);
	free(parser->quantity);
	free(parser->unit);
	free(parser->source);
	free(parser->medium);
	free(parser->columns);
	free(parser->number);
}

enum spec_status
spec_spd_parse(const char *text, size_t size, const char *name, struct spec_curve *curve,
	struct spec_error *error)
{
	struct parser parser;
	enum spec_status status = parser_open(&parser, name, error);

	*curve = (struct spec_curve){0};
	if (status == SPEC_OK)
		status = feed(&parser, text, size);
	if (status == SPEC_OK)
		status = finish(&parser, curve);
	if (status != SPEC_OK)
		spec_curve_free(curve);
	parser_close(&parser);
	return status;
}

enum spec_status
spec_spd_read(
	FILE *file, const char *name, struct spec_curve *curve, struct spec_error *error)
{
	struct parser parser;
	enum spec_status status = parser_open(&parser, name, error);
	char *chunk = spec_memory_new(CHUNK, 1, "bytes", error);
	size_t size;

	*curve = (struct spec_curve){0};
	if (!chunk)
		status = SPEC_ENOMEM;
	while (status == SPEC_OK && (size = fread(chunk, 1, CHUNK, file)) > 0)
		status = feed(&parser, chunk, size);
	if (status == SPEC_OK && ferror(file))
		status = spec_error_system(error, errno, "unable to read '%s'", name);
	if (status == SPEC_OK)
		status = finish(&parser, curve);
	if (status != SPEC_OK)
		spec_curve_free(curve);
	free(chunk);
	parser_close(&parser);
	return status;
}

enum spec_status
spec_spd_load(const char *path, struct spec_curve *curve, struct spec_error *error)
{
	FILE *file = fopen(path, "rbe");
	enum spec_status status;

	*curve = (struct spec_curve){0};
	if (!file)
		return spec_error_system(error, errno, "unable to open '%s'", path);
	status = spec_spd_read(file, path, curve, error);
	fclose(file); /* opened for reading: nothing can be lost here */
	return status;
}

size_t
spec_spd_format_number(double value, char *text)
{
	char digits[SPEC_SPD_NUMBER];
	int precision = 0, exponent;

	/* The first that reads back: 17 digits always do. */
	do
		snprintf(digits, sizeof digits, "%.*e", precision++, value);
	while (strtod(digits, NULL) != value && precision < 17);
	exponent = (int)strtol(strchr(digits, 'e') + 1, NULL, 10);
	if (exponent < -5 || exponent > 15)
		return (size_t)snprintf(text, SPEC_SPD_NUMBER, "%s", digits);
	precision = precision - 1 - exponent;
	return (size_t)snprintf(
		text, SPEC_SPD_NUMBER, "%.*f", precision > 0 ? precision : 0, value);
}

/* Whether a text reads back as it is: no control characters, no blanks around it. */
static int
text_fits(const char *text)
{
	size_t length = strlen(text);

	if (length > SPEC_SPD_LONGEST_LINE / 2)
		return 0;
	for (size_t i = 0; i < length; i++)
		if ((unsigned char)text[i] < ' ' || text[i] == 127)
			return 0;
	return length == 0 || (text[0] != ' ' && text[length - 1] != ' ');
}

static int
medium_fits(const char *medium)
{
	return !*medium || strcmp(medium, "air") == 0 || strcmp(medium, "vacuum") == 0;
}

static enum spec_status
check_texts(const struct spec_curve *curve, struct spec_error *error)
{
	const char *texts[] = {curve->title, curve->quantity, curve->unit, curve->source};
	size_t line = 0;

	for (size_t i = 0; i < sizeof texts / sizeof texts[0]; i++)
		if (!text_fits(texts[i]))
			return spec_error_set(error, SPEC_ERANGE,
				"no line of an spd file can hold the text '%.200s'",
				texts[i]);
	if (!medium_fits(curve->medium))
		return spec_error_set(error, SPEC_ERANGE,
			"the medium is neither air nor vacuum: '%.40s'", curve->medium);
	for (size_t i = 0; i < curve->columns; i++) {
		const char *name = curve->column[i];

		if (!*name || name[word_length(name)] || !text_fits(name))
			return spec_error_set(error, SPEC_ERANGE,
				"'%.200s' cannot be the name of a column", name);
		line += strlen(name) + 1;
	}
	/* Neither the line that names the columns nor a row may be too long to be read. */
	if (line > SPEC_SPD_LONGEST_LINE / 2 ||
		curve->columns >= SPEC_SPD_LONGEST_LINE / SPEC_SPD_NUMBER ||
		curve->count > SPEC_SPD_MOST_ROWS)
		return spec_error_set(error, SPEC_ERANGE,
			"the table of %zu columns and %zu rows is too large for an spd "
			"file",
			curve->columns, curve->count);
	return SPEC_OK;
}

static enum spec_status
check_numbers(const struct spec_curve *curve, struct spec_error *error)
{
	double before = 0;

	for (size_t i = 0; i < curve->count; i++) {
		if (!(curve->wavelength_nm[i] > before) ||
			!isfinite(curve->wavelength_nm[i]))
			return spec_error_set(error, SPEC_ERANGE,
				"wavelength %.10g nm of '%.200s' is not finite, positive "
				"and ascending",
				curve->wavelength_nm[i], curve->title);
		before = curve->wavelength_nm[i];
	}
	for (size_t i = 0; i < curve->count * curve->columns; i++)
		if (!isfinite(curve->value[i]))
			return spec_error_set(error, SPEC_ERANGE,
				"the value of '%.200s' at %.10g nm is not finite",
				curve->title, curve->wavelength_nm[i % curve->count]);
	return SPEC_OK;
}

static void
write_header(FILE *file, const struct spec_curve *curve)
{
	static const char *const keys[] = {"title", "quantity", "unit", "source", "medium"};
	const char *texts[] = {
		curve->title, curve->quantity, curve->unit, curve->source, curve->medium};

	for (size_t i = 0; i < sizeof keys / sizeof keys[0]; i++)
		if (*texts[i])
			fprintf(file, "# %s: %s\n", keys[i], texts[i]);
	fputs("# columns: " FIRST_COLUMN, file);
	for (size_t i = 0; i < curve->columns; i++)
		fprintf(file, " %s", curve->column[i]);
	fputc('\n', file);
}

enum spec_status
spec_spd_write(FILE *file, const struct spec_curve *curve, struct spec_error *error)
{
	enum spec_status status = check_texts(curve, error);
	char text[SPEC_SPD_NUMBER];

	if (status == SPEC_OK)
		status = check_numbers(curve, error);
	if (status != SPEC_OK)
		return status;
	errno = 0;
	write_header(file, curve);
	for (size_t i = 0; i < curve->count && !ferror(file); i++) {
		spec_spd_format_number(curve->wavelength_nm[i], text);
		fputs(text, file);
		for (size_t j = 0; j < curve->columns; j++) {
			spec_spd_format_number(curve->value[j * curve->count + i], text);
			fprintf(file, " %s", text);
		}
		fputc('\n', file);
	}
	if (fflush(file) != 0 || ferror(file))
		return spec_error_system(
			error, errno ? errno : EIO, "unable to write the spectrum");
	return SPEC_OK;
}

enum spec_status
spec_spd_save(const char *path, const struct spec_curve *curve, struct spec_error *error)
{
	struct spec_text text;
	enum spec_status status = spec_text_open(&text, error);

	if (status != SPEC_OK)
		return status;
	status = spec_spd_write(text.stream, curve, error);
	if (status == SPEC_OK)
		status = spec_text_close(&text, error);
	if (status == SPEC_OK)
		status = spec_output_save(path, text.bytes, text.size, error);
	spec_text_free(&text);
	return status;
}
