#include "spectrum/reshape.h"

#include <errno.h>
#include <stdlib.h>
#include <string.h>

#include "spectrum/lookup.h"
#include "spectrum/operate.h"
#include "spectrum/product.h"
#include "spectrum/spd.h"
#include "spectrum/spdtable.h"
#include "spectrum/store.h"

/* Reads the file of a name; *path, to be freed, is what messages call it. */
static enum spec_status
read_table(const char *name, struct spec_spd_table *table, char **path,
	struct spec_error *error)
{
	enum spec_status status;
	FILE *file;

	*path = NULL;
	if (strcmp(name, "-") == 0)
		return spec_spd_table_read(stdin, "<stdin>", table, error);
	*table = (struct spec_spd_table){0};
	status = spec_lookup_path(name, path, error);
	if (status != SPEC_OK)
		return status;
	file = fopen(*path, "rbe");
	if (!file)
		return spec_error_system(error, errno, "unable to open '%s'", *path);
	status = spec_spd_table_read(file, *path, table, error);
	fclose(file); /* opened for reading: nothing can be lost here */
	return status;
}

static int
is_plain(const struct spec_spd_table *table)
{
	return !spec_spd_columns(table->kind) && table->lines == 0;
}

/* ---- one spectrum ---- */

/* Puts a spectrum in the place of another. */
static void
replace(struct spec_spectrum *old, struct spec_spectrum *next)
{
	spec_spectrum_free(old);
	*old = *next;
}

static enum spec_status
multiply(struct spec_spectrum *spectrum, const struct spec_reshape *reshape,
	struct spec_error *error)
{
	struct spec_spectrum factor, next;
	enum spec_status status = SPEC_OK;

	for (size_t i = 0; i < reshape->multiplies && status == SPEC_OK; i++) {
		status = spec_spectrum_from_curve(&reshape->multiply[i], 0, &factor, error);
		if (status != SPEC_OK)
			return status;
		status = spec_spectrum_combine(spectrum, SPEC_MULTIPLY, &factor,
			SPEC_EXTRAPOLATE_REFUSE, &next, error);
		spec_spectrum_free(&factor);
		if (status == SPEC_OK)
			replace(spectrum, &next);
	}
	if (status != SPEC_OK || reshape->scale == 1)
		return status;
	status = spec_spectrum_combine_number(
		spectrum, SPEC_MULTIPLY, reshape->scale, &next, error);
	if (status == SPEC_OK)
		replace(spectrum, &next);
	return status;
}

/* Sets the rule between samples, where there are any. */
static enum spec_status
set_rule(struct spec_spectrum *spectrum, const struct spec_reshape *reshape,
	struct spec_error *error)
{
	struct spec_samples samples = {spectrum->wavelength_nm, spectrum->value,
		spectrum->count, reshape->interpolate};

	if (!reshape->has_interpolate)
		return SPEC_OK;
	if (!spectrum->wavelength_nm)
		return spec_error_set(error, SPEC_EUSAGE,
			"'%.200s' is of the kind '%s' and has no samples to interpolate "
			"between",
			spectrum->title, spec_spectrum_kind_name(spectrum->smooth));
	spectrum->interpolate = reshape->interpolate;
	return spec_samples_check(&samples, error);
}

/* Does all that is asked for to a spectrum, which becomes another. */
static enum spec_status
reshape_spectrum(struct spec_spectrum *spectrum, const struct spec_reshape *reshape,
	const struct spec_representation *to, struct spec_error *error)
{
	struct spec_representation wanted = *to;
	struct spec_spectrum next;
	enum spec_status status = set_rule(spectrum, reshape, error);

	wanted.extrapolate = reshape->extrapolate;
	if (status == SPEC_OK)
		status = multiply(spectrum, reshape, error);
	/* A table at its own wavelengths keeps what lies between them. */
	if (status == SPEC_OK && to->kind == SPEC_SPECTRUM_TABULATED && !to->grid &&
		spectrum->wavelength_nm)
		wanted.interpolate = spectrum->interpolate;
	if (status == SPEC_OK)
		status = spec_spectrum_convert(spectrum, &wanted, &next, error);
	if (status == SPEC_OK)
		replace(spectrum, &next);
	return status;
}

