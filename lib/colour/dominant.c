#include "colour/dominant.h"

#include <math.h>
#include <stdlib.h>

#include "base/memory.h"

/* A ray through the end that two segments share must meet one of them despite rounding. */
#define CORNER 1e-9

void
spec_dominant_xy(const double xyz[3], double xy[2])
{
	double sum = xyz[0] + xyz[1] + xyz[2];

	xy[0] = sum > 0 ? xyz[0] / sum : NAN;
	xy[1] = sum > 0 ? xyz[1] / sum : NAN;
}

size_t
spec_dominant_locus(
	const struct spec_curve *observer, double (*xy)[2], double *wavelength_nm)
{
	const size_t n = observer->count;
	size_t count = 0;

	for (size_t i = 0; i < n; i++) {
		double xyz[3] = {observer->value[i], observer->value[n + i],
			observer->value[2 * n + i]};
		double at[2];

		spec_dominant_xy(xyz, at);
		if (observer->wavelength_nm[i] < SPEC_DOMINANT_FIRST_NM ||
			observer->wavelength_nm[i] > SPEC_DOMINANT_LAST_NM || isnan(at[0]))
			continue;
		if (xy) {
			xy[count][0] = at[0];
			xy[count][1] = at[1];
		}
		if (wavelength_nm)
			wavelength_nm[count] = observer->wavelength_nm[i];
		count++;
	}
	return count;
}

/*
 * Where the ray from + t direction, t > 0, meets the segment from a to b, at the part s of
 * it: returns t, or 0 where it does not.
 */
static double
meet(const double from[2], const double direction[2], const double a[2], const double b[2],
	double *s)
{
	double along[2] = {b[0] - a[0], b[1] - a[1]};
	double to[2] = {a[0] - from[0], a[1] - from[1]};
	double area = direction[0] * along[1] - direction[1] * along[0], t;

	if (area == 0)
		return 0;
	t = (to[0] * along[1] - to[1] * along[0]) / area;
	*s = (to[0] * direction[1] - to[1] * direction[0]) / area;
	return t > 0 && *s >= -CORNER && *s <= 1 + CORNER ? t : 0;
}

struct locus {
	size_t count;
	double (*xy)[2], *wavelength_nm;
};

/* The outermost meeting with the spectral locus: t, or 0, and its wavelength, or NaN. */
static double
meet_locus(const struct locus *locus, const double from[2], const double direction[2],
	double *wavelength_nm)
{
	double farthest = 0, s = 0;

	*wavelength_nm = NAN;
	for (size_t i = 0; i + 1 < locus->count; i++) {
		double t = meet(from, direction, locus->xy[i], locus->xy[i + 1], &s);

		if (!(t > farthest))
			continue;
		farthest = t;
		*wavelength_nm =
			locus->wavelength_nm[i] +
			s * (locus->wavelength_nm[i + 1] - locus->wavelength_nm[i]);
	}
	return farthest;
}

static void
find(const struct locus *locus, const double xy[2], const double white[2],
	double *dominant_nm, double *purity)
{
	double there[2] = {xy[0] - white[0], xy[1] - white[1]};
	double back[2] = {-there[0], -there[1]};
	double nm, s, t = meet_locus(locus, white, there, &nm);
	double purple = locus->count < 2 ? 0
					 : meet(white, there, locus->xy[locus->count - 1],
						   locus->xy[0], &s);

	if (t >= purple && t > 0) {
		*dominant_nm = nm;
		*purity = 1 / t;
	} else if (purple > 0) {
		*purity = 1 / purple;
		if (meet_locus(locus, white, back, &nm) > 0)
			*dominant_nm = -nm;
	}
}

enum spec_status
spec_dominant_find(const struct spec_curve *observer, const double xy[2],
	const double white[2], double *dominant_nm, double *purity,
	struct spec_error *error)
{
	struct locus locus = {0};
	double distance = hypot(xy[0] - white[0], xy[1] - white[1]);
	enum spec_status status = SPEC_ENOMEM;

	*dominant_nm = *purity = NAN;
	if (!isfinite(distance))
		return SPEC_OK;
	if (distance < SPEC_DOMINANT_WHITE) {
		*purity = 0;
		return SPEC_OK;
	}
	locus.xy = spec_memory_new(
		observer->count, sizeof *locus.xy, "observer samples", error);
	locus.wavelength_nm =
		spec_memory_new(observer->count, sizeof(double), "observer samples", error);
	if (locus.xy && locus.wavelength_nm) {
		locus.count = spec_dominant_locus(observer, locus.xy, locus.wavelength_nm);
		find(&locus, xy, white, dominant_nm, purity);
		status = SPEC_OK;
	}
	free(locus.xy);
	free(locus.wavelength_nm);
	return status;
}
