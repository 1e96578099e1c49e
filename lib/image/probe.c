#include "image/probe.h"

#include <math.h>
#include <stdint.h>
#include <stdlib.h>
#include <string.h>

#include "base/memory.h"
#include "base/number.h"
#include "base/text.h"
#include "image/rgb.h"
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
		*probe = (struct spec_probe){
			.x = (size_t)x, .width = 1, .y = (int)y, .height = 1};
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
		status = spec_decoder_read(decoder, y, error);
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
	for (size_t i = 0; i < probes; i++) {
		free(probe[i].name);
		free(probe[i].value);
	}
}

/* XYZ by one observer: the sums that are spec2rgb's, to a space whose RGB are XYZ. */
static enum spec_status
plan_observer(struct spec_rgb *plan, const struct spec_image *image,
	const struct spec_curve *observer, const struct spec_viewing *viewing,
	struct spec_error *error)
{
	static const struct spec_space xyz = {.name = "xyz",
		.title = "XYZ",
		.red_xy = {1, 0},
		.green_xy = {0, 1},
		.blue_xy = {0, 0},
		.white_xy = {1. / 3, 1. / 3}};
	struct spec_rgb_setup setup = {.observer = observer,
		.illuminant = &viewing->illuminant,
		.adaptation = SPEC_ADAPTATION_NONE,
		.space = &xyz,
		.rule = viewing->rule};

	return spec_rgb_plan(plan, image, &setup, error);
}

static void
sum_terms(const struct spec_rgb *plan, const double *value, double xyz[3])
{
	for (size_t c = 0; c < 3; c++) {
		xyz[c] = 0;
		for (size_t i = 0; i < plan->terms; i++)
			xyz[c] +=
				plan->weight[c * plan->terms + i] * value[plan->channel[i]];
	}
}

/* What the image's samples are, or SPEC_ENOMEM. */
static enum spec_status
find_seen(const struct spec_image *image, enum spec_seen *seen, struct spec_error *error)
{
	char *quantity = spec_image_quantity(image, error);

	if (!quantity)
		return SPEC_ENOMEM;
	*seen = SPEC_SEEN_REFLECTED;
	if (image->role == SPEC_ROLE_EMISSIVE)
		*seen = spec_seen_of(quantity, "") == SPEC_SEEN_RADIANCE
				? SPEC_SEEN_RADIANCE
				: SPEC_SEEN_LIGHT;
	free(quantity);
	return SPEC_OK;
}

static enum spec_status
see_all(struct spec_probe *probe, size_t probes, const struct spec_rgb *observed,
	const struct spec_rgb *standard, const struct spec_viewing *viewing,
	enum spec_seen seen, struct spec_error *error)
{
	for (size_t i = 0; i < probes; i++) {
		double xyz[3], standard_xyz[3];
		enum spec_status status;

		sum_terms(observed, probe[i].value, xyz);
		sum_terms(standard, probe[i].value, standard_xyz);
		status = spec_appearance_find(viewing, seen, xyz, standard_xyz,
			observed->white, &probe[i].seen, error);
		if (status != SPEC_OK)
			return status;
		probe[i].seen.outside = observed->outside;
	}
	return SPEC_OK;
}

enum spec_status
spec_probe_see(struct spec_probe *probe, size_t probes, const struct spec_reader *reader,
	const struct spec_viewing *viewing, struct spec_error *error)
{
	const struct spec_image *image = spec_reader_image(reader);
	struct spec_rgb observed = {0}, standard = {0};
	struct spec_error why = {0};
	enum spec_seen seen;
	enum spec_status status;

	for (size_t i = 0; i < probes; i++)
		spec_appearance_clear(&probe[i].seen);
	if (image->bands == 0)
		return SPEC_OK;
	status = find_seen(image, &seen, error);
	if (status == SPEC_OK) {
		status = plan_observer(&observed, image, &viewing->observer, viewing, &why);
		if (status == SPEC_OK)
			status = plan_observer(
				&standard, image, &viewing->standard, viewing, &why);
		if (status == SPEC_OK)
			status = see_all(
				probe, probes, &observed, &standard, viewing, seen, &why);
		/* Bands that nobody sees have no appearance, and that is no fault. */
		if (status != SPEC_ENOMEM &&
			(viewing->rule == SPEC_RULE_CIE || status == SPEC_ERANGE))
			status = SPEC_OK;
		else if (status != SPEC_OK && error) {
			*error = why;
			if (status != SPEC_ENOMEM)
				spec_error_prefix(error, "%s", spec_reader_name(reader));
		}
	}
	spec_rgb_free(&observed);
	spec_rgb_free(&standard);
	return status;
}

/* With the fewest digits that read back as the same sample. */
static void
print_sample(FILE *stream, const struct spec_channel *channel, double value)
{
	char text[32];
	int digits = 6;

	if (channel->sample == SPEC_SAMPLE_UINT && value == floor(value)) {
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
print_name(FILE *stream, const struct spec_probe *probe)
{
	if (probe->name)
		spec_value_print_text(stream, probe->name, strlen(probe->name));
	else
		fprintf(stream, "x%zuy%d", probe->x, probe->y);
}

/* The lines begin with the name, as those of other things do with theirs. */
static enum spec_status
print_seen(FILE *stream, const struct spec_probe *probe, size_t probes,
	struct spec_error *error)
{
	for (size_t j = 0; j < probes; j++) {
		struct spec_text lead = {0};
		enum spec_status status = spec_text_open(&lead, error);

		if (status == SPEC_OK) {
			fputs("# ", lead.stream);
			print_name(lead.stream, &probe[j]);
			fputc(' ', lead.stream);
			fputc('\0', lead.stream);
			status = spec_text_close(&lead, error);
		}
		if (status == SPEC_OK)
			spec_appearance_print(stream, lead.bytes, &probe[j].seen);
		spec_text_free(&lead);
		if (status != SPEC_OK)
			return status;
	}
	return SPEC_OK;
}

static void
print_columns(FILE *stream, const struct spec_image *image, const struct spec_probe *probe,
	size_t probes)
{
	fputs("# columns: wavelength_nm", stream);
	for (size_t j = 0; j < probes; j++) {
		for (int k = 0; k < image->stokes; k++) {
			fputc(' ', stream);
			print_name(stream, &probe[j]);
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
	enum spec_status status;

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
	status = print_seen(stream, probe, probes, error);
	if (status != SPEC_OK)
		return status;
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
put_place(struct spec_json *json, const struct spec_probe *probe)
{
	if (!probe->name) {
		spec_json_whole(json, "x", (long long)probe->x);
		spec_json_whole(json, "y", probe->y);
		return;
	}
	spec_json_text(json, "name", probe->name);
	spec_json_whole(json, "x0", (long long)probe->x);
	spec_json_whole(json, "y0", probe->y);
	spec_json_whole(json, "x1", (long long)probe->x + (long long)probe->width);
	spec_json_whole(json, "y1", (long long)probe->y + probe->height);
}

static void
put_pixel(struct spec_json *json, const struct spec_image *image,
	const struct spec_probe *probe)
{
	static const char *const components[] = {"S0", "S1", "S2", "S3"};

	spec_json_open(json, NULL, '{', SPEC_JSON_LINES);
	put_place(json, probe);
	spec_appearance_json(json, &probe->seen);
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
	spec_json_open(json, probes > 0 && probe->name ? "patches" : "pixels", '[',
		SPEC_JSON_LINES);
	for (size_t i = 0; i < probes; i++)
		put_pixel(json, image, &probe[i]);
	spec_json_close(json);
	spec_json_close(json);
	free(quantity);
	return SPEC_OK;
}
