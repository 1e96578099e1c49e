/* Observers, spaces, adaptation, encoding and colour differences. */
#include <float.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "colour/difference.h"
#include "colour/encode.h"
#include "colour/observer.h"
#include "colour/space.h"
#include "spectrum/curve.h"
#include "spectrum/spd.h"

#include "check.h"
#include "random.h"

static void
near_all(const double *got, const double *wanted, size_t count, double tolerance,
	const char *what)
{
	size_t i;

	for (i = 0; i < count; i++)
		near(got[i], wanted[i], tolerance, what);
}

/* Spaces and adaptation */

/*
 * BT.709 primaries and white .3127 .3290, solved in exact fractions (python's
 * fractions) and rounded to 10 digits. IEC 61966-2-1 rounds it
 * to .4124 .3576 .1805 / .2126 .7152 .0722 / .0193 .1192 .9505.
 */
static const double srgb_to_xyz[9] = {.4123907993, .3575843394, .1804807884, .2126390059,
	.7151686788, .0721923154, .0193308187, .1191947798, .9505321522};

/* The first row of the inverse likewise; IEC 61966-2-1: 3.2406 -1.5372 -0.4986. */
static const double srgb_from_xyz[3] = {3.2409699419, -1.5373831776, -.4986107603};

static void
test_space_srgb(void **state)
{
	const struct spec_space *space = spec_space_find("srgb", NULL);
	double to[9], from[9], product[9], white[3];
	const double one[3] = {1, 1, 1}, identity[9] = {1, 0, 0, 0, 1, 0, 0, 0, 1};

	(void)state;
	assert_non_null(space);
	assert_int_equal(spec_space_to_xyz(space, to, NULL), SPEC_OK);
	assert_int_equal(spec_space_from_xyz(space, from, NULL), SPEC_OK);
	near_all(to, srgb_to_xyz, 9, 1e-10, "to XYZ");
	near_all(from, srgb_from_xyz, 3, 1e-9, "from XYZ");
	spec_matrix_multiply(to, from, product);
	near_all(product, identity, 9, 1e-15, "product");
	spec_matrix_apply(to, one, product);
	spec_white_xyz(space->white_xy, white);
	near_all(product, white, 3, 1e-15, "white");
	assert_ptr_equal(space->transfer, &spec_transfer_srgb);
}

/* Luminance coefficients that the standards print. */
static void
test_space_others(void **state)
{
	static const struct {
		const char *name;
		double red, green, blue, tolerance;
	} known[] = {
		{"rec2020", .2627, .6780, .0593, 5e-5},  /* ITU-R BT.2020-2 table 4 */
		{"p3", .228975, .691739, .079287, 1e-6}, /* SMPTE EG 432-1 primaries, D65 */
		{"adobe", .29734, .62736, .07529, 1e-5}, /* Adobe RGB (1998) 4.3.5.3 */
		{"aces", .3439664498, .7281660966, -.0721325464, 1e-9}, /* ST 2065-1 */
	};
	struct spec_error error;
	double m[9];
	size_t i;

	(void)state;
	for (i = 0; i < COUNT(known); i++) {
		const struct spec_space *space = spec_space_find(known[i].name, &error);

		assert_non_null(space);
		assert_int_equal(spec_space_to_xyz(space, m, &error), SPEC_OK);
		near(m[3], known[i].red, known[i].tolerance, known[i].name);
		near(m[4], known[i].green, known[i].tolerance, known[i].name);
		near(m[5], known[i].blue, known[i].tolerance, known[i].name);
	}
	assert_null(spec_space_find("srgbb", &error));
	assert_int_equal(error.status, SPEC_EUSAGE);
	assert_null(spec_white_find("D66", &error));
	for (i = 0; spec_space_at(i); i++)
		assert_ptr_equal(
			spec_space_find(spec_space_at(i)->name, NULL), spec_space_at(i));
	for (i = 0; spec_white_at(i); i++)
		assert_ptr_equal(
			spec_white_find(spec_white_at(i)->name, NULL), spec_white_at(i));
}

static void
test_space_degenerate(void **state)
{
	const struct spec_space line = {.title = "line",
		.red_xy = {.1, .1},
		.green_xy = {.2, .2},
		.blue_xy = {.3, .3},
		.white_xy = {.3127, .3290}};
	const struct spec_space dark = {.title = "dark",
		.red_xy = {.64, .33},
		.green_xy = {.3, .6},
		.blue_xy = {.15, .06},
		.white_xy = {.3, 0}};
	const double singular[9] = {1, 2, 3, 2, 4, 6, 1, 0, 1};
	struct spec_error error;
	double m[9];

	(void)state;
	assert_int_equal(spec_space_to_xyz(&line, m, &error), SPEC_ERANGE);
	assert_int_equal(spec_space_from_xyz(&dark, m, &error), SPEC_ERANGE);
	assert_int_equal(spec_matrix_invert(singular, m, &error), SPEC_ERANGE);
}

/* ASTM E308 whites, by which Lindbloom computed his table. */
static const double d65[3] = {.95047, 1, 1.08883}, d50[3] = {.96422, 1, .82521};

