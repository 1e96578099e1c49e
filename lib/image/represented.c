/* Writing images in other representations, and what their attribute says. */
#include "image/represented.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "base/memory.h"
#include "base/number.h"
#include "base/text.h"
#include "image/mix.h"
#include "image/save.h"
#include "image/stream.h"
#include "spectrum/fourier.h"
#include "spectrum/spd.h"

/* ---- names and the attribute ---- */

const char *
spec_represented_prefix(enum spec_role role, int stokes)
{
	static const char *const names[] = {"S0", "S1", "S2", "S3"};

	return role == SPEC_ROLE_EMISSIVE ? names[stokes] : "T";
}

void
spec_represented_name(char *text, size_t size, const char *prefix, size_t coefficient)
{
	snprintf(text, size, "%s.%c%zu", prefix,
		coefficient == 0 || coefficient % 2 == 1 ? 'a' : 'b',
		(coefficient + 1) / 2);
}

void
spec_represented_line_names(
	char *weight, char *wavelength, size_t size, const char *prefix, size_t line)
{
	snprintf(weight, size, "%s.line%zu", prefix, line + 1);
	snprintf(wavelength, size, "%s.line%zu.nm", prefix, line + 1);
}

static enum spec_status
fail_attribute(const char *name, const char *text, struct spec_error *error)
{
	return spec_error_set(error, SPEC_EFORMAT,
		"%s: its spec:representation is none: '%.60s'", name, text);
}

enum spec_status
spec_represented_read(const struct spec_image *image, const char *name,
	struct spec_represented *represented, struct spec_error *error)
{
	unsigned long long lines = 0, coefficients = 0;
	double low_nm = 0, high_nm = 0;
	char *text, end;
	int has_lines, has_series;
	enum spec_status status =
		spec_image_text(image, "spec:representation", &text, error);

	*represented = (struct spec_represented){0};
	if (status != SPEC_OK || !text)
		return status;
	has_series = sscanf(text, "fourier %4llu %lf %lf%c", &coefficients, &low_nm,
			     &high_nm, &end) == 3;
	has_lines = !has_series;
	if (!has_series)
		has_series = sscanf(text, "composite %4llu fourier %4llu %lf %lf%c", &lines,
				     &coefficients, &low_nm, &high_nm, &end) == 4;
	if (!has_series)
		has_lines = sscanf(text, "composite %4llu%c", &lines, &end) == 1;
	if ((!has_series && !has_lines) || strpbrk(text, "xX") || /* hexadecimal */
		(has_lines && (lines < 1 || lines > SPEC_REPRESENTED_MOST_LINES)) ||
		(has_series && (coefficients % 2 == 0 ||
				       coefficients > SPEC_REPRESENTED_MOST_COEFFICIENTS ||
				       !(low_nm > 0) || !(high_nm > low_nm) ||
				       !isfinite(high_nm))))
		status = fail_attribute(name, text, error);
	represented->low_nm = low_nm;
	represented->high_nm = high_nm;
	represented->lines = lines;
	represented->coefficients = coefficients;
	free(text);
	return status;
}

static enum spec_status
write_attribute(struct spec_image *image, const struct spec_represented *represented,
	struct spec_error *error)
{
	char text[160], low[SPEC_SPD_NUMBER], high[SPEC_SPD_NUMBER];
	int length = 0;

	spec_spd_format_number(represented->low_nm, low);
	spec_spd_format_number(represented->high_nm, high);
	if (represented->lines > 0)
		length = snprintf(text, sizeof text, "composite %zu", represented->lines);
	if (represented->coefficients > 0)
		snprintf(text + length, sizeof text - (size_t)length, "%sfourier %zu %s %s",
			length > 0 ? " " : "", represented->coefficients, low, high);
	return spec_image_set_text(image, "spec:representation", text, error);
}

/* The bands that coefficients stand for have no channels to be named by. */
static enum spec_status
write_wavelengths(
	struct spec_image *image, const struct spec_image *input, struct spec_error *error)
{
	struct spec_text text = {0};
	char number[SPEC_SPD_NUMBER];
	enum spec_status status = spec_text_open(&text, error);

