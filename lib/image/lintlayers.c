/* What is wrong with light layers and geometry. */
#include <stdio.h>
#include <string.h>

#include "image/describing.h"
#include "image/layers.h"
#include "image/linting.h"

static int
has_channel(const struct spec_image *image, const char *name)
{
	return spec_image_find_channel(image, name) < image->channels;
}

/* Vectors of the surface that the bands show, of which a component is missing. */
static void
check_vectors(struct spec_linting *linting)
{
	static const char *const vectors[] = {"P", "N", "Ns", "Tan", "I", "Q"};
	char name[8];

	for (size_t i = 0; i < sizeof vectors / sizeof vectors[0]; i++) {
		int there = 0;

		for (const char *component = "XYZ"; *component; component++) {
			snprintf(name, sizeof name, "%s.%c", vectors[i], *component);
			there += has_channel(linting->image, name);
		}
		if (there > 0 && there < 3)
			spec_linting_add(linting, SPEC_LINT_WARNING, vectors[i],
				"has not all of .X, .Y, .Z");
	}
}

static void
check_id(struct spec_linting *linting, const char *prefix)
{
	const struct spec_image *image = linting->image;
	char name[64];
	size_t channel;

	snprintf(name, sizeof name, "%sid", prefix);
	channel = spec_image_find_channel(image, name);
	if (channel < image->channels && image->channel[channel].sample != SPEC_SAMPLE_UINT)
		spec_linting_add(linting, SPEC_LINT_WARNING, name, "is %s; ids are UINT",
			spec_describing_sample(image->channel[channel].sample));
}

static int
has_vector(const struct spec_image *image, const char *prefix, const char *vector)
{
	char name[64];

	snprintf(name, sizeof name, "%s%s.X", prefix, vector);
	return has_channel(image, name);
}

static void
check_film(struct spec_linting *linting, size_t number, int *covers)
{
	const struct spec_image *image = linting->image;
	char prefix[32], name[64];

	snprintf(prefix, sizeof prefix, "film%zu.", number);
	check_id(linting, prefix);
	snprintf(name, sizeof name, "%scosine", prefix);
	if (!has_channel(image, name) &&
		!(has_vector(image, prefix, "Ns") && has_vector(image, prefix, "I")))
		spec_linting_add(linting, SPEC_LINT_ERROR, name,
			"is missing, and so is Ns or I in its place");
	snprintf(name, sizeof name, "%scover", prefix);
	*covers += has_channel(image, name);
}

static void
check_lamp(struct spec_linting *linting, size_t number)
{
	char prefix[32], name[64];

	snprintf(prefix, sizeof prefix, "lamp%zu.", number);
	if (has_vector(linting->image, prefix, "D"))
		return;
	snprintf(name, sizeof name, "%sD", prefix);
	spec_linting_add(linting, SPEC_LINT_ERROR, name,
		"is missing: the direction of the lamp's light");
}

void
spec_linting_layers(struct spec_linting *linting)
{
	struct spec_layers layers;
	struct spec_error error = {0};
	enum spec_status status;
	int covers = 0;

	if (linting->status != SPEC_OK)
		return;
	check_vectors(linting);
	check_id(linting, "");
	/* Without an index there is nothing that layers could fit. */
	if (linting->image->bands == 0 && linting->role != SPEC_ROLE_OTHER)
		return;
	status = spec_layers_find(&layers, linting->image, "", &error);
	if (status == SPEC_EFORMAT) {
		/* Without the name of the file, which its own line has already. */
		spec_linting_add(linting, SPEC_LINT_ERROR, "layers", "%s",
			error.message + strspn(error.message, ": "));
		return;
	}
	if (status != SPEC_OK) {
		linting->status = status;
		if (linting->error)
			*linting->error = error;
		return;
	}
	for (size_t i = 1; i <= layers.films; i++)
		check_film(linting, i, &covers);
	for (size_t i = 1; i <= layers.lamps; i++)
		check_lamp(linting, i);
	if (covers > 0 && (size_t)covers < layers.films)
		spec_linting_add(linting, SPEC_LINT_ERROR, "layers",
			"have cover for %d of %zu films; it must be there for all or for none",
			covers, layers.films);
	spec_layers_free(&layers);
}
