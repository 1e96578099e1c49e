#include "image/patches.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "base/memory.h"
#include "image/save.h"

static enum spec_status
set_header(struct spec_image *image, const struct spec_curve *curve, enum spec_role role,
	struct spec_error *error)
{
	const char *quantity =
		role == SPEC_ROLE_REFLECTIVE ? curve->quantity : "radiance per nm";
	enum spec_status status =
		spec_image_set_text(image, "spectralLayoutVersion", "1.0", error);

	if (status == SPEC_OK)
		status = spec_image_set_text(image, "spec:quantity", quantity, error);
	if (status == SPEC_OK && role == SPEC_ROLE_EMISSIVE)
		status = spec_image_set_text(image, "emissiveUnits", "W.m^-2.sr^-1", error);
	return status;
}

size_t
spec_patches_count(const struct spec_curve *curve, size_t curves)
{
	size_t count = 0;

	for (size_t i = 0; i < curves; i++)
		count += curve[i].columns;
	return count;
}

enum spec_status
spec_patches_image(struct spec_image *image, const struct spec_curve *curve, size_t curves,
	const struct spec_patches_setup *setup, struct spec_error *error)
{
	long long width =
		(long long)setup->columns * (setup->patch + setup->gap) + setup->gap;
	long long height =
		(long long)setup->rows * (setup->patch + setup->gap) + setup->gap;
	enum spec_role role =
		spec_curve_is_ratio(&curve[0]) ? SPEC_ROLE_REFLECTIVE : SPEC_ROLE_EMISSIVE;
	enum spec_status status;

	*image = (struct spec_image){.pixel_aspect_ratio = 1, .screen_window_width = 1};
	if (spec_patches_count(curve, curves) >
		(size_t)setup->columns * (size_t)setup->rows)
		return spec_error_set(error, SPEC_EUSAGE,
			"%zu curves do not fit %d x %d patches",
			spec_patches_count(curve, curves), setup->columns, setup->rows);
	if (width > 1 << 20 || height > 1 << 20)
		return spec_error_set(error, SPEC_ERANGE,
			"a chart of %lld x %lld pixels is too large", width, height);
	for (size_t i = 0; i < curves; i++) {
		if (!spec_curve_is_ratio(&curve[i]) && !spec_curve_is_light(&curve[i]))
			return spec_error_set(error, SPEC_EUSAGE,
				"'%s' is a %s: an image holds light, reflectance or transmittance",
				curve[i].title, curve[i].quantity);
		if (spec_curve_is_ratio(&curve[i]) != spec_curve_is_ratio(&curve[0]))
			return spec_error_set(error, SPEC_EUSAGE,
				"'%s' is %s but '%s' is %s", curve[0].title,
				curve[0].quantity, curve[i].title, curve[i].quantity);
	}
	image->data = image->display = (struct spec_window){0, 0, (int)width, (int)height};
	status = set_header(image, &curve[0], role, error);
	if (status == SPEC_OK)
		status = spec_image_add_bands(image, role, 1, setup->grid->wavelength_nm,
			setup->grid->count,
			setup->half ? SPEC_SAMPLE_HALF : SPEC_SAMPLE_FLOAT, error);
	if (status == SPEC_OK)
		status = spec_image_index(image, "chart", error);
	if (status != SPEC_OK)
		spec_image_clear(image);
	return status;
}

/* The curves' values: value[patch * bands + band], a patch for each column. */
static enum spec_status
sample(const struct spec_curve *curve, size_t curves,
	const struct spec_patches_setup *setup, double **value, struct spec_error *error)
{
	size_t bands = setup->grid->count, patch = 0;
	enum spec_status status = SPEC_OK;

	*value = spec_memory_new(
		spec_patches_count(curve, curves) * bands, sizeof **value, "values", error);
	if (!*value)
		return SPEC_ENOMEM;
	for (size_t i = 0; i < curves; i++) {
		for (size_t j = 0; j < curve[i].columns && status == SPEC_OK; j++, patch++)
			status = spec_curve_sample(&curve[i], j, setup->extrapolate,
				setup->grid->wavelength_nm, bands, *value + patch * bands,
				error);
	}
	return status;
}

/* Which patch stands at a pixel, or patches where it is black. */
static size_t
patch_at(const struct spec_patches_setup *setup, size_t patches, int x, int y)
{
	int step = setup->patch + setup->gap;
	size_t index;

	if (x % step < setup->gap || y % step < setup->gap)
		return patches;
	index = (size_t)(y / step) * (size_t)setup->columns + (size_t)(x / step);
	return index < patches ? index : patches;
}

/* What the lines of a chart are made of. */
struct chart {
	const struct spec_image *image;
	const struct spec_patches_setup *setup;
	size_t patches;
	double *value; /* [patches][bands] */
};

