/* Rows of 16-bit floats (IEEE 754 binary16) to 32 bits and back. */
#ifndef SPEC_IMAGE_HALF_H
#define SPEC_IMAGE_HALF_H

#include <stddef.h>

/* Neither side need be aligned. NaN stays NaN, infinities stay, -0 stays. */
void spec_half_to_float(float *to, const void *from, size_t count);

/* Rounds to nearest even; beyond 65504 it becomes an infinity. */
void spec_half_from_float(void *to, const float *from, size_t count);

/* How many finite floats would become infinite so. */
size_t spec_half_overflows(const float *from, size_t count);

#endif
