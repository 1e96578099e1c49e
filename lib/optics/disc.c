#include "optics/disc.h"

#include <math.h>
#include <string.h>

#include "base/vector.h"
#include "optics/grating.h"

#define PI 3.14159265358979323846

#define RUN 256        /* pixels worked on together: they stay in the nearest cache */
#define SIDE_ORDERS 3  /* T 7.4: the side strips on each side of the middle */
#define NEAR_RAD 3.4   /* widest side strip of which two orders away 4e-14 is left */
#define NOTHING 690    /* e^-690 = 1e-300: a highlight's end */
#define NAUGHT (-80.f) /* a power of e that adds nothing; lower ones take expf long */
#define CUT 8          /* standard deviations after which a lobe ends */
#define PARALLEL 1e-12 /* squared sine of an angle that float vectors cannot tell from 0 */

#ifdef SPEC_VECTOR_FUNCTION
SPEC_VECTOR_FUNCTION(double, vector_erf, "erf");
#else
#define vector_erf erf
#endif

/*
 * T, section 7.2, has the CD's dimensions, 7.5 the DVD's distances; ECMA-130 (1996) and
 * ECMA-267 (2001) agree with them in the tracks. The index is polycarbonate's (1.585 at 589
 * nm), within the 1.55 +- 0.10 of both standards. No standard fixes width and depth, since
 * players need only the signal that they give: T's pits are a quarter of a CD player's 780 nm
 * deep in that (123 nm), so the others are taken as a quarter of 650 nm (103 nm) and of 405 nm
 * (64 nm). 320 nm and 130 nm are nominal widths in the trade's literature.
 *
 * Blu-ray: track pitch 320 nm, channel bit 74.5 nm (Blu-ray Disc Association, white paper on
 * the format, 2010; a layer of 25 GB). The code (1,7)PP has runs of 2 to 8 bits; were they as
 * random as can be, a run of i bits had probability x^-i with x = 1.6013, and a mean length of
 * 3.39 bits: a pit and a land after it take 2 * 3.39 * 74.5 nm = 506 nm.
 *
 * Record: 100 um is a usual distance of grooves, which carry no pits. T has no constants for
 * it. c2 alone leaves the anisotropic part of T 7.9, without any wavelength; with T's c5 and
 * beta, c0 makes it send back about 0.044 of a lamp's light from above, as a plane of PVC with
 * index 1.54 does (0.045).
 *
 * T has table 7.1 for the CD, and names no other constants for its DVD in figure 7.9. An order's width is 0.5
 * degrees: the sun's or a lamp's at arm's length, and a disc that is not quite flat.
 */
#define COMPOSITE_OF_T                                                                     \
	.groove_scale = .005, .strip_height = 1, .strip_floor = .01,                       \
	.main_scale_nm = 1000, .main_floor_nm = 0, .groove_decay = 10,                     \
	.groove_exponent = 2, .side_width_rad = 3.14, .main_width_rad = .4,                \
	.specular = 50, .specular_exponent = 10000, .diffuse = .001

static const struct spec_disc discs[] = {
	{.name = "cd",
		.track_nm = 1600,
		.pit_nm = 2400,
		.pit_width_nm = 600,
		.pit_depth_nm = 125,
		.index = 1.58,
		.lobe_width = PI / 360,
		COMPOSITE_OF_T},
	{.name = "dvd",
		.track_nm = 740,
		.pit_nm = 1400,
		.pit_width_nm = 320,
		.pit_depth_nm = 103,
		.index = 1.58,
		.lobe_width = PI / 360,
		COMPOSITE_OF_T},
	{.name = "bluray",
		.track_nm = 320,
		.pit_nm = 506,
		.pit_width_nm = 130,
		.pit_depth_nm = 64,
		.index = 1.58,
		.lobe_width = PI / 360,
		COMPOSITE_OF_T},
	{.name = "vinyl",
		.track_nm = 100000,
		.index = 1.54,
		.lobe_width = PI / 360,
		.groove_scale = .04,
		.strip_floor = 1,
		.groove_decay = 10,
		.groove_exponent = 2,
		.side_width_rad = 3.14,
		.main_width_rad = .4},
};