/* B. Lindbloom, Chromatic Adaptation (2017): Bradford, D65 to D50. */
static void
test_adaptation_bradford(void **state)
{
	static const double lindbloom[9] = {1.0478112, .0228866, -.0501270, .0295424,
		.9904844, -.0170491, -.0092345, .0150436, .7521316};
	double m[9], back[9], white[3];
	const double identity[9] = {1, 0, 0, 0, 1, 0, 0, 0, 1};

	(void)state;
	assert_int_equal(
		spec_adaptation_matrix(SPEC_ADAPTATION_BRADFORD, d65, d50, m, NULL),
		SPEC_OK);
	near_all(m, lindbloom, 9, 1e-7, "Bradford");
	spec_matrix_apply(m, d65, white);
	near_all(white, d50, 3, 1e-15, "white");
	assert_int_equal(
		spec_adaptation_matrix(SPEC_ADAPTATION_BRADFORD, d50, d65, back, NULL),
		SPEC_OK);
	spec_matrix_multiply(m, back, back);
	near_all(back, identity, 9, 1e-15, "there and back");
}

/* Von Kries with the printed M16 by long-hand: M16 x = diag(to/from) M16 x0. */
static void
test_adaptation_cat16(void **state)
{
	static const double m16[9] = {.401288, .650173, -.051461, -.250268, 1.204414,
		.045854, -.002079, .048952, .953127};
	const double colour[3] = {.2, .3, .1};
	double m[9], out[3], before[3], after[3], from[3], to[3];
	int i;

	(void)state;
	assert_int_equal(
		spec_adaptation_matrix(SPEC_ADAPTATION_CAT16, d65, d50, m, NULL), SPEC_OK);
	spec_matrix_apply(m, d65, out);
	near_all(out, d50, 3, 1e-15, "white");
	spec_matrix_apply(m, colour, out);
	spec_matrix_apply(m16, out, after);
	spec_matrix_apply(m16, colour, before);
	spec_matrix_apply(m16, d65, from);
	spec_matrix_apply(m16, d50, to);
	for (i = 0; i < 3; i++)
		near(after[i], before[i] * to[i] / from[i], 1e-15, "CAT16");
}

static void
test_adaptation_rules(void **state)
{
	const double identity[9] = {1, 0, 0, 0, 1, 0, 0, 0, 1},
		     bright[3] = {95.047, 100, 108.883};
	const double black[3] = {0, 0, 0}, blue[3] = {1, .01, 5},
		     nan_white[3] = {NAN, 1, 1};
	enum spec_adaptation method;
	struct spec_error error;
	double m[9];

	(void)state;
	assert_int_equal(
		spec_adaptation_matrix(SPEC_ADAPTATION_NONE, black, blue, m, &error),
		SPEC_OK);
	near_all(m, identity, 9, 0, "none");
	/* The scale of a white does not matter. */
	assert_int_equal(
		spec_adaptation_matrix(SPEC_ADAPTATION_BRADFORD, d65, bright, m, &error),
		SPEC_OK);
	near_all(m, identity, 9, 1e-15, "same white");
	method = SPEC_ADAPTATION_BRADFORD;
	assert_int_equal(
		spec_adaptation_matrix(method, black, d50, m, &error), SPEC_ERANGE);
	assert_int_equal(spec_adaptation_matrix(method, d50, blue, m, &error), SPEC_ERANGE);
	assert_int_equal(
		spec_adaptation_matrix(method, nan_white, d50, m, &error), SPEC_ERANGE);
	assert_int_equal(spec_adaptation_find("cat16", &method, &error), SPEC_OK);
	assert_int_equal(method, SPEC_ADAPTATION_CAT16);
	assert_int_equal(spec_adaptation_find("cat17", &method, &error), SPEC_EUSAGE);
}

/* Encoding */

/* IEC 61966-2-1 in long double, for any argument in [0, 1]. */
static long double
srgb_long(long double v)
{
	return v <= .0031308L ? 12.92L * v : 1.055L * powl(v, 1 / 2.4L) - .055L;
}

static int
code_long(float v, int largest)
{
	float clamped = v > 0 ? v < 1 ? v : 1 : 0;

	return (int)floorl(largest * srgb_long(clamped) + .5L);
}

static float
float_of(uint32_t bits)
{
	float v;

	memcpy(&v, &bits, sizeof v);
	return v;
}

static void
test_srgb_scalar(void **state)
{
	double v;

	(void)state;
	near(spec_srgb_encode(0), 0, 0, "black");
	near(spec_srgb_encode(1), 1, 1e-15, "white");
	near(spec_srgb_encode(.0031308), .040449936, 1e-15, "the end of the straight part");
	/*
	 * 1.055 * .18^(1/2.4) - .055 and ((.5 + .055) / 1.055)^2.4 by
	 * python's decimal at 40 digits
	 */
	near(spec_srgb_encode(.18), .46135612950044164, 1e-15, "encode .18");
	near(spec_srgb_decode(.5), .21404114048223255, 1e-15, "decode .5");
	/* The two branches of the standard meet only to within 3e-8. */
	for (v = 0; v <= 1; v += 1. / 1024)
		near(spec_srgb_decode(spec_srgb_encode(v)), v,
			v > .003 && v < .0032 ? 3e-8 : 1e-15, "round trip");
	assert_true(isnan(spec_srgb_encode(NAN)));
	assert_true(isnan(spec_srgb_decode(NAN)));
}

