/*
 * Reading ENVI files: a text header beside raw data. What the header says that no field of
 * ours holds goes into attributes "envi:KEY", for enviwriter.c to write again.
 */
#include <math.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <strings.h>
#include <sys/stat.h>
#include <unistd.h>

#include "base/memory.h"
#include "base/number.h"
#include "base/path.h"
#include "image/description.h"
#include "image/enviheader.h"
#include "image/given.h"
#include "image/names.h"
#include "image/reading.h"
#include "image/samples.h"

#define MOST_HEADER (16 << 20) /* bytes */

/* Of ours, beside attributes. */
#define DISPLAY "spec:display window"
#define ASPECT "spec:pixel aspect"

struct envi_reader {
	struct spec_reader base;
	struct envi_header header;
	struct spec_source data; /* where the header is the file that was named */
	struct spec_source *from;
	size_t *band;          /* in the file, of each channel */
	double *gain, *offset; /* of each band in the file, or null */
	double ignored;        /* stands for no value; or NaN */
};

/* ---- the two files ---- */

static int
is_header(const unsigned char *bytes, size_t size)
{
	return size >= 5 && memcmp(bytes, "ENVI", 4) == 0 &&
	       (bytes[4] == '\n' || bytes[4] == '\r' || bytes[4] == ' ');
}

/* Where a path's suffix begins, or its end. */
static size_t
stem_length(const char *path)
{
	return (size_t)(spec_path_suffix(path) - path);
}

/* A path of which the first so many bytes are followed by a suffix; empty: too long. */
static void
with_suffix(char *path, size_t room, const char *stem, size_t length, const char *suffix)
{
	if (length + strlen(suffix) >= room)
		*path = '\0';
	else
		snprintf(path, room, "%.*s%s", (int)length, stem, suffix);
}

/* The header of raw data: NAME.hdr beside NAME.img or NAME, or NAME.img.hdr. */
static int
find_header(const char *path, char *header, size_t room)
{
	size_t ends[] = {strlen(path), stem_length(path)};

	for (size_t i = 0; i < 2; i++) {
		unsigned char bytes[8];
		size_t got;
		FILE *file;

		with_suffix(header, room, path, ends[i], ".hdr");
		file = *header && strcmp(header, path) != 0 ? fopen(header, "re") : NULL;
		if (!file)
			continue;
		got = fread(bytes, 1, sizeof bytes, file);
		fclose(file);
		if (is_header(bytes, got))
			return 1;
	}
	return 0;
}

static int
recognises(const unsigned char *bytes, size_t size, const char *path)
{
	char header[4096];

	return is_header(bytes, size) ||
	       (strcmp(path, "-") != 0 && find_header(path, header, sizeof header));
}

/* The data of a header's path; the header's own name stands for them in messages. */
static enum spec_status
open_data(struct envi_reader *reader, const char *path, struct spec_error *error)
{
	static const char *const suffixes[] = {"", ".img", ".raw", ".dat", ".bin", ".bsq",
		".bil", ".bip", ".cube", ".hyspex", ".IMG", ".RAW", ".DAT", ".BIN", ".BSQ",
		".BIL", ".BIP"};
	char name[4096];
	struct stat about;

	if (strcmp(path, "-") == 0)
		return spec_error_set(error, SPEC_EUSAGE,
			"%s: is the header of an ENVI file, whose data lie in another one: "
			"name the file",
			reader->base.source.name);
	for (size_t i = 0; i < sizeof suffixes / sizeof *suffixes; i++) {
		with_suffix(name, sizeof name, path, stem_length(path), suffixes[i]);
		/* A folder of the image's name is often beside it. */
		if (*name && strcmp(name, path) != 0 && stat(name, &about) == 0 &&
			!S_ISDIR(about.st_mode)) {
			reader->from = &reader->data;
			return spec_source_open(&reader->data, name, 1, error);
		}
	}
	return spec_error_set(error, SPEC_EIO,
		"%s: the data that it describes were not found beside it (%.*s, .img, .raw "
		"…)",
		path, (int)stem_length(path), path);
}

static enum spec_status
read_all(struct spec_source *source, char **text, size_t *size, struct spec_error *error)
{
	enum spec_status status = SPEC_OK;
	size_t room = 0, got = 1;
	void *list = NULL;

	*size = 0;
	while (status == SPEC_OK && got > 0) {
		status = spec_memory_grow(&list, &room, *size + 65536, 1, "bytes", error);
		*text = list;
		if (status == SPEC_OK)
			status = spec_source_read(source, *text + *size, room - *size,
				(int64_t)*size, &got, error);
		*size += got;
		if (status == SPEC_OK && *size > MOST_HEADER)
			status = spec_error_set(error, SPEC_ERANGE,
				"%s: a header of more than %d bytes", source->name,
				MOST_HEADER);
	}
	return status;
}

