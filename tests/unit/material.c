/* How surfaces scatter: what is chosen, how often, and what it weighs. */
#include <stdio.h>
#include <stdlib.h>

#include "optics/fresnel.h"
#include "render/material.h"
#include "scene/scene.h"

#include "check.h"

#define PI 3.14159265358979323846
#define MOST_BANDS 32

/*
 * A mean of estimates lies within 4 of its own standard errors of the truth but for one in
 * 16000; the seeds are fixed, so that a test that passed once passes always.
 */
#define SIGMAS 4

struct fixture {
	struct spec_scene scene;
	struct spec_grid grid;
	struct spec_bands_grid bands;
	struct spec_material *material;
	struct spec_hit hit;
	struct spec_surface surface;
	double room[2 * MOST_BANDS];
};

static struct spec_scene_spectrum
constant(double value)
{
	return (struct spec_scene_spectrum){.kind = SPEC_SCENE_CONSTANT, .value = value};
}

/* Five bands; the surface lies in the plane z = 0, its outside above. */
static int
set_up(void **state)
{
	struct fixture *f = calloc(1, sizeof *f);
	struct spec_error error;

	assert_non_null(f);
	check(spec_grid_parse("450:650:50", &f->grid, &error), &error);
	check(spec_bands_make(&f->bands, &f->grid, SPEC_EXTRAPOLATE_REFUSE, &error),
		&error);
	f->scene.material = calloc(1, sizeof *f->scene.material);
	f->scene.materials = 1;
	f->scene.material->reflectance = constant(0.5);
	f->scene.material->eta = constant(1.5);
	f->scene.material->k = constant(0);
	f->hit.normal = f->hit.shading = (struct spec_vector){0, 0, 1};
	f->hit.tangent = (struct spec_vector){1, 0, 0};
	*state = f;
	return 0;
}

static void
free_material(struct fixture *f)
{
	spec_materials_free(f->material, 1);
	f->material = NULL;
}

static int
tear_down(void **state)
{
	struct fixture *f = *state;

	free_material(f);
	spec_scene_free(&f->scene);
	spec_bands_free(&f->bands);
	spec_grid_free(&f->grid);
	free(f);
	return 0;
}

/* The material as the scene has it now. */
static void
make(struct fixture *f, enum spec_scene_material_kind kind)
{
	struct spec_error error;

	free_material(f);
	f->scene.material->kind = kind;
	check(spec_materials_make(&f->material, &f->scene, &f->bands, &error), &error);
}

static void
make_metal(struct fixture *f, double n, double k, double alpha_x, double alpha_y)
{
	f->scene.material->eta = constant(n);
	f->scene.material->k = constant(k);
	f->scene.material->roughness[0] = alpha_x;
	f->scene.material->roughness[1] = alpha_y;
	make(f, SPEC_SCENE_CONDUCTOR);
}

static void
make_disc(struct fixture *f, const char *preset)
{
	free(f->scene.material->preset);
	f->scene.material->preset = strdup(preset);
	make(f, SPEC_SCENE_DIFFRACTIVE);
}

static struct spec_vector
at_angle(double angle_deg, double azimuth_deg)
{
	double angle = angle_deg * PI / 180, azimuth = azimuth_deg * PI / 180;

	return (struct spec_vector){
		sin(angle) * cos(azimuth), sin(angle) * sin(azimuth), cos(angle)};
}

static void
look(struct fixture *f, struct spec_vector eye)
{
	f->surface = (struct spec_surface){.material = f->material,
		.hit = &f->hit,
		.eye = eye,
		.cosine = spec_vector_dot(eye, f->hit.shading),
		.room = f->room};
}

static const float whole[MOST_BANDS] = {1, 1, 1, 1, 1, 1, 1, 1, 1, 1, 1, 1, 1, 1, 1, 1, 1,
	1, 1, 1, 1, 1, 1, 1, 1, 1, 1, 1, 1, 1, 1, 1};

