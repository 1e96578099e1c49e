/*
 * Reflection at one boundary: the values where a closed form is simple, and everywhere else
 * the complex formulas in long double, 2048 times as fine as what they are compared with.
 */
#include <complex.h>
#include <float.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "optics/fresnel.h"

#include "check.h"
#include "random.h"

#define ULP DBL_EPSILON /* of 1 */
#define DEGREE (3.14159265358979323846 / 180)

enum { RANDOM = 20000 };

struct amplitudes {
	long double complex s, p;
};

/* Born & Wolf 1.5.2 (21a) with a complex index behind the boundary. */
static struct amplitudes
exact(double cosine, double n1, double n2, double k2)
{
	long double c = cosine, along = n1 * sqrtl((1 - c) * (1 + c));
	long double complex n = n2 + I * (long double)k2;
	long double complex q = csqrtl((n - along) * (n + along));

	return (struct amplitudes){
		(n1 * c - q) / (n1 * c + q), (n * n * c - n1 * q) / (n * n * c + n1 * q)};
}

static long double
power(long double complex amplitude)
{
	return creall(amplitude) * creall(amplitude) +
	       cimagl(amplitude) * cimagl(amplitude);
}

static const double indices[] = {0.2, 0.9, 1, 1.000277, 1.33, 1.5, 1.52, 2.4, 4.1};

enum { INDICES = sizeof indices / sizeof *indices };

/* Two roundings of the quotient and one of each term, then squared. */
static void
test_normal_incidence(void **state)
{
	(void)state;
	for (size_t i = 0; i < INDICES; i++) {
		for (size_t j = 0; j < INDICES; j++) {
			double n1 = indices[i], n2 = indices[j];
			double r = (n1 - n2) / (n1 + n2), wanted = r * r;
			struct spec_fresnel got = spec_fresnel_dielectric(1, n1, n2);

			near(got.s, wanted, 8 * ULP * wanted, "s");
			near(got.p, wanted, 8 * ULP * wanted, "p");
		}
	}
	near(spec_fresnel_dielectric(1, 1, 1.5).s, 0.04, 8 * ULP, "air to glass");
}

/* ((n - n1)^2 + k^2) / ((n + n1)^2 + k^2), with about ten roundings of positive terms. */
static void
test_normal_incidence_on_a_metal(void **state)
{
	static const double metals[][2] = {
		{0.05, 4}, {0.2, 3.4}, {1.4, 7.6}, {3, 3}, {0, 2}, {4, 0.03}};

	(void)state;
	for (size_t i = 0; i < sizeof metals / sizeof *metals; i++) {
		for (size_t j = 0; j < INDICES; j++) {
			double n1 = indices[j], n = metals[i][0], k = metals[i][1];
			double wanted = ((n - n1) * (n - n1) + k * k) /
					((n + n1) * (n + n1) + k * k);
			struct spec_fresnel got = spec_fresnel_conductor(1, n1, n, k);

			near(got.s, wanted, 16 * ULP * wanted, "s");
			near(got.p, wanted, 16 * ULP * wanted, "p");
		}
	}
}

/*
 * The amplitude is a difference of terms that are some ulp off, and comes squared. Into a
 * thin medium the angle is small: an ulp of its cosine is (n1 / n2)^2 ulp of its sine
 * squared, and there as many of the square of the cosine inside.
 */
static void
test_brewster(void **state)
{
	(void)state;
	for (size_t i = 0; i < INDICES; i++) {
		for (size_t j = 0; j < INDICES; j++) {
			double n1 = indices[i], n2 = indices[j], ratio = n1 / n2;
			double cosine = n1 / hypot(n1, n2);
			double off = 4 * ULP * (1 + pow(ratio, 4));
			double r = (ratio * ratio - 1) / (ratio * ratio + 1);

			near(spec_fresnel_dielectric(cosine, n1, n2).p, 0, off * off, "p");
			near(spec_fresnel_conductor(cosine, n1, n2, 0).p, 0, off * off,
				"p, conductor");
			near(spec_fresnel_dielectric(cosine, n1, n2).s, r * r, 2 * off,
				"s");
		}
	}
}

