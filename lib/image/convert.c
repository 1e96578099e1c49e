/* The header of a conversion's output, and the plan as a whole. */
#include "image/convert.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "base/memory.h"
#include "image/converting.h"
#include "image/names.h"
#include "image/samples.h"

static int
floor_divide(int a, int b)
{
	return a / b - (a % b < 0);
}

static enum spec_status
set_windows(struct spec_convert *convert, const struct spec_convert_setup *setup,
	const char *name, struct spec_error *error)
{
	const struct spec_window *whole = &convert->input->data;
	struct spec_window *data = &convert->image.data, *display = &convert->image.display;
	int n = setup->downsample;

	convert->downsample = n;
	if (setup->has_crop) {
		const struct spec_window *crop = &setup->crop;
		long long width = (long long)spec_window_width(whole);
		long long height = (long long)spec_window_height(whole);

		if (crop->x0 < 0 || crop->y0 < 0 || crop->x1 > width || crop->y1 > height ||
			crop->x0 >= crop->x1 || crop->y0 >= crop->y1)
			return spec_error_set(error, SPEC_ERANGE,
				"%s: the crop %d,%d,%d,%d is empty or not inside "
				"0,0,%lld,%lld",
				name, crop->x0, crop->y0, crop->x1, crop->y1, width,
				height);
		convert->x0 = crop->x0;
		convert->y0 = crop->y0;
		*data = (struct spec_window){whole->x0 + crop->x0, whole->y0 + crop->y0,
			whole->x0 + crop->x1, whole->y0 + crop->y1};
	}
	if (n == 1)
		return SPEC_OK;
	if (data->x0 % n || data->y0 % n || data->x1 % n || data->y1 % n)
		return spec_error_set(error, SPEC_ERANGE,
			"%s: the window %d,%d,%d,%d is not made of %d x %d pixels (--crop "
			"it first)",
			name, data->x0, data->y0, data->x1, data->y1, n, n);
	*data = (struct spec_window){
		data->x0 / n, data->y0 / n, data->x1 / n, data->y1 / n};
	*display = (struct spec_window){floor_divide(display->x0, n),
		floor_divide(display->y0, n), -floor_divide(-display->x1, n),
		-floor_divide(-display->y1, n)};
	return SPEC_OK;
}

static int
changes_values(const struct spec_converting *converting)
{
	return converting->setup->operations > 0 ||
	       spec_converting_to_band(converting) != converting->per_band;
}

static int
is_foreign(const struct spec_channel *channel)
{
	return channel->role == SPEC_ROLE_OTHER;
}

/* What the bands of a light are stored as. */
static enum spec_sample
sample_of(
	const struct spec_converting *converting, const struct spec_converting_light *light)
{
	const struct spec_channel *channel =
		&converting->convert->input->channel[light->channel[0]];

	return channel->sample == SPEC_SAMPLE_HALF ? SPEC_SAMPLE_HALF : SPEC_SAMPLE_FLOAT;
}

/* The channels of a light layer give way to those of the new bands. */
static enum spec_status
renew_layer(struct spec_converting *converting, const struct spec_converting_light *light,
	struct spec_error *error)
{
	const struct spec_image *input = converting->convert->input;
	struct spec_image *image = &converting->convert->image;
	enum spec_status status = SPEC_OK;
	char name[128];

	for (size_t i = 0; i < input->bands; i++) {
		const char *old = input->channel[light->channel[i]].name;
		size_t at = 0;

		while (strcmp(image->channel[at].name, old) != 0)
			at++;
		free(image->channel[at].name);
		memmove(&image->channel[at], &image->channel[at + 1],
			(--image->channels - at) * sizeof *image->channel);
	}
	for (size_t i = 0; i < converting->made.count && status == SPEC_OK; i++) {
		int length = snprintf(name, sizeof name, "%s", light->prefix);

		spec_names_write(name + length, sizeof name - (size_t)length,
			SPEC_ROLE_EMISSIVE, 0, converting->made.wavelength_nm[i], 0);
		status = spec_image_add_channel(
			image, name, sample_of(converting, light), error);
	}
	return status;
}

