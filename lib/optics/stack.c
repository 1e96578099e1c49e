#include "optics/stack.h"

#include <math.h>
#include <stdint.h>
#include <stdlib.h>
#include <string.h>

#include "base/memory.h"
#include "base/vector.h"

#define LANES 128    /* worked on together: their state stays in the nearest cache */
#define RESCALE 16   /* layers after which fields are made about 1 again */
#define LEAST 1e-100 /* |q|^2 of a layer where light runs along it: not 0 */

/*
 * Tangential fields at a boundary, of s and of p light, each divided by one factor that
 * both fields share: electric ("B") and magnetic ("C") of Macleod's eq. 2.110.
 */
struct fields {
	double br[LANES], bi[LANES], cr[LANES], ci[LANES];
};

struct lanes {
	_Alignas(64) double along[LANES]; /* (n0 sin theta0)^2: the same in every layer */
	double q[LANES];                  /* n0 cos theta0 */
	double e0[LANES];                 /* n0^2 */
	double er[LANES], ei[LANES];      /* the present medium's (n + ik)^2 */
	double vr[LANES], vi[LANES];      /* its inverse */
	double phase[LANES];              /* 4 pi d / lambda */
	double qr[LANES], qi[LANES], squared[LANES]; /* n cos(theta), |its square| */
	double turn[LANES], decay[LANES];            /* half E's argument, and log |E| */
	double lost[LANES], wr[LANES], wi[LANES];    /* |E| - 1, cosine and sine of turn */
	double decayed[LANES]; /* what the powers are still to decay by, a logarithm */
	double through[LANES]; /* its exponential */
	double power_s[LANES], power_p[LANES]; /* that enters the substrate */
	struct fields s, p;
	double rs[LANES], rp[LANES], ts[LANES], tp[LANES];
};

enum spec_status
spec_stack_new(size_t layers, size_t wavelengths, struct spec_stack *stack,
	struct spec_error *error)
{
	*stack = (struct spec_stack){.layers = layers, .wavelengths = wavelengths};
	stack->thickness_nm = spec_memory_new(layers, sizeof(double), "layers", error);
	stack->wavelength_nm =
		spec_memory_new(wavelengths, sizeof(double), "wavelengths", error);
	stack->n =
		spec_memory_new(layers + 2, wavelengths * sizeof(double), "indices", error);
	stack->k =
		spec_memory_new(layers + 2, wavelengths * sizeof(double), "indices", error);
	if (stack->thickness_nm && stack->wavelength_nm && stack->n && stack->k)
		return SPEC_OK;
	spec_stack_free(stack);
	return SPEC_ENOMEM;
}

void
spec_stack_free(struct spec_stack *stack)
{
	free(stack->thickness_nm);
	free(stack->wavelength_nm);
	free(stack->n);
	free(stack->k);
	*stack = (struct spec_stack){0};
}

enum spec_status
spec_stack_reverse(const struct spec_stack *stack, struct spec_stack *reversed,
	struct spec_error *error)
{
	size_t count = stack->wavelengths, media = stack->layers + 2;
	enum spec_status status = spec_stack_new(stack->layers, count, reversed, error);

	if (status != SPEC_OK)
		return status;
	reversed->varied = stack->varied ? stack->layers + 1 - stack->varied : 0;
	memcpy(reversed->wavelength_nm, stack->wavelength_nm, count * sizeof(double));
	for (size_t i = 0; i < stack->layers; i++)
		reversed->thickness_nm[i] = stack->thickness_nm[stack->layers - 1 - i];
	for (size_t i = 0; i < media; i++) {
		size_t to = i * count, from = (media - 1 - i) * count;

		memcpy(reversed->n + to, stack->n + from, count * sizeof(double));
		memcpy(reversed->k + to, stack->k + from, count * sizeof(double));
	}
	return SPEC_OK;
}

