#include "render/material.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "base/memory.h"
#include "base/vector.h"
#include "optics/fresnel.h"

#define SMOOTHEST 1e-3    /* alpha below which a surface is a mirror */
#define LEAST_CHANCE 0.05 /* of either side of a choice that is not sure */

static enum spec_status
make_conductor(struct spec_material *material, const struct spec_scene *scene,
	const struct spec_scene_material *from, const struct spec_bands_grid *bands,
	struct spec_error *error)
{
	enum spec_status status = spec_bands_sample(
		bands, scene, &from->eta, SPEC_BANDS_INDEX, material->eta, error);

	if (status == SPEC_OK)
		status = spec_bands_sample(
			bands, scene, &from->k, SPEC_BANDS_INDEX, material->k, error);
	return status;
}

static enum spec_status
make_dielectric(struct spec_material *material, const struct spec_scene *scene,
	const struct spec_scene_material *from, const struct spec_bands_grid *bands,
	struct spec_error *error)
{
	enum spec_status status = spec_bands_sample(
		bands, scene, &from->eta, SPEC_BANDS_INDEX, material->eta, error);

	for (size_t i = 1; i < bands->count && status == SPEC_OK; i++)
		material->dispersive |= material->eta[i] != material->eta[0];
	if (status == SPEC_OK && (material->alpha[0] > 0 || material->alpha[1] > 0)) {
		status = spec_error_set(error, SPEC_EUNSUPPORTED,
			"a rough dielectric cannot be rendered yet");
		spec_scene_prefix(scene, &from->place, error);
	}
	return status;
}

static enum spec_status
make_diffuse(struct spec_material *material, const struct spec_scene *scene,
	const struct spec_scene_material *from, const struct spec_bands_grid *bands,
	struct spec_error *error)
{
	enum spec_status status = spec_bands_sample(
		bands, scene, &from->reflectance, SPEC_BANDS_RATIO, material->eta, error);

	for (size_t i = 0; i < bands->count && status == SPEC_OK; i++)
		material->reflectance[i] = (float)material->eta[i];
	return status;
}

static enum spec_status
make_film(struct spec_material *material, const struct spec_scene *scene,
	const struct spec_scene_material *from, const struct spec_bands_grid *bands,
	struct spec_error *error)
{
	struct spec_recipe recipe = {0};
	struct spec_thickness thickness;
	enum spec_status status = spec_recipe_parse(from->stack, &recipe, error);

	if (status == SPEC_OK && from->thickness)
		status = spec_thickness_parse(from->thickness, &thickness, error);
	if (status == SPEC_OK)
		status = spec_coating_make(&material->coating, &recipe,
			from->thickness ? &thickness : NULL, bands->wavelength_nm,
			bands->count, bands->extrapolate, error);
	spec_recipe_free(&recipe);
	if (status != SPEC_OK)
		spec_scene_prefix(scene, &from->place, error);
	return status;
}

static enum spec_status
make_disc(struct spec_material *material, const struct spec_scene_material *from,
	struct spec_error *error)
{
	const struct spec_disc *disc = spec_disc_find(from->preset, error);

	if (!disc)
		return SPEC_EUSAGE;
	material->disc = *disc;
	return SPEC_OK;
}

/* Smooth both ways, or rough both ways, if little. */
static void
set_alpha(double alpha[2], const double roughness[2])
{
	int smooth = roughness[0] < SMOOTHEST && roughness[1] < SMOOTHEST;

	for (int i = 0; i < 2; i++)
		alpha[i] = smooth ? 0 : fmax(roughness[i], SMOOTHEST);
}

static enum spec_status
make_material(struct spec_material *material, const struct spec_scene *scene,
	const struct spec_scene_material *from, const struct spec_bands_grid *bands,
	struct spec_error *error)
{
	size_t count = bands->count;

