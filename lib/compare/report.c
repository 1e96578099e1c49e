#include "compare/report.h"

#include <math.h>
#include <string.h>

int
spec_report_is_alarm(const struct spec_report *report)
{
	return spec_significance_p(&report->result->test) <=
	       spec_significance_level(report->sigma);
}

enum spec_status
spec_report_judge(struct spec_report *report, struct spec_error *error)
{
	const struct spec_images *result = report->result;
	enum spec_status status = SPEC_OK;
	int judged = report->exact || report->sigma > 0;

	report->different = result->structure[0] != '\0';
	if (!result->comparable)
		return SPEC_OK;
	/* What is not finite on one side, and another id, are beyond any tolerance. */
	report->different |= result->spectral.nonfinite > 0 ||
			     result->others.nonfinite > 0 || result->whole.differing > 0 ||
			     (report->exact && result->exact.differing > 0) ||
			     (report->sigma > 0 && spec_report_is_alarm(report));
	for (size_t i = 0; i < report->metrics && status == SPEC_OK; i++) {
		struct spec_report_metric *it = &report->metric[i];

		judged |= it->judged;
		if (!it->shown && !it->judged)
			continue;
		it->applies = spec_metric_applies(&it->metric, result);
		if (it->applies)
			status = spec_metric_measure(
				&it->metric, result, report->peak, &it->value, error);
		/* What cannot be measured is not within. */
		it->beyond = it->judged &&
			     (!it->applies || !spec_metric_within(&it->metric,
						      it->value.value, it->tolerance));
		report->different |= it->beyond;
	}
	if (!judged)
		report->different |= spec_metric_max(result) > 0;
	return status;
}

static void
print_name(FILE *stream, const struct spec_image *image, size_t channel)
{
	char name[256];

	snprintf(name, sizeof name, "%s", image->channel[channel].name);
	spec_error_plain(name);
	fprintf(stream, "'%s'", name);
}

static void
print_sample(FILE *stream, const struct spec_image *image, const struct spec_measure *worst)
{
	if (worst->nonfinite > 0) {
		fprintf(stream, " at %zu,%d in ", worst->nonfinite_first.x,
			worst->nonfinite_first.y);
		print_name(stream, image, worst->nonfinite_first.band);
		fprintf(stream, ": %.9g and %.9g, the first of %llu that are not finite",
			worst->nonfinite_a, worst->nonfinite_b,
			(unsigned long long)worst->nonfinite);
	} else if (worst->difference.value > 0) {
		fprintf(stream, " at %zu,%d in ", worst->difference.place.x,
			worst->difference.place.y);
		print_name(stream, image, worst->difference.place.band);
		fprintf(stream, ": %.9g and %.9g", worst->difference_a,
			worst->difference_b);
	}
}

/* Whether the largest difference is one of whole numbers. */
static int
most_is_whole(const struct spec_images *result)
{
	const struct spec_whole *whole = &result->whole;

	return whole->differing > 0 &&
	       fabs((double)whole->a - (double)whole->b) == spec_metric_max(result);
}

/* Else the measure that has it; null: none. */
static const struct spec_measure *
most_of(const struct spec_images *result, int *grid)
{
	*grid = 0;
	if (result->others.samples > 0 &&
		spec_measure_max(&result->others) == spec_metric_max(result))
		return &result->others;
	*grid = result->grid;
	return result->bands > 0 ? &result->spectral : NULL;
}

/* Where the largest difference is, and between what. */
static void
print_most(FILE *stream, const struct spec_report *report)
{
	const struct spec_images *result = report->result;
	const struct spec_whole *whole = &result->whole;
	const struct spec_measure *worst;
	int grid;

	if (most_is_whole(result)) {
		fprintf(stream, " at %zu,%d in ", whole->x, whole->y);
		print_name(stream, report->image[0], whole->channel);
		fprintf(stream, ": %u and %u", whole->a, whole->b);
		return;
	}
	worst = most_of(result, &grid);
	if (worst)
		print_sample(stream, report->image[grid], worst);
}

