#include "image/probe.h"

#include <math.h>
#include <stdint.h>
#include <stdlib.h>
#include <string.h>

#include "base/memory.h"
#include "base/number.h"
#include "image/value.h"

#define MOST_PIXELS (1 << 30) /* of a side: as far as the windows of files may reach */

enum spec_status
spec_probe_parse(const char *text, struct spec_probe *probe, struct spec_error *error)
{
	const char *comma = strchr(text, ',');
	long long x, y;
	enum spec_status status;
	char *first;

	if (!comma)
		return spec_error_set(
			error, SPEC_EUSAGE, "the pixel '%s' is not X,Y", text);
	first = spec_memory_text(text, (size_t)(comma - text), error);
	if (!first)
		return SPEC_ENOMEM;
	status = spec_number_parse_whole(first, 0, MOST_PIXELS, "the pixel's X", &x, error);
	free(first);
	if (status == SPEC_OK)
		status = spec_number_parse_whole(
			comma + 1, 0, MOST_PIXELS, "the pixel's Y", &y, error);
	if (status == SPEC_OK)
		*probe = (struct spec_probe){.x = (size_t)x, .y = (int)y};
	return status;
}

/* Where a probe's line is. */
struct line {
	int y;
	size_t probe;
};

static int
compare_lines(const void *a, const void *b)
{
	const struct line *one = a, *two = b;

	return (one->y > two->y) - (one->y < two->y);
}

/* The probes' lines in order, for a pipe is read forward; and room for the values. */
static enum spec_status
sort_probes(struct spec_probe *probe, size_t probes, const struct spec_reader *reader,
	struct line *line, struct spec_error *error)
{
	const struct spec_image *image = spec_reader_image(reader);
	size_t width = spec_window_width(&image->data);
	size_t height = spec_window_height(&image->data);

	for (size_t i = 0; i < probes; i++) {
		line[i] = (struct line){probe[i].y, i};
		if (probe[i].x >= width || (size_t)probe[i].y >= height)
			return spec_error_set(error, SPEC_ERANGE,
				"%s: the pixel %zu,%d is outside of its %zu x %zu",
				spec_reader_name(reader), probe[i].x, probe[i].y, width,
				height);
		free(probe[i].value);
		probe[i].value =
			spec_memory_new(image->channels, sizeof(double), "channels", error);
		if (!probe[i].value)
			return SPEC_ENOMEM;
	}
	qsort(line, probes, sizeof *line, compare_lines);
	return SPEC_OK;
}

static double
sample_of(const struct spec_channel *channel, const float *sample)
{
	uint32_t number;

	if (channel->sample != SPEC_SAMPLE_UINT || channel->role != SPEC_ROLE_OTHER)
		return *sample;
	memcpy(&number, sample, sizeof number);
	return number;
}

/* The pixel's line becomes the decoder's, unless it is that already. */
static enum spec_status
read_pixel(const struct spec_image *image, struct spec_decoder *decoder, int fetched,
	const struct spec_probe *probe, struct spec_error *error)
{
	int y = image->data.y0 + probe->y;
	enum spec_status status = SPEC_OK;

	if (!fetched)
		status = spec_decoder_fetch(decoder, y, y + 1, error);
	if (!fetched && status == SPEC_OK)
		status = spec_decoder_decode(decoder, error);
	for (size_t i = 0; i < image->channels && status == SPEC_OK; i++)
		probe->value[i] = sample_of(
			&image->channel[i], spec_decoder_row(decoder, y, i) + probe->x);
	return status;
}

enum spec_status
spec_probe_read(struct spec_probe *probe, size_t probes, struct spec_reader *reader,
	struct spec_error *error)
{
	const struct spec_image *image = spec_reader_image(reader);
	struct spec_decoder *decoder = NULL;
	struct line *line = spec_memory_new(probes, sizeof *line, "pixels", error);
	enum spec_status status = SPEC_ENOMEM;

	if (line)
		status = sort_probes(probe, probes, reader, line, error);
	if (status == SPEC_OK)
		status = spec_decoder_open(&decoder, reader, NULL, error);
	for (size_t i = 0; i < probes && status == SPEC_OK; i++)
		status = read_pixel(image, decoder, i > 0 && line[i].y == line[i - 1].y,
			&probe[line[i].probe], error);
	spec_decoder_close(decoder);
	free(line);
	return status == SPEC_OK ? spec_reader_drain(reader, error) : status;
}

void
spec_probe_free(struct spec_probe *probe, size_t probes)
{
	for (size_t i = 0; i < probes; i++)
		free(probe[i].value);
}

/* With the fewest digits that read back as the same sample. */
static void
print_sample(FILE *stream, const struct spec_channel *channel, double value)
{
	char text[32];
	int digits = 6;

	if (channel->sample == SPEC_SAMPLE_UINT) {
		fprintf(stream, " %.0f", value);
		return;
	}
	do
		snprintf(text, sizeof text, "%.*g", digits, value);
	while (isfinite(value) && strtof(text, NULL) != (float)value && digits++ < 9);
	fprintf(stream, " %s", text);
}

