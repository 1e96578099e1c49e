/*
 * What the header of an ENVI file says of the image. What no field of ours holds goes into
 * attributes "envi:KEY", for enviwriter.c to write again.
 */
#include <math.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <strings.h>

#include "base/memory.h"
#include "base/number.h"
#include "image/description.h"
#include "image/envireading.h"
#include "image/given.h"
#include "image/names.h"
#include "image/samples.h"

/* Of ours, beside attributes. */
#define DISPLAY "spec:display window"
#define ASPECT "spec:pixel aspect"

/* Nanometres per unit of "wavelength"; 0: a wavenumber or a frequency; -1: unknown. */
static double
unit_nm(const char *unit)
{
	static const struct {
		const char *name;
		double nm;
	} units[] = {{"nanometers", 1}, {"nanometer", 1}, {"nm", 1}, {"micrometers", 1e3},
		{"micrometer", 1e3}, {"microns", 1e3}, {"um", 1e3}, {"millimeters", 1e6},
		{"mm", 1e6}, {"centimeters", 1e7}, {"cm", 1e7}, {"meters", 1e9}, {"m", 1e9},
		{"angstroms", .1}};

	for (size_t i = 0; unit && i < sizeof units / sizeof *units; i++)
		if (strcasecmp(unit, units[i].name) == 0)
			return units[i].nm;
	return -1;
}

/* The wavelength that a number in a unit of the reciprocal kind stands for; 0: no such unit. */
static double
reciprocal_nm(const char *unit, double number)
{
	static const struct {
		const char *name;
		double nm; /* of the number 1 */
	} units[] = {{"wavenumber", 1e7}, {"ghz", 299792458.}, {"mhz", 299792458e3}};

	for (size_t i = 0; unit && i < sizeof units / sizeof *units; i++)
		if (strcasecmp(unit, units[i].name) == 0)
			return number > 0 ? units[i].nm / number : 0;
	return 0;
}

/*
 * The bands' wavelengths, of the header or of the user. Without a unit, numbers below 100
 * are micrometres, as in ENVI itself.
 */
static enum spec_status
get_wavelengths(struct envi_reader *reader, const struct spec_settings *settings,
	double **wavelength_nm, struct spec_error *error)
{
	const struct envi_header *header = &reader->header;
	const char *name = reader->base.source.name,
		   *unit = envi_header_find(header, "wavelength units");
	struct spec_grid grid;
	enum spec_status status;

	*wavelength_nm = NULL;
	if (!settings->wavelengths) {
		status = envi_header_numbers(
			header, "wavelength", name, wavelength_nm, error);
		if (status != SPEC_OK)
			return status;
	}
	if (!*wavelength_nm) {
		status = spec_given_wavelengths(
			settings, (size_t)header->bands, name, &grid, error);
		*wavelength_nm = grid.wavelength_nm;
		return status;
	}
	for (long long i = 0; i < header->bands; i++) {
		double number = (*wavelength_nm)[i], nm = unit_nm(unit);

		if (!unit || strcasecmp(unit, "unknown") == 0 || !*unit)
			nm = number < 100 ? 1e3 : 1;
		nm = nm > 0 ? number * nm : reciprocal_nm(unit, number);
		if (!(nm >= SPEC_NAMES_SHORTEST_NM && nm <= SPEC_NAMES_LONGEST_NM))
			return spec_error_set(error, SPEC_EFORMAT,
				"%s: the wavelength %g %s of band %lld is none (--wavelengths "
				"tells others)",
				name, number, unit ? unit : "", i + 1);
		(*wavelength_nm)[i] = nm;
	}
	return SPEC_OK;
}

static int
mentions(const char *text, const char *word)
{
	return text && strcasestr(text, word);
}

/* Light or reflectance, as the user or the header says it. */
static enum spec_status
get_role(const struct envi_reader *reader, const struct spec_settings *settings,
	enum spec_role *role, struct spec_error *error)
{
	static const char *const keys[] = {"spec:quantity", "data units", "z plot titles",
		"description", "band names"};
	const struct envi_header *header = &reader->header;

