#include "image/regions.h"

#include <errno.h>
#include <math.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "base/memory.h"
#include "base/number.h"
#include "image/stream.h"

#define MOST_PIXELS (1 << 30) /* of a side: as far as the windows of files may reach */
#define FIELDS 5
#define BLANKS " \t\r\n"

static int
is_layout(const char *text)
{
	size_t digits = strspn(text, "0123456789"), more;

	if (digits == 0 || text[digits] != 'x')
		return 0;
	more = strspn(text + digits + 1, "0123456789");
	return more > 0 && text[digits + 1 + more] == '\0';
}

static enum spec_status
add_region(struct spec_regions *regions, const struct spec_probe *region, const char *name,
	struct spec_error *error)
{
	void *list = regions->probe;
	enum spec_status status = spec_memory_grow(&list, &regions->room,
		regions->probes + 1, sizeof *region, "rectangles", error);
	char *copy;

	regions->probe = list;
	if (status != SPEC_OK)
		return status;
	copy = spec_memory_text(name, strlen(name), error);
	if (!copy)
		return SPEC_ENOMEM;
	regions->probe[regions->probes] = *region;
	regions->probe[regions->probes++].name = copy;
	return SPEC_OK;
}

/* Splits a line; returns how many fields it has, of which FIELDS are kept. */
static size_t
split(char *line, char *field[FIELDS])
{
	size_t fields = 0;
	char *rest;

	for (char *word = strtok_r(line, BLANKS, &rest); word;
		word = strtok_r(NULL, BLANKS, &rest), fields++) {
		if (fields < FIELDS)
			field[fields] = word;
	}
	return fields;
}

static enum spec_status
take_line(struct spec_regions *regions, char *line, struct spec_error *error)
{
	static const char *const what[] = {"x0", "y0", "x1", "y1"};
	char *field[FIELDS];
	long long at[FIELDS - 1];
	size_t fields = split(line, field);
	struct spec_probe region = {0};
	enum spec_status status = SPEC_OK;

	if (fields == 0 || field[0][0] == '#')
		return SPEC_OK;
	if (fields != FIELDS)
		return spec_error_set(error, SPEC_EFORMAT, "is not NAME X0 Y0 X1 Y1");
	for (size_t i = 0; i < FIELDS - 1 && status == SPEC_OK; i++)
		status = spec_number_parse_whole(
			field[i + 1], 0, MOST_PIXELS, what[i], &at[i], error);
	if (status != SPEC_OK)
		return status;
	if (at[2] <= at[0] || at[3] <= at[1])
		return spec_error_set(
			error, SPEC_EFORMAT, "'%s' has no pixel inside", field[0]);
	if (regions->probes == SPEC_REGIONS_MOST)
		return spec_error_set(error, SPEC_ERANGE,
			"is one rectangle more than the %d that there may be",
			SPEC_REGIONS_MOST);
	region.x = (size_t)at[0];
	region.width = (size_t)(at[2] - at[0]);
	region.y = (int)at[1];
	region.height = (int)(at[3] - at[1]);
	return add_region(regions, &region, field[0], error);
}

static int
compare_names(const void *a, const void *b)
{
	const char *const *one = a, *const *two = b;

	return strcmp(*one, *two);
}

static enum spec_status
check_names(const struct spec_regions *regions, struct spec_error *error)
{
	const char **name =
		spec_memory_new(regions->probes, sizeof *name, "rectangles", error);
	enum spec_status status = SPEC_OK;

	if (!name)
		return SPEC_ENOMEM;
	for (size_t i = 0; i < regions->probes; i++)
		name[i] = regions->probe[i].name;
	qsort(name, regions->probes, sizeof *name, compare_names);
	for (size_t i = 1; i < regions->probes && status == SPEC_OK; i++) {
		if (strcmp(name[i - 1], name[i]) == 0)
			status = spec_error_set(error, SPEC_EFORMAT,
				"two rectangles are called '%s'", name[i]);
	}
	free(name);
	return status;
}

