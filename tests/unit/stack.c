/*
 * Films: published values, closed forms, and in between two other ways to compute them,
 * both in long double: the recursion of reflection coefficients (Parratt 1954; Hirayama et
 * al. 2001) and the product of characteristic matrices (Abeles 1950).
 */
#include <complex.h>
#include <float.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "optics/stack.h"

#include "check.h"
#include "random.h"

#define PI 3.14159265358979323846
#define PIL 3.14159265358979323846264338327950288L
#define DEGREE (PI / 180)
#define ULP DBL_EPSILON /* of 1 */
#define LEAST 1e-300    /* below it a double has no longer all its digits */

enum { S = SPEC_POLARISATION_S, P = SPEC_POLARISATION_P, U = SPEC_POLARISATION_NONE };

/* Shares of the power. */
struct powers {
	double r, t;
};

struct medium {
	double n, k, d_nm;
};

static void
near_both(struct powers got, struct powers wanted, double tolerance, const char *what)
{
	near(got.r, wanted.r, tolerance, what);
	near(got.t, wanted.t, tolerance, what);
}

/* ---- stacks ---- */

static struct spec_stack
new_stack(size_t layers, size_t wavelengths)
{
	struct spec_stack stack;

	assert_int_equal(spec_stack_new(layers, wavelengths, &stack, NULL), SPEC_OK);
	return stack;
}

/* Sets a medium, counted from the ambient, at all wavelengths. */
static void
set_medium(struct spec_stack *stack, size_t number, struct medium medium)
{
	for (size_t i = 0; i < stack->wavelengths; i++) {
		stack->n[number * stack->wavelengths + i] = medium.n;
		stack->k[number * stack->wavelengths + i] = medium.k;
	}
	if (number > 0 && number <= stack->layers)
		stack->thickness_nm[number - 1] = medium.d_nm;
}

/* At one wavelength. count: ambient and substrate included. */
static struct spec_stack
make_stack(double wavelength_nm, const struct medium *media, size_t count)
{
	struct spec_stack stack = new_stack(count - 2, 1);

	stack.wavelength_nm[0] = wavelength_nm;
	for (size_t i = 0; i < count; i++)
		set_medium(&stack, i, media[i]);
	return stack;
}

#define MAKE_STACK(wavelength_nm, ...)                                                     \
	make_stack(wavelength_nm, (const struct medium[]){__VA_ARGS__},                    \
		sizeof(const struct medium[]){__VA_ARGS__} / sizeof(struct medium))

/* Of a stack with one wavelength. */
static struct powers
run(const struct spec_stack *stack, double cosine, int polarisation)
{
	struct powers got;

	assert_int_equal(stack->wavelengths, 1);
	spec_stack_spectrum(
		stack, cosine, 0, (enum spec_polarisation)polarisation, &got.r, &got.t);
	return got;
}

/* ---- the two other ways ---- */

struct exact {
	long double r, t;
};

static long double
square(long double complex value)
{
	return creall(value) * creall(value) + cimagl(value) * cimagl(value);
}

static long double complex
index_of(const struct spec_stack *stack, size_t medium)
{
	size_t at = medium * stack->wavelengths;

	return stack->n[at] + I * (long double)stack->k[at];
}

/* n cos(theta) with the imaginary part of a wave that decays. */
static long double complex
normal_component(const struct spec_stack *stack, size_t medium, double cosine)
{
	long double c = cosine, along = stack->n[0] * sqrtl((1 - c) * (1 + c));
	long double complex n = index_of(stack, medium), q;

	if (medium == 0)
		return stack->n[0] * c;
	q = csqrtl((n - along) * (n + along));
	return cimagl(q) < 0 ? -q : q;
}

/* delta of a layer. */
static long double complex
phase_of(const struct spec_stack *stack, size_t layer, long double complex q)
{
	return 2 * PIL * stack->thickness_nm[layer - 1] / stack->wavelength_nm[0] * q;
}

/* A medium's index, and n cos(theta) in it. */
struct ray {
	long double complex n, q;
};

static struct ray
ray_in(const struct spec_stack *stack, size_t medium, double cosine)
{
	return (struct ray){
		index_of(stack, medium), normal_component(stack, medium, cosine)};
}

/* Amplitudes of reflection and of transmission; of p light the magnetic ones. */
struct boundary {
	long double complex r, t;
};

static struct boundary
cross_boundary(struct ray from, struct ray to, int p)
{
	long double complex a = p ? to.n * to.n * from.q : from.q;
	long double complex b = p ? from.n * from.n * to.q : to.q;

	return (struct boundary){(a - b) / (a + b), 2 * a / (a + b)};
}

/*
 * D. Schiffner, Wellenlängenbasiertes Beleuchtungsmodell im Shader (2008), pages 67 and 68,
 * put right: a layer's phase is 2 pi n d cos / lambda, not twice that, and what is let
 * through has the factor e^(i phase), too.
 */
static struct exact
parratt(const struct spec_stack *stack, double cosine, int p)
{
	long double complex r = 0, t = 1, wave = 1;
	struct ray last = ray_in(stack, stack->layers + 1, cosine), behind = last,
		   here = last;
	long double power_in, power_out;

	for (size_t medium = stack->layers + 1; medium-- > 0; behind = here) {
		struct boundary front;
		long double complex echo = r * wave * wave, all;

		here = ray_in(stack, medium, cosine);
		front = cross_boundary(here, behind, p);
		all = 1 + front.r * echo;
		t *= front.t * wave / all;
		r = (front.r + echo) / all;
		wave = medium ? cexpl(I * phase_of(stack, medium, here.q)) : 1;
	}
	power_in = creall(p ? here.q / (here.n * here.n) : here.q);
	power_out = creall(p ? last.q / (last.n * last.n) : last.q);
	return (struct exact){square(r), square(t) * power_out / power_in};
}

