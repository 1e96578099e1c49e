/* lib/spectrum/planck: the black body. */
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdlib.h>

#include <cmocka.h>

#include "spectrum/planck.h"

#define COUNT(list) (sizeof(list) / sizeof *(list))

/* CODATA 2018, exact but for digits cut. */
#define STEFAN_BOLTZMANN 5.670374419e-8 /* W m^-2 K^-4 */
#define PI 3.14159265358979323846L

/* What the SI fixes, once more and in long double. */
static const long double h_j_s = 6.62607015e-34L, c_m_s = 299792458, k_j_k = 1.380649e-23L;

static long double
exponent(long double temperature_k, long double nm)
{
	return h_j_s * c_m_s / (nm * 1e-9L * k_j_k * temperature_k);
}

/* [W m^-2 sr^-1 nm^-1] */
static long double
radiance(long double temperature_k, long double nm)
{
	long double m = nm * 1e-9L;

	return 1e-9L * 2 * h_j_s * c_m_s * c_m_s / powl(m, 5) /
	       expm1l(exponent(temperature_k, nm));
}

static void
near(double got, long double wanted, long double tolerance, const char *what)
{
	if (!(fabsl(got - wanted) <= tolerance))
		fail_msg("%s: got %.17g, wanted %.17Lg +- %Lg", what, got, wanted,
			tolerance);
}

/* Uniform in [0, 1). */
static double
draw(void)
{
	static uint64_t state = 20190520;

	state = state * 6364136223846793005u + 1442695040888963407u;
	return (double)(state >> 11) * 0x1p-53;
}

static double
draw_log(double low, double high)
{
	return low * exp(draw() * log(high / low));
}

/* The accuracy that the header states. */
static void
planck_matches_long_double(void **state)
{
	enum { most = 37 }; /* vectors and what is left over */
	double nm[most], absolute[most], relative[most];

	(void)state;
	for (int round = 0; round < 3000; round++) {
		double temperature_k = draw_log(1, 1e8);
		long double peak =
			radiance(temperature_k, 2.897771955185172661e6L / temperature_k);

		for (int i = 0; i < most; i++)
			nm[i] = draw_log(1, 1e6);
		spec_planck_radiance(temperature_k, nm, most, absolute);
		spec_planck_relative(temperature_k, nm, most, relative);
		for (int i = 0; i < most; i++) {
			long double x = exponent(temperature_k, nm[i]);
			long double wanted = radiance(temperature_k, nm[i]);
			long double part = (12 + x) * 0x1p-52L;

			if (x > 680)
				continue;
			near(absolute[i], wanted, part * wanted, "radiance");
			near(relative[i], wanted / peak, part * wanted / peak, "relative");
			assert_true(relative[i] >= 0 && relative[i] <= 1 + 1e-14);
		}
	}
}

/* One value that everybody can check: 500 nm at 5000 K. */
static void
planck_has_its_units(void **state)
{
	const double nm[2] = {500, 1000};
	double value[2];

	(void)state;
	spec_planck_radiance(5000, nm, 2, value);
	/* The formula in python's decimal, 40 digits. */
	near(value[0], 12107.1905903981094563853L, 1e-10L, "500 nm");
	near(value[0] / value[1],
		32 * expm1l(exponent(5000, 1000)) / expm1l(exponent(5000, 500)), 1e-14L,
		"ratio");
}

static void
planck_peaks_after_wien(void **state)
{
	static const double temperature_k[] = {3, 300, 2856, 5778, 6504, 1e5};

	(void)state;
	for (size_t i = 0; i < COUNT(temperature_k); i++) {
		double peak_nm = SPEC_WIEN_NM_K / temperature_k[i];
		double nm[3] = {peak_nm * .999, peak_nm, peak_nm * 1.001}, value[3];

		spec_planck_relative(temperature_k[i], nm, 3, value);
		near(value[1], 1, 4e-15L, "peak");
		assert_true(value[0] < value[1] && value[2] < value[1]);
		/* The crest is level there: the central difference over 0.2 % is cubic. */
		assert_true(fabs(value[2] - value[0]) < 1e-7);
		spec_planck_radiance(temperature_k[i], nm, 3, value);
		assert_true(value[0] < value[1] && value[2] < value[1]);
	}
}

/* From 1 nm to 1 mm; what is beyond is a part below 2e-7 of it from 1000 K on. */
static void
planck_integrates_to_stefan_boltzmann(void **state)
{
	enum { bins = 600 };
	static const double temperature_k[] = {1000, 2856, 6504, 20000, 1e5};
	double edge_nm[bins + 1], mean[bins];

	(void)state;
	for (int i = 0; i <= bins; i++)
		edge_nm[i] = pow(10, 6. * i / bins);
	for (size_t k = 0; k < COUNT(temperature_k); k++) {
		double t = temperature_k[k], sum = 0;
		double wanted = STEFAN_BOLTZMANN * t * t * t * t / (double)PI;

		spec_planck_radiance_mean(t, edge_nm, bins, mean);
		for (int i = 0; i < bins; i++)
			sum += mean[i] * (edge_nm[i + 1] - edge_nm[i]);
		near(sum / wanted, 1, 1e-6L, "integral");
	}
}

