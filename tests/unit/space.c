/* Spaces as users name them, their matrices, transfer functions and other coordinates. */
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "colour/coordinates.h"
#include "colour/encode.h"
#include "colour/space.h"

#include "check.h"

static void
near_all(const double *got, const double *wanted, size_t count, double tolerance,
	const char *what)
{
	for (size_t i = 0; i < count; i++)
		near(got[i], wanted[i], tolerance, what);
}

/* To XYZ, as published; within a unit of the last digit that is printed. */
static void
test_matrices(void **state)
{
	static const struct {
		const char *name;
		double m[9], tolerance;
	} published[] = {
		/* SMPTE ST 2065-1:2012, equation 1 */
		{"aces",
			{.9525523959, 0, .0000936786, .3439664498, .7281660966,
				-.0721325464, 0, 0, 1.0088251844},
			6e-11},
		/* Academy S-2014-004, 2016, appendix A */
		{"acescg",
			{.6624541811, .1340042065, .1561876870, .2722287168, .6740817658,
				.0536895174, -.0055746495, .0040607335, 1.0103391003},
			6e-11},
		/* Adobe RGB (1998), 2005-05, 4.3.5.3 */
		{"adobe",
			{.57667, .18556, .18823, .29734, .62736, .07529, .02703, .07069,
				.99134},
			6e-6},
		/* Primaries and white of SMPTE RP 431-2:2011, solved in exact fractions */
		{"dci-p3",
			{.44517, .27713, .17228, .20949, .72160, .06891, 0, .04706, .90736},
			6e-6},
		/* SMPTE EG 432-1:2010 with D65, as in CSS Color 4, of 7 digits */
		{"p3",
			{.4865709, .2656677, .1982173, .2289746, .6917385, .0792869, 0,
				.0451134, 1.0439444},
			1e-7},
		{"rec2020",
			{.6369580, .1446169, .1688810, .2627002, .6779981, .0593017, 0,
				.0280727, 1.0609851},
			1e-7},
		{"rec709",
			{.4123908, .3575843, .1804808, .2126390, .7151687, .0721923,
				.0193308, .1191948, .9505322},
			1e-7},
		{"xyz", {1, 0, 0, 0, 1, 0, 0, 0, 1}, 1e-15},
		{"lab", {1, 0, 0, 0, 1, 0, 0, 0, 1}, 1e-15},
	};
	struct spec_space space;
	double m[9];

	(void)state;
	for (size_t i = 0; i < COUNT(published); i++) {
		assert_int_equal(
			spec_space_parse(published[i].name, &space, NULL), SPEC_OK);
		assert_int_equal(spec_space_to_xyz(&space, m, NULL), SPEC_OK);
		near_all(m, published[i].m, 9, published[i].tolerance, published[i].name);
	}
}

static void
test_parse(void **state)
{
	static const char *const bad[] = {"", "srgbb", "s-rgb", ",", "1,2",
		"1,2,3,4,5,6,7,8", ".64,.33 .3,.6 .15,.06",
		".64,.33 .3,.6 .15,.06 .3127,.329 .1,.1", ".64,.33 .3,.6 .15,.06 .3127,",
		".64,.33 .3,.6 .15,.06 .3127,x", ".64,.33 .3,.6 .15,.06 .3127,nan",
		".64,.33 .3,.6 .15,.06 .3127,0", ".1,.1 .2,.2 .3,.3 .3127,.329",
		".64,.33 .3,.6 .15,.06 .3127,-.3"};
	struct spec_space space, known;
	struct spec_error error;
	double m[9], wanted[9];

	(void)state;
	assert_int_equal(
		spec_space_parse(".64,.33 .3,.6 .15,.06 .3127,.3290", &space, &error),
		SPEC_OK);
	assert_string_equal(space.name, "custom");
	assert_ptr_equal(space.transfer, &spec_transfer_srgb);
	assert_int_equal(spec_space_parse("srgb", &known, &error), SPEC_OK);
	assert_int_equal(spec_space_to_xyz(&space, m, NULL), SPEC_OK);
	assert_int_equal(spec_space_to_xyz(&known, wanted, NULL), SPEC_OK);
	near_all(m, wanted, 9, 0, "custom");
	for (size_t i = 0; i < COUNT(bad); i++) {
		memset(&error, 0, sizeof error);
		if (spec_space_parse(bad[i], &space, &error) != SPEC_EUSAGE)
			fail_msg("'%s' is taken", bad[i]);
		assert_true(error.message[0] != 0);
	}
	assert_int_equal(
		spec_space_parse(".6,.3 .6,.3 .15,.06 .3,.3", &space, &error), SPEC_EUSAGE);
	assert_contains(error.message, "primaries of a custom RGB space lie on one line");
	assert_int_equal(
		spec_space_parse("0,0 1,0 0,1 .5,.5", &space, &error), SPEC_EUSAGE);
	assert_contains(error.message, "space lies on a line with two of its primaries");
	/* As their standards write them. */
	assert_int_equal(spec_space_parse("sRGB", &space, &error), SPEC_OK);
	assert_string_equal(space.name, "srgb");
	assert_ptr_equal(spec_space_find("ACEScg", NULL), spec_space_find("acescg", NULL));
}

