/* lib/spectrum/spectrum, interpolate, fourier: kinds of spectra, their values and means. */
#include <stdlib.h>

#include "spectrum/fourier.h"
#include "spectrum/spectrum.h"

#include "check.h"
#include "spectra.h"

#define PI 3.141592653589793

static double
draw(void)
{
	static uint64_t state = 1880;

	state = state * 6364136223846793005u + 1442695040888963407u;
	return (double)(state >> 11) * 0x1p-53;
}

/* The integral of the smooth part, by Simpson's rule between the breaks of a table. */
static double
simpson(const struct spec_spectrum *spectrum, double a_nm, double b_nm, int steps)
{
	double sum = 0, h = (b_nm - a_nm) / steps;

	/* Just inside, for functions that jump at a or b. */
	sum += value_at(spectrum, a_nm + 1e-12 * a_nm) +
	       value_at(spectrum, b_nm - 1e-12 * b_nm);
	for (int i = 1; i < steps; i++)
		sum += (i % 2 ? 4 : 2) * value_at(spectrum, a_nm + i * h);
	return sum * h / 3;
}

static double
integral(const struct spec_spectrum *spectrum, double a_nm, double b_nm)
{
	double value;

	assert_int_equal(spec_spectrum_integral(spectrum, SPEC_EXTRAPOLATE_REFUSE, a_nm,
				 b_nm, &value, NULL),
		SPEC_OK);
	return value;
}

/* ---- interpolation ---- */

/*
 * Half-way values of this series are published in the documentation of three programs that
 * follow CIE 167:2005 (colour-science's SpragueInterpolator among them), ends included.
 */
static void
sprague_gives_published_values(void **state)
{
	static const double value[] = {5.92, 9.37, 10.8135, 4.51, 69.59, 27.8007, 86.05};
	static const double half[] = {
		7.21850256, 12.23568833, 1.66284023, 40.76525391, 51.84316346, 43.77379185};
	struct spec_spectrum spectrum;

	(void)state;
	assert_int_equal(spec_spectrum_sampled(400, 460, value, 7, SPEC_INTERPOLATE_SPRAGUE,
				 &spectrum, NULL),
		SPEC_OK);
	for (size_t i = 0; i < COUNT(value); i++)
		assert_true(value_at(&spectrum, 400 + 10 * (double)i) == value[i]);
	for (size_t i = 0; i < COUNT(half); i++)
		near(value_at(&spectrum, 405 + 10 * (double)i), half[i], 5e-9, "half-way");
	near(value_at(&spectrum, 402.5), 6.7295161, 1e-7, "a quarter");
	near(value_at(&spectrum, 407.5), 7.8140625, 1e-7, "three quarters");
	spec_spectrum_free(&spectrum);
}

/*
 * Between six samples it is exact for polynomials up to degree 4; with samples that it adds
 * at the ends, for straight lines.
 */
static void
sprague_reproduces_quartics(void **state)
{
	double value[9];
	struct spec_spectrum spectrum;

	(void)state;
	for (int degree = 0; degree <= 5; degree++) {
		double inside = 0, worst = 0;

		for (int i = 0; i < 9; i++)
			value[i] = pow(.25 * i - 1, degree);
		assert_int_equal(spec_spectrum_sampled(400, 480, value, 9,
					 SPEC_INTERPOLATE_SPRAGUE, &spectrum, NULL),
			SPEC_OK);
		for (double nm = 400; nm <= 480; nm += .7) {
			double miss = fabs(
				value_at(&spectrum, nm) - pow((nm - 440) / 40, degree));

			worst = fmax(worst, miss);
			if (nm > 420 && nm < 460)
				inside = fmax(inside, miss);
		}
		assert_true((inside < 1e-14) == (degree <= 4));
		assert_true((worst < 1e-14) == (degree <= 1));
		spec_spectrum_free(&spectrum);
	}
}

