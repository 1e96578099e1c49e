#include "spectrum/store.h"

#include <errno.h>
#include <float.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "base/memory.h"
#include "base/output.h"
#include "base/text.h"
#include "spectrum/lookup.h"
#include "spectrum/spd.h"
#include "spectrum/spdtable.h"

#define EQUAL_STEPS 1e-9 /* of a wavelength: samples that were rounded are samples still */

/* ---- reading ---- */

/* One column of a table, to be freed; column 0 is the wavelengths. */
static double *
take_column(const struct spec_spd_table *table, size_t column, struct spec_error *error)
{
	double *value = spec_memory_new(table->rows, sizeof *value, "rows", error);

	for (size_t i = 0; value && i < table->rows; i++)
		value[i] = table->number[i * table->width + column];
	return value;
}

static enum spec_status
make_samples(const struct spec_spd_table *table, struct spec_spectrum *spectrum,
	struct spec_error *error)
{
	double *nm = take_column(table, 0, error), *value = take_column(table, 1, error);
	size_t count = table->rows;
	enum spec_status status = nm && value ? SPEC_OK : SPEC_ENOMEM;

	if (status == SPEC_OK && table->kind == SPEC_SPECTRUM_TABULATED)
		status = spec_spectrum_tabulated(
			nm, value, count, table->interpolate, spectrum, error);
	else if (status == SPEC_OK)
		status = spec_spectrum_sampled(nm[0], nm[count - 1], value, count,
			table->interpolate, spectrum, error);
	for (size_t i = 0; i < count && status == SPEC_OK; i++)
		if (fabs(spectrum->wavelength_nm[i] - nm[i]) > EQUAL_STEPS * nm[i])
			status = spec_error_set(error, SPEC_EFORMAT,
				"the samples do not stand at equal distances: %.10g nm "
				"where %.10g nm should",
				nm[i], spectrum->wavelength_nm[i]);
	free(nm);
	free(value);
	return status;
}

static enum spec_status
make_series(const struct spec_spd_table *table, struct spec_spectrum *spectrum,
	struct spec_error *error)
{
	size_t count = 2 * table->rows - 1;
	double *coefficient =
		spec_memory_new(count, sizeof *coefficient, "coefficients", error);
	enum spec_status status;

	if (!coefficient)
		return SPEC_ENOMEM;
	for (size_t i = 0; i < table->rows; i++) {
		coefficient[i == 0 ? 0 : 2 * i - 1] = table->number[3 * i + 1];
		if (i > 0)
			coefficient[2 * i] = table->number[3 * i + 2];
	}
	status = spec_spectrum_fourier(
		table->low_nm, table->high_nm, coefficient, count, spectrum, error);
	free(coefficient);
	return status;
}

static enum spec_status
make_colour(const struct spec_spd_table *table, struct spec_spectrum *spectrum,
	struct spec_error *error)
{
	const double *row = table->number;
	struct spec_sigmoid sigmoid = {row[3], row[4], row[5], row[6]};

	if (fabs(sigmoid.c2) == DBL_MAX)
		sigmoid.c2 *= 2;
	return spec_spectrum_rgb(row, &sigmoid, spectrum, error);
}

static enum spec_status
take_texts(const struct spec_spd_table *table, struct spec_spectrum *spectrum,
	struct spec_error *error)
{
	const char *text[] = {
		table->title, table->quantity, table->unit, table->source, table->medium};
	char **field[] = {&spectrum->title, &spectrum->quantity, &spectrum->unit,
		&spectrum->source, &spectrum->medium};
	enum spec_status status = SPEC_OK;

	for (int i = 0; i < 5 && status == SPEC_OK; i++)
		if (text[i])
			status = spec_curve_set_text(field[i], text[i], error);
	return status;
}

enum spec_status
spec_spd_table_to_spectrum(const struct spec_spd_table *table, const char *name,
	struct spec_spectrum *spectrum, struct spec_error *error)
{
	const double *row = table->number;
	enum spec_status status = SPEC_OK;

	*spectrum = (struct spec_spectrum){0};
	if (table->lines > 0 && !spec_spd_columns(table->kind) && table->width > 2)
		return spec_error_set(error, SPEC_EFORMAT,
			"%s: lines stand beside %zu columns, not one", name,
			table->width - 1);
	switch (table->kind) {
	case SPEC_SPECTRUM_FOURIER:
		status = make_series(table, spectrum, error);
		break;
	case SPEC_SPECTRUM_CONSTANT:
		status = spec_spectrum_constant(row[0], spectrum, error);
		break;
	case SPEC_SPECTRUM_BLACKBODY:
		status = spec_spectrum_blackbody(row[0], row[1], spectrum, error);
		break;
	case SPEC_SPECTRUM_RGB:
		status = make_colour(table, spectrum, error);
		break;
	default:
		status = make_samples(table, spectrum, error);
		break;
	}
	if (status == SPEC_OK)
		status =
			spec_spectrum_add_lines(spectrum, table->line, table->lines, error);
	if (status != SPEC_OK && status != SPEC_ENOMEM && error)
		spec_error_prefix(error, "%s", name);
	if (status == SPEC_OK)
		status = take_texts(table, spectrum, error);
	if (status != SPEC_OK)
		spec_spectrum_free(spectrum);
	return status;
}

enum spec_status
spec_spectrum_read(FILE *file, const char *name, struct spec_spectrum *spectrum,
	struct spec_error *error)
{
	struct spec_spd_table table;
	enum spec_status status = spec_spd_table_read(file, name, &table, error);

	*spectrum = (struct spec_spectrum){0};
	if (status != SPEC_OK)
		return status;
	status = spec_spd_table_to_spectrum(&table, name, spectrum, error);
	spec_spd_table_free(&table);
	return status;
}