/* Born & Wolf 1.6.5; overflows where a layer is opaque. */
static struct exact
abeles(const struct spec_stack *stack, double cosine, int p)
{
	size_t last = stack->layers + 1;
	long double complex n = index_of(stack, last);
	long double complex q = normal_component(stack, last, cosine);
	long double complex b = 1, c = p ? n * n / q : q, sum;
	long double power = creall(c), eta;

	for (size_t layer = stack->layers; layer > 0; layer--) {
		long double complex delta, was = b;

		n = index_of(stack, layer);
		q = normal_component(stack, layer, cosine);
		delta = phase_of(stack, layer, q);
		b = ccosl(delta) * b - I * csinl(delta) * c * (p ? q / (n * n) : 1 / q);
		c = ccosl(delta) * c - I * csinl(delta) * was * (p ? n * n / q : q);
	}
	eta = p ? stack->n[0] / (long double)cosine : stack->n[0] * (long double)cosine;
	sum = eta * b + c;
	return (struct exact){square((eta * b - c) / sum), 4 * eta * power / square(sum)};
}

/* ---- how near the library has to come ---- */

static void
add_difference(struct powers *sum, struct exact a, struct exact b, double step)
{
	sum->r += (double)fabsl(a.r - b.r) / step;
	sum->t += (double)fabsl(a.t - b.t) / step;
}

/*
 * What the powers move by, per ulp, where all phases, the ambient's index or all absorption
 * are an ulp off: a resonance may multiply the roundings of its layers by thousands.
 */
static struct powers
sensitivity(const struct spec_stack *stack, double cosine, int p)
{
	static const double step = 0x1p-36;
	struct exact here = parratt(stack, cosine, p);
	struct spec_stack other = *stack;
	struct powers moved = {0, 0};
	double wavelength_nm = stack->wavelength_nm[0] * (1 + step);
	size_t count = (stack->layers + 2) * stack->wavelengths;
	double *n = malloc(count * sizeof *n), *k = malloc(count * sizeof *k);

	assert_true(n && k);
	memcpy(n, stack->n, count * sizeof *n);
	memcpy(k, stack->k, count * sizeof *k);
	other.wavelength_nm = &wavelength_nm;
	add_difference(&moved, parratt(&other, cosine, p), here, step);
	other.wavelength_nm = stack->wavelength_nm;
	other.n = n;
	n[0] *= 1 + step;
	add_difference(&moved, parratt(&other, cosine, p), here, step);
	other.n = stack->n;
	other.k = k;
	for (size_t i = stack->wavelengths; i < count; i++) {
		if (i < count - stack->wavelengths || k[i] > 0)
			k[i] += step * n[i];
	}
	add_difference(&moved, parratt(&other, cosine, p), here, step);
	free(n);
	free(k);
	return moved;
}

/*
 * 64 of those ulp: a phase is some twenty roundings and libmvec's 4 ulp away from what it
 * should be. And a reflectance that is a difference of numbers about 1, squared.
 */
static struct powers
allowed(struct exact wanted, struct powers moved)
{
	return (struct powers){64 * ULP * ((double)wanted.r + moved.r) + 64 * ULP * ULP,
		64 * ULP * ((double)wanted.t + moved.t) + LEAST};
}

static void
near_exact(
	struct powers got, struct exact wanted, struct powers tolerance, const char *what)
{
	near(got.r, (double)wanted.r, tolerance.r, what);
	near(got.t, (double)wanted.t, tolerance.t, what);
}

static void
check_range(struct powers got)
{
	if (!(got.r >= 0 && got.r <= 1 && got.t >= 0 && got.t <= 1))
		fail_msg("reflectance %.17g, transmittance %.17g", got.r, got.t);
}

static int
absorbs(const struct spec_stack *stack)
{
	for (size_t i = 0; i < (stack->layers + 2) * stack->wavelengths; i++) {
		if (stack->k[i] != 0)
			return 1;
	}
	return 0;
}

/* Absorption in nepers: abeles() makes cosines of it, which end at 11356. */
static int
is_opaque(const struct spec_stack *stack, double cosine)
{
	long double sum = 0;

	for (size_t i = 1; i <= stack->layers; i++)
		sum += cimagl(phase_of(stack, i, normal_component(stack, i, cosine)));
	return sum > 5000;
}

/* s and p light against both other ways, and that all power is somewhere. */
static void
check_stack(const struct spec_stack *stack, double cosine, const char *what)
{
	for (int polarisation = S; polarisation <= P; polarisation++) {
		int p = polarisation == P;
		struct exact wanted = parratt(stack, cosine, p);
		struct powers moved = sensitivity(stack, cosine, p);
		struct powers tolerance = allowed(wanted, moved);
		struct powers got = run(stack, cosine, polarisation);
		double sum = got.r + got.t, lost = 64 * ULP * (1 + moved.r + moved.t);

		near_exact(got, wanted, tolerance, what);
		if (stack->layers <= 100 && !is_opaque(stack, cosine))
			near_exact(got, abeles(stack, cosine, p), tolerance, what);
		check_range(got);
		if (absorbs(stack))
			assert_true(sum <= 1 + lost);
		else
			near(sum, 1, lost, what);
	}
}

/* ---- published values ---- */

/*
 * S. J. Byrnes, tmm, basic_test() of its tests.py (github.com/sbyrnes321/tmm): numbers from
 * an independent program in Mathematica, for 1 | 2+4i | 3+0.3i | 1+0.1i at 0.1 rad.
 */
static void
test_published(void **state)
{
	static const struct powers s = {0.37273208839139516, 0.22604491247079261};
	static const struct powers p = {0.37016110373044969, 0.22824374314132009};
	struct spec_stack stack =
		MAKE_STACK(100, {1, 0, 0}, {2, 4, 2}, {3, 0.3, 3}, {1, 0.1, 0});
	double cosine = cos(0.1);

	(void)state;
	near_both(run(&stack, cosine, S), s, 1e-12 * s.t, "s");
	near_both(run(&stack, cosine, P), p, 1e-12 * p.t, "p");
	near(run(&stack, cosine, U).r, (s.r + p.r) / 2, 1e-12 * s.r, "unpolarised");
	near(run(&stack, cosine, U).t, (s.t + p.t) / 2, 1e-12 * s.t, "unpolarised");
	check_stack(&stack, cosine, "Byrnes");
	spec_stack_free(&stack);
}