	if (status != SPEC_OK)
		return status;
	for (size_t i = 0; i < input->bands; i++) {
		spec_spd_format_number(input->wavelength_nm[i], number);
		fprintf(text.stream, "%s%s", i > 0 ? " " : "", number);
	}
	fputc('\0', text.stream);
	status = spec_text_close(&text, error);
	if (status == SPEC_OK)
		status = spec_image_set_text(image, "spec:wavelengths", text.bytes, error);
	spec_text_free(&text);
	return status;
}

/* ---- the matrices ---- */

/* T 3.2 and 3.3 of the spectrum that is 1 in one band and 0 in the others. */
static enum spec_status
add_band(const struct spec_represented *represented, const double *wavelength_nm,
	const double *edges_nm, size_t bands, size_t band, double *value,
	double *coefficient)
{
	struct spec_samples samples = {
		wavelength_nm, value, bands, SPEC_INTERPOLATE_LINEAR};
	struct spec_piece piece[2] = {{.terms = 1, .coefficient = {1}}};
	double low_nm = represented->low_nm, high_nm = represented->high_nm;

	if (edges_nm) {
		piece->from_nm = edges_nm[band];
		piece->to_nm = edges_nm[band + 1];
		spec_series_add_piece(
			piece, low_nm, high_nm, coefficient, represented->coefficients);
		return SPEC_OK;
	}
	value[band] = 1;
	for (size_t i = band > 0 ? band - 1 : 0; i <= band && i + 1 < bands; i++) {
		int pieces = spec_samples_pieces(&samples, i, piece);

		for (int k = 0; k < pieces; k++)
			spec_series_add_piece(&piece[k], low_nm, high_nm, coefficient,
				represented->coefficients);
	}
	value[band] = 0;
	return SPEC_OK;
}

double *
spec_represented_forth(const struct spec_represented *represented,
	const double *wavelength_nm, const double *edges_nm, size_t bands,
	struct spec_error *error)
{
	size_t count = represented->coefficients;
	double *weight = spec_memory_new(count, bands * sizeof *weight, "weights", error),
	       *value = spec_memory_new(bands + count, sizeof *value, "weights", error);

	if (!weight || !value) {
		free(weight);
		free(value);
		return NULL;
	}
	for (size_t band = 0; band < bands; band++) {
		double *coefficient = value + bands;

		memset(coefficient, 0, count * sizeof *coefficient);
		add_band(represented, wavelength_nm, edges_nm, bands, band, value,
			coefficient);
		for (size_t i = 0; i < count; i++)
			weight[i * bands + band] = coefficient[i];
	}
	free(value);
	return weight;
}

double *
spec_represented_back(const struct spec_represented *represented,
	const double *wavelength_nm, const double *edges_nm, size_t bands,
	struct spec_error *error)
{
	size_t count = represented->coefficients;
	double *weight = spec_memory_new(bands, count * sizeof *weight, "weights", error),
	       *one = spec_memory_new(count, sizeof *one, "weights", error);
	struct spec_series series = {represented->low_nm, represented->high_nm, count, one};

	for (size_t i = 0; weight && one && i < count; i++) {
		one[i] = 1;
		for (size_t band = 0; band < bands; band++)
			weight[band * count + i] =
				edges_nm ? spec_series_mean(&series, edges_nm[band],
						   edges_nm[band + 1])
					 : spec_series_at(&series, wavelength_nm[band]);
		one[i] = 0;
	}
	free(one);
	if (!one) {
		free(weight);
		weight = NULL;
	}
	return weight;
}

/* ---- writing ---- */

struct run {
	struct spec_image image; /* the output's, indexed */
	const struct spec_image *input;
	struct spec_represented represented;
	double *forth;
	size_t *origin;      /* of each channel of the output, or input->channels: ours */
	size_t *coefficient; /* [stokes][coefficients]: channels of the output */
	size_t *line;        /* [stokes][lines][weight, wavelength]: the same */
	size_t *smooth;      /* [stokes][bands]: where the rest stays in bands */
};

