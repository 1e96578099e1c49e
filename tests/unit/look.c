/* Tone curves, gamut maps and dithering. */
#include <float.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "base/vector.h"
#include "colour/gamut.h"
#include "colour/tone.h"
#include "image/look.h"

#include "check.h"

static void
test_tone_parse(void **state)
{
	static const char *const bad[] = {"", "Reinhard", "reinhard:", "reinhard:0",
		"reinhard:-1", "reinhard:x", "filmic:2"};
	struct spec_tone tone;
	struct spec_error error;

	(void)state;
	assert_int_equal(spec_tone_parse("none", &tone, &error), SPEC_OK);
	assert_int_equal(tone.kind, SPEC_TONE_NONE);
	assert_int_equal(spec_tone_parse("reinhard:4", &tone, &error), SPEC_OK);
	assert_true(tone.kind == SPEC_TONE_REINHARD && tone.white == 4);
	for (size_t i = 0; i < COUNT(bad); i++) {
		if (spec_tone_parse(bad[i], &tone, &error) == SPEC_OK)
			fail_msg("'%s' is taken", bad[i]);
	}
}

static void
test_tone_curves(void **state)
{
	const struct spec_tone plain = {SPEC_TONE_REINHARD, 0},
			       white = {SPEC_TONE_REINHARD, 4},
			       film = {SPEC_TONE_FILMIC, 0};

	(void)state;
	near(spec_tone_curve(&plain, 1), .5, 1e-15, "Y / (1 + Y)");
	near(spec_tone_curve(&plain, 3), .75, 1e-15, "Y / (1 + Y)");
	near(spec_tone_curve(&white, 4), 1, 1e-15, "white");
	near(spec_tone_curve(&white, 1), 1.0625 / 2, 1e-15, "Y (1 + Y / 16) / (1 + Y)");
	near(spec_tone_curve(&film, 0), 0, 1e-15, "black");
	near(spec_tone_curve(&film, 5.6), 1, 1e-15, "white");
	/* h(2) = (2 (.3 + .05) + .004) / (2 (.3 + .5) + .06) - 1/15, h(11.2) likewise. */
	near(spec_tone_curve(&film, 1),
		(.704 / 1.66 - 1. / 15) /
			((11.2 * 1.73 + .004) / (11.2 * 2.18 + .06) - 1. / 15),
		1e-14, "film");
}

/* One factor for all three: ratios stay, and the luminance is the curve's. */
static void
test_tone_row(void **state)
{
	static const char *const names[] = {"reinhard", "reinhard:2.5", "filmic"};
	const double weight[3] = {.2126, .7152, .0722};

	(void)state;
	for (size_t i = 0; i < COUNT(names); i++) {
		float red[] = {.5f, 4, 1e-12f, -1, 0}, green[] = {.25f, -.5f, 1e-12f, 0, 0},
		      blue[] = {1, 2, 1e-12f, 0, 0};
		float *const plane[3] = {red, green, blue};
		struct spec_tone tone;

		assert_int_equal(spec_tone_parse(names[i], &tone, NULL), SPEC_OK);
		spec_tone_row(&tone, weight, plane, 5);
		near(green[0] / red[0], .5, 1e-6, "ratio");
		near(blue[0] / red[0], 2, 1e-6, "ratio");
		near(green[1] / red[1], -.125, 1e-6, "ratio");
		near(weight[0] * red[0] + weight[1] * green[0] + weight[2] * blue[0],
			spec_tone_curve(&tone, .2126 * .5 + .7152 * .25 + .0722), 1e-6,
			names[i]);
		/* The slope at 0 is that of the curve. */
		near(red[2] / 1e-12f, spec_tone_curve(&tone, 1e-7) / 1e-7, 1e-5, "slope");
		near(red[3], -spec_tone_curve(&tone, 1e-7) / 1e-7, 1e-5, "below 0");
		assert_true(red[4] == 0);
	}
}

#define PIXELS 4000

