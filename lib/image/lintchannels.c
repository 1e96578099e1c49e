/* What is wrong with an image's channels: their names, types and grids. */
#include <ctype.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "base/memory.h"
#include "image/linting.h"
#include "image/names.h"

#define SAME_NM 1e-6     /* bands less apart are the same */
#define NEARLY_NM 1e-3   /* names of six and of three decimals are the same band */
#define MICROMETRES 10.0 /* no image is of light below this [nm]: its unit is another */
#define PBRT_DECIMALS 3

static int
compare_bands(const void *a, const void *b)
{
	const struct spec_linting_band *one = a, *two = b;

	if (one->wavelength_nm != two->wavelength_nm)
		return one->wavelength_nm > two->wavelength_nm ? 1 : -1;
	return (one->channel > two->channel) - (one->channel < two->channel);
}

static const char *
name_of(const struct spec_linting *linting, size_t channel)
{
	return linting->image->channel[channel].name;
}

/* Light where there is any: with both kinds, the file is wrong anyway. */
static void
gather_bands(struct spec_linting *linting)
{
	const struct spec_image *image = linting->image;

	for (size_t i = 0; i < image->channels; i++) {
		enum spec_role role = image->channel[i].role;

		if (role == SPEC_ROLE_EMISSIVE || linting->role == SPEC_ROLE_OTHER)
			linting->role =
				role == SPEC_ROLE_BISPECTRAL ? SPEC_ROLE_REFLECTIVE : role;
	}
	for (int i = 0; i < 4; i++) {
		linting->band[i] = spec_memory_new(
			image->channels, sizeof *linting->band[i], "bands", linting->error);
		if (!linting->band[i]) {
			linting->status = SPEC_ENOMEM;
			return;
		}
	}
	for (size_t i = 0; i < image->channels; i++) {
		const struct spec_channel *channel = &image->channel[i];
		int list = channel->stokes;

		if (channel->role == linting->role && channel->role != SPEC_ROLE_OTHER)
			linting->band[list][linting->bands[list]++] =
				(struct spec_linting_band){channel->wavelength_nm, i};
	}
	for (int i = 0; i < 4; i++)
		qsort(linting->band[i], linting->bands[i], sizeof *linting->band[i],
			compare_bands);
}

/* "S0." or "T." and a number, and at the end a unit: somebody meant a band. */
static int
looks_like_band(const char *name)
{
	size_t length = strlen(name);
	int emissive = name[0] == 'S' && name[1] >= '0' && name[1] <= '3' && name[2] == '.';

	if (!emissive && strncmp(name, "T.", 2) != 0)
		return 0;
	return isdigit((unsigned char)name[emissive ? 3 : 2]) &&
	       (name[length - 1] == 'm' || strcmp(name + length - 2, "Hz") == 0);
}

static void
check_foreign(struct spec_linting *linting)
{
	const struct spec_image *image = linting->image;

	for (size_t i = 0; i < image->channels; i++) {
		struct spec_channel channel = {.name = image->channel[i].name};

		if (image->channel[i].role != SPEC_ROLE_OTHER)
			continue;
		if (spec_names_read(&channel, NULL) == SPEC_EFORMAT)
			spec_linting_add(linting, SPEC_LINT_ERROR, channel.name,
				"is named as a band without a wavelength between %g and %g nm",
				SPEC_NAMES_SHORTEST_NM, SPEC_NAMES_LONGEST_NM);
		else if (looks_like_band(channel.name))
			spec_linting_add(linting, SPEC_LINT_WARNING, channel.name,
				"looks like a band, but its name is another channel's (the "
				"decimal mark is a comma)");
	}
}

/* How the layout names a band, and whether it is named so. */
static int
is_named_well(const struct spec_channel *channel, char *name, size_t size)
{
	spec_names_write(name, size, channel->role, channel->stokes, channel->wavelength_nm,
		channel->reradiated_nm);
	return strcmp(name, channel->name) == 0;
}