static void
neighbours_and_left_samples_hold(void **state)
{
	static const double nm[] = {400, 410, 440}, value[] = {1, 2, 4};
	static const struct {
		double nm, nearest, left, linear;
	} rows[] = {{400, 1, 1, 1}, {404, 1, 1, 1.4}, {405, 2, 1, 1.5}, {410, 2, 2, 2},
		{424, 2, 2, 2 + 14. / 15}, {425, 4, 2, 3}, {439, 4, 2, 2 + 29. / 15},
		{440, 4, 4, 4}};
	struct spec_spectrum near_by, left, linear;

	(void)state;
	spec_spectrum_tabulated(nm, value, 3, SPEC_INTERPOLATE_NEAREST, &near_by, NULL);
	spec_spectrum_tabulated(nm, value, 3, SPEC_INTERPOLATE_LEFT, &left, NULL);
	spec_spectrum_tabulated(nm, value, 3, SPEC_INTERPOLATE_LINEAR, &linear, NULL);
	for (size_t i = 0; i < COUNT(rows); i++) {
		assert_true(value_at(&near_by, rows[i].nm) == rows[i].nearest);
		assert_true(value_at(&left, rows[i].nm) == rows[i].left);
		near(value_at(&linear, rows[i].nm), rows[i].linear, 1e-15, "linear");
	}
	near(integral(&near_by, 400, 440), 5 * 1 + 20 * 2 + 15 * 4, 1e-12, "nearest");
	near(integral(&left, 400, 440), 10 * 1 + 30 * 2, 1e-12, "left");
	near(integral(&linear, 400, 440), 15 + 90, 1e-12, "linear");
	near(integral(&near_by, 402, 430), 3 * 1 + 20 * 2 + 5 * 4, 1e-12, "a part");
	spec_spectrum_free(&near_by);
	spec_spectrum_free(&left);
	spec_spectrum_free(&linear);
}

static void
interpolations_have_names(void **state)
{
	enum spec_interpolate interpolate;
	struct spec_error error;

	(void)state;
	for (int i = 0; i <= SPEC_INTERPOLATE_SPRAGUE; i++) {
		const char *name = spec_interpolate_name((enum spec_interpolate)i);

		assert_int_equal(spec_interpolate_parse(name, &interpolate, NULL), SPEC_OK);
		assert_int_equal(interpolate, i);
	}
	assert_int_equal(
		spec_interpolate_parse("cubic", &interpolate, &error), SPEC_EUSAGE);
	assert_non_null(strstr(error.message, "'cubic'"));
}

/* ---- Fourier series ---- */

/* 2 i^l j_l(x) is the integral of P_l(t) exp(ixt): here by Simpson's rule, DLMF 10.54.2. */
static void
bessel_functions_are_transforms(void **state)
{
	static const double xs[] = {0, 1e-9, .1, 1, 3.999, 4.001, 9, 40, 700};

	(void)state;
	for (size_t i = 0; i < COUNT(xs); i++) {
		double j[6], x = xs[i];

		spec_spherical_bessel(x, j);
		for (int l = 0; l < 6; l++) {
			const int steps = 20000;
			double sum = 0;

			for (int k = 0; k <= steps; k++) {
				double t = 2. * k / steps - 1, before = 1, p = t;
				double weight = k == 0 || k == steps ? 1 : k % 2 ? 4 : 2;

				for (int m = 1; m < l; m++) {
					double next = ((2 * m + 1) * t * p - m * before) /
						      (m + 1);

					before = p;
					p = next;
				}
				p = l == 0 ? 1 : p;
				sum += weight * p * (l % 2 ? sin(x * t) : cos(x * t)) *
				       ((l / 2) % 2 ? -1 : 1);
			}
			/* Simpson: (x h)^4 / 180, h = 1e-4. */
			near(j[l], sum / steps / 3, 2e-13 + pow(x * 1e-4, 4) / 90, "j_l");
		}
	}
}