/* ---- all columns ---- */

/* A curve with the texts of a spectrum, its wavelengths, and columns of these names. */
static enum spec_status
start_curve(const struct spec_spectrum *spectrum, const struct spec_curve *names,
	struct spec_curve *curve, struct spec_error *error)
{
	const char *text[] = {spectrum->title, spectrum->quantity, spectrum->unit,
		spectrum->source, spectrum->medium};
	enum spec_status status =
		spec_curve_new(spectrum->count, names->columns, curve, error);
	char **field[] = {&curve->title, &curve->quantity, &curve->unit, &curve->source,
		&curve->medium};

	for (int i = 0; i < 5 && status == SPEC_OK; i++)
		status = spec_curve_set_text(field[i], text[i], error);
	for (size_t i = 0; i < names->columns && status == SPEC_OK; i++)
		status = spec_curve_set_text(&curve->column[i], names->column[i], error);
	if (status == SPEC_OK)
		memcpy(curve->wavelength_nm, spectrum->wavelength_nm,
			spectrum->count * sizeof *curve->wavelength_nm);
	return status;
}

/* Every column of a curve with that rule between its rows; *rule: that of the result. */
static enum spec_status
reshape_columns(const struct spec_curve *source, enum spec_interpolate *rule,
	const struct spec_reshape *reshape, const struct spec_representation *to,
	struct spec_curve *curve, struct spec_error *error)
{
	struct spec_reshape ruled = *reshape;
	enum spec_status status = SPEC_OK;

	*curve = (struct spec_curve){0};
	if (!reshape->has_interpolate)
		ruled.interpolate = *rule;
	ruled.has_interpolate = 1;
	for (size_t i = 0; i < source->columns && status == SPEC_OK; i++) {
		struct spec_spectrum spectrum;

		status = spec_spectrum_from_curve(source, i, &spectrum, error);
		if (status == SPEC_OK)
			status = reshape_spectrum(&spectrum, &ruled, to, error);
		if (status == SPEC_OK && i == 0)
			status = start_curve(&spectrum, source, curve, error);
		if (status == SPEC_OK) {
			memcpy(curve->value + i * curve->count, spectrum.value,
				curve->count * sizeof *curve->value);
			*rule = spectrum.interpolate;
		}
		spec_spectrum_free(&spectrum);
	}
	if (status != SPEC_OK)
		spec_curve_free(curve);
	return status;
}

/* The same where it is linear between: as it has always been. */
static enum spec_status
reshape_linear(const struct spec_curve *source, const struct spec_reshape *reshape,
	struct spec_curve *curve, struct spec_error *error)
{
	struct spec_curve next;
	enum spec_status status = spec_curve_copy(source, curve, error);

	for (size_t i = 0; i < reshape->multiplies && status == SPEC_OK; i++) {
		status = spec_curve_multiply(curve, &reshape->multiply[i], &next, error);
		if (status == SPEC_OK) {
			spec_curve_free(curve);
			*curve = next;
		}
	}
	if (status == SPEC_OK && reshape->grid) {
		status = spec_curve_resample(
			curve, reshape->grid, reshape->extrapolate, &next, error);
		if (status == SPEC_OK) {
			spec_curve_free(curve);
			*curve = next;
		}
	}
	for (size_t i = 0; i < curve->count * curve->columns && status == SPEC_OK; i++)
		curve->value[i] *= reshape->scale;
	if (status == SPEC_OK && reshape->scale != 1)
		status = spec_curve_set_text(
			&curve->unit, "", error); /* it was of other numbers */
	if (status != SPEC_OK)
		spec_curve_free(curve);
	return status;
}

/* ---- files ---- */

