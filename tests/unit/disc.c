/* lib/optics/disc: the two models of optical discs. */
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "optics/disc.h"
#include "optics/grating.h"

#include "check.h"
#include "random.h"

#define PI 3.14159265358979323846

#define MOST 700 /* pixels: more than two runs of the library, the last one in part */

static struct spec_disc
disc_named(const char *name)
{
	const struct spec_disc *disc = spec_disc_find(name, NULL);

	assert_non_null(disc);
	return *disc;
}

/* Grids that the tests share: 380 to 780 nm, even; and one with uneven steps. */
static double even[81], uneven[7] = {400, 410, 440, 445, 520, 521, 700};
static double uneven_edges[8] = {395, 405, 425, 442, 470, 520.5, 600, 720};

static int
fill_grids(void **state)
{
	(void)state;
	for (int i = 0; i < 81; i++)
		even[i] = 380 + 5 * i;
	return 0;
}

static const struct spec_disc_bands even_points = {81, even, NULL};
static const struct spec_disc_bands uneven_points = {7, uneven, NULL};
static const struct spec_disc_bands uneven_bins = {7, uneven, uneven_edges};
static const struct spec_disc_bands one_point = {1, even + 34, NULL};
static const struct spec_disc_bands one_bin = {1, uneven, uneven_edges};

enum { BANDS_KINDS = 5 };

static const struct spec_disc_bands *const all_bands[BANDS_KINDS] = {
	&even_points, &uneven_points, &uneven_bins, &one_point, &one_bin};

/* ---- presets and factors ---- */

/* The table of specdisc(1), by its rows; a record, which has no pits, uses nothing of a dash. */
static void
test_table(void **state)
{
	static const char *const names[] = {"cd", "dvd", "bluray", "vinyl"};
	static const struct {
		const char *name;
		size_t offset;
		double value[4];
	} rows[] = {
#define ROW(member) #member, offsetof(struct spec_disc, member)
		{ROW(track_nm), {1600, 740, 320, 100000}},
		{ROW(pit_nm), {2400, 1400, 506, 0}},
		{ROW(pit_width_nm), {600, 320, 130, 0}},
		{ROW(pit_depth_nm), {125, 103, 64, 0}},
		{ROW(index), {1.58, 1.58, 1.58, 1.54}},
		{ROW(groove_scale), {.005, .005, .005, .04}},
		{ROW(strip_height), {1, 1, 1, 0}},
		{ROW(strip_floor), {.01, .01, .01, 1}},
		{ROW(main_scale_nm), {1000, 1000, 1000, 0}},
		{ROW(main_floor_nm), {0}},
		{ROW(groove_decay), {10, 10, 10, 10}},
		{ROW(groove_exponent), {2, 2, 2, 2}},
		{ROW(side_width_rad), {3.14, 3.14, 3.14, 3.14}},
		{ROW(main_width_rad), {.4, .4, .4, .4}},
		{ROW(specular), {50, 50, 50, 0}},
		{ROW(specular_exponent), {10000, 10000, 10000, 0}},
		{ROW(diffuse), {.001, .001, .001, 0}},
#undef ROW
	};

	(void)state;
	for (size_t i = 0; i < COUNT(names); i++) {
		struct spec_disc disc = disc_named(names[i]);

		for (size_t row = 0; row < COUNT(rows); row++) {
			double value;

			memcpy(&value, (const char *)&disc + rows[row].offset,
				sizeof value);
			near(value, rows[row].value[i], 0, rows[row].name);
		}
	}
}

static void
test_presets(void **state)
{
	struct spec_error error;
	double x = 1.6, mean = 0, all;
	int lowest, highest;
	const double overhead[3] = {0, 0, 1};

	(void)state;
	assert_null(spec_disc_find("laserdisc", &error));
	assert_int_equal(error.status, SPEC_EUSAGE);
	assert_string_equal(error.message,
		"no disc is named 'laserdisc'; there are cd, dvd, bluray and vinyl");
	near(disc_named("cd").track_nm, 1600, 0, "cd track");
	near(disc_named("cd").pit_nm, 2400, 0, "cd pits");
	near(disc_named("dvd").track_nm, 740, 0, "dvd track");
	near(disc_named("dvd").pit_nm, 1400, 0, "dvd pits");
	near(disc_named("bluray").track_nm, 320, 0, "bluray track");

	/* The random runs of 2 to 8 bits behind Blu-ray's distance of pits: x by iteration. */
	for (int turn = 0; turn < 60; turn++) {
		all = mean = 0;
		for (int i = 2; i <= 8; i++) {
			all += pow(x, -i);
			mean += i * pow(x, -i);
		}
		x *= 1 + (all - 1) / mean; /* Newton, in log x */
	}
	near(x, 1.6013, .5e-4, "the chance of a bit");
	near(2 * mean * 74.5, disc_named("bluray").pit_nm, .5, "bluray pits");

	/* Depths of a quarter of the players' wavelengths, to the nanometre. */
	near(4 * disc_named("dvd").index * disc_named("dvd").pit_depth_nm, 650, 3.2, "dvd");
	near(4 * disc_named("bluray").index * disc_named("bluray").pit_depth_nm, 405, 3.2,
		"bluray depth");

	/* A Blu-ray disc has no visible order at normal incidence. */
	for (int i = 0; i < 81; i++) {
		spec_grating_orders(overhead, even[i], disc_named("bluray").track_nm,
			&lowest, &highest);
		assert_int_equal(lowest, 0);
		assert_int_equal(highest, 0);
	}
}

