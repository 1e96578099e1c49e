#include "scene/spectra.h"

#include <float.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "optics/index.h"
#include "scene/paths.h"
#include "scene/represented.h"
#include "spectrum/curve.h"
#include "spectrum/lookup.h"
#include "spectrum/spd.h"
#include "spectrum/store.h"

/* Where values of a use lie. */
static const struct {
	const char *what;
	double least, most;
	int above; /* the least itself is not allowed */
} ranges[] = {{"a reflectance", 0, 1, 0}, {"light", 0, DBL_MAX, 0},
	{"a refractive index", 0, SPEC_INDEX_LARGEST, 1},
	{"an extinction coefficient", 0, SPEC_INDEX_LARGEST, 0}};

int
spec_scene_fits(enum spec_scene_use use, double value)
{
	return value >= ranges[use].least && value <= ranges[use].most &&
	       (value > ranges[use].least || !ranges[use].above);
}

enum spec_status
spec_scene_fail_value(const struct spec_arguments *arguments,
	const struct spec_parameter *parameter, enum spec_scene_use use, double value,
	double wavelength_nm)
{
	char where[40] = "";
	const char *what = ranges[use].what;

	if (wavelength_nm > 0)
		snprintf(where, sizeof where, " at %g nm", wavelength_nm);
	if (ranges[use].above && value <= 0)
		return spec_arguments_fail(arguments, parameter, SPEC_ERANGE,
			"is %s that is not positive: %g%s", what, value, where);
	if (ranges[use].most == DBL_MAX)
		return spec_arguments_fail(arguments, parameter, SPEC_ERANGE,
			"is %s that is negative: %g%s", what, value, where);
	return spec_arguments_fail(arguments, parameter, SPEC_ERANGE,
		"is %s outside %g..%g: %g%s", what, ranges[use].least, ranges[use].most,
		value, where);
}

const char *
spec_scene_use_name(enum spec_scene_use use)
{
	return ranges[use].what;
}

/* ---- curves ---- */

enum spec_status
spec_scene_check_curve(const struct spec_arguments *arguments,
	const struct spec_parameter *parameter, enum spec_scene_use use,
	const struct spec_curve *curve)
{
	for (size_t i = 0; i < curve->count; i++)
		if (!spec_scene_fits(use, curve->value[i]))
			return spec_scene_fail_value(arguments, parameter, use,
				curve->value[i], curve->wavelength_nm[i]);
	return SPEC_OK;
}

enum spec_status
spec_scene_read_table(const struct spec_arguments *arguments,
	const struct spec_parameter *parameter, struct spec_curve *curve)
{
	const double *number = parameter->number;
	size_t count = parameter->count / 2;
	enum spec_status status;

	if (parameter->count % 2 != 0 || count < 2)
		return spec_arguments_fail(arguments, parameter, SPEC_EFORMAT,
			"needs pairs of a wavelength and a value, two of them or more");
	for (size_t i = 0; i < count; i++)
		if (!(number[2 * i] > (i > 0 ? number[2 * i - 2] : 0)))
			return spec_arguments_fail(arguments, parameter, SPEC_EFORMAT,
				"has wavelengths that are not positive and ascending: %g "
				"nm",
				number[2 * i]);
	status = spec_curve_new(count, 1, curve, arguments->error);
	for (size_t i = 0; status == SPEC_OK && i < count; i++) {
		curve->wavelength_nm[i] = number[2 * i];
		curve->value[i] = number[2 * i + 1];
	}
	if (status == SPEC_OK)
		status = spec_curve_set_text(
			&curve->title, parameter->name, arguments->error);
	return status;
}

