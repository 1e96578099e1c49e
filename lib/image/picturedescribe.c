/* What pictures are of: colours, the bands of one file, or one band each. */
#include <ctype.h>
#include <stdlib.h>
#include <string.h>

#include "base/memory.h"
#include "base/number.h"
#include "base/path.h"
#include "image/description.h"
#include "image/given.h"
#include "image/picturereading.h"

/* The channels and where each comes from, the image's order being by name. */
static enum spec_status
settle_channels(struct picture_reader *reader, const struct spec_settings *settings,
	struct spec_error *error)
{
	struct spec_image *image = &reader->base.image;
	const char *name = reader->base.source.name;
	enum spec_status status = spec_given_apply(image, settings, name, error);

	if (status == SPEC_OK)
		status = spec_image_index(image, name, error);
	reader->from_input = spec_memory_new(
		image->channels, sizeof *reader->from_input, "channels", error);
	reader->from_channel = spec_memory_new(
		image->channels, sizeof *reader->from_channel, "channels", error);
	return status == SPEC_OK && (!reader->from_input || !reader->from_channel)
		       ? SPEC_ENOMEM
		       : status;
}

/* Up to four channels without wavelengths: Y, Y A, R G B or R G B A. */
static enum spec_status
set_colours(struct picture_reader *reader, const struct spec_settings *settings,
	struct spec_error *error)
{
	static const char *const names[] = {"Y", "YA", "RGB", "RGBA"};
	struct spec_image *image = &reader->base.image;
	const struct spec_pictures_content *content = &reader->input[0].content;
	const char *letters = names[content->channels - 1];
	enum spec_status status = SPEC_OK;
	char name[2] = "";

	for (int i = 0; i < content->channels && status == SPEC_OK; i++) {
		name[0] = letters[i];
		status = spec_image_add_channel(image, name, SPEC_SAMPLE_FLOAT, error);
	}
	reader->colours = 1;
	if (status == SPEC_OK && reader->input[0].png_content.has_primaries)
		status = spec_image_set_attribute(image, "chromaticities", "chromaticities",
			reader->input[0].png_content.primaries,
			sizeof reader->input[0].png_content.primaries, error);
	if (status == SPEC_OK)
		status = settle_channels(reader, settings, error);
	for (int i = 0; i < content->channels && status == SPEC_OK; i++) {
		name[0] = letters[i];
		reader->from_channel[spec_image_find_channel(image, name)] = (size_t)i;
	}
	return status;
}

/* Bands in the layout's names; band i of those given is channel i, or input i's first. */
static enum spec_status
set_bands(struct picture_reader *reader, const struct spec_grid *grid, enum spec_role role,
	const struct spec_settings *settings, struct spec_error *error)
{
	struct spec_image *image = &reader->base.image;
	enum spec_status status = spec_image_add_bands(
		image, role, 1, grid->wavelength_nm, grid->count, SPEC_SAMPLE_FLOAT, error);

	if (status == SPEC_OK)
		status = settle_channels(reader, settings, error);
	for (size_t i = 0; i < grid->count && status == SPEC_OK; i++) {
		int same;
		size_t found =
			spec_image_nearest_band(image, grid->wavelength_nm[i], &same);
		size_t channel = image->band_channel[found];

		reader->from_input[channel] = reader->inputs > 1 ? i : 0;
		reader->from_channel[channel] = reader->inputs > 1 ? 0 : i;
	}
	return status;
}

static enum spec_status
find_role(const struct picture_reader *reader, const struct spec_settings *settings,
	enum spec_role *role, struct spec_error *error)
{
	char *quantity;

	*role = settings->read_as;
	if (*role != SPEC_ROLE_OTHER)
		return SPEC_OK;
	quantity = spec_image_quantity(&reader->base.image, error);
	if (!quantity)
		return SPEC_ENOMEM;
	if (strstr(quantity, "radiance"))
		*role = SPEC_ROLE_EMISSIVE;
	else if (strstr(quantity, "reflectance") || strstr(quantity, "transmittance"))
		*role = SPEC_ROLE_REFLECTIVE;
	free(quantity);
	if (*role != SPEC_ROLE_OTHER)
		return SPEC_OK;
	return spec_error_set(error, SPEC_EUSAGE,
		"%s: does not say whether it holds radiance or reflectance (--read-as)",
		reader->base.source.name);
}

/* What the first picture says of the image. */
static enum spec_status
describe(struct picture_reader *reader, struct spec_description *said,
	struct spec_error *error)
{
	const struct picture_input *input = &reader->input[0];
	enum spec_status status = spec_description_read(
		input->content.description, &reader->base.image, said, error);

	if (status == SPEC_EFORMAT)
		spec_error_prefix(error, "%s", input->path);
	return status;
}

/* Many channels in one file: what it describes itself as, or what the user says. */
static enum spec_status
set_cube(struct picture_reader *reader, const struct spec_settings *settings,
	struct spec_error *error)
{
	const struct spec_pictures_content *content = &reader->input[0].content;
	const char *name = reader->base.source.name;
	struct spec_image *image = &reader->base.image;
	struct spec_description said;
	struct spec_grid given = {0};
	enum spec_role role = SPEC_ROLE_OTHER;
	enum spec_status status = describe(reader, &said, error);
	int says = status == SPEC_OK && !settings->wavelengths && said.grid.count > 0;

