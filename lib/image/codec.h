/*
 * libdeflate in OpenEXRCore's codec hooks, both ways: ZIP and ZIPS chunks are
 * decoded and encoded faster than by zlib, and read the same.
 */
#ifndef SPEC_IMAGE_CODEC_H
#define SPEC_IMAGE_CODEC_H

#include <openexr.h>

/* A decompress_fn for ZIP and ZIPS. decoding_user_data: a struct libdeflate_decompressor. */
exr_result_t spec_codec_inflate(exr_decode_pipeline_t *pipeline);

/* A compress_fn for ZIP and ZIPS. encoding_user_data: a struct libdeflate_compressor. */
exr_result_t spec_codec_deflate(exr_encode_pipeline_t *pipeline);

#endif
