#include "render/daylight.h"

#include <math.h>
#include <stdlib.h>

#include "base/memory.h"

#define SHARE_ROWS 128  /* of directions, 1.4 degrees high each */
#define BIN_STEP_NM 1.0 /* bins are averaged at points no farther apart, and at 4 or more */
#define LEAST_POINTS 4
#define LOWEST_NM SPEC_CLEARSKY_LOW_NM
#define HIGHEST_NM SPEC_CLEARSKY_HIGH_NM

/* --- bands --- */

static void
take_weight(struct spec_daylight_share *share, size_t bands, size_t band, double part,
	const struct spec_dome_weight *weight)
{
	float *low = share->part + (size_t)weight->index * bands + band;

	low[0] += (float)(part * weight->low);
	low[bands] += (float)(part * weight->high);
}

/* The mean over a bin, by its middles. */
static enum spec_status
share_bin(struct spec_daylight *daylight, const struct spec_bands_grid *bands, size_t band,
	struct spec_error *error)
{
	double from_nm = bands->edges_nm[band], to_nm = bands->edges_nm[band + 1];
	double points = fmax(LEAST_POINTS, ceil((to_nm - from_nm) / BIN_STEP_NM));
	enum spec_status status = SPEC_OK;

	for (double i = 0; i < points && status == SPEC_OK; i++) {
		double nm = from_nm + (to_nm - from_nm) * (i + 0.5) / points;
		struct spec_dome_weight sky, disc;

		if (!(nm >= LOWEST_NM && nm <= HIGHEST_NM))
			continue;
		status = spec_dome_weigh(&daylight->dome, &nm, 1, &sky, &disc, error);
		if (status != SPEC_OK)
			continue;
		take_weight(&daylight->sky, daylight->bands, band, 1 / points, &sky);
		take_weight(&daylight->disc, daylight->bands, band, 1 / points, &disc);
	}
	return status;
}

static void
find_ends(struct spec_daylight_share *share, size_t bands)
{
	for (size_t i = 0; i < SPEC_DOME_BANDS; i++) {
		const float *part = share->part + i * bands;

		share->last[i] = bands;
		while (share->last[i] > 0 && part[share->last[i] - 1] == 0)
			share->last[i]--;
		while (share->first[i] < share->last[i] && part[share->first[i]] == 0)
			share->first[i]++;
	}
}

static enum spec_status
share_bands(struct spec_daylight *daylight, const struct spec_bands_grid *bands,
	struct spec_error *error)
{
	size_t count = bands->count * SPEC_DOME_BANDS;
	enum spec_status status = SPEC_OK;

	daylight->sky.part = spec_memory_new(count, sizeof(float), "bands", error);
	daylight->disc.part = spec_memory_new(count, sizeof(float), "bands", error);
	if (!daylight->sky.part || !daylight->disc.part)
		return SPEC_ENOMEM;
	for (size_t i = 0; i < bands->count && status == SPEC_OK; i++)
		status = share_bin(daylight, bands, i, error);
	find_ends(&daylight->sky, bands->count);
	find_ends(&daylight->disc, bands->count);
	return status;
}

static void
add_share(const struct spec_daylight *daylight, const struct spec_daylight_share *share,
	const double value[SPEC_DOME_BANDS], const float *factor, double weight,
	float *radiance)
{
	for (size_t i = 0; i < SPEC_DOME_BANDS; i++) {
		size_t first = share->first[i];

		spec_bands_add_product(radiance + first, factor + first,
			share->part + i * daylight->bands + first,
			(float)(weight * value[i]), share->last[i] - first);
	}
}

/* The mean over bands of what one value in each of the dome's bands becomes. */
static double
mean_of_share(const struct spec_daylight *daylight, const struct spec_daylight_share *share,
	const double value[SPEC_DOME_BANDS])
{
	double sum = 0;

	for (size_t i = 0; i < SPEC_DOME_BANDS; i++)
		for (size_t j = share->first[i]; j < share->last[i]; j++)
			sum += value[i] * share->part[i * daylight->bands + j];
	return sum / (double)daylight->bands;
}

