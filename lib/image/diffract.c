#include "image/diffract.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "base/memory.h"
#include "base/vector.h"
#include "image/save.h"

#define RUN 256 /* pixels worked on at a time */

/* A worker's own: directions of a run, and what the disc makes of them. */
struct scratch {
	float tangent[3][RUN];
	double along[RUN], across[RUN], half_cosine[RUN], lamp_cosine[RUN], eye_cosine[RUN];
	double factor[RUN]; /* N.D where lamp and eye see the surface, else 0 */
	double values[];    /* [2][bands][RUN]: light, and one lamp's reflection */
};

static enum spec_status
need(size_t channel, const char *what, const char *name, struct spec_error *error)
{
	if (channel != SPEC_LAYERS_NONE)
		return SPEC_OK;
	return spec_error_set(error, SPEC_EFORMAT, "%s: has no %s", name, what);
}

static void
want_vector(struct spec_diffract *diffract, const size_t vector[3])
{
	for (size_t i = 0; i < 3; i++)
		spec_relight_want(&diffract->relight, vector[i]);
}

static const size_t *
normal_of(const struct spec_geometry *surface)
{
	return surface->shading[0] != SPEC_LAYERS_NONE ? surface->shading : surface->normal;
}

static enum spec_status
plan_surface(struct spec_diffract *diffract, struct spec_error *error)
{
	const struct spec_geometry *surface = &diffract->layers.surface;
	const struct spec_diffract_setup *setup = &diffract->setup;
	const char *name = diffract->name;
	int by_id = 0;
	enum spec_status status =
		need(normal_of(surface)[0], "channels Ns.X, Ns.Y, Ns.Z", name, error);

	if (status == SPEC_OK)
		status = need(surface->eye[0], "channels I.X, I.Y, I.Z", name, error);
	if (status == SPEC_OK && setup->has_centre)
		status = need(surface->point[0], "channels P.X, P.Y, P.Z", name, error);
	else if (status == SPEC_OK)
		status = need(surface->tangent[0],
			"channels Tan.X, Tan.Y, Tan.Z (--centre does without)", name,
			error);
	for (size_t i = 0; i < setup->discs; i++)
		by_id |= !setup->mask[i].any;
	if (status == SPEC_OK && by_id)
		status = need(surface->id, "channel id", name, error);
	if (status == SPEC_OK && by_id &&
		diffract->relight.input->channel[surface->id].sample != SPEC_SAMPLE_UINT)
		status = spec_error_set(
			error, SPEC_EFORMAT, "%s: the channel 'id' is not UINT", name);
	want_vector(diffract, normal_of(surface));
	want_vector(diffract, surface->eye);
	want_vector(diffract, setup->has_centre ? surface->point : surface->tangent);
	spec_relight_want(&diffract->relight, surface->cover);
	spec_relight_want(&diffract->relight, surface->id);
	return status;
}

static enum spec_status
plan_lamps(struct spec_diffract *diffract, struct spec_error *error)
{
	const struct spec_layers *layers = &diffract->layers;

	if (layers->lamps == 0)
		return spec_error_set(error, SPEC_EFORMAT,
			"%s: has no lamp layers (lamp1.S0.550,000000nm ...; see "
			"specexr(5))",
			diffract->name);
	for (size_t i = 0; i < layers->lamps; i++) {
		const struct spec_lamp_layer *lamp = &layers->lamp[i];

		if (lamp->direction[0] == SPEC_LAYERS_NONE)
			return spec_error_set(error, SPEC_EFORMAT,
				"%s: 'lamp%zu' has no direction (D.X, D.Y, D.Z)",
				diffract->name, i + 1);
		want_vector(diffract, lamp->direction);
		for (size_t j = 0; j < diffract->relight.input->bands; j++)
			spec_relight_want(&diffract->relight, lamp->irradiance[j]);
	}
	return SPEC_OK;
}

/* Tangents are to be neither too long nor too short for a float. */
static void
make_unit(double axis[3])
{
	double most = fmax(fmax(fabs(axis[0]), fabs(axis[1])), fabs(axis[2])), length;

	for (size_t i = 0; i < 3; i++)
		axis[i] /= most;
	length = sqrt(axis[0] * axis[0] + axis[1] * axis[1] + axis[2] * axis[2]);
	for (size_t i = 0; i < 3; i++)
		axis[i] /= length;
}

