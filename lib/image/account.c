#include "image/account.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "base/memory.h"
#include "base/text.h"

static const char *
title_of(const struct spec_curve *curve)
{
	return *curve->title ? curve->title : "untitled";
}

static double
step_of(const struct spec_curve *observer)
{
	const double *w = observer->wavelength_nm;

	return (w[observer->count - 1] - w[0]) / (double)(observer->count - 1);
}

static void
tell_scale(FILE *stream, const struct spec_image *image, const struct spec_rgb_setup *setup,
	const struct spec_rgb *rgb)
{
	double efficacy = spec_rule_efficacy(setup->observer);

	if (setup->scale == SPEC_RGB_ABSOLUTE) {
		fprintf(stream, "; Y in cd/m^2, by %.7g lm/W", efficacy);
		return;
	}
	fprintf(stream, "; Y = %d: %s", setup->scale == SPEC_RGB_HUNDRED ? 100 : 1,
		image->role == SPEC_ROLE_REFLECTIVE ? "the perfect reflector"
						    : "1 per nm at all wavelengths");
	if (isfinite(rgb->luminance))
		fprintf(stream, ", %.7g cd/m^2 by %.7g lm/W", rgb->luminance, efficacy);
}

enum spec_status
spec_account_text(const struct spec_image *image, const struct spec_rgb_setup *setup,
	const struct spec_rgb *rgb, const char *bands, char **result,
	struct spec_error *error)
{
	struct spec_text text = {0};
	enum spec_status status = spec_text_open(&text, error);

	*result = NULL;
	if (status != SPEC_OK)
		return status;
	fprintf(text.stream, "rule %s, %s; observer %s, by %g nm",
		spec_rule_name(setup->rule), spec_rule_title(setup->rule),
		title_of(setup->observer), step_of(setup->observer));
	if (image->role == SPEC_ROLE_REFLECTIVE)
		fprintf(text.stream, "; illuminant %s",
			setup->illuminant ? title_of(setup->illuminant) : "equal energy");
	tell_scale(text.stream, image, setup, rgb);
	fprintf(text.stream, "; outside: %.2f %% of Y", 100 * rgb->outside);
	if (bands)
		fprintf(text.stream, "; %s", bands);
	status = spec_text_close(&text, error);
	if (status == SPEC_OK)
		*result = spec_memory_text(text.bytes, text.size, error);
	spec_text_free(&text);
	return *result ? SPEC_OK : SPEC_ENOMEM;
}

double
spec_account_luminance(const struct spec_rgb_setup *setup, const struct spec_rgb *rgb)
{
	static const double parts[] = {1, 100};

	if (setup->scale == SPEC_RGB_ABSOLUTE)
		return exp2(-setup->exposure);
	return rgb->luminance / parts[setup->scale] * exp2(-setup->exposure);
}
