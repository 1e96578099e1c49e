#include "image/description.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "base/memory.h"
#include "base/number.h"
#include "image/samples.h"
#include "spectrum/spd.h"

#define FIRST_LINE "spectools\n"
#define FARTHEST (1 << 30) /* a window's coordinates */

/* ---- windows ---- */

void
spec_description_window(
	char text[SPEC_DESCRIPTION_WINDOW], const struct spec_window *window)
{
	snprintf(text, SPEC_DESCRIPTION_WINDOW, "%d %d %d %d", window->x0, window->y0,
		window->x1, window->y1);
}

enum spec_status
spec_description_parse_window(
	const char *text, struct spec_window *window, struct spec_error *error)
{
	int *const to[] = {&window->x0, &window->y0, &window->x1, &window->y1};
	const char *at = text;
	size_t i = 0;

	for (; i < 4; i++) {
		double value;
		size_t length = spec_number_scan(at, '.', &value);

		if (length == 0 || !(value >= -FARTHEST && value <= FARTHEST) ||
			value != (int)value)
			break;
		*to[i] = (int)value;
		at += length;
		at += strspn(at, " ,");
	}
	if (i < 4 || *at || window->x0 >= window->x1 || window->y0 >= window->y1)
		return spec_error_set(
			error, SPEC_EFORMAT, "'%.60s' is no window X0 Y0 X1 Y1", text);
	return SPEC_OK;
}

/* ---- writing ---- */

static void
write_window(FILE *stream, const char *key, const struct spec_window *window,
	const struct spec_window *size)
{
	char text[SPEC_DESCRIPTION_WINDOW];

	if (window->x0 == 0 && window->y0 == 0 &&
		spec_window_width(window) == spec_window_width(size) &&
		spec_window_height(window) == spec_window_height(size))
		return;
	spec_description_window(text, window);
	fprintf(stream, "%s: %s\n", key, text);
}

static void
write_place(FILE *stream, const struct spec_image *image)
{
	char number[SPEC_SPD_NUMBER];

	write_window(stream, "data_window", &image->data, &image->data);
	write_window(stream, "display_window", &image->display, &image->data);
	if (image->pixel_aspect_ratio != 1) {
		spec_spd_format_number(image->pixel_aspect_ratio, number);
		fprintf(stream, "pixel_aspect: %s\n", number);
	}
}

static void
write_text(FILE *stream, const struct spec_attribute *attribute)
{
	fprintf(stream, "%s: ", attribute->name);
	for (size_t k = 0; k < attribute->size; k++) {
		fputc(attribute->value[k], stream);
		if (attribute->value[k] == '\n')
			fputc(' ', stream);
	}
	fputc('\n', stream);
}

/* Whether a text can stand in a line. A zero byte would end the description. */
static int
fits(const struct spec_attribute *attribute)
{
	return strncmp(attribute->name, "spec:", 5) == 0 &&
	       strcmp(attribute->type, "string") == 0 &&
	       !memchr(attribute->value, '\0', attribute->size) &&
	       !strpbrk(attribute->name, " \n");
}

static enum spec_status
write_attributes(FILE *stream, const struct spec_image *image, int without_bins,
	struct spec_error *error)
{
	char *quantity = spec_image_quantity(image, error);
	long long samples;
	enum spec_status status =
		quantity ? spec_samples_get(image, &samples, "image", error) : SPEC_ENOMEM;

	if (status == SPEC_OK)
		fprintf(stream, "spec:quantity: %s\n", quantity);
	if (status == SPEC_OK && samples > 0)
		fprintf(stream, "spec:samples: %lld\n", samples);
	free(quantity);
	for (size_t i = 0; i < image->attributes && status == SPEC_OK; i++) {
		const struct spec_attribute *attribute = &image->attribute[i];

		if (fits(attribute) && strcmp(attribute->name, "spec:quantity") != 0 &&
			!(without_bins && strcmp(attribute->name, "spec:bins") == 0))
			write_text(stream, attribute);
	}
	return status;
}

enum spec_status
spec_description_write(
	const struct spec_image *image, struct spec_text *text, struct spec_error *error)
{
	char number[SPEC_SPD_NUMBER];

	fputs(FIRST_LINE "wavelength_nm:", text->stream);
	for (size_t i = 0; i < image->bands; i++) {
		spec_spd_format_number(image->wavelength_nm[i], number);
		fprintf(text->stream, " %s", number);
	}
	fputc('\n', text->stream);
	write_place(text->stream, image);
	return write_attributes(text->stream, image, 0, error);
}

enum spec_status
spec_description_write_band(const struct spec_image *image, size_t band,
	struct spec_text *text, struct spec_error *error)
{
	char number[SPEC_SPD_NUMBER], other[SPEC_SPD_NUMBER];

	spec_spd_format_number(image->wavelength_nm[band], number);
	fprintf(text->stream, FIRST_LINE "wavelength_nm: %s\n", number);
	if (image->edges_nm) {
		spec_spd_format_number(image->edges_nm[band], number);
		spec_spd_format_number(image->edges_nm[band + 1], other);
		fprintf(text->stream, "bin_nm: %s %s\n", number, other);
	}
	write_place(text->stream, image);
	return write_attributes(text->stream, image, 1, error);
}

