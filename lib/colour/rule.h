/*
 * Rules of integration: how the bands of an image become tristimulus values, and what
 * luminance these are.
 */
#ifndef SPEC_COLOUR_RULE_H
#define SPEC_COLOUR_RULE_H

#include "base/error.h"
#include "colour/observer.h"
#include "spectrum/curve.h"

enum spec_rule {
	SPEC_RULE_CIE, /* sums by 1 nm, or the observer's steps: observer.h (CIE 15:2018) */
	SPEC_RULE_GRID, /* the trapezoid over the spectrum's own wavelengths */
	SPEC_RULE_ASTM /* weights for reflectance by 10 or 20 nm: abridged.h (ASTM E308-15) */
};

/* "cie", "grid" or "astm"; else SPEC_EUSAGE. */
enum spec_status spec_rule_find(
	const char *name, enum spec_rule *rule, struct spec_error *error);

const char *spec_rule_name(enum spec_rule rule);

/*
 * What a rule is, in words for a reader, such as "the trapezoid over the
 * spectrum's own wavelengths".
 */
const char *spec_rule_title(enum spec_rule rule);

/* What the weights of an image are besides themselves. */
struct spec_rule_sums {
	double outside; /* as spec_observer_weights has it, by its rule whatever this one is */
	/*
	 * XYZ with Y = 1 of the perfect reflector, or of light that is the same at all
	 * wavelengths. By the rules "grid" and "astm" that of a reflector is the sum of the
	 * weights.
	 */
	double white[3];
	/*
	 * [nm, times the illuminant's unit where there is one] the integral of y, or S y, by
	 * which Y was divided: a Y of 1 has the luminance of efficacy times this, where the
	 * values are radiance per nm or per band, or the illuminant's are that of the perfect
	 * reflector.
	 */
	double integral;
};

/*
 * The weights of the bands for X, Y and Z by a rule; arguments, units and errors as
 * spec_observer_weights.
 * grid:   Bins weigh the observer [times the illuminant] at their middles, times their
 *         widths; points by the trapezoid; values per band at their wavelengths or middles.
 *         Observer and illuminant are linear between their samples and zero outside.
 *         Reflectance is divided by the same sum of S y, so that the perfect reflector has
 *         Y = 1 exactly; light, as by "cie", by the sum over the observer's whole table.
 * astm:   Reflectance and transmittance at points, bands 10 or 20 nm apart.
 * Besides: SPEC_EUSAGE of "astm", light or bins; those of spec_abridged_weights;
 *         SPEC_EFORMAT of "grid", no finite, positive y at these bands.
 */
enum spec_status spec_rule_weights(enum spec_rule rule, const struct spec_curve *observer,
	const struct spec_curve *illuminant, const struct spec_bands *bands, double *weight,
	struct spec_rule_sums *sums, struct spec_error *error);

/*
 * The luminous efficacy [lm/W] of what an observer calls y = 1: 683 lm/W over its y at the
 * wavelength of 540 THz in standard air, 555.016 nm, where the candela is defined (SI Brochure
 * 2019; CIE S 017:2020, 17-21-092). That is 683.002 for V(lambda), which the CIE rounds to the
 * 683 lm/W that is returned for it (CIE 15:2018, 7.1); 683.6 for the observer of 1964, 683.36
 * and 683.15 for those of 2015, 1700 for scotopic vision.
 * NaN where the observer has no y: sensors, or a curve that is no luminous efficiency.
 */
double spec_rule_efficacy(const struct spec_curve *observer);

#endif
