#include "image/level.h"

#include <math.h>
#include <stdatomic.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "base/memory.h"
#include "base/number.h"
#include "colour/coarse.h"
#include "colour/difference.h"
#include "image/stream.h"

#define MOST_LEVEL 15 /* has more bands than any image */
#define MOST_BOUND 1e6

/* What is known of some pixels of one candidate. */
struct sums {
	long long pixels, nonfinite;
	int mended; /* one of them is not finite with all bands alone */
	struct {
		double sum, squares, most;
		int x, y;
	} of[SPEC_LEVEL_FORMULAS];
};

/* A choice that is compared with all bands. */
struct candidate {
	int number; /* of the level, or -1 */
	size_t bands, stride;
	unsigned char *kept;
	struct spec_rgb rgb; /* in X, Y and Z */
	atomic_int out;      /* beyond the bound: no longer compared */
	struct sums sums;
};

struct comparison {
	const struct spec_level *level;
	const struct spec_image *image;
	struct spec_rgb seen; /* of all bands, in X, Y and Z */
	struct candidate *candidate;
	size_t candidates;
	int bounded, compared, wanted[SPEC_LEVEL_FORMULAS];
	size_t width, pixels;
};

enum spec_status
spec_level_parse(const char *text, struct spec_level *level, struct spec_error *error)
{
	static const struct {
		const char *name;
		enum spec_level_formula formula;
		int of_mean;
	} metrics[] = {{"de76", SPEC_LEVEL_DE76, 1}, {"de76-max", SPEC_LEVEL_DE76, 0},
		{"de2000", SPEC_LEVEL_DE2000, 1}, {"de2000-max", SPEC_LEVEL_DE2000, 0}};
	const char *colon = strchr(text, ':');
	enum spec_status status;
	long long number;

	*level = (struct spec_level){.kind = SPEC_LEVEL_HALVED};
	if (!colon) {
		status = spec_number_parse_whole(
			text, 0, MOST_LEVEL, "the level", &number, error);
		level->number = status == SPEC_OK ? (unsigned)number : 0;
		return status;
	}
	for (size_t i = 0; i < sizeof metrics / sizeof *metrics; i++) {
		if (strlen(metrics[i].name) != (size_t)(colon - text) ||
			strncmp(metrics[i].name, text, (size_t)(colon - text)) != 0)
			continue;
		level->kind = SPEC_LEVEL_BOUNDED;
		level->formula = metrics[i].formula;
		level->of_mean = metrics[i].of_mean;
		return spec_number_parse(colon + 1, 0, MOST_BOUND, "the bound of a level",
			&level->bound, error);
	}
	return spec_error_set(error, SPEC_EUSAGE,
		"a level is a number, or de76, de76-max, de2000 or de2000-max with a bound, as "
		"in de2000-max:1, not '%.200s'",
		text);
}

enum spec_status
spec_level_parse_step(const char *text, struct spec_level *level, struct spec_error *error)
{
	*level = (struct spec_level){.kind = SPEC_LEVEL_STEP};
	return spec_number_parse_length(text, "the step", &level->step_nm, error);
}

/* The plan *from without the bands that a candidate does not keep. */
static enum spec_status
coarsen(const struct candidate *candidate, const struct spec_image *image,
	const struct spec_rgb *from, struct spec_rgb *rgb, struct spec_error *error)
{
	size_t all = from->terms, count = 0;
	double *weight = spec_memory_new(all, 3 * sizeof *weight, "bands", error);

	*rgb = *from; /* what it points to is replaced */
	rgb->weight = weight;
	rgb->channel = spec_memory_new(all, sizeof *rgb->channel, "bands", error);
	if (!weight || !rgb->channel) {
		spec_rgb_free(rgb);
		return SPEC_ENOMEM;
	}
	memcpy(weight, from->weight, 3 * all * sizeof *weight);
	for (size_t c = 0; c < 3; c++) {
		if (candidate->stride > 0)
			spec_coarse_repeat(
				image->bands, candidate->stride, weight + c * all);
		else
			spec_coarse_interpolate(image->wavelength_nm, image->bands,
				candidate->kept, weight + c * all);
	}
	for (size_t i = 0; i < all; i++) {
		/* Behind the bands stand elements of reradiation, which all stay. */
		if (i < image->bands && !candidate->kept[i])
			continue;
		rgb->channel[count] = from->channel[i];
		for (size_t c = 0; c < 3; c++)
			weight[c * all + count] = weight[c * all + i];
		count++;
	}
	for (size_t c = 1; c < 3; c++)
		memmove(weight + c * count, weight + c * all, count * sizeof *weight);
	rgb->terms = count;
	return SPEC_OK;
}

