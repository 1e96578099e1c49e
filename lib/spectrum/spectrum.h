/*
 * Spectra in the representations of a framework for spectral rendering: samples, a table,
 * a Fourier series, a composite of a smooth part and lines, a colour.
 * Sources: equations "T" are those of a thesis (in Dutch) on rendering thin films and
 *          gratings with spectra in pbrt, chapter 3; the Fourier and the composite
 *          representation are of Y. Sun, F. D. Fracchia, M. S. Drew: A Composite Model for
 *          Representing Spectral Functions, TR 1998-18, Simon Fraser University, 1998.
 */
#ifndef SPEC_SPECTRUM_SPECTRUM_H
#define SPEC_SPECTRUM_SPECTRUM_H

#include <stddef.h>

#include "base/error.h"
#include "spectrum/curve.h"
#include "spectrum/interpolate.h"
#include "spectrum/sigmoid.h"

/* The range that stands for all wavelengths where a kind has no ends: the observers'. */
#define SPEC_SPECTRUM_LOW_NM 360.
#define SPEC_SPECTRUM_HIGH_NM 830.

#define SPEC_SPECTRUM_MOST_SAMPLES 1000000
#define SPEC_SPECTRUM_MOST_COEFFICIENTS 4097
#define SPEC_SPECTRUM_MOST_LINES 4096

/* Of the smooth part; with lines beside it a spectrum is a composite. */
enum spec_spectrum_kind {
	SPEC_SPECTRUM_CONSTANT,  /* level at all wavelengths */
	SPEC_SPECTRUM_BLACKBODY, /* Planck's law, level at its peak, at all wavelengths */
	SPEC_SPECTRUM_RGB,       /* the sigmoid that stands for a colour, at all of them */
	SPEC_SPECTRUM_FOURIER,   /* T 3.1 over low_nm..high_nm */
	SPEC_SPECTRUM_TABULATED, /* values at any wavelengths */
	SPEC_SPECTRUM_SAMPLED,   /* values at equal distances from low_nm to high_nm */
	SPEC_SPECTRUM_COMPOSITE  /* T 3.4: of a whole, never of the smooth part */
};

/* A line (T 3.5): weight times Dirac's delta, so its weight is its energy. */
struct spec_line {
	double wavelength_nm; /* > 0 */
	double weight;        /* [unit of the spectrum x nm]; not 0 */
};

struct spec_spectrum {
	/* Never null once filled; "" where nothing is known. As in a curve. */
	char *title, *quantity, *unit, *source, *medium;

	enum spec_spectrum_kind smooth;
	enum spec_interpolate interpolate; /* of samples and tables */
	/* Ends of samples, a table and a Fourier series; 0 and infinity of the others. */
	double low_nm, high_nm;
	size_t count; /* of values */
	/* Sampled, tabulated: [count], > 0, strictly ascending, the ends among them. */
	double *wavelength_nm;
	/* Sampled, tabulated: [count]. Fourier: count is odd; a0, a1, b1, a2, b2, … */
	double *value;
	double level;         /* constant, blackbody */
	double temperature_k; /* blackbody, > 0 */
	double rgb[3];        /* RGB: the colour that the sigmoid stands for, linear */
	struct spec_sigmoid sigmoid;

	size_t lines;
	struct spec_line *line; /* ascending, no wavelength twice */
};

/* The kind of the whole: SPEC_SPECTRUM_COMPOSITE where there are lines. */
enum spec_spectrum_kind spec_spectrum_kind(const struct spec_spectrum *spectrum);

/* "fourier" and so on. */
const char *spec_spectrum_kind_name(enum spec_spectrum_kind kind);

/*
 * Makers. All texts are "" and there are no lines. Errors: SPEC_ENOMEM, SPEC_ERANGE (what
 * lies outside the limits above and below, or is not finite); then spectrum is empty.
 */

/*
 * Samples at low_nm + i (high_nm - low_nm) / (count - 1), i < count; count >= 2,
 * 0 < low_nm < high_nm. Sprague's interpolation needs 6 samples.
 */
enum spec_status spec_spectrum_sampled(double low_nm, double high_nm, const double *value,
	size_t count, enum spec_interpolate interpolate, struct spec_spectrum *spectrum,
	struct spec_error *error);

/*
 * Any wavelengths, ascending and > 0. Sprague's interpolation needs 6 that are equidistant
 * to 1e-6 of their distance.
 */
