/*
 * Recipes: stacks of thin films in the language of specfilm.
 *
 *   stack  = medium "|" { item "|" } medium      the ambient, …, the substrate
 *   item   = layer | group
 *   layer  = medium thickness
 *   group  = "(" item { "|" item } ")" "^" times
 *
 * as in "air | (TiO2 60nm | SiO2 95nm)^8 | N-BK7". A medium is what spec_index_parse reads,
 * but for names with blanks or any of | ( ) ^ in them. A thickness is what
 * spec_number_parse_thickness reads, at most SPEC_RECIPE_THICKEST_NM; or *, for the one
 * layer, in no group, whose thickness is left free. times is a whole number from 1 on.
 * Blanks and line breaks are free but in numbers and names; a medium and its thickness need
 * one between them.
 */
#ifndef SPEC_OPTICS_RECIPE_H
#define SPEC_OPTICS_RECIPE_H

#include <stddef.h>

#include "base/error.h"
#include "optics/index.h"
#include "spectrum/curve.h"

#define SPEC_RECIPE_MOST_LAYERS 10000 /* with every group written out */
#define SPEC_RECIPE_DEEPEST 32        /* groups in groups */
#define SPEC_RECIPE_THICKEST_NM 1e9

struct spec_recipe_medium {
	char *name;   /* as it was written */
	size_t at;    /* the byte of the text where it stands first */
	size_t layer; /* the first that consists of it */
	struct spec_index index;
};

struct spec_recipe_layer {
	size_t medium;       /* the number of its medium, from 0 */
	double thickness_nm; /* >= 0; NaN for *; 0 for ambient and substrate */
};

struct spec_recipe {
	char *text;
	size_t media; /* each that is written another way is another, and was read once */
	struct spec_recipe_medium *medium;
	size_t count; /* of the layers, with the ambient and the substrate */
	struct spec_recipe_layer *layer;
	size_t varied; /* the number, from 1, of the layer whose thickness is *; 0: none */
	size_t varied_at; /* the byte of the text where the * stands */
};

/*
 * Reads a recipe, with every group written out.
 * SPEC_EUSAGE: whatever breaks the rules above, or a stack of too many layers. Other
 * statuses as spec_index_parse. Every error but SPEC_ENOMEM has a caret in text under the
 * first byte that is at fault. On an error recipe is empty.
 */
enum spec_status spec_recipe_parse(
	const char *text, struct spec_recipe *recipe, struct spec_error *error);

/* Frees what recipe holds and leaves it empty; null or empty is allowed. */
void spec_recipe_free(struct spec_recipe *recipe);

/* The number of layers between the ambient and the substrate: layer[1] to layer[number]. */
size_t spec_recipe_layers(const struct spec_recipe *recipe);

/*
 * The number, from 1, of the layer whose thickness --thickness sets: the one with *, else
 * the only layer. SPEC_EUSAGE: there is no layer, or there are several and none has *.
 */
enum spec_status spec_recipe_find_varied(
	const struct spec_recipe *recipe, size_t *layer, struct spec_error *error);

/* For a caller without --thickness. SPEC_EUSAGE: a layer has *. */
enum spec_status spec_recipe_check_fixed(
	const struct spec_recipe *recipe, struct spec_error *error);

/*
 * The indices of all media at count wavelengths.
 * n, k: [recipe->count][count] values each, that is (layers + 2) * count: the ambient
 * first, the substrate last. Otherwise, and errors, as spec_index_sample; the message names
 * the medium, and a caret shows it in the text.
 */
enum spec_status spec_recipe_sample(const struct spec_recipe *recipe,
	const double *wavelength_nm, size_t count, enum spec_extrapolate extrapolate,
	double *n, double *k, struct spec_error *error);

#endif