/* Ibid., coh_overflow_test(): behind an opaque layer there may be anything. */
static void
test_opaque_layer(void **state)
{
	struct spec_stack stack = MAKE_STACK(
		200, {1, 0, 0}, {2, 0.1, 50}, {1, 3, 1e5}, {4, 0, 50}, {5, 0, 0});
	struct spec_stack front = MAKE_STACK(200, {1, 0, 0}, {2, 0.1, 50}, {1, 3, 0});

	(void)state;
	for (double cosine = 1; cosine > 0.05; cosine -= 0.1) {
		for (int polarisation = S; polarisation <= P; polarisation++) {
			struct powers got = run(&stack, cosine, polarisation);

			near(got.r, run(&front, cosine, polarisation).r, 16 * ULP, "r");
			near(got.t, 0, 0, "t");
		}
	}
	spec_stack_free(&stack);
	spec_stack_free(&front);
}

/* ---- closed forms ---- */

/* No layer: fresnel.h, which other tests look after. */
static void
test_bare_surface(void **state)
{
	static const double indices[][2] = {
		{1.5, 0}, {0.7, 0}, {1, 0}, {0.2, 3.4}, {2.5, 0.01}, {0, 2}};

	(void)state;
	for (size_t i = 0; i < sizeof indices / sizeof *indices; i++) {
		double n = indices[i][0], k = indices[i][1];
		struct spec_stack stack = MAKE_STACK(550, {1.1, 0, 0}, {n, k, 0});

		for (int angle = 0; angle < 90; angle += 3) {
			double cosine = cos(angle * DEGREE);
			struct spec_fresnel bare =
				spec_fresnel_conductor(cosine, 1.1, n, k);
			/* What gets in through a boundary is not reflected. */
			struct powers s = {bare.s, 1 - bare.s}, p = {bare.p, 1 - bare.p};

			near_both(run(&stack, cosine, S), s, 64 * ULP, "s");
			near_both(run(&stack, cosine, P), p, 64 * ULP, "p");
		}
		spec_stack_free(&stack);
	}
}

/* Of a quarter wave of n1 between n0 and ns. */
static double
quarter_wave(double n0, double n1, double ns)
{
	double r = (n0 * ns - n1 * n1) / (n0 * ns + n1 * n1);

	return r * r;
}

static void
test_quarter_wave(void **state)
{
	static const double n[][3] = {{1, 1.38, 1.52}, {1, 1.2328828005937953, 1.52},
		{1, 2.35, 1.52}, {1.5, 1.2, 4}};

	(void)state;
	near(quarter_wave(1, 1.38, 1.52), 0.0126, 5e-5, "MgF2 on glass, as printed");
	for (size_t i = 0; i < sizeof n / sizeof *n; i++) {
		double r = quarter_wave(n[i][0], n[i][1], n[i][2]);
		struct spec_stack stack = MAKE_STACK(550, {n[i][0], 0, 0},
			{n[i][1], 0, 550 / (4 * n[i][1])}, {n[i][2], 0, 0});

		near_both(run(&stack, 1, S), (struct powers){r, 1 - r}, 1e-14, "s");
		near_both(run(&stack, 1, P), (struct powers){r, 1 - r}, 1e-14, "p");
		spec_stack_free(&stack);
	}
}

/* A half wave, and a layer without thickness, might as well not be there. */
static void
test_absentees(void **state)
{
	struct spec_stack bare = MAKE_STACK(550, {1, 0, 0}, {1.7, 0.2, 0});
	struct spec_stack none =
		MAKE_STACK(550, {1, 0, 0}, {2.3, 1.5, 0}, {0.3, 0, 0}, {1.7, 0.2, 0});

	(void)state;
	for (int angle = 0; angle < 90; angle += 10) {
		double cosine = cos(angle * DEGREE), sine = sin(angle * DEGREE);
		double d_nm = 550 / (2 * sqrt(2.3 * 2.3 - sine * sine));
		struct spec_stack half =
			MAKE_STACK(550, {1, 0, 0}, {2.3, 0, d_nm}, {1.7, 0.2, 0});

		for (int polarisation = S; polarisation <= P; polarisation++) {
			struct powers wanted = run(&bare, cosine, polarisation);

			near_both(run(&half, cosine, polarisation), wanted, 32 * ULP,
				"half wave");
			near_both(run(&none, cosine, polarisation), wanted, 32 * ULP,
				"no thickness");
		}
		spec_stack_free(&half);
	}
	spec_stack_free(&bare);
	spec_stack_free(&none);
}

/*
 * Two layers that reflect nothing at one wavelength (Macleod, eqs. 4.5-4.6; n1 is outside):
 * the amplitude is a difference of rounded numbers about 1, the reflectance its square.
 */
static void
test_v_coat(void **state)
{
	static const double n[][2] = {{1.38, 2.15}, {1.46, 2.1}, {1.38, 1.9}};
	static const double n0 = 1, ns = 1.52, least = 1e-28;
	struct spec_stack quarters = MAKE_STACK(510, {1, 0, 0}, {1.38, 0, 510.0 / 4 / 1.38},
		{1.38 * 1.2328828005937953, 0, 510.0 / 4 / 1.38 / 1.2328828005937953},
		{1.52, 0, 0});

	(void)state;
	near_both(run(&quarters, 1, S), (struct powers){0, 1}, 1e-14, "quarters");
	near(run(&quarters, 1, S).r, 0, least, "quarters");
	spec_stack_free(&quarters);
	for (size_t i = 0; i < sizeof n / sizeof *n; i++) {
		double n1 = n[i][0], n2 = n[i][1];
		double a = n1 * n1 * ns - n0 * n2 * n2, b = n0 * ns - n1 * n1;
		double c = n2 * n2 - n0 * ns;
		double delta1 = atan(sqrt((ns - n0) * c * n1 * n1 / (a * b)));
		double delta2 = atan(n1 * n2 * (ns - n0) / (a * tan(delta1)));
		struct spec_stack stack;

		if (delta2 < 0)
			delta2 += PI;
		stack = MAKE_STACK(510, {n0, 0, 0}, {n1, 0, 510 * delta1 / (2 * PI * n1)},
			{n2, 0, 510 * delta2 / (2 * PI * n2)}, {ns, 0, 0});
		near(run(&stack, 1, S).r, 0, least, "s");
		near(run(&stack, 1, P).r, 0, least, "p");
		near(run(&stack, 1, U).t, 1, 64 * ULP, "t");
		spec_stack_free(&stack);
	}
}

