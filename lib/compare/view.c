#include "compare/view.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "base/memory.h"
#include "colour/observer.h"

#define DEGREES (180 / 3.14159265358979323846)

/* --- polarisation --- */

static double
linear_of(const double s[4])
{
	return hypot(s[1], s[2]);
}

static double
degree(const double s[4])
{
	return hypot(linear_of(s), s[3]) / s[0];
}

static double
linear_degree(const double s[4])
{
	return linear_of(s) / s[0];
}

static double
circular_degree(const double s[4])
{
	return fabs(s[3]) / s[0];
}

static double
angle(const double s[4])
{
	double deg = DEGREES * atan2(s[2], s[1]) / 2;

	if (s[1] == 0 && s[2] == 0)
		return NAN;
	return deg < 0 ? deg + 180 : deg;
}

static double
ellipticity(const double s[4])
{
	if (s[1] == 0 && s[2] == 0 && s[3] == 0)
		return NAN;
	return DEGREES * atan2(s[3], linear_of(s)) / 2;
}

static const struct spec_stokes_number polarisations[] = {
	{"dop", "degree of polarisation", 0, 1, "viridis", degree},
	{"dolp", "degree of linear polarisation", 0, 1, "viridis", linear_degree},
	{"docp", "degree of circular polarisation", 0, 1, "viridis", circular_degree},
	{"aop", "angle of polarisation, deg", 0, 180, "hue", angle},
	{"ellipticity", "ellipticity, deg", -45, 45, "cool-warm", ellipticity},
};

const struct spec_stokes_number *
spec_stokes_find(const char *name, struct spec_error *error)
{
	for (size_t i = 0; i < sizeof polarisations / sizeof *polarisations; i++) {
		if (strcmp(polarisations[i].name, name) == 0)
			return &polarisations[i];
	}
	spec_error_set(error, SPEC_EUSAGE,
		"'%s' is not dop, dolp, docp, aop or ellipticity", name);
	return NULL;
}

/* --- making --- */

/* What the functions below share. */
struct maker {
	struct spec_view *view;
	const struct spec_image *image;
	const char *name;
	const struct spec_view_setup *setup;
	struct spec_error *error;
};

static enum spec_status
find_band(const struct maker *maker, size_t *band)
{
	const struct spec_image *image = maker->image;
	double wavelength_nm = maker->setup->band_nm;
	int same = 0;

	if (image->bands == 0)
		return spec_error_set(
			maker->error, SPEC_ERANGE, "%s: has no bands", maker->name);
	*band = spec_image_nearest_band(image, wavelength_nm, &same);
	if (same)
		return SPEC_OK;
	return spec_error_set(maker->error, SPEC_ERANGE,
		"%s: has no band at %g nm; the nearest is at %g nm", maker->name,
		wavelength_nm, image->wavelength_nm[*band]);
}

/* Room for the channels that are read. */
static enum spec_status
take_terms(const struct maker *maker, size_t terms)
{
	maker->view->channel = spec_memory_new(
		terms, sizeof *maker->view->channel, "channels", maker->error);
	maker->view->terms = terms;
	return maker->view->channel ? SPEC_OK : SPEC_ENOMEM;
}

/* Without a band an expression must say the wavelengths itself. */
static enum spec_status
check_fixed(const struct spec_expression *expression, struct spec_error *error)
{
	for (size_t i = 0; i < expression->count; i++) {
		const struct spec_node *node = &expression->node[i];

		if (node->kind != SPEC_NODE_SAMPLE &&
			(node->kind != SPEC_NODE_PLACE || node->place != SPEC_PLACE_NM))
			continue;
		spec_error_set(error, SPEC_EUSAGE,
			"of which band? b550, a(550), or a wavelength by --band");
		spec_error_point(error, expression->text, node->at);
		return SPEC_EUSAGE;
	}
	return SPEC_OK;
}

