#include "compare/matte.h"

#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include "base/memory.h"
#include "base/number.h"

/* "NAME" or "NAME=N", where the whole is not the name of a channel of the image. */
static enum spec_status
read_channel(struct spec_matte *mask, const char *text, const struct spec_image *image,
	struct spec_error *error)
{
	const char *equals = strrchr(text, '=');
	long long number = 0;
	enum spec_status status = SPEC_OK;

	if (image && spec_image_find_channel(image, text) < image->channels)
		equals = NULL;
	if (equals)
		status = spec_number_parse_whole(
			equals + 1, 0, UINT32_MAX, "the mask's number", &number, error);
	if (status != SPEC_OK)
		return status;
	mask->equals = equals != NULL;
	mask->number = (uint32_t)number;
	mask->channel = spec_memory_text(
		text, equals ? (size_t)(equals - text) : strlen(text), error);
	return mask->channel ? SPEC_OK : SPEC_ENOMEM;
}

/* Whether a text is a channel of the image, or would be without "=N". */
static int
is_channel(const char *text, const struct spec_image *image)
{
	const char *equals = strrchr(text, '=');
	size_t length = equals ? (size_t)(equals - text) : strlen(text);

	for (size_t i = 0; i < image->channels; i++) {
		const char *name = image->channel[i].name;

		if (strcmp(name, text) == 0 ||
			(strlen(name) == length && strncmp(name, text, length) == 0))
			return 1;
	}
	return 0;
}

static int
is_file(const char *path)
{
	return strcmp(path, "-") == 0 || access(path, F_OK) == 0;
}

/* "FILE" or "FILE:NAME": the first colon that ends the name of a file. */
static enum spec_status
read_file(struct spec_matte *mask, const char *text, int *found, struct spec_error *error)
{
	size_t length = strlen(text);
	enum spec_status status = SPEC_OK;

	*found = 0;
	mask->path = spec_memory_text(text, length, error);
	if (!mask->path)
		return SPEC_ENOMEM;
	*found = is_file(mask->path);
	if (*found)
		return SPEC_OK;
	for (size_t i = 0; i < length && !*found; i++) {
		if (text[i] != ':')
			continue;
		mask->path[i] = '\0';
		*found = is_file(mask->path);
		if (*found)
			status = read_channel(mask, text + i + 1, NULL, error);
		else
			mask->path[i] = ':';
	}
	return status;
}

enum spec_status
spec_matte_read(struct spec_matte *mask, const char *text, const struct spec_image *image,
	const char *name, struct spec_error *error)
{
	enum spec_status status;
	int found = 1;

	*mask = (struct spec_matte){0};
	if (is_channel(text, image)) {
		status = read_channel(mask, text, image, error);
		if (status == SPEC_OK)
			status = spec_matte_settle(mask, image, name, error);
	} else {
		status = read_file(mask, text, &found, error);
	}
	if (status == SPEC_OK && !found)
		status = spec_error_set(error, SPEC_EUSAGE,
			"the mask '%s' is neither a channel of %s nor a file", text, name);
	if (status != SPEC_OK)
		spec_matte_free(mask);
	return status;
}

/* Of an image that is a mask and no more. */
static const char *
usual_channel(const struct spec_image *image)
{
	if (image->channels == 1)
		return image->channel[0].name;
	if (spec_image_find_channel(image, "A") < image->channels)
		return "A";
	return spec_image_find_channel(image, "Y") < image->channels ? "Y" : NULL;
}

enum spec_status
spec_matte_settle(struct spec_matte *mask, const struct spec_image *image, const char *name,
	struct spec_error *error)
{
	const char *usual = usual_channel(image);
	size_t channel;

	if (!mask->channel && !usual)
		return spec_error_set(error, SPEC_EUSAGE,
			"%s: which of its %zu channels is the mask? (--mask FILE:CHANNEL)",
			name, image->channels);
	if (!mask->channel)
		mask->channel = spec_memory_text(usual, strlen(usual), error);
	if (!mask->channel)
		return SPEC_ENOMEM;
	channel = spec_image_find_channel(image, mask->channel);
	if (channel == image->channels)
		return spec_error_set(
			error, SPEC_EUSAGE, "%s has no channel '%s'", name, mask->channel);
	if (mask->equals && (image->channel[channel].sample != SPEC_SAMPLE_UINT ||
				    image->channel[channel].role != SPEC_ROLE_OTHER))
		return spec_error_set(error, SPEC_EUSAGE,
			"%s: its channel '%s' holds no whole numbers (UINT)", name,
			mask->channel);
	return SPEC_OK;
}

void
spec_matte_free(struct spec_matte *mask)
{
	free(mask->path);
	free(mask->channel);
	*mask = (struct spec_matte){0};
}
