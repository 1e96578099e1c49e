/* The metrics of two images by their names, such as "rmse" and "de2000-p95". */
#ifndef SPEC_COMPARE_METRICS_H
#define SPEC_COMPARE_METRICS_H

#include <stddef.h>

#include "base/error.h"
#include "compare/images.h"

enum spec_metric_kind {
	SPEC_METRIC_RMSE,
	SPEC_METRIC_MAX,
	SPEC_METRIC_ANGLE,
	SPEC_METRIC_ANGLE_MAX,
	SPEC_METRIC_PSNR,
	SPEC_METRIC_FIT,
	SPEC_METRIC_FIT_MIN,
	SPEC_METRIC_COLOUR,
	SPEC_METRIC_COLOUR_MAX,
	SPEC_METRIC_MAE,
	SPEC_METRIC_RELATIVE,
	SPEC_METRIC_ENERGY,
	SPEC_METRIC_MEAN,      /* of a map */
	SPEC_METRIC_PERCENTILE /* of a map */
};

struct spec_metric {
	char name[32];
	const char *unit; /* "" if it has none */
	enum spec_metric_kind kind;
	int larger_is_better;
	enum spec_detail_pixel map; /* of a mean or a percentile */
	double percent;             /* of a percentile, 0 to 100 */
};

/* What is printed where no metric is named, and all that have a name of their own. */
#define SPEC_METRICS_USUAL 9
#define SPEC_METRICS_NAMED 18
extern const struct spec_metric spec_metrics[SPEC_METRICS_NAMED];

/*
 * The metric that length bytes name: one of those above, or "MAP-pN", MAP one of rmse mae
 * max sam gfc sid de76 de94 de2000 and N a number from 0 to 100. SPEC_EUSAGE: another.
 */
enum spec_status spec_metric_find(const char *name, size_t length,
	struct spec_metric *metric, struct spec_error *error);

/* The map of that name; SPEC_EUSAGE: another. */
enum spec_status spec_metric_map(
	const char *name, enum spec_detail_pixel *map, struct spec_error *error);

const char *spec_metric_map_name(enum spec_detail_pixel map);
const char *spec_metric_map_unit(enum spec_detail_pixel map);

/* Adds what a metric needs to a setup: want_angle, want_bands, maps. */
void spec_metric_need(const struct spec_metric *metric, struct spec_images_setup *setup);

int spec_metric_is_colour(const struct spec_metric *metric);

/* Whether the images allow the metric. */
int spec_metric_applies(const struct spec_metric *metric, const struct spec_images *result);

struct spec_metric_value {
	double value;
	int has_place; /* of a pixel, from the data window's corner */
	size_t x;
	int y;
};

/* Error: SPEC_ENOMEM. peak: of psnr, or 0. */
enum spec_status spec_metric_measure(const struct spec_metric *metric,
	const struct spec_images *result, double peak, struct spec_metric_value *value,
	struct spec_error *error);

/* Whether a value is within a tolerance; of energy, whose sign tells a direction, its size. */
int spec_metric_within(const struct spec_metric *metric, double value, double tolerance);

/* The largest difference in any channel, whole numbers included. */
double spec_metric_max(const struct spec_images *result);

#endif
