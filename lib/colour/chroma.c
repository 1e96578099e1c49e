#include "colour/chroma.h"

#include <math.h>
#include <string.h>

#include "base/vector.h"

#define BLOCK 256 /* pixels at a time */
#define STEPS 60  /* at most; about seven are needed */
#define NEAR 1e-9 /* to the edge of the gamut: less than a float can tell */

/* Ottosson 2020: from the cube roots of cones' responses to L. */
#define LONG_SHARE .2104542553
#define MEDIUM_SHARE .7936177850
#define SHORT_SHARE (-.0040720468)

/* Pixels that are outside, of one block. */
struct batch {
	size_t count, place[BLOCK];
	float red[BLOCK], green[BLOCK], blue[BLOCK];
	/*
	 * L, a and b are linear in the roots of the cones' responses, and a grey of
	 * lightness L has three equal ones: at constant L and hue the roots move in a
	 * straight line to L.
	 */
	double lightness[BLOCK], root[3][BLOCK];
	/* Parts of chroma, 0 is grey and 1 the colour, and the margins there, maybe halved. */
	double inside[BLOCK], outside[BLOCK], low[BLOCK], high[BLOCK];
	double side[BLOCK]; /* of the step before: 1 inside, -1 outside */
};

struct triple {
	double red, green, blue;
};

static inline double
lesser(double a, double b)
{
	return a < b ? a : b;
}

static inline double
greater(double a, double b)
{
	return a > b ? a : b;
}

static inline double
cube(double v)
{
	return v * v * v;
}

static inline struct triple
multiply(const double m[9], double a, double b, double c)
{
	return (struct triple){m[0] * a + m[1] * b + m[2] * c,
		m[3] * a + m[4] * b + m[5] * c, m[6] * a + m[7] * b + m[8] * c};
}

/* The colour of a batch's pixel with a part of its chroma, of the same lightness. */
static inline struct triple
reduce(const double from_cones[9], const struct batch *batch, size_t i, double part)
{
	double grey = batch->lightness[i];

	return multiply(from_cones, cube(grey + part * (batch->root[0][i] - grey)),
		cube(grey + part * (batch->root[1][i] - grey)),
		cube(grey + part * (batch->root[2][i] - grey)));
}

/* How far the nearest component is from leaving 0 to 1; negative where it has left. */
static inline double
margin_of(struct triple rgb)
{
	double least = lesser(rgb.red, lesser(rgb.green, rgb.blue));
	double most = greater(rgb.red, greater(rgb.green, rgb.blue));

	return lesser(least, 1 - most);
}

SPEC_VECTORISED static void
flag_outside(const float *restrict red, const float *restrict green,
	const float *restrict blue, size_t count, unsigned char *restrict flag)
{
	for (size_t i = 0; i < count; i++) {
		float r = red[i], g = green[i], b = blue[i];
		double sum = (double)r + (double)g + (double)b;
		float least = r < g ? r : g, most = r > g ? r : g;

		least = least < b ? least : b;
		most = most > b ? most : b;
		flag[i] = ((least < 0) | (most > 1)) & (sum - sum == 0);
	}
}

static void
gather(struct batch *batch, float *const plane[3], size_t x0, size_t count)
{
	unsigned char flag[BLOCK];

	flag_outside(plane[0] + x0, plane[1] + x0, plane[2] + x0, count, flag);
	batch->count = 0;
	for (size_t i = 0; i < count; i++) {
		batch->place[batch->count] = x0 + i;
		batch->count += flag[i] != 0;
	}
	for (size_t i = 0; i < batch->count; i++) {
		batch->red[i] = plane[0][batch->place[i]];
		batch->green[i] = plane[1][batch->place[i]];
		batch->blue[i] = plane[2][batch->place[i]];
	}
}