static void
multiply_out(const struct fixture *f, const struct spec_bands_scaled *from, float *value)
{
	for (size_t i = 0; i < f->bands.count; i++)
		value[i] = (float)(from->value[i] * from->scale);
}

/* f cos in each band, where the density is above 0. */
static double
evaluate(const struct fixture *f, struct spec_vector light, float *value)
{
	float room[MOST_BANDS];
	struct spec_bands_scaled scattered = {.room = room};
	double density = spec_material_evaluate(&f->surface, light, &scattered);

	if (density > 0)
		multiply_out(f, &scattered, value);
	return density;
}

/* One choice; its density, the direction, and the weights. */
static double
choose(const struct fixture *f, const float *throughput, uint64_t seed, uint32_t sample,
	struct spec_vector *direction, float *weight)
{
	struct spec_sampler sampler;
	float room[MOST_BANDS] = {0};
	struct spec_bands_scaled scaled = {.room = room};
	double density;

	spec_sampler_start(&sampler, seed, (int)(sample % 101), 0, sample);
	density =
		spec_material_sample(&f->surface, throughput, &sampler, direction, &scaled);
	multiply_out(f, &scaled, weight);
	return density;
}

/* --- rough materials: integrals over the hemisphere, by quadrature and by samples --- */

/* What is compared: 1, x, y, z, xx, yy, xy of the direction, and the first band's weight. */
#define MOMENTS 8
#define CELLS 48 /* 6 of the polar angle's cosine times 8 of the azimuth */

struct integrals {
	double moment[MOMENTS];
	double cell[CELLS];
};

static void
add_direction(struct integrals *sums, struct spec_vector d, double density, double weighted)
{
	const double v[MOMENTS] = {1, d.x, d.y, d.z, d.x * d.x, d.y * d.y, d.x * d.y, 0};
	double turn = (atan2(d.y, d.x) + PI) / (2 * PI);
	size_t cell = (size_t)fmin(d.z * 6, 5) * 8 + (size_t)fmin(turn * 8, 7);

	for (size_t i = 0; i < MOMENTS - 1; i++)
		sums->moment[i] += density * v[i];
	sums->moment[MOMENTS - 1] += weighted;
	sums->cell[cell] += density;
}

/*
 * The midpoint rule around the mirror direction, where lobes are: the angle from it is pi t^3.
 * The horizon cuts through what it adds up, and so do the cells: of sums over the hemisphere
 * it is within 5e-4, as four times as many steps tell.
 */
#define STEPS 300
#define QUADRATURE 1e-3

static void
integrate(const struct fixture *f, struct integrals *sums)
{
	struct spec_frame frame =
		spec_frame_about(spec_vector_mirror(f->surface.eye, f->hit.shading));

	*sums = (struct integrals){0};
	for (int i = 0; i < STEPS; i++) {
		double t = (i + 0.5) / STEPS, angle = PI * t * t * t;
		double size = 3 * PI * t * t / STEPS * sin(angle) * 2 * PI / STEPS;

		for (int j = 0; j < STEPS; j++) {
			double azimuth = 2 * PI * (j + 0.5) / STEPS, density;
			struct spec_vector d = spec_frame_to_world(
				&frame, (struct spec_vector){sin(angle) * cos(azimuth),
						sin(angle) * sin(azimuth), cos(angle)});
			float value[MOST_BANDS];

			density = evaluate(f, d, value);
			if (density > 0)
				add_direction(
					sums, d, density * size, (double)value[0] * size);
		}
	}
}

#define SAMPLES 40000

