#include "image/given.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "base/memory.h"
#include "base/number.h"

#define LONGEST_WAVELENGTH 64

/* Takes one "W" of a list from *text, up to a comma or the end. */
static enum spec_status
take_wavelength(const char **text, double *wavelength_nm, struct spec_error *error)
{
	size_t length = strcspn(*text, ",");
	char number[LONGEST_WAVELENGTH];

	if (length >= sizeof number)
		return spec_error_set(error, SPEC_EUSAGE,
			"a wavelength is longer than %zu characters: '%.40s'",
			sizeof number - 1, *text);
	snprintf(number, sizeof number, "%.*s", (int)length, *text);
	*text += length + ((*text)[length] == ',');
	return spec_number_parse_length(number, "the wavelength", wavelength_nm, error);
}

static struct spec_channel *
find_channel(struct spec_image *image, const char *name, size_t length)
{
	for (size_t i = 0; i < image->channels; i++) {
		const char *own = image->channel[i].name;

		if (strlen(own) == length && memcmp(own, name, length) == 0)
			return &image->channel[i];
	}
	return NULL;
}

/* Bands by their own names: of two inputs the map may be meant for the other one. */
static int
has_bands(const struct spec_image *image)
{
	for (size_t i = 0; i < image->channels; i++) {
		enum spec_naming naming = image->channel[i].naming;

		if (naming != SPEC_NAMING_NONE && naming != SPEC_NAMING_GIVEN)
			return 1;
	}
	return 0;
}

/* One "NAME=WAVELENGTH" of the map. */
static enum spec_status
map_channel(struct spec_image *image, enum spec_role role, const char **text,
	const char *name, struct spec_error *error)
{
	size_t length = strcspn(*text, "=,");
	struct spec_channel *channel = find_channel(image, *text, length);
	int shown = (int)(length < 200 ? length : 200);
	enum spec_status status;

	if ((*text)[length] != '=' || length == 0)
		return spec_error_set(error, SPEC_EUSAGE,
			"the name map is not NAME=WAVELENGTH,... at '%.40s'", *text);
	if (!channel && has_bands(image)) {
		*text += strcspn(*text, ",");
		*text += **text == ',';
		return SPEC_OK;
	}
	if (!channel)
		return spec_error_set(error, SPEC_EUSAGE,
			"%s: has no channel '%.*s' to be mapped", name, shown, *text);
	if (channel->naming == SPEC_NAMING_GIVEN)
		return spec_error_set(
			error, SPEC_EUSAGE, "'%.*s' is mapped twice", shown, *text);
	if (channel->role != SPEC_ROLE_OTHER)
		return spec_error_set(error, SPEC_EUSAGE,
			"%s: channel '%.*s' says itself that it is of %g nm", name, shown,
			*text, channel->wavelength_nm);
	*text += length + 1;
	status = take_wavelength(text, &channel->wavelength_nm, error);
	channel->reradiated_nm = channel->wavelength_nm;
	channel->naming = SPEC_NAMING_GIVEN;
	channel->role = role;
	return status;
}

enum spec_status
spec_given_apply(struct spec_image *image, const struct spec_settings *settings,
	const char *name, struct spec_error *error)
{
	enum spec_role role = settings->read_as;
	const char *map = settings->name_map;
	enum spec_status status = SPEC_OK;

	while (map && *map && status == SPEC_OK)
		status = map_channel(image,
			role == SPEC_ROLE_OTHER ? SPEC_ROLE_EMISSIVE : role, &map, name,
			error);
	for (size_t i = 0; i < image->channels && status == SPEC_OK; i++) {
		struct spec_channel *channel = &image->channel[i];

		if (role == SPEC_ROLE_OTHER || channel->role == SPEC_ROLE_OTHER)
			continue;
		if (channel->naming == SPEC_NAMING_LAYOUT && channel->role != role)
			return spec_error_set(error, SPEC_EUSAGE,
				"%s: its names say that it is %s", name,
				channel->role == SPEC_ROLE_EMISSIVE ? "radiance"
								    : "reflectance");
		channel->role = role;
	}
	return status;
}

enum spec_status
spec_given_wavelengths(const struct spec_settings *settings, size_t count, const char *name,
	struct spec_grid *grid, struct spec_error *error)
{
	const char *text = settings->wavelengths;
	enum spec_status status = SPEC_OK;

	*grid = (struct spec_grid){0};
	if (!text)
		return spec_error_set(error, SPEC_EUSAGE,
			"%s: does not say of which wavelengths its %zu bands are "
			"(--wavelengths LO:HI:STEP)",
			name, count);
	if (strchr(text, ':')) {
		status = spec_grid_parse(text, grid, error);
	} else {
		size_t commas = 0;

		for (const char *at = text; *at; at++)
			commas += *at == ',';
		status = spec_grid_new(commas + 1, grid, error);
		for (size_t i = 0; i < grid->count && status == SPEC_OK; i++) {
			status = take_wavelength(&text, &grid->wavelength_nm[i], error);
			if (status == SPEC_OK && i > 0 &&
				grid->wavelength_nm[i] <= grid->wavelength_nm[i - 1])
				status = spec_error_set(error, SPEC_EUSAGE,
					"the wavelengths do not ascend at %g nm",
					grid->wavelength_nm[i]);
		}
	}
	if (status == SPEC_OK && grid->count != count)
		status = spec_error_set(error, SPEC_EUSAGE,
			"%s: has %zu bands, and --wavelengths gives %zu", name, count,
			grid->count);
	if (status != SPEC_OK)
		spec_grid_free(grid);
	return status;
}

enum spec_status
spec_given_role(const char *text, enum spec_role *role, struct spec_error *error)
{
	if (strcmp(text, "radiance") == 0)
		*role = SPEC_ROLE_EMISSIVE;
	else if (strcmp(text, "reflectance") == 0)
		*role = SPEC_ROLE_REFLECTIVE;
	else
		return spec_error_set(error, SPEC_EUSAGE,
			"'%s' is neither radiance nor reflectance", text);
	return SPEC_OK;
}
