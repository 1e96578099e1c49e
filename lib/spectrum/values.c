/* Functions of the values of one spectrum, and their extremes; see operate.h. */
#include <math.h>
#include <stdlib.h>

#include "spectrum/operate.h"
#include "spectrum/represent.h"

#define FINE 8 /* steps between two of spec_spectrum_grid, in looking for extremes */
#define GOLDEN .6180339887498949
#define GOLDEN_STEPS 60

struct function {
	const char *name;
	double (*of)(const struct function *function, double value);
	double low, high;
};

static double
exponential(const struct function *function, double value)
{
	(void)function;
	return exp(value);
}

static double
square_root(const struct function *function, double value)
{
	(void)function;
	return sqrt(value);
}

static double
clamp(const struct function *function, double value)
{
	return fmin(fmax(value, function->low), function->high);
}

/* A table of what has no samples, and else a copy. */
static enum spec_status
sample(const struct spec_spectrum *spectrum, struct spec_spectrum *result,
	struct spec_error *error)
{
	struct spec_representation sampled = {.kind = SPEC_SPECTRUM_SAMPLED};

	if (spectrum->wavelength_nm || spectrum->smooth == SPEC_SPECTRUM_CONSTANT)
		return spec_spectrum_copy(spectrum, result, error);
	return spec_spectrum_convert(spectrum, &sampled, result, error);
}

static enum spec_status
map(const struct spec_spectrum *spectrum, const struct function *function,
	struct spec_spectrum *result, struct spec_error *error)
{
	enum spec_status status = SPEC_OK;

	*result = (struct spec_spectrum){0};
	if (spectrum->lines > 0)
		return spec_error_set(error, SPEC_ERANGE,
			"'%.200s' has lines, and %s of a line has no meaning",
			spectrum->title, function->name);
	status = sample(spectrum, result, error);
	if (status == SPEC_OK && result->smooth == SPEC_SPECTRUM_CONSTANT) {
		result->level = function->of(function, spectrum->level);
		if (!isfinite(result->level))
			status = spec_error_set(error, SPEC_ERANGE,
				"%s of %g is not finite", function->name, spectrum->level);
	}
	for (size_t i = 0; status == SPEC_OK && i < result->count; i++) {
		double value = result->value[i];

		result->value[i] = function->of(function, value);
		if (!isfinite(result->value[i]))
			status = spec_error_set(error, SPEC_ERANGE,
				"%s of %g, at %.10g nm, is not finite", function->name,
				value, result->wavelength_nm[i]);
	}
	if (status != SPEC_OK)
		spec_spectrum_free(result);
	return status;
}

/* It is another quantity, in no unit. */
static enum spec_status
map_away(const struct spec_spectrum *spectrum, const struct function *function,
	struct spec_spectrum *result, struct spec_error *error)
{
	enum spec_status status = map(spectrum, function, result, error);

	if (status == SPEC_OK)
		status = spec_curve_set_text(&result->quantity, "", error);
	if (status == SPEC_OK)
		status = spec_curve_set_text(&result->unit, "", error);
	if (status != SPEC_OK)
		spec_spectrum_free(result);
	return status;
}

enum spec_status
spec_spectrum_exp(const struct spec_spectrum *spectrum, struct spec_spectrum *result,
	struct spec_error *error)
{
	struct function function = {"the exponential", exponential, 0, 0};

	return map_away(spectrum, &function, result, error);
}

enum spec_status
spec_spectrum_sqrt(const struct spec_spectrum *spectrum, struct spec_spectrum *result,
	struct spec_error *error)
{
	struct function function = {"the square root", square_root, 0, 0};

	return map_away(spectrum, &function, result, error);
}

enum spec_status
spec_spectrum_clamp(const struct spec_spectrum *spectrum, double low, double high,
	struct spec_spectrum *result, struct spec_error *error)
{
	struct function function = {"a clamp", clamp, low, high};
	struct spec_extremes extremes;
	enum spec_status status;

	*result = (struct spec_spectrum){0};
	if (!(low <= high))
		return spec_error_set(
			error, SPEC_ERANGE, "nothing can be clamped to %g..%g", low, high);
	if (spectrum->lines == 0) {
		status = spec_spectrum_extremes(spectrum, &extremes, error);
		if (status != SPEC_OK)
			return status;
		if (extremes.least >= low && extremes.most <= high)
			return spec_spectrum_copy(spectrum, result, error);
	}
	return map(spectrum, &function, result, error);
}

/* ---- extremes ---- */