static enum spec_status
renew_bands(struct spec_converting *converting, struct spec_error *error)
{
	const struct spec_image *input = converting->convert->input;
	struct spec_image *image = &converting->convert->image;
	int light = spec_converting_is_light(converting, converting->setup->operations);
	enum spec_status status = SPEC_OK;

	for (size_t i = 0; i < converting->lights && status == SPEC_OK; i++)
		if (converting->light[i].is_layer)
			status = renew_layer(converting, &converting->light[i], error);
	if (status != SPEC_OK)
		return status;
	spec_image_remove_bands(image);
	return spec_image_add_bands(image,
		light ? SPEC_ROLE_EMISSIVE : SPEC_ROLE_REFLECTIVE, input->stokes,
		converting->made.wavelength_nm, converting->made.count,
		sample_of(converting, &converting->light[0]), error);
}

/* The output's channels: bands in the layout's names, and what is foreign. */
static enum spec_status
set_channels(struct spec_converting *converting, struct spec_error *error)
{
	const struct spec_convert_setup *setup = converting->setup;
	struct spec_image *image = &converting->convert->image;
	enum spec_status status = spec_image_index(image, converting->name, error);

	if (status == SPEC_OK && setup->bands_only)
		spec_image_remove_channels(image, is_foreign);
	if (status == SPEC_OK)
		status = spec_image_set_bins(
			image, converting->made.edges_nm, converting->made.count, error);
	if (status == SPEC_OK && converting->renewed)
		status = renew_bands(converting, error);
	if (status != SPEC_OK)
		return status;
	for (size_t i = 0; i < image->channels; i++) {
		struct spec_channel *channel = &image->channel[i];

		if (channel->role == SPEC_ROLE_OTHER)
			continue;
		if (setup->half || channel->sample == SPEC_SAMPLE_UINT)
			channel->sample =
				setup->half ? SPEC_SAMPLE_HALF : SPEC_SAMPLE_FLOAT;
	}
	if (changes_values(converting))
		spec_image_remove_preview(image);
	status = spec_image_rename_bands(image, converting->name, error);
	return status == SPEC_OK ? spec_converting_renew_variances(converting, error)
				 : status;
}

/* text with the first "per nm" or "per band" in it made the other; newly allocated. */
static char *
say_per(const char *text, int per_band, struct spec_error *error)
{
	const char *old = per_band ? "per nm" : "per band",
		   *new = per_band ? "per band" : "per nm";
	const char *at = strstr(text, old);
	size_t size = strlen(text) + strlen(new) + 1;
	char *said = spec_memory_new(size, 1, "bytes of text", error);

	if (said && at)
		snprintf(said, size, "%.*s%s%s", (int)(at - text), text, new,
			at + strlen(old));
	else if (said)
		snprintf(said, size, "%s", text);
	return said;
}

/* What the samples are now. */
static enum spec_status
set_quantity(struct spec_converting *converting, struct spec_error *error)
{
	const struct spec_convert_setup *setup = converting->setup;
	char *said =
		say_per(converting->quantity, spec_converting_to_band(converting), error);
	enum spec_status status = said ? SPEC_OK : SPEC_ENOMEM;
	int changed = said && strcmp(said, converting->quantity) != 0;

	for (size_t i = 0; i < setup->operations && status == SPEC_OK; i++) {
		const struct spec_operation *operation = &setup->operation[i];
		size_t size = strlen(said) + 64;
		char *next = NULL;

		if (operation->kind == SPEC_OPERATION_ILLUMINATE)
			next = strstr(operation->curve.quantity, "per band")
				       ? spec_memory_text("radiance per band", 17, error)
				       : spec_memory_text("radiance per nm", 15, error);
		else if (operation->kind == SPEC_OPERATION_REFLECTANCE_OF)
			next = spec_memory_text("reflectance", 11, error);
		else if (operation->kind == SPEC_OPERATION_RAISE &&
			 operation->number != 1 && spec_converting_is_light(converting, i))
			next = spec_memory_new(size, 1, "bytes of text", error);
		else
			continue;
		if (next && *next == '\0')
			snprintf(next, size, "(%s)^%g", said, operation->number);
		free(said);
		said = next;
		status = said ? SPEC_OK : SPEC_ENOMEM;
		changed = 1;
	}
	if (status == SPEC_OK && changed)
		status = spec_image_set_text(
			&converting->convert->image, "spec:quantity", said, error);
	free(said);
	return status;
}

/* A pixel of N x N has as many times the samples. */
static enum spec_status
count_samples(struct spec_converting *converting, struct spec_error *error)
{
	struct spec_convert *convert = converting->convert;
	long long n = convert->downsample, samples;
	enum spec_status status =
		spec_samples_get(&convert->image, &samples, converting->name, error);

	return status == SPEC_OK ? spec_samples_set(&convert->image, samples * n * n,
					   converting->name, error)
				 : status;
}