enum spec_status spec_spectrum_tabulated(const double *wavelength_nm, const double *value,
	size_t count, enum spec_interpolate interpolate, struct spec_spectrum *spectrum,
	struct spec_error *error);

/* T 3.1 with count coefficients a0, a1, b1, a2, b2, …: an odd number. 0 < low_nm < high_nm. */
enum spec_status spec_spectrum_fourier(double low_nm, double high_nm,
	const double *coefficient, size_t count, struct spec_spectrum *spectrum,
	struct spec_error *error);

enum spec_status spec_spectrum_constant(
	double level, struct spec_spectrum *spectrum, struct spec_error *error);

/* temperature_k > 0; level: its value at the peak. */
enum spec_status spec_spectrum_blackbody(double temperature_k, double level,
	struct spec_spectrum *spectrum, struct spec_error *error);

/* A colour and the sigmoid that stands for it (colour/upsample.h finds one). */
enum spec_status spec_spectrum_rgb(const double rgb[3], const struct spec_sigmoid *sigmoid,
	struct spec_spectrum *spectrum, struct spec_error *error);

/*
 * Adds lines: in any order; lines at one wavelength become one, and those that weigh 0 go.
 * SPEC_ERANGE: a wavelength that is not positive, a number that is not finite.
 */
enum spec_status spec_spectrum_add_lines(struct spec_spectrum *spectrum,
	const struct spec_line *line, size_t count, struct spec_error *error);

/* One column of a curve, with its texts, as a table that is linear between its samples. */
enum spec_status spec_spectrum_from_curve(const struct spec_curve *curve, size_t column,
	struct spec_spectrum *spectrum, struct spec_error *error);

/* copy becomes a spectrum of its own. SPEC_ENOMEM; then copy is empty. */
enum spec_status spec_spectrum_copy(const struct spec_spectrum *source,
	struct spec_spectrum *copy, struct spec_error *error);

/* The texts of from, as those of to. */
enum spec_status spec_spectrum_copy_texts(const struct spec_spectrum *from,
	struct spec_spectrum *to, struct spec_error *error);

/* Frees what spectrum holds and leaves it empty; null or empty is allowed. */
void spec_spectrum_free(struct spec_spectrum *spectrum);

/*
 * The range that stands for a spectrum: its ends, and those of the observers where it has
 * none.
 */
void spec_spectrum_range(
	const struct spec_spectrum *spectrum, double *low_nm, double *high_nm);

/*
 * The smooth part at count wavelengths [nm], in any order. Wavelengths within 1e-9 of an
 * end count as that end; beyond, extrapolate rules (T has 0). T 3.1 repeats itself beyond
 * its ends; here it ends there like the others.
 * Errors: SPEC_ERANGE  a wavelength outside under SPEC_EXTRAPOLATE_REFUSE; NaN
 */
enum spec_status spec_spectrum_sample(const struct spec_spectrum *spectrum,
	enum spec_extrapolate extrapolate, const double *wavelength_nm, size_t count,
	double *value, struct spec_error *error);

/*
 * The means of the whole over bins: of the smooth part, and weight over width of each line
 * in the bin that holds it. A bin holds its lower edge and not its upper one, and the last
 * bin both, so every line in the range counts once, and mean times width summed over the
 * bins is the energy between the outermost edges.
 * Given:    edges_nm     bins + 1, > 0, finite, ascending
 *           extrapolate  what the smooth part is outside its ends; lines are where they are
 * Accuracy: to rounding, but within 1e-6 of the scale of a colour, and for black bodies in
 *           bins up to 20 nm wide as planck.h says (wider ones are divided)
 * Errors:   SPEC_ERANGE  edges that do not ascend; outside, as in spec_spectrum_sample
 */
enum spec_status spec_spectrum_mean(const struct spec_spectrum *spectrum,
	enum spec_extrapolate extrapolate, const double *edges_nm, size_t bins,
	double *value, struct spec_error *error);

/*
 * The energy of the whole between two wavelengths: the integral of the smooth part and the
 * weights of the lines from low_nm to high_nm, both included. As spec_spectrum_mean.
 */
enum spec_status spec_spectrum_integral(const struct spec_spectrum *spectrum,
	enum spec_extrapolate extrapolate, double low_nm, double high_nm, double *integral,
	struct spec_error *error);

#endif
