#include "image/relight.h"

#include <stdlib.h>
#include <string.h>

#include "base/memory.h"

static enum spec_status
set_header(struct spec_relight *relight, int (*goes)(const struct spec_channel *channel),
	int half, const char *name, struct spec_error *error)
{
	struct spec_image *image = &relight->image;
	enum spec_status status = spec_image_copy(image, relight->input, error);

	if (status != SPEC_OK)
		return status;
	if (goes)
		spec_image_remove_channels(image, goes);
	spec_image_remove_preview(image);
	for (size_t i = 0; i < image->channels; i++) {
		struct spec_channel *channel = &image->channel[i];

		if (channel->role == SPEC_ROLE_EMISSIVE && half)
			channel->sample = SPEC_SAMPLE_HALF;
		else if (channel->role == SPEC_ROLE_EMISSIVE &&
			 channel->sample == SPEC_SAMPLE_UINT)
			channel->sample = SPEC_SAMPLE_FLOAT;
	}
	status = spec_image_set_text(image, "spectralLayoutVersion", "1.0", error);
	if (status == SPEC_OK && !spec_image_attribute(image, "emissiveUnits"))
		status = spec_image_set_text(image, "emissiveUnits", "W.m^-2.sr^-1", error);
	/* Bins that the old names say are known to an index alone. */
	if (status == SPEC_OK && relight->input->edges_nm)
		status = spec_image_index(image, name, error);
	return status == SPEC_OK ? spec_image_rename_bands(image, name, error) : status;
}

/* Bands by their place, for they may have been renamed; all else by its name. */
static enum spec_status
find_origins(struct spec_relight *relight, struct spec_error *error)
{
	const struct spec_image *input = relight->input, *image = &relight->image;
	size_t bands = input->bands;

	relight->origin = spec_memory_new(
		image->channels, sizeof *relight->origin, "channels", error);
	relight->band =
		spec_memory_new(image->channels, sizeof *relight->band, "channels", error);
	relight->wanted = spec_memory_new(input->channels, 1, "channels", error);
	if (!relight->origin || !relight->band || !relight->wanted)
		return SPEC_ENOMEM;
	for (size_t i = 0; i < image->channels; i++) {
		relight->band[i] = SPEC_LAYERS_NONE;
		if (image->channel[i].role == SPEC_ROLE_OTHER)
			relight->origin[i] =
				spec_image_find_channel(input, image->channel[i].name);
	}
	for (size_t i = 0; i < bands * (size_t)input->stokes; i++) {
		relight->origin[image->band_channel[i]] = input->band_channel[i];
		if (i < bands)
			relight->band[image->band_channel[i]] = i;
	}
	for (size_t i = 0; i < image->channels; i++)
		relight->wanted[relight->origin[i]] = 1;
	return SPEC_OK;
}

enum spec_status
spec_relight_plan(struct spec_relight *relight, const struct spec_image *input,
	int (*goes)(const struct spec_channel *channel), int half, const char *name,
	struct spec_error *error)
{
	enum spec_status status = SPEC_OK;

	*relight = (struct spec_relight){.input = input};
	if (input->role != SPEC_ROLE_EMISSIVE)
		status = spec_error_set(error, SPEC_EFORMAT,
			"%s: has no bands of light (S0.550,000000nm ...) to add light to",
			name);
	if (status == SPEC_OK)
		status = set_header(relight, goes, half, name, error);
	if (status == SPEC_OK)
		status = find_origins(relight, error);
	if (status != SPEC_OK)
		spec_relight_free(relight);
	return status;
}

void
spec_relight_free(struct spec_relight *relight)
{
	spec_image_clear(&relight->image);
	free(relight->origin);
	free(relight->band);
	free(relight->wanted);
	*relight = (struct spec_relight){0};
}

void
spec_relight_want(struct spec_relight *relight, size_t channel)
{
	if (channel != SPEC_LAYERS_NONE)
		relight->wanted[channel] = 1;
}

void
spec_relight_copy(const struct spec_relight *relight, const struct spec_decoder *decoder,
	int y, float *const *plane)
{
	const struct spec_image *image = &relight->image;
	size_t bytes = spec_window_width(&image->data) * sizeof **plane;

	for (size_t i = 0; i < image->channels; i++) {
		if (relight->band[i] == SPEC_LAYERS_NONE)
			memcpy(plane[i], spec_decoder_row(decoder, y, relight->origin[i]),
				bytes);
	}
}

struct spec_stream
spec_relight_stream(const struct spec_relight *relight, struct spec_reader *reader)
{
	return (struct spec_stream){
		.reader = {reader},
		.wanted = {relight->wanted},
		.readers = 1,
		.first_line = relight->input->data.y0,
		.lines = (int)spec_window_height(&relight->image.data),
		.lines_in = 1,
	};
}
