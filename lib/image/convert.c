#include "image/convert.h"

#include <math.h>
#include <stdint.h>
#include <stdlib.h>
#include <string.h>

#include "base/memory.h"
#include "base/vector.h"
#include "image/samples.h"
#include "image/save.h"

#define RUN 256 /* pixels summed at a time */

static enum spec_status
add_term(struct spec_convert *convert, size_t channel, double weight,
	struct spec_error *error)
{
	void *channels = convert->channel, *weights = convert->weight;
	enum spec_status status = spec_memory_grow(&channels, &convert->channel_room,
		convert->terms + 1, sizeof *convert->channel, "weights", error);

	convert->channel = channels;
	if (status == SPEC_OK)
		status = spec_memory_grow(&weights, &convert->weight_room,
			convert->terms + 1, sizeof *convert->weight, "weights", error);
	convert->weight = weights;
	if (status != SPEC_OK)
		return status;
	convert->channel[convert->terms] = channel;
	convert->weight[convert->terms] = weight;
	convert->wanted[channel] = 1;
	convert->terms++;
	return SPEC_OK;
}

static int
floor_divide(int a, int b)
{
	return a / b - (a % b < 0);
}

static enum spec_status
set_windows(struct spec_convert *convert, const struct spec_convert_setup *setup,
	const char *name, struct spec_error *error)
{
	const struct spec_window *whole = &convert->input->data;
	struct spec_window *data = &convert->image.data, *display = &convert->image.display;
	int n = setup->downsample;

	convert->downsample = n;
	if (setup->has_crop) {
		const struct spec_window *crop = &setup->crop;
		long long width = (long long)spec_window_width(whole);
		long long height = (long long)spec_window_height(whole);

		if (crop->x0 < 0 || crop->y0 < 0 || crop->x1 > width || crop->y1 > height ||
			crop->x0 >= crop->x1 || crop->y0 >= crop->y1)
			return spec_error_set(error, SPEC_ERANGE,
				"%s: the crop %d,%d,%d,%d is empty or not inside "
				"0,0,%lld,%lld",
				name, crop->x0, crop->y0, crop->x1, crop->y1, width,
				height);
		convert->x0 = crop->x0;
		convert->y0 = crop->y0;
		*data = (struct spec_window){whole->x0 + crop->x0, whole->y0 + crop->y0,
			whole->x0 + crop->x1, whole->y0 + crop->y1};
	}
	if (n == 1)
		return SPEC_OK;
	if (data->x0 % n || data->y0 % n || data->x1 % n || data->y1 % n)
		return spec_error_set(error, SPEC_ERANGE,
			"%s: the window %d,%d,%d,%d is not made of %d x %d pixels (--crop "
			"it first)",
			name, data->x0, data->y0, data->x1, data->y1, n, n);
	*data = (struct spec_window){
		data->x0 / n, data->y0 / n, data->x1 / n, data->y1 / n};
	*display = (struct spec_window){floor_divide(display->x0, n),
		floor_divide(display->y0, n), -floor_divide(-display->x1, n),
		-floor_divide(-display->y1, n)};
	return SPEC_OK;
}

/* The bands that --band names must be there: nothing is interpolated. */
static enum spec_status
match_bands(const struct spec_image *input, const struct spec_grid *wanted,
	struct spec_grid *found, const char *name, struct spec_error *error)
{
	enum spec_status status = spec_grid_new(wanted->count, found, error);

	for (size_t i = 0; i < wanted->count && status == SPEC_OK; i++) {
		double target = wanted->wavelength_nm[i];
		int same;
		size_t band = spec_image_nearest_band(input, target, &same);

		found->wavelength_nm[i] = input->wavelength_nm[band];
		if (!same)
			status = spec_error_set(error, SPEC_ERANGE,
				"%s: has no band at %g nm; the nearest is at %g nm (--grid interpolates)",
				name, target, input->wavelength_nm[band]);
	}
	return status;
}

/* Bins stay bins only where the bands stay as they are, without gaps between them. */
static enum spec_status
settle_bins(struct spec_convert *convert, const struct spec_grid *grid,
	struct spec_error *error)
{
	const struct spec_image *input = convert->input;
	size_t first = 0, count = 0;

	if (!input->edges_nm || !grid)
		return SPEC_OK;
	for (; count < grid->count; count++) {
		int same;
		size_t band =
			spec_image_nearest_band(input, grid->wavelength_nm[count], &same);

		if (count == 0)
			first = band;
		if (!same || band != first + count)
			break;
	}
	if (count == grid->count)
		return spec_image_set_bins(
			&convert->image, input->edges_nm + first, count, error);
	return spec_image_set_bins(&convert->image, NULL, 0, error);
}

