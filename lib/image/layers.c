#include "image/layers.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "base/memory.h"
#include "image/names.h"

#define MOST_LAYERS 4096 /* of a kind; more than any view ray crosses */

/* The number behind a prefix and before a point, from 1; *rest is what follows. 0: none. */
static size_t
number_of(const char *channel, const char *prefix, const char **rest)
{
	size_t length = strlen(prefix), digits, number = 0;

	if (strncmp(channel, prefix, length) != 0)
		return 0;
	channel += length;
	digits = strspn(channel, "0123456789");
	if (digits == 0 || digits > 4 || channel[0] == '0' || channel[digits] != '.')
		return 0;
	for (size_t i = 0; i < digits; i++)
		number = number * 10 + (size_t)(channel[i] - '0');
	*rest = channel + digits + 1;
	return number <= MOST_LAYERS ? number : 0;
}

/* What follows a prefix, or null. */
static const char *
after(const char *channel, const char *prefix)
{
	size_t length = strlen(prefix);

	return strncmp(channel, prefix, length) == 0 ? channel + length : NULL;
}

int
spec_layers_is_film(const struct spec_channel *channel)
{
	const char *rest;

	return number_of(channel->name, "film", &rest) > 0 ||
	       after(channel->name, "through.");
}

int
spec_layers_is_lamp(const struct spec_channel *channel)
{
	const char *rest;

	return number_of(channel->name, "lamp", &rest) > 0;
}

static void
clear_vector(size_t vector[3])
{
	vector[0] = vector[1] = vector[2] = SPEC_LAYERS_NONE;
}

static void
clear_geometry(struct spec_geometry *geometry)
{
	clear_vector(geometry->point);
	clear_vector(geometry->normal);
	clear_vector(geometry->shading);
	clear_vector(geometry->tangent);
	clear_vector(geometry->eye);
	clear_vector(geometry->object);
	geometry->cosine = geometry->cover = geometry->id = SPEC_LAYERS_NONE;
}

/* Whether name is vector.X, .Y or .Z; then its channel is noted. */
static int
take_component(size_t vector[3], const char *vector_name, const char *name, size_t channel)
{
	size_t length = strlen(vector_name);

	if (strncmp(name, vector_name, length) != 0 || strlen(name) != length + 2 ||
		name[length] != '.' || name[length + 1] < 'X' || name[length + 1] > 'Z')
		return 0;
	vector[name[length + 1] - 'X'] = channel;
	return 1;
}

static void
take_geometry(struct spec_geometry *geometry, const char *name, size_t channel)
{
	if (strcmp(name, "cosine") == 0)
		geometry->cosine = channel;
	else if (strcmp(name, "cover") == 0)
		geometry->cover = channel;
	else if (strcmp(name, "id") == 0)
		geometry->id = channel;
	else if (!take_component(geometry->point, "P", name, channel) &&
		 !take_component(geometry->normal, "N", name, channel) &&
		 !take_component(geometry->shading, "Ns", name, channel) &&
		 !take_component(geometry->tangent, "Tan", name, channel) &&
		 !take_component(geometry->eye, "I", name, channel))
		(void)take_component(geometry->object, "Q", name, channel);
}

/* A channel that is a band of a layer: suffix is its name without the layer's. */
static enum spec_status
take_band(size_t *bands, const struct spec_image *image, const char *suffix, size_t channel,
	const char *name, struct spec_error *error)
{
	const char *whole = image->channel[channel].name;
	struct spec_channel band = {0};
	enum spec_status status;
	size_t index;
	int same;

	band.name = spec_memory_text(suffix, strlen(suffix), error);
	if (!band.name)
		return SPEC_ENOMEM;
	status = spec_names_read(&band, error);
	free(band.name);
	if (status != SPEC_OK) {
		spec_error_prefix(error, "%s: '%s'", name, whole);
		return status;
	}
	if (band.role != SPEC_ROLE_EMISSIVE || band.stokes != 0)
		return spec_error_set(error, SPEC_EFORMAT,
			"%s: '%s' is not named as a band of light (S0.550,000000nm)", name,
			whole);
	index = spec_image_nearest_band(image, band.wavelength_nm, &same);
	if (!same || bands[index] != SPEC_LAYERS_NONE)
		return spec_error_set(error, SPEC_EFORMAT,
			same ? "%s: '%s' stands for a band that its layer has already"
			     : "%s: '%s' is not at a band of S0",
			name, whole);
	bands[index] = channel;
	return SPEC_OK;
}

