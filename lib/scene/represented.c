#include "scene/represented.h"

#include <float.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "base/memory.h"
#include "colour/observer.h"
#include "colour/space.h"
#include "colour/upsample.h"
#include "optics/index.h"
#include "spectrum/lookup.h"
#include "spectrum/operate.h"
#include "spectrum/represent.h"

#define COLOUR_SLACK 1e-6 /* of a component: what rounding leaves outside is no colour */

struct reading {
	const struct spec_arguments *arguments;
	const struct spec_parameter *parameter;
	enum spec_scene_use use;
};

/* Puts the place before an error of the spectrum room. */
static enum spec_status
place_error(const struct reading *reading, enum spec_status status)
{
	struct spec_error *error = reading->arguments->error;

	if (status == SPEC_OK || status == SPEC_ENOMEM)
		return status;
	if (error)
		return spec_arguments_fail(reading->arguments, reading->parameter, status,
			"is no spectrum: %.500s", error->message);
	return status;
}

/* ---- samples and series ---- */

/* The spectrum's parameter as a curve, with the parameter's name for a title. */
static enum spec_status
keep_curve(const struct reading *reading, struct spec_spectrum *from,
	struct spec_scene_spectrum *spectrum)
{
	struct spec_error *error = reading->arguments->error;
	enum spec_status status = spec_spectrum_to_curve(from, &spectrum->curve, error);

	spectrum->kind = SPEC_SCENE_CURVE;
	spec_spectrum_free(from);
	return status;
}

static enum spec_status
set_title(const struct reading *reading, struct spec_spectrum *spectrum)
{
	return spec_curve_set_text(
		&spectrum->title, reading->parameter->name, reading->arguments->error);
}

/* Samples, from the range on. */
static enum spec_status
make_samples(const struct reading *reading, const double *number, size_t count,
	struct spec_spectrum *spectrum)
{
	enum spec_status status = place_error(reading,
		spec_spectrum_sampled(number[0], number[1], number + 2, count,
			SPEC_INTERPOLATE_LINEAR, spectrum, reading->arguments->error));

	for (size_t i = 0; i < count && status == SPEC_OK; i++)
		if (!spec_scene_fits(reading->use, spectrum->value[i]))
			status = spec_scene_fail_value(reading->arguments,
				reading->parameter, reading->use, spectrum->value[i],
				spectrum->wavelength_nm[i]);
	return status == SPEC_OK ? set_title(reading, spectrum) : status;
}

/* The values that a use has: SPEC_SCENE_ETA's are above the least. */
static void
limits_of(enum spec_scene_use use, double *least, double *most)
{
	*least = 0;
	*most = use == SPEC_SCENE_REFLECTANCE ? 1
		: use == SPEC_SCENE_LIGHT     ? DBL_MAX
					      : SPEC_INDEX_LARGEST;
}

/* Clamps what leaves the values of its use, with a warning; lines stay. */
static enum spec_status
clamp_series(const struct reading *reading, struct spec_spectrum *spectrum)
{
	const struct spec_arguments *arguments = reading->arguments;
	struct spec_extremes extremes;
	struct spec_spectrum clamped;
	double least, most, worst, worst_nm;
	size_t lines;
	enum spec_status status =
		spec_spectrum_extremes(spectrum, &extremes, arguments->error);

	limits_of(reading->use, &least, &most);
	if (status != SPEC_OK || (spec_scene_fits(reading->use, extremes.least) &&
					 spec_scene_fits(reading->use, extremes.most)))
		return status;
	worst = extremes.least < least ? extremes.least : extremes.most;
	worst_nm = extremes.least < least ? extremes.least_nm : extremes.most_nm;
	if (reading->use == SPEC_SCENE_ETA)
		return spec_scene_fail_value(arguments, reading->parameter, reading->use,
			extremes.least <= 0 ? extremes.least : worst,
			extremes.least <= 0 ? extremes.least_nm : worst_nm);
	status = spec_scene_warn(arguments->scene,
		reading->parameter ? &reading->parameter->place : &arguments->place,
		arguments->error, "'%.60s' of %s is %s and %.3g at %.4g nm; it is clamped",
		reading->parameter ? reading->parameter->name : spectrum->title,
		arguments->statement, spec_scene_use_name(reading->use), worst, worst_nm);
	lines = spectrum->lines;
	spectrum->lines = 0;
	if (status == SPEC_OK)
		status = spec_spectrum_clamp(
			spectrum, least, most, &clamped, arguments->error);
	if (status != SPEC_OK)
		return status;
	status = spec_spectrum_add_lines(&clamped, spectrum->line, lines, arguments->error);
	spec_spectrum_free(spectrum);
	*spectrum = clamped;
	return status;
}

