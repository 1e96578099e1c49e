/* The model of grating orders: spec_disc_orders. */
#include <math.h>
#include <string.h>

#include "base/vector.h"
#include "optics/disc.h"
#include "optics/grating.h"

#define RUN 256 /* pixels worked on together: they stay in the nearest cache */
#define CUT 8   /* standard deviations after which a lobe ends */

/* The model of orders at some pixels. */
struct orders {
	const struct spec_disc *disc;
	const struct spec_disc_bands *bands;
	double *reflection;
	size_t stride, count;
	double nearest, farthest; /* least and greatest |v| */
	double across[RUN];       /* |v| */
	double strip[RUN];        /* K(u) */
	double distribution[RUN]; /* erf at the lower edge of the band */
};

/* Edge i, 0..count, of the bands: see spec_disc_orders about those of point samples. */
static double
edge_nm(const struct spec_disc_bands *bands, size_t i)
{
	const double *point = bands->wavelength_nm;
	size_t last = bands->count - 1;

	if (bands->edges_nm)
		return bands->edges_nm[i];
	if (last == 0)
		return point[0];
	if (i == 0)
		return fmax(point[0] - (point[1] - point[0]) / 2, point[0] / 2);
	if (i > last)
		return point[last] + (point[last] - point[last - 1]) / 2;
	return (point[i - 1] + point[i]) / 2;
}

/* A normal distribution's density of x, in the inverse of x's unit. */
SPEC_VECTORISED static void
density(double *restrict value, const double *restrict x, double centre, double width,
	size_t count)
{
	const double decay_rate = -.5 / (width * width),
		     height = 1 / (width * sqrt(2 * M_PI));

	for (size_t i = 0; i < count; i++)
		value[i] = height *
			   spec_vector_exp(decay_rate * (x[i] - centre) * (x[i] - centre));
}

SPEC_VECTORISED static void
error_function(double *restrict value, const double *restrict x, double sign, double centre,
	double scale, size_t count)
{
	for (size_t i = 0; i < count; i++)
		value[i] = spec_vector_erf((sign * x[i] - centre) * scale);
}

/* Adds the mean of a lobe over a band: what its distribution grows by between the edges. */
SPEC_VECTORISED static void
add_growth(double *restrict reflection, double *restrict distribution,
	const double *restrict next, const double *restrict strip, double factor,
	size_t count)
{
	for (size_t i = 0; i < count; i++) {
		reflection[i] += factor * strip[i] * (distribution[i] - next[i]);
		distribution[i] = next[i];
	}
}

SPEC_VECTORISED static void
add_product(double *restrict reflection, const double *restrict a, const double *restrict b,
	double factor, size_t count)
{
	for (size_t i = 0; i < count; i++)
		reflection[i] += factor * a[i] * b[i];
}

static double
efficiency_in(const struct orders *run, size_t band, int order)
{
	const struct spec_disc *disc = run->disc;
	double phase = spec_grating_phase(
		disc->pit_depth_nm, disc->index, run->bands->wavelength_nm[band]);

	return spec_grating_lamellar(disc->pit_width_nm / disc->track_nm, phase, order);
}

/* Order 0, whose lobe is the same in all bands; or any where one point sample is all. */
static void
add_still_order(const struct orders *run, int order, double sign)
{
	const struct spec_disc *disc = run->disc;
	double centre = sign * order * run->bands->wavelength_nm[0] / disc->track_nm;
	double lobe_at[RUN];

	density(lobe_at, run->across, centre, disc->lobe_width, run->count);
	for (size_t band = 0; band < run->bands->count; band++)
		add_product(run->reflection + band * run->stride, run->strip, lobe_at,
			efficiency_in(run, band, order), run->count);
}

/* The lobe of order >= 1 on v's side (sign 1) or on the other one (sign -1). */
static void
add_order(struct orders *run, int order, double sign)
{
	const struct spec_disc *disc = run->disc;
	double per_nm = order / disc->track_nm, reach = CUT * disc->lobe_width;
	double nearest = sign > 0 ? run->nearest : -run->farthest;
	double farthest = sign > 0 ? run->farthest : -run->nearest;
	double scale = 1 / (disc->lobe_width * sqrt(2)), next[RUN];
	int started = 0;

	for (size_t band = 0; band < run->bands->count; band++) {
		double low = edge_nm(run->bands, band) * per_nm;
		double high = edge_nm(run->bands, band + 1) * per_nm;

		if (high < nearest - reach)
			continue;
		if (low > farthest + reach)
			break;
		if (!started)
			error_function(run->distribution, run->across, sign, low, scale,
				run->count);
		started = 1;
		error_function(next, run->across, sign, high, scale, run->count);
		add_growth(run->reflection + band * run->stride, run->distribution, next,
			run->strip, efficiency_in(run, band, order) / (2 * (high - low)),
			run->count);
	}
}

static void
add_orders(struct orders *run)
{
	const struct spec_disc_bands *bands = run->bands;
	double reach = CUT * run->disc->lobe_width, track_nm = run->disc->track_nm;
	double low_nm = edge_nm(bands, 0), high_nm = edge_nm(bands, bands->count);
	int first = (int)fmax(ceil((run->nearest - reach) * track_nm / high_nm), 1);
	int last = (int)floor((run->farthest + reach) * track_nm / low_nm);

	if (run->nearest <= reach)
		add_still_order(run, 0, 1);
	if (run->disc->pit_width_nm == 0 || run->disc->pit_depth_nm == 0)
		return; /* a mirror; else a record would have hundreds of empty orders */
	for (int order = first; order <= last; order++) {
		for (double sign = 1; sign >= -1; sign -= 2) {
			if (high_nm > low_nm)
				add_order(run, order, sign);
			else
				add_still_order(run, order, sign);
		}
	}
}

/* The part of count pixels, up to RUN, in which the lobes are; and nothing elsewhere. */
static void
add_strip(struct orders *run, const double *along, const double *across, size_t count)
{
	double reach = CUT * run->disc->lobe_width;
	size_t first = 0, end = count;

	while (end > 0 && !(fabs(along[end - 1]) <= reach))
		end--;
	while (first < end && !(fabs(along[first]) <= reach))
		first++;
	if (first == end)
		return;
	run->count = end - first;
	run->reflection += first;
	run->nearest = INFINITY;
	run->farthest = 0;
	for (size_t x = 0; x < run->count; x++) {
		run->across[x] = fabs(across[first + x]);
		run->nearest = fmin(run->nearest, run->across[x]);
		run->farthest = fmax(run->farthest, run->across[x]);
	}
	density(run->strip, along + first, 0, run->disc->lobe_width, run->count);
	add_orders(run);
}

void
spec_disc_orders(const struct spec_disc *disc, const struct spec_disc_bands *bands,
	const struct spec_disc_pixels *pixels, double *reflection, size_t stride)
{
	struct orders run = {.disc = disc, .bands = bands, .stride = stride};

	for (size_t x0 = 0; x0 < pixels->count && bands->count > 0; x0 += RUN) {
		size_t count = pixels->count - x0 < RUN ? pixels->count - x0 : RUN;

		for (size_t band = 0; band < bands->count; band++)
			memset(reflection + band * stride + x0, 0,
				count * sizeof *reflection);
		run.reflection = reflection + x0;
		add_strip(&run, pixels->along + x0, pixels->across + x0, count);
	}
}