/* Where grey is no better, part 0 stays; where the colour is inside after all, part 1. */
SPEC_VECTORISED static void
start(const double to[9], const double from[9], struct batch *restrict batch)
{
	double to_cones[9], from_cones[9];

	memcpy(to_cones, to, sizeof to_cones);
	memcpy(from_cones, from, sizeof from_cones);
	for (size_t i = 0; i < batch->count; i++) {
		struct triple cones =
			multiply(to_cones, batch->red[i], batch->green[i], batch->blue[i]);
		double a = spec_vector_cbrt(cones.red), b = spec_vector_cbrt(cones.green),
		       c = spec_vector_cbrt(cones.blue);
		double lightness = LONG_SHARE * a + MEDIUM_SHARE * b + SHORT_SHARE * c;

		batch->root[0][i] = a;
		batch->root[1][i] = b;
		batch->root[2][i] = c;
		batch->lightness[i] = lesser(greater(lightness, 0), 1);
	}
	for (size_t i = 0; i < batch->count; i++) {
		double at_grey = margin_of(reduce(from_cones, batch, i, 0));
		double at_colour = margin_of(reduce(from_cones, batch, i, 1));
		int between = (at_grey > 0) & (at_colour < 0);
		double inside = ((at_grey > 0) & !between) ? 1 : 0;

		batch->inside[i] = inside;
		batch->outside[i] = between ? 1 : inside;
		batch->low[i] = at_grey;
		batch->high[i] = at_colour;
		batch->side[i] = 0;
	}
}

/*
 * A step of regula falsi towards the part at which the margin is 0, halving what stays
 * (Dowell and Jarratt 1971, "Illinois"), of every pixel that is not there yet. Returns how
 * many go on.
 */
SPEC_VECTORISED static unsigned
approach(const double from[9], struct batch *restrict batch)
{
	double from_cones[9];
	unsigned left = 0;

	memcpy(from_cones, from, sizeof from_cones);
	for (size_t i = 0; i < batch->count; i++) {
		double inside = batch->inside[i], outside = batch->outside[i];
		double low = batch->low[i], high = batch->high[i], side = batch->side[i];
		double between = (inside * high - outside * low) / (high - low);
		double part = outside - inside > NEAR ? between : inside;
		double margin = margin_of(reduce(from_cones, batch, i, part));
		double half_low = side < 0 ? low / 2 : low;
		double half_high = side > 0 ? high / 2 : high;

		/* On the edge both ends of the interval come together. */
		batch->low[i] = margin > -NEAR ? margin : half_low;
		batch->high[i] = margin < NEAR ? margin : half_high;
		batch->inside[i] = margin > -NEAR ? part : inside;
		batch->outside[i] = margin < NEAR ? part : outside;
		batch->side[i] = margin > 0 ? 1 : -1;
	}
	for (size_t i = 0; i < batch->count; i++)
		left += batch->outside[i] - batch->inside[i] > NEAR;
	return left;
}

SPEC_VECTORISED static void
finish(const double from[9], struct batch *restrict batch)
{
	double from_cones[9];

	memcpy(from_cones, from, sizeof from_cones);
	for (size_t i = 0; i < batch->count; i++) {
		struct triple rgb = reduce(from_cones, batch, i, batch->inside[i]);

		batch->red[i] = (float)lesser(greater(rgb.red, 0), 1);
		batch->green[i] = (float)lesser(greater(rgb.green, 0), 1);
		batch->blue[i] = (float)lesser(greater(rgb.blue, 0), 1);
	}
}

void
spec_chroma_row(const double to_cones[9], const double from_cones[9], float *const plane[3],
	size_t count)
{
	struct batch batch;

	for (size_t x0 = 0; x0 < count; x0 += BLOCK) {
		gather(&batch, plane, x0, count - x0 < BLOCK ? count - x0 : BLOCK);
		if (batch.count == 0)
			continue;
		start(to_cones, from_cones, &batch);
		for (int i = 0; i < STEPS && approach(from_cones, &batch) > 0; i++)
			continue;
		finish(from_cones, &batch);
		for (size_t i = 0; i < batch.count; i++) {
			plane[0][batch.place[i]] = batch.red[i];
			plane[1][batch.place[i]] = batch.green[i];
			plane[2][batch.place[i]] = batch.blue[i];
		}
	}
}