static enum spec_status
set_attributes(struct spec_converting *converting, struct spec_error *error)
{
	struct spec_image *image = &converting->convert->image;
	enum spec_medium medium = converting->setup->medium;
	enum spec_status status =
		spec_image_set_text(image, "spectralLayoutVersion", "1.0", error);

	if (status == SPEC_OK)
		status = set_quantity(converting, error);
	if (status == SPEC_OK && medium != SPEC_MEDIUM_UNKNOWN)
		status = spec_image_set_text(
			image, "spec:medium", spec_medium_name(medium), error);
	if (image->role == SPEC_ROLE_REFLECTIVE &&
		converting->convert->input->role == SPEC_ROLE_EMISSIVE)
		spec_image_remove_attribute(image, "emissiveUnits");
	if (status == SPEC_OK && image->role == SPEC_ROLE_EMISSIVE &&
		!spec_image_attribute(image, "emissiveUnits"))
		status = spec_image_set_text(image, "emissiveUnits", "W.m^-2.sr^-1", error);
	return status;
}

static void
add_light(struct spec_converting *converting, const size_t *channel, int stokes,
	const char *kind, size_t number, const char *after)
{
	struct spec_converting_light *light = &converting->light[converting->lights++];

	*light = (struct spec_converting_light){
		.channel = channel, .stokes = stokes, .is_layer = *kind != '\0'};
	if (number > 0)
		snprintf(light->prefix, sizeof light->prefix, "%s%zu.%s", kind, number,
			after);
	else
		snprintf(light->prefix, sizeof light->prefix, "%s", kind);
}

/* The Stokes components and, where the bands are changed, the light layers. */
static enum spec_status
gather_lights(struct spec_converting *converting, struct spec_error *error)
{
	const struct spec_convert_setup *setup = converting->setup;
	const struct spec_image *input = converting->convert->input;
	struct spec_layers *layers = &converting->layers;
	int changes = setup->grid || setup->bands || setup->operations > 0 ||
		      setup->medium != SPEC_MEDIUM_UNKNOWN ||
		      setup->per != SPEC_CONVERT_AS_IT_IS;
	enum spec_status status = SPEC_OK;

	if (changes && !setup->bands_only && input->role == SPEC_ROLE_EMISSIVE)
		status = spec_layers_find(layers, input, converting->name, error);
	if (status != SPEC_OK)
		return status;
	converting->light =
		spec_memory_new((size_t)input->stokes + layers->films + layers->lamps + 1,
			sizeof *converting->light, "layers", error);
	if (!converting->light)
		return SPEC_ENOMEM;
	for (int i = 0; i < input->stokes; i++)
		add_light(converting, input->band_channel + (size_t)i * input->bands, i, "",
			0, "");
	for (size_t i = 0; i < layers->films; i++)
		add_light(converting, layers->film[i].mirror, 0, "film", i + 1, "mirror.");
	for (size_t i = 0; i < layers->lamps; i++)
		add_light(converting, layers->lamp[i].irradiance, 0, "lamp", i + 1, "");
	if (layers->through)
		add_light(converting, layers->through, 0, "through.", 0, "");
	return SPEC_OK;
}

static enum spec_status
check_quantity(const struct spec_converting *converting, struct spec_error *error)
{
	const struct spec_convert_setup *setup = converting->setup;

	if (setup->grid && !setup->rebin && converting->per_band &&
		setup->per != SPEC_CONVERT_PER_NM)
		return spec_error_set(error, SPEC_EUNSUPPORTED,
			"%s: its values are per band; they cannot be interpolated (--rebin, or "
			"--per nm)",
			converting->name);
	if (setup->per != SPEC_CONVERT_AS_IT_IS && !converting->per_band &&
		!strstr(converting->quantity, "per nm"))
		return spec_error_set(error, SPEC_EUSAGE,
			"%s: its values are '%s', which says neither per nm nor per band",
			converting->name, converting->quantity);
	return SPEC_OK;
}

