#include "spectrum/reshape.h"

#include <errno.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "base/text.h"
#include "spectrum/lookup.h"
#include "spectrum/operate.h"
#include "spectrum/product.h"
#include "spectrum/rebin.h"
#include "spectrum/spd.h"
#include "spectrum/spdtable.h"
#include "spectrum/store.h"

/* The table of what is computed. */
static enum spec_status
calculate(const char *name, struct spec_spd_table *table, struct spec_error *error)
{
	struct spec_curve curve;
	struct spec_text text = {0};
	FILE *file;
	enum spec_status status = spec_lookup_curve(name, &curve, error);

	*table = (struct spec_spd_table){0};
	if (status == SPEC_OK)
		status = spec_text_open(&text, error);
	if (status == SPEC_OK)
		status = spec_spd_write(text.stream, &curve, error);
	if (status == SPEC_OK)
		status = spec_text_close(&text, error);
	if (status == SPEC_OK) {
		file = fmemopen(text.bytes, text.size, "r");
		status =
			file ? spec_spd_table_read(file, name, table, error)
			     : spec_error_system(error, errno, "unable to read '%s'", name);
		if (file)
			fclose(file);
	}
	spec_text_free(&text);
	spec_curve_free(&curve);
	return status;
}

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
	if (spec_lookup_is_computed(name))
		return calculate(name, table, error);
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

/* With a curve or a number. */
static enum spec_status
combine(const struct spec_spectrum *spectrum, const struct spec_operation *operation,
	struct spec_spectrum *next, struct spec_error *error)
{
	static const enum spec_operator operators[] = {
		[SPEC_OPERATION_MULTIPLY] = SPEC_MULTIPLY,
		[SPEC_OPERATION_DIVIDE] = SPEC_DIVIDE,
		[SPEC_OPERATION_ADD] = SPEC_ADD,
		[SPEC_OPERATION_SCALE] = SPEC_MULTIPLY,
		[SPEC_OPERATION_RAISE] = SPEC_RAISE};
	enum spec_operator op = operators[operation->kind];
	struct spec_spectrum other;
	enum spec_status status;

	if (operation->kind == SPEC_OPERATION_SCALE ||
		operation->kind == SPEC_OPERATION_RAISE)
		return spec_spectrum_combine_number(
			spectrum, op, operation->number, next, error);
	status = spec_spectrum_from_curve(&operation->curve, 0, &other, error);
	if (status != SPEC_OK)
		return status;
	status = spec_spectrum_combine(
		spectrum, op, &other, SPEC_EXTRAPOLATE_REFUSE, next, error);
	spec_spectrum_free(&other);
	return status;
}

static enum spec_status
operate(struct spec_spectrum *spectrum, const struct spec_reshape *reshape,
	struct spec_error *error)
{
	enum spec_status status = SPEC_OK;

	for (size_t i = 0; i < reshape->operations && status == SPEC_OK; i++) {
		const struct spec_operation *operation = &reshape->operation[i];
		struct spec_spectrum next;

		if (operation->kind == SPEC_OPERATION_ILLUMINATE ||
			operation->kind == SPEC_OPERATION_REFLECTANCE_OF)
			return spec_error_set(error, SPEC_EUNSUPPORTED,
				"what light does to reflectance is for images");
		if (operation->kind == SPEC_OPERATION_CLAMP)
			status = spec_spectrum_clamp(
				spectrum, operation->low, operation->high, &next, error);
		else
			status = combine(spectrum, operation, &next, error);
		if (status == SPEC_OK)
			replace(spectrum, &next);
	}
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
		status = operate(spectrum, reshape, error);
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

/* ---- a curve that is linear between its rows ---- */

/* Puts a curve in place of another. */
static void
replace_curve(struct spec_curve *curve, struct spec_curve *next)
{
	spec_curve_free(curve);
	*curve = *next;
}

static enum spec_status
settle_quantity(const char *name, const char *quantity, struct spec_curve *curve,
	struct spec_error *error)
{
	struct spec_curve said = {.quantity = (char *)quantity};

	if (!quantity)
		return SPEC_OK;
	if (!*curve->quantity)
		return spec_curve_set_text(&curve->quantity, quantity, error);
	if (spec_curve_is_ratio(curve) == spec_curve_is_ratio(&said))
		return SPEC_OK;
	return spec_error_set(error, SPEC_EUSAGE, "'%s' says itself that it is %s", name,
		curve->quantity);
}

/* Its wavelengths over nm, in the medium that is asked for. */
static enum spec_status
settle_wavelengths(const char *name, const struct spec_reshape *reshape,
	struct spec_curve *curve, int *left, struct spec_error *error)
{
	const char *medium = spec_medium_name(reshape->medium);
	enum spec_status status =
		spec_abscissa_convert(reshape->abscissa, curve, left, error);

