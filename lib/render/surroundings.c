#include "render/surroundings.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "base/interval.h"
#include "base/memory.h"
#include "base/vector.h"
#include "image/reader.h"

#define FLOOR 1e-3 /* of the mean: dark pixels are chosen now and then, too */

/* Which two bands of the image a band lies between, and how far; part < 0: outside. */
struct blend {
	size_t first, second;
	double part;
};

static struct blend
blend_of(const struct spec_image *image, double wavelength_nm)
{
	const double *known = image->wavelength_nm;
	int same;
	size_t i = spec_image_nearest_band(image, wavelength_nm, &same);

	if (same)
		return (struct blend){i, i, 0};
	if (wavelength_nm < known[0] || wavelength_nm > known[image->bands - 1])
		return (struct blend){0, 0, -1};
	i -= known[i] > wavelength_nm;
	return (struct blend){
		i, i + 1, (wavelength_nm - known[i]) / (known[i + 1] - known[i])};
}

static enum spec_status
check_quantity(const struct spec_reader *reader, struct spec_error *error)
{
	char *quantity = spec_image_quantity(spec_reader_image(reader), error);
	int per_band = quantity && strstr(quantity, "per band");

	if (!quantity)
		return SPEC_ENOMEM;
	free(quantity);
	if (!per_band)
		return SPEC_OK;
	return spec_error_set(error, SPEC_EUNSUPPORTED,
		"%s: values are per band, but surroundings need them per nm",
		spec_reader_name(reader));
}

static enum spec_status
check_image(const struct spec_reader *reader, const struct spec_bands_grid *bands,
	const struct spec_settings *settings, struct spec_error *error)
{
	const struct spec_image *image = spec_reader_image(reader);
	size_t width = spec_window_width(&image->data);
	size_t height = spec_window_height(&image->data);
	const char *name = spec_reader_name(reader);

	if (image->role != SPEC_ROLE_EMISSIVE)
		return spec_error_set(error, SPEC_EUNSUPPORTED,
			"%s: surroundings need bands of light (S0)", name);
	if (width != 2 * height)
		return spec_error_set(error, SPEC_EUNSUPPORTED,
			"%s: %zu x %zu pixels: surroundings are twice as wide as high (latitude and longitude; specconvert --projection latlong)",
			name, width, height);
	if ((double)width * (double)height * (double)bands->count * sizeof(float) >
		(double)settings->limits.memory)
		return spec_error_set(error, SPEC_ERANGE,
			"%s: %zu x %zu pixels of %zu bands take more than the limit of %lld bytes (--limit memory=BYTES)",
			name, width, height, bands->count, settings->limits.memory);
	return SPEC_OK;
}

static enum spec_status
take_line(struct spec_surroundings *to, const struct spec_decoder *decoder, int y,
	const struct spec_reader *reader, const struct blend *blend,
	struct spec_error *error)
{
	const struct spec_image *image = spec_reader_image(reader);
	float *line = to->pixel + (size_t)(y - image->data.y0) * to->width * to->bands;

	for (size_t band = 0; band < to->bands; band++) {
		const struct blend *b = &blend[band];
		const float *first =
			spec_decoder_row(decoder, y, image->band_channel[b->first]);
		const float *second =
			spec_decoder_row(decoder, y, image->band_channel[b->second]);

		for (size_t x = 0; x < to->width && b->part >= 0; x++) {
			double value = first[x] * (1 - b->part) + second[x] * b->part;

			if (!(value >= 0 && value < INFINITY))
				return spec_error_set(error, SPEC_EFORMAT,
					"%s: pixel %zu,%d is negative or not finite",
					spec_reader_name(reader), x, y - image->data.y0);
			line[x * to->bands + band] = (float)value;
		}
	}
	return SPEC_OK;
}

static enum spec_status
read_lines(struct spec_surroundings *to, struct spec_reader *reader,
	const struct spec_bands_grid *bands, struct spec_error *error)
{
	const struct spec_image *image = spec_reader_image(reader);
	struct spec_decoder *decoder = NULL;
	struct blend *blend = spec_memory_new(to->bands, sizeof *blend, "bands", error);
	enum spec_status status = blend ? SPEC_OK : SPEC_ENOMEM;

	for (size_t i = 0; i < to->bands && status == SPEC_OK; i++)
		blend[i] = blend_of(image, bands->wavelength_nm[i]);
	if (status == SPEC_OK)
		status = spec_decoder_open(&decoder, reader, NULL, error);
	for (int y = image->data.y0; y < image->data.y1 && status == SPEC_OK; y++) {
		status = spec_decoder_read(decoder, y, error);
		if (status == SPEC_OK)
			status = take_line(to, decoder, y, reader, blend, error);
	}
	spec_decoder_close(decoder);
	free(blend);
	return status;
}

