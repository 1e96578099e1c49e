/* How a spectrum looks: tristimulus values and what is computed from them, for reports. */
#ifndef SPEC_COLOUR_APPEARANCE_H
#define SPEC_COLOUR_APPEARANCE_H

#include <stdio.h>

#include "base/error.h"
#include "base/json.h"
#include "colour/rule.h"
#include "spectrum/curve.h"

/* Who looks, and by which light; afterwards only read, by any threads. */
struct spec_viewing {
	struct spec_curve observer;
	struct spec_curve standard;   /* CIE 1931: of luminance and of temperatures */
	struct spec_curve illuminant; /* relative power per nm */
	double white_xyz[3];          /* the illuminant's by the observer, Y = 1 */
	double neutral_xy[2];         /* of dominant wavelengths of light */
	/*
	 * Of radiance [W m^-2 sr^-1 nm^-1]: cd m^-2, where 1 per nm has Y = 1. That of an
	 * observer without luminous efficiency is NaN.
	 */
	double luminance, observer_luminance;
	int tristimulus; /* the observer sees X, Y, Z; else there are its signals alone */
	enum spec_rule rule;
	int rule_told; /* also in text */
};

/*
 * observer: as in spec_observer_spectrum, or null: "1931". illuminant: a light's name, or
 * null: D65, and equal energy as the white of dominant wavelengths of light, which else is
 * the illuminant too. The rule is "cie", not told; the caller may change both. Errors: those
 * of spec_observer_load, spec_lookup_light and spec_observer_white.
 */
enum spec_status spec_viewing_load(const char *observer, const char *illuminant,
	struct spec_viewing *viewing, struct spec_error *error);
void spec_viewing_free(struct spec_viewing *viewing);

enum spec_seen {
	SPEC_SEEN_NOTHING,    /* neither light nor a ratio, such as an index: all is NaN */
	SPEC_SEEN_REFLECTED,  /* reflectance or transmittance, under the illuminant */
	SPEC_SEEN_RELATIVE,   /* light of which only the ratios of its powers are known */
	SPEC_SEEN_LIGHT,      /* light on a scale of its own */
	SPEC_SEEN_IRRADIANCE, /* power in W m^-2 nm^-1 */
	SPEC_SEEN_RADIANCE    /* light in W m^-2 sr^-1, per nm or per band */
};

/*
 * By the texts of a quantity and a unit, as of curves; "" is not known. A spectral power
 * distribution is an irradiance where its unit is "W m-2 nm-1".
 */
enum spec_seen spec_seen_of(const char *quantity, const char *unit);

/* What has no meaning or is not known is NaN. */
struct spec_appearance {
	/*
	 * Of an observer that sees X, Y, Z; others have signals, the second on Y's scale.
	 * Reflected: Y = 100 for the perfect reflector. Relative: Y = 100. Light: Y = 100 for
	 * 1 per nm at all wavelengths. Radiance: Y in cd m^-2, irradiance: in lx (by the
	 * observer).
	 */
	double xyz[3];
	double xy[2];
	double uv[2]; /* u', v' of the CIE 1976 diagram */
	/*
	 * CIELAB; white is the perfect reflector under the illuminant, for light that with
	 * Y = 1 for 1 per nm at all wavelengths, and for relative light and irradiance
	 * that with the light's own Y.
	 */
	double lab[3];
	double cct_k, duv;          /* of light alone: temperature.h */
	double dominant_nm, purity; /* dominant.h: negative is complementary */
	double luminance;           /* cd m^-2, of radiance alone: 683 lm/W, CIE 1931 */
	double illuminance;         /* lx, of irradiance alone: as well */
	double outside;   /* fraction of Y that is outside of what the spectrum tells of */
	double signal[3]; /* of an observer without X, Y, Z */
	const struct spec_viewing *viewing; /* by which it was found, or null */
};

/* Nothing is known. */
void spec_appearance_clear(struct spec_appearance *appearance);

/*
 * Given:  xyz       by the viewing's observer: Y = 1 for the perfect reflector, or for
 *                   light of 1 per nm at all wavelengths, as spec_observer_weights has it
 *         standard  the same by CIE 1931
 *         white     XYZ with Y = 1 of the perfect reflector, for reflected light; or null:
 *                   the viewing's
 * Light that has no positive Y, and what is not finite, has xyz at most. The viewing must
 * live as long as the appearance.
 * Error:  SPEC_ENOMEM
 */
enum spec_status spec_appearance_find(const struct spec_viewing *viewing,
	enum spec_seen seen, const double xyz[3], const double standard[3],
	const double white[3], struct spec_appearance *appearance,
	struct spec_error *error);

/*
 * That of a column of a curve, which is linear between its samples and nothing beyond them.
 * A curve of one sample, or outside of what the observer sees, has none. Errors: those of
 * spec_rule_weights but SPEC_ERANGE.
 */
enum spec_status spec_appearance_of_curve(const struct spec_viewing *viewing,
	const struct spec_curve *curve, size_t column, struct spec_appearance *appearance,
	struct spec_error *error);

/* Into an object that is open: the keys that specinfo(1) lists; NaN is null. */
void spec_appearance_json(struct spec_json *json, const struct spec_appearance *appearance);

/* A line per thing that is known, each behind lead. */
void spec_appearance_print(
	FILE *stream, const char *lead, const struct spec_appearance *appearance);

#endif
