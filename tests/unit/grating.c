/* lib/optics/grating: where orders go, and how much light goes there. */
#include <math.h>

#include "optics/grating.h"

#include "check.h"
#include "random.h"

#define PI 3.14159265358979323846
#define DEGREE (PI / 180)

/* A unit vector above the surface. */
static void
random_direction(uint64_t *seed, double direction[3])
{
	double z = random_in(seed, 0, 1), turn = random_in(seed, 0, 2 * PI);

	direction[0] = sqrt(1 - z * z) * cos(turn);
	direction[1] = sqrt(1 - z * z) * sin(turn);
	direction[2] = z;
}

/* A CD under a lamp right above it, in the light of a green laser. */
static void
test_disc_angles(void **state)
{
	static const double overhead[3] = {0, 0, 1};
	static const double angle[3] = {19.42, 41.68, 85.95}; /* [degrees], to .005 */
	double out[3];

	(void)state;
	for (int m = 1; m <= 3; m++) {
		assert_true(spec_grating_direction(overhead, m, 532, 1600, out));
		near(atan2(out[1], out[2]) / DEGREE, angle[m - 1], .005, "angle");
		near(out[0], 0, 0, "x");
		assert_true(spec_grating_direction(overhead, -m, 532, 1600, out));
		near(atan2(-out[1], out[2]) / DEGREE, angle[m - 1], .005, "other side");
	}
	assert_false(spec_grating_direction(overhead, 4, 532, 1600, out));
}

/* Order 3 is there up to a third of the pitch, where it grazes the disc. */
static void
test_last_wavelength(void **state)
{
	static const double overhead[3] = {0, 0, 1};
	double out[3], limit = 1600. / 3;
	int lowest, highest;

	(void)state;
	assert_true(spec_grating_direction(overhead, 3, 533, 1600, out));
	assert_false(spec_grating_direction(overhead, 3, 534, 1600, out));
	assert_true(spec_grating_direction(overhead, 3, limit, 1600, out));
	near(out[1], 1, 0, "y of grazing light");
	near(out[2], 0, 0, "z of grazing light");
	spec_grating_orders(overhead, limit, 1600, &lowest, &highest);
	assert_int_equal(lowest, -3);
	assert_int_equal(highest, 3);
	spec_grating_orders(overhead, limit + 1e-9, 1600, &lowest, &highest);
	assert_int_equal(lowest, -2);
	assert_int_equal(highest, 2);
}

/* Evanescent light has no direction, and none is written. */
static void
test_evanescent(void **state)
{
	const double slanting[3] = {.6, 0, .8};
	double out[3] = {7, 8, 9};

	(void)state;
	/* The cone has a radius of .8: y = .8125 does not fit, .78125 does. */
	assert_false(spec_grating_direction(slanting, 1, 1300, 1600, out));
	near(out[0] + out[1] + out[2], 24, 0, "left alone");
	assert_true(spec_grating_direction(slanting, 1, 1250, 1600, out));
	near(out[2], sqrt(.64 - .78125 * .78125), 1e-15, "z");
}

/* All orders of a lamp lie on one cone around the grooves, and obey the equation. */
static void
test_cone(void **state)
{
	uint64_t seed = 1;
	int found = 0;

	(void)state;
	for (int i = 0; i < 2000; i++) {
		double in[3], out[3], back[3], nm = random_in(&seed, 200, 2000);
		double pitch_nm = random_in(&seed, 300, 3000);
		int m = (int)random_in(&seed, -6, 7);

		random_direction(&seed, in);
		if (!spec_grating_direction(in, m, nm, pitch_nm, out))
			continue;
		found++;
		near(out[0], -in[0], 0, "along the grooves");
		/* Numbers up to 6 * 2000 / 300 are subtracted: one rounding of 40. */
		near(in[1] + out[1], m * nm / pitch_nm, 1e-14, "across");
		/* ... whose square enters z^2; and the lamp's own length, 1e-16. */
		near(out[0] * out[0] + out[1] * out[1] + out[2] * out[2], 1, 1e-14, "unit");
		assert_true(out[2] >= 0);
		/* Light takes the same way back, in the same order. */
		if (out[2] < 1e-4)
			continue;
		assert_true(spec_grating_direction(out, m, nm, pitch_nm, back));
		near(back[0], in[0], 0, "back, x");
		near(back[1], in[1], 1e-14, "back, y");
		near(back[2] * back[2], in[2] * in[2], 4e-14, "back, z");
	}
	assert_true(found > 500);
}

/* Order 0 is the mirror, also for light that grazes. */
static void
test_mirror(void **state)
{
	uint64_t seed = 2;

	(void)state;
	for (int i = 0; i < 1000; i++) {
		double in[3], out[3];
		int lowest, highest;

		random_direction(&seed, in);
		if (i % 2)
			in[2] = 0;
		assert_true(spec_grating_direction(in, 0, 500, 1600, out));
		near(out[0], -in[0], 0, "x");
		near(out[1], -in[1], 0, "y");
		near(out[2], in[2], 0, "z");
		/* A pitch of a tenth of the wavelength leaves nothing else. */
		spec_grating_orders(in, 500, 50, &lowest, &highest);
		assert_int_equal(lowest, 0);
		assert_int_equal(highest, 0);
	}
}

/* Littrow: at sin(angle) = m wavelength / (2 pitch) order m goes back to the lamp. */
static void
test_littrow(void **state)
{
	(void)state;
	for (int m = -5; m <= 5; m++) {
		double y = m * 532 / (2 * 1600.), out[3];
		double in[3] = {0, y, sqrt(1 - y * y)};
		double aside[3] = {.3, y, sqrt(1 - .09 - y * y)};

		assert_true(spec_grating_direction(in, m, 532, 1600, out));
		near(out[1], in[1], 3e-16, "y"); /* one rounding of 2 y < 2 */
		near(out[2], in[2], 1e-15, "z");
		/* A lamp aside gets its light back across the grooves alone. */
		assert_true(spec_grating_direction(aside, m, 532, 1600, out));
		near(out[0], -.3, 0, "aside, x");
		near(out[1], aside[1], 3e-16, "aside, y");
		near(out[2], aside[2], 1e-15, "aside, z");
	}
}

