/* Vectors of three numbers in arrays. */
#ifndef SPEC_BASE_TRIPLE_H
#define SPEC_BASE_TRIPLE_H

#include <math.h>

static inline double
spec_triple_dot(const double a[3], const double b[3])
{
	return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}

/* a x b; result is neither of them. */
static inline void
spec_triple_cross(const double a[3], const double b[3], double result[3])
{
	for (int i = 0; i < 3; i++)
		result[i] =
			a[(i + 1) % 3] * b[(i + 2) % 3] - a[(i + 2) % 3] * b[(i + 1) % 3];
}

/* Makes a unit vector; 0 where there is no direction: all are 0, or one is not finite. */
static inline int
spec_triple_normalise(double vector[3])
{
	double most = fmax(fabs(vector[0]), fmax(fabs(vector[1]), fabs(vector[2])));
	double length;

	for (int i = 0; i < 3; i++)
		if (!isfinite(vector[i]))
			return 0;
	if (!(most > 0))
		return 0;
	for (int i = 0; i < 3; i++)
		vector[i] /= most; /* no square can overflow now */
	length = sqrt(spec_triple_dot(vector, vector));
	for (int i = 0; i < 3; i++)
		vector[i] /= length;
	return 1;
}

#endif