/* Whether a name is that of a band of light, in any of the namings that are read. */
static int
names_light(const char *name)
{
	struct spec_channel channel = {.name = (char *)(uintptr_t)name}; /* only read */

	return spec_names_read(&channel, NULL) == SPEC_OK &&
	       channel.role == SPEC_ROLE_EMISSIVE;
}

static size_t *
new_bands(const struct spec_image *image, struct spec_error *error)
{
	size_t *bands = spec_memory_new(image->bands, sizeof *bands, "bands", error);

	for (size_t i = 0; bands && i < image->bands; i++)
		bands[i] = SPEC_LAYERS_NONE;
	return bands;
}

/* How many layers there are of each kind, by their highest numbers. */
static enum spec_status
make_room(struct spec_layers *layers, const struct spec_image *image,
	struct spec_error *error)
{
	const char *rest;

	for (size_t i = 0; i < image->channels; i++) {
		size_t film = number_of(image->channel[i].name, "film", &rest);
		size_t lamp = number_of(image->channel[i].name, "lamp", &rest);

		layers->films = film > layers->films ? film : layers->films;
		layers->lamps = lamp > layers->lamps ? lamp : layers->lamps;
	}
	layers->film = spec_memory_new(layers->films, sizeof *layers->film, "films", error);
	layers->lamp = spec_memory_new(layers->lamps, sizeof *layers->lamp, "lamps", error);
	if (!layers->film || !layers->lamp)
		return SPEC_ENOMEM;
	for (size_t i = 0; i < layers->films; i++) {
		clear_geometry(&layers->film[i].geometry);
		layers->film[i].mirror = new_bands(image, error);
		if (!layers->film[i].mirror)
			return SPEC_ENOMEM;
	}
	for (size_t i = 0; i < layers->lamps; i++) {
		clear_vector(layers->lamp[i].direction);
		layers->lamp[i].irradiance = new_bands(image, error);
		if (!layers->lamp[i].irradiance)
			return SPEC_ENOMEM;
	}
	return SPEC_OK;
}

static enum spec_status
take_channel(struct spec_layers *layers, const struct spec_image *image, size_t channel,
	const char *name, struct spec_error *error)
{
	const char *text = image->channel[channel].name, *rest, *band;
	size_t number;

	if ((number = number_of(text, "film", &rest)) > 0) {
		struct spec_film_layer *film = &layers->film[number - 1];

		band = after(rest, "mirror.");
		if (band)
			return take_band(film->mirror, image, band, channel, name, error);
		take_geometry(&film->geometry, rest, channel);
	} else if ((number = number_of(text, "lamp", &rest)) > 0) {
		struct spec_lamp_layer *lamp = &layers->lamp[number - 1];

		if (names_light(rest))
			return take_band(
				lamp->irradiance, image, rest, channel, name, error);
		(void)take_component(lamp->direction, "D", rest, channel);
	} else if (after(text, "through.")) {
		if (!layers->through)
			layers->through = new_bands(image, error);
		if (!layers->through)
			return SPEC_ENOMEM;
		return take_band(layers->through, image, after(text, "through."), channel,
			name, error);
	} else {
		take_geometry(&layers->surface, text, channel);
	}
	return SPEC_OK;
}

static enum spec_status
check_bands(const struct spec_image *image, const size_t *bands, const char *kind,
	size_t number, const char *part, const char *name, struct spec_error *error)
{
	char layer[32];

	snprintf(layer, sizeof layer, number ? "%s%zu%s" : "%s", kind, number, part);
	for (size_t i = 0; i < image->bands; i++) {
		if (bands[i] == SPEC_LAYERS_NONE)
			return spec_error_set(error, SPEC_EFORMAT,
				"%s: the layer '%s' has no band at %g nm, which S0 has",
				name, layer, image->wavelength_nm[i]);
	}
	return SPEC_OK;
}