/* ASTM E308's whites, as in test_adaptation_bradford. */
static const double d65[3] = {.95047, 1, 1.08883}, d50[3] = {.96422, 1, .82521};

static void
test_adaptation(void **state)
{
	/* B. Lindbloom, Chromatic Adaptation (2017): von Kries, D65 to D50. */
	static const double lindbloom[9] = {1.0160803, .0552297, -.0521326, .0060666,
		.9955661, -.0012235, 0, 0, .7578869};
	/* CIE 159:2004, table of the matrix and its printed inverse, of 6 digits. */
	static const double inverse[9] = {1.096124, -.278869, .182745, .454369, .473533,
		.072098, -.009628, -.005698, 1.015326};
	static const char *const names[] = {
		"none", "vonkries", "bradford", "cat02", "cat16"};
	static const double channels[9] = {
		.7328, .4296, -.1624, -.7036, 1.6975, .0061, .0030, .0136, .9834};
	enum spec_adaptation method;
	double m[9], gain[9] = {0}, from[3], to[3];

	(void)state;
	assert_int_equal(spec_adaptation_find("vonkries", &method, NULL), SPEC_OK);
	assert_int_equal(spec_adaptation_matrix(method, d65, d50, m, NULL), SPEC_OK);
	near_all(m, lindbloom, 9, 1e-7, "von Kries");
	spec_matrix_apply(channels, d65, from);
	spec_matrix_apply(channels, d50, to);
	for (int i = 0; i < 3; i++)
		gain[4 * i] = to[i] / from[i];
	spec_matrix_multiply(gain, channels, gain);
	spec_matrix_multiply(inverse, gain, gain);
	assert_int_equal(spec_adaptation_find("cat02", &method, NULL), SPEC_OK);
	assert_int_equal(spec_adaptation_matrix(method, d65, d50, m, NULL), SPEC_OK);
	near_all(m, gain, 9, 2e-6, "CAT02");
	for (size_t i = 1; i < COUNT(names); i++) {
		assert_int_equal(spec_adaptation_find(names[i], &method, NULL), SPEC_OK);
		assert_int_equal(
			spec_adaptation_matrix(method, d65, d50, m, NULL), SPEC_OK);
		spec_matrix_apply(m, d65, to);
		near_all(to, d50, 3, 1e-14, names[i]);
	}
}

/* The standards' own formulas in long double, once more. */
static long double
encode_long(const char *name, long double v)
{
	if (strcmp(name, "srgb") == 0)
		return v <= .0031308L ? 12.92L * v : 1.055L * powl(v, 1 / 2.4L) - .055L;
	if (strcmp(name, "rec709") == 0)
		return v <= .018L ? 4.5L * v : 1.099L * powl(v, .45L) - .099L;
	if (strcmp(name, "rec2020") == 0)
		return v <= .018053968510807L
			       ? 4.5L * v
			       : 1.09929682680944L * powl(v, .45L) - .09929682680944L;
	if (strncmp(name, "gamma:", 6) == 0)
		return powl(v, 1 / strtold(name + 6, NULL));
	if (strcmp(name, "adobe") == 0)
		return powl(v, 1 / 2.19921875L);
	return strcmp(name, "dci") == 0 ? powl(v, 1 / 2.6L) : v;
}

static void
test_transfer(void **state)
{
	struct spec_error error;

	(void)state;
	for (size_t i = 0; spec_transfer_at(i); i++) {
		const struct spec_transfer *transfer = spec_transfer_at(i);
		/* How far apart the parts are where they meet, in encoded units. */
		double gap = strcmp(transfer->name, "rec709") == 0 ? 2.6e-4 : 3e-8;

		assert_ptr_equal(spec_transfer_find(transfer->name, NULL), transfer);
		for (double v = 0; v <= 2; v += 1. / 1024) {
			double encoded = spec_transfer_encode(transfer, v);
			int meeting = fabs(v - transfer->cut) < 2e-3;

			near(encoded, (double)encode_long(transfer->name, v),
				1e-15 * (1 + v), transfer->name);
			near(spec_transfer_decode(transfer, encoded), v,
				meeting ? gap : 1e-15 * (1 + v), transfer->name);
		}
		near(spec_transfer_encode(transfer, 1), 1, 1e-15, transfer->name);
		assert_true(isnan(spec_transfer_encode(transfer, NAN)));
		assert_true(isnan(spec_transfer_decode(transfer, NAN)));
	}
	assert_null(spec_transfer_find("gamma", &error));
	assert_int_equal(error.status, SPEC_EUSAGE);
	assert_null(spec_transfer_find("gamma:2", &error));
	assert_int_equal(error.status, SPEC_EUSAGE);
}

