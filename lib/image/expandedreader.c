/*
 * A reader made of a reader: where an image says that it holds coefficients or lines, this
 * one gives the bands that they stand for.
 */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "base/interval.h"
#include "base/memory.h"
#include "base/number.h"
#include "image/expandedreader.h"
#include "image/mix.h"
#include "image/represented.h"
#include "image/reading.h"

struct expanded_reader {
	struct spec_reader base;
	struct spec_reader *inner;
	struct spec_represented represented;
	double *back;
	size_t *origin; /* of each channel, the inner's, or its count: a band of ours */
	size_t *coefficient; /* [stokes][coefficients] of the inner's channels */
	size_t *line;        /* [stokes][lines][weight, wavelength] */
	size_t *smooth;      /* [stokes][bands], where the rest is in bands */
};

struct expanded_decoder {
	struct spec_decoder base;
	struct spec_decoder *inner;
	const float **in; /* coefficients, or bands, of one row */
	float **out;
};

/* ---- the header ---- */

/* Whether a channel is one of the representation's: S0.a0, T.line1.nm and so on. */
static int
is_coefficient(const struct spec_channel *channel)
{
	const char *name = channel->name, *rest;
	size_t digits;

	if (name[0] == 'T' && name[1] == '.')
		rest = name + 2;
	else if (name[0] == 'S' && name[1] >= '0' && name[1] <= '3' && name[2] == '.')
		rest = name + 3;
	else
		return 0;
	if (strncmp(rest, "line", 4) == 0)
		rest += 4;
	else if (*rest == 'a' || *rest == 'b')
		rest++;
	else
		return 0;
	digits = strspn(rest, "0123456789");
	return digits > 0 && (!rest[digits] || strcmp(rest + digits, ".nm") == 0);
}

/* The numbers of a text with blanks between; newly allocated. */
static enum spec_status
read_numbers(const char *text, double **number, size_t *count, struct spec_error *error)
{
	size_t room = 0;
	void *list = NULL;
	enum spec_status status = SPEC_OK;

	*count = 0;
	for (text += strspn(text, " "); *text && status == SPEC_OK;
		text += strspn(text, " ")) {
		double value;
		size_t length = spec_number_scan(text, '.', &value);

		if (length == 0 || !(value > 0) ||
			(*count > 0 && value <= ((double *)list)[*count - 1]))
			status = spec_error_set(error, SPEC_EFORMAT,
				"the attribute spec:wavelengths is damaged at '%.40s'",
				text);
		if (status == SPEC_OK)
			status = spec_memory_grow(
				&list, &room, *count + 1, sizeof value, "bands", error);
		if (status == SPEC_OK)
			((double *)list)[(*count)++] = value;
		text += length;
	}
	*number = list;
	return status;
}

/* Light or reflectance, and how many components: by the names of the coefficients. */
static enum spec_status
find_role(const struct spec_image *stored, enum spec_role *role, int *stokes,
	const char *name, struct spec_error *error)
{
	int light = spec_image_find_channel(stored, "S0.a0") < stored->channels,
	    ratio = spec_image_find_channel(stored, "T.a0") < stored->channels;

	*role = light ? SPEC_ROLE_EMISSIVE : SPEC_ROLE_REFLECTIVE;
	*stokes = spec_image_find_channel(stored, "S3.a0") < stored->channels ? 4 : 1;
	return light != ratio
		       ? SPEC_OK
		       : spec_error_set(error, SPEC_EFORMAT,
				 "%s: has no coefficients, or two kinds of them", name);
}

/* Bands in place of coefficients, at the wavelengths that the image names. */
static enum spec_status
add_named_bands(struct expanded_reader *reader, enum spec_role role, int stokes,
	struct spec_error *error)
{
	const struct spec_image *stored = spec_reader_image(reader->inner);
	char *text = NULL;
	double *wavelength_nm = NULL;
	size_t bands = 0;
	enum spec_status status = spec_image_text(stored, "spec:wavelengths", &text, error);

	if (status == SPEC_OK)
		status = read_numbers(text ? text : "", &wavelength_nm, &bands, error);
	if (status == SPEC_OK && bands < 2)
		status = spec_error_set(error, SPEC_EFORMAT,
			"the attribute spec:wavelengths names fewer than two bands");
	if (status == SPEC_OK &&
		bands * (size_t)stokes > (size_t)reader->base.limits.channels)
		status = spec_error_set(error, SPEC_ERANGE,
			"%zu bands are more than the limit of %lld channels (--limit "
			"channels=N)",
			bands, reader->base.limits.channels);
	if (status == SPEC_OK)
		status = spec_image_add_bands(&reader->base.image, role, stokes,
			wavelength_nm, bands, SPEC_SAMPLE_FLOAT, error);
	free(text);
	free(wavelength_nm);
	return status;
}