/* T 7.7 and 7.8 by hand, with the side strips' norm put right (sigma1): to these digits. */
static void
test_pins(void **state)
{
	struct spec_disc cd = disc_named("cd");
	double peak = 550 / cd.pit_nm;

	(void)state;
	near(spec_disc_side_strips(&cd, peak, 550), .29224, .5e-5, "f^2");
	near(spec_disc_side_strips(&cd, -peak, 550), .29224, .5e-5, "f^2, other side");
	near(spec_disc_main_strip(&cd, 0, 550), 2225.567, .5e-3, "g^2");
	near(spec_disc_main_strip(&cd, 0, 400), 2225.567, .5e-3, "g^2, 400 nm");
}

static void
test_factors(void **state)
{
	struct spec_disc cd = disc_named("cd");
	double height = sqrt(PI) / 6.28, away = exp(-4 * PI * PI / (3.14 * 3.14));

	(void)state;
	/* Half way between orders 1 and 2 and the next two: distances of pi and 3 pi. */
	near(spec_disc_side_strips(&cd, 1.5 * 500 / 2400, 500),
		.01 + height * (2 * away + pow(away, 9)), 1e-15, "between strips");
	/* In the mirror's direction there are orders -1 and 1, and no 0. */
	near(spec_disc_side_strips(&cd, 0, 500), .01 + 2 * height * pow(away, 4), 1e-15,
		"no strip");
	/* Beyond order 3 there is no strip. */
	near(spec_disc_side_strips(&cd, 1.9, 400), .01, 1e-15, "no order 11");
	/* At a phase of sigma2 / 2 the lobe has fallen to 1/e. */
	near(spec_disc_main_strip(&cd, .2 * 500 / (2 * PI * 2400), 500),
		1000 * (sqrt(PI) / .8 / exp(1) + .01), 1e-12, "main strip");
	cd.main_floor_nm = 3;
	near(spec_disc_main_strip(&cd, 1, 500), 13, 1e-14, "main floor");
	near(spec_disc_anisotropy(&cd, 0), 1, 0, "no slant");
	near(spec_disc_anisotropy(&cd, -.3), exp(-.9), 1e-16, "slant");
	cd.groove_exponent = 1.5;
	near(spec_disc_anisotropy(&cd, -.25), exp(-1.25), 1e-16, "slant, exponent 1.5");
}

/* ---- pixels ---- */

/* Arrays of pixels, with room for a wide stride after them. */
struct row {
	double along[MOST], across[MOST], half_cosine[MOST], lamp_cosine[MOST],
		eye_cosine[MOST];
};

static struct spec_disc_pixels
pixels_of(struct row *row, size_t count)
{
	return (struct spec_disc_pixels){count, row->along, row->across, row->half_cosine,
		row->lamp_cosine, row->eye_cosine};
}

/* Any sums of two directions, a third of them near the mirror direction's. */
static void
fill_row(struct row *row, uint64_t *seed)
{
	for (size_t x = 0; x < MOST; x++) {
		double size = x % 3 == 0 ? .05 : 1.4;

		row->along[x] = random_in(seed, -size, size);
		row->across[x] = random_in(seed, -size, size);
		row->half_cosine[x] = random_in(seed, x % 3 == 0 ? .9995 : -1, 1);
	}
	row->along[1] = row->across[1] = row->half_cosine[1] = 0;
	row->along[2] = row->across[2] = 0;
	row->half_cosine[2] = 1;
}

typedef void model(const struct spec_disc *, const struct spec_disc_bands *,
	const struct spec_disc_pixels *, double *, size_t);

/* The reflection of one pixel, which must be there in all of its bands. */
static void
reflect(model *function, const struct spec_disc *disc, const struct spec_disc_bands *bands,
	double along, double across, double half_cosine, double *reflection)
{
	struct spec_disc_pixels pixel = {1, &along, &across, &half_cosine, NULL, NULL};

	for (size_t i = 0; i < bands->count; i++)
		reflection[i] = NAN;
	function(disc, bands, &pixel, reflection, 1);
}

/* What a band weighs in the integral over wavelength. */
static double
weight_nm(const struct spec_disc_bands *bands, size_t i)
{
	const double *w = bands->wavelength_nm;

	if (bands->edges_nm)
		return bands->edges_nm[i + 1] - bands->edges_nm[i];
	return ((i + 1 < bands->count ? w[i + 1] : w[i]) - (i > 0 ? w[i - 1] : w[i])) / 2;
}

/* ---- composite ---- */