/* T's figure 3.1: the box from 500 to 600 nm over 360 to 830 nm. */
#define BOX_LOW 360.
#define BOX_RANGE 470.

static void
box_series(double *coefficient, size_t count)
{
	struct spec_piece box = {500, 600, 1, {1}};

	memset(coefficient, 0, count * sizeof *coefficient);
	spec_series_add_piece(&box, BOX_LOW, BOX_LOW + BOX_RANGE, coefficient, count);
}

static void
box_has_its_coefficients(void **state)
{
	double coefficient[41];

	(void)state;
	box_series(coefficient, 41);
	near(coefficient[0], 2 * 100 / BOX_RANGE, 1e-15, "a0");
	for (int n = 1; n <= 20; n++) {
		double k = 2 * PI * n / BOX_RANGE;

		near(coefficient[2 * n - 1], (sin(k * 240) - sin(k * 140)) / (PI * n),
			1e-15, "an");
		near(coefficient[2 * n], (cos(k * 140) - cos(k * 240)) / (PI * n), 1e-15,
			"bn");
	}
}

/*
 * What T's figure 3.1b shows: nine coefficients of the box send light through a filter from
 * 600 to 830 nm that the box itself does not. The integral of T 3.1, term by term.
 */
static void
truncated_box_leaks_through_filter(void **state)
{
	double coefficient[9], leak;
	struct spec_spectrum box;

	(void)state;
	box_series(coefficient, 9);
	assert_int_equal(spec_spectrum_fourier(
				 BOX_LOW, BOX_LOW + BOX_RANGE, coefficient, 9, &box, NULL),
		SPEC_OK);
	leak = .5 * coefficient[0] * 230;
	for (int n = 1; n <= 4; n++) {
		double k = 2 * PI * n / BOX_RANGE;

		leak += coefficient[2 * n - 1] / k * (sin(k * 470) - sin(k * 240)) -
			coefficient[2 * n] / k * (cos(k * 470) - cos(k * 240));
	}
	near(integral(&box, 600, 830), leak, 1e-12, "leak");
	near(integral(&box, BOX_LOW, BOX_LOW + BOX_RANGE), 100, 1e-12, "energy");
	/* In units of the box's energy: far from nothing, as T says. */
	assert_true(leak > .02 * 100 && leak < .1 * 100);
	spec_spectrum_free(&box);
}

/* Parseval: a0^2 / 2 + sum of an^2 + bn^2 is 2 / range times the integral of S^2. */
static void
series_keep_parsevals_sum(void **state)
{
	enum { MOST = 4001 };
	static double coefficient[MOST];
	double sum;

	(void)state;
	box_series(coefficient, MOST);
	sum = .5 * coefficient[0] * coefficient[0];
	for (int i = 1; i < MOST; i++)
		sum += coefficient[i] * coefficient[i];
	/* Beyond n the rest is at most 4 / (pi^2 n). */
	near(sum, 2 / BOX_RANGE * 100, 4 / (PI * PI * 2000), "box");
	assert_true(sum < 2 / BOX_RANGE * 100);
}

/* Pieces of every degree against Simpson's rule. */
static void
pieces_have_exact_transforms(void **state)
{
	(void)state;
	for (int round = 0; round < 20; round++) {
		double value[6], k = .3 * round * draw(), re, im, sum_re = 0, sum_im = 0;
		double from, to;
		struct spec_samples samples = {
			(const double[]){400, 410, 420, 430, 440, 450}, value, 6,
			SPEC_INTERPOLATE_SPRAGUE};
		struct spec_piece piece[2];
		size_t at = (size_t)(5 * draw());

		for (int i = 0; i < 6; i++)
			value[i] = draw();
		assert_int_equal(spec_samples_pieces(&samples, at, piece), 1);
		spec_piece_transform(piece, k, 390, &re, &im);
		from = 400 + 10 * (double)at;
		to = from + 10;
		for (int i = 0; i <= 4000; i++) {
			double nm = from + (to - from) * i / 4000;
			double weight = (i == 0 || i == 4000 ? 1
						: i % 2      ? 4
							     : 2) *
					spec_samples_at(&samples, nm);

			sum_re += weight * cos(k * (nm - 390));
			sum_im += weight * sin(k * (nm - 390));
		}
		near(re, sum_re * 10 / 12000, 1e-9, "cosine");
		near(im, sum_im * 10 / 12000, 1e-9, "sine");
	}
}