static struct spec_encoder *
new_encoder(void)
{
	struct spec_encoder *encoder = malloc(sizeof *encoder);

	assert_non_null(encoder);
	spec_encoder_init(encoder, &spec_transfer_srgb);
	return encoder;
}

static int
encode8(const struct spec_encoder *encoder, float v)
{
	unsigned char code;

	spec_encode8(encoder, &v, 1, &code, 1);
	return code;
}

static int
encode16(const struct spec_encoder *encoder, float v)
{
	uint16_t code;

	spec_encode16(encoder, &v, 1, &code, 1);
	return code;
}

static void
test_encode8_thresholds(void **state)
{
	struct spec_encoder *encoder = new_encoder();
	float t, v;
	int code, i;

	(void)state;
	for (code = 1; code < 256; code++) {
		t = encoder->threshold[code];
		assert_int_equal(code_long(t, 255), code);
		assert_int_equal(code_long(nextafterf(t, 0), 255), code - 1);
		for (v = t, i = 0; i < 4; i++, v = nextafterf(v, 2))
			assert_int_equal(encode8(encoder, v), code);
		for (v = nextafterf(t, 0), i = 0; i < 4; i++, v = nextafterf(v, 0))
			assert_int_equal(encode8(encoder, v), code - 1);
	}
	free(encoder);
}

static void
test_encode_sweep(void **state)
{
	struct spec_encoder *encoder = new_encoder();
	uint32_t bits;
	float v;

	(void)state;
	for (bits = 0; bits < 0x3fa00000; bits += 4001) { /* up to 1.25 */
		v = float_of(bits);
		if (encode8(encoder, v) != code_long(v, 255) ||
			encode16(encoder, v) != code_long(v, 65535))
			fail_msg(
				"%a: %d, %d", v, encode8(encoder, v), encode16(encoder, v));
	}
	free(encoder);
}

/* Around a third of the thresholds of 16 bits, where the chord leaves it to the formula. */
static void
test_encode16_thresholds(void **state)
{
	struct spec_encoder *encoder = new_encoder();
	int code, i;
	float v;

	(void)state;
	for (code = 1; code < 65536; code += 3) {
		v = (float)spec_srgb_decode((code - .5) / 65535);
		v = nextafterf(nextafterf(v, 0), 0);
		for (i = 0; i < 5; i++, v = nextafterf(v, 2))
			if (encode16(encoder, v) != code_long(v, 65535))
				fail_msg("%a: %d", v, encode16(encoder, v));
	}
	free(encoder);
}

/* Around every threshold of 16 bits, a run at a time. */
static void
test_encode16_runs(void **state)
{
	enum { STEPS = 5, CODES = 257 };
	struct spec_encoder *encoder = new_encoder();
	static float linear[STEPS * CODES];
	static uint16_t word[STEPS * CODES];

	(void)state;
	for (int first = 1; first < 65536; first += CODES) {
		for (size_t i = 0; i < STEPS * CODES; i++) {
			int code = first + (int)i / STEPS;
			float v = (float)spec_srgb_decode(fmin((code - .5) / 65535, 1));
			uint32_t bits;

			memcpy(&bits, &v, sizeof bits);
			linear[i] = float_of(bits + (uint32_t)(i % STEPS) - STEPS / 2);
		}
		spec_encode16(encoder, linear, STEPS * CODES, word, 1);
		for (size_t i = 0; i < STEPS * CODES; i++) {
			if (word[i] != code_long(linear[i], 65535))
				fail_msg("%a: %d", (double)linear[i], word[i]);
		}
	}
	free(encoder);
}

static void
test_encode_special(void **state)
{
	static const struct {
		float v;
		int white;
	} special[] = {{0, 0}, {-0.f, 0}, {NAN, 0}, {-NAN, 0}, {INFINITY, 1},
		{-INFINITY, 0}, {1, 1}, {2, 1}, {FLT_MAX, 1}, {-FLT_MAX, 0}, {-1, 0},
		{FLT_MIN, 0}, {FLT_TRUE_MIN, 0}, {-FLT_TRUE_MIN, 0}, {0x1.fffffep-1f, 1}};
	struct spec_encoder *encoder = new_encoder();
	size_t i;

	(void)state;
	for (i = 0; i < COUNT(special); i++) {
		assert_int_equal(encode8(encoder, special[i].v), 255 * special[i].white);
		assert_int_equal(encode16(encoder, special[i].v), 65535 * special[i].white);
	}
	free(encoder);
}

/* Long runs, through the blocks, at a stride, and nothing written between. */
static void
test_encode_stride(void **state)
{
	enum { N = 1000 };
	struct spec_encoder *encoder = new_encoder();
	static float linear[N];
	static unsigned char out[3 * N];
	static uint16_t out16[2 * N];
	size_t i;

	(void)state;
	memset(out, 77, sizeof out);
	memset(out16, 77, sizeof out16);
	for (i = 0; i < N; i++)
		linear[i] = (float)i / (N - 1);
	spec_encode8(encoder, linear, N, out + 1, 3);
	spec_encode16(encoder, linear, N, out16, 2);
	for (i = 0; i < N; i++) {
		assert_int_equal(out[3 * i], 77);
		assert_int_equal(out[3 * i + 1], code_long(linear[i], 255));
		assert_int_equal(out[3 * i + 2], 77);
		assert_int_equal(out16[2 * i], code_long(linear[i], 65535));
		assert_int_equal(out16[2 * i + 1], 77 * 257);
	}
	spec_encode8(encoder, linear, 0, out, 1);
	assert_int_equal(out[0], 77);
	free(encoder);
}

