/* Curves out of an atlas. */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "image/atlas.h"
#include "image/atlasing.h"
#include "image/patches.h"

#define MOST_TOLD 512 /* bytes of names in a message */

/* An atlas that is being read. */
struct atlas {
	struct spec_reader *reader;
	const char *file;
	struct spec_grid grid;
	size_t channel[SPEC_ATLAS_TEXEL];
	char *lines;         /* the attribute's text */
	size_t first, count; /* of the curve's lines */
};

/* The text of a field of a line, which ends with a tab or the line's end, and its length. */
static const char *
field_at(const char *line, enum spec_atlas_field field, size_t *length)
{
	for (int i = 0; i < (int)field; i++) {
		line += strcspn(line, "\t\n");
		line += *line == '\t';
	}
	*length = strcspn(line, "\t\n");
	return line;
}

static const char *
next_line(const char *line)
{
	line += strcspn(line, "\n");
	return line + (*line == '\n');
}

static int
is_called(const char *line, const char *name)
{
	size_t length;
	const char *found = field_at(line, SPEC_ATLAS_NAME, &length);

	return strlen(name) == length && memcmp(found, name, length) == 0;
}

static enum spec_status
damaged(const struct atlas *atlas, const char *what, struct spec_error *error)
{
	return spec_error_set(
		error, SPEC_EFORMAT, "%s: a damaged atlas: %s", atlas->file, what);
}

/* The header fits itself. */
static enum spec_status
open_atlas(struct atlas *atlas, struct spec_error *error)
{
	static const char *const channels[SPEC_ATLAS_TEXEL] = {"R", "G", "B", "A"};
	const struct spec_image *image = spec_reader_image(atlas->reader);
	char *steps = NULL;
	size_t lines = 0;
	enum spec_status status = spec_image_text(image, SPEC_ATLAS_STEPS, &steps, error);

	if (status == SPEC_OK)
		status = spec_image_text(image, SPEC_ATLAS_LINES, &atlas->lines, error);
	if (status == SPEC_OK && (!steps || !atlas->lines))
		status = spec_error_set(error, SPEC_EFORMAT,
			"%s: is no atlas of curves (no attribute %s)", atlas->file,
			steps ? SPEC_ATLAS_LINES : SPEC_ATLAS_STEPS);
	if (status == SPEC_OK && spec_grid_parse(steps, &atlas->grid, error) != SPEC_OK)
		status = damaged(atlas, "its grid is none", error);
	free(steps);
	for (size_t i = 0; i < SPEC_ATLAS_TEXEL && status == SPEC_OK; i++) {
		atlas->channel[i] = spec_image_find_channel(image, channels[i]);
		if (atlas->channel[i] == image->channels ||
			image->channel[atlas->channel[i]].sample == SPEC_SAMPLE_UINT)
			status = damaged(atlas, "channels R, G, B, A are not there", error);
	}
	for (const char *at = atlas->lines; status == SPEC_OK && *at; at = next_line(at))
		lines++;
	if (status == SPEC_OK && lines != spec_window_height(&image->data))
		status = damaged(atlas, "it has more or fewer lines than it says", error);
	if (status == SPEC_OK &&
		spec_atlas_texels(atlas->grid.count) + 1 != spec_window_width(&image->data))
		status = damaged(atlas, "its width does not fit its grid", error);
	return status;
}

/* All names, each once, as far as there is room. */
static void
list_names(const struct atlas *atlas, char told[MOST_TOLD])
{
	const char *before = NULL;
	size_t used = 0;

	told[0] = '\0';
	for (const char *at = atlas->lines; *at; at = next_line(at)) {
		size_t length, other = 0;
		const char *name = field_at(at, SPEC_ATLAS_NAME, &length);
		const char *last = before ? field_at(before, SPEC_ATLAS_NAME, &other) : "";

		if (before && length == other && memcmp(name, last, length) == 0)
			continue;
		before = at;
		if (used + length + 5 > MOST_TOLD) {
			(void)snprintf(told + used, MOST_TOLD - used, " ...");
			return;
		}
		used += (size_t)snprintf(told + used, MOST_TOLD - used, "%s%.*s",
			used > 0 ? " " : "", (int)length, name);
	}
}

static enum spec_status
find_lines(struct atlas *atlas, const char *name, struct spec_error *error)
{
	char told[MOST_TOLD];
	size_t line = 0;

	for (const char *at = atlas->lines; *at; at = next_line(at), line++) {
		if (!is_called(at, name))
			continue;
		if (atlas->count == 0)
			atlas->first = line;
		else if (line != atlas->first + atlas->count)
			return damaged(atlas, "the lines of a curve are apart", error);
		atlas->count++;
	}
	if (atlas->count > 0)
		return SPEC_OK;
	list_names(atlas, told);
	return spec_error_set(error, SPEC_EUSAGE, "%s: has no curve '%.200s' (%s)",
		atlas->file, name, told);
}

