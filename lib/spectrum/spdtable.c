/* Reading the lines of a file in the format of spd(5). */
#include "spectrum/spdtable.h"

#include <errno.h>
#include <math.h>
#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <strings.h>

#include "base/memory.h"
#include "base/number.h"
#include "spectrum/spd.h"

#define FIRST_COLUMN "wavelength_nm"
#define LINE "line"
#define BLANKS " \t"
#define CHUNK 65536 /* bytes read at once */

/* What is known of a file while its lines come in. */
struct parser {
	const char *name;
	struct spec_error *error;
	size_t line; /* counts from 1 */
	char *text;  /* the line so far, room for SPEC_SPD_LONGEST_LINE + 2 bytes */
	size_t length;
	struct spec_spd_table *table;
	char *representation, *interpolation, *range; /* null: not seen */
	size_t range_line;
};

/* By the order of enum spec_spectrum_kind; null: wavelength_nm and others. */
static const char *const columns_of[] = {"level", "temperature_K level",
	"red green blue scale c0_per_nm2 c1_per_nm c2", "order cosine sine", NULL, NULL};

const char *
spec_spd_columns(enum spec_spectrum_kind kind)
{
	return columns_of[kind];
}

static enum spec_status fail(const struct parser *parser, enum spec_status status,
	const char *format, ...) __attribute__((format(printf, 3, 4)));

static enum spec_status
fail(const struct parser *parser, enum spec_status status, const char *format, ...)
{
	va_list arguments;

	va_start(arguments, format);
	spec_error_vset(parser->error, status, format, arguments);
	va_end(arguments);
	spec_error_prefix(parser->error, "%s:%zu", parser->name, parser->line);
	return status;
}

static enum spec_status
fail_long(const struct parser *parser)
{
	return fail(parser, SPEC_ERANGE, "the line is longer than %d bytes",
		SPEC_SPD_LONGEST_LINE);
}

/* The next of several words, which blanks and at most one comma separate. */
size_t
spec_spd_word(const char *text)
{
	return strcspn(text, BLANKS ",");
}

/* Steps over blanks and at most one comma; *comma tells whether there was one. */
const char *
spec_spd_skip(const char *text, int *comma)
{
	text += strspn(text, BLANKS);
	*comma = *text == ',';
	return *comma ? text + 1 + strspn(text + 1, BLANKS) : text;
}

/* Whether two texts have the same words. */
static int
same_words(const char *a, const char *b)
{
	int comma;

	while (*a && *b) {
		size_t length = spec_spd_word(a);

		if (length == 0 || length != spec_spd_word(b) || strncmp(a, b, length) != 0)
			return 0;
		a = spec_spd_skip(a + length, &comma);
		b = spec_spd_skip(b + length, &comma);
	}
	return !*a && !*b;
}

/* The names of columns: how many, if they are what the kind of the table wants. */
static enum spec_status
count_columns(const struct parser *parser, const char *text, size_t *count)
{
	const char *wanted = spec_spd_columns(parser->table->kind), *at = text;
	int comma = 0;

	for (*count = 0; *at || comma; ++*count) {
		size_t length = spec_spd_word(at);

		if (length == 0)
			return fail(parser, SPEC_EFORMAT, "a column has no name");
		if (!wanted && *count == 0 &&
			(length != strlen(FIRST_COLUMN) ||
				strncmp(at, FIRST_COLUMN, length) != 0))
			return fail(parser, SPEC_EFORMAT,
				"the first column is not " FIRST_COLUMN " but '%.*s'",
				(int)(length < 40 ? length : 40), at);
		at = spec_spd_skip(at + length, &comma);
	}
	if (!wanted && *count < 2)
		return fail(parser, SPEC_EFORMAT,
			"the columns are not " FIRST_COLUMN " and others");
	if (wanted && !same_words(text, wanted))
		return fail(parser, SPEC_EFORMAT, "the columns are not '%s'", wanted);
	return SPEC_OK;
}

/*
 * From behind the name of the wavelengths in the line of names of a CSV file, or null where
 * it has none: other programs write a blank, brackets or no unit.
 */
static const char *
skip_first_name(const char *text)
{
	static const char *const names[] = {FIRST_COLUMN, "wavelength (nm)",
		"wavelength(nm)", "wavelength [nm]", "wavelength[nm]", "wavelength"};

	for (size_t i = 0; i < sizeof names / sizeof names[0]; i++) {
		size_t length = strlen(names[i]);

		if (strncasecmp(text, names[i], length) == 0 &&
			spec_spd_word(text + length) == 0)
			return text + length;
	}
	return NULL;
}

