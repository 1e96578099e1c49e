/* A picture of linear RGB, or of other coordinates of colour, as an OpenEXR image. */
#include <stdlib.h>

#include "base/memory.h"
#include "image/encoder.h"
#include "image/image.h"
#include "image/writer.h"

#define CHANNELS 3

/* By enum spec_coordinates: the channels in the order of a file, by their names. */
static const struct layout {
	const char *name[CHANNELS];
	int component[CHANNELS]; /* of a pixel as it is given */
} layouts[] = {{{"B", "G", "R"}, {2, 1, 0}}, {{"X", "Y", "Z"}, {0, 1, 2}},
	{{"L", "a", "b"}, {0, 1, 2}}, {{"Y", "x", "y"}, {2, 0, 1}}};

struct state {
	const struct layout *layout;
	struct spec_image image;
	struct spec_writer *writer;
	struct spec_packer *packer;
};

/* The attribute's bytes: x and y of red, green, blue and white, little-endian floats. */
static enum spec_status
say_space(
	struct spec_image *image, const struct spec_space *space, struct spec_error *error)
{
	float xy[8];

	/* Other coordinates do not depend on primaries. */
	if (!space || space->coordinates != SPEC_COORDINATES_RGB)
		return SPEC_OK;
	for (int i = 0; i < 2; i++) {
		xy[i] = (float)space->red_xy[i];
		xy[2 + i] = (float)space->green_xy[i];
		xy[4 + i] = (float)space->blue_xy[i];
		xy[6 + i] = (float)space->white_xy[i];
	}
	return spec_image_set_attribute(
		image, "chromaticities", "chromaticities", xy, sizeof xy, error);
}

/* whiteLuminance is OpenEXR's: the luminance of R = G = B = 1. */
static enum spec_status
say_sums(struct spec_image *image, const struct spec_picture *picture,
	struct spec_error *error)
{
	const struct spec_space *space = picture->space;
	float luminance = (float)picture->kind.luminance;
	enum spec_status status = SPEC_OK;

	if (picture->kind.account)
		status = spec_image_set_text(
			image, "spec:integration", picture->kind.account, error);
	if (status == SPEC_OK && luminance > 0 && space &&
		space->coordinates == SPEC_COORDINATES_RGB)
		status = spec_image_set_attribute(image, "whiteLuminance", "float",
			&luminance, sizeof luminance, error);
	return status;
}

static enum spec_status
describe(struct spec_image *image, const struct spec_picture *picture,
	const struct layout *layout, struct spec_error *error)
{
	enum spec_status status = SPEC_OK;

	image->data.x1 = image->display.x1 = (int)picture->width;
	image->data.y1 = image->display.y1 = (int)picture->height;
	image->pixel_aspect_ratio = image->screen_window_width = 1;
	for (int i = 0; i < CHANNELS && status == SPEC_OK; i++)
		status = spec_image_add_channel(image, layout->name[i],
			picture->kind.half ? SPEC_SAMPLE_HALF : SPEC_SAMPLE_FLOAT, error);
	if (status == SPEC_OK)
		status = say_space(image, picture->space, error);
	if (status == SPEC_OK)
		status = say_sums(image, picture, error);
	if (status == SPEC_OK)
		status = spec_image_index(image, picture->output->path, error);
	return status;
}

static enum spec_status
open_exr(struct spec_picture *picture, struct spec_error *error)
{
	struct state *state = spec_memory_new(1, sizeof *state, "pictures", error);
	enum spec_status status;

	picture->state = state;
	if (!state)
		return SPEC_ENOMEM;
	state->layout = &layouts[picture->space ? picture->space->coordinates
						: SPEC_COORDINATES_RGB];
	status = describe(&state->image, picture, state->layout, error);
	if (status == SPEC_OK)
		status = spec_writer_open(
			&state->writer, &state->image, picture->output, -1, error);
	if (status == SPEC_OK)
		status = spec_packer_open(&state->packer, state->writer, error);
	return status;
}

static enum spec_status
write_exr(struct spec_picture *picture, const void *rows, size_t count,
	struct spec_error *error)
{
	struct state *state = picture->state;
	const int *component = state->layout->component;
	const float *sample = rows;
	enum spec_status status = SPEC_OK;

	for (size_t i = 0; i < count && status == SPEC_OK; i++) {
		int y = (int)(picture->done + i);
		float *const *plane;

		status = spec_packer_begin(state->packer, y, &plane, error);
		if (status != SPEC_OK)
			break;
		for (size_t x = 0; x < picture->width; x++, sample += CHANNELS) {
			plane[0][x] = sample[component[0]];
			plane[1][x] = sample[component[1]];
			plane[2][x] = sample[component[2]];
		}
		status = spec_packer_end(state->packer, y, error);
	}
	return status;
}

static enum spec_status
finish_exr(struct spec_picture *picture, struct spec_error *error)
{
	struct state *state = picture->state;

	/* The packer tells the writer what it saw when it closes. */
	spec_packer_close(state->packer);
	state->packer = NULL;
	picture->overflows = spec_writer_overflows(state->writer);
	return spec_writer_finish(state->writer, error);
}

static void
close_exr(struct spec_picture *picture)
{
	struct state *state = picture->state;

	if (!state)
		return;
	spec_packer_close(state->packer);
	spec_writer_close(state->writer);
	spec_image_clear(&state->image);
	free(state);
}

const struct spec_picture_encoder spec_picture_encoder_exr = {
	open_exr, write_exr, finish_exr, close_exr};