	material->kind = from->kind;
	material->bands = count;
	material->wavelength_nm = bands->wavelength_nm;
	material->edges_nm = bands->edges_nm;
	set_alpha(material->alpha, from->roughness);
	material->reflectance = spec_memory_new(count, sizeof(float), "bands", error);
	material->eta = spec_memory_new(count, sizeof(double), "bands", error);
	material->k = spec_memory_new(count, sizeof(double), "bands", error);
	if (!material->reflectance || !material->eta || !material->k)
		return SPEC_ENOMEM;
	switch (from->kind) {
	case SPEC_SCENE_DIFFUSE:
		return make_diffuse(material, scene, from, bands, error);
	case SPEC_SCENE_CONDUCTOR:
		return make_conductor(material, scene, from, bands, error);
	case SPEC_SCENE_DIELECTRIC:
		return make_dielectric(material, scene, from, bands, error);
	case SPEC_SCENE_THINFILM:
		return make_film(material, scene, from, bands, error);
	case SPEC_SCENE_DIFFRACTIVE:
		return make_disc(material, from, error);
	default:
		return SPEC_OK;
	}
}

enum spec_status
spec_materials_make(struct spec_material **list, const struct spec_scene *scene,
	const struct spec_bands_grid *bands, struct spec_error *error)
{
	enum spec_status status = SPEC_OK;

	*list = spec_memory_new(scene->materials, sizeof **list, "materials", error);
	if (!*list)
		return SPEC_ENOMEM;
	for (size_t i = 0; i < scene->materials && status == SPEC_OK; i++)
		status = make_material(
			&(*list)[i], scene, &scene->material[i], bands, error);
	if (status != SPEC_OK) {
		spec_materials_free(*list, scene->materials);
		*list = NULL;
	}
	return status;
}

void
spec_materials_free(struct spec_material *list, size_t count)
{
	for (size_t i = 0; list && i < count; i++) {
		free(list[i].reflectance);
		free(list[i].eta);
		free(list[i].k);
		spec_coating_free(&list[i].coating);
	}
	free(list);
}

static int
is_smooth(const struct spec_material *material)
{
	return material->alpha[0] == 0;
}

int
spec_material_is_rough(const struct spec_material *material)
{
	return material->kind == SPEC_SCENE_DIFFUSE ||
	       material->kind == SPEC_SCENE_DIFFRACTIVE ||
	       (material->kind == SPEC_SCENE_CONDUCTOR && !is_smooth(material));
}

/* The shading frame on the side of the eye, x along the tangent. */
static struct spec_frame
frame_of(const struct spec_surface *surface)
{
	struct spec_vector normal = surface->hit->shading, tangent;
	struct spec_frame frame;

	if (surface->cosine < 0)
		normal = spec_vector_negate(normal);
	if (surface->material->kind == SPEC_SCENE_DIFFUSE) /* any frame will do */
		return spec_frame_about(normal);
	tangent = surface->hit->tangent;
	tangent = spec_vector_along(tangent, normal, -spec_vector_dot(tangent, normal));
	if (!(spec_vector_dot(tangent, tangent) > 1e-12))
		return spec_frame_about(normal);
	frame.z = normal;
	frame.x = spec_vector_unit(tangent);
	frame.y = spec_vector_cross(frame.z, frame.x);
	return frame;
}

SPEC_VECTORISED static void
scale_values(float *to, const float *from, float factor, size_t count)
{
	for (size_t i = 0; i < count; i++) /* in place, too */
		to[i] = factor * from[i];
}

/*
 * Sine and cosine for |x| <= pi / 4, to an ulp: the polynomials of fdlibm's k_sin.c and
 * k_cos.c. There is no range to reduce, and no call.
 */
static double
small_sine(double x)
{
	double z = x * x, zz = z * z;
	double low = -1.66666666666666324348e-01 + z * 8.33333333332248946124e-03;
	double middle = -1.98412698298579493134e-04 + z * 2.75573137070700676789e-06;
	double high = -2.50507602534068634195e-08 + z * 1.58969099521155010221e-10;

	return x + x * z * (low + zz * (middle + zz * high));
}

static double
small_cosine(double x)
{
	double z = x * x, zz = z * z;
	double low = 4.16666666666666019037e-02 + z * -1.38888888888741095749e-03;
	double middle = 2.48015872894767294178e-05 + z * -2.75573143513906633035e-07;
	double high = 2.08757232129817482790e-09 + z * -1.13596475577881948265e-11;

	return 1 - z * (0.5 - z * (low + zz * (middle + zz * high)));
}