/* Keeps the names of the columns until the table is complete. */
static enum spec_status
parse_columns(struct parser *parser, const char *text)
{
	size_t count;
	enum spec_status status;

	if (parser->table->columns)
		return fail(parser, SPEC_EFORMAT, "the columns are named twice");
	status = count_columns(parser, text, &count);
	if (status != SPEC_OK)
		return status;
	parser->table->width = count;
	parser->table->columns = spec_memory_text(text, strlen(text), parser->error);
	return parser->table->columns ? SPEC_OK : SPEC_ENOMEM;
}

/* The same of a CSV file's line of names, from behind the first. */
static enum spec_status
parse_names(struct parser *parser, const char *rest)
{
	size_t size = strlen(FIRST_COLUMN) + strlen(rest) + 1;
	char *names = spec_memory_new(size, 1, "names of columns", parser->error);
	enum spec_status status;

	if (!names)
		return SPEC_ENOMEM;
	snprintf(names, size, "%s%s", FIRST_COLUMN, rest);
	status = parse_columns(parser, names);
	free(names);
	return status;
}

static enum spec_status
parse_representation(struct parser *parser)
{
	const char *text = parser->representation;

	if (parser->table->columns)
		return fail(parser, SPEC_EFORMAT,
			"the representation is named below the columns");
	for (int i = 0; i < SPEC_SPECTRUM_COMPOSITE; i++) {
		parser->table->kind = (enum spec_spectrum_kind)i;
		if (strcmp(text, spec_spectrum_kind_name(parser->table->kind)) == 0)
			return SPEC_OK;
	}
	return fail(parser, SPEC_EFORMAT, "there is no representation '%.40s'", text);
}

static enum spec_status
parse_range(struct parser *parser)
{
	struct spec_spd_table *table = parser->table;
	const char *at = parser->range;
	double *number[] = {&table->low_nm, &table->high_nm};
	int comma;

	for (int i = 0; i < 2; i++) {
		size_t word = spec_spd_word(at);

		if (word == 0 || spec_number_scan(at, '.', number[i]) != word)
			return fail(parser, SPEC_EFORMAT, "the range is not two numbers");
		at = spec_spd_skip(at + word, &comma);
	}
	if (*at || !(table->low_nm > 0 && table->low_nm < table->high_nm))
		return fail(parser, SPEC_EFORMAT,
			"the range is not two wavelengths, the smaller first: '%.60s'",
			parser->range);
	return SPEC_OK;
}

/* What a line of the header means beyond its text. */
static enum spec_status
take_key(struct parser *parser, char **value)
{
	const char *medium = parser->table->medium;

	if (value == &parser->representation)
		return parse_representation(parser);
	if (value == &parser->range)
		parser->range_line = parser->line; /* what it is of comes later, perhaps */
	if (value == &parser->interpolation &&
		spec_interpolate_parse(*value, &parser->table->interpolate, NULL) !=
			SPEC_OK)
		return fail(parser, SPEC_EFORMAT,
			"the interpolation is not linear, nearest, left or sprague: '%.40s'",
			*value);
	if (value == &parser->table->medium && *medium && strcmp(medium, "air") != 0 &&
		strcmp(medium, "vacuum") != 0)
		return fail(parser, SPEC_EFORMAT,
			"the medium is neither air nor vacuum: '%.40s'", medium);
	return SPEC_OK;
}

/* text: a line from behind its '#' on. Lines that are not ours are comments. */
static enum spec_status
parse_header(struct parser *parser, const char *text)
{
	const struct {
		const char *key;
		char **value;
	} keys[] = {{"title:", &parser->table->title},
		{"quantity:", &parser->table->quantity}, {"unit:", &parser->table->unit},
		{"source:", &parser->table->source}, {"medium:", &parser->table->medium},
		{"representation:", &parser->representation},
		{"interpolation:", &parser->interpolation}, {"range:", &parser->range}};

	if (parser->table->rows + parser->table->lines > 0)
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
		return *keys[i].value ? take_key(parser, keys[i].value) : SPEC_ENOMEM;
	}
	return SPEC_OK;
}