/* Powers by number: of a few, and of the two at the ends. */
static void
test_gamma(void **state)
{
	static const char *const none[] = {"gamma", "gamma:", "gamma:0.99", "gamma:2.61",
		"gamma:nan", "gamma:2.2x", "gamma:-2", "2.2"};
	struct spec_transfer own;
	struct spec_error error;

	(void)state;
	assert_ptr_equal(spec_transfer_parse("srgb", &own, NULL), &spec_transfer_srgb);
	assert_ptr_equal(spec_transfer_parse("gamma:1", &own, NULL), &spec_transfer_linear);
	assert_ptr_equal(spec_transfer_parse("gamma:1.8", &own, NULL), &own);
	assert_string_equal(own.name, "gamma:1.8");
	near(spec_transfer_encode(&own, .5), .680395, 1e-6, "ROMM RGB's power");
	near(spec_transfer_decode(&own, .25), pow(.25, 1.8), 1e-15, "gamma:1.8 back");
	assert_int_equal(own.cicp, 0);
	assert_ptr_equal(spec_transfer_parse("gamma:2.2", &own, NULL), &own);
	assert_int_equal(own.cicp, 4);
	for (size_t i = 0; i < COUNT(none); i++) {
		assert_null(spec_transfer_parse(none[i], &own, &error));
		assert_int_equal(error.status, SPEC_EUSAGE);
	}
}

enum { RUN = 600 }; /* more than two blocks of the encoders' */

/* The codes of a run of floats, as they lie, beside the formula in long double. */
static void
check_run(const struct spec_encoder *encoder, const float *v)
{
	static unsigned char code[RUN];
	static uint16_t word[RUN];

	spec_encode8(encoder, v, RUN, code, 1);
	spec_encode16(encoder, v, RUN, word, 1);
	for (size_t i = 0; i < RUN; i++) {
		long double clamped =
			encode_long(encoder->transfer->name, v[i] < 1 ? v[i] : 1);

		if (code[i] != (int)floorl(255 * clamped + .5L) ||
			word[i] != (int)floorl(65535 * clamped + .5L))
			fail_msg("%s of %a: %d, %d", encoder->transfer->name, (double)v[i],
				code[i], word[i]);
	}
}

/* Every code of 8 bits at both sides of its threshold; 16 bits in a sweep. */
static void
check_encoder(struct spec_encoder *encoder, const struct spec_transfer *transfer)
{
	static float v[RUN];
	uint32_t bits = 0;

	spec_encoder_init(encoder, transfer);
	while (bits < 0x3f900000) {
		for (size_t k = 0; k < RUN; k++, bits += 3001)
			memcpy(&v[k], &bits, sizeof bits);
		check_run(encoder, v);
	}
	for (int code = 1; code < 256; code++) {
		float around[2] = {
			nextafterf(encoder->threshold[code], 0), encoder->threshold[code]};
		unsigned char got[2];

		spec_encode8(encoder, around, 2, got, 1);
		assert_int_equal(got[0], code - 1);
		assert_int_equal(got[1], code);
	}
}

static void
test_encoders(void **state)
{
	static const char *const gammas[] = {
		"gamma:1.0001", "gamma:1.05", "gamma:1.8", "gamma:2.2", "gamma:2.6"};
	struct spec_encoder *encoder = malloc(sizeof *encoder);
	struct spec_transfer own;

	(void)state;
	assert_non_null(encoder);
	for (size_t i = 0; spec_transfer_at(i); i++)
		check_encoder(encoder, spec_transfer_at(i));
	for (size_t i = 0; i < COUNT(gammas); i++)
		check_encoder(encoder, spec_transfer_parse(gammas[i], &own, NULL));
	free(encoder);
}

static void
test_coordinates(void **state)
{
	/* L* of Y = (6/29)^3 is 8; X = Xn / 8 has f = 1/2; Z = Zn f = 1. */
	float x = .95047f / 8, y = 216.f / 24389, z = 1.08883f;
	float *plane[3] = {&x, &y, &z};

	(void)state;
	spec_coordinates_row(SPEC_COORDINATES_LAB, d65, plane, 1);
	near(x, 8, 1e-5, "L*");
	near(y, 500 * (.5 - 6. / 29), 1e-4, "a*");
	near(z, 200 * (6. / 29 - 1), 1e-4, "b*");
	x = .3f, y = .5f, z = .2f;
	spec_coordinates_row(SPEC_COORDINATES_XYY, d65, plane, 1);
	near(x, .3, 1e-7, "x");
	near(y, .5, 1e-7, "y");
	near(z, .5, 1e-7, "Y");
	x = y = z = 0;
	spec_coordinates_row(SPEC_COORDINATES_XYY, d65, plane, 1);
	near(x, .312727, 1e-6, "x of black");
	near(y, .329023, 1e-6, "y of black");
	near(z, 0, 0, "Y of black");
	x = 7;
	spec_coordinates_row(SPEC_COORDINATES_XYZ, d65, plane, 1);
	near(x, 7, 0, "X");
}

int
main(void)
{
	const struct CMUnitTest tests[] = {cmocka_unit_test(test_matrices),
		cmocka_unit_test(test_parse), cmocka_unit_test(test_adaptation),
		cmocka_unit_test(test_transfer), cmocka_unit_test(test_gamma),
		cmocka_unit_test(test_encoders), cmocka_unit_test(test_coordinates)};

	return cmocka_run_group_tests(tests, NULL, NULL);
}