/* air | (H L)^pairs | glass in quarter waves; its admittance is ns (nH / nL)^(2 pairs). */
static void
test_mirror(void **state)
{
	static const double high = 2.35, low = 1.38, ns = 1.52;

	(void)state;
	for (size_t pairs = 0; pairs <= 50; pairs++) {
		struct spec_stack stack = new_stack(2 * pairs, 1);
		double y = ns * pow(high / low, 2 * (double)pairs);
		double r = (1 - y) / (1 + y), t = 4 * y / ((1 + y) * (1 + y));
		struct powers got;

		stack.wavelength_nm[0] = 633;
		set_medium(&stack, 0, (struct medium){1, 0, 0});
		for (size_t i = 1; i <= 2 * pairs; i++) {
			double n = i % 2 ? high : low;

			set_medium(&stack, i, (struct medium){n, 0, 633 / (4 * n)});
		}
		set_medium(&stack, 2 * pairs + 1, (struct medium){ns, 0, 0});
		got = run(&stack, 1, pairs % 2 ? S : P);
		/* Some roundings in each layer, and in each factor of the power. */
		near(got.r, r * r, 32 * ULP, "reflectance");
		near(got.t, t, 16 * ULP * (double)(4 + pairs) * t, "transmittance");
		check_range(got);
		spec_stack_free(&stack);
	}
}

/* Born & Wolf 7.6.1: both surfaces' amplitudes, the one inside the film and its phase. */
struct film {
	double complex r12, r23, t12t21, wave;
};

static struct film
make_film(const double *n, double phase, double cosine, int p)
{
	double sine = n[0] * sqrt((1 - cosine) * (1 + cosine));
	double q1 = n[0] * cosine, q2 = sqrt(n[1] * n[1] - sine * sine);
	double q3 = sqrt(n[2] * n[2] - sine * sine);
	double e1 = p ? n[0] * n[0] : 1, e2 = p ? n[1] * n[1] : 1, e3 = p ? n[2] * n[2] : 1;
	double r12 = (e2 * q1 - e1 * q2) / (e2 * q1 + e1 * q2);

	return (struct film){r12, (e3 * q2 - e2 * q3) / (e3 * q2 + e2 * q3), 1 - r12 * r12,
		cexp(I * phase * q2)};
}

/* All echoes at once. */
static double
airy(const struct film *film)
{
	double complex r = (film->r12 + film->r23 * film->wave) /
			   (1 + film->r12 * film->r23 * film->wave);

	return creal(r) * creal(r) + cimag(r) * cimag(r);
}

/* One after the other: T 6.11 and 6.12, but of amplitudes where T adds powers. */
static double
echoes(const struct film *film, int count)
{
	double complex echo = 1, r;

	for (int i = 1; i < count; i++)
		echo = 1 - film->r12 * film->r23 * film->wave * echo;
	r = film->r12 + film->t12t21 * film->r23 * film->wave * echo;
	return creal(r) * creal(r) + cimag(r) * cimag(r);
}

/* 200 echoes leave at most |r12 r23|^200, and that is below 0.85 here: 1e-14. */
static void
test_airy(void **state)
{
	static const double n[][3] = {
		{1, 1.33, 1}, {1, 1.47, 1.33}, {1, 2.4, 1.52}, {1.5, 2, 1.7}, {1, 1.38, 4}};

	(void)state;
	for (size_t i = 0; i < sizeof n / sizeof *n; i++) {
		for (int angle = 0; angle <= 80; angle += 5) {
			double cosine = cos(angle * DEGREE), d_nm = 90 + 17 * angle;
			double phase = 4 * PI * d_nm / 550;
			struct spec_stack stack = MAKE_STACK(
				550, {n[i][0], 0, 0}, {n[i][1], 0, d_nm}, {n[i][2], 0, 0});

			for (int polarisation = S; polarisation <= P; polarisation++) {
				struct film film =
					make_film(n[i], phase, cosine, polarisation == P);
				double r = airy(&film);
				/* The roundings of the phase, and those of the sums. */
				double off = 4 * ULP * (16 + n[i][1] * phase);

				near_both(run(&stack, cosine, polarisation),
					(struct powers){r, 1 - r}, off, "Airy");
				near(run(&stack, cosine, polarisation).r,
					echoes(&film, 200), off + 2e-14, "200 echoes");
			}
			spec_stack_free(&stack);
		}
	}
}

/*
 * A gap of air in glass beyond the critical angle: T = 1 / (1 + a sinh(decay)^2), the same
 * as of a barrier in quantum mechanics.
 */
static struct powers
tunnel(double n, double cosine, double d_over_wavelength, int p)
{
	double sine = n * sqrt((1 - cosine) * (1 + cosine)), v = sqrt(sine * sine - 1);
	double glass = p ? n / cosine : n * cosine, air = p ? 1 / v : v;
	double a = (glass / air + air / glass) / 2;
	double b = a * sinh(2 * PI * d_over_wavelength * v);

	if (isinf(b * b))
		return (struct powers){1, 0};
	return (struct powers){b * b / (1 + b * b), 1 / (1 + b * b)};
}

static void
test_frustrated_reflection(void **state)
{
	(void)state;
	for (int angle = 42; angle <= 87; angle += 5) {
		double cosine = cos(angle * DEGREE);

		for (double d_nm = 1; d_nm < 2e6; d_nm *= 1.7) {
			struct spec_stack stack =
				MAKE_STACK(550, {1.5, 0, 0}, {1, 0, d_nm}, {1.5, 0, 0});

			for (int polarisation = S; polarisation <= P; polarisation++) {
				struct powers got = run(&stack, cosine, polarisation);
				struct powers wanted =
					tunnel(1.5, cosine, d_nm / 550, polarisation == P);
				/* The decay's exponent, in ulp, is the relative error. */
				double off = 64 * ULP * (1 + 2 * PI * d_nm / 550);

				near(got.r, wanted.r, 64 * ULP, "reflectance");
				near(got.t, wanted.t, off * wanted.t + LEAST,
					"transmittance");
				check_range(got);
			}
			spec_stack_free(&stack);
		}
	}
}

/*
 * n + ik in n, at right angles: r = -ik / (2n + ik) at both surfaces. For a small k that is
 * Beer and Lambert's law, but for some r^2.
 */
