/* ICC profiles of RGB spaces, which pictures carry. */
#ifndef SPEC_COLOUR_PROFILE_H
#define SPEC_COLOUR_PROFILE_H

#include <stddef.h>

#include "base/error.h"
#include "colour/space.h"

/*
 * The profile of a space, as a matrix and the inverse of a transfer function; its white is
 * taken to D50 by Bradford, as ICC.1 asks. The same bytes for the same space. It is called
 * by the space's title and, where that is not the space's own, the transfer function's name.
 * Given:    space     of coordinates RGB
 *           transfer  of the samples, or null: linear
 * Returned: *bytes, newly allocated, and *size
 * Errors:   SPEC_ERANGE  lcms2 makes none of these primaries; SPEC_ENOMEM
 * Source:   ICC.1:2010-12 (version 4.3), by lcms2.
 */
enum spec_status spec_profile_make(const struct spec_space *space,
	const struct spec_transfer *transfer, unsigned char **bytes, size_t *size,
	struct spec_error *error);

#endif
