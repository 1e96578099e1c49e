/*
 * How fast the films of a row of pixels are computed, in one thread: reflectance and
 * transmittance of unpolarised light at WAVELENGTHS for PIXELS that differ in angle and in
 * the thickness of one layer, by spec_stack_row as the library has it for this processor;
 * by the same source for AVX2 alone; and, as a floor, by the recursion of Hirayama et al.
 * (2001) for one pixel after the other in C99's double complex, without vector code.
 *
 *   bench-stack [ROUNDS]            ROUNDS: 5
 *
 * Prints lines "what value unit". vector: the width of the registers that the library
 * picks. The others are rates, "layers-N-..." for N layers that all absorb and "film-..."
 * for one clear layer. Processor time is taken, not wall time, the least of the rounds,
 * in which all take turns.
 */
#include "stack-avx2.h"

#include <complex.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <time.h>

#define PI 3.14159265358979323846

enum { WAVELENGTHS = 81, PIXELS = 1920 };

typedef void row_function(const struct spec_stack *stack, size_t wavelength,
	const double *cosine, const double *varied_nm, size_t count,
	enum spec_polarisation polarisation, double *reflectance, double *transmittance);

/* A stack and what computes a row of it. */
struct contest {
	const char *name;
	size_t layers;
	int absorbs;
	row_function *row;
	struct spec_stack stack;
	double least_s;
};

struct scene {
	double cosine[PIXELS], varied_nm[PIXELS];
	double reflectance[PIXELS], transmittance[PIXELS];
};

static _Noreturn void
die(const char *message)
{
	fprintf(stderr, "bench-stack: %s\n", message);
	exit(2);
}

static double complex
index_of(const struct spec_stack *stack, size_t medium, size_t wavelength)
{
	size_t at = medium * stack->wavelengths + wavelength;

	return stack->n[at] + I * stack->k[at];
}

/* From a medium 1 into a medium 2; eta: n cos(theta) for s light, n / cos(theta) for p. */
static void
cross_boundary(double complex eta1, double complex eta2, double complex wave,
	double complex *r, double complex *t)
{
	double complex boundary = (eta1 - eta2) / (eta1 + eta2);
	double complex square = wave * wave;
	double complex inverse = 1 / (1 + boundary * *r * square);

	*t = (1 + boundary) * *t * wave * inverse;
	*r = (boundary + *r * square) * inverse;
}

static void
cross_pixel(const struct spec_stack *stack, size_t wavelength, double cosine,
	double varied_nm, int is_p, double *reflectance, double *transmittance)
{
	double along = stack->n[wavelength] * sqrt(1 - cosine * cosine);
	double complex r = 0, t = 1, behind = 0, last = 0, wave = 1;

	for (size_t medium = stack->layers + 2; medium-- > 0;) {
		double complex n = index_of(stack, medium, wavelength);
		double complex q = csqrt(n * n - along * along);
		double complex eta = is_p ? n * n / q : q;
		double d = medium == stack->varied ? varied_nm : 0;

		if (medium == stack->layers + 1)
			last = eta;
		else
			cross_boundary(eta, behind, wave, &r, &t);
		behind = eta;
		if (medium == 0 || medium == stack->layers + 1)
			continue;
		if (medium != stack->varied)
			d = stack->thickness_nm[medium - 1];
		wave = cexp(I * (2 * PI / stack->wavelength_nm[wavelength] * d) * q);
	}
	*reflectance += (creal(r) * creal(r) + cimag(r) * cimag(r)) / 2;
	*transmittance += (creal(t) * creal(t) + cimag(t) * cimag(t)) / 2 * creal(last) /
			  creal(behind);
}

static void
plain_row(const struct spec_stack *stack, size_t wavelength, const double *cosine,
	const double *varied_nm, size_t count, enum spec_polarisation polarisation,
	double *reflectance, double *transmittance)
{
	(void)polarisation;
	for (size_t i = 0; i < count; i++) {
		reflectance[i] = transmittance[i] = 0;
		for (int is_p = 0; is_p < 2; is_p++)
			cross_pixel(stack, wavelength, cosine[i], varied_nm[i], is_p,
				&reflectance[i], &transmittance[i]);
	}
}