/* Differences of one pixel; colours that are the same bits have none. */
static void
add_pixel(const struct comparison *comparison, struct sums *sums, const double full_lab[3],
	const double xyz[3], int same, int x, int y)
{
	double lab[3] = {0}, difference[SPEC_LEVEL_FORMULAS] = {0};

	if (!same) {
		spec_lab_from_xyz(xyz, comparison->seen.white, lab);
		difference[SPEC_LEVEL_DE76] = spec_difference_ab76(full_lab, lab);
		if (comparison->wanted[SPEC_LEVEL_DE2000])
			difference[SPEC_LEVEL_DE2000] =
				spec_difference_ciede2000(full_lab, lab);
	}
	for (size_t i = 0; i < SPEC_LEVEL_FORMULAS; i++) {
		sums->of[i].sum += difference[i];
		sums->of[i].squares += difference[i] * difference[i];
		if (sums->pixels == 0 || difference[i] > sums->of[i].most) {
			sums->of[i].most = difference[i];
			sums->of[i].x = x;
			sums->of[i].y = y;
		}
	}
	sums->pixels++;
}

static void
sum_row(const struct comparison *comparison, const struct spec_rgb *rgb,
	struct spec_stream_worker *worker, int line, const float **plane, float *xyz)
{
	size_t width = comparison->width;

	for (size_t i = 0; i < rgb->terms; i++)
		plane[i] = spec_decoder_row(worker->decoder[0],
			comparison->image->data.y0 + line, rgb->channel[i]);
	spec_rgb_row(rgb, plane, width, xyz, xyz + width, xyz + 2 * width);
}

/* A row of a candidate beside the same of all bands. */
static void
compare_row(const struct comparison *comparison, struct sums *sums, const float *full,
	const double *full_lab, const float *xyz, int line)
{
	size_t width = comparison->width;

	for (size_t x = 0; x < width; x++) {
		double there[3];
		int finite[2] = {1, 1}, same = 1;

		for (size_t c = 0; c < 3; c++) {
			there[c] = xyz[c * width + x];
			finite[0] &= isfinite(full[c * width + x]) != 0;
			finite[1] &= isfinite(there[c]) != 0;
			same &= full[c * width + x] == xyz[c * width + x];
		}
		if (finite[0] && finite[1]) {
			add_pixel(comparison, sums, full_lab + 3 * x, there, same, (int)x,
				line);
			continue;
		}
		sums->nonfinite++;
		sums->mended |= finite[0] != finite[1];
	}
}

static enum spec_status
kernel(void *state, struct spec_stream_worker *worker, int line, struct spec_error *error)
{
	const struct comparison *comparison = state;
	size_t width = comparison->width;
	double *lab = worker->scratch;
	float *full = (float *)(void *)(lab + 3 * width), *xyz = full + 3 * width;
	const float **plane = (const float **)(void *)(xyz + 3 * width);
	struct sums *sums = (struct sums *)(void *)worker->payload;

	(void)error;
	memset(sums, 0, comparison->candidates * sizeof *sums);
	sum_row(comparison, &comparison->seen, worker, line, plane, full);
	for (size_t x = 0; x < width; x++) {
		double there[3] = {full[x], full[width + x], full[2 * width + x]};

		spec_lab_from_xyz(there, comparison->seen.white, lab + 3 * x);
	}
	for (size_t i = 0; i < comparison->candidates; i++) {
		struct candidate *candidate = &comparison->candidate[i];

		if (atomic_load(&candidate->out))
			continue;
		sum_row(comparison, &candidate->rgb, worker, line, plane, xyz);
		compare_row(comparison, &sums[i], full, lab, xyz, line);
		if (comparison->bounded && !comparison->level->of_mean &&
			!(sums[i].of[comparison->level->formula].most <=
				comparison->level->bound))
			atomic_store(&candidate->out, 1);
	}
	return SPEC_OK;
}

static void
add_sums(struct sums *to, const struct sums *from)
{
	for (size_t i = 0; i < SPEC_LEVEL_FORMULAS; i++) {
		to->of[i].sum += from->of[i].sum;
		to->of[i].squares += from->of[i].squares;
		if (from->pixels > 0 &&
			(to->pixels == 0 || from->of[i].most > to->of[i].most)) {
			to->of[i].most = from->of[i].most;
			to->of[i].x = from->of[i].x;
			to->of[i].y = from->of[i].y;
		}
	}
	to->pixels += from->pixels;
	to->nonfinite += from->nonfinite;
	to->mended |= from->mended;
}

static enum spec_status
deliver(void *state, const unsigned char *payload, int line, int count,
	struct spec_error *error)
{
	struct comparison *comparison = state;
	const struct sums *sums = (const struct sums *)(const void *)payload;

