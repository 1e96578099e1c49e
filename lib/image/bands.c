/* Finding the bands among an image's channels. */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "base/memory.h"
#include "base/number.h"
#include "image/image.h"
#include "image/names.h"
#include "spectrum/grid.h"

struct band {
	double wavelength_nm;
	size_t channel;
};

static int
compare_names(const void *a, const void *b)
{
	const struct spec_channel *one = a, *two = b;

	return strcmp(one->name, two->name);
}

static int
compare_bands(const void *a, const void *b)
{
	const struct band *one = a, *two = b;

	return (one->wavelength_nm > two->wavelength_nm) -
	       (one->wavelength_nm < two->wavelength_nm);
}

static enum spec_status
sort_channels(struct spec_image *image, const char *name, struct spec_error *error)
{
	qsort(image->channel, image->channels, sizeof *image->channel, compare_names);
	for (size_t i = 1; i < image->channels; i++) {
		if (strcmp(image->channel[i - 1].name, image->channel[i].name) == 0)
			return spec_error_set(error, SPEC_EFORMAT,
				"%s: two channels are named '%s'", name,
				image->channel[i].name);
	}
	return SPEC_OK;
}

/* Bands that two programs named are two grids, wherever they lie. */
static enum spec_status
check_namings(const struct spec_image *image, const char *name, struct spec_error *error)
{
	const struct spec_channel *first = NULL;

	for (size_t i = 0; i < image->channels; i++) {
		const struct spec_channel *channel = &image->channel[i];

		if (channel->naming == SPEC_NAMING_NONE)
			continue;
		if (!first)
			first = channel;
		if (channel->naming != first->naming)
			return spec_error_set(error, SPEC_EFORMAT,
				"%s: '%s' and '%s' are named differently (two grids in one file)",
				name, first->name, channel->name);
	}
	return SPEC_OK;
}

/* The channels of one Stokes component, or of T, by wavelength. */
static enum spec_status
gather(const struct spec_image *image, enum spec_role role, int stokes, struct band *band,
	size_t *count, const char *name, struct spec_error *error)
{
	*count = 0;
	for (size_t i = 0; i < image->channels; i++) {
		const struct spec_channel *channel = &image->channel[i];

		if (channel->role == role && channel->stokes == stokes)
			band[(*count)++] = (struct band){channel->wavelength_nm, i};
	}
	qsort(band, *count, sizeof *band, compare_bands);
	for (size_t i = 1; i < *count; i++) {
		if (band[i].wavelength_nm - band[i - 1].wavelength_nm < 1e-6)
			return spec_error_set(error, SPEC_EFORMAT,
				"%s: channels '%s' and '%s' are the same band (two grids "
				"in one file?)",
				name, image->channel[band[i - 1].channel].name,
				image->channel[band[i].channel].name);
	}
	return SPEC_OK;
}

/* What kinds of bands there are. */
static enum spec_status
find_role(struct spec_image *image, int present[4], const char *name,
	struct spec_error *error)
{
	const char *emissive = NULL, *reflective = NULL;

	for (size_t i = 0; i < image->channels; i++) {
		const struct spec_channel *channel = &image->channel[i];

		if (channel->role == SPEC_ROLE_EMISSIVE) {
			emissive = channel->name;
			present[channel->stokes] = 1;
		} else if (channel->role != SPEC_ROLE_OTHER) {
			reflective = channel->name;
			image->bispectral += channel->role == SPEC_ROLE_BISPECTRAL;
		}
	}
	if (emissive && reflective)
		return spec_error_set(error, SPEC_EFORMAT,
			"%s: has emissive and reflective bands at once ('%s', '%s')", name,
			emissive, reflective);
	image->role = emissive     ? SPEC_ROLE_EMISSIVE
		      : reflective ? SPEC_ROLE_REFLECTIVE
				   : SPEC_ROLE_OTHER;
	image->stokes = present[1] || present[2] || present[3] ? 4 : 1;
	if (image->stokes == 4 && !(present[0] && present[1] && present[2] && present[3]))
		return spec_error_set(error, SPEC_EFORMAT,
			"%s: has some of the Stokes components, not all", name);
	return SPEC_OK;
}

static enum spec_status
set_component(struct spec_image *image, int stokes, const struct band *band, size_t count,
	const char *name, struct spec_error *error)
{
	if (stokes > 0 && count != image->bands)
		return spec_error_set(error, SPEC_EFORMAT,
			"%s: S0 has %zu bands and S%d has %zu (two grids in one file)",
			name, image->bands, stokes, count);
	for (size_t i = 0; i < count; i++) {
		if (stokes > 0 &&
			fabs(image->wavelength_nm[i] - band[i].wavelength_nm) > 1e-6)
			return spec_error_set(error, SPEC_EFORMAT,
				"%s: channel '%s' has no partner among S0's (two grids in "
				"one file)",
				name, image->channel[band[i].channel].name);
		image->wavelength_nm[i] = band[i].wavelength_nm;
		image->band_channel[stokes * count + i] = band[i].channel;
	}
	image->bands = count;
	return SPEC_OK;
}

