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

/*
 * Under names of their own: gcc makes sincos of a sine and a cosine of one angle, and then
 * no vector code of that.
 */
#if defined(__x86_64__) && !defined(__clang__)
#define SPEC_VECTOR_FUNCTION(type, name, function)                                         \
	extern type name(type) __asm__(function) __attribute__((simd("notinbranch"), const))
SPEC_VECTOR_FUNCTION(double, spec_vector_sin, "sin");
SPEC_VECTOR_FUNCTION(double, spec_vector_cos, "cos");
SPEC_VECTOR_FUNCTION(double, spec_vector_exp, "exp");
SPEC_VECTOR_FUNCTION(double, spec_vector_expm1, "expm1");
SPEC_VECTOR_FUNCTION(double, spec_vector_erf, "erf");   /* since glibc 2.35 */
SPEC_VECTOR_FUNCTION(double, spec_vector_cbrt, "cbrt"); /* since glibc 2.35 */
SPEC_VECTOR_FUNCTION(double, spec_vector_log, "log");
SPEC_VECTOR_FUNCTION(float, spec_vector_expf, "expf");
extern double spec_vector_pow(double, double) __asm__("pow")
	__attribute__((simd("notinbranch"), const));
extern double spec_vector_atan2(double, double) __asm__("atan2") /* since glibc 2.35 */
	__attribute__((simd("notinbranch"), const));
#else
#define spec_vector_sin sin
#define spec_vector_cos cos
#define spec_vector_exp exp
#define spec_vector_expm1 expm1
#define spec_vector_erf erf
#define spec_vector_cbrt cbrt
#define spec_vector_log log
#define spec_vector_pow pow
#define spec_vector_atan2 atan2
#define spec_vector_expf expf
#endif

#endif