/* Colours of all hues, of which many are outside of the space. */
static void
fill(float *const plane[3], size_t count)
{
	uint32_t noise = 1;

	for (size_t i = 0; i < count; i++) {
		for (int c = 0; c < 3; c++) {
			noise = noise * 1664525u + 1013904223u;
			plane[c][i] = (float)(noise >> 8) * 0x1p-24f * 2.2f - .6f;
		}
	}
}

static double
luminance_of(const struct spec_gamut_map *map, const float *const plane[3], size_t i)
{
	return map->luminance[0] * plane[0][i] + map->luminance[1] * plane[1][i] +
	       map->luminance[2] * plane[2][i];
}

struct rows {
	float before[3][PIXELS], after[3][PIXELS];
};

static struct rows *
map_rows(struct spec_gamut_map *map, enum spec_gamut kind, const char *name)
{
	struct rows *rows = malloc(sizeof *rows);
	float *const before[3] = {rows->before[0], rows->before[1], rows->before[2]};
	float *const after[3] = {rows->after[0], rows->after[1], rows->after[2]};

	assert_int_equal(
		spec_gamut_init(map, kind, spec_space_find(name, NULL), NULL), SPEC_OK);
	fill(before, PIXELS);
	memcpy(rows->after, rows->before, sizeof rows->after);
	if (kind == SPEC_GAMUT_SCALE)
		spec_gamut_measure(map, (const float *const *)before, PIXELS);
	spec_gamut_row(map, after, PIXELS);
	return rows;
}

static int
is_within(double v, double least, double most)
{
	return v >= least && v <= most;
}

static void
test_desaturate(void **state)
{
	struct spec_gamut_map map;
	struct rows *rows = map_rows(&map, SPEC_GAMUT_DESATURATE, "p3");
	const float *const before[3] = {rows->before[0], rows->before[1], rows->before[2]};
	const float *const after[3] = {rows->after[0], rows->after[1], rows->after[2]};
	int touched = 0;

	(void)state;
	for (size_t i = 0; i < PIXELS; i++) {
		double y = luminance_of(&map, before, i),
		       got = luminance_of(&map, after, i);
		int inside = 1;

		for (int c = 0; c < 3; c++) {
			assert_true(is_within(after[c][i], 0, 1));
			inside &= is_within(before[c][i], 0, 1);
		}
		near(got, fmin(fmax(y, 0), 1), 1e-6, "luminance");
		if (inside)
			assert_true(
				before[0][i] == after[0][i] && before[2][i] == after[2][i]);
		else if (y > 0 && y < 1) {
			/* On a straight line to grey, and no nearer than it must be. */
			double least = fmin(after[0][i], fmin(after[1][i], after[2][i]));
			double most = fmax(after[0][i], fmax(after[1][i], after[2][i]));

			touched++;
			assert_true(least < 1e-6 || most > 1 - 1e-6);
			near((after[0][i] - y) * (before[1][i] - y),
				(after[1][i] - y) * (before[0][i] - y), 1e-6, "line");
		}
	}
	assert_true(touched > PIXELS / 4);
	free(rows);
}

static void
test_scale(void **state)
{
	struct spec_gamut_map map;
	struct rows *rows = map_rows(&map, SPEC_GAMUT_SCALE, "srgb");
	const float *const before[3] = {rows->before[0], rows->before[1], rows->before[2]};
	const float *const after[3] = {rows->after[0], rows->after[1], rows->after[2]};
	double least = 1, most = 0;

	(void)state;
	for (size_t i = 0; i < PIXELS; i++) {
		double y = luminance_of(&map, before, i);

		near(luminance_of(&map, after, i), y / map.most, 1e-6, "luminance");
		for (int c = 0; c < 3 && y > 0; c++) {
			least = fmin(least, after[c][i]);
			most = fmax(most, after[c][i]);
			near((after[c][i] * map.most - y), map.chroma * (before[c][i] - y),
				1e-6, "one factor");
		}
	}
	near(least, 0, 1e-6, "least");
	assert_true(most <= 1 + 1e-6);
	assert_true(map.most > 1.2 && map.most < 1.7 && map.chroma > 0 && map.chroma < 1);
	free(rows);
}

