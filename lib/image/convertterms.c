/* The operations of a conversion, as weights and addends of each channel of the output. */
#include <math.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "base/memory.h"
#include "image/converting.h"
#include "image/names.h"
#include "spectrum/product.h"

/* What a value is multiplied by, and what is added then. */
struct affine {
	double factor, addend;
};

int
spec_converting_is_light(const struct spec_converting *converting, size_t at)
{
	int light = converting->convert->input->role == SPEC_ROLE_EMISSIVE;

	for (size_t i = 0; i < at; i++) {
		enum spec_operation_kind kind = converting->setup->operation[i].kind;

		if (kind == SPEC_OPERATION_ILLUMINATE)
			light = 1;
		if (kind == SPEC_OPERATION_REFLECTANCE_OF)
			light = 0;
	}
	return light;
}

static enum spec_status
check_illuminate(
	const struct spec_converting *converting, size_t at, struct spec_error *error)
{
	if (spec_converting_is_light(converting, at))
		return spec_error_set(error, SPEC_EUSAGE,
			"%s: only reflectance (T) can be illuminated", converting->name);
	return SPEC_OK;
}

static enum spec_status
check_reflectance_of(
	const struct spec_converting *converting, size_t at, struct spec_error *error)
{
	const struct spec_image *input = converting->convert->input;
	const struct spec_operation *operation = &converting->setup->operation[at];
	const char *name = converting->name;

	if (input->role != SPEC_ROLE_EMISSIVE || !spec_converting_is_light(converting, at))
		return spec_error_set(error, SPEC_EUSAGE,
			"%s: only light (S0) has a reflectance under a light", name);
	if (input->stokes > 1)
		return spec_error_set(error, SPEC_EUNSUPPORTED,
			"%s: is polarised, which reflectance (T) cannot say", name);
	if (converting->layers.films > 0 || converting->layers.lamps > 0)
		return spec_error_set(error, SPEC_EUNSUPPORTED,
			"%s: has light layers, which reflectance (T) cannot have "
			"(--bands-only drops them)",
			name);
	if (spec_converting_to_band(converting) !=
		(strstr(operation->curve.quantity, "per band") != NULL))
		return spec_error_set(error, SPEC_EUSAGE,
			"%s: its values are per %s, those of '%s' are not (--per)", name,
			spec_converting_to_band(converting) ? "band" : "nm",
			spec_operation_name(operation));
	return SPEC_OK;
}

/* The image as a curve's texts: what can be added to it. */
static enum spec_status
check_add(const struct spec_converting *converting, size_t at, struct spec_error *error)
{
	const struct spec_operation *operation = &converting->setup->operation[at];
	const struct spec_curve *curve = &operation->curve;
	const char *name = spec_operation_name(operation);
	int light = spec_converting_is_light(converting, at),
	    per_band = spec_converting_to_band(converting);

	if (curve->quantity[0] == '\0')
		return SPEC_OK;
	if (light ? !spec_curve_is_light(curve) : !spec_curve_is_ratio(curve))
		return spec_error_set(error, SPEC_EUSAGE,
			"%s: is %s, '%s' a %s: they cannot be added", converting->name,
			light ? "light" : "a reflectance or transmittance", name,
			curve->quantity);
	for (size_t i = 0; light && i < at; i++) {
		const struct spec_operation *before = &converting->setup->operation[i];

		if (before->kind == SPEC_OPERATION_RAISE && before->number != 1)
			return spec_error_set(error, SPEC_EUSAGE,
				"%s: light to the power of %g and '%s' cannot be added",
				converting->name, before->number, name);
	}
	if (light && (strstr(curve->quantity, "per band") != NULL) != per_band)
		return spec_error_set(error, SPEC_EUSAGE,
			"%s: its values are per %s, those of '%s' are not: they cannot be "
			"added (--per)",
			converting->name, per_band ? "band" : "nm", name);
	return SPEC_OK;
}

