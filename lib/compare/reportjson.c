#include <math.h>
#include <string.h>

#include "base/json.h"
#include "compare/report.h"

/* The lines of a text, as an array. */
static void
put_lines(struct spec_json *json, const char *key, const char *text)
{
	spec_json_open(json, key, '[', SPEC_JSON_LINES);
	while (*text) {
		size_t length = strcspn(text, "\n");

		spec_json_bytes(json, NULL, text, length);
		text += length + (text[length] == '\n');
	}
	spec_json_close(json);
}

static void
put_place(struct spec_json *json, size_t x, int y)
{
	spec_json_open(json, "at", '[', SPEC_JSON_INLINE);
	spec_json_whole(json, NULL, (long long)x);
	spec_json_whole(json, NULL, y);
	spec_json_close(json);
}

static void
put_channel(struct spec_json *json, const struct spec_image *image, size_t channel)
{
	spec_json_text(json, "channel", image->channel[channel].name);
	if (image->channel[channel].role != SPEC_ROLE_OTHER)
		spec_json_number(
			json, "wavelength_nm", image->channel[channel].wavelength_nm);
}

/* The worst sample: the first that is not finite, else the one farthest off. */
static void
put_sample(struct spec_json *json, const struct spec_image *image,
	const struct spec_measure *worst)
{
	int spoiled = worst->nonfinite > 0;
	const struct spec_measure_place *place =
		spoiled ? &worst->nonfinite_first : &worst->difference.place;

	if (!spoiled && !(worst->difference.value > 0))
		return;
	put_place(json, place->x, place->y);
	put_channel(json, image, place->band);
	spec_json_float(json, "a", spoiled ? worst->nonfinite_a : worst->difference_a);
	spec_json_float(json, "b", spoiled ? worst->nonfinite_b : worst->difference_b);
	if (spoiled)
		spec_json_whole(json, "not_finite", (long long)worst->nonfinite);
}

static void
put_most(struct spec_json *json, const struct spec_report *report)
{
	const struct spec_images *result = report->result;
	const struct spec_whole *whole = &result->whole;
	const struct spec_measure *others = &result->others, *bands = &result->spectral;
	double most = spec_metric_max(result);

	if (whole->differing > 0 && fabs((double)whole->a - (double)whole->b) == most) {
		put_place(json, whole->x, whole->y);
		put_channel(json, report->image[0], whole->channel);
		spec_json_whole(json, "a", whole->a);
		spec_json_whole(json, "b", whole->b);
	} else if (others->samples > 0 && spec_measure_max(others) == most) {
		put_sample(json, report->image[0], others);
	} else if (result->bands > 0) {
		put_sample(json, report->image[result->grid], bands);
	}
}

static void
put_metric(struct spec_json *json, const struct spec_report *report,
	const struct spec_report_metric *it)
{
	spec_json_open(json, it->metric.name, '{', SPEC_JSON_INLINE);
	if (it->applies)
		spec_json_number(json, "value", it->value.value);
	else
		spec_json_null(json, "value");
	if (it->applies && isinf(it->value.value))
		spec_json_text(json, "infinite", it->value.value > 0 ? "+" : "-");
	spec_json_text(json, "unit", it->metric.unit);
	if (it->applies && it->metric.kind == SPEC_METRIC_MAX)
		put_most(json, report);
	else if (it->applies && it->value.has_place)
		put_place(json, it->value.x, it->value.y);
	if (it->judged) {
		spec_json_number(json, "tolerance", it->tolerance);
		spec_json_truth(json, "within", !it->beyond);
	}
	spec_json_close(json);
}

static void
put_bands(struct spec_json *json, const struct spec_report *report)
{
	const struct spec_images *result = report->result;
	const struct spec_image *image = report->image[result->grid];

	spec_json_open(json, "bands", '[', SPEC_JSON_LINES);
	for (size_t i = 0; i < result->bands; i++) {
		const struct spec_detail_band *band = &result->band[i];

		spec_json_open(json, NULL, '{', SPEC_JSON_INLINE);
		put_channel(json, image, result->band_channel[i]);
		spec_json_number(json, "rmse", spec_detail_rmse(band, 1));
		spec_json_number(json, "mae", spec_detail_mae(band, 1));
		spec_json_number(json, "max", spec_detail_max(band, 1));
		spec_json_number(json, "relative", spec_detail_relative(band, 1));
		spec_json_number(
			json, "psnr", spec_detail_psnr(band, 1, spec_report_peak(report)));
		spec_json_close(json);
	}
	spec_json_close(json);
}