int
spec_stack_is_lit(const struct spec_stack *stack)
{
	for (size_t i = 0; i < stack->wavelengths; i++) {
		if (stack->k[i] != 0 || !(stack->n[i] > 0))
			return 0;
	}
	return 1;
}

/*
 * The root q of er + i ei - along with a positive real or imaginary part: n cos(theta) of
 * a layer. *squared is |q|^2.
 */
static inline void
normal_component(
	double er, double ei, double along, double *qr, double *qi, double *squared)
{
	double a = er - along, size = fabs(a) + LEAST;
	double length = sqrt(size * size + ei * ei);
	double large = sqrt((length + size) / 2), small = ei / (2 * large);

	*qr = a >= 0 ? large : small;
	*qi = a >= 0 ? small : large;
	*squared = length;
}

/* The fields of a wave that goes off into the substrate. */
SPEC_VECTORISED static void
begin(struct lanes *lanes)
{
	for (size_t i = 0; i < LANES; i++) {
		double qr, qi, squared;

		normal_component(
			lanes->er[i], lanes->ei[i], lanes->along[i], &qr, &qi, &squared);
		lanes->s.br[i] = 1;
		lanes->s.bi[i] = 0;
		lanes->s.cr[i] = qr;
		lanes->s.ci[i] = qi;
		/* Admittance e / q, both fields times q: q may be 0. */
		lanes->p.br[i] = qr;
		lanes->p.bi[i] = qi;
		lanes->p.cr[i] = lanes->er[i];
		lanes->p.ci[i] = lanes->ei[i];
		lanes->power_s[i] = qr;
		lanes->power_p[i] = lanes->er[i] * qr + lanes->ei[i] * qi;
		lanes->decayed[i] = 0;
	}
}

/*
 * From the back of a layer to its front. With E = e^(2 i delta), |E| <= 1, and all fields
 * times e^(i delta), which keeps them from growing (Macleod's eq. 2.110 otherwise):
 *   B' = ((1 + E) B + (1 - E) C / eta) / 2
 *   C' = ((1 - E) B eta + (1 + E) C) / 2
 * a + ib is (1 + E) / 2, c + id is (1 - E) / 2. c is a sum of what is not negative,
 * -lost / 2 + |E| sin(turn)^2: 1 / eta and eta may be large, where q is small, and would
 * lift the rounding of a difference.
 */
static inline void
advance(struct fields *fields, size_t i, double a, double b, double c, double d,
	double etar, double etai, double inverser, double inversei)
{
	double br = fields->br[i], bi = fields->bi[i];
	double cr = fields->cr[i], ci = fields->ci[i];
	double xr = cr * inverser - ci * inversei, xi = cr * inversei + ci * inverser;
	double yr = br * etar - bi * etai, yi = br * etai + bi * etar;

	fields->br[i] = (a * br - b * bi) + (c * xr - d * xi);
	fields->bi[i] = (a * bi + b * br) + (c * xi + d * xr);
	fields->cr[i] = (c * yr - d * yi) + (a * cr - b * ci);
	fields->ci[i] = (c * yi + d * yr) + (a * ci + b * cr);
}

/* q = n cos(theta) of the present layer, and what E is to be made of. */
SPEC_VECTORISED static void
find_roots(struct lanes *restrict lanes)
{
	for (size_t i = 0; i < LANES; i++) {
		normal_component(lanes->er[i], lanes->ei[i], lanes->along[i], &lanes->qr[i],
			&lanes->qi[i], &lanes->squared[i]);
		lanes->turn[i] = lanes->qr[i] * lanes->phase[i] / 2;
		lanes->decay[i] = -lanes->qi[i] * lanes->phase[i];
		lanes->decayed[i] += lanes->decay[i];
	}
}