/* Decimals behind the comma of a band's name. */
static size_t
decimals(const char *name)
{
	const char *comma = strchr(name, ',');

	return comma ? strspn(comma + 1, "0123456789") : 0;
}

static void
check_names(struct spec_linting *linting)
{
	const struct spec_image *image = linting->image;
	size_t bands = 0, odd = 0, other = 0, short_names = 0, first = 0;
	char name[96];

	for (size_t i = 0; i < image->channels; i++) {
		const struct spec_channel *channel = &image->channel[i];

		if (channel->role == SPEC_ROLE_OTHER)
			continue;
		bands++;
		short_names += channel->role == SPEC_ROLE_EMISSIVE &&
			       decimals(channel->name) == PBRT_DECIMALS;
		if (is_named_well(channel, name, sizeof name))
			continue;
		if (odd++ == 0)
			first = i;
		other += channel->naming != SPEC_NAMING_LAYOUT;
	}
	if (odd == 0)
		return;
	(void)is_named_well(&image->channel[first], name, sizeof name);
	spec_linting_add(linting, SPEC_LINT_WARNING, name_of(linting, first),
		"is not named '%s', as a writer must name it (%zu of %zu bands%s)", name,
		odd, bands, other > 0 ? ", in the way of another program" : "");
	if (short_names == bands)
		spec_linting_add(linting, SPEC_LINT_NOTE, name_of(linting, first),
			"has three decimals, as pbrt-v4 writes them; its values are 106.856895 "
			"times the radiance");
}

static void
check_roles(struct spec_linting *linting)
{
	const struct spec_image *image = linting->image;
	const struct spec_channel *first[SPEC_NAMING_KAIST + 1] = {NULL}, *one = NULL;
	const struct spec_channel *emissive = NULL, *reflective = NULL;

	for (size_t i = image->channels; i-- > 0;) {
		const struct spec_channel *channel = &image->channel[i];

		first[channel->naming] = channel;
		if (channel->role == SPEC_ROLE_EMISSIVE)
			emissive = channel;
		else if (channel->role != SPEC_ROLE_OTHER)
			reflective = channel;
	}
	if (emissive && reflective)
		spec_linting_add(linting, SPEC_LINT_ERROR, reflective->name,
			"is a band of reflectance, beside bands of light such as '%s'",
			emissive->name);
	for (int i = SPEC_NAMING_LAYOUT; i <= SPEC_NAMING_KAIST; i++) {
		if (one && first[i])
			spec_linting_add(linting, SPEC_LINT_ERROR, first[i]->name,
				"is named in another way than '%s': two grids in one file",
				one->name);
		if (!one)
			one = first[i];
	}
}

static void
check_types(struct spec_linting *linting)
{
	const struct spec_image *image = linting->image;
	size_t count = 0, first = 0;

	for (size_t i = 0; i < image->channels; i++) {
		if (image->channel[i].role == SPEC_ROLE_OTHER ||
			image->channel[i].sample != SPEC_SAMPLE_UINT)
			continue;
		if (count++ == 0)
			first = i;
	}
	if (count > 0)
		spec_linting_add(linting, SPEC_LINT_WARNING, name_of(linting, first),
			"is UINT, where HALF or FLOAT is advised (%zu bands)", count);
}

static void
check_grid(struct spec_linting *linting, int list)
{
	const struct spec_linting_band *band = linting->band[list];

	for (size_t i = 1; i < linting->bands[list]; i++) {
		double apart_nm = band[i].wavelength_nm - band[i - 1].wavelength_nm;

		if (apart_nm >= NEARLY_NM)
			continue;
		spec_linting_add(linting,
			apart_nm < SAME_NM ? SPEC_LINT_ERROR : SPEC_LINT_WARNING,
			name_of(linting, band[i].channel), "is %s band as '%s'",
			apart_nm < SAME_NM ? "the same" : "nearly the same",
			name_of(linting, band[i - 1].channel));
	}
}