	*role = settings->read_as;
	if (*role != SPEC_ROLE_OTHER)
		return SPEC_OK;
	for (size_t i = 0; i < sizeof keys / sizeof *keys; i++) {
		const char *text = envi_header_find(header, keys[i]);
		int light = mentions(text, "radiance"),
		    ratio = mentions(text, "reflectance") ||
			    mentions(text, "transmittance");

		if (light != ratio) {
			*role = light ? SPEC_ROLE_EMISSIVE : SPEC_ROLE_REFLECTIVE;
			return SPEC_OK;
		}
	}
	if (envi_header_find(header, "reflectance scale factor")) {
		*role = SPEC_ROLE_REFLECTIVE;
		return SPEC_OK;
	}
	return spec_error_set(error, SPEC_EUSAGE,
		"%s: does not say whether it holds radiance or reflectance (--read-as)",
		reader->base.source.name);
}

/* The number of a field; what is no number (NaN is written, too) is an error. */
static enum spec_status
get_number(const struct envi_reader *reader, const char *key, const char *text,
	double least, double most, double *number, struct spec_error *error)
{
	enum spec_status status;

	if (strcasecmp(text, "nan") == 0 && least == -HUGE_VAL) {
		*number = NAN;
		return SPEC_OK;
	}
	status = spec_number_parse(text, least, most, key, number, error);
	if (status != SPEC_OK)
		spec_error_prefix(error, "%s", reader->base.source.name);
	return status;
}

/* Gains and offsets, which there need not be yet, by a factor. */
static enum spec_status
divide(struct envi_reader *reader, double factor, struct spec_error *error)
{
	size_t bands = (size_t)reader->header.bands;

	if (!reader->gain) {
		reader->gain = spec_memory_new(bands, sizeof *reader->gain, "bands", error);
		for (size_t i = 0; reader->gain && i < bands; i++)
			reader->gain[i] = 1;
	}
	if (!reader->gain)
		return SPEC_ENOMEM;
	for (size_t i = 0; i < bands; i++) {
		reader->gain[i] /= factor;
		if (reader->offset)
			reader->offset[i] /= factor;
	}
	return SPEC_OK;
}

/* value = (number * gain + offset) / reflectance scale factor, where the header says so. */
static enum spec_status
get_scale(struct envi_reader *reader, struct spec_error *error)
{
	const struct envi_header *header = &reader->header;
	const char *name = reader->base.source.name,
		   *scale = envi_header_find(header, "reflectance scale factor"),
		   *ignored = envi_header_find(header, "data ignore value");
	enum spec_status status =
		envi_header_numbers(header, "data gain values", name, &reader->gain, error);
	double factor = 1;

	reader->ignored = NAN;
	if (status == SPEC_OK)
		status = envi_header_numbers(
			header, "data offset values", name, &reader->offset, error);
	if (status == SPEC_OK && ignored)
		status = get_number(reader, "data ignore value", ignored, -HUGE_VAL,
			HUGE_VAL, &reader->ignored, error);
	if (status == SPEC_OK && scale)
		status = get_number(reader, "reflectance scale factor", scale, 1e-30, 1e30,
			&factor, error);
	if (status != SPEC_OK)
		return status;
	return factor == 1 ? SPEC_OK : divide(reader, factor, error);
}

/*
 * Keys whose meaning a field of the image or of the reader holds, and lists by band, which
 * other bands would make wrong.
 */
static int
is_known(const char *key)
{
	static const char *const known[] = {"samples", "lines", "bands", "header offset",
		"data type", "byte order", "interleave", "file compression", "file type",
		"wavelength", "wavelength units", "data gain values", "data offset values",
		"reflectance scale factor", "data ignore value", "x start", "y start",
		"band names", "default bands", "fwhm", "bbl", DISPLAY, ASPECT};

	for (size_t i = 0; i < sizeof known / sizeof *known; i++)
		if (strcmp(key, known[i]) == 0)
			return 1;
	return 0;
}

static enum spec_status
keep_ours(struct envi_reader *reader, struct envi_field *field, struct spec_error *error)
{
	struct spec_image *image = &reader->base.image;
	const char *name = reader->base.source.name;
	long long samples;
	enum spec_status status;

	envi_text_decode(field->value);
	if (strcmp(field->key, "spec:samples") != 0)
		return spec_image_set_text(image, field->key, field->value, error);
	status = spec_number_parse_whole(
		field->value, 1, INT32_MAX, field->key, &samples, error);
	if (status != SPEC_OK) {
		spec_error_prefix(error, "%s", name);
		return status;
	}
	return spec_samples_set(image, samples, name, error);
}