static void
test_matched_absorber(void **state)
{
	static const double n = 1.5, wavelength_nm = 550;

	(void)state;
	for (double k = 1e-8; k < 3; k *= 10) {
		for (double d_nm = 1; d_nm < 1e7; d_nm *= 10) {
			struct spec_stack stack = MAKE_STACK(
				wavelength_nm, {n, 0, 0}, {n, k, d_nm}, {n, 0, 0});
			double complex r = -I * k / (2 * n + I * k);
			double complex wave =
				cexp(4 * PI * d_nm / wavelength_nm * (I * n - k));
			double through = exp(-4 * PI * k * d_nm / wavelength_nm);
			double length = cabs((1 - r * r) / (1 - r * r * wave));
			struct powers wanted = {
				pow(cabs(r * (1 - wave) / (1 - r * r * wave)), 2),
				length * length * through};
			struct powers got = run(&stack, 1, S);
			/* Of the phase and of the exponent of the decay. */
			double off = 16 * ULP * (4 + 4 * PI * (n + k) * d_nm / 550);
			double surfaces = 4 * pow(cabs(r), 2);

			near(got.r, wanted.r, (cabs(r) + off) * off, "reflectance");
			near(got.t, wanted.t, off * wanted.t + LEAST, "transmittance");
			if (k < 0.1)
				near(got.t, through, (surfaces + off) * through + LEAST,
					"Beer and Lambert");
			spec_stack_free(&stack);
		}
	}
}

/* A millimetre of what might be gold: the bare metal, which keeps all that it lets in. */
static void
test_thick_metal(void **state)
{
	static const double n = 0.36, k = 2.77;
	struct spec_stack stack = MAKE_STACK(550, {1, 0, 0}, {n, k, 1e6}, {1.52, 0, 0});

	(void)state;
	for (int angle = 0; angle < 90; angle++) {
		double cosine = cos(angle * DEGREE);
		struct spec_fresnel bare = spec_fresnel_conductor(cosine, 1, n, k);

		near_both(
			run(&stack, cosine, S), (struct powers){bare.s, 0}, 32 * ULP, "s");
		near_both(
			run(&stack, cosine, P), (struct powers){bare.p, 0}, 32 * ULP, "p");
	}
	spec_stack_free(&stack);
}

/* ---- the edges ---- */

/* Along the surface all is reflected, and a little above it nearly all. */
static void
test_grazing(void **state)
{
	static const double cosines[] = {1e-6, 1e-9, 1e-17, 1e-45, 1e-120, 1e-200, 1e-310};
	struct spec_stack stacks[] = {MAKE_STACK(550, {1, 0, 0}, {1.5, 0, 0}),
		MAKE_STACK(550, {1, 0, 0}, {1.33, 0, 300}, {1, 0, 0}),
		MAKE_STACK(550, {1, 0, 0}, {1, 0, 300}, {1, 0, 0}),
		MAKE_STACK(550, {1, 0, 0}, {0.3, 3, 20}, {1.5, 0, 0}),
		MAKE_STACK(550, {1.5, 0, 0}, {1.2, 0, 300}, {1.4, 0, 30}, {1.7, 0.1, 0})};

	(void)state;
	for (size_t i = 0; i < sizeof stacks / sizeof *stacks; i++) {
		for (int polarisation = U; polarisation <= P; polarisation++) {
			double zero = 0, r, t;

			near_both(run(&stacks[i], 0, polarisation), (struct powers){1, 0},
				0, "spectrum");
			spec_stack_row(&stacks[i], 0, &zero, NULL, 1,
				(enum spec_polarisation)polarisation, &r, &t);
			near_both((struct powers){r, t}, (struct powers){1, 0}, 0, "row");
			for (size_t j = 0; i != 2 && j < sizeof cosines / sizeof *cosines;
				j++) {
				/* Metals are nearly at their Brewster angle: 100. */
				double off = 100 * cosines[j] + 16 * ULP;

				near_both(run(&stacks[i], cosines[j], polarisation),
					(struct powers){1, 0}, off, "spectrum");
				spec_stack_row(&stacks[i], 0, &cosines[j], NULL, 1,
					(enum spec_polarisation)polarisation, &r, &t);
				near_both((struct powers){r, t}, (struct powers){1, 0}, off,
					"row");
			}
		}
		spec_stack_free(&stacks[i]);
	}
}

/*
 * One layer along which light runs: n cos(theta) = 0 in it, and the sine of the phase over
 * that is the phase itself, phi = 2 pi d / lambda.
 */
static struct powers
along_layer(const struct medium *media, double wavelength_nm, int p)
{
	double e0 = media[0].n * media[0].n, e1 = media[1].n * media[1].n;
	double q0 = sqrt(e0 - e1), q2 = sqrt(media[2].n * media[2].n - e1);
	double phi = 2 * PI * media[1].d_nm / wavelength_nm;
	double eta0 = p ? e0 / q0 : q0, eta2 = p ? media[2].n * media[2].n / q2 : q2;
	double complex b = p ? 1 : 1 - I * phi * eta2;
	double complex c = p ? eta2 - I * phi * e1 : eta2;
	double sum = cabs(eta0 * b + c), minus = cabs(eta0 * b - c);

	return (struct powers){minus * minus / (sum * sum), 4 * eta0 * eta2 / (sum * sum)};
}

/*
 * Exactly at a layer's critical angle, as far as a cosine can say that, and beside it. q^2
 * has the error of an ulp of n0^2 there and enters times phi^2, about 40: 1e-13.
 */
static void
test_critical_angle_of_a_layer(void **state)
{
	static const double ratios[] = {0.8, 0.6, 0.5, 0.75, 1.3 / 1.5, 1 / 1.33, 0.28};
	static const double beside[] = {1e-14, 1e-12, 1e-10, 1e-9, 1e-7, 1e-5, 1e-3};

	(void)state;
	for (size_t i = 0; i < sizeof ratios / sizeof *ratios; i++) {
		double cosine = sqrt((1 - ratios[i]) * (1 + ratios[i])), nudged = cosine;
		const struct medium media[] = {
			{1.5, 0, 0}, {1.5 * ratios[i], 0, 500}, {1.52, 0, 0}};
		struct spec_stack stack = make_stack(550, media, 3);

		for (int ulp = -8; ulp < 8; ulp++)
			nudged = nextafter(nudged, 0);
		for (int ulp = -16; ulp <= 16; ulp++, nudged = nextafter(nudged, 1)) {
			near_both(run(&stack, nudged, S), along_layer(media, 550, 0), 1e-12,
				"s");
			near_both(run(&stack, nudged, P), along_layer(media, 550, 1), 1e-12,
				"p");
		}
		for (size_t j = 0; j < sizeof beside / sizeof *beside; j++) {
			for (int sign = -1; sign <= 1; sign += 2) {
				double there = cosine + sign * beside[j];
				int p = j % 2;

				near_exact(run(&stack, there, p ? P : S),
					abeles(&stack, there, p),
					(struct powers){1e-13, 1e-13},
					"beside the critical angle");
			}
		}
		spec_stack_free(&stack);
	}
}

