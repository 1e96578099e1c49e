/* Inside describe*.c and lint*.c alone: what things are called, and channels in groups. */
#ifndef SPEC_IMAGE_DESCRIBING_H
#define SPEC_IMAGE_DESCRIBING_H

#include "image/describe.h"

/* "emissive", "reflective" or, without bands, null. */
const char *spec_describing_role(enum spec_role role);

/* "uint", "half", "float". */
const char *spec_describing_sample(enum spec_sample sample);

/*
 * "layout", "mitsuba", "iset3d", "kaist", "ocean", "given" or, where
 * there are no bands, null.
 */
const char *spec_describing_naming(enum spec_naming naming);

/*
 * The kinds of geometry: "P", "N" …, the last is null. *vector: it has .X, .Y, .Z. Whether
 * an image has one, with a prefix such as "film1." or "".
 */
struct spec_describing_geometry {
	const char *name;
	int vector;
};
extern const struct spec_describing_geometry spec_describing_geometries[];
int spec_describing_has(const struct spec_image *image, const char *prefix,
	const struct spec_describing_geometry *geometry);

/* A channel that is neither a band nor of a layer or of geometry. */
int spec_describing_is_foreign(const struct spec_channel *channel);

/*
 * Bands are summed up in groups: S0 to S3, or T and T off the diagonal. The channels of
 * group 0 to SPEC_DESCRIBING_GROUPS - 1, how many there are, and what they are called.
 */
#define SPEC_DESCRIBING_GROUPS 4
size_t spec_describing_group(const struct spec_describe *describe, int group,
	const char **name, struct spec_statistics *sum);

#endif