	if (status != SPEC_OK || !*medium)
		return status;
	if (strcmp(curve->medium, medium) == 0)
		return spec_error_set(error, SPEC_EUSAGE,
			"%s: its wavelengths are those in %s already", name, medium);
	status = spec_air_convert(
		reshape->medium, curve->wavelength_nm, curve->count, error);
	return status == SPEC_OK ? spec_curve_set_text(&curve->medium, medium, error)
				 : status;
}

/* The curve on the grid by a rule, and after the operations there. */
static enum spec_status
change(const struct spec_reshape *reshape, enum spec_interpolate rule,
	struct spec_curve *curve, struct spec_error *error)
{
	const struct spec_grid *grid = reshape->grid;
	struct spec_curve next;
	enum spec_status status = SPEC_OK;

	if (grid && reshape->rebin)
		status = spec_curve_rebin(
			curve, grid, reshape->edges_nm, reshape->extrapolate, &next, error);
	else if (grid)
		status = spec_curve_resample_by(
			rule, curve, grid, reshape->extrapolate, &next, error);
	if (status == SPEC_OK && grid)
		replace_curve(curve, &next);
	for (size_t i = 0; i < reshape->operations && status == SPEC_OK; i++)
		status = spec_operation_apply(&reshape->operation[i], curve, error);
	if (status != SPEC_OK || !grid || reshape->operations == 0)
		return status;
	/* The wavelengths of other curves came in between. */
	status = spec_curve_resample(curve, grid, reshape->extrapolate, &next, error);
	if (status == SPEC_OK)
		replace_curve(curve, &next);
	return status;
}

/* As spec_reshape_loaded, of a curve with any rule between its rows, and a grid or not. */
static enum spec_status
shape(const char *name, const struct spec_reshape *reshape, enum spec_interpolate rule,
	struct spec_curve *curve, struct spec_reshape_notes *notes,
	struct spec_error *error)
{
	enum spec_status status = settle_quantity(name, reshape->quantity, curve, error);

	if (status == SPEC_OK)
		status = settle_wavelengths(name, reshape, curve, &notes->left, error);
	if (status == SPEC_OK && reshape->grid)
		spec_curve_describe_outside(curve, reshape->grid, reshape->edges_nm,
			reshape->rebin, notes->outside, sizeof notes->outside);
	if (status == SPEC_OK)
		status = change(reshape, rule, curve, error);
	if (status != SPEC_OK)
		spec_curve_free(curve);
	return status;
}

enum spec_status
spec_reshape_loaded(const char *name, const struct spec_reshape *reshape,
	struct spec_curve *curve, struct spec_reshape_notes *notes,
	struct spec_error *error)
{
	*notes = (struct spec_reshape_notes){0};
	return shape(name, reshape,
		reshape->has_interpolate ? reshape->interpolate : SPEC_INTERPOLATE_LINEAR,
		curve, notes, error);
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

/* What only a plain table can have: numbers of another unit or medium, and bins. */
static enum spec_status
check_plain(const char *name, const struct spec_reshape *reshape, struct spec_error *error)
{
	if (reshape->abscissa == SPEC_ABSCISSA_NM &&
		reshape->medium == SPEC_MEDIUM_UNKNOWN && !reshape->rebin)
		return SPEC_OK;
	return spec_error_set(error, SPEC_EUSAGE,
		"%s: units, media and bins are for tables that are linear between their "
		"rows (specconvert --to tabulated makes one)",
		name);
}

/* A plain table at its own wavelengths, by another rule than the linear one. */
static enum spec_status
shape_by_rule(const char *name, struct spec_spd_table *table,
	const struct spec_reshape *reshape, struct spec_curve *curve,
	struct spec_error *error)
{
	struct spec_representation same = {.kind = SPEC_SPECTRUM_TABULATED};
	enum spec_interpolate rule =
		reshape->has_interpolate ? reshape->interpolate : table->interpolate;
	struct spec_curve source = {0};
	enum spec_status status = check_plain(name, reshape, error);

	if (status == SPEC_OK)
		status = spec_spd_table_to_curve(table, &source, error);
	if (status == SPEC_OK)
		status = reshape_columns(&source, &rule, reshape, &same, curve, error);
	spec_curve_free(&source);
	return status;
}

enum spec_status
spec_reshape_curve(const char *name, const struct spec_reshape *reshape,
	struct spec_curve *curve, struct spec_reshape_notes *notes,
	struct spec_error *error)
{
	struct spec_spd_table table;
	enum spec_interpolate rule;
	const char *title = "<stdin>";
	char *path;
	enum spec_status status = read_table(name, &table, &path, error);

	*curve = (struct spec_curve){0};
	*notes = (struct spec_reshape_notes){0};
	if (path)
		title = path;
	rule = reshape->has_interpolate ? reshape->interpolate : table.interpolate;
	if (status == SPEC_OK && !is_plain(&table)) {
		status = check_plain(name, reshape, error);
		if (status == SPEC_OK)
			status = sample_file(&table, title, reshape, curve, error);
	} else if (status == SPEC_OK &&
		   (reshape->grid || rule == SPEC_INTERPOLATE_LINEAR)) {
		status = spec_spd_table_to_curve(&table, curve, error);
		if (status == SPEC_OK)
			status = shape(name, reshape, rule, curve, notes, error);
	} else if (status == SPEC_OK) {
		status = shape_by_rule(name, &table, reshape, curve, error);
	}
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

	if (status == SPEC_OK)
		status = check_plain(name, reshape, error);
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
