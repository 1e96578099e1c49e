#include "image/fromrgb.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "base/memory.h"
#include "colour/space.h"
#include "image/save.h"
#include "spectrum/rebin.h"

/* How far chromaticities may be from Rec. 709's: files state them to three digits. */
#define SAME_XY .001

static enum spec_status
find_colours(struct spec_fromrgb *fromrgb, const char *name, struct spec_error *error)
{
	static const char *const names[3] = {"R", "G", "B"};
	const struct spec_image *input = fromrgb->input;

	if (input->bands > 0)
		return spec_error_set(error, SPEC_EFORMAT, "%s: is spectral already", name);
	for (int i = 0; i < 3; i++) {
		size_t found = spec_image_find_channel(input, names[i]);

		if (found == input->channels)
			return spec_error_set(error, SPEC_EFORMAT, "%s: has no channel %s",
				name, names[i]);
		if (input->channel[found].sample == SPEC_SAMPLE_UINT)
			return spec_error_set(error, SPEC_EFORMAT,
				"%s: its channel %s holds whole numbers", name, names[i]);
		fromrgb->colour[i] = found;
	}
	return SPEC_OK;
}

/* OpenEXR's attribute: x and y of red, green, blue and white. Without it they are Rec. 709's. */
static enum spec_status
check_space(const struct spec_image *input, const char *name, struct spec_error *error)
{
	const struct spec_space *space = spec_space_find("srgb", error);
	const struct spec_attribute *attribute =
		spec_image_attribute(input, "chromaticities");
	float xy[8];

	if (!attribute)
		return SPEC_OK;
	if (strcmp(attribute->type, "chromaticities") != 0 || attribute->size != sizeof xy)
		return spec_error_set(
			error, SPEC_EFORMAT, "%s: its chromaticities are damaged", name);
	memcpy(xy, attribute->value, sizeof xy);
	for (int i = 0; i < 8; i++) {
		const double *wanted = i < 2   ? space->red_xy
				       : i < 4 ? space->green_xy
				       : i < 6 ? space->blue_xy
					       : space->white_xy;

		if (!(fabs(xy[i] - wanted[i % 2]) <= SAME_XY))
			return spec_error_set(error, SPEC_EUNSUPPORTED,
				"%s: its primaries or its white are not those of Rec. 709 (%s "
				"%c is %g instead of %g)",
				name,
				i < 2   ? "red"
				: i < 4 ? "green"
				: i < 6 ? "blue"
					: "white",
				"xy"[i % 2], xy[i], wanted[i % 2]);
	}
	return SPEC_OK;
}

static enum spec_status
set_header(struct spec_fromrgb *fromrgb, const struct spec_fromrgb_setup *setup,
	const struct spec_grid *grid, const double *edges_nm, const char *name,
	struct spec_error *error)
{
	const struct spec_channel *red = &fromrgb->input->channel[fromrgb->colour[0]];
	int half = setup->half || red->sample == SPEC_SAMPLE_HALF;
	int light = setup->use == SPEC_UPSAMPLING_LIGHT;
	struct spec_image *image = &fromrgb->image;
	enum spec_status status = spec_image_copy(image, fromrgb->input, error);

	if (status != SPEC_OK)
		return status;
	spec_image_remove_preview(image);
	spec_image_remove_attribute(image, "chromaticities");
	status = spec_image_add_bands(image,
		light ? SPEC_ROLE_EMISSIVE : SPEC_ROLE_REFLECTIVE, 1, grid->wavelength_nm,
		grid->count, half ? SPEC_SAMPLE_HALF : SPEC_SAMPLE_FLOAT, error);
	if (status == SPEC_OK)
		status = spec_image_set_bins(image, edges_nm, grid->count, error);
	if (status == SPEC_OK)
		status = spec_image_set_text(image, "spectralLayoutVersion", "1.0", error);
	if (status == SPEC_OK)
		status = spec_image_set_text(image, "spec:quantity",
			light                                     ? "radiance per nm"
			: setup->use == SPEC_UPSAMPLING_UNBOUNDED ? "factor"
								  : "reflectance",
			error);
	if (status == SPEC_OK && light)
		status = spec_image_set_text(image, "emissiveUnits", "W.m^-2.sr^-1", error);
	return status == SPEC_OK ? spec_image_index(image, name, error) : status;
}

static enum spec_status
find_origins(struct spec_fromrgb *fromrgb, struct spec_error *error)
{
	const struct spec_image *input = fromrgb->input, *image = &fromrgb->image;

	fromrgb->origin = spec_memory_new(
		image->channels, sizeof *fromrgb->origin, "channels", error);
	fromrgb->wanted = spec_memory_new(input->channels, 1, "channels", error);
	if (!fromrgb->origin || !fromrgb->wanted)
		return SPEC_ENOMEM;
	for (size_t i = 0; i < image->channels; i++) {
		if (image->channel[i].role != SPEC_ROLE_OTHER)
			continue;
		fromrgb->origin[i] = spec_image_find_channel(input, image->channel[i].name);
		fromrgb->wanted[fromrgb->origin[i]] = 1;
	}
	for (int i = 0; i < 3; i++)
		fromrgb->wanted[fromrgb->colour[i]] = 1;
	return SPEC_OK;
}

