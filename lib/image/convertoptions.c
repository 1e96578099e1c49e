#include "image/convertoptions.h"

#include <stdlib.h>
#include <string.h>

#include "base/memory.h"
#include "base/number.h"
#include "image/gridof.h"

#define MOST_FACTOR (1 << 16) /* of --downsample */
#define LEAST 1e-3            /* of the most light, for --reflectance-of */

void
spec_convert_options_init(struct spec_convert_options *options)
{
	*options = (struct spec_convert_options){.setup = {.downsample = 1, .least = -1}};
}

void
spec_convert_options_free(struct spec_convert_options *options)
{
	for (size_t i = 0; i < options->setup.operations; i++)
		spec_operation_free(&options->operation[i]);
	free(options->operation);
	free(options->edges_nm);
	spec_grid_free(&options->grid);
	spec_grid_free(&options->bands);
	*options = (struct spec_convert_options){0};
}

/* ---- taking ---- */

static int
compare_numbers(const void *a, const void *b)
{
	const double *one = a, *two = b;

	return (*one > *two) - (*one < *two);
}

static enum spec_status
take_band(struct spec_convert_options *options, const char *text, struct spec_error *error)
{
	void *list = options->bands.wavelength_nm;
	double wavelength_nm;
	enum spec_status status =
		spec_number_parse_length(text, "the band", &wavelength_nm, error);

	if (status == SPEC_OK)
		status = spec_memory_grow(&list, &options->band_room,
			options->bands.count + 1, sizeof(double), "bands", error);
	options->bands.wavelength_nm = list;
	if (status != SPEC_OK)
		return status;
	for (size_t i = 0; i < options->bands.count; i++) {
		if (options->bands.wavelength_nm[i] == wavelength_nm)
			return SPEC_OK;
	}
	options->bands.wavelength_nm[options->bands.count++] = wavelength_nm;
	qsort(list, options->bands.count, sizeof(double), compare_numbers);
	return SPEC_OK;
}

/* Room for one operation more. */
static enum spec_status
grow(struct spec_convert_options *options, struct spec_error *error)
{
	void *list = options->operation;
	enum spec_status status = spec_memory_grow(&list, &options->operation_room,
		options->setup.operations + 1, sizeof *options->operation, "operations",
		error);

	options->operation = list;
	return status;
}

static enum spec_status
take_operation(struct spec_convert_options *options, const char *name, const char *text,
	int *known, struct spec_error *error)
{
	enum spec_status status = grow(options, error);

	*known = 1;
	if (status == SPEC_OK)
		status = spec_operation_parse(name, text,
			&options->operation[options->setup.operations], known, error);
	if (status == SPEC_OK && *known)
		options->setup.operations++;
	return status;
}

enum spec_status
spec_convert_options_defer(struct spec_convert_options *options, const char *name,
	const char *value, int *known, struct spec_error *error)
{
	enum spec_status status = grow(options, error);

	*known = status == SPEC_OK &&
		 spec_operation_defer(
			 name, value, &options->operation[options->setup.operations]);
	options->setup.operations += (size_t)*known;
	return status;
}

static enum spec_status
take_per(struct spec_convert_options *options, const char *text, struct spec_error *error)
{
	if (strcmp(text, "nm") != 0 && strcmp(text, "band") != 0)
		return spec_error_set(error, SPEC_EUSAGE, "'%s' is not nm or band", text);
	options->setup.per = *text == 'n' ? SPEC_CONVERT_PER_NM : SPEC_CONVERT_PER_BAND;
	return SPEC_OK;
}

static enum spec_status
take_medium(struct spec_convert_options *options, enum spec_medium medium,
	struct spec_error *error)
{
	if (options->setup.medium != SPEC_MEDIUM_UNKNOWN && options->setup.medium != medium)
		return spec_error_set(
			error, SPEC_EUSAGE, "--to-air and --to-vacuum exclude each other");
	options->setup.medium = medium;
	return SPEC_OK;
}

static enum spec_status
take_rule(struct spec_convert_options *options, const char *text, struct spec_error *error)
{
	options->has_interpolation = 1;
	return spec_interpolate_parse(text, &options->setup.interpolation, error);
}

static enum spec_status
take_representation(
	struct spec_convert_options *options, const char *text, struct spec_error *error)
{
	options->has_to = 1;
	return spec_representation_parse(text, &options->to, error);
}