/* What a spike at wavelength_nm puts into band i, per weight. */
static double
spike_share(const struct spec_disc_bands *bands, double wavelength_nm, size_t i)
{
	const double *w = bands->wavelength_nm;

	if (bands->edges_nm)
		return wavelength_nm >= bands->edges_nm[i] &&
				       wavelength_nm < bands->edges_nm[i + 1]
			       ? 1 / weight_nm(bands, i)
			       : 0;
	if (bands->count == 1 || wavelength_nm < w[0] ||
		wavelength_nm > w[bands->count - 1])
		return 0;
	if (wavelength_nm <= w[i])
		return i == 0 ? 1 / weight_nm(bands, i)
			      : fmax(0, (wavelength_nm - w[i - 1]) / (w[i] - w[i - 1])) /
					weight_nm(bands, i);
	return i + 1 == bands->count
		       ? 0
		       : fmax(0, (w[i + 1] - wavelength_nm) / (w[i + 1] - w[i])) /
				 weight_nm(bands, i);
}

/* T 7.9 as it is written in the header, a term at a time. */
static double
composite_of(const struct spec_disc *disc, const struct spec_disc_bands *bands, size_t band,
	double along, double across, double half_cosine)
{
	double strips = spec_disc_side_strips(disc, along, bands->wavelength_nm[band]);

	for (int n = 1; n <= 20; n++) {
		double nm = disc->track_nm * fabs(across) / n;

		if (nm > 1)
			strips += spec_disc_main_strip(disc, along, nm) *
				  spike_share(bands, nm, band);
	}
	return disc->groove_scale * spec_disc_anisotropy(disc, along) * strips +
	       disc->specular * pow(fabs(half_cosine), disc->specular_exponent) +
	       disc->diffuse;
}

/* Rows of some lengths against the formula; nothing is written outside the pixels. */
static void
check_composite(
	const struct spec_disc *disc, const struct spec_disc_bands *bands, double relative)
{
	static const size_t counts[] = {1, 7, 255, 257, MOST};
	const size_t stride = MOST + 3;
	double *reflection = malloc(bands->count * stride * sizeof *reflection);
	struct row *row = malloc(sizeof *row);
	uint64_t seed = 1;

	assert_true(reflection && row);
	fill_row(row, &seed);
	for (size_t c = 0; c < sizeof counts / sizeof *counts; c++) {
		struct spec_disc_pixels pixels = pixels_of(row, counts[c]);

		for (size_t i = 0; i < bands->count * stride; i++)
			reflection[i] = -7;
		spec_disc_composite(disc, bands, &pixels, reflection, stride);
		for (size_t i = 0; i < bands->count * stride; i++) {
			size_t x = i % stride, band = i / stride;
			double want = -7;

			if (x < counts[c])
				want = composite_of(disc, bands, band, row->along[x],
					row->across[x], row->half_cosine[x]);
			near(reflection[i], want, relative * fabs(want), "composite");
		}
	}
	free(row);
	free(reflection);
}

static void
test_composite(void **state)
{
	struct spec_disc disc;

	(void)state;
	for (size_t i = 0; i < BANDS_KINDS; i++) {
		/* 1e-6 is promised: the lobes are float. */
		disc = disc_named("cd");
		check_composite(&disc, all_bands[i], 1e-6);
		disc = disc_named("dvd");
		check_composite(&disc, all_bands[i], 1e-6);
		disc.side_width_rad = .2;
		disc.groove_exponent = 1.5;
		disc.main_floor_nm = 2;
		disc.specular_exponent = 0;
		check_composite(&disc, all_bands[i], 1e-6);
		/* Wide lobes are double; pow's and exp's roundings remain. */
		disc.side_width_rad = 6;
		disc.specular_exponent = 3;
		check_composite(&disc, all_bands[i], 1e-13);
	}
}

/* A disc that sends back a single spike of 3 nm/sr per order, and nothing else. */
static struct spec_disc
spikes_alone(void)
{
	struct spec_disc disc = {.track_nm = 1600,
		.pit_nm = 2400,
		.side_width_rad = 1,
		.main_width_rad = 1,
		.groove_scale = 1,
		.main_floor_nm = 3};

	return disc;
}

/* The integral over wavelength of a spike at wavelength_nm, which no other one joins. */
static double
spike_energy(const struct spec_disc_bands *bands, double wavelength_nm, double *mean_nm)
{
	struct spec_disc disc = spikes_alone();
	double reflection[81], sum = 0;

	*mean_nm = 0;
	reflect(spec_disc_composite, &disc, bands, .1, -wavelength_nm / 1600, 1,
		reflection);
	for (size_t i = 0; i < bands->count; i++) {
		sum += reflection[i] * weight_nm(bands, i);
		*mean_nm += reflection[i] * weight_nm(bands, i) * bands->wavelength_nm[i];
	}
	*mean_nm /= sum;
	return sum;
}