/* Of the samples; absorbed ones add nothing. Also: weight is f cos over density. */
static void
sample_all(const struct fixture *f, struct integrals *sums, struct integrals *squares,
	const char *what)
{
	*sums = *squares = (struct integrals){0};
	for (uint32_t i = 0; i < SAMPLES; i++) {
		struct spec_vector d;
		float weight[MOST_BANDS], value[MOST_BANDS];
		struct integrals one = {0};
		double density = choose(f, whole, 1, i, &d, weight), again;

		if (density < 0)
			continue;
		near(spec_vector_length(d), 1, 1e-12, what);
		again = evaluate(f, d, value);
		/* The direction is rounded on its way out of the frame and back. */
		if (d.z > 1e-6) {
			near(again / density, 1, 1e-6, "density of a sample");
			for (size_t j = 0; j < f->bands.count; j++)
				near(weight[j] * density, value[j], 1e-5 * value[j] + 1e-30,
					"f cos of a sample");
		}
		add_direction(&one, d, 1, weight[0]);
		for (size_t j = 0; j < MOMENTS; j++) {
			sums->moment[j] += one.moment[j] / SAMPLES;
			squares->moment[j] += one.moment[j] * one.moment[j] / SAMPLES;
		}
		for (size_t j = 0; j < CELLS; j++)
			sums->cell[j] += one.cell[j];
	}
}

/*
 * Density and samples agree: in moments, and in how many fall into cells. Samples are taken
 * from many pixels, so that they are nearly independent; what strata they share lowers the
 * deviation alone.
 */
static void
expect_agreement(const struct fixture *f, const char *what)
{
	static const char *const names[MOMENTS] = {
		"1", "x", "y", "z", "xx", "yy", "xy", "weight"};
	struct integrals wanted, got, squares;
	char name[128];

	integrate(f, &wanted);
	sample_all(f, &got, &squares, what);
	if (wanted.moment[0] > 1 + QUADRATURE)
		fail_msg("%s: the density integrates to %g", what, wanted.moment[0]);
	for (size_t i = 0; i < MOMENTS; i++) {
		double variance = squares.moment[i] - got.moment[i] * got.moment[i];
		double sigma = sqrt(fmax(variance, 0) / SAMPLES);

		snprintf(name, sizeof name, "%s: mean of %s", what, names[i]);
		near(got.moment[i], wanted.moment[i],
			SIGMAS * sigma + QUADRATURE * fmax(1, wanted.moment[i]), name);
	}
	for (size_t i = 0; i < CELLS; i++) {
		double expected = wanted.cell[i] * SAMPLES;

		/* 5 standard errors: of 48 cells in 40 cases one false alarm in 900. */
		snprintf(name, sizeof name, "%s: samples in cell %zu", what, i);
		near(got.cell[i], expected, 5 * sqrt(expected + 1) + QUADRATURE * SAMPLES,
			name);
	}
}

static void
test_diffuse(void **state)
{
	struct fixture *f = *state;

	make(f, SPEC_SCENE_DIFFUSE);
	look(f, at_angle(40, 30));
	expect_agreement(f, "diffuse");
	look(f, at_angle(89.9, 30));
	expect_agreement(f, "diffuse, grazing");
}

static void
test_rough_metal(void **state)
{
	static const double alpha[][2] = {
		{1, 1}, {0.3, 0.3}, {0.05, 0.05}, {0.6, 0.1}, {0.05, 0.4}};
	static const double angle[] = {0, 45, 80, 89};
	struct fixture *f = *state;
	char what[80];

	for (size_t i = 0; i < COUNT(alpha); i++) {
		make_metal(f, 0.2, 3.5, alpha[i][0], alpha[i][1]);
		for (size_t j = 0; j < COUNT(angle); j++) {
			look(f, at_angle(angle[j], 25));
			snprintf(what, sizeof what, "metal of alpha %g, %g at %g degrees",
				alpha[i][0], alpha[i][1], angle[j]);
			expect_agreement(f, what);
		}
	}
}

static void
test_disc(void **state)
{
	static const char *const preset[] = {"cd", "dvd", "bluray", "vinyl"};
	static const double angle[] = {0, 45, 80};
	struct fixture *f = *state;
	char what[80];

	for (size_t i = 0; i < COUNT(preset); i++) {
		make_disc(f, preset[i]);
		for (size_t j = 0; j < COUNT(angle); j++) {
			look(f, at_angle(angle[j], 25));
			snprintf(
				what, sizeof what, "%s at %g degrees", preset[i], angle[j]);
			expect_agreement(f, what);
		}
	}
}

