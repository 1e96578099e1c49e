/* The bands that are rendered, and scene spectra in them. */
#ifndef SPEC_RENDER_BANDS_H
#define SPEC_RENDER_BANDS_H

#include <stddef.h>

#include "base/error.h"
#include "scene/scene.h"
#include "spectrum/grid.h"

struct spec_bands_grid {
	size_t count;
	double *wavelength_nm; /* the bands' middles, ascending */
	double *edges_nm;      /* [count + 1]: values are means between them */
	/* Of ratios and indices; light ends with its data. */
	enum spec_extrapolate extrapolate;
};

/*
 * The bands of a grid: edges half-way between the wavelengths, and as far beyond the first
 * and the last; a sole one is 1 nm wide. SPEC_ENOMEM.
 */
enum spec_status spec_bands_make(struct spec_bands_grid *bands,
	const struct spec_grid *grid, enum spec_extrapolate extrapolate,
	struct spec_error *error);
void spec_bands_free(struct spec_bands_grid *bands);

/*
 * A list of values in the bands times a number. Who finds the values has room for new ones;
 * what is constant but for the number is pointed to.
 */
struct spec_bands_scaled {
	const float *value; /* [bands] */
	double scale;
	float *room; /* [bands] */
};

/* What a spectrum stands for: an RGB becomes another spectrum in each case. */
enum spec_bands_use {
	SPEC_BANDS_RATIO, /* 0 to 1 */
	SPEC_BANDS_LIGHT,
	SPEC_BANDS_INDEX /* at the middles, where others are means */
};

/*
 * A scene spectrum in the bands: value[count]. Curves are 0 outside their data for light;
 * elsewhere the rule of the bands holds. Errors (SPEC_ERANGE) name the scene's file and line.
 */
enum spec_status spec_bands_sample(const struct spec_bands_grid *bands,
	const struct spec_scene *scene, const struct spec_scene_spectrum *spectrum,
	enum spec_bands_use use, double *value, struct spec_error *error);

/* Adds weight times a times b to sum, band by band. */
void spec_bands_add_product(float *restrict sum, const float *restrict a,
	const float *restrict b, float weight, size_t count);

#endif