static enum spec_status
make_program(const struct maker *maker, const char *text)
{
	struct spec_view *view = maker->view;
	size_t channel = SPEC_PROGRAM_NONE, band = 0;
	struct spec_program_place place = {.image = &maker->image,
		.name = &maker->name,
		.channel = &channel,
		.wavelength_nm = NAN,
		.bands = maker->image->bands,
		.width = spec_window_width(&maker->image->data),
		.height = spec_window_height(&maker->image->data)};
	struct spec_expression expression;
	enum spec_status status = spec_expression_parse(text, 1, &expression, maker->error);

	if (status != SPEC_OK)
		return status;
	if (maker->setup->band_nm > 0) {
		status = find_band(maker, &band);
		if (status == SPEC_OK) {
			channel = spec_program_band(maker->image, band, 0);
			place.wavelength_nm = maker->image->wavelength_nm[band];
		}
	} else {
		status = check_fixed(&expression, maker->error);
	}
	if (status == SPEC_OK)
		status = spec_program_make(
			&view->program, &expression, &place, maker->error);
	spec_expression_free(&expression);
	if (status == SPEC_OK)
		status = take_terms(maker, view->program.rows);
	for (size_t i = 0; i < view->terms && status == SPEC_OK; i++)
		view->channel[i] = view->program.row[i].channel;
	return status;
}

/*
 * How much of each band is in the sums: the band's own value, or
 * what the observer sees of it.
 */
static enum spec_status
weigh_bands(const struct maker *maker, double *weight)
{
	const struct spec_image *image = maker->image;
	struct spec_bands bands = {image->bands, image->wavelength_nm, image->edges_nm, 0};
	double outside, *xyz;
	size_t band = 0;
	char *quantity;
	enum spec_status status = SPEC_ENOMEM;

	if (maker->setup->band_nm > 0) {
		status = find_band(maker, &band);
		if (status == SPEC_OK)
			weight[band] = 1;
		return status;
	}
	quantity = spec_image_quantity(image, maker->error);
	xyz = spec_memory_new(image->bands, 3 * sizeof *xyz, "bands", maker->error);
	bands.per_band = quantity && strstr(quantity, "per band");
	if (quantity && xyz)
		status = spec_observer_weights(
			maker->setup->observer, NULL, &bands, xyz, &outside, maker->error);
	if (status == SPEC_OK)
		memcpy(weight, xyz + image->bands, image->bands * sizeof *weight);
	free(quantity);
	free(xyz);
	return status;
}

/* The sums of S0, and of S1, S2 and S3, over the bands that have a weight. */
static enum spec_status
make_sums(const struct maker *maker, const double *weight, size_t used)
{
	struct spec_view *view = maker->view;
	const struct spec_image *image = maker->image;
	size_t term = 0;
	enum spec_status status = take_terms(maker, 4 * used);

	view->intensity.terms = used;
	view->rest.terms = 3 * used;
	view->intensity.weight =
		spec_memory_new(3 * used, sizeof(double), "bands", maker->error);
	view->rest.weight =
		spec_memory_new(9 * used, sizeof(double), "bands", maker->error);
	if (status != SPEC_OK || !view->intensity.weight || !view->rest.weight)
		return SPEC_ENOMEM;
	for (size_t band = 0; band < image->bands; band++) {
		if (weight[band] == 0)
			continue;
		for (size_t stokes = 0; stokes < 4; stokes++)
			view->channel[stokes * used + term] =
				image->band_channel[stokes * image->bands + band];
		view->intensity.weight[term] = weight[band];
		for (size_t i = 0; i < 3; i++)
			view->rest.weight[i * 3 * used + i * used + term] = weight[band];
		term++;
	}
	return SPEC_OK;
}

static enum spec_status
make_polarisation(const struct maker *maker)
{
	const struct spec_image *image = maker->image;
	double *weight;
	size_t used = 0;
	enum spec_status status;

	if (image->role != SPEC_ROLE_EMISSIVE || image->stokes < 4)
		return spec_error_set(maker->error, SPEC_ERANGE,
			"%s: is not polarised: it has no Stokes components S1, S2 and S3",
			maker->name);
	weight = spec_memory_new(image->bands, sizeof *weight, "bands", maker->error);
	if (!weight)
		return SPEC_ENOMEM;
	status = weigh_bands(maker, weight);
	for (size_t i = 0; i < image->bands; i++)
		used += weight[i] != 0;
	if (status == SPEC_OK)
		status = make_sums(maker, weight, used);
	free(weight);
	return status;
}

