/* What is wrong with an image's samples. */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "base/memory.h"
#include "base/vector.h"
#include "image/layers.h"
#include "image/linting.h"
#include "image/statistics.h"
#include "image/stream.h"

#define STOKES_SLACK 1e-4F   /* of S0: what rounding to HALF and to decimals may cost */
#define COSINE_BEYOND 1.001F /* specfilm refuses what lies farther out */

/* Pixels of a band that are more polarised than light can be. */
struct excess {
	unsigned long long count;
	size_t x, channel; /* of the first by y, channel, x */
	int y;
};

struct run {
	struct spec_linting *linting;
	struct spec_statistics *statistics; /* of each channel */
	struct excess excess;
	size_t channels, width;
	int y0, polarised; /* S0 to S3 are there, on one grid */
};

SPEC_VECTORISED static size_t
count_excess(const float *restrict s0, const float *restrict s1, const float *restrict s2,
	const float *restrict s3, size_t width)
{
	size_t count = 0;

	for (size_t x = 0; x < width; x++) {
		float most = s0[x] * (1 + STOKES_SLACK);
		float rest = s1[x] * s1[x] + s2[x] * s2[x] + s3[x] * s3[x];

		count += (rest > most * most) | ((rest > 0) & (most < 0));
	}
	return count;
}

/* The payload of a line: the statistics of all channels, then the excess. */
static enum spec_status
look_at_line(
	void *state, struct spec_stream_worker *worker, int line, struct spec_error *error)
{
	const struct run *run = state;
	const struct spec_image *image = run->linting->image;
	struct spec_statistics *statistics = (void *)worker->payload;
	struct excess *excess = (void *)(statistics + run->channels);
	const float *row[4];

	(void)error;
	memset(worker->payload, 0,
		run->channels * sizeof *statistics + sizeof(struct excess));
	for (size_t i = 0; i < run->channels; i++) {
		if (spec_statistics_applies(&image->channel[i]))
			spec_statistics_line(&statistics[i],
				spec_decoder_row(worker->decoder[0], run->y0 + line, i),
				run->width, line);
	}
	for (size_t i = 0; run->polarised && i < run->linting->bands[0]; i++) {
		size_t count;

		for (int j = 0; j < 4; j++)
			row[j] = spec_decoder_row(worker->decoder[0], run->y0 + line,
				run->linting->band[j][i].channel);
		count = count_excess(row[0], row[1], row[2], row[3], run->width);
		if (count > 0 && excess->count == 0) {
			excess->y = line;
			excess->channel = run->linting->band[0][i].channel;
			while (count_excess(row[0] + excess->x, row[1] + excess->x,
				       row[2] + excess->x, row[3] + excess->x, 1) == 0)
				excess->x++;
		}
		excess->count += count;
	}
	return SPEC_OK;
}

static enum spec_status
add_lines(void *state, const unsigned char *payload, int line, int count,
	struct spec_error *error)
{
	struct run *run = state;
	size_t size = run->channels * sizeof *run->statistics;

	(void)line;
	(void)error;
	for (int i = 0; i < count; i++, payload += size + sizeof(struct excess)) {
		const struct spec_statistics *from = (const void *)payload;
		const struct excess *excess = (const void *)(payload + size);
		unsigned long long before = run->excess.count;

		for (size_t j = 0; j < run->channels; j++)
			spec_statistics_add(&run->statistics[j], &from[j]);
		if (before == 0)
			run->excess = *excess;
		else
			run->excess.count += excess->count;
	}
	return SPEC_OK;
}

/* What a channel is to hold. */
enum content {
	LIGHT,   /* S0, T, layers of light: not negative */
	STOKES,  /* S1 to S3 */
	FOREIGN, /* anything */
	COVER    /* A and cover: 0 to 1 */
};