/* Edges that the channels' own names tell (Mitsuba 0.6): used where they meet. */
static enum spec_status
edges_from_names(struct spec_image *image, struct spec_error *error)
{
	double *edges_nm;

	for (size_t i = 0; i < image->bands; i++) {
		const struct spec_channel *channel =
			&image->channel[image->band_channel[i]];

		if (channel->high_nm == 0)
			return SPEC_OK;
		if (i > 0 && fabs(image->channel[image->band_channel[i - 1]].high_nm -
				     channel->low_nm) > 0.011)
			return SPEC_OK; /* two decimals of the names: they do not meet */
	}
	edges_nm = spec_memory_new(image->bands + 1, sizeof *edges_nm, "edges", error);
	if (!edges_nm)
		return SPEC_ENOMEM;
	for (size_t i = 0; i < image->bands; i++) {
		edges_nm[i] = image->channel[image->band_channel[i]].low_nm;
		edges_nm[i + 1] = image->channel[image->band_channel[i]].high_nm;
	}
	image->edges_nm = edges_nm;
	return SPEC_OK;
}

static enum spec_status
edges_from_attribute(struct spec_image *image, const char *text, const char *name,
	struct spec_error *error)
{
	double *edges_nm =
		spec_memory_new(image->bands + 1, sizeof *edges_nm, "edges", error);
	size_t count = 0;

	if (!edges_nm)
		return SPEC_ENOMEM;
	image->edges_nm = edges_nm;
	for (; count <= image->bands; count++) {
		size_t length = spec_number_scan(text, '.', &edges_nm[count]);

		if (length == 0 || (text[length] != ' ' && text[length] != '\0'))
			break;
		text += length + (text[length] == ' ');
	}
	if (count != image->bands + 1 || *text != '\0')
		return spec_error_set(error, SPEC_EFORMAT,
			"%s: spec:bins does not have %zu edges for %zu bands", name,
			image->bands + 1, image->bands);
	for (size_t i = 0; i < image->bands; i++) {
		if (!(edges_nm[i] < edges_nm[i + 1]) ||
			image->wavelength_nm[i] < edges_nm[i] ||
			image->wavelength_nm[i] > edges_nm[i + 1])
			return spec_error_set(error, SPEC_EFORMAT,
				"%s: spec:bins has no bin around %g nm where one should be",
				name, image->wavelength_nm[i]);
	}
	return SPEC_OK;
}

static enum spec_status
find_edges(struct spec_image *image, const char *name, struct spec_error *error)
{
	enum spec_status status;
	char *text;

	if (image->bands == 0)
		return SPEC_OK;
	status = spec_image_text(image, "spec:bins", &text, error);
	if (status != SPEC_OK)
		return status;
	status = text ? edges_from_attribute(image, text, name, error)
		      : edges_from_names(image, error);
	free(text);
	return status;
}

size_t
spec_image_nearest_band(const struct spec_image *image, double wavelength_nm, int *same)
{
	return spec_grid_nearest(image->wavelength_nm, image->bands, wavelength_nm, same);
}

size_t
spec_image_find_channel(const struct spec_image *image, const char *name)
{
	struct spec_channel key = {.name = (char *)name};
	const struct spec_channel *found =
		bsearch(&key, image->channel, image->channels, sizeof key, compare_names);

	return found ? (size_t)(found - image->channel) : image->channels;
}

static int
has_band(const struct spec_image *image, double wavelength_nm)
{
	int same;

	spec_image_nearest_band(image, wavelength_nm, &same);
	return same;
}

/* Light that leaves at a wavelength without a band would be lost. */
static enum spec_status
check_bispectral(const struct spec_image *image, const char *name, struct spec_error *error)
{
	for (size_t i = 0; i < image->channels && image->bispectral > 0; i++) {
		const struct spec_channel *channel = &image->channel[i];

		if (channel->role == SPEC_ROLE_BISPECTRAL &&
			!(has_band(image, channel->wavelength_nm) &&
				has_band(image, channel->reradiated_nm)))
			return spec_error_set(error, SPEC_EFORMAT,
				"%s: channel '%s' has a wavelength that is not on the diagonal",
				name, channel->name);
	}
	return SPEC_OK;
}

/* The number in an attribute of one, or NaN. */
static double
number_of(const struct spec_attribute *attribute)
{
	double value = NAN;
	float single;
	char text[64];

	if (strcmp(attribute->type, "float") == 0 && attribute->size == sizeof single) {
		memcpy(&single, attribute->value, sizeof single);
		return rint(single * 1e13) / 1e13; /* 550 nm, not 550.000012 */
	}
	if (strcmp(attribute->type, "double") == 0 && attribute->size == sizeof value)
		memcpy(&value, attribute->value, sizeof value);
	if (strcmp(attribute->type, "string") == 0 && attribute->size < sizeof text) {
		memcpy(text, attribute->value, attribute->size);
		text[attribute->size] = '\0';
		if (spec_number_parse(text, 0, 1, "the wavelength", &value, NULL) !=
			SPEC_OK)
			return NAN;
	}
	return value;
}