static enum spec_status
read_header(struct envi_reader *reader, const char *path, struct spec_error *error)
{
	struct spec_source other = {.fd = -1};
	struct spec_source *source = &reader->base.source;
	unsigned char bytes[8];
	char name[4096], *text = NULL;
	size_t got, size = 0;
	enum spec_status status =
		spec_source_read(source, bytes, sizeof bytes, 0, &got, error);

	if (status == SPEC_OK && is_header(bytes, got)) {
		status = open_data(reader, path, error);
	} else if (status == SPEC_OK) {
		reader->from = source;
		find_header(path, name, sizeof name);
		source = &other;
		status = spec_source_open(&other, name, MOST_HEADER, error);
	}
	if (status == SPEC_OK)
		status = read_all(source, &text, &size, error);
	if (status == SPEC_OK)
		status =
			envi_header_parse(text, size, source->name, &reader->header, error);
	free(text);
	if (source == &other)
		spec_source_close(&other);
	return status;
}

/* ---- what the header says of the image ---- */

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

static enum spec_status
check_data(const struct envi_reader *reader, struct spec_error *error)
{
	const struct envi_header *header = &reader->header;
	long long needed;

	if (__builtin_mul_overflow(header->lines * header->samples,
		    header->bands * (long long)envi_type_bytes(header->type), &needed) ||
		__builtin_add_overflow(needed, header->offset, &needed))
		return spec_error_set(error, SPEC_ERANGE,
			"%s: describes more bytes than a file can have",
			reader->base.source.name);
	if (!reader->from->seekable)
		return spec_error_set(error, SPEC_EUNSUPPORTED,
			"%s: the data of an ENVI file must be a regular file",
			reader->from->name);
	if (reader->from->size < needed)
		return spec_error_set(error, SPEC_EFORMAT,
			"%s: ends early: has %lld bytes instead of %lld",
			reader->from->name, (long long)reader->from->size, needed);
	return SPEC_OK;
}

static enum spec_status
open_reader(struct spec_reader *base, const char *path,
	const struct spec_settings *settings, struct spec_error *error)
{
	struct envi_reader *reader = (struct envi_reader *)base;
	const struct envi_header *header = &reader->header;
	double *wavelength_nm = NULL;
	enum spec_role role = SPEC_ROLE_OTHER;
	enum spec_status status;

	reader->data.fd = -1;
	status = read_header(reader, path, error);
	if (status == SPEC_OK && header->bands > settings->limits.channels)
		status = spec_error_set(error, SPEC_ERANGE,
			"%s: %lld bands are more than the limit of %lld (--limit channels=N)",
			base->source.name, header->bands, settings->limits.channels);
	if (status == SPEC_OK)
		status = spec_reading_check_size(
			base, header->samples, header->lines, error);
	if (status == SPEC_OK)
		status = check_data(reader, error);
	if (status == SPEC_OK)
		status = set_window(reader, error);
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
	if (status == SPEC_OK)
		spec_source_seal(reader->from);
	base->chunk_lines = 1;
	base->line_bytes = (size_t)(header->samples * header->bands) *
			   (sizeof(float) > envi_type_bytes(header->type)
					   ? sizeof(float)
					   : envi_type_bytes(header->type));
	return status == SPEC_OK ? spec_reading_check_memory(base, error) : status;
}

static void
close_reader(struct spec_reader *base)
{
	struct envi_reader *reader = (struct envi_reader *)base;

	envi_header_free(&reader->header);
	spec_source_close(&reader->data);
	free(reader->band);
	free(reader->gain);
	free(reader->offset);
}

/* ---- lines ---- */

static enum spec_status
read_bytes(struct envi_reader *reader, unsigned char *to, size_t size, long long at,
	struct spec_error *error)
{
	size_t got;
	enum spec_status status = spec_source_read(
		reader->from, to, size, reader->header.offset + at, &got, error);

	if (status == SPEC_OK && got < size)
		status = spec_error_set(
			error, SPEC_EFORMAT, "%s: ends early", reader->from->name);
	return status;
}

static int
shares(const struct spec_reader *reader)
{
	return ((const struct envi_reader *)reader)->from->seekable;
}

/* Of a BSQ file the wanted bands alone, each with its lines; of others the lines. */
static enum spec_status
fetch(struct spec_decoder *decoder, struct spec_error *error)
{
	struct envi_reader *reader = (struct envi_reader *)decoder->reader;
	const struct envi_header *header = &reader->header;
	size_t bytes = (size_t)header->samples * envi_type_bytes(header->type),
	       block = bytes * decoder->lines;
	long long first = decoder->y0 - reader->base.image.data.y0;
	enum spec_status status = spec_reading_reserve(
		&decoder->packed, block * (size_t)header->bands, 0, error);

	if (status != SPEC_OK)
		return status;
	if (header->interleave != ENVI_BSQ)
		return read_bytes(reader, decoder->packed.bytes,
			block * (size_t)header->bands,
			first * (long long)bytes * header->bands, error);
	for (size_t i = 0; i < reader->base.image.channels && status == SPEC_OK; i++) {
		size_t band = reader->band[i];

		if (decoder->wanted[i])
			status = read_bytes(reader, decoder->packed.bytes + band * block,
				block,
				((long long)band * header->lines + first) *
					(long long)bytes,
				error);
	}
	return status;
}