/* A disc has one face; specdisc(1) leaves the other dark, too. */
static void
test_disc_from_behind(void **state)
{
	struct fixture *f = *state;
	struct spec_vector d;
	float value[MOST_BANDS];

	make_disc(f, "cd");
	f->hit.normal.z = f->hit.shading.z = -1;
	look(f, at_angle(30, 0));
	assert_true(evaluate(f, at_angle(20, 90), value) == 0);
	for (uint32_t i = 0; i < 100; i++)
		assert_true(choose(f, whole, 1, i, &d, value) < 0);
}

/* Metal from within: the frame turns with the eye's side. */
static void
test_other_side(void **state)
{
	struct fixture *f = *state;
	struct spec_vector d, other;
	float weight[MOST_BANDS], same[MOST_BANDS];

	make_metal(f, 0.2, 3.5, 0.3, 0.1);
	for (uint32_t i = 0; i < 1000; i++) {
		double density;

		look(f, at_angle(50, 70));
		density = choose(f, whole, 3, i, &d, weight);
		f->hit.normal.z = f->hit.shading.z = -1;
		look(f, at_angle(50, 70));
		near(choose(f, whole, 3, i, &other, same), density, 1e-9 * fabs(density),
			"density on the other side");
		f->hit.normal.z = f->hit.shading.z = 1;
		if (density > 0) {
			assert_true(d.z > 0);
			assert_true(
				spec_vector_length(spec_vector_subtract(d, other)) < 1e-12);
			assert_memory_equal(weight, same, f->bands.count * sizeof *weight);
		}
	}
}

/* --- reciprocity and energy --- */

static void
expect_reciprocity(struct fixture *f, double bound, const char *what)
{
	for (int i = 0; i < 2000; i++) {
		struct spec_vector a = at_angle(fmod(i * 7.3, 89), i * 37.),
				   b = at_angle(fmod(i * 3.7 + 11, 89), i * 11.);
		float there[MOST_BANDS], back[MOST_BANDS];

		look(f, a);
		assert_true(evaluate(f, b, there) > 0);
		look(f, b);
		assert_true(evaluate(f, a, back) > 0);
		for (size_t j = 0; j < f->bands.count; j++)
			near(there[j] / b.z, back[j] / a.z, bound * fabs(back[j] / a.z),
				what);
	}
}

static void
test_reciprocity(void **state)
{
	struct fixture *f = *state;

	make(f, SPEC_SCENE_DIFFUSE);
	expect_reciprocity(f, 1e-6, "diffuse");
	make_metal(f, 0.2, 3.5, 0.3, 0.3);
	expect_reciprocity(f, 1e-6, "metal");
	make_metal(f, 0.2, 3.5, 0.6, 0.1);
	expect_reciprocity(f, 1e-6, "brushed metal");
	make_disc(f, "cd");
	expect_reciprocity(f, 1e-5, "cd");
	make_disc(f, "vinyl");
	expect_reciprocity(f, 1e-5, "vinyl");
}

/* A metal that reflects all sends back no more than it gets; smooth ones lose little. */
static void
test_energy(void **state)
{
	static const double alpha[] = {0.05, 0.3, 1};
	/* The white furnace of single scattering: 1 but for what shadowing takes. */
	static const double least[] = {0.9, 0.8, 0.3};
	struct fixture *f = *state;
	struct integrals sums;

	for (size_t i = 0; i < COUNT(alpha); i++) {
		make_metal(f, 0, 3, alpha[i], alpha[i]);
		for (double angle = 0; angle < 89; angle += 22) {
			look(f, at_angle(angle, 0));
			integrate(f, &sums);
			assert_true(sums.moment[MOMENTS - 1] <= 1 + QUADRATURE);
			assert_true(sums.moment[MOMENTS - 1] >= least[i]);
		}
	}
	/* Alpha 1 from above: D = 1/pi, G = 2c/(1+c), and 2 pi times the integral of D G/4. */
	look(f, at_angle(0, 0));
	integrate(f, &sums);
	near(sums.moment[MOMENTS - 1], 1 - log(2), 1e-4, "white furnace of alpha 1");
}