/* At 45 degrees the reflectance of p light is the square of that of s light (Abeles). */
static void
test_abeles(void **state)
{
	(void)state;
	for (size_t i = 2; i < INDICES; i++) {
		struct spec_fresnel got = spec_fresnel_dielectric(sqrt(0.5), 1, indices[i]);
		struct spec_fresnel metal =
			spec_fresnel_conductor(sqrt(0.5), 1, 0.1 + (double)i, 3);

		near(got.p, got.s * got.s, 8 * ULP, "dielectric");
		near(metal.p, metal.s * metal.s, 16 * ULP, "metal");
	}
}

/*
 * All is reflected from the critical angle on. On it the sine inside is 1 but for an ulp or
 * two, so that the cosine inside is at most sqrt(4 ulp) and the reflectance lacks
 * 4 cosine inside n2 / (n1 cosine), and for p light (n1 / n2)^2 times that.
 */
static void
test_critical_angle(void **state)
{
	(void)state;
	for (size_t i = 0; i < INDICES; i++) {
		for (size_t j = 0; j < i; j++) {
			double n1 = indices[i], n2 = indices[j], ratio = n2 / n1;
			double cosine = sqrt((1 - ratio) * (1 + ratio));
			double lack = 8 * sqrt(4 * ULP) / (ratio * ratio * cosine);
			double above = 1e-3 * cosine, below = 1e-3 * (1 - cosine);
			struct spec_fresnel got;
			struct amplitudes wanted;

			got = spec_fresnel_dielectric(cosine, n1, n2);
			near(got.s, 1, lack, "s at the critical angle");
			near(got.p, 1, lack, "p at the critical angle");
			assert_true(got.s <= 1 && got.p <= 1);
			got = spec_fresnel_dielectric(cosine - above, n1, n2);
			near(got.s, 1, 0, "s above the critical angle");
			near(got.p, 1, 0, "p above the critical angle");
			got = spec_fresnel_dielectric(cosine + below, n1, n2);
			wanted = exact(cosine + below, n1, n2, 0);
			/* The cosine inside, about sqrt(below), has the error ulp / it. */
			lack = 16 * ULP / (sqrt(below) * ratio * ratio * cosine);
			near(got.s, (double)power(wanted.s), lack, "s below");
			near(got.p, (double)power(wanted.p), lack, "p below");
			assert_true(got.s < 1 && got.p < 1);
		}
	}
}

/* Whatever lies behind the boundary, the same medium included. */
static void
test_grazing(void **state)
{
	static const double k[] = {0, 1e-9, 0.5, 9};

	(void)state;
	for (size_t i = 0; i < INDICES; i++) {
		for (size_t j = 0; j < INDICES; j++) {
			struct spec_fresnel got =
				spec_fresnel_dielectric(0, indices[i], indices[j]);

			near(got.s, 1, 0, "s");
			near(got.p, 1, 0, "p");
			for (size_t m = 0; m < sizeof k / sizeof *k; m++) {
				got = spec_fresnel_conductor(
					0, indices[i], indices[j], k[m]);
				near(got.s, 1, 0, "s on a conductor");
				near(got.p, 1, 0, "p on a conductor");
			}
		}
	}
}

/*
 * Stokes: the same from both sides, at the angles of one ray. The cosine inside is rounded
 * to an ulp of 1, from which the way back makes an error of the cosine outside of some ulp
 * / cosine; the reflectance moves by at most 4 n / cosine times that.
 */