/* Turns weights share[1..count] into the sums of shares up to each; returns the whole. */
static double
accumulate(double *share, size_t count)
{
	double whole;

	for (size_t i = 1; i <= count; i++)
		share[i] += share[i - 1];
	whole = share[count];
	for (size_t i = 1; i < count; i++)
		share[i] /= whole;
	share[count] = 1;
	return whole;
}

static double
sine_of_row(const struct spec_surroundings *s, size_t y)
{
	return sin(M_PI * ((double)y + 0.5) / (double)s->height);
}

/* The mean over bands of each pixel into column[1..width], and over everything. */
static void
average(struct spec_surroundings *s)
{
	double whole = 0, sines = 0;

	for (size_t y = 0; y < s->height; y++) {
		double *column = s->column + y * (s->width + 1);

		for (size_t x = 0; x < s->width; x++) {
			const float *pixel = s->pixel + (y * s->width + x) * s->bands;
			double sum = 0;

			for (size_t i = 0; i < s->bands; i++)
				sum += pixel[i];
			column[x + 1] = sum / (double)s->bands;
			whole += sine_of_row(s, y) * column[x + 1];
		}
		sines += sine_of_row(s, y);
	}
	s->mean = whole / (sines * (double)s->width);
}

static double
at_column(const double *column, size_t width, size_t x)
{
	return column[x % width + 1];
}

/*
 * The mean over each pixel's place of light that is linear between the pixels' middles: one
 * beside the sun has some of it.
 */
static enum spec_status
blur(struct spec_surroundings *s, struct spec_error *error)
{
	size_t w = s->width, h = s->height;
	double *sharp = spec_memory_new(h, (w + 1) * sizeof *sharp, "pixels", error);

	if (!sharp)
		return SPEC_ENOMEM;
	memcpy(sharp, s->column, h * (w + 1) * sizeof *sharp);
	for (size_t y = 0; y < h; y++) {
		for (size_t x = 0; x < w; x++) {
			static const double weight[] = {1, 6, 1};
			double sum = 0;

			for (size_t i = 0; i < 3; i++) {
				size_t row = y + i > 0 ? y + i - 1 : 0;
				const double *from =
					sharp + (row < h ? row : h - 1) * (w + 1);

				sum += weight[i] * (at_column(from, w, x + w - 1) +
							   6 * at_column(from, w, x) +
							   at_column(from, w, x + 1));
			}
			s->column[y * (w + 1) + x + 1] = sum / 64;
		}
	}
	free(sharp);
	return SPEC_OK;
}

/* Shares of rows, and of pixels in each row: by the mean over bands and the solid angle. */
static enum spec_status
share_out(struct spec_surroundings *s, struct spec_error *error)
{
	enum spec_status status;
	double least;

	average(s);
	status = blur(s, error);
	if (status != SPEC_OK)
		return status;
	least = s->mean > 0 ? FLOOR * s->mean : 1; /* all black: any share will do */
	for (size_t y = 0; y < s->height; y++) {
		double *column = s->column + y * (s->width + 1);

		for (size_t x = 1; x <= s->width; x++)
			column[x] += least;
		s->row[y + 1] = accumulate(column, s->width) * sine_of_row(s, y);
	}
	(void)accumulate(s->row, s->height);
	return SPEC_OK;
}

static enum spec_status
make_room(struct spec_surroundings *s, struct spec_error *error)
{
	s->pixel = spec_memory_new(
		s->width * s->height, s->bands * sizeof *s->pixel, "pixels", error);
	s->row = spec_memory_new(s->height + 1, sizeof *s->row, "lines", error);
	s->column = spec_memory_new(
		s->height * (s->width + 1), sizeof *s->column, "pixels", error);
	return s->pixel && s->row && s->column ? SPEC_OK : SPEC_ENOMEM;
}

enum spec_status
spec_surroundings_read(struct spec_surroundings *s, const char *path,
	const struct spec_bands_grid *bands, const struct spec_settings *settings,
	struct spec_error *error)
{
	struct spec_reader *reader = NULL;
	enum spec_status status = spec_reader_open(&reader, path, settings, error);

	*s = (struct spec_surroundings){.bands = bands->count};
	if (status == SPEC_OK)
		status = check_image(reader, bands, settings, error);
	if (status == SPEC_OK)
		status = check_quantity(reader, error);
	if (status == SPEC_OK) {
		s->width = spec_window_width(&spec_reader_image(reader)->data);
		s->height = spec_window_height(&spec_reader_image(reader)->data);
		status = make_room(s, error);
	}
	if (status == SPEC_OK)
		status = read_lines(s, reader, bands, error);
	if (status == SPEC_OK)
		status = share_out(s, error);
	if (status != SPEC_OK)
		spec_surroundings_free(s);
	spec_reader_close(reader);
	return status;
}