/* Light does not get through a surface past a bent shading normal. */
static void
test_bent_normal(void **state)
{
	struct fixture *f = *state;
	static const enum spec_scene_material_kind kinds[] = {
		SPEC_SCENE_DIFFUSE, SPEC_SCENE_CONDUCTOR, SPEC_SCENE_DIFFRACTIVE};

	f->scene.material->roughness[0] = f->scene.material->roughness[1] = 0.5;
	f->scene.material->preset = strdup("cd");
	f->hit.shading = at_angle(30, 0);
	for (size_t k = 0; k < COUNT(kinds); k++) {
		make(f, kinds[k]);
		look(f, at_angle(70, 0));
		for (uint32_t i = 0; i < 2000; i++) {
			struct spec_vector d;
			float value[MOST_BANDS];

			if (choose(f, whole, 2, i, &d, value) >= 0)
				assert_true(d.z > 0);
			d = at_angle(90.5 + i % 30, i);
			assert_true(evaluate(f, d, value) == 0);
		}
	}
}

/* --- mirrors --- */

static void
test_smooth_metal(void **state)
{
	struct fixture *f = *state;

	make_metal(f, 0.3, 2.5, 0, 0);
	assert_false(spec_material_is_rough(f->material));
	for (double angle = 0; angle < 90; angle += 9.9) {
		struct spec_fresnel wanted =
			spec_fresnel_conductor(cos(angle * PI / 180), 1, 0.3, 2.5);
		struct spec_vector d, mirror = at_angle(angle, 200);
		float weight[MOST_BANDS];

		look(f, at_angle(angle, 20));
		assert_true(choose(f, whole, 1, 0, &d, weight) == 0);
		near(spec_vector_length(spec_vector_subtract(d, mirror)), 0, 1e-12,
			"mirror direction");
		for (size_t i = 0; i < f->bands.count; i++)
			near(weight[i], (wanted.s + wanted.p) / 2, 1e-7, "weight");
	}
}

/* Rough in one direction alone is not smooth (pbrt: what "uroughness" alone describes). */
static void
test_half_smooth_metal(void **state)
{
	struct fixture *f = *state;
	double most = 0;

	make_metal(f, 0.3, 2.5, 0.3, 0);
	assert_true(spec_material_is_rough(f->material));
	look(f, at_angle(0, 0));
	for (uint32_t i = 0; i < 1000; i++) {
		struct spec_vector d;
		float weight[MOST_BANDS];

		if (choose(f, whole, 1, i, &d, weight) < 0)
			continue;
		most = fmax(most, fabs(d.x));
		assert_true(fabs(d.y) < 0.1); /* a streak along x */
	}
	assert_true(most > 0.5);
}

/* --- dielectrics --- */