/* A series, from the range on. */
static enum spec_status
make_series(const struct reading *reading, const double *number, size_t count,
	struct spec_spectrum *spectrum)
{
	enum spec_status status =
		place_error(reading, spec_spectrum_fourier(number[0], number[1], number + 2,
					     count, spectrum, reading->arguments->error));

	if (status == SPEC_OK)
		status = set_title(reading, spectrum);
	return status == SPEC_OK ? clamp_series(reading, spectrum) : status;
}

static enum spec_status
read_samples(const struct reading *reading, struct spec_scene_spectrum *spectrum)
{
	const struct spec_parameter *parameter = reading->parameter;
	struct spec_spectrum samples = {0};
	enum spec_status status;

	if (parameter->count < 4)
		return spec_arguments_fail(reading->arguments, parameter, SPEC_EFORMAT,
			"needs the ends of a range in nm and two samples or more");
	status = make_samples(reading, parameter->number, parameter->count - 2, &samples);
	if (status == SPEC_OK)
		return keep_curve(reading, &samples, spectrum);
	spec_spectrum_free(&samples);
	return status;
}

static enum spec_status
read_series(const struct reading *reading, struct spec_scene_spectrum *spectrum)
{
	const struct spec_parameter *parameter = reading->parameter;
	enum spec_status status;

	if (parameter->count < 3 || parameter->count % 2 == 0)
		return spec_arguments_fail(reading->arguments, parameter, SPEC_EFORMAT,
			"needs the ends of a range in nm and an odd number of coefficients "
			"a0 a1 b1 a2 b2 and so on");
	spectrum->kind = SPEC_SCENE_SPECTRUM;
	status = make_series(
		reading, parameter->number, parameter->count - 2, &spectrum->spectrum);
	if (status != SPEC_OK || spectrum->spectrum.smooth == SPEC_SPECTRUM_FOURIER)
		return status;
	return keep_curve(reading, &spectrum->spectrum, spectrum);
}

/* ---- composites ---- */

/* Pairs of a wavelength and a weight. */
static enum spec_status
add_lines(const struct reading *reading, const double *number, size_t count,
	struct spec_spectrum *spectrum)
{
	const struct spec_arguments *arguments = reading->arguments;
	struct spec_line *line;
	enum spec_status status;

	if (count > 0 && reading->use != SPEC_SCENE_LIGHT)
		return spec_arguments_fail(arguments, reading->parameter, SPEC_ERANGE,
			"is %s, and only light has lines",
			spec_scene_use_name(reading->use));
	line = spec_memory_new(count, sizeof *line, "lines", arguments->error);
	status = line ? SPEC_OK : SPEC_ENOMEM;
	for (size_t i = 0; i < count && status == SPEC_OK; i++) {
		line[i] = (struct spec_line){number[2 * i], number[2 * i + 1]};
		if (!(line[i].weight >= 0))
			status = spec_arguments_fail(arguments, reading->parameter,
				SPEC_ERANGE, "has a line of negative weight: %g at %g nm",
				line[i].weight, line[i].wavelength_nm);
	}
	if (status == SPEC_OK)
		status = place_error(reading,
			spec_spectrum_add_lines(spectrum, line, count, arguments->error));
	free(line);
	return status;
}