/* What remains of a curve is one of its columns. */
static enum spec_status
keep_column(struct spec_curve *curve, size_t column, struct spec_error *error)
{
	struct spec_curve kept;
	enum spec_status status;

	if (curve->columns == 1)
		return SPEC_OK;
	status = spec_curve_new(curve->count, 1, &kept, error);
	if (status == SPEC_OK)
		status = spec_curve_set_text(&kept.title, curve->title, error);
	if (status == SPEC_OK)
		status = spec_curve_set_text(&kept.quantity, curve->quantity, error);
	if (status == SPEC_OK)
		status = spec_curve_set_text(&kept.unit, curve->unit, error);
	if (status == SPEC_OK)
		status = spec_curve_set_text(&kept.source, curve->source, error);
	if (status == SPEC_OK)
		status = spec_curve_set_text(&kept.medium, curve->medium, error);
	if (status == SPEC_OK)
		status = spec_curve_set_text(&kept.column[0], curve->column[column], error);
	if (status != SPEC_OK) {
		spec_curve_free(&kept);
		return status;
	}
	memcpy(kept.wavelength_nm, curve->wavelength_nm,
		curve->count * sizeof *kept.wavelength_nm);
	memcpy(kept.value, curve->value + column * curve->count,
		curve->count * sizeof *kept.value);
	spec_curve_free(curve);
	*curve = kept;
	return SPEC_OK;
}

/* The column of a curve that a use wants; columns: the curve is something else. */
static size_t
find_column(const struct spec_curve *curve, enum spec_scene_use use)
{
	int unstated = curve->quantity[0] == '\0';
	size_t column;

	if (use == SPEC_SCENE_LIGHT)
		return spec_curve_is_light(curve) ? 0 : curve->columns;
	if (use == SPEC_SCENE_REFLECTANCE)
		return unstated || spec_curve_is_ratio(curve) ? 0 : curve->columns;
	if (!unstated && strcmp(curve->quantity, "refractive index") != 0)
		return curve->columns;
	column = spec_curve_find_column(curve, use == SPEC_SCENE_ETA ? "n" : "k");
	/* Plain pairs, as pbrt has them. */
	return column == curve->columns && unstated && column == 1 ? 0 : column;
}

/* ---- names ---- */

/* Names of pbrt's that are others in spectra/. */
static const struct {
	const char *name, *ours, *hint;
} renamed[] = {{"glass-BK7", "glass/N-BK7", NULL}, {"glass-F10", "glass/SF10", NULL},
	{"glass-F11", "glass/SF11", NULL},
	{"glass-F5", NULL,
		"pbrt's table of that name is of SCHOTT SF5; F5 itself is \"glass/F5\""}};

/*
 * Our name for one of pbrt's: 1, or 0 if it is none of pbrt's; *hint: why it is not ours.
 * *column, where the name says it: "n" or "k".
 */
static int
translate(const char *name, char *ours, size_t size, const char **column, const char **hint)
{
	size_t length = strlen(name);

	*column = *hint = NULL;
	for (size_t i = 0; i < sizeof renamed / sizeof *renamed; i++) {
		if (strcmp(renamed[i].name, name) != 0)
			continue;
		*hint = renamed[i].hint;
		snprintf(ours, size, "%s", *hint ? "" : renamed[i].ours);
		return 1;
	}
	if (strncmp(name, "metal-", 6) == 0 && length > 10 &&
		strcmp(name + length - 4, "-eta") == 0) {
		*column = "n";
		snprintf(ours, size, "metals/%.*s", (int)length - 10, name + 6);
	} else if (strncmp(name, "metal-", 6) == 0 && length > 8 &&
		   strcmp(name + length - 2, "-k") == 0) {
		*column = "k";
		snprintf(ours, size, "metals/%.*s", (int)length - 8, name + 6);
	} else if (strncmp(name, "glass-", 6) == 0) {
		snprintf(ours, size, "glass/%s", name + 6);
	} else if (strncmp(name, "stdillum-", 9) == 0) {
		snprintf(ours, size, "illuminants/%s", name + 9);
	} else {
		return 0;
	}
	return 1;
}

/* The path of the file that a name stands for, to be freed. */
static enum spec_status
find(const struct spec_arguments *arguments, const struct spec_parameter *parameter,
	const char *name, char **path)
{
	enum spec_status status = SPEC_OK;

	*path = NULL;
	if (spec_lookup_is_path(name)) {
		status = spec_scene_find_file(arguments->scene,
			spec_arguments_place(arguments, parameter), name, path,
			arguments->error);
		if (status != SPEC_OK || *path)
			return status;
	}
	status = spec_lookup_path(name, path, arguments->error);
	return spec_arguments_blame(arguments, parameter, status);
}