	(void)line;
	(void)error;
	for (int row = 0; row < count; row++) {
		for (size_t i = 0; i < comparison->candidates; i++)
			add_sums(&comparison->candidate[i].sums, sums++);
	}
	if (!comparison->bounded || !comparison->level->of_mean)
		return SPEC_OK;
	for (size_t i = 0; i < comparison->candidates; i++) {
		struct candidate *candidate = &comparison->candidate[i];

		/* The mean can no longer be within the bound, whatever is still to come. */
		if (candidate->sums.of[comparison->level->formula].sum >
			comparison->level->bound * (double)comparison->pixels)
			atomic_store(&candidate->out, 1);
	}
	return SPEC_OK;
}

static enum spec_status
compare(struct comparison *comparison, struct spec_reader *reader,
	const struct spec_settings *settings, struct spec_error *error)
{
	const struct spec_rgb *seen = &comparison->seen;
	struct spec_stream stream = {
		.payload_bytes = comparison->candidates * sizeof(struct sums),
		.scratch_bytes =
			comparison->width * (3 * sizeof(double) + 6 * sizeof(float)) +
			seen->terms * sizeof(float *),
		.state = comparison,
		.kernel = kernel,
		.deliver = deliver};
	unsigned char *wanted =
		spec_stream_take(&stream, reader, seen->channel, seen->terms, error);
	enum spec_status status =
		wanted ? spec_stream_run(&stream, settings, error) : SPEC_ENOMEM;

	free(wanted);
	return status;
}

/* Whether all of what was compared lies within the bound. */
static int
is_within(const struct spec_level *level, const struct candidate *candidate)
{
	const struct sums *sums = &candidate->sums;

	if (candidate->out || sums->mended)
		return 0;
	return !level->of_mean || sums->pixels == 0 ||
	       sums->of[level->formula].sum / (double)sums->pixels <= level->bound;
}

static void
make_report(const struct candidate *candidate, const struct spec_image *image,
	struct spec_level_report *report)
{
	const struct sums *sums = &candidate->sums;
	double pixels = sums->pixels > 0 ? (double)sums->pixels : 1;

	*report = (struct spec_level_report){.number = candidate->number,
		.finest =
			candidate->number < 0 ? -1 : (int)spec_coarse_finest(image->bands),
		.bands = candidate->bands,
		.of = image->bands,
		.pixels = sums->pixels,
		.nonfinite = sums->nonfinite};
	for (size_t i = 0; i < SPEC_LEVEL_FORMULAS; i++)
		report->difference[i] = (struct spec_level_difference){
			sums->of[i].sum / pixels, sqrt(sums->of[i].squares / pixels),
			sums->of[i].most, sums->of[i].x, sums->of[i].y};
}

/* Which bands a candidate keeps. */
static enum spec_status
choose_bands(struct candidate *candidate, const struct spec_level *level,
	const struct spec_image *image, unsigned number, struct spec_error *error)
{
	candidate->kept = spec_memory_new(image->bands, 1, "bands", error);
	if (!candidate->kept)
		return SPEC_ENOMEM;
	if (level->kind == SPEC_LEVEL_STEP) {
		enum spec_status status = spec_coarse_stride(image->wavelength_nm,
			image->bands, level->step_nm, &candidate->stride, error);

		if (status != SPEC_OK)
			return status;
		candidate->number = -1;
		for (size_t i = 0; i < image->bands; i += candidate->stride) {
			candidate->kept[i] = 1;
			candidate->bands++;
		}
		return SPEC_OK;
	}
	candidate->number = (int)number;
	candidate->bands = spec_coarse_halve(image->bands, number, candidate->kept);
	return SPEC_OK;
}

/* The candidates: all levels where they are bounded, else the one that is asked for. */
static enum spec_status
make_candidates(struct comparison *comparison, struct spec_error *error)
{
	const struct spec_level *level = comparison->level;
	const struct spec_image *image = comparison->image;
	unsigned finest = spec_coarse_finest(image->bands),
		 number = level->number < finest ? level->number : finest;
	enum spec_status status = SPEC_OK;

	comparison->candidates = comparison->bounded ? (size_t)finest + 1 : 1;
	comparison->candidate = spec_memory_new(
		comparison->candidates, sizeof *comparison->candidate, "levels", error);
	if (!comparison->candidate)
		return SPEC_ENOMEM;
	for (size_t i = 0; i < comparison->candidates && status == SPEC_OK; i++) {
		struct candidate *candidate = &comparison->candidate[i];

		status = choose_bands(candidate, level, image,
			comparison->bounded ? (unsigned)i : number, error);
		if (status == SPEC_OK && comparison->compared)
			status = coarsen(candidate, image, &comparison->seen,
				&candidate->rgb, error);
	}
	return status;
}

