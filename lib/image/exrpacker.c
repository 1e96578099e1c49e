/* Encoding chunks of an OpenEXR file and writing them. */
#include <string.h>

#include "image/codec.h"
#include "image/exr.h"
#include "image/exrwriting.h"

#define DEFLATE_LEVEL 4 /* libdeflate; measured: 6 takes half as long again for 1 % */

enum spec_status
exr_open_packer(struct spec_packer *base, struct spec_error *error)
{
	struct exr_packer *packer = (struct exr_packer *)base;

	packer->compressor = libdeflate_alloc_compressor(DEFLATE_LEVEL);
	return packer->compressor
		       ? SPEC_OK
		       : spec_error_set(error, SPEC_ENOMEM, "out of memory for a packer");
}

void
exr_close_packer(struct spec_packer *base)
{
	struct exr_packer *packer = (struct exr_packer *)base;

	if (packer->started) {
		packer->pipeline.packed_buffer = NULL; /* a slot's */
		packer->pipeline.packed_alloc_size = 0;
		exr_encoding_destroy(exr_writer_of(packer)->context, &packer->pipeline);
	}
	spec_codec_release();
	if (packer->compressor)
		libdeflate_free_compressor(packer->compressor);
}

/* The lines lie packed already; the pipeline only wants to be told so. */
static exr_result_t
pack_nothing(exr_encode_pipeline_t *pipeline)
{
	pipeline->packed_bytes = pipeline->packed_alloc_size;
	return EXR_ERR_SUCCESS;
}

static exr_result_t
start_pipeline(struct exr_packer *packer, const exr_chunk_info_t *info)
{
	exr_const_context_t context = exr_writer_of(packer)->context;
	exr_encode_pipeline_t *pipeline = &packer->pipeline;
	exr_result_t result;

	if (packer->started) {
		result = exr_encoding_update(context, 0, info, pipeline);
	} else {
		result = exr_encoding_initialize(context, 0, info, pipeline);
		if (result != EXR_ERR_SUCCESS)
			return result;
		packer->started = 1;
		result = exr_encoding_choose_default_routines(context, 0, pipeline);
		pipeline->convert_and_pack_fn = pack_nothing;
		pipeline->yield_until_ready_fn = NULL;
		pipeline->write_fn = NULL;
	}
	for (int i = 0; i < pipeline->channel_count; i++) {
		exr_coding_channel_info_t *channel = &pipeline->channels[i];

		channel->user_data_type = channel->data_type;
		channel->user_bytes_per_element = channel->bytes_per_element;
		channel->encode_from_ptr =
			(const uint8_t *)""; /* not read: it must not be null */
	}
	return result;
}

static exr_result_t
encode(struct exr_packer *packer, int index, unsigned char *raw)
{
	struct exr_writer *writer = exr_writer_of(packer);
	exr_encode_pipeline_t *pipeline = &packer->pipeline;
	int y = spec_writing_first_line(&writer->base, index);
	size_t size = writer->base.line_bytes * spec_writing_lines(&writer->base, index);
	exr_chunk_info_t info;
	exr_result_t result;

	packer->base.chunk = raw;
	packer->base.chunk_bytes = size;
	if (writer->base.compression == EXR_COMPRESSION_NONE)
		return EXR_ERR_SUCCESS;
	if (spec_codec_is_zip(writer->base.compression))
		return spec_codec_zip(
			packer->compressor, raw, size, &packer->base.chunk_bytes);
	result = exr_write_scanline_chunk_info(writer->context, 0, y, &info);
	if (result == EXR_ERR_SUCCESS)
		result = start_pipeline(packer, &info);
	if (result != EXR_ERR_SUCCESS)
		return result;
	if (info.unpacked_size != size)
		return EXR_ERR_INVALID_ARGUMENT; /* the library would free raw to make room */
	pipeline->packed_buffer = raw;
	pipeline->packed_alloc_size = size;
	result = exr_encoding_run(writer->context, 0, pipeline);
	pipeline->packed_buffer = NULL;
	pipeline->packed_alloc_size = 0;
	/* What does not shrink is stored: readers tell it by its size. */
	if (pipeline->compressed_bytes < size) {
		packer->base.chunk = pipeline->compressed_buffer;
		packer->base.chunk_bytes = pipeline->compressed_bytes;
	}
	return result;
}

enum spec_status
exr_encode(
	struct spec_packer *base, int index, unsigned char *raw, struct spec_error *error)
{
	struct exr_packer *packer = (struct exr_packer *)base;
	exr_result_t result;

	spec_exr_forget();
	result = encode(packer, index, raw);
	return result == EXR_ERR_SUCCESS
		       ? SPEC_OK
		       : spec_exr_error(result, base->writer->path, error);
}

enum spec_status
exr_write(struct spec_packer *base, int index, struct spec_error *error)
{
	struct exr_writer *writer = exr_writer_of((struct exr_packer *)base);
	exr_result_t result;

	spec_exr_forget();
	result = exr_write_scanline_chunk(writer->context, 0,
		spec_writing_first_line(&writer->base, index), base->chunk,
		base->chunk_bytes);
	return result == EXR_ERR_SUCCESS && !spec_exr_has_note()
		       ? SPEC_OK
		       : spec_exr_error(result, writer->base.path, error);
}