/* Air, layers that alternate between two indices with some dispersion, glass. */
static void
make_stack(struct contest *contest)
{
	struct spec_stack *stack = &contest->stack;

	if (spec_stack_new(contest->layers, WAVELENGTHS, stack, NULL) != SPEC_OK)
		die("out of memory");
	stack->varied = 1;
	for (size_t i = 0; i < contest->layers; i++)
		stack->thickness_nm[i] = 40 + 7 * (double)i;
	for (size_t i = 0; i < WAVELENGTHS; i++) {
		double wavelength_nm = 380 + 5 * (double)i;

		stack->wavelength_nm[i] = wavelength_nm;
		for (size_t medium = 0; medium < contest->layers + 2; medium++) {
			size_t at = medium * WAVELENGTHS + i;

			stack->n[at] = medium % 2 ? 1.38 : 2.3 + 40 / wavelength_nm;
			if (contest->absorbs)
				stack->k[at] = medium % 2 ? 0.001 : 0.1;
		}
		stack->n[i] = 1;
		stack->k[i] = 0;
		stack->n[(contest->layers + 1) * WAVELENGTHS + i] = 1.52;
		stack->k[(contest->layers + 1) * WAVELENGTHS + i] = 0;
	}
}

static void
make_scene(struct scene *scene)
{
	for (size_t i = 0; i < PIXELS; i++) {
		scene->cosine[i] = 1 - 0.9 * (double)i / PIXELS;
		scene->varied_nm[i] = 200 + 500 * (double)(i * 7 % PIXELS) / PIXELS;
	}
}

static double
seconds(void)
{
	struct timespec now;

	clock_gettime(CLOCK_THREAD_CPUTIME_ID, &now);
	return (double)now.tv_sec + 1e-9 * (double)now.tv_nsec;
}

static void
run_round(struct contest *contest, struct scene *scene)
{
	double start = seconds(), taken;

	for (size_t i = 0; i < WAVELENGTHS; i++)
		contest->row(&contest->stack, i, scene->cosine, scene->varied_nm, PIXELS,
			SPEC_POLARISATION_NONE, scene->reflectance, scene->transmittance);
	taken = seconds() - start;
	if (contest->least_s == 0 || taken < contest->least_s)
		contest->least_s = taken;
}

/* They compute the same, or their rates mean nothing. */
static void
check(struct contest *contest, struct scene *scene)
{
	static double reflectance[PIXELS], transmittance[PIXELS];

	contest->row(&contest->stack, WAVELENGTHS / 2, scene->cosine, scene->varied_nm,
		PIXELS, SPEC_POLARISATION_NONE, scene->reflectance, scene->transmittance);
	plain_row(&contest->stack, WAVELENGTHS / 2, scene->cosine, scene->varied_nm, PIXELS,
		SPEC_POLARISATION_NONE, reflectance, transmittance);
	for (size_t i = 0; i < PIXELS; i++) {
		if (!(fabs(scene->reflectance[i] - reflectance[i]) < 1e-9 &&
			    fabs(scene->transmittance[i] - transmittance[i]) < 1e-9))
			die("the results differ");
	}
}

static int
vector_bits(void)
{
#if HAS_AVX2_STACK
	if (__builtin_cpu_supports("x86-64-v4"))
		return 512;
	return __builtin_cpu_supports("x86-64-v3") ? 256 : 128;
#else
	return 0;
#endif
}

int
main(int argc, char **argv)
{
	struct contest contests[] = {
		{.name = "layers-8-library", 8, 1, spec_stack_row},
		{.name = "layers-16-library", 16, 1, spec_stack_row},
		{.name = "film-library", 1, 0, spec_stack_row},
		{.name = "layers-8-plain", 8, 1, plain_row},
		{.name = "film-plain", 1, 0, plain_row},
#if HAS_AVX2_STACK
		{.name = "layers-8-avx2", 8, 1, avx2_stack_row},
		{.name = "layers-16-avx2", 16, 1, avx2_stack_row},
		{.name = "film-avx2", 1, 0, avx2_stack_row},
#endif
	};
	size_t count = sizeof contests / sizeof *contests;
	int rounds = argc > 1 ? atoi(argv[1]) : 5, bits = vector_bits();
	static struct scene scene;

	if (argc > 2 || rounds < 1)
		die("usage: bench-stack [ROUNDS]");
	if (bits < 256 && HAS_AVX2_STACK)
		count -= 3;
	make_scene(&scene);
	for (size_t i = 0; i < count; i++) {
		make_stack(&contests[i]);
		check(&contests[i], &scene);
	}
	for (int round = 0; round < rounds; round++) {
		for (size_t i = 0; i < count; i++)
			run_round(&contests[i], &scene);
	}
	printf("vector %d bit\n", bits);
	for (size_t i = 0; i < count; i++) {
		double work = (double)contests[i].layers * WAVELENGTHS * PIXELS;

		printf("%s %.3g layer*wavelength*pixel/s\n", contests[i].name,
			work / contests[i].least_s);
		spec_stack_free(&contests[i].stack);
	}
	return 0;
}
