#include "spectrum/summary.h"

#include "spectrum/grid.h"

/* The extremes of a column: the indices of its samples, the first where several are equal. */
static void
find_extremes(
	const struct spec_curve *curve, size_t column, size_t *lowest, size_t *highest)
{
	const double *value = curve->value + column * curve->count;

	*lowest = *highest = 0;
	for (size_t i = 1; i < curve->count; i++) {
		if (value[i] < value[*lowest])
			*lowest = i;
		if (value[i] > value[*highest])
			*highest = i;
	}
}

static void
print_text(FILE *stream, const char *label, const char *text)
{
	if (!*text)
		return;
	fprintf(stream, "  %-13s ", label);
	for (; *text; text++)
		fputc((unsigned char)*text < ' ' || *text == 127 ? '?' : *text, stream);
	fputc('\n', stream);
}

static void
print_range(FILE *stream, const struct spec_curve *curve)
{
	const double *known = curve->wavelength_nm;
	double step_nm = spec_grid_step(known, curve->count);

	fprintf(stream, "  %-13s %zu, ", "samples", curve->count);
	if (curve->count == 1)
		fprintf(stream, "%.10g nm", known[0]);
	else
		fprintf(stream, "%.10g..%.10g nm", known[0], known[curve->count - 1]);
	if (step_nm > 0)
		fprintf(stream, " by %.7g nm", step_nm);
	else if (curve->count > 1)
		fputs(", irregular", stream);
	if (*curve->medium)
		fprintf(stream, ", in %s", curve->medium);
	fputc('\n', stream);
}

void
spec_summary_print(FILE *stream, const char *name, const struct spec_curve *curve)
{
	size_t lowest, highest;

	for (; *name; name++)
		fputc((unsigned char)*name < ' ' || *name == 127 ? '?' : *name, stream);
	fputs("\n  format        spd\n", stream);
	print_text(stream, "title", curve->title);
	print_text(stream, "quantity", curve->quantity);
	print_text(stream, "unit", curve->unit);
	print_text(stream, "source", curve->source);
	print_range(stream, curve);
	for (size_t i = 0; i < curve->columns; i++) {
		const double *value = curve->value + i * curve->count;

		find_extremes(curve, i, &lowest, &highest);
		fprintf(stream, "  %-13s %s: %.7g at %.10g nm to %.7g at %.10g nm\n",
			i == 0 ? "columns" : "", curve->column[i], value[lowest],
			curve->wavelength_nm[lowest], value[highest],
			curve->wavelength_nm[highest]);
	}
}

void
spec_summary_json_open(
	struct spec_json *json, const char *name, const struct spec_curve *curve)
{
	double step_nm = spec_grid_step(curve->wavelength_nm, curve->count);
	size_t lowest, highest;

	spec_json_open(json, NULL, '{', SPEC_JSON_LINES);
	spec_json_text(json, "file", name);
	spec_json_text(json, "format", "spd");
	spec_json_text(json, "title", curve->title);
	spec_json_text(json, "quantity", curve->quantity);
	spec_json_text(json, "unit", curve->unit);
	spec_json_text(json, "source", curve->source);
	spec_json_text(json, "medium", *curve->medium ? curve->medium : NULL);
	spec_json_whole(json, "count", (long long)curve->count);
	if (step_nm > 0)
		spec_json_number(json, "step_nm", step_nm);
	else
		spec_json_null(json, "step_nm");
	spec_json_numbers(json, "wavelength_nm", curve->wavelength_nm, curve->count);
	spec_json_open(json, "columns", '[', SPEC_JSON_LINES);
	for (size_t i = 0; i < curve->columns; i++) {
		const double *value = curve->value + i * curve->count;

		find_extremes(curve, i, &lowest, &highest);
		spec_json_open(json, NULL, '{', SPEC_JSON_INLINE);
		spec_json_text(json, "name", curve->column[i]);
		spec_json_number(json, "min", value[lowest]);
		spec_json_number(json, "min_nm", curve->wavelength_nm[lowest]);
		spec_json_number(json, "max", value[highest]);
		spec_json_number(json, "max_nm", curve->wavelength_nm[highest]);
		spec_json_close(json);
	}
	spec_json_close(json);
}