static enum spec_status
add_bands(struct expanded_reader *reader, struct spec_error *error)
{
	const char *name = reader->base.source.name;
	enum spec_role role;
	int stokes;
	enum spec_status status =
		find_role(spec_reader_image(reader->inner), &role, &stokes, name, error);

	if (status != SPEC_OK)
		return status;
	status = add_named_bands(reader, role, stokes, error);
	if (status != SPEC_OK && status != SPEC_ENOMEM)
		spec_error_prefix(error, "%s", name);
	return status;
}

static enum spec_status
make_image(struct expanded_reader *reader, struct spec_error *error)
{
	const struct spec_image *stored = spec_reader_image(reader->inner);
	struct spec_image *image = &reader->base.image;
	const char *name = reader->base.source.name;
	enum spec_status status = spec_image_copy(image, stored, error);

	if (status == SPEC_OK)
		spec_image_remove_channels(image, is_coefficient);
	if (status == SPEC_OK && reader->represented.coefficients > 0)
		status = add_bands(reader, error);
	spec_image_remove_attribute(image, "spec:representation");
	spec_image_remove_attribute(image, "spec:wavelengths");
	return status == SPEC_OK ? spec_image_index(image, name, error) : status;
}

/* ---- where everything lies ---- */

static enum spec_status
find_channel(const struct expanded_reader *reader, const char *channel, size_t *found,
	struct spec_error *error)
{
	const struct spec_image *stored = spec_reader_image(reader->inner);

	*found = spec_image_find_channel(stored, channel);
	return *found < stored->channels
		       ? SPEC_OK
		       : spec_error_set(error, SPEC_EFORMAT, "%s: lacks the channel '%s'",
				 reader->base.source.name, channel);
}

static enum spec_status
find_component(const struct expanded_reader *reader, int stokes, struct spec_error *error)
{
	const struct spec_represented *represented = &reader->represented;
	const char *prefix = spec_represented_prefix(reader->base.image.role, stokes);
	size_t *coefficient =
		       reader->coefficient + (size_t)stokes * represented->coefficients,
	       *line = reader->line + (size_t)stokes * represented->lines * 2;
	char name[64], other[64];
	enum spec_status status = SPEC_OK;

	for (size_t i = 0; i < represented->coefficients && status == SPEC_OK; i++) {
		spec_represented_name(name, sizeof name, prefix, i);
		status = find_channel(reader, name, &coefficient[i], error);
	}
	for (size_t i = 0; i < represented->lines && status == SPEC_OK; i++) {
		spec_represented_line_names(name, other, sizeof name, prefix, i);
		status = find_channel(reader, name, &line[2 * i], error);
		if (status == SPEC_OK)
			status = find_channel(reader, other, &line[2 * i + 1], error);
	}
	return status;
}

static enum spec_status
find_channels(struct expanded_reader *reader, struct spec_error *error)
{
	const struct spec_image *image = &reader->base.image,
				*stored = spec_reader_image(reader->inner);
	size_t stokes = (size_t)image->stokes, lines = reader->represented.lines,
	       count = reader->represented.coefficients;
	enum spec_status status = SPEC_OK;

	reader->origin =
		spec_memory_new(image->channels, sizeof(size_t), "channels", error);
	reader->coefficient =
		spec_memory_new(stokes * count, sizeof(size_t), "channels", error);
	reader->line =
		spec_memory_new(stokes * lines, 2 * sizeof(size_t), "channels", error);
	reader->smooth =
		spec_memory_new(stokes * image->bands, sizeof(size_t), "channels", error);
	if (!reader->origin || !reader->coefficient || !reader->line || !reader->smooth)
		return SPEC_ENOMEM;
	for (int i = 0; i < image->stokes && status == SPEC_OK; i++)
		status = find_component(reader, i, error);
	for (size_t i = 0; i < image->channels; i++)
		reader->origin[i] = spec_image_find_channel(stored, image->channel[i].name);
	for (size_t i = 0; i < stokes * image->bands; i++) {
		reader->smooth[i] = reader->origin[image->band_channel[i]];
		reader->origin[image->band_channel[i]] = stored->channels;
	}
	return status;
}

/* ---- the reader ---- */

static void
close_reader(struct spec_reader *base)
{
	struct expanded_reader *reader = (struct expanded_reader *)base;

	spec_reader_close(reader->inner);
	free(reader->back);
	free(reader->origin);
	free(reader->coefficient);
	free(reader->line);
	free(reader->smooth);
}