static int
changes_values(const struct spec_convert_setup *setup)
{
	return setup->multiplies > 0 || setup->illuminate || setup->scale != 1;
}

static enum spec_sample
sample_of_bands(const struct spec_image *input, int half)
{
	if (half)
		return SPEC_SAMPLE_HALF;
	return input->channel[input->band_channel[0]].sample == SPEC_SAMPLE_HALF
		       ? SPEC_SAMPLE_HALF
		       : SPEC_SAMPLE_FLOAT;
}

/* The output's bands: those of the grid, or the input's own, in the layout's names. */
static enum spec_status
set_bands(struct spec_convert *convert, const struct spec_convert_setup *setup,
	const struct spec_grid *grid, const char *name, struct spec_error *error)
{
	const struct spec_image *input = convert->input;
	struct spec_image *image = &convert->image;
	enum spec_role role = setup->illuminate ? SPEC_ROLE_EMISSIVE : input->role;
	enum spec_status status = spec_image_index(image, name, error);

	if (status == SPEC_OK && input->edges_nm)
		status = spec_image_set_bins(image, input->edges_nm, input->bands, error);
	if (status == SPEC_OK)
		status = settle_bins(convert, grid, error);
	if (status != SPEC_OK)
		return status;
	if (grid || setup->illuminate) {
		spec_image_remove_bands(image);
		status = spec_image_add_bands(image, role, input->stokes,
			grid ? grid->wavelength_nm : input->wavelength_nm,
			grid ? grid->count : input->bands, sample_of_bands(input, 0),
			error);
	}
	for (size_t i = 0; i < image->channels; i++) {
		struct spec_channel *channel = &image->channel[i];

		if (channel->role == SPEC_ROLE_OTHER)
			continue;
		if (setup->half || channel->sample == SPEC_SAMPLE_UINT)
			channel->sample =
				setup->half ? SPEC_SAMPLE_HALF : SPEC_SAMPLE_FLOAT;
	}
	if (changes_values(setup))
		spec_image_remove_preview(image);
	return status == SPEC_OK ? spec_image_rename_bands(image, name, error) : status;
}

static enum spec_status
set_attributes(struct spec_convert *convert, const struct spec_convert_setup *setup,
	struct spec_error *error)
{
	struct spec_image *image = &convert->image;
	enum spec_status status =
		spec_image_set_text(image, "spectralLayoutVersion", "1.0", error);

	if (status == SPEC_OK && setup->illuminate)
		status = spec_image_set_text(
			image, "spec:quantity", "radiance per nm", error);
	if (status == SPEC_OK && image->role == SPEC_ROLE_EMISSIVE &&
		!spec_image_attribute(image, "emissiveUnits"))
		status = spec_image_set_text(image, "emissiveUnits", "W.m^-2.sr^-1", error);
	return status;
}

/* A pixel of N x N has as many times the samples. */
static enum spec_status
count_samples(struct spec_convert *convert, const char *name, struct spec_error *error)
{
	long long n = convert->downsample, samples;
	enum spec_status status = spec_samples_get(&convert->image, &samples, name, error);

	return status == SPEC_OK
		       ? spec_samples_set(&convert->image, samples * n * n, name, error)
		       : status;
}

/* What all curves together multiply the light at a wavelength by. */
static enum spec_status
factor_at(const struct spec_convert_setup *setup, double wavelength_nm, double *factor,
	struct spec_error *error)
{
	enum spec_status status = SPEC_OK;

	*factor = setup->scale;
	for (size_t i = 0; i < setup->multiplies && status == SPEC_OK; i++) {
		double value = 0;

		status = spec_curve_sample(&setup->multiply[i], 0, setup->extrapolate,
			&wavelength_nm, 1, &value, error);
		*factor *= value;
	}
	return status;
}

static enum spec_status
power_at(const struct spec_convert_setup *setup, double wavelength_nm, double *power,
	struct spec_error *error)
{
	*power = 1;
	if (!setup->illuminate)
		return SPEC_OK;
	return spec_curve_sample(
		setup->illuminate, 0, setup->extrapolate, &wavelength_nm, 1, power, error);
}

static enum spec_status
refuse_outside(const struct spec_image *input, double wavelength_nm, const char *name,
	struct spec_error *error)
{
	return spec_error_set(error, SPEC_ERANGE,
		"%s: %g nm is outside its bands, %g..%g nm (--extrapolate zero|constant)",
		name, wavelength_nm, input->wavelength_nm[0],
		input->wavelength_nm[input->bands - 1]);
}