enum spec_status
spec_diffract_plan(struct spec_diffract *diffract, const struct spec_image *input,
	const struct spec_diffract_setup *setup, const char *name, struct spec_error *error)
{
	enum spec_status status;

	*diffract = (struct spec_diffract){.setup = *setup, .name = name};
	if (setup->has_centre)
		make_unit(diffract->setup.axis);
	status = spec_layers_find(&diffract->layers, input, name, error);
	if (status == SPEC_OK)
		status = spec_relight_plan(&diffract->relight, input,
			setup->keep ? NULL : spec_layers_is_lamp, setup->half, name, error);
	if (status == SPEC_OK)
		status = plan_lamps(diffract, error);
	if (status == SPEC_OK)
		status = plan_surface(diffract, error);
	if (status != SPEC_OK)
		spec_diffract_free(diffract);
	return status;
}

void
spec_diffract_free(struct spec_diffract *diffract)
{
	spec_layers_free(&diffract->layers);
	spec_relight_free(&diffract->relight);
	*diffract = (struct spec_diffract){0};
}

static void
rows_of(const struct spec_decoder *decoder, int y, const size_t vector[3], size_t x0,
	const float *row[3])
{
	for (size_t i = 0; i < 3; i++)
		row[i] = spec_decoder_row(decoder, y, vector[i]) + x0;
}

/* Along circles around the axis: axis x (P - centre). */
static void
circle_tangents(const struct spec_diffract_setup *setup, const float *const point[3],
	size_t count, float tangent[3][RUN])
{
	const double *axis = setup->axis;

	for (size_t i = 0; i < count; i++) {
		double x = point[0][i] - setup->centre[0];
		double y = point[1][i] - setup->centre[1];
		double z = point[2][i] - setup->centre[2];

		tangent[0][i] = (float)(axis[1] * z - axis[2] * y);
		tangent[1][i] = (float)(axis[2] * x - axis[0] * z);
		tangent[2][i] = (float)(axis[0] * y - axis[1] * x);
	}
}

/* The disc that a pixel's surface is, or null: there is none, or none for its id. */
static const struct spec_disc *
disc_at(const struct spec_diffract_setup *setup, const float *cover, const float *ids,
	size_t x, int *bare)
{
	size_t i;

	*bare = 0;
	if (cover && cover[x] == 0)
		return NULL;
	i = spec_mask_find(setup->mask, setup->discs, ids, x);
	*bare = i == SPEC_MASK_NONE;
	return i == SPEC_MASK_NONE ? NULL : &setup->disc[i];
}

/* Pixels from..to-1 of one disc: all lamps' light, added to light. */
struct patch {
	const struct spec_disc *disc;
	size_t from, to; /* in the image's line */
};

/* What lamp and eye both see is lit by the cosine; no light comes from behind. */
SPEC_VECTORISED static void
find_factors(const double *restrict lamp_cosine, const double *restrict eye_cosine,
	size_t count, double *restrict factor)
{
	for (size_t i = 0; i < count; i++)
		factor[i] = lamp_cosine[i] > 0 && eye_cosine[i] > 0 ? lamp_cosine[i] : 0;
}

SPEC_VECTORISED static void
add_reflected(double *restrict light, const double *restrict reflection,
	const double *restrict factor, const float *restrict irradiance, size_t count)
{
	for (size_t i = 0; i < count; i++)
		light[i] += reflection[i] * factor[i] * irradiance[i];
}

static int
any_lit(const double *factor, size_t count)
{
	for (size_t i = 0; i < count; i++) {
		if (factor[i] != 0)
			return 1;
	}
	return 0;
}

static void
light_patch(const struct spec_diffract *diffract, const struct spec_decoder *decoder, int y,
	const struct patch *patch, struct scratch *scratch)
{
	const struct spec_image *input = diffract->relight.input;
	const struct spec_geometry *surface = &diffract->layers.surface;
	size_t count = patch->to - patch->from, bands = input->bands;
	double *light = scratch->values, *reflection = scratch->values + bands * RUN;
	struct spec_disc_bands wanted = {bands, input->wavelength_nm, input->edges_nm};
	struct spec_disc_pixels pixels = {count, scratch->along, scratch->across,
		scratch->half_cosine, scratch->lamp_cosine, scratch->eye_cosine};
	struct spec_disc_directions directions = {
		.tangent = {scratch->tangent[0], scratch->tangent[1], scratch->tangent[2]}};

	memset(light, 0, bands * RUN * sizeof *light);
	rows_of(decoder, y, normal_of(surface), patch->from, directions.normal);
	rows_of(decoder, y, surface->eye, patch->from, directions.eye);
	if (diffract->setup.has_centre) {
		const float *point[3];

		rows_of(decoder, y, surface->point, patch->from, point);
		circle_tangents(&diffract->setup, point, count, scratch->tangent);
	} else {
		rows_of(decoder, y, surface->tangent, patch->from, directions.tangent);
	}
	for (size_t i = 0; i < diffract->layers.lamps; i++) {
		const struct spec_lamp_layer *lamp = &diffract->layers.lamp[i];

		rows_of(decoder, y, lamp->direction, patch->from, directions.lamp);
		spec_disc_geometry(&directions, &pixels);
		find_factors(pixels.lamp_cosine, pixels.eye_cosine, count, scratch->factor);
		if (!any_lit(scratch->factor, count))
			continue;
		diffract->setup.model(patch->disc, &wanted, &pixels, reflection, RUN);
		for (size_t band = 0; band < bands; band++)
			add_reflected(light + band * RUN, reflection + band * RUN,
				scratch->factor,
				spec_decoder_row(decoder, y, lamp->irradiance[band]) +
					patch->from,
				count);
	}
}

