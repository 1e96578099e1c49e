/* Images made into one: what goes together, what comes out, and its values in one pixel. */
#include <stdio.h>
#include <stdlib.h>

#include "compare/arithmetic.h"
#include "image/samples.h"

#include "check.h"

enum { MOST_IMAGES = 4, MOST_CHANNELS = 32 };

/* Images of one pixel, made anew for each case, and what is planned with them. */
static struct spec_image image[MOST_IMAGES];
static struct spec_match input[MOST_IMAGES];
static float sample[MOST_IMAGES][MOST_CHANNELS];
static size_t images;
static struct spec_arithmetic arithmetic;
static struct spec_error error;

static const char *const names[MOST_IMAGES] = {"a.exr", "b.exr", "c.exr", "d.exr"};

static void
ok(enum spec_status status)
{
	if (status != SPEC_OK)
		fail_msg("%s\n%s", error.message, error.place);
}

static void
clear(void)
{
	spec_arithmetic_free(&arithmetic);
	for (size_t i = 0; i < images; i++)
		spec_image_clear(&image[i]);
	images = 0;
}

/* Another image, with bands at 400, 500 ... nm and the channels named, which end with null. */
static struct spec_image *
new_image(enum spec_role role, int stokes, size_t bands, const char *const *channel)
{
	static const double nm[] = {400, 500, 600, 700};
	struct spec_image *fresh = &image[images];

	*fresh = (struct spec_image){0};
	fresh->data = fresh->display = (struct spec_window){0, 0, 1, 1};
	if (bands > 0)
		ok(spec_image_add_bands(
			fresh, role, stokes, nm, bands, SPEC_SAMPLE_FLOAT, &error));
	for (; channel && *channel; channel++)
		ok(spec_image_add_channel(fresh, *channel,
			strstr(*channel, "id") ? SPEC_SAMPLE_UINT : SPEC_SAMPLE_FLOAT,
			&error));
	ok(spec_image_index(fresh, names[images], &error));
	input[images] = (struct spec_match){fresh, names[images]};
	for (size_t i = 0; i < fresh->channels; i++)
		sample[images][i] = (float)(images + 1);
	images++;
	return fresh;
}

static struct spec_image *
light(void)
{
	return new_image(SPEC_ROLE_EMISSIVE, 1, 2, NULL);
}

static struct spec_image *
reflectance(void)
{
	return new_image(SPEC_ROLE_REFLECTIVE, 1, 2, NULL);
}

static void
set_sample(const struct spec_image *of, const char *channel, double value)
{
	size_t at = spec_image_find_channel(of, channel);
	uint32_t whole = (uint32_t)value;

	assert_true(at < of->channels);
	if (of->channel[at].sample == SPEC_SAMPLE_UINT)
		memcpy(&sample[of - image][at], &whole, sizeof whole);
	else
		sample[of - image][at] = (float)value;
}

static enum spec_status
plan_setup(const struct spec_arithmetic_setup *setup)
{
	spec_arithmetic_free(&arithmetic);
	return spec_arithmetic_plan(&arithmetic, input, images, setup, &error);
}

static enum spec_status
plan(enum spec_arithmetic_operation operation)
{
	const struct spec_arithmetic_setup setup = {
		.operation = operation, .kind = SPEC_ROLE_OTHER};

	return plan_setup(&setup);
}

static enum spec_status
plan_expression(const char *text, enum spec_role kind)
{
	const struct spec_arithmetic_setup setup = {
		.operation = SPEC_ARITHMETIC_EXPRESSION, .expression = text, .kind = kind};

	return plan_setup(&setup);
}

static void
refused_as(enum spec_status status, const char *part)
{
	if (status == SPEC_OK)
		fail_msg("taken in place of '%s'", part);
	if (!strstr(error.message, part))
		fail_msg("'%s' is not in '%s'", part, error.message);
	assert_int_equal(arithmetic.image.channels, 0);
	clear();
}

