#include "spectrum/weights.h"

#include <string.h>

#include "base/interval.h"

enum spec_status
spec_weights_check(enum spec_interpolate rule, const double *known_nm, size_t count,
	struct spec_error *error)
{
	struct spec_samples samples = {known_nm, known_nm, count, rule};

	return spec_samples_check(&samples, error);
}

/* The samples that a value in interval i is made of: two, or six about it. */
static struct spec_weights
choose_samples(enum spec_interpolate rule, size_t count, size_t i)
{
	size_t most = rule == SPEC_INTERPOLATE_SPRAGUE ? 6 : 2, first = most == 2 ? i
									: i < 2   ? 0
										  : i - 2;

	if (first + most > count)
		first = count - most;
	return (struct spec_weights){.first = first, .count = most};
}

struct spec_weights
spec_weights_at(enum spec_interpolate rule, const double *known_nm, size_t count,
	double wavelength_nm)
{
	struct spec_weights weights;
	size_t zeros = 0;

	if (wavelength_nm <= known_nm[0])
		return (struct spec_weights){.first = 0, .count = 1, .weight = {1}};
	if (wavelength_nm >= known_nm[count - 1])
		return (struct spec_weights){.first = count - 1, .count = 1, .weight = {1}};
	weights = choose_samples(
		rule, count, spec_interval_find(known_nm, count - 1, wavelength_nm));
	/* The value is linear in the samples: each by itself gives its weight. */
	for (size_t k = 0; k < weights.count; k++) {
		double one[SPEC_WEIGHTS_MOST] = {0};
		struct spec_samples samples = {
			known_nm + weights.first, one, weights.count, rule};

		one[k] = 1;
		weights.weight[k] = spec_samples_at(&samples, wavelength_nm);
	}
	/* A NaN that weighs 0 would still be one. */
	while (weights.weight[weights.count - 1] == 0)
		weights.count--;
	while (weights.weight[zeros] == 0)
		zeros++;
	weights.first += zeros;
	weights.count -= zeros;
	memmove(weights.weight, weights.weight + zeros,
		weights.count * sizeof *weights.weight);
	return weights;
}