static enum content
content_of(const struct spec_channel *channel)
{
	const char *point = strrchr(channel->name, '.');
	const char *last = point ? point + 1 : channel->name;

	if (channel->role != SPEC_ROLE_OTHER)
		return channel->role == SPEC_ROLE_EMISSIVE && channel->stokes > 0 ? STOKES
										  : LIGHT;
	if (strcmp(channel->name, "A") == 0 || strcmp(channel->name, "cover") == 0 ||
		(spec_layers_is_film(channel) && strcmp(last, "cover") == 0))
		return COVER;
	if ((spec_layers_is_film(channel) || spec_layers_is_lamp(channel)) &&
		strstr(channel->name, "S0."))
		return LIGHT;
	return FOREIGN;
}

/* One kind of odd sample, of all channels of a content. */
struct oddity {
	unsigned long long count;
	size_t channels;
	size_t channel, x; /* of the first by y, x, channel */
	int y;
	float least, most; /* of the channels that have it */
};

static void
take_oddity(struct oddity *oddity, const struct spec_statistics *statistics,
	const struct spec_statistics_kind *kind, size_t channel)
{
	int earlier = kind->y < oddity->y || (kind->y == oddity->y && kind->x < oddity->x);

	if (kind->count == 0)
		return;
	if (oddity->count == 0 || earlier) {
		oddity->y = kind->y;
		oddity->x = kind->x;
		oddity->channel = channel;
	}
	if (statistics->finite > 0) {
		oddity->least = fminf(oddity->least, statistics->minimum);
		oddity->most = fmaxf(oddity->most, statistics->maximum);
	}
	oddity->count += kind->count;
	oddity->channels++;
}

static void
add_oddity(struct spec_linting *linting, enum spec_lint_severity severity,
	const struct oddity *oddity, const char *what)
{
	char place[320];

	if (oddity->count == 0)
		return;
	snprintf(place, sizeof place, "%.255s at %zu,%d",
		linting->image->channel[oddity->channel].name, oddity->x, oddity->y);
	spec_linting_add(linting, severity, place,
		"is %s, the first of %llu such samples in %zu channels", what,
		oddity->count, oddity->channels);
}

static void
judge_finiteness(struct spec_linting *linting, const struct spec_statistics *statistics,
	int foreign, enum spec_lint_severity severity)
{
	struct oddity nan = {0}, infinite = {0};

	for (size_t i = 0; i < linting->image->channels; i++) {
		enum content content = content_of(&linting->image->channel[i]);

		if ((content == FOREIGN || content == COVER) != foreign)
			continue;
		take_oddity(&nan, &statistics[i], &statistics[i].nan, i);
		take_oddity(&infinite, &statistics[i], &statistics[i].infinite, i);
	}
	add_oddity(linting, severity, &nan, "NaN");
	add_oddity(linting, severity, &infinite, "infinite");
}

static void
judge_light(struct spec_linting *linting, const struct spec_statistics *statistics)
{
	struct oddity negative = {0}, above = {0};
	char *quantity = spec_image_quantity(linting->image, linting->error), what[64];
	int share = quantity && linting->image->role == SPEC_ROLE_REFLECTIVE &&
		    (strcmp(quantity, "reflectance") == 0 ||
			    strcmp(quantity, "transmittance") == 0 ||
			    strcmp(quantity, "absorptance") == 0);

	if (!quantity)
		linting->status = SPEC_ENOMEM;
	for (size_t i = 0; i < linting->image->channels; i++) {
		if (content_of(&linting->image->channel[i]) != LIGHT)
			continue;
		take_oddity(&negative, &statistics[i], &statistics[i].negative, i);
		if (share)
			take_oddity(&above, &statistics[i], &statistics[i].above_one, i);
	}
	snprintf(what, sizeof what, "negative (the least is %g)", negative.least);
	add_oddity(linting, SPEC_LINT_WARNING, &negative, what);
	snprintf(what, sizeof what, "a %s above 1 (the most is %g)",
		quantity ? quantity : "", above.most);
	add_oddity(linting, SPEC_LINT_WARNING, &above, what);
	free(quantity);
}

