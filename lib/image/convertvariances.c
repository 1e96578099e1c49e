/* What becomes of the variances of bands: they follow where a band is one of before. */
#include "image/converting.h"
#include "image/variances.h"

/* Bands of one path have one noise: the variance of a sum of bands is not known. */
static int
can_follow(const struct spec_converting *converting)
{
	const struct spec_image *input = converting->convert->input;
	const struct spec_convert_setup *setup = converting->setup;
	int can = input->stokes == 1 && input->bispectral == 0 &&
		  spec_variances_are_whole(input);

	for (size_t i = 0; i < setup->operations && can; i++)
		can = spec_operation_is_affine(&setup->operation[i]);
	for (size_t i = 0; i < converting->made.count && can; i++)
		can = converting->first[i + 1] - converting->first[i] == 1;
	return can;
}

enum spec_status
spec_converting_renew_variances(
	struct spec_converting *converting, struct spec_error *error)
{
	struct spec_image *image = &converting->convert->image;

	if (!spec_variances_has_some(image) ||
		(!converting->renewed && converting->setup->operations == 0 &&
			converting->convert->downsample == 1))
		return SPEC_OK;
	converting->variances = can_follow(converting);
	if (!converting->variances)
		spec_converting_note(converting,
			"%s: without the variances, which are not known of these bands",
			converting->name);
	return spec_variances_renew(image, converting->variances, converting->name, error);
}

size_t
spec_converting_find_variance(
	const struct spec_converting *converting, size_t channel, size_t *band)
{
	const struct spec_image *image = &converting->convert->image,
				*input = converting->convert->input;

	*band = 0;
	if (!converting->variances || !spec_variances_is_one(&image->channel[channel]))
		return input->channels;
	while (spec_variances_find(image, image->band_channel[*band]) != channel)
		++*band;
	return spec_variances_find(
		input, input->band_channel[converting->band[converting->first[*band]]]);
}