/*
 * Malley: uniform on the disk, then up. Shirley & Chiu 1997 keep strata whole. Which of the
 * two is longer is chance: an index does not make the processor guess.
 */
static struct spec_vector
sample_cosine(const double pair[2])
{
	double at[2] = {2 * pair[0] - 1, 2 * pair[1] - 1}, angle;
	int longer = fabs(at[0]) <= fabs(at[1]);
	double radius = at[longer];

	if (radius == 0)
		return (struct spec_vector){0, 0, 1};
	angle = M_PI / 4 * (at[!longer] / radius);
	at[longer] = radius * small_cosine(angle);
	at[!longer] = radius * small_sine(angle);
	return (struct spec_vector){at[0], at[1], sqrt(1 - radius * radius)};
}

/* --- Trowbridge-Reitz (GGX), after Heitz, JCGT 3(2), 2014, and 7(4), 2018 --- */

static double
facets(const double alpha[2], struct spec_vector m)
{
	double x = m.x / alpha[0], y = m.y / alpha[1];
	double square = x * x + y * y + m.z * m.z;

	return 1 / (M_PI * alpha[0] * alpha[1] * square * square);
}

static double
lambda_of(const double alpha[2], struct spec_vector w)
{
	double x = alpha[0] * w.x, y = alpha[1] * w.y;

	return w.z == 0 ? INFINITY : (sqrt(1 + (x * x + y * y) / (w.z * w.z)) - 1) / 2;
}

static struct spec_vector
sample_facet(const double alpha[2], struct spec_vector eye, const double pair[2])
{
	struct spec_vector stretched = spec_vector_unit(
		(struct spec_vector){alpha[0] * eye.x, alpha[1] * eye.y, eye.z});
	struct spec_frame frame = spec_frame_about(stretched);
	double radius = sqrt(pair[0]), angle = 2 * M_PI * pair[1];
	double a = radius * cos(angle), b = radius * sin(angle);
	double seen = (1 + stretched.z) / 2, c;
	struct spec_vector up, across, m;

	/* The half of the disk that is turned away from the eye is narrower. */
	across = stretched.z < 0.9999999
			 ? spec_vector_unit(spec_vector_cross(
				   (struct spec_vector){0, 0, 1}, stretched))
			 : frame.x;
	up = spec_vector_cross(stretched, across);
	b = (1 - seen) * sqrt(fmax(0, 1 - a * a)) + seen * b;
	c = sqrt(fmax(0, 1 - a * a - b * b));
	m = spec_vector_along(
		spec_vector_along(spec_vector_scale(across, a), up, b), stretched, c);
	return spec_vector_unit(
		(struct spec_vector){alpha[0] * m.x, alpha[1] * m.y, fmax(m.z, 1e-9)});
}

/* Density of sample_facet's mirror direction. */
static double
facet_density(const double alpha[2], struct spec_vector eye, struct spec_vector m)
{
	double g1 = 1 / (1 + lambda_of(alpha, eye));

	return facets(alpha, m) * g1 / (4 * eye.z);
}

static void
conductor_fresnel(
	const struct spec_material *material, double cosine, float *value, double factor)
{
	double one[256], s[256], p[256];
	size_t done, part;

	for (done = 0; done < material->bands; done += part) {
		part = material->bands - done < 256 ? material->bands - done : 256;
		for (size_t i = 0; i < part; i++)
			one[i] = 1;
		spec_fresnel_spectrum(
			cosine, one, material->eta + done, material->k + done, part, s, p);
		for (size_t i = 0; i < part; i++)
			value[done + i] = (float)((s[i] + p[i]) / 2 * factor);
	}
}

static double
evaluate_conductor(const struct spec_surface *surface, const struct spec_frame *frame,
	struct spec_vector light, float *value)
{
	const struct spec_material *material = surface->material;
	struct spec_vector eye = spec_frame_to_local(frame, surface->eye);
	struct spec_vector to = spec_frame_to_local(frame, light), m;
	double g2;