SPEC_VECTORISED static void
add_light(float *restrict to, const double *restrict light, size_t count)
{
	for (size_t i = 0; i < count; i++)
		to[i] = (float)(to[i] + light[i]);
}

/* The longest patch from x on, or the stretch without a disc where patch->disc is null. */
static void
find_patch(const struct spec_diffract *diffract, const float *cover, const float *ids,
	size_t x, size_t width, struct patch *patch, long long *bare)
{
	int is_bare;

	patch->from = x;
	patch->disc = disc_at(&diffract->setup, cover, ids, x, &is_bare);
	*bare += is_bare;
	for (x++; x < width && x - patch->from < RUN; x++) {
		const struct spec_disc *disc =
			disc_at(&diffract->setup, cover, ids, x, &is_bare);

		if (disc != patch->disc)
			break;
		*bare += is_bare;
	}
	patch->to = x;
}

static void
light_line(struct spec_diffract *diffract, const struct spec_decoder *decoder, int y,
	struct scratch *scratch, float *const *plane)
{
	const struct spec_relight *relight = &diffract->relight;
	const struct spec_geometry *surface = &diffract->layers.surface;
	const float *cover = spec_relight_row(decoder, y, surface->cover);
	const float *ids = spec_relight_row(decoder, y, surface->id);
	size_t width = spec_window_width(&relight->image.data);
	struct patch patch = {0};
	long long bare = 0;

	for (size_t x = 0; x < width; x = patch.to) {
		find_patch(diffract, cover, ids, x, width, &patch, &bare);
		if (!patch.disc)
			continue;
		light_patch(diffract, decoder, y, &patch, scratch);
		for (size_t i = 0; i < relight->image.channels; i++) {
			if (relight->band[i] != SPEC_LAYERS_NONE)
				add_light(plane[i] + patch.from,
					scratch->values + relight->band[i] * RUN,
					patch.to - patch.from);
		}
	}
	if (bare > 0)
		atomic_fetch_add(&diffract->bare, bare);
}

static enum spec_status
kernel(void *state, struct spec_stream_worker *worker, int line, struct spec_error *error)
{
	struct spec_diffract *diffract = state;
	const struct spec_relight *relight = &diffract->relight;
	const struct spec_decoder *decoder = worker->decoder[0];
	int y = relight->input->data.y0 + line;
	size_t width = spec_window_width(&relight->image.data);
	float *const *plane;
	enum spec_status status = spec_packer_begin(worker->packer, y, &plane, error);

	if (status != SPEC_OK)
		return status;
	spec_relight_copy(relight, decoder, y, plane);
	for (size_t i = 0; i < relight->image.channels; i++) {
		if (relight->band[i] != SPEC_LAYERS_NONE)
			memcpy(plane[i], spec_decoder_row(decoder, y, relight->origin[i]),
				width * sizeof **plane);
	}
	light_line(diffract, decoder, y, worker->scratch, plane);
	return spec_packer_end(worker->packer, y, error);
}

enum spec_status
spec_diffract_run(struct spec_diffract *diffract, struct spec_reader *reader,
	const struct spec_settings *settings, unsigned long long *overflows,
	struct spec_error *error)
{
	struct spec_stream stream = spec_relight_stream(&diffract->relight, reader);

	stream.scratch_bytes = sizeof(struct scratch) +
			       2 * diffract->relight.input->bands * RUN * sizeof(double);
	stream.state = diffract;
	stream.kernel = kernel;
	return spec_image_save(
		&diffract->relight.image, &stream, settings, overflows, error);
}
