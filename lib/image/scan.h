/*
 * A first look at a header: OpenEXRCore sorts channels as it reads them, one by one,
 * and so takes minutes over a header with a million, before anybody can count them.
 */
#ifndef SPEC_IMAGE_SCAN_H
#define SPEC_IMAGE_SCAN_H

#include "base/error.h"
#include "base/source.h"

/*
 * Counts the channels of every part. Error (SPEC_ERANGE): one has more than limit;
 * or that of reading. A damaged header is no error here: the library will say so.
 */
enum spec_status spec_scan_channels(
	struct spec_source *source, long long limit, struct spec_error *error);

#endif