static void
test_stokes(void **state)
{
	(void)state;
	for (int angle = 0; angle <= 85; angle++) {
		double cosine = cos(angle * DEGREE), sine = sin(angle * DEGREE);

		for (size_t i = 0; i < INDICES; i++) {
			for (size_t j = i; j < INDICES; j++) {
				double n1 = indices[i], n2 = indices[j];
				double inside = sqrt(1 - n1 / n2 * sine * (n1 / n2 * sine));
				double tolerance = 16 * ULP * n2 / n1 / (cosine * cosine);
				struct spec_fresnel in, out;

				in = spec_fresnel_dielectric(cosine, n1, n2);
				out = spec_fresnel_dielectric(inside, n2, n1);
				near(in.s, out.s, tolerance, "s");
				near(in.p, out.p, tolerance, "p");
			}
		}
	}
}

/*
 * What the exact reflectance moves by where every number is off by an ulp, per ulp: near a
 * critical angle of a medium that hardly absorbs that is much more than the reflectance.
 */
static struct spec_fresnel
sensitivity(double cosine, double n1, double n2, double k2)
{
	static const double step = 0x1p-30;
	struct amplitudes here = exact(cosine, n1, n2, k2);
	struct amplitudes index = exact(cosine, n1, n2 * (1 + step), k2);
	struct amplitudes absorption = exact(cosine, n1, n2, k2 * (1 + step));
	struct amplitudes angle = exact(cosine * (1 - step), n1, n2, k2);
	long double s = cabsl(index.s - here.s) + cabsl(absorption.s - here.s) +
			cabsl(angle.s - here.s);
	long double p = cabsl(index.p - here.p) + cabsl(absorption.p - here.p) +
			cabsl(angle.p - here.p);

	return (struct spec_fresnel){(double)s / step, (double)p / step};
}

/*
 * |r|^2 where r, a difference of numbers below 1, is off by 2 ulp of 1, by 16 ulp of itself
 * and by what 16 ulp of its parts make of it.
 */
static void
near_power(double got, long double complex amplitude, double moved, const char *what)
{
	double r = (double)cabsl(amplitude), off = 2 * ULP + 16 * ULP * (r + moved);

	near(got, (double)power(amplitude), 2 * r * off + off * off, what);
}

static void
test_conductor(void **state)
{
	uint64_t seed = 1;

	(void)state;
	for (int i = 0; i < RANDOM; i++) {
		double n1 = random_between(&seed, 0.5, 4);
		double n2 = random_between(&seed, 0.02, 8);
		double k2 = random_between(&seed, 1e-5, 12);
		double cosine = cos(random_share(&seed) * 90 * DEGREE);
		struct spec_fresnel got = spec_fresnel_conductor(cosine, n1, n2, k2);
		struct spec_fresnel moved = sensitivity(cosine, n1, n2, k2);
		struct amplitudes wanted = exact(cosine, n1, n2, k2);

		near_power(got.s, wanted.s, moved.s, "s");
		near_power(got.p, wanted.p, moved.p, "p");
		assert_true(got.s >= 0 && got.s <= 1 && got.p >= 0 && got.p <= 1);
	}
}

/* The same but for rounding; beyond the critical angle both are exactly 1. */
static void
test_conductor_that_conducts_not(void **state)
{
	uint64_t seed = 2;

	(void)state;
	for (int i = 0; i < RANDOM; i++) {
		double n1 = random_between(&seed, 0.5, 4);
		double n2 = random_between(&seed, 0.5, 4);
		double cosine = cos(random_share(&seed) * 90 * DEGREE);
		double sine = n1 / n2 * sqrt((1 - cosine) * (1 + cosine));
		struct spec_fresnel a = spec_fresnel_dielectric(cosine, n1, n2);
		struct spec_fresnel b = spec_fresnel_conductor(cosine, n1, n2, 0);
		struct spec_fresnel moved;
		struct amplitudes wanted;

		if (sine > 1 + 4 * ULP) {
			near(a.s, 1, 0, "s, dielectric");
			near(a.p, 1, 0, "p, dielectric");
			near(b.s, 1, 0, "s, conductor");
			near(b.p, 1, 0, "p, conductor");
		} else if (sine < 1 - 1e-6) { /* a step of sensitivity() stays below 1 */
			moved = sensitivity(cosine, n1, n2, 0);
			wanted = exact(cosine, n1, n2, 0);
			near_power(a.s, wanted.s, moved.s, "s, dielectric");
			near_power(a.p, wanted.p, moved.p, "p, dielectric");
			near_power(b.s, wanted.s, moved.s, "s, conductor");
			near_power(b.p, wanted.p, moved.p, "p, conductor");
		}
	}
}