static enum spec_status
kernel(void *state, struct spec_stream_worker *worker, int line, struct spec_error *error)
{
	const struct chart *chart = state;
	const struct spec_image *image = chart->image;
	size_t width = spec_window_width(&image->data);
	float *const *plane;
	enum spec_status status = spec_packer_begin(worker->packer, line, &plane, error);

	for (size_t i = 0; i < image->bands && status == SPEC_OK; i++) {
		float *row = plane[image->band_channel[i]];

		for (size_t x = 0; x < width; x++) {
			size_t index = patch_at(chart->setup, chart->patches, (int)x, line);

			row[x] = index < chart->patches
					 ? (float)chart->value[index * image->bands + i]
					 : 0;
		}
	}
	return status == SPEC_OK ? spec_packer_end(worker->packer, line, error) : status;
}

enum spec_status
spec_patches_write(const struct spec_image *image, const struct spec_curve *curve,
	size_t curves, const struct spec_patches_setup *setup,
	const struct spec_settings *settings, unsigned long long *overflows,
	struct spec_error *error)
{
	struct chart chart = {image, setup, spec_patches_count(curve, curves), NULL};
	struct spec_stream stream = {.lines = (int)spec_window_height(&image->data),
		.lines_in = 1,
		.state = &chart,
		.kernel = kernel};
	enum spec_status status = sample(curve, curves, setup, &chart.value, error);

	*overflows = 0;
	if (status == SPEC_OK)
		status = spec_image_save(image, &stream, settings, overflows, error);
	free(chart.value);
	return status;
}

static enum spec_status
new_curve(const struct spec_reader *reader, struct spec_curve *curve,
	struct spec_error *error)
{
	const struct spec_image *image = spec_reader_image(reader);
	size_t width = spec_window_width(&image->data);
	size_t pixels = width * spec_window_height(&image->data);
	char *quantity, column[48];
	enum spec_status status;

	if (image->bands == 0)
		return spec_error_set(error, SPEC_EFORMAT, "%s: has no spectral channel",
			spec_reader_name(reader));
	if (pixels > SPEC_PATCHES_MOST_PIXELS)
		return spec_error_set(error, SPEC_ERANGE,
			"%s: %zu pixels are more than the %d that fit a text (--crop or "
			"--downsample)",
			spec_reader_name(reader), pixels, SPEC_PATCHES_MOST_PIXELS);
	status = spec_curve_new(image->bands, pixels, curve, error);
	for (size_t i = 0; i < pixels && status == SPEC_OK; i++) {
		snprintf(column, sizeof column, "x%zuy%zu", i % width, i / width);
		status = spec_curve_set_text(&curve->column[i], column, error);
	}
	if (status != SPEC_OK)
		return status;
	quantity = spec_image_quantity(image, error);
	status = quantity ? spec_curve_set_text(&curve->quantity, quantity, error)
			  : SPEC_ENOMEM;
	free(quantity);
	memcpy(curve->wavelength_nm, image->wavelength_nm, image->bands * sizeof(double));
	return status;
}

double
spec_patches_shortest(float value)
{
	char text[32];

	for (int digits = 6; digits <= 9; digits++) {
		snprintf(text, sizeof text, "%.*g", digits, value);
		if (strtof(text, NULL) == value)
			break;
	}
	return strtod(text, NULL);
}

enum spec_status
spec_patches_curve(
	struct spec_reader *reader, struct spec_curve *curve, struct spec_error *error)
{
	const struct spec_image *image = spec_reader_image(reader);
	size_t width = spec_window_width(&image->data);
	struct spec_decoder *decoder = NULL;
	enum spec_status status = new_curve(reader, curve, error);

	if (status == SPEC_OK)
		status = spec_decoder_open(&decoder, reader, NULL, error);
	for (int y = image->data.y0; y < image->data.y1 && status == SPEC_OK; y++) {
		status = spec_decoder_read(decoder, y, error);
		for (size_t i = 0; i < image->bands && status == SPEC_OK; i++) {
			const float *row =
				spec_decoder_row(decoder, y, image->band_channel[i]);

			for (size_t x = 0; x < width && status == SPEC_OK; x++) {
				size_t pixel = (y - image->data.y0) * width + x;

				if (!isfinite(row[x]))
					status = spec_error_set(error, SPEC_EFORMAT,
						"%s: pixel %zu,%d is not finite at %g nm",
						spec_reader_name(reader), x,
						y - image->data.y0,
						image->wavelength_nm[i]);
				curve->value[pixel * image->bands + i] =
					spec_patches_shortest(row[x]);
			}
		}
	}
	spec_decoder_close(decoder);
	if (status == SPEC_OK)
		status = spec_reader_drain(reader, error);
	if (status != SPEC_OK)
		spec_curve_free(curve);
	return status;
}
