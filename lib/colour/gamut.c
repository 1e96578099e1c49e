#include "colour/gamut.h"

#include <math.h>
#include <string.h>

#include "base/vector.h"

#define STEPS 60  /* at most; about seven are needed */
#define NEAR 1e-9 /* to the edge of the gamut: less than a float can tell */

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

/* How far the nearest component is from leaving 0 to 1; negative where it has left. */
static double
margin_of(const double rgb[3])
{
	double least = fmin(rgb[0], fmin(rgb[1], rgb[2]));
	double most = fmax(rgb[0], fmax(rgb[1], rgb[2]));

	return fmin(least, 1 - most);
}

/*
 * The part of chroma at which the margin is 0, from grey, where it is not below 0, and a
 * colour outside: regula falsi, halving what stays (Dowell and Jarratt 1971, "Illinois").
 */
static double
find_part(const struct spec_gamut_map *map, const double root[3], double grey,
	double at_grey, double at_colour)
{
	double inside = 0, outside = 1, low = at_grey, high = at_colour, rgb[3];
	int side = 0;

	for (int i = 0; i < STEPS && outside - inside > NEAR; i++) {
		double part = (inside * high - outside * low) / (high - low), margin;

		reduce(map, root, grey, part, rgb);
		margin = margin_of(rgb);
		if (fabs(margin) < NEAR)
			return part;
		if (margin > 0) {
			inside = part;
			low = margin;
			high = side > 0 ? high / 2 : high;
			side = 1;
		} else {
			outside = part;
			high = margin;
			low = side < 0 ? low / 2 : low;
			side = -1;
		}
	}
	return inside;
}

/*
 * L, a and b are linear in the cube roots, and a grey of lightness L has three equal ones:
 * at constant L and hue the roots move in a straight line to L.
 */
static void
lose_chroma(const struct spec_gamut_map *map, double rgb[3])
{
	double root[3], lightness = 0, part = 0, at_grey, at_colour;

	spec_matrix_apply(map->to_cones, rgb, root);
	for (int i = 0; i < 3; i++) {
		root[i] = cbrt(root[i]);
		lightness += oklab_lightness[i] * root[i];
	}
	lightness = fmin(fmax(lightness, 0), 1);
	reduce(map, root, lightness, 1, rgb);
	at_colour = margin_of(rgb);
	reduce(map, root, lightness, 0, rgb);
	at_grey = margin_of(rgb);
	if (at_grey > 0)
		part = at_colour < 0 ? find_part(map, root, lightness, at_grey, at_colour)
				     : 1;
	reduce(map, root, lightness, part, rgb);
	for (int c = 0; c < 3; c++)
		rgb[c] = fmin(fmax(rgb[c], 0), 1);
}

void
spec_gamut_row(const struct spec_gamut_map *map, float *const plane[3], size_t count)
{
	if (map->kind == SPEC_GAMUT_CLIP ||
		(map->kind == SPEC_GAMUT_SCALE && map->most == 1 && map->chroma == 1))
		return;
	if (map->kind == SPEC_GAMUT_DESATURATE) {
		desaturate(map->luminance, plane[0], plane[1], plane[2], count);
		return;
	}
	for (size_t i = 0; i < count; i++) {
		double rgb[3] = {plane[0][i], plane[1][i], plane[2][i]};

		if (map->kind == SPEC_GAMUT_SCALE)
			scale(map, rgb);
		else if (is_inside(rgb) || !isfinite(rgb[0] + rgb[1] + rgb[2]))
			continue;
		else
			lose_chroma(map, rgb);
		for (int c = 0; c < 3; c++)
			plane[c][i] = (float)rgb[c];
	}
}