static enum spec_status
plan_bands(struct spec_fromrgb *fromrgb, const struct spec_fromrgb_setup *setup,
	const char *name, struct spec_error *error)
{
	struct spec_grid usual = {0};
	const struct spec_grid *grid = setup->grid ? setup->grid : &usual;
	double *edges_nm = NULL;
	enum spec_status status = SPEC_OK;

	if (!setup->grid)
		status = spec_grid_parse(SPEC_FROMRGB_GRID, &usual, error);
	if (status == SPEC_OK) {
		edges_nm =
			spec_memory_new(grid->count + 1, sizeof *edges_nm, "bands", error);
		status = edges_nm ? SPEC_OK : SPEC_ENOMEM;
	}
	if (status == SPEC_OK) {
		struct spec_upsampling_setup bands = {.model = setup->model,
			.use = setup->use,
			.count = grid->count,
			.edges_nm = edges_nm,
			.extrapolate = setup->extrapolate};

		spec_bins_halfway(grid->wavelength_nm, grid->count, edges_nm);
		status = spec_upsampling_plan(&fromrgb->upsampling, &bands, error);
	}
	if (status == SPEC_OK)
		status = set_header(fromrgb, setup, grid, edges_nm, name, error);
	free(edges_nm);
	spec_grid_free(&usual);
	return status;
}

enum spec_status
spec_fromrgb_plan(struct spec_fromrgb *fromrgb, const struct spec_image *input,
	const struct spec_fromrgb_setup *setup, const char *name, struct spec_error *error)
{
	enum spec_status status;

	*fromrgb = (struct spec_fromrgb){.input = input};
	status = find_colours(fromrgb, name, error);
	if (status == SPEC_OK)
		status = check_space(input, name, error);
	if (status == SPEC_OK)
		status = plan_bands(fromrgb, setup, name, error);
	if (status == SPEC_OK)
		status = find_origins(fromrgb, error);
	if (status != SPEC_OK)
		spec_fromrgb_free(fromrgb);
	return status;
}

void
spec_fromrgb_free(struct spec_fromrgb *fromrgb)
{
	spec_image_clear(&fromrgb->image);
	spec_upsampling_free(&fromrgb->upsampling);
	free(fromrgb->origin);
	free(fromrgb->wanted);
	*fromrgb = (struct spec_fromrgb){0};
}

static enum spec_status
kernel(void *state, struct spec_stream_worker *worker, int line, struct spec_error *error)
{
	struct spec_fromrgb *fromrgb = state;
	const struct spec_image *image = &fromrgb->image;
	const struct spec_decoder *decoder = worker->decoder[0];
	size_t width = spec_window_width(&image->data);
	int y = image->data.y0 + line;
	float **band = worker->scratch, *const * plane;
	enum spec_status status = spec_packer_begin(worker->packer, y, &plane, error);

	if (status != SPEC_OK)
		return status;
	for (size_t i = 0; i < image->channels; i++) {
		if (image->channel[i].role == SPEC_ROLE_OTHER)
			memcpy(plane[i], spec_decoder_row(decoder, y, fromrgb->origin[i]),
				width * sizeof **plane);
	}
	for (size_t i = 0; i < image->bands; i++)
		band[i] = plane[image->band_channel[i]];
	atomic_fetch_add(&fromrgb->clamped,
		spec_upsampling_row(&fromrgb->upsampling,
			spec_decoder_row(decoder, y, fromrgb->colour[0]),
			spec_decoder_row(decoder, y, fromrgb->colour[1]),
			spec_decoder_row(decoder, y, fromrgb->colour[2]), width, band));
	return spec_packer_end(worker->packer, y, error);
}

enum spec_status
spec_fromrgb_run(struct spec_fromrgb *fromrgb, struct spec_reader *reader,
	const struct spec_settings *settings, unsigned long long *overflows,
	struct spec_error *error)
{
	struct spec_stream stream = {
		.reader = {reader},
		.wanted = {fromrgb->wanted},
		.readers = 1,
		.first_line = fromrgb->input->data.y0,
		.lines = (int)spec_window_height(&fromrgb->image.data),
		.lines_in = 1,
		.scratch_bytes = fromrgb->image.bands * sizeof(float *),
		.state = fromrgb,
		.kernel = kernel,
	};

	atomic_store(&fromrgb->clamped, 0);
	return spec_image_save(&fromrgb->image, &stream, settings, overflows, error);
}
