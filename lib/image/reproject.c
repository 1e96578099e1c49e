#include "image/reproject.h"

#include <stdlib.h>
#include <string.h>

#include "base/memory.h"
#include "base/vector.h"
#include "image/save.h"

#define ACROSS 4 /* places of a pixel, each way */
#define TAPS (ACROSS * ACROSS * 4)

struct reprojection {
	const struct spec_image *input;
	struct spec_image image;
	struct spec_panorama from, to;
	float *sample; /* of the input: [(y * width + x) * channels + channel] */
};

/* Pixels of the input and their parts, each once. */
struct taps {
	size_t count;
	size_t pixel[TAPS];
	double part[TAPS];
};

static enum spec_status
take_lines(struct reprojection *it, struct spec_reader *reader, struct spec_error *error)
{
	const struct spec_image *image = it->input;
	size_t channels = image->channels, width = it->from.width;
	struct spec_decoder *decoder = NULL;
	enum spec_status status = spec_decoder_open(&decoder, reader, NULL, error);

	for (int y = image->data.y0; y < image->data.y1 && status == SPEC_OK; y++) {
		float *line = it->sample + (size_t)(y - image->data.y0) * width * channels;

		status = spec_decoder_read(decoder, y, error);
		for (size_t i = 0; i < channels && status == SPEC_OK; i++) {
			const float *row = spec_decoder_row(decoder, y, i);

			for (size_t x = 0; x < width; x++)
				line[x * channels + i] = row[x];
		}
	}
	if (status == SPEC_OK)
		status = spec_reader_drain(reader, error);
	spec_decoder_close(decoder);
	return status;
}

static enum spec_status
check(const struct reprojection *it, const char *name, const struct spec_settings *settings,
	struct spec_error *error)
{
	const struct spec_image *image = it->input;
	double bytes = (double)it->from.width * (double)it->from.height *
		       (double)image->channels * sizeof(float);

	if (image->role == SPEC_ROLE_EMISSIVE && image->stokes > 1)
		return spec_error_set(error, SPEC_EUNSUPPORTED,
			"%s: is polarised, and the frames of S1 and S2 would turn", name);
	if ((double)it->to.width * (double)it->to.height > (double)settings->limits.pixels)
		return spec_error_set(error, SPEC_ERANGE,
			"%s: would become %zu x %zu pixels, more than the limit of %lld (--limit pixels=N)",
			name, it->to.width, it->to.height, settings->limits.pixels);
	if (bytes > (double)settings->limits.memory)
		return spec_error_set(error, SPEC_ERANGE,
			"%s: %zu x %zu pixels of %zu channels take more than the limit of %lld bytes (--limit memory=BYTES)",
			name, it->from.width, it->from.height, image->channels,
			settings->limits.memory);
	return SPEC_OK;
}

static void
add_place(const struct reprojection *it, double x, double y, struct taps *taps)
{
	struct spec_panorama_blend blend;
	double direction[3];

	if (!spec_panorama_direction(&it->to, x, y, direction))
		return;
	blend = spec_panorama_around(&it->from, direction);
	for (size_t k = 0; k < 4; k++) {
		size_t i = 0;

		while (i < taps->count && taps->pixel[i] != blend.pixel[k])
			i++;
		if (i == taps->count) {
			taps->pixel[taps->count++] = blend.pixel[k];
			taps->part[i] = 0;
		}
		taps->part[i] += blend.part[k] / (ACROSS * ACROSS);
	}
}

SPEC_VECTORISED static void
add_pixel(double *restrict sum, const float *restrict sample, double part, size_t count)
{
	for (size_t i = 0; i < count; i++)
		sum[i] += part * sample[i];
}

/* The samples nearest to the middle of a pixel, or null beside the faces. */
static const float *
nearest(const struct reprojection *it, double x, double y)
{
	struct spec_panorama_blend blend;
	double direction[3];
	size_t best = 0;

	if (!spec_panorama_direction(&it->to, x, y, direction))
		return NULL;
	blend = spec_panorama_around(&it->from, direction);
	for (size_t k = 1; k < 4; k++) {
		if (blend.part[k] > blend.part[best])
			best = k;
	}
	return it->sample + blend.pixel[best] * it->input->channels;
}

