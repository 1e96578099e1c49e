/* T's model of a compact disc: spec_disc_composite and its factors. */
#include <math.h>
#include <string.h>

#include "base/vector.h"
#include "optics/disc.h"

#define RUN 256        /* pixels worked on together: they stay in the nearest cache */
#define SIDE_ORDERS 3  /* T 7.4: the side strips on each side of the middle */
#define NEAR_RAD 3.4   /* widest side strip of which two orders away 4e-14 is left */
#define NOTHING 690    /* e^-690 = 1e-300: a highlight's end */
#define NAUGHT (-80.f) /* a power of e that adds nothing; lower ones take expf long */

/* The height of a strip's lobe, of T 7.4 and 7.7. */
static double
lobe_height(const struct spec_disc *disc, double width_rad)
{
	return disc->strip_height * sqrt(M_PI) / (2 * width_rad);
}

static double
phase_of_pits(const struct spec_disc *disc, double along, double wavelength_nm)
{
	return 2 * M_PI / wavelength_nm * disc->pit_nm * along;
}

static double
lobe(double phase_rad, double width_rad)
{
	double x = phase_rad / width_rad;

	return exp(-4 * x * x);
}

double
spec_disc_side_strips(const struct spec_disc *disc, double along, double wavelength_nm)
{
	double phase = phase_of_pits(disc, along, wavelength_nm), sum = 0;

	for (int n = 1; n <= SIDE_ORDERS; n++)
		sum += lobe(phase - 2 * M_PI * n, disc->side_width_rad) +
		       lobe(phase + 2 * M_PI * n, disc->side_width_rad);
	return lobe_height(disc, disc->side_width_rad) * sum + disc->strip_floor;
}

double
spec_disc_main_strip(const struct spec_disc *disc, double along, double wavelength_nm)
{
	double phase = phase_of_pits(disc, along, wavelength_nm);
	double strip = lobe_height(disc, disc->main_width_rad) *
			       lobe(phase, disc->main_width_rad) +
		       disc->strip_floor;

	return disc->main_scale_nm * strip + disc->main_floor_nm;
}

/* |u|^beta; T's beta is 2, for which pow would take as long as many bands. */
static double
groove_power(const struct spec_disc *disc, double along)
{
	return disc->groove_exponent == 2 ? along * along
					  : pow(fabs(along), disc->groove_exponent);
}

double
spec_disc_anisotropy(const struct spec_disc *disc, double along)
{
	return exp(-disc->groove_decay * groove_power(disc, along));
}

/* What the bands of the composite model have in common, at some pixels. */
struct composite {
	size_t count;
	double path_nm[RUN]; /* pit_nm |u| */
	double groove[RUN];  /* c0 times the anisotropy [1/sr] */
	double plain[RUN];   /* c_spec |half_cosine|^alpha + c_diff [1/sr] */
};

SPEC_VECTORISED static void
decay(double *restrict groove, double scale, double rate, size_t count)
{
	for (size_t x = 0; x < count; x++)
		groove[x] = scale * spec_vector_exp(-rate * groove[x]);
}

static void
fill_composite(struct composite *run, const struct spec_disc *disc, const double *along,
	const double *half_cosine, size_t count)
{
	/* Far off the mirror direction the power is nothing, and pow takes long to say so. */
	double nothing = exp(-NOTHING / disc->specular_exponent);

	run->count = count;
	for (size_t x = 0; x < count; x++) {
		double half = fabs(half_cosine[x]);

		run->path_nm[x] = disc->pit_nm * fabs(along[x]);
		run->groove[x] = groove_power(disc, along[x]);
		run->plain[x] = disc->diffuse;
		if (disc->specular > 0 && half >= nothing)
			run->plain[x] +=
				disc->specular * pow(half, disc->specular_exponent);
	}
	decay(run->groove, disc->groove_scale, disc->groove_decay, count);
}

/* T 7.4 at one wavelength, with the phase in turns. */
struct strips {
	double turns_per_nm; /* 1 / wavelength */
	double decay;        /* -4 (2 pi / sigma1)^2 */
	double height, floor;
};

/* The strip nearest to a phase, and how far off that is; in float: it is a small number. */
struct nearest {
	float turns[RUN], order[RUN];
};

SPEC_VECTORISED static void
reduce(struct nearest *restrict nearest, const double *restrict path_nm,
	double turns_per_nm, size_t count)
{
	for (size_t x = 0; x < count; x++) {
		double turns = path_nm[x] * turns_per_nm, order = floor(turns + .5);

		nearest->turns[x] = (float)(turns - order);
		nearest->order[x] = (float)order;
	}
}

/* The sum of the lobes of all that count where lobes are no wider than NEAR_RAD. */
SPEC_VECTORISED static void
add_lobes(float *restrict sum, const struct nearest *restrict nearest, float rate,
	size_t count)
{
	for (size_t x = 0; x < count; x++) {
		float d = nearest->turns[x], n = nearest->order[x];
		float at = rate * d * d;
		float before = rate * (d + 1) * (d + 1);
		float after = rate * (d - 1) * (d - 1);
		/* Factors, because a branch around a call leaves no vector code. */
		float has_at = ((n > 0) & (n <= SIDE_ORDERS)) ? 1 : 0;
		float has_before = ((n != 1) & (n <= SIDE_ORDERS + 1)) ? 1 : 0;
		float has_after = n < SIDE_ORDERS ? 1 : 0;

		sum[x] = has_at * spec_vector_expf(at > NAUGHT ? at : NAUGHT) +
			 has_before * spec_vector_expf(before > NAUGHT ? before : NAUGHT) +
			 has_after * spec_vector_expf(after > NAUGHT ? after : NAUGHT);
	}
}

