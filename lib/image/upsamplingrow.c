/* The rows of upsampling.h: blocks of pixels, for each of which all bands are made. */
#include <float.h>
#include <math.h>
#include <string.h>

#include "base/vector.h"
#include "colour/smits.h"
#include "colour/gaussian.h"
#include "image/upsampling.h"

#define RUN 256 /* pixels of a block */

/* The largest component that twice fits a float. */
#define MOST (FLT_MAX / 2)

/* A block's colours, without what cannot be, and what is added to all bands: 0 or NaN. */
struct block {
	float r[RUN], g[RUN], b[RUN], bad[RUN];
};

/* NaN and infinities give 0 here; they are in bad. */
static inline float
clean(float value, float most)
{
	value = value > 0 ? value : 0;
	return value < most ? value : (value <= FLT_MAX ? most : 0);
}

/* Returns how many finite pixels had a component out of range. */
SPEC_VECTORISED static size_t
clean_block(const float *r, const float *g, const float *b, size_t count, float most,
	struct block *block)
{
	unsigned clamped = 0;

	for (size_t x = 0; x < count; x++) {
		float bad = (r[x] - r[x]) + (g[x] - g[x]) + (b[x] - b[x]);
		int below = (r[x] < 0) | (g[x] < 0) | (b[x] < 0);
		int above = (r[x] > most) | (g[x] > most) | (b[x] > most);

		block->r[x] = clean(r[x], most);
		block->g[x] = clean(g[x], most);
		block->b[x] = clean(b[x], most);
		block->bad[x] = bad;
		clamped += (unsigned)((below | above) & (bad == 0));
	}
	return clamped;
}

/* Sums of spectra */

/* As spec_smits_weights. The white takes what is bad to all bands. */
SPEC_VECTORISED static void
weigh_smits(const struct block *block, size_t count, float weight[][RUN])
{
	for (size_t x = 0; x < count; x++) {
		float r = block->r[x], g = block->g[x], b = block->b[x];
		float rg = r < g ? r : g, white = rg < b ? rg : b;
		float cyan, magenta, yellow;

		r -= white;
		g -= white;
		b -= white;
		cyan = g < b ? g : b;
		magenta = r < b ? r : b;
		yellow = r < g ? r : g;
		weight[SPEC_SMITS_WHITE][x] = white + block->bad[x];
		weight[SPEC_SMITS_CYAN][x] = cyan;
		weight[SPEC_SMITS_MAGENTA][x] = magenta;
		weight[SPEC_SMITS_YELLOW][x] = yellow;
		weight[SPEC_SMITS_RED][x] = r - magenta - yellow;
		weight[SPEC_SMITS_GREEN][x] = g - cyan - yellow;
		weight[SPEC_SMITS_BLUE][x] = b - cyan - magenta;
	}
}

/* What is above most becomes that; NaN stays. */
SPEC_VECTORISED static void
add_seven(const float weight[][RUN], const float *basis, size_t count, float most,
	float *restrict to)
{
	const float b0 = basis[0], b1 = basis[1], b2 = basis[2], b3 = basis[3];
	const float b4 = basis[4], b5 = basis[5], b6 = basis[6];

	for (size_t x = 0; x < count; x++) {
		float value = (b0 * weight[0][x] + b1 * weight[1][x]) +
			      (b2 * weight[2][x] + b3 * weight[3][x]) +
			      ((b4 * weight[4][x] + b5 * weight[5][x]) + b6 * weight[6][x]);

		to[x] = value > most ? most : value;
	}
}

SPEC_VECTORISED static void
add_three(const struct block *block, const float *basis, size_t count, float most,
	float *restrict to)
{
	const float red = basis[0], green = basis[1], blue = basis[2];

	for (size_t x = 0; x < count; x++) {
		float value = red * block->r[x] + green * block->g[x] + blue * block->b[x] +
			      block->bad[x];

		to[x] = value > most ? most : value;
	}
}

