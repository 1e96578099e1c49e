/* What specdiff says of two images: as text, a line for each metric, or as JSON. */
#ifndef SPEC_COMPARE_REPORT_H
#define SPEC_COMPARE_REPORT_H

#include <stdio.h>

#include "base/error.h"
#include "compare/images.h"
#include "compare/metrics.h"

#define SPEC_REPORT_MOST_METRICS 64

struct spec_report_metric {
	struct spec_metric metric;
	int shown, judged;
	double tolerance;
	/* Filled by spec_report_judge. */
	int applies, beyond;
	struct spec_metric_value value;
};

struct spec_report {
	const char *name[2]; /* the files */
	const struct spec_image *image[2];
	const struct spec_images *result;
	struct spec_report_metric metric[SPEC_REPORT_MOST_METRICS];
	size_t metrics;
	int shows_bands, exact;
	double sigma;  /* of the test of significance; 0: none */
	double peak;   /* of psnr, or 0 */
	int different; /* filled by spec_report_judge */
};

/*
 * Measures the metrics that are shown or judged, and whether the images are different: as
 * such, in a sample that is not finite or a whole number, in a bit where exact is set,
 * beyond a tolerance or in expectation at sigma, or, where none of these is set, in any
 * sample.
 * Error: SPEC_ENOMEM.
 */
enum spec_status spec_report_judge(struct spec_report *report, struct spec_error *error);

/* Whether the test of significance says that the images differ. */
int spec_report_is_alarm(const struct spec_report *report);

/* The peak of psnr: the report's, else the largest magnitude in the first image's bands. */
double spec_report_peak(const struct spec_report *report);

/* Write errors stay in the stream. */
void spec_report_text(const struct spec_report *report, FILE *stream);
void spec_report_json(const struct spec_report *report, FILE *stream);

#endif
