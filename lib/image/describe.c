#include "image/describe.h"

#include <stdlib.h>
#include <string.h>

#include "image/describing.h"
#include "image/exr.h"
#include "spectrum/grid.h"

const char *
spec_describing_role(enum spec_role role)
{
	if (role == SPEC_ROLE_EMISSIVE)
		return "emissive";
	return role == SPEC_ROLE_REFLECTIVE ? "reflective" : NULL;
}

const char *
spec_describing_sample(enum spec_sample sample)
{
	if (sample == SPEC_SAMPLE_UINT)
		return "uint";
	return sample == SPEC_SAMPLE_HALF ? "half" : "float";
}

const char *
spec_describing_naming(enum spec_naming naming)
{
	switch (naming) {
	case SPEC_NAMING_LAYOUT:
		return "layout";
	case SPEC_NAMING_MITSUBA:
		return "mitsuba";
	case SPEC_NAMING_ISET3D:
		return "iset3d";
	case SPEC_NAMING_KAIST:
		return "kaist";
	case SPEC_NAMING_OCEAN:
		return "ocean";
	case SPEC_NAMING_GIVEN:
		return "given";
	default:
		return NULL;
	}
}

const char *
spec_describe_unit(const char *quantity)
{
	static const struct {
		const char *quantity, *unit;
	} known[] = {{"radiance per nm", "W m^-2 sr^-1 nm^-1"},
		{"radiance per band", "W m^-2 sr^-1"}, {"reflectance", "1"},
		{"transmittance", "1"}, {"absorptance", "1"}, {"reflectance factor", "1"}};

	for (size_t i = 0; i < sizeof known / sizeof known[0]; i++) {
		if (strcmp(quantity, known[i].quantity) == 0)
			return known[i].unit;
	}
	return NULL;
}

const struct spec_describing_geometry spec_describing_geometries[] = {{"P", 1}, {"N", 1},
	{"Ns", 1}, {"u", 0}, {"v", 0}, {"Tan", 1}, {"I", 1}, {"cosine", 0}, {"Q", 1},
	{"id", 0}, {"cover", 0}, {NULL, 0}};

int
spec_describing_has(const struct spec_image *image, const char *prefix,
	const struct spec_describing_geometry *geometry)
{
	char name[64];

	for (const char *component = "XYZ"; *component; component++) {
		snprintf(name, sizeof name, geometry->vector ? "%s%s.%c" : "%s%s", prefix,
			geometry->name, *component);
		if (spec_image_find_channel(image, name) < image->channels)
			return 1;
	}
	return 0;
}

static int
is_geometry(const char *name)
{
	for (const struct spec_describing_geometry *geometry = spec_describing_geometries;
		geometry->name; geometry++) {
		size_t length = strlen(geometry->name);

		if (strncmp(name, geometry->name, length) != 0)
			continue;
		name += length;
		if (geometry->vector ? name[0] == '.' && name[1] && !name[2] &&
					       strchr("XYZ", name[1])
				     : !name[0])
			return 1;
		name -= length;
	}
	return 0;
}

int
spec_describing_is_foreign(const struct spec_channel *channel)
{
	return channel->role == SPEC_ROLE_OTHER && !spec_layers_is_film(channel) &&
	       !spec_layers_is_lamp(channel) && !is_geometry(channel->name);
}

/* Which group a band's channel is in, or -1. */
static int
group_of(const struct spec_channel *channel)
{
	switch (channel->role) {
	case SPEC_ROLE_EMISSIVE:
		return channel->stokes;
	case SPEC_ROLE_REFLECTIVE:
		return 0;
	case SPEC_ROLE_BISPECTRAL:
		return 1;
	default:
		return -1;
	}
}

size_t
spec_describing_group(const struct spec_describe *describe, int group, const char **name,
	struct spec_statistics *sum)
{
	static const char *const emissive[SPEC_DESCRIBING_GROUPS] = {
		"S0", "S1", "S2", "S3"};
	const struct spec_image *image = describe->image;
	size_t channels = 0;

	*name = image->role == SPEC_ROLE_EMISSIVE ? emissive[group]
		: group == 0                      ? "T"
						  : "T off the diagonal";
	*sum = (struct spec_statistics){0};
	for (size_t i = 0; i < image->channels; i++) {
		if (group_of(&image->channel[i]) != group)
			continue;
		spec_statistics_add(sum, &describe->setup.statistics[i]);
		channels++;
	}
	return channels;
}

enum spec_status
spec_describe_find(struct spec_describe *describe, const struct spec_reader *reader,
	const struct spec_describe_setup *setup, struct spec_error *error)
{
	const struct spec_image *image = spec_reader_image(reader);
	enum spec_status status;

	*describe = (struct spec_describe){.image = image,
		.setup = *setup,
		.name = spec_reader_name(reader),
		.storage = spec_reader_storage(reader)};
	for (size_t i = 0; i < image->channels; i++)
		describe->bytes += spec_exr_sample_bytes(image->channel[i].sample);
	describe->bytes *=
		spec_window_width(&image->data) * spec_window_height(&image->data);
	if (image->bands > 0) {
		describe->naming = image->channel[image->band_channel[0]].naming;
		describe->step_nm = spec_grid_step(image->wavelength_nm, image->bands);
	}
	describe->quantity = spec_image_quantity(image, error);
	if (!describe->quantity)
		return SPEC_ENOMEM;
	describe->unit = spec_describe_unit(describe->quantity);
	status = spec_layers_find(
		&describe->layers, image, describe->name, &describe->damage);
	if (status != SPEC_ENOMEM)
		return SPEC_OK;
	if (error)
		*error = describe->damage;
	spec_describe_free(describe);
	return status;
}

void
spec_describe_free(struct spec_describe *describe)
{
	free(describe->quantity);
	spec_layers_free(&describe->layers);
	*describe = (struct spec_describe){0};
}
