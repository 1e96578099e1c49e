/*
 * Spectra of light for RGB colours after Sun: three Gaussians, of red, green and blue,
 *     sum over i of weight[i] exp(-ln 2 (2 (l - c_i) / w)^2),  c = 680, 550, 450 nm,
 * the narrower the more saturated the colour is, weighted so that the colour is met.
 * Source: Sun, Fracchia, Calvert, Drew: Deriving spectra from colors and rendering light
 *         interference. IEEE Computer Graphics and Applications 19 (4), 1999, 61-67.
 * Reading: w is the width at half height, w = 150 nm + s (10 nm - 150 nm). s is the purity
 *         of excitation: how far the colour's chromaticity (CIE 1931) is from white, over
 *         how far the spectrum locus or the line of purples is in that direction. Where a
 *         weight would be negative, the colour lies outside the triangle of the three
 *         Gaussians' colours: then they get narrower, by 1 % at a time, until it does not.
 *         A weight that is negative even at 10 nm is 0; such are the deepest blues alone.
 * These are no reflectances: narrow ones rise far above 1.
 */
#ifndef SPEC_COLOUR_GAUSSIAN_H
#define SPEC_COLOUR_GAUSSIAN_H

#include <stddef.h>

#include "base/error.h"
#include "colour/space.h"

#define SPEC_GAUSSIAN_WIDEST_NM 150.0
#define SPEC_GAUSSIAN_NARROWEST_NM 10.0
#define SPEC_GAUSSIAN_STEP .99        /* from one width to the next narrower one */
#define SPEC_GAUSSIAN_DIRECTIONS 4096 /* of the locus from white, linear between */

/* What colours of one space are solved for; afterwards only read, by any threads. */
struct spec_gaussian_fit {
	size_t count;          /* the observer's samples */
	double *wavelength_nm; /* [count] */
	double *weight;        /* [3 * count]: XYZ of such a spectrum */
	double to_xyz[9];      /* from linear RGB */
	double white_xy[2];
	/* One over the locus's distance from white, by direction, from -pi to pi. */
	double nearness[SPEC_GAUSSIAN_DIRECTIONS + 1];
};

struct spec_gaussians {
	double width_nm;  /* at half height */
	double weight[3]; /* red, green, blue, each >= 0 */
};

/*
 * lit: 0, the spectra are of light itself, of which 1 per nm has Y = 1; 1, they are what
 * the space's white light is multiplied by. Errors: those of spec_upsampler_load,
 * spec_lookup_curve and spec_observer_weights.
 */
enum spec_status spec_gaussian_load(const struct spec_space *space, int lit,
	struct spec_gaussian_fit *fit, struct spec_error *error);
void spec_gaussian_free(struct spec_gaussian_fit *fit);

/* The width for a colour: rgb, linear, finite, >= 0. Black is white as to its hue. */
double spec_gaussian_width(const struct spec_gaussian_fit *fit, const double rgb[3]);

/* The matrix from linear RGB to the weights for a width. Error: SPEC_ERANGE, no inverse. */
enum spec_status spec_gaussian_matrix(const struct spec_gaussian_fit *fit, double width_nm,
	double m[9], struct spec_error *error);

/* Whether no weight is negative, but for rounding. */
int spec_gaussian_is_met(const double weight[3]);

/* The spectrum of a colour: rgb, linear, finite, >= 0. Errors: SPEC_ERANGE. */
enum spec_status spec_gaussian_solve(const struct spec_gaussian_fit *fit,
	const double rgb[3], struct spec_gaussians *gaussians, struct spec_error *error);

/* The i-th Gaussian, 0 to 2, of weight 1: at a wavelength, and its exact mean over a bin. */
double spec_gaussian_component(int i, double width_nm, double wavelength_nm);
double spec_gaussian_component_mean(int i, double width_nm, double from_nm, double to_nm);

/* The spectrum at count wavelengths, and its means over bins between bins + 1 edges. */
void spec_gaussians_sample(const struct spec_gaussians *gaussians,
	const double *wavelength_nm, size_t count, double *value);
void spec_gaussians_mean(const struct spec_gaussians *gaussians, const double *edges_nm,
	size_t bins, double *value);

#endif
