/* A spectral image as the components of a colour model: an OpenEXR image of floats. */
#ifndef SPEC_IMAGE_SEPARATE_H
#define SPEC_IMAGE_SEPARATE_H

#include "base/error.h"
#include "colour/models.h"
#include "image/develop.h"
#include "image/reader.h"
#include "image/rgb.h"
#include "image/settings.h"

/*
 * Reads all lines of an image, sums them by the plan, clips the result to the colours of a
 * picture, [0, 1], encodes it by sRGB's transfer function and writes the model's components
 * to the settings' output, as spec_image_save does: channels of the names in models.h, such
 * as H, S, V, and the input's windows; it says nothing of wavelengths. A pixel of which a
 * component is not finite is NaN in all of them. result: as spec_develop_run's.
 */
enum spec_status spec_separate_run(struct spec_develop *result, struct spec_reader *reader,
	const struct spec_rgb *rgb, const struct spec_model *model,
	const struct spec_settings *settings, struct spec_error *error);

#endif
