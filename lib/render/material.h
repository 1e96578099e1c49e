/*
 * How surfaces scatter: every direction is chosen once for all bands, and what differs
 * between them is a weight in each. Directions point away from the surface.
 */
#ifndef SPEC_RENDER_MATERIAL_H
#define SPEC_RENDER_MATERIAL_H

#include <stddef.h>

#include "base/error.h"
#include "optics/coating.h"
#include "optics/disc.h"
#include "render/bands.h"
#include "render/sampler.h"
#include "render/space.h"
#include "render/world.h"
#include "scene/scene.h"

struct spec_material {
	enum spec_scene_material_kind kind;
	size_t bands;
	float *reflectance; /* [bands], diffuse */
	double *eta, *k;    /* [bands], conductor; dielectric: eta alone */
	int dispersive;     /* a dielectric whose eta varies */
	double alpha[2];    /* Trowbridge-Reitz; 0: smooth */
	struct spec_coating coating;
	struct spec_disc disc;
	const double *wavelength_nm, *edges_nm; /* of the bands */
};

/* The materials of a scene in bands: *list has scene->materials. */
enum spec_status spec_materials_make(struct spec_material **list,
	const struct spec_scene *scene, const struct spec_bands_grid *bands,
	struct spec_error *error);
void spec_materials_free(struct spec_material *list, size_t count);

/* A surface at a hit, as seen along a ray. */
struct spec_surface {
	const struct spec_material *material;
	const struct spec_hit *hit;
	struct spec_vector eye; /* towards where the ray came from */
	double cosine;          /* of eye and shading normal: < 0 seen from inside */
	double *room;           /* [2 * bands] that the functions may use */
};

/* Whether light can be scattered into directions that are not known beforehand. */
int spec_material_is_rough(const struct spec_material *material);

/*
 * f cos for a direction to a light, in each band, and the density [1/sr] with which
 * spec_material_sample chooses it. Of rough materials alone.
 */
double spec_material_evaluate(const struct spec_surface *surface, struct spec_vector light,
	struct spec_bands_scaled *value);

/*
 * Chooses a direction and what the throughput is multiplied by there: f cos / density, in
 * each band. throughput: of the path so far, for choices that depend on it. Returns the
 * density [1/sr], 0 for directions that no other way can find (mirrors), or -1: absorbed.
 */
double spec_material_sample(const struct spec_surface *surface, const float *throughput,
	struct spec_sampler *sampler, struct spec_vector *direction,
	struct spec_bands_scaled *weight);

#endif
