#include "image/mask.h"

#include <string.h>

#include "base/number.h"

enum spec_status
spec_mask_parse(struct spec_mask *mask, size_t number, const char *text, const char *nouns,
	struct spec_error *error)
{
	long long id = 0;
	enum spec_status status = SPEC_OK;

	if (text)
		status = spec_number_parse_whole(text, 0, UINT32_MAX, "the id", &id, error);
	mask[number] = (struct spec_mask){!text, (uint32_t)id};
	for (size_t i = 0; i < number && status == SPEC_OK; i++) {
		if (mask[i].any != mask[number].any || mask[i].id != mask[number].id)
			continue;
		if (text)
			status = spec_error_set(error, SPEC_EUSAGE,
				"two %s are for the id %s", nouns, text);
		else
			status = spec_error_set(error, SPEC_EUSAGE,
				"two %s are for all surfaces (--mask ID)", nouns);
	}
	return status;
}

size_t
spec_mask_find(const struct spec_mask *mask, size_t masks, const float *ids, size_t x)
{
	size_t any = SPEC_MASK_NONE;
	uint32_t id = 0;

	if (ids)
		memcpy(&id, ids + x, sizeof id);
	for (size_t i = 0; i < masks; i++) {
		if (mask[i].any)
			any = i;
		else if (mask[i].id == id)
			return i;
	}
	return any;
}
