/*
 * What stands before the samples of a TIFF file of floats without compression: header,
 * directory and all that it points to, so that the file can be written forward alone.
 * Source: Adobe, TIFF revision 6.0 (1992); and, beyond 4 GiB, Aware Systems, The BigTIFF
 * File Format Proposal (2008).
 */
#ifndef SPEC_IMAGE_TIFFHEADER_H
#define SPEC_IMAGE_TIFFHEADER_H

#include <stddef.h>

#include "base/error.h"
#include "base/text.h"

struct spec_tiff_layout {
	size_t width, height;    /* pixels, each below 2^32 */
	size_t channels;         /* 1 to 32767, of grey, interleaved */
	const char *description; /* of so many bytes, the zero behind it among them */
	size_t description_bytes;
};

/*
 * Writes it to text->stream, which is open; rows follow, from the top, 32-bit floats in this
 * machine's byte order. SPEC_ENOMEM.
 */
enum spec_status spec_tiff_header(const struct spec_tiff_layout *layout,
	struct spec_text *text, struct spec_error *error);

#endif