static enum spec_status
find_named(const struct spec_arguments *arguments, const struct spec_parameter *parameter,
	const char *name, enum spec_scene_use use, char **path)
{
	const char *column, *hint;
	char ours[128] = "";
	enum spec_status status;

	if (!translate(name, ours, sizeof ours, &column, &hint))
		return find(arguments, parameter, name, path);
	if (column && (use != SPEC_SCENE_ETA || *column != 'n') &&
		(use != SPEC_SCENE_K || *column != 'k'))
		return spec_arguments_fail(arguments, parameter, SPEC_EUSAGE,
			"is %s, which '%.60s' is not", ranges[use].what, name);
	status = hint ? SPEC_EUSAGE : spec_lookup_path(ours, path, arguments->error);
	if (status == SPEC_EUSAGE)
		return spec_arguments_fail(arguments, parameter, SPEC_EUNSUPPORTED,
			"is '%.60s', which is not among our spectra%s%s", name,
			hint ? ": " : "", hint ? hint : "");
	return spec_arguments_blame(arguments, parameter, status);
}

/* A curve in place of what a file holds; a Fourier series or lines of light stay. */
static enum spec_status
load(const struct spec_arguments *arguments, const struct spec_parameter *parameter,
	const char *path, enum spec_scene_use use, struct spec_scene_spectrum *spectrum)
{
	struct spec_spectrum stored = {0};
	enum spec_status status = spec_spectrum_load(path, &stored, arguments->error);

	if (status == SPEC_OK && use == SPEC_SCENE_LIGHT &&
		(stored.lines > 0 || !stored.wavelength_nm))
		return spec_scene_keep_light(arguments, parameter, &stored, spectrum);
	spec_spectrum_free(&stored);
	if (status == SPEC_OK)
		status = spec_spd_load(path, &spectrum->curve, arguments->error);
	spectrum->kind = SPEC_SCENE_CURVE;
	return spec_arguments_blame(arguments, parameter, status);
}

/* What is computed and has no file. */
static enum spec_status
compute(const struct spec_arguments *arguments, const struct spec_parameter *parameter,
	const char *name, struct spec_scene_spectrum *spectrum)
{
	enum spec_status status =
		spec_lookup_curve(name, &spectrum->curve, arguments->error);

	spectrum->kind = SPEC_SCENE_CURVE;
	return spec_arguments_blame(arguments, parameter, status);
}

static enum spec_status
read_named(const struct spec_arguments *arguments, const struct spec_parameter *parameter,
	const char *name, enum spec_scene_use use, struct spec_scene_spectrum *spectrum)
{
	struct spec_curve *curve = &spectrum->curve, quantity;
	char *path = NULL;
	enum spec_status status;
	size_t column;

	if (spec_lookup_is_computed(name)) {
		status = compute(arguments, parameter, name, spectrum);
	} else {
		status = find_named(arguments, parameter, name, use, &path);
		if (status == SPEC_OK)
			status = load(arguments, parameter, path, use, spectrum);
		free(path);
	}
	if (status != SPEC_OK)
		return status;
	if (spectrum->kind == SPEC_SCENE_SPECTRUM) {
		quantity = (struct spec_curve){.quantity = spectrum->spectrum.quantity};
		if (spec_curve_is_light(&quantity))
			return SPEC_OK;
	}
	column = curve->count > 0 ? find_column(curve, use) : curve->columns;
	if (column == curve->columns)
		return spec_arguments_fail(arguments, parameter, SPEC_EUSAGE,
			"is %s, which '%.60s' is not", ranges[use].what, name);
	status = keep_column(curve, column, arguments->error);
	if (status == SPEC_OK)
		status = spec_scene_check_curve(arguments, parameter, use, curve);
	return status;
}

/* ---- all of them ---- */

