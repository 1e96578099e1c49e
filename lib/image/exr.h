/* What reader and writer share: OpenEXRCore's messages and attributes. */
#ifndef SPEC_IMAGE_EXR_H
#define SPEC_IMAGE_EXR_H

#include <openexr.h>

#include "base/error.h"
#include "image/image.h"

/* Bytes per sample of a type. */
static inline size_t
spec_exr_sample_bytes(enum spec_sample sample)
{
	return sample == SPEC_SAMPLE_HALF ? 2 : 4;
}

/*
 * OpenEXRCore reports through a callback; this one keeps the thread's last
 * message, which spec_exr_error then puts behind "name: ".
 */
void spec_exr_report(exr_const_context_t context, exr_result_t code, const char *message);
void spec_exr_forget(void);

/*
 * What went wrong in the thread's last call, as an error. A system's error that
 * spec_exr_note kept in a callback comes before the library's own words.
 */
enum spec_status spec_exr_error(
	exr_result_t result, const char *name, struct spec_error *error);
void spec_exr_note(const struct spec_error *error);
int spec_exr_has_note(void);

/*
 * OpenEXRCore allocates what a header asks for before it has read it. This allocator
 * refuses single pieces above the thread's limit, with a note that names the option
 * which lifts it; spec_exr_allow sets the limit for the calling thread.
 */
void *spec_exr_allocate(size_t size);
void spec_exr_allow(long long size, const char *option);

/* Copies a part's attributes into the image, except those that its fields hold. */
enum spec_status spec_exr_get_attributes(exr_const_context_t context, int part,
	struct spec_image *image, const char *name, struct spec_error *error);

/* Declares the image's attributes in a part that is being written. */
enum spec_status spec_exr_set_attributes(exr_context_t context, int part,
	const struct spec_image *image, const char *name, struct spec_error *error);

#endif
