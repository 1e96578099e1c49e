#include "optics/fresnel.h"

#include <string.h>

#include "base/vector.h"

enum spec_status
spec_polarisation_parse(
	const char *text, enum spec_polarisation *polarisation, struct spec_error *error)
{
	static const char letters[] = "usp";
	const char *found = strlen(text) == 1 ? strchr(letters, text[0]) : NULL;

	if (!found)
		return spec_error_set(error, SPEC_EUSAGE,
			"the polarisation is u, s or p, not '%s'", text);
	*polarisation = (enum spec_polarisation)(found - letters);
	return SPEC_OK;
}

struct spec_fresnel
spec_fresnel_dielectric(double cosine, double n1, double n2)
{
	double sine = n1 / n2 * sqrt((1 - cosine) * (1 + cosine)), inside, s, p;

	if (sine >= 1)
		return (struct spec_fresnel){1, 1};
	inside = sqrt(1 - sine * sine);
	s = (n1 * cosine - n2 * inside) / (n1 * cosine + n2 * inside);
	p = (n2 * cosine - n1 * inside) / (n2 * cosine + n1 * inside);
	return (struct spec_fresnel){s * s, p * p};
}

/*
 * With u + iv = n2 cos(theta2), the root of n2^2 - n1^2 sin(theta1)^2:
 *   s = ((n1 c - u)^2 + v^2) / ((n1 c + u)^2 + v^2)
 *   p = (((n^2 - k^2) c - n1 u)^2 + (2nkc - n1 v)^2) / (the same with plus)
 */
SPEC_VECTORISED void
spec_fresnel_spectrum(double cosine, const double *restrict n1, const double *restrict n2,
	const double *restrict k2, size_t count, double *restrict s, double *restrict p)
{
	double c = cosine, sine2 = (1 - c) * (1 + c);

	for (size_t i = 0; i < count; i++) {
		double real = n2[i] * n2[i] - k2[i] * k2[i], imaginary = 2 * n2[i] * k2[i];
		double a = real - n1[i] * n1[i] * sine2;
		double length = sqrt(a * a + imaginary * imaginary);
		double large = sqrt((length + fabs(a)) / 2);
		double small = large > 0 ? imaginary / (2 * large) : 0;
		double u = a >= 0 ? large : small, v = a >= 0 ? small : large;
		double x = n1[i] * c - u, y = n1[i] * c + u;
		double xr = real * c - n1[i] * u, xi = imaginary * c - n1[i] * v;
		double yr = real * c + n1[i] * u, yi = imaginary * c + n1[i] * v;

		double ys = y * y + v * v, yp = yr * yr + yi * yi;

		/* Only light that grazes a boundary between equals has 0/0. */
		s[i] = ys > 0 ? (x * x + v * v) / ys : 1;
		p[i] = yp > 0 ? (xr * xr + xi * xi) / yp : 1;
	}
}

struct spec_fresnel
spec_fresnel_conductor(double cosine, double n1, double n2, double k2)
{
	struct spec_fresnel result;

	spec_fresnel_spectrum(cosine, &n1, &n2, &k2, 1, &result.s, &result.p);
	return result;
}
