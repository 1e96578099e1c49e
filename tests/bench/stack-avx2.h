/*
 * The library's lib/optics/stack.c compiled again for AVX2 alone, under names of its own:
 * avx2_stack_row is then what spec_stack_row is on a processor without AVX-512. Comes
 * before everything that includes base/vector.h, which takes SPEC_VECTORISED as it is here.
 */
#ifndef BENCH_STACK_AVX2_H
#define BENCH_STACK_AVX2_H

#include "optics/stack.h"

#if defined(__x86_64__) && !defined(__clang__)
#define HAS_AVX2_STACK 1
#define SPEC_VECTORISED __attribute__((target("arch=x86-64-v3")))

extern __typeof__(spec_stack_new) avx2_stack_new;
extern __typeof__(spec_stack_free) avx2_stack_free;
extern __typeof__(spec_stack_reverse) avx2_stack_reverse;
extern __typeof__(spec_stack_is_lit) avx2_stack_is_lit;
extern __typeof__(spec_stack_spectrum) avx2_stack_spectrum;
extern __typeof__(spec_stack_row) avx2_stack_row;

#define spec_stack_new avx2_stack_new
#define spec_stack_free avx2_stack_free
#define spec_stack_reverse avx2_stack_reverse
#define spec_stack_is_lit avx2_stack_is_lit
#define spec_stack_spectrum avx2_stack_spectrum
#define spec_stack_row avx2_stack_row
#include "optics/stack.c"
#undef spec_stack_new
#undef spec_stack_free
#undef spec_stack_reverse
#undef spec_stack_is_lit
#undef spec_stack_spectrum
#undef spec_stack_row
#undef PI
#else
#define HAS_AVX2_STACK 0
#endif

#endif
