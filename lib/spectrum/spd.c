#include "spectrum/spd.h"

#include <errno.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "base/memory.h"
#include "base/output.h"
#include "base/text.h"
#include "spectrum/represent.h"
#include "spectrum/spdtable.h"

#define FIRST_COLUMN "wavelength_nm"

/* Moves the header's texts and columns into the curve. */
static enum spec_status
move_header(
	struct spec_spd_table *table, struct spec_curve *curve, struct spec_error *error)
{
	char **from[] = {&table->title, &table->quantity, &table->unit, &table->source,
		&table->medium};
	char **to[] = {&curve->title, &curve->quantity, &curve->unit, &curve->source,
		&curve->medium};
	const char *at = table->columns;
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

		at = spec_spd_skip(at + spec_spd_word(at), &comma);
		length = spec_spd_word(at);
		name = spec_memory_text(at, length, error);
		if (!name)
			return SPEC_ENOMEM;
		free(curve->column[i]);
		curve->column[i] = name;
	}
	return SPEC_OK;
}

enum spec_status
spec_spd_table_to_curve(
	struct spec_spd_table *table, struct spec_curve *curve, struct spec_error *error)
{
	enum spec_status status =
		spec_curve_new(table->rows, table->width - 1, curve, error);

	if (status == SPEC_OK)
		status = move_header(table, curve, error);
	if (status != SPEC_OK) {
		spec_curve_free(curve);
		return status;
	}
	for (size_t i = 0; i < curve->count; i++) {
		const double *row = table->number + i * table->width;

		curve->wavelength_nm[i] = row[0];
		for (size_t j = 0; j < curve->columns; j++)
			curve->value[j * curve->count + i] = row[1 + j];
	}
	return SPEC_OK;
}

/* The spectrum as a curve; its errors name the file. */
static enum spec_status
sample_spectrum(const struct spec_spectrum *spectrum, const char *name,
	struct spec_curve *curve, struct spec_error *error)
{
	enum spec_status status = spec_spectrum_to_curve(spectrum, curve, error);

	if (status != SPEC_OK && status != SPEC_ENOMEM && error)
		spec_error_prefix(error, "%s", name);
	return status;
}

/*
 * A curve of what was read, which is freed; a spectrum of another kind is sampled. Rows are
 * taken as they are, but the rules that their distances have to keep hold all the same.
 */
static enum spec_status
take_table(struct spec_spd_table *table, const char *name, struct spec_curve *curve,
	struct spec_error *error)
{
	struct spec_spectrum spectrum = {0};
	int rows = !spec_spd_columns(table->kind) && table->lines == 0;
	int plain = rows && table->kind == SPEC_SPECTRUM_TABULATED &&
		    table->interpolate == SPEC_INTERPOLATE_LINEAR;
	enum spec_status status = SPEC_OK;

	if (!plain)
		status = spec_spd_table_to_spectrum(table, name, &spectrum, error);
	if (status == SPEC_OK)
		status = rows ? spec_spd_table_to_curve(table, curve, error)
			      : sample_spectrum(&spectrum, name, curve, error);
	spec_spectrum_free(&spectrum);
	spec_spd_table_free(table);
	return status;
}

enum spec_status
spec_spd_parse(const char *text, size_t size, const char *name, struct spec_curve *curve,
	struct spec_error *error)
{
	struct spec_spd_table table;
	enum spec_status status = spec_spd_table_parse(text, size, name, &table, error);

	*curve = (struct spec_curve){0};
	return status == SPEC_OK ? take_table(&table, name, curve, error) : status;
}

enum spec_status
spec_spd_read(
	FILE *file, const char *name, struct spec_curve *curve, struct spec_error *error)
{
	struct spec_spd_table table;
	enum spec_status status = spec_spd_table_read(file, name, &table, error);

	*curve = (struct spec_curve){0};
	return status == SPEC_OK ? take_table(&table, name, curve, error) : status;
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

enum spec_status
spec_spd_check_texts(const struct spec_curve *curve, struct spec_error *error)
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

		if (!*name || name[spec_spd_word(name)] || !text_fits(name))
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
				curve->wavelength_nm[i], spec_curve_name(curve));
		before = curve->wavelength_nm[i];
	}
	for (size_t i = 0; i < curve->count * curve->columns; i++)
		if (!isfinite(curve->value[i]))
			return spec_error_set(error, SPEC_ERANGE,
				"the value of '%.200s' at %.10g nm is not finite",
				spec_curve_name(curve),
				curve->wavelength_nm[i % curve->count]);
	return SPEC_OK;
}

static void
write_columns(FILE *file, const struct spec_curve *curve, char separator)
{
	fputs(FIRST_COLUMN, file);
	for (size_t i = 0; i < curve->columns; i++)
		fprintf(file, "%c%s", separator, curve->column[i]);
	fputc('\n', file);
}