/* The output's sample of that channel, in its one pixel. */
static double
value_of(const char *channel)
{
	size_t at = spec_image_find_channel(&arithmetic.image, channel);
	const struct spec_arithmetic_source *source;
	const struct spec_program *program;
	const float *row[4 * MOST_IMAGES];
	float to;
	uint32_t whole;
	void *scratch;

	if (at == arithmetic.image.channels)
		fail_msg("no channel '%s'", channel);
	source = &arithmetic.source[at];
	if (source->program == SPEC_PROGRAM_NONE) {
		assert_true(arithmetic.wanted[0][source->channel]);
		to = sample[0][source->channel];
	} else {
		program = &arithmetic.program[source->program];
		assert_in_range(program->rows, 0, COUNT(row));
		assert_in_range(program->rows, 0, arithmetic.most_rows);
		for (size_t i = 0; i < program->rows; i++) {
			assert_true(arithmetic.wanted[program->row[i].image]
						     [program->row[i].channel]);
			row[i] = &sample[program->row[i].image][program->row[i].channel];
		}
		assert_in_range(spec_program_scratch(program), 0, arithmetic.scratch_bytes);
		scratch = aligned_alloc(64, arithmetic.scratch_bytes + 64);
		assert_non_null(scratch);
		spec_program_run(program, row, 1, 0, scratch, &to);
		free(scratch);
	}
	if (arithmetic.image.channel[at].sample != SPEC_SAMPLE_UINT)
		return to;
	memcpy(&whole, &to, sizeof whole);
	return whole;
}

static void
is(const char *channel, double want)
{
	double got = value_of(channel);

	if (got != want && got != (float)want && !(isnan(got) && isnan(want)))
		fail_msg("%s: got %.9g, wanted %.9g", channel, got, want);
}

static void
has_text(const char *attribute, const char *want)
{
	char *text;

	ok(spec_image_text(&arithmetic.image, attribute, &text, &error));
	if (!want)
		assert_null(text);
	else if (!text || strcmp(text, want) != 0)
		fail_msg("%s is '%s'", attribute, text ? text : "not there");
	free(text);
}

static void
has_samples(long long want)
{
	long long samples;

	ok(spec_samples_get(&arithmetic.image, &samples, "the result", &error));
	assert_int_equal(samples, want);
}

#define BAND "S0.500,000000nm"
#define RATIO "T.500,000000nm"

/* Two or three images of light, whose band has these values; NaN: no third. */
static void
lights(double a, double b, double c)
{
	set_sample(light(), BAND, a);
	set_sample(light(), BAND, b);
	if (!isnan(c))
		set_sample(light(), BAND, c);
}

static void
gives(enum spec_arithmetic_operation operation, double want)
{
	ok(plan(operation));
	is(BAND, want);
	assert_int_equal(arithmetic.image.role, SPEC_ROLE_EMISSIVE);
	has_text("emissiveUnits", "W.m^-2.sr^-1");
	has_text("spectralLayoutVersion", "1.0");
	clear();
}

static void
test_values(void **state)
{
	(void)state;
	lights(1.5, 0.25, -4);
	gives(SPEC_ARITHMETIC_ADD, -2.25);
	lights(1.5, 0.25, NAN);
	gives(SPEC_ARITHMETIC_SUBTRACT, 1.25);
	lights(1.5, 0.25, -4);
	gives(SPEC_ARITHMETIC_MIN, -4);
	lights(1.5, 0.25, -4);
	gives(SPEC_ARITHMETIC_MAX, 1.5);
	lights(1.5, 0.25, -4);
	gives(SPEC_ARITHMETIC_MEAN, -0.75);
	/* NaN in one image is NaN in the result, whichever it is. */
	for (int i = 0; i < 4; i++) {
		static const enum spec_arithmetic_operation all[] = {SPEC_ARITHMETIC_ADD,
			SPEC_ARITHMETIC_MIN, SPEC_ARITHMETIC_MAX, SPEC_ARITHMETIC_MEAN};

		lights(1, 2, 3);
		sample[i % 3][1] = NAN;
		gives(all[i], NAN);
	}
	/* In double precision, rounded once: float would lose the ones. */
	lights(1, 16777216, -16777216);
	gives(SPEC_ARITHMETIC_ADD, 1);
}

static void
test_products(void **state)
{
	(void)state;
	lights(6, 1, NAN); /* the second is to be reflectance */
	spec_image_clear(&image[--images]);
	set_sample(reflectance(), RATIO, 0.5);
	ok(plan(SPEC_ARITHMETIC_MULTIPLY));
	is(BAND, 3);
	clear();
	set_sample(reflectance(), RATIO, 0.5);
	set_sample(reflectance(), RATIO, 0.25);
	set_sample(light(), BAND, 8);
	ok(spec_image_set_text(&image[2], "spec:quantity", "radiance per band", &error));
	ok(plan(SPEC_ARITHMETIC_MULTIPLY));
	is(BAND, 1);
	has_text("spec:quantity", "radiance per band");
	assert_int_equal(arithmetic.image.role, SPEC_ROLE_EMISSIVE);
	clear();
	set_sample(reflectance(), RATIO, 0.5);
	set_sample(reflectance(), RATIO, 0.25);
	ok(plan(SPEC_ARITHMETIC_MULTIPLY));
	is(RATIO, 0.125);
	has_text("spec:quantity", NULL);
	ok(spec_image_set_text(&image[1], "spec:quantity", "transmittance", &error));
	ok(plan(SPEC_ARITHMETIC_MULTIPLY));
	has_text("spec:quantity", "ratio");
	clear();
	lights(1, 2, NAN);
	refused_as(plan(SPEC_ARITHMETIC_MULTIPLY), "a.exr and b.exr are both light");
}