static enum spec_status
read_composite(const struct reading *reading, struct spec_scene_spectrum *spectrum)
{
	const struct spec_parameter *parameter = reading->parameter;
	int series = parameter->type == SPEC_COMPOSITE_FOURIER;
	const char *what = series ? "coefficients" : "samples";
	double number = parameter->number[0];
	size_t count, rest;
	enum spec_status status;

	if (!(number >= 1 && number <= SPEC_SPECTRUM_MOST_SAMPLES &&
		    number == floor(number)))
		return spec_arguments_fail(reading->arguments, parameter, SPEC_EFORMAT,
			"begins with the number of its %s, not with %g", what, number);
	count = (size_t)number;
	if (parameter->count < 3 + count)
		return spec_arguments_fail(reading->arguments, parameter, SPEC_EFORMAT,
			"needs, after %zu, the ends of a range in nm and %zu %s", count,
			count, what);
	rest = parameter->count - 3 - count;
	if (rest % 2 != 0)
		return spec_arguments_fail(reading->arguments, parameter, SPEC_EFORMAT,
			"ends in %zu numbers that are no pairs of a wavelength and a "
			"weight",
			rest);
	spectrum->kind = SPEC_SCENE_SPECTRUM;
	status = (series ? make_series : make_samples)(
		reading, parameter->number + 1, count, &spectrum->spectrum);
	return status == SPEC_OK ? add_lines(reading, parameter->number + 3 + count,
					   rest / 2, &spectrum->spectrum)
				 : status;
}

/* ---- colours ---- */

/* XYZ of a curve, at the observer's wavelengths. */
static enum spec_status
find_xyz(const struct spec_curve *curve, int light, const double *wavelength_nm,
	const double *weight, size_t count, double xyz[3], struct spec_error *error)
{
	double *value = spec_memory_new(count, sizeof *value, "wavelengths", error);
	enum spec_status status =
		value ? spec_curve_sample(curve, 0,
				light ? SPEC_EXTRAPOLATE_ZERO : SPEC_EXTRAPOLATE_CONSTANT,
				wavelength_nm, count, value, error)
		      : SPEC_ENOMEM;

	for (size_t r = 0; r < 3 && status == SPEC_OK; r++) {
		xyz[r] = 0;
		for (size_t i = 0; i < count; i++)
			xyz[r] += weight[r * count + i] * value[i];
	}
	free(value);
	return status;
}

/* The weights of light at the upsampler's wavelengths, which are the observer's. */
static enum spec_status
weigh_light(
	const struct spec_upsampler *upsampler, double *weight, struct spec_error *error)
{
	struct spec_bands bands = {
		.count = upsampler->count, .wavelength_nm = upsampler->wavelength_nm};
	struct spec_curve observer;
	double outside;
	enum spec_status status =
		spec_lookup_curve(spec_observer_spectrum("1931"), &observer, error);

	if (status == SPEC_OK)
		status = spec_observer_weights(
			&observer, NULL, &bands, weight, &outside, error);
	spec_curve_free(&observer);
	return status;
}

static enum spec_status
find_rgb(const struct spec_curve *curve, int light, double rgb[3], struct spec_error *error)
{
	const struct spec_space *space = spec_space_find("srgb", error);
	struct spec_upsampler upsampler = {0};
	double from_xyz[9], xyz[3], *weight = NULL;
	enum spec_status status =
		space ? spec_upsampler_load(space, &upsampler, error) : SPEC_EUSAGE;

	if (status == SPEC_OK)
		status = spec_matrix_invert(upsampler.to_xyz, from_xyz, error);
	if (status == SPEC_OK && light) {
		weight = spec_memory_new(
			3 * upsampler.count, sizeof *weight, "weights", error);
		status = weight ? weigh_light(&upsampler, weight, error) : SPEC_ENOMEM;
	}
	if (status == SPEC_OK)
		status = find_xyz(curve, light, upsampler.wavelength_nm,
			light ? weight : upsampler.weight, upsampler.count, xyz, error);
	if (status == SPEC_OK)
		spec_matrix_apply(from_xyz, xyz, rgb);
	free(weight);
	spec_upsampler_free(&upsampler);
	return status;
}