static const struct spec_linting_band *
find_band(const struct spec_linting *linting, int list, double wavelength_nm,
	double tolerance_nm)
{
	const struct spec_linting_band *band = linting->band[list];
	size_t low = 0, high = linting->bands[list];

	while (low < high) {
		size_t middle = (low + high) / 2;

		if (band[middle].wavelength_nm < wavelength_nm - tolerance_nm)
			low = middle + 1;
		else
			high = middle;
	}
	if (low < linting->bands[list] &&
		fabs(band[low].wavelength_nm - wavelength_nm) <= tolerance_nm)
		return &band[low];
	return NULL;
}

/* Bands of one list that another lacks: the first of them. */
static void
check_partners(struct spec_linting *linting, int list, int other)
{
	size_t missing = 0, first = 0;

	for (size_t i = 0; i < linting->bands[list]; i++) {
		if (find_band(
			    linting, other, linting->band[list][i].wavelength_nm, SAME_NM))
			continue;
		if (missing++ == 0)
			first = linting->band[list][i].channel;
	}
	if (missing > 0)
		spec_linting_add(linting, SPEC_LINT_ERROR, name_of(linting, first),
			"has no partner in S%d (%zu bands)", other, missing);
}

static void
check_stokes(struct spec_linting *linting)
{
	const size_t *bands = linting->bands;

	if (linting->role != SPEC_ROLE_EMISSIVE ||
		(bands[0] > 0 && bands[1] + bands[2] + bands[3] == 0))
		return;
	for (int i = 0; i < 4; i++) {
		if (bands[i] == 0) {
			char place[8];

			snprintf(place, sizeof place, "S%d", i);
			spec_linting_add(linting, SPEC_LINT_ERROR, place,
				"is missing, beside other Stokes components");
		}
	}
	for (int i = 1; i < 4 && bands[0] > 0; i++) {
		if (bands[i] == 0)
			continue;
		check_partners(linting, 0, i);
		check_partners(linting, i, 0);
	}
}

static void
check_bispectral(struct spec_linting *linting)
{
	const struct spec_image *image = linting->image;

	for (size_t i = 0; i < image->channels; i++) {
		const struct spec_channel *channel = &image->channel[i];
		const double *wavelengths[] = {
			&channel->wavelength_nm, &channel->reradiated_nm};

		if (channel->role != SPEC_ROLE_BISPECTRAL)
			continue;
		if (linting->role == SPEC_ROLE_REFLECTIVE && linting->bands[0] == 0) {
			spec_linting_add(linting, SPEC_LINT_ERROR, channel->name,
				"is bispectral, and there is no band on the diagonal");
			return;
		}
		for (int j = 0; j < 2 && linting->role == SPEC_ROLE_REFLECTIVE; j++) {
			if (!find_band(linting, 0, *wavelengths[j], NEARLY_NM))
				spec_linting_add(linting, SPEC_LINT_ERROR, channel->name,
					"has no band on the diagonal at %.10g nm",
					*wavelengths[j]);
		}
	}
}

void
spec_linting_channels(struct spec_linting *linting)
{
	gather_bands(linting);
	if (linting->status != SPEC_OK)
		return;
	check_foreign(linting);
	check_roles(linting);
	if (linting->role == SPEC_ROLE_OTHER) {
		spec_linting_add(linting, SPEC_LINT_NOTE, "file",
			"has no bands: it is not spectral");
		return;
	}
	check_names(linting);
	check_types(linting);
	for (int i = 0; i < 4; i++)
		check_grid(linting, i);
	check_stokes(linting);
	check_bispectral(linting);
	if (linting->bands[0] > 0 &&
		linting->band[0][linting->bands[0] - 1].wavelength_nm < MICROMETRES)
		spec_linting_add(linting, SPEC_LINT_WARNING,
			name_of(linting, linting->band[0][0].channel),
			"is at %.10g nm, and no band is above %g nm: is its unit another?",
			linting->band[0][0].wavelength_nm, MICROMETRES);
}