static void
test_spikes_on_points(void **state)
{
	static const struct spec_disc_bands *const grids[] = {&even_points, &uneven_points};
	uint64_t seed = 2;
	double mean;

	(void)state;
	for (size_t g = 0; g < 2; g++) {
		const double *w = grids[g]->wavelength_nm;
		size_t last = grids[g]->count - 1;

		for (int i = 0; i < 500; i++) {
			/* Above half the last wavelength no second spike is in range. */
			double nm = random_in(&seed, w[0], fmin(w[last], 2 * w[0] - 1));

			near(spike_energy(grids[g], nm, &mean), 3, 1e-14, "weight");
			/* The hats keep the place too: roundings of 800 nm. */
			near(mean, nm, 1e-12, "place");
		}
		/* The halved cells at both ends, and the points themselves. */
		near(spike_energy(grids[g], w[0] * (1 + 1e-15), &mean), 3, 1e-12, "first");
		near(spike_energy(grids[g], w[0] + 1, &mean), 3, 1e-14, "after the first");
		near(spike_energy(grids[g], w[1], &mean), 3, 1e-14, "second");
		near(mean, w[1], 1e-12, "second's place");
		near(spike_energy(grids[g], w[0] - .01, &mean), 0, 0, "too short");
	}
	/* A second spike at half the wavelength is in range too, unless it is shorter. */
	near(spike_energy(&even_points, 779.999, &mean), 6, 1e-13, "two orders");
	near(spike_energy(&even_points, 780.01, &mean), 3, 1e-14, "one is beyond");
	near(spike_energy(&uneven_points, 699.999, &mean), 3, 1e-14, "last");
	near(spike_energy(&uneven_points, 700.01, &mean), 0, 0, "too long");
	near(spike_energy(&uneven_points, 2100, &mean), 9, 1e-13, "orders 3 to 5");
	near(spike_energy(&one_point, 550, &mean), 0, 0, "one point");
}

static void
test_spikes_on_bins(void **state)
{
	struct spec_disc disc = spikes_alone();
	const double *edge = uneven_edges;
	uint64_t seed = 3;
	double mean, reflection[7];

	(void)state;
	for (int i = 0; i < 500; i++)
		near(spike_energy(&uneven_bins, random_in(&seed, edge[0], edge[7]), &mean),
			3, 1e-14, "weight");
	/* An edge is the upper bin's; with |v| = 1 nothing rounds. */
	for (size_t i = 0; i < 7; i++) {
		disc.track_nm = edge[i];
		reflect(spec_disc_composite, &disc, &uneven_bins, .1, 1, 1, reflection);
		for (size_t j = 0; j < 7; j++)
			near(reflection[j], j == i ? 3 / (edge[i + 1] - edge[i]) : 0, 1e-15,
				"lower edge");
	}
	disc.track_nm = edge[7];
	reflect(spec_disc_composite, &disc, &uneven_bins, .1, 1, 1, reflection);
	for (size_t j = 0; j < 7; j++)
		near(reflection[j], 0, 0, "upper edge");
	near(spike_energy(&uneven_bins, edge[0] - .01, &mean), 0, 0, "too short");
	near(spike_energy(&one_bin, 400, &mean), 3, 1e-14, "one bin");
	near(spike_energy(&one_bin, 405, &mean), 0, 0, "above one bin");
	near(spike_energy(&one_bin, 1200, &mean), 3, 1e-14, "order 3 in one bin");
}

/* A record's reflection is T 7.8 alone, the same bits in every band. */
static void
test_vinyl(void **state)
{
	struct spec_disc vinyl = disc_named("vinyl");
	double back = 0;
	struct row *row = malloc(sizeof *row);
	double *reflection = malloc(81 * MOST * sizeof *reflection);
	struct spec_disc_pixels pixels;
	uint64_t seed = 4;

	(void)state;
	assert_true(row && reflection);
	fill_row(row, &seed);
	pixels = pixels_of(row, MOST);
	spec_disc_composite(&vinyl, &even_points, &pixels, reflection, MOST);
	for (size_t x = 0; x < MOST; x++) {
		double want = .04 * exp(-10 * row->along[x] * row->along[x]);

		near(reflection[x], want, 5e-17, "anisotropy"); /* libmvec: 4 ulp of .04 */
		for (size_t band = 1; band < 81; band++)
			near(reflection[band * MOST + x], reflection[x], 0, "colour");
	}
	/* Of a lamp above about .044 comes back: a strip of x is 2 sqrt(1 - x^2) long. */
	for (int i = -500; i < 500; i++) {
		double x = (i + .5) / 500;

		back += .04 * exp(-10 * x * x) * 2 * sqrt(1 - x * x) / 500;
	}
	near(back, .044, .001, "sent back");
	for (int i = 0; i < 20; i++) {
		double nm = random_in(&seed, 300, 900), along = random_in(&seed, -2, 2);

		near(spec_disc_side_strips(&vinyl, along, nm), 1, 0, "f^2");
		near(spec_disc_main_strip(&vinyl, along, nm), 0, 0, "g^2");
	}
	free(reflection);
	free(row);
}

/* ---- orders ---- */

static double
density(double x, double width)
{
	return exp(-x * x / (2 * width * width)) / (width * sqrt(2 * PI));
}

/* The mean over a band of an order's lobe across the tracks. */
static double
mean_lobe(const struct spec_disc *disc, double low_nm, double high_nm, double across, int m)
{
	double low = m * low_nm / disc->track_nm, high = m * high_nm / disc->track_nm;
	double scale = 1 / (disc->lobe_width * sqrt(2));

	if (m == 0 || high_nm == low_nm)
		return density(across - low, disc->lobe_width);
	return (erf((across - low) * scale) - erf((across - high) * scale)) /
	       (2 * (high - low));
}