/* Fresnel's chance, Snell's direction, and the change of radiance with the solid angle. */
static void
expect_dielectric(struct fixture *f, double angle, int inside)
{
	enum { TRIES = 4096 };
	double n1 = inside ? 1.5 : 1, n2 = inside ? 1 : 1.5;
	struct spec_vector eye = at_angle(angle, 20), mirror = at_angle(angle, 200);
	double sine = n1 / n2 * sin(angle * PI / 180);
	struct spec_fresnel fresnel =
		spec_fresnel_dielectric(cos(angle * PI / 180), n1, n2);
	double share = (fresnel.s + fresnel.p) / 2;
	unsigned mirrored = 0;

	f->hit.normal.z = f->hit.shading.z = inside ? -1 : 1;
	look(f, eye);
	for (uint32_t i = 0; i < TRIES; i++) {
		struct spec_vector d, through;
		float weight[MOST_BANDS];
		double wanted = 1;

		assert_true(choose(f, whole, 1, i, &d, weight) == 0);
		if (d.z > 0) {
			mirrored++;
			near(spec_vector_length(spec_vector_subtract(d, mirror)), 0, 1e-12,
				"mirror direction");
		} else {
			assert_true(sine < 1);
			through = at_angle(180 - asin(sine) * 180 / PI, 200);
			near(spec_vector_length(spec_vector_subtract(d, through)), 0, 1e-7,
				"Snell's direction");
			wanted = n1 * n1 / (n2 * n2);
		}
		for (size_t j = 0; j < f->bands.count; j++)
			near(weight[j], wanted, 1e-6, "weight");
	}
	near(mirrored / (double)TRIES, share,
		SIGMAS * sqrt(share * (1 - share) / TRIES) + 1e-12, "share mirrored");
}

static void
test_dielectric(void **state)
{
	struct fixture *f = *state;

	make(f, SPEC_SCENE_DIELECTRIC);
	assert_false(spec_material_is_rough(f->material));
	for (double angle = 0; angle < 90; angle += 12.3) {
		expect_dielectric(f, angle, 0);
		expect_dielectric(f, angle, 1); /* from 41.8 degrees on all is mirrored */
	}
	expect_dielectric(f, 41.8, 1);
	expect_dielectric(f, 41.82, 1);
	expect_dielectric(f, 89.99, 0);
}

/* An index that falls: 1.60 at 400 nm to 1.50 at 700 nm. */
static void
make_prism(struct fixture *f)
{
	struct spec_scene_spectrum *eta = &f->scene.material->eta;
	struct spec_error error;

	*eta = (struct spec_scene_spectrum){.kind = SPEC_SCENE_CURVE};
	check(spec_curve_new(2, 1, &eta->curve, &error), &error);
	eta->curve.wavelength_nm[0] = 400;
	eta->curve.wavelength_nm[1] = 700;
	eta->curve.value[0] = 1.6;
	eta->curve.value[1] = 1.5;
	make(f, SPEC_SCENE_DIELECTRIC);
	assert_true(f->material->dispersive);
}

/*
 * One band goes on alone. In the mean each band has its own answer: the mean of its weight
 * is R + T (n1/n2)^2, that of weight times direction R mirror + T (n1/n2)^2 refracted.
 */
static void
expect_dispersion(struct fixture *f, double angle, int inside, const float *throughput)
{
	enum { TRIES = 40000 };
	double weight_sum[MOST_BANDS] = {0}, weight_squares[MOST_BANDS] = {0};
	double x_sum[MOST_BANDS] = {0}, x_squares[MOST_BANDS] = {0};

	f->hit.normal.z = f->hit.shading.z = inside ? -1 : 1;
	look(f, at_angle(angle, 0));
	for (uint32_t i = 0; i < TRIES; i++) {
		struct spec_vector d;
		float weight[MOST_BANDS];
		int alone = 0;

		assert_true(choose(f, throughput, 5, i, &d, weight) == 0);
		for (size_t j = 0; j < f->bands.count; j++) {
			alone += weight[j] != 0;
			weight_sum[j] += weight[j];
			weight_squares[j] += (double)weight[j] * weight[j];
			x_sum[j] += weight[j] * d.x;
			x_squares[j] += weight[j] * d.x * (weight[j] * d.x);
		}
		assert_int_equal(alone, 1);
	}
	for (size_t j = 0; j < f->bands.count; j++) {
		double n = 1.6 - (f->bands.wavelength_nm[j] - 400) / 3000;
		double n1 = inside ? n : 1, n2 = inside ? 1 : n;
		double sine = n1 / n2 * sin(angle * PI / 180), factor = n1 * n1 / n2 / n2;
		struct spec_fresnel fresnel =
			spec_fresnel_dielectric(cos(angle * PI / 180), n1, n2);
		double r = (fresnel.s + fresnel.p) / 2, x, mean = weight_sum[j] / TRIES;
		double square = weight_squares[j] / TRIES - mean * mean;

		if (!(throughput[j] > 0)) {
			near(mean, 0, 0, "weight of a band that carries nothing");
			continue;
		}
		near(mean, r + (1 - r) * factor, SIGMAS * sqrt(square / TRIES),
			"mean weight of a band");
		x = -r * sin(angle * PI / 180) - (1 - r) * factor * sine;
		mean = x_sum[j] / TRIES;
		square = x_squares[j] / TRIES - mean * mean;
		near(mean, x, SIGMAS * sqrt(square / TRIES) + 1e-12,
			"mean direction of a band");
	}
}