/* What is neither a factor nor, of light alone, added. */
static enum spec_status
check_shape(const struct spec_converting *converting, size_t at, struct spec_error *error)
{
	const struct spec_image *input = converting->convert->input;
	int adds = converting->setup->operation[at].kind == SPEC_OPERATION_ADD;
	int lit = spec_converting_is_light(converting, at);

	if (input->bispectral > 0 && !lit)
		return spec_error_set(error, SPEC_EUNSUPPORTED,
			"%s: is bispectral; --add, --raise and --clamp need light "
			"(--illuminate it first)",
			converting->name);
	if (!adds && input->stokes > 1)
		return spec_error_set(error, SPEC_EUNSUPPORTED,
			"%s: is polarised, and --raise and --clamp of Stokes components mean "
			"nothing",
			converting->name);
	if (!adds && (converting->layers.films > 0 || converting->layers.lamps > 0))
		return spec_error_set(error, SPEC_EUNSUPPORTED,
			"%s: has light layers, which come before --raise and --clamp "
			"(specfilm, specdisc)",
			converting->name);
	return SPEC_OK;
}

static enum spec_status
check_operation(
	const struct spec_converting *converting, size_t at, struct spec_error *error)
{
	enum spec_status status;

	switch (converting->setup->operation[at].kind) {
	case SPEC_OPERATION_ILLUMINATE:
		return check_illuminate(converting, at, error);
	case SPEC_OPERATION_REFLECTANCE_OF:
		return check_reflectance_of(converting, at, error);
	case SPEC_OPERATION_ADD:
		status = check_shape(converting, at, error);
		return status == SPEC_OK ? check_add(converting, at, error) : status;
	case SPEC_OPERATION_RAISE:
	case SPEC_OPERATION_CLAMP:
		return check_shape(converting, at, error);
	default:
		return SPEC_OK;
	}
}

enum spec_status
spec_converting_check(const struct spec_converting *converting, struct spec_error *error)
{
	enum spec_status status = SPEC_OK;

	for (size_t i = 0; i < converting->setup->operations && status == SPEC_OK; i++)
		status = check_operation(converting, i, error);
	return status;
}

static enum spec_status
sample(const struct spec_converting *converting, const struct spec_operation *operation,
	double wavelength_nm, double *value, struct spec_error *error)
{
	return spec_curve_sample(&operation->curve, 0, converting->setup->extrapolate,
		&wavelength_nm, 1, value, error);
}

/* Adds " 400" to a list of wavelengths, or " ..." once where there is no more room. */
static void
list_wavelength(char *list, size_t size, double wavelength_nm)
{
	size_t length = strlen(list);

	if (length + 20 < size)
		snprintf(list + length, size - length, " %g", wavelength_nm);
	else if (list[length - 1] != '.')
		snprintf(list + length, size - length, " ...");
}

/* Takes those bands away for which keep is 0. */
static void
take_away(struct spec_converting_bands *bands, const unsigned char *keep)
{
	size_t first = 0, kept = 0, last = 0;

	for (size_t i = 0; i < bands->count; i++) {
		if (!keep[i])
			continue;
		first = kept == 0 ? i : first;
		last = i;
		bands->wavelength_nm[kept++] = bands->wavelength_nm[i];
	}
	/* Bins with a gap between them cannot be told. */
	if (bands->edges_nm && last - first + 1 != kept) {
		free(bands->edges_nm);
		bands->edges_nm = NULL;
	}
	if (bands->edges_nm)
		memmove(bands->edges_nm, bands->edges_nm + first,
			(kept + 1) * sizeof *bands->edges_nm);
	bands->count = kept;
}

static enum spec_status
drop_below(struct spec_converting *converting, const struct spec_operation *operation,
	unsigned char *keep, double *power, struct spec_error *error)
{
	struct spec_converting_bands *made = &converting->made;
	enum spec_status status = SPEC_OK;
	double most = 0;
	size_t kept = 0;
	char dropped[400] = "";

	for (size_t i = 0; i < made->count && status == SPEC_OK; i++) {
		status = sample(
			converting, operation, made->wavelength_nm[i], &power[i], error);
		most = fmax(most, power[i]);
	}
	if (status != SPEC_OK)
		return status;
	for (size_t i = 0; i < made->count; i++) {
		keep[i] = power[i] > 0 && power[i] >= converting->setup->least * most;
		kept += keep[i];
		if (!keep[i])
			list_wavelength(dropped, sizeof dropped, made->wavelength_nm[i]);
	}
	if (kept == 0)
		return spec_error_set(error, SPEC_ERANGE,
			"%s: '%s' is dark in all its bands", converting->name,
			spec_operation_name(operation));
	if (kept == made->count)
		return SPEC_OK;
	spec_converting_note(converting,
		"%s: without the bands at%s nm, where '%.100s' is below %g of its most",
		converting->name, dropped, spec_operation_name(operation),
		converting->setup->least);
	converting->renewed = 1;
	take_away(made, keep);
	return SPEC_OK;
}