/* Reads count numbers of a C type, step bytes apart, in either byte order. */
#define CONVERT(type, bits)                                                                \
	for (size_t x = 0; x < count; x++, from += step) {                                 \
		uint##bits##_t raw;                                                        \
		type number;                                                               \
                                                                                           \
		memcpy(&raw, from, sizeof raw);                                            \
		if (swapped)                                                               \
			raw = __builtin_bswap##bits(raw);                                  \
		memcpy(&number, &raw, sizeof number);                                      \
		to[x] = (float)number;                                                     \
	}                                                                                  \
	break

static void
convert(int type, int swapped, const unsigned char *from, size_t step, float *to,
	size_t count)
{
	switch (type) {
	case ENVI_U8:
		for (size_t x = 0; x < count; x++, from += step)
			to[x] = *from;
		break;
	case ENVI_I16:
		CONVERT(int16_t, 16);
	case ENVI_U16:
		CONVERT(uint16_t, 16);
	case ENVI_I32:
		CONVERT(int32_t, 32);
	case ENVI_U32:
		CONVERT(uint32_t, 32);
	case ENVI_I64:
		CONVERT(int64_t, 64);
	case ENVI_U64:
		CONVERT(uint64_t, 64);
	case ENVI_F64:
		CONVERT(double, 64);
	default:
		CONVERT(float, 32);
	}
}

static void
scale(const struct envi_reader *reader, size_t band, float *row, size_t count)
{
	double gain = reader->gain ? reader->gain[band] : 1,
	       offset = reader->offset ? reader->offset[band] : 0;

	if (!isnan(reader->ignored)) {
		for (size_t x = 0; x < count; x++)
			if (row[x] == (float)reader->ignored)
				row[x] = NAN;
	}
	if (gain == 1 && offset == 0)
		return;
	for (size_t x = 0; x < count; x++)
		row[x] = (float)(row[x] * gain + offset);
}

/* Where a band's first sample in a line of what was fetched lies, in samples. */
static size_t
place(const struct envi_header *header, size_t band, size_t line, size_t lines)
{
	size_t width = (size_t)header->samples, bands = (size_t)header->bands;

	switch (header->interleave) {
	case ENVI_BSQ:
		return (band * lines + line) * width;
	case ENVI_BIL:
		return (line * bands + band) * width;
	default:
		return line * width * bands + band;
	}
}

/* Floats of this machine's that lie line by line can be used where they were fetched. */
static int
needs_no_copy(const struct envi_reader *reader)
{
	const struct envi_header *header = &reader->header;

	return header->type == ENVI_F32 && !header->swapped &&
	       header->interleave != ENVI_BIP && !reader->gain && !reader->offset &&
	       isnan(reader->ignored);
}

static void
point(struct spec_decoder *decoder, const struct envi_reader *reader)
{
	size_t channels = reader->base.image.channels, lines = (size_t)decoder->lines;

	for (size_t i = 0; i < lines * channels; i++)
		decoder->row[i] = (float *)(void *)decoder->packed.bytes +
				  place(&reader->header, reader->band[i % channels],
					  i / channels, lines);
}

/* One line; pixel by pixel so few at a time that their bands stay in the cache. */
static void
decode_line(const struct envi_reader *reader, const struct spec_decoder *decoder,
	size_t line, float *const *row)
{
	const struct envi_header *header = &reader->header;
	size_t size = envi_type_bytes(header->type), width = (size_t)header->samples,
	       channels = reader->base.image.channels, pixel = (size_t)header->bands * size,
	       step = header->interleave == ENVI_BIP ? pixel : size,
	       run = header->interleave == ENVI_BIP ? spec_reading_run(pixel) : width;

	for (size_t x = 0; x < width; x += run) {
		for (size_t i = 0; i < channels; i++) {
			const unsigned char *from = decoder->packed.bytes +
						    place(header, reader->band[i], line,
							    (size_t)decoder->lines) *
							    size +
						    x * step;

			if (row[i])
				convert(header->type, header->swapped, from, step,
					row[i] + x, width - x < run ? width - x : run);
		}
	}
	for (size_t i = 0; i < channels; i++) {
		if (row[i])
			scale(reader, reader->band[i], row[i], width);
	}
}

static enum spec_status
decode(struct spec_decoder *decoder, struct spec_error *error)
{
	const struct envi_reader *reader = (const struct envi_reader *)decoder->reader;
	enum spec_status status;

	if (needs_no_copy(reader)) {
		point(decoder, reader);
		return SPEC_OK;
	}
	status = spec_reading_planes(decoder, error);
	for (size_t line = 0; status == SPEC_OK && line < (size_t)decoder->lines; line++)
		decode_line(reader, decoder, line,
			decoder->row + line * reader->base.image.channels);
	return status;
}

const struct spec_reading_format spec_reading_envi = {
	.name = "ENVI",
	.reader_bytes = sizeof(struct envi_reader),
	.decoder_bytes = sizeof(struct spec_decoder),
	.recognises = recognises,
	.open = open_reader,
	.close = close_reader,
	.shares = shares,
	.fetch = fetch,
	.decode = decode,
};
