/*
 * Which surfaces of an image a coating or a disc is for, by the ids in its channels. A tool
 * has a list of masks, one for each of its coatings or discs.
 */
#ifndef SPEC_IMAGE_MASK_H
#define SPEC_IMAGE_MASK_H

#include <stddef.h>
#include <stdint.h>

#include "base/error.h"

#define SPEC_MASK_NONE SIZE_MAX /* in place of a mask's number: none is for a surface */

struct spec_mask {
	int any;     /* every surface that none of the others takes */
	uint32_t id; /* else those of this id */
};

/*
 * Sets mask[number] from the text of an id, or from null: any surface. nouns: what has the
 * masks, for the message, such as "discs". Errors: no whole number from 0 to 2^32 - 1 (as
 * spec_number_parse_whole's); an earlier mask that is for the same (SPEC_EUSAGE).
 */
enum spec_status spec_mask_parse(struct spec_mask *mask, size_t number, const char *text,
	const char *nouns, struct spec_error *error);

/*
 * The number of the mask that the surface of pixel x falls to, or SPEC_MASK_NONE. ids: a
 * row of UINT samples, as decoders have them, or null: every id is 0.
 */
size_t spec_mask_find(
	const struct spec_mask *mask, size_t masks, const float *ids, size_t x);

#endif
