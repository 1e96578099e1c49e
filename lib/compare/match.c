#include "compare/match.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#define SAME_NM 1e-3 /* edges of bins closer than this are the same */
#define LONGEST 96   /* bytes of what is said of one side */

const char *
spec_match_kind(const struct spec_image *image)
{
	return image->role == SPEC_ROLE_EMISSIVE     ? "light"
	       : image->role == SPEC_ROLE_REFLECTIVE ? "reflectance"
						     : "no bands";
}

static enum spec_status
differ(const struct spec_match *a, const char *of_a, const struct spec_match *b,
	const char *of_b, struct spec_error *error)
{
	return spec_error_set(
		error, SPEC_EUSAGE, "%s has %s, %s %s", a->name, of_a, b->name, of_b);
}

static enum spec_status
match_window(const struct spec_match *a, const struct spec_window *of_a,
	const struct spec_match *b, const struct spec_window *of_b, const char *what,
	struct spec_error *error)
{
	char one[LONGEST], two[LONGEST];

	if (memcmp(of_a, of_b, sizeof *of_a) == 0)
		return SPEC_OK;
	snprintf(one, sizeof one, "the %s window %d,%d,%d,%d", what, of_a->x0, of_a->y0,
		of_a->x1, of_a->y1);
	snprintf(two, sizeof two, "%d,%d,%d,%d", of_b->x0, of_b->y0, of_b->x1, of_b->y1);
	return differ(a, one, b, two, error);
}

enum spec_status
spec_match_windows(
	const struct spec_match *a, const struct spec_match *b, struct spec_error *error)
{
	enum spec_status status =
		match_window(a, &a->image->data, b, &b->image->data, "data", error);

	return status == SPEC_OK ? match_window(a, &a->image->display, b,
					   &b->image->display, "display", error)
				 : status;
}

/* "81 bands 380..780 nm", and what stands at a band's place. */
static void
describe_bands(char *text, const struct spec_image *image, size_t band, int alike)
{
	int length = snprintf(text, LONGEST, "%zu bands %g..%g nm", image->bands,
		image->wavelength_nm[0], image->wavelength_nm[image->bands - 1]);

	if (alike)
		snprintf(text + length, LONGEST - (size_t)length, " with one at %.9g nm",
			image->wavelength_nm[band]);
}

enum spec_status
spec_match_bands(
	const struct spec_match *a, const struct spec_match *b, struct spec_error *error)
{
	const struct spec_image *one = a->image, *two = b->image;
	size_t last = one->bands - 1, band = 0;
	char of_a[LONGEST], of_b[LONGEST];
	int same = 1, alike;

	for (; band < one->bands && band < two->bands && same; band++)
		same = spec_image_nearest_band(one, two->wavelength_nm[band], &same) ==
			       band &&
		       same;
	if (same && one->bands == two->bands)
		return SPEC_OK;
	/* Where their ends tell nothing, the band does at which they differ. */
	alike = one->bands == two->bands &&
		fabs(one->wavelength_nm[0] - two->wavelength_nm[0]) < SAME_NM &&
		fabs(one->wavelength_nm[last] - two->wavelength_nm[last]) < SAME_NM;
	describe_bands(of_a, one, band - 1, alike);
	describe_bands(of_b, two, band - 1, alike);
	return differ(a, of_a, b, of_b, error);
}

enum spec_status
spec_match_bins(
	const struct spec_match *a, const struct spec_match *b, struct spec_error *error)
{
	const double *one = a->image->edges_nm, *two = b->image->edges_nm;
	char of_a[LONGEST], of_b[LONGEST];

	if (!one != !two)
		return differ(a, one ? "bins" : "point samples", b,
			two ? "bins" : "point samples", error);
	for (size_t i = 0; one && i <= a->image->bands; i++) {
		if (fabs(one[i] - two[i]) <= SAME_NM)
			continue;
		snprintf(of_a, sizeof of_a, "a bin's edge at %.9g nm", one[i]);
		snprintf(of_b, sizeof of_b, "at %.9g nm", two[i]);
		return differ(a, of_a, b, of_b, error);
	}
	return SPEC_OK;
}

enum spec_status
spec_match_quantities(
	const struct spec_match *a, const struct spec_match *b, struct spec_error *error)
{
	char *one = spec_image_quantity(a->image, error);
	char *two = spec_image_quantity(b->image, error);
	enum spec_status status = one && two ? SPEC_OK : SPEC_ENOMEM;

	if (status == SPEC_OK &&
		(a->image->role != b->image->role || strcmp(one, two) != 0))
		status = spec_error_set(error, SPEC_EUSAGE,
			"%s is %s ('%.80s'), %s %s ('%.80s')", a->name,
			spec_match_kind(a->image), one, b->name, spec_match_kind(b->image),
			two);
	free(one);
	free(two);
	return status;
}

enum spec_status
spec_match_stokes(
	const struct spec_match *a, const struct spec_match *b, struct spec_error *error)
{
	char of_a[LONGEST], of_b[LONGEST];

	if (a->image->stokes == b->image->stokes)
		return SPEC_OK;
	snprintf(of_a, sizeof of_a, "%d Stokes component%s", a->image->stokes,
		a->image->stokes == 1 ? "" : "s");
	snprintf(of_b, sizeof of_b, "%d", b->image->stokes);
	return differ(a, of_a, b, of_b, error);
}
