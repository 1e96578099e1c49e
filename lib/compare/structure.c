/* Two images as such: what they are, before any sample is looked at. */
#include <math.h>
#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "base/memory.h"
#include "compare/comparing.h"
#include "image/variances.h"

#define SAME_NM 1e-3 /* edges of bins closer than this are the same */

void
spec_comparing_say(struct spec_images *result, const char *format, ...)
{
	static const char more[] = "... and more\n";
	size_t length = strlen(result->structure), room = sizeof result->structure - length;
	va_list arguments;
	int wanted;

	if (length >= sizeof more &&
		strcmp(result->structure + length - sizeof more + 1, more) == 0)
		return;
	va_start(arguments, format);
	wanted = vsnprintf(result->structure + length, room, format, arguments);
	va_end(arguments);
	/* Of the line break too: put it back. */
	spec_error_plain(result->structure + length);
	if (wanted > 0 && (size_t)wanted < room)
		result->structure[length + wanted - 1] = '\n';
	if (wanted < 0 || (size_t)wanted + sizeof more > room) /* whole lines or none */
		strcpy(result->structure + length, more);
}

static void
compare_windows(struct spec_images *result, const char *what, const struct spec_window *a,
	const struct spec_window *b)
{
	if (memcmp(a, b, sizeof *a) != 0)
		spec_comparing_say(result,
			"%s windows differ: %d,%d,%d,%d and %d,%d,%d,%d\n", what, a->x0,
			a->y0, a->x1, a->y1, b->x0, b->y0, b->x1, b->y1);
}

static enum spec_status
compare_quantities(struct spec_images *result, const struct spec_image *a,
	const struct spec_image *b, int *same_scale, struct spec_error *error)
{
	char *one = spec_image_quantity(a, error), *two = spec_image_quantity(b, error);
	enum spec_status status = one && two ? SPEC_OK : SPEC_ENOMEM;

	if (status == SPEC_OK && (a->role != b->role || strcmp(one, two) != 0))
		spec_comparing_say(result, "quantities differ: '%s' and '%s'\n",
			*one ? one : "no bands", *two ? two : "no bands");
	/* Values of bands and densities are not on one scale. */
	*same_scale =
		status == SPEC_OK && !strstr(one, "per band") == !strstr(two, "per band");
	free(one);
	free(two);
	return status;
}

/* The layout's unit of emissive bands; a file that has none is taken to have this. */
#define USUAL_UNITS "W.m^-2.sr^-1"

static enum spec_status
compare_units(struct spec_images *result, const struct spec_image *a,
	const struct spec_image *b, struct spec_error *error)
{
	const struct spec_image *image[] = {a, b};
	char *units[2] = {NULL, NULL};
	enum spec_status status = SPEC_OK;

	for (int i = 0; i < 2 && status == SPEC_OK; i++) {
		status = spec_image_text(image[i], "emissiveUnits", &units[i], error);
		if (status == SPEC_OK && !units[i])
			units[i] =
				spec_memory_text(USUAL_UNITS, strlen(USUAL_UNITS), error);
		if (!units[i])
			status = SPEC_ENOMEM;
	}
	if (status == SPEC_OK && a->role == SPEC_ROLE_EMISSIVE &&
		b->role == SPEC_ROLE_EMISSIVE && strcmp(units[0], units[1]) != 0)
		spec_comparing_say(
			result, "units differ: '%s' and '%s'\n", units[0], units[1]);
	free(units[0]);
	free(units[1]);
	return status;
}

static int
same_band(const struct spec_image *a, const struct spec_image *b, size_t i)
{
	int same;

	return spec_image_nearest_band(a, b->wavelength_nm[i], &same) == i && same;
}

/* Whether the bands can be paired. */
static int
compare_bands(
	struct spec_images *result, const struct spec_image *a, const struct spec_image *b)
{
	size_t i = 0;
	int paired = 0;