static enum spec_status
check(const struct spec_image *input, const struct spec_represented *represented,
	const char *name, struct spec_error *error)
{
	if (input->bands < 2)
		return spec_error_set(
			error, SPEC_EFORMAT, "%s: has fewer than two bands", name);
	if (input->bispectral > 0)
		return spec_error_set(error, SPEC_EUNSUPPORTED,
			"%s: is bispectral; --illuminate it first", name);
	if (represented->coefficients > input->bands ||
		represented->coefficients > SPEC_REPRESENTED_MOST_COEFFICIENTS)
		return spec_error_set(error, SPEC_ERANGE,
			"%s: %zu coefficients are more than its %zu bands, or than %d",
			name, represented->coefficients, input->bands,
			SPEC_REPRESENTED_MOST_COEFFICIENTS);
	if (represented->lines > SPEC_REPRESENTED_MOST_LINES)
		return spec_error_set(error, SPEC_ERANGE, "more than %d lines",
			SPEC_REPRESENTED_MOST_LINES);
	return SPEC_OK;
}

/* Adds the channels of one Stokes component. */
static enum spec_status
add_channels(struct spec_image *image, const struct spec_represented *represented,
	const char *prefix, enum spec_sample sample, struct spec_error *error)
{
	enum spec_status status = SPEC_OK;
	char name[64], other[64];

	for (size_t i = 0; i < represented->coefficients && status == SPEC_OK; i++) {
		spec_represented_name(name, sizeof name, prefix, i);
		status = spec_image_add_channel(image, name, sample, error);
	}
	for (size_t i = 0; i < represented->lines && status == SPEC_OK; i++) {
		spec_represented_line_names(name, other, sizeof name, prefix, i);
		status = spec_image_add_channel(image, name, SPEC_SAMPLE_FLOAT, error);
		if (status == SPEC_OK)
			status = spec_image_add_channel(
				image, other, SPEC_SAMPLE_FLOAT, error);
	}
	return status;
}

static enum spec_status
make_header(struct run *run, const struct spec_settings *settings, const char *name,
	struct spec_error *error)
{
	const struct spec_image *input = run->input;
	struct spec_image *image = &run->image;
	enum spec_sample sample = settings->half ? SPEC_SAMPLE_HALF : SPEC_SAMPLE_FLOAT;
	enum spec_status status = spec_image_copy(image, input, error);

	if (status == SPEC_OK)
		status = spec_image_index(image, name, error);
	if (status == SPEC_OK)
		status = spec_image_rename_bands(image, name, error);
	if (status == SPEC_OK && run->represented.coefficients > 0) {
		spec_image_remove_bands(image);
		status = write_wavelengths(image, input, error);
	}
	for (int stokes = 0; stokes < input->stokes && status == SPEC_OK; stokes++)
		status = add_channels(image, &run->represented,
			spec_represented_prefix(input->role, stokes), sample, error);
	if (status == SPEC_OK)
		status = write_attribute(image, &run->represented, error);
	if (status == SPEC_OK)
		status = spec_image_set_text(image, "spectralLayoutVersion", "1.0", error);
	if (status == SPEC_OK && input->edges_nm)
		status = spec_image_set_bins(image, input->edges_nm, input->bands, error);
	return status == SPEC_OK ? spec_image_index(image, name, error) : status;
}

/* Where the channels of a component lie in the output. */
static void
find_component(struct run *run, int stokes)
{
	const struct spec_represented *represented = &run->represented;
	const char *prefix = spec_represented_prefix(run->input->role, stokes);
	size_t *coefficient = run->coefficient + (size_t)stokes * represented->coefficients,
	       *line = run->line + (size_t)stokes * represented->lines * 2;
	char name[64], other[64];

	for (size_t i = 0; i < represented->coefficients; i++) {
		spec_represented_name(name, sizeof name, prefix, i);
		coefficient[i] = spec_image_find_channel(&run->image, name);
	}
	for (size_t i = 0; i < represented->lines; i++) {
		spec_represented_line_names(name, other, sizeof name, prefix, i);
		line[2 * i] = spec_image_find_channel(&run->image, name);
		line[2 * i + 1] = spec_image_find_channel(&run->image, other);
	}
}