/* The channels of a layer, and the scale of what they usually are. */
static enum spec_status
make_layer(const struct maker *maker)
{
	static const char *const directions[] = {"N", "Ns", "Tan", "I", "D"};
	const struct spec_layer *layer = maker->setup->layer;
	struct spec_view *view = maker->view;
	size_t parts = layer->kind == SPEC_LAYER_VECTOR  ? 3
		       : layer->kind == SPEC_LAYER_PLANE ? 2
							 : 1;
	enum spec_status status = take_terms(maker, parts);

	if (status != SPEC_OK)
		return status;
	memcpy(view->channel, layer->channel, parts * sizeof *view->channel);
	view->numbers = parts > 1 ? 3 : 1;
	for (size_t i = 0; i < sizeof directions / sizeof *directions && parts == 3; i++) {
		if (strcmp(layer->base, directions[i]) == 0) {
			view->low = -1;
			view->high = 1;
		}
	}
	if (parts == 2 || strcmp(layer->base, "Q") == 0)
		view->high = 1;
	return SPEC_OK;
}

static void
name_view(struct spec_view *view, const struct spec_view_setup *setup)
{
	if (setup->polarisation && setup->band_nm > 0)
		snprintf(view->label, sizeof view->label, "%s, %g nm",
			setup->polarisation->label, setup->band_nm);
	else if (setup->polarisation || setup->expression)
		snprintf(view->label, sizeof view->label, "%s",
			setup->polarisation ? setup->polarisation->label
					    : setup->expression);
	else if (setup->layer)
		snprintf(view->label, sizeof view->label, "%s", setup->layer->base);
	else
		snprintf(view->label, sizeof view->label, "%g nm", setup->band_nm);
}

enum spec_status
spec_view_make(struct spec_view *view, const struct spec_image *image, const char *name,
	const struct spec_view_setup *setup, struct spec_error *error)
{
	struct maker maker = {NULL, image, name, setup, error};
	enum spec_status status;

	*view = (struct spec_view){.numbers = 1, .map = "viridis", .image = image};
	maker.view = view;
	if (setup->polarisation) {
		view->polarisation = setup->polarisation;
		view->map = setup->polarisation->map;
		view->low = setup->polarisation->low;
		view->high = setup->polarisation->high;
		status = make_polarisation(&maker);
	} else if (setup->layer && !setup->expression) {
		status = make_layer(&maker);
	} else {
		status = make_program(&maker, setup->expression ? setup->expression : "a");
	}
	name_view(view, setup);
	if (status != SPEC_OK)
		spec_view_free(view);
	return status;
}

void
spec_view_free(struct spec_view *view)
{
	spec_rgb_free(&view->intensity);
	spec_rgb_free(&view->rest);
	spec_program_free(&view->program);
	free(view->channel);
	*view = (struct spec_view){0};
}

/* --- running --- */

size_t
spec_view_scratch(const struct spec_view *view, size_t width)
{
	return view->polarisation ? 6 * width * sizeof(float)
				  : spec_program_scratch(&view->program);
}

static void
tell_polarisation(const struct spec_view *view, const float *const *row, size_t width,
	float *scratch, float *to)
{
	float *plane[6];

	for (size_t i = 0; i < 6; i++)
		plane[i] = scratch + i * width;
	spec_rgb_row(&view->intensity, row, width, plane[0], plane[1], plane[2]);
	spec_rgb_row(&view->rest, row + view->intensity.terms, width, plane[3], plane[4],
		plane[5]);
	for (size_t x = 0; x < width; x++) {
		const double stokes[4] = {
			plane[0][x], plane[3][x], plane[4][x], plane[5][x]};

		to[x] = (float)view->polarisation->of(stokes);
	}
}

static void
copy_channel(const struct spec_channel *channel, const float *from, size_t width, float *to)
{
	if (channel->role != SPEC_ROLE_OTHER || channel->sample != SPEC_SAMPLE_UINT) {
		memcpy(to, from, width * sizeof *to);
		return;
	}
	for (size_t x = 0; x < width; x++) {
		uint32_t whole;

		memcpy(&whole, &from[x], sizeof whole);
		to[x] = (float)whole;
	}
}

void
spec_view_row(const struct spec_view *view, const float *const *row, size_t width, int y,
	void *scratch, float *to)
{
	if (view->polarisation) {
		tell_polarisation(view, row, width, scratch, to);
	} else if (view->program.instructions > 0) {
		spec_program_run(&view->program, row, width, y, scratch, to);
	} else {
		for (size_t i = 0; i < view->terms; i++)
			copy_channel(&view->image->channel[view->channel[i]], row[i], width,
				to + i * width);
		if (view->numbers > view->terms) /* uv: no blue */
			memset(to + view->terms * width, 0, width * sizeof *to);
	}
}