/* One band of the output: the input's band, or the two that it lies between. */
static enum spec_status
add_band_terms(struct spec_convert *convert, const struct spec_convert_setup *setup,
	double wavelength_nm, int stokes, double factor, const char *name,
	struct spec_error *error)
{
	const struct spec_image *input = convert->input;
	const double *known = input->wavelength_nm;
	const size_t *channel = input->band_channel + (size_t)stokes * input->bands;
	int same, outside = wavelength_nm < known[0] ||
			    wavelength_nm > known[input->bands - 1];
	size_t i = spec_image_nearest_band(input, wavelength_nm, &same);
	double power, part;
	enum spec_status status;

	if (!same && outside && setup->extrapolate == SPEC_EXTRAPOLATE_REFUSE)
		return refuse_outside(input, wavelength_nm, name, error);
	if (!same && outside && setup->extrapolate == SPEC_EXTRAPOLATE_ZERO)
		return SPEC_OK; /* no term: zero times a NaN would be one */
	status = power_at(setup, wavelength_nm, &power, error);
	if (status != SPEC_OK)
		return status;
	factor *= power;
	if (same || outside)
		return add_term(convert, channel[i], factor, error);
	i -= known[i] > wavelength_nm;
	part = (wavelength_nm - known[i]) / (known[i + 1] - known[i]);
	status = add_term(convert, channel[i], factor * (1 - part), error);
	return status == SPEC_OK ? add_term(convert, channel[i + 1], factor * part, error)
				 : status;
}

/* Light that comes in at other wavelengths and leaves at this one. */
static enum spec_status
add_reradiated_terms(struct spec_convert *convert, const struct spec_convert_setup *setup,
	double wavelength_nm, double factor, struct spec_error *error)
{
	const struct spec_image *input = convert->input;
	enum spec_status status = SPEC_OK;

	for (size_t i = 0; i < input->channels && status == SPEC_OK; i++) {
		const struct spec_channel *channel = &input->channel[i];
		double power;
		int same;

		if (channel->role != SPEC_ROLE_BISPECTRAL)
			continue;
		if (input->wavelength_nm[spec_image_nearest_band(
			    input, channel->reradiated_nm, &same)] != wavelength_nm)
			continue;
		status = power_at(setup, channel->wavelength_nm, &power, error);
		if (status == SPEC_OK)
			status = add_term(convert, i, factor * power, error);
	}
	return status;
}

/* The input's channel that a channel of the output was, by its name or by its bands. */
static size_t
find_origin(const struct spec_image *input, const struct spec_channel *channel)
{
	size_t found = spec_image_find_channel(input, channel->name);

	for (size_t i = 0; found == input->channels && i < input->channels; i++) {
		const struct spec_channel *other = &input->channel[i];

		if (other->role == channel->role &&
			fabs(other->wavelength_nm - channel->wavelength_nm) < 1e-6 &&
			fabs(other->reradiated_nm - channel->reradiated_nm) < 1e-6)
			found = i;
	}
	return found;
}

static enum spec_status
add_channel_terms(struct spec_convert *convert, const struct spec_convert_setup *setup,
	const struct spec_channel *channel, const char *name, struct spec_error *error)
{
	enum spec_status status;
	double factor = 1;

	if (channel->role == SPEC_ROLE_OTHER)
		return add_term(convert, find_origin(convert->input, channel), 1, error);
	status = factor_at(setup,
		channel->role == SPEC_ROLE_BISPECTRAL ? channel->reradiated_nm
						      : channel->wavelength_nm,
		&factor, error);
	if (status != SPEC_OK)
		return status;
	if (channel->role == SPEC_ROLE_BISPECTRAL)
		return add_term(
			convert, find_origin(convert->input, channel), factor, error);
	status = add_band_terms(convert, setup, channel->wavelength_nm, channel->stokes,
		factor, name, error);
	if (status == SPEC_OK && setup->illuminate)
		status = add_reradiated_terms(
			convert, setup, channel->wavelength_nm, factor, error);
	return status;
}

static enum spec_status
plan_terms(struct spec_convert *convert, const struct spec_convert_setup *setup,
	const char *name, struct spec_error *error)
{
	size_t channels = convert->image.channels;
	enum spec_status status = SPEC_OK;

	convert->first =
		spec_memory_new(channels + 1, sizeof *convert->first, "channels", error);
	convert->wanted = spec_memory_new(convert->input->channels, 1, "channels", error);
	if (!convert->first || !convert->wanted)
		return SPEC_ENOMEM;
	for (size_t i = 0; i < channels && status == SPEC_OK; i++) {
		convert->first[i] = convert->terms;
		status = add_channel_terms(
			convert, setup, &convert->image.channel[i], name, error);
	}
	convert->first[channels] = convert->terms;
	return status;
}