/* The same with the substrate: from there on nothing gets through. */
static void
test_critical_angle_of_the_substrate(void **state)
{
	struct spec_stack stack =
		MAKE_STACK(550, {1.25, 0, 0}, {2, 0, 200}, {1.4, 0, 90}, {1, 0, 0});
	double cosine = 0.6;

	(void)state;
	for (int polarisation = S; polarisation <= P; polarisation++) {
		for (double nudge = 1e-16; nudge < 0.1; nudge *= 10) {
			struct powers above = run(&stack, cosine - nudge, polarisation);
			struct powers below = run(&stack, cosine + nudge, polarisation);

			check_range(above);
			check_range(below);
			near(above.r + above.t, 1, 32 * ULP, "above");
			near(below.r + below.t, 1, 32 * ULP, "below");
			if (nudge > 1e-15)
				near(above.t, 0, 0, "beyond the angle");
			/* As the cosine in the substrate: as a square root. */
			near(below.t, 0, 16 * sqrt(nudge + 4 * ULP), "before the angle");
		}
	}
	spec_stack_free(&stack);
}

/* In a dense medium all may happen within half a degree: 1 - cosine^2 has few digits left. */
static void
test_small_angles(void **state)
{
	struct spec_stack bare = MAKE_STACK(550, {5, 0, 0}, {0.05, 0, 0});
	struct spec_stack layers =
		MAKE_STACK(550, {5, 0, 0}, {0.05, 0, 700}, {1.5, 0, 90}, {0.04, 0, 0});

	(void)state;
	for (double cosine = 1; cosine > 0.9999; cosine -= 7.3e-7) {
		check_stack(&bare, cosine, "bare surface");
		check_stack(&layers, cosine, "layers");
	}
	spec_stack_free(&bare);
	spec_stack_free(&layers);
}

/* ---- many layers ---- */

static void
alternate(struct spec_stack *stack, struct medium odd, struct medium even)
{
	set_medium(stack, 0, (struct medium){1, 0, 0});
	for (size_t i = 1; i <= stack->layers; i++)
		set_medium(stack, i, i % 2 ? odd : even);
	set_medium(stack, stack->layers + 1, (struct medium){1.52, 0, 0});
}

/*
 * Up to 10000 layers: mirrors in and beside their band, barriers through which light gets
 * all the same (a field grows by a thousand digits before it is scaled back, and absorption
 * takes as many away), metal and dielectric, and layers of extreme indices.
 */
static void
test_many_layers(void **state)
{
	static const struct {
		const char *what;
		struct medium odd, even;
	} kinds[] = {
		{"mirror", {2.35, 0, 60}, {1.38, 0, 100}},
		{"beside the band", {2.35, 0, 31}, {1.38, 0, 47}},
		{"barriers", {1, 0, 187}, {0, 1, 60}},
		{"metal and dielectric", {1.5, 0, 155}, {0.05, 3, 20}},
		{"absorption", {1.5, 1e-4, 155}, {1.6, 1e-3, 20}},
		{"extremes", {5, 0, 27.5}, {0.05, 0, 2750}},
		{"opaque", {1, 0, 187}, {0.05, 8, 2000}},
	};
	static const size_t counts[] = {15, 16, 17, 31, 32, 33, 100, 1000, 10000};

	(void)state;
	for (size_t i = 0; i < sizeof kinds / sizeof *kinds; i++) {
		for (size_t j = 0; j < sizeof counts / sizeof *counts; j++) {
			struct spec_stack stack = new_stack(counts[j], 1);

			stack.wavelength_nm[0] = 550;
			alternate(&stack, kinds[i].odd, kinds[i].even);
			check_stack(&stack, 1, kinds[i].what);
			if (counts[j] <= 1000)
				check_stack(&stack, 0.3, kinds[i].what);
			spec_stack_free(&stack);
		}
	}
}

/* ---- whatever comes ---- */

static struct spec_stack
random_stack(uint64_t *seed, size_t most_layers)
{
	size_t layers = (size_t)(random_share(seed) * (double)(most_layers + 1));
	struct spec_stack stack = new_stack(layers, 1);
	int clear = random_share(seed) < 0.4;

	stack.wavelength_nm[0] = 300 + 600 * random_share(seed);
	for (size_t i = 0; i < layers + 2; i++) {
		struct medium medium = {random_between(seed, 0.05, 5), 0, 0};

		if (i > 0 && !clear && random_share(seed) < 0.6)
			medium.k = random_between(seed, 1e-4, 8);
		if (random_share(seed) < 0.9)
			medium.d_nm = 2000 * random_share(seed);
		set_medium(&stack, i, medium);
	}
	return stack;
}

static void
test_random_stacks(void **state)
{
	enum { STACKS = 3000, LAYERS = 40 };
	uint64_t seed = 1;

	(void)state;
	for (int i = 0; i < STACKS; i++) {
		struct spec_stack stack = random_stack(&seed, LAYERS);
		double cosine = cos(random_share(&seed) * 90 * DEGREE);
		struct powers s = run(&stack, cosine, S), p = run(&stack, cosine, P);
		struct powers mean = {s.r / 2 + p.r / 2, s.t / 2 + p.t / 2};

		check_stack(&stack, cosine, "random stack");
		near_both(run(&stack, cosine, U), mean, 2 * ULP, "unpolarised");
		spec_stack_free(&stack);
	}
}

/*
 * As much gets through from either side, absorption or not. The way back starts with a
 * cosine that has the error of an ulp over its square; both are kept above 0.1.
 */
