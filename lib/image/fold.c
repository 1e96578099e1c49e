#include "image/fold.h"

#include <math.h>
#include <stdlib.h>

#include "base/memory.h"
#include "base/vector.h"
#include "image/save.h"

#define RUN 256    /* pixels worked on at a time */
#define SLACK 1e-3 /* by which the cosine of a mean of vectors may pass 1 */

/* Neighbouring pixels with one coating, seen from one side. */
struct segment {
	size_t from, to;
	const struct spec_coating *coating;
	int behind;
};

/* A film over a run of pixels. */
struct film_run {
	double cosine[RUN], thickness_nm[RUN];
	double share[RUN]; /* of the light from behind that has to pass it */
	int partial;       /* some share is not 1 */
	struct segment segment[RUN];
	size_t segments;
};

/* A worker's own. */
struct scratch {
	double light[RUN], mirrored[RUN], through[RUN];
	struct film_run film[];
};

static enum spec_status
need(int there, size_t film, const char *what, const char *name, struct spec_error *error)
{
	if (there)
		return SPEC_OK;
	return spec_error_set(
		error, SPEC_EFORMAT, "%s: 'film%zu' has no channel '%s'", name, film, what);
}

/* The surface's axis that gravity goes along, or SPEC_LAYERS_NONE. */
static size_t
height_channel(const struct spec_geometry *geometry, const struct spec_thickness *thickness)
{
	return thickness->kind == SPEC_THICKNESS_GRAVITY ? geometry->object[thickness->up]
							 : SPEC_LAYERS_NONE;
}

/* Checks that a film has what its coatings need, and marks it as wanted. */
static enum spec_status
plan_film(struct spec_fold *fold, size_t number, struct spec_error *error)
{
	const struct spec_film_layer *film = &fold->layers.film[number - 1];
	const struct spec_geometry *geometry = &film->geometry;
	const struct spec_image *input = fold->relight.input;
	int has_cosine = geometry->cosine != SPEC_LAYERS_NONE;
	int has_vectors = geometry->shading[0] != SPEC_LAYERS_NONE &&
			  geometry->eye[0] != SPEC_LAYERS_NONE;
	enum spec_status status =
		need(has_cosine || has_vectors, number, "cosine", fold->name, error);

	for (size_t i = 0; i < fold->setup.coatings && status == SPEC_OK; i++) {
		const struct spec_thickness *thickness = &fold->setup.coating[i].thickness;

		if (!fold->setup.mask[i].any)
			status = need(geometry->id != SPEC_LAYERS_NONE &&
					      input->channel[geometry->id].sample ==
						      SPEC_SAMPLE_UINT,
				number, "id (UINT)", fold->name, error);
		if (status == SPEC_OK && thickness->kind == SPEC_THICKNESS_GRAVITY)
			status = need(
				height_channel(geometry, thickness) != SPEC_LAYERS_NONE,
				number, "Q.X, Q.Y, Q.Z", fold->name, error);
		spec_relight_want(&fold->relight, height_channel(geometry, thickness));
	}
	spec_relight_want(&fold->relight, geometry->cosine);
	spec_relight_want(&fold->relight, geometry->cover);
	spec_relight_want(&fold->relight, geometry->id);
	for (size_t i = 0; i < 3 && !has_cosine && has_vectors; i++) {
		spec_relight_want(&fold->relight, geometry->shading[i]);
		spec_relight_want(&fold->relight, geometry->eye[i]);
	}
	for (size_t i = 0; i < input->bands; i++)
		spec_relight_want(&fold->relight, film->mirror[i]);
	return status;
}

static enum spec_status
plan_films(struct spec_fold *fold, struct spec_error *error)
{
	enum spec_status status = SPEC_OK;

	if (fold->layers.films == 0)
		return spec_error_set(error, SPEC_EFORMAT,
			"%s: has no film layers (film1.mirror.S0.550,000000nm ...; see "
			"specexr(5))",
			fold->name);
	for (size_t i = 1; i <= fold->layers.films && status == SPEC_OK; i++)
		status = plan_film(fold, i, error);
	for (size_t i = 0; fold->layers.through && i < fold->relight.input->bands; i++)
		spec_relight_want(&fold->relight, fold->layers.through[i]);
	return status;
}

enum spec_status
spec_fold_plan(struct spec_fold *fold, const struct spec_image *input,
	const struct spec_fold_setup *setup, const char *name, struct spec_error *error)
{
	enum spec_status status;

	*fold = (struct spec_fold){.setup = *setup, .name = name};
	status = spec_layers_find(&fold->layers, input, name, error);
	if (status == SPEC_OK)
		status = spec_relight_plan(&fold->relight, input,
			setup->keep ? NULL : spec_layers_is_film, setup->half, name, error);
	if (status == SPEC_OK)
		status = plan_films(fold, error);
	if (status != SPEC_OK)
		spec_fold_free(fold);
	return status;
}