/* --- the ground --- */

/*
 * The irradiance of the sky on a horizontal plane in the dome's bands: rings of equal width of
 * sin^2 of the angle from the zenith, 1e-4 off at most.
 */
static void
irradiate(const struct spec_dome *dome, double irradiance[SPEC_DOME_BANDS])
{
	enum { RINGS = 64, SECTORS = 128 };

	for (size_t k = 0; k < SPEC_DOME_BANDS; k++)
		irradiance[k] = 0;
	for (int i = 0; i < RINGS; i++) {
		double sine = sqrt((i + 0.5) / RINGS), cosine = sqrt(1 - sine * sine);

		for (int j = 0; j < SECTORS; j++) {
			double angle = 2 * M_PI * (j + 0.5) / SECTORS,
			       band[SPEC_DOME_BANDS];
			double direction[3] = {
				sine * sin(angle), sine * cos(angle), cosine};

			spec_dome_sky(dome, direction, band);
			for (size_t k = 0; k < SPEC_DOME_BANDS; k++)
				irradiance[k] += band[k] * M_PI / (RINGS * SECTORS);
		}
	}
}

static enum spec_status
light_ground(struct spec_daylight *daylight, double albedo, struct spec_error *error)
{
	const struct spec_dome *dome = &daylight->dome;
	double from_sky[SPEC_DOME_BANDS], from_sun[SPEC_DOME_BANDS];
	size_t bands = daylight->bands;
	float *ones = spec_memory_new(bands, sizeof *ones, "bands", error);

	daylight->ground = spec_memory_new(bands, sizeof *daylight->ground, "bands", error);
	if (!ones || !daylight->ground) {
		free(ones);
		return SPEC_ENOMEM;
	}
	for (size_t i = 0; i < bands; i++)
		ones[i] = 1;
	irradiate(dome, from_sky);
	for (size_t i = 0; i < SPEC_DOME_BANDS; i++)
		from_sun[i] = dome->disc[i] * daylight->sun_sr * dome->sun[2];
	add_share(
		daylight, &daylight->sky, from_sky, ones, albedo / M_PI, daylight->ground);
	if (daylight->has_sun)
		add_share(daylight, &daylight->disc, from_sun, ones, albedo / M_PI,
			daylight->ground);
	free(ones);
	return SPEC_OK;
}

/* --- directions --- */

/* What a direction but the sun's sends, in the mean over the bands. */
static double
mean_radiance(const void *state, struct spec_vector direction)
{
	const struct spec_daylight *daylight = state;
	const double d[3] = {direction.x, direction.y, direction.z};
	double band[SPEC_DOME_BANDS], sum = 0;

	if (direction.z >= 0) {
		spec_dome_sky(&daylight->dome, d, band);
		return mean_of_share(daylight, &daylight->sky, band);
	}
	for (size_t i = 0; i < daylight->bands; i++)
		sum += daylight->ground[i];
	return sum / (double)daylight->bands;
}

/* Half by the light of both, half equally: the sun alone casts shadows. */
static enum spec_status
share_directions(struct spec_daylight *daylight, struct spec_error *error)
{
	double sun = 0, rest;
	enum spec_status status = spec_surroundings_plan(
		&daylight->shares, SHARE_ROWS, mean_radiance, daylight, error);

	if (status != SPEC_OK)
		return status;
	rest = 4 * M_PI * daylight->shares.mean;
	if (daylight->has_sun)
		sun = daylight->sun_sr *
		      mean_of_share(daylight, &daylight->disc, daylight->dome.disc);
	daylight->mean = (sun + rest) / (4 * M_PI);
	daylight->sun_chance = sun > 0 ? (sun / (sun + rest) + 0.5) / 2 : 0;
	return SPEC_OK;
}