/* Differences */

/* Sharma, Wu, Dalal 2005, table 1: L a b, L a b, CIEDE2000. */
static const double sharma[34][7] = {
	{50, 2.6772, -79.7751, 50, 0, -82.7485, 2.0425},
	{50, 3.1571, -77.2803, 50, 0, -82.7485, 2.8615},
	{50, 2.8361, -74.0200, 50, 0, -82.7485, 3.4412},
	{50, -1.3802, -84.2814, 50, 0, -82.7485, 1.0000},
	{50, -1.1848, -84.8006, 50, 0, -82.7485, 1.0000},
	{50, -.9009, -85.5211, 50, 0, -82.7485, 1.0000},
	{50, 0, 0, 50, -1, 2, 2.3669},
	{50, -1, 2, 50, 0, 0, 2.3669},
	{50, 2.4900, -.0010, 50, -2.4900, .0009, 7.1792},
	{50, 2.4900, -.0010, 50, -2.4900, .0010, 7.1792},
	{50, 2.4900, -.0010, 50, -2.4900, .0011, 7.2195},
	{50, 2.4900, -.0010, 50, -2.4900, .0012, 7.2195},
	{50, -.0010, 2.4900, 50, .0009, -2.4900, 4.8045},
	{50, -.0010, 2.4900, 50, .0010, -2.4900, 4.8045},
	{50, -.0010, 2.4900, 50, .0011, -2.4900, 4.7461},
	{50, 2.5000, 0, 50, 0, -2.5000, 4.3065},
	{50, 2.5000, 0, 73, 25, -18, 27.1492},
	{50, 2.5000, 0, 61, -5, 29, 22.8977},
	{50, 2.5000, 0, 56, -27, -3, 31.9030},
	{50, 2.5000, 0, 58, 24, 15, 19.4535},
	{50, 2.5000, 0, 50, 3.1736, .5854, 1.0000},
	{50, 2.5000, 0, 50, 3.2972, 0, 1.0000},
	{50, 2.5000, 0, 50, 1.8634, .5757, 1.0000},
	{50, 2.5000, 0, 50, 3.2592, .3350, 1.0000},
	{60.2574, -34.0099, 36.2677, 60.4626, -34.1751, 39.4387, 1.2644},
	{63.0109, -31.0961, -5.8663, 62.8187, -29.7946, -4.0864, 1.2630},
	{61.2901, 3.7196, -5.3901, 61.4292, 2.2480, -4.9620, 1.8731},
	{35.0831, -44.1164, 3.7933, 35.0232, -40.0716, 1.5901, 1.8645},
	{22.7233, 20.0904, -46.6940, 23.0331, 14.9730, -42.5619, 2.0373},
	{36.4612, 47.8580, 18.3852, 36.2715, 50.5065, 21.2231, 1.4146},
	{90.8027, -2.0831, 1.4410, 91.1528, -1.6435, .0447, 1.4441},
	{90.9257, -.5406, -.9208, 88.6381, -.8985, -.7239, 1.5381},
	{6.7747, -.2908, -2.4247, 5.8714, -.0985, -2.2286, .6377},
	{2.0776, .0795, -1.1350, .9033, -.0636, -.5514, .9082},
};

static void
test_ciede2000_sharma(void **state)
{
	size_t i;

	(void)state;
	for (i = 0; i < COUNT(sharma); i++) {
		const double *p = sharma[i];

		near(spec_difference_ciede2000(p, p + 3), p[6], 5.1e-5, "Sharma");
		/* Symmetric, also where the hues are opposite (pairs 10 and 14). */
		near(spec_difference_ciede2000(p + 3, p), p[6], 5.1e-5, "Sharma, swapped");
		near(spec_difference_ciede2000(p, p), 0, 0, "itself");
	}
}

/* By hand: the reference's chroma alone sets S_C = 1 + .045 C, S_H = 1 + .015 C. */
static void
test_cie94(void **state)
{
	const double red[] = {50, 10, 0}, yellow[] = {50, 0, 10}, weak[] = {50, 3, 4},
		     strong[] = {52, 6, 8};

	(void)state;
	near(spec_difference_cie94(red, red), 0, 0, "itself");
	near(spec_difference_cie94(red, yellow), sqrt(200) / 1.15, 1e-13, "hue alone");
	near(spec_difference_cie94(weak, strong), hypot(2, 5 / 1.225), 1e-13, "from weak");
	near(spec_difference_cie94(strong, weak), hypot(2, 5 / 1.45), 1e-13, "from strong");
	assert_true(isnan(spec_difference_cie94((double[]){50, NAN, 0}, red)));
}

static void
test_ciede2000_nan(void **state)
{
	const double good[3] = {50, 10, 10};
	int i;

	(void)state;
	for (i = 0; i < 3; i++) {
		double bad[3] = {50, 10, 10};

		bad[i] = NAN;
		assert_true(isnan(spec_difference_ciede2000(bad, good)));
		assert_true(isnan(spec_difference_ciede2000(good, bad)));
		assert_true(isnan(spec_difference_ab76(good, bad)));
	}
}

#define PAIRS 5000

struct labs {
	double one[3][PAIRS], two[3][PAIRS], difference[PAIRS];
};