enum spec_status
spec_converting_drop_dark(struct spec_converting *converting, struct spec_error *error)
{
	const struct spec_convert_setup *setup = converting->setup;
	enum spec_status status = SPEC_OK;
	unsigned char *keep;
	double *power;
	size_t at = 0;

	while (at < setup->operations &&
		setup->operation[at].kind != SPEC_OPERATION_REFLECTANCE_OF)
		at++;
	if (at == setup->operations)
		return SPEC_OK;
	keep = spec_memory_new(converting->made.count, 1, "bands", error);
	power = spec_memory_new(converting->made.count, sizeof *power, "bands", error);
	status = keep && power
			 ? drop_below(converting, &setup->operation[at], keep, power, error)
			 : SPEC_ENOMEM;
	free(keep);
	free(power);
	return status;
}

/* What an operation with a curve or a factor makes of a value so far. */
static enum spec_status
apply(const struct spec_converting *converting, const struct spec_operation *operation,
	double wavelength_nm, int adds, struct affine *so_far, struct spec_error *error)
{
	double value = operation->number;
	enum spec_status status = SPEC_OK;

	if (operation->kind != SPEC_OPERATION_SCALE)
		status = sample(converting, operation, wavelength_nm, &value, error);
	if (status != SPEC_OK)
		return status;
	if (operation->kind == SPEC_OPERATION_ADD) {
		so_far->addend += adds ? value : 0;
		return SPEC_OK;
	}
	if (operation->kind == SPEC_OPERATION_DIVIDE ||
		operation->kind == SPEC_OPERATION_REFLECTANCE_OF) {
		if (value == 0)
			return spec_error_set(error, SPEC_ERANGE,
				"unable to divide by '%.200s': it is 0 at %.10g nm",
				spec_operation_name(operation), wavelength_nm);
		so_far->factor /= value;
		so_far->addend /= value;
		return SPEC_OK;
	}
	so_far->factor *= value;
	so_far->addend *= value;
	return SPEC_OK;
}

/*
 * The operations at a wavelength: chain[0] on the sum, chain[i] after the i-th step. adds:
 * to this channel light is added. lit: also by what illuminates.
 */
static enum spec_status
fold(const struct spec_converting *converting, double wavelength_nm, int adds, int lit,
	struct affine *chain, struct spec_error *error)
{
	const struct spec_convert_setup *setup = converting->setup;
	enum spec_status status = SPEC_OK;

	*chain = (struct affine){.factor = 1};
	for (size_t i = 0; i < setup->operations && status == SPEC_OK; i++) {
		const struct spec_operation *operation = &setup->operation[i];

		if (!spec_operation_is_affine(operation))
			*++chain = (struct affine){.factor = 1};
		else if (lit || operation->kind != SPEC_OPERATION_ILLUMINATE)
			status = apply(
				converting, operation, wavelength_nm, adds, chain, error);
	}
	return status;
}

static enum spec_status
add_term(struct spec_convert *convert, size_t channel, double weight,
	struct spec_error *error)
{
	void *channels = convert->channel, *weights = convert->weight;
	enum spec_status status = spec_memory_grow(&channels, &convert->channel_room,
		convert->terms + 1, sizeof *convert->channel, "weights", error);

	convert->channel = channels;
	if (status == SPEC_OK)
		status = spec_memory_grow(&weights, &convert->weight_room,
			convert->terms + 1, sizeof *convert->weight, "weights", error);
	convert->weight = weights;
	if (status != SPEC_OK)
		return status;
	convert->channel[convert->terms] = channel;
	convert->weight[convert->terms] = weight;
	convert->wanted[channel] = 1;
	convert->terms++;
	return SPEC_OK;
}