static void
print_foreign(FILE *stream, const struct spec_image *image, const struct spec_probe *probe,
	size_t probes)
{
	for (size_t i = 0; i < image->channels; i++) {
		const struct spec_channel *channel = &image->channel[i];

		if (channel->role != SPEC_ROLE_OTHER &&
			channel->role != SPEC_ROLE_BISPECTRAL)
			continue;
		fputs("# channel ", stream);
		spec_value_print_text(stream, channel->name, strlen(channel->name));
		fputc(':', stream);
		for (size_t j = 0; j < probes; j++)
			print_sample(stream, channel, probe[j].value[i]);
		fputc('\n', stream);
	}
}

static void
print_columns(FILE *stream, const struct spec_image *image, const struct spec_probe *probe,
	size_t probes)
{
	fputs("# columns: wavelength_nm", stream);
	for (size_t j = 0; j < probes; j++) {
		for (int k = 0; k < image->stokes; k++) {
			fprintf(stream, " x%zuy%d", probe[j].x, probe[j].y);
			if (image->stokes > 1)
				fprintf(stream, "S%d", k);
		}
	}
	fputc('\n', stream);
}

static void
print_bands(FILE *stream, const struct spec_image *image, const struct spec_probe *probe,
	size_t probes)
{
	for (size_t i = 0; i < image->bands; i++) {
		fprintf(stream, "%.10g", image->wavelength_nm[i]);
		for (size_t j = 0; j < probes; j++) {
			for (int k = 0; k < image->stokes; k++) {
				size_t channel =
					image->band_channel[(size_t)k * image->bands + i];

				print_sample(stream, &image->channel[channel],
					probe[j].value[channel]);
			}
		}
		fputc('\n', stream);
	}
}

enum spec_status
spec_probe_print(FILE *stream, const struct spec_reader *reader,
	const struct spec_probe *probe, size_t probes, struct spec_error *error)
{
	const struct spec_image *image = spec_reader_image(reader);
	const char *name = spec_reader_name(reader);
	char *quantity = spec_image_quantity(image, error);

	if (!quantity)
		return SPEC_ENOMEM;
	fputs("# title: ", stream);
	spec_value_print_text(stream, name, strlen(name));
	if (*quantity) {
		fputs("\n# quantity: ", stream);
		spec_value_print_text(stream, quantity, strlen(quantity));
	}
	fputc('\n', stream);
	free(quantity);
	print_foreign(stream, image, probe, probes);
	if (image->bands > 0)
		print_columns(stream, image, probe, probes);
	print_bands(stream, image, probe, probes);
	return SPEC_OK;
}

static void
put_sample(struct spec_json *json, const char *key, const struct spec_channel *channel,
	double value)
{
	if (channel->sample == SPEC_SAMPLE_UINT)
		spec_json_number(json, key, value);
	else
		spec_json_float(json, key, (float)value);
}

static void
put_pixel(struct spec_json *json, const struct spec_image *image,
	const struct spec_probe *probe)
{
	static const char *const components[] = {"S0", "S1", "S2", "S3"};

	spec_json_open(json, NULL, '{', SPEC_JSON_LINES);
	spec_json_whole(json, "x", (long long)probe->x);
	spec_json_whole(json, "y", probe->y);
	for (int k = 0; k < image->stokes && image->bands > 0; k++) {
		spec_json_open(json,
			image->role == SPEC_ROLE_EMISSIVE ? components[k] : "T", '[',
			SPEC_JSON_INLINE);
		for (size_t i = 0; i < image->bands; i++) {
			size_t channel = image->band_channel[(size_t)k * image->bands + i];

			put_sample(json, NULL, &image->channel[channel],
				probe->value[channel]);
		}
		spec_json_close(json);
	}
	spec_json_open(json, "channels", '{', SPEC_JSON_INLINE);
	for (size_t i = 0; i < image->channels; i++) {
		const struct spec_channel *channel = &image->channel[i];

		if (channel->role == SPEC_ROLE_OTHER ||
			channel->role == SPEC_ROLE_BISPECTRAL)
			put_sample(json, channel->name, channel, probe->value[i]);
	}
	spec_json_close(json);
	spec_json_close(json);
}

enum spec_status
spec_probe_json(struct spec_json *json, const struct spec_reader *reader,
	const struct spec_probe *probe, size_t probes, struct spec_error *error)
{
	const struct spec_image *image = spec_reader_image(reader);
	char *quantity = spec_image_quantity(image, error);

	if (!quantity)
		return SPEC_ENOMEM;
	spec_json_open(json, NULL, '{', SPEC_JSON_LINES);
	spec_json_text(json, "file", spec_reader_name(reader));
	spec_json_text(json, "quantity", image->bands > 0 ? quantity : NULL);
	spec_json_numbers(json, "wavelength_nm", image->wavelength_nm, image->bands);
	spec_json_open(json, "pixels", '[', SPEC_JSON_LINES);
	for (size_t i = 0; i < probes; i++)
		put_pixel(json, image, &probe[i]);
	spec_json_close(json);
	spec_json_close(json);
	free(quantity);
	return SPEC_OK;
}