static void
take_differences(struct labs *labs, size_t count)
{
	const double *const one[3] = {labs->one[0], labs->one[1], labs->one[2]};
	const double *const two[3] = {labs->two[0], labs->two[1], labs->two[2]};

	spec_difference_ciede2000_row(one, two, count, labs->difference);
}

/* Sharma's pairs, as vectors of them. */
static void
test_ciede2000_row_sharma(void **state)
{
	static struct labs labs;

	(void)state;
	for (size_t i = 0; i < COUNT(sharma); i++) {
		for (size_t c = 0; c < 3; c++) {
			labs.one[c][i] = labs.two[c][COUNT(sharma) + i] = sharma[i][c];
			labs.two[c][i] = labs.one[c][COUNT(sharma) + i] = sharma[i][3 + c];
		}
	}
	take_differences(&labs, 2 * COUNT(sharma));
	for (size_t i = 0; i < 2 * COUNT(sharma); i++)
		near(labs.difference[i], sharma[i % COUNT(sharma)][6], 5.1e-5, "Sharma");
}

/* Beside one by one: near and far, greys, opposite hues, hues beside 0. */
static void
test_ciede2000_row(void **state)
{
	static struct labs labs;
	uint64_t random = 1;

	(void)state;
	for (size_t i = 0; i < PAIRS; i++) {
		double far = i % 2 ? 100 : pow(10, -(double)(i % 14));

		labs.one[0][i] = random_in(&random, 0, 100);
		labs.two[0][i] = labs.one[0][i] + far * random_in(&random, -.5, .5);
		for (size_t c = 1; c < 3; c++) {
			labs.one[c][i] = random_in(&random, -100, 100);
			labs.two[c][i] = labs.one[c][i] + far * random_in(&random, -.5, .5);
		}
		if (i % 16 == 3) /* opposite, exactly */
			for (size_t c = 1; c < 3; c++)
				labs.two[c][i] = -labs.one[c][i];
		if (i % 16 == 5) /* on either side of hue 0 */
			labs.two[2][i] = -(labs.one[2][i] *= 1e-3);
		if (i % 16 == 7)
			labs.one[1][i] = labs.one[2][i] = 0;
	}
	labs.one[1][99] = labs.two[0][100] = NAN;
	take_differences(&labs, PAIRS);
	for (size_t i = 0; i < PAIRS; i++) {
		const double one[3] = {labs.one[0][i], labs.one[1][i], labs.one[2][i]};
		const double two[3] = {labs.two[0][i], labs.two[1][i], labs.two[2][i]};

		if (i == 99 || i == 100)
			assert_true(isnan(labs.difference[i]));
		else
			near(labs.difference[i], spec_difference_ciede2000(one, two), 1e-11,
				"one by one");
	}
	memcpy(labs.two, labs.one, sizeof labs.two);
	take_differences(&labs, 99);
	for (size_t i = 0; i < 99; i++)
		near(labs.difference[i], 0, 0, "itself");
}

/* Over the joint of root and line, and below 0. */
static void
test_lab_row(void **state)
{
	static struct labs labs;
	double *const plane[3] = {labs.two[0], labs.two[1], labs.two[2]};
	uint64_t random = 1;

	(void)state;
	for (size_t i = 0; i < PAIRS; i++)
		for (size_t c = 0; c < 3; c++)
			labs.one[c][i] = i % 3 ? random_in(&random, -.02, .02)
					       : random_between(&random, 1e-3, 1e3);
	memcpy(labs.two, labs.one, sizeof labs.two);
	spec_lab_row(d65, plane, PAIRS);
	for (size_t i = 0; i < PAIRS; i++) {
		double xyz[3] = {labs.one[0][i], labs.one[1][i], labs.one[2][i]}, lab[3];
		double root = cbrt(fmax(fmax(xyz[0], 1), fmax(xyz[1], xyz[2])));

		/* 500 times two roots that are 4 units in the last place off. */
		spec_lab_from_xyz(xyz, d65, lab);
		for (size_t c = 0; c < 3; c++)
			near(labs.two[c][i], lab[c], 4000 * DBL_EPSILON * root,
				"one by one");
	}
}

static void
test_lab(void **state)
{
	/* B. Lindbloom's calculator: sRGB's red, its matrix for the white of ASTM E308. */
	const double red[3] = {.4124564, .2126729, .0193339};
	const double red_lab[3] = {53.2408, 80.0925, 67.2032};
	const double white_lab[3] = {100, 0, 0}, black[3] = {0, 0, 0};
	/* The straight part meets the root at L* = 8 (CIE 15). */
	const double joint[3] = {216 * d65[0] / 24389, 216. / 24389, 216 * d65[2] / 24389};
	const double joint_lab[3] = {8, 0, 0}, a[3] = {50, 1, 2}, b[3] = {52, 2, 4};
	double lab[3];

	(void)state;
	spec_lab_from_xyz(red, d65, lab);
	near_all(lab, red_lab, 3, 5.1e-5, "red");
	spec_lab_from_xyz(d65, d65, lab);
	near_all(lab, white_lab, 3, 1e-13, "white");
	spec_lab_from_xyz(black, d65, lab);
	near_all(lab, black, 3, 0, "black");
	spec_lab_from_xyz(joint, d65, lab);
	near_all(lab, joint_lab, 3, 1e-13, "joint");
	near(spec_difference_ab76(a, b), 3, 1e-15, "2, 1, 2");
}