/* The integral of t^3 / (e^t - 1) from x to infinity, term by term of 1 / (e^t - 1). */
static long double
upper_integral(long double x)
{
	long double sum = 0;

	for (long double n = 1; (n - 1) * x < 50; n++)
		sum += expl(-n * x) * (((x / n + 3 / (n * n)) * x + 6 / (n * n * n)) * x +
					      6 / (n * n * n * n));
	return sum;
}

/* The mean radiance between two wavelengths, in closed form but for that series. */
static long double
band_mean(long double temperature_k, long double a_nm, long double b_nm)
{
	long double hc = h_j_s * c_m_s, kt = k_j_k * temperature_k;
	long double unit = 2 * kt * (kt / hc) * (kt / hc) * (kt / hc) * c_m_s;

	return unit *
	       (upper_integral(exponent(temperature_k, b_nm)) -
		       upper_integral(exponent(temperature_k, a_nm))) /
	       (b_nm - a_nm);
}

/* The errors that the header states. */
static void
planck_means_keep_their_error(void **state)
{
	static const struct {
		double ratio, fall;
		long double error;
	} known[] = {{1.01, 4, 1e-12L}, {1.1, 4, 1e-12L}, {1.5, .2, 1e-12L},
		{1.5, 4, 1e-12L}, {1.05, 8, 1e-6L}, {3, .2, 1e-6L}, {3, 8, 1e-6L}};

	(void)state;
	for (size_t k = 0; k < COUNT(known); k++)
		for (int round = 0; round < 50; round++) {
			double a = draw_log(100, 1e5), edge_nm[2] = {a, a * known[k].ratio};
			double t = (double)(h_j_s * c_m_s / k_j_k) * 1e9 / known[k].fall *
				   (1 / a - 1 / edge_nm[1]);
			long double wanted = band_mean(t, a, edge_nm[1]);
			long double peak = radiance(t, 2.897771955185172661e6L / t);
			double mean;

			spec_planck_radiance_mean(t, edge_nm, 1, &mean);
			near((double)(mean / wanted), 1, known[k].error, "mean");
			spec_planck_relative_mean(t, edge_nm, 1, &mean);
			near((double)(mean / wanted * peak), 1, known[k].error,
				"relative mean");
		}
}

static void
planck_of_the_cold_is_zero(void **state)
{
	static const double cold_k[] = {0, 1e-320, 1e-300, 1e-30, 1e-3, 10};
	const double nm[9] = {1, 10, 100, 200, 380, 500, 780, 1000, 2000};
	double value[9];

	(void)state;
	for (size_t k = 0; k < COUNT(cold_k); k++) {
		spec_planck_radiance(cold_k[k], nm, 9, value);
		for (int i = 0; i < 9; i++)
			assert_true(value[i] == 0);
		spec_planck_relative(cold_k[k], nm, 9, value);
		for (int i = 0; i < 9; i++)
			assert_true(value[i] == 0);
		spec_planck_relative_mean(cold_k[k], nm, 8, value);
		for (int i = 0; i < 8; i++)
			assert_true(value[i] == 0);
	}
	spec_planck_radiance(NAN, nm, 9, value);
	assert_true(isnan(value[0]) && isnan(value[8]));
	spec_planck_relative(NAN, nm, 9, value);
	assert_true(isnan(value[0]) && isnan(value[8]));
}

/* Rayleigh and Jeans: 2 c k T / l^4 where h c is far below l k T. */
static void
planck_of_the_hot_is_classical(void **state)
{
	const double nm[1] = {1e6};
	double value[1];
	long double t = 1e11L, m = 1e-3L;

	(void)state;
	spec_planck_radiance((double)t, nm, 1, value);
	near((double)(value[0] / (1e-9L * 2 * c_m_s * k_j_k * t / powl(m, 4))), 1, 1e-9L,
		"classical");
}

int
main(void)
{
	const struct CMUnitTest tests[] = {
		cmocka_unit_test(planck_matches_long_double),
		cmocka_unit_test(planck_has_its_units),
		cmocka_unit_test(planck_peaks_after_wien),
		cmocka_unit_test(planck_integrates_to_stefan_boltzmann),
		cmocka_unit_test(planck_means_keep_their_error),
		cmocka_unit_test(planck_of_the_cold_is_zero),
		cmocka_unit_test(planck_of_the_hot_is_classical),
	};

	return cmocka_run_group_tests_name("planck", tests, NULL, NULL);
}