static enum spec_status
check_vector(const size_t vector[3], const char *layer, size_t number, const char *what,
	const char *name, struct spec_error *error)
{
	int there = (vector[0] != SPEC_LAYERS_NONE) + (vector[1] != SPEC_LAYERS_NONE) +
		    (vector[2] != SPEC_LAYERS_NONE);

	if (there == 0 || there == 3)
		return SPEC_OK;
	if (number > 0)
		return spec_error_set(error, SPEC_EFORMAT,
			"%s: '%s%zu.%s' has not all of .X, .Y, .Z", name, layer, number,
			what);
	return spec_error_set(
		error, SPEC_EFORMAT, "%s: '%s' has not all of .X, .Y, .Z", name, what);
}

static enum spec_status
check_geometry(const struct spec_geometry *geometry, const char *layer, size_t number,
	const char *name, struct spec_error *error)
{
	const size_t *const vector[] = {geometry->point, geometry->normal,
		geometry->shading, geometry->tangent, geometry->eye, geometry->object};
	static const char *const what[] = {"P", "N", "Ns", "Tan", "I", "Q"};
	enum spec_status status = SPEC_OK;

	for (size_t i = 0; i < 6 && status == SPEC_OK; i++)
		status = check_vector(vector[i], layer, number, what[i], name, error);
	return status;
}

static enum spec_status
check_layers(const struct spec_layers *layers, const struct spec_image *image,
	const char *name, struct spec_error *error)
{
	enum spec_status status = SPEC_OK;

	for (size_t i = 0; i < layers->films && status == SPEC_OK; i++) {
		status = check_bands(image, layers->film[i].mirror, "film", i + 1,
			".mirror", name, error);
		if (status == SPEC_OK)
			status = check_geometry(
				&layers->film[i].geometry, "film", i + 1, name, error);
	}
	for (size_t i = 0; i < layers->lamps && status == SPEC_OK; i++) {
		status = check_bands(
			image, layers->lamp[i].irradiance, "lamp", i + 1, "", name, error);
		if (status == SPEC_OK)
			status = check_vector(
				layers->lamp[i].direction, "lamp", i + 1, "D", name, error);
	}
	if (status == SPEC_OK && layers->through)
		status = check_bands(image, layers->through, "through", 0, "", name, error);
	return status;
}

enum spec_status
spec_layers_find(struct spec_layers *layers, const struct spec_image *image,
	const char *name, struct spec_error *error)
{
	enum spec_status status;

	*layers = (struct spec_layers){0};
	clear_geometry(&layers->surface);
	status = make_room(layers, image, error);
	if (status == SPEC_OK && layers->films + layers->lamps > 0 &&
		image->role != SPEC_ROLE_EMISSIVE)
		status = spec_error_set(error, SPEC_EFORMAT,
			"%s: has light layers, and no bands of light (S0) beside them",
			name);
	for (size_t i = 0; i < image->channels && status == SPEC_OK; i++) {
		if (image->channel[i].role == SPEC_ROLE_OTHER)
			status = take_channel(layers, image, i, name, error);
	}
	if (status == SPEC_OK)
		status = check_layers(layers, image, name, error);
	/* A vector that no layer uses does no harm: it passes through. */
	if (status == SPEC_OK && layers->lamps > 0)
		status = check_geometry(&layers->surface, "", 0, name, error);
	if (status != SPEC_OK)
		spec_layers_free(layers);
	return status;
}

void
spec_layers_free(struct spec_layers *layers)
{
	for (size_t i = 0; layers->film && i < layers->films; i++)
		free(layers->film[i].mirror);
	for (size_t i = 0; layers->lamp && i < layers->lamps; i++)
		free(layers->lamp[i].irradiance);
	free(layers->film);
	free(layers->lamp);
	free(layers->through);
	*layers = (struct spec_layers){0};
}