static enum spec_status
settle(struct expanded_reader *reader, struct spec_error *error)
{
	struct spec_reader *base = &reader->base;
	const struct spec_image *image = &base->image;
	size_t floats, stored = spec_reader_line_bytes(reader->inner);
	enum spec_status status = make_image(reader, error);

	if (status == SPEC_OK && image->bands == 0)
		status = spec_error_set(error, SPEC_EFORMAT,
			"%s: has lines and no smooth part", base->source.name);
	if (status == SPEC_OK)
		status = find_channels(reader, error);
	if (status != SPEC_OK)
		return status;
	floats = spec_window_width(&image->data) * image->channels * sizeof(float);
	base->chunk_lines = spec_reader_chunk_lines(reader->inner);
	base->line_bytes = floats > stored ? floats : stored;
	if (reader->represented.coefficients > 0) {
		reader->back = spec_represented_back(&reader->represented,
			image->wavelength_nm, image->edges_nm, image->bands, error);
		if (!reader->back)
			return SPEC_ENOMEM;
	}
	return spec_reading_check_memory(base, error);
}

enum spec_status
spec_expanded_open(struct spec_reader **reader, const struct spec_represented *represented,
	struct spec_error *error)
{
	struct spec_reader *inner = *reader;
	const char *name = spec_reader_name(inner);
	struct expanded_reader *outer = spec_memory_new(1, sizeof *outer, "readers", error);
	enum spec_status status;

	if (!outer)
		return SPEC_ENOMEM;
	outer->base.format = &spec_reading_expanded;
	outer->base.limits = inner->limits;
	outer->base.source = (struct spec_source){.fd = -1, .size = -1};
	outer->represented = *represented;
	outer->base.source.name = spec_memory_text(name, strlen(name), error);
	if (!outer->base.source.name) {
		free(outer);
		return SPEC_ENOMEM;
	}
	outer->inner = inner;
	outer->base.storage = inner->storage;
	status = spec_image_text(spec_reader_image(inner), "spec:representation",
		&outer->base.representation, error);
	if (status == SPEC_OK)
		status = settle(outer, error);
	if (status == SPEC_OK) {
		*reader = &outer->base;
	} else {
		outer->inner = NULL;
		spec_reader_close(&outer->base);
	}
	return status;
}

/* ---- lines ---- */

static enum spec_status
open_decoder(struct spec_decoder *base, struct spec_error *error)
{
	struct expanded_decoder *decoder = (struct expanded_decoder *)base;
	const struct expanded_reader *reader = (struct expanded_reader *)base->reader;
	const struct spec_image *image = &reader->base.image,
				*stored = spec_reader_image(reader->inner);
	size_t count = reader->represented.coefficients, lines = reader->represented.lines;
	unsigned char *wanted = spec_memory_new(stored->channels, 1, "channels", error);
	enum spec_status status = wanted ? SPEC_OK : SPEC_ENOMEM;

	for (size_t i = 0; wanted && i < image->channels; i++)
		if (base->wanted[i] && reader->origin[i] < stored->channels)
			wanted[reader->origin[i]] = 1;
	for (size_t i = 0; wanted && i < (size_t)image->stokes * image->bands; i++) {
		size_t stokes = i / image->bands;

		if (!base->wanted[image->band_channel[i]])
			continue;
		for (size_t k = 0; k < count; k++)
			wanted[reader->coefficient[stokes * count + k]] = 1;
		for (size_t k = 0; k < 2 * lines; k++)
			wanted[reader->line[stokes * 2 * lines + k]] = 1;
		if (count == 0)
			wanted[reader->smooth[i]] = 1;
	}
	if (status == SPEC_OK)
		status = spec_decoder_open(&decoder->inner, reader->inner, wanted, error);
	free(wanted);
	decoder->in = spec_memory_new(count + 1, sizeof *decoder->in, "rows", error);
	decoder->out = spec_memory_new(image->bands, sizeof *decoder->out, "rows", error);
	return status == SPEC_OK && (!decoder->in || !decoder->out) ? SPEC_ENOMEM : status;
}

static void
close_decoder(struct spec_decoder *base)
{
	struct expanded_decoder *decoder = (struct expanded_decoder *)base;

	spec_decoder_close(decoder->inner);
	free(decoder->in);
	free(decoder->out);
}

static int
shares(const struct spec_reader *reader)
{
	return spec_reader_shares(((const struct expanded_reader *)reader)->inner);
}

static enum spec_status
fetch(struct spec_decoder *base, struct spec_error *error)
{
	return spec_decoder_fetch(((struct expanded_decoder *)base)->inner, base->y0,
		base->y0 + base->lines, error);
}

/* The width that a sample stands for in an integral by trapezoids. */
static double
cell_nm(const struct spec_image *image, size_t i)
{
	const double *nm = image->wavelength_nm;
	double low_nm = i > 0 ? nm[i - 1] : nm[i],
	       high_nm = i + 1 < image->bands ? nm[i + 1] : nm[i];

	return (high_nm - low_nm) / 2;
}