const struct spec_disc *
spec_disc_find(const char *name, struct spec_error *error)
{
	for (size_t i = 0; i < sizeof discs / sizeof *discs; i++) {
		if (strcmp(discs[i].name, name) == 0)
			return &discs[i];
	}
	spec_error_set(error, SPEC_EUSAGE,
		"no disc is named '%s'; there are cd, dvd, bluray and vinyl", name);
	return NULL;
}

/* The height of a strip's lobe, of T 7.4 and 7.7. */
static double
lobe_height(const struct spec_disc *disc, double width_rad)
{
	return disc->strip_height * sqrt(PI) / (2 * width_rad);
}

static double
phase_of_pits(const struct spec_disc *disc, double along, double wavelength_nm)
{
	return 2 * PI / wavelength_nm * disc->pit_nm * along;
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
		sum += lobe(phase - 2 * PI * n, disc->side_width_rad) +
		       lobe(phase + 2 * PI * n, disc->side_width_rad);
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

struct vector {
	double x, y, z;
};

static inline double
dot(struct vector a, struct vector b)
{
	return a.x * b.x + a.y * b.y + a.z * b.z;
}

static inline struct vector
scaled(struct vector a, double factor)
{
	return (struct vector){a.x * factor, a.y * factor, a.z * factor};
}

static inline struct vector
sum_of(struct vector a, struct vector b)
{
	return (struct vector){a.x + b.x, a.y + b.y, a.z + b.z};
}

static inline struct vector
cross(struct vector a, struct vector b)
{
	return (struct vector){
		a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
}

/* The unit vector; *known stays 1 if there is one. No squared float overflows a double. */
static inline struct vector
unit_of(const float *const plane[3], size_t i, int *known)
{
	struct vector a = {plane[0][i], plane[1][i], plane[2][i]};
	double square = dot(a, a);

	*known &= (square > 0) & (square < INFINITY);
	return scaled(a, 1 / sqrt(square));
}

SPEC_VECTORISED static void
geometry(const struct spec_disc_directions *directions, size_t count,
	double *restrict along, double *restrict across, double *restrict half_cosine,
	double *restrict lamp_cosine, double *restrict eye_cosine)
{
	const struct spec_disc_directions from = *directions;

	for (size_t i = 0; i < count; i++) {
		int known = 1;
		struct vector lamp = unit_of(from.lamp, i, &known);
		struct vector eye = unit_of(from.eye, i, &known);
		struct vector normal = unit_of(from.normal, i, &known);
		struct vector t = unit_of(from.tangent, i, &known);
		struct vector sum = sum_of(lamp, eye);
		struct vector x = sum_of(t, scaled(normal, -dot(t, normal)));
		double flat = dot(x, x), size = dot(sum, sum), scale = 1 / sqrt(flat);

		known &= flat > PARALLEL;
		along[i] = known ? dot(sum, x) * scale : 0;
		across[i] = known ? dot(sum, cross(normal, x)) * scale : 0;
		half_cosine[i] =
			(known & (size > 0)) ? dot(sum, normal) * (1 / sqrt(size)) : 0;
		lamp_cosine[i] = known ? dot(lamp, normal) : 0;
		eye_cosine[i] = known ? dot(eye, normal) : 0;
	}
}

void
spec_disc_geometry(
	const struct spec_disc_directions *directions, struct spec_disc_pixels *pixels)
{
	geometry(directions, pixels->count, pixels->along, pixels->across,
		pixels->half_cosine, pixels->lamp_cosine, pixels->eye_cosine);
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
	double turn = 2 * PI / disc->side_width_rad;
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
		     height = 1 / (width * sqrt(2 * PI));

	for (size_t i = 0; i < count; i++)
		value[i] = height *
			   spec_vector_exp(decay_rate * (x[i] - centre) * (x[i] - centre));
}

SPEC_VECTORISED static void
error_function(double *restrict value, const double *restrict x, double sign, double centre,
	double scale, size_t count)
{
	for (size_t i = 0; i < count; i++)
		value[i] = vector_erf((sign * x[i] - centre) * scale);
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
