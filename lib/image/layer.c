#include "image/layer.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "base/memory.h"
#include "image/names.h"

static const char *const vector[] = {".X", ".Y", ".Z"};

/* The rest of a channel's name behind "PREFIX.", or null. */
static const char *
behind(const char *name, const char *prefix, size_t length)
{
	return strncmp(name, prefix, length) == 0 && name[length] == '.' ? name + length + 1
									 : NULL;
}

/* What a channel of this name would be; a name that is broken is that of no band. */
static int
read_band(const char *suffix, struct spec_channel *band, struct spec_error *error)
{
	*band = (struct spec_channel){0};
	band->name = spec_memory_text(suffix, strlen(suffix), error);
	if (!band->name)
		return 0;
	if (spec_names_read(band, NULL) != SPEC_OK)
		band->role = SPEC_ROLE_OTHER;
	return 1;
}

/* Makes the layer's channels the bands, and all others none. *count: how many they are. */
static enum spec_status
choose_bands(struct spec_image *chosen, const char *layer, size_t *count,
	struct spec_error *error)
{
	size_t length = strlen(layer);

	*count = 0;
	for (size_t i = 0; i < chosen->channels; i++) {
		struct spec_channel *channel = &chosen->channel[i], band;
		const char *suffix = behind(channel->name, layer, length);

		channel->role = SPEC_ROLE_OTHER;
		channel->naming = SPEC_NAMING_NONE;
		if (!suffix)
			continue;
		if (!read_band(suffix, &band, error))
			return SPEC_ENOMEM;
		free(band.name);
		band.name = channel->name;
		band.sample = channel->sample;
		band.linear = channel->linear;
		*channel = band;
		*count += band.role != SPEC_ROLE_OTHER;
	}
	return SPEC_OK;
}

static int
find_parts(const struct spec_image *image, const char *prefix, size_t length,
	const char *const *part, size_t parts, size_t channel[3])
{
	char name[256];

	for (size_t i = 0; i < parts; i++) {
		if (snprintf(name, sizeof name, "%.*s%s", (int)length, prefix, part[i]) >=
			(int)sizeof name)
			return 0;
		channel[i] = spec_image_find_channel(image, name);
		if (channel[i] == image->channels)
			return 0;
	}
	return 1;
}

/* The layer as one of channels. */
static int
find_channels(struct spec_layer *result, const struct spec_image *image, const char *layer)
{
	static const char *const plane[] = {"u", "v"};
	size_t length = strlen(layer);

	result->kind = SPEC_LAYER_VECTOR;
	if (find_parts(image, layer, length, vector, 3, result->channel))
		return 1;
	result->kind = SPEC_LAYER_CHANNEL;
	result->channel[0] = spec_image_find_channel(image, layer);
	if (result->channel[0] < image->channels)
		return 1;
	result->kind = SPEC_LAYER_PLANE;
	return strcmp(result->base, "uv") == 0 &&
	       find_parts(image, layer, length - 2, plane, 2, result->channel);
}

/* Bytes of a channel's name that are its layer's, whole where it is one by itself. */
static size_t
layer_length(const struct spec_image *image, const char *name, struct spec_error *error)
{
	size_t length = strlen(name), channel[3];
	struct spec_channel band;

	if (length > 2 && name[length - 2] == '.' && strchr("XYZ", name[length - 1]) &&
		find_parts(image, name, length - 2, vector, 3, channel))
		return length - 2;
	for (const char *at = strchr(name, '.'); at; at = strchr(at + 1, '.')) {
		if (!read_band(at + 1, &band, error))
			return 0;
		free(band.name);
		if (band.role != SPEC_ROLE_OTHER)
			return (size_t)(at - name);
	}
	return length;
}

/* The error that lists what there is, as far as a line holds it. */
static enum spec_status
fail_unknown(const struct spec_image *image, const char *name, const char *layer,
	struct spec_error *error)
{
	char list[600] = "";
	const char *last = "";
	size_t used = 0, last_length = 0;

	for (size_t i = 0; i < image->channels; i++) {
		const char *own = image->channel[i].name;
		size_t length = image->channel[i].role == SPEC_ROLE_OTHER
					? layer_length(image, own, error)
					: 0;

		if (length == 0 ||
			(length == last_length && strncmp(own, last, length) == 0))
			continue;
		if (used + length + 8 > sizeof list) {
			snprintf(list + used, sizeof list - used, ", ...");
			break;
		}
		used += (size_t)snprintf(list + used, sizeof list - used, "%s%.*s",
			used > 0 ? ", " : "", (int)length, own);
		last = own;
		last_length = length;
	}
	return spec_error_set(error, SPEC_EUSAGE, "%s: has no layer '%.100s'%s%s", name,
		layer, used > 0 ? "; it has " : ", and none besides its bands", list);
}

enum spec_status
spec_layer_find(struct spec_layer *result, const struct spec_image *image, const char *name,
	const char *layer, struct spec_image *chosen, struct spec_error *error)
{
	const char *point = strrchr(layer, '.');
	size_t bands = 0;
	enum spec_status status;

	*result = (struct spec_layer){.base = point ? point + 1 : layer};
	if (find_channels(result, image, layer))
		return SPEC_OK;
	status = spec_image_copy(chosen, image, error);
	if (status == SPEC_OK)
		status = choose_bands(chosen, layer, &bands, error);
	if (status == SPEC_OK && bands == 0)
		status = fail_unknown(image, name, layer, error);
	else if (status == SPEC_OK)
		status = spec_image_index(chosen, name, error);
	result->kind = SPEC_LAYER_BANDS;
	if (status != SPEC_OK)
		spec_image_clear(chosen);
	return status;
}
