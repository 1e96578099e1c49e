/*
 * Dispersion formulas: the refractive index n of a transparent medium over wavelength.
 * Indices are relative to air. l is the wavelength in um.
 */
#ifndef SPEC_OPTICS_DISPERSION_H
#define SPEC_OPTICS_DISPERSION_H

#include <stddef.h>

#include "base/error.h"

#define SPEC_DISPERSION_MOST 16 /* coefficients */

/*
 * The formulas, with their coefficients in this order. The numbers are those of the page
 * "Dispersion formulas" of M. N. Polyanskiy, "Refractiveindex.info database of optical
 * constants", Sci. Data 11, 94 (2024).
 */
enum spec_dispersion_kind {
	/*
	 * n^2 = 1 + sum of B l^2 / (l^2 - C), C in um^2. Formula 2; as in SCHOTT's
	 * catalogue, P. Hartmann, Optical Glass, SPIE (2014), eq. (3.12). Coefficients: B1,
	 * C1, B2, C2, …, an even number; a pair whose C is 0 adds its B alone.
	 */
	SPEC_DISPERSION_SELLMEIER,
	/*
	 * n^2 = 1 + sum of B l^2 / (l^2 - L^2), L in um: the wavelengths of the resonances.
	 * Formula 1; W. Sellmeier, Annalen der Physik und Chemie 219, 272 (1871), and
	 * I. H. Malitson on fused silica, J. Opt. Soc. Am. 55, 1205 (1965). Coefficients:
	 * B1, L1, B2, L2, …, an even number.
	 */
	SPEC_DISPERSION_SELLMEIER_UM,
	/* n = A + B / l^2 + C / l^4 + …. Formula 5, even powers; A.-L. Cauchy (1836). */
	SPEC_DISPERSION_CAUCHY,
	/*
	 * n^2 = a0 + a1 l^2 + a2 / l^2 + a3 / l^4 + a4 / l^6 + …. Formula 3, even powers;
	 * SCHOTT's older catalogues, up to a5.
	 */
	SPEC_DISPERSION_SCHOTT,
	/*
	 * n = n0 + A / l + B / l^3.5. Formula 5 with these powers; A. E. Conrady, Applied
	 * Optics and Optical Design, part 2 (1960). Three coefficients.
	 */
	SPEC_DISPERSION_CONRADY
};

struct spec_dispersion {
	enum spec_dispersion_kind kind;
	double coefficient[SPEC_DISPERSION_MOST];
	size_t count; /* of coefficients */
};

/*
 * The name of a formula, as spec_index_parse reads it: "sellmeier", "sellmeier-um",
 * "cauchy", "schott", "conrady"; null for what is no kind.
 */
const char *spec_dispersion_name(enum spec_dispersion_kind kind);

/* SPEC_EUSAGE: no such kind, not its number of coefficients, or one that is not finite. */
enum spec_status spec_dispersion_check(
	const struct spec_dispersion *dispersion, struct spec_error *error);

/*
 * The refractive index at count wavelengths.
 * wavelength_nm: positive and finite, in any order. n: room for count values; it must not
 * overlap wavelength_nm.
 * SPEC_EUSAGE as spec_dispersion_check. SPEC_ERANGE: a wavelength is not positive and
 * finite, or the formula gives no n there that is (no n^2, where it gives n^2); the message
 * names the wavelength, and what n then holds is undefined. A formula does not know for
 * which wavelengths it was made: the caller has to.
 */
enum spec_status spec_dispersion_sample(const struct spec_dispersion *dispersion,
	const double *wavelength_nm, size_t count, double *n, struct spec_error *error);

/*
 * The Abbe number V_d = (n_d - 1) / (n_F - n_C) at the lines d, 587.5618 nm (helium), and F
 * and C, 486.1327 and 656.2725 nm (hydrogen). SCHOTT, TIE-29: Refractive index and
 * dispersion (2005), section 2; the lines: ISO 7944:1998.
 * Errors as spec_dispersion_sample; SPEC_ERANGE also where n_F is n_C.
 */
enum spec_status spec_dispersion_abbe(
	const struct spec_dispersion *dispersion, double *abbe, struct spec_error *error);

#endif