static void
cell_of(const struct spec_disc_bands *bands, size_t i, double *low_nm, double *high_nm)
{
	const double *w = bands->wavelength_nm;
	size_t last = bands->count - 1;

	if (bands->edges_nm) {
		*low_nm = bands->edges_nm[i];
		*high_nm = bands->edges_nm[i + 1];
	} else if (last == 0) {
		*low_nm = *high_nm = w[0];
	} else {
		*low_nm = i > 0 ? (w[i - 1] + w[i]) / 2 : w[0] - (w[1] - w[0]) / 2;
		*high_nm = i < last ? (w[i] + w[i + 1]) / 2
				    : w[last] + (w[last] - w[last - 1]) / 2;
	}
}

static double
efficiency(const struct spec_disc *disc, double wavelength_nm, int m)
{
	return spec_grating_lamellar(disc->pit_width_nm / disc->track_nm,
		spec_grating_phase(disc->pit_depth_nm, disc->index, wavelength_nm), m);
}

static double
orders_of(const struct spec_disc *disc, const struct spec_disc_bands *bands, size_t band,
	double along, double across)
{
	double low_nm, high_nm, sum = 0;

	cell_of(bands, band, &low_nm, &high_nm);
	for (int m = -12; m <= 12; m++)
		sum += efficiency(disc, bands->wavelength_nm[band], m) *
		       mean_lobe(disc, low_nm, high_nm, across, m);
	return density(along, disc->lobe_width) * sum;
}

static void
check_orders(const struct spec_disc *disc, const struct spec_disc_bands *bands)
{
	static const size_t counts[] = {1, 7, 257, MOST};
	const size_t stride = MOST + 3;
	double *reflection = malloc(bands->count * stride * sizeof *reflection);
	double peak = density(0, disc->lobe_width) * density(0, disc->lobe_width);
	struct row *row = malloc(sizeof *row);
	uint64_t seed = 5;

	assert_true(reflection && row);
	fill_row(row, &seed);
	for (size_t c = 0; c < sizeof counts / sizeof *counts; c++) {
		struct spec_disc_pixels pixels = pixels_of(row, counts[c]);

		for (size_t i = 0; i < bands->count * stride; i++)
			reflection[i] = -7;
		spec_disc_orders(disc, bands, &pixels, reflection, stride);
		for (size_t i = 0; i < bands->count * stride; i++) {
			size_t x = i % stride, band = i / stride;
			double want = -7;

			if (x < counts[c])
				want = orders_of(
					disc, bands, band, row->along[x], row->across[x]);
			/*
			 * The cut at 8 standard deviations is 1.3e-14 of the peak; a mean
			 * is a difference of two erf, 1e-15, over 4e-3 or more of a lobe.
			 */
			near(reflection[i], want, 1e-12 * peak, "orders");
		}
	}
	free(row);
	free(reflection);
}

static void
test_orders(void **state)
{
	struct spec_disc disc;

	(void)state;
	for (size_t i = 0; i < BANDS_KINDS; i++) {
		disc = disc_named("cd");
		check_orders(&disc, all_bands[i]);
		disc = disc_named("dvd");
		check_orders(&disc, all_bands[i]);
		/* Lobes so wide that those of the other side reach over. */
		disc.lobe_width = .2;
		check_orders(&disc, all_bands[i]);
		/* ... and so narrow that they fall between bands. */
		disc = disc_named("bluray");
		disc.lobe_width = .001;
		check_orders(&disc, all_bands[i]);
		disc = disc_named("vinyl");
		check_orders(&disc, all_bands[i]);
	}
}

/* Where the mirror's lobe is highest: eta_0 / (2 pi width^2), for all bands. */
static void
test_mirror_peak(void **state)
{
	struct spec_disc cd = disc_named("cd");
	double reflection[81];

	(void)state;
	reflect(spec_disc_orders, &cd, &even_points, 0, 0, 1, reflection);
	for (size_t i = 0; i < 81; i++) {
		double want = efficiency(&cd, even[i], 0) /
			      (2 * PI * cd.lobe_width * cd.lobe_width);

		near(reflection[i], want, 1e-13 * want, "peak");
	}
}

/*
 * The integral of f_r cos(theta) over all directions to the eye, for one lamp: in u and v,
 * of which cos(theta) d(omega) = du dv. The trapezoidal rule at steps of half a standard
 * deviation is exact to exp(-2 pi^2 4) = 5e-35 for a Gaussian.
 */
static double
hemisphere(const struct spec_disc *disc, const struct spec_disc_bands *bands,
	const double lamp[3])
{
	double step = disc->lobe_width / 2, sum = 0;

	for (int i = -20; i <= 20; i++) {
		double along[MOST], across[MOST], reflection[MOST];
		double x = i * step - lamp[0], width = sqrt(1 - x * x);
		struct spec_disc_pixels pixels = {0, along, across, NULL, NULL, NULL};
		int first = (int)ceil((lamp[1] - width) / step);
		int last = (int)floor((lamp[1] + width) / step);

		for (int j = first; j <= last; j++) {
			along[pixels.count] = i * step;
			across[pixels.count++] = j * step;
			if (pixels.count < MOST && j < last)
				continue;
			spec_disc_orders(disc, bands, &pixels, reflection, MOST);
			for (size_t k = 0; k < pixels.count; k++)
				sum += reflection[k] * step * step;
			pixels.count = 0;
		}
	}
	return sum;
}

