#include "colour/models.h"

#include <math.h>
#include <string.h>

/* Luma's weights and the scales of the differences: ITU-R BT.470-6, 1998. */
#define LUMA_RED 0.299
#define LUMA_GREEN 0.587
#define LUMA_BLUE 0.114
#define SCALE_U 0.493
#define SCALE_V 0.877
#define MOST_U (SCALE_U * (1 - LUMA_BLUE))
#define MOST_V (SCALE_V * (1 - LUMA_RED))

static const struct spec_model models[] = {
	{SPEC_MODEL_HSV, "hsv", 3, {"H", "S", "V"}, {0}, {360, 1, 1}},
	{SPEC_MODEL_HSL, "hsl", 3, {"H", "S", "L"}, {0}, {360, 1, 1}},
	{SPEC_MODEL_YUV, "yuv", 3, {"Y", "U", "V"}, {0, -MOST_U, -MOST_V},
		{1, MOST_U, MOST_V}},
	{SPEC_MODEL_CMYK, "cmyk", 4, {"C", "M", "Y", "K"}, {0}, {1, 1, 1, 1}},
};

const struct spec_model *
spec_model_at(size_t index)
{
	return index < sizeof models / sizeof *models ? &models[index] : NULL;
}

const struct spec_model *
spec_model_find(const char *name, struct spec_error *error)
{
	for (size_t i = 0; i < sizeof models / sizeof *models; i++)
		if (strcmp(models[i].name, name) == 0)
			return &models[i];
	spec_error_set(error, SPEC_EUSAGE, "'%s' is not hsv, hsl, yuv or cmyk", name);
	return NULL;
}

/* The remainder of a division, in [0, period): of a tiny negative number too. */
static double
wrap(double value, double period)
{
	double rest = fmod(value, period);

	rest += rest < 0 ? period : 0;
	return rest < period ? rest : 0;
}

static double
hue(const double rgb[3], double least, double most)
{
	double span = most - least, sixth;

	if (span == 0)
		return 0;
	if (most == rgb[0])
		sixth = (rgb[1] - rgb[2]) / span;
	else if (most == rgb[1])
		sixth = 2 + (rgb[2] - rgb[0]) / span;
	else
		sixth = 4 + (rgb[0] - rgb[1]) / span;
	return wrap(60 * sixth, 360);
}

void
spec_model_from_rgb(
	const struct spec_model *model, const double rgb[3], double value[SPEC_MODEL_MOST])
{
	double least = fmin(rgb[0], fmin(rgb[1], rgb[2]));
	double most = fmax(rgb[0], fmax(rgb[1], rgb[2]));
	double light = (most + least) / 2;
	double luma = LUMA_RED * rgb[0] + LUMA_GREEN * rgb[1] + LUMA_BLUE * rgb[2];

	value[3] = 0;
	switch (model->kind) {
	case SPEC_MODEL_HSV:
		value[0] = hue(rgb, least, most);
		value[1] = most > least ? (most - least) / most : 0;
		value[2] = most;
		break;
	case SPEC_MODEL_HSL:
		value[0] = hue(rgb, least, most);
		value[1] = most > least ? (most - light) / fmin(light, 1 - light) : 0;
		value[2] = light;
		break;
	case SPEC_MODEL_YUV:
		value[0] = luma;
		value[1] = SCALE_U * (rgb[2] - luma);
		value[2] = SCALE_V * (rgb[0] - luma);
		break;
	case SPEC_MODEL_CMYK:
		for (int i = 0; i < 3; i++)
			value[i] = most > 0 ? (most - rgb[i]) / most : 0;
		value[3] = 1 - most;
		break;
	}
}

void
spec_model_to_rgb(
	const struct spec_model *model, const double value[SPEC_MODEL_MOST], double rgb[3])
{
	/* Where in its wave each component stands at a hue of 0: CSS Color 4, section 7.1. */
	static const double sixth[3] = {5, 3, 1}, twelfth[3] = {0, 8, 4};
	double chroma = value[1] * fmin(value[2], 1 - value[2]);

	switch (model->kind) {
	case SPEC_MODEL_HSV:
		for (int i = 0; i < 3; i++) {
			double k = wrap(sixth[i] + value[0] / 60, 6);

			rgb[i] = value[2] -
				 value[2] * value[1] * fmax(0, fmin(fmin(k, 4 - k), 1));
		}
		break;
	case SPEC_MODEL_HSL:
		for (int i = 0; i < 3; i++) {
			double k = wrap(twelfth[i] + value[0] / 30, 12);

			rgb[i] = value[2] - chroma * fmax(-1, fmin(fmin(k - 3, 9 - k), 1));
		}
		break;
	case SPEC_MODEL_YUV:
		rgb[0] = value[0] + value[2] / SCALE_V;
		rgb[2] = value[0] + value[1] / SCALE_U;
		rgb[1] = (value[0] - LUMA_RED * rgb[0] - LUMA_BLUE * rgb[2]) / LUMA_GREEN;
		break;
	case SPEC_MODEL_CMYK:
		for (int i = 0; i < 3; i++)
			rgb[i] = (1 - value[i]) * (1 - value[3]);
		break;
	}
}