static double
signed_value(const struct spec_spectrum *spectrum, double sign, double nm)
{
	double value = 0;

	/* Within the range: nothing is refused. */
	spec_spectrum_sample(spectrum, SPEC_EXTRAPOLATE_CONSTANT, &nm, 1, &value, NULL);
	return sign * value;
}

/* The largest of sign times the values from low to high, by golden section; where it is. */
static double
climb(const struct spec_spectrum *spectrum, double sign, double low_nm, double high_nm)
{
	double a_nm = high_nm - GOLDEN * (high_nm - low_nm);
	double b_nm = low_nm + GOLDEN * (high_nm - low_nm);
	double a = signed_value(spectrum, sign, a_nm),
	       b = signed_value(spectrum, sign, b_nm);

	for (int i = 0; i < GOLDEN_STEPS; i++) {
		if (a > b) {
			high_nm = b_nm;
			b_nm = a_nm;
			b = a;
			a_nm = high_nm - GOLDEN * (high_nm - low_nm);
			a = signed_value(spectrum, sign, a_nm);
		} else {
			low_nm = a_nm;
			a_nm = b_nm;
			a = b;
			b_nm = low_nm + GOLDEN * (high_nm - low_nm);
			b = signed_value(spectrum, sign, b_nm);
		}
	}
	return a > b ? a_nm : b_nm;
}

/* The largest of sign times the values, and where: among fine steps, then climbing. */
static void
find_largest(const struct spec_spectrum *spectrum, double sign, const double *nm,
	size_t count, double *largest, double *largest_nm)
{
	double around_nm[2] = {nm[0], nm[0]}, at_nm;

	*largest_nm = nm[0];
	*largest = signed_value(spectrum, sign, nm[0]);
	for (size_t i = 0; i + 1 < count; i++) {
		double step_nm = (nm[i + 1] - nm[i]) / FINE;

		for (int k = 1; k <= FINE; k++) {
			double here_nm = k < FINE ? nm[i] + k * step_nm : nm[i + 1];
			double value = signed_value(spectrum, sign, here_nm);

			if (value <= *largest)
				continue;
			*largest = value;
			*largest_nm = here_nm;
			around_nm[0] = here_nm - step_nm;
			around_nm[1] = fmin(here_nm + step_nm, nm[count - 1]);
		}
	}
	if (*largest_nm == nm[0] && count > 1)
		around_nm[1] = nm[0] + (nm[1] - nm[0]) / FINE;
	at_nm = climb(spectrum, sign, around_nm[0], around_nm[1]);
	if (signed_value(spectrum, sign, at_nm) > *largest) {
		*largest = signed_value(spectrum, sign, at_nm);
		*largest_nm = at_nm;
	}
}

enum spec_status
spec_spectrum_extremes(const struct spec_spectrum *spectrum, struct spec_extremes *extremes,
	struct spec_error *error)
{
	size_t count;
	double *nm = spec_spectrum_grid(spectrum, &count, error);

	if (!nm)
		return SPEC_ENOMEM;
	*extremes = (struct spec_extremes){spectrum->level, nm[0], spectrum->level, nm[0]};
	if (spectrum->wavelength_nm && spectrum->interpolate != SPEC_INTERPOLATE_SPRAGUE) {
		extremes->least = extremes->most = spectrum->value[0];
		for (size_t i = 1; i < count; i++) {
			double value = spectrum->value[i];

			if (value < extremes->least) {
				extremes->least = value;
				extremes->least_nm = nm[i];
			}
			if (value > extremes->most) {
				extremes->most = value;
				extremes->most_nm = nm[i];
			}
		}
	} else if (spectrum->smooth != SPEC_SPECTRUM_CONSTANT) {
		find_largest(spectrum, 1, nm, count, &extremes->most, &extremes->most_nm);
		find_largest(
			spectrum, -1, nm, count, &extremes->least, &extremes->least_nm);
		extremes->least = -extremes->least;
	}
	free(nm);
	return SPEC_OK;
}

int
spec_spectrum_is_black(const struct spec_spectrum *spectrum)
{
	if (spectrum->lines > 0)
		return 0;
	if (spectrum->smooth == SPEC_SPECTRUM_RGB)
		return spectrum->sigmoid.scale == 0 ||
		       (isinf(spectrum->sigmoid.c2) && spectrum->sigmoid.c2 < 0);
	for (size_t i = 0; i < spectrum->count; i++)
		if (spectrum->value[i] != 0)
			return 0;
	return spectrum->count > 0 || spectrum->level == 0;
}