static void
check_energy(const struct spec_disc *disc, const struct spec_disc_bands *bands,
	const double lamp[3], int *orders)
{
	double wanted = 0, low_nm, high_nm;
	int lowest, highest, wider_lowest, wider_highest;

	/* The edges of the band must have the same orders, and none of them graze. */
	cell_of(bands, 0, &low_nm, &high_nm);
	spec_grating_orders(
		lamp, low_nm * .98, disc->track_nm, &wider_lowest, &wider_highest);
	spec_grating_orders(lamp, high_nm * 1.02, disc->track_nm, &lowest, &highest);
	assert_int_equal(lowest, wider_lowest);
	assert_int_equal(highest, wider_highest);
	for (int m = lowest; m <= highest; m++)
		wanted += efficiency(disc, bands->wavelength_nm[0], m);
	*orders = highest - lowest + 1;
	/* What lies beyond the cut of 8 standard deviations: 4e-15; and the erfs'. */
	near(hemisphere(disc, bands, lamp), wanted, 1e-12, "energy");
}

static void
test_energy(void **state)
{
	static const double lamps[4][3] = {
		{0, 0, 1}, {.36, .48, .8}, {0, -.8, .6}, {.8, 0, .6}};
	static const double point = 500, edges[2] = {497, 502};
	const struct spec_disc_bands sole = {1, &point, NULL}, bin = {1, &point, edges};
	struct spec_disc disc = disc_named("cd");
	int orders, most = 0;

	(void)state;
	disc.lobe_width = .001;
	for (size_t i = 0; i < 4; i++) {
		check_energy(&disc, &sole, lamps[i], &orders);
		check_energy(&disc, &bin, lamps[i], &orders);
		most = orders > most ? orders : most;
	}
	assert_int_equal(most, 7);
}

/* A lobe of a tenth of a nanometre is in one band or two, with all of its energy. */
static void
test_narrow_lobes(void **state)
{
	struct spec_disc disc = disc_named("cd");
	const struct spec_disc_bands *const grids[] = {&even_points, &uneven_bins};
	uint64_t seed = 6;

	(void)state;
	disc.lobe_width = .1 / disc.track_nm;
	for (int i = 0; i < 400; i++) {
		const struct spec_disc_bands *bands = grids[i % 2];
		double nm = random_in(&seed, 397, 719), sum = 0, reflection[81];
		int m = i % 3 + 1;

		/* Other orders are there too, at wavelengths far from this one. */
		reflect(spec_disc_orders, &disc, bands, 0, m * nm / disc.track_nm, 1,
			reflection);
		for (size_t band = 0; band < bands->count; band++) {
			double low_nm, high_nm;

			cell_of(bands, band, &low_nm, &high_nm);
			if (high_nm > nm - 2 && low_nm < nm + 2)
				sum += reflection[band] * (high_nm - low_nm) /
				       efficiency(&disc, bands->wavelength_nm[band], m);
		}
		/* The lobe's integral over wavelength is track / m; erfs of 1e-16. */
		near(sum / (density(0, disc.lobe_width) * disc.track_nm / m), 1, 1e-12,
			"narrow lobe");
	}
}

/* ---- directions ---- */

struct planes {
	float value[12][MOST];
};

static struct spec_disc_directions
directions_of(const struct planes *planes)
{
	struct spec_disc_directions directions;

	for (size_t i = 0; i < 3; i++) {
		directions.lamp[i] = planes->value[i];
		directions.eye[i] = planes->value[3 + i];
		directions.normal[i] = planes->value[6 + i];
		directions.tangent[i] = planes->value[9 + i];
	}
	return directions;
}

static void
set_vector(struct planes *planes, size_t first, size_t x, double a, double b, double c)
{
	planes->value[first][x] = (float)a;
	planes->value[first + 1][x] = (float)b;
	planes->value[first + 2][x] = (float)c;
}

/* Vectors of any length, none of them near another one's line or zero. */
static void
fill_planes(struct planes *planes, uint64_t *seed)
{
	for (size_t x = 0; x < MOST; x++) {
		for (size_t first = 0; first < 12; first += 3) {
			double size = exp(random_in(seed, -30, 30));
			double middle[3] = {0, 0, 0};

			middle[first == 9 ? 0 : 2] = 2;
			set_vector(planes, first, x,
				size * (middle[0] + random_in(seed, -1, 1)),
				size * random_in(seed, -1, 1),
				size * (middle[2] + random_in(seed, -1, 1)));
		}
	}
}

