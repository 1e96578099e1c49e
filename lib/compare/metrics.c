#include "compare/metrics.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "base/number.h"

#define COLOURS (1u << SPEC_DETAIL_DE76 | 1u << SPEC_DETAIL_DE94 | 1u << SPEC_DETAIL_DE2000)

const struct spec_metric spec_metrics[SPEC_METRICS_NAMED] = {
	{"rmse", "", SPEC_METRIC_RMSE, 0, 0, 0},
	{"max", "", SPEC_METRIC_MAX, 0, 0, 0},
	{"sam", "rad", SPEC_METRIC_ANGLE, 0, 0, 0},
	{"sam-max", "rad", SPEC_METRIC_ANGLE_MAX, 0, 0, 0},
	{"psnr", "dB", SPEC_METRIC_PSNR, 1, 0, 0},
	{"gfc", "", SPEC_METRIC_FIT, 1, 0, 0},
	{"gfc-min", "", SPEC_METRIC_FIT_MIN, 1, 0, 0},
	{"de2000", "", SPEC_METRIC_COLOUR, 0, 0, 0},
	{"de2000-max", "", SPEC_METRIC_COLOUR_MAX, 0, 0, 0},
	{"mae", "", SPEC_METRIC_MAE, 0, 0, 0},
	{"relative", "", SPEC_METRIC_RELATIVE, 0, 0, 0},
	{"energy", "", SPEC_METRIC_ENERGY, 0, 0, 0},
	{"sid", "", SPEC_METRIC_MEAN, 0, SPEC_DETAIL_SID, 0},
	{"sid-max", "", SPEC_METRIC_PERCENTILE, 0, SPEC_DETAIL_SID, 100},
	{"de76", "", SPEC_METRIC_MEAN, 0, SPEC_DETAIL_DE76, 0},
	{"de76-max", "", SPEC_METRIC_PERCENTILE, 0, SPEC_DETAIL_DE76, 100},
	{"de94", "", SPEC_METRIC_MEAN, 0, SPEC_DETAIL_DE94, 0},
	{"de94-max", "", SPEC_METRIC_PERCENTILE, 0, SPEC_DETAIL_DE94, 100},
};

static const struct {
	const char *name, *unit;
} maps[SPEC_DETAIL_PIXELS] = {
	[SPEC_DETAIL_RMSE] = {"rmse", ""},
	[SPEC_DETAIL_MAE] = {"mae", ""},
	[SPEC_DETAIL_MAX] = {"max", ""},
	[SPEC_DETAIL_SAM] = {"sam", "rad"},
	[SPEC_DETAIL_GFC] = {"gfc", ""},
	[SPEC_DETAIL_SID] = {"sid", ""},
	[SPEC_DETAIL_DE76] = {"de76", ""},
	[SPEC_DETAIL_DE94] = {"de94", ""},
	[SPEC_DETAIL_DE2000] = {"de2000", ""},
};

const char *
spec_metric_map_name(enum spec_detail_pixel map)
{
	return maps[map].name;
}

const char *
spec_metric_map_unit(enum spec_detail_pixel map)
{
	return maps[map].unit;
}

/* The map that length bytes name, or SPEC_DETAIL_PIXELS. */
static int
find_map(const char *name, size_t length)
{
	int map = 0;

	while (map < SPEC_DETAIL_PIXELS &&
		(strlen(maps[map].name) != length ||
			strncmp(maps[map].name, name, length) != 0))
		map++;
	return map;
}

enum spec_status
spec_metric_map(const char *name, enum spec_detail_pixel *map, struct spec_error *error)
{
	int found = find_map(name, strlen(name));

	if (found == SPEC_DETAIL_PIXELS)
		return spec_error_set(error, SPEC_EUSAGE,
			"'%s' is nothing that a pixel has: rmse mae max sam gfc sid de76 de94 "
			"de2000",
			name);
	*map = (enum spec_detail_pixel)found;
	return SPEC_OK;
}

/* "MAP-pN"; returns whether it is one, with the metric but its number. */
static int
read_percentile(struct spec_metric *metric)
{
	char *dash = strrchr(metric->name, '-');
	int map = dash ? find_map(metric->name, (size_t)(dash - metric->name))
		       : SPEC_DETAIL_PIXELS;

	if (map == SPEC_DETAIL_PIXELS || dash[1] != 'p')
		return 0;
	metric->kind = SPEC_METRIC_PERCENTILE;
	metric->map = (enum spec_detail_pixel)map;
	metric->unit = maps[map].unit;
	metric->larger_is_better = map == SPEC_DETAIL_GFC;
	return 1;
}

enum spec_status
spec_metric_find(const char *name, size_t length, struct spec_metric *metric,
	struct spec_error *error)
{
	for (size_t i = 0; i < SPEC_METRICS_NAMED; i++) {
		*metric = spec_metrics[i];
		if (strlen(metric->name) == length &&
			memcmp(metric->name, name, length) == 0)
			return SPEC_OK;
	}
	*metric = (struct spec_metric){.unit = ""};
	if (length < sizeof metric->name)
		memcpy(metric->name, name, length);
	if (!read_percentile(metric))
		return spec_error_set(error, SPEC_EUSAGE,
			"unknown metric '%.*s' (try --help)",
			(int)(length < 64 ? length : 64), name);
	return spec_number_parse(strrchr(metric->name, '-') + 2, 0, 100, "the percentile",
		&metric->percent, error);
}