/* Ocean's bands: a channel of any name, and an attribute NAME.wavelength in metres. */
static void
read_ocean(struct spec_image *image)
{
	static const char suffix[] = ".wavelength";

	for (size_t i = 0; i < image->attributes; i++) {
		const struct spec_attribute *attribute = &image->attribute[i];
		size_t length = strlen(attribute->name), tail = sizeof suffix - 1, found;
		double wavelength_nm;
		char channel[256];

		if (length <= tail || length - tail >= sizeof channel ||
			strcmp(attribute->name + length - tail, suffix) != 0)
			continue;
		snprintf(channel, sizeof channel, "%.*s", (int)(length - tail),
			attribute->name);
		found = spec_image_find_channel(image, channel);
		wavelength_nm = number_of(attribute) * 1e9;
		if (found == image->channels ||
			image->channel[found].naming != SPEC_NAMING_NONE ||
			!(wavelength_nm >= SPEC_NAMES_SHORTEST_NM &&
				wavelength_nm <= SPEC_NAMES_LONGEST_NM))
			continue;
		image->channel[found].naming = SPEC_NAMING_OCEAN;
		image->channel[found].role = SPEC_ROLE_EMISSIVE;
		image->channel[found].wavelength_nm = wavelength_nm;
		image->channel[found].reradiated_nm = wavelength_nm;
	}
}

static enum spec_status
find_bands(struct spec_image *image, struct band *band, const char *name,
	struct spec_error *error)
{
	int present[4] = {0};
	enum spec_status status = find_role(image, present, name, error);
	size_t count;

	if (status != SPEC_OK || image->role == SPEC_ROLE_OTHER)
		return status;
	status = check_namings(image, name, error);
	for (int stokes = 0; stokes < image->stokes && status == SPEC_OK; stokes++) {
		status = gather(image, image->role, stokes, band, &count, name, error);
		if (status == SPEC_OK)
			status = set_component(image, stokes, band, count, name, error);
	}
	if (status == SPEC_OK && image->bands == 0)
		status = spec_error_set(error, SPEC_EFORMAT,
			"%s: has bispectral channels but none on the diagonal", name);
	return status == SPEC_OK ? check_bispectral(image, name, error) : status;
}

enum spec_status
spec_image_index(struct spec_image *image, const char *name, struct spec_error *error)
{
	struct band *band;
	enum spec_status status;

	free(image->wavelength_nm);
	free(image->edges_nm);
	free(image->band_channel);
	image->edges_nm = NULL;
	image->bands = image->bispectral = 0;
	band = spec_memory_new(image->channels, sizeof *band, "bands", error);
	image->wavelength_nm =
		spec_memory_new(image->channels, sizeof(double), "bands", error);
	image->band_channel =
		spec_memory_new(image->channels, 4 * sizeof(size_t), "bands", error);
	if (!band || !image->wavelength_nm || !image->band_channel) {
		free(band);
		return SPEC_ENOMEM;
	}
	status = sort_channels(image, name, error);
	if (status == SPEC_OK)
		read_ocean(image);
	if (status == SPEC_OK)
		status = find_bands(image, band, name, error);
	if (status == SPEC_OK)
		status = find_edges(image, name, error);
	free(band);
	return status;
}

enum spec_status
spec_image_rename_bands(
	struct spec_image *image, const char *name, struct spec_error *error)
{
	enum spec_status status = SPEC_OK;
	char text[96];

	for (size_t i = 0; i < image->channels; i++) {
		struct spec_channel *channel = &image->channel[i];
		char *renamed;

		if (channel->role == SPEC_ROLE_OTHER)
			continue;
		spec_names_write(text, sizeof text, channel->role, channel->stokes,
			channel->wavelength_nm, channel->reradiated_nm);
		renamed = spec_memory_text(text, strlen(text), error);
		if (!renamed)
			return SPEC_ENOMEM;
		if (channel->naming == SPEC_NAMING_OCEAN) {
			snprintf(text, sizeof text, "%.80s.wavelength", channel->name);
			spec_image_remove_attribute(image, text);
		}
		free(channel->name);
		channel->name = renamed;
		channel->naming = SPEC_NAMING_LAYOUT;
	}
	if (image->edges_nm && !spec_image_attribute(image, "spec:bins"))
		status = spec_image_set_bins(image, image->edges_nm, image->bands, error);
	return status == SPEC_OK ? spec_image_index(image, name, error) : status;
}

enum spec_status
spec_image_set_bins(struct spec_image *image, const double *edges_nm, size_t bands,
	struct spec_error *error)
{
	enum { LONGEST_EDGE = 32 };
	enum spec_status status;
	char *text;
	size_t length = 0;

	if (!edges_nm) {
		spec_image_remove_attribute(image, "spec:bins");
		return SPEC_OK;
	}
	text = spec_memory_new(bands + 1, LONGEST_EDGE, "edges", error);
	if (!text)
		return SPEC_ENOMEM;
	for (size_t i = 0; i <= bands; i++)
		length += snprintf(text + length, LONGEST_EDGE, "%s%.10g", i > 0 ? " " : "",
			edges_nm[i]);
	status = spec_image_set_text(image, "spec:bins", text, error);
	free(text);
	return status;
}