/* Light that comes in at other wavelengths and leaves at this one. */
static enum spec_status
add_reradiated_terms(struct spec_converting *converting,
	const struct spec_operation *illuminate, size_t band, double factor,
	struct spec_error *error)
{
	const struct spec_image *input = converting->convert->input;
	enum spec_status status = SPEC_OK;

	for (size_t i = 0; i < input->channels && status == SPEC_OK; i++) {
		const struct spec_channel *channel = &input->channel[i];
		double power;
		int same;

		if (channel->role != SPEC_ROLE_BISPECTRAL ||
			spec_image_nearest_band(input, channel->reradiated_nm, &same) !=
				band)
			continue;
		status = sample(
			converting, illuminate, channel->wavelength_nm, &power, error);
		if (status == SPEC_OK)
			status = add_term(converting->convert, i, factor * power, error);
	}
	return status;
}

static const struct spec_operation *
find_illuminate(const struct spec_convert_setup *setup)
{
	for (size_t i = 0; i < setup->operations; i++)
		if (setup->operation[i].kind == SPEC_OPERATION_ILLUMINATE)
			return &setup->operation[i];
	return NULL;
}

/* A band of light or of reflectance in the output: channel is the output's. */
static enum spec_status
add_light_terms(struct spec_converting *converting, size_t channel,
	const struct spec_converting_light *light, size_t made, struct affine *chain,
	struct spec_error *error)
{
	struct spec_convert *convert = converting->convert;
	const struct spec_operation *illuminate = find_illuminate(converting->setup);
	double wavelength_nm = converting->made.wavelength_nm[made];
	int adds = !light->is_layer && light->stokes == 0;
	enum spec_status status = fold(converting, wavelength_nm, adds, 1, chain, error);

	if (status != SPEC_OK)
		return status;
	convert->offset[channel] = chain[0].addend;
	convert->stepped[channel] = convert->steps > 0;
	for (size_t i = 0; i < convert->steps; i++) {
		double *after = convert->after + (channel * convert->steps + i) * 2;

		after[0] = chain[i + 1].factor;
		after[1] = chain[i + 1].addend;
	}
	for (size_t t = converting->first[made];
		t < converting->first[made + 1] && status == SPEC_OK; t++)
		status = add_term(convert, light->channel[converting->band[t]],
			chain[0].factor * converting->weight[t], error);
	if (status != SPEC_OK || !illuminate || convert->input->bispectral == 0)
		return status;
	status = fold(converting, wavelength_nm, adds, 0, chain, error);
	if (status != SPEC_OK)
		return status;
	/* The grid of such an image stays: a band is made of itself. */
	return add_reradiated_terms(converting, illuminate,
		converting->band[converting->first[made]], chain[0].factor, error);
}

/* The input's channel that a channel of the output was, by its name or by its bands. */
static size_t
find_origin(const struct spec_image *input, const struct spec_channel *channel)
{
	size_t found = spec_image_find_channel(input, channel->name);

	for (size_t i = 0; found == input->channels && i < input->channels; i++) {
		const struct spec_channel *other = &input->channel[i];

		if (other->role == channel->role &&
			fabs(other->wavelength_nm - channel->wavelength_nm) < 1e-6 &&
			fabs(other->reradiated_nm - channel->reradiated_nm) < 1e-6)
			found = i;
	}
	return found;
}

/* A variance goes by the square of what its band is multiplied by. */
static enum spec_status
add_variance_term(struct spec_converting *converting, size_t origin, size_t band,
	struct affine *chain, struct spec_error *error)
{
	enum spec_status status =
		fold(converting, converting->made.wavelength_nm[band], 0, 1, chain, error);
	double factor = chain[0].factor * converting->weight[converting->first[band]] /
			converting->convert->downsample;

	return status == SPEC_OK
		       ? add_term(converting->convert, origin, factor * factor, error)
		       : status;
}

/* Foreign channels, and those off the diagonal. */
static enum spec_status
add_other_terms(struct spec_converting *converting, size_t at, struct affine *chain,
	struct spec_error *error)
{
	struct spec_convert *convert = converting->convert;
	const struct spec_channel *channel = &convert->image.channel[at];
	size_t band, origin = spec_converting_find_variance(converting, at, &band);
	enum spec_status status = SPEC_OK;

	if (origin < convert->input->channels)
		return add_variance_term(converting, origin, band, chain, error);
	origin = find_origin(convert->input, channel);