enum spec_status
spec_spectrum_load(
	const char *path, struct spec_spectrum *spectrum, struct spec_error *error)
{
	FILE *file = fopen(path, "rbe");
	enum spec_status status;

	*spectrum = (struct spec_spectrum){0};
	if (!file)
		return spec_error_system(error, errno, "unable to open '%s'", path);
	status = spec_spectrum_read(file, path, spectrum, error);
	fclose(file); /* opened for reading: nothing can be lost here */
	return status;
}

static enum spec_status
calculate(const char *name, struct spec_spectrum *spectrum, struct spec_error *error)
{
	struct spec_curve curve;
	enum spec_status status = spec_lookup_curve(name, &curve, error);

	*spectrum = (struct spec_spectrum){0};
	if (status == SPEC_OK)
		status = spec_spectrum_from_curve(&curve, 0, spectrum, error);
	spec_curve_free(&curve);
	return status;
}

enum spec_status
spec_spectrum_named(
	const char *name, struct spec_spectrum *spectrum, struct spec_error *error)
{
	char *path;
	enum spec_status status;

	if (spec_lookup_is_computed(name))
		return calculate(name, spectrum, error);
	status = spec_lookup_path(name, &path, error);
	*spectrum = (struct spec_spectrum){0};
	if (status == SPEC_OK)
		status = spec_spectrum_load(path, spectrum, error);
	free(path);
	return status;
}

/* ---- writing ---- */

static void
write_numbers(FILE *file, const double *number, size_t count)
{
	char text[SPEC_SPD_NUMBER];

	for (size_t i = 0; i < count; i++) {
		spec_spd_format_number(number[i], text);
		fprintf(file, i > 0 ? " %s" : "%s", text);
	}
	fputc('\n', file);
}

static void
write_header(FILE *file, const struct spec_spectrum *spectrum)
{
	const char *columns = spec_spd_columns(spectrum->smooth);
	double range_nm[] = {spectrum->low_nm, spectrum->high_nm};

	spec_spd_write_rule(file, spectrum->smooth,
		columns ? SPEC_INTERPOLATE_LINEAR : spectrum->interpolate);
	if (spectrum->smooth == SPEC_SPECTRUM_FOURIER) {
		fputs("# range: ", file);
		write_numbers(file, range_nm, 2);
	}
	fprintf(file, "# columns: %s\n", columns ? columns : "wavelength_nm value");
}

static void
write_rows(FILE *file, const struct spec_spectrum *spectrum)
{
	const struct spec_sigmoid *sigmoid = &spectrum->sigmoid;
	const double *rgb = spectrum->rgb, *value = spectrum->value;
	double row[7] = {spectrum->temperature_k, spectrum->level};

	if (spectrum->smooth == SPEC_SPECTRUM_CONSTANT) {
		write_numbers(file, &spectrum->level, 1);
	} else if (spectrum->smooth == SPEC_SPECTRUM_BLACKBODY) {
		write_numbers(file, row, 2);
	} else if (spectrum->smooth == SPEC_SPECTRUM_RGB) {
		for (int i = 0; i < 3; i++)
			row[i] = rgb[i];
		row[3] = sigmoid->scale;
		row[4] = sigmoid->c0_per_nm2;
		row[5] = sigmoid->c1_per_nm;
		row[6] = fmin(fmax(sigmoid->c2, -DBL_MAX), DBL_MAX);
		write_numbers(file, row, 7);
	} else if (spectrum->smooth == SPEC_SPECTRUM_FOURIER) {
		for (size_t i = 0; i <= spectrum->count / 2; i++) {
			row[0] = (double)i;
			row[1] = value[i == 0 ? 0 : 2 * i - 1];
			row[2] = i == 0 ? 0 : value[2 * i];
			write_numbers(file, row, 3);
		}
	} else {
		for (size_t i = 0; i < spectrum->count; i++) {
			row[0] = spectrum->wavelength_nm[i];
			row[1] = value[i];
			write_numbers(file, row, 2);
		}
	}
}

enum spec_status
spec_spectrum_write(
	FILE *file, const struct spec_spectrum *spectrum, struct spec_error *error)
{
	char name[] = "value", *column = name;
	struct spec_curve texts = {spectrum->title, spectrum->quantity, spectrum->unit,
		spectrum->source, spectrum->medium, .columns = 1, .column = &column,
		.count = spectrum->count};
	enum spec_status status = spec_spd_check_texts(&texts, error);

	if (status != SPEC_OK)
		return status;
	errno = 0;
	spec_spd_write_texts(file, &texts);
	write_header(file, spectrum);
	write_rows(file, spectrum);
	for (size_t i = 0; i < spectrum->lines; i++) {
		double line[] = {spectrum->line[i].wavelength_nm, spectrum->line[i].weight};

		fputs("line ", file);
		write_numbers(file, line, 2);
	}
	if (fflush(file) != 0 || ferror(file))
		return spec_error_system(
			error, errno ? errno : EIO, "unable to write the spectrum");
	return SPEC_OK;
}

enum spec_status
spec_spectrum_save(
	const char *path, const struct spec_spectrum *spectrum, struct spec_error *error)
{
	struct spec_text text;
	enum spec_status status = spec_text_open(&text, error);

	if (status != SPEC_OK)
		return status;
	status = spec_spectrum_write(text.stream, spectrum, error);
	if (status == SPEC_OK)
		status = spec_text_close(&text, error);
	if (status == SPEC_OK)
		status = spec_output_save(path, text.bytes, text.size, error);
	spec_text_free(&text);
	return status;
}
