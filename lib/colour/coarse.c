#include "colour/coarse.h"

#include <math.h>
#include <string.h>

/* Of the distance between bands: wavelengths in names are often rounded. */
#define TOLERANCE .01

size_t
spec_coarse_halve(size_t count, unsigned level, unsigned char *kept)
{
	size_t number = count > 1 ? 2 : count;

	memset(kept, 0, count);
	kept[0] = kept[count - 1] = 1;
	for (unsigned i = 0; i < level && number < count; i++) {
		for (size_t from = 0, to; from + 1 < count; from = to) {
			size_t middle;

			for (to = from + 1; !kept[to]; to++)
				;
			middle = from + (to - from) / 2;
			number += !kept[middle];
			kept[middle] = 1;
		}
	}
	return number;
}

unsigned
spec_coarse_finest(size_t count)
{
	unsigned level = 0;

	while (count > 1 && (count - 2) >> level > 0)
		level++;
	return level;
}

enum spec_status
spec_coarse_stride(const double *wavelength_nm, size_t count, double step_nm,
	size_t *stride, struct spec_error *error)
{
	double first = wavelength_nm[0], gap, times;

	if (count < 2)
		return spec_error_set(
			error, SPEC_EUSAGE, "one band has no other a step away");
	gap = (wavelength_nm[count - 1] - first) / (double)(count - 1);
	for (size_t i = 0; i < count; i++) {
		double off = wavelength_nm[i] - (first + (double)i * gap);

		if (!(fabs(off) <= TOLERANCE * gap))
			return spec_error_set(error, SPEC_EUSAGE,
				"a step needs bands at equal distances, which those at %g "
				"nm are not; levels do not",
				wavelength_nm[i]);
	}
	times = round(step_nm / gap);
	if (!(times >= 1 && fabs(times * gap - step_nm) <= TOLERANCE * gap))
		return spec_error_set(error, SPEC_EUSAGE,
			"the bands are %g nm apart: a step of %g nm is no multiple of that",
			gap, step_nm);
	if (times > (double)(count - 1))
		return spec_error_set(error, SPEC_EUSAGE,
			"of the bands at %g..%g nm a step of %g nm leaves one", first,
			wavelength_nm[count - 1], step_nm);
	*stride = (size_t)times;
	return SPEC_OK;
}

void
spec_coarse_repeat(size_t count, size_t stride, double *weight)
{
	for (size_t i = 0; i < count; i++)
		weight[i] = i % stride == 0 ? weight[i] * (double)stride : 0;
}

void
spec_coarse_interpolate(const double *wavelength_nm, size_t count,
	const unsigned char *kept, double *weight)
{
	for (size_t from = 0, to; from + 1 < count; from = to) {
		double gap;

		for (to = from + 1; !kept[to]; to++)
			;
		gap = wavelength_nm[to] - wavelength_nm[from];
		for (size_t i = from + 1; i < to; i++) {
			double part = (wavelength_nm[i] - wavelength_nm[from]) / gap;

			weight[from] += (1 - part) * weight[i];
			weight[to] += part * weight[i];
			weight[i] = 0;
		}
	}
}
