/* CIELAB and CIEDE2000 as vector code: the formulas of difference.c. */
#include "colour/difference.h"

#include <math.h>

#include "base/vector.h"
#include "colour/differing.h"

#define BLOCK 128 /* pairs at a time */

/* cos and sin of 30, 6 and 63 degrees. */
#define COS30 .86602540378443864676
#define SIN30 .5
#define COS6 .99452189536827333692
#define SIN6 .10452846326765347140
#define COS63 .45399049973954679156
#define SIN63 .89100652418836786236

/*
 * Hue jumps at half a turn between two colours: nearer than this to it the formulas of one
 * pair decide, whose arcs of tangents are exact there.
 */
#define DOUBT (1e-9 * DEGREE)

/* f of CIELAB. In one loop the compiler would take a cube root only where it is wanted. */
SPEC_VECTORISED static void
take_roots(double white, double *restrict plane, size_t count)
{
	double root[BLOCK];

	for (size_t i = 0; i < count; i++)
		root[i] = spec_vector_cbrt(plane[i] / white);
	for (size_t i = 0; i < count; i++) {
		double ratio = plane[i] / white, line = (LAB_KAPPA * ratio + 16) / 116;

		plane[i] = ratio > LAB_EPSILON ? root[i] : line;
	}
}

SPEC_VECTORISED static void
join_roots(double *restrict x, double *restrict y, double *restrict z, size_t count)
{
	for (size_t i = 0; i < count; i++) {
		double a = x[i], b = y[i], c = z[i];

		x[i] = 116 * b - 16;
		y[i] = 500 * (a - b);
		z[i] = 200 * (b - c);
	}
}

void
spec_lab_row(const double white[3], double *const plane[3], size_t count)
{
	for (size_t x = 0, n; x < count; x += n) {
		n = count - x < BLOCK ? count - x : BLOCK;
		for (int c = 0; c < 3; c++)
			take_roots(white[c], plane[c] + x, n);
		join_roots(plane[0] + x, plane[1] + x, plane[2] + x, n);
	}
}

/* Pairs between the steps. */
struct pairs {
	double chroma1[BLOCK], chroma2[BLOCK], hue1[BLOCK], hue2[BLOCK]; /* hue [rad] */
	double mean[BLOCK], step[BLOCK];                                 /* of hue [rad] */
	double doubt[BLOCK]; /* 1 where one by one is right */
};

static inline double
hue_of(double b, double a)
{
	double hue = spec_vector_atan2(b, a), turned = hue + 360 * DEGREE;

	hue = hue < 0 ? turned : hue;
	return ((a == 0) & (b == 0)) ? 0 : hue;
}

SPEC_VECTORISED static void
find_hues(const double *restrict a1, const double *restrict b1, const double *restrict a2,
	const double *restrict b2, size_t count, struct pairs *restrict pairs)
{
	for (size_t i = 0; i < count; i++) {
		double square1 = b1[i] * b1[i], square2 = b2[i] * b2[i];
		double mean = .5 * (sqrt(a1[i] * a1[i] + square1) +
					   sqrt(a2[i] * a2[i] + square2));
		double c7 = seventh_power(mean);
		double g = 1 + .5 * (1 - sqrt(c7 / (c7 + CHROMA7)));
		double p = g * a1[i], q = g * a2[i];

		pairs->chroma1[i] = sqrt(p * p + square1);
		pairs->chroma2[i] = sqrt(q * q + square2);
		pairs->hue1[i] = hue_of(b1[i], p);
		pairs->hue2[i] = hue_of(b2[i], q);
	}
}

/* The hue difference the short way round, and the mean hue on that way. */
SPEC_VECTORISED static void
find_steps(struct pairs *restrict pairs, size_t count)
{
	const double half = 180 * DEGREE, turn = 360 * DEGREE;

	for (size_t i = 0; i < count; i++) {
		double step = pairs->hue2[i] - pairs->hue1[i], far = fabs(step);
		double sum = pairs->hue1[i] + pairs->hue2[i];
		double other = sum < turn ? (sum + turn) / 2 : (sum - turn) / 2;
		double mean = far <= half ? sum / 2 : other;
		int grey = (pairs->chroma1[i] == 0) | (pairs->chroma2[i] == 0);
		int near = (fabs(far - half) < DOUBT) | (fabs(sum - turn) < DOUBT);

		step = step > half ? step - turn : step < -half ? step + turn : step;
		pairs->step[i] = grey ? 0 : step;
		pairs->mean[i] = grey ? sum : mean;
		pairs->doubt[i] = near ? 1 : 0;
	}
}

/* T, of the hue's weight, by the cosines and sines of the angle's multiples. */
static inline double
hue_weight(double cosine, double sine)
{
	double cos2 = cosine * cosine - sine * sine, sin2 = 2 * sine * cosine;
	double cos3 = cos2 * cosine - sin2 * sine, sin3 = sin2 * cosine + cos2 * sine;
	double cos4 = cos2 * cos2 - sin2 * sin2, sin4 = 2 * sin2 * cos2;

	return 1 - .17 * (cosine * COS30 + sine * SIN30) + .24 * cos2 +
	       .32 * (cos3 * COS6 - sin3 * SIN6) - .20 * (cos4 * COS63 + sin4 * SIN63);
}

SPEC_VECTORISED static void
weigh(const double *restrict l1, const double *restrict l2, struct pairs *restrict pairs,
	size_t count, double *restrict difference)
{
	for (size_t i = 0; i < count; i++) {
		double c1 = pairs->chroma1[i], c2 = pairs->chroma2[i], h = pairs->mean[i];
		double c = .5 * (c1 + c2), c7 = seventh_power(c);
		double t = hue_weight(spec_vector_cos(h), spec_vector_sin(h));
		double from_blue = (h / DEGREE - 275) / 25;
		double angle = 30 * DEGREE * spec_vector_exp(-from_blue * from_blue);
		double rotation =
			-spec_vector_sin(2 * angle) * 2 * sqrt(c7 / (c7 + CHROMA7));
		double middle = .5 * (l1[i] + l2[i]) - 50, l = middle * middle;
		double dh = 2 * sqrt(c1 * c2) * spec_vector_sin(.5 * pairs->step[i]);
		double nl = (l2[i] - l1[i]) / (1 + .015 * l / sqrt(20 + l));
		double nc = (c2 - c1) / (1 + .045 * c), nh = dh / (1 + .015 * c * t);
		double square = nl * nl + nc * nc + nh * nh + rotation * nc * nh;
		double root = sqrt(square);

		difference[i] = square < 0 ? 0 : root;
	}
}

void
spec_difference_ciede2000_row(const double *const lab1[3], const double *const lab2[3],
	size_t count, double *difference)
{
	struct pairs pairs;

	for (size_t x = 0, n; x < count; x += n) {
		n = count - x < BLOCK ? count - x : BLOCK;
		find_hues(lab1[1] + x, lab1[2] + x, lab2[1] + x, lab2[2] + x, n, &pairs);
		find_steps(&pairs, n);
		weigh(lab1[0] + x, lab2[0] + x, &pairs, n, difference + x);
		for (size_t i = 0; i < n; i++) {
			double one[3] = {lab1[0][x + i], lab1[1][x + i], lab1[2][x + i]};
			double two[3] = {lab2[0][x + i], lab2[1][x + i], lab2[2][x + i]};

			if (pairs.doubt[i] > 0)
				difference[x + i] = spec_difference_ciede2000(one, two);
		}
	}
}
