/* Weighted sums of planes of pixels: every output is a sum of all inputs. */
#ifndef SPEC_IMAGE_MIX_H
#define SPEC_IMAGE_MIX_H

#include <stddef.h>

/*
 * out[o][x] = the sum over i of weight[o * inputs + i] * in[i][x], for x < width, in double.
 * No plane of the output may overlap one of the input. An input of which no output has a
 * weight but 0 is still read, so its NaN comes through.
 */
void spec_mix_rows(const float *const *in, size_t inputs, const double *weight,
	float *const *out, size_t outputs, size_t width);

#endif