static void
put_exact(struct spec_json *json, const struct spec_report *report)
{
	const struct spec_exact *exact = &report->result->exact;
	float a, b;

	spec_json_open(json, "exact", '{', SPEC_JSON_INLINE);
	spec_json_whole(json, "differing", (long long)exact->differing);
	if (exact->differing > 0) {
		memcpy(&a, &exact->a, sizeof a);
		memcpy(&b, &exact->b, sizeof b);
		put_place(json, exact->x, exact->y);
		put_channel(json, report->image[0], exact->channel);
		spec_json_float(json, "a", a);
		spec_json_float(json, "b", b);
	}
	spec_json_close(json);
}

static void
put_test(struct spec_json *json, const struct spec_report *report)
{
	static const char *const kind[] = {"band", "tiles", "tile"};
	const struct spec_images *result = report->result;
	const struct spec_significance *test = &result->test;

	spec_json_open(json, "same_within", '{', SPEC_JSON_INLINE);
	spec_json_number(json, "sigma", report->sigma);
	spec_json_truth(json, "same", !spec_report_is_alarm(report));
	spec_json_number(json, "p", spec_significance_p(test));
	spec_json_number(json, "alarm", spec_significance_level(report->sigma));
	spec_json_text(json, "noise", result->known_variances ? "variance" : "differences");
	spec_json_whole(json, "statistics", (long long)test->tests);
	if (test->tests > 0) {
		spec_json_text(json, "kind", kind[test->kind]);
		put_channel(json, report->image[result->grid],
			result->band_channel[test->in_band]);
		spec_json_number(json, "value", test->value);
		spec_json_number(json, "mean_difference", test->mean);
		if (test->kind == SPEC_SIGNIFICANCE_ONE_TILE)
			put_place(json, test->x + (size_t)result->region.x0,
				test->y + result->region.y0);
	}
	spec_json_close(json);
}

static void
put_image(struct spec_json *json, const struct spec_report *report, int side)
{
	const struct spec_image *image = report->image[side];

	spec_json_open(json, NULL, '{', SPEC_JSON_INLINE);
	spec_json_text(json, "file", report->name[side]);
	spec_json_whole(json, "width", (long long)spec_window_width(&image->data));
	spec_json_whole(json, "height", (long long)spec_window_height(&image->data));
	spec_json_whole(json, "bands", (long long)image->bands);
	if (image->bands > 0) {
		spec_json_number(json, "low_nm", image->wavelength_nm[0]);
		spec_json_number(json, "high_nm", image->wavelength_nm[image->bands - 1]);
	}
	spec_json_close(json);
}

static void
put_measured(struct spec_json *json, const struct spec_report *report)
{
	const struct spec_images *result = report->result;
	const struct spec_window *region = &result->region;

	spec_json_open(json, "region", '[', SPEC_JSON_INLINE);
	spec_json_whole(json, NULL, region->x0);
	spec_json_whole(json, NULL, region->y0);
	spec_json_whole(json, NULL, region->x1);
	spec_json_whole(json, NULL, region->y1);
	spec_json_close(json);
	spec_json_whole(json, "pixels",
		(long long)(result->bands > 0 ? result->spectral.pixels
					      : result->others.pixels));
	spec_json_open(json, "metrics", '{', SPEC_JSON_LINES);
	for (size_t i = 0; i < report->metrics; i++) {
		if (report->metric[i].shown || report->metric[i].judged)
			put_metric(json, report, &report->metric[i]);
	}
	spec_json_close(json);
	if (report->exact)
		put_exact(json, report);
	if (report->sigma > 0)
		put_test(json, report);
	if (report->shows_bands)
		put_bands(json, report);
}

void
spec_report_json(const struct spec_report *report, FILE *stream)
{
	struct spec_json json;

	spec_json_start(&json, stream);
	spec_json_open(&json, NULL, '{', SPEC_JSON_LINES);
	spec_json_truth(&json, "same", !report->different);
	spec_json_open(&json, "images", '[', SPEC_JSON_LINES);
	put_image(&json, report, 0);
	put_image(&json, report, 1);
	spec_json_close(&json);
	put_lines(&json, "structure", report->result->structure);
	put_lines(&json, "notes", report->result->notes);
	spec_json_truth(&json, "measured", report->result->comparable);
	if (report->result->comparable)
		put_measured(&json, report);
	spec_json_close(&json);
}