	if (!(to.z > 0) || !(eye.z > 0))
		return 0;
	m = spec_vector_unit(spec_vector_add(eye, to));
	g2 = 1 / (1 + lambda_of(material->alpha, eye) + lambda_of(material->alpha, to));
	conductor_fresnel(material, spec_vector_dot(eye, m), value,
		facets(material->alpha, m) * g2 / (4 * eye.z));
	return facet_density(material->alpha, eye, m);
}

static double
sample_conductor(const struct spec_surface *surface, struct spec_sampler *sampler,
	struct spec_vector *direction, float *weight)
{
	const struct spec_material *material = surface->material;
	struct spec_frame frame = frame_of(surface);
	struct spec_vector eye = spec_frame_to_local(&frame, surface->eye), to, m;
	double pair[2], g1, g2;

	if (!(eye.z > 0))
		return -1;
	if (is_smooth(material)) {
		*direction = spec_vector_mirror(surface->eye, frame.z);
		conductor_fresnel(material, eye.z, weight, 1);
		return 0;
	}
	spec_sampler_pair(sampler, pair);
	m = sample_facet(material->alpha, eye, pair);
	to = spec_vector_mirror(eye, m);
	if (!(to.z > 0))
		return -1;
	g1 = 1 + lambda_of(material->alpha, eye);
	g2 = g1 + lambda_of(material->alpha, to);
	conductor_fresnel(material, spec_vector_dot(eye, m), weight, g1 / g2);
	*direction = spec_frame_to_world(&frame, to);
	return facet_density(material->alpha, eye, m);
}

/* --- discs: T's composite model, sampled by its diffuse part and its highlight --- */

static double
disc_density(
	const struct spec_material *material, struct spec_vector eye, struct spec_vector to)
{
	struct spec_vector half = spec_vector_unit(spec_vector_add(eye, to));
	double alpha = material->disc.specular_exponent;
	double lobe = (alpha + 1) / (2 * M_PI) * pow(fmax(half.z, 0), alpha);
	double cosine = spec_vector_dot(eye, half);

	return to.z / M_PI / 2 + (cosine > 0 ? lobe / (4 * cosine) / 2 : 0);
}

static double
evaluate_disc(const struct spec_surface *surface, const struct spec_frame *frame,
	struct spec_vector light, float *value)
{
	const struct spec_material *material = surface->material;
	struct spec_vector eye = spec_frame_to_local(frame, surface->eye);
	struct spec_vector to = spec_frame_to_local(frame, light), sum;
	double along, across, half_cosine, length;
	struct spec_disc_bands bands = {
		material->bands, material->wavelength_nm, material->edges_nm};
	struct spec_disc_pixels pixel = {.count = 1,
		.along = &along,
		.across = &across,
		.half_cosine = &half_cosine};
	double *reflection = surface->room;

	if (!(to.z > 0) || !(eye.z > 0))
		return 0;
	sum = spec_vector_add(eye, to);
	length = spec_vector_length(sum);
	along = sum.x;
	across = sum.y;
	half_cosine = length > 0 ? sum.z / length : 0;
	spec_disc_composite(&material->disc, &bands, &pixel, reflection, 1);
	for (size_t i = 0; i < material->bands; i++)
		value[i] = (float)(reflection[i] * to.z);
	return disc_density(material, eye, to);
}

static double
sample_disc(const struct spec_surface *surface, struct spec_sampler *sampler,
	struct spec_vector *direction, float *weight)
{
	const struct spec_material *material = surface->material;
	struct spec_frame frame = frame_of(surface);
	struct spec_vector eye = spec_frame_to_local(&frame, surface->eye), to;
	double pair[2], density, alpha = material->disc.specular_exponent;

	spec_sampler_pair(sampler, pair);
	if (spec_sampler_number(sampler) < 0.5) {
		to = sample_cosine(pair);
	} else {
		double cosine = pow(1 - pair[0], 1 / (alpha + 1));
		double sine = sqrt(fmax(0, 1 - cosine * cosine)),
		       angle = 2 * M_PI * pair[1];

		to = spec_vector_mirror(eye,
			(struct spec_vector){sine * cos(angle), sine * sin(angle), cosine});
	}
	if (!(to.z > 0) || !(surface->cosine > 0))
		return -1;
	*direction = spec_frame_to_world(&frame, to);
	density = evaluate_disc(surface, &frame, *direction, weight);
	if (!(density > 0))
		return -1;
	scale_values(weight, weight, (float)(1 / density), material->bands);
	return density;
}

