#include "image/image.h"

#include <stdlib.h>
#include <string.h>

#include "base/memory.h"
#include "image/names.h"

void
spec_image_clear_index(struct spec_image *image)
{
	free(image->wavelength_nm);
	free(image->edges_nm);
	free(image->band_channel);
	image->wavelength_nm = image->edges_nm = NULL;
	image->band_channel = NULL;
	image->bands = image->bispectral = 0;
	image->stokes = 0;
	image->role = SPEC_ROLE_OTHER;
}

void
spec_image_clear(struct spec_image *image)
{
	for (size_t i = 0; i < image->channels; i++)
		free(image->channel[i].name);
	for (size_t i = 0; i < image->attributes; i++) {
		free(image->attribute[i].name);
		free(image->attribute[i].type);
		free(image->attribute[i].value);
	}
	free(image->channel);
	free(image->attribute);
	free(image->part);
	spec_image_clear_index(image);
	*image = (struct spec_image){0};
}

enum spec_status
spec_image_copy(
	struct spec_image *copy, const struct spec_image *image, struct spec_error *error)
{
	enum spec_status status = SPEC_OK;

	*copy = (struct spec_image){.data = image->data,
		.display = image->display,
		.pixel_aspect_ratio = image->pixel_aspect_ratio,
		.screen_window_x = image->screen_window_x,
		.screen_window_y = image->screen_window_y,
		.screen_window_width = image->screen_window_width,
		.compression = image->compression};
	if (image->part) {
		copy->part = spec_memory_text(image->part, strlen(image->part), error);
		status = copy->part ? SPEC_OK : SPEC_ENOMEM;
	}
	for (size_t i = 0; i < image->channels && status == SPEC_OK; i++) {
		const struct spec_channel *channel = &image->channel[i];

		status =
			spec_image_add_channel(copy, channel->name, channel->sample, error);
		if (status == SPEC_OK) {
			char *name = copy->channel[i].name;

			/* All of it: not every band is known by its name. */
			copy->channel[i] = *channel;
			copy->channel[i].name = name;
		}
	}
	for (size_t i = 0; i < image->attributes && status == SPEC_OK; i++) {
		const struct spec_attribute *attribute = &image->attribute[i];

		status = spec_image_set_attribute(copy, attribute->name, attribute->type,
			attribute->value, attribute->size, error);
	}
	if (status != SPEC_OK)
		spec_image_clear(copy);
	return status;
}

enum spec_status
spec_image_add_channel(struct spec_image *image, const char *name, enum spec_sample sample,
	struct spec_error *error)
{
	struct spec_channel *channel;
	void *list = image->channel;
	enum spec_status status = spec_memory_grow(&list, &image->channel_room,
		image->channels + 1, sizeof *image->channel, "channels", error);

	if (status != SPEC_OK)
		return status;
	image->channel = list;
	channel = &image->channel[image->channels];
	*channel = (struct spec_channel){.sample = sample};
	channel->name = spec_memory_text(name, strlen(name), error);
	if (!channel->name)
		return SPEC_ENOMEM;
	image->channels++;
	return spec_names_read(channel, error);
}

void
spec_image_remove_channels(
	struct spec_image *image, int (*goes)(const struct spec_channel *channel))
{
	size_t kept = 0;

	spec_image_clear_index(image);
	for (size_t i = 0; i < image->channels; i++) {
		if (goes(&image->channel[i]))
			free(image->channel[i].name);
		else
			image->channel[kept++] = image->channel[i];
	}
	image->channels = kept;
}

static int
is_band(const struct spec_channel *channel)
{
	return channel->role != SPEC_ROLE_OTHER;
}

void
spec_image_remove_bands(struct spec_image *image)
{
	spec_image_remove_channels(image, is_band);
}

static int
is_preview(const struct spec_channel *channel)
{
	return channel->role == SPEC_ROLE_OTHER && strlen(channel->name) == 1 &&
	       strchr("RGB", channel->name[0]);
}

void
spec_image_remove_preview(struct spec_image *image)
{
	spec_image_remove_channels(image, is_preview);
}

enum spec_status
spec_image_add_bands(struct spec_image *image, enum spec_role role, int stokes,
	const double *wavelength_nm, size_t count, enum spec_sample sample,
	struct spec_error *error)
{
	enum spec_status status = SPEC_OK;
	char name[64];

	for (int component = 0; component < stokes; component++) {
		for (size_t i = 0; i < count && status == SPEC_OK; i++) {
			spec_names_write(
				name, sizeof name, role, component, wavelength_nm[i], 0);
			status = spec_image_add_channel(image, name, sample, error);
		}
	}
	return status;
}

const struct spec_attribute *
spec_image_attribute(const struct spec_image *image, const char *name)
{
	for (size_t i = 0; i < image->attributes; i++) {
		if (strcmp(image->attribute[i].name, name) == 0)
			return &image->attribute[i];
	}
	return NULL;
}

void
spec_image_remove_attribute(struct spec_image *image, const char *name)
{
	struct spec_attribute *attribute =
		(struct spec_attribute *)spec_image_attribute(image, name);
	size_t index;

	if (!attribute)
		return;
	free(attribute->name);
	free(attribute->type);
	free(attribute->value);
	index = attribute - image->attribute;
	memmove(attribute, attribute + 1,
		(image->attributes - index - 1) * sizeof *attribute);
	image->attributes--;
}

enum spec_status
spec_image_set_attribute(struct spec_image *image, const char *name, const char *type,
	const void *value, size_t size, struct spec_error *error)
{
	struct spec_attribute *attribute;
	void *list = image->attribute;
	enum spec_status status = spec_memory_grow(&list, &image->attribute_room,
		image->attributes + 1, sizeof *attribute, "attributes", error);
	struct spec_attribute new = {.size = size};

	if (status != SPEC_OK)
		return status;
	image->attribute = list;
	new.name = spec_memory_text(name, strlen(name), error);
	new.type = spec_memory_text(type, strlen(type), error);
	new.value = (unsigned char *)spec_memory_text(value ? value : "", size, error);
	if (!new.name || !new.type || !new.value) {
		free(new.name);
		free(new.type);
		free(new.value);
		return SPEC_ENOMEM;
	}
	attribute = (struct spec_attribute *)spec_image_attribute(image, name);
	if (attribute) {
		free(attribute->name);
		free(attribute->type);
		free(attribute->value);
		*attribute = new;
	} else {
		image->attribute[image->attributes++] = new;
	}
	return SPEC_OK;
}

enum spec_status
spec_image_set_text(struct spec_image *image, const char *name, const char *text,
	struct spec_error *error)
{
	return spec_image_set_attribute(image, name, "string", text, strlen(text), error);
}

enum spec_status
spec_image_text(const struct spec_image *image, const char *name, char **text,
	struct spec_error *error)
{
	const struct spec_attribute *attribute = spec_image_attribute(image, name);

	*text = NULL;
	if (!attribute || strcmp(attribute->type, "string") != 0)
		return SPEC_OK;
	*text = spec_memory_text((const char *)attribute->value, attribute->size, error);
	return *text ? SPEC_OK : SPEC_ENOMEM;
}

char *
spec_image_quantity(const struct spec_image *image, struct spec_error *error)
{
	const char *standard = image->role == SPEC_ROLE_EMISSIVE     ? "radiance per nm"
			       : image->role == SPEC_ROLE_REFLECTIVE ? "reflectance"
								     : "";
	char *quantity;

	if (spec_image_text(image, "spec:quantity", &quantity, error) != SPEC_OK)
		return NULL;
	return quantity ? quantity : spec_memory_text(standard, strlen(standard), error);
}
