#include "image/codec.h"

#include <libdeflate.h>
#include <pthread.h>
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

#if defined(__SSE2__)
/* The sum of bytes, modulo 256 all that is wanted of it. */
static unsigned
sum_bytes(const unsigned char *byte, size_t count)
{
	__m128i sum = _mm_setzero_si128();
	unsigned rest = 0;
	size_t i = 0;

	for (; i + 16 <= count; i += 16)
		sum = _mm_add_epi64(sum,
			_mm_sad_epu8(
				_mm_loadu_si128((const __m128i *)(const void *)(byte + i)),
				_mm_setzero_si128()));
	for (; i < count; i++)
		rest += byte[i];
	return rest + (unsigned)_mm_cvtsi128_si32(sum) +
	       (unsigned)_mm_cvtsi128_si32(_mm_srli_si128(sum, 8));
}

/* Sixteen running sums, each of the differences up to it, from carry on in every byte. */
static __m128i
run_sums(const unsigned char *difference, __m128i carry)
{
	__m128i sum =
		_mm_add_epi8(_mm_loadu_si128((const __m128i *)(const void *)difference),
			_mm_set1_epi8(-128));

	sum = _mm_add_epi8(sum, _mm_slli_si128(sum, 1));
	sum = _mm_add_epi8(sum, _mm_slli_si128(sum, 2));
	sum = _mm_add_epi8(sum, _mm_slli_si128(sum, 4));
	sum = _mm_add_epi8(sum, _mm_slli_si128(sum, 8));
	return _mm_add_epi8(sum, carry);
}

/* The last of sixteen bytes, in all of them. */
static __m128i
spread_last(__m128i bytes)
{
	return _mm_set1_epi8((char)(_mm_extract_epi16(bytes, 7) >> 8));
}
#endif

/*
 * Turns differences back into bytes and puts them in their places. Both halves are
 * run at once, which saves a pass over memory: the odd one goes on from the last byte
 * of the even one, which is the sum of that half.
 */
static void
undo_predictor(unsigned char *to, const unsigned char *from, size_t count)
{
	size_t half = (count + 1) / 2, i = 0;
	const unsigned char *even = from, *odd = from + half;
	unsigned a = 128, b = 128; /* the first difference of all is a byte as it is */

#if defined(__SSE2__)
	__m128i even_carry = _mm_set1_epi8(-128), odd_carry;

	b = (sum_bytes(even, half) - 128 * (unsigned)(half - 1)) & 255;
	odd_carry = _mm_set1_epi8((char)b);
	for (; i + 16 <= count / 2; i += 16) {
		__m128i x = run_sums(even + i, even_carry),
			y = run_sums(odd + i, odd_carry);

		_mm_storeu_si128((__m128i *)(void *)(to + 2 * i), _mm_unpacklo_epi8(x, y));
		_mm_storeu_si128(
			(__m128i *)(void *)(to + 2 * i + 16), _mm_unpackhi_epi8(x, y));
		even_carry = spread_last(x);
		odd_carry = spread_last(y);
	}
	if (i > 0) {
		a = to[2 * i - 2];
		b = to[2 * i - 1];
	}
#else
	for (size_t k = 0; k < half; k++)
		b += even[k] - 128u;
#endif
	for (; i < half; i++) {
		a += even[i] - 128u;
		to[2 * i] = (unsigned char)a;
		if (2 * i + 1 < count) {
			b += odd[i] - 128u;
			to[2 * i + 1] = (unsigned char)b;
		}
	}
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

/*
 * The bytes between the predictor and deflate, the calling thread's own: whoever decodes a
 * chunk and then encodes one does not need both at once, and a chunk of many bands is large.
 */
static _Thread_local struct {
	void *bytes;
	size_t room;
} between;

/* Frees them where a thread ends that nobody made release them. */
static pthread_key_t at_end;
static pthread_once_t made = PTHREAD_ONCE_INIT;
static int has_key;

static void
make_key(void)
{
	has_key = pthread_key_create(&at_end, free) == 0;
}

static void
keep(void *bytes, size_t room)
{
	between.bytes = bytes;
	between.room = room;
	pthread_once(&made, make_key);
	if (has_key)
		(void)pthread_setspecific(at_end, bytes);
}

void
spec_codec_release(void)
{
	if (!between.bytes)
		return;
	free(between.bytes);
	keep(NULL, 0);
}

static int
reserve(size_t size)
{
	if (between.bytes && between.room >= size)
		return 1;
	spec_codec_release();
	keep(malloc(size), size);
	return between.bytes != NULL;
}

exr_result_t
spec_codec_unzip(struct libdeflate_decompressor *decompressor, const void *packed,
	size_t packed_size, void *bytes, size_t size)
{
	if (!reserve(size))
		return EXR_ERR_OUT_OF_MEMORY;
	if (libdeflate_zlib_decompress(decompressor, packed, packed_size, between.bytes,
		    size, NULL) != LIBDEFLATE_SUCCESS)
		return EXR_ERR_CORRUPT_CHUNK;
	undo_predictor(bytes, between.bytes, size);
	return EXR_ERR_SUCCESS;
}

exr_result_t
spec_codec_zip(struct libdeflate_compressor *compressor, void *bytes, size_t size,
	size_t *packed_size)
{
	if (!reserve(size))
		return EXR_ERR_OUT_OF_MEMORY;
	split(between.bytes, bytes, size);
	make_differences(between.bytes, size);
	*packed_size =
		libdeflate_zlib_compress(compressor, between.bytes, size, bytes, size);
	/* A chunk that does not shrink is stored: readers tell it by its size. */
	if (*packed_size == 0 || *packed_size >= size) {
		undo_predictor(bytes, between.bytes, size);
		*packed_size = size;
	}
	return EXR_ERR_SUCCESS;
}