/* ---- reading ---- */

int
spec_description_is_ours(const char *description)
{
	return strncmp(description, FIRST_LINE, strlen(FIRST_LINE)) == 0;
}

static enum spec_status
read_wavelengths(const char *text, struct spec_grid *grid, struct spec_error *error)
{
	size_t count = *text && *text != ' ', i = 0;
	enum spec_status status;

	spec_grid_free(grid);
	for (const char *at = text; *at; at++)
		count += *at == ' ' && at[1] != ' ' && at[1];
	status = spec_grid_new(count, grid, error);
	for (; status == SPEC_OK && i < count; i++) {
		size_t length;

		text += strspn(text, " ");
		length = spec_number_scan(text, '.', &grid->wavelength_nm[i]);
		if (length == 0 || !(grid->wavelength_nm[i] > 0) ||
			!strchr(" ", text[length])) {
			spec_grid_free(grid);
			return spec_error_set(error, SPEC_EFORMAT,
				"the description's wavelengths are none: '%.40s'", text);
		}
		text += length;
	}
	return status;
}

static enum spec_status
read_window(const char *text, struct spec_window *window, const struct spec_window *size,
	struct spec_error *error)
{
	struct spec_window read;
	enum spec_status status = spec_description_parse_window(text, &read, error);

	if (status != SPEC_OK)
		return status;
	if (size && (spec_window_width(&read) != spec_window_width(size) ||
			    spec_window_height(&read) != spec_window_height(size)))
		return spec_error_set(error, SPEC_EFORMAT,
			"the description speaks of %zu x %zu pixels",
			spec_window_width(&read), spec_window_height(&read));
	*window = read;
	return SPEC_OK;
}

/* What stands beside attributes. *known: it was that. */
static enum spec_status
read_own(const char *key, const char *value, struct spec_image *image,
	struct spec_description *said, int *known, struct spec_error *error)
{
	double number = 1;
	enum spec_status status;

	*known = 1;
	if (strcmp(key, "wavelength_nm") == 0)
		return said ? read_wavelengths(value, &said->grid, error) : SPEC_OK;
	if (strcmp(key, "bin_nm") == 0) {
		size_t length = said ? spec_number_scan(value, '.', &said->bin_nm[0]) : 0;

		if (length > 0 && value[length] == ' ')
			said->has_bin = spec_number_scan(value + length + 1, '.',
						&said->bin_nm[1]) > 0;
		return SPEC_OK;
	}
	if (strcmp(key, "data_window") == 0)
		return read_window(value, &image->data, &image->data, error);
	if (strcmp(key, "display_window") == 0)
		return read_window(value, &image->display, NULL, error);
	if (strcmp(key, "pixel_aspect") == 0) {
		status = spec_number_parse(
			value, 1e-6, 1e6, "the pixels' aspect", &number, error);
		image->pixel_aspect_ratio = (float)number;
		return status;
	}
	*known = 0;
	return SPEC_OK;
}

/* One "key: value"; the value's own line breaks have a blank behind them. */
static enum spec_status
read_line(char *line, struct spec_image *image, struct spec_description *said,
	struct spec_error *error)
{
	char *value = strstr(line, ": "), *to;
	long long samples;
	enum spec_status status;
	size_t length;
	int known;

	if (!value)
		return SPEC_OK;
	*value = '\0';
	to = value += 2;
	status = read_own(line, value, image, said, &known, error);
	if (known || strncmp(line, "spec:", 5) != 0)
		return status;
	if (strcmp(line, "spec:samples") == 0) {
		status = spec_number_parse_whole(
			value, 1, INT32_MAX, "the number of samples", &samples, error);
		return status == SPEC_OK ? spec_samples_set(image, samples, "image", error)
					 : status;
	}
	length = strlen(value);
	for (size_t i = 0; i < length; i++) {
		*to++ = value[i];
		i += value[i] == '\n';
	}
	*to = '\0';
	return spec_image_set_text(image, line, value, error);
}

enum spec_status
spec_description_read(const char *description, struct spec_image *image,
	struct spec_description *said, struct spec_error *error)
{
	enum spec_status status = SPEC_OK;
	char *copy, *line;

	if (said)
		*said = (struct spec_description){0};
	if (!*description)
		return SPEC_OK;
	if (!spec_description_is_ours(description))
		return spec_image_set_text(image, "ImageDescription", description, error);
	copy = spec_memory_text(description, strlen(description), error);
	if (!copy)
		return SPEC_ENOMEM;
	line = copy + strlen(FIRST_LINE);
	while (status == SPEC_OK && line && *line) {
		char *end = strchr(line, '\n');

		while (end && end[1] == ' ')
			end = strchr(end + 1, '\n');
		if (end)
			*end = '\0';
		status = read_line(line, image, said, error);
		line = end ? end + 1 : NULL;
	}
	free(copy);
	if (status != SPEC_OK && said)
		spec_description_free(said);
	return status;
}

void
spec_description_free(struct spec_description *said)
{
	spec_grid_free(&said->grid);
	*said = (struct spec_description){0};
}