void
spec_spd_write_texts(FILE *file, const struct spec_curve *curve)
{
	static const char *const keys[] = {"title", "quantity", "unit", "source", "medium"};
	const char *texts[] = {
		curve->title, curve->quantity, curve->unit, curve->source, curve->medium};

	for (size_t i = 0; i < sizeof keys / sizeof keys[0]; i++)
		if (*texts[i])
			fprintf(file, "# %s: %s\n", keys[i], texts[i]);
}

void
spec_spd_write_rule(
	FILE *file, enum spec_spectrum_kind kind, enum spec_interpolate interpolate)
{
	if (kind != SPEC_SPECTRUM_TABULATED)
		fprintf(file, "# representation: %s\n", spec_spectrum_kind_name(kind));
	if (interpolate != SPEC_INTERPOLATE_LINEAR)
		fprintf(file, "# interpolation: %s\n", spec_interpolate_name(interpolate));
}

static void
write_header(FILE *file, const struct spec_curve *curve, enum spec_spectrum_kind kind,
	enum spec_interpolate interpolate)
{
	spec_spd_write_texts(file, curve);
	spec_spd_write_rule(file, kind, interpolate);
	fputs("# columns: ", file);
	write_columns(file, curve, ' ');
}

static void
write_rows(FILE *file, const struct spec_curve *curve, char separator)
{
	char text[SPEC_SPD_NUMBER];

	for (size_t i = 0; i < curve->count && !ferror(file); i++) {
		spec_spd_format_number(curve->wavelength_nm[i], text);
		fputs(text, file);
		for (size_t j = 0; j < curve->columns; j++) {
			spec_spd_format_number(curve->value[j * curve->count + i], text);
			fprintf(file, "%c%s", separator, text);
		}
		fputc('\n', file);
	}
}

static enum spec_status
check_curve(const struct spec_curve *curve, struct spec_error *error)
{
	enum spec_status status = spec_spd_check_texts(curve, error);

	return status == SPEC_OK ? check_numbers(curve, error) : status;
}

static enum spec_status
finish(FILE *file, struct spec_error *error)
{
	return fflush(file) == 0 && !ferror(file)
		       ? SPEC_OK
		       : spec_error_system(error, errno ? errno : EIO,
				 "unable to write the spectrum");
}

static enum spec_status
write_as(FILE *file, const struct spec_curve *curve, enum spec_spectrum_kind kind,
	enum spec_interpolate interpolate, struct spec_error *error)
{
	enum spec_status status = check_curve(curve, error);

	if (status != SPEC_OK)
		return status;
	errno = 0;
	write_header(file, curve, kind, interpolate);
	write_rows(file, curve, ' ');
	return finish(file, error);
}

static enum spec_status
write_csv(FILE *file, const struct spec_curve *curve, struct spec_error *error)
{
	enum spec_status status = check_curve(curve, error);

	if (status != SPEC_OK)
		return status;
	errno = 0;
	write_columns(file, curve, ',');
	write_rows(file, curve, ',');
	return finish(file, error);
}

enum spec_status
spec_spd_write(FILE *file, const struct spec_curve *curve, struct spec_error *error)
{
	return write_as(
		file, curve, SPEC_SPECTRUM_TABULATED, SPEC_INTERPOLATE_LINEAR, error);
}

/* Saves what was written to a text, unless that failed, and frees it. */
static enum spec_status
save_text(const char *path, struct spec_text *text, enum spec_status status,
	struct spec_error *error)
{
	if (status == SPEC_OK)
		status = spec_text_close(text, error);
	if (status == SPEC_OK)
		status = spec_output_save(path, text->bytes, text->size, error);
	spec_text_free(text);
	return status;
}

enum spec_status
spec_spd_save_as(const char *path, const struct spec_curve *curve,
	enum spec_spectrum_kind kind, enum spec_interpolate interpolate,
	struct spec_error *error)
{
	struct spec_text text;
	enum spec_status status = spec_text_open(&text, error);

	if (status != SPEC_OK)
		return status;
	return save_text(
		path, &text, write_as(text.stream, curve, kind, interpolate, error), error);
}

enum spec_status
spec_spd_save(const char *path, const struct spec_curve *curve, struct spec_error *error)
{
	return spec_spd_save_as(
		path, curve, SPEC_SPECTRUM_TABULATED, SPEC_INTERPOLATE_LINEAR, error);
}

enum spec_status
spec_spd_save_csv(
	const char *path, const struct spec_curve *curve, struct spec_error *error)
{
	struct spec_text text;
	enum spec_status status = spec_text_open(&text, error);

	if (status != SPEC_OK)
		return status;
	return save_text(path, &text, write_csv(text.stream, curve, error), error);
}