/* A product of band-limited functions is band-limited: the convolution is exact. */
static void
products_of_series_are_exact(void **state)
{
	double a[9], b[5], product[13];

	(void)state;
	for (int i = 0; i < 9; i++)
		a[i] = draw() - .5;
	for (int i = 0; i < 5; i++)
		b[i] = draw() - .5;
	spec_series_multiply(a, 9, b, 5, product);
	for (double nm = 380; nm < 780; nm += 7.3) {
		struct spec_series one = {380, 780, 9, a}, two = {380, 780, 5, b};
		struct spec_series both = {380, 780, 13, product};

		near(spec_series_at(&both, nm),
			spec_series_at(&one, nm) * spec_series_at(&two, nm), 1e-14,
			"product");
	}
}

/* ---- lines and bins ---- */

static void
bins_hold_each_line_once(void **state)
{
	static const struct spec_line lines[] = {
		{500, 3}, {400, 2}, {420, 5}, {436, 7}, {399.9, 100}, {500.1, 100}};
	static const double edges[] = {400, 420, 430, 440, 500};
	double mean[4], sum = 0;
	struct spec_spectrum spectrum;

	(void)state;
	assert_int_equal(spec_spectrum_constant(1, &spectrum, NULL), SPEC_OK);
	assert_int_equal(
		spec_spectrum_add_lines(&spectrum, lines, COUNT(lines), NULL), SPEC_OK);
	assert_int_equal(spec_spectrum_kind(&spectrum), SPEC_SPECTRUM_COMPOSITE);
	assert_int_equal(spec_spectrum_mean(
				 &spectrum, SPEC_EXTRAPOLATE_REFUSE, edges, 4, mean, NULL),
		SPEC_OK);
	near(mean[0], 1 + 2. / 20, 1e-15, "its lower edge");
	near(mean[1], 1 + 5. / 10, 1e-15, "an inner edge is the upper bin's");
	near(mean[2], 1 + 7. / 10, 1e-15, "inside");
	near(mean[3], 1 + 3. / 60, 1e-15, "the last edge");
	for (int i = 0; i < 4; i++)
		sum += mean[i] * (edges[i + 1] - edges[i]);
	near(sum, 100 + 2 + 5 + 7 + 3, 1e-12, "energy");
	near(integral(&spectrum, 400, 500), 117, 1e-12, "integral");
	spec_spectrum_free(&spectrum);
}

static void
lines_are_sorted_and_merged(void **state)
{
	static const struct spec_line first[] = {{546.1, 3}, {435.8, 2}},
				      second[] = {{435.8, 4}, {546.1, -3}, {404.7, 1}};
	struct spec_spectrum spectrum;

	(void)state;
	spec_spectrum_constant(0, &spectrum, NULL);
	assert_int_equal(spec_spectrum_add_lines(&spectrum, first, 2, NULL), SPEC_OK);
	assert_true(spectrum.line[0].wavelength_nm == 435.8);
	assert_int_equal(spec_spectrum_add_lines(&spectrum, second, 3, NULL), SPEC_OK);
	assert_int_equal(spectrum.lines, 2);
	assert_true(
		spectrum.line[0].wavelength_nm == 404.7 && spectrum.line[0].weight == 1);
	assert_true(
		spectrum.line[1].wavelength_nm == 435.8 && spectrum.line[1].weight == 6);
	spec_spectrum_free(&spectrum);
}

/* ---- all kinds ---- */