/*
 * A line goes into the bin that holds it, or, of point samples, to the two that it lies
 * between, so that the integral by trapezoids and the centre are the line's.
 */
static void
add_line(const struct spec_image *image, float *const *band, size_t x, double weight,
	double nm)
{
	size_t i, last = image->bands - 1;
	double part;

	if (!(nm > 0) || weight == 0)
		return;
	if (image->edges_nm) {
		i = spec_interval_find(image->edges_nm, image->bands, nm);
		if (nm < image->edges_nm[0] || nm > image->edges_nm[image->bands])
			return;
		if (band[i])
			band[i][x] += (float)(weight / (image->edges_nm[i + 1] -
							       image->edges_nm[i]));
		return;
	}
	if (nm < image->wavelength_nm[0] || nm > image->wavelength_nm[last])
		return;
	i = spec_interval_find(image->wavelength_nm, image->bands, nm);
	i -= i == last;
	part = (nm - image->wavelength_nm[i]) /
	       (image->wavelength_nm[i + 1] - image->wavelength_nm[i]);
	if (band[i])
		band[i][x] += (float)(weight * (1 - part) / cell_nm(image, i));
	if (band[i + 1])
		band[i + 1][x] += (float)(weight * part / cell_nm(image, i + 1));
}

/* The bands of one line of one component. */
static void
expand(const struct expanded_decoder *decoder, int y, size_t stokes, float *const *row)
{
	const struct expanded_reader *reader =
		(const struct expanded_reader *)decoder->base.reader;
	const struct spec_image *image = &reader->base.image;
	size_t bands = image->bands, width = spec_window_width(&image->data),
	       count = reader->represented.coefficients, lines = reader->represented.lines;
	const size_t *channel = image->band_channel + stokes * bands,
		     *line = reader->line + stokes * 2 * lines;
	size_t wanted = 0;

	for (size_t i = 0; i < bands; i++) {
		decoder->out[i] = row[channel[i]];
		wanted += decoder->out[i] != NULL;
	}
	if (wanted == 0)
		return;
	for (size_t i = 0; i < count; i++)
		decoder->in[i] = spec_decoder_row(
			decoder->inner, y, reader->coefficient[stokes * count + i]);
	if (count > 0 && wanted == bands)
		spec_mix_rows(decoder->in, count, reader->back, decoder->out, bands, width);
	for (size_t i = 0; i < bands; i++) {
		if (!decoder->out[i] || (count > 0 && wanted == bands))
			continue;
		if (count > 0)
			spec_mix_rows(decoder->in, count, reader->back + i * count,
				&decoder->out[i], 1, width);
		else
			memcpy(decoder->out[i],
				spec_decoder_row(decoder->inner, y,
					reader->smooth[stokes * bands + i]),
				width * sizeof(float));
	}
	for (size_t k = 0; k < lines; k++) {
		const float *weight = spec_decoder_row(decoder->inner, y, line[2 * k]),
			    *nm = spec_decoder_row(decoder->inner, y, line[2 * k + 1]);

		for (size_t x = 0; x < width; x++)
			add_line(image, decoder->out, x, weight[x], nm[x]);
	}
}

static enum spec_status
decode(struct spec_decoder *base, struct spec_error *error)
{
	struct expanded_decoder *decoder = (struct expanded_decoder *)base;
	const struct expanded_reader *reader = (struct expanded_reader *)base->reader;
	const struct spec_image *image = &reader->base.image;
	size_t stored = spec_reader_image(reader->inner)->channels;
	enum spec_status status = spec_decoder_decode(decoder->inner, error);

	if (status == SPEC_OK)
		status = spec_reading_planes(base, error);
	for (int line = 0; line < base->lines && status == SPEC_OK; line++) {
		float **row = base->row + (size_t)line * image->channels;
		int y = base->y0 + line;

		for (int stokes = 0; stokes < image->stokes; stokes++)
			expand(decoder, y, (size_t)stokes, row);
		for (size_t i = 0; i < image->channels; i++)
			if (row[i] && reader->origin[i] < stored)
				row[i] = (float *)spec_decoder_row(
					decoder->inner, y, reader->origin[i]);
	}
	return status;
}

static enum spec_status
drain(struct spec_reader *reader, struct spec_error *error)
{
	return spec_reader_drain(((struct expanded_reader *)reader)->inner, error);
}

const struct spec_reading_format spec_reading_expanded = {
	.name = "OpenEXR",
	.reader_bytes = sizeof(struct expanded_reader),
	.decoder_bytes = sizeof(struct expanded_decoder),
	.close = close_reader,
	.open_decoder = open_decoder,
	.close_decoder = close_decoder,
	.shares = shares,
	.fetch = fetch,
	.decode = decode,
	.drain = drain,
};