/* Takes in the numbers of a row, before anything is known but that they are numbers. */
static enum spec_status
parse_numbers(struct parser *parser, const char *at, size_t *count)
{
	int comma = 0;

	for (*count = 0; *at || comma; ++*count) {
		size_t used = parser->table->rows * parser->table->width + *count,
		       word = spec_spd_word(at);
		enum spec_status status = spec_memory_grow((void **)&parser->table->number,
			&parser->table->room, used + 1, sizeof(double), "values",
			parser->error);

		if (status != SPEC_OK)
			return status;
		if (word == 0)
			return fail(
				parser, SPEC_EFORMAT, "a value is missing beside a comma");
		if (spec_number_scan(at, '.', &parser->table->number[used]) != word)
			return fail(parser, SPEC_EFORMAT, "'%.*s' is not a finite number",
				(int)(word < 40 ? word : 40), at);
		at = spec_spd_skip(at + word, &comma);
	}
	return SPEC_OK;
}

/* A row of a table: its wavelength. */
static enum spec_status
check_wavelength(const struct parser *parser, const double *row)
{
	const struct spec_spd_table *table = parser->table;

	if (!(row[0] > 0))
		return fail(parser, SPEC_EFORMAT, "the wavelength %.10g nm is not positive",
			row[0]);
	if (table->rows > 0 && !(row[0] > row[-(ptrdiff_t)table->width]))
		return fail(parser, SPEC_EFORMAT,
			"the wavelength %.10g nm does not lie above the one before, %.10g "
			"nm",
			row[0], row[-(ptrdiff_t)table->width]);
	return SPEC_OK;
}

/* A row of another kind. */
static enum spec_status
check_row(const struct parser *parser, const double *row)
{
	const struct spec_spd_table *table = parser->table;

	if (!spec_spd_columns(table->kind))
		return check_wavelength(parser, row);
	if (table->kind != SPEC_SPECTRUM_FOURIER)
		return table->rows == 0 ? SPEC_OK
					: fail(parser, SPEC_EFORMAT,
						  "a spectrum of the kind '%s' has one row",
						  spec_spectrum_kind_name(table->kind));
	if (row[0] != (double)table->rows)
		return fail(parser, SPEC_EFORMAT, "the order %.10g stands where %zu should",
			row[0], table->rows);
	if (table->rows == 0 && row[2] != 0)
		return fail(parser, SPEC_EFORMAT, "the sine of order 0 is not 0");
	return SPEC_OK;
}

/* How many numbers a row has where neither header nor rows have said so. */
static size_t
usual_width(const struct parser *parser, size_t count)
{
	const char *at = spec_spd_columns(parser->table->kind);
	size_t width = 0;
	int comma;

	for (; at && *at; width++)
		at = spec_spd_skip(at + spec_spd_word(at), &comma);
	return at ? width : count;
}

static enum spec_status
parse_row(struct parser *parser, const char *text)
{
	struct spec_spd_table *table = parser->table;
	size_t count;
	enum spec_status status;

	if (table->rows == SPEC_SPD_MOST_ROWS)
		return fail(parser, SPEC_ERANGE, "more than %d rows", SPEC_SPD_MOST_ROWS);
	if (table->lines > 0)
		return fail(parser, SPEC_EFORMAT, "a row stands below the lines");
	status = parse_numbers(parser, text, &count);
	if (status != SPEC_OK)
		return status;
	if (count < 2 && !spec_spd_columns(table->kind))
		return fail(parser, SPEC_EFORMAT, "a row needs a wavelength and a value");
	if (table->width == 0)
		table->width = usual_width(parser, count);
	if (count != table->width)
		return fail(parser, SPEC_EFORMAT, "%zu numbers where the %s %zu", count,
			table->rows > 0  ? "rows above have"
			: table->columns ? "header names"
					 : "representation has",
			table->width);
	status = check_row(parser, table->number + table->rows * table->width);
	table->rows += status == SPEC_OK;
	return status;
}