/* Observers */

/* Smooth functions from 360 to 830 nm at 1 nm, of the shape of the CIE's. */
static void
make_observer(struct spec_curve *observer)
{
	static const double peak[3] = {1.06, 1, 1.78}, centre[3] = {595, 557, 449};
	static const double width[3] = {33, 42, 23};
	size_t i, c;

	assert_int_equal(spec_curve_new(471, 3, observer, NULL), SPEC_OK);
	for (i = 0; i < 471; i++) {
		observer->wavelength_nm[i] = 360. + (double)i;
		for (c = 0; c < 3; c++) {
			double t = (observer->wavelength_nm[i] - centre[c]) / width[c];

			observer->value[c * 471 + i] = peak[c] * exp(-.5 * t * t);
		}
	}
}

/* y is 1 everywhere, x rises from 0 and z falls to 0: their integrals are closed forms. */
static void
make_straight_observer(struct spec_curve *observer)
{
	size_t i;

	assert_int_equal(spec_curve_new(101, 3, observer, NULL), SPEC_OK);
	for (i = 0; i < 101; i++) {
		observer->wavelength_nm[i] = 400. + (double)i;
		observer->value[i] = (double)i;
		observer->value[101 + i] = 1;
		observer->value[202 + i] = 100. - (double)i;
	}
}

/* The sum over the observer's samples from..to of one function times a + b nm. */
static double
ramp_sum(const struct spec_curve *observer, size_t c, double from, double to, double a,
	double b)
{
	double sum = 0;
	size_t i;

	for (i = 0; i < observer->count; i++)
		if (observer->wavelength_nm[i] >= from && observer->wavelength_nm[i] <= to)
			sum += observer->value[c * observer->count + i] *
			       (a + b * observer->wavelength_nm[i]);
	return sum;
}

static double
dot(const double *weight, const double *value, size_t count)
{
	double sum = 0;
	size_t i;

	for (i = 0; i < count; i++)
		sum += weight[i] * (value ? value[i] : 1);
	return sum;
}

/* A flat image on any grid: Y is the covered fraction. */
static void
test_observer_flat(void **state)
{
	static const double odd[] = {381.3, 400, 400.2, 447.77, 500, 612.5, 613, 699.999};
	struct spec_bands bands = {COUNT(odd), odd, NULL, 0};
	double weight[3 * COUNT(odd)], outside, all, part;
	struct spec_curve observer;
	size_t c;

	(void)state;
	make_observer(&observer);
	assert_int_equal(
		spec_observer_weights(&observer, NULL, &bands, weight, &outside, NULL),
		SPEC_OK);
	all = ramp_sum(&observer, 1, 360, 830, 1, 0);
	for (c = 0; c < 3; c++)
		near(dot(weight + c * COUNT(odd), NULL, COUNT(odd)),
			ramp_sum(&observer, c, 381.3, 699.999, 1, 0) / all, 1e-14, "flat");
	part = ramp_sum(&observer, 1, 381.3, 699.999, 1, 0) / all;
	near(outside, 1 - part, 1e-14, "outside");
	assert_true(outside > 1e-4);
	spec_curve_free(&observer);
}

/* A ramp at 10 nm is linear between its samples: the 1 nm sum exactly. */
static void
test_observer_ramp(void **state)
{
	struct spec_bands bands = {41, NULL, NULL, 0};
	double nm[41], value[41], weight[123], outside, all;
	struct spec_curve observer;
	size_t c, i;

	(void)state;
	for (i = 0; i < 41; i++) {
		nm[i] = 380 + 10. * (double)i;
		value[i] = 2 + .01 * nm[i];
	}
	bands.wavelength_nm = nm;
	make_observer(&observer);
	assert_int_equal(
		spec_observer_weights(&observer, NULL, &bands, weight, &outside, NULL),
		SPEC_OK);
	all = ramp_sum(&observer, 1, 360, 830, 1, 0);
	for (c = 0; c < 3; c++)
		near(dot(weight + c * 41, value, 41),
			ramp_sum(&observer, c, 380, 780, 2, .01) / all, 1e-13, "ramp");
	/* Ends that rounding moved inwards still count. */
	nm[0] += 1e-9;
	nm[40] -= 1e-9;
	assert_int_equal(
		spec_observer_weights(&observer, NULL, &bands, weight, &outside, NULL),
		SPEC_OK);
	near(dot(weight + 41, value, 41), ramp_sum(&observer, 1, 380, 780, 2, .01) / all,
		1e-10, "ramp, ends moved");
	spec_curve_free(&observer);
}