static struct spec_vector
direction_to(const struct spec_surroundings *s, double x, double y)
{
	double polar = M_PI * y / (double)s->height,
	       azimuth = 2 * M_PI * x / (double)s->width;

	return (struct spec_vector){
		sin(polar) * cos(azimuth), sin(polar) * sin(azimuth), cos(polar)};
}

enum spec_status
spec_surroundings_plan(struct spec_surroundings *s, size_t height,
	spec_surroundings_radiance *radiance, const void *state, struct spec_error *error)
{
	enum spec_status status;

	*s = (struct spec_surroundings){.bands = 1, .width = 2 * height, .height = height};
	status = make_room(s, error);
	for (size_t y = 0; y < s->height && status == SPEC_OK; y++)
		for (size_t x = 0; x < s->width; x++)
			s->pixel[y * s->width + x] = (float)radiance(
				state, direction_to(s, (double)x + 0.5, (double)y + 0.5));
	if (status == SPEC_OK)
		status = share_out(s, error);
	if (status != SPEC_OK)
		spec_surroundings_free(s);
	return status;
}

void
spec_surroundings_free(struct spec_surroundings *s)
{
	free(s->pixel);
	free(s->row);
	free(s->column);
	*s = (struct spec_surroundings){0};
}

/* Columns and rows of a direction, 0 to width and 0 to height. */
static void
place_of(const struct spec_surroundings *s, struct spec_vector d, double *x, double *y)
{
	double azimuth = atan2(d.y, d.x);

	*x = (azimuth < 0 ? azimuth + 2 * M_PI : azimuth) / (2 * M_PI) * (double)s->width;
	*y = acos(fmin(fmax(d.z, -1), 1)) / M_PI * (double)s->height;
}

SPEC_VECTORISED static void
add_blend(float *restrict radiance, const float *restrict factor, const float *a,
	const float *b, const float *c, const float *d, const float w[4], size_t count)
{
	for (size_t i = 0; i < count; i++)
		radiance[i] +=
			factor[i] * (w[0] * a[i] + w[1] * b[i] + w[2] * c[i] + w[3] * d[i]);
}

void
spec_surroundings_add(const struct spec_surroundings *s, struct spec_vector direction,
	const float *factor, double weight, float *radiance)
{
	double x, y, px, py;
	size_t x0, x1, y0, y1;

	place_of(s, direction, &x, &y);
	x -= 0.5;
	y -= 0.5;
	px = x - floor(x);
	py = y - floor(y);
	x0 = (size_t)((long)floor(x) + (long)s->width) % s->width;
	x1 = (x0 + 1) % s->width;
	y0 = y < 0 ? 0 : (size_t)y;
	y1 = y < 0 ? 0 : (y0 + 1 < s->height ? y0 + 1 : s->height - 1);
	{
		const float w[4] = {(float)(weight * (1 - px) * (1 - py)),
			(float)(weight * px * (1 - py)), (float)(weight * (1 - px) * py),
			(float)(weight * px * py)};

		add_blend(radiance, factor, s->pixel + (y0 * s->width + x0) * s->bands,
			s->pixel + (y0 * s->width + x1) * s->bands,
			s->pixel + (y1 * s->width + x0) * s->bands,
			s->pixel + (y1 * s->width + x1) * s->bands, w, s->bands);
	}
}

/* The interval of a rising list from 0 to 1 that holds a number; *part: how far in it. */
static size_t
find_share(const double *share, size_t count, double number, double *part)
{
	size_t found = spec_interval_find(share, count, number);

	*part = (number - share[found]) / (share[found + 1] - share[found]);
	return found;
}

/* Of a pixel's share of all directions, per steradian. */
static double
density_at(const struct spec_surroundings *s, size_t x, size_t y, double sine)
{
	const double *column = s->column + y * (s->width + 1);
	double share = (s->row[y + 1] - s->row[y]) * (column[x + 1] - column[x]);

	if (!(sine > 0))
		return 0;
	return share * (double)s->width * (double)s->height / (2 * M_PI * M_PI * sine);
}

double
spec_surroundings_sample(const struct spec_surroundings *s, const double pair[2],
	struct spec_vector *direction)
{
	double px, py;
	size_t y = find_share(s->row, s->height, pair[1], &py);
	size_t x = find_share(s->column + y * (s->width + 1), s->width, pair[0], &px);

	*direction = direction_to(s, (double)x + px, (double)y + py);
	return density_at(s, x, y, sin(M_PI * ((double)y + py) / (double)s->height));
}

double
spec_surroundings_density(const struct spec_surroundings *s, struct spec_vector d)
{
	double x, y;
	size_t column, row;

	place_of(s, d, &x, &y);
	column = x < (double)s->width ? (size_t)x : s->width - 1;
	row = y < (double)s->height ? (size_t)y : s->height - 1;
	return density_at(s, column, row, sqrt(fmax(0, 1 - d.z * d.z)));
}
