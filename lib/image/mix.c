#include "image/mix.h"

#include <string.h>

#include "base/vector.h"

#define RUN 64   /* pixels at a time: some hundred inputs of them stay in the first cache */
#define BLOCK 16 /* pixels whose sums stay in registers */
#define TOGETHER 4 /* outputs that read an input once for all */

/* Half a block. A machine with narrower registers takes two or four of them for one. */
typedef double doubles __attribute__((vector_size(8 * sizeof(double))));
typedef float floats __attribute__((vector_size(8 * sizeof(float))));

struct block {
	doubles half[2];
};

static inline struct block
load_block(const float *from)
{
	floats value[2];

	memcpy(value, from, sizeof value);
	return (struct block){{__builtin_convertvector(value[0], doubles),
		__builtin_convertvector(value[1], doubles)}};
}

static inline void
store_block(float *to, const struct block *sum)
{
	floats value[2] = {__builtin_convertvector(sum->half[0], floats),
		__builtin_convertvector(sum->half[1], floats)};

	memcpy(to, value, sizeof value);
}

/* Four sums of one block of pixels; a null output is summed for nothing. */
SPEC_VECTORISED static void
mix_blocks(const float *const *in, size_t inputs, const double *const weight[TOGETHER],
	float *const to[TOGETHER], size_t from, size_t end)
{
	const double *restrict a = weight[0], *restrict b = weight[1],
			       *restrict c = weight[2], *restrict d = weight[3];

	for (; from < end; from += BLOCK) {
		struct block sum[TOGETHER];

		memset(sum, 0, sizeof sum);
		for (size_t i = 0; i < inputs; i++) {
			struct block value = load_block(in[i] + from);

			for (int half = 0; half < 2; half++) {
				sum[0].half[half] += a[i] * value.half[half];
				sum[1].half[half] += b[i] * value.half[half];
				sum[2].half[half] += c[i] * value.half[half];
				sum[3].half[half] += d[i] * value.half[half];
			}
		}
		for (int k = 0; k < TOGETHER; k++)
			if (to[k])
				store_block(to[k] + from, &sum[k]);
	}
}

/* The pixels that are left over at the end of a row. */
SPEC_VECTORISED static void
mix_rest(const float *const *in, size_t inputs, const double *weight, float *to,
	size_t from, size_t end)
{
	for (; from < end; from++) {
		double sum = 0;

		for (size_t i = 0; i < inputs; i++)
			sum += weight[i] * (double)in[i][from];
		to[from] = (float)sum;
	}
}

static void
mix_run(const float *const *in, size_t inputs, const double *weight, float *const *out,
	size_t outputs, size_t from, size_t end)
{
	size_t whole = from + (end - from) / BLOCK * BLOCK;

	for (size_t o = 0; o < outputs; o += TOGETHER) {
		const double *weights[TOGETHER];
		float *to[TOGETHER];

		for (size_t k = 0; k < TOGETHER; k++) {
			size_t output = o + k < outputs ? o + k : o;

			weights[k] = weight + output * inputs;
			to[k] = o + k < outputs ? out[output] : NULL;
		}
		mix_blocks(in, inputs, weights, to, from, whole);
	}
	for (size_t o = 0; o < outputs && whole < end; o++)
		mix_rest(in, inputs, weight + o * inputs, out[o], whole, end);
}

void
spec_mix_rows(const float *const *in, size_t inputs, const double *weight,
	float *const *out, size_t outputs, size_t width)
{
	for (size_t from = 0; from < width; from += RUN)
		mix_run(in, inputs, weight, out, outputs, from,
			width - from < RUN ? width : from + RUN);
}
