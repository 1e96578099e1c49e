#include "colour/gamut.h"

#include <math.h>
#include <string.h>

#define STEPS 30 /* of halving: chroma is found to 1e-9 of itself */

/* Ottosson 2020: from XYZ of D65 to cones, and from their cube roots to L, a and b. */
static const double cones[9] = {.8189330101, .3618667424, -.1288597137, .0329845436,
	.9293118715, .0361456387, .0482003018, .2643662691, .6338517070};
static const double oklab_lightness[3] = {.2104542553, .7936177850, -.0040720468};

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

static double
luminance_of(const struct spec_gamut_map *map, const double rgb[3])
{
	return map->luminance[0] * rgb[0] + map->luminance[1] * rgb[1] +
	       map->luminance[2] * rgb[2];
}

void
spec_gamut_measure(struct spec_gamut_map *map, const float *const plane[3], size_t count)
{
	for (size_t i = 0; i < count; i++) {
		double rgb[3] = {plane[0][i], plane[1][i], plane[2][i]};
		double y = luminance_of(map, rgb);
		double least = fmin(rgb[0], fmin(rgb[1], rgb[2]));
		double most = fmax(rgb[0], fmax(rgb[1], rgb[2]));

		if (!isfinite(y) || !(y > 0))
			continue;
		if (most > map->most)
			map->most = most;
		if (least < 0 && y / (y - least) < map->chroma)
			map->chroma = y / (y - least);
	}
}

static void
scale(const struct spec_gamut_map *map, double rgb[3])
{
	double y = luminance_of(map, rgb);

	for (int c = 0; c < 3; c++)
		rgb[c] = (y + map->chroma * (rgb[c] - y)) / map->most;
}

static int
is_inside(const double rgb[3])
{
	return rgb[0] >= 0 && rgb[0] <= 1 && rgb[1] >= 0 && rgb[1] <= 1 && rgb[2] >= 0 &&
	       rgb[2] <= 1;
}

static void
desaturate(const struct spec_gamut_map *map, double rgb[3])
{
	double y = luminance_of(map, rgb), part = 1;

	y = fmin(fmax(y, 0), 1);
	for (int c = 0; c < 3; c++) {
		double limit = rgb[c] < 0 ? 0 : 1;

		if (rgb[c] < 0 || rgb[c] > 1)
			part = fmin(part, (limit - y) / (rgb[c] - y));
	}
	for (int c = 0; c < 3; c++)
		rgb[c] = fmin(fmax(y + part * (rgb[c] - y), 0), 1);
}

/* The colour whose chroma is a part of that of the cube roots, of grey's own lightness. */
static void
reduce(const struct spec_gamut_map *map, const double root[3], double grey, double part,
	double rgb[3])
{
	for (int i = 0; i < 3; i++) {
		double r = grey + part * (root[i] - grey);

		rgb[i] = r * r * r;
	}
	spec_matrix_apply(map->from_cones, rgb, rgb);
}

/*
 * L, a and b are linear in the cube roots, and a grey of lightness L has three equal ones:
 * at constant L and hue the roots move in a straight line to L.
 */
static void
lose_chroma(const struct spec_gamut_map *map, double rgb[3])
{
	double root[3], lightness = 0, inside = 0, outside = 1;

	spec_matrix_apply(map->to_cones, rgb, root);
	for (int i = 0; i < 3; i++) {
		root[i] = cbrt(root[i]);
		lightness += oklab_lightness[i] * root[i];
	}
	lightness = fmin(fmax(lightness, 0), 1);
	for (int i = 0; i < STEPS && lightness > 0 && lightness < 1; i++) {
		double middle = (inside + outside) / 2;

		reduce(map, root, lightness, middle, rgb);
		if (is_inside(rgb))
			inside = middle;
		else
			outside = middle;
	}
	reduce(map, root, lightness, inside, rgb);
	for (int c = 0; c < 3; c++)
		rgb[c] = fmin(fmax(rgb[c], 0), 1);
}

void
spec_gamut_row(const struct spec_gamut_map *map, float *const plane[3], size_t count)
{
	if (map->kind == SPEC_GAMUT_CLIP ||
		(map->kind == SPEC_GAMUT_SCALE && map->most == 1 && map->chroma == 1))
		return;
	for (size_t i = 0; i < count; i++) {
		double rgb[3] = {plane[0][i], plane[1][i], plane[2][i]};

		if (map->kind == SPEC_GAMUT_SCALE)
			scale(map, rgb);
		else if (is_inside(rgb) || !isfinite(rgb[0] + rgb[1] + rgb[2]))
			continue;
		else if (map->kind == SPEC_GAMUT_DESATURATE)
			desaturate(map, rgb);
		else
			lose_chroma(map, rgb);
		for (int c = 0; c < 3; c++)
			plane[c][i] = (float)rgb[c];
	}
}
