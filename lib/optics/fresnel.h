/*
 * Reflection at one plane boundary (Born & Wolf, Principles of Optics, 7th ed. 1999,
 * sections 1.5 and 14.2). A complex index is n + ik with the time dependence e^(-iwt): a
 * positive k absorbs. Cosines are those of the angle of incidence, 0 to 1.
 */
#ifndef SPEC_OPTICS_FRESNEL_H
#define SPEC_OPTICS_FRESNEL_H

#include <stddef.h>

#include "base/error.h"

enum spec_polarisation {
	SPEC_POLARISATION_NONE, /* unpolarised: the mean of the two */
	SPEC_POLARISATION_S,    /* the electric field is across the plane of incidence */
	SPEC_POLARISATION_P     /* ... lies in it */
};

/* "u", "s" or "p". Error (SPEC_EUSAGE): another text. */
enum spec_status spec_polarisation_parse(
	const char *text, enum spec_polarisation *polarisation, struct spec_error *error);

/* Reflectances, 0 to 1. */
struct spec_fresnel {
	double s, p;
};

static inline double
spec_fresnel_mean(struct spec_fresnel value, enum spec_polarisation polarisation)
{
	if (polarisation == SPEC_POLARISATION_S)
		return value.s;
	return polarisation == SPEC_POLARISATION_P ? value.p : (value.s + value.p) / 2;
}

/*
 * From an index n1 > 0 to n2 > 0, both real (Born & Wolf 1.5.2 (21a)); beyond the critical
 * angle 1. What is not reflected is transmitted.
 */
struct spec_fresnel spec_fresnel_dielectric(double cosine, double n1, double n2);

/*
 * From an index n1 > 0 to n2 + ik2 in real arithmetic (Born & Wolf 14.2 (4), (6)). What is
 * not reflected is transmitted, and absorbed behind the boundary where k2 > 0.
 */
struct spec_fresnel spec_fresnel_conductor(double cosine, double n1, double n2, double k2);

/* The same at count wavelengths: n1, n2, k2, s and p are arrays of count. */
void spec_fresnel_spectrum(double cosine, const double *n1, const double *n2,
	const double *k2, size_t count, double *s, double *p);

#endif
