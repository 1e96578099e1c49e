/* What reader and writer of Radiance's spectral pictures share. */
#ifndef SPEC_IMAGE_HSR_H
#define SPEC_IMAGE_HSR_H

#include <math.h>

/*
 * A radiance of Radiance's is what it would be, in W m^-2 sr^-1, if the whole range of 380
 * to 780 nm were as bright: its WHTEFFICACY is of equal energy over that. So a radiance per
 * nm is that over 400 nm.
 */
#define HSR_RANGE_NM 400.0

#define HSR_EXPONENT_EXCESS 128

/* A byte stands for the middle of the numbers that were cut to it. */
#define HSR_MIDDLE .5

/* What a byte's 1 is worth beside this exponent; 0 is black. */
static inline double
hsr_power(unsigned char exponent)
{
	return exponent == 0 ? 0 : ldexp(1, exponent - (HSR_EXPONENT_EXCESS + 8));
}

#endif
