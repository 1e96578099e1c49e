#include "spectrum/abscissa.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "base/memory.h"

/* The speed of light [nm THz] and the nanometres of a centimetre. */
#define LIGHT_NM_THZ 299792.458
#define NM_PER_CM 1e7

static const char *const names[] = {"nm", "um", "THz", "cm-1"};

enum spec_status
spec_abscissa_parse(
	const char *text, enum spec_abscissa *abscissa, struct spec_error *error)
{
	for (size_t i = 0; i < sizeof names / sizeof *names; i++) {
		if (strcmp(text, names[i]) == 0) {
			*abscissa = (enum spec_abscissa)i;
			return SPEC_OK;
		}
	}
	return spec_error_set(
		error, SPEC_EUSAGE, "unknown unit '%.200s' (nm um THz cm-1)", text);
}

static double
to_nm(enum spec_abscissa abscissa, double x)
{
	if (abscissa == SPEC_ABSCISSA_UM)
		return x * 1e3;
	return (abscissa == SPEC_ABSCISSA_THZ ? LIGHT_NM_THZ : NM_PER_CM) / x;
}

/* |dx/dl| at a wavelength l. */
static double
slope(enum spec_abscissa abscissa, double nm)
{
	if (abscissa == SPEC_ABSCISSA_UM)
		return 1e-3;
	return (abscissa == SPEC_ABSCISSA_THZ ? LIGHT_NM_THZ : NM_PER_CM) / (nm * nm);
}

/* Puts the last sample first. */
static void
reverse(double *value, size_t count)
{
	for (size_t i = 0; i < count / 2; i++) {
		double kept = value[i];

		value[i] = value[count - 1 - i];
		value[count - 1 - i] = kept;
	}
}

/* Where in the quantity " per UNIT" ends it, or null. */
static char *
find_per(const struct spec_curve *curve, enum spec_abscissa abscissa)
{
	char wanted[16], *at;

	snprintf(wanted, sizeof wanted, " per %s", names[abscissa]);
	at = strstr(curve->quantity, wanted);
	return at && at[strlen(wanted)] == '\0' ? at : NULL;
}

static enum spec_status
convert_values(enum spec_abscissa abscissa, struct spec_curve *curve, int *left,
	struct spec_error *error)
{
	char *per = find_per(curve, abscissa);
	enum spec_status status;

	*left = curve->quantity[0] == '\0';
	if (!per && strcmp(curve->quantity, "spectral power distribution") != 0)
		return SPEC_OK;
	if (per) {
		char text[256];

		snprintf(text, sizeof text, "%.*s per nm",
			(int)(per - curve->quantity < 240 ? per - curve->quantity : 240),
			curve->quantity);
		status = spec_curve_set_text(&curve->quantity, text, error);
		if (status != SPEC_OK)
			return status;
	}
	for (size_t i = 0; i < curve->count * curve->columns; i++)
		curve->value[i] *= slope(abscissa, curve->wavelength_nm[i % curve->count]);
	return spec_curve_set_text(&curve->unit, "", error);
}

enum spec_status
spec_abscissa_convert(enum spec_abscissa abscissa, struct spec_curve *curve, int *left,
	struct spec_error *error)
{
	*left = 0;
	if (abscissa == SPEC_ABSCISSA_NM)
		return SPEC_OK;
	for (size_t i = 0; i < curve->count; i++)
		curve->wavelength_nm[i] = to_nm(abscissa, curve->wavelength_nm[i]);
	if (abscissa != SPEC_ABSCISSA_UM) {
		reverse(curve->wavelength_nm, curve->count);
		for (size_t i = 0; i < curve->columns; i++)
			reverse(curve->value + i * curve->count, curve->count);
	}
	for (size_t i = 0; i < curve->count; i++) {
		double nm = curve->wavelength_nm[i];

		if (!(nm > (i > 0 ? curve->wavelength_nm[i - 1] : 0)) || !isfinite(nm))
			return spec_error_set(error, SPEC_ERANGE,
				"'%.200s' has no ascending wavelengths: %.10g nm",
				spec_curve_name(curve), nm);
	}
	return convert_values(abscissa, curve, left, error);
}