/* One pixel of all channels. sum: room for these. */
static void
work_out(const struct reprojection *it, size_t x, size_t y, double *sum, float *const *out)
{
	size_t channels = it->input->channels;
	const float *whole = nearest(it, (double)x + .5, (double)y + .5);
	struct taps taps = {.count = 0};

	for (size_t i = 0; i < ACROSS; i++)
		for (size_t j = 0; j < ACROSS; j++)
			add_place(it, (double)x + ((double)j + .5) / ACROSS,
				(double)y + ((double)i + .5) / ACROSS, &taps);
	memset(sum, 0, channels * sizeof *sum);
	for (size_t i = 0; i < taps.count; i++) {
		if (taps.part[i] > 0)
			add_pixel(sum, it->sample + taps.pixel[i] * channels, taps.part[i],
				channels);
	}
	for (size_t i = 0; i < channels; i++) {
		const struct spec_channel *channel = &it->input->channel[i];

		out[i][x] = (float)sum[i];
		if (channel->role != SPEC_ROLE_OTHER || channel->sample != SPEC_SAMPLE_UINT)
			continue;
		if (whole)
			memcpy(&out[i][x], &whole[i], sizeof whole[i]);
		else
			memset(&out[i][x], 0, sizeof out[i][x]);
	}
}

static enum spec_status
kernel(void *state, struct spec_stream_worker *worker, int line, struct spec_error *error)
{
	const struct reprojection *it = state;
	float *const *out;
	enum spec_status status = spec_packer_begin(worker->packer, line, &out, error);

	if (status != SPEC_OK)
		return status;
	for (size_t x = 0; x < it->to.width; x++)
		work_out(it, x, (size_t)line, worker->scratch, out);
	return spec_packer_end(worker->packer, line, error);
}

/* The output's header: the input's, with another size. */
static enum spec_status
describe(struct reprojection *it, const char *name, const struct spec_settings *settings,
	struct spec_error *error)
{
	enum spec_status status = spec_image_copy(&it->image, it->input, error);

	if (status != SPEC_OK)
		return status;
	it->image.data = it->image.display =
		(struct spec_window){0, 0, (int)it->to.width, (int)it->to.height};
	it->image.pixel_aspect_ratio = 1;
	for (size_t i = 0; i < it->image.channels; i++) {
		struct spec_channel *channel = &it->image.channel[i];

		if (channel->role != SPEC_ROLE_OTHER &&
			(settings->half || channel->sample == SPEC_SAMPLE_UINT))
			channel->sample =
				settings->half ? SPEC_SAMPLE_HALF : SPEC_SAMPLE_FLOAT;
	}
	spec_image_remove_attribute(&it->image, "envmap");
	status = spec_image_index(&it->image, name, error);
	if (status == SPEC_OK)
		status = spec_settings_record(settings, &it->image, error);
	return status;
}

static enum spec_status
reproject(struct reprojection *it, struct spec_reader *reader,
	const struct spec_settings *settings, unsigned long long *overflows,
	struct spec_error *error)
{
	struct spec_stream stream = {.lines = (int)it->to.height,
		.lines_in = 1,
		.scratch_bytes = it->input->channels * sizeof(double),
		.state = it,
		.kernel = kernel};
	enum spec_status status = SPEC_ENOMEM;

	it->sample = spec_memory_new(it->from.width * it->from.height,
		it->input->channels * sizeof *it->sample, "samples", error);
	if (it->sample)
		status = take_lines(it, reader, error);
	if (status == SPEC_OK)
		status = spec_image_save(&it->image, &stream, settings, overflows, error);
	free(it->sample);
	return status;
}

enum spec_status
spec_reproject_run(struct spec_reader *reader, enum spec_projection projection,
	size_t height, const struct spec_settings *settings, unsigned long long *overflows,
	struct spec_error *error)
{
	struct reprojection it = {.input = spec_reader_image(reader)};
	const struct spec_window *data = &it.input->data;
	const char *name = spec_reader_name(reader);
	enum spec_status status = spec_panorama_of(
		spec_window_width(data), spec_window_height(data), &it.from, error);

	if (status != SPEC_OK) {
		spec_error_prefix(error, "%s", name);
		return status;
	}
	it.to = spec_panorama_like(&it.from, projection, height);
	status = check(&it, name, settings, error);
	if (status == SPEC_OK)
		status = describe(&it, name, settings, error);
	if (status == SPEC_OK)
		status = reproject(&it, reader, settings, overflows, error);
	spec_image_clear(&it.image);
	return status;
}