/* Bins: the integrals of straight functions, with parts of a step and parts outside. */
static void
test_observer_bins(void **state)
{
	static const double edge[] = {390, 400.25, 400.75, 433.3, 450, 500, 600};
	struct spec_bands bands = {6, NULL, edge, 0};
	double weight[18], density[18], outside;
	struct spec_curve observer;
	size_t i;

	(void)state;
	make_straight_observer(&observer);
	assert_int_equal(
		spec_observer_weights(&observer, NULL, &bands, weight, &outside, NULL),
		SPEC_OK);
	for (i = 0; i < 6; i++) {
		double a = fmax(edge[i], 400) - 400, b = fmin(edge[i + 1], 500) - 400;
		double width = fmax(b - a, 0), middle = .5 * (a + b);

		near(weight[i], width * middle / 101, 1e-13, "x");
		near(weight[6 + i], width / 101, 1e-13, "y");
		near(weight[12 + i], width * (100 - middle) / 101, 1e-13, "z");
	}
	/* 100 nm of integral against 101 samples in the normalisation. */
	near(outside, 1. / 101, 1e-13, "outside");
	bands.per_band = 1;
	assert_int_equal(
		spec_observer_weights(&observer, NULL, &bands, density, &outside, NULL),
		SPEC_OK);
	for (i = 0; i < 18; i++)
		near(density[i], weight[i] / (edge[i % 6 + 1] - edge[i % 6]), 1e-15,
			"per band");
	near(outside, 1. / 101, 1e-13, "outside");
	spec_curve_free(&observer);
}

static void
test_observer_per_band(void **state)
{
	static const double nm[] = {350, 405.25, 425, 500};
	struct spec_bands bands = {4, nm, NULL, 1};
	double weight[12], outside;
	struct spec_curve observer;

	(void)state;
	make_straight_observer(&observer);
	assert_int_equal(
		spec_observer_weights(&observer, NULL, &bands, weight, &outside, NULL),
		SPEC_OK);
	near(weight[0], 0, 0, "outside the table");
	near(weight[1], 5.25 / 101, 1e-16, "x");
	near(weight[5], 1. / 101, 1e-16, "y");
	near(weight[9], 94.75 / 101, 1e-15, "z");
	near(weight[3], 100. / 101, 1e-15, "x at the end");
	near(outside, 0, 0, "outside");
	/* Half a step beyond 425 and 445: the samples 415 to 455. */
	bands = (struct spec_bands){2, (const double[]){425, 445}, NULL, 1};
	assert_int_equal(
		spec_observer_weights(&observer, NULL, &bands, weight, &outside, NULL),
		SPEC_OK);
	near(outside, 60. / 101, 1e-15, "outside");
	/* One laser line: its energy times the function there. */
	bands = (struct spec_bands){1, (const double[]){450.5}, NULL, 1};
	assert_int_equal(
		spec_observer_weights(&observer, NULL, &bands, weight, &outside, NULL),
		SPEC_OK);
	near(weight[0], 50.5 / 101, 1e-15, "line");
	near(outside, 0, 0, "outside");
	spec_curve_free(&observer);
}

/* The perfect reflector has Y = 1 where the illuminant has data, and the white's XYZ. */
static void
test_observer_illuminant(void **state)
{
	double nm[42], edge[] = {380, 780}, weight[126], outside, white[3], sum;
	struct spec_bands bands = {42, nm, NULL, 0}, one = {1, NULL, edge, 0};
	struct spec_curve observer, lamp;
	size_t i, c;

	(void)state;
	make_observer(&observer);
	assert_int_equal(spec_curve_new(81, 1, &lamp, NULL), SPEC_OK);
	for (i = 0; i < 81; i++) {
		lamp.wavelength_nm[i] = 380 + 5. * (double)i;
		lamp.value[i] = lamp.wavelength_nm[i] - 300;
	}
	for (i = 0; i < 42; i++)
		nm[i] = 375 + 10. * (double)i;
	assert_int_equal(spec_observer_white(&observer, &lamp, white, NULL), SPEC_OK);
	assert_int_equal(
		spec_observer_weights(&observer, &lamp, &bands, weight, &outside, NULL),
		SPEC_OK);
	sum = ramp_sum(&observer, 1, 380, 780, -300, 1);
	for (c = 0; c < 3; c++) {
		near(white[c], ramp_sum(&observer, c, 380, 780, -300, 1) / sum, 1e-14,
			"white");
		near(dot(weight + 42 * c, NULL, 42), white[c], 1e-14, "reflector");
	}
	near(white[1], 1, 0, "Y");
	near(outside, 0, 1e-14, "outside");
	/* One wide bin of reflectance; the ends of the sum carry almost nothing. */
	assert_int_equal(
		spec_observer_weights(&observer, &lamp, &one, weight, &outside, NULL),
		SPEC_OK);
	near(weight[1], 1, 1e-5, "bin");
	assert_int_equal(spec_observer_white(&observer, NULL, white, NULL), SPEC_OK);
	near(white[0],
		ramp_sum(&observer, 0, 360, 830, 1, 0) /
			ramp_sum(&observer, 1, 360, 830, 1, 0),
		1e-14, "equal energy");
	spec_curve_free(&observer);
	spec_curve_free(&lamp);
}

static void
refused(const struct spec_curve *observer, const struct spec_curve *illuminant,
	struct spec_bands bands, enum spec_status status, const char *part)
{
	struct spec_error error = {0};
	double weight[30], outside;

	assert_int_equal(spec_observer_weights(
				 observer, illuminant, &bands, weight, &outside, &error),
		status);
	assert_int_equal(error.status, status);
	if (!strstr(error.message, part))
		fail_msg("'%s' lacks '%s'", error.message, part);
}