static enum spec_status
read_lines(struct spec_regions *regions, FILE *file, struct spec_error *error)
{
	char *line = NULL;
	size_t room = 0, number = 0;
	ssize_t length;
	enum spec_status status = SPEC_OK;

	while (status == SPEC_OK && (length = getline(&line, &room, file)) >= 0) {
		number++;
		if (strlen(line) != (size_t)length)
			status = spec_error_set(error, SPEC_EFORMAT, "is no text");
		else
			status = take_line(regions, line, error);
		if (status != SPEC_OK)
			status = (spec_error_prefix(error, "line %zu", number), status);
	}
	free(line);
	if (status == SPEC_OK && ferror(file))
		return spec_error_set(error, SPEC_EIO, "%s", strerror(errno));
	if (status == SPEC_OK && regions->probes == 0)
		return spec_error_set(error, SPEC_EFORMAT, "has no rectangle");
	return status == SPEC_OK ? check_names(regions, error) : status;
}

enum spec_status
spec_regions_parse(const char *text, struct spec_regions *regions, struct spec_error *error)
{
	enum spec_status status;
	FILE *file;

	*regions = (struct spec_regions){0};
	if (is_layout(text)) {
		status = spec_number_parse_size(text, SPEC_REGIONS_MOST, "the chart",
			&regions->columns, &regions->rows, error);
		if (status == SPEC_OK &&
			(long long)regions->columns * regions->rows > SPEC_REGIONS_MOST)
			status = spec_error_set(error, SPEC_ERANGE,
				"a chart of %s has more than %d patches", text,
				SPEC_REGIONS_MOST);
		return status;
	}
	file = fopen(text, "rbe");
	if (!file)
		return spec_error_set(error, SPEC_EIO, "%s: %s", text, strerror(errno));
	status = read_lines(regions, file, error);
	fclose(file);
	if (status != SPEC_OK) {
		spec_regions_free(regions);
		spec_error_prefix(error, "%s", text);
	}
	return status;
}

void
spec_regions_free(struct spec_regions *regions)
{
	spec_probe_free(regions->probe, regions->probes);
	free(regions->probe);
	*regions = (struct spec_regions){0};
}

/* The middle half of the part i of parts that fill a side. */
static void
middle_half(size_t side, int parts, int i, size_t *from, size_t *size)
{
	size_t quarters = 4 * (size_t)parts, first = 4 * (size_t)i + 1;
	size_t to = side * (first + 2) / quarters;

	*from = side * first / quarters;
	*size = to > *from ? to - *from : 1;
}

/* The rectangles of a chart in an image of this size. */
static enum spec_status
place_chart(
	struct spec_regions *regions, size_t width, size_t height, struct spec_error *error)
{
	spec_probe_free(regions->probe, regions->probes);
	regions->probes = 0;
	if ((size_t)regions->columns > width || (size_t)regions->rows > height)
		return spec_error_set(error, SPEC_ERANGE,
			"a chart of %dx%d patches does not fit %zu x %zu pixels",
			regions->columns, regions->rows, width, height);
	for (int i = 0; i < regions->columns * regions->rows; i++) {
		struct spec_probe region = {0};
		size_t y, lines;
		char name[16];
		enum spec_status status;

		middle_half(width, regions->columns, i % regions->columns, &region.x,
			&region.width);
		middle_half(height, regions->rows, i / regions->columns, &y, &lines);
		region.y = (int)y;
		region.height = (int)lines;
		snprintf(name, sizeof name, "%d", i + 1);
		status = add_region(regions, &region, name, error);
		if (status != SPEC_OK)
			return status;
	}
	return SPEC_OK;
}

/* One pass over the image. */
struct run {
	const struct spec_image *image;
	struct spec_probe *probe;
	size_t probes;
	size_t most; /* rectangles that one line crosses */
	int first;   /* the line of the data window that is the stream's line 0 */
};

static int
crosses(const struct spec_probe *probe, int y)
{
	return y >= probe->y && y - probe->y < probe->height;
}

static double
sum_row(const struct spec_channel *channel, const float *row,
	const struct spec_probe *probe)
{
	double sum = 0;
	uint32_t number;

	if (channel->sample == SPEC_SAMPLE_UINT && channel->role == SPEC_ROLE_OTHER) {
		memcpy(&number, row + probe->x, sizeof number);
		return probe->width == 1 && probe->height == 1 ? number : NAN;
	}
	for (size_t x = probe->x; x < probe->x + probe->width; x++)
		sum += row[x];
	return sum;
}