/* The sums that are compared: whatever the picture's space and scale are, Y is 1 for white. */
static enum spec_status
plan_seen(struct comparison *comparison, const struct spec_rgb_setup *setup,
	struct spec_error *error)
{
	struct spec_rgb_setup seen = *setup;

	seen.space = spec_space_find("xyz", error);
	seen.scale = SPEC_RGB_ONE;
	return spec_rgb_plan(&comparison->seen, comparison->image, &seen, error);
}

static enum spec_status
apply(struct comparison *comparison, struct spec_reader *reader, struct spec_rgb *rgb,
	struct spec_level_report *report, const struct spec_settings *settings,
	struct spec_error *error)
{
	const struct spec_level *level = comparison->level;
	struct candidate *chosen;
	struct spec_rgb fewer;
	enum spec_status status = make_candidates(comparison, error);

	if (status == SPEC_EUSAGE) /* of the step */
		spec_error_prefix(error, "%s", spec_reader_name(reader));
	if (status == SPEC_OK && comparison->compared)
		status = compare(comparison, reader, settings, error);
	if (status != SPEC_OK)
		return status;
	chosen = comparison->candidate;
	/* The last has all bands and needs no check. */
	while (comparison->bounded &&
		chosen + 1 < comparison->candidate + comparison->candidates &&
		!is_within(level, chosen))
		chosen++;
	status = coarsen(chosen, comparison->image, rgb, &fewer, error);
	if (status != SPEC_OK)
		return status;
	spec_rgb_free(rgb);
	*rgb = fewer;
	make_report(chosen, comparison->image, report);
	return SPEC_OK;
}

enum spec_status
spec_level_apply(const struct spec_level *level, struct spec_reader *reader,
	const struct spec_image *image, const struct spec_rgb_setup *setup,
	struct spec_rgb *rgb, struct spec_level_report *report,
	const struct spec_settings *settings, struct spec_error *error)
{
	struct comparison comparison = {.level = level,
		.image = image,
		.bounded = level->kind == SPEC_LEVEL_BOUNDED};
	enum spec_status status = SPEC_OK;

	if (level->kind == SPEC_LEVEL_ALL)
		return SPEC_OK;
	comparison.width = spec_window_width(&comparison.image->data);
	comparison.pixels = comparison.width * spec_window_height(&comparison.image->data);
	comparison.wanted[SPEC_LEVEL_DE2000] =
		level->measured || level->formula == SPEC_LEVEL_DE2000;
	comparison.compared = comparison.bounded || level->measured;
	if (comparison.compared)
		status = plan_seen(&comparison, setup, error);
	if (status != SPEC_OK)
		spec_error_prefix(error, "%s", spec_reader_name(reader));
	else
		status = apply(&comparison, reader, rgb, report, settings, error);
	for (size_t i = 0; comparison.candidate && i < comparison.candidates; i++) {
		free(comparison.candidate[i].kept);
		spec_rgb_free(&comparison.candidate[i].rgb);
	}
	free(comparison.candidate);
	spec_rgb_free(&comparison.seen);
	return status;
}

void
spec_level_text(const struct spec_level *level, const struct spec_level_report *report,
	char text[SPEC_LEVEL_TEXT])
{
	if (level->kind == SPEC_LEVEL_STEP)
		snprintf(text, SPEC_LEVEL_TEXT,
			"%zu of %zu bands, each for those up to the next", report->bands,
			report->of);
	else
		snprintf(text, SPEC_LEVEL_TEXT,
			"%zu of %zu bands, level %d, straight lines between them",
			report->bands, report->of, report->number);
}

void
spec_level_print(const struct spec_level_report *report, FILE *stream)
{
	static const char *const name[SPEC_LEVEL_FORMULAS] = {
		[SPEC_LEVEL_DE76] = "de76", [SPEC_LEVEL_DE2000] = "de2000"};

	if (report->number >= 0)
		fprintf(stream, "level      %d of %d\n", report->number, report->finest);
	fprintf(stream, "bands      %zu of %zu\n", report->bands, report->of);
	for (size_t i = 0; i < SPEC_LEVEL_FORMULAS; i++) {
		const struct spec_level_difference *difference = &report->difference[i];
		char rms[16], most[16];

		snprintf(rms, sizeof rms, "%s-rms", name[i]);
		snprintf(most, sizeof most, "%s-max", name[i]);
		fprintf(stream, "%-10s %.6g\n", name[i], difference->mean);
		fprintf(stream, "%-10s %.6g\n", rms, difference->rms);
		fprintf(stream, "%-10s %.6g at %d,%d\n", most, difference->most,
			difference->x, difference->y);
	}
	if (report->nonfinite > 0)
		fprintf(stream, "nonfinite  %lld\n", report->nonfinite);
}