static void
judge_cover(struct spec_linting *linting, const struct spec_statistics *statistics)
{
	struct oddity below = {0}, above = {0};
	char what[64];

	for (size_t i = 0; i < linting->image->channels; i++) {
		if (content_of(&linting->image->channel[i]) != COVER)
			continue;
		take_oddity(&below, &statistics[i], &statistics[i].negative, i);
		take_oddity(&above, &statistics[i], &statistics[i].above_one, i);
	}
	snprintf(what, sizeof what, "a coverage below 0 (the least is %g)", below.least);
	add_oddity(linting, SPEC_LINT_WARNING, &below, what);
	snprintf(what, sizeof what, "a coverage above 1 (the most is %g)", above.most);
	add_oddity(linting, SPEC_LINT_WARNING, &above, what);
}

static void
judge_cosines(struct spec_linting *linting, const struct spec_statistics *statistics)
{
	for (size_t i = 0; i < linting->image->channels; i++) {
		const struct spec_channel *channel = &linting->image->channel[i];
		const char *point = strrchr(channel->name, '.');

		if (strcmp(channel->name, "cosine") != 0 &&
			!(spec_layers_is_film(channel) && point &&
				strcmp(point, ".cosine") == 0))
			continue;
		if (statistics[i].finite > 0 &&
			(statistics[i].minimum < -COSINE_BEYOND ||
				statistics[i].maximum > COSINE_BEYOND))
			spec_linting_add(linting, SPEC_LINT_WARNING, channel->name,
				"reaches from %g to %g, which no cosine does",
				statistics[i].minimum, statistics[i].maximum);
	}
}

static void
judge(struct run *run)
{
	struct spec_linting *linting = run->linting;
	int dark = linting->role != SPEC_ROLE_OTHER;
	char place[320];

	judge_finiteness(linting, run->statistics, 0, SPEC_LINT_WARNING);
	judge_light(linting, run->statistics);
	if (run->excess.count > 0) {
		snprintf(place, sizeof place, "%.255s at %zu,%d",
			linting->image->channel[run->excess.channel].name, run->excess.x,
			run->excess.y);
		spec_linting_add(linting, SPEC_LINT_WARNING, place,
			"is less than the length of S1, S2, S3, the first of %llu such samples",
			run->excess.count);
	}
	/* An atlas's A is a number like the others. */
	if (!spec_image_attribute(linting->image, "spec:atlas"))
		judge_cover(linting, run->statistics);
	judge_cosines(linting, run->statistics);
	judge_finiteness(linting, run->statistics, 1, SPEC_LINT_NOTE);
	for (size_t i = 0; i < run->channels && dark; i++) {
		enum content content = content_of(&linting->image->channel[i]);

		if (content == LIGHT || content == STOKES)
			dark = run->statistics[i].finite == run->statistics[i].samples &&
			       run->statistics[i].minimum == 0 &&
			       run->statistics[i].maximum == 0;
	}
	if (dark)
		spec_linting_add(linting, SPEC_LINT_NOTE, "file",
			"every sample of its bands and layers is 0");
}

enum spec_status
spec_linting_samples(struct spec_linting *linting, struct spec_reader *reader,
	const struct spec_settings *settings, struct spec_error *error)
{
	const struct spec_image *image = linting->image;
	struct run run = {.linting = linting,
		.channels = image->channels,
		.width = spec_window_width(&image->data),
		.y0 = image->data.y0,
		.polarised = image->stokes == 4};
	struct spec_stream stream = {.reader = {reader},
		.readers = 1,
		.first_line = image->data.y0,
		.lines = (int)spec_window_height(&image->data),
		.lines_in = 1,
		.payload_bytes =
			image->channels * sizeof *run.statistics + sizeof(struct excess),
		.state = &run,
		.kernel = look_at_line,
		.deliver = add_lines};
	enum spec_status status = SPEC_ENOMEM;

	run.statistics =
		spec_memory_new(image->channels, sizeof *run.statistics, "channels", error);
	if (run.statistics)
		status = spec_stream_run(&stream, settings, error);
	if (status == SPEC_OK)
		judge(&run);
	free(run.statistics);
	return status;
}