static void
test_dispersion(void **state)
{
	static const float coloured[] = {0.1f, 0, 0.5f, 0.9f, 0.2f};
	struct fixture *f = *state;

	make_prism(f);
	expect_dispersion(f, 0, 0, whole);
	expect_dispersion(f, 55, 0, whole);
	expect_dispersion(f, 30, 1, whole);
	expect_dispersion(f, 39.5, 1, whole); /* total for some bands alone */
	expect_dispersion(f, 55, 0, coloured);
	expect_dispersion(f, 39.5, 1, coloured);
}

static void
test_rough_dielectric_is_refused(void **state)
{
	struct fixture *f = *state;
	struct spec_error error;

	f->scene.files = 1;
	f->scene.file = calloc(1, sizeof *f->scene.file);
	f->scene.file[0] = strdup("a.pbrt");
	f->scene.material->roughness[0] = f->scene.material->roughness[1] = 0.2;
	f->scene.material->kind = SPEC_SCENE_DIELECTRIC;
	assert_int_equal(spec_materials_make(&f->material, &f->scene, &f->bands, &error),
		SPEC_EUNSUPPORTED);
	assert_null(f->material);
}

/* --- films --- */

static void
make_film(struct fixture *f, const char *stack, const char *thickness)
{
	free(f->scene.material->stack);
	free(f->scene.material->thickness);
	f->scene.material->stack = strdup(stack);
	f->scene.material->thickness = thickness ? strdup(thickness) : NULL;
	make(f, SPEC_SCENE_THINFILM);
}

/* In the mean what is mirrored and what comes through are those of the coating. */
static void
expect_film(struct fixture *f, double angle, int inside, double thickness_nm,
	const float *throughput)
{
	enum { TRIES = 4000 };
	double cosine = cos(angle * PI / 180), sum[2][MOST_BANDS] = {{0}};
	double squares[2][MOST_BANDS] = {{0}};

	f->hit.normal.z = f->hit.shading.z = inside ? -1 : 1;
	look(f, at_angle(angle, 20));
	for (uint32_t i = 0; i < TRIES; i++) {
		struct spec_vector d, wanted;
		float weight[MOST_BANDS];

		assert_true(choose(f, throughput, 1, i, &d, weight) == 0);
		wanted = d.z > 0 ? at_angle(angle, 200)
				 : spec_vector_negate(at_angle(angle, 20));
		near(spec_vector_length(spec_vector_subtract(d, wanted)), 0, 1e-12,
			"direction");
		for (size_t j = 0; j < f->bands.count; j++) {
			sum[d.z < 0][j] += weight[j];
			squares[d.z < 0][j] += (double)weight[j] * weight[j];
		}
	}
	for (size_t j = 0; j < f->bands.count; j++) {
		double factor[2];

		spec_coating_row(&f->material->coating, j, inside, &cosine, &thickness_nm,
			1, SPEC_POLARISATION_NONE, &factor[0], &factor[1]);
		for (int k = 0; k < 2; k++) {
			double mean = sum[k][j] / TRIES;
			double square = squares[k][j] / TRIES - mean * mean;

			near(mean, factor[k], SIGMAS * sqrt(fmax(square, 0) / TRIES) + 1e-6,
				k ? "through" : "mirrored");
		}
	}
}