int
spec_metric_is_colour(const struct spec_metric *metric)
{
	if (metric->kind == SPEC_METRIC_COLOUR || metric->kind == SPEC_METRIC_COLOUR_MAX)
		return 1;
	return metric->kind >= SPEC_METRIC_MEAN && (1u << metric->map & COLOURS) != 0;
}

void
spec_metric_need(const struct spec_metric *metric, struct spec_images_setup *setup)
{
	switch (metric->kind) {
	case SPEC_METRIC_ANGLE:
	case SPEC_METRIC_ANGLE_MAX:
	case SPEC_METRIC_FIT:
	case SPEC_METRIC_FIT_MIN:
		setup->want_angle = 1;
		break;
	case SPEC_METRIC_MAE:
	case SPEC_METRIC_RELATIVE:
	case SPEC_METRIC_ENERGY:
		setup->want_bands = 1;
		break;
	case SPEC_METRIC_MEAN:
	case SPEC_METRIC_PERCENTILE:
		setup->maps |= 1u << metric->map;
		break;
	default:
		break;
	}
}

int
spec_metric_applies(const struct spec_metric *metric, const struct spec_images *result)
{
	if (spec_metric_is_colour(metric))
		return result->coloured;
	return result->bands > 0 || metric->kind == SPEC_METRIC_RMSE ||
	       metric->kind == SPEC_METRIC_MAX;
}

double
spec_metric_max(const struct spec_images *result)
{
	double most = fabs((double)result->whole.a - (double)result->whole.b);

	if (result->bands > 0)
		most = fmax(most, spec_measure_max(&result->spectral));
	if (result->others.samples > 0)
		most = fmax(most, spec_measure_max(&result->others));
	return most;
}

/* Where the extreme is; where it is not finite, the first pixel that makes it so. */
static void
take_place(struct spec_metric_value *value, const struct spec_measure *measure,
	const struct spec_measure_extreme *extreme, double best)
{
	const struct spec_measure_place *place = &extreme->place;

	if (measure->nonfinite > 0)
		place = &measure->nonfinite_first;
	else if (measure->pixels == 0 || extreme->value == best)
		return;
	value->has_place = 1;
	value->x = place->x;
	value->y = place->y;
}

static double
detail_of(enum spec_metric_kind kind, const struct spec_images *result)
{
	if (kind == SPEC_METRIC_MAE)
		return spec_detail_mae(result->band, result->bands);
	if (kind == SPEC_METRIC_RELATIVE)
		return spec_detail_relative(result->band, result->bands);
	return spec_detail_energy(result->band, result->width_nm, result->bands);
}

static double
value_of(enum spec_metric_kind kind, const struct spec_images *result, double peak)
{
	const struct spec_measure *spectral = &result->spectral;

	switch (kind) {
	case SPEC_METRIC_RMSE:
		return result->bands > 0 ? spec_measure_rmse(spectral) : 0;
	case SPEC_METRIC_MAX:
		return spec_metric_max(result);
	case SPEC_METRIC_ANGLE:
		return spec_measure_angle_mean(spectral);
	case SPEC_METRIC_ANGLE_MAX:
		return spec_measure_angle_max(spectral);
	case SPEC_METRIC_PSNR:
		return spec_measure_psnr(spectral, peak);
	case SPEC_METRIC_FIT:
		return spec_measure_fit_mean(spectral);
	case SPEC_METRIC_FIT_MIN:
		return spec_measure_fit_min(spectral);
	case SPEC_METRIC_COLOUR:
		return spec_measure_colour_mean(spectral);
	case SPEC_METRIC_COLOUR_MAX:
		return spec_measure_colour_max(spectral);
	default:
		return detail_of(kind, result);
	}
}

enum spec_status
spec_metric_measure(const struct spec_metric *metric, const struct spec_images *result,
	double peak, struct spec_metric_value *value, struct spec_error *error)
{
	const struct spec_measure *spectral = &result->spectral;
	enum spec_status status = SPEC_OK;

	*value = (struct spec_metric_value){0};
	if (metric->kind == SPEC_METRIC_PERCENTILE) {
		status = spec_images_percentile(result, metric->map, metric->percent,
			&value->value, &value->x, &value->y, error);
		value->has_place =
			metric->larger_is_better ? value->value < 1 : value->value > 0;
		return status;
	}
	if (metric->kind == SPEC_METRIC_MEAN)
		value->value = spec_images_mean(result, metric->map);
	else
		value->value = value_of(metric->kind, result, peak);
	if (metric->kind == SPEC_METRIC_ANGLE_MAX)
		take_place(value, spectral, &spectral->angle_most, 0);
	else if (metric->kind == SPEC_METRIC_COLOUR_MAX)
		take_place(value, spectral, &spectral->colour_most, 0);
	else if (metric->kind == SPEC_METRIC_FIT_MIN)
		take_place(value, spectral, &spectral->fit_least, 1);
	return status;
}

int
spec_metric_within(const struct spec_metric *metric, double value, double tolerance)
{
	if (metric->kind == SPEC_METRIC_ENERGY)
		value = fabs(value);
	return metric->larger_is_better ? value >= tolerance : value <= tolerance;
}
