#include "colour/tone.h"

#include <math.h>
#include <string.h>

#include "base/number.h"
#include "base/vector.h"

/* Hable 2010. */
#define A .15
#define B .50
#define C .10
#define D .20
#define E .02
#define F .30
#define FILMIC_WHITE 11.2
#define FILMIC_EXPOSURE 2

enum spec_status
spec_tone_parse(const char *text, struct spec_tone *tone, struct spec_error *error)
{
	*tone = (struct spec_tone){SPEC_TONE_NONE, 0};
	if (strcmp(text, "none") == 0)
		return SPEC_OK;
	if (strcmp(text, "filmic") == 0) {
		tone->kind = SPEC_TONE_FILMIC;
		return SPEC_OK;
	}
	tone->kind = SPEC_TONE_REINHARD;
	if (strcmp(text, "reinhard") == 0)
		return SPEC_OK;
	if (strncmp(text, "reinhard:", 9) == 0)
		return spec_number_parse(
			text + 9, 1e-6, 1e9, "the white of --tone", &tone->white, error);
	return spec_error_set(error, SPEC_EUSAGE,
		"unknown tone curve '%s': expected none, reinhard, reinhard:WHITE or filmic",
		text);
}

static double
film(double x)
{
	return (x * (A * x + C * B) + D * E) / (x * (A * x + B) + D * F) - E / F;
}

/* Of h at 0: (C B D F - B D E) / (D F)^2. */
static double
film_slope(void)
{
	return (C * B * D * F - B * D * E) / (D * F * D * F);
}

double
spec_tone_curve(const struct spec_tone *tone, double luminance)
{
	double bend = tone->white > 0 ? 1 / (tone->white * tone->white) : 0;

	switch (tone->kind) {
	case SPEC_TONE_REINHARD:
		return luminance * (1 + luminance * bend) / (1 + luminance);
	case SPEC_TONE_FILMIC:
		return film(FILMIC_EXPOSURE * luminance) / film(FILMIC_WHITE);
	case SPEC_TONE_NONE:
		break;
	}
	return luminance;
}

SPEC_VECTORISED static void
multiply_reinhard(double bend, const double weight[3], float *restrict r, float *restrict g,
	float *restrict b, size_t count)
{
	double red = weight[0], green = weight[1], blue = weight[2];

	for (size_t i = 0; i < count; i++) {
		double y = red * r[i] + green * g[i] + blue * b[i], up = y > 0 ? y : 0;
		double factor = (1 + up * bend) / (1 + up);

		r[i] = (float)(r[i] * factor);
		g[i] = (float)(g[i] * factor);
		b[i] = (float)(b[i] * factor);
	}
}

/* h(2 Y) / Y loses digits near 0: there it is the slope. */
SPEC_VECTORISED static void
multiply_filmic(const double weight[3], float *restrict r, float *restrict g,
	float *restrict b, size_t count)
{
	double red = weight[0], green = weight[1], blue = weight[2];
	double scale = 1 / film(FILMIC_WHITE);
	double slope = FILMIC_EXPOSURE * film_slope() * scale;

	for (size_t i = 0; i < count; i++) {
		double y = red * r[i] + green * g[i] + blue * b[i];
		double up = y > 1e-9 ? y : 1e-9, x = FILMIC_EXPOSURE * up;
		double value = (x * (A * x + C * B) + D * E) / (x * (A * x + B) + D * F);
		double factor = y > 1e-9 ? (value - E / F) * scale / up : slope;

		r[i] = (float)(r[i] * factor);
		g[i] = (float)(g[i] * factor);
		b[i] = (float)(b[i] * factor);
	}
}

void
spec_tone_row(const struct spec_tone *tone, const double luminance[3],
	float *const plane[3], size_t count)
{
	double bend = tone->white > 0 ? 1 / (tone->white * tone->white) : 0;

	if (tone->kind == SPEC_TONE_REINHARD)
		multiply_reinhard(bend, luminance, plane[0], plane[1], plane[2], count);
	else if (tone->kind == SPEC_TONE_FILMIC)
		multiply_filmic(luminance, plane[0], plane[1], plane[2], count);
}