	if (status == SPEC_OK && !says) {
		status = spec_given_wavelengths(
			settings, (size_t)content->channels, name, &given, error);
		spec_image_remove_attribute(image, "spec:bins");
	}
	if (says && said.grid.count != (size_t)content->channels)
		status = spec_error_set(error, SPEC_EFORMAT,
			"%s: describes %zu bands and has %d channels", name,
			said.grid.count, content->channels);
	if (status == SPEC_OK && says && said.has_bin && said.grid.count == 1)
		status = spec_image_set_bins(image, said.bin_nm, 1, error);
	if (status == SPEC_OK)
		status = find_role(reader, settings, &role, error);
	if (status == SPEC_OK)
		status = set_bands(
			reader, says ? &said.grid : &given, role, settings, error);
	spec_description_free(&said);
	spec_grid_free(&given);
	return status;
}

/* The wavelength in a name such as "550nm.png" or "scene_w550.5nm.tif"; 0: none. */
static double
wavelength_of(const char *path)
{
	const char *found = spec_path_name(path);

	while ((found = strstr(found, "nm"))) {
		const char *from = found;
		double value;

		while (from > path && (isdigit((unsigned char)from[-1]) ||
					      (from[-1] == '.' && from - path > 1 &&
						      isdigit((unsigned char)from[-2]))))
			from--;
		if (from < found &&
			spec_number_scan(from, '.', &value) == (size_t)(found - from))
			return value;
		found += 2;
	}
	return 0;
}

static int
compare_wavelengths(const void *a, const void *b)
{
	const struct picture_input *one = a, *two = b;

	return (one->wavelength_nm > two->wavelength_nm) -
	       (one->wavelength_nm < two->wavelength_nm);
}

/* The wavelength of a picture, and its bin, as it says itself, or as its name does. */
static enum spec_status
find_wavelength(struct picture_input *input, struct spec_error *error)
{
	const char *description = input->content.description;
	struct spec_image passed = {
		.data = {0, 0, input->content.width, input->content.height}};
	struct spec_description said = {0};
	enum spec_status status = SPEC_OK;

	if (spec_description_is_ours(description))
		status = spec_description_read(description, &passed, &said, error);
	if (status == SPEC_EFORMAT)
		spec_error_prefix(error, "%s", input->path);
	input->wavelength_nm = said.grid.count == 1 ? said.grid.wavelength_nm[0]
						    : wavelength_of(input->path);
	input->has_bin = said.has_bin && said.grid.count == 1;
	memcpy(input->bin_nm, said.bin_nm, sizeof input->bin_nm);
	spec_description_free(&said);
	spec_image_clear(&passed);
	return status;
}

/* Of each picture its wavelength, if all have one; sorted by it. */
static enum spec_status
find_wavelengths(
	struct picture_reader *reader, struct spec_grid *grid, struct spec_error *error)
{
	enum spec_status status = SPEC_OK;
	size_t known = 0;

	for (size_t i = 0; i < reader->inputs && status == SPEC_OK; i++) {
		status = find_wavelength(&reader->input[i], error);
		known += reader->input[i].wavelength_nm > 0;
	}
	if (status != SPEC_OK || known < reader->inputs)
		return status;
	qsort(reader->input, reader->inputs, sizeof *reader->input, compare_wavelengths);
	status = spec_grid_new(reader->inputs, grid, error);
	for (size_t i = 0; i < reader->inputs && status == SPEC_OK; i++) {
		grid->wavelength_nm[i] = reader->input[i].wavelength_nm;
		if (i > 0 && grid->wavelength_nm[i] == grid->wavelength_nm[i - 1])
			status = spec_error_set(error, SPEC_EFORMAT,
				"%s and %s are both of %g nm", reader->input[i - 1].path,
				reader->input[i].path, grid->wavelength_nm[i]);
	}
	return status;
}

/* The bins of all pictures, where they have some that lie side by side. */
static enum spec_status
join_bins(struct picture_reader *reader, struct spec_error *error)
{
	size_t count = reader->inputs;
	double *edges_nm = spec_memory_new(count + 1, sizeof *edges_nm, "edges", error);
	enum spec_status status = SPEC_OK;
	int joined = 1;

	if (!edges_nm)
		return SPEC_ENOMEM;
	for (size_t i = 0; i < count; i++) {
		const struct picture_input *input = &reader->input[i];

		joined &= input->has_bin && (i == 0 || input->bin_nm[0] == edges_nm[i]);
		edges_nm[i] = input->bin_nm[0];
		edges_nm[i + 1] = input->bin_nm[1];
	}
	if (joined)
		status = spec_image_set_bins(&reader->base.image, edges_nm, count, error);
	free(edges_nm);
	return status;
}

static enum spec_status
set_stack(struct picture_reader *reader, const struct spec_settings *settings,
	struct spec_error *error)
{
	struct spec_grid grid = {0};
	enum spec_role role = SPEC_ROLE_OTHER;
	enum spec_status status = describe(reader, NULL, error);

	spec_image_remove_attribute(&reader->base.image, "spec:bins");
	if (status == SPEC_OK && !settings->wavelengths)
		status = find_wavelengths(reader, &grid, error);
	if (status == SPEC_OK && grid.count == 0)
		status = spec_given_wavelengths(
			settings, reader->inputs, reader->base.source.name, &grid, error);
	else if (status == SPEC_OK)
		status = join_bins(reader, error);
	if (status == SPEC_OK)
		status = find_role(reader, settings, &role, error);
	if (status == SPEC_OK)
		status = set_bands(reader, &grid, role, settings, error);
	spec_grid_free(&grid);
	return status;
}

enum spec_status
picture_describe(struct picture_reader *reader, const struct spec_settings *settings,
	struct spec_error *error)
{
	const struct spec_pictures_content *content = &reader->input[0].content;

	if (reader->base.source.fd < 0)
		return set_stack(reader, settings, error);
	if (settings->wavelengths || content->channels > 4 ||
		spec_description_is_ours(content->description))
		return set_cube(reader, settings, error);
	return set_colours(reader, settings, error);
}