static void
test_observer_errors(void **state)
{
	static const double good[] = {400, 500, 600}, falling[] = {400, 600, 500};
	static const double twice[] = {400, 400, 500}, nan[] = {400, NAN, 600};
	static const double infrared[] = {900, 1000, 1100},
			    between[] = {500.2, 500.5, 500.8};
	struct spec_curve observer, lamp;

	(void)state;
	make_observer(&observer);
	assert_int_equal(spec_curve_new(2, 1, &lamp, NULL), SPEC_OK);
	lamp.wavelength_nm[0] = 900;
	lamp.wavelength_nm[1] = 1000;
	lamp.value[0] = lamp.value[1] = 1;
	refused(&observer, NULL, (struct spec_bands){0, good, NULL, 0}, SPEC_EUSAGE,
		"no bands");
	refused(&observer, NULL, (struct spec_bands){1, good, NULL, 0}, SPEC_ERANGE,
		"no width");
	refused(&observer, NULL, (struct spec_bands){3, falling, NULL, 0}, SPEC_ERANGE,
		"500 nm follows 600 nm");
	refused(&observer, NULL, (struct spec_bands){3, twice, NULL, 0}, SPEC_ERANGE,
		"ascend");
	refused(&observer, NULL, (struct spec_bands){3, nan, NULL, 0}, SPEC_ERANGE,
		"finite");
	refused(&observer, NULL, (struct spec_bands){2, NULL, falling, 0}, SPEC_ERANGE,
		"edge");
	refused(&observer, NULL, (struct spec_bands){3, infrared, NULL, 0}, SPEC_ERANGE,
		"900..1100 nm");
	refused(&observer, NULL, (struct spec_bands){2, NULL, infrared, 0}, SPEC_ERANGE,
		"360..830 nm");
	refused(&observer, NULL, (struct spec_bands){1, infrared, NULL, 1}, SPEC_ERANGE,
		"outside");
	refused(&observer, NULL, (struct spec_bands){3, between, NULL, 0}, SPEC_ERANGE,
		"between");
	refused(&observer, &lamp, (struct spec_bands){3, good, NULL, 0}, SPEC_ERANGE,
		"900..1000 nm");
	refused(&observer, &lamp, (struct spec_bands){3, good, NULL, 1}, SPEC_EUSAGE,
		"per band");
	refused(&lamp, NULL, (struct spec_bands){3, good, NULL, 0}, SPEC_EFORMAT,
		"x, y and z");
	lamp.wavelength_nm[0] = 500;
	lamp.value[0] = lamp.value[1] = 0;
	refused(&observer, &lamp, (struct spec_bands){3, good, NULL, 0}, SPEC_EFORMAT,
		"positive");
	observer.wavelength_nm[7] += .1;
	refused(&observer, NULL, (struct spec_bands){3, good, NULL, 0}, SPEC_EFORMAT,
		"367.1 nm");
	spec_curve_free(&observer);
	spec_curve_free(&lamp);
}

/* Tristimulus values of illuminants as CIE 15:2004, table T.3, prints them. */
static void
test_observer_whites(void **state)
{
	static const struct {
		const char *path;
		double xyz[3];
	} known[] = {
		{"spectra/illuminants/D65.spd", {.95047, 1, 1.08883}}, /* ASTM E308 */
		{"spectra/illuminants/A.spd", {1.09850, 1, .35585}},
	};
	struct spec_curve observer, lamp;
	struct spec_error error;
	double white[3];
	size_t i;

	(void)state;
	assert_int_equal(
		spec_spd_load("spectra/cmf/cie1931.spd", &observer, &error), SPEC_OK);
	for (i = 0; i < COUNT(known); i++) {
		assert_int_equal(spec_spd_load(known[i].path, &lamp, &error), SPEC_OK);
		assert_int_equal(
			spec_observer_white(&observer, &lamp, white, &error), SPEC_OK);
		near_all(white, known[i].xyz, 3, 1e-4, known[i].path);
		spec_curve_free(&lamp);
	}
	spec_curve_free(&observer);
}

int
main(void)
{
	const struct CMUnitTest tests[] = {
		cmocka_unit_test(test_space_srgb),
		cmocka_unit_test(test_space_others),
		cmocka_unit_test(test_space_degenerate),
		cmocka_unit_test(test_adaptation_bradford),
		cmocka_unit_test(test_adaptation_cat16),
		cmocka_unit_test(test_adaptation_rules),
		cmocka_unit_test(test_srgb_scalar),
		cmocka_unit_test(test_encode8_thresholds),
		cmocka_unit_test(test_encode_sweep),
		cmocka_unit_test(test_encode16_thresholds),
		cmocka_unit_test(test_encode16_runs),
		cmocka_unit_test(test_encode_special),
		cmocka_unit_test(test_encode_stride),
		cmocka_unit_test(test_ciede2000_sharma),
		cmocka_unit_test(test_cie94),
		cmocka_unit_test(test_ciede2000_nan),
		cmocka_unit_test(test_ciede2000_row_sharma),
		cmocka_unit_test(test_ciede2000_row),
		cmocka_unit_test(test_lab_row),
		cmocka_unit_test(test_lab),
		cmocka_unit_test(test_observer_flat),
		cmocka_unit_test(test_observer_ramp),
		cmocka_unit_test(test_observer_bins),
		cmocka_unit_test(test_observer_per_band),
		cmocka_unit_test(test_observer_illuminant),
		cmocka_unit_test(test_observer_errors),
		cmocka_unit_test(test_observer_whites),
	};

	return cmocka_run_group_tests_name("colour", tests, NULL, NULL);
}
