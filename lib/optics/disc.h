/*
 * Reflection by optical discs and records: what a lamp's light becomes on the way to the
 * eye, by two models.
 * - composite: that of T, Vangorp & Yskout, Multispectrale rendering (2005), chapter 7, made
 *   to look like photographs;
 * - orders: the grating orders of the tracks, each with the power that scalar diffraction
 *   gives it.
 * Both are symmetric in lamp and eye, and know of the two directions only their sum: with wi
 * and wo the unit vectors from the surface to lamp and eye, T's
 *   u = (wi + wo).x along the tracks, v = (wi + wo).y across them.
 */
#ifndef SPEC_OPTICS_DISC_H
#define SPEC_OPTICS_DISC_H

#include <stddef.h>

#include "base/error.h"

struct spec_disc {
	const char *name;
	double track_nm;     /* from track to track, > 0 */
	double pit_nm;       /* mean distance along a track from pit to pit, >= 0 */
	double pit_width_nm; /* 0..track_nm */
	double pit_depth_nm; /* >= 0 */
	double index;        /* refractive, of the clear layer over the pits; > 0 */
	/*
	 * Standard deviation of an order's lobe in direction cosine (by the normal [rad]),
	 * > 0: as the lamp's angular size and the disc's waves make it.
	 */
	double lobe_width;
	/* The constants of the composite model, with T's names for them; all >= 0. */
	double groove_scale;      /* c0 [1/sr] */
	double strip_height;      /* c1 [rad], of a strip's lobe */
	double strip_floor;       /* c2, below the lobes */
	double main_scale_nm;     /* c3 [nm], of the main strip's spikes */
	double main_floor_nm;     /* c4 [nm] */
	double groove_decay;      /* c5 */
	double groove_exponent;   /* beta */
	double side_width_rad;    /* sigma1, width of a side strip's lobe in phase; > 0 */
	double main_width_rad;    /* sigma2, the same of the main strip; > 0 */
	double specular;          /* c_spec [1/sr] */
	double specular_exponent; /* alpha */
	double diffuse;           /* c_diff [1/sr] */
};

/*
 * The disc of that name: "cd", "dvd", "bluray" or "vinyl" (a gramophone record). The model
 * of orders knows of no grooves without pits: it makes a plain mirror of "vinyl".
 * Error: null, SPEC_EUSAGE: no such disc (the message names those that there are).
 */
const struct spec_disc *spec_disc_find(const char *name, struct spec_error *error);

/*
 * The factors of the composite model, T 7.4, 7.7 and 7.8. along: u, -2..2. wavelength_nm > 0.
 *   side strips  f^2 = c1 sqrt(pi) / (2 sigma1) sum over n = -3..3 but 0 of
 *                      exp(-4 (k pit_nm u - 2 pi n)^2 / sigma1^2) + c2,  k = 2 pi / wavelength
 *   main strip   g^2 = c3 (c1 sqrt(pi) / (2 sigma2) exp(-4 (k pit_nm u)^2 / sigma2^2) + c2)
 *                      + c4 [nm]: the weight of a spike, which is a Dirac in wavelength
 *   anisotropy   exp(-c5 |u|^beta), 0..1
 * f^2 and g^2 are T's names and are not squared here.
 */
double spec_disc_side_strips(
	const struct spec_disc *disc, double along, double wavelength_nm);
double spec_disc_main_strip(
	const struct spec_disc *disc, double along, double wavelength_nm);
double spec_disc_anisotropy(const struct spec_disc *disc, double along);

/* The bands in which reflection is wanted. */
struct spec_disc_bands {
	size_t count;
	const double *wavelength_nm; /* [count], ascending, > 0 */
	/*
	 * [count + 1], ascending, > 0: the values are means over bins between these; null:
	 * they are samples at points, linear between.
	 */
	const double *edges_nm;
};

/*
 * Directions of count pixels, each array [count] in double and each vector three planes
 * [count] in float, x, y and z in any one frame. The vectors need not have length 1.
 */
struct spec_disc_directions {
	const float *lamp[3];   /* from the surface to the lamp */
	const float *eye[3];    /* from the surface to the eye */
	const float *normal[3]; /* of the surface */
	/* Along the track, either way; what of it lies along the normal is taken off. */
	const float *tangent[3];
};

/*
 * The sign of across depends on the frame's handedness and the tangent's way, and matters to
 * neither model.
 */
struct spec_disc_pixels {
	size_t count;
	double *along;       /* (wi + wo).x */
	double *across;      /* (wi + wo).y */
	double *half_cosine; /* normal.(wi + wo)/|wi + wo|; 0 where wi + wo = 0 */
	double *lamp_cosine; /* normal.wi: < 0 where the lamp is behind the surface */
	double *eye_cosine;  /* normal.wo */
};

/*
 * Fills the arrays of pixels from directions of as many pixels. All five values are 0 where a
 * vector is 0 or not finite, or where the tangent lies within 1e-6 rad of the normal: the
 * cosines say that nothing is lit there.
 */
void spec_disc_geometry(
	const struct spec_disc_directions *directions, struct spec_disc_pixels *pixels);

/*
 * The composite model, T 7.9 with its errors put right:
 *   f_r = c0 anisotropy (f^2 + g^2) + c_spec |half_cosine|^alpha + c_diff,
 * f^2 at the bands' wavelengths, and g^2 as spikes at track_nm |v| / n, n = 1, 2, ... A bin
 * takes the spikes from its lower edge to below its upper one, each over the bin's width. Of
 * point samples the two around a spike share it linearly, each over half the distance of its
 * neighbours, so that the trapezoidal sum keeps the spike's weight; a sole one takes none. A
 * spike beyond the edges or the outer wavelengths is lost.
 * Given:    pixels  along, across and half_cosine; finite (the two cosines are not used)
 * Returned: reflection[band * stride + pixel], BRDF [1/sr], for stride >= pixels->count. The
 *           lobes of f^2 are computed in float: f^2 is within 1e-6 of itself where c2 is not
 *           below T's.
 * Departs:  T's c_diff (wo.n) is not reciprocal, and stands here without the cosine. T's
 *           listing 7.1 has the sign of c5 wrong, sigma2 in the side strips, c4 outside the
 *           anisotropy, and adds all that is smooth to every spike.
 */
void spec_disc_composite(const struct spec_disc *disc, const struct spec_disc_bands *bands,
	const struct spec_disc_pixels *pixels, double *reflection, size_t stride);

/*
 * The model of orders:
 *   f_r = sum over m of eta_m K(u) K(v - m wavelength / track_nm)
 * with eta_m that of spec_grating_lamellar for the pits' width over track_nm and their depth,
 * at the band's wavelength, and K a normal distribution of standard deviation lobe_width,
 * taken in the mean over the band, so that a narrow lobe does not fall between bands. Bands
 * that are point samples stand for what is nearer to them than to another one (the outer ones
 * reach as far to both sides, but no lower than half their wavelength); a sole one is exact at
 * its wavelength. As cos(theta) d(omega) = du dv over outgoing directions, the integral of
 * f_r cos(theta) is the sum of eta_m over the orders that have a direction.
 * Arguments and result as spec_disc_composite; half_cosine is not used. Beyond 8 standard
 * deviations in u or v, 1e-14 of its height, a lobe may be taken as 0. That the metal absorbs
 * and the clear layer reflects is left to the caller.
 */
void spec_disc_orders(const struct spec_disc *disc, const struct spec_disc_bands *bands,
	const struct spec_disc_pixels *pixels, double *reflection, size_t stride);

#endif