/* Ottosson's own matrix from linear sRGB to cones, and his to L, a, b. */
static void
to_oklab(const float *const plane[3], size_t i, double lab[3])
{
	static const double cones[9] = {.4122214708, .5363325363, .0514459929, .2119034982,
		.6806995451, .1073969566, .0883024619, .2817188376, .6299787005};
	static const double m[9] = {.2104542553, .7936177850, -.0040720468, 1.9779984951,
		-2.4285922050, .4505937099, .0259040371, .7827717662, -.8086757660};
	double rgb[3] = {plane[0][i], plane[1][i], plane[2][i]};

	spec_matrix_apply(cones, rgb, rgb);
	for (int c = 0; c < 3; c++)
		rgb[c] = cbrt(rgb[c]);
	spec_matrix_apply(m, rgb, lab);
}

static void
test_perceptual(void **state)
{
	struct spec_gamut_map map;
	struct rows *rows = map_rows(&map, SPEC_GAMUT_PERCEPTUAL, "srgb");
	const float *const before[3] = {rows->before[0], rows->before[1], rows->before[2]};
	const float *const after[3] = {rows->after[0], rows->after[1], rows->after[2]};
	int touched = 0;

	(void)state;
	for (size_t i = 0; i < PIXELS; i++) {
		double from[3], to[3], least, most;

		to_oklab(before, i, from);
		to_oklab(after, i, to);
		least = fmin(after[0][i], fmin(after[1][i], after[2][i]));
		most = fmax(after[0][i], fmax(after[1][i], after[2][i]));
		assert_true(is_within(least, 0, 1) && is_within(most, 0, 1));
		if (from[0] <= .05 || from[0] >= .999) /* roots of rounding near black */
			continue;
		/* His two matrices differ by 3e-4 at the white of sRGB, in the root 1e-4. */
		near(to[0], from[0], 5e-4, "lightness");
		near(to[1] * from[2], to[2] * from[1], 5e-4, "hue");
		assert_true(to[1] * from[1] + to[2] * from[2] > -1e-4);
		assert_true(hypot(to[1], to[2]) < hypot(from[1], from[2]) + 5e-4);
		touched += before[0][i] != after[0][i];
		if (before[0][i] != after[0][i])
			assert_true(least < 1e-6 || most > 1 - 1e-6);
	}
	assert_true(touched > PIXELS / 4);
	free(rows);
}

/* libmvec's cube root beside the exact one. */
SPEC_VECTORISED static void
take_roots(const double *restrict from, size_t count, double *restrict root)
{
	for (size_t i = 0; i < count; i++)
		root[i] = spec_vector_cbrt(from[i]);
}

static void
test_cube_root(void **state)
{
	enum { MANY = 4000 };
	static double from[MANY], root[MANY];
	double worst = 0;

	(void)state;
	for (int scale = -40; scale <= 40; scale++) {
		for (size_t i = 0; i < MANY; i++)
			from[i] =
				ldexp(i % 2 ? -1 - (double)i / MANY : 1 + (double)i / MANY,
					scale);
		take_roots(from, MANY, root);
		for (size_t i = 0; i < MANY; i++) {
			long double exact = cbrtl((long double)from[i]);

			worst = fmax(worst, (double)fabsl(root[i] / exact - 1));
		}
	}
	near(worst, 0, 4 * DBL_EPSILON, "the cube root");
	from[0] = 0;
	take_roots(from, 1, root);
	assert_true(root[0] == 0);
}