void
spec_fold_free(struct spec_fold *fold)
{
	spec_layers_free(&fold->layers);
	spec_relight_free(&fold->relight);
	*fold = (struct spec_fold){0};
}

/* The rows of one line of a film's channels, or null where there is none. */
struct film_rows {
	const float *cosine, *cover, *id, *shading[3], *eye[3];
};

static struct film_rows
rows_of(const struct spec_geometry *geometry, const struct spec_decoder *decoder, int y)
{
	struct film_rows rows = {.cosine = spec_relight_row(decoder, y, geometry->cosine),
		.cover = spec_relight_row(decoder, y, geometry->cover),
		.id = spec_relight_row(decoder, y, geometry->id)};

	for (size_t i = 0; i < 3 && !rows.cosine; i++) {
		rows.shading[i] = spec_relight_row(decoder, y, geometry->shading[i]);
		rows.eye[i] = spec_relight_row(decoder, y, geometry->eye[i]);
	}
	return rows;
}

static double
cosine_at(const struct film_rows *rows, size_t x)
{
	if (rows->cosine)
		return rows->cosine[x];
	return (double)rows->shading[0][x] * rows->eye[0][x] +
	       (double)rows->shading[1][x] * rows->eye[1][x] +
	       (double)rows->shading[2][x] * rows->eye[2][x];
}

/* The coating of a pixel's surface, or null: none of the setup's is for it. */
static const struct spec_coating *
coating_at(const struct spec_fold_setup *setup, const struct film_rows *rows, size_t x)
{
	size_t i = spec_mask_find(setup->mask, setup->coatings, rows->id, x);

	return i == SPEC_MASK_NONE ? NULL : &setup->coating[i];
}

/* The cosine of a pixel's angle of incidence; *behind: it is seen from the substrate. */
static enum spec_status
incidence_at(const struct spec_fold *fold, size_t film, const struct film_rows *rows,
	const struct spec_coating *coating, int y, size_t x, double *cosine, int *behind,
	struct spec_error *error)
{
	double signed_cosine = cosine_at(rows, x), size = fabs(signed_cosine);
	int line = y - fold->relight.input->data.y0;

	*behind = signed_cosine < 0;
	*cosine = size < 1 ? size : 1;
	if (!(size <= 1 + SLACK))
		return spec_error_set(error, SPEC_EFORMAT,
			"%s: pixel %zu,%d: the cosine of film%zu is %g", fold->name, x,
			line, film, signed_cosine);
	if (*behind && !coating->clear_behind)
		return spec_error_set(error, SPEC_EFORMAT,
			"%s: pixel %zu,%d: film%zu is seen from within its substrate, "
			"which absorbs",
			fold->name, x, line, film);
	return SPEC_OK;
}

/*
 * Every ray of the chain of films crosses the first: where another covers less, the rest
 * of the light passes beside it.
 */
static double
share_at(const float *cover, const float *first, size_t x)
{
	double whole = first ? first[x] : 1;

	if (!cover || !(cover[x] < whole))
		return 1;
	return cover[x] > 0 ? cover[x] / whole : 0;
}

/* Cuts pixels x0..x0+count-1 of a film into segments; bare ones are left out. */
static enum spec_status
cut(struct spec_fold *fold, size_t film, const struct spec_decoder *decoder, int y,
	size_t x0, size_t count, struct film_run *run, struct spec_error *error)
{
	const struct spec_geometry *geometry = &fold->layers.film[film - 1].geometry;
	struct film_rows rows = rows_of(geometry, decoder, y);
	const float *first =
		spec_relight_row(decoder, y, fold->layers.film[0].geometry.cover);
	struct segment *last = NULL;
	long long bare = 0;

	run->segments = 0;
	run->partial = 0;
	for (size_t i = 0; i < count; i++) {
		size_t x = x0 + i;
		const struct spec_coating *coating;
		enum spec_status status;
		int behind;

		if (rows.cover && rows.cover[x] == 0)
			continue;
		coating = coating_at(&fold->setup, &rows, x);
		bare += !coating;
		if (!coating)
			continue;
		status = incidence_at(
			fold, film, &rows, coating, y, x, &run->cosine[i], &behind, error);
		if (status != SPEC_OK)
			return status;
		run->share[i] = share_at(rows.cover, first, x);
		run->partial |= run->share[i] != 1;
		if (!last || last->to != i || last->coating != coating ||
			last->behind != behind) {
			last = &run->segment[run->segments++];
			*last = (struct segment){i, i, coating, behind};
		}
		last->to = i + 1;
	}
	if (bare > 0)
		atomic_fetch_add(&fold->bare, bare);
	return SPEC_OK;
}

static void
measure(const struct spec_fold *fold, size_t film, const struct spec_decoder *decoder,
	int y, size_t x0, struct film_run *run)
{
	const struct spec_geometry *geometry = &fold->layers.film[film - 1].geometry;

	for (size_t i = 0; i < run->segments; i++) {
		const struct segment *segment = &run->segment[i];
		const struct spec_thickness *thickness = &segment->coating->thickness;
		const float *height =
			spec_relight_row(decoder, y, height_channel(geometry, thickness));

		spec_thickness_row(thickness, height ? height + x0 + segment->from : NULL,
			segment->to - segment->from, run->thickness_nm + segment->from);
	}
}