static enum spec_status
check_medium(const struct spec_converting *converting, struct spec_error *error)
{
	const struct spec_image *input = converting->convert->input;
	enum spec_medium medium = converting->setup->medium;
	enum spec_status status;
	char *text;
	int same;

	if (medium == SPEC_MEDIUM_UNKNOWN)
		return SPEC_OK;
	if (input->bispectral > 0)
		return spec_error_set(error, SPEC_EUNSUPPORTED,
			"%s: is bispectral; its wavelengths cannot be changed (--illuminate it "
			"first)",
			converting->name);
	status = spec_image_text(input, "spec:medium", &text, error);
	if (status != SPEC_OK)
		return status;
	same = text && strcmp(text, spec_medium_name(medium)) == 0;
	free(text);
	return same ? spec_error_set(error, SPEC_EUSAGE,
			      "%s: its wavelengths are those in %s already",
			      converting->name, spec_medium_name(medium))
		    : SPEC_OK;
}

static enum spec_status
check_setup(struct spec_converting *converting, struct spec_error *error)
{
	const struct spec_convert_setup *setup = converting->setup;
	const struct spec_image *input = converting->convert->input;
	int spectral = setup->grid || setup->bands || setup->operations > 0 ||
		       setup->bands_only || setup->per != SPEC_CONVERT_AS_IT_IS ||
		       setup->medium != SPEC_MEDIUM_UNKNOWN;
	enum spec_status status;

	if (input->bands == 0 && spectral)
		return spec_error_set(error, SPEC_EFORMAT, "%s: has no spectral channel",
			converting->name);
	if (input->bispectral > 0 && (setup->grid || setup->bands))
		return spec_error_set(error, SPEC_EUNSUPPORTED,
			"%s: is bispectral; its grid cannot be changed (--illuminate it "
			"first)",
			converting->name);
	converting->quantity = spec_image_quantity(input, error);
	if (!converting->quantity)
		return SPEC_ENOMEM;
	converting->per_band = strstr(converting->quantity, "per band") != NULL;
	status = check_quantity(converting, error);
	return status == SPEC_OK ? check_medium(converting, error) : status;
}

/* All that is about bands; the windows are set. */
static enum spec_status
plan_bands(struct spec_converting *converting, struct spec_error *error)
{
	const struct spec_convert_setup *setup = converting->setup;
	enum spec_status status = gather_lights(converting, error);

	if (status == SPEC_OK)
		status = spec_converting_check(converting, error);
	converting->renewed = spec_converting_is_light(converting, setup->operations) !=
			      (converting->convert->input->role == SPEC_ROLE_EMISSIVE);
	if (status == SPEC_OK)
		status = spec_converting_bands(converting, error);
	if (status == SPEC_OK)
		status = set_channels(converting, error);
	return status == SPEC_OK ? set_attributes(converting, error) : status;
}

static void
free_converting(struct spec_converting *converting)
{
	free(converting->known.wavelength_nm);
	free(converting->known.edges_nm);
	free(converting->made.wavelength_nm);
	free(converting->made.edges_nm);
	free(converting->first);
	free(converting->band);
	free(converting->weight);
	free(converting->light);
	free(converting->quantity);
	spec_layers_free(&converting->layers);
}

enum spec_status
spec_convert_plan(struct spec_convert *convert, const struct spec_image *input,
	const struct spec_convert_setup *setup, const char *name, struct spec_error *error)
{
	struct spec_converting converting = {
		.convert = convert, .setup = setup, .name = name};
	enum spec_status status;

	*convert = (struct spec_convert){.input = input};
	status = check_setup(&converting, error);
	if (status == SPEC_OK)
		status = spec_image_copy(&convert->image, input, error);
	if (status == SPEC_OK)
		status = set_windows(convert, setup, name, error);
	if (status == SPEC_OK)
		status = input->bands > 0 ? plan_bands(&converting, error)
					  : spec_image_index(&convert->image, name, error);
	if (status == SPEC_OK)
		status = spec_converting_terms(&converting, error);
	if (status == SPEC_OK && convert->downsample > 1)
		status = count_samples(&converting, error);
	if (status == SPEC_OK && convert->downsample > 1)
		status = spec_reduce_plan(&convert->reduce, &convert->image, input,
			convert->downsample, convert->wanted, error);
	free_converting(&converting);
	if (status != SPEC_OK)
		spec_convert_free(convert);
	return status;
}

void
spec_convert_free(struct spec_convert *convert)
{
	spec_image_clear(&convert->image);
	spec_reduce_free(&convert->reduce);
	free(convert->first);
	free(convert->channel);
	free(convert->weight);
	free(convert->offset);
	free(convert->step);
	free(convert->after);
	free(convert->stepped);
	free(convert->wanted);
	*convert = (struct spec_convert){0};
}