/* In loops of their own: what lives across a call of libmvec is saved around it. */
SPEC_VECTORISED static void
find_waves(struct lanes *restrict lanes)
{
	for (size_t i = 0; i < LANES; i++)
		lanes->lost[i] = spec_vector_expm1(lanes->decay[i]);
	for (size_t i = 0; i < LANES; i++)
		lanes->wr[i] = spec_vector_cos(lanes->turn[i]);
	for (size_t i = 0; i < LANES; i++)
		lanes->wi[i] = spec_vector_sin(lanes->turn[i]);
}

SPEC_VECTORISED static void
advance_fields(struct lanes *restrict lanes)
{
	for (size_t i = 0; i < LANES; i++) {
		double er = lanes->er[i], ei = lanes->ei[i];
		double vr = lanes->vr[i], vi = lanes->vi[i];
		double qr = lanes->qr[i], qi = lanes->qi[i];
		double sine = (1 + lanes->lost[i]) * lanes->wi[i], b = sine * lanes->wr[i];
		double c = sine * lanes->wi[i] - lanes->lost[i] / 2, a = 1 - c;
		double inverse = 1 / lanes->squared[i];
		double ir = qr * inverse, ii = -qi * inverse; /* 1 / q */

		advance(&lanes->s, i, a, b, c, -b, qr, qi, ir, ii);
		/* p: eta = e / q, 1 / eta = q / e */
		advance(&lanes->p, i, a, b, c, -b, er * ir - ei * ii, er * ii + ei * ir,
			qr * vr - qi * vi, qr * vi + qi * vr);
	}
}

/* Whether the present layer absorbs nothing and is evanescent in no lane. */
SPEC_VECTORISED static int
is_clear(const struct lanes *lanes)
{
	uint64_t other = 0;

	for (size_t i = 0; i < LANES; i++)
		other |= lanes->ei[i] == 0 && lanes->along[i] < lanes->er[i] ? 0 : 1;
	return !other;
}

SPEC_VECTORISED static void
find_clear_waves(struct lanes *restrict lanes)
{
	for (size_t i = 0; i < LANES; i++) {
		lanes->qr[i] = sqrt(lanes->er[i] - lanes->along[i]);
		lanes->turn[i] = lanes->qr[i] * lanes->phase[i] / 2;
	}
	for (size_t i = 0; i < LANES; i++)
		lanes->wr[i] = spec_vector_cos(lanes->turn[i]);
	for (size_t i = 0; i < LANES; i++)
		lanes->wi[i] = spec_vector_sin(lanes->turn[i]);
}

/*
 * Where nothing decays, in real numbers (Macleod's eq. 2.110 as it stands), with
 * b = sin(delta) / eta and c = eta sin(delta):
 *   B' = cos(delta) B - i b C
 *   C' = cos(delta) C - i c B
 */
static inline void
advance_clear(struct fields *fields, size_t i, double cosine, double b, double c)
{
	double br = fields->br[i], bi = fields->bi[i];
	double cr = fields->cr[i], ci = fields->ci[i];

	fields->br[i] = cosine * br + b * ci;
	fields->bi[i] = cosine * bi - b * cr;
	fields->cr[i] = cosine * cr + c * bi;
	fields->ci[i] = cosine * ci - c * br;
}

SPEC_VECTORISED static void
advance_clear_fields(struct lanes *restrict lanes)
{
	for (size_t i = 0; i < LANES; i++) {
		double q = lanes->qr[i], sine = lanes->wi[i], cosine = lanes->wr[i];
		double over = sine / q, times = sine * q;

		advance_clear(&lanes->s, i, cosine, over, times);
		advance_clear(
			&lanes->p, i, cosine, times * lanes->vr[i], over * lanes->er[i]);
	}
}

/* The decay since this was called last. */
SPEC_VECTORISED static void
find_decay(struct lanes *restrict lanes)
{
	for (size_t i = 0; i < LANES; i++)
		lanes->through[i] = spec_vector_exp(lanes->decayed[i]);
	for (size_t i = 0; i < LANES; i++)
		lanes->decayed[i] = 0;
}