/* "line WAVELENGTH WEIGHT", from behind its first word on. */
static enum spec_status
parse_spectral_line(struct parser *parser, const char *at)
{
	struct spec_spd_table *table = parser->table;
	void *list = table->line;
	double number[2];
	enum spec_status status;
	int comma;

	if (table->lines == SPEC_SPECTRUM_MOST_LINES)
		return fail(parser, SPEC_ERANGE, "more than %d lines",
			SPEC_SPECTRUM_MOST_LINES);
	at = spec_spd_skip(at, &comma);
	for (int i = 0; i < 2; i++) {
		size_t word = spec_spd_word(at);

		if (word == 0 || spec_number_scan(at, '.', &number[i]) != word)
			return fail(parser, SPEC_EFORMAT,
				"a line is 'line', its wavelength and its weight");
		at = spec_spd_skip(at + word, &comma);
	}
	if (*at || !(number[0] > 0))
		return fail(parser, SPEC_EFORMAT,
			"a line is 'line', its wavelength, which is positive, and its "
			"weight");
	status = spec_memory_grow(&list, &table->line_room, table->lines + 1,
		sizeof *table->line, "lines", parser->error);
	table->line = list;
	if (status == SPEC_OK)
		table->line[table->lines++] = (struct spec_line){number[0], number[1]};
	return status;
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
	if (parser->table->rows == 0 && skip_first_name(text))
		return parse_names(parser, skip_first_name(text));
	if (strncmp(text, LINE, strlen(LINE)) == 0 && spec_spd_word(text) == strlen(LINE))
		return parse_spectral_line(parser, text + strlen(LINE));
	return parse_row(parser, text);
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

/* What must be there at the end. */
static enum spec_status
finish(struct parser *parser)
{
	struct spec_spd_table *table = parser->table;
	enum spec_status status = SPEC_OK;

	if (parser->length > 0)
		status = parse_line(parser);
	if (status == SPEC_OK && table->rows == 0)
		status = spec_error_set(parser->error, SPEC_EFORMAT,
			"%s:%zu: the file ends without a row", parser->name, parser->line);
	/* Other programs' tables may say in their own words where they begin and end. */
	if (status == SPEC_OK && parser->representation &&
		(table->kind == SPEC_SPECTRUM_FOURIER) != (parser->range != NULL))
		status = spec_error_set(parser->error, SPEC_EFORMAT, "%s: %s", parser->name,
			parser->range ? "a range, which only a Fourier spectrum has"
				      : "a Fourier spectrum without a range");
	if (status == SPEC_OK && table->kind == SPEC_SPECTRUM_FOURIER) {
		parser->line = parser->range_line;
		status = parse_range(parser);
	}
	if (status == SPEC_OK && parser->interpolation && spec_spd_columns(table->kind))
		status = spec_error_set(parser->error, SPEC_EFORMAT,
			"%s: an interpolation, which only samples have", parser->name);
	return status;
}

static enum spec_status
parser_open(struct parser *parser, const char *name, struct spec_spd_table *table,
	struct spec_error *error)
{
	*parser = (struct parser){.name = name, .error = error, .table = table};
	*table = (struct spec_spd_table){.kind = SPEC_SPECTRUM_TABULATED};
	parser->text =
		spec_memory_new(SPEC_SPD_LONGEST_LINE + 2, 1, "bytes of a line", error);
	return parser->text ? SPEC_OK : SPEC_ENOMEM;
}

static enum spec_status
parser_close(struct parser *parser, enum spec_status status)
{
	free(parser->text);
	free(parser->representation);
	free(parser->interpolation);
	free(parser->range);
	if (status != SPEC_OK)
		spec_spd_table_free(parser->table);
	return status;
}

void
spec_spd_table_free(struct spec_spd_table *table)
{
	free(table->title);
	free(table->quantity);
	free(table->unit);
	free(table->source);
	free(table->medium);
	free(table->columns);
	free(table->number);
	free(table->line);
	*table = (struct spec_spd_table){0};
}

enum spec_status
spec_spd_table_parse(const char *text, size_t size, const char *name,
	struct spec_spd_table *table, struct spec_error *error)
{
	struct parser parser;
	enum spec_status status = parser_open(&parser, name, table, error);

	if (status == SPEC_OK)
		status = feed(&parser, text, size);
	if (status == SPEC_OK)
		status = finish(&parser);
	return parser_close(&parser, status);
}

enum spec_status
spec_spd_table_read(FILE *file, const char *name, struct spec_spd_table *table,
	struct spec_error *error)
{
	struct parser parser;
	enum spec_status status = parser_open(&parser, name, table, error);
	char *chunk = spec_memory_new(CHUNK, 1, "bytes", error);
	size_t size;

	if (!chunk)
		status = SPEC_ENOMEM;
	while (status == SPEC_OK && (size = fread(chunk, 1, CHUNK, file)) > 0)
		status = feed(&parser, chunk, size);
	if (status == SPEC_OK && ferror(file))
		status = spec_error_system(error, errno, "unable to read '%s'", name);
	if (status == SPEC_OK)
		status = finish(&parser);
	free(chunk);
	return parser_close(&parser, status);
}