/* One of each kind, with the interpolations of samples. */
static size_t
make_kinds(struct spec_spectrum *spectra)
{
	static const double nm[] = {380, 395, 430, 433, 500, 612, 780},
			    value[] = {.1, .9, .3, .4, 2, .05, 1.5},
			    even[] = {.2, .9, .3, .4, 1.7, .05, 1.5, .8, 1.1};
	static const double coefficient[] = {2, .3, -.4, .1, .05}, rgb[] = {.7, .2, .1};
	static const struct spec_sigmoid sigmoid = {1.5, 3e-5, -.02, 2};
	struct spec_spectrum *next = spectra;

	spec_spectrum_constant(.7, next++, NULL);
	spec_spectrum_blackbody(2856, 3, next++, NULL);
	spec_spectrum_rgb(rgb, &sigmoid, next++, NULL);
	spec_spectrum_fourier(380, 780, coefficient, COUNT(coefficient), next++, NULL);
	for (int i = 0; i < 3; i++)
		spec_spectrum_tabulated(
			nm, value, COUNT(nm), (enum spec_interpolate)i, next++, NULL);
	for (int i = 0; i < 4; i++)
		spec_spectrum_sampled(380, 780, even, COUNT(even), (enum spec_interpolate)i,
			next++, NULL);
	return (size_t)(next - spectra);
}

static void
means_are_integrals_of_values(void **state)
{
	/* All breaks of the tables, their half-way points, and some others. */
	static const double edges[] = {380, 387.5, 395, 405, 412.5, 430, 431.5, 433, 455,
		466.5, 480, 500, 505, 530, 555, 556, 580, 605, 612, 630, 655, 680, 696, 705,
		730, 755, 780};
	struct spec_spectrum spectra[16];
	size_t count = make_kinds(spectra);
	double mean[COUNT(edges) - 1];

	(void)state;
	assert_int_equal(count, 11);
	for (size_t i = 0; i < count; i++) {
		double whole = 0;

		assert_int_equal(spec_spectrum_mean(&spectra[i], SPEC_EXTRAPOLATE_REFUSE,
					 edges, COUNT(edges) - 1, mean, NULL),
			SPEC_OK);
		for (size_t k = 0; k + 1 < COUNT(edges); k++) {
			double width = edges[k + 1] - edges[k];

			/* A colour's means are promised to 1e-6 of its scale. */
			near(mean[k] * width,
				simpson(&spectra[i], edges[k], edges[k + 1], 200),
				(spectra[i].smooth == SPEC_SPECTRUM_RGB ? 1.5e-6 : 1e-9) *
					width,
				spec_spectrum_kind_name(spectra[i].smooth));
			whole += mean[k] * width;
		}
		near(integral(&spectra[i], 380, 780), whole, 6e-4, "the sum of the bins");
		spec_spectrum_free(&spectra[i]);
	}
}

