/* What a text asks a spectrum to become; see represent.h. */
#include <string.h>

#include "base/number.h"
#include "spectrum/represent.h"

/* A whole number at the start of *text, which moves behind it; 0: there is none. */
static int
take_number(const char **text, size_t *number)
{
	double value;
	size_t digits = strspn(*text, "0123456789");

	if (digits == 0 || digits > 9 || spec_number_scan(*text, '.', &value) != digits)
		return 0;
	*text += digits;
	*number = (size_t)value;
	return 1;
}

static enum spec_status
parse_sampled(const char *text, struct spec_representation *representation,
	struct spec_error *error)
{
	struct spec_grid grid;
	enum spec_status status = spec_grid_parse(text, &grid, error);

	if (status == SPEC_OK && grid.count < 2)
		status = spec_error_set(error, SPEC_ERANGE,
			"a sampled spectrum has 2 samples or more: '%.60s'", text);
	if (status == SPEC_OK) {
		representation->kind = SPEC_SPECTRUM_SAMPLED;
		representation->low_nm = grid.wavelength_nm[0];
		representation->high_nm = grid.wavelength_nm[grid.count - 1];
		representation->count = grid.count;
	}
	spec_grid_free(&grid);
	return status;
}

static enum spec_status
parse_counts(const char *text, struct spec_representation *representation,
	struct spec_error *error)
{
	int composite = strncmp(text, "composite:", 10) == 0;
	const char *at = text + (composite ? 10 : 8);
	size_t *coefficients =
		composite ? &representation->coefficients : &representation->count;
	int whole = take_number(&at, &representation->count);

	representation->coefficients = 0;
	representation->kind = composite ? SPEC_SPECTRUM_COMPOSITE : SPEC_SPECTRUM_FOURIER;
	if (whole && composite && *at == ',') {
		at++;
		whole = take_number(&at, coefficients);
	} else if (whole && composite) {
		coefficients = NULL;
	}
	if (!whole || *at)
		return spec_error_set(error, SPEC_EUSAGE,
			"'%.60s' is not fourier:N, composite:K or composite:K,N", text);
	if (coefficients &&
		(*coefficients % 2 == 0 || *coefficients > SPEC_SPECTRUM_MOST_COEFFICIENTS))
		return spec_error_set(error, SPEC_ERANGE,
			"'%.60s': a Fourier spectrum has an odd number of coefficients, 1 "
			"to %d",
			text, SPEC_SPECTRUM_MOST_COEFFICIENTS);
	if (composite && representation->count > SPEC_SPECTRUM_MOST_LINES)
		return spec_error_set(error, SPEC_ERANGE,
			"'%.60s': a spectrum has at most %d lines", text,
			SPEC_SPECTRUM_MOST_LINES);
	return SPEC_OK;
}

enum spec_status
spec_representation_parse(const char *text, struct spec_representation *representation,
	struct spec_error *error)
{
	representation->low_nm = representation->high_nm = 0;
	representation->count = representation->coefficients = 0;
	representation->kind = SPEC_SPECTRUM_TABULATED;
	if (strcmp(text, "tabulated") == 0)
		return SPEC_OK;
	if (strcmp(text, "sampled") == 0) {
		representation->kind = SPEC_SPECTRUM_SAMPLED;
		representation->low_nm = representation->high_nm = 0;
		representation->count = 0;
		return SPEC_OK;
	}
	if (strncmp(text, "sampled:", 8) == 0)
		return parse_sampled(text + 8, representation, error);
	if (strncmp(text, "fourier:", 8) == 0 || strncmp(text, "composite:", 10) == 0)
		return parse_counts(text, representation, error);
	return spec_error_set(error, SPEC_EUSAGE,
		"'%.60s' is not sampled:LO:HI:STEP, tabulated, fourier:N, composite:K or "
		"composite:K,N",
		text);
}