/* The line's payload: sums by channels of each rectangle that it crosses, in their order. */
static enum spec_status
sum_line(void *state, struct spec_stream_worker *worker, int line, struct spec_error *error)
{
	const struct run *run = state;
	const struct spec_image *image = run->image;
	double *sum = (double *)(void *)worker->payload;
	int y = run->first + line;

	(void)error;
	for (size_t i = 0; i < run->probes; i++) {
		if (!crosses(&run->probe[i], y))
			continue;
		for (size_t c = 0; c < image->channels; c++)
			*sum++ = sum_row(&image->channel[c],
				spec_decoder_row(worker->decoder[0], image->data.y0 + y, c),
				&run->probe[i]);
	}
	return SPEC_OK;
}

static enum spec_status
add_lines(void *state, const unsigned char *payload, int line, int count,
	struct spec_error *error)
{
	const struct run *run = state;
	const size_t channels = run->image->channels;

	(void)error;
	for (int j = 0; j < count; j++) {
		const double *sum = (const double *)(const void *)payload +
				    (size_t)j * run->most * channels;

		for (size_t i = 0; i < run->probes; i++) {
			if (!crosses(&run->probe[i], run->first + line + j))
				continue;
			for (size_t c = 0; c < channels; c++)
				run->probe[i].value[c] += *sum++;
		}
	}
	return SPEC_OK;
}

/* Room for the sums, and the lines that the rectangles need: first to *end - 1. */
static enum spec_status
prepare(struct run *run, const struct spec_reader *reader, int *end,
	struct spec_error *error)
{
	size_t width = spec_window_width(&run->image->data);
	size_t height = spec_window_height(&run->image->data), crossed;

	run->first = MOST_PIXELS;
	*end = 0;
	for (size_t i = 0; i < run->probes; i++) {
		struct spec_probe *probe = &run->probe[i];

		if (probe->x + probe->width > width ||
			(size_t)probe->y + (size_t)probe->height > height)
			return spec_error_set(error, SPEC_ERANGE,
				"%s: '%s' reaches outside of its %zu x %zu",
				spec_reader_name(reader), probe->name, width, height);
		free(probe->value);
		probe->value = spec_memory_new(
			run->image->channels, sizeof(double), "channels", error);
		if (!probe->value)
			return SPEC_ENOMEM;
		run->first = probe->y < run->first ? probe->y : run->first;
		*end = probe->y + probe->height > *end ? probe->y + probe->height : *end;
	}
	/* The most are crossed where one of them begins. */
	for (size_t i = 0; i < run->probes; i++) {
		crossed = 0;
		for (size_t j = 0; j < run->probes; j++)
			crossed += (size_t)crosses(&run->probe[j], run->probe[i].y);
		run->most = crossed > run->most ? crossed : run->most;
	}
	return SPEC_OK;
}

static enum spec_status
read_means(struct run *run, struct spec_reader *reader,
	const struct spec_settings *settings, struct spec_error *error)
{
	struct spec_stream stream = {.reader = {reader},
		.readers = 1,
		.lines_in = 1,
		.state = run,
		.kernel = sum_line,
		.deliver = add_lines};
	int end;
	enum spec_status status = prepare(run, reader, &end, error);

	if (status != SPEC_OK)
		return status;
	stream.first_line = run->image->data.y0 + run->first;
	stream.lines = end - run->first;
	stream.payload_bytes = run->most * run->image->channels * sizeof(double);
	status = spec_stream_run(&stream, settings, error);
	for (size_t i = 0; i < run->probes; i++) {
		struct spec_probe *probe = &run->probe[i];

		for (size_t c = 0; c < run->image->channels; c++)
			probe->value[c] /= (double)probe->width * probe->height;
	}
	return status;
}

enum spec_status
spec_regions_read(struct spec_regions *regions, struct spec_reader *reader,
	const struct spec_settings *settings, struct spec_error *error)
{
	const struct spec_image *image = spec_reader_image(reader);
	struct run run = {.image = image};
	enum spec_status status = SPEC_OK;

	if (regions->columns > 0)
		status = place_chart(regions, spec_window_width(&image->data),
			spec_window_height(&image->data), error);
	if (status == SPEC_ERANGE)
		spec_error_prefix(error, "%s", spec_reader_name(reader));
	run.probe = regions->probe;
	run.probes = regions->probes;
	if (status == SPEC_OK)
		status = read_means(&run, reader, settings, error);
	return status == SPEC_OK ? spec_reader_drain(reader, error) : status;
}