static void
rules_hold_outside(void **state)
{
	static const double nm[] = {370, 800}, edges[] = {360, 380, 780, 800};
	struct spec_spectrum spectra[16];
	size_t count = make_kinds(spectra);

	(void)state;
	for (size_t i = 0; i < count; i++) {
		struct spec_error error;
		int endless = i < 3;
		double value[3];

		assert_int_equal(spec_spectrum_sample(&spectra[i], SPEC_EXTRAPOLATE_REFUSE,
					 nm, 2, value, &error),
			endless ? SPEC_OK : SPEC_ERANGE);
		if (!endless)
			assert_string_equal(error.message,
				"the spectrum covers 380..780 nm, not 370 nm");
		assert_int_equal(spec_spectrum_mean(&spectra[i], SPEC_EXTRAPOLATE_REFUSE,
					 edges + 1, 2, value, &error),
			endless ? SPEC_OK : SPEC_ERANGE);
		if (!endless)
			assert_string_equal(error.message,
				"the spectrum covers 380..780 nm, not 800 nm");
		spec_spectrum_sample(
			&spectra[i], SPEC_EXTRAPOLATE_ZERO, nm, 2, value, NULL);
		assert_true((value[0] == 0 && value[1] == 0) == !endless);
		spec_spectrum_mean(
			&spectra[i], SPEC_EXTRAPOLATE_ZERO, edges, 3, value, NULL);
		assert_true((value[0] == 0 && value[2] == 0) == !endless);
		if (!endless) {
			spec_spectrum_sample(
				&spectra[i], SPEC_EXTRAPOLATE_CONSTANT, nm, 2, value, NULL);
			assert_true(value[0] == value_at(&spectra[i], 380));
			assert_true(value[1] == value_at(&spectra[i], 780));
			spec_spectrum_mean(&spectra[i], SPEC_EXTRAPOLATE_CONSTANT, edges, 3,
				value, NULL);
			near(value[0], value_at(&spectra[i], 380), 1e-15, "below");
			near(value[2], value_at(&spectra[i], 780), 1e-15, "above");
		}
		spec_spectrum_free(&spectra[i]);
	}
}

static void
copies_are_equal(void **state)
{
	static const struct spec_line line = {546.1, 12};
	struct spec_spectrum spectra[16];
	size_t count = make_kinds(spectra);

	(void)state;
	for (size_t i = 0; i < count; i++) {
		struct spec_spectrum copy;

		spec_curve_set_text(&spectra[i].unit, "W/nm", NULL);
		spec_spectrum_add_lines(&spectra[i], &line, 1, NULL);
		assert_int_equal(spec_spectrum_copy(&spectra[i], &copy, NULL), SPEC_OK);
		assert_string_equal(copy.unit, "W/nm");
		assert_int_equal(copy.smooth, spectra[i].smooth);
		assert_true(copy.lines == 1 && copy.line[0].weight == 12);
		for (double nm = 380; nm < 780; nm += 9.1)
			assert_true(value_at(&copy, nm) == value_at(&spectra[i], nm));
		spec_spectrum_free(&copy);
		spec_spectrum_free(&spectra[i]);
	}
	spec_spectrum_free(NULL);
}

static void
curves_become_tables(void **state)
{
	struct spec_curve curve;
	struct spec_spectrum spectrum;
	struct spec_error error;

	(void)state;
	spec_curve_new(2, 2, &curve, NULL);
	curve.wavelength_nm[0] = 400;
	curve.wavelength_nm[1] = 500;
	curve.value[3] = 8;
	spec_curve_set_text(&curve.title, "gold", NULL);
	assert_int_equal(spec_spectrum_from_curve(&curve, 1, &spectrum, NULL), SPEC_OK);
	assert_string_equal(spectrum.title, "gold");
	assert_int_equal(spectrum.smooth, SPEC_SPECTRUM_TABULATED);
	near(value_at(&spectrum, 450), 4, 0, "half-way");
	spec_spectrum_free(&spectrum);
	assert_int_equal(
		spec_spectrum_from_curve(&curve, 2, &spectrum, &error), SPEC_ERANGE);
	spec_curve_free(&curve);
}

