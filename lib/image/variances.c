#include "image/variances.h"

#include <stdio.h>
#include <string.h>

int
spec_variances_is_one(const struct spec_channel *channel)
{
	return channel->role == SPEC_ROLE_OTHER &&
	       strncmp(channel->name, SPEC_VARIANCES_PREFIX,
		       strlen(SPEC_VARIANCES_PREFIX)) == 0;
}

int
spec_variances_has_some(const struct spec_image *image)
{
	size_t i = 0;

	while (i < image->channels && !spec_variances_is_one(&image->channel[i]))
		i++;
	return i < image->channels;
}

size_t
spec_variances_find(const struct spec_image *image, size_t band_channel)
{
	char name[256];

	if (snprintf(name, sizeof name, SPEC_VARIANCES_PREFIX "%s",
		    image->channel[band_channel].name) >= (int)sizeof name)
		return image->channels;
	return spec_image_find_channel(image, name);
}

int
spec_variances_are_whole(const struct spec_image *image)
{
	int whole = image->bands > 0;

	for (size_t i = 0; i < image->channels && whole; i++)
		whole = image->channel[i].role == SPEC_ROLE_OTHER ||
			spec_variances_find(image, i) < image->channels;
	return whole;
}

enum spec_status
spec_variances_renew(
	struct spec_image *image, int wanted, const char *name, struct spec_error *error)
{
	enum spec_status status;
	char text[256];
	size_t channels;

	spec_image_remove_channels(image, spec_variances_is_one);
	channels = image->channels;
	for (size_t i = 0; i < channels && wanted; i++) {
		if (image->channel[i].role == SPEC_ROLE_OTHER)
			continue;
		snprintf(text, sizeof text, SPEC_VARIANCES_PREFIX "%s",
			image->channel[i].name);
		status = spec_image_add_channel(image, text, SPEC_SAMPLE_FLOAT, error);
		if (status != SPEC_OK)
			return status;
	}
	return spec_image_index(image, name, error);
}
