/*
 * A first look at a header: OpenEXRCore sorts channels and attributes as it reads them, one
 * by one, and so takes minutes over a header with a million, before anybody can count them.
 */
#ifndef SPEC_IMAGE_SCAN_H
#define SPEC_IMAGE_SCAN_H

#include "base/error.h"
#include "base/source.h"
#include "image/settings.h"

/*
 * Counts the channels and attributes of every part. Error (SPEC_ERANGE): one has more
 * than the limits allow; or that of reading. A damaged header is no error here: the
 * library will say so.
 */
enum spec_status spec_scan_header(struct spec_source *source,
	const struct spec_limits *limits, struct spec_error *error);

#endif