/* What is about pixels. */
static enum spec_status
take_pixels(struct spec_convert_options *options, const char *name, const char *value,
	int *known, struct spec_error *error)
{
	struct spec_convert_setup *setup = &options->setup;

	*known = 1;
	if (strcmp(name, "crop") == 0) {
		setup->has_crop = 1;
		return spec_settings_crop(value, &setup->crop, error);
	}
	if (strcmp(name, "downsample") == 0)
		return spec_number_parse_int(
			value, 1, MOST_FACTOR, "the factor", &setup->downsample, error);
	return take_operation(options, name, value, known, error);
}

enum spec_status
spec_convert_options_take(struct spec_convert_options *options, const char *name,
	const char *value, int *known, struct spec_error *error)
{
	struct spec_convert_setup *setup = &options->setup;

	*known = 1;
	if (strcmp(name, "grid") == 0)
		options->grid_text = value;
	else if (strcmp(name, "interp") == 0)
		return take_rule(options, value, error);
	else if (strcmp(name, "to") == 0)
		return take_representation(options, value, error);
	else if (strcmp(name, "rebin") == 0)
		setup->rebin = 1;
	else if (strcmp(name, "band") == 0)
		return take_band(options, value, error);
	else if (strcmp(name, "bands-only") == 0)
		setup->bands_only = 1;
	else if (strcmp(name, "per") == 0)
		return take_per(options, value, error);
	else if (strcmp(name, "to-air") == 0)
		return take_medium(options, SPEC_MEDIUM_AIR, error);
	else if (strcmp(name, "to-vacuum") == 0)
		return take_medium(options, SPEC_MEDIUM_VACUUM, error);
	else if (strcmp(name, "input-unit") == 0)
		return spec_abscissa_parse(value, &options->abscissa, error);
	else if (strcmp(name, "extrapolate") == 0)
		return spec_extrapolate_parse(value, 1, &setup->extrapolate, error);
	else if (strcmp(name, "least") == 0)
		return spec_number_parse(
			value, 0, 1, "the least light", &setup->least, error);
	else
		return take_pixels(options, name, value, known, error);
	return SPEC_OK;
}

/* ---- all together ---- */

/* What makes no sense together, or alone. */
static enum spec_status
check(const struct spec_convert_options *options, struct spec_error *error)
{
	const struct spec_convert_setup *setup = &options->setup;
	const char *wrong = NULL;
	int divides = 0;

	for (size_t i = 0; i < setup->operations; i++)
		divides |= options->operation[i].kind == SPEC_OPERATION_REFLECTANCE_OF;
	if (options->grid_text && options->bands.count > 0)
		wrong = "--grid and --band exclude each other";
	else if (setup->rebin && !options->grid_text)
		wrong = "--rebin needs the bins of a --grid";
	else if (options->grid_text && options->has_to)
		wrong = "--grid and --to exclude each other";
	else if (options->has_interpolation && setup->rebin)
		wrong = "--rebin and --interp exclude each other";
	else if (setup->least >= 0 && !divides)
		wrong = "--least is for --reflectance-of";
	return wrong ? spec_error_set(error, SPEC_EUSAGE, "%s", wrong) : SPEC_OK;
}

enum spec_status
spec_convert_options_settle(struct spec_convert_options *options,
	const struct spec_settings *settings, struct spec_error *error)
{
	struct spec_convert_setup *setup = &options->setup;
	enum spec_status status = check(options, error);

	if (status != SPEC_OK)
		return status;
	if (options->grid_text && strcmp(options->grid_text, "native") == 0)
		setup->rebin = 0;
	else if (options->grid_text)
		status = spec_grid_of(options->grid_text, settings, &options->grid,
			&options->edges_nm, error);
	if (setup->least < 0)
		setup->least = LEAST;
	setup->grid = options->grid.count > 0 ? &options->grid : NULL;
	setup->edges_nm = options->edges_nm;
	setup->bands = options->bands.count > 0 ? &options->bands : NULL;
	setup->operation = options->operation;
	setup->half = settings->half;
	return status;
}

int
spec_convert_options_change(const struct spec_convert_options *options)
{
	const struct spec_convert_setup *setup = &options->setup;

	return setup->grid || setup->bands || setup->bands_only || setup->operations > 0 ||
	       setup->has_crop || setup->downsample > 1 ||
	       setup->per != SPEC_CONVERT_AS_IT_IS || setup->medium != SPEC_MEDIUM_UNKNOWN;
}