	chain[0] = (struct affine){.factor = 1};
	if (channel->role == SPEC_ROLE_BISPECTRAL)
		status = fold(converting, channel->reradiated_nm, 0, 1, chain, error);
	return status == SPEC_OK ? add_term(convert, origin, chain[0].factor, error)
				 : status;
}

/* Which channels of the output are bands of light: number light * made + band, or none. */
static enum spec_status
find_lights(
	const struct spec_converting *converting, size_t *place, struct spec_error *error)
{
	const struct spec_image *image = &converting->convert->image,
				*input = converting->convert->input;
	size_t bands = converting->made.count;
	char name[128];

	for (size_t i = 0; i < image->channels; i++)
		place[i] = SPEC_LAYERS_NONE;
	for (size_t i = 0; i < converting->lights * bands; i++) {
		const struct spec_converting_light *light = &converting->light[i / bands];
		size_t band = i % bands, channel;

		if (!light->is_layer) {
			channel = image->band_channel[(size_t)light->stokes * bands + band];
		} else if (converting->renewed) {
			int length = snprintf(name, sizeof name, "%s", light->prefix);

			spec_names_write(name + length, sizeof name - (size_t)length,
				SPEC_ROLE_EMISSIVE, 0, converting->made.wavelength_nm[band],
				0);
			channel = spec_image_find_channel(image, name);
		} else {
			channel = spec_image_find_channel(
				image, input->channel[light->channel[band]].name);
		}
		if (channel == image->channels)
			return spec_error_set(error, SPEC_EFORMAT,
				"%s: a band of '%s' cannot be told from others",
				converting->name, light->prefix);
		place[channel] = i;
	}
	return SPEC_OK;
}

/* Room for what is known of each channel of the output, and the steps. */
static enum spec_status
make_room(struct spec_converting *converting, struct spec_error *error)
{
	struct spec_convert *convert = converting->convert;
	const struct spec_convert_setup *setup = converting->setup;
	size_t channels = convert->image.channels;

	convert->step =
		spec_memory_new(setup->operations, sizeof *convert->step, "steps", error);
	for (size_t i = 0; convert->step && i < setup->operations; i++) {
		const struct spec_operation *operation = &setup->operation[i];

		if (!spec_operation_is_affine(operation))
			convert->step[convert->steps++] = (struct spec_convert_step){
				.raises = operation->kind == SPEC_OPERATION_RAISE,
				.power = operation->number,
				.low = operation->low,
				.high = operation->high};
	}
	convert->first =
		spec_memory_new(channels + 1, sizeof *convert->first, "channels", error);
	convert->offset =
		spec_memory_new(channels, sizeof *convert->offset, "channels", error);
	convert->stepped = spec_memory_new(channels, 1, "channels", error);
	convert->after = spec_memory_new(channels * (convert->steps + 1),
		2 * sizeof *convert->after, "channels", error);
	convert->wanted = spec_memory_new(convert->input->channels, 1, "channels", error);
	return convert->step && convert->first && convert->offset && convert->stepped &&
			       convert->after && convert->wanted
		       ? SPEC_OK
		       : SPEC_ENOMEM;
}

enum spec_status
spec_converting_terms(struct spec_converting *converting, struct spec_error *error)
{
	struct spec_convert *convert = converting->convert;
	size_t channels = convert->image.channels, bands = converting->made.count;
	enum spec_status status = make_room(converting, error);
	size_t *place = spec_memory_new(channels, sizeof *place, "channels", error);
	struct affine *chain =
		spec_memory_new(convert->steps + 1, sizeof *chain, "steps", error);

	if (!place || !chain)
		status = SPEC_ENOMEM;
	if (status == SPEC_OK)
		status = find_lights(converting, place, error);
	for (size_t i = 0; i < channels && status == SPEC_OK; i++) {
		convert->first[i] = convert->terms;
		status = place[i] == SPEC_LAYERS_NONE
				 ? add_other_terms(converting, i, chain, error)
				 : add_light_terms(converting, i,
					   &converting->light[place[i] / bands],
					   place[i] % bands, chain, error);
	}
	if (status == SPEC_OK)
		convert->first[channels] = convert->terms;
	free(place);
	free(chain);
	return status;
}