static void
test_quotients(void **state)
{
	(void)state;
	lights(1, 4, NAN);
	ok(plan(SPEC_ARITHMETIC_DIVIDE));
	is(RATIO, 0.25);
	has_text("spec:quantity", "ratio");
	has_text("emissiveUnits", NULL);
	set_sample(&image[1], BAND, 0);
	is(RATIO, INFINITY);
	set_sample(&image[0], BAND, 0);
	is(RATIO, NAN);
	clear();
	set_sample(light(), BAND, 1);
	set_sample(reflectance(), RATIO, 0.5);
	ok(plan(SPEC_ARITHMETIC_DIVIDE));
	is(BAND, 2);
	clear();
	set_sample(reflectance(), RATIO, 1);
	set_sample(reflectance(), RATIO, 8);
	ok(plan(SPEC_ARITHMETIC_DIVIDE));
	is(RATIO, 0.125);
	has_text("spec:quantity", "ratio");
	clear();
	reflectance();
	light();
	refused_as(plan(SPEC_ARITHMETIC_DIVIDE), "a.exr is reflectance, b.exr light");
	lights(1, 2, NAN);
	ok(spec_image_set_text(&image[1], "spec:quantity", "radiance per band", &error));
	refused_as(plan(SPEC_ARITHMETIC_DIVIDE), "radiance per band");
	lights(1, 2, 3);
	refused_as(plan(SPEC_ARITHMETIC_DIVIDE), "divide takes 2 images at most, and 3");
}

static const char *const alpha[] = {"A", NULL};

static void
test_over(void **state)
{
	(void)state;
	for (int i = 0; i < 3; i++) {
		new_image(SPEC_ROLE_EMISSIVE, 1, 2, alpha);
		set_sample(&image[i], BAND, 0.125 * (i + 1));
		set_sample(&image[i], "A", 0.25 * (i + 1));
	}
	ok(plan(SPEC_ARITHMETIC_OVER));
	is(BAND, 0.125 + 0.75 * (0.25 + 0.5 * 0.375));
	is("A", 0.25 + 0.75 * (0.5 + 0.5 * 0.75));
	/* What is hidden plays no part; what is seen through nothing is there as it is. */
	set_sample(&image[0], "A", 1);
	set_sample(&image[1], BAND, NAN);
	set_sample(&image[2], BAND, INFINITY);
	is(BAND, 0.125);
	is("A", 1);
	set_sample(&image[0], BAND, 0);
	set_sample(&image[0], "A", 0);
	set_sample(&image[1], BAND, 0);
	set_sample(&image[1], "A", 0);
	is(BAND, INFINITY);
	is("A", 0.75);
	clear();
	/* An image without alpha, last, covers everything. */
	new_image(SPEC_ROLE_EMISSIVE, 1, 2, alpha);
	light();
	set_sample(&image[0], "A", 0.25);
	ok(plan(SPEC_ARITHMETIC_OVER));
	is("A", 1);
	is(BAND, 1 + 0.75 * 2);
	clear();
	light();
	new_image(SPEC_ROLE_EMISSIVE, 1, 2, alpha);
	refused_as(plan(SPEC_ARITHMETIC_OVER), "a.exr has no alpha (A), so b.exr");
}

/* Of a mean it is made as the bands are, where an image without it covers all; else copied. */
static void
test_alpha(void **state)
{
	(void)state;
	new_image(SPEC_ROLE_EMISSIVE, 1, 2, alpha);
	new_image(SPEC_ROLE_EMISSIVE, 1, 2, alpha);
	set_sample(&image[0], "A", 0.25);
	set_sample(&image[1], "A", 0.75);
	ok(spec_samples_set(&image[0], 1, "a.exr", &error));
	ok(spec_samples_set(&image[1], 3, "b.exr", &error));
	ok(plan(SPEC_ARITHMETIC_MEAN));
	is("A", 0.5);
	ok(plan(SPEC_ARITHMETIC_MERGE));
	is("A", 0.625);
	for (enum spec_arithmetic_operation operation = SPEC_ARITHMETIC_ADD;
		operation <= SPEC_ARITHMETIC_MAX; operation++) {
		if (operation == SPEC_ARITHMETIC_MULTIPLY)
			continue; /* of light by light there is none */
		ok(plan(operation));
		is("A", 0.25);
	}
	ok(plan_expression("a + b", SPEC_ROLE_OTHER));
	is("A", 0.25);
	clear();
	new_image(SPEC_ROLE_EMISSIVE, 1, 2, alpha);
	light();
	set_sample(&image[0], "A", 0.25);
	ok(plan(SPEC_ARITHMETIC_MEAN));
	is("A", 0.625);
	clear();
}

