/*
 * ZIP and ZIPS by libdeflate, which is faster than zlib: what OpenEXRCore's own pipelines
 * would do to a chunk, without their buffers.
 */
#ifndef SPEC_IMAGE_CODEC_H
#define SPEC_IMAGE_CODEC_H

#include <libdeflate.h>
#include <openexr.h>
#include <stddef.h>

/*
 * Decodes a chunk into size bytes, which may begin where the packed ones do. Errors:
 * EXR_ERR_CORRUPT_CHUNK, EXR_ERR_OUT_OF_MEMORY.
 */
exr_result_t spec_codec_unzip(struct libdeflate_decompressor *decompressor,
	const void *packed, size_t packed_size, void *bytes, size_t size);

/*
 * Encodes a chunk where it lies; *packed_size: how many bytes it has then, size where it
 * stays what it is because it would not shrink. Error: EXR_ERR_OUT_OF_MEMORY.
 */
exr_result_t spec_codec_zip(struct libdeflate_compressor *compressor, void *bytes,
	size_t size, size_t *packed_size);

/* Frees what the calling thread keeps from one chunk to the next. */
void spec_codec_release(void);

static inline int
spec_codec_is_zip(int compression)
{
	return compression == EXR_COMPRESSION_ZIP || compression == EXR_COMPRESSION_ZIPS;
}

#endif
