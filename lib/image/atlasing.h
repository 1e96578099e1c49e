/* What writing and reading an atlas (atlas.h) share. */
#ifndef SPEC_IMAGE_ATLASING_H
#define SPEC_IMAGE_ATLASING_H

#include <stddef.h>

/* Names of attributes. */
#define SPEC_ATLAS_STEPS "spec:atlas"
#define SPEC_ATLAS_LINES "spec:atlas-lines"

/* The fields of a line of SPEC_ATLAS_LINES. */
enum spec_atlas_field {
	SPEC_ATLAS_NAME,
	SPEC_ATLAS_COLUMN,
	SPEC_ATLAS_QUANTITY,
	SPEC_ATLAS_UNIT,
	SPEC_ATLAS_MEDIUM,
	SPEC_ATLAS_TITLE,
	SPEC_ATLAS_SOURCE,
	SPEC_ATLAS_FIELDS
};

#define SPEC_ATLAS_TEXEL 4 /* samples: R, G, B, A */

static inline size_t
spec_atlas_texels(size_t samples)
{
	return (samples + SPEC_ATLAS_TEXEL - 1) / SPEC_ATLAS_TEXEL;
}

#endif