/*
 * The power takes its part of the decay each time, as the fields' scale alone could make it
 * overflow in a stack of a thousand barriers through which light gets all the same.
 */
SPEC_VECTORISED static void
rescale(struct fields *restrict fields, const double *restrict through,
	double *restrict power)
{
	for (size_t i = 0; i < LANES; i++) {
		double size = fabs(fields->br[i]) + fabs(fields->bi[i]) +
			      fabs(fields->cr[i]) + fabs(fields->ci[i]);
		double scale = 1 / size;

		fields->br[i] *= scale;
		fields->bi[i] *= scale;
		fields->cr[i] *= scale;
		fields->ci[i] *= scale;
		power[i] *= through[i] * (scale * scale);
	}
}

/*
 * |r|^2 and the power that gets through, of fields at the front. b / c is the ambient's eta,
 * which by itself may be too large or small to be squared.
 */
static inline void
finish_one(const struct fields *fields, size_t i, double b, double c, double power,
	double *reflectance, double *transmittance)
{
	double br = b * fields->br[i], bi = b * fields->bi[i];
	double cr = c * fields->cr[i], ci = c * fields->ci[i];
	double minus = (br - cr) * (br - cr) + (bi - ci) * (bi - ci);
	double inverse = 1 / ((br + cr) * (br + cr) + (bi + ci) * (bi + ci));

	*reflectance = minus * inverse;
	*transmittance = 4 * b * c * power * inverse;
}

SPEC_VECTORISED static void
finish(struct lanes *restrict lanes)
{
	for (size_t i = 0; i < LANES; i++) {
		double q = lanes->q[i], through = lanes->through[i];

		finish_one(&lanes->s, i, q, 1, lanes->power_s[i] * through, &lanes->rs[i],
			&lanes->ts[i]);
		finish_one(&lanes->p, i, lanes->e0[i], q, lanes->power_p[i] * through,
			&lanes->rp[i], &lanes->tp[i]);
	}
}

/*
 * One layer without absorption and nothing evanescent: Airy's formula in real numbers
 * (Born & Wolf 7.6.1 (9)), r = n/d of both surfaces put over one denominator.
 */
static inline double
airy(double n1, double d1, double n2, double d2, double cosine_of_phase)
{
	double a = n1 * d2, b = n2 * d1, c = 2 * (n1 * n2) * (d1 * d2) * cosine_of_phase;
	double e = d1 * d2, f = n1 * n2;

	return (a * a + b * b + c) / (e * e + f * f + c);
}

SPEC_VECTORISED static void
one_clear_layer(struct lanes *restrict lanes, double e0, double e1, double e2)
{
	for (size_t i = 0; i < LANES; i++) {
		double q0 = lanes->q[i], q1 = sqrt(e1 - lanes->along[i]);
		double q2 = sqrt(e2 - lanes->along[i]);
		double c = spec_vector_cos(q1 * lanes->phase[i]);

		lanes->rs[i] = airy(q0 - q1, q0 + q1, q1 - q2, q1 + q2, c);
		lanes->rp[i] = airy(e1 * q0 - e0 * q1, e1 * q0 + e0 * q1, e2 * q1 - e1 * q2,
			e2 * q1 + e1 * q2, c);
		lanes->ts[i] = 1 - lanes->rs[i];
		lanes->tp[i] = 1 - lanes->rp[i];
	}
}

/* Rounding may lead out of it, in a resonance by many ulp. NaN stays NaN. */
static inline double
from_0_to_1(double share)
{
	return share > 1 ? 1 : share < 0 ? 0 : share;
}

