/* The colours and the widths of the bands that are compared. */
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "base/memory.h"
#include "colour/observer.h"
#include "colour/space.h"
#include "compare/comparing.h"
#include "spectrum/rebin.h"

/* XYZ weights of S0's bands or of T's; the other Stokes components have none. */
static enum spec_status
colour_bands(struct spec_comparing *comparison, struct spec_error *error)
{
	const struct spec_images_setup *setup = comparison->setup;
	const struct spec_image *a = comparison->a;
	size_t bands_here = comparison->grid_bands, count = comparison->bands.count;
	struct spec_bands bands = {
		bands_here, comparison->grid_nm, comparison->grid_edges_nm, 0};
	const struct spec_curve *light =
		a->role == SPEC_ROLE_REFLECTIVE ? setup->illuminant : NULL;
	double outside;
	double *weight = spec_memory_new(3 * bands_here, sizeof *weight, "bands", error);
	char *quantity = spec_image_quantity(a, error);
	enum spec_status status = weight && quantity ? SPEC_OK : SPEC_ENOMEM;

	bands.per_band = quantity && strstr(quantity, "per band") != NULL;
	free(quantity);
	if (status == SPEC_OK)
		status = spec_observer_weights(
			setup->observer, light, &bands, weight, &outside, error);
	for (size_t i = 0; i < 3 * bands_here && status == SPEC_OK; i++)
		comparison->weight_xyz[i / bands_here * count + i % bands_here] =
			weight[i] * exp2(setup->exposure);
	free(weight);
	if (status != SPEC_OK)
		return status;
	return spec_observer_white(setup->observer, setup->illuminant,
		comparison->spectral_setup.white_xyz, error);
}

/* The image whose channels the pairs name. */
static const struct spec_image *
picture_of(const struct spec_comparing *comparison)
{
	return comparison->picture ? comparison->picture : comparison->a;
}

/* Where among the pairs the channel of that name is, or their count. */
static size_t
find_pair(const struct spec_comparing *comparison, const char *name)
{
	size_t channel = spec_image_find_channel(picture_of(comparison), name), i = 0;

	while (i < comparison->bands.count && comparison->bands.a[i] != channel)
		i++;
	return i;
}

enum spec_status
spec_comparing_space(
	const struct spec_image *image, struct spec_space *space, struct spec_error *error)
{
	const struct spec_attribute *it = spec_image_attribute(image, "chromaticities");
	const struct spec_space *usual = spec_space_find("srgb", error);
	float xy[8];

	if (!usual)
		return SPEC_EUSAGE;
	*space = *usual;
	if (!it || strcmp(it->type, "chromaticities") != 0 || it->size != sizeof xy)
		return SPEC_OK;
	memcpy(xy, it->value, sizeof xy);
	for (int i = 0; i < 2; i++) {
		space->red_xy[i] = xy[i];
		space->green_xy[i] = xy[2 + i];
		space->blue_xy[i] = xy[4 + i];
		space->white_xy[i] = xy[6 + i];
	}
	return SPEC_OK;
}

static enum spec_status
colour_pictures(struct spec_comparing *comparison, struct spec_error *error)
{
	static const char *const name[] = {"R", "G", "B"};
	size_t count = comparison->bands.count;
	/* The exposure of what is shown is in its sums. */
	double gain = comparison->picture ? 1 : exp2(comparison->setup->exposure);
	struct spec_space space;
	double matrix[9];
	enum spec_status status;

	for (int c = 0; c < 3; c++) {
		if (find_pair(comparison, name[c]) == count)
			return spec_error_set(error, SPEC_ERANGE,
				"no colours: neither bands nor channels R, G and B");
	}
	status = spec_comparing_space(picture_of(comparison), &space, error);
	if (status == SPEC_OK)
		status = spec_space_to_xyz(&space, matrix, error);
	for (int i = 0; i < 9 && status == SPEC_OK; i++)
		comparison->weight_xyz[(size_t)(i / 3) * count +
				       find_pair(comparison, name[i % 3])] =
			matrix[i] * gain;
	if (status == SPEC_OK)
		spec_white_xyz(space.white_xy, comparison->spectral_setup.white_xyz);
	return status;
}

enum spec_status
spec_comparing_colour(struct spec_comparing *comparison, struct spec_error *error)
{
	enum spec_status status;

	comparison->weight_xyz = spec_memory_new(
		3 * comparison->bands.count, sizeof(double), "bands", error);
	if (!comparison->weight_xyz)
		return SPEC_ENOMEM;
	status = comparison->grid_bands > 0 ? colour_bands(comparison, error)
					    : colour_pictures(comparison, error);
	if (status != SPEC_OK)
		return status;
	comparison->spectral_setup.weight_xyz = comparison->weight_xyz;
	comparison->result->coloured = 1;
	memcpy(comparison->result->white_xyz, comparison->spectral_setup.white_xyz,
		sizeof comparison->result->white_xyz);
	return SPEC_OK;
}

enum spec_status
spec_comparing_widths(struct spec_comparing *comparison, struct spec_error *error)
{
	const struct spec_image *a = comparison->a;
	size_t bands = comparison->grid_bands, count = comparison->bands.count;
	double *width = spec_memory_new(count, sizeof *width, "bands", error);
	double *edges_nm = spec_memory_new(bands + 1, sizeof *edges_nm, "bands", error);
	char *quantity = spec_image_quantity(a, error);
	enum spec_status status = width && edges_nm && quantity ? SPEC_OK : SPEC_ENOMEM;
	int plain = status == SPEC_OK && (bands == 0 || strstr(quantity, "per band"));

	if (status == SPEC_OK && bands > 0 && comparison->grid_edges_nm)
		memcpy(edges_nm, comparison->grid_edges_nm, (bands + 1) * sizeof *edges_nm);
	else if (status == SPEC_OK && bands > 0)
		spec_bins_halfway(comparison->grid_nm, bands, edges_nm);
	for (size_t i = 0; i < count && status == SPEC_OK; i++) {
		if (plain)
			width[i] = bands == 0 || i < bands;
		else if (i < bands)
			width[i] = edges_nm[i + 1] - edges_nm[i];
	}
	free(quantity);
	free(edges_nm);
	comparison->width_nm = width;
	return status;
}