static enum spec_status
refuse_per_band(const struct spec_image *input, const char *name, struct spec_error *error)
{
	char *quantity = spec_image_quantity(input, error);
	int per_band = quantity && strstr(quantity, "per band");

	if (!quantity)
		return SPEC_ENOMEM;
	free(quantity);
	if (!per_band)
		return SPEC_OK;
	return spec_error_set(error, SPEC_EUNSUPPORTED,
		"%s: its values are per band; they cannot be interpolated", name);
}

static enum spec_status
check_setup(const struct spec_image *input, const struct spec_convert_setup *setup,
	const char *name, struct spec_error *error)
{
	int spectral = setup->grid || setup->bands || changes_values(setup);

	if (input->bands == 0 && spectral)
		return spec_error_set(
			error, SPEC_EFORMAT, "%s: has no spectral channel", name);
	if (setup->illuminate && input->role != SPEC_ROLE_REFLECTIVE)
		return spec_error_set(error, SPEC_EUSAGE,
			"%s: only reflectance (T) can be illuminated", name);
	if (input->bispectral > 0 && (setup->grid || setup->bands))
		return spec_error_set(error, SPEC_EUNSUPPORTED,
			"%s: is bispectral; its grid cannot be changed (--illuminate it "
			"first)",
			name);
	return setup->grid ? refuse_per_band(input, name, error) : SPEC_OK;
}

enum spec_status
spec_convert_plan(struct spec_convert *convert, const struct spec_image *input,
	const struct spec_convert_setup *setup, const char *name, struct spec_error *error)
{
	struct spec_grid found = {0};
	const struct spec_grid *grid = setup->grid;
	enum spec_status status = check_setup(input, setup, name, error);

	*convert = (struct spec_convert){.input = input};
	if (status == SPEC_OK && setup->bands) {
		status = match_bands(input, setup->bands, &found, name, error);
		grid = &found;
	}
	if (status == SPEC_OK)
		status = spec_image_copy(&convert->image, input, error);
	if (status == SPEC_OK)
		status = set_windows(convert, setup, name, error);
	if (status == SPEC_OK && input->bands > 0)
		status = set_bands(convert, setup, grid, name, error);
	else if (status == SPEC_OK)
		status = spec_image_index(&convert->image, name, error);
	if (status == SPEC_OK && input->bands > 0)
		status = set_attributes(convert, setup, error);
	if (status == SPEC_OK && setup->downsample > 1)
		status = count_samples(convert, name, error);
	if (status == SPEC_OK)
		status = plan_terms(convert, setup, name, error);
	spec_grid_free(&found);
	if (status != SPEC_OK)
		spec_convert_free(convert);
	return status;
}

void
spec_convert_free(struct spec_convert *convert)
{
	spec_image_clear(&convert->image);
	free(convert->first);
	free(convert->channel);
	free(convert->weight);
	free(convert->wanted);
	*convert = (struct spec_convert){0};
}

SPEC_VECTORISED static void
scale_row(float *restrict to, const float *restrict from, double weight, size_t count)
{
	for (size_t x = 0; x < count; x++)
		to[x] = (float)(weight * from[x]);
}

SPEC_VECTORISED static void
blend_row(float *restrict to, const float *restrict a, const float *restrict b, double wa,
	double wb, size_t count)
{
	for (size_t x = 0; x < count; x++)
		to[x] = (float)(wa * a[x] + wb * b[x]);
}

/* Any number of terms over n x n pixels each, summed in double. */
static void
sum_row(const struct spec_convert *convert, const struct spec_stream_worker *worker,
	size_t channel, int y, float *to, size_t width)
{
	int n = convert->downsample;
	double share = 1.0 / ((double)n * n), sum[RUN];

	for (size_t x0 = 0; x0 < width; x0 += RUN) {
		size_t count = width - x0 < RUN ? width - x0 : RUN;

		memset(sum, 0, sizeof sum);
		for (size_t t = convert->first[channel]; t < convert->first[channel + 1];
			t++) {
			for (int line = 0; line < n; line++) {
				const float *from = spec_decoder_row(worker->decoder[0],
							    y + line, convert->channel[t]) +
						    convert->x0 + x0 * n;

				for (size_t x = 0; x < count; x++)
					for (int i = 0; i < n; i++)
						sum[x] += convert->weight[t] *
							  from[x * n + i];
			}
		}
		for (size_t x = 0; x < count; x++)
			to[x0 + x] = (float)(sum[x] * share);
	}
}