/* --- choices between a mirrored and a straight or refracted ray --- */

/* The chance of being mirrored: by the mean over the bands of what the path still carries. */
static double
chance_of(const double *mirrored, const double *through, const float *throughput,
	size_t count)
{
	double first = 0, second = 0, chance;

	for (size_t i = 0; i < count; i++) {
		first += mirrored[i] * throughput[i];
		second += through[i] * throughput[i];
	}
	if (!(first + second > 0))
		return first > 0 ? 1 : 0;
	chance = first / (first + second);
	if (first > 0 && chance < LEAST_CHANCE)
		chance = LEAST_CHANCE;
	if (second > 0 && chance > 1 - LEAST_CHANCE)
		chance = 1 - LEAST_CHANCE;
	return chance;
}

/* Turns values to weights of a choice that had this chance. */
static void
weigh(const double *value, double chance, float *weight, size_t count)
{
	for (size_t i = 0; i < count; i++)
		weight[i] = (float)(value[i] / chance);
}

/* What a film mirrors and lets straight through, in each band; as spec_coating_row. */
static void
film_factors(const struct spec_surface *surface, double *mirrored, double *through)
{
	const struct spec_coating *coating = &surface->material->coating;
	const struct spec_vector *object = &surface->hit->object;
	float height[] = {(float)object->x, (float)object->y, (float)object->z};
	double thickness_nm, cosine = fmin(fabs(surface->cosine), 1);

	spec_thickness_row(
		&coating->thickness, &height[coating->thickness.up], 1, &thickness_nm);
	spec_coating_spectrum(
		coating, surface->cosine < 0, cosine, thickness_nm, mirrored, through);
}

static double
sample_film(const struct spec_surface *surface, const float *throughput,
	struct spec_sampler *sampler, struct spec_vector *direction, float *weight)
{
	size_t count = surface->material->bands;
	double *mirrored = surface->room, *through = surface->room + count, chance;

	if (surface->cosine < 0 && !surface->material->coating.clear_behind)
		return -1;
	film_factors(surface, mirrored, through);
	chance = chance_of(mirrored, through, throughput, count);
	if (spec_sampler_number(sampler) < chance) {
		*direction = spec_vector_mirror(surface->eye, surface->hit->shading);
		weigh(mirrored, chance, weight, count);
	} else {
		*direction = spec_vector_negate(surface->eye);
		weigh(through, 1 - chance, weight, count);
	}
	return 0;
}

/* Snell; 0 beyond the critical angle. ratio: index on the eye's side over the other's. */
static int
refract(struct spec_vector eye, struct spec_vector normal, double ratio,
	struct spec_vector *direction)
{
	double cosine = spec_vector_dot(eye, normal);
	double square = 1 - ratio * ratio * (1 - cosine * cosine);

	if (square <= 0)
		return 0;
	*direction = spec_vector_unit(spec_vector_along(
		spec_vector_scale(eye, -ratio), normal, ratio * cosine - sqrt(square)));
	return 1;
}

/*
 * Where the index varies, the path goes on with one band alone, chosen by what it carries
 * (degradation, Evans & McCool 1999).
 */
static size_t
choose_band(const float *throughput, size_t count, double number, double *chance)
{
	double sum = 0, part = 0;
	size_t last = 0;

	for (size_t i = 0; i < count; i++)
		sum += throughput[i];
	for (size_t i = 0; i < count; i++) {
		if (!(throughput[i] > 0))
			continue;
		last = i;
		part += throughput[i];
		if (part > number * sum)
			break;
	}
	*chance = throughput[last] / sum;
	return last;
}

static double
sample_dielectric(const struct spec_surface *surface, const float *throughput,
	struct spec_sampler *sampler, struct spec_vector *direction, float *weight)
{
	const struct spec_material *material = surface->material;
	struct spec_vector normal = surface->hit->shading;
	double kept = 1, cosine = fmin(fabs(surface->cosine), 1), n1, n2, mirrored;
	struct spec_vector refracted;
	size_t band = 0;

