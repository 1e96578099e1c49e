#include "image/description.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "base/memory.h"
#include "base/number.h"
#include "spectrum/spd.h"

#define FIRST_LINE "spectools\n"

enum spec_status
spec_description_write(
	const struct spec_image *image, struct spec_text *text, struct spec_error *error)
{
	char number[SPEC_SPD_NUMBER], *quantity = spec_image_quantity(image, error);

	if (!quantity)
		return SPEC_ENOMEM;
	fputs(FIRST_LINE "wavelength_nm:", text->stream);
	for (size_t i = 0; i < image->bands; i++) {
		spec_spd_format_number(image->wavelength_nm[i], number);
		fprintf(text->stream, " %s", number);
	}
	fprintf(text->stream, "\nspec:quantity: %s\n", quantity);
	free(quantity);
	for (size_t i = 0; i < image->attributes; i++) {
		const struct spec_attribute *attribute = &image->attribute[i];

		if (strncmp(attribute->name, "spec:", 5) != 0 ||
			strcmp(attribute->name, "spec:quantity") == 0 ||
			strcmp(attribute->type, "string") != 0)
			continue;
		fprintf(text->stream, "%s: ", attribute->name);
		for (size_t k = 0; k < attribute->size; k++) {
			fputc(attribute->value[k], text->stream);
			if (attribute->value[k] == '\n')
				fputc(' ', text->stream);
		}
		fputc('\n', text->stream);
	}
	return SPEC_OK;
}

int
spec_description_is_ours(const char *description)
{
	return strncmp(description, FIRST_LINE, strlen(FIRST_LINE)) == 0;
}

static enum spec_status
read_wavelengths(const char *text, struct spec_grid *grid, struct spec_error *error)
{
	size_t count = 0, i = 0;
	enum spec_status status;

	for (const char *at = text; *at; at++)
		count += *at == ' ' && at[1] != ' ' && at[1];
	status = spec_grid_new(count, grid, error);
	for (; status == SPEC_OK && i < count; i++) {
		size_t length;

		text += strspn(text, " ");
		length = spec_number_scan(text, '.', &grid->wavelength_nm[i]);
		if (length == 0 || !(grid->wavelength_nm[i] > 0)) {
			spec_grid_free(grid);
			return spec_error_set(error, SPEC_EFORMAT,
				"the description's wavelengths are none: '%.40s'", text);
		}
		text += length;
	}
	return status;
}

/* One "key: value"; the value's own line breaks have a blank behind them. */
static enum spec_status
read_line(char *line, struct spec_image *image, struct spec_grid *grid,
	struct spec_error *error)
{
	char *value = strstr(line, ": "), *to;
	size_t length;

	if (!value)
		return SPEC_OK;
	*value = '\0';
	if (strcmp(line, "wavelength_nm") == 0)
		return grid ? read_wavelengths(value + 1, grid, error) : SPEC_OK;
	length = strlen(value + 2);
	to = value += 2;
	for (size_t i = 0; i < length; i++) {
		*to++ = value[i];
		i += value[i] == '\n';
	}
	*to = '\0';
	return strncmp(line, "spec:", 5) == 0
		       ? spec_image_set_text(image, line, value, error)
		       : SPEC_OK;
}

enum spec_status
spec_description_read(const char *description, struct spec_image *image,
	struct spec_grid *grid, struct spec_error *error)
{
	enum spec_status status = SPEC_OK;
	char *copy, *line;

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
		status = read_line(line, image, grid, error);
		line = end ? end + 1 : NULL;
	}
	free(copy);
	return status;
}
