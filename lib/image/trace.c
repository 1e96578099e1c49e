#include "image/trace.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "base/memory.h"
#include "base/number.h"
#include "colour/space.h"

#define BESIDE 0.15 /* of the range of a component: from the line of blends */
#define LEAST 0.1   /* share of ink that belongs to a run */
#define CERTAIN 0.5 /* share that a run has somewhere */
#define MOST_PIXEL 1e6
#define MARGIN 4 /* rows above and below, for a broad line at the axis' end */

/* What is found in a column, going down. */
struct column {
	double ink, moment; /* of the run: sums of shares, and of shares times y */
	double most;        /* share of one of its pixels */
	int open;           /* the pixel above belonged to it */
	int found;          /* a run that is certain has ended, or goes on */
	double y;
};

struct trace {
	const struct spec_trace_axes *axes;
	const char *file;
	double paper[3], way[3], square; /* from paper to ink, and its length squared */
	int x0, x1, y0, y1;              /* half-open, in the data window */
	struct column *column;
};

static enum spec_status
parse_number(const char **at, char end, double *number, struct spec_error *error)
{
	char text[64];
	size_t length = strcspn(*at, ",= ");

	if (length >= sizeof text || (*at)[length] != end)
		return spec_error_set(error, SPEC_EUSAGE,
			"the axes are not X,Y=WAVELENGTH,VALUE X,Y=WAVELENGTH,VALUE");
	memcpy(text, *at, length);
	text[length] = '\0';
	*at += length + (end != '\0');
	return spec_number_parse(
		text, -1e300, 1e300, "a number of the axes", number, error);
}

static enum spec_status
parse_wavelength(const char **at, double *wavelength_nm, struct spec_error *error)
{
	char text[64];
	size_t length = strcspn(*at, ",= ");

	if (length >= sizeof text || (*at)[length] != ',')
		return spec_error_set(error, SPEC_EUSAGE,
			"the axes are not X,Y=WAVELENGTH,VALUE X,Y=WAVELENGTH,VALUE");
	memcpy(text, *at, length);
	text[length] = '\0';
	*at += length + 1;
	return spec_number_parse_length(
		text, "a wavelength of the axes", wavelength_nm, error);
}

enum spec_status
spec_trace_parse(const char *text, struct spec_trace_axes *axes, struct spec_error *error)
{
	const char *at = text + strspn(text, " ");
	enum spec_status status = SPEC_OK;

	for (int i = 0; i < 2 && status == SPEC_OK; i++) {
		status = parse_number(&at, ',', &axes->x[i], error);
		if (status == SPEC_OK)
			status = parse_number(&at, '=', &axes->y[i], error);
		if (status == SPEC_OK)
			status = parse_wavelength(&at, &axes->wavelength_nm[i], error);
		if (status == SPEC_OK)
			status = parse_number(
				&at, i == 0 ? ' ' : '\0', &axes->value[i], error);
		at += strspn(at, " ");
	}
	for (int i = 0; i < 2 && status == SPEC_OK; i++)
		if (!(axes->x[i] >= 0 && axes->x[i] < MOST_PIXEL && axes->y[i] >= 0 &&
			    axes->y[i] < MOST_PIXEL))
			status = spec_error_set(error, SPEC_ERANGE,
				"a place of the axes is outside every picture: %g,%g",
				axes->x[i], axes->y[i]);
	if (status == SPEC_OK && (axes->x[0] == axes->x[1] || axes->y[0] == axes->y[1] ||
					 axes->wavelength_nm[0] == axes->wavelength_nm[1] ||
					 axes->value[0] == axes->value[1]))
		status = spec_error_set(error, SPEC_EUSAGE,
			"the two points of the axes must differ in X, Y, wavelength and value");
	return status;
}

/* How much of a pixel is ink. */
static double
share_of(const struct trace *trace, const double linear[3])
{
	double from[3], along = 0, beside = 0;

	for (int c = 0; c < 3; c++) {
		double encoded = spec_srgb_encode(fmin(fmax(linear[c], 0), 1));

		from[c] = encoded - trace->paper[c];
		along += from[c] * trace->way[c] / trace->square;
	}
	along = fmin(fmax(along, 0), 1);
	for (int c = 0; c < 3; c++)
		beside += pow(from[c] - along * trace->way[c], 2);
	return beside <= BESIDE * BESIDE ? along : 0;
}

/* A run has ended; one that was never certain is nothing. */
static enum spec_status
end_run(const struct trace *trace, int x, struct column *column, struct spec_error *error)
{
	double ink = column->ink, most = column->most;

	column->open = 0;
	column->ink = column->most = 0;
	if (most < CERTAIN)
		return SPEC_OK;
	if (column->found)
		return spec_error_set(error, SPEC_ERANGE,
			"%s: the curve's colour is at two places of column %d, around rows "
			"%.0f and %.0f",
			trace->file, x, column->y, column->moment / ink);
	column->found = 1;
	column->y = column->moment / ink;
	return SPEC_OK;
}

static enum spec_status
take_pixel(const struct trace *trace, int x, int y, double share, struct spec_error *error)
{
	struct column *column = &trace->column[x - trace->x0];

	if (share < LEAST)
		return column->open ? end_run(trace, x, column, error) : SPEC_OK;
	if (!column->open)
		column->moment = 0;
	column->open = 1;
	column->ink += share;
	column->moment += share * y;
	column->most = fmax(column->most, share);
	return SPEC_OK;
}

static enum spec_status
find_channels(const struct spec_image *image, const char *file, size_t channel[3],
	struct spec_error *error)
{
	static const char *const names[3] = {"R", "G", "B"};