/* The curve of a file that is no plain table: a table of its values at the grid. */
static enum spec_status
sample_file(const struct spec_spd_table *table, const char *path,
	const struct spec_reshape *reshape, struct spec_curve *curve,
	struct spec_error *error)
{
	struct spec_representation at_grid = {
		.kind = SPEC_SPECTRUM_TABULATED, .grid = reshape->grid};
	struct spec_spectrum spectrum;
	enum spec_status status = spec_spd_table_to_spectrum(table, path, &spectrum, error);

	if (status == SPEC_OK)
		status = reshape_spectrum(&spectrum, reshape, &at_grid, error);
	if (status == SPEC_OK)
		status = spec_spectrum_to_curve(&spectrum, curve, error);
	spec_spectrum_free(&spectrum);
	return status;
}

enum spec_status
spec_reshape_curve(const char *name, const struct spec_reshape *reshape,
	struct spec_curve *curve, struct spec_error *error)
{
	struct spec_representation at_grid = {
		.kind = SPEC_SPECTRUM_TABULATED, .grid = reshape->grid};
	struct spec_spd_table table;
	struct spec_curve source = {0};
	enum spec_interpolate rule;
	char *path;
	enum spec_status status = read_table(name, &table, &path, error);

	*curve = (struct spec_curve){0};
	rule = reshape->has_interpolate ? reshape->interpolate : table.interpolate;
	if (status == SPEC_OK && !is_plain(&table))
		status =
			sample_file(&table, path ? path : "<stdin>", reshape, curve, error);
	else if (status == SPEC_OK) {
		status = spec_spd_table_to_curve(&table, &source, error);
		if (status == SPEC_OK && rule == SPEC_INTERPOLATE_LINEAR)
			status = reshape_linear(&source, reshape, curve, error);
		else if (status == SPEC_OK)
			status = reshape_columns(
				&source, &rule, reshape, &at_grid, curve, error);
	}
	spec_curve_free(&source);
	spec_spd_table_free(&table);
	free(path);
	return status;
}

/* A plain table as samples or a table: all its columns. */
static enum spec_status
save_columns(struct spec_spd_table *table, const struct spec_reshape *reshape,
	const struct spec_representation *to, const char *path, struct spec_error *error)
{
	enum spec_interpolate rule = table->interpolate;
	struct spec_curve source, curve = {0};
	enum spec_status status = spec_spd_table_to_curve(table, &source, error);

	if (status == SPEC_OK)
		status = reshape_columns(&source, &rule, reshape, to, &curve, error);
	if (status == SPEC_OK)
		status = spec_spd_save_as(path, &curve, to->kind, rule, error);
	spec_curve_free(&source);
	spec_curve_free(&curve);
	return status;
}

enum spec_status
spec_reshape_save(const char *name, const struct spec_reshape *reshape,
	const struct spec_representation *to, const char *path, struct spec_error *error)
{
	int tabular =
		to->kind == SPEC_SPECTRUM_SAMPLED || to->kind == SPEC_SPECTRUM_TABULATED;
	struct spec_spectrum spectrum = {0};
	struct spec_spd_table table;
	char *source;
	enum spec_status status = read_table(name, &table, &source, error);

	if (status == SPEC_OK && is_plain(&table) && tabular) {
		status = save_columns(&table, reshape, to, path, error);
	} else if (status == SPEC_OK && is_plain(&table) && table.width > 2) {
		status = spec_error_set(error, SPEC_EUSAGE,
			"'%.200s' has %zu columns, and a spectrum of the kind '%s' has one",
			name, table.width - 1, spec_spectrum_kind_name(to->kind));
	} else if (status == SPEC_OK) {
		status = spec_spd_table_to_spectrum(
			&table, source ? source : "<stdin>", &spectrum, error);
		if (status == SPEC_OK)
			status = reshape_spectrum(&spectrum, reshape, to, error);
		if (status == SPEC_OK)
			status = spec_spectrum_save(path, &spectrum, error);
	}
	spec_spectrum_free(&spectrum);
	spec_spd_table_free(&table);
	free(source);
	return status;
}