static enum spec_status
plan_lerp(const char *text)
{
	struct spec_matte mask;
	const struct spec_arithmetic_setup setup = {
		.operation = SPEC_ARITHMETIC_LERP, .mask = &mask, .kind = SPEC_ROLE_OTHER};
	enum spec_status status = spec_matte_read(&mask, text, &image[0], "a.exr", &error);

	if (status == SPEC_OK)
		status = plan_setup(&setup);
	spec_matte_free(&mask);
	return status;
}

static void
test_lerp(void **state)
{
	static const char *const channels[] = {"A", "id", "od\"d\\", "n=3", NULL};

	(void)state;
	new_image(SPEC_ROLE_EMISSIVE, 1, 2, channels);
	new_image(SPEC_ROLE_EMISSIVE, 1, 2, alpha);
	set_sample(&image[0], BAND, 8);
	set_sample(&image[1], BAND, 16);
	set_sample(&image[0], "A", 0.25);
	set_sample(&image[1], "A", 1);
	set_sample(&image[0], "id", 7);
	set_sample(&image[0], "od\"d\\", 0.5);
	set_sample(&image[0], "n=3", 0.75);
	ok(plan_lerp("A"));
	is(BAND, 10);
	is("A", 0.25 * 0.75 + 0.25);
	is("id", 7);
	ok(plan_lerp("id=7"));
	is(BAND, 16);
	is("A", 1);
	ok(plan_lerp("id=6"));
	is(BAND, 8);
	set_sample(&image[0], "id", 4294967295);
	ok(plan_lerp("id=4294967295"));
	is(BAND, 16);
	set_sample(&image[0], "id", 7);
	ok(plan_lerp("od\"d\\"));
	is(BAND, 12);
	ok(plan_lerp("n=3"));
	is(BAND, 14);
	assert_int_equal(plan_lerp("A=1"), SPEC_EUSAGE);
	assert_non_null(strstr(error.message, "holds no whole numbers"));
	assert_int_equal(plan_lerp("id=-1"), SPEC_ERANGE);
	assert_int_equal(plan_lerp("no-such"), SPEC_EUSAGE);
	assert_non_null(strstr(error.message, "neither a channel of a.exr nor a file"));
	clear();
}

static void
test_merge(void **state)
{
	static const double weight[] = {1, 3}, fine[] = {0.123456789, 0.987654321};
	struct spec_arithmetic_setup setup = {.operation = SPEC_ARITHMETIC_MERGE,
		.weight = weight,
		.kind = SPEC_ROLE_OTHER};

	(void)state;
	lights(1, 2, NAN);
	ok(spec_samples_set(&image[0], 48, "a.exr", &error));
	assert_int_equal(plan(SPEC_ARITHMETIC_MERGE), SPEC_EUSAGE);
	assert_non_null(strstr(error.message, "b.exr does not say its samples"));
	ok(plan_setup(&setup));
	is(BAND, 1.75);
	has_samples(0);
	ok(spec_samples_set(&image[1], 16, "b.exr", &error));
	ok(plan(SPEC_ARITHMETIC_MERGE));
	is(BAND, 1.25);
	has_samples(64);
	setup.operation = SPEC_ARITHMETIC_MEAN;
	ok(plan_setup(&setup));
	is(BAND, 1.75);
	has_samples(0);
	setup.weight = fine;
	ok(plan_setup(&setup));
	is(BAND, (fine[0] * 1 + fine[1] * 2) / (fine[0] + fine[1]));
	ok(spec_samples_set(&image[1], 2147483647, "b.exr", &error));
	refused_as(plan(SPEC_ARITHMETIC_MERGE), "more than spec:samples can say");
	lights(1, 2, NAN);
	ok(spec_image_set_text(&image[0], "spec:samples", "12", &error));
	refused_as(plan(SPEC_ARITHMETIC_MERGE), "a.exr: its spec:samples is no int");
}