static void
unit_at(const struct planes *planes, size_t first, size_t x, double unit[3])
{
	double a = planes->value[first][x], b = planes->value[first + 1][x];
	double c = planes->value[first + 2][x], length = sqrt(a * a + b * b + c * c);

	unit[0] = a / length;
	unit[1] = b / length;
	unit[2] = c / length;
}

static double
dot(const double a[3], const double b[3])
{
	return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}

/* Gram and Schmidt, and a determinant in place of the cross product. */
static void
test_geometry(void **state)
{
	struct planes *planes = calloc(1, sizeof *planes);
	struct row *row = malloc(sizeof *row);
	struct spec_disc_pixels pixels = pixels_of(row, MOST);
	struct spec_disc_directions directions;
	uint64_t seed = 7;

	(void)state;
	assert_true(planes && row);
	directions = directions_of(planes);
	fill_planes(planes, &seed);
	spec_disc_geometry(&directions, &pixels);
	for (size_t x = 0; x < MOST; x++) {
		double l[3], e[3], n[3], t[3], s[3], in_plane, slant, across, length;

		unit_at(planes, 0, x, l);
		unit_at(planes, 3, x, e);
		unit_at(planes, 6, x, n);
		unit_at(planes, 9, x, t);
		for (size_t i = 0; i < 3; i++)
			s[i] = l[i] + e[i];
		slant = dot(n, t);
		in_plane = sqrt(1 - slant * slant);
		across = (s[0] * (n[1] * t[2] - n[2] * t[1]) -
				 s[1] * (n[0] * t[2] - n[2] * t[0]) +
				 s[2] * (n[0] * t[1] - n[1] * t[0])) /
			 in_plane;
		length = sqrt(dot(s, s));
		/* Some roundings of 2, over sqrt(1 - slant^2) > .1. */
		near(row->along[x], (dot(s, t) - slant * dot(s, n)) / in_plane, 2e-14,
			"along");
		near(row->across[x], across, 2e-14, "across");
		near(row->half_cosine[x], dot(s, n) / length, 2e-15, "half");
		near(row->lamp_cosine[x], dot(l, n), 1e-15, "lamp");
		near(row->eye_cosine[x], dot(e, n), 1e-15, "eye");
		/* The three are a frame: they have the sum's length. */
		near(row->along[x] * row->along[x] + row->across[x] * row->across[x] +
				pow(row->half_cosine[x] * length, 2),
			length * length, 1e-13, "length");
	}
	free(row);
	free(planes);
}

/* Lamp and eye change places: the same pixel, so both models are reciprocal. */
static void
test_reciprocity(void **state)
{
	struct planes *planes = calloc(1, sizeof *planes);
	struct row *there = malloc(sizeof *there), *back = malloc(sizeof *back);
	struct spec_disc_pixels pixels = pixels_of(there, MOST);
	struct spec_disc_directions directions;
	struct spec_disc cd = disc_named("cd");
	double *r = malloc(2 * 7 * MOST * sizeof *r);
	model *const models[2] = {spec_disc_composite, spec_disc_orders};
	uint64_t seed = 8;

	(void)state;
	assert_true(planes && there && back && r);
	directions = directions_of(planes);
	fill_planes(planes, &seed);
	spec_disc_geometry(&directions, &pixels);
	for (size_t i = 0; i < 3; i++) {
		const float *lamp = directions.lamp[i];

		directions.lamp[i] = directions.eye[i];
		directions.eye[i] = lamp;
	}
	pixels = pixels_of(back, MOST);
	spec_disc_geometry(&directions, &pixels);
	for (size_t x = 0; x < MOST; x++) {
		near(back->lamp_cosine[x], there->eye_cosine[x], 0, "lamp");
		near(back->eye_cosine[x], there->lamp_cosine[x], 0, "eye");
	}
	for (size_t i = 0; i < 2; i++) {
		pixels = pixels_of(there, MOST);
		models[i](&cd, &uneven_points, &pixels, r, MOST);
		pixels = pixels_of(back, MOST);
		models[i](&cd, &uneven_points, &pixels, r + 7 * MOST, MOST);
		for (size_t j = 0; j < 7 * MOST; j++)
			near(r[7 * MOST + j], r[j], 0, "reciprocity");
	}
	free(r);
	free(back);
	free(there);
	free(planes);
}

/* Neither the tangent's way nor the sign of across matters: orders come in pairs. */
static void
test_handedness(void **state)
{
	struct spec_disc cd = disc_named("cd");
	model *const models[2] = {spec_disc_composite, spec_disc_orders};
	double a[81], b[81];
	uint64_t seed = 9;

	(void)state;
	for (int i = 0; i < 100; i++) {
		double u = random_in(&seed, -.03, .03), v = random_in(&seed, -1, 1);

		for (size_t j = 0; j < 2; j++) {
			reflect(models[j], &cd, &even_points, u, v, .9, a);
			reflect(models[j], &cd, &even_points, -u, v, .9, b);
			assert_memory_equal(a, b, sizeof a);
			reflect(models[j], &cd, &even_points, u, -v, -.9, b);
			assert_memory_equal(a, b, sizeof a);
		}
	}
}

