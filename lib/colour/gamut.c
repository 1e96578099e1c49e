#include "colour/gamut.h"

#include <math.h>
#include <string.h>

#include "base/vector.h"
#include "colour/chroma.h"

#define BLOCK 256 /* pixels at a time */

/* Ottosson 2020: from XYZ of D65 to cones. */
static const double cones[9] = {.8189330101, .3618667424, -.1288597137, .0329845436,
	.9293118715, .0361456387, .0482003018, .2643662691, .6338517070};

static const char *const names[] = {"clip", "desaturate", "scale", "perceptual"};

enum spec_status
spec_gamut_find(const char *name, enum spec_gamut *gamut, struct spec_error *error)
{
	for (size_t i = 0; i < sizeof names / sizeof *names; i++) {
		if (strcmp(names[i], name) == 0) {
			*gamut = (enum spec_gamut)i;
			return SPEC_OK;
		}
	}
	return spec_error_set(error, SPEC_EUSAGE,
		"unknown gamut map '%s': expected clip, desaturate, scale or perceptual",
		name);
}

enum spec_status
spec_gamut_init(struct spec_gamut_map *map, enum spec_gamut kind,
	const struct spec_space *space, struct spec_error *error)
{
	const double one[3] = {1, 1, 1};
	double m[9], white[3];
	enum spec_status status = spec_space_to_xyz(space, m, error);

	*map = (struct spec_gamut_map){.kind = kind, .most = 1, .chroma = 1};
	if (status != SPEC_OK)
		return status;
	memcpy(map->luminance, m + 3, sizeof map->luminance);
	if (kind != SPEC_GAMUT_CLIP && space->coordinates != SPEC_COORDINATES_RGB)
		return spec_error_set(
			error, SPEC_EUSAGE, "%s has no gamut to map to", space->title);
	if (kind != SPEC_GAMUT_PERCEPTUAL)
		return SPEC_OK;
	spec_matrix_multiply(cones, m, map->to_cones);
	spec_matrix_apply(map->to_cones, one, white);
	for (int r = 0; r < 3; r++) {
		if (!(white[r] > 0))
			return spec_error_set(error, SPEC_ERANGE,
				"OKLab does not see the white of %s", space->title);
		for (int c = 0; c < 3; c++)
			map->to_cones[3 * r + c] /= white[r];
	}
	return spec_matrix_invert(map->to_cones, map->from_cones, error);
}

/* Of each pixel the largest component, and the factor of saturation; 1 where none counts. */
SPEC_VECTORISED static void
find_extremes(const double weight[3], const float *restrict r, const float *restrict g,
	const float *restrict b, size_t count, float *restrict most,
	double *restrict chroma)
{
	double red_share = weight[0], green_share = weight[1], blue_share = weight[2];

	for (size_t i = 0; i < count; i++) {
		float red = r[i], green = g[i], blue = b[i];
		double y = red_share * red + green_share * green + blue_share * blue;
		float high = red > green ? red : green, low = red < green ? red : green;
		double part;
		int counts = (y > 0) & (y - y == 0);

		high = high > blue ? high : blue;
		low = low < blue ? low : blue;
		part = y / (y - low);
		most[i] = (counts & (high > 1)) ? high : 1;
		chroma[i] = (counts & (low < 0)) ? part : 1;
	}
}

void
spec_gamut_measure(struct spec_gamut_map *map, const float *const plane[3], size_t count)
{
	double chroma[BLOCK];
	float most[BLOCK];

	for (size_t x0 = 0; x0 < count; x0 += BLOCK) {
		size_t n = count - x0 < BLOCK ? count - x0 : BLOCK;

		find_extremes(map->luminance, plane[0] + x0, plane[1] + x0, plane[2] + x0,
			n, most, chroma);
		for (size_t i = 0; i < n; i++) {
			map->most = most[i] > map->most ? most[i] : map->most;
			map->chroma = chroma[i] < map->chroma ? chroma[i] : map->chroma;
		}
	}
}

SPEC_VECTORISED static void
scale(const struct spec_gamut_map *map, float *restrict r, float *restrict g,
	float *restrict b, size_t count)
{
	double red_share = map->luminance[0], green_share = map->luminance[1],
	       blue_share = map->luminance[2];
	double chroma = map->chroma, most = map->most;

	for (size_t i = 0; i < count; i++) {
		double red = r[i], green = g[i], blue = b[i];
		double y = red_share * red + green_share * green + blue_share * blue;

		r[i] = (float)((y + chroma * (red - y)) / most);
		g[i] = (float)((y + chroma * (green - y)) / most);
		b[i] = (float)((y + chroma * (blue - y)) / most);
	}
}

/* The part of the way from grey to a component that stays within 0 to 1, if it is less. */
static inline double
least_part(double part, double grey, double component)
{
	double limit = component < 0 ? 0 : 1, within = (limit - grey) / (component - grey);
	int leaves = (component < 0) | (component > 1);

	return (leaves & (within < part)) ? within : part;
}

static inline double
clamp(double v)
{
	v = v < 0 ? 0 : v;
	return v > 1 ? 1 : v;
}

SPEC_VECTORISED static void
desaturate(const double weight[3], float *restrict r, float *restrict g, float *restrict b,
	size_t count)
{
	double red_share = weight[0], green_share = weight[1], blue_share = weight[2];

	for (size_t i = 0; i < count; i++) {
		double red = r[i], green = g[i], blue = b[i], sum = red + green + blue;
		double y = red_share * red + green_share * green + blue_share * blue;
		double grey = clamp(y), part = least_part(1, grey, red);
		int finite = sum - sum == 0;

		part = least_part(part, grey, green);
		part = least_part(part, grey, blue);
		r[i] = finite ? (float)clamp(grey + part * (red - grey)) : r[i];
		g[i] = finite ? (float)clamp(grey + part * (green - grey)) : g[i];
		b[i] = finite ? (float)clamp(grey + part * (blue - grey)) : b[i];
	}
}

void
spec_gamut_row(const struct spec_gamut_map *map, float *const plane[3], size_t count)
{
	switch (map->kind) {
	case SPEC_GAMUT_CLIP:
		break;
	case SPEC_GAMUT_DESATURATE:
		desaturate(map->luminance, plane[0], plane[1], plane[2], count);
		break;
	case SPEC_GAMUT_SCALE:
		if (map->most != 1 || map->chroma != 1)
			scale(map, plane[0], plane[1], plane[2], count);
		break;
	case SPEC_GAMUT_PERCEPTUAL:
		spec_chroma_row(map->to_cones, map->from_cones, plane, count);
		break;
	}
}
