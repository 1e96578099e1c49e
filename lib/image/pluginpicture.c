/* Writing RGB pictures in the formats of the plugin. */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "base/memory.h"
#include "colour/profile.h"
#include "image/encoder.h"
#include "image/plugin.h"

/* Largest float that RGBE holds: a fraction of 255/256 and an exponent of 127. */
#define MOST_RGBE 0x1.FEp126f

struct state {
	struct spec_plugin loaded;
	void *picture;
	float *row;             /* of HDR, clamped */
	unsigned char *profile; /* or null */
};

/* The plugin's error with the file's name before it. */
static enum spec_status
report(struct spec_error *error, const struct spec_error *cause, const char *path)
{
	return spec_error_set(
		error, cause->status, "unable to write '%s': %s", path, cause->message);
}

enum spec_status
spec_plugin_knows(const char *suffix, const char *path, struct spec_error *error)
{
	struct state state = {0};
	struct spec_error cause = {0};
	enum spec_status status = spec_plugin_load(&state.loaded, &cause);

	if (status == SPEC_OK)
		status = state.loaded.table->knows(suffix, &cause);
	spec_plugin_unload(&state.loaded);
	return status == SPEC_OK ? SPEC_OK : report(error, &cause, path);
}

/* sRGB, with its own transfer function or linear. */
static int
is_plain(const struct spec_picture *picture)
{
	return strcmp(picture->space->name, "srgb") == 0 &&
	       (picture->kind.sample == SPEC_PICTURE_FLOAT ||
		       picture->space->transfer == &spec_transfer_srgb);
}

/* What the samples are, as OpenImageIO calls it; null: it has no word for it. */
static const char *
name_colour(const struct spec_picture *picture)
{
	const struct spec_space *space = picture->space;

	if (picture->kind.sample == SPEC_PICTURE_FLOAT)
		return "Linear";
	if (!space)
		return NULL;
	if (!space->transfer || space->transfer == &spec_transfer_linear)
		return "Linear";
	return is_plain(picture) ? "sRGB" : NULL;
}

/* OpenImageIO's word for sRGB becomes nothing in a TIFF. */
static int
is_tiff(const struct spec_picture *picture)
{
	return strncmp(picture->kind.suffix, "tif", 3) == 0;
}

/* The usual space needs none where OpenImageIO's word says it. */
static enum spec_status
make_profile(const struct spec_picture *picture, struct spec_pictures_request *request,
	struct spec_error *error)
{
	const struct spec_space *space = picture->space;
	struct state *state = picture->state;
	enum spec_status status;

	if (!space || (is_plain(picture) && !is_tiff(picture)))
		return SPEC_OK;
	status = spec_profile_make(space,
		picture->kind.sample == SPEC_PICTURE_FLOAT ? NULL : space->transfer,
		&state->profile, &request->profile_bytes, error);
	request->profile = state->profile;
	return status;
}

static int
is_rgbe(const struct spec_picture *picture)
{
	return strcmp(picture->kind.suffix, "hdr") == 0 ||
	       strcmp(picture->kind.suffix, "rgbe") == 0;
}

static enum spec_status
open_plugin(struct spec_picture *picture, struct spec_error *error)
{
	struct state *state = spec_memory_new(1, sizeof *state, "pictures", error);
	struct spec_error cause = {0};
	struct spec_pictures_request request = {.suffix = picture->kind.suffix,
		.width = picture->width,
		.height = picture->height,
		.channels = 3,
		.bits = 8 * (int)spec_picture_sample_bytes(picture->kind.sample),
		.colour = name_colour(picture)};
	enum spec_status status;

	picture->state = state;
	if (!state)
		return SPEC_ENOMEM;
	if (is_rgbe(picture)) {
		state->row = spec_memory_new(
			picture->width, 3 * sizeof *state->row, "samples", error);
		if (!state->row)
			return SPEC_ENOMEM;
	}
	status = make_profile(picture, &request, &cause);
	if (status == SPEC_OK)
		status = spec_plugin_load(&state->loaded, &cause);
	if (status == SPEC_OK)
		status = state->loaded.table->open(&state->picture, &request, &cause);
	return status == SPEC_OK ? SPEC_OK : report(error, &cause, picture->output->path);
}

/* OpenImageIO makes large numbers of negative ones here. NaN becomes 0, too. */
static enum spec_status
write_rgbe(struct spec_picture *picture, const float *sample, size_t count,
	struct spec_error *cause)
{
	struct state *state = picture->state;
	size_t samples = 3 * picture->width;
	enum spec_status status = SPEC_OK;

	for (size_t y = 0; y < count && status == SPEC_OK; y++, sample += samples) {
		for (size_t i = 0; i < samples; i++)
			state->row[i] = sample[i] > 0 ? fminf(sample[i], MOST_RGBE) : 0;
		status = state->loaded.table->write(state->picture, state->row, 1, cause);
	}
	return status;
}

static enum spec_status
write_plugin(struct spec_picture *picture, const void *rows, size_t count,
	struct spec_error *error)
{
	struct state *state = picture->state;
	struct spec_error cause = {0};
	enum spec_status status =
		is_rgbe(picture)
			? write_rgbe(picture, rows, count, &cause)
			: state->loaded.table->write(state->picture, rows, count, &cause);

	return status == SPEC_OK ? SPEC_OK : report(error, &cause, picture->output->path);
}

static enum spec_status
finish_plugin(struct spec_picture *picture, struct spec_error *error)
{
	struct state *state = picture->state;
	struct spec_error cause = {0};
	const unsigned char *bytes = NULL;
	size_t size = 0;

	if (state->loaded.table->finish(state->picture, &bytes, &size, &cause) != SPEC_OK)
		return report(error, &cause, picture->output->path);
	return spec_output_write(picture->output, bytes, size, error);
}

static void
close_plugin(struct spec_picture *picture)
{
	struct state *state = picture->state;

	if (!state)
		return;
	if (state->picture)
		state->loaded.table->close(state->picture);
	spec_plugin_unload(&state->loaded);
	free(state->row);
	free(state->profile);
	free(state);
}

const struct spec_picture_encoder spec_picture_encoder_plugin = {
	open_plugin, write_plugin, finish_plugin, close_plugin};
