/* A spectral image beside a picture: what the picture shows if it is one of that image. */
#include <stdio.h>

#include "base/memory.h"
#include "compare/comparing.h"
#include "image/rgb.h"

/* R, G and B of the image, or 0 where it is no picture. */
static int
find_channels(const struct spec_image *image, size_t channel[3])
{
	static const char *const name[] = {"R", "G", "B"};

	for (int c = 0; c < 3; c++) {
		channel[c] = spec_image_find_channel(image, name[c]);
		if (channel[c] == image->channels ||
			image->channel[channel[c]].sample == SPEC_SAMPLE_UINT)
			return 0;
	}
	return image->bands == 0;
}

/* Three bands: the sums that make red, green and blue of the spectral image. */
static enum spec_status
sum_bands(struct spec_comparing_sums *sums, const struct spec_image *image,
	const struct spec_images_setup *setup, const struct spec_space *space,
	double *outside, struct spec_error *error)
{
	struct spec_rgb_setup how = {.observer = setup->observer,
		.illuminant = setup->illuminant,
		.adaptation = SPEC_ADAPTATION_NONE,
		.space = space,
		.exposure = setup->exposure};
	struct spec_rgb rgb = {0};
	enum spec_status status = spec_rgb_plan(&rgb, image, &how, error);

	if (status == SPEC_OK)
		status = spec_comparing_new_sums(sums, 3, 3 * rgb.terms, error);
	for (size_t i = 0; i < 3 * rgb.terms && status == SPEC_OK; i++) {
		sums->channel[i] = rgb.channel[i % rgb.terms];
		sums->weight[i] = rgb.weight[i];
		sums->first[i / rgb.terms + 1] = i + 1;
	}
	*outside = rgb.outside;
	spec_rgb_free(&rgb);
	return status;
}

/* The same of the picture: its channels as they are. */
static enum spec_status
take_channels(struct spec_comparing *comparison, const size_t channel[3], int side,
	struct spec_error *error)
{
	struct spec_comparing_sums *sums = &comparison->sums[side];
	struct spec_comparing_pairs *pairs = &comparison->bands;
	enum spec_status status = spec_comparing_new_sums(sums, 3, 3, error);

	pairs->a = spec_memory_new(3, sizeof *pairs->a, "bands", error);
	pairs->b = spec_memory_new(3, sizeof *pairs->b, "bands", error);
	if (status != SPEC_OK || !pairs->a || !pairs->b)
		return SPEC_ENOMEM;
	for (size_t i = 0; i < 3; i++) {
		sums->channel[i] = pairs->a[i] = pairs->b[i] = channel[i];
		sums->weight[i] = 1;
		sums->first[i + 1] = i + 1;
	}
	pairs->count = 3;
	return SPEC_OK;
}

enum spec_status
spec_comparing_shown(struct spec_comparing *comparison, struct spec_error *error)
{
	const struct spec_images_setup *setup = comparison->setup;
	struct spec_images *result = comparison->result;
	int second = comparison->a->bands > 0;
	const struct spec_image *picture = second ? comparison->b : comparison->a;
	const struct spec_image *image = second ? comparison->a : comparison->b;
	struct spec_space space;
	size_t channel[3];
	double outside = 0;
	enum spec_status status;

	if (image->bands == 0 || !setup->observer || setup->exact ||
		!find_channels(picture, channel))
		return SPEC_OK;
	status = spec_comparing_space(picture, &space, error);
	if (status == SPEC_OK)
		status = sum_bands(
			&comparison->sums[!second], image, setup, &space, &outside, error);
	if (status == SPEC_OK)
		status = take_channels(comparison, channel, second, error);
	comparison->picture = picture;
	result->grid = second;
	snprintf(result->notes, sizeof result->notes,
		"the %s as spec2rgb shows it, in the primaries of the %s; %.2f %% of Y is "
		"outside its bands\n",
		second ? "first" : "second", second ? "second" : "first", 100 * outside);
	return status;
}
