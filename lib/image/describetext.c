/* What is in an image, for people: aligned, a line per thing. */
#include <math.h>
#include <string.h>

#include "image/describing.h"
#include "image/value.h"
#include "image/settings.h"

#define LABEL "  %-13s "
#define LONGEST_LINE 64 /* bytes of names in a line, of a text of an attribute */
#define NAME_COLUMN 32  /* of the names of attributes, at most */

static void
label(FILE *stream, const char *text)
{
	fprintf(stream, LABEL, text);
}

static void
print_bytes(FILE *stream, unsigned long long bytes)
{
	static const char *const units[] = {"KiB", "MiB", "GiB", "TiB"};
	double value = (double)bytes / 1024;
	size_t unit = 0;

	if (bytes < 1024) {
		fprintf(stream, "%llu bytes", bytes);
		return;
	}
	while (value >= 1024 && unit < 3) {
		value /= 1024;
		unit++;
	}
	fprintf(stream, "%.3g %s", value, units[unit]);
}

static void
print_storage(FILE *stream, const struct spec_describe *describe)
{
	const struct spec_storage *storage = &describe->storage;
	const char *compression =
		spec_settings_compression_name(describe->image->compression);

	label(stream, "format");
	fprintf(stream, "%s", describe->setup.format);
	if (compression && strcmp(describe->setup.format, "OpenEXR") == 0)
		fprintf(stream, ", compression %s", compression);
	if (storage->tile_width > 0)
		fprintf(stream, ", tiles of %d x %d", storage->tile_width,
			storage->tile_height);
	fputc('\n', stream);
	if (describe->setup.representation && *describe->setup.representation) {
		label(stream, "stored as");
		fprintf(stream, "%s\n", describe->setup.representation);
	}
	if (storage->parts > 1 || describe->image->part) {
		label(stream, "part");
		fprintf(stream, "%d of %d, counted from 0", storage->part, storage->parts);
		if (describe->image->part) {
			fputs(", named ", stream);
			spec_value_print_text(stream, describe->image->part,
				strlen(describe->image->part));
		}
		fputc('\n', stream);
	}
}

static void
print_window(FILE *stream, const char *name, const struct spec_window *window)
{
	label(stream, name);
	fprintf(stream, "%d,%d,%d,%d\n", window->x0, window->y0, window->x1, window->y1);
}

static void
print_size(FILE *stream, const struct spec_describe *describe)
{
	const struct spec_window *data = &describe->image->data,
				 *display = &describe->image->display;

	label(stream, "size");
	fprintf(stream, "%zu x %zu pixels, ", spec_window_width(data),
		spec_window_height(data));
	print_bytes(stream, describe->bytes);
	fputs(" uncompressed\n", stream);
	if (data->x0 != 0 || data->y0 != 0 || memcmp(data, display, sizeof *data) != 0) {
		print_window(stream, "data window", data);
		print_window(stream, "display", display);
	}
	if (describe->image->pixel_aspect_ratio != 1) {
		label(stream, "pixel aspect");
		fprintf(stream, "%.6g\n", describe->image->pixel_aspect_ratio);
	}
}

/* The type of the bands' samples, or "" where they are not all of one. */
static const char *
band_sample(const struct spec_image *image)
{
	const char *name = "";

	for (size_t i = 0; i < image->channels; i++) {
		const struct spec_channel *channel = &image->channel[i];

		if (channel->role == SPEC_ROLE_OTHER)
			continue;
		if (!*name)
			name = spec_describing_sample(channel->sample);
		else if (name != spec_describing_sample(channel->sample))
			return "several types";
	}
	return name;
}

static void
print_grid(FILE *stream, const struct spec_describe *describe)
{
	const struct spec_image *image = describe->image;
	const double *known = image->wavelength_nm;

	label(stream, "bands");
	fprintf(stream, "%zu, ", image->bands);
	if (image->bands == 1)
		fprintf(stream, "%.10g nm", known[0]);
	else
		fprintf(stream, "%.10g..%.10g nm", known[0], known[image->bands - 1]);
	if (describe->step_nm > 0)
		fprintf(stream, " by %.7g nm", describe->step_nm);
	else if (image->bands > 1)
		fputs(", irregular", stream);
	fprintf(stream, ", %s\n", band_sample(image));
	label(stream, "samples");
	if (image->edges_nm)
		fprintf(stream, "%s over bins, %.10g..%.10g nm\n",
			strstr(describe->quantity, "per band") ? "integrals" : "means",
			image->edges_nm[0], image->edges_nm[image->bands]);
	else
		fputs("points\n", stream);
}

