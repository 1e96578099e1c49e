#include "colour/basis.h"

#include <stdlib.h>
#include <string.h>

#include "base/memory.h"
#include "spectrum/lookup.h"
#include "spectrum/mean.h"

enum spec_status
spec_basis_load(const char *name, size_t columns, struct spec_curve *basis,
	struct spec_error *error)
{
	enum spec_status status = spec_lookup_curve(name, basis, error);

	if (status != SPEC_OK || basis->columns == columns)
		return status;
	status = spec_error_set(error, SPEC_EFORMAT,
		"the spectrum '%s' has %zu columns instead of %zu", name, basis->columns,
		columns);
	spec_curve_free(basis);
	return status;
}

/* One column at wavelengths, or its means over bins. */
static enum spec_status
take_column(const struct spec_curve *basis, size_t column, int means, const double *nm,
	size_t count, double *value, struct spec_error *error)
{
	if (means)
		return spec_curve_mean(
			basis, column, SPEC_EXTRAPOLATE_CONSTANT, nm, count, value, error);
	return spec_curve_sample(
		basis, column, SPEC_EXTRAPOLATE_CONSTANT, nm, count, value, error);
}

static enum spec_status
add_up(const struct spec_curve *basis, const double *weight, int means, const double *nm,
	size_t count, double *value, struct spec_error *error)
{
	double *part = spec_memory_new(count, sizeof *part, "wavelengths", error);
	enum spec_status status = part ? SPEC_OK : SPEC_ENOMEM;

	memset(value, 0, count * sizeof *value);
	for (size_t k = 0; k < basis->columns && status == SPEC_OK; k++) {
		status = take_column(basis, k, means, nm, count, part, error);
		for (size_t i = 0; i < count && status == SPEC_OK; i++)
			value[i] += weight[k] * part[i];
	}
	free(part);
	return status;
}

enum spec_status
spec_basis_sample(const struct spec_curve *basis, const double *weight,
	const double *wavelength_nm, size_t count, double *value, struct spec_error *error)
{
	return add_up(basis, weight, 0, wavelength_nm, count, value, error);
}

enum spec_status
spec_basis_mean(const struct spec_curve *basis, const double *weight,
	const double *edges_nm, size_t bins, double *value, struct spec_error *error)
{
	return add_up(basis, weight, 1, edges_nm, bins, value, error);
}