	if (material->dispersive)
		band = choose_band(
			throughput, material->bands, spec_sampler_number(sampler), &kept);
	n1 = surface->cosine < 0 ? material->eta[band] : 1;
	n2 = surface->cosine < 0 ? 1 : material->eta[band];
	if (surface->cosine < 0)
		normal = spec_vector_negate(normal);
	mirrored = spec_fresnel_mean(
		spec_fresnel_dielectric(cosine, n1, n2), SPEC_POLARISATION_NONE);
	if (!refract(surface->eye, normal, n1 / n2, &refracted))
		mirrored = 1;
	/* Chosen with the chance that it has: what is left is a weight of 1. */
	*direction = spec_sampler_number(sampler) < mirrored
			     ? spec_vector_mirror(surface->eye, normal)
			     : refracted;
	for (size_t i = 0; i < material->bands; i++) {
		double value = material->dispersive ? (i == band) / kept : 1;

		/* Radiance is narrowed or widened with the solid angle. */
		if (spec_vector_dot(*direction, normal) < 0)
			value *= n1 * n1 / (n2 * n2);
		weight[i] = (float)value;
	}
	return 0;
}

/* --- all materials --- */

double
spec_material_evaluate(const struct spec_surface *surface, struct spec_vector light,
	struct spec_bands_scaled *value)
{
	const struct spec_material *material = surface->material;
	struct spec_frame frame = frame_of(surface);
	double cosine = spec_vector_dot(light, frame.z);

	/* Light that would leak through the surface, past a bent shading normal. */
	if (spec_vector_dot(light, surface->hit->normal) *
			spec_vector_dot(surface->eye, surface->hit->normal) <=
		0)
		return 0;
	value->value = value->room;
	value->scale = 1;
	if (material->kind == SPEC_SCENE_CONDUCTOR)
		return evaluate_conductor(surface, &frame, light, value->room);
	if (material->kind == SPEC_SCENE_DIFFRACTIVE) /* dark from behind */
		return surface->cosine > 0
			       ? evaluate_disc(surface, &frame, light, value->room)
			       : 0;
	if (material->kind != SPEC_SCENE_DIFFUSE || !(cosine > 0))
		return 0;
	value->value = material->reflectance;
	return value->scale = cosine / M_PI;
}

static double
sample_diffuse(const struct spec_surface *surface, struct spec_sampler *sampler,
	struct spec_vector *direction, struct spec_bands_scaled *weight)
{
	struct spec_frame frame = frame_of(surface);
	struct spec_vector local;
	double pair[2];

	spec_sampler_pair(sampler, pair);
	local = sample_cosine(pair);
	if (!(local.z > 0))
		return -1;
	*direction = spec_frame_to_world(&frame, local);
	weight->value = surface->material->reflectance;
	return local.z / M_PI;
}

double
spec_material_sample(const struct spec_surface *surface, const float *throughput,
	struct spec_sampler *sampler, struct spec_vector *direction,
	struct spec_bands_scaled *weight)
{
	float *room = weight->room;
	double density = -1;

	weight->value = room;
	weight->scale = 1;
	switch (surface->material->kind) {
	case SPEC_SCENE_DIFFUSE:
		density = sample_diffuse(surface, sampler, direction, weight);
		break;
	case SPEC_SCENE_CONDUCTOR:
		density = sample_conductor(surface, sampler, direction, room);
		break;
	case SPEC_SCENE_DIFFRACTIVE:
		density = sample_disc(surface, sampler, direction, room);
		break;
	case SPEC_SCENE_DIELECTRIC:
		return sample_dielectric(surface, throughput, sampler, direction, room);
	case SPEC_SCENE_THINFILM:
		return sample_film(surface, throughput, sampler, direction, room);
	case SPEC_SCENE_INTERFACE:
		*direction = spec_vector_negate(surface->eye);
		for (size_t i = 0; i < surface->material->bands; i++)
			room[i] = 1;
		return 0;
	}
	/* Into the surface, past a bent shading normal. */
	if (density >= 0 &&
		spec_vector_dot(*direction, surface->hit->normal) *
				spec_vector_dot(surface->eye, surface->hit->normal) <=
			0)
		return -1;
	return density;
}