/* Where the grating equation sends an order, along is 0 and across its wavelength's. */
static void
test_grating_agrees(void **state)
{
	struct planes *planes = calloc(1, sizeof *planes);
	struct row *row = malloc(sizeof *row);
	struct spec_disc_directions directions;
	struct spec_disc_pixels pixels = pixels_of(row, 6);
	const double lamp[3] = {.36, .48, .8};
	int lowest, highest;

	(void)state;
	assert_true(planes && row);
	directions = directions_of(planes);
	spec_grating_orders(lamp, 500, 1600, &lowest, &highest);
	assert_int_equal(lowest, -1);
	assert_int_equal(highest, 4);
	for (int m = lowest; m <= highest; m++) {
		size_t x = (size_t)(m - lowest);
		double eye[3];

		assert_true(spec_grating_direction(lamp, m, 500, 1600, eye));
		/* x of the grating is the world's z, its y the world's x. */
		set_vector(planes, 0, x, lamp[1], lamp[2], lamp[0]);
		set_vector(planes, 3, x, eye[1], eye[2], eye[0]);
		set_vector(planes, 6, x, 0, 1, 0);
		set_vector(planes, 9, x, 0, 0, 1);
	}
	spec_disc_geometry(&directions, &pixels);
	for (int m = lowest; m <= highest; m++) {
		/* Two unit vectors in float: 2^-25 each. */
		near(row->along[m - lowest], 0, 1.2e-7, "along");
		near(fabs(row->across[m - lowest]), abs(m) * 500 / 1600., 1.2e-7, "across");
	}
	free(row);
	free(planes);
}

/* Where there is no frame there is no light; where lamp and eye cancel there is no half. */
static void
test_no_frame(void **state)
{
	struct planes *planes = calloc(1, sizeof *planes);
	struct row *row = malloc(sizeof *row);
	struct spec_disc_directions directions;
	struct spec_disc_pixels pixels = pixels_of(row, 10);
	struct spec_disc cd = disc_named("cd");
	double reflection[81];

	(void)state;
	assert_true(planes && row);
	directions = directions_of(planes);
	for (size_t x = 0; x < 10; x++) {
		set_vector(planes, 0, x, .6, 0, .8);
		set_vector(planes, 3, x, 0, .6, .8);
		set_vector(planes, 6, x, 0, 0, 2);
		set_vector(planes, 9, x, 3, 4, 5);
	}
	set_vector(planes, 0, 1, 0, 0, 0);
	set_vector(planes, 3, 2, 0, 0, 0);
	set_vector(planes, 6, 3, 0, 0, 0);
	set_vector(planes, 9, 4, 0, 0, 0);
	set_vector(planes, 0, 5, NAN, 0, 1);
	set_vector(planes, 3, 6, INFINITY, 0, 1);
	set_vector(planes, 9, 7, 0, 0, -3);
	set_vector(planes, 9, 8, 1e-8, 0, 1);
	set_vector(planes, 3, 9, -.6, 0, -.8);
	spec_disc_geometry(&directions, &pixels);
	/* The tangent in the plane is (.6, .8, 0). Floats near .6: 2^-25. */
	near(row->along[0], .36 + .48, 1e-7, "along");
	near(fabs(row->across[0]), fabs(.6 * .6 - .6 * .8), 1e-7, "across");
	for (size_t x = 1; x < 9; x++) {
		near(row->along[x], 0, 0, "along");
		near(row->across[x], 0, 0, "across");
		near(row->half_cosine[x], 0, 0, "half");
		near(row->lamp_cosine[x], 0, 0, "lamp");
		near(row->eye_cosine[x], 0, 0, "eye");
	}
	near(row->along[9], 0, 0, "opposite, along");
	near(row->across[9], 0, 0, "opposite, across");
	near(row->half_cosine[9], 0, 0, "opposite, half");
	near(row->lamp_cosine[9], .8, 1e-7, "opposite, lamp");
	/* The models are finite there too: T's terms for u = v = 0 without a highlight. */
	reflect(spec_disc_composite, &cd, &even_points, 0, 0, 0, reflection);
	for (size_t i = 0; i < 81; i++)
		near(reflection[i], .001 + .005 * (.01 + sqrt(PI) / 3.14 * exp(-16.0157)),
			1e-12, "no highlight");
	free(row);
	free(planes);
}

int
main(void)
{
	const struct CMUnitTest tests[] = {
		cmocka_unit_test(test_table),
		cmocka_unit_test(test_presets),
		cmocka_unit_test(test_pins),
		cmocka_unit_test(test_factors),
		cmocka_unit_test(test_composite),
		cmocka_unit_test(test_spikes_on_points),
		cmocka_unit_test(test_spikes_on_bins),
		cmocka_unit_test(test_vinyl),
		cmocka_unit_test(test_orders),
		cmocka_unit_test(test_mirror_peak),
		cmocka_unit_test(test_energy),
		cmocka_unit_test(test_narrow_lobes),
		cmocka_unit_test(test_geometry),
		cmocka_unit_test(test_reciprocity),
		cmocka_unit_test(test_handedness),
		cmocka_unit_test(test_grating_agrees),
		cmocka_unit_test(test_no_frame),
	};

	return cmocka_run_group_tests(tests, fill_grids, NULL);
}
