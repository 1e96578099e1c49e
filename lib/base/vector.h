/*
 * Loops that gcc makes vector code of. SPEC_VECTORISED before a function makes it three
 * times, for AVX-512, for AVX2 and for any x86-64, and the first call picks. In such
 * loops the functions below are libmvec's, at most 4 units in the last place off.
 */
#ifndef SPEC_BASE_VECTOR_H
#define SPEC_BASE_VECTOR_H

#include <math.h>

/*
 * clang 14 knows neither attribute. The thread sanitizer is not yet there when the choice
 * is made, and crashes in it. Who measures one of the three defines SPEC_VECTORISED.
 */
#if !defined(SPEC_VECTORISED)
#if defined(__x86_64__) && !defined(__clang__) && !defined(__SANITIZE_THREAD__)
#define SPEC_VECTORISED                                                                    \
	__attribute__((target_clones("arch=x86-64-v4", "arch=x86-64-v3", "default")))
#else
#define SPEC_VECTORISED
#endif
#endif

#if defined(__x86_64__) && !defined(__clang__)
extern double cos(double) __attribute__((simd("notinbranch"), const));
extern double exp(double) __attribute__((simd("notinbranch"), const));
extern float cosf(float) __attribute__((simd("notinbranch"), const));
extern float expf(float) __attribute__((simd("notinbranch"), const));
#endif

#endif