	if (a->role != b->role) {
		spec_comparing_say(result,
			"bands differ: %zu and %zu, of different kinds\n", a->bands,
			b->bands);
		return 0;
	}
	if (a->stokes != b->stokes)
		spec_comparing_say(result, "Stokes components differ: %d and %d\n",
			a->stokes, b->stokes);
	while (i < a->bands && i < b->bands && same_band(a, b, i))
		i++;
	if (i < a->bands && (i >= b->bands || a->wavelength_nm[i] < b->wavelength_nm[i]))
		spec_comparing_say(result,
			"bands differ: %zu and %zu, the first has %g nm, the second has "
			"not\n",
			a->bands, b->bands, a->wavelength_nm[i]);
	else if (i < b->bands)
		spec_comparing_say(result,
			"bands differ: %zu and %zu, the second has %g nm, the first has "
			"not\n",
			a->bands, b->bands, b->wavelength_nm[i]);
	else
		paired = a->stokes == b->stokes;
	if (paired && (a->edges_nm != NULL) != (b->edges_nm != NULL)) {
		spec_comparing_say(result,
			"bands differ: one has bins, the other has point samples\n");
		return 0;
	}
	for (i = 0; paired && a->edges_nm && i <= a->bands; i++) {
		if (fabs(a->edges_nm[i] - b->edges_nm[i]) <= SAME_NM)
			continue;
		spec_comparing_say(result, "bins differ: an edge at %g nm and at %g nm\n",
			a->edges_nm[i], b->edges_nm[i]);
		return 0;
	}
	return paired;
}

/* Whole numbers are no bands, even where neither image has any and all channels stand in. */
static int
is_other(const struct spec_image *image, size_t channel, int spectral)
{
	const struct spec_channel *it = &image->channel[channel];

	if (!spectral)
		return it->sample == SPEC_SAMPLE_UINT;
	return it->role == SPEC_ROLE_OTHER || it->role == SPEC_ROLE_BISPECTRAL;
}

/* Pairs by name the channels that are no bands (others 1), or those that stand in for bands. */
static enum spec_status
pair_channels(struct spec_images *result, const struct spec_image *a,
	const struct spec_image *b, int others, struct spec_comparing_pairs *pairs,
	struct spec_error *error)
{
	int spectral = a->bands > 0 || b->bands > 0;

	pairs->a = spec_memory_new(a->channels, sizeof *pairs->a, "channels", error);
	pairs->b = spec_memory_new(a->channels, sizeof *pairs->b, "channels", error);
	if (!pairs->a || !pairs->b)
		return SPEC_ENOMEM;
	for (size_t i = 0; i < a->channels; i++) {
		size_t partner = spec_image_find_channel(b, a->channel[i].name);

		if (is_other(a, i, spectral) != others)
			continue;
		if (partner == b->channels) {
			spec_comparing_say(result, "channel '%s' is only in the first\n",
				a->channel[i].name);
			continue;
		}
		if ((a->channel[i].sample == SPEC_SAMPLE_UINT) !=
			(b->channel[partner].sample == SPEC_SAMPLE_UINT))
			spec_comparing_say(result,
				"channel '%s' holds whole numbers on one side\n",
				a->channel[i].name);
		pairs->a[pairs->count] = i;
		pairs->b[pairs->count++] = partner;
	}
	for (size_t i = 0; i < b->channels; i++) {
		if (is_other(b, i, spectral) == others &&
			spec_image_find_channel(a, b->channel[i].name) == a->channels)
			spec_comparing_say(result, "channel '%s' is only in the second\n",
				b->channel[i].name);
	}
	return SPEC_OK;
}

static enum spec_status
pair_bands(const struct spec_image *a, const struct spec_image *b,
	struct spec_comparing_pairs *pairs, struct spec_error *error)
{
	size_t count = a->bands * (size_t)a->stokes;

	pairs->a = spec_memory_new(count, sizeof *pairs->a, "bands", error);
	pairs->b = spec_memory_new(count, sizeof *pairs->b, "bands", error);
	if (!pairs->a || !pairs->b)
		return SPEC_ENOMEM;
	pairs->count = count;
	memcpy(pairs->a, a->band_channel, count * sizeof *pairs->a);
	memcpy(pairs->b, b->band_channel, count * sizeof *pairs->b);
	return SPEC_OK;
}

static void
say_grids(
	struct spec_images *result, const struct spec_image *a, const struct spec_image *b)
{
	spec_comparing_say(result,
		"grids: %g to %g nm in %zu bands and %g to %g nm in %zu (--resample "
		"compares their overlap)\n",
		a->wavelength_nm[0], a->wavelength_nm[a->bands - 1], a->bands,
		b->wavelength_nm[0], b->wavelength_nm[b->bands - 1], b->bands);
}