SPEC_VECTORISED static void
join(double *restrict reflection, const struct composite *restrict run,
	const float *restrict sum, double height, double least, size_t count)
{
	for (size_t x = 0; x < count; x++)
		reflection[x] =
			run->plain[x] + run->groove[x] * (least + height * (double)sum[x]);
}

/*
 * Passes of their own, because between double and float, and round floor, vector code is
 * slow or, before AVX2, none. As |u| stands for u, order -1 is the one before 0.
 */
static void
add_near_strips(double *reflection, const struct composite *run, const struct strips *at)
{
	struct nearest nearest;
	float sum[RUN];

	if (at->height > 0) {
		reduce(&nearest, run->path_nm, at->turns_per_nm, run->count);
		add_lobes(sum, &nearest, (float)at->decay, run->count);
	} else {
		memset(sum, 0, sizeof sum);
	}
	join(reflection, run, sum, at->height, at->floor, run->count);
}

SPEC_VECTORISED static void
add_wide_strips(double *restrict reflection, const struct composite *run,
	const struct strips *at, size_t count)
{
	const struct strips s = *at;

	for (size_t x = 0; x < count; x++) {
		double t = run->path_nm[x] * s.turns_per_nm, sum = 0;

		for (int n = 1; n <= SIDE_ORDERS; n++)
			sum += spec_vector_exp(s.decay * (t - n) * (t - n)) +
			       spec_vector_exp(s.decay * (t + n) * (t + n));
		reflection[x] = run->plain[x] + run->groove[x] * (s.floor + s.height * sum);
	}
}

static void
add_smooth(const struct composite *run, const struct spec_disc *disc,
	const struct spec_disc_bands *bands, double *reflection, size_t stride)
{
	double turn = 2 * M_PI / disc->side_width_rad;
	struct strips strips = {0, -4 * turn * turn,
		lobe_height(disc, disc->side_width_rad), disc->strip_floor};

	for (size_t band = 0; band < bands->count; band++) {
		double *row = reflection + band * stride;

		strips.turns_per_nm = 1 / bands->wavelength_nm[band];
		if (disc->side_width_rad <= NEAR_RAD)
			add_near_strips(row, run, &strips);
		else
			add_wide_strips(row, run, &strips, run->count);
	}
}

/* The i with bound[i] <= value < bound[i + 1], for a value that lies within the bounds. */
static size_t
interval_of(const double *bound, size_t intervals, double value)
{
	double share = (value - bound[0]) / (bound[intervals] - bound[0]);
	size_t i = (size_t)(share * (double)intervals);

	/* A guess that hits where the steps are equal. */
	if (i >= intervals)
		i = intervals - 1;
	while (i > 0 && value < bound[i])
		i--;
	while (i + 1 < intervals && value >= bound[i + 1])
		i++;
	return i;
}

/* What a point sample weighs in the trapezoidal sum over its neighbours too. */
static double
trapezoid_nm(const struct spec_disc_bands *bands, size_t i)
{
	const double *wavelength_nm = bands->wavelength_nm;
	size_t before = i > 0 ? i - 1 : i, after = i + 1 < bands->count ? i + 1 : i;

	return (wavelength_nm[after] - wavelength_nm[before]) / 2;
}

/* Puts a spike's weight [nm/sr] into one pixel's bands. */
static void
add_spike(const struct spec_disc_bands *bands, double wavelength_nm, double weight,
	double *reflection, size_t stride)
{
	const double *edge = bands->edges_nm, *point = bands->wavelength_nm;
	size_t i;
	double share;

	if (edge) {
		i = interval_of(edge, bands->count, wavelength_nm);
		if (wavelength_nm < edge[i + 1])
			reflection[i * stride] += weight / (edge[i + 1] - edge[i]);
		return;
	}
	i = interval_of(point, bands->count - 1, wavelength_nm);
	share = (wavelength_nm - point[i]) / (point[i + 1] - point[i]);
	reflection[i * stride] += weight * (1 - share) / trapezoid_nm(bands, i);
	reflection[(i + 1) * stride] += weight * share / trapezoid_nm(bands, i + 1);
}

static void
add_spikes(const struct composite *run, const struct spec_disc *disc,
	const struct spec_disc_bands *bands, const double *along, const double *across,
	double *reflection, size_t stride)
{
	const double *range = bands->edges_nm ? bands->edges_nm : bands->wavelength_nm;
	double lowest_nm = range[0];
	double highest_nm = range[bands->edges_nm ? bands->count : bands->count - 1];

	if (!(highest_nm > lowest_nm) ||
		(disc->main_scale_nm == 0 && disc->main_floor_nm == 0))
		return;
	for (size_t x = 0; x < run->count; x++) {
		double path_nm = disc->track_nm * fabs(across[x]);
		double n = fmax(floor(path_nm / highest_nm), 1), spike_nm;

		for (; (spike_nm = path_nm / n) >= lowest_nm; n++) {
			double weight = spec_disc_main_strip(disc, along[x], spike_nm);

			if (spike_nm <= highest_nm)
				add_spike(bands, spike_nm, run->groove[x] * weight,
					reflection + x, stride);
		}
	}
}

void
spec_disc_composite(const struct spec_disc *disc, const struct spec_disc_bands *bands,
	const struct spec_disc_pixels *pixels, double *reflection, size_t stride)
{
	struct composite run;

	for (size_t x0 = 0; x0 < pixels->count && bands->count > 0; x0 += RUN) {
		size_t count = pixels->count - x0 < RUN ? pixels->count - x0 : RUN;

		fill_composite(
			&run, disc, pixels->along + x0, pixels->half_cosine + x0, count);
		add_smooth(&run, disc, bands, reflection + x0, stride);
		add_spikes(&run, disc, bands, pixels->along + x0, pixels->across + x0,
			reflection + x0, stride);
	}
}