static void
print_bands(FILE *stream, const struct spec_describe *describe)
{
	const struct spec_image *image = describe->image;

	if (image->bands == 0) {
		label(stream, "bands");
		fputs("none: the image is not spectral\n", stream);
		return;
	}
	print_grid(stream, describe);
	label(stream, "quantity");
	spec_value_print_text(stream, describe->quantity, strlen(describe->quantity));
	if (describe->unit)
		fprintf(stream, " [%s]", describe->unit);
	fputc('\n', stream);
	label(stream, "role");
	fputs(spec_describing_role(image->role), stream);
	if (image->stokes > 1)
		fputs(", polarised (S0 S1 S2 S3)", stream);
	if (image->bispectral > 0)
		fprintf(stream, ", bispectral (%zu channels off the diagonal)",
			image->bispectral);
	fputc('\n', stream);
	label(stream, "names");
	fprintf(stream, "%s, such as ", spec_describing_naming(describe->naming));
	spec_value_print_text(stream, image->channel[image->band_channel[0]].name,
		strlen(image->channel[image->band_channel[0]].name));
	fputc('\n', stream);
}

/* The kinds of geometry behind a prefix; *lead stands before the first. */
static int
print_geometry(
	FILE *stream, const struct spec_image *image, const char *prefix, const char *lead)
{
	int any = 0;

	for (const struct spec_describing_geometry *geometry = spec_describing_geometries;
		geometry->name; geometry++) {
		if (!spec_describing_has(image, prefix, geometry))
			continue;
		if (!any && lead)
			fputs(lead, stream);
		fprintf(stream, any ? " %s" : "%s", geometry->name);
		any = 1;
	}
	return any;
}

static int
has_geometry(const struct spec_image *image)
{
	for (const struct spec_describing_geometry *geometry = spec_describing_geometries;
		geometry->name; geometry++) {
		if (spec_describing_has(image, "", geometry))
			return 1;
	}
	return 0;
}

static void
print_layers(FILE *stream, const struct spec_describe *describe)
{
	const struct spec_layers *layers = &describe->layers;
	const char *name = "layers";
	char prefix[32];

	if (describe->damage.status != SPEC_OK) {
		label(stream, name);
		fprintf(stream, "unusable: %s\n", describe->damage.message);
	}
	for (size_t i = 1; i <= layers->films; i++, name = "") {
		label(stream, name);
		snprintf(prefix, sizeof prefix, "film%zu.", i);
		fprintf(stream, "film%zu: mirror", i);
		(void)print_geometry(stream, describe->image, prefix, ", ");
		fputc('\n', stream);
	}
	if (layers->through) {
		label(stream, name);
		fputs("through\n", stream);
		name = "";
	}
	for (size_t i = 1; i <= layers->lamps; i++, name = "") {
		label(stream, name);
		fprintf(stream, "lamp%zu: irradiance, D\n", i);
	}
	if (has_geometry(describe->image)) {
		label(stream, "geometry");
		(void)print_geometry(stream, describe->image, "", NULL);
		fputc('\n', stream);
	}
}

/* Channels that are neither bands nor of layers or geometry, those of a type in a line. */
static void
print_foreign(FILE *stream, const struct spec_image *image)
{
	const char *name = "channels";

	for (int sample = SPEC_SAMPLE_FLOAT; sample >= SPEC_SAMPLE_UINT; sample--) {
		size_t length = 0, left = 0;

		for (size_t i = 0; i < image->channels; i++) {
			const struct spec_channel *channel = &image->channel[i];

			if ((int)channel->sample != sample ||
				!spec_describing_is_foreign(channel))
				continue;
			if (length == 0) {
				label(stream, name);
				fprintf(stream, "%s:", spec_describing_sample(sample));
				name = "";
			}
			length += strlen(channel->name) + 1;
			if (length > LONGEST_LINE && length > strlen(channel->name) + 1) {
				left++;
				continue;
			}
			fputc(' ', stream);
			spec_value_print_text(stream, channel->name, strlen(channel->name));
		}
		if (left > 0)
			fprintf(stream, " and %zu more", left);
		if (length > 0)
			fputc('\n', stream);
	}
}