static enum spec_status
keep_fields(struct envi_reader *reader, struct spec_error *error)
{
	const char *quantity = envi_header_find(&reader->header, "spec:quantity");
	enum spec_status status = SPEC_OK;
	char name[250];

	for (size_t i = 0; i < reader->header.fields && status == SPEC_OK; i++) {
		struct envi_field *field = &reader->header.field[i];

		if (is_known(field->key) || !*field->key || strlen(field->key) > 200)
			continue;
		if (quantity && strcmp(field->key, "data units") == 0 &&
			strcmp(field->value, quantity) == 0)
			continue; /* as our writer has them */
		if (strncmp(field->key, "spec:", 5) == 0) {
			status = keep_ours(reader, field, error);
			continue;
		}
		snprintf(name, sizeof name, "envi:%s", field->key);
		status =
			spec_image_set_text(&reader->base.image, name, field->value, error);
	}
	return status;
}

/* A window's corner, which ENVI counts from 1. */
static enum spec_status
get_corner(const struct envi_reader *reader, const char *key, int *corner,
	struct spec_error *error)
{
	const char *text = envi_header_find(&reader->header, key);
	double value = 1;
	enum spec_status status =
		text ? get_number(reader, key, text, -(1 << 29), 1 << 29, &value, error)
		     : SPEC_OK;

	*corner = (int)floor(value) - 1;
	return status;
}

static enum spec_status
set_window(struct envi_reader *reader, struct spec_error *error)
{
	struct spec_image *image = &reader->base.image;
	const char *display = envi_header_find(&reader->header, DISPLAY),
		   *aspect = envi_header_find(&reader->header, ASPECT);
	double ratio = 1;
	enum spec_status status = get_corner(reader, "x start", &image->data.x0, error);

	if (status == SPEC_OK)
		status = get_corner(reader, "y start", &image->data.y0, error);
	image->data.x1 = image->data.x0 + (int)reader->header.samples;
	image->data.y1 = image->data.y0 + (int)reader->header.lines;
	image->display = image->data;
	if (status == SPEC_OK && display) {
		status = spec_description_parse_window(display, &image->display, error);
		if (status != SPEC_OK)
			spec_error_prefix(error, "%s", reader->base.source.name);
	}
	if (status == SPEC_OK && aspect)
		status = get_number(reader, ASPECT, aspect, 1e-6, 1e6, &ratio, error);
	image->pixel_aspect_ratio = (float)ratio;
	image->screen_window_width = 1;
	return status;
}

/* The channels in the layout's names, and which band of the file each one is. */
static enum spec_status
set_bands(struct envi_reader *reader, const double *wavelength_nm, enum spec_role role,
	struct spec_error *error)
{
	struct spec_image *image = &reader->base.image;
	size_t bands = (size_t)reader->header.bands;
	enum spec_status status = spec_image_add_bands(
		image, role, 1, wavelength_nm, bands, SPEC_SAMPLE_FLOAT, error);

	if (status == SPEC_OK)
		status = spec_image_index(image, reader->base.source.name, error);
	reader->band = spec_memory_new(bands, sizeof *reader->band, "bands", error);
	if (status != SPEC_OK || !reader->band)
		return status == SPEC_OK ? SPEC_ENOMEM : status;
	for (size_t i = 0; i < bands; i++) {
		int same;
		size_t found = spec_image_nearest_band(image, wavelength_nm[i], &same);

		reader->band[image->band_channel[found]] = i;
	}
	return SPEC_OK;
}

enum spec_status
envi_describe(struct envi_reader *reader, const struct spec_settings *settings,
	struct spec_error *error)
{
	double *wavelength_nm = NULL;
	enum spec_role role = SPEC_ROLE_OTHER;
	enum spec_status status = set_window(reader, error);

	if (status == SPEC_OK)
		status = get_role(reader, settings, &role, error);
	if (status == SPEC_OK)
		status = get_wavelengths(reader, settings, &wavelength_nm, error);
	if (status == SPEC_OK)
		status = get_scale(reader, error);
	if (status == SPEC_OK)
		status = keep_fields(reader, error);
	if (status == SPEC_OK)
		status = set_bands(reader, wavelength_nm, role, error);
	free(wavelength_nm);
	return status;
}