static void
sum_block(const struct spec_upsampling *upsampling, const struct block *block, size_t count,
	float *const *band, size_t x0)
{
	int bounded = upsampling->use == SPEC_UPSAMPLING_ALBEDO;
	int smits = upsampling->model == SPEC_UPSAMPLING_SMITS;
	float weight[SPEC_SMITS_COLUMNS][RUN];

	if (smits)
		weigh_smits(block, count, weight);
	for (size_t i = 0; i < upsampling->bands; i++) {
		const float *basis = upsampling->basis + i * upsampling->columns;
		float most = bounded ? upsampling->most[i] : HUGE_VALF;

		if (smits)
			add_seven((const float(*)[RUN])weight, basis, count, most,
				band[i] + x0);
		else
			add_three(block, basis, count, most, band[i] + x0);
	}
}

/* Sigmoids */

struct polynomials {
	float c0[RUN], c1[RUN], c2[RUN], scale[RUN];
};

/* The colours over twice their largest component; black has scale 0. */
SPEC_VECTORISED static void
normalise(struct block *block, size_t count, float *restrict scale)
{
	for (size_t x = 0; x < count; x++) {
		float r = block->r[x], g = block->g[x], b = block->b[x];
		float rg = r > g ? r : g, most = rg > b ? rg : b;
		float divisor = most > 0 ? most : 1;

		block->r[x] = .5F * (r / divisor);
		block->g[x] = .5F * (g / divisor);
		block->b[x] = .5F * (b / divisor);
		scale[x] = 2 * most;
	}
}

/* S of a polynomial, in a form that keeps its digits near 0. */
static inline float
sigmoid_at(const struct polynomials *p, size_t i, float t)
{
	float x = (p->c0[i] * t + p->c1[i]) * t + p->c2[i];
	float r = sqrtf(1 + x * x), tail = .5F / (r * (r + fabsf(x)));

	return x < 0 ? tail : 1 - tail;
}

SPEC_VECTORISED static void
put_one(const struct polynomials *p, const struct spec_upsampling_node *node, size_t count,
	float *restrict to)
{
	const float t = node->t, weight = node->weight;

	for (size_t i = 0; i < count; i++)
		to[i] = p->scale[i] * (weight * sigmoid_at(p, i, t));
}

SPEC_VECTORISED static void
put_two(const struct polynomials *p, const struct spec_upsampling_node *node, size_t count,
	float *restrict to)
{
	const float t1 = node[0].t, t2 = node[1].t;
	const float weight1 = node[0].weight, weight2 = node[1].weight;

	for (size_t i = 0; i < count; i++)
		to[i] = p->scale[i] *
			(weight1 * sigmoid_at(p, i, t1) + weight2 * sigmoid_at(p, i, t2));
}

/* Rounding aside the sum is not above what a level spectrum has; NaN stays. */
SPEC_VECTORISED static void
add_limited(const float *restrict from, const float *restrict scale, float most,
	size_t count, float *restrict to)
{
	for (size_t i = 0; i < count; i++) {
		float value = to[i] + from[i], limit = scale[i] * most;

		to[i] = value > limit ? limit : value;
	}
}

static void
sigmoid_block(const struct spec_upsampling *upsampling, struct block *block, size_t count,
	float *const *band, size_t x0)
{
	struct polynomials p;
	float scale[RUN], part[RUN];
	int bounded = upsampling->use == SPEC_UPSAMPLING_ALBEDO;

	if (!bounded)
		normalise(block, count, scale);
	spec_sigmoids_look_up(&upsampling->sigmoids, block->r, block->g, block->b, count,
		p.c0, p.c1, p.c2, p.scale);
	for (size_t x = 0; x < count; x++)
		p.scale[x] = (bounded ? p.scale[x] : p.scale[x] * scale[x]) + block->bad[x];
	for (size_t i = 0; i < upsampling->bands; i++) {
		const struct spec_upsampling_node *node = upsampling->node;
		size_t first = upsampling->first[i], end = upsampling->first[i + 1];

		if (end - first == 1)
			put_one(&p, node + first, count, band[i] + x0);
		else
			put_two(&p, node + first, count, band[i] + x0);
		for (size_t j = first + 2; j < end; j += 2) {
			put_two(&p, node + j, count, part);
			add_limited(
				part, p.scale, upsampling->most[i], count, band[i] + x0);
		}
	}
}