/* How far the nearest component is from leaving 0 to 1, with a part of the roots' chroma. */
static double
margin_at(const struct spec_gamut_map *map, const double root[3], double grey, double part,
	double rgb[3])
{
	for (int c = 0; c < 3; c++)
		rgb[c] = pow(fabs(grey + part * (root[c] - grey)), 3) *
			 (grey + part * (root[c] - grey) < 0 ? -1 : 1);
	spec_matrix_apply(map->from_cones, rgb, rgb);
	return fmin(
		fmin(rgb[0], fmin(rgb[1], rgb[2])), 1 - fmax(rgb[0], fmax(rgb[1], rgb[2])));
}

/*
 * The edge of the gamut by halving, beside what the rows have: 1e-9 is how near they come
 * to it, and a float has 6e-8 of it.
 */
static void
test_perceptual_edge(void **state)
{
	static const double lightness[3] = {.2104542553, .7936177850, -.0040720468};
	struct spec_gamut_map map;
	struct rows *rows = map_rows(&map, SPEC_GAMUT_PERCEPTUAL, "p3");
	int reduced = 0;

	(void)state;
	for (size_t i = 0; i < PIXELS; i++) {
		double rgb[3] = {
			rows->before[0][i], rows->before[1][i], rows->before[2][i]};
		double root[3], grey = 0, inside = 0, outside = 1;

		if (fmin(rgb[0], fmin(rgb[1], rgb[2])) >= 0 &&
			fmax(rgb[0], fmax(rgb[1], rgb[2])) <= 1)
			continue;
		spec_matrix_apply(map.to_cones, rgb, root);
		for (int c = 0; c < 3; c++) {
			root[c] = cbrt(root[c]);
			grey += lightness[c] * root[c];
		}
		grey = fmin(fmax(grey, 0), 1);
		for (int step = 0; step < 60; step++) {
			double part = (inside + outside) / 2;

			*(margin_at(&map, root, grey, part, rgb) >= 0 ? &inside
								      : &outside) = part;
		}
		(void)margin_at(&map, root, grey, inside, rgb);
		for (int c = 0; c < 3; c++)
			near(rows->after[c][i], fmin(fmax(rgb[c], 0), 1), 1e-7, "edge");
		reduced += inside > .01 && inside < .99;
	}
	assert_true(reduced > PIXELS / 4);
	free(rows);
}

/* A pixel's colour does not depend on the pixels that are worked on beside it. */
static void
test_gamut_alone(void **state)
{
	static const enum spec_gamut kinds[] = {
		SPEC_GAMUT_DESATURATE, SPEC_GAMUT_SCALE, SPEC_GAMUT_PERCEPTUAL};

	(void)state;
	for (size_t k = 0; k < COUNT(kinds); k++) {
		struct spec_gamut_map map;
		struct rows *rows = map_rows(&map, kinds[k], "srgb");

		for (size_t i = 0; i < PIXELS; i++) {
			float *const plane[3] = {rows->before[0] + i, rows->before[1] + i,
				rows->before[2] + i};

			spec_gamut_row(&map, plane, 1);
			for (int c = 0; c < 3; c++)
				near(*plane[c], rows->after[c][i], 1.2e-7, "alone");
		}
		free(rows);
	}
}

static void
test_gamut_rules(void **state)
{
	float red[] = {NAN, INFINITY, 2, -1}, green[] = {-1, 0, 2, -1},
	      blue[] = {2, -1, 2, -1};
	float *const plane[3] = {red, green, blue};
	struct spec_gamut_map map;
	enum spec_gamut kind;
	struct spec_error error;

	(void)state;
	assert_int_equal(spec_gamut_find("desaturate", &kind, &error), SPEC_OK);
	assert_int_equal(kind, SPEC_GAMUT_DESATURATE);
	assert_int_equal(spec_gamut_find("Clip", &kind, &error), SPEC_EUSAGE);
	assert_int_equal(spec_gamut_init(&map, SPEC_GAMUT_PERCEPTUAL,
				 spec_space_find("lab", NULL), &error),
		SPEC_EUSAGE);
	for (kind = SPEC_GAMUT_DESATURATE; kind <= SPEC_GAMUT_PERCEPTUAL; kind += 2) {
		for (size_t i = 0; spec_space_at(i); i++) {
			if (spec_space_at(i)->coordinates != SPEC_COORDINATES_RGB)
				continue;
			assert_int_equal(
				spec_gamut_init(&map, kind, spec_space_at(i), &error),
				SPEC_OK);
			red[2] = green[2] = blue[2] = 2;
			red[3] = green[3] = blue[3] = -1;
			spec_gamut_row(&map, plane, 4);
			assert_true(isnan(red[0]) && green[0] == -1 && isinf(red[1]));
			for (int c = 0; c < 3; c++) {
				near(plane[c][2], 1, 1e-6, "white");
				near(plane[c][3], 0, 1e-6, "black");
			}
		}
	}
}