static void
print_metric(
	FILE *stream, const struct spec_report *report, const struct spec_report_metric *it)
{
	fprintf(stream, "%-10s %.6g%s%s", it->metric.name, it->value.value,
		*it->metric.unit ? " " : "", it->metric.unit);
	if (it->metric.kind == SPEC_METRIC_MAX)
		print_most(stream, report);
	else if (it->value.has_place)
		fprintf(stream, " at %zu,%d", it->value.x, it->value.y);
	if (it->beyond)
		fprintf(stream, " (beyond %g)", it->tolerance);
	fputc('\n', stream);
}

static void
print_exact(FILE *stream, const struct spec_report *report)
{
	const struct spec_exact *exact = &report->result->exact;
	float a, b;

	if (exact->differing == 0) {
		fputs("exact      all bits are the same\n", stream);
		return;
	}
	memcpy(&a, &exact->a, sizeof a);
	memcpy(&b, &exact->b, sizeof b);
	fprintf(stream, "exact      %llu samples differ, the first at %zu,%d in ",
		exact->differing, exact->x, exact->y);
	print_name(stream, report->image[0], exact->channel);
	fprintf(stream, ": %.9g (0x%08x) and %.9g (0x%08x)\n", a, exact->a, b, exact->b);
}

static int
least(int a, int b)
{
	return a < b ? a : b;
}

/* The statistic that says most. */
static void
print_statistic(FILE *stream, const struct spec_report *report)
{
	const struct spec_images *result = report->result;
	const struct spec_significance *test = &result->test;

	fputs("; most ", stream);
	print_name(
		stream, report->image[result->grid], result->band_channel[test->in_band]);
	if (test->kind == SPEC_SIGNIFICANCE_TILES) {
		fprintf(stream, ", chi-square of its tiles %.3g of 1 each\n", test->value);
		return;
	}
	if (test->kind == SPEC_SIGNIFICANCE_ONE_TILE) {
		int x = (int)test->x + result->region.x0, y = test->y + result->region.y0;

		fprintf(stream, " at %d,%d to %d,%d", x, y,
			least(x + SPEC_SIGNIFICANCE_TILE, result->region.x1),
			least(y + SPEC_SIGNIFICANCE_TILE, result->region.y1));
	}
	fprintf(stream, ", z %.3g, mean difference %.3g\n", test->value, test->mean);
}

static void
print_test(FILE *stream, const struct spec_report *report)
{
	fprintf(stream, "%s within %g sigma: p %.3g, alarm up to %.3g; noise from %s",
		spec_report_is_alarm(report) ? "not the same" : "the same", report->sigma,
		spec_significance_p(&report->result->test),
		spec_significance_level(report->sigma),
		report->result->known_variances ? "the channels variance.*"
						: "the differences");
	if (report->result->test.tests > 0)
		print_statistic(stream, report);
	else
		fputc('\n', stream);
}

double
spec_report_peak(const struct spec_report *report)
{
	return report->peak > 0 ? report->peak : (double)report->result->spectral.largest_a;
}

static void
print_bands(FILE *stream, const struct spec_report *report)
{
	const struct spec_images *result = report->result;

	fprintf(stream, "%-20s %12s %12s %12s %12s %12s\n", "band", "rmse", "mae", "max",
		"relative", "psnr");
	for (size_t i = 0; i < result->bands; i++) {
		const struct spec_detail_band *band = &result->band[i];
		char name[256];

		snprintf(name, sizeof name, "%s",
			report->image[result->grid]->channel[result->band_channel[i]].name);
		spec_error_plain(name);
		fprintf(stream, "%-20s %12.6g %12.6g %12.6g %12.6g %12.6g\n", name,
			spec_detail_rmse(band, 1), spec_detail_mae(band, 1),
			spec_detail_max(band, 1), spec_detail_relative(band, 1),
			spec_detail_psnr(band, 1, spec_report_peak(report)));
	}
}

void
spec_report_text(const struct spec_report *report, FILE *stream)
{
	fputs(report->result->structure, stream);
	fputs(report->result->notes, stream);
	if (!report->result->comparable)
		return;
	for (size_t i = 0; i < report->metrics; i++) {
		if (report->metric[i].shown && report->metric[i].applies)
			print_metric(stream, report, &report->metric[i]);
	}
	if (report->exact)
		print_exact(stream, report);
	if (report->sigma > 0)
		print_test(stream, report);
	if (report->shows_bands)
		print_bands(stream, report);
}