static enum spec_status
plan(struct run *run, const struct spec_settings *settings, const char *name,
	struct spec_error *error)
{
	const struct spec_image *input = run->input;
	const struct spec_represented *represented = &run->represented;
	size_t stokes = (size_t)input->stokes;
	enum spec_status status = make_header(run, settings, name, error);

	if (status != SPEC_OK)
		return status;
	run->coefficient = spec_memory_new(
		stokes * represented->coefficients, sizeof(size_t), "channels", error);
	run->line = spec_memory_new(
		stokes * represented->lines, 2 * sizeof(size_t), "channels", error);
	run->smooth =
		spec_memory_new(stokes * input->bands, sizeof(size_t), "channels", error);
	run->origin =
		spec_memory_new(run->image.channels, sizeof(size_t), "channels", error);
	if (!run->coefficient || !run->line || !run->smooth || !run->origin)
		return SPEC_ENOMEM;
	for (int i = 0; i < input->stokes; i++)
		find_component(run, i);
	/* Bands that stay lie in the output's index, if it has one, in the same order. */
	if (represented->coefficients == 0)
		memcpy(run->smooth, run->image.band_channel,
			stokes * input->bands * sizeof(size_t));
	for (size_t i = 0; i < run->image.channels; i++)
		run->origin[i] = spec_image_find_channel(input, run->image.channel[i].name);
	for (size_t i = 0; i < run->image.channels; i++)
		if (run->image.channel[i].role != SPEC_ROLE_OTHER)
			run->origin[i] = input->channels;
	if (represented->coefficients == 0)
		return SPEC_OK;
	run->forth = spec_represented_forth(
		represented, input->wavelength_nm, input->edges_nm, input->bands, error);
	return run->forth ? SPEC_OK : SPEC_ENOMEM;
}

static void
free_run(struct run *run)
{
	spec_image_clear(&run->image);
	free(run->forth);
	free(run->origin);
	free(run->coefficient);
	free(run->line);
	free(run->smooth);
}

/* One row's lines and rest: the rest goes to smooth, [bands][width]. */
static enum spec_status
split_row(const struct run *run, const float *const *band, int stokes, float *const *plane,
	float *smooth, struct spec_error *error)
{
	const struct spec_image *input = run->input;
	size_t bands = input->bands, lines = run->represented.lines,
	       width = spec_window_width(&input->data);
	const size_t *channel = run->line + (size_t)stokes * lines * 2;
	struct spec_line line[SPEC_REPRESENTED_MOST_LINES];
	double *value = spec_memory_new(2 * bands, sizeof *value, "samples", error);
	enum spec_status status = value ? SPEC_OK : SPEC_ENOMEM;

	for (size_t x = 0; x < width && status == SPEC_OK; x++) {
		struct spec_samples samples = {
			input->wavelength_nm, value, bands, SPEC_INTERPOLATE_LINEAR};
		size_t found = lines;

		for (size_t i = 0; i < bands; i++)
			value[i] = band[i][x];
		status = spec_samples_lines(&samples, line, &found, value + bands, error);
		for (size_t i = 0; i < bands && status == SPEC_OK; i++)
			smooth[i * width + x] = (float)value[bands + i];
		for (size_t i = 0; i < lines && status == SPEC_OK; i++) {
			plane[channel[2 * i]][x] = i < found ? (float)line[i].weight : 0;
			plane[channel[2 * i + 1]][x] =
				i < found ? (float)line[i].wavelength_nm : 0;
		}
	}
	free(value);
	return status;
}

/* What a worker has for one component: pointers to bands, to coefficients, and the rest. */
struct scratch {
	const float **band;
	float **coefficient;
	float *smooth;
};

static size_t
scratch_bytes(const struct run *run)
{
	size_t bands = run->input->bands, width = spec_window_width(&run->input->data);

	return (bands + run->represented.coefficients) * sizeof(void *) +
	       (run->represented.lines > 0 ? bands * width * sizeof(float) : 0);
}