/* The results of count lanes: shares of s and p light; light that grazes is all reflected. */
SPEC_VECTORISED static void
store(const struct lanes *restrict lanes, size_t count, double s, double p,
	double *restrict reflectance, double *restrict transmittance)
{
	for (size_t i = 0; i < count; i++) {
		double r = s * from_0_to_1(lanes->rs[i]) + p * from_0_to_1(lanes->rp[i]);
		double t = s * from_0_to_1(lanes->ts[i]) + p * from_0_to_1(lanes->tp[i]);

		reflectance[i] = lanes->q[i] > 0 ? r : 1;
		transmittance[i] = lanes->q[i] > 0 ? t : 0;
	}
}

/* Lanes beyond count repeat the last, so that they hold numbers. */
static void
fill_lanes(double *lane, const double *value, size_t count)
{
	memcpy(lane, value, count * sizeof *lane);
	for (size_t i = count; i < LANES; i++)
		lane[i] = value[count - 1];
}

SPEC_VECTORISED static void
fill_constant(double *lane, double value)
{
	for (size_t i = 0; i < LANES; i++)
		lane[i] = value;
}

static void
set_medium(struct lanes *lanes, size_t i, double n, double k)
{
	double er = n * n - k * k, ei = 2 * n * k, inverse = 1 / (er * er + ei * ei);

	lanes->er[i] = er;
	lanes->ei[i] = ei;
	lanes->vr[i] = er * inverse;
	lanes->vi[i] = -ei * inverse;
}

/* The medium of that number at wavelengths first..first+count-1, or at one in all lanes. */
static void
enter_medium(struct lanes *lanes, const struct spec_stack *stack, size_t medium,
	size_t first, size_t count)
{
	size_t at = medium * stack->wavelengths + first;

	set_medium(lanes, 0, stack->n[at], stack->k[at]);
	for (size_t i = 1; i < LANES && count > 1; i++) {
		size_t wavelength = at + (i < count ? i : count - 1);

		set_medium(lanes, i, stack->n[wavelength], stack->k[wavelength]);
	}
	if (count > 1)
		return;
	fill_constant(lanes->er, lanes->er[0]);
	fill_constant(lanes->ei, lanes->ei[0]);
	fill_constant(lanes->vr, lanes->vr[0]);
	fill_constant(lanes->vi, lanes->vi[0]);
}

SPEC_VECTORISED static void
multiply(double *restrict lane, const double *restrict value, double factor)
{
	for (size_t i = 0; i < LANES; i++)
		lane[i] = factor * value[i];
}

/* 4 pi d / lambda of a layer, from 1, in all lanes. */
static void
set_phase(struct lanes *lanes, const struct spec_stack *stack, size_t layer, size_t first,
	size_t count, const double *varied_nm)
{
	const double *wavelength_nm = stack->wavelength_nm + first;
	double thickness_nm = stack->thickness_nm[layer - 1];

	if (count == 1 && layer == stack->varied)
		multiply(lanes->phase, varied_nm, 4 * M_PI / wavelength_nm[0]);
	else if (count == 1)
		fill_constant(lanes->phase, 4 * M_PI * thickness_nm / wavelength_nm[0]);
	for (size_t i = 0; i < LANES && count > 1; i++) {
		double d = layer == stack->varied ? varied_nm[i] : thickness_nm;

		lanes->phase[i] = 4 * M_PI * d / wavelength_nm[i < count ? i : count - 1];
	}
}

/* From the substrate through all layers to the ambient; cosines are in the lanes. */
static void
cross_stack(struct lanes *lanes, const struct spec_stack *stack, size_t first, size_t count,
	const double *varied_nm)
{
	enter_medium(lanes, stack, stack->layers + 1, first, count);
	begin(lanes);
	for (size_t layer = stack->layers; layer > 0; layer--) {
		enter_medium(lanes, stack, layer, first, count);
		set_phase(lanes, stack, layer, first, count, varied_nm);
		if (is_clear(lanes)) {
			find_clear_waves(lanes);
			advance_clear_fields(lanes);
		} else {
			find_roots(lanes);
			find_waves(lanes);
			advance_fields(lanes);
		}
		if (layer % RESCALE == 0) {
			find_decay(lanes);
			rescale(&lanes->s, lanes->through, lanes->power_s);
			rescale(&lanes->p, lanes->through, lanes->power_p);
		}
	}
	find_decay(lanes);
	finish(lanes);
}