	for (int c = 0; c < 3; c++) {
		channel[c] = spec_image_find_channel(image, names[c]);
		if (channel[c] == image->channels ||
			image->channel[channel[c]].sample == SPEC_SAMPLE_UINT)
			return spec_error_set(error, SPEC_EFORMAT,
				"%s: is no picture of colours: no channel %s", file,
				names[c]);
	}
	return SPEC_OK;
}

static enum spec_status
read_columns(struct trace *trace, struct spec_reader *reader, struct spec_error *error)
{
	const struct spec_image *image = spec_reader_image(reader);
	struct spec_decoder *decoder = NULL;
	size_t channel[3];
	enum spec_status status = find_channels(image, trace->file, channel, error);

	if (status == SPEC_OK)
		status = spec_decoder_open(&decoder, reader, NULL, error);
	for (int y = trace->y0; y < trace->y1 && status == SPEC_OK; y++) {
		const float *row[3];

		status = spec_decoder_read(decoder, image->data.y0 + y, error);
		for (int c = 0; c < 3 && status == SPEC_OK; c++)
			row[c] = spec_decoder_row(decoder, image->data.y0 + y, channel[c]);
		for (int x = trace->x0; x < trace->x1 && status == SPEC_OK; x++) {
			double linear[3] = {row[0][x], row[1][x], row[2][x]};

			status = take_pixel(trace, x, y, share_of(trace, linear), error);
		}
	}
	for (int x = trace->x0; x < trace->x1 && status == SPEC_OK; x++)
		if (trace->column[x - trace->x0].open)
			status = end_run(trace, x, &trace->column[x - trace->x0], error);
	spec_decoder_close(decoder);
	return status == SPEC_OK ? spec_reader_drain(reader, error) : status;
}

/* Where a place between the two points lies between what they stand for. */
static double
scale(const double place[2], const double of[2], double at)
{
	double share = (at - place[0]) / (place[1] - place[0]);

	return of[0] * (1 - share) + of[1] * share;
}

static enum spec_status
make_curve(const struct trace *trace, struct spec_curve *curve, struct spec_error *error)
{
	const struct spec_trace_axes *axes = trace->axes;
	int backwards = (axes->x[1] > axes->x[0]) !=
			(axes->wavelength_nm[1] > axes->wavelength_nm[0]);
	int columns = trace->x1 - trace->x0;
	size_t count = 0, i = 0;
	enum spec_status status;

	for (int x = 0; x < columns; x++)
		count += trace->column[x].found != 0;
	if (count < 2)
		return spec_error_set(error, SPEC_ERANGE,
			"%s: the curve's colour is in %s of the plot", trace->file,
			count ? "one column alone" : "no column");
	status = spec_curve_new(count, 1, curve, error);
	for (int x = 0; x < columns && status == SPEC_OK; x++) {
		size_t place = backwards ? count - 1 - i : i;

		if (!trace->column[x].found)
			continue;
		curve->wavelength_nm[place] =
			scale(axes->x, axes->wavelength_nm, trace->x0 + x);
		curve->value[place] = scale(axes->y, axes->value, trace->column[x].y);
		i++;
	}
	return status;
}

static enum spec_status
open_trace(struct trace *trace, const struct spec_image *image, const double ink[3],
	const double paper[3], struct spec_error *error)
{
	const struct spec_trace_axes *axes = trace->axes;

	for (int c = 0; c < 3; c++) {
		trace->paper[c] = paper[c];
		trace->way[c] = ink[c] - paper[c];
		trace->square += trace->way[c] * trace->way[c];
	}
	if (trace->square < 4 * BESIDE * BESIDE)
		return spec_error_set(error, SPEC_EUSAGE,
			"the curve's colour can hardly be told from the background's");
	trace->x0 = (int)ceil(fmin(axes->x[0], axes->x[1]));
	trace->x1 = (int)floor(fmax(axes->x[0], axes->x[1])) + 1;
	trace->y0 = (int)ceil(fmin(axes->y[0], axes->y[1]));
	trace->y1 = (int)floor(fmax(axes->y[0], axes->y[1])) + 1;
	if ((size_t)trace->x1 > spec_window_width(&image->data) ||
		(size_t)trace->y1 > spec_window_height(&image->data))
		return spec_error_set(error, SPEC_ERANGE,
			"%s: has %zu x %zu pixels, and a point of the axes is not among them",
			trace->file, spec_window_width(&image->data),
			spec_window_height(&image->data));
	trace->y0 = trace->y0 > MARGIN ? trace->y0 - MARGIN : 0;
	trace->y1 += MARGIN;
	if ((size_t)trace->y1 > spec_window_height(&image->data))
		trace->y1 = (int)spec_window_height(&image->data);
	trace->column = spec_memory_new(
		(size_t)(trace->x1 - trace->x0), sizeof *trace->column, "columns", error);
	return trace->column ? SPEC_OK : SPEC_ENOMEM;
}

enum spec_status
spec_trace_curve(struct spec_reader *reader, const struct spec_trace_axes *axes,
	const double ink[3], const double paper[3], struct spec_curve *curve,
	struct spec_error *error)
{
	struct trace trace = {.axes = axes, .file = spec_reader_name(reader)};
	char source[300];
	enum spec_status status =
		open_trace(&trace, spec_reader_image(reader), ink, paper, error);

	*curve = (struct spec_curve){0};
	if (status == SPEC_OK)
		status = read_columns(&trace, reader, error);
	if (status == SPEC_OK)
		status = make_curve(&trace, curve, error);
	if (status == SPEC_OK) {
		(void)snprintf(
			source, sizeof source, "read off the plot %.200s", trace.file);
		spec_error_plain(source);
		status = spec_curve_set_text(&curve->source, source, error);
	}
	if (status != SPEC_OK)
		spec_curve_free(curve);
	free(trace.column);
	return status;
}
