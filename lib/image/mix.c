#include "image/mix.h"

#include <string.h>

#include "base/vector.h"

/* Pixels at a time: some hundred inputs of them stay in the first cache. */
#define RUN 64

/* Four outputs at a time read every input once for all. */
#define TOGETHER 4

SPEC_VECTORISED static void
mix_four(const float *const *in, size_t inputs, const double *const weight[TOGETHER],
	float *const to[TOGETHER], size_t from, size_t count)
{
	double sum[TOGETHER][RUN];

	memset(sum, 0, sizeof sum);
	for (size_t i = 0; i < inputs; i++) {
		const float *restrict value = in[i] + from;
		double a = weight[0][i], b = weight[1][i], c = weight[2][i],
		       d = weight[3][i];

		for (size_t x = 0; x < count; x++) {
			double v = value[x];

			sum[0][x] += a * v;
			sum[1][x] += b * v;
			sum[2][x] += c * v;
			sum[3][x] += d * v;
		}
	}
	for (int k = 0; k < TOGETHER; k++)
		for (size_t x = 0; x < count && to[k]; x++)
			to[k][from + x] = (float)sum[k][x];
}

void
spec_mix_rows(const float *const *in, size_t inputs, const double *weight,
	float *const *out, size_t outputs, size_t width)
{
	for (size_t from = 0; from < width; from += RUN) {
		size_t count = width - from < RUN ? width - from : RUN;

		for (size_t o = 0; o < outputs; o += TOGETHER) {
			const double *weights[TOGETHER];
			float *to[TOGETHER];

			for (size_t k = 0; k < TOGETHER; k++) {
				size_t output = o + k < outputs ? o + k : o;

				weights[k] = weight + output * inputs;
				to[k] = o + k < outputs ? out[output] : NULL;
			}
			mix_four(in, inputs, weights, to, from, count);
		}
	}
}