static enum spec_status
take_field(const char *line, enum spec_atlas_field field, char **text,
	struct spec_error *error)
{
	size_t length;
	const char *found = field_at(line, field, &length);
	char *copy = strndup(found, length);
	enum spec_status status = SPEC_ENOMEM;

	if (!copy)
		return spec_error_set(error, SPEC_ENOMEM, "no memory for texts");
	status = spec_curve_set_text(text, copy, error);
	free(copy);
	return status;
}

static enum spec_status
take_texts(const struct atlas *atlas, struct spec_curve *curve, struct spec_error *error)
{
	const char *line = atlas->lines;
	enum spec_status status;

	for (size_t i = 0; i < atlas->first; i++)
		line = next_line(line);
	status = take_field(line, SPEC_ATLAS_QUANTITY, &curve->quantity, error);
	if (status == SPEC_OK)
		status = take_field(line, SPEC_ATLAS_UNIT, &curve->unit, error);
	if (status == SPEC_OK)
		status = take_field(line, SPEC_ATLAS_MEDIUM, &curve->medium, error);
	if (status == SPEC_OK)
		status = take_field(line, SPEC_ATLAS_TITLE, &curve->title, error);
	if (status == SPEC_OK)
		status = take_field(line, SPEC_ATLAS_SOURCE, &curve->source, error);
	for (size_t i = 0; i < atlas->count && status == SPEC_OK; i++) {
		status = take_field(line, SPEC_ATLAS_COLUMN, &curve->column[i], error);
		line = next_line(line);
	}
	return status;
}

static enum spec_status
take_samples(const struct atlas *atlas, const struct spec_decoder *decoder, int y,
	double *value, struct spec_error *error)
{
	for (size_t i = 0; i < atlas->grid.count; i++) {
		const float *row =
			spec_decoder_row(decoder, y, atlas->channel[i % SPEC_ATLAS_TEXEL]);
		float sample = row[i / SPEC_ATLAS_TEXEL];

		if (!isfinite(sample))
			return spec_error_set(error, SPEC_EFORMAT,
				"%s: line %d is not finite at %g nm", atlas->file, y,
				atlas->grid.wavelength_nm[i]);
		value[i] = spec_patches_shortest(sample);
	}
	return SPEC_OK;
}

/* All lines go by, also those that are not wanted: a pipe is read to its end. */
static enum spec_status
read_curve(const struct atlas *atlas, struct spec_curve *curve, struct spec_error *error)
{
	const struct spec_image *image = spec_reader_image(atlas->reader);
	struct spec_decoder *decoder = NULL;
	enum spec_status status = spec_decoder_open(&decoder, atlas->reader, NULL, error);

	for (int y = image->data.y0; y < image->data.y1 && status == SPEC_OK; y++) {
		size_t line = (size_t)(y - image->data.y0);

		status = spec_decoder_fetch(decoder, y, y + 1, error);
		if (status == SPEC_OK && line >= atlas->first &&
			line < atlas->first + atlas->count) {
			status = spec_decoder_decode(decoder, error);
			if (status == SPEC_OK)
				status = take_samples(atlas, decoder, y,
					curve->value + (line - atlas->first) * curve->count,
					error);
		}
	}
	spec_decoder_close(decoder);
	return status == SPEC_OK ? spec_reader_drain(atlas->reader, error) : status;
}

enum spec_status
spec_atlas_curve(struct spec_reader *reader, const char *name, struct spec_curve *curve,
	struct spec_error *error)
{
	struct atlas atlas = {.reader = reader, .file = spec_reader_name(reader)};
	enum spec_status status = open_atlas(&atlas, error);

	*curve = (struct spec_curve){0};
	if (status == SPEC_OK)
		status = find_lines(&atlas, name, error);
	if (status == SPEC_OK)
		status = spec_curve_new(atlas.grid.count, atlas.count, curve, error);
	if (status == SPEC_OK) {
		memcpy(curve->wavelength_nm, atlas.grid.wavelength_nm,
			atlas.grid.count * sizeof *curve->wavelength_nm);
		status = take_texts(&atlas, curve, error);
	}
	if (status == SPEC_OK)
		status = read_curve(&atlas, curve, error);
	if (status != SPEC_OK)
		spec_curve_free(curve);
	spec_grid_free(&atlas.grid);
	free(atlas.lines);
	return status;
}
