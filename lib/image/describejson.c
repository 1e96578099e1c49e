/* What is in an image, for programs; specinfo(1) has the keys. */
#include <math.h>
#include <string.h>

#include "image/describing.h"
#include "image/value.h"
#include "image/settings.h"

static void
put_window(struct spec_json *json, const char *key, const struct spec_window *window)
{
	const int corner[] = {window->x0, window->y0, window->x1, window->y1};

	spec_json_open(json, key, '[', SPEC_JSON_INLINE);
	for (int i = 0; i < 4; i++)
		spec_json_whole(json, NULL, corner[i]);
	spec_json_close(json);
}

static void
put_storage(struct spec_json *json, const struct spec_describe *describe)
{
	const struct spec_image *image = describe->image;
	const struct spec_storage *storage = &describe->storage;

	spec_json_text(json, "file", describe->name);
	spec_json_text(json, "format", describe->setup.format);
	spec_json_text(json, "compression",
		strcmp(describe->setup.format, "OpenEXR") == 0
			? spec_settings_compression_name(image->compression)
			: NULL);
	if (describe->setup.representation && *describe->setup.representation)
		spec_json_text(json, "representation", describe->setup.representation);
	else
		spec_json_null(json, "representation");
	spec_json_whole(json, "parts", storage->parts);
	spec_json_whole(json, "part", storage->part);
	spec_json_text(json, "part_name", image->part);
	if (storage->tile_width > 0) {
		spec_json_open(json, "tiles", '[', SPEC_JSON_INLINE);
		spec_json_whole(json, NULL, storage->tile_width);
		spec_json_whole(json, NULL, storage->tile_height);
		spec_json_close(json);
	} else {
		spec_json_null(json, "tiles");
	}
	spec_json_whole(json, "width", (long long)spec_window_width(&image->data));
	spec_json_whole(json, "height", (long long)spec_window_height(&image->data));
	spec_json_whole(json, "bytes", (long long)describe->bytes);
	put_window(json, "data_window", &image->data);
	put_window(json, "display_window", &image->display);
	spec_json_float(json, "pixel_aspect_ratio", image->pixel_aspect_ratio);
}

static void
put_bands(struct spec_json *json, const struct spec_describe *describe)
{
	const struct spec_image *image = describe->image;
	int spectral = image->bands > 0;

	spec_json_text(json, "role", spec_describing_role(image->role));
	spec_json_text(json, "quantity", spectral ? describe->quantity : NULL);
	spec_json_text(json, "unit", describe->unit);
	spec_json_text(json, "naming", spec_describing_naming(describe->naming));
	spec_json_whole(json, "stokes", spectral ? image->stokes : 0);
	spec_json_whole(json, "bispectral", (long long)image->bispectral);
	spec_json_whole(json, "bands", (long long)image->bands);
	if (describe->step_nm > 0)
		spec_json_number(json, "step_nm", describe->step_nm);
	else
		spec_json_null(json, "step_nm");
	spec_json_numbers(json, "wavelength_nm", image->wavelength_nm, image->bands);
	if (image->edges_nm)
		spec_json_numbers(json, "edges_nm", image->edges_nm, image->bands + 1);
	else
		spec_json_null(json, "edges_nm");
}

static void
put_number(struct spec_json *json, const char *kind, size_t number)
{
	char name[32];

	snprintf(name, sizeof name, "%s%zu", kind, number);
	spec_json_text(json, NULL, name);
}

static void
put_layers(struct spec_json *json, const struct spec_describe *describe)
{
	const struct spec_layers *layers = &describe->layers;

	spec_json_open(json, "layers", '[', SPEC_JSON_INLINE);
	for (size_t i = 1; i <= layers->films; i++)
		put_number(json, "film", i);
	if (layers->through)
		spec_json_text(json, NULL, "through");
	for (size_t i = 1; i <= layers->lamps; i++)
		put_number(json, "lamp", i);
	spec_json_close(json);
	if (describe->damage.status != SPEC_OK)
		spec_json_text(json, "layers_error", describe->damage.message);
	spec_json_open(json, "geometry", '[', SPEC_JSON_INLINE);
	for (const struct spec_describing_geometry *geometry = spec_describing_geometries;
		geometry->name; geometry++) {
		if (spec_describing_has(describe->image, "", geometry))
			spec_json_text(json, NULL, geometry->name);
	}
	spec_json_close(json);
}