SPEC_VECTORISED static void
fold_layer(double *restrict light, const double *restrict through,
	const double *restrict mirrored, const float *restrict mirror, size_t count)
{
	for (size_t i = 0; i < count; i++)
		light[i] = through[i] * light[i] + mirrored[i] * mirror[i];
}

SPEC_VECTORISED static void
add_light(float *restrict to, const float *restrict from, const double *restrict light,
	size_t count)
{
	for (size_t i = 0; i < count; i++)
		to[i] = (float)(from[i] + light[i]);
}

SPEC_VECTORISED static void
pass_beside(double *restrict through, const double *restrict share, size_t count)
{
	for (size_t i = 0; i < count; i++)
		through[i] = 1 + share[i] * (through[i] - 1);
}

/* One film in front of the light: pixels without it let all through. */
static void
fold_film(const struct spec_fold *fold, const struct film_run *run, size_t band,
	const float *mirror, struct scratch *scratch)
{
	for (size_t i = 0; i < run->segments; i++) {
		const struct segment *segment = &run->segment[i];
		size_t from = segment->from, count = segment->to - from;

		spec_coating_row(segment->coating, band, segment->behind,
			run->cosine + from, run->thickness_nm + from, count,
			fold->setup.polarisation, scratch->mirrored, scratch->through);
		if (run->partial)
			pass_beside(scratch->through, run->share + from, count);
		fold_layer(scratch->light + from, scratch->through, scratch->mirrored,
			mirror + from, count);
	}
}

/* A band of pixels x0..x0+count-1. */
static void
fold_band(const struct spec_fold *fold, const struct spec_decoder *decoder, int y,
	size_t band, size_t x0, size_t count, struct scratch *scratch, float *to)
{
	const struct spec_layers *layers = &fold->layers;
	const float *from =
		spec_decoder_row(decoder, y, fold->relight.input->band_channel[band]);
	const float *through = layers->through
				       ? spec_decoder_row(decoder, y, layers->through[band])
				       : NULL;

	for (size_t i = 0; i < count; i++)
		scratch->light[i] = through ? through[x0 + i] : 0;
	for (size_t film = layers->films; film > 0; film--)
		fold_film(fold, &scratch->film[film - 1], band,
			spec_decoder_row(decoder, y, layers->film[film - 1].mirror[band]) +
				x0,
			scratch);
	add_light(to + x0, from + x0, scratch->light, count);
}

static enum spec_status
fold_run(struct spec_fold *fold, const struct spec_decoder *decoder, int y, size_t x0,
	size_t count, struct scratch *scratch, float *const *plane,
	struct spec_error *error)
{
	enum spec_status status = SPEC_OK;

	for (size_t film = 1; film <= fold->layers.films && status == SPEC_OK; film++) {
		struct film_run *run = &scratch->film[film - 1];

		status = cut(fold, film, decoder, y, x0, count, run, error);
		if (status == SPEC_OK)
			measure(fold, film, decoder, y, x0, run);
	}
	for (size_t i = 0; i < fold->relight.image.channels && status == SPEC_OK; i++) {
		if (fold->relight.band[i] != SPEC_LAYERS_NONE)
			fold_band(fold, decoder, y, fold->relight.band[i], x0, count,
				scratch, plane[i]);
	}
	return status;
}

static enum spec_status
kernel(void *state, struct spec_stream_worker *worker, int line, struct spec_error *error)
{
	struct spec_fold *fold = state;
	const struct spec_decoder *decoder = worker->decoder[0];
	int y = fold->relight.input->data.y0 + line;
	size_t width = spec_window_width(&fold->relight.image.data);
	float *const *plane;
	enum spec_status status = spec_packer_begin(worker->packer, y, &plane, error);

	if (status != SPEC_OK)
		return status;
	spec_relight_copy(&fold->relight, decoder, y, plane);
	for (size_t x0 = 0; x0 < width && status == SPEC_OK; x0 += RUN)
		status = fold_run(fold, decoder, y, x0, width - x0 < RUN ? width - x0 : RUN,
			worker->scratch, plane, error);
	return status == SPEC_OK ? spec_packer_end(worker->packer, y, error) : status;
}

enum spec_status
spec_fold_run(struct spec_fold *fold, struct spec_reader *reader,
	const struct spec_settings *settings, unsigned long long *overflows,
	struct spec_error *error)
{
	struct spec_stream stream = spec_relight_stream(&fold->relight, reader);

	stream.scratch_bytes =
		sizeof(struct scratch) + fold->layers.films * sizeof(struct film_run);
	stream.state = fold;
	stream.kernel = kernel;
	return spec_image_save(&fold->relight.image, &stream, settings, overflows, error);
}