/* n: the ambient's index in each lane. */
SPEC_VECTORISED static void
set_incidence(struct lanes *restrict lanes, const double *restrict cosine,
	const double *restrict n)
{
	for (size_t i = 0; i < LANES; i++) {
		lanes->q[i] = n[i] * cosine[i];
		lanes->e0[i] = n[i] * n[i];
		lanes->along[i] = n[i] * n[i] * ((1 - cosine[i]) * (1 + cosine[i]));
	}
}

static double
share_of_s(enum spec_polarisation polarisation)
{
	if (polarisation == SPEC_POLARISATION_NONE)
		return 0.5;
	return polarisation == SPEC_POLARISATION_S ? 1 : 0;
}

void
spec_stack_spectrum(const struct spec_stack *stack, double cosine, double varied_nm,
	enum spec_polarisation polarisation, double *reflectance, double *transmittance)
{
	double varied[LANES], lane_cosine[LANES], n[LANES], s = share_of_s(polarisation);
	struct lanes lanes;

	fill_constant(varied, varied_nm);
	fill_constant(lane_cosine, cosine);
	for (size_t first = 0; first < stack->wavelengths; first += LANES) {
		size_t count = stack->wavelengths - first;

		if (count > LANES)
			count = LANES;
		fill_lanes(n, stack->n + first, count);
		set_incidence(&lanes, lane_cosine, n);
		cross_stack(&lanes, stack, first, count, varied);
		store(&lanes, count, s, 1 - s, reflectance + first, transmittance + first);
	}
}

/* Whether all of the stack is clear, one layer thick, and nothing in it evanescent. */
static int
is_one_clear_layer(const struct lanes *lanes, const struct spec_stack *stack,
	const double *e, size_t wavelength)
{
	double most = 0;

	if (stack->layers != 1)
		return 0;
	for (size_t medium = 1; medium < 3; medium++) {
		if (stack->k[medium * stack->wavelengths + wavelength] != 0)
			return 0;
	}
	for (size_t i = 0; i < LANES; i++)
		most = lanes->along[i] > most ? lanes->along[i] : most;
	return most < e[1] && most < e[2];
}

static void
run_row(struct lanes *lanes, const struct spec_stack *stack, size_t wavelength,
	const double *varied_nm)
{
	double e[3] = {0};

	for (size_t medium = 0; medium < 3 && stack->layers == 1; medium++) {
		double n = stack->n[medium * stack->wavelengths + wavelength];

		e[medium] = n * n;
	}
	if (!is_one_clear_layer(lanes, stack, e, wavelength)) {
		cross_stack(lanes, stack, wavelength, 1, varied_nm);
		return;
	}
	set_phase(lanes, stack, 1, wavelength, 1, varied_nm);
	one_clear_layer(lanes, e[0], e[1], e[2]);
}

void
spec_stack_row(const struct spec_stack *stack, size_t wavelength, const double *cosine,
	const double *varied_nm, size_t count, enum spec_polarisation polarisation,
	double *reflectance, double *transmittance)
{
	double varied[LANES], lane_cosine[LANES], n[LANES], s = share_of_s(polarisation);
	struct lanes lanes;

	fill_constant(varied, 0);
	fill_constant(n, stack->n[wavelength]);
	for (size_t first = 0; first < count; first += LANES) {
		size_t part = count - first < LANES ? count - first : LANES;

		fill_lanes(lane_cosine, cosine + first, part);
		if (varied_nm)
			fill_lanes(varied, varied_nm + first, part);
		set_incidence(&lanes, lane_cosine, n);
		run_row(&lanes, stack, wavelength, varied);
		store(&lanes, part, s, 1 - s, reflectance + first, transmittance + first);
	}
}