static void
put_channel(struct spec_json *json, const struct spec_channel *channel)
{
	spec_json_open(json, NULL, '{', SPEC_JSON_INLINE);
	spec_json_text(json, "name", channel->name);
	spec_json_text(json, "sample", spec_describing_sample(channel->sample));
	if (channel->role != SPEC_ROLE_OTHER)
		spec_json_number(json, "wavelength_nm", channel->wavelength_nm);
	if (channel->role == SPEC_ROLE_BISPECTRAL)
		spec_json_number(json, "reradiated_nm", channel->reradiated_nm);
	if (channel->role == SPEC_ROLE_EMISSIVE)
		spec_json_whole(json, "stokes", channel->stokes);
	spec_json_close(json);
}

static void
put_history(struct spec_json *json, const struct spec_image *image)
{
	const struct spec_attribute *history = spec_image_attribute(image, "spec:history");
	const char *text = NULL, *end = NULL;

	if (history && strcmp(history->type, "string") == 0) {
		text = (const char *)history->value;
		end = text + history->size;
	}
	spec_json_open(json, "history", '[', SPEC_JSON_LINES);
	while (text < end) {
		const char *line = memchr(text, '\n', (size_t)(end - text));

		line = line ? line : end;
		spec_json_bytes(json, NULL, text, (size_t)(line - text));
		text = line + 1;
	}
	spec_json_close(json);
}

static void
put_row(struct spec_json *json, const char *name, size_t channels,
	const struct spec_statistics *row)
{
	int any = row->finite > 0;

	spec_json_open(json, NULL, '{', SPEC_JSON_INLINE);
	spec_json_text(json, "name", name);
	spec_json_whole(json, "channels", (long long)channels);
	spec_json_whole(json, "samples", (long long)row->samples);
	spec_json_float(json, "min", any ? row->minimum : NAN);
	spec_json_float(json, "max", any ? row->maximum : NAN);
	spec_json_number(json, "mean", any ? row->mean : NAN);
	spec_json_number(json, "deviation", spec_statistics_deviation(row));
	spec_json_whole(json, "nan", (long long)row->nan.count);
	spec_json_whole(json, "inf", (long long)row->infinite.count);
	spec_json_whole(json, "negative", (long long)row->negative.count);
	spec_json_close(json);
}

static void
put_statistics(struct spec_json *json, const struct spec_describe *describe)
{
	const struct spec_image *image = describe->image;
	const struct spec_statistics *all = describe->setup.statistics;
	struct spec_statistics sum;
	const char *name;

	spec_json_open(json, "statistics", '[', SPEC_JSON_LINES);
	for (int group = 0; group < SPEC_DESCRIBING_GROUPS; group++) {
		size_t channels = spec_describing_group(describe, group, &name, &sum);

		if (channels > 0)
			put_row(json, name, channels, &sum);
	}
	for (size_t i = 0; i < image->channels; i++) {
		if (image->channel[i].role == SPEC_ROLE_OTHER &&
			spec_statistics_applies(&image->channel[i]))
			put_row(json, image->channel[i].name, 1, &all[i]);
	}
	spec_json_close(json);
	if (!describe->setup.bands)
		return;
	spec_json_open(json, "band_statistics", '[', SPEC_JSON_LINES);
	for (size_t i = 0; i < image->bands * (size_t)image->stokes; i++)
		put_row(json, image->channel[image->band_channel[i]].name, 1,
			&all[image->band_channel[i]]);
	spec_json_close(json);
}

void
spec_describe_json(struct spec_json *json, const struct spec_describe *describe)
{
	const struct spec_image *image = describe->image;

	spec_json_open(json, NULL, '{', SPEC_JSON_LINES);
	put_storage(json, describe);
	put_bands(json, describe);
	put_layers(json, describe);
	spec_json_open(json, "channels", '[', SPEC_JSON_LINES);
	for (size_t i = 0; i < image->channels; i++)
		put_channel(json, &image->channel[i]);
	spec_json_close(json);
	spec_json_open(json, "attributes", '{', SPEC_JSON_LINES);
	for (size_t i = 0; i < image->attributes; i++)
		spec_value_json(json, &image->attribute[i]);
	spec_json_close(json);
	put_history(json, image);
	if (describe->setup.statistics)
		put_statistics(json, describe);
	spec_json_close(json);
}
