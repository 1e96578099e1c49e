/* A stack with its thickness, ready to be looked at from both sides at given wavelengths. */
#ifndef SPEC_OPTICS_COATING_H
#define SPEC_OPTICS_COATING_H

#include <stddef.h>

#include "base/error.h"
#include "optics/recipe.h"
#include "optics/stack.h"
#include "optics/thickness.h"
#include "spectrum/curve.h"

/*
 * An extinction coefficient below which a half-space counts as clear: light of 550 nm falls
 * to 1/e over 0.4 mm of it, and glass and water have 1e-9 to 1e-6.
 */
#define SPEC_COATING_CLEAR 1e-4

struct spec_coating {
	struct spec_stack front, back;   /* from the ambient, from the substrate */
	struct spec_thickness thickness; /* of the varied layer, if there is one */
	int clear_behind; /* the substrate does not absorb: light can come from it */
	double *from_behind, *from_before; /* [wavelengths] see spec_coating_row */
};

/*
 * thickness: of the recipe's layer that varies; null: the recipe has all thicknesses.
 * wavelength_nm: [count], > 0. extrapolate: of the indices. Errors: an index is not known
 * at a wavelength (SPEC_ERANGE), the ambient absorbs, a thickness is missing or has no one
 * layer to go to (SPEC_EUSAGE).
 */
enum spec_status spec_coating_make(struct spec_coating *coating,
	const struct spec_recipe *recipe, const struct spec_thickness *thickness,
	const double *wavelength_nm, size_t count, enum spec_extrapolate extrapolate,
	struct spec_error *error);
void spec_coating_free(struct spec_coating *coating);

/*
 * At one wavelength, by its number, for count pixels: what radiance is multiplied by when it
 * is mirrored, and when it comes through to the eye. behind: the eye is in the substrate
 * (then it must be clear). cosine: 0 to 1, in the eye's medium. The transmittance of power
 * is multiplied by (n_eye / n_light)^2, as a beam's solid angle shrinks and grows with the
 * index (T listing 6.2 has it upside down); it is 0 where the substrate absorbs.
 */
void spec_coating_row(const struct spec_coating *coating, size_t wavelength, int behind,
	const double *cosine, const double *thickness_nm, size_t count,
	enum spec_polarisation polarisation, double *mirrored, double *through);

/* The same for one pixel at all wavelengths, unpolarised: mirrored and through [count]. */
void spec_coating_spectrum(const struct spec_coating *coating, int behind, double cosine,
	double thickness_nm, double *mirrored, double *through);

/* What of 1 is left, but for what rounding leaves of it: the absorptance. */
double spec_coating_absorptance(double reflectance, double transmittance);

/*
 * Reflectance R, transmittance T and absorptance A = 1 - R - T from the front as a curve of
 * three columns. cosine: of the angle of incidence, 0 to 1. A constant thickness alone.
 */
enum spec_status spec_coating_curve(const struct spec_coating *coating, double cosine,
	enum spec_polarisation polarisation, struct spec_curve *curve,
	struct spec_error *error);

#endif
