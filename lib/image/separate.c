#include "image/separate.h"

#include <math.h>
#include <stdatomic.h>
#include <stdlib.h>

#include "image/save.h"

struct separation {
	const struct spec_image *input, *image;
	const struct spec_rgb *rgb;
	const struct spec_model *model;
	size_t channel[SPEC_MODEL_MOST]; /* of each component, in image */
	size_t width;
	atomic_llong nonfinite;
	atomic_llong first; /* the first such pixel, by rows */
};

static enum spec_status
describe(struct separation *separation, struct spec_image *image, struct spec_error *error)
{
	const struct spec_model *model = separation->model;
	enum spec_status status = SPEC_OK;

	image->data = separation->input->data;
	image->display = separation->input->display;
	image->pixel_aspect_ratio = separation->input->pixel_aspect_ratio;
	image->screen_window_width = 1;
	for (size_t i = 0; i < model->components && status == SPEC_OK; i++)
		status = spec_image_add_channel(
			image, model->component[i], SPEC_SAMPLE_FLOAT, error);
	if (status == SPEC_OK)
		status = spec_image_index(image, model->name, error);
	for (size_t i = 0; i < model->components && status == SPEC_OK; i++)
		separation->channel[i] =
			spec_image_find_channel(image, model->component[i]);
	return status;
}

static void
note_nonfinite(struct separation *separation, long long pixel)
{
	long long first = atomic_load(&separation->first);

	atomic_fetch_add(&separation->nonfinite, 1);
	while (pixel < first &&
		!atomic_compare_exchange_weak(&separation->first, &first, pixel))
		;
}

static enum spec_status
kernel(void *state, struct spec_stream_worker *worker, int line, struct spec_error *error)
{
	struct separation *separation = state;
	const struct spec_rgb *rgb = separation->rgb;
	size_t width = separation->width;
	const float **plane = worker->scratch;
	float *linear = (float *)(void *)(plane + rgb->terms);
	float *const *out;
	enum spec_status status = spec_packer_begin(
		worker->packer, separation->image->data.y0 + line, &out, error);

	if (status != SPEC_OK)
		return status;
	for (size_t i = 0; i < rgb->terms; i++)
		plane[i] = spec_decoder_row(worker->decoder[0],
			separation->input->data.y0 + line, rgb->channel[i]);
	spec_rgb_row(rgb, plane, width, linear, linear + width, linear + 2 * width);
	for (size_t x = 0; x < width; x++) {
		double code[3], value[SPEC_MODEL_MOST];
		int finite = 1;

		for (size_t c = 0; c < 3; c++) {
			double sample = linear[c * width + x];

			finite &= isfinite(sample) != 0;
			code[c] = spec_srgb_encode(fmin(fmax(sample, 0), 1));
		}
		spec_model_from_rgb(separation->model, code, value);
		for (size_t i = 0; i < separation->model->components; i++)
			out[separation->channel[i]][x] = finite ? (float)value[i] : NAN;
		if (!finite)
			note_nonfinite(separation,
				(long long)line * (long long)width + (long long)x);
	}
	return spec_packer_end(worker->packer, separation->image->data.y0 + line, error);
}

static enum spec_status
run(struct separation *separation, struct spec_reader *reader,
	const struct spec_settings *settings, struct spec_error *error)
{
	const struct spec_rgb *rgb = separation->rgb;
	struct spec_stream stream = {.scratch_bytes = rgb->terms * sizeof(float *) +
						      3 * separation->width * sizeof(float),
		.state = separation,
		.kernel = kernel};
	unsigned char *wanted =
		spec_stream_take(&stream, reader, rgb->channel, rgb->terms, error);
	unsigned long long overflows;
	enum spec_status status = wanted ? spec_image_save(separation->image, &stream,
						   settings, &overflows, error)
					 : SPEC_ENOMEM;

	free(wanted);
	return status;
}

enum spec_status
spec_separate_run(struct spec_develop *result, struct spec_reader *reader,
	const struct spec_rgb *rgb, const struct spec_model *model,
	const struct spec_settings *settings, struct spec_error *error)
{
	struct spec_image image = {0};
	struct separation separation = {.input = spec_reader_image(reader),
		.image = &image,
		.rgb = rgb,
		.model = model,
		.first = 0x7fffffffffffffff};
	enum spec_status status;

	separation.width = spec_window_width(&separation.input->data);
	*result = (struct spec_develop){0};
	status = describe(&separation, &image, error);
	if (status == SPEC_OK)
		status = spec_settings_record(settings, &image, error);
	if (status == SPEC_OK)
		status = run(&separation, reader, settings, error);
	result->nonfinite = separation.nonfinite;
	if (result->nonfinite > 0) {
		result->first_x = (int)(separation.first % (long long)separation.width);
		result->first_y = (int)(separation.first / (long long)separation.width);
	}
	spec_image_clear(&image);
	return status;
}