static enum spec_status
plan_over(const char *channel)
{
	const struct spec_arithmetic_setup setup = {.operation = SPEC_ARITHMETIC_OVER,
		.alpha = channel,
		.kind = SPEC_ROLE_OTHER};

	return plan_setup(&setup);
}

/* Geometry is the mean over what was met; light layers are worked on as S0. */
static void
test_geometry(void **state)
{
	static const char *const channels[] = {"film1.N.X", "film1.N.Y", "film1.N.Z",
		"film1.P.X", "film1.P.Y", "film1.P.Z", "film1.cosine", "film1.cover",
		"film1.id", "film1.mirror.S0.400nm", "film1.mirror.S0.500nm",
		"through.S0.400nm", "through.S0.500nm", "film1.other", NULL};
	static const char *const lamp[] = {"lamp2.S0.400nm", "lamp2.S0.500nm",
		"lamp1.S0.400nm", "lamp1.S0.500nm", NULL};

	(void)state;
	for (int i = 0; i < 2; i++) {
		const struct spec_image *fresh =
			new_image(SPEC_ROLE_EMISSIVE, 1, 2, channels);

		set_sample(fresh, "film1.N.X", i == 0);
		set_sample(fresh, "film1.N.Y", 0);
		set_sample(fresh, "film1.N.Z", i == 1);
		set_sample(fresh, "film1.cover", i == 0 ? 0.5 : 0.25);
		set_sample(fresh, "film1.id", i == 0 ? 16777217 : 5);
		ok(spec_samples_set(&image[i], i == 0 ? 10 : 20, "it", &error));
	}
	ok(plan(SPEC_ARITHMETIC_MERGE));
	is(BAND, (10. * 1 + 20 * 2) / 30);
	is("film1.mirror.S0.500nm", (10. * 1 + 20 * 2) / 30);
	is("through.S0.500nm", (10. * 1 + 20 * 2) / 30);
	is("film1.cover", (10 * 0.5 + 20 * 0.25) / 30);
	/* 5 samples each met the film. */
	is("film1.P.Y", 1.5);
	is("film1.cosine", 1.5);
	is("film1.N.X", sqrt(0.5));
	is("film1.N.Y", 0);
	is("film1.N.Z", sqrt(0.5));
	is("film1.id", 16777217);
	is("film1.other", 1);
	set_sample(&image[1], "film1.cover", 0.75);
	is("film1.id", 5);
	is("film1.N.Z", 3 / sqrt(10));
	set_sample(&image[0], "film1.cover", 0);
	set_sample(&image[1], "film1.cover", 0);
	is("film1.P.Y", 0);
	is("film1.N.Z", 0);
	ok(plan(SPEC_ARITHMETIC_ADD));
	is("film1.mirror.S0.400nm", 3);
	is("film1.P.Y", 1);
	clear();
	new_image(SPEC_ROLE_EMISSIVE, 1, 2, channels);
	new_image(SPEC_ROLE_EMISSIVE, 1, 2, channels);
	ok(plan(SPEC_ARITHMETIC_MEAN));
	is("film1.mirror.S0.400nm", 1.5);
	is("film1.P.Y", (1 * 1 + 2 * 2) / 3.); /* by cover */
	assert_int_equal(plan_lerp("film1.cover"), SPEC_EUSAGE);
	assert_non_null(strstr(error.message, "which lerp cannot do"));
	assert_int_equal(plan_expression("a", SPEC_ROLE_OTHER), SPEC_EUSAGE);
	assert_non_null(strstr(error.message, "which expr cannot do"));
	assert_int_equal(plan(SPEC_ARITHMETIC_DIVIDE), SPEC_EUSAGE);
	assert_non_null(strstr(error.message, "which divide cannot do"));
	assert_int_equal(plan_over("film1.cover"), SPEC_EUSAGE);
	assert_non_null(strstr(error.message, "which over cannot do"));
	refused_as(
		plan(SPEC_ARITHMETIC_MAX), "a.exr has light layers, which max cannot do");
	light();
	new_image(SPEC_ROLE_EMISSIVE, 1, 2, channels);
	refused_as(plan(SPEC_ARITHMETIC_ADD), "light layers of 0 films and of 0 lamps");
	new_image(SPEC_ROLE_EMISSIVE, 1, 2, lamp);
	new_image(SPEC_ROLE_EMISSIVE, 1, 2, &lamp[2]);
	refused_as(plan(SPEC_ARITHMETIC_ADD), "and of 2 lamps, b.exr of 0 and of 1");
}

