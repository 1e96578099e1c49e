#include "spectrum/grid.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "base/interval.h"
#include "base/memory.h"
#include "base/number.h"

#define SLACK 1e-6      /* of a step: how far off the grid the upper bound may lie */
#define SAME_NM 1e-3    /* names of six and of three decimals are the same wavelength */
#define REGULAR 0.01    /* of a step, by which a regular grid's may be off */
#define SAME_SHARE 0.25 /* of the way to the next one, where that is less */

enum spec_status
spec_grid_new(size_t count, struct spec_grid *grid, struct spec_error *error)
{
	*grid = (struct spec_grid){0};
	if (count < 1 || count > SPEC_GRID_LONGEST)
		return spec_error_set(error, SPEC_ERANGE,
			"a grid has 1 to %d wavelengths, not %zu", SPEC_GRID_LONGEST,
			count);
	grid->wavelength_nm = spec_memory_new(count, sizeof(double), "wavelengths", error);
	if (!grid->wavelength_nm)
		return SPEC_ENOMEM;
	grid->count = count;
	return SPEC_OK;
}

/* Splits text into its three numbers; 0 if it is anything else. */
static int
split(const char *text, double *number)
{
	for (int i = 0; i < 3; i++) {
		size_t length = spec_number_scan(text, '.', &number[i]);

		if (length == 0 || text[length] != (i < 2 ? ':' : '\0'))
			return 0;
		text += length + 1;
	}
	return 1;
}

static enum spec_status
check_bounds(const char *text, double low_nm, double high_nm, double step_nm,
	struct spec_error *error)
{
	if (high_nm < low_nm)
		return spec_error_set(error, SPEC_EUSAGE,
			"the bounds of grid '%s' are reversed, it takes LO:HI:STEP with LO "
			"<= HI",
			text);
	if (!(step_nm > 0))
		return spec_error_set(
			error, SPEC_EUSAGE, "the step of grid '%s' is not positive", text);
	if (low_nm < SPEC_GRID_LOWEST_NM || high_nm > SPEC_GRID_HIGHEST_NM)
		return spec_error_set(error, SPEC_ERANGE, "grid '%s' leaves %g..%.0f nm",
			text, SPEC_GRID_LOWEST_NM, SPEC_GRID_HIGHEST_NM);
	return SPEC_OK;
}

/* How many steps lie between the bounds, if that is a whole number within reason. */
static enum spec_status
count_steps(const char *text, double low_nm, double high_nm, double step_nm, size_t *steps,
	struct spec_error *error)
{
	double exact = (high_nm - low_nm) / step_nm, nearest;

	if (!(exact + SLACK < SPEC_GRID_LONGEST))
		return spec_error_set(error, SPEC_ERANGE,
			"grid '%s' has more than %d wavelengths", text, SPEC_GRID_LONGEST);
	nearest = round(exact);
	if (fabs(exact - nearest) > SLACK) {
		if (low_nm + nearest * step_nm > SPEC_GRID_HIGHEST_NM)
			nearest = floor(exact);
		return spec_error_set(error, SPEC_EUSAGE,
			"grid '%s' does not reach its upper bound in whole steps, the "
			"nearest that fits "
			"is %.10g",
			text, low_nm + nearest * step_nm);
	}
	*steps = (size_t)nearest;
	return SPEC_OK;
}

enum spec_status
spec_grid_parse(const char *text, struct spec_grid *grid, struct spec_error *error)
{
	double number[3];
	enum spec_status status;
	size_t steps = 0;

	*grid = (struct spec_grid){0};
	if (!split(text, number))
		return spec_error_set(
			error, SPEC_EUSAGE, "grid '%s' is not LO:HI:STEP in nm", text);
	status = check_bounds(text, number[0], number[1], number[2], error);
	if (status == SPEC_OK)
		status = count_steps(text, number[0], number[1], number[2], &steps, error);
	if (status == SPEC_OK)
		status = spec_grid_new(steps + 1, grid, error);
	for (size_t i = 0; status == SPEC_OK && i < grid->count; i++) {
		grid->wavelength_nm[i] = number[0] + (double)i * number[2];
		if (i > 0 && !(grid->wavelength_nm[i] > grid->wavelength_nm[i - 1]))
			status = spec_error_set(error, SPEC_ERANGE,
				"the step of grid '%s' is too small to tell its "
				"wavelengths apart",
				text);
	}
	if (status != SPEC_OK)
		spec_grid_free(grid);
	return status;
}

enum spec_status
spec_grid_copy(
	const struct spec_grid *source, struct spec_grid *copy, struct spec_error *error)
{
	enum spec_status status = spec_grid_new(source->count, copy, error);

	if (status == SPEC_OK)
		memcpy(copy->wavelength_nm, source->wavelength_nm,
			source->count * sizeof *source->wavelength_nm);
	return status;
}

size_t
spec_grid_nearest(const double *known_nm, size_t count, double wavelength_nm, int *same)
{
	size_t low = spec_interval_find(known_nm, count - 1, wavelength_nm);
	double tolerance_nm = SAME_NM;

	if (low + 1 < count && fabs(known_nm[low + 1] - wavelength_nm) <
				       fabs(known_nm[low] - wavelength_nm))
		low++;
	if (low > 0)
		tolerance_nm = fmin(
			tolerance_nm, SAME_SHARE * (known_nm[low] - known_nm[low - 1]));
	if (low + 1 < count)
		tolerance_nm = fmin(
			tolerance_nm, SAME_SHARE * (known_nm[low + 1] - known_nm[low]));
	*same = fabs(known_nm[low] - wavelength_nm) <= tolerance_nm;
	return low;
}

void
spec_grid_free(struct spec_grid *grid)
{
	if (!grid)
		return;
	free(grid->wavelength_nm);
	*grid = (struct spec_grid){0};
}

double
spec_grid_step(const double *wavelength_nm, size_t count)
{
	double step_nm, most_nm;

	if (count < 2)
		return 0;
	step_nm = (wavelength_nm[count - 1] - wavelength_nm[0]) / (double)(count - 1);
	most_nm = fmin(SAME_NM, REGULAR * step_nm);
	for (size_t i = 1; i + 1 < count; i++) {
		if (fabs(wavelength_nm[0] + (double)i * step_nm - wavelength_nm[i]) >
			most_nm * (1 + 1e-6))
			return 0;
	}
	return step_nm;
}
