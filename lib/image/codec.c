#include "image/codec.h"

#include <libdeflate.h>
#include <stdint.h>
#include <stdlib.h>
#include <string.h>

#if defined(__SSE2__)
#include <emmintrin.h>
#endif

/*
 * The predictor of ZIP (OpenEXR file layout, "ZIP compression"): the bytes are
 * split into those of even and odd places, one half after the other, and each is
 * replaced by its difference from the one before, plus 128.
 */

/* Running sums: turns differences back into bytes, in place. */
static void
undo_differences(unsigned char *byte, size_t count)
{
	unsigned previous = 0;
	size_t i = 0;

#if defined(__SSE2__)
	const __m128i offset = _mm_set1_epi8(-128);
	__m128i carry = _mm_set1_epi8(-128); /* the first byte has no offset: undo it */

	for (; i + 16 <= count; i += 16) {
		__m128i sum = _mm_add_epi8(
			_mm_loadu_si128((__m128i *)(void *)(byte + i)), offset);

		sum = _mm_add_epi8(sum, _mm_slli_si128(sum, 1));
		sum = _mm_add_epi8(sum, _mm_slli_si128(sum, 2));
		sum = _mm_add_epi8(sum, _mm_slli_si128(sum, 4));
		sum = _mm_add_epi8(sum, _mm_slli_si128(sum, 8));
		sum = _mm_add_epi8(sum, carry);
		_mm_storeu_si128((__m128i *)(void *)(byte + i), sum);
		carry = _mm_set1_epi8((char)byte[i + 15]);
	}
#endif
	previous = i > 0 ? byte[i - 1] : 128;
	for (; i < count; i++) {
		previous = previous + byte[i] - 128;
		byte[i] = (unsigned char)previous;
	}
}

static void
interleave(unsigned char *to, const unsigned char *from, size_t count)
{
	const unsigned char *even = from, *odd = from + (count + 1) / 2;
	size_t i = 0;

#if defined(__SSE2__)
	for (; i + 32 <= count; i += 32) {
		__m128i a = _mm_loadu_si128((const __m128i *)(const void *)(even + i / 2));
		__m128i b = _mm_loadu_si128((const __m128i *)(const void *)(odd + i / 2));

		_mm_storeu_si128((__m128i *)(void *)(to + i), _mm_unpacklo_epi8(a, b));
		_mm_storeu_si128((__m128i *)(void *)(to + i + 16), _mm_unpackhi_epi8(a, b));
	}
#endif
	for (; i < count; i++)
		to[i] = i % 2 == 0 ? even[i / 2] : odd[i / 2];
}

static void
split(unsigned char *to, const unsigned char *from, size_t count)
{
	unsigned char *even = to, *odd = to + (count + 1) / 2;
	size_t i = 0;

#if defined(__SSE2__)
	const __m128i low = _mm_set1_epi16(0xff);

	for (; i + 32 <= count; i += 32) {
		__m128i a = _mm_loadu_si128((const __m128i *)(const void *)(from + i));
		__m128i b = _mm_loadu_si128((const __m128i *)(const void *)(from + i + 16));

		_mm_storeu_si128((__m128i *)(void *)(even + i / 2),
			_mm_packus_epi16(_mm_and_si128(a, low), _mm_and_si128(b, low)));
		_mm_storeu_si128((__m128i *)(void *)(odd + i / 2),
			_mm_packus_epi16(_mm_srli_epi16(a, 8), _mm_srli_epi16(b, 8)));
	}
#endif
	for (; i < count; i++)
		*(i % 2 == 0 ? &even[i / 2] : &odd[i / 2]) = from[i];
}

static void
make_differences(unsigned char *byte, size_t count)
{
	/* Backwards, so that each difference is taken from bytes not yet replaced. */
	for (size_t i = count; i-- > 1;)
		byte[i] = (unsigned char)(byte[i] - byte[i - 1] + 128);
}

static int
reserve(void **buffer, size_t *room, size_t size)
{
	if (*buffer && *room >= size)
		return 1;
	free(*buffer);
	*buffer = malloc(size);
	*room = *buffer ? size : 0;
	return *buffer != NULL;
}

exr_result_t
spec_codec_inflate(exr_decode_pipeline_t *pipeline)
{
	size_t packed = pipeline->chunk.packed_size, size = pipeline->chunk.unpacked_size;

	if (packed == size) /* stored as it is: both buffers are the same one */
		return EXR_ERR_SUCCESS;
	if (!reserve(&pipeline->scratch_buffer_1, &pipeline->scratch_alloc_size_1, size))
		return EXR_ERR_OUT_OF_MEMORY;
	if (libdeflate_zlib_decompress(pipeline->decoding_user_data,
		    pipeline->packed_buffer, packed, pipeline->scratch_buffer_1, size,
		    NULL) != LIBDEFLATE_SUCCESS)
		return EXR_ERR_CORRUPT_CHUNK;
	undo_differences(pipeline->scratch_buffer_1, size);
	interleave(pipeline->unpacked_buffer, pipeline->scratch_buffer_1, size);
	return EXR_ERR_SUCCESS;
}

exr_result_t
spec_codec_deflate(exr_encode_pipeline_t *pipeline)
{
	struct libdeflate_compressor *compressor = pipeline->encoding_user_data;
	size_t size = pipeline->packed_bytes, done;

	if (!reserve(&pipeline->scratch_buffer_1, &pipeline->scratch_alloc_size_1, size) ||
		!reserve(&pipeline->compressed_buffer, &pipeline->compressed_alloc_size,
			size))
		return EXR_ERR_OUT_OF_MEMORY;
	split(pipeline->scratch_buffer_1, pipeline->packed_buffer, size);
	make_differences(pipeline->scratch_buffer_1, size);
	done = libdeflate_zlib_compress(compressor, pipeline->scratch_buffer_1, size,
		pipeline->compressed_buffer, size);
	/* A chunk that does not shrink is stored: readers tell it by its size. */
	if (done == 0 || done >= size) {
		memcpy(pipeline->compressed_buffer, pipeline->packed_buffer, size);
		done = size;
	}
	pipeline->compressed_bytes = done;
	return EXR_ERR_SUCCESS;
}
