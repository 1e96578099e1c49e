#include "optics/dispersion.h"

#include <math.h>

#include "base/vector.h"

#define NM_PER_UM 1e3

static const struct formula {
	const char *name;
	size_t least, most, step; /* numbers of coefficients */
	int squared;              /* it gives n^2 */
} formulas[] = {
	[SPEC_DISPERSION_SELLMEIER] = {"sellmeier", 2, SPEC_DISPERSION_MOST, 2, 1},
	[SPEC_DISPERSION_SELLMEIER_UM] = {"sellmeier-um", 2, SPEC_DISPERSION_MOST, 2, 1},
	[SPEC_DISPERSION_CAUCHY] = {"cauchy", 1, SPEC_DISPERSION_MOST, 1, 0},
	[SPEC_DISPERSION_SCHOTT] = {"schott", 1, SPEC_DISPERSION_MOST, 1, 1},
	[SPEC_DISPERSION_CONRADY] = {"conrady", 3, 3, 1, 0},
};

static const struct formula *
find_formula(enum spec_dispersion_kind kind)
{
	return (size_t)kind < sizeof formulas / sizeof formulas[0] ? &formulas[kind] : NULL;
}

const char *
spec_dispersion_name(enum spec_dispersion_kind kind)
{
	const struct formula *formula = find_formula(kind);

	return formula ? formula->name : NULL;
}

enum spec_status
spec_dispersion_check(const struct spec_dispersion *dispersion, struct spec_error *error)
{
	const struct formula *formula = find_formula(dispersion->kind);
	size_t count = dispersion->count;

	if (!formula)
		return spec_error_set(
			error, SPEC_EUSAGE, "there is no such dispersion formula");
	if (count < formula->least || count > formula->most) {
		if (formula->least == formula->most)
			return spec_error_set(error, SPEC_EUSAGE,
				"%s takes %zu coefficients, not %zu", formula->name,
				formula->least, count);
		return spec_error_set(error, SPEC_EUSAGE,
			"%s takes %zu to %zu coefficients, not %zu", formula->name,
			formula->least, formula->most, count);
	}
	if (count % formula->step != 0)
		return spec_error_set(error, SPEC_EUSAGE,
			"%s takes pairs of coefficients, and %zu is an odd number",
			formula->name, count);
	for (size_t i = 0; i < count; i++) {
		if (!isfinite(dispersion->coefficient[i]))
			return spec_error_set(error, SPEC_EUSAGE,
				"coefficient %zu of %s is not finite", i + 1,
				formula->name);
	}
	return SPEC_OK;
}

/* sum += strength l^2 / (l^2 - resonance_um2) */
SPEC_VECTORISED static void
add_resonance(const double *restrict wavelength_nm, size_t count, double strength,
	double resonance_um2, double *restrict sum)
{
	for (size_t i = 0; i < count; i++) {
		double um = wavelength_nm[i] / NM_PER_UM;

		sum[i] += strength * (um * um) / (um * um - resonance_um2);
	}
}

/* sum = sum / l^2 + coefficient, a step of Horner's scheme */
SPEC_VECTORISED static void
add_power(const double *restrict wavelength_nm, size_t count, double coefficient,
	double *restrict sum)
{
	for (size_t i = 0; i < count; i++) {
		double um = wavelength_nm[i] / NM_PER_UM;

		sum[i] = sum[i] / (um * um) + coefficient;
	}
}

/* sum += coefficient l^2 */
SPEC_VECTORISED static void
add_square(const double *restrict wavelength_nm, size_t count, double coefficient,
	double *restrict sum)
{
	for (size_t i = 0; i < count; i++) {
		double um = wavelength_nm[i] / NM_PER_UM;

		sum[i] += coefficient * (um * um);
	}
}

SPEC_VECTORISED static void
set_conrady(const double *restrict wavelength_nm, size_t count,
	const double *restrict coefficient, double *restrict n)
{
	for (size_t i = 0; i < count; i++) {
		double um = wavelength_nm[i] / NM_PER_UM;

		n[i] = coefficient[0] +
		       (coefficient[1] + coefficient[2] / (um * um * sqrt(um))) / um;
	}
}

SPEC_VECTORISED static void
take_roots(double *value, size_t count)
{
	for (size_t i = 0; i < count; i++)
		value[i] = sqrt(value[i]);
}

/* The formula itself: n, or n^2 for those that give that. */
static void
evaluate(const struct spec_dispersion *dispersion, const double *wavelength_nm,
	size_t count, double *value)
{
	const double *coefficient = dispersion->coefficient;
	int sellmeier = dispersion->kind == SPEC_DISPERSION_SELLMEIER ||
			dispersion->kind == SPEC_DISPERSION_SELLMEIER_UM;
	int schott = dispersion->kind == SPEC_DISPERSION_SCHOTT;

	for (size_t i = 0; i < count; i++)
		value[i] = sellmeier;
	if (dispersion->kind == SPEC_DISPERSION_CONRADY) {
		set_conrady(wavelength_nm, count, coefficient, value);
		return;
	}
	for (size_t i = 0; sellmeier && i < dispersion->count; i += 2) {
		double at = coefficient[i + 1];

		if (dispersion->kind == SPEC_DISPERSION_SELLMEIER_UM)
			at *= at;
		add_resonance(wavelength_nm, count, coefficient[i], at, value);
	}
	/* Schott's a1 is the one that does not belong to 1 / l^2. */
	for (size_t i = dispersion->count; !sellmeier && i > 0; i--) {
		if (!schott || i != 2)
			add_power(wavelength_nm, count, coefficient[i - 1], value);
	}
	if (schott && dispersion->count > 1)
		add_square(wavelength_nm, count, coefficient[1], value);
}

static int
is_positive(double value)
{
	return value > 0 && isfinite(value);
}

enum spec_status
spec_dispersion_sample(const struct spec_dispersion *dispersion,
	const double *wavelength_nm, size_t count, double *n, struct spec_error *error)
{
	enum spec_status status = spec_dispersion_check(dispersion, error);
	const struct formula *formula = find_formula(dispersion->kind);

	if (status != SPEC_OK)
		return status;
	for (size_t i = 0; i < count; i++) {
		if (!is_positive(wavelength_nm[i]))
			return spec_error_set(error, SPEC_ERANGE,
				"the wavelength %.10g nm is not positive and finite",
				wavelength_nm[i]);
	}
	evaluate(dispersion, wavelength_nm, count, n);
	for (size_t i = 0; i < count; i++) {
		if (!is_positive(n[i]))
			return spec_error_set(error, SPEC_ERANGE,
				"%s gives %s = %g at %.10g nm", formula->name,
				formula->squared ? "n^2" : "n", n[i], wavelength_nm[i]);
	}
	if (formula->squared)
		take_roots(n, count);
	return SPEC_OK;
}

enum spec_status
spec_dispersion_abbe(
	const struct spec_dispersion *dispersion, double *abbe, struct spec_error *error)
{
	static const double line_nm[] = {587.5618, 486.1327, 656.2725}; /* d, F, C */
	double n[3];
	enum spec_status status = spec_dispersion_sample(dispersion, line_nm, 3, n, error);

	if (status != SPEC_OK)
		return status;
	if (n[1] == n[2])
		return spec_error_set(error, SPEC_ERANGE,
			"the Abbe number is infinite: n_F and n_C are equal");
	*abbe = (n[0] - 1) / (n[1] - n[2]);
	return SPEC_OK;
}