/* Those that have a line of their own. */
static int
is_told(const char *name)
{
	return strcmp(name, "spec:history") == 0 || strcmp(name, "spec:quantity") == 0 ||
	       strcmp(name, "spec:bins") == 0;
}

static void
print_attributes(FILE *stream, const struct spec_image *image)
{
	const char *name = "attributes";
	int width = 0;

	for (size_t i = 0; i < image->attributes; i++) {
		int length = (int)strlen(image->attribute[i].name);

		if (!is_told(image->attribute[i].name) && length > width)
			width = length < NAME_COLUMN ? length : NAME_COLUMN;
	}
	for (size_t i = 0; i < image->attributes; i++) {
		const struct spec_attribute *attribute = &image->attribute[i];
		int length = (int)strlen(attribute->name);

		if (is_told(attribute->name))
			continue;
		label(stream, name);
		spec_value_print_text(stream, attribute->name, strlen(attribute->name));
		fprintf(stream, "%*s", length < width ? width - length + 2 : 2, "");
		spec_value_print(stream, attribute, LONGEST_LINE);
		fputc('\n', stream);
		name = "";
	}
}

static void
print_history(FILE *stream, const struct spec_image *image)
{
	const struct spec_attribute *history = spec_image_attribute(image, "spec:history");
	const char *name = "history", *text, *end;

	if (!history || strcmp(history->type, "string") != 0)
		return;
	text = (const char *)history->value;
	end = text + history->size;
	while (text < end) {
		const char *line = memchr(text, '\n', (size_t)(end - text));

		line = line ? line : end;
		label(stream, name);
		spec_value_print_text(stream, text, (size_t)(line - text));
		fputc('\n', stream);
		text = line + 1;
		name = "";
	}
}

static void
print_row(FILE *stream, const char *name, const struct spec_statistics *row)
{
	fputs("  ", stream);
	spec_value_print_text(stream, name, strlen(name));
	fprintf(stream, "%*s", strlen(name) < 20 ? (int)(20 - strlen(name)) : 0, "");
	if (row->finite > 0)
		fprintf(stream, " %12.6g %12.6g %12.6g %12.6g", row->minimum, row->maximum,
			row->mean, spec_statistics_deviation(row));
	else
		fprintf(stream, " %12s %12s %12s %12s", "-", "-", "-", "-");
	fprintf(stream, " %8llu %8llu %8llu\n", row->nan.count, row->infinite.count,
		row->negative.count);
}

static void
print_statistics(FILE *stream, const struct spec_describe *describe)
{
	const struct spec_image *image = describe->image;
	struct spec_statistics sum;
	const char *name;

	fprintf(stream, "  %-20s %12s %12s %12s %12s %8s %8s %8s\n", "statistics", "min",
		"max", "mean", "deviation", "nan", "inf", "negative");
	for (int group = 0; group < SPEC_DESCRIBING_GROUPS; group++) {
		if (spec_describing_group(describe, group, &name, &sum) > 0)
			print_row(stream, name, &sum);
	}
	for (size_t i = 0; i < image->channels; i++) {
		if (image->channel[i].role == SPEC_ROLE_OTHER &&
			spec_statistics_applies(&image->channel[i]))
			print_row(stream, image->channel[i].name,
				&describe->setup.statistics[i]);
	}
	for (size_t i = 0;
		describe->setup.bands && i < image->bands * (size_t)image->stokes; i++)
		print_row(stream, image->channel[image->band_channel[i]].name,
			&describe->setup.statistics[image->band_channel[i]]);
}

void
spec_describe_print(FILE *stream, const struct spec_describe *describe)
{
	spec_value_print_text(stream, describe->name, strlen(describe->name));
	fputc('\n', stream);
	print_storage(stream, describe);
	print_size(stream, describe);
	print_bands(stream, describe);
	print_layers(stream, describe);
	print_foreign(stream, describe->image);
	print_attributes(stream, describe->image);
	print_history(stream, describe->image);
	if (describe->setup.statistics)
		print_statistics(stream, describe);
}