static void
test_film(void **state)
{
	static const float coloured[] = {0.1f, 0.9f, 0.5f, 0.01f, 0.2f};
	struct fixture *f = *state;

	make_film(f, "air | 1.33 400nm | air", NULL);
	assert_false(spec_material_is_rough(f->material));
	for (double angle = 0; angle < 90; angle += 17) {
		expect_film(f, angle, 0, 400, whole);
		expect_film(f, angle, 1, 400, whole);
		expect_film(f, angle, 0, 400, coloured);
	}
	/* Between air and glass: from behind, total reflection beyond 41.8 degrees. */
	make_film(f, "air | 1.38 100nm | 1.5", NULL);
	for (double angle = 0; angle < 90; angle += 17) {
		expect_film(f, angle, 0, 100, whole);
		expect_film(f, angle, 1, 100, whole);
	}
	/* Light absorbed in the layer goes neither way. */
	make_film(f, "air | 1.5+0.1i 300nm | 1.5", NULL);
	expect_film(f, 30, 0, 300, whole);
	expect_film(f, 30, 1, 300, coloured);
}

/* On metal: nothing comes through, and from within the metal all is dark. */
static void
test_film_on_metal(void **state)
{
	struct fixture *f = *state;
	struct spec_vector d;
	float weight[MOST_BANDS];

	make_film(f, "air | 1.5 300nm | 0.3+3i", NULL);
	expect_film(f, 50, 0, 300, whole);
	f->hit.normal.z = f->hit.shading.z = -1;
	look(f, at_angle(50, 0));
	assert_true(choose(f, whole, 1, 0, &d, weight) < 0);
}

/* Gravity's film is as thick as the place on the object says. */
static void
test_film_thickness(void **state)
{
	struct fixture *f = *state;

	make_film(f, "air | 1.33 * | air", "gravity 200nm..800nm");
	f->hit.object = (struct spec_vector){0.1, 0.9, 1};
	expect_film(f, 30, 0, 200, whole);
	f->hit.object.z = 0;
	expect_film(f, 30, 0, 800, whole);
	f->hit.object.z = 0.5;
	expect_film(f, 30, 1, 400, whole);
	make_film(f, "air | 1.33 * | air", "gravity 200nm..800nm y");
	f->hit.object = (struct spec_vector){0.1, 0, 1};
	expect_film(f, 30, 1, 800, whole);
}

static void
test_interface(void **state)
{
	struct fixture *f = *state;
	struct spec_vector d;
	float weight[MOST_BANDS];

	make(f, SPEC_SCENE_INTERFACE);
	look(f, at_angle(50, 10));
	assert_true(choose(f, whole, 1, 0, &d, weight) == 0);
	near(spec_vector_length(spec_vector_add(d, f->surface.eye)), 0, 1e-15, "direction");
	for (size_t i = 0; i < f->bands.count; i++)
		assert_true(weight[i] == 1);
}

#define TEST(name) cmocka_unit_test_setup_teardown(name, set_up, tear_down)

int
main(void)
{
	const struct CMUnitTest tests[] = {
		TEST(test_diffuse),
		TEST(test_rough_metal),
		TEST(test_disc),
		TEST(test_disc_from_behind),
		TEST(test_other_side),
		TEST(test_reciprocity),
		TEST(test_energy),
		TEST(test_bent_normal),
		TEST(test_smooth_metal),
		TEST(test_half_smooth_metal),
		TEST(test_dielectric),
		TEST(test_dispersion),
		TEST(test_rough_dielectric_is_refused),
		TEST(test_film),
		TEST(test_film_on_metal),
		TEST(test_film_thickness),
		TEST(test_interface),
	};

	return cmocka_run_group_tests_name("material", tests, NULL, NULL);
}