enum spec_status
spec_daylight_make(struct spec_daylight *daylight, const struct spec_scene_daylight *light,
	const struct spec_bands_grid *bands, struct spec_error *error)
{
	enum spec_status status;

	*daylight =
		(struct spec_daylight){.bands = bands->count, .has_sun = light->has_sun};
	daylight->axes = (struct spec_frame){spec_vector_of(light->east),
		spec_vector_of(light->north), spec_vector_of(light->up)};
	status = spec_dome_make(
		&light->sun, &light->sunlight.atmosphere, &daylight->dome, error);
	if (status == SPEC_OK) {
		daylight->sun_sr = spec_dome_disc_sr(&daylight->dome);
		daylight->sun = spec_frame_about(
			spec_vector_unit(spec_vector_of(daylight->dome.sun)));
		status = share_bands(daylight, bands, error);
	}
	if (status == SPEC_OK)
		status = light_ground(
			daylight, light->sunlight.atmosphere.ground_albedo, error);
	return status == SPEC_OK ? share_directions(daylight, error) : status;
}

void
spec_daylight_free(struct spec_daylight *daylight)
{
	spec_dome_free(&daylight->dome);
	spec_surroundings_free(&daylight->shares);
	free(daylight->sky.part);
	free(daylight->disc.part);
	free(daylight->ground);
	*daylight = (struct spec_daylight){0};
}

/* --- a direction --- */

/* 1 - cos of the angle to the sun's middle, which keeps its digits where it is small. */
static double
versine_to_sun(const struct spec_daylight *daylight, struct spec_vector local)
{
	struct spec_vector off = spec_vector_subtract(local, daylight->sun.z);

	return spec_vector_dot(off, off) / 2;
}

static double
versine_of_disc(const struct spec_daylight *daylight)
{
	return daylight->sun_sr / (2 * M_PI);
}

void
spec_daylight_add(const struct spec_daylight *daylight, struct spec_vector direction,
	const float *factor, double weight, float *radiance)
{
	struct spec_vector local = spec_frame_to_local(&daylight->axes, direction);
	const double d[3] = {local.x, local.y, local.z};
	double band[SPEC_DOME_BANDS];

	if (local.z < 0) {
		spec_bands_add_product(
			radiance, factor, daylight->ground, (float)weight, daylight->bands);
		return;
	}
	spec_dome_sky(&daylight->dome, d, band);
	add_share(daylight, &daylight->sky, band, factor, weight, radiance);
	/* On the edge rounding decides, and nobody else is asked. */
	if (daylight->has_sun &&
		versine_to_sun(daylight, local) <= 1.01 * versine_of_disc(daylight) &&
		spec_dome_disc(&daylight->dome, d, band))
		add_share(daylight, &daylight->disc, band, factor, weight, radiance);
}

double
spec_daylight_density(const struct spec_daylight *daylight, struct spec_vector direction)
{
	struct spec_vector local = spec_frame_to_local(&daylight->axes, direction);
	double density = (1 - daylight->sun_chance) *
			 spec_surroundings_density(&daylight->shares, local);

	if (daylight->sun_chance > 0 &&
		versine_to_sun(daylight, local) <= versine_of_disc(daylight))
		density += daylight->sun_chance / daylight->sun_sr;
	return density;
}

double
spec_daylight_sample(const struct spec_daylight *daylight, const double pair[2],
	double number, struct spec_vector *direction)
{
	struct spec_vector local;

	if (number < daylight->sun_chance) {
		double versine = pair[0] * versine_of_disc(daylight);
		double sine = sqrt(versine * (2 - versine)), angle = 2 * M_PI * pair[1];

		local = spec_frame_to_world(
			&daylight->sun, (struct spec_vector){sine * cos(angle),
						sine * sin(angle), 1 - versine});
	} else {
		(void)spec_surroundings_sample(&daylight->shares, pair, &local);
	}
	*direction = spec_vector_unit(spec_frame_to_world(&daylight->axes, local));
	return spec_daylight_density(daylight, *direction);
}