static void
test_reciprocity(void **state)
{
	enum { STACKS = 2000, LAYERS = 20 };
	uint64_t seed = 2;

	(void)state;
	for (int i = 0; i < STACKS; i++) {
		struct spec_stack stack = random_stack(&seed, LAYERS), back;
		double n = random_between(&seed, 1, 3), cosine, other;

		set_medium(&stack, stack.layers + 1, (struct medium){n, 0, 0});
		other = 0.1 + 0.9 * random_share(&seed);
		cosine = 1 - n / stack.n[0] * (n / stack.n[0]) * (1 - other) * (1 + other);
		assert_int_equal(spec_stack_reverse(&stack, &back, NULL), SPEC_OK);
		for (int polarisation = S; polarisation <= P && cosine > 0.01;
			polarisation++) {
			struct powers there = run(&stack, sqrt(cosine), polarisation);
			struct powers again = run(&back, other, polarisation);
			struct powers moved =
				sensitivity(&stack, sqrt(cosine), polarisation == P);
			double ulp = 64 + 4 * n / stack.n[0] * (n / stack.n[0]) / cosine;

			near(there.t, again.t, ulp * ULP * (there.t + moved.t) + LEAST,
				"from both sides");
		}
		spec_stack_free(&stack);
		spec_stack_free(&back);
	}
}

/* A layer cut in two is the same layer. */
static void
test_cut_layer(void **state)
{
	struct spec_stack whole = MAKE_STACK(
		550, {1.5, 0, 0}, {2, 0.3, 90}, {1, 0, 300}, {0.2, 2, 10}, {1.6, 0, 0});
	struct spec_stack cut = MAKE_STACK(550, {1.5, 0, 0}, {2, 0.3, 30}, {2, 0.3, 60},
		{1, 0, 100}, {1, 0, 200}, {0.2, 2, 4}, {0.2, 2, 6}, {1.6, 0, 0});

	(void)state;
	for (int angle = 0; angle < 90; angle += 5) {
		double cosine = cos(angle * DEGREE);

		near_both(run(&cut, cosine, S), run(&whole, cosine, S), 64 * ULP, "s");
		near_both(run(&cut, cosine, P), run(&whole, cosine, P), 64 * ULP, "p");
	}
	spec_stack_free(&whole);
	spec_stack_free(&cut);
}

/* ---- rows and spectra ---- */

enum { MOST = 300, DIFFERENT = 61 };

/* Indices that change with the wavelength; in a dense ambient, 3, what is evanescent too. */
static struct spec_stack
dispersive_stack(size_t layers, size_t wavelengths, size_t varied, double k, int ambient)
{
	struct spec_stack stack = new_stack(layers, wavelengths);

	stack.varied = varied;
	for (size_t i = 0; i < wavelengths; i++) {
		stack.wavelength_nm[i] = 380 + 400 * (double)i / (double)wavelengths;
		for (size_t medium = 0; medium < layers + 2; medium++) {
			size_t at = medium * wavelengths + i;

			stack.n[at] = 1.2 +
				      0.3 * (double)((medium * 5 + (size_t)ambient) % 4) +
				      20 / stack.wavelength_nm[i];
			stack.k[at] = medium % 3 == 1 ? k : 0;
		}
	}
	for (size_t i = 0; i < layers; i++)
		stack.thickness_nm[i] = 40 + 13 * (double)(i % 7);
	return stack;
}

/* After 61 of them, which divides no block of pixels, they repeat. */
struct pixels {
	double cosine[MOST], varied_nm[MOST];
	double r[DIFFERENT][MOST], t[DIFFERENT][MOST]; /* [pixel][wavelength] */
};

static void
fill_pixels(struct pixels *pixels, const struct spec_stack *stack, int polarisation)
{
	uint64_t seed = 3;

	for (size_t i = 0; i < DIFFERENT; i++) {
		pixels->cosine[i] = i == 49 ? 0 : random_share(&seed);
		pixels->varied_nm[i] = 400 * random_share(&seed);
		spec_stack_spectrum(stack, pixels->cosine[i], pixels->varied_nm[i],
			(enum spec_polarisation)polarisation, pixels->r[i], pixels->t[i]);
	}
	for (size_t i = DIFFERENT; i < MOST; i++) {
		pixels->cosine[i] = pixels->cosine[i - DIFFERENT];
		pixels->varied_nm[i] = pixels->varied_nm[i - DIFFERENT];
	}
}

static void
check_row(const struct pixels *pixels, const struct spec_stack *stack, size_t wavelength,
	size_t count, int polarisation)
{
	double r[MOST + 1], t[MOST + 1];

	r[count] = t[count] = -7;
	spec_stack_row(stack, wavelength, pixels->cosine,
		stack->varied ? pixels->varied_nm : NULL, count,
		(enum spec_polarisation)polarisation, r, t);
	for (size_t i = 0; i < count; i++) {
		struct powers got = {r[i], t[i]};
		size_t same = i % DIFFERENT;
		struct powers wanted = {
			pixels->r[same][wavelength], pixels->t[same][wavelength]};

		check_range(got);
		/* Phases of up to 30 whose roundings differ. */
		near_both(got, wanted, 1e-13, "row against spectrum");
	}
	near(r[count], -7, 0, "beyond the row");
	near(t[count], -7, 0, "beyond the row");
}

static void
test_rows_and_spectra(void **state)
{
	static const struct {
		size_t layers, varied;
		double k;
		int ambient;
	} kinds[] = {{0, 0, 0, 1}, {0, 0, 0.5, 1}, {1, 0, 0, 1}, {1, 1, 0, 0}, {1, 1, 0, 2},
		{1, 0, 0, 3}, {1, 1, 0.02, 1}, {2, 1, 0, 3}, {5, 5, 0.1, 3}, {17, 3, 0, 2},
		{33, 0, 0.01, 1}};
	static const size_t counts[] = {1, 7, 127, 128, 129, MOST};
	static const size_t wavelengths[] = {1, 81, 128, 129, MOST};
	struct pixels *pixels = malloc(sizeof *pixels);

	(void)state;
	assert_non_null(pixels);
	for (size_t i = 0; i < sizeof kinds / sizeof *kinds; i++) {
		for (size_t j = 0; j < sizeof wavelengths / sizeof *wavelengths; j++) {
			size_t count = wavelengths[j];
			struct spec_stack stack = dispersive_stack(kinds[i].layers, count,
				kinds[i].varied, kinds[i].k, kinds[i].ambient);
			int polarisation = (int)((i + j) % 3);

			fill_pixels(pixels, &stack, polarisation);
			for (size_t m = 0; m < sizeof counts / sizeof *counts; m++) {
				check_row(pixels, &stack, 0, counts[m], polarisation);
				check_row(
					pixels, &stack, count / 2, counts[m], polarisation);
				check_row(
					pixels, &stack, count - 1, counts[m], polarisation);
			}
			spec_stack_free(&stack);
		}
	}
	free(pixels);
}