static void
divide_scratch(const struct run *run, void *bytes, struct scratch *scratch)
{
	scratch->band = bytes;
	scratch->coefficient = (float **)(scratch->band + run->input->bands);
	scratch->smooth =
		(float *)(void *)(scratch->coefficient + run->represented.coefficients);
}

static enum spec_status
convert_component(const struct run *run, struct spec_stream_worker *worker, int y,
	int stokes, float *const *plane, struct spec_error *error)
{
	const struct spec_image *input = run->input;
	size_t bands = input->bands, count = run->represented.coefficients,
	       width = spec_window_width(&input->data);
	const size_t *channel = input->band_channel + (size_t)stokes * bands;
	struct scratch scratch;
	enum spec_status status = SPEC_OK;

	divide_scratch(run, worker->scratch, &scratch);
	for (size_t i = 0; i < bands; i++)
		scratch.band[i] = spec_decoder_row(worker->decoder[0], y, channel[i]);
	if (run->represented.lines > 0) {
		status = split_row(run, scratch.band, stokes, plane, scratch.smooth, error);
		for (size_t i = 0; i < bands; i++)
			scratch.band[i] = scratch.smooth + i * width;
	}
	for (size_t i = 0; i < count; i++)
		scratch.coefficient[i] =
			plane[run->coefficient[(size_t)stokes * count + i]];
	if (count > 0)
		spec_mix_rows(
			scratch.band, bands, run->forth, scratch.coefficient, count, width);
	for (size_t i = 0; i < bands && count == 0 && status == SPEC_OK; i++)
		memcpy(plane[run->smooth[(size_t)stokes * bands + i]], scratch.band[i],
			width * sizeof(float));
	return status;
}

static enum spec_status
kernel(void *state, struct spec_stream_worker *worker, int line, struct spec_error *error)
{
	const struct run *run = state;
	int y = run->input->data.y0 + line;
	float *const *plane;
	enum spec_status status = spec_packer_begin(worker->packer, y, &plane, error);

	for (int i = 0; i < run->input->stokes && status == SPEC_OK; i++)
		status = convert_component(run, worker, y, i, plane, error);
	for (size_t i = 0; i < run->image.channels && status == SPEC_OK; i++)
		if (run->origin[i] < run->input->channels)
			memcpy(plane[i],
				spec_decoder_row(worker->decoder[0], y, run->origin[i]),
				spec_window_width(&run->input->data) * sizeof(float));
	return status == SPEC_OK ? spec_packer_end(worker->packer, y, error) : status;
}

enum spec_status
spec_represented_run(struct spec_reader *reader,
	const struct spec_representation *representation,
	const struct spec_settings *settings, unsigned long long *overflows,
	struct spec_error *error)
{
	const struct spec_image *input = spec_reader_image(reader);
	int composite = representation->kind == SPEC_SPECTRUM_COMPOSITE;
	struct run run = {.input = input,
		.represented = {.coefficients = composite ? representation->coefficients
							  : representation->count,
			.lines = composite ? representation->count : 0}};
	struct spec_stream stream = {.reader = {reader},
		.readers = 1,
		.lines = (int)spec_window_height(&input->data),
		.first_line = input->data.y0,
		.lines_in = 1,
		.state = &run,
		.kernel = kernel};
	enum spec_status status =
		check(input, &run.represented, spec_reader_name(reader), error);

	if (status == SPEC_OK) {
		run.represented.low_nm =
			input->edges_nm ? input->edges_nm[0] : input->wavelength_nm[0];
		run.represented.high_nm = input->edges_nm
						  ? input->edges_nm[input->bands]
						  : input->wavelength_nm[input->bands - 1];
		status = plan(&run, settings, spec_reader_name(reader), error);
	}
	if (status == SPEC_OK)
		status = spec_settings_record(settings, &run.image, error);
	stream.scratch_bytes = status == SPEC_OK ? scratch_bytes(&run) : 0;
	if (status == SPEC_OK)
		status = spec_image_save(&run.image, &stream, settings, overflows, error);
	free_run(&run);
	return status;
}