/* The range of orders is that of trying them all, and has no gaps. */
static void
test_orders(void **state)
{
	uint64_t seed = 3;

	(void)state;
	for (int i = 0; i < 1000; i++) {
		double in[3], out[3], nm = random_in(&seed, 200, 2000);
		double pitch_nm = random_in(&seed, 100, 10000);
		int lowest, highest;

		random_direction(&seed, in);
		spec_grating_orders(in, nm, pitch_nm, &lowest, &highest);
		for (int m = -110; m <= 110; m++)
			assert_int_equal(spec_grating_direction(in, m, nm, pitch_nm, out),
				m >= lowest && m <= highest);
	}
}

static void
test_phase(void **state)
{
	(void)state;
	/* A quarter of a wave deep, in the layer: half a turn. */
	near(spec_grating_phase(780 / (4 * 1.58), 1.58, 780), PI, 1e-15, "quarter");
	near(spec_grating_phase(125, 1.58, 550), 4 * PI * 1.58 * 125 / 550, 1e-15, "pit");
	near(spec_grating_phase(0, 1.58, 550), 0, 0, "flat");
}

static void
test_known_efficiencies(void **state)
{
	(void)state;
	/* Half of the pitch, half a turn: a square wave of -1 and 1. */
	near(spec_grating_lamellar(.5, PI, 0), 0, 1e-31, "square 0");
	for (int m = 1; m <= 9; m += 2) {
		near(spec_grating_lamellar(.5, PI, m), 4 / (PI * PI * m * m), 1e-16,
			"square, odd");
		near(spec_grating_lamellar(.5, PI, m + 1), 0, 0, "square, even");
	}
	/* No pits, nothing but pits, pits of no depth, and of a whole wave: a mirror. */
	for (int m = -3; m <= 3; m++) {
		near(spec_grating_lamellar(0, 2, m), m == 0, 0, "no pits");
		near(spec_grating_lamellar(1, 2, m), m == 0, 0, "all pits");
		near(spec_grating_lamellar(.375, 0, m), m == 0, 0, "flat");
		near(spec_grating_lamellar(.375, 2 * PI, m), m == 0, 1e-31, "one wave");
	}
	/* The CD at 550 nm: sin^2(4.5125 / 2) = (1 - cos 4.5125) / 2 = .5992803. */
	near(spec_grating_lamellar(.375, 4.5125, 0), 1 - .9375 * .5992803, 1e-7, "cd 0");
}

/* |c_m|^2 of the profile's Fourier series, the integral by Simpson's rule. */
static double
series_power(double q, double phi, int m)
{
	enum { STEPS = 2000 };
	double real = 0, imaginary = 0;

	for (int i = 0; i <= STEPS; i++) {
		double weight = i == 0 || i == STEPS ? 1 : i % 2 ? 4 : 2;
		double turn = 2 * PI * m * q * i / STEPS;

		/* What the pits reflect besides the land's 1, turned by -turn. */
		real += weight * (cos(phi - turn) - cos(turn));
		imaginary += weight * (sin(phi - turn) + sin(turn));
	}
	real = real * q / (3 * STEPS) + (m == 0);
	imaginary *= q / (3 * STEPS);
	return real * real + imaginary * imaginary;
}

static void
test_efficiencies(void **state)
{
	uint64_t seed = 4;

	(void)state;
	for (int i = 0; i < 200; i++) {
		double q = random_in(&seed, 0, 1), phi = random_in(&seed, -20, 20);

		for (int m = -5; m <= 5; m++) {
			double got = spec_grating_lamellar(q, phi, m);

			/* Simpson: (2 pi 5)^4 / (180 * 2000^4) = 3e-10, twice |c_m| < 2. */
			near(got, series_power(q, phi, m), 2e-9, "series");
			near(spec_grating_lamellar(q, phi, -m), got, 0, "symmetric");
			assert_true(got >= 0 && got <= 1);
		}
	}
}

/* They sum to 1: what a sum up to order M misses is below 2 (4 / pi^2) / M. */
static void
test_sum(void **state)
{
	enum { M = 20000 };
	uint64_t seed = 5;

	(void)state;
	for (int i = 0; i < 50; i++) {
		double q = random_in(&seed, 0, 1), phi = random_in(&seed, 0, 20);
		double sum = spec_grating_lamellar(q, phi, 0), s = sin(phi / 2);
		double bound = 8 * s * s / (PI * PI * M);

		for (int m = M; m >= 1; m--)
			sum += 2 * spec_grating_lamellar(q, phi, m);
		/* 1e-12: as many roundings as terms. */
		near(1 - sum, bound / 2, bound / 2 + 1e-12, "missing");
	}
}

int
main(void)
{
	const struct CMUnitTest tests[] = {
		cmocka_unit_test(test_disc_angles),
		cmocka_unit_test(test_last_wavelength),
		cmocka_unit_test(test_evanescent),
		cmocka_unit_test(test_cone),
		cmocka_unit_test(test_mirror),
		cmocka_unit_test(test_littrow),
		cmocka_unit_test(test_orders),
		cmocka_unit_test(test_phase),
		cmocka_unit_test(test_known_efficiencies),
		cmocka_unit_test(test_efficiencies),
		cmocka_unit_test(test_sum),
	};

	return cmocka_run_group_tests(tests, NULL, NULL);
}
