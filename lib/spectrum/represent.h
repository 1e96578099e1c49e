/* From one representation of a spectrum to another. */
#ifndef SPEC_SPECTRUM_REPRESENT_H
#define SPEC_SPECTRUM_REPRESENT_H

#include <stddef.h>

#include "base/error.h"
#include "spectrum/grid.h"
#include "spectrum/spectrum.h"

/* What a spectrum shall become. */
struct spec_representation {
	/* SAMPLED, TABULATED, FOURIER, COMPOSITE or CONSTANT */
	enum spec_spectrum_kind kind;
	/* Sampled, Fourier, constant: the range; both 0: the spectrum's own. */
	double low_nm, high_nm;
	/*
	 * Sampled: samples, 0: as many as spec_spectrum_grid gives. Fourier: coefficients, odd.
	 * Composite: lines at most.
	 */
	size_t count;
	size_t coefficients; /* composite: of its smooth part; 0: that stays what it is */
	const struct spec_grid *grid;      /* tabulated; null: spec_spectrum_grid's */
	enum spec_interpolate interpolate; /* sampled, tabulated */
	enum spec_extrapolate extrapolate;
};

/*
 * "sampled", "sampled:LO:HI:STEP", "tabulated", "fourier:N", "composite:K" or
 * "composite:K,N". No range but that of samples; the other members stay what they are.
 * SPEC_EUSAGE: another text; SPEC_ERANGE: numbers out of range.
 */
enum spec_status spec_representation_parse(const char *text,
	struct spec_representation *representation, struct spec_error *error);

/*
 * The wavelengths that stand for a spectrum where it has to be sampled: those of its
 * samples; else equal steps over its range (spec_spectrum_range), at most 1 nm and at most
 * a sixteenth of the shortest wave of a Fourier series, as far as SPEC_GRID_LONGEST allows.
 * To be freed with free; null: SPEC_ENOMEM.
 */
double *spec_spectrum_grid(
	const struct spec_spectrum *spectrum, size_t *count, struct spec_error *error);

/*
 * All conversions go through the values of the smooth part; some keep more:
 *   to Fourier    from Fourier over the same range, coefficients are cut off or 0 added.
 *                 Of samples and tables T 3.2 and 3.3 are integrated exactly, whatever lies
 *                 between the samples; of other kinds to about 1e-12 (as polynomials of
 *                 degree 5 over each nm). Lines enter as what they are, w cos(n u) and
 *                 w sin(n u). So a0, the energy, is exact, and lines outside the range and
 *                 what is smooth there are left out.
 *   to samples, tabulated
 *                 the values at the wavelengths. Lines become narrow peaks of their weight:
 *                 with linear interpolation a line between two samples gives each the share
 *                 that keeps the energy and its centre; with left and nearest it goes where
 *                 it would be read. At the samples themselves nothing else changes. With
 *                 Sprague's it is as with linear, whose energy it has but in the two
 *                 outermost steps. Lines outside the range are left out.
 *   to composite  lines stay and so does the smooth part, but becomes a Fourier series where
 *                 coefficients are asked for. Without lines, those of samples and tables are
 *                 looked for, see below.
 *   to constant   the mean over the range, lines included.
 * The texts are kept.
 *
 * Lines of samples and tables that are linear between: a peak is a sample higher than the
 * one before and not lower than the one after, with a foot on each side: where, going down
 * from it, the next step is less than a twentieth of the way come down so far. It is a line
 * where its feet are at most 30 nm apart, or the samples beside the peak, and where it rises
 * above its base by more than a tenth of the base. The base joins the feet: a cubic through
 * them and the samples next to them outside, where those belong to no other peak, else
 * straight; never above the samples, nor below 0 and both feet. The count heaviest lines are
 * taken out: smooth becomes their bases, weight is what lay above in the samples' integral,
 * and wavelength its centre, a single sample's own. So lines and smooth part together keep
 * the energy to rounding, and a cubic with spikes in single samples is taken apart exactly.
 *
 * Errors: SPEC_ERANGE        numbers out of range; the wavelengths leave the spectrum's
 *                            under SPEC_EXTRAPOLATE_REFUSE; more lines than asked for
 *         SPEC_EUNSUPPORTED  to black body or RGB (colour/upsample.h); lines of samples
 *                            that are not linear between
 *         SPEC_ENOMEM. Then result is empty.
 */
enum spec_status spec_spectrum_convert(const struct spec_spectrum *source,
	const struct spec_representation *representation, struct spec_spectrum *result,
	struct spec_error *error);

/* A spectrum as a curve of one column, converted to a table on spec_spectrum_grid. */
enum spec_status spec_spectrum_to_curve(const struct spec_spectrum *spectrum,
	struct spec_curve *curve, struct spec_error *error);

/*
 * The lines of samples, as above.
 * Given:    samples  linear between; count >= 1
 * Returned: line     the heaviest, at most *lines of them, by wavelength; *lines: how many
 *           smooth   [count] what remains at the samples
 */
enum spec_status spec_samples_lines(const struct spec_samples *samples,
	struct spec_line *line, size_t *lines, double *smooth, struct spec_error *error);

#endif