/* Directions have length 1 again, and what not all images have is the first's. */
static void
test_directions(void **state)
{
	static const char *const channels[] = {"Tan.X", "Tan.Y", "Tan.Z", "I.X", "I.Y",
		"I.Z", "Ns.X", "Ns.Y", "Ns.Z", "lamp1.D.X", "lamp1.D.Y", "lamp1.D.Z",
		"lamp1.S0.400nm", "lamp1.S0.500nm", "Q.X", "Q.Y", "Q.Z", "u", "v", NULL};
	static const char *const vectors[] = {"Tan", "I", "Ns", "lamp1.D"};
	char name[32];

	(void)state;
	new_image(SPEC_ROLE_EMISSIVE, 1, 2, channels);
	new_image(SPEC_ROLE_EMISSIVE, 1, 2, channels);
	for (size_t i = 0; i < COUNT(vectors); i++) {
		snprintf(name, sizeof name, "%s.Y", vectors[i]);
		set_sample(&image[0], name, -3);
	}
	ok(plan(SPEC_ARITHMETIC_MEAN));
	for (size_t i = 0; i < COUNT(vectors); i++) {
		/* 1, -3, 1 and 2, 2, 2 */
		snprintf(name, sizeof name, "%s.X", vectors[i]);
		is(name, 3 / sqrt(19));
		snprintf(name, sizeof name, "%s.Y", vectors[i]);
		is(name, -1 / sqrt(19));
	}
	is("Q.Z", 1.5);
	is("u", 1.5);
	is("v", 1.5);
	is("lamp1.S0.500nm", 1.5);
	clear();
	new_image(SPEC_ROLE_EMISSIVE, 1, 2, &channels[17]);
	new_image(SPEC_ROLE_EMISSIVE, 1, 2, &channels[18]);
	ok(plan(SPEC_ARITHMETIC_MEAN));
	is("u", 1);
	is("v", 1.5);
	clear();
}

static void
test_expressions(void **state)
{
	static const char *const height[] = {"Z", "B", "G", "R", NULL};

	(void)state;
	lights(1, 4, NAN);
	new_image(SPEC_ROLE_OTHER, 0, 0, height);
	ok(plan_expression("a / b * c.Z", SPEC_ROLE_REFLECTIVE));
	is(RATIO, 0.75);
	has_text("spec:quantity", "ratio");
	ok(plan_expression("a(400) + b", SPEC_ROLE_OTHER));
	is(BAND, 5);
	assert_int_equal(plan_expression("a + c", SPEC_ROLE_OTHER), SPEC_EUSAGE);
	assert_non_null(strstr(error.message, "c.exr has no such band"));
	clear();
	reflectance();
	ok(plan_expression("a * planck(3000)", SPEC_ROLE_EMISSIVE));
	has_text("spec:quantity", "radiance per nm");
	assert_true(value_of(BAND) > 0);
	clear();
	/* Light in place of reflectance is as the first light is. */
	reflectance();
	new_image(SPEC_ROLE_EMISSIVE, 4, 2, NULL);
	new_image(SPEC_ROLE_EMISSIVE, 4, 2, NULL);
	ok(spec_image_set_text(&image[1], "spec:quantity", "irradiance", &error));
	ok(plan_expression("a * b + c", SPEC_ROLE_EMISSIVE));
	has_text("spec:quantity", "irradiance");
	is("S3.500,000000nm", 5);
	clear();
	set_sample(light(), BAND, 3);
	ok(plan_expression("a(450)", SPEC_ROLE_OTHER));
	is(BAND, 2);
	ok(spec_image_set_text(&image[0], "spec:quantity", "radiance per band", &error));
	assert_int_equal(plan_expression("a(399.9985)", SPEC_ROLE_OTHER), SPEC_ERANGE);
	ok(plan_expression("a(400.001)", SPEC_ROLE_OTHER));
	is(BAND, 1);
	refused_as(plan_expression("a(450)", SPEC_ROLE_OTHER),
		"no band at 450 nm, and its values per band are not interpolated");
	new_image(SPEC_ROLE_OTHER, 0, 0, height);
	light();
	refused_as(plan_expression("b", SPEC_ROLE_OTHER), "a.exr: has no spectral channel");
	new_image(SPEC_ROLE_EMISSIVE, 1, 2, height);
	ok(plan_expression("2 * a", SPEC_ROLE_OTHER)); /* the preview is dropped */
	assert_int_equal(arithmetic.image.channels, 3);
	is("Z", 1);
	clear();
}

