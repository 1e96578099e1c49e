#include "image/samples.h"

#include <stdint.h>
#include <string.h>

static const char attribute_name[] = "spec:samples";

enum spec_status
spec_samples_get(const struct spec_image *image, long long *samples, const char *name,
	struct spec_error *error)
{
	const struct spec_attribute *attribute =
		spec_image_attribute(image, attribute_name);
	int32_t number;

	*samples = 0;
	if (!attribute)
		return SPEC_OK;
	if (strcmp(attribute->type, "int") != 0 || attribute->size != sizeof number)
		return spec_error_set(
			error, SPEC_EFORMAT, "%s: its spec:samples is no int", name);
	memcpy(&number, attribute->value, sizeof number);
	if (number < 1)
		return spec_error_set(error, SPEC_EFORMAT,
			"%s: its spec:samples is %ld, not at least 1", name, (long)number);
	*samples = number;
	return SPEC_OK;
}

enum spec_status
spec_samples_set(struct spec_image *image, long long samples, const char *name,
	struct spec_error *error)
{
	int32_t number = (int32_t)samples;

	if (samples > INT32_MAX)
		return spec_error_set(error, SPEC_ERANGE,
			"%s: %lld samples per pixel are more than spec:samples can say, %ld",
			name, samples, (long)INT32_MAX);
	if (samples < 1) {
		spec_image_remove_attribute(image, attribute_name);
		return SPEC_OK;
	}
	return spec_image_set_attribute(
		image, attribute_name, "int", &number, sizeof number, error);
}