/* Gaussians */

/* The tabulated widths around a pixel's, and the weights of the six Gaussians there. */
struct mixture {
	size_t width;
	float weight[6];
};

static void
weights_at(const struct spec_upsampling *upsampling, size_t width, const double rgb[3],
	double weight[3])
{
	spec_matrix_apply(upsampling->matrix + 9 * width, rgb, weight);
}

/* Whether the weights between two tabulated widths are those of a colour that is met. */
static int
is_met_between(const double near[3], const double far[3], double part)
{
	double weight[3];

	for (int k = 0; k < 3; k++)
		weight[k] = near[k] + part * (far[k] - near[k]);
	return spec_gaussian_is_met(weight);
}

/* As spec_gaussian_solve, whose steps are those of the tabulated widths. */
static struct mixture
mix(const struct spec_upsampling *upsampling, const double rgb[3], float bad)
{
	double width_nm = spec_gaussian_width(upsampling->sun, rgb), near[3], far[3];
	double place = log(width_nm / SPEC_GAUSSIAN_WIDEST_NM) / log(SPEC_GAUSSIAN_STEP);
	size_t width = (size_t)fmax(place, 0), last = upsampling->widths - 2;
	double part = fmin(place - (double)width, 1);
	struct mixture mixture;
	int met;

	width = width < last ? width : last;
	weights_at(upsampling, width, rgb, near);
	weights_at(upsampling, width + 1, rgb, far);
	while (!(met = is_met_between(near, far, part)) && width < last) {
		memcpy(near, far, sizeof near);
		weights_at(upsampling, ++width + 1, rgb, far);
	}
	mixture.width = width;
	for (int k = 0; k < 3; k++) {
		mixture.weight[k] =
			(float)((1 - part) * (met ? near[k] : fmax(near[k], 0))) + bad;
		mixture.weight[3 + k] = (float)(part * (met ? far[k] : fmax(far[k], 0)));
	}
	return mixture;
}

static void
gaussian_block(const struct spec_upsampling *upsampling, const struct block *block,
	size_t count, float *const *band, size_t x0)
{
	struct mixture mixture[RUN];

	for (size_t x = 0; x < count; x++) {
		const double rgb[3] = {block->r[x], block->g[x], block->b[x]};

		mixture[x] = mix(upsampling, rgb, block->bad[x]);
	}
	for (size_t i = 0; i < upsampling->bands; i++) {
		const float *table = upsampling->gaussian + i * upsampling->widths * 3;

		for (size_t x = 0; x < count; x++) {
			const float *value = table + 3 * mixture[x].width;
			const float *weight = mixture[x].weight;

			float sum = (weight[0] * value[0] + weight[1] * value[1] +
					    weight[2] * value[2]) +
				    (weight[3] * value[3] + weight[4] * value[4] +
					    weight[5] * value[5]);

			band[i][x0 + x] = sum < 0 ? 0 : sum;
		}
	}
}

size_t
spec_upsampling_row(const struct spec_upsampling *upsampling, const float *r,
	const float *g, const float *b, size_t width, float *const *band)
{
	float most = upsampling->use == SPEC_UPSAMPLING_ALBEDO ? 1 : MOST;
	struct block block;
	size_t clamped = 0;

	for (size_t x0 = 0; x0 < width; x0 += RUN) {
		size_t count = width - x0 < RUN ? width - x0 : RUN;

		clamped += clean_block(r + x0, g + x0, b + x0, count, most, &block);
		if (upsampling->model == SPEC_UPSAMPLING_SIGMOID)
			sigmoid_block(upsampling, &block, count, band, x0);
		else if (upsampling->model == SPEC_UPSAMPLING_SUN)
			gaussian_block(upsampling, &block, count, band, x0);
		else
			sum_block(upsampling, &block, count, band, x0);
	}
	return clamped;
}