static void
test_stokes(void **state)
{
	(void)state;
	new_image(SPEC_ROLE_EMISSIVE, 4, 2, NULL);
	new_image(SPEC_ROLE_EMISSIVE, 4, 2, NULL);
	set_sample(&image[0], "S2.400,000000nm", -0.5);
	ok(plan(SPEC_ARITHMETIC_ADD));
	is("S2.400,000000nm", 1.5);
	is("S0.400,000000nm", 3);
	ok(plan_expression("a(500) * stokes", SPEC_ROLE_OTHER));
	is("S3.400,000000nm", 3);
	is("S0.400,000000nm", 0);
	ok(plan_expression("a", SPEC_ROLE_REFLECTIVE)); /* of S0 */
	is("T.400,000000nm", 1);
	assert_int_equal(plan(SPEC_ARITHMETIC_DIVIDE), SPEC_EUNSUPPORTED);
	refused_as(plan(SPEC_ARITHMETIC_MIN), "of which there is no min");
	new_image(SPEC_ROLE_EMISSIVE, 4, 2, NULL);
	reflectance();
	set_sample(&image[0], "S2.400,000000nm", -0.5);
	set_sample(&image[1], "T.400,000000nm", 0.5);
	ok(plan(SPEC_ARITHMETIC_MULTIPLY));
	is("S2.400,000000nm", -0.25);
	clear();
	light();
	new_image(SPEC_ROLE_EMISSIVE, 4, 2, NULL);
	refused_as(plan(SPEC_ARITHMETIC_ADD), "a.exr has 1 Stokes component, b.exr 4");
	light();
	new_image(SPEC_ROLE_EMISSIVE, 4, 2, NULL);
	refused_as(
		plan_expression("a + b", SPEC_ROLE_OTHER), "1 Stokes component, b.exr 4");
}

static void
test_bispectral(void **state)
{
	static const char *const off[] = {"T.400,000000nm.500,000000nm", NULL};
	static const char *const other[] = {"T.500,000000nm.400,000000nm", NULL};
	static const char *const farther[] = {"T.400,000000nm.600,000000nm", NULL};

	(void)state;
	new_image(SPEC_ROLE_REFLECTIVE, 1, 2, off);
	new_image(SPEC_ROLE_REFLECTIVE, 1, 2, off);
	ok(plan(SPEC_ARITHMETIC_MEAN));
	is(off[0], 1.5);
	is(RATIO, 1.5);
	assert_int_equal(plan(SPEC_ARITHMETIC_MULTIPLY), SPEC_EUNSUPPORTED);
	refused_as(plan(SPEC_ARITHMETIC_MAX), "is bispectral, which max cannot do");
	new_image(SPEC_ROLE_REFLECTIVE, 1, 2, off);
	new_image(SPEC_ROLE_REFLECTIVE, 1, 2, other);
	refused_as(plan(SPEC_ARITHMETIC_MEAN), "b.exr has no channel 'T.400");
	new_image(SPEC_ROLE_REFLECTIVE, 1, 3, off);
	new_image(SPEC_ROLE_REFLECTIVE, 1, 3, farther);
	refused_as(plan(SPEC_ARITHMETIC_MEAN), "b.exr has no channel 'T.400");
	new_image(SPEC_ROLE_REFLECTIVE, 1, 2, off);
	reflectance();
	refused_as(plan(SPEC_ARITHMETIC_MEAN), "a.exr has 1 bispectral channels, b.exr 0");
}

static void
bins(struct spec_image *of, double first)
{
	const double edges[] = {first, 450, 550};

	ok(spec_image_set_bins(of, edges, 2, &error));
	ok(spec_image_index(of, "an image", &error));
}

