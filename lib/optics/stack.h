/*
 * Plane layers between two half-spaces, coherent: reflectance and transmittance by the
 * admittances of Macleod, Thin-Film Optical Filters, 4th ed. 2010, section 2.6, in a form
 * that neither overflows nor loses digits in layers that absorb or are evanescent, however
 * thick or many they are. Indices are n + ik with e^(-iwt): a positive k absorbs.
 */
#ifndef SPEC_OPTICS_STACK_H
#define SPEC_OPTICS_STACK_H

#include <stddef.h>

#include "base/error.h"
#include "optics/fresnel.h"

struct spec_stack {
	size_t layers; /* between ambient and substrate; 0: a bare surface */
	size_t varied; /* the layer, from 1, whose thickness is given apart; 0: none */
	double *thickness_nm; /* [layers], from the ambient on; >= 0 */
	size_t wavelengths;
	double *wavelength_nm; /* [wavelengths], > 0, in vacuum or as the indices have it */
	double *n, *k; /* [(layers + 2) * wavelengths], ambient first, substrate last */
};

/* An empty stack of that size, for the caller to fill in: everything is 0. SPEC_ENOMEM. */
enum spec_status spec_stack_new(size_t layers, size_t wavelengths, struct spec_stack *stack,
	struct spec_error *error);
void spec_stack_free(struct spec_stack *stack);

/* reversed becomes the same stack seen from its substrate. SPEC_ENOMEM. */
enum spec_status spec_stack_reverse(const struct spec_stack *stack,
	struct spec_stack *reversed, struct spec_error *error);

/*
 * Whether light can arrive from the ambient: it does not absorb and has an index above 0,
 * at all wavelengths. The functions below need that.
 */
int spec_stack_is_lit(const struct spec_stack *stack);

/*
 * At all wavelengths, for one angle. cosine: of the angle of incidence, in the ambient,
 * 0 to 1. varied_nm: the thickness of the varied layer, if there is one. reflectance and
 * transmittance: [wavelengths], shares of the incident power, 0 to 1; what both leave of 1
 * was absorbed. The transmitted power is that which enters the substrate.
 */
void spec_stack_spectrum(const struct spec_stack *stack, double cosine, double varied_nm,
	enum spec_polarisation polarisation, double *reflectance, double *transmittance);

/*
 * At one wavelength, for count pixels with a cosine and a varied_nm each; varied_nm may be
 * null where no layer is varied. reflectance and transmittance: [count].
 */
void spec_stack_row(const struct spec_stack *stack, size_t wavelength, const double *cosine,
	const double *varied_nm, size_t count, enum spec_polarisation polarisation,
	double *reflectance, double *transmittance);

#endif