/* Puts a colour into the values of its use, with a warning where it leaves them. */
static enum spec_status
clamp_rgb(const struct reading *reading, double rgb[3])
{
	const double whole[3] = {rgb[0], rgb[1], rgb[2]};
	double least, most, worst = 0, scale = fmax(rgb[0], fmax(rgb[1], rgb[2]));

	limits_of(reading->use, &least, &most);
	for (int i = 0; i < 3; i++) {
		rgb[i] = fmin(fmax(rgb[i], least), most);
		worst = fmax(worst, fabs(rgb[i] - whole[i]));
	}
	if (worst <= COLOUR_SLACK * fabs(scale))
		return SPEC_OK;
	return spec_scene_warn(reading->arguments->scene, &reading->parameter->place,
		reading->arguments->error,
		"'%.60s' of %s has a colour that sRGB has not, %.3g %.3g %.3g; it is clamped",
		reading->parameter->name, reading->arguments->statement, whole[0], whole[1],
		whole[2]);
}

static enum spec_status
read_colour(const struct reading *reading, struct spec_scene_spectrum *spectrum)
{
	struct spec_error *error = reading->arguments->error;
	enum spec_status status;

	if (reading->parameter->type == SPEC_RGB_FROM_SAMPLED) {
		status = read_samples(reading, spectrum);
	} else {
		status = spec_scene_read_table(
			reading->arguments, reading->parameter, &spectrum->curve);
		if (status == SPEC_OK)
			status = spec_scene_check_curve(reading->arguments,
				reading->parameter, reading->use, &spectrum->curve);
	}
	if (status != SPEC_OK)
		return status;
	status = find_rgb(
		&spectrum->curve, reading->use == SPEC_SCENE_LIGHT, spectrum->rgb, error);
	spec_curve_free(&spectrum->curve);
	spectrum->kind = SPEC_SCENE_RGB;
	if (status != SPEC_OK) {
		spec_scene_prefix(
			reading->arguments->scene, &reading->parameter->place, error);
		return status;
	}
	return clamp_rgb(reading, spectrum->rgb);
}

enum spec_status
spec_scene_keep_light(const struct spec_arguments *arguments,
	const struct spec_parameter *parameter, struct spec_spectrum *stored,
	struct spec_scene_spectrum *spectrum)
{
	struct reading reading = {arguments, parameter, SPEC_SCENE_LIGHT};
	struct spec_spectrum *light = &spectrum->spectrum;
	struct spec_extremes extremes;
	enum spec_status status;

	*light = *stored;
	*stored = (struct spec_spectrum){0};
	spectrum->kind = SPEC_SCENE_SPECTRUM;
	for (size_t i = 0; i < light->lines; i++)
		if (light->line[i].weight < 0)
			return spec_arguments_fail(arguments, parameter, SPEC_ERANGE,
				"has a line of negative weight: %g at %g nm",
				light->line[i].weight, light->line[i].wavelength_nm);
	if (light->smooth == SPEC_SPECTRUM_FOURIER)
		return clamp_series(&reading, light);
	status = spec_spectrum_extremes(light, &extremes, arguments->error);
	if (status == SPEC_OK && extremes.least < 0)
		status = spec_scene_fail_value(arguments, parameter, SPEC_SCENE_LIGHT,
			extremes.least, extremes.least_nm);
	return status;
}

enum spec_status
spec_scene_read_represented(const struct spec_arguments *arguments,
	const struct spec_parameter *parameter, enum spec_scene_use use,
	struct spec_scene_spectrum *spectrum)
{
	struct reading reading = {arguments, parameter, use};
	enum spec_status status;

	switch ((unsigned)parameter->type) {
	case SPEC_SAMPLED_SPECTRUM:
		return read_samples(&reading, spectrum);
	case SPEC_FOURIER_SPECTRUM:
		return read_series(&reading, spectrum);
	case SPEC_COMPOSITE_SAMPLED:
	case SPEC_COMPOSITE_FOURIER:
		return read_composite(&reading, spectrum);
	case SPEC_RGB_FROM_SAMPLED:
	case SPEC_RGB_FROM_TABULATED:
		return read_colour(&reading, spectrum);
	default:
		break;
	}
	spectrum->kind = SPEC_SCENE_CURVE;
	status = spec_scene_read_table(arguments, parameter, &spectrum->curve);
	return status == SPEC_OK
		       ? spec_scene_check_curve(arguments, parameter, use, &spectrum->curve)
		       : status;
}