/* Whether the bands can be paired, as they are or on another grid. */
static enum spec_status
compare_grids(struct spec_comparing *comparison, int *paired, struct spec_error *error)
{
	struct spec_images *result = comparison->result;
	const struct spec_image *a = comparison->a, *b = comparison->b;
	size_t before = strlen(result->structure);
	enum spec_status status = SPEC_OK;
	int done = 0;

	*paired = compare_bands(result, a, b);
	comparison->grid_bands = a->bands;
	comparison->grid_nm = a->wavelength_nm;
	comparison->grid_edges_nm = a->edges_nm;
	if (*paired || a->role != b->role || a->bands == 0 || a->stokes != b->stokes)
		return SPEC_OK;
	if (comparison->setup->resample)
		status = spec_comparing_resample(comparison, &done, error);
	if (done) {
		result->structure[before] = '\0';
		*paired = 1;
	} else if (status == SPEC_OK && !a->edges_nm == !b->edges_nm &&
		   !comparison->setup->resample) {
		say_grids(result, a, b);
	}
	return status;
}

enum spec_status
spec_comparing_structure(struct spec_comparing *comparison, struct spec_error *error)
{
	struct spec_images *result = comparison->result;
	const struct spec_image *a = comparison->a, *b = comparison->b;
	int same_window = memcmp(&a->data, &b->data, sizeof a->data) == 0, same_scale,
	    paired;
	enum spec_status status;

	compare_windows(result, "data", &a->data, &b->data);
	compare_windows(result, "display", &a->display, &b->display);
	status = spec_comparing_shown(comparison, error);
	if (status != SPEC_OK || comparison->picture) {
		result->comparable = same_window;
		return status;
	}
	status = compare_grids(comparison, &paired, error);
	if (status == SPEC_OK)
		status = compare_quantities(result, a, b, &same_scale, error);
	if (status == SPEC_OK)
		status = compare_units(result, a, b, error);
	if (status != SPEC_OK)
		return status;
	result->comparable = paired && same_window;
	result->comparable &= same_scale;
	status = pair_channels(result, a, b, 1, &comparison->others, error);
	if (status == SPEC_OK && a->bands == 0 && b->bands == 0)
		status = pair_channels(result, a, b, 0, &comparison->bands, error);
	else if (status == SPEC_OK && result->comparable && !comparison->sums[0].first)
		status = pair_bands(a, b, &comparison->bands, error);
	return status;
}

enum spec_status
spec_comparing_variances(struct spec_comparing *comparison, struct spec_error *error)
{
	const struct spec_comparing_pairs *bands = &comparison->bands;
	struct spec_comparing_pairs *pairs = &comparison->variances;

	pairs->a = spec_memory_new(bands->count, sizeof *pairs->a, "bands", error);
	pairs->b = spec_memory_new(bands->count, sizeof *pairs->b, "bands", error);
	if (!pairs->a || !pairs->b)
		return SPEC_ENOMEM;
	if (comparison->sums[0].first)
		return SPEC_OK;
	for (size_t i = 0; i < bands->count; i++) {
		pairs->a[i] = spec_variances_find(comparison->a, bands->a[i]);
		pairs->b[i] = spec_variances_find(comparison->b, bands->b[i]);
		if (pairs->a[i] == comparison->a->channels ||
			pairs->b[i] == comparison->b->channels ||
			comparison->a->channel[pairs->a[i]].sample == SPEC_SAMPLE_UINT ||
			comparison->b->channel[pairs->b[i]].sample == SPEC_SAMPLE_UINT)
			return SPEC_OK;
	}
	pairs->count = bands->count;
	return SPEC_OK;
}

void
spec_comparing_free(struct spec_comparing *comparison)
{
	free(comparison->bands.a);
	free(comparison->bands.b);
	free(comparison->others.a);
	free(comparison->others.b);
	free(comparison->variances.a);
	free(comparison->variances.b);
	for (int side = 0; side < 2; side++) {
		free(comparison->sums[side].first);
		free(comparison->sums[side].channel);
		free(comparison->sums[side].weight);
	}
	free(comparison->weight_xyz);
	free(comparison->width_nm);
}