static void
wrong_spectra_are_refused(void **state)
{
	static const double value[] = {1, 2, 3, 4, 5, 6}, bad[] = {1, NAN, 3},
			    nm[] = {400, 410, 420, 430, 440.1, 450}, down[] = {400, 390},
			    below[] = {0, 10};
	static const struct spec_line far = {INFINITY, 1}, negative = {-1, 1};
	static const struct spec_sigmoid broken = {1, NAN, 0, 0};
	struct spec_spectrum s;
	struct spec_error e;

	(void)state;
	assert_int_equal(spec_spectrum_sampled(400, 400, value, 3, 0, &s, &e), SPEC_ERANGE);
	assert_int_equal(spec_spectrum_sampled(0, 400, value, 3, 0, &s, &e), SPEC_ERANGE);
	assert_int_equal(spec_spectrum_sampled(400, 500, value, 1, 0, &s, &e), SPEC_ERANGE);
	assert_int_equal(spec_spectrum_sampled(400, 500, bad, 3, 0, &s, &e), SPEC_ERANGE);
	assert_string_equal(e.message, "sample 2 is not finite");
	assert_int_equal(
		spec_spectrum_sampled(400, 500, value, 5, SPEC_INTERPOLATE_SPRAGUE, &s, &e),
		SPEC_ERANGE);
	assert_string_equal(e.message, "Sprague's interpolation needs 6 samples, not 5");
	assert_int_equal(
		spec_spectrum_tabulated(nm, value, 6, SPEC_INTERPOLATE_SPRAGUE, &s, &e),
		SPEC_ERANGE);
	assert_non_null(strstr(e.message, "430 nm is followed by 440.1 nm"));
	assert_int_equal(spec_spectrum_tabulated(down, value, 2, 0, &s, &e), SPEC_ERANGE);
	assert_int_equal(spec_spectrum_tabulated(below, value, 2, 0, &s, &e), SPEC_ERANGE);
	assert_int_equal(spec_spectrum_tabulated(nm, value, 0, 0, &s, &e), SPEC_ERANGE);
	assert_int_equal(spec_spectrum_fourier(400, 500, value, 4, &s, &e), SPEC_ERANGE);
	assert_non_null(strstr(e.message, "odd number of coefficients"));
	assert_int_equal(spec_spectrum_fourier(400, 300, value, 3, &s, &e), SPEC_ERANGE);
	assert_int_equal(spec_spectrum_fourier(400, 500, bad, 3, &s, &e), SPEC_ERANGE);
	assert_int_equal(spec_spectrum_constant(NAN, &s, &e), SPEC_ERANGE);
	assert_int_equal(spec_spectrum_blackbody(0, 1, &s, &e), SPEC_ERANGE);
	assert_int_equal(spec_spectrum_blackbody(5000, INFINITY, &s, &e), SPEC_ERANGE);
	assert_int_equal(spec_spectrum_rgb(value, &broken, &s, &e), SPEC_ERANGE);
	assert_null(s.title);
	assert_int_equal(spec_spectrum_constant(1, &s, &e), SPEC_OK);
	assert_int_equal(spec_spectrum_add_lines(&s, &far, 1, &e), SPEC_ERANGE);
	assert_int_equal(spec_spectrum_add_lines(&s, &negative, 1, &e), SPEC_ERANGE);
	assert_int_equal(s.lines, 0);
	assert_int_equal(
		spec_spectrum_mean(&s, 0, down, 1, (double[1]){0}, &e), SPEC_ERANGE);
	spec_spectrum_free(&s);
}

int
main(void)
{
	const struct CMUnitTest tests[] = {
		cmocka_unit_test(sprague_gives_published_values),
		cmocka_unit_test(sprague_reproduces_quartics),
		cmocka_unit_test(neighbours_and_left_samples_hold),
		cmocka_unit_test(interpolations_have_names),
		cmocka_unit_test(bessel_functions_are_transforms),
		cmocka_unit_test(box_has_its_coefficients),
		cmocka_unit_test(truncated_box_leaks_through_filter),
		cmocka_unit_test(series_keep_parsevals_sum),
		cmocka_unit_test(pieces_have_exact_transforms),
		cmocka_unit_test(products_of_series_are_exact),
		cmocka_unit_test(bins_hold_each_line_once),
		cmocka_unit_test(lines_are_sorted_and_merged),
		cmocka_unit_test(means_are_integrals_of_values),
		cmocka_unit_test(rules_hold_outside),
		cmocka_unit_test(copies_are_equal),
		cmocka_unit_test(curves_become_tables),
		cmocka_unit_test(wrong_spectra_are_refused),
	};

	return cmocka_run_group_tests(tests, NULL, NULL);
}