/* The mean of dithered codes is the code before rounding. */
static void
test_dither(void **state)
{
	enum { WIDTH = 1000, HEIGHT = 64 };
	const double white[3] = {.95047, 1, 1.08883};
	struct spec_look look = {.space = spec_space_find("srgb", NULL), .dither = 1};
	struct spec_finish *finish = malloc(sizeof *finish);
	static float linear[3 * WIDTH];
	static unsigned char samples[3 * WIDTH];
	float *const plane[3] = {linear, linear + WIDTH, linear + 2 * WIDTH};
	struct spec_error error;

	(void)state;
	assert_int_equal(spec_finish_init(finish, &look, SPEC_PICTURE_U16, white, &error),
		SPEC_EUSAGE);
	assert_int_equal(
		spec_finish_init(finish, &look, SPEC_PICTURE_U8, white, &error), SPEC_OK);
	for (double code = 0; code <= 255; code += 12.75) {
		double sum[3] = {0};
		float v = (float)spec_srgb_decode(code / 255);

		for (int y = 0; y < HEIGHT; y++) {
			for (size_t x = 0; x < 3 * WIDTH; x++)
				linear[x] = v;
			spec_finish_encode(finish, plane, WIDTH, y, samples);
			for (size_t x = 0; x < 3 * WIDTH; x++) {
				assert_true(fabs(samples[x] - code) < 1.01);
				sum[x % 3] += samples[x];
			}
		}
		/* 64000 draws: the standard deviation of their mean is .5 / 253 at most. */
		for (int c = 0; c < 3; c++)
			near(sum[c] / (WIDTH * HEIGHT), code, .01, "mean");
	}
	free(finish);
}

static void
test_meter(void **state)
{
	static const char *const bad[] = {"auto:", "auto:%", "auto:0%", "auto:101%",
		"auto:50", "automatic", "auto:x%",
		"auto:1234567890123456789012345678901234567890%"};
	struct spec_look look = {0};
	struct spec_error error;

	(void)state;
	assert_int_equal(spec_look_meter(&look, "auto", &error), SPEC_OK);
	assert_int_equal(look.metering, SPEC_METERING_AVERAGE);
	assert_int_equal(spec_look_meter(&look, "auto:99.5%", &error), SPEC_OK);
	assert_int_equal(look.metering, SPEC_METERING_PERCENTILE);
	near(look.percentile, 99.5, 0, "percentile");
	for (size_t i = 0; i < COUNT(bad); i++) {
		if (spec_look_meter(&look, bad[i], &error) == SPEC_OK)
			fail_msg("'%s' is taken", bad[i]);
	}
}

int
main(void)
{
	const struct CMUnitTest tests[] = {cmocka_unit_test(test_tone_parse),
		cmocka_unit_test(test_tone_curves), cmocka_unit_test(test_tone_row),
		cmocka_unit_test(test_desaturate), cmocka_unit_test(test_scale),
		cmocka_unit_test(test_perceptual), cmocka_unit_test(test_cube_root),
		cmocka_unit_test(test_perceptual_edge), cmocka_unit_test(test_gamut_alone),
		cmocka_unit_test(test_gamut_rules), cmocka_unit_test(test_dither),
		cmocka_unit_test(test_meter)};

	return cmocka_run_group_tests(tests, NULL, NULL);
}