/* A plasma below its frequency: n = 0. Nothing can get in. */
static void
test_imaginary_index(void **state)
{
	(void)state;
	for (int angle = 0; angle <= 90; angle += 5) {
		struct spec_fresnel got =
			spec_fresnel_conductor(cos(angle * DEGREE), 1, 0, 2.5);

		near(got.s, 1, 0, "s");
		near(got.p, 1, 0, "p");
	}
}

/* Square roots and quotients are rounded alike in vectors and alone: the bits agree. */
static void
test_spectrum(void **state)
{
	enum { MOST = 300 };
	static const size_t counts[] = {1, 2, 7, 8, 9, 81, MOST};
	double n1[MOST], n2[MOST], k2[MOST], s[MOST], p[MOST];
	uint64_t seed = 3;

	(void)state;
	for (size_t i = 0; i < MOST; i++) {
		n1[i] = random_between(&seed, 1, 2);
		n2[i] = random_between(&seed, 0.05, 5);
		k2[i] = i % 3 ? random_between(&seed, 1e-4, 8) : 0;
	}
	for (size_t j = 0; j < sizeof counts / sizeof *counts; j++) {
		double cosine = 1 - 0.15 * (double)j;

		spec_fresnel_spectrum(cosine, n1, n2, k2, counts[j], s, p);
		for (size_t i = 0; i < counts[j]; i++) {
			struct spec_fresnel one =
				spec_fresnel_conductor(cosine, n1[i], n2[i], k2[i]);

			near(s[i], one.s, 0, "s");
			near(p[i], one.p, 0, "p");
		}
	}
}

static void
test_polarisation(void **state)
{
	static const char *const wrong[] = {"", "x", "S", "sp", "unpolarised"};
	enum spec_polarisation polarisation;
	struct spec_fresnel value = {0.75, 0.25};
	struct spec_error error;

	(void)state;
	assert_int_equal(spec_polarisation_parse("u", &polarisation, &error), SPEC_OK);
	near(spec_fresnel_mean(value, polarisation), 0.5, 0, "u");
	assert_int_equal(spec_polarisation_parse("s", &polarisation, &error), SPEC_OK);
	near(spec_fresnel_mean(value, polarisation), 0.75, 0, "s");
	assert_int_equal(spec_polarisation_parse("p", &polarisation, &error), SPEC_OK);
	near(spec_fresnel_mean(value, polarisation), 0.25, 0, "p");
	for (size_t i = 0; i < sizeof wrong / sizeof *wrong; i++) {
		assert_int_equal(spec_polarisation_parse(wrong[i], &polarisation, &error),
			SPEC_EUSAGE);
		assert_non_null(strstr(error.message, wrong[i]));
		assert_int_equal(polarisation, SPEC_POLARISATION_P);
	}
}

int
main(void)
{
	const struct CMUnitTest tests[] = {
		cmocka_unit_test(test_normal_incidence),
		cmocka_unit_test(test_normal_incidence_on_a_metal),
		cmocka_unit_test(test_brewster),
		cmocka_unit_test(test_abeles),
		cmocka_unit_test(test_critical_angle),
		cmocka_unit_test(test_grazing),
		cmocka_unit_test(test_stokes),
		cmocka_unit_test(test_conductor),
		cmocka_unit_test(test_conductor_that_conducts_not),
		cmocka_unit_test(test_imaginary_index),
		cmocka_unit_test(test_spectrum),
		cmocka_unit_test(test_polarisation),
	};

	return cmocka_run_group_tests_name("optics/fresnel", tests, NULL, NULL);
}