struct sample {
	uint32_t value, place;
};

static int
compare_samples(const void *a, const void *b)
{
	const struct sample *one = a, *two = b;

	if (one->value != two->value)
		return one->value < two->value ? -1 : 1;
	return one->place < two->place ? -1 : 1;
}

/* The value that most samples have; of several that lead, the one that came first. */
static uint32_t
most_frequent(struct sample *sample, size_t count)
{
	size_t best = 0, best_count = 0;

	qsort(sample, count, sizeof *sample, compare_samples);
	for (size_t i = 0, run; i < count; i += run) {
		for (run = 1; i + run < count && sample[i + run].value == sample[i].value;
			run++)
			continue;
		if (run > best_count ||
			(run == best_count && sample[i].place < sample[best].place)) {
			best = i;
			best_count = run;
		}
	}
	return sample[best].value;
}

/* Whole numbers that are no bands: of n x n pixels the most frequent. */
static void
reduce_numbers(const struct spec_convert *convert, const struct spec_stream_worker *worker,
	size_t source, int y, float *to)
{
	size_t width = spec_window_width(&convert->image.data), n = convert->downsample;
	struct sample *sample = worker->scratch;

	for (size_t x = 0; x < width; x++) {
		uint32_t value;
		int equal = 1;

		for (size_t line = 0; line < n; line++) {
			const float *from = spec_decoder_row(worker->decoder[0],
						    y + (int)line, source) +
					    convert->x0 + x * n;

			for (size_t i = 0; i < n; i++) {
				struct sample *next = &sample[line * n + i];

				memcpy(&next->value, from + i, sizeof next->value);
				next->place = (uint32_t)(line * n + i);
				equal &= next->value == sample[0].value;
			}
		}
		value = equal ? sample[0].value : most_frequent(sample, n * n);
		memcpy(to + x, &value, sizeof value);
	}
}

static void
convert_row(const struct spec_convert *convert, const struct spec_stream_worker *worker,
	size_t channel, int y, float *to)
{
	size_t width = spec_window_width(&convert->image.data);
	size_t first = convert->first[channel], count = convert->first[channel + 1] - first;
	const size_t *source = convert->channel + first;
	const double *weight = convert->weight + first;
	const float *from;

	if (count == 0) {
		memset(to, 0, width * sizeof *to);
		return;
	}
	from = spec_decoder_row(worker->decoder[0], y, source[0]) + convert->x0;
	if (convert->downsample > 1 &&
		convert->image.channel[channel].sample == SPEC_SAMPLE_UINT)
		reduce_numbers(convert, worker, source[0], y, to);
	else if (convert->downsample > 1 || count > 2)
		sum_row(convert, worker, channel, y, to, width);
	else if (count == 2)
		blend_row(to, from,
			spec_decoder_row(worker->decoder[0], y, source[1]) + convert->x0,
			weight[0], weight[1], width);
	else if (weight[0] == 1)
		memcpy(to, from, width * sizeof *to);
	else
		scale_row(to, from, weight[0], width);
}

static enum spec_status
kernel(void *state, struct spec_stream_worker *worker, int line, struct spec_error *error)
{
	const struct spec_convert *convert = state;
	int y = convert->input->data.y0 + convert->y0 + line * convert->downsample;
	int y_out = convert->image.data.y0 + line;
	float *const *plane;
	enum spec_status status = spec_packer_begin(worker->packer, y_out, &plane, error);

	if (status != SPEC_OK)
		return status;
	for (size_t i = 0; i < convert->image.channels; i++)
		convert_row(convert, worker, i, y, plane[i]);
	return spec_packer_end(worker->packer, y_out, error);
}

enum spec_status
spec_convert_run(struct spec_convert *convert, struct spec_reader *reader,
	const struct spec_settings *settings, unsigned long long *overflows,
	struct spec_error *error)
{
	struct spec_stream stream = {
		.reader = {reader},
		.wanted = {convert->wanted},
		.readers = 1,
		.first_line = convert->input->data.y0 + convert->y0,
		.lines = (int)spec_window_height(&convert->image.data),
		.lines_in = convert->downsample,
		.state = convert,
		.kernel = kernel,
	};

	if (convert->downsample > 1)
		stream.scratch_bytes = (size_t)convert->downsample *
				       (size_t)convert->downsample * sizeof(struct sample);
	return spec_image_save(&convert->image, &stream, settings, overflows, error);
}