static enum spec_status
read_numbers(const struct spec_arguments *arguments, const struct spec_parameter *parameter,
	enum spec_scene_use use, struct spec_scene_spectrum *spectrum)
{
	int rgb = parameter->type == SPEC_RGB || parameter->type == SPEC_RGB_SPECTRUM;

	if (parameter->count != (rgb ? 3 : 1))
		return spec_arguments_fail(arguments, parameter, SPEC_EFORMAT,
			"takes %d value%s, not %zu", rgb ? 3 : 1, rgb ? "s" : "",
			parameter->count);
	for (size_t i = 0; i < parameter->count; i++)
		if (!spec_scene_fits(use, parameter->number[i]))
			return spec_scene_fail_value(
				arguments, parameter, use, parameter->number[i], 0);
	spectrum->kind = rgb ? SPEC_SCENE_RGB : SPEC_SCENE_CONSTANT;
	if (rgb)
		memcpy(spectrum->rgb, parameter->number, sizeof spectrum->rgb);
	else
		spectrum->value = parameter->number[0];
	return SPEC_OK;
}

static enum spec_status
read_blackbody(const struct spec_arguments *arguments,
	const struct spec_parameter *parameter, enum spec_scene_use use,
	struct spec_scene_spectrum *spectrum)
{
	enum spec_status status = spec_arguments_only(arguments, parameter);

	if (status != SPEC_OK)
		return status;
	if (use != SPEC_SCENE_LIGHT)
		return spec_arguments_fail(arguments, parameter, SPEC_EFORMAT,
			"is %s, which a blackbody is not", ranges[use].what);
	if (!(parameter->number[0] > 0))
		return spec_arguments_fail(arguments, parameter, SPEC_ERANGE,
			"is a temperature that is not positive: %g K",
			parameter->number[0]);
	spectrum->kind = SPEC_SCENE_BLACKBODY;
	spectrum->value = parameter->number[0];
	return SPEC_OK;
}

static enum spec_status
read_spectrum(const struct spec_arguments *arguments,
	const struct spec_parameter *parameter, enum spec_scene_use use,
	struct spec_scene_spectrum *spectrum)
{
	enum spec_status status;

	if (parameter->type == SPEC_BLACKBODY)
		return read_blackbody(arguments, parameter, use, spectrum);
	if (parameter->type & SPEC_REPRESENTED & ~(unsigned)SPEC_RGB_SPECTRUM)
		return spec_scene_read_represented(arguments, parameter, use, spectrum);
	if (parameter->type != SPEC_SPECTRUM)
		return read_numbers(arguments, parameter, use, spectrum);
	if (parameter->text) {
		status = spec_arguments_only(arguments, parameter);
		return status == SPEC_OK ? read_named(arguments, parameter,
						   parameter->text[0], use, spectrum)
					 : status;
	}
	spectrum->kind = SPEC_SCENE_CURVE;
	status = spec_scene_read_table(arguments, parameter, &spectrum->curve);
	if (status == SPEC_OK)
		status =
			spec_scene_check_curve(arguments, parameter, use, &spectrum->curve);
	return status;
}

enum spec_status
spec_arguments_spectrum(const struct spec_arguments *arguments, const char *name,
	enum spec_scene_use use, struct spec_scene_spectrum *spectrum, int *given)
{
	const struct spec_parameter *parameter = spec_arguments_find(arguments, name);
	struct spec_scene_spectrum read = {0};
	enum spec_status status;

	*given = parameter != NULL;
	if (!parameter)
		return SPEC_OK;
	read.place = parameter->place;
	status = read_spectrum(arguments, parameter, use, &read);
	if (status == SPEC_OK)
		*spectrum = read;
	else
		spec_scene_spectrum_free(&read);
	return status;
}

enum spec_status
spec_arguments_named_spectrum(const struct spec_arguments *arguments, const char *name,
	enum spec_scene_use use, struct spec_scene_spectrum *spectrum)
{
	struct spec_scene_spectrum read = {.place = arguments->place};
	enum spec_status status = read_named(arguments, NULL, name, use, &read);

	if (status == SPEC_OK)
		*spectrum = read;
	else
		spec_scene_spectrum_free(&read);
	return status;
}