/* Each wavelength of a spectrum is what it is alone, and a varied layer as if it were set. */
static void
test_spectrum(void **state)
{
	enum { WAVELENGTHS = 300, LAYERS = 5 };
	struct spec_stack all = dispersive_stack(LAYERS, WAVELENGTHS, 2, 0.3, 3);
	struct spec_stack one = new_stack(LAYERS, 1);
	double r[WAVELENGTHS], t[WAVELENGTHS];

	(void)state;
	spec_stack_spectrum(&all, 0.7, 333, SPEC_POLARISATION_NONE, r, t);
	memcpy(one.thickness_nm, all.thickness_nm, LAYERS * sizeof(double));
	one.thickness_nm[1] = 333;
	for (size_t i = 0; i < WAVELENGTHS; i++) {
		one.wavelength_nm[0] = all.wavelength_nm[i];
		for (size_t medium = 0; medium < LAYERS + 2; medium++) {
			one.n[medium] = all.n[medium * WAVELENGTHS + i];
			one.k[medium] = all.k[medium * WAVELENGTHS + i];
		}
		near_both(run(&one, 0.7, U), (struct powers){r[i], t[i]}, 1e-14, "alone");
	}
	spec_stack_free(&all);
	spec_stack_free(&one);
}

/* ---- the rest ---- */

static void
equal(const double *a, const double *b, size_t count)
{
	assert_memory_equal(a, b, count * sizeof *a);
}

static void
test_reverse(void **state)
{
	enum { LAYERS = 7, WAVELENGTHS = 5, COUNT = (LAYERS + 2) * WAVELENGTHS };
	struct spec_stack stack = dispersive_stack(LAYERS, WAVELENGTHS, 3, 0.1, 1), back,
			  again;

	(void)state;
	assert_int_equal(spec_stack_reverse(&stack, &back, NULL), SPEC_OK);
	assert_int_equal(back.varied, 5);
	assert_true(back.thickness_nm[0] == stack.thickness_nm[LAYERS - 1]);
	equal(back.n, stack.n + (LAYERS + 1) * WAVELENGTHS, WAVELENGTHS);
	equal(back.k + WAVELENGTHS, stack.k + LAYERS * WAVELENGTHS, WAVELENGTHS);
	assert_int_equal(spec_stack_reverse(&back, &again, NULL), SPEC_OK);
	assert_int_equal(again.layers, LAYERS);
	assert_int_equal(again.wavelengths, WAVELENGTHS);
	assert_int_equal(again.varied, 3);
	equal(again.thickness_nm, stack.thickness_nm, LAYERS);
	equal(again.wavelength_nm, stack.wavelength_nm, WAVELENGTHS);
	equal(again.n, stack.n, COUNT);
	equal(again.k, stack.k, COUNT);
	spec_stack_free(&again);
	spec_stack_free(&back);
	stack.varied = 0;
	assert_int_equal(spec_stack_reverse(&stack, &back, NULL), SPEC_OK);
	assert_int_equal(back.varied, 0);
	spec_stack_free(&back);
	spec_stack_free(&stack);
}

static void
test_is_lit(void **state)
{
	struct spec_stack stack = dispersive_stack(2, 5, 0, 0.1, 1);

	(void)state;
	assert_true(spec_stack_is_lit(&stack));
	stack.k[4] = 1e-9;
	assert_false(spec_stack_is_lit(&stack));
	stack.k[4] = 0;
	stack.n[4] = 0;
	assert_false(spec_stack_is_lit(&stack));
	stack.n[4] = NAN;
	assert_false(spec_stack_is_lit(&stack));
	stack.n[4] = 1;
	assert_true(spec_stack_is_lit(&stack));
	spec_stack_free(&stack);
}

static void
test_no_room(void **state)
{
	struct spec_stack stack;
	struct spec_error error;

	(void)state;
	assert_int_equal(spec_stack_new(SIZE_MAX, 1, &stack, &error), SPEC_ENOMEM);
	assert_null(stack.n);
	assert_int_equal(spec_stack_new(1, SIZE_MAX / 8, &stack, &error), SPEC_ENOMEM);
	assert_null(stack.thickness_nm);
	spec_stack_free(&stack);
}

int
main(void)
{
	const struct CMUnitTest tests[] = {
		cmocka_unit_test(test_published),
		cmocka_unit_test(test_opaque_layer),
		cmocka_unit_test(test_bare_surface),
		cmocka_unit_test(test_quarter_wave),
		cmocka_unit_test(test_absentees),
		cmocka_unit_test(test_v_coat),
		cmocka_unit_test(test_mirror),
		cmocka_unit_test(test_airy),
		cmocka_unit_test(test_frustrated_reflection),
		cmocka_unit_test(test_matched_absorber),
		cmocka_unit_test(test_thick_metal),
		cmocka_unit_test(test_grazing),
		cmocka_unit_test(test_critical_angle_of_a_layer),
		cmocka_unit_test(test_critical_angle_of_the_substrate),
		cmocka_unit_test(test_small_angles),
		cmocka_unit_test(test_many_layers),
		cmocka_unit_test(test_random_stacks),
		cmocka_unit_test(test_reciprocity),
		cmocka_unit_test(test_cut_layer),
		cmocka_unit_test(test_rows_and_spectra),
		cmocka_unit_test(test_spectrum),
		cmocka_unit_test(test_reverse),
		cmocka_unit_test(test_is_lit),
		cmocka_unit_test(test_no_room),
	};

	return cmocka_run_group_tests_name("optics/stack", tests, NULL, NULL);
}