static void
test_mismatches(void **state)
{
	struct spec_image *odd;

	(void)state;
	light();
	new_image(SPEC_ROLE_EMISSIVE, 1, 3, NULL);
	refused_as(plan(SPEC_ARITHMETIC_ADD),
		"a.exr has 2 bands 400..500 nm, b.exr 3 bands 400..600 nm");
	light();
	reflectance();
	refused_as(plan(SPEC_ARITHMETIC_ADD),
		"a.exr is light ('radiance per nm'), b.exr reflectance ('reflectance')");
	light();
	light()->data.x1 = 2;
	refused_as(plan(SPEC_ARITHMETIC_ADD),
		"a.exr has the data window 0,0,1,1, b.exr 0,0,2,1");
	light();
	light()->display.x0 = -1;
	refused_as(plan(SPEC_ARITHMETIC_ADD), "display window 0,0,1,1, b.exr -1,0,1,1");
	bins(light(), 350);
	light();
	refused_as(plan(SPEC_ARITHMETIC_ADD), "a.exr has bins, b.exr point samples");
	bins(light(), 350);
	bins(light(), 360);
	refused_as(plan(SPEC_ARITHMETIC_ADD), "a bin's edge at 350 nm, b.exr at 360 nm");
	bins(light(), 350);
	bins(reflectance(), 360);
	refused_as(
		plan(SPEC_ARITHMETIC_MULTIPLY), "a bin's edge at 350 nm, b.exr at 360 nm");
	/* In expressions bins are the user's affair where there are none on one side. */
	bins(light(), 350);
	light();
	ok(plan_expression("a + b", SPEC_ROLE_OTHER));
	has_text("spec:bins", "350 450 550");
	clear();
	bins(light(), 350);
	bins(light(), 360);
	refused_as(plan_expression("a + b", SPEC_ROLE_OTHER), "a bin's edge at 350 nm");
	/* Reflectance at points multiplies light in bins, either way round. */
	reflectance();
	bins(light(), 350);
	ok(plan(SPEC_ARITHMETIC_MULTIPLY));
	has_text("spec:bins", "350 450 550");
	clear();
	/* What is of one kind is in bins or at points, whichever comes first. */
	reflectance();
	bins(reflectance(), 350);
	refused_as(plan(SPEC_ARITHMETIC_MULTIPLY), "a.exr has point samples, b.exr bins");
	bins(light(), 350);
	reflectance();
	bins(reflectance(), 350);
	refused_as(plan(SPEC_ARITHMETIC_MULTIPLY), "b.exr has point samples, c.exr bins");
	reflectance();
	bins(light(), 350);
	bins(reflectance(), 350);
	refused_as(plan(SPEC_ARITHMETIC_MULTIPLY), "a.exr has point samples, c.exr bins");
	light();
	bins(light(), 350);
	refused_as(plan(SPEC_ARITHMETIC_DIVIDE), "a.exr has point samples, b.exr bins");
	reflectance();
	bins(reflectance(), 350);
	refused_as(plan(SPEC_ARITHMETIC_DIVIDE), "a.exr has point samples, b.exr bins");
	light();
	refused_as(plan(SPEC_ARITHMETIC_ADD), "add needs 2 images at least, and 1 is");
	odd = new_image(SPEC_ROLE_EMISSIVE, 1, 3, NULL);
	new_image(SPEC_ROLE_EMISSIVE, 1, 3, NULL);
	free(odd->channel[1].name);
	odd->channel[1].name = strdup("S0.500,5nm");
	odd->channel[1].wavelength_nm = 500.5;
	ok(spec_image_index(odd, "a.exr", &error));
	refused_as(plan(SPEC_ARITHMETIC_ADD),
		"3 bands 400..600 nm with one at 500.5 nm, b.exr 3 bands 400..600 nm with one at 500 nm");
}

static void
test_history(void **state)
{
	(void)state;
	lights(1, 2, 3);
	ok(spec_image_set_text(&image[0], "spec:history", "one\n", &error));
	ok(spec_image_set_text(&image[1], "spec:history", "one\n", &error));
	ok(spec_image_set_text(&image[2], "spec:history", "two\nthree", &error));
	ok(plan(SPEC_ARITHMETIC_ADD));
	has_text("spec:history", "one\ntwo\nthree\n");
	clear();
}

static void
test_names(void **state)
{
	enum spec_arithmetic_operation operation;

	(void)state;
	ok(spec_arithmetic_find("lerp", &operation, &error));
	assert_int_equal(operation, SPEC_ARITHMETIC_LERP);
	assert_int_equal(spec_arithmetic_find("merge", &operation, &error), SPEC_EUSAGE);
	assert_int_equal(spec_arithmetic_find("", &operation, &error), SPEC_EUSAGE);
}

static int
forget(void **state)
{
	(void)state;
	clear();
	return 0;
}

#define TEST(function) cmocka_unit_test_teardown(function, forget)

int
main(void)
{
	const struct CMUnitTest tests[] = {
		TEST(test_values),
		TEST(test_products),
		TEST(test_quotients),
		TEST(test_over),
		TEST(test_alpha),
		TEST(test_lerp),
		TEST(test_merge),
		TEST(test_geometry),
		TEST(test_directions),
		TEST(test_expressions),
		TEST(test_stokes),
		TEST(test_bispectral),
		TEST(test_mismatches),
		TEST(test_history),
		TEST(test_names),
	};

	return cmocka_run_group_tests(tests, NULL, NULL);
}
